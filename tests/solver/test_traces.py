"""Measured traces: work, pressures, tidying, warnings, and speed with very many samples."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import Any

import mpmath
import numpy as np
import pytest
from scipy.integrate import quad

from indicated import columns_file
from kurbel.errors import MachineFileError
from kurbel.machine import Cylinder, Machine
from kurbel.machine.indicator import Indicator
from kurbel.machine.measured import Measured
from kurbel.machine.parts import Friction, Masses, Piston
from kurbel.machine_file import load, loads
from kurbel.mechanisms.slider_crank import SliderCrank
from kurbel.report.check import checked
from kurbel.report.warnings import brake_warnings, trace_warnings
from kurbel.solver.case import Case
from kurbel.solver.forces import CylinderForces
from kurbel.traces.correct import Trace
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
        unit=(BAR, 1), points=list(zip(angles.tolist(), smooth(angles - zero).tolist())), angle_zero=zero
    )


def solved(
    head: Any, crank: Any = None, cycle: str = "two-stroke", mechanism: Any = CRANK, **more: Any
) -> CylinderForces:
    piston = Piston(0.3, 0.0, 0.08, Indicator(head, crank))
    own = Cylinder(mechanism, pistons=(piston,), **more)
    return CylinderForces(Machine((own,), speed=3.0, cycle=cycle), own)


@cache
def precise_area() -> float:
    """∮ p dx of the smooth pressure, by scipy's Gauss and Kronrod."""

    def torque(phi: float) -> float:
        p = 6 + 4 * math.cos(phi - 0.4) + 1.5 * math.cos(2 * phi - 0.9) + 0.4 * math.cos(3 * phi - 1.3)
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
    assert solved(trace(0.5, zero)).at(at).p_head == pytest.approx(solved(trace(0.5)).at(at).p_head, rel=1e-4)


def test_angle_zero_is_the_dead_centre_of_an_offset_crank() -> None:
    """The first sample stands at φ_i, where the chamber is smallest."""
    mechanism = SliderCrank(0.2, 0.9, 0.1)
    forces = solved(trace(1.0), mechanism=mechanism)
    assert forces.at([mechanism.dead_centres()[0]]).p_head[0] == pytest.approx(smooth(0.0) * BAR, rel=1e-12)


def test_straight_over_the_angle_between_samples() -> None:
    points = [(0.0, 5.0), (50.0, 9.0), (180.0, 2.0), (180.0, 1.0), (360.0, 3.0)]
    forces = solved(Measured.from_keys(unit=(BAR, 1), points=points))
    at = forces.at([0, 25, 50, 115, 180, 270, 359.999999])
    assert at.p_head == pytest.approx(np.array([5, 7, 9, 5.5, 1, 2, 3]) * BAR, rel=1e-7)
    assert forces.at([180 - 1e-9]).p_head[0] == pytest.approx(2 * BAR)


def test_uneven_samples_give_the_exact_work_of_the_straight_lines() -> None:
    points = [(0.0, 5.0), (50.0, 9.0), (180.0, 2.0), (180.0, 1.0), (360.0, 5.0)]
    forces = solved(Measured.from_keys(unit=(BAR, 1), points=points))
    with mpmath.workdps(30):
        total = mpmath.mpf(0)
        for (a, p), (b, q) in pairwise(points):
            if b > a:

                def torque(deg: Any, a: float = a, b: float = b, p: float = p, q: float = q) -> Any:
                    phi = mpmath.radians(deg)
                    psi = mpmath.asin(mpmath.mpf(2) / 9 * mpmath.sin(phi))
                    return (p + (q - p) * (deg - a) / (b - a)) * mpmath.sin(phi + psi) / mpmath.cos(psi)

                total += mpmath.quad(torque, mpmath.linspace(a, b, 4))
        expected = float(total * mpmath.pi / 180 * 0.2 * BAR * mpmath.pi / 4 * mpmath.mpf("0.09"))
    assert forces.work == pytest.approx(expected, rel=1e-13)
    assert abs(forces.energy_residual or 0.0) < 1e-14


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
    forces = solved(Measured.from_keys(unit=(BAR, 1), points=points), masses=Masses(200.0), friction=Friction(0.05))
    fine = forces.at(np.arange(0, 72001) / 200)
    for name in ("P", "S", "N", "T"):
        found = forces.extremes_of(name)
        assert found is not None
        column = getattr(fine, name)
        assert found.largest.value >= column.max() * (1 - 1e-12)
        assert found.largest.value == pytest.approx(column.max(), rel=1e-5)
        assert found.smallest.value <= column.min() + 1e-9
    assert abs(forces.energy_residual or 0.0) < 1e-5


