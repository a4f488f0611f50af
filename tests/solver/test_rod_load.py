"""The rod load of compressors (API 618, 6.6), against mpmath, by law, and as a user runs it."""

from pathlib import Path

import pytest
from mpmath import cos, findroot, mp, mpf, pi, sin, sqrt

from kurbel.checks.limits import cases_report
from kurbel.cli.request import cases_of
from kurbel.machine_file import loads
from kurbel.notes.warnings import cylinder_warnings
from kurbel.report.commands import report_of
from kurbel.solver.case import Case
from kurbel.solver.forces import CylinderForces
from kurbel.tables.frame import Frame
from representative import CONFIGS, case_of

EXAMPLES = Path(__file__).parents[1] / "examples"
RLO1, RLO5 = ((EXAMPLES / f"{name}.yaml").read_text("utf-8") for name in ("RLO1", "RLO5"))
PARTS = "masses: {piston: 60 kg, piston_rod: 30 kg, crosshead: 50 kg, other: 10 kg, connecting_rod: 80 kg}"


def solved(text: str) -> CylinderForces:
    return Case(loads(text)).cylinders[0]


def pressure(fraction: mpf, rises: bool) -> mpf:
    """Absolute pressure in bar of RLO1 over the fraction of the stroke from the chamber's smallest volume."""
    suction, delivery, clearance, exponent = mpf(1), mpf(6), mpf(1) / 10, mpf(13) / 10
    if rises:
        return min(delivery, suction * ((1 + clearance) / (clearance + fraction)) ** exponent)
    return max(suction, delivery * (clearance / (clearance + fraction)) ** exponent)


def rod_load(degrees: mpf) -> mpf:
    """Rod load in N of RLO1 from its own data: R = p_H A_H − p_C A_C − m b, areas and acceleration by formula."""
    crank, rod, omega = mpf("0.15"), mpf("0.75"), 10 * pi
    head, shaft = pi / 4 * mpf("0.09"), pi / 4 * mpf("0.0036")
    phi = degrees * pi / 180
    kappa, lam = sqrt(1 - (crank / rod * sin(phi)) ** 2), crank / rod
    x = crank * (1 - cos(phi)) + rod * (1 - kappa)
    b = (
        crank
        * omega**2
        * (cos(phi) + lam * (cos(phi) ** 2 - sin(phi) ** 2 + lam**2 * sin(phi) ** 4) / kappa**3)
    )
    back = degrees > 180
    at_head, at_crank = pressure(x / (2 * crank), back), pressure(1 - x / (2 * crank), not back)
    ambient = mpf("1.01325")
    return 100000 * ((at_head - ambient) * head - (at_crank - ambient) * (head - shaft)) - 150 * b


def test_reversal_angles_are_roots_to_1e_9_degrees() -> None:
    with mp.workdps(40):
        wanted = [findroot(rod_load, (mpf(low), mpf(low) + mpf("0.1"))) for low in (15.9, 208.4)]
    result = solved(RLO1).phi_rod_reversal
    assert result == pytest.approx([float(one) for one in wanted], rel=0, abs=1e-9)


@pytest.mark.parametrize("degrees", [0.0, 10.0, 100.0, 200.0, 355.0])
def test_rod_load_against_mpmath(degrees: float) -> None:
    with mp.workdps(40):
        assert float(solved(RLO1).at([degrees]).P_rod[0]) == pytest.approx(
            float(rod_load(mpf(degrees))), rel=1e-13
        )


def test_connecting_rod_and_friction_do_not_count_and_at_the_piston_rod_the_crosshead_neither() -> (
    None
):
    forces = solved(
        RLO1.replace("masses: {other: 150 kg}", PARTS + "\nfriction: {crosshead: 0.05}")
    )
    state = forces.at([0.0, 77.0, 240.0])
    assert state.P_rod == pytest.approx(state.P + 40 * state.b, rel=1e-13)
    assert state.P_piston_rod == pytest.approx(state.P_gas - 100 * state.b, rel=1e-13)
    assert forces.rod_compression_max.value == pytest.approx(
        solved(RLO1).rod_compression_max.value, rel=1e-13
    )


def test_weight_counts_where_the_stroke_line_leans() -> None:
    leaning = solved(RLO1 + "inclination: 90 deg\n").at([30.0]).P_rod
    assert leaning - solved(RLO1).at([30.0]).P_rod == pytest.approx(150 * 9.80665, rel=1e-10)


def test_pieces_of_the_reversed_load_add_up_and_the_longest_is_reported() -> None:
    """A pressure that pulls on the outstroke from 20° to 30° and from 50° to 80° only; harder on the way back."""
    steps = ((0, 20, 2), (20, 30, -1), (30, 50, 2), (50, 80, -1), (80, 180, 2), (180, 360, 3))
    points = [[degrees, bar] for start, end, bar in steps for degrees in range(start, end + 1, 5)]
    trace = f"{{trace: {{unit: bar, points: {points}}}}}"
    result = solved(f"crank: 100 mm\nrod: 500 mm\nbore: 100 mm\nindicator: {{head_end: {trace}}}\n")
    assert result.phi_rod_reversal == pytest.approx([20, 30, 50, 80], abs=1e-9)
    assert result.reversal_angle == pytest.approx(40, abs=1e-9)
    assert result.reversal_longest == pytest.approx(30, abs=1e-9)
    assert result.reversal_ratio == pytest.approx(1 / 3, rel=1e-12)


