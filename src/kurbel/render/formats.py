"""The text of a report in each format, and its output."""

import sys
from collections.abc import Callable, Collection, Iterable, Iterator
from dataclasses import replace
from itertools import chain, islice
from shutil import get_terminal_size

from kurbel.render import Look
from kurbel.render.data import csv_text, json_text
from kurbel.render.markup import Latex, Markdown, document, html
from kurbel.render.output import stdout_look, write_lines, write_out
from kurbel.render.page import page
from kurbel.render.text import Line, plain
from kurbel.report.tables import Report, first_selection

_SIDE, _CELL = 14, 8
"""Width in characters of symbol and unit of a row, and of each number."""
_WRITERS: dict[str, Callable[[Report, Look], Iterable[str]]] = {
    "table": lambda report, look: plain(page(report, look)),
    "csv": csv_text,
    "json": json_text,
    "markdown": lambda report, look: document(report, look, Markdown()),
    "html": html,
    "latex": lambda report, look: document(report, look, Latex()),
}
"""Format -> the function that yields the text of a report in pieces, so that a long table needs no memory."""


def render(report: Report, look: Look = Look()) -> str:  # noqa: B008 (immutable)
    """Return the report as text that ends with a newline; the same report gives the same text every time."""
    return "".join(_WRITERS[look.format](report, look))


def write_report(
    report: Report, look: Look, file_name: str | None = None, first: Collection[str] | None = None
) -> None:
    """Write the report to a file (as UTF-8), or to standard output in its encoding. Raises UsageError.

    first: ids shown on a terminal that has too few lines for the whole report; None: always the whole report.

    On a terminal, blocks have as many angles as fit its width, and colours if wanted; a pipe gets plain text, folded
    only to a given width.
    """
    named = file_name not in (None, "-")
    look = look if named else stdout_look(look)
    if named or look.format in ("html", "latex"):  # always read as UTF-8
        look = replace(look, encoding="utf-8")
    if named or look.format != "table":
        write_out(_WRITERS[look.format](report, look), file_name, look.encoding)
    else:
        write_lines(page(report, look) if first is None else _fitting(report, look, first), look)


def _fitting(report: Report, look: Look, first: Collection[str]) -> Iterator[Line]:
    """Return the lines of the report, or of a first selection of it if a terminal has fewer lines."""
    lines, most = page(report, look), get_terminal_size().lines
    begin = list(islice(lines, most)) if sys.stdout.isatty() else []
    if len(begin) < most:
        return chain(begin, lines)
    across = max(((look.width or 80) - _SIDE) // _CELL, 4)
    return page(first_selection(report, first, across, rows=most // 6), look)
