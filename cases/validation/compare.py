#!/usr/bin/env python3
"""What accuracy costs: every figure that has a limit, and the time of the processor, for each scheme; into schemes.md.

Runs all cases (or those named); finished runs in --keep are read again. Exit code 2: wrong use, or a package is missing.
"""
import argparse
import os
import sys
from pathlib import Path

import run as runner

SCHEMES = ("classic", "default", "high")
PAGE = Path(__file__).resolve().parent / "schemes.md"


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("cases", nargs="*", metavar="CASE", help="default: all")
    parser.add_argument("--size", choices=("small", "full"), default="small")
    program = os.environ.get("GREENWATER_PROGRAM", runner.ROOT / "build/openmp/app/greenwater")
    parser.add_argument("--program", type=Path, default=program, metavar="PATH", help="default: %(default)s")
    parser.add_argument("--keep", type=Path, required=True, metavar="DIR", help="where the runs are kept")
    parser.add_argument("--write", action="store_true", help="write the table into schemes.md")
    return parser.parse_args()


def rows_of(name, case, runs, measured):
    """One row for each figure with a limit, and one for the cost."""
    from figures import number

    by_name = {scheme: {figure.name: figure for figure in found} for scheme, (found, _) in measured.items()}
    limited = [figure for figure in by_name["default"].values() if figure.limit]
    for figure in limited:
        cells = []
        for scheme in SCHEMES:
            found = by_name[scheme].get(figure.name)
            if found and not found.limit:
                found.limit = figure.limit
            cells.append(found.error() if found else "fails" if measured[scheme][1] else "")
        yield [f"[{name}]({name}): {figure.name}", figure.limit.text, *cells]
    costs = [runs[scheme].cost() for scheme in SCHEMES]
    failed = [bool(measured[scheme][1]) for scheme in SCHEMES]
    base = costs[SCHEMES.index("default")]
    cells = ["fails" if bad else f"{number(cost)} s ({cost / max(base, 1e-3):.2f})" for cost, bad in zip(costs, failed)]
    yield [f"**{name}: time of the processor**", "", *cells]


def main():
    options = arguments()
    runner.need_packages(False)
    sys.path.insert(0, str(runner.HERE))
    import page
    from figures import as_columns, as_markdown
    from runs import Runs

    rows, notes, any_run = [["figure", "limit", *SCHEMES]], [], None
    for name in options.cases or runner.case_names():
        case = runner.load_case(name)
        base = options.keep.resolve() / name / options.size
        program = options.program.resolve()
        runs = {s: Runs(program, runner.HERE / name, base / s, options.size, s) for s in SCHEMES}
        measured = {scheme: runner.measure(case, runs[scheme]) for scheme in SCHEMES}
        rows += rows_of(name, case, runs, measured)
        notes += [f"{name}: {note}" for scheme in SCHEMES for note in measured[scheme][1]]
        any_run = any_run or next(iter(runs["default"].done.values()))
        print(as_columns(rows[:1] + [row for row in rows if name in row[0]]), flush=True)
    if options.write:
        command = f"cases/validation/compare.py --size {options.size} --keep DIR --write"
        text = PAGE.read_text()
        before, _, rest = text.partition(page.BEGIN)
        after = rest.partition(page.END)[2]
        table = as_markdown(rows).replace("|---|---:|---:|---|---:|", "|---|---|---:|---:|---:|")
        parts = [table, "\n".join(f"* {note}" for note in notes), page.origin(any_run.manifest(), command)]
        PAGE.write_text(before + page.BEGIN + "\n" + "\n\n".join(part for part in parts if part) + "\n" + page.END + after)


if __name__ == "__main__":
    main()
