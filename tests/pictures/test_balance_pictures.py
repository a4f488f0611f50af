"""Pictures of what is free: the tips of the vectors, and their orders as bars."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from drawn import drawn, ids_of

from kurbel.machine_file import loads
from kurbel.report.pictures import pictures_of
from kurbel.report.pictures.source import Wish
from kurbel.solver.case import Case
from representative import case_of


def test_the_tip_of_the_free_force_is_the_solvers() -> None:
    case = case_of("diesel-four-stroke")
    panel = drawn("diesel-four-stroke", "free-vectors")[0].panels[0]
    for piece in panel.curves[0].pieces:
        free = case.balance.at(piece.degrees, piece.within)
        assert (piece.x == np.asarray(free.F_x) / 1e3).all()
        assert (piece.y == np.asarray(free.F_y) / 1e3).all()
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


def test_what_has_no_speed_has_no_free_forces() -> None:
    text = "{stroke: 800 mm, rod_ratio: 5, masses: {piston: 100 kg}}"
    assert not {"free-vectors", "free-angle", "free-orders"} & {
        one.id for one in pictures_of(Case(loads(text)), Wish())
    }
    assert {"free-vectors", "free-angle", "free-orders"} <= set(ids_of("boxer"))


def test_the_polar_diagrams_of_bearings_are_the_solvers_loads() -> None:
    """A point stands as far from the middle as its load is large, in the direction that the column tells."""
    case, pictures_ = case_of("gas-engine"), drawn("gas-engine", "bearing-loads")
    assert [one.of for one in pictures_] == [part.name for part in case.bearings.parts]
    for picture, part in zip(pictures_, case.bearings.parts):
        for panel in picture.panels:
            frame = f"load_{panel.title.partition(':')[0]}"
            for piece in panel.curves[0].pieces:
                columns = part.at(piece.degrees, piece.within)
                load, direction = np.asarray(columns.load) / 1e3, np.radians(getattr(columns, frame))
                assert np.allclose(piece.x, load * np.cos(direction), atol=1e-12 * load.max())
                assert np.allclose(piece.y, load * np.sin(direction), atol=1e-12 * load.max())
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
        assert (curve.pieces[0].y == angles / np.abs(angles).max()).all()
        assert np.count_nonzero(np.diff(np.sign(curve.pieces[0].y))) == mode  # a free shaft has as many nodes
    assert curves[0].name.symbol == f"1: {case.torsion.natural_frequency:.4g} Hz"
    assert len(panel.x.names) == len(case.torsion.line.masses)
