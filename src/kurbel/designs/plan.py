"""What varies, `KEY=…` as a list, a range or a distribution, and which designs there are.

These are a grid of all values, or of values side by side, each with every point of the sample.
"""

import math
import re
from collections.abc import Sequence
from fractions import Fraction
from itertools import chain
from statistics import NormalDist
from typing import NamedTuple

import numpy as np

from kurbel.arrays import Array, Indices
from kurbel.declared.numerals import NUMBER, WRITTEN, keyboard_text
from kurbel.declared.reading import LONGEST_VALUE, text_in_one_line
from kurbel.declared.units import (
    normal_unit,
    split_quantity,
    step_unit,
    written_unit,
    zero_and_unit,
)
from kurbel.errors import UnitError, UsageError
from kurbel.machine_file.overrides import path_of

MOST_ROWS = 10_000_000
"""Rows that are computed without a confirmation (`--yes`)."""
_MOST_VALUES = 10_000_000
"""Values of one key; a range of more is a slip of its step."""
_LARGEST = 1e300
"""Sums of larger numbers may be infinite."""
_CALL = re.compile(r"([A-Za-z_]+)\s*\((.*)\)\s*")
_NEXT_KEY = re.compile(r";(?=[^;=]*=|\s*(?:;|$))")
_DISTRIBUTIONS = {"normal": "mean, deviation", "uniform": "least, most"}


class Uniform(NamedTuple):
    """A distribution that is uniform from its least to its most."""

    least: float
    most: float

    def inv_cdf(self, share: float) -> float:
        """Return the value below which this share of all lies."""
        return self.least + share * (self.most - self.least)


class Input(NamedTuple):
    """A key that varies: its values, as texts of the machine file or as numbers in a unit.

    distribution: of such numbers, from which a `Plan` draws them.
    """

    key: str
    texts: tuple[str, ...] = ()
    numbers: tuple[float, ...] = ()
    unit: str = ""
    distribution: NormalDist | Uniform | None = None

    @property
    def length(self) -> int:
        """The number of its values."""
        return len(self.texts or self.numbers)

    def text(self, index: int) -> str:
        """Return a value as the machine file would have it."""
        if self.texts:
            return self.texts[index]
        number = str(self.numbers[index]).removesuffix(".0")
        return f"{number} {self.unit}".rstrip()


def read_axis(text: str) -> tuple[Input, ...]:
    """Return the keys that change together, in `bore=400,450 mm; head_end_rod=70,80 mm`; raises UsageError.

    >>> [input.key for input in read_axis("bore=400,450 mm; head_end_rod=70,80 mm")]
    ['bore', 'head_end_rod']
    """
    parts = [part.strip() for part in _NEXT_KEY.split(text)]
    if len(parts) > 1 and not all(parts):
        raise _refused(text, "a key is missing next to ';'; write KEY=…; KEY=…, or leave it out")
    inputs = tuple(map(read_input, parts))
    if len(inputs) > 1 and any(input.distribution for input in inputs):
        raise _refused(
            text, "a distribution has a --vary of its own; write a list or a range of each key"
        )
    return inputs


def read_input(text: str) -> Input:
    """Read `rod_ratio=3:6:0.25`, `speed=40,50,60 rpm` or `bore=normal(450 mm, 0.2 mm)`; raises UsageError.

    >>> read_input("speed=40,50,60 rpm").texts
    ('40 rpm', '50 rpm', '60 rpm')
    >>> read_input("rod_ratio=3:4:0.25").numbers
    (3.0, 3.25, 3.5, 3.75, 4.0)
    """
    key, _, values = (part.strip() for part in keyboard_text(text).partition("="))
    if not key or not values:
        raise _refused(
            text,
            "write KEY=…, such as rod_ratio=3:6:0.25, speed=40,50,60 rpm, bore=normal(450 mm, 0.2 mm)",
        )
    call = _CALL.fullmatch(values)
    if call:
        distribution, unit = _distribution(text, call[1], call[2])
        return Input(key, unit=unit, distribution=distribution)
    is_range = ":" in values and "," not in values and NUMBER.match(values)
    if is_range:
        numbers, unit = _range(text, values)
        return Input(key, (), numbers, unit)
    return Input(key, _list(text, [part.strip() for part in values.split(",")]))


