"""Yoke-frame small crank drive (Klein, Schanzlin & Becker), R p. 614: a slider-crank without a crosshead guide.

Steam and pump piston rod lie in one line, joined by a frame in which rod and crank move. The motion is that of the
slider-crank; the side force N of the rod finds no guide and bends the piston rod.
"""

import math
from collections.abc import Iterator
from typing import Any, ClassVar

from kurbel.arrays import Number
from kurbel.crank_angle import CrankAngle
from kurbel.declared.record import Rule, field
from kurbel.mechanisms import Offer, finite, own_force
from kurbel.mechanisms.slider_crank import SliderCrank
from kurbel.numerics.arithmetic import some

_M_BEND = own_force(
    "M_bend",
    "M_b",
    "torque",
    "Bending moment of N on the piston rod at its stuffing box",
    called="bending moment of N on the piston rod",
)


_BENDING = own_force(
    "sigma_bend", "σ_b", "stress", "Bending stress of the piston rod by M_b", called="bending stress of the piston rod"
)
_PUSHED = own_force(
    "sigma_rod",
    "σ_KS",
    "stress",
    "Stress of the piston rod by P and M_b on the side that M_b > 0 compresses, compression positive",
    called="stress of the piston rod on the side that M_b > 0 compresses",
)
_PULLED = own_force(
    "sigma_rod_other",
    "σ_KS2",
    "stress",
    "The same on the other side",
    called="stress of the piston rod on the other side",
)


def _of_rod(state: Any, force: Any, factor: float, power: int) -> Any:
    """Return factor · force/(π d^power) by the piston rod at the crank end; None where there is none."""
    pistons = state.drive.cylinder.pistons
    if force is None or not pistons or not some(pistons[0].crank_end_rod != 0):
        return None
    return force * (factor / math.pi) / pistons[0].crank_end_rod ** power


def _fibre(state: Any, side: float) -> Any:
    """Return P/A + M_b/W on one side of the piston rod, or with the other sign on the other one."""
    arm = state.mechanism.bending_arm(state.posed)
    along, across = _of_rod(state, state.P, 4, 2), _of_rod(state, state.N, 32, 3)
    return None if along is None or across is None or arm is None else along + across * arm * side


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
        Offer(
            _BENDING, lambda drive, angle: drive.bending_arm(angle), force=lambda state: _of_rod(state, state.N, 32, 3)
        ),
        Offer(_PUSHED, lambda drive, angle: 1.0 + 0 * angle.sin, force=lambda state: _fibre(state, 1.0)),
        Offer(_PULLED, lambda drive, angle: 1.0 + 0 * angle.sin, force=lambda state: _fibre(state, -1.0)),
    )
    notes: ClassVar[tuple[str, ...]] = (
        "There is no crosshead guide: the side force N bends the piston rod (R p. 614).",
    )

    def rules(self) -> Iterator[Rule]:
        yield from SliderCrank.rules(self)
        yield from finite(self, "gland")

    def bending_arm(self, angle: CrankAngle) -> Number | None:
        """Return l_g + x in m, on which N bends the piston rod at the stuffing box; None where `gland` is not given.

        The rod is taken as held by this stuffing box alone, which is on the safe side.
        """
        return None if self.gland is None else self.gland + self.coordinate(angle)

    @property
    def lacks(self) -> tuple[tuple[str, str], ...]:
        """Name the bending of the piston rod, where its arm is not known."""
        return () if self.gland is not None else (("bending of the piston rod", "no gland given"),)
