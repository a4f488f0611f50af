"""The mechanisms of the book behind one interface: the output coordinate and its first two derivatives by crank angle.

A mechanism is one file with one class, named in `kurbel.mechanisms.kinds`. The formulas work on whatever numbers the
crank angle has. `Mechanism` lists what a new one must supply.
"""

import math
from abc import ABC, abstractmethod
from collections.abc import Callable
from functools import cached_property
from typing import Any, ClassVar, NamedTuple

import numpy as np

from kurbel.arrays import Array, Number
from kurbel.crank_angle import CrankAngle, unit_vector
from kurbel.declared.record import FieldValue, Record, field
from kurbel.numerics.extreme import Extreme
from kurbel.numerics.search import bracketed_roots
from kurbel.quantity import Formula, Quantity, ResultCondition

ColumnFactor = Callable[[Any, CrankAngle], Any]
"""Takes a mechanism and a crank angle, and returns what the formula of a column has besides ω and a force."""


class Offer:
    """A column that only some mechanisms have, with its formula.

    factor: takes the mechanism and a crank angle and returns the value in SI over what it is proportional to, of the
    shape of the angle, or None where it is not known. It is proportional to ω to the power `omega`, and to what `force`
    takes of the state: `P`, `along_stroke` (P less friction), `N`, or the moment `M_out` on what swings. unless: takes the
    results of the command; where it is true, the column says nothing new there.
    """

    def __init__(
        self,
        quantity: Quantity,
        factor: ColumnFactor,
        omega: int = 0,
        force: Formula | None = None,
        unless: ResultCondition | None = None,
    ) -> None:
        self.quantity = quantity
        self.factor = factor
        self.omega = omega
        self.force = force
        self.unless = unless

    def of(self, state: Any) -> Array | None:
        """Return the column of the state of a cylinder at crank angles (n,) in SI; None where it is not known."""
        factors = [self.factor(state.mechanism, state.posed), *[state.omega] * self.omega]
        if self.force:
            factors.append(self.force(state))
        if any(factor is None for factor in factors):
            return None
        return math.prod(factors)


def motion_column(
    id: str, symbol: str, kind: str, text: str, factor: ColumnFactor, omega: int = 0
) -> Offer:
    """Return a column that a mechanism adds to `kurbel motion`."""
    return Offer(Quantity(id, symbol, kind, text, commands=("motion",), after="b"), factor, omega)


def force_column(
    id: str,
    symbol: str,
    kind: str,
    text: str,
    factor: ColumnFactor,
    force: Formula,
    after: str = "N",
) -> Offer:
    """Return a column that a mechanism adds to `kurbel forces`, with extremes, called as the sentence begins."""
    called = text[0].lower() + text[1:].partition(",")[0]
    forces = ("forces",)
    return Offer(
        Quantity(id, symbol, kind, text, "", forces, forces, called, after), factor, force=force
    )


def requested_column(
    id: str,
    symbol: str,
    kind: str,
    text: str,
    factor: ColumnFactor,
    after: str,
    omega: int = 0,
    plain: str = "",
) -> Offer:
    """Return a column that a mechanism adds to both, printed on request."""
    commands = ("motion", "forces")
    return Offer(
        Quantity(id, symbol, kind, text, plain, commands, after=after, on_request=commands),
        factor,
        omega,
    )


class KeyOffer:
    """A key value that only some mechanisms have, with its formula.

    value: takes the mechanism and the results of its command, and returns a number in SI, an Extreme, or None.
    bound: largest value that the sources permit, in SI; a larger one gives a warning.
    """

    def __init__(
        self, quantity: Quantity, value: Callable[[Any, Any], Any], bound: float | None = None
    ) -> None:
        self.quantity = quantity
        self.value = value
        self.bound = bound

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


Position = tuple[Any, Any]
"""Place in m from the shaft, along φ = 0 and along φ = 90°; each a number, or shaped as the angle."""
SHAFT, PIN = "shaft", "pin"


class Sketch(NamedTuple):
    """What is drawn of a mechanism at crank angles, to scale.

    joints: places by name, the shaft and the crank pin among them; links: stiff members, each the joints it runs
    through; blocks: joints that slide along a link; fixed: joints on the frame; guides: lines on the frame on which
    the output slides. output: the joint at which P acts; toward: the direction in which P counts positive, and `across`
    that in which the output presses on its guide where N is positive; of what only swings, None.
    """

    joints: dict[str, Position]
    links: tuple[tuple[str, ...], ...]
    fixed: tuple[str, ...]
    blocks: tuple[tuple[str, tuple[str, str]], ...] = ()
    guides: tuple[tuple[Position, Position], ...] = ()
    output: str = ""
    toward: Position | None = None
    across: Position | None = None

    @classmethod
    def of_crank(
        cls,
        radius: float,
        angle: CrankAngle,
        joints: dict[str, Position],
        *links: tuple[str, ...],
        **more: Any,
    ) -> "Sketch":
        """Return the sketch of a crank with what else is given; fixed: joints on the frame besides the shaft."""
        pin = on_circle(radius, angle.cos, angle.sin)
        fixed = (SHAFT, *more.pop("fixed", ()))
        return cls({SHAFT: (0.0, 0.0), PIN: pin, **joints}, ((SHAFT, PIN), *links), fixed, **more)


