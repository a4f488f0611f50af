"""The printed page: golden files, widths, blocks, characters."""

from collections.abc import Callable
from pathlib import Path

import pytest
from hypothesis import given

from kurbel.render import Look
from kurbel.render.formats import render
from kurbel.render.page import book_sizes
from kurbel.render.text import folded, width
from kurbel.report.zusammenstellung import zusammenstellung
from render.sample_report import ONE, REPORT, texts

GOLDEN = Path(__file__).parent.parent / "golden"

PAGES = {
    "table.txt": (zusammenstellung(), Look()),
    "table-compare-comma.txt": (zusammenstellung(compare=True), Look(comma=True)),
    "table-rows.txt": (zusammenstellung((4.5,), ("b", "c", "psi", "N")), Look(layout="rows")),
    "table-80.txt": (zusammenstellung(), Look(width=80)),
    "table-ascii.txt": (
        zusammenstellung(formula="first-order", rows=("b", "c", "x", "psi")),
        Look(encoding="ascii"),
    ),
    "table.md": (zusammenstellung((5.0,)), Look("markdown")),
    "forces.txt": (ONE, Look()),
    "forces-cylinders.txt": (REPORT, Look()),
    "forces-rows-ascii.txt": (REPORT, Look(layout="rows", encoding="ascii")),
    "forces-40.txt": (ONE, Look(width=40)),
    "forces-comma.md": (REPORT, Look("markdown", comma=True)),
    "forces.csv": (REPORT, Look("csv")),
    "forces.json": (REPORT, Look("json")),
    "forces.html": (REPORT, Look("html")),
    "forces-comma.tex": (REPORT, Look("latex", comma=True)),
    "table.tex": (zusammenstellung((5.0,)), Look("latex")),
}


@pytest.mark.parametrize("name", PAGES)
def test_golden(name: str, kept: Callable[[Path, str], str]) -> None:
    text = render(*PAGES[name])
    assert text == kept(GOLDEN / name, text)


@pytest.mark.parametrize(
    ("count", "sizes"),
    [(0, [0]), (1, [1]), (9, [9]), (10, [10]), (11, [9, 2]), (19, [9, 10]), (37, [9, 9, 9, 10])],
)
def test_blocks_as_in_the_book(count: int, sizes: list[int]) -> None:
    assert book_sizes(count) == sizes


@pytest.mark.parametrize("columns", [40, 60, 80, 120, 200])
def test_tables_fit_the_terminal(columns: int) -> None:
    for report in (ONE, zusammenstellung()):
        lines = render(report, Look(width=columns)).splitlines()[1:]
        assert max(map(width, lines)) <= columns


SAID = "Of order 3 (-1.78 %) within 10 % of 110 rpm it bears 2.35 kN m at 30.5 °, 12 m/s² and 9 lbf ft/rad in 4 parts."


@pytest.mark.parametrize("columns", range(24, 81, 4))
def test_no_line_ends_between_a_number_and_its_unit(columns: int) -> None:
    """`10` stood at the end of a line and `%` before the next one."""
    lines = folded(SAID, columns)
    assert max(map(width, lines)) <= columns
    assert " ".join(lines) == SAID
    for one in ("-1.78 %)", "10 %", "110 rpm", "2.35 kN m", "30.5 °,", "12 m/s²", "9 lbf ft/rad"):
        assert any(one in line for line in lines), one


@pytest.mark.parametrize(
    "look", [Look(), Look(layout="rows"), *map(Look, ("markdown", "csv", "json", "html", "latex"))]
)
def test_every_character_can_be_written(look: Look) -> None:
    compared, simple = (
        zusammenstellung(compare=True),
        zusammenstellung(formula="first-order", rows=("c", "x")),
    )
    for encoding in ("ascii", "cp1252", "cp850", "latin-1", "utf-8"):
        for report in (REPORT, ONE, compared, simple):
            text = render(report, look._replace(encoding=encoding))
            assert "?" not in text.encode(encoding).decode(encoding)


@given(texts())
def test_names_cannot_steer_the_terminal(name: str) -> None:
    report = ONE._replace(title=name, parts=(ONE.parts[0]._replace(name=name),) * 2)
    text = render(report)
    assert all(
        character == "\n" or (ord(character) >= 32 and not 127 <= ord(character) < 160)
        for character in text
    )
