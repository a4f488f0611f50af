"""Traces of compressors, pumps and steam engines: judged as what they are, and silent where they are right.

The pressures are those of ideal valves and of p V^n = const, made here from the geometry of the crank alone.
"""

import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from indicated import columns_file, fraction
from kurbel.errors import MachineFileError
from kurbel.machine_file import loads
from kurbel.notes.warnings import machine_notes
from kurbel.solver.case import Case

DEGREES = np.arange(-180.0, 180.0, 1.0)
"""After the dead centre at which the chamber is smallest."""


def compressor(
    clearance: float, ratio: float, exponent: float = 1.3, is_crank_end: bool = False
) -> Any:
    """Pressures in bar: suction at 1 bar, compression, delivery, and re-expansion of what is left."""
    displaced = 1 - fraction(DEGREES + 180) if is_crank_end else fraction(DEGREES)
    volume = displaced + clearance
    compressed = ((1 + clearance) / volume) ** exponent
    expanded = ratio * (clearance / volume) ** exponent
    growing = DEGREES >= 0
    return np.where(growing, np.maximum(expanded, 1.0), np.minimum(compressed, ratio))


def steam(admitted: float = 6.0, exhaust: float = 1.1) -> Any:
    """Admission from 12° before the dead centre to 80° after it, expansion, release at 155°, and compression."""
    volume = fraction(DEGREES) + 0.07
    cut_off = fraction(80.0) + 0.07
    expanded = admitted * cut_off / volume
    driven = np.where(DEGREES < 80, admitted, np.where(DEGREES < 155, expanded, exhaust))
    closed = fraction(-35.0) + 0.07
    cushioned = np.where(DEGREES < -35, exhaust, np.minimum(exhaust * closed / volume, admitted))
    cushioned = np.where(DEGREES > -12, admitted, cushioned)
    return np.where(DEGREES >= 0, driven, cushioned)


def pump() -> Any:
    return np.where((DEGREES >= 4) & (DEGREES < 180), 0.3, 90.0)


MACHINES = {
    "air compressor": (compressor(0.06, 8.0), "compressor", 0.06),
    "of high pressure": (98 * compressor(0.158, 2.2), "compressor", 0.158),
    "of 12 bar": (compressor(0.03, 12.0), "compressor", 0.03),
    "steam engine": (steam(), "steam", 0.07),
    "steam engine of 1.3 bar": (steam(1.3, 0.2), "steam", 0.07),
    "pump": (pump(), "pump", 0.5),
}


def machine_text(
    folder: Path,
    pressures: Any,
    keys: str = "",
    role: str = "",
    end: str = "head_end",
    degrees: Any = DEGREES,
    extra: str = "",
) -> str:
    columns_file(folder / "p.csv", np.column_stack((degrees, pressures)))
    lines = f"  role: {role}\n" if role else ""
    return (
        "cycle: two-stroke\nspeed: 600 rpm\nstroke: 200 mm\nrod_ratio: 4\nbore: 100 mm\n"
        f"crank_end_rod: 20 mm\nindicator:\n  pressures: absolute\n{lines}"
        f"  {end}: {{trace: {{file: '{folder / 'p.csv'}', unit: bar{keys}}}}}\n{extra}"
    )


def trace_notes(text: str) -> list[str]:
    notes = [note.text for note in machine_notes(Case(loads(text)))]
    return [note for note in notes if note.startswith("piston, ")]


@pytest.mark.parametrize("name", MACHINES)
@pytest.mark.parametrize("has_role", [True, False])
@pytest.mark.parametrize("has_clearance", [True, False])
def test_good_traces_of_other_machines_are_not_accused(
    tmp_path: Path, name: str, has_role: bool, has_clearance: bool
) -> None:
    pressures, role, clearance = MACHINES[name]
    keys = f", clearance: {clearance}" if has_clearance else ""
    assert trace_notes(machine_text(tmp_path, pressures, keys, role if has_role else "")) == []


@pytest.mark.parametrize("name", MACHINES)
@pytest.mark.parametrize("zero", [90.0, 180.0, -90.0])
def test_a_dead_centre_that_is_quarter_turns_off_is_found(
    tmp_path: Path, name: str, zero: float
) -> None:
    """The head end of each, with a wrong zero: the first thing to write is the right one."""
    pressures, role, clearance = MACHINES[name]
    keys = f", clearance: {clearance}, angle_zero: {zero:g} deg"
    notes = trace_notes(machine_text(tmp_path, pressures, keys, role))
    (shown,) = re.findall(r"'angle_zero: (-?[0-9.]+) deg'", notes[0])
    assert float(shown) % 360 == pytest.approx(0.0, abs=12.0) or float(shown) % 360 >= 348.0


@pytest.mark.parametrize("off", [20.0, -20.0])
def test_the_dead_centre_of_a_compressor_follows_from_its_lines(tmp_path: Path, off: float) -> None:
    keys = f", clearance: 0.06, angle_zero: {off:g} deg"
    (note,) = trace_notes(machine_text(tmp_path, compressor(0.06, 8.0), keys, "compressor"))
    (shown,) = re.findall(r"'angle_zero: (-?[0-9.]+) deg'", note)
    assert float(shown) == pytest.approx(0.0, abs=1.5)
    assert "±" in note


@pytest.mark.parametrize("clearance", [15.8, 0.0158])
def test_a_wrong_clearance_is_named_and_not_the_unit(tmp_path: Path, clearance: float) -> None:
    pressures = 98 * compressor(0.158, 2.2)
    text = machine_text(tmp_path, pressures, f", clearance: {clearance}", "compressor")
    note = trace_notes(text)[-1]
    assert "unit" not in note
    (shown,) = re.findall(r"'clearance: ([0-9.]+)'", note)
    assert float(shown) == pytest.approx(0.158, rel=0.1)


