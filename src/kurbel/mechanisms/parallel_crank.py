"""Parallel crank (Parallelkurbeltrieb), R ch. 14 A: two equal cranks and a coupler as long as the frame."""

import math
from typing import Any

from kurbel.arrays import Number
from kurbel.crank_angle import CrankAngle
from kurbel.declared.record import field
from kurbel.mechanisms import (
    F_COUPLER,
    PIN,
    SWING_OFFERS,
    SWING_VALUES,
    KeyOffer,
    Mechanism,
    Sketch,
    Turning,
    motion_column,
    on_circle,
)
from kurbel.quantity import Quantity

_POINT = "of every coupler point"
COUPLER_OFFERS = (
    motion_column(
        "x_coupler",
        "x_K",
        "length",
        f"Displacement {_POINT} along the frame",
        lambda mechanism, angle: -mechanism.crank * angle.versine,
    ),
    motion_column(
        "y_coupler",
        "y_K",
        "length",
        f"Displacement {_POINT} across the frame",
        lambda mechanism, angle: mechanism.crank * angle.sin,
    ),
    motion_column(
        "bx_coupler",
        "b_Kx",
        "acceleration",
        f"Acceleration {_POINT} along the frame",
        lambda mechanism, angle: -mechanism.crank * angle.cos,
        omega=2,
    ),
    motion_column(
        "by_coupler",
        "b_Ky",
        "acceleration",
        f"Acceleration {_POINT} across the frame",
        lambda mechanism, angle: -mechanism.crank * angle.sin,
        omega=2,
    ),
)
"""How the coupler runs from φ = 0 on: with the speed v = Rω, accelerated by v²/R toward the centre (R ch. 14 A)."""


def _acceleration(mechanism: Any, results: Any) -> float | None:
    """Return v²/R = R ω² in m/s²; None without a speed."""
    if results.omega is None:
        return None
    return mechanism.crank * results.omega * results.omega


def _inertia(mechanism: Any, results: Any) -> float | None:
    """Return m R ω² in N; None without a speed or the mass of the coupler."""
    acceleration = _acceleration(mechanism, results)
    if acceleration is None or mechanism.coupler_mass is None:
        return None
    return mechanism.coupler_mass * acceleration


COUPLER_VALUES = (
    KeyOffer(
        Quantity(
            "b_coupler",
            "b_K",
            "acceleration",
            f"Acceleration v²/R {_POINT}, toward its centre",
            "",
            ("motion", "forces"),
            after="theta_ddot_min",
        ),
        _acceleration,
    ),
    KeyOffer(
        Quantity(
            "coupler_inertia",
            "F_b",
            "force",
            "Centrifugal force m v²/R of the coupler",
            "",
            ("forces",),
            after="T_min",
        ),
        _inertia,
    ),
)


class ParallelCrank(Mechanism):
    """Two equal cranks, joined by a coupler of the length of the frame: the coupled wheels of a locomotive.

    crank: R; frame: distance of the two shafts, and length of the coupler; in m. coupler_mass: kg, None where it is not
    known. The output is the second crank, θ = φ. Every point of the coupler runs on a circle of radius R. Raises
    RuleError for lengths that are not positive.
    """

    crank: float = field("length", "Radius of both cranks", "R", above=0)
    frame: float = field("length", "Distance of the shafts; the coupler is as long", "d", above=0)
    coupler_mass: float | None = field(
        "mass", "Mass of the coupler", "m", least=0, absent="no inertia of the coupler"
    )

    name = "parallel-crank"
    slides = False
    turns = True
    stroke = math.tau
    swing = None
    OFFERS = (*SWING_OFFERS, *COUPLER_OFFERS, F_COUPLER)
    KEY_OFFERS = (*SWING_VALUES, *COUPLER_VALUES)
    notes = (
        "At 0 and 180 deg cranks and coupler lie in one line: one pair alone passes on no torque there and leaves "
        "the motion undetermined; a second pair of cranks at 90 deg to the first carries it through.",
    )

    def dead_centres(self) -> tuple[float, float]:
        """Return 0° and 180°, where cranks and coupler lie in one line and the motion is undetermined."""
        return 0.0, 180.0

    def coordinate(self, angle: CrankAngle) -> Number:
        """Return θ = φ in radians."""
        return angle.degrees * (math.pi / 180)

    def slope(self, angle: CrankAngle) -> Number:
        """Return dθ/dφ = 1."""
        return angle.sin * 0 + 1.0

    def curvature(self, angle: CrankAngle) -> Number:
        """Return d²θ/dφ² = 0."""
        return angle.sin * 0

    def swing_at(self, angle: CrankAngle) -> Turning:
        """Return the second crank, which turns as the first does."""
        return Turning(angle.degrees, self.slope(angle), self.curvature(angle))

    def sketch(self, angle: CrankAngle) -> Sketch:
        """Return both cranks and the coupler."""
        second = self.frame, 0.0
        joints = {
            "second": second,
            "second pin": on_circle(self.crank, angle.cos, angle.sin, second),
        }
        links = (PIN, "second pin"), ("second pin", "second")
        return Sketch.of_crank(self.crank, angle, joints, *links, fixed=("second",))

    def coupler_force_factor(self, angle: CrankAngle) -> Number:
        """Return the coupler's force over the torque it passes on, sin φ/R in 1/m, with a second pair at 90°.

        Of two equally stiff couplers at 90° each takes a force as its stretch, R sin φ δ, so that the two torques add
        up to sin²φ + cos²φ = 1. One pair alone would need 1/(R sin φ), which no force reaches at the dead centres.
        """
        return angle.sin / self.crank

    @property
    def lacks(self) -> tuple[tuple[str, str], ...]:
        """Name the inertia of the coupler, where its mass is not given."""
        if self.coupler_mass is not None:
            return ()
        return (("inertia of the coupler", "no coupler_mass given"),)
