"""Loads of every pin and main bearing over the cycle, and the arcs of their surfaces that are never loaded.

A load is a complex number: its real part is along the axis of a frame, outward, its imaginary part 90° further in
the sense of rotation. The frames:

    throw    turns with the crank:   F = −D + iT, of a main bearing as crank 1 turns
    engine   the stroke line of cylinder 1 outward:   F e^{iφ} e^{iγ}, γ from there to the stroke line
    rod      the line of the rod, crank pin to crosshead:   F e^{iφ} e^{iψ}

Crank pin and journal are at rest in the frame of the throw, crosshead pin and main shell in that of the engine, the
shells of the rod in that of the rod. Pin and shell are taken to touch over 60° to either side of the load.
"""

from __future__ import annotations

import math
from abc import abstractmethod
from collections.abc import Iterator, Sequence
from functools import cached_property, lru_cache
from typing import Any, NamedTuple

import numpy as np

from kurbel import crank_formulas as formulas
from kurbel.arrays import Array, ComplexArray, Indices, Number
from kurbel.crank_angle import CrankAngle, unit_vector
from kurbel.errors import UsageError
from kurbel.machine import Cylinder, Machine
from kurbel.machine.batch import taken
from kurbel.machine.cylinder import work_alike
from kurbel.numerics.extreme import Extreme
from kurbel.numerics.lobatto import chebyshev, rule
from kurbel.numerics.pieces import Pieces, common, resolved
from kurbel.quantity import value
from kurbel.solver.figures import AtAngles, Results, result
from kurbel.solver.forces import CylinderForces
from kurbel.solver.shaft import SupportedShaft, Vector, shaft_obstacle
from kurbel.solver.state import State, on_crosshead_pin, on_pin

HALF_CONTACT = 60.0
"""Degrees to either side of a load over which pin and shell are taken to touch."""
_NO_LOAD = 1e-12
"""Of the largest load: a smaller one is rounding and has no direction."""
_TINIEST = 1e-300
_SURE = 100.0
"""The direction of a load is resolved fully down to 1/100 of the largest; below, its weight falls with the load."""
_ALONG = 1e-13
"""Of the largest load: a component of a load that is smaller is rounding."""
_ON_AXIS = 1e-12
"""Degrees by which rounding may turn a load off the axis of its frame; a rod without mass is loaded along its axis."""
_EQUAL = 1e-6
"""Degrees by which rounding may move the ends of an arc that nearly vanishing loads determine."""


Size = tuple[float | None, float | None]
"""Diameter and length in m; None where they are not given."""
Sliding = tuple[Extreme, Number, Number | None]
"""Relative rotation of two surfaces over that of the crank, largest and mean, and the friction work in J."""


class Follower(NamedTuple):
    """A cylinder at the angles φ of crank 1: its own crank is at φ − position, in degrees.

    forces: of the first of the cylinders that work alike.
    """

    forces: CylinderForces
    cylinder: Cylinder
    position: Number

    def at(self, degrees: Array, within: Array) -> State:
        """Return the state at angles (n,) of crank 1, on the sides of jumps that hold `within`."""
        return State.at(self.forces.drive, degrees - self.position, within - self.position)

    def carried(self, pieces: Pieces, *values: Number) -> Array:
        """Return quantities sampled on the pieces of the cylinder at the nodes of common ones, (q, nodes, pieces)."""
        source = self.forces.pieces
        samples = np.stack([np.broadcast_to(one, source.degrees.shape) for one in values])
        return samples if pieces is source else pieces.carried(samples, source, self.position)


class BearingColumns(AtAngles):
    """The load of one bearing at crank angles φ (n,) in degrees; frames: complex in N, in each of its frames."""

    commands = ("bearings",)
    load = value(
        "F_L", "force", "Load of a rod on its pin, or of the shaft on a main bearing", lambda columns: columns.size
    )
    load_throw = value(
        "ε_K",
        "angle",
        "Direction of the load from its throw outward, of a main bearing from that of crank 1",
        lambda columns: columns.directions.get("throw"),
    )
    load_engine = value(
        "ε_M",
        "angle",
        "Direction of the load from the stroke line of cylinder 1 outward",
        lambda columns: columns.directions.get("engine"),
    )
    load_rod = value(
        "ε_S",
        "angle",
        "Direction of the load from the line of the rod, crank pin to crosshead",
        lambda columns: columns.directions.get("rod"),
    )

    def __init__(self, phi: Array, frames: dict[str, ComplexArray]) -> None:
        self.phi, self.size = phi, np.abs(next(iter(frames.values())))
        self.directions = {name: _axial(np.degrees(np.angle(load)), _ON_AXIS) for name, load in frames.items()}


