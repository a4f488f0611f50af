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
from kurbel.machine.turning import (
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
    def rules_of_keys(cls, given: ValuesByKey) -> Iterator[Rule]:
        forms = [
            name
            for name in ("points", "file", "harmonics", "swing", "coefficient")
            if name in given
        ]
        message = "give one of 'points', 'file' or 'harmonics', or 'swing', or 'coefficient' beside 'mean'"
        yield Rule((), len(forms) != 1 and forms != ["swing", "coefficient"], message)
        level = "mean" in given and forms in (["points"], ["file"])
        yield Rule(
            "mean",
            level,
            f"belongs to harmonics, a swing or a coefficient; '{forms[0] if forms else ''}' has its own",
        )
        bare = "unit" not in given and isinstance(given.get("mean"), InUnit)
        yield Rule(
            "mean",
            bare,
            f"{given.get('mean', 0.0):g} has no unit; write it with one, such as '500 N m'",
        )
        yield harmonics_need_a_unit(given)
        yield from super().rules_of_keys(given)

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
        up, down = unit
        layout_of_file = cls.layout(layout)
        samples = samples_of_file(
            file,
            layout_of_file,
            "torque",
            lambda torques: torques * up / down,
            most_turns=MOST_TURNS,
        )
        if len(samples.values) > 1:
            lap = samples.angles[-1] - samples.angles[0]
            refused(f"holds {len(samples.values)} laps of {lap:g} deg; keep one cycle", "file")
        angles, torques = _from_zero(samples, angle_zero)
        closed = (
            ("the closing sample is missing; the first one closes the cycle",)
            if samples.completed
            else ()
        )
        return Effort(
            tuple(angles.tolist()), tuple(torques.tolist()), (file,), (*samples.notes, *closed)
        )


def _from_zero(samples: Laps, angle_zero: float) -> tuple[Array, Array]:
    """Return the angles (n,) in degrees from 0 to the end of the cycle, and the torques (n,), straight in between."""
    period = float(round(samples.angles[-1] - samples.angles[0]))
    begun = samples.angles - angle_zero
    begun = begun - period * np.ceil(begun[0] / period)  # begins in (−period, 0]
    angles, torques = np.concatenate([begun, begun + period]), np.tile(samples.values[0], 2)
    first, last = (
        np.searchsorted(angles, 0.0, side="right"),
        np.searchsorted(angles, period, side="left"),
    )
    between = np.interp(0.0, angles, torques)
    at_zero = torques[first - 1] if angles[first - 1] == 0 else between
    at_end = torques[last] if angles[last] == period else between
    inside = slice(first, last)
    return np.concatenate([[0.0], angles[inside], [period]]), np.concatenate(
        [[at_zero], torques[inside], [at_end]]
    )
