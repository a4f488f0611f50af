"""Forms of values: numbers with their units and bounds, words, other texts of one line, lists of points."""

import math
import operator
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
        """For 'expected …'."""
        raise NotImplementedError

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
        self.expected, self.example, self.schema, self.parts = (
            expected,
            example,
            schema or {},
            tuple(parts),
        )
        self.written = written or (expected if self.shape is str else "a mapping")

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
    return value if value.strip() else refused(f"expected {expected}, got an empty text")


def _beyond(value: Number, kind: str) -> tuple[tuple[Truth, str], ...]:
    """Return whether a value in the base of its kind, or which of many, is too large or too small for machine files."""
    smallest, largest, *_ = KINDS[kind]
    return (~(np.abs(value) <= largest), "large"), (
        (value != 0) & (np.abs(value) < smallest),
        "small",
    )


def out_of_size(value: float, kind: str) -> str:
    """Return the message if a value in the base of its kind is out of the range of machine files.

    >>> out_of_size(1e-200, "length")
    'is too small; a length in a machine file is 0 or at least 1e-09 m'
    """
    too = next((too for beyond, too in _beyond(value, kind) if beyond), "")
    if not too:
        return ""
    smallest, largest, _, unit, *_ = KINDS[kind]
    name = "bare number" if kind == "ratio" else kind.replace("_", " ")
    within = (
        f"at most {largest:g} {unit}" if too == "large" else f"0 or at least {smallest:g} {unit}"
    )
    return f"is too {too}; {'an' if name[0] in 'aei' else 'a'} {name} in a machine file is {within}".rstrip()


def size_faults(points: Sequence[DiagramPoint], unit: UnitFactor, kind: str) -> list[Fault]:
    """Return a fault for the first point whose value in this unit of its kind is too large; [] if there is none."""
    up, down = unit
    for index, (_, value) in enumerate(points):
        if abs(value * up / down) > KINDS[kind].largest:
            return [Fault((index, 1), f"{value:g} {out_of_size(math.inf, kind)}")]
    return []


def order_faults(points: Sequence[DiagramPoint], place: str) -> list[Fault]:
    """Return a fault for the first point at which a line turns back, or has a third value; place: how one is written.

    >>> order_faults([(0, 5), (0.6, 4), (0.5, 3)], "fraction {:g}")[0].message
    'fraction 0.5 after 0.6: the line turns back'
    """
    forward = points[0][0] <= points[-1][0]
    for index in range(1, len(points)):
        before, here = points[index - 1], points[index]
        if here[0] != before[0] and (here[0] > before[0]) != forward:
            return [
                Fault((index,), f"{place.format(here[0])} after {before[0]:g}: the line turns back")
            ]
        if index > 1 and points[index - 2][0] == here[0] and points[index - 2] != before != here:
            return [Fault((index,), f"three points at {place.format(here[0])}; a jump has two")]
    return []


