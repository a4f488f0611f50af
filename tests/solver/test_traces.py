"""Measured traces: work, pressures, many cycles, exponents, volumes, level, the motored dead centre, and the brake."""

import csv
import io
import json
import math
import re
import statistics
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner
from scipy.integrate import quad

from command import run
from indicated import RATIO, Engine, absolute, columns_file, cycles, fraction, indicated
from kurbel.cli import kurbel
from kurbel.errors import MachineFileError, UsageError
from kurbel.machine import Cylinder, Machine
from kurbel.machine.indicator import Indicator
from kurbel.machine.measured import Measured, Motored, dead_centre
from kurbel.machine.parts import Friction, Masses, Piston
from kurbel.machine_file import load
from kurbel.mechanisms.slider_crank import SliderCrank
from kurbel.report.commands import report_of
from kurbel.solver.case import Case
from kurbel.solver.forces import CylinderForces
from kurbel.tables.frame import Frame
from kurbel.traces.correct import Trace
from kurbel.traces.read import Layout
from representative import few

BAR = 1e5
CRANK = SliderCrank(0.2, 0.9)


def smooth(degrees: Any) -> Any:
    """A smooth two-stroke pressure in bar whose Fourier series ends at the third harmonic."""
    phi = np.radians(degrees)
    return 6 + 4 * np.cos(phi - 0.4) + 1.5 * np.cos(2 * phi - 0.9) + 0.4 * np.cos(3 * phi - 1.3)


def trace(step: float, zero: float = 0.0, period: float = 360.0, closed: bool = True) -> Trace:
    count = round(period / step)
    angles = np.arange(count + closed) * period / count
    return Measured.from_keys(
        unit=(BAR, 1),
        points=list(zip(angles.tolist(), smooth(angles - zero).tolist())),
        angle_zero=zero,
    )


def solved(
    head: Any, crank: Any = None, cycle: str = "two-stroke", mechanism: Any = CRANK, **more: Any
) -> CylinderForces:
    piston = Piston(0.3, head_end_rod=0.0, crank_end_rod=0.08, indicator=Indicator(head, crank))
    own = Cylinder(mechanism, pistons=(piston,), **more)
    return CylinderForces(Machine((own,), speed=3.0, cycle=cycle), own)


@pytest.mark.parametrize(
    "angles", [np.arange(0.0, 720.5, 0.5), np.array([0.0, 100.0, 300.0, 720.0])]
)
def test_a_constant_pressure_does_no_work(angles: Any) -> None:
    """Not even its rounding, by which a brake power would be divided."""
    points = [(angle, 2.3) for angle in angles.tolist()]
    result = solved(Measured.from_keys(unit=(BAR, 1), points=points), cycle="four-stroke")
    assert result["work"].value == 0


@cache
def precise_area() -> float:
    """∮ p dx of the smooth pressure, by scipy's Gauss and Kronrod."""

    def torque(phi: float) -> float:
        p = (
            6
            + 4 * math.cos(phi - 0.4)
            + 1.5 * math.cos(2 * phi - 0.9)
            + 0.4 * math.cos(3 * phi - 1.3)
        )
        psi = math.asin(0.2 / 0.9 * math.sin(phi))
        return p * 0.2 * math.sin(phi + psi) / math.cos(psi)

    return float(quad(torque, 0, 2 * math.pi, epsabs=0, epsrel=1e-13)[0]) * BAR


SAMPLED = [(step, closed) for closed in (True, False) for step in (30.0, 10.0, 1.0, 0.1)]


@pytest.mark.parametrize(("step", "closed"), few(SAMPLED, [*SAMPLED[:3], *SAMPLED[4:7]]))
def test_trapezoid_work_of_a_smooth_trace(step: float, closed: bool) -> None:
    """Of a smooth periodic pressure the trapezoid at equal angles is exact as soon as it resolves the harmonics."""
    expected = precise_area() * np.pi / 4 * 0.3**2
    tolerance = 1e-3 if step == 30 else 1e-12
    assert solved(trace(step, closed=closed)).work == pytest.approx(expected, rel=tolerance)


