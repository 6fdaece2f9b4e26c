"""A beam in a rolling tank of oil: the forcing's frequency, and the same motion by walls that move and by gravity that turns."""
import math

import numpy

from figures import Figure, below, near

TITLE = "an elastic beam in a rolling tank of oil"
ANGLE, PERIOD, HEIGHT, GROWTH = math.radians(3.97), 1.215, 0.1148, 0.4
SIZES = {"full": 12, "small": 0.35}  # periods
# Up to the first crest of the tip both ways have to agree. The small size ends before that, and only tells; the full one looks
# more closely, as the oil breaks over the tip: at the spacing of the case two runs that differ in round-off differ by 1.4 %.
AGREE = 0.02
FINE = {"mps.spacing": 0.003, "mps.time_step": 3e-4, "structure.0.fem.divisions": [2, 38], "time.end": 1.2}
FREQUENCY_OFF = 0.01


def angle_at(time):
    return ANGLE * numpy.sin(2 * math.pi / PERIOD * time) * (1 - numpy.exp(-((time / GROWTH) ** 2)))


def tip_in_tank(run, turns):
    """Time, and the tip's way along the tank's floor [m]."""
    time, x = run.probe("tip_x")
    _, y = run.probe("tip_y")
    if not turns:
        return time, x
    a = angle_at(time)
    return time, numpy.cos(a) * x + numpy.sin(a) * (HEIGHT + y)


def both(runs):
    settings = FINE if runs.size == "full" else {"time.end": SIZES["small"] * PERIOD}
    return (tip_in_tank(runs.run("walls_closely" if runs.size == "full" else "walls", settings), True),
            tip_in_tank(runs.run("frame", settings, file="frame.toml"), False))


def long_run(runs):
    return tip_in_tank(runs.run("walls", {"time.end": SIZES[runs.size] * PERIOD}), True)


def first_crest(time, tip):
    """The first extremum that is more than half of the first period's largest."""
    early = tip[time < PERIOD]
    return int(numpy.argmax(numpy.abs(early)))


def strongest_frequency(time, tip):
    """Of the second half of the run, by the best fit of a sine: in the first periods the tank is still starting."""
    part = time > time[-1] / 2
    best = None
    for frequency in numpy.linspace(0.8, 1.2, 401) / PERIOD:
        phase = 2 * math.pi * frequency * time[part]
        basis = numpy.stack([numpy.sin(phase), numpy.cos(phase), numpy.ones(len(phase))], axis=1)
        left = numpy.linalg.lstsq(basis, tip[part], rcond=None)[1]
        if best is None or left[0] < best[0]:
            best = (left[0], frequency)
    return best[1]


def measure(runs):
    (time, walls), (_, frame) = both(runs)
    count = min(len(walls), len(frame))
    crest = first_crest(time, walls)
    off = numpy.abs(walls[:count] - frame[:count])[: crest + 1].max() / abs(walls[crest])
    yield Figure("first crest of the tip [m]", walls[crest])
    yield Figure("its time [s]", time[crest])
    yield Figure("moving walls against turning gravity, up to there / crest", off,
                 below(AGREE) if runs.size == "full" else None)
    if runs.size == "full":
        yield Figure("frequency of the tip / that of the tank", strongest_frequency(*long_run(runs)) * PERIOD,
                     near(1, FREQUENCY_OFF))


def draw(figure, runs):
    axes = figure.subplots()
    if "default" in runs and "walls" in runs["default"].done:
        (time, walls), (again, frame) = both(runs["default"])
        if runs["default"].size == "full":
            axes.plot(*scaled(long_run(runs["default"])), color="tab:gray", lw=0.6, label="for long")
        axes.plot(*scaled((time, walls)), color="tab:blue", lw=1, label="walls that move")
        axes.plot(*scaled((again, frame)), color="tab:green", lw=0.8, ls="--", label="gravity that turns")
    axes.set(xlabel="t [s]", ylabel="tip along the floor [mm]")
    axes.legend(fontsize=8)


def scaled(tip):
    return tip[0], 1e3 * tip[1]
