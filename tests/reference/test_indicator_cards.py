"""Published examples that start from an indicator card or an ideal cycle."""

from __future__ import annotations

import math

import pytest

from kurbel.declared.units import GRAVITY
from kurbel.machine import Cylinder, Machine
from kurbel.machine.ideal_cards import Diesel
from kurbel.machine.indicator import Indicator
from kurbel.machine.parts import Masses, Piston
from kurbel.mechanisms.slider_crank import SliderCrank
from kurbel.solver.forces import CylinderForces
from machines import constant_pressure, one_cylinder

PSI, POUND, INCH, FOOT = 0.45359237 * 9.80665 / 0.0254**2, 0.45359237 * 9.80665, 0.0254, 0.3048


def test_sarkar_5_8_diesel_card_from_its_numbers() -> None:
    """B. K. Sarkar, Theory of Machines, p. 166: ε = 14, p V^1.35, cut-off at 1/10 stroke; at 60° exactly 8824.91 N m.

    (Printed 8850.3, by the first-order inertia force.) The book takes g = 9.81.
    """
    card = Diesel(0.1e6, cut_off=0.1, clearance=1 / 13, exponent=1.35, expansion_exponent=1.35)
    piston = Piston(0.25, indicator=Indicator(card, absolute=True))
    own = Cylinder(SliderCrank(0.2, 0.8), pistons=(piston,), masses=Masses(200.0), inclination=90.0)
    state = CylinderForces(Machine((own,), speed=5.0, ambient=0.1e6), own).at([60.0])
    assert state.M[0] - 200 * (GRAVITY - 9.81) * state.slope[0] == pytest.approx(8824.91126743, rel=1e-11)


def test_tredgold_mean_pressure_of_a_card() -> None:
    """T. Tredgold, The Steam Engine, 1838, p. 387: 15.35 lb/in² on 2827 in² are 43 394 lb, and power at 252 ft/min."""
    area = 2827 * INCH**2
    bore = math.sqrt(4 * area / math.pi)
    # two strokes of 7 ft, 18 revolutions a minute; both ends at the mean pressure against nothing
    card = constant_pressure(15.35 * PSI)
    stroke = 7 * FOOT
    forces = one_cylinder(SliderCrank(stroke / 2, math.inf), 18, pistons=(Piston(bore, indicator=Indicator(card)),))
    assert forces.at([90.0]).P_gas[0] / POUND == pytest.approx(43394.45, rel=1e-12)
    assert (forces.motion.c_m or 0) / FOOT * 60 == pytest.approx(252, rel=1e-12)


def test_tredgold_work_of_the_mean_pressure() -> None:
    """A double-acting card of that mean pressure does its force times the piston speed."""
    from kurbel.machine.indicator import Constant

    area, stroke = 2827 * INCH**2, 7 * FOOT
    card = Constant.from_keys(expansion=15.35 * PSI, compression=0.0)
    piston = Piston(math.sqrt(4 * area / math.pi), indicator=Indicator(card, card))
    forces = one_cylinder(SliderCrank(stroke / 2, math.inf), 18, pistons=(piston,))
    assert forces.power == pytest.approx(43394.45 * POUND * 252 * FOOT / 60, rel=1e-12)
    assert forces.mean_pressure == pytest.approx(15.35 * PSI, rel=1e-12)


def test_the_shipped_diesel_follows_the_curves_that_it_names() -> None:
    """p V^1.36 and p V^1.3 with a clearance of 0.08 of the stroke volume, rounded to 0.1 bar."""
    from pathlib import Path

    from kurbel.machine_file import load

    machine = load(Path(__file__).parents[2] / "configs" / "diesel-four-stroke.yaml")
    indicator = machine.cylinders[0].pistons[0].indicator
    assert indicator is not None
    expansion, *_, compression = indicator.head_end.lines  # type: ignore[union-attr]
    for line, (z, gauge), exponent, last in (
        (compression, (1.0, -0.1e5), 1.36, 9),
        (expansion, (0.08, 32.5e5), 1.3, 7),
    ):
        for fraction, pressure in list(zip(line.fractions, line.pressures))[1:last]:
            drawn = (gauge + 101325) * ((z + 0.08) / (fraction + 0.08)) ** exponent - 101325
            assert pressure == pytest.approx(drawn, abs=0.051e5)
