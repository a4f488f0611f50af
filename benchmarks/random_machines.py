"""Crossings and extremes of random machines against a fine mesh: none may be missed.

python benchmarks/random_machines.py [COUNT]
"""

from __future__ import annotations

import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parent.parent / "tests"))
sys.path.insert(0, str(Path(__file__).parent.parent / "tests" / "solver"))

from test_effort import missed, random_machine


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
