"""Cycles of 720°: which line acts when, double-acting and standing, mixed with everything else."""

import math
from itertools import pairwise
from typing import Any

import numpy as np
import pytest

from kurbel.machine import Cylinder, Machine
from kurbel.machine.ideal_cards import Compressor, Otto
from kurbel.machine.indicator import Card, Constant, Indicator
from kurbel.machine.measured import Measured
from kurbel.machine.parts import Friction, Masses, Piston
from kurbel.mechanisms.slider_crank import SliderCrank
from kurbel.solver.forces import CylinderForces
from machines import STEAM_CARD, constant_pressure

BAR = 1e5
LINES: dict[str, list[tuple[float, float]]] = {
    "expansion": [(0, 6), (0.04, 24), (0.2, 9), (0.5, 4), (0.88, 2.2), (1, 0.6)],
    "exhaust": [(1, 0.6), (0.9, 0.1), (0, 0.05)],
    "intake": [(0, 0.05), (0.05, -0.1), (1, -0.15)],
    "compression": [(1, -0.15), (0.5, 0.7), (0.2, 2.5), (0, 6)],
}
CARD = Card.from_keys(unit=(BAR, 1), **LINES)
MECHANISM = SliderCrank(0.15, 0.66)


def engine(
    head: Any = CARD, crank: Any = None, mechanism: Any = MECHANISM, rpm: float = 300, **more: Any
) -> CylinderForces:
    own = Cylinder(
        mechanism,
        pistons=(
            Piston(0.22, head_end_rod=0.0, crank_end_rod=0.06, indicator=Indicator(head, crank)),
        ),
        **more,
    )
    return CylinderForces(Machine((own,), speed=rpm / 60, cycle="four-stroke"), own)


def area(line: str) -> float:
    """∫ p dz under a line, in Pa, along the stroke fraction as the line runs."""
    points = LINES[line]
    return BAR * sum((b[0] - a[0]) * (a[1] + b[1]) / 2 for a, b in pairwise(points))


@pytest.mark.parametrize(
    "mechanism", [MECHANISM, SliderCrank(0.15, 0.66, 0.1), SliderCrank(0.15, math.inf)]
)
def test_lines_in_the_order_of_the_process(mechanism: SliderCrank) -> None:
    """Firing dead centre, expansion out, exhaust back, intake out, compression back; offset cranks too."""
    inner, outer = mechanism.dead_centres()
    forces = engine(mechanism=mechanism)
    outs = mechanism.crank_angles_at(np.array([0.2 * mechanism.stroke]), True)[0]
    back = mechanism.crank_angles_at(np.array([0.2 * mechanism.stroke]), False)[0]
    at = forces.at([outs, back, outs + 360, back + 360])
    exhaust = 0.05 + 0.2 / 0.9 * 0.05
    intake = -0.1 - 0.15 / 0.95 * 0.05
    assert at.p_head == pytest.approx(np.array([9, exhaust, intake, 2.5]) * BAR, rel=1e-12)
    corners = forces.at([inner, outer, inner + 360, outer + 360]).p_head
    assert corners == pytest.approx(np.array([6, 0.6, 0.05, -0.15]) * BAR, rel=1e-9)


def test_the_crank_end_fires_one_stroke_later() -> None:
    forces = engine(None, CARD)
    at = forces.at([180.0, 360.0, 540.0, 0.0]).p_crank
    assert at == pytest.approx(np.array([6, 0.6, 0.05, -0.15]) * BAR)


def test_work_is_that_of_both_loops() -> None:
    forces = engine()
    expected = sum(map(area, LINES)) * math.pi / 4 * 0.22**2 * 0.3
    assert forces.work == pytest.approx(expected, rel=1e-13)
    assert forces.power == pytest.approx(expected * 5 / 2, rel=1e-13)
    assert forces.mean_pressure == pytest.approx(sum(map(area, LINES)), rel=1e-13)
    assert pytest.approx(expected / (4 * math.pi * 0.15), rel=1e-13) == forces.W


@pytest.mark.parametrize(
    ("crank_end", "more"),
    [
        (None, {}),
        (CARD, {}),
        (CARD, {"masses": Masses(90.0), "inclination": 90.0}),
        (CARD, {"masses": Masses(90.0), "inclination": 0.0, "friction": Friction(0.1)}),
        (None, {"masses": Masses(60.0), "friction": Friction(0.06)}),
    ],
    ids=["single", "double", "standing", "lying with friction", "friction"],
)
def test_energy_over_the_cycle(crank_end: Any, more: dict[str, Any]) -> None:
    """The quadrature of T over 720° is the closed work less friction."""
    forces = engine(CARD, crank_end, **more)
    assert abs(forces.energy_residual or 0.0) < 1e-14
    assert forces.breaks[-1] == 720
    if crank_end:
        head, crank = forces.drive.gas[0].works
        assert crank == pytest.approx(head * (0.22**2 - 0.06**2) / 0.22**2, rel=1e-14)


@pytest.mark.parametrize(
    "pump",
    [
        constant_pressure(2e5),
        Constant.from_keys(expansion=-0.3e5, compression=6e5),
        STEAM_CARD,
        Compressor(0.0, 6e5, clearance=0.05),
        Measured.from_keys(
            unit=(1e5, 1), points=[(0.0, 6.0), (90.0, 0.1), (200.0, 0.0), (360.0, 6.0)]
        ),
    ],
    ids=["gas at rest", "pump", "card", "compressor", "trace"],
)
def test_a_pump_behind_a_four_stroke_engine_works_on_every_turn(pump: Any) -> None:
    """Its force repeats after 360°, and its work counts twice in 720°; the engine's is that without it."""
    engine = Piston(0.3, indicator=Indicator(Otto(0.0, 25e5, clearance=0.2)))
    behind = Piston(0.2, indicator=Indicator(pump), name="pump")
    mechanism = SliderCrank(0.2, 0.9)

    def solved(cycle: str, *pistons: Piston) -> CylinderForces:
        own = Cylinder(mechanism, pistons=pistons)
        return CylinderForces(Machine((own,), speed=2.0, cycle=cycle), own)

    both, alone, pumping = (
        solved("four-stroke", engine, behind),
        solved("four-stroke", engine),
        solved("two-stroke", behind),
    )
    degrees = np.arange(1.0, 720.0, 7.3)
    expected = alone.at(degrees).P + pumping.at(degrees).P
    assert pytest.approx(expected, rel=1e-12, abs=1e-6) == both.at(degrees).P
    assert both.work == pytest.approx(
        (alone.work or 0) + 2 * (pumping.work or 0), rel=1e-12, abs=1e-6
    )
    assert abs(both.energy_residual or 0.0) < 1e-12
