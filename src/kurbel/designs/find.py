"""The values of one or two keys that give required key values, or that make a key value least or greatest."""

from __future__ import annotations

import re
from collections.abc import Callable, Sequence
from itertools import groupby, product
from typing import NamedTuple

import numpy as np

from kurbel.arrays import Array
from kurbel.declared.reading import text_in_one_line
from kurbel.declared.unit_systems import SI, convert, show
from kurbel.declared.units import parse_quantity
from kurbel.designs.answers import Design, Head, Study
from kurbel.designs.chosen import condition_parts, place_of, read_condition
from kurbel.designs.plan import read_span
from kurbel.errors import NoSolutionError, UsageError
from kurbel.machine.origin import Origin
from kurbel.machine_file.overrides import path_of
from kurbel.numerics.search import common_roots, lowest, roots

_EQUATION = re.compile("[^<>≤≥≠!=]+==?[^=]+")
_EQUAL = 1e-12
"""Relative difference below which extremes are equal."""
_ASIDE = 1e-6
"""Share of the range: step from an extreme to a design that shows which bound limits it."""
_FLAT = 0.02
"""Share of the range, over which an extreme is as good, that is reported."""


class Varied(NamedTuple):
    """A key and the range of its values, in SI; unit: that of the range as written."""

    key: str
    low: float
    high: float
    unit: str
    kind: str

    def in_unit(self, value: float) -> float:
        """Return a value in SI in the unit of the range."""
        return float(convert(value, self.kind, self.unit))

    def written(self, value: float, figures: int = 6) -> str:
        """Return a value in SI as a text in the unit of the range."""
        return f"{self.in_unit(value):.{figures}g} {self.unit}".rstrip()


class Target(NamedTuple):
    """A key value that is to have a value in SI (aim `=`), or to be the `least` or the `greatest`.

    place: among the key values of a solution.
    """

    text: str
    head: Head
    place: int
    aim: str
    value: float | None


class Solution(NamedTuple):
    """Values of the keys, the key values that they give, in SI, and notes on limits that are broken or are binding."""

    values: tuple[float, ...]
    key_values: tuple[float, ...]
    notes: tuple[str, ...] = ()


class Failed(NamedTuple):
    """A part of the range of the only key, in SI, in which designs fail, and why the first of them does."""

    low: float
    high: float
    why: str


class _Design(NamedTuple):
    """A design that was computed: its numbers and key values in SI, nan where it fails.

    failure: why it fails; broken, unmet: the limits and conditions that it breaks, or why it fails.
    """

    numbers: tuple[float, ...]
    values: tuple[float, ...]
    failure: str
    broken: str
    unmet: str


def find_solutions(
    origin: Origin,
    vary: Sequence[str],
    equations: Sequence[str] = (),
    least: str = "",
    greatest: str = "",
    conditions: Sequence[str] = (),
    progress: Callable[[str], None] | None = None,
) -> Solutions:
    """Return the values of keys of a machine file that give wanted key values, or an extreme one.

    vary: one or two texts `KEY=low:high unit`; equations: as many texts `KEY_VALUE = value`, or none and the name of a
    key value that is to be the least or the greatest; conditions, as those of `kurbel sweep --where`: solutions keep
    them, and an extreme keeps the limits of the file, too.

    Raises UsageError for what cannot be read, and NoSolutionError, with what was met, where nothing is found.
    """
    extreme = least or greatest
    if wrong := next((equation for equation in equations if not _EQUATION.fullmatch(equation)), ""):
        raise UsageError(
            f"{text_in_one_line(wrong)}: write an equation, such as 'N_max = 4 kN'; a bound has --where"
        )
    if (
        not 1 <= len(vary) <= 2
        or (least and greatest)
        or len(equations) != (0 if extreme else len(vary))
    ):
        raise UsageError(
            "give --vary KEY=low:high and 'KEY_VALUE = value', two of both, or --least or --greatest"
        )
    found = Solutions(origin, vary, [extreme] if extreme else equations, conditions, progress)
    if extreme:
        found.find_extreme("least" if least else "greatest")
    else:
        found.solve()
    if not found.found:
        raise NoSolutionError(_nothing(found))
    return found


