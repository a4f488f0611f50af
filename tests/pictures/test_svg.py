"""Pictures as files: small, legible in black and white and for the colour-blind, and harmless."""

import re
from itertools import combinations
from xml.etree import ElementTree

import numpy as np
import pytest
from drawn import drawn, ids_of, named

from kurbel.pictures.picture import Panel
from kurbel.pictures.picture_source import PictureOptions
from kurbel.pictures.pictures import pictures
from kurbel.render import Look
from kurbel.render.picture import Label, PanelFrame
from kurbel.render.style import COLOURS, picture_css
from kurbel.render.svg import PAPER_SIZES, svg_file
from representative import case_of, few

LARGEST = 60_000


def luminance(colour: str) -> float:
    """Relative luminance after WCAG 2."""
    parts = [int(colour[k : k + 2], 16) / 255 for k in (1, 3, 5)]
    red, green, blue = (c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in parts)
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue


def contrast(one: str, other: str) -> float:
    light, dark = sorted((luminance(one), luminance(other)), reverse=True)
    return (light + 0.05) / (dark + 0.05)


# every picture of every kind of mechanism is one of these
DRAWN = [
    "compressor-two-stage",
    "coupled-axle",
    "crank-rocker",
    "diesel-trace",
    "four-throws",
    "gas-engine",
    "generator-coupling",
    "locomotive-link",
    "marine-diesel",
    "press",
    "punch",
    "radial-three",
    "scotch-yoke-pump",
    "torsional-damper",
    "triplex-pump",
    "waterworks",
]


@pytest.mark.parametrize("name", few(DRAWN, ["punch", "coupled-axle"]))
def test_files_are_small_and_whole(name: str) -> None:
    for id in ids_of(name):
        for picture in drawn(name, id):
            text = svg_file([picture], Look())
            assert len(text.encode()) <= LARGEST
            root = ElementTree.fromstring(text)
            assert "nan" not in text.lower().replace("finance", "")
            assert root.find("{http://www.w3.org/2000/svg}title") is not None


@pytest.mark.parametrize("mode", [0, 1], ids=["light", "dark"])
def test_contrast(mode: int) -> None:
    of = {name: both[mode] for name, both in COLOURS.items()}
    for name in ("ink", "faint", *(f"line{number}" for number in range(6))):
        assert contrast(of[name], of["paper"]) >= 4.5
        assert of[name] in picture_css()
    for ground in ("gain", "loss"):
        assert contrast(of["ink"], of[ground]) >= 4.5
    for name in ("ink", "faint", "good", "bad", "link"):
        for ground in ("paper", "shade"):
            assert contrast(of[name], of[ground]) >= 4.5


def test_a_name_is_text_and_nothing_else() -> None:
    text = svg_file(list(pictures(named(), ("motion", "mechanism"), PictureOptions())), Look())
    assert "<script" not in text
    assert "&lt;script&gt;" in text
    assert "\x1b" not in text
    ElementTree.fromstring(text)


def test_nothing_is_loaded_from_elsewhere() -> None:
    text = svg_file(drawn("waterworks", "mechanism"), Look())
    assert not re.findall(r"href|url\(|@import|<script|<image|\bon\w+=", text)
    assert re.findall(r"https?://[^\"]*", text) == ["http://www.w3.org/2000/svg"]


MOVING = [
    "waterworks",
    "marine-diesel",
    "scotch-yoke-pump",
    "shaper",
    "crank-rocker",
    "coupled-axle",
    "yoke-frame-pump",
]


