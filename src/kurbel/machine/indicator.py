"""Indicator cards: pressure over the stroke, as an indicator draws it in each chamber from its own dead centre."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import reduce
from itertools import chain
from typing import TYPE_CHECKING, Any, ClassVar, Union

import numpy as np

from kurbel.arrays import Number
from kurbel.declared.forms.figures import Bound
from kurbel.declared.forms.structures import Keyed, OneOf, RecordForm
from kurbel.declared.forms.values import (
    CLEARANCE_OR_NONE,
    Choice,
    NumberForm,
    Ordinates,
    Points,
    order_faults,
    size_faults,
    unit_name,
)
from kurbel.declared.record import Record, Rule, ValuesByKey, alternative, field
from kurbel.declared.unit_systems import show
from kurbel.declared.units import DiagramPoint, UnitFactor, written_unit
from kurbel.errors import Fault, refuse
from kurbel.machine.chamber import StrokeCard
from kurbel.numerics.arithmetic import some

if TYPE_CHECKING:
    from kurbel.machine.ideal_cards import Compressor, Diesel, IdealCard, Otto, Steam
    from kurbel.machine.measured import Measured
    from kurbel.machine.wiebe import Wiebe
    from kurbel.traces.correct import Trace


@dataclass(frozen=True, eq=False)
class Rectangle(StrokeCard):
    """A card of horizontal lines, for any working cycle; pressures in Pa.

    level: the pressure on every stroke, None for the ambient; mean: the mean indicated pressure p_i, by which the
    expansion line of a driving chamber (or, if negative, the compression line of a driven one) differs from it. doubts: on
    what it was measured from; notes: remarks for the user.
    """

    level: float | None = None
    mean: float = 0.0
    doubts: tuple[str, ...] = ()

    cycles: ClassVar[tuple[str, ...]] = ("two-stroke", "four-stroke")
    clearance: ClassVar[None] = None
    """Lines of constant pressure need no clearance volume."""

    @property
    def notes(self) -> tuple[str, ...]:
        """That such a card has the correct work, but not the true pressures."""
        if not self.mean:
            return self.doubts
        mean = show(self.mean, "pressure")
        return (
            *self.doubts,
            f"a rectangular card of the mean pressure {mean} replaces the true one: "
            "work and power are correct, forces over the angle are not",
        )

    def rules_in(self, cycle: str, lift: Number) -> Iterator[Rule]:
        """Yield the rule that no pressure is below the vacuum; lift: added to make pressures absolute, in Pa."""
        if self.level is not None:
            message = "{level:pressure} is below the vacuum, which is at {vacuum:pressure}"
            numbers = {"level": self.level, "vacuum": 0.0 - lift}
            yield Rule((), self.level + lift < 0, message, numbers)


class Drawn(Record):
    """The paper of a card: its length, and the scale of the spring in m/Pa.

    Points are in millimetres, or in inches where the length is.
    """

    length: float = field(
        # keeps the unit in which it is written, so that the lengths of many cards are read one by one
        NumberForm(
            "length",
            above=0,
            becomes=lambda length, text: Bound(length, written_unit(text)),
            apart=True,
        ),
        "Length of the card on the paper",
        "l",
    )
    spring: float = field(
        "spring", "Scale of the spring: height on the paper over pressure", above=0
    )

    @property
    def scales(self) -> tuple[str, UnitFactor, float]:
        """The unit of the points, what turns heights above the atmospheric line into Pa, the length in that unit."""
        if isinstance(self.length, Bound) and self.length.unit.startswith("in"):
            return "in", (254.0, 1e4 * self.spring), round(self.length * 1e4 / 254, 9)
        return "mm", (1.0, 1e3 * self.spring), round(1e3 * self.length, 9)


_POINTS = Points("stroke fraction", "pressure", ratio=True)


@dataclass(frozen=True, eq=False)
class CardLine:
    """One line of a card: pressures in Pa over fractions of the chamber's stroke, in the order of the process.

    Two points at one fraction are a vertical jump. `start` is the fraction at which the line begins, 0 or 1.
    """

    name: str
    fractions: tuple[float, ...]
    pressures: tuple[float, ...]
    start: int


STROKES = {
    "two-stroke": ("expansion", "compression"),
    "four-stroke": ("expansion", "exhaust", "intake", "compression"),
}
"""Cycle -> the lines of a card from the chamber's (firing) dead centre on; the volume grows along every other one."""


