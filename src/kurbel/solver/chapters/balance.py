"""Balancing of the whole machine: its unbalanced forces and moments, and the counterweights against them.

The unbalanced (shaking) force is minus the sum of mass times acceleration of all moving parts (d'Alembert), at uniform
rotation. It is a complex number in the plane normal to the shaft, divided by ω² throughout, so that it is in kg m:

      F_y ↑   ∕ stroke line of a cylinder, at its bank angle γ      φ − δ  its own crank angle, 0 on its stroke line
          │ ∕                                                       m, m_rot  reciprocating mass, mass at the crank pin
    shaft O────→ F_x  stroke line of cylinder 1, outward            z, z_0    position along the shaft, and of reference

    F = Σ (m x″(φ − δ) + m_rot R e^{i(φ − δ)}) e^{iγ}     all angles in the sense of rotation, x″ = d²x/dφ²
    M = Σ (z − z_0) F                                     a moment vector turned back by 90°, parallel to its force
    F = Σ c_n e^{inφ}                                     rotating vectors of order n; n < 0 against the crank
    u n² e^{±inφ}                                         force of a weight u (mass times radius) turning at ±n ω

The rolling moment on the frame about the shaft is −(M + dH/dt), with the torque M on the shaft and the angular momentum
H of the reciprocating masses and rods about the shaft.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import cached_property
from typing import Any

import numpy as np

from kurbel.arrays import Array, ComplexArray, Number
from kurbel.crank_angle import CrankAngle, unit_vector
from kurbel.errors import UsageError
from kurbel.numerics.arithmetic import some, sqrt, unless_cancelled, where
from kurbel.numerics.enclosing import ClosedCurve
from kurbel.numerics.extreme import Extreme, Extremes
from kurbel.quantity import Computed, Heading, value
from kurbel.solver.chapters.unbalanced import (
    Unbalanced,
    book_curvature,
    contributions_of,
    vector_at,
)
from kurbel.solver.effort import Term, TurningEffort
from kurbel.solver.figures import AtAngles, Results, result
from kurbel.solver.forces import CylinderForces
from kurbel.solver.shaft import (
    Weight,
    counterweights_of,
    middle_of,
    split_by_lever,
    throws_with_masses,
    wheels_of,
)
from kurbel.solver.state import State

_REAL = 1e-12
"""Rounding of a direction (relative), or of a lever in m."""


# over the crank angle


def _vector(
    name: str,
    symbol: str,
    kind: str,
    text: str,
    of: Callable[[ComplexArray], Array],
    asked: bool = False,
) -> Computed[Array | None]:
    """Return a column: a component, or the magnitude, of a vector of `BalanceColumns`; asked: on request only."""

    def part(columns: BalanceColumns) -> Array | None:
        vector = columns.vector(name)
        if vector is None:
            return None
        return of(vector)

    return value(symbol, kind, text, part, on_request=("balance",) if asked else ())


class BalanceColumns(AtAngles):
    """Unbalanced forces in N and moments in N m of one machine at crank angles φ (n,) in degrees.

    within: at a jump the value is taken on the side of these angles (n,).
    """

    commands = ("balance",)
    F_x = _vector(
        "force",
        "F_x",
        "force",
        "Unbalanced force along the stroke line of cylinder 1, outward from the shaft",
        np.real,
    )
    F_y = _vector(
        "force",
        "F_y",
        "force",
        "Unbalanced force across it, 90° ahead in the sense of rotation",
        np.imag,
    )
    F_free = _vector("force", "F", "force", "Magnitude of the unbalanced force", np.abs, asked=True)
    F_x_book = _vector(
        "book force",
        "F_x,0",
        "force",
        "F_x by the acceleration of first order (R 291)",
        np.real,
        True,
    )
    F_y_book = _vector(
        "book force",
        "F_y,0",
        "force",
        "F_y by the acceleration of first order (R 291)",
        np.imag,
        True,
    )
    M_x = _vector("moment", "M_x", "torque", "Unbalanced moment Σ (z − z_0) F_x", np.real)
    M_y = _vector("moment", "M_y", "torque", "Unbalanced moment Σ (z − z_0) F_y", np.imag)
    M_free = _vector(
        "moment", "M_f", "torque", "Magnitude of the unbalanced moment", np.abs, asked=True
    )
    M_x_book = _vector(
        "book moment",
        "M_x,0",
        "torque",
        "M_x by the acceleration of first order (R 291)",
        np.real,
        True,
    )
    M_y_book = _vector(
        "book moment",
        "M_y,0",
        "torque",
        "M_y by the acceleration of first order (R 291)",
        np.imag,
        True,
    )
    M_roll = value(
        "M_roll",
        "torque",
        "Rolling moment on the frame about the shaft, in the sense of rotation",
        lambda columns: columns.rolling(),
    )

    def __init__(self, balance: MachineBalance, phi: Array, within: Array) -> None:
        self.phi = phi
        self._balance = balance
        self._within = within

    def vector(self, name: str) -> ComplexArray | None:
        """Return a vector (n,): `force`, `moment`, `book force`, `book moment`; None where it does not exist."""
        curve = self._balance.curve(name)
        omega = self._balance.omega
        if curve is None or omega is None:
            return None
        return vector_at(curve, self.phi) * (omega * omega)

    def rolling(self) -> Array | None:
        """Return the rolling moment (n,) in N m; None without a speed."""
        effort = self._balance.effort
        roll = self._balance.roll
        if effort is None or roll is None:
            return None
        return effort.at(effort.pieces, roll, self.phi, self._within)


# the whole machine


class MachineBalance(Results):
    """Key values of the balance of the whole machine; `at(degrees)` gives the columns.

    Attributes are named by the ids of the key values, in SI; None where the machine does not have one. Raises
    UsageError where there are no moving masses, and where the position of a weight is missing. count: number of
    machines, whose key values are arrays (machines,), nan where a machine has none. compare: whether to compute also
    the key values by the acceleration of first order (R 291).

    z_0: reference plane of moments in m; wheels: positions in m of the wheels of a locomotive that have
    counterweights, () for another machine; counterweights: those of the machine file.
    """

    command = "balance"
    state = BalanceColumns

    _unbalanced = Heading("Unbalanced forces and moments")
    _book = "The same by the acceleration of first order (R 291)"
    F_free_max = value(
        "F_max", "force", "Largest unbalanced force", lambda balance: balance.largest("force")
    )
    F_free_max_book = value(
        "F_0,max", "force", _book, lambda balance: balance.largest_of_book("book force")
    )
    M_free_max = value(
        "M_f,max", "torque", "Largest unbalanced moment", lambda balance: balance.largest("moment")
    )
    M_free_max_book = value(
        "M_f,0,max", "torque", _book, lambda balance: balance.largest_of_book("book moment")
    )
    M_roll_max = value(
        "M_roll,max",
        "torque",
        "Largest rolling moment on the frame",
        lambda balance: balance.rolling and balance.rolling.largest,
        unless=lambda balance: balance.rolls_as_it_turns,
    )
    M_roll_min = value(
        "M_roll,min",
        "torque",
        "Smallest rolling moment on the frame",
        lambda balance: balance.rolling and balance.rolling.smallest,
        unless=lambda balance: balance.rolls_as_it_turns,
    )
    _counterweights = Heading("Counterweights")
    counterweight_given = value(
        "u",
        "unbalance",
        "Vector sum of the given counterweights, mass times radius",
        lambda balance: balance.sum_of_counterweights(),
        for_entry=True,
    )
    # it cancels the forward rotating vector of order 1
    _direction = "Its direction from throw 1"
    counterweight_best = value(
        "u_1",
        "unbalance",
        "Counterweight balancing all rotating and half of the reciprocating mass",
        lambda balance: balance.shown(abs(balance.forward)),
        for_entry=True,
    )
    counterweight_best_angle = value(
        "α_1",
        "angle",
        _direction,
        lambda balance: balance.angle_of(-balance.forward),
        for_entry=True,
    )
    counterweight_least = value(
        "u_min",
        "unbalance",
        "Counterweight that minimises the largest unbalanced force",
        lambda balance: balance.shown(abs(balance.least)),
        for_entry=True,
    )
    counterweight_least_angle = value(
        "α_min",
        "angle",
        _direction,
        lambda balance: balance.angle_of(balance.least),
        for_entry=True,
    )
    share_best = value(
        "c_min",
        "ratio",
        "Share of the reciprocating mass that this counterweight balances",
        lambda balance: balance.share_of_least(),
        for_entry=True,
    )
    F_free_best = value(
        "F_min",
        "force",
        "Largest unbalanced force with it",
        lambda balance: balance.times_omega_squared(*balance.smallest_circle[1:]),
    )

    _locomotive = Heading("Locomotive")
    counterweight_wheel = value(
        "u_R", "unbalance", "Largest counterweight of a wheel, mass times radius", for_entry=True
    )
    train_speed = value("v_z", "velocity", "Speed of the train")
    traction_variation = value("F_z", "force", "Largest variation of the tractive force")
    swaying_couple = value("M_s", "torque", "Largest swaying couple, about the vertical axis")
    hammer_blow = value(
        "H", "force", "Hammer blow: amplitude by which a counterweight loads and lifts its wheel"
    )
    hammer_speed = value(
        "n_H", "speed", "Speed of rotation at which the hammer blow equals the wheel load"
    )
    hammer_train_speed = value(
        "v_H", "velocity", "Speed of the train at which the hammer blow equals the wheel load"
    )
    share_allowed = value(
        "c_H",
        "ratio",
        "Largest share of the reciprocating masses that keeps the hammer blow within its limit",
    )

    def __init__(self, effort: TurningEffort, compare: bool = False) -> None:
        machine = effort.machine
        self.machine = machine
        self.count = effort.count
        self._cylinders = effort.cylinders
        self._turning = effort
        self._compare = compare
        # counterweights turn with their throw, whether or not its cylinder has masses
        cranks = throws_with_masses(machine)
        with_masses = [throw for throw in cranks if throw.cylinder.masses]
        self.counterweights = tuple(counterweights_of(machine, cranks)) if cranks else ()
        moving = any(some(throw.mass != 0) or some(throw.rotating != 0) for throw in with_masses)
        turning = any(some(weight.product != 0) for weight in self.counterweights)
        if not (moving or turning):
            raise UsageError(
                f"{machine.name}: no moving masses to balance; give 'masses' to its cylinders"
            )
        for throw in with_masses:
            if throw.cylinder.mechanism.quick_return:
                raise UsageError(
                    f"{throw.name}: the masses of a quick-return mechanism are not known"
                )
        self.throws = tuple(with_masses or cranks)
        self._first_arm = cranks[0].arm
        self.omega = None if machine.speed is None else 2 * math.pi * machine.speed
        self.z_0 = middle_of(machine)
        self.wheels = wheels_of(machine)

    def _columns(self, phi: Array, within: Array) -> BalanceColumns:
        return BalanceColumns(self, phi, within)

    def shown(self, values: Array) -> Any:
        """Return real numbers (machines,); of the only machine a float, None for nan."""
        if self.count is None and math.isnan(values[0]):
            return None
        return result(values, self.count)

    def sum_of_counterweights(self) -> Any:
        """Return the magnitude in kg m of the vector sum of the given counterweights; None without any."""
        if not self.counterweights:
            return None
        return abs(sum(weight.product for weight in self.counterweights))

    # unbalanced vectors, all divided by ω²

    def _with(self, weights: Sequence[Weight], book: bool = False) -> Unbalanced:
        return Unbalanced(contributions_of(self.throws, weights, book, self.count or 1), self.z_0)

    @cached_property
    def _weights(self) -> tuple[Weight, ...]:
        """The weights in the machine file, on the crank and on balance shafts."""
        weights = list(self.counterweights)
        for shaft in self.machine.balance_shafts:
            order = -shaft.order if shaft.against else shaft.order
            product = shaft.product * unit_vector(shaft.angle)
            weights.append(Weight(product, order, shaft.axial_position))
        return tuple(weights)

    @cached_property
    def bare(self) -> Unbalanced:
        """The unbalance of the throws, without counterweights and balance shafts."""
        return self._with(())

    @cached_property
    def free(self) -> Unbalanced:
        """The unbalance with the counterweights and balance shafts of the machine file."""
        if self._weights:
            return self._with(self._weights)
        return self.bare

    @cached_property
    def book(self) -> Unbalanced | None:
        """The same by the acceleration of first order, R 291; None where the book has none for a mechanism."""
        for throw in self.throws:
            if book_curvature(throw.cylinder.mechanism, CrankAngle.of(0.0)) is None:
                return None
        return self._with(self._weights, book=True)

    def curve(self, name: str) -> ClosedCurve | None:
        """Return `force`, `moment`, `book force` or `book moment`, over ω²; None where it does not exist."""
        vectors = self.book if name.startswith("book") else self.free
        if vectors is None:
            return None
        if name.endswith("force"):
            return vectors.force
        return vectors.moment

    def times_omega_squared(self, lengths: Array, degrees: Array) -> Extreme | None:
        """Return the extreme of a vector from its largest magnitude over ω²; None without a speed."""
        if self.omega is None:
            return None
        return Extreme(self.shown(lengths) * self.omega * self.omega, self.shown(degrees))

    def largest(self, name: str, along: bool = False) -> Extreme | None:
        """Return the largest magnitude of a vector, see `curve`; along: of what it has along the stroke lines."""
        curve = self.curve(name)
        if curve is None:
            return None
        if along:
            curve = ClosedCurve((curve.waves + curve.waves[::-1].conj()) / 2)
        return self.times_omega_squared(*curve.farthest())

    def largest_of_book(self, name: str) -> Extreme | None:
        """Return the largest magnitude of a vector by the acceleration of first order, where these are compared."""
        if not self._compare:
            return None
        return self.largest(name)

    # the rolling moment on the frame about the shaft: −(M + dH/dt), H the angular momentum about the shaft

    @property
    def effort(self) -> TurningEffort | None:
        """The turning effort of the machine, with its losses; None without a speed."""
        return self._turning if self.omega is not None and some(self.omega != 0) else None

    @property
    def rolls_as_it_turns(self) -> bool:
        """Whether the rolling moment is minus the torque of `kurbel flywheel`, since dH/dt = 0."""
        return not any(map(changes_angular_momentum, self._cylinders))

    @cached_property
    def roll(self) -> Array | None:
        """Samples of the rolling moment in N m on the pieces of the effort. Raises UsageError where no force acts."""

        def angular_momentum_rate(state: State) -> Number:
            """Return dH/dt = m e b in N m, less the couple of an exact rod, as ψ counts against the rotation."""
            drive = state.drive
            moment = state.b * (drive.mass * drive.mechanism.offset)
            if drive.cylinder.link_rod is not None:
                moment = moment + state.knuckle_momentum_rate
            if not drive.rod:
                return moment
            return moment - state.rod_couple

        if self.effort is None:
            return None
        changing = [
            Term(-1.0, group, angular_momentum_rate)
            for group in self.effort.groups
            if changes_angular_momentum(group[0])
        ]
        return self.effort.sampled(changing) - self.effort.M

    @cached_property
    def rolling(self) -> Extremes | None:
        """The extremes of the rolling moment."""
        if self.roll is None:
            return None
        return self._turning.pieces.extremes(self.roll[None]).each(self._turning.result)[0]

    @property
    def cycle(self) -> float:
        """Period in degrees: one revolution, or the cycle of the machine where gas forces are in the rolling moment."""
        has_gas = any(cylinder.drive.has_gas for cylinder in self._cylinders)
        if not has_gas:
            return 360.0
        return 360.0 * self.machine.revolutions

    @property
    def breaks(self) -> Array:
        """The crank angles in degrees between which every quantity of the only machine is smooth."""
        low = self.effort.pieces.low if self.effort else np.zeros(1)
        return np.append(low[low < self.cycle], self.cycle)

    # counterweights, and shafts

    @property
    def forward(self) -> ComplexArray:
        """Forward rotating vector of order 1 over ω², in kg m, (machines,)."""
        return self.bare.force.of(1)

    @cached_property
    def smallest_circle(self) -> tuple[ComplexArray, Array, Array]:
        """The smallest circle round the curve c, see `least`."""
        return self.bare.force.plus(1, -self.forward).turned_back().least_circle()

    @property
    def least(self) -> ComplexArray:
        """The counterweight u in kg m, (machines,), that minimises the largest unbalanced force.

        In the frame of the crank the force without a counterweight is the closed curve F e^{−iφ} = c_1 + c(φ). A weight
        u on the crank adds u, so that max |F + u e^{iφ}| is smallest where −u is the centre of the smallest circle that
        encloses the curve.
        """
        centre = self.forward + self.smallest_circle[0]
        return -np.asarray(unless_cancelled(centre, np.abs(self.forward)))

    def angle_of(self, product: ComplexArray) -> Any:
        """Return the direction of a weight (machines,) from throw 1 in degrees, in (−180, 180]; none for no weight."""
        degrees = np.degrees(np.angle(product / self._first_arm))
        degrees = np.where(degrees > _REAL - 180, degrees, 180.0)
        return self.shown(np.where(product != 0, degrees, math.nan))

    def share_of_least(self) -> Any:
        """Return the share of the reciprocating mass that the counterweight `least` balances in a single-throw machine.

        None where there are several throws, or where it is not opposite the throw.
        """
        throw, *others = self.throws
        if others or not some(throw.mass != 0):
            return None
        opposite = -self.least / throw.arm
        is_opposite = np.abs(opposite.imag) <= _REAL * np.abs(opposite)
        has_share = is_opposite & (throw.mass != 0)
        share = (opposite.real - throw.rotating) / np.where(has_share, throw.mass, math.nan)
        return self.shown(share)

    @property
    def planes(self) -> tuple[Any, ...]:
        """The two correction planes in m: those given, else of the wheels, else of the outer cylinders; or ()."""
        counterweights = self.machine.counterweights
        if not isinstance(counterweights, tuple) and counterweights.planes:
            return counterweights.planes
        if self.wheels:
            return self.wheels
        positions = [throw.place for throw in self.throws if throw.place is not None]
        if positions and min(positions) < max(positions):
            return min(positions), max(positions)
        return ()

    def _in_planes(self, order: int) -> tuple[Weight, ...]:
        """Return the weights in two planes that cancel force and moment of an order; () without planes.

        u_a + u_b = −F/n² and (z_a − z_0) u_a + (z_b − z_0) u_b = −M/n², with the rotating vectors F and M of the order.
        """
        if not self.planes or self.bare.moment is None or self.z_0 is None:
            return ()
        force = complex(self.bare.force.of(order)[0])
        moment = complex(self.bare.moment.of(order)[0])
        z_a, z_b = self.planes
        product_b = ((z_a - self.z_0) * force - moment) / (z_b - z_a)
        product_a = -force - product_b
        return (
            Weight(product_a / order**2, order, z_a),
            Weight(product_b / order**2, order, z_b),
        )

    @cached_property
    def best_in_planes(self) -> tuple[Weight, ...]:
        """The counterweights in two planes that cancel the vectors of force and moment that rotate with the crank."""
        return self._in_planes(1)

    @cached_property
    def best_shafts(self) -> tuple[Weight, ...]:
        """The weights on balance shafts that cancel what counterweights cannot: orders −1, 2 and −2.

        The pair of orders 2 and −2 is the Lanchester balancer. Weights of zero are left out. Where one weight at the
        right position cancels the moment as well, it is placed there; otherwise a shaft has two, in the two planes.
        """
        weights: list[Weight] = []
        for order in (-1, 2, -2):
            # rotating vectors of force and moment
            force = complex(self.bare.force.of(order)[0])
            moment: complex | None = None
            if self.bare.moment is not None:
                moment = complex(self.bare.moment.of(order)[0])
            # a real lever M/F is where one weight cancels both
            lever = 1j if moment is None or not force else moment / force
            has_place = abs(lever.imag) <= _REAL * (1 + abs(lever)) and self.z_0 is not None
            if moment and not has_place and self.planes:
                weights += self._in_planes(order)
            elif force:
                position: Number | None = None
                if has_place and self.z_0 is not None:
                    position = self.z_0 + lever.real
                weights.append(Weight(-force / order**2, order, position))
        return tuple(weights)

    # the wheels of a locomotive

    def in_wheels(self, of: str = "all") -> tuple[Any, Any]:
        """Return the rotating unbalance in each of the two wheels in kg m, distributed by the lever law.

        of: `all`, counterweights and rotating masses; `counterweights`, these alone; `reciprocating`, the reciprocating
        masses as if they turned with the crank.
        """
        near_sum: Any = 0
        far_sum: Any = 0
        if of != "counterweights":
            for throw in self.throws:
                mass = throw.mass if of == "reciprocating" else throw.rotating
                near, far = split_by_lever(throw.weight(mass), self.wheels, throw.name)
                near_sum = near_sum + near.product
                far_sum = far_sum + far.product
        if of != "reciprocating":
            for counterweight in self.counterweights:
                near, far = split_by_lever(counterweight, self.wheels, "counterweights")
                near_sum = near_sum + near.product
                far_sum = far_sum + far.product
        return near_sum, far_sum

    def _larger_in_wheels(self, of: str) -> Any:
        """Return the larger magnitude in kg m of `in_wheels`."""
        near, far = map(abs, self.in_wheels(of))
        return where(near >= far, near, far)

    @cached_property
    def answers(self) -> dict[str, object]:
        """Key values of a locomotive by id; {} for another machine.

        The counterweights balance all rotating masses. Their excess, for a share of the reciprocating
        masses, alternately loads and unloads its wheel: the hammer blow.
        """
        locomotive = self.machine.locomotive
        omega = self.omega
        if locomotive is None:
            return {}
        answers: dict[str, object] = {
            "traction_variation": self.largest("force", along=True),
            "swaying_couple": self.largest("moment", along=True),
        }
        # rotating unbalance of the worse wheel: that which is left, and those of all reciprocating masses and the weights
        excess = self._larger_in_wheels("all")
        reciprocating = self._larger_in_wheels("reciprocating")
        counterweight = self._larger_in_wheels("counterweights")
        if self.counterweights:
            answers["counterweight_wheel"] = counterweight
        # at the speed
        if omega is not None and some(omega != 0):
            answers["hammer_blow"] = excess * (omega * omega)
            limit = locomotive.hammer_limit
            if limit is not None:
                blow = reciprocating * (omega * omega)
                answers["share_allowed"] = limit / where(blow > limit, blow, limit)
            if locomotive.wheel_diameter is not None:
                answers["train_speed"] = locomotive.wheel_diameter / 2 * omega
        # the speed at which the wheel lifts
        if locomotive.wheel_load is not None and some(excess != 0):
            divisor = where(excess != 0, excess, math.nan)
            hammer_speed = sqrt(locomotive.wheel_load / divisor) / (2 * math.pi)
            answers["hammer_speed"] = hammer_speed
            if locomotive.wheel_diameter is not None:
                radius = locomotive.wheel_diameter / 2
                answers["hammer_train_speed"] = radius * (2 * math.pi * hammer_speed)
        return answers


def changes_angular_momentum(cylinder: CylinderForces) -> bool:
    """Return whether the angular momentum of its reciprocating masses and rod about the shaft varies."""
    drive = cylinder.drive
    turns_unevenly = drive.rod is not None or some(drive.knuckle_mass != 0)
    return drive.has_inertia and (some(drive.mechanism.offset != 0) or turns_unevenly)
