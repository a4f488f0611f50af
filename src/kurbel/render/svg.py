"""Pictures as SVG: text stays text, colours and strokes are classes, and what moves, moves without a script."""

from collections.abc import Iterable, Iterator, Sequence
from html import escape
from typing import NamedTuple

import numpy as np

from kurbel.arrays import ComplexArray
from kurbel.render import Look
from kurbel.render.picture import (
    LOOKS,
    Medium,
    PanelFrame,
    axis_text,
    legend_text,
    looks_of,
    picture_text,
    symbol,
    ticks,
)
from kurbel.render.text import folded, subscripts, width
from kurbel.report.picture import Curve, Picture

# lengths in points from the upper left corner
PAPER_SIZES = Medium(letter=5.8, line=12.0, dot=4.0, grain=(4.0, 4.0), covering=40.0, shortest=110.0, tallest=460.0)
WIDTH = 720.0
_TALL, _SHORT = 250.0, 170.0
"""Height of a panel among at most two and of one among several."""
_GUTTER = 14.0
"""Between panels that are next to each other."""
_BOLD = 8.3
"""Width of a character of a heading."""
_SECONDS = 6.0
"""Time that a moving mechanism takes for one cycle."""
_STRAIGHT = 0.1
"""How far a point that is left out may be from the line between its neighbours."""


class Stroke(NamedTuple):
    """A curve's colour on a light and on a dark ground, and lengths of its dashes and gaps, none for a full line."""

    light: str
    dark: str
    dashes: str


STROKES = (
    Stroke("#0b5394", "#7cc0f5", ""),
    Stroke("#b04a0c", "#f0a35e", "8 3"),
    Stroke("#0b0b0b", "#f2f2f2", "2 2.5"),
    Stroke("#00694f", "#3fd1a0", "9 3 2 3"),
    Stroke("#8f2f74", "#eaa0cf", "5 2"),
    Stroke("#6b5900", "#e6d354", "1 3"),
)
"""After Okabe and Ito, whom the colour-blind can tell apart, darkened or lightened to a contrast of 4.5."""
INK, PAPER = ("#1a1a1a", "#e8e8e8"), ("#ffffff", "#15181b")
FAINT, GRID = ("#5c5c5c", "#a5a5a5"), ("#dcdcdc", "#33383d")
GAIN, LOSS = ("#cfe0f1", "#27425c"), ("#f6ddcc", "#583d28")
"""Each in light and in dark."""
SHAPES: tuple[tuple[complex, ...], ...] = (
    (),
    (-1 - 1j, 1 - 1j, 1 + 1j, -1 + 1j),
    (-1.3j, 1.2 + 1j, -1.2 + 1j),
    (-1.4j, 1.4, 1.4j, -1.4),
    (1.3j, 1.2 - 1j, -1.2 - 1j),
    (-1.4 - 0.5j, 1.4 - 0.5j, 1.4 + 0.5j, -1.4 + 0.5j),
    (-0.5 - 1.4j, 0.5 - 1.4j, 0.5 + 1.4j, -0.5 + 1.4j),
)
"""Corners of the figures that mark points, over their radius; none of a circle. Seven of them and six colours."""


Entry = tuple[str, float, int, int | None]
"""Of a line of texts above a panel: a text, its left end, its row, and the stroke before it, if any."""


def css(dark: bool = True) -> str:
    """Return the style sheet of pictures; dark: also for dark screens, and for readers who want nothing to move."""
    always = (
        'text{font-family:system-ui,"DejaVu Sans",sans-serif;font-size:10px}.h{font-size:13px;font-weight:600}'
        ".m{stroke-width:4;stroke-linecap:round}.f,.g,.x{stroke-width:1}.o,.b,.i{stroke-width:1.2}"
        ".f,.g,.x,.m{fill:none}.halo{paint-order:stroke;stroke-width:3px;stroke-linejoin:round}"
    )
    for number, stroke in enumerate(STROKES):
        dashes = f";stroke-dasharray:{stroke.dashes}" if stroke.dashes else ""
        always += f".k{number}{{stroke-width:1.6;fill:none{dashes}}}.j{number}{{stroke-width:1.2;fill:none}}"
    light, at_night = (
        f".s{{background:{PAPER[mode]}}}text{{fill:{INK[mode]}}}.halo{{stroke:{PAPER[mode]}}}.f{{stroke:{FAINT[mode]}}}"
        f".g{{stroke:{GRID[mode]}}}.x,.m,.o,.b,.i{{stroke:{INK[mode]}}}.o{{fill:{PAPER[mode]}}}.b{{fill:{GRID[mode]}}}"
        f".i{{fill:{INK[mode]}}}.p{{fill:{GAIN[mode]}}}.n{{fill:{LOSS[mode]}}}"
        + "".join(f".k{k},.j{k}{{stroke:{one[mode]}}}.c{k}{{fill:{one[mode]}}}" for k, one in enumerate(STROKES))
        for mode in (0, 1)
    )
    if not dark:
        return f"{always}{light}"
    still = "svg .moving{display:none}svg .still{display:inline}"
    return (
        f"{always}{light}svg .still{{display:none}}@media (prefers-reduced-motion:reduce){{{still}}}"
        f"@media print{{{still}}}@media screen and (prefers-color-scheme:dark){{{at_night}}}"
    )


