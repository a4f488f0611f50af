"""Pictures are as exact as the tables: every point is the solver's, extremes stand where the key value does."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from drawn import curve_of, drawn, ids_of, off_line, on_its_side
from scipy.integrate import trapezoid

from kurbel.declared.unit_systems import convert
from kurbel.errors import NoSolutionError
from kurbel.machine_file import loads
from kurbel.report.picture import Panel, Picture
from kurbel.report.picture_source import FINENESS, PictureOptions, sampled
from kurbel.report.pictures import PICTURES, pictures
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
        for degrees, y in curve_of(panel, symbol).pieces():
            state = results.at(degrees, on_its_side(degrees))
            assert (y == convert(np.asarray(state[quantity.id]), quantity.kind, panel.y.unit)).all()


@pytest.mark.parametrize("name", LINES)
def test_marks_stand_where_the_key_values_do(name: str) -> None:
    case = case_of(name)
    for id in LINES[name]:
        for picture in drawn(name, id):
            results = case.flywheel if id == "effort" else case.stress if id == "throw-stress" else case.cylinders[0]
            known = {one.quantity.symbol: one for one in results.key_values().values()}
            for panel in picture.panels:
                for mark in panel.marks:
                    if mark.figure.name.symbol == "force reversal":
                        continue
                    figure = known[mark.figure.name.symbol]
                    assert mark.figure.at_deg == figure.degrees
                    assert mark.y == mark.figure.value == convert(figure.value, figure.quantity.kind, panel.y.unit)
                    assert mark.x == figure.degrees


def test_forces_reverse_where_the_inertia_line_is_crossed() -> None:
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
    ((x, y),) = curve_of(below, "P").jumps()
    assert x.tolist() == [180.0, 180.0]
    assert y[1] - y[0] > 50  # kN
    trace = curve_of(drawn("diesel-trace", "forces")[0].panels[0], "S")
    assert len(trace.pieces()) == 1  # straight lines between the samples of a trace bend, and do not jump


def test_straight_lines_between_the_points_miss_no_curve() -> None:
    """Compared with the solver at angles that no drawing has."""
    forces = case_of("gas-engine").cylinders[0]
    for curve in (one for one in drawn("gas-engine", "forces")[0].panels[0].curves if one.kind == "line"):
        for x, y in curve.pieces():
            between = np.linspace(x[0], x[-1], 1009)[1:-1]
            true = np.asarray(getattr(forces.at(between), curve.name.symbol)) / 1e3
            assert np.abs(np.interp(between, x, y) - true).max() <= 1.5 * FINENESS * np.nanmax(np.ptp(y))


def test_sampling_meets_both_sides_of_every_break() -> None:
    def saw(degrees: np.ndarray, within: np.ndarray) -> np.ndarray:
        return np.stack([degrees - 90 * np.floor(within / 90)])

    found = sampled(np.array([0.0, 90.0, 180.0]), saw)
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
        V, p = (np.concatenate(parts) for parts in zip(*curve.pieces()))
        V, p = V / 1e6, p * 1e5
        work += float(trapezoid(p, V))
    assert work == pytest.approx(case.cylinders[0].work, rel=1e-3)


def test_the_strokes_of_a_four_stroke_engine_lie_side_by_side() -> None:
    (picture,) = drawn("diesel-trace", "piston-force-way")
    assert [panel.title.split()[0] for panel in picture.panels] == ["Outstroke", "Return"] * 2
    for panel, out in zip(picture.panels, (True, False, True, False)):
        x = panel.curves[0].x
        assert (x[-1] > x[0]) == out
        assert (np.nanmin(x), np.nanmax(x)) == (0.0, pytest.approx(180.0))


def test_t_in_polar_form_stands_as_far_from_its_circle_as_t_is_large() -> None:
    panel = drawn("waterworks", "effort-polar")[0].panels[0]
    curve, ring = panel.curves[:2]
    base = float(np.hypot(ring.x[0], ring.y[0]))
    forces = case_of("waterworks").cylinders[0]
    degrees = np.linspace(0.3, 359.7, 700)
    tips = (base + np.asarray(forces.at(degrees).T) / 1e3) * np.exp(1j * np.radians(degrees))
    assert off_line(curve, tips) < 1e-3 * base


def test_the_arrows_are_the_forces() -> None:
    """Each points along its force; T and D at the pin add up to the rod force, P and N at the crosshead as well."""
    case = case_of("waterworks")
    (picture,) = pictures(case, ("mechanism",), PictureOptions(angles=(40.0,)))
    drawn_ = {one.name.symbol: one.x + 1j * one.y for one in picture.panels[0].curves if one.kind == "arrow"}
    arrows = {symbol: head - tail for symbol, (tail, head) in drawn_.items()}
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
        for picture in drawn(name, id):
            for curve in (curve for panel in picture.panels for curve in panel.at_moment(0).curves):
                assert all(np.isfinite(piece).all() for piece in curve.pieces())


def test_a_crosshead_that_locks_itself_is_refused_and_its_motion_drawn() -> None:
    locked = "{speed: 50 rpm, stroke: 800 mm, rod_ratio: 2, masses: {piston: 100 kg}, friction: {crosshead: 5}}"
    case = Case(loads(locked))
    with pytest.raises(NoSolutionError, match="locks itself"):
        list(pictures(case, ("forces",), PictureOptions()))
    assert list(pictures(case, ("motion",), PictureOptions()))


def test_equal_cylinders_are_drawn_once() -> None:
    case = case_of("four-in-line")
    (motion,) = pictures(case, ("motion",), PictureOptions())
    assert motion.of == "cylinders 1–4"
    panel = motion.panels[0]
    for degrees, y in panel.curves[0].pieces():
        for one in case.cylinders:  # the picture is that of each of them
            np.testing.assert_array_equal(convert(one.at(degrees).way, "length", panel.y.unit), y)
    (third,) = pictures(case, ("motion",), PictureOptions(cylinder="3"))
    assert third.of == "cylinder 3"


def test_an_infinite_rod_is_drawn_as_the_yoke_that_moves_alike() -> None:
    case = Case(loads("{speed: 50 rpm, stroke: 800 mm, rod_ratio: infinite, masses: {piston: 100 kg}}"))
    (picture,) = pictures(case, ("mechanism",), PictureOptions(angles=(60.0,)))
    joints = next(one for one in picture.panels[0].curves if one.kind == "joint")
    assert picture.panels[0].x.unit == "mm"
    assert (200.0, 0.0) in [(round(x, 9), round(y, 9)) for x, y in zip(joints.x, joints.y)]  # R cos 60°


def test_the_tip_of_the_free_force_is_the_solvers() -> None:
    case = case_of("diesel-four-stroke")
    panel = drawn("diesel-four-stroke", "free-vectors")[0].panels[0]
    free = case.balance.at(np.linspace(0.0, 719.0, 500))
    tips = (np.asarray(free.F_x) + 1j * np.asarray(free.F_y)) / 1e3
    assert off_line(panel.curves[0], tips) <= 1e-3 * np.abs(tips).max()
    (mark,) = panel.marks
    largest = case.balance.F_free_max
    assert largest is not None
    assert (mark.figure.value, mark.figure.at_deg) == (largest.value / 1e3, largest.degrees)
    assert np.hypot(mark.x, mark.y) == pytest.approx(largest.value / 1e3, rel=1e-14)
    assert panel.equal


def test_a_four_in_line_keeps_the_second_order_along_its_stroke_line() -> None:
    """A vector along one line is two circles of one size; of 4 cranks at 180° order 1 is gone (Bevan, ch. 14)."""
    panel = drawn("four-in-line", "free-orders")[0].panels[0]
    place = panel.x.names.index("2")
    with_, against = (
        next(float(one.high[0]) for one in panel.shades if one.gain == gain and abs(one.x.mean() - place) < 0.5)
        for gain in (True, False)
    )
    assert with_ == pytest.approx(against, rel=1e-12)
    assert with_ > 0
    first = [float(one.high[0]) for one in panel.shades if abs(one.x.mean() - panel.x.names.index("1")) < 0.5]
    assert max(first) <= 1e-12 * with_


def test_bars_stand_side_by_side_and_do_not_meet() -> None:
    panel = drawn("v8-cross-plane", "free-orders")[0].panels[0]
    spans = sorted((float(one.x[0]), float(one.x[-1])) for one in panel.shades)
    assert all(end <= start + 1e-12 for (_, end), (start, _) in itertools.pairwise(spans))
    assert len(spans) == 2 * len(panel.x.names)


def test_the_polar_diagrams_of_bearings_are_the_solvers_loads() -> None:
    """A point stands as far from the middle as its load is large, in the direction that the column tells."""
    case, pictures_ = case_of("gas-engine"), drawn("gas-engine", "bearing-loads")
    assert [one.of for one in pictures_] == [part.name for part in case.bearings.parts]
    for picture, part in zip(pictures_, case.bearings.parts):
        for panel in picture.panels:
            columns = part.at(np.linspace(0.1, 719.9, 500))
            direction = np.radians(np.nan_to_num(getattr(columns, f"load_{panel.title.partition(':')[0]}")))
            tips = np.asarray(columns.load) / 1e3 * np.exp(1j * direction)
            assert off_line(panel.curves[0], tips) <= 2e-3 * np.abs(tips).max()
            (mark,) = panel.marks
            assert mark.figure.value == part.load_max.value / 1e3
            assert np.hypot(mark.x, mark.y) == pytest.approx(part.load_max.value / 1e3, rel=1e-9)


def test_bars_of_the_torque_are_its_orders() -> None:
    """Over a turn of six cranks at 120° only the orders 3, 6, 9, … of the gas remain (two-stroke: 6, 12)."""
    case = case_of("marine-diesel")
    panel = drawn("marine-diesel", "orders")[0].panels[0]
    heights = [float(one.high[0]) for one in panel.shades]
    found = case.harmonics()
    assert heights == pytest.approx(
        [abs(one) / 1e3 for one in found.machine.whole.amplitudes[: len(heights)]], rel=1e-15
    )
    assert panel.x.names[int(np.argmax(heights))] == "6"


def test_modes_are_those_of_holzer_with_their_frequencies() -> None:
    case = case_of("marine-diesel")
    panel = drawn("marine-diesel", "modes")[0].panels[0]
    curves = [one for one in panel.curves if one.kind == "line"]
    for mode, curve in enumerate(curves, 1):
        angles = np.asarray(case.torsion.holzer(mode).angles)
        assert (curve.y == angles / np.abs(angles).max()).all()
        assert np.count_nonzero(np.diff(np.sign(curve.y))) == mode  # a free shaft has as many nodes
    assert curves[0].name.symbol == f"1: {case.torsion.natural_frequency:.4g} Hz"
    assert len(panel.x.names) == len(case.torsion.line.masses)
