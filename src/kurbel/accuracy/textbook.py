"""References: the crank train as textbooks write it, in mpmath's numbers.

Nothing is shared with the solver: pressures are found and signs of friction chosen anew. Differences of nearly equal
numbers are left as they are in the books; the digits pay for them. Angles are in radians of the own crank, all else in
SI. `at` is any angle within a piece between corners: it selects the side of a corner.
"""

import math
from bisect import bisect_right
from collections.abc import Callable, Sequence
from functools import cache, partial
from itertools import accumulate, pairwise
from typing import Any, NamedTuple

import mpmath
from mpmath.calculus.quadrature import GaussLegendre

from kurbel.machine import CYCLES, Cylinder, Machine
from kurbel.machine.indicator import Card
from kurbel.mechanisms import Mechanism

mp, mpf = mpmath.mp, mpmath.mpf
DIGITS = 40
Number = Any
"""An mpf, or in `stance` a float or an array of either."""
Function = Callable[[Number, Number], Number]
"""Takes an angle, and one within its piece."""


class Stance(NamedTuple):
    """A slider-crank: x, dx/dφ and d²x/dφ² in m, sine and cosine of the rod angle."""

    x: Number
    slope: Number
    curvature: Number
    sin_psi: Number
    cos_psi: Number


def stance(r: Number, length: Number, e: Number, sin: Number, cos: Number, sqrt: Callable[[Number], Number]) -> Stance:
    """Return the motion at a crank angle, R 285, 288, 291, of a crank r, a rod and an offset e in m."""
    if math.isinf(length):
        return Stance(r * (1 - cos), r * sin, r * cos, 0 * sin, 0 * sin + 1)
    aside = r * sin - e
    along = sqrt(length**2 - aside**2)
    swing = r * cos * aside / along
    x = sqrt((length + r) ** 2 - e**2) - r * cos - along
    curvature = r * cos + (r**2 * cos**2 - aside * r * sin + swing**2) / along
    return Stance(x, r * sin + swing, curvature, aside / length, along / length)


class TextbookMotion:
    """Motion of a slider-crank, or of a Scotch yoke, whose rod is infinite."""

    def __init__(self, mechanism: Mechanism) -> None:
        self.r, self.rod, self.offset = mpf(mechanism.crank), mpf(mechanism.rod_length), mpf(0)
        self.dead_centres = mpf(0), +mp.pi
        if not math.isinf(self.rod):
            self.offset = mpf(mechanism.offset)
            inner, outer = self.offset / (self.rod + self.r), self.offset / (self.rod - self.r)
            self.dead_centres = mp.asin(inner), mp.pi + mp.asin(outer)
        self.stroke = self.at(self.dead_centres[1]).x

    def at(self, phi: Number) -> Stance:
        """Return the motion at a crank angle."""
        return stance(self.r, self.rod, self.offset, mp.sin(phi), mp.cos(phi), mp.sqrt)

    def angles_at(self, fraction: Number) -> tuple[Number, Number]:
        """Return the crank angles of the outstroke and of the return at a fraction of the stroke."""
        line, cosine = mpf(0), 1 - 2 * fraction
        if not math.isinf(self.rod):  # law of cosines for crank, rod and the line from the shaft to the crosshead
            along = mp.sqrt((self.rod + self.r) ** 2 - self.offset**2) - fraction * self.stroke
            distance = mp.hypot(along, self.offset)
            cosine = (self.r**2 + distance**2 - self.rod**2) / (2 * self.r * distance)
            line = mp.asin(self.offset / distance)
        beyond = mp.acos(min(max(cosine, -1), 1))
        return line + beyond, line + 2 * mp.pi - beyond


class Forces(NamedTuple):
    """dx/dφ in m; in N the gas force, P, what lifts the crosshead from its guide, and the friction along x."""

    slope: Number
    gas: Number
    push: Number
    lift: Number
    friction: Number

    @property
    def torque(self) -> Number:
        """M in N m, inertia at uniform speed included."""
        return (self.push - self.friction) * self.slope


