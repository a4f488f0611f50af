"""What to write about the layout of a file of columns so that it can be read: tried out on its first lines."""

import itertools
from collections.abc import Iterator, Sequence

from kurbel.machine_file.columns import FIGURES, Columns, is_number

_SIGNS = {";": "semicolon", "\t": "tab", ",": "comma", " ": "space"}
_PLAIN = "; figures are plain numbers, such as 1013.25 or 1.01325e3: export them so"
_NO_FIGURES = "; is it a file of figures?"
_TRIED = 200
"""Lines that are looked at: headings are no longer."""


def advice(text: str, number: int, line: str, columns: Columns, cell: str = "") -> str:
    """Return what to write so that a file could be read: keys under which its first lines are rows, or a guess.

    number, line, cell: the line, and the cell in it, that could not be.
    """
    lines = list(itertools.islice(text.split("\n", _TRIED), _TRIED))
    found = min(_layouts(lines, columns), key=lambda one: one.skip_rows, default=None)
    written = _written(found, columns) if found else ()
    alone = len(written) == 1 and "skip_rows" in written[0]
    if not written or (alone and FIGURES.fullmatch(cell)):  # of headings no cell is one of figures
        return _guess(lines, number, line, columns, cell)
    return f"; write {' and '.join(written)}{' if it is a heading' if alone else ''}"


def _layouts(lines: Sequence[str], columns: Columns) -> Iterator[Columns]:
    """Yield the layouts, the given one first, in which figures begin below lines that are no rows."""
    quoted = any('"' in line for line in lines)
    for signs in _signs_tried(columns):
        for one in _columns_tried(signs) if quoted or signs.delimiter != signs.decimal else ():
            begin = _begin_of_figures(lines, one)
            if begin is not None:
                yield one._replace(skip_rows=begin)


def _signs_tried(columns: Columns) -> Iterator[Columns]:
    for delimiter in dict.fromkeys((columns.delimiter, *_SIGNS)):
        for decimal in dict.fromkeys((columns.decimal, ".", ",")):
            yield columns._replace(delimiter=delimiter, decimal=decimal)


def _columns_tried(columns: Columns) -> Iterator[Columns]:
    yield columns
    if columns.angle is None:  # rows that only count need no column beside that of what was measured
        yield columns._replace(values=(1,))


def _begin_of_figures(lines: Sequence[str], columns: Columns) -> int | None:
    """Return how many lines stand above the first of at least two rows of figures; None where rows are broken."""
    rows = {i: _is_row(line, columns) for i, line in enumerate(lines) if line.partition("#")[0].strip()}
    begin = next((index for index, row in rows.items() if row), len(lines))
    below = [row for index, row in rows.items() if index >= begin]
    if len(below) < 2 or not all(below):
        return None
    return begin if any(index < begin for index in rows) else 0


def _is_row(line: str, columns: Columns) -> bool:
    cells = columns.cells(line.partition("#")[0].strip())
    return len(cells) >= max(columns.wanted) and all(is_number(cells[one - 1].strip()) for one in columns.wanted)


def _written(found: Columns, given: Columns) -> tuple[str, ...]:
    """Return the keys that make the given layout that which was found."""
    keys = (
        (found.skip_rows != given.skip_rows, f"'skip_rows: {found.skip_rows}'"),
        (found.delimiter != given.delimiter, f"'delimiter: {_SIGNS.get(found.delimiter)}'"),
        (found.decimal != given.decimal, f"'decimal: {'comma' if found.decimal == ',' else 'point'}'"),
        (found.values != given.values, f"'pressure_column: {found.values[0]}'"),
    )
    return tuple(text for differs, text in keys if differs)


def _guess(lines: Sequence[str], number: int, line: str, columns: Columns, cell: str) -> str:
    """Return what the first bad line itself hints at: signs by which it is a row, or what stands in the way."""
    signs = _signs_tried(columns)
    found = next((one for one in signs if one.delimiter != one.decimal and _is_row(line, one)), None)
    if found:
        return f"; write {' and '.join(_written(found, columns))}"
    rows = [index for index, text in enumerate(lines, 1) if index > columns.skip_rows and _is_row(text, columns)]
    if rows and number < rows[0] and not FIGURES.fullmatch(cell):
        return f"; write 'skip_rows: {rows[0] - 1}' if it is a heading"
    if rows and rows[0] < number:
        return "; leave such lines out, or mend them"
    return _of_cells(columns.cells(line), columns, cell)


def _of_cells(cells: Sequence[str], columns: Columns, cell: str) -> str:
    """Return what the cells of a line hint at that no layout makes a row."""
    if len(cells) >= max(columns.wanted):
        return _PLAIN if any(one.isdigit() for one in cell) else _NO_FIGURES
    if not any(is_number(one.strip()) for one in cells):
        return _NO_FIGURES
    if len(cells) > 1 or columns.angle is None:
        return f"; it has {len(cells)} only"
    return "; if it has no angles, write 'pressure_column: 1' and 'angle_step: 0.5 deg', say"
