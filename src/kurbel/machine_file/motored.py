"""The dead centre found from a motored trace: without combustion the pressure peaks just before it."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from os.path import basename
from typing import TYPE_CHECKING, ClassVar, NamedTuple

import numpy as np

from kurbel.declared.forms import FilePath, Physical
from kurbel.declared.keys import Described, Key, Keys
from kurbel.errors import Fault, RuleError, refuse
from kurbel.machine_file.samples import Layout, samples_of

if TYPE_CHECKING:
    from kurbel.arrays import Array

_HALF = 6.0
"""Degrees on either side of the peak through which the parabola goes."""
_SIDES = 20.0, 40.0, 60.0, 80.0
"""Degrees from the peak at which both its sides are compared: where something burnt, they are not alike."""
_FEWEST = 36
_ALIKE = 0.5, 1.15


@dataclass(frozen=True)
class Motored(Described):
    """A motored trace, and by how many degrees heat loss and leakage put its peak before the dead centre."""

    motored: str
    loss_angle: float

    KEYS: ClassVar[Keys] = {
        "motored": Key(
            FilePath(), "File of a motored trace, laid out as that of the trace", required=True, example="motored.csv"
        ),
        "loss_angle": Key(
            Physical("angle", least=0),
            "Angle by which heat loss and leakage put its peak before the dead centre",
            required=True,
            example="0.7 deg",
        ),
    }


class _Vertex(NamedTuple):
    """The peak of a parabola: place in degrees, its standard error, and the samples that it goes through."""

    degrees: float
    error: float
    samples: int


def dead_centre(given: Motored, layout: Layout, base: Callable[[Array], Array], against: bool) -> tuple[float, str]:
    """Return the angle of the dead centre in degrees as the file counts, and how it was found; raises RuleError."""
    try:
        samples = samples_of(given.motored, layout, "pressure", base, against)
        angles, pressures = _one_cycle(samples.angles, samples.values)
        _refuse_fired(angles, pressures)
        whole, half = (_vertex(angles, pressures, width) for width in (_HALF, _HALF / 2))
    except RuleError as error:
        raise RuleError(*(fault._replace(path=("angle_zero", "motored")) for fault in error.faults)) from None
    # of a peak that is no parabola the half of the samples tells another place
    doubt = math.hypot(whole.error, whole.degrees - half.degrees)
    zero = whole.degrees + given.loss_angle
    written, peak = (-zero, -whole.degrees) if against else (zero, whole.degrees)
    note = (
        f"angle_zero is {written:.4g} deg, uncertain by {doubt:.2g} deg: the peak of a parabola through "
        f"{whole.samples} samples of {basename(given.motored)} stands at {peak:.4g} deg, the dead centre "
        f"{given.loss_angle:g} deg later"
    )
    return written, note


def _one_cycle(angles: Array, laps: Array) -> tuple[Array, Array]:
    """Return two turns (n,), or one cycle of 720 deg, about the peak: the mean of what was measured."""
    turns = laps if len(laps) % 2 else np.concatenate((laps[0::2, :-1], laps[1::2, :-1]), axis=1)
    one = turns.mean(axis=0)
    period = angles[-1] - angles[0]
    count = len(one) if len(laps) % 2 == 0 else len(one) - 1
    around = np.concatenate([angles[:-1] + period * turn for turn in range(count // (len(angles) - 1))])
    top = int(np.argmax(one[:count]))
    order = np.arange(top - count // 2, top + count // 2)
    total = period * (count // (len(angles) - 1))
    return around[order % count] + total * (order // count), one[order % count]


def _refuse_fired(angles: Array, pressures: Array) -> None:
    if len(angles) < _FEWEST:
        refuse(Fault((), f"has {len(angles)} samples only; measure it finer"))
    top, low = float(angles[len(angles) // 2]), float(pressures.min())
    for side in _SIDES:
        before, after = (float(np.interp(top + way, angles, pressures)) - low for way in (-side, side))
        if not _ALIKE[0] * before <= after <= _ALIKE[1] * before:
            times = f"{after / before:.2g} times that" if before > 0 else "not that"
            message = f"is no motored trace: {side:g} deg after its peak the pressure rises to {times} before it"
            refuse(Fault((), f"{message}; name one without combustion"))


def _vertex(angles: Array, pressures: Array, width: float) -> _Vertex:
    """Return the peak of the parabola of least squares through the samples around the top one."""
    top = angles[len(angles) // 2]
    for _ in range(3):  # the top sample may be noise: go on from the peak of the parabola
        near = np.abs(angles - top) <= width
        if np.count_nonzero(near) < 5:
            refuse(Fault((), f"has fewer than five samples within {width:g} deg of its peak; measure it finer"))
        along = angles[near] - top
        basis = np.stack((np.ones_like(along), along, along**2), axis=1)
        found, _, _, _ = np.linalg.lstsq(basis, pressures[near], rcond=None)
        if not found[2] < 0 or abs(found[1] / (2 * found[2])) > width:
            refuse(Fault((), "has no peak that a parabola could be laid through"))
        top = top - found[1] / (2 * found[2])
    spread = pressures[near] - basis @ found
    variance = float(spread @ spread) / (len(along) - 3)
    covariance = variance * np.linalg.inv(basis.T @ basis)
    slope = np.array([0.0, -1 / (2 * found[2]), found[1] / (2 * found[2] ** 2)])
    return _Vertex(float(top), math.sqrt(max(0.0, slope @ covariance @ slope)), len(along))