class TextbookCylinder:
    """Forces of one cylinder, in pieces between the corners of its cards."""

    def __init__(self, machine: Machine, cylinder: Cylinder) -> None:
        self.motion, self.turns = TextbookMotion(cylinder.mechanism), CYCLES[machine.cycle_of(cylinder)]
        self.omega, self._ambient = 2 * mp.pi * mpf(machine.speed or 0.0), mpf(machine.ambient)
        masses, friction, lean = cylinder.masses, cylinder.friction, machine.inclination_of(cylinder)
        rod = masses.connecting_rod if masses else None
        rod_mass, share = (mpf(rod.mass), mpf(rod.share)) if rod else (mpf(0), mpf(0))
        self.mass = mpf(masses.parts if masses else 0.0) + rod_mass * share
        self.turning_inertia = rod_mass * (1 - share) * self.motion.r**2
        weight, angle = self.mass * mpf(0 if lean is None else "9.80665"), mp.radians(mpf(lean or 0.0))
        self._weight, self._side_weight = weight * mp.sin(angle), weight * mp.cos(angle)

        self._crosshead = mpf((friction and cylinder.mechanism.has_rod and friction.crosshead) or 0.0)
        self._rings = mpf((friction and friction.constant) or 0.0)
        if friction and (rings := friction.rings):
            surface = rings.count * mp.pi * mpf(cylinder.pistons[0].bore) * mpf(rings.height)
            self._rings += surface * mpf(rings.pressure) * mpf(rings.coefficient)

        self._chambers: list[tuple[Card, int, Number, Number]] = []  # sign of the force, area, to absolute pressures
        for piston in cylinder.pistons:
            lift = mpf(0) if piston.indicator and piston.indicator.absolute else self._ambient
            for end, card in piston.chambers.items():
                assert isinstance(card, Card)
                head, ratio = end == "head_end", piston.lever_ratio
                thickness = mpf(piston.head_end_rod if head else piston.crank_end_rod)
                area = mp.pi / 4 * (mpf(piston.bore) ** 2 - thickness**2) * abs(mpf(ratio))
                self._chambers.append((card, 1 if head == (ratio > 0) else -1, area, lift))

        self._cut(self._corners())
        if self._crosshead:
            self._cut(merged([*self.edges, *roots(lambda phi, at: self.forces(phi, at).lift, self.edges)]))

    def _corners(self) -> list[Number]:
        """Return the angles from the first inner dead centre through one cycle at which a card bends or jumps."""
        found = [self.motion.dead_centres[0] + 2 * mp.pi * self.turns]
        for stroke in range(2 * self.turns):
            turn, back = divmod(stroke, 2)
            found.append(self.motion.dead_centres[back] + 2 * mp.pi * turn)
            for card, sign, _, _ in self._chambers:
                places = map(mpf, card.lines[(stroke - (sign < 0)) % len(card.lines)].fractions)
                inside = (place if sign > 0 else 1 - place for place in places if 0 < place < 1)
                found += [self.motion.angles_at(fraction)[back] + 2 * mp.pi * turn for fraction in inside]
        return merged(found)

    def _cut(self, edges: list[Number]) -> None:
        """Take the edges of pieces; find on each its direction, the lines of its cards, and the side of the guide."""
        self.edges, self._starts = edges, [float(edge - edges[0]) for edge in edges[:-1]]
        middles = [(low + high) / 2 for low, high in pairwise(edges)]
        self._direction, self._pressures = [], []
        for middle in middles:
            turn, since = divmod(float(middle - edges[0]), 2 * math.pi)
            back = since > self.motion.dead_centres[1] - self.motion.dead_centres[0]
            self._direction.append(-1 if back else 1)
            fraction = self.motion.at(middle).x / self.motion.stroke
            self._pressures.append([self._segment(one, 2 * int(turn) + back, fraction) for one in self._chambers])
        self._side = self._direction
        self._side = [1 if self.forces(middle, middle).lift >= 0 else -1 for middle in middles]

    def _segment(
        self, chamber: tuple[Card, int, Number, Number], stroke: int, fraction: Number
    ) -> tuple[Number, Number, Number]:
        """Return place, absolute pressure there, and slope or exponent, of a card at a fraction of the stroke."""
        card, sign, _, lift = chamber
        line = card.lines[(stroke - (sign < 0)) % len(card.lines)]
        points = list(zip(line.fractions, line.pressures))[:: 1 if line.start == 0 else -1]
        place = fraction if sign > 0 else 1 - fraction
        (z, p), (next_z, next_p) = next(two for two in pairwise(points) if two[0][0] < place < two[1][0])
        z, p, next_z, next_p = mpf(z), mpf(p) + lift, mpf(next_z), mpf(next_p) + lift
        if card.interpolate == "linear":
            return z, p, (next_p - p) / (next_z - z)
        clearance = mpf(card.clearance)  # p (z + clearance)^n is constant
        return z, p, mp.log(p / next_p) / mp.log((next_z + clearance) / (z + clearance))

    def forces(self, phi: Number, at: Number) -> Forces:
        """Return the forces at a crank angle."""
        piece = bisect_right(self._starts, float(at - self.edges[0]) % (2 * math.pi * self.turns)) - 1
        motion, gas = self.motion.at(phi), mpf(0)
        for (card, sign, area, _), (z, pressure, rise) in zip(self._chambers, self._pressures[piece]):
            place = motion.x / self.motion.stroke if sign > 0 else 1 - motion.x / self.motion.stroke
            if card.interpolate == "linear":
                pressure = pressure + rise * (place - z)
            else:
                pressure = pressure * ((z + mpf(card.clearance)) / (place + mpf(card.clearance))) ** rise
            gas += sign * area * (pressure - self._ambient)
        push = gas - self.mass * self.omega**2 * motion.curvature + self._weight
        direction = self._direction[piece]
        lift = (push - direction * self._rings) * motion.sin_psi + self._side_weight * motion.cos_psi
        leaning = motion.cos_psi + direction * self._side[piece] * self._crosshead * motion.sin_psi
        friction = direction * (self._crosshead * abs(lift / leaning) + self._rings)
        return Forces(motion.slope, gas, push, lift, friction)


