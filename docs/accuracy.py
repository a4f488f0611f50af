"""Write docs/accuracy.md and docs/accuracy.svg: a real run of `kurbel accuracy`, explained.

python docs/accuracy.py

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
from kurbel.tables.tables import Report

FOLDER = Path(__file__).parent
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


def explanation(report: Report) -> str:
    """Return which error an engineer should worry about."""
    engine = report._replace(parts=report.parts[:1])
    machine = first_machine()
    data = [data_error.error for data_error in data_errors(machine)]
    model, rough = (
        [model_error.error for model_error in model_errors(machine) if model_error.cause == cause]
        for cause in ("first-order formulas", "infinite rod")
    )
    hand = errors(engine, lambda names: names[1] in EQUIDISTANT and names[2] == "36")
    own = errors(engine, lambda names: names[1] == "kurbel")
    return f"""Which error matters? For the first built-in machine, a steam engine with L/R = 5:

| error | from | to |
| --- | --: | --: |
| of the data: 0.1° of dead centre, 0.5 % noise of the gas force | {power(min(data))} | {power(max(data))} |
| of the model: infinite rod | {power(min(rough))} | {power(max(rough))} |
| of the model: first-order formulas | {power(min(model))} | {power(max(model))} |
| of reading the diagrams every 10°, as tables by hand do | {power(min(hand))} | {power(max(hand))} |
| of the arithmetic: kurbel | {power(min(own))} | {power(max(own))} |

- **Data.** A dead centre that is found 0.1° too late, or half a percent of noise in the gas force, changes the answers
  by {power(min(data))} to {power(max(data))}. No formula corrects that: check dead centre and indicator first.
- **Model.** The infinite rod costs up to {max(rough):.0%}, the formulas of first order up to {power(max(model))}.
  With a computer there is no reason to use either.
- **Reading.** 18 divisions of the half turn, as the book has them, miss by up to {max(hand):.1%}: peaks and
  jumps between two divisions are missed.
- **Arithmetic.** The smallest error of the data is {power(min(data) / max(own))} times kurbel's largest here. Its
  largest error in all scenes is {worst(report)}. Differences from a measurement are not due to arithmetic.

What a machine does not need is not computed: {saved(engine)}.

The picture shows time over error of every quantity for all built-in machines; a line joins the results of one method
for one machine. The error falls to the right; the grey line is 2⁻⁵³, the rounding of one float. A method further right
*and* lower than the dot of the same machine would be better than kurbel's own; the last sentence of the report names
any. The best methods use kurbel's idea: cut the cycle at the corners of the cards, and between them use Gauss rules,
root searches or a fit of Chebyshev polynomials. The number of points that they need is not known beforehand; kurbel
determines it for each machine. References are textbook formulas in 40 digits of mpmath, with Gauss rules whose pieces
are halved until 25 digits agree. `benchmarks/speed_lines.py` and `benchmarks/flywheel.py` do the same for the speed of
the shaft, `benchmarks/model_and_data.py` the errors of data and model. `python docs/accuracy.py` writes this page."""


def main() -> None:
    """Write both files."""
    report = accuracy_report(None, False, loads)
    extremes, _ = extremes_report(loads, answer_of)
    draw_file([accuracy_picture(report)], Look(), str(FOLDER / PICTURE))
    engine = render(report._replace(parts=report.parts[:1]), Look(format="markdown"))
    text = "\n\n".join(
        (
            "# Accuracy and run time",
            explanation(report),
            f"![Time over error]({PICTURE})",
            engine.strip(),
            f"Stiff and extreme machines are run through the whole program, from the text of a file to the report: "
            f"{extremes.parts[0].place_tables[0].title}.",
        )
    )
    write_out((text, "\n"), str(FOLDER / "accuracy.md"))


if __name__ == "__main__":
    main()
