"""What someone writes who has a textbook and numpy: radians, formulas in the order of the book, interpolated cards.

`formula` chooses the motion: `exact`, `first-order` (B 22, 25, 26), `infinite` (the infinite rod), or `printed`: the
velocity factor to three decimals, as Zusammenstellung 112 has it.
"""

import math
from collections.abc import Callable
from functools import cached_property
from typing import Any

import numpy as np

from kurbel.accuracy.given import End, Given
from kurbel.arrays import Array
from kurbel.machine import Cylinder, Machine


class Moved:
    """The motion at crank angles (n,) in radians, (n,) each; every formula is computed when it is asked for."""

    def __init__(self, mechanism: Any, phi: Array, formula: str = "exact") -> None:
        self.phi, self.r, self.rod, self.offset = phi, mechanism.crank, mechanism.rod_length, mechanism.offset
        self.lam = self.r / self.rod
        self.formula = "infinite" if math.isinf(self.rod) else formula

    @cached_property
    def psi(self) -> Array:
        """The rod angle in radians."""
        if self.formula == "infinite":
            return np.zeros_like(self.phi)
        return np.asarray(np.arcsin((self.r * np.sin(self.phi) - self.offset) / self.rod))

    @property
    def coordinate(self) -> Array:
        """The way x in m."""
        r, phi = self.r, self.phi
        if self.formula == "infinite":
            return np.asarray(r * (1 - np.cos(phi)))
        if self.formula == "first-order":
            return np.asarray(r * (1 - np.cos(phi) + self.lam / 2 * np.sin(phi) ** 2))
        outer = math.sqrt((self.rod + r) ** 2 - self.offset**2)
        return np.asarray(outer - r * np.cos(phi) - self.rod * np.cos(self.psi))

    @property
    def slope(self) -> Array:
        """dx/dφ in m."""
        if self.formula == "infinite":
            return np.asarray(self.r * np.sin(self.phi))
        if self.formula == "first-order":
            return np.asarray(self.r * (np.sin(self.phi) + self.lam / 2 * np.sin(2 * self.phi)))
        factor = np.sin(self.phi + self.psi) / np.cos(self.psi)
        return np.asarray(self.r * (np.round(factor, 3) if self.formula == "printed" else factor))

    @property
    def curvature(self) -> Array:
        """d²x/dφ² in m."""
        phi, psi = self.phi, self.psi
        if self.formula == "infinite":
            return np.asarray(self.r * np.cos(phi))
        if self.formula in ("first-order", "printed"):
            return np.asarray(self.r * (np.cos(phi) + self.lam * np.cos(2 * phi)))
        bend = self.lam * np.cos(phi) ** 2 / np.cos(psi) ** 3
        return np.asarray(self.r * (np.cos(phi + psi) / np.cos(psi) + bend))

    @property
    def stroke(self) -> float:
        """s in m."""
        if self.formula == "infinite":
            return float(2 * self.r)
        far, near = ((self.rod + sign * self.r) ** 2 - self.offset**2 for sign in (1, -1))
        return math.sqrt(far) - math.sqrt(near)

    @property
    def dead_centres(self) -> tuple[float, float]:
        """The inner and the outer one in radians."""
        if self.formula == "infinite":
            return 0.0, math.pi
        outer = math.pi + math.asin(self.offset / (self.rod - self.r))
        return math.asin(self.offset / (self.rod + self.r)), outer


class TextbookCylinder:
    """Forces of one cylinder; crank angles in radians of its own crank, (n,) each."""

    def __init__(self, machine: Machine, cylinder: Cylinder, formula: str = "exact", massless: bool = False) -> None:
        self.mechanism: Any = cylinder.mechanism
        self.formula = formula
        given = Given(machine, cylinder, float, massless)
        self.turns = given.turns
        self._inertia = given.mass * (2 * math.pi * machine.speed) ** 2 if machine.speed else 0.0
        lean = math.radians(given.lean or 0.0)
        self._along, self._across = given.weight * math.sin(lean), given.weight * math.cos(lean)
        self._f: float = given.crosshead
        self._rings: float = given.steady_friction
        self._ends = [(end, [_line(end, line) for line in end.card.lines]) for end in given.ends]

    def gas_force(self, phi: Array, shift: float = 0.0, noise: Callable[[Array], Array] | None = None) -> Array:
        """Return the gas force in N.

        shift: radians by which the pressures are taken too late; noise: what is put on each chamber's pressures.
        """
        on_card = Moved(self.mechanism, phi - shift, "infinite" if self.formula == "infinite" else "exact")
        share, cycle = np.clip(on_card.coordinate / on_card.stroke, 0.0, 1.0), 2 * math.pi * self.turns
        inner, outer = on_card.dead_centres
        since = np.mod(np.mod(phi - shift, cycle) - inner, cycle)
        number = 2 * (since // (2 * math.pi)) + (np.mod(since, 2 * math.pi) >= outer - inner)
        total = np.zeros_like(phi)
        for end, lines in self._ends:
            z, which = (share, number) if end.head_end else (1 - share, number - 1)
            pressure = np.zeros_like(phi)
            for index, line in enumerate(lines):
                here = which % len(lines) == index
                pressure[here] = line(z[here])
            area = end.area if end.head_end else -end.area
            total += area * (pressure if noise is None else pressure + noise(pressure))
        return total

    def forces(self, phi: Array, **disturbed: Any) -> tuple[Array, Array, Moved]:
        """Return P and the crosshead's drag in N, and the motion; disturbed: as for `gas_force`."""
        motion = Moved(self.mechanism, phi, self.formula)
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
        return self.gas_force(phi, **disturbed) * Moved(self.mechanism, phi, self.formula).slope


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


def _line(end: End, line: Any) -> Callable[[Array], Array]:
    """Return the gauge pressure over the stroke fraction as np.interp has it, in logarithms for polytropic cards."""
    order, card, lift = 1 if line.start == 0 else -1, end.card, end.lift
    fractions, pressures = np.array(line.fractions)[::order], np.array(line.pressures)[::order]
    if card.interpolate == "linear":
        return lambda z: np.interp(z, fractions, pressures - end.base)
    volumes, logs = np.log(fractions + card.clearance), np.log(pressures + lift)
    return lambda z: np.exp(np.interp(np.log(z + card.clearance), volumes, logs)) - lift - end.base
