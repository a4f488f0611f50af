"""Ideal cards: work against 50 digits and against the closed forms of the textbooks; corners, faults, consistency."""

from typing import Any

import mpmath
import numpy as np
import pytest

from kurbel.machine import STANDARD_ATMOSPHERE, Cylinder, Machine
from kurbel.machine.ideal_cards import Compressor, Diesel, IdealCard, Otto, Steam
from kurbel.machine.indicator import Card, Indicator
from kurbel.machine.parts import Piston
from kurbel.mechanisms.slider_crank import SliderCrank
from kurbel.solver.forces import CylinderForces
from kurbel.solver.gas import process_in

mpf = mpmath.mpf
BAR = 1e5

STEAM = Steam(
    8 * BAR, 0.2 * BAR, cut_off=0.3, clearance=0.05, release=0.92, compression=0.12, exponent=1.0
)
WET = Steam(
    8 * BAR, -0.8 * BAR, cut_off=0.2, clearance=0.07, release=0.95, compression=0.2, exponent=1.135
)
COMPRESSOR = Compressor(0.0, 6 * BAR, clearance=0.06, exponent=1.3)
OTTO = Otto(
    -0.1 * BAR,
    35 * BAR,
    clearance=1 / 7,
    exhaust=0.05 * BAR,
    exponent=1.32,
    expansion_exponent=1.28,
)
DIESEL = Diesel(0.0, cut_off=0.08, clearance=1 / 14, exponent=1.36, expansion_exponent=1.3)
MIXED = Diesel(
    0.0, cut_off=0.05, clearance=1 / 14, peak=60 * BAR, exponent=1.36, expansion_exponent=1.3
)
CARDS: list[IdealCard] = [STEAM, WET, COMPRESSOR, OTTO, DIESEL, MIXED]


def cylinder(
    card: Any, cycle: str = "two-stroke", absolute: bool = False, **more: Any
) -> CylinderForces:
    own = Cylinder(
        SliderCrank(0.1, 0.45),
        pistons=(Piston(0.16, indicator=Indicator(card, absolute=absolute)),),
        **more,
    )
    return CylinderForces(Machine((own,), speed=5.0, cycle=cycle), own)


def polytropic_work(p: mpf, volume: mpf, next_volume: mpf, n: mpf) -> mpf:
    """∫ P dV along P V^n = const."""
    if n == 1:
        return p * volume * mpmath.log(next_volume / volume)
    return p * volume * ((next_volume / volume) ** (1 - n) - 1) / (1 - n)


def precise_work(card: IdealCard, lift: float) -> mpf:
    """∮ P dV over the stroke volume with 50 digits, absolute pressures, written down as the textbooks do."""
    c, one = mpf(card.clearance), mpf(1)
    if isinstance(card, Steam):
        high, low, n = mpf(card.admission) + lift, mpf(card.exhaust) + lift, mpf(card.exponent)
        cut, release, closing = mpf(card.cut_off), mpf(card.release), mpf(card.compression)
        gained = high * cut + polytropic_work(high, c + cut, c + release, n) + low * (1 - release)
        return gained - low * (1 - closing) + polytropic_work(low, c + closing, c, n)
    if isinstance(card, Compressor):
        high, low, n = mpf(card.delivery) + lift, mpf(card.suction) + lift, mpf(card.exponent)
        filled, emptied = c * (high / low) ** (1 / n), (c + 1) * (low / high) ** (1 / n)
        taken = polytropic_work(high, c, filled, n) + low * (1 + c - filled)
        return taken + polytropic_work(low, 1 + c, emptied, n) - high * (emptied - c)
    n, m = mpf(card.exponent), mpf(card.expansion_exponent)
    intake = mpf(card.intake) + lift
    compression = polytropic_work(intake, 1 + c, c, n)
    if isinstance(card, Otto):
        return polytropic_work(mpf(card.peak) + lift, c, one + c, m) + compression
    cut = mpf(card.cut_off)
    burning = intake * ((1 + c) / c) ** n if card.peak is None else mpf(card.peak) + lift
    return burning * cut + polytropic_work(burning, c + cut, 1 + c, m) + compression


