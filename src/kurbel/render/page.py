"""The printed page: title, tables, key values, reasons and warnings; crank angles across, or a line for each row."""

import re
from collections.abc import Collection, Iterable, Iterator, Sequence

from kurbel.render import Look
from kurbel.render.output import stdout_look, write_out
from kurbel.render.text import BLANK, Line, Piece, folded, line, padded, plain, width
from kurbel.render.text_tables import (
    MARK,
    TextColumn,
    headed,
    key_value_table,
    part_name,
    place_table,
    sentence_text,
    sheets,
)
from kurbel.report.alike import shown_once
from kurbel.report.tables import KeyValue, Report

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

    for heads, bands in sheets(report, look):
        yield BLANK
        if look.layout == "book":
            yield from _book(heads, bands, report.group == "ratios", look)
            continue
        for number, (name, columns) in enumerate(bands):
            yield from [BLANK] * (number > 0) + [line(name, "name")] * bool(name)
            yield from _blocks(heads, columns, look, _ROW_GAP, between=(BLANK,))

    for table in report.printed_tables:
        yield BLANK
        shown = place_table(table, look)
        yield from (line(one, "name") for one in folded(shown.caption, look.width))
        # without names the first column names the rows; a name that repeats the one above stays blank
        hidden = shown.heads and not table.headed
        side = [one._replace(symbol="") if hidden else one for one in shown.columns[: shown.heads or 1]]
        if len(side) > 1:
            repeated = zip(side[0].values, ("", *side[0].values))
            side[0] = side[0]._replace(values=["" if name == above else name for name, above in repeated])
        yield from _blocks(side, shown.columns[len(side) :], look, _GAP)

    if notes := [note for note in (report.mirrored, *report.notes) if note]:
        yield from (BLANK, *(one for note in notes for one in sentence("", note, look)))
    for part in report.all_parts:
        name = part_name(report, part, look)
        of = f": {name}" if name else ""
        if part.key_values:
            yield from (BLANK, line(f"Key values{of}", "name"), *_key_value_lines(part.key_values, look))
        if part.left_out:
            yield from (BLANK, line(f"Left out{of}", "name"), *in_two_columns(part.left_out, look))
        if part.warnings:
            yield from (BLANK, line(f"Warnings{of}", "name"))
            yield from (one for warning in part.warnings for one in sentence("  ", warning, look))


# a line for each row


def _blocks(
    side: Sequence[TextColumn], columns: Sequence[TextColumn], look: Look, gap: int, between: Iterable[Line] = ()
) -> Iterator[Line]:
    """Yield block under block, each with the side columns and as many others as fit the width, at least one."""
    blocks = [list(side)]
    for one in columns:
        wide = sum(_wide(column) + gap for column in blocks[-1]) + _wide(one)
        if look.width is not None and wide > look.width and len(blocks[-1]) > len(side):
            blocks.append(list(side))
        blocks[-1].append(one)
    for number, block in enumerate(blocks):
        yield from between if number else ()
        widths = list(map(_wide, block))
        lines = [([one.symbol for one in block], "head"), ([one.unit for one in block], "unit")]
        for texts, role in lines if any(lines[1][0]) else lines[:1]:
            yield _row(block, widths, gap, texts, role)
        ruled = line(look.text("─") * (sum(widths) + gap * (len(widths) - 1)), "rule")
        yield ruled
        for cells in zip(*(one.cells() for one in block)):
            yield _row(block, widths, gap, cells, "cell")
        yield ruled


def _row(block: Sequence[TextColumn], widths: Sequence[int], gap: int, texts: Sequence[str], role: str) -> Line:
    pieces = []
    for number, (column, wide, text) in enumerate(zip(block, widths, texts)):
        role_of = "name" if column.words else "mark" if text.endswith(MARK) else role
        pieces.append(Piece(" " * gap * (number > 0) + padded(text, wide, not column.words), role_of))
    return tuple(pieces)


def _wide(column: TextColumn) -> int:
    return max(width(column.symbol), width(column.unit), column.width)


# the look of Zusammenstellung 112: quantities down the side, crank angles across, broken as over two pages


