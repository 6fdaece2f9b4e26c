#!/usr/bin/env python3
"""Picture of a run: the water in space and from above at three times.

    scripts/run cases/dam_break_3d/dam_break_3d.toml
    python3 cases/dam_break_3d/plot.py runs/dam_break_3d out.png

Needs python3-h5py and python3-matplotlib (with Pillow, on which it depends).
"""
import sys

import h5py
import matplotlib
import numpy

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from mpl_toolkits.mplot3d.art3d import Line3DCollection, Poly3DCollection
from PIL import Image

TIMES = (0.2, 0.34, 0.54)  # s
TANK = (1.0, 0.6, 0.6)  # m
PLATE = ((0.7, 0.15, 0.0), (0.72, 0.45, 0.1))  # lowest and highest corner [m]
FASTEST = 2.5  # m/s, end of the colour scale


def frames(path):
    """Time [s], positions [m] and speeds [m/s] of the frames nearest to TIMES."""
    with h5py.File(path, "r") as file:
        stored = list(file["frames"].values())
        for wanted in TIMES:
            frame = min(stored, key=lambda one: abs(one.attrs["time"] - wanted))
            yield frame.attrs["time"], frame["position"][:], numpy.linalg.norm(frame["velocity"][:], axis=1)


def box_faces(low, high):
    """The six faces of a box, four corners each."""
    faces = []
    for axis in range(3):
        a, b = (axis + 1) % 3, (axis + 2) % 3
        for side in (low, high):
            face = numpy.full((4, 3), side[axis], dtype=float)
            face[:, a] = low[a], high[a], high[a], low[a]
            face[:, b] = low[b], low[b], high[b], high[b]
            faces.append(face)
    return faces


def dots(axis, x, speed, **more):
    return axis.scatter(*x.T, c=speed, s=3, vmin=0, vmax=FASTEST, cmap="viridis", linewidths=0, alpha=1, **more)


def draw_in_space(axis, x, speed):
    # matplotlib sorts the points of one collection by depth, but collections only as a whole. Seen from +x, -y and
    # above, a point is in front of the plate if it is on the outer side of one of the three faces that look that way.
    front = (x[:, 0] > PLATE[1][0]) | (x[:, 1] < PLATE[0][1]) | (x[:, 2] > PLATE[1][2])
    edges = [numpy.vstack((face, face[:1])) for face in box_faces((0, 0, 0), TANK)]
    axis.computed_zorder = False
    axis.add_collection3d(Line3DCollection(edges, color="0.6", linewidth=0.6, zorder=1))
    dots(axis, x[~front], speed[~front], depthshade=False, zorder=2)
    plate = Poly3DCollection(box_faces(*PLATE), facecolor="0.3", edgecolor="black", linewidth=0.6, zorder=3)
    axis.add_collection3d(plate)
    dots(axis, x[front], speed[front], depthshade=False, zorder=4)
    axis.set(xlim=(0, TANK[0]), ylim=(0, TANK[1]), zlim=(0, TANK[2]))
    axis.set_box_aspect(TANK, zoom=1.08)
    axis.view_init(elev=25, azim=-62)
    axis.set_axis_off()


def draw_from_above(axis, x, speed):
    order = numpy.argsort(x[:, 2])  # the highest on top
    drawn = dots(axis, x[order, :2], speed[order])
    (x0, y0, _), (x1, y1, _) = PLATE
    axis.fill((x0, x1, x1, x0), (y0, y0, y1, y1), facecolor="none", edgecolor="black", linewidth=1.2)
    axis.plot((0, TANK[0], TANK[0], 0, 0), (0, 0, TANK[1], TANK[1], 0), color="black", linewidth=1)
    axis.set(aspect="equal")
    axis.set_axis_off()
    return drawn


def main(run, picture):
    figure = plt.figure(figsize=(12, 5.8))
    width = 0.31  # of a column of the picture
    for column, (time, x, speed) in enumerate(frames(f"{run}/results.h5")):
        left = 0.005 + column * width
        draw_in_space(figure.add_axes((left - 0.02, 0.37, width + 0.04, 0.6), projection="3d"), x, speed)
        drawn = draw_from_above(figure.add_axes((left + 0.015, 0.01, width - 0.03, 0.36)), x, speed)
        figure.text(left + width / 2, 0.955, f"t = {time:.2f} s", ha="center", fontsize=12)
    figure.colorbar(drawn, cax=figure.add_axes((0.945, 0.2, 0.012, 0.6)), label="speed [m/s]")
    figure.canvas.draw()
    # 256 colours instead of all: a fraction of the size.
    image = Image.fromarray(numpy.asarray(figure.canvas.buffer_rgba())).convert("RGB")
    image.quantize(256, Image.Quantize.MEDIANCUT, dither=Image.Dither.NONE).save(picture, optimize=True)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    main(*sys.argv[1:])
