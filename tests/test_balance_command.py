"""`kurbel balance` as it is called: its columns, tables, switches, and what it says where it cannot answer."""

from __future__ import annotations

import itertools
import json
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner, Result

from kurbel.cli import kurbel

pytestmark = pytest.mark.usefixtures("solved_once")
CONFIGS = Path(__file__).parent.parent / "configs"
V90 = """
speed: 600 rpm
cylinders:
  - {name: A, crank: 50 mm, rod_ratio: 4, masses: {reciprocating: 2 kg}}
  - {like: A, name: B, bank_angle: 90 deg, crank_position: 90 deg}
"""


def run(text: str, *more: str) -> Result:
    return CliRunner().invoke(kurbel, ["balance", "-", *more], input=text)


def parsed(name: str, *more: str) -> dict[str, Any]:
    result = CliRunner().invoke(kurbel, ["balance", str(CONFIGS / f"{name}.yaml"), "-f", "json", *more])
    assert (result.exit_code, result.stderr) == (0, "")
    found: dict[str, Any] = json.loads(result.stdout)
    return found


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


def test_what_cancels_prints_as_0() -> None:
    text = CliRunner().invoke(kurbel, ["balance", str(CONFIGS / "boxer.yaml")]).stdout
    assert "  F_max      0    N     at 0°" in text
    rows = [line.split() for line in text.splitlines() if line.startswith("F_x")]
    assert {value for row in rows for value in row[2:]} == {"0"}
    # two equal weights at right angles pass the stroke line together, half way between
    found = parsed("locomotive-two-cylinders", "--angles", "45")["machine_columns"]
    assert {one["id"]: one["values"] for one in found}["F_y"] == [0]


def test_directions_along_an_axis_are_told_as_just_that() -> None:
    """What depends on sin φ alone has waves of odd orders as sines, of even ones as cosines; F₊ and F₋ of what goes to
    and fro along the stroke line meet there, whichever way the cranks stand.
    """
    offset, locomotive = (
        {one["id"]: one["values"] for one in parsed(name)["machine_place_tables"][1]["columns"]}
        for name in ("offset-engine", "locomotive-two-cylinders")
    )
    phases = zip(offset["order"], offset["F_forward_phase"], offset["F_backward_phase"])
    for order, *both in itertools.islice(phases, 1, None):
        assert {abs(one) for one in both} <= ({90} if order % 2 else {0, 180})
    assert {*locomotive["F_direction"]} | {*locomotive["M_direction"]} == {0, None}


def test_the_book_stands_beside_the_exact_only_where_it_is_asked_for() -> None:
    plain, both = parsed("four-in-line"), parsed("four-in-line", "--compare")
    assert "F_free_max_book" not in ids(plain["machine_key_values"])
    values = {one["id"]: one["value"] for one in both["machine_key_values"]}
    assert values["F_free_max_book"] < values["F_free_max"]
    assert "F_x_book" in ids(both["machine_columns"])
    orders = {one["id"]: one["values"] for one in both["machine_place_tables"][0]["columns"]}
    assert orders["F_forward_book"][2] == 0 < orders["F_forward"][2]  # of order 4 the books know nothing


def test_of_thousands_of_orders_the_lowest_are_told_and_the_rest_together() -> None:
    short = "{speed: 600 rpm, crank: 50 mm, rod_ratio: 1.00001, axial_position: 0 mm, masses: {reciprocating: 2 kg}}"
    result = run(short, "--orders", "--width", "200")
    rows = [line.split() for line in result.stdout.splitlines()]
    assert [row[0] for row in rows if len(row) > 4 and row[0].isdigit()][:24] == ["1", *map(str, range(2, 48, 2))]
    (note,) = (line for line in result.stdout.splitlines() if "more orders follow, from n = 48 on" in line)
    assert "together at most " in note
    assert note.endswith(" kN of the force, 0 N m of the moment.")
    assert len(result.stdout.splitlines()) < 100
    assert "more orders" not in run(short.replace("1.00001", "3"), "--orders").stdout


@pytest.mark.parametrize(
    ("text", "left"),
    [
        (V90, "free moments no axial_position given of A, B"),
        (V90.replace("{like: A,", "{crank: 50 mm, rod_ratio: 4,"), "inertia of B no masses given"),
        (V90.replace("speed: 600 rpm", ""), "free forces and moments no speed given"),
        (V90.replace("like: A,", "like: A, offset: 5 mm,"), "figures of first order the book has no such formula"),
    ],
)
def test_what_is_left_out_is_said(text: str, left: str) -> None:
    result = run(text, "--compare", "--width", "200")
    assert (result.exit_code, result.stderr) == (0, "")
    assert left in " ".join(result.stdout.split())


def test_pins_that_are_not_shared_are_told() -> None:
    apart = V90.replace("bank_angle: 90 deg, crank_position: 90", "bank_angle: 60 deg, crank_position: 90").replace(
        "name: A,", "name: A, axial_position: 0 mm,"
    )
    for result in (run(apart, "--width", "300"), CliRunner().invoke(kurbel, ["check", "-"], input=apart)):
        assert "A and B are at one place along the shaft, but their throws are 30 deg apart" in " ".join(
            result.stdout.split()
        )
    shared = V90.replace("name: A,", "name: A, axial_position: 0 mm,")
    assert "crank pin" not in run(shared).stdout


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("{speed: 1 rpm, crank: 50 mm, rod_ratio: 4}", "nothing moves that could be balanced; give 'masses'"),
        ("{crank: 50 mm, rod_ratio: 4, masses: {other: 0 kg}}", "nothing moves that could be balanced"),
        ("effort: {unit: N m, points: [[0, 1], [360, 1]]}", "nothing moves that could be balanced"),
    ],
)
def test_without_masses_there_is_nothing_to_balance(text: str, message: str) -> None:
    result = run(text)
    assert result.exit_code == 2
    assert message in result.stderr


def test_the_counterweights_say_what_they_hold() -> None:
    """Of one crank of 50 mm with 2 kg to and fro and 3 kg on the pin the first holds (3 + 2/2) · 0.05 kg m."""
    one = "speed: 600 rpm\ncrank: 50 mm\nrod_ratio: 4\nmasses: {reciprocating: 2 kg, rotating: 3 kg}\n"
    told = run(one + "counterweights: [{product: 1 kg m, angle: 0 deg}, {product: 1 kg m, angle: 180 deg}]\n").stdout
    best = next(line for line in told.splitlines() if line.startswith("  u_1 "))
    assert best.split()[1:3] == ["0.2000", "kg"]
    assert "Counterweight against what rotates and half of what reciprocates" in best
    assert "Vector sum of the given counterweights" in told


@pytest.mark.parametrize("asked", [["--columns", "F_x"], ["--angles", "30"]])
def test_only_orders_and_what_stands_over_the_angle_exclude_each_other(asked: list[str]) -> None:
    result = CliRunner().invoke(kurbel, ["balance", str(CONFIGS / "boxer.yaml"), "--orders", *asked])
    assert result.exit_code == 2
    assert f"--orders prints nothing over the crank angle; leave it or {asked[0]} out." in result.stderr
