"""Every bad machine file with its full expected message; what a file may hold has bounds."""

from collections.abc import Callable
from pathlib import Path

import pytest

from command import run
from kurbel.errors import KurbelError, MachineFileError
from kurbel.machine_file import load, loads

FOLDER = Path(__file__).parent / "bad"
FILES = sorted(path.stem for path in FOLDER.glob("*.yaml"))


def _message(name: str, monkeypatch: pytest.MonkeyPatch) -> str:
    monkeypatch.chdir(FOLDER)
    with pytest.raises(MachineFileError) as caught:
        load(f"{name}.yaml")
    return str(caught.value)


def test_messages(monkeypatch: pytest.MonkeyPatch, kept: Callable[[Path, str], str]) -> None:
    reported = {name: _message(name, monkeypatch) + "\n" for name in FILES}
    assert reported == {
        name: kept(FOLDER / f"{name}.expected", message) for name, message in reported.items()
    }


def test_pretty_shows_the_source_line_and_a_caret(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(FOLDER)
    with pytest.raises(MachineFileError) as caught:
        load("rod_too_short.yaml")
    assert caught.value.pretty().split("\n")[1:] == ["    rod: 300 mm", "         ^"]


@pytest.mark.parametrize("cells", [30, 60, 104])
def test_the_caret_is_below_the_fault_in_a_line_that_is_cut(cells: int) -> None:
    pairs = ", ".join(f"[{i}, 1]" for i in range(360))
    for text in (
        f"effort: {{unit: N m, points: [{pairs}, [360, x]]}}",
        "{cylinders: x}",
        f"cylinders: x  # {pairs}",
    ):
        with pytest.raises(MachineFileError) as caught:
            loads(text)
        _, source, caret = caught.value.pretty(cells).split("\n")
        assert len(source) <= cells
        assert source[caret.index("^")] == "x"


# what a machine file may hold has bounds; every message has, too; no file is quoted that is none of figures

ENGINE = "speed: 60 rpm\ncrank: 400 mm\nrod_ratio: 5\n"
STEAM = (
    "indicator: {head_end: {steam: "
    "{admission: 160 bar, exhaust: 1 bar, cut_off: 0.3, clearance: 0.05, exponent: 1.1}}}\n"
)
TRACE = "bore: 1 m\nindicator: {{head_end: {{trace: {{file: {file}, unit: bar, angle_zero: {zero}{more}}}}}}}\n"


def test_nothing_that_was_built_gets_one() -> None:
    """The Cruquius engine: 144 inches; a large two-stroke diesel: 20 t; a model engine: 30,000 rpm."""
    largest = "rod_ratio: 5\nspeed: 10 rpm\ncrank: 1.5 m\nbore: 3658 mm\nmasses: {piston: 20 t}\n"
    fastest = "rod_ratio: 5\nspeed: 30000 rpm\ncrank: 6 mm\nbore: 12 mm\n"
    assert "beyond anything built" not in run("check", "-", text=largest).output
    assert "beyond anything built" not in run("check", "-", text=fastest).output
    engine = ENGINE + "bore: 450 mm\nflywheel: {fluctuation: 1/5}\n" + STEAM
    assert "is it right?" not in run("check", "-", text=engine).output
    pump = "indicator: {head_end: {constant: {expansion: 0 bar, compression: 1600 bar}}}\n"
    assert (
        "is its unit right?" not in run("check", "-", text=ENGINE + "bore: 20 mm\n" + pump).output
    )


LONG = 100_000


@pytest.mark.parametrize(
    "text",
    [
        "masses: " + "x" * LONG,
        "x" * LONG + ": 1",
        "crank: " + "a_" * LONG,
        "crank: " + "ab:c" * LONG,
        "crank: 1 m\n" + "bore" * LONG + ":4",
        "crank: " + "9" * LONG + " m",
        "rod_ratio: " + "1," * LONG,
        f"limits: {{{'x' * LONG}: 1}}",
        f"effort: {{unit: N m, points: [[0 {'1' * LONG}], [1, 2]]}}",
        f"effort: {{unit: N m, points: [[{'1, ' * 10_000}], [1, 2]]}}",
        f"effort: {{unit: {'N m ' * LONG}, points: [[0, 1], [360, 1]]}}",
        "cylinders:\n" + "- {crank: 1 m, rod_ratio: 5}\n" * 1000,
    ],
    ids=lambda text: text[:12],
)
def test_a_message_is_bounded_however_long_a_word_is(text: str) -> None:
    with pytest.raises(MachineFileError) as caught:
        loads(text)
    assert max(map(len, caught.value.pretty().split("\n"))) < 500


SECRET = "root:x:0:0:root:/root:/bin/bash\n"


@pytest.mark.parametrize("delimiter", ["comma", "space", "tab"])
@pytest.mark.parametrize(
    "content", [SECRET, f"0,{SECRET}", f"0 1\n{SECRET}", "-----BEGIN KEY-----\nMIIEpAIBAAKC\n"]
)
def test_no_text_of_a_file_is_quoted_that_is_no_trace(
    tmp_path: Path, delimiter: str, content: str
) -> None:
    (tmp_path / "passwd").write_text(content)
    keys = TRACE.format(file="passwd", zero="0 deg", more=f", delimiter: {delimiter}")
    (tmp_path / "m.yaml").write_text(ENGINE + keys)
    with pytest.raises(MachineFileError) as caught:
        load(tmp_path / "m.yaml")
    for word in ("root", "bash", "BEGIN", "MII"):
        assert word not in caught.value.faults[0].message


def test_a_line_without_end_is_not_loaded(tmp_path: Path) -> None:
    (tmp_path / "p.csv").write_text("1" * 1_000_000)
    (tmp_path / "m.yaml").write_text(ENGINE + TRACE.format(file="p.csv", zero="0 deg", more=""))
    with pytest.raises(KurbelError, match="has a line of more than 10000 characters"):
        load(tmp_path / "m.yaml")
