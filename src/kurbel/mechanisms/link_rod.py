"""A piston on a link rod, whose knuckle pin is on the big end of a master rod, as in radial engines.

The plane normal to the shaft in complex numbers, angles positive in the sense of rotation. In the frame of the link's
own stroke line, g = e^{iΓ} with the angle Γ from the master's stroke line to this one, p = e^{iφ}:

    s = (R Im(pg) − e_m)/L      c = √(1 − s²)      the master rod lies at e^{−iψ}, sin ψ = s
    a = k e^{i(κ−Γ)}(c − i s)   z = R p + a        knuckle pin, from the shaft
    x = X(φ_i) − X              X = Re z + √(l² − (Im z − e)²)
"""

from __future__ import annotations

from collections.abc import Iterator
from functools import cached_property
from typing import Any, ClassVar, NamedTuple

import numpy as np

from kurbel.arrays import Array, Number
from kurbel.crank_angle import CrankAngle, unit_vector
from kurbel.declared.record import Rule, field
from kurbel.mechanisms import PIN, Mechanism, Offer, Sketch, Turning, force_column
from kurbel.mechanisms.slider_crank import ROD_OFFERS, SliderCrank
from kurbel.numerics.arithmetic import bearing, sqrt
from kurbel.numerics.search import bracketed_roots

_TURNS: Array = np.linspace(0.0, 359.5, 720)
"""Crank angles in degrees at which a link rod is looked at to see whether it reaches and how often it turns back."""
_SEARCHED = 60.0
"""Degrees to either side of 0° and 180° within which a dead centre is."""


class Knuckle(NamedTuple):
    """The knuckle pin at a crank angle, complex in m: its arm from the crank pin, its place, and the derivatives of it.

    cos_master, slope_master: cos ψ and ψ′ of the master rod.
    """

    arm: Any
    place: Any
    speed: Any
    acceleration: Any
    cos_master: Any
    slope_master: Any


class Link(NamedTuple):
    """The link rod: sine and cosine of its angle ψ_l, and ψ_l′, ψ_l″."""

    sin: Any
    cos: Any
    slope: Any
    curvature: Any


def _force_on_knuckle(state: Any) -> Any:
    force = state.knuckle_force
    if force is None:
        return None
    return np.abs(force)


LINK_OFFERS: tuple[Offer, ...] = (
    *(offer for offer in ROD_OFFERS if not offer.quantity.id.endswith(("_book", "_error"))),
    force_column(
        "F_knuckle",
        "F_An",
        "force",
        "Force of the link rod on its knuckle pin",
        lambda link, angle: 1.0,
        force=_force_on_knuckle,
    ),
)


