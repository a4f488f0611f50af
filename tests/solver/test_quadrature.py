"""Friction work and mean bearing loads against a quadrature that shares nothing with the solver but the integrand."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest

from kurbel.machine import Machine
from kurbel.machine.ideal_cards import Diesel
from kurbel.machine.indicator import Indicator
from kurbel.machine.parts import ConnectingRod, Friction, Masses, Piston
from kurbel.mechanisms.slider_crank import SliderCrank
from kurbel.solver.case import Case
from kurbel.solver.forces import CylinderForces
from kurbel.solver.stress import CrankshaftStrength
from kurbel.traces.correct import Trace
from machines import one_cylinder
from random_cylinders import cylinders
from shafts import shaft

GAUSS = np.polynomial.legendre.leggauss(12)
GRADES = 0.5 ** np.arange(1, 24)
Function = Callable[[np.ndarray], np.ndarray]


def with_least(function: Function, breaks: np.ndarray) -> np.ndarray:
    """The breaks, and all angles of least values of a dense scan: there a magnitude has its kinks, or is near to one.

    function: f ≥ 0 at crank angles (n,) in degrees.
    """
    low, high = breaks[:-1, None], breaks[1:, None]
    mesh = low + (high - low) * np.linspace(1e-9, 1 - 1e-9, 3001)
    values = function(mesh.ravel()).reshape(mesh.shape)
    rows, columns = np.nonzero((values[:, 1:-1] <= values[:, :-2]) & (values[:, 1:-1] < values[:, 2:]))
    left, right = mesh[rows, columns], mesh[rows, columns + 2]
    golden = (math.sqrt(5) - 1) / 2
    for _ in range(36):
        inner = right - golden * (right - left), left + golden * (right - left)
        lower = function(inner[0]) < function(inner[1])
        left, right = np.where(lower, left, inner[0]), np.where(lower, inner[1], right)
    cuts = np.sort(np.concatenate((breaks, (left + right) / 2)))
    return cuts[np.concatenate(([True], np.diff(cuts) > 1e-11))]


def precise_integral(function: Function, breaks: np.ndarray) -> float:
    """∫ |f| dφ: 12 Gauss points on parts that shrink by halves toward all breaks and all least values."""
    cuts = with_least(function, breaks)
    shares = np.concatenate(([0.0], GRADES[::-1], 1 - GRADES[1:], [1.0]))
    edges = cuts[:-1, None] + np.diff(cuts)[:, None] * shares
    half = np.radians(np.diff(edges))[..., None] / 2
    nodes = edges[:, :-1, None] + np.diff(edges)[..., None] * (1 + GAUSS[0]) / 2
    return math.fsum((function(nodes.ravel()).reshape(nodes.shape) * GAUSS[1] * half).ravel().tolist())


def friction_power(forces: CylinderForces) -> Function:
    def power(degrees: np.ndarray) -> np.ndarray:
        state = forces.at(degrees)
        return np.asarray(state.crosshead_drag * (state.slope * state.direction))

    return power


def edges_of(forces: CylinderForces) -> np.ndarray:
    """The ends of the pieces of the cycle."""
    return np.append(forces.pieces.low, forces.pieces.cycle)


def error_of_friction(forces: CylinderForces) -> float:
    precise = precise_integral(friction_power(forces), edges_of(forces))
    return abs(forces.friction_works["crosshead"] / precise - 1)


def bearing_load(strength: CrankshaftStrength, bearing: str) -> Function:
    def load(degrees: np.ndarray) -> np.ndarray:
        state = strength.forces.at(degrees)
        if bearing == "pin":
            return np.hypot(state.D, state.T)
        at, end = strength.at(degrees), bearing[-1]
        return np.hypot(at[f"{end}_D"], at[f"{end}_T"])

    return load


def errors_of_bearings(forces: CylinderForces) -> list[float]:
    machine = forces.drive.machine
    strength = Case(Machine((forces.drive.cylinder,), speed=machine.speed, crankshaft=shaft())).stress
    turn = math.radians(forces.drive.cycle)
    breaks = edges_of(forces)
    if forces.drive.cylinder.friction:  # where the guide changes sides, every force has a kink
        breaks = with_least(friction_power(forces), breaks)
    errors = []
    for bearing, diameter, length in (("pin", 0.18, 0.2), ("journal_A", 0.19, 0.3), ("journal_B", 0.19, 0.3)):
        found = strength.pressure_mean(bearing)
        assert found is not None
        precise = precise_integral(bearing_load(strength, bearing), breaks) / turn / diameter / length
        errors.append(abs(found / precise - 1))
    return errors


def rubbing_diesel() -> CylinderForces:
    """Piston force and rod angle pass zero beside each other: the guide changes sides twice between two nodes."""
    diesel = Diesel.from_keys(
        intake=-51379.84345506035,
        cut_off=0.032183767208578615,
        exponent=1.3138075981361519,
        compression_ratio=9.149748785327816,
    )
    return one_cylinder(
        SliderCrank(0.17495922359333085, 0.671018700829822, -0.0479227279492077),
        60 * 1.301188205871063,
        pistons=(Piston(0.20559387583925628, 0.01909191112069929, indicator=Indicator(diesel)),),
        masses=Masses(1326.5875, ConnectingRod(586.5834509198818, 0.35)),
        friction=Friction(0.1),
    )


def test_friction_where_the_guide_changes_sides_twice_at_once() -> None:
    forces = rubbing_diesel()
    assert error_of_friction(forces) <= 1e-12
    assert forces.energy_residual is not None
    assert abs(forces.energy_residual) <= 1e-14


@pytest.mark.parametrize("step", [0.9, 0.5])
def test_friction_between_samples_where_the_rod_swings_round_within_a_hair(step: float) -> None:
    """R/L = 0.999 and 400 or 720 samples: narrow as their pieces are, those beside 90° and 270° must be narrower."""
    angles = np.arange(0.0, 360.0 + step / 2, step)
    trace = Trace(angles, 1e5 * (6 + 4 * np.cos(np.radians(angles) - 0.4))[np.newaxis])
    forces = one_cylinder(
        SliderCrank(0.2, 0.2002),
        180,
        pistons=(Piston(0.3, indicator=Indicator(trace)),),
        masses=Masses(10.0),
        friction=Friction(0.02),
    )
    near = [centre + side * 10 * share for centre in (90, 270) for side in (1, -1) for share in (1, *GRADES)]
    breaks = np.unique(np.concatenate((edges_of(forces), near)))
    edges = breaks[:-1, None], breaks[1:, None]
    nodes = edges[0] + (edges[1] - edges[0]) * (1 + GAUSS[0]) / 2
    values = friction_power(forces)(nodes.ravel()).reshape(nodes.shape)
    precise = float((np.radians(edges[1] - edges[0]) / 2 * values * GAUSS[1]).sum())
    assert forces.friction_works["crosshead"] == pytest.approx(precise, rel=2e-12)


def test_friction_of_random_cylinders() -> None:
    for forces in cylinders(11, 3, friction=True):
        assert error_of_friction(forces) <= 1e-12
        assert forces.energy_residual is not None
        assert abs(forces.energy_residual) <= 1e-13


def test_mean_pressures_of_random_bearings() -> None:
    for forces in cylinders(12, 1):
        assert max(errors_of_bearings(forces)) <= 1e-12


@pytest.mark.slow
def test_friction_and_bearings_of_many_cylinders() -> None:
    for forces in cylinders(5, 8, friction=True):
        assert error_of_friction(forces) <= 1e-12
        assert max(errors_of_bearings(forces)) <= 1e-12
        assert forces.energy_residual is not None
        assert abs(forces.energy_residual) <= 1e-13
