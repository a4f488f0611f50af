"""The slider-crank against its textbook formulas in 50 digits, its closed extremes, and its rules."""

import itertools
import math

import mpmath as mp
import pytest

from kurbel.crank_angle import CrankAngle
from kurbel.mechanisms.link_rod import LinkedPiston
from kurbel.mechanisms.slider_crank import SliderCrank
from machines import one_cylinder


def motion_of(lam):
    return one_cylinder(SliderCrank(lam, 1.0), rpm=60 / math.tau).motion


@pytest.mark.parametrize("lam", [1e-8, 0.2, 0.25, 0.7, 0.99, 1 - 1e-4])
def test_largest_velocity(lam):
    """At the zero of b: sin²ψ = q with q³ − q² − q + λ² = 0, and c = v sin φ (1 + q)."""
    exact = mp.mpf(lam)
    with mp.workdps(60):
        q = mp.findroot(
            lambda q: q**3 - q**2 - q + exact**2,
            (mp.mpf(0), mp.mpf(1)),
            solver="anderson",
            tol=1e-90,
        )
        wanted, at = (
            exact * mp.sqrt(q / exact**2) * (1 + q),
            mp.degrees(mp.asin(mp.sqrt(q / exact**2))),
        )
    result = motion_of(lam)
    assert result.c_max.value == pytest.approx(float(wanted), rel=1e-13)
    assert result.c_max.degrees == pytest.approx(float(at), abs=1e-9)
    assert result.c_min.value == pytest.approx(-result.c_max.value, rel=1e-13)


@pytest.mark.parametrize("lam", [0.2, 0.25, 0.2638, 0.3, 0.5, 0.7, 0.881, 0.99])
def test_smallest_acceleration(lam):
    """Beyond λ = (√21 − 3)/6 = 0.263763 within the stroke, where 3y(1 − y)(1 + y)² = ρ for y = −λ cos φ/cos ψ."""
    exact, result = mp.mpf(lam), motion_of(lam).b_min
    if lam < (math.sqrt(21) - 3) / 6:
        assert (result.value, result.degrees) == (pytest.approx(lam * (lam - 1), rel=1e-13), 180.0)
        return
    rho = 1 - exact**2
    y = mp.findroot(
        lambda y: 3 * y * (1 - y) * (1 + y) ** 2 - rho, (mp.mpf(0), exact), solver="anderson"
    )
    kappa = mp.sqrt(rho / (1 - y**2))
    cos = -y * kappa / exact
    wanted = exact * (cos * (kappa + exact * cos) / kappa - exact * rho * (1 - cos**2) / kappa**3)
    assert result.value == pytest.approx(float(wanted), rel=1e-12)


@pytest.mark.parametrize(
    ("offset", "by_ratio"), [*itertools.product((0.0, 0.02, -0.1), (True, False))]
)
def test_the_stroke_gives_the_crank(offset, by_ratio):
    size = {"rod_ratio": 4.0} if by_ratio else {"rod": 1.2}
    machine = SliderCrank.from_keys(stroke=0.6, offset=offset, **size)
    assert machine.stroke == pytest.approx(0.6, rel=1e-14)
    assert not by_ratio or machine.rod / machine.crank == pytest.approx(4, rel=1e-15)


@pytest.mark.parametrize("offset", [0.05, -0.3])
def test_displacement_keeps_its_digits_near_the_inner_dead_centre(offset: float) -> None:
    """A thousandth of a degree away it is 1e-10 of the crank, of which small clearances need every digit."""
    mechanism, degrees = (
        SliderCrank(0.4, 2.0, offset),
        SliderCrank(0.4, 2.0, offset).dead_centres()[0] + 1e-3,
    )
    with mp.workdps(40):
        R, L, e, phi = mp.mpf(0.4), mp.mpf(2), mp.mpf(offset), mp.radians(mp.mpf(degrees))
        true = (
            mp.sqrt((L + R) ** 2 - e**2)
            - R * mp.cos(phi)
            - mp.sqrt(L**2 - (R * mp.sin(phi) - e) ** 2)
        )
    assert float(mechanism.coordinate(CrankAngle.of(degrees))) == pytest.approx(
        float(true), rel=1e-9
    )


@pytest.mark.parametrize("lam", [0.6, 0.25, 1e-4])
def test_the_errors_of_the_first_order_against_60_digits(lam):
    """Without the cancellation of a difference: at λ = 1e-4 that of x is 1e-13 R."""
    degrees = [17.0, 90.0, 123.0, 301.0]
    state = one_cylinder(SliderCrank(lam, 1.0), rpm=60 / math.tau).at(degrees)
    with mp.workdps(60):
        ratio = mp.mpf(lam)

        def missing(phi):
            exact = (1 - mp.sqrt(1 - (ratio * mp.sin(phi)) ** 2)) / ratio
            return ratio * (ratio * mp.sin(phi) ** 2 / 2 - exact)

        for order, id in enumerate(("x_error", "c_error", "b_error")):
            wanted = [float(mp.diff(missing, mp.radians(angle), order)) for angle in degrees]
            # c is zero at 90 deg
            assert state[id] == pytest.approx(wanted, rel=1e-12, abs=1e-12 * lam**4)


def test_link_rods_have_neither_approximations_nor_errors_of_them():
    offered = [offer.quantity.id for offer in LinkedPiston.OFFERS]
    assert not [id for id in offered if id.endswith(("_book", "_error"))]
