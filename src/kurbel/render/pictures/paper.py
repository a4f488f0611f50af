"""A scene as PNG or PDF, by matplotlib: the same lines, areas and texts at the same places as in SVG."""

import re
from typing import Any

from kurbel.render import Look
from kurbel.render.pictures.scene import Dots, Item, Line, Text
from kurbel.render.pictures.style import FAINT, GAIN, GRID, INK, LOOKS, LOSS, PAPER
from kurbel.report.pictures.picture import Picture

_POINT = 0.75
"""Of a point of matplotlib in one of a scene, 96 to the inch."""
_DPI = 192
_STROKES: dict[str, dict[str, Any]] = {
    "f": {"color": FAINT[0], "linewidth": 1},
    "g": {"color": GRID[0], "linewidth": 1},
    "x": {"color": INK[0], "linewidth": 1},
    "m": {"color": INK[0], "linewidth": 4, "solid_capstyle": "round"},
}
_FILLS: dict[str, dict[str, Any]] = {
    "p": {"facecolor": GAIN[0], "edgecolor": "none"},
    "n": {"facecolor": LOSS[0], "edgecolor": "none"},
    "b": {"facecolor": GRID[0], "edgecolor": INK[0]},
    "o": {"facecolor": PAPER[0], "edgecolor": INK[0]},
    "i": {"facecolor": INK[0], "edgecolor": INK[0]},
}


def save(pictures: list[Picture], look: Look, path: str, kind: str) -> None:
    """Draw pictures one below the other into a file; kind: png or pdf."""
    from matplotlib import rc_context
    from matplotlib.figure import Figure

    from kurbel.render.pictures.layout import scene

    scenes = [scene(picture, look) for picture in pictures]
    wide, tall = max(one.width for one in scenes), sum(one.height for one in scenes)
    with rc_context({"font.sans-serif": ["DejaVu Sans"], "text.parse_math": False, "pdf.fonttype": 42}):
        figure = Figure(figsize=(wide / 96, tall / 96), facecolor=PAPER[0])
        axes = figure.add_axes((0, 0, 1, 1), xlim=(0, wide), ylim=(tall, 0))
        axes.set_axis_off()
        top = 0.0
        for one in scenes:
            for order, item in enumerate(one.items):
                _ITEMS[type(item)](axes, item, top, order)
            top += one.height
        nameless = {"CreationDate": None} if kind == "pdf" else {"Software": None}
        figure.savefig(path, format=kind, dpi=_DPI, metadata=nameless)


def _text(axes: Any, item: Text, top: float, order: int) -> None:
    from matplotlib.patheffects import Normal, Stroke

    anchor = {"start": "left", "middle": "center", "end": "right"}[item.anchor]
    size, weight = (13, "bold") if item.look == "h" else (10, "normal")
    text = _mathtext(item)
    drawn = axes.text(
        item.x,
        item.y + top,
        text,
        parse_math=text != item.text,
        ha=anchor,
        va="baseline",
        size=size * _POINT,
        weight=weight,
        color=INK[0],
        zorder=order,
    )
    if item.halo:
        drawn.set_path_effects([Stroke(linewidth=3 * _POINT, foreground=PAPER[0]), Normal()])


def _mathtext(item: Text) -> str:
    """Return a text with its subscripts as matplotlib sets them; one without any as it is."""
    first, *following = item.levels
    if not following:
        return first
    below = [re.sub("([,=/])", r"{\1}", one) for one in following[::2]]
    return first + "".join(rf"$_{{\mathregular{{{one}}}}}${rest}" for one, rest in zip(below, following[1::2]))


def _line(axes: Any, item: Line, top: float, order: int) -> None:
    for part in item.parts:
        x, y = zip(*((x, y + top) for x, y in part))
        if item.closed:
            axes.fill(x, y, linewidth=1.2 * _POINT, zorder=order, **_fill(item.look))
        else:
            axes.plot(x, y, zorder=order, **_stroke(item.look))


def _dots(axes: Any, item: Dots, top: float, order: int) -> None:
    if item.places:
        x, y = zip(*((x, y + top) for x, y in item.places))
        size = (2 * item.radius * _POINT) ** 2
        marker = [(a, -b) for a, b in item.corners] if item.corners else "o"
        axes.scatter(x, y, s=size, marker=marker, linewidth=1.2 * _POINT, zorder=order, **_fill(item.look))


def _stroke(look: str) -> dict[str, Any]:
    if look in _STROKES:
        found = dict(_STROKES[look])
        return {**found, "linewidth": found["linewidth"] * _POINT}
    name, _, solid = look.partition(" ")
    own, wide = LOOKS[int(name[1:])], 1.6 if name.startswith("k") else 1.2
    dashed = own.dashes if name.startswith("k") and not solid else ()
    style = (0, tuple(one / wide for one in dashed)) if dashed else "-"
    return {"color": own.light, "linewidth": wide * _POINT, "linestyle": style}


def _fill(look: str) -> dict[str, Any]:
    return _FILLS.get(look) or {"facecolor": LOOKS[int(look[1:])].light, "edgecolor": "none"}


_ITEMS: dict[type[Item], Any] = {Line: _line, Text: _text, Dots: _dots}
