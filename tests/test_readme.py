"""README and docs cannot go stale: every console block is run and compared, every generated page regenerated."""

from __future__ import annotations

import doctest
import os
import re
import shutil
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from kurbel.report.symbols import symbols_page

ROOT = Path(__file__).parent.parent
README = ROOT / "README.md"
BLOCK = re.compile(r"```console\n(\$ [^\n]*)\n(.*?)```", re.DOTALL)
BROKEN = """\
name: Engine with five mistakes
speed: 50
crank: 400 mm
rod: 300 mm
boore: 450 mm
indicator:
  head_end:
    unit: at
    expansion:   [[0, 9,5], [1, 2.2]]
    compression: [[1, 1.2], [0.25, 1.2], [0, 9.5]]
  crank_end: mirrord
"""

NO_SHELL = os.name != "posix" or shutil.which("bash") is None
pytestmark = pytest.mark.skipif(NO_SHELL, reason="the README speaks to a shell")


@pytest.fixture(scope="module")
def workshop(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the files that the README speaks of, and `kurbel` on the path."""
    folder = tmp_path_factory.mktemp("readme")
    demo = re.search(r"```yaml\n(name: Demo.*?)```", README.read_text(encoding="utf-8"), re.DOTALL)
    assert demo
    (folder / "demo.yaml").write_text(demo.group(1), encoding="utf-8")
    (folder / "broken.yaml").write_text(BROKEN, encoding="utf-8")
    shutil.copytree(ROOT / "configs", folder / "configs")
    script = folder / "bin" / "kurbel"
    script.parent.mkdir()
    script.write_text(f'#!/bin/sh\nexec "{sys.executable}" -m kurbel "$@"\n')
    script.chmod(0o755)
    return folder


def output_of(command: str, folder: Path) -> str:
    environment = {k: v for k, v in os.environ.items() if k not in ("FORCE_COLOR", "COLUMNS")}
    environment |= {"PATH": f"{folder / 'bin'}{os.pathsep}{environment['PATH']}", "PYTHONIOENCODING": "utf-8"}
    done = subprocess.run(
        ["bash", "-c", command.removeprefix("$ ")],
        cwd=folder,
        env=environment,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        check=False,
    )
    return done.stdout.decode()


BLOCKS = BLOCK.findall(README.read_text(encoding="utf-8"))


@pytest.mark.parametrize(("command", "printed"), BLOCKS, ids=[command[2:60] for command, _ in BLOCKS])
def test_commands_of_the_readme(command: str, printed: str, workshop: Path, kept: Callable[[Path, str], str]) -> None:
    real = output_of(command, workshop)
    text = README.read_text(encoding="utf-8")
    now = text.replace(f"{command}\n{printed}```", f"{command}\n{real}```")
    if now != kept(README, now):
        assert real == printed


def test_python_of_the_readme(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(ROOT)
    found = doctest.testfile(str(README), module_relative=False, encoding="utf-8")
    assert found.attempted > 3
    assert found.failed == 0


def test_the_readme_has_commands() -> None:
    assert len(BLOCKS) >= 4


def test_the_page_of_symbols_is_current(kept: Callable[[Path, str], str]) -> None:
    assert kept(ROOT / "docs" / "symbols.md", symbols_page()) == symbols_page()
