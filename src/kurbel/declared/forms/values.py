"""Forms of values: numbers, values with a unit, counts, words, texts, lists of points, mappings by dotted keys."""

import operator
import os
import re
from abc import abstractmethod
from collections.abc import Iterator, Sequence
from functools import cache
from typing import Any

import numpy as np

from kurbel.declared.keys import Form, Schema
from kurbel.declared.numerals import NUMBER, RATIO, WRITTEN, parse_number, parse_ratio, plain
from kurbel.declared.reading import LONGEST_VALUE, REFUSED, Plain, Reading, glued_hint, is_nothing, kind_of, shown
from kurbel.declared.unit_systems import show
from kurbel.declared.units import (
    KINDS,
    MOST_ITEMS,
    MOST_POINTS,
    example,
    out_of_size,
    parse_quantity,
    plain_quantities,
    range_of,
    unit_example,
    unit_factor,
    unit_names,
    written_unit,
)
from kurbel.errors import Path, UnitError, refused
from kurbel.near_words import did_you_mean
from kurbel.numerics.arithmetic import is_number

Words = tuple[tuple[str, float], ...]


def reference(name: str) -> Schema:
    """Return a reference to a definition of the schema."""
    # draft-07 overlooks whatever stands beside a $ref, so it goes into a list of its own
    return {"allOf": [{"$ref": f"#/definitions/{name}"}]}


class Scalar(Form):
    """A text of one line."""

    def take(self, reading: Reading, value: Any, path: Path) -> Any:
        """Read a text of sensible length."""
        if is_nothing(value):
            refused(f"a value is missing; write {self.expected()}")
        if isinstance(value, str) and len(value) > LONGEST_VALUE:
            refused(f"expected {self.expected()}, got {len(value)} characters; {LONGEST_VALUE} are the most")
        if not isinstance(value, str) or not value.isprintable():
            refused(f"expected {self.expected()}, got {kind_of(value)}")
        if not value.strip():
            refused(f"expected {self.expected()}, got an empty text")
        return self.parse(value, reading.folder)

    @abstractmethod
    def parse(self, text: str, folder: str) -> Any:
        """Return what a text becomes; raises RuleError."""


class _Bounded(Scalar):
    """A number with its bounds, in the base of its kind.

    above, below: the value must be larger or smaller; least, most: it must not be smaller or larger. `words` are texts
    allowed instead, such as `infinite`, with the value they stand for; zero: 0 is allowed beside what is in the bounds.
    """

    def __init__(
        self,
        kind: str = "ratio",
        above: float | None = None,
        least: float | None = None,
        below: float | None = None,
        most: float | None = None,
        words: Words = (),
        zero: bool = False,
    ) -> None:
        self.kind, self.words, self.zero = kind, words, zero
        self.above, self.least, self.below, self.most = above, least, below, most

    def parse(self, text: str, folder: str) -> float:
        for word, stands_for in self.words:
            if text == word:
                return stands_for
        if self.words and text.strip()[0].isalpha():
            refused(f"expected {self.expected()}, got '{text}'")
        try:
            value = self.number(text)
        except UnitError as error:
            refused(f"{error}{glued_hint(text)}")
        wrong = self._wrong(value)
        return refused(f"{text} {wrong}") if wrong else value

    @property
    def is_number(self) -> bool:
        return True

    def numbers(self, texts: Sequence[str]) -> list[float] | None:
        """Return what texts become that are plain numbers within the bounds; None where one is not."""
        found = plain_quantities(texts, self.kind)
        return None if found is None or self._wrong(np.array(found)) else found

    def _wrong(self, value: Any) -> str:
        return self.out_of_bounds(value) or out_of_size(value, self.kind)

    @abstractmethod
    def number(self, text: str) -> float:
        """Return the number in the base of its kind; raises RuleError."""

    def unquoted(self, text: str) -> str:
        """Return a text without quotation marks; raises RuleError for one that has them."""
        if not isinstance(text, Plain):
            what = self.expected().partition(" or ")[0]
            refused(f'expected {what}, got the text "{text}"; leave out the quotation marks')
        return text

    def out_of_bounds(self, value: Any) -> str:
        """Compare a number with the bounds.

        >>> Physical("length", least=0.1).out_of_bounds(-0.3)
        'is too small; it must be at least 100 mm'
        """
        return next((words for broken, words in self.bounds(value) if np.any(broken)), "")

    def bounds(self, value: Any) -> Iterator[tuple[Any, str]]:
        """Yield where a number, or each of many, is out of a bound, with the words for it."""
        for bound, wrong, too, must in (
            (self.above, operator.le, "small", "more than"),
            (self.least, operator.lt, "small", "at least"),
            (self.below, operator.ge, "large", "less than"),
            (self.most, operator.gt, "large", "at most"),
        ):
            if bound is not None and (is_number(value) or isinstance(value, np.ndarray)):
                broken = (wrong(value, bound) | (value != value)) & ((value != 0) | (not self.zero))
                yield broken, f"is too {too}; it must be {must} {show(bound, self.kind) if bound else '0'}"

    def _or_words(self) -> str:
        return "".join(f" or '{word}'" for word, _ in self.words)

    def _schema(self, number: Schema) -> Schema:
        others: list[Any] = [word for word, _ in self.words] + [0] * self.zero
        return {"anyOf": [number, {"enum": others}]} if others else number


