"""A block of water, length L along its speed U and height H, meets a flat wall over all of its height.

At the instant of impact potential flow loses the part 8 (H/L) sum over odd n of tanh(n pi L/H) / (n pi)^3 of the kinetic
energy: the pressure impulse solves Laplace's equation with q = 0 on the free sides. A projection has to get it in its
first step.
"""
import math

from figures import Figure, between, near

TITLE = "a block of water against a flat wall"
LENGTHS = (0.5, 1.0, 2.0)  # L / H
SIZES = {"full": (26, 50, 100), "small": (26, 50)}  # H / l0; even, as half of it must be whole rows too
LIMIT = {"full": 0.03, "small": 0.06}  # at the finest; the error is first order, and small has half the particles


def exact(length):
    terms = (math.tanh(n * math.pi * length) / (n * math.pi) ** 3 for n in range(1, 2001, 2))
    return 8 / length * sum(terms)


def loss(runs, length, rows):
    """Part of the kinetic energy that the first step takes; it moves the water by a hundredth of a spacing."""
    spacing = 1 / rows
    step = 0.01 * spacing
    settings = {
        "mps.spacing": spacing,
        "mps.time_step": step,
        "time.end": step,
        "output.every_time": step,
        "fluid.0.region.max": [length, 1.0],
    }
    energy = runs.run(f"L{length:g}_n{rows}", settings).history()["E_kin"]
    return 1 - energy[-1] / energy[0]


def order(runs, losses, length):
    """Of the error, between the two finest."""
    errors = [abs(1 - value / exact(length)) for value in losses[-2:]]
    rows = SIZES[runs.size][-2:]
    return math.log(errors[0] / errors[1]) / math.log(rows[1] / rows[0])


def measure(runs):
    for length in LENGTHS:
        losses = [loss(runs, length, rows) for rows in SIZES[runs.size]]
        for rows, value in zip(SIZES[runs.size], losses):
            finest = rows == SIZES[runs.size][-1]
            limit = near(exact(length), LIMIT[runs.size]) if finest else None
            yield Figure(f"L/H = {length:g}: energy lost at once, H/l0 = {rows}", value, limit)
        yield Figure(f"L/H = {length:g}: order of the error", order(runs, losses, length), between(0.7, 2.5))


def draw(figure, runs):
    left, right = figure.subplots(1, 2)
    lengths = [0.3 + 0.02 * i for i in range(110)]
    left.plot(lengths, [exact(length) for length in lengths], "k-", lw=0.8, label="potential flow")
    for scheme, mark in (("classic", "s"), ("default", "o")):
        if scheme not in runs or not runs[scheme].done:
            continue
        rows = SIZES[runs[scheme].size]
        left.plot(LENGTHS, [loss(runs[scheme], length, rows[-1]) for length in LENGTHS], mark, mfc="none", label=scheme)
        for length in LENGTHS:
            errors = [abs(1 - loss(runs[scheme], length, n) / exact(length)) for n in rows]
            right.loglog(rows, errors, mark + "-", mfc="none", label=f"{scheme}, L/H = {length:g}")
    right.loglog(rows, [1.5 / n for n in rows], "k--", lw=0.8, label="first order")
    left.set(xlabel="L / H", ylabel="part of the energy lost at once", ylim=(0, None))
    right.set(xlabel="H / l0", ylabel="relative error")
    left.legend(fontsize=8)
    right.legend(fontsize=6)
