"""F. Rötscher, Die Maschinenelemente (1927), ch. 14: what is not on the page of validation of the waterworks engine."""

import pytest

from kurbel.machine.indicator import Constant, Indicator
from kurbel.machine.parts import Piston
from kurbel.mechanisms.slider_crank import SliderCrank
from machines import AT, STEAM_CARD, one_cylinder

TAFEL_I = SliderCrank(crank=0.4, rod=2.0)
STEAM = Piston(0.45, 0.075, 0.1, Indicator(STEAM_CARD, STEAM_CARD))
_PUMP_CARD = Constant.from_keys(expansion=-0.45 * AT, compression=5.4 * AT)
PUMP = Piston(0.285, 0.0, 0.075, Indicator(_PUMP_CARD, _PUMP_CARD), "pump")


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
