"""Reading and first use of many numbers, as ratios to a naive loop of the same run over the same text.

    python benchmarks/reading.py [COUNT]

The naive loop splits every line of a trace with `str.split` and `float`.
"""

from __future__ import annotations

import math
import statistics
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

from kurbel.machine_file import load, loads
from kurbel.solver.case import Case

DEMO = Path(__file__).parent.parent / "configs" / "waterworks.yaml"
TRACED = """
speed: 60 rpm
crank: 200 mm
rod: 900 mm
bore: 300 mm
masses: {piston: 90 kg}
indicator: {head_end: {trace: {file: p.csv, unit: bar}}}
"""


def seconds(task: Callable[[], object]) -> float:
    """Median of three."""
    times = []
    for _ in range(3):
        begin = time.perf_counter()
        task()
        times.append(time.perf_counter() - begin)
    return statistics.median(times)


def naive(text: str) -> list[list[float]]:
    """The numbers of a text of pairs."""
    return [[float(number) for number in line.split(",")] for line in text.splitlines()]


def main() -> None:
    """Print the table."""
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 100_000
    angles = [360 * index / count for index in range(count)]
    trace = "".join(
        f"{angle:.6f},{5 + 4 * math.cos(math.radians(angle)):.6f}\n" for angle in angles
    )
    points = "".join(
        f"    - [{angle:.6f}, {100 + index % 7}]\n" for index, angle in enumerate(angles)
    )
    effort = f"speed: 60 rpm\neffort:\n  unit: N m\n  points:\n{points}    - [360, 100]\nflywheel: {{inertia: 10 kg m2}}\n"
    turning = loads(effort)
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, "p.csv").write_text(trace, encoding="utf-8")
        machine = Path(folder, "m.yaml")
        machine.write_text(TRACED, encoding="utf-8")
        rows = {
            "naive loop over the trace": lambda: naive(trace),
            "machine file of the waterworks": lambda: load(DEMO),
            "trace of a file": lambda: load(machine),
            "its forces": lambda: Case(load(machine)).cylinders[0].extremes_of("T"),
            "running sums of as many points": lambda: Case(turning).flywheel.work_shaft,
        }
        print(f"{count} numbers")
        times = {name: seconds(task) for name, task in rows.items()}
    for name, taken in times.items():
        print(
            f"{name:<32}{taken * 1e3:>10.1f} ms{taken / times['naive loop over the trace']:>10.2f} x naive"
        )


if __name__ == "__main__":
    main()
