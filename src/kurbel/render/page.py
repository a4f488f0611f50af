"""The printed page: title, tables, key values, reasons and warnings; crank angles across, or a line for each row."""

import re
import sys
from collections.abc import Collection, Iterable, Iterator, Sequence
from itertools import chain, islice

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
    if notes := notes_for_people(report):
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
    if books := legend_of(report):
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
        # without names the first column names the rows; a name that repeats the one above stays blank
        hidden = shown.heads and not table.headed
        side = [
            column._replace(symbol="") if hidden else column
            for column in shown.columns[: shown.heads or 1]
        ]
        if len(side) > 1:
            repeated = zip(side[0].cells, ("", *side[0].cells))
            side[0] = side[0]._replace(
                cells=["" if name == above else name for name, above in repeated]
            )
        yield from blocks(side, shown.columns[len(side) :], look)


def fitting(
    report: Report, look: Look, first: Sequence[str], named: Sequence[str] = ()
) -> Iterator[Line]:
    """Return the lines of the report, or of a first selection of it if a terminal has fewer lines.

    first: ids of the selection; named: those of its key values that stay where even these do not fit.
    """
    lines, most = page_lines(report, look), terminal_size()[1]
    begin = list(islice(lines, most)) if sys.stdout.isatty() else []
    if len(begin) < most:
        return chain(begin, lines)
    across = max(((look.width or 80) - _SIDE) // _CELL, 4)
    rows = most // 6
    selected = first_selection(report, first, across, rows)
    candidates = [selected]
    # a table over the angle must not push key values off the screen
    if any(part.key_values for part in selected.all_parts):
        candidates.append(selected.changed(lambda part: part._replace(columns=())))
        if named:
            candidates.append(first_selection(report, named, across, rows))
    page = list[Line]()
    for candidate in candidates:
        for in_short in (False, True):
            page = [*selection(candidate, look, in_short)]
            # the prompt takes a line, too
            if len(page) < most:
                return iter(page)
    return iter(page)


# a line for each row


def blocks(
    side: Sequence[TextColumn], columns: Sequence[TextColumn], look: Look, gap: int = _GAP
) -> Iterator[Line]:
    """Yield block under block, each with the side columns and as many others as fit the width, at least one."""
    every = [
        (one, max(map(width, (one.symbol, one.unit, *one.cells)))) for one in (*side, *columns)
    ]
    before, blocks = len(side), [every[: len(side)]]
    for sized in every[before:]:
        wide = sum(one + gap for _, one in blocks[-1]) + sized[1]
        if look.width is not None and wide > look.width and len(blocks[-1]) > before:
            blocks.append(every[:before])
        blocks[-1].append(sized)
    for number, block in enumerate(blocks):
        yield from (BLANK,) if number else ()
        rule = line(look.text("─") * (sum(wide + gap for _, wide in block) - gap), "rule")
        yield _row(block, gap, [one.symbol for one, _ in block], "head")
        if any(one.unit for one, _ in block):
            yield _row(block, gap, [one.unit for one, _ in block], "unit")
        yield rule
        for cells in zip(*(one.cells for one, _ in block)):
            yield _row(block, gap, cells, "cell")
        yield rule


def _row(
    block: Sequence[tuple[TextColumn, int]], gap: int, texts: Sequence[str], role: str
) -> Line:
    return tuple(
        Piece(
            " " * gap * (number > 0) + padded(text, wide, not column.words),
            _role(text, column, role),
        )
        for number, ((column, wide), text) in enumerate(zip(block, texts))
    )


def _role(text: str, column: TextColumn, role: str) -> str:
    return "name" if column.words else "mark" if text.endswith(MARK) else role


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
    rows = [*heads, *(row for _, band in bands for row in band)]
    cell = max((width(text) for row in rows for text in row.cells), default=0) + _GAP
    texts = (
        [name for name, _ in bands if named_beside],
        [row.symbol for row in rows],
        [row.unit for row in rows],
    )
    # of names, symbols and units; a column without a text takes no room
    name, symbol, unit = (
        wide and wide + _GAP for wide in (max(map(width, each), default=0) for each in texts)
    )
    if look.width is not None and look.width < name + symbol + unit + 2 * cell:
        name = 0
    side = name + symbol + unit

    def book_line(band: str, row: TextColumn, across: slice, role: str = "symbol") -> Line:
        label = padded(row.symbol, symbol - _GAP, role == "head") + " " * _GAP
        pieces = [
            Piece(padded(band, name), "name"),
            Piece(label, role),
            Piece(padded(row.unit, unit), "unit"),
        ]
        number = "head" if role == "head" else "cell"
        return (
            *pieces,
            *(
                Piece(padded(text, cell, True), _role(text, row, number))
                for text in row.cells[across]
            ),
        )

    start, count = 0, len(heads[0].cells)
    for size in (
        book_sizes(count)
        if look.width is None
        else fitting_sizes(count, (look.width - side) // cell)
    ):
        yield from (BLANK,) if start else ()
        across, rule = (
            slice(start, start + size),
            line(look.text("─") * (side + size * cell), "rule"),
        )
        yield from (book_line("", head, across, "head") for head in heads)
        for band, columns in bands:
            yield rule
            if band and not name:
                yield line(band, "name")
            yield from (
                book_line("" if k or not name else band, row, across)
                for k, row in enumerate(columns)
            )
        yield rule
        start += size


def book_sizes(count: int) -> list[int]:
    """Return nine angles to a block; a single one left over joins the last: 19 = 9 + 10, as in the book."""
    full = max(0, (count - 2) // _NINE)
    return [*[_NINE] * full, count - full * _NINE]


def fitting_sizes(count: int, most: int) -> list[int]:
    """Return blocks of nearly equal length of at most `most` angles, the longer ones last."""
    blocks = -(-count // max(most, 1))
    return (
        [count // blocks + (index >= blocks - count % blocks) for index in range(blocks)]
        if count
        else []
    )


# sentences and key values


def _key_value_lines(
    key_values: Collection[KeyValue], look: Look, in_short: bool = False
) -> Iterator[Line]:
    """Yield a line for each key value: symbol, value, unit, crank angle, meaning; those of one heading together.

    in_short: the meaning in two or three words, or none where these would need another line.
    """
    groups = headed(key_values)
    table = key_value_table("", [one for group in groups.values() for one in group], look)
    symbols, shown, units, angles, meanings = (column.cells for column in table.columns)
    numbers = _below_one_another(shown, table.lists)
    angles = [f"at {one}" if one else "" for one in angles]
    symbol, unit, angle = (max(map(width, each)) for each in (symbols, units, angles))
    wide = max((width(one) for one in numbers if width(one) <= _LONGEST), default=0)
    before_meaning = 2 + symbol + 2 + wide + 2 + unit + 2
    if look.width is not None and before_meaning + angle > look.width:
        angle = 0

    lines = zip(symbols, numbers, units, angles, meanings)
    for heading, group in groups.items():
        yield from (BLANK, line(heading, "unit")) if heading else ()
        for name, number, of, at, text in islice(lines, len(group)):
            start = f"  {padded(name, symbol)}  "
            head = f"{start}{padded(number, wide)}  {padded(of, unit)}  "
            if width(number) > wide:  # a long list has lines of its own
                yield from sentence(start, f"{number}  {of}".rstrip(), look)
                head = " " * before_meaning
            if angle:
                head += f"{padded(at, angle)}  "
            elif at:
                text = f"{at}  {text}"
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
    wholes = [
        "" if row in lists else re.findall(r"^-?\d+|$", text)[0] for row, text in enumerate(texts)
    ]
    before = max(map(len, wholes))
    pairs = [(whole, text[len(whole) :]) for whole, text in zip(wholes, texts)]
    return [whole.rjust(before) + (rest or " ") if whole else rest for whole, rest in pairs]
