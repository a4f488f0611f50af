"""Write docs/accuracy.md and docs/accuracy.svg: a real run of `kurbel accuracy`, explained.

python tools/accuracy.py

The numbers in the explanation are read from the run; times belong to the machine that the page names.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent.parent / "benchmarks"))

from model_and_data import data_errors, first_machine, model_errors

from kurbel.cli.comparing import answer_of
from kurbel.machine_file import loads
from kurbel.pictures.accuracy import accuracy_picture
from kurbel.render import Look
from kurbel.render.drawing import draw_file
from kurbel.render.formats import render
from kurbel.render.output import write_out
from kurbel.report.accuracy import accuracy_report, extremes_report
from kurbel.tables.tables import PlaceTable, Report

FOLDER = Path(__file__).parent.parent / "docs"
PICTURE = "accuracy.svg"
EQUIDISTANT = ("trapezium rule", "largest ordinate")


def errors(report: Report, wanted: Callable[[tuple[str, ...]], bool]) -> list[float]:
    """Return the numerical errors of the rows of all scenes whose names are wanted."""
    return [
        error
        for part in report.parts
        for table in part.place_tables
        if table.id == "numerical_error"
        for names, error in zip(
            table.names, next(c for c in table.columns if c.id == "error").values
        )
        if error and wanted(names)
    ]


def power(value: float) -> str:
    """Write a number with one digit, as 4e-04."""
    return f"{value:.0e}"


def worst(report: Report) -> str:
    """Return error, quantity and scene of kurbel's own worst answer."""
    found = [
        (error, names[0], part.name)
        for part in report.parts
        for table in part.place_tables
        if table.id == "numerical_error"
        for names, error in zip(
            table.names, next(c for c in table.columns if c.id == "error").values
        )
        if names[1] == "kurbel" and error is not None
    ]
    error, quantity, scene = max(found)
    return f"{power(error)} ({quantity}, {scene})"


def saved(report: Report) -> str:
    """Return how many functions of the solver run for the whole machine and for its motion alone, and for how long."""
    table = next(table for table in report.parts[0].place_tables if table.id == "leaving_out")
    stages, times = (
        next(c.values for c in table.columns if c.id == id) for id in ("stages", "least")
    )
    (whole, _), *_, (motion, _), (positions, _) = each = list(zip(stages, times))
    spans = " and ".join(f"{each[place][1]:.2g} ms" for place in (0, -2))
    return f"""all results of the whole machine need {whole} functions
of the solver, its motion alone {motion}, positions alone {positions}; the first two take {spans}"""


def speed_table(report: Report) -> str:
    """Return a table of the stiff scenes: kurbel, and the most exact run of the others."""
    lines = [
        "| scene | kurbel: ω | δ | the most exact other run | ω | δ | its time | fail |",
        "| --- | --: | --: | --- | --: | --: | --: | --: |",
    ]
    for part in report.parts:
        for table in part.place_tables:
            if table.id == "speed_error":
                lines.append(speed_line(part.name, table))
    return "\n".join(lines)


def speed_line(scene: str, table: PlaceTable) -> str:
    """Return the line of a scene."""
    columns = {column.id: column.values for column in table.columns}
    rows = list(zip(table.names, columns["omega"], columns["delta"], columns["ratio"]))
    _, omega, delta, _ = rows[0]
    others = [row for row in rows if not row[0][0].startswith("kurbel")]
    names, other_omega, other_delta, ratio = min(
        (row for row in others if row[1]), key=lambda row: row[1]
    )
    failed = sum(row[1] is None for row in others)
    run = f"{names[0]} {names[1]}" + ("" if names[2] == "periodic" else f", {names[2]}")
    shown = [
        power(omega),
        power(delta),
        run,
        power(other_omega),
        power(other_delta),
        f"× {ratio:.2g}",
    ]
    return f"| {scene} | {' | '.join(shown)} | {failed} of {len(others)} |"


