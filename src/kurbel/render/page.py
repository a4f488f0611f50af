"""The printed page: title, tables, key values, reasons and warnings; crank angles across, or a line for each row."""

from collections.abc import Collection, Iterable, Iterator, Sequence

from kurbel.render import Look
from kurbel.render.output import stdout_look, write_out
from kurbel.render.text import BLANK, Line, Piece, folded, left, line, plain, right, width
from kurbel.render.text_tables import (
    MARK,
    KeyValueText,
    Sheet,
    TextColumn,
    key_value_text,
    part_name,
    place_table,
    sentence_text,
    sheets,
)
from kurbel.report.alike import shown_once
from kurbel.report.tables import KeyValue, PlaceTable, Report

_NINE = 9  # angles to a block: the book breaks after 80°
_GAP = 2
_ROW_GAP = 3
_LONGEST = 16  # of a number, or two angles; a longer list gets lines of its own
_NARROWEST = 24  # below this a sentence is folded under its head instead of next to it


def page(report: Report, look: Look) -> Iterator[Line]:
    """Yield the lines of the whole page."""
    report = shown_once(report)
    yield from (line(one, "title") for one in folded(look.text(report.title), look.width))
    yield from (line(one) for text in report.head for one in folded(look.text(text), look.width))
    for sheet in sheets(report, look):
        yield BLANK
        yield from (_rows if look.layout == "rows" else _book)(sheet, look)
    for table in report.printed_tables:
        yield BLANK
        yield from _places(table, look)
    for paragraph in _prose(report, look):
        yield BLANK
        yield from paragraph


# a line for each row


def _rows(sheet: Sheet, look: Look) -> Iterator[Line]:
    """Yield a line for each crank angle, part under part."""
    for number, (name, columns) in enumerate(sheet.bands):
        if number:
            yield BLANK
        if name:
            yield line(name, "name")
        yield from _blocks(sheet.heads, columns, look, _ROW_GAP, between=(BLANK,))


def _places(table: PlaceTable, look: Look) -> Iterator[Line]:
    """Yield a line for each named place, under the title; without names the first column names the rows."""
    yield from (line(one, "name") for one in folded(look.text(table.title), look.width))
    names, columns = place_table(table, look)
    side = names if table.headed else [one._replace(symbol="") for one in names]
    if len(side) > 1:  # a name that repeats the one above stays blank
        repeated = zip(side[0].values, ("", *side[0].values))
        side[0] = side[0]._replace(values=["" if name == above else name for name, above in repeated])
    yield from _blocks(side or columns[:1], columns if side else columns[1:], look, _GAP)


def _blocks(
    side: Sequence[TextColumn], columns: Sequence[TextColumn], look: Look, gap: int, between: Iterable[Line] = ()
) -> Iterator[Line]:
    """Yield block under block, each with the side columns and as many others as fit the width, at least one."""
    block = list(side)
    for one in columns:
        wide = sum(column.whole_width + gap for column in block) + one.whole_width
        if look.width is not None and wide > look.width and len(block) > len(side):
            yield from _block(block, look, gap)
            yield from between
            block = list(side)
        block.append(one)
    yield from _block(block, look, gap)


def _block(columns: Sequence[TextColumn], look: Look, gap: int) -> Iterator[Line]:
    ruled = line(look.text("─") * (sum(one.whole_width + gap for one in columns) - gap), "rule")
    layout = [(" " * gap * (k > 0), one.whole_width, one.words) for k, one in enumerate(columns)]

    def row(texts: Iterable[str], role: str) -> Line:
        return tuple(
            Piece(before + left(text, wide), "name")
            if words
            else Piece(before + right(text, wide), "mark" if text.endswith(MARK) else role)
            for text, (before, wide, words) in zip(texts, layout)
        )

    yield row((one.symbol for one in columns), "head")
    if any(one.unit for one in columns):
        yield row((one.unit for one in columns), "unit")
    yield ruled
    for texts in zip(*(one.cells() for one in columns)):
        yield row(texts, "cell")
    yield ruled


# the look of Zusammenstellung 112: quantities down the side, crank angles across, broken as over two pages