class Card(StrokeCard, Record):
    """A card: its lines in the order of the process from the smallest volume on, and how to join their points.

    interpolate: `linear`, or `polytropic`: straight in log p over log V, which needs the clearance volume over
    the stroke volume. `notes`: what was corrected; drawn: whether its points count from an atmospheric line.
    """

    _unit = alternative(
        unit_name("pressure"),
        "Unit of the pressures; or give `drawn`",
        required=True,
        example="bar",
    )
    _drawn = alternative(
        Drawn,
        "The paper of the card: all points are then millimetres, or inches where its length is, from the card's own "
        "dead centre and from the atmospheric line",
        instead="unit",
    )
    _area = alternative(
        "area",
        "Area by planimeter, instead of the lines of a drawn card",
        least=0,
        needs="drawn",
    )
    _mean_height = alternative(
        "length",
        "Mean height by planimeter, instead of the lines of a drawn card",
        least=0,
        instead="area",
        needs="drawn",
    )
    _ordinates = alternative(
        Ordinates(),
        "Heights between its lines in the middle of equal strips of the card, as bare numbers in the unit of its "
        "length; their mean over the spring is p_i",
        instead="area",
        needs="drawn",
        also=("mid_ordinates", "midordinates", "mean_ordinates", "heights"),
    )
    _expansion = alternative(_POINTS, "Line while the burnt or admitted gas expands")
    _compression = alternative(_POINTS, "Line while the chamber is compressed or empties")
    _intake = alternative(_POINTS, "Suction line of a four-stroke cycle")
    _exhaust = alternative(_POINTS, "Exhaust line of a four-stroke cycle")
    lines: tuple[CardLine, ...] = ()
    interpolate: str = field(
        ("linear", "polytropic"), "How points are joined", default="linear", absent="linear"
    )
    clearance: float | None = field(
        CLEARANCE_OR_NONE,
        "Clearance over stroke volume, for `polytropic`",
        absent="not known",
        example="0.08",
    )
    notes: tuple[str, ...] = ()
    drawn: bool = False

    @classmethod
    def rules_of_keys(cls, values: ValuesByKey) -> Iterator[Rule]:
        """Yield that the mean height is given twice."""
        is_given_twice = "mean_height" in values and "ordinates" in values
        message = "'mean_height' and 'ordinates' mean the same; give only one of them"
        yield Rule("ordinates", is_given_twice, message)

    @classmethod
    def of_keys(
        cls,
        unit: UnitFactor | None = None,
        drawn: Drawn | None = None,
        interpolate: str = "linear",
        clearance: float | None = None,
        **lines: Any,
    ) -> Card | Rectangle:
        """Return the card that these keys of a machine file describe; raises RuleError with every fault.

        lines: points by the name of the line, and what a planimeter measured.
        """
        measured = {name: lines.pop(name) for name in _OF_HEIGHTS if name in lines}
        if drawn and measured:
            message = "the lines have an area of their own; leave out the one by planimeter"
            if "ordinates" in measured:
                message = "the lines have a mean height of their own; leave out the ordinates"
            refuse(*(Fault((name,), message) for name in lines))
            # p_i = a/(l · spring)
            height: float = measured.get("mean_height", 0.0)
            doubts: tuple[str, ...] = ()
            if "area" in measured:
                height = measured["area"] / drawn.length
            if "ordinates" in measured:
                height, doubts = _mean_ordinate(measured["ordinates"], drawn)
            return Rectangle(mean=height / drawn.spring, doubts=doubts)

        # missing or faulty lines
        paper_unit, factor, stroke = drawn.scales if drawn else ("", unit or (1, 1), 1.0)
        cycle = "four-stroke" if {"intake", "exhaust"} & lines.keys() else "two-stroke"
        faults = []
        for name in STROKES[cycle]:
            if name not in lines:
                faults.append(Fault((), f"the '{name}' line of the {cycle} card is missing"))
        if interpolate == "polytropic" and not clearance:
            message = (
                "'polytropic' needs the 'clearance' volume over the stroke volume, more than 0"
            )
            faults.append(Fault(("interpolate",), message))
        for name, points in lines.items():
            line_faults = _line_faults(points, stroke, paper_unit)
            line_faults += size_faults(points, factor, "pressure")
            faults += (fault.below((name,)) for fault in line_faults)
        refuse(*faults)

        # the lines, in Pa over fractions of the stroke
        card_lines = []
        notes = []
        for start, name in zip((0, 1, 0, 1), STROKES[cycle]):
            points = lines[name]
            different = _in_order(points, start)
            if len(different) < len(points):
                notes.append(f"{name}: a point given twice counts once")
            multiplier, divisor = factor
            fractions = tuple(x / stroke for x, _ in different)
            pressures = tuple(p * multiplier / divisor for _, p in different)
            card_lines.append(CardLine(name, fractions, pressures, start))
        return cls(tuple(card_lines), interpolate, clearance, tuple(notes), drawn is not None)

    @property
    def flat(self) -> bool:
        """Whether each line is one pressure, as those of an ideal pump."""
        for line in self.lines:
            first = line.pressures[0]
            if not all(np.array_equal(pressure, first) for pressure in line.pressures):
                return False
        return True

    @property
    def cycles(self) -> tuple[str, ...]:
        """The one cycle that has so many lines."""
        return tuple(cycle for cycle, lines in STROKES.items() if len(lines) == len(self.lines))

    def rules_in(self, cycle: str, lift: Number) -> Iterator[Rule]:
        """Yield what does not fit the cycle of the machine, or what no polytropic line can be drawn through."""
        # the lines of the cycle
        names = STROKES[cycle]
        count = len(self.lines)
        message = f"a {cycle} cycle needs the lines {', '.join(names)}; this card has {count} lines"
        yield Rule((), count != len(names), message)
        # the vacuum
        lowest = reduce(np.minimum, chain(*(line.pressures for line in self.lines)))
        numbers = {"lowest": lowest, "vacuum": 0.0 - lift}
        if self.interpolate == "polytropic":
            message = (
                "{lowest:pressure} is not above the vacuum, as p V^n needs; "
                "write 'interpolate: linear'"
            )
            yield Rule((), lowest + lift <= 0, message, numbers)
        else:
            message = "{lowest:pressure} is below the vacuum, which is at {vacuum:pressure}"
            yield Rule((), lowest + lift < 0, message, numbers)


