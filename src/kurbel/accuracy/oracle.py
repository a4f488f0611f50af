"""The crank train once more, as the textbooks write it, in Decimal: what the references are computed from.

Nothing is shared with the solver: angles are reduced, pressures found and signs of friction chosen anew. Differences of
nearly equal numbers are left as they stand in the books; the digits of the decimal context pay for them.
"""

from collections.abc import Iterator
from decimal import Decimal
from functools import cached_property, lru_cache
from itertools import pairwise
from math import isinf
from typing import Any, NamedTuple

from kurbel.accuracy.decimals import Function, arcsin, pi, root, sin_cos
from kurbel.accuracy.given import End, Given
from kurbel.machine import Cylinder, Machine
from kurbel.mechanisms import Mechanism


class Position(NamedTuple):
    """Where a slider-crank stands: its coordinate x in m, dx/dφ, d²x/dφ², and sine and cosine of the rod angle."""

    coordinate: Decimal
    slope: Decimal
    curvature: Decimal
    sin_psi: Decimal
    cos_psi: Decimal


class CrankMotion:
    """R 285, 288, 291 (exact) with R, L, e in m; an infinite rod has no offset."""

    def __init__(self, crank: float, rod: float, offset: float = 0.0) -> None:
        self.crank = Decimal(crank)
        self.rod = None if isinf(rod) else Decimal(rod)
        self.offset = Decimal(offset) if self.rod is not None else Decimal(0)
        self.at = lru_cache(maxsize=4096)(self._at)

    @classmethod
    def of(cls, mechanism: Mechanism) -> "CrankMotion":
        """Return that of a slider-crank, or of a Scotch yoke, its rod infinite."""
        return cls(mechanism.crank, mechanism.rod_length, mechanism.offset)

    def _at(self, degrees: Decimal) -> Position:
        """Return x, dx/dφ, d²x/dφ² and the rod angle at a crank angle in degrees."""
        sin, cos = sin_cos(degrees)
        r = self.crank
        if self.rod is None:
            return Position(r * (1 - cos), r * sin, r * cos, Decimal(0), Decimal(1))
        aside = r * sin - self.offset
        along = (self.rod**2 - aside**2).sqrt()
        tilt = r * cos * aside / along
        bend = (r * r * cos * cos - aside * r * sin) / along + tilt * tilt / along
        return Position(
            ((self.rod + r) ** 2 - self.offset**2).sqrt() - r * cos - along,
            r * sin + tilt,
            r * cos + bend,
            aside / self.rod,
            along / self.rod,
        )

    @cached_property
    def stroke(self) -> Decimal:
        """s in m."""
        if self.rod is None:
            return 2 * self.crank
        far, near = ((self.rod + sign * self.crank) ** 2 - self.offset**2 for sign in (1, -1))
        return far.sqrt() - near.sqrt()

    @cached_property
    def dead_centres(self) -> tuple[Decimal, Decimal]:
        """sin φ_i = e/(L+R), sin(φ_o − 180°) = e/(L−R), in degrees."""
        if self.rod is None or not self.offset:
            return Decimal(0), Decimal(180)
        outer = 180 + arcsin(self.offset / (self.rod - self.crank))
        return arcsin(self.offset / (self.rod + self.crank)), outer

    def angle_at(self, fraction: Decimal, outstroke: bool) -> Decimal:
        """Return the crank angle in degrees at which this fraction of the stroke is passed."""
        inner, outer = self.dead_centres
        low, high = (inner, outer) if outstroke else (outer, inner + 360)
        if fraction in (0, 1):
            return low if (fraction == 0) == outstroke else high
        return root(lambda degrees: self.at(degrees).coordinate / self.stroke - fraction, low, high)


class Segment(NamedTuple):
    """Part of a line of a card between two stroke fractions; exponent: n of p V^n, or None for a straight line."""

    z: Decimal
    p: Decimal
    next_z: Decimal
    next_p: Decimal
    exponent: Decimal | None


