"""The studies of benchmarks/ still run: each once, as briefly as it can be told to."""

import subprocess
import sys
from pathlib import Path

import pytest

FOLDER = Path(__file__).parent.parent / "benchmarks"
BRIEF = {
    "pareto_front.py": ["2000"],
    "random_cylinders.py": ["5"],
    "random_files.py": ["5"],
    "random_machines.py": ["5"],
    "reading.py": ["500"],
    "speed_lines.py": ["1"],
    "start_up.py": ["1"],
    "sweep.py": ["20"],
}


# these take minutes even at their shortest, and are run by hand
LONG = {"metamorphic.py", "stiff_scenes.py"}


@pytest.mark.slow
@pytest.mark.parametrize("name", sorted({file.name for file in FOLDER.glob("*.py")} - LONG))
def test_benchmark_runs(name: str) -> None:
    command = [sys.executable, str(FOLDER / name), *BRIEF.get(name, [])]
    done = subprocess.run(command, capture_output=True, encoding="utf-8", check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout
