"""Balancing of the whole machine: key values, the best counterweights and balance shafts, locomotives.

Forces and moments are those of `unbalanced`, complex and over ω², in kg m and kg m². A counterweight u, mass times
radius, on the crank adds u e^{iφ}. The rolling moment on the frame about the shaft is −(M + dH/dt), with the turning
effort M and the moment of momentum H of the masses about the shaft.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from functools import cache, cached_property, partial
from typing import Any

import numpy as np

from kurbel.arrays import Array, ComplexArray, Flags
from kurbel.crank_angle import CrankAngle
from kurbel.errors import UsageError
from kurbel.machine.balance import Locomotive
from kurbel.numerics.arithmetic import some, sqrt, where
from kurbel.numerics.enclosing import ClosedCurve
from kurbel.numerics.extreme import Extreme, Extremes
from kurbel.numerics.pieces import Pieces
from kurbel.solver.effort import Term, TurningEffort
from kurbel.solver.figures import Columns, Results, passed_on
from kurbel.solver.forces import CylinderForces
from kurbel.solver.state import State
from kurbel.solver.unbalanced import Circles, Free, Terms, book_curvature, largest, sampled, turn_of
from kurbel.solver.weights import (
    OwnThrow,
    Weight,
    counterweights_of,
    levered,
    middle_of,
    shafts_of,
    wheels_of,
)

_SETTLED = 1e-13
"""Of the radius: by what a curve may reach beyond the smallest circle round it."""
_ROUNDS = 60
_REAL = 1e-12
"""By what a direction, or a lever in m, may miss another by rounding."""
_ROUNDING = 1e-14
"""Of the size of a curve: a centre that is nearer to 0 is 0."""


def least_centres(
    pieces: Pieces, curve: ComplexArray, even: Flags, others: ComplexArray
) -> tuple[ComplexArray, Array, Array]:
    """Return the centres (n,) of the smallest circles round closed curves c(φ), sampled on the pieces of a turn.

    even: which curves (n,) are their own image about 0, their centre. With them the lengths of other vectors (q, nodes,
    pieces), and last that of c less its centre, are searched together; see `largest`.
    """
    closed, size, each = ClosedCurve(pieces, curve), pieces.largest(np.abs(curve)), np.arange(pieces.count)
    degrees = np.zeros((4, pieces.count)) if even.all() else closed.nearly_enclosed()
    for _ in range(_ROUNDS):
        circle, degrees = closed.enclosed(degrees)
        centre = np.where(even | (np.abs(circle.centre) <= _ROUNDING * size), 0.0, circle.centre)
        top, at = largest(pieces, np.concatenate((others, [curve - centre[pieces.machine]])))
        beyond = ~even & (top[-1] > np.sqrt(circle.square) * (1 + _SETTLED) + _ROUNDING * size)
        if not beyond.any():
            break
        degrees[circle.shares.argmin(axis=0), each] = at[-1]
    return centre, top, at


def _found(name: str, text: str) -> Any:
    """Return a key value of the balance that is found with the others; see `MachineBalance.searched`."""
    return property(lambda balance: balance.searched(name), doc=text)


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
"""Column -> the part of the unbalanced force in N or moment in N m that it is, of the true one or of the book."""


class MachineBalance(Results):
    """The key values of the whole machine over a turn; `at(degrees)` gives the columns.

    Attributes are named by the ids of the key values, in SI; one that the machine does not have is None. Raises
    UsageError where nothing moves that could be balanced, and where a place of a weight is missing. count: of how many
    machines the numbers are, (machines,); then so are the key values, nan where a machine has none.

    z_0: place in m from where moments are taken; wheels: of the counterweights in the wheels of a locomotive, none of
    another machine; counterweights: those of the machine file.
    """

    command = "balance"

    def __init__(self, effort: TurningEffort) -> None:
        machine = self.machine = effort.machine
        self.count, self._cylinders, self._turning = effort.count, effort.cylinders, effort
        first = machine.cylinders[0].bank_angle if machine.cylinders else 0.0
        own = (OwnThrow(number, one, first) for number, one in enumerate(machine.cylinders) if one.masses)
        self.throws = tuple(own)
        if not any(some(one.mass != 0) or some(one.rotating != 0) for one in self.throws):
            raise UsageError(f"{machine.name}: nothing moves that could be balanced; give 'masses' to its cylinders")
        for throw in self.throws:
            if throw.mechanism.quick_return:
                raise UsageError(f"{throw.name}: the masses of what drives a ram back quickly are not known")
        self.omega = None if machine.speed is None else 2 * math.pi * machine.speed
        self.z_0, self.wheels = middle_of(machine), wheels_of(machine)
        self.counterweights = tuple(counterweights_of(machine, self.throws))

    @property
    def answering(self) -> tuple[Any, ...]:
        """The objects that have key values, searched in this order."""
        return (self, *((self.locomotive,) if self.locomotive else ()))

    def _columns(self, phi: Array, within: Array) -> Columns:
        @cache
        def vector(of: str, name: str) -> ComplexArray | None:
            free = self.free if of == "free" else self.book
            circles = None if free is None else free.force if name == "force" else free.moment
            return None if circles is None or self.omega is None else circles.at(phi) * (self.omega * self.omega)

        def part(of: str, name: str, component: Callable[[ComplexArray], Array]) -> Array | None:
            found = vector(of, name)
            return None if found is None else component(found)

        formulas = {id: partial(part, *each) for id, each in _VECTORS.items()}
        return Columns(phi, formulas | {"M_roll": lambda: self._roll_at(phi, within)})

    # what moves, all of it over ω²

    @cached_property
    def _throws_alone(self) -> Terms:
        return Terms.of(self.throws, lambda one, angle: one.curvature(angle), self.count)

    @cached_property
    def bare(self) -> Free:
        """What the throws give, without counterweights and balance shafts."""
        return Free(self._throws_alone, self.z_0)

    @cached_property
    def free(self) -> Free:
        """What is unbalanced, with the counterweights and balance shafts of the machine file."""
        return Free(self._throws_alone.with_weights(self._given), self.z_0) if self._given else self.bare

    @cached_property
    def _given(self) -> tuple[Weight, ...]:
        """The weights of the machine file, on the crank and on shafts."""
        return (*self.counterweights, *shafts_of(self.machine))

    @cached_property
    def book(self) -> Free | None:
        """The same by the acceleration of first order, R 291; None where the book has none for a mechanism."""
        if any(book_curvature(one.mechanism, CrankAngle.of(0.0)) is None for one in self.throws):
            return None
        return Free(Terms.of(self.throws, book_curvature, self.count).with_weights(self._given), self.z_0)

    # the largest of it, and the counterweight that leaves the least largest force

    @cached_property
    def _searched(self) -> tuple[Any, dict[str, Extreme]]:
        """The least counterweight in kg m, and the largest lengths over ω², all found in one search.

        In the frame of the crank the force without a counterweight is the closed curve F e^{−iφ} = f_1 + c(φ), to
        which a weight u on the crank adds u: the least largest |F + u e^{iφ}| has −u in the centre of the smallest
        circle round it. With even orders alone c(φ + 180°) = −c(φ), and the centre is 0.
        """
        bare, free = self.bare.force, self.free
        turning = bare.forward[0]
        vectors = {"force": free.force, "moment": free.moment, "bare": bare.turned_by(-turning)}
        given = {name: one for name, one in vectors.items() if one is not None}
        pieces, (*found, loose) = sampled([*given.values()], self.count)
        rows = dict(zip(given, found))
        if self.machine.locomotive:
            rows |= {f"{name} along": one.real.astype(complex) for name, one in rows.items()}
        odd = np.concatenate((given["bare"].forward[2::2], given["bare"].backward[::2], [turning]))
        even = ~(odd.reshape(len(odd), -1) != 0).any(axis=0) & (not bare.rests)
        curve = loose * turn_of(pieces).conj()
        centre, top, at = least_centres(pieces, curve, np.broadcast_to(even, pieces.count), np.array([*rows.values()]))
        extremes = [Extreme(self._told(one), self._told(where_)) for one, where_ in zip(top, at)]
        weight = -(turning + (complex(centre[0]) if self.count is None else centre))
        return weight, dict(zip([*rows, "least"], extremes))

    def _told(self, values: Array) -> Any:
        """Return numbers of every machine (machines,), or that of the only one."""
        return float(values[0]) if self.count is None else values

    def _times_square(self, found: Extreme | None) -> Extreme | None:
        """Return an extreme over ω² times ω²; None without a speed."""
        if found is None or self.omega is None:
            return None
        return Extreme(found.value * self.omega * self.omega, found.degrees)

    def largest(self, vector: Circles | None) -> Extreme | None:
        """Return the largest length of a vector over ω², times ω², with its angle; None without a speed."""
        if vector is None:
            return None
        top, at = largest(*sampled([vector], self.count))
        return self._times_square(Extreme(self._told(top[0]), self._told(at[0])))

    def searched(self, name: str) -> Extreme | None:
        """Return the largest `force`, `moment`, or what of them is `along` the stroke lines, in N or N m."""
        return self._times_square(self._searched[1].get(name))

    F_free_max = _found("force", "Largest unbalanced force in N.")

    M_free_max = _found("moment", "Largest unbalanced moment in N m.")

    F_free_best = _found("least", "The least largest unbalanced force in N.")

    # the rolling moment on the frame about the shaft: −(M + dH/dt), H the moment of momentum about the shaft

    @property
    def _effort(self) -> TurningEffort | None:
        """The turning effort of the machine, with its losses; None without a speed."""
        return self._turning if self.omega is not None and some(self.omega != 0) else None

    @property
    def rolls(self) -> bool:
        """Whether a rolling moment is known. Raises UsageError where no force acts."""
        return self._effort is not None and len(self._effort.pieces.half) > 0

    @property
    def rolls_as_it_turns(self) -> bool:
        """Whether the rolling moment is the turning effort of `kurbel flywheel` with the other sign."""
        return not any(map(swirls, self._cylinders))

    @cached_property
    def _roll(self) -> Array | None:
        """Samples of the rolling moment −(M + dH/dt) in N m on the pieces of the turning effort."""
        if self._effort is None:
            return None
        effort = self._effort
        return effort.sampled([Term(-1.0, one, swirl) for one in effort.groups if swirls(one[0])]) - effort.M

    def _roll_at(self, phi: Array, within: Array) -> Array | None:
        """Return the rolling moment in N m at crank angles (k,), on the sides of jumps that hold `within`."""
        if self._roll is None:
            return None
        return self._turning.at(self._turning.pieces, self._roll, phi, within)

    @cached_property
    def _roll_extremes(self) -> Extremes | None:
        if self._roll is None:
            return None
        return self._turning.pieces.extremes(self._roll[None]).each(self._turning.result)[0]

    M_roll_max = passed_on("_roll_extremes", "largest", "Largest rolling moment on the frame in N m.")
    M_roll_min = passed_on("_roll_extremes", "smallest", "Smallest rolling moment on the frame in N m.")

    @property
    def cycle(self) -> float:
        """Degrees after which everything repeats: a turn, or with gas in the rolling moment that of the machine."""
        return 360.0 * (self.machine.revolutions if any(one.drive.has_gas for one in self._cylinders) else 1)

    @property
    def breaks(self) -> Array:
        """The crank angles in degrees between which every quantity of the only machine is smooth."""
        low = self._effort.pieces.low if self._effort else np.zeros(1)
        return np.append(low[low < self.cycle], self.cycle)

    # counterweights

    def angle_of(self, product: Any) -> Any:
        """Return the direction of a weight from throw 1 in degrees, above −180 and up to 180; None, nan of nothing."""
        turned = product / self.throws[0].weight(1.0).product
        degrees = np.degrees(np.arctan2(turned.imag, turned.real))
        degrees = np.where(degrees > _REAL - 180, degrees, 180.0)
        if self.count is None:
            return float(degrees) if product else None
        return np.where(product != 0, degrees, np.nan)

    @property
    def counterweight_given(self) -> Any:
        """Size of the sum of the given counterweights in kg m."""
        return abs(sum(one.product for one in self.counterweights)) if self.counterweights else None

    @cached_property
    def _forward(self) -> Any:
        """The forward circle of order 1 over ω², in kg m."""
        first = self.bare.force.forward[0]
        return complex(first) if self.count is None else first

    @property
    def counterweight_best(self) -> Any:
        """Product in kg m of the counterweight that takes away the forward circle of order 1."""
        return abs(self._forward)

    @property
    def counterweight_best_angle(self) -> Any:
        """Its direction from throw 1 in degrees; None for a weight of nothing."""
        return self.angle_of(-self._forward)

    @property
    def least(self) -> Any:
        """The counterweight in kg m, complex, that leaves the least largest force."""
        return self._searched[0]

    @property
    def counterweight_least(self) -> Any:
        """Product in kg m of the counterweight that leaves the least largest force."""
        return abs(self.least)

    @property
    def counterweight_least_angle(self) -> Any:
        """Its direction from throw 1 in degrees; None for a weight of nothing."""
        return self.angle_of(self.least)

    @property
    def share_best(self) -> Any:
        """Share of the reciprocating mass with which a counterweight opposite the only throw is the least one's."""
        throw, *others = self.throws
        if others or not some(throw.mass != 0):
            return None
        opposite = -self.least / throw.weight(1.0).product
        aside = abs(opposite.imag) > _REAL * abs(opposite)
        if self.count is None:
            return None if aside else (opposite.real - throw.rotating) / throw.mass
        with np.errstate(all="ignore"):
            return np.where(aside | (throw.mass == 0), np.nan, (opposite.real - throw.rotating) / throw.mass)

    @cached_property
    def planes(self) -> tuple[Any, ...]:
        """Places in m of two planes for counterweights: those given, or of the outer cylinders; () if they are one."""
        given = self.machine.counterweights
        named = () if isinstance(given, tuple) else given.planes
        places = [one.place for one in self.throws if one.place is not None]
        outer = (min(places), max(places)) if places and min(places) < max(places) else ()
        return named or self.wheels or outer

    @cached_property
    def best_in_planes(self) -> tuple[Weight, ...]:
        """The counterweights in two planes that take away all that turns with the crank, force and moment.

        u_a + u_b = −F and (z_a − z_0) u_a + (z_b − z_0) u_b = −M, with F and M of the forward circles of order 1.
        """
        if not self.planes or self.bare.moment is None:
            return ()
        force, moment, (first, second) = self._forward, complex(self.bare.moment.forward[0]), self.planes
        far = ((first - self.z_0) * force - moment) / (second - first)
        return Weight(-force - far, 1, first), Weight(far, 1, second)

    @cached_property
    def best_shafts(self) -> tuple[Weight, ...]:
        """The weights on shafts that take away what no counterweight can: order 1 against, order 2 either way.

        Two of order 2 are those of Lanchester. Weights of nothing are left out; where a place makes one take the moment
        away as well, it has that place.
        """
        force, moment = self.bare.force, self.bare.moment
        found = []
        for order in (-1, 2, -2):
            circle = complex(force.of(order))
            if circle:
                arm = 1j if moment is None else complex(moment.of(order)) / circle
                place = None if self.z_0 is None or abs(arm.imag) > _REAL * (1 + abs(arm)) else self.z_0 + arm.real
                found.append(Weight(-circle / order**2, order, place))
        return tuple(found)

    @cached_property
    def locomotive(self) -> LocomotiveBalance | None:
        """What of it concerns the wheels of a locomotive; None of another machine."""
        return LocomotiveBalance(self, self.machine.locomotive) if self.machine.locomotive else None


