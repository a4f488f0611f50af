"""Pictures are as exact as the tables: every point is the solver's, extremes stand where the key value does."""

from __future__ import annotations

import math

import numpy as np
import pytest
from drawn import drawn, ids_of
from scipy.integrate import trapezoid

from kurbel.declared.unit_systems import convert
from kurbel.errors import NoSolutionError, UsageError
from kurbel.machine import Cylinder, Machine
from kurbel.machine_file import loads
from kurbel.mechanisms.slider_crank import SliderCrank
from kurbel.report.pictures import PICTURES, pictures, pictures_of
from kurbel.report.pictures.picture import Panel, Picture
from kurbel.report.pictures.sampling import sampled
from kurbel.report.pictures.source import FILE, TERMINAL, Wish
from kurbel.solver.case import Case
from representative import case_of, few

LINES = {
    "waterworks": {"piston-force": ("P_0", "P"), "forces": ("S", "N", "D", "T"), "motion": ("x", "c", "b")},
    "gas-engine": {"throw-stress": ("σ_pin", "σ_w,A"), "effort": ("T", "E")},
    "diesel-trace": {"forces": ("S", "N", "D", "T"), "effort": ("T", "E")},
    "coupled-blower": {"effort": ("T", "ω", "M_K")},
    "crank-rocker": {"motion": ("θ", "θ̇", "θ̈")},
}


def panels_with(picture: Picture, symbol: str) -> list[Panel]:
    return [one for one in picture.panels if symbol in [curve.name.symbol for curve in one.curves]]


@pytest.mark.parametrize(("name", "id"), [(name, id) for name, every in LINES.items() for id in every])
def test_every_point_is_the_solvers(name: str, id: str) -> None:
    """Each point of a curve, bit by bit, is what the solver says at its crank angle, on its side of a jump."""
    case = case_of(name)
    command = next(one.command for one in PICTURES if one.id == id)
    results = {"flywheel": lambda: case.flywheel, "stress": lambda: case.stress}.get(
        command, lambda: case.cylinders[0]
    )()
    declared = {one.symbol: one for one in results.lists.all_columns}
    for symbol in LINES[name][id]:
        quantity = declared[symbol]
        panel = panels_with(drawn(name, id)[0], symbol)[-1 if symbol == "P" else 0]
        curve = next(one for one in panel.curves if one.name.symbol == symbol)
        for piece in curve.pieces:
            state = results.at(piece.degrees, piece.within)
            expected = convert(np.asarray(state[quantity.id]), quantity.kind, panel.y.unit)
            assert (piece.y == expected).all()
            assert (piece.x == piece.degrees).all()


@pytest.mark.parametrize("name", LINES)
def test_marks_stand_where_the_key_values_do(name: str) -> None:
    case = case_of(name)
    for id in LINES[name]:
        for picture in drawn(name, id):
            results = case.flywheel if id == "effort" else case.stress if id == "throw-stress" else case.cylinders[0]
            known = {one.quantity.symbol: one for one in results.key_values().values()}
            for panel in picture.panels:
                for mark in panel.marks:
                    if mark.figure.name.symbol == "Druckwechsel":
                        continue
                    figure = known[mark.figure.name.symbol]
                    assert mark.figure.at_deg == figure.degrees
                    assert mark.y == mark.figure.value == convert(figure.value, figure.quantity.kind, panel.y.unit)
                    assert mark.x == figure.degrees


def test_the_marks_are_there() -> None:
    symbols = [mark.figure.name.symbol for panel in drawn("waterworks", "forces")[0].panels for mark in panel.marks]
    assert symbols == ["S_max", "S_min", "N_max", "N_min", "T_max", "T_min"]
    over_way = drawn("waterworks", "motion-way")[0].panels[0]
    (largest, _), motion = over_way.marks, case_of("waterworks").cylinders[0].motion
    assert motion.c_max is not None
    assert largest.x == 1e3 * float(case_of("waterworks").cylinders[0].at([motion.c_max.degrees]).x[0])


def test_the_druckwechsel_stands_where_the_inertia_line_is_crossed() -> None:
    above, below = drawn("waterworks", "piston-force")[0].panels
    forces = case_of("waterworks").cylinders[0]
    assert forces.phi_reversal is not None
    assert [mark.x for mark in above.marks] == list(forces.phi_reversal)
    assert [mark.x for mark in below.marks if mark.y == 0] == list(forces.phi_reversal)
    for mark in above.marks:
        state = forces.at([mark.x])
        assert mark.y == pytest.approx(-float(state.P_inertia[0]) / 1e3, rel=1e-14)
        assert float(state.P_start[0]) == pytest.approx(-float(state.P_inertia[0]), abs=1e-9 * 1e5)


def test_a_jump_is_a_jump() -> None:
    """At 180° the pressures change over: P ends at one value and begins at another, at the same angle."""
    below = drawn("waterworks", "piston-force")[0].panels[1]
    before, after = next(curve for curve in below.curves if curve.name.symbol == "P").pieces
    assert before.x[-1] == after.x[0] == 180.0
    assert after.y[0] - before.y[-1] > 50  # kN
    trace = next(c for c in drawn("diesel-trace", "forces")[0].panels[0].curves if c.name.symbol == "S")
    assert len(trace.pieces) == 1  # straight lines between the samples of a trace bend, and do not jump


