"""Sheets of Excel workbooks: read as files of columns are, with the same messages by row."""

import io
import re
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from indicated import Engine, absolute
from kurbel.errors import MachineFileError
from kurbel.machine_file import loads
from kurbel.solver.case import Case
from kurbel.traces import read

openpyxl = pytest.importorskip("openpyxl")

ANGLES = np.arange(0.0, 720.0, 2.0)
PRESSURES = absolute(Engine(), ANGLES)
ROWS: list[list[Any]] = [[float(a), float(p)] for a, p in zip(ANGLES, PRESSURES)]


def workbook(folder: Path, rows: Any = ROWS, sheet: str = "Data", more: Any = ()) -> Path:
    """Save rows in the first sheet of p.xlsx, and more sheets by their names."""
    book = openpyxl.Workbook()
    first = book.active
    first.title = sheet
    for row in rows:
        first.append(row)
    for title, cells in dict(more).items():
        other = book.create_sheet(title)
        for row in cells:
            other.append(row)
    book.save(folder / "p.xlsx")
    return folder / "p.xlsx"


def engine_text(file: Path, keys: str = "") -> str:
    return (
        "cycle: four-stroke\nspeed: 1500 rpm\nstroke: 100 mm\nrod_ratio: 4\nbore: 90 mm\n"
        f"indicator: {{pressures: absolute, head_end: {{trace: {{file: '{file}', unit: bar{keys}}}}}}}\n"
    )


def pressures_of(text: str) -> Any:
    chamber = loads(text).cylinders[0].pistons[0].chambers["head_end"]
    return chamber.pressures[:-1] / 1e5


HEADED = [["Motor 7", None], [None, None], ["Winkel [°]", "p [bar]"], *ROWS]
IN_COLUMN_B = [[None, None, *row] for row in ROWS]
COMMAS = [[f"{a:g}", f"{p!r}".replace(".", ",")] for a, p in ROWS]
ONE_CELL = [[f"{a:g};{p!r}"] for a, p in ROWS]


@pytest.mark.parametrize(
    ("rows", "keys"),
    [
        (ROWS, ""),
        (HEADED, ", skip_rows: 3"),
        (IN_COLUMN_B, ", angle_column: 3, pressure_column: 4"),
        (COMMAS, ", decimal: comma"),
        (ONE_CELL, ", delimiter: semicolon"),
        ([[p] for _, p in ROWS], ", angle_step: 2 deg, pressure_column: 1"),
    ],
    ids=[
        "plain",
        "headings",
        "columns C and D",
        "texts with commas",
        "one cell a row",
        "no angles",
    ],
)
def test_sheets_in_the_forms_of_files(tmp_path: Path, rows: Any, keys: str) -> None:
    text = engine_text(workbook(tmp_path, rows), keys)
    assert pressures_of(text) == pytest.approx(PRESSURES, rel=1e-15)


def test_the_sheet_by_its_name(tmp_path: Path) -> None:
    doubled = [[a, 2 * p] for a, p in ROWS]
    file = workbook(tmp_path, [["see the other sheet"]], "Read me", {"Run 7": doubled})
    assert pressures_of(engine_text(file, ", sheet: Run 7")) == pytest.approx(2 * PRESSURES)


def test_a_motored_run_in_another_sheet(tmp_path: Path) -> None:
    fine = np.arange(0.0, 720.0, 0.5)
    late = 3.0
    runs = [
        [[float(a), float(p)] for a, p in zip(fine, absolute(engine, fine - late))]
        for engine in (Engine(), Engine(heat=0.0))
    ]
    file = workbook(tmp_path, runs[0], "fired", {"motored": runs[1]})
    motored = f"{{motored: '{file}', sheet: motored, loss_angle: 0 deg}}"
    text = engine_text(file, f", angle_zero: {motored}")
    trace: Any = loads(text).cylinders[0].pistons[0].chambers["head_end"]
    assert trace.angle_zero == pytest.approx(late, abs=0.05)


def test_an_effort_in_a_workbook(tmp_path: Path) -> None:
    file = workbook(tmp_path, [[float(a), float(100 + a % 7)] for a in range(361)])
    points = ", ".join(f"[{a}, {100 + a % 7}]" for a in range(361))
    given = [f"file: '{file}'", f"points: [{points}]"]
    swings = [
        Case(loads(f"speed: 60 rpm\neffort: {{unit: N m, {keys}}}\n")).flywheel.dE for keys in given
    ]
    assert swings[0] == swings[1]


def with_row(number: int, row: list[Any]) -> list[list[Any]]:
    return [*ROWS[: number - 1], row, *ROWS[number:]]


