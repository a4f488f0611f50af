"""Pictures as files: small, legible in black and white and for the colour-blind, and harmless."""

from __future__ import annotations

import re
from dataclasses import replace
from itertools import combinations, pairwise
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest
from drawn import drawn, ids_of, named

from kurbel.machine_file import loads
from kurbel.render import Look
from kurbel.render.html import BAD, GOOD, LINK
from kurbel.render.html import FAINT as PAGE_FAINT
from kurbel.render.html import INK as PAGE_INK
from kurbel.render.html import PAPER as PAGE_PAPER
from kurbel.render.html import SHADE as PAGE_SHADE
from kurbel.render.pictures.drawing import draw_file
from kurbel.render.pictures.labels import CHARACTER, LINE, Box, Taken
from kurbel.render.pictures.layout import scene
from kurbel.render.pictures.scene import Text, thinned
from kurbel.render.pictures.style import FAINT, GAIN, INK, LOOKS, LOSS, PAPER, css
from kurbel.render.pictures.svg import svg_file
from kurbel.report.pictures import pictures
from kurbel.report.pictures.source import Wish
from kurbel.solver.case import Case
from representative import CONFIGS, case_of, few

LARGEST = 60_000


def luminance(colour: str) -> float:
    """Relative luminance after WCAG 2."""
    parts = [int(colour[k : k + 2], 16) / 255 for k in (1, 3, 5)]
    red, green, blue = (c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in parts)
    return 0.2126 * red + 0.7152 * green + 0.0722 * blue


def contrast(one: str, other: str) -> float:
    light, dark = sorted((luminance(one), luminance(other)), reverse=True)
    return (light + 0.05) / (dark + 0.05)


@pytest.mark.parametrize("name", few(CONFIGS, ["punch", "coupled-axle"]))
def test_files_are_small_and_whole(name: str) -> None:
    for id in ids_of(name):
        for picture in drawn(name, id):
            for piece in (piece for panel in picture.panels for curve in panel.curves for piece in curve.pieces):
                assert np.isfinite(piece.x).all()
                assert np.isfinite(piece.y).all()
            text = "".join(svg_file([picture], Look()))
            assert len(text.encode()) <= LARGEST
            root = ElementTree.fromstring(text)
            assert "nan" not in text.lower().replace("finance", "")
            assert root.find("{http://www.w3.org/2000/svg}title") is not None


@pytest.mark.parametrize("mode", [0, 1], ids=["light", "dark"])
def test_contrast(mode: int) -> None:
    for colours in (INK, FAINT, *((look.light, look.dark) for look in LOOKS)):
        assert contrast(colours[mode], PAPER[mode]) >= 4.5
    for ground in (GAIN, LOSS):
        assert contrast(INK[mode], ground[mode]) >= 4.5
    for colours in (PAGE_INK, PAGE_FAINT, GOOD, BAD, LINK):
        for ground in (PAGE_PAPER, PAGE_SHADE):
            assert contrast(colours[mode], ground[mode]) >= 4.5


def test_curves_are_told_apart_without_colour() -> None:
    assert len({look.dashes for look in LOOKS}) == len(LOOKS)
    assert len({look.character for look in LOOKS}) == len(LOOKS)
    assert contrast(GAIN[0], LOSS[0]) > 1.15  # of two grey values the one is darker


def lms(colour: str) -> tuple[float, float, float]:
    """What the three kinds of cones see of a colour (Smith and Pokorny, as Viénot, Brettel and Mollon 1999 have it)."""
    parts = [int(colour[k : k + 2], 16) / 255 for k in (1, 3, 5)]
    r, g, b = (c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in parts)
    return (
        17.8824 * r + 43.5161 * g + 4.11935 * b,
        3.45565 * r + 27.1554 * g + 3.86714 * b,
        0.0299566 * r + 0.184309 * g + 1.46709 * b,
    )


def test_colours_are_told_apart_without_red_or_green_cones() -> None:
    """Without one kind of cones two are left: in each of them or in both the first four colours differ by a sixth."""
    for one, other in combinations(LOOKS[:4], 2):
        for kept in ((1, 2), (0, 2)):
            first, second = ([lms(look.light)[k] for k in kept] for look in (one, other))
            assert max(abs(a - b) / max(a, b) for a, b in zip(first, second)) > 1 / 6


def test_the_palette_of_the_style_sheet_is_that_of_the_tests() -> None:
    assert all(look.light in css() and look.dark in css() for look in LOOKS)


def test_a_name_is_text_and_nothing_else() -> None:
    text = "".join(svg_file(list(pictures(named(), ("motion", "mechanism"), Wish())), Look()))
    assert "<script" not in text
    assert "&lt;script&gt;" in text
    assert "\x1b" not in text
    ElementTree.fromstring(text)


