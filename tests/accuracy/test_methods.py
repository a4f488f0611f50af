"""The methods that kurbel is compared with converge as their textbooks say; rows, errors and savings."""

import math

import mpmath
import numpy as np
import pytest

from kurbel.accuracy import trials
from kurbel.accuracy.methods import by_quad, by_simpson, over_the_turn
from kurbel.accuracy.references import Textbook, unknown
from kurbel.accuracy.trials import Trial, errors, examined, savings, with_corners, without_corners
from kurbel.machine_file import loads
from kurbel.solver.case import Case

SMOOTH = """
{speed: 50 rpm, crank: 400 mm, rod: 2000 mm, bore: 450 mm, masses: {piston: 500 kg},
 indicator: {head_end: {constant: {expansion: 5 bar, compression: 0 bar}}, crank_end: mirrored},
 flywheel: {inertia: 900 kg m2}, load: {slip: 0.2}}
"""
RINGS = "rings: {count: 3, height: 8 mm, pressure: 0.2 bar, coefficient: 0.1}"
BARE = "{name: bare, speed: 60 rpm, crank: 400 mm, rod: 2000 mm}"


@pytest.fixture(scope="module")
def rows() -> list[Trial]:
    """All rows of a machine without corners but at the dead centres, and with friction."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(trials, "timed", lambda run, quick: (1.0, 1.0))
        patch.setattr(trials, "scipy_integrate", lambda: None)  # whose quad takes seconds
        machine = loads(
            SMOOTH.replace("flywheel", f"friction: {{crosshead: 0.05, {RINGS}}}, flywheel")
        )
        return examined(Textbook(machine), np.arange(0.0, 361.0, 10.0), True)[0]


@pytest.mark.parametrize("quantity", ["x", "c", "b", "A_i", "T_max, T_min", "A_f", "ΔE"])
def test_methods_converge(rows: list[Trial], quantity: str) -> None:
    """Equal divisions slowly; methods between the corners, and kurbel, to rounding."""
    results = {
        (row.method, row.points): row.error or 0.0 for row in rows if row.quantity == quantity
    }
    own = next(error for (method, _), error in results.items() if method == "kurbel")
    assert own < 1e-13
    if quantity in "xcb":
        assert results["textbook, radians", "closed"] < 1e-11
        assert results["Chebyshev fit", "16"] > 1e3 * results["Chebyshev fit", "32"]
        assert results["Chebyshev fit", "64"] < 1e-8
        return
    by_tops = quantity[0] == "T"
    fit = "Chebyshev fit between the corners"
    simple = "largest ordinate" if by_tops else "trapezium rule"
    assert results[simple, "36"] > 10 * results[simple, "360"] >= 10 * results[simple, "3600"]
    assert results[fit, "8"] > results[fit, "16"]
    assert results[fit, "32"] < 1e-13
    if not by_tops:
        assert (
            results["Simpson's rule", "36"]
            > 3 * results["Simpson's rule", "360"]
            >= 3 * results["Simpson's rule", "3600"]
        )
        assert (
            results["Gauss over the turn", "36"] > 3 * results["Gauss over the turn", "360"] > 1e-9
        )
    if quantity[0] == "A":
        assert results["spreadsheet", "36 rows"] > 10 * results["spreadsheet", "360 rows"] > 1e-9
    assert (
        results["roots between the corners" if by_tops else "Gauss between the corners", "32"]
        < 1e-13
    )


def test_evaluations_are_counted(rows: list[Trial]) -> None:
    """37 angles of a closed formula, as many samples of a turn as divisions; kurbel's own are those of its solver."""
    used = {(row.quantity, row.method, row.points): row.evaluations for row in rows}
    assert used["x", "kurbel", "closed"] == used["x", "textbook, radians", "closed"] == 37
    assert used["c", "Chebyshev fit", "32"] == 33
    assert 3600 <= used["A_i", "trapezium rule", "3600"] < 3700
    assert 16 < used["T_max, T_min", "kurbel", "roots of T′"] < 1000


def test_errors_of_arrays() -> None:
    def of(*values: int) -> np.ndarray:
        return np.array([mpmath.mpf(value) for value in values])

    relative, ulp = errors(np.array([1.0, 2.0 + 2**-51, 0.0]), of(1, 2, 0))
    assert relative == pytest.approx(2**-52, rel=1e-12)
    assert ulp == pytest.approx(1, rel=1e-12)
    assert errors(np.array([1.0, 1e-3]), of(1, 0)) == (pytest.approx(1e-3), None)
    assert errors(np.array([math.nan]), of(1)) == (None, None)


