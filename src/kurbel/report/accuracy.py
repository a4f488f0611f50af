"""The reports of `kurbel accuracy`: error against run time, and the verdicts on stiff and extreme cases."""

import platform
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import NamedTuple

import numpy as np

from kurbel.accuracy import trials
from kurbel.accuracy.extremes import all_cases, verdicts
from kurbel.errors import UsageError
from kurbel.machine import Machine
from kurbel.report.commands import report_of
from kurbel.report.frame import Frame, provenance
from kurbel.report.picture import Axis, Curve, Panel, Picture, Words
from kurbel.report.tables import Column, LeftOut, Part, PlaceTable, Report, Value
from kurbel.solver.case import Case

Loads = Callable[[str], Machine]
"""Reads the text of a machine file; passed in by the command line, since reports do not import the reader."""
Progress = Callable[[str, float], None]
"""Called with what is computed, and the completed share."""
NUMERICAL = "numerical_error"
"""Id of the table that the picture is drawn from."""


class Scene(NamedTuple):
    """A built-in machine.

    turns: from these on its motion is compared, -1 if an earlier scene has done so; quick: it is also in the quick run.
    """

    text: str
    turns: int = 0
    quick: bool = False


_STEAM = (
    "{unit: at, expansion: [[0, 9.5], [0.35, 9.5], [0.5, 6.7], [0.7, 4.7], [0.95, 3.3], [1, 2.2]], "
    "compression: [[1, 1.2], [0.25, 1.2], [0.1, 2.4], [0.02, 6.5], [0, 9.5]]}"
)
_CYLINDER = f"bore: 450 mm, indicator: {{head_end: {_STEAM}, crank_end: mirrored}}"
_TRAIN, _MASSES = "speed: 50 rpm, crank: 400 mm", "masses: {piston: 200 kg}"
_GAS_ENGINE = """
name: Gas engine, offset
speed: 160 rpm
cycle: four-stroke
stroke: 600 mm
rod: 1400 mm
offset: 20 mm
bore: 400 mm
indicator:
  pressures: absolute
  head_end:
    unit: bar
    interpolate: polytropic
    clearance: 0.2
    intake: [[0, 0.95], [1, 0.95]]
    compression: [[1, 0.95], [0, 9.8]]
    expansion: [[0, 26], [0.03, 25], [1, 2.6]]
    exhaust: [[1, 1.1], [0, 1.1]]
masses: {piston: 240 kg, connecting_rod: 180 kg}
inclination: 90 deg
friction: {crosshead: 0.05, rings: {count: 5, height: 12 mm, pressure: 0.4 bar, coefficient: 0.1}}
flywheel: {inertia: 4000 kg m2}
load: {slip: 0.02}
"""
_SCENES = (
    Scene(
        f"{{name: Steam engine, {_TRAIN}, rod: 2000 mm, {_CYLINDER}, {_MASSES}, inclination: 0 deg, "
        "friction: {crosshead: 0.06}, flywheel: {inertia: 900 kg m2}, load: {power_law: 2}}",
        quick=True,
    ),
    Scene(_GAS_ENGINE),
    Scene(
        f'{{name: "Short rod, L/R = 1.01", {_TRAIN}, rod: 404 mm, {_CYLINDER}, {_MASSES}, '
        "friction: {crosshead: 0.06}}"
    ),
    Scene(f'{{name: "Long rod, L/R = 1e6", {_TRAIN}, rod: 400 km}}', quick=True),
    Scene(f"{{name: Millionth turn, {_TRAIN}, rod: 2000 mm}}", turns=10**6),
    Scene(
        f'{{name: "Stiff: on the grid, slip 1e-6", {_TRAIN}, rod: 2000 mm, {_CYLINDER}, {_MASSES}, '
        "flywheel: {inertia: 20 kg m2}, load: {slip: 1e-6}}",
        turns=-1,
        quick=True,
    ),
    Scene(
        f'{{name: "Slow: heavy flywheel and a fan", {_TRAIN}, rod: 2000 mm, {_CYLINDER}, '
        "flywheel: {inertia: 6e7 kg m2}, load: {power_law: 2}}",
        turns=-1,
    ),
)
_NOTES = (
    "Error: the largest relative error against a reference of 40 digits by another method; where the exact value is "
    "zero, relative to the largest value. Of model and data it is the largest difference over the cycle, relative to "
    "the largest value. ulp: the same in units of the last place, below 1e-12.",
    "Ratio: median time over that of kurbel's own method, or of the whole machine. Points: divisions of a turn, or "
    "points on each piece between corners, which the methods between corners are given. Evaluations: crank angles of "
    "which the motion is computed. Stages: functions of the solver that run for all that `kurbel forces` prints.",
)


