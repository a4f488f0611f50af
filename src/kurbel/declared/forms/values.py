"""Forms of values: numbers with their units and bounds, words, other texts of one line, lists of points."""

import math
import os
import re
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import KW_ONLY, dataclass, field
from functools import cached_property
from typing import Any, ClassVar, NoReturn

import numpy as np

from kurbel.arrays import Array, Flags, Number, Truth
from kurbel.declared.numerals import NUMBER, keyboard_text, parse_number, parse_ratio
from kurbel.declared.reading import (
    LONGEST_VALUE,
    REFUSED,
    Node,
    Plain,
    Reading,
    glued_hint,
    is_nothing,
    node_kind,
    text_in_one_line,
)
from kurbel.declared.unit_systems import show
from kurbel.declared.units import (
    KINDS,
    MOST_ITEMS,
    MOST_POINTS,
    DiagramPoint,
    UnitFactor,
    kind_example,
    parse_quantity,
    unit_example,
    unit_factor,
    written_unit,
)
from kurbel.errors import Fault, Path, RuleError, UnitError, refused
from kurbel.near_words import did_you_mean
from kurbel.numerics.arithmetic import is_number

Schema = dict[str, Any]


class Form(ABC):
    """The form of the value of a key: how it is written, and what it becomes.

    expected: for 'expected …'; example: a value as a person writes it, '…' if that is longer than a line; written: a
    short description for pages. kind: of the number, or of each number of a list, '' for other values; number: the form
    of the number that it becomes, which many machines have as an array; unread: stands for a value that could not be
    read, while rules judge the others, None if nothing can; inline: records whose keys are in the same
    mapping. schema: the JSON Schema of a value, as far as it does not depend on parts and units; parts: the forms that
    it consists of, each after its key, '' for none.
    """

    shape: ClassVar[type] = str
    """Of the tree: str, list or dict."""
    kind: str = ""
    number: "NumberForm | None" = None
    unread: object = None
    inline: "tuple[Form, ...]" = ()

    @cached_property
    def expected(self) -> str:
        """For 'expected …'; what is written, where a form has no other words for it."""
        return self.written

    @cached_property
    def parts(self) -> "tuple[tuple[str, Form], ...]":
        """The forms that it consists of, each after its key."""
        return ()

    def __init__(
        self,
        expected: str,
        example: str = "…",
        written: str = "",
        schema: Schema | None = None,
        parts: "Iterable[tuple[str, Form]]" = (),
    ) -> None:
        self.expected = expected
        self.example = example
        self.schema = schema or {}
        self.parts = tuple(parts)
        usually_written = expected if self.shape is str else "a mapping"
        self.written = written or usually_written

    def kind_as_written(self, value: Node | None) -> str:
        """Return the kind of the number that is written in this way, '' if it is no number."""
        return self.kind

    @abstractmethod
    def take(self, reading: Reading, value: Node, path: Path) -> object:
        """Return what a value of the tree becomes; faults are reported, or raised as RuleError."""

    def read(self, reading: Reading, value: Node, path: Path) -> Any:
        """Return what a value of the tree becomes, or REFUSED after reporting every fault."""
        if value is REFUSED:
            return REFUSED
        try:
            return self.take(reading, value, path)
        except RuleError as error:
            return reading.refuse(path, error)


def one_line(value: Node, expected: str) -> str:
    """Return a text of one line and of sensible length; raises RuleError for anything else."""
    if is_nothing(value):
        refused(f"a value is missing; write {expected}")
    if isinstance(value, str) and len(value) > LONGEST_VALUE:
        refused(f"expected {expected}, got {len(value)} characters; {LONGEST_VALUE} are the most")
    if not isinstance(value, str) or not value.isprintable():
        refused(f"expected {expected}, got {node_kind(value)}")
    if value.strip():
        return value
    return refused(f"expected {expected}, got an empty text")


