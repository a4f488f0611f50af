"""The Python API, as a notebook uses it."""

from __future__ import annotations

import math
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import kurbel
from kurbel.mechanisms.slider_crank import SliderCrank

CONFIGS = Path(__file__).parent.parent / "configs"


def test_every_public_name_exists() -> None:
    for name in kurbel.__all__:
        assert getattr(kurbel, name).__doc__
    assert set(kurbel.__all__) <= set(dir(kurbel))
    with pytest.raises(AttributeError, match="no attribute 'lood'"):
        _ = kurbel.lood  # type: ignore[attr-defined]


def test_import_kurbel_imports_nothing_else() -> None:
    code = "import sys, kurbel; print([m for m in sys.modules if m in ('numpy', 'yaml', 'click', 'rich')])"
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout == "[]\n"


def test_load_and_solve() -> None:
    case = kurbel.solve(kurbel.load(CONFIGS / "waterworks.yaml"))
    state = case.cylinders[0].at(np.arange(0.0, 361.0, 10.0))
    assert state.T.shape == (37,)
    assert state.x[18] == 0.8


def test_a_machine_built_in_python_is_the_machine_of_the_file() -> None:
    from_file = kurbel.loads("{speed: 50 rpm, stroke: 800 mm, rod_ratio: 5}")
    built = kurbel.Machine((kurbel.Cylinder(kurbel.SliderCrank(0.4, 2.0)),), speed=50 / 60)
    for machine in (from_file, built):
        motion = kurbel.solve(machine).cylinders[0].motion
        assert motion.c_max is not None
        assert motion.c_max.value == pytest.approx(1.0198331 * 0.4 * 2 * math.pi * 50 / 60, rel=1e-7)


def test_rules_hold_in_python_too() -> None:
    with pytest.raises(kurbel.KurbelError, match="rod: 300 mm is shorter than the crank"):
        SliderCrank(crank=0.4, rod=0.3)


def test_functions_are_pointwise() -> None:
    """f(φ)[::7] == f(φ[::7]): no quantity knows its neighbours."""
    forces = kurbel.solve(kurbel.load(CONFIGS / "waterworks.yaml")).cylinders[0]
    degrees = np.linspace(0, 360, 721)
    whole, part = forces.at(degrees), forces.at(degrees[::7])
    for name in ("psi", "x", "c", "b", "p_head", "p_crank", "P_gas", "P_inertia", "P", "S", "N", "D", "T", "M"):
        assert (getattr(whole, name)[::7] == getattr(part, name)).all()


def test_results_repeat_every_turn() -> None:
    forces = kurbel.solve(kurbel.load(CONFIGS / "waterworks.yaml")).cylinders[0]
    degrees = np.arange(0.0, 360.0, 7.5)
    for name in ("x", "P", "T", "N"):
        assert (getattr(forces.at(degrees), name) == getattr(forces.at(degrees + 3600), name)).all()