@pytest.mark.parametrize("fineness", [FILE, TERMINAL])
def test_straight_lines_between_the_points_miss_no_curve(fineness: float) -> None:
    """Held against the solver at angles that no drawing knows."""
    forces = case_of("gas-engine").cylinders[0]
    panel = drawn("gas-engine", "forces", fineness)[0].panels[0]
    for curve in (one for one in panel.curves if one.kind == "line"):
        ends = [end for piece in curve.pieces for end in (piece.y.min(), piece.y.max())]
        for piece in curve.pieces:
            between = np.linspace(piece.x[0], piece.x[-1], 1009)[1:-1]
            column = {"S": "S", "N": "N", "D": "D", "T": "T"}[curve.name.symbol]
            true = np.asarray(getattr(forces.at(between), column)) / 1e3
            missed = np.abs(np.interp(between, piece.x, piece.y) - true).max()
            assert missed <= 1.5 * fineness * (max(ends) - min(ends))


def test_sampling_meets_both_sides_of_every_break() -> None:
    def saw(degrees: np.ndarray, within: np.ndarray) -> np.ndarray:
        return np.stack([degrees - 90 * np.floor(within / 90)])

    found = sampled(np.array([0.0, 90.0, 180.0]), saw, 1e-3)
    assert found.values[0][found.degrees == 90.0].tolist() == [90.0, 0.0]
    assert (np.diff(found.degrees) >= 0).all()


def test_lobes_are_shaded_and_numbered_with_their_work() -> None:
    panel = drawn("waterworks-two-cranks", "effort")[0].panels[0]
    turning = case_of("waterworks-two-cranks").flywheel
    figures = {shade.figure.name.symbol: shade for shade in panel.shades if shade.figure}
    assert set(figures) == {f"A_{k + 1}" for k in range(len(turning.lobes))}
    for k, work in enumerate(turning.lobes):
        shade = figures[f"A_{k + 1}"]
        assert shade.figure is not None
        assert shade.figure.value == pytest.approx(work / 1e3, rel=1e-15)
        assert shade.gain == (work > 0)
    ends = {end for shade in panel.shades for end in (shade.x[0], shade.x[-1])}
    assert ends == {0.0, 360.0, *turning.phi_crossing}  # where they cross, rounding may leave either of them above
    # the surface itself, in kN times the way of the pin in m, is that work: straight lines miss it by their fineness
    first = figures["A_2"]
    area = float(trapezoid(first.high - first.low, np.radians(first.x))) * turning.crank
    assert area == pytest.approx(turning.lobes[1] / 1e3, rel=2e-3)


def test_the_card_encloses_the_indicated_work() -> None:
    """∮ p dV of the drawn card over the volume is the indicated work of the piston, head end and crank end."""
    case = case_of("compressor")
    panel = drawn("compressor", "card-volume")[0].panels[0]
    assert panel.x.unit == "cm^3"
    work = 0.0
    for curve in (one for one in panel.curves if one.kind == "line"):
        V = np.concatenate([piece.x for piece in curve.pieces]) / 1e6
        p = np.concatenate([piece.y for piece in curve.pieces]) * 1e5
        work += float(trapezoid(p, V))
    assert work == pytest.approx(case.cylinders[0].work, rel=1e-3)


def test_the_strokes_of_a_four_stroke_engine_lie_side_by_side() -> None:
    (picture,) = drawn("diesel-trace", "piston-force-way")
    assert [panel.title.split()[0] for panel in picture.panels] == ["Hingang", "Rückgang", "Hingang", "Rückgang"]
    for panel, out in zip(picture.panels, (True, False, True, False)):
        x = np.concatenate([piece.x for piece in panel.curves[0].pieces])
        assert (x[-1] > x[0]) == out
        assert (x.min(), x.max()) == (0.0, pytest.approx(180.0))


def test_t_in_polar_form_stands_as_far_from_its_circle_as_t_is_large() -> None:
    panel = drawn("waterworks", "effort-polar")[0].panels[0]
    curve, ring = panel.curves[:2]
    base = float(np.hypot(ring.pieces[0].x[0], ring.pieces[0].y[0]))
    forces = case_of("waterworks").cylinders[0]
    for piece in curve.pieces:
        T = np.asarray(forces.at(piece.degrees, piece.within).T) / 1e3
        assert np.allclose(np.hypot(piece.x, piece.y) - base, T, atol=1e-11)
        assert np.allclose(np.arctan2(piece.y, piece.x), np.angle(np.exp(1j * np.radians(piece.degrees))), atol=1e-9)


