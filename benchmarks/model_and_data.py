"""Errors that no arithmetic mends: what the books' approximations and wrong data change in the results of a machine.

python benchmarks/model_and_data.py [FILE]: for a machine file, or the first built-in machine of `kurbel accuracy`.
Relative differences: of x, c and b the largest over the cycle, over the largest value.
"""

from __future__ import annotations

import math
import statistics
import sys
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from kurbel import crank_formulas, load, loads
from kurbel.accuracy.extremes import table_lines
from kurbel.crank_angle import CrankAngle
from kurbel.machine import Machine
from kurbel.mechanisms.slider_crank import SliderCrank
from kurbel.solver.case import Case

STEP = 0.1
"""Degrees between the samples of a measured force, and of a dead centre found too late."""


class Difference(NamedTuple):
    """How much a simpler model, or wrong data, change a quantity, relatively."""

    quantity: str
    cause: str
    error: float


def first_machine() -> Machine:
    """Return the first built-in machine."""
    return loads(table_lines("scenes.tsv")[0][2])


def model_errors(machine: Machine) -> Iterator[Difference]:
    """Yield what the book's approximations change in the motion of the first slider-crank, in T_max and in ΔE."""
    exact, angle = machine.cylinders[0].mechanism, CrankAngle.of(np.arange(361.0))
    for quantity, function, formula in (
        ("x", exact.coordinate, crank_formulas.first_order_displacement),
        ("c", exact.slope, crank_formulas.first_order_velocity),
        ("b", exact.curvature, crank_formulas.first_order_acceleration),
    ):
        truth = function(angle)
        for cause, lam in (("first-order formulas", exact.lam), ("infinite rod", 0.0)):
            missed = np.abs(exact.crank * formula(angle.sin, angle.cos, lam) - truth)
            yield Difference(quantity, cause, float(missed.max() / np.abs(truth).max()))

    every = machine.cylinders
    rodless = tuple(
        replace(one, mechanism=SliderCrank(one.mechanism.crank, math.inf)) for one in every
    )
    massless = tuple(replace(one, masses=None, inclination=None) for one in every)
    for cause, cylinders in (("infinite rod", rodless), ("inertia left out", massless)):
        yield from changes(
            torques(machine), torques(replace(machine, cylinders=cylinders, limits=())), cause
        )


def torques(machine: Machine) -> dict[str, float]:
    """Return T_max of the first cylinder and ΔE."""
    case = Case(machine)
    return {"T_max": case.cylinders[0].extremes_of("T").largest.value, "ΔE": case.flywheel.dE}


def data_errors(machine: Machine) -> Iterator[Difference]:
    """Yield what 0.1° of dead centre and 0.5 % noise of the gas force change, with a sample every 0.1°.

    The friction is left as it is. Noise: the standard deviation over 20 draws, the same in every run.
    """
    case, phi = Case(machine), np.arange(0.0, 360.0 * machine.revolutions, STEP)
    places = [phi - cylinder.crank_position for cylinder in machine.cylinders]
    states = [forces.at(place) for forces, place in zip(case.cylinders, places)]
    first, torque, crank = states[0], case.flywheel.at(phi).M, machine.cylinders[0].mechanism.crank

    def answers(changes: Sequence[np.ndarray]) -> dict[str, float]:
        above = torque + sum(change * state.slope for change, state in zip(changes, states))
        above = above - above.mean()
        return {
            "A_i": float((first.slope * (first.P_gas + changes[0])).sum()) * math.radians(STEP),
            "T_max": float((first.T + changes[0] * first.slope / crank).max()),
            "ΔE": float(np.ptp(np.cumsum(above + np.roll(above, -1)))) / 2 * math.radians(STEP),
        }

    whole = answers([0 * phi for _ in states])
    late = [forces.at(place - STEP).P_gas for forces, place in zip(case.cylinders, places)]
    yield from changes(
        whole, answers([b - a.P_gas for a, b in zip(states, late)]), "dead centre 0.1° late"
    )
    draws = []
    for seed in range(20):
        random = np.random.default_rng(seed)
        draws.append(
            answers(
                [
                    random.normal(0.0, 0.005 * np.abs(state.P_gas).max(), len(phi))
                    for state in states
                ]
            )
        )
    noisy = {
        quantity: value
        + math.sqrt(statistics.fmean((draw[quantity] - value) ** 2 for draw in draws))
        for quantity, value in whole.items()
    }
    yield from changes(whole, noisy, "noise 0.5% of the gas force")


def changes(whole: dict[str, float], other: dict[str, float], cause: str) -> Iterator[Difference]:
    """Yield relative differences."""
    for quantity, value in whole.items():
        yield Difference(quantity, cause, abs(other[quantity] / value - 1))


def main() -> None:
    machine = load(sys.argv[1]) if len(sys.argv) > 1 else first_machine()
    print(machine.name)
    for one in (*model_errors(machine), *data_errors(machine)):
        print(f"{one.quantity:<8}{one.cause:<30}{one.error:>8.1e}")


if __name__ == "__main__":
    main()
