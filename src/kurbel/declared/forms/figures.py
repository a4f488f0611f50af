"""Forms of what key values are held against: bounds, and expected figures with their tolerance."""

import re
from abc import abstractmethod
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from kurbel.declared.forms.values import Number, Physical
from kurbel.declared.keys import Form, Schema
from kurbel.declared.numerals import NUMBER, familiar
from kurbel.declared.reading import REFUSED, Plain, Reading, is_nothing, kind_of, shown
from kurbel.declared.units import written_unit
from kurbel.errors import Path, refused
from kurbel.near_words import did_you_mean
from kurbel.quantity import Quantity, ambiguity, called


class Bound(float):
    """A bound in the base of its kind, which keeps the unit, and the name of its key value, as they were written."""

    __slots__ = ("name", "unit")
    unit: str
    name: str

    def __new__(cls, value: float, unit: str = "", name: str = "") -> "Bound":
        bound = super().__new__(cls, value)
        bound.unit, bound.name = unit, name
        return bound


@dataclass(frozen=True, eq=False)
class Expected:
    """The smallest and the largest value that meet an expectation, in the base; unit, text and name as written."""

    low: float
    high: float
    unit: str = ""
    text: str = ""
    name: str = ""


MACHINE = "machine"
"""What stands before the id of a key value of the whole machine, as the name of a cylinder before one of its own."""


def scoped(name: str) -> tuple[str, str]:
    """Return whose key value a name is, '' where it is not said, and its id.

    >>> scoped("machine.T_max"), scoped("No. 1.c_max"), scoped("c_max")
    (('machine', 'T_max'), ('No. 1', 'c_max'), ('', 'c_max'))
    """
    scope, _, id = name.rpartition(".")
    return scope, id


class _Figures(Form):
    """A mapping from key values, by id or printed symbol, to a figure each; becomes pairs of id and figure.

    Before the id may stand whose it is: `machine.T_max`, or the name of a cylinder.
    """

    shape = dict
    what: str
    """What is put on a key value, for messages."""

    @abstractmethod
    def figure(self, size: Number | Physical) -> Form:
        """Return the form of a figure for a quantity of which values have this form."""

    @abstractmethod
    def named(self, figure: Any, written: Any, name: str) -> Any:
        """Return a figure with what it was written as, and the name that it stands under."""

    def _figure_of(self, quantity: Quantity) -> Form:
        return self.figure(Number() if quantity.kind == "ratio" else Physical(quantity.kind))

    def schema(self, definitions: Schema) -> Schema:
        return {"type": "object"}  # what reads machine files knows the key values: see `schema_of`

    def schema_of(self, known: Mapping[str, Quantity], definitions: Schema) -> Schema:
        """Return the schema of a mapping from these key values, by id."""
        # a symbol of several, or of one and the id of another, names none
        named = Counter(name for one in known.values() for name in {one.id, one.symbol, one.ascii_symbol})
        properties = {
            name: {**self._figure_of(quantity).schema(definitions), "description": quantity.text}
            for id, quantity in known.items()
            for name in (id, quantity.symbol, quantity.ascii_symbol)
            if not quantity.listed and (name == id or named[name] == 1)
        }
        # the same below a scope: of those of one form one pattern
        forms: dict[str, Schema] = {}
        names: dict[str, list[str]] = {}
        for name, schema in properties.items():
            form = {key: value for key, value in schema.items() if key != "description"}
            forms.setdefault(repr(form), form)
            names.setdefault(repr(form), []).append(re.sub(r"[][\\^$.|?*+(){}/]", r"\\\g<0>", name))
        patterns = {f"^.+\\.({'|'.join(names[form])})$": schema for form, schema in forms.items()}
        return {
            "type": "object",
            "additionalProperties": False,
            "properties": properties,
            "patternProperties": patterns,
        }

    def take(self, reading: Reading, value: Any, path: Path) -> Any:
        """Read every figure by the form of its quantity."""
        if not isinstance(value, dict):  # an empty one, as --set limits={} writes it, takes off those of the file
            refused(f"expected {self.expected()}, got {'nothing' if is_nothing(value) else kind_of(value)}")
        known = reading.key_values()
        found: dict[str, Any] = {}
        for name, figure in value.items():
            id, wrong = self._meant(name, known)
            if id in found:
                wrong = f"'{shown(name)}' is the symbol of {id}, which is given already; leave one of them out"
            if wrong:
                reading.fault((*path, name), wrong, at_key=True)
            else:
                read = self._figure_of(known[scoped(id)[1]]).read(reading, figure, (*path, name))
                found[id] = read if read is REFUSED else self.named(read, figure, name)
        return REFUSED if any(one is REFUSED for one in found.values()) else tuple(found.items())

    def _meant(self, name: str, known: Mapping[str, Quantity]) -> tuple[str, str]:
        """Return the id that a name stands for, with whose it is before it, and what is wrong with it."""
        found = called(name, known.values())
        scope, own = scoped(name)
        if scope and not found and called(own, known.values()):
            id, wrong = self._meant(own, known)
            return f"{scope}.{id}", wrong
        if not found:
            hint = did_you_mean(name, tuple(id for id, one in known.items() if not one.listed))
            some = f"; known are {', '.join([*known][:6])}, …"
            return "", f"unknown key value '{shown(name)}'{hint or some}"
        wrong = f"'{name}' is a list of values; no {self.what} can be put on it" if known[found[0]].listed else ""
        return found[0], ambiguity(name, found) or wrong


