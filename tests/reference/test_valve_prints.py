"""Valve gears in print, 1859 to 1892; see `valve_prints`."""

import pytest

from valve_prints import PRINTS, Print

WRONG = {
    "slot 35°37′: opening": 13.833,
    "slot 62°26′: cut-off": 0.2998,  # printed as 40 %
    "cut-off by his rule S = r √(1 − x) − v/2": 0.7009,
}
"""Figures that are not as printed, by B cos φ + A sin φ with a pocket calculator."""


@pytest.mark.parametrize("printed", PRINTS, ids=lambda one: f"{one.source}: {one.of}")
def test_a_printed_figure(printed: Print) -> None:
    exact = WRONG.get(printed.of)
    if exact is None:
        assert printed.agrees, printed.computed
    else:
        assert not printed.agrees
        assert printed.why
        assert printed.computed == pytest.approx(exact, rel=1e-4)
