"""The rotating square patch: pressure at the start, what is kept, and whether voids open."""
import math

import numpy

from figures import Figure, below, near

TITLE = "a rotating square patch"
RHO, OMEGA, L = 1000.0, 1.0, 1.0
CENTRE_PRESSURE = -0.1473427  # rho omega^2 L^2 at t = 0+: the double series of Colagrossi 2005
SIZES = {"full": (50, 100), "small": (40,)}  # L / l0


def settings(rows):
    spacing = L / rows
    return {"mps.spacing": spacing, "mps.time_step": 0.25 * spacing / (OMEGA * L)}


def start_of(runs, rows):
    """Six steps with a frame after each."""
    given = settings(rows)
    step = given["mps.time_step"]
    few = {"time.end": 6 * step, "output.every_time": step, "output.precision": "float64"}
    return runs.run(f"start_n{rows}", {**given, **few})


def centre_pressure(frame, spacing):
    """A paraboloid through the pressures of the particles nearest to the middle, in rho omega^2 L^2."""
    near_by = (frame.x**2).sum(axis=1) < (4 * spacing) ** 2
    x, y = frame.x[near_by].T
    terms = numpy.stack([numpy.ones_like(x), x, y, x * x, x * y, y * y], axis=1)
    return numpy.linalg.lstsq(terms, frame.p[near_by], rcond=None)[0][0] / (RHO * OMEGA**2 * L**2)


def kinetic_energy(frame):
    return 0.5 * (frame.u**2).sum()


def angular_momentum(frame):
    return (frame.x[:, 0] * frame.u[:, 1] - frame.x[:, 1] * frame.u[:, 0]).sum()


def distance_to_water(points, x, reach):
    """From each point to the particle next to it; never more than the reach. Points of one column share their search."""
    distance = numpy.empty(len(points))
    for column in numpy.unique(points[:, 0]):
        ours = points[:, 0] == column
        near_by = x[numpy.abs(x[:, 0] - column) < reach]
        apart = points[ours][:, None, :] - near_by[None, :, :]
        distance[ours] = numpy.sqrt((apart**2).sum(axis=2).min(axis=1, initial=reach**2))
    return distance


def grid_about(centre, half, step):
    axis = numpy.arange(-half, half + step / 2, step)
    return numpy.array([(centre[0] + a, centre[1] + b) for a in axis for b in axis])


def largest_void(frame, spacing, radius=0.3):
    """Radius of the largest empty circle with its centre in the middle of the patch, in spacings: the best of a coarse
    grid, then of fine ones round the best few."""
    middle = frame.x.mean(axis=0)
    reach = 4 * spacing
    x = frame.x[((frame.x - middle) ** 2).sum(axis=1) < (radius + reach) ** 2]
    points = grid_about(middle, radius, spacing / 3)
    points = points[((points - middle) ** 2).sum(axis=1) < radius**2]
    distance = distance_to_water(points, x, reach)
    best = points[numpy.argsort(distance)[-10:]]
    fine = [distance_to_water(grid_about(point, spacing / 4, spacing / 24), x, reach).max() for point in best]
    return max(distance.max(), *fine) / spacing


def measure(runs):
    for rows in SIZES[runs.size]:
        yield from measure_at(runs, rows)


def measure_at(runs, rows):
    spacing, name = L / rows, f"L/l0 = {rows}: "
    values = [centre_pressure(frame, spacing) for frame in start_of(runs, rows).frames()[3:6]]
    yield Figure(name + "pressure in the middle, steps 3 to 5", numpy.mean(values), near(CENTRE_PRESSURE, 0.03))
    frames = runs.run(f"n{rows}", settings(rows)).frames()
    energy = kinetic_energy(frames[-1]) / kinetic_energy(frames[0])
    momentum = angular_momentum(frames[-1]) / angular_momentum(frames[0])
    yield Figure(name + "kinetic energy lost to omega t = 2", 1 - energy, below(0.03))
    yield Figure(name + "angular momentum lost to omega t = 2", 1 - momentum, below(0.01))
    yield Figure(name + "largest empty circle / l0", max(largest_void(f, spacing) for f in frames), below(0.9))


def draw(figure, runs):
    schemes = [scheme for scheme in ("default", "classic") if scheme in runs and runs[scheme].done]
    for axes, scheme in zip(numpy.atleast_1d(figure.subplots(1, 2)), schemes):
        rows = SIZES[runs[scheme].size][0]
        run = runs[scheme].done.get(f"n{rows}")
        if run is None:
            continue
        frame = run.frames()[-1]
        scale = RHO * OMEGA**2 * L**2
        dots = axes.scatter(*frame.x.T, c=frame.p / scale, s=2, vmin=-0.1, vmax=0.1, cmap="coolwarm", linewidths=0)
        axes.set(aspect="equal", title=f"{scheme}, omega t = {frame.time:.1f}", xlim=(-1.3, 1.3), ylim=(-1.3, 1.3))
    figure.colorbar(dots, ax=figure.axes, label="p / (rho omega² L²)", shrink=0.8)
