"""The methods that kurbel is compared with converge as their textbooks say; rows, errors and savings."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import mpmath
import numpy as np
import pytest

from imported import modules_after
from kurbel.accuracy import trials
from kurbel.accuracy.methods import DIGITS, FLOATS, fitted, gauss
from kurbel.accuracy.trials import Lacking, Question, Row, better, errors, lighter, questions, savings
from kurbel.machine_file import loads
from kurbel.report.accuracy import _everything

SMOOTH = """
{speed: 50 rpm, crank: 400 mm, rod: 2000 mm, bore: 450 mm, masses: {piston: 500 kg},
 indicator: {head_end: {constant: {expansion: 5 bar, compression: 0 bar}}, crank_end: mirrored},
 flywheel: {inertia: 900 kg m2}, load: {slip: 0.2}}
"""
FULL = """
{name: full, speed: 60 rpm, crank: 400 mm, rod: 2000 mm, bore: 450 mm, inclination: 0 deg,
 indicator: {head_end: {constant: {expansion: 5 bar, compression: 1 bar}}, crank_end: mirrored},
 masses: {piston: 200 kg}, friction: {crosshead: 0.05},
 flywheel: {inertia: 900 kg m2}, load: {slip: 0.1}}
"""


def order(error_of: Callable[[int], float], coarse: int, fine: int) -> float:
    """Observed order of convergence between two divisions of a turn."""
    return math.log(error_of(coarse) / error_of(fine)) / math.log(fine / coarse)


def questions_of(text: str) -> dict[str, Question]:
    found = questions(loads(text), np.arange(0.0, 361.0, 10.0), True)
    return {one.quantity: one for one in found if isinstance(one, Question)}


def missed(text: str, quantity: str) -> dict[tuple[str, str], float]:
    """The error of each method, by its name and points."""
    question = questions_of(text)[quantity]
    with mpmath.mp.workdps(DIGITS):
        reference = np.atleast_1d(np.array(question.reference(), dtype=object))
    found = {}
    for name, points, run in question.methods:
        error, _ = errors(np.atleast_1d(np.asarray(run(loads(text), FLOATS), dtype=float)), reference)
        assert error is not None
        found[name, points] = error
    return found


@pytest.mark.parametrize("quantity", ["A_i", "T_max, T_min", "ΔE"])
def test_methods_converge(quantity: str) -> None:
    """Equal divisions slowly; methods between the corners, and kurbel, to rounding."""
    found = missed(SMOOTH, quantity)
    assert found[trials.OWN, next(points for name, points in found if name == trials.OWN)] < 1e-14
    simple = "largest ordinate" if quantity[0] == "T" else "trapezium rule"
    assert found[simple, "36"] > 10 * found[simple, "360"] >= 10 * found[simple, "3600"]
    assert found["Chebyshev fit", "8"] > found["Chebyshev fit", "16"]
    assert found["Chebyshev fit", "32"] < 1e-13
    assert (
        found[("roots", "Gauss")[quantity[0] != "T"] + " between the corners", ("24", "32")[quantity[0] != "T"]] < 1e-13
    )


@pytest.mark.parametrize("quantity", ["c", "b"])
def test_differences_have_order_two(quantity: str) -> None:
    found = missed(SMOOTH, quantity)
    assert order(lambda count: found["differences of x", str(count)], 36, 360) == pytest.approx(2, abs=0.02)
    assert found["Chebyshev fit", "64"] < 1e-8
    assert found["textbook, radians", "closed"] < 1e-11


def test_speed_lines_converge() -> None:
    found = missed(SMOOTH, "ω")
    assert found[trials.OWN, "1e-13"] < 1e-13
    assert found["collocation between the corners", "4"] > 1e3 * found["collocation between the corners", "8"]
    assert found["collocation between the corners", "16"] < 1e-13
    euler = [
        np.abs(trials.speed_line(loads(SMOOTH), FLOATS, 1, steps) / trials.speed_line(loads(SMOOTH), FLOATS) - 1).max()
        for steps in (360, 3600)
    ]
    assert math.log10(euler[0] / euler[1]) == pytest.approx(1, abs=0.05)


def test_quadratures_have_their_orders() -> None:
    """|sin φ| over a turn is 4: trapezium order 2 (from its kinks), Simpson 4, which meets them."""

    def error(rule: str) -> Callable[[int], float]:
        def of(count: int) -> float:
            with pytest.MonkeyPatch.context() as patch:
                patch.setattr(
                    trials,
                    "function_of",
                    lambda *_: (lambda phi, at: np.abs(np.sin(phi)), np.array([0.0, 2 * math.pi])),
                )
                machine: Any = None
                return abs(float(trials.equidistant("A_i", rule, count, machine, FLOATS)) - 4)

        return of

    assert order(error("trapezium rule"), 36, 360) == pytest.approx(2, abs=0.01)
    assert order(error("Simpson's rule"), 36, 360) == pytest.approx(4, abs=0.01)


def test_a_fit_is_exact_for_polynomials_of_each_piece() -> None:
    edges = np.array([0.0, 1.0, 3.0])

    def function(x: Any, at: Any) -> Any:
        return np.where(np.asarray(at) < 1, x**7, 5 - x**3)

    fit = fitted(function, edges, 8)
    x = np.array([0.3, 1.0, 2.9])
    within = np.array([0.5, 0.5, 2.0])
    assert fit(x, within) == pytest.approx([0.3**7, 1.0, 5 - 2.9**3])
    assert gauss(8)(fit, edges) == pytest.approx([1 / 8, 10 - 20])


def test_errors_of_arrays() -> None:
    def of(*values: int) -> np.ndarray:
        return np.array([mpmath.mpf(value) for value in values])

    relative, ulp = errors(np.array([1.0, 2.0 + 2**-51, 0.0]), of(1, 2, 0))
    assert relative == pytest.approx(2**-52, rel=1e-12)
    assert ulp == pytest.approx(1, rel=1e-12)
    assert errors(np.array([1.0, 1e-3]), of(1, 0)) == (pytest.approx(1e-3), None)
    assert errors(np.array([math.nan]), of(1)) == (None, None)


def row(method: str, error: float | None, time: float | None, state: str = "ok") -> Row:
    return Row("x", method, "1", state, 1, error, None, time, time, 1.0)


def test_better_needs_both_error_and_time() -> None:
    own = row("kurbel", 1e-12, 1.0)
    both = row("a", 1e-14, 0.5)
    others = [
        row("b", 1e-14, 1.5),
        row("c", 1e-10, 0.1),
        row("d", 1e-12 - 1e-15, 0.1),
        row("e", None, None, "no solution"),
    ]
    assert better([own, both, *others]) == [both]


def test_evaluations_are_counted() -> None:
    """361 angles of a closed formula, 360 samples of a turn; kurbel's own are those of its mechanism."""
    found, _ = trials.examined(loads(SMOOTH), np.arange(361.0), True)
    used = {(one.quantity, one.method, one.points): one.evaluations for one in found}
    assert used["x", "kurbel", "closed"] == used["x", "textbook, radians", "closed"] == 361
    assert used["c", "differences of x", "360"] == 3 * 361
    assert 3600 <= used["A_i", "trapezium rule", "3600"] < 3700
    assert 16 < used["T_max, T_min", "kurbel", "roots of T′"] < 1000


