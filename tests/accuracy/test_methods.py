"""The methods that kurbel is compared with do what their textbooks say: each converges in its order."""

from __future__ import annotations

import math

import numpy as np
import pytest

from kurbel.accuracy import marching, references, rivals
from kurbel.accuracy.decimals import precise
from kurbel.accuracy.oracle import CrankMotion, CylinderOracle
from kurbel.accuracy.periodic import SpeedOracle
from kurbel.accuracy.scenes import Scene
from kurbel.accuracy.textbook import Moved, TextbookCylinder, TextbookMachine
from kurbel.accuracy.timing import Patience, timed
from kurbel.accuracy.trials import Lacking, Question, Row, dominating, errors, questions
from kurbel.machine import Machine
from kurbel.machine_file import loads
from kurbel.mechanisms.slider_crank import SliderCrank
from kurbel.solver.case import Case

SMOOTH = """
{speed: 50 rpm, crank: 400 mm, rod: 2000 mm, bore: 450 mm, masses: {piston: 500 kg},
 indicator: {head_end: {constant: {expansion: 5 bar, compression: 0 bar}}, crank_end: mirrored},
 flywheel: {inertia: 900 kg m2}, load: {slip: 0.2}}
"""


def order(error_of: object, coarse: int, fine: int) -> float:
    """Observed order of convergence between two divisions of a turn."""
    return math.log(error_of(coarse) / error_of(fine)) / math.log(fine / coarse)  # type: ignore[operator]


def test_textbook_motion_is_that_of_the_reference() -> None:
    mechanism = SliderCrank(0.4, 2.0, 0.15)
    degrees = np.arange(361.0)
    for asked in ("coordinate", "slope", "curvature"):
        with precise():
            truth = references.motion_at(CrankMotion(0.4, 2.0, 0.15), degrees.tolist(), asked)
        found = getattr(Moved(mechanism, np.radians(degrees)), asked)
        assert found == pytest.approx(np.array(list(map(float, truth))), abs=1e-14)


def test_textbook_torque_is_that_of_the_reference() -> None:
    machine = loads(
        "{speed: 300 rpm, cycle: four-stroke, stroke: 600 mm, rod: 1400 mm, offset: 20 mm, bore: 400 mm, "
        "inclination: 60 deg, masses: {piston: 240 kg}, indicator: {head_end: {unit: bar, interpolate: polytropic, "
        "clearance: 0.2, intake: [[0, 0], [1, 0]], compression: [[1, 0], [0, 9]], expansion: [[0, 26], [1, 2]], "
        "exhaust: [[1, 0.1], [0, 0.1]]}}, friction: {crosshead: 0.05}}"
    )
    cylinder = machine.cylinders[0]
    with precise():
        oracle = CylinderOracle(machine, cylinder)
        angles = [7.0, 100.0, 250.0, 300.0, 401.0, 500.0, 655.0]
        expected = [float(oracle.torque(*map(type(oracle.mass), (angle, angle)))) for angle in angles]
    textbook = TextbookCylinder(machine, cylinder)
    assert textbook.torque(np.radians(angles)) == pytest.approx(np.array(expected), rel=1e-11)
    assert TextbookMachine(machine).torque(np.radians(angles)) == pytest.approx(np.array(expected), rel=1e-11)


def test_first_order_formulas_are_those_of_the_book() -> None:
    """B 31: λ = 1/5, 45° 0.343 R, 90° 1.1 R, 135° 1.757 R."""
    found = Moved(SliderCrank(1.0, 5.0), np.radians([45.0, 90.0, 135.0]), "first-order").coordinate
    assert found == pytest.approx([0.343, 1.1, 1.757], abs=5e-4)


def test_differences_have_order_two() -> None:
    mechanism = SliderCrank(0.4, 2.0)
    degrees = np.array([33.0])
    truth = Moved(mechanism, np.radians(degrees)).slope

    def missed(count: int) -> float:
        return float(abs(rivals.differences(mechanism, degrees, 1, 2 * math.pi / count) - truth)[0])

    assert order(missed, 36, 360) == pytest.approx(2, abs=0.02)


def test_quadratures_have_their_orders() -> None:
    """Half a turn of sin φ put into a turn: trapezium order 2 (from its kinks), Simpson 4 where it meets them."""

    def missed(rule: object) -> object:
        return lambda count: abs(rule(lambda phi: np.abs(np.sin(phi)), count, 1) - 4)  # type: ignore[operator]

    assert order(missed(rivals.trapezoid), 36, 360) == pytest.approx(2, abs=0.01)
    assert order(missed(rivals.simpson), 36, 360) == pytest.approx(4, abs=0.01)


