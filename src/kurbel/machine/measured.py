"""The keys of a measured trace, whose samples are in the machine file or in a file of columns."""

from collections.abc import Callable, Iterator
from os.path import basename
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from kurbel.arrays import Array
from kurbel.declared.forms.structures import OneOf, RecordForm
from kurbel.declared.forms.values import (
    CLEARANCE,
    COLUMN_RANGE,
    FILE_PATH,
    Choice,
    NumberForm,
    Points,
    unit_name,
)
from kurbel.declared.record import Record, Rule, ValuesByKey, alternative, field
from kurbel.declared.units import DiagramPoint, UnitFactor
from kurbel.errors import Fault, RuleError, refused
from kurbel.traces.correct import KnownLevel, Strokes, Trace, motored_peak
from kurbel.traces.cycles import Laps, samples_of_file, whole_cycles
from kurbel.traces.read import DECIMALS, DELIMITERS, SECONDS, Layout

if TYPE_CHECKING:
    from kurbel.traces.heat import HeatLaw


class Columns(Record):
    """The layout of a file of columns; `what` was measured over the angles: pressures or torques."""

    what: ClassVar[str]
    needs_speed: ClassVar[bool] = True
    file = alternative(
        FILE_PATH, "File with a column of angles in degrees", example="indicator.csv"
    )
    angle_column = alternative(
        int, "Column of the angles, counted from 1", absent="1", needs="file"
    )
    angle_unit = alternative(
        ("deg", "rad", "s", "ms"),
        "Unit of the angle column: an angle, or time",
        absent="deg",
        needs="file",
    )
    recorded_speed = alternative(
        "speed",
        "Constant speed at which times were recorded; of pressures, where their period does not show it",
        above=0,
        needs="angle_unit",
    )
    pulse_column = alternative(
        int,
        "Column of the pulses of a toothed wheel, instead of a column of angles",
        instead="angle_column",
        needs="file",
    )
    teeth = alternative(
        NumberForm(whole=True, least=1),
        "Teeth of the wheel in one turn, with the missing ones",
        absent="1",
        needs="pulse_column",
    )
    missing_teeth = alternative(
        NumberForm(whole=True, least=0),
        "Teeth that are left out at the reference: angles count from the first tooth after the gap",
        absent="0",
        needs="pulse_column",
    )
    angle_step = alternative(
        "angle",
        "Crank angle from one row to the next, instead of a column of angles",
        above=0,
        instead="angle_column",
        needs="file",
    )
    skip_rows = alternative(
        NumberForm(whole=True, least=0),
        "Number of lines before the first data",
        absent="0",
        needs="file",
    )
    sheet = alternative(
        str, "Sheet of a workbook (xlsx), by its name", absent="the first", needs="file"
    )
    delimiter = alternative(
        (*DELIMITERS, *DELIMITERS.values()),
        "Separator of the columns",
        absent="comma; of a workbook its cells",
        also=("separator", "sep"),
        needs="file",
    )
    decimal = alternative(
        tuple(DECIMALS), "Decimal point or decimal comma", absent="point", needs="file"
    )

    @classmethod
    def rules_of_keys(cls, values: ValuesByKey) -> Iterator[Rule]:
        """Yield the rules on keys of the layout that contradict one another."""
        if "file" not in values:
            return
        # a column of both angles and figures
        key = f"{cls.what}_column"
        columns = (values.get(key, 2),)
        if f"{cls.what}_columns" in values:
            key = f"{cls.what}_columns"
            columns = values[key]
        angle_column = values.get("angle_column", 1)
        measured = "angle"
        for other in ("pulse", "volume", "displacement"):
            if f"{other}_column" in values:
                angle_column = values[f"{other}_column"]
                measured = other
        is_of_angles = angle_column in columns and "angle_step" not in values
        yield Rule(key, is_of_angles, f"column {angle_column} is that of the {measured}s")
        # times and the speed that makes them angles
        has_times = values.get("angle_unit") in SECONDS
        has_speed = "recorded_speed" in values
        message = "times become angles by a speed; write 'recorded_speed: 1500 rpm', say"
        yield Rule("angle_unit", has_times and not has_speed and cls.needs_speed, message)
        message = "a speed is for times only; write 'angle_unit: s'"
        yield Rule("recorded_speed", has_speed and not has_times, message)
        # the wheel whose pulses are angles
        message = "how many 'teeth' has the wheel in one turn? Write 'teeth: 60', say"
        yield Rule("pulse_column", "pulse_column" in values and "teeth" not in values, message)

    @classmethod
    def layout(cls, keys: dict[str, Any]) -> Layout:
        """Return the layout that these keys describe."""
        columns = keys.pop(f"{cls.what}_columns", None)
        if columns is None:
            columns = (keys.pop(f"{cls.what}_column", 2),)
        # a delimiter by its word, or as the sign itself
        delimiter = keys.pop("delimiter", "")
        words = {sign: word for word, sign in DELIMITERS.items()}
        return Layout(columns, delimiter=words.get(delimiter, delimiter), **keys)


