"""Indicator cards: pressure over the stroke, as an indicator draws it in each chamber from its own dead centre."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, Protocol

from kurbel.declared.forms import Choice, Keyed, OneOf, Physical, Points, Record, UnitName, not_negative
from kurbel.declared.keys import Described, Key, Keys
from kurbel.declared.kinds import Factor, Point, size_faults
from kurbel.declared.unit_systems import show
from kurbel.errors import Fault, Path, refuse, refused
from kurbel.machine.drawn import Drawn
from kurbel.machine.ideal_cards import CLEARANCE_OR_NONE, Compressor, Diesel, Otto, Steam
from kurbel.machine.rectangle import Rectangle, Rectangular

_POINTS = Points("stroke fraction", "pressure", ratio=True)


class Chamber(Protocol):
    """What stands in one end of a cylinder: a card, an ideal card or a trace."""

    @property
    def cycles(self) -> tuple[str, ...]:
        """The working cycles that it can be part of."""
        ...

    def fault_in(self, cycle: str, lift: float) -> str:
        """Return what does not fit the cycle of the machine, or pressures that `lift` makes absolute (Pa); or ''."""
        ...


@dataclass(frozen=True, eq=False)
class Line:
    """One line of a card: pressures in Pa over fractions of the chamber's stroke, in the order of the process.

    Two points at one fraction are a vertical jump. `start` is the fraction at which the line begins, 0 or 1.
    """

    name: str
    fractions: tuple[float, ...]
    pressures: tuple[float, ...]
    start: int


STROKES = {"two-stroke": ("expansion", "compression"), "four-stroke": ("expansion", "exhaust", "intake", "compression")}
"""Cycle -> the lines of a card from the chamber's (firing) dead centre on; the volume grows along every other one."""


@dataclass(frozen=True, eq=False, repr=False)
class Card(Described):
    """A card: its lines in the order of the process from the smallest volume on, and how to join their points.

    interpolate: `linear`, or `polytropic`: straight in log p over log V, which needs the clearance volume over
    the stroke volume. `notes` tells what was tidied up; drawn: whether its points count from an atmospheric line.
    """

    lines: tuple[Line, ...]
    interpolate: str = "linear"
    clearance: float | None = None
    notes: tuple[str, ...] = ()
    drawn: bool = False

    KEYS: ClassVar[Keys] = {
        "unit": Key(UnitName("pressure"), "Unit of the pressures; or give `drawn`", required=True, example="bar"),
        "drawn": Key(
            Record(Drawn),
            "The paper of the card: all points are then millimetres, from the card's own dead centre and from the "
            "atmospheric line",
            instead="unit",
        ),
        "area": not_negative("area", "Area by planimeter, instead of the lines of a drawn card", needs="drawn"),
        "mean_height": not_negative(
            "length", "Mean height by planimeter, instead of the lines of a drawn card", instead="area", needs="drawn"
        ),
        "expansion": Key(_POINTS, "Line while the burnt or admitted gas expands"),
        "compression": Key(_POINTS, "Line while the chamber is compressed or empties"),
        "intake": Key(_POINTS, "Suction line of a four-stroke cycle"),
        "exhaust": Key(_POINTS, "Exhaust line of a four-stroke cycle"),
        "interpolate": Key(Choice(("linear", "polytropic")), "How points are joined", absent="linear"),
        "clearance": Key(CLEARANCE_OR_NONE, "Clearance over stroke volume, for `polytropic`", absent="not known"),
    }

    @classmethod
    def of_keys(
        cls,
        unit: Factor | None = None,
        drawn: "Drawn | None" = None,
        interpolate: str = "linear",
        clearance: float | None = None,
        **given: Any,
    ) -> "Card | Rectangle":
        """Return the card that these keys of a machine file describe; raises RuleError with every fault."""
        if drawn and given.keys() & {"area", "mean_height"}:
            return _by_planimeter(drawn, **given)
        factor = drawn.unit if drawn else unit or (1, 1)
        whole = drawn.whole if drawn else 1.0
        faults = [*_missing_lines(given), *_all_line_faults(given, whole)]
        if interpolate == "polytropic" and not clearance:
            needed = "'polytropic' needs the 'clearance' volume over the stroke volume"
            faults.append(Fault(("interpolate",), needed + (", more than 0" if clearance == 0 else "")))
        for name, points in given.items():
            faults += size_faults(points, factor, "pressure", (name,))
        refuse(*faults)
        names = STROKES[_cycle_of(given)]
        lines = tuple(_line(name, given[name], factor, whole, index % 2) for index, name in enumerate(names))
        notes = tuple(
            f"{line.name}: a point given twice counts once"
            for line in lines
            if len(line.fractions) < len(given[line.name])
        )
        return cls(lines, interpolate, clearance, notes, drawn is not None)

    @staticmethod
    def faults_of_keys(values: Mapping[str, Any]) -> list[Fault]:
        """Return what is wrong with the lines that could be read, where others could not be."""
        lines = {name: value for name, value in values.items() if isinstance(value, list)}
        return [] if "drawn" in values else _all_line_faults(lines, 1.0)

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


def _cycle_of(given: Iterable[str]) -> str:
    return "four-stroke" if {"intake", "exhaust"} & set(given) else "two-stroke"


