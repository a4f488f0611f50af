"""Many measured cycles, gross and net work, exponents, volumes, pegging, the motored dead centre, and the brake."""

from __future__ import annotations

import csv
import io
import json
import re
import statistics
from functools import cache, partial
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from click.testing import CliRunner
from scipy.integrate import quad
from scipy.optimize import minimize_scalar

from indicated import RATIO, Engine, absolute, columns_file, cycles, fraction, indicated
from kurbel.cli import kurbel
from kurbel.errors import MachineFileError, UsageError
from kurbel.machine.measured import Motored, dead_centre
from kurbel.machine_file import load
from kurbel.solver.case import Case
from kurbel.solver.forces import CylinderForces
from kurbel.traces.correct import parabola_peak
from kurbel.traces.read import Layout
from representative import few

pytestmark = pytest.mark.usefixtures("solved_once")

ENGINE = Engine()
BAR = 1e5
STROKE, BORE = 0.1, 0.09
AREA = np.pi / 4 * BORE**2
FINE = np.arange(0.0, 720.0, 0.5)


def machine(folder: Path, table: Any, keys: str = "", top: str = "", cycle: str = "four-stroke") -> Path:
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
    return forces(folder, np.column_stack((angles, each.T)), f", pressure_columns: 2-13{keys}", **more)


def test_the_spread_of_many_cycles(tmp_path: Path) -> None:
    angles, each = many()
    p_i = [indicated(angles, one) for one in each]
    peaks = [float(one.max()) for one in each]
    found = in_columns(tmp_path)
    assert found["cycles_measured"].value == 12
    assert found["mean_pressure"].value == pytest.approx(statistics.fmean(p_i) * BAR, rel=1e-12)
    assert found["mean_pressure_std"].value == pytest.approx(statistics.stdev(p_i) * BAR, rel=1e-11)
    assert found["mean_pressure_cov"].value == pytest.approx(statistics.stdev(p_i) / statistics.fmean(p_i), rel=1e-11)
    assert found["p_max_mean"].value == pytest.approx(statistics.fmean(peaks) * BAR, rel=1e-12)
    assert found["p_max_std"].value == pytest.approx(statistics.stdev(peaks) * BAR, rel=1e-11)
    most = found["p_max_most"]
    assert most.value == pytest.approx(max(peaks) * BAR, rel=1e-12)
    assert most.degrees == pytest.approx(angles[int(np.argmax(each[int(np.argmax(peaks))]))])
    assert found["cycle_worst"].value == 1 + p_i.index(min(p_i))


@pytest.mark.parametrize("lap", [720.0, 360.0, 1e9])
def test_cycles_one_below_the_other_are_those_of_columns(tmp_path: Path, lap: float) -> None:
    """The angle begins anew in every cycle, in every turn, or never."""
    angles, each = many()
    counted = np.concatenate([angles + 720.0 * number for number in range(12)])
    found = forces(tmp_path, np.column_stack((counted % lap, each.ravel())))
    assert found.indicated.cycles is not None
    by_hand = [indicated(angles, one) * BAR for one in each]
    assert found.indicated.cycles.mean_pressure == pytest.approx(by_hand, rel=1e-12)
    at = np.arange(0.0, 720.0, 7.3)
    assert found.at(at).p_head == pytest.approx(in_columns(tmp_path).at(at).p_head, rel=1e-12, abs=1e-6)


def test_cycles_at_other_angles_each(tmp_path: Path) -> None:
    """A speed that is not quite even: every cycle has angles of its own; what is left over at the end is told."""
    angles, each = many()
    step = 0.5003
    counted = np.arange(0, 12 * 720 - 100, step)
    samples = np.interp(counted, np.arange(12 * 1440) * 0.5, each.ravel())
    found = forces(tmp_path, np.column_stack((counted, samples)))
    assert found["cycles_measured"].value == 11
    by_hand = [indicated(angles, one) * BAR for one in each[:11]]
    assert found["mean_pressure"].value == pytest.approx(statistics.fmean(by_hand), rel=1e-3)
    (note,) = [
        one
        for one in Case(load(tmp_path / "m.yaml")).machine.cylinders[0].pistons[0].indicator.head_end.notes
        if "left out" in one
    ]  # type: ignore[union-attr]
    assert "after lap 23 of 360 deg are left out" in note


