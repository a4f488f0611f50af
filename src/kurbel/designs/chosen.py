"""Choice of the rows of a sweep: by conditions, the best, the Pareto front; and a summary."""

import math
import operator
import re
from collections.abc import Callable, Iterable, Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np

from kurbel.arrays import Array, Flags, Indices
from kurbel.declared.numerals import keyboard_text
from kurbel.declared.reading import text_in_one_line
from kurbel.declared.unit_systems import convert
from kurbel.declared.units import other_zero, parse_quantity, written_unit
from kurbel.designs.answers import Cell, Design, Head
from kurbel.designs.binding import INFINITE
from kurbel.errors import UnitError, UsageError
from kurbel.near_words import did_you_mean
from kurbel.quantities import KEY_VALUES

_RELATIONS: dict[str, Callable[..., bool]] = {
    "<=": operator.le,
    ">=": operator.ge,
    "!=": operator.ne,
    "==": operator.eq,
    "≤": operator.le,
    "≥": operator.ge,
    "≠": operator.ne,
    "<": operator.lt,
    ">": operator.gt,
    "=": operator.eq,
}
_OF_WORDS = ("=", "==", "!=", "≠")
_CONDITION = re.compile(rf"(.+?)\s*({'|'.join(_RELATIONS)})\s*(.*)")


class RowCondition(NamedTuple):
    """A comparison of a column, counted through the values and the texts, with a value in its unit, or with a text."""

    place: int
    relation: str
    value: float | str

    def holds(self, row: Design) -> bool:
        """Return whether it holds; a row without that value keeps no condition."""
        cell = (*row.values, *row.texts)[self.place]
        value = cell if isinstance(self.value, str) else _number(cell)
        return value is not None and _RELATIONS[self.relation](value, self.value)


def condition_parts(text: str) -> tuple[str, str, str]:
    """Return the column, the relation and the value of a condition; raises UsageError."""
    condition = _CONDITION.fullmatch(keyboard_text(text).strip())
    if not condition:
        raise UsageError(
            "--where: expected a column, a relation and a value, such as 'c_max < 5 m/s', "
            f"got {text_in_one_line(text)!r}"
        )
    name, relation, written = (part.strip() for part in condition.groups())
    return name, relation, written


def read_condition(text: str, heads: Sequence[Head], option: str = "--where") -> RowCondition:
    """Read `c_max < 5 m/s` or, for a column of words, `keeps = yes`; raises UsageError."""
    name, relation, written = condition_parts(text)
    number = place_of(name, heads, option)
    where = f"{option} {text_in_one_line(text)}"
    head = heads[number]
    if not head.kind:
        if relation not in _OF_WORDS:
            raise UsageError(
                f"{where}: {name} has words, of which none is less than another; write = or !="
            )
        if name == "keeps" and written not in ("yes", "no", ""):
            raise UsageError(f"{where}: keeps is yes, no, or empty where a limit cannot be judged")
        return RowCondition(number, relation, written)
    try:
        is_infinite = head.input and written == INFINITE
        value = math.inf if is_infinite else parse_quantity(written, head.kind)
    except UnitError as error:
        raise UsageError(f"{where}: {error}") from None
    wrong_zero = head.kind == "pressure" and other_zero(written_unit(written), head.zero, name)
    if wrong_zero:
        raise UsageError(f"{where}: {wrong_zero}")
    return RowCondition(number, relation, float(convert(value, head.kind, head.unit)))


def place_of(name: str, heads: Sequence[Head], option: str) -> int:
    """Return which column of single values a name or a printed symbol is; raises UsageError."""
    ids = tuple(head.id for head in heads)
    owner, _, symbol = name.rpartition(".")
    meant = [name]
    if name not in ids:
        meant += (f"{owner}.{id}".lstrip(".") for id in KEY_VALUES.ids_of(symbol))
    number = next((ids.index(column) for column in meant if column in ids), None)
    if number is None:
        raise UsageError(
            f"{option}: no column '{text_in_one_line(name)}'{did_you_mean(name, ids)} (there are {', '.join(ids)})"
        )
    if heads[number].listed:
        raise UsageError(
            f"{option}: {ids[number]} is a list of values, which is neither more nor less than another one"
        )
    return number


def _number(value: Cell) -> float | None:
    """Return the number in a cell, inf for an infinite rod; None where there is none."""
    if value == INFINITE:
        return math.inf
    return value if isinstance(value, (int, float)) else None


class Aim(NamedTuple):
    """A column of which the smallest values are the best, or, with `most`, the largest ones."""

    place: int
    most: bool

    def of(self, row: Design) -> tuple[bool, float]:
        """Return whether there is no number, and the cost, of which less is better."""
        value = _number(row.values[self.place])
        cost = value or 0.0
        return value is None, -cost if self.most else cost


def read_aim(text: str, heads: Sequence[Head], option: str) -> Aim:
    """Read `T_max`, the smallest value first, or `-T_max`, the largest first; raises UsageError."""
    name = text.strip()
    number = place_of(name.removeprefix("-"), heads, option)
    if not heads[number].kind:
        raise UsageError(f"{option}: {heads[number].id} has words, of which none is the best")
    return Aim(number, name.startswith("-"))


def pareto_front(rows: Iterable[Design], aims: Sequence[Aim]) -> Iterator[Design]:
    """Yield the Pareto front: the rows than which no other is better in one aim and as good in all."""
    judged, costs = list[Design](), list[list[float]]()
    for row in rows:
        verdicts = [aim.of(row) for aim in aims]
        if not any(lacks for lacks, _ in verdicts):
            judged.append(row)
            costs.append([cost for _, cost in verdicts])
    is_best = unbettered(np.array(costs).reshape(len(judged), len(aims)))
    return (row for row, is_there in zip(judged, is_best.tolist()) if is_there)


