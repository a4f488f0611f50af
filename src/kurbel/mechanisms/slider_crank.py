"""Slider-crank, straight or offset (gerader und geschränkter Schubkurbeltrieb), R ch. 14 B, and in a yoke frame."""

import math
from collections.abc import Callable, Iterator
from functools import cached_property
from typing import Any

import numpy as np

from kurbel import crank_formulas as formulas
from kurbel.arrays import Array, Number
from kurbel.crank_angle import CrankAngle
from kurbel.declared.keys import Key
from kurbel.declared.record import FieldValue, Rule, ValuesByKey, alternative, field
from kurbel.mechanisms import (
    PIN,
    TURNING,
    Mechanism,
    Offer,
    Sketch,
    Turning,
    force_column,
    requested_column,
)
from kurbel.numerics.arithmetic import bearing, every, magnitude, some, sqrt, total, ulp, where
from kurbel.quantity import Quantity

_INFINITE = {"infinite": math.inf}


def crank_field() -> FieldValue:
    """Return the field of the crank radius of a mechanism that can be given by its stroke."""
    return field(
        "length",
        "Crank radius; or give `stroke`",
        "R",
        above=0,
        example="400 mm",
        also=("crank_radius", "crank_throw", "kurbelradius"),
    )


def stroke_instead(gives: Callable[[ValuesByKey], dict[str, object]]) -> Key:
    """Return the field of the stroke, given instead of the crank; gives: the crank, from all values by key."""
    return alternative(
        "length",
        "Stroke; or give `crank`",
        "s",
        above=0,
        instead="crank",
        gives=gives,
        key="stroke",
        also=("stroke_length", "hub", "kolbenhub"),
    )


def _book(
    id: str,
    kind: str,
    text: str,
    formula: Callable[[Number, Number, Number], Number],
    omega: int = 0,
) -> Offer:
    """Return the first-order approximation of a column; formula: for R = 1. With an offset the books have none."""

    def factor(mechanism: Any, angle: CrankAngle) -> Number | None:
        if not mechanism.straight:
            return None
        return mechanism.crank * formula(angle.sin, angle.cos, mechanism.lam)

    return requested_column(
        f"{id}_book", f"{id}_0", kind, f"{text}, first order in λ", factor, id, omega
    )


def _error(
    id: str,
    kind: str,
    formula: Callable[[CrankAngle, Number, Number], Number],
    omega: int = 0,
) -> Offer:
    """Return the error of the first-order approximation of a column; formula: for R = 1, takes the angle, cos ψ and λ.

    An infinite rod has none.
    """

    def factor(mechanism: Any, angle: CrankAngle) -> Number | None:
        if not mechanism.straight or every(mechanism.lam == 0):
            return None
        _, cos_psi = mechanism.rod_angle(angle)
        return mechanism.crank * formula(angle, cos_psi, mechanism.lam)

    quantity = Quantity(
        f"{id}_error",
        f"Δ{id}",
        kind,
        f"Error of the first order in λ: {id}_0 less {id}",
        commands=("motion",),
        extremes=("motion",),
        called=f"error of {id}_0",
        after=f"{id}_book",
        on_request=("motion",),
        of_book=True,
    )
    return Offer(quantity, factor, omega)


def _rod_turn(order: int) -> Offer:
    end, mark, kind, name = TURNING[order]
    text = f"{name} of the rod"
    return requested_column(
        f"psi{end}",
        f"ψ{mark}",
        kind,
        text,
        lambda mechanism, angle: -mechanism.coupler_at(angle)[order],
        "b",
        order,
    )


ROD_OFFERS: tuple[Offer, ...] = (
    _book(
        "x",
        "length",
        "Displacement R (1 − cos φ + ½ λ sin²φ) (R 286)",
        formulas.first_order_displacement,
    ),
    _book(
        "c",
        "velocity",
        "Velocity v (sin φ + ½ λ sin 2φ) (B 25)",
        formulas.first_order_velocity,
        omega=1,
    ),
    _book(
        "b",
        "acceleration",
        "Acceleration v²/R (cos φ + λ cos 2φ) (R 291)",
        formulas.first_order_acceleration,
        2,
    ),
    _error(
        "x",
        "length",
        lambda angle, cos_psi, lam: formulas.displacement_error(angle.sin, cos_psi, lam),
    ),
    _error(
        "c",
        "velocity",
        lambda angle, cos_psi, lam: formulas.velocity_error(angle.sin, angle.cos, cos_psi, lam),
        omega=1,
    ),
    _error(
        "b",
        "acceleration",
        lambda angle, cos_psi, lam: formulas.acceleration_error(angle.sin, angle.cos, cos_psi, lam),
        omega=2,
    ),
    _rod_turn(1),
    _rod_turn(2),
)


