"""openTorsion, examples/ICE_example.py (MIT, S. Laine, U. Hakonen 2020): a Diesel engine, pressure digitised from
doi 10.1243/14644193JMBD126. Case OT1.

The source takes 500 samples of the straight lines between the digitised points over 720°, divides them by 15.2 MPa and
multiplies by the peak pressure at the speed. Its firing dead centre is at 360°.
"""

from __future__ import annotations

import math
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from kurbel.machine import Cylinder, Machine
from kurbel.machine.indicator import Indicator
from kurbel.machine.measured import Measured
from kurbel.machine.parts import Masses, Piston
from kurbel.machine_file import load
from kurbel.mechanisms.slider_crank import SliderCrank
from kurbel.solver.case import Case
from kurbel.solver.forces import CylinderForces

FOLDER = Path(__file__).resolve().parents[3] / "shared" / "data"
PRESSURES, PEAKS = FOLDER / "opentorsion_pressure_data.csv", FOLDER / "opentorsion_peak_data.csv"
MPA = 1e6
pytestmark = pytest.mark.skipif(not PRESSURES.is_file(), reason="the digitised pressures are not here")


@cache
def curves() -> tuple[Any, Any]:
    return np.loadtxt(PRESSURES, delimiter=";"), np.loadtxt(PEAKS, delimiter=";")


def engine(angles: Any, pressures: Any, rpm: float) -> CylinderForces:
    """The engine of the source with a trace in MPa."""
    points = list(zip(angles.tolist(), pressures.tolist()))
    trace = Measured.from_keys(unit=(MPA, 1), points=points, angle_zero=360.0)
    own = Cylinder(
        SliderCrank(0.137 / 2, 0.207), pistons=(Piston(0.105, indicator=Indicator(trace)),), masses=Masses(2.521)
    )
    return CylinderForces(Machine((own,), speed=rpm / 60, cycle="four-stroke"), own)


def scaled(rpm: float, samples: int) -> CylinderForces:
    curve, peaks = curves()
    angles = np.linspace(0, 720, samples)
    peak = np.interp(rpm, peaks[:, 0], peaks[:, 1])
    return engine(angles, np.interp(angles, curve[:, 0], curve[:, 1]) / 15.2 * peak, rpm)


@pytest.mark.parametrize(("rpm", "torque"), [(1000, 168.05), (2000, 175.49), (2500, 92.39)])
def test_mean_torque(rpm: float, torque: float) -> None:
    forces = scaled(rpm, 500)
    assert (forces.work or 0) / (4 * math.pi) == pytest.approx(torque, abs=0.005)
    assert (forces.W or 0) * 0.0685 == pytest.approx(torque, abs=0.005)


@pytest.mark.parametrize(
    ("rpm", "degrees", "pressure", "torque"),
    [
        (1500, 30, 0.261680, -95.8850388724),
        (1500, 390, 8.529987, 3068.82161564),
        (1500, 450, 1.743724, 1136.62937123),
        (2500, 30, 0.138542, -491.537966498),
        (2500, 90, 0.137851, 366.077900143),
        (2500, 150, 0.145843, 229.45123778),
    ],
)
def test_crank_torque(rpm: float, degrees: float, pressure: float, torque: float) -> None:
    """The printed pressures have six decimals; the torques are exact, those of the source's series are 1 % off."""
    at = scaled(rpm, 721).at([degrees - 360.0])
    assert at.p_head[0] / MPA == pytest.approx(pressure, abs=5.1e-7)
    assert at.M[0] == pytest.approx(torque, abs=2e-3)


def test_the_file_itself_runs(tmp_path: Path) -> None:
    """Uneven samples, semicolons, firing at 360°: the work is that of a trapezoid rule on very many angles."""
    (tmp_path / "ot.yaml").write_text(
        "cycle: four-stroke\nspeed: 1500 rpm\nstroke: 137 mm\nrod: 207 mm\nbore: 105 mm\nindicator:\n  head_end:\n"
        f"    trace: {{file: {PRESSURES}, unit: MPa, delimiter: semicolon, angle_zero: 360 deg}}\n"
        "masses: {other: 2.521 kg}\n"
    )
    forces = Case(load(tmp_path / "ot.yaml")).cylinders[0]
    curve, _ = curves()
    phi = np.linspace(0, 720, 720_001)
    psi = np.arcsin(0.0685 / 0.207 * np.sin(np.radians(phi)))
    slope = 0.0685 * np.sin(np.radians(phi) + psi) / np.cos(psi)
    torque = np.interp(phi, curve[:, 0], curve[:, 1]) * MPA * slope * math.pi / 4 * 0.105**2
    steps = (torque[1:] + torque[:-1]) / 2
    assert forces.work == pytest.approx(steps.mean() * 4 * math.pi, rel=1e-7)
    assert abs(forces.energy_residual or 0.0) < 1e-13
