"""What `kurbel flywheel` tells over the angle of crank 1."""

from functools import cached_property, partial
from typing import TYPE_CHECKING

import numpy as np

from kurbel.arrays import Array
from kurbel.numerics.jet import Jet
from kurbel.numerics.search import Sampled
from kurbel.solver.figures import Columns
from kurbel.solver.turning.torques import Sum

if TYPE_CHECKING:
    from kurbel.solver.turning.flywheel import MachineTurning


OF_SPEED = ("omega", "alpha", "M_coupling")
"""Columns that hang on the speed line."""


class TurningCurves:
    """The whole machine at crank angles (n,) in degrees, on the sides of jumps that hold `within`."""

    def __init__(self, turning: "MachineTurning", phi: Array, within: Array) -> None:
        self._turning, self._turned, self._phi, self._within = turning, turning.turned, phi, within

    def columns(self) -> Columns:
        """Return the columns."""
        ids = ("M", "M_load", "T", "T_inertia", "E", *OF_SPEED)
        return Columns(self._phi, {id: partial(self._value, id) for id in ids})

    def _value(self, column: str) -> Array | None:
        found = self.curve(column)
        return None if found is None else found.value

    def curve(self, column: str) -> Sampled | None:
        """Return a column with its slope by φ; None for one left out."""
        if column in OF_SPEED:
            return self._of_speed.get(column)
        if column == "E":
            return Sampled(self._turned.excess.at(self._phi), (self._effort - self._load).value)
        torque = {"M_load": "_load", "T_inertia": "_inertia"}.get(column, "_effort")
        found, arm = getattr(self, torque), self._turning.crank if column.startswith("T") else 1.0
        return None if found is None or arm is None else Sampled.of(found / arm, self._phi.shape)

    @cached_property
    def _effort(self) -> Jet:
        return self._turned.effort.torque(self._phi, self._within)

    @cached_property
    def _load(self) -> Jet:
        return self._turned.excess.load.torque(self._phi, self._within)

    @cached_property
    def _inertia(self) -> Jet | None:
        """The torque of the inertia forces, with its share of the losses."""
        parts = [(self._turned.share(mass.drive), mass) for mass in self._turned.masses]
        return Sum(*parts).torque(self._phi, self._within) if parts else None

    @cached_property
    def _of_speed(self) -> dict[str, Sampled]:
        """What the speed line tells, which knows the angles of one cycle."""
        speed, cycle = self._turning.speed, self._turned.cycle
        turn = cycle * np.floor(self._within / cycle)
        return speed.curves(self._phi - turn, self._within - turn) if speed else {}
