"""A turning effort known from elsewhere, as the machine file gives it: by points, a file, harmonics, or its swing."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from kurbel.arrays import Array
from kurbel.declared.record import Rule, ValuesByKey, alternative
from kurbel.declared.units import DiagramPoint, UnitFactor
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
from kurbel.traces.correct import turns_left_out
from kurbel.traces.cycles import Laps, cut, joined, samples_of_file


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
            most_turns=_MOST_RECORDED,
        )
        notes = samples.notes
        if samples.completed:
            notes = (*notes, "the closing sample is missing; the first one closes the cycle")
        return RecordedEffort.of_laps(samples, angle_zero, file, notes)


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


# a recording, and the mean of its cycles

_MOST_RECORDED = 10_000
"""Turns of the shaft in one recording."""
_LEAST_ALIKE = 0.5
"""Correlation of each cycle and the next one below which they are no repetitions."""
_PAIRED = 0.25
"""Squared difference of cycles and the next but one, over that of neighbours, below which pairs are the cycles."""
_NOISE = 1e-3
"""Squared difference of neighbours, over the squared swing, that needs no second look."""


@dataclass(frozen=True, eq=False)
class RecordedEffort(Effort):
    """A diagram from a file: one cycle, or many one after the other, of which the machine knows the length.

    laps: as they were read, of which angles and torques are the mean; zero: the angle in the file of the dead centre.
    """

    laps: Laps | None = None
    zero: float = 0.0

    @classmethod
    def of_laps(
        cls, laps: Laps, zero: float, file: str, notes: tuple[str, ...]
    ) -> "RecordedEffort":
        """Return the effort of these laps, the mean of which is one cycle."""
        angles, torques = _from_zero(laps.angles, laps.values.mean(axis=0), zero)
        return cls(tuple(angles.tolist()), tuple(torques.tolist()), (file,), notes, laps, zero)

    def rules_of_cycle(self, cycle: str, turns: int) -> Iterator[Rule]:
        """Yield what does not fit the cycle of the machine, of so many turns of the shaft."""
        cycles = self._cycles(turns)
        if cycles is None:
            yield from self._rules_of_another_length(cycle, turns)
            return
        if len(cycles.values) == 1:
            return
        swing = cycles.values - cycles.values.mean()
        square = (swing**2).mean()
        is_unlike = (swing[1:] * swing[:-1]).mean() < _LEAST_ALIKE * square
        counts_on = self.laps is not None and len(self.laps.values) == 1
        if is_unlike and counts_on:
            yield from super().rules_of_cycle(cycle, turns)
            return
        degrees = f"{360 * turns:g} deg"
        advice = "'cycle: four-stroke', or " if turns == 1 else ""
        message = (
            f"the {len(cycles.values)} cycles of {degrees} in it are not alike; write {advice}"
            "'cycle_turns', the turns of the shaft after which everything repeats, or keep one cycle"
        )
        yield Rule("file", is_unlike, message)
        if len(cycles.values) > 2 and not is_unlike:
            neighbours = ((swing[1:] - swing[:-1]) ** 2).mean()
            next_but_one = ((swing[2:] - swing[:-2]) ** 2).mean()
            is_paired = neighbours > _NOISE * square and next_but_one < _PAIRED * neighbours
            advice = "cycle: four-stroke" if turns == 1 else f"cycle_turns: {2 * turns}"
            message = f"the cycles of {degrees} differ in pairs; write '{advice}' at the top"
            yield Rule("file", is_paired, message)

    def _rules_of_another_length(self, cycle: str, turns: int) -> Iterator[Rule]:
        """Yield that its laps make no cycle of so many turns."""
        count = 1 if self.laps is None else len(self.laps.values)
        if count == 1:
            yield from super().rules_of_cycle(cycle, turns)
            return
        message = (
            f"has {count} laps of {self.angles[-1]:g} deg, the cycle {360 * turns:g} deg; write "
            "'cycle_turns', the turns of the shaft after which everything repeats"
        )
        yield Rule("file", True, message)

    def of_cycle(self, turns: int) -> Effort:
        """Return the mean of its cycles of so many turns; itself where it is one diagram."""
        cycles = self._cycles(turns)
        if cycles is None or self.laps is None:
            return self
        count = len(cycles.values)
        if count == 1 and cycles is self.laps:
            return self
        notes = self.notes
        if cycles.values.shape[1] > self.laps.values.shape[1]:  # of several turns each
            notes = notes + turns_left_out(len(self.laps.values), turns)
        if count > 1:
            notes = (*notes, f"the mean of {count} cycles of {360 * turns:g} deg counts")
        return self.of_laps(cycles, self.zero, self.files[0], notes)

    def _cycles(self, turns: int) -> Laps | None:
        """Return the cycles of so many turns in its laps; None where these are a diagram of another length."""
        laps = self.laps
        if laps is None:
            return None
        angles = laps.angles
        lap = round((angles[-1] - angles[0]) / 360)
        count = len(laps.values)
        if lap == turns:
            return laps
        # one diagram repeats within the cycle, several laps are parts of it
        if turns % lap == 0 and count == 1:
            return None
        if turns % lap == 0:
            parts = turns // lap
            return joined(laps, parts) if count >= parts else None
        # cycles that count on; two turns are taken for a four-stroke cycle
        is_cut = lap % turns == 0 and lap > 2
        return cut(laps, lap // turns) if is_cut else None


def _from_zero(recorded: Array, values: Array, angle_zero: float) -> tuple[Array, Array]:
    """Return the angles (n,) in degrees from 0 to the end of the cycle, and the torques (n,), straight in between."""
    # two periods, of which the first begins in (−period, 0]
    period = float(round(recorded[-1] - recorded[0]))
    shifted = recorded - angle_zero
    shifted = shifted - period * np.ceil(shifted[0] / period)
    angles = np.concatenate([shifted, shifted + period])
    torques = np.tile(values, 2)
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
