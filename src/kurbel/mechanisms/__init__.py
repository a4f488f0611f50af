"""The mechanisms of the book behind one interface: the output coordinate and its first two derivatives by crank angle.

A mechanism is one file with one class, named in `kurbel.mechanisms.kinds`. The formulas work on whatever numbers the
crank angle has. `Mechanism` lists what a new one must supply.
"""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property, partial, reduce
from operator import mul
from typing import Any, ClassVar, NamedTuple

import numpy as np

from kurbel.arrays import Array, Number
from kurbel.crank_angle import CrankAngle
from kurbel.declared.record import Record, Rule, field
from kurbel.errors import UsageError
from kurbel.numerics.arithmetic import sqrt
from kurbel.numerics.extreme import Extreme
from kurbel.numerics.roots import bracketed_roots
from kurbel.quantity import Quantity


@dataclass(frozen=True, eq=False)
class Offer:
    """A column that only some mechanisms have, with its formula.

    factor: takes the mechanism and a crank angle and returns the value in SI over what it is proportional to, of the
    shape of the angle, or None where it is not known. It is proportional to ω to the power `omega`, and to what `force`
    takes of the state: `P`, `along_rod` (P less friction), `N`, or the moment `M_out` on what swings. unless: takes the
    results of the command; where it is true, the column says nothing new there.
    """

    quantity: Quantity
    factor: Callable[[Any, CrankAngle], Any]
    omega: int = 0
    force: Callable[[Any], Any] | None = None
    unless: Callable[[Any], bool] | None = None

    def of(self, state: Any) -> Any:
        """Return the column of the state of a cylinder at crank angles (n,) in SI; None where it is not known."""
        given = [state.omega] * self.omega + ([self.force(state)] if self.force else [])
        factor = self.factor(state.mechanism, state.posed)
        return None if factor is None or any(one is None for one in given) else reduce(mul, given, 1.0) * factor


own_motion = partial(Quantity, commands=("motion",), after="b")
"""Declares a column that a mechanism adds to `kurbel motion`."""
own_force = partial(Quantity, commands=("forces",), extremes=("forces",), after="N")
"""Declares a column that a mechanism adds to `kurbel forces`, with extremes, of which `called` says what they are."""
on_request = partial(Quantity, commands=("motion", "forces"), on_request=("motion", "forces"))
"""Declares a column that a mechanism adds to both, printed on request, after the column named by `after`."""


@dataclass(frozen=True, eq=False)
class KeyOffer:
    """A key value that only some mechanisms have, with its formula.

    value: takes the mechanism and the results of its command, and returns a number in SI, an Extreme, or None.
    bound: largest value that the sources permit, in SI; a larger one gives a warning.
    """

    quantity: Quantity
    value: Callable[[Any, Any], Any]
    bound: float | None = None

    def of(self, results: Any) -> Any:
        """Return the key value from the results of its command, which have the mechanism."""
        return self.value(results.mechanism, results)


class Turning(NamedTuple):
    """How a member of a mechanism turns: its angle in degrees, and dθ/dφ and d²θ/dφ², each shaped as the crank angle.

    A connecting rod or coupler counts its angle τ as φ counts, from the crank pin toward its other pin.
    """

    degrees: Number
    slope: Number
    curvature: Number


class PointMotion(NamedTuple):
    """Place in m of a point from the shaft axis: x along φ = 0, y along φ = 90°; |dr/dφ| and |d²r/dφ²|, in m."""

    x: Number
    y: Number
    speed: Number
    acceleration: Number


Point = tuple[Any, Any]
"""Place in m from the shaft, along φ = 0 and along φ = 90°; each a number, or shaped as the angle."""
SHAFT, PIN = "shaft", "pin"


@dataclass(frozen=True, eq=False)
class Sketch:
    """What is drawn of a mechanism at crank angles, to scale.

    joints: places by name, the shaft and the crank pin among them; links: stiff members, each the joints it runs
    through; blocks: joints that slide along a link; fixed: joints on the frame; guides: lines on the frame on which
    the output slides. output: the joint at which P acts; toward: the direction in which P counts positive, and `across`
    that in which the output presses on its guide where N is positive; of what only swings, None.
    """

    joints: dict[str, Point]
    links: tuple[tuple[str, ...], ...]
    fixed: tuple[str, ...]
    blocks: tuple[tuple[str, tuple[str, str]], ...] = ()
    guides: tuple[tuple[Point, Point], ...] = ()
    output: str = ""
    toward: Point | None = None
    across: Point | None = None


