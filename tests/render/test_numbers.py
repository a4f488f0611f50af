"""Laws of number formatting."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from kurbel.render import Look
from kurbel.render.text import angle_scale, cell, digit_scale, head_scale, rounded, single
from kurbel.render.text_tables import place_table
from kurbel.tables.tables import Column, PlaceTable

FINITE = st.floats(allow_nan=False, allow_infinity=False)
ROW = st.lists(FINITE, min_size=1, max_size=8)


@given(ROW, st.integers(1, 17))
def test_a_cell_is_within_half_a_unit_of_its_last_decimal(row: list[float], digits: int) -> None:
    scale = digit_scale(row, digits)
    for value in row:
        shown = (
            float(cell(value, scale)) * 10.0**scale.exponent if abs(scale.exponent) < 300 else None
        )
        if shown is not None:
            unit = 10.0 ** (scale.exponent - scale.decimals)
            assert abs(shown - value) <= 0.5 * unit * (1 + 1e-6) + 4 * math.ulp(value)


@given(FINITE, st.integers(0, 6))
def test_no_negative_zero(value: float, decimals: int) -> None:
    from kurbel.render.text import Scale

    shown = cell(value, Scale(decimals))
    assert not (shown.startswith("-") and float(shown) == 0)
    assert not str(rounded(value * 0, None)).startswith("-")


@pytest.mark.parametrize(
    ("row", "cells"),
    [
        # Zusammenstellung 112: three decimals
        ([1.2, -0.01429, 0.0, None], ["1.200", "-0.014", "0", ""]),
        ([154321.4, -0.2], ["154321", "0"]),
        ([2.4e7, -1e5], ["24.00", "-0.10"]),
        ([9.9999e6], ["10.00"]),
        ([3.2e-7], ["320.0"]),
        ([999.96], ["1000"]),
        ([0.0123449], ["0.01234"]),
    ],
)
def test_rows_as_an_engineer_writes_them(row: list[float | None], cells: list[str]) -> None:
    assert [cell(value, digit_scale(row)) for value in row] == cells


@pytest.mark.parametrize(
    ("value", "shown"),
    [
        (0.8, ("0.8000", 0)),
        (2.4e7, ("2.400", 7)),
        (-1.1e-16, ("-1.100", -16)),
        (5e-324, ("4.941", -324)),
        (36, ("36", 0)),
    ],
)
def test_a_value_that_is_alone(value: float, shown: tuple[str, int]) -> None:
    assert single(value) == shown


WRITTEN = [([0, 10.0], 0), ([0, 7.5], 1), ([0.000001], 6), ([], 0), ([None], 0)]
COMPUTED = [([1 / 3], 2), ([100 / 3, 200 / 3, 360.0], 2), ([1 / 3, 1 / 3 + 1e-4], 4)]


@pytest.mark.parametrize(("angles", "decimals"), [*WRITTEN, *COMPUTED])
def test_crank_angles_have_the_decimals_they_need(angles: list[float], decimals: int) -> None:
    """Written ones keep their decimals; computed ones have two, more only where they would be alike."""
    assert head_scale(angles).decimals == decimals


def test_angles_have_the_digits_that_are_wanted() -> None:
    assert head_scale([100 / 3, 200 / 3], 5).decimals == 3
    assert head_scale([22.5], 6).decimals == 1
    assert angle_scale([79.100135, 180.0]).decimals == 1
    assert angle_scale([79.100135, 180.0], 6).decimals == 3
    assert angle_scale([180.0], 1).decimals == 0


def rows(*values: float | None) -> PlaceTable:
    names = tuple((f"row {number}",) for number in range(len(values)))
    torque = Column("M", "M", "M", "kN m", values)
    reference = Column("W", "W", "W", "kN m", (64.07,) * len(values))
    return PlaceTable("torques", "Torques", ("row",), names, (torque, reference))


@pytest.mark.parametrize(
    ("values", "cells"),
    [
        ((17.34, -4.6), ["17.34", "-4.60"]),
        ((17.34, 0.004), ["17.340", "0.004"]),
        ((17.34, -0.00032), ["17.3400", "-0.0003"]),
        ((17.34, 2e-7), ["17.34", "2.000·10⁻⁷"]),
        ((17.34, 0.0, None), ["17.34", "0", "–"]),
        ((17.34, 1e-14), ["17.34", "0"]),  # a rounding error
        ((0.0, 0.0), ["0", "0"]),
    ],
)
def test_no_value_of_a_table_of_places_is_printed_as_zero(
    values: tuple[float | None, ...], cells: list[str]
) -> None:
    _, torque, reference = place_table(rows(*values), Look()).columns
    assert torque.cells == cells
    assert set(reference.cells) == {"64.07"}
