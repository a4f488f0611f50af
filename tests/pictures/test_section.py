"""The machine in section: joints, strokes and volumes are those of the machine, and everything drawn can be read."""

import math
import re
from itertools import combinations
from pathlib import Path
from xml.etree import ElementTree

import numpy as np
import pytest

from command import run
from kurbel.machine_file import loads
from kurbel.pictures.picture import Body, Panel, Shape
from kurbel.pictures.picture_source import PictureOptions
from kurbel.pictures.pictures import pictures
from kurbel.render import Look
from kurbel.render.picture import PanelFrame
from kurbel.render.svg import PAPER_SIZES, svg_file
from kurbel.solver.case import Case
from representative import CONFIGS, case_of, few

DRAWN = [name for name in CONFIGS if name != "punch"]  # which has no cylinder
SOME = ["waterworks", "v8-cross-plane", "shaper", "radial-three", "yoke-frame-pump"]
WIDE = 704.0


def panel_of(case: Case, *angles: float) -> Panel:
    (picture,) = pictures(case, ("mechanism",), PictureOptions("si", angles=angles or None))
    return picture.panels[0]


def placed(body: Body, point: complex, moment: int = 0) -> complex:
    place, turn, stretch = (
        one[min(moment, len(one) - 1)] for one in (body.place, body.turn, body.stretch)
    )
    return place + np.exp(1j * math.radians(turn)) * (stretch * point.real + 1j * point.imag)


def rods(panel: Panel) -> list[tuple[Body, complex]]:
    """The connecting rods, from the crank pin, each with the place of the other pin: a round eye at its far end."""
    results = []
    for body in panel.bodies:
        eyes = [shape.points[0] for shape in body.shapes if shape.look == "rod" and shape.radius]
        results += [(body, eye) for eye in eyes if eye.real > 0]
    return results


ANGLES = (0.0, 37.0, 90.0, 180.0, 251.5)


@pytest.mark.parametrize("degrees", ANGLES)
@pytest.mark.parametrize(
    ("name", "R", "L", "e", "upright"),
    [
        ("waterworks", 0.4, 2.0, 0.0, False),
        ("diesel-four-stroke", 0.21, 1.05, 0.0, True),
        ("yoke-frame-pump", 0.08, 0.32, 0.0, False),
        # R is the root of s = √((L+R)² − e²) − √((L−R)² − e²) for s = 240 mm, L = 4.5 R
        ("offset-engine", 0.11986431951598362, 4.5 * 0.11986431951598362, 0.025, True),
    ],
)
def test_the_rod_runs_from_the_crank_pin_to_the_crosshead(
    name: str, R: float, L: float, e: float, upright: bool, degrees: float
) -> None:
    ((rod, small_end),) = rods(panel_of(case_of(name), degrees))
    turn = 1j if upright else 1.0
    pin = R * np.exp(1j * math.radians(degrees))
    crosshead = pin.real + math.sqrt(L**2 - (pin.imag - e) ** 2) + 1j * e
    assert placed(rod, small_end) == pytest.approx(turn * crosshead, abs=1e-12)
    assert placed(rod, 0j) == pytest.approx(turn * pin, abs=1e-12)


def test_every_cylinder_is_at_its_own_crank_angle() -> None:
    """Three rods on one pin; stroke lines 120° apart, the first one upright."""
    text = re.sub(r" +link_rod: .*\n", "", CONFIGS["radial-three"].read_text("utf-8"))
    drawn = rods(panel_of(Case(loads(text)), 40.0))
    pins = [placed(rod, 0j) for rod, _ in drawn]
    assert len(drawn) == 3
    assert np.allclose(pins, 0.06 * np.exp(1j * math.radians(90 + 40)), atol=1e-12)
    lines = sorted(np.degrees(np.angle([placed(rod, eye) for rod, eye in drawn])) % 360)
    assert np.allclose(lines, [90, 210, 330], atol=1e-9)


@pytest.mark.parametrize(("rotation", "sense"), [("over", 1), ("under", -1)])
def test_the_sense_of_rotation(rotation: str, sense: int) -> None:
    text = f"{{rotation: {rotation}, inclination: 0 deg, crank: 400 mm, rod: 2 m, masses: {{piston: 9 kg}}}}"
    ((rod, _),) = rods(panel_of(Case(loads(text)), 30.0))
    assert placed(rod, 0j) == pytest.approx(0.4 * np.exp(sense * 1j * math.radians(30)), abs=1e-12)


