"""`kurbel plot`: what it draws, what it lists, and what it answers to wrong wishes."""

from __future__ import annotations

from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from kurbel.cli import kurbel
from kurbel.report.pictures import PICTURES
from representative import CONFIGS, few

WATERWORKS = str(CONFIGS["waterworks"])


def run(*args: str, text: str | None = None) -> Result:
    return CliRunner().invoke(kurbel, ["plot", *args], input=text)


def test_without_a_name_the_picture_that_says_most() -> None:
    result = run(WATERWORKS)
    assert result.exit_code == 0
    assert result.stdout.startswith("Waterworks engine, high-pressure side. Piston force\n")
    assert "P_max 137.0 kN, 360°" in result.stdout
    moving = run("-", text="{speed: 50 rpm, stroke: 800 mm, rod_ratio: 5}")
    assert moving.stdout.startswith("machine. Displacement, velocity, acceleration\n")


@pytest.mark.parametrize("name", few(["gas-engine", "crank-rocker"], ["crank-rocker"]))
def test_the_list_names_what_this_machine_has(name: str) -> None:
    listed = [line.split()[0] for line in run(str(CONFIGS[name]), "--list").stdout.splitlines()]
    assert listed == [one.id for one in PICTURES if one.id in listed]
    assert "motion" in listed
    assert ("throw-stress" in listed) == (name == "gas-engine")
    assert run(WATERWORKS, "--list", "-o", "x.svg").exit_code == 2
    unknown = run(str(CONFIGS[name]), "crd").stderr
    assert unknown.partition(" has ")[2].strip() == f"{', '.join(listed)})"


def test_without_a_file_the_list_names_every_picture() -> None:
    listed = run("--list").stdout.splitlines()
    assert [line.split()[0] for line in listed] == [one.id for one in PICTURES]
    assert all(one.title in line for one, line in zip(PICTURES, listed))
    assert "kurbel plot --list" in CliRunner().invoke(kurbel, ["--help"]).stdout
    nothing = run()
    assert (nothing.exit_code, "Missing argument 'FILE'." in nothing.stderr) == (2, True)


def test_a_mechanism_at_chosen_angles(tmp_path: Path) -> None:
    file = tmp_path / "m.svg"
    assert run(WATERWORKS, "mechanism", "--angles", "0,45,123.4567", "-o", str(file)).exit_code == 0
    text = file.read_text(encoding="utf-8")
    assert all(f"φ = {angle}°" in text for angle in (0, 45, 123.4567))
    assert "animate" not in text


@pytest.mark.parametrize(
    ("args", "message"),
    [
        (
            ["efort"],
            "no picture 'efort'; did you mean 'effort'? (Waterworks engine, high-pressure side has piston-force,",
        ),
        (["throw-stress"], "no 'crankshaft' is given"),
        (["card", "-o", "x.jpg"], "the name of a picture ends in .svg, .png or .pdf"),
        (["card", "-o", "nowhere/x.svg"], "cannot write nowhere/x.svg: No such file or directory"),
        (["card", "-o", "nowhere/x.pdf"], "cannot write nowhere/x.pdf: No such file or directory"),
        (["\x1b[31m<script>"], r"no picture '\u001b[31m<script>'"),
        (["mechanism", "--angles", "inf"], "inf"),
    ],
)
def test_wrong_wishes(args: list[str], message: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    result = run(WATERWORKS, *args)
    assert result.exit_code == 2
    assert message in result.stderr
    assert "\x1b" not in result.stderr
    assert not list(tmp_path.iterdir())


def test_without_typst_the_way_out_is_named(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    import importlib.util

    real = importlib.util.find_spec
    monkeypatch.setattr(importlib.util, "find_spec", lambda name, *more: None if name == "typst" else real(name, *more))
    result = run(WATERWORKS, "card", "-o", str(tmp_path / "x.pdf"))
    assert result.exit_code == 2
    assert (
        "a pdf needs typst, which is not installed: pip install 'kurbel[plot]'; an svg needs nothing" in result.stderr
    )
    assert run(WATERWORKS, "card", "-o", str(tmp_path / "x.svg")).exit_code == 0
