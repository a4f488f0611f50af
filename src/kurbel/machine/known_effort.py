"""A turning effort known from elsewhere, as the machine file gives it: by points, a file, harmonics, or its swing."""

from collections.abc import Iterator
from typing import Any

import numpy as np

from kurbel.arrays import Array
from kurbel.declared.record import Rule, ValuesByKey, alternative
from kurbel.declared.units import DiagramPoint, UnitFactor
from kurbel.errors import refused
from kurbel.machine.cylinder import MOST_TURNS
from kurbel.machine.measured import Columns
from kurbel.machine.shaft_side import (
    HARMONICS,
    MEAN,
    POINTS,
    UNIT,
    Effort,
    InUnit,
    KnownDiagram,
    Swing,
    harmonics_need_a_unit,
    harmonics_of,
    in_unit,
    points_of,
)
from kurbel.traces.cycles import Laps, samples_of_file


class KnownEffort(Columns):
    """What becomes an `Effort`, `Harmonics` or a `Swing`."""

    what = "torque"
    unit = UNIT
    points = POINTS._replace(text=f"{POINTS.text}; or give `file` or `harmonics`", instead="file")
    file = Columns.file._replace(
        text="File with a column of angles in degrees and one of torques",
        needs="unit",
        example="effort.csv",
    )
    torque_column = alternative(
        int, "Column of the torques, counted from 1", absent="2", needs="file"
    )
    angle_zero = alternative(
        "angle",
        "Angle of the firing or inner dead centre in the file",
        absent="0 deg",
        needs="file",
    )
    mean = MEAN
    harmonics = HARMONICS
    swing = alternative(
        "energy", "Swing of energy, where nothing else of the effort is known", "ΔE", least=0
    )
    coefficient = alternative(
        "ratio",
        "Coefficient of fluctuation of energy: the swing over the work of a cycle, which the mean torque gives",
        "ΔE/A",
        least=0,
        instead="swing",
        needs="mean",
        example="0.2",
    )

    @classmethod
    def rules_of_keys(cls, values: ValuesByKey) -> Iterator[Rule]:
        # one of the forms; swing and coefficient together are refused as the same quantity twice
        forms = [form for form in _FORMS if form in values]
        is_one_form = len(forms) == 1 or forms == ["swing", "coefficient"]
        message = (
            "give one of 'points', 'file' or 'harmonics', "
            "or 'swing', or 'coefficient' beside 'mean'"
        )
        yield Rule((), not is_one_form, message)
        # the mean torque
        if "mean" in values:
            yield from _rules_of_mean(values, forms)
        yield harmonics_need_a_unit(values)
        yield from super().rules_of_keys(values)

    @classmethod
    def of_keys(
        cls,
        unit: UnitFactor = (1.0, 1.0),
        points: list[DiagramPoint] | None = None,
        file: str | None = None,
        harmonics: list[DiagramPoint] | None = None,
        mean: float | None = None,
        swing: float | None = None,
        coefficient: float | None = None,
        angle_zero: float = 0.0,
        **layout: Any,
    ) -> KnownDiagram:
        """Return the effort that these keys describe, its file read; raises RuleError."""
        if harmonics is not None:
            return harmonics_of(unit, mean or 0.0, harmonics)
        if swing is not None or coefficient is not None:
            return Swing(swing, coefficient, None if mean is None else in_unit(mean, unit))
        if file is None:
            return points_of(unit, points or [])
        # the samples of a file
        multiplier, divisor = unit
        samples = samples_of_file(
            file,
            cls.layout(layout),
            "torque",
            lambda torques: torques * multiplier / divisor,
            most_turns=MOST_TURNS,
        )
        if len(samples.values) > 1:
            lap = samples.angles[-1] - samples.angles[0]
            refused(f"holds {len(samples.values)} laps of {lap:g} deg; keep one cycle", "file")
        angles, torques = _from_zero(samples, angle_zero)
        notes = samples.notes
        if samples.completed:
            notes = (*notes, "the closing sample is missing; the first one closes the cycle")
        return Effort(tuple(angles.tolist()), tuple(torques.tolist()), (file,), notes)


_FORMS = ("points", "file", "harmonics", "swing", "coefficient")
"""Keys of which an effort has one."""


def _rules_of_mean(values: ValuesByKey, forms: list[str]) -> Iterator[Rule]:
    """Yield the rules on a mean torque: what has one, and its unit."""
    if forms in (["points"], ["file"]):
        message = f"belongs to harmonics, a swing or a coefficient; '{forms[0]}' has its own"
        yield Rule("mean", True, message)
    mean = values["mean"]
    if isinstance(mean, InUnit) and "unit" not in values:
        message = f"{mean:g} has no unit; write it with one, such as '500 N m'"
        yield Rule("mean", True, message)


def _from_zero(samples: Laps, angle_zero: float) -> tuple[Array, Array]:
    """Return the angles (n,) in degrees from 0 to the end of the cycle, and the torques (n,), straight in between."""
    # two periods, of which the first begins in (−period, 0]
    period = float(round(samples.angles[-1] - samples.angles[0]))
    shifted = samples.angles - angle_zero
    shifted = shifted - period * np.ceil(shifted[0] / period)
    angles = np.concatenate([shifted, shifted + period])
    torques = np.tile(samples.values[0], 2)
    # the samples inside of one cycle, and the torques at its ends
    first = np.searchsorted(angles, 0.0, side="right")
    last = np.searchsorted(angles, period, side="left")
    between = np.interp(0.0, angles, torques)
    at_zero = torques[first - 1] if angles[first - 1] == 0 else between
    at_end = torques[last] if angles[last] == period else between
    return (
        np.concatenate([[0.0], angles[first:last], [period]]),
        np.concatenate([[at_zero], torques[first:last], [at_end]]),
    )