def _beyond(value: Number, kind: str) -> tuple[tuple[Truth, str], ...]:
    """Return whether a value in the base of its kind, or which of many, is too large or too small for machine files."""
    smallest, largest, *_ = KINDS[kind]
    size = np.abs(value)
    is_too_large = ~(size <= largest)
    is_too_small = (value != 0) & (size < smallest)
    return (is_too_large, "large"), (is_too_small, "small")


def out_of_size(value: float, kind: str) -> str:
    """Return the message if a value in the base of its kind is out of the range of machine files.

    >>> out_of_size(1e-200, "length")
    'is too small; a length in a machine file is 0 or at least 1e-09 m'
    """
    sizes = [size for is_beyond, size in _beyond(value, kind) if is_beyond]
    if not sizes:
        return ""
    smallest, largest, _, unit, *_ = KINDS[kind]
    name = "bare number" if kind == "ratio" else kind.replace("_", " ")
    article = "an" if name[0] in "aei" else "a"
    allowed = f"0 or at least {smallest:g} {unit}"
    if sizes[0] == "large":
        allowed = f"at most {largest:g} {unit}"
    return f"is too {sizes[0]}; {article} {name} in a machine file is {allowed}".rstrip()


def size_faults(points: Sequence[DiagramPoint], unit: UnitFactor, kind: str) -> list[Fault]:
    """Return a fault for the first point whose value in this unit of its kind is too large; [] if there is none."""
    multiplier, divisor = unit
    for index, (_, value) in enumerate(points):
        if abs(value * multiplier / divisor) > KINDS[kind].largest:
            return [Fault((index, 1), f"{value:g} {out_of_size(math.inf, kind)}")]
    return []


def order_faults(points: Sequence[DiagramPoint], format: str) -> list[Fault]:
    """Return a fault for the first point at which a line turns back, or has a third value.

    format: how the abscissa of a point is written in the message.

    >>> order_faults([(0, 5), (0.6, 4), (0.5, 3)], "fraction {:g}")[0].message
    'fraction 0.5 after 0.6: the line turns back'
    """
    rises = points[0][0] <= points[-1][0]
    for index in range(1, len(points)):
        point = points[index]
        before = points[index - 1]
        turns_back = point[0] != before[0] and (point[0] > before[0]) != rises
        if turns_back:
            where = f"{format.format(point[0])} after {before[0]:g}"
            return [Fault((index,), f"{where}: the line turns back")]
        if index == 1:
            continue
        # three different points at one abscissa
        two_before = points[index - 2]
        is_same_abscissa = two_before[0] == point[0]
        if is_same_abscissa and two_before != before and before != point:
            where = format.format(point[0])
            return [Fault((index,), f"three points at {where}; a jump has two")]
    return []


