"""Files of traces as loggers and people write them: read as they are meant, or refused with a way out that works."""

from __future__ import annotations

import os
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from indicated import Engine, absolute
from kurbel.errors import MachineFileError
from kurbel.machine import Machine
from kurbel.machine_file import load
from kurbel.report.warnings import machine_notes
from kurbel.solver.case import Case
from kurbel.traces.correct import Trace
from representative import few

ENGINE = Engine()
ANGLES = np.arange(0.0, 720.0, 2.0)
PRESSURES = np.round(absolute(ENGINE, ANGLES), 3)


def machine(folder: Path, content: str | bytes, keys: str = "", unit: str = "bar") -> Machine:
    (folder / "p.csv").write_bytes(content if isinstance(content, bytes) else content.encode())
    (folder / "m.yaml").write_text(
        "cycle: four-stroke\nspeed: 1500 rpm\nstroke: 100 mm\nrod_ratio: 4\nbore: 90 mm\n"
        f"indicator: {{pressures: absolute, head_end: {{trace: {{file: p.csv, unit: {unit}{keys}}}}}}}\n"
    )
    return load(folder / "m.yaml")


def trace_of(one: Machine) -> Trace:
    indicator = one.cylinders[0].pistons[0].indicator
    assert indicator is not None
    assert isinstance(indicator.head_end, Trace)
    return indicator.head_end.over(720.0 if one.cycle == "four-stroke" else 360.0)


def meant(one: Machine) -> None:
    """Hold a machine against the trace that every file here holds, whatever its angles begin with."""
    trace = trace_of(one)
    turned = np.mod(trace.angles[:-1] - trace.angle_zero, 720.0)
    order = np.argsort(turned)
    assert turned[order] == pytest.approx(ANGLES, abs=1e-6)
    assert trace.pressures[:-1][order] / 1e5 == pytest.approx(PRESSURES, rel=1e-12)


def rows(angles: Any = ANGLES, pressures: Any = PRESSURES, between: str = ",", form: str = "%s") -> str:
    return "".join(f"{form % f'{a:.10g}'}{between}{form % f'{p:.6g}'}\n" for a, p in zip(angles, pressures))


def commas(text: str) -> str:
    return text.replace(".", ",")


TURN = np.mod(ANGLES, 360.0)
FORMS: dict[str, tuple[str | bytes, str]] = {
    "plain": (rows(), ""),
    "UTF-16": (rows().encode("utf-16"), ""),
    "UTF-16 without a mark": (rows().encode("utf-16-le"), ""),
    "UTF-16, big end first": (b"\xfe\xff" + rows().encode("utf-16-be"), ""),
    "byte order mark": ("\ufeff" + rows(), ""),
    "decimal commas": (commas(rows(between=";")), ", delimiter: semicolon, decimal: comma"),
    "quoted decimal commas": (
        rows(form='"%s"').replace(".", ",").replace('""', '"'),
        ", decimal: comma",
    ),
    "quoted numbers": (rows(form='"%s"'), ""),
    "modulo 360": (rows(TURN), ""),
    "-360 to 360": (rows(np.roll((ANGLES + 360) % 720 - 360, 180), np.roll(PRESSURES, 180)), ""),
    "radians": (rows(np.radians(ANGLES)), ", angle_unit: rad"),
    "seconds": (rows(ANGLES / 9000), ", angle_unit: s, recorded_speed: 1500 rpm"),
    "milliseconds": (rows(ANGLES / 9), ", angle_unit: ms, recorded_speed: 1500 rpm"),
    "sample numbers": (rows(np.arange(360)), ", angle_step: 2 deg"),
    "no angles": ("".join(f"{p:.3f}\n" for p in PRESSURES), ", angle_step: 2 deg, pressure_column: 1"),
    "volts": (rows(pressures=(PRESSURES - 1) / 20), ", scale: 20, offset: 1 bar"),
    "against the rotation": (rows((-ANGLES[::-1]) % 720, PRESSURES[::-1]), ", angle_sense: against"),
    "falling angles": (rows(720 - ANGLES), ", angle_sense: against"),
    "line feeds of old Macs": (rows().replace("\n", "\r"), ""),
    "line feeds of DOS": (rows().replace("\n", "\r\n"), ""),
    "tabs": (rows(between="\t"), ", delimiter: tab"),
    "blanks": (rows(between="   "), ", delimiter: space"),
    "semicolons by their sign": (rows(between=";"), ', delimiter: ";"'),
    "other columns": (rows(form="9,%s"), ", angle_column: 2, pressure_column: 4"),
    "a heading in Latin-1": ("Kurbelwinkel [°]\n".encode("latin-1") + rows().encode(), ", skip_rows: 1"),
    "comments and empty lines": ("# bar\n\n" + rows().replace("\n20,", "\n\n20,") + "# end\n", ""),
}


