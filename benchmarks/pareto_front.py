"""Time of the Pareto front of a sweep all of whose rows are on it, which is the worst that can happen.

    python benchmarks/pareto_front.py [ROWS]

Times are of the processor, the least of some runs. The rows are points of a sphere, none of which betters another one.
"""

from __future__ import annotations

import sys
import time

import numpy as np

from kurbel.arrays import Array
from kurbel.designs.chosen import unbettered

ROWS, RUNS, SEED = 20_000, 3, 0
AIMS = (2, 3, 4, 5, 6)


def on_a_sphere(rows: int, aims: int) -> Array:
    """Return costs (rows, aims) of which none is less than another one in all."""
    drawn = np.abs(np.random.default_rng(SEED).normal(size=(rows, aims)))
    return np.asarray(-drawn / np.linalg.norm(drawn, axis=1)[:, None])


def seconds(costs: Array) -> float:
    """Return the least processor time of some runs."""
    times = []
    for _ in range(RUNS):
        begin = time.process_time()
        front = unbettered(costs)
        times.append(time.process_time() - begin)
        assert front.all()
    return min(times)


def main() -> None:
    """Print the time for each number of aims."""
    rows = int(sys.argv[1]) if len(sys.argv) > 1 else ROWS
    print(f"{rows} rows, all on the front")
    for aims in AIMS:
        print(f"{aims} aims {seconds(on_a_sphere(rows, aims)):8.3f} s")


if __name__ == "__main__":
    main()
