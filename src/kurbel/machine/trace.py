"""Measured pressure over the crank angle, in the machine file itself or in a file of columns beside it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

from kurbel.declared.bounds import Point
from kurbel.declared.keys import Choice, Count, FilePath, Key, Keys, Physical, Points, UnitName
from kurbel.declared.units import Factor
from kurbel.errors import Fault, RuleError
from kurbel.machine import CYCLES

if TYPE_CHECKING:
    from kurbel.machine.trace_samples import Samples

DELIMITERS = {"comma": ",", "semicolon": ";", "tab": "\t", "space": " "}
"""Word in the machine file -> what stands between two columns."""
_DECIMALS = {"point": ".", "comma": ","}


@dataclass(frozen=True, eq=False)
class Trace:
    """A measured trace over one whole cycle.

    samples: angles as the trace counts them and pressures in Pa; angle_zero: the angle, as the trace counts, of the
    firing or inner dead centre, in degrees. Both ends of a cylinder count from the same dead centre, as one encoder on
    the shaft does; a mirrored trace follows one stroke later. file: where the samples came from, if not from
    the machine file.
    """

    samples: Samples
    angle_zero: float = 0.0
    file: str | None = None

    KEYS: ClassVar[Keys] = {
        "file": Key(FilePath(), "File with a column of angles in degrees and one of pressures; or give `points`"),
        "points": Key(Points("deg", "pressure"), "Pressure over the crank angle; or give `file`", instead="file"),
        "unit": Key(UnitName("pressure"), "Unit of the pressures", required=True),
        "angle_column": Key(Count(), "Column of the angles, counted from 1", absent="1"),
        "pressure_column": Key(Count(), "Column of the pressures, counted from 1", absent="2"),
        "skip_rows": Key(Count(least=0), "Number of lines above the first figures", absent="0"),
        "delimiter": Key(
            Choice((*DELIMITERS, *DELIMITERS.values())), "What stands between two columns", absent="comma"
        ),
        "decimal": Key(Choice(tuple(_DECIMALS)), "Decimal point or decimal comma", absent="point"),
        "angle_zero": Key(
            Physical("angle"), "Angle of the firing or inner dead centre as the trace counts", absent="0 deg"
        ),
    }

    @classmethod
    def from_keys(
        cls,
        unit: Factor,
        file: str | None = None,
        points: list[Point] | None = None,
        angle_zero: float = 0.0,
        delimiter: str | None = None,
        decimal: str | None = None,
        **columns: int,
    ) -> Trace:
        """Return the trace that these keys of a machine file describe, its file read; raises RuleError."""
        if file is not None and points is not None:
            raise RuleError(Fault(("points",), "'file' and 'points' say the same thing; leave one of them out"))
        described = [*columns, *(("delimiter",) if delimiter else ()), *(("decimal",) if decimal else ())]
        if file is not None:
            return cls(_from_file(file, unit, delimiter or "comma", decimal or "point", columns), angle_zero, file)
        if points is None:
            raise RuleError(Fault((), "'file' or 'points' is missing; write for instance 'file: indicator.csv'"))
        if described:
            raise RuleError(
                *(Fault((key,), f"'{key}' describes a file; leave it out beside 'points'") for key in described)
            )
        return cls(_from_points(points, unit), angle_zero)

    @property
    def notes(self) -> tuple[str, ...]:
        """What was tidied up in the samples."""
        return self.samples.notes

    @property
    def cycles(self) -> tuple[str, ...]:
        """The one cycle that is as long."""
        return tuple(cycle for cycle, turns in CYCLES.items() if 360.0 * turns == self.samples.period)

    def fault_in(self, cycle: str, lift: float) -> str:
        """Return what does not fit the cycle of the machine, or an empty text."""
        whole = 360.0 * CYCLES[cycle]
        if self.samples.period == whole:
            return ""
        other = next(name for name in CYCLES if name != cycle)
        covers = f"the trace covers {self.samples.period:g} deg, a {cycle} cycle has {whole:g} deg"
        return f"{covers}; write 'cycle: {other}' at the top"


def _from_file(file: str, unit: Factor, delimiter: str, decimal: str, columns: dict[str, int]) -> Samples:
    angle, pressure = columns.get("angle_column", 1), columns.get("pressure_column", 2)
    between, point = DELIMITERS.get(delimiter, delimiter), _DECIMALS[decimal]
    faults = _column_faults(angle, pressure, between, point)
    if faults:
        raise RuleError(*faults)
    from kurbel.machine.trace_samples import Columns, read_columns, whole_cycle

    layout = Columns(angle, pressure, columns.get("skip_rows", 0), between, point)
    angles, values, line = read_columns(file, layout)
    return whole_cycle(angles, values * unit[0] / unit[1], lambda index: Fault(("file",), line(index)))


def _column_faults(angle: int, pressure: int, between: str, point: str) -> list[Fault]:
    faults = []
    if angle == pressure:
        faults.append(Fault(("pressure_column",), f"column {pressure} is that of the angles"))
    if between == point:
        message = "a comma cannot stand both in numbers and between columns; write 'delimiter: semicolon'"
        faults.append(Fault(("decimal",), message))
    return faults


def _from_points(points: list[Point], unit: Factor) -> Samples:
    import numpy as np

    from kurbel.machine.trace_samples import whole_cycle

    angles, values = np.array(points, dtype=float).T
    return whole_cycle(angles, values * unit[0] / unit[1], lambda index: Fault(("points", index), ""))
