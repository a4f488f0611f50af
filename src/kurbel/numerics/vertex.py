"""The peak of samples, by a parabola through those around the top one: a single sample may be noise."""

import math
from typing import NamedTuple

import numpy as np

from kurbel.arrays import Array

_FEWEST = 5


class Vertex(NamedTuple):
    """The peak of a parabola: its place, the standard error of that, and how many samples it goes through."""

    place: float
    error: float
    samples: int


def vertex(places: Array, values: Array, top: float, width: float) -> Vertex | None:
    """Return the peak of the parabola of least squares through samples (n,) within `width` of the top one.

    None where they are fewer than five, or have no peak within that width.
    """
    for _ in range(3):  # the top sample may be noise: go on from the peak of the parabola
        near = np.abs(places - top) <= width
        if np.count_nonzero(near) < _FEWEST:
            return None
        along = places[near] - top
        basis = np.stack((np.ones_like(along), along, along**2), axis=1)
        found, _, rank, _ = np.linalg.lstsq(basis, values[near], rcond=None)
        if rank < 3 or not found[2] < 0 or abs(found[1] / (2 * found[2])) > width:
            return None
        top = top - found[1] / (2 * found[2])
    spread = values[near] - basis @ found
    covariance = float(spread @ spread) / (len(along) - 3) * np.linalg.inv(basis.T @ basis)
    slope = np.array([0.0, -1 / (2 * found[2]), found[1] / (2 * found[2] ** 2)])
    return Vertex(float(top), math.sqrt(max(0.0, slope @ covariance @ slope)), len(along))