@pytest.mark.parametrize("zero", [360.0, -90.0, 17.3])
def test_angle_zero_shifts_the_trace(zero: float) -> None:
    assert solved(trace(0.5, zero)).work == pytest.approx(solved(trace(0.5)).work or 0, rel=1e-12)
    at = [0.0, 100.25, 359.0]
    assert solved(trace(0.5, zero)).at(at).p_head == pytest.approx(
        solved(trace(0.5)).at(at).p_head, rel=1e-4
    )


def test_angle_zero_is_the_dead_centre_of_an_offset_crank() -> None:
    """The first sample stands at φ_i, where the chamber is smallest."""
    mechanism = SliderCrank(0.2, 0.9, 0.1)
    forces = solved(trace(1.0), mechanism=mechanism)
    assert forces.at([mechanism.dead_centres()[0]]).p_head[0] == pytest.approx(
        smooth(0.0) * BAR, rel=1e-12
    )


def test_straight_over_the_angle_between_samples() -> None:
    points = [(0.0, 5.0), (50.0, 9.0), (180.0, 2.0), (180.0, 1.0), (360.0, 3.0)]
    forces = solved(Measured.from_keys(unit=(BAR, 1), points=points))
    at = forces.at([0, 25, 50, 115, 180, 270, 359.999999])
    assert at.p_head == pytest.approx(np.array([5, 7, 9, 5.5, 1, 2, 3]) * BAR, rel=1e-7)
    assert forces.at([180 - 1e-9]).p_head[0] == pytest.approx(2 * BAR)


def test_a_mirrored_trace_follows_one_stroke_later() -> None:
    one = trace(1.0)
    forces = solved(one, one)
    at = forces.at([0.0, 90.0, 180.0, 300.0])
    before = forces.at([180.0, 270.0, 0.0, 120.0])
    assert at.p_crank == pytest.approx(before.p_head, rel=1e-12)


def test_a_trace_of_its_own_at_the_crank_end_counts_from_the_same_dead_centre() -> None:
    forces = solved(trace(1.0), trace(0.5))
    assert forces.at([40.0]).p_crank[0] == pytest.approx(smooth(40.0) * BAR, rel=1e-4)
    ends = forces.drive.gas[0].works
    assert ends[1] == pytest.approx(-ends[0] * (0.3**2 - 0.08**2) / 0.3**2, rel=1e-12)


def test_sensitivity_is_the_change_for_a_tenth_of_a_degree() -> None:
    here = solved(trace(0.5)).work or 0.0
    later = solved(trace(0.5, zero=0.0)).work
    moved = replace(trace(0.5), angle_zero=-0.1)
    change = ((solved(moved).work or 0.0) - here) / here
    assert later == here
    assert solved(trace(0.5)).work_sensitivity == pytest.approx(change, rel=2e-3)


def test_every_kink_counts_for_the_extremes() -> None:
    """With noise on 7,200 samples the largest forces are still those of a search without gaps."""
    rng = np.random.default_rng(7)
    angles = np.arange(7201) / 20
    pressures = smooth(angles) + rng.normal(0, 0.2, 7201)
    points = list(zip(angles.tolist(), pressures.tolist()))
    forces = solved(
        Measured.from_keys(unit=(BAR, 1), points=points),
        masses=Masses(200.0),
        friction=Friction(0.05),
    )
    fine = forces.at(np.arange(0, 72001) / 200)
    for name in ("P", "S", "N", "T"):
        result = forces.extremes_of(name)
        assert result is not None
        column = getattr(fine, name)
        assert result.largest.value >= column.max() * (1 - 1e-12)
        assert result.largest.value == pytest.approx(column.max(), rel=1e-5)
        assert result.smallest.value <= column.min() + 1e-9
    assert abs(forces.energy_residual or 0.0) < 1e-5


