"""How the work of a command grows with what it is given: counted calls, which are the same at every run."""

import cProfile
import pstats
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from command import printed
from indicated import Engine, absolute, columns_file

CYLINDER = "stroke: 100 mm\nrod_ratio: 4\nbore: 90 mm\nmasses: {reciprocating: 1 kg}\n"
ENGINE = f"cycle: four-stroke\nspeed: 1500 rpm\n{CYLINDER}"
TRACE = "indicator: {pressures: absolute, head_end: {trace: {unit: bar, %s}}}\n"


@pytest.fixture(autouse=True)
def here(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)


def calls(*words: str) -> int:
    """How many functions a command calls, once all that it imports is there."""
    profile = cProfile.Profile()
    profile.runcall(printed, *words)
    return int(pstats.Stats(profile).total_calls)


def traced(samples: int, noise: float = 0.0) -> str:
    """A machine with a trace of so many samples in a file, with noise in bar."""
    angles = np.arange(samples) * 720 / samples
    shaken = absolute(Engine(), angles) + noise * np.random.default_rng(1).standard_normal(samples)
    columns_file(Path("p.csv"), np.column_stack((angles, shaken)))
    Path("m.yaml").write_text(ENGINE + TRACE % "file: p.csv")
    return "m.yaml"


def per_sample(
    command: Callable[[str], tuple[str, ...]], machine: Callable[[int], str], few: int, many: int
) -> float:
    """Calls of a command for each further sample."""
    printed(*command(machine(few)))
    counted = [calls(*command(machine(samples))) for samples in (few, many)]
    return (counted[1] - counted[0]) / (many - few)


# samples: 500,000 are allowed, and each command is to take 5 s at most, so 10 microseconds a sample


@pytest.mark.parametrize("noise", [0.0, 3.0])
def test_check_takes_the_samples_of_a_file_together(noise: float) -> None:
    """No call a sample: what is done with them is done in whole arrays."""
    assert per_sample(lambda file: ("check", file), lambda n: traced(n, noise), 2000, 4000) < 0.1


def test_a_picture_has_no_piece_for_every_crossing_in_the_noise() -> None:
    """A picture of 1000 dots across shows no more than it has dots, whatever crosses between them."""
    assert (
        per_sample(lambda file: ("plot", file, "-o", "m.svg"), lambda n: traced(n, 3.0), 1000, 2000)
        < 5
    )