def read_span(text: str) -> tuple[str, str, str, str]:
    """Return the key, the texts of both ends and the unit of `crank=300:500 mm`; raises UsageError.

    >>> read_span("crank=300:500 mm")
    ('crank', '300 mm', '500 mm', 'mm')
    """
    key, _, values = (part.strip() for part in keyboard_text(text).partition("="))
    expected = "write KEY=low:high, such as rod_ratio=3:6 or crank=300:500 mm"
    ends = values.split(":") if key else ()
    (low, high), unit = _numbers(text, ends, 2, expected)
    return key, f"{low.text} {unit}".rstrip(), f"{high.text} {unit}".rstrip(), unit


def _refused(text: str, why: str) -> UsageError:
    return UsageError(f"--vary {text_in_one_line(text)}: {why}")


def _list(text: str, parts: list[str]) -> tuple[str, ...]:
    """Return the values of a list; the unit of the last one is that of those before it that have none."""
    are_values = all(0 < len(part) <= LONGEST_VALUE for part in parts)
    if not are_values:
        raise _refused(
            text, "a value is missing between two commas; write decimal points, such as 1.5"
        )
    if any(";" in part and NUMBER.match(part) for part in parts):
        raise _refused(text, "values are separated by commas; after ';' comes a further KEY=…")
    unit = written_unit(parts[-1])
    texts = []
    for part in parts:
        is_bare_number = bool(unit) and bool(re.fullmatch(WRITTEN, part))
        texts.append(f"{part} {unit}" if is_bare_number else part)
    # rows are read together, and only the first one as it is in the file
    zeros = {zero_and_unit(written_unit(part))[0] for part in texts}
    if len(zeros) > 1:
        units = " and ".join(dict.fromkeys(map(written_unit, texts)))
        raise _refused(text, f"write these pressures from one zero, not in {units}")
    return tuple(texts)


class _WrittenNumber(NamedTuple):
    """A number before a unit: as a text, such as `2 1/4`, and its value."""

    text: str
    value: float


def _written_number(part: str) -> tuple[_WrittenNumber, str] | None:
    """Return the number and the unit of a text, None where it has no number.

    >>> _written_number("2 1/4 in"), _written_number("1 ft 6 in")
    ((_WrittenNumber(text='2 1/4', value=2.25), 'in'), (_WrittenNumber(text='18', value=18.0), 'in'))
    """
    try:
        quantity = split_quantity(part)
    except UnitError:
        return None
    if quantity is None or quantity[1] != written_unit(part):
        return None
    value, unit = quantity
    text = part.removesuffix(unit).strip()
    if not re.fullmatch(WRITTEN, text):  # feet and inches
        text = f"{value:.15g}"
    return _WrittenNumber(text, value), unit


def _numbers(
    text: str, parts: Sequence[str], count: int, expected: str, has_step: bool = False
) -> tuple[list[_WrittenNumber], str]:
    """Return so many numbers, and their unit; expected: what else is refused.

    has_step: the last one is a difference, which may be in bar or K where others are in bara or °C.
    """
    written = list(map(_written_number, map(str.strip, parts)))
    numbers = [number for number, _ in filter(None, written)]
    units = [unit for _, unit in filter(None, written)]
    if len(numbers) != count or None in written:
        raise _refused(text, expected)
    first_unit = next(filter(None, units), "")
    if has_step and units[-1] == step_unit(first_unit):
        units[-1] = first_unit
    if set(map(normal_unit, units)) == {"ft", "in"}:
        numbers = list(map(_in_inches, numbers, units))
        units = ["in"] * count
        first_unit = "in"
    different_units = {normal_unit(unit): unit for unit in reversed(units) if unit}
    if len(different_units) > 1:
        in_units = " and ".join(sorted(different_units.values()))
        raise _refused(text, f"write these numbers in one unit, not in {in_units}")
    for number in numbers:
        if abs(number.value) > _LARGEST:
            raise _refused(text, f"{text_in_one_line(number.text)} is too large to compute with")
    return numbers, first_unit


