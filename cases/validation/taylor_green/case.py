"""Taylor-Green vortices: how fast they decay, at which order of the spacing, and whether they last where hardly anything damps."""
import math

import numpy

from figures import Figure, at_least, below, near

TITLE = "Taylor-Green vortices"
LIMITED = ("default", "high")
SIZES = {"full": (25, 50, 100), "small": (25, 50)}  # L / l0
LONG = {"full": 50, "small": 25}  # L / l0 of the run at Re = 1000
RATE_OFF = {"default": 0.01, "high": 0.003, "classic": 0.01}  # at L / l0 = 50
ORDER = {"default": 1.0, "high": 1.8, "classic": 1.0}


def run_of(runs, cells, name="re100", nu=0.01, more=None):
    spacing = 1 / cells
    settings = {"mps.spacing": spacing, "mps.time_step": 0.25 * spacing, "effects.viscosity.kinematic": nu}
    return runs.run(f"{name}_n{cells}", {**settings, **(more or {})})


def exact_rate(nu):
    """Of the kinetic energy [1/s]."""
    return 16 * math.pi**2 * nu


def rate_of(run, nu):
    """Slope of ln E over the whole run, over the exact one."""
    history = run.history()
    return -numpy.polyfit(history["time"], numpy.log(history["E_kin"]), 1)[0] / exact_rate(nu)


def velocity_error(run, nu):
    """Root mean square at the end, over that of the exact flow."""
    frame = run.frames()[-1]
    x, y = 2 * math.pi * frame.x.T
    speed = math.exp(-exact_rate(nu) / 2 * frame.time)
    exact = speed * numpy.stack([-numpy.cos(x) * numpy.sin(y), numpy.sin(x) * numpy.cos(y)], axis=1)
    return math.sqrt(((frame.u - exact) ** 2).sum() / (exact**2).sum())


def order_of(sizes, errors):
    return -numpy.polyfit(numpy.log(sizes), numpy.log(numpy.abs(errors)), 1)[0]


def measure(runs):
    sizes = SIZES[runs.size]
    rates, errors = [], []
    for cells in sizes:
        run = run_of(runs, cells)
        rates.append(rate_of(run, 0.01))
        errors.append(velocity_error(run, 0.01))
        limit = near(1, RATE_OFF[runs.scheme]) if cells == 50 else None
        yield Figure(f"Re 100, L/l0 = {cells}: rate of decay / exact", rates[-1], limit)
        yield Figure(f"Re 100, L/l0 = {cells}: rms error of u after L/U", errors[-1])
    order = at_least(ORDER[runs.scheme])
    yield Figure("order of the error of the rate", order_of(sizes, numpy.array(rates) - 1), order)
    yield Figure("order of the error of u", order_of(sizes, errors), order)
    lattice = run_of(runs, 50, "lattice", more={"fluid.0.jitter": 0})
    yield Figure("L/l0 = 50 from the lattice: rate of decay / exact", rate_of(lattice, 0.01))
    yield from measure_long(runs)


def measure_long(runs):
    run = run_of(runs, LONG[runs.size], "re1000", 0.001, {"time.end": 5})
    history = run.history()
    energy = history["E_kin"] / history["E_kin"][0]
    lowest = numpy.minimum.accumulate(energy)
    yield Figure("Re 1000 to t U/L = 5: largest rise of E / E0", (energy - lowest).max(), below(1e-3))
    yield Figure("Re 1000 to t U/L = 5: rms error of n", history["n_err"][-1], below(0.02))
    yield Figure("Re 1000 to t U/L = 5: rate of decay / exact", rate_of(run, 0.001))


def draw(figure, runs):
    axes = figure.subplots()
    for scheme, colour in (("classic", "tab:orange"), ("default", "tab:blue"), ("high", "tab:green")):
        for cells in SIZES["full"]:
            name = f"re100_n{cells}"
            if scheme not in runs or name not in runs[scheme].done:
                continue
            history = runs[scheme].done[name].history()
            part = history["E_kin"] / history["E_kin"][0] * numpy.exp(exact_rate(0.01) * history["time"])
            axes.plot(history["time"], part, color=colour, lw=0.5 + cells / 50, label=f"{scheme}, L/l0 = {cells}")
    axes.axhline(1, color="black", lw=0.6, ls="--")
    axes.set(xlabel="t U / L", ylabel="kinetic energy / exact", xlim=(0, 1))
    axes.legend(fontsize=7)
