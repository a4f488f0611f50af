"""The mechanisms of the book behind one interface: the output coordinate and its first two derivatives by crank angle.

A mechanism is one file with one class, and one line in `MECHANISMS`. None imports numpy: the formulas work on whatever
the crank angle is made of. What a new mechanism must supply stands in `Mechanism`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple

from kurbel.errors import Fault, RuleError
from kurbel.keys import Keys, Record

if TYPE_CHECKING:
    from kurbel.crank_angle import CrankAngle

MECHANISMS = {
    "slider-crank": Record("kurbel.mechanisms.slider_crank:SliderCrank"),
    "scotch-yoke": Record("kurbel.mechanisms.scotch_yoke:ScotchYoke"),
    "slotted-lever": Record("kurbel.mechanisms.slotted_lever:SlottedLever"),
    "four-bar": Record("kurbel.mechanisms.four_bar:FourBar"),
    "parallel-crank": Record("kurbel.mechanisms.parallel_crank:ParallelCrank"),
    "yoke-frame": Record("kurbel.mechanisms.yoke_frame:YokeFrame"),
}
"""Word in the machine file -> class; imported only when a machine names it."""


class Extreme(NamedTuple):
    """A value and the crank angle in degrees at which it stands."""

    value: float
    degrees: float


class Swing(NamedTuple):
    """The swinging member at a crank angle: θ in degrees, dθ/dφ and d²θ/dφ² (radian per radian), each as the angle."""

    degrees: Any
    slope: Any
    curvature: Any


class Mechanism:
    """What every mechanism supplies. It serves forces, work and torque through these alone:

    1. `KEYS`, its keys in the machine file, and its geometric rules, raised as RuleError at birth;
    2. `coordinate`, `slope`, `curvature`: q, dq/dφ and d²q/dφ² at a crank angle, pointwise, so that c = q′ω, b = q″ω²
       and torque = P q′. q is a length in m where the output slides, an angle in radians where it only swings. It
       rises from `start` at the inner dead centre (0 unless the book counts otherwise) by `stroke`;
    3. `slides` and `swings`: whether it has a path (columns x, c, b, and a place where a force acts) and a swinging
       member (columns theta, theta_dot, theta_ddot, from `swing_at`). The slotted lever has both;
    4. `dead_centres` in degrees, the end of the outstroke after its beginning;
    5. `crank_angles_at`: the inverse of `coordinate` on the outstroke or the return stroke;
    6. `landmarks`: crank angles in degrees at which its functions bend sharply; searches and quadratures split there.

    It may offer more: `rod_angle` (a connecting rod with S, N, D), closed extremes, transmission angles, `notes`.
    """

    KEYS: ClassVar[Keys]
    name: ClassVar[str]
    slides: ClassVar[bool] = True
    swings: ClassVar[bool] = False
    quick_return: ClassVar[bool] = False
    """Whether its strokes are named working and return stroke (phi_work, c_work_max …) rather than by dead centres."""
    guided: ClassVar[bool] = True
    """Whether the side force N rests on a guide; otherwise it bends the piston rod."""
    crank: float

    @property
    def stroke(self) -> float:
        """Stroke in m; of what only swings, its swing in radians."""
        raise AssertionError

    @property
    def start(self) -> float:
        """The coordinate at the inner dead centre."""
        return 0.0

    @property
    def swing(self) -> float | None:
        """The angle in degrees through which the member swings; None where nothing swings, or it turns fully."""
        return None

    def coordinate(self, angle: CrankAngle) -> Any:
        """Return q at the crank angle, in m (or rad), of the shape of the angle."""
        raise AssertionError

    def slope(self, angle: CrankAngle) -> Any:
        """Return dq/dφ in m (or rad) per radian."""
        raise AssertionError

    def curvature(self, angle: CrankAngle) -> Any:
        """Return d²q/dφ² in m (or rad) per radian squared."""
        raise AssertionError

    def dead_centres(self) -> tuple[float, float]:
        """Return inner and outer dead centre in degrees; the outstroke runs from the first to the second."""
        raise AssertionError

    def crank_angles_at(self, displacement: Any, outstroke: bool) -> Any:
        """Return the crank angles in degrees where q − start (n,), from 0 to the stroke, is passed on that stroke."""
        raise AssertionError

    def landmarks(self) -> tuple[float, ...]:
        """Return the crank angles in degrees, besides the dead centres, at which searches should split."""
        return ()

    @property
    def phi_work(self) -> float:
        """Crank rotation of the outstroke, or of the working stroke, in degrees."""
        inner, outer = self.dead_centres()
        return outer - inner

    @property
    def phi_return(self) -> float:
        """Crank rotation of the return stroke in degrees."""
        return 360.0 - self.phi_work

    @property
    def time_ratio(self) -> float:
        """Time of the outstroke (working stroke) over that of the return stroke, at uniform rotation."""
        return self.phi_work / self.phi_return

    def swing_at(self, angle: CrankAngle) -> Swing | None:
        """Return the swinging member at the crank angle, or None where there is none."""
        return None

    def rod_angle(self, angle: CrankAngle) -> tuple[Any, Any] | None:
        """Return (sin ψ, cos ψ) of the connecting rod, or None where there is none."""
        return None

    def velocity_extremes(self) -> tuple[Extreme, ...]:
        """Return closed extremes of `slope`, where there are any; otherwise they are searched."""
        return ()

    def acceleration_extremes(self) -> tuple[Extreme, ...]:
        """Return closed extremes of `curvature`, where there are any; otherwise they are searched."""
        return ()

    def swing_extremes(self) -> tuple[Extreme, ...]:
        """Return closed extremes of dθ/dφ, where there are any; otherwise they are searched."""
        return ()

    @property
    def transmission(self) -> tuple[Extreme, Extreme] | None:
        """Smallest and largest transmission angle in degrees, or None where the word means nothing."""
        return None

    @property
    def notes(self) -> tuple[str, ...]:
        """What a reader of the results should know about this mechanism, each in one sentence."""
        return ()


def check_lengths(**lengths: float) -> None:
    """Raise RuleError for every length that is not positive and finite."""
    wrong = [name for name, value in lengths.items() if not 0 < value < float("inf")]
    faults = [Fault((name,), "must be a positive, finite length") for name in wrong]
    if faults:
        raise RuleError(*faults)


def fan(centre: float, width: float) -> tuple[float, ...]:
    """Return angles in degrees that stand ever wider on both sides of a bend of this half width (degrees) at `centre`.

    >>> fan(180.0, 10.0)
    (180.0, 170.0, 190.0, 150.0, 210.0)
    """
    angles = [centre]
    while 0 < width < 45:
        angles += [centre - width, centre + width]
        width *= 3
    return tuple(angles)
