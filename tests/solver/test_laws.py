"""Laws that hold for every machine: energy, equilibrium, one-sided values at jumps, and complete lists of angles."""

import math
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from kurbel.errors import NoSolutionError
from kurbel.machine import Machine
from kurbel.machine.indicator import Card, Indicator
from kurbel.machine.parts import Friction, Masses, Piston, Rings
from kurbel.mechanisms.slider_crank import SliderCrank
from kurbel.solver.case import Case
from kurbel.solver.forces import CylinderForces
from machines import STEAM_CARD, one_cylinder, single_acting
from random_cylinders import cylinders

pressures = st.floats(-0.9, 30, allow_nan=False).map(lambda p: round(p, 3))


@st.composite
def cards(draw: st.DrawFn) -> Card:
    def line(first: int, last: int) -> list[tuple[float, float]]:
        inner = sorted(
            draw(st.lists(st.integers(1, 99), max_size=5, unique=True)), reverse=first > last
        )
        return [(x / 100, draw(pressures)) for x in (first * 100, *inner, last * 100)]

    return Card.from_keys(unit=(1e5, 1), expansion=line(0, 1), compression=line(1, 0))


@st.composite
def machines(draw: st.DrawFn) -> CylinderForces:
    lam = draw(st.floats(0.01, 0.95))
    offset = draw(st.sampled_from([0.0, 0.0, 0.5, -0.8])) * (1 / lam - 1) * 0.3
    friction = draw(
        st.sampled_from([None, Friction(0.05), Friction(0.02, Rings(2, 0.01, 2e4, 0.1))])
    )
    head, crank = draw(cards()), draw(st.sampled_from([None, STEAM_CARD]))
    return one_cylinder(
        SliderCrank(0.3, 0.3 / lam, offset),
        draw(st.floats(0, 900)),
        pistons=(
            Piston(0.25, head_end_rod=0.03, crank_end_rod=0.05, indicator=Indicator(head, crank)),
        ),
        masses=Masses(draw(st.floats(0, 300))),
        friction=friction,
        inclination=draw(st.sampled_from([None, 0.0, 30.0, 90.0])),
    )


@given(machines())
def test_energy_goes_in_and_comes_out(forces: CylinderForces) -> None:
    """Quadrature of the torque against closed work of cards and quadrature of the friction."""
    try:
        residual = forces.energy_residual
    except NoSolutionError:
        return  # self-locking, rightly refused
    assert abs(residual) < 1e-13


@given(machines(), st.lists(st.floats(0, 360), min_size=1, max_size=20))
def test_forces_balance_at_crosshead_and_pin(forces: CylinderForces, degrees: list[float]) -> None:
    state = forces.at(degrees)
    try:
        rod = state.S
    except NoSolutionError:
        return
    psi = np.radians(state.psi)
    scale = abs(state.P_gas) + abs(state.P_inertia) + abs(rod) + 1e-9
    friction = 0.0 if state.F_friction is None else state.F_friction
    assert (
        abs(rod * np.cos(psi) - state.P - friction) <= 1e-14 * scale
    ).all()  # along the stroke line
    assert (
        abs(rod * np.sin(psi) - state.N + forces.drive.guide_weight) <= 1e-13 * scale / np.cos(psi)
    ).all()  # across
    assert (abs(np.hypot(state.D, state.T) - abs(rod)) <= 1e-13 * scale / np.cos(psi)).all()


@given(machines())
def test_no_angle_beats_the_extremes(forces: CylinderForces) -> None:
    dense = forces.at(np.linspace(0, 360, 3001))
    try:
        for column in ("P", "S", "N", "T"):
            result = forces.extremes_of(column)
            values = getattr(dense, column)
            slack = 1e-12 * abs(values).max()
            assert result.largest.value >= values.max() - slack
            assert result.smallest.value <= values.min() + slack
    except NoSolutionError:
        return