class Mechanism(Record):
    """What every mechanism supplies. It serves forces, work and torque through these alone:

    1. `name`, the word in the machine file, fields that are its keys there, and its geometric rules;
       `crank`, the radius that T is referred to;
    2. `coordinate`, `slope`, `curvature`: q, dq/dφ and d²q/dφ² at a crank angle, pointwise, so that c = q′ω, b = q″ω²
       and torque = P q′. q is a length in m where the output `slides`, an angle in radians where it only swings. It
       rises from `start` at the inner dead centre (0 unless the book counts otherwise) by `stroke`, in the same unit;
    3. `dead_centres` in degrees, the end of the outstroke after its beginning.

    A class without one of these is refused. All else has a default here that a mechanism may override:
    `crank_angles_at`, the inverse of `coordinate`; the connecting rod, the radial force; `sketch`,
    what is drawn of it; `lacks` and `notes`. What only some mechanisms have (a swinging lever, a sliding block, a
    coupler) they add as columns in OFFERS and key values in KEY_OFFERS. No other module tests for the class of a
    mechanism.
    """

    name: ClassVar[str]
    OFFERS: ClassVar[tuple[Offer, ...]] = ()
    KEY_OFFERS: ClassVar[tuple[KeyOffer, ...]] = ()
    guided: ClassVar[bool] = True
    """Whether the side force N rests on a guide; otherwise it bends the piston rod."""
    has_rod: ClassVar[bool] = False
    """Whether there is a connecting rod on the crank, with rod force S and side force N."""
    far_pin: ClassVar[str] = "crosshead_pin"
    """What the pin of the connecting rod or coupler that is not on the crank is called."""
    known_across: ClassVar[bool] = False
    """Whether, without a connecting rod, nothing but its weight pushes the output across the stroke line onto N."""
    # what follows may depend on the lengths: then a property takes its place
    slides: ClassVar[Any] = True
    """Whether the output moves to and fro on a line."""
    turns: ClassVar[Any] = False
    """Whether the output turns on and on, so that it has no return stroke."""
    has_dead_centres: ClassVar[Any] = True
    """Whether there are dead centres; otherwise `dead_centres` only part a turn into halves."""
    quick_return: ClassVar[Any] = False
    """Whether it is built for a slow working and a quick return stroke, and has key values by these names."""
    works_outward: ClassVar[Any] = True
    """Whether the outstroke is the working stroke; otherwise the return stroke is."""
    stroke: ClassVar[Any]
    """Stroke in m; of what only swings, its swing in radians."""
    start: ClassVar[Any] = 0.0
    """The coordinate at the inner dead centre."""
    notes: ClassVar[Any] = ()
    """What a reader of the results should know about this mechanism, each in one sentence."""
    lacks: ClassVar[Any] = ()
    """Results that need further keys of the file, each with the reason why it is missing: (what, why)."""
    crank: float

    def __init_subclass__(cls) -> None:
        super().__init_subclass__()
        own = [one for one in cls.__mro__ if issubclass(one, Mechanism) and one is not Mechanism]
        given = {name for one in own for name in (*vars(one), *getattr(one, "__annotations__", ()))}
        required = ("name", "crank", "stroke", "dead_centres", "coordinate", "slope", "curvature")
        missing = [name for name in required if name not in given]
        if missing:
            raise UsageError(f"mechanism {cls.__name__} does not define {', '.join(missing)}")

    @property
    def offset(self) -> float:
        """Distance in m of the stroke line from the shaft, positive toward the side of the outstroke."""
        return 0.0

    def coordinate(self, angle: CrankAngle) -> Number:
        """Return q at the crank angle, in m (or rad), of the shape of the angle."""
        raise NotImplementedError

    def slope(self, angle: CrankAngle) -> Number:
        """Return dq/dφ in m (or rad) per radian."""
        raise NotImplementedError

    def curvature(self, angle: CrankAngle) -> Number:
        """Return d²q/dφ² in m (or rad) per radian squared."""
        raise NotImplementedError

    def dead_centres(self) -> tuple[float, float]:
        """Return inner and outer dead centre in degrees; the outstroke runs from the first to the second."""
        raise NotImplementedError

    def crank_angles_at(self, displacement: Array, outstroke: bool) -> Array:
        """Return the crank angles in degrees where q − start (n,), from 0 to the stroke, is passed on that stroke.

        Here by search between the dead centres, to the rounding of `coordinate`.
        """
        passed = np.asarray(displacement, dtype=float)
        inner, outer = (np.full_like(passed, degrees) for degrees in self.dead_centres())
        ends = (inner, -passed), (outer, np.asarray(self.stroke - passed))
        (low, f_low), (high, f_high) = ends if outstroke else (ends[1], (inner + 360.0, -passed))

        def left(degrees: Array) -> tuple[Array, Array]:
            angle = CrankAngle.of(degrees)
            over = np.asarray(self.coordinate(angle) - self.start - passed)
            return over, np.asarray(self.slope(angle) * (np.pi / 180))

        found = bracketed_roots(left, low, high, f_low, f_high)
        # near a dead centre the rounding of the coordinate leaves 1e-6 degrees open
        return np.where(f_low == 0, low, np.where(f_high == 0, high, found))

    def remaining(self, angle: CrankAngle) -> Number:
        """Return what is left of the stroke to the outer dead centre, s − (q − start), in m (or rad)."""
        left: Number = self.stroke - (self.coordinate(angle) - self.start)
        return left

    @property
    def phi_work(self) -> float:
        """Crank rotation of the outstroke, or of the working stroke, in degrees."""
        inner, outer = self.dead_centres()
        return outer - inner

    @property
    def phi_return(self) -> float:
        """Crank rotation during the return stroke in degrees."""
        return 360.0 - self.phi_work

    @property
    def time_ratio(self) -> float:
        """Time ratio of the outstroke (working stroke) to the return stroke, at uniform rotation."""
        return self.phi_work / self.phi_return

    def rod_angle(self, angle: CrankAngle) -> tuple[Number, Number] | None:
        """Return (sin ψ, cos ψ) of the connecting rod, or None where there is none."""
        return None

    @property
    def rod_length(self) -> float:
        """Length L in m of the connecting rod on the crank; infinite where there is none."""
        return math.inf

    @property
    def coupler_length(self) -> float:
        """Length in m of the connecting rod or coupler on the crank pin; infinite where there is none."""
        return self.rod_length

    def coupler_at(self, angle: CrankAngle) -> Turning | None:
        """Return how the connecting rod or coupler on the crank pin lies and turns, or None where there is none."""
        return None

    def point_at(self, angle: CrankAngle, along: float, across: float) -> PointMotion | None:
        """Return the motion of a point of the rod or coupler, or None where there is none.

        It is `along` from the crank pin toward the other pin and `across` to the left of that, in m: at
        r = R e^{iφ} + (along + i across) e^{iτ}.
        """
        coupler, R = self.coupler_at(angle), self.crank
        if coupler is None:
            return None
        turned = CrankAngle.of(coupler.degrees)
        x, y = turned.cos * along - turned.sin * across, turned.sin * along + turned.cos * across
        turn, bend = coupler.slope, coupler.curvature
        speed = -R * angle.sin - y * turn, R * angle.cos + x * turn
        acceleration = (
            -R * angle.cos - y * bend - x * turn * turn,
            -R * angle.sin + x * bend - y * turn * turn,
        )
        sizes = (sqrt(one * one + other * other) for one, other in (speed, acceleration))
        return PointMotion(R * angle.cos + x, R * angle.sin + y, *sizes)

    def sketch(self, angle: CrankAngle) -> Sketch | None:
        """Return what is drawn of the mechanism at the crank angle, or None where that cannot be drawn."""
        return None

    @cached_property
    def lam(self) -> float:
        """λ = R/L, 0 without a connecting rod."""
        return self.crank / self.rod_length

    def radial(self, angle: CrankAngle) -> Number | None:
        """Return D/P, the radial force at the crank pin (positive toward the shaft) over the force at the output."""
        return None


