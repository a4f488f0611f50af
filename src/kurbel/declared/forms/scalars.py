"""Forms of one line: numbers, values with a unit, counts, words, texts."""

import operator
import re
from abc import abstractmethod
from collections.abc import Iterator, Sequence
from functools import cache
from typing import Any

import numpy as np

from kurbel.declared.keys import Form, Schema
from kurbel.declared.kinds import KINDS, out_of_size, range_of
from kurbel.declared.numerals import NUMBER, RATIO, WRITTEN, parse_ratio
from kurbel.declared.reading import LONGEST_VALUE, Plain, Reading, glued_hint, is_nothing, kind_of, shown
from kurbel.declared.unit_systems import show
from kurbel.declared.units import (
    example,
    parse_quantity,
    plain_quantities,
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