class RamLever(NamedTuple):
    """A slotted lever whose end moves a ram: radius of the crank, distance of its pivot, and its length, in m."""

    crank: float
    frame: float
    length: float


class Mechanism(Record, ABC):
    """What every mechanism supplies. It serves forces, work and torque through these alone:

    1. `name`, the word in the machine file, fields that are its keys there, and its geometric rules;
       `crank`, the radius that T is referred to;
    2. `coordinate`, `slope`, `curvature`: q, dq/dφ and d²q/dφ² at a crank angle, pointwise, so that c = q′ω, b = q″ω²
       and torque = P q′. q is a length in m where the output `slides`, an angle in radians where it only swings. It
       rises from `start` at the inner dead centre (0 unless the book counts otherwise) by `stroke`, in the same unit;
    3. `dead_centres` in degrees, the end of the outstroke after its beginning.

    A class without one of these methods cannot be instantiated. All else has a default here that a mechanism may
    override: `crank_angles_at`, the inverse of `coordinate`; the connecting rod, the radial force; `sketch`, what is
    drawn of it; `lacks` and `notes`. What only some mechanisms have (a swinging lever, a sliding block, a
    coupler) they add as columns in OFFERS and key values in KEY_OFFERS. No other module tests for the class of a
    mechanism, but for the references of `kurbel accuracy`, which have other formulas for each.
    """

    name: ClassVar[str]
    OFFERS: ClassVar[tuple[Offer, ...]] = ()
    KEY_OFFERS: ClassVar[tuple[KeyOffer, ...]] = ()
    rubs: ClassVar[bool] = False
    """Whether a block on the crank pin and two guides may rub, as those of a Scotch yoke."""
    swings_cylinder: ClassVar[bool] = False
    """Whether the cylinder swings with its piston, so that neither masses nor weight are known from the piston."""
    guided: ClassVar[bool] = True
    """Whether the side force N rests on a guide; otherwise it bends the piston rod."""
    is_crank_drive: ClassVar[bool] = False
    """Whether the crank pin moves the output itself, or through one connecting rod."""
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

    @property
    def offset(self) -> float:
        """Distance in m of the stroke line from the shaft, positive toward the side of the outstroke."""
        return 0.0

    @property
    def rubbing_pin(self) -> float | None:
        """Diameter in m of the crank pin that rubs in a block; None where there is none, or it is not given."""
        return None

    @property
    def guide_distance(self) -> float | None:
        """Distance in m of the two guides that keep a yoke from tilting; None where there are none, or not given."""
        return None

    def guide_pair_factor(self, angle: CrankAngle) -> Number | None:
        """Return the force on each of two such guides over P, of the shape of the angle; None without them."""
        return None

    @property
    def ram_lever(self) -> RamLever | None:
        """The slotted lever whose end moves the ram without a link; None where there is none."""
        return None

    @abstractmethod
    def coordinate(self, angle: CrankAngle) -> Number:
        """Return q at the crank angle, in m (or rad), of the shape of the angle."""

    @abstractmethod
    def slope(self, angle: CrankAngle) -> Number:
        """Return dq/dφ in m (or rad) per radian."""

    @abstractmethod
    def curvature(self, angle: CrankAngle) -> Number:
        """Return d²q/dφ² in m (or rad) per radian squared."""

    @abstractmethod
    def dead_centres(self) -> tuple[float, float]:
        """Return inner and outer dead centre in degrees; the outstroke runs from the first to the second."""

    def swing_ends(self) -> tuple[float, float]:
        """Return the crank angles in degrees at which a swinging member turns back; here the dead centres."""
        return self.dead_centres()

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

        root = bracketed_roots(left, low, high, f_low, f_high)
        # near a dead centre the rounding of the coordinate leaves 1e-6 degrees open
        return np.where(f_low == 0, low, np.where(f_high == 0, high, root))

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
        pin = R * (angle.cos + 1j * angle.sin)
        arm = (along + 1j * across) * unit_vector(coupler.degrees)
        position, acceleration = pin + arm, arm * (1j * coupler.curvature - coupler.slope**2) - pin
        return PointMotion(
            position.real, position.imag, abs(pin + arm * coupler.slope), abs(acceleration)
        )

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


def on_circle(radius: Number, cos: Number, sin: Number, centre: Position = (0.0, 0.0)) -> Position:
    """Return the point of a circle in a direction."""
    return centre[0] + radius * cos, centre[1] + radius * sin


# columns and key values that several mechanisms have: of a swinging member, a block on the crank pin, a coupler