@dataclass(eq=False)
class NumberForm(Form):
    """A number with a unit of its kind, such as `450 mm`, or a bare one; becomes a float in the base of the kind.

    above, below: the value must be larger or smaller; least, most: it must not be smaller or larger; zero: 0 is allowed
    in addition to the bounds. words: texts allowed instead, such as `infinite`, with their values; or_else: what else
    is allowed, for messages. share_of: the quantity of which the value is a share, for the message on a value with a
    unit. is_difference: of two values, see `parse_quantity`. whole: it becomes an int. becomes: a function of the value
    and the text as written; apart: of one value at a time, not of an array.
    """

    kind: str = "ratio"
    _: KW_ONLY
    above: float | None = None
    least: float | None = None
    below: float | None = None
    most: float | None = None
    words: Mapping[str, float] = field(default_factory=dict)
    zero: bool = False
    whole: bool = False
    is_difference: bool = False
    share_of: str = ""
    or_else: str = ""
    becomes: Callable[[Any, str], object] | None = None
    apart: bool = False

    def __post_init__(self) -> None:
        # an example, and what messages expect
        if self.whole:
            likely = max(self.least or 0, 3) if self.most is None else self.least
            sample = str(likely)
            expected = "a whole number"
        elif self.kind == "ratio":
            sample = "5" if (self.above or 0) >= 1 else "0.1"
            expected = "a number"
        else:
            sample = kind_example(self.kind)
            expected = f"a number with its unit, such as '{sample}'"
        expected += "".join(f" or '{word}'" for word in self.words)
        # how it is written, on pages
        written = ""
        if self.kind != "ratio":
            written = f"`{sample}`" + "".join(f", or `{word}`" for word in self.words)
        super().__init__(expected, sample, written)
        # what it becomes
        self.number = None if self.whole or self.apart else self
        is_nan_unread = self.number is not None and not self.becomes
        self.unread = math.nan if is_nan_unread else None

    def take(self, reading: Reading, value: Node, path: Path) -> object:
        """Read the number, and compare it with its bounds."""
        text = one_line(value, self.expected)
        if text in self.words:
            return self.words[text]
        is_unknown_word = self.words and text.strip()[0].isalpha()
        is_no_number = self.or_else and not NUMBER.match(keyboard_text(text))
        if is_unknown_word or is_no_number:
            refused(f"expected {self.expected}{self.or_else}, got '{text_in_one_line(text)}'")
        try:
            number = self._number(text)
        except UnitError as error:
            refused(f"{error}{glued_hint(text)}")
        broken_bound = self.out_of_bounds(number) or out_of_size(number, self.kind)
        if broken_bound:
            refused(f"{text} {broken_bound}")
        if not self.becomes:
            return number
        return self.becomes(number, text)

    def _number(self, text: str) -> float:
        """Return the number in the base of its kind; raises RuleError."""
        if self.kind != "ratio":
            return parse_quantity(text, self.kind, self.is_difference)
        has_unit = written_unit(text)[:1].isalpha()
        if self.share_of and has_unit:
            refused(
                f"expected a number, got '{text}'; "
                f"it is a share of {self.share_of}, such as 0.05 or 5 %"
            )
        if not isinstance(text, Plain):
            number = "a whole number" if self.whole else "a number"
            refused(f'expected {number}, got the text "{text}"; leave out the quotation marks')
        if not self.whole:
            return parse_ratio(text)
        if not re.fullmatch(r"[-+]?(0|[1-9][0-9]{0,8})", text):
            refused(f"expected a whole number, got '{text}'")
        if self.most == self.least != int(text):
            refused(f"{int(text)} is not supported; it must be {self.least}")
        return int(text)

    def out_of_bounds(self, value: Any) -> str:
        """Compare a number with the bounds.

        >>> NumberForm("length", least=0.1).out_of_bounds(-0.3)
        'is too small; it must be at least 100 mm'
        """
        if not is_number(value):
            return ""
        for is_broken, bound, size, relation in self._bounds(value):
            if is_broken:
                limit = show(bound, self.kind) if bound else "0"
                return f"is too {size}; it must be {relation} {limit}"
        if math.isinf(value) and not self.words:
            return "must be finite"
        return ""

    def within(self, values: Array) -> Flags:
        """Return which of many numbers (n,) are that of a word, or within the bounds and the range of machine files."""
        is_beyond = np.zeros(len(values), dtype=bool)
        for is_broken, *_ in (*self._bounds(values), *_beyond(values, self.kind)):
            is_beyond |= is_broken
        is_word = np.isin(values, list(self.words.values()))
        return is_word | ~is_beyond

    def _bounds(self, value: Number) -> Iterator[tuple[Truth, float, str, str]]:
        """Yield whether a number, or which of many, breaks a bound, and what it then is and must be."""
        # 0 may be allowed in addition to the bounds
        has_bounds = (value != 0) | (not self.zero)
        if self.above is not None:
            yield has_bounds & (value <= self.above), self.above, "small", "more than"
        if self.least is not None:
            yield has_bounds & (value < self.least), self.least, "small", "at least"
        if self.below is not None:
            yield has_bounds & (value >= self.below), self.below, "large", "less than"
        if self.most is not None:
            yield has_bounds & (value > self.most), self.most, "large", "at most"


