"""First pass of every printed format: the values of a report as tables of text, with their digits, units and marks."""

from collections.abc import Collection, Iterator, Sequence
from itertools import groupby
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
from kurbel.tables.tables import CellValue, Column, KeyValue, Part, PlaceTable, Report, grouped

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


def sheets(
    report: Report, look: Look
) -> Iterator[tuple[list[TextColumn], list[tuple[str, list[TextColumn]]]]]:
    """Yield the columns of crank angles, and each part over these angles by its name, for each run of such parts."""
    parts = [part for part in report.all_parts if part.columns]
    for _, run in groupby(parts, lambda part: part.columns[0].values):
        alike = list(run)
        pad = " " if any(column.marked for part in alike for column in part.columns) else ""
        phi = alike[0].columns[0]
        angles = [phi]
        if report.mirrored:
            values = tuple(None if value is None else 360 - value for value in phi.values)
            symbol, ascii_symbol = f"360° − {phi.symbol}", f"360 - {phi.ascii_symbol}"
            angles.append(phi._replace(symbol=symbol, ascii_symbol=ascii_symbol, values=values))
        heads = [
            _scaled(angle, head_scale(angle.values, look.digits), look, pad) for angle in angles
        ]
        bands = []
        for part in alike:
            curves = [_curve(column, look, pad) for column in part.columns[1:]]
            bands.append((part_name(report, part, look), curves))
        yield heads, bands


def _curve(column: Column, look: Look, pad: str) -> TextColumn:
    """Return a column over the crank angle at one scale, which has more decimals if a value would be printed as 0.0.

    A value that is too small for that, next to a zero of the curve, has its own power of ten.
    """
    column = _without_rounding(column, (column.size, *column.values))
    scale = digit_scale(column.values, look.digits)
    smallest = min((abs(value) for value in column.values if value), default=0.0)
    finer = _visible_scale(smallest, scale) if smallest else scale
    if finer is not None:
        return _scaled(column, finer, look, pad)
    shown = _scaled(column, scale, look, pad)
    cells = list(shown.cells)
    for row, value in enumerate(column.values):
        if value and float(cell(value, scale)) == 0:
            number = look.counted(*single(value / 10.0**scale.exponent, look.digits, _FEW_DIGITS))
            cells[row] = look.number(number) + pad
    return shown._replace(cells=cells)


def _without_rounding(column: Column, sharing: Sequence[CellValue]) -> Column:
    """Return a column with zeros in the place of rounding errors, which are relative to values of the same unit."""
    largest = max((abs(value) for value in sharing if value is not None), default=0.0)
    values = [
        0.0 if value and abs(value) <= _ROUNDING * largest else value for value in column.values
    ]
    return column._replace(values=values)


def _visible_scale(smallest: float, scale: Scale) -> Scale | None:
    """Return the scale, or one with as many more decimals as the smallest value needs; None if these are too many."""
    for more in range(_MORE_DECIMALS + 1):
        finer = scale._replace(decimals=scale.decimals + more)
        if float(cell(smallest, finer)) > 0:
            return finer
    return None


def _scaled(
    column: Column, scale: Scale, look: Look, pad: str = "", missing: str = ""
) -> TextColumn:
    """Return a column whose cells all have the same decimals; pad: after those without a mark."""
    if column.decimals is not None:
        scale = Scale(column.decimals)
    cells = [
        missing if value is None else look.number(cell(value, scale)) + pad
        for value in column.values
    ]
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
    return look.text(str(part.name)) if len(report.all_parts) > 1 else ""


def place_table(table: PlaceTable, look: Look) -> TextTable:
    """Return a table of named places; columns of one unit share their scale, to be compared by eye.

    A column has a scale of its own if it has angles, decimals or digits of its own, or a value so small that the shared
    scale would print it as 0.0.
    """
    blank = "_" if table.headed else " "
    columns = list[TextColumn]()
    for head, names in zip(table.heads, zip(*table.names)):
        words = [table.words.get(name) or name.replace("_", blank) for name in names]
        columns.append(
            TextColumn(head, "", [look.number(look.text(text)) for text in words], "name")
        )
    sharing: dict[str, list[CellValue]] = {}
    for column in table.columns:
        if column.decimals is None and not column.alone:
            sharing.setdefault(column.unit, []).extend(column.values)
    missing = look.text("–")
    for column in table.columns:
        if column.decimals is not None:
            text_column = _scaled(column, Scale(column.decimals), look, missing=missing)
        elif column.alone:
            text_column = _each_scaled(column, column.alone, look, missing)
        elif column.unit == "deg":
            text_column = _scaled(
                column, angle_scale(column.values, look.digits), look, missing=missing
            )
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
    scale = digit_scale(sharing, look.digits)
    smallest = min((abs(value) for value in column.values if value), default=0.0)
    finer = _visible_scale(smallest, scale) if smallest else scale
    if finer is None:
        return _each_scaled(column, DIGITS, look, missing)
    return _scaled(column, finer, look, missing=missing)


def _each_scaled(column: Column, digits: int, look: Look, missing: str) -> TextColumn:
    """Return a column in which each value has its own scale, with so many digits if no others are wanted."""
    cells = [
        missing if value is None else look.number(look.counted(*single(value, look.digits, digits)))
        for value in column.values
    ]
    return _headed(column, cells, look)


def key_value_table(caption: str, found: Collection[KeyValue], look: Look) -> TextTable:
    """Return key values as a table: symbol, value, unit, crank angle, meaning."""
    rows = []
    for one in found:
        at = "" if one.at_deg is None else look.extreme_at(one.at_deg, one.side)
        symbol = look.symbol(one.symbol, one.ascii_symbol)
        rows.append((symbol, _value(one, look), look.unit(one.unit), at, look.sentence(one.text)))
    heads = (
        ("Symbol", "symbol"),
        ("Value", "number"),
        ("Unit", "name"),
        ("At", "number"),
        ("Meaning", "sentence"),
    )
    columns = [TextColumn(head, "", cells, kind) for (head, kind), cells in zip(heads, zip(*rows))]
    lists = {row for row, one in enumerate(found) if isinstance(one.value, tuple) and one.value}
    return TextTable(caption, columns, 1, lists=lists)


def headed(found: Collection[KeyValue]) -> dict[str, list[KeyValue]]:
    """Return key values by their headings, in the order of the first of each; a few, or those of one, all by ""."""
    groups = {group[0].heading: group for group in grouped(found, lambda one: one.heading)}
    return groups if len(groups) > 1 and len(found) > _FEW else {"": list(found)}


def _value(one: KeyValue, look: Look) -> str:
    """Return a number with its power of ten, or the numbers of a list, of a long one its ends."""
    if one.value is None or one.value == ():
        return look.text("–")
    if one.noise:  # is only known to be less
        power = look.counted("1", NOISE_POWER)
        return f"< {power.removeprefix('1·')}"

    values = one.value if isinstance(one.value, tuple) else (one.value,)

    text = look.angle if one.unit == "deg" else look.value
    if len(values) > _MOST_LISTED:
        return f"{len(values)} from {text(min(values))} to {text(max(values))}"
    return ("; " if look.comma else ", ").join(map(text, values))