@dataclass(eq=False)
class NumberForm(Form):
    """A number with a unit of its kind, such as `450 mm`, or a bare one; becomes a float in the base of the kind.

    above, below: the value must be larger or smaller; least, most: it must not be smaller or larger; zero: 0 is allowed
    in addition to the bounds. words: texts allowed instead, such as `infinite`, with their values; or_else: what else
    is allowed, for messages. share_of: the quantity of which the value is a share, for the message on a value with a
    unit. whole: it becomes an int. becomes: a function of the value and the text as written; apart: of one value at a
    time, not of an array.
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
    share_of: str = ""
    or_else: str = ""
    becomes: Callable[[Any, str], object] | None = None
    apart: bool = False

    def __post_init__(self) -> None:
        bare = self.kind == "ratio"
        if self.whole:
            sample, expected = (
                str(max(self.least or 0, 3) if self.most is None else self.least),
                "a whole number",
            )
        elif bare:
            sample, expected = "5" if (self.above or 0) >= 1 else "0.1", "a number"
        else:
            sample = kind_example(self.kind)
            expected = f"a number with its unit, such as '{sample}'"
        written = "" if bare else f"`{sample}`" + "".join(f", or `{word}`" for word in self.words)
        super().__init__(
            expected + "".join(f" or '{word}'" for word in self.words), sample, written
        )
        self.number = None if self.whole or self.apart else self
        self.unread = None if self.number is None or self.becomes else math.nan

    def take(self, reading: Reading, value: Node, path: Path) -> object:
        """Read the number, and compare it with its bounds."""
        text = one_line(value, self.expected)
        if text in self.words:
            return self.words[text]
        if (self.words and text.strip()[0].isalpha()) or (
            self.or_else and not NUMBER.match(keyboard_text(text))
        ):
            refused(f"expected {self.expected}{self.or_else}, got '{text_in_one_line(text)}'")
        try:
            number = self._number(text)
        except UnitError as error:
            refused(f"{error}{glued_hint(text)}")
        if wrong := self.out_of_bounds(number) or out_of_size(number, self.kind):
            refused(f"{text} {wrong}")
        return self.becomes(number, text) if self.becomes else number

    def _number(self, text: str) -> float:
        """Return the number in the base of its kind; raises RuleError."""
        if self.kind != "ratio":
            return parse_quantity(text, self.kind)
        if self.share_of and written_unit(text)[:1].isalpha():
            refused(
                f"expected a number, got '{text}'; it is a share of {self.share_of}, such as 0.05 or 5 %"
            )
        if not isinstance(text, Plain):
            what = "a whole number" if self.whole else "a number"
            refused(f'expected {what}, got the text "{text}"; leave out the quotation marks')
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
        for broken, bound, too, must in self._bounds(value) if is_number(value) else ():
            if broken:
                return f"is too {too}; it must be {must} {show(bound, self.kind) if bound else '0'}"
        return "must be finite" if is_number(value) and not self.words and math.isinf(value) else ""

    def within(self, values: Array) -> Flags:
        """Return which of many numbers (n,) are that of a word, or within the bounds and the range of machine files."""
        beyond = np.zeros(len(values), dtype=bool)
        for broken, *_ in (*self._bounds(values), *_beyond(values, self.kind)):
            beyond |= broken
        return np.isin(values, list(self.words.values())) | ~beyond

    def _bounds(self, value: Number) -> Iterator[tuple[Truth, float, str, str]]:
        """Yield whether a number, or which of many, breaks a bound, and what it then is and must be."""
        counts = (value != 0) | (not self.zero)
        for bound, breaks, too, must in (
            (self.above, operator.le, "small", "more than"),
            (self.least, operator.lt, "small", "at least"),
            (self.below, operator.ge, "large", "less than"),
            (self.most, operator.gt, "large", "at most"),
        ):
            if bound is not None:
                yield counts & breaks(value, bound), bound, too, must


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
        self.words, self.also, self.means = words, also or {}, means or {}
        every, written = (f"'{word}'" for word in words), ", ".join(f"`{word}`" for word in words)
        schema: Schema = (
            {"type": "boolean"} if words == ("true", "false") else {"enum": list(words)}
        )
        super().__init__(" or ".join(every), words[0], written, schema)

    def take(self, reading: Reading, value: Node, path: Path) -> object:
        """Return the word, unchanged: a blank or a tab can be one."""
        if isinstance(value, str) and value in self.words:
            return self.means.get(value, str(value))
        text = one_line(value, self.expected)
        meant = self.also.get(text.strip().lower())
        hint = (
            f"; write '{meant}'"
            if meant
            else did_you_mean(text, self.words) or f"; write {self.expected}"
        )
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
        found = (
            {"type": ["string", "integer"], "pattern": rf"^\s*{pattern}\s*$"} if pattern else schema
        )
        super().__init__(expected, example, written, found)
        self.become, self.pattern, self.unit_of = become, pattern, unit_of
        self.unread = (math.nan, 1.0) if unit_of else None

    def take(self, reading: Reading, value: Node, path: Path) -> object:
        """Read the text."""
        text = one_line(value, self.expected)
        if self.pattern and not re.fullmatch(self.pattern, keyboard_text(text)):
            refused(f"expected {self.expected}, got '{text}'")
        return self.become(keyboard_text(text) if self.pattern else text, reading.folder)


TEXT = Text("a text", lambda text, folder: text.strip(), schema={"type": ["string", "number"]})


def unit_name(kind: str) -> Text:
    """Return the form of the name of a unit; it becomes the pair of factors that converts to the base of the kind."""
    sample = unit_example(kind)
    expected = f"a unit of {kind}, such as '{sample}'"
    return Text(expected, lambda text, folder: unit_factor(text, kind), sample, unit_of=kind)


def _firing_order(text: str, folder: str) -> tuple[int, ...]:
    """Return the numbers of all cylinders from 1, each once; raises RuleError for any other list."""
    order = tuple(map(int, re.findall("[0-9]+", text)))
    twice = next((number for number in order if order.count(number) > 1), None)
    if twice:
        refused(f"cylinder {twice} is listed twice in {text}")
    missing = next((number for number in range(1, max(order) + 1) if number not in order), None)
    if missing or len(order) > MOST_ITEMS:
        refused(
            f"cylinder {missing} is missing in {text}"
            if missing
            else f"more than {MOST_ITEMS} cylinders"
        )
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
    parts = [[int(one) for one in part.split("-")] for part in text.split(",")]
    found = tuple(number for part in parts for number in range(part[0], part[-1] + 1))
    if len(set(found)) < len(found) or any(part[0] > part[-1] for part in parts):
        refused(f"{text} runs backward or names a column twice; write for instance '2-61'")
    if len(found) > _MOST_COLUMNS:
        refused(f"{text} are {len(found)} columns; at most {_MOST_COLUMNS} are read")
    return found


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
    full = os.path.join(folder, text)
    if os.path.isdir(full):
        refused(f"'{text_in_one_line(text)}' is a folder; name the file in it")
    if os.path.exists(full) and not os.path.isfile(full):
        refused(
            f"'{text_in_one_line(text)}' is a device or a pipe; name a file that can be read again"
        )
    if not os.path.isfile(full):
        refused(
            f"there is no file '{text_in_one_line(text)}' in {text_in_one_line(folder) if folder else 'the working directory'}"
        )
    return full


FILE_PATH = Text("the name of a file", _existing, schema={"type": "string", "minLength": 1})
"""The path of a file, relative to the machine file."""

_FAULTS_SHOWN = 3  # of one list; the others usually have the same cause, such as decimal commas


class Points(Form):
    """A list of pairs of bare numbers, `[[x, y], …]`, or of triples; becomes a list of tuples of floats.

    ratio: the first number of each may also be a quotient or in percent.
    """

    shape = list

    def __init__(self, *names: str, least: int = 2, ratio: bool = False) -> None:
        self.columns, self.least, self.ratio = names, least, ratio
        self._called, self._count = {2: ("pair", "two"), 3: ("triple", "three")}[len(names)]
        self._one = f"[{', '.join(names)}]"
        sample = "[[0, 1], [1, 2]]" if len(names) == 2 else "[[1, 20, -5]]"
        number, length = {"type": ["number", "string"] if ratio else "number"}, len(names)
        one = {"type": "array", "items": number, "minItems": length, "maxItems": length}
        schema = {"type": "array", "items": one, "minItems": least, "maxItems": MOST_POINTS}
        super().__init__(
            f"a list of {self._called}s [{self._one}, …]", sample, f"`[{self._one}, …]`", schema
        )

    def take(self, reading: Reading, value: Node, path: Path) -> object:
        """Read the pairs, and report the first few wrong ones."""
        if isinstance(value, Plain) and not value:
            refused(f"a value is missing; write {self.expected}")
        if not isinstance(value, list):
            refused(f"expected {self.expected}, got {node_kind(value)}")
        if len(value) > MOST_POINTS:
            refused(f"{len(value)} points; more than {MOST_POINTS} are not taken, thin them out")
        pairs: list[DiagramPoint] = []
        wrong: list[tuple[int, RuleError]] = []
        for index, item in enumerate(value):
            try:
                pairs.append(self._numbers(item))
            except RuleError as error:
                wrong.append((index, error))
        if not wrong and len(pairs) < self.least:
            only = f"only {len(pairs)} point" if pairs else "no points"
            refused(f"{only}; at least {self.least} are needed, [{self._one}, …]")
        if wrong and all(isinstance(item, str) for item in value):
            refused(
                f"expected {self.expected}, got single values; put each {self._called} into its own brackets"
            )
        unknown = [(index, error) for index, error in wrong if error.faults]
        for index, reason in unknown[:_FAULTS_SHOWN]:
            reading.refuse((*path, index), reason)
        if more := unknown[_FAULTS_SHOWN:]:
            these = f"these {len(more)} points are" if len(more) > 1 else "this point is"
            reading.fault((*path, more[0][0]), f"from here on {these} wrong as well")
        return REFUSED if wrong else pairs

    def _numbers(self, item: Node) -> DiagramPoint:
        """Return the numbers of a point; raises RuleError, without faults if these have been reported."""
        length = len(self.columns)
        if item is REFUSED:
            raise RuleError()
        if not isinstance(item, list):
            refused(f"expected a {self._called} {self._one}, got {node_kind(item)}")
        if any(isinstance(entry, (list, dict)) for entry in item):
            refused(
                f"expected a {self._called} {self._one} of numbers; are there too many brackets?"
            )
        if len(item) != length:
            self._miscounted(list(map(str, item)))
        numbers, faults = [], list[Fault]()
        for index, entry in enumerate(item):
            try:
                if is_nothing(entry):
                    refused(f"a value is missing; write the {self.columns[index]} as a number")
                text = text_in_one_line(str(entry), LONGEST_VALUE)
                if isinstance(entry, str) and not isinstance(entry, Plain):
                    refused(
                        f'expected a number, got the text "{text_in_one_line(text)}"; leave out the quotation marks'
                    )
                if entry is not REFUSED:
                    numbers.append(
                        parse_ratio(text) if self.ratio and not index else parse_number(text)
                    )
            except RuleError as error:
                faults += (fault.below((index,)) for fault in error.faults)
        if len(numbers) < length:
            raise RuleError(*faults)
        return tuple(numbers)

    def _miscounted(self, texts: list[str]) -> NoReturn:
        """Raise RuleError for a point of too many or too few numbers."""
        length = len(self.columns)
        if len(texts) == 1 < length < 3 and re.fullmatch(r"\S+\s+\S+", texts[0]):
            both = text_in_one_line(", ".join(texts[0].split()))
            refused(f"a comma is missing between the two numbers; write [{both}]")
        whole = length < len(texts) <= 2 * length and all(
            re.fullmatch(r"[-+]?\d+", text) for text in texts
        )
        hint = "; write decimal points, such as 1.5 for 1,5" if whole else ""
        wrong = f"a {self._called} {self._one} has {self._count} numbers, [{text_in_one_line(', '.join(texts[:6]))}] has"
        refused(f"{wrong} {len(texts) or 'none'}{hint}")


CLEARANCE = NumberForm(share_of="the stroke", least=1e-6, most=1e5)
"""A clearance volume over the stroke volume, within bounds for which p V^n can be computed."""
CLEARANCE_OR_NONE = NumberForm(share_of="the stroke", least=1e-6, most=1e5, zero=True)
"""The same if it may also be 0, which leaves the clearance out of the theory."""
