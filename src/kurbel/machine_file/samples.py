"""The keys that say how a file of samples is laid out, and the samples that are read by them."""

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, NamedTuple

from kurbel.declared.forms import Choice, Count, Physical, positive
from kurbel.declared.keys import Key, Keys
from kurbel.errors import Fault, RuleError, refuse

if TYPE_CHECKING:
    from kurbel.arrays import Array
    from kurbel.machine_file.whole_cycle import Samples

DELIMITERS = {"comma": ",", "semicolon": ";", "tab": "\t", "space": " "}
"""Word in the machine file -> what stands between two columns."""
_DECIMALS = {"point": ".", "comma": ","}
_BY_TIME = "; are 'recorded_speed' and 'angle_unit' (s or ms) right?"
_SECONDS = {"s": 1.0, "ms": 1e-3}


def layout_keys(what: str) -> Keys:
    """Return the keys that say how a file of columns, angles and what was measured, is laid out."""
    return {
        "angle_column": Key(Count(), "Column of the angles, counted from 1", absent="1"),
        "angle_unit": Key(
            Choice(("deg", "rad", "s", "ms")), "What the angle column counts: an angle, or time", absent="deg"
        ),
        "recorded_speed": positive("speed", "Constant speed at which times were recorded", needs="angle_unit"),
        "angle_step": positive(
            "angle", "Crank angle from one row to the next, instead of a column of angles", instead="angle_column"
        ),
        f"{what}_column": Key(Count(), f"Column of the {what}s, counted from 1", absent="2"),
        "skip_rows": Key(Count(least=0), "Number of lines above the first figures", absent="0"),
        "delimiter": Key(
            Choice((*DELIMITERS, *DELIMITERS.values())),
            "What stands between two columns",
            absent="comma",
            also=("separator", "sep"),
        ),
        "decimal": Key(Choice(tuple(_DECIMALS)), "Decimal point or decimal comma", absent="point"),
        "angle_zero": Key(
            Physical("angle"), "Angle of the firing or inner dead centre as the file counts", absent="0 deg"
        ),
    }


class Layout(NamedTuple):
    """How a file of samples is laid out, by its keys; `columns`: those of what was measured."""

    columns: tuple[int, ...] = (2,)
    angle_column: int = 1
    angle_unit: str = "deg"
    recorded_speed: float | None = None
    angle_step: float | None = None
    skip_rows: int = 0
    delimiter: str = "comma"
    decimal: str = "point"

    @classmethod
    def of_keys(cls, what: str, **keys: Any) -> "Layout":
        """Return the layout that the keys describe; raises RuleError for those that contradict one another."""
        several = keys.pop(f"{what}_columns", None)
        key, columns = (f"{what}_columns", several) if several else (f"{what}_column", (keys.pop(f"{what}_column", 2),))
        layout = cls(columns, **keys)
        faults = []
        if layout.angle_step is None and layout.angle_column in columns:
            faults.append(Fault((key,), f"column {layout.angle_column} is that of the angles"))
        if layout.angle_unit in _SECONDS and layout.recorded_speed is None:
            faults.append(
                Fault(("angle_unit",), "times become angles by a speed; write 'recorded_speed: 1500 rpm', say")
            )
        if layout.angle_unit not in _SECONDS and layout.recorded_speed is not None:
            faults.append(Fault(("recorded_speed",), "the speed is asked for times only; write 'angle_unit: s'"))
        refuse(*faults)
        return layout

    def degrees(self, column: "Array | None", rows: int) -> "Array":
        """Return the angles (rows,) in degrees that a column of the file tells, or none."""
        import numpy as np

        if column is None:
            return np.asarray(np.arange(rows) * (self.angle_step or 0.0), dtype=float)
        if self.recorded_speed is not None:
            return column * (360.0 * self.recorded_speed * _SECONDS[self.angle_unit])
        return np.asarray(column * math.degrees(1.0) if self.angle_unit == "rad" else column)


def samples_of(
    file: str, layout: Layout, what: str, base: "Callable[[Array], Array]", against: bool = False
) -> "Samples":
    """Return the laps of what was measured from a file; raises RuleError.

    base: turns figures of the file into the base of their unit; against: angles count against the rotation.
    """
    import numpy as np

    from kurbel.machine_file.columns import Columns, read_columns
    from kurbel.machine_file.recording import Recording
    from kurbel.machine_file.whole_cycle import whole_cycle

    between = DELIMITERS.get(layout.delimiter, layout.delimiter)
    angle = None if layout.angle_step else layout.angle_column
    table = read_columns(file, Columns(angle, layout.columns, layout.skip_rows, between, _DECIMALS[layout.decimal]))
    with np.errstate(over="ignore"):  # what is beyond all numbers is told with its line
        angles, values = layout.degrees(table.angles, table.values.shape[1]), base(table.values)

    try:
        return whole_cycle(Recording.of(angles, values, lambda row: Fault(("file",), table.line(row)), against), what)
    except RuleError as error:
        if layout.recorded_speed is None:
            raise
        (fault,) = error.faults
        asked = "" if "angle_unit" in fault.message else _BY_TIME
        raise RuleError(fault._replace(message=fault.message + asked)) from None
