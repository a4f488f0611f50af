"""Pictures of measured traces: every line is where the samples, the geometry and the closed forms have it."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from drawn import curve_of, ids_of

from indicated import columns_file, fraction
from kurbel.machine_file import loads
from kurbel.pictures.picture import Curve, Panel
from kurbel.pictures.picture_source import PictureOptions, sampled, telling
from kurbel.pictures.pictures import pictures
from kurbel.solver.case import Case

CLEARANCE = 0.1
EXPONENT = 1.3
DEGREES = np.arange(-180.0, 180.0)
SWEPT = math.pi / 4 * 10.0**2 * 10.0
"""cm³ of 100 mm bore and stroke."""


def polytropic(sizes: Any) -> Any:
    """Pressures (m, n) in bar by p V^1.3 over a turn, at 1 bar at the outer dead centre, times a size for each cycle."""
    volumes = fraction(DEGREES) + CLEARANCE
    return np.outer(sizes, ((1 + CLEARANCE) / volumes) ** EXPONENT)


def case_of_cycles(
    folder: Path, pressures: Any, keys: str = "", size: str = "stroke: 100 mm"
) -> Case:
    columns_file(folder / "p.csv", np.column_stack((DEGREES, *pressures)), "%.12g")
    columns = f", pressure_columns: 2-{len(pressures) + 1}" if len(pressures) > 1 else ""
    text = (
        f"cycle: two-stroke\nspeed: 600 rpm\n{size}\nrod_ratio: 4\nbore: 100 mm\n"
        f"indicator: {{pressures: absolute, head_end: {{trace: {{file: '{folder / 'p.csv'}', "
        f"unit: bar{columns}{keys}}}}}}}\n"
    )
    return Case(loads(text))


def panel_of(case: Case, id: str, number: int = 0) -> Panel:
    (picture,) = pictures(case, (id,), PictureOptions())
    return picture.panels[number]


def of_kind(panel: Panel, kind: str) -> list[Curve]:
    return [curve for curve in panel.curves if curve.kind == kind]


def test_every_cycle_is_drawn_and_their_mean(tmp_path: Path) -> None:
    """Three cycles 0.9, 1 and 1.2 times as high: their tops, and a mean of 3.1/3."""
    panel = panel_of(case_of_cycles(tmp_path, polytropic([0.9, 1.0, 1.2])), "trace-cycles")
    peak = (1.1 / CLEARANCE) ** EXPONENT
    (cycles,) = of_kind(panel, "cycles")
    tops = [float(y.max()) for _, y in cycles.pieces()]
    assert tops == pytest.approx([0.9 * peak, peak, 1.2 * peak], rel=1e-9)
    assert not cycles.jumps()
    mean = curve_of(panel, "p")
    assert len(mean.x) == 361
    assert float(mean.y.max()) == pytest.approx(3.1 / 3 * peak, rel=1e-9)
    assert panel.title == "3 cycles"


def test_of_very_many_cycles_sixty_are_drawn(tmp_path: Path) -> None:
    panel = panel_of(case_of_cycles(tmp_path, polytropic(np.linspace(1, 2, 80))), "trace-cycles")
    (cycles,) = of_kind(panel, "cycles")
    tops = [float(y.max()) for _, y in cycles.pieces()]
    assert len(tops) == 60
    assert tops[-1] == pytest.approx(2 * tops[0], rel=1e-9)
    assert panel.title == "60 of 80 cycles"


def test_dead_centres_are_where_the_geometry_has_them(tmp_path: Path) -> None:
    """With an offset e they are at arcsin(e/(L ± R)), not half a turn apart."""
    case = case_of_cycles(tmp_path, polytropic([1.0]), size="crank: 50 mm\noffset: 20 mm")
    panel = panel_of(case, "trace-cycles")
    places = {curve.name.symbol: float(curve.x[0]) for curve in of_kind(panel, "faint")}
    apart = 180 - math.degrees(math.asin(20 / 250) - math.asin(20 / 150))
    nearest = abs(abs(places["outer dead centre"]) - 180)
    assert places["inner dead centre"] == 0
    assert nearest == pytest.approx(abs(apart - 180), abs=1e-9)


def test_a_polytrope_is_a_straight_line_with_its_exponent(tmp_path: Path) -> None:
    """p V^1.3 = const from 1 bar at the largest volume: both fitted lines lie on it."""
    keys = f", clearance: {CLEARANCE}"
    panel = panel_of(case_of_cycles(tmp_path, polytropic([1.0]), keys), "trace-lines")
    assert panel.x.log
    assert panel.y.log
    curve = curve_of(panel, "p")
    inside = curve.x / SWEPT
    assert curve.y == pytest.approx(((1 + CLEARANCE) / inside) ** EXPONENT, rel=1e-9)
    for line in of_kind(panel, "faint"):
        assert line.y == pytest.approx(((1 + CLEARANCE) * SWEPT / line.x) ** EXPONENT, rel=1e-9)
    figures = {mark.figure.name.symbol: mark.figure for mark in panel.marks}
    assert [figures[symbol].value for symbol in ("n_c", "n_d")] == pytest.approx([EXPONENT] * 2)
    assert {figure.unit for figure in figures.values()} == {""}


def test_without_a_clearance_there_is_no_volume(tmp_path: Path) -> None:
    ids = ids_of(case_of_cycles(tmp_path, polytropic([1.0])))
    assert "trace-cycles" in ids
    assert "trace-lines" not in ids
    assert "heat-release" not in ids


@pytest.mark.parametrize(
    ("machine", "tolerance"), [("diesel-trace", 0.02), ("petrol-engine", 1e-3)]
)
def test_heat_release_is_that_of_the_key_values(machine: str, tolerance: float) -> None:
    """The marks are the key values, and the area below the rate is the heat: of a trace and of a card by Wiebe."""
    case = Case(loads(Path(f"configs/{machine}.yaml").read_text(encoding="utf-8")))
    values = case.cylinders[0].rows.key_values
    key_values = {id: values[id].of(case.cylinders[0]) for id in ("heat_released", "phi_burnt_50")}
    rate = curve_of(panel_of(case, "heat-release"), "dQ/dφ")
    burnt = curve_of(panel_of(case, "heat-release", 1), "x_b")
    inside = (burnt.y > 0) & (burnt.y < 1)
    area = np.trapezoid if hasattr(np, "trapezoid") else np.trapz
    assert area(rate.y[inside], rate.x[inside]) == pytest.approx(
        key_values["heat_released"], rel=tolerance
    )
    share = panel_of(case, "heat-release", 1)
    marks = {mark.figure.name.symbol: (mark.x, mark.y) for mark in share.marks}
    assert marks["φ_50"] == (key_values["phi_burnt_50"], 0.5)


# very many samples


def test_of_a_crowd_the_highest_and_lowest_stay() -> None:
    """A line of 30,000 breaks, each with a height of its own, has the heights of every stretch, and its ends."""
    breaks = np.linspace(0.0, 360.0, 30_001)
    heights = np.random.default_rng(1).standard_normal(30_001)
    drawn = sampled(breaks, lambda degrees, _: np.interp(degrees, breaks, heights)[None])
    assert len(drawn.degrees) < 15_000
    assert drawn.values.max() == heights.max()
    assert drawn.values.min() == heights.min()
    for stretch in range(0, 30_000, 15):
        part = heights[stretch : stretch + 15]
        assert {part.min(), part.max()} <= set(drawn.values[0])


def test_of_a_crowd_wide_pieces_are_drawn_as_alone() -> None:
    """Where breaks are far apart next to very many, the curve between them is as fine as without these."""
    crowd = np.linspace(100.0, 110.0, 20_001)
    breaks = np.concatenate(([0.0, 50.0], crowd, [200.0, 360.0]))
    drawn = sampled(breaks, lambda degrees, _: np.sin(np.radians(degrees))[None])
    fine = np.linspace(0.0, 360.0, 5000)
    missed = np.interp(fine, drawn.degrees, drawn.values[0]) - np.sin(np.radians(fine))
    assert np.abs(missed).max() < 1e-3


def test_telling_points_are_in_order() -> None:
    points = np.array([[0.0, 3.0, 1.0, 2.0, 5.0, 4.0, 9.0]])
    assert telling(points, 2).tolist() == [0, 1, 4, 5, 6]
