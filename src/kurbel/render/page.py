"""The printed page: title, tables, key values, reasons and warnings; crank angles across, or a line for each row."""

import math
import re
import sys
from collections.abc import Collection, Iterable, Iterator, Sequence
from itertools import chain, islice
from typing import NamedTuple

from kurbel.quantity import first_words
from kurbel.render import Look
from kurbel.render.output import terminal_size
from kurbel.render.text import (
    BLANK,
    Line,
    Piece,
    in_two_columns,
    line,
    padded,
    paragraph,
    sentence,
    width,
)
from kurbel.render.text_tables import (
    MARK,
    TextColumn,
    headed,
    key_value_table,
    part_name,
    place_table,
    sheets,
)
from kurbel.tables.sources import legend_of
from kurbel.tables.tables import (
    KeyValue,
    Report,
    first_selection,
    for_people,
    notes_for_people,
)

_NINE = 9  # angles to a block: the book breaks after 80°
_SIDE, _CELL = 14, 8
"""Width in characters of symbol and unit of a row, and of each number."""
_GAP, _ROW_GAP = 2, 3
_LONGEST = 16  # of a number, or two angles; a longer list gets lines of its own


def page_lines(report: Report, look: Look) -> Iterator[Line]:
    """Yield the lines of the whole page, the books of its references last."""
    report = for_people(report)
    yield from _title(report, look)
    yield from _tables(report, look)
    notes = notes_for_people(report)
    if notes:
        yield BLANK
        yield from _sentences("", notes, look)
    for part in report.all_parts:
        name = part_name(report, part, look)
        of = f": {name}" if name else ""
        if part.key_values:
            yield from (BLANK, line(f"Key values{of}", "name"))
            yield from _key_value_lines(part.key_values, look)
        if part.left_out:
            yield from (BLANK, line(f"Left out{of}", "name"))
            yield from in_two_columns(part.left_out, look)
        if part.warnings:
            yield from (BLANK, line(f"Warnings{of}", "name"))
            yield from _sentences("  ", part.warnings, look)
    books = legend_of(report)
    if books:
        yield from sentence("", books, look)


def selection(report: Report, look: Look, in_short: bool = False) -> Iterator[Line]:
    """Yield the lines of a first selection: the key values, a short table, and what is left out in one line.

    in_short: key values have no more words than fit next to them.
    """
    yield from _title(report, look)
    for part in report.all_parts:
        if part.key_values:
            name = part_name(report, part, look)
            yield from (BLANK, line(name, "name")) if name else (BLANK,)
            yield from _key_value_lines(part.key_values, look, in_short)
    yield from _tables(report, look)
    yield from _sentences("", report.notes, look)
    for part in report.all_parts:
        if part.warnings:
            name = part_name(report, part, look)
            yield from (BLANK, line(f"Warnings: {name}" if name else "Warnings", "name"))
            yield from _sentences("  ", part.warnings, look)


def _title(report: Report, look: Look) -> Iterator[Line]:
    yield from paragraph(look.text(report.title), look.width, "title")
    for text in report.head:
        yield from paragraph(look.text(text), look.width)


def _sentences(head: str, texts: Iterable[str], look: Look) -> Iterator[Line]:
    for text in texts:
        yield from sentence(head, text, look)


def _tables(report: Report, look: Look) -> Iterator[Line]:
    """Yield the tables over the crank angle, and those of places."""
    for heads, bands in sheets(report, look):
        if look.layout == "book":
            yield BLANK
            yield from _book(heads, bands, report.group == "ratios", look)
        else:
            for name, columns in bands:
                yield from (BLANK, line(name, "name")) if name else (BLANK,)
                yield from blocks(heads, columns, look, _ROW_GAP)

    for table in report.printed_tables:
        shown = place_table(table, look)
        yield from (BLANK, *paragraph(shown.caption, look.width, "name"))
        # without names the first column names the rows
        side = list(shown.columns[: shown.heads or 1])
        if shown.heads and not table.headed:
            side = [column._replace(symbol="") for column in side]
        if len(side) > 1:
            side[0] = _without_repetition(side[0])
        yield from blocks(side, shown.columns[len(side) :], look)


def _without_repetition(names: TextColumn) -> TextColumn:
    """Return a column of names in which one that repeats the name above stays blank."""
    cells = []
    for above, name in zip(("", *names.cells), names.cells):
        cells.append("" if name == above else name)
    return names._replace(cells=cells)


