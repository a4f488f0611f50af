"""`kurbel harmonics` and `kurbel torsion` as their users call them: formats, options, and what they refuse."""

from typing import Any

import pytest

from command import answer
from representative import CONFIGS

BLOWER, SHIP = (str(CONFIGS[name]) for name in ("coupled-blower", "marine-diesel"))


def table(found: dict[str, Any], id: str) -> dict[str, list[Any]]:
    one = next(table for table in found["machine_place_tables"] if table["id"] == id)
    return {column["id"]: column["values"] for column in one["columns"]}


def test_the_columns_that_scripts_rely_on() -> None:
    orders = table(answer("harmonics", BLOWER), "orders")
    assert list(orders) == [
        "order",
        "M_cos",
        "M_sin",
        "M_amplitude",
        "M_phase",
        "M_gas",
        "M_inertia",
    ]
    assert orders["order"] == list(range(1, 25))
    result = answer("torsion", SHIP)
    assert [table["id"] for table in result["machine_place_tables"]] == [
        "modes",
        "holzer",
        "critical_speeds",
        "pieces",
    ]
    modes, critical = table(result, "modes"), table(result, "critical_speeds")
    assert list(modes)[:2] == ["mode", "frequency"]
    assert list(critical)[:3] == ["order", "mode", "speed"]
    assert (modes["mode"][:2], modes["frequency"][0]) == ([0, 1], 0)
    assert critical["order"] == list(range(1, 13)) * 3
    for order, mode, speed in zip(critical["order"], critical["mode"], critical["speed"]):
        assert speed == pytest.approx(modes["frequency"][int(mode)] / order, rel=1e-15)
    assert all(
        isinstance(column["unit"], str) for column in result["machine_place_tables"][0]["columns"]
    )


def test_half_orders_of_four_strokes() -> None:
    result = answer("harmonics", str(CONFIGS["four-cylinder-generator"]))
    assert table(result, "orders")["order"] == [half / 2 for half in range(1, 49)]
    marks = result["machine_place_tables"][0]["rows"]
    assert [index / 2 + 0.5 for index, mark in enumerate(marks) if mark["kind"] == "major"] == list(
        range(2, 25, 2)
    )
    assert len(result["cylinders"]) == 4


def test_orders_over_the_speed() -> None:
    result = table(
        answer("harmonics", BLOWER, "--speeds", "75, 150 rpm", "--orders", "1,3"), "orders_by_speed"
    )
    assert (result["speed"], result["order"]) == ([1.25, 1.25, 2.5, 2.5], [1, 3, 1, 3])
    slow = table(answer("harmonics", BLOWER, "--set", "speed=75 rpm", "--orders", "1,3"), "orders")
    assert result["M_cos"][:2] == pytest.approx(slow["M_cos"], rel=1e-12)


def test_every_piece_over_the_angle() -> None:
    result = answer("torsion", SHIP, "--columns", "M_shaft,tau", "--step", "1")
    pieces = result["cylinders"]
    assert len(pieces) == 8
    shown = table(result, "pieces")
    for number, piece in enumerate(pieces):
        columns = {column["id"]: column["values"] for column in piece["columns"]}
        assert max(columns["M_shaft"]) == pytest.approx(shown["M_shaft_max"][number], rel=1e-2)
        assert max(columns["M_shaft"]) <= shown["M_shaft_max"][number]
        stressed = [one / two for one, two in zip(columns["M_shaft"], columns["tau"])]
        assert min(stressed) == pytest.approx(max(stressed), rel=1e-12)


def test_over_the_speed_the_critical_one_is_the_worst() -> None:
    result = answer("torsion", BLOWER, "--speeds", "60:90:1 rpm", "--orders", "3")
    speeds, critical = table(result, "speeds"), table(result, "critical_speeds")
    worst = max(range(31), key=speeds["M_vibratory"].__getitem__)
    assert speeds["speed"][worst] == pytest.approx(critical["speed"][0], abs=1.5 / 60)
    assert len(speeds["speed"]) == 31