class Bearing(Results):
    """A pin or a main bearing at the angles of crank 1. Attributes are named by the ids of the key values, in SI.

    name: as it is printed; followed: the cylinders that load it; size: diameter and length in m, None where they are
    not given; journal, shell: the frames in which its two surfaces stand still; contact: degrees from the direction of
    the load to where they touch; of_rod: whether a rod of a cylinder turns on it. Of many machines all key values are
    arrays (machines,).
    """

    command = "bearings"
    state = BearingColumns
    contact = 180.0
    of_rod = False

    load_max = value("F_L,max", "force", "Largest load")
    load_min = value("F_L,min", "force", "Smallest load")
    load_mean = value("F_L,m", "force", "Mean load over time")
    load_high = value("F_L,m,½", "force", "Mean load over the time in which it exceeds half the largest")
    unloaded_arc = value("Δε_Z", "angle", "Arc of the pin or journal that is never loaded")
    unloaded_middle = value("ε_Z", "angle", "Middle of its widest part, in the frame of the pin")
    unloaded_arc_shell = value("Δε_L", "angle", "Arc of the shell that is never loaded")
    unloaded_middle_shell = value("ε_L", "angle", "Middle of its widest part, in the frame of the shell")
    pressure_max = value("p_L,max", "pressure", "Largest pressure, load over d l")
    pressure_mean = value("p_L,m", "pressure", "Mean pressure over time")
    rubbing_speed_max = value("v_L,max", "velocity", "Largest sliding speed of the surfaces")
    rubbing_speed_mean = value("v_L,m", "velocity", "Mean sliding speed of the surfaces")
    pressure_velocity = value("k_L", "pressure_velocity", "Mean pressure times mean speed, p v")
    work_rubbing = value("A_f,L", "energy", "Friction work per cycle")

    def __init__(self, name: str, followed: Sequence[Follower], size: Size, surfaces: tuple[str, str]) -> None:
        self.name, self.followed, self.size = name, tuple(followed), size
        self.journal, self.shell = surfaces
        drive = followed[0].forces.drive
        self.machine, self.count, self.omega = drive.machine, drive.count, drive.omega
        cycle = 360.0 * self.machine.revolutions
        self._common = common([(one.forces.pieces, one.position) for one in followed], cycle)

    @abstractmethod
    def _frames(self, degrees: Array, within: Array) -> dict[str, ComplexArray]:
        """Return the load in N of the only machine in each of its frames at angles (n,) in degrees."""

    @abstractmethod
    def _samples(self) -> Array:
        """Return the load on the common pieces of journal and of shell, two parts each, (4, nodes, pieces)."""

    @abstractmethod
    def _rubbing(self) -> Sliding:
        """Return the relative rotation of its surfaces over that of the crank, largest and mean, and the friction work.

        The work is in J per cycle of the machine, None without a coefficient of friction.
        """

    def _columns(self, phi: Array, within: Array) -> BearingColumns:
        return BearingColumns(phi, self._frames(phi, within))

    @cached_property
    def _cycle(self) -> tuple[Pieces, Array, Array]:
        return with_magnitude(self._common, self._samples())

    @property
    def breaks(self) -> Array:
        """The crank angles in degrees of the only machine between which every quantity is smooth."""
        return np.append(self._cycle[0].low, self._cycle[0].cycle)

    def _result(self, values: Array) -> Any:
        return result(values, self.count)

    @cached_property
    def answers(self) -> dict[str, Any]:
        """The key values by id in SI; those that need sizes, speed or a coefficient only if these are given."""
        pieces, load, (x, y, shell_x, shell_y) = self._cycle
        loads, mean = pieces.extremes(load[None]).each(self._result)[0], self._result(pieces.mean(load))
        # the time in which it exceeds half the largest, by the mean of each piece; the weights sum to 2
        largest = np.atleast_1d(loads.largest.value)
        parted = pieces.split(pieces.zeros(load - pieces.of(largest / 2), largest))
        part = load if parted is pieces else parted.carried(load, pieces)
        above = np.where(parted.rule.weights @ part > parted.of(largest), 1.0, 0.0)
        time, sums = parted.integral(np.stack((np.broadcast_to(above, part.shape), part * above)))
        high = self._result(np.where(largest == 0, 0.0, sums / np.where(time > 0, time, 1.0)))
        found = {"load_max": loads.largest, "load_min": loads.smallest, "load_mean": mean, "load_high": high}

        for surface, ending in ((x + 1j * y, ""), (shell_x + 1j * shell_y, "_shell")):
            arc, middle = map(self._result, unloaded(pieces, surface, self.contact))
            found[f"unloaded_arc{ending}"] = None if self.count is None and math.isnan(arc) else arc
            found[f"unloaded_middle{ending}"] = None if self.count is None and math.isnan(middle) else middle

        (diameter, length), (fastest, rate, work) = self.size, self._rubbing()
        if diameter is not None and length is not None:
            found["pressure_max"] = Extreme(loads.largest.value / (diameter * length), loads.largest.degrees)
            found["pressure_mean"] = mean / (diameter * length)
        if diameter is not None and self.omega is not None:
            surface_speed = self.omega * diameter / 2
            found["rubbing_speed_max"] = Extreme(fastest.value * surface_speed, fastest.degrees)
            found["rubbing_speed_mean"] = rate * surface_speed
            if length is not None:
                found["pressure_velocity"] = found["pressure_mean"] * found["rubbing_speed_mean"]
        return {**found, "work_rubbing": work}