def reversals_of(
    expansion: list[tuple[float, float]], compression: list[tuple[float, float]]
) -> tuple[float, ...] | None:
    card = Card.from_keys(unit=(1e5, 1), expansion=expansion, compression=compression)
    return one_cylinder(
        SliderCrank(0.4, 2.0), pistons=(Piston(0.2, indicator=Indicator(card)),)
    ).phi_reversal


def test_druckwechsel() -> None:
    """A reversal is a change from one sign to the other; zero in between has none."""
    never = [(1.0, 0.0), (0.0, 0.0)]
    assert reversals_of([(0, 5), (0.5, 5), (1, 0)], never) == ()  # exhausts to the ambient
    assert reversals_of([(0, 5), (0.4, 0), (1, 3)], [(1, 3), (0, 5)]) == ()  # touches zero
    assert (
        reversals_of([(0, 5), (0.4, 5), (0.4, 0), (0.7, 0), (0.7, 2), (1, 2)], [(1, 2), (0, 5)])
        == ()
    )  # + 0 +
    # + on the outstroke, nothing in the middle, − on the way back: once where − begins, once where + begins
    assert reversals_of([(0, 5), (1, 5)], [(1, -0.5), (0, -0.5)]) == (0.0, 180.0)
    result = reversals_of(
        [(0, 5), (0.5, 5), (0.5, 0), (1, 0)], [(1, 0), (0.5, 0), (0.5, -0.5), (0, -0.5)]
    )
    assert result == pytest.approx(
        (0.0, float(360 - SliderCrank(0.4, 2.0).crank_angles_at(0.4, True))), abs=1e-12
    )


def test_one_sided_values_at_a_jump() -> None:
    """Exhaust opens at the outer dead centre: 2.2 at before it, 1.2 at after it."""
    forces = one_cylinder(
        SliderCrank(0.4, 2.0), pistons=(Piston(0.45, indicator=Indicator(STEAM_CARD)),)
    )
    at = np.array([180.0, 180.0])
    before, after = forces.at(at, np.array([179.0, 181.0])).p_head / 98066.5
    assert before == pytest.approx(2.2, rel=1e-14)
    assert after == pytest.approx(1.2, rel=1e-14)
    assert forces.at([180.0]).p_head[0] / 98066.5 == pytest.approx(1.2, rel=1e-14)


def test_a_vertical_jump_inside_the_stroke_is_at_its_exact_angle() -> None:
    card = Card.from_keys(
        unit=(1e5, 1), expansion=[(0, 8), (0.3, 8), (0.3, 2), (1, 2)], compression=[(1, 0), (0, 0)]
    )
    forces = one_cylinder(SliderCrank(0.4, 2.0), pistons=(Piston(0.2, indicator=Indicator(card)),))
    # x = 0.3 s of the exact motion: from the triangle of shaft, pin and crosshead
    distance = 0.4 + 2.0 - 0.3 * 0.8
    angle = math.degrees(math.acos((0.4**2 + distance**2 - 2.0**2) / (2 * 0.4 * distance)))
    around = forces.at([angle - 1e-9, angle + 1e-9])
    assert list(around.p_head) == pytest.approx([8e5, 2e5], rel=1e-12)
    result = forces.extremes_of("T")
    assert result.largest.degrees == pytest.approx(angle, abs=1e-11)
    assert forces.work == pytest.approx(
        (0.3 * 8e5 + 0.7 * 2e5) * 0.8 * Piston(0.2).head_area, rel=1e-15
    )


# lists of angles are complete: no sample of a dense scan between two listed angles has the other sign

SAMPLES = 400
Evaluate = Callable[[np.ndarray, np.ndarray], np.ndarray]
"""A quantity at crank angles in degrees, on the sides of jumps that hold others."""