def finite(record: Record, *names: str) -> Iterator[Rule]:
    """Yield the rule that these lengths are finite; what is not given is None."""
    for name in names:
        value = vars(record)[name]
        if value is not None:
            yield Rule(name, np.logical_not(np.isfinite(value)), "must be finite")


def on_circle(radius: Number, cos: Number, sin: Number, centre: Point = (0.0, 0.0)) -> Point:
    """Return the point of a circle in a direction."""
    return centre[0] + radius * cos, centre[1] + radius * sin


# columns and key values that several mechanisms have: of a swinging member, a block on the crank pin, a coupler

_BOTH, _MEMBER = ("motion", "forces"), "of the swinging member"


def _slides(results: Any) -> bool:
    """Return whether x gives the position of what slides, in forces."""
    return results.command == "forces" and bool(results.mechanism.slides)


def _swing(id: str, symbol: str, kind: str, text: str, called: str = "") -> Quantity:
    searched = ("motion",) if called else ()
    return Quantity(id, symbol, kind, f"{text} {_MEMBER}", "", _BOTH, searched, called, after="b")


SWING_OFFERS = (
    Offer(_swing("theta", "θ", "angle", "Angle"), lambda one, angle: one.swing_at(angle).degrees, unless=_slides),
    Offer(
        _swing("theta_dot", "θ̇", "angular_velocity", "Angular velocity", "angular velocity of the swing"),
        lambda one, angle: one.swing_at(angle).slope,
        omega=1,
        unless=_slides,
    ),
    Offer(
        _swing("theta_ddot", "θ̈", "angular_acceleration", "Angular acceleration", "angular acceleration"),
        lambda one, angle: one.swing_at(angle).curvature,
        omega=2,
        unless=_slides,
    ),
)
"""Of a mechanism with `swing_at`, which returns how its swinging member turns."""


