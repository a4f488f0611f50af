"""References: the crank train as textbooks write it, in mpmath's numbers.

Nothing is shared with the solver: pressures are found and signs of friction chosen anew. Differences of nearly equal
numbers are left as they are in the books; the digits pay for them. Angles are in degrees, all else in SI. `within` is
any angle of a piece between corners: it selects the side of a corner.
"""

import math
from collections.abc import Callable, Iterator, Sequence
from functools import cache, partial
from typing import NamedTuple

import numpy as np

from kurbel.accuracy.cards import KNOWN_CARDS, Drawing, Line, drawn, without_process
from kurbel.accuracy.methods import Found, Number, by_gauss, merged, mp, mpf, roots
from kurbel.arrays import Array
from kurbel.machine import CYCLES, Cylinder, Machine
from kurbel.machine.parts import GasOnRings
from kurbel.mechanisms import Mechanism

DIGITS = 40
STEPS = 24
"""Equal steps of a piece, at which roots are looked for."""


# what has no reference


def taking_part(machine: Machine, quantity: str) -> tuple[Cylinder, ...]:
    """Return the cylinders that a quantity belongs to: all, or the first one."""
    return machine.cylinders if quantity == "ΔE" else machine.cylinders[:1]


def unknown(machine: Machine, quantity: str) -> Iterator[str]:
    """Yield what of a machine has no independent calculation of a quantity here."""
    for one in taking_part(machine, quantity):
        if one.mechanism.name not in ("slider-crank", "scotch-yoke", "yoke-frame"):
            yield f"the {one.mechanism.name}"
        if quantity in "xcb":
            return
        for piston in one.pistons:
            for chamber in piston.chambers.values():
                if what := without_process(chamber):
                    yield what
        if one.masses and one.masses.connecting_rod and one.masses.connecting_rod.exact:
            yield "a rod given by its centre of gravity"
        if one.ram_force:
            yield "a ram force"
        if friction := one.friction:
            if friction.of_pins:
                yield "pins that rub"
            if friction.block is not None or friction.guides is not None:
                yield "a yoke that rubs"
            if friction.rings and isinstance(friction.rings.pressure, GasOnRings):
                yield "rings that the gas presses"
    if quantity == "ΔE":
        if machine.effort is not None:
            yield "a given turning effort"
        if machine.efficiency != 1:
            yield "an efficiency"
        if machine.load is not None and machine.load.diagram is not None:
            yield "a load given by points"


# motion and forces


class Stance(NamedTuple):
    """A slider-crank: x, dx/dφ and d²x/dφ² in m, sine and cosine of the rod angle."""

    x: Number
    slope: Number
    curvature: Number
    sin_psi: Number
    cos_psi: Number


def stance(
    r: Number, length: Number, e: Number, sin: Number, cos: Number, sqrt: Callable[[Number], Number]
) -> Stance:
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
    """Motion of a slider-crank, or of a Scotch yoke, whose rod is infinite; ends: of the strokes of one turn."""

    def __init__(self, mechanism: Mechanism) -> None:
        self.r, rod, offset = mpf(mechanism.crank), mpf(mechanism.rod_length), mpf(mechanism.offset)
        self.at_pin = partial(stance, self.r, rod, offset, sqrt=mp.sqrt)
        inner, outer = mp.asin(offset / (rod + self.r)), mp.asin(offset / (rod - self.r))
        self.ends = np.array([mp.degrees(inner), 180 + mp.degrees(outer), 360 + mp.degrees(inner)])
        self.stroke = self.at(self.ends[1]).x

    def at(self, phi: Number) -> Stance:
        """Return the motion at a crank angle."""
        return self.at_pin(sin=mp.sinpi(phi / 180), cos=mp.cospi(phi / 180))


