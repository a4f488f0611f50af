"""The closed loop of a four-bar linkage: where its coupler and rocker stand, and how fast they turn."""

import math
from typing import Any, NamedTuple

from kurbel.crank_angle import CrankAngle
from kurbel.mechanisms.coupler import Coupler
from kurbel.numerics.arithmetic import bearing, sqrt


class Loop(NamedTuple):
    """Four links over the length of the frame, with the gaps that decide how they close.

    crank a, coupler b, rocker c; span 1 − a; flat b + c − a − 1; near_coupler |1 − a| + b − c; near_rocker
    |1 − a| + c − b. It closes at the crank angles where its triangle of coupler, rocker and diagonal does, whether the
    crank turns fully or not.
    """

    crank: float
    coupler: float
    rocker: float
    span: float
    flat: float
    near_coupler: float
    near_rocker: float
    unlike: float

    @classmethod
    def of(cls, crank: float, coupler: float, rocker: float, frame: float) -> "Loop":
        """Return the loop of four lengths in one unit."""
        a, b, c = crank / frame, coupler / frame, rocker / frame
        near, far = min(crank, frame), max(crank, frame)
        return cls(
            a,
            b,
            c,
            (frame - crank) / frame,
            math.fsum((coupler, rocker, -crank, -frame)) / frame,
            math.fsum((far, coupler, -near, -rocker)) / frame,
            math.fsum((far, rocker, -near, -coupler)) / frame,
            (coupler - rocker) / frame,
        )

    def at(self, angle: CrankAngle) -> "Closure":
        """Return the loop closed at a crank angle, its gaps built from positive terms."""
        a, near, far = self.crank, angle.versine, angle.vercosine
        square = self.span * self.span + 2 * a * near
        diagonal = sqrt(square)
        lift = 2 * a * near / (diagonal + abs(self.span))  # diagonal − |1 − a|
        drop = 2 * a * far / (1 + a + diagonal)  # 1 + a − diagonal
        first, second = self.near_coupler + lift, self.near_rocker + lift
        beyond, total = self.flat + drop, self.coupler + self.rocker + diagonal
        # twice the area of the triangle coupler, rocker, diagonal, by Heron's product of differences
        area = sqrt(beyond * total) * sqrt(first * second) / 2
        return Closure(self, angle, near, square, area)


class Closure(NamedTuple):
    """A loop at a crank angle: square w of the diagonal from pin to rocker pivot, and H, twice the triangle's area."""

    loop: Loop
    angle: CrankAngle
    near: Any
    square: Any
    area: Any

    @property
    def direction(self) -> tuple[Any, Any]:
        """(sin θ, cos θ) of the rocker from the line of the pivots, its joint to the left of pin → rocker pivot."""
        across, along = self.loop.crank * self.angle.sin, self.loop.span + self.loop.crank * self.near
        foot = (self.square - self.loop.unlike * (self.loop.coupler + self.loop.rocker)) / 2
        scale = self.square * self.loop.rocker
        return (foot * across + self.area * along) / scale, (self.area * across - foot * along) / scale

    @property
    def turned(self) -> Any:
        """θ in degrees of a rocker that runs on with φ: the turning of the diagonal less the angle at its pivot."""
        foot = (self.square - self.loop.unlike * (self.loop.coupler + self.loop.rocker)) / 2
        lead = bearing(self.angle.sin, self.near - self.loop.span)  # of the diagonal before the crank
        return self.angle.degrees + lead - bearing(self.area, foot)

    @property
    def _by_coupler(self) -> Any:
        """E = w + b² − c²."""
        return self.square + self.loop.unlike * (self.loop.coupler + self.loop.rocker)

    @property
    def slope(self) -> Any:
        """dθ/dφ = [a sin φ E/(2H) + a(a − cos φ)]/w, the turning of the triangle and of the diagonal."""
        a, sin = self.loop.crank, self.angle.sin
        return (a * sin * self._by_coupler / (2 * self.area) + a * (self.near - self.loop.span)) / self.square

    @property
    def curvature(self) -> Any:
        """d²θ/dφ² = a sin φ (1 − a²)/w² + [w″E + w′²(1 − EG/(4H²) − E/w)]/(4Hw), with G = b² + c² − w."""
        loop, w, H, E = self.loop, self.square, self.area, self._by_coupler
        G = loop.coupler * loop.coupler + loop.rocker * loop.rocker - w
        rise, bend = 2 * loop.crank * self.angle.sin, 2 * loop.crank * self.angle.cos
        triangle = bend * E + rise * rise * (1 - (E / (2 * H)) * (G / (2 * H)) - E / w)
        return rise / 2 * loop.span * (1 + loop.crank) / (w * w) + triangle / (4 * H * w)

    @property
    def coupler(self) -> Coupler:
        """The coupler at τ, by the velocities and accelerations of its ends along the rocker at θ.

        b τ′ sin(θ−τ) = −a sin(θ−φ), b τ″ sin(θ−τ) = a cos(θ−φ) + b τ′² cos(θ−τ) − c θ′².
        """
        loop, (sin, cos), angle = self.loop, self.direction, self.angle
        a, b, c = loop.crank, loop.coupler, loop.rocker
        along, across = (1 + c * cos - a * angle.cos) / b, (c * sin - a * angle.sin) / b
        lever = self.area / c
        slope = -a * (sin * angle.cos - cos * angle.sin) / lever
        square = self.slope * self.slope
        bend = a * (cos * angle.cos + sin * angle.sin) + b * slope * slope * (cos * along + sin * across) - c * square
        return Coupler(across, along, slope, bend / lever)

    @property
    def sin_transmission(self) -> Any:
        """sin μ = H/(b c), μ between coupler and rocker."""
        return self.area / (self.loop.coupler * self.loop.rocker)
