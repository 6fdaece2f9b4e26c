"""A dam break onto a square column: the net force along the tank, and the speed of the water before the column."""
import numpy

from curves import averaged, impact
from figures import Figure, below, near

TITLE = "a dam break onto a square column"
SIZES = {"full": 0.01, "small": 0.02}  # l0 [m]
END = {"full": 1.4, "small": 0.7}  # [s]
MEAN = 0.02  # measured and computed force are averaged over so much time [s]
ARRIVED = 10.0  # the mean force [N] that counts as arrival
IMPULSE_TIME = 0.3  # the impulse is counted from arrival for so long [s]
# Parts of the measured figures. When the water comes is not held to any: the floor was wet, and here it is dry.
IMPULSE, SPEED_OFF = {"full": 0.15, "small": 0.2}, {"full": 0.1, "small": 0.15}
FIRST = 0.15  # speeds nearer to the arrival than this are only told [s]
POINT = numpy.array((0.814, 0.3, 0.026))  # where the speed was measured [m]
COLUMN = numpy.array(((0.9, 0.24, 0.0), (1.02, 0.36, 0.75)))  # two corners [m]
REACH = 1.5  # x spacing: particles nearer to the point tell the speed there

# t [s], force along the tank [N]; thinned from what was read off the figure of P. E. Raad and R. Bidoae, J. Comput. Phys.
# 203:668, 2005.
FORCE = ((0.0, 0.0), (0.327, 0.089), (0.343, 4.375), (0.355, 8.036), (0.363, 16.696), (0.371, 21.518), (0.382, 26.161),
         (0.390, 30.804), (0.396, 33.125), (0.429, 32.054), (0.441, 24.911), (0.453, 24.554), (0.476, 21.696),
         (0.500, 18.125), (0.539, 19.554), (0.571, 17.589), (0.618, 17.946), (0.661, 18.125), (0.710, 17.143),
         (0.755, 16.250), (0.810, 15.268), (0.865, 15.536), (0.912, 12.589), (0.963, 9.554), (1.018, 8.839), (1.076, 7.232),
         (1.139, 5.268), (1.227, 4.018), (1.316, 2.768), (1.418, 0.268))
# Time after the water has come to the point [s], speed along the tank [m/s]: means over 0.05 s on either side of what was
# read off the same paper's figure. The record begins with the water; how long after the gate that was is not known.
SPEED = ((0.1, 1.71), (0.2, 1.51), (0.3, 1.37), (0.4, 1.22), (0.5, 1.03))
TIME = numpy.arange(0, 1.4, 0.001)


def run_of(runs):
    spacing = SIZES[runs.size]
    given = {"mps.spacing": spacing, "mps.time_step": 0.1 * spacing, "time.end": END[runs.size]}
    if runs.scheme == "classic":
        given |= {"mps.time_step": 0.115 * spacing, "mps.adaptive": False, "probe.1.reading": "average"}
    return runs.run("column", given)


def smooth(time, force):
    return averaged(time, force, TIME, MEAN)


def facts(curve):
    """Arrival [s], peak [N], impulse [N s]; nan where the curve never arrives."""
    return impact(TIME, curve, ARRIVED, IMPULSE_TIME)


def speeds(run, spacing):
    """Times after the first frame with water at the point, and the mean speed of the particles about it."""
    time, speed = [], []
    for frame in run.frames():
        about = ((frame.x - POINT) ** 2).sum(axis=1) < (REACH * spacing) ** 2
        if about.any():
            time.append(frame.time)
            speed.append(frame.u[about, 0].mean())
    return numpy.array(time) - time[0], numpy.array(speed)


def in_the_column(frame):
    return ((COLUMN[0] < frame.x) & (frame.x < COLUMN[1])).all(axis=1).sum()


def measure(runs):
    run = run_of(runs)
    computed, measured = facts(smooth(*run.probe("force"))), facts(smooth(*zip(*FORCE)))
    names = ("arrival [s]", "peak [N]", "impulse [N s]")
    for name, value, reference, part in zip(names, computed, measured, (None, None, IMPULSE[runs.size])):
        limit = near(reference, part) if part else None
        yield Figure(f"force: {name}" + ("" if part else f", measured {reference:.3g}"), value, limit)
    if runs.scheme == "default":
        reaction = facts(smooth(*run.probe("reaction")))
        yield Figure("impulse of the reaction / that of the fitted pressure", reaction[2] / computed[2], near(1, 0.05))
    time, speed = speeds(run, SIZES[runs.size])
    for after, reference in SPEED:
        limit = near(reference, SPEED_OFF[runs.size]) if after > FIRST else None
        name = f"speed {after} s after its arrival [m/s]" + ("" if limit else f", measured {reference}")
        yield Figure(name, numpy.interp(after, time, speed), limit)
    yield Figure("particles lost", run.history()["lost"][-1], below(0.5))
    yield Figure("most particles in the column at any frame", max(in_the_column(f) for f in run.frames()), below(0.5))


def draw(figure, runs):
    left, right = figure.subplots(1, 2)
    for scheme, colour in (("classic", "tab:orange"), ("default", "tab:blue")):
        run = runs[scheme].done.get("column") if scheme in runs else None
        if run:
            left.plot(TIME, smooth(*run.probe("force")), color=colour, lw=0.8, label=scheme)
            right.plot(*speeds(run, SIZES[runs[scheme].size]), color=colour, lw=0.8, label=scheme)
    left.plot(TIME, smooth(*zip(*FORCE)), "k-", lw=0.8, label="Yeh and Petroff")
    right.plot(*zip(*SPEED), "ko", mfc="none", label="Yeh and Petroff")
    left.set(xlabel="t [s]", ylabel="force on the column [N]", xlim=(0.2, 1.4), ylim=(-20, 50))
    right.set(xlabel="time after the water has come [s]", ylabel="speed before the column [m/s]", xlim=(0, 0.7))
    left.legend(fontsize=7)
