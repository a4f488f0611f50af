"""Rows of a sweep as text: csv, json lines, markdown, or a table; each row is made when it is asked for."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

from kurbel.render.csv_text import _harmless, _quoted
from kurbel.render.numbers import exact, single

if TYPE_CHECKING:
    from kurbel.render import Look

FORMATS = ("table", "csv", "json", "markdown", "parquet")


class Titles(NamedTuple):
    """Names of the columns with their units, in order, without those of the row itself.

    limited: whether bounds stand that a row keeps or not; row: what a row is called by; failing: whether one may fail.
    """

    names: tuple[tuple[str, str], ...]
    limited: bool = False
    row: str = "row"
    failing: bool = True

    @property
    def whole(self) -> list[str]:
        """All heads with their units, as in csv: `row`, `T_max_N`, …, `keeps`, `broken`, `failure`."""
        heads = [f"{name}_{unit.replace(' ', '')}" if unit else name for name, unit in self.names]
        return [self.row, *heads, *self.last]

    @property
    def last(self) -> tuple[str, ...]:
        """The heads of texts after the values."""
        return (*(("keeps", "broken") if self.limited else ()), *(("failure",) if self.failing else ()))

    def values(self, row: Any) -> list[Any]:
        """Return what stands in a row under the heads."""
        kept = ({True: "yes", False: "no", None: ""}[row.keeps], row.broken) if self.limited else ()
        return [row.number, *row.values, *kept, *((row.failure,) if self.failing else ())]


def csv_rows(titles: Titles, rows: Iterable[Any], look: Look, headed: bool = True) -> Iterator[str]:
    """Yield the rows as CSV; a list stands in one cell, its values parted by blanks."""
    separator = ";" if look.comma else ","
    if headed:
        yield separator.join(_quoted(_harmless(name), separator) for name in titles.whole) + "\n"
    for row in rows:
        yield separator.join([_csv_cell(value, look, separator) for value in titles.values(row)]) + "\n"


def _csv_cell(value: Any, look: Look, separator: str) -> str:
    if value is None:
        return ""
    if isinstance(value, str):
        return _quoted(_harmless(look.charset.text(value)), separator)
    if isinstance(value, tuple):
        return " ".join([_csv_cell(one, look, separator) for one in value])
    text = exact(value, look.digits)
    return text.replace(".", ",") if look.comma else text


def json_rows(titles: Titles, rows: Iterable[Any], look: Look) -> Iterator[str]:
    """Yield one object a line, whose keys are the heads of csv."""
    names = titles.whole
    for row in rows:
        told = {"keeps": row.keeps, "broken": row.broken or None, "failure": row.failure or None}
        found = {name: told.get(name, value) for name, value in zip(names, titles.values(row))}
        yield json.dumps(found, allow_nan=False, ensure_ascii=False) + "\n"


def markdown_rows(titles: Titles, rows: Iterable[Any], look: Look) -> Iterator[str]:
    """Yield a table in Markdown, numbers to four digits."""
    heads = [*(f"{name} ({unit})" if unit else name for name, unit in titles.names)]
    rules = ["--:"] * (len(heads) + 1) + ["---"] * len(titles.last)
    for line in ([titles.row, *heads, *titles.last], rules):
        yield f"| {' | '.join(map(_escaped, line))} |\n"
    for row in rows:
        yield f"| {' | '.join(_escaped(_cell(value, look)) for value in titles.values(row))} |\n"


def _escaped(text: str) -> str:
    return text.replace("\\", "\\\\").replace("|", "\\|")


def _cell(value: Any, look: Look) -> str:
    if value is None:
        return ""
    if isinstance(value, str):
        return look.charset.text(value)
    if isinstance(value, tuple):
        return " ".join(_cell(one, look) for one in value)
    text, power = single(value, look.digits, look.comma)
    return f"{text}e{power}" if power else text


_WIDTH_OF = 20
"""Rows whose widths tell those of the columns of a table; what is wider afterwards moves its row."""


def table_rows(titles: Titles, rows: Iterable[Any], look: Look) -> Iterator[str]:
    """Yield a table of numbers to four digits, flush right, heads and units over it."""
    names = [titles.row, *(name for name, _ in titles.names), *titles.last]
    units = ["", *(unit for _, unit in titles.names), *("" for _ in titles.last)]
    following = iter(rows)
    first = [[_cell(value, look) for value in titles.values(row)] for _, row in zip(range(_WIDTH_OF), following)]
    widths = [max(map(len, column)) for column in zip(names, units, *first)]
    if titles.failing:  # a reason may be long, and nothing stands after it
        widths[-1] = 0
    rule = look.charset.text("─") * (sum(widths) + 2 * (len(widths) - 1))
    for cells in (names, units) if any(units) else (names,):
        yield _line([look.charset.text(cell) for cell in cells], widths)
    yield rule + "\n"
    for cells in first:
        yield _line(cells, widths)
    for row in following:
        yield _line([_cell(value, look) for value in titles.values(row)], widths)


def _line(cells: Sequence[str], widths: Sequence[int]) -> str:
    return "  ".join(cell.rjust(width) for cell, width in zip(cells, widths)).rstrip() + "\n"


WRITERS: dict[str, Callable[..., Iterator[str]]] = {
    "csv": csv_rows,
    "json": json_rows,
    "markdown": markdown_rows,
    "table": table_rows,
}
