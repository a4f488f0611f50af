"""Pictures as SVG: text stays text, colours and strokes are classes, and what moves, moves without a script."""

import math
from collections.abc import Iterable, Iterator, Sequence
from html import escape
from typing import NamedTuple

import numpy as np

from kurbel.arrays import Array, ComplexArray
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
from kurbel.report.picture import MOMENTS_PER_TURN, Body, Curve, Panel, Picture, Shape

# lengths in points from the upper left corner
PAPER_SIZES = Medium(letter=5.8, line=12.0, dot=4.0, grain=(4.0, 4.0), covering=40.0, shortest=110.0, tallest=460.0)
WIDTH = 720.0
_TALL, _SHORT = 250.0, 170.0
"""Height of a panel among at most two and of one among several."""
_GUTTER = 14.0
"""Between panels that are next to each other."""
_BOLD = 8.3
"""Width of a character of a heading."""
_SECONDS = 5.0
"""Time that a moving mechanism takes for one turn."""
_POSTER = (1150.0, 640.0)
"""Room for a picture on a sheet, the longer side first."""
_LONGEST_BAR, _NOTE = 110.0, 7.0
"""Length of the longest bar that shows a scale, and width of a character of a note."""
_CLEAR = 4.0
"""How far labels are at least from the upright axis."""
_SHORTEST = 2.0
"""Length of an arrow below which it has no name, where it does not move."""
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
EDGE = ("#2c3843", "#aeb8c1")
MATERIALS = {
    "wall": ("#55626e", "#93a0ab"),
    "web": ("#8593a0", "#5d6b7a"),
    "metal": ("#c9d2da", "#5a6772"),
    "rod": ("#e4e9ed", "#74818c"),
    "hollow": ("#f6f8f9", "#20262c"),
    "gas": ("#e0603a", "#e8693f"),
    "liquid": ("#3f86bd", "#4d9ad3"),
}
"""Edges and fillings of parts of machines, in light and in dark."""
_EDGED = "metal", "rod", "hollow"
_LINES = {"thin": "", "axis": "7 2.5 1.5 2.5", "guess": "4 3"}
"""Looks of lines of machines, with their dashes."""
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


def css(dark: bool = True, machines: bool = True) -> str:
    """Return the style sheet of pictures; dark: also for dark screens, and for readers who want nothing to move.

    machines: also of machines in section.
    """
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
        + (_machine_css(mode) if machines else "")
        for mode in (0, 1)
    )
    if not dark:
        return f"{always}{light}"
    still = "svg .moving{display:none}svg .still{display:inline}"
    return (
        f"{always}{light}svg .still{{display:none}}@media (prefers-reduced-motion:reduce){{{still}}}"
        f"@media print{{{still}}}@media screen and (prefers-color-scheme:dark){{{at_night}}}"
    )


def _machine_css(mode: int) -> str:
    """Return the style sheet of parts of machines in light or in dark."""
    filled = "".join(f".{look}{{fill:{one[mode]}}}" for look, one in MATERIALS.items())
    colours = f".thin,.guess,.{',.'.join(_EDGED)}{{stroke:{EDGE[mode]}}}.axis{{stroke:{FAINT[mode]}}}"
    colours += f".note{{fill:{FAINT[mode]}}}"
    if mode:
        return filled + colours
    strokes = f".{',.'.join(_EDGED)}{{stroke-width:.9;stroke-linejoin:round}}"
    for look, dashes in _LINES.items():
        strokes += f".{look}{{fill:none;stroke-width:.7{f';stroke-dasharray:{dashes}' if dashes else ''}}}"
    texts = ".note{font-size:12.5px}.strong,.force{font-size:13px}.strong{font-weight:600}"
    return f"{strokes}{texts}@media(max-width:520px){{.mark,.force{{font-size:19px}}}}{filled}{colours}"


def svg_file(pictures: Iterable[Picture], look: Look, paper: bool = False) -> str:
    """Return a file with pictures one below the other; paper: as what can neither be dark nor move."""
    height, parts, texts, machines = 0.0, "", list[str](), False
    for picture in pictures:
        machines |= any(panel.bodies for panel in picture.panels)
        tall, items = _drawn(picture, look, paper)
        texts.append(picture_text(picture, look))
        parts += f'<g transform="translate(0 {height:g})">\n{items}</g>\n'
        height += tall
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" class="s" viewBox="-8 0 {WIDTH + 16:g} {height:g}" '
        f'width="{WIDTH + 16:g}" height="{height:g}" role="img">\n<title>{escape(" ".join(texts))}</title>\n'
        f"<style>{css(not paper, machines)}</style>\n{parts}</svg>\n"
    )