def test_nothing_is_loaded_from_elsewhere() -> None:
    text = "".join(svg_file(list(drawn("waterworks", "mechanism")), Look()))
    assert not re.findall(r"href|url\(|@import|<script|<image|\bon\w+=", text)
    assert re.findall(r"https?://[^\"]*", text) == ["http://www.w3.org/2000/svg"]


MOVING = ["waterworks", "scotch-yoke-pump", "shaper", "crank-rocker", "coupled-axle", "yoke-frame-pump"]


@pytest.mark.parametrize("name", few(MOVING, ["waterworks", "crank-rocker"]))
def test_every_mechanism_of_the_book_moves(name: str) -> None:
    text = "".join(svg_file(list(drawn(name, "mechanism")), Look()))
    moves = re.findall(r'<animate attributeName="(\w+)" dur="6s" repeatCount="indefinite" values="([^"]*)"', text)
    assert {"d", "cx", "x"} <= {attribute for attribute, _ in moves}
    for _, values in moves:
        every = values.split(";")
        assert len(every) == 73
        assert every[0] == every[-1]  # round and round
    assert "prefers-reduced-motion" in text


def test_only_what_moves_is_drawn_twice_for_those_who_want_it_still() -> None:
    root = ElementTree.fromstring("".join(svg_file(list(drawn("waterworks", "mechanism")), Look())))
    names = [one.get("class") for one in root.iter("{http://www.w3.org/2000/svg}g")]
    assert "moving" in names
    assert "still" in names
    still = next(one for one in root.iter("{http://www.w3.org/2000/svg}g") if one.get("class") == "still")
    assert not list(still.iter("{http://www.w3.org/2000/svg}animate"))
    assert "animate" not in "".join(svg_file(list(drawn("waterworks", "forces")), Look()))


BEGINS = [("svg", b"<svg"), ("pdf", b"%PDF"), ("png", b"\x89PNG")]


@pytest.mark.parametrize(("suffix", "begin"), few(BEGINS, BEGINS[:1]))
def test_the_same_picture_every_time(suffix: str, begin: bytes, tmp_path: Path) -> None:
    if suffix != "svg":
        pytest.importorskip("matplotlib")
    for name in ("a", "b"):
        draw_file(list(drawn("waterworks", "card")), Look(), str(tmp_path / f"{name}.{suffix}"))
    first, second = ((tmp_path / f"{name}.{suffix}").read_bytes() for name in ("a", "b"))
    assert first == second
    assert first.startswith(begin)


def test_thinning_leaves_out_only_what_lies_on_a_line() -> None:
    x = np.linspace(0, 100, 401)
    y = np.abs(x - 50)
    assert thinned(x, y) == ((0.0, 50.0), (50.0, 0.0), (100.0, 50.0))
    wave = 40 * np.sin(x / 8)
    kept = np.array(thinned(x, wave))
    steepness = np.hypot(1, np.interp(x, kept[:-1, 0] / 2 + kept[1:, 0] / 2, np.diff(kept[:, 1]) / np.diff(kept[:, 0])))
    assert (np.abs(np.interp(x, *kept.T) - wave) / steepness).max() <= 0.15
    assert len(kept) < 200


def test_an_angle_stands_only_where_the_mechanism_stands() -> None:
    (page,) = ["".join(svg_file([drawn("shaper", "mechanism")[0]], Look()))]
    shown, still = page.split('<g class="still">')
    assert "φ = " not in shown
    assert "φ = " in still
    case = case_of("shaper")
    standing = "".join(svg_file(list(pictures(case, ("mechanism",), Wish(angles=(45.0,)))), Look()))
    assert "φ = 45°" in standing
    assert "still" not in standing.split("</style>")[1]


@pytest.mark.parametrize(("name", "lobes"), [("radial-three", 12), ("marine-diesel", 12), ("waterworks-two-cranks", 4)])
def test_every_lobe_is_named_and_no_name_meets_another(name: str, lobes: int) -> None:
    laid = scene(drawn(name, "effort")[0], Look())
    named = [one for one in laid.items if isinstance(one, Text) and one.text.startswith("A_")]
    assert {one.text.split()[0] for one in named} == {f"A_{number}" for number in range(1, lobes + 1)}
    boxes = [Box(one.x, one.y - 9, one.x + CHARACTER * len(one.text), one.y + 2) for one in named]
    assert not any(a.meets(b) for a, b in combinations(boxes, 2))


def test_a_long_name_takes_several_lines() -> None:
    picture = drawn("shaper", "motion")[0]
    laid = scene(replace(picture, machine=f"{'long name of a machine ' * 8}end"), Look())
    lines = [one.text for one in laid.items if isinstance(one, Text) and one.look == "h"]
    assert len(lines) == 3
    assert all(len(line) <= 85 for line in lines)
    assert laid.height > scene(picture, Look()).height


