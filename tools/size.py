"""The page of the limits of size: measured processor time and memory of commands that grow.

python tools/size.py > docs/size.md

It takes about two minutes. Times are of the machine that runs it.
"""

from __future__ import annotations

import math
import os
import platform
import sys
import tempfile
from collections.abc import Iterator, Sequence
from pathlib import Path
from textwrap import indent
from typing import NamedTuple

from kurbel.declared.units import MOST_ITEMS, MOST_POINTS, MOST_SHAFT_ITEMS
from kurbel.designs.plan import MOST_ROWS
from kurbel.traces.read import LARGEST_FILE, MOST_NUMBERS

CONFIGS = Path(__file__).parent.parent / "configs"

_HEAD = f"""# Limits of size

How large traces, sweeps and machines may be, and what they cost. Times are processor times of one run on one machine
({{processor}}, Python {{python}}), memory is the peak of the process; `python tools/size.py` measures them anew.
`kurbel --version` takes {{start}}.

| what | limit |
| --- | --: |
| file of a trace | {LARGEST_FILE // 2**20} MiB, {MOST_NUMBERS:,} numbers |
| samples of one cycle, points of one diagram | {MOST_POINTS:,} |
| items of one list of the machine file: cylinders, load cases | {MOST_ITEMS} |
| items of a shaft line: masses, and the segments between them | {MOST_SHAFT_ITEMS} |
| rows of a sweep | {MOST_ROWS:,}, more with `--yes` |

Beyond these kurbel stops with a message, before it computes."""


class Spent(NamedTuple):
    """Processor time in s and memory in MB of a command."""

    seconds: float
    memory: float

    def __str__(self) -> str:
        seconds = f"{self.seconds:.2g}" if self.seconds < 10 else f"{self.seconds:.0f}"
        return f"{seconds} s, {self.memory:.0f} MB"


def main() -> None:
    """Measure, and write the page to standard output."""
    with tempfile.TemporaryDirectory() as folder:
        os.chdir(folder)
        start = _spent(["--version"])
        head = _HEAD.format(
            processor=platform.machine(), python=platform.python_version(), start=start
        )
        print("\n\n".join([head, *_traces(), *_machines(), *_sweeps(), *_uncertainties()]))


def _spent(words: Sequence[str]) -> Spent:
    """Run kurbel with its output to a file. Raises RuntimeError where it fails."""
    child = os.fork()
    if child == 0:
        nothing = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nothing, 1)
        os.execv(sys.executable, [sys.executable, "-m", "kurbel", *words])
    _, status, used = os.wait4(child, 0)
    if status:
        raise RuntimeError(" ".join(words))
    return Spent(used.ru_utime + used.ru_stime, used.ru_maxrss / 1024)


def _traces() -> Iterator[str]:
    rows = []
    for samples, cycles in (
        (720, 1),
        (7_200, 1),
        (72_000, 1),
        (500_000, 1),
        (720, 100),
        (3_600, 300),
    ):
        _trace(samples, cycles)
        rows.append(
            (f"{samples:,}", str(cycles), str(_spent(["forces", "bench.yaml", "--key-values"])))
        )
    yield "## Traces\n\n`kurbel forces bench.yaml --key-values`: a four-stroke engine with samples from a CSV file."
    yield _table(("samples of a cycle", "cycles", "time, memory"), rows)


def _trace(samples: int, cycles: int) -> None:
    """Write the file of a trace, a smooth pressure with a peak, its cycles in columns, and its machine."""
    with Path("bench.csv").open("w", encoding="utf-8") as file:
        for k in range(samples):
            phi = 720 * k / samples
            near = min(phi, 720 - phi)
            p = 1 + 49 * math.exp(-((near / 40) ** 2))
            file.write(
                f"{phi:.9g},"
                + ",".join(f"{p * (1 + 0.01 * math.sin(c)):.6g}" for c in range(cycles))
                + "\n"
            )
    layout = f"pressure_columns: 2-{cycles + 1}" if cycles > 1 else "pressure_column: 2"
    Path("bench.yaml").write_text(
        f"""speed: 1500 rpm
cycle: four-stroke
stroke: 120 mm
rod_ratio: 4
bore: 100 mm
indicator: {{pressures: absolute, head_end: {{trace: {{file: bench.csv, unit: bar, {layout}}}}}}}
masses: {{reciprocating: 2 kg}}
""",
        encoding="utf-8",
    )


_CYLINDER = """stroke: 120 mm
rod_ratio: 4
bore: 100 mm
masses: {piston: 1.5 kg, connecting_rod: 2 kg}
indicator: {head_end: {otto: {intake: -0.1 bar, exhaust: 0.1 bar, peak: 50 bar, compression_ratio: 9, exponent: 1.33}}}
"""


