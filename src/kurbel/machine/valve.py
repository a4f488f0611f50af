"""A slide or piston valve driven by one eccentric: its laps, how it is set, and the events at each end.

φ counts from the inner dead centre in the sense of rotation. w is how far the valve is off the middle of its ports, in
the sense that opens the head end to steam; the eccentric, δ beyond the square to the crank, moves it by

    w = r sin a + σ g + ε        a = φ + δ        g = l − √(l² − r² cos² a)

At mid-travel the slope of its rod leaves the valve nearer to the shaft by g. An outside valve opens the head end toward
the shaft: σ = +1; an inside one, or a rocker between eccentric and valve, turns the sense, and both together turn it
back. ε is what the fitter adjusts on the spindle, so that each end has its lead.

The crank end is the head end with −σ and −ε, half a turn later. With steam lap S and exhaust lap E an end is open to
steam by w − S, and to the exhaust by −w − E. The edges are inverted exactly, by the cosine rule (`Eccentric.angle_at`).
"""

import math
from collections.abc import Iterator
from dataclasses import replace
from functools import cached_property
from typing import Any, NamedTuple, Union

import numpy as np

from kurbel.arrays import Number, Truth
from kurbel.crank_angle import CrankAngle
from kurbel.declared.forms.structures import OneOf, RecordForm
from kurbel.declared.forms.values import NumberForm
from kurbel.declared.record import Record, Rule, alternative, field, first_of
from kurbel.machine.ideal_cards import Steam
from kurbel.machine.parts import Piston
from kurbel.mechanisms import Mechanism
from kurbel.numerics.arithmetic import bearing, sqrt, where

_AT_DEAD_CENTRE = 1e-9
"""Degrees: an event nearer to a dead centre is there; the rest is rounding."""
_ROUNDING = 1e-12
"""Of the eccentricity: a smaller length is rounding."""


class EachEnd(Record):
    """A length in m that is not the same at both ends."""

    head_end: float = field("length", "At the head end", example="22 mm")
    crank_end: float = field("length", "At the crank end", example="22 mm")


Length = Union[float, EachEnd]
"""A length of both ends, or of each."""
_LENGTH = OneOf(NumberForm("length"), RecordForm(EachEnd))


def _of_both(length: Length) -> tuple[Number, Number]:
    """Return a length at the head end and at the crank end."""
    if isinstance(length, EachEnd):
        return length.head_end, length.crank_end
    return length, length


class Eccentric(NamedTuple):
    """The eccentric that moves the valve, or that would move it as its link does.

    radius: r in m; ahead: A = r sin δ, how far the valve is ahead at the dead centre with an infinite rod; square:
    B = r cos δ; slope: k = 1/l in 1/m, 0 for an infinite eccentric rod.
    """

    radius: Number
    ahead: Number
    square: Number
    slope: Number

    @property
    def advance(self) -> Number:
        """Angle of advance δ in degrees."""
        return bearing(self.ahead, self.square)

    def nearer(self, off_square: Number) -> Number:
        """Return g = l − √(l² − r² cos² a) in m for r cos a, without cancellation."""
        k = self.slope
        square = off_square * off_square
        return k * square / (1 + sqrt(np.maximum(1 - k * k * square, 0.0)))

    def displacement(self, angle: CrankAngle, sense: Number) -> Number:
        """Return r sin a + σ g in m at a crank angle."""
        r_sin_a: Number = self.ahead * angle.cos + self.square * angle.sin
        r_cos_a = self.square * angle.cos - self.ahead * angle.sin
        return r_sin_a + sense * self.nearer(r_cos_a)

    def angle_at(self, displacement: Number, sense: Number) -> Number:
        """Return a in degrees, from −90 to 90, at which r sin a + σ g = d on the rising branch.

        With h = σ k:  a = atan2(d − h (r² + d²)/2, √[(r − d)(r + d)(1 + h (r − d)/2)(1 − h (r + d)/2)]).
        """
        r = self.radius
        d = displacement
        h = sense * self.slope
        sine_part = d - h * (r * r + d * d) / 2
        cosine_part = (r - d) * (r + d) * (1 + h * (r - d) / 2) * (1 - h * (r + d) / 2)
        return bearing(sine_part, sqrt(np.maximum(cosine_part, 0.0)))


