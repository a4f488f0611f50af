"""The picture of `kurbel accuracy`: time over error."""

from itertools import groupby

import numpy as np

from kurbel.errors import UsageError
from kurbel.pictures.picture import Axis, Curve, Panel, Picture, Words
from kurbel.report.accuracy import NUMERICAL
from kurbel.tables.tables import Report

_LEAST = 1e-17
"""Errors below this, zero too, are drawn here."""


def accuracy_picture(report: Report) -> Picture:
    """Return a panel for each quantity of an accuracy report, with a curve for each method and scene.

    Raises UsageError where nothing was compared.
    """
    curves: dict[str, list[Curve]] = {}
    methods: list[str] = []
    for one in (one for part in report.parts for one in part.place_tables if one.id == NUMERICAL):
        columns = {column.id: column.values for column in one.columns}
        rows = zip(one.names, columns["error"], columns["median"])
        found = ((names[:2], max(error, _LEAST), time) for names, error, time in rows if error is not None)
        for (quantity, method), dots in groupby(found, key=lambda row: row[0]):
            if method not in methods:
                methods.append(method)
            _, errors, times = map(np.array, zip(*dots))
            curves.setdefault(quantity, []).append(Curve(Words(method), errors, times, "dots", methods.index(method)))
    if not curves:
        raise UsageError("--plot: nothing was compared, there is nothing to draw")

    every = np.concatenate([one.y for of_quantity in curves.values() for one in of_quantity])
    low, high = every.min(), every.max()
    rounding = Curve(Words(""), np.array([2.0**-53, 2.0**-53]), np.array([low, high]), "faint")
    x = Axis(Words("error"), log=True, low=_LEAST, high=1.0, falling=True)
    y = Axis(Words("time"), unit="ms", log=True, low=low, high=high)
    panels = [Panel(x, y, (rounding, *drawn), title=quantity) for quantity, drawn in curves.items()]
    return Picture(
        "accuracy",
        "time over error",
        "Time over relative error of each method, lines between its answers for one machine; the error falls to the "
        "right, the thin upright line is the rounding of one float.",
        tuple(panels),
        report.title,
        across=min(4, len(curves)),
        legend=tuple((Words(method), number) for number, method in enumerate(methods)),
    )
