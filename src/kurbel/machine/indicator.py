"""Indicator cards: pressure over the stroke, as an indicator draws it in each chamber from its own dead centre."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple, Protocol

from kurbel.declared.bounds import Point, size_faults
from kurbel.declared.forms import Choice, Keyed, Number, OneOf, Physical, Points, Record, UnitName
from kurbel.declared.keys import Described, Key, Keys
from kurbel.declared.unit_systems import show
from kurbel.declared.units import Factor
from kurbel.errors import Fault, Path, refuse

CLEARANCE = Number(least=1e-6, most=1e5)
"""A clearance volume over the stroke volume: what a machine can have, and p V^n can be computed with."""


class Chamber(Protocol):
    """What stands in one end of a cylinder: a card, an ideal card or a trace."""

    @property
    def cycles(self) -> tuple[str, ...]:
        """The working cycles that it can be part of."""
        ...

    def fault_in(self, cycle: str, lift: float) -> str:
        """Return what does not fit the cycle of the machine, or pressures that `lift` makes absolute (Pa); or ''."""
        ...


class Line(NamedTuple):
    """One line of a card: pressures in Pa over fractions of the chamber's stroke, in the order of the process.

    Two points at one fraction are a vertical jump. `start` is the fraction at which the line begins, 0 or 1.
    """

    name: str
    fractions: tuple[float, ...]
    pressures: tuple[float, ...]
    start: int


STROKES = {"two-stroke": ("expansion", "compression"), "four-stroke": ("expansion", "exhaust", "intake", "compression")}
"""Cycle -> the lines of a card from the chamber's (firing) dead centre on; the volume grows along every other one."""


@dataclass(frozen=True, eq=False)
class Card(Described):
    """A card: its lines in the order of the process from the smallest volume on, and how to join their points.

    interpolate: `linear`, or `polytropic`: straight in log p over log V, which needs the clearance volume over
    the stroke volume. `notes` tells what was tidied up.
    """

    lines: tuple[Line, ...]
    interpolate: str = "linear"
    clearance: float | None = None
    notes: tuple[str, ...] = ()

    KEYS: ClassVar[Keys] = {
        "unit": Key(UnitName("pressure"), "Unit of the pressures", required=True),
        "expansion": Key(Points("stroke fraction", "pressure"), "Line while the burnt or admitted gas expands"),
        "compression": Key(Points("stroke fraction", "pressure"), "Line while the chamber is compressed or empties"),
        "intake": Key(Points("stroke fraction", "pressure"), "Suction line of a four-stroke cycle"),
        "exhaust": Key(Points("stroke fraction", "pressure"), "Exhaust line of a four-stroke cycle"),
        "interpolate": Key(Choice(("linear", "polytropic")), "How points are joined", absent="linear"),
        "clearance": Key(CLEARANCE, "Clearance volume over stroke volume, for `polytropic`", absent="not known"),
    }

    @classmethod
    def of_keys(
        cls, unit: Factor, interpolate: str = "linear", clearance: float | None = None, **given: list[Point]
    ) -> Card:
        """Return the card that these keys of a machine file describe; raises RuleError with every fault."""
        cycle = "four-stroke" if given.keys() & {"intake", "exhaust"} else "two-stroke"
        faults = [
            Fault((), f"the '{name}' line of the {cycle} card is missing")
            for name in STROKES[cycle]
            if name not in given
        ]
        drawn = [(name, given[name], index % 2) for index, name in enumerate(STROKES[cycle]) if name in given]
        faults += [fault for name, points, _ in drawn for fault in cls.faults_of_key(name, points)]
        if interpolate == "polytropic" and clearance is None:
            faults.append(Fault(("interpolate",), "'polytropic' needs the 'clearance' volume over the stroke volume"))
        for name, points, _ in drawn:
            faults += size_faults(points, unit, "pressure", (name,))
        refuse(*faults)
        lines = tuple(_line(name, points, unit, start) for name, points, start in drawn)
        notes = tuple(
            f"{name}: a point given twice counts once"
            for (name, points, _), line in zip(drawn, lines)
            if len(line.fractions) < len(points)
        )
        return cls(lines, interpolate, clearance, notes)

    @staticmethod
    def faults_of_key(name: str, value: Any) -> list[Fault]:
        """Return what is wrong with the line under one key, whatever the others say."""
        return _line_faults(name, value) if isinstance(value, list) else []

    @property
    def cycles(self) -> tuple[str, ...]:
        """The one cycle that has so many lines."""
        return tuple(cycle for cycle, lines in STROKES.items() if len(lines) == len(self.lines))

    def fault_in(self, cycle: str, lift: float) -> str:
        """Return what does not fit the cycle of the machine, or what no polytropic line can be drawn through; or ''."""
        wanted = STROKES[cycle]
        if len(self.lines) != len(wanted):
            return f"a {cycle} cycle needs the lines {', '.join(wanted)}; this card has {len(self.lines)} lines"
        lowest = min(pressure for line in self.lines for pressure in line.pressures)
        if self.interpolate == "polytropic" and lowest + lift <= 0:
            return f"{show(lowest, 'pressure')} is not above the vacuum, as p V^n needs; write 'interpolate: linear'"
        if lowest + lift < 0:
            return f"{show(lowest, 'pressure')} is below the vacuum, which is at {show(0.0 - lift, 'pressure')}"
        return ""


