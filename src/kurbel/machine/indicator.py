"""Indicator cards: pressure over the stroke, as an indicator draws it in each chamber from its own dead centre."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import reduce
from typing import TYPE_CHECKING, Any, ClassVar, Union

import numpy as np

from kurbel.arrays import Number
from kurbel.declared.forms.figures import Bound
from kurbel.declared.forms.structures import Keyed, OneOf, RecordForm
from kurbel.declared.forms.values import (
    CLEARANCE_OR_NONE,
    Choice,
    NumberForm,
    Points,
    order_faults,
    size_faults,
    unit_name,
)
from kurbel.declared.record import Record, Rule, ValuesByKey, alternative, field
from kurbel.declared.unit_systems import show
from kurbel.declared.units import DiagramPoint, UnitFactor, written_unit
from kurbel.errors import Fault, refuse
from kurbel.machine.chamber import ChamberCard

if TYPE_CHECKING:
    from kurbel.machine.ideal_cards import Compressor, Diesel, IdealCard, Otto, Steam
    from kurbel.machine.measured import Measured
    from kurbel.traces.correct import Trace


@dataclass(frozen=True, eq=False)
class Rectangle(ChamberCard):
    """A card of horizontal lines, for any working cycle; pressures in Pa.

    level: the pressure on every stroke, None for the ambient; mean: the mean indicated pressure p_i, by which the
    expansion line of a driving chamber (or, if negative, the compression line of a driven one) differs from it. notes:
    remarks for the user.
    """

    level: float | None = None
    mean: float = 0.0

    cycles: ClassVar[tuple[str, ...]] = ("two-stroke", "four-stroke")

    @property
    def notes(self) -> tuple[str, ...]:
        """That such a card has the correct work, but not the true pressures."""
        if not self.mean:
            return ()
        return (
            f"a rectangular card of the mean pressure {show(self.mean, 'pressure')} replaces the true one: work and "
            "power are correct, forces over the angle are not",
        )

    def rules_in(self, cycle: str, lift: Number) -> Iterator[Rule]:
        """Yield the rule that no pressure is below the vacuum; lift: added to make pressures absolute, in Pa."""
        if self.level is not None:
            below = "{level:pressure} is below the vacuum, which is at {vacuum:pressure}"
            yield Rule(
                (), self.level + lift < 0, below, {"level": self.level, "vacuum": 0.0 - lift}
            )


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


class Card(ChamberCard, Record):
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
    def of_keys(
        cls,
        unit: UnitFactor | None = None,
        drawn: Drawn | None = None,
        interpolate: str = "linear",
        clearance: float | None = None,
        **given: Any,
    ) -> Card | Rectangle:
        """Return the card that these keys of a machine file describe; raises RuleError with every fault."""
        by_planimeter = {name: given.pop(name) for name in ("area", "mean_height") if name in given}
        if drawn and by_planimeter:
            own = "the lines have an area of their own; leave out the one by planimeter"
            refuse(*(Fault((name,), own) for name in given))
            height = by_planimeter.get("mean_height", by_planimeter.get("area", 0.0) / drawn.length)
            return Rectangle(mean=height / drawn.spring)  # p_i = a/(l · spring)
        paper, factor, whole = drawn.scales if drawn else ("", unit or (1, 1), 1.0)
        cycle = "four-stroke" if {"intake", "exhaust"} & given.keys() else "two-stroke"
        missing = [name for name in STROKES[cycle] if name not in given]
        faults = [
            Fault((), f"the '{name}' line of the {cycle} card is missing") for name in missing
        ]
        if interpolate == "polytropic" and not clearance:
            needed = "'polytropic' needs the 'clearance' volume over the stroke volume, more than 0"
            faults.append(Fault(("interpolate",), needed))
        for name, points in given.items():
            large = size_faults(points, factor, "pressure")
            faults += (fault.below((name,)) for fault in _line_faults(points, whole, paper) + large)
        refuse(*faults)
        lines, notes = [], []
        for start, name in zip((0, 1, 0, 1), STROKES[cycle]):
            points = given[name]
            ordered = points if (points[0][0] <= points[-1][0]) == (start == 0) else points[::-1]
            kept = [point for before, point in zip([None, *ordered], ordered) if point != before]
            if len(kept) < len(points):
                notes.append(f"{name}: a point given twice counts once")
            pressures = tuple(p * factor[0] / factor[1] for _, p in kept)
            lines.append(CardLine(name, tuple(x / whole for x, _ in kept), pressures, start))
        return cls(tuple(lines), interpolate, clearance, tuple(notes), drawn is not None)

    @property
    def flat(self) -> bool:
        """Whether each line is one pressure, as those of an ideal pump."""
        return all(
            np.ndim(p) == 0 and p == line.pressures[0]
            for line in self.lines
            for p in line.pressures
        )

    @property
    def cycles(self) -> tuple[str, ...]:
        """The one cycle that has so many lines."""
        return tuple(cycle for cycle, lines in STROKES.items() if len(lines) == len(self.lines))

    def rules_in(self, cycle: str, lift: Number) -> Iterator[Rule]:
        """Yield what does not fit the cycle of the machine, or what no polytropic line can be drawn through."""
        wanted = STROKES[cycle]
        lines = f"a {cycle} cycle needs the lines {', '.join(wanted)}; this card has {len(self.lines)} lines"
        yield Rule((), len(self.lines) != len(wanted), lines)
        lowest = reduce(
            np.minimum, (pressure for line in self.lines for pressure in line.pressures)
        )
        numbers = {"lowest": lowest, "vacuum": 0.0 - lift}
        if self.interpolate == "polytropic":
            above = "{lowest:pressure} is not above the vacuum, as p V^n needs; write 'interpolate: linear'"
            yield Rule((), lowest + lift <= 0, above, numbers)
        else:
            below = "{lowest:pressure} is below the vacuum, which is at {vacuum:pressure}"
            yield Rule((), lowest + lift < 0, below, numbers)


def _line_faults(points: list[DiagramPoint], whole: float, unit: str) -> list[Fault]:
    """Return the first fault of a line that does not run once through the whole stroke.

    whole: the stroke in a unit of the paper, '' for fractions of it.
    """
    beyond = [index for index, (x, _) in enumerate(points) if not 0 <= x <= whole]
    if beyond:
        x = points[beyond[0]][0]
        message = f"{x:g} {unit} is not on the card, which is {whole:g} {unit} long; its own dead centre is at 0"
        if not unit:
            hint = (
                f"; write {x / 100:g} here if the line is in percent"
                if 1 < x <= 100 and len(beyond) > 1
                else ""
            )
            message = f"{x:g} is no fraction of the stroke; fractions run from 0 to 1{hint}"
        return [Fault((beyond[0],), message)]
    low, high = sorted((points[0][0], points[-1][0]))
    of = unit and f" {unit}"
    if (low, high) == (0.0, whole):
        return order_faults(points, f"{{:g}}{of}" if unit else "fraction {:g}")
    own = "0 is this chamber's own dead centre, where it is smallest"
    runs = f"it runs from {low:g} to {high:g}{of}; {own}"
    return [Fault((), f"the line must reach from 0 to {whole:g}{of}; {runs}")]


class Constant(Record):
    """Constant pressure on each stroke: an ideal pump."""

    expansion: float = field("pressure", "Pressure while the chamber grows: suction")
    compression: float = field("pressure", "Pressure while the chamber shrinks: delivery")

    @classmethod
    def of_keys(cls, expansion: float, compression: float) -> Card:
        """Return the card with two horizontal lines."""
        return Card(
            (
                CardLine("expansion", (0.0, 1.0), (expansion, expansion), 0),
                CardLine("compression", (1.0, 0.0), (compression, compression), 1),
            )
        )


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
Chamber = Union[Rectangle, Card, "IdealCard", "Trace"]
"""The pressure in one end of a cylinder; each has `cycles`, of which it can be part, and `rules_in`."""


def _mirrored(head_end: Chamber | None) -> dict[str, object]:
    """Return the crank end that has the card of the head end, its valves at work."""
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
        gives=lambda given: {"absolute": given["pressures"] == "absolute"},
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
        # each chamber's fractions count from its own dead centre, so that it is the same card
        gives=lambda given: (
            _mirrored(given.get("head_end")) if given["crank_end"] == "mirrored" else {}
        ),
    )
    role: str | None = field(
        ("engine", "compressor", "pump", "steam"),
        "What the cylinder is, by which a measured trace is judged",
        absent="by cycle and shape of the trace",
    )
    absolute: bool = False

    @classmethod
    def rules_of_keys(cls, given: ValuesByKey) -> Iterator[Rule]:
        mirrored = given.get("crank_end") == "mirrored"
        none = "head_end" not in given and (mirrored or "crank_end" not in given)
        yield Rule(
            "crank_end" if mirrored else (),
            none,
            "the indicator shows no pressure; give 'head_end'",
        )
        for end in ("head_end", "crank_end"):
            card = given.get(end)
            drawn = given.get("pressures") == "absolute" and isinstance(card, Card) and card.drawn
            message = "a drawn card counts from the atmospheric line; write 'pressures: gauge'"
            yield Rule((end, "drawn"), drawn, message)
