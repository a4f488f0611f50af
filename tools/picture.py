"""Draw the picture of the README: what a terminal shows.

python tools/picture.py > docs/terminal.svg
"""

from __future__ import annotations

import io
import sys

from rich.console import Console
from rich.terminal_theme import MONOKAI
from rich.text import Text

from kurbel.render import Look
from kurbel.render.output import STYLES
from kurbel.render.page import page_lines
from kurbel.report.zusammenstellung import zusammenstellung

WIDTH = 120


def main() -> None:
    """Write the picture to standard output."""
    console = Console(
        record=True, width=WIDTH, file=io.StringIO(), force_terminal=True, highlight=False
    )
    report = zusammenstellung((5.0, 4.5, 4.0), ("b", "c"), tuple(range(0, 181, 10)), "book", False)
    console.print(Text("$ kurbel table", "bold"))
    for line in page_lines(report, Look(width=WIDTH)):
        console.print(
            Text.assemble(*((piece.text, STYLES[piece.role]) for piece in line)), soft_wrap=True
        )
    svg = console.export_svg(title="kurbel table", theme=MONOKAI, unique_id="kurbel")
    sys.stdout.buffer.write(svg.encode())


if __name__ == "__main__":
    main()