def _heat_law() -> "type[HeatLaw]":
    from kurbel.traces.heat import HeatLaw

    return HeatLaw


class Motored(Record):
    """A motored trace, and by how many degrees heat loss and leakage put its peak before the dead centre."""

    motored: str = field(
        FILE_PATH, "File of a motored trace, in the same layout as the trace", example="motored.csv"
    )
    loss_angle: float = field(
        "angle",
        "Thermodynamic loss angle: how far heat loss and leakage move the peak ahead of the dead centre",
        least=0,
        example="0.7 deg",
    )
    sheet: str | None = field(
        str, "Its sheet, of a workbook", absent="as that of the trace", example="motored"
    )


class Measured(Columns):
    """What becomes a `Trace` once its samples are read and closed to whole cycles."""

    what = "pressure"
    needs_speed = False
    file = Columns.file._replace(
        text="File with a column of angles in degrees and one of pressures; or give `points`",
        required=True,
    )
    points = alternative(
        Points("deg", "pressure"), "Pressure over the crank angle; or give `file`", instead="file"
    )
    unit = alternative(unit_name("pressure"), "Unit of the pressures", required=True)
    pressure_column = alternative(
        int, "Column of the pressures, counted from 1", absent="2", needs="file"
    )
    angle_zero = alternative(
        OneOf(NumberForm("angle"), RecordForm(Motored)),
        "Angle of the firing or inner dead centre in the file; or a motored trace from which it is found",
        absent="0 deg",
    )
    volume_column = alternative(
        int,
        "Column of the volumes of the chamber, instead of a column of angles",
        instead="angle_column",
        needs="volume_unit",
        also=("v_column",),
    )
    volume_unit = alternative(unit_name("volume"), "Unit of the volumes", needs="volume_column")
    displacement_column = alternative(
        int,
        "Column of the displacements of the piston from its inner dead centre, or any other place, instead of a "
        "column of angles",
        instead="angle_column",
        needs="displacement_unit",
    )
    displacement_unit = alternative(
        unit_name("length"), "Unit of the displacements", needs="displacement_column"
    )
    pressure_columns = alternative(
        COLUMN_RANGE,
        "Columns of pressures, one for each measured cycle",
        instead="pressure_column",
        needs="file",
    )
    angle_sense = alternative(
        ("with", "against"),
        "Direction in which angles count: with the rotation or against it",
        absent="with",
    )
    scale = alternative(
        "ratio",
        "Pressure, in the unit, per 1 of the file, such as bar per volt",
        absent="1",
        example="20",
    )
    offset = alternative("pressure", "Pressure added after scaling", absent="0 bar")
    pegging = alternative(
        OneOf(Choice(("ambient",)), RecordForm(KnownLevel)),
        "Reference point for the absolute level of every cycle; `ambient`: the dead centre where the compression "
        "begins",
        absent="pressures as measured",
    )
    drift = alternative(
        ("linear",), "Drift correction of every cycle, so that it closes", absent="none"
    )
    clearance = alternative(
        CLEARANCE,
        "Clearance over stroke volume, for exponents and volumes",
        "ε₀",
        absent="not known",
        example="0.06",
    )
    compression_ratio = alternative(
        "ratio",
        "Largest over smallest volume, instead of `clearance`",
        "ε",
        above=1,
        instead="clearance",
        example="17",
    )

    suction_line = alternative(
        "pressure",
        "Pressure in the suction line of a compressor, gauge or absolute as in `pressures`",
        absent="that in the cylinder at its largest volume",
    )
    discharge_line = alternative(
        "pressure",
        "Pressure in the discharge line of a compressor, gauge or absolute as in `pressures`",
        absent="that in the cylinder at its smallest volume",
    )

    heat = alternative(
        RecordForm(_heat_law),
        "Heat release, by the first law from pressure and volume",
        absent="not computed",
    )

    @classmethod
    def rules_of_keys(cls, values: ValuesByKey) -> Iterator[Rule]:
        """Yield the rules on keys that contradict one another."""
        yield from super().rules_of_keys(values)
        has_volumes = "clearance" in values or "compression_ratio" in values
        message = "heat needs the volumes; give 'clearance' or 'compression_ratio'"
        lacks_volumes = not has_volumes and "volume_column" not in values
        yield Rule("heat", "heat" in values and lacks_volumes, message)
        # rows by volume or displacement have no other angles
        if not {"volume_column", "displacement_column"} & values.keys():
            return
        for key in _OF_ANGLES:
            message = "the crank angles follow from the order of the rows; leave it out"
            yield Rule(key, key in values, message)
        has_both = {"volume_column", "displacement_column"} <= values.keys()
        yield Rule("displacement_column", has_both, "give it, or 'volume_column', not both")

    @classmethod
    def of_keys(
        cls,
        unit: UnitFactor,
        file: str | None = None,
        points: list[DiagramPoint] | None = None,
        angle_zero: float | Motored = 0.0,
        angle_sense: str = "with",
        scale: float = 1.0,
        offset: float = 0.0,
        pegging: KnownLevel | str | None = None,
        drift: str | None = None,
        clearance: float | None = None,
        compression_ratio: float | None = None,
        suction_line: float | None = None,
        discharge_line: float | None = None,
        heat: "HeatLaw | None" = None,
        **layout: Any,
    ) -> Trace:
        """Return the trace that these keys describe, its file read."""
        counts_against = angle_sense == "against"
        multiplier, divisor = unit

        def pressures_of(figures: Array) -> Array:
            """Return the pressures in Pa of figures of the file."""
            if scale == 0:
                refused("0 leaves no pressure; write the pressure for 1 of the file", "scale")
            return figures * multiplier / divisor * scale + offset

        # the samples, from the file of the trace or from the machine file
        files: tuple[str, ...] = ()
        file_layout = Layout()
        strokes = None
        if file is None:
            angles, figures = np.array(points, dtype=float).T
            pressures = pressures_of(figures[np.newaxis])
            samples = whole_cycles(
                angles,
                pressures,
                lambda row: Fault(("points", row), ""),
                against=counts_against,
            )
        else:
            files = (file,)
            over = _strokes_of_layout(layout)
            file_layout = cls.layout(layout)
            if over is None:
                samples = samples_of_file(
                    file, file_layout, "pressure", pressures_of, counts_against
                )
            else:
                samples, strokes = _strokes_of_file()(
                    file, file_layout, pressures_of, *over, counts_against
                )
        # the dead centre
        notes = samples.notes
        if isinstance(angle_zero, Motored):
            files = (*files, angle_zero.motored)
            angle_zero, note = dead_centre(angle_zero, file_layout, pressures_of, counts_against)
            notes = (*notes, note)
        # the clearance; ε = 1 + 1/ε₀
        if compression_ratio:
            clearance = 1 / (compression_ratio - 1)
        return Trace(
            samples.angles,
            samples.values,
            angle_zero=-angle_zero if counts_against else angle_zero,
            files=files,
            notes=notes,
            completed=samples.completed,
            clearance=clearance,
            level=drift == "linear",
            pegging=pegging,
            against=counts_against and strokes is None,
            unit=multiplier / divisor,
            scale=scale,
            clock=samples.clock,
            suction=suction_line,
            discharge=discharge_line,
            heat=heat,
            strokes=strokes,
        )


