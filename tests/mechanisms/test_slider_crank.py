"""The slider-crank against its textbook formulas in 50 digits, its closed extremes, and its rules."""

from __future__ import annotations

import itertools
import math
import random

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from precise import exact_angle, ulps

from kurbel import crank_formulas
from kurbel.crank_angle import CrankAngle
from kurbel.errors import RuleError
from kurbel.mechanisms.slider_crank import SliderCrank
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


@pytest.mark.parametrize("lam", few([*RATIOS, 1e-200, 1 - 2**-53], [RATIOS[0], RATIOS[4], 1e-200, 1 - 2**-53]))
def test_largest_velocity_in_closed_form(lam):
    machine = SliderCrank(lam, 1.0)
    exact = mp.mpf(lam)
    with mp.workdps(460):
        low, high = mp.mpf(0), mp.mpf(1)
        for _ in range(1500):  # the zero of b: sin²ψ = q, q³ − q² − q + λ² = 0
            q = (low + high) / 2
            low, high = (q, high) if q**3 - q**2 - q + exact**2 > 0 else (low, q)
        wanted = exact * mp.sqrt(q / exact**2) * (1 + q)
    largest, smallest = machine.velocity_extremes()
    assert ulps(largest.value, wanted) <= 5
    assert smallest.value == -largest.value
    at = CrankAngle.of(largest.degrees)
    assert abs(machine.curvature(at)) <= 1e-14 * max(1, 1 / float(machine.rho) ** 0.5)


@pytest.mark.parametrize("lam", [0.2638, 0.3, 0.5, 0.7, 0.881, 0.99, 1 - 1e-9])
def test_smallest_acceleration_within_the_stroke(lam):
    machine = SliderCrank(lam, 1.0)
    lowest = min(machine.acceleration_extremes(), key=lambda extreme: extreme.value)
    exact = mp.mpf(lam)
    rho = 1 - exact**2
    y = mp.findroot(lambda y: 3 * y * (1 - y) * (1 + y) ** 2 - rho, (mp.mpf(0), exact), solver="anderson")
    kappa = mp.sqrt(rho / (1 - y**2))
    cos = -y * kappa / exact
    wanted = exact * (cos * (kappa + exact * cos) / kappa - exact * rho * (1 - cos**2) / kappa**3)
    assert ulps(lowest.value, wanted) <= 5


def test_below_the_threshold_the_acceleration_is_smallest_at_the_outer_dead_centre():
    threshold = (math.sqrt(21) - 3) / 6
    below, above = SliderCrank(threshold - 1e-9, 1.0), SliderCrank(threshold + 1e-9, 1.0)
    assert len(below.acceleration_extremes()) == 2
    assert len(above.acceleration_extremes()) == 4
    assert round(threshold, 6) == 0.263763


def test_acceleration_dips_of_the_numerics_note():
    dip = crank_formulas.acceleration_dip(0.3, 1 - 0.09)
    assert (round(dip.value, 6), round(dip.degrees, 2)) == (-0.709178, 148.23)
    dip = crank_formulas.acceleration_dip(0.5, 0.75)
    assert (round(dip.value, 6), round(dip.degrees, 2)) == (-0.758921, 112.49)


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


def test_offset_vanishes_into_the_straight_machine():
    straight, nearly = SliderCrank(0.3, 1.0), SliderCrank(0.3, 1.0, 1e-13)
    angle = CrankAngle.of(np.linspace(0, 360, 73))
    assert nearly.coordinate(angle) == pytest.approx(straight.coordinate(angle), abs=1e-12)
    assert nearly.slope(angle) == pytest.approx(straight.slope(angle), abs=1e-12)
    assert nearly.stroke == pytest.approx(0.6, rel=1e-15)


def test_a_long_rod_is_nearly_infinite():
    angle = CrankAngle.of(np.linspace(0, 360, 73))
    long, infinite = SliderCrank(0.3, 3e11), SliderCrank(0.3, math.inf)
    for name in ("coordinate", "slope", "curvature"):
        assert getattr(long, name)(angle) == pytest.approx(getattr(infinite, name)(angle), abs=1e-12)


@pytest.mark.parametrize(("crank", "rod"), [(1e300, 5e300), (1e-300, 5e-300), (1e-300, 1.0), (1.0, 1e300)])
def test_extreme_sizes_stay_finite(crank, rod):
    machine = SliderCrank(crank, rod)
    angle = CrankAngle.of(np.linspace(0, 360, 25))
    for function in (machine.coordinate, machine.slope, machine.curvature):
        assert np.isfinite(function(angle)).all()
    assert machine.coordinate(CrankAngle.of(90.0)) >= crank


@given(
    st.floats(0.01, 0.999),
    st.floats(-0.9, 0.9),
    st.floats(0, 1),
    st.booleans(),
)
@settings(max_examples=2 * settings.default.max_examples)
def test_inverse_everywhere(lam, share, fraction, outstroke):
    machine = SliderCrank(lam, 1.0, share * (1 - lam))
    way = fraction * machine.stroke
    degrees = float(machine.crank_angles_at(np.array([way]), outstroke)[0])
    assert machine.coordinate(CrankAngle.of(degrees)) == pytest.approx(way, abs=1e-14 * machine.stroke)
    if 1e-6 < fraction < 1 - 1e-6:
        assert (machine.slope(CrankAngle.of(degrees)) > 0) == outstroke


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
