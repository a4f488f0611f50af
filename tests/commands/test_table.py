"""`kurbel table` against the book, against independent formulas, and at its limits."""

import math

import mpmath
import pytest
from hypothesis import given
from hypothesis import strategies as st

from command import answer, run
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
            assert values(report, ratio, ROWS[name])[phi] == pytest.approx(
                float(expected), rel=1e-9, abs=1e-13
            )


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


@pytest.mark.parametrize(
    ("ratio", "c_max", "at", "square"),
    [
        (5, 1.0198331, 79.10014, 78.69007),
        (4.5, 1.0244, 78.02, 77.47),
        (4, 1.0308827, 76.72098, 75.96376),
        (3.2, None, None, None),
    ],
)
def test_where_c_is_largest(ratio: float, c_max: float, at: float, square: float) -> None:
    """c_max of L/R = 5 and 4 is about 1.02 v and 1.03 v in the book (R p. 604), the rod about square to the crank."""
    (table,) = answer("table", "--ratio", str(ratio))["machine_place_tables"]
    figures = {column["id"]: column["values"][0] for column in table["columns"]}
    with mpmath.workdps(40):
        root = mpmath.findroot(lambda phi: textbook(ratio, phi)["b"], 78)
        there = textbook(ratio, root)
        assert figures["phi_b_zero"] == pytest.approx(float(root), rel=1e-13)
        assert figures["c_max_factor"] == pytest.approx(float(there["c"]), rel=1e-13)
        assert figures["x_b_zero"] == pytest.approx(float(there["x"]), rel=1e-13)
    # at the angle of R the crank is square to the rod: their directions are perpendicular
    crank = complex(
        math.cos(math.radians(figures["phi_square"])), math.sin(math.radians(figures["phi_square"]))
    )
    psi = math.asin(crank.imag / ratio)
    rod = complex(math.cos(psi), -math.sin(psi))
    assert (crank * rod.conjugate()).real == pytest.approx(0, abs=1e-15)
    if c_max:
        assert figures["c_max_factor"] == pytest.approx(c_max, abs=5e-5)
        assert figures["phi_b_zero"] == pytest.approx(at, abs=5e-3)
        assert figures["phi_square"] == pytest.approx(square, abs=5e-3)


def test_ratio_written_as_the_books_write_it() -> None:
    """R/L = 1/5 is L/R = 5: the same table, and a note."""
    by_rod, by_crank = (answer("table", "--ratio", text) for text in ("4.5", "1/4.5"))
    assert by_crank["ratios"] == by_rod["ratios"]
    assert by_crank["notes"][0] == "--ratio 1/4.5 is below 1 and was read as R/L: L/R = 4.5."
    assert "notes" not in by_rod


def test_comparison_has_three_decimals_as_the_book() -> None:
    printed = run("table", "--compare", "--digits", "7").stdout
    factors = [line.split() for line in printed.splitlines() if line.startswith("L/R = 5 ")]
    decimals = {
        len(word.rstrip("*").partition(".")[2]) for line in factors for word in line if "." in word
    }
    assert decimals == {3, 5}  # those of angles at seven digits
    assert "cos φ ± R/L cos 2φ" in printed
    assert "sin(φ±ψ)/cos ψ" in printed
