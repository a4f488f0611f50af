"""Every bad machine file beside its full expected message."""

from __future__ import annotations

from collections.abc import Callable
from itertools import product
from pathlib import Path

import pytest
import yaml

from kurbel.errors import MachineFileError
from kurbel.machine_file import load
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


@pytest.mark.parametrize("cells", [30, 40, 80, 104])
@pytest.mark.parametrize("encoding", ["utf-8", "ascii"])
def test_the_caret_stands_below_the_fault_at_every_width(cells: int, encoding: str) -> None:
    """Wide letters, letters that become two, and lines wider than the terminal."""
    from kurbel.errors import Fault
    from kurbel.render.text import Look, width

    for before, (filling, after) in product((0, 1, 7, 40, 90), (("x", 0), ("φ", 3), ("宽", 200), ("ß", 50))):
        text = filling * before + "@" + filling * after
        error = MachineFileError("m", [Fault((), "wrong", line=1, column=before + 1, source_line=text)])
        _, source, caret = error.pretty(cells, Look(encoding=encoding).text, width).split("\n")
        assert width(source) <= cells
        assert width(source[: source.index("@")]) == caret.index("^")


def test_a_line_of_a_million_characters_is_cut() -> None:
    from kurbel.errors import Fault

    text = "x" * 500_000 + "@" + "x" * 500_000
    error = MachineFileError("m", [Fault((), "wrong", line=1, column=500_001, source_line=text)])
    _, source, caret = error.pretty().split("\n")
    assert source[caret.index("^")] == "@"


def test_a_terminal_gets_lines_that_fit(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from click.testing import CliRunner

    from kurbel.cli import kurbel

    monkeypatch.setenv("COLUMNS", "60")
    pairs = ", ".join(f"[{i}, 1]" for i in range(360))
    (tmp_path / "m.yaml").write_text(f"effort: {{unit: N m, points: [{pairs}, [360, x]]}}")
    told = CliRunner().invoke(kurbel, ["check", str(tmp_path / "m.yaml")]).stderr.splitlines()
    assert len(told[-2]) <= 60
    assert told[-2][told[-1].index("^")] == "x"


def test_columns_of_this_machine_are_told_first(solved_once: None) -> None:
    from click.testing import CliRunner

    from kurbel.cli import kurbel

    file = str(Path(__file__).parents[2] / "configs" / "scotch-yoke-pump.yaml")
    told = CliRunner().invoke(kurbel, ["motion", file, "--columns", "theeta"]).stderr
    assert (
        "'theeta' is no column of kurbel motion; did you mean 'theta'? (this machine has phi (φ), z, x, c, b, c_block"
        in told
    )
    for command in (["motion"], ["stress", "--places"]):
        file = str(Path(__file__).parents[2] / "configs" / "gas-engine.yaml")
        refused = CliRunner().invoke(kurbel, [*command, file, "--columns", "nonsense"])
        assert (refused.exit_code, f"'nonsense' is no column of kurbel {command[0]}" in refused.stderr) == (2, True)
