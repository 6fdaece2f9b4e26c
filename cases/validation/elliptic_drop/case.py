"""The stretching drop: it stays an ellipse of constant area, and its axes follow an ordinary differential equation."""
import math

from figures import Figure, below, near

TITLE = "a stretching drop"
A0, R = 100.0, 1.0
TIMES = (0.0076, 0.008)  # [s]
SIZES = {"full": (50, 100), "small": (25,)}  # R / l0
AXIS = {"full": 0.005, "small": 0.01}  # part of the axis; small has half the particles
ENERGY = {"full": 0.01, "small": 0.02}


def exact_axis(end, steps=2000):
    """b(end): b' = A b, A' = A^2 (a^4 - 1) / (a^4 + 1) with a = 1 / b and R = 1; Runge and Kutta's fourth order."""

    def rate(b, strain):
        return strain * b, strain**2 * (b**-4 - 1) / (b**-4 + 1)

    b, strain, h = 1.0, A0, end / steps
    for _ in range(steps):
        k1 = rate(b, strain)
        k2 = rate(b + h / 2 * k1[0], strain + h / 2 * k1[1])
        k3 = rate(b + h / 2 * k2[0], strain + h / 2 * k2[1])
        k4 = rate(b + h * k3[0], strain + h * k3[1])
        b += h / 6 * (k1[0] + 2 * k2[0] + 2 * k3[0] + k4[0])
        strain += h / 6 * (k1[1] + 2 * k2[1] + 2 * k3[1] + k4[1])
    return b


def run_of(runs, rows):
    spacing = R / rows
    given = {"mps.spacing": spacing, "mps.time_step": 0.25 * spacing / (A0 * R)}
    if runs.scheme == "classic":
        # C = 1.05 lets sound travel at about 9 spacings a step, which must be fast beside the water.
        given |= {"mps.time_step": 0.05 * spacing / (A0 * R), "mps.adaptive": False}
    return runs.run(f"n{rows}", given)


def axis_by_moments(frame, first):
    return R * math.sqrt((frame.x[:, 1] ** 2).mean() / (first.x[:, 1] ** 2).mean())


def kinetic_energy(frame):
    return (frame.u**2).sum()


def measure(runs):
    for rows in SIZES[runs.size]:
        yield from measure_at(runs, rows)


def measure_at(runs, rows):
    name = f"R/l0 = {rows}: "
    frames = run_of(runs, rows).frames()
    for time in TIMES:
        frame = min(frames, key=lambda f: abs(f.time - time))
        exact = exact_axis(frame.time)
        axis = axis_by_moments(frame, frames[0])
        extent = (frame.x[:, 1].max() - frame.x[:, 1].min() + R / rows) / 2
        yield Figure(f"{name}axis / exact at {time} s, by moments", axis / exact, near(1, AXIS[runs.size]))
        yield Figure(f"{name}axis / exact at {time} s, by extent", extent / exact)
    loss = 1 - kinetic_energy(frames[-1]) / kinetic_energy(frames[0])
    yield Figure(name + "kinetic energy lost to 0.008 s", loss, below(ENERGY[runs.size]))


def draw(figure, runs):
    from matplotlib.patches import Ellipse

    left, right = figure.subplots(1, 2)
    for scheme, colour in (("classic", "tab:orange"), ("default", "tab:blue")):
        if scheme not in runs:
            continue
        run = runs[scheme].done.get(f"n{SIZES[runs[scheme].size][0]}")
        if run is None:
            continue
        frames = run.frames()
        left.plot(*frames[-1].x.T, ",", color=colour)
        axes = [axis_by_moments(frame, frames[0]) for frame in frames]
        right.plot([1e3 * frame.time for frame in frames], axes, "o", mfc="none", color=colour, label=scheme)
    b = exact_axis(frames[-1].time)
    left.add_patch(Ellipse((0, 0), 2 / b, 2 * b, fill=False))
    left.set(aspect="equal", xlim=(-1.2, 1.2), ylim=(-2.2, 2.2), title=f"t = {frames[-1].time:.4f} s")
    times = [0.0002 * i for i in range(41)]
    right.plot([1e3 * time for time in times], [exact_axis(time, 200) for time in times], "k-", lw=0.8, label="exact")
    right.set(xlabel="t [ms]", ylabel="half axis along y [m]")
    right.legend(fontsize=8)