class Choice(Form):
    """One of these words.

    also: other words that people try, each with the correct one; means: what the words become, if not themselves.
    """

    def __init__(
        self,
        words: tuple[str, ...],
        also: dict[str, str] | None = None,
        means: dict[str, object] | None = None,
    ) -> None:
        self.words = words
        self.also = also or {}
        self.means = means or {}
        expected = " or ".join(f"'{word}'" for word in words)
        written = ", ".join(f"`{word}`" for word in words)
        schema: Schema = {"enum": list(words)}
        if words == ("true", "false"):
            schema = {"type": "boolean"}
        super().__init__(expected, words[0], written, schema)

    def take(self, reading: Reading, value: Node, path: Path) -> object:
        """Return the word, unchanged: a blank or a tab can be one."""
        if isinstance(value, str) and value in self.words:
            return self.means.get(value, str(value))
        text = one_line(value, self.expected)
        meant = self.also.get(text.strip().lower())
        if meant:
            hint = f"; write '{meant}'"
        else:
            hint = did_you_mean(text, self.words) or f"; write {self.expected}"
        return refused(f"unknown word '{text_in_one_line(text)}'{hint}")


class Text(Form):
    """Any other text of one line.

    become: a function of the text and the folder of the file; it raises RuleError for an invalid text. pattern: regular
    expression for the text in plain characters; unit_of: the kind of which it names a unit.
    """

    def __init__(
        self,
        expected: str,
        become: Callable[[str, str], object],
        example: str = "…",
        written: str = "",
        schema: Schema | None = None,
        pattern: str = "",
        unit_of: str = "",
    ) -> None:
        if pattern:
            schema = {"type": ["string", "integer"], "pattern": rf"^\s*{pattern}\s*$"}
        super().__init__(expected, example, written, schema)
        self.become = become
        self.pattern = pattern
        self.unit_of = unit_of
        self.unread = (math.nan, 1.0) if unit_of else None

    def take(self, reading: Reading, value: Node, path: Path) -> object:
        """Read the text."""
        text = one_line(value, self.expected)
        if self.pattern and not re.fullmatch(self.pattern, keyboard_text(text)):
            refused(f"expected {self.expected}, got '{text}'")
        if self.pattern:
            text = keyboard_text(text)
        return self.become(text, reading.folder)


TEXT = Text("a text", lambda text, folder: text.strip(), schema={"type": ["string", "number"]})


def unit_name(kind: str) -> Text:
    """Return the form of the name of a unit; it becomes the pair of factors that converts to the base of the kind."""
    sample = unit_example(kind)
    expected = f"a unit of {kind}, such as '{sample}'"
    return Text(expected, lambda text, folder: unit_factor(text, kind), sample, unit_of=kind)


def _firing_order(text: str, folder: str) -> tuple[int, ...]:
    """Return the numbers of all cylinders from 1, each once; raises RuleError for any other list."""
    order = tuple(map(int, re.findall("[0-9]+", text)))
    for number in order:
        if order.count(number) > 1:
            refused(f"cylinder {number} is listed twice in {text}")
    for number in range(1, max(order) + 1):
        if number not in order:
            refused(f"cylinder {number} is missing in {text}")
    if len(order) > MOST_ITEMS:
        refused(f"more than {MOST_ITEMS} cylinders")
    return order


FIRING_ORDER = Text(
    "the numbers of the cylinders, such as '1-3-4-2'",
    _firing_order,
    "1-3-4-2",
    "`1-3-4-2`",
    pattern=r"[1-9][0-9]{0,2}(\s*[-, ]\s*[1-9][0-9]{0,2})*",
)
"""The numbers of all cylinders in the order in which they fire; becomes a tuple of int."""

_MOST_COLUMNS = 5000


def _columns(text: str, folder: str) -> tuple[int, ...]:
    """Return the numbers of columns, each once; raises RuleError."""
    numbers: list[int] = []
    is_backward = False
    for span in text.split(","):
        ends = span.split("-")
        first, last = int(ends[0]), int(ends[-1])
        is_backward = is_backward or first > last
        numbers += range(first, last + 1)
    if is_backward or len(set(numbers)) < len(numbers):
        refused(f"{text} runs backward or names a column twice; write for instance '2-61'")
    if len(numbers) > _MOST_COLUMNS:
        refused(f"{text} are {len(numbers)} columns; at most {_MOST_COLUMNS} are read")
    return tuple(numbers)