def scanned(breaks: np.ndarray, evaluate: Evaluate) -> tuple[np.ndarray, np.ndarray]:
    """Angles and values of the only quantity on a dense mesh, and at the summits of parabolas through its samples."""
    low, high = breaks[:-1, None], breaks[1:, None]
    degrees = low + (high - low) * np.linspace(0, 1, SAMPLES)
    within = np.broadcast_to((low + high) / 2, degrees.shape)
    result = evaluate(degrees, within)
    before, here, after = result[:, :-2], result[:, 1:-1], result[:, 2:]
    bend = before - 2 * here + after
    step = np.clip((before - after) / np.where(bend == 0, 1.0, bend) / 2, -1, 1)
    summits = degrees[:, 1:-1] + step * np.diff(degrees)[:, 1:]
    at_summits = evaluate(summits, within[:, 1:-1])
    # ends stand beside each other, before and after a jump; between equal angles their order remains
    angles = np.concatenate((degrees, summits), axis=1)
    values = np.concatenate((result, at_summits), axis=1)
    order = np.argsort(angles, axis=1, kind="stable")
    return np.take_along_axis(angles, order, 1).ravel(), np.take_along_axis(
        values, order, 1
    ).ravel()


def wrong_signs(
    found: np.ndarray, breaks: np.ndarray, evaluate: Evaluate, size: float = 0.0
) -> int:
    """Count the samples whose sign is not that of the others between the same two listed angles, and false angles."""
    angles, values = scanned(breaks, evaluate)
    clear = np.abs(values) > 1e-12 * max(size, np.abs(values).max())
    apart = np.abs(angles[:, None] - np.array([*found, -1.0])).min(axis=1) > 1e-9
    angles, signs = angles[clear & apart], np.sign(values[clear & apart])
    arc = np.searchsorted(found, angles) % max(len(found), 1)
    per_arc = [signs[arc == number] for number in range(max(len(found), 1))]
    mixed = sum(min((one > 0).sum(), (one < 0).sum()) for one in per_arc)
    # an arc so short that no sample falls into it shows nothing of its neighbours
    means = [one.mean() if len(one) else math.nan for one in per_arc]
    same = sum(a == b for a, b in zip(means, [*means[1:], means[0]])) if len(found) else 0
    return int(mixed) + int(same)


def force_along(forces: CylinderForces) -> Evaluate:
    return lambda degrees, within: forces.at(degrees.ravel(), within.ravel()).P.reshape(
        degrees.shape
    )


def missing_reversals(forces: CylinderForces) -> int:
    result, extremes = forces.phi_reversal, forces.extremes_of("P")
    both = extremes.largest.value > 0 > extremes.smallest.value
    return wrong_signs(np.array(result), forces.breaks, force_along(forces)) + int(
        bool(result) != both
    )


def missing_crossings(forces: CylinderForces) -> int:
    shaft = Case(Machine((forces.drive.cylinder,), speed=forces.drive.machine.speed)).flywheel
    result = shaft.extremes_of("T")
    mean = shaft.W

    def evaluate(degrees: np.ndarray, within: np.ndarray) -> np.ndarray:
        return shaft.at(degrees.ravel(), within.ravel()).T.reshape(degrees.shape) - mean

    size = max(abs(extreme.value) for extreme in result)
    return wrong_signs(np.array(shaft.phi_crossing), forces.breaks, evaluate, size)


@pytest.mark.parametrize("summit", [11.4, 1.0, 1e-3, 1e-6])
def test_a_short_force_reversal_is_found(summit: float) -> None:
    """A constant pressure that leaves P_max of a few newtons beside a P_min of thousands."""
    lowest = single_acting(0.4, 0.4 / 0.3, 0.3, 0.0, 120, 100).motion.b_min
    pressure = (summit + 100 * lowest.value) / (math.pi / 4 * 0.3**2)
    forces = single_acting(0.4, 0.4 / 0.3, 0.3, pressure, 120, 100)
    result = forces.extremes_of("P")
    assert result.largest.value == pytest.approx(summit, abs=1e-11)
    assert len(forces.phi_reversal) == 4
    assert np.abs(forces.at(forces.phi_reversal).P).max() <= 1e-12 * -result.smallest.value


def test_no_angle_is_missing_in_random_cylinders() -> None:
    for forces in cylinders(10, 5):
        assert missing_reversals(forces) == 0
        assert missing_crossings(forces) == 0
