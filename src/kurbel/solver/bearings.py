"""What every pin and main bearing carries over the cycle, and what of their surfaces is never loaded.

A load is complex, outward along the axis of a frame and 90° on in the sense of rotation:

    throw    turns with the crank:   F = −D + iT, of a main bearing as crank 1 turns
    engine   the stroke line of cylinder 1 outward:   F e^{iφ} e^{iγ}, γ from there to the stroke line
    rod      the line of the rod, crank pin to crosshead:   F e^{iφ} e^{iψ}

Crank pin and journal stand still in the frame of the throw, crosshead pin and main shell in that of the engine, the
shells in the rod in that of the rod. Pin and shell count as touching 60° to either side of the load.
"""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Iterator, Sequence
from functools import cached_property, lru_cache, partial
from typing import Any, NamedTuple

import numpy as np

from kurbel import crank_formulas as formulas
from kurbel.arrays import Array, ComplexArray, Indices
from kurbel.crank_angle import CrankAngle, unit_vector
from kurbel.errors import UsageError
from kurbel.machine import Cylinder, Machine
from kurbel.machine.batch import taken
from kurbel.machine.cylinder import work_alike
from kurbel.numerics.extreme import Extreme, Extremes
from kurbel.numerics.lobatto import chebyshev, rule
from kurbel.numerics.pieces import Pieces, common, resolved
from kurbel.solver.drive import Drive
from kurbel.solver.figures import Columns, Results
from kurbel.solver.forces import CylinderForces
from kurbel.solver.shaft import ShaftLine, Vector, shaft_obstacle
from kurbel.solver.state import State, on_crosshead_pin, on_pin

FRAMES = ("throw", "engine", "rod")
HALF_CONTACT = 60.0
"""Degrees to either side of a load over which pin and shell are taken to touch."""
_NO_LOAD = 1e-12
"""Of the largest load: what is smaller is rounding and has no direction."""
_TINIEST = 1e-300
_SURE = 100.0
"""By so much of its share of the largest load a smaller one counts where its direction is to be a polynomial."""
_ALONG = 1e-13
"""Of the largest load: what rounding leaves across the axis of a frame."""
_ON_AXIS = 1e-12
"""Degrees by which rounding turns a load aside that is along the axis of a frame, as that of a rod without mass."""
_EQUAL = 1e-6
"""Degrees by which rounding may move the ends of an arc, where next to no load decides them."""


class Follower(NamedTuple):
    """A cylinder at the angles φ of crank 1: its own crank is at φ − position, in degrees.

    forces: of the first of the cylinders that work alike.
    """

    forces: CylinderForces
    cylinder: Cylinder
    position: Any

    @property
    def drive(self) -> Drive:
        """The cylinder made ready for the solver."""
        return self.forces.drive

    def at(self, degrees: Array, within: Array) -> State:
        """Return the state at angles (n,) of crank 1, on the sides of jumps that hold `within`."""
        return State.at(self.drive, degrees - self.position, within - self.position)


class Size(NamedTuple):
    """Diameter and length in m, None where they are not given."""

    diameter: Any
    length: Any


class _Cycle(NamedTuple):
    """The cycle of a load in N on pieces: its magnitude, and the load as its two surfaces see it."""

    pieces: Pieces
    load: Array
    on_journal: ComplexArray
    on_shell: ComplexArray