def test_integrals_follow_the_straight_lines() -> None:
    """Many narrow pieces: the quadrature of T is the exact work of the straight lines, not only the trapezoid's."""
    forces = solved(trace(0.1))
    gas = forces.drive.gas[0]
    assert gas.head is not None
    weights, pressures = gas.head.straight_weights(), gas.head.pressures  # type: ignore[attr-defined]
    straight = float(weights @ pressures) * gas.piston.head_area * 0.4
    turnover = float(forces.pieces.integral(np.abs(forces.samples.M))[0])
    mean = (forces.energy_residual or 0.0) * turnover + (forces.work or 0.0)
    assert mean == pytest.approx(straight, rel=1e-10)
    assert straight == pytest.approx(forces.work or 0.0, rel=1e-5)
    assert straight != forces.work


@pytest.mark.parametrize(
    ("cycle", "count"),
    few([("two-stroke", 100_000), ("two-stroke", 10_000), ("four-stroke", 20_000)], [("two-stroke", 10_000)]),
)
def test_very_many_samples(tmp_path: Path, cycle: str, count: int) -> None:
    """What reading and computing them takes is in benchmarks/reading.py."""
    period = 360.0 if cycle == "two-stroke" else 720.0
    angles = np.arange(count) * period / count
    columns_file(tmp_path / "p.csv", np.c_[angles, smooth(angles)])
    (tmp_path / "m.yaml").write_text(
        f"cycle: {cycle}\nspeed: 60 rpm\ncrank: 200 mm\nrod: 900 mm\nbore: 300 mm\nmasses: {{piston: 90 kg}}\n"
        "indicator: {head_end: {trace: {file: p.csv, unit: bar}}}\n"
    )
    forces = Case(load(tmp_path / "m.yaml")).cylinders[0]
    assert forces.extremes_of("T") is not None
    assert abs(forces.energy_residual or 0.0) < 1e-8
    expected = precise_area() * np.pi / 4 * 0.3**2 * period / 360
    assert forces.work == pytest.approx(expected, rel=1e-6)


# reading

HEAD = "crank: 200 mm\nrod: 900 mm\nbore: 300 mm\nspeed: 60 rpm\n"


def machine_of(tmp_path: Path, text: str | bytes, keys: str = "", more: str = "") -> Machine:
    (tmp_path / "p.csv").write_bytes(text if isinstance(text, bytes) else text.encode())
    (tmp_path / "m.yaml").write_text(
        f"{HEAD}{more}indicator: {{head_end: {{trace: {{file: p.csv, unit: bar{keys}}}}}}}\n"
    )
    return load(tmp_path / "m.yaml")


def columns_of(machine: Machine) -> tuple[list[float], list[float]]:
    samples = machine.cylinders[0].pistons[0].indicator.head_end  # type: ignore[union-attr]
    return samples.angles.tolist(), samples.pressures.tolist()


GOOD = [f"{angle},{1 + angle / 100}" for angle in range(0, 361, 10)]


def broken(line: int, text: str) -> str:
    return "\n".join([*GOOD[: line - 1], text, *GOOD[line:]]) + "\n"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (broken(5, "40,nan"), "line 5: the pressure is nan, not a number; leave such rows out"),
        (broken(5, "inf,3"), "line 5: the angle is inf, not a number"),
        (broken(5, "40,1e400"), "line 5: the pressure is inf"),
        (broken(6, "20,3"), "line 6: 20 deg after 40 deg; put the points in order of the angle"),
        (broken(6, "50,x3"), "line 6: column 2 holds no number"),
        (broken(6, "50"), "line 6 has no column 2: 50"),
        (broken(6, "50;3"), "line 6 has no column 2: 50;3; write 'delimiter: semicolon'"),
        (broken(1, "angle,bar"), "line 1: column 1 holds no number; write 'skip_rows: 1' if it is a heading"),
        ("0;1,5\n180;2\n360;1\n", "line 1: '0;1' is no number; write 'delimiter: semicolon'"),
        ("", "p.csv has no figures"),
        ("# nothing\n\n", "p.csv has no figures"),
        ("0,1\n", "line 1: a trace needs samples at two angles or more"),
        ("0,1\n0,2\n", "line 1: a trace needs samples at two angles or more"),
        ("0,1\n90,2\n90,3\n90,4\n360,1", "line 4: three points at 90 deg; a jump has two"),
        (
            "\n".join(GOOD[:25]),
            "line 25: no samples from 240 to 360 deg; a trace covers a whole cycle of 360 or 720 deg",
        ),
        ("0,1\n720,2\n1440,1\n", "line 3: the samples run over 1440 deg; cut whole cycles out"),
        (b"\xff\xfe0\x00,\x001\x00", "line 1"),
    ],
)
def test_what_cannot_be_a_trace_is_named_with_its_line(tmp_path: Path, text: str | bytes, message: str) -> None:
    with pytest.raises(MachineFileError) as caught:
        machine_of(tmp_path, text)
    (fault,) = caught.value.faults
    assert fault.path == ("indicator", "head_end", "trace", "file")
    assert message in fault.message
    assert (fault.line, fault.source_line[fault.column - 1 :][:5]) == (5, "p.csv")


