"""Figures of a run, their limits, and the table of them."""
import math


class Limit:
    """A range that a figure must lie in, and how the table says it."""

    def __init__(self, low, high, text):
        self.low, self.high, self.text = low, high, text

    def holds(self, value):
        return self.low <= value <= self.high


def below(most):
    """The size of the figure is below this."""
    return Limit(-most, most, f"< {number(most)}")


def at_most(most):
    return Limit(-math.inf, most, f"<= {number(most)}")


def near(reference, part):
    """Within this part of the reference."""
    room = abs(reference) * part
    return Limit(reference - room, reference + room, f"{number(reference)} ± {100 * part:g} %")


def between(low, high):
    return Limit(low, high, f"{number(low)} to {number(high)}")


class Figure:
    """One line of the table; without a limit it is only told."""

    def __init__(self, name, value, limit=None):
        self.name, self.value, self.limit = name, float(value), limit

    def misses(self):
        return self.limit is not None and not self.limit.holds(self.value)

    def verdict(self):
        if self.limit is None:
            return ""
        return "MISS" if self.misses() else "ok"


def number(value):
    """Four digits, without a tail of zeros; powers of ten where they are far."""
    return f"{value:.4g}".replace("e-0", "e-").replace("e+0", "e+")


def table(figures, beside):
    """Rows of text: each figure with its limit, and the classic scheme's value where it has one."""
    classic = {figure.name: figure for figure in beside}
    rows = [["figure", "value", "limit", "", "classic"]]
    for figure in figures:
        other = classic.pop(figure.name, None)
        limit = figure.limit.text if figure.limit else ""
        rows.append([figure.name, number(figure.value), limit, figure.verdict(), number(other.value) if other else ""])
    rows += [[figure.name, "", "", "", number(figure.value)] for figure in classic.values()]
    return rows


def as_columns(rows):
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    return "\n".join("  ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip() for row in rows)


def as_markdown(rows):
    lines = ["| " + " | ".join(row) + " |" for row in rows]
    lines.insert(1, "|---|---:|---:|---|---:|")
    return "\n".join(lines)
