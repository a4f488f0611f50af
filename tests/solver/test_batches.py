"""Many machines in one batch have the key values that each has alone."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import pytest

from batches import batch
from kurbel import loads
from kurbel.machine import Machine
from kurbel.numerics.extreme import Extreme
from kurbel.solver.case import Case

VECTORS = (
    *("F_free_max", "M_free_max", "F_free_best", "counterweight_best", "counterweight_best_angle"),
    *(
        "counterweight_least",
        "counterweight_least_angle",
        "share_best",
        "counterweight_given",
        "M_roll_max",
        "M_roll_min",
    ),
)
LOCOMOTIVE = (
    "traction_variation",
    "swaying_couple",
    "hammer_blow",
    "hammer_speed",
    "hammer_train_speed",
    "share_allowed",
    "counterweight_wheel",
)
DIRECTION = "_angle"


def alone_and_together(machines: Sequence[Machine]) -> tuple[list[Any], Any]:
    return [Case(one).balance for one in machines], Case(batch(machines), len(machines)).balance


def of_one(number: Any, place: int) -> float:
    """The number of one machine of a batch; nan of None."""
    return float("nan" if number is None else number[place] if np.ndim(number) else number)


def differs(id: str, one: Any, other: Any, place: int) -> str:
    """What differs of a key value of a machine alone from that of the batch; "" where nothing does."""
    if not isinstance(other, Extreme):
        other = Extreme(other, 0.0)
    value, degrees = one if isinstance(one, Extreme) else (of_one(one, 0), 0.0)
    here, there = (of_one(part, place) for part in other)
    size = 360.0 if id.endswith(DIRECTION) else abs(value)
    alike = np.isclose(value, here, rtol=0, atol=1e-12 * np.nan_to_num(size) + 1e-15, equal_nan=True)
    return "" if alike and abs(degrees - there) < 1e-7 else f"{id} {place}: {value!r} {here!r} at {degrees!r} {there!r}"


def all_differences(machines: Sequence[Machine], ids: Sequence[str]) -> list[str]:
    alone, together = alone_and_together(machines)
    found = [
        differs(id, getattr(one, id), getattr(together, id), place) for place, one in enumerate(alone) for id in ids
    ]
    return [one for one in found if one]


SINGLE = """
speed: {speed} rpm
crank: {crank} m
rod_ratio: {ratio}
offset: {offset} m
masses: {{reciprocating: {mass} kg, rotating: {turning} kg}}
counterweights: [{{product: {product} kg m, angle: 170 deg}}]
"""
VEE = """
speed: {speed} rpm
cylinders:
  - name: A
    axial_position: {offset} m
    crank: {crank} m
    rod_ratio: {ratio}
    masses: {{other: {mass} kg, rotating: {turning} kg}}
  - {{like: A, name: B, bank_angle: 60 deg, crank_position: {late} deg, axial_position: 0.4 m}}
  - {{like: A, name: C, crank_position: 120 deg, axial_position: 0.7 m}}
balance_shafts: [{{order: 2, sense: against, product: {product} kg m, axial_position: 0.1 m}}]
"""
IN_LINE = """
speed: {speed} rpm
cycle: four-stroke
cylinders:
  count: 6
  firing_order: 1-5-3-6-2-4
  spacing: 100 mm
  each: {{crank: {crank} m, rod_ratio: {ratio}, masses: {{reciprocating: {mass} kg}}}}
"""
TWO_CRANKS = """
speed: {speed} rpm
cylinders:
  - name: left
    axial_position: -0.35 m
    crank: {crank} m
    rod_ratio: {ratio}
    masses: {{other: {mass} kg, rotating: {turning} kg}}
  - {{like: left, name: right, crank_position: 90 deg, axial_position: 0.35 m}}
counterweights: {{share: 0.4}}
locomotive: {{wheel_distance: 1.6 m, wheel_diameter: 1.7 m, wheel_load: 80 kN, hammer_limit: 40 kN}}
"""


def machines_of(text: str, count: int, shortest: float) -> list[Machine]:
    random = np.random.default_rng(7)
    ratios = shortest * 10 ** random.uniform(0, 0.6, count)
    numbers = {
        "speed": random.uniform(50, 3000, count),
        "crank": random.uniform(0.03, 0.5, count),
        "ratio": ratios,
        "mass": 10 ** random.uniform(-1, 2, count),
        "turning": 10 ** random.uniform(-1, 2, count),
        "product": 10 ** random.uniform(-2, 1, count),
        "late": random.uniform(0, 360, count),
    }
    numbers["offset"] = numbers["crank"] * (ratios - 1) * random.uniform(-0.7, 0.7, count)
    each = ({name: float(values[k]) for name, values in numbers.items()} for k in range(count))
    return [loads(text.format(**one)) for one in each]


@pytest.mark.parametrize("shortest", [2.0, 1.01])
@pytest.mark.parametrize(
    ("text", "ids"), [(SINGLE, VECTORS), (VEE, VECTORS), (IN_LINE, VECTORS), (TWO_CRANKS, VECTORS)]
)
def test_balance(text: str, ids: Sequence[str], shortest: float) -> None:
    assert all_differences(machines_of(text, 12, shortest), ids) == []


def test_wheels_of_locomotives() -> None:
    machines = machines_of(TWO_CRANKS, 12, 3.0)
    alone, together = (Case(one).balance for one in machines), Case(batch(machines), 12).balance
    found = [
        differs(id, getattr(one, id), getattr(together, id), k) for k, one in enumerate(alone) for id in LOCOMOTIVE
    ]
    assert [one for one in found if one] == []
