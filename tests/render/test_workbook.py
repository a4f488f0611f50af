"""Workbooks of Excel: read again by openpyxl, they have the numbers of JSON, with heads, units, warnings."""

import io
import math
import sys
import zipfile
from collections.abc import Sequence
from itertools import chain
from pathlib import Path
from typing import Any

import pytest

from command import answer, run
from kurbel.errors import UsageError
from kurbel.render import Look
from kurbel.render.workbook import Sheet, SheetColumn, report_sheets, write_workbook
from render.sample_report import REPORT

openpyxl = pytest.importorskip("openpyxl")
pytest.importorskip("xlsxwriter")

CONFIGS = Path(__file__).parents[2] / "configs"
Rows = list[tuple[Any, ...]]


def written(folder: Path, *words: object) -> Path:
    """Return the workbook that a command writes."""
    file = folder / "x.xlsx"
    result = run(*words, "-o", file)
    assert (result.exit_code, result.output) == (0, "")
    return file


def rows_of_sheets(file: Path | io.BytesIO) -> dict[str, Rows]:
    """Return the rows of every sheet by its name."""
    sheets = openpyxl.load_workbook(file).worksheets
    return {sheet.title: list(sheet.iter_rows(values_only=True)) for sheet in sheets}


def column(rows: Rows, head: str) -> list[Any]:
    """Return the cells below a head."""
    index = rows[0].index(head)
    return [row[index] for row in rows[1:]]


def numbers(values: Sequence[float | None]) -> list[float]:
    """Return numbers with nan for those that are missing."""
    return [math.nan if value is None else value for value in values]


def alike(cells: Sequence[float | None], values: Sequence[float | None]) -> bool:
    """Return whether cells have these values, to the 16 digits that a workbook stores."""
    return numbers(cells) == pytest.approx(numbers(values), rel=1e-15, nan_ok=True)


@pytest.mark.parametrize(
    ("command", "machine"), [("forces", "locomotive-two-cylinders"), ("balance", "four-in-line")]
)
def test_numbers_are_those_of_json(command: str, machine: str, tmp_path: Path) -> None:
    words = (command, CONFIGS / f"{machine}.yaml", "--units", "si", "--angles", "0,90")
    content = answer(*words)
    sheets = rows_of_sheets(written(tmp_path, *words))

    # every column of every part and table
    tables = {part["name"]: part["columns"] for part in content.get("cylinders", ())}
    tables[command] = content.get("machine_columns", ())
    for table in content.get("machine_place_tables", ()):
        tables[table["id"]] = table["columns"]
    compared = 0
    for name, columns in tables.items():
        rows = sheets.get(name, [()])
        heads = {head.split(" [")[0]: head for head in rows[0]}
        for expected in columns:
            assert alike(column(rows, heads[expected["id"]]), expected["values"])
            compared += 1
    assert compared > 10

    # every key value
    parts = [part["key_values"] for part in content.get("cylinders", ())]
    values: list[float | None] = []
    for key_value in chain(*parts, content.get("machine_key_values", ())):
        value = key_value["value"]
        values += value if isinstance(value, list) else [value]
    assert alike(column(sheets["key values"], "value"), values)


def test_heads_formats_and_the_same_bytes_again(tmp_path: Path) -> None:
    words = ("forces", CONFIGS / "waterworks.yaml", "--columns", "x,P")
    file = written(tmp_path, *words)
    content = file.read_bytes()
    workbook = openpyxl.load_workbook(file)
    assert workbook.sheetnames == ["key values", "forces", "pistons", "columns", "notes"]
    forces = workbook["forces"]
    assert [cell.value for cell in forces[1]] == ["phi [°]", "x [mm]", "P [kN]"]
    assert (forces.freeze_panes, forces.auto_filter.ref) == ("A2", "A1:C38")
    # shown to four digits of the largest, as in a table
    assert [cell.number_format for cell in forces[3]] == ["0", "0.0", "0.0"]
    assert forces.column_dimensions["A"].width >= len("phi [°]")
    assert written(tmp_path, *words).read_bytes() == content


def test_warnings_and_notes_on_a_sheet() -> None:
    file = io.BytesIO()
    write_workbook(report_sheets(REPORT, Look("xlsx")), file, Look("xlsx"))
    sheets = rows_of_sheets(file)
    names = ["key values", 'HP side , "Käfer" φ|ψ', "LP", "machine", "notes"]
    assert list(sheets) == names
    what, of, text = sheets["notes"][1]
    assert (what, text) == ("warning", "the card does not close: 1.2 at against 1.3 at")
    assert of == REPORT.parts[0].name
    assert openpyxl.load_workbook(file)["notes"].sheet_properties.tabColor.rgb == "FFFF6600"


def test_a_name_is_never_a_formula(tmp_path: Path) -> None:
    machine = "cylinders: [{name: '=1+1', crank: 1 m, rod: 5 m}, {name: a/b, crank: 1 m, rod: 5 m}]"
    file = tmp_path / "x.xlsx"
    assert run("motion", "-", "-o", file, text=machine).exit_code == 0
    with zipfile.ZipFile(file) as parts:
        assert not any(b"<f>" in parts.read(name) for name in parts.namelist())
    assert list(rows_of_sheets(file))[1:3] == ["=1+1", "a b"]


def test_rows_of_a_sweep_and_of_find(tmp_path: Path) -> None:
    words = ("sweep", CONFIGS / "waterworks.yaml", "--columns", "T_max,phi_reversal")
    rows = rows_of_sheets(written(tmp_path, *words, "--vary", "rod_ratio=0.5,5"))["rows"]
    assert rows[0] == ("row", "rod_ratio", "T_max [kN]", "phi_reversal [°]", "failure")
    assert rows[1][:3] == (1, 0.5, None)
    assert "too small" in rows[1][4]
    si = answer("forces", CONFIGS / "waterworks.yaml")["cylinders"][0]["key_values"]
    T_max = next(value["value"] for value in si if value["id"] == "T_max")
    assert rows[2][2] == pytest.approx(T_max / 1000, rel=1e-13)
    assert len(rows[2][3].split()) == 2

    # of no row the heads are there
    words = (*words, "--vary", "rod_ratio=4,5", "--where", "rod_ratio > 9")
    assert len(rows_of_sheets(written(tmp_path, *words))["rows"]) == 1

    words = ("find", CONFIGS / "waterworks.yaml", "T_max = 88 kN", "--vary", "rod_ratio=3:8")
    rows = rows_of_sheets(written(tmp_path, *words))["rows"]
    assert column(rows, "T_max [kN]") == pytest.approx([88], rel=1e-9)


def test_what_excel_cannot_hold_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("kurbel.render.workbook._MOST_ROWS", 10)
    sheet = Sheet("rows", [SheetColumn("a", [1.0] * 10)])
    with pytest.raises(UsageError, match="has 10 rows, the table 10"):
        write_workbook([sheet], io.BytesIO(), Look("xlsx"))
    old = tmp_path / "old.xlsx"
    old.write_text("old")
    assert run("motion", CONFIGS / "waterworks.yaml", "-o", old).exit_code == 2
    assert old.read_text() == "old"


def test_a_missing_package_is_named(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(sys.modules, "xlsxwriter", None)
    result = run("motion", CONFIGS / "waterworks.yaml", "-o", tmp_path / "x.xlsx")
    assert (result.exit_code, "pip install XlsxWriter" in result.stderr) == (2, True)
    assert list(tmp_path.iterdir()) == []