class Limits(_Figures):
    """A mapping from key values to bounds; becomes pairs of id and Bound."""

    what = "bound"

    def figure(self, size: Number | Physical) -> Form:
        return size

    def named(self, figure: Any, written: Any, name: str) -> Bound:
        return Bound(figure, written_unit(written), name)

    def expected(self) -> str:
        return "a mapping of key values to bounds, such as 'c_max: 6 m/s'"

    def written(self) -> str:
        return "`{key value: bound}`"


class Expectations(_Figures):
    """A mapping from key values to figures with a tolerance; becomes pairs of id and Expected."""

    what = "expectation"

    def figure(self, size: Number | Physical) -> Form:
        return _Figure(size)

    def named(self, figure: Expected, written: Any, name: str) -> Expected:
        return replace(figure, name=name)

    def expected(self) -> str:
        return "a mapping of key values to figures, such as 'b_max: 13.16 m/s2 ± 0.5 %'"

    def written(self) -> str:
        return "`{key value: figure ± tolerance}`, or two bounds `[least, most]`"


_PLUS_MINUS = r"\s*(?:±|\+\s*/?\s*-)\s*"
_PERCENT = rf"({NUMBER.pattern})\s*%"


class _Figure(Form):
    """A figure with its tolerance, such as `13.16 m/s2 ± 0.5 %`, or a list of two bounds; becomes an Expected."""

    def __init__(self, size: Number | Physical) -> None:
        self.size = size

    def expected(self) -> str:
        return (
            f"a figure and its tolerance, such as '{self.example()}' or '{self._absolute()}', or two bounds in a list"
        )

    def example(self) -> str:
        return f"{self.size.example()} ± 0.5 %"

    def _absolute(self) -> str:
        return f"{self.size.example()} ± 0.1 {written_unit(self.size.example())}".rstrip()

    def schema(self, definitions: Schema) -> Schema:
        name = f"figure_{self.size.kind}"
        definitions[name] = {
            "anyOf": [
                {"type": "string", "pattern": r"^[^±]*[0-9][^±]*(±|\+\s*/?\s*-)\s*[0-9.][^±]*$"},
                {"type": "array", "items": self.size.schema(definitions), "minItems": 2, "maxItems": 2},
            ],
            "errorMessage": f"write {self.expected()}",
            "examples": [self.example(), self._absolute()],
        }
        return {"allOf": [{"$ref": f"#/definitions/{name}"}]}

    def take(self, reading: Reading, value: Any, path: Path) -> Any:
        """Read a figure with its tolerance, or two bounds."""
        if isinstance(value, list) and len(value) == 2:
            low, high = (self.size.read(reading, one, (*path, index)) for index, one in enumerate(value))
            return self._between(low, high, value)
        parts = re.split(_PLUS_MINUS, familiar(value)) if isinstance(value, str) else []
        if len(parts) != 2 or not all(parts):
            refused(f"expected {self.expected()}, got {kind_of(value)}")
        figure, tolerance = parts
        if not written_unit(figure) and not re.fullmatch(_PERCENT, tolerance):
            figure = f"{figure} {written_unit(tolerance)}"  # 13.16 ± 0.05 m/s2
        middle = self.size.read(reading, Plain(figure), path)
        around = REFUSED if middle is REFUSED else self._around(reading, tolerance, middle, path)
        if around is REFUSED:
            return REFUSED
        if not around > 0:
            refused(f"the tolerance of '{value}' is {'0' if not around else 'negative'}; write how far off it may be")
        return Expected(middle - around, middle + around, written_unit(figure), value)

    def _around(self, reading: Reading, tolerance: str, middle: float, path: Path) -> Any:
        """Return the tolerance in the base; one in percent is a share of the figure."""
        share = re.fullmatch(_PERCENT, tolerance)
        if share:
            return float(share[1]) / 100 * abs(middle)
        return self.size.read(reading, Plain(tolerance), path)

    def _between(self, low: Any, high: Any, value: list[str]) -> Any:
        if low is REFUSED or high is REFUSED:
            return REFUSED
        if low > high:
            refused(f"the first bound, {value[0]}, is larger than the second, {value[1]}; exchange them")
        return Expected(low, high, written_unit(value[0]), f"{value[0]} to {value[1]}")
