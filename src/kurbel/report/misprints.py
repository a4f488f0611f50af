"""The printed figures of Zusammenstellung 112 beside the computed ones, and what is misprinted there."""

from __future__ import annotations

from collections.abc import Iterator

from kurbel.errors import UsageError
from kurbel.report.printed_112 import HALF_UNIT, PRINTED, STEP
from kurbel.report.tables import Column, Part, Report


def compared(report: Report, formula: str) -> Report:
    """Return the table with the printed figures below the computed ones, those that rounding cannot explain marked.

    Raises UsageError where the book prints no such table.
    """
    _check(report, formula)
    parts = tuple(part._replace(columns=tuple(_with_printed(part))) for part in report.parts)
    misprints = [text for part in parts for text in _misprints(part)]
    head = "* misprint: off the book's own formula by more than half a unit of the last decimal; blank: illegible."
    return report._replace(parts=parts, notes=(head, *misprints))


def _check(report: Report, formula: str) -> None:
    part = report.parts[0]
    angles = part.columns[0].values
    wrong = [
        *(f"L/R = {one.name:g}" for one in report.parts if one.name not in PRINTED["velocity_factor"]),
        *(f"the row {column.id}" for column in part.columns[1:] if column.id not in PRINTED),
        *([] if formula == "book" else [f"--formula {formula}"]),
        *([] if list(angles) == list(range(0, 181, STEP)) else ["other angles"]),
    ]
    if wrong:
        raise UsageError(
            f"--compare: the book prints nothing for {', '.join(wrong)}; "
            "only b and c by --formula book, for L/R = 5, 4.5 and 4, every 10 degrees"
        )


def _with_printed(part: Part) -> Iterator[Column]:
    phi, *rows = part.columns
    yield phi
    for row in rows:
        printed = PRINTED[row.id][float(part.name)]
        marked = tuple(
            index for index, (value, figure) in enumerate(zip(row.values, printed)) if _is_misprint(value, figure)
        )
        yield row
        yield Column(f"{row.id}_printed", "  printed", "  printed", "", printed, f"{row.text}, as printed", 3, marked)


def _is_misprint(value: float | None, figure: float | None) -> bool:
    # the small margin keeps a figure that rounds a tie the other way
    return value is not None and figure is not None and abs(value - figure) > HALF_UNIT * (1 + 1e-9)


def _misprints(part: Part) -> Iterator[str]:
    phi = part.columns[0].values
    for row, printed in zip(part.columns[1::2], part.columns[2::2]):
        for index in printed.marked:
            value, figure = row.values[index], printed.values[index]
            yield f"L/R = {part.name:g}, φ = {phi[index]:g}°: {row.symbol} is {value:.3f}, printed {figure:.3f}"