def _book(sheet: Sheet, look: Look) -> Iterator[Line]:
    """Yield the sheet in blocks of crank angles, nine each or as many as fit the width."""
    rows = [*sheet.heads, *(row for _, band in sheet.bands for row in band)]
    cell = max(row.width for row in rows) + _GAP
    symbol, unit = max(width(row.symbol) for row in rows), max(width(row.unit) for row in rows)
    name = max(width(name) for name, _ in sheet.bands) if sheet.named_beside else 0
    if look.width is not None and look.width < sum(wide + _GAP for wide in (name, symbol, unit) if wide) + 2 * cell:
        name = 0
    side = sum(wide + _GAP for wide in (name, symbol, unit) if wide)
    gap = " " * _GAP

    def book_line(band: str, row: TextColumn, across: range, role: str) -> Line:
        pieces = [Piece(left(band, name) + gap, "name")] if name else []
        pieces.append(Piece((right if role == "head" else left)(row.symbol, symbol) + gap, role))
        if unit:
            pieces.append(Piece(left(row.unit, unit) + gap, "unit"))
        cells = row.cells(across.start, across.stop)
        number = "head" if role == "head" else "cell"
        return (*pieces, *(Piece(right(text, cell), "mark" if text.endswith(MARK) else number) for text in cells))

    start, count = 0, len(sheet.heads[0].values)
    for size in book_sizes(count) if look.width is None else fitting_sizes(count, (look.width - side) // cell):
        if start:
            yield BLANK
        across, ruled = range(start, start + size), line(look.text("─") * (side + size * cell), "rule")
        yield from (book_line("", head, across, "head") for head in sheet.heads)
        for band, columns in sheet.bands:
            yield ruled
            if band and not name:
                yield line(band, "name")
            yield from (book_line("" if k else band, row, across, "symbol") for k, row in enumerate(columns))
        yield ruled
        start += size


def book_sizes(count: int) -> list[int]:
    """Return nine angles to a block; a single one left over joins the last: 19 = 9 + 10, as in the book."""
    full = max(0, (count - 2) // _NINE)
    return [*[_NINE] * full, count - full * _NINE]


def fitting_sizes(count: int, most: int) -> list[int]:
    """Return blocks as even as can be of at most `most` angles, the longer ones last."""
    blocks = -(-count // max(most, 1))
    return [count // blocks + (index >= blocks - count % blocks) for index in range(blocks)] if count else []


# sentences and key values


def _prose(report: Report, look: Look) -> Iterator[list[Line]]:
    """Yield the paragraphs below the tables: notes, key values, what was left out and why, warnings."""
    if notes := [note for note in (report.mirrored, *report.notes) if note]:
        yield [one for note in notes for one in sentence("", note, look)]
    for part in report.all_parts:
        name = part_name(report, part, look)
        of = f": {name}" if name else ""
        if part.key_values:
            yield [line(f"Key values{of}", "name"), *key_value_lines(part.key_values, look)]
        if part.left_out:
            yield [line(f"Left out{of}", "name"), *in_two_columns(part.left_out, look)]
        if part.warnings:
            warnings = (one for warning in part.warnings for one in sentence("  ", warning, look))
            yield [line(f"Warnings{of}", "name"), *warnings]


def key_value_lines(key_values: Collection[KeyValue], look: Look) -> Iterator[Line]:
    """Yield a line for each key value: symbol, value, unit, crank angle, meaning."""
    shown = [key_value_text(one, look) for one in key_values]
    numbers = _aligned(shown)
    symbol, unit = max(width(one.symbol) for one in shown), max(width(one.unit) for one in shown)
    number = max((wide for one in numbers if (wide := width(one)) <= _LONGEST), default=0)
    angles = [f"at {one.at}" if one.at else "" for one in shown]
    angle = max(map(width, angles))
    if look.width is not None and 2 + symbol + 2 + number + 2 + unit + 2 + angle > look.width:
        angle = 0
    for one, value, at in zip(shown, numbers, angles):
        head, text = f"  {left(one.symbol, symbol)}  {left(value, number)}  {left(one.unit, unit)}  ", one.sentence
        if angle:
            head += f"{left(at, angle)}  "
        elif at:
            text = f"{at}  {text}"
        if width(value) > number:  # a long list has lines of its own
            before = f"  {left(one.symbol, symbol)}  "
            rest = None if look.width is None else max(look.width - width(before), _NARROWEST)
            for row in folded(f"{value}  {one.unit}".rstrip(), rest):
                yield line(before + row, "cell")
                before = " " * width(before)
            head = " " * (4 + symbol + number + 2 + unit + 2 + (angle + 2 if angle else 0))
        yield from sentence(head, text, look)


def _aligned(shown: Sequence[KeyValueText]) -> list[str]:
    """Return the numbers with their decimal points below one another; whole numbers end there, too."""
    ends = [one.number.lstrip("-0123456789") if one.single else one.number for one in shown]
    whole = max(len(one.number) - len(end) for one, end in zip(shown, ends))
    return [
        one.number.removesuffix(end).rjust(whole) + (end or " ") if one.single else one.number
        for one, end in zip(shown, ends)
    ]


def in_two_columns(found: Iterable[tuple[str, str]], look: Look) -> Iterator[Line]:
    """Yield heads in a column, each with its sentence."""
    heads = [(look.text(head), text) for head, text in found]
    column = max(width(head) for head, _ in heads)
    for head, text in heads:
        yield from sentence(f"  {left(head, column)}  ", text, look)


def sentence(head: str, text: str, look: Look) -> Iterator[Line]:
    """Yield a head and its sentence, which is folded next to it, or below it where it leaves little room."""
    text = sentence_text(text, look)
    if look.width is None or width(head) + width(text) <= look.width:
        yield (Piece(head, "cell"), Piece(text))
        return
    indent = width(head)
    if look.width - indent < _NARROWEST:
        if head.strip():
            yield line(head, "cell")
        head, indent = "", 6
    for index, one in enumerate(folded(text, max(look.width - indent, _NARROWEST))):
        yield (Piece(head if head and index == 0 else " " * indent, "cell"), Piece(one))


# lists of the commands that print no report


def listing(title: str, sections: Iterable[tuple[str, Sequence[tuple[str, str]]]], look: Look) -> str:
    """Return a title and sections, each a head line with its entries, as plain text."""
    lines = [line(one) for one in folded(look.text(title), look.width)]
    for name, entries in sections:
        lines += [BLANK, *(line(one) for one in folded(look.text(name), look.width))]
        lines += in_two_columns(entries, look)
    return "".join(plain(lines))


def write_entries(found: Sequence[tuple[str, str]], file_name: str | None = None) -> None:
    """Write heads in a column, each with its text, to a file or to standard output."""
    look = Look() if file_name else stdout_look(Look())
    longest = max((len(head) for head, _ in found), default=0)
    lines = (one for head, text in found for one in sentence(f"{head:<{longest}}  ", text, look))
    write_out(plain(lines), file_name)
