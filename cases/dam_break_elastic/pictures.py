#!/usr/bin/env python3
"""Pictures in the style of the paper's Figs. 2 to 7: frames, close-ups, and histories at five heights of the plate.

    cases/dam_break_elastic/pictures.py RUN_OF_PAPER_TOML RUN_OF_BEST_TOML FOLDER

Needs python3-h5py and python3-matplotlib.
"""
import sys
from pathlib import Path

import h5py
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy

from peaks import PAPER_DISPLACEMENT, PAPER_LOAD, probe, smooth

TIMES = (0.15, 0.25, 0.3, 0.4)  # s
NAMES = ("paper.toml", "best.toml")
HEIGHTS = (0.02, 0.25, 0.5, 0.75, 1.0)  # of n1 ... n5


def frame_near(path, wanted):
    """Time, particles, speeds, pressures, and the plate's outline of the frame nearest to a time."""
    with h5py.File(path, "r") as file:
        frames = file["frames"]
        name = min(frames, key=lambda key: abs(frames[key].attrs["time"] - wanted))
        frame = frames[name]
        outline = frame["plate/position"][:] if "plate" in frame else None
        speed = numpy.linalg.norm(frame["velocity"][:], axis=1)
        return frame.attrs["time"], frame["position"][:], speed, frame["pressure"][:], outline


def draw_plate(axis, outline):
    """Its nodes as they stand, on the front."""
    if outline is None:
        return
    front = outline[outline[:, 2] > 0] if outline.shape[1] == 3 else outline
    order = numpy.argsort(front[:, 1])
    middle = front[order, 0].reshape(-1, 2)
    height = front[order, 1].reshape(-1, 2)
    left, right = middle.min(axis=1), middle.max(axis=1)
    axis.fill_betweenx(height.mean(axis=1), left, right, color="black")


def draw_frames(runs, folder, name, window, size, by_pressure):
    figure, axes = plt.subplots(len(runs), len(TIMES), figsize=(3.1 * len(TIMES), 2.6 * len(runs)), layout="constrained",
                                squeeze=False)
    for row, (run, title) in enumerate(zip(runs, NAMES)):
        for axis, wanted in zip(axes[row], TIMES):
            time, x, speed, pressure, outline = frame_near(f"{run}/results.h5", wanted)
            colour, top = (pressure / 1e3, 5) if by_pressure else (speed, 4)
            dots = axis.scatter(x[:, 0], x[:, 1], c=colour, s=size, vmin=0, vmax=top, cmap="viridis", linewidths=0)
            draw_plate(axis, outline)
            axis.plot((0, 0, 0.8, 0.8), (0.6, 0, 0, 0.6), color="black", linewidth=1)
            axis.set(xlim=window[:2], ylim=window[2:], aspect="equal", title=f"{title}, {time:.2f} s", xticks=(), yticks=())
    figure.colorbar(dots, ax=axes, label="p [kPa]" if by_pressure else "speed [m/s]", shrink=0.7)
    figure.savefig(Path(folder) / name, dpi=80)
    plt.close(figure)


def draw_histories(runs, folder, name):
    """Fig. 6 and 7: loads (mean over 2 ms) and displacements along x at five heights."""
    figure, axes = plt.subplots(2, len(runs), figsize=(5 * len(runs), 6), layout="constrained", squeeze=False, sharex=True)
    for column, (run, title) in enumerate(zip(runs, NAMES)):
        for k, height in enumerate(HEIGHTS, 1):
            time, load = probe(run, f"load_n{k}")
            axes[0][column].plot(time, smooth(time, load) / 1e3, lw=0.8, label=f"n{k}, {height:g} of the height")
            time, way = probe(run, f"displacement_n{k}")
            axes[1][column].plot(time, 1e3 * way, lw=1)
        axes[0][column].axvline(PAPER_LOAD, color="k", ls=":", lw=0.8)
        axes[1][column].axvline(PAPER_DISPLACEMENT, color="k", ls=":", lw=0.8)
        axes[0][column].set(title=title, ylabel="load [kPa]", xlim=(0.2, 0.5))
        axes[1][column].set(xlabel="t [s]", ylabel="displacement [mm]")
    axes[0][0].legend(fontsize=7)
    figure.savefig(Path(folder) / name, dpi=80)
    plt.close(figure)


def draw_all(paper, best, folder):
    runs = [paper, best]
    draw_frames(runs, folder, "elastic_frames.png", (-0.02, 0.82, -0.02, 0.62), 0.3, False)
    draw_frames(runs, folder, "elastic_close.png", (0.5, 0.8, -0.01, 0.2), 1.2, True)
    draw_histories(runs, folder, "elastic_histories.png")


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    draw_all(*sys.argv[1:])
