"""`kurbel table` against the book, against independent formulas, and at its limits."""

import math

import mpmath
import pytest
from hypothesis import given
from hypothesis import strategies as st

from command import answer
from kurbel.report.zusammenstellung import ROWS, zusammenstellung
from kurbel.tables.tables import Report


def values(report: Report, ratio: float, row: str) -> dict[float, float]:
    part = next(part for part in report.parts if part.name == ratio)
    phi, column = part.columns[0], next(column for column in part.columns if column.id == row)
    return dict(zip(phi.values, column.values))


RATIO = st.floats(1.001, 1e6)
PHI = st.floats(0, 180)


def textbook(ratio: float, phi: float) -> dict[str, mpmath.mpf]:
    """The formulas as R 285 to 303 print them, in 60 digits."""
    angle, lam = mpmath.radians(mpmath.mpf(phi)), 1 / mpmath.mpf(ratio)
    psi = mpmath.asin(lam * mpmath.sin(angle))
    cos_psi = mpmath.cos(psi)
    return {
        "b": mpmath.cos(angle + psi) / cos_psi + lam * mpmath.cos(angle) ** 2 / cos_psi**3,
        "c": mpmath.sin(angle + psi) / cos_psi,
        "x": 1 - mpmath.cos(angle) + (1 - cos_psi) / lam,
        "psi": mpmath.degrees(psi),
        "S": 1 / cos_psi,
        "N": mpmath.tan(psi),
        "D": mpmath.cos(angle + psi) / cos_psi,
        "T_b": -(mpmath.cos(angle + psi) / cos_psi + lam * mpmath.cos(angle) ** 2 / cos_psi**3)
        * (mpmath.sin(angle + psi) / cos_psi),
        "x/s": (1 - mpmath.cos(angle) + (1 - cos_psi) / lam) / 2,
    }


@given(RATIO, PHI)
def test_exact_rows_against_the_textbook_formulas(ratio: float, phi: float) -> None:
    report = zusammenstellung((ratio,), tuple(ROWS), (phi,), "exact")
    with mpmath.workdps(60):
        for name, expected in textbook(ratio, phi).items():
            assert values(report, ratio, ROWS[name])[phi] == pytest.approx(float(expected), rel=1e-9, abs=1e-13)


@given(RATIO, PHI)
def test_first_order_rows(ratio: float, phi: float) -> None:
    report = zusammenstellung((ratio,), ("b", "c", "x"), (phi,), "first-order")
    angle = math.radians(phi)
    # R 291, B 25, R 286
    assert values(report, ratio, "acceleration_factor")[phi] == pytest.approx(
        math.cos(angle) + math.cos(2 * angle) / ratio, abs=1e-14
    )
    assert values(report, ratio, "velocity_factor")[phi] == pytest.approx(
        math.sin(angle) + math.sin(2 * angle) / (2 * ratio), abs=1e-14
    )
    assert values(report, ratio, "displacement_factor")[phi] == pytest.approx(
        1 - math.cos(angle) + math.sin(angle) ** 2 / (2 * ratio), abs=1e-14
    )


@pytest.mark.parametrize("ratio", ["1.0000000000000002", "1e300", "1.7976931348623157e308"])
def test_extreme_ratios_stay_finite(ratio: str) -> None:
    content = answer("table", "--ratio", ratio, "--rows", "b,c,x,psi,S,N,D,T_b,x/s")
    for column in content["ratios"][0]["columns"]:
        assert all(math.isfinite(value) for value in column["values"])
