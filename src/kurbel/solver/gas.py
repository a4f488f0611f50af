"""Pressures in the chambers of a cylinder, and force and work of gas, steam or water on the pistons.

An indicator card is a process over the stroke fraction z, from the chamber's smallest volume on, of segments that are
straight or p V^n = const. Ideal cards follow from the parameters of a theoretical cycle. Segments are selected by crank
angle, not by displacement, so that each side of a vertical jump is exact. The work A s ∮ p dz has closed form:

    straight      (p + p′)/2 · (z′ − z)
    p V^n         P V ln(V′/V) (e^u − 1)/u − p_a (z′ − z),  u = (1 − n) ln(V′/V),  P = p + p_a absolute,
                  V = z + clearance, p_a: 0 for absolute pressures, else the ambient pressure

A measured trace is in `kurbel.traces.pressure`. The force is P = p_H A_H − p_C A_C (R 296), gauge pressures.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import cached_property
from itertools import pairwise
from typing import TYPE_CHECKING, ClassVar, Literal, NamedTuple, Union

import numpy as np

from kurbel.arrays import Array, Indices, Number
from kurbel.crank_angle import CYCLES, within_cycle
from kurbel.errors import UsageError
from kurbel.machine.batch import changed, taken, varies
from kurbel.machine.indicator import STROKES, Card, Chamber, Rectangle, levels_of_strokes
from kurbel.machine.parts import Piston
from kurbel.mechanisms import Mechanism
from kurbel.mechanisms.setting import Setting
from kurbel.numerics.arithmetic import some, spread, total
from kurbel.numerics.extreme import Extreme, largest
from kurbel.numerics.pieces import Angles
from kurbel.solver.figures import result

if TYPE_CHECKING:
    from kurbel.machine.ideal_cards import IdealCard
    from kurbel.solver.wiebe import WiebeHeat, WiebePressure
    from kurbel.traces.heat import Released
    from kurbel.traces.pressure import TracePressure

_NO_WIDTH = 1e-10
"""Degrees of crank angle: a segment over less is a jump."""
_STEEP = 1e-3
"""Fraction of the stroke: a segment over less is so steep that the rounding of z matters."""
_ROUNDING = 3e-13
"""Degrees of crank angle by which the angle of a corner may be off: a few units in the last place of 720."""
_BITS = 100
"""Binary places of pressures and of stroke fractions in whole numbers, far more than there are."""

# the process of a chamber


class Process:
    """The pressure in a chamber over one cycle, from the (firing) dead centre on.

    lines: (n, 6), in the order of the process without vertical jumps: number of the stroke, stroke fraction z and
    pressure p in Pa where a line begins, both where it ends, and n of p V^n = const between them with absolute
    pressures, 0 for a straight line. lift: pressure in Pa to be added for absolute pressures; clearance: clearance
    volume over stroke volume.
    """

    def __init__(self, lines: Array, lift: float = 0.0, clearance: float = math.inf) -> None:
        self.lines = lines
        self.lift = lift
        self.clearance = clearance

    @cached_property
    def area(self) -> float:
        """∮ p dz in Pa in closed form; straight lines in whole numbers: cards of nearly no area lose no digits."""
        straight, curved = 0, list[float]()
        for _, z, p, next_z, next_p, exponent in self.lines.tolist():
            if exponent:
                grown = float(growth(z, next_z - z, self.clearance))
                u = (1 - exponent) * grown
                mean = math.expm1(u) / u if u else 1.0
                curved.append((p + self.lift) * (z + self.clearance) * grown * mean)
                curved.append(-self.lift * (next_z - z))
            else:
                heights = _in_bits(p) + _in_bits(next_p)
                straight += heights * (_in_bits(next_z) - _in_bits(z))
        return math.fsum((math.ldexp(straight, -2 * _BITS - 1), *curved))


def growth(z: Number, distance: Number, clearance: Number) -> Number:
    """Return ln(V′/V) between stroke fractions z and z + distance.

    As ±ln(1 + |V′ − V|/min(V, V′)), which is accurate both for steep lines and for small clearances.

    >>> round(float(growth(1.0, -1.0, 1.0)), 9)
    -0.693147181
    """
    return np.where(distance < 0, -1.0, 1.0) * np.log1p(
        np.abs(distance) / (np.minimum(z, z + distance) + clearance)
    )


ProcessLine = tuple[int, float, float, float, float, float]
"""One of the lines of a `Process`."""


def _in_bits(number: float) -> int:
    """Return a number as a multiple of the smallest step that cards are computed in."""
    return int(math.ldexp(number, _BITS))


def process_in(
    chamber: Card | Rectangle | IdealCard,
    lift: float = 0.0,
    cycle: float = 360.0,
    base: float = 0.0,
) -> Process:
    """Return the process of a card.

    lift: to be added to its pressures for absolute, base: to be subtracted for gauge pressures, in Pa; cycle: degrees.
    """
    clearance = math.inf
    if isinstance(chamber, Card):
        if chamber.interpolate != "linear" and chamber.clearance is not None:
            clearance = chamber.clearance
        lines = list(_drawn_lines(chamber, lift, clearance))
    elif isinstance(chamber, Rectangle):
        lines = list(_level_lines(chamber, cycle, base))
    else:
        from kurbel.solver.ideal_process import ideal_lines

        clearance = chamber.clearance
        lift, lines = ideal_lines(chamber, lift, four_stroke=cycle == 720.0)
    with_width = [line for line in lines if line[3] != line[1]]
    return Process(np.array(with_width), lift, clearance)


def _drawn_lines(card: Card, lift: float, clearance: float) -> Iterator[ProcessLine]:
    """Yield the lines between the points of a card: straight, or polytropes where its clearance is known."""
    for stroke, line in enumerate(card.lines):
        for (z, p), (next_z, next_p) in pairwise(zip(line.fractions, line.pressures)):
            exponent = 0.0
            if next_z != z and not math.isinf(clearance):
                fall = math.log((p + lift) / (next_p + lift))
                exponent = fall / float(growth(z, next_z - z, clearance))
            yield stroke, z, p, next_z, next_p, exponent


def _level_lines(rectangle: Rectangle, cycle: float, base: float) -> Iterator[ProcessLine]:
    """Yield a level line for each stroke; the mean pressure is that of the stroke that drives, or is driven."""
    level = base if rectangle.level is None else rectangle.level
    above = {"expansion": max(rectangle.mean, 0.0), "compression": max(-rectangle.mean, 0.0)}
    names = next(names for word, names in STROKES.items() if 360.0 * CYCLES[word] == cycle)
    for stroke, name in enumerate(names):
        pressure = level + above.get(name, 0.0)
        yield stroke, float(stroke % 2), pressure, float(1 - stroke % 2), pressure, 0.0


# over the crank angle


class HeatOfEnd(NamedTuple):
    """The heat that is released in one chamber, the chamber, and its indicated work in J per cycle."""

    released: Released | WiebeHeat
    setting: Setting
    work: Number

    def burnt(self, degrees: Array, within: Array, machine: Indices | None = None) -> Array:
        """Return the burnt share x_b at crank angles in degrees of these machines; `within`: the side of its fall to 0."""
        return self.released.burnt_at(self._after(degrees, within, machine), machine)

    def rate(self, degrees: Array, within: Array, machine: Indices | None = None) -> Array:
        """Return the heat in J that is released over the degree around crank angles of these machines."""
        return self.released.rate_at(self._after(degrees, within, machine), machine)

    def _after(self, degrees: Array, within: Array, machine: Indices | None) -> Array:
        """Return the degrees from the firing dead centre, in the cycle of the heat that holds `within`."""
        setting = self.setting if machine is None else taken(self.setting, machine)
        end = spread(self.released.end_of_cycle(self.setting.cycle), machine)
        passed = within - setting.own_dead_centre - end
        begin = setting.own_dead_centre + setting.cycle * (np.floor(passed / setting.cycle) + 1)
        return np.asarray(degrees - begin)


class CardPressure:
    """Gauge pressure in one chamber from a process over the stroke, or in those of many machines.

    traced: it is no trace; releases: nor has it a heat release; by_stroke: it follows the stroke. mirrored: the
    pressure at the other end, which has the same process. steep: whether a line is so steep that the rounding of z
    counts; starts: where lines begin.
    """

    traced: ClassVar[Literal[False]] = False
    releases: ClassVar[bool] = False
    by_stroke: ClassVar[Literal[True]] = True

    def __init__(
        self,
        chamber: Card | Rectangle | IdealCard,
        setting: Setting,
        count: int | None,
        mirrored: CardPressure | None,
    ) -> None:
        self.setting, self._count = setting, count
        cycle = setting.cycle
        self._processes: list[Process]
        self._which: Indices
        if mirrored:
            self._processes = mirrored._processes
            self._which = mirrored._which
        else:
            self._processes, self._which = _processes(chamber, setting, count)

        # lines at the same angles in all machines are kept once
        alike = self._alike = len(self._processes) == 1 and not varies(setting.mechanism)
        which = self._which[:1] if alike else self._which
        self._machine, rows = _over_the_angle(self._processes, which, setting, alike)
        self._begins, self._ends, z, p, next_z, self._next_p, exponent = rows
        self._p = p
        rise = (self._next_p - p) / (next_z - z)
        self._rows = np.stack((z, p, next_z, exponent, rise, self._begins, self._ends))
        self._keys = self._machine * (2 * cycle) + self._begins
        self._first = np.searchsorted(self._machine, np.arange(len(which)))
        self._straight = not exponent.any()
        self._level = self._straight and np.array_equal(p, self._next_p)
        self.steep = bool((np.abs(next_z - z) < _STEEP).any())
        machines = count if alike and count else 1
        machine = np.repeat(np.arange(machines), len(z)) if alike else self._machine
        self.starts = Angles(machine, np.tile(self._begins, machines))

    def released(self, area: Number) -> None:
        """Return the heat released over a piston of this area: none."""
        return None

    @property
    def area(self) -> Number:
        """∮ p dz over the stroke fraction z in Pa, per cycle, closed."""
        areas = np.array([process.area for process in self._processes])
        if len(areas) == 1:
            return float(areas[0])
        return areas[self._which]

    @cached_property
    def highest(self) -> Extreme:
        """The highest gauge pressure in Pa, and the first crank angle in degrees of the cycle that has it."""
        best = np.maximum.reduceat(np.maximum(self._p, self._next_p), self._first)
        until = np.where(self._ends > self._begins, self._ends, self._ends + self.setting.cycle)
        level = best[self._machine]
        at_end = np.where(self._next_p == level, until, np.inf)
        angles = np.where(self._p == level, self._begins, at_end)
        first = np.minimum.reduceat(angles, self._first)
        pressure, degrees, _ = np.broadcast_arrays(
            best - self.setting.base, first, np.empty(self._count or 1)
        )
        return Extreme(result(pressure, self._count), result(degrees, self._count))

    def at(
        self,
        z: Array,
        degrees: Array,
        within: Array,
        machine: Indices | None,
        remaining: Array | None = None,
    ) -> Array:
        """Return the gauge pressure in Pa where z of the stroke is passed, on the segments that hold `within` (n,).

        z, degrees: (n,), or (nodes, n) of pieces, each of which one segment holds; machine: of each, (n,); remaining:
        1 − z with all its digits, of which steep lines near the outer dead centre need every one. Where no pressure
        varies along any segment, it is (n,) for pieces, too.
        """
        setting = self.setting
        number = np.zeros(1, dtype=np.intp) if machine is None or self._alike else machine

        # the line that each angle is on; before its first line a machine is on its last
        turned = within_cycle(within, setting.cycle)
        row = np.searchsorted(self._keys, number * (2 * setting.cycle) + turned, side="right") - 1
        last = np.append(self._first[1:], len(self._keys))[number] - 1
        row = np.where(row < self._first[number], last, row)
        begin, p, next_z, exponent, rise, begins, ends = self._rows[:, row]
        base = spread(setting.base, machine)
        if self._level:
            return np.asarray(p - base)

        passed, rest = (z, remaining) if setting.head_end else (remaining, z)
        distance = (1 - z if passed is None else passed) - begin
        if remaining is not None:
            distance = np.where(begin > 0.5, (1 - begin) - rest, distance)
        # angles of corners are rounded, lines may be steep: at corners the pressure is exactly the card's; of a piece
        # only the first and the last node may be there
        edges = np.s_[:: len(distance) - 1] if distance.ndim > 1 else np.s_[:]
        turned = within_cycle(degrees[edges], setting.cycle)
        for corner, corner_distance in ((ends, next_z - begin), (begins, 0.0)):
            is_there = np.abs(turned - corner) <= _ROUNDING
            distance[edges] = np.where(is_there, corner_distance, distance[edges])
        straight: Array = (p - base) + rise * distance
        if self._straight:
            return straight

        # polytropes; what is straight may begin without any volume
        lifts = np.array([process.lift for process in self._processes])
        clearances = np.array([process.clearance for process in self._processes])
        process = 0 if len(lifts) == 1 or machine is None else self._which[machine]
        lift = lifts[process]
        is_curved = exponent != 0
        clearance = np.where(is_curved, clearances[process], 1.0)
        power = (p + lift) * np.exp(growth(begin, distance, clearance) * -exponent)
        return np.where(is_curved, power - lift - base, straight)


def _processes(
    chamber: Card | Rectangle | IdealCard, setting: Setting, count: int | None
) -> tuple[list[Process], Indices]:
    """Return the different processes in a chamber, and which of them each machine has, (machines,)."""
    which = np.zeros(count or 1, int)
    chambers = [chamber]
    if varies(chamber):
        which = np.arange(count or 1)
        chambers = [_of_machine(chamber, number) for number in which.tolist()]
    numbers = np.stack(np.broadcast_arrays(which.astype(float), setting.lift, setting.base))
    different, of_machines = np.unique(numbers, axis=1, return_inverse=True)
    processes = []
    for number, lift, base in different.T.tolist():
        processes.append(process_in(chambers[int(number)], lift, setting.cycle, base))
    return processes, of_machines.ravel()


def _of_machine(chamber: Card | Rectangle | IdealCard, number: int) -> Card | Rectangle | IdealCard:
    """Return the chamber of one of many machines."""
    return changed(chamber, lambda numbers: numbers[number].item())


def _over_the_angle(
    processes: list[Process], which: Indices, setting: Setting, alike: bool
) -> tuple[Indices, Array]:
    """Return whose each line is, and in the order of the angle begin and end in degrees, z, p, z′, p′, n, (7, n).

    which: the process of each machine. Those over no width, being jumps, are left out. alike: the lines are at the same
    angles in all machines, and are returned for one. One process of many machines is elsewhere in each.
    """
    lengths = np.array([len(process.lines) for process in processes])
    machine = np.repeat(np.arange(len(which)), lengths[which])
    shift = (np.cumsum(lengths) - lengths)[which] - (np.cumsum(lengths[which]) - lengths[which])
    lines = np.concatenate([process.lines for process in processes])[
        np.arange(len(machine)) + shift[machine]
    ]
    stroke = lines[:, 0].astype(np.intp)
    z = lines[:, 1]

    # the crank end begins its process at the outer dead centre, one stroke later
    number = stroke if setting.head_end else stroke + 1
    mechanism = setting.mechanism if alike else taken(setting.mechanism, machine)
    inner, outer = mechanism.dead_centres()
    turn = 360.0 * (number // 2)
    begin = turn + np.where(number % 2 == 0, inner, outer)
    end = 360.0 * ((number + 1) // 2) + np.where(number % 2 == 0, outer, inner)

    # a later line of a stroke begins where the stroke has come to its corner
    edges = begin.copy()
    fraction = z if setting.head_end else 1 - z
    is_later = np.append(False, (stroke[1:] == stroke[:-1]) & (machine[1:] == machine[:-1]))
    for outstroke in (True, False):
        inside = np.flatnonzero(is_later & ((number % 2 == 0) == outstroke))
        if len(inside):
            moved = mechanism if alike else taken(setting.mechanism, machine[inside])
            angle = moved.crank_angles_at(fraction[inside] * moved.stroke, outstroke)
            edges[inside] = turn[inside] + angle
    ends = np.where(np.append(is_later[1:], False), np.append(edges[1:], 0.0), end)

    # next to the other end of the stroke rounding may turn two angles round
    wide = np.mod(ends - edges + 1, 360.0) - 1 > _NO_WIDTH
    machine, stroke, begin, edges = machine[wide], stroke[wide], begin[wide], edges[wide]
    is_first = np.append(True, (stroke[1:] != stroke[:-1]) | (machine[1:] != machine[:-1]))
    angles = np.mod(np.where(is_first, begin, edges), setting.cycle)
    order = np.lexsort((angles, machine))
    angles, machine = angles[order], machine[order]
    following = np.append(np.arange(1, len(angles)), 0)
    last = np.append(machine[1:] != machine[:-1], True)
    following[last] = np.flatnonzero(np.append(True, last[:-1]))
    return machine, np.stack((angles, angles[following], *lines[wide][order, 1:].T))


Pressure = Union[CardPressure, "WiebePressure", "TracePressure"]


def _pressure(
    chamber: Chamber,
    setting: Setting,
    area: Number,
    count: int | None,
    mirrored: CardPressure | None,
) -> Pressure:
    """Return the pressure over the crank angle that a card or a trace shows; area: of the piston in m²."""
    if chamber.traced:
        from kurbel.traces.pressure import TracePressure

        return TracePressure(chamber, setting)
    if not chamber.by_stroke:
        from kurbel.solver.wiebe import WiebePressure

        return WiebePressure(chamber, setting, area, count)
    return CardPressure(chamber, setting, count, mirrored)


class PistonGas:
    """The pressures on both sides of one piston that has an indicator.

    head, crank: of the two ends, None for an end that is open to the ambient; ends: those that have pressures, with
    their areas in m². cycle: degrees of its own cycle, which is run through `repeats` times in that of the cylinder.
    count: of machines, None for one. number: of the piston in the cylinder. base: in Pa, to be subtracted from those of the file for gauge pressures;
    swept_volume: in m³, in the chambers that have pressures; starts: where each pressure bends or jumps in the
    cylinder's cycle; areas: at head end and crank end in m², of a piston by a lever reduced to the crosshead, turned:
    whether it moves against that; clearance_volumes: smallest volumes in m³ of head end and crank end, 0 where one is
    not known.
    """

    def __init__(
        self,
        piston: Piston,
        mechanism: Mechanism,
        cycle: float,
        ambient: float,
        repeats: int,
        count: int | None,
        number: int = 0,
    ) -> None:
        indicator = piston.indicator
        assert indicator is not None
        ratio, self.turned = piston.lever_ratio, some(piston.lever_ratio < 0)
        if self.turned and some(ratio > 0):
            raise UsageError(
                "pistons that move with the crosshead and against it are computed apart"
            )
        at_head = Setting(mechanism, cycle, not self.turned, ambient, indicator.absolute)
        at_crank = at_head._replace(
            head_end=self.turned, mirrored=indicator.crank_end is indicator.head_end
        )
        self.piston, self.stroke, self.repeats = piston, mechanism.stroke, repeats
        self.number = number
        self.absolute, self.base = indicator.absolute, at_head.base
        self.role = indicator.role
        head_area: Number = piston.head_area * abs(ratio)
        crank_area: Number = piston.crank_area * abs(ratio)
        self.areas = head_area, crank_area
        self.head: Pressure | None = None
        self.crank: Pressure | None = None
        if indicator.head_end is not None:
            self.head = _pressure(indicator.head_end, at_head, head_area, count, None)
        if indicator.crank_end is not None:
            same = self.head if at_crank.mirrored and isinstance(self.head, CardPressure) else None
            self.crank = _pressure(indicator.crank_end, at_crank, crank_area, count, same)

        self.ends: list[tuple[Pressure, Number]] = []
        for pressure, area in zip((self.head, self.crank), self.areas):
            if pressure is not None:
                self.ends.append((pressure, area))
        self._traces = [(end, area) for end, area in self.ends if end.traced]
        self.has_trace = bool(self._traces)
        self.releases_heat = any(end.releases for end, _ in self.ends)
        self.swept_volume: Number = sum(area for _, area in self.ends) * self.stroke
        self.starts = []
        for turn in cycle * np.arange(repeats):
            for end, _ in self.ends:
                self.starts.append(Angles(end.starts.machine, end.starts.degrees + turn))
        self.clearance_volumes: list[Number] = []
        chambers = (indicator.head_end, indicator.crank_end)
        for chamber, pressure, area in zip(chambers, (self.head, self.crank), self.areas):
            clearance = chamber.clearance if chamber else None
            if pressure is not None and pressure.traced:  # by the smallest volume of a file, say
                clearance = pressure.trace.clearance
            volume = 0.0 if clearance is None else clearance * area * self.stroke
            self.clearance_volumes.append(volume)

    @property
    def compresses_gas(self) -> bool:
        """Whether the piston, if it is driven, compresses a gas: by its card, its role, or the shape of its pressures.

        A liquid has one pressure on each stroke; a combustion engine and a steam engine may be driven, too.
        """
        chambers = list(self.piston.chambers.values())
        if any(chamber.compresses for chamber in chambers):
            return True
        if self.role is not None:
            return self.role == "compressor"
        if any(chamber.burns or chamber.by_steam for chamber in chambers):
            return False
        return any(levels_of_strokes(chamber) is None for chamber in chambers)

    @cached_property
    def works(self) -> tuple[Number, ...]:
        """Indicated work in J per cycle of the cylinder of head end and crank end: A s ∮ p dz."""
        return tuple(area * self.stroke * self.repeats * end.area for end, area in self.ends)

    @cached_property
    def work(self) -> Number:
        """Indicated work in J per cycle."""
        return total(*self.works)

    @property
    def traced(self) -> tuple[float, float] | None:
        """Indicated work in J of the ends that have a trace, and its change per radian of angle; None without."""
        if not self._traces:
            return None
        distance = self.stroke * self.repeats
        work = sum(area * end.area for end, area in self._traces)
        by_angle = sum(area * end.area_by_angle for end, area in self._traces)
        return distance * work, distance * by_angle

    @cached_property
    def steepest(self) -> Extreme | None:
        """Largest rise of pressure in Pa per degree at an end where it is over the crank angle; None without any."""
        rises = [end.steepest for end, _ in self.ends if not end.by_stroke]
        return largest(*rises) if rises else None

    @cached_property
    def heat(self) -> HeatOfEnd | None:
        """The heat release of the first end that has one."""
        for end, area in self.ends:
            released = end.released(area)
            if released is not None:
                return HeatOfEnd(released, end.setting, area * self.stroke * end.area)
        return None

    @property
    def wanders(self) -> bool:
        """Whether measured cycles at one of its ends wander against each other."""
        return any(end.wanders for end, _ in self._traces if end.traced)

    @property
    def noise(self) -> float:
        """Standard deviation in N of the noise that traces bring into the force."""
        return math.hypot(*(end.noise * area for end, area in self._traces))
