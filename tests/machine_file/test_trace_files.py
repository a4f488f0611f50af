"""Files of traces as loggers and people write them: read as they are meant, or refused with a way out that works."""

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
from kurbel.notes.warnings import machine_notes
from kurbel.solver.case import Case
from kurbel.traces.correct import Trace
from representative import few

ENGINE = Engine()
ANGLES = np.arange(0.0, 720.0, 2.0)
PRESSURES = np.round(absolute(ENGINE, ANGLES), 3)


def machine(
    folder: Path,
    content: str | bytes,
    keys: str = "",
    unit: str = "bar",
    cycle: str = "four-stroke",
) -> Machine:
    (folder / "p.csv").write_bytes(content if isinstance(content, bytes) else content.encode())
    (folder / "m.yaml").write_text(
        f"cycle: {cycle}\nspeed: 1500 rpm\nstroke: 100 mm\nrod_ratio: 4\nbore: 90 mm\n"
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


def rows(
    angles: Any = ANGLES, pressures: Any = PRESSURES, between: str = ",", form: str = "%s"
) -> str:
    return "".join(
        f"{form % f'{a:.10g}'}{between}{form % f'{p:.6g}'}\n" for a, p in zip(angles, pressures)
    )


def commas(text: str) -> str:
    return text.replace(".", ",")


TURN = np.mod(ANGLES, 360.0)
BARE = "".join(f"{p:.3f}\n" for p in PRESSURES)
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
    "no angles": (BARE, ", angle_step: 2 deg, pressure_column: 1"),
    "volts": (rows(pressures=(PRESSURES - 1) / 20), ", scale: 20, offset: 1 bar"),
    "kilopascals": (rows(pressures=PRESSURES * 100), ", scale: 0.01"),
    "against the rotation": (
        rows((-ANGLES[::-1]) % 720, PRESSURES[::-1]),
        ", angle_sense: against",
    ),
    "falling angles": (rows(720 - ANGLES), ", angle_sense: against"),
    "line feeds of old Macs": (rows().replace("\n", "\r"), ""),
    "line feeds of DOS": (rows().replace("\n", "\r\n"), ""),
    "tabs": (rows(between="\t"), ", delimiter: tab"),
    "blanks": (rows(between="   "), ", delimiter: space"),
    "semicolons by their sign": (rows(between=";"), ', delimiter: ";"'),
    "other columns": (rows(form="9,%s"), ", angle_column: 2, pressure_column: 4"),
    "a heading in Latin-1": (
        "Kurbelwinkel [°]\n".encode("latin-1") + rows().encode(),
        ", skip_rows: 1",
    ),
    "a heading of figures": ("1500,12.5\n" + rows(), ", skip_rows: 1"),
    "comments and empty lines": ("# bar\n\n" + rows().replace("\n20,", "\n\n20,") + "# end\n", ""),
    "samples given twice": (
        rows().replace("\n20,", "\n18,36.789\n20,").replace("36.789", f"{PRESSURES[9]:.6g}"),
        "",
    ),
}


@pytest.mark.parametrize("form", FORMS)
def test_forms_of_files(tmp_path: Path, form: str) -> None:
    meant(machine(tmp_path, *FORMS[form]))


@pytest.mark.parametrize(("begin", "zero"), [(-180.0, "0"), (100.0, "720")])
def test_turns_that_begin_within_one(tmp_path: Path, begin: float, zero: str) -> None:
    """Angles modulo 360 that do not begin at the firing dead centre."""
    turned = np.roll(np.arange(360), int(-begin / 2))
    angles = (ANGLES[turned] - begin) % 360 + begin if begin < 0 else TURN[turned]
    trace = trace_of(
        machine(tmp_path, rows(angles, PRESSURES[turned]), f", angle_zero: {zero} deg")
    )
    assert np.sort(trace.pressures[:-1] / 1e5) == pytest.approx(np.sort(PRESSURES))
    peak = float(trace.angles[int(np.argmax(trace.pressures))])
    assert (peak - float(ANGLES[int(np.argmax(PRESSURES))])) % 360 == pytest.approx(0.0, abs=1e-9)