def swirls(cylinder: CylinderForces) -> bool:
    """Return whether the moment of momentum of its masses about the shaft changes."""
    drive = cylinder.drive
    return drive.has_inertia and (some(drive.mechanism.offset != 0) or drive.rod is not None)


def swirl(state: State) -> Any:
    """Return dH/dt = m e b in N m, less the couple of an exact rod, which swings against the crank."""
    drive = state.drive
    moment = state.b * (drive.mass * drive.mechanism.offset)
    return moment - state.rod_couple if drive.rod else moment


class BookBalance:
    """The key values by the book's acceleration of first order, which are shown only on request."""

    def __init__(self, balance: MachineBalance) -> None:
        self._balance = balance

    @property
    def F_free_max_book(self) -> Extreme | None:
        """Largest unbalanced force in N."""
        return self._balance.largest(self._balance.book.force if self._balance.book else None)

    @property
    def M_free_max_book(self) -> Extreme | None:
        """Largest unbalanced moment in N m."""
        return self._balance.largest(self._balance.book.moment if self._balance.book else None)


class LocomotiveBalance:
    """The key values of a locomotive, in SI, at the angular velocity of its machine; None what needs one not given.

    The counterweights balance all that turns; what they have more than that, so as to balance a share of what goes to
    and fro, loads and lifts the wheel that has it: its hammer blow.
    """

    def __init__(self, balance: MachineBalance, given: Locomotive) -> None:
        self._balance, self._given = balance, given
        self._square = balance.omega * balance.omega if balance.omega is not None and some(balance.omega != 0) else None

    @property
    def train_speed(self) -> Any:
        """Speed of the train in m/s; None without the diameter of the wheels."""
        return None if self._square is None else self._rolling(self._balance.omega)

    def _rolling(self, omega: Any) -> Any:
        diameter = self._given.wheel_diameter
        return None if diameter is None else diameter / 2 * omega

    @property
    def traction_variation(self) -> Extreme | None:
        """Largest unbalanced force in N along the stroke lines, by which the pull at the drawbar varies."""
        return self._balance.searched("force along")

    @property
    def swaying_couple(self) -> Extreme | None:
        """Largest moment in N m of the unbalanced forces along the stroke lines about the upright axis."""
        return self._balance.searched("moment along")

    def _in_wheels(self, weights: Iterable[tuple[str, Weight]]) -> tuple[Any, Any]:
        """Return the sums of weights in the two wheels, as by a lever, in kg m; each with what it is of."""
        parts = [levered(one, self._balance.wheels, owner) for owner, one in weights]
        return sum(part[0].product for part in parts), sum(part[1].product for part in parts)

    @cached_property
    def unbalanced(self) -> tuple[Any, Any]:
        """What turns in each wheel in kg m, counterweights and rotating masses together."""
        rotating = [(one.name, one.weight(one.rotating)) for one in self._balance.throws]
        return self._in_wheels((*rotating, *(("counterweights", one) for one in self._balance.counterweights)))

    @property
    def hammer_blow(self) -> Any:
        """Largest force in N by which a wheel is loaded and lifted."""
        return None if self._square is None else _larger(*self.unbalanced) * self._square

    @property
    def hammer_speed(self) -> Any:
        """Revolutions per second at which the hammer blow is the load of a wheel; None without that, or a blow."""
        most = _larger(*self.unbalanced)
        if self._given.wheel_load is None or not some(most != 0):
            return None
        return sqrt(self._given.wheel_load / where(most != 0, most, math.nan)) / (2 * math.pi)

    @property
    def hammer_train_speed(self) -> Any:
        """Speed of the train in m/s at which it is."""
        return None if self.hammer_speed is None else self._rolling(2 * math.pi * self.hammer_speed)

    @property
    def share_allowed(self) -> Any:
        """Largest share of the reciprocating masses of which the counterweights keep the limit of the hammer blow."""
        if self._given.hammer_limit is None or self._square is None:
            return None
        whole = self._in_wheels((one.name, one.weight(one.mass)) for one in self._balance.throws)
        blow = _larger(*whole) * self._square
        return self._given.hammer_limit / where(blow > self._given.hammer_limit, blow, self._given.hammer_limit)


def _larger(one: Any, other: Any) -> Any:
    return where(abs(one) >= abs(other), abs(one), abs(other))
