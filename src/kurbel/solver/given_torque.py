"""Torques that are known from elsewhere: by points, by harmonics, or by their swing of energy alone."""

from __future__ import annotations

import math

import numpy as np

from kurbel.arrays import Array
from kurbel.crank_angle import unit_vector
from kurbel.machine.shaft_side import Harmonics, KnownDiagram, Swing
from kurbel.numerics.pieces import Pieces


def corners(diagram: KnownDiagram, cycle: float) -> Array:
    """Return the angles in degrees between which a torque is smooth; of waves so many that pieces resolve them."""
    if isinstance(diagram, Swing):
        return np.zeros(0)
    if isinstance(diagram, Harmonics):
        highest = max(1.0, *(order for order, _, _ in diagram.terms))
        return np.linspace(0.0, cycle, math.ceil(cycle / 90 * highest) + 1)
    return np.add.outer(np.arange(0.0, cycle, diagram.angles[-1]), diagram.angles).ravel()


def torque_on(diagram: KnownDiagram, pieces: Pieces) -> Array:
    """Return a torque in N m on pieces: M = mean + Σ c cos νφ + s sin νφ, or points with straight lines between them.

    Points repeat from their last angle on; at a jump the side counts that holds the middle of a piece. Of a swing the
    mean alone is known, 0 where it is not.
    """
    if isinstance(diagram, Swing):
        mean = np.zeros(pieces.count) if diagram.mean is None else diagram.mean
        return pieces.filled(pieces.of(mean))
    if isinstance(diagram, Harmonics):
        orders, cos, sin = np.array(diagram.terms).T
        waves = unit_vector(np.multiply.outer(pieces.degrees, orders)) @ (cos - 1j * sin)
        return diagram.mean + waves.real
    angles, torques = np.array(diagram.angles), np.array(diagram.torques)
    turn = angles[-1] * np.floor(pieces.middle / angles[-1])
    line = np.searchsorted(angles, pieces.middle - turn, side="right") - 1
    rise = (torques[line + 1] - torques[line]) / (angles[line + 1] - angles[line])
    return torques[line] + rise * (pieces.degrees - turn - angles[line])
