"""A mechanism from outside: what one file must supply, as the README says. The tests register it by one line."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from kurbel.crank_angle import CrankAngle
from kurbel.declared.keys import Key, Keys, Physical
from kurbel.declared.quantity import Quantity
from kurbel.mechanisms import Mechanism, Offer, check_lengths


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
    OFFERS: ClassVar[tuple[Offer, ...]] = (
        Offer(
            Quantity(
                "M_tilt",
                "M_t",
                "torque",
                "Moment of P on the flat follower, which the cam touches dx/dφ beside its axis",
                commands=("forces",),
                extremes=("forces",),
                called="moment of P on the follower",
                after="P",
            ),
            lambda cam, angle: cam.slope(angle),
            ("P",),
        ),
    )

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
