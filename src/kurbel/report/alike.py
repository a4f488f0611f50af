"""Equal cylinders, pins and bearings, which tables and pages show once; CSV and JSON list every one."""

import re
from collections.abc import Callable, Hashable, Iterable, Sequence
from itertools import groupby
from typing import TypeVar

from kurbel.report.tables import Column, KeyValue, Part, PlaceTable, Report, Value

_NUMBERED = re.compile(r"(.*\D)(\d{1,9})")
_NINE_DIGITS = 1e-9
Item = TypeVar("Item")


def together(names: Sequence[str]) -> str:
    """Return several names as one: those that differ in their number by their numbers.

    >>> together(["cylinder 1", "cylinder 2", "cylinder 3", "cylinder 6"]), together(["HP", "LP"])
    ('cylinders 1–3, 6', 'HP, LP')
    >>> together(["pin of left 1", "pin of right 1", "pin of left 2", "pin of right 2"])
    'pin of left 1, 2, right 1, 2'
    """
    texts = [_numbered(group) for group in grouped(names, _stem)]
    head, of, _ = texts[0].rpartition(" of ")
    shared = head + of if all(text.startswith(head + of) for text in texts) else ""
    return shared + ", ".join(text.removeprefix(shared) for text in texts)


def _stem(name: str) -> str:
    found = _NUMBERED.fullmatch(name)
    return found.group(1) if found else name


def _numbered(names: Sequence[str]) -> str:
    """Return names of one stem with their numbers, runs of them from the first to the last."""
    if len(names) == 1:
        return names[0]
    numbers = [int(found.group(2)) for name in names if (found := _NUMBERED.fullmatch(name))]
    runs = groupby(enumerate(numbers), lambda pair: pair[1] - pair[0])
    spans = [[number for _, number in run] for _, run in runs]
    texts = (f"{span[0]}–{span[-1]}" if len(span) > 2 else ", ".join(map(str, span)) for span in spans)
    return f"{_stem(names[0]).replace('cylinder ', 'cylinders ')}{', '.join(texts)}"


def grouped(items: Iterable[Item], key: Callable[[Item], Hashable]) -> list[list[Item]]:
    """Return the items in groups of equal key, in the order of their first ones."""
    groups: dict[Hashable, list[Item]] = {}
    for item in items:
        groups.setdefault(key(item), []).append(item)
    return list(groups.values())


def told_once(report: Report) -> Report:
    """Return the report with its equal parts as one; its title names them if no other part is left.

    Pins and bearings are equal if their key values are, at whatever crank angles they are loaded.
    """
    equal = _EQUAL.get(report.group)
    if equal is None or len(report.parts) < 2:
        return report
    groups: list[list[Part]] = []
    for part in report.parts:
        found = next((group for group in groups if equal(group[0], part)), None)
        groups.append([part]) if found is None else found.append(part)
    if len(groups) == len(report.parts):
        return report
    parts = tuple(_as_one(group) for group in groups)
    alone = len(parts) == 1 and report.whole is None
    return report._replace(
        parts=parts,
        title=f"{report.title}: {parts[0].name}" if alone else report.title,
        notes=(*report.notes, _SHIFTED) if report.group == "bearings" else report.notes,
    )


_SHIFTED = (
    "Pins and bearings named together carry equal loads, each at its own crank angles; those of the first are shown."
)


def _equal_cylinders(one: Part, other: Part) -> bool:
    return (
        _equal_figures(one, other)
        and _equal_curves(one.columns, other.columns)
        and len(one.place_tables) == len(other.place_tables)
        and all(map(_equal_tables, one.place_tables, other.place_tables))
        and one.nowhere == other.nowhere
    )


def _equal_bearings(one: Part, other: Part) -> bool:
    """Whether both are of one kind, such as main bearings, and carry equal loads."""
    return _kind(one) == _kind(other) and _equal_figures(one, other)


_EQUAL = {"cylinders": _equal_cylinders, "bearings": _equal_bearings}
"""Group of a report -> whether two parts of it are equal."""


def _kind(part: Part) -> str:
    return str(part.name).removesuffix(part.of).rstrip("0123456789")


def _equal_figures(one: Part, other: Part) -> bool:
    """Whether the key values, without the angles at which they are, and what is left out are equal."""
    if [value.id for value in one.key_values] != [value.id for value in other.key_values]:
        return False
    some, others = _by_unit(one.key_values), _by_unit(other.key_values)
    near = some.keys() == others.keys() and all(_near(values, others[unit]) for unit, values in some.items())
    return near and tuple(one.left_out) == tuple(other.left_out)


def _by_unit(key_values: Iterable[KeyValue]) -> dict[str, list[Value]]:
    found: dict[str, list[Value]] = {}
    for one in key_values:
        if not one.noise:
            found.setdefault(one.unit, []).extend(one.value if isinstance(one.value, tuple) else (one.value,))
    return found


def _equal_tables(one: PlaceTable, other: PlaceTable) -> bool:
    same = (one.id, one.title, one.names, one.said) == (other.id, other.title, other.names, other.said)
    return same and _equal_curves(one.columns, other.columns)


def _equal_curves(some: Sequence[Column], others: Sequence[Column]) -> bool:
    return [(one.id, one.unit) for one in some] == [(one.id, one.unit) for one in others] and all(
        _near(one.values, other.values) for one, other in zip(some, others)
    )


def _near(some: Sequence[Value], others: Sequence[Value]) -> bool:
    """Whether values are equal to nine digits of the largest of them."""
    if some == others:
        return True
    slack = _NINE_DIGITS * max((abs(value) for value in some if value is not None), default=0.0)
    return len(some) == len(others) and all(
        a == b or (a is not None and b is not None and abs(a - b) <= slack) for a, b in zip(some, others)
    )


def _as_one(parts: Sequence[Part]) -> Part:
    warnings = tuple(dict.fromkeys(warning for part in parts for warning in part.warnings))
    return parts[0]._replace(name=together([str(part.name) for part in parts]), warnings=warnings)
