"""`kurbel plot`: what it draws, what it lists, and what it answers to wrong wishes."""

import re
from pathlib import Path

import pytest

from command import run
from kurbel.pictures.picture_source import PictureOptions
from kurbel.pictures.pictures import PICTURES, pictures
from kurbel.render import Look
from kurbel.render.paper import PAPERS, sheets
from representative import CONFIGS, case_of, few

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


def sizes_of_pages(file: Path) -> list[tuple[int, int]]:
    """Width and height in points of each page of a pdf."""
    boxes = re.findall(rb"/MediaBox *\[0 0 ([\d.]+) ([\d.]+)\]", file.read_bytes())
    return [(round(float(wide)), round(float(tall))) for wide, tall in boxes]


def test_a_pdf_has_a_sheet_for_each_picture_and_each_angle(tmp_path: Path) -> None:
    """A4 has 210 mm × 297 mm, letter 8.5 in × 11 in; a point is 1/72 in."""
    pytest.importorskip("typst")
    file, machine = tmp_path / "x.pdf", str(CONFIGS["waterworks"])
    run("plot", machine, "forces", "motion", "-o", str(file))
    assert sorted(sizes_of_pages(file)) == [(595, 842), (842, 595)]
    lesson = ("plot", machine, "construction", "--angles", "30,60,120", "-o", str(file))
    assert run(*lesson, "--paper", "letter").exit_code == 0
    assert sizes_of_pages(file) == [(612, 792)] * 3
    # as large as the pictures, for those who put them into a document
    assert run(*lesson, "--paper", "fit").exit_code == 0
    ((wide, tall),) = sizes_of_pages(file)
    assert wide == 552
    assert tall > 3 * 600


def test_nothing_of_a_picture_is_lost_between_sheets() -> None:
    for name in ("waterworks", "diesel-trace"):
        drawn = list(pictures(case_of(name), ("all",), PictureOptions(angles=(0.0, 60.0))))
        paged = list(sheets(drawn, PAPERS["a4"], Look()))
        panels = [panel for picture in drawn for panel in picture.panels]
        assert [panel for sheet in paged for panel in sheet.picture.panels] == panels
        # an upright sheet has room for it in its whole width
        for sheet in paged:
            assert sheet.tall <= PAPERS["a4"].height_over_width(lies=False)
            assert len({panel.angle for panel in sheet.picture.panels}) == 1


def test_the_paper_is_that_of_a_pdf() -> None:
    for file, more in (("x.svg", ()), ("x.pdf", ("--poster", "A2"))):
        result = run("plot", WATERWORKS, "-o", file, "--paper", "letter", *more)
        assert result.exit_code == 2
        assert "--paper letter is for pictures in a pdf" in result.stderr


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
