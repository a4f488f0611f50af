"""Time in the process: all columns at 361 angles and all key values of a machine, against a naive loop over the angles.

python benchmarks/in_process.py [MACHINE.yaml]
"""

from __future__ import annotations

import math
import statistics
import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

import kurbel
from kurbel.report.commands import subjects_of
from kurbel.tables.frame import Subject

CONFIGS = Path(__file__).parent.parent / "configs"
ANGLES = np.arange(361.0)


def everything(machine: kurbel.Machine) -> None:
    """All columns and key values of all cylinders."""
    for subject in subjects_of(kurbel.solve(machine), "forces"):
        columns_only(subject)
        list(subject.key_values("forces"))


def columns_only(subject: Subject) -> None:
    """All columns of one cylinder."""
    assert subject.at
    answer = subject.at(ANGLES)
    for id in subject.lists.columns("forces"):
        _ = answer[id]


def naive_motion(crank: float, rod: float, omega: float) -> list[tuple[float, float, float]]:
    """x, c and b alone as a textbook writes them, one angle after the other."""
    rows = []
    for degrees in range(361):
        phi = math.radians(degrees)
        psi = math.asin(crank / rod * math.sin(phi))
        x = crank * (1 - math.cos(phi)) + rod * (1 - math.cos(psi))
        c = crank * omega * math.sin(phi + psi) / math.cos(psi)
        bend = crank / rod * math.cos(phi) ** 2 / math.cos(psi) ** 3
        b = crank * omega**2 * (math.cos(phi + psi) / math.cos(psi) + bend)
        rows.append((x, c, b))
    return rows


def milliseconds(task: Callable[[], object], repeats: int = 30) -> float:
    """Median time of a task after one warm-up."""
    task()
    times = []
    for _ in range(repeats):
        begin = time.perf_counter()
        task()
        times.append(time.perf_counter() - begin)
    return statistics.median(times) * 1e3


def main() -> None:
    """Print the table."""
    machine = kurbel.load(sys.argv[1] if len(sys.argv) > 1 else CONFIGS / "waterworks.yaml")
    base = milliseconds(lambda: naive_motion(0.4, 2.0, 5.2))
    rows = {
        "naive loop: x, c, b only": base,
        "all columns": milliseconds(lambda: columns_only(kurbel.solve(machine).cylinders[0])),
        "all columns and key values": milliseconds(lambda: everything(machine)),
    }
    print(f"{machine.name}, {len(ANGLES)} angles")
    for name, time_ms in rows.items():
        print(f"{name:<28}{time_ms:>8.2f} ms{time_ms / base:>8.1f} x naive")


if __name__ == "__main__":
    main()
