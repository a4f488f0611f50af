"""`kurbel accuracy` as a user sees it."""

import math
import re
import time
from collections.abc import Callable, Iterator
from typing import Any

import pytest

from command import answer, printed, run
from kurbel import loads
from kurbel.accuracy import trials
from kurbel.accuracy.extremes import Probe
from kurbel.accuracy.trials import data_errors, model_errors
from kurbel.report import accuracy
from kurbel.report.accuracy import accuracy_picture
from kurbel.report.tables import Column, Part, PlaceTable, Report
from representative import few

MOTION = "{name: plain, speed: 50 rpm, crank: 400 mm, rod_ratio: 5}"
ENGINE = """
{name: engine, speed: 50 rpm, crank: 400 mm, rod: 2000 mm, bore: 450 mm, masses: {piston: 500 kg},
 indicator: {head_end: {unit: bar, expansion: [[0, 9], [0.3, 9], [1, 2]], compression: [[1, 1], [0.2, 1], [0, 9]]}},
 friction: {crosshead: 0.05}}
"""


@pytest.fixture(scope="module", autouse=True)
def impatient() -> Iterator[None]:
    """Every method is timed once: how long it takes is nothing to these tests."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(trials, "timed", once)
        yield


def once(run: Callable[[], object], quick: bool) -> tuple[float, float]:
    begin = time.perf_counter()
    run()
    return (time.perf_counter() - begin,) * 2


@pytest.fixture(scope="module")
def measured() -> Report:
    """What is measured of the engine: seconds of work, once."""
    return accuracy.accuracy_report(loads(ENGINE), True, loads, {})


@pytest.fixture
def engine(measured: Report, monkeypatch: pytest.MonkeyPatch) -> dict[str, Any]:
    monkeypatch.setattr(accuracy, "accuracy_report", lambda *_: measured)
    return answer("accuracy", "-", "--quick", text=ENGINE)


def tables(content: dict[str, Any]) -> dict[str, dict[str, Any]]:
    return {table["id"]: table for table in content["scenes"][0]["place_tables"]}


def test_text_names_versions_methods_and_states() -> None:
    text = printed("accuracy", "-", "--quick", text=MOTION)
    assert text.startswith("plain. Accuracy and run time\nkurbel ")
    assert re.search(r"Python 3\.\d+\.\d+, numpy \d", text)
    assert "quantity  method             points  state" in text
    assert "textbook, radians" in text
    assert "plain: error of the model" in text
    assert "error of the data" not in text  # no cards
    assert "leaving out saves" not in text  # nothing to leave out


def test_json_has_the_four_sections(engine: dict[str, Any]) -> None:
    assert engine["command"] == "accuracy"
    assert engine["machine"] == "engine"
    assert list(tables(engine)) == ["numerical_error", "model_error", "data_error", "leaving_out"]
    rows = tables(engine)["numerical_error"]["rows"]
    assert {row["quantity"] for row in rows} == {"x", "c", "b", "A_i", "T_max, T_min", "A_f", "ΔE"}
    assert {row["state"] for row in rows} == {"ok"}


def test_own_methods_are_exact_and_data_worse_than_model_worse_than_numbers(engine: dict[str, Any]) -> None:
    found = tables(engine)
    numerical = found["numerical_error"]
    errors = next(column for column in numerical["columns"] if column["id"] == "error")["values"]
    own = [error for row, error in zip(numerical["rows"], errors) if row["method"] == "kurbel"]
    assert len(own) == 7
    assert max(own) < 1e-12
    model = next(column for column in found["model_error"]["columns"] if column["id"] == "error")["values"]
    data = next(column for column in found["data_error"]["columns"] if column["id"] == "error")["values"]
    assert min(model) > 1e6 * max(own)
    assert min(data) > 1e6 * max(own)


def test_a_mechanism_without_a_reference_says_so() -> None:
    machine = "{mechanism: four-bar, crank: 40 mm, coupler: 150 mm, rocker: 80 mm, frame: 150 mm, speed: 120 rpm}"
    assert "no independent calculation of the four-bar" in printed("accuracy", "-", "--quick", text=machine)


def scene(name: str, *rows: tuple[str, str, str, float | None, float | None]) -> Part:
    """Rows of quantity, method, state, error and time."""
    names = tuple((quantity, method, "36", state) for quantity, method, state, _, _ in rows)
    errors = Column("error", "error", "error", "", tuple(error for *_, error, _ in rows))
    times = Column("median", "median", "median", "ms", tuple(time for *_, time in rows))
    heads = ("quantity", "method", "points", "state")
    return Part(name, (), place_tables=(PlaceTable("numerical_error", name, heads, names, (errors, times)),))


TWO_SCENES = Report(
    "two scenes",
    "accuracy",
    None,
    "scenes",
    (
        scene(
            "1", ("x", "kurbel", "ok", 0.0, 2.0), ("x", "book, 9", "ok", 0.1, 1.0), ("x", "book, 18", "ok", 0.01, 3.0)
        ),
        scene(
            "2", ("x", "book, 9", "ok", 0.2, 4.0), ("c", "kurbel", "ok", 1e-16, 5.0), ("c", "book", "lost", None, None)
        ),
    ),
)


def test_a_panel_holds_all_scenes_of_a_quantity() -> None:
    """One line for each method, broken between the scenes; what is exact can be drawn, and what failed cannot."""
    x, c = accuracy_picture(TWO_SCENES).panels
    assert (x.title, c.title, x.x.falling) == ("x", "c", True)
    drawn = {curve.name.symbol: list(zip(curve.x, curve.y)) for curve in x.curves if curve.kind == "dots"}
    assert drawn["kurbel"] == [(1e-17, 2.0)]
    assert drawn["book"][:2] == [(0.1, 1.0), (0.01, 3.0)]
    assert math.isnan(drawn["book"][2][0])
    assert drawn["book"][3] == (0.2, 4.0)
    assert [curve.name.symbol for curve in c.curves if curve.kind == "dots"] == ["kurbel"]


def test_a_failed_extreme_case_ends_with_status_1(monkeypatch: pytest.MonkeyPatch) -> None:
    cases = [
        Probe("right", MOTION, "motion c@180", "0", "8"),
        Probe("wrong", MOTION, "motion c@30", "status 2: never"),
    ]
    monkeypatch.setattr(accuracy, "all_cases", lambda: cases)
    result = run("accuracy", "--extremes")
    assert result.exit_code == 1
    assert "1 of 2 cases passed" in result.stdout
    assert "FAILED" in result.stdout
    monkeypatch.setattr(accuracy, "all_cases", lambda: cases[:1])
    assert run("accuracy", "--extremes").exit_code == 0


IDLE = "speed: 60 rpm\ncrank: 400 mm\nrod: 2 m\nbore: 450 mm\n"
CONSTANT = "{constant: {expansion: %s, compression: %s}}"
WORKLESS = {
    "zero": f"indicator: {{head_end: {CONSTANT % ('0 bar', '0 bar')}}}\n",
    "equal": f"indicator: {{head_end: {CONSTANT % ('3 bar', '3 bar')}}}\n",
    "both ends": f"indicator: {{head_end: {CONSTANT % ('3 bar', '3 bar')}, crank_end: mirrored}}\n",
    "one line": "indicator: {head_end: {unit: bar, expansion: [[0, 5], [1, 1]], compression: [[1, 1], [0, 5]]}}\n",
}


@pytest.mark.parametrize("text", few(WORKLESS.values(), [], WORKLESS))
def test_no_error_is_relative_to_zero(text: str) -> None:
    """Such cards do no work; what a quadrature makes of that is a rounding, to which nothing is relative."""
    for more in ("", "masses: {piston: 100 kg}\nfriction: {crosshead: 0.1}\n"):
        machine = loads(IDLE + text + more)
        found = [*model_errors(machine), *data_errors(machine)]
        assert "A_i" not in [one.quantity for one in found]
        assert all(one.error < 2 for one in found)


def test_a_quantity_that_is_zero_is_not_examined_and_that_is_told() -> None:
    (scene,) = answer("accuracy", "-", "--quick", text=IDLE + WORKLESS["zero"])["scenes"]
    assert [one["what"] for one in scene["left_out"]] == ["A_i", "T_max, T_min", "ΔE"]
    assert {one["why"] for one in scene["left_out"]} == {"it is zero, and no error is relative to that"}
