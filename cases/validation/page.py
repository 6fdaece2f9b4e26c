"""Writes the table into a case's README.md, and its picture."""
import datetime
from pathlib import Path

from figures import as_markdown

BEGIN, END = "<!-- figures: written by scripts/validate -->", "<!-- end of figures -->"


def write_table(page, rows, origin, notes):
    """Puts the table between the two marks; all else of the page stays."""
    text = Path(page).read_text()
    before, found, rest = text.partition(BEGIN)
    _, closed, after = rest.partition(END)
    if not found or not closed:
        raise SystemExit(f"{page} has no lines '{BEGIN}' and '{END}' to write between")
    lines = [as_markdown(rows), *notes, origin]
    Path(page).write_text(before + BEGIN + "\n" + "\n\n".join(lines) + "\n" + END + after)


def origin(manifest, command):
    """Where the figures come from, in a sentence."""
    build = manifest["build"]
    today = datetime.date.today().isoformat()
    return f"`{command}`, {today}, greenwater {build['version']} ({build['git']})."


def draw_picture(path, draw, runs):
    """A small picture, of 64 colours: `draw` of the case gets the figure and the runs by scheme."""
    import io

    import matplotlib
    from PIL import Image  # comes with matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure = plt.figure(figsize=(7.2, 3.6), layout="constrained")
    draw(figure, runs)
    drawn = io.BytesIO()
    figure.savefig(drawn, dpi=80)
    plt.close(figure)
    Image.open(drawn).convert("RGB").quantize(64).save(path, optimize=True)