def problem_of(machine: Machine) -> marching.SpeedProblem:
    return marching.SpeedProblem(machine, Case(machine).flywheel.M_mean)


@pytest.fixture(scope="module")
def speed() -> tuple[marching.SpeedProblem, np.ndarray]:
    machine = loads(SMOOTH)
    with precise():
        return problem_of(machine), np.array([float(w) for w in SpeedOracle(machine).omega()])


def test_runge_kutta_has_order_four(speed: tuple[marching.SpeedProblem, np.ndarray]) -> None:
    problem, truth = speed

    def missed(count: int) -> float:
        march = marching.runge_kutta(problem, count, 60)
        assert march.state == marching.OK
        return float(np.abs(march.omega / truth - 1).max())

    assert order(missed, 24, 144) == pytest.approx(4, abs=0.6)


def test_implicit_trapezium_has_order_two(speed: tuple[marching.SpeedProblem, np.ndarray]) -> None:
    problem, truth = speed

    def missed(count: int) -> float:
        return float(np.abs(marching.implicit_trapezoid(problem, count).omega / truth - 1).max())

    assert order(missed, 360, 3600) == pytest.approx(2, abs=0.1)


def test_marching_says_what_went_wrong() -> None:
    stiff = problem_of(loads(SMOOTH.replace("slip: 0.2", "slip: 1e-9")))
    assert marching.runge_kutta(stiff, 36, 3).state in (marching.NEGATIVE, marching.BLOW_UP)
    heavy = problem_of(loads(SMOOTH.replace("900 kg m2", "9e6 kg m2")))
    assert marching.runge_kutta(heavy, 36, 3).state == marching.OPEN


def test_scipy_agrees(speed: tuple[marching.SpeedProblem, np.ndarray]) -> None:
    pytest.importorskip("scipy")
    problem, truth = speed
    march = marching.scipy_march(problem, "LSODA", 1e-6, 8)
    assert march.omega == pytest.approx(truth, rel=1e-4)


def test_errors_of_arrays() -> None:
    from decimal import Decimal

    relative, ulp = errors([1.0, 2.0 + 2**-51, 0.0], [Decimal(1), Decimal(2), Decimal(0)])
    assert relative == pytest.approx(2**-52, rel=1e-12)
    assert ulp == pytest.approx(1, rel=1e-12)
    assert errors([1.0, 1e-3], [Decimal(1), Decimal(0)]) == (pytest.approx(1e-3), None)
    assert errors([math.nan], [Decimal(1)]) == (None, None)


def row(method: str, error: float | None, time: float, state: str = "ok") -> Row:
    return Row("x", method, "1", state, 1, error, None, time, time, 1.0)


def test_dominating_needs_both_error_and_time() -> None:
    own = row("kurbel", 1e-12, 1.0)
    better = row("a", 1e-14, 0.5)
    others = [row("b", 1e-14, 1.5), row("c", 1e-10, 0.1), row("d", 1e-12 - 1e-15, 0.1), row("e", None, 0.1, "blow-up")]
    assert dominating([own, better, *others]) == [better]


def test_timing_repeats_until_patience_ends() -> None:
    calls = []
    found = timed(lambda: calls.append(1) or len(calls), Patience(7, 10.0))
    assert (found.answer, len(calls)) == (1, 8)
    assert 0 < found.least <= found.median


def test_only_quantities_of_the_machine_are_asked_for() -> None:
    def asked(text: str) -> list[str]:
        return [one.quantity for one in questions(Scene(loads(text))) if isinstance(one, Question)]

    assert asked("{speed: 50 rpm, crank: 400 mm, rod_ratio: 5}") == ["x", "c", "b"]
    assert asked(SMOOTH) == ["x", "c", "b", "A_i", "T_max, T_min", "ΔE", "ω"]
    four_bar = "{mechanism: four-bar, crank: 40 mm, coupler: 150 mm, rocker: 80 mm, frame: 150 mm, speed: 120 rpm}"
    lacking = Lacking("x, c, b", "no independent calculation of the four-bar")
    assert list(questions(Scene(loads(four_bar)))) == [lacking]