def test_uneven_samples_of_each_cycle(tmp_path: Path) -> None:
    """Without equal angles a cycle's p_i is the exact integral of straight lines, here by another quadrature."""
    angles, each = many()
    kept = np.sort(np.random.default_rng(3).choice(len(angles), 1100, replace=False))
    kept[0] = 0
    found = forces(tmp_path, np.column_stack((angles[kept], each[:2, kept].T)), ", pressure_columns: 2-3")
    assert found.indicated.cycles is not None
    for one, area in zip(each[:2, kept], found.indicated.cycles.mean_pressure):
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
    return float(np.sum(np.interp(at, around, values) * slope * weights * np.radians(half)[:, None]))


def test_gross_and_net(tmp_path: Path) -> None:
    one = absolute(ENGINE, FINE)
    found = forces(tmp_path, np.column_stack((FINE, one)))
    exchange = straight(FINE, one, 180.0, 540.0) * BAR
    assert found["mean_pressure_exchange"].value == pytest.approx(exchange, rel=1e-11)
    assert exchange < 0
    total = indicated(FINE, one) * BAR
    assert found["mean_pressure"].value == pytest.approx(total, rel=1e-12)
    assert found["mean_pressure_gross"].value == pytest.approx(total - exchange, rel=1e-12)


@pytest.mark.parametrize("level", [1.0, 3.7])
def test_without_a_pumping_loop_there_is_no_pressure_of_it(tmp_path: Path, level: float) -> None:
    """The same pressure through exhaust and intake: 1e-16 bar were told."""
    one = np.where((FINE >= 180) & (FINE <= 540), level, absolute(ENGINE, FINE))
    found = forces(tmp_path, np.column_stack((FINE, one)))
    assert found["mean_pressure_exchange"].value == 0
    assert found["mean_pressure_gross"].value == found["mean_pressure"].value
    nearly = forces(tmp_path, np.column_stack((FINE, np.where((FINE > 200) & (FINE < 300), one + 1e-9, one))))
    assert nearly["mean_pressure_exchange"].value < 0


def test_extremes_of_a_cycle_against_another_search(tmp_path: Path) -> None:
    """T and N along the straight lines between samples, by scipy in every piece that may hold the extreme."""
    angles, each = many()
    top = "masses: {piston: 1.2 kg}\n"
    found = forces(tmp_path, np.column_stack((angles, each[0])), top=top)
    one, omega, crank = each[0] - 1.01325, 50 * np.pi, STROKE / 2

    def force(degrees: float, factor: Any) -> float:
        phi = np.radians(degrees)
        sine = RATIO * np.sin(phi)
        cosine = np.sqrt(1 - sine**2)
        rate = RATIO * np.cos(phi) / cosine
        jerk = -RATIO * np.sin(phi) / cosine + rate**2 * sine / cosine
        # x = r (1 − cos φ) + l (1 − cos ψ): differentiated twice by φ
        b = crank * omega**2 * (np.cos(phi) + (cosine * rate**2 + sine * jerk) / RATIO)
        gas = np.interp(degrees, np.append(angles, 720.0), np.append(one, one[0])) * BAR * AREA
        return float((gas - 1.2 * b) * factor(np.sin(phi), np.cos(phi), sine, cosine))

    factors = {"T": lambda s, c, sine, cosine: s + c * sine / cosine, "N": lambda s, c, sine, cosine: sine / cosine}
    for name, factor in factors.items():
        dense = np.array([force(at, factor) for at in angles.tolist()])
        for sign, end in ((1, "max"), (-1, "min")):
            likely = np.argsort(-sign * dense)[:12]
            lows = [low for i in likely for low in (angles[i] - 0.5, angles[i])]
            values = [highest(partial(force, factor=factor), sign, low) for low in lows]
            best = max((sign * dense).max(), *values)
            assert found[f"{name}_{end}"].value == pytest.approx(sign * best, rel=1e-9)


