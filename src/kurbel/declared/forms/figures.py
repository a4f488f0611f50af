"""Forms of limits and expectations of key values, and of uncertainties and settings of keys by their dotted names."""

import re
from collections.abc import Mapping
from typing import NamedTuple

from kurbel.declared.forms.values import Form, NumberForm
from kurbel.declared.numerals import NUMBER, familiar, keyboard_text
from kurbel.declared.reading import (
    LONGEST_VALUE,
    REFUSED,
    Node,
    Plain,
    Reading,
    has_refused,
    is_nothing,
    node_kind,
    text_in_one_line,
)
from kurbel.declared.units import written_unit
from kurbel.errors import Path, refused
from kurbel.near_words import did_you_mean
from kurbel.quantity import Quantity, ambiguity, called, in_sentences


class Bound(float):
    """A bound in the base of its kind, with its unit and the name of its key value as written in the file."""

    __slots__ = ("name", "unit")
    unit: str
    name: str

    def __new__(cls, value: float, unit: str = "", name: str = "") -> "Bound":
        bound = super().__new__(cls, value)
        bound.unit, bound.name = unit, name
        return bound


class Expected(NamedTuple):
    """The smallest and the largest value that meet an expectation, in the base; unit, text and name as written."""

    low: float
    high: float
    unit: str = ""
    text: str = ""
    name: str = ""


MACHINE = "machine"
"""Prefix of a key value of the whole machine, as the name of a cylinder is of its own: `machine.T_max`."""


def scoped(name: str) -> tuple[str, str]:
    """Return the prefix of the name of a key value, '' if it has none, and its id.

    >>> scoped("machine.T_max"), scoped("No. 1.c_max"), scoped("c_max")
    (('machine', 'T_max'), ('No. 1', 'c_max'), ('', 'c_max'))
    """
    scope, _, id = name.rpartition(".")
    return scope, id


class Figures(Form):
    """A mapping from key values, by id or printed symbol, to a figure each; becomes pairs of id and Bound or Expected.

    The id may have a prefix: `machine.T_max`, or the name of a cylinder. what: the word for such a figure in messages;
    tolerated: figures with a tolerance.
    """

    shape = dict

    def __init__(self, expected: str, written: str, what: str, tolerated: bool = False) -> None:
        super().__init__(
            expected, written=written, schema={"type": "object"}
        )  # see `schema` for the key values
        self.what, self.tolerated = what, tolerated

    def figure_of(self, quantity: Quantity) -> Form:
        """Return the form of a figure for a quantity."""
        number = NumberForm(quantity.kind)
        return FigureForm(number) if self.tolerated else number

    def take(self, reading: Reading, value: Node, path: Path) -> object:
        """Read every figure by the form of its quantity."""
        if not isinstance(
            value, dict
        ):  # an empty one, as --set limits={} writes it, takes off those of the file
            refused(
                f"expected {self.expected}, got {'nothing' if is_nothing(value) else node_kind(value)}"
            )
        known = reading.key_values()
        found: dict[str, object] = {}
        for name, written in value.items():
            scope, own, ids = _meant(name, known)
            wrong = ambiguity(own, ids) if ids else self._unknown(name, known)
            id = ".".join(filter(None, (scope, *ids[:1])))
            if not wrong and known[ids[0]].listed:
                wrong = f"'{name}' is a list of values; no {self.what} can be put on it"
            if id in found:
                wrong = f"'{text_in_one_line(name)}' is the symbol of {id}, which is given already; leave one of them out"
            if wrong:
                reading.fault((*path, name), wrong, at_key=True)
                continue
            figure = self.figure_of(known[ids[0]]).read(reading, written, (*path, name))
            if isinstance(figure, Expected):
                figure = figure._replace(name=name)
            found[id] = (
                Bound(figure, written_unit(str(written)), name)
                if isinstance(figure, float)
                else figure
            )
        return REFUSED if has_refused(found.values()) else tuple(found.items())

    def _unknown(self, name: str, known: Mapping[str, Quantity]) -> str:
        single = {id: one for id, one in known.items() if not one.listed}
        hint = did_you_mean(name, tuple(single)) or in_sentences(name, single.values())
        some = f"; known are {', '.join([*known][:6])}, …"
        return f"unknown key value '{text_in_one_line(name)}'{hint or some}"


def _meant(name: str, known: Mapping[str, Quantity]) -> tuple[str, str, tuple[str, ...]]:
    """Return the prefix of a name, '' without one, the rest, and the ids that this means.

    Ids are looked up first, with and without a prefix: for symbols all key values are needed.
    """
    scope, own = scoped(name)
    if name in known:
        return "", name, (name,)
    if own in known:
        return scope, own, (own,)
    ids = called(name, known.values())
    return ("", name, ids) if ids else (scope, own, called(own, known.values()))


