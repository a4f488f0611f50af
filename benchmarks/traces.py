"""Measured traces of the bench: time to read them and to have p_i of every cycle, over that of `import numpy`; memory.

    python benchmarks/traces.py

Each in a process of its own, the best of three; memory is the peak of the process less that of `import numpy`.
"""

from __future__ import annotations

import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

TRACED = """
cycle: four-stroke
speed: 1500 rpm
stroke: 100 mm
rod_ratio: 4
bore: 90 mm
indicator: {{head_end: {{trace: {{file: p.csv, unit: bar{keys}}}}}}}
"""
NUMPY = "import numpy"
READ = "from kurbel.machine_file import load; from kurbel.solver.case import Case; case = Case(load('m.yaml'))"
SPREAD = f"{READ}; one = case.cylinders[0]; one.mean_pressure, one.indicated.mean_pressure_cov"
MEASURED = """
import resource, time
begin = time.perf_counter()
{task}
print(time.perf_counter() - begin, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024)
"""


def measured(task: str, folder: Path) -> tuple[float, float]:
    """Seconds and MiB of a task, the best of three."""
    runs = [
        subprocess.run(
            [sys.executable, "-c", MEASURED.format(task=task)],
            cwd=folder,
            capture_output=True,
            text=True,
            check=True,
        ).stdout.split()
        for _ in range(3)
    ]
    return min(float(seconds) for seconds, _ in runs), min(float(size) for _, size in runs)


def tables() -> dict[str, tuple[np.ndarray, str]]:
    """What is read: a table of angles and pressures, and the keys that it needs."""
    rng = np.random.default_rng(1)

    def pressures(count: int, cycles: int) -> np.ndarray:
        phi = np.arange(count) * 2 * np.pi / count
        return 20 * np.exp(-50 * (1 - np.cos(phi - 0.1))) + rng.normal(0, 0.1, (cycles, count))

    sixty = pressures(3600, 60)
    turns = np.arange(3600) * 0.2
    return {
        "7,200 points": (np.column_stack((np.arange(7200) * 0.1, pressures(7200, 1)[0])), ""),
        "60 x 3,600, in columns": (np.column_stack((turns, sixty.T)), ", pressure_columns: 2-61"),
        "60 x 3,600, one below another": (np.column_stack((np.tile(turns, 60), sixty.ravel())), ""),
        "1e6 points, 278 cycles": (
            np.column_stack((np.tile(turns, 278), pressures(3600, 278).ravel())),
            "",
        ),
    }


def main() -> None:
    """Print the table."""
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        base, size = measured(NUMPY, folder)
        print(
            f"{'':<32}{'read':>10}{'p_i, COV':>12}{'memory':>12}\n{'import numpy':<32}{base * 1e3:>7.0f} ms"
        )
        for what, (table, keys) in tables().items():
            np.savetxt(folder / "p.csv", table, delimiter=",", fmt="%.4f")
            (folder / "m.yaml").write_text(TRACED.format(keys=keys), encoding="utf-8")
            read, spread = measured(READ, folder), measured(SPREAD, folder)
            ratios = (
                f"{read[0] / base:>8.1f} x{spread[0] / base:>10.1f} x{spread[1] - size:>8.0f} MiB"
            )
            print(f"{what:<32}{ratios}")


if __name__ == "__main__":
    main()
