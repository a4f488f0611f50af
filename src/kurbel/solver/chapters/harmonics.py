"""Orders of the turning effort: M = M₀ + Σ Re(M_ν e^{iνφ}), ν periods per turn of the shaft.

    M_ν = (2/Φ) ∫ M e^{−iνφ} dφ          over the cycle Φ, piece by piece, since M has corners and jumps

The inertia forces, which go with ω², are kept apart from what is independent of the speed: gas, weight and friction.
A crank that follows crank 1 by β has its orders times e^{−iνβ}. Numbers of many machines are (n,), amplitudes (k, n).
"""

from __future__ import annotations

import math
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from kurbel.arrays import Array, ComplexArray, Number
from kurbel.crank_angle import unit_vector
from kurbel.errors import UsageError
from kurbel.numerics.arithmetic import is_whole, some, unless_cancelled, where
from kurbel.numerics.lobatto import chebyshev, rule
from kurbel.numerics.pieces import Pieces
from kurbel.quantity import key_value, value
from kurbel.solver.effort import TurningEffort, moves, position, torque_of_inertia
from kurbel.solver.figures import Results
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
    return step * np.arange(1.0, round(highest / step) + 1)


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
    count = len(pieces.rule.nodes)
    fastest = math.radians(pieces.half.max() * orders.max(initial=1.0))
    fine = rule(math.ceil((count / 2 + fastest + 11.4 * fastest ** (1 / 3) + 6) / 2))
    to_fine = fine.weights[:, None] * (chebyshev(fine.nodes, count) @ pieces.rule.series)
    integrals = np.empty((len(values), len(orders), len(pieces.half)), dtype=complex)
    step = 360.0 / pieces.cycle
    for start in range(0, len(pieces.half), _AT_ONCE):
        part = slice(start, start + _AT_ONCE)
        half = pieces.half[part]
        from_left = pieces.offset[part] + half * (1 + fine.nodes[:, None])
        degrees = pieces.right_angle[part] + from_left
        shares = to_fine @ (values[..., part] * half)
        # e^{−iνφ} of an order from that of the order before it, computed anew now and then
        turn = unit_vector(-step * degrees)
        waves = shares.astype(complex)
        before = 0.0
        for index, order in enumerate(orders.tolist()):
            if order == before + step and (index + 1) % _RENEWED:
                waves *= turn
            else:
                waves = shares * unit_vector(-order * degrees)
            before = order
            integrals[:, index, part] = waves.sum(axis=1)
    of_cycle = np.add.reduceat(integrals, pieces.first, axis=2)
    return np.asarray(of_cycle * (2 / pieces.cycle), dtype=complex)


class Orders(NamedTuple):
    """The orders ν (k,) of a torque in two parts: independent of the speed, and of the inertia forces at ω_n.

    gas, inertia: complex amplitudes M_ν in N m, (k,) or (k, n), None without moving masses; largest: of the amplitudes
    and the means, (n,).
    """

    orders: Array
    gas: ComplexArray
    inertia: ComplexArray | None
    largest: Array

    def at_speed(self, ratio: float) -> ComplexArray:
        """Return both together at a speed, over the nominal one."""
        if self.inertia is None:
            return self.gas
        return self.gas + ratio**2 * self.inertia

    @property
    def whole(self) -> ComplexArray:
        """Both together."""
        return self.at_speed(1.0)


class CylinderOrders(NamedTuple):
    """The orders of the torque of one cylinder over its own crank angle, without the losses of the machine."""

    forces: CylinderForces
    own: Orders

    @property
    def area(self) -> Any:
        """R A in m³ of crank radius and head-end area, by which torques become tangential pressures."""
        drive = self.forces.drive
        pistons = drive.cylinder.pistons
        if not pistons:
            return None
        return math.pi / 4 * pistons[0].bore ** 2 * drive.mechanism.crank


