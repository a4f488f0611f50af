"""CSV and JSON for scripts: exact, readable by other readers, to the letter of the contract."""

import csv
import io
import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from kurbel.render import Look
from kurbel.render.formats import render
from kurbel.tables.tables import Column, Part, PlaceTable, Report
from render.sample_report import ONE, PHI, texts

VALUES = st.lists(
    st.none() | st.floats(allow_nan=False, allow_infinity=False), min_size=1, max_size=6
)


def report_of(values: list[float | None], name: str = "one") -> Report:
    columns = (
        PHI._replace(values=tuple(range(len(values)))),
        Column("x", "x", "x", "m", tuple(values)),
    )
    return Report("t", "forces", "m", "cylinders", (Part(name, columns),))


def read_csv(text: str, delimiter: str = ",") -> list[list[str]]:
    assert "\r" not in text
    return list(csv.reader(io.StringIO(text), delimiter=delimiter))


@given(VALUES, st.booleans())
def test_csv_reads_back_exactly(values: list[float | None], comma: bool) -> None:
    rows = read_csv(render(report_of(values), Look("csv", comma=comma)), ";" if comma else ",")
    assert rows[0] == ["phi_deg", "x_m"]
    assert [None if text == "" else float(text.replace(",", ".")) for _, text in rows[1:]] == values
    assert [phi for phi, _ in rows[1:]] == [str(index) for index in range(len(values))]


@given(VALUES)
def test_json_reads_back_exactly(values: list[float | None]) -> None:
    content = json.loads(render(report_of(values), Look("json")))
    assert content["cylinders"][0]["columns"][1]["values"] == values


@pytest.mark.parametrize(
    "name", ["=2+5", "+2", "-2+3", "@SUM(A1:A9)", '=HYPERLINK("http://a.b","c")', "＝2+5"]
)
def test_no_name_is_a_formula_to_a_spreadsheet(name: str) -> None:
    part = Part(name, (PHI._replace(values=(0.0,)), Column("x", "x", "x", "m", (-2.0,))))
    places = PlaceTable("t", "t", ("part",), ((name,),), (Column("s", "s", "s", "Pa", (-3.0,)),))
    report = Report("t", "forces", "m", "cylinders", (part, part))
    assert read_csv(render(report, Look("csv")))[1] == ["'" + name, "0", "-2.0"]
    alone = Report("t", "accuracy", "m", "scenes", (Part(name, (), place_tables=(places,)),))
    assert read_csv(render(alone, Look("csv")))[1] == ["'" + name, "t", "'" + name, "-3.0"]


@given(texts(), st.sampled_from(["utf-8", "ascii"]))
def test_any_name_survives_in_json(name: str, encoding: str) -> None:
    text = render(report_of([1.0], name), Look("json", encoding=encoding))
    assert json.loads(text.encode(encoding))["cylinders"][0]["name"] == name


def test_json_never_holds_nan() -> None:
    with pytest.raises(ValueError, match="JSON compliant"):
        render(report_of([float("nan")]), Look("json"))


@given(st.lists(texts("Cc", "Zl", "Zp"), min_size=2, max_size=2))
def test_markdown_tables_keep_their_columns(names: list[str]) -> None:
    symbols = tuple(column._replace(symbol=names[0]) for column in ONE.parts[0].columns)
    report = ONE._replace(title=names[1], parts=(ONE.parts[0]._replace(columns=symbols),))
    lines = [
        line for line in render(report, Look("markdown")).split("\n") if line.startswith("| ")
    ][:15]
    assert {line.replace("\\\\", "").replace("\\|", "").count("|") for line in lines} == {
        len(symbols) + 1
    }