def explanation(report: Report, extremes: Report) -> str:
    """Return the page up to the picture: how exact, what it costs, what else could be used, where it ends."""
    engine = report._replace(parts=report.parts[:1])
    machine = first_machine()
    data = [data_error.error for data_error in data_errors(machine)]
    model, rough = (
        [model_error.error for model_error in model_errors(machine) if model_error.cause == cause]
        for cause in ("first-order formulas", "infinite rod")
    )
    hand = errors(engine, lambda names: names[1] in EQUIDISTANT and names[2] == "36")
    own = errors(engine, lambda names: names[1] == "kurbel")
    sentences = "\n".join(
        f"- {note}" for note in report.notes if note.startswith(engine.parts[0].name)
    )
    (judged,) = extremes.parts[0].place_tables
    return f"""## How exact

For the first built-in machine, a steam engine with L/R = 5:

| relative error | from | to |
| --- | --: | --: |
| of the data: 0.1° of dead centre, 0.5 % noise of the gas force | {power(min(data))} | {power(max(data))} |
| of the model: infinite rod | {power(min(rough))} | {power(max(rough))} |
| of the model: first-order formulas | {power(min(model))} | {power(max(model))} |
| of reading the diagrams every 10°, as tables by hand do | {power(min(hand))} | {power(max(hand))} |
| of the arithmetic: kurbel | {power(min(own))} | {power(max(own))} |

The smallest error of the data is {power(min(data) / max(own))} times the largest of the arithmetic: a difference from a
measurement comes from dead centre, indicator or model. The largest error in all scenes of motion, forces and energy is
{worst(report)}. References are the formulas of the textbooks in 40 digits of mpmath, integrated
between the corners of the cards by Gauss's rule, whose pieces are halved until 15 digits agree; the halves then have 30.

## What it costs

What a machine does not need is not computed: {saved(engine)}.

## What else you could use

{sentences}

A spreadsheet with 36 or 360 rows has the trapezium rule or the largest ordinate of as many divisions. The corners are
where the cards bend or jump and where friction changes its sign: whoever knows them, and how many points a piece needs,
has all digits with Gauss's rule as well. The tables below have every method.

## Where the speed is stiff

The speed of the shaft follows the load within an angle that falls with the slip, and needs thousands of cycles with a
heavy flywheel. Errors are relative to a collocation in 40 digits; other methods are Runge and Kutta's with fixed steps
(RK4) and scipy's RK45, DOP853, Radau and LSODA, marched for 20 cycles at most or by shooting, that is by Newton's
method for a cycle that repeats. They are given the torque, and no corners. The last column counts those that blow up or
need more than 12 000 evaluations (Radau, whose are dearer, 4000); times are relative to kurbel's, which computes the torque, too.

{speed_table(report)}

## Where it ends

Stiff and extreme machines go through the whole program, from the text of a file to the report (`kurbel accuracy
--extremes`): {judged.title}. What is beyond floats, locks, stalls or does not repeat is refused with a message.
Some bounds are wide, because the value depends on the input so much: a volumetric efficiency of 1e-7, a coupling at
order 99 of the torque with nothing to damp it, a crosshead just before it locks.

Journals in the bearings of a crankshaft, since each bearing load follows from all cylinders together; an effort of which only
the swing of energy is given, which has no torque; traces of more than 400 samples, and the work of one at equal angles, which
is a sum over its samples: these have no second calculation in this command, and it says so. All else is compared with free
bodies of every member: a rod as a rigid body, a link rod with the big end that carries it, friction in pins, yokes and rings,
other mechanisms by where their joints are, events of a slide valve by searching, a trace as straight lines between its samples.

`python tools/accuracy.py` writes this page, `benchmarks/stiff_scenes.py` the references of the stiff scenes,
`benchmarks/model_and_data.py` has the errors of data and model.

The picture shows time over error; a line joins the results of one method for one machine. The error falls to the right;
the grey line is 2⁻⁵³, the rounding of one float. A method further right *and* lower than kurbel's dot of the same
machine is better."""


def main() -> None:
    """Write both files."""
    report = accuracy_report(None, False, loads)
    extremes, _ = extremes_report(loads, answer_of)
    draw_file([accuracy_picture(report)], Look(), str(FOLDER / PICTURE))
    stiff = next(number for number, part in enumerate(report.parts) if part.name == "Slip 1e-3")
    shown = report._replace(parts=(report.parts[0], report.parts[stiff]))
    tables = render(shown, Look(format="markdown"))
    text = "\n\n".join(
        (
            "# Accuracy and run time",
            explanation(report, extremes),
            f"![Time over error]({PICTURE})",
            tables.strip(),
        )
    )
    write_out((text, "\n"), str(FOLDER / "accuracy.md"))


if __name__ == "__main__":
    main()
