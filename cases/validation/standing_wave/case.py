"""Half a standing wave in a tank: period, and how much of the amplitude is left."""
import math

import numpy

from curves import crests, zero_crossings
from figures import Figure, below, near

TITLE = "a standing wave"
G, DEPTH, WIDTH, AMPLITUDE = 9.81, 0.5, 0.5, 0.025
K = math.pi / WIDTH
PERIOD = 2 * math.pi / math.sqrt(G * K * math.tanh(K * DEPTH))
PERIODS = 10
SIZES = {"full": 50, "small": 25}  # depth / l0; the wave is twice as long
# Limits; the small size has half the particles along the wave, and both errors are of first order in the spacing.
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
    """Times, and the part cos(k x) of the surface, in parts of a: the area's moment, so that no surface is looked for."""
    run, spacing = run_of(runs)
    frames = run.frames()
    mode = [numpy.cos(K * frame.x[:, 0]).sum() * spacing**2 / (WIDTH / 2) for frame in frames]
    return numpy.array([frame.time for frame in frames]), numpy.array(mode) / AMPLITUDE


def measure(runs):
    time, mode = first_mode(runs)
    zeros = zero_crossings(time, mode)
    when, height = crests(time, mode)
    period = 2 * (zeros[-1] - zeros[0]) / (len(zeros) - 1)
    rate = numpy.polyfit(when, numpy.log(height), 1)[0]
    yield Figure("period / period of linear theory", period / PERIOD, near(1, PERIOD_OFF[runs.size]))
    yield Figure("the same by second order, 1 + (k a)^2 / 8", 1 + (K * AMPLITUDE) ** 2 / 8)
    yield Figure("first crest / a", height[0])
    yield Figure("amplitude lost in 10 periods", 1 - math.exp(rate * PERIODS * PERIOD), below(LOSS[runs.size]))


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
