"""Yoke-frame small crank drive (Klein, Schanzlin & Becker), R p. 614: a slider-crank without a crosshead guide.

Steam and pump piston rod lie in one line, joined by a frame in which rod and crank move. The motion is that of the
slider-crank; the side force N of the rod finds no guide and bends the piston rod.
"""

import math
from typing import Any

from kurbel.arrays import Number
from kurbel.crank_angle import CrankAngle
from kurbel.declared.record import field
from kurbel.mechanisms import Offer, force_column
from kurbel.mechanisms.slider_crank import SliderCrank
from kurbel.numerics.arithmetic import some


def _stress(state: Any, along: float, across: float) -> Any:
    """Return along · P/A + across · M_b/W of the piston rod at the crank end; None without it, force or gland."""
    pistons, arm = state.drive.cylinder.pistons, state.mechanism.bending_arm(state.posed)
    if state.N is None or arm is None or not pistons or not some(pistons[0].crank_end_rod != 0):
        return None
    diameter = pistons[0].crank_end_rod
    return (4 * along * state.P + 32 * across * state.N * arm / diameter) / (math.pi * diameter * diameter)


def _stress_column(id: str, symbol: str, text: str, along: float, across: float) -> Offer:
    return force_column(id, symbol, "stress", text, lambda *_: 1.0, lambda state: _stress(state, along, across))


BENDING_OFFERS = (
    force_column(
        "M_bend",
        "M_b",
        "torque",
        "Bending moment of N on the piston rod, at its stuffing box",
        lambda drive, angle: drive.bending_arm(angle),
        lambda state: state.N,
    ),
    _stress_column("sigma_bend", "σ_b", "Bending stress of the piston rod, by M_b", 0.0, 1.0),
    _stress_column(
        "sigma_rod",
        "σ_KS",
        "Stress of the piston rod on the side that M_b > 0 compresses, by P and M_b, compression positive",
        1.0,
        1.0,
    ),
    _stress_column("sigma_rod_other", "σ_KS2", "Stress of the piston rod on the other side, by P and M_b", 1.0, -1.0),
)


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

    name = "yoke-frame"
    guided = False
    OFFERS = (*SliderCrank.OFFERS, *BENDING_OFFERS)
    notes = ("There is no crosshead guide: the side force N bends the piston rod (R p. 614).",)

    def bending_arm(self, angle: CrankAngle) -> Number | None:
        """Return l_g + x in m, on which N bends the piston rod at the stuffing box; None where `gland` is not given.

        The rod is taken as held by this stuffing box alone, which is on the safe side.
        """
        return None if self.gland is None else self.gland + self.coordinate(angle)

    @property
    def lacks(self) -> tuple[tuple[str, str], ...]:
        """Name the bending of the piston rod, where its arm is not known."""
        return () if self.gland is not None else (("bending of the piston rod", "no gland given"),)
