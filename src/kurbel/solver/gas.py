"""The pressures in the chambers and the force and work of gas, steam or water on the pistons.

A card is a process over the stroke z, counted from the chamber's smallest volume: segments that are straight, or p V^n
= const. Ideal cards are drawn from the few numbers of a theoretical cycle. Segments are found by crank angle, not by
displacement, so that each side of a vertical jump is exact. The indicated work is closed, A s ∮ p dz:

    straight      (p + p′)/2 · (z′ − z)
    p V^n         P V ln(V′/V) (e^u − 1)/u,  u = (1 − n) ln(V′/V), P absolute, less what makes it absolute

A measured trace is in `kurbel.solver.trace`. The force is P = p_H A_H − p_C A_C (R 296), gauge pressures.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from itertools import pairwise
from typing import Any, NamedTuple, Union

import numpy as np

from kurbel.arrays import Array, Indices
from kurbel.crank_angle import within_cycle
from kurbel.machine.batch import changed, taken, varies
from kurbel.machine.cylinder import CYCLES
from kurbel.machine.ideal_cards import Compressor, Diesel, Otto, Steam, after_polytrope
from kurbel.machine.indicator import STROKES, Card, Rectangle
from kurbel.machine.parts import Piston
from kurbel.mechanisms import Mechanism
from kurbel.numerics.arithmetic import total
from kurbel.numerics.extreme import Extreme
from kurbel.numerics.pieces import Angles
from kurbel.solver.trace import TracePressure, spread
from kurbel.traces.correct import Setting, Trace

_NO_WIDTH = 1e-10
"""Degrees of crank angle; over less a line cannot be followed, and its segment is a jump."""
_STEEP = 1e-3
"""Of the stroke: a line over less is so steep that the rounding of z counts."""
_ROUNDING = 3e-13
"""Degrees of crank angle by which the angle of a corner may be off: a few units in the last place of 720."""

# the process of a chamber


class Segment(NamedTuple):
    """A line between two stroke fractions z, where the pressures p (Pa) are given; numbers, or many, (n,).

    exponent: n of p V^n = const between them, with absolute pressures; 0 for a straight line.
    """

    z: Any
    p: Any
    next_z: Any
    next_p: Any
    exponent: Any = 0.0


Stroke = tuple[Segment, ...]
"""The segments of one line, in the order of the process, vertical jumps left out."""


@dataclass(frozen=True)
class Process:
    """What happens in a chamber during one cycle, stroke by stroke from the (firing) dead centre on.

    lift: what makes the pressures absolute, in Pa; clearance: smallest volume over the stroke volume.
    """

    strokes: tuple[Stroke, ...]
    lift: float = 0.0
    clearance: float = math.inf

    @property
    def area(self) -> float:
        """∮ p dz in Pa, closed: straight segments exactly, so that nearly cancelling cards lose nothing."""
        segments = [segment for stroke in self.strokes for segment in stroke]
        straight = sum(_straight_area(one) for one in segments if not one.exponent)
        curved = (term for one in segments if one.exponent for term in self._polytropic_area(one))
        return math.fsum((float(straight), *curved))

    def _polytropic_area(self, segment: Segment) -> tuple[float, float]:
        """Return P V ln(V′/V) (e^u − 1)/u with P absolute, and what the lift takes off."""
        volume, way = segment.z + self.clearance, segment.next_z - segment.z
        grown = float(growth(segment.z, way, self.clearance))
        u = (1 - segment.exponent) * grown
        mean = math.expm1(u) / u if u else 1.0
        return (segment.p + self.lift) * volume * grown * mean, -self.lift * way


def _straight_area(segment: Segment) -> Fraction:
    z, p, next_z, next_p = (Fraction(float(one)) for one in segment[:4])
    return (p + next_p) * (next_z - z) / 2


def growth(z: Any, way: Any, clearance: Any) -> Any:
    """Return ln(V′/V) between stroke fractions z and z + way.

    Only ln(1 + what is more than the smaller volume) has its digits both for steep lines and for small clearances.

    >>> round(float(growth(1.0, -1.0, 1.0)), 9)
    -0.693147181
    """
    return np.where(way < 0, -1.0, 1.0) * np.log1p(np.abs(way) / (np.minimum(z, z + way) + clearance))


def polytropic_exponent(z: float, p: float, next_z: float, next_p: float, clearance: float) -> float:
    """Return n of p V^n = const through two points: stroke fractions z, absolute pressures p, relative clearance.

    >>> polytropic_exponent(0.0, 8.0, 1.0, 4.0, 1.0)
    1.0
    """
    return math.log(p / next_p) / float(growth(z, next_z - z, clearance))


def process_in(chamber: Any, lift: float = 0.0, cycle: float = 360.0, base: float = 0.0) -> Process:
    """Return the process of a card.

    lift: what makes its pressures absolute, base: what they less this are gauge pressures, both in Pa; cycle: degrees.
    """
    if isinstance(chamber, Card):
        return _card(chamber, lift)
    if isinstance(chamber, Rectangle):
        return _rectangle(chamber, base, cycle)
    return Process(_ideal(chamber, lift, four_stroke=cycle == 720.0), lift, chamber.clearance)


def _card(card: Card, lift: float) -> Process:
    """Return the process of a card drawn by points, joined as the card says."""
    straight = card.interpolate == "linear" or card.clearance is None
    clearance = math.inf if straight or card.clearance is None else card.clearance

    def exponent(z: float, p: float, next_z: float, next_p: float) -> float:
        return 0.0 if straight else polytropic_exponent(z, p + lift, next_z, next_p + lift, clearance)

    strokes = tuple(
        tuple(
            Segment(z, p, next_z, next_p, exponent(z, p, next_z, next_p))
            for (z, p), (next_z, next_p) in pairwise(zip(line.fractions, line.pressures))
            if next_z != z
        )
        for line in card.lines
    )
    return Process(strokes, lift, clearance)


def _rectangle(card: Rectangle, base: float, cycle: float) -> Process:
    """Return a rectangular card: the mean pressure stands on the stroke that drives, or is driven."""
    level = base if card.level is None else card.level
    above = {"expansion": max(card.mean, 0.0), "compression": max(-card.mean, 0.0)}
    names = next(names for word, names in STROKES.items() if 360.0 * CYCLES[word] == cycle)
    pressures = [level + above.get(name, 0.0) for name in names]
    return Process(tuple((_isobar(float(i % 2), p, float(1 - i % 2)),) for i, p in enumerate(pressures)))


def _ideal(card: Steam | Compressor | Otto | Diesel, lift: float, four_stroke: bool) -> tuple[Stroke, ...]:
    """Return the lines of an ideal card, stroke by stroke; those of an engine with exhaust and intake in four strokes.

    lift: what makes its pressures absolute, in Pa.
    """
    clearance = card.clearance

    def polytrope(z: float, p: float, next_z: float, exponent: float) -> Segment:
        """Return p V^n = const from the point (z, p) to the stroke fraction next_z."""
        if next_z == z:  # even where there is no volume
            return _isobar(z, p, z)
        absolute = after_polytrope(p + lift, z + clearance, next_z + clearance, exponent)
        return Segment(z, p, next_z, absolute - lift, exponent)

    if isinstance(card, Steam):  # admission, expansion, exhaust; exhaust, compression
        expansion = polytrope(card.cut_off, card.admission, card.release, card.exponent)
        out = _isobar(0.0, card.admission, card.cut_off), expansion, _isobar(card.release, card.exhaust, 1.0)
        back = (
            _isobar(1.0, card.exhaust, card.compression),
            polytrope(card.compression, card.exhaust, 0.0, card.exponent),
        )
        return _wide(*out), _wide(*back)
    if isinstance(card, Compressor):  # expansion of the clearance gas, suction; compression, delivery
        grown = math.expm1(math.log((card.delivery + lift) / (card.suction + lift)) / card.exponent)
        shrunk = math.expm1(math.log((card.suction + lift) / (card.delivery + lift)) / card.exponent)
        fills, empties = clearance * grown, 1.0 + (1.0 + clearance) * shrunk
        expansion = Segment(0.0, card.delivery, fills, card.suction, card.exponent)
        compression = Segment(1.0, card.suction, empties, card.delivery, card.exponent)
        suction, delivery = _isobar(fills, card.suction, 1.0), _isobar(empties, card.delivery, 0.0)
        return _wide(expansion, suction), _wide(compression, delivery)
    compression = polytrope(1.0, card.intake, 0.0, card.exponent)
    if isinstance(card, Otto):
        power: Stroke = (polytrope(0.0, card.peak, 1.0, card.expansion_exponent),)
    else:  # injection at constant pressure
        burning = compression.next_p if card.peak is None else card.peak
        expansion = polytrope(card.cut_off, burning, 1.0, card.expansion_exponent)
        power = _isobar(0.0, burning, card.cut_off), expansion
    if not four_stroke:
        return power, (compression,)
    return power, (_isobar(1.0, card.leaving, 0.0),), (_isobar(0.0, card.intake, 1.0),), (compression,)


def _isobar(z: float, p: float, next_z: float) -> Segment:
    return Segment(z, p, next_z, p)


def _wide(*segments: Segment) -> Stroke:
    """Return the segments that have any width."""
    return tuple(segment for segment in segments if segment.next_z != segment.z)


# over the crank angle


class CardPressure:
    """Gauge pressure in one chamber from a process over the stroke, or in those of many machines."""

    def __init__(self, chamber: Any, setting: Setting, count: int | None) -> None:
        self.setting, self._count = setting, count
        self.processes, self._which = _processes(chamber, setting, count)
        alike = self._alike = len(self.processes) == 1 and not varies(setting.mechanism)
        segments = _over_the_angle(self.processes, self._which, setting, alike)
        self._machine, self._begins, self._ends, self._table = segments
        self._clearance = self._of_machines([one.clearance for one in self.processes])
        self._keys = self._machine * (2 * setting.cycle) + self._begins
        self._first = np.searchsorted(self._machine, np.arange(1 if alike else len(self._which)))
        z, p, next_z, next_p, exponent = self._table
        self._rows = np.stack((z, p, next_z, exponent, (next_p - p) / (next_z - z), self._begins, self._ends))
        self.straight = not exponent.any()
        self.steep = bool((np.abs(next_z - z) < _STEEP).any())

    @property
    def starts(self) -> Angles:
        """Where segments begin, of one machine those of machine 0."""
        if not (self._alike and self._count):
            return Angles(self._machine, self._begins)
        return Angles(np.repeat(np.arange(self._count), len(self._begins)), np.tile(self._begins, self._count))

    def at(
        self, z: Array, degrees: Array, within: Array, machine: Indices | None, remaining: Array | None = None
    ) -> Array:
        """Return the gauge pressure in Pa where z of the stroke is passed, on the segments that hold `within` (n,).

        z, degrees: (n,), or (nodes, n) of pieces, each of which one segment holds; machine: of each, (n,); remaining:
        1 − z with all its digits, of which steep lines near the outer dead centre need every one.
        """
        setting, row = self.setting, self._holding(within, machine)
        begin, p, next_z, exponent, rise, begins, ends = self._rows[:, row]
        lift, base, clearance = (spread(one, machine) for one in (setting.lift, setting.base, self._clearance))
        own, rest = (z, remaining) if setting.head_end else (remaining, z)
        way = (1 - z if own is None else own) - begin
        if remaining is not None:
            way = np.where(begin > 0.5, (1 - begin) - rest, way)
        # angles of corners are rounded, lines may be steep: at corners the pressure is exactly the card's; of a piece
        # only the first and the last node may be there
        at = np.s_[:: len(way) - 1] if way.ndim > 1 else np.s_[:]
        turned = within_cycle(degrees[at], setting.cycle)
        for corner, whole in ((ends, next_z - begin), (begins, 0.0)):
            way[at] = np.where(np.abs(turned - corner) <= _ROUNDING, whole, way[at])
        straight: Array = (p - base) + rise * way
        if self.straight:
            return straight
        curved = exponent != 0
        clearance = np.where(curved, clearance, 1.0)  # what is straight may begin without any volume
        power = (p + lift) * np.exp(growth(begin, way, clearance) * -exponent)
        return np.where(curved, power - lift - base, straight)

    def _holding(self, within: Array, machine: Indices | None) -> Indices:
        """Return the segments that hold angles (n,) in degrees, of these machines."""
        turned = within_cycle(within, self.setting.cycle)
        own = np.zeros(1, dtype=np.intp) if machine is None or self._alike else machine
        row = np.searchsorted(self._keys, own * (2 * self.setting.cycle) + turned, side="right") - 1
        last = np.append(self._first[1:], len(self._keys))[own] - 1
        return np.where(row < self._first[own], last, row)

    @cached_property
    def highest(self) -> Extreme:
        """The highest gauge pressure in Pa, and the first crank angle in degrees of the cycle that has it."""
        p, next_p = self._table.p, self._table.next_p
        best = np.maximum.reduceat(np.maximum(p, next_p), self._first)
        until = np.where(self._ends > self._begins, self._ends, self._ends + self.setting.cycle)
        level = best[self._machine]
        angles = np.where(p == level, self._begins, np.where(next_p == level, until, np.inf))
        highest, first = best - self.setting.base, np.minimum.reduceat(angles, self._first)
        if self._count is None:
            return Extreme(float(highest[0]), float(first[0]))
        pair: Any = np.broadcast_arrays(highest, first, np.empty(self._count))[:2]
        return Extreme(*pair)

    @cached_property
    def area(self) -> Any:
        """∮ p dz over the stroke fraction z in Pa, per cycle, closed."""
        return self._of_machines([one.area for one in self.processes])

    def _of_machines(self, values: list[float]) -> Any:
        """Return numbers of the processes as those of the machines: one if there is one process."""
        return values[0] if len(values) == 1 else np.array(values)[self._which]


def _processes(chamber: Any, setting: Setting, count: int | None) -> tuple[list[Process], Indices]:
    """Return the different processes of machines, and which one each has, (machines,)."""
    each, which = [chamber], np.zeros(count or 1, int)
    if varies(chamber):
        which = np.arange(count or 1)
        each = [changed(chamber, lambda numbers, at=at: numbers[at].item()) for at in which]  # type: ignore[misc]
    numbers = (np.broadcast_to(one, len(which)).tolist() for one in (which, setting.lift, setting.base))
    made: dict[tuple[int, float, float], int] = {}
    own = np.array([made.setdefault(key, len(made)) for key in zip(*numbers)])
    return [process_in(each[one], lift, setting.cycle, base) for one, lift, base in made], own


def _over_the_angle(
    processes: list[Process], which: Indices, setting: Setting, alike: bool
) -> tuple[Indices, Array, Array, Segment]:
    """Return whose each segment is, where it begins and ends in degrees, and the segments, in the order of the angle.

    Those over no width, being jumps, are left out. alike: the segments are at the same angles in all machines, and are
    returned for one. One process of many machines is elsewhere in each.
    """
    machine, stroke, table = _rows_of(processes, which[:1] if alike else which)
    # the crank end begins its process at the outer dead centre, one stroke later
    number = stroke + (0 if setting.head_end else 1)
    mechanism = setting.mechanism if alike else taken(setting.mechanism, machine)
    begin, end = (_dead_centre(mechanism, each) for each in (number, number + 1))
    edges, along = begin.copy(), table.z if setting.head_end else 1 - table.z
    later = np.append(False, (stroke[1:] == stroke[:-1]) & (machine[1:] == machine[:-1]))
    for outstroke in (True, False):
        inside = np.flatnonzero(later & ((number % 2 == 0) == outstroke))
        if len(inside):
            own = mechanism if alike else taken(setting.mechanism, machine[inside])
            edges[inside] = 360.0 * (number[inside] // 2) + own.crank_angles_at(along[inside] * own.stroke, outstroke)
    ends = np.where(np.append(later[1:], False), np.append(edges[1:], 0.0), end)
    # beside the other end of the stroke rounding may turn two angles round
    wide = np.mod(ends - edges + 1, 360.0) - 1 > _NO_WIDTH
    machine, stroke, begin, edges = machine[wide], stroke[wide], begin[wide], edges[wide]
    begins = np.append(True, (stroke[1:] != stroke[:-1]) | (machine[1:] != machine[:-1]))
    angles = np.mod(np.where(begins, begin, edges), setting.cycle)
    order = np.lexsort((angles, machine))
    angles, machine = angles[order], machine[order]
    following = np.append(np.arange(1, len(angles)), 0)
    last = np.append(machine[1:] != machine[:-1], True)
    following[last] = np.flatnonzero(np.append(True, last[:-1]))
    return machine, angles, angles[following], Segment(*(part[wide][order] for part in table))


def _rows_of(processes: list[Process], which: Indices) -> tuple[Indices, Indices, Segment]:
    """Return whose each segment is, of which stroke, and the segments, (n,), in the order of the process."""
    rows = [
        np.array([(number, *segment) for number, stroke in enumerate(one.strokes) for segment in stroke])
        for one in processes
    ]
    lengths = np.array([len(one) for one in rows])
    machine = np.repeat(np.arange(len(which)), lengths[which])
    begins = (np.cumsum(lengths) - lengths)[which]
    own = np.cumsum(lengths[which]) - lengths[which]
    stroke, *columns = np.concatenate(rows)[np.arange(len(machine)) + (begins - own)[machine]].T
    return machine, stroke.astype(np.intp), Segment(*columns)


def _dead_centre(mechanism: Mechanism, number: Indices) -> Array:
    """Return the crank angles in degrees (n,) at which strokes begin; strokes count from 0 on."""
    return np.asarray(360.0 * (number // 2) + np.where(number % 2 == 0, *mechanism.dead_centres()))


Pressure = Union[CardPressure, TracePressure]


class PistonGas:
    """The pressures on both sides of one piston that has an indicator.

    head, crank: of the two ends, None for an end that is open to the ambient. cycle: degrees of its own cycle, which is
    run through `repeats` times in that of the cylinder. count: of machines, None for one.
    """

    def __init__(
        self, piston: Piston, mechanism: Mechanism, cycle: float, ambient: float, repeats: int, count: int | None
    ) -> None:
        indicator = piston.indicator
        assert indicator is not None
        at_head = Setting(mechanism, cycle, True, ambient, indicator.absolute)
        at_crank = at_head._replace(head_end=False, mirrored=indicator.crank_end is indicator.head_end)
        self.piston, self.stroke, self.repeats = piston, mechanism.stroke, repeats
        self.absolute, self.base = indicator.absolute, at_head.base
        self._cycle = cycle
        self.head = _pressure_in(indicator.head_end, at_head, count)
        self.crank = _pressure_in(indicator.crank_end, at_crank, count)

    @property
    def ends(self) -> tuple[tuple[Pressure, float], ...]:
        """The chambers that have pressures, with their areas in m²."""
        both = ((self.head, self.piston.head_area), (self.crank, self.piston.crank_area))
        return tuple((end, area) for end, area in both if end is not None)

    @property
    def starts(self) -> list[Angles]:
        """Where each pressure bends or jumps in the cylinder's cycle."""
        turns = range(self.repeats)
        return [
            one.starts._replace(degrees=one.starts.degrees + k * self._cycle) for k in turns for one, _ in self.ends
        ]

    @cached_property
    def works(self) -> tuple[Any, ...]:
        """Indicated work in J per cycle of the cylinder of head end and crank end: A s ∮ p dz."""
        return tuple(area * self.stroke * self.repeats * end.area for end, area in self.ends)

    @cached_property
    def work(self) -> Any:
        """Indicated work in J per cycle."""
        return total(*self.works)

    @property
    def traced(self) -> tuple[float, float] | None:
        """Indicated work in J of the ends that have a trace, and its change per radian of angle; None without."""
        found = [
            (area * end.area, area * end.area_by_angle) for end, area in self.ends if isinstance(end, TracePressure)
        ]
        way = self.stroke * self.repeats
        return (way * sum(w for w, _ in found), way * sum(d for _, d in found)) if found else None

    @property
    def noise(self) -> float:
        """Standard deviation in N of the noise that traces bring into the force."""
        return math.hypot(*(end.noise * area for end, area in self.ends if isinstance(end, TracePressure)))

    @cached_property
    def clearance_volumes(self) -> tuple[Any, Any]:
        """Smallest volumes in m³ of head end and crank end; 0 where one is not known."""
        indicator = self.piston.indicator
        chambers = (indicator.head_end, indicator.crank_end) if indicator else (None, None)
        head, crank = (getattr(chamber, "clearance", None) for chamber in chambers)
        return (
            0.0 if head is None else head * self.piston.head_area * self.stroke,
            0.0 if crank is None else crank * self.piston.crank_area * self.stroke,
        )

    @property
    def swept_volume(self) -> Any:
        """Volume in m³ swept in the chambers that have pressures."""
        return sum(area for _, area in self.ends) * self.stroke


def _pressure_in(chamber: Any, setting: Setting, count: int | None) -> Pressure | None:
    if chamber is None:
        return None
    if isinstance(chamber, Trace):
        return TracePressure(chamber, setting)
    return CardPressure(chamber, setting, count)
