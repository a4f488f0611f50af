"""The reports of `kurbel accuracy`: error against run time, and the verdicts on stiff and extreme cases."""

import platform
from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np

from kurbel.accuracy.extremes import all_cases
from kurbel.accuracy.inexact import Difference, data_errors, model_errors
from kurbel.accuracy.leaving_out import Saving, savings
from kurbel.accuracy.scenes import Loads, Scene, built_in
from kurbel.accuracy.timing import Patience
from kurbel.accuracy.trials import Lacking, Row, dominating, examined
from kurbel.machine import Machine
from kurbel.report.commands import report_of
from kurbel.report.frame import Frame, provenance
from kurbel.report.tables import Column, LeftOut, Part, PlaceTable, Report, Value
from kurbel.solver.case import Case

NUMERICAL = "numerical_error"
"""Id of the table that the picture is drawn from."""


class Measured(NamedTuple):
    """All that was found out about one scene."""

    name: str
    rows: tuple[Row, ...]
    lacking: tuple[Lacking, ...]
    model: tuple[Difference, ...]
    data: tuple[Difference, ...]
    savings: tuple[Saving, ...]


def accuracy_report(machine: Machine | None, quick: bool, loads: Loads, uncertain: Sequence[Difference] = ()) -> Report:
    """Return error against run time for a machine, or for the built-in scenes; quick: fewer scenes and points.

    uncertain: what the uncertainties of the machine's data make of its quantities.
    """
    scenes = built_in(quick, loads) if machine is None else [Scene(machine)]
    with np.errstate(all="ignore"):
        found = [_measured(scene, quick, uncertain) for scene in scenes]
    name = "built-in scenes" if machine is None else machine.name
    parts = tuple(
        Part(one.name, (), left_out=tuple(LeftOut(*lack) for lack in one.lacking), place_tables=tuple(_tables(one)))
        for one in found
    )
    named = None if machine is None else machine.name
    head = (environment(), "Times are of this machine and this run; compare them only with one another.")
    title = f"{name}. Genauigkeit und Rechenzeit"
    report = Report(title, "accuracy", named, "scenes", parts, notes=(*_NOTES, *_edge(found)), head=head)
    return report if machine is None else report._replace(provenance=provenance(machine))


def _measured(scene: Scene, quick: bool, uncertain: Sequence[Difference]) -> Measured:
    rows, lacking = examined(scene, quick)
    machine = scene.machine
    worth = bool(machine.cylinders) and any(one.masses or one.pistons for one in machine.cylinders)
    return Measured(
        machine.name,
        tuple(rows),
        tuple(lacking),
        tuple(model_errors(machine)),
        (*data_errors(machine), *uncertain),
        tuple(savings(machine, everything, Patience.of(quick))) if worth else (),
    )


def everything(case: Case) -> None:
    """Ask a case for all that `kurbel forces` prints: every column at 37 angles, and every key value."""
    from kurbel.report.crank import forces_subjects

    for subject in forces_subjects(case):
        assert subject.at
        state = subject.at(np.arange(0.0, 361.0, 10.0))
        for id in subject.lists.columns("forces"):
            _ = state[id]
        for _ in subject.key_values("forces"):
            pass


_NOTES = (
    "Error: the largest relative error against a reference of 40 digits by another method; where the exact value is "
    "zero, relative to the largest value. Of model and data it is the largest difference over the cycle, relative to "
    "the largest value. ulp: the same in units of the last place, below 1e-12.",
    "Ratio: median time over that of kurbel's own method. Evaluations: crank angles at which the motion was computed.",
    "Points: divisions of a turn, or a tolerance. A march counts as periodic when all further cycles would "
    "change the speed by less than 1e-9 of its swing, or its tolerance; it is given up after 12 (quick: 4) cycles.",
)


def _edge(found: Sequence[Measured]) -> Iterator[str]:
    """Yield what is both more exact and faster than kurbel's own method, or that nothing is."""
    beaten = [
        f"{one.name}, {row.quantity}: {row.method} ({row.points}) is both more exact and faster than kurbel's own"
        for one in found
        for quantity in dict.fromkeys(row.quantity for row in one.rows)
        for row in dominating([row for row in one.rows if row.quantity == quantity])
    ]
    yield from beaten
    if not beaten and any(one.rows for one in found):
        yield "No method listed is both more exact and faster than kurbel's own, beyond noise (20 % of time, 16 u)."


