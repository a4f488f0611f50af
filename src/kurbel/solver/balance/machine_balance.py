"""What `kurbel balance` answers for the whole machine: free forces and moments, their orders, and the best weights."""

import math
from collections.abc import Callable, Sequence
from functools import cache, cached_property, partial
from typing import TYPE_CHECKING, Any

import numpy as np

from kurbel.arrays import Array, ComplexArray
from kurbel.crank_angle import CrankAngle
from kurbel.errors import UsageError
from kurbel.machine import Machine
from kurbel.numerics.extreme import Extreme
from kurbel.numerics.search import Extremes
from kurbel.solver.balance.best import Least, in_planes, least, shafts
from kurbel.solver.balance.circles import Circles
from kurbel.solver.balance.free import Free, Products, of_book, of_throws
from kurbel.solver.balance.rolling import rolling_moment, swirls
from kurbel.solver.cylinder.forces import CylinderForces
from kurbel.solver.figures import Columns, Results, passed_on
from kurbel.solver.turning.torques import Sum
from kurbel.solver.weights import OwnThrow, Weight, counterweights_of, middle_of, shafts_of, wheels_of

if TYPE_CHECKING:
    from kurbel.solver.balance.locomotive import LocomotiveBalance

_REAL = 1e-12
"""Beside its size, what a counterweight opposite the throw may point aside by rounding."""


_VECTORS: dict[str, tuple[str, str, Callable[[Any], Any]]] = {
    "F_x": ("free", "force", np.real),
    "F_y": ("free", "force", np.imag),
    "F_free": ("free", "force", np.abs),
    "M_x": ("free", "moment", np.real),
    "M_y": ("free", "moment", np.imag),
    "M_free": ("free", "moment", np.abs),
    "F_x_book": ("book", "force", np.real),
    "F_y_book": ("book", "force", np.imag),
    "M_x_book": ("book", "moment", np.real),
    "M_y_book": ("book", "moment", np.imag),
}
"""Column -> the part of the free force in N or moment in N m that it is, of the true one (`free`) or of the book."""


