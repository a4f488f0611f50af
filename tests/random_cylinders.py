"""Cylinders drawn at random, with everything that makes a force bend, jump or change its sign."""

from typing import Any

import numpy as np

from kurbel.errors import NoSolutionError, RuleError
from kurbel.machine.ideal_cards import Diesel
from kurbel.machine.indicator import Card, Chamber, Indicator
from kurbel.machine.parts import ConnectingRod, Friction, Masses, Piston, Rings
from kurbel.mechanisms.slider_crank import SliderCrank
from kurbel.solver.forces import CylinderForces
from machines import constant_pressure, one_cylinder


def cylinders(seed: int, count: int, friction: bool = False) -> list[CylinderForces]:
    """Return so many cylinders whose crosshead does not lock itself."""
    random = np.random.default_rng(seed)
    results: list[CylinderForces] = []
    while len(results) < count:
        try:
            forces = random_cylinder(random, friction)
            forces.extremes_of("N")
        except (RuleError, NoSolutionError):
            continue
        results.append(forces)
    return results


def random_cylinder(random: np.random.Generator, friction: bool) -> CylinderForces:
    lam = random.uniform(0.05, 0.9)
    crank = 10 ** random.uniform(-1.5, 0)
    offset = random.choice([0, 1]) * random.uniform(-0.6, 0.6) * (crank / lam - crank)
    mechanism = SliderCrank(crank, crank / lam, offset)
    bore = crank * random.uniform(0.5, 1.5)
    speed = 10 ** random.uniform(0, 1.3) / crank**0.5
    mass = 2e5 * bore**2 / (crank * (6.3 * speed) ** 2) * 10 ** random.uniform(-1, 1)
    head, crank_end = random_chamber(random), random.choice([0, 1]) * 1
    return one_cylinder(
        mechanism,
        60 * speed,
        pistons=(
            Piston(
                bore,
                crank_end_rod=bore / 5,
                indicator=Indicator(head, random_chamber(random) if crank_end else None),
            ),
        ),
        masses=Masses(mass, random_rod(random, mass / 2, crank / lam)),
        friction=random_friction(random, bore) if friction else None,
        inclination=random.choice([None, 0.0, 30.0, 90.0]),
    )


def random_chamber(random: np.random.Generator) -> Chamber:
    kind = random.integers(3)
    if kind == 0:
        return constant_pressure(random.uniform(-0.5, 1) * 1e5)
    if kind == 1:
        return Diesel.from_keys(
            intake=random.uniform(-0.5, 0) * 1e5,
            cut_off=random.uniform(0.02, 0.2),
            compression_ratio=12.0,
        )
    z = np.sort(random.uniform(0, 1, 3))
    p = random.uniform(-0.9, 3, 8)
    return Card.from_keys(
        unit=(1e5, 1),
        expansion=[(0, p[0]), (z[0], p[1]), (z[0], p[2]), (z[1], p[3]), (1, p[4])],
        compression=[(1, p[5]), (z[2], p[6]), (0, p[7])],
    )


def random_rod(random: np.random.Generator, mass: float, length: float) -> ConnectingRod | None:
    kind = random.integers(3)
    if kind == 0:
        return None
    if kind == 1:
        return ConnectingRod(mass, 0.35)
    exact: dict[str, Any] = {
        "center_of_gravity": random.uniform(0.2, 0.9) * length,
        "inertia": mass * length**2 / 8,
    }
    return ConnectingRod(mass, **exact)


def random_friction(random: np.random.Generator, bore: float) -> Friction:
    rings = Rings(3, bore / 50, 2e4, 0.1) if random.integers(2) else None
    return Friction(random.uniform(0.01, 0.2), rings)