@pytest.mark.parametrize(("step", "far"), [(60, True), (5, False)])
def test_samples_too_far_apart_are_reported(step: int, far: bool) -> None:
    points = [(a, float(smooth(a))) for a in range(0, 361, step)]
    piston = Piston(0.3, indicator=Indicator(Measured.from_keys(unit=(BAR, 1), points=points)))
    case = Case(Machine((Cylinder(CRANK, pistons=(piston,)),)))
    (part,) = report_of(case, Frame("forces", [0.0], None, "si")).parts
    assert far == any("the samples are too far apart" in warning for warning in part.warnings)


# many cycles of one engine

ENGINE = Engine()
STROKE, BORE = 0.1, 0.09
AREA = np.pi / 4 * BORE**2
FINE = np.arange(0.0, 720.0, 0.5)
ONE = absolute(ENGINE, FINE)
TABLE = np.column_stack((FINE, ONE))


def machine(
    folder: Path, table: Any, keys: str = "", top: str = "", cycle: str = "four-stroke"
) -> Path:
    """A machine file beside a table (n, k) of angles and absolute pressures in bar, all digits of them written."""
    columns_file(folder / "p.csv", table, "%.17g")
    (folder / "m.yaml").write_text(
        f"cycle: {cycle}\nspeed: 1500 rpm\nstroke: 100 mm\nrod_ratio: 4\nbore: 90 mm\n{top}"
        f"indicator: {{pressures: absolute, head_end: {{trace: {{file: p.csv, unit: bar{keys}}}}}}}\n"
    )
    return folder / "m.yaml"


def forces(*given: Any, **more: Any) -> CylinderForces:
    return Case(load(machine(*given, **more))).cylinders[0]


@cache
def many() -> tuple[Any, Any]:
    return cycles(ENGINE, 12, 0.5, noise=0.05, spread=0.08)


def in_columns(folder: Path, keys: str = "", **more: Any) -> CylinderForces:
    angles, each = many()
    return forces(
        folder, np.column_stack((angles, each.T)), f", pressure_columns: 2-13{keys}", **more
    )


def test_the_spread_of_many_cycles(tmp_path: Path) -> None:
    angles, each = many()
    p_i = [indicated(angles, one) for one in each]
    peaks = [float(one.max()) for one in each]
    result = in_columns(tmp_path)
    expected = {
        "cycles_measured": 12,
        "mean_pressure": statistics.fmean(p_i) * BAR,
        "mean_pressure_std": statistics.stdev(p_i) * BAR,
        "mean_pressure_cov": statistics.stdev(p_i) / statistics.fmean(p_i),
        "p_max_mean": statistics.fmean(peaks) * BAR,
        "p_max_std": statistics.stdev(peaks) * BAR,
        "p_max_most": max(peaks) * BAR,
        "cycle_worst": 1 + p_i.index(min(p_i)),
    }
    assert {name: result[name].value for name in expected} == pytest.approx(expected, rel=1e-11)
    assert result["p_max_most"].degrees == pytest.approx(
        angles[int(np.argmax(each[int(np.argmax(peaks))]))]
    )


@pytest.mark.parametrize("lap", [720.0, 360.0, 1e9])
def test_cycles_one_below_the_other_are_those_of_columns(tmp_path: Path, lap: float) -> None:
    """The angle begins anew in every cycle, in every turn, or never."""
    angles, each = many()
    counted = np.concatenate([angles + 720.0 * number for number in range(12)])
    result = forces(tmp_path, np.column_stack((counted % lap, each.ravel())))
    assert result.indicated.cycles is not None
    by_hand = [indicated(angles, one) * BAR for one in each]
    assert result.indicated.cycles.mean_pressure == pytest.approx(by_hand, rel=1e-12)
    at = np.arange(0.0, 720.0, 7.3)
    assert result.at(at).p_head == pytest.approx(
        in_columns(tmp_path).at(at).p_head, rel=1e-12, abs=1e-6
    )