class Link(Record):
    """Stephenson's link between the rods of two eccentrics, one for each sense of rotation."""

    half_length: float = field(
        "length",
        "Half the length of the link, between the pins of the rods",
        "c",
        above=0,
        example="230 mm",
    )
    position: float = field(
        "ratio",
        "Place of the block on the link, from 0 in its middle (mid gear) to 1 (full gear)",
        "u/c",
        least=0,
        most=1,
        example="0.5",
    )
    rods: str = field(
        ("open", "crossed"),
        "Whether the rods are open or crossed when both eccentrics are on the side of the link",
        default="open",
        absent="open",
    )

    def eccentric(self, radius: float, advance: float, rod: float) -> Eccentric:
        """Return the one eccentric that moves the valve as two and the link do (Zeuner), with an infinite rod.

        radius, advance in degrees, rod: of the two eccentrics.
        """
        delta = CrankAngle.of(advance)
        kappa = self.position
        rise = (1 - kappa * kappa) * (self.half_length / rod) * delta.cos
        rods_sign = 1.0 if self.rods == "open" else -1.0
        A = radius * (delta.sin + rods_sign * rise)
        B = radius * kappa * delta.cos
        return Eccentric(np.hypot(A, B), A, B, 0.0)


class Events(NamedTuple):
    """Of one end, each a `Number`: degrees from its own dead centre, or fractions of the stroke from there."""

    cut_off: Any
    release: Any
    compression: Any
    admission: Any


class ValveEnd(NamedTuple):
    """One end of the cylinder as the valve serves it; angles count from its own dead centre, lengths are in m.

    key: of the machine file; dead_centre: its own one, in degrees; sense, shift: σ and ε as this end has them; lead:
    v; port: width of the port, beyond which nothing opens.
    """

    key: str
    dead_centre: float
    eccentric: Eccentric
    sense: float
    shift: Number
    steam_lap: Number
    exhaust_lap: Number
    lead: Number
    port: Number

    @property
    def name(self) -> str:
        """What people call it."""
        return self.key.replace("_", " ")

    @property
    def exhaust_lead(self) -> Number:
        """v_i, how far the end is open to the exhaust at the end of its stroke: A − σ g − ε − E."""
        eccentric = self.eccentric
        nearer = eccentric.nearer(eccentric.square)
        return eccentric.ahead - self.sense * nearer - self.shift - self.exhaust_lap

    @property
    def opening(self) -> Number:
        """Largest opening to steam."""
        return np.minimum(self.eccentric.radius + self.shift - self.steam_lap, self.port)

    def opening_at(self, displacement: Number) -> Number:
        """Return how far the port is open where the valve is displaced so far, to the exhaust negative, 0 if shut.

        displacement: in the sense that opens this end to steam.
        """
        to_steam = np.clip(displacement - self.steam_lap, 0.0, self.port)
        to_exhaust = np.clip(-displacement - self.exhaust_lap, 0.0, self.port)
        return to_steam - to_exhaust

    @property
    def events(self) -> Events:
        """The angles at which the edges pass those of the port, from 0 to 360 degrees."""
        delta = self.eccentric.advance
        opens_to_steam = self.eccentric.angle_at(self.steam_lap - self.shift, self.sense)
        shuts_exhaust = self.eccentric.angle_at(-self.exhaust_lap - self.shift, self.sense)
        return Events(
            cut_off=_settled(180.0 - opens_to_steam - delta),
            release=_settled(180.0 - shuts_exhaust - delta),
            compression=_settled(360.0 + shuts_exhaust - delta),
            admission=_settled(360.0 + opens_to_steam - delta),
        )

    def fractions(self, mechanism: Mechanism) -> Events:
        """Return what part of the stroke the piston is away from this end at each event."""
        away = [self._away(degrees + self.dead_centre, mechanism) for degrees in self.events]
        return Events(*away)

    def _away(self, degrees: Number, mechanism: Mechanism) -> Number:
        """Return the distance of the piston from this end over the stroke, at a crank angle."""
        angle = CrankAngle.of(degrees)
        if self.key == "crank_end":
            return mechanism.remaining(angle) / mechanism.stroke
        return (mechanism.coordinate(angle) - mechanism.start) / mechanism.stroke

    def timed(self, card: Steam, mechanism: Mechanism) -> Steam:
        """Return a steam card with the events of this end."""
        events = self.fractions(mechanism)
        return replace(
            card,
            cut_off=events.cut_off,
            release=events.release,
            compression=events.compression,
            lead=events.admission,
        )

    def rules(self, setting: str) -> Iterator[Rule]:
        """Yield what keeps the valve from serving this end; setting: the key by which it is set."""
        r = self.eccentric.radius
        S = self.steam_lap
        E = self.exhaust_lap
        yield Rule("steam_lap", S < 0, f"{self.name}: a steam lap is not negative")
        # the travel opens the port
        advice = "its lap must be less than half the travel"
        message = f"{self.name}: never opens to steam; {advice}"
        yield Rule("steam_lap", S - self.shift >= r, message)
        message = f"{self.name}: never opens to the exhaust; {advice}"
        yield Rule("exhaust_lap", E + self.shift >= r, message)

        # with both edges in line nothing expands, as in the engines without laps, advance and lead
        laps = S + E
        is_in_line = (laps <= _ROUNDING * r) & (self.eccentric.ahead > 0)
        message = (
            f"{self.name}: open to steam and exhaust at once, "
            "since the laps together are {laps:length}"
        )
        yield Rule("exhaust_lap", (laps < 0) | is_in_line, message, {"laps": laps})

        # the port opens before the dead centre
        for medium, lead in (("steam", self.lead), ("the exhaust", self.exhaust_lead)):
            gap = -lead
            message = (
                f"{self.name}: opens to {medium} only after the dead centre, "
                "where it overlaps by {gap:length}"
            )
            yield Rule(setting, gap > _ROUNDING * r, message, {"gap": gap})


