"""The values of one or two keys that give required key values, or that make a key value least or greatest."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import groupby, product
from typing import NamedTuple

import numpy as np

from kurbel.arrays import Array
from kurbel.declared.reading import shown
from kurbel.declared.unit_systems import SI, convert, show
from kurbel.declared.units import parse_quantity
from kurbel.designs.answers import Answer, answers_at, requested_answers
from kurbel.designs.binding import Binder
from kurbel.designs.chosen import Condition, parts_of, read_condition
from kurbel.designs.plan import read_span
from kurbel.designs.sweep import Design, Head, begun, broken_of, limits_of
from kurbel.errors import NoSolutionError, UnitError, UsageError
from kurbel.machine.origin import Origin
from kurbel.machine_file.overrides import path_of
from kurbel.numerics.search import common_roots, lowest, roots

_EQUAL = 1e-12
"""Relative difference below which extremes are equal."""
_ASIDE = 1e-6
"""Share of the range: step from an extreme to a design that shows which bound limits it."""


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


class Target(NamedTuple):
    """A key value that is to have a value in SI (aim `=`), or to be the `least` or the `greatest`."""

    text: str
    answer: Answer
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


class Solutions(NamedTuple):
    """Solutions in the order of the first key, and jumps: places where a key value jumps across the wanted value.

    machine: its name. names, answers: of the key values of a solution, those that are wanted first. met: least and
    greatest value of each wanted key value. places (n, keys), values (n, answers): all designs that were computed, in
    SI, in the order of the keys.
    """

    machine: str
    varied: tuple[Varied, ...]
    wanted: tuple[Target, ...]
    names: tuple[str, ...]
    answers: tuple[Answer, ...]
    found: tuple[Solution, ...]
    jumps: tuple[Solution, ...]
    failed: tuple[Failed, ...]
    met: tuple[tuple[float, float], ...]
    places: Array
    values: Array


def find(
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
    if wrong := next((one for one in equations if "=" not in one), ""):
        raise UsageError(f"{shown(wrong)}: write an equation, such as 'N_max = 4 kN'; a bound has --where")
    if not 1 <= len(vary) <= 2 or (least and greatest) or len(equations) != (0 if extreme else len(vary)):
        raise UsageError("give --vary KEY=low:high and 'KEY_VALUE = value', two of both, or --least or --greatest")
    designs = _Designs(origin, vary, equations or [extreme], "least" if least else "greatest", conditions, progress)
    solutions, jumps = (_extreme(designs, 1.0 if least else -1.0), ()) if extreme else _solved(designs)
    findings = designs.findings(solutions, jumps)
    if not solutions:
        raise NoSolutionError(_nothing(findings, designs.excluded))
    return findings


class _Designs:
    """Designs of a file by their places (n, keys), from 0 to 1 in each range, and all that was computed of them."""

    def __init__(
        self,
        origin: Origin,
        vary: Sequence[str],
        wanted: Sequence[str],
        aim: str,
        conditions: Sequence[str],
        progress: Callable[[str], None] | None = None,
    ) -> None:
        self.progress = progress
        spans = [read_span(one) for one in vary]
        keys = [key for key, *_ in spans]
        if len({path_of(key) for key in keys}) < len(keys):
            raise UsageError(f"--vary {keys[-1]}: this key is varied twice")
        parts = [one.partition("=") for one in wanted]
        every = dict.fromkeys([*(name.strip() for name, _, _ in parts), *(parts_of(one)[0] for one in conditions)])
        self.names = [name for name in every if name not in keys]
        self.binder, self.answers = _begun(origin, spans, self.names)
        self.varied = [_varied(span, kind) for span, kind in zip(spans, self.binder.kinds)]
        self.wanted = [
            Target(text, answer, "=" if equals else aim, _parsed(text, value, answer.kind) if equals else None)
            for text, answer, (_, equals, value) in zip(wanted, self.answers, parts)
        ]
        heads = [Head(one.key, SI[one.kind], True, one.kind) for one in self.varied]
        heads += [Head(name, SI[one.kind], False, one.kind) for name, one in zip(self.names, self.answers)]
        self.conditions: list[tuple[str, Condition]] = [(one, read_condition(one, heads, ())) for one in conditions]
        self.limits = list(limits_of(self.binder.machine))
        self.excluded = 0
        """Solutions that break a condition."""
        self.computed: list[tuple[tuple[float, ...], Array, str]] = []
        """Of every design its numbers, its key values, and why it fails."""

    def numbers(self, places: Array) -> Array:
        """Return the numbers (n, keys) in SI at places."""
        low, high = np.array([(one.low, one.high) for one in self.varied]).T
        return np.asarray(low * (1 - places) + high * places)

    def at(self, places: Array) -> tuple[Array, list[str], list[str]]:
        """Return key values (n, answers), nan where a design fails; the limits each breaks; the conditions each breaks.

        For a design that fails both texts are the reason of the failure.
        """
        if self.progress:
            self.progress(f"{len(self.computed)} designs computed")
        numbers, count = self.numbers(places), len(self.answers)
        rows = numbers.tolist()
        found = answers_at(self.binder, numbers, (*self.answers, *(one.answer for one in self.limits)))
        values, broken, unmet = np.full((len(rows), count), np.nan), [""] * len(rows), [""] * len(rows)
        for number, (row, own) in enumerate(zip(rows, found)):
            if isinstance(own, str):
                broken[number] = unmet[number] = own
            else:
                values[number] = [np.nan if one is None else one for one in own[:count]]
                broken[number] = ", ".join(f"limits.{name}" for name in broken_of(self.limits, own[count:]))
                whole = Design(number, (*row, *own[:count]))
                unmet[number] = ", ".join(text for text, one in self.conditions if not one.holds(whole))
            self.computed.append((tuple(row), values[number], own if isinstance(own, str) else ""))
        return values, broken, unmet

    def findings(self, solutions: Sequence[Solution], jumps: Sequence[Solution]) -> Solutions:
        """Return what was found together with what was computed."""
        computed = sorted(self.computed, key=lambda one: one[0])
        values = np.array([one[1] for one in computed])
        spans = [
            (float(column.min()), float(column.max())) if len(column := own[np.isfinite(own)]) else (np.nan, np.nan)
            for own in values.T[: len(self.wanted)]
        ]
        failed: list[Failed] = []
        for fails, part in groupby(computed, key=lambda one: bool(one[2])):
            inside = list(part)
            if fails and len(self.varied) == 1:
                failed.append(Failed(inside[0][0][0], inside[-1][0][0], inside[0][2]))
        return Solutions(
            self.binder.machine.name,
            tuple(self.varied),
            tuple(self.wanted),
            tuple(self.names),
            tuple(self.answers),
            tuple(sorted(solutions)),
            tuple(jumps),
            tuple(failed),
            tuple(spans),
            np.array([one[0] for one in computed]),
            values,
        )


def _solved(designs: _Designs) -> tuple[Sequence[Solution], Sequence[Solution]]:
    """Return where all equations hold, and, for a single equation, where the key value jumps across its value."""
    values = np.array([one.value for one in designs.wanted], dtype=float)

    def left(places: Array) -> Array:
        found = designs.at(places)[0][:, : len(values)] - values
        return np.asarray(found[:, 0] if len(values) == 1 else found)

    if len(values) == 1:
        found, jumps = roots(left)
        places = found[:, None]
    else:
        places = common_roots(left)
        jumps = np.zeros(len(places), dtype=bool)
    if not len(places):
        return [], []
    key_values, broken, unmet = designs.at(places)
    solutions: list[list[Solution]] = [[], []]
    designs.excluded = sum(map(bool, unmet))
    for number, row in enumerate(designs.numbers(places).tolist()):
        if not unmet[number]:
            notes = (f"breaks {broken[number]}",) if broken[number] else ()
            solutions[int(jumps[number])].append(Solution(tuple(row), tuple(key_values[number].tolist()), notes))
    return solutions[0], solutions[1]


def _extreme(designs: _Designs, sign: float) -> Sequence[Solution]:
    """Return the design whose first key value is the least (sign 1) or greatest (−1) within all limits; or none."""

    def cost(places: Array) -> Array:
        values, broken, unmet = designs.at(places)
        fits = np.array([not one and not other for one, other in zip(broken, unmet)])
        return np.where(fits, sign * values[:, 0], np.nan)

    place, best = lowest(cost, len(designs.varied))
    if not np.isfinite(best):
        return []
    values, _, _ = designs.at(place[None])
    return [
        Solution(
            tuple(designs.numbers(place[None])[0].tolist()),
            tuple(values[0].tolist()),
            _bounds(designs, place, best * sign),
        )
    ]


def _bounds(designs: _Designs, place: Array, best: float) -> tuple[str, ...]:
    """Return at which bounds an extreme is, and over which range of the only key it is as good."""
    notes: list[str] = []
    steps = _ASIDE * np.concatenate([np.eye(len(place)), -np.eye(len(place))])
    _, broken, unmet = designs.at(np.clip(place + steps, 0.0, 1.0))
    for axis, one in enumerate(designs.varied):
        for end, word in ((0.0, "least"), (1.0, "greatest")):
            if abs(place[axis] - end) < _ASIDE:
                notes.append(f"{one.key} is at the {word} of its range")
    notes += [f"beyond it: {text}" for text in dict.fromkeys([*broken, *unmet]) if text]
    if len(place) == 1:
        rows = sorted(designs.computed, key=lambda one: one[0])
        same = [abs(one[1][0] - best) <= _EQUAL * abs(best) for one in rows]
        at = next(number for number, one in enumerate(rows) if same[number])
        last = at + next((number for number, one in enumerate(same[at:]) if not one), len(same) - at) - 1
        low, high = rows[at][0][0], rows[last][0][0]
        if high - low > 0.02 * (designs.varied[0].high - designs.varied[0].low):
            varied = designs.varied[0]
            notes.append(f"as good from {varied.in_unit(low):.6g} to {varied.in_unit(high):.6g} {varied.unit}".rstrip())
    return tuple(notes)


def _nothing(findings: Solutions, excluded: int) -> str:
    """Return the message that nothing was found, with the values that were met; excluded: solutions by --where."""
    ranges = " and ".join(
        f"{one.key} from {one.in_unit(one.low):.6g} to {one.in_unit(one.high):.6g} {one.unit}".rstrip()
        for one in findings.varied
    )
    wanted = " and ".join(one.text.strip() for one in findings.wanted)
    if not np.isfinite(findings.met).any():
        return f"{ranges}: no design has {wanted}: {findings.failed[0].why if findings.failed else 'all fail'}"
    if findings.wanted[0].aim != "=":
        return f"{ranges}: no design keeps all limits and conditions"
    met = " and ".join(
        f"{one.answer.quantity.id} is {_shown(low, one.answer)} to {_shown(high, one.answer)}"
        for one, (low, high) in zip(findings.wanted, findings.met)
    )
    more = "; it is passed by a jump" if findings.jumps else ""
    more += f"; --where leaves out {excluded} that {'has' if excluded == 1 else 'have'} it" if excluded else ""
    return f"{ranges}: no design has {wanted}: {met}{more}"


def _shown(value: float, answer: Answer) -> str:
    return show(value, answer.kind) if np.isfinite(value) else "nothing"


# --- reading the options

_Span = tuple[str, str, str, str]
"""A key, the texts of both ends of its range, and their unit."""


def _begun(origin: Origin, spans: Sequence[_Span], names: Sequence[str]) -> tuple[Binder, list[Answer]]:
    """Return the binder of the varied keys, made from the first ends of the ranges that give a valid machine, and the
    key values by these names. Raises UsageError for a name that is a list or that several parts have.
    """
    ends = product(*((low, high) for _, low, high, _ in spans))
    binder, found = begun(
        origin,
        [key for key, *_ in spans],
        ends,
        lambda machine: [requested_answers(machine, [name], option="find") for name in names],
    )
    for name, each in zip(names, found):
        if each[0].quantity.listed:
            raise UsageError(f"{name}: a list of values, of which none is the wanted one")
        if len(each) > 1:
            own = f"{each[0].subject}.{each[0].quantity.id}"
            raise UsageError(f"{name}: there are {len(each)} of it; write which one, such as '{own}'")
    return binder, [each[0] for each in found]


def _varied(span: _Span, kind: str) -> Varied:
    key, low, high, unit = span
    if not kind:
        raise UsageError(f"--vary {key}: only a number has a range; kurbel sweep compares words")
    ends = [_parsed(f"--vary {key}", text, kind) for text in (low, high)]
    if not ends[0] < ends[1]:
        raise UsageError(f"--vary {key}: the range goes from {low} up to {high}; write the smaller one first")
    return Varied(key, ends[0], ends[1], "" if unit == "%" else unit, kind)  # a share is printed as a sweep prints it


def _parsed(where: str, text: str, kind: str) -> float:
    try:
        return parse_quantity(text.strip(" ="), kind)
    except UnitError as error:
        raise UsageError(f"{shown(where)}: {error}") from None
