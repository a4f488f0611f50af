"""Newton's law for every body sees a fault in any of the forces, and nothing where they are right."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest

from kurbel import Case, loads
from kurbel.solver import pins
from kurbel.solver.rod import ExactRod
from kurbel.solver.state import State
from random_cylinders import cylinders

ENGINE = """
{speed: 1500 rpm, crank: 60 mm, rod: 210 mm, offset: 4 mm, bore: 110 mm, inclination: 30 deg, cycle: four-stroke,
 indicator: {head_end: {otto: {intake: 0 bar, compression_ratio: 9, peak: 50 bar}}},
 masses: {piston: 1.2 kg, connecting_rod: {mass: 1.5 kg, center_of_gravity: 140 mm, inertia: 0.012 kg m2}},
 friction: {crosshead: 0.05, crank_pin: 0.02, crank_pin_diameter: 60 mm, crosshead_pin: 0.02,
            crosshead_pin_diameter: 30 mm, journals: 0.01, journal_diameter: 70 mm}}
"""


def residual() -> float:
    found = Case(loads(ENGINE)).cylinders[0].residual
    assert found is not None
    return found


def test_sound_forces_leave_nothing_open() -> None:
    assert residual() <= 1e-12


def test_sound_forces_of_random_cylinders_leave_nothing_open() -> None:
    for forces in cylinders(31, 10, friction=True):
        assert forces.residual is None or forces.residual <= 1e-12


def scaled(of: Callable[..., Any], by: float) -> Callable[..., Any]:
    return lambda *given: of(*given) * by


def wrong_side(state: State) -> Any:
    sin_psi, cos_psi = state.rod_angle
    return cos_psi - sin_psi * (state.guide_side * state.direction * state.drive.crosshead_friction)


def wrong_weight(rod: ExactRod, rod_angle: Any, angle: Any) -> Any:
    assert rod.weight is not None
    return -rod.side_force(rod_angle, angle) * angle.cos - (angle.sin * rod.weight[0] - angle.cos * rod.weight[1])


def more_pull(rod: ExactRod, rod_angle: Any, angle: Any, tangential: Any, radial: Any) -> Any:
    sin_psi, cos_psi = rod_angle
    sin, cos = angle.sin * cos_psi + angle.cos * sin_psi, angle.cos * cos_psi - angle.sin * sin_psi
    return tangential * sin + (radial - 1e-3 * rod.pull) * cos


FAULTS: dict[str, tuple[Any, str, Any]] = {
    "side of the guide friction in N": (State, "below", property(wrong_side)),
    "weight of the rod's part at the pin in T": (ExactRod, "tangential", wrong_weight),
    "turning of the rod on the pin": (pins.Rubbing, "crank_pin", property(lambda one: one.at_crank * (1 - one.slope))),
    "couple of the rod": (ExactRod, "couple", scaled(ExactRod.couple, 1 + 1e-6)),
    "radial pull in S at the crank pin": (ExactRod, "at_crank", more_pull),
    "reduced inertia of the rod": (ExactRod, "reduced_inertia", scaled(ExactRod.reduced_inertia, 0.999)),
}


@pytest.mark.parametrize("fault", FAULTS)
def test_a_planted_fault_shows(fault: str, monkeypatch: pytest.MonkeyPatch) -> None:
    owner, name, wrong = FAULTS[fault]
    monkeypatch.setattr(owner, name, wrong)
    assert residual() > 1e-9
