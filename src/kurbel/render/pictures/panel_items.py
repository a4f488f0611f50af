"""What stands on one panel of a scene: ticks, shades, curves, marks, arrows, and their labels."""

from collections.abc import Iterator, Sequence
from itertools import pairwise

import numpy as np

from kurbel.arrays import Array
from kurbel.render import Look
from kurbel.render.pictures.labels import CHARACTER, Box, Taken, axis_text, figure_text, shade_texts, symbol, tick_texts
from kurbel.render.pictures.scale import Scale, ticks
from kurbel.render.pictures.scene import Dots, Item, Line, Places, Text, thinned
from kurbel.render.pictures.style import SHAPES, looks_of
from kurbel.render.text import width as cells
from kurbel.report.pictures.picture import Arrow, Curve, Panel, Shade

Scales = tuple[Scale, Scale]
_KINDS = {"faint": "f", "guide": "f", "member": "m", "block": "b"}
_MOST_LABELS = 12
_BESIDE = 14.0
"""Room that a picture has to the right of its panel."""


def panel_items(panel: Panel, frame: Box, scales: Scales, look: Look) -> Iterator[Item]:
    """Yield what stands on a panel of a page, from below to above."""
    x, y = scales
    inner = Box(x.start, y.end, x.end, y.start)
    free = inner._replace(top=frame.top + 2, bottom=frame.bottom - 2) if panel.plain else inner
    if not panel.plain:
        yield from _grid(panel, scales, look)
    yield from shapes(panel, scales)
    yield from _heading(panel, frame, scales, look)
    yield from labels(panel, Taken(free, dense(panel.curves, scales)), scales, look)


def shapes(panel: Panel, scales: Scales) -> Iterator[Item]:
    """Yield the shades and the curves of a panel."""
    yield from (item for shade in panel.shades for item in _shade(shade, scales))
    for number, (curve, look) in enumerate(zip(panel.curves, looks_of(panel))):
        yield from _curve(panel, number, curve, look, scales)


def labels(panel: Panel, taken: Taken, scales: Scales, look: Look) -> Iterator[Item]:
    """Yield what names lines, forces, points and surfaces; forces and points with what is drawn of them."""
    yield from _faint_names(panel, scales, taken, look)
    for number in range(len(panel.arrows)):
        yield from arrow(panel, number, scales, look)
    yield from _marks(panel, scales, taken, look)
    yield from _figures(panel, scales, taken, look)


def dense(curves: Sequence[Curve], scales: Scales) -> Array:
    """Return places (n, 2) along curves, a few points apart."""
    x, y = scales
    found = [np.empty((0, 2))]
    for piece in (piece for curve in curves for piece in curve.pieces):
        way = np.linspace(0, len(piece.x) - 1, max(150, len(piece.x)))
        steps = np.arange(len(piece.x))
        found.append(np.column_stack([np.interp(way, steps, s.place(p)) for s, p in ((x, piece.x), (y, piece.y))]))
    return np.concatenate(found)


def _grid(panel: Panel, scales: Scales, look: Look) -> Iterator[Item]:
    """Yield thin lines with what they stand for, and what runs along the axes."""
    x, y = scales
    across, up = ticks(x, panel.x, max(3, int((x.end - x.start) / 64))), ticks(y, panel.y, int((y.start - y.end) / 30))
    lines = [((x.place(v), y.start), (x.place(v), y.end)) for v in across]
    lines += [((x.start, y.place(v)), (x.end, y.place(v))) for v in up]
    yield Line(tuple(lines), "g")
    yield Line((((x.start, y.end), (x.start, y.start), (x.end, y.start)),), "x")
    below = tick_texts(panel.x, across, look)
    yield from _along([float(x.place(v)) for v in across], below, x.end + _BESIDE, y.start + 14)
    for value, text in zip(up, tick_texts(panel.y, up, look)):
        yield Text(x.start - 6, y.place(value) + 3.5, text, "t", "end")
    yield Text(x.end, y.start + 26, axis_text(panel.x.name, panel.x.unit, look), "t", "end")


def _along(places: list[float], texts: Sequence[str], edge: float, base: float) -> Iterator[Item]:
    """Yield what stands below the ticks, inside the edge of the picture; of two that meet the outer one stands."""
    taken: list[tuple[float, float]] = []
    for k in sorted(range(len(places)), key=lambda k: min(k, len(places) - 1 - k)):
        half = CHARACTER * cells(texts[k]) / 2
        middle = min(places[k], edge - half)
        if all(middle + half <= left or middle - half >= right for left, right in taken):
            taken.append((middle - half, middle + half))
            yield Text(middle, base, texts[k], "t", "middle", plain=True)


def _shade(shade: Shade, scales: Scales) -> Iterator[Item]:
    x, y = scales
    there = thinned(x.place(shade.x), y.place(shade.high), 0.3)
    back = thinned(x.place(shade.x[::-1]), y.place(shade.low[::-1]), 0.3)
    yield Line(((*there, *back),), "p" if shade.gain else "n", closed=True)


