"""A dam break onto a box: when the pressure comes at two sensors, its peak and its impulse; water heights; nobody is lost."""
import math

import numpy

from curves import averaged, impact
from figures import Figure, below, near

TITLE = "a dam break onto a box"
RHO, G, H = 1000.0, 9.81, 0.55
HEAD = RHO * G * H
SIZES = {"full": (0.02, H / 27), "small": (0.05,)}  # l0 [m]; at 20 mm the water is 0.54 m deep, at the others as it should be
END = {"full": 2.0, "small": 1.0}  # [s]
MEAN = 0.02 * math.sqrt(H / G)  # both curves are averaged over so much time [s], as in lobovsky
ARRIVED = 0.2 * HEAD  # the mean pressure [Pa] that counts as arrival, as there
IMPULSE_TIME = 0.5  # the impulse is counted from arrival for so long [s]
# Parts of the measured arrival and impulse; peaks are only told. The small size has its box 3 particles high and P1 below the
# first row of them: arrivals and the height in the reservoir are all that it can be held to.
ARRIVAL, IMPULSE = {"full": 0.05, "small": 0.1}, {"full": 0.15, "small": None}
BOX = numpy.array(((0.6635, 0.2985, 0.0), (0.8245, 0.7015, 0.161)))  # two corners [m]
GAUGE = 0.1  # side of the square whose water is counted for a height [m]
# The gauge that is held to a limit, and this as part of the measured height. At the small size's 50 mm heights come in pieces
# of 12.5 mm, and are one or two of them higher or lower when a step is a fifth shorter.
RESERVOIR, RESERVOIR_OFF = "H4", {"full": 0.1, "small": 0.15}

# t [s], p [Pa]: the record of the experiment as it is given away with SPHERIC's test 2, thinned; from 0.6 s on read off the
# figures of Kleefsman et al., J. Comput. Phys. 206:363, 2005.
MEASURED = {
    "P1": ((0, 0), (0.392, -96), (0.393, 516), (0.394, 1868), (0.395, 3675), (0.396, 5196), (0.398, 4402), (0.400, 5622),
           (0.402, 7947), (0.404, 9090), (0.408, 10822), (0.412, 8509), (0.415, 11239), (0.420, 9761), (0.430, 9363),
           (0.440, 8620), (0.460, 7833), (0.480, 6986), (0.500, 6483), (0.550, 5768), (0.590, 4985), (0.647, 4187),
           (0.748, 3701), (0.848, 3459), (0.949, 3162), (1.000, 3016), (1.149, 2903), (1.350, 2498), (1.551, 2779),
           (1.752, 2930), (2.000, 3066)),
    "P3": ((0, 0), (0.418, -70), (0.422, 190), (0.424, 1217), (0.426, 1735), (0.427, 3202), (0.428, 4413), (0.430, 5221),
           (0.432, 4685), (0.440, 5456), (0.450, 6176), (0.458, 6560), (0.473, 6216), (0.480, 5625), (0.490, 5479),
           (0.500, 5177), (0.520, 5329), (0.550, 4919), (0.590, 4305), (0.672, 3691), (0.773, 3739), (0.874, 3653),
           (0.974, 3291), (1.000, 3215), (1.176, 2757), (1.322, 2223), (1.523, 2034), (1.725, 2185), (2.000, 2198)),
}
# x of the gauges, in the middle of the tank [m], and the measured height [m] at 0.5, 1.0, 1.5 and 2.0 s, from that record.
HEIGHTS = {
    "H1": (1.488, (0.095, 0.155, 0.145, 0.142)),
    "H2": (0.992, (0.099, 0.179, 0.236, 0.287)),
    "H3": (0.496, (0.001, 0.151, 0.346, 0.288)),
    "H4": (2.638, (0.426, 0.279, 0.182, 0.130)),
}
TIME = numpy.arange(0, 2.0, 0.0005)


def smooth(time, pressure):
    return averaged(time, pressure, TIME, MEAN)


