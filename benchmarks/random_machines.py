"""Crossings and extremes of random machines against a fine mesh: none may be missed.

python benchmarks/random_machines.py [COUNT]
"""

from __future__ import annotations

import sys

import numpy as np

from kurbel.machine import Cylinder, Machine
from kurbel.machine.indicator import Card, Indicator
from kurbel.machine.parts import Masses, Piston
from kurbel.mechanisms.slider_crank import SliderCrank
from kurbel.solver.case import Case
from kurbel.solver.flywheel import MachineTurning


def random_machine(random: np.random.Generator) -> MachineTurning:
    """Return the turning effort of one to three double-acting cylinders with cards that jump."""
    cylinders = []
    for number in range(int(random.integers(1, 4))):
        z = np.sort(random.uniform(0, 1, 3))
        levels = random.uniform(-0.5, 10, 8) * 1e5
        card = Card.from_keys(
            unit=(1, 1),
            expansion=[
                (0, levels[0]),
                (z[0], levels[1]),
                (z[0], levels[2]),
                (z[1], levels[3]),
                (1, levels[4]),
            ],
            compression=[(1, levels[5]), (z[2], levels[6]), (0, levels[7])],
        )
        crank = 10 ** random.uniform(-2, 0)
        cylinders.append(
            Cylinder(
                SliderCrank(crank, crank / random.uniform(0.05, 0.97)),
                name=f"cylinder {number + 1}",
                pistons=(Piston(crank, indicator=Indicator(card, card)),),
                masses=Masses(random.choice([0, 1]) * 10 ** random.uniform(0, 3)),
                crank_position=random.uniform(-180, 360),
            )
        )
    return Case(Machine(tuple(cylinders), speed=10 ** random.uniform(1, 3) / 60)).flywheel


def missed(machine: MachineTurning, samples: int = 200) -> int:
    """Count changes of sign of M − M_mean on a fine mesh next to no crossing, and extremes that the mesh beats."""
    low, high = machine.breaks[:-1, None], machine.breaks[1:, None]
    degrees = low + (high - low) * np.linspace(0, 1, samples)
    within = np.broadcast_to((low + high) / 2, degrees.shape)
    total = machine.at(degrees.ravel(), within.ravel()).M
    values = total - machine.M_mean
    size = np.abs(total).max()
    changes = np.flatnonzero(values[:-1] * values[1:] < 0)
    crossings = np.array(machine.phi_crossing)
    near = [
        (
            (crossings >= degrees.ravel()[i] - 1e-9) & (crossings <= degrees.ravel()[i + 1] + 1e-9)
        ).any()
        for i in changes
        if max(abs(values[i]), abs(values[i + 1])) > 1e-13 * size
    ]
    beaten = (total.max() > machine.M_max.value + 1e-12 * size) + (
        total.min() < machine.M_min.value - 1e-12 * size
    )
    return len(near) - int(sum(near)) + int(beaten)


def main() -> None:
    """Print how many crossings and extremes were found and missed."""
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 2000
    random = np.random.default_rng(20240501)
    crossings = lost = 0
    for number in range(count):
        machine = random_machine(random)
        crossings += len(machine.phi_crossing)
        if found := missed(machine):
            lost += found
            print(f"machine {number}: {found} missed")
    print(f"{count} machines, {crossings} crossings and {2 * count} extremes: {lost} missed")


if __name__ == "__main__":
    main()
