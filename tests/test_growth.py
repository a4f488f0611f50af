"""How the work of a command grows with what it is given: counted calls, peaks of memory, and CPU times in ratio.

No bound is a time. Python calls and peaks of memory are the same at every run; where the work is within numpy, CPU
times of one run are divided by one another, with margins of three and more.
"""

from __future__ import annotations

import cProfile
import pstats
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

import memory
from indicated import Engine, absolute, columns_file
from kurbel.cli import kurbel

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


def traced(samples: int, noise: float = 0.0) -> str:
    """A machine with a trace of so many samples in a file, with noise in bar."""
    angles = np.arange(samples) * 720 / samples
    shaken = absolute(Engine(), angles) + noise * np.random.default_rng(1).standard_normal(samples)
    columns_file(Path("p.csv"), np.column_stack((angles, shaken)))
    Path("m.yaml").write_text(ENGINE + TRACE % "file: p.csv")
    return "m.yaml"


def in_line(count: int) -> str:
    """A four-stroke engine with so many equal cylinders that fire at equal intervals, and a flywheel."""
    first = CYLINDER.strip().replace("\n", ", ")
    cylinders = [f"{{name: c0, {first}, indicator: {{head_end: {{{OTTO}}}}}}}"]
    cylinders += [f"{{like: c0, name: c{i}, crank_position: {720 * i / count!r} deg}}" for i in range(1, count)]
    text = "cycle: four-stroke\nspeed: 1500 rpm\nflywheel: {inertia: 1 kg m2}\ncylinders:\n"
    Path("m.yaml").write_text(text + "".join(f"  - {one}\n" for one in cylinders))
    return "m.yaml"


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


def test_a_picture_has_no_piece_for_every_crossing_in_the_noise() -> None:
    """A picture of 1000 dots across shows no more than it has dots, whatever crosses between them."""
    assert per_sample(lambda file: ("plot", file, "-o", "m.svg"), lambda n: traced(n, 3.0), 1000, 2000) < 5


# mechanisms and cylinders


def test_check_grows_with_the_cylinders_not_with_their_square() -> None:
    run("check", in_line(2))
    found = [peak("check", in_line(count)) for count in (12, 24)]
    assert found[1] < 2.5 * found[0]


# sweeps
