"""The pressure over the crank angle of a charge that burns by the function of Wiebe, and its heat release.

By the first law V dp + n p dV = (κ − 1) dQ, with n of the compression up to the chamber's dead centre and of the
expansion after it, and absolute p. V = z + c is the volume over the stroke volume V_s, z the fraction of the stroke and
c the clearance over V_s; q = (κ − 1) Q/V_s, with the heat Q to the gas in J per cycle:

    d(p V^n) = q V^(n−1) dx_b,     p = p₁ (V₁/V)^n + q/V (x_b − x₁ (V₁/V)^(n−1) − K V^(1−n)),

where 1 is the start of the compression, or of the expansion, and by parts K = (n − 1) ∫ x_b V^(n−2) dV from there on. Only K needs a
quadrature, of an integrand that begins with x_b and not with its slope: on pieces of the cycle, halved until it is a
polynomial on each.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import Any, ClassVar, Literal, NamedTuple

import numpy as np

from kurbel.arrays import Array, Flags, Indices, Number
from kurbel.crank_angle import CrankAngle
from kurbel.machine.batch import taken
from kurbel.machine.wiebe import Wiebe
from kurbel.mechanisms.setting import Setting
from kurbel.numerics.arithmetic import spread
from kurbel.numerics.extreme import Extreme, largest
from kurbel.numerics.pieces import Angles, Pieces, refined
from kurbel.solver.figures import result

CHORD = 1.0
"""Degrees over which rates are measured, as those of traces."""
_MARGIN = 10.0
"""Degrees before and after the heat release that a picture of it shows, too."""
_CENTRE = 360.0
"""Where the chamber's dead centre is in the pieces, which hold one compression before and one expansion after it."""


class StrokeStart(NamedTuple):
    """Where a stroke begins: n of p V^n, p in Pa, V over the volume of a stroke, x_b, K; of every angle or of all."""

    exponent: Any
    pressure: Any
    volume: Any
    burnt: Any
    integral: Any

    def pressure_at(self, heat: Any, volume: Any, burnt: Any, integral: Any) -> Any:
        """Return the absolute pressure in Pa at a volume; heat: q in Pa."""
        n = self.exponent
        ratio = self.volume / volume
        from_integral = (integral - self.integral) * volume ** (1 - n)
        gained = burnt - self.burnt * ratio ** (n - 1) - from_integral
        return self.pressure * ratio**n + heat / volume * gained


