"""A picture as lines of characters, for a terminal: curves in Braille or letters, with axes, units and labels."""

from collections.abc import Iterator
from itertools import product

import numpy as np

from kurbel.arrays import Array
from kurbel.render import Look
from kurbel.render.pictures.canvas import Canvas
from kurbel.render.pictures.labels import LINE, Box, Taken, axis_text, symbol, tick_texts
from kurbel.render.pictures.panel_items import Scales, arrow, dense, labels, shapes
from kurbel.render.pictures.scale import Scale, scale_of, taller, ticks
from kurbel.render.pictures.scene import Item, Line, Text
from kurbel.render.pictures.style import looks_of
from kurbel.render.text import BLANK, folded, line, right
from kurbel.render.text import Line as Printed
from kurbel.render.text import width as cells
from kurbel.report.pictures.picture import Panel, Picture

_CELL = np.array([LINE / 2, LINE])
"""Width and height in points of a character of a terminal."""
_WIDTH = 80
_WIDEST = 160
_LEAST = 24
_TALL, _SHORT = 16, 10
_LEAST_ROWS = 7


def letters(picture: Picture, look: Look) -> Iterator[Printed]:
    """Yield a picture line by line, in the width of the look."""
    width = min(max(look.width or _WIDTH, _LEAST), _WIDEST)
    yield from (line(one, "title") for one in folded(look.charset.text(picture.heading), width))
    for panel in picture.panels:
        yield BLANK
        yield from _panel(panel, look, width, _TALL if len(picture.panels) == 1 else _SHORT)


def _panel(panel: Panel, look: Look, width: int, rows: int) -> Iterator[Printed]:
    y, x = scale_of(panel, "y"), scale_of(panel, "x")
    if panel.equal:
        y = taller(y, 2 * _LEAST_ROWS / width * (x.high - x.low))
    up = [] if panel.plain else ticks(y, panel.y, rows // 2)
    texts = tick_texts(panel.y, up, look)
    side = max(map(cells, texts), default=-1) + 1
    if panel.equal:
        # both axes have one scale, and a character is twice as high as wide
        rows = max(_LEAST_ROWS, min(30, round((width - side) / 2 * abs((y.high - y.low) / (x.high - x.low)))))
    canvas = Canvas(width - side, rows, look.charset.has("⣿"))
    right_end, bottom = (np.array(canvas.fine) - 1) * _dot(canvas)
    scales = x.reach(0.0, right_end), y.reach(bottom, 0.0)
    axis = "" if panel.plain else axis_text(panel.y.name, panel.y.unit, look)
    head = "   ".join(filter(None, (look.charset.text(panel.title), axis)))
    yield from (line(one) for one in folded(head, width))
    _draw(panel, canvas, scales, look)
    at = {int(scales[1].place(v) / _CELL[1]): text for v, text in zip(up, texts)}
    for row in range(*canvas.used) if panel.plain else range(rows):
        label = line(right(at.get(row, ""), side - 1) + " ", "unit") if side else ()
        yield (*label, *canvas.line_of(row))
    if not panel.plain:
        yield from _below(panel, scales[0], canvas, side, look)


def _dot(canvas: Canvas) -> Array:
    """Return width and height in points of a dot of a canvas."""
    return _CELL * (canvas.columns, canvas.rows) / canvas.fine


def _draw(panel: Panel, canvas: Canvas, scales: Scales, look: Look) -> None:
    """Draw what stands on the panel of a page; the surfaces between curves are left blank."""
    taken = Taken(Box(0.0, 0.0, *_CELL * (canvas.columns, canvas.rows)), dense(panel.curves, scales), ruled=True)
    still = panel._replace(shades=() if panel.curves else panel.shades, frames=())
    items = [*shapes(still, scales), *_names(panel, taken, scales, look), *_arrows(still, taken, scales, look)]
    items += labels(panel._replace(arrows=()), taken, scales, look)
    # the lines to compare with first, so that curves stand over them, and the texts over all
    for item in sorted(items, key=lambda one: (isinstance(one, Text), _role(one.look) != "rule")):
        if isinstance(item, Line):
            for part in item.parts:
                x, y = np.array([*part, *part[: item.closed]]).T / _dot(canvas)[:, None]
                canvas.line(x, y, _role(item.look))
        elif isinstance(item, Text):
            column, row = (item.x, item.y - LINE + 2) / _CELL
            canvas.write(round(column), round(row), item.text, _role(item.look))


def _role(look: str) -> str:
    """Return the role in which a terminal draws what has this look on paper."""
    if look[0] in "kjc":
        return f"curve{look[1]}"
    return {"m": "curve0", "p": "curve0", "n": "curve1", "t": "head"}.get(look, "rule")


def _arrows(panel: Panel, taken: Taken, scales: Scales, look: Look) -> Iterator[Item]:
    """Yield forces as arrows, their symbols where they hide nothing."""
    for number in range(len(panel.arrows)):
        for item in arrow(panel, number, scales, look):
            if not isinstance(item, Text):
                yield item
            elif place := taken.place(item.x, item.y, item.text, upward=True):
                yield Text(*place, item.text, "c1")


def _names(panel: Panel, taken: Taken, scales: Scales, look: Look) -> Iterator[Text]:
    """Yield the symbol of each of several curves where it is farthest from the others."""
    curves = [(one, number) for one, number in zip(panel.curves, looks_of(panel)) if one.kind in ("line", "dots")]
    for curve, number in curves if len(curves) > 1 else ():
        own, name = dense([curve], scales)[::3], symbol(curve.name, look)
        others = [dense([other], scales) for other, _ in curves if other is not curve]
        gap = np.min([_apart(own, other).min(axis=1) for other in others], axis=0)
        for clear, best in product((True, False), np.argsort(-gap)[:40]):
            left, base = own[best].tolist()
            if place := taken.place(left, base, name, base < scales[1].start / 2, clear):
                yield Text(*place, name, f"c{number}")
                break


def _apart(places: Array, others: Array) -> Array:
    """Return how far places (n, 2) are from others (m, 2), across and down together, (n, m)."""
    across, down = (np.abs(np.subtract.outer(one, other)) for one, other in zip(places.T, others.T))
    return np.asarray(across + down)


def _below(panel: Panel, scale: Scale, canvas: Canvas, side: int, look: Look) -> Iterator[Printed]:
    """Yield the axis below a panel, its ticks, and what runs along it."""
    values = ticks(scale, panel.x, max(2, canvas.columns // 10))
    texts = tick_texts(panel.x, values, look)
    rule = [look.charset.text("─")] * canvas.columns
    under = [" "] * canvas.columns
    end = 0
    for value, text in zip(values, texts):
        column = int(scale.place(value) / _CELL[0])
        start = min(max(column - cells(text) // 2, 0), canvas.columns - cells(text))
        rule[column] = "┴" if look.charset.has("┴") else "+"
        if start >= end and start >= 0:
            under[start : start + cells(text)] = list(text)
            end = start + cells(text) + 1
    yield line(" " * side + "".join(rule), "rule")
    yield line(" " * side + "".join(under).rstrip(), "unit")
    yield line(right(axis_text(panel.x.name, panel.x.unit, look), side + canvas.columns), "unit")
