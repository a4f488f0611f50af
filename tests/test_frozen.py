"""Records that stay as they were born."""

import copy
import pickle
from dataclasses import FrozenInstanceError, fields, replace
from inspect import Parameter, signature
from typing import Any

import pytest

from kurbel.mechanisms.slider_crank import SliderCrank

BORN = SliderCrank(0.4, rod=2.0)


@pytest.mark.parametrize("change", [lambda: setattr(BORN, "rod", 3.0), lambda: delattr(BORN, "rod")])
def test_a_record_cannot_be_changed(change: Any) -> None:
    with pytest.raises(FrozenInstanceError, match=r"^cannot change 'rod' of a SliderCrank; make another one$"):
        change()
    assert BORN.rod == 2.0


@pytest.mark.parametrize(
    ("values", "named"),
    [
        ((0.4,), {}),
        ((0.4, 2.0, 0.0, 1.0), {}),
        ((0.4, 2.0), {"crank": 0.4}),
        ((0.4, 2.0), {"length": 2.0}),
    ],
)
def test_values_that_are_missing_doubled_or_unknown_are_refused(values: Any, named: Any) -> None:
    with pytest.raises(TypeError, match=r"^SliderCrank\(.*, offset: float = 0.0\) does not take"):
        SliderCrank(*values, **named)


def test_a_record_is_a_dataclass_to_those_who_ask() -> None:
    assert [one.name for one in fields(SliderCrank)] == ["crank", "rod", "offset"]
    assert replace(BORN, rod=2.5).rod == 2.5
    for other in (copy.copy(BORN), pickle.loads(pickle.dumps(BORN))):
        assert vars(other) == vars(BORN)
        assert other != BORN


def test_its_call_and_its_values_are_told() -> None:
    told = signature(SliderCrank).parameters
    assert [one.default for one in told.values()] == [Parameter.empty, Parameter.empty, 0.0]
    assert repr(BORN) == "SliderCrank(crank=0.4, rod=2.0)"