_BOTH = ("motion", "forces")
TURNING = (
    ("", "", "angle", "Angle"),
    ("_dot", "\u0307", "angular_velocity", "Angular velocity"),
    ("_ddot", "\u0308", "angular_acceleration", "Angular acceleration"),
)
"""How a member turns, by derivatives: end of the id, mark on the symbol, kind, and name."""


def _swing(order: int) -> Offer:
    end, mark, kind, name = TURNING[order]
    searched, called = (("motion",), f"{name.lower()} of the swing") if order else ((), "")
    text = f"{name} of the swinging member"
    quantity = Quantity(
        f"theta{end}", f"θ{mark}", kind, text, "", _BOTH, searched, called, after="b"
    )
    return Offer(
        quantity,
        lambda mechanism, angle: mechanism.swing_at(angle)[order],
        order,
        # in forces x gives the position of what slides
        unless=lambda results: results.command == "forces" and bool(results.mechanism.slides),
    )


SWING_OFFERS = (_swing(0), _swing(1), _swing(2))
"""Of a mechanism with `swing_at`, which returns how its swinging member turns."""


def _ends(mechanism: Any) -> list[Extreme]:
    """θ in degrees where the member turns back; where it turns fully, none."""
    ends = mechanism.swing_ends() if mechanism.swing is not None else ()
    return [
        Extreme(float(mechanism.swing_at(CrankAngle.of(end)).degrees), end % 360.0) for end in ends
    ]


SWING_VALUES = (
    KeyOffer(
        Quantity(
            "swing",
            "θ_s",
            "angle",
            "Angle through which the member swings",
            "",
            _BOTH,
            after="stroke",
        ),
        lambda mechanism, _: mechanism.swing,
    ),
    KeyOffer(
        Quantity(
            "theta_min",
            "θ_min",
            "angle",
            "Smallest angle of the swinging member",
            "",
            _BOTH,
            after="stroke",
        ),
        lambda mechanism, _: min(_ends(mechanism), default=None),
    ),
    KeyOffer(
        Quantity(
            "theta_max",
            "θ_max",
            "angle",
            "Largest angle of the swinging member",
            "",
            _BOTH,
            after="stroke",
        ),
        lambda mechanism, _: max(_ends(mechanism), default=None),
    ),
)
"""Of a mechanism with `swing_at`, and a `swing` in degrees, None where the member turns fully."""

F_COUPLER = force_column(
    "F_coupler",
    "F_K",
    "force",
    "Force in the coupler, thrust positive",
    lambda mechanism, angle: mechanism.coupler_force_factor(angle),
    lambda state: state.M_out,
    after="M_out",
)
"""Of a mechanism with `coupler_force_factor`, the force in 1/m over the moment on the swinging member."""


def pin_diameter() -> FieldValue:
    """Return the field of the diameter of the crank pin."""
    text = "Diameter of the crank pin; needs `pin_length`"
    return field("length", text, "d_z", above=0, absent="no pin pressure", needs="pin_length")


def pin_length() -> FieldValue:
    """Return the field of the length of the crank pin."""
    text = "Length of the crank pin in its block; needs `pin_diameter`"
    return field("length", text, "l_z", above=0, absent="no pin pressure", needs="pin_diameter")


NO_PIN = ("pin pressure", "no pin_diameter and pin_length given")
"""What a mechanism with a block lacks without its pin, and why."""


def pin_force(factor: ColumnFactor) -> Offer:
    """Return the force on a crank pin that carries no connecting rod; factor: over P less friction."""
    text = "Force of the sliding block or rod on the crank pin, positive in the direction of P"
    return force_column("F_pin", "F_z", "force", text, factor, lambda state: state.along_stroke)


BLOCK_OFFERS = (
    motion_column(
        "c_block",
        "c_b",
        "velocity",
        "Sliding speed of the crank-pin block along its slot",
        lambda mechanism, angle: mechanism.block_slope(angle),
        omega=1,
    ),
    pin_force(lambda mechanism, angle: mechanism.pin_force_factor(angle)),
)
"""Of a mechanism with `block_slope`, the speed of the block over ω in m, and `pin_force_factor`, its force over P."""


def pin_pressure_offer(bound: float | None = None) -> KeyOffer:
    """Return the offer of the key value `pin_pressure`, F_pin/(d l) between pin and block (R p. 615).

    bound: in Pa, up to which the sources let such a pin go.
    """

    def largest(mechanism: Any, forces: Any) -> Extreme | None:
        if mechanism.pin_diameter is None:
            return None
        extremes = forces.extremes_of("F_pin")
        if not extremes:
            return None
        area = mechanism.pin_diameter * mechanism.pin_length
        return Extreme(extremes.peak.value / area, extremes.peak.degrees)

    text = "Largest pressure of the sliding block on the crank pin"
    return KeyOffer(
        Quantity("pin_pressure", "p_z", "pressure", text, "", ("forces",), after="T_min"),
        largest,
        bound,
    )
