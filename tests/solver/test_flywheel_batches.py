"""Many machines in one batch have the turning, flywheel, speed line and coupling that each has alone."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from batches import batch
from kurbel import load
from kurbel.errors import KurbelError
from kurbel.machine import Machine
from kurbel.machine.turning import Flywheel, Load
from kurbel.solver.case import Case

CONFIGS = Path(__file__).parents[2] / "configs"
WATERWORKS, TWO_CRANKS = load(CONFIGS / "waterworks.yaml"), load(CONFIGS / "waterworks-two-cranks.yaml")
COUPLED = load(CONFIGS / "generator-coupling.yaml")
VALUES = (
    *("M_mean", "dE", "E_max", "M_max", "J", "J_needed", "delta", "delta_book", "omega_max", "omega_mean", "alpha_min"),
    *("multiplier", "natural_order", "M_coupling_max", "amplification", "energy_fluctuation", "phi_crossing", "lobes"),
)


def value_of(machine: Machine, id: str) -> object:
    """A key value of a machine alone; nan where it has none, or no solution."""
    try:
        return Case(machine).flywheel[id].value
    except KurbelError:
        return float("nan")


def differences(machines: Sequence[Machine], answered: Sequence[bool]) -> list[str]:
    """Return the key values of machines of a batch that are not those alone; answered: which have any there."""
    together, found = Case(batch(machines), len(machines)).flywheel, []
    for id in VALUES:
        try:
            each = together[id].value
        except KurbelError:
            each = [float("nan")] * len(machines)
        for machine, one, fit in zip(
            machines, each if np.ndim(each) or isinstance(each, tuple) else [each] * 9, answered
        ):
            if fit and one != pytest.approx(value_of(machine, id), rel=1e-12, nan_ok=True):
                found.append(f"{id}: {one} and {value_of(machine, id)}")
    return found


@pytest.mark.parametrize("wanted", [None, Load(power=2.0), Load(power=-2.0), Load(slip=0.001)])
def test_light_and_heavy_flywheels(wanted: Load | None) -> None:
    """The lightest machines stall: they have no speed line in a batch either."""
    wheels = [replace(WATERWORKS, flywheel=Flywheel(inertia), load=wanted) for inertia in (10.0, 300.0, 1e3, 1e5)]
    assert differences(wheels, [True] * 4) == []


def test_cranks_that_differ_and_an_efficiency_with_which_one_cannot_run() -> None:
    machines = [replace(TWO_CRANKS, efficiency=eta, flywheel=Flywheel(None, 0.01)) for eta in (0.8, 0.9, 1.0)]
    assert differences(machines, [False, True, True]) == []


def test_couplings() -> None:
    """One that counts as rigid is left to be answered alone."""
    machines = [
        replace(COUPLED, coupling=replace(COUPLED.coupling, stiffness=stiffness)) for stiffness in (1e4, 3e5, 1e6, 1e10)
    ]
    assert differences(machines, [True, True, True, False]) == []
    assert np.isnan(Case(batch(machines), 4).flywheel.delta[3])