class Bearing(Results):
    """A pin or a main bearing at the angles of crank 1. Attributes are named by the ids of the key values, in SI.

    name: as it is printed; followed: the cylinders that load it; size; journal, shell: the frames in which its two
    surfaces stand still; contact: degrees from the direction of the load to where they touch; of_rod: whether a rod
    of a cylinder turns on it. Of many machines all key values are arrays (machines,).
    """

    command = "bearings"
    journal: str
    shell: str
    contact = 180.0
    of_rod = False

    def __init__(self, name: str, followed: Sequence[Follower], size: Size) -> None:
        self.name, self.followed, self.size = name, tuple(followed), size
        self.count, self.omega = followed[0].drive.count, followed[0].drive.omega

    @abstractmethod
    def _frames(self, degrees: Array, within: Array) -> dict[str, ComplexArray]:
        """Return the load in N of the only machine in each of its frames at angles (n,) in degrees."""

    @abstractmethod
    def _sampled(self) -> tuple[Pieces, ComplexArray, ComplexArray]:
        """Return pieces of the cycle, and the load in the frames of journal and shell."""

    @property
    @abstractmethod
    def _rate(self) -> tuple[Extreme, Any]:
        """By how much its surfaces turn on one another, over that of the crank: the largest, and the mean over time."""

    @property
    @abstractmethod
    def work_rubbing(self) -> Any:
        """Work of its friction in J per cycle of the machine; None without a coefficient."""

    def _columns(self, phi: Array, within: Array) -> Columns:
        """Return the load in N, and its direction in degrees in each frame; None without it."""
        found = self._frames(phi, within)

        def direction(frame: str) -> Array | None:
            return _axial(np.degrees(np.angle(found[frame])), _ON_AXIS) if frame in found else None

        directions = {f"load_{frame}": partial(direction, frame) for frame in FRAMES}
        return Columns(phi, {"load": lambda: np.abs(next(iter(found.values()))), **directions})

    # the cycle

    @cached_property
    def _cycle(self) -> _Cycle:
        pieces, journal, shell = self._sampled()
        fine, load, (x, y, shell_x, shell_y) = _with_magnitude(pieces, journal, (shell.real, shell.imag))
        return _Cycle(fine, load, x + 1j * y, shell_x + 1j * shell_y)

    def _told(self, values: Array) -> Any:
        """Return what was found of every machine (machines,), or of the only one as a number."""
        return float(values[0]) if self.count is None else values

    @property
    def breaks(self) -> Array:
        """The crank angles in degrees of the only machine between which every quantity is smooth."""
        return np.append(self._cycle.pieces.low, self._cycle.pieces.cycle)

    def _extremes_of(self, pieces: Pieces, values: Array) -> Extremes:
        """Return the extremes of samples (nodes, pieces)."""
        return pieces.extremes(values[None]).each(self._told)[0]

    @cached_property
    def _load(self) -> Extremes:
        return self._extremes_of(self._cycle.pieces, self._cycle.load)

    @property
    def load_max(self) -> Extreme:
        """Largest load in N."""
        return self._load.largest

    @property
    def load_min(self) -> Extreme:
        """Smallest load in N."""
        return self._load.smallest

    @cached_property
    def load_mean(self) -> Any:
        """Mean load in N over the time of a cycle."""
        return self._told(self._cycle.pieces.mean(self._cycle.load))

    @cached_property
    def load_high(self) -> Any:
        """Mean load in N over the time in which it exceeds half its largest."""
        whole, load = self._cycle.pieces, self._cycle.load
        largest = np.atleast_1d(self.load_max.value)
        pieces = whole.split(whole.zeros(load - whole.of(largest / 2), largest))
        load = load if pieces is whole else pieces.carried(load, whole)
        above = np.where(pieces.rule.weights @ load > pieces.of(largest), 1.0, 0.0)  # the weights sum to 2
        time, sums = pieces.integral(np.stack((np.broadcast_to(above, load.shape), load * above)))
        return self._told(np.where(largest == 0, 0.0, sums / np.where(time > 0, time, 1.0)))

    # the surfaces

    @cached_property
    def _of_journal(self) -> tuple[Array, Array]:
        return unloaded(self._cycle.pieces, self._cycle.on_journal, self.contact)

    @cached_property
    def _of_shell(self) -> tuple[Array, Array]:
        return unloaded(self._cycle.pieces, self._cycle.on_shell, self.contact)

    def _angle(self, degrees: Array) -> Any:
        """Return what was found of every machine, or of the only one; None where that is nothing."""
        found = self._told(degrees)
        return None if self.count is None and math.isnan(found) else found

    @property
    def unloaded_arc(self) -> Any:
        """Degrees of the surface of pin or journal that are never loaded; None where it is loaded nowhere."""
        return self._angle(self._of_journal[0])

    @property
    def unloaded_middle(self) -> Any:
        """Direction in degrees of the middle of its widest stretch; None without one."""
        return self._angle(self._of_journal[1])

    @property
    def unloaded_arc_shell(self) -> Any:
        """Degrees of the surface of the shell that are never loaded; None where it is loaded nowhere."""
        return self._angle(self._of_shell[0])

    @property
    def unloaded_middle_shell(self) -> Any:
        """Direction in degrees of the middle of its widest stretch; None without one."""
        return self._angle(self._of_shell[1])

    # pressures and rubbing

    @property
    def _area(self) -> Any:
        diameter, length = self.size
        return None if diameter is None or length is None else diameter * length

    @property
    def pressure_max(self) -> Extreme | None:
        """Largest load over d l in Pa."""
        return None if self._area is None else Extreme(self.load_max.value / self._area, self.load_max.degrees)

    @property
    def pressure_mean(self) -> Any:
        """Mean load over d l in Pa."""
        return None if self._area is None else self.load_mean / self._area

    @property
    def _surface_speed(self) -> Any:
        """ω d/2 in m/s."""
        return None if self.omega is None or self.size.diameter is None else self.omega * self.size.diameter / 2

    @property
    def rubbing_speed_max(self) -> Extreme | None:
        """Largest speed in m/s of one surface on the other."""
        if self._surface_speed is None:
            return None
        rate = self._rate[0]
        return Extreme(rate.value * self._surface_speed, rate.degrees)

    @property
    def rubbing_speed_mean(self) -> Any:
        """Mean speed in m/s of one surface on the other."""
        return None if self._surface_speed is None else self._rate[1] * self._surface_speed

    @property
    def pressure_velocity(self) -> Any:
        """Mean pressure times mean speed, p_m v in W/m²."""
        pressure, speed = self.pressure_mean, self.rubbing_speed_mean
        return None if pressure is None or speed is None else pressure * speed