def _machines() -> Iterator[str]:
    rows = []
    for count in (1, 4, 12, MOST_ITEMS):
        positions = ", ".join(f"{720 * k / count:.9g} deg" for k in range(count))
        Path("engine.yaml").write_text(
            f"speed: 1500 rpm\ncycle: four-stroke\nflywheel: {{inertia: 5 kg m2}}\ncylinders:\n  count: {count}\n"
            f"  crank_positions: [{positions}]\n  spacing: 150 mm\n  each:\n{indent(_CYLINDER, '    ')}",
            encoding="utf-8",
        )
        commands = ("forces", "flywheel", "balance")
        rows.append(
            (
                str(count),
                *(str(_spent([command, "engine.yaml", "--key-values"])) for command in commands),
            )
        )
    yield "## Cylinders\n\nEqual cylinders with different crank positions, `--key-values` of each command:"
    yield _table(("cylinders", "`forces`", "`flywheel`", "`balance`"), rows)
    rows = []
    for masses in (3, 12, 50, MOST_SHAFT_ITEMS // 2):
        between = "".join(
            f"  - {{inertia: 0.1 kg m2, damping: 1 N m s/rad}}\n  - {{stiffness: {1 + k % 3} MN m/rad}}\n"
            for k in range(masses - 2)
        )
        Path("shaft.yaml").write_text(
            f"speed: 1500 rpm\ncycle: four-stroke\n{_CYLINDER}shaft:\n"
            f"  - {{cylinder: cylinder 1, inertia: 0.1 kg m2}}\n  - {{stiffness: 1 MN m/rad}}\n{between}"
            "  - {inertia: 2 kg m2, damping: 5 N m s/rad, load: true}\n",
            encoding="utf-8",
        )
        rows.append((str(masses), str(_spent(["torsion", "shaft.yaml", "--key-values"]))))
    yield "## Masses of a shaft line\n\n`kurbel torsion shaft.yaml --key-values`:"
    yield _table(("masses", "time, memory"), rows)


def _sweeps() -> Iterator[str]:
    rows = []
    for machine, key, column, counts in (
        ("waterworks", "rod_ratio", "T_max", (100, 10_000, 100_000)),
        ("waterworks-two-cranks", "flywheel.fluctuation", "delta", (100, 1_000)),
        ("shaper", "crank", "c_max", (100, 1_000)),
        ("marine-diesel", "speed", "f_1", (100,)),
    ):
        span = {"rod_ratio": "uniform(3, 6)", "flywheel.fluctuation": "uniform(0.01, 0.05)"}
        span |= {"crank": "uniform(200 mm, 400 mm)", "speed": "uniform(80 rpm, 120 rpm)"}
        for count in counts:
            words = [
                "sweep",
                str(CONFIGS / f"{machine}.yaml"),
                "--vary",
                f"{key}={span[key]}",
                "--sample",
                str(count),
            ]
            spent = _spent([*words, "--columns", column, "-o", "rows.csv", "--jobs", "1"])
            rows.append((f"`{machine}`", f"`{key}`", f"`{column}`", f"{count:,}", str(spent)))
    yield "## Sweeps\n\n`kurbel sweep MACHINE --vary KEY=uniform(…) --sample N --columns COLUMN -o rows.csv --jobs 1`:"
    yield _table(("machine", "varies", "column", "rows", "time, memory"), rows)
    yield """Machines of one kind are computed together; other mechanisms and commands are computed one machine after
another ([one solver](sweeps.md#one-solver)). `--jobs` and `--shard` divide the work."""


def _uncertainties() -> Iterator[str]:
    """Measure uncertainties of first order, and such as need a sample."""
    Path("five.yaml").write_text(_FIVE_CYLINDERS, encoding="utf-8")
    rows = []
    for command, spread, how in (
        ("forces", "1 %", "first order"),
        ("forces", "25 %", "2,000 machines sampled"),
        ("flywheel", "1 %", "first order"),
        ("flywheel", "25 %", "200 machines sampled"),
    ):
        words = [command, "five.yaml", "--uncertainty", f"cylinders.0.rod={spread}"]
        rows.append((f"`{command}`", spread, how, str(_spent([*words, "--key-values"]))))
    yield """## Uncertainties

`--uncertainty cylinders.0.rod=…` of a compressor with five unequal cylinders and a load with a slip of 2·10⁻⁶, a stiff one:"""
    yield _table(("command", "of the rod", "by", "time, memory"), rows)
    yield """Where a key value bends over the width of an uncertainty, it comes from a sample: 2,000 machines, or 200 where each
takes long by itself (measured traces, other mechanisms, `torsion`, and `flywheel` under a load that depends on the
speed). The column `sample` of the table says which. `--key-values NAMES` takes only these key values, and the sample
only those of them that need it."""


_FIVE_CYLINDERS = """speed: 300 rpm
flywheel: {inertia: 20 kg m2}
load: {slip: 2e-6}
cylinders:
  - name: a
    stroke: 200 mm
    rod: 500 mm
    bore: 250 mm
    masses: {reciprocating: 40 kg}
    indicator:
      pressures: absolute
      head_end: {compressor: {suction: 1 bar, delivery: 4 bar, clearance: 0.05, exponent: 1.3}}
  - {like: a, crank_position: 72 deg, bore: 255 mm}
  - {like: a, crank_position: 144 deg, bore: 260 mm}
  - {like: a, crank_position: 216 deg, bore: 265 mm}
  - {like: a, crank_position: 288 deg, bore: 270 mm}
"""


def _table(heads: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    lines = [heads, ["---", *["--:"] * (len(heads) - 1)], *rows]
    return "\n".join(f"| {' | '.join(line)} |" for line in lines)


if __name__ == "__main__":
    main()