_COLUMN = r"[1-9][0-9]{0,4}(\s*-\s*[1-9][0-9]{0,4})?"
COLUMN_RANGE = Text(
    "the numbers of columns, such as '2-61', or in quotation marks '2, 5, 7-9'",
    _columns,
    "2-61",
    "`2-61`, or in quotation marks `'2, 5, 7-9'`",
    pattern=rf"{_COLUMN}(\s*,\s*{_COLUMN})*",
)
"""The numbers of columns; becomes a tuple of int."""


def _existing(text: str, folder: str) -> str:
    """Return the path of a file, given relative to this folder, as one that can be opened; raises RuleError."""
    path = os.path.join(folder, text)
    if os.path.isfile(path):
        return path
    name = f"'{text_in_one_line(text)}'"
    if os.path.isdir(path):
        refused(f"{name} is a folder; name the file in it")
    if os.path.exists(path):
        refused(f"{name} is a device or a pipe; name a file that can be read again")
    where = text_in_one_line(folder) if folder else "the working directory"
    return refused(f"there is no file {name} in {where}")


FILE_PATH = Text("the name of a file", _existing, schema={"type": "string", "minLength": 1})
"""The path of a file, relative to the machine file."""

_FAULTS_SHOWN = 3  # of one list; the others usually have the same cause, such as decimal commas


class Ordinates(Form):
    """A list of bare numbers, `[y, y, …]`; becomes a tuple of floats."""

    shape = list
    _least = 3
    _most = 1000

    def __init__(self) -> None:
        schema: Schema = {
            "type": "array",
            "items": {"type": "number"},
            "minItems": self._least,
            "maxItems": self._most,
        }
        sample = "[22.5, 31, 28.5]"
        super().__init__(f"a list of numbers, such as {sample}", sample, f"`{sample}`", schema)

    def take(self, reading: Reading, value: Node, path: Path) -> object:
        """Read the numbers, and report each that is none."""
        if not isinstance(value, list):
            refused(f"expected {self.expected}, got {node_kind(value)}")
        if not self._least <= len(value) <= self._most:
            refused(f"{len(value)} numbers; from {self._least} to {self._most} are taken")
        numbers: list[float] = []
        for index, item in enumerate(value):
            try:
                numbers.append(parse_number(one_line(item, "a number")))
            except RuleError as error:
                reading.refuse((*path, index), error)
        return tuple(numbers) if len(numbers) == len(value) else REFUSED


