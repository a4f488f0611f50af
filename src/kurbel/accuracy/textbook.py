"""The crank train once more, as textbooks write it: in floats for other methods, in mpmath's numbers for references.

Nothing is shared with the solver: pressures are found and signs of friction chosen anew. Differences of nearly equal
numbers are left as they are in the books; the digits of a reference pay for them. Angles are in radians of the own
crank, all else in SI. `at` is any angle within a piece between corners: it says which side of a corner is meant.
"""

import math
from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import numpy as np

from kurbel.accuracy.methods import FLOATS, Number, Numbers, merged, roots
from kurbel.arrays import Array, Indices
from kurbel.machine import CYCLES, Cylinder, Machine
from kurbel.machine.indicator import Card, Line
from kurbel.mechanisms import Mechanism


class Stance(NamedTuple):
    """A slider-crank at crank angles: x, dx/dφ and d²x/dφ² in m, sine and cosine of the rod angle."""

    x: Number
    slope: Number
    curvature: Number
    sin_psi: Number
    cos_psi: Number


class Chamber(NamedTuple):
    """One end of a cylinder; sign: of its force; area in m²; lift makes pressures absolute, base gauge, in Pa."""

    card: Card
    sign: int
    area: Number
    lift: Number
    base: Number

    def line(self, stroke: int) -> Line:
        """Return the line of the card on a stroke of the piston, which are counted from the first outstroke as 0."""
        return self.card.lines[(stroke - (self.sign < 0)) % len(self.card.lines)]

    def share(self, fraction: Number) -> Number:
        """Return the fraction of the card's stroke for one of the piston's, and conversely."""
        return fraction if self.sign > 0 else 1 - fraction


class TextbookMotion:
    """Motion of a slider-crank, or of a Scotch yoke, whose rod is infinite.

    formula: `exact`, R 285, 288, 291; `first-order`, B 22, 25, 26; `infinite`, an infinite rod.
    """

    def __init__(self, mechanism: Mechanism, numbers: Numbers = FLOATS, formula: str = "exact") -> None:
        infinite = formula == "infinite" or math.isinf(mechanism.rod_length)
        self.numbers, self.formula = numbers, "infinite" if infinite else formula
        self.crank, self.rod = numbers.of(mechanism.crank), numbers.of(mechanism.rod_length)
        self.offset = numbers.of(0.0 if infinite else mechanism.offset)
        if infinite:
            self.stroke, self.dead_centres = 2 * self.crank, (numbers.of(0.0), numbers.of(1.0) * numbers.pi)
        else:
            far, near = self.rod + self.crank, self.rod - self.crank
            self.reach = numbers.sqrt(far**2 - self.offset**2)
            self.stroke = self.reach - numbers.sqrt(near**2 - self.offset**2)
            self.dead_centres = numbers.arcsin(self.offset / far), numbers.pi + numbers.arcsin(self.offset / near)

    def at(self, phi: Number, formula: str = "") -> Stance:
        """Return the motion at crank angles; formula: another one, to which an infinite rod stays infinite."""
        formula, r, sin, cos = formula or self.formula, self.crank, self.numbers.sin(phi), self.numbers.cos(phi)
        if self.formula == "infinite":
            return Stance(r * (1 - cos), r * sin, r * cos, 0 * sin, 0 * sin + 1)
        aside = r * sin - self.offset
        along = self.numbers.sqrt(self.rod**2 - aside**2)
        swing = r * cos * aside / along
        x, slope = self.reach - r * cos - along, r * sin + swing
        curvature = r * cos + (r**2 * cos**2 - aside * r * sin + swing**2) / along
        if formula == "first-order":
            lam = r / self.rod
            x, slope = r * (1 - cos + lam * sin**2 / 2), r * sin * (1 + lam * cos)
            curvature = r * (cos + lam * (2 * cos**2 - 1))
        return Stance(x, slope, curvature, aside / self.rod, along / self.rod)

    def beyond(self, fractions: Number) -> tuple[Number, Number]:
        """Return the angle between crank and line of action at fractions of the stroke, and that of this line."""
        numbers, r, line = self.numbers, self.crank, 0 * fractions
        cosine = 1 - 2 * fractions
        if self.formula != "infinite":  # law of cosines for crank, rod and the line from the shaft to the crosshead
            distance = numbers.sqrt((self.reach - fractions * self.stroke) ** 2 + self.offset**2)
            cosine = (r**2 + distance**2 - self.rod**2) / (2 * r * distance)
            line = numbers.arcsin(self.offset / distance)
        return numbers.pi / 2 - numbers.arcsin(np.maximum(np.minimum(cosine, 1), -1)), line


class Forces(NamedTuple):
    """dx/dφ in m; in N the gas force, P, what lifts the crosshead from its guide, and the friction along x."""

    slope: Number
    gas: Number
    push: Number
    lift: Number
    friction: Number