class SliderCrank(Mechanism):
    """A crank, a connecting rod and a crosshead on a straight guide.

    crank: R in m; rod: L in m, `math.inf` for the infinite rod; offset: e in m of the stroke line from the shaft axis,
    positive toward the side of the crank pin on the outstroke. sin ψ = (R sin φ − e)/L. The crank turns fully for
    L > R + |e|; otherwise RuleError is raised.
    """

    crank: float = crank_field()
    _stroke = stroke_instead(lambda keys: {"crank": _crank_of_stroke(keys)})
    rod: float = field(
        "length",
        "Length of the connecting rod, or `infinite`; or give `rod_ratio`",
        "L",
        above=0,
        words=_INFINITE,
        also=(
            "con_rod",
            "conrod",
            "connecting_rod",
            "rod_length",
            "conrod_length",
            "pleuel",
            "schubstange",
        ),
    )
    _rod_ratio = alternative(
        "ratio",
        "L/R; or give `rod`",
        "L/R",
        above=1,
        words=_INFINITE,
        instead="rod",
        example="5",
        usual="5 in horizontal machines, down to 4.5 and 4 in vertical ones (R p. 603)",
        gives=lambda keys: {"rod": keys["crank"] * keys["rod_ratio"]},
        key="rod_ratio",
    )
    offset: float = field(
        "length",
        "Offset of the stroke line from the shaft, positive toward the side of the crank pin on the outstroke; in an "
        "engine away from the thrust side, so that the rod is straighter on the power stroke, and negative for a "
        "piston pin set toward the thrust side",
        "e",
        default=0.0,
        also=("gudgeon_pin_offset", "wrist_pin_offset", "piston_pin_offset", "desaxe"),
    )

    name = "slider-crank"
    is_crank_drive = True
    has_rod = True
    OFFERS = ROD_OFFERS

    @classmethod
    def rules_of_keys(cls, keys: ValuesByKey) -> Iterator[Rule]:
        rod = keys.get("rod") if keys.get("rod") is not None else keys.get("rod_ratio")
        stroke, offset = keys.get("stroke"), keys.get("offset")
        if not (stroke is None or offset is None or rod is None):
            crank, reach = _crank_of_stroke(keys), stroke + offset + rod
            remedy = "no crank has this stroke with {offset:length} and such a rod; give a longer one, or less offset"
            yield Rule("offset", (crank != crank) & (reach == reach), remedy, keys)

    def rules(self) -> Iterator[Rule]:
        crank, rod, offset = self.crank, self.rod, abs(self.offset)
        # rounding: decimal lengths with L = R + |e| exactly may differ by this as floats; without an offset they do not
        rounding = where(self.offset == 0, 0.0, ulp(rod) + ulp(offset) / 2)
        short = np.isfinite(rod) & (total(rod, -crank, -offset) <= rounding)
        numbers = {"reach": offset}
        reach = "{rod} does not reach: it must be longer than crank and offset together ({crank} + {reach:length})"
        yield Rule("rod", short & np.not_equal(offset, 0), reach, numbers)
        straight = short & np.equal(offset, 0)
        fully = "the crank ({crank}); the crank turns fully only with a longer rod"
        yield Rule("rod", straight & (rod == crank), f"{{rod}} is no longer than {fully}")
        yield Rule("rod", straight & (rod < crank), f"{{rod}} is shorter than {fully}")

    @property
    def rod_length(self) -> float:
        """L in m, `math.inf` for the infinite rod."""
        return self.rod

    @cached_property
    def straight(self) -> bool:
        """Whether the stroke line passes through the shaft axis, or the rod is infinite."""
        return every(self.offset == 0) or every(self.rod == math.inf)

    @cached_property
    def _gaps(self) -> tuple[float, ...]:
        """(L − R + e)/L and (L − R − e)/L, the least 1 − sin ψ and 1 + sin ψ; (L + R + e)/L and (L + R − e)/L."""
        if every(self.rod == math.inf):
            return 1.0, 1.0, 1.0, 1.0
        gaps = []
        for crank in (-self.crank, self.crank):
            for offset in (self.offset, -self.offset):
                gaps.append(total(self.rod, crank, offset) / self.rod)
        return tuple(gaps)

    @cached_property
    def _reaches(self) -> tuple[float, float]:
        """√((L+R)² − e²)/L and √((L−R)² − e²)/L: the crosshead's distances from the shaft at the dead centres."""
        beyond, within, above, below = self._gaps
        return sqrt(above * below), sqrt(beyond * within)

    @cached_property
    def stroke(self) -> float:
        """s = √((L+R)² − e²) − √((L−R)² − e²) = 4LR/(their sum); 2R without offset."""
        if self.straight:
            return 2 * self.crank
        return self.crank * (4 / sum(self._reaches))

    def dead_centres(self) -> tuple[float, float]:
        """Return φ_i with sin φ_i = e/(L+R) and φ_o = 180° + arcsin(e/(L−R)), in degrees."""
        if self.straight:
            return 0.0, 180.0
        reach_at_inner, reach_at_outer = self._reaches
        rise = self.offset / self.rod
        return bearing(rise, reach_at_inner), 180.0 + bearing(rise, reach_at_outer)

    def rod_angle(self, angle: CrankAngle) -> tuple[Number, Number]:
        """Return (sin ψ, cos ψ) with sin ψ = (R sin φ − e)/L."""
        if angle.rod is not None:
            return angle.rod
        lam, gaps = self.lam, self._gaps
        if self.straight:  # 1 − λ² sin²φ without its cancellation
            return lam * angle.sin, sqrt(
                angle.cos * angle.cos + gaps[0] * gaps[2] * (angle.sin * angle.sin)
            )
        # 1 + |sin φ| and 1 − |sin φ|
        sum_of_sin = 1 + magnitude(angle.sin)
        rest_of_sin = angle.cos * angle.cos / sum_of_sin
        is_above = angle.sin >= 0
        # 1 − sin ψ and 1 + sin ψ, each as a gap plus λ(1 ∓ sin φ), both positive
        one_minus_sin_psi = gaps[0] + lam * where(is_above, rest_of_sin, sum_of_sin)
        one_plus_sin_psi = gaps[1] + lam * where(is_above, sum_of_sin, rest_of_sin)
        sin_psi = lam * angle.sin - self.offset / self.rod
        return sin_psi, sqrt(one_minus_sin_psi) * sqrt(one_plus_sin_psi)

    def coupler_at(self, angle: CrankAngle) -> Turning:
        """Return the rotation of the rod, whose direction from crank pin to crosshead is −ψ."""
        sin_psi, cos_psi = self.rod_angle(angle)
        slope = formulas.rod_slope(angle.cos, cos_psi, self.lam)
        curvature = formulas.rod_curvature(angle.sin, sin_psi, cos_psi, slope, self.lam)
        return Turning(bearing(-sin_psi, cos_psi), -slope, -curvature)

    def sketch(self, angle: CrankAngle) -> Sketch:
        """Return crank, rod and crosshead, whose line is e from the shaft; for an infinite rod a Scotch yoke."""
        if math.isinf(self.rod):
            return yoke_sketch(self.crank, angle)
        far = self.rod * self._reaches[0]
        return Sketch.of_crank(
            self.crank,
            angle,
            {"crosshead": (far - self.coordinate(angle), self.offset)},
            (PIN, "crosshead"),
            guides=(((far - self.stroke, self.offset), (far, self.offset)),),
            output="crosshead",
            toward=(-1.0, 0.0),
            across=(0.0, -1.0),
        )

    @cached_property
    def _start(self) -> CrankAngle:
        """The inner dead centre."""
        return CrankAngle.of(self.dead_centres()[0])

    @cached_property
    def _start_rod(self) -> tuple[Number, Number]:
        """The rod there."""
        return self.rod_angle(self._start)

    def coordinate(self, angle: CrankAngle) -> Number:
        """Return x = √((L+R)² − e²) − R cos φ − L cos ψ in m, R 285 where e = 0.

        With θ = φ − φ_i, m = (φ + φ_i)/2:  x = 2R sin(θ/2) [sin m + cos m (sin ψ + sin ψ_i)/(cos ψ + cos ψ_i)].
        """
        sin_psi, cos_psi = self.rod_angle(angle)
        if self.straight:  # (1 − cos φ) + (1 − cos ψ)/λ, as a sum of positive terms
            return self.crank * (angle.versine + self.lam * (angle.sin * angle.sin) / (1 + cos_psi))
        start, (sin_start, cos_start) = self._start, self._start_rod
        # sine and cosine of θ/2, both possibly with the opposite sign, which cancels in the products below
        sin, cos = (
            angle.sin * start.cos - angle.cos * start.sin,
            angle.cos * start.cos + angle.sin * start.sin,
        )
        large = sqrt((1 + magnitude(cos)) / 2)
        small = sin / (2 * large)
        half_sin, half_cos = where(cos >= 0, small, large), where(cos >= 0, large, small)
        middle_sin = start.sin * half_cos + start.cos * half_sin
        middle_cos = start.cos * half_cos - start.sin * half_sin
        lead = (sin_psi + sin_start) / (cos_psi + cos_start)
        return self.crank * (2 * half_sin * (middle_sin + middle_cos * lead))

    def remaining(self, angle: CrankAngle) -> Number:
        """Return s − x in m; without offset R(1 + cos φ)(1 − λ(1 − cos φ)/(1 + cos ψ)), without cancellation."""
        if not self.straight:
            return super().remaining(angle)
        lead = self.lam * angle.versine / (1 + self.rod_angle(angle)[1])
        return self.crank * (angle.vercosine * (1 - lead))

    def _lead(self, angle: CrankAngle, cos_psi: Number) -> Number:
        """Return cos ψ + λ cos φ without cancellation, for e = 0; for cos φ < 0 as (1 − λ²)/(cos ψ − λ cos φ)."""
        sum_of_both = cos_psi + self.lam * magnitude(angle.cos)
        return where(angle.cos >= 0, sum_of_both, self._gaps[0] * self._gaps[2] / sum_of_both)

    def slope(self, angle: CrankAngle) -> Number:
        """Return dx/dφ = R sin(φ+ψ)/cos ψ in m, R 288; without offset R sin φ (cos ψ + λ cos φ)/cos ψ."""
        sin_psi, cos_psi = self.rod_angle(angle)
        if self.straight:
            return self.crank * (angle.sin * self._lead(angle, cos_psi) / cos_psi)
        return self.crank * (angle.sin + angle.cos * sin_psi / cos_psi)

    def curvature(self, angle: CrankAngle) -> Number:
        """Return d²x/dφ² = R [cos(φ+ψ)/cos ψ + λ cos²φ/cos³ψ] in m: exact, where R 291 is its first-order form.

        For e = 0 as R [cos φ (cos ψ + λ cos φ)/cos ψ − λ (1 − λ²) sin²φ/cos³ψ], whose terms have one sign for
        cos φ < 0.
        """
        sin_psi, cos_psi = self.rod_angle(angle)
        cube = cos_psi * cos_psi * cos_psi
        if self.straight:
            bend = self.lam * self._gaps[0] * self._gaps[2] * (angle.sin * angle.sin) / cube
            return self.crank * (angle.cos * self._lead(angle, cos_psi) / cos_psi - bend)
        bend = self.lam * (angle.cos * angle.cos) / cube
        return self.crank * (angle.cos - angle.sin * sin_psi / cos_psi + bend)

    def radial(self, angle: CrankAngle) -> Number:
        """Return D/P = cos(φ+ψ)/cos ψ, R 302."""
        sin_psi, cos_psi = self.rod_angle(angle)
        return angle.cos - angle.sin * (sin_psi / cos_psi)

    def crank_angles_at(self, displacement: Array, outstroke: bool) -> Array:
        """Return the crank angles in degrees at which x (n,) in m is passed on the outstroke or the return stroke.

        From the triangle shaft, pin, crosshead by half angles, accurate near the dead centres. In closed form, since
        every point of a card over the stroke needs it, and a search takes fifty times as long.
        """
        # x and stroke over R; lengths from here on over L
        lam = self.lam
        passed = displacement / self.crank
        stroke = self.stroke / self.crank
        eps = self.offset / self.rod
        at_inner, at_outer = self._reaches
        # the crosshead from the foot of the shaft axis, and from the shaft
        distance = at_inner - lam * passed
        line = np.hypot(distance, eps)
        # (1 + λ − line)/λ and (line + λ − 1)/λ, each from a difference of squares
        before = passed * (2 * at_inner - lam * passed) / (1 + lam + line)
        after = (stroke - passed) * (distance + at_outer) / (line + 1 - lam)
        # half the angle at the shaft, by its tangent
        half = np.arctan2(np.sqrt(before * (1 + line - lam)), np.sqrt(after * (line + lam + 1)))
        lead = np.degrees(np.arctan2(eps, distance))
        sweep = np.degrees(2 * half)
        if outstroke:
            return lead + sweep
        return 360.0 + lead - sweep


