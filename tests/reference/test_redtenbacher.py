"""F. Redtenbacher, Der Maschinenbau (1862): crosshead, inclined plane, piston rings. Equation numbers D are his."""

import math

import mpmath
import pytest

from kurbel.errors import NoSolutionError
from kurbel.machine.indicator import Constant, Indicator
from kurbel.machine.parts import Friction, Piston, Rings
from kurbel.mechanisms.slider_crank import SliderCrank
from machines import constant_pressure, one_cylinder

FULL_ADMISSION = Constant.from_keys(expansion=6e5, compression=0.0)
LOCOMOTIVE = Piston(0.42, indicator=Indicator(FULL_ADMISSION, FULL_ADMISSION))


def test_loss_over_the_way_is_half_as_much_again() -> None:
    """∮ f|N||dx|/(P s) at constant P, by quadrature in high precision from D 3; his mean is over the rod angle."""
    lam, f = mpmath.mpf(1) / 6, mpmath.mpf(1) / 10

    def share(phi: mpmath.mpf) -> mpmath.mpf:
        sin_psi = lam * mpmath.sin(phi)
        cos_psi = mpmath.sqrt(1 - sin_psi**2)
        slope = mpmath.sin(phi) + mpmath.cos(phi) * sin_psi / cos_psi
        return f * sin_psi / (cos_psi + f * sin_psi) * slope / 2

    with mpmath.workdps(30):
        expected = float(mpmath.quad(share, mpmath.linspace(0, mpmath.pi, 9)))
    forces = one_cylinder(SliderCrank(0.3, 1.8), pistons=(LOCOMOTIVE,), friction=Friction(0.1))
    assert expected == pytest.approx(0.01304, abs=5e-6)
    assert forces.loss_crosshead == pytest.approx(expected, rel=1e-13)


def test_guide_force_while_driving_and_while_driven() -> None:
    """D 3 on the outstroke; pushed back against its motion, the friction changes sides and N grows."""
    lam_sin, f = 1 / 6, 0.1
    cos_psi = math.sqrt(1 - lam_sin**2)
    pushed, pulled = Indicator(constant_pressure(6e5)), Indicator(None, constant_pressure(6e5))
    for indicator, sign in ((pushed, +1), (pulled, -1)):
        piston = Piston(0.42, indicator=indicator)
        state = one_cylinder(SliderCrank(0.3, 1.8), pistons=(piston,), friction=Friction(f)).at(
            [90]
        )
        force = sign * 6e5 * piston.head_area
        assert state.N[0] == pytest.approx(
            force * lam_sin / (cos_psi + sign * f * lam_sin), rel=1e-14
        )
        assert state.S[0] * lam_sin == pytest.approx(state.N[0], rel=1e-14)  # D 2
        assert state.S[0] * cos_psi + sign * f * state.N[0] == pytest.approx(
            force, rel=1e-14
        )  # D 1
        assert state.F_friction[0] < 0


def test_rings() -> None:
    """Friction D π h p_r f, share 4 h p_r f/(D p) of the piston force (Kolbenreibung)."""
    rings = Rings(1, 0.05, 0.4e5, 0.1)
    forces = one_cylinder(
        SliderCrank(0.3, 1.8), pistons=(LOCOMOTIVE,), friction=Friction(None, rings)
    )
    assert forces.drive.ring_force == pytest.approx(math.pi * 0.42 * 0.05 * 0.4e5 * 0.1, rel=1e-15)
    assert forces.loss_rings == pytest.approx(4 * 0.05 * 0.4e5 * 0.1 / (0.42 * 6e5), rel=1e-14)


def test_a_driven_machine_locks_where_f_tan_psi_reaches_one() -> None:
    """D 5 for the crosshead: N = −P tan ψ/(1 − f tan ψ) has no value beyond f tan ψ = 1."""
    piston = Piston(
        0.2,
        indicator=Indicator(
            Constant.from_keys(expansion=0.0, compression=5e5),
            Constant.from_keys(expansion=0.0, compression=5e5),
        ),
    )  # takes work
    free = one_cylinder(SliderCrank(0.89, 1.0), pistons=(piston,), friction=Friction(0.5))
    locked = one_cylinder(SliderCrank(0.9, 1.0), pistons=(piston,), friction=Friction(0.5))
    assert free.friction_work > 0
    with pytest.raises(NoSolutionError, match="locks itself near φ = "):
        _ = locked.friction_work
