"""Form of a list of pairs, `[[x, y], …]`, read quickly enough for a measurement of 1e5 of them."""

import re
from typing import Any

from kurbel.declared.keys import Form, Schema
from kurbel.declared.kinds import MOST_POINTS
from kurbel.declared.numerals import parse_number, parse_ratio
from kurbel.declared.reading import LONGEST_VALUE, REFUSED, Plain, Reading, is_nothing, kind_of, shown
from kurbel.errors import Path, UnitError, refused

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
