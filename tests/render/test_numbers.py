"""Laws of number formatting."""

import math

import pytest
from hypothesis import given
from hypothesis import strategies as st

from kurbel.render.text import angle_scale, cell, rounded, scale_of, single

FINITE = st.floats(allow_nan=False, allow_infinity=False)
ROW = st.lists(FINITE, min_size=1, max_size=8)


@given(ROW, st.integers(1, 17))
def test_a_cell_is_within_half_a_unit_of_its_last_decimal(row: list[float], digits: int) -> None:
    scale = scale_of(row, digits)
    for value in row:
        shown = float(cell(value, scale)) * 10.0**scale.exponent if abs(scale.exponent) < 300 else None
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
    assert [cell(value, scale_of(row)) for value in row] == cells


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
def test_a_value_that_stands_alone(value: float, shown: tuple[str, int]) -> None:
    assert single(value) == shown


@pytest.mark.parametrize(("angles", "decimals"), [([0, 10.0], 0), ([0, 7.5], 1), ([1 / 3], 6), ([], 0), ([None], 0)])
def test_angles_have_the_decimals_they_need(angles: list[float], decimals: int) -> None:
    assert angle_scale(angles).decimals == decimals
