"""The collapse of a column twice as high as wide: its front against measured ones, and how noisy the pressure is."""
import math

import numpy

from figures import Figure, at_most, below, near

TITLE = "collapse of a column of water"
RHO, G, A = 1000.0, 9.81, 0.2
HEAD = RHO * G * 2 * A
CLOCK = math.sqrt(2 * G / A)
SIZES = {"full": (25, 50, 100), "small": (25, 50)}  # a / l0
NOISE_ROWS = {"full": 50, "small": 20}
DIVISORS = {"full": (1, 2, 4), "small": (1, 4)}  # of the step

# t sqrt(2g/a), x/a; read off the figures. Koshizuka and Oka, Nucl. Sci. Eng. 123:421, 1996; Martin and Moyce, Phil. Trans.
# R. Soc. A 244:312, 1952 (n^2 = 2, a = 2.25 in).
KOSHIZUKA_OKA_MPS = ((0.778, 1.351), (1.095, 1.637), (1.381, 1.931), (1.684, 2.268), (2.043, 2.707), (2.278, 3.004))
KOSHIZUKA_OKA = ((1.153, 1.505), (1.537, 1.892), (1.935, 2.241), (2.323, 2.615), (2.719, 3.003))
MARTIN_MOYCE = ((1.219, 1.474), (1.997, 2.292), (2.547, 2.995))


def settings(rows, step):
    return {"mps.spacing": A / rows, "mps.time_step": step * A / rows}


def front_run(runs, rows):
    """The classic scheme's steps do not adapt: its C is a stiffness that goes with (spacing / dt)^2."""
    if runs.scheme == "classic":
        return runs.run(f"front_n{rows}", {**settings(rows, 0.115), "mps.adaptive": False})
    return runs.run(f"front_n{rows}", settings(rows, 0.1))


def front(run):
    time, x = run.probe("front")
    return time * CLOCK, numpy.maximum.accumulate(x / A)


def arrival(run, place):
    """When the front passes x/a = place, in sqrt(a/2g)."""
    time, x = front(run)
    i = int(numpy.argmax(x >= place))
    return time[i - 1] + (place - x[i - 1]) / (x[i] - x[i - 1]) * (time[i] - time[i - 1])


def worst_lead(run, measured):
    """Of our time over the measured one, less 1, at the measured places."""
    return max((arrival(run, place) / time - 1 for time, place in measured), key=abs)


def best_shift(run, measured):
    """The one shift in time [sqrt(a/2g)] after which our front is nearest to the measured places, and how near it is then
    at the worst of them: what is left of the difference when nobody knows when the gate let the water go."""
    time, x = front(run)
    t, place = numpy.array(measured).T
    shifts = numpy.arange(0, 0.6, 0.005)
    errors = [numpy.abs(numpy.interp(t - shift, time, x) / place - 1).max() for shift in shifts]
    best = int(numpy.argmin(errors))
    return shifts[best], errors[best]


def mean_speed(run, low, high):
    return (high - low) / (arrival(run, high) - arrival(run, low))


def noise(runs, divisor, begin=0.3, end=0.5):
    """Standard deviation of the pressure at the floor about its centred mean of 5 ms, in rho g H."""
    rows = NOISE_ROWS[runs.size]
    step = (0.115 if runs.scheme == "classic" else 0.05) / divisor
    given = {**settings(rows, step), "mps.adaptive": False, "time.end": 0.502}
    time, p = runs.run(f"noise_dt_{divisor}", given).probe("floor")
    rough = p - numpy.convolve(p, numpy.ones(5) / 5, mode="same")
    return rough[(time >= begin) & (time <= end)].std() / HEAD


def measure(runs):
    yield from measure_front(runs)
    yield from measure_noise(runs)


def measure_front(runs):
    finest = front_run(runs, SIZES[runs.size][-1])
    for name, measured in (("Koshizuka and Oka", KOSHIZUKA_OKA), ("Martin and Moyce", MARTIN_MOYCE)):
        # Missed as long as no gate is modelled; a test that always fails would hide the other figures.
        limit = below(0.1) if runs.size == "full" else None
        yield Figure(f"front: worst lead in time on {name}, measured", worst_lead(finest, measured), limit)
        shift, error = best_shift(finest, measured)
        yield Figure(f"front: its place, all moved by one time, off {name}", error, below(0.1))
        yield Figure(f"front: that time / sqrt(a/2g), {name}", shift)
    yield Figure("front: worst lead in time on Koshizuka and Oka, MPS", worst_lead(finest, KOSHIZUKA_OKA_MPS))
    (early, low), (late, high) = MARTIN_MOYCE[0], MARTIN_MOYCE[-1]
    speed, reference = mean_speed(finest, low, high), (high - low) / (late - early)
    name = f"front: mean speed from x/a = {low} to {high} / sqrt(2ga), Martin and Moyce"
    yield Figure(name, speed, near(reference, 0.05))
    for place in (2, 3):
        times = [arrival(front_run(runs, rows), place) for rows in SIZES[runs.size]]
        converged = 2 * times[-1] - times[-2]  # first order
        for rows, time in zip(SIZES[runs.size], times):
            limit = below(0.02) if rows == SIZES[runs.size][-1] else None
            yield Figure(f"front: time to x/a = {place}, a/l0 = {rows}, off its own limit", time / converged - 1, limit)


def measure_noise(runs):
    divisors = DIVISORS[runs.size]
    values = [noise(runs, divisor) for divisor in divisors]
    for divisor, value in zip(divisors, values):
        yield Figure(f"floor: noise 0.3 to 0.5 s / rho g H, dt / {divisor}", value)
    for divisor, value in zip(divisors[1:], values[1:]):
        yield Figure(f"floor: noise at dt / {divisor} over that at dt", value / values[0], at_most(1.25))
    yield Figure("floor: noise 0.05 to 0.25 s / rho g H, dt", noise(runs, 1, 0.05, 0.25))


def compare(default, classic):
    part = noise(default, 1) / noise(classic, 1)
    yield Figure("floor: noise 0.3 to 0.5 s over the classic scheme's", part, at_most(1 / 3))


def draw(figure, runs):
    axes, right = figure.subplots(1, 2)
    for scheme, colour in (("classic", "tab:orange"), ("default", "tab:blue")):
        if scheme not in runs:
            continue
        rows = SIZES[runs[scheme].size][-1]
        run = runs[scheme].done.get(f"front_n{rows}")
        if run:
            time, x = front(run)
            axes.plot(time[x < 3.1], x[x < 3.1], color=colour, label=f"{scheme}, a/l0 = {rows}")
        run = runs[scheme].done.get("noise_dt_1")
        if run:
            time, p = run.probe("floor")
            right.plot(time, p / HEAD, color=colour, lw=0.7, label=scheme)
    axes.plot(*zip(*KOSHIZUKA_OKA_MPS), "s", mfc="none", label="Koshizuka & Oka 1996, MPS")
    axes.plot(*zip(*KOSHIZUKA_OKA), "o", mfc="none", label="Koshizuka & Oka 1996, measured")
    axes.plot(*zip(*MARTIN_MOYCE), "^", mfc="none", label="Martin & Moyce 1952, measured")
    axes.set(xlabel="t sqrt(2g/a)", ylabel="front x/a")
    axes.legend(fontsize=7)
    right.set(xlabel="t [s]", ylabel="p / (rho g H) at the floor, x = a/2", ylim=(-0.2, 1.5))