def highest(force: Any, sign: int, low: float) -> float:
    """The largest of a force, or of its negative, over half a degree from an angle on."""
    options = {"xatol": 1e-10}
    return float(
        -minimize_scalar(lambda at: -sign * force(at), bounds=(low, low + 0.5), method="bounded", options=options).fun
    )


def test_one_cycle_and_each_cycle(tmp_path: Path) -> None:
    angles, each = many()
    file = machine(tmp_path, np.column_stack((angles, each.T)), ", pressure_columns: 2-13")
    runner = CliRunner()
    told = json.loads(runner.invoke(kurbel, ["forces", str(file), "--cycle", "7", "-f", "json"]).stdout)
    values = {one["id"]: one["value"] for one in told["cylinders"][0]["key_values"]}
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
    ("options", "said"),
    [
        (["--cycle", "13"], "--cycle 13: there are 12 cycles, counted from 1"),
        (["--cycle", "0"], "0 is not in the range"),
        (["--each-cycle", "--columns", "T"], "--each-cycle has no table over the angle; leave out --columns"),
        (["--each-cycle", "--cycle", "3"], "leave out --cycle"),
    ],
)
def test_cycles_that_are_not_there(tmp_path: Path, options: list[str], said: str) -> None:
    angles, each = many()
    file = machine(tmp_path, np.column_stack((angles, each.T)), ", pressure_columns: 2-13")
    ran = CliRunner().invoke(kurbel, ["forces", str(file), *options])
    assert (ran.exit_code, said in " ".join(ran.output.split())) == (2, True)


@pytest.mark.parametrize("option", [["--cycle", "1"], ["--each-cycle"]])
def test_one_cycle_only_has_no_others(tmp_path: Path, option: list[str]) -> None:
    file = machine(tmp_path, np.column_stack((FINE, absolute(ENGINE, FINE))))
    ran = CliRunner().invoke(kurbel, ["forces", str(file), *option])
    assert ran.exit_code == 2
    assert "no trace of this machine has several cycles; leave it out" in ran.output


def test_exponents_are_those_of_the_lines(tmp_path: Path) -> None:
    """The trace is p V^1.33 while it is compressed; after the burning, times a factor that is all but constant."""
    engine = Engine(lasts=30.0)
    found = forces(tmp_path, np.column_stack((FINE, absolute(engine, FINE))), ", clearance: 1/14")
    assert found["n_compression"].value == pytest.approx(1.33, abs=1e-9)
    assert found["n_expansion"].value == pytest.approx(1.33, abs=2e-3)
    assert found["V_clearance"].value == pytest.approx(AREA * STROKE / 14, rel=1e-12)
    ratio = forces(tmp_path, np.column_stack((FINE, absolute(engine, FINE))), ", compression_ratio: 15")
    assert ratio["n_compression"].value == pytest.approx(found["n_compression"].value, rel=1e-12)


