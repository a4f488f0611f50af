"""Every bad machine file beside its full expected message."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
import yaml
from click.testing import CliRunner

from kurbel.cli import kurbel
from kurbel.errors import Fault, MachineFileError
from kurbel.machine_file import load, loads
from kurbel.render.text import Look
from representative import few

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


@pytest.mark.parametrize("name", few(FILES, ["deep_nesting", *FILES[::16]]))
def test_same_message_without_libyaml(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delattr(yaml, "CSafeLoader", raising=False)
    assert _message(name, monkeypatch) + "\n" == (FOLDER / f"{name}.expected").read_text("utf-8")


def test_many_mistakes_are_told_in_one_run(monkeypatch: pytest.MonkeyPatch) -> None:
    lines = _message("five_mistakes", monkeypatch).split("\n")
    assert [int(line.split(":")[1]) for line in lines] == [2, 3, 4, 9, 11, 13, 14, 15, 17, 19]


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


def test_the_source_line_is_shown_as_the_terminal_can_show_it() -> None:
    fault = Fault((), "wrong", line=1, column=9, source_line="ß ° \x1b[31m b")
    shown = MachineFileError("m.yaml", [fault]).pretty(spelt=Look(encoding="ascii").text).split("\n")
    assert all(line.isascii() and line.isprintable() for line in shown)
    assert shown[1][shown[2].index("^")] == "m"


def test_columns_of_this_machine_are_listed_first(solved_once: None) -> None:
    configs = Path(__file__).parents[2] / "configs"
    refused = CliRunner().invoke(kurbel, ["motion", str(configs / "scotch-yoke-pump.yaml"), "--columns", "theeta"])
    meant = "no column of kurbel motion; did you mean 'theta'? (this machine has phi (φ), z, x, c, b, c_block"
    assert f"'theeta' is {meant}" in refused.stderr
    for command in (["motion"], ["stress", "--places"]):
        refused = CliRunner().invoke(kurbel, [*command, str(configs / "gas-engine.yaml"), "--columns", "nonsense"])
        assert (refused.exit_code, f"'nonsense' is no column of kurbel {command[0]}" in refused.stderr) == (2, True)