def _book(
    heads: Sequence[TextColumn], bands: Sequence[tuple[str, Sequence[TextColumn]]], named_beside: bool, look: Look
) -> Iterator[Line]:
    """Yield the columns in blocks of crank angles, nine each or as many as fit the width.

    named_beside: the names of bands are short and have a column of their own, as L/R in the book.
    """
    rows = [*heads, *(row for _, band in bands for row in band)]
    cell = max(row.width for row in rows) + _GAP
    texts = [name for name, _ in bands if named_beside], [row.symbol for row in rows], [row.unit for row in rows]
    # of names, symbols and units; a column without a text takes no room
    name, symbol, unit = (wide and wide + _GAP for wide in (max(map(width, each), default=0) for each in texts))
    if look.width is not None and look.width < name + symbol + unit + 2 * cell:
        name = 0
    side = name + symbol + unit

    def book_line(band: str, row: TextColumn, across: range, role: str = "symbol") -> Line:
        label = padded(row.symbol, symbol - _GAP, role == "head") + " " * _GAP
        pieces = [Piece(padded(band, name), "name"), Piece(label, role), Piece(padded(row.unit, unit), "unit")]
        number = "head" if role == "head" else "cell"
        cells = [
            Piece(padded(text, cell, True), "mark" if text.endswith(MARK) else number) for text in row.cells(across)
        ]
        return (*(one for one in pieces if one.text), *cells)

    start, count = 0, len(heads[0].values)
    for size in book_sizes(count) if look.width is None else fitting_sizes(count, (look.width - side) // cell):
        yield from [BLANK] * (start > 0)
        across, ruled = range(start, start + size), line(look.text("─") * (side + size * cell), "rule")
        yield from (book_line("", head, across, "head") for head in heads)
        for band, columns in bands:
            yield ruled
            if band and not name:
                yield line(band, "name")
            yield from (book_line("" if k or not name else band, row, across) for k, row in enumerate(columns))
        yield ruled
        start += size


def book_sizes(count: int) -> list[int]:
    """Return nine angles to a block; a single one left over joins the last: 19 = 9 + 10, as in the book."""
    full = max(0, (count - 2) // _NINE)
    return [*[_NINE] * full, count - full * _NINE]


def fitting_sizes(count: int, most: int) -> list[int]:
    """Return blocks of nearly equal length of at most `most` angles, the longer ones last."""
    blocks = -(-count // max(most, 1))
    return [count // blocks + (index >= blocks - count % blocks) for index in range(blocks)] if count else []


# sentences and key values


def _key_value_lines(key_values: Collection[KeyValue], look: Look) -> Iterator[Line]:
    """Yield a line for each key value: symbol, value, unit, crank angle, meaning; those of one heading together."""
    groups = headed(key_values)
    key_values = [one for group in groups.values() for one in group]
    first_of = {group[0].id: heading for heading, group in groups.items() if heading}
    table = key_value_table("", key_values, look)
    symbols, shown, units, angles, meanings = (one.values for one in table.columns)
    # decimal points below one another; whole numbers end there, too
    wholes = ["" if row in table.lists else re.findall(r"^-?\d+|$", text)[0] for row, text in enumerate(shown)]
    before = max(map(len, wholes))
    pairs = [(whole, text[len(whole) :]) for whole, text in zip(wholes, shown)]
    numbers = [whole.rjust(before) + (rest or " ") if whole else rest for whole, rest in pairs]
    wide = max((width(one) for one in numbers if width(one) <= _LONGEST), default=0)
    angles = [f"at {one}" if one else "" for one in angles]
    symbol, unit, angle = (max(map(width, each)) for each in (symbols, units, angles))
    if look.width is not None and 2 + symbol + 2 + wide + 2 + unit + 2 + angle > look.width:
        angle = 0

    for one, name, number, of, at, text in zip(key_values, symbols, numbers, units, angles, meanings):
        if one.id in first_of:
            yield from (BLANK, line(first_of[one.id], "unit"))
        start = f"  {padded(name, symbol)}  "
        head = f"{start}{padded(number, wide)}  {padded(of, unit)}  "
        if angle:
            head += f"{padded(at, angle)}  "
        elif at:
            text = f"{at}  {text}"
        if width(number) > wide:  # a long list has lines of its own
            room = None if look.width is None else max(look.width - width(start), _NARROWEST)
            for k, row in enumerate(folded(f"{number}  {of}".rstrip(), room)):
                yield line((" " * width(start) if k else start) + row, "cell")
            head = " " * (4 + symbol + wide + 2 + unit + 2 + (angle + 2 if angle else 0))
        yield from sentence(head, text, look)


def in_two_columns(found: Iterable[tuple[str, str]], look: Look, indent: str = "  ") -> Iterator[Line]:
    """Yield heads in a column, each with its sentence."""
    heads = [(look.text(head), text) for head, text in found]
    column = max((width(head) for head, _ in heads), default=0)
    for head, text in heads:
        yield from sentence(f"{indent}{padded(head, column)}  ", text, look)


def sentence(head: str, text: str, look: Look) -> Iterator[Line]:
    """Yield a head and its sentence, which is folded next to it, or below it if there is little room."""
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
        lines += [BLANK, *(line(one) for one in folded(look.text(name), look.width)), *in_two_columns(entries, look)]
    return "".join(plain(lines))


def write_entries(found: Sequence[tuple[str, str]], file_name: str | None = None) -> None:
    """Write heads in a column, each with its text, to a file or to standard output."""
    look = Look() if file_name else stdout_look(Look())
    write_out(plain(in_two_columns(found, look, "")), file_name)