_OF_HEIGHTS = ("area", "mean_height", "ordinates")
"""Keys of a drawn card that give its mean height instead of its lines."""


def _mean_ordinate(ordinates: tuple[float, ...], drawn: Drawn) -> tuple[float, tuple[str, ...]]:
    """Return the mean of mid-ordinates in m, and what is doubtful about them; raises RuleError."""
    unit, _, length = drawn.scales
    for index, height in enumerate(ordinates):
        if abs(height) > length:
            message = (
                f"{height:g} {unit} is more than the card is long ({length:g} {unit}); heights are "
                "in the unit of its length"
            )
            refuse(Fault(("ordinates", index), message))
    doubts: tuple[str, ...] = ()
    if ordinates[0] == 0 == ordinates[-1] and any(ordinates):
        doubts = (
            "the first and the last ordinate are 0: are they at the ends of the card? Mid-ordinates are "
            "in the middle of equal strips",
        )
    mean = math.fsum(ordinates) / len(ordinates)
    metres = 0.0254 if unit == "in" else 1e-3
    return mean * metres, doubts


def _in_order(points: list[DiagramPoint], start: int) -> list[DiagramPoint]:
    """Return the points of a line in the order of the process, equal neighbours once; start: 0 or 1, where it begins."""
    begins_at_zero = points[0][0] <= points[-1][0]
    if begins_at_zero != (start == 0):
        points = points[::-1]
    different = points[:1]
    for point in points[1:]:
        if point != different[-1]:
            different.append(point)
    return different