def test_cycles_at_other_angles_each(tmp_path: Path) -> None:
    """A speed that is not quite even: every cycle has angles of its own; what is left over at the end is named."""
    angles, each = many()
    step = 0.5003
    counted = np.arange(0, 12 * 720 - 100, step)
    samples = np.interp(counted, np.arange(12 * 1440) * 0.5, each.ravel())
    result = forces(tmp_path, np.column_stack((counted, samples)))
    assert result["cycles_measured"].value == 11
    by_hand = [indicated(angles, one) * BAR for one in each[:11]]
    assert result["mean_pressure"].value == pytest.approx(statistics.fmean(by_hand), rel=1e-3)
    assert result.drive.own_gas.head is not None  # type: ignore[union-attr]
    assert any(
        "after lap 23 of 360 deg are left out" in note
        for note in result.drive.own_gas.head.trace.notes
    )  # type: ignore


def test_uneven_samples_of_each_cycle(tmp_path: Path) -> None:
    """Without equal angles a cycle's p_i is the exact integral of straight lines, here by another quadrature."""
    angles, each = many()
    kept = np.sort(np.random.default_rng(3).choice(len(angles), 1100, replace=False))
    kept[0] = 0
    result = forces(
        tmp_path, np.column_stack((angles[kept], each[:2, kept].T)), ", pressure_columns: 2-3"
    )
    assert result.indicated.cycles is not None
    for one, area in zip(each[:2, kept], result.indicated.cycles.mean_pressure):
        assert area == pytest.approx(straight(angles[kept], one, 0.0, 720.0) * BAR, rel=1e-11)


def straight(angles: Any, pressures: Any, begin: float, end: float) -> float:
    """∫ p dz over an angle along straight lines between samples, by Gauss's rule with six nodes on every piece."""
    nodes, weights = np.polynomial.legendre.leggauss(6)
    around = np.concatenate((angles, [angles[0] + 720.0]))
    values = np.concatenate((pressures, pressures[:1]))
    edges = np.unique(np.concatenate((around, [begin, end])))
    edges = edges[(edges >= begin) & (edges <= end)]
    middle, half = (edges[1:] + edges[:-1]) / 2, np.diff(edges) / 2
    at = middle[:, None] + half[:, None] * nodes
    phi = np.radians(at)
    sine = RATIO * np.sin(phi)
    slope = (np.sin(phi) + sine * np.cos(phi) / np.sqrt(1 - sine**2)) / 2
    return float(
        np.sum(np.interp(at, around, values) * slope * weights * np.radians(half)[:, None])
    )


def test_gross_and_net(tmp_path: Path) -> None:
    result = forces(tmp_path, TABLE)
    exchange = straight(FINE, ONE, 180.0, 540.0) * BAR
    assert result["mean_pressure_exchange"].value == pytest.approx(exchange, rel=1e-11)
    assert exchange < 0
    total = indicated(FINE, ONE) * BAR
    assert result["mean_pressure"].value == pytest.approx(total, rel=1e-12)
    assert result["mean_pressure_gross"].value == pytest.approx(total - exchange, rel=1e-12)


@pytest.mark.parametrize("level", [1.0, 3.7])
def test_without_a_pumping_loop_there_is_no_pressure_of_it(tmp_path: Path, level: float) -> None:
    """The same pressure through exhaust and intake: 1e-16 bar were printed."""
    one = np.where((FINE >= 180) & (FINE <= 540), level, absolute(ENGINE, FINE))
    result = forces(tmp_path, np.column_stack((FINE, one)))
    assert result["mean_pressure_exchange"].value == 0
    assert result["mean_pressure_gross"].value == result["mean_pressure"].value
    nearly = forces(
        tmp_path, np.column_stack((FINE, np.where((FINE > 200) & (FINE < 300), one + 1e-9, one)))
    )
    assert nearly["mean_pressure_exchange"].value < 0