ALWAYS_PRESSED = """
speed: 300 rpm
stroke: 200 mm
rod_ratio: 5
bore: 150 mm
indicator:
  pressures: absolute
  head_end:
    compressor: {suction: 3 bar, delivery: 8 bar, clearance: 0.1, exponent: 1.3}
"""
MOTORED = """
cycle: four-stroke
speed: 750 rpm
stroke: 180 mm
rod_ratio: 4
bore: 150 mm
indicator:
  pressures: absolute
  head_end:
    unit: bar
    clearance: 0.08
    interpolate: polytropic
    intake: [[0, 0.95], [1, 0.95]]
    compression: [[1, 0.95], [0, 28]]
    expansion: [[0, 26], [1, 0.9]]
    exhaust: [[1, 1.05], [0, 1.05]]
"""


PUMP = """
speed: 60 rpm
stroke: 200 mm
rod_ratio: 5
bore: 150 mm
masses: {piston: 20 kg}
indicator: {head_end: {constant: {expansion: -0.4 bar, compression: 20 bar}}}
"""
"""A plunger that presses all the time but for the suction, which is less than its inertia."""


@pytest.mark.parametrize("name", sorted(CONFIGS))
def test_of_the_shipped_machines_compressors_alone_have_rod_loads(name: str) -> None:
    is_compressor = name in ("compressor", "compressor-two-stage")
    case = case_of(name)
    assert all(forces.no_compressor != is_compressor for forces in case.cylinders)


def test_a_pump_gets_no_rod_load_but_by_name() -> None:
    """Its piston is driven, as that of a compressor, but what it moves is a liquid."""
    for text in (PUMP, PUMP.replace("{head_end", "{role: pump, head_end"), f"{PUMP}pump: {{}}\n"):
        case = Case(loads(text))
        forces = case.cylinders[0]
        assert forces.work < 0
        assert not any("rod load" in warning for warning in cylinder_warnings(forces))
        report = report_of(case, Frame("forces", (0.0,), None, "metric"))
        ids = {key_value.id for part in report.all_parts for key_value in part.key_values}
        assert "P_max" in ids
        assert not ids & {"rod_compression_max", "reversal_angle", "gas_tension_max"}
        assert "P_rod" not in {column.id for part in report.all_parts for column in part.columns}
        assert not any("API 618" in note for note in report.notes)
        # after the outer dead centre 20 bar on the area, and m R ω² (1 − λ) at 1 Hz
        largest = 20e5 * float(pi) / 4 * 0.15**2 + 20 * 0.1 * (2 * float(pi)) ** 2 * (1 - 1 / 5)
        assert forces.rod_compression_max.value == pytest.approx(largest, rel=1e-12)


def test_a_rod_with_another_load_has_no_rod_load_of_the_gas_alone() -> None:
    """The definition of API 618 has gas, inertia and weight; a spring on the rod it does not know."""
    for load in ("force: {spring: 5 N/mm, preload: 1 kN}", "ram_force: {work: 1 kN, return: 1 kN}"):
        (forces,) = Case(loads(f"{ALWAYS_PRESSED}{load}\n")).cylinders
        assert forces.no_compressor
        assert not any("rod load" in warning for warning in cylinder_warnings(forces))
    assert not Case(loads(ALWAYS_PRESSED)).cylinders[0].no_compressor


def test_load_cases_of_a_pump_have_no_rod_load_either() -> None:
    cases = "cases: [{name: slow, set: {speed: 30 rpm}}]\n"
    for text, is_compressor in ((PUMP, False), (ALWAYS_PRESSED, True)):
        machine = loads(text + cases)
        report = cases_report(machine, cases_of(machine), "forces", "metric")
        (table,) = [table for part in report.all_parts for table in part.place_tables]
        ids = {column.id for column in table.columns}
        assert "p_max" in ids
        assert ("rod_compression_max" in ids) == is_compressor
        # by name it is there
        named = cases_report(machine, cases_of(machine), "forces", "metric", ["P_G,d"])
        assert named.all_parts[0].place_tables[0].columns[0].id == "rod_compression_max"


def test_a_role_makes_a_compressor_of_a_trace() -> None:
    """Samples that may be those of a motored engine: what nobody names is judged as a compressor, as before."""
    points = [[degrees, 1 + 4 * (degrees % 360 > 180)] for degrees in range(0, 360, 10)]
    trace = f"{{trace: {{unit: bar, points: {points}}}}}"
    indicator = f"indicator: {{ROLE head_end: {trace}}}\n"
    text = f"crank: 100 mm\nrod: 500 mm\nbore: 100 mm\n{indicator}"
    for role, is_none in (("", False), ("role: compressor,", False), ("role: engine,", True)):
        assert solved(text.replace("ROLE", role)).no_compressor == is_none


def test_a_motored_engine_is_no_compressor() -> None:
    """Its gas work is negative, as a compressor's, but nobody judges it by the rod load of compressors."""
    forces = Case(loads(f"{MOTORED}masses: {{piston: 3 kg}}\n")).cylinders[0]
    assert forces.work < 0
    assert [
        cylinder_warning
        for cylinder_warning in cylinder_warnings(forces)
        if "rod load" in cylinder_warning
    ] == []
    assert [
        cylinder_warning
        for cylinder_warning in cylinder_warnings(Case(loads(ALWAYS_PRESSED)).cylinders[0])
        if "rod load" in cylinder_warning
    ]