def row(method: str, error: float | None, time: float, quantity: str = "A_i") -> Trial:
    return Trial(quantity, method, "1", "ok", 1, error, None, time, time, 1.0)


def test_the_fastest_rival_with_corners_has_all_digits() -> None:
    """16 roundings are all digits; where kurbel has fewer, its own error is the measure."""
    own = row("kurbel", 1e-17, 2.0)
    slow, fast = (
        row("Gauss between the corners", 1e-16, 1.0),
        row("Chebyshev fit between the corners", 1e-15, 0.5),
    )
    rough, lost = (
        row("Gauss between the corners", 1e-14, 0.1),
        row("Gauss between the corners", None, 0.1),
    )
    blind = row("trapezium rule", 1e-17, 0.1)
    assert with_corners([own, slow, fast, rough, lost, blind]) == [(fast, 0.25)]
    assert with_corners([own._replace(error=1e-13), rough]) == [(rough, 0.05)]
    assert with_corners([own, lost, blind]) == []


def test_rivals_without_corners_are_compared_at_the_time_of_kurbel() -> None:
    own, slow = row("kurbel", 1e-16, 1.0), row("Simpson's rule", 1e-9, 1.5)
    rough, better = row("trapezium rule", 1e-4, 0.1), row("trapezium rule", 1e-6, 0.9)
    reported = row("Gauss between the corners", 1e-16, 0.5)
    assert without_corners([own, slow, rough, better, reported]) == [(better, 0.9)]
    assert without_corners([own, slow]) == []


@pytest.mark.parametrize(
    ("text", "what", "why"),
    [
        (
            "{speed: 60 rpm, effort: {swing: 100 J, mean: 50 N m}}",
            "ΔE",
            "an effort of which the swing of energy is given",
        ),
        (
            SMOOTH.replace(
                "flywheel:",
                "friction: {journals: 0.1, journal_diameter: 90 mm}, "
                "crankshaft: {a: 200 mm, b: 200 mm, web_distance: 130 mm, web_thickness: 60 mm, "
                "web_width: 120 mm, pin_diameter: 90 mm, pin_length: 100 mm}, flywheel:",
            ),
            "A_f",
            "journals that rub in the bearings of a crankshaft",
        ),
    ],
)
def test_what_has_no_reference_is_named(text: str, what: str, why: str) -> None:
    assert why in list(unknown(loads(text), what))


def test_every_thing_left_out_saves_functions() -> None:
    machine = loads(
        SMOOTH.replace("flywheel", "friction: {crosshead: 0.05}, inclination: 0 deg, flywheel")
    )
    result = list(
        savings(machine, lambda one: Case(one).cylinders[0].at(np.arange(0.0, 361.0, 10.0)).T, True)
    )
    assert [one.machine for one in result] == [
        "everything",
        "no friction",
        "no masses either",
        "no cards either: motion alone",
        "no speed either: positions alone",
    ]
    counts = [one.stages for one in result]
    assert counts == sorted(counts, reverse=True)
    assert counts[0] > counts[-1] > 0
    assert result[0].ratio == 1.0
    bare = [
        saving.machine
        for saving in savings(loads(BARE), lambda one: Case(one).cylinders[0].at([0.0]), True)
    ]
    assert bare == ["everything", "no speed either: positions alone"]


def test_quad_of_scipy_over_a_corner() -> None:
    """|sin φ| over a turn has the area 4; Gauss's rule without its corner misses it by far more than quad."""
    pytest.importorskip("scipy")

    def function(phi: np.ndarray, within: np.ndarray) -> np.ndarray:
        return np.abs(np.sin(np.radians(phi - 40)))

    whole = np.array([0.0, 360.0])
    assert by_quad("A_i", function, whole, 0) == pytest.approx(4, rel=1e-7)
    assert over_the_turn("A_i", function, whole, 36) == pytest.approx(4, rel=1e-2)
    assert over_the_turn("A_i", function, whole, 36) != pytest.approx(4, rel=1e-5)
    assert by_simpson("A_i", function, whole, 360) == pytest.approx(4, rel=1e-3)