def test_volume_over_pressure_is_the_work(tmp_path: Path) -> None:
    """∮ p dV of the csv with x, V and p is A_i; dV is the slope of V."""
    table = np.column_stack((FINE, absolute(ENGINE, FINE)))
    file = machine(tmp_path, table, ", clearance: 1/14")
    step = ["--step", "0.5", "-f", "csv", "--columns", "x,V,dV,p_head,dp_head"]
    rows = list(csv.DictReader(io.StringIO(CliRunner().invoke(kurbel, ["forces", str(file), *step]).stdout)))
    phi, x, V, dV, p, dp = (np.array([float(row[name]) for row in rows]) for name in rows[0])
    assert pytest.approx(AREA * (x + STROKE / 14), rel=1e-12) == V
    assert pytest.approx(AREA * STROKE * (fraction(phi) + 1 / 14), rel=1e-9) == V
    work = float(np.sum((p * dV)[:-1])) * 0.5
    assert work == pytest.approx(Case(load(file)).cylinders[0]["work"].value, rel=1e-10)
    wide = (np.interp(phi + 0.5, phi, p) - np.interp(phi - 0.5, phi, p))[1:-1]
    assert dp[1:-1] == pytest.approx(wide, rel=1e-9, abs=1e-6)


def test_largest_rise_of_pressure(tmp_path: Path) -> None:
    one = absolute(ENGINE, FINE)
    found = forces(tmp_path, np.column_stack((FINE, one)))["p_rise_max"]
    rises = np.roll(one, -2) - one  # over 1 deg, between samples; between them the chord is a mean of two
    assert found.value == pytest.approx(float(rises.max()) * BAR, rel=1e-12)
    assert found.degrees == pytest.approx((float(FINE[int(np.argmax(rises))]) + 0.5) % 720)


def test_brake_and_friction(tmp_path: Path) -> None:
    table = np.column_stack((FINE, absolute(ENGINE, FINE)))
    p_i = indicated(FINE, table[:, 1]) * BAR
    swept = AREA * STROKE * 25 / 2
    for brake in ("brake_power: 3.6 kW", f"brake_torque: {3600 / (2 * np.pi * 25)!r} N m"):
        file = machine(tmp_path, table, top=f"{brake}\n")
        case = Case(load(file))
        for results in (case.cylinders[0], case.flywheel):
            assert results["mean_pressure_brake"].value == pytest.approx(3600 / swept, rel=1e-12)
            assert results["mean_pressure_friction"].value == pytest.approx(p_i - 3600 / swept, rel=1e-11)
            assert results["eta_m"].value == pytest.approx(3600 / (p_i * swept), rel=1e-12)


def test_the_brake_of_several_cylinders_is_of_the_machine(tmp_path: Path) -> None:
    table = np.column_stack((FINE, absolute(ENGINE, FINE)))
    text = machine(tmp_path, table).read_text()
    head, body = text.split("stroke: 100 mm")
    each = f"    stroke: 100 mm{body}".replace("\n", "\n    ")
    (tmp_path / "m.yaml").write_text(
        f"brake_power: 7 kW\n{head}cylinders:\n  count: 2\n  firing_order: 1-2\n  each:\n{each}\n"
    )
    case = Case(load(tmp_path / "m.yaml"))
    indicated_power = 2 * indicated(FINE, table[:, 1]) * BAR * AREA * STROKE * 25 / 2
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
    assert pegged["mean_pressure"].value == pytest.approx(indicated(angles, each[0]) * BAR, rel=1e-11)
    assert pegged["p_max_std"].value == pytest.approx(0.0, abs=1e-4)
    ambient = forces(tmp_path, table, f"{keys}, pegging: ambient")
    assert float(np.mean(ambient.at(np.arange(537.5, 542.6, 0.5)).p_head)) == pytest.approx(101325.0, rel=1e-12)


def test_drift_is_a_line(tmp_path: Path) -> None:
    one = absolute(ENGINE, FINE)
    found = forces(tmp_path, np.column_stack((FINE, one + 3 * FINE / 720)), ", drift: linear")
    assert found["mean_pressure"].value == pytest.approx(indicated(FINE, one) * BAR, rel=2e-3)
    closed = np.append(FINE, 720.0)
    known = forces(tmp_path, np.column_stack((closed, absolute(ENGINE, closed) + 3 * closed / 720)), ", drift: linear")
    assert known["mean_pressure"].value == pytest.approx(indicated(FINE, one) * BAR, rel=1e-12)


