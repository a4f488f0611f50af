"""How the work of a command grows with what it is given: counted calls, peaks of memory, and CPU times in ratio.

No bound is a time. Python calls and peaks of memory are the same at every run; where the work is within numpy, CPU
times of one run are divided by one another, with margins of three and more.
"""

from __future__ import annotations

import cProfile
import pstats
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

import memory
from indicated import Engine, absolute, columns_file
from kurbel.cli import kurbel
from swept_rows import WATERWORKS

CYLINDER = "stroke: 100 mm\nrod_ratio: 4\nbore: 90 mm\nmasses: {reciprocating: 1 kg}\n"
ENGINE = f"cycle: four-stroke\nspeed: 1500 rpm\n{CYLINDER}"
TRACE = "indicator: {pressures: absolute, head_end: {trace: {unit: bar, %s}}}\n"
OTTO = "otto: {intake: 0 bar, exhaust: 0.1 bar, compression_ratio: 9, exponent: 1.33, peak: 40 bar}"


@pytest.fixture(autouse=True)
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def run(*words: str) -> None:
    result = CliRunner().invoke(kurbel, list(words))
    assert result.exit_code == 0, result.output


def calls(*words: str) -> int:
    """How many functions a command calls, once all that it imports is there."""
    profile = cProfile.Profile()
    profile.runcall(run, *words)
    return int(pstats.Stats(profile).total_calls)  # type: ignore[attr-defined]


def peak(*words: str) -> int:
    """Bytes that a command has at most."""
    return memory.peak(lambda: run(*words))[1]


def cpu(work: Callable[[], object]) -> float:
    """Seconds of the processor, the least of two runs."""
    found = []
    for _ in range(2):
        begun = time.process_time()
        work()
        found.append(time.process_time() - begun)
    return min(found)


def traced(samples: int, noise: float = 0.0) -> str:
    """A machine with a trace of so many samples in a file, with noise in bar."""
    angles = np.arange(samples) * 720 / samples
    shaken = absolute(Engine(), angles) + noise * np.random.default_rng(1).standard_normal(samples)
    columns_file(Path("p.csv"), np.column_stack((angles, shaken)))
    Path("m.yaml").write_text(ENGINE + TRACE % "file: p.csv")
    return "m.yaml"


def pointed(samples: int) -> str:
    """A machine with as many samples in its own file."""
    angles = np.arange(samples) * 720 / samples
    points = ", ".join(f"[{a:.6f}, {p:.4f}]" for a, p in zip(angles, absolute(Engine(), angles)))
    Path("m.yaml").write_text(ENGINE + TRACE % f"points: [{points}]")
    return "m.yaml"


def in_line(count: int) -> str:
    """A four-stroke engine with so many equal cylinders that fire at equal intervals, and a flywheel."""
    first = CYLINDER.strip().replace("\n", ", ")
    cylinders = [f"{{name: c0, {first}, indicator: {{head_end: {{{OTTO}}}}}}}"]
    cylinders += [f"{{like: c0, name: c{i}, crank_position: {720 * i / count!r} deg}}" for i in range(1, count)]
    text = "cycle: four-stroke\nspeed: 1500 rpm\nflywheel: {inertia: 1 kg m2}\ncylinders:\n"
    Path("m.yaml").write_text(text + "".join(f"  - {one}\n" for one in cylinders))
    return "m.yaml"


def swept(rows: int, *options: str) -> tuple[str, ...]:
    """A sweep of so many rows in one process."""
    values = f"rod_ratio=3:{3 + (rows - 1) * 1e-4:.4f}:0.0001"
    return "sweep", WATERWORKS, "--vary", values, "--columns", "stroke", "-j", "1", *options


def per_sample(command: Callable[[str], tuple[str, ...]], machine: Callable[[int], str], few: int, many: int) -> float:
    """Calls of a command for each further sample."""
    run(*command(machine(few)))
    counted = [calls(*command(machine(samples))) for samples in (few, many)]
    return (counted[1] - counted[0]) / (many - few)


# samples: 500,000 are allowed, and each command is to take 5 s at most, so 10 microseconds a sample


