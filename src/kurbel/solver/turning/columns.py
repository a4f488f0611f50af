"""What `kurbel flywheel` tells over the angle of crank 1."""

from functools import cached_property, partial
from typing import TYPE_CHECKING

import numpy as np

from kurbel.arrays import Array
from kurbel.numerics.jet import Jet
from kurbel.numerics.search import Sampled
from kurbel.solver.figures import Columns
from kurbel.solver.turning.machine_effort import MachineEffort
from kurbel.solver.turning.speed import SpeedLine
from kurbel.solver.turning.torques import Sum, Torque

if TYPE_CHECKING:
    from kurbel.solver.turning.coupling import ElasticCoupling


OF_SPEED = ("omega", "alpha", "M_coupling")
"""Columns that hang on the speed line."""


class TurningCurves:
    """The whole machine at crank angles (n,) in degrees, on the sides of jumps that hold `within`.

    crank: radius of crank 1 in m, None without one.
    """

    def __init__(self, turned: MachineEffort, crank: float | None, phi: Array, within: Array) -> None:
        self._turned, self._crank, self._phi, self._within = turned, crank, phi, within

    def columns(self, speed: "SpeedLine | ElasticCoupling | None") -> Columns:
        """Return the columns."""
        own = {id: partial(self._value, id) for id in ("M", "M_load", "T", "T_inertia")}
        of_speed = {id: partial(self._of_speed, speed, id) for id in OF_SPEED}
        return Columns(self._phi, {**own, "E": lambda: self._turned.excess.at(self._phi), **of_speed})

    def _value(self, column: str) -> Array | None:
        found = self.curve(column)
        return found and np.asarray(found.value)

    def _of_speed(self, speed: "SpeedLine | ElasticCoupling | None", column: str) -> Array | None:
        angles = np.mod(self._phi, self._turned.cycle)
        found = speed.curves(angles, angles).get(column) if speed else None
        return None if found is None else found.value

    def curve(self, column: str) -> Sampled | None:
        """Return a column of the torques, or their work, with its slope by φ; None for one left out."""
        if column == "M_load":
            return Sampled.of(self._torque(self._turned.excess.load), self._phi.shape)
        if column == "E":
            return Sampled(self._turned.excess.at(self._phi), self._torque(self._turned.excess.torque).value)
        arm, torque = 1.0 if column == "M" else self._crank, self._inertia if column == "T_inertia" else self._effort
        return None if arm is None or torque is None else Sampled(torque.value / arm, torque.slope / arm)

    def _torque(self, torque: Torque) -> Jet:
        return torque.torque(self._phi, self._within)

    @cached_property
    def _effort(self) -> Jet:
        return self._torque(self._turned.effort)

    @cached_property
    def _inertia(self) -> Jet | None:
        """The torque of the inertia forces, with its share of the losses."""
        masses = self._turned.masses
        return self._torque(Sum(*((self._turned.efficiency, mass) for mass in masses))) if masses else None
