"""Four-bar linkage: the crank-rocker (Bogenschubkurbel), R ch. 14 A, and the drag link, whose rocker turns too."""

import math
from collections.abc import Iterator
from functools import cached_property
from typing import NamedTuple

from kurbel.arrays import Number
from kurbel.crank_angle import CrankAngle
from kurbel.declared.record import Rule, field
from kurbel.mechanisms import (
    F_COUPLER,
    PIN,
    SWING_OFFERS,
    SWING_VALUES,
    TURNING,
    KeyOffer,
    Mechanism,
    Offer,
    Sketch,
    Turning,
    on_circle,
    requested_column,
)
from kurbel.numerics.arithmetic import bearing, sqrt
from kurbel.numerics.extreme import Extreme
from kurbel.quantity import Quantity


def _coupler(order: int) -> Offer:
    end, mark, kind, name = TURNING[order]
    text = (
        f"{name}, from the line crank pivot → rocker pivot, of the coupler"
        if not order
        else f"{name} of the coupler"
    )
    return requested_column(
        f"theta_coupler{end}",
        f"θ{mark}_K",
        kind,
        text,
        lambda one, angle: one.coupler_at(angle)[order],
        "theta_ddot",
        order,
        f"theta_K{end}",
    )


def _transmission(end: str, size: str, degrees: float) -> KeyOffer:
    text, after = f"{size} transmission angle", "theta_ddot_min"
    quantity = Quantity(
        f"transmission_{end}", f"μ_{end}", "angle", text, "", ("motion", "forces"), after=after
    )
    return KeyOffer(quantity, lambda four_bar, _: four_bar.transmission(degrees))


class Closure(NamedTuple):
    """The closed loop at a crank angle: (sin θ, cos θ) of the rocker, θ′, θ″; lengths over the frame.

    H: twice the area of the triangle of coupler, rocker and diagonal from crank pin to rocker pivot; foot: product of
    rocker and diagonal, times the cosine of the angle between them.
    """

    sin: Number
    cos: Number
    slope: Number
    curvature: Number
    H: Number
    foot: Number


