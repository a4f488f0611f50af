"""The printed page: title, tables, key values, and what was left out, from top to bottom."""

from collections.abc import Iterator

from kurbel.render import Look
from kurbel.render.prose import prose
from kurbel.render.sheet import sheets
from kurbel.render.text import BLANK, Line, folded, line
from kurbel.report.alike import told_once
from kurbel.report.tables import Report


def page(report: Report, look: Look) -> Iterator[Line]:
    """Yield the lines of the whole page."""
    if look.layout == "rows":
        from kurbel.render.columns import table
    else:
        from kurbel.render.book import table
    report = told_once(report)
    yield from (line(one, "title") for one in folded(look.charset.text(report.title), look.width))
    yield from (line(one) for text in report.head for one in folded(look.charset.text(text), look.width))
    for sheet in sheets(report, look):
        yield BLANK
        yield from table(sheet, look)
    if any(report.printed_tables):
        from kurbel.render.place_table import place_tables

        for place_lines in place_tables(report, look):
            yield from (BLANK, *place_lines)
    for paragraph in prose(report, look):
        yield from (BLANK, *paragraph)
