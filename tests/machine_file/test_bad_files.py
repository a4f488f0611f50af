"""Every bad machine file beside its full expected message."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from kurbel.errors import MachineFileError
from kurbel.machine_file import load, loads

FOLDER = Path(__file__).parent / "bad"
FILES = sorted(path.stem for path in FOLDER.glob("*.yaml"))


def _message(name: str, monkeypatch: pytest.MonkeyPatch) -> str:
    monkeypatch.chdir(FOLDER)
    with pytest.raises(MachineFileError) as caught:
        load(f"{name}.yaml")
    return str(caught.value)


def test_messages(monkeypatch: pytest.MonkeyPatch, kept: Callable[[Path, str], str]) -> None:
    told = {name: _message(name, monkeypatch) + "\n" for name in FILES}
    assert told == {name: kept(FOLDER / f"{name}.expected", message) for name, message in told.items()}


def test_pretty_shows_the_source_line_and_a_caret(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(FOLDER)
    with pytest.raises(MachineFileError) as caught:
        load("rod_too_short.yaml")
    assert caught.value.pretty().split("\n")[1:] == ["    rod: 300 mm", "         ^"]


@pytest.mark.parametrize("cells", [30, 60, 104])
def test_the_caret_is_below_the_fault_in_a_line_that_is_cut(cells: int) -> None:
    pairs = ", ".join(f"[{i}, 1]" for i in range(360))
    for text in (f"effort: {{unit: N m, points: [{pairs}, [360, x]]}}", "speed: x", f"speed: x  # {pairs}"):
        with pytest.raises(MachineFileError) as caught:
            loads(text)
        _, source, caret = caught.value.pretty(cells).split("\n")
        assert len(source) <= cells
        assert source[caret.index("^")] == "x"
