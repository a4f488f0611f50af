"""A chain of masses driven round and round: its periodic motion, with jumps and loads that depend on the speed.

All masses move nearly uniformly: d/dt = ω_n d/dφ. With the torque T = S + d (ω_i − ω_{i+1}) in each piece,
Ṡ = k (ω_i − ω_{i+1}), every mass has J ω̇ = T before it − T behind it − c (ω − ω_n) + M, and one of them − L(ω).
"""

import math
from collections.abc import Callable
from copy import copy
from functools import cached_property
from typing import NamedTuple

import numpy as np

from kurbel.arrays import Array, Indices
from kurbel.numerics.collocation_old import Periodic, periodic
from kurbel.numerics.elements import Elements
from kurbel.numerics.grid import cut_equally
from kurbel.solver.shaft_line.chain import Chain
from kurbel.solver.shaft_line.modes import Modes

_SWING = 120.0
"""Degrees of a natural oscillation that one element may hold at first, …"""
_MOST_PARTS = 8000
"""… though a piece is cut into no more parts than these."""


class Rise(NamedTuple):
    """How the load rises with the speed: of which mass, and its law; see `kurbel.solver.turning.speed.SpeedLaw`."""

    mass: int
    law: Callable[[Array], tuple[Array, Array]]


class ChainEquation:
    """See the head of the module, and `collocation.Equation`.

    The unknowns are, in N m and of one size: for each piece S less its mean, over the largest natural order, and for
    each mass what it gains over ω_n times its momentum. driving: takes angles in degrees, with what is on their side of
    a jump, and returns the torque on each mass less its mean in N m, (n, …).
    """

    def __init__(
        self, chain: Chain, omega: float, driving: Callable[[Array, Array], Array], rise: Rise | None = None
    ) -> None:
        self.chain, self.omega, self.driving, self.rise = chain, omega, driving, rise
        self.noise = self._more = 0.0

    @cached_property
    def order(self) -> float:
        """The largest natural order."""
        return float(Modes(self.chain).omegas[-1]) / self.omega

    @cached_property
    def speeds(self) -> Array:
        """What turns the unknowns of the masses into speeds over ω_n in rad/s, (n,)."""
        return 1 / (self.chain.inertias * self.omega)

    @cached_property
    def passing(self) -> Array:
        """The matrix (pieces, m) that turns the unknowns into torques in the pieces, less their mean."""
        springs = np.eye(len(self.chain.stiffnesses)) * self.order
        return np.hstack((springs, self.chain.piece_damping[:, None] * self.chain.twists * self.speeds))

    @cached_property
    def matrix(self) -> Array:
        """The matrix A of y′ = A y + …, (m, m)."""
        chain, pieces = self.chain, len(self.chain.stiffnesses)
        stiff = (chain.stiffnesses / (self.omega * self.order))[:, None] * chain.twists * self.speeds
        whole = np.vstack((np.hstack((np.zeros((pieces, pieces)), stiff)), -chain.twists.T @ self.passing))
        places = np.arange(pieces, len(whole))
        whole[places, places] -= chain.mass_damping * self.speeds
        return whole

    @property
    def _risen(self) -> int:
        """Which unknown the load minds."""
        assert self.rise
        return len(self.chain.stiffnesses) + self.rise.mass

    @property
    def _height(self) -> float:
        """What the mass that minds the speed loses until it stands still, in N m."""
        assert self.rise
        return float(self.chain.inertias[self.rise.mass]) * self.omega**2 + self._more

    def prepared(self, degrees: Array, within: Array) -> Array:
        """See `collocation.Equation`."""
        driving = self.driving(degrees, within)
        return np.concatenate((np.zeros((len(self.chain.stiffnesses), *degrees.shape)), driving))

    def rate(self, prepared: Array, y: Array) -> tuple[Array, Array]:
        """See `collocation.Equation`."""
        rate = y @ self.matrix.T + np.moveaxis(prepared, 0, -1)
        slope = np.broadcast_to(self.matrix, (*y.shape, y.shape[-1]))
        if self.rise:
            # with u = (ω − ω_n)/ω_n the square of the speed is 1 + u (2 + u) of the nominal one
            gained = y[..., self._risen] / self._height
            more, bend = self.rise.law(gained * (2 + gained))
            slope = slope.copy()
            rate[..., self._risen] -= more
            slope[..., self._risen, self._risen] -= bend * 2 * (1 + gained) / self._height
        return rate, slope

    def floor(self, prepared: Array) -> Array:
        """See `collocation.Equation`: the mass that minds the speed must not stand still."""
        floor = np.full((*prepared.shape[1:], len(prepared)), -math.inf)
        if self.rise:
            floor[..., self._risen] = -self._height
        return floor

    def eased(self, by: float) -> "ChainEquation":
        """See `collocation.Equation`: the load minds the speed as if its mass had so much more J ω_n², in N m."""
        tamer = copy(self)
        tamer._more = by
        return tamer

    def parts(self, breaks: Array) -> Indices:
        """Return into how many elements each piece of the cycle between the breaks in degrees is cut at first."""
        return np.ceil(np.diff(breaks) * (self.order / _SWING)).clip(1, _MOST_PARTS).astype(int)

    def solved(self, breaks: Array) -> Periodic:
        """Return the periodic motion over smooth pieces of the cycle between the breaks in degrees.

        A load that does not mind the speed leaves the mean speed open: it is the nominal one.
        """
        found = periodic(self, Elements.over(cut_equally(breaks, self.parts(breaks))), len(self.matrix))
        if self.rise is None and not self.chain.mass_damping.any() and not self.chain.ground:
            pieces = len(self.chain.stiffnesses)
            width = np.radians(found.elements.width)
            drift = width @ found.coefficients[:, pieces, 0] * self.speeds[0] / width.sum()
            found.coefficients[:, pieces:, 0] -= drift / self.speeds
        return found
