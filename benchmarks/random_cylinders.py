"""Force reversals and crossings of random cylinders against a dense scan between exact extremes: none may be missed.

    python benchmarks/random_cylinders.py [COUNT [SEED]]

Without a seed it is that of the day.
"""

from __future__ import annotations

import sys
from datetime import date
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent.parent / "tests"))
sys.path.insert(0, str(Path(__file__).parent.parent / "tests" / "solver"))

from test_laws import cylinders, missing_crossings, missing_reversals


def main() -> None:
    """Print how many angles were found and missed."""
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 2000
    seed = int(sys.argv[2]) if len(sys.argv) > 2 else date.today().toordinal()
    found = lost = 0
    for number, forces in enumerate(cylinders(seed, count)):
        found += len(forces.phi_reversal or ())
        if missing := missing_reversals(forces) + missing_crossings(forces):
            lost += missing
            print(f"cylinder {number}: {missing} missed")
    print(f"seed {seed}: {count} cylinders, {found} reversals and all crossings: {lost} missed")


if __name__ == "__main__":
    main()