def test_decimal_commas_without_saying_so(tmp_path: Path) -> None:
    with pytest.raises(MachineFileError, match=r"line 1: '1,5' is no number; write 'decimal: comma'"):
        machine_of(tmp_path, "0;1,5\n180;2,5\n360;1,5\n", ", delimiter: semicolon")


def test_points_are_judged_in_the_same_way() -> None:
    points = "[[0, 1], [100, 2], [90, 1], [360, 1]]"
    with pytest.raises(MachineFileError, match=r"trace.points\[2\]: 90 deg after 100 deg"):
        loads(f"{HEAD}indicator: {{head_end: {{trace: {{unit: bar, points: {points}}}}}}}")


def test_the_missing_closing_sample_is_taken_from_the_first(tmp_path: Path) -> None:
    machine = machine_of(tmp_path, "\n".join(GOOD[:-1]))
    angles, pressures = columns_of(machine)
    assert (angles[-1], pressures[-1]) == (360, pressures[0])
    assert notes_of(machine) == ()  # as loggers write them; a drift would be seen all the same


def test_gaps_are_told(tmp_path: Path) -> None:
    rows = "\n".join(f"{a / 10},{2}" for a in range(3601) if not 1000 < a < 1200)
    (note,) = machine_of(tmp_path, rows).cylinders[0].pistons[0].indicator.head_end.notes  # type: ignore[union-attr]
    assert note == "no samples from 100 to 120 deg; a straight line joins them"


def rows(*angles: float) -> str:
    return "".join(f"{angle:.10g},{2 + (angle > 180):g}\n" for angle in angles)


@pytest.mark.parametrize(("begin", "end"), [(100, 126), (40, 140), (10, 330), (2, 200)])
@pytest.mark.parametrize("step", [0.5, 2])
def test_large_holes_are_refused(tmp_path: Path, begin: int, end: int, step: float) -> None:
    """Also those over more than half of the cycle, and whatever the largest step elsewhere is."""
    angles = [a for a in np.arange(0, 360 + step, step).tolist() if not begin < a < end]
    with pytest.raises(MachineFileError) as caught:
        machine_of(tmp_path, rows(*angles))
    assert f"no samples from {begin} to {end} deg" in caught.value.faults[0].message


def test_a_hole_does_not_widen_what_may_be_missing_at_the_end(tmp_path: Path) -> None:
    angles = [a for a in np.arange(0, 344).tolist() if not 100 < a < 118]
    with pytest.raises(MachineFileError, match="no samples from 343 to 360 deg"):
        machine_of(tmp_path, rows(*angles))


def test_small_holes_are_told_and_a_denser_stretch_is_none(tmp_path: Path) -> None:
    dense = np.unique(np.concatenate((np.arange(0, 361), np.arange(0, 600) / 10)))
    assert notes_of(machine_of(tmp_path, rows(*dense.tolist()))) == ()
    holed = [a for a in dense.tolist() if not 200 < a < 204]
    assert notes_of(machine_of(tmp_path, rows(*holed))) == (
        "no samples from 200 to 204 deg; a straight line joins them",
    )


def notes_of(machine: Machine) -> tuple[str, ...]:
    return machine.cylinders[0].pistons[0].indicator.head_end.notes  # type: ignore


