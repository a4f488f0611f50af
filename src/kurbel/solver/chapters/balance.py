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
from typing import TYPE_CHECKING, Any, NamedTuple, cast

import numpy as np

from kurbel.arrays import Array, ComplexArray, Number
from kurbel.crank_angle import CrankAngle, unit_vector
from kurbel.errors import UsageError
from kurbel.mechanisms import Mechanism
from kurbel.numerics.arithmetic import some, sqrt, unless_cancelled, where
from kurbel.numerics.enclosing import ClosedCurve
from kurbel.numerics.extreme import Extreme, Extremes
from kurbel.quantity import Computed, Heading, value
from kurbel.solver.effort import Term, TurningEffort
from kurbel.solver.figures import AtAngles, Results, result
from kurbel.solver.forces import CylinderForces
from kurbel.solver.shaft import (
    CylinderThrow,
    Weight,
    counterweights_of,
    middle_of,
    split_by_lever,
    throws_with_masses,
    wheels_of,
)
from kurbel.solver.state import State

if TYPE_CHECKING:
    from kurbel.mechanisms.link_rod import LinkedPiston

_SAMPLES = 256
"""Samples of a revolution for the Fourier analysis of a mechanism; repeatedly four times as many for a short rod, …"""
_MOST_SAMPLES = 1 << 20
"""… up to this many for a batch together: a batch of more raises an error, and its machines are computed singly."""
_SHOWN = 1e-9
"""Relative to the largest order: smaller ones are not listed."""
_FEWEST = 8
"""Smallest number of orders, so that those of balance shafts are included."""
_MOST = 24
"""Largest number of orders listed; a rod hardly longer than the crank has thousands, which decrease slowly."""
_AT_ONCE = 64
"""Orders that are computed at all angles together."""
_EPS = float(np.finfo(float).eps)
_REAL = 1e-12
"""Rounding of a direction (relative), or of a lever in m."""

# forces and moments, order by order


def orders_of(throw: CylinderThrow, book: bool, count: int) -> ComplexArray:
    """Return the Fourier coefficients c_n in m, n = 1 … k, (k, count): x″ = 2 Re Σ c_n e^{inφ}; rounding is set to 0.

    Samples are added until all orders in the upper half of those resolved vanish; a short rod needs more. book: of the
    acceleration of first order. Raises UsageError for a rod with more orders than can be computed, L/R < 1.00000001.
    """
    mechanism = throw.cylinder.mechanism
    samples = _SAMPLES
    while samples * count <= _MOST_SAMPLES:
        # d²x/dφ² at equal steps of a revolution
        degrees: Array = np.arange(samples, dtype=float)[:, None] * (360.0 / samples)
        angle = CrankAngle.of(degrees)
        curvature = book_curvature(mechanism, angle) if book else mechanism.curvature(angle)
        values = np.broadcast_to(curvature, (samples, count))
        waves = np.fft.rfft(values, axis=0)[1:] / samples
        rounding = _EPS * np.abs(values).max(axis=0)
        # cosines and sines each: an even function is without sines
        waves = unless_cancelled(waves, rounding, 1.0)
        last = int(np.flatnonzero(waves.any(axis=1)).max(initial=0)) + 1
        if last <= samples // 4:
            return waves[:last]
        samples *= 4
    raise UsageError(
        f"{throw.name}: the rod is so little longer than the crank that the orders of its forces do not converge"
    )


def book_curvature(mechanism: Mechanism, angle: CrankAngle) -> Any:
    """Return d²x/dφ² in m of first order, R 291; the true one where there is no rod, None where the book has none."""
    offer = next((offer for offer in mechanism.OFFERS if offer.quantity.id == "b_book"), None)
    if offer:
        return offer.factor(mechanism, angle)
    return mechanism.curvature(angle)


class Contribution(NamedTuple):
    """What a throw or weight adds to the unbalanced force over ω²; place: along the shaft in m, None if not known.

    waves: its Fourier coefficients in kg m from −k to k, (2k + 1, count).
    """

    waves: ComplexArray
    place: Number | None


def contributions_of(
    throws: Sequence[CylinderThrow], weights: Sequence[Weight], book: bool, count: int
) -> list[Contribution]:
    """Return (m x″(φ − δ) + m_rot R e^{i(φ − δ)}) e^{iγ} of each throw, and u n² e^{inφ} of each weight.

    book: with the acceleration of first order. Cylinders with the same mechanism share one analysis.
    """
    # one analysis for each mechanism
    throws_by_mechanism = {id(throw.cylinder.mechanism): throw for throw in throws}
    orders = {key: orders_of(throw, book, count) for key, throw in throws_by_mechanism.items()}
    k = max(_FEWEST, *map(len, orders.values()))
    contributions = list[Contribution]()
    # m x″(φ − δ) e^{iγ}: a real function has the conjugate waves backward
    for throw in throws:
        listed = orders[id(throw.cylinder.mechanism)]
        forward = np.concatenate((listed, np.zeros((k - len(listed), count))))
        waves = np.concatenate((forward[::-1].conj(), np.zeros((1, count)), forward))
        lag = np.broadcast_to(throw.lag, count)
        turned_back = np.multiply.outer(np.arange(-k, k + 1), lag)
        turned = waves * throw.mass * unit_vector(throw.bank - turned_back)
        contributions.append(Contribution(turned, throw.place))
    contributions += _of_knuckles(throws, k, count)
    # m_rot R of the throws, and the weights: u n² e^{inφ}
    rotating = [throw.weight(throw.rotating) for throw in throws]
    for weight in (*rotating, *weights):
        if some(weight.product != 0):
            waves = np.zeros((2 * k + 1, count), complex)
            waves[k + weight.order] = weight.product * weight.order**2
            contributions.append(Contribution(waves, weight.place))
    return contributions