def svg(picture: Picture, look: Look) -> str:
    """Return a picture as a part of a page that has the style sheet, and its heading."""
    tall, items = _drawn(picture, look, False, headed=False)
    head = f'<svg class="s" viewBox="-1 0 {WIDTH + 2:g} {tall:g}" role="img">'
    return f"{head}<title>{escape(picture_text(picture, look))}</title>\n{items}</svg>"


def poster_svg(panel: Panel, look: Look, wide: bool) -> str:
    """Return a panel alone, as it is on a sheet of paper, wide or tall, with fine lines and small texts."""
    room, tallest = _POSTER if wide else _POSTER[::-1]
    frame = PanelFrame(panel, look, PAPER_SIZES._replace(tallest=tallest), room, tallest)
    tall = frame.tall + 30.0 + 15.0 * len(_footnote(frame))
    return (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="-2 -6 {room + 4:g} {tall + 6:g}" width="{room + 4:g}" '
        f'height="{tall + 6:g}"><style>{css(False)}</style>{"".join(_panel(frame, 0.0, True, ()))}</svg>'
    )


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
        under += 18.0 + 15.0 * len(_footnote(frame)) if panel.footnote else 0.0
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
    resting = _text(0, -5, frame.look.text(panel.title), "note", plain=True) if panel.plain else ""
    moving = ""
    yield from (_body(frame, body, paper) for body in panel.bodies)
    for curve, look in zip(panel.curves, looks_of(panel)):
        if curve.x.ndim == 1 or paper:
            yield _curve(frame, curve.at_moment(0), look)
        else:  # forces alone move
            moving += _arrow(frame, [curve.at_moment(moment) for moment in range(len(curve.x))])
            resting += _arrow(frame, [curve.at_moment(0)])
    if moving or (not paper and any(body.moves for body in panel.bodies)):
        resting = f'<g class="moving">{moving}</g>\n<g class="still">{resting}</g>\n'
    yield resting
    labels = frame.labels(named=False)
    yield "".join(_shape("f", _path(np.array([one.point, one.lead]))) for one in labels if one.lead is not None)
    yield "".join(_shape("o", _dot(complex(frame.place(mark.x, mark.y)), 0, 2.6)) for mark in panel.marks)
    clear = -math.inf if panel.plain else _CLEAR  # of the axis
    yield "".join(_text(max(label.left, clear), label.top + 9.5, label.text, "halo") for label in labels)
    for one in panel.captions:
        at, of = complex(frame.place(one.place.real, one.place.imag)), "mark strong" if one.strong else "mark note"
        yield _text(at.real, at.imag + 4.5, frame.look.text(one.text), of, "middle", plain=True)
    if panel.footnote:
        yield from _below(frame)


def _body(frame: PanelFrame, body: Body, paper: bool) -> str:
    """Return shapes that move together, at rest and, unless on paper, also in motion."""
    places, scale = frame.place(body.place.real, body.place.imag), frame.points_per_unit
    moving, moved = not paper and body.moves, places - places[0]
    # on the page y counts downward, so that angles turn the other way
    steps = (
        ("scale", body.stretch, [f"{round(one, 4):g} 1" for one in body.stretch], 1.0),
        ("rotate", body.turn, [f"{round(-one, 2) + 0.0:g}" for one in body.turn], 0.0),
        # from where it rests, which has fewer digits
        ("translate", moved, [f"{_number(one.real)} {_number(one.imag)}" for one in moved], 0.0),
    )
    found = ""
    for animated in (True, False) if moving else (False,):
        drawn = "".join(_part(shape, scale) for shape in body.shapes)
        for kind, values, texts, nothing in steps:
            if np.any((values if animated else values[:1]) != nothing):
                moves = _transformed(kind, values, texts) if animated else ""
                drawn = f'<g transform="{kind}({texts[0]})">{moves}{drawn}</g>'
        drawn = f'<g transform="translate({_number(places[0].real)} {_number(places[0].imag)})">{drawn}</g>'
        if np.any(body.tint != 1.0):
            texts = [f"{one:.2f}".lstrip("0") for one in body.tint]
            moves = _animated("opacity", texts) if animated else ""
            drawn = f'<g opacity="{texts[0]}">{moves}{drawn}</g>'
        found += f'<g class="{"moving" if animated else "still"}">{drawn}</g>\n' if moving else f"{drawn}\n"
    return found


def _part(shape: Shape, scale: float) -> str:
    points, radius = shape.points.conj() * scale, shape.radius * scale
    if radius:
        middle = f' cx="{_number(points[0].real)}"' if points[0].real else ""
        middle += f' cy="{_number(points[0].imag)}"' if points[0].imag else ""
        return f'<circle class="{shape.look}"{middle} r="{_number(radius)}"/>'
    return f'<path class="{shape.look}" d="{_path(points)}{"z" if len(points) > 2 else ""}"/>'


