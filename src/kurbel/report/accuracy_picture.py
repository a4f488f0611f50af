"""The work-precision picture of `kurbel accuracy`: time over error, one panel for each quantity."""

import numpy as np

from kurbel.errors import UsageError
from kurbel.report.picture import Axis, Curve, Panel, Picture, Words
from kurbel.report.tables import Report

_TABLE = "numerical_error"
_LEAST = 1e-17
"""Errors below this, zero too, are drawn here."""
_ROUNDING = 2.0**-53

Dots = dict[str, dict[str, list[list[tuple[float, float]]]]]
"""Quantity -> method -> errors and times in ms, a list for each scene."""


def accuracy_picture(report: Report) -> Picture:
    """Return a panel for each quantity of an accuracy report, with all its scenes.

    Raises UsageError where nothing was compared.
    """
    found = dots(report)
    if not found:
        raise UsageError("--plot: nothing was compared, there is nothing to draw")
    methods = list(dict.fromkeys(method for every in found.values() for method in every))
    times = [time for of in found.values() for scenes in of.values() for scene in scenes for _, time in scene]
    span = min(times), max(times)
    return Picture(
        "accuracy",
        "time over error",
        "Time over relative error of each method, lines between its answers for one machine; the error falls to the "
        "right, the thin upright line is the rounding of one float.",
        tuple(_panel(quantity, scenes, methods, span) for quantity, scenes in found.items()),
        report.title,
        across=min(4, len(found)),
        legend=tuple((Words(method), number) for number, method in enumerate(methods)),
    )


def dots(report: Report) -> Dots:
    """Return what is drawn of each quantity; methods without an answer have no dots."""
    found: Dots = {}
    for table in (table for part in report.parts for table in part.place_tables if table.id == _TABLE):
        columns = {column.id: column.values for column in table.columns}
        scene: dict[tuple[str, str], list[tuple[float, float]]] = {}
        for (quantity, method, _, state), error, time in zip(table.names, columns["error"], columns["median"]):
            if error is not None and time is not None and state == "ok":
                scene.setdefault((quantity, method.split(",")[0]), []).append((max(error, _LEAST), time))
        for (quantity, method), answers in scene.items():
            found.setdefault(quantity, {}).setdefault(method, []).append(answers)
    return found


def _panel(
    quantity: str,
    found: dict[str, list[list[tuple[float, float]]]],
    methods: list[str],
    span: tuple[float, float],
) -> Panel:
    curves = []
    for method, scenes in found.items():
        # a gap between scenes
        answers = np.array([one for scene in scenes for one in (*scene, (np.nan, np.nan))])[:-1]
        curves.append(Curve(Words(method), answers[:, 0], answers[:, 1], "dots", methods.index(method)))
    rounding = Curve(Words(""), np.array([_ROUNDING, _ROUNDING]), np.array(span), "faint")
    x = Axis(Words("error"), log=True, low=_LEAST, high=1.0, falling=True)
    return Panel(
        x, Axis(Words("time"), unit="ms", log=True, low=span[0], high=span[1]), (rounding, *curves), title=quantity
    )
