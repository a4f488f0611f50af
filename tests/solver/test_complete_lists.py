"""Lists of angles are complete: no sample of a dense scan between two listed angles has the other sign."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest

from kurbel.machine import Machine
from kurbel.solver.case import Case
from kurbel.solver.forces import CylinderForces
from machines import single_acting
from random_cylinders import cylinders

SAMPLES = 400
Evaluate = Callable[[np.ndarray, np.ndarray], np.ndarray]
"""A quantity at crank angles in degrees, on the sides of jumps that hold others."""


def scanned(breaks: np.ndarray, evaluate: Evaluate) -> tuple[np.ndarray, np.ndarray]:
    """Angles and values of the only quantity on a dense mesh, and at the summits of parabolas through its samples."""
    low, high = breaks[:-1, None], breaks[1:, None]
    degrees = low + (high - low) * np.linspace(0, 1, SAMPLES)
    within = np.broadcast_to((low + high) / 2, degrees.shape)
    found = evaluate(degrees, within)
    before, here, after = found[:, :-2], found[:, 1:-1], found[:, 2:]
    bend = before - 2 * here + after
    step = np.clip((before - after) / np.where(bend == 0, 1.0, bend) / 2, -1, 1)
    summits = degrees[:, 1:-1] + step * np.diff(degrees)[:, 1:]
    at_summits = evaluate(summits, within[:, 1:-1])
    # ends stand beside each other, before and after a jump; between equal angles their order remains
    angles = np.concatenate((degrees, summits), axis=1)
    values = np.concatenate((found, at_summits), axis=1)
    order = np.argsort(angles, axis=1, kind="stable")
    return np.take_along_axis(angles, order, 1).ravel(), np.take_along_axis(values, order, 1).ravel()


def wrong_signs(found: np.ndarray, breaks: np.ndarray, evaluate: Evaluate, size: float = 0.0) -> int:
    """Count the samples whose sign is not that of the others between the same two listed angles, and false angles."""
    angles, values = scanned(breaks, evaluate)
    clear = np.abs(values) > 1e-12 * max(size, np.abs(values).max())
    apart = np.abs(angles[:, None] - np.array([*found, -1.0])).min(axis=1) > 1e-9
    angles, signs = angles[clear & apart], np.sign(values[clear & apart])
    arc = np.searchsorted(found, angles) % max(len(found), 1)
    per_arc = [signs[arc == number] for number in range(max(len(found), 1))]
    mixed = sum(min((one > 0).sum(), (one < 0).sum()) for one in per_arc)
    # an arc so short that no sample falls into it tells nothing of its neighbours
    means = [one.mean() if len(one) else math.nan for one in per_arc]
    same = sum(a == b for a, b in zip(means, [*means[1:], means[0]])) if len(found) else 0
    return int(mixed) + int(same)


def force_along(forces: CylinderForces) -> Evaluate:
    return lambda degrees, within: forces.at(degrees.ravel(), within.ravel()).P.reshape(degrees.shape)


def missing_reversals(forces: CylinderForces) -> int:
    found, extremes = forces.phi_reversal, forces.extremes_of("P")
    assert found is not None
    assert extremes is not None
    both = extremes.largest.value > 0 > extremes.smallest.value
    return wrong_signs(np.array(found), forces.breaks, force_along(forces)) + int(bool(found) != both)


def missing_crossings(forces: CylinderForces) -> int:
    shaft = Case(Machine((forces.drive.cylinder,), speed=forces.drive.machine.speed)).flywheel
    found = shaft.extremes_of("T")
    assert found is not None
    assert shaft.W is not None
    mean = shaft.W

    def evaluate(degrees: np.ndarray, within: np.ndarray) -> np.ndarray:
        return shaft.at(degrees.ravel(), within.ravel()).T.reshape(degrees.shape) - mean

    size = max(abs(extreme.value) for extreme in found)
    return wrong_signs(np.array(shaft.phi_crossing), forces.breaks, evaluate, size)


@pytest.mark.parametrize("summit", [11.4, 1.0, 1e-3, 1e-6])
def test_a_short_druckwechsel_is_found(summit: float) -> None:
    """A constant pressure that leaves P_max of a few newtons beside a P_min of thousands."""
    lowest = single_acting(0.4, 0.4 / 0.3, 0.3, 0.0, 120, 100).motion.b_min
    assert lowest is not None
    pressure = (summit + 100 * lowest.value) / (math.pi / 4 * 0.3**2)
    forces = single_acting(0.4, 0.4 / 0.3, 0.3, pressure, 120, 100)
    found = forces.extremes_of("P")
    assert found is not None
    assert found.largest.value == pytest.approx(summit, abs=1e-11)
    assert forces.phi_reversal is not None
    assert len(forces.phi_reversal) == 4
    assert np.abs(forces.at(forces.phi_reversal).P).max() <= 1e-12 * -found.smallest.value


def test_no_angle_is_missing_in_random_cylinders() -> None:
    for forces in cylinders(10, 5):
        assert missing_reversals(forces) == 0
        assert missing_crossings(forces) == 0