@pytest.mark.parametrize("name", ["air compressor", "steam engine"])
def test_an_angle_against_the_rotation_is_found_by_the_flanks(tmp_path: Path, name: str) -> None:
    pressures, role, clearance = MACHINES[name]
    turned = machine_text(
        tmp_path, pressures[::-1], f", clearance: {clearance}", role, degrees=-DEGREES[::-1]
    )
    assert "'angle_sense: against'" in trace_notes(turned)[0]
    assert trace_notes(turned.replace("unit: bar", "unit: bar, angle_sense: against")) == []


def test_the_trace_of_the_other_end(tmp_path: Path) -> None:
    """The trace of the head end, called that of the crank end."""
    text = machine_text(tmp_path, compressor(0.06, 8.0), ", clearance: 0.06", end="crank_end")
    (note,) = trace_notes(text)
    assert "or is it the trace of the head end?" in note


def test_figures_of_a_compressor(tmp_path: Path) -> None:
    """Exponents, efficiencies and losses in closed form, of both ends together too."""
    c, ratio, n = 0.06, 8.0, 1.3
    text = machine_text(
        tmp_path,
        compressor(c, ratio, n),
        f", clearance: {c}, suction_line: 1.1 bar, discharge_line: 7.5 bar",
        "compressor",
    )
    forces = Case(loads(text)).cylinders[0]
    assert forces["n_compression"].value == pytest.approx(n, abs=1e-6)
    assert forces["n_expansion"].value == pytest.approx(n, abs=1e-6)

    def compressed_to(p: float) -> float:
        return float((1 + c) * p ** (-1 / n) - c)

    def expanded_to(p: float) -> float:
        return float(c * (ratio / p) ** (1 / n) - c)

    suction = compressed_to(1.1) - expanded_to(1.1)
    discharge = compressed_to(7.5) - expanded_to(7.5)
    assert forces["suction_efficiency"].value == pytest.approx(suction, abs=2e-3)
    assert forces["discharge_efficiency"].value == pytest.approx(discharge, abs=2e-3)

    def work_between(p: float, z: float, next_z: float, start: float, volume: float) -> float:
        """∫ (pressure of the line p V^n − p) dz, by its antiderivative."""
        constant = start * volume**n
        ends = [(end + c) ** (1 - n) / (1 - n) for end in (z, next_z)]
        return float(constant * (ends[1] - ends[0]) - p * (next_z - z))

    # suction: 1 bar below 1.1 bar, less the corners where the lines are between both
    opened = expanded_to(1.0)
    corner = work_between(1.1, expanded_to(1.1), opened, ratio, c)
    last = work_between(1.1, 1.0, compressed_to(1.1), 1.0, 1 + c)
    expected = 0.1 * (1.0 - opened) - corner - last
    assert forces["suction_loss"].value == pytest.approx(expected * 1e5, rel=0.02)

    # the other end of the same cylinder, from the same encoder
    outer = compressor(c, ratio, n, is_crank_end=True)
    columns_file(tmp_path / "outer.csv", np.column_stack((DEGREES, outer)))
    trace = text[text.index("{trace: ") : text.rindex("}") + 1]
    other = trace.replace("p.csv", "outer.csv").replace(
        "unit: bar", "unit: bar, angle_zero: 180 deg"
    )
    case = Case(loads(f"{text.rstrip()}\n  crank_end: {other}\n"))
    assert case.cylinders[0]["n_compression"].value == pytest.approx(n, abs=1e-6)
    assert case.cylinders[0]["n_compression_crank"].value == pytest.approx(n, abs=1e-6)
    assert case.cylinders[0]["suction_efficiency"].value == pytest.approx(suction, abs=5e-3)


def test_a_lost_sample_is_named_by_its_line(tmp_path: Path) -> None:
    pressures = compressor(0.06, 8.0).copy()
    pressures[36] = 9999
    with pytest.raises(MachineFileError, match=r"line 37: the pressure 9999 bar is no sample"):
        loads(machine_text(tmp_path, pressures))


def test_the_other_end_with_another_clearance(tmp_path: Path) -> None:
    """Its lines, with the clearance of the other end, show another dead centre than half a turn; the flanks do not."""
    pressures = 19.6 * np.roll(compressor(0.184, 1.9, 1.3, is_crank_end=True), 180)
    (note,) = trace_notes(machine_text(tmp_path, pressures, ", clearance: 0.25"))
    assert re.search(r"'angle_zero: -?180 deg', or is it the trace of the crank end\?", note)


def test_rows_numbered_as_angles(tmp_path: Path) -> None:
    """1024 samples of one cycle, 0 to 1023 for their angles: neither turns nor a four-stroke cycle."""
    fine = np.arange(1024) * 360 / 1024
    pressures = np.interp(fine, DEGREES + 180, compressor(0.158, 1.9, 1.4), period=360)
    rows = np.arange(1024.0)
    with pytest.raises(MachineFileError, match="if it numbers samples"):
        loads(machine_text(tmp_path, pressures, degrees=rows))
    with pytest.raises(MachineFileError, match="do these number the samples"):
        loads(machine_text(tmp_path, pressures[::10], degrees=rows[:103]))


def test_turns_at_each_degree_are_no_row_numbers(tmp_path: Path) -> None:
    """Two turns and a half at 0, 1, … deg that repeat are a recording."""
    pressures = np.tile(compressor(0.06, 8.0), 3)[:900]
    loads(machine_text(tmp_path, pressures, degrees=np.arange(900.0)))
