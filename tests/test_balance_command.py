"""`kurbel balance` as it is called: its columns, tables, switches, and what it says where it cannot answer."""

from typing import Any

import pytest

from command import answer, printed, run
from representative import CONFIGS

pytestmark = pytest.mark.usefixtures("solved_once")
V90 = """
speed: 600 rpm
cylinders:
  - {name: A, crank: 50 mm, rod_ratio: 4, masses: {reciprocating: 2 kg}}
  - {like: A, name: B, bank_angle: 90 deg, crank_position: 90 deg}
"""


def parsed(name: str, *more: str) -> dict[str, Any]:
    return answer("balance", CONFIGS[name], *more)


def ids(entries: list[dict[str, Any]]) -> list[str]:
    return [one["id"] for one in entries]


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


def test_pins_that_are_not_shared_are_told() -> None:
    apart = V90.replace("bank_angle: 90 deg, crank_position: 90", "bank_angle: 60 deg, crank_position: 90").replace(
        "name: A,", "name: A, axial_position: 0 mm,"
    )
    for result in (run("balance", "-", "--width", "300", text=apart), run("check", "-", text=apart)):
        assert "A and B are at one place along the shaft, but their throws are 30 deg apart" in " ".join(
            result.stdout.split()
        )
    shared = V90.replace("name: A,", "name: A, axial_position: 0 mm,")
    assert "crank pin" not in run("balance", "-", text=shared).stdout


def test_the_counterweights_say_what_they_hold() -> None:
    """Of one crank of 50 mm with 2 kg to and fro and 3 kg on the pin the first holds (3 + 2/2) · 0.05 kg m."""
    one = "speed: 600 rpm\ncrank: 50 mm\nrod_ratio: 4\nmasses: {reciprocating: 2 kg, rotating: 3 kg}\n"
    one += "counterweights: [{product: 1 kg m, angle: 0 deg}, {product: 1 kg m, angle: 180 deg}]\n"
    told = printed("balance", "-", text=one)
    best = next(line for line in told.splitlines() if line.startswith("  u_1 "))
    assert best.split()[1:3] == ["0.2000", "kg"]
    assert "Counterweight balancing all rotating and half of the reciprocating mass" in best
    assert "Vector sum of the given counterweights" in told
