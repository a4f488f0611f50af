"""The picture of `kurbel accuracy`: time over error."""

from collections.abc import Iterator
from itertools import chain

import numpy as np

from kurbel.accuracy.trials import ROUNDING
from kurbel.errors import UsageError
from kurbel.pictures.picture import Axis, Curve, Panel, Picture, Words
from kurbel.report.accuracy import NUMERICAL, SPEED
from kurbel.tables.tables import Report

_LEAST = 1e-17
"""Errors below this, zero too, are drawn here."""


def accuracy_picture(report: Report) -> Picture:
    """Return a panel for each quantity of an accuracy report, and one for ω in each scene of the speed.

    A curve is one method, in the panel of a quantity in one scene. Raises UsageError where nothing was compared.
    """
    methods: dict[str, int] = {}
    curves: dict[str, list[Curve]] = {}
    for title, method, errors, times in _dots(report):
        look = methods.setdefault(method, len(methods))
        curves.setdefault(title, []).append(
            Curve(Words(method), np.array(errors), np.array(times), "dots", look)
        )
    if not curves:
        raise UsageError("--plot: nothing was compared, there is nothing to draw")

    # all panels have the same axes
    all_curves = chain.from_iterable(curves.values())
    all_times = np.concatenate([curve.y for curve in all_curves])
    low = all_times.min()
    high = all_times.max()
    rounding = Curve(Words(""), np.array([ROUNDING] * 2), np.array([low, high]), "faint")
    x = Axis(Words("error"), log=True, low=_LEAST, high=1.0, falling=True)
    y = Axis(Words("time"), unit="ms", log=True, low=low, high=high)
    panels = [Panel(x, y, (rounding, *drawn), title=title) for title, drawn in curves.items()]
    return Picture(
        "accuracy",
        "time over error",
        "Time over relative error, lines between the answers of one method for one machine; the error falls to the "
        "right, the thin upright line is the rounding of one float. Runs that fail are not drawn; the titles count "
        "them.",
        tuple(panels),
        report.title,
        across=min(4, len(curves)),
        legend=tuple((Words(method), look) for method, look in methods.items()),
    )


def _dots(report: Report) -> Iterator[tuple[str, str, list[float], list[float]]]:
    """Yield title of the panel, method, errors and times of each curve."""
    for part in report.parts:
        for compared in part.place_tables:
            if compared.id not in (NUMERICAL, SPEED):
                continue
            columns = {column.id: column.values for column in compared.columns}
            is_speed = compared.id == SPEED
            errors = columns["omega" if is_speed else "error"]
            failed = sum(error is None for error in errors)
            of_speed = f"ω, {part.name}" + (f"; {failed} fail" if failed else "")

            dots: dict[tuple[str, str], list[tuple[float, float]]] = {}
            for names, error, time in zip(compared.names, errors, columns["median"]):
                title, method = (of_speed, names[0]) if is_speed else names[:2]
                if error is not None and time is not None:
                    dots.setdefault((title, method), []).append((max(error, _LEAST), time))
            for (title, method), points in dots.items():
                yield title, method, [error for error, _ in points], [time for _, time in points]