class Chamber:
    """One end of a cylinder with a card. Gauge pressures in Pa."""

    def __init__(self, end: End) -> None:
        self.area: Decimal = end.area
        self.head_end = end.head_end
        self._lift: Decimal = end.lift
        self._base: Decimal = end.base
        self._clearance = None if end.card.interpolate == "linear" else Decimal(end.card.clearance)
        self.lines = tuple(tuple(self._segments(line)) for line in end.card.lines)

    def _segments(self, line: Any) -> Iterator[Segment]:
        points = [(Decimal(z), Decimal(p)) for z, p in zip(line.fractions, line.pressures)]
        for (z, p), (next_z, next_p) in pairwise(points):
            if z != next_z:
                yield Segment(z, p, next_z, next_p, self._exponent(z, p, next_z, next_p))

    def _exponent(self, z: Decimal, p: Decimal, next_z: Decimal, next_p: Decimal) -> Decimal | None:
        if self._clearance is None:
            return None
        volumes = (next_z + self._clearance) / (z + self._clearance)
        return ((p + self._lift) / (next_p + self._lift)).ln() / volumes.ln()

    def pressure(self, stroke: int, fraction: Decimal, within: Decimal) -> Decimal:
        """Return the pressure at a fraction of the piston's stroke, on the segment that holds the fraction `within`."""
        line = self.lines[(stroke if self.head_end else stroke - 1) % len(self.lines)]
        z, inside = (fraction, within) if self.head_end else (1 - fraction, 1 - within)
        segment = next((s for s in line if min(s.z, s.next_z) <= inside <= max(s.z, s.next_z)), line[-1])
        return self.on(segment, z)

    def on(self, segment: Segment, z: Decimal) -> Decimal:
        """Return the pressure on a segment."""
        if segment.exponent is None or self._clearance is None:
            rise = (segment.next_p - segment.p) / (segment.next_z - segment.z)
            return segment.p - self._base + rise * (z - segment.z)
        volumes = (segment.z + self._clearance) / (z + self._clearance)
        return (segment.p + self._lift) * volumes**segment.exponent - self._lift - self._base

    def corners(self, stroke: int) -> Iterator[Decimal]:
        """Yield the fractions of the piston's stroke at which the card bends or jumps."""
        for segment in self.lines[(stroke if self.head_end else stroke - 1) % len(self.lines)]:
            yield segment.z if self.head_end else 1 - segment.z


def why_not(cylinder: Cylinder) -> str:
    """Return why there is no independent calculation of a cylinder's forces, or an empty text."""
    from kurbel.machine.indicator import Card

    if why := why_no_motion(cylinder):
        return why
    chambers = [chamber for piston in cylinder.pistons for chamber in piston.chambers.values()]
    if not all(isinstance(chamber, Card) for chamber in chambers):
        return "no independent calculation of traces and ideal cards"
    if cylinder.masses and cylinder.masses.connecting_rod and cylinder.masses.connecting_rod.exact:
        return "no independent calculation of a rod given by its centre of gravity"
    return "no independent calculation of a ram force" if cylinder.ram_force else ""


def why_no_motion(cylinder: Cylinder) -> str:
    """Return why there is no independent calculation of a cylinder's motion, or an empty text."""
    name = cylinder.mechanism.name
    known = ("slider-crank", "scotch-yoke", "yoke-frame")
    return "" if name in known else f"no independent calculation of the {name}"


