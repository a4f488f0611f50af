"""The text of a report in each format, and its output; only the format that is wanted is loaded."""

from collections.abc import Iterable, Iterator, Sequence
from typing import NamedTuple

from kurbel.render import Look
from kurbel.render.output import look_at, opened, write_lines, write_out
from kurbel.render.text import Line, plain_lines
from kurbel.tables.tables import Report


def render(report: Report, look: Look = Look()) -> str:  # noqa: B008 (immutable)
    """Return the report as text that ends with a newline, the same every time; a workbook is no text."""
    return "".join(_pieces(report, look))


def _pieces(report: Report, look: Look) -> Iterable[str]:
    """Return the text in pieces, so that a long table needs no memory."""
    if look.format == "csv":
        from kurbel.render.csv_text import csv_text

        return csv_text(report, look)
    if look.format == "json":
        from kurbel.render.json_text import json_text

        return json_text(report, look)
    if look.format == "table":
        return plain_lines(_lines(report, look))
    from kurbel.render.markup import markup

    return markup(report, look)


def _lines(
    report: Report, look: Look, first: Sequence[str] | None = None, named: Sequence[str] = ()
) -> Iterator[Line]:
    from kurbel.render.page import fitting, page_lines

    if first is None:
        return page_lines(report, look)
    return fitting(report, look, first, named)


class Output(NamedTuple):
    """Where a report goes, a file or standard output, and how it looks."""

    look: Look
    file_name: str | None

    def write(
        self, report: Report, first: Sequence[str] | None = None, named: Sequence[str] = ()
    ) -> None:
        """Write the report to the file (as UTF-8), or to standard output in its encoding. Raises UsageError.

        first: ids shown on a terminal that has too few lines for the whole report; None: always the whole report.
        named: those of its key values that stay, however few the lines.

        On a terminal, blocks have as many angles as fit its width, and colours if wanted; a pipe gets plain text,
        folded only to a given width.
        """
        if self.look.format == "xlsx":
            from kurbel.render.workbook import report_sheets, write_workbook

            with opened(self.file_name) as file:
                write_workbook(report_sheets(report, self.look), file, self.look)
            return
        look = look_at(self.file_name, self.look)
        if look.format == "table" and self.file_name in (None, "-"):
            write_lines(_lines(report, look, first, named), look)
        else:
            if look.format in ("html", "latex"):  # always read as UTF-8
                look = look._replace(encoding="utf-8")
            write_out(_pieces(report, look), self.file_name, look.encoding)