def _runs_forward(points: list[Point]) -> bool:
    return points[0][0] <= points[-1][0]


def _line(name: str, points: list[Point], unit: Factor, start: int) -> Line:
    """Return one line in process order, its pressures in Pa."""
    up, down = unit
    ordered = points if _runs_forward(points) == (start == 0) else points[::-1]
    kept = [point for i, point in enumerate(ordered) if i == 0 or point != ordered[i - 1]]
    return Line(name, tuple(x for x, _ in kept), tuple(p * up / down for _, p in kept), start)


def _line_faults(name: str, points: list[Point]) -> list[Fault]:
    """Return what keeps a line from running once through the whole stroke."""
    beyond = [index for index, (x, _) in enumerate(points) if not 0 <= x <= 1]
    if not beyond:
        return _order_faults(name, points)
    # told once: where there are more, they are of the same sort
    first = points[beyond[0]][0]
    hint = f"; write {first / 100:g} here if the line is in percent" if 1 < first <= 100 and len(beyond) > 1 else ""
    return [Fault((name, beyond[0]), f"{first:g} is no fraction of the stroke; fractions run from 0 to 1{hint}")]


def _order_faults(name: str, points: list[Point]) -> list[Fault]:
    forward = _runs_forward(points)
    fractions = [x for x, _ in points]
    low, high = (fractions[0], fractions[-1]) if forward else (fractions[-1], fractions[0])
    if (low, high) != (0.0, 1.0):
        return [Fault((name,), f"the line must reach from fraction 0 to 1; it runs from {low:g} to {high:g}")]
    for i in range(1, len(points)):
        if (fractions[i] < fractions[i - 1]) if forward else (fractions[i] > fractions[i - 1]):
            return [Fault((name, i), f"fraction {fractions[i]:g} after {fractions[i - 1]:g}: the line turns back")]
        if i >= 2 and fractions[i] == fractions[i - 2] and points[i - 2] != points[i - 1] != points[i]:
            return [Fault((name, i), f"three points at fraction {fractions[i]:g}; a jump has two")]
    return []


class Constant(Described):
    """Constant pressure on each stroke: an ideal pump."""

    KEYS: ClassVar[Keys] = {
        "expansion": Key(Physical("pressure"), "Pressure while the chamber grows: suction", required=True),
        "compression": Key(Physical("pressure"), "Pressure while the chamber shrinks: delivery", required=True),
    }

    @staticmethod
    def of_keys(expansion: float, compression: float) -> Card:
        """Return the card with two horizontal lines."""
        return Card(
            (
                Line("expansion", (0.0, 1.0), (expansion, expansion), 0),
                Line("compression", (1.0, 0.0), (compression, compression), 1),
            )
        )


_CHAMBER = Keyed(
    cases={
        "constant": Record("kurbel.machine.indicator:Constant"),
        "trace": Record("kurbel.machine_file.trace:Measured"),
        "steam": Record("kurbel.machine.ideal_cards:Steam"),
        "compressor": Record("kurbel.machine.ideal_cards:Compressor"),
        "otto": Record("kurbel.machine.ideal_cards:Otto"),
        "diesel": Record("kurbel.machine.ideal_cards:Diesel"),
    },
    otherwise=Record("kurbel.machine.indicator:Card"),
)


@dataclass(frozen=True, eq=False)
class Indicator(Described):
    """The pressures in the two ends of a cylinder; an end that is None is open to the ambient.

    absolute: the pressures of both ends are absolute, not gauge.
    """

    head_end: Chamber | None = None
    crank_end: Chamber | None = None
    absolute: bool = False

    KEYS: ClassVar[Keys] = {
        "pressures": Key(Choice(("gauge", "absolute")), "What the pressures count from", absent="gauge"),
        "head_end": Key(_CHAMBER, "Pressure at the head end", absent="open to the ambient"),
        "crank_end": Key(
            OneOf(Choice(("mirrored",)), _CHAMBER),
            "Pressure at the crank end, or `mirrored`: the head end's card from the crank end's dead centre",
            absent="open to the ambient",
        ),
    }

    @classmethod
    def of_keys(
        cls, pressures: str = "gauge", head_end: Chamber | None = None, crank_end: Chamber | str | None = None
    ) -> Indicator:
        """Return the indicator that these keys of a machine file describe; raises RuleError."""
        if head_end is None and crank_end in (None, "mirrored"):
            path: Path = () if crank_end is None else ("crank_end",)
            refuse(Fault(path, "the indicator shows no pressure; give 'head_end'"))
        # a mirrored card is the same card: each chamber's fractions count from its own dead centre
        other = head_end if isinstance(crank_end, str) else crank_end
        return cls(head_end, other, pressures == "absolute")