def _curve(panel: Panel, number: int, curve: Curve, look: int, scales: Scales) -> Iterator[Item]:
    """Yield a curve, each of its jumps as a thin line."""
    parts = _on_paper(curve, scales)
    moving = tuple(_on_paper(one.curves[number], scales) for one in panel.frames)
    moving = moving if any(parts_ != parts for parts_ in moving) else ()
    if curve.kind in ("joint", "fixed"):
        frames = tuple(one[0] for one in moving)
        yield Dots(parts[0], "o" if curve.kind == "joint" else "i", 4.0, frames)
        return
    if curve.kind == "dots":
        yield from (Line((part,), f"j{look}") for part in parts if len(part) > 1)
        shape = SHAPES[(look if curve.look is None else curve.look) % len(SHAPES)]
        yield Dots(tuple(place for part in parts for place in part), f"c{look}", 2.4, corners=shape)
        return
    kind = _KINDS.get(curve.kind, f"k{look}")
    yield Line(parts, kind, curve.kind == "block", moving)
    if curve.kind == "line":
        jumps = tuple((before[-1], after[0]) for before, after in pairwise(parts))
        yield from (Line(jumps, f"j{look}"),) if jumps else ()


def _on_paper(curve: Curve, scales: Scales) -> tuple[Places, ...]:
    x, y = scales
    places = [(np.asarray(x.place(piece.x)), np.asarray(y.place(piece.y))) for piece in curve.pieces]
    whole = curve.kind in ("line", "faint")
    return tuple(thinned(*one) if whole else tuple(zip(one[0].tolist(), one[1].tolist())) for one in places)


def _heading(panel: Panel, frame: Box, scales: Scales, look: Look) -> Iterator[Item]:
    """Yield what stands above a panel: its title, what runs upward, and which stroke is which quantity."""
    x, base = scales[0], frame.top + (13 if panel.plain else 24)
    left = x.start if panel.plain else 12.0 + frame.left
    axis = "" if panel.plain else axis_text(panel.y.name, panel.y.unit, look)
    for text, title in ((look.charset.text(panel.title), True), (axis, False)):
        if text:
            yield Text(left, base, text, still=bool(panel.frames), plain=title)
            left += CHARACTER * cells(text) + 20
    lines = [(curve, one) for curve, one in zip(panel.curves, looks_of(panel)) if curve.kind == "line"]
    for curve, one in lines if len(lines) > 1 else ():
        name = symbol(curve.name, look)
        wide = 30 + CHARACTER * cells(name) + 16
        if left + wide > frame.right:
            break
        yield Line((((left, base - 4), (left + 26, base - 4)),), f"k{one}")
        yield Text(left + 30, base, name)
        left += wide


def _faint_names(panel: Panel, scales: Scales, taken: Taken, look: Look) -> Iterator[Item]:
    """Yield the names of the lines to compare with, at their ends."""
    x, y = scales
    for curve in panel.curves:
        if curve.kind == "faint" and curve.name.symbol:
            piece, name = curve.pieces[-1], symbol(curve.name, look)
            if place := taken.place(float(x.place(piece.x[-1])), float(y.place(piece.y[-1])), name, upward=True):
                yield Text(*place, name, halo=True)


def _marks(panel: Panel, scales: Scales, taken: Taken, look: Look) -> Iterator[Item]:
    x, y = scales
    places = [(float(x.place(mark.x)), float(y.place(mark.y))) for mark in panel.marks]
    for left, base in places:
        taken.take(Box(left - 4, base - 4, left + 4, base + 4))
    if places:
        yield Dots(tuple(places), "o")
    middle = (y.start + y.end) / 2
    for mark, (left, base) in list(zip(panel.marks, places))[:_MOST_LABELS]:
        text = figure_text(mark.figure, look)
        if found := taken.pointed(left, base, text, upward=base < middle or panel.plain):
            place, pointer = found
            if pointer:
                yield Line((pointer,), "f")
            yield Text(*place, text, halo=True)


def _figures(panel: Panel, scales: Scales, taken: Taken, look: Look) -> Iterator[Item]:
    """Yield what is written into shades, at their highest place."""
    x, y = scales
    for shade, text in shade_texts(panel.shades, look, lambda one: float(np.ptp(x.place(one.x))) / CHARACTER):
        widest = int(np.argmax(np.abs(shade.high - shade.low)))
        middle = float(y.place((shade.high[widest] + shade.low[widest]) / 2))
        for written in (text, text.split(" ")[0]):
            if place := taken.place(float(x.place(shade.x[widest])), middle, written, upward=True, clear=True):
                yield Text(*place, written, halo=True)
                break


def arrow(panel: Panel, number: int, scales: Scales, look: Look) -> Iterator[Item]:
    """Yield a force as an arrow with its symbol."""
    arrow = panel.arrows[number]
    moving = [one.arrows[number] for one in panel.frames]
    shafts, heads, names = zip(*(_arrow_places(one, scales) for one in (arrow, *moving)))
    yield Line(shafts[0], "k1 solid", frames=shafts[1:])
    yield Line(heads[0], "c1", True, frames=heads[1:])
    text = symbol(arrow.name, look)
    left, base = names[0]
    yield Text(left, base, text, "t", "middle", True, names[1:])


def _arrow_places(arrow: Arrow, scales: Scales) -> tuple[tuple[Places, ...], tuple[Places, ...], tuple[float, float]]:
    """Return the shaft and the head of an arrow, and where its name stands."""
    x, y = scales
    start, end = (np.array([x.place(one[0]), y.place(one[1])], dtype=float) for one in (arrow.tail, arrow.head))
    length = float(np.hypot(*(end - start)))
    along = (end - start) / length if length else np.zeros(2)
    across = np.array([-along[1], along[0]])
    size = min(9.0, length)
    back = end - size * along
    head = (tuple(end), tuple(back + 0.4 * size * across), tuple(back - 0.4 * size * across))
    name = end + 9 * along + (0, 3.5)
    return ((tuple(start), tuple(back)),), (head,), (float(name[0]), float(name[1]))