class Solutions:
    """Solutions in the order of the first key, and jumps: places where a key value jumps across the wanted value.

    machine: its name; heads, answers: of the key values of a solution, in SI; computed: all designs of the search, in
    the order of their keys; excluded: the number of solutions that break a condition. A place is one of (n, keys), from
    0 to 1 in each range.
    """

    def __init__(
        self,
        origin: Origin,
        vary: Sequence[str],
        wanted: Sequence[str],
        conditions: Sequence[str],
        progress: Callable[[str], None] | None,
    ) -> None:
        self.progress = progress
        spans = [read_span(one) for one in vary]
        keys = [key for key, *_ in spans]
        if len({path_of(key) for key in keys}) < len(keys):
            raise UsageError(f"--vary {keys[-1]}: this key is varied twice")
        names = [one.partition("=")[0].strip() for one in wanted]
        names += [
            name
            for name in (condition_parts(condition)[0] for condition in conditions)
            if name not in keys
        ]
        ends = product(*((low, high) for _, low, high, _ in spans))
        self.study = Study(origin, keys, ends, names, option="find")
        self.machine, self.answers = self.study.binder.machine.name, self.study.answers
        self.varied = [_varied(span, kind) for span, kind in zip(spans, self.study.binder.kinds)]
        heads = [
            *(Head(one.key, SI[one.kind], one.kind, input=True) for one in self.varied),
            *self.study.heads("si"),
        ]
        self.heads = tuple(heads[len(keys) :])
        self.wanted: list[Target] = []
        for text, name in zip(wanted, names):
            place = place_of(name, heads, "find")
            value = None if text == name else float(read_condition(text, heads, "find").value)
            self.wanted.append(Target(text.strip(), heads[place], place - len(keys), "=", value))
        self.conditions = [
            (condition, read_condition(condition, heads)) for condition in conditions
        ]
        self.computed: list[_Design] = []
        self.found: list[Solution] = []
        self.jumps: list[Solution] = []
        self.excluded = 0

    def at(self, places: Array) -> list[_Design]:
        """Return the designs at places (n, keys)."""
        if self.progress:
            self.progress(f"{len(self.computed)} designs computed")
        low, high = np.array([(one.low, one.high) for one in self.varied]).T
        numbers = low * (1 - places) + high * places
        found = []
        for row, one in zip(numbers.tolist(), self.study.of(self.study.binder.columns(numbers))):
            values = tuple(
                np.array(one.values or [np.nan] * len(self.study.answers), dtype=float).tolist()
            )
            design = Design(0, (*row, *one.values))
            unmet = one.failure or ", ".join(
                text for text, each in self.conditions if not each.holds(design)
            )
            broken = one.failure or ", ".join(f"limits.{name}" for name in one.broken)
            found.append(_Design(tuple(row), values, one.failure, broken, unmet))
        self.computed = sorted([*self.computed, *found])
        return found

    def solve(self) -> None:
        """Find where all equations hold, and, for a single equation, where the key value jumps across its value."""
        columns = [one.place for one in self.wanted]
        wanted = np.array([one.value for one in self.wanted], dtype=float)

        def left(places: Array) -> Array:
            return np.array([one.values for one in self.at(places)])[:, columns] - wanted

        if len(wanted) == 1:
            found, jumps, until = roots(lambda places: left(places)[:, 0], abs(float(wanted[0])))
            if not self.depends(0):
                return
            places = found[:, None]
        else:
            places = common_roots(left)
            jumps = np.zeros(len(places), dtype=bool)
            until = np.full(len(places), np.nan)
        designs = self.at(places) if len(places) else []
        for design, jump, end in zip(designs, jumps, until):
            if design.unmet:
                self.excluded += 1
                continue
            notes = [f"breaks {design.broken}"] if design.broken else []
            if np.isfinite(end):
                (key,) = self.varied
                last = key.low * (1 - end) + key.high * end
                notes.append(f"the same up to {key.written(last)}")
            solution = Solution(design.numbers, design.values, tuple(notes))
            (self.jumps if jump else self.found).append(solution)
        self.found.sort()

    def depends(self, number: int) -> bool:
        """Return whether a wanted key value differs, by more than rounding, between the designs that were computed."""
        low, high = self.met[number]
        return not high - low <= _EQUAL * max(abs(low), abs(high))

    def find_extreme(self, aim: str) -> None:
        """Find the design whose key value is the `least` or the `greatest` within all limits, if there is one."""
        sign = 1.0 if aim == "least" else -1.0
        self.wanted = [self.wanted[0]._replace(aim=aim)]
        column = self.wanted[0].place

        def cost(places: Array) -> Array:
            found = self.at(places)
            return np.array(
                [np.nan if one.broken or one.unmet else sign * one.values[column] for one in found]
            )

        place, best = lowest(cost, len(self.varied))
        if np.isfinite(best):
            (one,) = self.at(place[None])
            self.found.append(Solution(one.numbers, one.values, self._bounds(place, best * sign)))

    def _bounds(self, place: Array, best: float) -> tuple[str, ...]:
        """Return at which bounds an extreme is, and over which range of the only key it is as good."""
        notes: list[str] = []
        steps = _ASIDE * np.concatenate([np.eye(len(place)), -np.eye(len(place))])
        aside = self.at(np.clip(place + steps, 0.0, 1.0))
        for own, one in zip(place.tolist(), self.varied):
            if min(own, 1 - own) < _ASIDE:
                notes.append(
                    f"{one.key} is at the {'least' if own < 0.5 else 'greatest'} of its range"
                )
        beyond = dict.fromkeys([*(one.broken for one in aside), *(one.unmet for one in aside)])
        notes += [f"beyond it: {text}" for text in beyond if text]
        if len(place) == 1:
            (key,), column = self.varied, self.wanted[0].place
            for same, part in groupby(
                self.computed, key=lambda one: abs(one.values[column] - best) <= _EQUAL * abs(best)
            ):
                level = [one.numbers[0] for one in part]
                if same and level[-1] - level[0] > _FLAT * (key.high - key.low):
                    notes.append(
                        f"as good from {key.in_unit(level[0]):.6g} to {key.written(level[-1])}"
                    )
        return tuple(notes)

    def has_wanted(self, number: int) -> bool:
        """Return whether a key value that does not depend on the keys is the wanted one."""
        value, (_, met) = self.wanted[number].value, self.met[number]
        return value is not None and abs(met - value) <= _EQUAL * abs(value)

    @property
    def places(self) -> Array:
        """All designs that were computed (n, keys), in SI."""
        return np.array([one.numbers for one in self.computed])

    @property
    def values(self) -> Array:
        """Their key values (n, answers) in SI."""
        return np.array([one.values for one in self.computed])

    @property
    def met(self) -> list[tuple[float, float]]:
        """Least and greatest value of each wanted key value."""
        columns = [self.values[:, one.place] for one in self.wanted]
        return [
            (np.nanmin(column, initial=np.inf), np.nanmax(column, initial=-np.inf))
            for column in columns
        ]

    @property
    def failed(self) -> list[Failed]:
        """The parts of the range of the only key in which designs fail."""
        along = self.computed if len(self.varied) == 1 else []
        parts = [
            list(part) for fails, part in groupby(along, key=lambda one: bool(one.failure)) if fails
        ]
        return [Failed(part[0].numbers[0], part[-1].numbers[0], part[0].failure) for part in parts]