_OF_ANGLES = ("angle_zero", "angle_unit", "angle_step", "pulse_column", "recorded_speed")
"""Keys of files with angles or times."""


def _strokes_of_file() -> Callable[..., "tuple[Laps, Strokes]"]:
    from kurbel.traces.strokes import strokes_of_file

    return strokes_of_file


def _strokes_of_layout(layout: dict[str, Any]) -> tuple[str, float] | None:
    """Return what a file has instead of angles, and its unit in SI; its column takes the place of theirs."""
    for kind in ("volume", "displacement"):
        column = layout.pop(f"{kind}_column", None)
        unit = layout.pop(f"{kind}_unit", None)
        if column is not None and unit is not None:
            layout["angle_column"] = column
            multiplier, divisor = unit
            return kind, multiplier / divisor
    return None


def dead_centre(
    motored: Motored, layout: Layout, base: Callable[[Array], Array], against: bool
) -> tuple[float, str]:
    """Return the angle of the dead centre in degrees as the file counts, and a note on it; raises RuleError.

    base: turns figures of the file into Pa; against: its angles count against the rotation.
    """
    file = motored.motored
    if motored.sheet is not None:
        layout = layout._replace(sheet=motored.sheet)
    try:
        samples = samples_of_file(file, layout, "pressure", base, against)
        if samples.clock is not None and samples.clock.is_free:
            refused("a motored trace by time needs a 'recorded_speed'")
        peak, uncertainty = motored_peak(samples.angles, samples.values)
    except RuleError as error:
        faults = [fault._replace(path=("angle_zero", "motored")) for fault in error.faults]
        raise RuleError(*faults) from None
    sign = -1 if against else 1
    zero = sign * (peak.place + motored.loss_angle)
    note = (
        f"angle_zero is {zero:.4g} deg, uncertain by {uncertainty:.2g} deg: "
        f"the peak of a parabola through {peak.samples} samples of {basename(file)} "
        f"is at {sign * peak.place:.4g} deg, the dead centre {motored.loss_angle:g} deg later"
    )
    return zero, note
