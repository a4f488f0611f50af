"""Recordings by time: their speed from the pressure itself or from pulses; cycles made from the geometry of the crank."""

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from indicated import Engine, absolute, columns_file, indicated
from kurbel.errors import MachineFileError
from kurbel.machine_file import loads
from kurbel.notes.warnings import machine_notes
from kurbel.solver.case import Case

ENGINE = Engine()
SPEED = 1503.7
"""rpm"""
FINE = np.arange(0.0, 720.0, 0.25)


def recorded(cycles: float, rate: float, engine: Engine = ENGINE, scatter: float = 0.0) -> Any:
    """Times in s, and pressures in bar, of so many cycles at a rate in Hz that no turn is a multiple of."""
    times = np.arange(0.0, cycles * 120 / SPEED, 1 / rate)
    angles = times * 6 * SPEED
    heats = ENGINE.heat * (1 + scatter * np.random.default_rng(3).standard_normal(64))
    pressures = np.empty_like(angles)
    for number in range(int(cycles) + 1):
        inside = angles // 720 == number
        burnt = engine._replace(heat=float(heats[number]))
        pressures[inside] = absolute(burnt, angles[inside])
    return times, pressures


def machine_text(
    folder: Path, columns: Any, keys: str, cycle: str = "four-stroke", unit: str = "s"
) -> str:
    columns_file(folder / "p.csv", np.column_stack(columns), "%.9g")
    times = f", angle_unit: {unit}" if unit else ""
    return (
        f"cycle: {cycle}\nspeed: 1500 rpm\nstroke: 100 mm\nrod_ratio: 4\nbore: 90 mm\n"
        f"indicator: {{pressures: absolute, head_end: {{trace: {{file: '{folder / 'p.csv'}', "
        f"unit: bar{times}{keys}}}}}}}\n"
    )


def trace_notes(case: Case) -> list[str]:
    notes = [note.text for note in machine_notes(case)]
    return [note for note in notes if note.startswith("piston, ") and "left out" not in note]


@pytest.mark.parametrize("cycles", [3.4, 8.0, 11.7])
def test_the_speed_is_that_of_the_pressure(tmp_path: Path, cycles: float) -> None:
    """Without a speed, and with one that is off: p_i of equal cycles, which therefore do not scatter."""
    columns = recorded(cycles, 37e3)
    true = indicated(FINE, absolute(ENGINE, FINE))
    for keys in (
        "",
        f", recorded_speed: {SPEED * 1.0012} rpm",
        f", recorded_speed: {SPEED * 0.97} rpm",
    ):
        case = Case(loads(machine_text(tmp_path, columns, keys)))
        forces = case.cylinders[0]
        assert forces["mean_pressure"].value / 1e5 == pytest.approx(true, rel=3e-3)
        assert forces["mean_pressure_cov"].value < 2e-3
        notes = trace_notes(case)
        if not keys:
            assert notes == []
            continue
        (note,) = notes
        (shown,) = re.findall(r"recorded_speed: ([0-9.]+) rpm", note)
        assert float(shown) == pytest.approx(SPEED, rel=1e-4)


def test_cycles_that_scatter_by_time(tmp_path: Path) -> None:
    """The coefficient of variation is that of the cycles, also of a recording whose speed is given 0.3 % too high."""
    columns = recorded(12.0, 37e3, scatter=0.1)
    covs = []
    for factor in (1.0, 1.003):
        keys = f", recorded_speed: {SPEED * factor} rpm"
        forces = Case(loads(machine_text(tmp_path, columns, keys))).cylinders[0]
        covs.append(forces["mean_pressure_cov"].value)
    assert covs[1] == pytest.approx(covs[0], rel=0.02)


def test_the_speed_of_two_strokes(tmp_path: Path) -> None:
    """One period is one turn: the same file as that of four strokes in half the time."""
    times, pressures = recorded(6.0, 37e3)
    text = machine_text(tmp_path, (times, pressures), ", angle_zero: 0 deg", "two-stroke")
    trace = loads(text).cylinders[0].pistons[0].chambers["head_end"]
    assert trace.over(360.0).period == 360.0
    assert trace.over(720.0).period == 720.0


def test_a_pressure_without_a_period_needs_a_speed(tmp_path: Path) -> None:
    times = np.arange(0.0, 0.08, 1e-4)
    with pytest.raises(MachineFileError, match="the pressure has no clear period; write"):
        loads(machine_text(tmp_path, (times, 1 + times), ""))


def test_a_speed_far_off_is_answered_with_that_of_the_pressure(tmp_path: Path) -> None:
    columns = recorded(11.7, 37e3)
    with pytest.raises(
        MachineFileError, match=r"recorded_speed: 751\.8.* rpm' in two strokes, 150"
    ):
        loads(machine_text(tmp_path, columns, ", recorded_speed: 1200 rpm"))


@pytest.mark.parametrize(("teeth", "missing"), [(60, 2), (36, 1), (90, 0)])
def test_angles_by_the_pulses_of_a_wheel(tmp_path: Path, teeth: int, missing: int) -> None:
    """A speed that swings by 3 % within each turn: only pulses can give the angles; the gap is at 0°."""
    times = np.arange(0.0, 8 * 120 / SPEED, 1 / 97e3)
    turned = 6 * SPEED * times
    angles = turned + 0.03 * np.degrees(np.sin(np.radians(turned)))
    tooth = angles * teeth / 360 % teeth
    pulses = ((tooth % 1) > 0.5) & (tooth < teeth - missing)
    columns = (absolute(ENGINE, angles), 5.0 * pulses)
    keys = f", pulse_column: 2, pressure_column: 1, teeth: {teeth}"
    keys += f", missing_teeth: {missing}" if missing else ""
    zero = 360 - 180 / teeth
    if missing:
        keys += f", angle_zero: {zero - 0.0:.6f} deg"
    else:
        keys += f", angle_zero: {-180 / teeth:.6f} deg"
    case = Case(loads(machine_text(tmp_path, columns, keys, unit="")))
    true = indicated(FINE, absolute(ENGINE, FINE))
    p_i = case.cylinders[0]["mean_pressure"].value / 1e5
    assert p_i == pytest.approx(true, rel=0.01)


def test_teeth_that_do_not_fit(tmp_path: Path) -> None:
    angles = np.arange(0.0, 1440.0, 0.5)
    tooth = angles / 6 % 60
    pulses = ((tooth % 1) > 0.5) & (tooth < 58)
    columns = (absolute(ENGINE, angles), 5.0 * pulses)
    keys = ", pulse_column: 2, pressure_column: 1, teeth: 36, missing_teeth: 2"
    with pytest.raises(MachineFileError, match="58 teeth between two gaps, where a wheel of 36"):
        loads(machine_text(tmp_path, columns, keys, unit=""))