class CylinderOracle:
    """Forces of one cylinder; angles in degrees of its own crank."""

    def __init__(self, machine: Machine, cylinder: Cylinder) -> None:
        self.motion = CrankMotion.of(cylinder.mechanism)
        given = Given(machine, cylinder, Decimal)
        self.turns = given.turns
        self.omega = None if machine.speed is None else 2 * pi() * Decimal(machine.speed)
        self.chambers = tuple(map(Chamber, given.ends))
        self.mass: Decimal = given.mass if self.omega is not None else Decimal(0)
        self.turning_inertia: Decimal = given.turning_inertia
        sin, cos = sin_cos(Decimal(given.lean or 0))
        self.weight: Decimal = given.weight * sin
        self.guide_weight: Decimal = given.weight * cos
        self.friction: Decimal = given.crosshead
        self.rings: Decimal = given.steady_friction

    def stroke_number(self, within: Decimal) -> int:
        """Return how many dead centres lie between the first inner one of the cycle and an angle."""
        inner, outer = self.motion.dead_centres
        since = _modulo(within - inner, 360 * self.turns)
        turn = int(since // 360)
        return 2 * turn + (since - 360 * turn >= outer - inner)

    def gas_force(self, degrees: Decimal, within: Decimal) -> Decimal:
        """Return p_H A_H − p_C A_C of all pistons in N."""
        stroke, motion = self.stroke_number(within), self.motion
        share, inside = motion.at(degrees).coordinate / motion.stroke, motion.at(within).coordinate / motion.stroke
        return sum(
            (c.area * c.pressure(stroke, share, inside) * (1 if c.head_end else -1) for c in self.chambers), Decimal(0)
        )

    def force(self, degrees: Decimal, within: Decimal) -> Decimal:
        """Return P in N: gas, inertia, weight."""
        inertia = self.mass * self.motion.at(degrees).curvature * (self.omega or 0) ** 2
        return self.gas_force(degrees, within) - inertia + self.weight

    def _direction(self, within: Decimal) -> int:
        return -1 if self.stroke_number(within) % 2 else 1

    def guide_sense(self, degrees: Decimal, within: Decimal) -> Decimal:
        """Return P sin ψ + G cos ψ in N, after the rings."""
        at = self.motion.at(degrees)
        push = self.force(degrees, within) - self._direction(within) * self.rings
        return push * at.sin_psi + self.guide_weight * at.cos_psi

    def drag(self, degrees: Decimal, within: Decimal) -> Decimal:
        """Return f |N| in N, D 3."""
        if not self.friction:
            return Decimal(0)
        at, lifted = self.motion.at(degrees), self.guide_sense(degrees, within)
        side = 1 if self.guide_sense(within, within) >= 0 else -1
        return abs(self.friction * lifted / (at.cos_psi + self._direction(within) * side * self.friction * at.sin_psi))

    def torque(self, degrees: Decimal, within: Decimal) -> Decimal:
        """Return M in N m."""
        lost = self._direction(within) * (self.drag(degrees, within) + self.rings)
        return (self.force(degrees, within) - lost) * self.motion.at(degrees).slope

    @cached_property
    def breaks(self) -> tuple[Decimal, ...]:
        """Angles from the first inner dead centre through one cycle at which a force bends or jumps."""
        found: set[Decimal] = set()
        inner = self.motion.dead_centres[0]
        for stroke in range(2 * self.turns):
            turn, outstroke = 360 * (stroke // 2), stroke % 2 == 0
            corners = {Decimal(0), Decimal(1)} | {z for c in self.chambers for z in c.corners(stroke)}
            found |= {self.motion.angle_at(z, outstroke) + turn for z in corners}
        angles = apart(sorted(found | {inner + 360 * self.turns}))
        return apart(sorted({*angles, *self._guide_turns(angles)})) if self.friction else angles

    def _guide_turns(self, angles: tuple[Decimal, ...]) -> Iterator[Decimal]:
        """Yield the angles at which the guide force changes sides."""
        for low, high in pairwise(angles):
            yield from sign_changes(self.guide_sense, low, high)


def sign_changes(function: Any, low: Decimal, high: Decimal, parts: int = 24) -> Iterator[Decimal]:
    """Yield the roots of function(degrees, within) inside one piece, looked for at equal steps."""
    within = (low + high) / 2
    ends = [low + (high - low) * k / parts for k in range(parts + 1)]
    values = [function(end, within) for end in ends]
    for k in range(parts):
        if values[k] * values[k + 1] < 0:
            at: Function = lambda degrees: function(degrees, within)  # noqa: E731
            yield root(at, ends[k], ends[k + 1])


def apart(angles: list[Decimal]) -> tuple[Decimal, ...]:
    """Leave out angles that differ from their neighbour by rounding only."""
    kept = angles[:1]
    for angle in angles[1:]:
        if angle - kept[-1] > Decimal("1e-20"):
            kept.append(angle)
    return tuple(kept)


def _modulo(value: Decimal, period: int) -> Decimal:
    rest = value % period
    return rest + period if rest < 0 else rest
