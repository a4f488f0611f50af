"""Pictures are as exact as the tables: every point is the solver's, extremes stand where the key value does."""

import math
import re

import numpy as np
import pytest
from drawn import curve_of, drawn, ids_of, off_line, on_its_side
from scipy.integrate import trapezoid

from kurbel.arrays import Array
from kurbel.declared.unit_systems import convert
from kurbel.errors import UsageError
from kurbel.machine_file import loads
from kurbel.pictures.picture import Panel, Picture
from kurbel.pictures.picture_source import PictureOptions, sampled
from kurbel.pictures.pictures import PICTURES, pictures
from kurbel.render import Look
from kurbel.render.braille import braille
from kurbel.render.picture import PanelFrame, picture_text
from kurbel.render.svg import PAPER_SIZES
from kurbel.render.text import plain_lines
from kurbel.solver.case import Case
from representative import case_of

LINES = {
    "waterworks": {
        "piston-force": ("P_0", "P"),
        "forces": ("S", "N", "D", "T"),
        "motion": ("x", "c", "b"),
    },
    "gas-engine": {"throw-stress": ("σ_pin", "σ_w,A"), "effort": ("T", "E")},
    "diesel-trace": {"forces": ("S", "N", "D", "T"), "effort": ("T", "E")},
    "coupled-blower": {"effort": ("T", "ω", "M_K")},
    "crank-rocker": {"motion": ("θ", "θ̇", "θ̈")},
}


def panels_with(picture: Picture, symbol: str) -> list[Panel]:
    return [
        panel for panel in picture.panels if symbol in [curve.name.symbol for curve in panel.curves]
    ]


@pytest.mark.parametrize(
    ("name", "id"), [(name, id) for name, every in LINES.items() for id in every]
)
def test_every_point_is_the_solvers(name: str, id: str) -> None:
    """Each point of a curve, bit by bit, is what the solver says at its crank angle, on its side of a jump."""
    case = case_of(name)
    command = next(picture.command for picture in PICTURES if picture.id == id)
    results = {"flywheel": lambda: case.flywheel, "stress": lambda: case.stress}.get(
        command, lambda: case.cylinders[0]
    )()
    declared = {column.symbol: column for column in results.lists.all_columns}
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
            results = (
                case.flywheel
                if id == "effort"
                else case.stress
                if id == "throw-stress"
                else case.cylinders[0]
            )
            known = {
                key_value.quantity.symbol: key_value for key_value in results.key_values().values()
            }
            for panel in picture.panels:
                for mark in panel.marks:
                    if mark.figure.name.symbol == "force reversal":
                        continue
                    figure = known[mark.figure.name.symbol]
                    assert mark.figure.at_deg == figure.degrees
                    assert (
                        mark.y
                        == mark.figure.value
                        == convert(figure.value, figure.quantity.kind, panel.y.unit)
                    )
                    assert mark.x == figure.degrees


def test_forces_reverse_where_the_inertia_line_is_crossed() -> None:
    above, below = drawn("waterworks", "piston-force")[0].panels
    forces = case_of("waterworks").cylinders[0]
    assert [mark.x for mark in above.marks] == list(forces.phi_reversal)
    assert [mark.x for mark in below.marks if mark.y == 0] == list(forces.phi_reversal)
    for mark in above.marks:
        state = forces.at([mark.x])
        assert mark.y == pytest.approx(-float(state.P_inertia[0]) / 1e3, rel=1e-14)
        assert float(state.P_start[0]) == pytest.approx(-float(state.P_inertia[0]), abs=1e-9 * 1e5)


def test_lobes_are_shaded_and_numbered_with_their_work() -> None:
    panel = drawn("waterworks-two-cranks", "effort")[0].panels[0]
    turning = case_of("waterworks-two-cranks").flywheel
    figures = {shade.figure.name.symbol: shade for shade in panel.shades if shade.figure}
    assert set(figures) == {f"A_{k + 1}" for k in range(len(turning.lobes))}
    for k, work in enumerate(turning.lobes):
        shade = figures[f"A_{k + 1}"]
        assert shade.figure.value == pytest.approx(work / 1e3, rel=1e-15)
        assert shade.gain == (work > 0)
    ends = {end for shade in panel.shades for end in (shade.x[0], shade.x[-1])}
    assert ends == {
        0.0,
        360.0,
        *turning.phi_crossing,
    }  # where they cross, rounding may leave either of them above
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
    for curve in (curve for curve in panel.curves if curve.kind == "line"):
        V, p = (np.concatenate(parts) for parts in zip(*curve.pieces()))
        V, p = V / 1e6, p * 1e5
        work += float(trapezoid(p, V))
    assert work == pytest.approx(case.cylinders[0].work, rel=1e-3)


