"""Key values against an independent calculation with 40 digits: textbook formulas, no tricks."""

from __future__ import annotations

from collections.abc import Callable
from itertools import pairwise

import mpmath
import numpy as np
import pytest

from kurbel.declared.units import GRAVITY
from kurbel.machine.indicator import Indicator, Line
from kurbel.machine.parts import Friction, Masses, Piston
from kurbel.mechanisms.slider_crank import SliderCrank
from kurbel.solver.forces import CylinderForces
from machines import STEAM_CARD, one_cylinder
from representative import few

mp = mpmath.mp
NODES, WEIGHTS = (tuple(map(mpmath.mpf, each)) for each in np.polynomial.legendre.leggauss(28))
LAMBDAS = [1e-12, 1e-3, 0.2, 0.25, 0.6, 0.9, 0.99, 1 - 1e-6, 1 - 1e-10]


class Oracle:
    """A double-acting machine with straight rod, written down as the textbooks do."""

    def __init__(self, forces: CylinderForces) -> None:
        drive = forces.drive
        self.piston = drive.cylinder.pistons[0]
        self.crank, self.rod = mpmath.mpf(drive.mechanism.crank), mpmath.mpf(drive.mechanism.rod)
        self.omega = 2 * mp.pi * mpmath.mpf(drive.machine.speed or 0)
        self.mass = mpmath.mpf(drive.mass)
        self.f = mpmath.mpf(drive.crosshead_friction)
        self.guide_weight = self.mass * mpmath.mpf(GRAVITY) if drive.weight else mpmath.mpf(0)
        indicator = self.piston.indicator
        self.head_lines = [_segments(line) for line in indicator.head_end.lines]
        self.crank_lines = [_segments(line) for line in indicator.crank_end.lines]

    def angles(self, phi: mpmath.mpf) -> tuple[mpmath.mpf, mpmath.mpf, mpmath.mpf, mpmath.mpf]:
        """Return sin φ, cos φ, sin ψ, cos ψ."""
        cos, sin = mp.cos_sin(phi)
        sin_psi = self.crank / self.rod * sin
        return sin, cos, sin_psi, mp.sqrt(1 - sin_psi**2)

    def slope(self, phi: mpmath.mpf) -> mpmath.mpf:
        sin, cos, sin_psi, cos_psi = self.angles(phi)
        return self.crank * (sin * cos_psi + cos * sin_psi) / cos_psi

    def gas(self, phi: mpmath.mpf) -> mpmath.mpf:
        sin, cos, _, cos_psi = self.angles(phi)
        out = sin >= 0
        fraction = (self.crank * (1 - cos) + self.rod * (1 - cos_psi)) / (2 * self.crank)
        p_head = _pressure(self.head_lines[0 if out else 1], fraction)
        p_crank = _pressure(self.crank_lines[1 if out else 0], 1 - fraction)
        return p_head * mpmath.mpf(self.piston.head_area) - p_crank * mpmath.mpf(self.piston.crank_area)

    def force(self, phi: mpmath.mpf) -> mpmath.mpf:
        sin, cos, sin_psi, cos_psi = self.angles(phi)
        bend = self.crank / self.rod * cos**2 / cos_psi**3
        b = self.crank * self.omega**2 * ((cos * cos_psi - sin * sin_psi) / cos_psi + bend)
        return self.gas(phi) - self.mass * b

    def lifted(self, phi: mpmath.mpf) -> mpmath.mpf:
        """What presses on the guide, over cos ψ, before friction takes its share."""
        _, _, sin_psi, cos_psi = self.angles(phi)
        return self.force(phi) * sin_psi + self.guide_weight * cos_psi

    def guide(self, phi: mpmath.mpf) -> mpmath.mpf:
        sin, _, sin_psi, cos_psi = self.angles(phi)
        lifted = self.lifted(phi)
        return lifted / (cos_psi + mp.sign(sin) * mp.sign(lifted) * self.f * sin_psi)

    def rod_force(self, phi: mpmath.mpf) -> mpmath.mpf:
        sin, _, _, cos_psi = self.angles(phi)
        drag = mp.sign(sin) * self.f * abs(self.guide(phi))
        return (self.force(phi) - drag) / cos_psi

    def tangential(self, phi: mpmath.mpf) -> mpmath.mpf:
        sin, cos, sin_psi, cos_psi = self.angles(phi)
        return self.rod_force(phi) * (sin * cos_psi + cos * sin_psi)


Segment = tuple[mpmath.mpf, mpmath.mpf, mpmath.mpf, mpmath.mpf]


def _segments(line: Line) -> list[Segment]:
    points = sorted((mpmath.mpf(z), mpmath.mpf(p)) for z, p in zip(line.fractions, line.pressures, strict=True))
    return [(*one, *other) for one, other in pairwise(points) if other[0] > one[0]]


def _pressure(segments: list[Segment], fraction: mpmath.mpf) -> mpmath.mpf:
    for z, p, next_z, next_p in segments:
        if z <= fraction <= next_z:
            return p + (next_p - p) * (fraction - z) / (next_z - z)
    assert fraction - 1 < 1e-20  # a dead centre, rounded
    return segments[-1][3]


