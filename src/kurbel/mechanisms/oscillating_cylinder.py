"""Oscillating cylinder (wobbler, trunnion engine): the piston rod is on the crank pin, and the cylinder swings with it."""

from collections.abc import Iterator
from typing import Any

import numpy as np

from kurbel.arrays import Array, Number
from kurbel.crank_angle import CrankAngle
from kurbel.declared.record import Rule, field
from kurbel.mechanisms import (
    PIN,
    SWING_OFFERS,
    SWING_VALUES,
    Mechanism,
    Sketch,
    Turning,
    on_circle,
    pin_force,
)
from kurbel.mechanisms.slider_crank import crank_field, stroke_instead
from kurbel.numerics.arithmetic import bearing, sqrt


class OscillatingCylinder(Mechanism):
    """A piston whose rod is on the crank pin, in a cylinder that swings on trunnions.

    crank: r; trunnion: e, distance of the trunnions from the shaft, in m. φ = 0 where the pin is on the trunnions' side.
    x, c and b are those of the piston in its cylinder. ρ is the distance of the pin from the trunnions, v = 1 − cos φ:

        ρ = √((e − r)² + 2 r e v)      x = ρ − (e − r) = 2 r e v/(ρ + e − r)      θ = −arctan(r sin φ/(e − r cos φ))

    Under P the piston with its rod touches the cylinder nowhere: pin and trunnions have ±P along the cylinder.
    Raises RuleError for e ≤ r.
    """

    crank: float = crank_field()
    _stroke = stroke_instead(lambda keys: {"crank": keys["stroke"] / 2})
    trunnion: float = field(
        "length",
        "Distance of the trunnions from the shaft",
        "e",
        above=0,
        example="1.6 m",
        also=("pivot", "trunnion_distance", "pivot_distance", "frame"),
    )

    name = "oscillating-cylinder"
    swings_cylinder = True
    OFFERS = (*SWING_OFFERS, pin_force(lambda cylinder, angle: 1.0))
    KEY_OFFERS = SWING_VALUES
    notes = (
        "The cylinder swings with its piston: x, c and b are motion in the cylinder; its masses, and the friction of "
        "trunnions and ports, are not computed.",
    )

    def rules(self) -> Iterator[Rule]:
        message = "{trunnion} is no more than the crank ({crank}): the crank pin would pass through the trunnions"
        yield Rule("trunnion", self.trunnion <= self.crank, message)

    @property
    def stroke(self) -> float:
        """2 r."""
        return 2 * self.crank

    def dead_centres(self) -> tuple[float, float]:
        """Return 0° and 180°, where pin, shaft and trunnions are in line."""
        return 0.0, 180.0

    @property
    def _gap(self) -> float:
        """Least distance of the pin from the trunnions, e − r, in m."""
        return self.trunnion - self.crank

    def _reach(self, angle: CrankAngle) -> Number:
        """Return the distance ρ of the pin from the trunnions in m."""
        return sqrt(self._gap * self._gap + 2 * self.crank * self.trunnion * angle.versine)

    def coordinate(self, angle: CrankAngle) -> Number:
        """Return x = 2 r e v/(ρ + e − r) in m, the travel of the piston in its cylinder."""
        spread = 2 * self.crank * self.trunnion * angle.versine
        return spread / (self._reach(angle) + self._gap)

    def remaining(self, angle: CrankAngle) -> Number:
        """Return s − x = 2 r e (1 + cos φ)/(ρ + e + r) in m."""
        spread = 2 * self.crank * self.trunnion * angle.vercosine
        return spread / (self._reach(angle) + self.trunnion + self.crank)

    def slope(self, angle: CrankAngle) -> Number:
        """Return x′ = r e sin φ/ρ in m."""
        return self.crank * self.trunnion * angle.sin / self._reach(angle)

    def curvature(self, angle: CrankAngle) -> Number:
        """Return x″ = (r e cos φ − x′²)/ρ in m."""
        slope = self.slope(angle)
        return (self.crank * self.trunnion * angle.cos - slope * slope) / self._reach(angle)

    def crank_angles_at(self, displacement: Array, outstroke: bool) -> Array:
        """Return the crank angles in degrees at which x (n,) in m is passed on the outstroke or the return stroke.

        tan φ/2 = √(x (ρ + e − r)/((2r − x)(ρ + e + r))) with ρ = x + e − r.
        """
        reach = displacement + self._gap
        before = displacement * (reach + self._gap)
        after = (self.stroke - displacement) * (reach + self.trunnion + self.crank)
        degrees = np.degrees(2 * np.arctan2(np.sqrt(before), np.sqrt(after)))
        if outstroke:
            return degrees
        return 360.0 - degrees

    # the cylinder

    def _direction(self, angle: CrankAngle) -> tuple[Number, Number]:
        """Return (sin θ, cos θ) of the cylinder."""
        reach = self._reach(angle)
        along = self._gap + self.crank * angle.versine
        return -self.crank * angle.sin / reach, along / reach

    def swing_at(self, angle: CrankAngle) -> Turning:
        """Return how the cylinder turns: θ, θ′ = −r(e cos φ − r)/ρ², θ″ = r e (e² − r²) sin φ/ρ⁴."""
        crank, trunnion = self.crank, self.trunnion
        square = self._reach(angle) ** 2
        slope = -crank * (self._gap - trunnion * angle.versine) / square
        bend = crank * trunnion * self._gap * (trunnion + crank) * angle.sin / (square * square)
        sin, cos = self._direction(angle)
        return Turning(bearing(sin, cos), slope, bend)

    @property
    def _half_swing(self) -> tuple[float, float]:
        """Sine and cosine of half the swing: r/e, and √(1 − (r/e)²)."""
        share = self.crank / self.trunnion
        return share, sqrt(self._gap / self.trunnion * (1 + share))

    @property
    def swing(self) -> float:
        """2 arcsin(r/e) in degrees."""
        return 2 * bearing(*self._half_swing)

    def swing_ends(self) -> tuple[float, float]:
        """Return where the rod is tangent to the circle of the pin, cos φ = r/e, in degrees."""
        sin, cos = self._half_swing
        degrees = bearing(cos, sin)
        return degrees, 360.0 - degrees

    def radial(self, angle: CrankAngle) -> Number:
        """Return D/P = cos(φ − θ)."""
        sin, cos = self._direction(angle)
        return angle.cos * cos + angle.sin * sin

    def sketch(self, angle: CrankAngle) -> Sketch:
        """Return crank, piston rod and trunnions; the rod is as long as the trunnions are away from the shaft."""
        pin = on_circle(self.crank, angle.cos, angle.sin)
        sin, cos = self._direction(angle)
        joints: dict[str, Any] = {
            "trunnion": (self.trunnion, 0.0),
            "piston": on_circle(self.trunnion, cos, sin, pin),
        }
        return Sketch.of_crank(self.crank, angle, joints, (PIN, "piston"), fixed=("trunnion",))
