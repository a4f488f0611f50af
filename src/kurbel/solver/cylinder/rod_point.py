"""What a state of a cylinder tells of a point of its connecting rod or coupler."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any

from kurbel.crank_angle import CrankAngle

if TYPE_CHECKING:
    from kurbel.mechanisms.coupler import PointMotion
    from kurbel.solver.cylinder.drive import Drive


class OfPoint:
    """The columns of the point, as `State` has them; None where the cylinder names none."""

    drive: Drive
    angle: CrankAngle

    @cached_property
    def _point(self) -> PointMotion | None:
        point, mechanism = self.drive.cylinder.point, self.drive.mechanism
        coupler = mechanism.coupler_at(self.angle) if point else None
        if point is None or coupler is None:
            return None
        from kurbel.mechanisms.coupler import point_motion

        return point_motion(mechanism, coupler, self.angle, point.from_crank_pin(mechanism), point.across)

    @property
    def x_point(self) -> Any:
        """Place of the point of the rod in m from the shaft axis, along φ = 0."""
        return self._point and self._point.x

    @property
    def y_point(self) -> Any:
        """Its place in m along φ = 90°."""
        return self._point and self._point.y

    @property
    def v_point(self) -> Any:
        """Its speed in m/s."""
        return None if self._point is None or self.drive.omega is None else self._point.speed * self.drive.omega

    @property
    def b_point(self) -> Any:
        """The magnitude of its acceleration in m/s², at uniform rotation."""
        w = self.drive.omega
        return None if self._point is None or w is None else self._point.acceleration * (w * w)