class Points(Form):
    """A list of pairs of bare numbers, `[[x, y], …]`, or of triples; becomes a list of tuples of floats.

    ratio: the first number of each may also be a quotient or in percent.
    """

    shape = list

    def __init__(self, *names: str, least: int = 2, ratio: bool = False) -> None:
        self.columns = names
        self.least = least
        self.ratio = ratio
        # how messages name a point
        length = len(names)
        self._called, self._count = {2: ("pair", "two"), 3: ("triple", "three")}[length]
        self._pattern = f"[{', '.join(names)}]"
        sample = "[[0, 1], [1, 2]]"
        if length == 3:
            sample = "[[1, 20, -5]]" if least == 1 else "[[0, 5, 0], [1, 8, 0]]"
        # the schema
        number: Schema = {"type": "number"}
        if ratio:
            number["type"] = ["number", "string"]
        point = {"type": "array", "items": number, "minItems": length, "maxItems": length}
        schema = {"type": "array", "items": point, "minItems": least, "maxItems": MOST_POINTS}
        expected = f"a list of {self._called}s [{self._pattern}, …]"
        super().__init__(expected, sample, f"`[{self._pattern}, …]`", schema)

    def take(self, reading: Reading, value: Node, path: Path) -> object:
        """Read the pairs, and report the first few wrong ones."""
        if isinstance(value, Plain) and not value:
            refused(f"a value is missing; write {self.expected}")
        if not isinstance(value, list):
            refused(f"expected {self.expected}, got {node_kind(value)}")
        if len(value) > MOST_POINTS:
            refused(f"{len(value)} points; more than {MOST_POINTS} are not taken, thin them out")
        # its points, and the errors of others by index
        points: list[DiagramPoint] = []
        errors: dict[int, RuleError] = {}
        for index, item in enumerate(value):
            try:
                points.append(self._numbers(item))
            except RuleError as error:
                errors[index] = error
        if not errors:
            if len(points) < self.least:
                count = f"only {len(points)} point" if points else "no points"
                refused(f"{count}; at least {self.least} are needed, [{self._pattern}, …]")
            return points
        if all(isinstance(item, str) for item in value):
            refused(
                f"expected {self.expected}, got single values; "
                f"put each {self._called} into its own brackets"
            )
        # the first few errors; an error without faults has been reported
        new = [index for index, error in errors.items() if error.faults]
        for index in new[:_FAULTS_SHOWN]:
            reading.refuse((*path, index), errors[index])
        further = new[_FAULTS_SHOWN:]
        if further:
            subject = f"these {len(further)} points are" if len(further) > 1 else "this point is"
            reading.fault((*path, further[0]), f"from here on {subject} wrong as well")
        return REFUSED

    def _numbers(self, item: Node) -> DiagramPoint:
        """Return the numbers of a point; raises RuleError, without faults if these have been reported."""
        if item is REFUSED:
            raise RuleError()
        expected = f"expected a {self._called} {self._pattern}"
        if not isinstance(item, list):
            refused(f"{expected}, got {node_kind(item)}")
        if any(isinstance(entry, (list, dict)) for entry in item):
            refused(f"{expected} of numbers; are there too many brackets?")
        if len(item) != len(self.columns):
            self._miscounted(list(map(str, item)))
        numbers: list[float] = []
        faults: list[Fault] = []
        for index, entry in enumerate(item):
            if entry is REFUSED:
                continue
            try:
                numbers.append(self._number(entry, index))
            except RuleError as error:
                faults += (fault.below((index,)) for fault in error.faults)
        if len(numbers) < len(self.columns):
            raise RuleError(*faults)
        return tuple(numbers)

    def _number(self, entry: Node, index: int) -> float:
        """Return the number at this index of a point; raises RuleError."""
        if is_nothing(entry):
            refused(f"a value is missing; write the {self.columns[index]} as a number")
        text = text_in_one_line(str(entry), LONGEST_VALUE)
        is_quoted = isinstance(entry, str) and not isinstance(entry, Plain)
        if is_quoted:
            refused(
                f'expected a number, got the text "{text_in_one_line(text)}"; '
                "leave out the quotation marks"
            )
        if self.ratio and index == 0:
            return parse_ratio(text)
        return parse_number(text)

    def _miscounted(self, texts: list[str]) -> NoReturn:
        """Raise RuleError for a point of too many or too few numbers."""
        length = len(self.columns)
        if len(texts) == 1 and length == 2 and re.fullmatch(r"\S+\s+\S+", texts[0]):
            numbers = text_in_one_line(", ".join(texts[0].split()))
            refused(f"a comma is missing between the two numbers; write [{numbers}]")
        # 1,5 is read as two whole numbers
        hint = ""
        has_whole_numbers = all(re.fullmatch(r"[-+]?\d+", text) for text in texts)
        if has_whole_numbers and length < len(texts) <= 2 * length:
            hint = "; write decimal points, such as 1.5 for 1,5"
        point = text_in_one_line(", ".join(texts[:6]))
        count = len(texts) or "none"
        refused(
            f"a {self._called} {self._pattern} has {self._count} numbers, "
            f"[{point}] has {count}{hint}"
        )


CLEARANCE = NumberForm(share_of="the stroke", least=1e-6, most=1e5)
"""A clearance volume over the stroke volume, within bounds for which p V^n can be computed."""
CLEARANCE_OR_NONE = NumberForm(share_of="the stroke", least=1e-6, most=1e5, zero=True)
"""The same if it may also be 0, which leaves the clearance out of the theory."""
