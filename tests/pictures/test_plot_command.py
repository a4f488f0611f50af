"""`kurbel plot`: what it draws, what it lists, and what it answers to wrong wishes."""

from pathlib import Path

import pytest

from command import run
from kurbel.pictures.pictures import PICTURES
from representative import CONFIGS, few

WATERWORKS = str(CONFIGS["waterworks"])


def test_without_a_name_the_picture_that_shows_most() -> None:
    result = run("plot", WATERWORKS)
    assert result.exit_code == 0
    assert result.stdout.startswith("Waterworks engine, high-pressure side. Piston force\n")
    assert "P_max 137.0 kN, 360°" in result.stdout
    moving = run("plot", "-", text="{speed: 50 rpm, stroke: 800 mm, rod_ratio: 5}")
    assert moving.stdout.startswith("machine. Displacement, velocity, acceleration\n")


@pytest.mark.parametrize("name", few(["gas-engine", "crank-rocker"], ["crank-rocker"]))
def test_the_list_names_what_this_machine_has(name: str) -> None:
    listed = [
        line.split()[0] for line in run("plot", str(CONFIGS[name]), "--list").stdout.splitlines()
    ]
    assert listed == [picture.id for picture in PICTURES if picture.id in listed]
    assert "motion" in listed
    assert ("throw-stress" in listed) == (name == "gas-engine")
    unknown = run("plot", str(CONFIGS[name]), "crd").stderr
    assert unknown.partition(" has ")[2].strip() == f"{', '.join(listed)})"


def test_without_a_file_the_list_names_every_picture() -> None:
    listed = run("plot", "--list").stdout.splitlines()
    assert [line.split()[0] for line in listed] == [picture.id for picture in PICTURES]
    assert all(one.title in line for one, line in zip(PICTURES, listed))
    assert "kurbel plot --list" in run("--help").stdout


def test_a_mechanism_at_chosen_angles(tmp_path: Path) -> None:
    file = tmp_path / "m.svg"
    assert (
        run("plot", WATERWORKS, "mechanism", "--angles", "0,45,123.4567", "-o", str(file)).exit_code
        == 0
    )
    text = file.read_text(encoding="utf-8")
    assert all(f"φ = {angle}°" in text for angle in (0, 45, 123.4567))
    assert "animate" not in text


def test_without_typst_the_way_out_is_named(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    import importlib.util

    real = importlib.util.find_spec
    monkeypatch.setattr(
        importlib.util,
        "find_spec",
        lambda name, *more: None if name == "typst" else real(name, *more),
    )
    result = run("plot", WATERWORKS, "card", "-o", str(tmp_path / "x.pdf"))
    assert result.exit_code == 2
    assert (
        "a pdf needs typst, which is not installed: pip install typst; svg needs no package"
        in result.stderr
    )
    assert run("plot", WATERWORKS, "card", "-o", str(tmp_path / "x.svg")).exit_code == 0
