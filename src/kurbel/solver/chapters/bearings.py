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

from collections.abc import Iterator, Mapping, Sequence
from functools import cached_property
from typing import Any

import numpy as np

from kurbel import crank_formulas as formulas
from kurbel.arrays import Array, ComplexArray, Number
from kurbel.crank_angle import CrankAngle, unit_vector
from kurbel.errors import UsageError
from kurbel.machine import Machine
from kurbel.machine.batch import taken
from kurbel.machine.cylinder import crank_lag
from kurbel.numerics.extreme import Extreme
from kurbel.numerics.pieces import common
from kurbel.solver.chapters.bearing import Bearing, Frames, Size, with_magnitude
from kurbel.solver.effort import position
from kurbel.solver.forces import CylinderForces
from kurbel.solver.shaft import SupportedShaft, shaft_obstacle
from kurbel.solver.state import State, crank_pin_force, crosshead_pin_force
from kurbel.solver.throw_loads import pin_load, resampled, state_at
from kurbel.solver.vector import Force


class RodPin(Bearing):
    """A pin of a connecting rod; the load is that of the rod on the pin.

    pin: `crank_pin`, or `crosshead_pin`, which moves with the crosshead and so in the frame of the engine.
    """

    of_rod = True

    def __init__(self, name: str, forces: CylinderForces, size: Size, pin: str) -> None:
        surfaces = ("throw" if pin == "crank_pin" else "engine", "rod")
        super().__init__(name, pin, (forces,), size, surfaces)
        self._forces = forces
        self._pin = pin
        # its stroke line, from that of cylinder 1
        first = forces.drive.machine.cylinders[0]
        self._bank = unit_vector(forces.drive.cylinder.bank_angle - first.bank_angle)

    def _seen(self, state: State, bank: Any) -> Frames:
        """Return the load in each frame; bank: e^{iγ} of its stroke line. N > 0 presses toward −i."""
        sin_psi, cos_psi = state.rod_angle or (0.0, 1.0)
        frames: dict[str, Any] = {}
        line: Any
        if self._pin == "crank_pin":
            D, T = crank_pin_force(state)
            frames["throw"] = -D + 1j * T
            line = frames["throw"] * (state.angle.cos + 1j * state.angle.sin)
        else:
            along, across = crosshead_pin_force(state)
            line = along - 1j * across
        frames["engine"] = line * bank
        frames["rod"] = line * (cos_psi + 1j * sin_psi)
        return frames

    def _frames(self, degrees: Array, within: Array) -> Frames:
        return self._seen(state_at(self._forces, degrees, within), self._bank)

    def _samples(self) -> Sequence[ComplexArray]:
        frames = self._seen(self._forces.samples, self._forces.pieces.of(self._bank))
        return [*resampled(self._common, self._forces, frames[self.journal], frames[self.shell])]

    def _turning(self) -> Array:
        """The rod turns on the crank pin with 1 + dψ/dφ, on the crosshead pin with dψ/dφ; see `Bearing`."""
        state, pieces = self._forces.samples, self._common
        _, cos_psi = state.rod_angle or (0.0, 1.0)
        mechanism = state.drive.mechanism
        slope = formulas.rod_slope(state.angle.cos, cos_psi, mechanism.lam)
        if state.drive.cylinder.link_rod is not None:
            # ψ_l does not follow from the crank pin, and τ = −ψ_l
            slope = -state.linked_piston.coupler_at(state.angle).slope
        rate = 1 + slope if self._pin == "crank_pin" else slope
        return resampled(pieces, self._forces, rate).real[0]

    def turning(self) -> tuple[Extreme, Number]:
        """Of a rod that swings; see `Bearing`."""
        pieces = self._common
        rate = self._turning()
        fastest = pieces.extremes(rate[None]).each(self._result)[0].peak
        return fastest, self._result(pieces.mean(np.abs(rate)))

    def friction_work(self) -> Number | None:
        """That of `kurbel forces`, over the cycle of the machine; see `Bearing`."""
        work = self._forces.friction_works.get(self._pin)
        if work is None:
            return None
        return work * (self.machine.revolutions // self._forces.drive.revolutions)


class MasterPin(RodPin):
    """The crank pin of a master rod, which carries the forces of its link rods, too."""

    def __init__(
        self, name: str, forces: CylinderForces, links: Sequence[CylinderForces], size: Size
    ) -> None:
        super().__init__(name, forces, size, "crank_pin")
        self._links = tuple(links)
        cycle = 360.0 * self.machine.revolutions
        parts = [(cylinder.pieces, position(cylinder)) for cylinder in (forces, *links)]
        self._common = common(parts, cycle)

    def _seen_from(self, throw: ComplexArray, degrees: Array) -> Frames:
        """Return a load in N from the frame of the throw in every frame; degrees: of the own crank."""
        angle = CrankAngle.of(degrees)
        rod_angle = self._forces.mechanism.rod_angle(angle)
        assert rod_angle is not None
        sin_psi, cos_psi = rod_angle
        line = throw * (angle.cos + 1j * angle.sin)
        return {
            "throw": throw,
            "engine": line * self._bank,
            "rod": line * (cos_psi + 1j * sin_psi),
        }

    def _frames(self, degrees: Array, within: Array) -> Frames:
        load: Force = 0j
        for cylinder in (self._forces, *self._links):
            load = load - np.conj(pin_load(state_at(cylinder, degrees, within)))
        return self._seen_from(load, degrees - position(self._forces))

    def _samples(self) -> Sequence[ComplexArray]:
        load: Force = 0j
        for cylinder in (self._forces, *self._links):
            (on_pin_of_rod,) = resampled(self._common, cylinder, pin_load(cylinder.samples))
            load = load - np.conj(on_pin_of_rod)
        frames = self._seen_from(load, self._common.degrees - position(self._forces))
        return [frames[self.journal], frames[self.shell]]


class KnucklePin(RodPin):
    """The knuckle pin of a link rod, at rest in the master rod; the load is that of the link rod on it."""

    def __init__(self, name: str, forces: CylinderForces) -> None:
        super().__init__(name, forces, (None, None), "knuckle_pin")
        self.journal = "master"

    def _seen(self, state: State, bank: Any) -> Frames:
        """Return the load in each frame; see `RodPin`."""
        sin_psi, cos_psi = state.rod_angle or (0.0, 1.0)
        force = state.knuckle_force
        master = state.linked_piston.master_direction(state.angle)
        return {
            "engine": force * bank,
            "rod": force * (cos_psi + 1j * sin_psi),
            "master": force * np.conj(master),
        }

    def _turning(self) -> Array:
        """The link rod turns on its knuckle pin with ψ_l′ − ψ′; see `Bearing`."""
        state = self._forces.samples
        rate = state.linked_piston.turning_on_master(state.angle)
        return resampled(self._common, self._forces, rate).real[0]


class MainBearing(Bearing):
    """A main bearing under one throw, or under the two that it is between; the load is that of the shaft on it.

    number: along the shaft, from 0; every: all cylinders of the machine. Its throw frame is that of crank 1.
    """

    contact = 0.0

    def __init__(
        self,
        name: str,
        number: int,
        line: SupportedShaft,
        all_cylinders: Sequence[CylinderForces],
        size: Size,
    ) -> None:
        throws = [throw for throw in line.throws if number in (throw.A, throw.B)]
        self._members = dict[int, CylinderForces]()
        for throw in throws:
            for index in throw.cylinders:
                self._members[index] = all_cylinders[index]
        cylinders = tuple(self._members.values())
        super().__init__(name, "journals", cylinders, size, ("throw", "engine"))
        self._number, self._line = number, line

    def _force(
        self, line: SupportedShaft, pins: Mapping[int, Force], degrees: Array
    ) -> ComplexArray:
        """Return the force in N in the frame of crank 1, whose angles in degrees these are.

        line: with the numbers of the machines whose angles they are; pins: D + iT on the crank pin of each cylinder.
        """
        force = np.zeros(degrees.shape, complex)
        for throw in line.throws:
            if self._number in (throw.A, throw.B):
                cylinder = line.machine.cylinders[throw.cylinders[0]]
                rods = [pins[index] for index in throw.cylinders]
                # whole turns are taken off, which is exact: next to a large angle another would lose its digits
                lag = np.fmod(crank_lag(cylinder, line.machine.cylinders[0]), 360.0)
                angle = CrankAngle.of(degrees - lag)
                on_A, on_B = line.reactions(throw, rods, cylinder, angle)
                on_bearing = on_A if self._number == throw.A else on_B
                force -= np.conj(on_bearing) * unit_vector(throw.angle)
        return force

    def _frames(self, degrees: Array, within: Array) -> Frames:
        pins = {}
        for number, forces in self._members.items():
            pins[number] = pin_load(state_at(forces, degrees, within))
        throw = self._force(self._line, pins, degrees)
        return {"throw": throw, "engine": throw * unit_vector(degrees)}

    def _sampled(self, rubbed: bool) -> ComplexArray:
        """Return the force in N on the common pieces; rubbed: with the friction of the pins."""
        pieces, pins = self._common, {}
        for number, forces in self._members.items():
            state = forces.samples if rubbed else forces.samples.without_pin_friction
            (pins[number],) = resampled(pieces, forces, pin_load(state))
        line = self._line
        if self.count is not None:
            line = SupportedShaft(taken(self.machine, pieces.machine))
        return self._force(line, pins, pieces.degrees)

    def _samples(self) -> Sequence[ComplexArray]:
        force = self._sampled(rubbed=True)
        return force, force * unit_vector(self._common.degrees)

    def friction_work(self) -> Number | None:
        """∮ f |F| d/2 dφ with the force F without the friction of the pins; see `Bearing`."""
        coefficients = []
        for forces in self.cylinders:
            friction = forces.drive.cylinder.friction
            if friction and friction.journals is not None:
                coefficients.append(friction.journals)
        if not coefficients or self.size[0] is None:
            return None
        pieces, load, _ = with_magnitude(self._common, [self._sampled(rubbed=False)])
        return self._result(pieces.integral(load)) * coefficients[0] * self.size[0] / 2


class ShaftBearings:
    """What `kurbel bearings` computes. Raises UsageError where no cylinder has a force and a connecting rod.

    obstacle: why there are no loads of main bearings, or an empty text; line: the throws on their bearings, None where
    that is not known.
    """

    def __repr__(self) -> str:
        return f"<kurbel bearings of '{self.machine.name}': .parts>"

    def __init__(self, machine: Machine, cylinders: Sequence[CylinderForces]) -> None:
        self.machine, self._cylinders = machine, cylinders
        if not any(map(_loads_pins, cylinders)):
            raise UsageError(
                f"{machine.name}: no load on any bearing: give a cylinder with a connecting rod, and a pressure, a "
                "'force', or masses and a speed"
            )
        self.obstacle = shaft_obstacle(machine)
        self.line = None if self.obstacle else SupportedShaft(machine)

    @cached_property
    def parts(self) -> tuple[Bearing, ...]:
        """Crank pin and crosshead pin of every cylinder, then the main bearings along the shaft."""
        pins = list[Bearing]()
        for number, forces in enumerate(self._cylinders):
            if _loads_pins(forces):
                pins += self._pins(number, forces)
        return (*pins, *self._main_bearings())

    def _pins(self, number: int, forces: CylinderForces) -> Iterator[RodPin]:
        """Yield the pins of a rod: that on the crank, or on its master rod, and that in the crosshead."""
        cylinder, shaft = forces.drive.cylinder, self.machine.crankshaft
        friction = cylinder.friction
        of = f" of {forces.drive.name}" if len(self._cylinders) > 1 else ""
        links = [other for other in self._cylinders if other.drive.cylinder.hangs_on(cylinder.name)]
        pin: Size = friction.crank_pin_diameter if friction else None, None
        if cylinder.link_rod is not None:
            yield KnucklePin(f"knuckle pin{of}", forces)
        elif links:
            if shaft:
                pin = shaft.pin_diameter, shaft.pin_length
            yield MasterPin(f"crank pin{of}", forces, links, pin)
        else:
            if shaft:  # rods on one pin have equal parts of its length
                rods = len(self.line.throw_of(number).cylinders) if self.line else 1
                pin = shaft.pin_diameter, shaft.pin_length / rods
            yield RodPin(f"crank pin{of}", forces, pin, "crank_pin")
        crosshead: Size = None, None
        if friction:
            crosshead = friction.crosshead_pin_diameter, friction.crosshead_pin_length
        yield RodPin(f"crosshead pin{of}", forces, crosshead, "crosshead_pin")

    def _main_bearings(self) -> Iterator[MainBearing]:
        """Yield the main bearings along the shaft, two of them A and B, more of them numbered."""
        if self.line is None:
            return
        shaft = self.line.shaft
        diameters = [shaft.journal_diameter]
        for cylinder in self.machine.cylinders:
            if cylinder.friction:
                diameters.append(cylinder.friction.journal_diameter)
        stated = [diameter for diameter in diameters if diameter is not None]
        size = stated[0] if stated else None, shaft.journal_length
        count = self.line.bearings
        names = "AB" if count == 2 else range(1, count + 1)
        for number, name in enumerate(names):
            yield MainBearing(f"bearing {name}", number, self.line, self._cylinders, size)


def _loads_pins(forces: CylinderForces) -> bool:
    """Return whether a force acts in a cylinder that has a connecting rod."""
    return forces.drive.has_force and bool(forces.drive.mechanism.has_rod)