def fitting(
    report: Report, look: Look, first: Sequence[str], named: Sequence[str] = ()
) -> Iterator[Line]:
    """Return the lines of the report, or of a first selection of it if a terminal has fewer lines.

    first: ids of the selection; named: those of its key values that stay where even these do not fit.
    """
    lines = page_lines(report, look)
    _, rows = terminal_size()
    beginning = list(islice(lines, rows)) if sys.stdout.isatty() else []
    if len(beginning) < rows:
        return chain(beginning, lines)

    # a table over the angle must not push key values off the screen
    across = max(((look.width or 80) - _SIDE) // _CELL, 4)
    selected = first_selection(report, first, across, rows=rows // 6)
    candidates = [selected]
    if any(part.key_values for part in selected.all_parts):
        candidates.append(selected.changed(lambda part: part._replace(columns=())))
        if named:
            candidates.append(first_selection(report, named, across, rows=rows // 6))

    # the prompt takes a line, too
    page = list[Line]()
    for candidate in candidates:
        for in_short in (False, True):
            page = list(selection(candidate, look, in_short))
            if len(page) < rows:
                return iter(page)
    return iter(page)


# a line for each row


def blocks(
    side: Sequence[TextColumn], columns: Sequence[TextColumn], look: Look, gap: int = _GAP
) -> Iterator[Line]:
    """Yield block under block, each with the side columns and as many others as fit the width, at least one."""
    for number, block in enumerate(_fitting_blocks(side, columns, look, gap)):
        if number:
            yield BLANK
        columns_of_block = [column for column, _ in block]
        wide = sum(cells + gap for _, cells in block) - gap
        rule = line(look.text("─") * wide, "rule")
        yield _row(block, gap, [column.symbol for column in columns_of_block], "head")
        if any(column.unit for column in columns_of_block):
            yield _row(block, gap, [column.unit for column in columns_of_block], "unit")
        yield rule
        for cells in zip(*(column.cells for column in columns_of_block)):
            yield _row(block, gap, cells, "cell")
        yield rule


Block = list[tuple[TextColumn, int]]
"""Columns with their widths, which stand side by side."""


def _fitting_blocks(
    side: Sequence[TextColumn], columns: Sequence[TextColumn], look: Look, gap: int
) -> list[Block]:
    """Return the columns in blocks that fit the width, each after the side columns."""
    with_widths = []
    for column in (*side, *columns):
        wide = max(map(width, (column.symbol, column.unit, *column.cells)))
        with_widths.append((column, wide))
    beginning = with_widths[: len(side)]
    blocks: list[Block] = [list(beginning)]
    for column, wide in with_widths[len(side) :]:
        needed = sum(cells + gap for _, cells in blocks[-1]) + wide
        is_full = look.width is not None and needed > look.width
        if is_full and len(blocks[-1]) > len(side):
            blocks.append(list(beginning))
        blocks[-1].append((column, wide))
    return blocks


def _row(block: Block, gap: int, texts: Sequence[str], role: str) -> Line:
    """Return a line of a block, with a gap before each column but the first."""
    pieces = list[Piece]()
    for (column, cells), text in zip(block, texts):
        before = " " * gap if pieces else ""
        text_in_cells = padded(text, cells, not column.words)
        pieces.append(Piece(before + text_in_cells, _role(text, column, role)))
    return tuple(pieces)


def _role(text: str, column: TextColumn, role: str) -> str:
    """Return the role of a cell: that of names, of marked values, or the one of its row."""
    if column.words:
        return "name"
    return "mark" if text.endswith(MARK) else role


# the look of Zusammenstellung 112: quantities down the side, crank angles across, broken as over two pages


def _book(
    heads: Sequence[TextColumn],
    bands: Sequence[tuple[str, Sequence[TextColumn]]],
    named_beside: bool,
    look: Look,
) -> Iterator[Line]:
    """Yield the columns in blocks of crank angles, nine each or as many as fit the width.

    named_beside: the names of bands are short and have a column of their own, as L/R in the book.
    """
    rows = list(heads)
    for _, columns in bands:
        rows += columns
    texts = chain.from_iterable(row.cells for row in rows)
    cell = max(map(width, texts), default=0) + _GAP
    side = _Side(
        _with_gap(name for name, _ in bands if named_beside),
        _with_gap(row.symbol for row in rows),
        _with_gap(row.unit for row in rows),
    )
    if look.width is not None and look.width < side.width + 2 * cell:
        side = side._replace(name=0)

    start = 0
    angles = len(heads[0].cells)
    sizes = book_sizes(angles)
    if look.width is not None:
        sizes = fitting_sizes(angles, (look.width - side.width) // cell)
    for size in sizes:
        if start:
            yield BLANK
        across = slice(start, start + size)
        rule = line(look.text("─") * (side.width + size * cell), "rule")
        for head in heads:
            yield side.line_of("", head, across, cell, "head")
        for band, columns in bands:
            yield rule
            if band and not side.name:
                yield line(band, "name")
            name = band if side.name else ""
            for row in columns:
                yield side.line_of(name, row, across, cell)
                name = ""
        yield rule
        start += size


def _with_gap(texts: Iterable[str]) -> int:
    """Return the width of a column of texts with its gap; without a text it takes no room."""
    wide = max(map(width, texts), default=0)
    if not wide:
        return 0
    return wide + _GAP


class _Side(NamedTuple):
    """Widths of the columns at the side of the book's table: names of bands, symbols, and units."""

    name: int
    symbol: int
    unit: int

    @property
    def width(self) -> int:
        """Of all three."""
        return self.name + self.symbol + self.unit

    def line_of(
        self, band: str, row: TextColumn, across: slice, cell: int, role: str = "symbol"
    ) -> Line:
        """Return the line of a row: name of its band, symbol, unit, and numbers of so many cells."""
        is_head = role == "head"
        label = padded(row.symbol, self.symbol - _GAP, is_head) + " " * _GAP
        pieces = [
            Piece(padded(band, self.name), "name"),
            Piece(label, role),
            Piece(padded(row.unit, self.unit), "unit"),
        ]
        for text in row.cells[across]:
            number_role = _role(text, row, "head" if is_head else "cell")
            pieces.append(Piece(padded(text, cell, True), number_role))
        return tuple(pieces)


def book_sizes(count: int) -> list[int]:
    """Return nine angles to a block; a single one left over joins the last: 19 = 9 + 10, as in the book."""
    full = max(0, (count - 2) // _NINE)
    return [_NINE] * full + [count - full * _NINE]


def fitting_sizes(count: int, most: int) -> list[int]:
    """Return blocks of nearly equal length of at most `most` angles, the longer ones last."""
    if not count:
        return []
    blocks = math.ceil(count / max(most, 1))
    size, longer = divmod(count, blocks)
    return [size] * (blocks - longer) + [size + 1] * longer


# sentences and key values


def _key_value_lines(
    key_values: Collection[KeyValue], look: Look, in_short: bool = False
) -> Iterator[Line]:
    """Yield a line for each key value: symbol, value, unit, crank angle, meaning; those of one heading together.

    in_short: the meaning in two or three words, or none where these would need another line.
    """
    groups = headed(key_values)
    table = key_value_table("", list(chain(*groups.values())), look)
    symbols, values, units, at_angles, meanings = (column.cells for column in table.columns)
    numbers = _below_one_another(values, table.lists)
    angles = [f"at {angle}" if angle else "" for angle in at_angles]

    # a long list has lines of its own, and does not make the column wider
    symbol_width, unit_width, angle_width = (
        max(map(width, texts)) for texts in (symbols, units, angles)
    )
    number_width = max((width(text) for text in numbers if width(text) <= _LONGEST), default=0)
    before_meaning = 2 + symbol_width + 2 + number_width + 2 + unit_width + 2
    if look.width is not None and before_meaning + angle_width > look.width:
        angle_width = 0

    lines = zip(symbols, numbers, units, angles, meanings)
    for heading, group in groups.items():
        if heading:
            yield from (BLANK, line(heading, "unit"))
        for symbol, number, unit, angle, meaning in islice(lines, len(group)):
            start = f"  {padded(symbol, symbol_width)}  "
            head = f"{start}{padded(number, number_width)}  {padded(unit, unit_width)}  "
            if width(number) > number_width:
                yield from sentence(start, f"{number}  {unit}".rstrip(), look)
                head = " " * before_meaning
            text = meaning
            if angle_width:
                head += f"{padded(angle, angle_width)}  "
            elif angle:
                text = f"{angle}  {meaning}"
            if in_short:
                text = _words_beside(head, text, look)
            yield from sentence(head, text, look)


def _words_beside(head: str, text: str, look: Look) -> str:
    """Return the first words of a sentence, '' where these do not fit next to what is before them."""
    words = first_words(text).partition(" per ")[0]
    fits = look.width is None or width(head) + width(words) <= look.width
    return words if fits else ""


def _below_one_another(texts: Sequence[str], lists: Collection[int]) -> list[str]:
    """Return numbers with their decimal points below one another, where whole ones end, too; lists: rows of lists."""
    integers = []
    for row, text in enumerate(texts):
        match = None if row in lists else re.match(r"-?\d+", text)
        integers.append(match[0] if match else "")
    before = max(map(len, integers))
    aligned = []
    for integer, text in zip(integers, texts):
        rest = text.removeprefix(integer)
        aligned.append(integer.rjust(before) + (rest or " ") if integer else rest)
    return aligned
