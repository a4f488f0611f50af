"""What someone writes who has a textbook and numpy: radians, formulas in the order of the book, interpolated cards.

`formula` chooses the motion: `exact`, `first-order` (B 22, 25, 26), `infinite` (the infinite rod), or `printed`: the
velocity factor to three decimals, as Zusammenstellung 112 has it.
"""

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from kurbel.machine import CYCLES, Cylinder, Machine

Array = NDArray[np.float64]
_GRAVITY = 9.80665
FORMULAS = ("exact", "first-order", "infinite", "printed")


class Moved(NamedTuple):
    """x in m, dx/dφ and d²x/dφ² in m, and the rod angle ψ in radians, each (n,)."""

    x: Array
    slope: Array
    curvature: Array
    psi: Array


def moved(mechanism: Any, phi: Array, formula: str = "exact") -> Moved:
    """Return the motion at crank angles (n,) in radians."""
    r, rod = mechanism.crank, getattr(mechanism, "rod", math.inf)
    if math.isinf(rod) or formula == "infinite":
        return Moved(r * (1 - np.cos(phi)), r * np.sin(phi), r * np.cos(phi), np.zeros_like(phi))
    lam, offset = r / rod, mechanism.offset
    psi = np.arcsin((r * np.sin(phi) - offset) / rod)
    if formula == "first-order":
        x = r * (1 - np.cos(phi) + lam / 2 * np.sin(phi) ** 2)
        return Moved(x, r * (np.sin(phi) + lam / 2 * np.sin(2 * phi)), r * (np.cos(phi) + lam * np.cos(2 * phi)), psi)
    factor = np.sin(phi + psi) / np.cos(psi)
    x = math.sqrt((rod + r) ** 2 - offset**2) - r * np.cos(phi) - rod * np.cos(psi)
    if formula == "printed":
        return Moved(x, r * np.round(factor, 3), r * (np.cos(phi) + lam * np.cos(2 * phi)), psi)
    bend = np.cos(phi + psi) / np.cos(psi) + lam * np.cos(phi) ** 2 / np.cos(psi) ** 3
    return Moved(x, r * factor, r * bend, psi)


def alone(mechanism: Any, phi: Array, order: int) -> Array:
    """Return x, dx/dφ or d²x/dφ² (order 0, 1, 2) in m by the exact formulas of the book, and nothing else."""
    r, rod = mechanism.crank, getattr(mechanism, "rod", math.inf)
    if math.isinf(rod):
        return np.asarray((r * (1 - np.cos(phi)), r * np.sin(phi), r * np.cos(phi))[order])
    psi = np.arcsin((r * np.sin(phi) - mechanism.offset) / rod)
    if order == 0:
        outer = math.sqrt((rod + r) ** 2 - mechanism.offset**2)
        return np.asarray(outer - r * np.cos(phi) - rod * np.cos(psi))
    if order == 1:
        return np.asarray(r * np.sin(phi + psi) / np.cos(psi))
    return np.asarray(r * (np.cos(phi + psi) / np.cos(psi) + r / rod * np.cos(phi) ** 2 / np.cos(psi) ** 3))


