"""Time in the process: free forces and moments, orders and best weights of 24 cylinders, and their rolling moment.

python benchmarks/balance.py
"""

from __future__ import annotations

import time
from collections.abc import Callable

import kurbel
from kurbel.solver.chapters.balance import MachineBalance

V24 = """
name: V24
speed: 1500 rpm
cycle: four-stroke
counterweights: {share: 0.5}
cylinders:
  count: 24
  firing_order: 1-17-5-21-3-15-11-23-9-19-7-13-12-24-8-20-10-22-2-14-4-18-6-16
  bank_angles: [0 deg, 60 deg]
  spacing: 200 mm
  each:
    crank: 90 mm
    rod_ratio: 3.9
    bore: 170 mm
    indicator:
      pressures: absolute
      head_end: {otto: {intake: 1 bar, exhaust: 1 bar, peak: 60 bar, compression_ratio: 11}}
    masses: {piston: 6 kg, rotating: 2 kg, connecting_rod: 7 kg}
"""


def weights(balance: MachineBalance) -> None:
    """Free forces and moments, their orders, the best weights."""
    assert balance.F_free_max
    assert balance.M_free_max
    assert balance.free.orders
    assert balance.F_free_best
    assert balance.best_in_planes
    assert balance.best_shafts is not None


def rolling(balance: MachineBalance) -> None:
    """The extremes of the rolling moment."""
    assert balance.M_roll_max
    assert balance.M_roll_min


def milliseconds(
    machine: kurbel.Machine, task: Callable[[MachineBalance], None], repeats: int = 50
) -> float:
    """Least time of a task, each time of a machine that is solved anew."""
    times = []
    for _ in range(repeats):
        begin = time.perf_counter()
        task(kurbel.solve(machine).balance)
        times.append(time.perf_counter() - begin)
    return min(times) * 1e3


def main() -> None:
    """Print the table."""
    machine = kurbel.loads(V24)
    for task in (weights, rolling):
        print(f"{milliseconds(machine, task):6.2f} ms  {task.__doc__}")


if __name__ == "__main__":
    main()
