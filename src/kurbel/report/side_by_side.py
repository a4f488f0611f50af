"""Two machines side by side: what they were given differently, key values with their differences, pictures in pairs."""

from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import partial
from itertools import zip_longest
from operator import itemgetter
from typing import Any, TypeVar

import numpy as np

from kurbel.declared.quantity import Quantity
from kurbel.declared.unit_systems import convert, units_of
from kurbel.errors import KurbelError
from kurbel.numerics.extreme import number_of, size_of
from kurbel.report.alike import grouped, together
from kurbel.report.commands import subjects_of
from kurbel.report.document import Document, Grid, Pair, Section
from kurbel.report.frame import Subject
from kurbel.report.picture_source import PictureOptions
from kurbel.report.pictures import PICTURES, pictures_if_any
from kurbel.report.provenance import provenance
from kurbel.report.whole import COMMANDS, Command, Given, Progress
from kurbel.solver.case import Case

_NONE = "–"
Item = TypeVar("Item")


@np.errstate(all="ignore")
def side_by_side(cases: Sequence[Case], given: Sequence[Given], system: str, progress: Progress) -> Document:
    """Return two machines side by side. progress: is told what is being done."""
    first, second = _names(cases)
    told = (*_files(cases, (first, second)), *_given(given, first, second))
    sections = [Section("input", "What was given differently", told)]
    for command in COMMANDS:
        progress(command.title.lower())
        sections.append(Section(command.word, command.title, tuple(_of_command(cases, command, system))))
    sources = tuple(provenance(case.machine) for case in cases)
    return Document(f"{first} and {second}", sources, tuple(one for one in sections if one.items))


def _names(cases: Sequence[Case]) -> tuple[str, str]:
    """Return the names of both, told apart by A and B where they are one."""
    first, second = (case.machine.name for case in cases)
    return (first, second) if first != second else (f"{first} (A)", f"{second} (B)")


def _given(given: Sequence[Given], first: str, second: str) -> Iterator[Grid | str]:
    one, other = map(dict, given)
    keys = list(dict.fromkeys((*one, *other)))
    rows = [(key, one.get(key, _NONE), other.get(key, _NONE)) for key in keys if one.get(key) != other.get(key)]
    yield Grid("Keys", ("Key", first, second), tuple(rows)) if rows else "Nothing: both files give the same."


def _files(cases: Sequence[Case], names: Sequence[str]) -> Iterator[str]:
    """Yield which file describes which machine."""
    files = [case.machine.origin.name for case in cases if case.machine.origin]
    if len(files) == len(names):
        yield "; ".join(f"{name} is that of {file}" for name, file in zip(names, files)) + "."


def _of_command(cases: Sequence[Case], command: Command, system: str) -> Iterator[Grid | Pair]:
    """Yield the key values of both machines, cylinder beside cylinder, equal ones once, and then the pictures."""
    both = [_had(partial(subjects_of, case, command.word)) for case in cases]
    heads = ("Symbol", *_names(cases), "Unit", "Difference", "Meaning")
    told = [((one or other).name, tuple(_rows(one, other, command.word, system))) for one, other in zip_longest(*both)]
    for equal in grouped(told, itemgetter(1)):
        names, (rows, *_) = zip(*equal)
        if rows:
            yield Grid(together(names) if len(told) > 1 else "Key values", heads, rows, (1, 2, 4), (3,))
    for declared in PICTURES:
        if declared.command == command.word:
            drawn = [_had(partial(pictures_if_any, case, declared, PictureOptions(system))) for case in cases]
            # each picture is named as its machine is here
            called = [[one._replace(machine=name) for one in ones] for ones, name in zip(drawn, _names(cases))]
            yield from (Pair(left, right) for left, right in zip_longest(*called))


def _had(found: Callable[[], Iterable[Item]]) -> list[Item]:
    """Return what is found of a machine, nothing where it has none of that."""
    try:
        return list(found())
    except KurbelError:
        return []


def _rows(left: Subject | None, right: Subject | None, command: str, system: str) -> Iterator[tuple[str, ...]]:
    found = [_values(one, command) for one in (left, right)]
    told = {quantity: [one.get(quantity) for one in found] for quantity in (*found[0], *found[1])}
    units = units_of([(one.kind, one.family, max(map(size_of, values))) for one, values in told.items()], system)
    for (quantity, values), unit in zip(told.items(), units):
        texts = [_NONE if value is None else f"{convert(value, quantity.kind, unit):.5g}" for value in values]
        yield quantity.symbol, *texts, quantity.marked(unit), _difference(values), quantity.text


def _values(subject: Subject | None, command: str) -> dict[Quantity, float]:
    """Return the single key values of a subject in SI; lists are not compared, nor is rounding."""
    try:
        found: dict[Quantity, Any] = dict(subject.key_values(command)) if subject else {}
    except KurbelError:
        return {}
    numbers = {one: number_of(value) for one, value in found.items()}
    return {one: value for one, value in numbers.items() if isinstance(value, (int, float)) and not one.residual}


def _difference(values: Sequence[float | None]) -> str:
    """Return by how many percent of the first the second is larger, where that can be told."""
    first, second = values
    if first is None or second is None or (not first and second):
        return _NONE
    percent = 100 * (second - first) / abs(first) if first else 0.0
    return f"{percent:+.{2 if abs(percent) < 100 else 0}f} %" if percent else "0 %"
