"""`kurbel balance` as it is called: its columns, tables, switches, and what it says where it cannot answer."""

from typing import Any

import pytest

from command import answer
from representative import CONFIGS

pytestmark = pytest.mark.usefixtures("solved_once")


def parsed(name: str, *more: str) -> dict[str, Any]:
    return answer("balance", CONFIGS[name], *more)


def ids(entries: list[dict[str, Any]]) -> list[str]:
    return [entry["id"] for entry in entries]


def test_columns_and_tables_have_the_names_that_are_relied_on() -> None:
    found = parsed("four-in-line")
    assert ids(found["machine_columns"]) == ["phi", "F_x", "F_y", "M_x", "M_y", "M_roll"]
    orders = next(one for one in found["machine_place_tables"] if one["id"] == "orders")
    assert ids(orders["columns"])[:3] == ["order", "F_forward", "F_backward"]
    assert {"M_forward", "M_backward"} < set(ids(orders["columns"]))
    assert orders["columns"][0]["values"][:3] == [1, 2, 4]
    assert orders["columns"][1]["values"][0] == 0
    named = {"F_free_max", "M_free_max", "counterweight_best", "F_free_best"}
    assert named < set(ids(found["machine_key_values"]))
    assert next(one["values"][-1] for one in found["machine_columns"] if one["id"] == "phi") == 360
