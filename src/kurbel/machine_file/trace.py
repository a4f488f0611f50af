"""The keys of a measured trace, whose samples stand in the machine file or in a file of columns beside it."""

from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple

from kurbel.declared.forms import Choice, ColumnRange, FilePath, Number, OneOf, Physical, Points, Record, UnitName
from kurbel.declared.keys import Described, Key, Keys
from kurbel.declared.kinds import Factor, Point
from kurbel.errors import Fault, refuse, refused
from kurbel.machine.ideal_cards import CLEARANCE
from kurbel.machine_file.motored import Motored
from kurbel.machine_file.samples import Layout, layout_keys, samples_of
from kurbel.traces.correct import KnownLevel, Trace

if TYPE_CHECKING:
    from kurbel.arrays import Array
    from kurbel.machine_file.whole_cycle import Samples

_LAYOUT = layout_keys("pressure")


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
        **_LAYOUT,
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
        angle_zero: "float | Motored" = 0.0,
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
        gauge = _Gauge(unit, scale, offset)
        if file is None:
            refuse(*(Fault((key,), f"'{key}' describes a file; leave it out beside 'points'") for key in layout))
            samples, laid_out = _from_points(points or [], gauge, against), Layout()
        else:
            laid_out = Layout.of_keys("pressure", **layout)
            samples = samples_of(file, laid_out, "pressure", gauge.pressures, against)
        zero, files, notes = _zero(angle_zero, laid_out, gauge, against)
        return Trace(
            samples.angles,
            samples.values,
            angle_zero=-zero if against else zero,
            files=(*((file,) if file else ()), *files),
            notes=(*samples.notes, *notes),
            completed=samples.completed,
            clearance=1 / (compression_ratio - 1) if compression_ratio else clearance,
            level=drift == "linear",
            pegging=KnownLevel() if isinstance(pegging, str) else pegging,
            against=against,
            unit=unit[0] / unit[1],
            scale=scale,
            offset=offset,
            column=laid_out.columns[0] if file else 0,
        )


class _Gauge(NamedTuple):
    """What turns figures of a file into pressures in Pa."""

    unit: Factor
    scale: float
    offset: float

    def pressures(self, figures: "Array") -> "Array":
        """Return pressures of the shape of the figures; raises RuleError for a scale of 0."""
        if self.scale == 0:
            refused("0 leaves no pressure; write the pressure for 1 of the file", "scale")
        up, down = self.unit
        return figures * up / down * self.scale + self.offset


def _from_points(points: list[Point], gauge: _Gauge, against: bool) -> "Samples":
    import numpy as np

    from kurbel.machine_file.recording import Recording
    from kurbel.machine_file.whole_cycle import whole_cycle

    angles, values = np.array(points, dtype=float).T
    pressures = gauge.pressures(values[np.newaxis])
    return whole_cycle(Recording.of(angles, pressures, lambda row: Fault(("points", row), ""), against))


def _zero(
    given: "float | Motored", layout: Layout, gauge: _Gauge, against: bool
) -> tuple[float, tuple[str, ...], tuple[str, ...]]:
    """Return the angle of the dead centre as the file counts, the files that it was read from, and what to say."""
    if isinstance(given, (int, float)):
        return given, (), ()
    from kurbel.machine_file.motored import dead_centre

    zero, note = dead_centre(given, layout, gauge.pressures, against)
    return zero, (given.motored,), (note,)
