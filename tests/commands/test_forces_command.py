"""`kurbel forces` and `kurbel check` as a user calls them."""

import pytest

from command import answer
from good_machines import DEMO
from representative import CONFIGS

WATERWORKS = str(CONFIGS["waterworks"])


def cylinder(parsed: dict[str, object], index: int = 0) -> dict[str, list[dict[str, object]]]:
    return parsed["cylinders"][index]


def key_value(part: dict[str, list[dict[str, object]]], name: str) -> dict[str, object]:
    return next(key_value for key_value in part["key_values"] if key_value["id"] == name)


def test_demo_machine_of_the_contract() -> None:
    parsed = answer("forces", "-", text=DEMO)
    assert parsed["command"] == "forces"
    assert parsed["machine"] == "Demo steam engine"
    part = cylinder(parsed)
    assert [c["id"] for c in part["columns"]][:6] == ["phi", "psi", "x", "c", "b", "p_head"]
    assert part["columns"][0]["values"] == list(range(0, 361, 10))
    assert key_value(part, "b_max")["value"] == pytest.approx(13.16, abs=5e-3)
    assert key_value(part, "b_max")["at_deg"] == 0
    assert {"what": "friction", "why": "no friction given"} in part["left_out"]
    assert part["warnings"] == []


def test_key_values_do_not_depend_on_the_step() -> None:
    first, second = (
        cylinder(answer("forces", WATERWORKS, "--step", step)) for step in ("10", "0.7")
    )
    assert first["key_values"] == second["key_values"]


def test_technical_units_show_the_figures_of_the_book() -> None:
    """Waterworks engine: 1546,3 cm², about 1115 kg of inertia (with 826 kg instead of 830), pump 3490 and 3710 kg."""
    part = cylinder(answer("forces", WATERWORKS, "--units", "technical", "--angles", "90,270"))
    assert key_value(part, "A_head")["value"] == pytest.approx(1546.3, abs=0.05)
    assert key_value(part, "A_head")["unit"] == "cm^2"
    assert key_value(part, "P_inertia_min")["value"] == pytest.approx(-1115 * 826 / 830, rel=2e-3)
    assert key_value(part, "stroke")["value"] == pytest.approx(800, rel=1e-15)