def _missing_lines(given: Mapping[str, Any]) -> list[Fault]:
    cycle = _cycle_of(given)
    missing = [name for name in STROKES[cycle] if name not in given]
    return [Fault((), f"the '{name}' line of the {cycle} card is missing") for name in missing]


def _by_planimeter(drawn: "Drawn", **given: Any) -> "Rectangle":
    lines = [name for name in given if name not in ("area", "mean_height")]
    refuse(*(Fault((name,), "the lines have an area of their own; leave out the one by planimeter") for name in lines))
    return drawn.rectangle(**given)


def _runs_forward(points: list[Point]) -> bool:
    return points[0][0] <= points[-1][0]


def _line(name: str, points: list[Point], unit: Factor, whole: float, start: int) -> Line:
    """Return one line in process order, its pressures in Pa."""
    up, down = unit
    ordered = points if _runs_forward(points) == (start == 0) else points[::-1]
    kept = [point for i, point in enumerate(ordered) if i == 0 or point != ordered[i - 1]]
    return Line(name, tuple(x / whole for x, _ in kept), tuple(p * up / down for _, p in kept), start)


def _all_line_faults(lines: Mapping[str, list[Point]], whole: float) -> list[Fault]:
    """Return what keeps lines from running once through the whole stroke; points that are not on it are told once."""
    faults = []
    for name, points in lines.items():
        beyond = [index for index, (x, _) in enumerate(points) if not 0 <= x <= whole]
        if beyond:
            return [Fault((name, beyond[0]), _beyond(points[beyond[0]][0], whole, len(beyond) > 1))]
        faults += _order_faults(name, points, whole)
    return faults


def _beyond(x: float, whole: float, several: bool) -> str:
    if whole != 1:
        return f"{x:g} mm is not on the card, which is {whole:g} mm long; its own dead centre is at 0"
    hint = f"; write {x / 100:g} here if the line is in percent" if 1 < x <= 100 and several else ""
    return f"{x:g} is no fraction of the stroke; fractions run from 0 to 1{hint}"


def _order_faults(name: str, points: list[Point], whole: float) -> list[Fault]:
    forward = _runs_forward(points)
    word, unit = ("", " mm") if whole != 1 else ("fraction ", "")
    along = [x for x, _ in points]
    low, high = (along[0], along[-1]) if forward else (along[-1], along[0])
    if (low, high) != (0.0, whole):
        own = "0 is this chamber's own dead centre, where it is smallest"
        reach = f"the line must reach from {word}0 to {whole:g}{unit}; it runs from {low:g} to {high:g}{unit}; {own}"
        return [Fault((name,), reach)]
    for i in range(1, len(points)):
        if (along[i] < along[i - 1]) if forward else (along[i] > along[i - 1]):
            return [Fault((name, i), f"{word}{along[i]:g}{unit} after {along[i - 1]:g}{unit}: the line turns back")]
        if i >= 2 and along[i] == along[i - 2] and points[i - 2] != points[i - 1] != points[i]:
            return [Fault((name, i), f"three points at {word}{along[i]:g}{unit}; a jump has two")]
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
        "mean_pressure": Rectangular("mean"),
        "constant": Record(Constant),
        "trace": Record("kurbel.machine_file.trace:Measured"),
        "steam": Record(Steam),
        "compressor": Record(Compressor),
        "otto": Record(Otto),
        "diesel": Record(Diesel),
    },
    otherwise=Record(Card),
)
_ONE_PRESSURE = Rectangular("level")


@dataclass(frozen=True, eq=False, repr=False)
class Indicator(Described):
    """The pressures in the two ends of a cylinder; an end that is None is open to the ambient.

    absolute: the pressures of both ends are absolute, not gauge.
    """

    head_end: Chamber | None = None
    crank_end: Chamber | None = None
    absolute: bool = False

    KEYS: ClassVar[Keys] = {
        "pressures": Key(
            Choice(("gauge", "absolute")),
            "What the pressures count from, also where `p_head`, `p_crank` and `p_max` are shown, asked for or limited",
            absent="gauge",
        ),
        "head_end": Key(
            OneOf(_ONE_PRESSURE, _CHAMBER),
            "Pressure at the head end: one for all strokes, or a card",
            absent="open to the ambient",
        ),
        "crank_end": Key(
            OneOf(Choice(("mirrored",)), _ONE_PRESSURE, _CHAMBER),
            "Pressure at the crank end, a card counted from its own dead centre, the outer one; or `mirrored`: the "
            "head end's card, so counted",
            absent="open to the ambient",
        ),
    }

    @classmethod
    def of_keys(
        cls, pressures: str = "gauge", head_end: Chamber | None = None, crank_end: Chamber | str | None = None
    ) -> "Indicator":
        """Return the indicator that these keys of a machine file describe; raises RuleError."""
        if head_end is None and crank_end in (None, "mirrored"):
            path: Path = () if crank_end is None else ("crank_end",)
            refused("the indicator shows no pressure; give 'head_end'", *path)
        for end, chamber in (("head_end", head_end), ("crank_end", crank_end)):
            if pressures == "absolute" and getattr(chamber, "drawn", False):
                refused("a drawn card counts from the atmospheric line; write 'pressures: gauge'", end, "drawn")
        # a mirrored card is the same card: each chamber's fractions count from its own dead centre
        other = head_end if isinstance(crank_end, str) else crank_end
        return cls(head_end, other, pressures == "absolute")
