"""What a report is made of, whatever it will be rendered as."""

from __future__ import annotations

from typing import NamedTuple, Union

from kurbel.errors import UsageError

Value = Union[float, int, None]


class Column(NamedTuple):
    """One quantity over the crank angle, already in the unit in which it is shown; None where it has no value.

    decimals: fixed number of decimals in printed tables, where the digits of a source are to be kept;
    marked: indices of the values that the printed table marks with an asterisk.
    """

    id: str
    symbol: str
    ascii_symbol: str
    unit: str
    values: tuple[Value, ...]
    text: str = ""
    decimals: int | None = None
    marked: tuple[int, ...] = ()


class KeyValue(NamedTuple):
    """One key value, already in its unit; a tuple for a list of angles; `at_deg` is where an extreme stands."""

    id: str
    symbol: str
    ascii_symbol: str
    unit: str
    value: Value | tuple[float, ...]
    text: str
    at_deg: float | None = None


class LeftOut(NamedTuple):
    """What was neither computed nor printed, and why."""

    what: str
    why: str


class Part(NamedTuple):
    """The results of one cylinder, of one L/R, or of the whole machine; the first column is the crank angle.

    `name` is the cylinder's name or the L/R as a number.
    """

    name: str | float
    columns: tuple[Column, ...]
    key_values: tuple[KeyValue, ...] = ()
    left_out: tuple[LeftOut, ...] = ()
    warnings: tuple[str, ...] = ()


class Report(NamedTuple):
    """One answer of one command.

    title: head line over the printed table, with its German title; command and machine as in JSON (`machine` is None
    for `kurbel table`); group: `cylinders` or `ratios`, the JSON key of `parts`; whole: the results of the whole
    machine, if any; mirrored: what changes under a second head line of the angles 360° − φ (empty: no such line);
    notes: sentences below the table.
    """

    title: str
    command: str
    machine: str | None
    group: str
    parts: tuple[Part, ...]
    whole: Part | None = None
    mirrored: str = ""
    notes: tuple[str, ...] = ()

    @property
    def all_parts(self) -> tuple[Part, ...]:
        """The parts, and the whole machine after them."""
        return self.parts if self.whole is None else (*self.parts, self.whole)


def choose_columns(report: Report, ids: tuple[str, ...]) -> Report:
    """Return the report with the crank angle and these columns alone, in this order.

    A column that only some parts have stands in those. Raises UsageError for an id that no part has.
    """
    known = tuple(dict.fromkeys(column.id for part in report.all_parts for column in part.columns))
    for id in ids:
        if id not in known:
            raise UsageError(f"--columns: no column '{id}' here{did_you_mean(id, known)} (known: {', '.join(known)})")

    def chosen(part: Part) -> Part:
        by_id = {column.id: column for column in part.columns[1:]}
        kept = tuple(by_id[id] for id in dict.fromkeys(ids) if id in by_id)
        return part._replace(columns=part.columns[:1] + kept)

    whole = None if report.whole is None else chosen(report.whole)
    return report._replace(parts=tuple(chosen(part) for part in report.parts), whole=whole)


def did_you_mean(word: str, known: tuple[str, ...]) -> str:
    """Return `; did you mean 'x'?` for the nearest known word, or nothing where none is near."""
    from difflib import get_close_matches

    same = [name for name in known if name.lower() == word.lower()]
    near = same or get_close_matches(word, known, n=1)
    return f"; did you mean '{near[0]}'?" if near else ""
