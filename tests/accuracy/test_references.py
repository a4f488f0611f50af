"""The references of `kurbel accuracy` against mpmath and against solutions in closed form."""

from __future__ import annotations

from decimal import Decimal

import mpmath
import pytest

from kurbel.accuracy import references
from kurbel.accuracy.decimals import arcsin, integral, largest, pi, precise, root, sin_cos
from kurbel.accuracy.oracle import CrankMotion, CylinderOracle
from kurbel.accuracy.periodic import SpeedOracle
from kurbel.machine_file import loads
from representative import few

mp = mpmath.mp
STEAM = """
{unit: at, expansion: [[0, 9.5], [0.35, 9.5], [0.5, 6.7], [0.7, 4.7], [0.95, 3.3], [1, 2.2]],
 compression: [[1, 1.2], [0.25, 1.2], [0.1, 2.4], [0.02, 6.5], [0, 9.5]]}
"""
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


def mpf(value: Decimal) -> mpmath.mpf:
    return mpmath.mpf(str(value))


def close(value: Decimal, truth: mpmath.mpf, digits: int) -> bool:
    return abs(mpf(value) - truth) <= mpmath.mpf(10) ** -digits * max(abs(truth), mpmath.mpf(10) ** -digits)


@pytest.mark.parametrize(
    "degrees", ["0", "30", "89.99999", "90", "180", "271.5", "-725.25", "360000030", "1e22", "1e-30"]
)
def test_sine_and_cosine(degrees: str) -> None:
    with mp.workdps(80), precise(40):
        phi = mp.radians(mpmath.mpf(degrees))
        sin, cos = sin_cos(Decimal(degrees))
        assert abs(mpf(sin) - mp.sin(phi)) <= mpmath.mpf(10) ** -39 * max(abs(mp.sin(phi)), mpmath.mpf(10) ** -30)
        assert abs(mpf(cos) - mp.cos(phi)) <= mpmath.mpf(10) ** -38


def test_pi_arcsin_and_root_of_two() -> None:
    with mp.workdps(60), precise(50):
        assert close(pi(), +mp.pi, 49)
        assert close(arcsin(Decimal("0.3")), mp.degrees(mp.asin(mpmath.mpf("0.3"))), 47)
        assert close(root(lambda x: x * x - 2, Decimal(1), Decimal(2)), mp.sqrt(2), 48)


def test_largest_and_integral() -> None:
    with mp.workdps(60), precise(40):
        assert close(largest(lambda x: x * (3 - x), Decimal(0), Decimal(3)), mpmath.mpf("2.25"), 35)
        assert close(integral(lambda x: 1 / (1 + x * x), Decimal(0), Decimal(1)) * 4, +mp.pi, 22)
        steep = integral(lambda x: (1 + Decimal("1e-6") - x).sqrt(), Decimal(0), Decimal(1))
        assert close(steep, (mpmath.mpf("1.000001") ** 1.5 - mpmath.mpf("1e-9")) * 2 / 3, 20)


@pytest.mark.parametrize(("rod", "offset"), [(2.0, 0.0), (0.404, 0.0), (2.0, 0.3), (2.0, 1.5), (1e6, 0.0)])
def test_motion_and_its_derivatives(rod: float, offset: float) -> None:
    """Velocity and acceleration are the derivatives of the way, which is that of the triangle."""
    with mp.workdps(60), precise(50):
        motion = CrankMotion(0.4, rod, offset)
        r, length, e = mpmath.mpf(0.4), mpmath.mpf(rod), mpmath.mpf(offset)

        def x(phi: mpmath.mpf) -> mpmath.mpf:
            return mp.sqrt((length + r) ** 2 - e**2) - r * mp.cos(phi) - mp.sqrt(length**2 - (r * mp.sin(phi) - e) ** 2)

        for degrees in (17.5, 90.0, 200.0, 333.25):
            phi = mp.radians(mpmath.mpf(degrees))
            at = motion.at(Decimal(degrees))
            assert close(at.coordinate, x(phi), 35)
            assert close(at.slope, mp.diff(x, phi), 18)
            assert close(at.curvature, mp.diff(x, phi, 2), 12)


def test_largest_velocity() -> None:
    """q³ − q² − q + λ² = 0 with q = sin²ψ, c_max/v = sin φ (1 + q)."""
    with mp.workdps(60), precise(40):
        lam = mpmath.mpf(0.4) / 2
        q = mp.findroot(lambda q: q**3 - q**2 - q + lam**2, mpmath.mpf("0.04"))
        assert close(references.largest_slope(CrankMotion(0.4, 2.0)), mpmath.mpf(0.4) * mp.sqrt(q) / lam * (1 + q), 30)


def test_work_is_the_area_of_the_polygon() -> None:
    machine = loads(ENGINE)
    with precise(40):
        cylinder = CylinderOracle(machine, machine.cylinders[0])
        area = Decimal(0)
        for chamber in cylinder.chambers:
            for line in chamber.lines:
                area += sum(((s.p + s.next_p) / 2 * (s.next_z - s.z) for s in line), Decimal(0)) * chamber.area
        assert abs(references.work(cylinder) / (area * cylinder.motion.stroke) - 1) < Decimal("1e-38")
        by_angle = sum(
            integral(
                lambda phi, m=(low + high) / 2: cylinder.gas_force(phi, m) * cylinder.motion.at(phi).slope, low, high
            )
            for low, high in zip(cylinder.breaks, cylinder.breaks[1:])
        )
        assert abs(by_angle * pi() / 180 / references.work(cylinder) - 1) < Decimal("1e-20")


