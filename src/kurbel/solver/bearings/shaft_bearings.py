"""The pins and main bearings of a machine, from the forces of its cylinders."""

from collections.abc import Iterator, Sequence
from functools import cached_property

import numpy as np

from kurbel import crank_formulas as formulas
from kurbel.arrays import Array
from kurbel.crank_angle import CrankAngle
from kurbel.errors import UsageError
from kurbel.machine import Machine
from kurbel.numerics.grid import Pieces, integral
from kurbel.numerics.jet import value_of
from kurbel.solver.bearings.bearing import Bearing, Loads, Size
from kurbel.solver.bearings.directions import Plane
from kurbel.solver.cylinder.following import Following
from kurbel.solver.cylinder.forces import CylinderForces
from kurbel.solver.cylinder.pins import on_crosshead_pin, on_pin
from kurbel.solver.shaft.line import ShaftLine, Throw, shaft_obstacle
from kurbel.solver.shaft.statics import Vector, norm


class RodPin(Bearing):
    """A pin of a connecting rod; the load is that of the rod on the pin.

    pin: `crank_pin`, or `crosshead_pin`, which moves with the crosshead and so in the frame of the engine.
    """

    shell = "rod"
    of_rod = True

    def __init__(self, name: str, followed: Following, size: Size, pin: str) -> None:
        super().__init__(name, (followed,), size)
        self._pin, self._turns = pin, followed.drive.machine.revolutions
        self.journal = "throw" if pin == "crank_pin" else "engine"

    def loads(self, degrees: Array, within: Array) -> Loads:
        """Return the load; see `Bearing`."""
        state = self.followed[0].jets_at(degrees, within)
        mechanism, angle = state.drive.mechanism, state.angle
        sin_psi, cos_psi = mechanism.rod_angle(angle) or (0.0, 1.0)
        rate = formulas.rod_slope(angle.cos, cos_psi, mechanism.lam)
        if self._pin == "crank_pin":
            throw = Plane.of_throw(on_pin(state))
            line, own, rate = throw.turned(angle.cos, angle.sin), {"throw": throw}, 1 + rate
        else:
            along, across = on_crosshead_pin(state)
            line, own = Plane(along, -across), {}
        engine, rod = line.turned_by(state.drive.cylinder.bank_angle), line.turned(cos_psi, sin_psi)
        return Loads({**own, "engine": engine, "rod": rod}, rate)

    @property
    def work_rubbing(self) -> float | None:
        """Work of its friction in J per cycle of the machine; None without a coefficient."""
        forces = self.followed[0].forces
        work = forces.pin_work_of(self._pin)
        return None if work is None else work * (self._turns // forces.drive.revolutions)


class MainBearing(Bearing):
    """A main bearing under one throw, or under the two that it stands between; the load is that of the shaft on it.

    number: along the shaft, from 0; its throw frame is that of crank 1.
    """

    journal, shell, contact = "throw", "engine", 0.0

    def __init__(self, name: str, number: int, line: ShaftLine, followed: Sequence[Following], size: Size) -> None:
        self._throws = tuple(throw for throw in line.throws if number in (throw.A, throw.B))
        own = [followed[index] for throw in self._throws for index in throw.cylinders]
        super().__init__(name, own, size)
        self._number = number
        self._line = line
        self._of_cylinder = followed

    def loads(self, degrees: Array, within: Array) -> Loads:
        """Return the load; see `Bearing`."""
        throw = self._force(degrees, within, rubbed=True)
        angle = CrankAngle.of(degrees).jets
        return Loads({"throw": throw, "engine": throw.turned(angle.cos, angle.sin)})

    def _force(self, degrees: Array, within: Array, rubbed: bool) -> Plane:
        """Return the force in N in the frame of crank 1; rubbed: with what the friction of the pins does to it."""
        found = [self._of_throw(throw, degrees, within, rubbed) for throw in self._throws]
        return Plane(*map(sum, zip(*found)))

    def _of_throw(self, throw: Throw, degrees: Array, within: Array, rubbed: bool) -> Plane:
        every = [self._of_cylinder[index].jets_at(degrees, within) for index in throw.cylinders]
        pins = [on_pin(one if rubbed else one.unrubbed) for one in every if one.drive.has_force]
        none = np.zeros_like(degrees)
        pin = Vector(*map(sum, zip(Vector(none, none), *pins)))
        both = self._line.carried(throw, pin, every[0].drive.cylinder, every[0].angle)
        return Plane.of_throw(both[0] if self._number == throw.A else both[1]).turned_by(throw.angle)

    @cached_property
    def work_rubbing(self) -> float | None:
        """Work of its friction in J per cycle of the machine; None without a coefficient."""
        given = (one.drive.cylinder.friction for one in self.followed)
        coefficient = next((one.journals for one in given if one and one.journals is not None), None)
        if coefficient is None or self.size.diameter is None:
            return None

        def size(pieces: Pieces) -> Array:
            force = self._force(pieces.degrees, pieces.within, rubbed=False)
            found = norm(*force)
            return np.asarray(value_of(found))

        return float(integral(self._grid, size)) * coefficient * self.size.diameter / 2


class ShaftBearings:
    """What `kurbel bearings` answers. Raises UsageError where no cylinder has a force and a connecting rod."""

    def __init__(self, machine: Machine, cylinders: tuple[CylinderForces, ...]) -> None:
        self.machine = machine
        self._cylinders = cylinders
        if not any(map(_loads, cylinders)):
            raise UsageError(
                f"{machine.name}: nothing loads a bearing: that needs a cylinder with a connecting rod, and a pressure "
                "or masses and a speed"
            )

    @property
    def obstacle(self) -> str:
        """Why no main bearings are told, or an empty text."""
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
        cycle = 360.0 * self.machine.revolutions
        followed = [Following(forces, cycle) for forces in self._cylinders]
        several = len(followed) > 1
        for number, one in enumerate(followed):
            if not _loads(one.forces):
                continue
            of = f" of {one.drive.name}" if several else ""
            yield RodPin(f"crank pin{of}", one, self._pin_size(number), "crank_pin")
            yield RodPin(f"crosshead pin{of}", one, _crosshead_size(one), "crosshead_pin")
        if self.line:
            names = "AB" if self.line.bearings == 2 else range(1, self.line.bearings + 1)
            for number, name in enumerate(names):
                yield MainBearing(f"bearing {name}", number, self.line, followed, self._journal_size())

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
        frictions = (one.friction for one in self.machine.cylinders)
        given = next((one.journal_diameter for one in frictions if one and one.journal_diameter), None)
        return Size(shaft.journal_diameter or given, shaft.journal_length)


def _crosshead_size(one: Following) -> Size:
    friction = one.drive.cylinder.friction
    return Size(friction.crosshead_pin_diameter, friction.crosshead_pin_length) if friction else Size(None, None)


def _loads(forces: CylinderForces) -> bool:
    return forces.drive.has_force and forces.drive.mechanism.has_rod