@pytest.mark.parametrize(
    ("text", "typeset"),
    [
        ("T_max 5.1 kN", ["T", "max", " 5.1 kN"]),
        ("|M_ν| in N m", ["|M", "ν", "| in N m"]),
        ("M_f,max 3 N m, 20°", ["M", "f,max", " 3 N m, 20°"]),
        ("F_x, F_y in kN", ["F", "x", ", F", "y", " in kN"]),
        ("−P_b", ["−P", "b", ""]),
        ("Δφ_G", ["Δφ", "G", ""]),
        ("boiler_house_engine", ["boiler_house_engine"]),
    ],
)
def test_subscripts_stand_lower(text: str, typeset: list[str]) -> None:
    assert Text(0, 0, text).levels == typeset


def test_names_are_no_symbols() -> None:
    """Neither those of pistons over their panels nor those of masses along an axis."""
    text = CONFIGS["waterworks"].read_text(encoding="utf-8").replace("name: pump", "name: A_1")
    (picture,) = pictures(Case(loads(text)), ("card",), Wish())
    assert ">A_1</text>" in "".join(svg_file([picture], Look()))
    text = CONFIGS["marine-diesel"].read_text(encoding="utf-8").replace("name: propeller", "name: G_2")
    (picture,) = pictures(Case(loads(text)), ("modes",), Wish())
    assert ">G_2</text>" in "".join(svg_file([picture], Look()))


def test_what_is_nought_at_every_angle_is_said() -> None:
    """Four cylinders in line have no free moment."""
    (picture,) = drawn("four-in-line", "free-angle")
    assert [panel.title for panel in picture.panels] == ["", "0 at every angle", ""]


def test_subscripts_of_a_file() -> None:
    (picture,) = drawn("waterworks", "motion")
    root = ElementTree.fromstring("".join(svg_file([picture], Look())))
    spans = {one.text for one in root.iter("{http://www.w3.org/2000/svg}tspan")}
    assert {"max", "min"} <= spans
    texts = ["".join(one.itertext()) for one in root.iter("{http://www.w3.org/2000/svg}text")]
    assert not any("_" in text for text in texts)


@pytest.mark.parametrize("name", ["torsional-damper", "generator-coupling", "marine-diesel"])
def test_names_along_an_axis_stand_inside_and_apart(name: str) -> None:
    (picture,) = drawn(name, "modes")
    laid = scene(picture, Look())
    names = picture.panels[0].x.names
    found = [one for one in laid.items if isinstance(one, Text) and one.text in names]
    spans = sorted((one.x - CHARACTER * len(one.text) / 2, one.x + CHARACTER * len(one.text) / 2) for one in found)
    assert {names[0], names[-1]} <= {one.text for one in found}
    assert spans[0][0] >= 0
    assert spans[-1][1] <= laid.width
    assert all(before[1] <= after[0] for before, after in pairwise(spans))


def test_labels_of_a_steep_bundle_stand_clear_of_it_and_lines_lead_to_them() -> None:
    """Five marks within 15° of the left edge: their labels once stood on the curves, and one on the next."""
    frame = Box(0.0, 0.0, 700.0, 250.0)
    steep = np.array([(x, 30 * k + 4 * x) for k in range(5) for x in np.linspace(0, 40, 80)])
    taken = Taken(frame, steep)
    text = "σ_pin,max 51.24 N/mm², 1.65°"
    marks = [(2.0 + 3 * k, 30.0 * k + 8 + 12 * k) for k in range(5)]
    for x, y in marks:
        taken.take(Box(x - 4, y - 4, x + 4, y + 4))
    boxes, pointers = [], []
    for x, y in marks:
        found = taken.pointed(x, y, text, upward=True)
        assert found
        (left, base), pointer = found
        boxes.append(Box(left, base - LINE + 2, left + CHARACTER * len(text), base + 2))
        pointers.append(pointer)
        inside = (steep > (boxes[-1].left, boxes[-1].top)) & (steep < (boxes[-1].right, boxes[-1].bottom))
        assert inside.all(axis=1).sum() <= 6
        assert not pointer or pointer[0] == (x, y)
    assert any(pointers)
    assert not any(one.meets(other) for k, one in enumerate(boxes) for other in boxes[:k])
    assert not any(box.cuts(*line) for line in pointers if line for box in boxes)


def test_no_label_of_the_throw_stresses_is_left_out_or_stands_on_another() -> None:
    texts = [one for one in scene(drawn("gas-engine", "throw-stress")[0], Look()).items if isinstance(one, Text)]
    labels = [one for one in texts if one.halo]
    assert sorted(one.text.split("_max")[0].split(",max")[0] for one in labels) == sorted(
        ["σ_pin", "σ_w,A", "σ_w,B", "σ_j,A", "σ_j,B"]
    )
    boxes = [Box(one.x, one.y - 9, one.x + CHARACTER * len(one.text), one.y + 2) for one in labels]
    assert not any(one.meets(other) for k, one in enumerate(boxes) for other in boxes[:k])