def test_the_arrows_are_the_forces() -> None:
    """Each points along its force; T and D at the pin add up to the rod force, P and N at the crosshead as well."""
    case = case_of("waterworks")
    (picture,) = pictures(case, ("mechanism",), PictureOptions(angles=(40.0,)))
    drawn_ = {
        curve.name.symbol: curve.x + 1j * curve.y
        for curve in picture.panels[0].curves
        if curve.kind == "force"
    }
    arrows = {symbol: head - tail for symbol, (tail, head) in drawn_.items()}
    state = case.cylinders[0].at([40.0])
    scale = abs(arrows["P"]) / abs(float(state.P[0]))
    assert arrows["T"] + arrows["D"] == pytest.approx(
        scale
        * (float(state.T[0]) * 1j - float(state.D[0]))
        * complex(math.cos(math.radians(40)), math.sin(math.radians(40)))
    )
    assert abs(arrows["T"] + arrows["D"]) == pytest.approx(
        scale * abs(float(state.S[0])), rel=1e-12
    )
    assert arrows["P"] == pytest.approx(-scale * float(state.P[0]))
    assert arrows["N"] == pytest.approx(-1j * scale * float(state.N[0]))


# those that are drawn for files are of every machine


def test_the_tip_of_the_free_force_is_the_solvers() -> None:
    case = case_of("diesel-four-stroke")
    panel = drawn("diesel-four-stroke", "free-vectors")[0].panels[0]
    free = case.balance.at(np.linspace(0.0, 719.0, 500))
    tips = (np.asarray(free.F_x) + 1j * np.asarray(free.F_y)) / 1e3
    assert off_line(panel.curves[0], tips) <= 1e-3 * np.abs(tips).max()
    mark, *_ = panel.marks
    largest = case.balance.F_free_max
    assert (mark.figure.value, mark.figure.at_deg) == (largest.value / 1e3, largest.degrees)
    assert np.hypot(mark.x, mark.y) == pytest.approx(largest.value / 1e3, rel=1e-14)
    assert panel.equal


def test_the_path_of_a_journal_is_that_of_its_columns_within_the_clearance() -> None:
    """A point is as far from the middle as the journal is eccentric, in the direction of the thinnest film."""
    case, pictures_ = case_of("gas-engine"), drawn("gas-engine", "journal-orbit")
    assert [picture.of for picture in pictures_] == [part.name for part in case.bearings.parts]
    for picture, part in zip(pictures_, case.bearings.parts):
        (panel,) = picture.panels
        columns = part.columns(np.linspace(0.1, 719.9, 500), "eccentricity", "film_direction")
        direction = np.exp(1j * np.radians(columns["film_direction"]))
        assert off_line(panel.curves[0], columns["eccentricity"] * direction) <= 2e-3
        clearance = panel.curves[-1]
        assert np.hypot(clearance.x, clearance.y) == pytest.approx(1.0, rel=1e-14)
        mark, *_ = panel.marks
        assert mark.figure.value == part.eccentricity_max.value
        assert np.hypot(mark.x, mark.y) == pytest.approx(part.eccentricity_max.value, rel=1e-9)


def test_a_machine_without_an_oil_film_has_no_path_of_a_journal() -> None:
    with pytest.raises(UsageError, match="has no picture 'journal-orbit'"):
        drawn("waterworks", "journal-orbit")


def test_the_polar_diagrams_of_bearings_are_the_solvers_loads() -> None:
    """A point is as far from the middle as its load is large, in the direction of the column."""
    case, pictures_ = case_of("gas-engine"), drawn("gas-engine", "bearing-loads")
    assert [picture.of for picture in pictures_] == [part.name for part in case.bearings.parts]
    for picture, part in zip(pictures_, case.bearings.parts):
        for panel in picture.panels:
            columns = part.at(np.linspace(0.1, 719.9, 500))
            direction = np.radians(
                np.nan_to_num(getattr(columns, f"load_{panel.title.partition(':')[0]}"))
            )
            tips = np.asarray(columns.load) / 1e3 * np.exp(1j * direction)
            assert off_line(panel.curves[0], tips) <= 2e-3 * np.abs(tips).max()
            mark, *_ = panel.marks
            assert mark.figure.value == part.load_max.value / 1e3
            assert np.hypot(mark.x, mark.y) == pytest.approx(part.load_max.value / 1e3, rel=1e-9)


def test_modes_are_those_of_holzer_with_their_frequencies() -> None:
    case = case_of("marine-diesel")
    panel = drawn("marine-diesel", "modes")[0].panels[0]
    curves = [curve for curve in panel.curves if curve.kind == "line"]
    for mode, curve in enumerate(curves, 1):
        angles = np.asarray(case.torsion.holzer(mode).angles)
        assert (curve.y == angles / np.abs(angles).max()).all()
        assert np.count_nonzero(np.diff(np.sign(curve.y))) == mode  # a free shaft has as many nodes
    assert curves[0].name.symbol == f"1: {case.torsion.natural_frequency:.4g} Hz"
    assert len(panel.x.names) == len(case.torsion.line.masses)


