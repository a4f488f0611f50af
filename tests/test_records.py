"""Records cannot be changed, only replaced; each is equal to itself alone."""

import copy
import math
import pickle
from collections.abc import Callable
from dataclasses import FrozenInstanceError, replace

import pytest

from kurbel.errors import RuleError
from kurbel.machine.balance import Counterweight
from kurbel.machine.indicator import Constant, Indicator
from kurbel.machine.turning import Load
from kurbel.mechanisms.slider_crank import SliderCrank

GIVEN = SliderCrank(0.4, rod=2.0)


@pytest.mark.parametrize("change", [lambda: setattr(GIVEN, "rod", 3.0), lambda: delattr(GIVEN, "rod")])
def test_a_record_cannot_be_changed(change: Callable[[], None]) -> None:
    with pytest.raises(FrozenInstanceError):
        change()
    assert GIVEN.rod == 2.0


def test_a_copy_has_the_same_values_and_is_another_record() -> None:
    assert replace(GIVEN, rod=2.5).rod == 2.5
    for other in (copy.copy(GIVEN), pickle.loads(pickle.dumps(GIVEN))):
        assert vars(other) == vars(GIVEN)
        assert other != GIVEN


def test_a_record_shows_the_call_that_makes_it() -> None:
    assert repr(GIVEN) == "SliderCrank(crank=0.4, rod=2.0)"
    assert repr(replace(GIVEN, offset=0.1)) == "SliderCrank(crank=0.4, rod=2.0, offset=0.1)"


@pytest.mark.parametrize(
    ("make", "place"),
    [
        (lambda: Constant(expansion=math.nan, compression=1.0), "expansion"),
        (lambda: Counterweight(product=1.0, axial_position=math.nan), "axial_position"),
        (lambda: Indicator(crank_end=math.nan), "crank_end"),  # type: ignore[arg-type]
        (lambda: Load(power=math.nan), "power_law"),
    ],
)
def test_what_is_no_number_is_refused(make: Callable[[], object], place: str) -> None:
    with pytest.raises(RuleError, match=f"^{place}: nan is no number$"):
        make()


def test_sums_beyond_floats_are_refused() -> None:
    with pytest.raises(RuleError, match="too large or too small to compute with"):
        SliderCrank(1e308, rod=1.5, offset=1e308)