def svg_file(pictures: Iterable[Picture], look: Look, paper: bool = False) -> str:
    """Return a file with pictures one below the other; paper: as what can neither be dark nor move."""
    height, parts, texts = 0.0, "", []
    for picture in pictures:
        tall, items = _drawn(picture, look, paper)
        texts.append(picture_text(picture, look))
        parts += f'<g transform="translate(0 {height:g})">\n{items}</g>\n'
        height += tall
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" class="s" viewBox="-8 0 {WIDTH + 16:g} {height:g}" '
        f'width="{WIDTH + 16:g}" height="{height:g}" role="img">\n<title>{escape(" ".join(texts))}</title>\n'
        f"<style>{css(not paper)}</style>\n{parts}</svg>\n"
    )


def svg(picture: Picture, look: Look) -> str:
    """Return a picture as a part of a page that has the style sheet, and its heading."""
    tall, items = _drawn(picture, look, False, headed=False)
    head = f'<svg class="s" viewBox="0 0 {WIDTH:g} {tall:g}" role="img">'
    return f"{head}<title>{escape(picture_text(picture, look))}</title>\n{items}</svg>"


def _drawn(picture: Picture, look: Look, paper: bool, headed: bool = True) -> tuple[float, str]:
    """Return the height of a picture and its items; headed: with its heading."""
    heading = folded(look.text(picture.heading), int(WIDTH / _BOLD)) if headed else []
    items = "".join(_text(0, 16 + 17 * number, text, "h", plain=True) for number, text in enumerate(heading))
    top, each = 7.0 * headed + 17 * len(heading), (WIDTH + _GUTTER) / picture.across - _GUTTER
    tall = _TALL if len(picture.panels) < 3 else _SHORT
    below = top
    for number, panel in enumerate(picture.panels):
        if number % picture.across == 0:
            top, across = below + 4 * (number > 0), 0.0
        left, right, above, under = (0.0, 0.0, 18.0, 8.0) if panel.plain else (48.0, 12.0, 20.0, 18.0)
        frame = PanelFrame(panel, look, PAPER_SIZES, each - left - right, tall)
        legend = [] if panel.plain else _legend(frame, left)
        above, under = (
            above + 14 * max((row for _, _, row, _ in legend), default=-1) + 14,
            under + 12 * len(frame.below),
        )
        inside = "".join(_panel(frame, left, paper, legend))
        items += f'<g transform="translate({across + left:g} {top + above:g})">\n{inside}</g>\n'
        below, across = max(below, top + above + frame.tall + under), across + each + _GUTTER
    top = below + 4
    for number, (name, mark) in enumerate(picture.legend):
        left, base = 12 + number % 4 * (WIDTH - 12) / 4, top + 14 + number // 4 * 16
        items += _shape(f"c{mark % LOOKS}", _dot(complex(left, base - 4), mark))
        items += _text(left + 9, base, symbol(name, look))
    return top + (-(-len(picture.legend) // 4) * 16 + 8 if picture.legend else 0), items


def _panel(frame: PanelFrame, left: float, paper: bool, legend: Sequence[Entry]) -> Iterator[str]:
    """Yield what is on a panel, from below to above; what moves twice, in motion and at rest.

    left: the room at its left.
    """
    panel = frame.panel
    if not panel.plain:
        yield from _around(frame, left, legend)
    for shade in panel.shades:
        low, high = (thinned(frame.place(shade.x, line)) for line in (shade.low, shade.high))
        # bars are all that there is to see; areas are behind their curves
        gain, loss = ("p", "n") if panel.curves else ("c0", "c1")
        yield _shape(gain if shade.gain else loss, _path(np.append(low, high[::-1])) + "Z")
    resting = _text(0, -5, frame.look.text(panel.title), plain=True) if panel.plain else ""
    moving = ""
    for curve, look in zip(panel.curves, looks_of(panel)):
        if curve.x.ndim == 1 or paper:
            yield _curve(frame, [curve.at_moment(0)], look)
        else:
            moving += _curve(frame, [curve.at_moment(moment) for moment in range(len(curve.x))], look)
            resting += _curve(frame, [curve.at_moment(0)], look)
    yield f'<g class="moving">{moving}</g>\n<g class="still">{resting}</g>\n' if moving else resting
    labels = frame.labels(named=False)
    yield "".join(_shape("f", _path(np.array([one.point, one.lead]))) for one in labels if one.lead is not None)
    yield "".join(_shape("o", _dot(complex(frame.place(mark.x, mark.y)), 0, 2.6)) for mark in panel.marks)
    yield "".join(_text(label.left, label.top + 9.5, label.text, "halo") for label in labels)


def _legend(frame: PanelFrame, left: float) -> list[Entry]:
    """Return what is above a panel: its title, what runs upward, and of several curves each with its stroke."""
    panel, look, found = frame.panel, frame.look, list[Entry]()
    at, row = -left, 0
    named = [(curve, number) for curve, number in zip(panel.curves, looks_of(panel)) if curve.kind == "line"]
    texts: list[tuple[str, int | None]] = [(look.text(panel.title), None), (axis_text(panel.y, look), None)]
    texts += [(legend_text(curve.name, look), number) for curve, number in named] if len(named) > 1 else []
    for text, number in texts:
        wide = PAPER_SIZES.letter * width(text) + (30 if number is not None else 0)
        if text and at + wide > frame.wide + 12 and at > -left:
            at, row = -left, row + 1
        if text:
            found.append((text, at, row, number))
            at += wide + 18
    return found


def _around(frame: PanelFrame, left: float, legend: Sequence[Entry]) -> Iterator[str]:
    """Yield thin lines with their values, what runs along the axes, and above which stroke is which quantity."""
    panel, look, wide, tall = frame.panel, frame.look, frame.wide, frame.tall
    across = frame.ticks_across(max(3, int(wide / 64)), -left, wide + 12)
    up = ticks(panel.y, frame.y, int(tall / 30), look)
    lines = [_path(np.array([place, place + 1j * tall])) for place, _, _ in across]
    lines += [_path(np.array([1j * place, wide + 1j * place])) for place, _ in up]
    yield _shape("g", "".join(lines)) + _shape("x", _path(np.array([0.0, 1j * tall, wide + 1j * tall])))
    yield "".join(_text(start, tall + 14, text, plain=True) for _, start, text in across if text)
    yield "".join(_text(-6, place + 3.5, text, anchor="end") for place, text in up)
    yield "".join(_text(wide, tall + 27 + 12 * k, text, anchor="end") for k, text in enumerate(frame.below))

    last = max((row for _, _, row, _ in legend), default=0)
    for text, at, row, number in legend:
        base = -10.0 - 14 * (last - row)
        if number is not None:
            yield _shape(f"k{number}", _path(np.array([at, at + 26]) + 1j * (base - 4)))
        yield _text(
            at + (30 if number is not None else 0), base, text, plain=row == 0 and text == look.text(panel.title)
        )


def _curve(frame: PanelFrame, moments: Sequence[Curve], look: int) -> str:
    """Return a curve, or a force with its name, through all moments of its movement, or at its only one."""
    kind, shape = moments[0].kind, look if moments[0].look is None else moments[0].look
    outlines: list[list[tuple[str, str]]] = []
    names: list[complex] = []
    for curve in moments:
        pieces = [frame.place(x, y) for x, y in curve.pieces()]
        lines = "".join(map(_path, map(thinned, pieces) if kind in ("line", "faint") else pieces))
        if kind == "line":
            jumps = "".join(_path(frame.place(x, y)) for x, y in curve.jumps())
            outlines.append([(f"k{look}", lines), (f"j{look}", jumps)] if jumps else [(f"k{look}", lines)])
        elif kind == "dots":
            dots = "".join(_dot(point, shape) for piece in pieces for point in piece)
            outlines.append([(f"j{look}", lines), (f"c{look}", dots)])
        elif kind in ("joint", "fixed", "beads", "pole"):
            radius = {"beads": 1.6, "pole": 3.0}.get(kind, 4.0)
            dots = "".join(_dot(point, 0, radius) for point in pieces[0])
            outlines.append([("o" if kind == "joint" else "i", dots)])
        elif kind == "arrow":
            tail, tip = pieces[0]
            length = abs(tip - tail)
            along = (tip - tail) / length if length else 0.0
            neck, half = tip - min(9.0, length) * along, np.array([0.8, 0.8, 3.6]) * 1j * along
            side = np.array([tail, neck, neck])
            outlines.append([("c1", _path(np.concatenate((side + half, [tip], (side - half)[::-1]))) + "Z")])
            names.append(tip + 9.0 * along + 3.5j)
        else:
            outlines.append([({"member": "m", "block": "b"}.get(kind, "f"), lines)])
    shapes = "".join(_shape(name, path, [one for _, one in loop]) for (name, path), *loop in zip(*outlines))
    if names:
        shapes += _text(
            names[0].real, names[0].imag, symbol(moments[0].name, frame.look), "halo", "middle", False, names
        )
    return shapes


def thinned(places: ComplexArray) -> ComplexArray:
    """Return places x + iy (n,) without those that are on a straight line between their neighbours."""
    while len(places) > 2:
        off, chord = places[1:-1] - places[:-2], places[2:] - places[:-2]
        share = (off * chord.conj()).real / np.maximum(np.abs(chord) ** 2, 1e-12)
        dull = np.abs(off - np.minimum(np.maximum(share, 0.0), 1.0) * chord) <= _STRAIGHT
        if not dull.any():
            break
        order = np.arange(len(dull))  # of neighbours every other one
        dull &= (order - np.maximum.accumulate(np.where(dull, -1, order))) % 2 == 1
        places = places[np.concatenate(([True], ~dull, [True]))]
    return places


def _path(places: ComplexArray) -> str:
    rounded = np.round(places, 1) + 0.0
    steps = (np.round(np.diff(rounded), 1) + 0.0).tolist()
    start = f"M{rounded[0].real:g} {rounded[0].imag:g}"
    return f"{start}l{' '.join([f'{one.real:g} {one.imag:g}' for one in steps])}" if steps else start


def _dot(middle: complex, shape: int, radius: float = 2.4) -> str:
    """Return the path of a point, as a circle or another figure."""
    if corners := SHAPES[shape % len(SHAPES)]:
        return _path(np.array([middle + radius * one for one in corners])) + "Z"
    x, y, r = _number(middle.real - radius), _number(middle.imag), f"{radius:g}"
    return f"M{x} {y}a{r} {r} 0 1 0 {2 * radius:g} 0a{r} {r} 0 1 0-{2 * radius:g} 0Z"


def _shape(look: str, path: str, loop: Sequence[str] = ()) -> str:
    """Return a path; loop: the paths through which it moves."""
    moves = _animated("d", (path, *loop))
    return f'<path class="{look}" d="{path}"{f">{moves}</path>" if moves else "/>"}\n'


def _text(
    x: float,
    y: float,
    text: str,
    look: str = "",
    anchor: str = "",
    plain: bool = False,
    loop: Sequence[complex] = (),
) -> str:
    """Return a text, with subscripts if it is not plain; loop: the places through which it moves."""
    first, *following = [text] if plain else subscripts(text)
    words = escape(first)
    for below, rest in zip(following[::2], following[1::2]):
        words += f'<tspan dy="2" font-size="80%">{escape(below)}</tspan>'
        words += f'<tspan dy="-2">{escape(rest)}</tspan>' if rest else ""
    moves = _animated("x", [_number(one.real) for one in loop]) + _animated("y", [_number(one.imag) for one in loop])
    attributes = (f' class="{look}"' if look else "") + (f' text-anchor="{anchor}"' if anchor else "")
    return f'<text{attributes} x="{_number(x)}" y="{_number(y)}">{words}{moves}</text>\n'


def _animated(attribute: str, values: Sequence[str]) -> str:
    """Return the movement of an attribute through these values and back, the first of which is at rest."""
    loop = values[1:]
    if len(set(loop)) < 2:
        return ""
    around = ";".join((*loop, loop[0]))
    return f'<animate attributeName="{attribute}" dur="{_SECONDS:g}s" repeatCount="indefinite" values="{around}"/>'


def _number(value: float) -> str:
    return f"{round(value, 1) + 0.0:g}"