def _in_inches(number: _WrittenNumber, unit: str) -> _WrittenNumber:
    """Return a number of feet or of inches in inches."""
    if normal_unit(unit) == "in":
        return number
    return _WrittenNumber(f"{12 * number.value:.15g}", 12 * number.value)


def _range(text: str, written: str) -> tuple[tuple[float, ...], str]:
    """Return first, first + step, … as decimal fractions, exactly, as far as they do not pass the last; their unit."""
    expected = "a range has three numbers, first:last:step, such as 3:6:0.25"
    numbers, unit = _numbers(text, written.split(":"), 3, expected, has_step=True)
    first, last, step = (Fraction(repr(number.value)) for number in numbers)
    leads_away = not step or (last - first) / step < 0
    if leads_away:
        raise _refused(
            text,
            f"a range from {numbers[0].text} by steps of {numbers[2].text} "
            f"never reaches {numbers[1].text}",
        )
    steps = (last - first) / step
    if steps >= _MOST_VALUES:
        raise _refused(text, f"this range has more than {_MOST_VALUES} values, as no key may")
    # whole numbers over one denominator
    denominator = math.lcm(first.denominator, step.denominator)
    start = int(first * denominator)
    increment = int(step * denominator)
    values = tuple((start + increment * number) / denominator for number in range(int(steps) + 1))
    return values, unit


def _distribution(text: str, name: str, inside: str) -> tuple[NormalDist | Uniform, str]:
    if name not in _DISTRIBUTIONS:
        names = ", ".join(f"{word}({words})" for word, words in _DISTRIBUTIONS.items())
        raise _refused(text, f"no distribution '{text_in_one_line(name)}'; known are {names}")
    expected = f"{name}({_DISTRIBUTIONS[name]}) has two numbers, such as normal(450 mm, 0.2 mm)"
    is_normal = name == "normal"
    (first, second), unit = _numbers(text, inside.split(","), 2, expected, has_step=is_normal)
    if is_normal:
        if second.value <= 0:
            raise _refused(text, f"the standard deviation must be more than 0, got {second.text}")
        return NormalDist(first.value, second.value), unit
    if second.value <= first.value:
        raise _refused(
            text, f"the least value must be less than the most, got {first.text} and {second.text}"
        )
    return Uniform(first.value, second.value), unit


