"""Start-up of whole processes with their output in a pipe, as ratios to `python -c 'import numpy'` of the same run.

    python benchmarks/start_up.py [ROUNDS [COMMAND...]]

Times are those that the processor spends on the process, of which other work on the machine takes no part. The
commands take turns, so that a machine that is slow for a while is slow for all of them. Both ratios are shown, of the
medians and of the least times. COMMAND: a word of those that are measured, such as `forces`; all if none is given.
"""

from __future__ import annotations

import os
import resource
import statistics
import subprocess
import sys
from pathlib import Path

BIN = Path(sys.executable).parent
CONFIGS = Path(__file__).parent.parent / "configs"
BASE = "import numpy"
COMMANDS = {
    BASE: [sys.executable, "-c", "import numpy"],
    "kurbel --help": [BIN / "kurbel", "--help"],
    "kurbel table": [BIN / "kurbel", "table"],
    "kurbel check": [BIN / "kurbel", "check", CONFIGS / "waterworks.yaml"],
    "kurbel forces -f csv": [BIN / "kurbel", "forces", CONFIGS / "waterworks.yaml", "-f", "csv"],
    "kurbel flywheel": [BIN / "kurbel", "flywheel", CONFIGS / "waterworks-two-cranks.yaml"],
    "kurbel balance": [BIN / "kurbel", "balance", CONFIGS / "waterworks.yaml"],
    "kurbel balance (V8)": [BIN / "kurbel", "balance", CONFIGS / "v8-cross-plane.yaml"],
    "kurbel plot": [BIN / "kurbel", "plot", CONFIGS / "waterworks.yaml"],
}
BUDGET = {
    "kurbel --help": 1.0,
    "kurbel table": 1.8,
    "kurbel forces -f csv": 2.0,
    "kurbel flywheel": 2.5,
}


def processor_time() -> float:
    """Return the seconds that the processor has spent on processes that have ended."""
    spent = resource.getrusage(resource.RUSAGE_CHILDREN)
    return spent.ru_utime + spent.ru_stime


def measure(rounds: int, words: list[str]) -> dict[str, list[float]]:
    """Return the seconds of each round by command."""
    commands = {
        name: command
        for name, command in COMMANDS.items()
        if name == BASE or not words or set(words) & set(name.split())
    }
    # without compiled modules every start would compile kurbel anew, which no installation does
    environment = {
        key: value for key, value in os.environ.items() if key != "PYTHONDONTWRITEBYTECODE"
    }
    times: dict[str, list[float]] = {name: [] for name in commands}
    for number in range(rounds + 1):
        for name, command in commands.items():
            begin = processor_time()
            subprocess.run(command, stdout=subprocess.PIPE, check=True, env=environment)
            if number:  # the first round warms up
                times[name].append(processor_time() - begin)
    return times


def main() -> None:
    """Print the table."""
    times = measure(int(sys.argv[1]) if len(sys.argv) > 1 else 15, sys.argv[2:])
    base = times[BASE]
    print(f"{'':<24}{'median':>16}{'least':>16}")
    print(f"{'command':<24}{'ms':>8}{'ratio':>8}{'ms':>8}{'ratio':>8}{'budget':>8}")
    for name, seconds in times.items():
        taken = "".join(
            f"{of(seconds) * 1e3:>8.1f}{of(seconds) / of(base):>8.2f}"
            for of in (statistics.median, min)
        )
        budget = f"{BUDGET[name]:.2f}" if name in BUDGET else ""
        print(f"{name:<24}{taken}{budget:>8}")


if __name__ == "__main__":
    main()
