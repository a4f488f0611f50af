"""Slotted lever (schwingende Kurbelschleife): the quick return of shapers, R p. 615, and Whitworth's rotating lever."""

import math
from collections.abc import Iterator
from functools import cached_property
from typing import Any, NamedTuple

from kurbel.arrays import Number
from kurbel.crank_angle import CrankAngle
from kurbel.declared.record import Rule, alternative, field
from kurbel.declared.unit_systems import show
from kurbel.mechanisms import (
    BLOCK_OFFERS,
    NO_PIN,
    PIN,
    SWING_OFFERS,
    SWING_VALUES,
    Mechanism,
    RamLever,
    Sketch,
    Turning,
    on_circle,
    pin_diameter,
    pin_length,
    pin_pressure_offer,
)
from kurbel.numerics.arithmetic import bearing, sqrt


class Lever(NamedTuple):
    """The lever at a crank angle: (sin θ, cos θ), θ′ and θ″.

    reach: distance of the pin from the pivot in m.
    """

    sin: Number
    cos: Number
    reach: Number
    slope: Number
    curvature: Number


class Ram(NamedTuple):
    """The ram over the length of the lever: its place, its derivative by θ, and minus the derivative of that."""

    place: Number
    lead: Number
    bend: Number


class SlottedLever(Mechanism):
    """A crank pin that slides in a slotted lever, whose end drives a ram square to the line of the two pivots.

    crank: r; frame: e, distance of the lever's pivot D from the shaft M; lever: R_l = DE; in m. Without `lever`
    the output is its tilt θ, and there is no ram; working and return stroke are those that a fork head would have.
    tan θ = r sin φ/(e + r cos φ), φ from the position where the pin is farthest from D, the ram moving forward there.
    For e > r the lever swings; for e < r it turns fully, which is Whitworth's quick return.
    link: m, `math.inf` for the fork head (x = R_l sin θ); otherwise the connecting link from E to the ram, which runs
    ahead of E. ram_height: h of the ram's line above D, by default half-way between highest and lowest point of E.
    pin_diameter, pin_length: of the crank pin in m, None where they are not known.
    Raises RuleError for e = r, and for a link that does not reach the ram or gets into line with the lever.
    """

    crank: float = field("length", "Crank radius; or give `stroke`", "r", above=0, example="100 mm")
    _stroke = alternative(
        "length",
        "Stroke of the ram of a lever that swings; or give `crank`",
        "s",
        above=0,
        instead="crank",
        needs="lever",
        gives=lambda keys: (
            {"crank": keys["stroke"] * keys["frame"] / (2 * keys["lever"])}
            if keys.get("frame") and keys.get("lever")
            else {}
        ),
        key="stroke",
    )
    frame: float = field("length", "Distance of the lever's pivot from the shaft", "e", above=0)
    lever: float | None = field(
        "length",
        "Length of the lever, pivot to end",
        "R_l",
        above=0,
        absent="angles and times only: no ram",
    )
    link: float = field(
        "length",
        "Length of the connecting link from the lever's end to the ram",
        "l",
        default=math.inf,
        above=0,
        words={"infinite": math.inf},
        absent="fork head sliding along the ram",
    )
    ram_height: float | None = field(
        "length",
        "Height of the ram's line above the lever's pivot; needs `link`",
        "h",
        absent="half-way between the highest and the lowest point of the lever's end",
    )
    pin_diameter: float | None = pin_diameter()
    pin_length: float | None = pin_length()

    name = "slotted-lever"
    OFFERS = (*SWING_OFFERS, *BLOCK_OFFERS)
    KEY_OFFERS = (*SWING_VALUES, pin_pressure_offer())
    quick_return = True

    def rules(self) -> Iterator[Rule]:
        forked = math.isinf(self.link)
        yield Rule(
            "link", not (self.slides or forked), "needs the end of the lever; give 'lever' too"
        )
        same = "{frame} is also the crank: the pin would pass through the lever's pivot"
        yield Rule("frame", self.crank == self.frame, same)
        fork = forked and self.ram_height is not None
        yield Rule("ram_height", fork, "has no meaning for a fork head; give 'link' with it")
        if self.slides and not forked and self.crank != self.frame:
            yield from self._rules_of_link()

    def _rules_of_link(self) -> Iterator[Rule]:
        end, height = self._end, self._height
        if self.rotates:
            least = end + abs(height)
            turning = "as the lever turns fully it must be longer than lever and ram_height together ({least:length})"
            yield Rule(
                "link", self.link <= least, f"{{link}} does not reach: {turning}", {"least": least}
            )
            return
        least = max(abs(height - end), abs(height - end * self._kappa[1]))
        numbers = {"ram": height, "least": least}
        reach = (
            "{link} does not reach the ram at {ram:length}; it must be longer than {least:length}"
        )
        yield Rule("link", self.link <= least, reach, numbers)
        in_line = (
            self.link > least and min(self._ram(sin, cos).lead for sin, cos in self._limits) <= 0
        )
        remedy = "give a longer link or another ram_height"
        yield Rule(
            "link", in_line, f"{{link}} gets into line with the lever within its swing; {remedy}"
        )

    # what it is, by its lengths

    @property
    def slides(self) -> bool:
        """Whether there is a ram, since the length of the lever is given."""
        return self.lever is not None

    @property
    def rotates(self) -> bool:
        """Whether the lever turns fully (e < r, Whitworth) instead of swinging."""
        return self.frame < self.crank

    @property
    def turns(self) -> bool:
        """Whether the output is the tilt of a lever that turns fully."""
        return self.rotates and not self.slides

    @property
    def ram_lever(self) -> RamLever | None:
        """The lever, where its fork head moves the ram."""
        if self.lever is None or math.isfinite(self.link):
            return None
        return RamLever(self.crank, self.frame, self.lever)

    @property
    def _end(self) -> float:
        """R_l in m, where there is a ram."""
        return self.lever or 0.0

    @cached_property
    def _kappa(self) -> tuple[float, float]:
        """κ, the shorter of r and e over the longer, and √(1 − κ²)."""
        shorter, longer = sorted((self.crank, self.frame))
        return shorter / longer, math.sqrt((longer - shorter) / longer * (1 + shorter / longer))

    @cached_property
    def _height(self) -> float:
        if self.ram_height is not None:
            return self.ram_height
        if self.rotates:
            return 0.0
        return self._end * (1 + self._kappa[1]) / 2

    # the lever, and the ram that it drives

    def _lever_at(self, angle: CrankAngle) -> Lever:
        """Return θ′ = r(r + e cos φ)/ρ², θ″ = −r e (e² − r²) sin φ/ρ⁴ and the rest of the lever at a crank angle.

        Sums that may cancel are those of e − r, as they were given, and 1 + cos φ.
        """
        crank, frame, gap = self.crank, self.frame, self.frame - self.crank
        reach = sqrt(gap * gap + 2 * crank * frame * angle.vercosine)
        along_crank = (frame * angle.vercosine - gap) / reach  # (r + e cos φ)/ρ
        bend = (
            -crank * frame * (gap * (crank + frame)) * angle.sin / (reach * reach * reach * reach)
        )
        sin, cos = crank * angle.sin / reach, (gap + crank * angle.vercosine) / reach
        return Lever(sin, cos, reach, crank * along_crank / reach, bend)

    def _ram(self, sin: Number, cos: Number) -> Ram:
        """Return the ram where the lever is at (sin θ, cos θ), by the link's angle γ, sin γ = (h − cos θ)/l.

            x = sin θ − l(1 − cos γ)      x′ = cos(θ + γ)/cos γ      −x″ = sin θ + cos θ tan γ + sin²θ/(l cos³γ)

        h and l are over R_l; a fork head is an infinite link, x = sin θ.
        """
        short = self._end / self.link  # 1/l
        height = self._height / self._end - cos
        rise = height * short
        run = sqrt((1 - rise) * (1 + rise))
        x = sin - height * rise / (1 + run)
        return Ram(
            x,
            cos - sin * (rise / run),
            sin + cos * (rise / run) + sin * sin * short / (run * run * run),
        )

    @cached_property
    def _limits(self) -> tuple[tuple[float, float], ...]:
        """(sin θ, cos θ) of the lever at the inner and the outer dead centre of the ram.

        The rotating lever is there in line with the link, folded behind and stretched ahead.
        """
        kappa, root = self._kappa
        if not self.rotates:
            return (-kappa, root), (kappa, root)
        # in line (R_l ∓ l) cos θ = h; both over l
        short = self._end / self.link
        height = self._height / self.link
        cos_folded = -height / (1 - short)
        cos_stretched = height / (1 + short)
        return (
            (-math.sqrt((1 - cos_folded) * (1 + cos_folded)), cos_folded),
            (math.sqrt((1 - cos_stretched) * (1 + cos_stretched)), cos_stretched),
        )

    def dead_centres(self) -> tuple[float, float]:
        """Return the ends of the working stroke, ∓(180° − β) with cos β = r/e (e/r for the rotating lever), R p. 615.

        With a link on the rotating lever they are where link and lever lie in line: φ = θ + arcsin(κ sin θ).
        """
        kappa, root = self._kappa
        if not self.rotates:
            end = 180.0 - bearing(root, kappa)
            return -end, end
        inner, outer = (
            bearing(sin, cos) + bearing(kappa * sin, sqrt(cos * cos + root * root * (sin * sin)))
            for sin, cos in self._limits
        )
        return inner, outer

    def swing_at(self, angle: CrankAngle) -> Turning:
        """Return how the lever turns; the rotating lever's θ runs on with φ from turn to turn."""
        lever, frame = self._lever_at(angle), self.frame
        if self.rotates:
            degrees = angle.degrees - bearing(frame * angle.sin, self.crank + frame * angle.cos)
        else:
            degrees = bearing(lever.sin, lever.cos)
        return Turning(degrees, lever.slope, lever.curvature)

    @property
    def swing(self) -> float | None:
        """2 arcsin(r/e) in degrees; None where the lever turns fully."""
        if self.rotates:
            return None
        return 2 * bearing(*self._kappa)

    @cached_property
    def _places(self) -> tuple[float, ...]:
        """Where the ram is in its dead centres, over R_l."""
        return tuple(float(self._ram(sin, cos).place) for sin, cos in self._limits)

    @property
    def stroke(self) -> float:
        """s = 2 R_l r/e (2 R_l for the rotating lever) with a fork head or a swinging lever; of θ without a ram."""
        if not self.slides:
            if self.swing is None:
                return math.tau
            return math.radians(self.swing)
        return self._end * (self._places[1] - self._places[0])

    @property
    def start(self) -> float:
        """−s/2: x, and θ of what swings, count from the middle of the stroke; where it turns fully from φ = 0."""
        if self.turns:
            return 0.0
        return -self.stroke / 2

    def coordinate(self, angle: CrankAngle) -> Number:
        """Return x of the ram in m from the middle of its stroke: R_l sin θ for the fork head; θ without a ram."""
        if not self.slides:
            return self.swing_at(angle).degrees * (math.pi / 180)
        lever = self._lever_at(angle)
        return self._end * (self._ram(lever.sin, lever.cos).place - sum(self._places) / 2)

    def slope(self, angle: CrankAngle) -> Number:
        """Return dx/dφ = R_l θ′ cos(θ + γ)/cos γ in m; for the fork head R_l r (r + e cos φ)(e + r cos φ)/ρ³."""
        lever = self._lever_at(angle)
        if self.slides:
            return self._end * (lever.slope * self._ram(lever.sin, lever.cos).lead)
        return lever.slope

    def curvature(self, angle: CrankAngle) -> Number:
        """Return d²x/dφ² = R_l [θ″ dx/dθ + θ′² d²x/dθ²] in m."""
        lever = self._lever_at(angle)
        if not self.slides:
            return lever.curvature
        ram = self._ram(lever.sin, lever.cos)
        return self._end * (lever.curvature * ram.lead - lever.slope * lever.slope * ram.bend)

    # the block on the crank pin

    def block_slope(self, angle: CrankAngle) -> Number:
        """Return dρ/dφ = −r e sin φ/ρ in m: times ω, the speed at which the block slides along the lever."""
        return -self.crank * self.frame * angle.sin / self._lever_at(angle).reach

    def pin_force_factor(self, angle: CrankAngle) -> Number | None:
        """Return the force on the crank pin, square to the lever, over the force P on the ram: (dx/dθ)/ρ."""
        if not self.slides:
            return None
        lever = self._lever_at(angle)
        return self._end * self._ram(lever.sin, lever.cos).lead / lever.reach

    def radial(self, angle: CrankAngle) -> Number | None:
        """Return D/P = −(force on the pin over P) (e sin φ)/ρ: the part of that force toward the shaft."""
        force = self.pin_force_factor(angle)
        if force is None:
            return None
        return -force * (self.frame * angle.sin / self._lever_at(angle).reach)

    # what readers see of it

    def sketch(self, angle: CrankAngle) -> Sketch:
        """Return the crank with its block on the lever, and the ram on its line, which is upright where φ = 0 lies."""
        lever, pivot = self._lever_at(angle), (-self.frame, 0.0)
        length = 1.1 * (self.crank + self.frame) if self.lever is None else self.lever
        joints, links = (
            {"pivot": pivot, "end": on_circle(length, lever.cos, lever.sin, pivot)},
            [("pivot", "end")],
        )
        more: dict[str, Any] = {"fixed": ("pivot",), "blocks": ((PIN, ("pivot", "end")),)}
        if self.slides:
            forked, half = math.isinf(self.link), self.stroke / 2
            line = pivot[0] + (length if forked else self._height)
            middle = 0.0 if forked else length * sum(self._places) / 2 + self.link
            joints["ram"] = (line, middle + self.coordinate(angle))
            links.append(("end", "ram"))
            more |= {
                "guides": (((line, middle - half), (line, middle + half)),),
                "output": "ram",
                "toward": (0.0, 1.0),
            }
        return Sketch.of_crank(self.crank, angle, joints, *links, **more)

    @property
    def lacks(self) -> tuple[tuple[str, str], ...]:
        """Name the forces of a link, the lever, and the pin where its size is not given."""
        lever = ("inertia of the lever", "kurbel takes masses on the ram only")
        if not self.slides:
            return ("ram", "no lever given"), lever
        link = (
            ()
            if math.isinf(self.link)
            else (("S, N", "the forces of the link on the ram are not computed"),)
        )
        if self.pin_diameter is not None:
            return (*link, lever)
        return (*link, lever, NO_PIN)

    @property
    def notes(self) -> tuple[str, ...]:
        """Say that the lever turns fully, where it does, and that the pin slides past its end, where it does."""
        sentences, farthest = [], self.frame + self.crank
        if self.rotates:
            sentences.append(
                "The frame is shorter than the crank: the lever turns fully (Whitworth quick return)."
            )
        if self.turns:
            sentences.append(
                "Without a lever's length the strokes are those of a ram square to the line of the pivots, on a fork "
                "head."
            )
        # a lever that turns fully may drive its ram by an arm on the other side of the pivot
        if self.lever is not None and not self.rotates and self.lever < farthest:
            sentences.append(
                f"The pin slides as far as {show(farthest, 'length')} from the lever's pivot, past its end at "
                f"{show(self.lever, 'length')}: the slot must go on beyond the joint with the ram."
            )
        return tuple(sentences)
