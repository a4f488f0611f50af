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
        bound.unit = unit
        bound.name = name
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
        # see `schema` for the key values
        super().__init__(expected, written=written, schema={"type": "object"})
        self.what = what
        self.tolerated = tolerated

    def figure_of(self, quantity: Quantity) -> Form:
        """Return the form of a figure for a quantity."""
        number = NumberForm(quantity.kind)
        if not self.tolerated:
            return number
        return FigureForm(number)

    def take(self, reading: Reading, value: Node, path: Path) -> object:
        """Read every figure by the form of its quantity."""
        # an empty one, as --set limits={} writes it, takes off those of the file
        if not isinstance(value, dict):
            refused(f"expected {self.expected}, got {_node_or_nothing(value)}")
        quantities = reading.key_values()
        figures: dict[str, object] = {}
        for name, text in value.items():
            # which key value is meant
            scope, symbol, ids = _meant_ids(name, quantities)
            id = ".".join(filter(None, (scope, *ids[:1])))
            fault = ambiguity(symbol, ids) if ids else self._unknown(name, quantities)
            if not fault and quantities[ids[0]].listed:
                fault = f"'{name}' is a list of values; no {self.what} can be put on it"
            if id in figures:
                fault = (
                    f"'{text_in_one_line(name)}' is the symbol of {id}, "
                    "which is given already; leave one of them out"
                )
            if fault:
                reading.fault((*path, name), fault, at_key=True)
                continue
            # its figure
            figure = self.figure_of(quantities[ids[0]]).read(reading, text, (*path, name))
            if isinstance(figure, Expected):
                figure = figure._replace(name=name)
            elif isinstance(figure, float):
                figure = Bound(figure, written_unit(str(text)), name)
            figures[id] = figure
        if has_refused(figures.values()):
            return REFUSED
        return tuple(figures.items())

    def _unknown(self, name: str, quantities: Mapping[str, Quantity]) -> str:
        """Return the message on a name that no key value has, with a likely one or the first few."""
        single = {id: quantity for id, quantity in quantities.items() if not quantity.listed}
        hint = did_you_mean(name, tuple(single)) or in_sentences(name, single.values())
        if not hint:
            hint = f"; known are {', '.join([*quantities][:6])}, …"
        return f"unknown key value '{text_in_one_line(name)}'{hint}"


def _meant_ids(name: str, quantities: Mapping[str, Quantity]) -> tuple[str, str, tuple[str, ...]]:
    """Return the prefix of a name, '' without one, the rest, and the ids that this means.

    Ids are looked up first, with and without a prefix: for symbols all key values are needed.
    """
    scope, rest = scoped(name)
    if name in quantities:
        return "", name, (name,)
    if rest in quantities:
        return scope, rest, (rest,)
    ids = called(name, quantities.values())
    if ids:
        return "", name, ids
    return scope, rest, called(rest, quantities.values())


def _node_or_nothing(value: Node) -> str:
    """Return the description of a value that is no mapping, for messages."""
    if is_nothing(value):
        return "nothing"
    return node_kind(value)


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
        self.tolerance = NumberForm(size.kind, is_difference=True)
        self.absolute = f"{size.example} ± 0.1 {written_unit(size.example)}".rstrip()
        sample = f"{size.example} ± 0.5 %"
        tolerated = f"a figure and its tolerance, such as '{sample}' or '{self.absolute}'"
        super().__init__(f"{tolerated}, or two bounds in a list", sample)

    def take(self, reading: Reading, value: Node, path: Path) -> object:
        """Read a figure with its tolerance, or two bounds."""
        if isinstance(value, list) and len(value) == 2:
            return self._two_bounds(reading, value, path)
        parts = re.split(_PLUS_MINUS, familiar(value)) if isinstance(value, str) else []
        if len(parts) != 2 or not all(parts):
            refused(f"expected {self.expected}, got {node_kind(value)}")
        # the figure; without a unit it has that of the tolerance: 13.16 ± 0.05 m/s2
        figure_text, tolerance_text = parts
        percent = re.fullmatch(_PERCENT, tolerance_text)
        if not written_unit(figure_text) and not percent:
            figure_text = f"{figure_text} {written_unit(tolerance_text)}"
        figure = self.size.read(reading, Plain(figure_text), path)
        if figure is REFUSED:
            return REFUSED
        # the tolerance
        if percent:
            tolerance = float(percent[1]) / 100 * abs(figure)
        else:
            tolerance = self.tolerance.read(reading, Plain(tolerance_text), path)
        if tolerance is REFUSED:
            return REFUSED
        if not tolerance > 0:
            size = "negative" if tolerance else "0"
            refused(f"the tolerance of '{value}' is {size}; write how far off it may be")
        unit = written_unit(figure_text)
        return Expected(figure - tolerance, figure + tolerance, unit, str(value))

    def _two_bounds(self, reading: Reading, bounds: list[Node], path: Path) -> object:
        """Read the smallest and the largest value that meet the expectation."""
        low = self.size.read(reading, bounds[0], (*path, 0))
        high = self.size.read(reading, bounds[1], (*path, 1))
        if low is REFUSED or high is REFUSED:
            return REFUSED
        if low > high:
            refused(
                f"the first bound, {bounds[0]}, is larger than the second, {bounds[1]}; "
                "exchange them"
            )
        return Expected(low, high, written_unit(str(bounds[0])), f"{bounds[0]} to {bounds[1]}")


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
            refused(f"expected {self.expected}, got {_node_or_nothing(value)}")
        if not self.spreads:
            return tuple(value.items())
        spreads: dict[str, object] = {}
        for name, node in value.items():
            spread = ""
            if isinstance(node, str) and len(node) <= LONGEST_VALUE:
                spread = spread_text(node)
            if spread:
                spreads[name] = spread
                continue
            expected = f"expected a standard uncertainty above 0, such as {_SPREADS}"
            spreads[name] = reading.fault((*path, name), f"{expected}, got {node_kind(node)}")
        if has_refused(spreads.values()):
            return REFUSED
        return tuple(spreads.items())


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
    spread = re.sub(r"(±|\+/-|\+-)\s*", "", keyboard_text(text).strip(), count=1)
    number = NUMBER.match(spread)
    is_above_zero = number is not None and float(number.group()) > 0
    return spread if is_above_zero else ""