def test_a_throw_from_the_side_is_as_high_as_its_cosine() -> None:
    """Cranks of 1-5-3-4-2-6 lag by 0, 240, 120, 180, 60 and 300°; the axes of shaft and cylinders are to scale."""
    panel = panel_of(case_of("marine-diesel"), 25.0)
    heights = [
        body.place[0].imag
        for body in panel.bodies
        if [shape.look for shape in body.shapes[:2]] == ["metal", "rod"]
    ]
    lags = np.array([0.0, 240.0, 120.0, 180.0, 60.0, 300.0])
    assert np.allclose(heights, 0.45 * np.cos(np.radians(25.0 - lags)), atol=1e-12)


def test_four_bars_are_as_long_as_the_file_gives() -> None:
    for degrees in ANGLES:
        panel = panel_of(case_of("crank-rocker"), degrees)
        bars = [body for body in panel.bodies if body.shapes[0].look == "rod"]
        lengths = {
            max(shape.points[0].real for shape in bar.shapes if shape.radius): bar for bar in bars
        }
        assert sorted(lengths) == pytest.approx([0.08, 0.15])
        coupler, rocker = lengths[max(lengths)], lengths[min(lengths)]
        assert placed(coupler, 0j) == pytest.approx(
            0.04 * np.exp(1j * math.radians(degrees)), abs=1e-12
        )
        assert placed(coupler, 0.15 + 0j) == pytest.approx(placed(rocker, 0j), abs=1e-12)
        assert placed(rocker, 0.08 + 0j) == pytest.approx(0.15, abs=1e-12)


def test_mechanisms_without_pistons_may_be_several() -> None:
    text = "{mechanism: four-bar, crank: 40 mm, coupler: 150 mm, rocker: 80 mm, frame: 150 mm}"
    panel = panel_of(Case(loads(f"{{cylinders: [{text}, {text}]}}")), 60.0)
    assert [caption.text for caption in panel.captions] == ["1"]


# the chambers


def chambers(panel: Panel) -> list[tuple[Body, Shape]]:
    return [
        (body, body.shapes[0]) for body in panel.bodies if body.shapes[0].look in ("gas", "liquid")
    ]


def test_volumes_are_those_of_the_cylinder() -> None:
    """π/4 d² × length of the drawn chamber is the volume at the head end, with the clearance that the file gives."""
    case, angles = case_of("steam-ideal"), (0.0, 63.0, 180.0, 300.0)
    for degrees in angles:
        (_, _), (head, shape) = chambers(panel_of(case, degrees))
        bore = np.ptp(shape.points.imag)
        assert bore == pytest.approx(0.35)
        assert math.pi / 4 * bore**2 * head.stretch[0] == pytest.approx(
            float(case.cylinders[0].at([degrees]).V[0])
        )


@pytest.mark.parametrize(
    "name", few(["waterworks", "scotch-yoke-pump", "compressor-two-stage"], ["waterworks"])
)
def test_what_a_piston_sweeps_is_the_stroke(name: str) -> None:
    case = case_of(name)
    inner, outer = (chambers(panel_of(case, degrees)) for degrees in (0.0, 180.0))
    stroke = case.machine.cylinders[0].mechanism.stroke
    for (before, _), (after, _) in zip(inner, outer):
        assert abs(after.stretch[0] - before.stretch[0]) == pytest.approx(stroke)
    bores = [
        piston.bore
        for cylinder in case.machine.cylinders
        for piston in cylinder.pistons
        for _ in piston.chambers
    ]
    assert sorted(np.ptp(shape.points.imag) for _, shape in inner) == pytest.approx(sorted(bores))


def test_chambers_are_tinted_by_their_pressure() -> None:
    """9.5 at against 1.2 at; water is not steam, and a single-acting engine has no second chamber."""
    looks = [
        (shape.look, float(body.tint[0]))
        for body, shape in chambers(panel_of(case_of("waterworks"), 40.0))
    ]
    (steam_out, steam_in), pump = looks[:2], looks[2:]
    assert (steam_out[0], {look for look, _ in pump}) == ("gas", {"liquid"})
    assert steam_in[1] > 0.7 > 0.2 > steam_out[1]
    assert len(chambers(panel_of(case_of("diesel-four-stroke"), 40.0))) == 1


def test_a_picture_at_one_angle_is_tinted_like_the_moving_one() -> None:
    """A compressor draws in no water, though it has one pressure at one angle; a charge is darkest as it burns."""
    assert {shape.look for _, shape in chambers(panel_of(case_of("compressor"), 40.0))} == {"gas"}
    ((burning, _),), ((drawn_in, _),) = (
        chambers(panel_of(case_of("diesel-four-stroke"), at)) for at in (10.0, 450.0)
    )
    assert float(burning.tint[0]) > 0.7 > 0.2 > float(drawn_in.tint[0])


# what can be seen of it


