"""The work-precision picture of `kurbel accuracy`: time over error, one line for each method."""

from __future__ import annotations

import os
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, NamedTuple

from kurbel.errors import UsageError
from kurbel.render.output import replaced

if TYPE_CHECKING:
    from kurbel.report.tables import Part, PlaceTable, Report

SUFFIXES = (".svg", ".png")
_TABLE = "numerical_error"
_OWN = "kurbel"
_LEAST = 1e-17
"""Errors below this, zero too, are drawn here."""
_ROUNDING = 2.0**-53


def check_plot(file_name: str) -> None:
    """Raise UsageError where a picture cannot be drawn to this file, before anything is measured."""
    suffix = os.path.splitext(file_name)[1].lower()
    if suffix not in SUFFIXES:
        raise UsageError(f"--plot {file_name}: the name of a picture ends in {' or '.join(SUFFIXES)}")
    from importlib.util import find_spec

    if find_spec("matplotlib") is None:
        raise UsageError("--plot needs matplotlib, which is not installed: pip install 'kurbel[plot]'")


class Curve(NamedTuple):
    """The points of one method in one panel: errors, times in ms."""

    method: str
    errors: tuple[float, ...]
    times: tuple[float, ...]


def curves(table: PlaceTable, quantity: str) -> Iterator[Curve]:
    """Yield the curves of a quantity; methods without an answer have none."""
    columns = {column.id: column.values for column in table.columns}
    points: dict[str, list[tuple[float, float]]] = {}
    for names, error, time in zip(table.names, columns["error"], columns["median"]):
        if names[0] == quantity and error is not None and time is not None and names[3] == "ok":
            points.setdefault(names[1].split(",")[0], []).append((max(error, _LEAST), time))
    for method, found in points.items():
        errors, times = zip(*found)
        yield Curve(method, errors, times)


def draw(report: Report, file_name: str) -> None:
    """Draw one panel for each quantity and scene of an accuracy report. Raises UsageError where that fails."""
    check_plot(file_name)
    panels = [(part, table, quantity) for part, table in _tables(report) for quantity in _quantities(table)]
    if not panels:
        raise UsageError("--plot: nothing was compared, there is nothing to draw")
    from matplotlib import rc_context
    from matplotlib.figure import Figure

    with rc_context({"svg.hashsalt": "kurbel", "svg.fonttype": "none", "font.size": 8}):
        across = min(4 if len(panels) > 15 else 3, len(panels))
        down = -(-len(panels) // across)
        figure = Figure(figsize=(4.4 * across, 3.3 * down), layout="constrained")
        axes = figure.subplots(down, across, squeeze=False)
        looks: dict[str, int] = {}
        for axis, (part, table, quantity) in zip(axes.flat, panels):
            _panel(axis, f"{quantity}   {part.name}", list(curves(table, quantity)), looks)
        for axis in list(axes.flat)[len(panels) :]:
            axis.set_axis_off()
        figure.suptitle("\n".join((report.title, *report.head[:1])), fontsize=9)
        for axis in list(axes.flat)[: len(panels)][-across:]:  # the lowest of each column
            axis.set_xlabel("relative error (dotted: 2⁻⁵³)")
        figure.supylabel("time, ms")
        handles = {label: line for axis in axes.flat for line, label in zip(*axis.get_legend_handles_labels())}
        figure.legend(handles.values(), handles.keys(), loc="outside lower center", ncols=2 * across, fontsize=8)
        try:
            with replaced(file_name) as path:
                figure.savefig(path, metadata={"Date": None} if file_name.lower().endswith(".svg") else None)
        except OSError as error:
            raise UsageError(f"cannot write {file_name}: {error.strerror or error}") from None


def _tables(report: Report) -> Iterator[tuple[Part, PlaceTable]]:
    for part in report.parts:
        for table in part.place_tables:
            if table.id == _TABLE:
                yield part, table


def _quantities(table: PlaceTable) -> tuple[str, ...]:
    return tuple(dict.fromkeys(names[0] for names in table.names))


_MARKS = "osD^v<>ph*X"


def _panel(axis: Any, title: str, found: list[Curve], looks: dict[str, int]) -> None:
    """Draw the curves; a method looks the same in every panel, by its place in `looks`."""
    from matplotlib.ticker import LogLocator, NullLocator

    for curve in found:
        look = looks.setdefault(curve.method, len(looks))
        style: dict[str, Any] = {"color": f"C{look % 10}", "marker": _MARKS[look % len(_MARKS)], "markersize": 4}
        if curve.method == _OWN:
            style = {"color": "black", "marker": "*", "markersize": 12, "zorder": 3}
        axis.loglog(curve.errors, curve.times, label=curve.method, linewidth=1, **style)
    axis.axvline(_ROUNDING, linestyle=":", color="gray", linewidth=1)
    axis.set_title(title, fontsize=8)
    times = [time for curve in found for time in curve.times]
    axis.set_ylim(min(times) / 3, max(times) * 3)
    axis.set_xlim(3.0, _LEAST / 3)  # falls to the right
    axis.grid(True, which="major", linewidth=0.3)
    axis.xaxis.set_major_locator(LogLocator(numticks=6))
    axis.xaxis.set_minor_locator(NullLocator())
