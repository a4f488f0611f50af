"""A picture as lines of characters, for a terminal: curves in Braille or letters, with axes, units and labels."""

from collections.abc import Iterator

import numpy as np

from kurbel.render import Look
from kurbel.render.charset import right
from kurbel.render.charset import width as cells
from kurbel.render.lines import BLANK, Line, line
from kurbel.render.pictures.canvas import Canvas
from kurbel.render.pictures.labels import axis_text, figure_text, shade_texts, symbol, tick_texts
from kurbel.render.pictures.scale import Scale, scale_of, taller, ticks
from kurbel.render.pictures.style import looks_of
from kurbel.render.prose import folded
from kurbel.report.pictures.picture import Curve, Panel, Picture, Shade

_WIDTH = 80
_WIDEST = 160
_LEAST = 24
_TALL, _SHORT = 16, 10
_LEAST_ROWS = 7


def letters(picture: Picture, look: Look) -> Iterator[Line]:
    """Yield a picture line by line, in the width of the look."""
    width = min(max(look.width or _WIDTH, _LEAST), _WIDEST)
    yield from (line(one, "title") for one in folded(look.charset.text(picture.heading), width))
    for panel in picture.panels:
        yield BLANK
        yield from _panel(panel, look, width, _TALL if len(picture.panels) == 1 else _SHORT)