class WiebePressure:
    """Gauge pressure in one chamber that burns by Wiebe's function, or in those of many machines.

    traced: it is no trace; releases: but it has a heat release. area: of the piston in m²; starts: where the pressure
    bends or jumps.
    """

    traced: ClassVar[Literal[False]] = False
    releases: ClassVar[bool] = True
    by_stroke: ClassVar[Literal[False]] = False
    steep: ClassVar[bool] = False

    def __init__(self, card: Wiebe, setting: Setting, area: Number, count: int | None) -> None:
        self.card = card
        self.setting = setting
        self.count = count
        stroke_volume = area * setting.mechanism.stroke
        self._heat = (card.kappa - 1) * card.heat_to_gas / stroke_volume

        # the dead centres of the cycle, from that at which the chamber fires
        firing = setting.own_dead_centre
        inner, outer = setting.mechanism.dead_centres()
        opposite = outer if setting.head_end else inner + 360.0
        self.expansion = opposite - firing
        self._dead_centres: list[Number] = []
        for turn in range(round(setting.cycle / 360.0)):
            self._dead_centres += [firing + 360.0 * turn, opposite + 360.0 * turn]

        # the pieces of one compression and one expansion, with the integral K at their nodes
        self._machines = np.arange(count or 1)
        edges = [self.expansion - 360.0, card.start, card.start + card.duration, self.expansion]
        pieces = Pieces.between(self._angles(*edges, origin=_CENTRE), count or 1, 720.0)
        self._pieces, (growth,) = refined(pieces, lambda pieces: [self._growth_of_integral(pieces)])
        self._integral = self._pieces.running(growth)

        # where the pressure bends or jumps
        begin = firing + card.start
        breaks = [*self._dead_centres, begin, begin + card.duration]
        starts = self._angles(*breaks, origin=0.0)
        self.starts = Angles(starts.machine, np.mod(starts.degrees, setting.cycle))

    def _angles(self, *degrees: Number, origin: float) -> Angles:
        """Return angles of every machine, so many degrees after the origin, in order."""
        return _angles_of(len(self._machines), [origin + angle for angle in degrees])

    # the strokes of the process

    def _growth_of_integral(self, pieces: Pieces) -> Array:
        """Return dK/dφ, φ in radians, at the nodes of pieces."""
        card, z, slope, after = self._at_nodes(pieces)
        n = np.where(pieces.middle < _CENTRE, card.exponent, card.expansion_exponent)
        burnt = card.burnt(after, pieces.of(self.expansion))
        growth = (n - 1) * burnt * (z + card.clearance) ** (n - 2) * slope
        return np.where(self._are_inside(pieces), growth, 0.0)

    def _at_nodes(self, pieces: Pieces) -> tuple[Wiebe, Array, Array, Array]:
        """Return the cards of pieces, and at their nodes z, dz/dφ and the degrees after the dead centre."""
        card, setting = self._of(pieces.machine)
        angle = CrankAngle.at_nodes(pieces.by_crank(_CENTRE - self.setting.own_dead_centre))
        z, slope = _stroke_fraction(setting, angle)
        after = pieces.offsets + (pieces.right_angle - _CENTRE)
        return card, pieces.filled(z), pieces.filled(slope), after

    def _are_inside(self, pieces: Pieces) -> Flags:
        """Return which pieces are in the compression or the expansion."""
        expansion = pieces.of(self.expansion)
        after = pieces.middle - _CENTRE
        return (after > expansion - 360.0) & (after < expansion)

    def _of(self, machine: Indices | None) -> tuple[Wiebe, Setting]:
        """Return card and chamber of machines, their numbers one for every angle or piece."""
        if machine is None:
            return self.card, self.setting
        return taken((self.card, self.setting), machine)

    @cached_property
    def _compression(self) -> StrokeStart:
        """The beginning of the compression, of all machines."""
        card = self.card
        return StrokeStart(
            card.exponent, card.intake + self.setting.lift, 1 + card.clearance, 0.0, 0.0
        )

    @cached_property
    def _expansion(self) -> StrokeStart:
        """The beginning of the expansion, of all machines: where the compression ends."""
        card = self.card
        centres = np.full(len(self._machines), _CENTRE)
        burnt = self._result(card.burnt(centres - _CENTRE, self.expansion))
        integral = self._result(self._integral_at(centres, self._machines))
        pressure = self._compression.pressure_at(self._heat, card.clearance, burnt, integral)
        return StrokeStart(card.expansion_exponent, pressure, card.clearance, burnt, integral)

    def _closed(
        self, z: Array, after: Array, expands: Flags, integral: Array, machine: Indices | None
    ) -> Array:
        """Return the absolute pressure in Pa while the valves are closed, at degrees after the dead centre."""
        # where the stroke began
        begins = []
        for of_compression, of_expansion in zip(self._compression, self._expansion):
            compressing = spread(of_compression, machine)
            expanding = spread(of_expansion, machine)
            begins.append(np.where(expands, expanding, compressing))

        # what has burnt since
        card, _ = self._of(machine)
        burnt = card.burnt(after, spread(self.expansion, machine))
        heat = spread(self._heat, machine)
        return StrokeStart(*begins).pressure_at(heat, z + card.clearance, burnt, integral)

    def _lowered(self, absolute: Any, machine: Indices | None) -> Any:
        """Return gauge pressures in Pa of absolute ones, by the diagram factor κ_d: p_back + κ_d (p − p_back)."""
        card, setting = self._of(machine)
        back = card.back_pressure + setting.lift
        drawn = back + card.diagram_factor * (absolute - back)
        return drawn - (setting.lift + setting.base)

    # over the crank angle

    def at(
        self,
        z: Array,
        degrees: Array,
        within: Array,
        machine: Indices | None,
        remaining: Array | None = None,
    ) -> Array:
        """Return the gauge pressure in Pa where z of the stroke is passed, on the side of jumps that holds `within` (n,).

        z, degrees: (n,), or (nodes, n) of pieces; machine: of each, (n,); remaining: not needed.
        """
        # the stroke, and the degrees after the dead centre before which the chamber compresses
        cycle = self.setting.cycle
        first, *later = (spread(centre, machine) for centre in self._dead_centres)
        since = np.mod(within - first, cycle)
        stroke = np.zeros(since.shape, dtype=int)
        for centre in later:
            stroke = stroke + (since >= np.mod(centre - first, cycle))
        compresses = stroke == len(later)
        after = np.where(compresses, since - cycle, since) + (degrees - within)

        # the integral K, by the polynomials of its pieces
        fraction = z if self.setting.head_end else 1 - z
        expansion = spread(self.expansion, machine)
        closed = np.clip(after, expansion - 360.0, expansion)
        owners = np.broadcast_to(0 if machine is None else machine, after.shape)
        integral = self._integral_at(_CENTRE + closed, owners)
        absolute = self._closed(fraction, closed, ~compresses, integral, machine)

        # exhaust and intake
        if cycle == 720.0:
            card, setting = self._of(machine)
            absolute = np.where(stroke == 1, card.back_pressure + setting.lift, absolute)
            absolute = np.where(stroke == 2, card.intake + setting.lift, absolute)
        return np.asarray(self._lowered(absolute, machine))

    def _integral_at(self, degrees: Array, machine: Indices) -> Array:
        """Return the integral K at angles of the pieces of these machines, of any shape."""
        integral = self._pieces.at(self._integral, machine.ravel(), degrees.ravel())
        return integral.reshape(degrees.shape)

    @cached_property
    def _over_closed_strokes(self) -> tuple[Pieces, Array, Array]:
        """Pieces of compression and expansion, with absolute pressure in Pa and p dz/dφ at their nodes."""

        def sample(pieces: Pieces) -> list[Array]:
            _, z, slope, after = self._at_nodes(pieces)
            expands = pieces.middle > _CENTRE
            owners = np.broadcast_to(pieces.machine, after.shape)
            integral = self._integral_at(pieces.degrees, owners)
            p = self._closed(z, after, expands, integral, pieces.machine)
            inside = self._are_inside(pieces)
            return [np.where(inside, p, 0.0), np.where(inside, p * slope, 0.0)]

        pieces, (p, power) = refined(self._pieces, sample)
        return pieces, p, power

    @cached_property
    def highest(self) -> Extreme:
        """The highest gauge pressure in Pa, and the first crank angle in degrees of the cycle that has it."""
        pieces, p, _ = self._over_closed_strokes
        extremes = pieces.extremes([p])
        pressure = self._lowered(extremes.largest[0], None)
        top = Extreme(self._result(pressure), self._crank_angle(extremes.largest_at[0]))
        if self.setting.cycle != 720.0:
            return top
        exhaust = self._lowered(self.card.back_pressure + self.setting.lift, None)
        begin = np.mod(self._dead_centres[1], self.setting.cycle)
        return largest(top, Extreme(self._result(exhaust), self._result(begin)))

    def _crank_angle(self, degrees: Array) -> Any:
        """Return the crank angle within the cycle of angles (machines,) of the pieces."""
        angle = self.setting.own_dead_centre + degrees - _CENTRE
        return self._result(np.mod(angle, self.setting.cycle))

    def _result(self, values: Any) -> Any:
        """Return a number of one machine as a float, and of many as (machines,)."""
        return result(np.broadcast_to(values, self._machines.shape), self.count)

    @cached_property
    def area(self) -> Number:
        """∮ p dz over the stroke fraction z in Pa, per cycle."""
        pieces, _, power = self._over_closed_strokes
        work = pieces.integral(power)
        if self.setting.cycle == 720.0:
            work = work + (self.card.intake - self.card.back_pressure)
        area: Number = self._result(self.card.diagram_factor * work)
        return area

    # rates

    def rise(self, degrees: Array, machine: Indices | None = None) -> Array:
        """Return the rise of pressure (n,) in Pa per degree at crank angles (n,), over the degree around each."""
        ahead = self._at_angle(degrees + CHORD / 2, machine)
        behind = self._at_angle(degrees - CHORD / 2, machine)
        return (ahead - behind) / CHORD

    def _at_angle(self, degrees: Array, machine: Indices | None) -> Array:
        """Return the gauge pressure in Pa at crank angles."""
        _, setting = self._of(machine)
        mechanism = setting.mechanism
        passed = (mechanism.coordinate(CrankAngle.of(degrees)) - mechanism.start) / mechanism.stroke
        return self.at(passed, degrees, degrees, machine)

    @cached_property
    def steepest(self) -> Extreme:
        """Largest rise of pressure in Pa per degree, over one degree, while the valves are closed."""
        card = self.card
        edges = [card.start, card.start + card.duration, 0.0, self.expansion, self.expansion - 360]
        pieces = _pieces_of_chords(edges, len(self._machines))

        def sample(pieces: Pieces) -> list[Array]:
            after = pieces.middle - _CENTRE
            expansion = pieces.of(self.expansion)
            inside = (after > expansion - 360 + CHORD / 2) & (after < expansion - CHORD / 2)
            degrees = pieces.degrees - _CENTRE + pieces.of(self.setting.own_dead_centre)
            machine = np.broadcast_to(pieces.machine, degrees.shape).ravel()
            rises = self.rise(degrees.ravel(), machine).reshape(degrees.shape)
            return [np.where(inside, rises, 0.0)]

        fine, (rises,) = refined(pieces, sample)
        extremes = fine.extremes([rises])
        steepest = self._result(extremes.largest[0])
        return Extreme(steepest, self._crank_angle(extremes.largest_at[0]))

    def released(self, area: Number) -> WiebeHeat:
        """Return the heat released over the piston."""
        return WiebeHeat(self.card, self.expansion, self.count)