def _of_knuckles(throws: Sequence[CylinderThrow], k: int, count: int) -> list[Contribution]:
    """Return −m_k z″(φ − δ) e^{iγ} of the mass of each link rod at its knuckle pin, from order −k to k."""
    contributions = list[Contribution]()
    for throw in throws:
        if not some(throw.knuckle_mass != 0):
            continue
        # z″ is complex: its waves forward and backward are not conjugate
        samples = max(_SAMPLES, 4 * k)
        degrees: Array = np.arange(samples, dtype=float)[:, None] * (360.0 / samples)
        linked_piston = cast("LinkedPiston", throw.cylinder.mechanism)
        _, acceleration = linked_piston.knuckle_motion(CrankAngle.of(degrees))
        values = np.broadcast_to(acceleration, (samples, count))
        transformed = np.fft.fft(values, axis=0) / samples
        orders = np.arange(-k, k + 1)
        waves = unless_cancelled(transformed[orders], _EPS * np.abs(values).max(axis=0), 1.0)
        lag = np.broadcast_to(throw.lag, count)
        turned_back = np.multiply.outer(orders, lag)
        turned = waves * -throw.knuckle_mass * unit_vector(throw.bank - turned_back)
        contributions.append(Contribution(turned, throw.place))
    return contributions


class Unbalanced:
    """The unbalanced force over ω² in kg m, and the moment over ω² in kg m², of the sum of all parts.

    z_0: reference plane of the moments in m; the moment is None where it, or a place, is not known. Orders that cancel
    are exactly 0. orders: of one machine, the lowest orders that any part has, whether or not they cancel in the sum;
    next_order: the first one that is not listed, None if all are.
    """

    def __init__(self, parts: Sequence[Contribution], z_0: Number | None) -> None:
        waves = np.array([part.waves for part in parts])
        self.force = _summed(waves, [1.0] * len(parts))
        # a moment needs the levers of all parts
        self.moment: ClosedCurve | None = None
        places = [part.place for part in parts if part.place is not None]
        if len(places) == len(parts) and (z_0 is not None or not places):
            self.moment = _summed(waves, [place - z_0 for place in places if z_0 is not None])
        # orders are those of the waves forward and backward together
        sizes = np.abs(waves[:, :, 0]).max(axis=0)
        sums = (sizes + sizes[::-1])[len(sizes) // 2 + 1 :]
        orders = tuple((np.flatnonzero(sums > _SHOWN * sums.max()) + 1).tolist())
        self.orders = orders[:_MOST]
        self.next_order = orders[_MOST] if len(orders) > _MOST else None


def _summed(waves: ComplexArray, levers: Sequence[Number]) -> ClosedCurve:
    terms = waves * np.array([np.broadcast_to(lever, waves.shape[2]) for lever in levers])[:, None]
    return ClosedCurve(unless_cancelled(terms.sum(axis=0), np.abs(terms).sum(axis=0)))


def vector_at(curve: ClosedCurve, degrees: Array) -> ComplexArray:
    """Return the force or moment vectors (n,) of one machine at crank angles (n,) in degrees; rounding is set to 0."""
    waves = curve.waves[:, 0]
    present = np.flatnonzero(waves)
    vectors = np.zeros(degrees.shape, complex)
    offsets: Array = np.empty(0)
    within_block = np.empty(0, complex)
    for begin in range(0, len(present), _AT_ONCE):
        block = present[begin : begin + _AT_ONCE]
        # e^{inφ} = e^{iaφ} e^{i(n − a)φ}: the second factor is that of the block before; of few waves a = 0
        first = curve.numbers[block[0]] if len(present) > _AT_ONCE else 0
        apart = curve.numbers[block] - first
        if not np.array_equal(apart, offsets):
            offsets = apart
            within_block = unit_vector(np.multiply.outer(offsets, degrees))
        turned = waves[block, None] * (unit_vector(first * degrees) * within_block)
        # one after another, so that the sum at an angle does not depend on the others
        for wave in turned:
            vectors += wave
    return unless_cancelled(vectors, np.abs(waves).sum())


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
    )
    # it cancels the forward rotating vector of order 1
    _direction = "Its direction from throw 1"
    counterweight_best = value(
        "u_1",
        "unbalance",
        "Counterweight balancing all rotating and half of the reciprocating mass",
        lambda balance: balance.shown(abs(balance.forward)),
    )
    counterweight_best_angle = value(
        "α_1", "angle", _direction, lambda balance: balance.angle_of(-balance.forward)
    )
    counterweight_least = value(
        "u_min",
        "unbalance",
        "Counterweight that minimises the largest unbalanced force",
        lambda balance: balance.shown(abs(balance.least)),
    )
    counterweight_least_angle = value(
        "α_min", "angle", _direction, lambda balance: balance.angle_of(balance.least)
    )
    share_best = value(
        "c_min",
        "ratio",
        "Share of the reciprocating mass that this counterweight balances",
        lambda balance: balance.share_of_least(),
    )
    F_free_best = value(
        "F_min",
        "force",
        "Largest unbalanced force with it",
        lambda balance: balance.times_omega_squared(*balance.smallest_circle[1:]),
    )

    _locomotive = Heading("Locomotive")
    counterweight_wheel = value(
        "u_R", "unbalance", "Largest counterweight of a wheel, mass times radius"
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