def _line_faults(points: list[DiagramPoint], stroke: float, unit: str) -> list[Fault]:
    """Return the first fault of a line that does not run once through the whole stroke.

    stroke: its length in a unit of the paper; 1 with '' for fractions of it.
    """
    # points beyond the stroke
    beyond = [index for index, (x, _) in enumerate(points) if not 0 <= x <= stroke]
    if beyond:
        x, _ = points[beyond[0]]
        if unit:
            message = (
                f"{x:g} {unit} is not on the card, which is {stroke:g} {unit} long; "
                "its own dead centre is at 0"
            )
        else:
            is_percent = 1 < x <= 100 and len(beyond) > 1
            hint = f"; write {x / 100:g} here if the line is in percent" if is_percent else ""
            message = f"{x:g} is no fraction of the stroke; fractions run from 0 to 1{hint}"
        return [Fault((beyond[0],), message)]
    # the ends of the line
    low, high = sorted((points[0][0], points[-1][0]))
    of_unit = f" {unit}" if unit else ""
    if (low, high) == (0.0, stroke):
        format = f"{{:g}}{of_unit}" if unit else "fraction {:g}"
        return order_faults(points, format)
    message = (
        f"the line must reach from 0 to {stroke:g}{of_unit}; "
        f"it runs from {low:g} to {high:g}{of_unit}; "
        "0 is this chamber's own dead centre, where it is smallest"
    )
    return [Fault((), message)]


class Constant(Record):
    """Constant pressure on each stroke: an ideal pump."""

    expansion: float = field("pressure", "Pressure while the chamber grows: suction")
    compression: float = field("pressure", "Pressure while the chamber shrinks: delivery")
    clearance: float | None = field(
        CLEARANCE_OR_NONE,
        "Clearance over stroke volume, for the `bulk_modulus` of the liquid",
        absent="not known, 0 for a compressible liquid",
        example="0.5",
    )

    @classmethod
    def of_keys(cls, expansion: float, compression: float, clearance: float | None = None) -> Card:
        """Return the card with two horizontal lines."""
        suction = CardLine("expansion", (0.0, 1.0), (expansion, expansion), 0)
        delivery = CardLine("compression", (1.0, 0.0), (compression, compression), 1)
        return Card((suction, delivery), clearance=clearance)


def _measured() -> type[Measured]:
    from kurbel.machine.measured import Measured

    return Measured


def _steam() -> type[Steam]:
    from kurbel.machine.ideal_cards import Steam

    return Steam


def _compressor() -> type[Compressor]:
    from kurbel.machine.ideal_cards import Compressor

    return Compressor


def _otto() -> type[Otto]:
    from kurbel.machine.ideal_cards import Otto

    return Otto


def _diesel() -> type[Diesel]:
    from kurbel.machine.ideal_cards import Diesel

    return Diesel


def _wiebe() -> type[Wiebe]:
    from kurbel.machine.wiebe import Wiebe

    return Wiebe