@pytest.mark.parametrize("card", CARDS, ids=lambda card: type(card).__name__)
@pytest.mark.parametrize("lift", [0.0, STANDARD_ATMOSPHERE], ids=["absolute", "gauge"])
def test_closed_work_against_50_digits(card: IdealCard, lift: float) -> None:
    if lift == 0:
        raised = {
            name: getattr(card, name) + 1.01325e5
            for name in ("admission", "exhaust", "suction", "delivery", "intake", "peak")
            if getattr(card, name, None) is not None
        }
        card = type(card)(**{**card.__dict__, **raised})
    with mpmath.workdps(50):
        expected = precise_work(card, lift)
        result = process_in(card, lift).area
        assert abs(result / expected - 1) <= 1e-14


@pytest.mark.parametrize("card", CARDS, ids=lambda card: type(card).__name__)
def test_the_forces_do_the_work_of_the_card(card: IdealCard) -> None:
    """∮ T R dφ by quadrature is the closed work, double-acting and with tiny clearance too."""
    forces = cylinder(card) if "two-stroke" in card.cycles else cylinder(card, "four-stroke")
    assert forces.work == pytest.approx(float(sum(forces.drive.gas[0].works)))
    assert abs(forces.energy_residual or 0.0) < 1e-13
    assert forces.mean_pressure == pytest.approx(
        process_in(card, STANDARD_ATMOSPHERE).area + _exchange(card), rel=1e-12
    )


def _exchange(card: IdealCard) -> float:
    """Area of the gas exchange of a four-stroke engine."""
    exhaust = getattr(card, "exhaust", None)
    return (
        card.intake - exhaust if isinstance(card, (Otto, Diesel)) and exhaust is not None else 0.0
    )


def test_corners_of_the_diesel_card() -> None:
    """Compression end p ε^n held to the cut-off, then expansion; crank end one stroke later."""
    card = Diesel(0.0, cut_off=0.1, clearance=0.08, exponent=1.35, expansion_exponent=1.35)
    own = Cylinder(SliderCrank(0.1, 0.45), pistons=(Piston(0.16, indicator=Indicator(card, card)),))
    forces = CylinderForces(Machine((own,)), own)
    end = 101325 * (1.08 / 0.08) ** 1.35 - 101325
    cut = forces.drive.mechanism.crank_angles_at(np.array([0.1 * 0.2]), True)[0]
    at = forces.at([0.0, cut, 180.0, 360.0])
    assert at.p_head[[0, 1, 3]] == pytest.approx([end, end, end], rel=1e-12)
    assert at.p_crank[2] == pytest.approx(end, rel=1e-12)
    # just before the outer dead centre: expanded from the cut-off
    expanded = (end + 101325) * (0.18 / 1.08) ** 1.35 - 101325
    assert forces.at([180 - 1e-9]).p_head[0] == pytest.approx(expanded, rel=1e-9)


def test_given_points_joined_polytropically() -> None:
    """Points taken from p V^1.3 = const give its work exactly, as few as they are."""
    n, c = 1.3, 0.1
    z = [0.0, 0.2, 0.55, 1.0]
    high = [(x, 12.0 * (c / (c + x)) ** n) for x in z]
    low = [(x, 3.0 * (c / (c + x)) ** n) for x in z]
    card = Card.from_keys(
        unit=(BAR, 1), expansion=high, compression=low, interpolate="polytropic", clearance=c
    )
    forces = cylinder(card, absolute=True)
    area = 9 * BAR * c * (1 - (c / (1 + c)) ** (n - 1)) / (n - 1)
    assert forces.mean_pressure == pytest.approx(area, rel=1e-14)
    assert abs(forces.energy_residual or 0.0) < 1e-14
    halfway = forces.drive.mechanism.crank_angles_at(np.array([0.4 * 0.2]), True)
    assert forces.at(halfway).p_head[0] == pytest.approx(12 * BAR * (0.1 / 0.5) ** n, rel=1e-13)