def test_energy_balance_of_torque_and_friction() -> None:
    """∮ M dφ = work − friction work: inertia and weight do none."""
    machine = loads(ENGINE.replace(", crank_end: mirrored", ""))
    with precise(30):
        cylinder = CylinderOracle(machine, machine.cylinders[0])
        mean = references.MachineOracle(machine).mean * 2 * pi()
        balance = references.work(cylinder) - references.friction_work(cylinder)
        assert abs(mean / balance - 1) < Decimal("1e-20")


def test_friction_work_of_constant_force() -> None:
    """P constant on each stroke, no masses: ∮ f |N| |dx| by mpmath over the four quarters."""
    card = "{constant: {expansion: 5 bar, compression: 0 bar}}"
    machine = loads(
        f"{{crank: 400 mm, rod: 2000 mm, bore: 450 mm, indicator: {{head_end: {card}}}, friction: {{crosshead: 0.1}}}}"
    )
    with mp.workdps(40), precise(40):
        found = references.friction_work(CylinderOracle(machine, machine.cylinders[0]))
        lam, f = mpmath.mpf(0.4) / 2, mpmath.mpf(0.1)
        force = mpmath.mpf(5e5) * mp.pi / 4 * mpmath.mpf(0.45) ** 2

        def power(phi: mpmath.mpf) -> mpmath.mpf:
            psi = mp.asin(lam * mp.sin(phi))
            slope = mpmath.mpf(0.4) * mp.sin(phi + psi) / mp.cos(psi)
            return f * force * mp.sin(psi) / (mp.cos(psi) + f * mp.sin(psi)) * slope

        assert close(found, mp.quad(power, [0, mp.pi / 2, mp.pi]), 20)


def test_excess_energy_of_two_levels() -> None:
    """Infinite rod, p on the outstroke alone: M = A p R sin φ there, mean A p R/π; ΔE between its crossings."""
    card = "{constant: {expansion: 5 bar, compression: 0 bar}}"
    machine = loads(f"{{crank: 400 mm, rod: infinite, bore: 450 mm, indicator: {{head_end: {card}}}}}")
    with mp.workdps(40), precise(40):
        top = mpmath.mpf(5e5) * mp.pi / 4 * mpmath.mpf(0.45) ** 2 * mpmath.mpf(0.4)
        first = mp.asin(1 / mp.pi)
        truth = top * (2 * mp.cos(first) - (mp.pi - 2 * first) / mp.pi)
        assert close(references.excess_energy(machine), truth, 20)


@pytest.mark.parametrize("inertia", few(["1e6 kg m2", "900 kg m2", "9 kg m2"], ["900 kg m2"]))
def test_speed_under_a_fan_in_closed_form(inertia: str) -> None:
    """Without masses and with a load ∝ ω² the energy obeys K′ = M − a K, a linear equation."""
    card = "{constant: {expansion: 5 bar, compression: 0 bar}}"
    machine = loads(
        f"{{speed: 50 rpm, crank: 400 mm, rod: infinite, bore: 450 mm, "
        f"indicator: {{head_end: {card}, crank_end: mirrored}}, "
        f"flywheel: {{inertia: {inertia}}}, load: {{power_law: 2}}}}"
    )
    with mp.workdps(40), precise(40):
        found = SpeedOracle(machine).omega()
        omega = 2 * mp.pi * mpmath.mpf(machine.speed)
        size = mp.pi / 4 * mpmath.mpf(0.45) ** 2 * mpmath.mpf(0.4)
        top = mpmath.mpf(5e5) * size
        half = mpmath.mpf(machine.flywheel.inertia) / 2
        a = 4 * top / (2 * mp.pi) / (half * omega**2)

        def stroke(energy: mpmath.mpf, phi: mpmath.mpf) -> mpmath.mpf:
            """K after φ of K′ = top sin φ − a K."""
            driven = top / (1 + a**2) * (a * mp.sin(phi) - mp.cos(phi))
            return driven + (energy + top / (1 + a**2)) * mp.exp(-a * phi)

        # K after a stroke is linear in its start: the start that comes back
        start = stroke(mpmath.mpf(0), mp.pi) / (1 - mp.exp(-a * mp.pi))
        for k in range(12):
            energy = stroke(start, (k % 6) * mp.pi / 6)
            assert close(found[k], mp.sqrt(energy / half), 18)


@pytest.mark.slow
def test_speed_does_not_hang_on_the_order_of_the_rule() -> None:
    machine = loads(ENGINE + "flywheel: {inertia: 100 kg m2}\nload: {slip: 0.2}\n")
    with precise(40):
        coarse, fine = (SpeedOracle(machine, stages).omega() for stages in (11, 14))
        assert max(abs(a / b - 1) for a, b in zip(coarse, fine)) < Decimal("1e-17")
