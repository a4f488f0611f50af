"""Scotch yoke (Kurbelschleife), R p. 616: the slider-crank with an infinite rod, its block sliding across the yoke."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

from kurbel.keys import Keys
from kurbel.mechanisms import Extreme, Mechanism, check_lengths
from kurbel.mechanisms.slider_crank import CRANK_KEYS, one_of

if TYPE_CHECKING:
    from kurbel.crank_angle import CrankAngle


@dataclass(frozen=True, eq=False)
class ScotchYoke(Mechanism):
    """A crank pin whose block slides in a yoke square to the stroke line.

    crank: R in m. The force on the pin is the force on the piston; there is no rod and no side force of one.
    Raises RuleError for a crank that is not positive.
    """

    crank: float

    name: ClassVar[str] = "scotch-yoke"
    KEYS: ClassVar[Keys] = CRANK_KEYS

    @classmethod
    def from_keys(cls, crank: float | None = None, stroke: float | None = None) -> ScotchYoke:
        """Return the Scotch yoke that these keys of a machine file describe; raises RuleError."""
        one_of(("crank", crank), ("stroke", stroke), hint="crank: 400 mm")
        return cls(crank if crank is not None else (stroke or 0.0) / 2)

    def __post_init__(self) -> None:
        check_lengths(crank=self.crank)

    @property
    def stroke(self) -> float:
        """s = 2R."""
        return 2 * self.crank

    def dead_centres(self) -> tuple[float, float]:
        """Return 0° and 180°."""
        return 0.0, 180.0

    def coordinate(self, angle: CrankAngle) -> Any:
        """Return x = R(1 − cos φ) in m, R 287."""
        return self.crank * angle.versine

    def slope(self, angle: CrankAngle) -> Any:
        """Return dx/dφ = R sin φ in m, R 289."""
        return self.crank * angle.sin

    def curvature(self, angle: CrankAngle) -> Any:
        """Return d²x/dφ² = R cos φ in m, R 295."""
        return self.crank * angle.cos

    def block_slope(self, angle: CrankAngle) -> Any:
        """Return R cos φ in m: times ω, the speed at which the block slides along the yoke."""
        return self.crank * angle.cos

    def pin_force_factor(self, angle: CrankAngle) -> Any:
        """Return the force on the crank pin over P: 1, of the shape of the angle."""
        return angle.sin * 0 + 1.0

    def crank_angles_at(self, displacement: Any, outstroke: bool) -> Any:
        """Return φ = 2 arctan √(x/(2R − x)) in degrees, and 360° less on the return stroke."""
        import numpy as np

        sweep = np.degrees(2 * np.arctan2(np.sqrt(displacement), np.sqrt(self.stroke - displacement)))
        return sweep if outstroke else 360.0 - sweep

    def landmarks(self) -> tuple[float, ...]:
        """Return the velocity peaks, 90° and 270°."""
        return 90.0, 270.0

    def velocity_extremes(self) -> tuple[Extreme, ...]:
        """Return ±R: c_max = v at 90°."""
        return Extreme(self.crank, 90.0), Extreme(-self.crank, 270.0)

    def acceleration_extremes(self) -> tuple[Extreme, ...]:
        """Return ±R: b_max = v²/R at 0°."""
        return Extreme(self.crank, 0.0), Extreme(-self.crank, 180.0)