def test_one_cycle_and_each_cycle(tmp_path: Path) -> None:
    angles, each = many()
    file = machine(tmp_path, np.column_stack((angles, each.T)), ", pressure_columns: 2-13")
    runner = CliRunner()
    reported = json.loads(
        runner.invoke(kurbel, ["forces", str(file), "--cycle", "7", "-f", "json"]).stdout
    )
    values = {
        key_value["id"]: key_value["value"] for key_value in reported["cylinders"][0]["key_values"]
    }
    assert values["mean_pressure"] == pytest.approx(indicated(angles, each[6]) * BAR, rel=1e-12)
    assert "cycles_measured" not in values
    table = runner.invoke(kurbel, ["forces", str(file), "--each-cycle", "-f", "csv"]).stdout
    rows = list(csv.DictReader(io.StringIO(table)))
    assert [row["cycle"] for row in rows] == [str(number) for number in range(1, 13)]
    assert [float(row["mean_pressure_Pa"]) for row in rows] == pytest.approx(
        [indicated(angles, one) * BAR for one in each], rel=1e-12
    )
    page = runner.invoke(kurbel, ["forces", str(file), "--each-cycle"]).stdout
    assert "Measured cycles" in page


@pytest.mark.parametrize(
    ("columns", "options", "said"),
    [
        (13, ["--cycle", "13"], "--cycle 13: there are 12 cycles, counted from 1"),
        (13, ["--cycle", "0"], "0 is not in the range"),
        (
            13,
            ["--each-cycle", "--columns", "T"],
            "--each-cycle has no table over the angle; leave out --columns",
        ),
        (13, ["--each-cycle", "--cycle", "3"], "leave out --cycle"),
        (2, ["--cycle", "1"], "no trace of this machine has several cycles; leave it out"),
        (2, ["--each-cycle"], "no trace of this machine has several cycles; leave it out"),
    ],
)
def test_cycles_that_are_not_there(
    tmp_path: Path, columns: int, options: list[str], said: str
) -> None:
    angles, each = many()
    file = machine(tmp_path, np.column_stack((angles, each.T)), f", pressure_columns: 2-{columns}")
    ran = run("forces", file, *options)
    assert (ran.exit_code, said in " ".join(ran.output.split())) == (2, True)


def test_exponents_are_those_of_the_lines(tmp_path: Path) -> None:
    """The trace is p V^1.33 while it is compressed; after the burning, times a factor that is all but constant."""
    engine = Engine(lasts=30.0)
    result = forces(tmp_path, np.column_stack((FINE, absolute(engine, FINE))), ", clearance: 1/14")
    assert result["n_compression"].value == pytest.approx(1.33, abs=1e-9)
    assert result["n_expansion"].value == pytest.approx(1.33, abs=2e-3)
    assert result["V_clearance"].value == pytest.approx(AREA * STROKE / 14, rel=1e-12)
    ratio = forces(
        tmp_path, np.column_stack((FINE, absolute(engine, FINE))), ", compression_ratio: 15"
    )
    assert ratio["n_compression"].value == pytest.approx(result["n_compression"].value, rel=1e-12)


def test_volume_over_pressure_is_the_work(tmp_path: Path) -> None:
    """∮ p dV of the csv with x, V and p is A_i; dV is the slope of V."""
    file = machine(tmp_path, TABLE, ", clearance: 1/14")
    step = ["--step", "0.5", "-f", "csv", "--columns", "x,V,dV,p_head,dp_head"]
    rows = list(csv.DictReader(io.StringIO(run("forces", file, *step).stdout)))
    phi, x, V, dV, p, dp = (np.array([float(row[name]) for row in rows]) for name in rows[0])
    assert pytest.approx(AREA * (x + STROKE / 14), rel=1e-12) == V
    assert pytest.approx(AREA * STROKE * (fraction(phi) + 1 / 14), rel=1e-9) == V
    work = float(np.sum((p * dV)[:-1])) * 0.5
    assert work == pytest.approx(Case(load(file)).cylinders[0]["work"].value, rel=1e-10)
    wide = (np.interp(phi + 0.5, phi, p) - np.interp(phi - 0.5, phi, p))[1:-1]
    assert dp[1:-1] == pytest.approx(wide, rel=1e-9, abs=1e-6)