def _ends(mechanism: Any) -> list[Extreme]:
    """θ in degrees at the dead centres; where the member turns fully, none."""
    centres = mechanism.dead_centres() if mechanism.swing is not None else ()
    return [Extreme(float(mechanism.swing_at(CrankAngle.of(end)).degrees), end % 360.0) for end in centres]


SWING_VALUES = (
    KeyOffer(
        Quantity("swing", "θ_s", "angle", "Angle through which the member swings", "", _BOTH, after="stroke"),
        lambda one, _: one.swing,
    ),
    KeyOffer(
        Quantity("theta_min", "θ_min", "angle", f"Smallest angle {_MEMBER}", "", _BOTH, after="stroke"),
        lambda one, _: min(_ends(one), default=None),
    ),
    KeyOffer(
        Quantity("theta_max", "θ_max", "angle", f"Largest angle {_MEMBER}", "", _BOTH, after="stroke"),
        lambda one, _: max(_ends(one), default=None),
    ),
)
"""Of a mechanism with `swing_at`, and a `swing` in degrees, None where the member turns fully."""

F_COUPLER = Offer(
    own_force(
        "F_coupler",
        "F_K",
        "force",
        "Force in the coupler, thrust positive",
        called="force in the coupler",
        after="M_out",
    ),
    lambda one, angle: one.coupler_force_factor(angle),
    force=lambda state: state.M_out,
)
"""Of a mechanism with `coupler_force_factor`, the force in 1/m over the moment on the swinging member."""


def pin_diameter() -> Any:
    """Return the field of the diameter of the crank pin."""
    text = "Diameter of the crank pin; needs `pin_length`"
    return field("length", text, "d_z", above=0, absent="no pin pressure", needs="pin_length")


def pin_length() -> Any:
    """Return the field of the length of the crank pin."""
    text = "Length of the crank pin in its block; needs `pin_diameter`"
    return field("length", text, "l_z", above=0, absent="same", needs="pin_diameter")


NO_PIN = ("pin pressure", "no pin_diameter and pin_length given")
"""What a mechanism with a block lacks without its pin, and why."""


BLOCK_OFFERS = (
    Offer(
        own_motion("c_block", "c_b", "velocity", "Sliding speed of the crank-pin block along its slot"),
        lambda one, angle: one.block_slope(angle),
        omega=1,
    ),
    Offer(
        own_force(
            "F_pin",
            "F_z",
            "force",
            "Force of the sliding block on the crank pin, positive in the direction of P",
            called="force of the sliding block on the crank pin",
        ),
        lambda one, angle: one.pin_force_factor(angle),
        force=lambda state: state.along_rod,
    ),
)
"""Of a mechanism with `block_slope`, the speed of the block over ω in m, and `pin_force_factor`, its force over P."""


def pin_pressure(bound: float | None = None) -> KeyOffer:
    """Return the pressure between pin and block; bound: in Pa, up to which the sources let such a pin go."""

    def largest(mechanism: Any, forces: Any) -> Extreme | None:
        found = None if mechanism.pin_diameter is None else forces.extremes_of("F_pin")
        if not found:
            return None
        return Extreme(found.peak.value / (mechanism.pin_diameter * mechanism.pin_length), found.peak.degrees)

    text = "Largest pressure of the sliding block on the crank pin"
    return KeyOffer(Quantity("pin_pressure", "p_z", "pressure", text, "", ("forces",), after="T_min"), largest, bound)