def accuracy_report(
    machine: Machine | None,
    quick: bool,
    loads: Loads,
    uncertain: Mapping[str, float],
    progress: Progress | None = None,
) -> Report:
    """Return error against run time for a machine, or for the built-in scenes; quick: fewer scenes and points.

    uncertain: relative uncertainties of quantities by symbol, from those in the file of the machine; progress: called
    with the name of each scene and the share of them that is done.
    """
    scenes = [(machine, 0)] if machine else [(loads(one.text), one.turns) for one in _SCENES if one.quick or not quick]
    parts: list[Part] = []
    notes = [*_NOTES]
    with np.errstate(all="ignore"):
        for number, (one, turns) in enumerate(scenes):
            if progress:
                progress(one.name, number / len(scenes))
            degrees = 360.0 * turns + np.arange(361.0 if turns >= 0 else 0.0)
            rows, lacking = trials.examined(one, degrees, quick)
            spreads = [
                trials.Difference(symbol, "standard uncertainties of the file", one)
                for symbol, one in uncertain.items()
            ]
            heavy = any(cylinder.masses or cylinder.pistons for cylinder in one.cylinders)
            saved = [*trials.savings(one, _everything, quick)] if heavy else []
            tables = (
                _table(NUMERICAL, f"{one.name}: numerical error", rows, 4),
                _table("model_error", f"{one.name}: error of the model", [*trials.model_errors(one)], 2),
                _table("data_error", f"{one.name}: error of the data", [*trials.data_errors(one), *spreads], 2),
                _table("leaving_out", f"{one.name}: what leaving out saves", saved, 1),
            )
            left_out = tuple(LeftOut(*what) for what in lacking)
            parts.append(Part(one.name, (), left_out=left_out, place_tables=tuple(t for t in tables if t.names)))
            notes += [
                f"{one.name}, {row.quantity}: {row.method} ({row.points}) is more exact and faster than kurbel's own"
                for row in trials.better(rows)
            ]
    if len(notes) == len(_NOTES) and any(table.id == NUMERICAL for table in parts[0].place_tables):
        notes.append("No method listed is both more exact and faster than kurbel's own, beyond noise (20 %, 16 u).")
    head = (environment(), "Times are of this machine and this run; compare them only with one another.")
    title = f"{machine.name if machine else 'built-in scenes'}. Accuracy and run time"
    named = machine.name if machine else None
    report = Report(title, "accuracy", named, "scenes", tuple(parts), notes=tuple(notes), head=head)
    return report._replace(provenance=provenance(machine)) if machine else report


def _table(id: str, title: str, found: Sequence[NamedTuple], heads: int) -> PlaceTable:
    """Return a table of records, whose first fields are the names of a row and whose others are its columns."""
    fields = found[0]._fields if found else ()
    columns = (_column(name, [one[place] for one in found]) for place, name in enumerate(fields) if place >= heads)
    names = tuple(tuple(map(str, one[:heads])) for one in found)
    return PlaceTable(id, title, fields[:heads], names, tuple(columns), True)


def _column(id: str, values: Sequence[Value]) -> Column:
    if id in ("median", "least"):  # times in s
        return Column(id, id, id, "ms", tuple(value and value * 1e3 for value in values), alone=2)
    return Column(id, id, id, "", tuple(values), alone=2)


def _everything(machine: Machine) -> None:
    """Compute all that `kurbel forces` prints: every column at 37 angles, and every key value."""
    report_of(Case(machine), Frame("forces", tuple(np.arange(0.0, 361.0, 10.0)), None, "si"))


