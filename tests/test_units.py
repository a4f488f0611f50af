"""Units by their definitions, and what is said about texts that are no quantity."""

from __future__ import annotations

import math

import pytest

from kurbel.declared.numerals import parse_number
from kurbel.declared.units import SI, TECHNICAL, convert, parse_quantity, show, unit_names
from kurbel.errors import UnitError

G = 9.80665  # m/s², standard gravity by definition (3rd CGPM 1901)


@pytest.mark.parametrize(
    ("text", "kind", "value"),
    [
        ("450 mm", "length", 0.45),
        ("0.1 cm", "length", 0.001),
        ("1 in", "length", 0.0254),  # 1959 yard and pound agreement
        ("1 ft", "length", 0.3048),
        ("1 lb", "mass", 0.45359237),
        ("1 at", "pressure", 98066.5),  # 1 kgf/cm²
        ("1 kgf/cm2", "pressure", 98066.5),
        ("1 kp/cm²", "pressure", 98066.5),
        ("1 atm", "pressure", 101325.0),  # 10th CGPM 1954
        ("760 Torr", "pressure", 101325.0),
        ("12 bar", "pressure", 12e5),
        ("1 N/mm2", "pressure", 1e6),
        ("1 kgf", "force", G),
        ("1 kp", "force", G),
        ("1 PS", "power", 735.49875),  # 75 kgf m/s
        ("1 kgf m", "torque", G),
        ("1 Nm", "torque", 1.0),
        ("1 N m", "torque", 1.0),
        ("120 rpm", "speed", 2.0),
        ("120 1/min", "speed", 2.0),
        ("120 U/min", "speed", 2.0),
        ("2 Hz", "speed", 2.0),
        ("90 deg", "angle", 90.0),
        ("90°", "angle", 90.0),
        ("4 kgf m2", "gd2", 4.0),
        ("4 kg m2", "gd2", 4.0),
        ("1 kg m²", "inertia", 1.0),
        ("1 kg·m^2", "inertia", 1.0),
        ("1 kg*m2", "inertia", 1.0),
        ("10000 kg cm2", "inertia", 1.0),
        ("6 m/s", "velocity", 6.0),
        ("6 m / s", "velocity", 6.0),
        ("25 kgf m/s/cm2", "pressure_velocity", 25 * G * 1e4),
        ("-0.45 at", "pressure", -44129.925),
        (" 1e3  mm ", "length", 1.0),
        (".5 m", "length", 0.5),
    ],
)
def test_values_by_definition(text: str, kind: str, value: float) -> None:
    assert parse_quantity(text, kind) == value


def test_psi_and_horsepower_by_definition() -> None:
    pound_force = 0.45359237 * G
    assert parse_quantity("1 psi", "pressure") == pytest.approx(pound_force / 0.0254**2, rel=1e-15)
    assert parse_quantity("1 hp", "power") == pytest.approx(550 * pound_force * 0.3048, rel=1e-15)


def test_radians() -> None:
    assert parse_quantity(f"{math.pi!r} rad", "angle") == 180.0
    assert parse_quantity(f"{2 * math.pi!r} rad/s", "speed") == 1.0


@pytest.mark.parametrize(
    ("text", "kind", "message"),
    [
        ("450", "length", "450 has no unit; write it with one, such as '450 mm'"),
        ("1,5 bar", "pressure", "'1,5 bar' has a decimal comma; write 1.5 bar"),
        ("1,234.5 mm", "length", "'1,234.5 mm' has commas between thousands; leave them out"),
        ("12 kg", "force", "unknown force unit 'kg' (known: N, kN, MN, kgf, kp, tf, lbf); kg is a unit of mass"),
        ("mm", "length", "expected a number with its unit, such as '450 mm', got 'mm'"),
        ("010 mm", "length", "expected a number with its unit, such as '450 mm', got '010 mm'"),
        ("1e400 mm", "length", "1e400 mm is too large to compute with"),
    ],
)
def test_messages_of_quantities(text: str, kind: str, message: str) -> None:
    with pytest.raises(UnitError) as caught:
        parse_quantity(text, kind)
    assert str(caught.value) == message


@pytest.mark.parametrize("unit", ["barg", "bara", "atü", "ata", "psig"])
def test_gauge_is_no_unit(unit: str) -> None:
    with pytest.raises(UnitError, match="said by the key 'pressures'"):
        parse_quantity(f"12 {unit}", "pressure")


@pytest.mark.parametrize(("text", "value"), [("5", 5.0), ("-1.5", -1.5), ("1e3", 1000.0), (".5", 0.5), ("5.", 5.0)])
def test_numbers(text: str, value: float) -> None:
    assert parse_number(text) == value


@pytest.mark.parametrize(
    ("text", "hint"),
    [
        ("4,5", "write the decimal point: 4.5"),
        ("1,234.5", "write it without commas between thousands"),
        ("1_000", "leave out the underscores"),
        ("010", "leave out the leading zero"),
        ("1:5", "a ratio is written as one number"),
        ("1/200", "write it as one number: 0.005"),
        ("85 %", "write it as a fraction: 0.85"),
        (".inf", "it must be finite"),
        ("5 mm", "it has no unit, write 5"),
    ],
)
def test_hints_of_numbers(text: str, hint: str) -> None:
    with pytest.raises(UnitError) as caught:
        parse_number(text)
    assert hint in str(caught.value)


@pytest.mark.parametrize("kind", [kind for kind in SI if kind != "ratio"])
def test_every_shown_unit_can_be_read_back(kind: str) -> None:
    for system in (SI, TECHNICAL):
        assert parse_quantity(f"1 {system[kind]}", kind) > 0


@pytest.mark.parametrize("kind", [kind for kind in SI if kind != "ratio"])
def test_every_unit_is_positive_and_finite(kind: str) -> None:
    for unit in unit_names(kind):
        assert 0 < parse_quantity(f"1 {unit}", kind) < math.inf


def test_convert_to_the_engineers_units() -> None:
    assert convert(98066.5, "pressure", "technical") == 1.0
    assert convert(G, "force", "technical") == 1.0
    assert convert(0.45, "length", "technical") == 450.0
    assert convert(0.45, "length") == 0.45


def test_show() -> None:
    assert show(0.3, "length") == "300 mm"
    assert show(5.4e5, "pressure") == "5.4 bar"
