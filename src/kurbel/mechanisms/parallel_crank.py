"""Parallel crank (Parallelkurbeltrieb), R ch. 14 A: two equal cranks and a coupler as long as the frame."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

from kurbel.declared.forms import Physical
from kurbel.declared.keys import Key, Keys, check
from kurbel.mechanisms import Mechanism, Swing, check_lengths
from kurbel.numerics.extreme import Extreme

if TYPE_CHECKING:
    from kurbel.crank_angle import CrankAngle


@dataclass(frozen=True, eq=False)
class ParallelCrank(Mechanism):
    """Two equal cranks, joined by a coupler of the length of the frame: the coupled wheels of a locomotive.

    crank: R; frame: distance of the two shafts, and length of the coupler; in m. coupler_mass: kg, None where it is not
    known. The output is the second crank, θ = φ. Every point of the coupler runs on a circle of radius R. Raises
    RuleError for lengths that are not positive.
    """

    crank: float
    frame: float
    coupler_mass: float | None = None

    name: ClassVar[str] = "parallel-crank"
    slides: ClassVar[bool] = False
    swings: ClassVar[bool] = True
    KEYS: ClassVar[Keys] = {
        "crank": Key(Physical("length", above=0), "Radius of both cranks", "R", required=True),
        "frame": Key(Physical("length", above=0), "Distance of the shafts; the coupler is as long", "d", required=True),
        "coupler_mass": Key(Physical("mass", least=0), "Mass of the coupler", "m", absent="no inertia of the coupler"),
    }

    def __post_init__(self) -> None:
        check_lengths(crank=self.crank, frame=self.frame)
        check(self.KEYS, {"coupler_mass": self.coupler_mass})

    @property
    def stroke(self) -> float:
        """2π: the second crank turns fully."""
        return math.tau

    def dead_centres(self) -> tuple[float, float]:
        """Return 0° and 180°, where cranks and coupler lie in one line and the motion is undetermined."""
        return 0.0, 180.0

    def coordinate(self, angle: CrankAngle) -> Any:
        """Return θ = φ in radians."""
        return angle.degrees * (math.pi / 180)

    def slope(self, angle: CrankAngle) -> Any:
        """Return dθ/dφ = 1."""
        return angle.sin * 0 + 1.0

    def curvature(self, angle: CrankAngle) -> Any:
        """Return d²θ/dφ² = 0."""
        return angle.sin * 0

    def swing_extremes(self) -> tuple[Extreme, ...]:
        """Return 1 and 1: the second crank turns evenly."""
        return Extreme(1.0, 0.0), Extreme(1.0, 0.0)

    def swing_at(self, angle: CrankAngle) -> Swing:
        """Return the second crank, which turns as the first does."""
        return Swing(angle.degrees, self.slope(angle), self.curvature(angle))

    def coupler_path(self, angle: CrankAngle) -> tuple[Any, Any]:
        """Return the way (along, across) the line of the shafts that every coupler point has come from φ = 0, in m.

        Its speed is v = Rω and its acceleration v²/R, toward the centre of its circle.
        """
        return -self.crank * angle.versine, self.crank * angle.sin

    def coupler_acceleration(self, angle: CrankAngle) -> tuple[Any, Any]:
        """Return the acceleration (along, across) of every coupler point over ω², in m: of size R, R ch. 14 A."""
        return -self.crank * angle.cos, -self.crank * angle.sin

    @property
    def coupler_inertia(self) -> float | None:
        """m R in kg m: the inertia force m v²/R over ω², R ch. 14 A."""
        return None if self.coupler_mass is None else self.coupler_mass * self.crank

    def coupler_force_factor(self, angle: CrankAngle) -> Any:
        """Return the coupler's force over the torque it passes on, sin φ/R in 1/m, with a second pair at 90°.

        Of two equally stiff couplers at 90° each takes a force as its stretch, R sin φ δ, so that the two torques add
        up to sin²φ + cos²φ = 1. One pair alone would need 1/(R sin φ), which no force reaches at the dead centres.
        """
        return angle.sin / self.crank

    @property
    def lacks(self) -> tuple[tuple[str, str], ...]:
        """Name the inertia of the coupler, where its mass is not given."""
        return () if self.coupler_mass is not None else (("inertia of the coupler", "no coupler_mass given"),)

    @property
    def notes(self) -> tuple[str, ...]:
        """Name the undetermined positions and their cure."""
        return (
            "At 0 and 180 deg cranks and coupler lie in one line: one pair alone passes on no torque there and leaves "
            "the motion undetermined; a second pair of cranks at 90 deg to the first carries it through.",
        )
