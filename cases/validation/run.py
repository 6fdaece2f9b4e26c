#!/usr/bin/env python3
"""Runs a validation case, measures it, and compares the figures with their limits.

The limits are for the default scheme, and for others that a case names in LIMITED; figures of further schemes only stand
beside. Exit code 1: a limit is missed; 2: wrong use, or a package is missing.
"""
import argparse
import importlib.util
import os
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent


def missing_packages(with_pictures):
    """The Debian packages that this Python lacks."""
    modules = {"numpy": "python3-numpy", "h5py": "python3-h5py"}
    if with_pictures:
        modules["matplotlib"] = "python3-matplotlib"
    return [package for module, package in modules.items() if importlib.util.find_spec(module) is None]


def need_packages(with_pictures):
    """Goes on with Debian's Python where this one lacks what is needed and that one may have it."""
    missing = missing_packages(with_pictures)
    if not missing:
        return
    debian = "/usr/bin/python3"
    if os.access(debian, os.X_OK) and "GREENWATER_SECOND_PYTHON" not in os.environ:
        os.environ["GREENWATER_SECOND_PYTHON"] = "1"
        os.execv(debian, [debian, *sys.argv])
    print(f"{sys.executable} lacks what the Debian packages {' '.join(missing)} bring: run scripts/setup", file=sys.stderr)
    sys.exit(2)


def case_names():
    return sorted(path.parent.name for path in HERE.glob("*/case.py"))


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("case", choices=case_names())
    parser.add_argument("--size", choices=("small", "full"), default="small")
    parser.add_argument(
        "--scheme",
        choices=("default", "high", "classic", "limited", "all"),
        default="all",
        help="limited: those that the case has limits for",
    )
    program = os.environ.get("GREENWATER_PROGRAM", ROOT / "build/openmp/app/greenwater")
    parser.add_argument("--program", type=Path, default=program, metavar="PATH", help="default: %(default)s")
    parser.add_argument("--keep", type=Path, metavar="DIR", help="keep the runs here, and read what is here already")
    parser.add_argument("--write", action="store_true", help="write the table into README.md, and picture.png")
    return parser.parse_args()


def load_case(name):
    spec = importlib.util.spec_from_file_location(name, HERE / name / "case.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def measure(case, runs):
    """The figures of one scheme, and a note if a run failed on the way: what was measured before it counts."""
    from runs import RunFailed

    figures, notes = [], []
    try:
        for figure in case.measure(runs):
            figures.append(figure)
    except RunFailed as failure:
        notes.append(f"Scheme {runs.scheme}, run {failure}")
    return figures, notes


def limited_schemes(case):
    return getattr(case, "LIMITED", ("default",))


def schemes_of(choice, case):
    return {"all": ("default", "high", "classic"), "limited": limited_schemes(case)}.get(choice, (choice,))


def report(options, case, runs, measured):
    """Prints the table, writes the page if asked for; whether all went well."""
    import figures
    import page

    first = next(iter(measured))
    chosen = measured[first][0]
    beside = {scheme: found for scheme, (found, _) in measured.items() if scheme != first}
    notes = [note for _, found in measured.values() for note in found]
    if "default" in measured and "classic" in measured and not notes and hasattr(case, "compare"):
        chosen += case.compare(runs["default"], runs["classic"])
    limited = limited_schemes(case)
    missed = {
        scheme: [figure.name for figure in found if figure.misses()] for scheme, (found, _) in measured.items() if scheme in limited
    }
    for scheme, names in missed.items():
        if scheme != first and names:
            notes.append(f"Scheme {scheme} misses its limit: {'; '.join(names)}.")
    if first not in limited:
        for figure in chosen:
            figure.limit = None
    rows = figures.table(chosen, beside)
    print(f"{options.case}: {case.TITLE} ({options.size})")
    print("\n".join([figures.as_columns(rows), *notes]))
    if options.write and not runs[first].done:
        print(f"README.md stays as it is: no run of scheme {first} came to its end.")
    elif options.write:
        folder = HERE / options.case
        any_run = next(iter(runs[first].done.values()))
        command = f"cases/validation/run.py {options.case} --size {options.size}"
        page.write_table(folder / "README.md", rows, page.origin(any_run.manifest(), command), notes)
        page.draw_picture(folder / "picture.png", case.draw, runs)
    return not any(missed.values()) and not any(measured[scheme][1] for scheme in missed)


def main():
    options = arguments()
    need_packages(options.write)
    if not os.access(options.program, os.X_OK):
        sys.exit(f"there is no program {options.program}: build it (scripts/run, scripts/test), or name it with --program")
    sys.path.insert(0, str(HERE))
    from runs import Runs

    case = load_case(options.case)
    schemes = schemes_of(options.scheme, case)
    with tempfile.TemporaryDirectory(prefix="greenwater_") as scratch:
        base = (options.keep or Path(scratch)).resolve() / options.case / options.size
        program = options.program.resolve()
        runs = {s: Runs(program, HERE / options.case, base / s, options.size, s) for s in schemes}
        measured = {scheme: measure(case, runs[scheme]) for scheme in schemes}
        good = report(options, case, runs, measured)
    sys.exit(0 if good else 1)


if __name__ == "__main__":
    main()