def test_where_an_order_meets_a_mode_the_speed_is_critical() -> None:
    """n = 60 f/ν, the frequency of the mode over the periods per turn; the working speed is that of the file."""
    for name, working in (("torsional-damper", 2000), ("marine-diesel", 110)):
        case, (panel,) = case_of(name), drawn(name, "campbell")[0].panels
        lines = {curve.name.symbol: curve for curve in panel.curves}
        frequencies = [
            float(omega) / (2 * math.pi) for omega in case.torsion.modes.omegas if omega > 1e-6
        ]
        assert lines["working speed"].x.tolist() == pytest.approx([working, working])
        slopes = [
            60 * curve.y[1] / curve.x[1]
            for curve in panel.curves
            if curve.kind == "faint" and not curve.name.symbol
        ]
        orders = {
            float(mark.figure.name.symbol.removeprefix("ν = ").removesuffix(":"))
            for mark in panel.marks
        }
        assert sorted(orders) == pytest.approx(
            sorted(slopes)
        )  # periods per turn times turns per second
        assert orders >= {
            critical_speed.order
            for critical_speed in case.torsion.critical_speeds(2, 12)
            if critical_speed.near
        }
        met = 0
        for mark in panel.marks:
            mode = min(frequencies, key=lambda frequency: abs(frequency - mark.y))
            assert mark.y == pytest.approx(mode, rel=1e-9)
            order = float(mark.figure.name.symbol.removeprefix("ν = ").removesuffix(":"))
            assert mark.x == pytest.approx(60 * mode / order, rel=1e-9)
            assert (mark.figure.value, mark.figure.unit) == (mark.x, "rpm")
            met += mark.x <= 1.25 * working
        assert met == len(panel.marks) > 4


@pytest.mark.parametrize("columns", [60, 80, 120])
def test_names_of_masses_are_whole(columns: int) -> None:
    """Below the axis where they have room, or else as a list behind their numbers."""
    masses = [mass.name for mass in case_of("torsional-damper").torsion.line.masses]
    text = " ".join(
        "".join(
            plain_lines(braille(drawn("torsional-damper", "modes")[0], Look(width=columns)))
        ).split()
    )
    assert all(name in text for name in masses)


def test_crank_angles_are_on_the_polar_curves() -> None:
    """Every 30°, each where the columns have the load then; from 0, which is on the picture, too."""
    part = case_of("gas-engine").bearings.parts[0]
    panel = drawn("gas-engine", "bearing-loads")[0].panels[0]
    beads = next(curve for curve in panel.curves if curve.kind == "beads")
    columns = part.at(np.arange(0.0, 720.0, 30.0))
    expected = np.asarray(columns.load) / 1e3 * np.exp(1j * np.radians(columns.load_throw))
    assert beads.x + 1j * beads.y == pytest.approx(expected, rel=1e-9)
    labelled = [mark for mark in panel.marks if not mark.figure.name.symbol]
    assert [mark.figure.at_deg for mark in labelled] == [90.0 * number for number in range(8)]
    assert [complex(mark.x, mark.y) for mark in labelled] == pytest.approx(expected[::3], rel=1e-9)


@pytest.mark.parametrize("name", ["marine-diesel", "triplex-pump", "diesel-trace"])
def test_no_polar_diagram_is_flattened(name: str) -> None:
    """One scale for both axes, and a height that shows it, however flat the curve is."""
    for id in ("bearing-loads", "free-vectors"):
        for picture in drawn(name, id):
            for panel in picture.panels:
                frame = PanelFrame(panel, Look(), PAPER_SIZES, 660.0 / picture.across, 250.0)
                assert frame.tall >= min(0.8 * frame.wide, 200.0)
                across, up = frame.x.high - frame.x.low, frame.y.high - frame.y.low
                assert across / frame.wide == pytest.approx(up / frame.tall, rel=1e-9)


def test_noise_of_a_trace_has_no_scale_of_its_own() -> None:
    """All strokes of a traced engine have the scale of the largest, and the gas exchange looks as small as it is."""
    panels = drawn("diesel-trace", "piston-force-way")[0].panels
    ends = {(panel.y.low, panel.y.high) for panel in panels}
    highest = max(float(np.nanmax(curve.y)) for panel in panels for curve in panel.curves)
    assert len(ends) == 1
    assert ends.pop()[1] == pytest.approx(highest)


