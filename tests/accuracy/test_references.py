"""The references of `kurbel accuracy` against mpmath's own functions and against solutions in closed form."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise

import mpmath
import numpy as np
import pytest

from kurbel.accuracy.extremes import reference
from kurbel.accuracy.methods import DIGITS, FLOATS, PRECISE, NoAnswer, extremes, gauss, precise_integrals, roots
from kurbel.accuracy.textbook import TextbookCylinder, TextbookMachine, TextbookMotion
from kurbel.accuracy.trials import speed_line
from kurbel.machine_file import loads
from kurbel.mechanisms.slider_crank import SliderCrank
from representative import few

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
GAS_ENGINE = """
{speed: 300 rpm, cycle: four-stroke, stroke: 600 mm, rod: 1400 mm, offset: 20 mm, bore: 400 mm, inclination: 60 deg,
 masses: {piston: 240 kg}, indicator: {head_end: {unit: bar, interpolate: polytropic, clearance: 0.2,
 intake: [[0, 0], [1, 0]], compression: [[1, 0], [0, 9]], expansion: [[0, 26], [1, 2]], exhaust: [[1, 0.1], [0, 0.1]]}},
 friction: {crosshead: 0.05}}
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
    motion = TextbookMotion(SliderCrank(0.4, rod, offset), PRECISE)
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
    motion = TextbookMotion(SliderCrank(0.4, 2.0, offset), PRECISE)
    fractions = PRECISE.of(np.array([0.02, 0.5, 0.95]))
    beyond, line = motion.beyond(fractions)
    for angles in (line + beyond, line - beyond):
        for angle, fraction in zip(angles, fractions):
            assert close(motion.at(angle).x / motion.stroke, fraction, 35)
    ends = [motion.at(angle).slope for angle in motion.dead_centres]
    assert all(abs(slope) < 1e-38 for slope in ends)


def test_first_order_formulas_are_those_of_the_book() -> None:
    """B 31: λ = 1/5, 45° 0.343 R, 90° 1.1 R, 135° 1.757 R; b at the inner dead centre 1 + λ."""
    motion = TextbookMotion(SliderCrank(1.0, 5.0), FLOATS, "first-order")
    assert motion.at(np.radians([45.0, 90.0, 135.0])).x == pytest.approx([0.343, 1.1, 1.757], abs=5e-4)
    assert motion.at(np.radians([0.0, 180.0])).curvature == pytest.approx([1.2, -0.8])


def test_floats_and_mpmath_agree() -> None:
    machine = loads(GAS_ENGINE)
    degrees = np.array([7.0, 100.0, 250.0, 300.0, 401.0, 500.0, 655.0])
    exact = PRECISE.of(degrees) * mp.pi / 180
    precise = TextbookMachine(machine, PRECISE).torque(exact, exact)
    floats = TextbookMachine(machine).torque(np.radians(degrees), np.radians(degrees))
    assert floats == pytest.approx(np.asarray(precise, dtype=float), rel=1e-11)


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
    whole = TextbookMachine(machine, PRECISE)
    balance = reference(machine, "forces work") - reference(machine, "forces friction_work")
    assert close(precise_integrals(whole.torque, whole.edges).sum(), balance, 25)


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