class Physical(_Bounded):
    """A number with a unit of this kind, such as `450 mm`; becomes a float in the base of the kind."""

    def number(self, text: str) -> float:
        return parse_quantity(text, self.kind)

    def expected(self) -> str:
        return f"a number with its unit, such as '{self.example()}'{self._or_words()}"

    def example(self) -> str:
        return example(self.kind)

    def written(self) -> str:
        return f"`{self.example()}`" + "".join(f", or `{word}`" for word, _ in self.words)

    def schema(self, definitions: Schema) -> Schema:
        name, units = f"quantity_{self.kind}", ", ".join(unit_names(self.kind))
        definitions[name] = {
            "type": "string",
            "pattern": f"^\\s*{WRITTEN}\\s*{_units(self.kind)}\\s*$",
            "description": f"{self.expected()}; in size {range_of(self.kind)}; units: {units}",
            # draft-07 has no words for a fault; editors (YAML and JSON language servers, ajv) take them from these
            "errorMessage": f"write {self.expected()}",
            "patternErrorMessage": f"write {self.expected()}; units: {units}",
            "examples": [self.example()],
        }
        return self._schema(reference(name))


class Number(_Bounded):
    """A bare number, a quotient such as `1/80` or `75 %` (a ratio, a fraction, a coefficient); becomes a float.

    share_of: what a value with a unit, which people try, must be divided by.
    """

    def __init__(self, share_of: str = "", **bounds: Any) -> None:
        super().__init__(**bounds)
        self.share_of = share_of

    def number(self, text: str) -> float:
        if self.share_of and written_unit(text)[:1].isalpha():
            refused(f"expected a number, got '{text}'; it is a share of {self.share_of}, such as 0.05 or 5 %")
        return parse_ratio(self.unquoted(text))

    def expected(self) -> str:
        return f"a number{self._or_words()}"

    def example(self) -> str:
        return "5" if (self.above or 0) >= 1 else "0.1"

    def schema(self, definitions: Schema) -> Schema:
        largest = KINDS["ratio"].largest
        bounds = {
            "exclusiveMinimum": self.above,
            "minimum": -largest if self.least is None else self.least,
            "exclusiveMaximum": self.below,
            "maximum": largest if self.most is None else self.most,
        }
        number = {name: bound for name, bound in bounds.items() if bound is not None}
        return self._schema({"type": ["number", "string"], **number, "pattern": f"^\\s*{RATIO}\\s*$"})


class Count(_Bounded):
    """A whole number; becomes an int."""

    def __init__(self, least: int = 1, most: int | None = None) -> None:
        super().__init__(least=least, most=most)

    def number(self, text: str) -> int:
        if not re.fullmatch(r"[-+]?(0|[1-9][0-9]{0,8})", self.unquoted(text)):
            refused(f"expected a whole number, got '{text}'")
        whole = int(text)
        if self.most == self.least != whole:
            refused(f"{whole} is not supported; it must be {self.least}")
        return whole

    @property
    def is_number(self) -> bool:
        return False

    def expected(self) -> str:
        return "a whole number"

    def example(self) -> str:
        return str(max(self.least or 0, 3) if self.most is None else self.least)

    def schema(self, definitions: Schema) -> Schema:
        return {"type": "integer", "minimum": self.least} | ({} if self.most is None else {"maximum": self.most})


