"""Nothing is imported from the working directory, by no command and in no process that it starts."""

from __future__ import annotations

import os
import subprocess
import sys
from importlib.metadata import packages_distributions
from pathlib import Path

import pytest

from command_lines import LINES
from representative import few

MODULES = {*sys.stdlib_module_names, *packages_distributions(), "sitecustomize", "usercustomize"} - {"kurbel"}
STARTS = {"kurbel": [str(Path(sys.executable).with_name("kurbel"))], "-m": [sys.executable, "-m", "kurbel"]}


def own_of_runpy() -> set[str]:
    """Return what Python itself imports for `python -m`, from the working directory too, before it comes to kurbel."""
    code = "import runpy, importlib.util, importlib.machinery, sys; print(*sys.modules)"
    done = subprocess.run([sys.executable, "-I", "-c", code], capture_output=True, text=True, check=True)
    return {name.partition(".")[0] for name in done.stdout.split()}


def trap(folder: Path, names: set[str]) -> None:
    """Write a file for each of these modules, which prints that it is imported."""
    for name in names:
        (folder / f"{name}.py").write_text(f"import sys; sys.stderr.write('imported {name}\\n')\n", encoding="utf-8")


@pytest.fixture(scope="module", params=STARTS)
def start(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple[list[str], Path]:
    """A way to start kurbel, and a folder of traps."""
    folder = tmp_path_factory.mktemp("trapped")
    trap(folder, MODULES - (own_of_runpy() if request.param == "-m" else set()))
    return STARTS[request.param], folder


def ran(folder: Path, *command: str, **environment: str) -> tuple[int, str]:
    """Return status and standard error of a command in a folder."""
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, env=os.environ | environment)
    return done.returncode, done.stderr


@pytest.mark.parametrize("command", few(["sweep", "report", "accuracy", "plot", "example"], ["sweep"]))
def test_no_command_imports_from_the_working_directory(start: tuple[list[str], Path], command: str) -> None:
    """The processes of a sweep ran a file there that was named as a module of Python."""
    starting, folder = start
    assert ran(folder, *starting, *LINES[command]) == (0, "")


def test_an_empty_python_path_is_not_the_working_directory(tmp_path: Path) -> None:
    trap(tmp_path, {"click", "numpy", "yaml", "pickle"})
    assert ran(tmp_path, *STARTS["kurbel"], *LINES["sweep"], PYTHONPATH=os.pathsep) == (0, "")
