"""A mechanism from outside: what one file must supply, as the README says. The tests register it by one line."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from kurbel.crank_angle import CrankAngle
from kurbel.declared.forms import Physical
from kurbel.declared.keys import Key, Keys
from kurbel.mechanisms import Mechanism, check_lengths


@dataclass(frozen=True, eq=False)
class HarmonicCam(Mechanism):
    """A cam that lifts its follower by x = a (1 − cos φ) + k sin²φ."""

    crank: float
    second: float

    name: ClassVar[str] = "harmonic-cam"
    KEYS: ClassVar[Keys] = {
        "crank": Key(Physical("length", above=0), "Half the lift", "a", required=True),
        "second": Key(Physical("length", above=0), "Second harmonic", "k", required=True),
    }

    def __post_init__(self) -> None:
        check_lengths(crank=self.crank, second=self.second)

    @property
    def stroke(self) -> float:
        return 2 * self.crank

    def dead_centres(self) -> tuple[float, float]:
        return 0.0, 180.0

    def coordinate(self, angle: CrankAngle) -> Any:
        return self.crank * angle.versine + self.second * (angle.sin * angle.sin)

    def slope(self, angle: CrankAngle) -> Any:
        return angle.sin * (self.crank + 2 * self.second * angle.cos)

    def curvature(self, angle: CrankAngle) -> Any:
        return self.crank * angle.cos + 2 * self.second * (angle.cos * angle.cos - angle.sin * angle.sin)
