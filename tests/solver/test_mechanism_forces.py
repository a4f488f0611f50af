"""Forces of every mechanism by the law of virtual work, and what each mechanism has of its own."""

import math
from typing import Any

import numpy as np
import pytest

from kurbel.machine import Cylinder, Machine
from kurbel.machine.indicator import Indicator
from kurbel.machine.parts import Friction, Masses, Moment, Piston, RamForce, Rings
from kurbel.mechanisms import Mechanism
from kurbel.mechanisms.four_bar import FourBar
from kurbel.mechanisms.parallel_crank import ParallelCrank
from kurbel.mechanisms.scotch_yoke import ScotchYoke
from kurbel.mechanisms.slider_crank import SliderCrank, YokeFrame
from kurbel.mechanisms.slotted_lever import SlottedLever
from kurbel.solver.forces import CylinderForces
from machines import AT, STEAM_CARD
from representative import law_of_each

SLIDING: dict[str, Mechanism] = {
    "slider-crank": SliderCrank(0.4, 2.0),
    "infinite rod": SliderCrank(0.4, math.inf),
    "offset": SliderCrank(0.3, 0.5, 0.1),
    "scotch yoke": ScotchYoke(0.25, 0.9, 0.05, 0.06),
    "yoke frame": YokeFrame(0.1, 0.3, gland=0.2),
    "shaper": SlottedLever(0.3, 0.8, 1.3),
    "shaper with link": SlottedLever(0.3, 0.8, 1.3, link=0.5),
    "pin close to the pivot": SlottedLever(0.3, 0.32, 0.7),
    "Whitworth": SlottedLever(0.15, 0.1, 0.2),
    "Whitworth with link": SlottedLever(0.15, 0.1, 0.2, link=0.6, ram_height=-0.07),
}
TURNING: dict[str, Mechanism] = {
    "four-bar": FourBar(0.04, 0.15, 0.08, 0.15),
    "four-bar, slow back": FourBar(0.04, 0.08, 0.15, 0.15),
    "parallel crank": ParallelCrank(0.3, 2.0, 140.0),
}
STEAM = Piston(
    0.2, head_end_rod=0.0, crank_end_rod=0.03, indicator=Indicator(STEAM_CARD, STEAM_CARD)
)
DENSE = np.arange(0.5, 360.0, 1.0)


def solved(mechanism: Mechanism, rpm: float | None = 90, **cylinder: Any) -> CylinderForces:
    own = Cylinder(mechanism, **cylinder)
    return CylinderForces(Machine((own,), speed=None if rpm is None else rpm / 60), own)


def every(machines: dict[str, Mechanism]) -> Any:
    return law_of_each(machines.values())


@every(SLIDING)
def test_steam_does_the_work_of_its_cards_in_any_mechanism(mechanism: Mechanism) -> None:
    """∮ M dφ is the area of the cards: the chambers see x from the dead centre, wherever the book counts it from."""
    forces = solved(mechanism, pistons=(STEAM,), masses=Masses(80))
    points = STEAM_CARD.lines
    area = sum(
        (z1 - z0) * (p0 + p1) / 2
        for line in points
        for (z0, p0), (z1, p1) in zip(
            zip(line.fractions, line.pressures), zip(line.fractions[1:], line.pressures[1:])
        )
    )
    assert forces.work == pytest.approx(
        (STEAM.head_area + STEAM.crank_area) * area * mechanism.stroke, rel=1e-13
    )
    assert forces.energy_residual == pytest.approx(0, abs=2e-14)
    pressures = forces.at(np.array(mechanism.dead_centres()) + 1e-9).p_head
    assert pressures == pytest.approx([9.5 * AT, 1.2 * AT], rel=1e-6)


@every(SLIDING)
def test_the_ram_takes_its_force_times_its_strokes(mechanism: Mechanism) -> None:
    forces = solved(mechanism, ram_force=RamForce(5000, 700))
    assert forces.resistance_work == pytest.approx(-5700 * mechanism.stroke, rel=1e-15)
    assert forces.energy_residual == pytest.approx(0, abs=2e-14)
    assert forces.W * mechanism.crank * 2 * math.pi == pytest.approx(
        -5700 * mechanism.stroke, rel=1e-14
    )
    assert forces.work is None