def environment() -> str:
    """Return versions and processor, which the times belong to."""
    versions = []
    for package in ("kurbel", "numpy", "mpmath"):
        with suppress(PackageNotFoundError):  # such as kurbel where it is run from its source
            versions.append(f"{package} {version(package)}")
    versions.insert(1, f"Python {platform.python_version()}")
    processor = platform.processor() or "unknown processor"
    if Path("/proc/cpuinfo").exists():
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8", errors="replace").splitlines()
        processor = next((line.partition(":")[2] for line in lines if line.startswith("model name")), processor)
    system = f"{platform.system()} {platform.machine()}"
    return f"{', '.join(versions)}; {system}, {' '.join(processor.split())}"


# stiff and extreme cases


def extremes_report(loads: Loads) -> tuple[Report, bool]:
    """Return the verdicts on all cases, and whether every one is passed."""
    found = list(verdicts(all_cases(), lambda text, asked: answer(loads(text), asked), loads))
    passed = sum(verdict.passed for verdict in found)
    names = tuple(
        (one.case.case, one.case.asked, one.expected, one.observed, "passed" if one.passed else "FAILED")
        for one in found
    )
    columns = (
        _column("ulp", [one.ulp for one in found]),
        _column("allowed", [None if one.ulp is None else float(one.case.ulp) for one in found]),
    )
    heads = ("case", "asked", "expected", "observed", "verdict")
    table = PlaceTable("extremes", f"{passed} of {len(found)} cases passed", heads, names, columns, True)
    part = Part("stiff and extreme cases", (), place_tables=(table,))
    title = "Stiff and extreme cases"
    return Report(title, "accuracy", None, "scenes", (part,), head=(environment(),)), passed == len(found)


def answer(machine: Machine, asked: str) -> float | None:
    """Return what the program prints for `forces T_max` or `motion x@30`, in SI; None where it is left out.

    The machine goes the whole way to the report. Raises KurbelError as the program does.
    """
    command, _, quantity = asked.partition(" ")
    name, _, at = quantity.partition("@")
    report = report_of(Case(machine), Frame(command, (float(at or 0),), None, "si"))
    parts = [part for part in (report.whole, *report.parts) if part]
    if at:
        values = (column.values[0] for part in parts for column in part.columns if column.id == name)
    else:
        values = (one.value for part in parts for one in part.key_values if one.id == name)  # type: ignore[misc]
    value = next(iter(values), None)
    return None if value is None else float(value)


_LEAST = 1e-17
"""Errors below this, zero too, are drawn here."""


def accuracy_picture(report: Report) -> Picture:
    """Return a panel for each quantity of an accuracy report, with all its scenes.

    Raises UsageError where nothing was compared.
    """
    # quantity -> method -> errors and times in ms, with a gap after each scene
    found: dict[str, dict[str, list[tuple[float, float]]]] = {}
    for table in (table for part in report.parts for table in part.place_tables if table.id == NUMERICAL):
        columns, here = {column.id: column.values for column in table.columns}, set()
        for (quantity, name, _, state), error, time in zip(table.names, columns["error"], columns["median"]):
            if error is not None and time is not None and state == "ok":
                method = name.split(",")[0]
                dots = found.setdefault(quantity, {}).setdefault(method, [])
                if dots and (quantity, method) not in here:
                    dots.append((np.nan, np.nan))
                here.add((quantity, method))
                dots.append((max(error, _LEAST), time))
    if not found:
        raise UsageError("--plot: nothing was compared, there is nothing to draw")

    methods = list(dict.fromkeys(method for every in found.values() for method in every))
    times = [time for every in found.values() for dots in every.values() for _, time in dots]
    low, high = np.nanmin(times), np.nanmax(times)
    rounding = Curve(Words(""), np.array([2.0**-53, 2.0**-53]), np.array([low, high]), "faint")
    x = Axis(Words("error"), log=True, low=_LEAST, high=1.0, falling=True)
    y = Axis(Words("time"), unit="ms", log=True, low=low, high=high)
    panels = []
    for quantity, every in found.items():
        curves = [rounding]
        for name, dots in every.items():
            errors, spans = np.array(dots).T
            curves.append(Curve(Words(name), errors, spans, "dots", methods.index(name)))
        panels.append(Panel(x, y, tuple(curves), title=quantity))
    return Picture(
        "accuracy",
        "time over error",
        "Time over relative error of each method, lines between its answers for one machine; the error falls to the "
        "right, the thin upright line is the rounding of one float.",
        tuple(panels),
        report.title,
        across=min(4, len(found)),
        legend=tuple((Words(method), number) for number, method in enumerate(methods)),
    )
