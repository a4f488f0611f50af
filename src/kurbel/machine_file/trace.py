"""The keys of a measured trace, whose samples stand in the machine file or in a file of columns beside it."""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from kurbel.declared.bounds import Point
from kurbel.declared.forms import Choice, Count, FilePath, Physical, Points, UnitName
from kurbel.declared.keys import Described, Key, Keys
from kurbel.declared.units import Factor
from kurbel.errors import Fault, refuse

if TYPE_CHECKING:
    from kurbel.machine.trace import Trace
    from kurbel.machine_file.whole_cycle import Samples

DELIMITERS = {"comma": ",", "semicolon": ";", "tab": "\t", "space": " "}
"""Word in the machine file -> what stands between two columns."""
_DECIMALS = {"point": ".", "comma": ","}


def layout_keys(what: str) -> Keys:
    """Return the keys that say how a file of columns, angles and what was measured, is laid out."""
    return {
        "angle_column": Key(Count(), "Column of the angles, counted from 1", absent="1"),
        f"{what}_column": Key(Count(), f"Column of the {what}s, counted from 1", absent="2"),
        "skip_rows": Key(Count(least=0), "Number of lines above the first figures", absent="0"),
        "delimiter": Key(
            Choice((*DELIMITERS, *DELIMITERS.values())), "What stands between two columns", absent="comma"
        ),
        "decimal": Key(Choice(tuple(_DECIMALS)), "Decimal point or decimal comma", absent="point"),
        "angle_zero": Key(
            Physical("angle"), "Angle of the firing or inner dead centre as the file counts", absent="0 deg"
        ),
    }


class Measured(Described):
    """What becomes a `Trace` once its samples are read and closed to a whole cycle."""

    KEYS: ClassVar[Keys] = {
        "file": Key(
            FilePath(),
            "File with a column of angles in degrees and one of pressures; or give `points`",
            required=True,
            example="indicator.csv",
        ),
        "points": Key(Points("deg", "pressure"), "Pressure over the crank angle; or give `file`", instead="file"),
        "unit": Key(UnitName("pressure"), "Unit of the pressures", required=True),
        **layout_keys("pressure"),
    }

    @classmethod
    def of_keys(
        cls,
        unit: Factor,
        file: str | None = None,
        points: list[Point] | None = None,
        angle_zero: float = 0.0,
        **layout: str | int,
    ) -> Trace:
        """Return the trace that these keys describe, its file read."""
        from kurbel.machine.trace import Trace

        if file is None:
            refuse(*(Fault((key,), f"'{key}' describes a file; leave it out beside 'points'") for key in layout))
            samples = _from_points(points or [], unit)
        else:
            samples = samples_of(file, unit, "pressure", **layout)  # type: ignore[arg-type]
        return Trace(samples.angles, samples.values, angle_zero, file, samples.notes)


def samples_of(
    file: str,
    unit: Factor,
    what: str,
    angle_column: int = 1,
    skip_rows: int = 0,
    delimiter: str = "comma",
    decimal: str = "point",
    **column: int,
) -> Samples:
    """Return one cycle of what was measured, in the base of its unit, from a file; raises RuleError."""
    between, point = DELIMITERS.get(delimiter, delimiter), _DECIMALS[decimal]
    value_column = column.get(f"{what}_column", 2)
    refuse(*_column_faults(angle_column, value_column, what, between, point))
    from kurbel.machine_file.columns import Columns, read_columns
    from kurbel.machine_file.whole_cycle import whole_cycle

    layout = Columns(angle_column, value_column, skip_rows, between, point)
    angles, values, line = read_columns(file, layout)
    return whole_cycle(angles, values * unit[0] / unit[1], lambda index: Fault(("file",), line(index)), what)


def _column_faults(angle: int, value: int, what: str, between: str, point: str) -> list[Fault]:
    faults = []
    if angle == value:
        faults.append(Fault((f"{what}_column",), f"column {value} is that of the angles"))
    if between == point:
        message = "a comma cannot stand both in numbers and between columns; write 'delimiter: semicolon'"
        faults.append(Fault(("decimal",), message))
    return faults


def _from_points(points: list[Point], unit: Factor) -> Samples:
    import numpy as np

    from kurbel.machine_file.whole_cycle import whole_cycle

    angles, values = np.array(points, dtype=float).T
    return whole_cycle(angles, values * unit[0] / unit[1], lambda index: Fault(("points", index), ""))