class Choice(Scalar):
    """One of these words. also: other words that people try, each with the one that is meant."""

    def __init__(self, words: tuple[str, ...], also: dict[str, str] | None = None) -> None:
        self.words, self.also = words, also or {}

    def suits(self, value: Any) -> bool:
        return not NUMBER.match(str(value))

    def take(self, reading: Reading, value: Any, path: Path) -> Any:
        """Take one of the words, of which one may be a blank or a tab."""
        return str(value) if isinstance(value, str) and value in self.words else super().take(reading, value, path)

    def parse(self, text: str, folder: str) -> str:
        meant = self.also.get(text.strip().lower())
        hint = f"; write '{meant}'" if meant else did_you_mean(text, self.words) or f"; write {self.expected()}"
        refused(f"unknown word '{shown(text)}'{hint}")

    def expected(self) -> str:
        return " or ".join(f"'{word}'" for word in self.words)

    def example(self) -> str:
        return self.words[0]

    def written(self) -> str:
        return ", ".join(f"`{word}`" for word in self.words)

    def schema(self, definitions: Schema) -> Schema:
        return {"enum": list(self.words)}


class Truth(Choice):
    """`true` or `false`; becomes a bool."""

    def __init__(self) -> None:
        super().__init__(("true", "false"))

    def take(self, reading: Reading, value: Any, path: Path) -> Any:
        """Take one of the two words."""
        return super().take(reading, value, path) == "true"

    def schema(self, definitions: Schema) -> Schema:
        return {"type": "boolean"}


class UnitName(Scalar):
    """The name of a unit of this kind; becomes the factor pair that turns numbers into its base."""

    def __init__(self, kind: str) -> None:
        self.unit_of = kind

    def parse(self, text: str, folder: str) -> Any:
        return unit_factor(text, self.unit_of)

    def expected(self) -> str:
        return f"a unit of {self.unit_of}, such as '{self.example()}'"

    def example(self) -> str:
        return unit_example(self.unit_of)

    def schema(self, definitions: Schema) -> Schema:
        return {"type": "string", "pattern": f"^\\s*{_units(self.unit_of)}\\s*$"}


@cache
def _units(kind: str) -> str:
    """Return a pattern of the units of a kind in every spelling that the reader takes."""
    return "(?:" + "|".join(_spellings(name) for name in unit_names(kind)) + ")"


def _spellings(unit: str) -> str:
    """Return a pattern of one unit: `kgf m2` is also `kgf·m²` and `kgf*m^2`."""
    letters = re.escape(re.sub(r"(?<=[a-z])2", "²", unit)).replace("\\ ", "[ ·*]+").replace("/", "\\s*/\\s*")
    return re.sub("^u(?=m)", "[uµμ]", letters).replace("²", "(?:\\^?2|²)")


class Text(Scalar):
    """Any text that is not empty."""

    def parse(self, text: str, folder: str) -> str:
        return text.strip()

    def expected(self) -> str:
        return "a text"

    def schema(self, definitions: Schema) -> Schema:
        return {"type": ["string", "number"]}


class Patterned(Scalar):
    """A text of a pattern, such as numbers joined by hyphens; what: what it is, sample: one that fits."""

    pattern: str
    what: str
    sample: str

    def matched(self, text: str) -> str:
        """Return a text that fits as a keyboard writes it; raises RuleError."""
        if not re.fullmatch(self.pattern, plain(text)):
            refused(f"expected {self.expected()}, got '{text}'")
        return plain(text)

    def expected(self) -> str:
        return f"{self.what}, such as '{self.sample}'"

    def example(self) -> str:
        return self.sample

    def written(self) -> str:
        return f"`{self.sample}`"

    def schema(self, definitions: Schema) -> Schema:
        return {"type": ["string", "integer"], "pattern": rf"^\s*{self.pattern}\s*$"}


class FiringOrder(Patterned):
    """The numbers of all cylinders in the order in which they fire, such as `1-3-4-2`; becomes a tuple of int."""

    pattern = r"[1-9][0-9]{0,2}(\s*[-, ]\s*[1-9][0-9]{0,2})*"
    what, sample = "the numbers of the cylinders", "1-3-4-2"

    def parse(self, text: str, folder: str) -> tuple[int, ...]:
        """Return the numbers; raises RuleError where they are not those from 1 on, each once."""
        order = tuple(map(int, re.findall("[0-9]+", self.matched(text))))
        twice = next((number for number in order if order.count(number) > 1), None)
        if twice:
            refused(f"cylinder {twice} stands twice in {text}")
        missing = next((number for number in range(1, max(order) + 1) if number not in order), None)
        if missing or len(order) > MOST_ITEMS:
            refused(f"cylinder {missing} is missing in {text}" if missing else f"more than {MOST_ITEMS} cylinders")
        return order


_COLUMNS = r"[1-9][0-9]{0,4}(\s*-\s*[1-9][0-9]{0,4})?"
_MOST = 5000