@pytest.mark.parametrize("inertia", few(["1e6 kg m2", "900 kg m2", "9 kg m2"], ["900 kg m2"]))
def test_speed_under_a_fan_in_closed_form(inertia: str) -> None:
    """Without masses and with a load ∝ ω² the energy obeys K′ = M − a K, a linear equation."""
    card = "{constant: {expansion: 5 bar, compression: 0 bar}}"
    machine = loads(
        f"{{speed: 50 rpm, crank: 400 mm, rod: infinite, bore: 450 mm, "
        f"indicator: {{head_end: {card}, crank_end: mirrored}}, "
        f"flywheel: {{inertia: {inertia}}}, load: {{power_law: 2}}}}"
    )
    assert machine.speed
    assert machine.flywheel
    found = speed_line(machine, PRECISE)
    omega = 2 * mp.pi * mpmath.mpf(machine.speed)
    top = mpmath.mpf(5e5) * mp.pi / 4 * mpmath.mpf(0.45) ** 2 * mpmath.mpf(0.4)
    half = mpmath.mpf(machine.flywheel.inertia) / 2
    a = 4 * top / (2 * mp.pi) / (half * omega**2)

    def stroke(energy: mpmath.mpf, phi: mpmath.mpf) -> mpmath.mpf:
        """K after φ of K′ = top sin φ − a K."""
        driven = top / (1 + a**2) * (a * mp.sin(phi) - mp.cos(phi))
        return driven + (energy + top / (1 + a**2)) * mp.exp(-a * phi)

    # K after a stroke is linear in its start: the start that comes back
    start = stroke(mpmath.mpf(0), mp.pi) / (1 - mp.exp(-a * mp.pi))
    for k in range(1, 13):
        assert close(found[k - 1], mp.sqrt(stroke(start, (k % 6) * mp.pi / 6) / half), 18)


@pytest.mark.slow
@pytest.mark.parametrize("load", ["slip: 0.2", "slip: 1e-7", "power_law: 12"])
def test_speed_is_independent_of_the_nodes(load: str) -> None:
    machine = loads(ENGINE + f"flywheel: {{inertia: 400 kg m2}}\nload: {{{load}}}\n")
    coarse, fine = (speed_line(machine, PRECISE, nodes) for nodes in (17, 20))
    assert max(abs(coarse / fine - 1)) < 1e-17


def test_roots_and_extremes_where_a_function_bends() -> None:
    """A cube is flat at its root; a step of width 1e-9 is steep there."""
    edges = PRECISE.of(np.array([-1.0, 2.0]))
    found, _ = roots(lambda x, _: (x - mp.sqrt(2) / 2) ** 3, edges, PRECISE)
    assert abs(found[0] - mp.sqrt(2) / 2) < 1e-9
    found, _ = roots(lambda x, _: (x - 1 / mpmath.mpf(3)) / (abs(x - 1 / mpmath.mpf(3)) + 1e-9), edges, PRECISE)
    assert abs(found[0] - 1 / mpmath.mpf(3)) < 1e-29
    found, _ = roots(lambda x, _: x - 0.25, np.array([0.0, 1.0]), FLOATS)  # at one of the steps
    assert found.tolist() == [0.25]
    assert extremes(lambda x, _: x * (1 - x), np.array([0.0, 0.7, 2.0]), FLOATS) == pytest.approx([0.25, -2.0])


def test_precise_integrals_near_a_pole() -> None:
    """∫ dx/(x² + ε²) = (2/ε) arctan(1/ε) over (−1, 1)."""
    narrow = mpmath.mpf("1e-4")
    found = precise_integrals(lambda x, _: 1 / (x * x + narrow**2), PRECISE.of(np.array([-1.0, 1.0])))
    assert close(found.sum(), 2 / narrow * mp.atan(1 / narrow), 22)
    assert gauss(8)(lambda x, _: x**15, np.array([0.0, 1.0])).sum() == pytest.approx(1 / 16, rel=1e-14)


def test_a_piece_is_named_by_an_angle_within_it() -> None:
    """At a corner where the card jumps, the side that is meant decides."""
    card = "{unit: bar, expansion: [[0, 9], [0.5, 9], [0.5, 2], [1, 2]], compression: [[1, 1], [0, 1]]}"
    machine = loads(f"{{crank: 400 mm, rod: infinite, bore: 450 mm, indicator: {{head_end: {card}}}}}")
    book = TextbookCylinder(machine, machine.cylinders[0])
    area = np.pi / 4 * 0.45**2
    forces = [book.forces(np.pi / 2, np.pi / 2 + side).gas / area for side in (-0.1, 0.1)]
    assert forces == pytest.approx([9e5, 2e5])


def test_a_machine_that_nearly_stalls_has_no_reference() -> None:
    """The mesh grows without end where the speed comes near to nothing."""
    machine = loads(ENGINE + "flywheel: {inertia: 100 kg m2}\nload: {power_law: 12}\n")
    with pytest.raises(NoAnswer, match="fine enough"):
        speed_line(machine, PRECISE)