class TextbookCylinder:
    """Forces of one cylinder; crank angles in radians of its own crank, (n,) each."""

    def __init__(self, machine: Machine, cylinder: Cylinder, formula: str = "exact", massless: bool = False) -> None:
        self.mechanism: Any = cylinder.mechanism
        self.formula = formula
        self.turns = CYCLES[machine.cycle_of(cylinder)]
        masses = None if massless else cylinder.masses
        rod = masses.connecting_rod if masses else None
        mass = masses.parts + (rod.mass * rod.share if rod else 0.0) if masses else 0.0
        self._inertia = mass * (2 * math.pi * machine.speed) ** 2 if machine.speed else 0.0
        incline = math.radians(machine.lean_of(cylinder) or 0.0)
        has_weight = masses is not None and cylinder.inclination is not None
        self._along = mass * _GRAVITY * math.sin(incline) if has_weight else 0.0
        self._across = mass * _GRAVITY * math.cos(incline) if has_weight else 0.0
        friction = cylinder.friction
        self._f = (friction.crosshead or 0.0) if friction and cylinder.mechanism.has_rod else 0.0
        self._rings = _steady_friction(cylinder)
        self._ends = [end for piston in cylinder.pistons if piston.indicator for end in _ends(piston, machine.ambient)]

    def gas_force(self, phi: Array, shift: float = 0.0, noise: Callable[[Array], Array] | None = None) -> Array:
        """Return the gas force in N.

        shift: radians by which the pressures are taken too late; noise: what is put on each chamber's pressures.
        """
        from_card = moved(self.mechanism, phi - shift, "infinite" if self.formula == "infinite" else "exact")
        stroke = self._stroke
        share, turned = np.clip(from_card.x / stroke, 0.0, 1.0), np.mod(phi - shift, 2 * math.pi * self.turns)
        inner, outer = self._dead_centres
        since = np.mod(turned - inner, 2 * math.pi * self.turns)
        number = 2 * (since // (2 * math.pi)) + (np.mod(since, 2 * math.pi) >= outer - inner)
        total = np.zeros_like(phi)
        for area, sign, lines in self._ends:
            z, which = (share, number) if sign > 0 else (1 - share, number - 1)
            pressure = np.zeros_like(phi)
            for index, line in enumerate(lines):
                here = which % len(lines) == index
                pressure[here] = line(z[here])
            total += sign * area * (pressure if noise is None else pressure + noise(pressure))
        return total

    @property
    def _stroke(self) -> float:
        r, rod, e = self.mechanism.crank, getattr(self.mechanism, "rod", math.inf), getattr(self.mechanism, "offset", 0)
        if math.isinf(rod) or self.formula == "infinite":
            return float(2 * r)
        return math.sqrt((rod + r) ** 2 - e**2) - math.sqrt((rod - r) ** 2 - e**2)

    @property
    def _dead_centres(self) -> tuple[float, float]:
        r, rod, e = self.mechanism.crank, getattr(self.mechanism, "rod", math.inf), getattr(self.mechanism, "offset", 0)
        if math.isinf(rod) or self.formula == "infinite":
            return 0.0, math.pi
        return math.asin(e / (rod + r)), math.pi + math.asin(e / (rod - r))

    def forces(self, phi: Array, **disturbed: Any) -> tuple[Array, Array, Moved]:
        """Return P and the crosshead's drag in N, and the motion; disturbed: as for `gas_force`."""
        motion = moved(self.mechanism, phi, self.formula)
        push = self.gas_force(phi, **disturbed) if self._ends else np.zeros_like(phi)
        push = push - self._inertia * motion.curvature + self._along
        if not self._f:
            return push, np.zeros_like(phi), motion
        way = np.where(motion.slope >= 0, 1.0, -1.0)
        lifted = (push - way * self._rings) * np.sin(motion.psi) + self._across * np.cos(motion.psi)
        side = np.where(lifted >= 0, 1.0, -1.0)
        guide = lifted / (np.cos(motion.psi) + self._f * way * side * np.sin(motion.psi))
        return push, self._f * np.abs(guide), motion

    def torque(self, phi: Array, **disturbed: Any) -> Array:
        """Return M in N m."""
        push, drag, motion = self.forces(phi, **disturbed)
        return (push - np.sign(motion.slope) * (drag + self._rings)) * motion.slope

    def friction_power(self, phi: Array) -> Array:
        """Return (f |N| + rings) |dx/dφ| in J per radian."""
        _, drag, motion = self.forces(phi)
        return (drag + self._rings) * np.abs(motion.slope)

    def gas_power(self, phi: Array, **disturbed: Any) -> Array:
        """Return the gas force times dx/dφ in J per radian."""
        return self.gas_force(phi, **disturbed) * moved(self.mechanism, phi, self.formula).slope


class TextbookMachine:
    """The turning effort of all cylinders, η of it, at crank angles in radians of crank 1."""

    def __init__(self, machine: Machine, formula: str = "exact", massless: bool = False) -> None:
        self.cycle = 2 * math.pi * machine.revolutions
        self._parts = [
            (TextbookCylinder(machine, one, formula, massless), math.radians(one.crank_position))
            for one in machine.cylinders
        ]

    def torque(self, phi: Array, **disturbed: Any) -> Array:
        """Return M in N m at crank angles (n,) in radians."""
        total = np.zeros_like(phi)
        for cylinder, position in self._parts:
            total += cylinder.torque(phi - position, **disturbed)
        return total


def _steady_friction(cylinder: Cylinder) -> float:
    rings = cylinder.friction.rings if cylinder.friction else None
    constant = float((cylinder.friction.constant if cylinder.friction else None) or 0.0)
    if rings is None:
        return constant
    return (
        constant + rings.count * math.pi * cylinder.pistons[0].bore * rings.height * rings.pressure * rings.coefficient
    )


_Line = Callable[[Array], Array]


def _ends(piston: Any, ambient: float) -> list[tuple[float, float, list[_Line]]]:
    indicator = piston.indicator
    found = []
    for card, rod, sign in (
        (indicator.head_end, piston.head_end_rod, 1),
        (indicator.crank_end, piston.crank_end_rod, -1),
    ):
        if card is not None:
            area = math.pi / 4 * (piston.bore**2 - rod**2)
            found.append((area, float(sign), [_line(card, line, ambient, indicator.absolute) for line in card.lines]))
    return found


def _line(card: Any, line: Any, ambient: float, absolute: bool) -> _Line:
    """Return the gauge pressure over the stroke fraction as np.interp has it, in logarithms for polytropic cards."""
    order = 1 if line.start == 0 else -1
    fractions, pressures = np.array(line.fractions)[::order], np.array(line.pressures)[::order]
    base = ambient if absolute else 0.0
    if card.interpolate == "linear":
        return lambda z: np.interp(z, fractions, pressures - base)
    lift = 0.0 if absolute else ambient
    volumes, logs = np.log(fractions + card.clearance), np.log(pressures + lift)
    return lambda z: np.exp(np.interp(np.log(z + card.clearance), volumes, logs)) - lift - base
