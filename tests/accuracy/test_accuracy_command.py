"""`kurbel accuracy` as a user sees it."""

import re
import time
from collections.abc import Callable, Iterator
from typing import Any

import pytest

from command import answer, printed, run
from kurbel import loads
from kurbel.accuracy import trials
from kurbel.accuracy.extremes import Probe
from kurbel.pictures.accuracy import accuracy_picture
from kurbel.report import accuracy
from kurbel.tables.tables import Column, Part, PlaceTable, Report

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
        patch.setattr(trials, "scipy_integrate", lambda: None)  # whose quad takes seconds
        yield


def once(run: Callable[[], object], quick: bool) -> tuple[float, float]:
    begin = time.perf_counter()
    run()
    return (time.perf_counter() - begin,) * 2


@pytest.fixture(scope="module")
def measured() -> Report:
    """What is measured of the engine: seconds of work, once."""
    return accuracy.accuracy_report(loads(ENGINE), True, loads)


@pytest.fixture
def engine(measured: Report, monkeypatch: pytest.MonkeyPatch) -> dict[str, Any]:
    monkeypatch.setattr(accuracy, "accuracy_report", lambda *_: measured)
    return answer("accuracy", "-", "--quick", text=ENGINE)


def test_text_names_versions_methods_and_states() -> None:
    text = printed("accuracy", "-", "--quick", text=MOTION)
    assert re.match(
        r"plain\. Accuracy and run time\nPython 3\.\d+\.\d+, kurbel \d.*, numpy \d", text
    )
    assert "quantity  method             points  state" in text
    assert "textbook, radians" in text
    assert "leaving out saves" not in text  # nothing to leave out


def test_json_has_both_sections_and_kurbel_is_exact(engine: dict[str, Any]) -> None:
    assert engine["command"] == "accuracy"
    assert engine["machine"] == "engine"
    numerical, saved = engine["scenes"][0]["place_tables"]
    assert (numerical["id"], saved["id"]) == ("numerical_error", "leaving_out")
    assert {row["state"] for row in numerical["rows"]} == {"ok"}
    errors = next(column for column in numerical["columns"] if column["id"] == "error")["values"]
    own = {
        row["quantity"]: error
        for row, error in zip(numerical["rows"], errors)
        if row["method"] == "kurbel"
    }
    assert list(own) == ["x", "c", "b", "A_i", "T_max, T_min", "A_f", "ΔE"]
    assert max(own.values()) < 1e-12


def scene(name: str, *rows: tuple[str, str, str, float | None, float | None]) -> Part:
    """Rows of quantity, method, state, error and time."""
    names = tuple((quantity, method, "36", state) for quantity, method, state, _, _ in rows)
    errors = Column("error", "error", "error", "", tuple(error for *_, error, _ in rows))
    times = Column("median", "median", "median", "ms", tuple(time for *_, time in rows))
    heads = ("quantity", "method", "points", "state")
    return Part(
        name, (), place_tables=(PlaceTable("numerical_error", name, heads, names, (errors, times)),)
    )


TWO_SCENES = Report(
    "two scenes",
    "accuracy",
    None,
    "scenes",
    (
        scene(
            "1",
            ("x", "kurbel", "ok", 0.0, 2.0),
            ("x", "book", "ok", 0.1, 1.0),
            ("x", "book", "ok", 0.01, 3.0),
        ),
        scene(
            "2",
            ("x", "book", "ok", 0.2, 4.0),
            ("c", "kurbel", "ok", 1e-16, 5.0),
            ("c", "book", "lost", None, None),
        ),
    ),
)


def test_a_panel_holds_all_scenes_of_a_quantity() -> None:
    """One line for each method and scene; what is exact can be drawn, and what failed cannot."""
    x, c = accuracy_picture(TWO_SCENES).panels
    assert (x.title, c.title, x.x.falling) == ("x", "c", True)
    drawn = [
        (curve.name.symbol, list(zip(curve.x, curve.y)))
        for curve in x.curves
        if curve.kind == "dots"
    ]
    assert drawn == [
        ("kurbel", [(1e-17, 2.0)]),
        ("book", [(0.1, 1.0), (0.01, 3.0)]),
        ("book", [(0.2, 4.0)]),
    ]
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


def test_a_quantity_that_is_zero_is_not_examined_and_that_is_reported() -> None:
    """Such a card does no work; what a quadrature makes of that is a rounding, to which nothing is relative."""
    zero = "{constant: {expansion: 0 bar, compression: 0 bar}}"
    idle = f"{{crank: 400 mm, rod: 2 m, bore: 450 mm, indicator: {{head_end: {zero}}}}}"
    (scene,) = answer("accuracy", "-", "--quick", text=idle)["scenes"]
    (one,) = scene["left_out"]
    assert one == {
        "what": "A_i, T_max, T_min, ΔE",
        "why": "it is zero, and no error is relative to that",
    }
