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
from kurbel.designs.answers import Design, DesignResult, Head, Study
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
    for equation in equations:
        if not _EQUATION.fullmatch(equation):
            raise UsageError(
                f"{text_in_one_line(equation)}: write an equation, such as 'N_max = 4 kN'; a bound has --where"
            )
    extreme = least or greatest
    equations_needed = 0 if extreme else len(vary)
    is_complete = 1 <= len(vary) <= 2 and len(equations) == equations_needed
    if not is_complete or (least and greatest):
        raise UsageError(
            "give --vary KEY=low:high and 'KEY_VALUE = value', two of both, or --least or --greatest"
        )
    wanted = [extreme] if extreme else equations
    solutions = Solutions(origin, vary, wanted, conditions, progress)
    if extreme:
        solutions.find_extreme("least" if least else "greatest")
    else:
        solutions.solve()
    if not solutions.found:
        raise NoSolutionError(_nothing(solutions))
    return solutions


class Solutions:
    """Solutions in the order of the first key, and jumps: places where a key value jumps across the wanted value.

    machine: its name; heads, answers: of the key values of a solution, in SI; computed: all designs of the search, in
    the order of their keys; excluded: the number of solutions that break a condition. A share (n, keys) is
    from 0 to 1 in each range.
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
        spans = [read_span(text) for text in vary]
        keys = [key for key, *_ in spans]
        if len({path_of(key) for key in keys}) < len(keys):
            raise UsageError(f"--vary {keys[-1]}: this key is varied twice")

        # the names of key values in the equations, and in the conditions
        names = [text.partition("=")[0].strip() for text in wanted]
        for condition in conditions:
            name, _, _ = condition_parts(condition)
            if name not in keys:
                names.append(name)
        ends = product(*((low, high) for _, low, high, _ in spans))
        self.study = Study(origin, keys, ends, names, option="find")
        self.machine = self.study.binder.machine.name
        self.answers = self.study.answers
        self.varied = [_varied(span, kind) for span, kind in zip(spans, self.study.binder.kinds)]

        # the columns of a design: keys, then key values
        key_heads = []
        for varied, zero in zip(self.varied, self.study.binder.zeros):
            head = Head(varied.key, SI[varied.kind], varied.kind, input=True, zero=zero)
            key_heads.append(head)
        self.heads = tuple(self.study.heads("si"))
        heads = [*key_heads, *self.heads]
        self.wanted: list[Target] = []
        for text, name in zip(wanted, names):
            column = place_of(name, heads, "find")
            is_equation = text != name
            value = None
            if is_equation:
                value = float(read_condition(text, heads, "find").value)
            target = Target(text.strip(), heads[column], column - len(keys), "=", value)
            self.wanted.append(target)
        self.conditions = [
            (condition, read_condition(condition, heads)) for condition in conditions
        ]
        self.computed: list[_Design] = []
        self.found: list[Solution] = []
        self.jumps: list[Solution] = []
        self.excluded = 0

    def __repr__(self) -> str:
        count = len(self.found)
        solutions = "1 solution" if count == 1 else f"{count} solutions"
        keys = ", ".join(varied.key for varied in self.varied)
        wanted = ", ".join(target.text for target in self.wanted)
        return f"<kurbel find of {keys} for {wanted}: {solutions} in .found>"

    def __str__(self) -> str:
        """Return a line for each solution: the keys in the units of their ranges, and the key values."""
        lines = []
        for solution in self.found:
            texts = []
            for varied, value in zip(self.varied, solution.values):
                texts.append(f"{varied.key} = {varied.written(value)}")
            for head, value in zip(self.heads, solution.key_values):
                texts.append(f"{head.id} = {show(value, head.kind)}")
            line = ", ".join(texts)
            lines.append("; ".join([line, *solution.notes]))
        return "\n".join(lines) or repr(self)

    def at(self, shares: Array) -> list[_Design]:
        """Return the designs at shares (n, keys) of the ranges."""
        if self.progress:
            self.progress(f"{len(self.computed)} designs computed")
        low = np.array([varied.low for varied in self.varied])
        high = np.array([varied.high for varied in self.varied])
        numbers = low * (1 - shares) + high * shares
        results = self.study.of(self.study.binder.columns(numbers))
        designs = [self._design(row, result) for row, result in zip(numbers.tolist(), results)]
        self.computed = sorted([*self.computed, *designs])
        return designs

    def _design(self, numbers: list[float], result: DesignResult) -> _Design:
        """Return a design with its key values, nan where it fails, and with what it breaks."""
        lacking = [np.nan] * len(self.study.answers)
        values = np.array(result.values or lacking, dtype=float).tolist()
        unmet = result.failure
        broken = result.failure
        if not result.failure:
            row = Design(0, (*numbers, *result.values))
            broken = ", ".join(f"limits.{name}" for name in result.broken)
            unmet = ", ".join(
                text for text, condition in self.conditions if not condition.holds(row)
            )
        return _Design(tuple(numbers), tuple(values), result.failure, broken, unmet)

    def solve(self) -> None:
        """Find where all equations hold, and, for a single equation, where the key value jumps across its value."""
        columns = [target.place for target in self.wanted]
        wanted_values = np.array([target.value for target in self.wanted], dtype=float)

        def differences(shares: Array) -> Array:
            values = np.array([design.values for design in self.at(shares)])
            return values[:, columns] - wanted_values

        if len(wanted_values) == 1:
            size = abs(float(wanted_values[0]))
            positions, jumps, ends = roots(lambda shares: differences(shares)[:, 0], size)
            if not self.depends(0):
                return
            shares = positions[:, None]
        else:
            shares = common_roots(differences)
            jumps = np.zeros(len(shares), dtype=bool)
            ends = np.full(len(shares), np.nan)

        designs = self.at(shares) if len(shares) else []
        for design, is_jump, end in zip(designs, jumps, ends):
            if design.unmet:
                self.excluded += 1
                continue
            solutions = self.jumps if is_jump else self.found
            notes = self._notes_of_solution(design, float(end))
            solutions.append(Solution(design.numbers, design.values, notes))
        self.found.sort()

    def _notes_of_solution(self, design: _Design, end: float) -> tuple[str, ...]:
        """Return the notes on a solution; end: up to which share of the range it is the same, nan for one place."""
        notes = [f"breaks {design.broken}"] if design.broken else []
        if np.isfinite(end):
            (varied,) = self.varied
            last = varied.low * (1 - end) + varied.high * end
            notes.append(f"the same up to {varied.written(last)}")
        return tuple(notes)

    def depends(self, number: int) -> bool:
        """Return whether a wanted key value differs, by more than rounding, between the designs that were computed."""
        low, high = self.met[number]
        return not high - low <= _EQUAL * max(abs(low), abs(high))

    def find_extreme(self, aim: str) -> None:
        """Find the design whose key value is the `least` or the `greatest` within all limits, if there is one."""
        sign = 1.0 if aim == "least" else -1.0
        self.wanted = [self.wanted[0]._replace(aim=aim)]
        column = self.wanted[0].place

        def cost(shares: Array) -> Array:
            designs = self.at(shares)
            costs = np.array([sign * design.values[column] for design in designs])
            costs[[bool(design.broken or design.unmet) for design in designs]] = np.nan
            return costs

        share, least_cost = lowest(cost, len(self.varied))
        if np.isfinite(least_cost):
            (design,) = self.at(share[None])
            notes = (
                *self._reached_ends(share),
                *self._binding_bounds(share),
                *self._level_stretches(sign * least_cost),
            )
            self.found.append(Solution(design.numbers, design.values, notes))

    def _reached_ends(self, shares: Array) -> list[str]:
        """Return of which ranges an extreme is at an end."""
        notes = []
        for share, varied in zip(shares.tolist(), self.varied):
            if min(share, 1 - share) < _ASIDE:
                end = "least" if share < 0.5 else "greatest"
                notes.append(f"{varied.key} is at the {end} of its range")
        return notes

    def _binding_bounds(self, shares: Array) -> list[str]:
        """Return which limits and conditions designs right next to an extreme break."""
        steps = _ASIDE * np.concatenate([np.eye(len(shares)), -np.eye(len(shares))])
        neighbours = self.at(np.clip(shares + steps, 0.0, 1.0))
        bounds = [design.broken for design in neighbours]
        bounds += [design.unmet for design in neighbours]
        return [f"beyond it: {text}" for text in dict.fromkeys(bounds) if text]

    def _level_stretches(self, best: float) -> list[str]:
        """Return over which stretches of the only key an extreme is as good."""
        if len(self.varied) > 1:
            return []
        (varied,) = self.varied
        column = self.wanted[0].place

        def is_best(design: _Design) -> bool:
            return abs(design.values[column] - best) <= _EQUAL * abs(best)

        notes = []
        for are_best, stretch in groupby(self.computed, key=is_best):
            numbers = [design.numbers[0] for design in stretch]
            is_long = numbers[-1] - numbers[0] > _FLAT * (varied.high - varied.low)
            if are_best and is_long:
                first = f"{varied.in_unit(numbers[0]):.6g}"
                notes.append(f"as good from {first} to {varied.written(numbers[-1])}")
        return notes

    def has_wanted(self, number: int) -> bool:
        """Return whether a key value that does not depend on the keys is the wanted one."""
        wanted_value = self.wanted[number].value
        _, value = self.met[number]
        return wanted_value is not None and abs(value - wanted_value) <= _EQUAL * abs(wanted_value)

    @property
    def places(self) -> Array:
        """All designs that were computed (n, keys), in SI."""
        return np.array([design.numbers for design in self.computed])

    @property
    def values(self) -> Array:
        """Their key values (n, answers) in SI."""
        return np.array([design.values for design in self.computed])

    @property
    def met(self) -> list[tuple[float, float]]:
        """Least and greatest value of each wanted key value."""
        ranges = []
        for target in self.wanted:
            column = self.values[:, target.place]
            least = float(np.nanmin(column, initial=np.inf))
            greatest = float(np.nanmax(column, initial=-np.inf))
            ranges.append((least, greatest))
        return ranges

    @property
    def failed(self) -> list[Failed]:
        """The parts of the range of the only key in which designs fail."""
        if len(self.varied) > 1:
            return []
        parts = []
        for fails, stretch in groupby(self.computed, key=lambda design: bool(design.failure)):
            if fails:
                designs = list(stretch)
                low, high = designs[0].numbers[0], designs[-1].numbers[0]
                parts.append(Failed(low, high, designs[0].failure))
        return parts


def _nothing(solutions: Solutions) -> str:
    """Return the message that nothing was found, with the values that were met."""
    ranges = " and ".join(
        f"{varied.key} from {varied.in_unit(varied.low):.6g} to {varied.written(varied.high)}"
        for varied in solutions.varied
    )
    wanted = " and ".join(target.text for target in solutions.wanted)
    if not np.isfinite(solutions.met).all():
        why = next((part.why for part in solutions.failed), "it has no value there")
        return f"{ranges}: no design has {wanted}: {why}"
    if solutions.wanted[0].aim != "=":
        return f"{ranges}: no design keeps all limits and conditions"

    # the range of each key value, or that it does not depend on the keys
    keys = " or ".join(varied.key for varied in solutions.varied)
    sentences = []
    for number, (target, (low, high)) in enumerate(zip(solutions.wanted, solutions.met)):
        id, kind = target.head.id, target.head.kind
        if solutions.depends(number):
            sentences.append(f"{id} is {show(low, kind)} to {show(high, kind)}")
        else:
            value = show(high, kind)
            sentences.append(f"{id} is {value} throughout, and does not depend on {keys}")

    more = "; it is passed by a jump" if solutions.jumps else ""
    if solutions.excluded == 1:
        more += "; --where leaves out 1 that has it"
    elif solutions.excluded:
        more += f"; --where leaves out {solutions.excluded} that have it"
    is_constant = len(solutions.wanted) == 1 and not solutions.depends(0)
    having = "no design has"
    if is_constant and solutions.has_wanted(0):
        having = "every design has"
    return f"{ranges}: {having} {wanted}: {' and '.join(sentences)}{more}"


def _varied(span: tuple[str, str, str, str], kind: str) -> Varied:
    key, low_text, high_text, unit = span
    if not kind:
        raise UsageError(f"--vary {key}: only a number has a range; kurbel sweep compares words")
    low = parse_quantity(low_text, kind)
    high = parse_quantity(high_text, kind)
    if not low < high:
        raise UsageError(
            f"--vary {key}: the range goes from {low_text} up to {high_text}; write the smaller one first"
        )
    # a share is printed as a sweep prints it
    shown_as = "" if unit == "%" else unit
    return Varied(key, low, high, shown_as, kind)
