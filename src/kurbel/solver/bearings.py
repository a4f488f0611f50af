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
from functools import cached_property, lru_cache
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
from kurbel.quantity import column, key_value
from kurbel.solver.figures import AtAngles, Results, told
from kurbel.solver.forces import CylinderForces
from kurbel.solver.shaft import ShaftLine, Vector, shaft_obstacle
from kurbel.solver.state import State, on_crosshead_pin, on_pin

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

    def at(self, degrees: Array, within: Array) -> State:
        """Return the state at angles (n,) of crank 1, on the sides of jumps that hold `within`."""
        return State.at(self.forces.drive, degrees - self.position, within - self.position)

    def carried(self, pieces: Pieces, values: Any) -> Any:
        """Return what is sampled on the pieces of the cylinder, complex or real, at the nodes of common ones."""
        source = self.forces.pieces
        values = np.broadcast_to(values, source.degrees.shape)
        if pieces is source:
            return values
        if np.iscomplexobj(values):
            return self.carried(pieces, values.real) + 1j * self.carried(pieces, values.imag)
        return pieces.carried(values, source, self.position)


class Size(NamedTuple):
    """Diameter and length in m, None where they are not given."""

    diameter: Any
    length: Any


class BearingColumns(AtAngles):
    """The load of one bearing at crank angles φ (n,) in degrees; frames: complex in N, in each of its frames."""

    commands = ("bearings",)

    def __init__(self, phi: Array, frames: dict[str, ComplexArray]) -> None:
        self.phi, self._frames = phi, frames

    def _direction(self, frame: str) -> Array | None:
        found = self._frames.get(frame)
        return None if found is None else _axial(np.degrees(np.angle(found)), _ON_AXIS)

    @column("F_L", "force")
    def load(self) -> Array:
        """Load of a rod on its pin, or of the shaft on a main bearing."""
        return np.abs(next(iter(self._frames.values())))

    @column("ε_K", "angle")
    def load_throw(self) -> Array | None:
        """Direction of the load from its throw outward, of a main bearing from that of crank 1."""
        return self._direction("throw")

    @column("ε_M", "angle")
    def load_engine(self) -> Array | None:
        """Direction of the load from the stroke line of cylinder 1 outward."""
        return self._direction("engine")

    @column("ε_S", "angle")
    def load_rod(self) -> Array | None:
        """Direction of the load from the line of the rod, crank pin to crosshead."""
        return self._direction("rod")


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
    state = BearingColumns
    journal: str
    shell: str
    contact = 180.0
    of_rod = False

    def __init__(self, name: str, followed: Sequence[Follower], size: Size) -> None:
        self.name, self.followed, self.size = name, tuple(followed), size
        drive = followed[0].forces.drive
        self.count, self.omega = drive.count, drive.omega

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

    @abstractmethod
    def _work(self) -> Any:
        """Return the work of its friction in J per cycle of the machine; None without a coefficient."""

    def _columns(self, phi: Array, within: Array) -> BearingColumns:
        return BearingColumns(phi, self._frames(phi, within))

    # the cycle

    @cached_property
    def _cycle(self) -> _Cycle:
        pieces, journal, shell = self._sampled()
        fine, load, (x, y, shell_x, shell_y) = _with_magnitude(pieces, journal, (shell.real, shell.imag))
        return _Cycle(fine, load, x + 1j * y, shell_x + 1j * shell_y)

    def _extremes(self, pieces: Pieces, values: Array) -> Extremes:
        """Return the extremes of samples (nodes, pieces)."""
        return pieces.extremes(values[None]).each(lambda values: told(values, self.count))[0]

    @property
    def breaks(self) -> Array:
        """The crank angles in degrees of the only machine between which every quantity is smooth."""
        return np.append(self._cycle.pieces.low, self._cycle.pieces.cycle)

    @cached_property
    def _load(self) -> Extremes:
        return self._extremes(self._cycle.pieces, self._cycle.load)

    @key_value("F_L,max", "force")
    def load_max(self) -> Extreme:
        """Largest load."""
        return self._load.largest

    @key_value("F_L,min", "force")
    def load_min(self) -> Extreme:
        """Smallest load."""
        return self._load.smallest

    @key_value("F_L,m", "force")
    def load_mean(self) -> Any:
        """Mean load over time."""
        return told(self._cycle.pieces.mean(self._cycle.load), self.count)

    @key_value("F_L,m,½", "force")
    def load_high(self) -> Any:
        """Mean load while it exceeds half the largest."""
        whole, load = self._cycle.pieces, self._cycle.load
        largest = np.atleast_1d(self.load_max.value)
        pieces = whole.split(whole.zeros(load - whole.of(largest / 2), largest))
        load = load if pieces is whole else pieces.carried(load, whole)
        above = np.where(pieces.rule.weights @ load > pieces.of(largest), 1.0, 0.0)  # the weights sum to 2
        time, sums = pieces.integral(np.stack((np.broadcast_to(above, load.shape), load * above)))
        return told(np.where(largest == 0, 0.0, sums / np.where(time > 0, time, 1.0)), self.count)

    # the surfaces

    def _unloaded(self, load: ComplexArray) -> tuple[Any, ...]:
        """Return the arc in degrees of a surface that is never loaded, and its middle; None where there is none."""
        found = (told(one, self.count) for one in unloaded(self._cycle.pieces, load, self.contact))
        return tuple(None if self.count is None and math.isnan(one) else one for one in found)

    @cached_property
    def _of_journal(self) -> tuple[Any, ...]:
        return self._unloaded(self._cycle.on_journal)

    @cached_property
    def _of_shell(self) -> tuple[Any, ...]:
        return self._unloaded(self._cycle.on_shell)

    @key_value("Δε_Z", "angle")
    def unloaded_arc(self) -> Any:
        """Arc of the pin or journal that is never loaded.

        None where it is loaded nowhere.
        """
        return self._of_journal[0]

    @key_value("ε_Z", "angle")
    def unloaded_middle(self) -> Any:
        """Middle of its widest piece, in the frame of the pin."""
        return self._of_journal[1]

    @key_value("Δε_L", "angle")
    def unloaded_arc_shell(self) -> Any:
        """Arc of the shell that is never loaded."""
        return self._of_shell[0]

    @key_value("ε_L", "angle")
    def unloaded_middle_shell(self) -> Any:
        """Middle of its widest piece, in the frame of the shell."""
        return self._of_shell[1]

    # pressures and rubbing

    @property
    def _area(self) -> Any:
        """d l in m²; None where one is not given."""
        diameter, length = self.size
        return None if diameter is None or length is None else diameter * length

    @property
    def _surface_speed(self) -> Any:
        """ω d/2 in m/s."""
        return None if self.omega is None or self.size.diameter is None else self.omega * self.size.diameter / 2

    @key_value("p_L,max", "pressure")
    def pressure_max(self) -> Extreme | None:
        """Largest pressure, load over d l."""
        return None if self._area is None else Extreme(self.load_max.value / self._area, self.load_max.degrees)

    @key_value("p_L,m", "pressure")
    def pressure_mean(self) -> Any:
        """Mean pressure over time."""
        return None if self._area is None else self.load_mean / self._area

    @key_value("v_L,max", "velocity")
    def rubbing_speed_max(self) -> Extreme | None:
        """Largest speed of one surface on the other."""
        if self._surface_speed is None:
            return None
        largest, _ = self._rate
        return Extreme(largest.value * self._surface_speed, largest.degrees)

    @key_value("v_L,m", "velocity")
    def rubbing_speed_mean(self) -> Any:
        """Mean speed of one surface on the other."""
        return None if self._surface_speed is None else self._rate[1] * self._surface_speed

    @key_value("k_L", "pressure_velocity")
    def pressure_velocity(self) -> Any:
        """Mean pressure times mean speed, p v."""
        pressure, speed = self.pressure_mean, self.rubbing_speed_mean
        return None if pressure is None or speed is None else pressure * speed

    @key_value("A_f,L", "energy")
    def work_rubbing(self) -> Any:
        """Work lost by its friction per cycle."""
        return self._work()


