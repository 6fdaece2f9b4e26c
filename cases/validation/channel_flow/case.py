"""Poiseuille's and Couette's flow from rest, against their series."""
import math

import numpy

from figures import Figure, below

TITLE = "flow between plates from rest"
NU, WIDTH, DRAW, SLIDE = 1e-6, 1e-3, 1e-4, 1.25e-5  # m^2/s, m, m/s^2, m/s
LIMITED = ("default", "high")
SIZES = {"full": 50, "small": 20}  # particles across
TIMES = (0.0225, 0.045, 0.1125, 0.225, math.inf)  # of Morris, Fox and Zhu 1997 [s]; the run ends at 1.0125 s
L2_OFF = {"full": 0.01, "small": 0.02}  # the small size has 2.5 times the spacing


def poiseuille(y, t):
    u = DRAW * y * (WIDTH - y) / (2 * NU)
    for k in range(0 if t == math.inf else 100):
        m = (2 * k + 1) * math.pi / WIDTH
        u -= 4 * DRAW / (NU * WIDTH * m**3) * numpy.sin(m * y) * math.exp(-m * m * NU * t)
    return u


def couette(y, t):
    u = SLIDE * y / WIDTH
    for n in range(1, 1 if t == math.inf else 200):
        m = n * math.pi / WIDTH
        u += 2 * SLIDE / (n * math.pi) * (-1) ** n * numpy.sin(m * y) * math.exp(-m * m * NU * t)
    return u


EXACT = {"poiseuille": poiseuille, "couette": couette}


def run_of(runs, flow, jitter=0):
    spacing = WIDTH / SIZES[runs.size]
    name = flow + ("_shaken" if jitter else "")
    return runs.run(name, {"mps.spacing": spacing, "fluid.0.jitter": jitter}, file=f"{flow}.toml")


def frame_at(run, time):
    return min(run.frames(), key=lambda frame: abs(frame.time - min(time, 1.0125)))


def error_at(run, flow, time):
    frame = frame_at(run, time)
    exact = EXACT[flow](frame.x[:, 1].copy(), math.inf if time == math.inf else frame.time)
    return math.sqrt(((frame.u[:, 0] - exact) ** 2).sum() / (exact**2).sum())


def measure(runs):
    for flow in EXACT:
        run = run_of(runs, flow)
        for time in TIMES:
            when = "steady" if time == math.inf else f"t = {time} s"
            yield Figure(f"{flow}, {when}: L2 of u", error_at(run, flow, time), below(L2_OFF[runs.size]))
        if runs.size == "full":
            continue  # minutes each, and the small size tells
        shaken = run_of(runs, flow, 0.2)
        worst = max(error_at(shaken, flow, time) for time in TIMES)
        yield Figure(f"{flow}, particles shaken by 0.2 l0: worst L2 of u", worst)


def draw(figure, runs):
    for axes, flow in zip(figure.subplots(1, 2, sharey=True), EXACT):
        y = numpy.linspace(0, WIDTH, 200)
        for time in TIMES:
            axes.plot(EXACT[flow](y.copy(), time), y / WIDTH, "k-", lw=0.6)
            for scheme, colour in (("default", "tab:blue"), ("high", "tab:green")):
                if scheme in runs and flow in runs[scheme].done:
                    frame = frame_at(runs[scheme].done[flow], time)
                    axes.plot(frame.u[:, 0], frame.x[:, 1] / WIDTH, ".", ms=1, color=colour)
        axes.set(xlabel="u [m/s]", title=flow)
