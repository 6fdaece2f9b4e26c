"""The stretching drop in 3-D: it stays an ellipsoid of constant volume, whose axes follow ordinary differential equations."""
import math

import numpy

from figures import Figure, below, near

TITLE = "a stretching drop in 3-D"
RHO, R = 1000.0, 1.0
RATES = (-50.0, -50.0, 100.0)  # of x, y, z at the start [1/s]; their sum is 0
END = 0.008  # [s]
SIZES = {"full": (20, 40), "small": (12,)}  # R / l0
AXIS = {"full": 0.005, "small": 0.01}  # part of the axis
ENERGY = {"full": 0.01, "small": 0.02}
PRESSURE = {"full": 0.05, "small": 0.1}  # part of the pressure in the middle, in the mean over the run
PRESSURE_WITHIN = 0.3  # parts of the ellipsoid: particles nearer to the middle tell the pressure there


def central_pressure(axes, rates):
    """p0 over rho / 2, at which the volume stays: sum of (a'/a)^2 over sum of 1 / a^2. `rates` are a'."""
    return ((rates / axes) ** 2).sum() / (1 / axes**2).sum()


def exact(end, steps=800):
    """Axes in R and p0 in rho at `end`: a'' = 2 p0 / (rho a) from a sphere; Runge and Kutta's fourth order."""

    def rate(state):
        axes, speeds = state
        return numpy.array([speeds, central_pressure(axes, speeds) / axes])

    state, h = numpy.array([[1.0, 1.0, 1.0], RATES]), end / steps
    for _ in range(steps):
        k1 = rate(state)
        k2 = rate(state + h / 2 * k1)
        k3 = rate(state + h / 2 * k2)
        k4 = rate(state + h * k3)
        state = state + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    return state[0], central_pressure(*state) / 2


def run_of(runs, rows):
    spacing = R / rows
    given = {"mps.spacing": spacing, "mps.time_step": 0.25 * spacing / (RATES[2] * R)}
    if runs.scheme == "classic":
        # As in 2-D: C = 1.05 lets sound travel at about 9 spacings a step, which must be fast beside the water.
        given |= {"mps.time_step": 0.05 * spacing / (RATES[2] * R), "mps.adaptive": False}
    return runs.run(f"n{rows}", given)


def axes_by_moments(frame, first):
    return R * numpy.sqrt((frame.x**2).mean(axis=0) / (first.x**2).mean(axis=0))


def kinetic_energy(frame):
    return (frame.u**2).sum()


def pressure_in_the_middle(frame, axes):
    """p0 / rho: p over 1 - sum of (x/a)^2 in the mean over the particles of the middle, where that is near 1."""
    apart = ((frame.x / axes) ** 2).sum(axis=1)
    middle = apart < PRESSURE_WITHIN**2
    return (frame.p[middle] / (1 - apart[middle])).mean() / RHO


def measure(runs):
    for rows in SIZES[runs.size]:
        yield from measure_at(runs, rows)


def measure_at(runs, rows):
    name = f"R/l0 = {rows}: "
    frames = run_of(runs, rows).frames()
    last = frames[-1]
    exact_axes, exact_pressure = exact(last.time)
    axes = axes_by_moments(last, frames[0])
    for axis in range(3):
        limit = near(1, AXIS[runs.size])
        yield Figure(f"{name}axis {'xyz'[axis]} / exact at {END} s, by moments", axes[axis] / exact_axes[axis], limit)
    yield Figure(f"{name}volume, product of the axes, at {END} s", axes.prod())
    loss = 1 - kinetic_energy(last) / kinetic_energy(frames[0])
    yield Figure(f"{name}kinetic energy lost to {END} s", loss, below(ENERGY[runs.size]))
    pressures = [pressure_in_the_middle(frame, exact(frame.time)[0]) / exact(frame.time)[1] for frame in frames[1:]]
    mean = numpy.mean(pressures)
    yield Figure(f"{name}pressure in the middle / exact, mean over the run", mean, near(1, PRESSURE[runs.size]))
    yield Figure(f"{name}pressure in the middle / exact, at its worst", max(pressures, key=lambda p: abs(p - 1)))


def draw(figure, runs):
    left, right = figure.subplots(1, 2)
    times = numpy.linspace(0, END, 41)
    curves = [exact(time, 200) for time in times]
    for scheme, colour in (("classic", "tab:orange"), ("default", "tab:blue")):
        run = runs[scheme].done.get(f"n{SIZES[runs[scheme].size][-1]}") if scheme in runs else None
        if run is None:
            continue
        frames = run.frames()
        when = [1e3 * frame.time for frame in frames]
        axes = numpy.array([axes_by_moments(frame, frames[0]) for frame in frames])
        left.plot(when, axes[:, 2], "o", mfc="none", color=colour, label=f"{scheme}, z")
        left.plot(when, axes[:, 0], "s", mfc="none", color=colour, label=f"{scheme}, x")
        middle = [pressure_in_the_middle(frame, exact(frame.time, 200)[0]) for frame in frames[1:]]
        right.plot(when[1:], middle, "o", mfc="none", color=colour, label=scheme)
    left.plot(1e3 * times, [axes for axes, _ in curves], "k-", lw=0.8)
    left.set(xlabel="t [ms]", ylabel="half axes [m]")
    right.plot(1e3 * times, [pressure for _, pressure in curves], "k-", lw=0.8, label="exact")
    right.set(xlabel="t [ms]", ylabel="pressure in the middle / rho [m²/s²]", ylim=(0, 4000))
    for axes in (left, right):
        axes.legend(fontsize=7)