class ColumnRange(Patterned):
    """The numbers of columns, such as `2-61` or `2, 5, 7-9`; becomes a tuple of int."""

    pattern = rf"{_COLUMNS}(\s*,\s*{_COLUMNS})*"
    what, sample = "the numbers of columns", "2-61"

    def parse(self, text: str, folder: str) -> tuple[int, ...]:
        """Return the numbers, each once; raises RuleError."""
        parts = [[int(one) for one in part.split("-")] for part in self.matched(text).split(",")]
        found = tuple(number for part in parts for number in range(part[0], part[-1] + 1))
        if len(set(found)) < len(found) or any(part[0] > part[-1] for part in parts):
            refused(f"{text} runs backward or names a column twice; write for instance '2-61'")
        return found if len(found) <= _MOST else refused(f"{text} are {len(found)} columns; at most {_MOST} are read")

    def expected(self) -> str:
        return "the numbers of columns, such as '2-61', or in quotation marks '2, 5, 7-9'"

    def written(self) -> str:
        return "`2-61`, or in quotation marks `'2, 5, 7-9'`"


class FilePath(Scalar):
    """The path of a file, relative to the machine file; becomes a path that can be opened."""

    def parse(self, text: str, folder: str) -> str:
        full = os.path.join(folder, text)
        if os.path.isdir(full):
            refused(f"'{shown(text)}' is a folder; name the file in it")
        if os.path.exists(full) and not os.path.isfile(full):
            refused(f"'{shown(text)}' is a device or a pipe; name a file that can be read again")
        if not os.path.isfile(full):
            refused(f"there is no file '{shown(text)}' in {shown(folder) if folder else 'the working directory'}")
        return full

    def expected(self) -> str:
        return "the name of a file"

    def schema(self, definitions: Schema) -> Schema:
        return {"type": "string", "minLength": 1}


_FAULTS_SHOWN = 3  # of one list: the others are of the same sort, as when every pair has a decimal comma


class Points(Form):
    """A list of pairs of bare numbers, `[[x, y], …]`, or of triples; becomes a list of tuples of floats.

    ratio: the first number of each may also be a quotient or in percent.
    """

    shape = list

    def __init__(self, *names: str, least: int = 2, ratio: bool = False) -> None:
        self.columns, self.least, self.ratio = names, least, ratio
        self._first = parse_ratio if ratio else parse_number
        self.called, self.count = {2: ("pair", "two"), 3: ("triple", "three")}[len(names)]
        self.one = f"[{', '.join(names)}]"

    def expected(self) -> str:
        return f"a list of {self.called}s [{self.one}, …]"

    def example(self) -> str:
        return "[[0, 1], [1, 2]]" if len(self.columns) == 2 else "[[1, 20, -5]]"

    def written(self) -> str:
        return f"`[{self.one}, …]`"

    def schema(self, definitions: Schema) -> Schema:
        length = len(self.columns)
        number = {"type": ["number", "string"] if self.ratio else "number"}
        one = {"type": "array", "items": number, "minItems": length, "maxItems": length}
        return {"type": "array", "items": one, "minItems": self.least, "maxItems": MOST_POINTS}

    def take(self, reading: Reading, value: Any, path: Path) -> Any:
        """Read the pairs, and tell the first few that are none."""
        if not isinstance(value, list):
            missing = isinstance(value, Plain) and not value
            got = "" if missing else f", got {kind_of(value)}"
            refused(f"{'a value is missing; write' if missing else 'expected'} {self.expected()}{got}")
        if len(value) > MOST_POINTS:
            refused(f"{len(value)} points; more than {MOST_POINTS} are not taken, thin them out")
        pairs = [self._numbers(item) for item in value]
        bad = [index for index, pair in enumerate(pairs) if pair is None]
        if bad:
            return self._report(reading, value, path, bad)
        if len(pairs) < self.least:
            only = f"only {len(pairs)} point" if pairs else "no points"
            refused(f"{only}; at least {self.least} are needed, [{self.one}, …]")
        return pairs

    def _report(self, reading: Reading, value: list[Any], path: Path, bad: list[int]) -> Any:
        if all(isinstance(item, str) for item in value):
            refused(f"expected {self.expected()}, got single values; put each {self.called} into its own brackets")
        told = [index for index in bad if value[index] is not REFUSED]
        for index in told[:_FAULTS_SHOWN]:
            self._explain(reading, value[index], (*path, index))
        more = told[_FAULTS_SHOWN:]
        if more:
            these = f"these {len(more)} points are" if len(more) > 1 else "this point is"
            reading.fault((*path, more[0]), f"from here on {these} wrong as well")
        return REFUSED

    def _explain(self, reading: Reading, item: Any, path: Path) -> None:
        """Note what is wrong with one point."""
        pair = f"{self.called} {self.one}"
        if not isinstance(item, list):
            reading.fault(path, f"expected a {pair}, got {kind_of(item)}")
        elif any(isinstance(entry, (list, dict)) for entry in item):
            reading.fault(path, f"expected a {pair} of numbers; are there too many brackets?")
        elif len(item) != len(self.columns):
            reading.fault(path, _wrong_length(item, pair, self.count, len(self.columns)))
        else:
            for index, name in enumerate(self.columns):
                if item[index] is not REFUSED and (message := self._wrong_number(index, name, item[index])):
                    reading.fault((*path, index), message)

    def _numbers(self, item: Any) -> tuple[float, ...] | None:
        """Return the numbers of a point, None where it is none."""
        if type(item) is not list or len(item) != len(self.columns):
            return None
        if any(type(entry) is not Plain or len(entry) > LONGEST_VALUE for entry in item):
            return None
        try:
            return self._first(item[0]), *map(parse_number, item[1:])
        except UnitError:
            return None

    def _wrong_number(self, index: int, name: str, entry: Any) -> str:
        if is_nothing(entry):
            return f"a value is missing; write the {name} as a number"
        if not isinstance(entry, Plain):
            return f'expected a number, got the text "{shown(entry)}"; leave out the quotation marks'
        try:
            (parse_number if index else self._first)(shown(entry, LONGEST_VALUE))
        except UnitError as error:
            return str(error)
        return ""


