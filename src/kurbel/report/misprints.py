"""The printed figures of Zusammenstellung 112 beside the computed ones, and what is misprinted there.

F. Rötscher, Die Maschinenelemente (1927), p. 602 f., read from the scan. None where it is illegible: 70° and 80° lie
in the fold between the two pages.
"""

from collections.abc import Iterator

from kurbel.errors import UsageError
from kurbel.report.tables import Column, Part, Report

__ = None  # illegible

_STEP = 10
_ACCELERATION = {
    5: (1.200, 1.173, 1.093, 0.966, 0.801, 0.608, 0.400, __, __, -0.200,
        -0.362, -0.495, -0.600, -0.678, -0.731, -0.766, -0.785, -0.796, -0.800),
    4.5: (1.222, 1.194, 1.110, 0.977, 0.805, 0.604, __, __, __, -0.222,
          -0.382, -0.512, -0.611, -0.681, -0.727, -0.755, -0.769, -0.776, -0.778),
    4: (1.250, 1.220, 1.131, 0.981, 0.809, 0.599, __, __, __, -0.250,
        -0.409, -0.534, -0.625, -0.686, -0.723, -0.741, -0.748, -0.750, -0.750),
}  # fmt: skip
"""L/R -> cos φ + R/L cos 2φ as printed, for φ = 0, 10, … 180°."""

_VELOCITY = {
    5: (0.0, 0.206, 0.405, 0.585, 0.740, 0.865, 0.953, __, __, 1.000,
        0.950, 0.874, 0.779, 0.666, 0.542, 0.413, 0.278, 0.139, 0.0),
    4.5: (0.0, 0.212, 0.413, 0.597, 0.753, 0.877, __, __, __, 1.000,
          0.946, 0.867, 0.768, 0.655, 0.532, 0.403, 0.271, 0.136, 0.0),
    4: (0.0, 0.216, 0.423, 0.609, 0.768, 0.891, __, __, __, 1.000,
        0.941, 0.857, 0.755, 0.641, 0.518, 0.391, 0.261, 0.131, 0.0),
}  # fmt: skip
"""L/R -> sin(φ+ψ)/cos ψ as printed."""

_PRINTED = {"acceleration_factor": _ACCELERATION, "velocity_factor": _VELOCITY}
"""Row id -> L/R -> figures."""

_HALF_UNIT = 0.0005
"""Half a unit of the last printed decimal: what rounding may differ by."""


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
        *(f"L/R = {one.name:g}" for one in report.parts if one.name not in _PRINTED["velocity_factor"]),
        *(f"the row {column.id}" for column in part.columns[1:] if column.id not in _PRINTED),
        *([] if formula == "book" else [f"--formula {formula}"]),
        *([] if list(angles) == list(range(0, 181, _STEP)) else ["other angles"]),
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
        printed = _PRINTED[row.id][float(part.name)]
        marked = tuple(
            index for index, (value, figure) in enumerate(zip(row.values, printed)) if _is_misprint(value, figure)
        )
        yield row
        yield Column(f"{row.id}_printed", "  printed", "  printed", "", printed, f"{row.text}, as printed", 3, marked)


def _is_misprint(value: float | None, figure: float | None) -> bool:
    # the small margin keeps a figure that rounds a tie the other way
    return value is not None and figure is not None and abs(value - figure) > _HALF_UNIT * (1 + 1e-9)


def _misprints(part: Part) -> Iterator[str]:
    phi = part.columns[0].values
    for row, printed in zip(part.columns[1::2], part.columns[2::2]):
        for index in printed.marked:
            value, figure = row.values[index], printed.values[index]
            yield f"L/R = {part.name:g}, φ = {phi[index]:g}°: {row.symbol} is {value:.3f}, printed {figure:.3f}"