class LinkedPiston(Mechanism):
    """A piston on a link rod. crank: R in m, of its master.

    master: the slider-crank of its master rod; between: Γ, from the master's stroke line to this one; angle: κ, at the
    crank pin from the master rod to the knuckle pin, both in degrees in the sense of rotation; radius: k, crank pin to
    knuckle pin; length: l of the link rod; own_offset: e of its stroke line; in m. Raises RuleError for a link rod
    that does not reach, or turns back more than twice a turn.
    """

    master: SliderCrank
    between: float
    length: float = field("length", "Length of the link rod", "l", above=0)
    radius: float = field("length", "Distance of the knuckle pin from the crank pin", "k", above=0)
    angle: float = 0.0
    own_offset: float = 0.0

    name = "link-rod"
    has_rod = True
    OFFERS = LINK_OFFERS
    lam: ClassVar[Any] = 0.0
    """A link rod has no ratio by which the books approximate its motion."""

    def rules(self) -> Iterator[Rule]:
        # all angles of all machines
        angles = CrankAngle.of(_TURNS[:, None])
        rises = np.abs(self._knuckle_at(angles).place.imag - self.own_offset)
        farthest = rises.max(axis=0)
        with np.errstate(invalid="ignore"):
            goes_out = self.slope(angles) > 0
        changes = np.count_nonzero(goes_out != np.roll(goes_out, 1, axis=0), axis=0)
        if not self._is_batch:
            farthest, changes = farthest.item(), changes.item()
        is_short = np.less_equal(self.length, farthest)
        message = "it does not reach: it needs more than {farthest:length}"
        yield Rule("length", is_short, message, {"farthest": farthest})
        turns_back = np.greater(changes, 2) & np.logical_not(is_short)
        yield Rule("radius", turns_back, "with it the piston turns back more than twice a turn")

    @property
    def offset(self) -> float:
        """Distance e in m of its stroke line from the shaft."""
        return self.own_offset

    @property
    def rod_length(self) -> float:
        """Length l in m of the link rod."""
        return self.length

    @cached_property
    def _line(self) -> Any:
        """g = e^{iΓ}."""
        return unit_vector(self.between)

    def _knuckle_at(self, angle: CrankAngle) -> Knuckle:
        """Return the knuckle pin at the crank angle, in the frame of the own stroke line."""
        R, L = self.crank, self.master.rod
        pin = angle.cos + 1j * angle.sin
        seen = pin * self._line

        # the master rod: sin ψ, ψ′ and ψ″
        sin = (R * seen.imag - self.master.offset) / L
        cos = sqrt((1 - sin) * (1 + sin))
        slope = R * seen.real / (L * cos)
        bend = (sin * slope * slope - R * seen.imag / L) / cos

        # the knuckle pin turns with it, by −ψ
        arm = self.radius * unit_vector(self.angle - self.between) * (cos - 1j * sin)
        speed = 1j * (R * pin - slope * arm)
        acceleration = -R * pin - (slope * slope + 1j * bend) * arm
        return Knuckle(arm, R * pin + arm, speed, acceleration, cos, slope)

    def _link(self, knuckle: Knuckle) -> Link:
        """Return how the link rod lies: sin ψ_l = (Im z − e)/l."""
        length = self.length
        sin = (knuckle.place.imag - self.own_offset) / length
        cos = sqrt((1 - sin) * (1 + sin))
        slope = knuckle.speed.imag / (length * cos)
        curvature = (knuckle.acceleration.imag / length + sin * slope * slope) / cos
        return Link(sin, cos, slope, curvature)

    def _height(self, angle: CrankAngle) -> Number:
        """Return X, the distance in m of the piston pin from the shaft along its stroke line."""
        knuckle = self._knuckle_at(angle)
        height: Number = knuckle.place.real + self.length * self._link(knuckle).cos
        return height

    @cached_property
    def _ends(self) -> tuple[Any, Any]:
        """Inner and outer dead centre in degrees: roots of x′ near 0° and 180°."""

        def slope_at(degrees: Array) -> tuple[Array, Array]:
            angle = CrankAngle.of(degrees)
            radian = np.pi / 180
            return np.asarray(self.slope(angle)), np.asarray(self.curvature(angle)) * radian

        shape = np.shape(self.slope(CrankAngle.of(np.zeros(1))))
        ends = []
        for middle in (0.0, 180.0):
            low = np.full(shape, middle - _SEARCHED)
            high = np.full(shape, middle + _SEARCHED)
            root = bracketed_roots(slope_at, low, high, slope_at(low)[0], slope_at(high)[0])
            ends.append(root if self._is_batch else float(root[0]))
        return ends[0], ends[1]

    @cached_property
    def _is_batch(self) -> bool:
        """Whether its numbers are those of many machines."""
        numbers = (self.crank, self.length, self.radius, self.angle, self.own_offset, self.between)
        masters = (self.master.crank, self.master.rod, self.master.offset)
        return any(np.ndim(number) > 0 for number in (*numbers, *masters))

    def dead_centres(self) -> tuple[float, float]:
        """Return where the piston turns back, in degrees, 0° where the crank pin passes its stroke line."""
        return self._ends

    @cached_property
    def _reach(self) -> Number:
        """X at the inner dead centre, in m."""
        return self._height(CrankAngle.of(self.dead_centres()[0]))

    @cached_property
    def stroke(self) -> Any:
        """X(φ_i) − X(φ_o) in m."""
        return self._reach - self._height(CrankAngle.of(self.dead_centres()[1]))

    def coordinate(self, angle: CrankAngle) -> Number:
        """Return x = X(φ_i) − X in m."""
        return self._reach - self._height(angle)

    def slope(self, angle: CrankAngle) -> Number:
        """Return x′ = l s_l ψ_l′ − Re z′ in m."""
        knuckle = self._knuckle_at(angle)
        link = self._link(knuckle)
        slope: Number = self.length * link.sin * link.slope - knuckle.speed.real
        return slope

    def curvature(self, angle: CrankAngle) -> Number:
        """Return x″ = l (c_l ψ_l′² + s_l ψ_l″) − Re z″ in m."""
        knuckle = self._knuckle_at(angle)
        link = self._link(knuckle)
        turned = link.cos * link.slope * link.slope + link.sin * link.curvature
        curvature: Number = self.length * turned - knuckle.acceleration.real
        return curvature

    def rod_angle(self, angle: CrankAngle) -> tuple[Number, Number]:
        """Return (sin ψ_l, cos ψ_l) of the link rod."""
        if angle.rod is not None:
            return angle.rod
        link = self._link(self._knuckle_at(angle))
        return link.sin, link.cos

    def coupler_at(self, angle: CrankAngle) -> Turning:
        """Return how the link rod turns, whose direction from knuckle pin to piston pin is −ψ_l."""
        link = self._link(self._knuckle_at(angle))
        return Turning(bearing(-link.sin, link.cos), -link.slope, -link.curvature)

    # forces

    def knuckle_motion(self, angle: CrankAngle) -> tuple[Any, Any]:
        """Return dz/dφ and d²z/dφ² of the knuckle pin in m, complex in the frame of the own stroke line."""
        knuckle = self._knuckle_at(angle)
        return knuckle.speed, knuckle.acceleration

    def knuckle_place(self, angle: CrankAngle) -> Any:
        """Return z of the knuckle pin in m, complex in the frame of the own stroke line."""
        return self._knuckle_at(angle).place

    def turning_on_master(self, angle: CrankAngle) -> Number:
        """Return ψ_l′ − ψ′, at which the link rod turns on its knuckle pin."""
        knuckle = self._knuckle_at(angle)
        turning: Number = self._link(knuckle).slope - knuckle.slope_master
        return turning

    def master_direction(self, angle: CrankAngle) -> Any:
        """Return g* e^{−iψ}, the direction of the master rod in the frame of the own stroke line."""
        knuckle = self._knuckle_at(angle)
        arm = self.radius * unit_vector(self.angle - self.between)
        return np.conj(self._line) * (knuckle.arm / arm)

    def moment_on_master(self, angle: CrankAngle, force: Any) -> Number:
        """Return M_K = Im(a* Q) in N m of a force Q in N on the knuckle pin, complex in the own frame."""
        moment: Number = (np.conj(self._knuckle_at(angle).arm) * force).imag
        return moment

    def force_on_pin(self, angle: CrankAngle, force: Any) -> Any:
        """Return E e^{−iφ} = (Q − i M_K g*/(L cos ψ)) e^{−iφ}: what reaches the crank pin of a force on the knuckle pin.

        The side force that M_K takes from the master's guide is the link's.
        """
        knuckle = self._knuckle_at(angle)
        moment = (np.conj(knuckle.arm) * force).imag
        side = moment / (self.master.rod * knuckle.cos_master)
        through = force - 1j * side * np.conj(self._line)
        return through * (angle.cos - 1j * angle.sin)

    def radial(self, angle: CrankAngle) -> Number:
        """Return D/P, the radial force at the crank pin of a piston force alone."""
        sin, cos = self.rod_angle(angle)
        radial: Number = -self.force_on_pin(angle, -(1 - 1j * sin / cos)).real
        return radial

    def sketch(self, angle: CrankAngle) -> Sketch:
        """Return crank, the arm to the knuckle pin, link rod and piston, whose line is e from the shaft."""
        knuckle = self._knuckle_at(angle).place
        far = float(self._reach)
        offset = self.own_offset
        joints: dict[str, Any] = {
            "knuckle": (knuckle.real, knuckle.imag),
            "crosshead": (far - self.coordinate(angle), offset),
        }
        return Sketch.of_crank(
            self.crank,
            angle,
            joints,
            (PIN, "knuckle"),
            ("knuckle", "crosshead"),
            guides=(((far - self.stroke, offset), (far, offset)),),
            output="crosshead",
            toward=(-1.0, 0.0),
            across=(0.0, -1.0),
        )
