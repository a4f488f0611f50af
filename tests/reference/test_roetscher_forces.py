"""F. Rötscher, Die Maschinenelemente (1927), ch. 14, the waterworks engine of Tafel I: forces (pp. 606-613)."""

from __future__ import annotations

import pytest

from kurbel.declared.units import GRAVITY
from kurbel.machine.indicator import Constant, Indicator
from kurbel.machine.parts import Masses, Piston
from kurbel.mechanisms.slider_crank import SliderCrank
from machines import AT, STEAM_CARD, one_cylinder

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
    assert smallest is not None
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
    assert found
    # just before the inner dead centre: head end compressed to 9,5 at, crank end released to 2,2 at, pump pushing
    steam_end = (9.5 * STEAM.head_area - 2.2 * STEAM.crank_area) * AT
    assert found.largest.value == pytest.approx(steam_end + pump.at([270]).P[0], rel=1e-14)
    assert found.largest.degrees == 360