def measured(sensor):
    return smooth(*zip(*MEASURED[sensor]))


def name_of(spacing):
    return f"l0_{1000 * spacing:.3g}mm"


def run_of(runs, spacing):
    given = {"mps.spacing": spacing, "mps.time_step": 0.1 * spacing, "time.end": END[runs.size]}
    if runs.scheme == "classic":
        given |= {"mps.time_step": 0.115 * spacing, "mps.adaptive": False}
    return runs.run(name_of(spacing), given)


def facts(curve):
    """Arrival [s], peak and impulse [rho g H and s]; nan where the curve never arrives."""
    arrival, peak, impulse = impact(TIME, curve, ARRIVED, IMPULSE_TIME)
    return arrival, peak / HEAD, impulse / HEAD


def height(frame, x, spacing):
    """The volume of the water over the gauge's square, by its area [m]: a drop in the air counts for what it is."""
    over = (abs(frame.x[:, 0] - x) < GAUGE / 2) & (abs(frame.x[:, 1] - 0.5) < GAUGE / 2)
    return over.sum() * spacing**3 / GAUGE**2


def in_the_box(frame):
    return ((BOX[0] < frame.x) & (frame.x < BOX[1])).all(axis=1).sum()


def measure(runs):
    for spacing in SIZES[runs.size]:
        for figure in measure_at(runs, spacing):
            figure.name = f"l0 = {1000 * spacing:.3g} mm, {figure.name}"
            yield figure


def measure_at(runs, spacing):
    run = run_of(runs, spacing)
    yield from measure_pressure(runs.size, run)
    if spacing == SIZES[runs.size][-1]:
        yield from measure_heights(runs.size, run, spacing)
    history = run.history()
    yield Figure("particles", history["particles"][0])
    yield Figure("particles lost", history["lost"][-1], below(0.5))
    yield Figure("most particles in the box at any frame", max(in_the_box(frame) for frame in run.frames()), below(0.5))
    yield Figure("steps", history["step"][-1])
    steps = numpy.diff(history["step"])
    yield Figure("ms per step", (history["ms_per_step"][1:] * steps).sum() / steps.sum())


def measure_pressure(size, run):
    for sensor in MEASURED:
        values, references = facts(smooth(*run.probe(sensor))), facts(measured(sensor))
        names = ("arrival [s]", "peak / rho g H", "impulse / rho g H [s]")
        for name, value, reference, part in zip(names, values, references, (ARRIVAL[size], None, IMPULSE[size])):
            limit = near(reference, part) if part else None
            yield Figure(f"{sensor}: {name}" + ("" if part else f", measured {reference:.3g}"), value, limit)


def measure_heights(size, run, spacing):
    for gauge, (x, references) in HEIGHTS.items():
        for time, reference in zip((0.5, 1.0, 1.5, 2.0), references):
            if time > END[size]:
                continue
            frame = min(run.frames(), key=lambda f: abs(f.time - time))
            limited = gauge == RESERVOIR
            name = f"{gauge}: height at {time} s [m]" + ("" if limited else f", measured {reference}")
            yield Figure(name, height(frame, x, spacing), near(reference, RESERVOIR_OFF[size]) if limited else None)


def draw(figure, runs):
    for axes, sensor in zip(figure.subplots(1, 2, sharey=True), MEASURED):
        for scheme, colour in (("classic", "tab:orange"), ("default", "tab:blue")):
            run = runs[scheme].done.get(name_of(SIZES[runs[scheme].size][-1])) if scheme in runs else None
            if run:
                curve = smooth(*run.probe(sensor))
                axes.plot(TIME, curve / HEAD, color=colour, lw=0.8, label=scheme)
        axes.plot(TIME, measured(sensor) / HEAD, "k-", lw=0.8, label="Kleefsman et al. 2005")
        axes.set(title=sensor, xlabel="t [s]", xlim=(0.3, 2), ylim=(-0.2, 2.8))
    figure.axes[0].set_ylabel("p / (rho g H)")
    figure.axes[0].legend(fontsize=7)
