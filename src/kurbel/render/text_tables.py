"""First pass of every printed format: the values of a report as tables of text, with their digits, units and marks."""

from collections.abc import Collection, Iterator, Sequence
from itertools import chain, groupby
from typing import NamedTuple

from kurbel.quantity import NOISE_POWER
from kurbel.render import Look
from kurbel.render.text import (
    DIGITS,
    Scale,
    angle_scale,
    cell,
    digit_scale,
    head_scale,
    single,
    whole_if_integral,
)
from kurbel.tables.tables import CellValue, Column, KeyValue, Part, PlaceTable, Report

MARK = "*"
_MOST_LISTED = 12
_FEW = 12
"""Key values that need no headings."""


class TextColumn(NamedTuple):
    """A column as text; kind: `number`, `name`, `symbol` or `sentence`."""

    symbol: str
    unit: str
    cells: Sequence[str]
    kind: str = "number"

    @property
    def words(self) -> bool:
        """Whether it holds words, which are flush left."""
        return self.kind != "number"


class TextTable(NamedTuple):
    """A table as text; heads: how many of its columns name the rows.

    verdicts: `good`, `bad` or "" of each row, or none at all; lists: rows whose value is a list, which may be folded.
    """

    caption: str
    columns: Sequence[TextColumn]
    heads: int = 0
    verdicts: Sequence[str] = ()
    lists: Collection[int] = ()


Bands = list[tuple[str, list[TextColumn]]]
"""Names of parts, each with its columns."""


def sheets(report: Report, look: Look) -> Iterator[tuple[list[TextColumn], Bands]]:
    """Yield the columns of crank angles, and each part over these angles by its name, for each run of such parts."""
    parts = [part for part in report.all_parts if part.columns]
    for _, run in groupby(parts, lambda part: part.columns[0].values):
        same_angles = list(run)
        columns = chain.from_iterable(part.columns for part in same_angles)
        has_marks = any(column.marked for column in columns)
        pad = " " if has_marks else ""

        phi = same_angles[0].columns[0]
        angles = [phi, _mirrored(phi)] if report.mirrored else [phi]
        heads = [
            _scaled(angle, head_scale(angle.values, look.digits), look, pad) for angle in angles
        ]
        bands: Bands = []
        for part in same_angles:
            curves = [_curve(column, look, pad) for column in part.columns[1:]]
            bands.append((part_name(report, part, look), curves))
        yield heads, bands


def _mirrored(phi: Column) -> Column:
    """Return the crank angles 360° − φ."""
    return phi._replace(
        symbol=f"360° − {phi.symbol}",
        ascii_symbol=f"360 - {phi.ascii_symbol}",
        values=tuple(None if angle is None else 360 - angle for angle in phi.values),
    )


def _curve(column: Column, look: Look, pad: str) -> TextColumn:
    """Return a column over the crank angle at one scale, which has more decimals if a value would be printed as 0.0.

    A value that is too small for that, next to a zero of the curve, has its own power of ten.
    """
    column = _without_rounding(column, (column.size, *column.values))
    scale = digit_scale(column.values, look.digits)
    finer = _visible_scale(column, scale)
    if finer is not None:
        return _scaled(column, finer, look, pad)

    # the scale that all others have
    shown = _scaled(column, scale, look, pad)
    cells = list(shown.cells)
    for row, value in enumerate(column.values):
        is_hidden = bool(value) and float(cell(value, scale)) == 0
        if value and is_hidden:
            in_unit = value / 10.0**scale.exponent
            number = look.counted(*single(in_unit, look.digits, _FEW_DIGITS))
            cells[row] = look.number(number) + pad
    return shown._replace(cells=cells)


def _without_rounding(column: Column, sharing: Sequence[CellValue]) -> Column:
    """Return a column with zeros in the place of rounding errors, which are relative to values of the same unit."""
    largest = max((abs(value) for value in sharing if value is not None), default=0.0)
    values = list[CellValue]()
    for value in column.values:
        is_rounding = value is not None and abs(value) <= _ROUNDING * largest
        values.append(0.0 if is_rounding else value)
    return column._replace(values=values)


def _visible_scale(column: Column, scale: Scale) -> Scale | None:
    """Return the scale, or one with as many more decimals as the smallest value needs; None if these are too many."""
    sizes = [abs(value) for value in column.values if value]
    if not sizes:
        return scale
    for more in range(_MORE_DECIMALS + 1):
        finer = scale._replace(decimals=scale.decimals + more)
        if float(cell(min(sizes), finer)) > 0:
            return finer
    return None


def _scaled(
    column: Column, scale: Scale, look: Look, pad: str = "", missing: str = ""
) -> TextColumn:
    """Return a column whose cells all have the same decimals; pad: after those without a mark."""
    if column.decimals is not None:
        scale = Scale(column.decimals)
    cells = []
    for value in column.values:
        cells.append(missing if value is None else look.number(cell(value, scale)) + pad)
    for row in column.marked:
        cells[row] = cells[row].removesuffix(pad) + MARK
    return _headed(column, cells, look, scale.exponent)


def _headed(column: Column, cells: Sequence[str], look: Look, exponent: int = 0) -> TextColumn:
    return TextColumn(
        look.symbol(column.symbol, column.ascii_symbol), look.unit(column.unit, exponent), cells
    )


