#!/usr/bin/env python3
"""What each choice changes in the paper's elastic case: one knob at a time at 2 mm, and the two runs at 1 mm.

    cases/dam_break_elastic/study.py                 # runs what is missing, prints the tables
    cases/dam_break_elastic/study.py --write         # and puts them, and the pictures, into docs/

Finished runs are kept in runs/study and read again as long as program, case and settings are the same: a study that was
stopped goes on where it was. Exit code 1: a run failed that should not.
"""
import argparse
import importlib.util
import os
import re
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
sys.path[:0] = [str(HERE), str(HERE.parent / "validation")]

KNOB_SPACING = 0.002
# The paper's step over its spacing, as C is a stiffness that goes with (spacing / step)^2.
# To 0.36 s: both peaks are over by then, also behind the gate.
AT_2_MM = {"mps.spacing": KNOB_SPACING, "mps.time_step": 0.00023, "structure.0.fem.divisions": [1, 50, 1],
           "time.end": 0.36}
BEST = {**AT_2_MM, "mps.expected_particles": 0, "structure.0.fem.time_step": 0.0}
PAPER = {**BEST, "structure.0.fem.expected_nodes": 0, "structure.0.fem.expected_elements": 0}
TILT = "structure.0.angle"
# name, what it is, case, settings, whether it may fail
KNOBS = (
    ("base", "best.toml at 2 mm", "best.toml", BEST, False),
    ("full", "plain hexahedra", "best.toml", {**BEST, "structure.0.fem.element": "full"}, False),
    ("aitken", "repeated, with Aitken's relaxation", "best.toml", {**BEST, "coupling.scheme": "aitken"}, False),
    ("staggered", "staggered", "best.toml", {**BEST, "coupling.scheme": "staggered"}, True),
    ("gate", "gate pulled up", "gate.toml", AT_2_MM, False),
    ("tilt1", "leans by 1 degree", "best.toml", {**BEST, TILT: 0.0174533}, False),
    ("tilt2", "leans by 2 degrees", "best.toml", {**BEST, TILT: 0.0349066}, False),
    ("tilt3", "leans by 3 degrees", "best.toml", {**BEST, TILT: 0.0523599}, False),
    ("undamped", "alpha = 0", "best.toml", {**BEST, "structure.0.fem.damping_alpha": 0.0}, False),
    ("paper", "paper.toml at 2 mm: C = 1.05", "paper.toml", PAPER, True),
    ("paper_c1", "paper.toml at 2 mm, C = 1", "paper.toml", {**PAPER, "mps.multiplication_coefficient": 1.0}, True),
)
LARGE = (
    ("best_1mm", "best.toml", "best.toml", {}, False),
    ("paper_1mm", "paper.toml", "paper.toml", {}, True),
)
HEAD = ("run", "front at plate [s]", "load n1 [s]", "load n1 [Pa]", "raw [s]", "raw [Pa]", "tip n5 [s]", "tip n5 [mm]", "")


def row_of(title, run, note, peaks):
    if run is None:
        return [title] + [""] * 7 + [note]
    p = peaks(run)
    return [title, f"{p['front']:.4f}", f"{p['load_time']:.4f}", f"{p['load']:.0f}", f"{p['raw_load_time']:.4f}",
            f"{p['raw_load']:.0f}", f"{p['tip_time']:.4f}", f"{1e3 * p['tip']:.3f}", note]


def printed_row():
    from peaks import PAPER_DISPLACEMENT, PAPER_LOAD

    return ["the paper", "", f"{PAPER_LOAD:.3f}", "", "", "", f"{PAPER_DISPLACEMENT:.3f}", "", ""]


def table(rows):
    lines = ["| " + " | ".join(row) + " |" for row in [HEAD, *rows]]
    lines.insert(1, "|---|" + "---:|" * 7 + "---|")
    return "\n".join(lines)


def in_words(run, p, end, tells_costs):
    """What a reader has to know of a run beside its figures."""
    from peaks import costs, history

    words = []
    if tells_costs:
        c = costs(run)
        words.append(f"{c['seconds']:.0f} s: fluid {100 * c['fluid']:.0f}, structure {100 * c['structures']:.0f}, "
                     f"coupling {100 * c['coupling']:.0f} %")
    lost = history(run)["lost"][-1]
    if lost > 0:
        words.append(f"{lost:.0f} particles lost")
    if p["end"] < 0.99 * end:
        words.append(f"ended at {p['end']:.3f} s")
    return ", ".join(words)


def carry_out(runs, plan, end, tells_costs):
    """Rows of the table, and the runs by name."""
    from peaks import peaks
    from runs import Run, RunFailed

    rows, done, failed = [], {}, False
    for name, title, file, settings, may_fail in plan:
        try:
            run, note = runs.run(name, settings, file=file), ""
        except RunFailed as failure:
            run, note = Run(runs.folder / name), "failed: " + str(failure).split("error:")[-1].strip()[:120]
            failed = failed or not may_fail
        done[name] = run
        try:
            note = note or in_words(run.folder, peaks(run.folder), end, tells_costs)
            rows.append(row_of(title, run.folder, note, peaks))
        except (OSError, IndexError):
            rows.append(row_of(title, None, note, peaks))
    return rows, done, failed


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    program = os.environ.get("GREENWATER_PROGRAM", ROOT / "build/openmp/app/greenwater")
    parser.add_argument("--program", type=Path, default=program, metavar="PATH", help="default: %(default)s")
    parser.add_argument("--keep", type=Path, default=ROOT / "runs/study", metavar="DIR", help="default: %(default)s")
    parser.add_argument("--only", choices=("knobs", "large"), help="a part of it")
    parser.add_argument("--write", action="store_true", help="write tables into docs/paper.md, and the pictures")
    options = parser.parse_args()
    need_numpy()
    from runs import Runs

    runs = Runs(options.program, HERE, options.keep, "full", "default")
    failed = False
    for part, plan, end, tells_costs in (("large", LARGE, 0.5, True), ("knobs", KNOBS, 0.36, False)):
        if options.only not in (None, part):
            continue
        rows, done, broken = carry_out(runs, plan, end, tells_costs)
        if part == "large":
            rows.append(printed_row())
        failed = failed or broken
        print(table(rows), "\n")
        if options.write:
            put(ROOT / "docs/paper.md", part, table(rows))
        if options.write and part == "large":
            import pictures

            pictures.draw_all(done["paper_1mm"].folder, done["best_1mm"].folder, ROOT / "docs/images")
    return 1 if failed else 0


def put(page, name, text):
    """Between the marks of that name."""
    marks = f"<!-- {name}: written by cases/dam_break_elastic/study.py -->", f"<!-- end of {name} -->"
    whole = page.read_text()
    pattern = re.compile(re.escape(marks[0]) + ".*?" + re.escape(marks[1]), re.DOTALL)
    page.write_text(pattern.sub(lambda _: f"{marks[0]}\n{text}\n{marks[1]}", whole))


def need_numpy():
    """Goes on with Debian's Python where this one lacks what is needed."""
    if importlib.util.find_spec("numpy") and importlib.util.find_spec("h5py"):
        return
    debian = "/usr/bin/python3"
    if os.access(debian, os.X_OK) and "GREENWATER_SECOND_PYTHON" not in os.environ:
        os.environ["GREENWATER_SECOND_PYTHON"] = "1"
        os.execv(debian, [debian, *sys.argv])
    sys.exit("needs the Debian packages python3-numpy and python3-h5py: run scripts/setup")


if __name__ == "__main__":
    sys.exit(main())