class Plan:
    """The rows of a sweep, by their number from 0; the last axis of a grid varies fastest.

    axes: for each, the keys that change together along it. side_by_side: all lists form one axis. sample, seed: size
    and seed of the sample of the distributions. most: largest number of rows, None for any. Raises UsageError for
    lists that do not fit together.
    """

    def __init__(
        self,
        axes: Sequence[tuple[Input, ...]],
        side_by_side: bool = False,
        sample: int | None = None,
        seed: int = 0,
        most: int | None = None,
    ) -> None:
        self.inputs = tuple(chain(*axes))
        drawn = [input for input in self.inputs if input.distribution]
        self._axes = [axis for axis in axes if not axis[0].distribution]
        if side_by_side and self._axes:
            self._axes = [tuple(chain(*self._axes))]
        self._refuse_keys()
        self._refuse_sample(drawn, sample)
        self._refuse_lengths("--zip" if side_by_side else "")
        self.rows = math.prod(axis[0].length for axis in self._axes) * (sample or 1)
        if most and self.rows > most:
            raise UsageError(f"these are {self.rows} rows; --yes computes more than {most}")
        if sample:
            self._draw(drawn, sample, seed)

    def _refuse_keys(self) -> None:
        """Refuse keys that are varied twice, and limits."""
        paths_before = set()
        for input in self.inputs:
            path = path_of(input.key)
            if path in paths_before:
                raise UsageError(f"--vary {input.key}: this key is varied twice")
            if path[0] == "limits":
                raise UsageError(
                    f"--vary {input.key}: limits are the same for all rows; --where chooses those within others"
                )
            paths_before.add(path)

    def _refuse_sample(self, drawn: Sequence[Input], sample: int | None) -> None:
        """Refuse a distribution without a sample, and a sample without a distribution."""
        if drawn and not sample:
            raise UsageError(
                f"--vary {drawn[0].key}: a distribution needs --sample N, such as --sample 1000"
            )
        if sample and not drawn:
            raise UsageError(
                "--sample: no key has a distribution, such as bore=normal(450 mm, 0.2 mm)"
            )

    def _refuse_lengths(self, option: str) -> None:
        """Refuse lists of different lengths along an axis; option: that puts them side by side."""
        for axis in self._axes:
            if len({input.length for input in axis}) > 1:
                lengths = ", ".join(f"{input.key} has {input.length}" for input in axis)
                where = option or f"--vary {'; '.join(input.key for input in axis)}"
                raise UsageError(f"{where}: the lists must be of one length; {lengths}")

    def _draw(self, drawn: Sequence[Input], sample: int, seed: int) -> None:
        """Draw the values of the distributions, which form an axis."""
        shares = latin_hypercube(sample, len(drawn), seed).T.tolist()
        self._axes.append(tuple(map(_drawn, drawn, shares)))
        with_values = {input.key: input for input in chain(*self._axes)}
        self.inputs = tuple(with_values[input.key] for input in self.inputs)

    def value_numbers(self, rows: Indices) -> list[Indices]:
        """Return which of its values each input has in these rows (n,)."""
        numbers: dict[str, Indices] = {}
        for axis in reversed(self._axes):
            rows, along_axis = np.divmod(rows, axis[0].length)
            for input in axis:
                numbers[input.key] = along_axis
        return [numbers[input.key] for input in self.inputs]

    def texts(self, row: int) -> tuple[str, ...]:
        """Return the values of the inputs in a row as the machine file would have them."""
        numbers = self.value_numbers(np.array([row]))
        return tuple(input.text(int(number[0])) for input, number in zip(self.inputs, numbers))


def _drawn(input: Input, shares: Sequence[float]) -> Input:
    """Return an input with the values of its distribution below which these shares of all lie."""
    assert input.distribution
    values = tuple(map(input.distribution.inv_cdf, shares))
    return Input(input.key, (), values, input.unit)


def latin_hypercube(count: int, width: int, seed: int) -> Array:
    """Return (count, width) numbers between 0 and 1: in every column one in each of `count` equal strips, at random."""
    random = np.random.default_rng(seed)
    strips = random.permuted(np.tile(np.arange(float(count))[:, None], width), axis=0)
    # neither 0 nor 1: a distribution has no value there
    in_strip = np.clip(random.random((count, width)), 2.0**-40, 1 - 2.0**-40)
    return (strips + in_strip) / count


def shard(text: str, rows: int) -> range:
    """Return the rows of one shard of many, `2/8`; one after another they are all rows. Raises UsageError.

    >>> [shard(f"{k}/3", 8) for k in (1, 2, 3)]
    [range(0, 2), range(2, 5), range(5, 8)]
    """
    match = re.fullmatch("([0-9]{1,9})/([0-9]{1,9})", text)
    number, count = map(int, match.groups()) if match else (0, 0)
    if not 1 <= number <= count:
        raise UsageError(f"--shard {text_in_one_line(text)}: write K/N, such as 2/8, K from 1 to N")
    return range(rows * (number - 1) // count, rows * number // count)
