"""What `kurbel flywheel` tells over the angle of crank 1."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from kurbel.numerics.search import Sampled
from kurbel.solver.turning.machine_effort import MachineEffort
from kurbel.solver.turning.speed import SpeedLine
from kurbel.solver.turning.torques import Sum

if TYPE_CHECKING:
    from kurbel.arrays import Array
    from kurbel.solver.turning.coupling import ElasticCoupling


OF_SPEED = ("omega", "alpha", "M_coupling")
"""Columns that hang on the speed line."""


class TurningColumns:
    """The whole machine at crank angles (n,) in degrees; attributes by the ids of the columns, in SI, each (n,).

    crank: radius of crank 1 in m, None without one; a column that the machine does not have is None.
    """

    def __init__(
        self,
        turned: MachineEffort,
        crank: float | None,
        speed: SpeedLine | ElasticCoupling | None,
        phi: Array,
        within: Array | None = None,
    ) -> None:
        self._turned, self._crank, self._speed = turned, crank, speed
        self.phi = phi
        self._within = phi if within is None else within

    def curve(self, column: str, within: Array) -> Sampled | None:
        """Return a column with its slope by φ, on the sides of jumps that hold `within`; None for one left out."""
        if column in OF_SPEED:
            return None if self._speed is None else self._speed.curves(self.phi, within).get(column)
        if column == "E":
            return Sampled(self.E, self._turned.excess.torque.torque(self.phi, within).slope)
        arm = 1.0 if column == "M" else self._crank
        torque = self._inertia if column == "T_inertia" else self._turned.effort
        if arm is None or not torque.parts:
            return None
        found = torque.torque(self.phi, within)
        return Sampled(found.value / arm, found.slope / arm)

    @property
    def _inertia(self) -> Sum:
        """The torque of the inertia forces, with its share of the losses."""
        return Sum(*((self._turned.efficiency, mass) for mass in self._turned.masses))

    @cached_property
    def M(self) -> Array:
        """Turning effort in N m."""
        return np.asarray(self._turned.effort.torque(self.phi, self._within).value)

    @property
    def M_load(self) -> Array:
        """The resistance in N m, at the nominal speed."""
        return np.asarray(self._turned.excess.load.torque(self.phi, self._within).value)

    @property
    def T(self) -> Array | None:
        """The turning effort as a force in N at the radius of crank 1."""
        return None if self._crank is None else self.M / self._crank

    @property
    def T_inertia(self) -> Array | None:
        """The share of the inertia forces in T, in N (Tolle)."""
        if self._crank is None or not self._turned.masses:
            return None
        return np.asarray(self._inertia.torque(self.phi, self._within).value / self._crank)

    @property
    def E(self) -> Array:
        """Excess work in J since angle 0."""
        return self._turned.excess.at(self.phi)

    @property
    def omega(self) -> Array | None:
        """Angular velocity in rad/s."""
        return None if self._speed is None else self._speed.omega(self.phi)

    @property
    def alpha(self) -> Array | None:
        """Angular acceleration in rad/s², dω/dt."""
        return None if self._speed is None else self._speed.alpha(self.phi)

    @property
    def M_coupling(self) -> Array | None:
        """Torque in the elastic coupling in N m."""
        return None if self._speed is None or isinstance(self._speed, SpeedLine) else self._speed.torque(self.phi)
