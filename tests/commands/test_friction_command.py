"""`kurbel friction`: the inclined plane by Redtenbacher's own cases, by statics, and by its limits."""

import json
import math
from typing import Any

import pytest

from command import run


def answer(incline: float, coefficient: float, *words: str) -> dict[str, Any]:
    result = run(
        "friction",
        "--incline",
        str(incline),
        "--coefficient",
        str(coefficient),
        *words,
        "-f",
        "json",
    )
    assert result.exit_code == 0, result.output
    return json.loads(result.stdout)


def forces(found: dict[str, Any]) -> dict[str, list[float | None]]:
    (table,) = found["machine_place_tables"]
    return {column["id"]: column["values"] for column in table["columns"]}


def test_level_force_is_the_tangent_of_both_angles() -> None:
    """D 3: P = Q tan(α + ρ) moves it up, P_1 = Q tan(α − ρ) holds it, tan ρ = f; along the plane sin α ± f cos α."""
    rho = math.atan(0.1)
    (table,) = answer(30, 0.1)["machine_place_tables"]
    assert [column["symbol"] for column in table["columns"]] == ["P/Q", "P_1/Q"]
    result = forces(answer(30, 0.1))
    alpha = math.radians(30)
    assert result["P_up"] == pytest.approx(
        [0.5 + 0.1 * math.cos(alpha), math.tan(alpha + rho)], rel=1e-14
    )
    assert result["P_held"] == pytest.approx(
        [0.5 - 0.1 * math.cos(alpha), math.tan(alpha - rho)], rel=1e-14
    )


@pytest.mark.parametrize("direction", [-20.0, 10.0, 45.0])
def test_statics_of_the_body(direction: float) -> None:
    """Along the plane P cos β = Q sin α ± f N, across it N = Q cos α − P sin β."""
    result = forces(answer(30, 0.2, "--direction", str(direction)))
    alpha, beta = math.radians(30), math.radians(direction)
    for id, friction in (("P_up", 0.2), ("P_held", -0.2)):
        force = result[id][0]
        pressing = math.cos(alpha) - force * math.sin(beta)
        assert pressing > 0
        assert force * math.cos(beta) == pytest.approx(
            math.sin(alpha) + friction * pressing, rel=1e-13
        )


def test_limits() -> None:
    """D 4: nothing holds it at tan α = f; D 5: no level force moves it up at tan α = 1/f."""
    at_rest = forces(answer(45, 1.0))
    assert at_rest["P_held"] == pytest.approx([0, 0], abs=1e-15)
    locked = answer(60, 0.7)
    assert forces(locked)["P_up"][1] is None
    assert locked["machine_left_out"][0]["what"] == "P/Q horizontal"
    assert forces(answer(20, 0.0))["P_up"] == forces(answer(20, 0.0))["P_held"]