@pytest.mark.parametrize("name", few(MOVING, ["waterworks", "marine-diesel", "crank-rocker"]))
def test_every_mechanism_of_the_book_moves(name: str) -> None:
    """Round and round; for those who want nothing to move it is drawn once more, at rest, with its angle."""
    text = svg_file(drawn(name, "mechanism"), Look())
    root = ElementTree.fromstring(text)
    moving, resting = (
        [one for one in root.iter() if one.get("class") == kind] for kind in ("moving", "still")
    )
    assert len(moving) == len(resting) > 2
    moves = [one for one in root.iter() if one.tag.rpartition("}")[2].startswith("animate")]
    forces = {"d", "x", "y"} if len(case_of(name).cylinders) == 1 else {"opacity"}
    assert {"transform", *forces} <= {move.get("attributeName") for move in moves}
    assert all(any(one in moves for one in group.iter()) for group in moving if len(group))
    assert not any(one in moves for group in resting for one in group.iter())
    for one in moves:
        values, turning = one.get("values", "").split(";"), one.get("type") == "rotate"
        assert one.get("repeatCount") == "indefinite"
        if len(values) == 2:  # what turns on and on, at a constant speed
            assert turning
        else:
            assert (len(values) - 1) % 48 == 0
            assert float(one.get("dur", "").removesuffix("s")) == 5 * (len(values) - 1) / 48
        apart = (
            float(values[-1]) - float(values[0]) if turning else 360.0 * (values[0] != values[-1])
        )
        assert apart % 360 == 0 if turning else apart == 0
    assert "prefers-reduced-motion" in text
    texts = ["".join(one.itertext()) for group in resting for one in group.iter()]
    assert any("φ = " in text for text in texts)
    assert not any("φ = " in "".join(group.itertext()) for group in moving)
    assert "animate" not in svg_file(drawn("waterworks", "forces"), Look())
    standing = svg_file(
        list(pictures(case_of(name), ("mechanism",), PictureOptions(angles=(45.0,)))), Look()
    )
    assert "φ = 45°" in standing
    assert "still" not in standing.split("</style>")[1]
    assert "animate" not in standing


def frame_of(panel: Panel, wide: float = 660.0, tall: float = 250.0) -> PanelFrame:
    return PanelFrame(panel, Look(), PAPER_SIZES, wide, tall)


def meet(one: Label, other: Label) -> bool:
    """Whether two labels share a place."""
    apart = one.left >= other.right or other.left >= one.right
    return not (
        apart or one.top >= other.top + PAPER_SIZES.line or other.top >= one.top + PAPER_SIZES.line
    )


def covered(frame: PanelFrame, label: Label) -> bool:
    """Whether a label is on a curve by more than a point at its edge, at 2,000 points along each piece."""
    for curve in frame.panel.curves:
        for piece in curve.pieces():
            z = frame.place(*piece)
            x, y = (
                np.interp(np.linspace(0, 1, 2000), np.linspace(0, 1, len(z)), one)
                for one in (z.real, z.imag)
            )
            inside = (x > label.left + 1) & (x < label.right - 1)
            inside &= (y > label.top + 1) & (y < label.top + PAPER_SIZES.line - 1)
            if inside.any():
                return True
    return False


LABELLED = ["waterworks", "gas-engine", "marine-diesel", "radial-three", "diesel-trace"]
MORE = ["four-throws", "mill-engine", "shaper", "triplex-pump", "compressor-two-stage"]
"""Machines that have the other pictures."""


@pytest.mark.parametrize(
    "names", [LABELLED, pytest.param(MORE, marks=pytest.mark.slow)], ids=["few", "more"]
)
def test_labels_are_clear_of_each_other_and_of_curves(names: list[str]) -> None:
    """Where no ground is free nearby a label may be on a curve: one of a hundred."""
    labels, on_curves = 0, 0
    for picture in (
        picture for name in names for id in ids_of(name) for picture in drawn(name, id)
    ):
        for panel in (panel for panel in picture.panels if not panel.plain):
            frame = frame_of(panel, {1: 660.0, 2: 293.0, 3: 170.0}[picture.across])
            result = frame.labels(named=False)
            assert not any(meet(one, other) for one, other in combinations(result, 2))
            named = [
                mark for mark in panel.marks if mark.figure.name.symbol
            ]  # angles are where there is room
            assert len(result) >= min(len(named), 12)
            labels += len(result)
            on_curves += sum(covered(frame, label) for label in result)
    assert labels > 100
    assert on_curves <= 0.01 * labels


def test_no_label_is_on_the_upright_axis() -> None:
    for id in ("forces", "effort", "bearing-loads"):
        text = svg_file(drawn("diesel-trace", id), Look())
        places = [float(match) for match in re.findall(r'<text class="halo" x="([^"]+)"', text)]
        assert places
        assert min(places) >= 4
