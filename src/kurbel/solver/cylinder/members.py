"""What the members do that only some mechanisms have: a lever or rocker, a block in its slot, a coupler, a free rod."""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING, Any

from kurbel.crank_angle import CrankAngle

if TYPE_CHECKING:
    from kurbel.mechanisms import Swing
    from kurbel.solver.cylinder.drive import Drive


class Members:
    """The part of `State` that asks the mechanism what else it has; attributes are ids of columns, None where absent.

    All in SI and of shape (n,), angles in degrees; those of motion are not for jets.
    """

    drive: Drive
    angle: CrankAngle

    # motion

    @cached_property
    def _swing(self) -> Swing | None:
        return self.drive.mechanism.swing_at(self.angle)

    @property
    def theta(self) -> Any:
        """Angle of the swinging member in degrees."""
        return None if self._swing is None else self._swing.degrees

    @property
    def theta_dot(self) -> Any:
        """Angular velocity of the swinging member in rad/s."""
        return self._at_speed(None if self._swing is None else self._swing.slope, 1)

    @property
    def theta_ddot(self) -> Any:
        """Angular acceleration of the swinging member in rad/s² at uniform rotation."""
        return self._at_speed(None if self._swing is None else self._swing.curvature, 2)

    @property
    def c_block(self) -> Any:
        """Speed in m/s at which the block slides along its slot."""
        return self._at_speed(self.drive.mechanism.block_slope(self.angle), 1)

    @property
    def x_coupler(self) -> Any:
        """Way in m of every coupler point along the frame."""
        return _of_pair(self.drive.mechanism.coupler_path(self.angle), 0)

    @property
    def y_coupler(self) -> Any:
        """Way in m of every coupler point across the frame."""
        return _of_pair(self.drive.mechanism.coupler_path(self.angle), 1)

    @property
    def bx_coupler(self) -> Any:
        """Acceleration in m/s² of every coupler point along the frame."""
        return self._at_speed(_of_pair(self.drive.mechanism.coupler_acceleration(self.angle), 0), 2)

    @property
    def by_coupler(self) -> Any:
        """Acceleration in m/s² of every coupler point across the frame."""
        return self._at_speed(_of_pair(self.drive.mechanism.coupler_acceleration(self.angle), 1), 2)

    def _at_speed(self, by_angle: Any, order: int) -> Any:
        omega = self.drive.omega
        return None if omega is None or by_angle is None else by_angle * math.prod((omega,) * order)

    # forces

    along_rod: Any
    N: Any
    M_out: Any

    @property
    def F_pin(self) -> Any:
        """Force in N of the sliding block on the crank pin, in the sense of P."""
        return _product(self.along_rod, self.drive.mechanism.pin_force_factor(self.angle))

    @property
    def N_pair(self) -> Any:
        """Force in N on each of the two guides that keep the output from tilting."""
        return _product(self.along_rod, self.drive.mechanism.guide_pair_factor(self.angle))

    @property
    def M_bend(self) -> Any:
        """Bending moment in N m of the side force on the piston rod, where no guide takes it."""
        return _product(self.N, self.drive.mechanism.bending_arm(self.angle))

    @property
    def F_coupler(self) -> Any:
        """Force in N in the coupler that passes on the moment of the swinging member."""
        return _product(self.M_out, self.drive.mechanism.coupler_force_factor(self.angle))


def _of_pair(pair: tuple[Any, Any] | None, index: int) -> Any:
    return None if pair is None else pair[index]


def _product(force: Any, factor: Any) -> Any:
    return None if force is None or factor is None else force * factor
