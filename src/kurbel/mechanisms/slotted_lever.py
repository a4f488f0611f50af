"""Slotted lever (schwingende Kurbelschleife): the quick return of shapers, R p. 615, and Whitworth's rotating lever."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, ClassVar, NamedTuple

from kurbel.crank_angle import CrankAngle
from kurbel.declared.record import Rule, field
from kurbel.declared.unit_systems import show
from kurbel.mechanisms import KeyOffer, Mechanism, Offer, finite
from kurbel.mechanisms.crank_pin import BLOCK_OFFERS, NO_PIN, pin_diameter, pin_length, pin_pressure, sum_along
from kurbel.mechanisms.ram import ConnectingLink, Direction, ForkHead
from kurbel.mechanisms.sketch import PIN, SHAFT, Sketch, on_circle
from kurbel.mechanisms.swing import SWING_OFFERS, SWING_VALUES, Swing
from kurbel.numerics.arithmetic import bearing, sqrt
from kurbel.numerics.extreme import Extreme


class _Lever(NamedTuple):
    """The lever at a crank angle: its direction, and the pin's distance from the pivot over the longer of r and e."""

    sin: Any
    cos: Any
    reach: Any


@dataclass(frozen=True, eq=False, repr=False)
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

    crank: float = field("length", "Crank radius", "r", above=0, required=True)
    frame: float = field("length", "Distance of the lever's pivot from the shaft", "e", above=0, required=True)
    lever: float | None = field(
        "length", "Length of the lever, pivot to end", "R_l", above=0, absent="angles and times only: no ram"
    )
    link: float = field(
        "length",
        "Length of the connecting link from the lever's end to the ram",
        "l",
        default=math.inf,
        above=0,
        words=(("infinite", math.inf),),
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

    name: ClassVar[str] = "slotted-lever"
    OFFERS: ClassVar[tuple[Offer, ...]] = (*SWING_OFFERS, *BLOCK_OFFERS)
    KEY_OFFERS: ClassVar[tuple[KeyOffer, ...]] = (*SWING_VALUES, pin_pressure())
    quick_return: ClassVar[bool] = True

    def rules(self) -> Iterator[Rule]:
        yield from finite(self, "crank", "frame", "lever")
        yield from self.contradictions()
        hanging = not (self.slides or self._forked)
        yield Rule("link", hanging, "has no lever's end to hang on; give 'lever' with it")
        yield from finite(self, "pin_diameter", "pin_length")
        same = "{frame} is also the crank: the pin would pass through the lever's pivot"
        yield Rule("frame", self.crank == self.frame, same)
        fork = self._forked and self.ram_height is not None
        yield Rule("ram_height", fork, "has no meaning for a fork head; give 'link' with it")
        yield from finite(self, "ram_height")
        lengths = (self.crank, self.frame, self.lever or 0.0, self.ram_height or 0.0)
        if not hanging and all(map(math.isfinite, lengths)) and self.crank != self.frame:
            fault = "" if self._forked else self._full_turn_fault() if self.rotates else self._swing_fault()
            yield Rule("link", bool(fault), f"{{link}} {fault}")

    def _full_turn_fault(self) -> str:
        if math.fsum((self.link, -self._end, -abs(self._height))) > 0:
            return ""
        arms = f"{show(self._end, 'length')} + {show(abs(self._height), 'length')}"
        return f"does not reach: as the lever turns fully it must be longer than lever and ram_height together ({arms})"

    def _swing_fault(self) -> str:
        farthest = max(abs(self._height - self._end), abs(self._height - self._end * self._kappa[1]))
        if self.link <= farthest:
            height = show(self._height, "length")
            return f"does not reach the ram at {height}; it must be longer than {show(farthest, 'length')}"
        if min(self._ram.lead(sin, cos) for sin, cos in self._limits) <= 0:
            return "gets into line with the lever within its swing; give a longer link or another ram_height"
        return ""

    @property
    def slides(self) -> bool:
        """Whether there is a ram, since the length of the lever is given."""
        return self.lever is not None

    @property
    def turns(self) -> bool:
        """Whether the output is the tilt of a lever that turns fully."""
        return self.rotates and not self.slides

    @property
    def _end(self) -> float:
        """R_l in m, where there is a ram."""
        assert self.lever is not None
        return self.lever

    @property
    def rotates(self) -> bool:
        """Whether the lever turns fully (e < r, Whitworth) instead of swinging."""
        return self.frame < self.crank

    @property
    def _forked(self) -> bool:
        return math.isinf(self.link)

    @property
    def _shares(self) -> tuple[float, float, float]:
        """r, e and e − r, over the longer of r and e."""
        longer = max(self.crank, self.frame)
        return self.crank / longer, self.frame / longer, (self.frame - self.crank) / longer

    @property
    def _kappa(self) -> tuple[float, float]:
        """κ, the shorter of r and e over the longer, and √(1 − κ²)."""
        crank, frame, gap = self._shares
        return min(crank, frame), math.sqrt(abs(gap) * (crank + frame))

    @property
    def _ram(self) -> ForkHead | ConnectingLink:
        return ForkHead() if self._forked else ConnectingLink(self.link / self._end, self._height / self._end)

    @property
    def _limits(self) -> tuple[Direction, Direction]:
        """(sin θ, cos θ) of the lever at the inner and the outer dead centre of the ram."""
        kappa, root = self._kappa
        return self._ram.ends if self.rotates else ((-kappa, root), (kappa, root))

    @property
    def _height(self) -> float:
        if self.ram_height is not None:
            return self.ram_height
        return 0.0 if self.rotates or not self.slides else self._end * (1 + self._kappa[1]) / 2

    def dead_centres(self) -> tuple[float, float]:
        """Return the ends of the working stroke, ∓(180° − β) with cos β = r/e (e/r for the rotating lever), R p. 615.

        With a link on the rotating lever they are where link and lever lie in line: φ = θ + arcsin(κ sin θ).
        """
        kappa, root = self._kappa
        if self._forked or not self.rotates:
            end = 180.0 - bearing(root, kappa)
            return -end, end
        ends = [bearing(sin, cos) + bearing(kappa * sin, self._cos_shift(sin, cos)) for sin, cos in self._limits]
        return ends[0], ends[1]

    def _cos_shift(self, sin: Any, cos: Any) -> Any:
        """√(1 − κ² sin²), from cosine and sine of one angle."""
        root = self._kappa[1]
        return sqrt(cos * cos + root * root * (sin * sin))

    def _lever_at(self, angle: CrankAngle) -> _Lever:
        crank, frame, gap = self._shares
        reach = sqrt(gap * gap + 2 * crank * frame * angle.vercosine)
        return _Lever(crank * angle.sin / reach, sum_along(frame, crank, gap, angle) / reach, reach)

    def sketch(self, angle: CrankAngle) -> Sketch:
        """Return the crank with its block on the lever, and the ram on its line, which is upright where φ = 0 lies."""
        lever, pivot = self._lever_at(angle), (-self.frame, 0.0)
        length = 1.1 * (self.crank + self.frame) if self.lever is None else self.lever
        end = on_circle(length, lever.cos, lever.sin, pivot)
        joints = {SHAFT: (0.0, 0.0), PIN: on_circle(self.crank, angle.cos, angle.sin), "pivot": pivot, "end": end}
        links: tuple[tuple[str, ...], ...] = ((SHAFT, PIN), ("pivot", "end"))
        blocks, fixed = ((PIN, ("pivot", "end")),), (SHAFT, "pivot")
        if not self.slides:
            return Sketch(joints, links, fixed, blocks)
        line = pivot[0] + (length if self._forked else self._height)
        middle = 0.0 if self._forked else length * (self._middle + self.link / length)
        joints["ram"] = (line, middle + self.coordinate(angle))
        guide = ((line, middle - self.stroke / 2), (line, middle + self.stroke / 2))
        return Sketch(joints, (*links, ("end", "ram")), fixed, blocks, (guide,), "ram", (0.0, 1.0))

    def swing_at(self, angle: CrankAngle) -> Swing:
        """Return θ, θ′ = r(r + e cos φ)/ρ² and θ″ = −r e (e² − r²) sin φ/ρ⁴, with ρ the pin's distance from the pivot.

        The rotating lever's θ runs on with φ from turn to turn.
        """
        crank, frame, _ = self._shares
        lever = self._lever_at(angle)
        degrees = bearing(lever.sin, lever.cos)
        if self.rotates:
            degrees = angle.degrees - bearing(frame * angle.sin, crank + frame * angle.cos)
        return Swing(degrees, *self._turning(angle, lever))

    def _turning(self, angle: CrankAngle, lever: _Lever) -> tuple[Any, Any]:
        """Return θ′ and θ″, pure arithmetic as the rest."""
        crank, frame, gap = self._shares
        square = lever.reach * lever.reach
        bend = -crank * frame * (gap * (crank + frame)) * angle.sin / (square * square)
        return crank * sum_along(crank, frame, -gap, angle) / square, bend

    @property
    def stroke(self) -> float:
        """s = 2 R_l r/e (2 R_l for the rotating lever) with a fork head or a swinging lever; of θ without a ram."""
        if not self.slides:
            return math.tau if self.swing is None else math.radians(self.swing)
        if not self.rotates:
            return 2 * self._end * self._kappa[0]
        inner, outer = (self._ram.place(sin, cos) for sin, cos in self._limits)
        return self._end * float(outer - inner)

    @property
    def start(self) -> float:
        """−s/2: x, and θ of what swings, count from the middle of the stroke; where it turns fully from φ = 0."""
        return 0.0 if self.turns else -self.stroke / 2

    @property
    def swing(self) -> float | None:
        """2 arcsin(r/e) in degrees; None where the lever turns fully."""
        return None if self.rotates else 2 * bearing(*self._kappa)

    def coordinate(self, angle: CrankAngle) -> Any:
        """Return x of the ram in m from the middle of its stroke: R_l sin θ for the fork head; θ without a ram."""
        if not self.slides:
            return self.swing_at(angle).degrees * (math.pi / 180)
        lever = self._lever_at(angle)
        place = self._ram.place(lever.sin, lever.cos)
        return self._end * (place if self._forked else place - self._middle)

    @property
    def _middle(self) -> float:
        """The middle of the stroke, as the ram counts its place."""
        return sum(float(self._ram.place(sin, cos)) for sin, cos in self._limits) / 2

    def slope(self, angle: CrankAngle) -> Any:
        """Return dx/dφ = R_l θ′ cos(θ + γ)/cos γ in m; for the fork head R_l r (r + e cos φ)(e + r cos φ)/ρ³."""
        lever = self._lever_at(angle)
        if not self.slides:
            return self._turning(angle, lever)[0]
        return self._end * (self._turning(angle, lever)[0] * self._ram.lead(lever.sin, lever.cos))

    def curvature(self, angle: CrankAngle) -> Any:
        """Return d²x/dφ² in m; for the fork head with u = er(1 + cos φ), g = (e − r)²

        −R_l r sin φ [g(g + 3er) + u(g + u)]/ρ⁵, whose terms are all positive.
        """
        if not self.slides:
            return self._turning(angle, self._lever_at(angle))[1]
        if not self._forked:
            return self._curvature_with_link(angle)
        crank, frame, gap = self._shares
        reach, beyond = self._lever_at(angle).reach, crank * frame * angle.vercosine
        inside = gap * gap * (gap * gap + 3 * crank * frame) + beyond * (gap * gap + beyond)
        square = reach * reach
        return -self._end * crank * angle.sin * (inside / (square * square * reach))

    def _curvature_with_link(self, angle: CrankAngle) -> Any:
        """d²x/dφ² = R_l [θ″ cos(θ + γ)/cos γ − θ′² (sin θ + cos θ tan γ + (R_l/l) sin²θ/cos³γ)]."""
        lever, ram = self._lever_at(angle), self._ram
        slope, curvature = self._turning(angle, lever)
        bent = slope * slope * ram.bend(lever.sin, lever.cos)
        return self._end * (curvature * ram.lead(lever.sin, lever.cos) - bent)

    def pin_force_factor(self, angle: CrankAngle) -> Any:
        """Return the force on the crank pin, square to the lever, over the force P on the ram: (dx/dθ)/ρ."""
        if not self.slides:
            return None
        lever = self._lever_at(angle)
        return self._end / max(self.crank, self.frame) * self._ram.lead(lever.sin, lever.cos) / lever.reach

    def radial(self, angle: CrankAngle) -> Any:
        """Return D/P = −(force on the pin over P) (e sin φ)/ρ: the part of that force toward the shaft."""
        if not self.slides:
            return None
        lever, frame = self._lever_at(angle), self._shares[1]
        return -self.pin_force_factor(angle) * (frame * angle.sin / lever.reach)

    @property
    def lacks(self) -> tuple[tuple[str, str], ...]:
        """Name the forces of a link, the lever, and the pin where its size is not given."""
        lever = ("inertia of the lever", "kurbel takes masses on the ram only")
        if not self.slides:
            return ("ram", "no lever given"), lever
        link = () if self._forked else (("S, N", "the forces of the link on the ram are not computed"),)
        return (*link, lever) if self.pin_diameter is not None else (*link, lever, NO_PIN)

    def block_slope(self, angle: CrankAngle) -> Any:
        """Return dρ/dφ = −r e sin φ/ρ in m: times ω, the speed at which the block slides along the lever."""
        _, frame, _ = self._shares
        return -self.crank * frame * angle.sin / self._lever_at(angle).reach

    def velocity_extremes(self) -> tuple[Extreme, ...]:
        """Return dx/dφ at 0°, R_l r/(e + r), R 304, and at 180°, −R_l r/|e − r|, R 305; fork head only."""
        if not self._forked or not self.slides:
            return ()
        crank, frame, gap = self._shares
        return Extreme(self._end * crank / (crank + frame), 0.0), Extreme(-self._end * crank / abs(gap), 180.0)

    @property
    def notes(self) -> tuple[str, ...]:
        """Say that the lever turns fully, where it does, and that the pin slides past its end, where it does."""
        whitworth = "The frame is shorter than the crank: the lever turns fully (Whitworth quick return)."
        times = (
            "Without a lever's length the strokes are those of a ram square to the line of the pivots, on a fork head."
        )
        return (whitworth,) * self.rotates + (times,) * self.turns + self._slot_notes()

    def _slot_notes(self) -> tuple[str, ...]:
        farthest = self.frame + self.crank
        if self.lever is None or self.rotates or self.lever >= farthest:
            return ()
        # a lever that turns fully may drive its ram by an arm on the other side of the pivot
        return (
            f"The pin slides as far as {show(farthest, 'length')} from the lever's pivot, past its end at "
            f"{show(self.lever, 'length')}: the slot must go on beyond the joint with the ram.",
        )