class MachineOrders(Results):
    """The orders (k,) of the turning effort of a whole machine, or of many, and of its cylinders."""

    command = "harmonics"

    def __init__(self, effort: TurningEffort, orders: Array | None = None) -> None:
        self.effort = effort
        if effort.swing is not None:
            raise UsageError(
                f"{effort.machine.name}: of the effort its swing of energy alone is known, and no orders"
            )
        self.orders = every_order(effort.cycle) if orders is None else orders

    def _orders_of(
        self, pieces: Pieces, torque: Array, inertia: Array | None, size: Number = 0.0
    ) -> Orders:
        """Return the orders of a torque (nodes, pieces) with the part of the inertia forces, None without any.

        A torque of a shorter cycle has only some of the orders. What is rounding of the largest, or of the torques of
        this size in N m that it is the sum of, is 0: cosines, and sines.
        """
        of_masses = np.zeros(()) if inertia is None else inertia
        values = np.stack([pieces.filled(torque - of_masses), pieces.filled(of_masses)])
        present = np.flatnonzero(is_whole(self.orders * round(pieces.cycle / 360.0)))
        waves = np.zeros((2, len(self.orders), pieces.count), dtype=complex)
        waves[:, present] = amplitudes(pieces, values, self.orders[present])

        mean_size = np.abs(pieces.mean(values)).max(axis=0)
        largest = np.maximum(np.abs(waves).max(axis=(0, 1)), mean_size)
        waves = unless_cancelled(waves, np.maximum(size, largest), _ROUNDING)
        gas, masses = waves[..., 0] if self.effort.count is None else waves
        return Orders(self.orders, gas, None if inertia is None else masses, largest)

    @cached_property
    def cylinders(self) -> tuple[CylinderOrders, ...]:
        """Those of every cylinder in which a force acts; one is computed of all that work alike."""
        by_name: dict[str, CylinderOrders] = {}
        for group in self.effort.groups:
            samples = group[0].samples
            inertia = torque_of_inertia(samples) if moves(group) else None
            orders = self._orders_of(group[0].pieces, samples.M, inertia)
            for forces in group:
                by_name[forces.drive.name] = CylinderOrders(forces, orders)
        names = [cylinder.drive.name for cylinder in self.effort.cylinders]
        return tuple(by_name[name] for name in names if name in by_name)

    @cached_property
    def machine(self) -> Orders:
        """Those of the turning effort, with the losses of the machine."""
        effort = self.effort
        sizes = [cylinder.own.largest for cylinder in self.cylinders]
        inertia = None
        if effort.given is None and effort.inertia_terms:
            inertia = effort.sampled(effort.inertia_terms)
        return self._orders_of(effort.pieces, effort.M, inertia, np.sum(sizes, axis=0))

    M_mean = value(
        "M_m",
        "torque",
        "Mean torque of the turning effort, equal to the resistance",
        lambda harmonics: harmonics.effort.result(harmonics.effort.mean),
    )

    @key_value("Σ|M_ν|²/2", "ratio", plain="sum M_nu2/2")
    def orders_share(self) -> Number | None:
        """Share of the variance of the torque contained in these orders (Parseval).

        None where the torque is uniform.
        """
        effort = self.effort
        carried = (np.abs(self.machine.whole) ** 2).sum(axis=0) / 2
        above_mean = effort.M - effort.pieces.of(effort.mean)
        variance = effort.result(effort.pieces.mean(above_mean**2))
        varies = variance > 1e-28 * self.M_mean**2
        if not some(varies):
            return None
        return carried / where(varies, variance, math.nan)

    @key_value("ν_H", "ratio", listed=True)
    def major_orders(self) -> Any:
        """Major orders, in which all cranks act in phase.

        None with fewer than two cylinders.
        """
        if len(self.cylinders) < 2:
            return None
        resultant: Any = 0.0
        for forces, *_ in self.cylinders:
            positions = position(forces) * np.ones(self.effort.pieces.count)
            resultant = resultant + unit_vector(np.multiply.outer(self.orders, positions))
        are_in_phase = np.abs(resultant) >= (1 - _IN_PHASE) * len(self.cylinders)
        of_machines = tuple(tuple(self.orders[major].tolist()) for major in are_in_phase.T)
        if self.effort.count is not None:
            return of_machines
        return of_machines[0]
