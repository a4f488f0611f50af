"""Steady forced vibration of a shaft line: what the orders of all torques make of it at any speed."""

import math
from functools import cached_property
from typing import NamedTuple

import numpy as np

from kurbel.arrays import Array, ComplexArray, Flags
from kurbel.machine.shaft_line import ShaftLine
from kurbel.numerics.waves import crests
from kurbel.solver.shaft_line.chain import Chain, Response, responding, twisting
from kurbel.solver.turning.harmonics import MachineOrders, Spectrum, spectrum
from kurbel.solver.turning.speed_lines import speed_law

_LOST = 1e-4
"""What rounding moves a torque by, over the largest one, beyond which its fourth digit is none: tables print four."""


class Excitation(NamedTuple):
    """The torques on n masses in N m, by orders (k,).

    gas, inertia: amplitudes (n, k) of what does not mind the speed, and of the inertia forces at ω_n = omega in rad/s;
    means (n,), with the load on the mass that takes it; load_slope: dL/dω of each mass at ω_n in N m s/rad (n,).
    """

    omega: float
    orders: Array
    gas: ComplexArray
    inertia: ComplexArray
    means: Array
    load_slope: Array

    def torques(self, omegas: Array) -> ComplexArray:
        """Return the amplitudes (n, s, k) at angular velocities (s,) in rad/s."""
        square = (omegas / self.omega) ** 2
        return np.asarray(self.gas[:, None] + self.inertia[:, None] * square[:, None])


def excitation(found: MachineOrders, line: ShaftLine) -> Excitation:
    """Return what acts on the masses of a shaft line.

    An effort that is known from elsewhere acts on the first mass. Efficiency takes its share of the effort of gas, but
    not of inertia; the load takes the mean of it all, and its own orders where it varies over the turn.
    """
    turned, shape = found.turned, (len(line.masses), len(found.orders))
    gas, inertia, means = np.zeros(shape, complex), np.zeros(shape, complex), np.zeros(len(line.masses))
    places = {name: index for index, mass in enumerate(line.masses) for name in mass.cylinders}
    for one in found.cylinders:
        place = places[one.forces.drive.name]
        gas[place] += one.in_machine.gas.amplitudes
        means[place] += one.in_machine.whole.mean
        if one.in_machine.inertia:
            inertia[place] += one.in_machine.inertia.amplitudes / one.share
    if not found.cylinders:
        gas[0], means[0] = found.machine.gas.amplitudes, turned.excess.mean
    if turned.machine.load and turned.machine.load.diagram:
        gas[line.load] -= spectrum(turned.excess.load, found.orders).amplitudes
    law, slopes = speed_law(turned), np.zeros(len(line.masses))
    omega = turned.omega or 0.0
    if not line.ground:
        means[line.load] -= means.sum()
    if law:
        slopes[line.load] = 2 * float(law(np.zeros(1))[1][0]) / omega
    return Excitation(omega, found.orders, gas, inertia, means, slopes)