def test_the_arrows_are_the_forces() -> None:
    """Each points along its force; T and D at the pin add up to the rod force, P and N at the crosshead as well."""
    case = case_of("waterworks")
    (picture,) = pictures(case, ("mechanism",), Wish(angles=(40.0,)))
    arrows = {one.name.symbol: complex(*one.head) - complex(*one.tail) for one in picture.panels[0].arrows}
    state = case.cylinders[0].at([40.0])
    scale = abs(arrows["P"]) / abs(float(state.P[0]))
    assert arrows["T"] + arrows["D"] == pytest.approx(
        scale
        * (float(state.T[0]) * 1j - float(state.D[0]))
        * complex(math.cos(math.radians(40)), math.sin(math.radians(40)))
    )
    assert abs(arrows["T"] + arrows["D"]) == pytest.approx(scale * abs(float(state.S[0])), rel=1e-12)
    assert arrows["P"] == pytest.approx(-scale * float(state.P[0]))
    assert arrows["N"] == pytest.approx(-1j * scale * float(state.N[0]))


# those that are drawn for files are of every machine
@pytest.mark.parametrize("name", few(["punch", "shaper", "marine-diesel", "v8-cross-plane"], ["punch", "shaper"]))
def test_a_shipped_machine_can_be_drawn(name: str) -> None:
    every = ids_of(name)
    assert {"effort"} <= set(every)
    for id in every:
        for picture in drawn(name, id, TERMINAL):
            for panel in picture.panels:
                for curve in panel.curves:
                    assert all(np.isfinite(piece.x).all() and np.isfinite(piece.y).all() for piece in curve.pieces)


def test_a_machine_that_only_moves_has_no_forces() -> None:
    case = Case(loads("{speed: 50 rpm, stroke: 800 mm, rod_ratio: 5}"))
    assert [one.id for one in pictures_of(case, Wish())] == ["motion", "motion-way", "mechanism"]
    assert [one.id for one in pictures_of(Case(loads("{stroke: 800 mm, rod_ratio: 5}")), Wish())] == [
        "motion",
        "mechanism",
    ]
    with pytest.raises(
        UsageError, match="has no picture 'forces': what it shows is left out; it has motion, motion-way"
    ):
        list(pictures(case, ("forces",), Wish()))


def test_a_crosshead_that_locks_itself_is_refused_and_its_motion_drawn() -> None:
    locked = "{speed: 50 rpm, stroke: 800 mm, rod_ratio: 2, masses: {piston: 100 kg}, friction: {crosshead: 5}}"
    case = Case(loads(locked))
    with pytest.raises(NoSolutionError, match="locks itself"):
        list(pictures(case, ("forces",), Wish()))
    assert list(pictures(case, ("motion",), Wish()))


def test_numbers_that_overflow_are_refused_by_name() -> None:
    huge = Machine((Cylinder(SliderCrank(0.4, 2.0)),), speed=1e200)
    with pytest.raises(UsageError, match="too large to compute with"):
        list(pictures(Case(huge), ("motion",), Wish()))


def test_units_are_those_that_are_asked_for() -> None:
    (picture,) = pictures(case_of("waterworks"), ("forces",), Wish("technical"))
    assert picture.panels[0].y.unit == "kgf"
    (mark,) = (m for m in picture.panels[0].marks if m.figure.name.symbol == "T_max")
    assert mark.y == pytest.approx(case_of("waterworks")["T_max"].value / 9.80665, rel=1e-15)


def test_ids_are_unique_and_every_function_exists() -> None:
    assert len({one.id for one in PICTURES}) == len(PICTURES)
    assert all(one.title and one.text.endswith(".") for one in PICTURES)


def test_equal_cylinders_are_drawn_once() -> None:
    case = case_of("four-in-line")
    (motion,) = pictures(case, ("motion",), Wish())
    assert motion.of == "cylinders 1–4"
    panel = motion.panels[0]
    for piece in panel.curves[0].pieces:
        for one in case.cylinders:  # the picture is that of each of them
            np.testing.assert_array_equal(convert(one.at(piece.degrees).way, "length", panel.y.unit), piece.y)
    (third,) = pictures(case, ("motion",), Wish(cylinder="3"))
    assert third.of == "cylinder 3"


def test_cylinders_that_differ_by_one_key_are_drawn_apart() -> None:
    equal = "{name: A, stroke: 800 mm, rod_ratio: 5, masses: {piston: 100 kg}}"
    others = "{name: B, like: A, crank_position: 120 deg}, {name: C, like: A, masses: {piston: 101 kg}}"
    case = Case(loads(f"{{speed: 50 rpm, cylinders: [{equal}, {others}]}}"))
    assert [one.of for one in pictures(case, ("forces",), Wish())] == ["A, B", "C"]


def test_an_infinite_rod_is_drawn_as_the_yoke_that_moves_alike() -> None:
    case = Case(loads("{speed: 50 rpm, stroke: 800 mm, rod_ratio: infinite, masses: {piston: 100 kg}}"))
    (picture,) = pictures(case, ("mechanism",), Wish(angles=(60.0,)))
    (joints,) = next(one for one in picture.panels[0].curves if one.kind == "joint").pieces
    assert picture.panels[0].x.unit == "mm"
    assert (200.0, 0.0) in [(round(x, 9), round(y, 9)) for x, y in zip(joints.x, joints.y)]  # R cos 60°
