"""The slider-crank against its textbook formulas in 50 digits, its closed extremes, and its rules."""

from __future__ import annotations

import itertools
import math
import random

import mpmath as mp
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from precise import exact_angle, ulps

from kurbel.crank_angle import CrankAngle
from kurbel.errors import RuleError
from kurbel.mechanisms.slider_crank import SliderCrank
from machines import one_cylinder
from representative import few

RATIOS = (1e-12, 1e-8, 1e-3, 0.2, 0.25, 0.7, 0.99, 1 - 1e-4, 1 - 1e-8, 1 - 1e-12)
BESIDE = [centre + step for centre in (0, 90, 180, 270, 360) for step in (-1e-3, -1e-7, -1e-13, 1e-13, 1e-7, 1e-3)]
ANYWHERE = random.Random(7)
ANGLES = [*map(float, range(0, 360, 15)), *BESIDE, *(ANYWHERE.uniform(-720, 720) for _ in range(150))]


def textbook(machine, degrees):
    """x, c/ω, b/ω² and cos ψ as R 285, 288 and the exact form of 291 have them, with digits to spare."""
    with mp.workdps(110):
        R, L, e, angle = mp.mpf(machine.crank), mp.mpf(machine.rod), mp.mpf(machine.offset), exact_angle(degrees)
        sin_psi = (R * angle.sin - e) / L
        cos_psi = mp.sqrt(1 - sin_psi**2)
        x = mp.sqrt((L + R) ** 2 - e**2) - R * angle.cos - L * cos_psi
        c = R * (angle.sin * cos_psi + angle.cos * sin_psi) / cos_psi
        bend = R * R / L * angle.cos**2 / cos_psi**3
        b = R * (angle.cos * cos_psi - angle.sin * sin_psi) / cos_psi + bend
        return x, c, b, cos_psi


@pytest.mark.parametrize(
    ("lam", "rod"),
    few([(lam, rod) for rod in (1.0, 2.3) for lam in RATIOS], [(lam, 2.3) for lam in (RATIOS[0], 0.2, RATIOS[-1])]),
)
def test_straight_within_eight_ulp(lam, rod):
    machine = SliderCrank(lam * rod, rod)
    for degrees in ANGLES:
        angle = CrankAngle.of(degrees)
        x, c, b, cos_psi = textbook(machine, degrees)
        assert ulps(machine.coordinate(angle), x) <= 8
        assert ulps(machine.slope(angle), c) <= 8
        R, lam_exact, exact = mp.mpf(machine.crank), mp.mpf(machine.crank) / mp.mpf(rod), exact_angle(degrees)
        second = R * lam_exact * (1 - lam_exact**2) * exact.sin**2 / cos_psi**3
        assert ulps(machine.curvature(angle), b, of=abs(b + second) + second) <= 8


@pytest.mark.parametrize("lam", RATIOS)
def test_dead_centres_are_exact_zeros(lam):
    machine = SliderCrank(lam, 1.0)
    for turn in range(-3, 4):
        inner, outer = CrankAngle.of(360.0 * turn), CrankAngle.of(360.0 * turn + 180.0)
        assert machine.coordinate(inner) == machine.slope(inner) == machine.slope(outer) == 0
        assert machine.coordinate(outer) == 2 * lam


def motion_of(lam):
    return one_cylinder(SliderCrank(lam, 1.0), rpm=60 / math.tau).motion


@pytest.mark.parametrize("lam", [1e-8, 0.2, 0.25, 0.7, 0.99, 1 - 1e-4])
def test_largest_velocity(lam):
    """At the zero of b: sin²ψ = q with q³ − q² − q + λ² = 0, and c = v sin φ (1 + q)."""
    exact = mp.mpf(lam)
    with mp.workdps(60):
        q = mp.findroot(lambda q: q**3 - q**2 - q + exact**2, (mp.mpf(0), mp.mpf(1)), solver="anderson", tol=1e-90)
        wanted, at = exact * mp.sqrt(q / exact**2) * (1 + q), mp.degrees(mp.asin(mp.sqrt(q / exact**2)))
    found = motion_of(lam)
    assert found.c_max.value == pytest.approx(float(wanted), rel=1e-13)
    assert found.c_max.degrees == pytest.approx(float(at), abs=1e-9)
    assert found.c_min.value == pytest.approx(-found.c_max.value, rel=1e-13)


