"""The keys of a measured trace, whose samples are in the machine file or in a file of columns."""

from collections.abc import Callable
from dataclasses import dataclass
from os.path import basename
from typing import Any, ClassVar

import numpy as np

from kurbel.arrays import Array
from kurbel.declared.forms import (
    Choice,
    ColumnRange,
    Count,
    FilePath,
    Number,
    OneOf,
    Physical,
    Points,
    Record,
    UnitName,
    not_negative,
    positive,
)
from kurbel.declared.keys import Described, Key, Keys
from kurbel.declared.kinds import Factor, Point
from kurbel.errors import Fault, RuleError, refuse, refused
from kurbel.machine.ideal_cards import CLEARANCE
from kurbel.traces.correct import KnownLevel, Trace, motored_peak
from kurbel.traces.cycles import samples_of_file, whole_cycles
from kurbel.traces.read import DECIMALS, DELIMITERS, Layout


def layout_keys(what: str) -> Keys:
    """Return the keys of how a file of columns, angles and what was measured, is laid out."""
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
        "decimal": Key(Choice(tuple(DECIMALS)), "Decimal point or decimal comma", absent="point"),
        "angle_zero": Key(
            Physical("angle"), "Angle of the firing or inner dead centre as the file counts", absent="0 deg"
        ),
    }


class Pegging(Described):
    """What becomes a `KnownLevel`."""

    KEYS: ClassVar[Keys] = {
        "angle": Key(Physical("angle"), "Crank angle from the (firing) dead centre", required=True),
        "pressure": Key(Physical("pressure"), "Pressure there, as `pressures` says", required=True),
    }

    @classmethod
    def of_keys(cls, angle: float, pressure: float) -> KnownLevel:
        """Return where the level is known."""
        return KnownLevel(angle, pressure)


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


class Measured(Described):
    """What becomes a `Trace` once its samples are read and closed to whole cycles."""

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
        "pressure_columns": Key(
            ColumnRange(), "Columns of pressures, one for each measured cycle", instead="pressure_column"
        ),
        "angle_zero": Key(
            OneOf(Physical("angle"), Record(Motored)),
            "Angle of the firing or inner dead centre as the file counts; or a motored trace by which it is found",
            absent="0 deg",
        ),
        "angle_sense": Key(
            Choice(("with", "against")), "Whether angles count with the rotation, or against it", absent="with"
        ),
        "scale": Key(Number(), "Pressure, in the unit, for 1 of the file, such as bar for a volt", absent="1"),
        "offset": Key(Physical("pressure"), "Pressure that is added after the scale", absent="0 bar"),
        "pegging": Key(
            OneOf(Choice(("ambient",)), Record(Pegging)),
            "Where the level of every cycle is known; `ambient`: at the dead centre where the compression begins",
            absent="pressures as measured",
        ),
        "drift": Key(
            Choice(("linear",)), "Drift that is taken off every cycle, so that it closes", absent="none is taken off"
        ),
        "clearance": Key(
            CLEARANCE, "Clearance over stroke volume, for exponents and volumes", "ε₀", absent="not known"
        ),
        "compression_ratio": Key(
            Number(above=1), "The same as the largest volume over the smallest", "ε", instead="clearance", example="17"
        ),
    }

    @classmethod
    def of_keys(
        cls,
        unit: Factor,
        file: str | None = None,
        points: list[Point] | None = None,
        angle_zero: float | Motored = 0.0,
        angle_sense: str = "with",
        scale: float = 1.0,
        offset: float = 0.0,
        pegging: KnownLevel | str | None = None,
        drift: str | None = None,
        clearance: float | None = None,
        compression_ratio: float | None = None,
        **layout: Any,
    ) -> Trace:
        """Return the trace that these keys describe, its file read."""
        against = angle_sense == "against"
        up, down = unit

        def pressures(figures: Array) -> Array:
            """Return the pressures in Pa of figures of the file."""
            if scale == 0:
                refused("0 leaves no pressure; write the pressure for 1 of the file", "scale")
            return figures * up / down * scale + offset

        if file is None:
            refuse(*(Fault((key,), f"'{key}' describes a file; leave it out beside 'points'") for key in layout))
            angles, figures = np.array(points, dtype=float).T
            values = pressures(figures[np.newaxis])
            samples = whole_cycles(angles, values, lambda row: Fault(("points", row), ""), against=against)
            laid_out = Layout(columns=(0,))
        else:
            laid_out = Layout.of_keys("pressure", **layout)
            samples = samples_of_file(file, laid_out, "pressure", pressures, against)
        files, notes = (file,) if file else (), samples.notes
        if isinstance(angle_zero, Motored):
            files, given = (*files, angle_zero.motored), angle_zero
            angle_zero, note = dead_centre(given, laid_out, pressures, against)
            notes = (*notes, note)
        return Trace(
            samples.angles,
            samples.values,
            angle_zero=-angle_zero if against else angle_zero,
            files=files,
            notes=notes,
            completed=samples.completed,
            clearance=1 / (compression_ratio - 1) if compression_ratio else clearance,
            level=drift == "linear",
            pegging=KnownLevel() if isinstance(pegging, str) else pegging,
            against=against,
            unit=up / down,
            scale=scale,
            offset=offset,
            column=laid_out.columns[0],
        )


def dead_centre(given: Motored, layout: Layout, base: Callable[[Array], Array], against: bool) -> tuple[float, str]:
    """Return the angle of the dead centre in degrees as the file counts, and a note on it; raises RuleError."""
    try:
        samples = samples_of_file(given.motored, layout, "pressure", base, against)
        peak, doubt = motored_peak(samples.angles, samples.values)
    except RuleError as error:
        raise RuleError(*(fault._replace(path=("angle_zero", "motored")) for fault in error.faults)) from None
    sense = -1 if against else 1
    zero = sense * (peak.place + given.loss_angle)
    note = (
        f"angle_zero is {zero:.4g} deg, uncertain by {doubt:.2g} deg: the peak of a parabola through "
        f"{peak.samples} samples of {basename(given.motored)} stands at {sense * peak.place:.4g} deg, the dead centre "
        f"{given.loss_angle:g} deg later"
    )
    return zero, note
