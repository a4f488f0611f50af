"""The studies of benchmarks/ still run: each once, as briefly as it can."""

import subprocess
import sys
from pathlib import Path

import pytest

FOLDER = Path(__file__).parents[2] / "benchmarks"
BRIEF = {
    "free_bodies.py": ["punch"],
    "oil_film.py": ["1"],
    "pareto_front.py": ["2000"],
    "random_cylinders.py": ["5"],
    "random_machines.py": ["5"],
    "reading.py": ["500"],
}


# these take seconds to minutes even at their shortest: they are run by hand, here only loaded
LONG = {
    "against_the_books.py",
    "flywheel.py",
    "metamorphic.py",
    "random_files.py",
    "speed_lines.py",
    "start_up.py",
    "stiff_scenes.py",
    "sweep.py",
    "torsion.py",
    "traces.py",
}


@pytest.mark.slow
@pytest.mark.parametrize("name", sorted({file.name for file in FOLDER.glob("*.py")} - LONG))
def test_benchmark_runs(name: str) -> None:
    command = [sys.executable, str(FOLDER / name), *BRIEF.get(name, [])]
    done = subprocess.run(command, capture_output=True, encoding="utf-8", check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout


@pytest.mark.slow
@pytest.mark.parametrize("name", sorted(LONG))
def test_long_benchmark_loads(name: str) -> None:
    module = name.removesuffix(".py")
    command = [sys.executable, "-c", f"import {module}; print({module}.main)"]
    done = subprocess.run(command, cwd=FOLDER, capture_output=True, encoding="utf-8", check=False)
    assert done.returncode == 0, done.stderr
    assert "function main" in done.stdout