def machine(lam: float, weight: bool = False, f: float = 0.1) -> CylinderForces:
    piston = Piston(0.45, 0.075, 0.1, Indicator(STEAM_CARD, STEAM_CARD))
    return one_cylinder(
        SliderCrank(0.4, 0.4 / lam),
        120,
        pistons=(piston,),
        masses=Masses(900),
        friction=Friction(f),
        inclination=0.0 if weight else None,
    )


def edges(forces: CylinderForces) -> list[mpmath.mpf]:
    """All bends of the machine; more of them than needed do the quadrature no harm."""
    return [mpmath.mpf(float(angle)) * mp.pi / 180 for angle in forces.breaks]


WEIGHED = [(0.2, False), (1 - 1e-6, False), *((lam, True) for lam in LAMBDAS)]


@pytest.mark.parametrize(("lam", "weight"), few(WEIGHED, [(0.25, True)]))
def test_friction_work(lam: float, weight: bool) -> None:
    forces = machine(lam, weight, f=0.1 if lam < 0.9 else 0.02 if lam < 0.999 else 1e-7)
    with mpmath.workdps(26):
        oracle = Oracle(forces)
        exact = sum(friction_work(oracle, low, high) for low, high in pairwise(edges(forces)))
        assert abs(forces.friction_work / exact - 1) < 1e-13


def friction_work(oracle: Oracle, low: mpmath.mpf, high: mpmath.mpf) -> mpmath.mpf:
    """Gauss of 28 points over a piece in which the guide keeps its side; rounded nodes are good enough."""
    middle, half = (low + high) / 2, (high - low) / 2
    angles = [middle + half * node for node in NODES]
    assert len({mp.sign(oracle.lifted(phi)) for phi in angles[::9]}) == 1
    return oracle.f * half * sum(w * abs(oracle.guide(phi) * oracle.slope(phi)) for w, phi in zip(WEIGHTS, angles))


CLIMBED = [(lam, column) for lam in (0.2, 0.6, 0.95) for column in ("P", "S", "N", "T")]


@pytest.mark.parametrize(("lam", "column"), few(CLIMBED, [(0.6, "N")]))
def test_extremes(lam: float, column: str) -> None:
    """Brute force over 20,000 angles finds the hill, high precision climbs it."""
    forces = machine(lam)
    found = forces.extremes_of(column)
    dense = getattr(forces.at(np.linspace(0, 360, 20001)), column)
    with mpmath.workdps(40):
        oracle = Oracle(forces)
        function = {"P": oracle.force, "S": oracle.rod_force, "N": oracle.guide, "T": oracle.tangential}[column]
        for extreme, sign in ((found.largest, 1), (found.smallest, -1)):
            assert sign * extreme.value >= (sign * dense).max() * (1 - 1e-12)
            exact = _climb(function, forces, extreme.degrees, sign)
            assert abs(extreme.value / exact - 1) < 1e-13


def _climb(
    function: Callable[[mpmath.mpf], mpmath.mpf], forces: CylinderForces, degrees: float, sign: int
) -> mpmath.mpf:
    """Return the extreme within the smooth pieces that touch the angle, one-sided at their ends, by ternary search."""
    breaks = forces.breaks
    pieces = [(low, high) for low, high in pairwise(breaks) if low - 1e-9 <= degrees <= high + 1e-9]
    best = None
    for low, high in pieces:
        tiny = mpmath.mpf(10) ** -28
        start = max(mpmath.mpf(low), mpmath.mpf(degrees) - mpmath.mpf("0.5")) * mp.pi / 180 + tiny
        stop = min(mpmath.mpf(high), mpmath.mpf(degrees) + mpmath.mpf("0.5")) * mp.pi / 180 - tiny
        for _ in range(110):
            a, b = start + (stop - start) / 3, stop - (stop - start) / 3
            start, stop = (a, stop) if sign * function(a) < sign * function(b) else (start, b)
        value = function((start + stop) / 2)
        best = value if best is None or sign * value > sign * best else best
    return best


@pytest.mark.parametrize("lam", LAMBDAS)
def test_columns_at_any_angle(lam: float) -> None:
    forces = machine(lam, weight=True, f=0.02)
    degrees = [1e-9, 10.0, 79.1, 123.4, 179.999, 200.0, 271.0, 359.0]
    state = forces.at(degrees)
    with mpmath.workdps(40):
        oracle = Oracle(forces)
        for i, degree in enumerate(degrees):
            phi = mpmath.mpf(degree) * mp.pi / 180
            scale = float(abs(oracle.gas(phi)) + abs(oracle.force(phi) - oracle.gas(phi)))
            for column, function in (("P", oracle.force), ("S", oracle.rod_force), ("N", oracle.guide)):
                factor = 1 / float(mp.cos(mp.asin(lam * mp.sin(phi))))
                assert abs(getattr(state, column)[i] - function(phi)) < 2e-14 * scale * factor