def test_an_angle_that_begins_anew_is_put_in_order(tmp_path: Path) -> None:
    turned = [*range(180, 360, 5), *range(0, 180, 5)]
    machine = machine_of(tmp_path, "".join(f"{a},{1 + a / 100}\n" for a in turned))
    angles, pressures = columns_of(machine)
    assert angles == [*range(0, 360, 5), 360]
    assert pressures[:-1] == pytest.approx([BAR * (1 + a / 100) for a in range(0, 360, 5)])
    assert notes_of(machine)[0] == "the angle begins anew at 0 deg; the samples from there on come first"


def test_faults_of_a_turned_trace_name_their_own_lines(tmp_path: Path) -> None:
    turned = "".join(f"{a},2\n" for a in [*range(180, 360, 5), 0, 5, 5, 5, *range(10, 180, 5)])
    with pytest.raises(MachineFileError, match="line 40: three points at 5 deg"):
        machine_of(tmp_path, turned)


@pytest.mark.parametrize("broken", ["\r", "\r\n", "\n"])
def test_lines_are_counted_as_they_are_read(tmp_path: Path, broken: str) -> None:
    text = broken.join(["# a form feed \x0c, and a separator \x1c \u2028", "0,1", "90,x", "360,1"])
    with pytest.raises(MachineFileError, match="line 3: column 2 holds no number"):
        machine_of(tmp_path, text.encode())


@pytest.mark.parametrize(
    ("text", "more", "advice"),
    [
        ("0,x\n", "", "line 1: column 2 holds no number; is it a file of figures?"),
        ("0 1\n1\n", ", delimiter: space", "line 2"),
    ],
)
def test_nothing_is_advised_that_is_already_set(tmp_path: Path, text: str, more: str, advice: str) -> None:
    with pytest.raises(MachineFileError) as caught:
        machine_of(tmp_path, text, more)
    assert advice in caught.value.faults[0].message
    assert "delimiter" not in caught.value.faults[0].message


def test_a_pipe_is_no_file_of_samples(tmp_path: Path) -> None:
    """Opening one would wait for ever."""
    import os

    os.mkfifo(tmp_path / "p.csv")
    with pytest.raises(MachineFileError, match="is a device or a pipe"):
        loads(f"{HEAD}indicator: {{head_end: {{trace: {{unit: bar, file: {tmp_path / 'p.csv'}}}}}}}")


def test_samples_given_twice(tmp_path: Path) -> None:
    machine = machine_of(tmp_path, "0,1\n120,2\n120,2\n360,1\n")
    assert columns_of(machine)[0] == [0, 120, 360]
    assert machine.cylinders[0].pistons[0].indicator.head_end.notes  # type: ignore[union-attr]


def test_a_trace_of_one_turn_is_no_four_stroke_cycle(tmp_path: Path) -> None:
    message = "the trace covers 360 deg, a four-stroke cycle has 720 deg; write 'cycle: two-stroke' at the top"
    with pytest.raises(MachineFileError, match=f"indicator.head_end: {message}"):
        machine_of(tmp_path, "\n".join(GOOD), more="cycle: four-stroke\n")


# warnings


def warned(
    points: list[tuple[float, float]], cycle: str = "two-stroke", zero: float = 0.0, absolute: bool = False
) -> list[str]:
    piston = Piston(
        0.3, indicator=Indicator(Measured.from_keys(unit=(BAR, 1), points=points, angle_zero=zero), absolute=absolute)
    )
    own = Cylinder(CRANK, pistons=(piston,))
    return list(trace_warnings(CylinderForces(Machine((own,), speed=3.0, cycle=cycle), own)))


def motored(late: float, level: float = 0.0) -> list[tuple[float, float]]:
    """A motored two-stroke chamber whose peak stands this many degrees late."""
    angles = np.arange(0.0, 361.0)
    volume = 0.1 + (1 - np.cos(np.radians(angles - late))) / 2
    return list(zip(angles.tolist(), ((1.1 / volume) ** 1.35 - 0.4 + level).tolist()))


def test_a_plausible_trace_is_not_blamed() -> None:
    angles = np.arange(0.0, 361.0)
    assert warned(list(zip(angles.tolist(), smooth(angles).tolist()))) == []
    assert warned(motored(0.0)) == []
    assert warned(motored(-1.0)) == []


@pytest.mark.parametrize(("late", "text"), [(-5.0, "5.2 deg before the dead centre")])
def test_motored_peak_away_from_the_dead_centre(late: float, text: str) -> None:
    """Heat loss puts it up to a degree before; here the work is negative as well, so nothing burns.

    The losses taken off below move the peak itself by p′/p″ = 0.5 cos 5° π/180 / 0.044, 0.2° more.
    """
    points = motored(late)
    shaken = [(a, p - 0.5 * np.sin(np.radians(a))) for a, p in points]  # losses: less work on the way out
    (warning,) = warned(shaken)
    assert text in warning
    assert "check angle_zero" in warning