class FourBar(Mechanism):
    """A crank that turns fully and through a coupler swings a rocker, or, where the frame is shortest, turns it too.

    crank, coupler, rocker, frame: a, b, c, d in m. φ and θ count from the line crank pivot → rocker pivot, with the
    coupler's joint on the side where the crank pin is for 0 < φ < 180°; that side holds for the whole turn. The working
    swing is the slower one. Raises RuleError unless crank or frame is the shortest link and together with the longest
    shorter than the other two (Grashof): no other crank turns fully.
    """

    crank: float = field("length", "Crank radius", "a", above=0)
    coupler: float = field("length", "Length of the coupler", "b", above=0)
    rocker: float = field("length", "Length of the rocker", "c", above=0)
    frame: float = field("length", "Distance of the rocker's pivot from the shaft", "d", above=0)

    name = "four-bar"
    slides = False
    OFFERS = (*SWING_OFFERS, *map(_coupler, range(3)), F_COUPLER)
    KEY_OFFERS = (
        *SWING_VALUES,
        _transmission("min", "Smallest", 0.0),
        _transmission("max", "Largest", 180.0),
    )
    far_pin = "rocker_pin"

    def rules(self) -> Iterator[Rule]:
        # among equals the crank comes first
        links = {
            "crank": self.crank,
            "frame": self.frame,
            "coupler": self.coupler,
            "rocker": self.rocker,
        }
        shortest, *others, longest = sorted(links, key=links.__getitem__)
        gap = math.fsum((*(links[name] for name in others), -links[shortest], -links[longest]))
        # lengths that were written in decimals meet a change point only within their rounding
        flat = gap <= 2 * math.ulp(links[longest])
        numbers = links | {
            "ends": links[shortest] + links[longest],
            "pair": sum(links[name] for name in others),
        }
        longer = f"{{crank}} is longer than the {shortest} ({{{shortest}}}), and so is the frame ({{frame}}): "
        longer += "the crank turns fully only where it or the frame is the shortest link"
        yield Rule(
            "crank", shortest not in ("crank", "frame") and gap == gap, longer
        )  # of an unread length gap is nan
        sums = f"{shortest} + {longest}, {{ends:length}}, must be less than {' + '.join(others)}, {{pair:length}}"
        grashof = f"it cannot turn fully: {sums} (Grashof; where they are equal, it folds flat: a change point)"
        yield Rule("crank", flat and shortest in ("crank", "frame"), grashof, numbers)

    @property
    def turns(self) -> bool:
        """Whether the rocker turns fully with the crank: the frame is the shortest link (drag link, double crank)."""
        return self.frame < self.crank

    @property
    def quick_return(self) -> bool:
        """Whether the rocker swings."""
        return not self.turns

    has_dead_centres = quick_return

    def closed_at(self, angle: CrankAngle) -> Closure:
        """Return the loop closed at a crank angle.

        With a, b, c over the frame, the diagonal p from the crank pin to the rocker's pivot has the square
        w = 1 + a² − 2a cos φ, and

            H² = (b + c + p)(b + c − p)(p + b − c)(p + c − b)/4     twice the area of coupler, rocker and p (Heron)
            θ′ = [a sin φ E/(2H) + a(a − cos φ)]/w                  E = w + b² − c²: the triangle turns, and p
            θ″ = a sin φ (1 − a²)/w² + [w″E + w′²(1 − EG/(4H²) − E/w)]/(4Hw)             G = b² + c² − w

        Every difference is built from positive terms, so that a linkage that is nearly flat keeps its digits.
        """
        crank, coupler, rocker, frame = self.crank, self.coupler, self.rocker, self.frame
        a, b, c = crank / frame, coupler / frame, rocker / frame
        near, far = min(crank, frame), max(crank, frame)
        flat, near_coupler, near_rocker = (
            math.fsum(terms) / frame
            for terms in (
                (coupler, rocker, -crank, -frame),  # b + c − a − 1
                (far, coupler, -near, -rocker),  # |1 − a| + b − c
                (far, rocker, -near, -coupler),
            )
        )
        span, unlike = (frame - crank) / frame, (coupler - rocker) / frame * (b + c)
        w = span * span + 2 * a * angle.versine
        p = sqrt(w)
        lift = 2 * a * angle.versine / (p + abs(span))  # p − |1 − a|
        drop = 2 * a * angle.vercosine / (1 + a + p)  # 1 + a − p
        H = (
            sqrt((flat + drop) * (b + c + p))
            * sqrt((near_coupler + lift) * (near_rocker + lift))
            / 2
        )
        across, along, foot = a * angle.sin, span + a * angle.versine, (w - unlike) / 2
        sin, cos = (foot * across + H * along) / (w * c), (H * across - foot * along) / (w * c)
        E, G, rise, bend = w + unlike, b * b + c * c - w, 2 * across, 2 * a * angle.cos
        slope = (across * E / (2 * H) + a * (angle.versine - span)) / w
        triangle = bend * E + rise * rise * (1 - (E / (2 * H)) * (G / (2 * H)) - E / w)
        curvature = across * span * (1 + a) / (w * w) + triangle / (4 * H * w)
        return Closure(sin, cos, slope, curvature, H, foot)

    def coordinate(self, angle: CrankAngle) -> Number:
        """Return θ in radians; where it turns fully, it runs on with φ."""
        return self.swing_at(angle).degrees * (math.pi / 180)

    def slope(self, angle: CrankAngle) -> Number:
        """Return dθ/dφ."""
        return self.closed_at(angle).slope

    def curvature(self, angle: CrankAngle) -> Number:
        """Return d²θ/dφ²."""
        return self.closed_at(angle).curvature

    def swing_at(self, angle: CrankAngle) -> Turning:
        """Return how the rocker turns."""
        loop = self.closed_at(angle)
        if not self.turns:
            return Turning(bearing(loop.sin, loop.cos), loop.slope, loop.curvature)
        # the diagonal runs ahead of the crank, and the rocker behind it
        ahead = bearing(angle.sin, angle.versine + (self.crank - self.frame) / self.frame)
        return Turning(
            angle.degrees + ahead - bearing(loop.H, loop.foot), loop.slope, loop.curvature
        )

    def coupler_at(self, angle: CrankAngle) -> Turning:
        """Return how the coupler turns, by the velocities and accelerations of its ends.

        b τ′ sin(θ−τ) = −a sin(θ−φ), b τ″ sin(θ−τ) = a cos(θ−φ) + b τ′² cos(θ−τ) − c θ′².
        """
        loop, d = self.closed_at(angle), self.frame
        a, b, c = self.crank / d, self.coupler / d, self.rocker / d
        along, across = (1 + c * loop.cos - a * angle.cos) / b, (c * loop.sin - a * angle.sin) / b
        lever = loop.H / c
        slope = -a * (loop.sin * angle.cos - loop.cos * angle.sin) / lever
        pull = a * (loop.cos * angle.cos + loop.sin * angle.sin) - c * loop.slope * loop.slope
        toward = b * slope * slope * (loop.cos * along + loop.sin * across)
        return Turning(bearing(across, along), slope, (pull + toward) / lever)

    @property
    def coupler_length(self) -> float:
        """b in m."""
        return self.coupler

    def coupler_force_factor(self, angle: CrankAngle) -> Number:
        """Return the coupler's force over the moment on the rocker, 1/(c sin μ) in 1/m, with sin μ = H/(b c)."""
        return self.coupler / self.frame / self.frame / self.closed_at(angle).H

    def transmission(self, degrees: float) -> Extreme:
        """Return the transmission angle μ between coupler and rocker, smallest at 0° and largest at 180°."""
        loop, c = self.closed_at(CrankAngle.of(degrees)), self.rocker / self.frame
        return Extreme(
            float(bearing(loop.H, c * c - loop.foot)), degrees
        )  # b c sin μ and b c cos μ

    def sketch(self, angle: CrankAngle) -> Sketch:
        """Return crank, coupler and rocker."""
        loop, pivot = self.closed_at(angle), (self.frame, 0.0)
        joints = {"rocker pin": on_circle(self.rocker, loop.cos, loop.sin, pivot), "pivot": pivot}
        links = (PIN, "rocker pin"), ("rocker pin", "pivot")
        return Sketch.of_crank(self.crank, angle, joints, *links, fixed=("pivot",))

    lacks = (
        ("inertia of coupler and rocker", "kurbel has no masses on a mechanism that only swings"),
    )

    def dead_centres(self) -> tuple[float, float]:
        """Return the crank angles of smallest and of largest θ: crank and coupler in line, stretched and folded.

        Half of each is the arctangent of a root of products of positive differences. Where the rocker turns fully there
        is no dead centre, and a turn counts from 0° by way of 180°.
        """
        if self.turns:
            return 0.0, 180.0
        b, c, d, halves = self.coupler, self.rocker, self.frame, []
        for a in (self.crank, -self.crank):
            share = math.fsum((a, b, c, -d)) / math.fsum((a, b, c, d))
            ratio = math.fsum((c, d, -a, -b)) / math.fsum((a, b, d, -c))
            halves.append(bearing(math.sqrt(share * ratio), 1.0))
        return 2 * halves[0], 180.0 + 2 * halves[1]

    @cached_property
    def limits(self) -> tuple[float, float]:
        """Smallest and largest θ in degrees, those of the dead centres."""
        inner, outer = (
            float(self.swing_at(CrankAngle.of(end)).degrees) for end in self.dead_centres()
        )
        return inner, outer

    @property
    def swing(self) -> float | None:
        """θ_max − θ_min in degrees; None where the rocker turns fully."""
        if self.turns:
            return None
        return self.limits[1] - self.limits[0]

    @property
    def stroke(self) -> float:
        """The swing in radians; 2π where the rocker turns fully."""
        if self.swing is None:
            return math.tau
        return math.radians(self.swing)

    @property
    def start(self) -> float:
        """The smallest θ in radians; where the rocker turns fully, that of φ = 0."""
        return math.radians(self.limits[0])

    @property
    def works_outward(self) -> bool:
        """Whether θ rises on the slower swing, which is the working one."""
        inner, outer = self.dead_centres()
        return outer - inner >= 180.0

    @property
    def phi_work(self) -> float:
        """Crank rotation of the slower swing in degrees."""
        inner, outer = self.dead_centres()
        return max(outer - inner, 360.0 - (outer - inner))

    @property
    def notes(self) -> tuple[str, ...]:
        """Say that the rocker turns fully, where it does."""
        return (
            "The frame is the shortest link: the rocker turns fully with the crank (drag link).",
        ) * self.turns
