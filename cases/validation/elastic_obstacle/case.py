"""A dam break on an elastic obstacle: when and how far its top goes."""
import numpy

from figures import Figure, between

TITLE = "a dam break on an elastic obstacle"
SIZES = {"full": 0.002, "small": 0.004}  # spacing [m]
# First peaks of the top's way, read from the figures of others: m, s.
OTHERS = {
    "Idelsohn et al. 2008, PFEM": (0.0483, 0.260),
    "Bogaers et al. 2016, QN-LS": (0.0450, 0.232),
    "Liu et al. 2013, SPH": (0.0465, 0.253),
    "Sun et al. 2019, MPS-DEM": (0.0462, 0.217),
    "Meduri et al. 2018": (0.0491, 0.235),
    "Ryzhakov et al. 2010": (0.0410, 0.235),
}


def run_of(runs):
    spacing = SIZES[runs.size]
    return runs.run("obstacle", {"mps.spacing": spacing, "mps.time_step": 0.1 * spacing,
                                 "time.end": 0.5 if runs.size == "full" else 0.3})


def measure(runs):
    time, tip = run_of(runs).probe("tip")
    early = time < 0.3
    peak = numpy.argmax(tip[early])
    yield Figure("first peak of the top [m]", tip[peak], between(0.040, 0.050))
    yield Figure("its time [s]", time[peak], between(0.21, 0.27))
    yield Figure("first motion, 0.1 mm [s]", time[numpy.argmax(numpy.abs(tip) > 1e-4)])


def draw(figure, runs):
    axes = figure.subplots()
    for scheme, colour in (("classic", "tab:orange"), ("default", "tab:blue")):
        if scheme in runs and "obstacle" in runs[scheme].done:
            time, tip = run_of(runs[scheme]).probe("tip")
            axes.plot(time, 1e3 * tip, color=colour, lw=1, label=scheme)
    for name, (height, when) in OTHERS.items():
        axes.plot(when, 1e3 * height, "x", ms=6, label=name)
    axes.set(xlabel="t [s]", ylabel="top, along x [mm]")
    axes.legend(fontsize=7)
