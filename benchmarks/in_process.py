"""Time in the process: all columns at 361 angles and all key values of a machine, against a naive loop over the angles.

And x, c and b at 360 angles against the closed form of numpy, which is 3 times as fast at most.

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
from kurbel.arrays import Array
from kurbel.report.commands import subjects_of
from kurbel.solver.forces import CylinderForces
from kurbel.tables.frame import Subject

CONFIGS = Path(__file__).parent.parent / "configs"
ANGLES = np.arange(361.0)
TURN = np.arange(360.0)


def everything(machine: kurbel.Machine) -> None:
    """All columns and key values of all cylinders."""
    for subject in subjects_of(kurbel.solve(machine), "forces"):
        if subject.at:
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


def closed_form(crank: float, rod: float, omega: float) -> tuple[Array, Array, Array]:
    """x, c and b alone as a textbook writes them, at all angles at once."""
    phi = np.radians(TURN)
    sin, cos = np.sin(phi), np.cos(phi)
    lam = crank / rod
    sin_psi = lam * sin
    cos_psi = np.sqrt(1 - sin_psi * sin_psi)
    tan_psi = sin_psi / cos_psi
    x = crank * (1 - cos) + rod * (1 - cos_psi)
    c = crank * omega * (sin + cos * tan_psi)
    b = crank * omega**2 * (cos - sin * tan_psi + lam * cos * cos / cos_psi**3)
    return x, c, b


def motion_only(cylinder: CylinderForces) -> tuple[Array, Array, Array]:
    """x, c and b of a solved cylinder."""
    state = cylinder.at(TURN)
    return state.x, state.c, state.b


def least_microseconds(task: Callable[[], object], repeats: int = 2000) -> float:
    """Least time of a task: others on the machine make it only longer."""
    times = []
    for _ in range(repeats):
        begin = time.perf_counter()
        task()
        times.append(time.perf_counter() - begin)
    return min(times) * 1e6


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

    (cylinder, *_) = kurbel.solve(machine).cylinders
    closed = least_microseconds(lambda: closed_form(0.4, 2.0, 5.2))
    solved = least_microseconds(lambda: motion_only(cylinder))
    columns = least_microseconds(lambda: cylinder.columns(TURN, "x", "c", "b"))
    print(
        f"x, c, b at {len(TURN)} angles: {solved:.0f} µs, {solved / closed:.1f} x numpy's closed form; "
        f"by columns(): {columns:.0f} µs, {columns / closed:.1f} x"
    )


if __name__ == "__main__":
    main()