@pytest.mark.parametrize("form", FORMS)
def test_forms_of_files(tmp_path: Path, form: str) -> None:
    meant(machine(tmp_path, *FORMS[form]))


@pytest.mark.parametrize(("begin", "zero"), [(-180.0, "0"), (100.0, "720")])
def test_turns_that_begin_within_one(tmp_path: Path, begin: float, zero: str) -> None:
    """Angles modulo 360 that do not begin at the firing dead centre."""
    turned = np.roll(np.arange(360), int(-begin / 2))
    angles = (ANGLES[turned] - begin) % 360 + begin if begin < 0 else TURN[turned]
    trace = trace_of(machine(tmp_path, rows(angles, PRESSURES[turned]), f", angle_zero: {zero} deg"))
    assert np.sort(trace.pressures[:-1] / 1e5) == pytest.approx(np.sort(PRESSURES))
    peak = float(trace.angles[int(np.argmax(trace.pressures))])
    assert (peak - float(ANGLES[int(np.argmax(PRESSURES))])) % 360 == pytest.approx(0.0, abs=1e-9)


def test_a_heading_of_figures(tmp_path: Path) -> None:
    """Speed and power above the figures are no sample at 1500 deg."""
    with pytest.raises(MachineFileError, match=r"line 2: the angle begins anew.* a heading\?"):
        machine(tmp_path, "1500,12.5\n" + rows())
    meant(machine(tmp_path, "1500,12.5\n" + rows(), ", skip_rows: 1"))


def test_gauge_kilopascals(tmp_path: Path) -> None:
    one = machine(tmp_path, rows(pressures=PRESSURES * 100), unit="kPa")
    assert trace_of(one).pressures[:-1] == pytest.approx(PRESSURES * 1e5)


HEADED = [
    ("Crank_Angle [deg] Cylinder_Pressure [bar]\n" + rows(between=" "), ""),
    ("Crank_Angle [deg],Cylinder Pressure [bar]\n" + rows(), ""),
    ("run 7; 1500 rpm\n\nKurbelwinkel [°];Druck [bar]\n" + commas(rows(between=";")), ""),
    ("run 7, 12 kW\nCrank_Angle [deg]\tp_cyl [bar]\n" + rows(between="\t"), ""),
    (("a\tb\n" + commas(rows(between="\t"))).encode("utf-16"), ""),
    ('"CA","p"\n' + rows(form='"%s"').replace(".", ","), ""),
    ("p [bar]\n" + "".join(f"{p:.3f}\n" for p in PRESSURES), ", angle_step: 2 deg"),
]


@pytest.mark.parametrize(("content", "keys"), HEADED)
def test_the_advice_reads_the_file(tmp_path: Path, content: str | bytes, keys: str) -> None:
    """Whatever is refused at first: what the message says to write is all that is missing."""
    with pytest.raises(MachineFileError) as caught:
        machine(tmp_path, content, keys)
    message = caught.value.faults[0].message
    advice = re.findall(r"'([a-z_]+: [a-z0-9]+)'", message.partition("; write")[2])
    assert advice, message
    meant(machine(tmp_path, content, "".join(f", {one}" for one in advice) + keys))


PLAIN = "figures are plain numbers, such as 1013.25 or 1.01325e3: export them so"
UNREADABLE: dict[str, tuple[str, str, str]] = {
    "times of day": (rows(ANGLES, form="12:00:%s"), "", f"line 1: '12:00:0' is no number; {PLAIN}"),
    "thousands": (
        "".join(f"{a:.10g};{p * 1000:,.1f}\n" for a, p in zip(ANGLES, PRESSURES)),
        ", delimiter: semicolon",
        f"is no number; {PLAIN}",
    ),
    "units in cells": (rows(form="%s u"), "", f"line 1: column 1 holds no number; {PLAIN}"),
    "exponents of Fortran": (rows(form="%sD0"), "", f"line 1: column 1 holds no number; {PLAIN}"),
    "another file": ("cycle: four-stroke\nspeed: 1500 rpm\n", "", "line 1 has no column 2; is it a file of figures?"),
    "too few columns": (rows(), ", pressure_columns: 2-61", "line 1 has no column 61: 0,37.661; it has 2 only"),
    "no angles": (
        "".join(f"{p:.3f}\n" for p in PRESSURES),
        "",
        "if it has no angles, write 'pressure_column: 1' and 'angle_step: 0.5 deg', say",
    ),
    "a last line": (rows() + "\nEnd\n", "", "line 362 has no column 2; leave such lines out, or mend them"),
    "an empty cell": (rows().replace("\n20,", "\n20,#"), "", "holds no number; leave such lines out, or mend them"),
}