def _wrong_length(item: list[Any], pair: str, count: str, length: int) -> str:
    written = shown(", ".join(str(entry) for entry in item[:6]))
    if len(item) == 1 < length < 3 and re.fullmatch(r"\S+\s+\S+", str(item[0])):
        return f"a comma is missing between the two numbers; write [{shown(', '.join(str(item[0]).split()))}]"
    if length < len(item) <= 2 * length and all(re.fullmatch(r"[-+]?\d+", str(entry)) for entry in item):
        return f"a {pair} has {count} numbers, [{written}] has {len(item)}; write decimal points, such as 1.5 for 1,5"
    return f"a {pair} has {count} numbers, [{written}] has {len(item) or 'none'}"


_EXAMPLE = "'bore: ± 0.2 mm' or 'masses.piston: ± 2 %'"
_SIGN = r"(±|\+/-|\+-)\s*"


class Uncertainties(Form):
    """A mapping from dotted keys to `± 0.2 mm` or `± 2 %`; becomes pairs of key and text without the sign."""

    shape = dict

    def expected(self) -> str:
        return f"a mapping of keys to standard uncertainties, such as {_EXAMPLE}"

    def schema(self, definitions: Schema) -> Schema:
        return {"type": "object", "minProperties": 1, "additionalProperties": {"type": ["string", "number"]}}

    def take(self, reading: Reading, value: Any, path: Path) -> Any:
        """Read every uncertainty."""
        if not isinstance(value, dict) or not value:
            refused(f"expected {self.expected()}, got {'nothing' if is_nothing(value) else kind_of(value)}")
        found = [(name, self._read(reading, one, (*path, name))) for name, one in value.items()]
        return REFUSED if any(text is REFUSED for _, text in found) else tuple(found)

    def _read(self, reading: Reading, value: Any, path: Path) -> Any:
        if isinstance(value, str) and len(value) <= LONGEST_VALUE:
            text = spread_text(value)
            if text:
                return text
            value = shown(value)
        return reading.fault(path, f"expected a standard uncertainty above 0, such as {_EXAMPLE}, got {value!r}")


class Settings(Form):
    """A mapping from dotted keys to values that stand there instead; becomes pairs of key and value, as in the file."""

    shape = dict

    def expected(self) -> str:
        return "a mapping of dotted keys to values, such as 'speed: 60 rpm' or 'cylinders.0.bore: 450 mm'"

    def schema(self, definitions: Schema) -> Schema:
        return {"type": "object", "minProperties": 1}

    def take(self, reading: Reading, value: Any, path: Path) -> Any:
        """Take the values as they are: they are read with the case."""
        if not isinstance(value, dict) or not value:
            refused(f"expected {self.expected()}, got {'nothing' if is_nothing(value) else kind_of(value)}")
        return tuple(value.items())


def spread_text(text: str) -> str:
    """Return the number with its unit, or percent, after `±`; '' for what is none above 0.

    >>> spread_text("± 0.2 mm"), spread_text("+-2 %"), spread_text("±-1 mm")
    ('0.2 mm', '2 %', '')
    """
    rest = re.sub(_SIGN, "", plain(text).strip(), count=1)
    number = NUMBER.match(rest)
    return rest if number and float(number.group()) > 0 else ""
