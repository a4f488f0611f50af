"""Indicated work, power and mechanical efficiency of the whole machine, from the balance of its energy."""

import pytest

import kurbel
from representative import CONFIGS

BALANCED = [
    "waterworks",
    "waterworks-two-cranks",
    "compressor-two-stage",
    "locomotive",
    "diesel-four-stroke",
]


@pytest.mark.parametrize("name", BALANCED)
def test_work_put_in_is_work_given_off_and_friction(name: str) -> None:
    case = kurbel.solve(kurbel.load(CONFIGS[name]))
    works = [cylinder.work_driving for cylinder in case.cylinders]
    driven = -sum(cylinder.work_driven for cylinder in case.cylinders)
    lost = sum(cylinder.friction_work or 0.0 for cylinder in case.cylinders)
    shaft = case.flywheel.work_shaft
    put_in = sum(works) + max(-shaft, 0.0)
    assert case.flywheel.work_indicated == pytest.approx(sum(works) or -driven, rel=1e-12)
    assert case.flywheel.mechanical_efficiency == pytest.approx((put_in - lost) / put_in, rel=1e-9)
    cycles_per_second = case.machine.speed / case.machine.revolutions
    assert case.flywheel.power_indicated == pytest.approx(
        case.flywheel.work_indicated * cycles_per_second, rel=1e-12
    )


def test_loss_of_redtenbachers_locomotive() -> None:
    """1.304 % over the stroke: the crosshead alone rubs, on the forces of the steam and of the masses."""
    case = kurbel.solve(kurbel.load(CONFIGS["locomotive"]))
    assert 1 - case.flywheel.mechanical_efficiency == pytest.approx(
        case["loss_crosshead"].value, rel=1e-12
    )


def test_efficiency_of_the_file_is_that_of_the_machine() -> None:
    """Without friction η alone takes from the work of the pistons."""
    case = kurbel.solve(kurbel.load(CONFIGS["marine-diesel"]))
    assert case.flywheel.mechanical_efficiency == pytest.approx(case.machine.efficiency, rel=1e-12)


def test_ram_is_useful_work() -> None:
    """A crank that a motor drives against the resistance of a ram has no pistons, and no indicated work."""
    case = kurbel.solve(kurbel.load(CONFIGS["shaper"]))
    assert case.flywheel.work_indicated is None
    assert case.flywheel.mechanical_efficiency is None
