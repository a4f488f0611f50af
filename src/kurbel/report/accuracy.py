"""The reports of `kurbel accuracy`: error against run time, and the verdicts on stiff and extreme cases."""

import platform
from collections.abc import Callable, Sequence
from contextlib import suppress
from functools import partial
from importlib.metadata import PackageNotFoundError, version
from itertools import chain
from pathlib import Path
from typing import NamedTuple

import numpy as np

from kurbel.accuracy import stiff, trials
from kurbel.accuracy.extremes import all_cases, table_lines, verdicts
from kurbel.accuracy.references import Textbook
from kurbel.machine import Machine
from kurbel.report.commands import report_of
from kurbel.solver.case import Case
from kurbel.tables.frame import Frame, provenance
from kurbel.tables.tables import Column, LeftOut, Part, PlaceTable, Report

MachineReader = Callable[[str], Machine]
"""Reads the text of a machine file; passed in by the command line, since reports do not import the reader."""
OnProgress = Callable[[str, float], None]
"""Called with what is computed, and the completed share."""
NUMERICAL, SPEED = "numerical_error", "speed_error"
"""Ids of the tables that the picture is drawn from."""
_NOTES = (
    "Error: the largest relative error against a reference of 40 digits by another method; where the exact value is "
    "zero, relative to the largest value. ulp: the same in units of the last place, below 1e-12.",
    "Ratio: median time over that of kurbel's own method, or of the whole machine. Points: divisions of a turn, or "
    "points on each piece between corners, which the methods between the corners are given; the others have the same "
    "forces and no corners. Of T and ΔE a spreadsheet has the largest ordinate and the trapezium rule. Evaluations: "
    "crank angles of which the motion is computed. Stages: functions of the solver that run for all that "
    "`kurbel forces` prints.",
)
_SPEED_NOTE = (
    "Speed: errors relative to a collocation in 40 digits, of ω the largest every 30°. Rivals are given the torque of "
    "the textbook as polynomials, which costs them no time, and no corners. RK4: so many steps a cycle; others: "
    "scipy's methods with a relative tolerance, where scipy is installed. State: what became of a march of 20 cycles, "
    "or of a search for the cycle that repeats; under a constant load one cycle is enough, at the level of the nominal "
    "mean speed. A method gives up after 12,000 evaluations, Radau after 4,000, or where as many in each of the fewest "
    "cycles would be more: a march takes two, a search one for each unknown besides."
)


def accuracy_report(
    machine: Machine | None, quick: bool, loads: MachineReader, progress: OnProgress | None = None
) -> Report:
    """Return error against run time for a machine, or for the built-in scenes; quick: fewer scenes and repeats.

    progress: called with the name of each scene and the share of them that is done.
    """
    scenes = [Scene(machine, 0.0, ())] if machine else built_in_scenes(quick, loads)
    parts: list[Part] = []
    sentences: list[str] = []
    textbook: Textbook | None = None
    for number, scene in enumerate(scenes):
        if progress:
            progress(scene.machine.name, number / len(scenes))
        textbook = Textbook(scene.machine, textbook)
        part, shown = _part_of(scene, textbook, machine is not None, quick)
        parts.append(part)
        sentences += shown
    tables = chain.from_iterable(part.place_tables for part in parts)
    has_speed = any(table.id == SPEED for table in tables)
    return Report(
        f"{machine.name if machine else 'built-in scenes'}. Accuracy and run time",
        "accuracy",
        machine.name if machine else None,
        "scenes",
        tuple(parts),
        notes=(*_NOTES, *((_SPEED_NOTE,) if has_speed else ()), *sentences),
        head=(
            environment(),
            "Times are of this machine and this run; compare them only with one another.",
        ),
        provenance=partial(provenance, machine) if machine else None,
    )


class Scene(NamedTuple):
    """A machine; first: the angle in degrees from which its motion is compared, None for the speed of the shaft alone.

    speed: columns of the reference of its speed, if that is known.
    """

    machine: Machine
    first: float | None
    speed: tuple[str, ...]


def built_in_scenes(quick: bool, loads: MachineReader) -> list[Scene]:
    """Return the scenes of `scenes.tsv` (quick, turn, machine) and of `stiff.tsv` (quick, machine, reference)."""
    scenes = []
    for is_quick, turns, text in table_lines("scenes.tsv"):
        if is_quick or not quick:
            scenes.append(Scene(loads(text), 360.0 * int(turns), ()))
    for is_quick, text, *reference in table_lines("stiff.tsv"):
        if is_quick or not quick:
            scenes.append(Scene(loads(text), None, tuple(reference)))
    return scenes


def _part_of(
    scene: Scene, textbook: Textbook, is_file: bool, quick: bool
) -> tuple[Part, list[str]]:
    """Return the tables of a scene, and what they show in sentences."""
    machine = scene.machine
    tables: list[PlaceTable] = []
    lacking: list[LeftOut] = []
    sentences: list[str] = []

    # motion, forces and energy
    if scene.first is not None:
        with np.errstate(all="ignore"):
            rows, left_out = trials.examined(textbook, scene.first + np.arange(361.0), quick)
        tables.append(_table(NUMERICAL, f"{machine.name}: numerical error", rows, 4))
        lacking += [LeftOut(", ".join(quantities), why) for why, quantities in left_out.items()]
        sentences += _of_rivals(machine.name, rows)

    # the speed of the shaft
    if is_file or scene.first is None:
        with np.errstate(all="ignore"):
            speeds, why = stiff.examined_speed(textbook, scene.speed, quick)
        tables.append(_table(SPEED, f"{machine.name}: speed of the shaft", speeds, 3))
        sentences += _of_speed(machine.name, speeds)
        if why and machine.flywheel is not None:
            lacking.append(LeftOut("ω, δ", why))

    # what leaving out saves
    is_heavy = any(cylinder.masses or cylinder.pistons for cylinder in machine.cylinders)
    if scene.first is not None and is_heavy:
        saved = [*trials.savings(machine, _everything, quick)]
        tables.append(_table("leaving_out", f"{machine.name}: what leaving out saves", saved, 1))
    filled = tuple(table for table in tables if table.names)
    return Part(machine.name, (), left_out=tuple(lacking), place_tables=filled), sentences


