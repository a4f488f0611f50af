"""`kurbel balance` as it is called: its columns, tables, switches, and what it says where it cannot answer."""

import json
import re
from typing import Any

import numpy as np
import pytest

from command import answer, printed, run
from representative import CONFIGS


def parsed(name: str, *more: str) -> dict[str, Any]:
    return answer("balance", CONFIGS[name], *more)


def ids(entries: list[dict[str, Any]]) -> list[str]:
    return [entry["id"] for entry in entries]


def test_columns_and_tables_have_the_names_that_are_relied_on() -> None:
    result = parsed("four-in-line")
    assert ids(result["machine_columns"]) == ["phi", "F_x", "F_y", "M_x", "M_y", "M_roll"]
    orders = next(table for table in result["machine_place_tables"] if table["id"] == "orders")
    assert ids(orders["columns"])[:3] == ["order", "F_forward", "F_backward"]
    assert {"M_forward", "M_backward"} < set(ids(orders["columns"]))
    assert orders["columns"][0]["values"][:3] == [1, 2, 4]
    assert orders["columns"][1]["values"][0] == 0
    named = {"F_free_max", "M_free_max", "counterweight_best", "F_free_best"}
    assert named < set(ids(result["machine_key_values"]))
    assert (
        next(column["values"][-1] for column in result["machine_columns"] if column["id"] == "phi")
        == 360
    )


def test_names_of_weights_are_words_for_programs_and_texts_for_people() -> None:
    three = (
        "speed: 60 rpm\ncylinders: {count: 3, spacing: 100 mm, firing_order: 1-2-3, "
        "each: {stroke: 100 mm, rod_ratio: 4, masses: {reciprocating: 1 kg}}}"
    )
    whole = json.loads(run("balance", "-", "-f", "json", text=three).stdout)
    (best,) = [table for table in whole["machine_place_tables"] if table["id"] == "best_weights"]
    assert "shaft_n_1_against_the_crank_A" in [row["weight"] for row in best["rows"]]
    assert all(re.fullmatch(r"\w+", row["weight"]) for row in best["rows"])
    assert "shaft n = 1, against the crank: A" in run("balance", "-", text=three).stdout


def test_directions_of_symmetrical_machines_are_exactly_those_of_their_symmetry() -> None:
    """Forces along the stroke line, or the middle of two banks, have its direction, whatever rounding adds."""
    for name, exact in (("marine-diesel", 0.0), ("triplex-pump", 0.0), ("four-in-line", 0.0)):
        assert set(directions(name, "F_direction")) == {exact}
    assert set(directions("triplex-pump", "M_direction")) == {0.0}
    assert directions("v8-cross-plane", "F_direction") == pytest.approx([45.0] * 3, abs=1e-12)


def directions(name: str, column: str) -> list[float]:
    """Directions of the orders that a machine has, in degrees."""
    tables = parsed(name, "--orders")["machine_place_tables"]
    (ellipses,) = [table for table in tables if table["id"] == "ellipses"]
    (values,) = [one["values"] for one in ellipses["columns"] if one["id"] == column]
    return [value for value in values if value is not None]


# weights as a designer types them back

FIVE_CYLINDERS = """
speed: 1500 rpm
cycle: four-stroke
cylinders:
  count: 5
  firing_order: 1-2-4-5-3
  spacing: 97.3 mm
  each: {crank: 43.2 mm, rod: 151.7 mm, masses: {reciprocating: 0.613 kg, rotating: 0.871 kg}}
"""


V_OF_FIVE = """
speed: 241.936 rpm
cycle: four-stroke
cylinders:
  - {name: first, crank: 135.12 mm, rod: 303.133 mm, masses: {piston: 131.391 kg}}
  - like: first
  - {like: first, bank_angle: 90 deg}
  - like: first
  - like: first
firing_order: 5-3-2-1-4
"""


def test_a_force_along_a_line_has_an_ellipse_without_width() -> None:
    """Cranks every 144°: four pistons in line lack the fifth, whose crank is in the other line; what is left is a line."""
    document = answer("balance", "-", "--orders", text=V_OF_FIVE)
    tables = {table["id"]: table for table in document["machine_place_tables"]}
    columns = {column["id"]: column["values"] for column in tables["ellipses"]["columns"]}
    assert columns["F_long"][0] > 10_000
    assert set(columns["F_short"]) == {0.0}


def typed_back(text: str, units: str) -> str:
    """Return the file with the best weights as they are printed for people."""
    page = printed("balance", "-", "--units", units, "-f", "markdown", text=text)
    rows = re.findall(
        r"^\| (counterweight|shaft n = (\d), (with|against) the crank):? [AB] "
        r"\| (\S+) \| (\S+) \| (\S+) \|$",
        page,
        re.MULTILINE,
    )
    length, product = {"metric": ("mm", "kg m"), "imperial": ("in", "lb in")}[units]
    weights, shafts = [], []
    for what, order, sense, place, size, angle in rows:
        keys = f"product: {size} {product}, angle: {angle} deg, axial_position: {place} {length}"
        if what == "counterweight":
            weights.append(f"{{{keys}}}")
        else:
            shafts.append(f"{{{keys}, order: {order}, sense: {sense}}}")
    assert len(weights) == 2
    assert len(shafts) == 6
    return f"{text}counterweights: [{', '.join(weights)}]\nbalance_shafts: [{', '.join(shafts)}]\n"


@pytest.mark.parametrize("units", ["metric", "imperial"])
def test_weights_as_they_are_printed_balance_as_computed(units: str) -> None:
    """Counterweights and shafts cancel the moments of orders 1 and 2; of five cranks the next one is of order 4."""
    moments = []
    for text in (FIVE_CYLINDERS, typed_back(FIVE_CYLINDERS, units)):
        orders = answer("balance", "-", text=text)["machine_place_tables"][0]
        columns = {column["id"]: column["values"] for column in orders["columns"]}
        moments.append([columns["M_forward"][:2], columns["M_backward"][:2]])
    before, after = np.array(moments)
    assert np.abs(after).max() < 5e-6 * np.abs(before).max()
    assert before.min() > 1e-3 * before.max()