def yoke_sketch(crank: float, angle: CrankAngle) -> Sketch:
    """Return a crank whose block slides in an upright yoke, and the rod that this moves."""
    x = crank * angle.cos
    return Sketch.of_crank(
        crank,
        angle,
        {
            "top": (x, 1.2 * crank),
            "bottom": (x, -1.2 * crank),
            "yoke": (x, 0.0),
            "rod": (x + 2 * crank, 0.0),
        },
        ("bottom", "top"),
        ("yoke", "rod"),
        blocks=((PIN, ("bottom", "top")),),
        guides=(((crank, 0.0), (3 * crank, 0.0)),),
        output="rod",
        toward=(-1.0, 0.0),
        across=(0.0, -1.0),
    )


def _crank_of_stroke(keys: ValuesByKey) -> Number:
    """Solve s = √((L+R)² − e²) − √((L−R)² − e²) for R, with L given or L = kR; nan where there is none."""
    half, rod, k, offset = (
        keys["stroke"] / 2,
        keys.get("rod"),
        keys.get("rod_ratio"),
        keys.get("offset") or 0.0,
    )
    length: Any = k if rod is None else rod
    straight = np.equal(offset, 0) | np.isinf(length)
    if np.all(straight):
        return half
    with np.errstate(all="ignore"):
        if k is None:
            between = np.asarray((rod - half) * (rod + half))
            share = np.sqrt(1 - offset * offset / np.where(between > 0, between, 0.0))
        else:
            # k² u² − (1 + k²) u + (ε² + 1) = 0 for u = (R/half)², ε = e/half; the root that is 1 for ε = 0
            square = k * k
            root = (square - 1) ** 2 - 4 * square * (offset / half) ** 2
            share = np.sqrt((1 + square + np.sqrt(root)) / (2 * square))
    crank = np.where(straight, half, half * share)
    if crank.ndim:
        return crank
    return float(crank)