@pytest.mark.parametrize("lam", [0.2, 0.25, 0.2638, 0.3, 0.5, 0.7, 0.881, 0.99])
def test_smallest_acceleration(lam):
    """Beyond λ = (√21 − 3)/6 = 0.263763 within the stroke, where 3y(1 − y)(1 + y)² = ρ for y = −λ cos φ/cos ψ."""
    exact, found = mp.mpf(lam), motion_of(lam).b_min
    if lam < (math.sqrt(21) - 3) / 6:
        assert (found.value, found.degrees) == (pytest.approx(lam * (lam - 1), rel=1e-13), 180.0)
        return
    rho = 1 - exact**2
    y = mp.findroot(lambda y: 3 * y * (1 - y) * (1 + y) ** 2 - rho, (mp.mpf(0), exact), solver="anderson")
    kappa = mp.sqrt(rho / (1 - y**2))
    cos = -y * kappa / exact
    wanted = exact * (cos * (kappa + exact * cos) / kappa - exact * rho * (1 - cos**2) / kappa**3)
    assert found.value == pytest.approx(float(wanted), rel=1e-12)


NEARLY = [(0.05, 0.5), (0.3, 1e-8), (0.3, 1e-12), (0.3, 1e-15), (0.9, 1e-6), (0.999, 1e-10), (-0.3, 1e-12)]


@pytest.mark.parametrize(("offset", "gap"), few(NEARLY, [NEARLY[0], NEARLY[3], NEARLY[6]]))
def test_offset_up_to_the_limit(offset, gap):
    machine = SliderCrank(1.0 - abs(offset) - gap, 1.0, offset)
    for degrees in ANGLES:
        angle = CrankAngle.of(degrees)
        x, c, b, cos_psi = textbook(machine, degrees)
        R, exact = mp.mpf(machine.crank), exact_angle(degrees)
        away = max(abs(math.remainder(degrees, 360)), 6) * mp.pi / 180
        # x has its zero at a transcendental angle: measured against the rounding of φ
        assert abs(machine.coordinate(angle) - x) <= 8 * 2**-53 * (abs(x) + abs(c) * away)
        terms = R * abs(exact.sin), R * abs(exact.cos) * mp.sqrt(1 - cos_psi**2) / cos_psi
        assert abs(machine.slope(angle) - c) <= 10 * 2**-53 * sum(terms)
        bends = R * abs(exact.cos), R * abs(exact.sin) * mp.sqrt(1 - cos_psi**2) / cos_psi
        assert abs(machine.curvature(angle) - b) <= 24 * 2**-53 * (sum(bends) + R * R * exact.cos**2 / cos_psi**3)


@given(st.floats(0.01, 0.95), st.floats(-0.9, 0.9), st.floats(0, 360))
@settings(max_examples=2 * settings.default.max_examples)
def test_the_mirrored_offset_runs_backwards(lam, share, degrees):
    offset = share * (1 - lam)
    ahead, behind = SliderCrank(lam, 1.0, offset), SliderCrank(lam, 1.0, -offset)
    angle, mirrored = CrankAngle.of(degrees), CrankAngle.of(-degrees)
    assert behind.coordinate(mirrored) == pytest.approx(ahead.coordinate(angle), abs=1e-14)
    assert behind.slope(mirrored) == pytest.approx(-ahead.slope(angle), abs=1e-13)
    assert behind.time_ratio == pytest.approx(1 / ahead.time_ratio, rel=1e-12)


@pytest.mark.parametrize(("offset", "by_ratio"), [*itertools.product((0.0, 0.02, -0.1), (True, False))])
def test_the_stroke_gives_the_crank(offset, by_ratio):
    size = {"rod_ratio": 4.0} if by_ratio else {"rod": 1.2}
    machine = SliderCrank.from_keys(stroke=0.6, offset=offset, **size)
    assert machine.stroke == pytest.approx(0.6, rel=1e-14)
    assert not by_ratio or machine.rod / machine.crank == pytest.approx(4, rel=1e-15)


@pytest.mark.parametrize(
    ("lengths", "message"),
    [
        ((0.4, 0.3), "rod: 300 mm is shorter than the crank (400 mm); the crank turns fully only with a longer rod"),
        ((0.4, 0.4), "rod: 400 mm is no longer than the crank (400 mm)"),
        (
            (0.3, 0.5, 0.2),
            "rod: 500 mm does not reach: it must be longer than crank and offset together (300 mm + 200 mm)",
        ),
        ((0.3, 0.5, -0.2), "rod: 500 mm does not reach"),
        ((0.1, 0.3, 0.2), "rod: 300 mm does not reach"),
    ],
)
def test_a_rod_that_does_not_reach(lengths, message):
    with pytest.raises(RuleError) as raised:
        SliderCrank(*lengths)
    assert str(raised.value).startswith(message)
