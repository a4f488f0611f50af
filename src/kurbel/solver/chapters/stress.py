"""Strength of a crankshaft, throw by throw, between two bearings or overhung: stresses over the whole cycle (G).

Where stresses are looked at, and which they are, is in `stress_places`.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Sequence
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from kurbel.arrays import Array, Number
from kurbel.crank_angle import CrankAngle, unit_vector
from kurbel.errors import UsageError
from kurbel.machine import Machine
from kurbel.machine.batch import taken
from kurbel.machine.crankshaft import Crankshaft
from kurbel.numerics.arithmetic import every, some, where
from kurbel.numerics.extreme import Extreme, chosen, largest, smallest
from kurbel.numerics.pieces import Pieces, common, highest, resolved
from kurbel.quantity import ValuesById
from kurbel.solver.chapters.strength import Strength, StressColumns
from kurbel.solver.chapters.stress_places import PARTS, Opposite, Place, places
from kurbel.solver.effort import position
from kurbel.solver.figures import result
from kurbel.solver.forces import CylinderForces
from kurbel.solver.shaft import FreeBody, SupportedShaft, flywheel_weight, strength_obstacle
from kurbel.solver.state import State
from kurbel.solver.throw_loads import pin_load, resampled, state_at
from kurbel.solver.vector import Force


class ThrowLoad(NamedTuple):
    """What acts on a throw, at angles (…): the force of each rod on the pin in N, D + iT; M_A in N m, None if none.

    pulls: centrifugal force of each rod in N, which its force has and its column D has not; opposite: the forces of the
    rods of the throw at the other end of the shaft.
    """

    rods: Sequence[Force]
    torque_A: Number | None
    pulls: Sequence[Number] = ()
    opposite: Sequence[Force] = ()


class ThrowStrength(Strength):
    """Statics and stresses of one throw, at the angles of crank 1.

    number: along the shaft, from 0; cylinders: all of the machine.
    """

    def __init__(
        self,
        machine: Machine,
        line: SupportedShaft,
        number: int,
        cylinders: Sequence[CylinderForces],
    ) -> None:
        self.machine, self.count, self.line = machine, cylinders[0].drive.count, line
        self.shaft: Crankshaft = line.shaft
        self.throw = line.throws[number]
        self.name = f"throw {number + 1}"
        self.rods = [cylinders[index] for index in self.throw.cylinders]
        # torque is carried from the free end, of overhung cranks from none
        self.before = list[CylinderForces]()
        if not self.shaft.overhung:
            for throw in line.throws[:number]:
                self.before += [cylinders[index] for index in throw.cylinders]
        self.opposite = None
        self._beyond = list[CylinderForces]()
        if self.shaft.overhung and self.throw.flywheel and len(line.throws) > 1:
            self.opposite = line.throws[1 - number]
            self._beyond = [cylinders[index] for index in self.opposite.cylinders]
        self._is_alone = len(cylinders) == 1

    def _position(self, forces: CylinderForces) -> Number:
        """Return the degrees by which a cylinder follows cylinder 1."""
        if self._is_alone:
            return 0.0
        return position(forces)

    # the throw under its loads

    def _machine_at(self, pieces: Pieces | None) -> Machine:
        """Return the machine, or of many the one of each piece."""
        if pieces is None or self.count is None:
            return self.machine
        return taken(self.machine, pieces.machine)

    def _bodies(
        self, load: ThrowLoad, angle: CrankAngle, pieces: Pieces | None = None, number: int = 0
    ) -> tuple[FreeBody, Opposite | None]:
        """Return the throw under a load, and the one at the other end of the shaft.

        angle: of the crank of one of its cylinders, `number` on the pin, at the nodes of pieces, or of each machine.
        """
        machine = self._machine_at(pieces)
        shaft, cylinder = machine.crankshaft, machine.cylinders[self.throw.cylinders[number]]
        assert shaft is not None
        weight = flywheel_weight(machine, cylinder, angle) if self.throw.flywheel else 0.0
        crank = cylinder.mechanism.crank
        body = FreeBody(shaft, crank, load.rods, weight, load.torque_A)
        if self.opposite is None or not load.opposite:
            return body, None
        other_crank = machine.cylinders[self.opposite.cylinders[0]].mechanism.crank
        apart = self.opposite.angle - self.throw.angle
        turn = unit_vector(-(apart if pieces is None else pieces.of(apart)))
        return body, Opposite(FreeBody(shaft, other_crank, load.opposite, 0.0), turn)

    def _angle(self, degrees: Array, pieces: Pieces | None = None) -> CrankAngle:
        """Return the angle of the crank of the first cylinder on the pin at angles of crank 1."""
        later = self._position(self.rods[0])
        if not np.any(later):
            if pieces is None:
                return CrankAngle.of(degrees)
            return CrankAngle.at_nodes(pieces)
        # whole turns are taken off, which is exact: next to a large position an angle would lose its digits
        later = np.fmod(later, 360.0)
        return CrankAngle.of(degrees - (later if pieces is None else pieces.of(later)))

    def _places(self, body: FreeBody, opposite: Opposite | None) -> list[Place]:
        """Return the places that are examined, with their stresses."""
        return list(places(body, self.throw.flywheel, opposite))

    def _columns(self, phi: Array, within: Array) -> StressColumns:
        load, states = self._load_at(phi, within)
        body, opposite = self._bodies(load, self._angle(phi))
        has_torques = len(self.line.throws) > 1
        return StressColumns(phi, states, body, self._places(body, opposite), has_torques)

    def _load_at(self, degrees: Array, within: Array) -> tuple[ThrowLoad, list[State]]:
        """Return the load of the only machine at crank angles (n,) in degrees, and the states of its cylinders."""
        states = [self._state(forces, degrees, within) for forces in self.rods]
        torque_A = None
        if self.before:
            before = [self._state(forces, degrees, within) for forces in self.before]
            torque_A = sum(
                pin_load(state).imag * state.mechanism.crank for state in before
            ) + np.zeros(len(degrees))
        beyond = [pin_load(self._state(forces, degrees, within)) for forces in self._beyond]
        zeros = np.zeros(len(degrees), complex)
        return ThrowLoad(
            [zeros + pin_load(state) for state in states], torque_A, opposite=beyond
        ), states

    def _state(self, forces: CylinderForces, degrees: Array, within: Array) -> State:
        """Return the state of a cylinder at angles of crank 1."""
        if self._is_alone:
            return State.at(forces.drive, degrees, within)
        return state_at(forces, degrees, within)

    # the cycle

    @cached_property
    def _common(self) -> Pieces:
        """The pieces within those of all cylinders that load the throw."""
        cylinders = [*self.rods, *self.before, *self._beyond]
        if self._is_alone:
            return self.rods[0].pieces
        cycle = 360.0 * self.machine.revolutions
        return common([(forces.pieces, self._position(forces)) for forces in cylinders], cycle)

    def _pin_samples(self, forces: CylinderForces) -> Array:
        """Return the force of a rod on the pin in N at the nodes of the common pieces, (nodes, pieces)."""
        load = pin_load(forces.samples)
        if self._is_alone:
            return self._common.filled(0j) + load
        return resampled(self._common, forces, load)[0]

    @cached_property
    def _samples(self) -> Array:
        """What acts on the throw at the nodes of the common pieces, real (parts, nodes, pieces); see `_load`."""
        pieces = self._common
        parts = list[Array]()
        for forces in self.rods:
            load = self._pin_samples(forces)
            parts += [load.real, load.imag]
        for forces in self.rods:
            parts.append(pieces.filled(pieces.of(forces.drive.rod_centrifugal_force)))
        for forces in self._beyond:
            load = self._pin_samples(forces)
            parts += [load.real, load.imag]
        if self.before:
            torque = pieces.filled(0.0)
            for forces in self.before:
                crank = pieces.of(forces.drive.mechanism.crank)
                torque = torque + self._pin_samples(forces).imag * crank
            parts.append(torque)
        return np.stack(parts)

    def _load(self, parts: Array) -> ThrowLoad:
        """Return the load that these parts are, (parts, nodes, pieces)."""
        rods, beyond = len(self.rods), len(self._beyond)
        of_rods, pulls = parts[: 2 * rods], parts[2 * rods : 3 * rods]
        of_others = parts[3 * rods : 3 * rods + 2 * beyond]
        return ThrowLoad(
            list(of_rods[::2] + 1j * of_rods[1::2]),
            parts[-1] if self.before else None,
            list(pulls),
            list(of_others[::2] + 1j * of_others[1::2]),
        )

    def _bodies_on(self, pieces: Pieces, parts: Array) -> tuple[FreeBody, Opposite | None]:
        return self._bodies(self._load(parts), self._angle(pieces.degrees, pieces), pieces)

    @cached_property
    def _cycle(self) -> tuple[Pieces, Array, Array]:
        """The cycle on pieces on which the loads are polynomials and no stress has a kink, cut where one is zero.

        Besides the pieces the parts of `_samples`, and magnitudes in N of the forces on A and B, on the pin rod by rod,
        and of the rod forces without their centrifugal forces. Each (…, nodes, pieces). Raises UsageError where the
        stresses of the only machine are no finite numbers.
        """
        pieces, parts = self._common, self._samples
        body, opposite = self._bodies_on(pieces, parts)
        examined = self._places(body, opposite)
        are_finite = [np.isfinite(place.combined + place.von_mises).all() for place in examined]
        if self.count is None and not all(are_finite):
            raise UsageError(
                f"{self.machine.name}: the stresses of the crankshaft are too large to compute with: "
                "check the numbers and units of the machine file"
            )
        kinks = np.stack([pieces.filled(kink) for kink in self._kinks(body, self._load(parts))])

        def magnitudes(cut: Pieces, acting: Array) -> Array:
            body, _ = self._bodies_on(cut, acting)
            load = self._load(acting)
            without_pull = [force + pull for force, pull in zip(load.rods, load.pulls)]
            return np.abs(np.stack((body.A, body.B, *load.rods, *without_pull)))

        fine, loads, acting = resolved(pieces, parts, kinks, pieces.largest(kinks), magnitudes)
        return fine, acting, np.asarray(loads)

    def _kinks(self, body: FreeBody, load: ThrowLoad) -> list[Number]:
        """Return the quantities at whose zeros a magnitude or a stress bends."""
        vectors = [body.pin, body.A, body.moments_at(body.shaft.web_distance)]
        if len(load.rods) > 1:
            vectors = [*load.rods, *vectors]
        kinks = list[Number]()
        for vector in vectors:
            kinks += [vector.real, vector.imag]
        # a web is bent out of plane as much at the pin as at the shaft
        kinks += [body.along_web, body.torque_pin - body.torque_B, body.torque_pin + body.torque_B]
        if body.torque_A is not None:
            kinks.append(body.torque_A)
            kinks.append(body.torque_A - body.torque_pin)
            kinks.append(body.torque_A + body.torque_pin)
            kinks.append(body.torque_B)
        for force, pull in zip(load.rods, load.pulls):
            kinks.append(force.real + pull)
        return kinks

    @property
    def breaks(self) -> Array:
        """The crank angles in degrees of the only machine between which every quantity is smooth."""
        return self._cycle[0].ends

    @cached_property
    def _largest(self) -> list[Extreme]:
        """The largest of Bach's stresses over the cycle, then of von Mises', of every place."""

        def stresses(cut: Pieces, parts: Array) -> list[Array]:
            examined = self._places(*self._bodies_on(cut, parts))
            by_bach = [place.combined for place in examined]
            return by_bach + [place.von_mises for place in examined]

        pieces, parts, _ = self._cycle
        largest_stresses = list[Extreme]()
        for stress, degrees in zip(*highest(pieces, parts, stresses)):
            largest_stresses.append(Extreme(self._result(stress), self._result(degrees)))
        return largest_stresses

    def _result(self, values: Array) -> Any:
        return result(values, self.count)

    @cached_property
    def answers(self) -> ValuesById:
        """The key values by id; stresses of the parts that are examined, the safety where k_b is given."""
        values = self._of_loads()
        pull = sum(forces.drive.rod_centrifugal_force for forces in self.rods)
        values["C_rod"] = pull if some(pull != 0) else None
        values["P_dc"] = self.full_force
        length = self.shaft.pin_length / len(self.rods)
        pressure = abs(self.full_force.value) / self.shaft.pin_diameter / length
        values["p_pin_dc"] = pressure  # G: P_max/(d_z l_z)
        for part in dict.fromkeys(place.part for place in self.at_dead_centre):
            values |= self._of_part(part)
        return values

    def _of_part(self, part: str) -> ValuesById:
        """The key values of one part of the throw: its stresses at rest and running, and its safety."""
        count = len(self.at_dead_centre)
        resting, by_bach, by_mises = list[Extreme](), list[Extreme](), list[Extreme]()
        for number, place in enumerate(self.at_dead_centre):
            if place.part == part:
                resting.append(Extreme(place.combined, place.degrees))
                by_bach.append(self._largest[number])
                by_mises.append(self._largest[count + number])
        at_rest, running = largest(*resting), largest(*by_bach)
        values: ValuesById = {
            f"sigma_{part}_dc": at_rest.value,
            f"sigma_{part}_max": running,
            f"mises_{part}_max": largest(*by_mises),
        }
        worst = largest(at_rest, running)
        allowable = self.shaft.allowable_bending
        if allowable is not None and not every(worst.value == 0):
            safety = allowable / where(worst.value == 0, math.nan, worst.value)
            values[f"safety_{part}_min"] = Extreme(safety, worst.degrees)
        return values

    def _of_loads(self) -> ValuesById:
        """The key values of the loads by id, pressures of what has a diameter and length, p_m v where a speed is given.

        The mean on the pin is that of the rod force alone, as G has it for its bounds on p_m v, v = π d n. Each rod has
        an equal part of the pin. Bearings between two throws carry both: their pressure is that of `kurbel bearings`.
        """
        pieces, _, loads = self._cycle
        shaft = self.shaft
        rods = len(self.rods)
        extremes = pieces.extremes(loads[: 2 + rods])
        most = list[Extreme]()
        for load, degrees in zip(extremes.largest, extremes.largest_at):
            most.append(Extreme(self._result(load), self._result(degrees)))
        means = [self._result(mean) for mean in pieces.mean(loads)]
        mean_on_pin = functools.reduce(np.maximum, means[2 + rods :]) if rods > 1 else means[-1]
        values: ValuesById = {"A_max": most[0], "B_max": most[1]}

        pin_length = shaft.pin_length / rods
        values |= self._pressures(
            "pin", largest(*most[2:]), mean_on_pin, shaft.pin_diameter, pin_length
        )
        if len(self.line.throws) == 1:
            diameter, length = shaft.journal_diameter, shaft.journal_length
            if diameter is not None and length is not None:
                values |= self._pressures("journal_A", most[0], means[0], diameter, length)
                values |= self._pressures("journal_B", most[1], means[1], diameter, length)
        return values

    def _pressures(
        self, part: str, load: Extreme, mean: Any, diameter: Number, length: Number
    ) -> ValuesById:
        """The largest and the mean pressure on a pin or journal, and p_m v where a speed is given."""
        speed = self.machine.speed
        largest_pressure: Any = load.value / diameter / length
        pressure = mean / diameter / length
        return {
            f"p_{part}_max": Extreme(largest_pressure, load.degrees),
            f"p_{part}_mean": pressure,
            f"k_{part}": None if speed is None else pressure * math.pi * diameter * speed,
        }

    def unbalanced(self) -> Number:
        """Return what is left of the sums of forces and moments, over the sizes of their terms, at its worst."""
        pieces = self._common
        body, _ = self._bodies_on(pieces, self._samples)
        torque = pieces.filled(0.0)
        for forces in self.rods:
            if forces.drive.has_force:
                state = forces.samples
                of_work = state.tangential_at_pin * state.mechanism.crank + 0j
                if not self._is_alone:
                    of_work = resampled(pieces, forces, of_work)[0]
                torque = torque + of_work.real
        return self._result(pieces.largest(body.equilibrium_residual(torque)))

    @cached_property
    def peak_torque(self) -> Extreme:
        """The largest torque in journal B in N m, driving or driven, with its sign."""
        pieces = self._common
        body, _ = self._bodies_on(pieces, self._samples)
        return pieces.extremes(pieces.filled(body.torque_B)[None]).each(self._result)[0].peak

    # the two positions of the book, and the worst of the cycle

    @cached_property
    def _full_forces(self) -> list[Extreme | None]:
        """Of each rod the largest piston force without inertia in N, and the dead centre of its own crank in degrees.

        Starting and slow running (R p. 608): the inner dead centre, or the outer one where pulling is stronger.
        """
        _ = self._cycle  # forces that are too large are refused before they are searched
        full = list[Extreme | None]()
        for forces in self.rods:
            extremes = forces.extremes_of("P_start") if forces.drive.has_force else None
            if extremes is None:
                full.append(None)
                continue
            pushes = extremes.largest.value >= -extremes.smallest.value
            inner = Extreme(extremes.largest.value, forces.motion.phi_idc)
            outer = Extreme(extremes.smallest.value, forces.motion.phi_odc)
            full.append(chosen(pushes, inner, outer))
        return full

    @cached_property
    def full_force(self) -> Extreme:
        """The largest piston force without inertia in N, and the angle in degrees in which the throw takes it."""
        forces = list[Extreme]()
        for rod, full in zip(self.rods, self._full_forces):
            if full is not None:
                forces.append(Extreme(full.value, self._of_crank_1(rod, full.degrees)))
        if not forces:
            return Extreme(0.0, 0.0)
        strongest = forces[0]
        for force in forces[1:]:
            strongest = chosen(np.abs(force.value) > np.abs(strongest.value), force, strongest)
        return strongest

    def _of_crank_1(self, forces: CylinderForces, degrees: Any) -> Any:
        """Return the angle of crank 1 at an angle of the crank of a cylinder."""
        if self._is_alone:
            return degrees
        return np.mod(degrees + self._position(forces), 360.0 * self.machine.revolutions)

    @cached_property
    def at_dead_centre(self) -> tuple[Place, ...]:
        """Every place in a dead centre under the full force of the pressure: T = 0, D = P cos(φ+ψ)/cos ψ.

        Of several rods each by itself in its own dead centre, nothing else acting on the throw: the worst of these.
        """
        worst = list[Place]()
        for number, (forces, full) in enumerate(zip(self.rods, self._full_forces)):
            force, degrees = (0.0, 0.0) if full is None else full
            angle = CrankAngle.of(degrees)
            radial: Any = forces.drive.mechanism.radial(angle)
            loads = [0 * force * radial + 0j for _ in self.rods]
            loads[number] = force * radial + 0j
            beyond = [0 * loads[0] for _ in self._beyond]
            bodies = self._bodies(ThrowLoad(loads, None, opposite=beyond), angle, number=number)
            of_crank_1 = self._of_crank_1(forces, degrees)
            examined = [place._replace(degrees=of_crank_1) for place in self._places(*bodies)]
            worst = list(map(_worse, worst, examined)) if worst else examined
        return tuple(worst)

    @property
    def at_largest_torque(self) -> tuple[Place, ...]:
        """Every place in the position of the largest torque, driving or driven, of the only machine."""
        degrees = self.peak_torque.degrees
        body, opposite = self._next_to([degrees])
        side = int(np.abs(body.torque_B).argmax())
        return tuple(place.of_state(side, degrees) for place in self._places(body, opposite))

    @property
    def at_worst(self) -> tuple[Place, ...]:
        """Every place at the crank angle of the running machine at which its own combined stress is largest."""
        angles = [worst.degrees for worst in self._largest[: len(self.at_dead_centre)]]
        worst = list[Place]()
        examined = self._places(*self._next_to(angles))
        for number, (place, degrees) in enumerate(zip(examined, angles)):
            # the side of the angle, before or after it, with the larger stress
            first = 2 * number
            side = first + int(place.combined[first : first + 2].argmax())
            worst.append(place.of_state(side, degrees))
        return tuple(worst)

    def _next_to(self, degrees: Sequence[float]) -> tuple[FreeBody, Opposite | None]:
        """Return the throw just before and just after each angle in degrees of the only machine, since T may jump."""
        angles = np.repeat(np.asarray(degrees), 2)
        load, _ = self._load_at(angles, angles + np.tile((-1e-9, 1e-9), len(degrees)))
        return self._bodies(load, self._angle(angles))


def _worse(place: Place, other: Place) -> Place:
    """Return the one with the larger combined stress, of many machines for each of them."""
    is_worse = other.combined > place.combined
    if not np.ndim(is_worse):
        return other if is_worse else place
    numbers = {}
    for name, first, second in zip(Place._fields, place, other):
        if name not in ("part", "name") and first is not None:
            numbers[name] = where(is_worse, second, first)
    return place._replace(**numbers)


class CrankshaftStrength(Strength):
    """What `kurbel stress` computes: the strength of every throw of a machine, and the worst of all.

    Raises UsageError where the machine has no crankshaft that can be examined, and no pressure that loads it.
    """

    def __init__(self, machine: Machine, cylinders: Sequence[CylinderForces]) -> None:
        obstacle = strength_obstacle(machine)
        if obstacle or machine.crankshaft is None:
            raise UsageError(f"{machine.name}: {obstacle}")
        self.machine = machine
        self.shaft: Crankshaft = machine.crankshaft
        self.count = cylinders[0].drive.count
        self.line = SupportedShaft(machine)
        self.throws = [
            ThrowStrength(machine, self.line, number, cylinders)
            for number in range(len(self.line.throws))
        ]

    @property
    def only(self) -> ThrowStrength | None:
        """The throw, if there is one alone."""
        if len(self.throws) != 1:
            return None
        return self.throws[0]

    @property
    def worst(self) -> ThrowStrength:
        """The throw of the largest combined stress of any part, of the only machine."""

        def largest_stress(throw: ThrowStrength) -> float:
            stresses = [throw.answers.get(f"sigma_{part}_max") for part in PARTS]
            return max(float(stress.value) for stress in stresses if stress is not None)

        return max(self.throws, key=largest_stress)

    def at(self, degrees: object, within: Array | None = None) -> Any:
        """Return every column of the only throw at crank angles (n,) in degrees; of several each has its own."""
        if self.only is None:
            raise UsageError("each throw has its own columns: ask one of case.stress.throws")
        return self.only.at(degrees, within)

    def columns(self, degrees: object, *names: str) -> dict[str, Array]:
        """Return columns of the only throw; see `Results`."""
        if self.only is None:
            raise UsageError("each throw has its own columns: ask one of case.stress.throws")
        return self.only.columns(degrees, *names)

    @cached_property
    def answers(self) -> ValuesById:
        """The key values by id: of all throws the largest, of safeties the smallest."""
        if self.only:
            return self.only.answers
        worst: ValuesById = {}
        for throw in self.throws:
            for id, answer in throw.answers.items():
                if answer is not None:
                    worst[id] = answer if id not in worst else _worst(id, worst[id], answer)
        return worst

    def unbalanced(self) -> Number:
        """Return the largest residual of equilibrium of any throw."""
        return functools.reduce(np.maximum, [throw.unbalanced() for throw in self.throws])


def _worst(id: str, value: Any, other: Any) -> Any:
    """Return the worse of two key values: the smaller safety, of anything else what is larger by magnitude."""
    if id.startswith("safety"):
        return smallest(value, other)
    if isinstance(value, Extreme):
        return chosen(np.abs(other.value) > np.abs(value.value), other, value)
    return np.maximum(value, other)