class Chamber(NamedTuple):
    """One end of a piston: its card, whether it grows on the outstroke (sign 1) or the return (−1), its area in m²."""

    card: Drawing
    sign: int
    area: Number
    strokes: int

    def lines(self, stroke: int) -> list[Line]:
        """Return the card's lines on a stroke of the cycle."""
        number = (stroke - (self.sign < 0)) % self.strokes
        return [line for line in self.card.lines if line.stroke == number]

    def fraction(self, share: Number) -> Number:
        """Return z of the card at a share of the crosshead's stroke, or that share at z."""
        return share if self.sign > 0 else 1 - share

    def line_at(self, stroke: int, share: Number) -> Line:
        """Return the line on which the gas is at a share of the crosshead's stroke."""
        z = self.fraction(share)
        return next(line for line in self.lines(stroke) if (line.begin - z) * (line.end - z) < 0)

    def pressure(self, line: Line, share: Number) -> Number:
        """Return the absolute pressure at a share of the crosshead's stroke, on one of the lines."""
        return self.card.at(line, self.fraction(share))


class Forces(NamedTuple):
    """dx/dφ in m; in N the gas force, the friction along x, what lifts the crosshead from its guide, and T; M in N m.

    The names are those of the columns of the solver; inertia is that at uniform speed.
    """

    slope: Number
    P_gas: Number
    F_friction: Number
    lift: Number
    T: Number
    M: Number


class TextbookCylinder:
    """Forces of one cylinder; edges: of the pieces of its cycle between the corners of its cards."""

    def __init__(self, machine: Machine, cylinder: Cylinder) -> None:
        self.motion, self.turns = (
            TextbookMotion(cylinder.mechanism),
            CYCLES[machine.cycle_of(cylinder)],
        )
        self.omega, self._ambient = 2 * mp.pi * mpf(machine.speed or 0.0), mpf(machine.ambient)
        masses, friction, lean = (
            cylinder.masses,
            cylinder.friction,
            machine.inclination_of(cylinder),
        )
        rod = masses.connecting_rod if masses else None
        self.mass = mpf(masses.parts if masses else 0.0) + (
            mpf(rod.mass) * mpf(rod.share) if rod else 0
        )
        weight, angle = (
            self.mass * mpf(0 if lean is None else "9.80665"),
            mp.radians(mpf(lean or 0.0)),
        )
        self._weight, self._side_weight = weight * mp.sin(angle), weight * mp.cos(angle)

        self._crosshead = mpf(
            (friction and cylinder.mechanism.has_rod and friction.crosshead) or 0.0
        )
        self._rings = mpf((friction and friction.constant) or 0.0)
        if friction and (rings := friction.rings):
            surface = rings.count * mp.pi * mpf(cylinder.pistons[0].bore) * mpf(rings.height)
            self._rings += surface * mpf(rings.pressure) * mpf(rings.coefficient)

        self._chambers: list[Chamber] = []
        for piston in cylinder.pistons:
            lift = mpf(0) if piston.indicator and piston.indicator.absolute else self._ambient
            for end, card in piston.chambers.items():
                assert isinstance(card, KNOWN_CARDS)
                head, ratio = end == "head_end", piston.lever_ratio
                thickness = mpf(piston.head_end_rod if head else piston.crank_end_rod)
                area = mp.pi / 4 * (mpf(piston.bore) ** 2 - thickness**2) * abs(mpf(ratio))
                drawing = drawn(card, lift, self.turns == 2)
                sign = 1 if head == (ratio > 0) else -1
                strokes = 1 + max(line.stroke for line in drawing.lines)
                self._chambers.append(Chamber(drawing, sign, area, strokes))

        self._piece = cache(self._piece_of)
        self.edges = merged(np.array(list(self._corners())))
        if self._crosshead:
            lifts = np.frompyfunc(lambda phi, within: self.at(phi, within).lift, 2, 1)
            off, _ = roots(lifts, self.edges[:-1], self.edges[1:], STEPS)
            self.edges = merged(np.append(self.edges, off))

    def _corners(self) -> Iterator[Number]:
        """Yield the angles from the first inner dead centre through one cycle at which a card bends or jumps."""
        yield self.motion.ends[0] + 360 * self.turns
        for stroke in range(2 * self.turns):
            turn, back = divmod(stroke, 2)
            yield self.motion.ends[back] + 360 * turn
            shares: set[Number] = set()
            for chamber in self._chambers:
                shares |= {chamber.fraction(line.begin) for line in chamber.lines(stroke)}
            for share in shares - {0, 1}:
                beyond = np.frompyfunc(
                    lambda phi, _, x=share * self.motion.stroke: self.motion.at(phi).x - x, 2, 1
                )
                (angle,), _ = roots(
                    beyond,
                    self.motion.ends[back : back + 1],
                    self.motion.ends[back + 1 :][:1],
                    STEPS,
                )
                yield angle + 360 * turn

    def _piece_of(self, within: Number) -> tuple[int, list[Line]]:
        """Return the direction of the crosshead on a piece, and on which line of its card each chamber is."""
        inner, outer, _ = self.motion.ends
        since = (within - inner) % (360 * self.turns)
        turn = int(since / 360)
        back, share = (
            since - 360 * turn > outer - inner,
            self.motion.at(within).x / self.motion.stroke,
        )
        lines = [chamber.line_at(2 * turn + back, share) for chamber in self._chambers]
        return -1 if back else 1, lines

    def at(self, phi: Number, within: Number) -> Forces:
        """Return the forces at a crank angle."""
        motion, (direction, lines) = self.motion.at(phi), self._piece(within)
        gas, share = mpf(0), motion.x / self.motion.stroke
        for chamber, line in zip(self._chambers, lines):
            gas += chamber.sign * chamber.area * (chamber.pressure(line, share) - self._ambient)
        push = gas - self.mass * self.omega**2 * motion.curvature + self._weight
        lift = (
            push - direction * self._rings
        ) * motion.sin_psi + self._side_weight * motion.cos_psi
        leaning = motion.cos_psi + direction * mp.sign(lift) * self._crosshead * motion.sin_psi
        friction = -direction * (self._crosshead * abs(lift / leaning) + self._rings)
        torque = (push + friction) * motion.slope
        return Forces(motion.slope, gas, friction, lift, torque / self.motion.r, torque)


