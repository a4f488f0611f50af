"""Yoke-frame small crank drive (Klein, Schanzlin & Becker), R p. 614: a slider-crank without a crosshead guide.

Steam and pump piston rod lie in one line, joined by a frame in which rod and crank move. The motion is that of the
slider-crank; the side force N of the rod finds no guide and bends the piston rod.
"""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, ClassVar

from kurbel.crank_angle import CrankAngle
from kurbel.declared.record import Rule, field
from kurbel.mechanisms import Offer, finite, own_force
from kurbel.mechanisms.slider_crank import SliderCrank

_M_BEND = own_force(
    "M_bend",
    "M_b",
    "torque",
    "Bending moment of N on the piston rod at its stuffing box",
    called="bending moment of N on the piston rod",
)


@dataclass(frozen=True, eq=False, repr=False)
class YokeFrame(SliderCrank):
    """A slider-crank whose crosshead pin is held by the piston rod alone.

    gland: distance in m from the stuffing box that guides the piston rod to the crosshead pin at the inner dead centre;
    None leaves the bending out. Raises RuleError as SliderCrank does, and for a gland that is not positive.
    """

    gland: float | None = field(
        "length",
        "Distance from the stuffing box to the crosshead pin at the inner dead centre",
        "l_g",
        above=0,
        absent="no bending of the piston rod",
    )

    name: ClassVar[str] = "yoke-frame"
    guided: ClassVar[bool] = False
    OFFERS: ClassVar[tuple[Offer, ...]] = (
        *SliderCrank.OFFERS,
        Offer(_M_BEND, lambda drive, angle: drive.bending_arm(angle), force=lambda state: state.N),
    )
    notes: ClassVar[tuple[str, ...]] = (
        "There is no crosshead guide: the side force N bends the piston rod (R p. 614).",
    )

    def rules(self) -> Iterator[Rule]:
        yield from SliderCrank.rules(self)
        yield from finite(self, "gland")

    def bending_arm(self, angle: CrankAngle) -> Any | None:
        """Return l_g + x in m, on which N bends the piston rod at the stuffing box; None where `gland` is not given.

        The rod is taken as held by this stuffing box alone, which is on the safe side.
        """
        return None if self.gland is None else self.gland + self.coordinate(angle)

    @property
    def lacks(self) -> tuple[tuple[str, str], ...]:
        """Name the bending of the piston rod, where its arm is not known."""
        return () if self.gland is not None else (("bending of the piston rod", "no gland given"),)
