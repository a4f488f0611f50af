"""Pictures in a terminal: as wide as it is, in Braille or in letters, kept as golden pages."""

from collections.abc import Callable
from pathlib import Path

import pytest
from drawn import drawn, named

from kurbel.pictures.picture import Picture
from kurbel.pictures.picture_source import PictureOptions
from kurbel.pictures.pictures import pictures
from kurbel.render import Look
from kurbel.render.braille import braille
from kurbel.render.text import plain_lines, width
from representative import few

GOLDEN = Path(__file__).parent.parent / "golden"


def text_of(picture: Picture, look: Look) -> str:
    return "".join(plain_lines(braille(picture, look)))


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
    text = text_of(drawn(name, id)[0], look)
    assert text == kept(GOLDEN / f"plot-{id}-{look.width}{ascii_}.txt", text)


WIDTHS = [
    (columns, encoding)
    for columns in (20, 24, 31, 40, 60, 80, 120, 160)
    for encoding in ("utf-8", "ascii")
]


@pytest.mark.parametrize(("columns", "encoding"), few(WIDTHS, WIDTHS[::5]))
def test_pictures_fit_every_width(columns: int, encoding: str) -> None:
    for id in ("forces", "effort", "mechanism", "effort-polar", "motion"):
        text = text_of(
            drawn("crank-rocker" if id == "motion" else "waterworks", id)[0],
            Look(width=columns, encoding=encoding),
        )
        longest = max(
            width(line) for line in text.splitlines() if " " not in line.strip() or "  " in line
        )
        assert longest <= max(columns, 24)
        assert "?" not in text.encode(encoding).decode(encoding)
    assert (
        columns < 40 or "_max" in text
    )  # the figures of θ̈, a letter with a mark on it, take one place


def test_a_name_can_do_nothing_to_a_terminal() -> None:
    (picture,) = pictures(named(), ("motion",), PictureOptions())
    for encoding in ("utf-8", "ascii"):
        text = text_of(picture, Look(encoding=encoding))
        assert "\x1b" not in text
        assert "<script>" in text  # which is no markup there
