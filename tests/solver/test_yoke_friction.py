"""Friction of a Scotch yoke, quasi-static and of first order in f, against free bodies summed by the midpoint rule."""

import math

import numpy as np
import pytest

import kurbel

R, GUIDES, SPEED, MASS, PIN = 0.06, 0.26, 80 / 60, 36.0, 0.04
TEXT = """
speed: 80 rpm
mechanism: scotch-yoke
crank: 60 mm
guide_length: 260 mm
pin_diameter: 40 mm
pin_length: 60 mm
inclination: 0 deg
bore: 150 mm
indicator: {head_end: {constant: {expansion: 4 bar, compression: 1 bar}}}
masses: {piston: 36 kg}
"""
AREA = math.pi / 4 * 0.15**2


def case(friction: str) -> kurbel.Case:
    return kurbel.solve(kurbel.loads(TEXT + f"friction: {{{friction}}}\n"))


def free_body(
    phi: np.ndarray, constant: float, f_guides: float, f_block: float
) -> dict[str, np.ndarray]:
    """What acts at crank angles in radians: on the pin along and across the stroke, and what the guides take."""
    out = np.where(np.sin(phi) > 0, 1.0, -1.0)
    gas = np.where(out > 0, 4e5, 1e5) * AREA
    P = gas - MASS * R * (2 * math.pi * SPEED) ** 2 * np.cos(phi) - out * constant
    drag = 2 * f_guides * np.abs(P * R * np.sin(phi)) / GUIDES  # two guides, each |P| R sin φ/l
    along = P - out * drag
    across = -f_block * np.abs(along) * np.sign(np.cos(phi))  # against R ω cos φ
    T, D = along * np.sin(phi) + across * np.cos(phi), along * np.cos(phi) - across * np.sin(phi)
    return {"along": along, "across": across, "drag": drag, "T": T, "D": D}


def test_forces_are_those_of_the_free_bodies() -> None:
    degrees = np.array([7.0, 52.0, 88.0, 93.0, 155.0, 188.0, 231.0, 268.0, 272.0, 349.0])
    state = case("constant: 300 N, guides: 0.07, block: 0.09").cylinders[0].at(degrees)
    result = free_body(np.radians(degrees), 300.0, 0.07, 0.09)
    assert pytest.approx(result["T"], rel=1e-12) == state.T
    assert pytest.approx(result["D"], rel=1e-12) == state.D
    assert pytest.approx(result["T"] * R, rel=1e-12) == state.M
    assert pytest.approx(result["along"], rel=1e-12) == state.along_stroke
    # the guides carry the weight and what the block drags across
    assert pytest.approx(MASS * 9.80665 + result["across"], rel=1e-12) == state.N


def test_works_are_integrals_of_the_free_bodies() -> None:
    forces = case("constant: 300 N, guides: 0.07, block: 0.09, crank_pin: 0.08").cylinders[0]
    count = 1_000_000
    phi = (np.arange(count) + 0.5) * (2 * math.pi / count)
    result, step = free_body(phi, 300.0, 0.07, 0.09), 2 * math.pi / count
    guides = (result["drag"] * np.abs(R * np.sin(phi))).sum() * step
    block = (np.abs(result["across"] * R * np.cos(phi))).sum() * step
    pin = 0.08 * PIN / 2 * np.hypot(result["along"], result["across"]).sum() * step
    assert forces.work_block == pytest.approx(block, rel=1e-9)
    assert forces.friction_works["guides"] == pytest.approx(guides, rel=1e-9)
    assert forces.work_crank_pin == pytest.approx(pin, rel=1e-9)
    left = (result["T"] * R).sum() * step - pin
    assert 2 * math.pi * R * forces.W == pytest.approx(left, rel=1e-9)
    assert abs(forces.energy_residual) < 1e-13


def test_constant_force_has_closed_works() -> None:
    """P constant on the outstroke alone: guides ∫ 2 f P R² sin² φ/l dφ = π f P R²/l.

    The block, pressed by P (1 − k sin φ) with k = 2 f R/l: ∫ f_b P (1 − k sin φ) R |cos φ| dφ = 2 f_b P R (1 − k/2).
    """
    text = TEXT.replace("compression: 1 bar", "compression: 0 bar").replace(
        "masses: {piston: 36 kg}", ""
    )
    machine = kurbel.loads(text + "friction: {guides: 0.07, block: 0.09}\n")
    forces, P = kurbel.solve(machine).cylinders[0], 4e5 * AREA
    assert forces.friction_works["guides"] == pytest.approx(
        math.pi * 0.07 * P * R**2 / GUIDES, rel=1e-12
    )
    assert forces.loss_guides == pytest.approx(math.pi * 0.07 * R / (2 * GUIDES), rel=1e-12)
    assert forces.work_block == pytest.approx(2 * 0.09 * P * R * (1 - 0.07 * R / GUIDES), rel=1e-12)