def _settled(degrees: Number) -> Number:
    """Return an angle from 0 to 360 degrees, exactly at a dead centre where only rounding is between."""
    centre = 180.0 * np.rint(degrees / 180.0)
    return where(abs(degrees - centre) < _AT_DEAD_CENTRE, centre, degrees) % 360.0


class Valve(Record):
    """The valve of a cylinder, in m and degrees; see the module.

    travel: 2r of the valve, behind a link of its two eccentrics; laps and leads are of both ends, or of each; lead,
    angle_of_advance: the one by which the valve is set, None the other.
    """

    travel: float = field(
        "length",
        "Travel of the valve; behind a `link`, of its eccentrics",
        "2r",
        above=0,
        example="90 mm",
    )
    _eccentricity = alternative(
        "length",
        "Eccentricity, half the travel",
        "r",
        above=0,
        example="45 mm",
        instead="travel",
        gives=lambda values: {"travel": 2 * values["eccentricity"]},
    )
    steam_lap: Length = field(
        _LENGTH,
        "Overlap beyond the port on the steam side, with the valve in its middle; one, or of each end",
        "S",
        example="22 mm",
    )
    exhaust_lap: Length = field(
        _LENGTH,
        "Overlap on the exhaust side; negative where the port is then open; one, or of each end",
        "E",
        default=0.0,
        example="2 mm",
        absent="0 mm",
    )
    lead: Length | None = field(
        _LENGTH,
        "Opening to steam at the dead centre, by which eccentric and spindle are set; one, or of each end",
        "v",
        example="3 mm",
        absent="follows from `angle_of_advance`",
    )
    angle_of_advance: float | None = field(
        "angle",
        "Angle of the eccentric beyond the square to the crank; the travel is then centred on the ports",
        "δ",
        least=0,
        most=90,
        example="34 deg",
        instead="lead",
        absent="follows from `lead`",
    )
    eccentric_rod: float = field(
        "length",
        "Length of the eccentric rod",
        "l",
        above=0,
        default=math.inf,
        example="1200 mm",
        absent="infinite, as Zeuner draws it",
    )
    admission: str = field(
        ("outside", "inside"),
        "Edges that admit steam: the outer ones of a slide valve, the inner ones of most piston valves",
        default="outside",
        absent="outside",
    )
    reversing_rocker: bool = field(
        bool,
        "Whether a rocker between eccentric and valve turns the motion round",
        default=False,
        absent="false",
    )
    port_width: float = field(
        "length",
        "Width of the ports along the travel",
        "a",
        above=0,
        example="30 mm",
        default=math.inf,
        absent="no limit",
    )
    port_length: float | None = field(
        "length",
        "Length of the ports across the travel",
        "b",
        above=0,
        example="280 mm",
        needs="port_width",
        absent="no speed of the steam",
    )
    link: Link | None = field(
        Link, "Stephenson's link", needs="eccentric_rod", absent="one eccentric"
    )

    def rules(self) -> Iterator[Rule]:
        if self.lead is None and self.angle_of_advance is None:
            yield Rule((), True, "how is the valve set? Give 'lead', or 'angle_of_advance'")
        elif self.lead is not None and self.link is not None:
            message = "of a link the lead follows; give 'angle_of_advance' instead"
            yield Rule("lead", True, message)
        else:
            yield from first_of(self._rules_of_motion())

    def _rules_of_motion(self) -> Iterator[Rule]:
        """Yield the rules on eccentric and rod, and those on each end."""
        r = self.travel / 2
        message = "{eccentric_rod} is no longer than the eccentricity ({r:length})"
        yield Rule("eccentric_rod", self.eccentric_rod <= r, message, {"r": r})
        setting = "angle_of_advance"
        if self.lead is not None:
            setting = "lead"
            A = self._lap_and_lead
            message = "lap and lead ({A:length}) are more than half the travel ({r:length})"
            yield Rule("lead", r < A, message, {"A": A, "r": r})
        for end in self.ends:
            yield from end.rules(setting)

    def rules_on(self, mechanism: Mechanism) -> Iterator[Rule]:
        """Yield that the mechanism has its dead centres elsewhere than the valve counts from."""
        fits: Truth = False
        if mechanism.slides and mechanism.has_dead_centres:
            inner, outer = mechanism.dead_centres()
            fits = (abs(inner) < _AT_DEAD_CENTRE) & (abs(outer - 180.0) < _AT_DEAD_CENTRE)
        message = (
            "a valve needs dead centres at 0° and 180°: "
            "a slider-crank or yoke-frame without offset, or a scotch-yoke"
        )
        yield Rule((), np.logical_not(fits), message)

    @property
    def _lap_and_lead(self) -> Number:
        """A = ½(S_H + S_C + v_H + v_C): the slope of the rod is the same at both dead centres, and drops out."""
        assert self.lead is not None
        return (sum(_of_both(self.steam_lap)) + sum(_of_both(self.lead))) / 2

    @cached_property
    def eccentric(self) -> Eccentric:
        """The eccentric that moves the valve, set by its leads or by its angle."""
        r = self.travel / 2
        k = 1 / self.eccentric_rod
        if self.angle_of_advance is None:
            A = self._lap_and_lead
            B = sqrt(np.maximum((r - A) * (r + A), 0.0))
            return Eccentric(r, A, B, k)
        if self.link is not None:
            return self.link.eccentric(r, self.angle_of_advance, self.eccentric_rod)
        delta = CrankAngle.of(self.angle_of_advance)
        return Eccentric(r, r * delta.sin, r * delta.cos, k)

    @property
    def sense(self) -> float:
        """σ, the way in which the slope of the eccentric rod displaces the valve."""
        is_inside = self.admission == "inside"
        are_both_or_none = is_inside == self.reversing_rocker
        if are_both_or_none:
            return 1.0
        return -1.0

    @cached_property
    def shift(self) -> Number:
        """ε in m, by which the middle of the travel is off the middle of the ports: ½(S_H + v_H − S_C − v_C) − σ g."""
        if self.lead is None:
            return 0.0
        S_H, S_C = _of_both(self.steam_lap)
        v_H, v_C = _of_both(self.lead)
        g = self.eccentric.nearer(self.eccentric.square)
        return (S_H + v_H - S_C - v_C) / 2 - self.sense * g

    @cached_property
    def ends(self) -> tuple[ValveEnd, ValveEnd]:
        """Head end and crank end."""
        return self._end("head_end", 0), self._end("crank_end", 1)

    @property
    def compresses(self) -> Truth:
        """Whether an end is shut before its dead centre, so that steam is compressed."""
        head, crank = (end.events.compression != 0.0 for end in self.ends)
        return head | crank

    def _end(self, key: str, number: int) -> ValveEnd:
        """Return an end; number: 0 of the head end, 1 of the crank end, which has −σ and −ε, half a turn later."""
        end_sign = 1.0 - 2.0 * number
        sigma = end_sign * self.sense
        epsilon = end_sign * self.shift
        S = _of_both(self.steam_lap)[number]
        E = _of_both(self.exhaust_lap)[number]
        # the lead, given or by the angle of advance: v = A + σ g + ε − S
        if self.lead is not None:
            v = _of_both(self.lead)[number]
        else:
            g = self.eccentric.nearer(self.eccentric.square)
            v = self.eccentric.ahead + sigma * g + epsilon - S
        return ValveEnd(
            key, 180.0 * number, self.eccentric, sigma, epsilon, S, E, v, self.port_width
        )

    def displacement(self, angle: CrankAngle) -> Number:
        """Return w in m at a crank angle."""
        return self.eccentric.displacement(angle, self.sense) + self.shift

    def timed(self, piston: Piston, mechanism: Mechanism) -> Piston:
        """Return the piston with the events of the valve in its steam cards."""
        cards: dict[str, Any] = {}
        for end in self.ends:
            card = piston.chambers.get(end.key)
            if isinstance(card, Steam):
                cards[end.key] = end.timed(card, mechanism)
        if piston.indicator is None or not cards:
            return piston
        indicator = replace(piston.indicator, **cards)
        return replace(piston, indicator=indicator)