_CHAMBER = Keyed(
    cases={
        "mean_pressure": NumberForm(
            "pressure", becomes=lambda pressure, _: Rectangle(mean=pressure)
        ),
        "constant": RecordForm(Constant),
        "trace": RecordForm(_measured),
        "steam": RecordForm(_steam),
        "compressor": RecordForm(_compressor),
        "otto": RecordForm(_otto),
        "diesel": RecordForm(_diesel),
        "wiebe": RecordForm(_wiebe),
    },
    otherwise=RecordForm(Card),
    beside=("diagram_factor", "unloaded"),
    texts={
        "mean_pressure": "Indicated mean pressure instead of a card: work and power are correct, forces are not"
    },
)
_ONE_PRESSURE = NumberForm(
    "pressure",
    or_else=", or a card below it",
    becomes=lambda pressure, _: Rectangle(level=pressure),
)
Chamber = Union[Rectangle, Card, "IdealCard", "Wiebe", "Trace"]
"""The pressure in one end of a cylinder; each has `cycles`, of which it can be part, `clearance`, and `rules_in`."""


def levels_of_strokes(chamber: Chamber | None) -> list[Number] | None:
    """Return the pressures in Pa that a chamber has, each on a whole stroke; of the ambient none; else None."""
    if isinstance(chamber, Rectangle):
        if some(chamber.mean != 0):
            return None
        if chamber.level is None:
            return []
        return [chamber.level]
    if not isinstance(chamber, Card):
        return None
    levels = list[Number]()
    for line in chamber.lines:
        first = line.pressures[0]
        if not all(np.array_equal(pressure, first) for pressure in line.pressures):
            return None
        levels.append(first)
    return levels


def _mirrored(values: ValuesByKey) -> dict[str, object]:
    """Return the crank end that has the card of the head end, its valves at work; nothing if it is not `mirrored`.

    The fractions of each chamber count from its own dead centre, so that it is the same card.
    """
    if values["crank_end"] != "mirrored":
        return {}
    head_end = values.get("head_end")
    return {"crank_end": None if head_end is None else head_end.loaded()}


class Indicator(Record):
    """The pressures in the two ends of a cylinder; an end that is None is open to the ambient.

    absolute: the pressures of both ends are absolute, not gauge.
    """

    _pressures = alternative(
        ("gauge", "absolute"),
        "Reference of the pressures, also for `p_head`, `p_crank` and `p_max` where they are printed, requested or "
        "limited",
        absent="gauge",
        gives=lambda values: {"absolute": values["pressures"] == "absolute"},
    )
    head_end: Chamber | None = field(
        OneOf(_ONE_PRESSURE, _CHAMBER),
        "Pressure at the head end: one for all strokes, or a card",
        absent="open to the ambient",
    )
    crank_end: Chamber | None = field(
        OneOf(Choice(("mirrored",)), _ONE_PRESSURE, _CHAMBER),
        "Pressure at the crank end, with a card measured from its own (outer) dead centre; or `mirrored`: the card "
        "of the head end",
        absent="open to the ambient",
        gives=_mirrored,
    )
    role: str | None = field(
        ("engine", "compressor", "pump", "steam"),
        "What the cylinder is, by which a measured trace is judged",
        absent="by cycle and shape of the trace",
    )
    absolute: bool = False

    @classmethod
    def rules_of_keys(cls, values: ValuesByKey) -> Iterator[Rule]:
        # an end without a pressure
        is_mirrored = values.get("crank_end") == "mirrored"
        has_crank_end = "crank_end" in values and not is_mirrored
        is_empty = "head_end" not in values and not has_crank_end
        message = "the indicator shows no pressure; give 'head_end'"
        yield Rule("crank_end" if is_mirrored else (), is_empty, message)
        # drawn cards are gauge
        if values.get("pressures") != "absolute":
            return
        for end in ("head_end", "crank_end"):
            card = values.get(end)
            is_drawn = isinstance(card, Card) and card.drawn
            message = "a drawn card counts from the atmospheric line; write 'pressures: gauge'"
            yield Rule((end, "drawn"), is_drawn, message)
