"""Laws that hold for every machine: energy, equilibrium at the pin, one-sided values at jumps."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from kurbel.crank_angle import CrankAngle
from kurbel.errors import NoSolutionError
from kurbel.machine import Cylinder, Machine
from kurbel.machine.indicator import Card, Constant, Indicator
from kurbel.machine.parts import Friction, Masses, Piston, Rings
from kurbel.mechanisms.slider_crank import SliderCrank
from kurbel.solver.case import Case
from kurbel.solver.forces import CylinderForces
from machines import STEAM_CARD, one_cylinder
from representative import few

pressures = st.floats(-0.9, 30, allow_nan=False).map(lambda p: round(p, 3))


@st.composite
def cards(draw: st.DrawFn) -> Card:
    def line(first: int, last: int) -> list[tuple[float, float]]:
        inner = sorted(draw(st.lists(st.integers(1, 99), max_size=5, unique=True)), reverse=first > last)
        return [(x / 100, draw(pressures)) for x in (first * 100, *inner, last * 100)]

    return Card.from_keys(unit=(1e5, 1), expansion=line(0, 1), compression=line(1, 0))


@st.composite
def machines(draw: st.DrawFn) -> CylinderForces:
    lam = draw(st.floats(0.01, 0.95))
    offset = draw(st.sampled_from([0.0, 0.0, 0.5, -0.8])) * (1 / lam - 1) * 0.3
    friction = draw(st.sampled_from([None, Friction(0.05), Friction(0.02, Rings(2, 0.01, 2e4, 0.1))]))
    head, crank = draw(cards()), draw(st.sampled_from([None, STEAM_CARD]))
    return one_cylinder(
        SliderCrank(0.3, 0.3 / lam, offset),
        draw(st.floats(0, 900)),
        pistons=(Piston(0.25, 0.03, 0.05, Indicator(head, crank)),),
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
    assert residual is not None
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
    assert (abs(rod * np.cos(psi) - state.P - friction) <= 1e-14 * scale).all()  # along the stroke line
    assert (abs(rod * np.sin(psi) - state.N + forces.drive.guide_weight) <= 1e-13 * scale / np.cos(psi)).all()  # across
    assert (abs(np.hypot(state.D, state.T) - abs(rod)) <= 1e-13 * scale / np.cos(psi)).all()


@given(machines())
def test_no_angle_beats_the_extremes(forces: CylinderForces) -> None:
    dense = forces.at(np.linspace(0, 360, 3001))
    try:
        for column in ("P", "S", "N", "T"):
            found = forces.extremes_of(column)
            values = getattr(dense, column)
            assert found
            slack = 1e-12 * abs(values).max()
            assert found.largest.value >= values.max() - slack
            assert found.smallest.value <= values.min() + slack
    except NoSolutionError:
        return


def test_friction_opposes_the_motion_everywhere() -> None:
    forces = one_cylinder(
        SliderCrank(0.4, 2.0),
        60,
        pistons=(Piston(0.45, indicator=Indicator(STEAM_CARD, STEAM_CARD)),),
        masses=Masses(800),
        friction=Friction(0.1),
        inclination=0.0,
    )
    state = forces.at(np.arange(1.0, 360.0, 1.0))
    assert (state.F_friction * state.c <= 0).all()
    assert (state.F_friction * state.c < 0).any()


def reversals_of(
    expansion: list[tuple[float, float]], compression: list[tuple[float, float]]
) -> tuple[float, ...] | None:
    card = Card.from_keys(unit=(1e5, 1), expansion=expansion, compression=compression)
    return one_cylinder(SliderCrank(0.4, 2.0), pistons=(Piston(0.2, indicator=Indicator(card)),)).phi_reversal


def test_druckwechsel() -> None:
    """A reversal is a change from one sign to the other; zero in between has none."""
    never = [(1.0, 0.0), (0.0, 0.0)]
    assert reversals_of([(0, 5), (0.5, 5), (1, 0)], never) == ()  # exhausts to the ambient
    assert reversals_of([(0, 5), (0.4, 0), (1, 3)], [(1, 3), (0, 5)]) == ()  # touches zero
    assert reversals_of([(0, 5), (0.4, 5), (0.4, 0), (0.7, 0), (0.7, 2), (1, 2)], [(1, 2), (0, 5)]) == ()  # + 0 +
    # + on the outstroke, nothing in the middle, − on the way back: once where − begins, once where + begins
    assert reversals_of([(0, 5), (1, 5)], [(1, -0.5), (0, -0.5)]) == (0.0, 180.0)
    found = reversals_of([(0, 5), (0.5, 5), (0.5, 0), (1, 0)], [(1, 0), (0.5, 0), (0.5, -0.5), (0, -0.5)])
    assert found == pytest.approx((0.0, float(360 - SliderCrank(0.4, 2.0).crank_angles_at(0.4, True))), abs=1e-12)


def test_one_sided_values_at_a_jump() -> None:
    """Exhaust opens at the outer dead centre: 2.2 at before it, 1.2 at after it."""
    forces = one_cylinder(SliderCrank(0.4, 2.0), pistons=(Piston(0.45, indicator=Indicator(STEAM_CARD)),))
    at = np.array([180.0, 180.0])
    before, after = forces.at(at, np.array([179.0, 181.0])).p_head / 98066.5
    assert before == pytest.approx(2.2, rel=1e-14)
    assert after == pytest.approx(1.2, rel=1e-14)
    assert forces.at([180.0]).p_head[0] / 98066.5 == pytest.approx(1.2, rel=1e-14)


def test_a_vertical_jump_inside_the_stroke_stands_at_its_exact_angle() -> None:
    card = Card.from_keys(unit=(1e5, 1), expansion=[(0, 8), (0.3, 8), (0.3, 2), (1, 2)], compression=[(1, 0), (0, 0)])
    forces = one_cylinder(SliderCrank(0.4, 2.0), pistons=(Piston(0.2, indicator=Indicator(card)),))
    # x = 0.3 s of the exact motion: from the triangle of shaft, pin and crosshead
    distance = 0.4 + 2.0 - 0.3 * 0.8
    angle = math.degrees(math.acos((0.4**2 + distance**2 - 2.0**2) / (2 * 0.4 * distance)))
    around = forces.at([angle - 1e-9, angle + 1e-9])
    assert list(around.p_head) == pytest.approx([8e5, 2e5], rel=1e-12)
    found = forces.extremes_of("T")
    assert found
    assert found.largest.degrees == pytest.approx(angle, abs=1e-11)
    assert forces.work == pytest.approx((0.3 * 8e5 + 0.7 * 2e5) * 0.8 * Piston(0.2).head_area, rel=1e-15)


STEEP = [(width, z, mirrored) for mirrored in (False, True) for z in (0.3, 0.37, 0.9) for width in (1e-3, 1e-6, 1e-8)]


@pytest.mark.parametrize(("width", "z", "mirrored"), few(STEEP, STEEP[::2]))
def test_extremes_at_corners_of_steep_lines_are_those_of_the_card(width: float, z: float, mirrored: bool) -> None:
    """The summit of the card is 9 bar, its hollow −0.7 bar, however steep the lines that lead there."""
    card = Card.from_keys(
        unit=(1e5, 1),
        expansion=[(0, 3), (z, 3), (z + width, 9), (z + 2 * width, 2), (1, 2)],
        compression=[(1, 0.5), (z, 0.5), (z - width, -0.7), (z - 2 * width, 0.5), (0, 0.5)],
    )
    piston = Piston(0.2, indicator=Indicator(None if mirrored else card, card if mirrored else None))
    own = Cylinder(SliderCrank(0.4, 2.0), pistons=(piston,), crank_position=77.7)
    case = Case(Machine((own,), speed=1.0))
    found = case.cylinders[0].extremes_of("P")
    assert found
    sides = sorted((found.largest.value, found.smallest.value), key=abs)
    assert np.abs(sides) == pytest.approx([0.7e5 * piston.head_area, 9e5 * piston.head_area], rel=4e-16)
    # the turning effort takes the corner at a shifted angle: there T is P at the corner times dx/dφ
    largest = max((case.flywheel.M_max, case.flywheel.M_min), key=lambda extreme: abs(extreme.value))
    slope = SliderCrank(0.4, 2.0).slope(CrankAngle.of(largest.degrees - 77.7))
    assert largest.value == pytest.approx(sides[1] * slope, rel=1e-14)


def test_speed_zero_has_no_inertia_but_exact_zeros() -> None:
    forces = one_cylinder(SliderCrank(0.4, 2.0), 0, masses=Masses(100))
    state = forces.at([0, 33, 180])
    assert (state.P_inertia == 0).all()
    assert (state.c == 0).all()
    assert forces.power is None


@pytest.mark.parametrize("scale", [1e-300, 1e-150, 1e150, 1e300])
def test_lengths_of_any_size(scale: float) -> None:
    card = Constant.from_keys(expansion=1.0, compression=0.0)
    bore = 1e-3 if scale > 1 else 1e3
    small = one_cylinder(SliderCrank(0.4, 2.0), pistons=(Piston(bore, indicator=Indicator(card)),)).at([10, 100, 250])
    large = one_cylinder(SliderCrank(0.4 * scale, 2.0 * scale), pistons=(Piston(bore, indicator=Indicator(card)),))
    state = large.at([10, 100, 250])
    assert pytest.approx(small.T, rel=4e-15) == state.T
    assert state.x / scale == pytest.approx(small.x, rel=4e-15)


def test_mirrored_card_turns_the_force_by_half_a_turn_for_the_infinite_rod() -> None:
    forces = one_cylinder(
        SliderCrank(0.4, math.inf), pistons=(Piston(0.45, indicator=Indicator(STEAM_CARD, STEAM_CARD)),)
    )
    degrees = np.arange(5.0, 180.0, 10.0)
    out, back = forces.at(degrees), forces.at(degrees + 180)
    assert list(out.P) == pytest.approx(list(-back.P), rel=1e-14)
    assert not out.N.any()