def test_only_quantities_of_the_machine_are_asked_for() -> None:
    assert list(questions_of("{speed: 50 rpm, crank: 400 mm, rod_ratio: 5}")) == ["x", "c", "b"]
    assert list(questions_of(SMOOTH)) == ["x", "c", "b", "A_i", "T_max, T_min", "ΔE", "ω"]
    assert list(questions_of(FULL)) == ["x", "c", "b", "A_i", "T_max, T_min", "A_f", "ΔE", "ω"]


@pytest.mark.parametrize(
    ("text", "what", "why"),
    [
        (
            "{mechanism: four-bar, crank: 40 mm, coupler: 150 mm, rocker: 80 mm, frame: 150 mm, speed: 120 rpm}",
            "x, c, b",
            "the four-bar",
        ),
        (SMOOTH.replace("slip: 0.2}", "slip: 0.2}, efficiency: 0.9"), "ΔE, ω", "an efficiency"),
        (
            SMOOTH.replace("flywheel:", "friction: {crank_pin: 0.1, crank_pin_diameter: 100 mm}, flywheel:"),
            "work, T, friction work",
            "pins that rub",
        ),
        ("{speed: 60 rpm, effort: {unit: N m, points: [[0, 1], [360, 1]]}}", "ΔE, ω", "a given turning effort"),
    ],
)
def test_what_has_no_reference_is_named(text: str, what: str, why: str) -> None:
    found = [one for one in questions(loads(text), np.arange(3.0), True) if isinstance(one, Lacking)]
    assert any(one.what == what and why in one.why for one in found)


def test_a_method_without_a_solution_keeps_its_row() -> None:
    def fails(machine: Any, numbers: Any) -> Any:
        raise trials.NoAnswer("no solution")

    question = Question("x", lambda: [mpmath.mpf(1)], [("kurbel", "", lambda *_: 1.0), ("other", "", fails)])
    own, other = trials.rows(question, loads(SMOOTH), True)
    assert (own.state, own.error) == ("ok", 0.0)
    assert (other.state, other.error, other.median, other.ratio) == ("no solution", None, None, None)


def test_every_thing_left_out_saves_functions() -> None:
    found = list(savings(loads(FULL), _everything, True))
    assert [one.machine for one in found] == [
        "everything",
        "no friction",
        "no masses either",
        "no cards either: motion alone",
        "no speed either: positions alone",
    ]
    counts = [one.stages for one in found]
    assert counts[0] == max(counts)
    assert (
        counts[0] > counts[3] > counts[4] > 0
    )  # forces without masses may be halved, so that a few functions more run
    assert found[0].ratio == 1.0
    assert lighter(loads(FULL), friction=None).cylinders[0].friction is None


def test_nothing_is_imported_for_what_is_absent(tmp_path: Path) -> None:
    """mpmath belongs to `kurbel accuracy` alone."""
    bare = tmp_path / "bare.yaml"
    bare.write_text("{name: bare, speed: 60 rpm, crank: 400 mm, rod: 2000 mm}", encoding="utf-8")
    absent = ("kurbel.accuracy", "mpmath", "scipy", "matplotlib", "rich")
    assert modules_after(["motion", str(bare)], ["forces", str(bare)]).isdisjoint(absent)
