"""Balancing of the whole machine: key values, the best counterweights and balance shafts, locomotives.

Forces and moments are those of `unbalanced`, complex and over ω², in kg m and kg m². A counterweight u, mass times
radius, on the crank adds u e^{iφ}. The rolling moment on the frame about the shaft is −(M + dH/dt), with the turning
effort M and the moment of momentum H of the masses about the shaft.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from functools import cached_property
from typing import Any

import numpy as np

from kurbel.arrays import Array
from kurbel.crank_angle import CrankAngle
from kurbel.errors import UsageError
from kurbel.machine.balance import Locomotive
from kurbel.numerics.arithmetic import some, sqrt, where
from kurbel.numerics.enclosing import ClosedCurve
from kurbel.numerics.extreme import Extreme, Extremes
from kurbel.quantity import column, key_value
from kurbel.solver.effort import Term, TurningEffort
from kurbel.solver.figures import AtAngles, Results, part
from kurbel.solver.forces import CylinderForces
from kurbel.solver.state import State
from kurbel.solver.unbalanced import Free, Terms, book_curvature, vector_at
from kurbel.solver.weights import OwnThrow, Weight, counterweights_of, levered, middle_of, shafts_of, wheels_of

_REAL = 1e-12
"""By what a direction, or a lever in m, may miss another by rounding."""


class BalanceColumns(AtAngles):
    """Unbalanced forces in N and moments in N m of one machine at crank angles φ (n,) in degrees.

    within: angles on the side of every jump that is meant.
    """

    commands = ("balance",)

    def __init__(self, balance: MachineBalance, phi: Array, within: Array) -> None:
        self.phi = phi
        self._balance, self._within = balance, within

    def _vectors(self, free: Free | None) -> tuple[Any, Any]:
        """Return the force and the moment (n,), complex; None for what there is not."""
        omega, curves = self._balance.omega, (free.force, free.moment) if free else (None, None)
        force, moment = (
            None if one is None or omega is None else vector_at(one, self.phi) * (omega * omega) for one in curves
        )
        return force, moment

    @cached_property
    def _free(self) -> tuple[Any, Any]:
        return self._vectors(self._balance.free)

    @cached_property
    def _book(self) -> tuple[Any, Any]:
        return self._vectors(self._balance.book)

    @column("F_x", "force")
    def F_x(self) -> Any:
        """Free force along the stroke line of cylinder 1, outward from the shaft."""
        return _part(np.real, self._free[0])

    @column("F_y", "force")
    def F_y(self) -> Any:
        """Free force across it, 90° on in the sense of rotation."""
        return _part(np.imag, self._free[0])

    @column("F", "force", on_request=("balance",))
    def F_free(self) -> Any:
        """Free force, its magnitude."""
        return _part(np.abs, self._free[0])

    @column("F_x,0", "force", on_request=("balance",))
    def F_x_book(self) -> Any:
        """F_x by the acceleration of first order (R 291)."""
        return _part(np.real, self._book[0])

    @column("F_y,0", "force", on_request=("balance",))
    def F_y_book(self) -> Any:
        """F_y by the acceleration of first order (R 291)."""
        return _part(np.imag, self._book[0])

    @column("M_x", "torque")
    def M_x(self) -> Any:
        """Free moment Σ (z − z_0) F_x."""
        return _part(np.real, self._free[1])

    @column("M_y", "torque")
    def M_y(self) -> Any:
        """Free moment Σ (z − z_0) F_y."""
        return _part(np.imag, self._free[1])

    @column("M_f", "torque", on_request=("balance",))
    def M_free(self) -> Any:
        """Free moment, its magnitude."""
        return _part(np.abs, self._free[1])

    @column("M_x,0", "torque", on_request=("balance",))
    def M_x_book(self) -> Any:
        """M_x by the acceleration of first order (R 291)."""
        return _part(np.real, self._book[1])

    @column("M_y,0", "torque", on_request=("balance",))
    def M_y_book(self) -> Any:
        """M_y by the acceleration of first order (R 291)."""
        return _part(np.imag, self._book[1])

    @column("M_roll", "torque")
    def M_roll(self) -> Any:
        """Rolling moment on the frame about the shaft, in the sense of rotation."""
        effort, roll = self._balance.effort, self._balance.roll
        return None if effort is None or roll is None else effort.at(effort.pieces, roll, self.phi, self._within)


def _part(component: Callable[[Any], Any], vector: Any) -> Any:
    return None if vector is None else component(vector)


class LocomotiveBalance(Results):
    """The key values of a locomotive, in SI, at the angular velocity of its machine; None what needs one not given.

    The counterweights balance all that turns; what they have more than that, so as to balance a share of what goes to
    and fro, loads and lifts the wheel that has it: its hammer blow.
    """

    command = "balance"

    def __init__(self, balance: MachineBalance, given: Locomotive) -> None:
        self._balance, self._given = balance, given
        self._square = balance.omega * balance.omega if balance.omega is not None and some(balance.omega != 0) else None

    def _rolling(self, omega: Any) -> Any:
        """Return the speed of the train in m/s; None without the diameter of the wheels."""
        diameter = self._given.wheel_diameter
        return None if diameter is None else diameter / 2 * omega

    @key_value("v_z", "velocity")
    def train_speed(self) -> Any:
        """Speed of the train."""
        return None if self._square is None else self._rolling(self._balance.omega)

    @key_value("F_z", "force")
    def traction_variation(self) -> Extreme | None:
        """Largest variation of the tractive force.

        The largest unbalanced force along the stroke lines.
        """
        return self._balance.farthest["force along"]

    @key_value("M_s", "torque")
    def swaying_couple(self) -> Extreme | None:
        """Largest swaying couple, about the upright axis."""
        return self._balance.farthest.get("moment along")

    def _in_wheels(self, weights: Iterable[tuple[str, Weight]]) -> tuple[Any, Any]:
        """Return the sums of weights in the two wheels, as by a lever, in kg m; each with what it is of."""
        parts = [levered(one, self._balance.wheels, owner) for owner, one in weights]
        return sum(part[0].product for part in parts), sum(part[1].product for part in parts)

    @cached_property
    def unbalanced(self) -> tuple[Any, Any]:
        """What turns in each wheel in kg m, counterweights and rotating masses together."""
        rotating = [(one.name, one.weight(one.rotating)) for one in self._balance.throws]
        return self._in_wheels((*rotating, *(("counterweights", one) for one in self._balance.counterweights)))

    @key_value("H", "force")
    def hammer_blow(self) -> Any:
        """Hammer blow: by how much a counterweight loads and lifts its wheel."""
        return None if self._square is None else _larger(*self.unbalanced) * self._square

    @key_value("n_H", "speed")
    def hammer_speed(self) -> Any:
        """Speed of rotation at which the hammer blow is the load of the wheel."""
        most = _larger(*self.unbalanced)
        if self._given.wheel_load is None or not some(most != 0):
            return None
        return sqrt(self._given.wheel_load / where(most != 0, most, math.nan)) / (2 * math.pi)

    @key_value("v_H", "velocity")
    def hammer_train_speed(self) -> Any:
        """Speed of the train at which it is."""
        return None if self.hammer_speed is None else self._rolling(2 * math.pi * self.hammer_speed)

    @key_value("c_H", "ratio")
    def share_allowed(self) -> Any:
        """Largest share of the reciprocating masses within the limit of the blow."""
        if self._given.hammer_limit is None or self._square is None:
            return None
        whole = self._in_wheels((one.name, one.weight(one.mass)) for one in self._balance.throws)
        blow = _larger(*whole) * self._square
        return self._given.hammer_limit / where(blow > self._given.hammer_limit, blow, self._given.hammer_limit)


def _larger(one: Any, other: Any) -> Any:
    return where(abs(one) >= abs(other), abs(one), abs(other))


class MachineBalance(Results):
    """The key values of the whole machine over a turn; `at(degrees)` gives the columns.

    Attributes are named by the ids of the key values, in SI; one that the machine does not have is None. Raises
    UsageError where nothing moves that could be balanced, and where a place of a weight is missing. count: of how many
    machines the numbers are, (machines,); then so are the key values, nan where a machine has none. compare: with the
    key values by the book's acceleration of first order, too.

    z_0: place in m from where moments are taken; wheels: of the counterweights in the wheels of a locomotive, none of
    another machine; counterweights: those of the machine file.
    """

    command = "balance"
    state = BalanceColumns

    def __init__(self, effort: TurningEffort, compare: bool = False) -> None:
        machine = self.machine = effort.machine
        self.count, self._cylinders, self._turning, self._compare = effort.count, effort.cylinders, effort, compare
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

    def _columns(self, phi: Array, within: Array) -> BalanceColumns:
        return BalanceColumns(self, phi, within)

    def _told(self, values: Any) -> Any:
        """Return complex numbers (machines,) of every machine, or that of the only one."""
        return values[0].item() if self.count is None else values

    # what moves, all of it over ω²

    @cached_property
    def _throws_alone(self) -> Terms:
        return Terms.of(self.throws, lambda one, angle: one.curvature(angle), self.count or 1)

    @cached_property
    def bare(self) -> Free:
        """What the throws give, without counterweights and balance shafts."""
        return Free(self._throws_alone, self.z_0)

    @cached_property
    def _weights(self) -> tuple[Weight, ...]:
        """The weights of the machine file, on the crank and on shafts."""
        return (*self.counterweights, *shafts_of(self.machine))

    @cached_property
    def free(self) -> Free:
        """What is unbalanced, with the counterweights and balance shafts of the machine file."""
        return Free(self._throws_alone.with_weights(self._weights), self.z_0) if self._weights else self.bare

    @cached_property
    def book(self) -> Free | None:
        """The same by the acceleration of first order, R 291; None where the book has none for a mechanism."""
        if any(book_curvature(one.mechanism, CrankAngle.of(0.0)) is None for one in self.throws):
            return None
        return Free(Terms.of(self.throws, book_curvature, self.count or 1).with_weights(self._weights), self.z_0)

    def times_square(self, lengths: Array, degrees: Array) -> Extreme | None:
        """Return largest lengths over ω² with their angles, times ω²; None without a speed."""
        if self.omega is None:
            return None
        return Extreme(self._told(lengths) * self.omega * self.omega, self._told(degrees))

    @cached_property
    def farthest(self) -> dict[str, Extreme | None]:
        """The largest unbalanced `force` and `moment`; of a locomotive also those `along` the stroke lines."""
        curves = {"force": self.free.force, "moment": self.free.moment}
        waves = {name: one.waves for name, one in curves.items() if one is not None}
        if self.machine.locomotive:
            waves |= {f"{name} along": (one + one[::-1].conj()) / 2 for name, one in waves.items()}
        found = ClosedCurve(np.concatenate([*waves.values()], axis=1)).farthest()
        return dict(zip(waves, map(self.times_square, *(np.split(one, len(waves)) for one in found))))

    @cached_property
    def _least(self) -> tuple[Any, Extreme | None]:
        """The counterweight in kg m that leaves the least largest force, complex, and that force.

        In the frame of the crank the force without a counterweight is the closed curve F e^{−iφ} = c_1 + c(φ), to
        which a weight u on the crank adds u: the least largest |F + u e^{iφ}| has −u in the centre of the smallest
        circle round it.
        """
        turning = self.bare.force.of(1)
        centre, radius, degrees = self.bare.force.plus(1, -turning).turned_back().least_circle()
        return self._told(-(turning + centre)), self.times_square(radius, degrees)

    @key_value("F_max", "force")
    def F_free_max(self) -> Extreme | None:
        """Largest free force."""
        return self.farthest["force"]

    @key_value("F_0,max", "force")
    def F_free_max_book(self) -> Extreme | None:
        """The same by the acceleration of first order (R 291)."""
        return self._farthest_of_book(lambda book: book.force)

    def _farthest_of_book(self, part: Callable[[Free], ClosedCurve | None]) -> Extreme | None:
        curve = part(self.book) if self._compare and self.book else None
        return None if curve is None else self.times_square(*curve.farthest())

    @key_value("M_f,max", "torque")
    def M_free_max(self) -> Extreme | None:
        """Largest free moment."""
        return self.farthest.get("moment")

    @key_value("M_f,0,max", "torque")
    def M_free_max_book(self) -> Extreme | None:
        """The same by the acceleration of first order (R 291)."""
        return self._farthest_of_book(lambda book: book.moment)

    # the rolling moment on the frame about the shaft: −(M + dH/dt), H the moment of momentum about the shaft

    @property
    def effort(self) -> TurningEffort | None:
        """The turning effort of the machine, with its losses; None without a speed."""
        return self._turning if self.omega is not None and some(self.omega != 0) else None

    @property
    def rolls_as_it_turns(self) -> bool:
        """Whether the rolling moment is the turning effort of `kurbel flywheel` with the other sign."""
        return not any(map(swirls, self._cylinders))

    @cached_property
    def roll(self) -> Array | None:
        """Samples of the rolling moment in N m on the pieces of the effort. Raises UsageError where no force acts."""
        if self.effort is None:
            return None
        swirling = [Term(-1.0, one, swirl) for one in self.effort.groups if swirls(one[0])]
        return self.effort.sampled(swirling) - self.effort.M

    @cached_property
    def _roll_extremes(self) -> Extremes | None:
        if self.roll is None:
            return None
        return self._turning.pieces.extremes(self.roll[None]).each(self._turning.result)[0]

    @key_value("M_roll,max", "torque", unless=lambda balance: balance.rolls_as_it_turns)
    def M_roll_max(self) -> Extreme | None:
        """Largest rolling moment on the frame."""
        return self._roll_extremes and self._roll_extremes.largest

    @key_value("M_roll,min", "torque", unless=lambda balance: balance.rolls_as_it_turns)
    def M_roll_min(self) -> Extreme | None:
        """Smallest rolling moment on the frame."""
        return self._roll_extremes and self._roll_extremes.smallest

    @property
    def cycle(self) -> float:
        """Degrees after which everything repeats: a turn, or with gas in the rolling moment that of the machine."""
        return 360.0 * (self.machine.revolutions if any(one.drive.has_gas for one in self._cylinders) else 1)

    @property
    def breaks(self) -> Array:
        """The crank angles in degrees between which every quantity of the only machine is smooth."""
        low = self.effort.pieces.low if self.effort else np.zeros(1)
        return np.append(low[low < self.cycle], self.cycle)

    # counterweights

    def _angle_of(self, product: Any) -> Any:
        """Return the direction of a weight from throw 1 in degrees, above −180 and up to 180; None, nan of nothing."""
        turned = product / self.throws[0].weight(1.0).product
        degrees = np.degrees(np.arctan2(turned.imag, turned.real))
        degrees = np.where(degrees > _REAL - 180, degrees, 180.0)
        if self.count is None:
            return float(degrees) if product else None
        return np.where(product != 0, degrees, np.nan)

    @key_value("u", "unbalance")
    def counterweight_given(self) -> Any:
        """Vector sum of the given counterweights, mass times radius."""
        return abs(sum(one.product for one in self.counterweights)) if self.counterweights else None

    @cached_property
    def _forward(self) -> Any:
        """The forward circle of order 1 over ω², in kg m."""
        return self._told(self.bare.force.of(1))

    @key_value("u_1", "unbalance")
    def counterweight_best(self) -> Any:
        """Counterweight against what rotates and half of what reciprocates.

        It takes away the forward circle of order 1.
        """
        return abs(self._forward)

    @key_value("α_1", "angle")
    def counterweight_best_angle(self) -> Any:
        """Its direction from throw 1."""
        return self._angle_of(-self._forward)

    @property
    def least(self) -> Any:
        """The counterweight in kg m, complex, that leaves the least largest force."""
        return self._least[0]

    @key_value("u_min", "unbalance")
    def counterweight_least(self) -> Any:
        """Counterweight that leaves the least largest free force."""
        return abs(self.least)

    @key_value("α_min", "angle")
    def counterweight_least_angle(self) -> Any:
        """Its direction from throw 1."""
        return self._angle_of(self.least)

    @key_value("c_min", "ratio")
    def share_best(self) -> Any:
        """Share of the reciprocating mass that it balances.

        Of a counterweight opposite the only throw; None where the least one is not opposite.
        """
        throw, *others = self.throws
        if others or not some(throw.mass != 0):
            return None
        opposite = -self.least / throw.weight(1.0).product
        aside = abs(opposite.imag) > _REAL * abs(opposite)
        if self.count is None:
            return None if aside else (opposite.real - throw.rotating) / throw.mass
        with np.errstate(all="ignore"):
            return np.where(aside | (throw.mass == 0), np.nan, (opposite.real - throw.rotating) / throw.mass)

    @key_value("F_min", "force")
    def F_free_best(self) -> Extreme | None:
        """Largest free force that it leaves."""
        return self._least[1]

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
        force, moment, (first, second) = self._forward, self._told(self.bare.moment.of(1)), self.planes
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
            circle = self._told(force.of(order))
            if circle:
                arm = 1j if moment is None else self._told(moment.of(order)) / circle
                place = None if self.z_0 is None or abs(arm.imag) > _REAL * (1 + abs(arm)) else self.z_0 + arm.real
                found.append(Weight(-circle / order**2, order, place))
        return tuple(found)

    @part(LocomotiveBalance)
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
