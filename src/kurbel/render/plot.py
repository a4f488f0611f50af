"""The work-precision picture of `kurbel accuracy`: time over error, one panel for each quantity."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, NamedTuple

from kurbel.errors import UsageError
from kurbel.render.output import replaced

if TYPE_CHECKING:
    from kurbel.report.tables import Report

SUFFIXES = (".svg", ".png")
_TABLE = "numerical_error"
_OWN = "kurbel"
_LEAST = 1e-17
"""Errors below this, zero too, are drawn here."""
_ROUNDING = 2.0**-53
_GAP = (float("nan"), float("nan"))
_MARKS = "osD^v<>ph*X"
_STYLE: Any = {
    **{"svg.hashsalt": "kurbel", "svg.fonttype": "none", "font.sans-serif": ["DejaVu Sans"], "font.size": 8},
    **{"xtick.bottom": False, "ytick.left": False, "axes.spines.top": False, "axes.spines.right": False},
    "legend.frameon": False,
}
_NAMELESS: Any = dict.fromkeys(("Creator", "Date", "Format", "Type"))
"""The same picture every time, small, with text as text, without its date."""


def check_plot(file_name: str) -> None:
    """Raise UsageError where a picture cannot be drawn to this file, before anything is measured."""
    suffix = os.path.splitext(file_name)[1].lower()
    if suffix not in SUFFIXES:
        raise UsageError(f"--plot {file_name}: the name of a picture ends in {' or '.join(SUFFIXES)}")
    from importlib.util import find_spec

    if find_spec("matplotlib") is None:
        raise UsageError("--plot needs matplotlib, which is not installed: pip install 'kurbel[plot]'")


class Dots(NamedTuple):
    """What one method does in one panel: errors and times in ms, nan after those of each scene."""

    method: str
    errors: tuple[float, ...]
    times: tuple[float, ...]


def panels(report: Report) -> dict[str, list[Dots]]:
    """Return what is drawn of each quantity, over all scenes; methods without an answer have no dots."""
    found: dict[str, dict[str, list[tuple[float, float]]]] = {}
    for table in (table for part in report.parts for table in part.place_tables if table.id == _TABLE):
        columns = {column.id: column.values for column in table.columns}
        scene: dict[tuple[str, str], list[tuple[float, float]]] = {}
        for (quantity, method, _, state), error, time in zip(table.names, columns["error"], columns["median"]):
            if error is not None and time is not None and state == "ok":
                scene.setdefault((quantity, method.split(",")[0]), []).append((max(error, _LEAST), time))
        for (quantity, method), dots in scene.items():
            found.setdefault(quantity, {}).setdefault(method, []).extend((*dots, _GAP))
    return {quantity: [Dots(name, *zip(*dots)) for name, dots in every.items()] for quantity, every in found.items()}


def draw(report: Report, file_name: str) -> None:
    """Draw one panel for each quantity of an accuracy report, all scenes in it. Raises UsageError where that fails."""
    check_plot(file_name)
    drawn = panels(report)
    if not drawn:
        raise UsageError("--plot: nothing was compared, there is nothing to draw")
    from matplotlib import rc_context

    with rc_context(_STYLE):
        figure = _figure(drawn)
        figure.suptitle("\n".join((report.title, *report.head[:1])), fontsize=9)
        try:
            with replaced(file_name) as path:
                figure.savefig(path, metadata=_NAMELESS if file_name.lower().endswith(".svg") else None)
        except OSError as error:
            raise UsageError(f"cannot write {file_name}: {error.strerror or error}") from None


def _figure(drawn: dict[str, list[Dots]]) -> Any:
    """Return the figure with its panels, four in a row, on the same axes."""
    from matplotlib.figure import Figure

    across = min(4, len(drawn))
    down = -(-len(drawn) // across)
    figure = Figure(figsize=(1.5 + 2.6 * across, 1.4 + 2.3 * down), layout="constrained")
    axes = figure.subplots(down, across, squeeze=False, sharex=True, sharey=True)
    looks: dict[str, int] = {}
    for axis, (quantity, dots) in zip(axes.flat, drawn.items()):
        _panel(axis, quantity, dots, looks)
    for axis in axes.flat[len(drawn) :]:
        axis.set_axis_off()
    axes[0, 0].set_xlim(3.0, _LEAST / 3)  # falls to the right
    for axis in axes.flat[max(0, len(drawn) - across) : len(drawn)]:  # the lowest of each column
        axis.set_xlabel("relative error")
        axis.tick_params(labelbottom=True)
    figure.supylabel("time, ms", fontsize=8)
    handles = {label: line for axis in axes.flat for line, label in zip(*axis.get_legend_handles_labels())}
    figure.legend(handles.values(), handles.keys(), loc="outside lower center", ncols=across)
    return figure


def _panel(axis: Any, title: str, found: list[Dots], looks: dict[str, int]) -> None:
    """Draw the dots, those of one scene joined; a method looks the same in every panel, by its place in `looks`."""
    from matplotlib.ticker import LogLocator, NullLocator

    for dots in found:
        look = looks.setdefault(dots.method, len(looks))
        style: dict[str, Any] = {"color": f"C{look % 10}", "marker": _MARKS[look % len(_MARKS)], "markersize": 3.5}
        if dots.method == _OWN:
            style = {"color": "black", "marker": "*", "markersize": 8, "linestyle": "none", "zorder": 3}
        axis.loglog(dots.errors, dots.times, label=dots.method, linewidth=0.6, markeredgewidth=0, **style)
    axis.axvline(_ROUNDING, linestyle=":", color="gray", linewidth=1)
    axis.set_title(title)
    for one in (axis.xaxis, axis.yaxis):
        one.set_major_locator(LogLocator(numticks=4))
        one.set_minor_locator(NullLocator())
        one.set_major_formatter("{x:.0e}")