@pytest.mark.parametrize("noise", [0.0, 3.0])
def test_check_takes_the_samples_of_a_file_together(noise: float) -> None:
    """No call a sample: what is done with them is done in whole arrays."""
    assert per_sample(lambda file: ("check", file), lambda n: traced(n, noise), 2000, 4000) < 0.1


def test_a_smooth_trace_is_drawn_from_whole_arrays() -> None:
    assert per_sample(lambda file: ("plot", file, "-o", "m.svg"), traced, 2000, 4000) < 0.1


def test_a_picture_has_no_piece_for_every_crossing_in_the_noise() -> None:
    """A picture of 1000 dots across shows no more than it has dots, whatever crosses between them."""
    assert per_sample(lambda file: ("plot", file, "-o", "m.svg"), lambda n: traced(n, 3.0), 1000, 2000) < 5


@pytest.mark.slow
def test_a_report_finds_no_root_for_every_crossing_in_the_noise() -> None:
    assert per_sample(lambda file: ("report", file, "-o", "m.html"), lambda n: traced(n, 1.0), 100, 200) < 20


@pytest.mark.slow
def test_a_report_of_a_smooth_trace_takes_a_few_times_its_reading() -> None:
    run("report", traced(500), "-o", "m.html")
    found = [cpu(lambda n=samples: run("report", traced(n), "-o", "m.html")) for samples in (500, 2000)]
    traced(100_000)
    reading = 1500 / 100_000 * cpu(lambda: np.loadtxt("p.csv", delimiter=","))
    assert found[1] - found[0] < 50 * reading


# mechanisms and cylinders


def test_a_rod_hardly_longer_than_the_crank_has_orders_that_fit() -> None:
    """At L/R = 1.0000001 they are 131,000, of which a few copies are held; the machine itself is no larger."""
    Path("n.yaml").write_text("speed: 1 rpm\nstroke: 1 m\nrod_ratio: 1.0000001\nmasses: {reciprocating: 10 kg}\n")
    assert peak("balance", "n.yaml") < 150e6


def test_check_grows_with_the_cylinders_not_with_their_square() -> None:
    run("check", in_line(2))
    found = [peak("check", in_line(count)) for count in (12, 24)]
    assert found[1] < 2.5 * found[0]


@pytest.mark.slow
@pytest.mark.xfail(
    strict=True,
    raises=AssertionError,
    reason="200,000 calls for each further cylinder equal to the first (100: over 40 s), a third of the first",
)
def test_a_report_solves_equal_cylinders_once() -> None:
    """5 s for 100 cylinders leave a tenth of today's work to each."""
    run("report", in_line(2), "-o", "m.html")
    found = [calls("report", in_line(count), "-o", "m.html") for count in (2, 3)]
    assert found[1] - found[0] < 40_000


# sweeps


@pytest.mark.slow
def test_the_front_of_two_aims_takes_hardly_more_than_its_rows() -> None:
    """Of one aim against itself every row is on the front; two aims need no more than an order of the rows."""
    run(*swept(100))
    plain, chosen = (cpu(lambda a=aims: run(*swept(6000, *a))) for aims in ((), ("--pareto", "rod_ratio,-rod_ratio")))
    assert chosen < 4 * plain


def test_resume_reads_a_row_faster_than_it_is_computed() -> None:
    found = {}
    for rows in (500, 1500):
        run(*swept(rows, "-o", f"{rows}.csv"))
        computed = calls(*swept(rows, "-o", f"{rows}.csv"))
        found[rows] = computed, calls(*swept(rows, "-o", f"{rows}.csv", "--resume"))
    computed, resumed = np.subtract(found[1500], found[500]) / 1000
    assert resumed < computed / 2


@pytest.mark.slow
def test_resume_does_not_hold_the_whole_file() -> None:
    wide = ("--vary", f"name={'x' * 200}", "--vary", f"tandem.0.name={'x' * 200}")
    found = []
    for rows in (500, 16_000):
        run(*swept(rows, *wide, "-o", f"{rows}.csv"))
        found.append(peak(*swept(rows, *wide, "-o", f"{rows}.csv", "--resume")))
    assert found[1] < 1.2 * found[0]