def _of_rivals(name: str, rows: Sequence[trials.Trial]) -> list[str]:
    """Return what the rows of a scene show of methods with the corners and without them."""
    sentences = []
    equal = trials.with_corners(rows)
    if equal:
        shown = "; ".join(
            f"{row.quantity} {ratio:.2g} ({row.method}, {row.points})" for row, ratio in equal
        )
        sentences.append(
            f"{name}: given the corners and enough points, the fastest methods with the digits of kurbel take of its "
            f"time {shown}. kurbel finds corners and points itself."
        )
    rough = trials.without_corners(rows)
    if rough:
        shown = "; ".join(
            f"{row.quantity} {row.error:.0e} ({row.method}, {row.points})" for row, _ in rough
        )
        sentences.append(
            f"{name}: without the corners, in no more time than kurbel's, the least errors are {shown}."
        )
    return sentences


def _of_speed(name: str, rows: Sequence[stiff.SpeedTrial]) -> list[str]:
    """Return what the rows show of the speed: the most exact rival, and how many fail."""
    if not rows:
        return []
    kurbel, others = rows[0], [row for row in rows if not row.method.startswith(trials.OWN)]
    failed = sum(row.omega is None for row in others)
    ends = sum(row.omega is not None and row.state != "periodic" for row in others)
    begin = f"{name}: the error of ω is {kurbel.omega:.0e} by kurbel"
    count = f"of {len(others)} runs by other methods {failed} fail and {ends} end without a periodic speed"
    best = min(
        (row for row in others if row.omega is not None),
        key=lambda row: row.omega or 0.0,
        default=None,
    )
    if best is None:
        return [f"{begin}; {count}."]
    nearest = f"{best.omega:.0e} by {best.method} ({best.points}) in {best.ratio:.2g} of its time"
    return [f"{begin}, and at least {nearest}; {count}."]


def _table(id: str, title: str, rows: Sequence[NamedTuple], heads: int) -> PlaceTable:
    """Return a table of records, whose first fields are the names of a row and whose others are its columns."""
    fields = rows[0]._fields if rows else ()
    columns: list[Column] = []
    for field, name in enumerate(fields):
        values = [row[field] for row in rows]
        has_values = any(value is not None for value in values)
        if field >= heads and has_values:
            unit = "ms" if name in ("median", "least", "time") else ""
            columns.append(Column(name, _SYMBOLS.get(name, name), name, unit, values, alone=2))
    names = tuple(tuple(map(str, row[:heads])) for row in rows)
    return PlaceTable(id, title, fields[:heads], names, tuple(columns), headed=True)


_SYMBOLS = {"omega": "ω", "delta": "δ", "omega_max": "ω_max", "M_K": "M_K"}
"""Symbols of columns of errors."""


def _everything(machine: Machine) -> None:
    """Compute all that `kurbel forces` prints: every column at 37 angles, and every key value."""
    report_of(Case(machine), Frame("forces", tuple(np.arange(0.0, 361.0, 10.0)), None, "si"))


def environment() -> str:
    """Return versions and processor, which the times belong to."""
    processor, cpuinfo = platform.processor() or "unknown processor", Path("/proc/cpuinfo")
    if cpuinfo.exists():
        lines = cpuinfo.read_text(encoding="utf-8", errors="replace").splitlines()
        processor = next(
            (line.partition(":")[2] for line in lines if line.startswith("model name")), processor
        )
    versions = [f"Python {platform.python_version()}"]
    for package in ("kurbel", "numpy", "mpmath"):
        with suppress(PackageNotFoundError):  # such as kurbel where it is run from its source
            versions.append(f"{package} {version(package)}")
    return f"{', '.join(versions)}; {platform.system()} {platform.machine()}, {' '.join(processor.split())}"


# stiff and extreme cases


def extremes_report(
    loads: MachineReader, compute: Callable[[Machine, str], float | None]
) -> tuple[Report, bool]:
    """Return the verdicts on all cases, the worst first, and whether every one is passed.

    compute: see `kurbel.accuracy.extremes.verdicts`.
    """
    judged = sorted(
        verdicts(all_cases(), compute, loads), key=lambda verdict: verdict.badness, reverse=True
    )
    passed = sum(verdict.passed for verdict in judged)
    listed = _table("extremes", f"{passed} of {len(judged)} cases passed", judged, 5)
    part = Part("stiff and extreme cases", (), place_tables=(listed,))
    report = Report(
        "Stiff and extreme cases", "accuracy", None, "scenes", (part,), head=(environment(),)
    )
    return report, passed == len(judged)


def answer(machine: Machine, asked: str) -> float | None:
    """Return what the program prints for `forces T_max` or `motion x@30`, in SI; None where it is left out.

    The machine goes the whole way to the report. Raises KurbelError as the program does.
    """
    command, _, quantity = asked.partition(" ")
    name, _, at = quantity.partition("@")
    report = report_of(Case(machine), Frame(command, (float(at or 0),), None, "si"))
    for part in report.all_parts:
        values = {column.id: column.values[0] for column in part.columns} if at else {}
        for key_value in part.key_values:
            if not isinstance(key_value.value, tuple):
                values.setdefault(key_value.id, key_value.value)
        if (value := values.get(name)) is not None:
            return value
    return None
