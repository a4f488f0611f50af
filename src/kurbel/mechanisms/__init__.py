"""The mechanisms of the book behind one interface: the output coordinate and its first two derivatives by crank angle.

A mechanism is one file with one class, and one line in `MECHANISMS`. None imports numpy: the formulas work on whatever
the crank angle is made of. What a new mechanism must supply stands in `Mechanism`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple

from kurbel.declared.forms import Record
from kurbel.declared.keys import Described, Keys
from kurbel.errors import Fault, refuse
from kurbel.numerics.extreme import Extreme

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


class Swing(NamedTuple):
    """The swinging member at a crank angle: θ in degrees, dθ/dφ and d²θ/dφ² (radian per radian), each as the angle."""

    degrees: Any
    slope: Any
    curvature: Any


class Mechanism(Described):
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

    What else it has it offers by the methods below that answer None here: a connecting rod, a sliding block, a coupler,
    closed extremes, transmission angles, `notes`. Nobody asks for its class.
    """

    KEYS: ClassVar[Keys]
    name: ClassVar[str]
    slides: ClassVar[bool] = True
    swings: ClassVar[bool] = False
    quick_return: ClassVar[bool] = False
    """Whether it is built for a slow working and a quick return stroke, and has key values by these names."""
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

    def cuts(self) -> tuple[float, ...]:
        """Return the crank angles in degrees at which quadratures and searches cut a turn: dead centres, landmarks."""
        return (*self.dead_centres(), *self.landmarks())

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
    def works_outward(self) -> bool:
        """Whether the outstroke is the working stroke; otherwise the return stroke is."""
        return True

    @property
    def turns(self) -> bool:
        """Whether the output turns on and on, so that it has no return stroke."""
        return not self.slides and self.swing is None

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

    @property
    def has_rod(self) -> bool:
        """Whether there is a connecting rod on the crank, with rod force S and side force N."""
        from kurbel.crank_angle import CrankAngle

        return self.rod_angle(CrankAngle.of(0.0)) is not None

    @property
    def rod_length(self) -> float:
        """Length L in m of the connecting rod on the crank; infinite where there is none."""
        return float("inf")

    @property
    def lam(self) -> float:
        """λ = R/L, 0 without a connecting rod."""
        return self.crank / self.rod_length

    def radial(self, angle: CrankAngle) -> Any | None:
        """Return D/P, the radial force at the crank pin (positive toward the shaft) over the force at the output."""
        return None

    def block_slope(self, angle: CrankAngle) -> Any | None:
        """Return the speed over ω in m of the block that slides on the crank pin's guide, or None without one."""
        return None

    def pin_force_factor(self, angle: CrankAngle) -> Any | None:
        """Return the force of that block on the crank pin over P, or None without one."""
        return None

    @property
    def pin_area(self) -> float | None:
        """Projected area of the crank pin in m², or None where its size is not given."""
        return None

    @property
    def pin_pressure_bound(self) -> float | None:
        """Pressure in Pa up to which the sources let such a crank pin go, or None where they are silent."""
        return None

    def guide_pair_factor(self, angle: CrankAngle) -> Any | None:
        """Return the force over P on each of two guides that hold the output against tilting, or None."""
        return None

    def bending_arm(self, angle: CrankAngle) -> Any | None:
        """Return the arm in m on which N bends the piston rod, or None where it does not, or is not known."""
        return None

    def coupler_force_factor(self, angle: CrankAngle) -> Any | None:
        """Return the force in a coupler over the moment on the swinging member in 1/m, or None without one."""
        return None

    def coupler_path(self, angle: CrankAngle) -> tuple[Any, Any] | None:
        """Return the way (along, across) the frame in m of a coupler all of whose points move alike, or None."""
        return None

    def coupler_acceleration(self, angle: CrankAngle) -> tuple[Any, Any] | None:
        """Return its acceleration (along, across) the frame over ω² in m, or None."""
        return None

    @property
    def coupler_inertia(self) -> float | None:
        """Size over ω² in kg m of the inertia force of that coupler, or None where its mass is not given."""
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
    def lacks(self) -> tuple[tuple[str, str], ...]:
        """What could be said of forces with further keys, and the reason why it is not: (what, why)."""
        return ()

    @property
    def notes(self) -> tuple[str, ...]:
        """What a reader of the results should know about this mechanism, each in one sentence."""
        return ()


def check_lengths(**lengths: float) -> None:
    """Raise RuleError for every length that is not positive and finite."""
    wrong = [name for name, value in lengths.items() if not 0 < value < float("inf")]
    refuse(*(Fault((name,), "must be a positive, finite length") for name in wrong))


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