class TextbookMachine:
    """The turning effort of all cylinders at the angles of crank 1."""

    def __init__(self, machine: Machine) -> None:
        cycle = 2 * mp.pi * machine.revolutions
        self.cylinders = [(TextbookCylinder(machine, one), mp.radians(one.crank_position)) for one in machine.cylinders]
        found = [mpf(0), cycle]
        for one, position in self.cylinders:
            starts = [position + 2 * mp.pi * turn for turn in range(0, machine.revolutions, one.turns)]
            found += [(angle + start) % cycle for angle in one.edges[:-1] for start in starts]
        self.edges = merged(found)

    def torque(self, phi: Number, at: Number) -> Number:
        """Return M in N m."""
        return mp.fsum(one.forces(phi - place, at - place).torque for one, place in self.cylinders)


# searches and integrals between corners


def merged(angles: Sequence[Number]) -> list[Number]:
    """Return angles in order, without those that differ from the one before by rounding only."""
    found = sorted(angles)
    return [found[0], *(high for low, high in pairwise(found) if high - low > mpf("1e-27"))]


def roots(function: Function, edges: Sequence[Number], parts: int = 24) -> list[Number]:
    """Return the roots inside the pieces, looked for at equal steps."""
    found = []
    for low, high in pairwise(edges):
        middle = (low + high) / 2
        places = [low + (high - low) * step / parts for step in range(parts + 1)]
        values = [function(place, middle) for place in places]
        for (a, b), (f_a, f_b) in zip(pairwise(places), pairwise(values)):
            if (f_a > 0) != (f_b > 0):
                along = partial(lambda middle, phi: function(phi, middle), middle)
                found.append(
                    mp.findroot(along, (a, b), solver="anderson", verify=False, maxsteps=300) if f_a and f_b else b
                )
    return found


def extremes(function: Function, edges: Sequence[Number]) -> tuple[Number, Number]:
    """Return the largest and the smallest value, from the ends of the pieces and the roots of the derivative."""
    step = mpf("1e-12")
    tops = roots(lambda phi, at: function(phi + step, at) - function(phi - step, at), edges)
    values = [function(end, (low + high) / 2) for low, high in pairwise(edges) for end in (low, high)]
    values += [function(top, top) for top in tops]
    return max(values), min(values)


@cache
def _gauss(precision: int) -> list[tuple[Number, Number]]:
    nodes: list[tuple[Number, Number]] = GaussLegendre(mp).calc_nodes(4, precision)
    return nodes


def integrals(function: Function, edges: Sequence[Number]) -> list[Number]:
    """Return the integral over each piece by 24 Gauss points, halved until whole and halves agree to 25 digits."""

    def rule(low: Number, high: Number) -> tuple[Number, Number]:
        middle, half = (low + high) / 2, (high - low) / 2
        values = [weight * function(middle + half * node, middle) for node, weight in _gauss(mp.prec)]
        return half * mp.fsum(values), half * mp.fsum(values, absolute=True)

    def integral(low: Number, high: Number, whole: Number) -> Number:
        middle = (low + high) / 2
        (left, size), (right, more) = rule(low, middle), rule(middle, high)
        if abs(left + right - whole) <= mpf("1e-25") * (size + more):
            return left + right
        return integral(low, middle, left) + integral(middle, high, right)

    return [integral(low, high, rule(low, high)[0]) for low, high in pairwise(edges)]


def excess(function: Function, edges: Sequence[Number]) -> Number:
    """Return the largest swing of ∫ (function − its mean), between the angles at which the function has its mean."""
    mean = mp.fsum(integrals(function, edges)) / (edges[-1] - edges[0])
    crossings = roots(lambda phi, at: function(phi, at) - mean, edges)
    heights = [mpf(0), *accumulate(integrals(lambda phi, at: function(phi, at) - mean, merged([*edges, *crossings])))]
    return max(heights) - min(heights)


# the references


def reference(machine: Machine, quantity: str) -> tuple[Number, list[Number]]:
    """Return A_i and A_f in J, T_max and T_min in N, of the first cylinder, or ΔE in J; and the edges of its pieces."""
    if quantity == "ΔE":
        whole = TextbookMachine(machine)
        return excess(whole.torque, whole.edges), whole.edges
    book = TextbookCylinder(machine, machine.cylinders[0])
    if quantity[0] == "T":
        return extremes(lambda phi, at: book.forces(phi, at).torque / book.motion.r, book.edges), book.edges

    def power(phi: Number, at: Number) -> Number:
        found = book.forces(phi, at)
        return (found.gas if quantity == "A_i" else found.friction) * found.slope

    return mp.fsum(integrals(power, book.edges)), book.edges


def peak_slope(mechanism: Mechanism) -> Number:
    """Return the largest dx/dφ in m on the outstroke."""
    book = TextbookMotion(mechanism)
    (peak,) = roots(lambda phi, at: book.at(phi).curvature, book.dead_centres)
    return book.at(peak).slope