def part_name(report: Report, part: Part, look: Look) -> str:
    """Return the heading of the results of a part; nothing for the only one, which the title names."""
    if part is not report.whole and report.group == "ratios":
        ratio = str(whole_if_integral(float(part.name))).replace("inf", "∞")
        return look.text(f"L/R = {look.number(ratio)}")
    is_only_cylinder = report.is_of_one_cylinder and part is not report.whole
    if is_only_cylinder or len(report.all_parts) < 2:
        return ""
    return look.text(str(part.name))


def place_table(table: PlaceTable, look: Look) -> TextTable:
    """Return a table of named places; columns of one unit share their scale, to be compared by eye.

    A column has a scale of its own if it has angles, decimals or digits of its own, or a value so small that the shared
    scale would print it as 0.0.
    """
    blank = "_" if table.headed else " "
    columns = list[TextColumn]()
    for head, names in zip(table.heads, zip(*table.names)):
        words = (table.words.get(name) or name.replace("_", blank) for name in names)
        cells = [look.number(look.text(text)) for text in words]
        columns.append(TextColumn(head, "", cells, "name"))

    # what columns of one unit have together
    sharing: dict[str, list[CellValue]] = {}
    for column in table.columns:
        if column.decimals is None and not column.alone and not column.for_entry:
            sharing.setdefault(column.unit, []).extend(column.values)

    missing = look.text("–")
    for column in table.columns:
        if column.decimals is not None:
            text_column = _scaled(column, Scale(column.decimals), look, missing=missing)
        elif column.for_entry:
            cells = [
                missing if value is None else look.value_for_entry(value) for value in column.values
            ]
            text_column = _headed(column, cells, look)
        elif column.alone:
            text_column = _each_scaled(column, column.alone, look, missing)
        elif column.unit == "deg":
            scale = angle_scale(column.values, look.digits)
            text_column = _scaled(column, scale, look, missing=missing)
        else:
            text_column = _visible(column, sharing[column.unit], look, missing)
        columns.append(text_column)
    return TextTable(look.text(table.title), columns, len(table.heads))


_ROUNDING = 1e-12
"""Values below this, relative to the largest of their unit, are rounding errors of a zero."""
_FEW_DIGITS = 2
"""Of a value next to a zero of its curve."""
_MORE_DECIMALS = 2
"""So many more than the shared scale has are printed for a small value, before values get powers of ten."""


def _visible(column: Column, sharing: Sequence[CellValue], look: Look, missing: str) -> TextColumn:
    """Return a column at the scale of all values that share its unit, or finer, so that none is printed as 0.0."""
    column = _without_rounding(column, sharing)
    finer = _visible_scale(column, digit_scale(sharing, look.digits))
    if finer is None:
        return _each_scaled(column, DIGITS, look, missing)
    return _scaled(column, finer, look, missing=missing)


def _each_scaled(column: Column, digits: int, look: Look, missing: str) -> TextColumn:
    """Return a column in which each value has its own scale, with so many digits if no others are wanted."""
    cells = []
    for value in column.values:
        if value is None:
            cells.append(missing)
        else:
            number, exponent = single(value, look.digits, digits)
            cells.append(look.number(look.counted(number, exponent)))
    return _headed(column, cells, look)


def key_value_table(caption: str, key_values: Collection[KeyValue], look: Look) -> TextTable:
    """Return key values as a table: symbol, value, unit, crank angle, meaning."""
    rows = []
    lists = set[int]()
    for number, key_value in enumerate(key_values):
        at_deg = key_value.at_deg
        row = (
            look.symbol(key_value.symbol, key_value.ascii_symbol),
            _value(key_value, look),
            look.unit(key_value.unit),
            "" if at_deg is None else look.extreme_at(at_deg, key_value.side),
            look.sentence(key_value.text),
        )
        rows.append(row)
        if isinstance(key_value.value, tuple) and key_value.value:
            lists.add(number)
    heads = (
        ("Symbol", "symbol"),
        ("Value", "number"),
        ("Unit", "name"),
        ("At", "number"),
        ("Meaning", "sentence"),
    )
    columns = [TextColumn(head, "", cells, kind) for (head, kind), cells in zip(heads, zip(*rows))]
    return TextTable(caption, columns, 1, lists=lists)


def headed(key_values: Collection[KeyValue]) -> dict[str, list[KeyValue]]:
    """Return key values by their headings, in the order of the first of each; a few, or those of one, all by ""."""
    groups: dict[str, list[KeyValue]] = {}
    for key_value in key_values:
        groups.setdefault(key_value.heading, []).append(key_value)
    if len(groups) > 1 and len(key_values) > _FEW:
        return groups
    return {"": list(key_values)}


def _value(key_value: KeyValue, look: Look) -> str:
    """Return a number with its power of ten, or the numbers of a list, of a long one its ends."""
    value = key_value.value
    if value is None or value == ():
        return look.text("–")
    if key_value.noise:  # is only known to be less
        power = look.counted("1", NOISE_POWER)
        return f"< {power.removeprefix('1·')}"

    numbers = value if isinstance(value, tuple) else (value,)
    text = look.angle if key_value.unit == "deg" else look.value
    if key_value.for_entry:
        text = look.angle_for_entry if key_value.unit == "deg" else look.value_for_entry
    if len(numbers) > _MOST_LISTED:
        return f"{len(numbers)} from {text(min(numbers))} to {text(max(numbers))}"
    separator = "; " if look.comma else ", "
    return separator.join(map(text, numbers))
