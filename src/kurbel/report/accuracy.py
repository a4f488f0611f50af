"""The reports of `kurbel accuracy`: error against run time, and the verdicts on stiff and extreme cases."""

import platform
from collections.abc import Callable, Sequence
from contextlib import suppress
from functools import partial
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path
from typing import NamedTuple

import numpy as np

from kurbel.accuracy import trials
from kurbel.accuracy.extremes import all_cases, table, verdicts
from kurbel.machine import Machine
from kurbel.report.commands import report_of
from kurbel.solver.case import Case
from kurbel.tables.frame import Frame, provenance
from kurbel.tables.tables import Column, LeftOut, Part, PlaceTable, Report

Loads = Callable[[str], Machine]
"""Reads the text of a machine file; passed in by the command line, since reports do not import the reader."""
Progress = Callable[[str, float], None]
"""Called with what is computed, and the completed share."""
NUMERICAL = "numerical_error"
"""Id of the table that the picture is drawn from."""
_NOTES = (
    "Error: the largest relative error against a reference of 40 digits by another method; where the exact value is "
    "zero, relative to the largest value. ulp: the same in units of the last place, below 1e-12.",
    "Ratio: median time over that of kurbel's own method, or of the whole machine. Points: divisions of a turn, or "
    "points on each piece between corners, which the methods between corners are given. Evaluations: crank angles of "
    "which the motion is computed. Stages: functions of the solver that run for all that `kurbel forces` prints.",
)


def accuracy_report(machine: Machine | None, quick: bool, loads: Loads, progress: Progress | None = None) -> Report:
    """Return error against run time for a machine, or for the built-in scenes; quick: fewer scenes and repeats.

    progress: called with the name of each scene and the share of them that is done. A line of `scenes.tsv` is a scene:
    `quick` if it is also in the quick run, from which turn on its motion is compared (-1 if an earlier one has done
    so), and the text of its machine file.
    """
    built_in = [] if machine else [line for line in table("scenes.tsv") if line[0] or not quick]
    scenes = [(machine, 0)] if machine else [(loads(text), int(turns)) for _, turns, text in built_in]
    parts: list[Part] = []
    found: list[str] = []
    for number, (one, turns) in enumerate(scenes):
        if progress:
            progress(one.name, number / len(scenes))
        degrees = 360.0 * turns + np.arange(361.0 if turns >= 0 else 0.0)
        with np.errstate(all="ignore"):
            rows, left_out = trials.examined(one, degrees, quick)
        heavy = any(cylinder.masses or cylinder.pistons for cylinder in one.cylinders)
        saved = [*trials.savings(one, _everything, quick)] if heavy else []
        tables = (
            _table(NUMERICAL, f"{one.name}: numerical error", rows, 4),
            _table("leaving_out", f"{one.name}: what leaving out saves", saved, 1),
        )
        lacking = tuple(LeftOut(", ".join(quantities), why) for why, quantities in left_out.items())
        parts.append(Part(one.name, (), left_out=lacking, place_tables=tuple(t for t in tables if t.names)))
        found += [
            f"{one.name}, {row.quantity}: {row.method} ({row.points}) is more exact and faster than kurbel's own"
            for row in trials.better(rows)
        ]
    if not found and parts[0].place_tables:
        found = ["No method listed is both more exact and faster than kurbel's own, beyond noise (20 %, 16 u)."]
    return Report(
        f"{machine.name if machine else 'built-in scenes'}. Accuracy and run time",
        "accuracy",
        machine.name if machine else None,
        "scenes",
        tuple(parts),
        notes=(*_NOTES, *found),
        head=(environment(), "Times are of this machine and this run; compare them only with one another."),
        provenance=partial(provenance, machine) if machine else None,
    )


def _table(id: str, title: str, rows: Sequence[NamedTuple], heads: int) -> PlaceTable:
    """Return a table of records, whose first fields are the names of a row and whose others are its columns."""
    fields = rows[0]._fields if rows else ()
    columns = [
        Column(name, name, name, "ms" if name in ("median", "least") else "", [row[place] for row in rows], alone=2)
        for place, name in enumerate(fields)
    ]
    names = tuple(tuple(map(str, row[:heads])) for row in rows)
    return PlaceTable(id, title, fields[:heads], names, tuple(columns[heads:]), headed=True)


def _everything(machine: Machine) -> None:
    """Compute all that `kurbel forces` prints: every column at 37 angles, and every key value."""
    report_of(Case(machine), Frame("forces", tuple(np.arange(0.0, 361.0, 10.0)), None, "si"))


def environment() -> str:
    """Return versions and processor, which the times belong to."""
    processor, cpuinfo = platform.processor() or "unknown processor", Path("/proc/cpuinfo")
    if cpuinfo.exists():
        lines = cpuinfo.read_text(encoding="utf-8", errors="replace").splitlines()
        processor = next((line.partition(":")[2] for line in lines if line.startswith("model name")), processor)
    versions = [f"Python {platform.python_version()}"]
    for package in ("kurbel", "numpy", "mpmath"):
        with suppress(PackageNotFoundError):  # such as kurbel where it is run from its source
            versions.append(f"{package} {version(package)}")
    return f"{', '.join(versions)}; {platform.system()} {platform.machine()}, {' '.join(processor.split())}"


# stiff and extreme cases


def extremes_report(loads: Loads) -> tuple[Report, bool]:
    """Return the verdicts on all cases, and whether every one is passed."""
    found = list(verdicts(all_cases(), answer, loads))
    passed = sum(one.passed for one in found)
    judged = _table("extremes", f"{passed} of {len(found)} cases passed", found, 5)
    part = Part("stiff and extreme cases", (), place_tables=(judged,))
    report = Report("Stiff and extreme cases", "accuracy", None, "scenes", (part,), head=(environment(),))
    return report, passed == len(found)


def answer(machine: Machine, asked: str) -> float | None:
    """Return what the program prints for `forces T_max` or `motion x@30`, in SI; None where it is left out.

    The machine goes the whole way to the report. Raises KurbelError as the program does.
    """
    command, _, quantity = asked.partition(" ")
    name, _, at = quantity.partition("@")
    report = report_of(Case(machine), Frame(command, (float(at or 0),), None, "si"))
    for part in report.all_parts:
        values = {column.id: column.values[0] for column in part.columns} if at else {}
        for one in part.key_values:
            if not isinstance(one.value, tuple):
                values.setdefault(one.id, one.value)
        if (value := values.get(name)) is not None:
            return value
    return None
