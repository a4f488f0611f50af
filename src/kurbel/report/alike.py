"""Equal cylinders, told once to people: programs read each of them."""

import re
from collections.abc import Callable, Hashable, Iterable, Sequence
from itertools import groupby
from typing import TypeVar

from kurbel.report.tables import Part, Report

Item = TypeVar("Item")


def together(names: Sequence[str]) -> str:
    """Return several names as one: those that differ in their number by their numbers.

    >>> together(["cylinder 1", "cylinder 2", "cylinder 3", "cylinder 6"]), together(["HP", "LP"])
    ('cylinders 1–3, 6', 'HP, LP')
    """
    found = [re.fullmatch(r"(.*\D)(\d{1,9})", name) for name in names]
    stems = {one.group(1) for one in found if one}
    if len(names) == 1 or len(stems) > 1 or None in found:
        return ", ".join(names)
    runs = groupby(enumerate(int(one.group(2)) for one in found if one), lambda pair: pair[1] - pair[0])
    spans = [[number for _, number in run] for _, run in runs]
    texts = (f"{span[0]}–{span[-1]}" if len(span) > 2 else ", ".join(map(str, span)) for span in spans)
    return f"{stems.pop().replace('cylinder ', 'cylinders ')}{', '.join(texts)}"


def grouped(items: Iterable[Item], key: Callable[[Item], Hashable]) -> list[list[Item]]:
    """Return the items in groups of equal key, in the order of their first ones."""
    groups: dict[Hashable, list[Item]] = {}
    for item in items:
        groups.setdefault(key(item), []).append(item)
    return list(groups.values())


def told_once(report: Report) -> Report:
    """Return the report with its equal cylinders as one part; its title names them where no other part is left."""
    if len(report.parts) < 2 or report.group != "cylinders":
        return report
    from kurbel.machine.alike import gathered  # not for a table of factors, which knows no machine

    groups = gathered(report.parts, _equal)
    if len(groups) == len(report.parts):
        return report
    parts = tuple(_as_one(group) for group in groups)
    alone = len(parts) == 1 and report.whole is None
    return report._replace(parts=parts, title=f"{report.title}: {parts[0].name}" if alone else report.title)


def _equal(one: Part, other: Part) -> bool:
    """Return whether two parts say the same but for their warnings, which may be of the whole machine."""
    told = ("columns", "key_values", "left_out", "place_tables")
    return all(tuple(getattr(one, name)) == tuple(getattr(other, name)) for name in told)


def _as_one(parts: Sequence[Part]) -> Part:
    warnings = tuple(dict.fromkeys(warning for part in parts for warning in part.warnings))
    return parts[0]._replace(name=together([str(part.name) for part in parts]), warnings=warnings)
