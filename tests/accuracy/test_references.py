"""The references of `kurbel accuracy` against mpmath's own functions and against solutions in closed form."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

import mpmath
import pytest

from kurbel.accuracy.extremes import reference
from kurbel.accuracy.textbook import DIGITS, TextbookCylinder, TextbookMachine, TextbookMotion, integrals, roots
from kurbel.machine_file import loads
from kurbel.mechanisms.slider_crank import SliderCrank

mp = mpmath.mp
STEAM = """
{unit: at, expansion: [[0, 9.5], [0.35, 9.5], [0.5, 6.7], [0.7, 4.7], [0.95, 3.3], [1, 2.2]],
 compression: [[1, 1.2], [0.25, 1.2], [0.1, 2.4], [0.02, 6.5], [0, 9.5]]}
"""
POINTS = {
    "expansion": [(0, 9.5), (0.35, 9.5), (0.5, 6.7), (0.7, 4.7), (0.95, 3.3), (1, 2.2)],
    "compression": [(1, 1.2), (0.25, 1.2), (0.1, 2.4), (0.02, 6.5), (0, 9.5)],
}
ENGINE = f"""
speed: 50 rpm
crank: 400 mm
rod: 2000 mm
bore: 450 mm
indicator: {{head_end: {STEAM}, crank_end: mirrored}}
masses: {{piston: 200 kg}}
friction: {{crosshead: 0.06}}
inclination: 0 deg
"""


@pytest.fixture(autouse=True)
def digits() -> Iterator[None]:
    with mp.workdps(DIGITS):
        yield


def close(value: mpmath.mpf, truth: mpmath.mpf, digits: int) -> bool:
    return abs(value - truth) <= mpmath.mpf(10) ** -digits * max(abs(truth), mpmath.mpf(10) ** -digits)


@pytest.mark.parametrize(("rod", "offset"), [(2.0, 0.0), (0.404, 0.0), (2.0, 0.3), (2.0, 1.5), (1e6, 0.0)])
def test_motion_and_its_derivatives(rod: float, offset: float) -> None:
    """Velocity and acceleration are the derivatives of the displacement, which is that of the triangle."""
    motion = TextbookMotion(SliderCrank(0.4, rod, offset))
    r, length, e = mpmath.mpf(0.4), mpmath.mpf(rod), mpmath.mpf(offset)

    def x(phi: mpmath.mpf) -> mpmath.mpf:
        return mp.sqrt((length + r) ** 2 - e**2) - r * mp.cos(phi) - mp.sqrt(length**2 - (r * mp.sin(phi) - e) ** 2)

    for degrees in (17.5, 90.0, 200.0, 333.25, -725.25, 360000030.0):
        phi = mp.radians(mpmath.mpf(degrees))
        at = motion.at(phi)
        assert close(at.x, x(phi), 30)
        assert close(at.slope, mp.diff(x, phi), 18)
        assert close(at.curvature, mp.diff(x, phi, 2), 12)
        sin_psi = (r * mp.sin(phi) - e) / length
        assert close(at.sin_psi, sin_psi, 30)
        assert close(at.cos_psi, mp.sqrt(1 - sin_psi**2), 30)


@pytest.mark.parametrize("offset", [0.0, 0.3])
def test_fractions_of_the_stroke_are_passed_at_their_angles(offset: float) -> None:
    motion = TextbookMotion(SliderCrank(0.4, 2.0, offset))
    for fraction in map(mpmath.mpf, ("0.02", "0.5", "0.95")):
        for angle in motion.angles_at(fraction):
            assert close(motion.at(angle).x / motion.stroke, fraction, 35)
    assert all(abs(motion.at(angle).slope) < 1e-38 for angle in motion.dead_centres)


def test_largest_velocity() -> None:
    """q³ − q² − q + λ² = 0 with q = sin²ψ, c_max/v = sin φ (1 + q)."""
    lam = mpmath.mpf(0.4) / 2
    q = mp.findroot(lambda q: q**3 - q**2 - q + lam**2, mpmath.mpf("0.04"))
    found = reference(loads("{speed: 60 rpm, crank: 400 mm, rod: 2000 mm}"), "motion c_max")
    assert close(found, 2 * mp.pi * mpmath.mpf(0.4) * mp.sqrt(q) / lam * (1 + q), 30)


def test_work_is_the_area_of_the_polygon() -> None:
    machine = loads(ENGINE)
    at = mpmath.mpf("98066.5")
    area = sum(
        (mpmath.mpf(p) + next_p) / 2 * (mpmath.mpf(next_z) - z)
        for line in POINTS.values()
        for (z, p), (next_z, next_p) in pairwise(line)
    )
    truth = 2 * area * at * mp.pi / 4 * mpmath.mpf(0.45) ** 2 * 2 * mpmath.mpf(0.4)
    assert close(reference(machine, "forces work"), truth, 15)  # the card in floats of Pa


def test_energy_balance_of_torque_and_friction() -> None:
    """∮ M dφ = work − friction work: inertia and weight do none."""
    machine = loads(ENGINE.replace(", crank_end: mirrored", ""))
    whole = TextbookMachine(machine)
    balance = reference(machine, "forces work") - reference(machine, "forces friction_work")
    assert close(mp.fsum(integrals(whole.torque, whole.edges)), balance, 25)


def test_friction_work_of_constant_force() -> None:
    """P constant on each stroke, no masses: ∮ f |N| |dx| by mpmath over the quarters."""
    card = "{constant: {expansion: 5 bar, compression: 0 bar}}"
    machine = loads(
        f"{{crank: 400 mm, rod: 2000 mm, bore: 450 mm, indicator: {{head_end: {card}}}, friction: {{crosshead: 0.1}}}}"
    )
    lam, f = mpmath.mpf(0.4) / 2, mpmath.mpf(0.1)
    force = mpmath.mpf(5e5) * mp.pi / 4 * mpmath.mpf(0.45) ** 2

    def power(phi: mpmath.mpf) -> mpmath.mpf:
        psi = mp.asin(lam * mp.sin(phi))
        slope = mpmath.mpf(0.4) * mp.sin(phi + psi) / mp.cos(psi)
        return f * force * mp.sin(psi) / (mp.cos(psi) + f * mp.sin(psi)) * slope

    assert close(reference(machine, "forces friction_work"), mp.quad(power, [0, mp.pi / 2, mp.pi]), 25)


def test_tangential_extremes_of_a_constant_force() -> None:
    """T = P c/v, whose largest value is that of c."""
    card = "{constant: {expansion: 5 bar, compression: 0 bar}}"
    machine = loads(f"{{speed: 60 rpm, crank: 400 mm, rod: 2000 mm, bore: 450 mm, indicator: {{head_end: {card}}}}}")
    force = mpmath.mpf(5e5) * mp.pi / 4 * mpmath.mpf(0.45) ** 2
    peak = reference(machine, "motion c_max") / (2 * mp.pi * mpmath.mpf(0.4))
    assert close(reference(machine, "forces T_max"), force * peak, 30)
    assert abs(reference(machine, "forces T_min")) < 1e-25


def test_excess_energy_of_two_levels() -> None:
    """Infinite rod, p on the outstroke alone: M = A p R sin φ there, mean A p R/π; ΔE between its crossings."""
    card = "{constant: {expansion: 5 bar, compression: 0 bar}}"
    machine = loads(f"{{crank: 400 mm, rod: infinite, bore: 450 mm, indicator: {{head_end: {card}}}}}")
    top = mpmath.mpf(5e5) * mp.pi / 4 * mpmath.mpf(0.45) ** 2 * mpmath.mpf(0.4)
    first = mp.asin(1 / mp.pi)
    assert close(reference(machine, "flywheel dE"), top * (2 * mp.cos(first) - (mp.pi - 2 * first) / mp.pi), 20)


def test_roots_of_a_steep_function() -> None:
    """A step of width 1e-9 is steep there."""
    third = 1 / mpmath.mpf(3)
    (found,) = roots(lambda x, _: (x - third) / (abs(x - third) + mpmath.mpf("1e-9")), [mpmath.mpf(-1), mpmath.mpf(2)])
    assert abs(found - third) < 1e-29


def test_integrals_near_a_pole() -> None:
    """∫ dx/(x² + ε²) = (2/ε) arctan(1/ε) over (−1, 1)."""
    narrow = mpmath.mpf("1e-4")
    (found,) = integrals(lambda x, _: 1 / (x * x + narrow**2), [mpmath.mpf(-1), mpmath.mpf(1)])
    assert close(found, 2 / narrow * mp.atan(1 / narrow), 22)


def test_a_piece_is_named_by_an_angle_within_it() -> None:
    """At a corner where the card jumps, the side that is meant decides."""
    card = "{unit: bar, expansion: [[0, 9], [0.5, 9], [0.5, 2], [1, 2]], compression: [[1, 1], [0, 1]]}"
    machine = loads(f"{{crank: 400 mm, rod: infinite, bore: 450 mm, indicator: {{head_end: {card}}}}}")
    book, quarter = TextbookCylinder(machine, machine.cylinders[0]), mp.pi / 2
    area = mp.pi / 4 * mpmath.mpf(0.45) ** 2
    forces = [float(book.forces(quarter, quarter + side).gas / area) for side in (-0.1, 0.1)]
    assert forces == pytest.approx([9e5, 2e5])