@every(SLIDING)
def test_rings_rub_in_any_mechanism(mechanism: Mechanism) -> None:
    rings = Friction(rings=Rings(2, 0.01, 3e4, 0.1))
    forces = solved(mechanism, pistons=(STEAM,), friction=rings)
    rubbing = 2 * math.pi * 0.2 * 0.01 * 3e4 * 0.1
    assert forces.friction_work == pytest.approx(rubbing * 2 * mechanism.stroke, rel=1e-14)
    assert forces.energy_residual == pytest.approx(0, abs=2e-14)


def test_guides_and_pin_of_a_scotch_yoke() -> None:
    """The couple of P on the piston rod and on the pin, R sin φ apart, rests on two guides."""
    forces = solved(
        ScotchYoke(0.25, guide_length=0.9, pin_diameter=0.05, pin_length=0.06), pistons=(STEAM,)
    )
    state = forces.at(DENSE)
    assert state["N_pair"] * 0.9 == pytest.approx(
        state.P * 0.25 * np.sin(np.radians(DENSE)), rel=1e-12, abs=1e-9
    )
    assert state["F_pin"] == pytest.approx(state.P, rel=1e-15)
    force = (
        9.5 * STEAM.head_area - 1.2 * STEAM.crank_area
    ) * AT  # the same on the return stroke is less
    assert forces["pin_pressure"].value == pytest.approx(force / (0.05 * 0.06), rel=1e-14)


def test_side_force_bends_the_piston_rod_of_a_yoke_frame() -> None:
    forces = solved(YokeFrame(0.1, 0.3, gland=0.2), pistons=(STEAM,))
    state = forces.at(DENSE)
    psi = np.arcsin(np.sin(np.radians(DENSE)) / 3)
    way = 0.4 - 0.1 * np.cos(np.radians(DENSE)) - 0.3 * np.cos(psi)
    assert state["M_bend"] == pytest.approx(
        state.P * np.tan(psi) * (0.2 + way), rel=1e-11, abs=1e-9
    )
    result = forces.extremes_of("M_bend")
    assert result.largest.value >= state["M_bend"].max()
    assert result.largest.value == pytest.approx(state["M_bend"].max(), rel=1e-3)
    assert solved(YokeFrame(0.1, 0.3), pistons=(STEAM,)).at(DENSE)["M_bend"] is None


@every(TURNING)
def test_a_moment_passes_to_the_crank_as_the_output_turns(mechanism: Mechanism) -> None:
    """M ω = M₂ θ̇ at every angle, against the motion, and the work of a turn is moment times swing."""
    resistance = Moment(40) if mechanism.turns else Moment(40, 10)
    forces = solved(mechanism, moment=resistance)
    state = forces.at(DENSE)
    omega = 2 * math.pi * 1.5
    assert state.M * omega == pytest.approx(state.M_out * state["theta_dot"], rel=1e-13)
    assert (state.M <= 0).all()
    work = -40 * 2 * math.pi if mechanism.turns else -50 * math.radians(mechanism.swing or 0)
    assert forces.resistance_work == pytest.approx(work, rel=1e-14)
    assert forces.energy_residual == pytest.approx(0, abs=2e-14)
    assert (state.P, state.x, state.c, state.S, state.D) == (None,) * 5


@pytest.mark.parametrize("name", ["four-bar", "four-bar, slow back"])
def test_the_slower_swing_works(name: str) -> None:
    mechanism = TURNING[name]
    state = solved(mechanism, moment=Moment(40, 10)).at(DENSE)
    working = abs(state.M_out) == 40
    share = working.mean()
    assert share == pytest.approx(mechanism.phi_work / 360, abs=0.006)
    assert share > 0.5
    assert len(set(np.sign(state["theta_dot"][working]))) == 1


def test_inertia_of_a_coupling_rod() -> None:
    """m v²/R, R ch. 14 A."""
    forces = solved(ParallelCrank(0.305, 2.1, 145.0), rpm=240, moment=Moment(9000))
    assert forces["coupler_inertia"].value == pytest.approx(
        145 * (0.305 * 8 * math.pi) ** 2 / 0.305, rel=1e-14
    )
    result = forces.extremes_of("F_coupler")
    assert result.largest.value == pytest.approx(9000 / 0.305, rel=1e-14)
    assert (
        "coupler_inertia" not in solved(ParallelCrank(0.305, 2.1), moment=Moment(9000)).key_values()
    )