def test_rounding_of_a_constant_is_not_refined() -> None:
    random = np.random.default_rng(1)

    def values(degrees: Array, within: Array) -> Array:
        return np.array(
            [np.sin(np.radians(degrees)), 2737.0 + random.normal(0.0, 1e-12, degrees.shape)]
        )

    alone = sampled(
        np.array([0.0, 180.0, 360.0]), lambda degrees, within: values(degrees, within)[:1]
    )
    both = sampled(np.array([0.0, 180.0, 360.0]), values)
    assert len(both.degrees) == len(alone.degrees)


def test_a_card_is_a_closed_line() -> None:
    """The crank end is opened at the outer dead centre, where the cycle begins: there, too, pressure falls upright."""
    for id in ("card", "card-volume"):
        crank_end = curve_of(drawn("coupled-blower", id)[0].panels[0], "p_C")
        x, y = crank_end.jumps()[-1]
        before, after = crank_end.pieces()[-2], crank_end.pieces()[0]
        assert (x[0], y[0], x[1], y[1]) == (before[0][-1], before[1][-1], after[0][0], after[1][0])
        assert x[0] == pytest.approx(x[1], abs=1e-6 * np.nanmax(crank_end.x))
        assert y[0] - y[1] > 0.5


def test_a_diagram_that_would_be_a_line_or_empty_is_left_out() -> None:
    """A load along the rod is a line to the rod; a torque that never changes has no orders."""
    (picture,) = [one for one in drawn("locomotive", "bearing-loads") if one.of == "crosshead pin"]
    assert [panel.title for panel in picture.panels] == ["engine: stroke line →"]
    assert "orders" not in ids_of("punch")
    assert "orders" in ids_of("shaper")


def test_a_degree_is_next_to_its_number() -> None:
    text = picture_text(drawn("shaper", "motion")[0], Look())
    assert "θ_max 22.02°, 112.02°" in text


# rod load of compressors, and what the approximations miss


COMPRESSOR = """
speed: 300 rpm
stroke: 300 mm
rod_ratio: 5
bore: 300 mm
crank_end_rod: 60 mm
masses: {other: 150 kg, connecting_rod: 90 kg}
indicator:
  pressures: absolute
  head_end: {compressor: {suction: 1 bar, delivery: 6 bar, clearance: 0.1, exponent: 1.3}}
  crank_end: mirrored
"""


def test_the_rod_load_is_gas_and_inertia_within_its_limits() -> None:
    limits = "limits: {rod_compression_max: 30 kN, rod_tension_max: 20 kN}\n"
    (picture,) = pictures(Case(loads(COMPRESSOR + limits)), ("rod-load",), PictureOptions())
    (panel,) = picture.panels
    curves = {curve.name.symbol: curve for curve in panel.curves}
    phi = np.arange(0.0, 360.0, 7.0)
    load, gas, inertia = (
        np.interp(phi, curves[symbol].x, curves[symbol].y) for symbol in ("P_G", "P_gas", "−m b")
    )
    assert load == pytest.approx(gas + inertia, abs=2e-3 * np.abs(load).max())
    assert curves["limit of P_G,d"].y.tolist() == pytest.approx([30.0, 30.0])
    assert curves["limit of P_G,z"].y.tolist() == pytest.approx([-20.0, -20.0])
    # where it reverses it is zero
    reversals = [mark.x for mark in panel.marks if mark.figure.name.symbol == "J"]
    assert len(reversals) == 2
    assert np.interp(reversals, curves["P_G"].x, curves["P_G"].y) == pytest.approx(0, abs=0.02)
    assert "API 618: 15°, 3 %" in panel.title
    in_terminal = "".join(plain_lines(braille(picture, Look(comma=True, width=120))))
    (over,) = re.findall(r"reverses over ([\d.]+)°", panel.title)
    assert f"reverses over {over.replace('.', ',')}°" in in_terminal


def test_rod_loads_are_drawn_of_compressors_alone() -> None:
    assert "rod-load" in ids_of("compressor")
    for name in ("triplex-pump", "punch", "diesel-two-stroke"):
        assert "rod-load" not in ids_of(name)


def test_the_error_of_the_approximations_is_largest_where_it_is_marked() -> None:
    """L/R = 4 at 90°: x = R + L − √(L² − R²) exactly, and R (1 + λ/2) by the book."""
    machine = loads("{speed: 60 rpm, crank: 200 mm, rod_ratio: 4}")
    (picture,) = pictures(Case(machine), ("approximations",), PictureOptions())
    displacement = picture.panels[0]
    missing = 200.0 * (1 + 1 / 8) - (200.0 + 800.0 - np.sqrt(800.0**2 - 200.0**2))
    lowest = min(displacement.marks, key=lambda mark: mark.y)
    assert (lowest.x, lowest.y) == pytest.approx((90.0, missing), rel=1e-9)
    assert displacement.title == f"at most {-missing / 4:.2g} % of s"
    infinite = loads("{speed: 60 rpm, crank: 200 mm, rod_ratio: infinite}")
    assert "approximations" not in ids_of(Case(infinite))