class RodPin(Bearing):
    """A pin of a connecting rod; the load is that of the rod on the pin.

    pin: `crank_pin`, or `crosshead_pin`, which moves with the crosshead and so in the frame of the engine.
    """

    of_rod = True

    def __init__(self, name: str, own: Follower, size: Size, pin: str) -> None:
        super().__init__(name, (own,), size, ("throw" if pin == "crank_pin" else "engine", "rod"))
        self._own, self._pin = own, pin

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

    def _samples(self) -> Array:
        forces, bank = self._own.forces, unit_vector(self._own.cylinder.bank_angle)
        frames = self._in_frames(forces.samples, forces.pieces.of(bank))
        journal, shell = frames[self.journal], frames[self.shell]
        return self._own.carried(self._common, journal.real, journal.imag, shell.real, shell.imag)

    def _rubbing(self) -> Sliding:
        """Of the crank pin 1 + dψ/dφ, of the crosshead pin dψ/dφ; see `Bearing`."""
        forces = self._own.forces
        state, work = forces.samples, forces.friction_works.get(self._pin)
        _, cos_psi = state.rod_angle or (0.0, 1.0)
        slope = formulas.rod_slope(state.angle.cos, cos_psi, state.drive.mechanism.lam)
        rate = self._own.carried(self._common, 1 + slope if self._pin == "crank_pin" else slope)
        fastest = self._common.extremes(rate).each(self._result)[0].peak
        whole = None if work is None else work * (self.machine.revolutions // forces.drive.revolutions)
        return fastest, self._result(self._common.mean(np.abs(rate[0]))), whole


class MainBearing(Bearing):
    """A main bearing under one throw, or under the two that it is between; the load is that of the shaft on it.

    number: along the shaft, from 0; every: all cylinders of the machine. Its throw frame is that of crank 1.
    """

    contact = 0.0

    def __init__(self, name: str, number: int, line: SupportedShaft, every: Sequence[Follower], size: Size) -> None:
        throws = [throw for throw in line.throws if number in (throw.A, throw.B)]
        self._members = {index: every[index] for throw in throws for index in throw.cylinders}
        super().__init__(name, (*self._members.values(),), size, ("throw", "engine"))
        self._number, self._line = number, line

    def _force(self, line: SupportedShaft, pins: dict[int, Vector], degrees: Array) -> ComplexArray:
        """Return the force in N in the frame of crank 1, whose angles in degrees these are.

        line: with the numbers of the machines whose angles they are; pins: forces of each cylinder on its crank pin.
        """
        force: Any = 0.0
        for throw in line.throws:
            if self._number in (throw.A, throw.B):
                own = line.machine.cylinders[throw.cylinders[0]]
                position = np.fmod(own.crank_position, self._members[throw.cylinders[0]].forces.drive.cycle)
                pin = Vector(*(sum(parts) for parts in zip(*(pins[index] for index in throw.cylinders))))
                at_A, at_B = line.carried(throw, pin, own, CrankAngle.of(degrees - position))
                carried = at_A if self._number == throw.A else at_B
                force = force + (-carried.D + 1j * carried.T) * unit_vector(throw.angle)
        return np.broadcast_to(np.asarray(force), degrees.shape)

    def _frames(self, degrees: Array, within: Array) -> dict[str, ComplexArray]:
        pins = {number: _pin_load(own.at(degrees, within)) for number, own in self._members.items()}
        throw = self._force(self._line, pins, degrees)
        return {"throw": throw, "engine": throw * unit_vector(degrees)}

    def _sampled(self, rubbed: bool) -> ComplexArray:
        """Return the force in N on the common pieces; rubbed: with the friction of the pins."""
        pieces, pins = self._common, {}
        for number, own in self._members.items():
            state = own.forces.samples if rubbed else own.forces.samples.without_pin_friction
            pins[number] = Vector(*own.carried(pieces, *_pin_load(state)))
        line = self._line if self.count is None else SupportedShaft(taken(self.machine, pieces.machine))
        return self._force(line, pins, pieces.degrees)

    def _samples(self) -> Array:
        force, angle = self._sampled(rubbed=True), CrankAngle.at_nodes(self._common)
        engine = force * (angle.cos + 1j * angle.sin)
        return np.stack((force.real, force.imag, engine.real, engine.imag))

    def _rubbing(self) -> Sliding:
        fastest = Extreme(1.0, self._result(np.zeros(self.count or 1)))
        given = [one.cylinder.friction for one in self.followed]
        coefficient = next((one.journals for one in given if one and one.journals is not None), None)
        if coefficient is None or self.size[0] is None:
            return fastest, 1.0, None
        force = self._sampled(rubbed=False)
        pieces, load, _ = with_magnitude(self._common, np.stack((force.real, force.imag)))
        return fastest, 1.0, self._result(pieces.integral(load)) * coefficient * self.size[0] / 2


def _pin_load(state: State) -> Vector:
    return on_pin(state) if state.drive.has_force else Vector(0.0, 0.0)


def with_magnitude(pieces: Pieces, parts: Array) -> tuple[Pieces, Array, Array]:
    """Return pieces on which magnitude and direction of a load are polynomials, with its magnitude in N and its parts.

    parts: both components of the load, then others to be carried along, (p, nodes, pieces). On each piece the direction
    of the load stays within a quarter of a turn. The direction of a small load is uncertain and counts less.
    """
    largest = pieces.largest(np.hypot(*parts[:2]))

    def both(some: Pieces, found: Array) -> Array:
        size, most = np.hypot(*found[:2]), some.of(largest)
        towards = _directed(found[0] + 1j * found[1], most)
        weakest = np.where(size > _NO_LOAD * most, size, math.inf).min(axis=0)
        share = np.where(np.isfinite(weakest), weakest / np.maximum(most, _TINIEST), 0.0)
        weight = np.minimum(1.0, _SURE * share)
        return np.stack((size, towards.real * weight, towards.imag * weight))

    fine, values, parts = resolved(pieces, parts, parts[:2], np.stack((largest, largest)), both)
    return fine, values[0], parts


def _directed(load: ComplexArray, largest: Array) -> ComplexArray:
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
    """Return the matrix (2, count − 2) that extrapolates from the inner ones of `count` nodes to both ends."""
    inner = rule(count).nodes[1:-1]
    return chebyshev(np.array([-1.0, 1.0]), count - 2) @ np.linalg.inv(chebyshev(inner, count - 2))


# the arc of a surface that no load reaches


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
    starts, widths = low + contact - HALF_CONTACT, high - low + 2 * HALF_CONTACT
    return unreached(starts, widths, pieces.machine, pieces.count)


def unreached(starts: Array, widths: Array, machine: Indices, count: int) -> tuple[Array, Array]:
    """Return how many degrees of a circle no arc covers, and the middle of the widest gap, each (machines,).

    starts, widths: of the arcs (n,) in degrees; machine: of each, ascending. Of gaps equally wide it is the first from
    0° on; the middle is nan where there is no gap, both are nan where there is no arc.
    """
    starts = 360.0 - np.mod(-starts, 360.0)
    order, many = np.lexsort((widths, starts, machine)), np.bincount(machine, minlength=count)
    # of each machine a row, filled up with arcs that reach nothing
    place = np.arange(len(machine)) - np.repeat(np.cumsum(many) - many, many)
    start, width = np.full((2, count, max(1, many.max())), [[[-math.inf]], [[0.0]]])
    start[machine, place], width[machine, place] = starts[order], widths[order]

    ends = start + width
    before = np.append(ends.max(axis=1, keepdims=True) - 360.0, ends[:, :-1], axis=1)
    with np.errstate(invalid="ignore"):  # without any arc
        gaps = np.maximum(start - np.maximum.accumulate(before, axis=1), 0.0)
        widest = gaps.max(axis=1, keepdims=True)
        first = np.arange(count), np.argmax(gaps > widest - _EQUAL, axis=1)
        middle = start[first] - gaps[first] / 2
        middle = _axial(middle - 360.0 * np.rint(middle / 360.0), _EQUAL)
    return gaps.sum(axis=1), np.where(widest[:, 0] > 0, middle, math.nan)


def _axial(directions: Array, rounding: float) -> Array:
    """Return directions in degrees; those within `rounding` of the axis are exactly 0 or 180."""
    along = np.rint(directions / 180.0) * 180.0
    return np.where(np.abs(directions - along) <= rounding, np.abs(along), directions)


# all of them


class ShaftBearings:
    """What `kurbel bearings` computes. Raises UsageError where no cylinder has a force and a connecting rod.

    obstacle: why there are no loads of main bearings, or an empty text; line: the throws on their bearings, None where
    that is not known.
    """

    def __init__(self, machine: Machine, cylinders: Sequence[CylinderForces]) -> None:
        self.machine, self._cylinders = machine, cylinders
        self._loading = [one.drive.has_force and bool(one.drive.mechanism.has_rod) for one in cylinders]
        if not any(self._loading):
            raise UsageError(
                f"{machine.name}: no load on any bearing: give a cylinder with a connecting rod, and a pressure or "
                "masses and a speed"
            )
        self.obstacle = shaft_obstacle(machine)
        known = machine.crankshaft and not self.obstacle
        self.line = SupportedShaft(machine) if known else None

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
        shaft, line = self.machine.crankshaft, self.line
        for number, (one, loads) in enumerate(zip(every, self._loading)):
            if loads:
                friction, of = one.cylinder.friction, f" of {one.cylinder.name}" if len(every) > 1 else ""
                pin: Size = friction.crank_pin_diameter if friction else None, None
                if shaft:  # rods on one pin have equal parts of its length
                    pin = shaft.pin_diameter, shaft.pin_length / (len(line.throw_of(number).cylinders) if line else 1)
                crosshead = (
                    (friction.crosshead_pin_diameter, friction.crosshead_pin_length) if friction else (None, None)
                )
                yield RodPin(f"crank pin{of}", one, pin, "crank_pin")
                yield RodPin(f"crosshead pin{of}", one, crosshead, "crosshead_pin")
        if line and shaft:
            frictions = [one.friction for one in self.machine.cylinders if one.friction]
            diameters = (shaft.journal_diameter, *(one.journal_diameter for one in frictions))
            size = next((one for one in diameters if one is not None), None), shaft.journal_length
            for number, name in enumerate("AB" if line.bearings == 2 else range(1, line.bearings + 1)):
                yield MainBearing(f"bearing {name}", number, line, every, size)
