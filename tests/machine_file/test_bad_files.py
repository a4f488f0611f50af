"""Every bad machine file beside its full expected message."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
import yaml

from kurbel.errors import MachineFileError
from kurbel.machine_file import load

FOLDER = Path(__file__).parent / "bad"
FILES = sorted(path.stem for path in FOLDER.glob("*.yaml"))


def _message(name: str, monkeypatch: pytest.MonkeyPatch) -> str:
    monkeypatch.chdir(FOLDER)
    with pytest.raises(MachineFileError) as caught:
        load(f"{name}.yaml")
    return str(caught.value)


@pytest.mark.parametrize("name", FILES)
def test_message(name: str, monkeypatch: pytest.MonkeyPatch, kept: Callable[[Path, str], str]) -> None:
    message = _message(name, monkeypatch) + "\n"
    assert message == kept(FOLDER / f"{name}.expected", message)


@pytest.mark.parametrize("name", FILES)
def test_same_message_without_libyaml(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delattr(yaml, "CSafeLoader", raising=False)
    assert _message(name, monkeypatch) + "\n" == (FOLDER / f"{name}.expected").read_text("utf-8")


def test_there_are_enough_of_them() -> None:
    assert len(FILES) >= 70
    assert {path.stem for path in FOLDER.glob("*.expected")} == set(FILES)


def test_many_mistakes_are_told_in_one_run(monkeypatch: pytest.MonkeyPatch) -> None:
    lines = _message("five_mistakes", monkeypatch).split("\n")
    assert [int(line.split(":")[1]) for line in lines] == [2, 3, 4, 9, 11, 13, 14, 15, 17, 19]


def test_pretty_shows_the_source_line_and_a_caret(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(FOLDER)
    with pytest.raises(MachineFileError) as caught:
        load("rod_too_short.yaml")
    assert caught.value.pretty().split("\n")[1:] == ["    rod: 300 mm", "         ^"]


def test_pretty_cuts_a_long_line_round_the_fault() -> None:
    from kurbel.machine_file import loads

    pairs = ", ".join(f"[{i}, 1]" for i in range(360))
    with pytest.raises(MachineFileError) as caught:
        loads(f"effort: {{unit: N m, points: [{pairs}, [360, x]]}}")
    _, source, caret = caught.value.pretty().split("\n")
    assert len(source) < 120
    assert source[caret.index("^")] == "x"


def test_pretty_clears_what_could_steer_a_terminal() -> None:
    from kurbel.errors import Fault

    error = MachineFileError("m.yaml", [Fault((), "wrong", line=1, column=3, source_line="a\x1b[31m b")])
    assert "\x1b" not in error.pretty()
