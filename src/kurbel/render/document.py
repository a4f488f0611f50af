"""A report as documents have it, Markdown, HTML and LaTeX: one walk through it, and what each of them must write."""

from collections.abc import Collection, Iterable, Iterator, Sequence
from typing import NamedTuple, Protocol

from kurbel.render import Look
from kurbel.render.numbers import angle
from kurbel.render.prose import number_text, sentence_text
from kurbel.render.sheet import Row, part_name, sheets
from kurbel.report.alike import told_once
from kurbel.report.tables import KeyValue, Report

ON_PAPER = 9
"""Columns of a table beside that of the angle: what a page of A4 holds; more make a table of their own."""
_KEY_VALUE_HEADS = {"Symbol": True, "Value": False, "Unit": True, "At": False, "Meaning": True}
"""Heads of a table of key values, and which of its columns are words."""


class Table(NamedTuple):
    """A table of texts; of_row: how many of its columns are heads of its rows, such as crank angles."""

    caption: str
    columns: Sequence[Row]
    of_row: int = 0

    @property
    def rows(self) -> Iterator[tuple[str, ...]]:
        """The cells, row by row."""
        return zip(*(column.cells for column in self.columns))


class _Writer(Protocol):
    """What a format writes: the texts are in the characters of the output, and none is escaped yet.

    across: the most columns of numbers in a table, None for all of them in one.
    """

    @property
    def across(self) -> int | None: ...
    def title(self, text: str) -> Iterator[str]: ...
    def paragraph(self, text: str) -> Iterator[str]: ...
    def table(self, table: Table) -> Iterator[str]: ...
    def key_values(self, title: str, found: Collection[KeyValue]) -> Iterator[str]: ...
    def items(self, title: str, lines: Sequence[str]) -> Iterator[str]: ...


def document(report: Report, look: Look, writer: _Writer) -> Iterator[str]:
    """Yield the report, piece by piece, as the writer writes it; equal cylinders are told once."""
    report = told_once(report)
    yield from writer.title(look.charset.text(report.title))
    for text in report.head:
        yield from writer.paragraph(look.charset.text(text))
    for table in (*_angle_tables(report, look, writer.across), *_place_tables(report, look, writer.across)):
        yield from writer.table(table)
    for text in filter(None, (report.mirrored, *report.notes)):
        yield from writer.paragraph(sentence_text(text, look))
    for part in report.all_parts:
        name = part_name(report, part, look)
        said = f": {name}" if name else ""
        if part.key_values:
            yield from writer.key_values(f"Key values{said}", part.key_values)
        if part.left_out:
            lines = [sentence_text(f"{one.what}: {one.why}", look) for one in part.left_out]
            yield from writer.items(f"Left out{said}", lines)
        if part.warnings:
            yield from writer.items(f"Warnings{said}", [sentence_text(one, look) for one in part.warnings])


def _angle_tables(report: Report, look: Look, across: int | None) -> Iterator[Table]:
    for sheet in sheets(report, look):
        for band in sheet.bands:
            for part in _parts(len(band.rows), across):
                yield Table(band.name, [*sheet.heads, *band.rows[part]], len(sheet.heads))


def _place_tables(report: Report, look: Look, across: int | None) -> Iterator[Table]:
    from kurbel.render.place_table import text_of

    for one in report.printed_tables:
        names, columns = text_of(one, look)
        for part in _parts(len(columns), across):
            yield Table(look.charset.text(one.title), [*names, *columns[part]])


def _parts(count: int, across: int | None) -> Iterator[slice]:
    """Yield what of so many columns each table has; of none there is one table, too."""
    most = across or max(count, 1)
    return (slice(start, start + most) for start in range(0, max(count, 1), most))


def key_value_table(title: str, found: Iterable[KeyValue], look: Look) -> Table:
    """Return a table of key values: symbol, value, unit, where each stands, and what it is."""
    rows = [_cells(one, look) for one in found]
    columns = [
        Row(head, "", [row[k] for row in rows], words) for k, (head, words) in enumerate(_KEY_VALUE_HEADS.items())
    ]
    return Table(title, columns, 1)


def _cells(one: KeyValue, look: Look) -> tuple[str, ...]:
    charset = look.charset
    return (
        charset.symbol(one.symbol, one.ascii_symbol),
        number_text(one, look),
        charset.unit(one.unit),
        "" if one.at_deg is None else angle(one.at_deg, look.comma) + charset.text("°"),
        sentence_text(one.text, look),
    )
