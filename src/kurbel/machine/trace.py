"""Measured pressure over the crank angle, in the machine file itself or in a file of columns beside it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from kurbel.errors import Fault, RuleError
from kurbel.keys import Choice, Count, FilePath, Key, Keys, Physical, Points, UnitName
from kurbel.machine.angle_points import Point, angle_faults, beyond_cycle
from kurbel.units import Factor

DELIMITERS = {"comma": ",", "semicolon": ";", "tab": "\t", "space": " "}
"""Word in the machine file -> what stands between two columns."""
_DECIMALS = {"point": ".", "comma": ","}


@dataclass(frozen=True, eq=False)
class Trace:
    """A measured trace: either `points` of (degrees, pressure) or the `file` to read them from.

    unit: factor pair that turns the pressures into Pa; angle_zero: the angle, as the trace counts, of the firing or
    inner dead centre, in degrees. Columns count from 1; skip_rows: lines above the first figures. The file is read
    when the pressures are wanted.
    """

    unit: Factor
    points: tuple[Point, ...] = ()
    file: str | None = None
    angle_column: int = 1
    pressure_column: int = 2
    skip_rows: int = 0
    delimiter: str = ","
    decimal: str = "."
    angle_zero: float = 0.0

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
        """Return the trace that these keys of a machine file describe; raises RuleError."""
        if file is None and points is None:
            raise RuleError(Fault((), "'file' or 'points' is missing; write for instance 'file: indicator.csv'"))
        if file is not None and points is not None:
            raise RuleError(Fault(("points",), "'file' and 'points' say the same thing; leave one of them out"))
        described = [*columns, *(("delimiter",) if delimiter else ()), *(("decimal",) if decimal else ())]
        if points is not None and described:
            raise RuleError(
                *(Fault((key,), f"'{key}' describes a file; leave it out beside 'points'") for key in described)
            )
        between = DELIMITERS.get(delimiter or "comma", delimiter or "")
        point = _DECIMALS[decimal or "point"]
        return cls(unit, tuple(points or ()), file, delimiter=between, decimal=point, angle_zero=angle_zero, **columns)

    def __post_init__(self) -> None:
        faults = angle_faults(list(self.points), ("points",)) if self.points else []
        if self.angle_column == self.pressure_column:
            faults.append(Fault(("pressure_column",), f"column {self.pressure_column} is that of the angles"))
        if self.delimiter == self.decimal:
            faults.append(
                Fault(
                    ("decimal",),
                    "a comma cannot stand both in numbers and between columns; write 'delimiter: semicolon'",
                )
            )
        if faults:
            raise RuleError(*faults)

    def cycle_fault(self, cycle: str) -> str:
        """Return what does not fit the cycle of the machine, or an empty text; a file is judged when it is read."""
        return beyond_cycle(self.points[-1][0], cycle) if self.points else ""