class MachineBalance(Results):
    """The key values of the whole machine over a turn; `at(degrees)` gives the columns.

    Attributes are named by the ids of the key values, in SI; one that the machine does not have is None. Raises
    UsageError where nothing moves that a free force could come from, and where a place of a weight is missing.

    z_0: place in m from where moments are taken; wheels: of the counterweights in the wheels of a locomotive, none of
    another machine; counterweights: those of the machine file.
    """

    command = "balance"

    def __init__(self, machine: Machine, cylinders: Sequence[CylinderForces]) -> None:
        self.machine = machine
        self._cylinders = cylinders
        first = machine.cylinders[0].bank_angle if machine.cylinders else 0.0
        own = (OwnThrow(number, one, first) for number, one in enumerate(machine.cylinders) if one.masses)
        self.throws = tuple(own)
        if not any(one.mass or one.rotating for one in self.throws):
            raise UsageError(f"{machine.name}: nothing moves that could be balanced; give 'masses' to its cylinders")
        for throw in self.throws:
            if throw.mechanism.quick_return:
                raise UsageError(f"{throw.name}: the masses of what drives a ram back quickly are not known")
        self.omega = None if machine.speed is None else 2 * math.pi * machine.speed
        self.z_0, self.wheels = middle_of(machine), wheels_of(machine)
        self.counterweights = tuple(counterweights_of(machine, self.throws))

    @property
    def answering(self) -> tuple[Any, ...]:
        """What answers key values, the first that knows one."""
        return (self, *((self.locomotive,) if self.locomotive else ()))

    def _columns(self, phi: Array, within: Array) -> Columns:
        @cache
        def vector(of: str, name: str) -> ComplexArray | None:
            circles: Circles | None = getattr(getattr(self, of), name, None)
            return None if circles is None or self.omega is None else circles.at(phi) * (self.omega * self.omega)

        def part(of: str, name: str, taken: Callable[[ComplexArray], Array]) -> Array | None:
            found = vector(of, name)
            return None if found is None else taken(found)

        def roll() -> Array | None:
            return None if self.roll is None else np.asarray(self.roll.torque(phi, within).value)

        return Columns(phi, {id: partial(part, *each) for id, each in _VECTORS.items()} | {"M_roll": roll})

    @property
    def breaks(self) -> Array:
        """The crank angles in degrees between which every quantity is smooth."""
        return self.roll.cuts.grid().breaks if self.roll else np.array([0.0, self.cycle])

    # what moves, all of it over ω²

    @cached_property
    def _throws_alone(self) -> Products:
        return of_throws(self.throws)

    @cached_property
    def bare(self) -> Free:
        """What the throws give, without counterweights and balance shafts."""
        return Free.of(self._throws_alone, self.z_0)

    @cached_property
    def free(self) -> Free:
        """What is free, with the counterweights and balance shafts of the machine file."""
        return Free.of(self._throws_alone.with_weights(self._given), self.z_0) if self._given else self.bare

    @cached_property
    def _given(self) -> tuple[Weight, ...]:
        """The weights of the machine file, on the crank and on shafts."""
        return (*self.counterweights, *shafts_of(self.machine))

    @cached_property
    def book(self) -> Free | None:
        """The same by the acceleration of first order, R 291; None where the book has none for a mechanism."""
        if any(of_book(one.mechanism, CrankAngle.of(0.0)) is None for one in self.throws):
            return None
        return Free.of(of_throws(self.throws, of_book).with_weights(self._given), self.z_0)

    @property
    def cycle(self) -> float:
        """Degrees after which everything repeats: a turn, or with gas in the rolling moment that of the machine."""
        return 360.0 * (self.machine.revolutions if any(one.drive.has_gas for one in self._cylinders) else 1)

    @cached_property
    def roll(self) -> Sum | None:
        """The rolling moment on the frame in N m over the cycle of the machine; None without a speed."""
        return rolling_moment(self.machine, self._cylinders) if self.omega else None

    # free forces and moments

    def largest(self, vector: Circles | None) -> Extreme | None:
        """Return the largest length of a vector over ω², times ω², with its angle; None without a speed."""
        if vector is None or self.omega is None:
            return None
        found = vector.largest
        return Extreme(found.value * self.omega * self.omega, found.degrees)

    @cached_property
    def F_free_max(self) -> Extreme | None:
        """Largest free force in N."""
        return self.largest(self.free.force)

    @cached_property
    def M_free_max(self) -> Extreme | None:
        """Largest free moment in N m."""
        return self.largest(self.free.moment)

    @property
    def rolls_as_it_turns(self) -> bool:
        """Whether the rolling moment is the turning effort of `kurbel flywheel` with the other sign."""
        return not any(map(swirls, self._cylinders))

    @cached_property
    def _roll_extremes(self) -> Extremes | None:
        if not self.roll:
            return None
        from kurbel.solver.turning.excess import torque_extremes

        grid = self.roll.cuts.first_of(self.roll.repeats).grid()
        return torque_extremes(self.roll, grid, self.roll.torque(grid.degrees, grid.within))

    M_roll_max = passed_on("_roll_extremes", "largest", "Largest rolling moment on the frame in N m.")
    M_roll_min = passed_on("_roll_extremes", "smallest", "Smallest rolling moment on the frame in N m.")

    # counterweights

    def angle_of(self, product: complex) -> float:
        """Return the direction of a weight from throw 1 in degrees, above −180 and up to 180."""
        throw = self.throws[0].weight(1.0).product
        turned = product / throw
        degrees = math.degrees(math.atan2(turned.imag, turned.real))
        return degrees if degrees > _REAL - 180 else 180.0

    @property
    def counterweight_given(self) -> float | None:
        """Size of the sum of the given counterweights in kg m."""
        return abs(sum(one.product for one in self.counterweights)) if self.counterweights else None

    @property
    def _forward(self) -> complex:
        return complex(self.bare.force.forward[0])

    @property
    def counterweight_best(self) -> float:
        """Product in kg m of the counterweight that takes away the forward circle of order 1."""
        return abs(self._forward)

    @property
    def counterweight_best_angle(self) -> float | None:
        """Its direction from throw 1 in degrees; None for a weight of nothing."""
        return self.angle_of(-self._forward) if self._forward else None

    @cached_property
    def least(self) -> Least:
        """The counterweight that leaves the least largest force."""
        return least(self.bare.force)

    @property
    def counterweight_least(self) -> float:
        """Product in kg m of the counterweight that leaves the least largest force."""
        return abs(self.least.weight)

    @property
    def counterweight_least_angle(self) -> float | None:
        """Its direction from throw 1 in degrees; None for a weight of nothing."""
        return self.angle_of(self.least.weight) if self.least.weight else None

    @property
    def F_free_best(self) -> Extreme | None:
        """The least largest free force in N."""
        return self.largest(self.least.left)

    @property
    def share_best(self) -> float | None:
        """Share of the reciprocating mass with which a counterweight opposite the only throw is the least one's."""
        (throw, *others) = self.throws
        opposite = -self.least.weight / throw.weight(1.0).product
        if others or not throw.mass or abs(opposite.imag) > _REAL * abs(opposite):
            return None
        return (opposite.real - throw.rotating) / throw.mass

    @cached_property
    def planes(self) -> tuple[float, ...]:
        """Places in m of two planes for counterweights: those given, or of the outer cylinders; () if they are one."""
        given = self.machine.counterweights
        named = () if isinstance(given, tuple) else given.planes
        places = [one.place for one in self.throws if one.place is not None]
        outer = (min(places), max(places)) if places and min(places) < max(places) else ()
        return named or self.wheels or outer

    @cached_property
    def best_in_planes(self) -> tuple[Weight, ...]:
        """The counterweights in two planes that take away all that turns with the crank, force and moment."""
        if not self.planes or self.bare.moment is None or self.z_0 is None:
            return ()
        levers = [plane - self.z_0 for plane in self.planes]
        found = in_planes(self._forward, complex(self.bare.moment.forward[0]), levers)
        return tuple(one._replace(place=plane) for one, plane in zip(found, self.planes))

    @cached_property
    def best_shafts(self) -> tuple[Weight, ...]:
        """The weights on balance shafts that take away what no counterweight can."""
        return shafts(self.bare.force, self.bare.moment, self.z_0)

    @cached_property
    def locomotive(self) -> "LocomotiveBalance | None":
        """What of it concerns the wheels of a locomotive; None of another machine."""
        given = self.machine.locomotive
        if given is None:
            return None
        from kurbel.solver.balance.locomotive import LocomotiveBalance

        return LocomotiveBalance(self, given)


class BookBalance:
    """The key values by the book's acceleration of first order, which are told only where they are asked for."""

    def __init__(self, balance: MachineBalance) -> None:
        self._balance = balance

    @property
    def F_free_max_book(self) -> Extreme | None:
        """Largest free force in N."""
        return self._balance.largest(self._balance.book.force if self._balance.book else None)

    @property
    def M_free_max_book(self) -> Extreme | None:
        """Largest free moment in N m."""
        return self._balance.largest(self._balance.book.moment if self._balance.book else None)
