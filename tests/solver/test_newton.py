"""Newton's law for every body sees a fault in any of the forces, and nothing where they are right."""

from typing import Any

import pytest

from kurbel import Case, loads
from kurbel.solver import newton
from kurbel.solver.drive import ExactRod
from kurbel.solver.state import State, reduced_inertia
from random_cylinders import cylinders

ENGINE = """
{speed: 1500 rpm, crank: 60 mm, rod: 210 mm, offset: 4 mm, bore: 110 mm, inclination: 30 deg, cycle: four-stroke,
 indicator: {head_end: {otto: {intake: 0 bar, compression_ratio: 9, peak: 50 bar}}},
 masses: {piston: 1.2 kg, connecting_rod: {mass: 1.5 kg, center_of_gravity: 140 mm, inertia: 0.012 kg m2}},
 friction: {crosshead: 0.05, crank_pin: 0.02, crank_pin_diameter: 60 mm, crosshead_pin: 0.02,
            crosshead_pin_diameter: 30 mm, journals: 0.01, journal_diameter: 70 mm}}
"""


def residual() -> float:
    result = Case(loads(ENGINE)).cylinders[0].residual
    return result


def test_sound_forces_leave_nothing_open() -> None:
    assert residual() <= 1e-12


def test_sound_forces_of_random_cylinders_leave_nothing_open() -> None:
    for forces in cylinders(31, 10, friction=True):
        assert forces.residual is None or forces.residual <= 1e-12


def wrong_side(state: State) -> Any:
    sin_psi, cos_psi = state.rod_angle
    return cos_psi - sin_psi * (state.guide_sign * state.direction * state.drive.crosshead_friction)


def wrong_weight(state: State) -> Any:
    along, across = state.drive.weight_of(exact(state).pin_mass) or (0.0, 0.0)
    couple = -state.rod_couple / (state.rod_angle[1] * state.mechanism.rod_length) * state.angle.cos
    return couple - (state.angle.sin * along - state.angle.cos * across)


def more_pull(state: State) -> Any:
    (sin_psi, cos_psi), angle = state.rod_angle, state.angle
    sin, cos = angle.sin * cos_psi + angle.cos * sin_psi, angle.cos * cos_psi - angle.sin * sin_psi
    return state.T * sin + (state.D - 1e-3 * state.drive.centrifugal(exact(state).pin_mass)) * cos


def less_inertia(state: State) -> Any:
    return reduced_inertia(state) - 1e-3 * state.rod_slope**2 * exact(state).excess_inertia


def exact(state: State) -> ExactRod:
    return state.drive.rod


LOSSES = State.losses.func
COUPLE = State.rod_couple.func
FAULTS: dict[str, tuple[Any, str, Any]] = {
    "side of the guide friction in N": (State, "guide_denominator", property(wrong_side)),
    "weight of the rod's part at the pin in T": (State, "_rod_tangential", property(wrong_weight)),
    "turning of the rod on the pin": (
        State,
        "losses",
        property(
            lambda state: (
                LOSSES(state) | {"crank_pin": state.rubbing.at_crank * (1 - state.rod_slope)}
            )
        ),
    ),
    "couple of the rod": (State, "rod_couple", property(lambda state: COUPLE(state) * (1 + 1e-6))),
    "radial pull in S at the crank pin": (State, "S_crank", property(more_pull)),
    "reduced inertia of the rod": (newton, "reduced_inertia", less_inertia),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_a_planted_fault_shows(fault: str, monkeypatch: pytest.MonkeyPatch) -> None:
    owner, name, wrong = FAULTS[fault]
    monkeypatch.setattr(owner, name, wrong)
    assert residual() > 1e-9