@pytest.mark.parametrize("zero", [0.0, 359.83, 100.0])
@pytest.mark.parametrize("noise", [0.0, 0.05])
def test_the_dead_centre_of_a_motored_trace(tmp_path: Path, zero: float, noise: float) -> None:
    """A motored peak 0.7 deg before the dead centre: found within what the note says of its uncertainty."""
    angles = np.arange(0.0, 720.0, 0.2)
    rng = np.random.default_rng(5)
    peak = absolute(Engine(heat=0.0), angles - zero + 0.7) + noise * rng.standard_normal(len(angles))
    columns_file(tmp_path / "motored.csv", np.column_stack((angles, peak)))
    table = np.column_stack((angles, absolute(ENGINE, angles - zero)))
    file = machine(tmp_path, table, ", angle_zero: {motored: motored.csv, loss_angle: 0.7 deg}")
    own = load(file)
    trace: Any = own.cylinders[0].pistons[0].indicator.head_end  # type: ignore[union-attr]
    off = (trace.angle_zero - zero + 360) % 720 - 360
    (note,) = [one for one in trace.notes if "angle_zero" in one]
    doubt = float(note.split("uncertain by ")[1].split(" deg")[0])
    assert abs(off) <= 3 * doubt + 2e-3
    assert doubt < 0.1
    assert "samples of motored.csv" in note
    assert str(tmp_path / "motored.csv") in own.trace_files


def test_the_peak_of_a_parabola_is_exact() -> None:
    angles = np.arange(-10.0, 10.1, 0.5)
    found = parabola_peak(angles, 40 - 0.03 * (angles - 1.234) ** 2, 1.0, 6.0)
    assert found is not None
    assert found.place == pytest.approx(1.234, abs=1e-12)
    assert found.error < 1e-10


@pytest.mark.parametrize(("step", "noise"), few([(0.1, 0.3), (0.5, 0.3), (1.0, 0.3)], [(0.5, 0.3)]))
def test_noise_is_no_combustion_and_the_stated_uncertainty_covers_it(tmp_path: Path, step: float, noise: float) -> None:
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


@pytest.mark.parametrize(
    ("engine", "said"),
    [(ENGINE, "is no motored trace: "), (None, "is no motored trace")],
)
def test_what_is_no_motored_trace(tmp_path: Path, engine: Engine | None, said: str) -> None:
    other = absolute(engine, FINE) if engine else np.where(np.abs((FINE - 50) % 720) < 30, 9.0, 1.0)
    columns_file(tmp_path / "motored.csv", np.column_stack((FINE, other)))
    keys = ", angle_zero: {motored: motored.csv, loss_angle: 0.7 deg}"
    file = machine(tmp_path, np.column_stack((FINE, absolute(ENGINE, FINE))), keys)
    with pytest.raises(MachineFileError, match="motored: ") as caught:
        load(file)
    assert said in str(caught.value)


def test_work_by_quad(tmp_path: Path) -> None:
    """p_i of very fine samples is that of the smooth pressure, by scipy."""

    def of_angle(phi: float) -> float:
        sine = RATIO * np.sin(phi)
        slope = (np.sin(phi) + sine * np.cos(phi) / np.sqrt(1 - sine**2)) / 2
        return float(absolute(Engine(heat=0.0), np.degrees(phi)) * slope)

    compression, _ = quad(of_angle, -2.0, 2.0, epsabs=1e-12, epsrel=1e-12)
    found = forces(tmp_path, np.column_stack((FINE, absolute(Engine(heat=0.0), FINE))))
    assert compression == pytest.approx(0.0, abs=1e-10)
    assert found["mean_pressure"].value == pytest.approx(
        indicated(FINE, absolute(Engine(heat=0.0), FINE)) * BAR, rel=1e-9
    )