@pytest.mark.parametrize("late", [-5.0, -2.0, 0.5, 1.0, 2.0, 5.0])
def test_motored_traces_are_known_by_their_shape(late: float) -> None:
    """Too late, a motored trace does positive work; its two sides are alike all the same."""
    (warning,) = warned(finely_motored(late))
    assert warning.startswith("piston, head end: no combustion shows, and the peak is")
    assert f"{abs(late):.2g} deg {'after' if late > 0 else 'before'}" in warning


@pytest.mark.parametrize("late", [-1.0, -0.5, 0.0])
def test_heat_loss_puts_a_motored_peak_before_the_dead_centre(late: float) -> None:
    assert warned(finely_motored(late)) == []


@pytest.mark.parametrize("late", [2.0, 5.0, 8.0, 15.0])
def test_late_combustion_is_not_taken_for_a_motored_engine(late: float) -> None:
    """Burning evenly over 40° from 10° before the dead centre, or later: (p V^n)′ ∝ the heat set free."""
    angles = np.arange(0.0, 360.1, 0.1)
    phi = (angles + 180) % 360 - 180
    volume = 0.12 + (1 - np.cos(np.radians(angles))) / 2
    burnt = np.clip((phi + 25 - late) / 40, 0, 1)
    heat = 1 + 1.5 * burnt**2 * (3 - 2 * burnt)
    pressures = (1.12 / volume) ** 1.33 * heat - 0.9
    assert not [w for w in warned(list(zip(angles.tolist(), pressures.tolist()))) if "motored" in w]


def finely_motored(late: float) -> list[tuple[float, float]]:
    angles = np.arange(0.0, 360.05, 0.1)
    volume = 0.1 + (1 - np.cos(np.radians(angles - late))) / 2
    return list(zip(angles.tolist(), ((1.1 / volume) ** 1.35 - 0.4).tolist()))


def test_jump_between_the_ends() -> None:
    (warning,) = warned([(0.0, 5.0), (90.0, 9.0), (180.0, 2.0), (360.0, 4.0)])
    assert warning.startswith("piston, head end: the pressure jumps by 1 bar where the cycle closes")


def test_levels() -> None:
    points = [(0.0, 5.0), (90.0, 9.0), (180.0, 0.0), (360.0, 5.0)]
    (warning,) = warned(points, absolute=True)
    assert "these look like gauge pressures" in warning
    (warning,) = warned([(a, p + 1.0) for a, p in points])
    assert "write 'pressures: absolute'" in warning
    (warning,) = warned([(a, p - 1.1) for a, p in points])
    assert "the perfect vacuum being at -1.013 bar" in warning


def test_firing_in_the_gas_exchange() -> None:
    points = [(0.0, 0.1), (350.0, 9.0), (370.0, 30.0), (500.0, 2.0), (720.0, 0.1)]
    (warning,) = warned(points, "four-stroke")
    assert "write 'angle_zero: 360 deg';" in warning
    assert warned(points, "four-stroke", zero=360.0) == []


def test_indicated_below_brake_power(tmp_path: Path) -> None:
    machine = machine_of(tmp_path, "\n".join(GOOD), more="brake_power: 500 kW\n")
    (warning,) = brake_warnings(Case(machine))
    assert "far below what the driven shaft takes, 500 kW" in warning
    notes = [entry.text for section in checked(Case(machine)).sections for entry in section.entries]
    assert warning in notes


def test_samples_too_far_apart_are_told() -> None:
    from kurbel.report.crank import forces_report
    from kurbel.report.frame import Frame

    def told(points: list[tuple[float, float]]) -> bool:
        piston = Piston(0.3, indicator=Indicator(Measured.from_keys(unit=(BAR, 1), points=points)))
        (part,) = forces_report(
            Case(Machine((Cylinder(CRANK, pistons=(piston,)),))), Frame("forces", [0.0], None, "si")
        ).parts
        return any("the samples are too far apart" in warning for warning in part.warnings)

    coarse = [(a, float(smooth(a))) for a in range(0, 361, 60)]
    fine = [(a, float(smooth(a))) for a in range(0, 361, 5)]
    assert told(coarse)
    assert not told(fine)
