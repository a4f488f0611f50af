"""Scotch yoke (Kurbelschleife), R p. 614: the slider-crank with an infinite rod, its block sliding across the yoke."""

import numpy as np

from kurbel.arrays import Array, Number
from kurbel.crank_angle import CrankAngle
from kurbel.declared.record import field
from kurbel.mechanisms import (
    BLOCK_OFFERS,
    NO_PIN,
    Mechanism,
    Sketch,
    force_column,
    pin_diameter,
    pin_length,
    pin_pressure_offer,
)
from kurbel.mechanisms.slider_crank import crank_field, stroke_instead, yoke_sketch

_N_PAIR = force_column(
    "N_pair",
    "N_2",
    "force",
    "Force on each of the two guides of a yoke, in opposite directions",
    lambda yoke, angle: yoke.guide_pair_factor(angle),
    lambda state: state.along_stroke,
)


class ScotchYoke(Mechanism):
    """A crank pin whose block slides in a yoke square to the stroke line.

    crank: R in m. The force on the pin is the force on the piston; there is no rod and no side force of one. But the
    pin is R sin φ away from the stroke line, and the yoke tilts unless two guides hold it.
    guide_length: their distance in m along the stroke; pin_diameter, pin_length in m; None where they are not known.
    Raises RuleError for lengths that are not positive.
    """

    crank: float = crank_field()
    _stroke = stroke_instead(lambda keys: {"crank": keys["stroke"] / 2})
    guide_length: float | None = field(
        "length",
        "Distance along the stroke of the two guides that keep the yoke from tilting",
        "l_g",
        above=0,
        absent="no force on the guides",
    )
    pin_diameter: float | None = pin_diameter()
    pin_length: float | None = pin_length()

    name = "scotch-yoke"
    is_crank_drive = True
    rubs = True
    known_across = True
    OFFERS = (*BLOCK_OFFERS, _N_PAIR)
    # R p. 615: up to 200 kgf/cm²
    KEY_OFFERS = (pin_pressure_offer(bound=200 * 98066.5),)

    def sketch(self, angle: CrankAngle) -> Sketch:
        """Return the crank with its block in the yoke."""
        return yoke_sketch(self.crank, angle)

    @property
    def stroke(self) -> float:
        """s = 2R."""
        return 2 * self.crank

    def dead_centres(self) -> tuple[float, float]:
        """Return 0° and 180°."""
        return 0.0, 180.0

    def coordinate(self, angle: CrankAngle) -> Number:
        """Return x = R(1 − cos φ) in m, R 287."""
        return self.crank * angle.versine

    def slope(self, angle: CrankAngle) -> Number:
        """Return dx/dφ = R sin φ in m, R 289."""
        return self.crank * angle.sin

    def curvature(self, angle: CrankAngle) -> Number:
        """Return d²x/dφ² = R cos φ in m, R 295."""
        return self.crank * angle.cos

    def block_slope(self, angle: CrankAngle) -> Number:
        """Return R cos φ in m: times ω, the speed at which the block slides along the yoke."""
        return self.crank * angle.cos

    def pin_force_factor(self, angle: CrankAngle) -> Number:
        """Return the force on the crank pin over P: 1, of the shape of the angle."""
        return angle.sin * 0 + 1.0

    def radial(self, angle: CrankAngle) -> Number:
        """Return D/P = cos φ, R 302 with ψ = 0."""
        return angle.cos

    @property
    def rubbing_pin(self) -> float | None:
        """The diameter of the crank pin, in its block."""
        return self.pin_diameter

    @property
    def guide_distance(self) -> float | None:
        """The distance of the guides."""
        return self.guide_length

    def guide_pair_factor(self, angle: CrankAngle) -> Number | None:
        """Return R sin φ/l_g: the couple of P on piston and pin, over the distance of the guides; None without it."""
        if self.guide_length is None:
            return None
        return self.crank / self.guide_length * angle.sin

    @property
    def lacks(self) -> tuple[tuple[str, str], ...]:
        """Name the guides and the pin, where their sizes are not given."""
        guides = (
            ()
            if self.guide_length is not None
            else (("force on the guides", "no guide_length given"),)
        )
        if self.pin_diameter is not None:
            return guides
        return (*guides, NO_PIN)

    def crank_angles_at(self, displacement: Array, outstroke: bool) -> Array:
        """Return φ = 2 arctan √(x/(2R − x)) in degrees, and 360° less on the return stroke."""
        sweep = np.degrees(
            2 * np.arctan2(np.sqrt(displacement), np.sqrt(self.stroke - displacement))
        )
        if outstroke:
            return sweep
        return 360.0 - sweep
