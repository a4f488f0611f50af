"""Four-bar linkage: the crank-rocker (Bogenschubkurbel), R ch. 14 A, and the drag link, whose rocker turns too."""

import math
from dataclasses import dataclass
from functools import cached_property
from typing import Any, ClassVar

from kurbel.crank_angle import CrankAngle
from kurbel.declared.forms import positive
from kurbel.declared.keys import Keys
from kurbel.declared.unit_systems import show
from kurbel.errors import refused
from kurbel.mechanisms import KeyOffer, Mechanism, Offer, check_lengths, on_request
from kurbel.mechanisms.coupler import Coupler
from kurbel.mechanisms.four_bar_loop import Loop
from kurbel.mechanisms.sketch import PIN, SHAFT, Sketch, on_circle
from kurbel.mechanisms.swing import F_COUPLER, SWING_OFFERS, SWING_VALUES, Swing, turning_offers
from kurbel.numerics.arithmetic import bearing
from kurbel.numerics.extreme import Extreme
from kurbel.quantity import Quantity


def _transmission(id: str, end: str, text: str) -> KeyOffer:
    return KeyOffer(
        Quantity(id, f"μ_{end}", "angle", text, commands=("motion", "forces"), after="theta_ddot_min"),
        lambda four_bar, _: four_bar.transmission[0 if end == "min" else 1],
    )


def _coupler_column(end: str, symbol: str, kind: str, text: str) -> Quantity:
    id, plain = f"theta_coupler{end}", f"theta_K{end}"
    return on_request(id, symbol, kind, f"{text} of the coupler", plain, after="theta_ddot")


COUPLER_OFFERS = turning_offers(
    lambda one, at: one.coupler_at(at),
    _coupler_column("", "θ_K", "angle", "Angle, from the line crank pivot → rocker pivot,"),
    _coupler_column("_dot", "θ̇_K", "angular_velocity", "Angular velocity"),
    _coupler_column("_ddot", "θ̈_K", "angular_acceleration", "Angular acceleration"),
)


