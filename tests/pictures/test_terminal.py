"""Pictures in a terminal: as wide as it is, in Braille or in letters, kept as golden pages."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from drawn import drawn, named

from kurbel.render import Look
from kurbel.render.pictures.canvas import Canvas
from kurbel.render.pictures.letters import letters
from kurbel.render.pictures.scale import Scale
from kurbel.render.text import plain, width
from kurbel.report.pictures import pictures
from kurbel.report.pictures.picture import Picture
from kurbel.report.pictures.source import TERMINAL, Wish
from representative import few

GOLDEN = Path(__file__).parent.parent / "golden"


def text_of(picture: Picture, look: Look) -> str:
    return "".join(plain(letters(picture, look)))


@pytest.mark.parametrize(
    ("name", "id", "look"),
    [
        ("waterworks", "forces", Look(width=100)),
        ("waterworks", "forces", Look(width=60, encoding="ascii")),
        ("waterworks-two-cranks", "effort", Look(width=80, comma=True)),
        ("gas-engine", "card", Look(width=80)),
        ("shaper", "mechanism", Look(width=60)),
        ("waterworks", "effort-polar", Look(width=60)),
    ],
    ids=lambda one: f"{one.width}-{one.encoding}" if isinstance(one, Look) else str(one),
)
def test_golden(name: str, id: str, look: Look, kept: Callable[[Path, str], str]) -> None:
    ascii_ = "-ascii" if look.encoding == "ascii" else ""
    text = text_of(drawn(name, id, TERMINAL)[0], look)
    assert text == kept(GOLDEN / f"plot-{id}-{look.width}{ascii_}.txt", text)


WIDTHS = [
    (columns, encoding)
    for columns in (20, 24, 31, 40, 60, 80, 120, 160)
    for encoding in ("utf-8", "ascii", "cp1252", "cp850")
]


@pytest.mark.parametrize(("columns", "encoding"), few(WIDTHS, WIDTHS[::9]))
def test_pictures_fit_every_width(columns: int, encoding: str) -> None:
    for id in ("forces", "effort", "mechanism", "effort-polar"):
        text = text_of(drawn("waterworks", id, TERMINAL)[0], Look(width=columns, encoding=encoding))
        longest = max(width(line) for line in text.splitlines() if " " not in line.strip() or "  " in line)
        assert longest <= max(columns, 24)
        assert "?" not in text.encode(encoding).decode(encoding)


def test_a_pipe_has_eighty_columns() -> None:
    text = text_of(drawn("waterworks", "forces", TERMINAL)[0], Look())
    assert max(map(width, text.splitlines())) == 80


def test_a_name_can_do_nothing_to_a_terminal() -> None:
    (picture,) = pictures(named(), ("motion",), Wish(fineness=TERMINAL))
    for encoding in ("utf-8", "ascii"):
        text = text_of(picture, Look(encoding=encoding))
        assert "\x1b" not in text
        assert "<script>" in text  # which is no markup there


def test_the_canvas_sets_the_dots_of_braille() -> None:
    """Dots 1 2 3 7 down the left, 4 5 6 8 down the right, as Unicode numbers them."""
    canvas = Canvas(1, 1, braille=True)
    canvas.line(np.array([0.0, 0.0]), np.array([0.0, 3.0]), "curve0")
    assert canvas.line_of(0)[0].text == chr(0x2800 + 0b01000111)
    canvas.line(np.array([1.0, 1.0]), np.array([0.0, 3.0]), "curve0")
    assert canvas.line_of(0)[0].text == "⣿"


def test_what_lies_between_two_dots_goes_to_the_same_one_on_every_processor() -> None:
    """Sines differ in their last digit by processor and library: the polar diagram had other dots on each."""
    between = [np.nextafter(0.5, 0), 0.5, np.nextafter(0.5, 1)]
    assert np.rint(Scale(0.0, 1.0, 0.0, 5.0).place(np.array(between))).tolist() == [2.0, 2.0, 2.0]


def test_what_lies_beyond_the_canvas_is_cut_off() -> None:
    canvas = Canvas(4, 2, braille=True)
    canvas.line(np.array([-50.0, 50.0]), np.array([-50.0, 50.0]), "curve0")
    assert [canvas.line_of(row)[0].text for row in range(2)] == ["⠑⢄", "  "]


def test_letters_tell_curves_apart_where_there_is_no_braille() -> None:
    text = text_of(drawn("waterworks", "forces", TERMINAL)[0], Look(width=80, encoding="ascii"))
    assert all(letter in text for letter in "*+ox")
    assert text.isascii()


def test_many_lobes_bear_numbers_within_them_and_few_their_work() -> None:
    crowded = text_of(drawn("radial-three", "effort", TERMINAL)[0], Look(width=80)).split("E in")[0]
    assert "A_4" in crowded
    assert "A_4 88.44 J" not in crowded
    few = text_of(drawn("waterworks", "effort", TERMINAL)[0], Look(width=80))
    assert "A_2 −18.39 kJ" in few
    assert all(f"A_{number}" in few for number in (1, 2, 3, 4))


def test_axes_tell_what_runs_along_them_in_which_unit() -> None:
    text = text_of(drawn("waterworks", "effort", TERMINAL)[0], Look(width=72))
    assert "T in kN" in text
    assert "φ in °" in text
    assert "−28.06 kN" in text
    assert "-28.06 kN" in text_of(drawn("waterworks", "effort", TERMINAL)[0], Look(width=72, encoding="ascii"))