class RodPin(Bearing):
    """A pin of a connecting rod; the load is that of the rod on the pin.

    pin: `crank_pin`, or `crosshead_pin`, which moves with the crosshead and so in the frame of the engine.
    """

    shell = "rod"
    of_rod = True

    def __init__(self, name: str, follower: Follower, size: Size, pin: str) -> None:
        super().__init__(name, (follower,), size)
        self._pin = pin
        self.journal = "throw" if pin == "crank_pin" else "engine"

    def _in_frames(self, state: State, bank: Any) -> dict[str, ComplexArray]:
        """Return the load in N in each of its frames; bank: e^{iγ} of its stroke line. N > 0 presses toward −i."""
        sin_psi, cos_psi = state.rod_angle or (0.0, 1.0)
        if self._pin == "crank_pin":
            radial, tangential = on_pin(state)
            own = {"throw": -radial + 1j * tangential}
            line = own["throw"] * (state.angle.cos + 1j * state.angle.sin)
        else:
            along, across = on_crosshead_pin(state)
            own, line = {}, along - 1j * across
        return {**own, "engine": line * bank, "rod": line * (cos_psi + 1j * sin_psi)}

    def _frames(self, degrees: Array, within: Array) -> dict[str, ComplexArray]:
        (own,) = self.followed
        return self._in_frames(own.at(degrees, within), unit_vector(own.cylinder.bank_angle))

    @cached_property
    def _pieces(self) -> Pieces:
        (own,) = self.followed
        return common([(own.forces.pieces, own.position)], _cycle_of(own.drive.machine))

    def _sampled(self) -> tuple[Pieces, ComplexArray, ComplexArray]:
        (own,) = self.followed
        frames = self._in_frames(own.forces.samples, own.forces.pieces.of(unit_vector(own.cylinder.bank_angle)))
        journal, shell = _carried(self._pieces, own, frames[self.journal], frames[self.shell])
        return self._pieces, journal, shell

    @cached_property
    def _rate(self) -> tuple[Extreme, Any]:
        """Of the crank pin 1 + dψ/dφ, of the crosshead pin dψ/dφ; see `Bearing`."""
        (own,) = self.followed
        state = own.forces.samples
        _, cos_psi = state.rod_angle or (0.0, 1.0)
        slope = formulas.rod_slope(state.angle.cos, cos_psi, state.drive.mechanism.lam)
        (rate,) = _carried(self._pieces, own, 1 + slope if self._pin == "crank_pin" else slope)
        return self._extremes_of(self._pieces, rate).peak, self._told(self._pieces.mean(np.abs(rate)))

    @property
    def work_rubbing(self) -> Any:
        """Work of its friction in J per cycle of the machine; None without a coefficient."""
        forces = self.followed[0].forces
        work = forces.pin_work_of(self._pin)
        return None if work is None else work * (forces.drive.machine.revolutions // forces.drive.revolutions)


class MainBearing(Bearing):
    """A main bearing under one throw, or under the two that it is between; the load is that of the shaft on it.

    number: along the shaft, from 0; every: all cylinders of the machine. Its throw frame is that of crank 1.
    """

    journal, shell, contact = "throw", "engine", 0.0

    def __init__(self, name: str, number: int, line: ShaftLine, every: Sequence[Follower], size: Size) -> None:
        self._throws = [throw for throw in line.throws if number in (throw.A, throw.B)]
        super().__init__(name, [every[index] for throw in self._throws for index in throw.cylinders], size)
        self._number, self._line, self._every = number, line, every

    def _force(self, line: ShaftLine, pins: dict[int, Vector], degrees: Array) -> ComplexArray:
        """Return the force in N in the frame of crank 1, whose angles in degrees these are.

        line: with the numbers of the machines whose angles they are; pins: forces of each cylinder on its crank pin.
        """
        force: Any = 0.0
        for throw in line.throws:
            if self._number not in (throw.A, throw.B):
                continue
            own = line.machine.cylinders[throw.cylinders[0]]
            position = np.fmod(own.crank_position, self._every[throw.cylinders[0]].drive.cycle)
            pin = Vector(*(sum(parts) for parts in zip(*(pins[index] for index in throw.cylinders))))
            both = line.carried(throw, pin, own, CrankAngle.of(degrees - position))
            carried = both[0] if self._number == throw.A else both[1]
            force = force + (-carried.D + 1j * carried.T) * unit_vector(throw.angle)
        return np.asarray(force)

    def _frames(self, degrees: Array, within: Array) -> dict[str, ComplexArray]:
        states = {one: self._every[one].at(degrees, within) for throw in self._throws for one in throw.cylinders}
        pins = {number: _on_pin_or_none(state) for number, state in states.items()}
        throw = np.broadcast_to(self._force(self._line, pins, degrees), degrees.shape)
        return {"throw": throw, "engine": throw * unit_vector(degrees)}

    def _on_pieces(self, rubbed: bool) -> tuple[Pieces, ComplexArray]:
        """Return pieces of the cycle and the force there; rubbed: with what the friction of the pins does to it."""
        machine = self._line.machine
        pieces = common([(one.forces.pieces, one.position) for one in self.followed], _cycle_of(machine))
        pins = {}
        for number in (number for throw in self._throws for number in throw.cylinders):
            own = self._every[number]
            radial, tangential = _on_pin_or_none(own.forces.samples if rubbed else own.forces.samples.unrubbed)
            (found,) = _carried(pieces, own, radial + 1j * tangential)
            pins[number] = Vector(found.real, found.imag)
        machine = machine if self.count is None else taken(machine, pieces.machine)
        assert machine.crankshaft is not None
        force = self._force(ShaftLine(machine, machine.crankshaft), pins, pieces.degrees)
        return pieces, np.broadcast_to(force, pieces.degrees.shape)

    def _sampled(self) -> tuple[Pieces, ComplexArray, ComplexArray]:
        pieces, force = self._on_pieces(rubbed=True)
        angle = CrankAngle.at_nodes(pieces)
        return pieces, force, force * (angle.cos + 1j * angle.sin)

    @property
    def _rate(self) -> tuple[Extreme, Any]:
        nowhere: Any = np.zeros(self.count or 1)
        return Extreme(1.0, self._told(nowhere)), 1.0

    @cached_property
    def work_rubbing(self) -> Any:
        """Work of its friction in J per cycle of the machine; None without a coefficient."""
        given = [one.cylinder.friction for one in self.followed]
        coefficient = next((one.journals for one in given if one and one.journals is not None), None)
        if coefficient is None or self.size.diameter is None:
            return None
        pieces, load, _ = _with_magnitude(*self._on_pieces(rubbed=False))
        return self._told(pieces.integral(load)) * coefficient * self.size.diameter / 2


def _on_pin_or_none(state: State) -> Vector:
    return on_pin(state) if state.drive.has_force else Vector(0.0, 0.0)


def _cycle_of(machine: Machine) -> float:
    return 360.0 * machine.revolutions


def _carried(pieces: Pieces, own: Follower, *columns: Any) -> list[Any]:
    """Return columns sampled on the pieces of a cylinder, complex or real, at the nodes of common ones."""
    source = own.forces.pieces
    whole = [np.broadcast_to(one, source.degrees.shape) for one in columns]
    if pieces is source:
        return whole
    parts = [part for one in whole for part in ((one.real, one.imag) if np.iscomplexobj(one) else (one,))]
    found = iter(pieces.carried(np.stack(parts), source, own.position))
    return [next(found) + 1j * next(found) if np.iscomplexobj(one) else next(found) for one in whole]


def _with_magnitude(pieces: Pieces, load: ComplexArray, others: Sequence[Array] = ()) -> tuple[Pieces, Array, Array]:
    """Return pieces on which magnitude and direction of a load are polynomials, the magnitude in N, and the parts.

    load: (nodes, pieces). The parts are those of the load and the others. On each piece the load lies within a quarter
    of a turn. The smaller a load, the less of its direction is left by rounding.
    """
    parts, largest = np.stack((load.real, load.imag, *others)), pieces.largest(np.abs(load))

    def both(some: Pieces, found: Array) -> Array:
        size, beside = np.hypot(*found[:2]), some.of(largest)
        towards = _directed(found[0] + 1j * found[1], beside)
        weakest = np.min(size, axis=0, where=size > _NO_LOAD * beside, initial=math.inf)
        share = np.where(np.isfinite(weakest), weakest / np.maximum(beside, _TINIEST), 0.0)
        weight = np.minimum(1.0, _SURE * share)
        return np.stack((size, towards.real * weight, towards.imag * weight))

    fine, values, parts = resolved(pieces, parts, parts[:2], np.stack((largest, largest)), both)
    return fine, values[0], parts


def _directed(load: ComplexArray, largest: Any) -> ComplexArray:
    """Return the directions of a load as unit vectors; where it vanishes at an end, that to which the inner nodes lead.

    load: in N, complex, (nodes, pieces); largest: of the machine of each piece.
    """
    size = np.abs(load)
    directions = load / np.maximum(size, _TINIEST)
    vanishing = size[[0, -1]] <= _NO_LOAD * largest
    if vanishing.any():
        directions[[0, -1]] = np.where(vanishing, _outward(len(load)) @ directions[1:-1], directions[[0, -1]])
    return directions


@lru_cache
def _outward(count: int) -> Array:
    """Return what extrapolates values at the inner nodes of so many to both ends, (2, count − 2)."""
    inner = rule(count).nodes[1:-1]
    return chebyshev(np.array([-1.0, 1.0]), count - 2) @ np.linalg.inv(chebyshev(inner, count - 2))


# what of a surface no load reaches


def unloaded(pieces: Pieces, load: ComplexArray, contact: float) -> tuple[Array, Array]:
    """Return the arc in degrees of a surface that a load never presses, and the middle of its widest stretch.

    load: in N, complex in the frame of the surface, (nodes, pieces), which turns by less than half a turn on a piece;
    contact: degrees from the direction of the load to where it presses. Each (machines,), nan where nothing presses,
    or all of it is pressed.
    """
    size = np.abs(load)
    largest = pieces.largest(size)[pieces.machine]
    pressed = size.max(axis=0) > _NO_LOAD * largest
    pieces, load, size, largest = pieces.taken(pressed), load[:, pressed], size[:, pressed], largest[pressed]
    along, across = (np.where(np.abs(x).max(axis=0) > _ALONG * largest, x, 0.0) for x in (load.real, load.imag))
    towards = _directed(along + 1j * across, largest)
    strongest = np.take_along_axis(towards, size.argmax(axis=0)[None], axis=0)
    direction = np.degrees(np.angle(towards * np.conj(strongest))) + np.degrees(np.angle(strongest))
    low, high = pieces.ranges(direction)
    return unreached(pieces.machine, low + contact - HALF_CONTACT, high + contact + HALF_CONTACT, pieces.count)


def unreached(machine: Indices, start: Array, end: Array, count: int) -> tuple[Array, Array]:
    """Return in degrees what of a circle arcs (n,) leave free, and the middle of its widest stretch, (count,).

    machine: whose each arc is, ascending. Of stretches equally wide it is the first from 0° on; nan where there is
    none, and for both where there is no arc.
    """
    each = np.bincount(machine, minlength=count)
    place = np.arange(len(machine)) - (np.cumsum(each) - each)[machine]
    begins, ends = np.full((count, each.max(initial=1)), math.inf), np.full((count, each.max(initial=1)), -math.inf)
    begins[machine, place] = np.mod(start, 360.0)
    ends[machine, place] = begins[machine, place] + (end - start)
    order = np.argsort(begins, axis=1)
    begins, ends = (np.take_along_axis(one, order, axis=1) for one in (begins, ends))
    begins, ends = (np.concatenate([one + turn for turn in (-360.0, 0.0, 360.0)], axis=1) for one in (begins, ends))
    begins = np.where(np.isfinite(begins), begins, 0.0)  # beyond the last arc, which no longer count
    gaps = begins[:, 1:] - np.maximum.accumulate(ends, axis=1)[:, :-1]
    gaps[(begins[:, 1:] <= 0) | (begins[:, 1:] > 360.0) | (gaps < 0)] = 0.0
    widest = np.argmax((gaps > 0) & (gaps > gaps.max(axis=1, keepdims=True) - _EQUAL), axis=1)
    row = np.arange(count)
    middle = begins[row, 1 + widest] - gaps[row, widest] / 2
    middle = _axial(middle - 360.0 * np.rint(middle / 360.0), _EQUAL)
    arc = np.where(each > 0, gaps.sum(axis=1), math.nan)
    return arc, np.where(arc > 0, middle, math.nan)


def _axial(directions: Array, rounding: float) -> Array:
    """Return directions (n,) in degrees, those along their axis but for this rounding as 0 or 180."""
    along = np.rint(directions / 180.0) * 180.0
    return np.where(np.abs(directions - along) <= rounding, np.abs(along), directions)


# all of them


class ShaftBearings:
    """What `kurbel bearings` computes. Raises UsageError where no cylinder has a force and a connecting rod."""

    def __init__(self, machine: Machine, cylinders: Sequence[CylinderForces]) -> None:
        self.machine, self._cylinders = machine, cylinders
        if not any(map(_loads, cylinders)):
            raise UsageError(
                f"{machine.name}: nothing loads a bearing: that needs a cylinder with a connecting rod, and a pressure "
                "or masses and a speed"
            )

    @property
    def obstacle(self) -> str:
        """Why there are no loads of main bearings, or an empty text."""
        return shaft_obstacle(self.machine)

    @cached_property
    def line(self) -> ShaftLine | None:
        """The throws on their bearings; None where that is not known."""
        shaft = self.machine.crankshaft
        return ShaftLine(self.machine, shaft) if shaft and not self.obstacle else None

    @cached_property
    def parts(self) -> tuple[Bearing, ...]:
        """Crank pin and crosshead pin of every cylinder, then the main bearings along the shaft."""
        return tuple(self._parts())

    def _followers(self) -> Iterator[Follower]:
        for forces in self._cylinders:
            own = forces.drive.cylinder
            first = next(one for one in self._cylinders if work_alike(one.drive.cylinder, own))
            # whole cycles are taken off, which is exact: beside a large position an angle would lose its digits
            yield Follower(first, own, np.fmod(own.crank_position, forces.drive.cycle))

    def _parts(self) -> Iterator[Bearing]:
        every = tuple(self._followers())
        for number, one in enumerate(every):
            if not _loads(one.forces):
                continue
            of = f" of {one.cylinder.name}" if len(every) > 1 else ""
            yield RodPin(f"crank pin{of}", one, self._pin_size(number), "crank_pin")
            yield RodPin(f"crosshead pin{of}", one, _crosshead_size(one.cylinder), "crosshead_pin")
        if self.line:
            names = "AB" if self.line.bearings == 2 else range(1, self.line.bearings + 1)
            for number, name in enumerate(names):
                yield MainBearing(f"bearing {name}", number, self.line, every, self._journal_size())

    def _pin_size(self, number: int) -> Size:
        """Return the size of a crank pin; rods side by side on one pin have equal parts of its length."""
        shaft, friction = self.machine.crankshaft, self.machine.cylinders[number].friction
        if shaft is None:
            return Size(friction.crank_pin_diameter if friction else None, None)
        rods = len(self.line.throw_of(number).cylinders) if self.line else 1
        return Size(shaft.pin_diameter, shaft.pin_length / rods)

    def _journal_size(self) -> Size:
        shaft = self.machine.crankshaft
        assert shaft is not None
        frictions = [one.friction for one in self.machine.cylinders if one.friction]
        diameters = (shaft.journal_diameter, *(one.journal_diameter for one in frictions))
        return Size(next((one for one in diameters if one is not None), None), shaft.journal_length)


def _crosshead_size(cylinder: Cylinder) -> Size:
    friction = cylinder.friction
    return Size(friction.crosshead_pin_diameter, friction.crosshead_pin_length) if friction else Size(None, None)


def _loads(forces: CylinderForces) -> bool:
    return forces.drive.has_force and bool(forces.drive.mechanism.has_rod)
