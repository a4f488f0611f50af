"""Random machine files of every kind through every command: no fault of kurbel's own, and how long the slowest took.

    python benchmarks/random_files.py [COUNT [SEED]]

Without a seed it is that of the day.
"""

from __future__ import annotations

import sys
import time
from collections import Counter
from datetime import date
from pathlib import Path

import numpy as np
from click.testing import CliRunner

sys.path.insert(0, str(Path(__file__).parent.parent / "tests"))

from kurbel.cli import kurbel
from random_files import machine_file

COMMANDS: tuple[tuple[str, ...], ...] = (
    ("check",),
    ("check", "-f", "json"),
    ("motion",),
    ("motion", "--where", "b = 1/6 b_max"),
    ("motion", "--over", "x", "--compare"),
    ("forces",),
    ("forces", "--where", "P = 0"),
    ("forces", "--over", "x", "--units", "imperial", "--layout", "rows"),
    ("forces", "-f", "json", "--set", "rotation=under"),
    ("forces", "--each-cycle"),
    ("forces", "--cycle", "2", "--key-values"),
    ("flywheel",),
    ("stress",),
    ("balance",),
    ("balance", "--orders", "--compare", "-f", "json"),
    ("balance", "--units", "technical", "-f", "markdown"),
    ("bearings",),
    ("bearings", "-f", "csv", "--units", "imperial"),
    ("bearings", "-f", "json", "--set", "rotation=under"),
    ("harmonics",),
    ("harmonics", "--speeds", "100:500:100 rpm", "-f", "json"),
    ("torsion",),
    ("torsion", "--orders", "0.5,1,3", "--columns", "M_shaft,tau", "-f", "json"),
    ("torsion", "--speeds", "50:500:50 rpm", "--modes", "9"),
)


def main() -> None:
    """Print the statuses by command, every fault with its number, and the slowest run."""
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
    seed = int(sys.argv[2]) if len(sys.argv) > 2 else date.today().toordinal()
    statuses: Counter[tuple[str, int]] = Counter()
    slowest = (0.0, "", -1)
    for number in range(count):
        text = machine_file(np.random.default_rng([seed, number]))
        for arguments in COMMANDS:
            command = " ".join(arguments)
            begin = time.process_time()
            result = CliRunner().invoke(kurbel, [*arguments, "-"], input=text)
            slowest = max(slowest, (time.process_time() - begin, command, number))
            statuses[command, result.exit_code] += 1
            if result.exit_code not in (0, 1, 2, 3) or "Warning:" in result.stderr:
                print(f"machine {number}, {command}: status {result.exit_code}: {result.stderr.strip()[-300:]}")
    for (command, status), found in sorted(statuses.items()):
        print(f"{command:<60} status {status}: {found}")
    print(f"seed {seed}; slowest: {slowest[0]:.1f} s of CPU, {slowest[1]} of machine {slowest[2]}")


if __name__ == "__main__":
    main()
