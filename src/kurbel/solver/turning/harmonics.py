"""Orders of the turning effort: M = M₀ + Σ Re(M_ν e^{iνφ}), ν periods per turn of the shaft.

M has a corner or a jump wherever a card has one; samples at equal angles see them late. Every smooth piece is
integrated by itself. What the inertia forces give is told apart: it goes with ω², the rest does not mind the speed.
"""

import math
from collections.abc import Callable, Iterator
from functools import cached_property
from typing import NamedTuple

import numpy as np

from kurbel.arrays import Array, ComplexArray
from kurbel.crank_angle import unit_vector
from kurbel.machine.alike import gathered, work_alike
from kurbel.numerics.grid import Grid, cut_equally
from kurbel.solver.cylinder.forces import CylinderForces
from kurbel.solver.turning.machine_effort import Driving, MachineEffort
from kurbel.solver.turning.torques import Sum, Torque

HIGHEST = 24
"""Order up to which they are told unless others are asked for."""
_RESOLVED = 10.0
"""Radians of the highest order that sixteen points of Gauss integrate to the last digit."""
_ROUNDING = 1e-14
"""What is smaller, over the torques that it is summed of, is rounding."""
_ALIKE = 1e-9
"""By what the sum of phase vectors of a major order may fall short of their number, relatively."""


def every_order(cycle: float, highest: int = HIGHEST) -> Array:
    """Return the orders up to the highest: halves of a cycle of 720 degrees, whole ones of 360."""
    step = 360.0 / cycle
    return np.asarray(step * np.arange(1, round(highest / step) + 1), dtype=float)


class Spectrum(NamedTuple):
    """The mean of a torque in N m, and its orders ν (n,) with their complex amplitudes M_ν (n,)."""

    mean: float
    orders: Array
    amplitudes: ComplexArray

    @classmethod
    def summed(cls, *parts: tuple[float, "Spectrum"]) -> "Spectrum":
        """Return that of a sum of torques of the same orders, each with a factor."""
        amplitudes = sum(factor * one.amplitudes for factor, one in parts)
        return cls(sum(factor * one.mean for factor, one in parts), parts[0][1].orders, np.asarray(amplitudes))

    def cleared(self, size: float) -> "Spectrum":
        """Return it with 0 for what is rounding beside torques of this size in N m: the mean, cosines, and sines."""
        parts = self.mean, self.amplitudes.real, self.amplitudes.imag
        mean, cos, sin = (np.where(np.abs(part) > _ROUNDING * size, part, 0.0) for part in parts)
        return Spectrum(float(mean), self.orders, cos + 1j * sin)

    def turned(self, degrees: float) -> "Spectrum":
        """Return that of the torque put earlier by an angle."""
        return self._replace(amplitudes=self.amplitudes * unit_vector(self.orders * degrees))

    @property
    def size(self) -> float:
        """The largest of its parts in N m."""
        return max(abs(self.mean), float(np.abs(self.amplitudes).max(initial=0.0)))

    def at(self, degrees: Array) -> Array:
        """Return the sum of the mean and these orders in N m at crank angles (k,) in degrees."""
        return np.asarray(self.mean + (unit_vector(np.multiply.outer(degrees, self.orders)) @ self.amplitudes).real)


def spectrum(torque: Torque, orders: Array) -> Spectrum:
    """Return mean and orders (n,) of a torque: M_ν = (2/Φ) ∫ M e^{−iνφ} dφ over its cycle Φ, piece by piece.

    >>> from kurbel.solver.turning.torques import Uniform
    >>> float(abs(spectrum(Uniform(5.0, 360.0), np.array([1.0])).amplitudes[0])) < 1e-14
    True
    """
    breaks = torque.cuts.grid().breaks
    parts = np.ceil(np.radians(np.diff(breaks)) * (orders.max(initial=1.0) / _RESOLVED)).astype(int).clip(1)
    grid = Grid(cut_equally(breaks, parts))
    shares = torque.torque(grid.degrees, grid.within).value * grid.half_widths[:, None] * grid.weights
    shares /= math.radians(grid.cycle)
    waves = (np.exp(-1j * np.radians(np.mod(order * grid.degrees, 360.0))) for order in orders)
    amplitudes = np.array([2 * (shares * wave).sum() for wave in waves], dtype=complex)
    return Spectrum(float(shares.sum()), orders, amplitudes)


class Orders(NamedTuple):
    """What does not depend on the speed, and what the inertia forces give at the nominal speed, None without them."""

    gas: Spectrum
    inertia: Spectrum | None

    @property
    def whole(self) -> Spectrum:
        """Both together."""
        return self.at_speed(1.0)

    def at_speed(self, ratio: float) -> Spectrum:
        """Return both together at a speed, over the nominal one."""
        return Spectrum.summed((1.0, self.gas), *([(ratio**2, self.inertia)] if self.inertia else []))

    @property
    def size(self) -> float:
        """The largest of the parts of both in N m."""
        return max(one.size for one in self if one)

    def each(self, change: Callable[[Spectrum], Spectrum]) -> "Orders":
        """Return both, each changed."""
        return Orders(change(self.gas), self.inertia and change(self.inertia))