def texts_in(root: ElementTree.Element, at: complex = 0j) -> list[tuple[complex, float, str]]:
    """The place, half the width, and the words of each text; nothing but translations is above texts."""
    results = []
    for one in root:
        moved = at
        if match := re.fullmatch(r"translate\(([-\d.]+) ([-\d.]+)\)", one.get("transform", "")):
            moved += complex(*map(float, match.groups()))
        if one.tag.endswith("text"):
            words = "".join(one.itertext())
            place, wide = (
                moved + complex(float(one.get("x", 0)), float(one.get("y", 0))),
                6.6 * len(words),
            )
            shift = {"middle": 0.0, "end": -wide / 2}.get(one.get("text-anchor", ""), wide / 2)
            results.append((place + shift, wide / 2, words))
        results += texts_in(one, moved)
    return results


@pytest.mark.parametrize("name", few(DRAWN, SOME))
def test_every_machine_is_drawn_small_and_whole(name: str) -> None:
    case = case_of(name)
    (picture,) = pictures(case, ("mechanism",), PictureOptions())
    text = svg_file([picture], Look())
    assert len(text.encode()) <= 70_000
    root = ElementTree.fromstring(text)
    left, top, wide, tall = map(float, root.get("viewBox", "").split())
    texts = texts_in(root)
    for place, half, words in texts:
        assert left - 1 <= place.real - half <= place.real + half <= left + wide + 1, words
        assert top + 8 <= place.imag <= top + tall, words
    notes = [
        text for text in texts if text[2] in {note.text for note in picture.panels[0].captions}
    ]
    for (one, half, _), (other, width, _) in combinations(notes, 2):
        assert abs(one.real - other.real) > half + width or abs(one.imag - other.imag) > 11
    assert any(words.startswith("To scale: ") for _, _, words in texts)
    assert len(notes) >= (len(case.cylinders) if len(case.cylinders) > 1 else 0)


@pytest.mark.parametrize("name", few(DRAWN, SOME))
def test_nothing_leaves_the_frame_through_the_whole_turn(name: str) -> None:
    (picture,) = pictures(case_of(name), ("mechanism",), PictureOptions())
    frame = PanelFrame(picture.panels[0], Look(), PAPER_SIZES, WIDE, 250.0)
    for body in picture.panels[0].bodies:
        for _, line in body.outlines():
            places = frame.place(line.real, line.imag)
            assert places.real.min() >= -1e-6
            assert places.real.max() <= frame.wide + 1e-6
            assert places.imag.min() >= -1e-6
            assert places.imag.max() <= frame.tall + 1e-6


def test_forces_are_clear_of_rod_and_crosshead() -> None:
    """No arrow of the waterworks engine crosses its connecting rod or its crosshead, at any angle."""
    panel = panel_of(case_of("waterworks"))
    ((rod, eye),) = rods(panel)
    for curve in panel.curves:
        assert curve.kind == "force"
        for moment in range(1, 49):
            tail, tip = curve.x[moment] + 1j * curve.y[moment]
            points = tail + (tip - tail) * np.linspace(0, 1, 20)
            start, end = placed(rod, 0j, moment), placed(rod, eye, moment)
            along = ((points - start) / (end - start)).real.clip(0, 1)
            assert np.abs(points - start - along * (end - start)).min() > 0.07


def test_one_cylinder_of_several_has_its_forces() -> None:
    case = case_of("v8-cross-plane")
    whole, one = (
        next(pictures(case, ("mechanism",), PictureOptions(cylinder=name)))
        for name in (None, "left 2")
    )
    assert (whole.panels[0].curves, whole.of) == ((), "")
    assert one.of == "left 2"
    assert {curve.name.symbol for curve in one.panels[0].curves} == {"P", "N", "T", "D"}


# as a sheet


def test_a_poster(tmp_path: Path) -> None:
    pytest.importorskip("typst")
    for size, name in (("A2", "a.pdf"), ("a4", "b.svg")):
        file = tmp_path / name
        assert (
            run(
                "plot", CONFIGS["waterworks"], "mechanism", "--poster", size, "-o", str(file)
            ).exit_code
            == 0
        )
        drawn = file.read_bytes()
        assert len(drawn) <= 400_000
    assert (tmp_path / "a.pdf").read_bytes().startswith(b"%PDF")
    root = ElementTree.parse(tmp_path / "b.svg").getroot()
    points = sorted(float(root.get(side, "").removesuffix("pt")) for side in ("width", "height"))
    assert points == pytest.approx([210 / 25.4 * 72, 297 / 25.4 * 72], abs=0.1)


def test_without_typst_a_poster_names_the_way_out(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    import importlib.util

    monkeypatch.setattr(importlib.util, "find_spec", lambda name, *more: None)
    result = run("plot", CONFIGS["waterworks"], "--poster", "A2", "-o", str(tmp_path / "x.svg"))
    assert result.exit_code == 2
    assert "a poster needs typst, which is not installed: pip install typst" in result.stderr