_BLOCK = 512
"""Points that are compared with one another together."""


def unbettered(costs: Array) -> Flags:
    """Return which points (n, aims) no other is less in one cost and not more in any; equal ones stand together.

    In the order of the first cost, of equal ones in that of the next, a point is bettered by earlier ones alone, and by
    any of these that is not more in the other costs. Of two costs the least one so far decides.
    """
    count, aims = costs.shape
    if not count:
        return np.zeros(0, dtype=bool)

    # points in order, equal ones once
    order = np.lexsort(costs.T[::-1])
    ordered = costs[order]
    is_new = np.ones(count, dtype=bool)
    is_new[1:] = (ordered[1:] != ordered[:-1]).any(axis=1)
    points = ordered[is_new]

    if aims <= 2:
        others = points[:, -1]
        least_before = np.minimum.accumulate(others)[:-1]
        stays: Flags = np.ones(len(points), dtype=bool)
        stays[1:] = others[1:] < least_before if aims == 2 else False
    else:
        stays = _unbettered_by_blocks(_ranks(points[:, 1:]))

    is_unbettered = np.empty(count, dtype=bool)
    is_unbettered[order] = stays[np.cumsum(is_new) - 1]
    return is_unbettered


def _ranks(points: Array) -> Indices:
    """Return the ranks of points (n, costs) in each cost, equal ones sharing theirs, in the narrowest integers.

    They compare as the costs do, and many times as fast.
    """
    narrowest = np.min_scalar_type(len(points))
    ranks = np.empty(points.shape, dtype=narrowest)
    for cost, values in enumerate(points.T):
        _, rank = np.unique(values, return_inverse=True)
        ranks[:, cost] = rank
    return ranks


def _unbettered_by_blocks(points: Indices) -> Flags:
    """Return which of different points (n, costs) have no earlier one that is not more in any cost."""
    stays = np.ones(len(points), dtype=bool)
    front = np.empty((0, points.shape[1]), dtype=points.dtype)
    for begin in range(0, len(points), _BLOCK):
        rest = np.arange(begin, min(begin + _BLOCK, len(points)))

        # by the front of all blocks before, of which a processor's cache holds a part
        for part in np.split(front, range(_BLOCK, len(front), _BLOCK)):
            rest = rest[~_is_reached(part, points[rest]).any(axis=0)]

        # by earlier ones of this block
        among = _is_reached(points[rest], points[rest])
        is_earlier = np.tri(len(rest), k=-1, dtype=bool).T
        rest = rest[~(among & is_earlier).any(axis=0)]

        stays[begin : begin + _BLOCK] = False
        stays[rest] = True
        front = np.concatenate((front, points[rest]))
    return stays


def _is_reached(first: Indices, second: Indices) -> Flags:
    """Return which of the first points (n, costs) are in no cost more than which of the second ones, (n, second)."""
    reached = np.ones((len(first), len(second)), dtype=bool)
    is_less = np.empty_like(reached)
    for cost, other in zip(first.T, second.T):
        np.less_equal(cost[:, None], other, out=is_less)
        reached &= is_less
    return reached


class Unit(str):
    """A unit in a cell, which a table writes as units are written."""


QUANTILES = (0.0, 0.05, 0.25, 0.5, 0.75, 0.95, 1.0)


def summary_heads(heads: Sequence[Head]) -> tuple[tuple[str, str], ...]:
    """Return names and units of the columns of a summary: quantiles, and the rank correlation with every input."""
    names = ["unit", "rows", "mean"]
    names += [f"q{100 * q:g}" for q in QUANTILES]
    names += [f"r({head.id})" for head in heads if head.input]
    return tuple((name, "") for name in names)


def column_summaries(rows: Iterable[Design], heads: Sequence[Head]) -> Iterator[Design]:
    """Yield a row for every column of numbers, over the rows that have a value there."""
    values_by_row = [row.values for row in rows]
    columns = [_numbers_of(cells) for cells in zip(*values_by_row)]
    inputs = [numbers for numbers, head in zip(columns, heads) if head.input]
    for numbers, head in zip(columns, heads):
        finite = numbers[np.isfinite(numbers)]
        if head.kind and len(finite):
            figures: list[Any] = [Unit(head.unit), len(finite), float(finite.mean())]
            figures += np.quantile(finite, QUANTILES).tolist()
            figures += [_rank_correlation(numbers, input_numbers) for input_numbers in inputs]
            yield Design(head.id, tuple(figures))  # type: ignore[arg-type]


def _numbers_of(cells: Iterable[object]) -> Array:
    """Return the numbers in a column, nan for all else."""
    numbers = [cell if isinstance(cell, (int, float)) else np.nan for cell in cells]
    return np.array(numbers, dtype=float)


def _rank_correlation(first: Array, second: Array) -> float | None:
    """Return the correlation of the ranks (Spearman), equal ones sharing theirs; None where one does not vary."""
    there = np.isfinite(first) & np.isfinite(second)
    ranks = []
    for values in (first[there], second[there]):
        _, group, counts = np.unique(values, return_inverse=True, return_counts=True)
        if len(counts) < 2:
            return None
        ranks.append((np.cumsum(counts) - (counts + 1) / 2)[group])
    return float(np.asarray(np.corrcoef(ranks))[0, 1])
