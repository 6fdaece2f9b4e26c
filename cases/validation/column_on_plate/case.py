"""A water column on a clamped plate: deflection, wet frequency, added mass."""
import math

import numpy

from figures import Figure, near

TITLE = "a water column on a clamped plate"
G, DEPTH, SPAN, THICK = 9.8, 2.0, 1.0, 0.05
RHO, RHO_S, E, NU = 1000.0, 2700.0, 67.5e9, 0.34
BENDING = E * THICK**3 / (12 * (1 - NU**2))
# Thin plate; shear makes it softer by 48 D / (kappa G h L^2) = 3 % [a plate of this thickness with QM6 elements].
DEFLECTION = -(RHO * DEPTH + RHO_S * THICK) * G * SPAN**4 / (384 * BENDING)
SHEAR = 5.0 / 6.0 * E / (2 * (1 + NU)) * THICK
DEFLECTION_WITH_SHEAR = DEFLECTION * (1 + 48 * BENDING / (SHEAR * SPAN**2))
# Potential flow in a closed-wall column with p = 0 on top, first mode: 1430 kg/m2 on 135 kg/m2.
ADDED_MASS, DRY = 1429.9, 273.3
WET = DRY / math.sqrt(1 + ADDED_MASS / (RHO_S * THICK))
SIZES = {"full": 40, "small": 20}  # particles along the span
OFF, FREQUENCY_OFF = 0.02, 0.05


def run_of(runs):
    return runs.run("column", {"mps.spacing": SPAN / SIZES[runs.size]})


def mean_at_end(time, value):
    """Over the last three wet periods."""
    return value[time > time[-1] - 3 / WET].mean()


def wet_frequency(time, value):
    """From the crossings of the mean, in the first four periods: later there is little left to cross."""
    part = time < 4 / WET
    time, value = time[part], value[part] - value[time > time[-1] / 2].mean()
    i = numpy.flatnonzero(value[:-1] * value[1:] < 0)
    zeros = time[i] - value[i] * (time[i + 1] - time[i]) / (value[i + 1] - value[i])
    return (len(zeros) - 1) / (2 * (zeros[-1] - zeros[0]))


def measure(runs):
    run = run_of(runs)
    time, middle = run.probe("middle")
    _, force = run.probe("force")
    history = run.history()
    yield Figure("deflection of the middle [m], thin plate", mean_at_end(time, middle), near(DEFLECTION, OFF))
    yield Figure("the same over a plate's with shear", mean_at_end(time, middle) / DEFLECTION_WITH_SHEAR)
    yield Figure("force / weight of the water", mean_at_end(time, force) / -(RHO * G * DEPTH * SPAN))
    yield Figure("wet frequency [Hz]", wet_frequency(time, middle), near(WET, FREQUENCY_OFF))
    if "added_mass_plate" in history:
        ratio = history["added_mass_plate"]
        yield Figure("added mass of the first mode [kg/m2]", ratio[numpy.isfinite(ratio)][0] * RHO_S * THICK
                     if numpy.isfinite(ratio).any() else numpy.nan)


def draw(figure, runs):
    axes = figure.subplots()
    for scheme, colour in (("classic", "tab:orange"), ("default", "tab:blue")):
        if scheme in runs and "column" in runs[scheme].done:
            time, middle = run_of(runs[scheme]).probe("middle")
            axes.plot(1e3 * time, 1e3 * middle, color=colour, lw=1, label=scheme)
    axes.axhline(1e3 * DEFLECTION, color="k", ls="--", lw=0.6, label="static, thin plate")
    axes.set(xlabel="t [ms]", ylabel="middle [mm]", ylim=(-0.2, 0.05))
    axes.legend(fontsize=8)
