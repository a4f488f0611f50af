"""Parallel crank (Parallelkurbeltrieb), R ch. 14 A: two equal cranks and a coupler as long as the frame."""

import math
from dataclasses import dataclass
from typing import Any, ClassVar

from kurbel.crank_angle import CrankAngle
from kurbel.declared.forms import not_negative, positive
from kurbel.declared.keys import Keys, check
from kurbel.mechanisms import KeyOffer, Mechanism, Offer, check_lengths, own_motion
from kurbel.mechanisms.sketch import PIN, SHAFT, Sketch, on_circle
from kurbel.mechanisms.swing import F_COUPLER, SWING_OFFERS, SWING_VALUES, Swing
from kurbel.quantity import Quantity


def _way(id: str, symbol: str, along: str, index: int) -> Offer:
    quantity = own_motion(id, symbol, "length", f"Way of every coupler point {along} the frame")
    return Offer(quantity, lambda one, angle: one.coupler_path(angle)[index])


def _acceleration(id: str, symbol: str, along: str, index: int) -> Offer:
    quantity = own_motion(id, symbol, "acceleration", f"Acceleration of every coupler point {along} the frame")
    return Offer(quantity, lambda one, angle: one.coupler_acceleration(angle)[index], omega=2)


def _squared(omega: float | None, *factors: float | None) -> float | None:
    """Return the product of the factors times ω²; None where one is not known."""
    known = [factor for factor in factors if factor is not None]
    return None if omega is None or len(known) < len(factors) else math.prod(known) * (omega * omega)


_ACCELERATION = "Acceleration v²/R of every coupler point, toward its centre"
_FORCE = "Inertia force m v²/R of the coupler, turning with the cranks"
_BOTH = ("motion", "forces")
_B_COUPLER = Quantity("b_coupler", "b_K", "acceleration", _ACCELERATION, "", _BOTH, after="theta_ddot_min")
_INERTIA = Quantity("coupler_inertia", "F_b", "force", _FORCE, commands=("forces",), after="T_min")


@dataclass(frozen=True, eq=False, repr=False)
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
    turns: ClassVar[bool] = True
    swing: ClassVar[None] = None
    OFFERS: ClassVar[tuple[Offer, ...]] = (
        *SWING_OFFERS,
        _way("x_coupler", "x_K", "along", 0),
        _way("y_coupler", "y_K", "across", 1),
        _acceleration("bx_coupler", "b_Kx", "along", 0),
        _acceleration("by_coupler", "b_Ky", "across", 1),
        F_COUPLER,
    )
    KEY_OFFERS: ClassVar[tuple[KeyOffer, ...]] = (
        *SWING_VALUES,
        KeyOffer(_B_COUPLER, lambda one, motion: _squared(motion.omega, one.crank)),
        KeyOffer(_INERTIA, lambda one, forces: _squared(forces.omega, one.coupler_mass, one.crank)),
    )
    KEYS: ClassVar[Keys] = {
        "crank": positive("length", "Radius of both cranks", "R", required=True),
        "frame": positive("length", "Distance of the shafts; the coupler is as long", "d", required=True),
        "coupler_mass": not_negative("mass", "Mass of the coupler", "m", absent="no inertia of the coupler"),
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

    def swing_at(self, angle: CrankAngle) -> Swing:
        """Return the second crank, which turns as the first does."""
        return Swing(angle.degrees, self.slope(angle), self.curvature(angle))

    def sketch(self, angle: CrankAngle) -> Sketch:
        """Return both cranks and the coupler."""
        pin = on_circle(self.crank, angle.cos, angle.sin)
        joints = {SHAFT: (0.0, 0.0), PIN: pin, "second pin": (pin[0] + self.frame, pin[1]), "second": (self.frame, 0.0)}
        return Sketch(joints, ((SHAFT, PIN), (PIN, "second pin"), ("second pin", "second")), (SHAFT, "second"))

    def coupler_path(self, angle: CrankAngle) -> tuple[Any, Any]:
        """Return the way (along, across) the line of the shafts that every coupler point has come from φ = 0, in m.

        Its speed is v = Rω and its acceleration v²/R, toward the centre of its circle.
        """
        return -self.crank * angle.versine, self.crank * angle.sin

    def coupler_acceleration(self, angle: CrankAngle) -> tuple[Any, Any]:
        """Return the acceleration (along, across) of every coupler point over ω², in m: of size R, R ch. 14 A."""
        return -self.crank * angle.cos, -self.crank * angle.sin

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
