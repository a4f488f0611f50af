"""What tables show of a report: identical cylinders, pins and bearings once; on a low terminal a first selection."""

import re
from collections.abc import Callable, Collection, Hashable, Iterable, Sequence
from itertools import groupby
from typing import TypeVar

from kurbel.report.tables import KeyValue, Part, Report, Value

_NUMBERED = re.compile(r"(.*\D)(\d{1,9})$")
Item = TypeVar("Item")


def together(names: Sequence[str]) -> str:
    """Return several names as one text; names that differ only in a number are listed by their numbers.

    >>> together(["cylinder 1", "cylinder 2", "cylinder 3", "cylinder 6"]), together(["HP", "LP"])
    ('cylinders 1–3, 6', 'HP, LP')
    >>> together(["pin of left 1", "pin of right 1", "pin of left 2", "pin of right 2"])
    'pin of left 1, 2, right 1, 2'
    """
    texts = []
    for group in grouped(names, lambda name: _NUMBERED.sub(r"\1", name)):
        text = group[0]
        if len(group) > 1:
            # runs of numbers from the first to the last
            numbers = [int(found.group(2)) for name in group if (found := _NUMBERED.fullmatch(name))]
            runs = groupby(enumerate(numbers), lambda pair: pair[1] - pair[0])
            spans = [[number for _, number in run] for _, run in runs]
            listed = (f"{span[0]}–{span[-1]}" if len(span) > 2 else ", ".join(map(str, span)) for span in spans)
            stem = _NUMBERED.sub(r"\1", text).replace("cylinder ", "cylinders ")
            text = f"{stem}{', '.join(listed)}"
        texts.append(text)
    head, of, _ = texts[0].rpartition(" of ")
    shared = head + of if all(text.startswith(head + of) for text in texts) else ""
    return shared + ", ".join(text.removeprefix(shared) for text in texts)


def grouped(items: Iterable[Item], key: Callable[[Item], Hashable]) -> list[list[Item]]:
    """Return the items in groups of equal key, in order of first occurrence."""
    groups: dict[Hashable, list[Item]] = {}
    for item in items:
        groups.setdefault(key(item), []).append(item)
    return list(groups.values())


def shown_once(report: Report) -> Report:
    """Return the report with identical parts merged into one; the title names them if no other part is left.

    Pins and bearings are identical if their key values are, at any crank angles; cylinders, if in addition their tables
    over their own crank angle are.
    """
    if len(report.parts) < 2 or report.group not in ("cylinders", "bearings"):
        return report
    bearings = report.group == "bearings"

    def content(part: Part) -> Hashable:
        if bearings:
            return equal_loads(str(part.name), part.of, part.key_values), part.left_out
        columns = [part.columns, *(one.columns for one in part.place_tables)]
        curves = [(one.id, one.unit, _nine_digits(one.values)) for some in columns for one in some]
        titles = [(one.title, one.names) for one in part.place_tables]
        return *curves, _figures(part.key_values), part.left_out, *titles

    groups = grouped(report.parts, content)
    if len(groups) == len(report.parts):
        return report
    parts = []
    for group in groups:
        warnings = tuple(dict.fromkeys(warning for part in group for warning in part.warnings))
        parts.append(group[0]._replace(name=together([str(part.name) for part in group]), warnings=warnings))
    title = f"{report.title}: {parts[0].name}" if len(parts) == 1 and report.whole is None else report.title
    notes = (*report.notes, _SHIFTED) if bearings else report.notes
    return report._replace(parts=tuple(parts), title=title, notes=notes)


def first_selection(report: Report, ids: Collection[str], across: int, rows: int) -> Report:
    """Return the report with only these columns, key values and tables, and the warnings.

    across: the largest number of crank angles; rows: the largest number of rows of a table. Without ids all columns and
    key values stay, and the tables of the whole machine, if it has any.
    """
    report = shown_once(report)
    of_whole = report.whole is not None and report.whole.place_tables

    def chosen(part: Part) -> Part:
        columns = [one for one in part.columns if not ids or one.id in ids or one is part.columns[0]]
        last = len(part.columns[0].values) - 1 if len(columns) > 1 else 0
        by = next((k for k in range(1, last) if last % k == 0 and last // k < across), 1)
        tables = [one for one in part.place_tables if (one.id in ids if ids else not of_whole or part is report.whole)]
        return part._replace(
            columns=tuple(one._replace(values=one.values[::by], marked=()) for one in columns) if last else (),
            key_values=tuple(one for one in part.key_values if not ids or one.id in ids),
            place_tables=tuple(
                one._replace(
                    names=one.names[:rows],
                    columns=tuple(each._replace(values=each.values[:rows]) for each in one.columns),
                )
                for one in tables
            ),
            left_out=(),
        )

    way_on = f"First selection. All columns, angles and key values: kurbel {report.command} FILE --all"
    return report.changed(chosen)._replace(notes=(), head=(*report.head, way_on))


_SHIFTED = (
    "Pins and bearings named together carry equal loads, each at its own crank angles; those of the first are shown."
)


def equal_loads(name: str, of: str, key_values: Iterable[KeyValue]) -> Hashable:
    """Return a value that is the same for equally loaded bearings of one kind; of: the cylinder of a pin."""
    return name.removesuffix(of).rstrip("0123456789"), _figures(key_values)


def _figures(key_values: Iterable[KeyValue]) -> Hashable:
    """Return the key values without their crank angles, to nine digits of the largest one of the same unit."""
    given, by_unit = tuple(key_values), dict[str, list[Value]]()
    for one in given:
        if not one.noise:
            by_unit.setdefault(one.unit, []).extend(one.value if isinstance(one.value, tuple) else (one.value,))
    return *(one.id for one in given), *((unit, _nine_digits(values)) for unit, values in by_unit.items())


def _nine_digits(values: Sequence[Value]) -> Hashable:
    """Return the largest of these values, and a hash of all relative to it, both rounded to nine digits."""
    largest = max((abs(value) for value in values if value is not None), default=0.0) or 1.0
    relative = tuple(None if value is None else round(value / largest, 9) for value in values)
    return f"{largest:.9g}", hash(relative)  # the values of a long table would take much memory