def _transformed(kind: str, values: Array | ComplexArray, texts: Sequence[str]) -> str:
    """Return the movement of a transformation through its values, the first of which is at rest, and round again."""
    loop, seconds = list(texts[1:]), (len(values) - 1) / MOMENTS_PER_TURN * _SECONDS
    if len(set(loop)) < 2:
        return ""
    steps, last = np.diff(values[1:]), loop[0]
    if kind == "rotate":  # what turns on and on ends a turn later
        last = f"{round(float(-values[1].real) - 360.0 * round(float((values[-1] - values[1]).real) / 360.0), 2):g}"
        if np.ptp(steps) < 1e-9:
            loop = loop[:1]
    around = ";".join((*loop, last))
    return (
        f'<animateTransform attributeName="transform" type="{kind}" dur="{seconds:g}s" repeatCount="indefinite" '
        f'values="{around}"/>'
    )


def _below(frame: PanelFrame) -> Iterator[str]:
    """Yield a bar of a round length, and what of the picture is to scale."""
    unit, scale, look = frame.panel.x.unit, frame.points_per_unit, frame.look
    power = 10.0 ** math.floor(math.log10(_LONGEST_BAR / scale))
    length = next(one * power for one in (5.0, 2.0, 1.0) if one * power * scale <= _LONGEST_BAR)
    top, end = frame.tall + 22.0, length * scale
    yield _shape("thin", f"M0 {top - 3:g}v6m0-3h{end:.1f}m0-3v6")
    yield _text(end + 7.0, top + 4.0, f"{length:g} {look.unit(unit)}", "note")
    for number, line in enumerate(_footnote(frame)):
        yield _text(frame.wide, top + 4.0 + 15.0 * number, line, "note", "end", plain=True)


def _footnote(frame: PanelFrame) -> list[str]:
    """Return the lines of the footnote at the right of the bar, about equally long."""
    text, room = frame.look.text(frame.panel.footnote), int((frame.wide - 190.0) / _NOTE)
    lines = folded(text, room)
    return folded(text, min(room, len(text) // len(lines) + 8))


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
    across = frame.ticks_across(max(3, int(wide / 64)), -left, wide + 8)
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


def _curve(frame: PanelFrame, curve: Curve, look: int) -> str:
    """Return a curve that does not move."""
    kind, shape = curve.kind, look if curve.look is None else curve.look
    if kind in ("arrow", "force"):
        return _arrow(frame, [curve])
    pieces = [frame.place(x, y) for x, y in curve.pieces()]
    lines = "".join(map(_path, map(thinned, pieces) if kind in ("line", "faint") else pieces))
    if kind == "line":
        jumps = "".join(_path(frame.place(x, y)) for x, y in curve.jumps())
        return _shape(f"k{look}", lines) + (_shape(f"j{look}", jumps) if jumps else "")
    if kind == "dots":
        dots = "".join(_dot(point, shape) for piece in pieces for point in piece)
        return _shape(f"j{look}", lines) + _shape(f"c{look}", dots)
    if kind in ("joint", "fixed", "beads", "pole"):
        radius = {"beads": 1.6, "pole": 3.0}.get(kind, 4.0)
        return _shape("o" if kind == "joint" else "i", "".join(_dot(point, 0, radius) for point in pieces[0]))
    return _shape({"member": "m", "block": "b"}.get(kind, "f"), lines)


def _arrow(frame: PanelFrame, moments: Sequence[Curve]) -> str:
    """Return an arrow with its name, through all moments of its movement, or at its only one."""
    force, paths, names = moments[0].kind == "force", list[str](), list[complex]()
    for curve in moments:
        tail, tip = frame.place(curve.x, curve.y).tolist()
        length = abs(tip - tail)
        if len(moments) == 1 and length < _SHORTEST:
            return ""
        along = (tip - tail) / length if length else 0.0
        neck, half = tip - min(9.0, length) * along, np.array([0.8, 0.8, 3.6]) * 1j * along
        side = np.array([tail, neck, neck])
        paths.append(_path(np.concatenate((side + half, [tip], (side - half)[::-1]))) + "Z")
        # a force is named at its end away from the shaft, where nothing else is
        inward = force and np.hypot(curve.x[0], curve.y[0]) > np.hypot(curve.x[1], curve.y[1])
        names.append((tail - 9.0 * along if inward else tip + 9.0 * along) + 3.5j)
    name, look = symbol(moments[0].name, frame.look), "halo force" if force else "halo"
    text = _text(names[0].real, names[0].imag, name, look, "middle", False, names)
    return _shape("c0" if force else "c1", paths[0], paths[1:]) + text


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
    around, seconds = ";".join((*loop, loop[0])), len(loop) / MOMENTS_PER_TURN * _SECONDS
    return f'<animate attributeName="{attribute}" dur="{seconds:g}s" repeatCount="indefinite" values="{around}"/>'


def _number(value: float) -> str:
    return f"{round(value, 1) + 0.0:g}"