class Vibration:
    """The forced vibration of a chain at angular velocities (s,) in rad/s, order by order.

    angles (n, s, k) in rad of the cranks' shaft; torques (pieces, s, k) in N m, true ones on both sides of a gear.
    """

    def __init__(self, chain: Chain, line: ShaftLine, acting: Excitation, omegas: Array) -> None:
        self.chain, self.line, self.acting, self.omegas = chain, line, acting, omegas
        self._ratios = np.array([piece.ratio for piece in line.pieces])

    @cached_property
    def _frequencies(self) -> Array:
        return np.asarray(np.multiply.outer(self.omegas, self.acting.orders))

    @cached_property
    def _held(self) -> Array:
        """Slope of the load, which takes the same mean torque at every speed, so that it goes with 1/ω; (n, s, 1)."""
        return np.asarray(np.multiply.outer(self.acting.load_slope, self.acting.omega / self.omegas)[..., None])

    @cached_property
    def driving(self) -> ComplexArray:
        """Amplitudes of the torques on the masses in N m (n, s, k)."""
        return self.acting.torques(self.omegas)

    @cached_property
    def _response(self) -> Response:
        return responding(self.chain, self._frequencies, self.driving, self._held)

    @property
    def angles(self) -> ComplexArray:
        """Amplitudes of the masses in rad."""
        return self._response.angles

    def _passing(self, angles: ComplexArray) -> ComplexArray:
        """Return the torques in the pieces in N m that angles of the masses make."""
        return np.asarray(twisting(self.chain, self._frequencies, angles) / self._ratios[:, None, None])

    @cached_property
    def torques(self) -> ComplexArray:
        """Amplitudes of the torques in the pieces in N m."""
        return self._passing(self.angles)

    @cached_property
    def endless(self) -> Flags:
        """Where an order meets a mode that next to nothing damps, so that rounding bounds the torques, (s,)."""
        moved = self._passing(self._response.moved)
        largest, unsure = (np.abs(torques).max(axis=(0, 2)) for torques in (self.torques, moved))
        return np.asarray(np.isfinite(self.driving).all(axis=(0, 2)) & ~(unsure <= _LOST * largest))

    @cached_property
    def means(self) -> Array:
        """Mean torques in the pieces in N m."""
        reached = np.cumsum(self.acting.means)
        if self.chain.ground == "before":
            reached = np.concatenate(([0.0], reached)) - reached[-1]
        return np.asarray(reached[: len(self._ratios)] / self._ratios)

    @cached_property
    def crests(self) -> tuple[Array, Array]:
        """Largest and smallest torque in the pieces beside their mean in N m, (pieces, s) each."""
        orders = self.acting.orders
        cycle = 2 if (orders % 1).any() else 1  # turns to which all of them are whole waves
        high, low = crests([round(cycle * order) for order in orders.tolist()], self.torques.reshape(-1, len(orders)))
        return high.reshape(self.torques.shape[:2]), low.reshape(self.torques.shape[:2])

    @cached_property
    def remainder(self) -> Array:
        """About what higher orders add to the torque in any piece in N m, (s,).

        What falls off as 1/ν², as behind a jump through a damper, or faster, is in all of them together no more than in
        the upper half of these.
        """
        upper = self.acting.orders > self.acting.orders[-1] / 2
        return np.asarray(np.abs(self.torques[..., upper]).sum(axis=2).max(axis=0))

    @property
    def vibratory(self) -> Array:
        """Half of what the torques in the pieces swing in N m, (pieces, s)."""
        high, low = self.crests
        return np.asarray((high - low) / 2)

    def over(self, piece: int, degrees: Array) -> Array:
        """Return the torque in a piece in N m at crank angles (n,) in degrees, at the first of the speeds."""
        return Spectrum(self.means[piece], self.acting.orders, self.torques[piece, 0]).at(degrees)

    @cached_property
    def loss(self) -> Array:
        """Mean power in W lost in dampers, in the material, and in a load that rises with the speed, (s,)."""
        chain, speeds = self.chain, np.abs(self._frequencies * self.angles) ** 2
        twists = np.abs(chain.twisted(self.angles)) ** 2
        of_masses = ((chain.mass_damping[:, None, None] + self._held) * speeds).sum(axis=(0, 2))
        material = np.multiply.outer(chain.stiffnesses * chain.loss, self._frequencies)
        viscous = np.multiply.outer(chain.piece_damping, self._frequencies**2)
        return np.asarray((of_masses + ((material + viscous) * twists).sum(axis=(0, 2))) / 2)


def stress(line: ShaftLine, piece: int) -> float | None:
    """Return the stress in Pa that a torque of 1 N m makes in a piece, where it is thinnest; None if not known."""
    moduli = [section.modulus for section in line.pieces[piece].sections]
    return 1 / min(moduli) if moduli and math.isfinite(min(moduli)) else None