class TextbookCylinder:
    """Forces of one cylinder, in pieces between the corners of its cards; formula: of the motion."""

    def __init__(self, machine: Machine, cylinder: Cylinder, numbers: Numbers = FLOATS, formula: str = "exact") -> None:
        of, self.numbers, self.motion = numbers.of, numbers, TextbookMotion(cylinder.mechanism, numbers, formula)
        self.turns, self.omega = CYCLES[machine.cycle_of(cylinder)], 2 * numbers.pi * of(machine.speed or 0.0)
        self._weigh(cylinder, machine.lean_of(cylinder))
        friction = cylinder.friction
        self._crosshead = of((friction and cylinder.mechanism.has_rod and friction.crosshead) or 0.0)
        self._rings = of((friction and friction.constant) or 0.0)
        if friction and (rings := friction.rings):
            surface = rings.count * numbers.pi * of(cylinder.pistons[0].bore) * of(rings.height)
            self._rings += surface * of(rings.pressure) * of(rings.coefficient)
        self._chambers = tuple(self._ends(cylinder, of(machine.ambient)))
        self._cut(self._corners())
        if self._crosshead:
            sides, _ = roots(lambda phi, at: self.forces(phi, at).lift, self.edges, numbers)
            self._cut(merged([*self.edges, *sides], numbers))

    def _weigh(self, cylinder: Cylinder, lean: float | None) -> None:
        of, masses = self.numbers.of, cylinder.masses
        rod = masses.connecting_rod if masses else None
        mass, share = (of(rod.mass), of(rod.share)) if rod else (of(0.0), of(0.0))
        self.mass = of(masses.parts if masses else 0.0) + mass * share
        self.turning_inertia = mass * (1 - share) * self.motion.crank**2
        angle = of(lean or 0.0) * self.numbers.pi / 180
        weight = self.mass * of(0.0 if lean is None else "9.80665")
        self._weight, self._side_weight = weight * self.numbers.sin(angle), weight * self.numbers.cos(angle)

    def _ends(self, cylinder: Cylinder, ambient: Number) -> Iterator[Chamber]:
        for piston in cylinder.pistons:
            absolute = piston.indicator is not None and piston.indicator.absolute
            for end, card in piston.chambers.items():
                assert isinstance(card, Card)
                rod = piston.head_end_rod if end == "head_end" else piston.crank_end_rod
                area = self.numbers.pi / 4 * (self.numbers.of(piston.bore) ** 2 - self.numbers.of(rod) ** 2)
                lift, base = (0, ambient) if absolute else (ambient, 0)
                yield Chamber(card, 1 if end == "head_end" else -1, area, lift, base)

    def _corners(self) -> Array:
        """Return the angles from the first inner dead centre through one cycle at which a card bends or jumps."""
        inner, numbers = self.motion.dead_centres[0], self.numbers
        found = [inner + 2 * numbers.pi * self.turns]
        for stroke in range(2 * self.turns):
            turn, back = divmod(stroke, 2)
            found.append(self.motion.dead_centres[back] + 2 * numbers.pi * turn)
            for chamber in self._chambers:
                fractions = chamber.share(numbers.of(chamber.line(stroke).fractions))
                beyond, line = self.motion.beyond(fractions[(fractions > 0) & (fractions < 1)])
                found += [*(line + 2 * numbers.pi * turn + (2 * numbers.pi - beyond if back else beyond))]
        return merged(found, numbers)

    def _cut(self, edges: Array) -> None:
        """Take the edges of pieces; find on each its direction, the lines of its cards, and the side of the guide."""
        middles = (edges[1:] + edges[:-1]) / 2
        self.edges, self._inside = edges, np.asarray(edges[1:-1] - edges[0], dtype=float)
        since = np.asarray(middles - edges[0], dtype=float)
        back = since % (2 * math.pi) > float(self.motion.dead_centres[1] - self.motion.dead_centres[0])
        self._direction = self._side = 1 - 2 * back.astype(int)
        strokes = 2 * (since // (2 * math.pi)).astype(int) + back
        fractions = np.asarray(self.motion.at(middles, "exact").x / self.motion.stroke, dtype=float)
        self._pressures = [self._pressure(one, strokes, one.share(fractions)) for one in self._chambers]
        self._side = np.where(self.forces(middles, middles).lift >= 0, 1, -1)

    def _pressure(self, chamber: Chamber, strokes: Indices, fractions: Array) -> Callable[[Number, Indices], Number]:
        """Return the gauge pressure of a chamber as a function of the fraction of its stroke and the piece's number."""
        ends = []
        for stroke, fraction in zip(strokes, fractions):
            line = chamber.line(stroke)
            order = 1 if line.start == 0 else -1
            places, pressures = line.fractions[::order], line.pressures[::order]
            last = min(max(int(np.searchsorted(places, fraction)), 1), len(places) - 1)
            ends.append((*places[last - 1 : last + 1], *pressures[last - 1 : last + 1]))
        z, next_z, p, next_p = self.numbers.of(np.array(ends)).T
        if chamber.card.interpolate == "linear":
            rise = (next_p - p) / (next_z - z)
            return lambda at, k: p[k] + rise[k] * (at - z[k]) - chamber.base
        clearance, lift, log = self.numbers.of(chamber.card.clearance), chamber.lift, self.numbers.log
        exponent = log((p + lift) / (next_p + lift)) / log((next_z + clearance) / (z + clearance))
        constant = (p + lift) * (z + clearance) ** exponent
        return lambda at, k: constant[k] / (at + clearance) ** exponent[k] - lift - chamber.base

    def forces(
        self, phi: Number, at: Number, shift: float = 0.0, noise: Callable[[Array], Array] | None = None
    ) -> Forces:
        """Return the forces at crank angles.

        shift: angle by which the pressures are taken too late; noise: of a chamber's pressures, what is added to them.
        """
        piece, late = (np.searchsorted(self._inside, self._since(angle), "right") for angle in (at, at - shift))
        motion = on_card = self.motion.at(phi)
        if shift or self.motion.formula == "first-order":
            on_card = self.motion.at(phi - shift, "exact")
        fraction, gas = on_card.x / self.motion.stroke, 0 * motion.x
        for chamber, pressure_at in zip(self._chambers, self._pressures):
            pressure = pressure_at(chamber.share(fraction), late)
            gas = gas + chamber.sign * chamber.area * (pressure + noise(pressure) if noise else pressure)
        push = gas - self.mass * self.omega**2 * motion.curvature + self._weight
        way = self._direction[piece]
        lift = (push - way * self._rings) * motion.sin_psi + self._side_weight * motion.cos_psi
        leaning = motion.cos_psi + way * self._side[piece] * self._crosshead * motion.sin_psi
        friction = way * (self._crosshead * np.abs(lift / leaning) + self._rings)
        return Forces(motion.slope, gas, push, lift, friction)

    def _since(self, angle: Number) -> Array:
        """Return angles counted from the start of the cycle, in floats."""
        return np.asarray(np.mod(np.asarray(angle - self.edges[0], dtype=float), 2 * math.pi * self.turns))

    def torque(self, phi: Number, at: Number, **disturbed: Any) -> Number:
        """Return M in N m, inertia at uniform speed included; disturbed: see `forces`."""
        found = self.forces(phi, at, **disturbed)
        return (found.push - found.friction) * found.slope

    def gas_power(self, phi: Number, at: Number, **disturbed: Any) -> Number:
        """Return the work of the gas in J per radian; disturbed: see `forces`."""
        found = self.forces(phi, at, **disturbed)
        return found.gas * found.slope

    def tangential(self, phi: Number, at: Number, **disturbed: Any) -> Number:
        """Return T in N, M over the radius of the crank; disturbed: see `forces`."""
        return self.torque(phi, at, **disturbed) / self.motion.crank

    def friction_power(self, phi: Number, at: Number) -> Number:
        """Return the work of friction in J per radian."""
        found = self.forces(phi, at)
        return found.friction * found.slope


class TextbookMachine:
    """The turning effort of all cylinders at the angles of crank 1."""

    def __init__(self, machine: Machine, numbers: Numbers = FLOATS, formula: str = "exact") -> None:
        self._cycle, degree = 2 * machine.revolutions * numbers.pi * numbers.of(1.0), numbers.pi / 180
        self._cylinders = [
            (TextbookCylinder(machine, one, numbers, formula), numbers.of(one.crank_position) * degree)
            for one in machine.cylinders
        ]
        found = [0 * self._cycle, self._cycle]
        for one, position in self._cylinders:
            turns = [2 * numbers.pi * one.turns * repeat for repeat in range(machine.revolutions // one.turns)]
            found += [(angle + position + turn) % self._cycle for angle in one.edges[:-1] for turn in turns]
        self.edges = merged(found, numbers)

    def torque(self, phi: Number, at: Number, **disturbed: Any) -> Number:
        """Return M in N m; disturbed: see `TextbookCylinder.forces`."""
        return sum(one.torque(phi - place, at - place, **disturbed) for one, place in self._cylinders)

    def drive(self, phi: Number, at: Number) -> Number:
        """Return M without inertia in N m."""
        total = self.torque(phi, at)
        for one, place in self._cylinders:
            motion = one.motion.at(phi - place)
            total = total + one.mass * one.omega**2 * motion.slope * motion.curvature
        return total

    def inertia(self, phi: Number, at: Number) -> Number:
        """Return Σ (m x′² + (1 − s) m_r R²) in kg m², with the reciprocating share s of the rods."""
        return sum(
            one.mass * one.motion.at(phi - place).slope ** 2 + one.turning_inertia for one, place in self._cylinders
        )
