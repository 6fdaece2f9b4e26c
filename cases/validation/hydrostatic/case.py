"""Still tanks: pressure, surface, and how calm they are."""
import math

import numpy

from figures import Figure, below, near

TITLE = "water at rest"
RHO, G, H = 1000.0, 9.81, 1.0
UNIT_TIME = math.sqrt(H / G)
UNIT_SPEED = math.sqrt(G * H)

# Particles over the depth; lengths of runs in sqrt(H/g); particles over the width of the 3-D column.
SIZES = {
    "full": {"rows": 50, "box": 200, "others": 50, "column": 10, "column_time": 20},
    "small": {"rows": 25, "box": 40, "others": 20, "column": 5, "column_time": 10},
}


def settings(runs, duration):
    spacing = H / SIZES[runs.size]["rows"]
    return {
        "mps.spacing": spacing,
        "mps.time_step": 0.1 * spacing,
        "time.end": duration * UNIT_TIME,
        "output.every_time": duration * UNIT_TIME / 50,
    }


def pressure_error(frame):
    """L2 over all particles, in parts of rho g H; the last axis points up."""
    exact = RHO * G * (H - frame.x[:, -1])
    return math.sqrt(numpy.mean((frame.p - exact) ** 2)) / (RHO * G * H)


def worst_pressure_error(run):
    """Of the second half of the run."""
    frames = run.frames()
    return max(pressure_error(frame) for frame in frames[len(frames) // 2 :])


def mean_height(frame):
    return frame.x[:, -1].mean()


def fastest(run, after=0.0):
    """The fastest particle at any time that was printed, in sqrt(gH)."""
    history = run.history()
    return history["umax"][history["time"] >= after].max() / UNIT_SPEED


def measure(runs):
    size = SIZES[runs.size]
    yield from measure_box(runs, size)
    yield from measure_jitter(runs, size)
    yield from measure_turned(runs, size)
    yield from measure_column(runs, size)
    yield from measure_plate(runs, size)


def measure_box(runs, size):
    run = runs.run("box", settings(runs, size["box"]))
    frames, spacing = run.frames(), H / size["rows"]
    drift = 2 * (mean_height(frames[-1]) - mean_height(frames[0])) / spacing
    yield Figure("box: L2(p) / rho g H", worst_pressure_error(run), below(0.005))
    yield Figure("box: drift of the surface / l0", drift, below(0.25))
    yield Figure("box: max speed / sqrt(gH)", fastest(run))


def measure_jitter(runs, size):
    run = runs.run("jitter", {**settings(runs, 1.5 * size["others"]), "fluid.0.jitter": 0.1})
    yield Figure("from disorder: max speed / sqrt(gH) after 20 sqrt(H/g)", fastest(run, 20 * UNIT_TIME), below(2e-3))
    yield Figure("from disorder: L2(p) / rho g H", worst_pressure_error(run), below(0.005))


def measure_turned(runs, size):
    run = runs.run("turned", settings(runs, size["others"]), "turned.toml")
    yield Figure("turned by 17 degrees: L2(p) / rho g H", worst_pressure_error(run), below(0.01))
    yield Figure("turned: max speed / sqrt(gH), second half", fastest(run, 0.5 * size["others"] * UNIT_TIME))


def measure_column(runs, size):
    width = size["column"] * H / size["rows"]
    shape = {
        "geometry.tank.max": [width, width, 1.2 * H],
        "fluid.0.region.max": [width, width, H],
    }
    run = runs.run("column_3d", {**settings(runs, size["column_time"]), **shape}, "column_3d.toml")
    yield Figure("3-D column: L2(p) / rho g H", worst_pressure_error(run), below(0.01))
    yield Figure("3-D column: max speed / sqrt(gH)", fastest(run))


def mean_load(run):
    """On the plate, of the second half of the run, in rho g H^2 / 2."""
    time, load = run.probe("load")
    return load[time > time[-1] / 2].mean() / (0.5 * RHO * G * H**2)


def measure_plate(runs, size):
    both = runs.run("plate", {**settings(runs, 20), "fluid.0.jitter": 0.1}, "plate.toml")
    yield Figure("plate, equal levels: net load / load of a side", mean_load(both), below(0.005))
    one = runs.run("plate_dry", {**settings(runs, 20), "fluid.0.region.max": [0.4, H]}, "plate.toml")
    yield Figure("plate, water on the left only: load / (rho g H^2 / 2)", mean_load(one), near(1, 0.01))


def draw(figure, runs):
    left, right = figure.subplots(1, 2)
    for scheme, colour in (("classic", "tab:orange"), ("default", "tab:blue")):
        if scheme not in runs or "box" not in runs[scheme].done:
            continue
        run = runs[scheme].run("box")
        last, history = run.frames()[-1], run.history()
        left.plot(last.p / (RHO * G * H), last.x[:, 1] / H, ".", ms=1.5, color=colour, label=scheme)
        right.semilogy(history["time"] / UNIT_TIME, history["umax"] / UNIT_SPEED + 1e-12, color=colour, label=scheme)
    left.plot((1, 0), (0, 1), "k-", lw=0.8, label="exact")
    left.set(xlabel="p / (rho g H), all particles at the end", ylabel="y / H")
    right.set(xlabel="t sqrt(g/H)", ylabel="fastest particle / sqrt(gH)", ylim=(1e-6, 1))
    left.legend(fontsize=8, markerscale=4)