LIMITS = Figures(
    "a mapping of key values to bounds, such as 'c_max: 6 m/s'", "`{key value: bound}`", "bound"
)
EXPECTATIONS = Figures(
    "a mapping of key values to figures, such as 'b_max: 13.16 m/s2 ± 0.5 %'",
    "`{key value: figure ± tolerance}`, or two bounds `[least, most]`",
    "expectation",
    tolerated=True,
)

_PLUS_MINUS = r"\s*(?:±|\+\s*/?\s*-)\s*"
_PERCENT = rf"({NUMBER.pattern})\s*%"


class FigureForm(Form):
    """A figure with its tolerance, such as `13.16 m/s2 ± 0.5 %`, or a list of two bounds; becomes an Expected."""

    def __init__(self, size: NumberForm) -> None:
        self.size = size
        self.absolute = f"{size.example} ± 0.1 {written_unit(size.example)}".rstrip()
        sample = f"{size.example} ± 0.5 %"
        either = f"a figure and its tolerance, such as '{sample}' or '{self.absolute}'"
        super().__init__(f"{either}, or two bounds in a list", sample)

    def take(self, reading: Reading, value: Node, path: Path) -> object:
        """Read a figure with its tolerance, or two bounds."""
        if isinstance(value, list) and len(value) == 2:
            low, high = (
                self.size.read(reading, one, (*path, index)) for index, one in enumerate(value)
            )
            if low is REFUSED or high is REFUSED:
                return REFUSED
            if low > high:
                refused(
                    f"the first bound, {value[0]}, is larger than the second, {value[1]}; exchange them"
                )
            return Expected(low, high, written_unit(str(value[0])), f"{value[0]} to {value[1]}")
        parts = re.split(_PLUS_MINUS, familiar(value)) if isinstance(value, str) else []
        if len(parts) != 2 or not all(parts):
            refused(f"expected {self.expected}, got {node_kind(value)}")
        figure, tolerance = parts
        percent = re.fullmatch(_PERCENT, tolerance)
        if not written_unit(figure) and not percent:
            figure = f"{figure} {written_unit(tolerance)}"  # 13.16 ± 0.05 m/s2
        middle = self.size.read(reading, Plain(figure), path)
        around = (
            1.0 if percent or middle is REFUSED else self.size.read(reading, Plain(tolerance), path)
        )
        if middle is REFUSED or around is REFUSED:
            return REFUSED
        if percent:
            around = float(percent[1]) / 100 * abs(middle)
        if not around > 0:
            refused(
                f"the tolerance of '{value}' is {'0' if not around else 'negative'}; write how far off it may be"
            )
        return Expected(middle - around, middle + around, written_unit(figure), str(value))


_SPREADS = "'bore: ± 0.2 mm' or 'masses.piston: ± 2 %'"


class ByKey(Form):
    """A mapping from dotted keys to texts; becomes pairs of them. spreads: they are standard uncertainties."""

    shape = dict

    def __init__(self, expected: str, spreads: bool = False) -> None:
        values = {"additionalProperties": {"type": ["string", "number"]}} if spreads else {}
        super().__init__(expected, schema={"type": "object", "minProperties": 1, **values})
        self.spreads = spreads

    def take(self, reading: Reading, value: Node, path: Path) -> object:
        """Read uncertainties; the values of a load case are read when they replace those of the file."""
        if not isinstance(value, dict) or not value:
            refused(
                f"expected {self.expected}, got {'nothing' if is_nothing(value) else node_kind(value)}"
            )
        if not self.spreads:
            return tuple(value.items())
        found: dict[str, object] = {}
        for name, one in value.items():
            short = isinstance(one, str) and len(one) <= LONGEST_VALUE
            wrong = (
                f"expected a standard uncertainty above 0, such as {_SPREADS}, got {node_kind(one)}"
            )
            found[name] = (short and spread_text(str(one))) or reading.fault((*path, name), wrong)
        return REFUSED if has_refused(found.values()) else tuple(found.items())


UNCERTAINTIES = ByKey(
    f"a mapping of keys to standard uncertainties, such as {_SPREADS}", spreads=True
)
SETTINGS = ByKey(
    "a mapping of dotted keys to values, such as 'speed: 60 rpm' or 'cylinders.0.bore: 450 mm'"
)


def spread_text(text: str) -> str:
    """Return the number with its unit, or percent, after `±`; '' for what is none above 0.

    >>> spread_text("± 0.2 mm"), spread_text("+-2 %"), spread_text("±-1 mm")
    ('0.2 mm', '2 %', '')
    """
    rest = re.sub(r"(±|\+/-|\+-)\s*", "", keyboard_text(text).strip(), count=1)
    number = NUMBER.match(rest)
    return rest if number and float(number.group()) > 0 else ""