@pytest.mark.parametrize("name", UNREADABLE)
def test_no_advice_leads_in_a_circle(tmp_path: Path, name: str) -> None:
    """No heading is seen where the lines below are no better; what stands in the way is named instead."""
    content, keys, said = UNREADABLE[name]
    with pytest.raises(MachineFileError) as caught:
        machine(tmp_path, content, keys)
    assert said in caught.value.faults[0].message
    assert "skip_rows" not in caught.value.faults[0].message


@pytest.mark.parametrize(
    ("begin", "said"),
    [
        (
            b"PK\x03\x04[Content_Types].xml",
            "an Excel or other workbook, or a zip archive, no text",
        ),
        (b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1", "an old Excel workbook"),
        (b"TDSm\x0e\x00\x00\x00", "a TDMS file of LabVIEW, no text; export its channels as CSV"),
        (b"MDF     3.30", "an MDF file"),
        (b"\x89HDF\r\n\x1a\n", "an HDF5 file"),
        (b"\x1f\x8b\x08\x00", "compressed by gzip, no text; unpack it"),
        (b"0,1\n\x00\x01\x02 and so on, to the end of the head of the file, which has text", "has zero bytes"),
    ],
)
def test_what_is_no_text_is_named(tmp_path: Path, begin: bytes, said: str) -> None:
    with pytest.raises(MachineFileError, match=re.escape(said)):
        machine(tmp_path, begin)


@pytest.mark.parametrize(
    ("keys", "said"),
    [
        (", angle_unit: s", "times become angles by a speed; write 'recorded_speed: 1500 rpm', say"),
        (", angle_unit: rad, recorded_speed: 1500 rpm", "write 'angle_unit: s'"),
        (", scale: 0", "0 leaves no pressure"),
        (", pressure_columns: 61-2", "runs backward or names a column twice"),
        (", pressure_columns: 1-3", "column 1 is that of the angles"),
        (", pressure_columns: 2-4", "line 1 has no column 4"),
        (", pressure_columns: [2, 3]", "or in quotation marks '2, 5, 7-9', got a list"),
        (", angle_unit: s, recorded_speed: 1 rpm", "are 'recorded_speed' and 'angle_unit' (s or ms) right?"),
        (", pressure_column: 2, pressure_columns: 2-4", "say the same thing"),
        (
            ", pressure_columns: two",
            "or in quotation marks '2, 5, 7-9', got 'two'",
        ),
        (", angle_column: 1, angle_step: 2 deg", "say the same thing"),
        (", pegging: {angle: 5 deg}", "'pressure' is missing"),
        (", angle_zero: {motored: p.csv}", "'loss_angle' is missing"),
        (", clearance: 0.1, compression_ratio: 11", "say the same thing"),
        (", decimal: comma", "a comma cannot be both in numbers and between columns"),
    ],
)
def test_keys_that_contradict_or_lack_one_another(tmp_path: Path, keys: str, said: str) -> None:
    with pytest.raises(MachineFileError, match=re.escape(said)):
        machine(tmp_path, rows(), keys)


def test_a_hole_in_any_cycle_is_refused(tmp_path: Path) -> None:
    angles = np.tile(ANGLES, 5)
    kept = np.delete(np.arange(len(angles)), np.arange(3 * 360 + 100, 3 * 360 + 130))
    with pytest.raises(MachineFileError, match=r"line 1180: no samples from 2358 to 2420 deg"):
        machine(tmp_path, rows(angles[kept], np.tile(PRESSURES, 5)[kept]))


def test_falling_angles_are_told_to_run_backward(tmp_path: Path) -> None:
    with pytest.raises(MachineFileError, match=r"the rows run backward.*or write 'angle_sense: against'"):
        machine(tmp_path, rows(720 - ANGLES))


def test_effort_holds_one_cycle(tmp_path: Path) -> None:
    (tmp_path / "e.csv").write_text(rows(np.tile(np.arange(0, 360, 2), 3), np.ones(540)))
    (tmp_path / "m.yaml").write_text("effort: {unit: N m, file: e.csv}\n")
    with pytest.raises(MachineFileError, match="holds 3 laps of 360 deg; keep one cycle"):
        load(tmp_path / "m.yaml")


def test_sample_numbers_are_no_angles(tmp_path: Path) -> None:
    """Samples at every tenth of a degree, numbered: read as angles they would be ten cycles, none like the other."""
    fine = np.arange(0.0, 720.0, 0.1)
    content = rows(np.arange(7200), absolute(ENGINE, fine))
    with pytest.raises(MachineFileError, match=r"turns that are not alike; .* such as 'angle_step: 0.1 deg'"):
        machine(tmp_path, content)
    assert trace_of(machine(tmp_path, content, ", angle_step: 0.1 deg")).angles[:-1] == pytest.approx(fine)


@pytest.mark.parametrize(
    ("angles", "advice", "keys"),
    [
        (np.radians(ANGLES), "are these radians? Then write 'angle_unit: rad'", ", angle_unit: rad"),
        (ANGLES / 9000, "are these times? Then write 'angle_unit: s'", ", angle_unit: s, recorded_speed: 1500 rpm"),
    ],
)
def test_what_counts_no_degrees(tmp_path: Path, angles: Any, advice: str, keys: str) -> None:
    with pytest.raises(MachineFileError, match=re.escape(advice)):
        machine(tmp_path, rows(angles))
    meant(machine(tmp_path, rows(angles), keys))


def test_figures_beyond_all_numbers(tmp_path: Path) -> None:
    with pytest.raises(MachineFileError, match="line 2: the pressure is inf"):
        machine(tmp_path, "0,1\n100,1e300\n720,1\n", ", scale: 1e15")
    with pytest.raises(MachineFileError, match="motored: has fewer than five samples within 3 deg of its peak"):
        machine(tmp_path, "0,1\n720,1\n", ", angle_zero: {motored: p.csv, loss_angle: 0.5 deg}")


# what is read otherwise than it is meant, or said in part


@pytest.mark.parametrize(
    ("heading", "said"),
    [
        ("CA [deg],p [kPa]", "column 2 has another unit, kPa"),
        ("CA [deg],p (bar)", ""),
        ("angle,p [V]", ""),
        ("a,b", ""),
    ],
)
def test_the_unit_of_a_heading(tmp_path: Path, heading: str, said: str) -> None:
    notes = trace_of(machine(tmp_path, f"{heading}\n{rows()}", ", skip_rows: 1")).notes
    assert [said in note for note in notes] == ([True] if said else [])


def said_of(folder: Path, content: str, keys: str = "", unit: str = "bar") -> str:
    """The fault of a file, or else all notes on the machine that was read."""
    try:
        one = machine(folder, content, keys, unit)
    except MachineFileError as error:
        return str(error)
    return "\n".join(note.text for note in machine_notes(Case(one)))


@pytest.mark.parametrize("heading", ["", "Winkel,Druck\n"])
def test_whole_degrees_and_decimal_commas_between_comma_columns(tmp_path: Path, heading: str) -> None:
    """'0,37,66' is 0 deg and 37.66 bar, or three columns: refused, or doubted, with both readings."""
    lines = "".join(f"{angle:g},{pressure:.2f}\n".replace(".", ",") for angle, pressure in zip(ANGLES, PRESSURES))
    said = said_of(tmp_path, heading + lines, ", skip_rows: 1" if heading else "")
    assert "decimal comma" in said
    assert "delimiter" in said


def test_a_point_between_thousands_is_named_as_it_stands_in_the_file(tmp_path: Path) -> None:
    german = str.maketrans(".,", ",.")
    lines = "".join(f"{a:.10g};{f'{p * 1000:,.2f}'.translate(german)}\n" for a, p in zip(ANGLES, PRESSURES))
    said = said_of(tmp_path, lines, ", delimiter: semicolon, decimal: comma", "mbar")
    assert "'37.661,00'" in said
    assert "thousands" in said


def _all_limits_in(text: str) -> bool:
    """Whether the three limits of size stand in a text, with or without signs between thousands."""
    plain = re.sub(r"(?<=[0-9])[ ,_\u202f](?=[0-9]{3})", "", text)
    return "64 MiB" in plain and bool(re.search(r"5000000|5 million|5·10⁶", plain)) and "500000" in plain


def test_the_docs_have_the_limits_of_size() -> None:
    page = Path(__file__).parents[2] / "docs" / "traces.md"
    assert _all_limits_in(page.read_text(encoding="utf-8"))


@pytest.mark.parametrize("large", few(["bytes", "samples"], ["bytes"]))
def test_all_limits_of_size_are_reported_at_once(tmp_path: Path, large: str) -> None:
    (tmp_path / "p.csv").write_text("".join(f"{i},1\n" for i in range(500_001)) if large == "samples" else "0,1\n")
    if large == "bytes":
        os.truncate(tmp_path / "p.csv", 64 * 2**20 + 1)
    (tmp_path / "m.yaml").write_text(
        "cycle: four-stroke\nstroke: 100 mm\nrod_ratio: 4\nbore: 90 mm\n"
        f"indicator: {{head_end: {{trace: {{file: p.csv, unit: bar, angle_step: {720 / 500_001!r} deg}}}}}}\n"
    )
    with pytest.raises(MachineFileError) as caught:
        load(tmp_path / "m.yaml")
    assert _all_limits_in(str(caught.value))