HEADED = [
    ("Crank_Angle [deg] Cylinder_Pressure [bar]\n" + rows(between=" "), ""),
    ("Crank_Angle [deg],Cylinder Pressure [bar]\n" + rows(), ""),
    ("run 7; 1500 rpm\n\nKurbelwinkel [°];Druck [bar]\n" + commas(rows(between=";")), ""),
    ("run 7, 12 kW\nCrank_Angle [deg]\tp_cyl [bar]\n" + rows(between="\t"), ""),
    (("a\tb\n" + commas(rows(between="\t"))).encode("utf-16"), ""),
    ('"CA","p"\n' + rows(form='"%s"').replace(".", ","), ""),
    ("p [bar]\n" + BARE, ", angle_step: 2 deg"),
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


@pytest.mark.parametrize(
    ("content", "advice", "keys"),
    [
        (
            rows(np.radians(ANGLES)),
            "are these radians? Then write 'angle_unit: rad'",
            ", angle_unit: rad",
        ),
        (
            rows(ANGLES / 9000),
            "are these times? Then write 'angle_unit: s'",
            ", angle_unit: s, recorded_speed: 1500 rpm",
        ),
        (
            rows(10 * np.arange(360)),
            "turns that are not alike; if it numbers samples, write how far apart they are, such as 'angle_step: 2",
            ", angle_step: 2 deg",
        ),
        (rows(720 - ANGLES), "the rows run backward; put", ", angle_sense: against"),
        (
            "1500,12.5\n" + rows(),
            "line 2: the angle begins anew after 1500 deg; a turn has 360",
            ", skip_rows: 1",
        ),
    ],
)
def test_what_counts_no_degrees(tmp_path: Path, content: str, advice: str, keys: str) -> None:
    with pytest.raises(MachineFileError, match=re.escape(advice)):
        machine(tmp_path, content)
    meant(machine(tmp_path, content, keys))


GOOD = [f"{angle},{1 + angle / 100}" for angle in range(0, 361, 10)]


def broken(line: int, text: str) -> str:
    return "\n".join([*GOOD[: line - 1], text, *GOOD[line:]]) + "\n"


def holed(begin: float, end: float, step: float, last: float = 360.0) -> str:
    angles = [
        angle for angle in np.arange(0, last + step / 2, step).tolist() if not begin < angle < end
    ]
    return rows(angles, [2 + (angle > 180) for angle in angles])


PLAIN = "figures are plain numbers, such as 1013.25 or 1.01325e3, without signs between thousands: export them so"
FIVE_TIMES = np.tile(ANGLES, 5), np.tile(PRESSURES, 5)
BUT_ONE = np.delete(np.arange(1800), np.arange(3 * 360 + 100, 3 * 360 + 130))
REFUSED: list[tuple[str | bytes, str, str]] = [
    # what is no number
    (broken(5, "40,nan"), "", "line 5: the pressure is nan, not a number; leave such rows out"),
    (broken(5, "inf,3"), "", "line 5: the angle is inf, not a number"),
    (broken(5, "40,1e400"), "", "line 5: the pressure is inf"),
    ("0,1\n100,1e300\n720,1\n", ", scale: 1e15", "line 2: the pressure is inf"),
    (broken(6, "50,x3"), "", "line 6: column 2 holds no number"),
    (broken(6, "50"), "", "line 6 has no column 2: 50"),
    (broken(6, "50;3"), "", "line 6 has no column 2: 50;3; leave such lines out"),
    (
        broken(1, "angle,bar"),
        "",
        "line 1: column 1 holds no number; write 'skip_rows: 1' if it is a heading",
    ),
    ("0;1,5\n180;2\n360;1\n", "", "line 1: '0;1' is no number; write 'delimiter: semicolon'"),
    (
        "0;1,5\n180;2,5\n360;1,5\n",
        ", delimiter: semicolon",
        "line 1: '1,5' is no number; write 'decimal: comma'",
    ),
    (
        "".join(f"{a};2\n" for a in range(720)) + "720;1,5\n",
        ", delimiter: semicolon",
        "line 721: '1,5' is no number; write 'decimal: comma'",
    ),
    ("", "", "p.csv has no figures"),
    ("# nothing\n\n", "", "p.csv has no figures"),
    *(
        (
            broken.join(
                ["# a form feed \x0c, and a separator \x1c \u2028", "0,1", "90,x", "360,1"]
            ),
            "",
            "line 3: column 2",
        )
        for broken in ("\r", "\r\n", "\n")
    ),
    # no advice leads in a circle, or to what is set already
    (rows(ANGLES, form="12:00:%s"), "", f"line 1: '12:00:0' is no number; {PLAIN}"),
    (
        "".join(f"{a:.10g};{p * 1000:,.1f}\n" for a, p in zip(ANGLES, PRESSURES)),
        ", delimiter: semicolon",
        f"is no number; {PLAIN}",
    ),
    (
        "".join(
            f"{a:g};{p * 1000:,.2f}\n".translate(str.maketrans(".,", ",."))
            for a, p in zip(ANGLES, PRESSURES)
        ),
        ", delimiter: semicolon, decimal: comma",
        "line 1: '37.661,00' is no number",
    ),
    (rows(form="%s u"), "", f"line 1: column 1 holds no number; {PLAIN}"),
    (rows(form="%sD0"), "", f"line 1: column 1 holds no number; {PLAIN}"),
    (
        "cycle: four-stroke\nspeed: 1500 rpm\n",
        "",
        "line 1 has no column 2; is it a file of figures?",
    ),
    ("0,x\n", "", "line 1: column 2 holds no number; is it a file of figures?"),
    (
        "0 1\n1\n",
        ", delimiter: space",
        "line 2 has no column 2: 1; leave such lines out, or correct them",
    ),
    (rows(), ", pressure_columns: 2-61", "line 1 has no column 61: 0,37.661; it has 2 only"),
    (BARE, "", "if it has no angles, write 'pressure_column: 1' and 'angle_step: 0.5 deg', say"),
    (rows() + "\nEnd\n", "", "line 362 has no column 2; leave such lines out, or correct them"),
    (
        rows().replace("\n20,", "\n20,#"),
        "",
        "holds no number; leave such lines out, or correct them",
    ),
    (
        "".join(f"{a:g},{p:.2f}\n".replace(".", ",") for a, p in zip(ANGLES, PRESSURES)),
        "",
        "has a decimal comma",
    ),
    # what is no text
    (b"\xff\xfe0\x00,\x001\x00", "", "line 1"),
    (
        b"PK\x03\x04[Content_Types].xml",
        "",
        "p.csv is an Excel or other workbook, or a zip archive, no text; export its table",
    ),
    (b"TDSm\x0e\x00\x00\x00", "", "a TDMS file of LabVIEW, no text; export its table"),
    (b"\x1f\x8b\x08\x00", "", "compressed by gzip, no text; export its table"),
    (
        b"0,1\n\x00\x01\x02 and so on, to the end of the head of the file, which has text",
        "",
        "has zero bytes",
    ),
    # what is no whole cycle, and in which line
    (broken(6, "20,3"), "", "line 6: 20 deg after 40 deg; put the points in order of the angle"),
    ("0,1\n", "", "line 1: a trace needs samples at two angles or more"),
    ("0,1\n0,2\n", "", "line 1: a trace needs samples at two angles or more"),
    ("0,1\n90,2\n90,3\n90,4\n360,1", "", "line 4: three points at 90 deg; a jump has two"),
    (
        "".join(f"{a},2\n" for a in [*range(180, 360, 5), 0, 5, 5, 5, *range(10, 180, 5)]),
        "",
        "line 40: three points at 5 deg",
    ),
    (
        "\n".join(GOOD[:25]),
        "",
        "line 25: no samples from 240 to 360 deg; a trace covers a whole cycle of 360 or 720 deg",
    ),
    ("0,1\n720,2\n1440,1\n", "", "line 3: the samples run over 1440 deg; cut whole cycles out"),
    *((holed(100, 126, step), "", "no samples from 100 to 126 deg") for step in (0.5, 2)),
    *((holed(10, 330, step), "", "no samples from 10 to 330 deg") for step in (0.5, 2)),
    (holed(100, 118, 1, last=343), "", "no samples from 343 to 360 deg"),
    (
        rows(*(five_time[BUT_ONE] for five_time in FIVE_TIMES)),
        "",
        "line 1180: no samples from 2358 to 2420 deg",
    ),
    (
        "\n".join(GOOD),
        "",
        "the trace covers 360 deg, a four-stroke cycle has 720 deg; write 'cycle: two-stroke'",
    ),
    # keys that contradict or lack one another
    (
        rows(),
        ", angle_unit: s",
        "times become angles by a speed, and the pressure has no clear period; write 'recorded_speed: 1500 rpm', say",
    ),
    (rows(), ", angle_unit: rad, recorded_speed: 1500 rpm", "write 'angle_unit: s'"),
    (
        rows(),
        ", angle_unit: s, recorded_speed: 1 rpm",
        "are 'recorded_speed' and 'angle_unit' (s or ms) right?",
    ),
    (rows(), ", scale: 0", "0 leaves no pressure"),
    (rows(), ", pressure_columns: 61-2", "runs backward or names a column twice"),
    (rows(), ", pressure_columns: 1-3", "column 1 is that of the angles"),
    (rows(), ", pressure_columns: 2-4", "line 1 has no column 4"),
    (rows(), ", pressure_columns: [2, 3]", "or in quotation marks '2, 5, 7-9', got a list"),
    (rows(), ", pressure_columns: two", "or in quotation marks '2, 5, 7-9', got 'two'"),
    (rows(), ", pressure_column: 2, pressure_columns: 2-4", "mean the same"),
    (rows(), ", angle_column: 1, angle_step: 2 deg", "mean the same"),
    (rows(), ", clearance: 0.1, compression_ratio: 11", "mean the same"),
    (rows(), ", pegging: {angle: 5 deg}", "'pressure' is missing"),
    (rows(), ", angle_zero: {motored: p.csv}", "'loss_angle' is missing"),
    (rows(), ", decimal: comma", "a comma cannot be both in numbers and between columns"),
    (
        "0,1\n720,1\n",
        ", angle_zero: {motored: p.csv, loss_angle: 0.5 deg}",
        "has fewer than five samples within 3 deg",
    ),
]


@pytest.mark.parametrize(("content", "keys", "said"), REFUSED)
def test_what_cannot_be_a_trace_is_named_with_its_line(
    tmp_path: Path, content: str | bytes, keys: str, said: str
) -> None:
    with pytest.raises(MachineFileError) as caught:
        machine(tmp_path, content, keys)
    (fault,) = caught.value.faults
    assert said in fault.message
    assert ("skip_rows" in fault.message) == ("skip_rows" in said)
    if not keys and "cycle:" not in said:
        assert fault.path == ("indicator", "head_end", "trace", "file")
        assert (fault.line, fault.source_line[fault.column - 1 :][:5]) == (6, "p.csv")


@pytest.mark.parametrize(
    ("content", "keys", "notes"),
    [
        ("\n".join(GOOD[:-1]), "", []),  # the closing sample is missing, as loggers write them
        (holed(100, 120, 0.1), "", ["no samples from 100 to 120 deg; a straight line joins them"]),
        (
            rows(np.r_[0:60:0.1, 60:361], np.full(901, 2.0)),
            "",
            [],
        ),  # a denser stretch leaves no holes elsewhere
        ("0,1\n120,2\n120,2\n360,1\n", "", ["1 sample given twice counts once"]),
        (
            "".join(f"{a},{1 + a / 100}\n" for a in [*range(180, 360, 5), *range(0, 180, 5)]),
            "",
            ["the angle begins anew at 0 deg; the samples from there on come first"],
        ),
    ],
)
def test_what_was_tidied_up_is_noted(
    tmp_path: Path, content: str, keys: str, notes: list[str]
) -> None:
    trace = trace_of(machine(tmp_path, content, keys, cycle="two-stroke"))
    assert len(trace.notes) == len(notes)
    assert all(said in note for said, note in zip(notes, trace.notes))
    assert trace.pressures[0] == trace.pressures[-1] or not trace.completed


def test_whole_degrees_and_decimal_commas_below_a_heading(tmp_path: Path) -> None:
    """'0,37,66' is 0 deg and 37.66 bar, or three columns: refused, or doubted, with both readings."""
    lines = "".join(
        f"{angle:g},{pressure:.2f}\n".replace(".", ",")
        for angle, pressure in zip(ANGLES, PRESSURES)
    )
    try:
        one = machine(tmp_path, "Winkel,Druck\n" + lines, ", skip_rows: 1")
        said = "\n".join(note.text for note in machine_notes(Case(one)))
    except MachineFileError as error:
        said = str(error)
    assert "decimal comma" in said
    assert "delimiter" in said


def test_points_and_efforts_are_judged_in_the_same_way(tmp_path: Path) -> None:
    (tmp_path / "m.yaml").write_text(
        "crank: 200 mm\nrod: 900 mm\nbore: 300 mm\nspeed: 60 rpm\n"
        "indicator: {head_end: {trace: {unit: bar, points: [[0, 1], [100, 2], [90, 1], [360, 1]]}}}\n"
    )
    with pytest.raises(MachineFileError, match=r"trace.points\[2\]: 90 deg after 100 deg"):
        load(tmp_path / "m.yaml")
    (tmp_path / "e.csv").write_text(rows(np.arange(0, 360, 2), np.ones(180)))
    for keys, said in (
        ("torque_column: 1", "column 1 is that of the angles"),
        ("angle_unit: s", "times become angles by a speed"),
        ("angle_unit: rad, recorded_speed: 60 rpm", "a speed is for times only"),
    ):
        (tmp_path / "m.yaml").write_text(f"effort: {{unit: N m, file: e.csv, {keys}}}\n")
        with pytest.raises(MachineFileError, match=said):
            load(tmp_path / "m.yaml")


def test_an_effort_over_three_turns_is_the_same_as_a_file_and_as_points(tmp_path: Path) -> None:
    angles = np.arange(0.0, 1081.0, 4.0)
    torques = np.where(angles < 360, 300.0, 0.0) + angles / 100
    (tmp_path / "e.csv").write_text(rows(angles, torques))
    points = ", ".join(
        f"[{angle:g}, {torque!r}]" for angle, torque in zip(angles, torques.tolist())
    )
    texts = ("file: e.csv", f"points: [{points}]")
    efforts = []
    for keys in texts:
        (tmp_path / "m.yaml").write_text(f"cycle_turns: 3\neffort: {{unit: N m, {keys}}}\n")
        efforts.append(Case(load(tmp_path / "m.yaml")).flywheel)
    assert efforts[0].dE == efforts[1].dE
    assert efforts[0].M_mean == efforts[1].M_mean
    (tmp_path / "m.yaml").write_text("effort: {unit: N m, file: e.csv}\n")
    with pytest.raises(MachineFileError, match=r"runs to 1080 deg.*write 'cycle_turns: 3'"):
        load(tmp_path / "m.yaml")
    (tmp_path / "e.csv").write_text(rows(angles[:-20], torques[:-20]))
    with pytest.raises(
        MachineFileError, match="no samples from 1000 to 1080 deg; a diagram covers whole turns"
    ):
        load(tmp_path / "m.yaml")


@pytest.mark.parametrize("counts_on", [False, True])
def test_laps_of_uneven_rows_keep_their_own_corners(tmp_path: Path, counts_on: bool) -> None:
    """The area below a lap is that of the trapezoids between its own samples, at whatever angles they are."""
    generator = np.random.default_rng(3)
    laps, areas = [], []
    for lap in range(5):
        regular = np.linspace(8, 352, 40 + lap)
        angles = np.concatenate(([0.0], regular + generator.uniform(-3, 3, len(regular)), [359.5]))
        pressures = (
            5 + 4 * np.cos(np.radians(angles)) + generator.uniform(0, 1, len(angles)) * (angles > 0)
        )
        laps.append((angles, pressures))
        ends = np.append(angles, 360.0), np.append(pressures, 9.0)
        areas.append(np.sum(np.diff(ends[0]) * (ends[1][1:] + ends[1][:-1]) / 2))
    angles = np.concatenate(
        [angles + 360 * lap * counts_on for lap, (angles, _) in enumerate(laps)]
    )
    content = rows(angles, np.concatenate([pressures for _, pressures in laps]))
    trace = trace_of(machine(tmp_path, content, "", cycle="two-stroke"))
    widths, samples = np.diff(trace.angles), trace.samples / 1e5
    measured = (widths * (samples[:, 1:] + samples[:, :-1]) / 2).sum(axis=1)
    np.testing.assert_allclose(measured, areas, rtol=2e-7)


def test_a_pipe_is_no_file_of_samples(tmp_path: Path) -> None:
    """Opening one would wait for ever."""
    machine(tmp_path, rows())
    (tmp_path / "p.csv").unlink()
    os.mkfifo(tmp_path / "p.csv")
    with pytest.raises(MachineFileError, match="is a device or a pipe"):
        load(tmp_path / "m.yaml")


def _all_limits_in(text: str) -> bool:
    """Whether the three limits of size stand in a text, with or without signs between thousands."""
    plain = re.sub(r"(?<=[0-9])[ ,_\u202f](?=[0-9]{3})", "", text)
    return (
        "64 MiB" in plain
        and bool(re.search(r"5000000|5 million|5·10⁶", plain))
        and "500000" in plain
    )


@pytest.mark.parametrize("large", few(["bytes", "samples"], ["bytes"]))
def test_all_limits_of_size_are_reported_at_once(tmp_path: Path, large: str) -> None:
    (tmp_path / "p.csv").write_text(
        "".join(f"{i},1\n" for i in range(500_001)) if large == "samples" else "0,1\n"
    )
    if large == "bytes":
        os.truncate(tmp_path / "p.csv", 64 * 2**20 + 1)
    (tmp_path / "m.yaml").write_text(
        "cycle: four-stroke\nstroke: 100 mm\nrod_ratio: 4\nbore: 90 mm\n"
        f"indicator: {{head_end: {{trace: {{file: p.csv, unit: bar, angle_step: {720 / 500_001!r} deg}}}}}}\n"
    )
    with pytest.raises(MachineFileError) as caught:
        load(tmp_path / "m.yaml")
    assert _all_limits_in(str(caught.value))
    page = Path(__file__).parents[2] / "docs" / "size.md"
    assert _all_limits_in(page.read_text(encoding="utf-8"))