def _nothing(found: Solutions) -> str:
    """Return the message that nothing was found, with the values that were met."""
    ranges = " and ".join(
        f"{one.key} from {one.in_unit(one.low):.6g} to {one.written(one.high)}"
        for one in found.varied
    )
    wanted = " and ".join(one.text for one in found.wanted)
    if not np.isfinite(found.met).all():
        why = next((one.why for one in found.failed), "it has no value there")
        return f"{ranges}: no design has {wanted}: {why}"
    if found.wanted[0].aim != "=":
        return f"{ranges}: no design keeps all limits and conditions"
    keys = " or ".join(key.key for key in found.varied)
    met = []
    for number, (target, (low, high)) in enumerate(zip(found.wanted, found.met)):
        least, most = show(low, target.head.kind), show(high, target.head.kind)
        constant = f"{target.head.id} is {most} throughout, and does not depend on {keys}"
        met.append(f"{target.head.id} is {least} to {most}" if found.depends(number) else constant)
    more = "; it is passed by a jump" if found.jumps else ""
    if found.excluded:
        more += f"; --where leaves out {found.excluded} that {'has' if found.excluded == 1 else 'have'} it"
    has_it = len(found.wanted) == 1 and not found.depends(0) and found.has_wanted(0)
    having = "every design has" if has_it else "no design has"
    return f"{ranges}: {having} {wanted}: {' and '.join(met)}{more}"


def _varied(span: tuple[str, str, str, str], kind: str) -> Varied:
    key, low, high, unit = span
    if not kind:
        raise UsageError(f"--vary {key}: only a number has a range; kurbel sweep compares words")
    ends = [parse_quantity(text, kind) for text in (low, high)]
    if not ends[0] < ends[1]:
        raise UsageError(
            f"--vary {key}: the range goes from {low} up to {high}; write the smaller one first"
        )
    return Varied(
        key, ends[0], ends[1], "" if unit == "%" else unit, kind
    )  # a share is printed as a sweep prints it