@pytest.mark.parametrize(
    ("rows", "keys", "message"),
    [
        (HEADED, "", "row 1 has no column 2; write 'skip_rows: 3'"),
        (with_row(9, [16.0, None]), "", "row 9 has no column 2: 16; leave such rows out"),
        (with_row(9, [None, 3.0]), "", "row 9: column 1 holds no number; leave such rows out"),
        (with_row(9, [16.0, "#N/A"]), "", "row 9: column 2 holds no number"),
        (with_row(9, [5.0, 3.0]), "", "row 9: 5 deg after 14 deg"),
        (COMMAS, "", "row 1: '37,660920890729216' is no number; write 'decimal: comma'"),
        (ONE_CELL, "", "write 'delimiter: semicolon'"),
        ([], "", "p.xlsx has no figures"),
        (ROWS, ", sheet: Date", "p.xlsx has no sheet 'Date'; did you mean 'Data'?"),
        (ROWS, ", sheet: Run 7", "p.xlsx has no sheet 'Run 7'; its sheets are 'Data'"),
    ],
)
def test_mistakes_are_named_by_their_row(
    tmp_path: Path, rows: Any, keys: str, message: str
) -> None:
    with pytest.raises(MachineFileError, match=re.escape(message)):
        loads(engine_text(workbook(tmp_path, rows), keys))


def test_what_is_no_workbook(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A text with a sheet, an archive of anything, a workbook that is cut off, and one without openpyxl."""
    text = tmp_path / "p.csv"
    text.write_text("".join(f"{a},{p}\n" for a, p in ROWS))
    file = workbook(tmp_path)
    archive = io.BytesIO()
    with zipfile.ZipFile(archive, "w") as packed:
        packed.writestr("p.csv", "0,1\n")
    (tmp_path / "p.zip").write_bytes(archive.getvalue())
    (tmp_path / "cut.xlsx").write_bytes(b"PK\x03\x04 xl/workbook.xml")

    absent: Callable[[str], None] = lambda name: None  # noqa: E731
    csv = "is an Excel or other workbook, or a zip archive, no text; export its table of figures"
    for name, keys, message in (
        ("p.csv", ", sheet: Data", "p.csv is no workbook; leave 'sheet' out"),
        ("p.zip", "", f"p.zip {csv} as CSV"),
        ("cut.xlsx", "", "cut.xlsx cannot be read as a workbook (File is not a zip file)"),
        ("p.xlsx", "", f"p.xlsx {csv} as CSV, or install openpyxl"),
    ):
        if "install" in message:
            monkeypatch.setattr(read, "find_spec", absent)
        with pytest.raises(MachineFileError, match=re.escape(message)):
            loads(engine_text(file.with_name(name), keys))


def damaged(file: Path, part: str, content: Callable[[bytes], bytes]) -> None:
    """Change one part of a workbook, which stays a zip archive."""
    with zipfile.ZipFile(file) as archive:
        parts = {name: archive.read(name) for name in archive.namelist()}
    parts[part] = content(parts[part])
    with zipfile.ZipFile(file, "w") as archive:
        for name, written in parts.items():
            archive.writestr(name, written)


@pytest.mark.parametrize(
    "part", ["xl/worksheets/sheet1.xml", "xl/styles.xml", "xl/workbook.xml", "docProps/core.xml"]
)
def test_damaged_workbooks(tmp_path: Path, part: str) -> None:
    """Whatever a damaged part does to its parser, the file is refused in one line."""
    file = workbook(tmp_path)
    damaged(file, part, lambda written: written[: len(written) // 2])
    with pytest.raises(MachineFileError, match="cannot be read as a workbook"):
        loads(engine_text(file))


def test_a_damaged_archive(tmp_path: Path) -> None:
    file = workbook(tmp_path)
    raw = bytearray(file.read_bytes())
    begin = raw.index(b"xl/worksheets/sheet1.xml") + 100
    raw[begin : begin + 200] = bytes(200)
    file.write_bytes(bytes(raw))
    with pytest.raises(MachineFileError, match="cannot be read as a workbook"):
        loads(engine_text(file))


def test_a_workbook_of_charts_alone(tmp_path: Path) -> None:
    book = openpyxl.Workbook()
    book.create_chartsheet("Chart")
    book.remove(book.active)
    book.save(tmp_path / "p.xlsx")
    with pytest.raises(MachineFileError, match="export its table as CSV"):
        loads(engine_text(tmp_path / "p.xlsx"))


def test_the_figures_are_on_another_sheet(tmp_path: Path) -> None:
    file = workbook(tmp_path, [["Motor 7"]], "Cover", {"Run 1": ROWS})
    with pytest.raises(MachineFileError, match=r"the first sheet, 'Cover', is read: .* 'Run 1'"):
        loads(engine_text(file))
    assert pressures_of(engine_text(file, ", sheet: Run 1")) == pytest.approx(PRESSURES)


def test_formulas_without_values(tmp_path: Path) -> None:
    """As a program writes them that computes nothing."""
    rows = [[a, f"=2*{p / 2!r}"] for a, p in zip(ANGLES.tolist(), PRESSURES.tolist())]
    with pytest.raises(MachineFileError, match="has formulas: open and save it in Excel"):
        loads(engine_text(workbook(tmp_path, rows)))
