"""Key values of many designs at once, against a loop over single machines in the same run.

    python benchmarks/sweep.py [ROWS]

Times are of the processor, of a design and cylinder; rows are designs of the waterworks machine, whose one cylinder has
four chambers.
"""

from __future__ import annotations

import os
import resource
import sys
import time
from collections.abc import Callable
from pathlib import Path

# one core, as in the program: others that wait for their part of a small product are busy doing it
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np

from kurbel.designs.answers import Answer, answered_alone, answers_of, requested_answers
from kurbel.designs.binding import Batch, Binder
from kurbel.designs.plan import read_axis
from kurbel.designs.sweep import Spec, Sweep, computed_rows
from kurbel.machine_file import source
from kurbel.machine_file.reader import read_machine
from kurbel.render import Look
from kurbel.render.sweep_rows import Titles, head_and_row_lines

CONFIGS = Path(__file__).parent.parent / "configs"
WATERWORKS = "waterworks"
OTHERS = (
    "locomotive",
    "gas-engine",
    "offset-engine",
    "steam-ideal",
    "diesel-two-stroke",
    "gas-engine-double-acting",
)
"""Machines whose rods and speeds are varied, too."""
CHAPTERS = (
    ("waterworks-two-cranks", ("dE",)),
    ("four-cylinder-generator", ("delta",)),
    ("four-in-line", ("F_free_max", "M_free_max", "counterweight_best")),
    ("gas-engine", ("load_max", "unloaded_arc")),
    ("gas-engine", ("sigma_pin_max",)),
    (
        "triplex-pump",
        (
            "flow_mean",
            "flow_max",
            "flow_min",
            "volume_fluctuation",
            "vessel_swing",
            "suction_lift_max",
        ),
    ),
)
"""Key values of the whole machine."""
DESIGNS, SINGLE, RUNS = 1000, 10, 5


def seconds(task: Callable[[], object]) -> float:
    """Processor time of a task, the least of so many runs: others on the machine make it only longer."""
    times = []
    for _ in range(RUNS):
        begin = time.process_time()
        task()
        times.append(time.process_time() - begin)
    return min(times)


def designs(name: str, count: int) -> list[Batch]:
    """Machines like one that is shipped, with rods and speeds of every length and size."""
    binder = Binder(source.read(CONFIGS / f"{name}.yaml"), ("rod_ratio", "speed"), ("5", "50 rpm"))
    ratios = np.linspace(3, 6, count)
    return binder.bound(binder.columns(np.column_stack([ratios, (40 + ratios) / 60])))[0]


def at_speeds(name: str, count: int) -> list[Batch]:
    """Machines like one that is shipped, at so many speeds."""
    origin = source.read(CONFIGS / f"{name}.yaml")
    speed = 60 * (read_machine(origin).speed or 1.0)
    binder = Binder(origin, ("speed",), (f"{speed} rpm",))
    return binder.bound(binder.columns(speed / 60 * np.linspace(0.9, 1.1, count)[:, np.newaxis]))[0]


def report(name: str, many: float, count: int, single: float | None = None) -> None:
    """Print a line: microseconds a design, and how often faster than alone."""
    ratio = "" if single is None else f"{single / (many / count):>8.0f} x"
    print(f"{name:<48}{many / count * 1e6:>10.0f} us{ratio}")


def beside_alone(name: str, batches: list[Batch], requested: list[Answer]) -> None:
    """Compare machines side by side with the same ones alone."""
    alone = [batches[0].single(place) for place in range(SINGLE)]
    single = seconds(lambda: [answered_alone(machine, requested) for machine in alone]) / SINGLE
    report(name, seconds(lambda: answers_of(batches, requested)), DESIGNS, single)


def main() -> None:
    """Print the table."""
    rows = int(sys.argv[1]) if len(sys.argv) > 1 else 10_000
    angles = np.linspace(0.0, 1000.0, 1_000_000)
    print(f"np.sin of a million doubles: {seconds(lambda: np.sin(angles)) * 1e3:.1f} ms")
    machines = designs(WATERWORKS, DESIGNS)
    every = list(requested_answers(machines[0].single(0), ()))
    motion = [
        one for one in every if one.quantity.id in ("c_m", "c_max", "b_max", "b_min", "phi_b_zero")
    ]
    beside_alone(f"key values of forces: {WATERWORKS}", machines, every)
    beside_alone(f"motion alone: {WATERWORKS}", machines, motion)
    for name in OTHERS:
        batches = designs(name, DESIGNS)
        beside_alone(
            f"key values of forces: {name}",
            batches,
            list(requested_answers(batches[0].single(0), ())),
        )
    for name, columns in CHAPTERS:
        batches = at_speeds(name, DESIGNS)
        beside_alone(
            f"{', '.join(columns)}: {name}",
            batches,
            list(requested_answers(batches[0].single(0), columns)),
        )
    report("binding to the file", seconds(lambda: designs(WATERWORKS, DESIGNS)), DESIGNS)
    axes = (read_axis("rod_ratio=uniform(3, 6)"), read_axis("speed=uniform(40, 60 rpm)"))
    begin = time.process_time()
    sweep = Sweep(Spec(source.read(CONFIGS / f"{WATERWORKS}.yaml"), axes, sample=rows))
    titles = Titles(tuple((head.id, head.unit) for head in sweep.heads), sweep.texts)
    size = sum(
        map(len, map(head_and_row_lines(titles, Look("csv"))[1], computed_rows(sweep, range(rows))))
    )
    report(f"{rows} rows with {len(sweep.heads)} columns as csv", time.process_time() - begin, rows)
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    print(f"{size / 1e6:.1f} MB written, {memory:.0f} MB of memory at most")


if __name__ == "__main__":
    main()
