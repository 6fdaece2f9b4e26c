"""A standing wave along x and y in a tank: period, and how much of the amplitude is left."""
import math

import numpy

from curves import crests, zero_crossings
from figures import Figure, below, near

TITLE = "a standing wave in 3-D"
G, DEPTH, AMPLITUDE = 9.81, 0.2, 0.01
LENGTH, WIDTH = 0.5, 0.4  # of the tank, half a wavelength along either
KX, KY = math.pi / LENGTH, math.pi / WIDTH
K = math.hypot(KX, KY)
PERIOD = 2 * math.pi / math.sqrt(G * K * math.tanh(K * DEPTH))
PERIODS = 5
SIZES = {"full": 20, "small": 10}  # depth / l0
# Limits; the small size has half the particles along the wave.
PERIOD_OFF = {"full": 0.01, "small": 0.02}
LOSS = {"full": 0.05, "small": 0.1}


def run_of(runs):
    spacing = DEPTH / SIZES[runs.size]
    settings = {
        "mps.spacing": spacing,
        "mps.time_step": 0.1 * spacing,
        "time.end": (PERIODS + 0.1) * PERIOD,
        "output.every_time": PERIOD / 40,
    }
    return runs.run("wave", settings), spacing


def first_mode(runs):
    """Times, and the part cos(kx x) cos(ky y) of the surface, in parts of a: the volume's moment, as in standing_wave."""
    run, spacing = run_of(runs)
    frames = run.frames()
    shapes = [numpy.cos(KX * frame.x[:, 0]) * numpy.cos(KY * frame.x[:, 1]) for frame in frames]
    mode = [shape.sum() * spacing**3 / (LENGTH * WIDTH / 4) for shape in shapes]
    return numpy.array([frame.time for frame in frames]), numpy.array(mode) / AMPLITUDE


def measure(runs):
    time, mode = first_mode(runs)
    zeros = zero_crossings(time, mode)
    when, height = crests(time, mode)
    period = 2 * (zeros[-1] - zeros[0]) / (len(zeros) - 1)
    rate = numpy.polyfit(when, numpy.log(height), 1)[0]
    yield Figure("period / period of linear theory", period / PERIOD, near(1, PERIOD_OFF[runs.size]))
    yield Figure("first crest / a", height[0])
    yield Figure(f"amplitude lost in {PERIODS} periods", 1 - math.exp(rate * PERIODS * PERIOD), below(LOSS[runs.size]))


def draw(figure, runs):
    axes = figure.subplots()
    for scheme, colour in (("classic", "tab:orange"), ("default", "tab:blue")):
        if scheme in runs and "wave" in runs[scheme].done:
            time, mode = first_mode(runs[scheme])
            axes.plot(time / PERIOD, mode, color=colour, lw=1, label=scheme)
    fine = numpy.linspace(0, PERIODS, 600)
    axes.plot(fine, numpy.sin(2 * math.pi * fine), "k--", lw=0.6, label="linear theory")
    axes.set(xlabel="t / T of linear theory", ylabel="first mode of the surface / a", xlim=(0, PERIODS), ylim=(-1.3, 1.6))
    axes.legend(fontsize=8, ncols=3, loc="upper right")