class CylinderOrders:
    """The orders of the torque of one cylinder.

    own: over its own crank angle, without the losses of the machine; share: what they leave of all of it; lost: what
    they take off besides, with its factor each.
    """

    def __init__(
        self, forces: CylinderForces, own: Orders, share: float, lost: tuple[tuple[float, Spectrum], ...]
    ) -> None:
        self.forces, self.own, self.share, self._lost = forces, own, share, lost

    @cached_property
    def in_machine(self) -> Orders:
        """Those over the angle of crank 1, with the losses of the machine."""
        behind = self.forces.drive.cylinder.crank_position
        shared = self.own.each(lambda one: Spectrum.summed((self.share, one)))
        gas = Spectrum.summed((1.0, shared.gas), *self._lost)
        return Orders(gas, shared.inertia).each(lambda one: one.turned(-behind))

    @cached_property
    def area(self) -> float | None:
        """R A in m³ of crank radius and head-end area, by which torques become tangential pressures."""
        pistons, crank = self.forces.drive.cylinder.pistons, self.forces.drive.mechanism.crank
        return math.pi / 4 * pistons[0].bore ** 2 * crank if pistons else None


def _alike(one: Driving, other: Driving) -> bool:
    return work_alike(one.forces.drive.cylinder, other.forces.drive.cylinder)


class MachineOrders:
    """The orders (n,) of the turning effort of a whole machine and of its cylinders."""

    def __init__(self, turned: MachineEffort, orders: Array | None = None) -> None:
        self.turned = turned
        self.orders = every_order(turned.cycle) if orders is None else orders

    @cached_property
    def cylinders(self) -> tuple[CylinderOrders, ...]:
        """Those of every cylinder in which a force acts; one is asked for all that work alike."""
        found: dict[str, CylinderOrders] = {}
        for group in gathered(self.turned.of_cylinders, _alike):
            own, lost = self._own(group[0]), tuple(self._lost(group[0]))
            found |= {part.forces.drive.name: CylinderOrders(part.forces, own, part.share, lost) for part in group}
        return tuple(found[part.forces.drive.name] for part in self.turned.of_cylinders)

    def _own(self, one: Driving) -> Orders:
        """Return the orders of a cylinder over its own crank angle."""
        effort, inertia = one.effort, one.inertia
        rest = effort if inertia is None else Sum((1.0, effort), (-1.0, inertia))
        found = Orders(spectrum(rest, self.orders), None if inertia is None else spectrum(inertia, self.orders))
        size, behind = found.size, one.forces.drive.cylinder.crank_position
        return found.each(lambda one: one.turned(behind).cleared(size))

    def _lost(self, one: Driving) -> Iterator[tuple[float, Spectrum]]:
        """Yield those of what is lost besides, over its own crank angle."""
        behind = one.forces.drive.cylinder.crank_position
        for factor, torque in one.lost:
            yield factor, spectrum(torque, self.orders).turned(behind)

    @cached_property
    def machine(self) -> Orders:
        """Those of the turning effort, with the losses of the machine."""
        if not self.turned.of_cylinders:
            known = spectrum(self.turned.effort, self.orders)
            return Orders(known.cleared(known.size), None)
        each = [one.in_machine for one in self.cylinders]
        gas = Spectrum.summed(*((1.0, one.gas) for one in each))
        inertia = [(1.0, one.inertia) for one in each if one.inertia]
        size = math.fsum(one.size for one in each)
        return Orders(gas, Spectrum.summed(*inertia) if inertia else None).each(lambda one: one.cleared(size))

    @property
    def M_mean(self) -> float:
        """Mean torque in N m."""
        return self.turned.excess.mean

    @cached_property
    def swing(self) -> float:
        """Mean square in N² m² of the torque less its mean."""
        excess = self.turned.excess
        torque = excess.effort.torque(excess.grid.degrees, excess.grid.within).value - excess.mean
        return excess.grid.integral(torque * torque) / math.radians(self.turned.cycle)

    @property
    def orders_share(self) -> float | None:
        """Share of that which these orders carry, Σ |M_ν|²/2 over it (Parseval); None where the torque is uniform."""
        carried = float((np.abs(self.machine.whole.amplitudes) ** 2).sum() / 2)
        return carried / self.swing if self.swing > 1e-28 * self.M_mean**2 else None

    @property
    def major_orders(self) -> tuple[float, ...] | None:
        """The orders to which all cranks contribute in phase; None with fewer than two cylinders."""
        positions = np.array([one.forces.drive.cylinder.crank_position for one in self.cylinders])
        if len(positions) < 2:
            return None
        together = np.abs(unit_vector(np.outer(self.orders, positions)).sum(axis=1)) >= (1 - _ALIKE) * len(positions)
        return tuple(self.orders[together].tolist())
