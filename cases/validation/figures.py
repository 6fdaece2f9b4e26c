"""Figures of a run, their limits, and the table of them."""
import math


class Limit:
    """A range that a figure must lie in, and how the table says it."""

    def __init__(self, low, high, text, reference=None):
        self.low, self.high, self.text, self.reference = low, high, text, reference

    def holds(self, value):
        return self.low <= value <= self.high


def below(most):
    """The size of the figure is below this."""
    return Limit(-most, most, f"< {number(most)}")


def at_least(least):
    return Limit(least, math.inf, f">= {number(least)}")


def at_most(most):
    return Limit(-math.inf, most, f"<= {number(most)}")


def near(reference, part):
    """Within this part of the reference."""
    room = abs(reference) * part
    return Limit(reference - room, reference + room, f"{number(reference)} ± {100 * part:g} %", reference)


def between(low, high):
    return Limit(low, high, f"{number(low)} to {number(high)}")


class Figure:
    """One line of the table; without a limit it is only told."""

    def __init__(self, name, value, limit=None):
        self.name, self.value, self.limit = name, float(value), limit

    def misses(self):
        return self.limit is not None and not self.limit.holds(self.value)

    def error(self):
        """As a text: how far it is off the reference of its limit, where that has one; else the figure itself."""
        reference = self.limit.reference if self.limit else None
        return f"{100 * (self.value / reference - 1):+.2g} %" if reference else number(self.value)

    def verdict(self):
        if self.limit is None:
            return ""
        return "MISS" if self.misses() else "ok"


def number(value):
    """Four digits, without a tail of zeros; powers of ten where they are far."""
    return f"{value:.4g}".replace("e-0", "e-").replace("e+0", "e+")


def table(figures, beside):
    """Rows of text: each figure with its limit, and its values with other schemes; `beside`: their figures by name."""
    others = {scheme: {figure.name: figure for figure in found} for scheme, found in beside.items()}
    rows = [["figure", "value", "limit", "", *others]]

    def values_beside(name):
        return [number(found[name].value) if name in found else "" for found in others.values()]

    for figure in figures:
        limit = figure.limit.text if figure.limit else ""
        rows.append([figure.name, number(figure.value), limit, figure.verdict(), *values_beside(figure.name)])
    mine = {figure.name for figure in figures}
    only_others = dict.fromkeys(name for found in others.values() for name in found if name not in mine)
    rows += [[name, "", "", "", *values_beside(name)] for name in only_others]
    return rows


def as_columns(rows):
    widths = [max(len(row[i]) for row in rows) for i in range(len(rows[0]))]
    return "\n".join("  ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip() for row in rows)


def as_markdown(rows):
    lines = ["| " + " | ".join(row) + " |" for row in rows]
    lines.insert(1, "|---|---:|---:|---|" + "---:|" * (len(rows[0]) - 4))
    return "\n".join(lines)
