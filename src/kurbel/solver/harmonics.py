"""Orders of the turning effort: M = M₀ + Σ Re(M_ν e^{iνφ}), ν periods per turn of the shaft.

    M_ν = (2/Φ) ∫ M e^{−iνφ} dφ          over the cycle Φ, piece by piece, since M has corners and jumps

The inertia forces, which go with ω², are kept apart from what is independent of the speed: gas, weight and friction.
A crank that follows crank 1 by β has its orders times e^{−iνβ}. Numbers of many machines are (n,), amplitudes (k, n).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import cached_property, reduce
from typing import Any, NamedTuple

import numpy as np

from kurbel.arrays import Array, ComplexArray
from kurbel.crank_angle import unit_vector
from kurbel.numerics.lobatto import chebyshev, rule
from kurbel.numerics.pieces import Pieces
from kurbel.solver.effort import TurningEffort, inertia_torque, position
from kurbel.solver.forces import CylinderForces

HIGHEST = 24
"""Highest order unless others are requested."""
_AT_ONCE = 256
"""Pieces that are integrated together: what the nearest memory holds."""
_RENEWED = 64
"""Orders after which e^{−iνφ} is computed anew, not from the order before."""
_ROUNDING = 1e-14
"""Of the torques that a sum has as terms: what is smaller is zero."""
_IN_PHASE = 1e-9
"""By what the sum of phase vectors of a major order may fall short of their number, relatively."""


def every_order(cycle: float, highest: int = HIGHEST) -> Array:
    """Return the orders up to the highest: halves of a cycle of 720 degrees, whole ones of 360."""
    step = 360.0 / cycle
    return np.asarray(step * np.arange(1, round(highest / step) + 1), dtype=float)


def amplitudes(pieces: Pieces, values: Array, orders: Array) -> ComplexArray:
    """Return the complex amplitudes (q, k, machines) of orders (k,) of samples of quantities (q, nodes, pieces).

    The polynomials of the pieces are sampled as finely as the highest order needs.

    >>> from kurbel.numerics.pieces import Angles
    >>> pieces = Pieces.between(Angles(np.zeros(0, dtype=int), np.zeros(0)), 1, 360.0)
    >>> abs(amplitudes(pieces, np.cos(np.radians(3 * pieces.degrees))[None], np.array([2.0, 3.0]))).round(14).ravel()
    array([0., 1.])
    """
    # e^{iwx} on −1 … 1 is a polynomial of degree w + 11.4 w^⅓ + 3 (J_n(w) < 1e-16 beyond), that of the samples counts
    # half, since its last coefficients are small; n Lobatto nodes integrate the degree 2n − 3 exactly
    count, fastest = len(pieces.rule.nodes), math.radians(pieces.half.max() * orders.max(initial=1.0))
    fine = rule(math.ceil((count / 2 + fastest + 11.4 * fastest ** (1 / 3) + 6) / 2))
    to_fine = fine.weights[:, None] * (chebyshev(fine.nodes, count) @ pieces.rule.series)
    found, step = np.empty((len(values), len(orders), len(pieces.half)), dtype=complex), 360.0 / pieces.cycle
    for start in range(0, len(pieces.half), _AT_ONCE):
        part = slice(start, start + _AT_ONCE)
        half = pieces.half[part]
        degrees = pieces.right_angle[part] + (pieces.offset[part] + half * (1 + fine.nodes[:, None]))
        shares, turn, before = to_fine @ (values[..., part] * half), unit_vector(-step * degrees), 0.0
        waves = shares.astype(complex)
        for index, order in enumerate(orders.tolist()):
            if order == before + step and (index + 1) % _RENEWED:
                waves *= turn
            else:
                waves = shares * unit_vector(-order * degrees)
            before = order
            found[:, index, part] = waves.sum(axis=1)
    return np.asarray(np.add.reduceat(found, pieces.first, axis=2) * (2 / pieces.cycle), dtype=complex)


class Spectrum(NamedTuple):
    """The mean of a torque in N m, and its orders ν (k,) with their complex amplitudes M_ν (k,), or (k, n)."""

    mean: Any
    orders: Array
    amplitudes: ComplexArray

    def plus(self, other: Spectrum | None, factor: Any = 1.0) -> Spectrum:
        """Return that of this torque and of another one times a factor."""
        if other is None:
            return self
        return Spectrum(self.mean + factor * other.mean, self.orders, self.amplitudes + factor * other.amplitudes)

    def times(self, factor: Any) -> Spectrum:
        """Return that of the torque times a factor."""
        return Spectrum(factor * self.mean, self.orders, factor * self.amplitudes)

    def earlier(self, degrees: Any) -> Spectrum:
        """Return that of the torque an angle earlier."""
        orders = self.orders.reshape(-1, *(1,) * (self.amplitudes.ndim - 1))
        return self._replace(amplitudes=self.amplitudes * unit_vector(orders * degrees))

    def cleared(self, size: Any) -> Spectrum:
        """Return it with 0 for what is rounding beside torques of this size in N m: the mean, cosines, and sines."""
        parts = self.mean, self.amplitudes.real, self.amplitudes.imag
        mean, cos, sin = (np.where(np.abs(part) > _ROUNDING * size, part, 0.0) for part in parts)
        return Spectrum(mean if mean.ndim else float(mean), self.orders, cos + 1j * sin)

    @property
    def size(self) -> Any:
        """The largest of its parts in N m."""
        return np.maximum(np.abs(self.mean), np.abs(self.amplitudes).max(axis=0, initial=0.0))

    def at(self, degrees: Array) -> Array:
        """Return the sum of the mean and these orders in N m at crank angles (m,) in degrees, of one machine."""
        return np.asarray(self.mean + (unit_vector(np.multiply.outer(degrees, self.orders)) @ self.amplitudes).real)


class Orders(NamedTuple):
    """What is independent of the speed, and what the inertia forces give at the nominal speed, None without them."""

    gas: Spectrum
    inertia: Spectrum | None

    @property
    def whole(self) -> Spectrum:
        """Both together."""
        return self.gas.plus(self.inertia)

    def at_speed(self, ratio: float) -> Spectrum:
        """Return both together at a speed, over the nominal one."""
        return self.gas.plus(self.inertia, ratio**2)

    @property
    def size(self) -> Any:
        """The largest of the parts of both in N m."""
        return np.maximum(self.gas.size, self.inertia.size if self.inertia else 0.0)

    def each(self, change: Callable[[Spectrum], Spectrum]) -> Orders:
        """Return both, each changed."""
        return Orders(change(self.gas), self.inertia and change(self.inertia))


class CylinderOrders(NamedTuple):
    """The orders of the torque of one cylinder.

    own: over its own crank angle, without the losses of the machine; share: what they leave of all of it; lost: what
    they take off besides, with its factor.
    """

    forces: CylinderForces
    own: Orders
    share: Any
    lost: tuple[tuple[Any, Spectrum], ...]

    @property
    def in_machine(self) -> Orders:
        """Those over the angle of crank 1, with the losses of the machine."""
        shared, behind = self.own.each(lambda one: one.times(self.share)), self.forces.drive.cylinder.crank_position
        for factor, lost in self.lost:
            shared = Orders(shared.gas.plus(lost, factor), shared.inertia)
        return shared.each(lambda one: one.earlier(-behind))

    @property
    def area(self) -> Any:
        """R A in m³ of crank radius and head-end area, by which torques become tangential pressures."""
        pistons, crank = self.forces.drive.cylinder.pistons, self.forces.drive.mechanism.crank
        return math.pi / 4 * pistons[0].bore ** 2 * crank if pistons else None


class MachineOrders:
    """The orders (k,) of the turning effort of a whole machine, or of many, and of its cylinders."""

    def __init__(self, effort: TurningEffort, orders: Array | None = None) -> None:
        self.effort = effort
        self.orders = every_order(effort.cycle) if orders is None else orders

    def spectra(self, pieces: Pieces, torques: Sequence[Array]) -> list[Spectrum]:
        """Return mean and orders of torques in N m, (nodes, pieces); of shorter cycles the orders that they have."""
        present = np.flatnonzero((self.orders * round(pieces.cycle / 360.0)) % 1 == 0)
        values = np.stack([np.broadcast_to(one, pieces.degrees.shape) for one in torques])
        found = np.zeros((len(values), len(self.orders), pieces.count), dtype=complex)
        found[:, present] = amplitudes(pieces, values, self.orders[present])
        means = pieces.mean(values)
        if self.effort.count is None:
            return [Spectrum(float(mean[0]), self.orders, one[:, 0]) for mean, one in zip(means, found)]
        return [Spectrum(mean, self.orders, one) for mean, one in zip(means, found)]

    @cached_property
    def cylinders(self) -> tuple[CylinderOrders, ...]:
        """Those of every cylinder in which a force acts; one is computed of all that work alike."""
        found: dict[str, CylinderOrders] = {}
        for group in self.effort.groups:
            forces, share, lost = group[0], self.effort.share(group[0].drive), self.effort.lost(group)
            torques = [forces.samples.M, *(one.torque(forces.samples) for one in lost)]
            if self.effort.moves(forces):
                torques.append(inertia_torque(forces.samples))
                torques[0] = torques[0] - torques[-1]
            gas, *rest = self.spectra(forces.pieces, torques)
            own = Orders(gas, rest.pop() if self.effort.moves(forces) else None)
            own = own.each(lambda one, size=own.size: one.cleared(size))  # type: ignore[misc]
            factors = tuple((one.factor, spectrum) for one, spectrum in zip(lost, rest))
            found |= {one.drive.name: CylinderOrders(one, own, share, factors) for one in group}
        return tuple(found[one.drive.name] for one in self.effort.cylinders)

    @cached_property
    def machine(self) -> Orders:
        """Those of the turning effort, with the losses of the machine."""
        if self.effort.given:
            (known,) = self.spectra(self.effort.pieces, [self.effort.M])
            return Orders(known.cleared(known.size), None)
        each = [one.in_machine for one in self.cylinders]
        inertia, size = [one.inertia for one in each if one.inertia], sum(one.size for one in each)
        summed = Orders(
            reduce(Spectrum.plus, (one.gas for one in each)), reduce(Spectrum.plus, inertia) if inertia else None
        )
        return summed.each(lambda one: one.cleared(size))

    @property
    def M_mean(self) -> Any:
        """Mean torque in N m."""
        return self.effort.result(self.effort.mean)

    @cached_property
    def swing(self) -> Any:
        """Mean square in N² m² of the torque less its mean."""
        effort = self.effort
        return effort.result(effort.pieces.mean((effort.M - effort.pieces.of(effort.mean)) ** 2))

    @property
    def orders_share(self) -> Any:
        """Share of that which these orders carry, Σ |M_ν|²/2 over it (Parseval); None where the torque is uniform."""
        carried, uniform = (np.abs(self.machine.whole.amplitudes) ** 2).sum(axis=0) / 2, 1e-28 * self.M_mean**2
        if self.effort.count is None:
            return float(carried) / self.swing if self.swing > uniform else None
        return carried / np.where(self.swing > uniform, self.swing, np.nan)

    @property
    def major_orders(self) -> Any:
        """The orders to which all cranks contribute in phase; None with fewer than two cylinders."""
        if len(self.cylinders) < 2:
            return None
        ones = np.ones(self.effort.pieces.count)
        positions = [position(one.forces) * ones for one in self.cylinders]
        together = np.abs(sum(unit_vector(np.multiply.outer(self.orders, one)) for one in positions))
        in_phase = together >= (1 - _IN_PHASE) * len(positions)
        each = tuple(tuple(self.orders[one].tolist()) for one in in_phase.T)
        return each[0] if self.effort.count is None else each