# Yoke-frame small crank drive (Klein, Schanzlin & Becker), R p. 614: steam and pump piston rod lie in one line, joined
# by a frame in which rod and crank move. The side force N of the rod finds no guide and bends the piston rod.


def _stress(state: Any, along: float, across: float) -> Any:
    """Return along · P/A + across · M_b/W of the piston rod at the crank end; None without it, force or gland."""
    pistons, arm = state.drive.cylinder.pistons, state.mechanism.bending_arm(state.posed)
    if state.N is None or arm is None or not pistons or not some(pistons[0].crank_end_rod != 0):
        return None
    diameter = pistons[0].crank_end_rod
    return (4 * along * state.P + 32 * across * state.N * arm / diameter) / (
        math.pi * diameter * diameter
    )


def _stress_column(id: str, symbol: str, text: str, along: float, across: float) -> Offer:
    return force_column(
        id, symbol, "stress", text, lambda *_: 1.0, lambda state: _stress(state, along, across)
    )


BENDING_OFFERS = (
    force_column(
        "M_bend",
        "M_b",
        "torque",
        "Bending moment of N on the piston rod, at its stuffing box",
        lambda drive, angle: drive.bending_arm(angle),
        lambda state: state.N,
    ),
    _stress_column("sigma_bend", "σ_b", "Bending stress of the piston rod, by M_b", 0.0, 1.0),
    _stress_column(
        "sigma_rod",
        "σ_KS",
        "Stress of the piston rod on the side that M_b > 0 compresses, by P and M_b, compression positive",
        1.0,
        1.0,
    ),
    _stress_column(
        "sigma_rod_other",
        "σ_KS2",
        "Stress of the piston rod on the other side, by P and M_b",
        1.0,
        -1.0,
    ),
)


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

    name = "yoke-frame"
    guided = False
    OFFERS = (*SliderCrank.OFFERS, *BENDING_OFFERS)
    notes = ("There is no crosshead guide: the side force N bends the piston rod (R p. 614).",)

    def bending_arm(self, angle: CrankAngle) -> Number | None:
        """Return l_g + x in m, on which N bends the piston rod at the stuffing box; None where `gland` is not given.

        The rod is taken as held by this stuffing box alone, which is on the safe side.
        """
        if self.gland is None:
            return None
        return self.gland + self.coordinate(angle)

    @property
    def lacks(self) -> tuple[tuple[str, str], ...]:
        """Name the bending of the piston rod, where its arm is not known."""
        if self.gland is not None:
            return ()
        return (("bending of the piston rod", "no gland given"),)
