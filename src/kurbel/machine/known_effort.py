"""The keys of a turning effort known from elsewhere: points, a file of columns, or harmonics."""

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from kurbel.arrays import Array
from kurbel.declared.forms.values import FILE_PATH, Points, size_faults, unit_name
from kurbel.declared.keys import Key
from kurbel.declared.reading import has_refused
from kurbel.declared.record import Record, Rule, alternative
from kurbel.declared.units import Factor, Point
from kurbel.errors import refuse, refused
from kurbel.machine.measured import (
    ANGLE_COLUMN,
    ANGLE_STEP,
    ANGLE_UNIT,
    DECIMAL,
    DELIMITER,
    RECORDED_SPEED,
    SKIP_ROWS,
    layout_of,
    layout_rules,
)
from kurbel.machine.turning import Effort, Harmonics
from kurbel.traces.cycles import Samples, samples_of_file

_HIGHEST = 1000
"""Periods per turn of a harmonic; each is followed, so that more of them take long."""


def _of_file(key: Key) -> Key:
    return key._replace(needs="file")


class Known(Record):
    """What becomes an `Effort`, or `Harmonics`."""

    unit = alternative(unit_name("torque"), "Unit of the torques", required=True)
    points = alternative(
        Points("deg", "torque"),
        "Torque over the crank angle; two points at one angle are a jump; or give `file` or `harmonics`",
        "M",
        instead="file",
    )
    file = alternative(FILE_PATH, "File with a column of angles in degrees and one of torques", example="effort.csv")
    angle_column, angle_unit = _of_file(ANGLE_COLUMN), _of_file(ANGLE_UNIT)
    recorded_speed, angle_step = _of_file(RECORDED_SPEED), _of_file(ANGLE_STEP)
    torque_column = alternative(int, "Column of the torques, counted from 1", absent="2", needs="file")
    skip_rows, delimiter, decimal = _of_file(SKIP_ROWS), _of_file(DELIMITER), _of_file(DECIMAL)
    angle_zero = alternative(
        "angle", "Angle of the firing or inner dead centre as the file counts", absent="0 deg", needs="file"
    )
    mean = alternative("ratio", "Mean torque beside the harmonics, in the unit", "M_m", needs="harmonics")
    harmonics = alternative(
        Points("order", "cos", "sin", least=1),
        "Harmonics of the torque: periods per turn, and the factors of cos νφ and sin νφ",
        needs="mean",
    )

    @classmethod
    def rules_of_keys(cls, given: Mapping[str, Any]) -> Iterator[Rule]:
        if has_refused(given.values()):
            return
        one = sum(name in given for name in ("points", "file", "harmonics")) == 1
        yield Rule((), not one, "give one of 'points', 'file' or 'harmonics'")
        if "file" in given:
            yield from layout_rules("torque", given)

    @classmethod
    def of_keys(
        cls,
        unit: Factor,
        points: list[Point] | None = None,
        file: str | None = None,
        harmonics: list[tuple[float, float, float]] | None = None,
        mean: float = 0.0,
        **layout: Any,
    ) -> Effort | Harmonics:
        """Return the effort that these keys describe, its file read; raises RuleError."""
        if harmonics is not None:
            return _by_harmonics(unit, mean, harmonics)
        return Effort.of_points(unit, points or []) if file is None else _from_file(unit, file, **layout)


def _by_harmonics(unit: Factor, mean: float, harmonics: list[tuple[float, float, float]]) -> Harmonics:
    up, down = unit
    for index, (order, _, _) in enumerate(harmonics):
        if not 0 < order <= _HIGHEST:
            message = f"order {order:g} is no number of periods per turn; it must be more than 0, at most {_HIGHEST}"
            refused(message, "harmonics", index, 0)
    sizes = [(0.0, mean), *((order, abs(c) + abs(s)) for order, c, s in harmonics)]
    refuse(*(fault._replace(path=("harmonics",)) for fault in size_faults(sizes, unit, "torque", ())))
    return Harmonics(mean * up / down, tuple((n, c * up / down, s * up / down) for n, c, s in harmonics))


def _from_file(unit: Factor, file: str, angle_zero: float = 0.0, **layout: Any) -> Effort:
    up, down = unit
    samples = samples_of_file(file, layout_of("torque", layout), "torque", lambda torques: torques * up / down)
    if len(samples.values) > 1:
        lap = samples.angles[-1] - samples.angles[0]
        refused(f"holds {len(samples.values)} laps of {lap:g} deg; keep one cycle", "file")
    angles, torques = _from_zero(samples, angle_zero)
    closed = ("the closing sample is missing; the first one closes the cycle",) if samples.completed else ()
    return Effort(tuple(angles.tolist()), tuple(torques.tolist()), (file,), (*samples.notes, *closed))


def _from_zero(samples: Samples, angle_zero: float) -> tuple[Array, Array]:
    """Return the angles (n,) in degrees from 0 to the end of the cycle, and the torques (n,), straight in between."""
    period = float(round(samples.angles[-1] - samples.angles[0]))
    begun = samples.angles - angle_zero
    begun = begun - period * np.ceil(begun[0] / period)  # begins in (−period, 0]
    angles, torques = np.concatenate([begun, begun + period]), np.tile(samples.values[0], 2)
    first, last = np.searchsorted(angles, 0.0, side="right"), np.searchsorted(angles, period, side="left")
    between = np.interp(0.0, angles, torques)
    at_zero = torques[first - 1] if angles[first - 1] == 0 else between
    at_end = torques[last] if angles[last] == period else between
    inside = slice(first, last)
    return np.concatenate([[0.0], angles[inside], [period]]), np.concatenate([[at_zero], torques[inside], [at_end]])