def _panel(panel: Panel, look: Look, width: int, rows: int) -> Iterator[Line]:
    y, x = scale_of(panel, "y"), scale_of(panel, "x")
    if panel.equal:
        y = taller(y, 2 * _LEAST_ROWS / width * (x.high - x.low))
    up = [] if panel.plain else ticks(y, panel.y, rows // 2)
    texts = tick_texts(panel.y, up, look)
    side = max(map(cells, texts), default=-1) + 1
    braille = look.charset.has("⣿")
    if panel.equal:
        rows = _rows_of_equal(x, y, width - side)
    canvas = Canvas(width - side, rows, braille)
    across, down = canvas.fine
    scales = x.reach(0.0, across - 1.0), y.reach(down - 1.0, 0.0)
    yield from (line(one) for one in folded(_head(panel, look), width))
    _draw(panel, canvas, scales, look)
    at = {int(scales[1].place(v)) * rows // down: text for v, text in zip(up, texts)}
    shown = range(*canvas.used) if panel.plain else range(rows)
    for row in shown:
        label = line(right(at.get(row, ""), side - 1) + " ", "unit") if side else ()
        yield (*label, *canvas.line_of(row))
    if not panel.plain:
        yield from _below(panel, scales[0], canvas, side, look)


def _rows_of_equal(x: Scale, y: Scale, columns: int) -> int:
    """Return the rows in which both axes have one scale, a character being twice as high as wide."""
    return max(_LEAST_ROWS, min(30, round(columns / 2 * abs((y.high - y.low) / (x.high - x.low)))))


def _head(panel: Panel, look: Look) -> str:
    said = [look.charset.text(panel.title)] if panel.title else []
    return "   ".join([*said, *([] if panel.plain else [axis_text(panel.y.name, panel.y.unit, look)])])


def _draw(panel: Panel, canvas: Canvas, scales: tuple[Scale, Scale], look: Look) -> None:
    x, y = scales
    looks = looks_of(panel)
    # the lines to compare with first, so that curves stand over them
    for curve, number in sorted(zip(panel.curves, looks), key=lambda one: one[0].kind in ("line", "dots", "member")):
        _draw_curve(curve, number, canvas, scales)
    for shade in panel.shades if not panel.curves else ():  # bars
        across, down = (np.concatenate(part) for part in ((shade.x, shade.x[::-1]), (shade.high, shade.low[::-1])))
        role = 0 if shade.gain else 1
        canvas.line(x.place(np.append(across, across[0])), y.place(np.append(down, down[0])), role, f"curve{role}")
    for arrow in panel.arrows:
        ends = np.array([arrow.tail, arrow.head])
        canvas.line(x.place(ends[:, 0]), y.place(ends[:, 1]), 1, "curve1")
        _write_near(canvas, float(x.place(ends[1, 0])), float(y.place(ends[1, 1])), symbol(arrow.name, look), "curve1")
    _names(panel, looks, canvas, scales, look)
    for mark in panel.marks:
        column, row = float(x.place(mark.x)), float(y.place(mark.y))
        _write_near(canvas, column, row, figure_text(mark.figure, look), "head")
    room = canvas.columns / canvas.fine[0]
    for shade, text in shade_texts(panel.shades, look, lambda one: room * float(np.ptp(x.place(one.x)))):
        if not _write_into(canvas, shade, scales, text):
            _write_into(canvas, shade, scales, text.split(" ")[0])


def _write_into(canvas: Canvas, shade: Shade, scales: tuple[Scale, Scale], text: str) -> bool:
    """Write a text into a shade, as near its middle as there is a blank place, or beside it; True if it stands."""
    (across, down), (x, y) = canvas.fine, scales
    widest = int(np.argmax(np.abs(shade.high - shade.low)))
    ends = sorted(int(y.place(line[widest]) * canvas.rows / down) for line in (shade.low, shade.high))
    centres = [float(x.place(at)) * canvas.columns / across for at in ((shade.x[0] + shade.x[-1]) / 2, shade.x[widest])]
    for row in sorted(range(ends[0] + 1, ends[1]), key=lambda row: abs(2 * row - sum(ends))):
        for centre in centres:
            start = round(centre - cells(text) / 2)
            if canvas.free(start, row, text, blank=True):
                canvas.write(start, row, text, "unit")
                return True
    middle = float(y.place((shade.high[widest] + shade.low[widest]) / 2))
    return _write_near(canvas, float(x.place(shade.x[widest])), middle, text, "unit", (True,))


def _draw_curve(curve: Curve, number: int, canvas: Canvas, scales: tuple[Scale, Scale]) -> None:
    x, y = scales
    drawn = curve.kind in ("line", "dots", "member")
    last = None
    for piece in curve.pieces if curve.kind not in ("joint", "fixed") else ():
        across, down = np.asarray(x.place(piece.x)), np.asarray(y.place(piece.y))
        if last is not None and curve.kind == "line":  # a jump
            across, down = np.append(last[0], across), np.append(last[1], down)
        canvas.line(across, down, number, f"curve{number}" if drawn else "rule")
        last = across[-1], down[-1]


def _names(panel: Panel, looks: list[int], canvas: Canvas, scales: tuple[Scale, Scale], look: Look) -> None:
    """Write the symbol of each of several curves where it is farthest from the others; of faint lines at their end."""
    lines = [(curve, number) for curve, number in zip(panel.curves, looks) if curve.kind in ("line", "dots")]
    x, y = scales
    for curve, number in lines if len(lines) > 1 else ():
        others = [_places(other, scales) for other, _ in lines if other is not curve]
        own = _places(curve, scales)[::3]
        gap = np.min([np.abs(own[:, None, :] - other[None, :, :]).sum(axis=2).min(axis=1) for other in others], axis=0)
        name = symbol(curve.name, look)
        for best in np.argsort(-gap)[:40]:
            if _write_near(canvas, own[best, 0], own[best, 1], name, f"curve{number}"):
                break
    for curve in panel.curves:
        if curve.kind == "faint" and curve.name.symbol:
            piece = curve.pieces[-1]
            place = float(x.place(piece.x[-1])), float(y.place(piece.y[-1]))
            _write_near(canvas, *place, symbol(curve.name, look), "unit")


def _places(curve: Curve, scales: tuple[Scale, Scale]) -> np.ndarray:
    x, y = scales
    return np.concatenate([np.column_stack((x.place(piece.x), y.place(piece.y))) for piece in curve.pieces])


def _write_near(
    canvas: Canvas, x: float, y: float, text: str, role: str, blanks: tuple[bool, ...] = (True, False)
) -> bool:
    """Write a text beside a place in dots, where nothing is drawn if there is such a place; True if it stands.

    blanks: whether only blank places will do, one try after the other.
    """
    across, down = canvas.fine
    column, row, long = int(x * canvas.columns / across), int(y * canvas.rows / down), cells(text)
    starts = [min(max(column + shift, 0), canvas.columns - long) for shift in (-(long // 2), 1, -long)]
    upward = row >= canvas.rows // 2
    order = (1, -1, 2, -2, 0) if upward else (-1, 1, -2, 2, 0)
    for blank in blanks:
        for step in order:
            for start in starts:
                if canvas.free(start, row + step, text, blank):
                    canvas.write(start, row + step, text, role)
                    return True
    return False


def _below(panel: Panel, scale: Scale, canvas: Canvas, side: int, look: Look) -> Iterator[Line]:
    """Yield the axis below a panel, its ticks, and what runs along it."""
    dots = canvas.fine[0]
    values = ticks(scale, panel.x, max(2, canvas.columns // 10))
    texts = tick_texts(panel.x, values, look)
    rule = [look.charset.rule] * canvas.columns
    under = [" "] * canvas.columns
    end = 0
    for value, text in zip(values, texts):
        column = int(scale.place(value)) * canvas.columns // dots
        start = min(max(column - cells(text) // 2, 0), canvas.columns - cells(text))
        rule[column] = "┴" if look.charset.has("┴") else "+"
        if start >= end and start >= 0:
            under[start : start + cells(text)] = list(text)
            end = start + cells(text) + 1
    yield line(" " * side + "".join(rule), "rule")
    yield line(" " * side + "".join(under).rstrip(), "unit")
    yield line(right(axis_text(panel.x.name, panel.x.unit, look), side + canvas.columns), "unit")
