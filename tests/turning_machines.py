"""Machines with a given turning effort, for tests of flywheel and speed line."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from kurbel.machine import Machine
from kurbel.machine.shaft_side import Effort, Flywheel
from kurbel.solver.case import Case
from kurbel.solver.flywheel import MachineTurning

Point = tuple[float, float]


def of_points(
    points: Sequence[Point],
    rpm: float | None = None,
    inertia: float | None = None,
    delta: float | None = None,
    **more: Any,
) -> MachineTurning:
    """Solve a machine with this turning-moment diagram, (degrees, N m)."""
    wheel = None if inertia is None and delta is None else Flywheel(inertia, delta)
    diagram = Effort(tuple(a for a, _ in points), tuple(m for _, m in points))
    cycle = "four-stroke" if points[-1][0] > 360 else "two-stroke"
    speed = None if rpm is None else rpm / 60
    return Case(
        Machine((), effort=diagram, speed=speed, flywheel=wheel, cycle=cycle, **more)
    ).flywheel


def rectangles(areas: Sequence[float], mean: float = 0.0) -> list[Point]:
    """Return a diagram of equally wide rectangular lobes of these areas in J about a mean torque in N m."""
    width = 360 / len(areas)
    heights = [mean + area / math.radians(width) for area in areas]
    return [(angle, m) for i, m in enumerate(heights) for angle in (i * width, (i + 1) * width)]


def moving_inertia(turning: MachineTurning, degrees: np.ndarray) -> np.ndarray:
    """Return J(φ) in kg m² of the moving masses at crank angles (n,) in degrees."""
    effort = turning.effort
    return effort.pieces.at(effort.J_moving, np.zeros(len(degrees), dtype=int), degrees)