def test_largest_rise_of_pressure(tmp_path: Path) -> None:
    result = forces(tmp_path, TABLE)["p_rise_max"]
    rises = (
        np.roll(ONE, -2) - ONE
    )  # over 1 deg, between samples; between them the chord is a mean of two
    assert result.value == pytest.approx(float(rises.max()) * BAR, rel=1e-12)
    assert result.degrees == pytest.approx((float(FINE[int(np.argmax(rises))]) + 0.5) % 720)


def test_brake_and_friction(tmp_path: Path) -> None:
    p_i = indicated(FINE, ONE) * BAR
    swept = AREA * STROKE * 25 / 2
    for brake in ("brake_power: 3.6 kW", f"brake_torque: {3600 / (2 * np.pi * 25)!r} N m"):
        file = machine(tmp_path, TABLE, top=f"{brake}\n")
        case = Case(load(file))
        for results in (case.cylinders[0], case.flywheel):
            assert results["mean_pressure_brake"].value == pytest.approx(3600 / swept, rel=1e-12)
            assert results["mean_pressure_friction"].value == pytest.approx(
                p_i - 3600 / swept, rel=1e-11
            )
            assert results["eta_m"].value == pytest.approx(3600 / (p_i * swept), rel=1e-12)


def test_the_brake_of_several_cylinders_is_of_the_machine(tmp_path: Path) -> None:
    text = machine(tmp_path, TABLE).read_text()
    head, body = text.split("stroke: 100 mm")
    each = f"    stroke: 100 mm{body}".replace("\n", "\n    ")
    (tmp_path / "m.yaml").write_text(
        f"brake_power: 7 kW\n{head}cylinders:\n  count: 2\n  firing_order: 1-2\n  each:\n{each}\n"
    )
    case = Case(load(tmp_path / "m.yaml"))
    indicated_power = 2 * indicated(FINE, ONE) * BAR * AREA * STROKE * 25 / 2
    assert case.flywheel["eta_m"].value == pytest.approx(7000 / indicated_power, rel=1e-12)
    with pytest.raises(UsageError, match="has no eta_m"):
        case.cylinders[0]["eta_m"]


# level and dead centre


def test_pegging_lifts_every_cycle(tmp_path: Path) -> None:
    """Cycles that stand at levels of their own come to the one that is known; p_i stays."""
    angles, each = cycles(ENGINE, 4, 0.5)
    adrift = each + np.array([[3.0], [-2.0], [7.5], [0.3]])
    table, keys = np.column_stack((angles, adrift.T)), ", pressure_columns: 2-5"
    at = np.arange(0.0, 720.0, 30.0)
    pegged = forces(tmp_path, table, f"{keys}, pegging: {{angle: -170 deg, pressure: 0.96 bar}}")
    level = np.interp(550, angles, each[0])
    window = each[0][(angles >= 547.5) & (angles <= 552.5)].mean()
    assert level == pytest.approx(window, rel=1e-3)
    expected = (np.interp(at, angles, each[0]) - window + 0.96) * BAR
    assert pegged.at(at).p_head == pytest.approx(expected, rel=1e-9, abs=1e-4)
    assert pegged["mean_pressure"].value == pytest.approx(
        indicated(angles, each[0]) * BAR, rel=1e-11
    )
    assert pegged["p_max_std"].value == pytest.approx(0.0, abs=1e-4)
    ambient = forces(tmp_path, table, f"{keys}, pegging: ambient")
    assert float(np.mean(ambient.at(np.arange(537.5, 542.6, 0.5)).p_head)) == pytest.approx(
        101325.0, rel=1e-12
    )