def _angles_of(count: int, degrees: Sequence[Number]) -> Angles:
    """Return these angles of every machine, each a number or (machines,)."""
    rows = [np.broadcast_to(angle, (count,)) for angle in degrees]
    by_machine = np.sort(np.stack(rows, axis=1), axis=1)
    return Angles(np.repeat(np.arange(count), len(rows)), by_machine.ravel())


def _pieces_of_chords(edges: Sequence[Number], count: int) -> Pieces:
    """Return pieces on which a rate over one degree is smooth, of what bends at these degrees after the dead centre."""
    ends = []
    for edge in edges:
        ends += [_CENTRE + edge - CHORD / 2, _CENTRE + edge + CHORD / 2]
    return Pieces.between(_angles_of(count, ends), count, 720.0)


def _stroke_fraction(setting: Setting, angle: CrankAngle) -> tuple[Array, Array]:
    """Return z from the chamber's smallest volume, and dz/dφ with φ in radians."""
    mechanism = setting.mechanism
    slope = mechanism.slope(angle) / mechanism.stroke
    if setting.head_end:
        return (mechanism.coordinate(angle) - mechanism.start) / mechanism.stroke, slope
    return mechanism.remaining(angle) / mechanism.stroke, -slope


class WiebeHeat:
    """The heat that a card by Wiebe releases per cycle: total in J, and over the degrees from the dead centre.

    supplied: that of the fuel, in J; expansion: degrees of crank angle of that stroke.
    """

    def __init__(self, card: Wiebe, expansion: Number, count: int | None) -> None:
        self.card = card
        self.expansion = expansion
        self.count = count
        last = card.burnt(np.broadcast_to(expansion, (count or 1,)), expansion)
        self._last: Number = result(last, count)
        self.supplied: Number = card.heat
        self.total: Number = card.heat_to_gas * self._last

    @property
    def span(self) -> tuple[Any, Any]:
        """The degrees from the firing dead centre between which heat is released, with a margin at either end."""
        last = self.expansion
        if not self.card.runs_on:
            last = np.minimum(self.card.start + self.card.duration + _MARGIN, last)
        return np.maximum(self.card.start - _MARGIN, self.expansion - 360.0), last

    def end_of_cycle(self, cycle: float) -> Number:
        """Return the degrees after the firing dead centre at which x_b falls to 0, in a cycle of so many."""
        return 360.0 if cycle == 720.0 else self.expansion

    def burnt_at(self, after: Array, machine: Indices | None = None) -> Array:
        """Return the burnt share x_b of what is released, at so many degrees after the firing dead centre."""
        card = self.card if machine is None else taken(self.card, machine)
        burnt = card.burnt(after, spread(self.expansion, machine)) / spread(self._last, machine)
        return np.asarray(burnt)

    def rate_at(self, after: Array, machine: Indices | None = None) -> Array:
        """Return the heat in J released over the degree around these angles, after the firing dead centre."""
        ahead = self.burnt_at(after + CHORD / 2, machine)
        behind = self.burnt_at(after - CHORD / 2, machine)
        return spread(self.total, machine) * (ahead - behind) / CHORD

    def angle_at(self, share: float) -> Any:
        """Return the angle in degrees after the firing dead centre at which so much of the heat is released."""
        return self.card.angle_at(share * self._last)

    @property
    def fastest(self) -> tuple[Any, Any]:
        """The largest heat in J that is released over one degree, and the angle in the middle of that."""
        card = self.card
        edges = [card.start, card.start + card.duration, self.expansion]
        pieces = _pieces_of_chords(edges, self.count or 1)

        def sample(pieces: Pieces) -> list[Array]:
            after = pieces.offsets + (pieces.right_angle - _CENTRE)
            return [self.rate_at(after, pieces.machine)]

        fine, (rates,) = refined(pieces, sample)
        extremes = fine.extremes([rates])
        top = result(extremes.largest[0], self.count)
        return top, result(extremes.largest_at[0] - _CENTRE, self.count)