@dataclass(frozen=True, eq=False, repr=False)
class FourBar(Mechanism):
    """A crank that turns fully and through a coupler swings a rocker, or, where the frame is shortest, turns it too.

    crank, coupler, rocker, frame: a, b, c, d in m. φ and θ count from the line crank pivot → rocker pivot, with the
    coupler's joint on the side where the crank pin is for 0 < φ < 180°; that side holds for the whole turn. The working
    swing is the slower one. Raises RuleError unless crank or frame is the shortest link and together with the longest
    shorter than the other two (Grashof): no other crank turns fully.
    """

    crank: float
    coupler: float
    rocker: float
    frame: float

    name: ClassVar[str] = "four-bar"
    slides: ClassVar[bool] = False
    OFFERS: ClassVar[tuple[Offer, ...]] = (*SWING_OFFERS, *COUPLER_OFFERS, F_COUPLER)
    KEY_OFFERS: ClassVar[tuple[KeyOffer, ...]] = (
        *SWING_VALUES,
        _transmission("transmission_min", "min", "Smallest transmission angle"),
        _transmission("transmission_max", "max", "Largest transmission angle"),
    )
    far_pin: ClassVar[str] = "rocker_pin"
    KEYS: ClassVar[Keys] = {
        "crank": positive("length", "Crank radius", "a", required=True),
        "coupler": positive("length", "Length of the coupler", "b", required=True),
        "rocker": positive("length", "Length of the rocker", "c", required=True),
        "frame": positive("length", "Distance of the rocker's pivot from the shaft", "d", required=True),
    }

    def __post_init__(self) -> None:
        # among equals the crank comes first
        links = {name: float(getattr(self, name)) for name in ("crank", "frame", "coupler", "rocker")}
        check_lengths(**links)
        shortest, *others, longest = sorted(links, key=lambda name: links[name])
        gap = math.fsum((*(links[name] for name in others), -links[shortest], -links[longest]))
        # lengths that were written in decimals meet a change point only within their rounding
        rounding = 2 * math.ulp(links[longest])
        if gap <= rounding or shortest not in ("crank", "frame"):
            refused(self._locked(shortest, longest, gap, rounding), "crank")

    def _locked(self, shortest: str, longest: str, gap: float, rounding: float) -> str:
        def named(name: str) -> str:
            return f"{name} {show(getattr(self, name), 'length')}"

        rest = [name for name in self.KEYS if name != longest]
        pair = " + ".join(named(name) for name in rest if name != shortest)
        if math.fsum((*(getattr(self, name) for name in rest), -getattr(self, longest))) <= 0:
            sides = " + ".join(named(name) for name in rest)
            return f"the links do not meet: {named(longest)} is no shorter than {sides}"
        if shortest not in ("crank", "frame"):
            crank = show(self.crank, "length")
            return f"{crank} is longer than the {named(shortest)}; the crank or the frame must be the shortest link"
        sums = f"{named(shortest)} + {named(longest)}"
        if abs(gap) <= rounding:
            flat = "the linkage folds flat once a turn and may go on either way from there (change point)"
            return f"{flat}: {sums} = {pair}"
        return f"it cannot turn fully: {sums} is more than {pair} (Grashof)"

    @property
    def turns(self) -> bool:
        """Whether the rocker turns fully with the crank: the frame is the shortest link (drag link, double crank)."""
        return self.frame < self.crank

    @property
    def quick_return(self) -> bool:
        """Whether the rocker swings."""
        return not self.turns

    has_dead_centres = quick_return

    @cached_property
    def loop(self) -> Loop:
        """The four links over the frame."""
        return Loop.of(self.crank, self.coupler, self.rocker, self.frame)

    def coordinate(self, angle: CrankAngle) -> Any:
        """Return θ in radians; where it turns fully, it runs on with φ."""
        return self.swing_at(angle).degrees * (math.pi / 180)

    def slope(self, angle: CrankAngle) -> Any:
        """Return dθ/dφ, by loop closure."""
        return self.loop.at(angle).slope

    def curvature(self, angle: CrankAngle) -> Any:
        """Return d²θ/dφ², by loop closure."""
        return self.loop.at(angle).curvature

    def swing_at(self, angle: CrankAngle) -> Swing:
        """Return the rocker at the crank angle."""
        closure = self.loop.at(angle)
        degrees = closure.turned if self.turns else bearing(*closure.direction)
        return Swing(degrees, closure.slope, closure.curvature)

    @property
    def coupler_length(self) -> float:
        """b in m."""
        return self.coupler

    def sketch(self, angle: CrankAngle) -> Sketch:
        """Return crank, coupler and rocker."""
        sin, cos = self.loop.at(angle).direction
        pivot = (self.frame, 0.0)
        joints = {
            SHAFT: (0.0, 0.0),
            PIN: on_circle(self.crank, angle.cos, angle.sin),
            "rocker pin": on_circle(self.rocker, cos, sin, pivot),
            "pivot": pivot,
        }
        return Sketch(joints, ((SHAFT, PIN), (PIN, "rocker pin"), ("rocker pin", "pivot")), (SHAFT, "pivot"))

    def coupler_at(self, angle: CrankAngle) -> Coupler:
        """Return the coupler at the crank angle."""
        return self.loop.at(angle).coupler

    def coupler_force_factor(self, angle: CrankAngle) -> Any:
        """Return the coupler's force over the moment on the rocker, 1/(c sin μ) in 1/m."""
        return 1 / (self.rocker * self.loop.at(angle).sin_transmission)

    @property
    def lacks(self) -> tuple[tuple[str, str], ...]:
        """Name the inertia of its links."""
        return (("inertia of coupler and rocker", "kurbel takes no masses on what only swings"),)

    def _half_tangents(self, reach: float) -> tuple[float, float]:
        """Return tan of half the angles at the crank's and the rocker's pivot, crank and coupler in line.

        reach: 1 for the coupler's joint at b + a from the crank's pivot, −1 at b − a. All differences are positive.
        """
        a, b, c, d = reach * self.crank, self.coupler, self.rocker, self.frame
        no_line, no_rocker = math.fsum((c, d, -a, -b)), math.fsum((a, b, d, -c))
        frame_share = math.fsum((a, b, c, -d)) / math.fsum((a, b, c, d))
        return math.sqrt(frame_share * (no_line / no_rocker)), math.sqrt(frame_share * (no_rocker / no_line))

    def dead_centres(self) -> tuple[float, float]:
        """Return the crank angles of smallest and of largest θ: crank and coupler in line, stretched and folded.

        Where the rocker turns fully there is none, and a turn counts from 0° by way of 180°.
        """
        if self.turns:
            return 0.0, 180.0
        return 2 * bearing(self._half_tangents(1)[0], 1.0), 180.0 + 2 * bearing(self._half_tangents(-1)[0], 1.0)

    @property
    def limits(self) -> tuple[float, float]:
        """Smallest and largest θ in degrees."""
        return 180.0 - 2 * bearing(self._half_tangents(1)[1], 1.0), 180.0 - 2 * bearing(self._half_tangents(-1)[1], 1.0)

    @property
    def swing(self) -> float | None:
        """θ_max − θ_min in degrees, from the difference of the half tangents: a small swing keeps its digits.

        None where the rocker turns fully.
        """
        if self.turns:
            return None
        stretched, folded = self._half_tangents(1)[1], self._half_tangents(-1)[1]
        a, b, c = self.loop.crank, self.loop.coupler, self.loop.rocker
        below = self._line_gap(1) * self._line_gap(-1) * (stretched + folded)
        return float(2 * bearing(16 * a * b * c / below, 1 + stretched * folded))

    def _line_gap(self, reach: float) -> float:
        """(c + d)² − (b ± a)², over d²."""
        a, b, c, d = reach * self.crank, self.coupler, self.rocker, self.frame
        return math.fsum((c, d, -a, -b)) / d * (math.fsum((c, d, a, b)) / d)

    @property
    def stroke(self) -> float:
        """The swing in radians; 2π where the rocker turns fully."""
        return math.tau if self.swing is None else math.radians(self.swing)

    @property
    def start(self) -> float:
        """The smallest θ in radians; where the rocker turns fully, that of φ = 0."""
        return float(self.coordinate(CrankAngle.of(0.0))) if self.turns else math.radians(self.limits[0])

    @property
    def works_outward(self) -> bool:
        """Whether θ rises on the slower swing, which is the working one."""
        inner, outer = self.dead_centres()
        return outer - inner >= 180.0

    @property
    def phi_work(self) -> float:
        """Crank rotation of the slower swing in degrees."""
        inner, outer = self.dead_centres()
        return outer - inner if self.works_outward else 360.0 - (outer - inner)

    @property
    def notes(self) -> tuple[str, ...]:
        """Say that the rocker turns fully, where it does."""
        return ("The frame is the shortest link: the rocker turns fully with the crank (drag link).",) * self.turns

    @property
    def transmission(self) -> tuple[Extreme, Extreme]:
        """The transmission angle μ between coupler and rocker at 0° and at 180°, its smallest and largest."""
        c, b, loop = self.rocker / self.frame, self.coupler / self.frame, self.loop
        twice = 2 * min(loop.crank, 1.0)
        small = math.sqrt(loop.near_coupler / (b + c + abs(loop.span)) * (loop.near_rocker / (loop.flat + twice)))
        far_coupler, far_rocker = loop.near_coupler + twice, loop.near_rocker + twice
        large = math.sqrt(far_coupler / loop.flat * (far_rocker / (b + c + 1 + loop.crank)))
        return Extreme(2 * bearing(small, 1.0), 0.0), Extreme(2 * bearing(large, 1.0), 180.0)
