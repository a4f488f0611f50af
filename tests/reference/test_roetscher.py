"""F. Rötscher, Die Maschinenelemente (1927), ch. 14: motion, and the forces of the waterworks engine (pp. 602-615)."""

import math

import pytest

from kurbel import crank_formulas as formulas
from kurbel.crank_angle import CrankAngle
from kurbel.declared.units import GRAVITY
from kurbel.machine.indicator import Constant, Indicator
from kurbel.machine.parts import Masses, Piston
from kurbel.mechanisms.slider_crank import SliderCrank
from machines import AT, STEAM_CARD, largest_velocity, one_cylinder


@pytest.mark.parametrize(
    ("rod_ratio", "printed", "exact", "degrees", "square_rod"),
    [(5, 1.02, 1.0198331, 79.10014, 78.69007), (4, 1.03, 1.0308827, 76.72098, 75.96376)],
)
def test_largest_velocity(rod_ratio, printed, exact, degrees, square_rod):
    """R p. 606: about 1.02 v and 1.03 v; his rule "rod square to the crank", tan φ = L/R, is near the true place."""
    machine = SliderCrank(1.0, float(rod_ratio))
    largest = largest_velocity(machine)
    assert largest.value == pytest.approx(exact, abs=5e-8)
    assert largest.value == pytest.approx(printed, abs=0.005)
    assert largest.degrees == pytest.approx(degrees, abs=5e-6)
    assert math.degrees(math.atan(rod_ratio)) == pytest.approx(square_rod, abs=5e-6)
    # the rule misses the place by half a degree, the velocity √(1 + λ²) there by little
    rule = machine.slope(CrankAngle.of(math.degrees(math.atan(rod_ratio))))
    assert rule == pytest.approx(math.hypot(1, 1 / rod_ratio), rel=1e-15)
    assert 0 < 1 - rule / largest.value < 1.1e-4


@pytest.mark.parametrize("lam", [1 / 6, 1 / 5, 1 / 4])
def test_acceleration_at_the_dead_centres_and_between(lam):
    """R 292 and 294 are exact; R 293, −λ at 90°, is exact with √(1 − λ²) below it."""
    machine = SliderCrank(lam, 1.0)
    inner, middle, outer = (machine.curvature(CrankAngle.of(degrees)) / lam for degrees in (0.0, 90.0, 180.0))
    assert inner == pytest.approx(1 + lam, rel=1e-15)
    assert middle == pytest.approx(-lam / math.sqrt(1 - lam * lam), rel=1e-15)
    assert outer == pytest.approx(-(1 - lam), rel=1e-15)
    at_90 = CrankAngle.of(90.0)
    assert formulas.first_order_acceleration(at_90.sin, at_90.cos, lam) == -lam


# f. Rötscher, Die Maschinenelemente (1927), ch. 14, the waterworks engine of Tafel I: forces (pp. 606-613)

TAFEL_I = SliderCrank(crank=0.4, rod=2.0)
STEAM = Piston(0.45, 0.075, 0.1, Indicator(STEAM_CARD, STEAM_CARD))
_PUMP_CARD = Constant.from_keys(expansion=-0.45 * AT, compression=5.4 * AT)
PUMP = Piston(0.285, 0.0, 0.075, Indicator(_PUMP_CARD, _PUMP_CARD), "pump")


def test_piston_areas() -> None:
    assert STEAM.head_area * 1e4 == pytest.approx(1546.3, abs=0.05)
    assert STEAM.crank_area * 1e4 == pytest.approx(1511.9, abs=0.06)  # 1511.85, printed 1511,9


def test_crank_pin_speed() -> None:
    motion = one_cylinder(TAFEL_I, 50).motion
    assert motion.v == pytest.approx(2.094, abs=5e-4)  # the book goes on with 2,095
    assert motion.c_m == pytest.approx(2 * 0.8 * 50 / 60, rel=1e-15)  # R 290


@pytest.mark.parametrize(("mass", "printed"), [(830, 1115), (990, 1330)])
def test_largest_inertia_force(mass: float, printed: float) -> None:
    """R 298 at the inner dead centre; the book takes v = 2,095 m/s and g = 9,81: 0.1 % more than exact."""
    smallest = one_cylinder(TAFEL_I, 50, masses=Masses(mass)).P_inertia_min
    assert smallest.degrees == 0
    assert -smallest.value / GRAVITY == pytest.approx(printed, rel=1.5e-3)


def test_pump_forces() -> None:
    """P = A p_s + (A − a) p_d out, A (p_s + p_d) − a p_s back: printed 3490 and 3710 kg."""
    state = one_cylinder(TAFEL_I, pistons=(PUMP,)).at([90, 270])
    assert state.P[0] / (AT / 1e4) == pytest.approx(-3490, abs=5)
    assert state.P[1] / (AT / 1e4) == pytest.approx(3710, abs=5)


def test_crank_train_carries_the_difference_and_the_dead_centre_the_sum() -> None:
    """R p. 613: the pump's force comes off the steam's on the way; in the dead centres both add up."""
    steam, pump, both = (one_cylinder(TAFEL_I, pistons=pistons) for pistons in ((STEAM,), (PUMP,), (STEAM, PUMP)))
    at = [10.0, 100.0, 200.0, 350.0]
    assert pytest.approx(steam.at(at).P + pump.at(at).P, rel=1e-14) == both.at(at).P
    found = both.extremes_of("P")
    # just before the inner dead centre: head end compressed to 9,5 at, crank end released to 2,2 at, pump pushing
    steam_end = (9.5 * STEAM.head_area - 2.2 * STEAM.crank_area) * AT
    assert found.largest.value == pytest.approx(steam_end + pump.at([270]).P[0], rel=1e-14)
    assert found.largest.degrees == 360
