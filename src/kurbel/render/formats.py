"""The text of a report in each format, and where it is written."""

import sys
from collections.abc import Callable, Collection, Iterable
from dataclasses import replace
from itertools import islice
from shutil import get_terminal_size

from kurbel.render import Look
from kurbel.render.data import csv_text, json_text
from kurbel.render.html import html
from kurbel.render.markup import Latex, Markdown, document
from kurbel.render.output import stdout_look, write_coloured, write_out
from kurbel.render.page import page
from kurbel.render.text import plain
from kurbel.report.alike import first_selection
from kurbel.report.tables import Report

_SIDE, _CELL = 14, 8
"""Cells of a terminal that symbol and unit of a row take, and that each number takes."""
_WRITERS: dict[str, Callable[[Report, Look], Iterable[str]]] = {
    "table": lambda report, look: plain(page(report, look)),
    "csv": csv_text,
    "json": json_text,
    "markdown": lambda report, look: document(report, look, Markdown()),
    "html": html,
    "latex": lambda report, look: document(report, look, Latex()),
}
"""Format, of FORMATS -> the function that makes its text of a report, piece by piece: a long table is never held."""


def render(report: Report, look: Look = Look()) -> str:  # noqa: B008 (immutable)
    """Return the report as text that ends with a newline; the same report gives the same text every time."""
    return "".join(_WRITERS[look.format](report, look))


def _fitting(report: Report, look: Look, first: Collection[str]) -> Report:
    """Return the report, or a first selection of it where a terminal has fewer lines."""
    most = get_terminal_size().lines
    if not sys.stdout.isatty() or len([*islice(page(report, look), most)]) < most:
        return report
    across = max(((look.width or 80) - _SIDE) // _CELL, 2)
    return first_selection(report, first, across, rows=most // 6)


def write_report(
    report: Report, look: Look, file_name: str | None = None, first: Collection[str] | None = None
) -> None:
    """Write the report to a file (as UTF-8), or to standard output in the encoding of that.

    first: ids of what a terminal shows that is too low for the whole report; None for all on every terminal.

    A terminal gets as many angles to a block as fit its width, and colours where they are wanted; a pipe gets plain
    text, of a width only if one is given. Raises UsageError where it cannot be written.
    """
    if file_name not in (None, "-"):
        look = replace(look, encoding="utf-8")
    else:
        look = stdout_look(look)
        if look.format in ("html", "latex"):  # are read as UTF-8, whatever the terminal has
            look = replace(look, encoding="utf-8")
        if look.format == "table":
            report = report if first is None else _fitting(report, look, first)
            if write_coloured(page(report, look), look):
                return
    write_out(_WRITERS[look.format](report, look), file_name, look.encoding)