# quantities


NEEDED: dict[str, Callable[[Number], Number]] = {
    "A_i": lambda state: state.slope * state.P_gas,
    "T_max, T_min": lambda state: state.T,
    "A_f": lambda state: -state.slope * state.F_friction,
    "ΔE": lambda state: state.M,
}
"""Quantity -> what it is the integral, the extremes or the swing of, from the columns of `Forces` or of the solver."""

Cylinders = Sequence[tuple[Callable[[Number, Number], Number], Number]]
"""Functions that return the columns of cylinders at angles of their own cranks, and where these are."""


def needed(quantity: str, cylinders: Cylinders, phi: Number, within: Number) -> Number:
    """Return what a quantity is computed from, at angles of crank 1."""
    return sum(NEEDED[quantity](at(phi - place, within - place)) for at, place in cylinders)


class TextbookMachine:
    """Cylinders with the places of their cranks; edges: of all pieces of the cycle, at the angles of crank 1."""

    def __init__(self, machine: Machine, cylinders: Sequence[Cylinder]) -> None:
        self.cylinders = [
            (TextbookCylinder(machine, one), mpf(one.crank_position)) for one in cylinders
        ]
        turns = max(one.turns for one, _ in self.cylinders)
        found = [mpf(0), mpf(360 * turns)]
        for one, place in self.cylinders:
            starts = [place + 360 * turn for turn in range(0, turns, one.turns)]
            found += [(edge + start) % found[1] for edge in one.edges[:-1] for start in starts]
        self.edges = merged(np.array(found))

    def function(self, quantity: str) -> Callable[[Array, Array], Array]:
        """Return what a quantity is computed from."""
        at = [(one.at, place) for one, place in self.cylinders]
        return np.frompyfunc(partial(needed, quantity, at), 2, 1)


def reference(machine: Machine, quantity: str) -> tuple[Found, Array]:
    """Return A_i and A_f in J, T_max and T_min in N, of the first cylinder, or ΔE in J; and the edges of its pieces."""
    book = TextbookMachine(machine, taking_part(machine, quantity))
    return by_gauss(quantity, book.function(quantity), book.edges, STEPS), book.edges
