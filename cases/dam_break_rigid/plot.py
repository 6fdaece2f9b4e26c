#!/usr/bin/env python3
"""Picture of a run: frames of the collapse and the front beside published ones.

    scripts/run cases/dam_break_rigid/quick.toml
    python3 cases/dam_break_rigid/plot.py runs/dam_break_rigid_quick out.png

Needs python3-h5py and python3-matplotlib.
"""
import csv
import math
import sys

import h5py
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

TIMES = (0.0, 0.15, 0.25, 0.3, 0.4, 0.5)  # s
PLATE = ((0.6, 0), (0.6, 0.1), (0.615, 0.1), (0.615, 0))
COLUMN = 0.2  # width a of the column [m]
GRAVITY = 9.81

# t sqrt(2 g / a), x / a; read off the figures.
KOSHIZUKA_OKA_MPS = ((0.591, 1.205), (0.778, 1.351), (1.095, 1.637), (1.381, 1.931), (1.684, 2.268), (2.043, 2.707))
KOSHIZUKA_OKA_MEASURED = ((0.769, 1.252), (1.153, 1.505), (1.537, 1.892), (1.935, 2.241), (2.323, 2.615))
MARTIN_MOYCE = ((0.832, 1.217), (1.219, 1.474), (1.997, 2.292), (2.547, 2.995))


def frames(path):
    with h5py.File(path, "r") as file:
        for name in sorted(file["frames"]):
            frame = file["frames"][name]
            yield frame.attrs["time"], frame["position"][:], frame["velocity"][:]


def draw_frames(axes, path):
    stored = list(frames(path))
    for axis, wanted in zip(axes, TIMES):
        time, x, u = min(stored, key=lambda frame: abs(frame[0] - wanted))
        speed = (u**2).sum(axis=1) ** 0.5
        dots = axis.scatter(x[:, 0], x[:, 1], c=speed, s=1.5, vmin=0, vmax=4, cmap="viridis", linewidths=0)
        axis.plot((0, 0, 0.8, 0.8), (0.6, 0, 0, 0.6), color="black", linewidth=1)
        axis.fill(*zip(*PLATE), color="black")
        axis.set(xlim=(-0.02, 0.82), ylim=(-0.02, 0.62), aspect="equal", title=f"t = {time:.2f} s", xticks=(), yticks=())
    return dots


def draw_front(axis, path):
    with open(path, newline="") as file:
        rows = [row for row in csv.DictReader(file)]
    scale = math.sqrt(2 * GRAVITY / COLUMN)
    points = [(float(r["time[s]"]) * scale, float(r["front[m]"]) / COLUMN) for r in rows]
    points = [point for point in points if point[1] <= 2.98]
    axis.plot(*zip(*points), label="Greenwater, classic scheme")
    axis.plot(*zip(*KOSHIZUKA_OKA_MPS), "s", mfc="none", label="Koshizuka & Oka 1996, MPS")
    axis.plot(*zip(*KOSHIZUKA_OKA_MEASURED), "o", mfc="none", label="Koshizuka & Oka 1996, measured")
    axis.plot(*zip(*MARTIN_MOYCE), "^", mfc="none", label="Martin & Moyce 1952, measured")
    axis.set(xlabel="t sqrt(2g/a)", ylabel="front x/a")
    axis.legend(fontsize=8)


def main(run, picture):
    figure = plt.figure(figsize=(10, 7.4), layout="constrained")
    top, bottom = figure.subfigures(2, 1, height_ratios=(2, 1.15))
    axes = list(top.subplots(2, 3).flat)
    dots = draw_frames(axes, f"{run}/results.h5")
    top.colorbar(dots, ax=axes, label="speed [m/s]", shrink=0.7)
    draw_front(bottom.subplots(), f"{run}/probes/front.csv")
    figure.savefig(picture, dpi=90)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