def test_drift_is_a_line(tmp_path: Path) -> None:
    result = forces(tmp_path, np.column_stack((FINE, ONE + 3 * FINE / 720)), ", drift: linear")
    assert result["mean_pressure"].value == pytest.approx(indicated(FINE, ONE) * BAR, rel=2e-3)
    closed = np.append(FINE, 720.0)
    known = forces(
        tmp_path,
        np.column_stack((closed, absolute(ENGINE, closed) + 3 * closed / 720)),
        ", drift: linear",
    )
    assert known["mean_pressure"].value == pytest.approx(indicated(FINE, ONE) * BAR, rel=1e-12)


@pytest.mark.parametrize(("zero", "noise"), [(0.0, 0.0), (359.83, 0.05), (100.0, 0.05)])
def test_the_dead_centre_of_a_motored_trace(tmp_path: Path, zero: float, noise: float) -> None:
    """A motored peak 0.7 deg before the dead centre: found within what the note says of its uncertainty."""
    angles = np.arange(0.0, 720.0, 0.2)
    rng = np.random.default_rng(5)
    peak = absolute(Engine(heat=0.0), angles - zero + 0.7) + noise * rng.standard_normal(
        len(angles)
    )
    columns_file(tmp_path / "motored.csv", np.column_stack((angles, peak)))
    table = np.column_stack((angles, absolute(ENGINE, angles - zero)))
    file = machine(tmp_path, table, ", angle_zero: {motored: motored.csv, loss_angle: 0.7 deg}")
    own = load(file)
    trace: Any = own.cylinders[0].pistons[0].indicator.head_end  # type: ignore[union-attr]
    off = (trace.angle_zero - zero + 360) % 720 - 360
    (note,) = [note for note in trace.notes if "angle_zero" in note]
    doubt = float(note.split("uncertain by ")[1].split(" deg")[0])
    assert abs(off) <= 3 * doubt + 2e-3
    assert doubt < 0.1
    assert "samples of motored.csv" in note
    assert str(tmp_path / "motored.csv") in own.trace_files


@pytest.mark.parametrize(("step", "noise"), few([(0.1, 0.3), (0.5, 0.3), (1.0, 0.3)], [(0.5, 0.3)]))
def test_noise_is_no_combustion_and_the_stated_uncertainty_covers_it(
    tmp_path: Path, step: float, noise: float
) -> None:
    """A dead centre at 0.37° under 0.3 bar of noise: no seed is refused, and two in three are within the stated."""
    angles, rng = np.arange(0.0, 720.0, step), np.random.default_rng(1)
    smooth, inside = absolute(Engine(heat=0.0), angles - 0.37), 0
    for _ in range(12):
        shaken = smooth + noise * rng.standard_normal(len(angles))
        columns_file(tmp_path / "motored.csv", np.column_stack((angles, shaken)), "%.5f")
        given = Motored(str(tmp_path / "motored.csv"), 0.0)
        zero, note = dead_centre(given, Layout(), lambda bar: np.asarray(bar * 1e5), against=False)
        off = abs((zero - 0.37 + 360) % 720 - 360)
        stated = float(re.findall(r"uncertain by ([0-9.]+) deg", note)[0])
        assert off < 5 * stated
        inside += off <= stated
    assert inside >= 8


@pytest.mark.parametrize("other", [ONE, np.where(np.abs((FINE - 50) % 720) < 30, 9.0, 1.0)])
def test_what_is_no_motored_trace(tmp_path: Path, other: Any) -> None:
    columns_file(tmp_path / "motored.csv", np.column_stack((FINE, other)))
    file = machine(tmp_path, TABLE, ", angle_zero: {motored: motored.csv, loss_angle: 0.7 deg}")
    with pytest.raises(MachineFileError, match=r"motored: .*is no motored trace"):
        load(file)