class RodPin(Bearing):
    """A pin of a connecting rod; the load is that of the rod on the pin.

    pin: `crank_pin`, or `crosshead_pin`, which moves with the crosshead and so in the frame of the engine.
    """

    shell = "rod"
    of_rod = True

    def __init__(self, name: str, follower: Follower, size: Size, pin: str) -> None:
        super().__init__(name, (follower,), size)
        self._own, self._pin = follower, pin
        self.journal = "throw" if pin == "crank_pin" else "engine"

    def _in_frames(self, state: State, bank: Any) -> dict[str, ComplexArray]:
        """Return the load in N in each of its frames; bank: e^{iγ} of its stroke line. N > 0 presses toward −i."""
        sin_psi, cos_psi = state.rod_angle or (0.0, 1.0)
        own = {}
        if self._pin == "crank_pin":
            pin = on_pin(state)
            own["throw"] = -pin.D + 1j * pin.T
            line = own["throw"] * (state.angle.cos + 1j * state.angle.sin)
        else:
            along, across = on_crosshead_pin(state)
            line = along - 1j * across
        return {**own, "engine": line * bank, "rod": line * (cos_psi + 1j * sin_psi)}

    def _frames(self, degrees: Array, within: Array) -> dict[str, ComplexArray]:
        return self._in_frames(self._own.at(degrees, within), unit_vector(self._own.cylinder.bank_angle))

    @cached_property
    def _pieces(self) -> Pieces:
        return _common_pieces(self._own.forces.drive.machine, self.followed)

    def _sampled(self) -> tuple[Pieces, ComplexArray, ComplexArray]:
        forces = self._own.forces
        frames = self._in_frames(forces.samples, forces.pieces.of(unit_vector(self._own.cylinder.bank_angle)))
        journal, shell = (self._own.carried(self._pieces, frames[name]) for name in (self.journal, self.shell))
        return self._pieces, journal, shell

    @cached_property
    def _rate(self) -> tuple[Extreme, Any]:
        """Of the crank pin 1 + dψ/dφ, of the crosshead pin dψ/dφ; see `Bearing`."""
        state = self._own.forces.samples
        _, cos_psi = state.rod_angle or (0.0, 1.0)
        slope = formulas.rod_slope(state.angle.cos, cos_psi, state.drive.mechanism.lam)
        rate = self._own.carried(self._pieces, 1 + slope if self._pin == "crank_pin" else slope)
        return self._extremes(self._pieces, rate).peak, told(self._pieces.mean(np.abs(rate)), self.count)

    def _work(self) -> Any:
        forces = self._own.forces
        work = forces.pin_work_of(self._pin)
        return None if work is None else work * (forces.drive.machine.revolutions // forces.drive.revolutions)


class MainBearing(Bearing):
    """A main bearing under one throw, or under the two that it is between; the load is that of the shaft on it.

    number: along the shaft, from 0; every: all cylinders of the machine. Its throw frame is that of crank 1.
    """

    journal, shell, contact = "throw", "engine", 0.0

    def __init__(self, name: str, number: int, line: ShaftLine, every: Sequence[Follower], size: Size) -> None:
        throws = [throw for throw in line.throws if number in (throw.A, throw.B)]
        self._members = [index for throw in throws for index in throw.cylinders]
        super().__init__(name, [every[index] for index in self._members], size)
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
            position = np.fmod(own.crank_position, self._every[throw.cylinders[0]].forces.drive.cycle)
            pin = Vector(*(sum(parts) for parts in zip(*(pins[index] for index in throw.cylinders))))
            both = line.carried(throw, pin, own, CrankAngle.of(degrees - position))
            carried = both[0] if self._number == throw.A else both[1]
            force = force + (-carried.D + 1j * carried.T) * unit_vector(throw.angle)
        return np.broadcast_to(np.asarray(force), degrees.shape)

    def _frames(self, degrees: Array, within: Array) -> dict[str, ComplexArray]:
        pins = {number: _pin_load(self._every[number].at(degrees, within)) for number in self._members}
        throw = self._force(self._line, pins, degrees)
        return {"throw": throw, "engine": throw * unit_vector(degrees)}

    def _on_pieces(self, rubbed: bool) -> tuple[Pieces, ComplexArray]:
        """Return pieces of the cycle and the force there; rubbed: with what the friction of the pins does to it."""
        machine = self._line.machine
        pieces, pins = _common_pieces(machine, self.followed), {}
        for number, own in zip(self._members, self.followed):
            load = _pin_load(own.forces.samples if rubbed else own.forces.samples.unrubbed)
            pins[number] = Vector(*(own.carried(pieces, one) for one in load))
        machine = machine if self.count is None else taken(machine, pieces.machine)
        assert machine.crankshaft is not None
        return pieces, self._force(ShaftLine(machine, machine.crankshaft), pins, pieces.degrees)

    def _sampled(self) -> tuple[Pieces, ComplexArray, ComplexArray]:
        pieces, force = self._on_pieces(rubbed=True)
        angle = CrankAngle.at_nodes(pieces)
        return pieces, force, force * (angle.cos + 1j * angle.sin)

    @property
    def _rate(self) -> tuple[Extreme, Any]:
        return Extreme(1.0, told(np.zeros(self.count or 1), self.count)), 1.0

    def _work(self) -> Any:
        given = [one.cylinder.friction for one in self.followed]
        coefficient = next((one.journals for one in given if one and one.journals is not None), None)
        if coefficient is None or self.size.diameter is None:
            return None
        pieces, load, _ = _with_magnitude(*self._on_pieces(rubbed=False))
        return told(pieces.integral(load), self.count) * coefficient * self.size.diameter / 2


def _pin_load(state: State) -> Vector:
    return on_pin(state) if state.drive.has_force else Vector(0.0, 0.0)


def _common_pieces(machine: Machine, followed: Sequence[Follower]) -> Pieces:
    """Return the pieces of the cycle of a machine on which the samples of all of these cylinders are smooth."""
    return common([(one.forces.pieces, one.position) for one in followed], 360.0 * machine.revolutions)


def _with_magnitude(pieces: Pieces, load: ComplexArray, others: Sequence[Array] = ()) -> tuple[Pieces, Array, Array]:
    """Return pieces on which magnitude and direction of a load are polynomials, the magnitude in N, and the parts.

    load: (nodes, pieces). The parts are those of the load and the others. On each piece the load lies within a quarter
    of a turn. The smaller a load, the less of its direction is left by rounding.
    """
    parts, largest = np.stack((load.real, load.imag, *others)), pieces.largest(np.abs(load))

    def both(some: Pieces, found: Array) -> Array:
        size, most = np.hypot(*found[:2]), some.of(largest)
        towards = _directed(found[0] + 1j * found[1], most)
        weakest = np.min(size, axis=0, where=size > _NO_LOAD * most, initial=math.inf)
        share = np.where(np.isfinite(weakest), weakest / np.maximum(most, _TINIEST), 0.0)
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

    def _parts(self) -> Iterator[Bearing]:
        every = []
        for forces in self._cylinders:
            own = forces.drive.cylinder
            first = next(one for one in self._cylinders if work_alike(one.drive.cylinder, own))
            # whole cycles are taken off, which is exact: next to a large position an angle would lose its digits
            every.append(Follower(first, own, np.fmod(own.crank_position, forces.drive.cycle)))
        for number, one in enumerate(every):
            if _loads(one.forces):
                of, (pin, crosshead) = f" of {one.cylinder.name}" if len(every) > 1 else "", self._pin_sizes(number)
                yield RodPin(f"crank pin{of}", one, pin, "crank_pin")
                yield RodPin(f"crosshead pin{of}", one, crosshead, "crosshead_pin")
        shaft, line = self.machine.crankshaft, self.line
        if line and shaft:
            frictions = [one.friction for one in self.machine.cylinders if one.friction]
            diameters = (shaft.journal_diameter, *(one.journal_diameter for one in frictions))
            size = Size(next((one for one in diameters if one is not None), None), shaft.journal_length)
            for number, name in enumerate("AB" if line.bearings == 2 else range(1, line.bearings + 1)):
                yield MainBearing(f"bearing {name}", number, line, every, size)

    def _pin_sizes(self, number: int) -> tuple[Size, Size]:
        """Return the sizes of crank pin and crosshead pin; rods on one pin have equal parts of its length."""
        shaft, friction = self.machine.crankshaft, self.machine.cylinders[number].friction
        crank = Size(friction.crank_pin_diameter if friction else None, None)
        if shaft is not None:
            rods = len(self.line.throw_of(number).cylinders) if self.line else 1
            crank = Size(shaft.pin_diameter, shaft.pin_length / rods)
        given = (friction.crosshead_pin_diameter, friction.crosshead_pin_length) if friction else (None, None)
        return crank, Size(*given)


def _loads(forces: CylinderForces) -> bool:
    return forces.drive.has_force and bool(forces.drive.mechanism.has_rod)
