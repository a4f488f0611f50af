"""Torsional vibration: 30 masses, 48 orders, 200 speeds; and natural frequencies beside numpy's eigenvalues.

python benchmarks/torsion.py [RUNS]

Times are those of the processor, medians of RUNS (5 if not given). Errors are relative, the largest of all modes, against
eigenvalues with 60 digits; chains of masses that differ by ever more powers of ten. Needs mpmath.
"""

from __future__ import annotations

import statistics
import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parent.parent / "tests"))
sys.path.insert(0, str(Path(__file__).parent.parent / "tests" / "solver"))

from test_torsion import at_random, eigenvalues

from kurbel.machine.shaft_line import ShaftLine, ShaftMass, ShaftSegment
from kurbel.solver.chapters.chain import Chain
from kurbel.solver.chapters.excitation import Excitation, Vibration
from kurbel.solver.chapters.natural_modes import Modes


def seconds(work: Callable[[], object]) -> float:
    """Median time of the processor for a piece of work."""
    runs = int(sys.argv[1]) if len(sys.argv) > 1 else 5
    times = []
    for _ in range(runs):
        begin = time.process_time()
        work()
        times.append(time.process_time() - begin)
    return statistics.median(times)


def whole(masses: int = 30, orders: int = 48, speeds: int = 200) -> Vibration:
    """A chain with damping in every piece, driven at six masses."""
    draw = np.random.default_rng(1)
    names = (
        ShaftMass(f"mass {i}", float(j), damping=2.0)
        for i, j in enumerate(draw.uniform(0.5, 2, masses))
    )
    stiffnesses = draw.uniform(1e5, 1e6, masses - 1)
    segments = (
        ShaftSegment(float(stiffness), 1.0, 0.01, before=place, behind=place + 1)
        for place, stiffness in enumerate(stiffnesses)
    )
    line = ShaftLine(tuple(names), tuple(segments))
    gas = np.zeros((masses, orders), dtype=complex)
    gas[2:8] = draw.normal(size=(6, orders)) + 1j * draw.normal(size=(6, orders))
    nothing = np.zeros(masses)
    acting = Excitation(30.0, 720.0, np.arange(1, orders + 1) / 2, gas, 0.1 * gas, nothing, nothing)
    chain = Chain.of(line, [mass.inertia for mass in line.masses])
    return Vibration(chain, line, acting, np.linspace(5.0, 60.0, speeds))


def plain_eigenvalues(chain: Chain) -> np.ndarray:
    """√ of the eigenvalues of J^{-1/2} K J^{-1/2} by numpy."""
    roots = np.sqrt(chain.inertias)
    matrix = chain.twists.T @ np.diag(chain.stiffnesses) @ chain.twists / roots / roots[:, None]
    return np.sqrt(np.abs(np.linalg.eigvalsh(matrix)))


def main() -> None:
    """Print both tables."""
    chain = whole().chain
    print("30 masses, 48 orders, 200 speeds")
    print(f"  torques of every order   {seconds(lambda: whole().torques) * 1e3:8.1f} ms")
    print(f"  and half of their swings {seconds(lambda: whole().vibratory) * 1e3:8.1f} ms")
    print(f"  natural frequencies      {seconds(lambda: Modes(chain).omegas) * 1e3:8.1f} ms")
    print("\nlargest relative error of the elastic modes of 12 masses\n")
    print(f"{'masses differ by 10^':<22}{'kurbel':>10}{'eigvalsh':>10}")
    for spread in (0, 1, 2, 3, 5):
        errors = np.zeros(2)
        for seed in range(4):
            chain = at_random(12, spread, "", seed)
            exact = np.array([float(eigenvalue) for eigenvalue in eigenvalues(chain)])[1:]
            for index, found in enumerate((Modes(chain).omegas, plain_eigenvalues(chain))):
                errors[index] = max(errors[index], np.abs(found[1:] / exact - 1).max())
        print(f"{2 * spread:<22}{errors[0]:>10.0e}{errors[1]:>10.0e}")


if __name__ == "__main__":
    main()
