"""Everything that can be said of one cylinder at given crank angles, each quantity computed when it is asked for."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from kurbel.crank_angle import CrankAngle
from kurbel.errors import NoSolutionError

if TYPE_CHECKING:
    from kurbel.solver.drive import Drive

Array = NDArray[np.float64]
GRAVITY = 9.80665


class State:
    """A cylinder at crank angles (n,); its attributes are named by the ids of the columns, in SI, each of shape (n,).

    angle: the crank angles; with jets for sine and cosine every quantity becomes a jet with its slope by φ.
    within: angles in degrees (n,) that say on which side of a jump each one is meant; the angles themselves mean the
    side just after it. A quantity that the machine does not have is None.
    """

    def __init__(self, drive: Drive, angle: CrankAngle, within: Array | None = None) -> None:
        self.drive = drive
        self.angle = angle
        self.within = angle.degrees if within is None else within
        self._inside = self if within is None else State(drive, CrankAngle.of(within))

    @property
    def phi(self) -> Array:
        """Crank angle in degrees."""
        return self.angle.degrees  # type: ignore[no-any-return]

    @cached_property
    def x(self) -> Any:
        """Displacement in m."""
        return self.drive.mechanism.coordinate(self.angle)

    @cached_property
    def slope(self) -> Any:
        """dx/dφ in m per radian."""
        return self.drive.mechanism.slope(self.angle)

    @cached_property
    def curvature(self) -> Any:
        """d²x/dφ² in m per radian squared."""
        return self.drive.mechanism.curvature(self.angle)

    @cached_property
    def c(self) -> Any:
        """Velocity in m/s."""
        return None if self.drive.omega is None else self.slope * self.drive.omega

    @cached_property
    def b(self) -> Any:
        """Acceleration in m/s² at uniform rotation."""
        return None if self.drive.omega is None else self.curvature * self.drive.omega**2

    @cached_property
    def _rod(self) -> tuple[Any, Any] | None:
        return self.drive.mechanism.rod_angle(self.angle)

    @cached_property
    def psi(self) -> Any:
        """Rod angle in degrees; not for jets."""
        return None if self._rod is None else np.degrees(np.arctan2(*self._rod))

    @cached_property
    def direction(self) -> Array:
        """+1 on the outstroke, −1 on the return stroke, shape (n,)."""
        inner, outer = self.drive.mechanism.dead_centres()
        return np.where(np.mod(self.within - inner, 360.0) < outer - inner, 1.0, -1.0)

    @cached_property
    def p_head(self) -> Any:
        """Gauge pressure at the head end of the cylinder's own piston in Pa."""
        gas = self.drive.own_gas
        return gas.head(self.x, self.within) if gas and gas.head else None

    @cached_property
    def p_crank(self) -> Any:
        """Gauge pressure at the crank end of the cylinder's own piston in Pa."""
        gas = self.drive.own_gas
        return gas.crank(self.x, self.within) if gas and gas.crank else None

    @cached_property
    def P_gas(self) -> Any:
        """Force of gas, steam or water on all pistons in N, R 296."""
        return sum(gas.force(self.x, self.within) for gas in self.drive.gas) if self.drive.gas else None

    @cached_property
    def P_inertia(self) -> Any:
        """−m b in N, R 298."""
        return -self.drive.mass * self.b if self.drive.has_inertia else None

    @cached_property
    def P_weight(self) -> Any:
        """Weight along the stroke line in N, positive toward the shaft."""
        weight = self.drive.weight
        return np.full_like(self.within, weight[0]) if weight else None

    @cached_property
    def P_start(self) -> Any:
        """Piston force without inertia in N: starting and slow running."""
        return _sum(self.P_gas, self.P_weight)

    @cached_property
    def P(self) -> Any:
        """Force at the crosshead along the stroke line in N: gas, inertia, weight."""
        return _sum(self.P_inertia, self.P_start)

    @cached_property
    def _after_rings(self) -> Any:
        """Force left for crosshead and rod after ring friction in N."""
        return self.P - self.direction * self.drive.ring_force if self.drive.ring_force else self.P

    @cached_property
    def guide_sense(self) -> Any:
        """The force whose sign is that of N: P sin ψ + G cos ψ with the weight G on the guide, in N."""
        sin_psi, cos_psi = self._rod if self._rod else (0.0, 1.0)
        return self._after_rings * sin_psi + cos_psi * self.drive.guide_weight

    @cached_property
    def N(self) -> Any:
        """Force on the guide in N, D 3 with signs: N = (P sin ψ + G cos ψ)/(cos ψ + f sin ψ sgn c sgn N).

        With f = 0 and no weight this is R 301, N = P tan ψ. Raises NoSolutionError where the crosshead locks itself.
        """
        if self.P is None or self._rod is None:
            return None
        if not self.drive.crosshead_friction:
            return self._after_rings * (self._rod[0] / self._rod[1]) + self.drive.guide_weight
        return self.guide_sense / self._below

    @cached_property
    def _guide_side(self) -> Array:
        """+1 where N ≥ 0, else −1, asked for within the piece: where N vanishes at its end, rounding would pick one."""
        return np.where(self._inside.guide_sense >= 0, 1.0, -1.0)

    @cached_property
    def _below(self) -> Any:
        assert self._rod is not None
        sin_psi, cos_psi = self._rod
        below = cos_psi + sin_psi * (self._guide_side * self.direction * self.drive.crosshead_friction)
        locked = self.phi[getattr(below, "value", below) <= 0]
        if locked.size:
            raise NoSolutionError(self._locks(float(locked[0])))
        return below

    def _locks(self, degrees: float) -> str:
        f = self.drive.crosshead_friction
        return (
            f"{self.drive.name}: the crosshead locks itself near φ = {degrees % 360:.4g}°, where the machine is driven "
            f"and f tan ψ ≥ 1 (f = {f:g}); a driven machine needs R/L < 1/√(1 + f²) = {1 / np.sqrt(1 + f * f):.6g}"
        )

    @cached_property
    def _crosshead_drag(self) -> Any:
        """Crosshead friction f |N| in N, against the motion."""
        return self.N * (self._guide_side * self.drive.crosshead_friction) if self.drive.crosshead_friction else 0.0

    @cached_property
    def F_friction(self) -> Any:
        """Friction of crosshead and rings along the stroke line in N, positive toward the shaft."""
        if self.P is None or not self.drive.has_friction:
            return None
        return (self._crosshead_drag + self.drive.ring_force) * -self.direction

    @cached_property
    def along_rod(self) -> Any:
        """The part of the rod force along the stroke line in N: the piston force less all friction."""
        friction = self.F_friction
        return self.P if friction is None else self.P + friction

    @cached_property
    def S(self) -> Any:
        """Rod force in N, compression positive, R 300."""
        return None if self.P is None or self._rod is None else self.along_rod / self._rod[1]

    @cached_property
    def D(self) -> Any:
        """Radial force at the crank pin in N, positive toward the shaft, R 302."""
        if self.P is None or self._rod is None:
            return None
        return self.along_rod * (self.angle.cos - self.angle.sin * (self._rod[0] / self._rod[1]))

    @cached_property
    def T(self) -> Any:
        """Tangential force at the crank pin in N, R 303: T R dφ = P dx."""
        return None if self.P is None else self.along_rod * (self.slope / self.drive.mechanism.crank)

    @cached_property
    def M(self) -> Any:
        """Torque on the shaft in N m."""
        return None if self.P is None else self.along_rod * self.slope

    @cached_property
    def crosshead_power(self) -> Any:
        """Crosshead friction times way by crank angle in J per radian, positive."""
        return self._crosshead_drag * (self.slope * self.direction)


def _sum(first: Any, second: Any) -> Any:
    if first is None:
        return second
    return first if second is None else first + second
