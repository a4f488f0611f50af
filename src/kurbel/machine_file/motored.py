"""The dead centre found from a motored trace: without combustion the pressure peaks just before it."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from os.path import basename
from typing import ClassVar

import numpy as np

from kurbel.arrays import Array
from kurbel.declared.forms import FilePath, not_negative
from kurbel.declared.keys import Described, Key, Keys
from kurbel.errors import RuleError, refused
from kurbel.machine_file.samples import Layout, samples_of
from kurbel.numerics.vertex import Vertex, vertex

_HALF = 6.0
"""Degrees on either side of the peak through which the parabola goes."""
_SIDES = (20.0, 50.0), (50.0, 80.0)
"""Degrees from the peak between which both its sides are compared: where something burnt, they are not alike."""
_LOW = 0.15
"""Share of the cycle below the level from which pressures are compared."""
_FEWEST, _NEAR = 36, 5
_ALIKE = 0.5, 1.15


@dataclass(frozen=True, eq=False, repr=False)
class Motored(Described):
    """A motored trace, and by how many degrees heat loss and leakage put its peak before the dead centre."""

    motored: str
    loss_angle: float

    KEYS: ClassVar[Keys] = {
        "motored": Key(
            FilePath(), "File of a motored trace, laid out as that of the trace", required=True, example="motored.csv"
        ),
        "loss_angle": not_negative(
            "angle",
            "Angle by which heat loss and leakage put its peak before the dead centre",
            required=True,
            example="0.7 deg",
        ),
    }


def dead_centre(given: Motored, layout: Layout, base: Callable[[Array], Array], against: bool) -> tuple[float, str]:
    """Return the angle of the dead centre in degrees as the file counts, and how it was found; raises RuleError."""
    try:
        samples = samples_of(given.motored, layout, "pressure", base, against)
        angles, pressures = _one_cycle(samples.angles, samples.values)
        if len(angles) < _FEWEST:
            refused(f"has {len(angles)} samples only; measure it finer")
        whole = _vertex(angles, pressures, _HALF)
        _refuse_fired(angles, pressures, whole.place)
    except RuleError as error:
        raise RuleError(*(fault._replace(path=("angle_zero", "motored")) for fault in error.faults)) from None
    half = vertex(angles, pressures, whole.place, _HALF / 2)
    # of a peak that is no parabola the half of the samples tells another place; where their noise hides it, its
    # standard error, √8 times that of all, is the bound
    doubt = math.hypot(whole.error, math.sqrt(8) * whole.error if half is None else whole.place - half.place)
    zero = whole.place + given.loss_angle
    written, peak = (-zero, -whole.place) if against else (zero, whole.place)
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


def _refuse_fired(angles: Array, pressures: Array, top: float) -> None:
    low = float(np.quantile(pressures, _LOW))
    for near, far in _SIDES:
        away = np.linspace(near, far, 301)
        before, after = (float(np.interp(top + way * away, angles, pressures).mean()) - low for way in (-1, 1))
        if not _ALIKE[0] * before <= after <= _ALIKE[1] * before:
            times = f"{after / before:.2g} times that" if before > 0 else "not that"
            message = (
                f"is no motored trace: {near:g} to {far:g} deg after its peak the pressure rises to {times} before"
            )
            refused(f"{message}; name one without combustion")


def _vertex(angles: Array, pressures: Array, width: float) -> Vertex:
    """Return the peak of the parabola through the samples so near to the top one; raises RuleError."""
    top = float(angles[len(angles) // 2])
    if np.count_nonzero(np.abs(angles - top) <= width / 2) < _NEAR:
        refused(f"has fewer than five samples within {width / 2:g} deg of its peak; measure it finer")
    found = vertex(angles, pressures, top, width)
    if found is None:
        refused("is no motored trace: it has no peak that a parabola could be laid through")
    return found