_TABLES = (
    (
        *(NUMERICAL, "numerical error", "rows", ("quantity", "method", "points", "state")),
        ("evaluations", "error", "ulp", "median", "least", "ratio"),
    ),
    ("model_error", "error of the model", "model", ("quantity", "cause"), ("error",)),
    ("data_error", "error of the data", "data", ("quantity", "cause"), ("error",)),
    ("leaving_out", "what leaving out saves", "savings", ("machine",), ("stages", "median", "least", "ratio")),
)
"""Id and title of a table, what of a scene it tells, and the fields of that which are its names and its columns."""


def _tables(one: Measured) -> Iterator[PlaceTable]:
    for id, title, told, heads, columns in _TABLES:
        if found := getattr(one, told):
            names = tuple(tuple(getattr(each, head) for head in heads) for each in found)
            shown = tuple(_column(name, [getattr(each, name) for each in found]) for name in columns)
            yield PlaceTable(id, f"{one.name}: {title}", heads, names, shown, True)


def _column(id: str, values: Sequence[Value]) -> Column:
    if id in ("median", "least"):  # times in s
        return Column(id, id, id, "ms", tuple(value and value * 1e3 for value in values), alone=2)
    return Column(id, id, id, "", tuple(values), alone=2)


def environment() -> str:
    """Return versions and processor, which the times belong to."""
    from importlib.metadata import PackageNotFoundError, version

    def named(package: str) -> str:
        try:
            return f"{package} {version(package)}"
        except PackageNotFoundError:
            return f"{package} not installed"

    packages = [named("kurbel"), f"Python {platform.python_version()}", named("numpy"), named("scipy")]
    return f"{', '.join(packages)}; {platform.system()} {platform.machine()}, {_processor()}"


def _processor() -> str:
    try:
        with open("/proc/cpuinfo", encoding="utf-8", errors="replace") as file:
            names = [line.partition(":")[2].strip() for line in file if line.startswith("model name")]
    except OSError:
        names = []
    return " ".join((names[0] if names else platform.processor() or "unknown processor").split())


# stiff and extreme cases


def extremes_report(loads: Loads) -> tuple[Report, bool]:
    """Return the verdicts on all cases, and whether every one is passed."""
    from kurbel.accuracy.extremes.judge import verdicts as judge

    def ask(text: str, asked: str) -> float | None:
        return answer(loads(text), asked)

    verdicts = list(judge(all_cases(), ask, loads))
    passed = sum(verdict.passed for verdict in verdicts)
    names = tuple(
        (v.case.name, v.case.asked, v.expected, v.observed, "passed" if v.passed else "FAILED") for v in verdicts
    )
    columns = (
        _column("ulp", [verdict.ulp for verdict in verdicts]),
        _column("allowed", [None if v.ulp is None else v.case.ulp for v in verdicts]),
    )
    heads = ("case", "asked", "expected", "observed", "verdict")
    table = PlaceTable("extremes", f"{passed} of {len(verdicts)} cases passed", heads, names, columns, True)
    part = Part("stiff and extreme cases", (), place_tables=(table,))
    title = "Stiff and extreme cases. Grenzfälle"
    return Report(title, "accuracy", None, "scenes", (part,), head=(environment(),)), passed == len(verdicts)


def answer(machine: Machine, asked: str) -> float | None:
    """Return what the program prints for `forces T_max` or `motion x@30`, in SI; None where it is left out.

    The machine goes the whole way to the report. Raises KurbelError as the program does.
    """
    command, _, quantity = asked.partition(" ")
    name, _, at = quantity.partition("@")
    report = report_of(Case(machine), Frame(command, (float(at or 0),), None, "si"))
    parts = [part for part in (report.whole, *report.parts) if part]
    found: Iterator[Any] = (one.value for part in parts for one in part.key_values if one.id == name)
    if at:
        found = (column.values[0] for part in parts for column in part.columns if column.id == name)
    value = next(found, None)
    return None if value is None else float(value)
