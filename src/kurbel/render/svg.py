"""Pictures as SVG: text stays text, colours and strokes are classes, and what moves, moves without a script."""

import math
from collections.abc import Iterable, Iterator, Sequence
from html import escape

import numpy as np

from kurbel.arrays import ComplexArray
from kurbel.pictures.picture import MOMENTS_PER_TURN, Body, Curve, Panel, Picture, Shape
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
from kurbel.render.style import picture_css
from kurbel.render.text import folded, subscripts, width

# lengths in points from the upper left corner
PAPER_SIZES = Medium(
    letter=5.8, line=12.0, dot=4.0, grain=(4.0, 4.0), covering=40.0, shortest=110.0, tallest=460.0
)
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
_NAMED, _SHORTEST = 11.0, 2.0
"""How far the name of an arrow is from its end; length below which it has none, where it does not move."""
_STRAIGHT = 0.1
"""How far a point that is left out may be from the line between its neighbours."""
_POINTS = {"joint": ("o", 4.0), "fixed": ("i", 4.0), "beads": ("i", 1.6), "pole": ("i", 3.0)}
"""Kind of curves that are points -> their look and radius."""
_FIGURES = (0, 0), (4, 45), (3, 30), (4, 0), (3, 90), (6, 0), (5, 54)
"""Corners and turn of the figures that mark points, the first a circle. Seven of them and six colours."""

LegendRow = list[tuple[str, float, int | None]]
"""Texts above a panel, each with its left end, and the number of the stroke before it, if any."""


def svg_file(pictures: Iterable[Picture], look: Look, paper: bool = False) -> str:
    """Return a file with pictures one below the other; paper: as what can neither be dark nor move."""
    height, parts, texts = 0.0, "", []
    for picture in pictures:
        tall, items = _drawn(picture, look, paper)
        texts.append(picture_text(picture, look))
        parts += f'<g transform="translate(0 {height:g})">\n{items}</g>\n'
        height += tall
    return _svg(parts, WIDTH, height, 8.0, " ".join(texts), picture_css(paper))


def svg(picture: Picture, look: Look) -> str:
    """Return a picture as a part of a page that has the style sheet, and its heading."""
    tall, items = _drawn(picture, look, False, headed=False)
    return _svg(items, WIDTH, tall, 1.0, picture_text(picture, look))


def poster_svg(panel: Panel, look: Look, wide: bool) -> str:
    """Return a panel alone, as it is on a sheet of paper, wide or tall, with fine lines and small texts."""
    room, tallest = _POSTER if wide else _POSTER[::-1]
    frame = PanelFrame(panel, look, PAPER_SIZES._replace(tallest=tallest), room, tallest)
    tall = frame.tall + 30.0 + 15.0 * len(_footnote(frame))
    return _svg(
        "".join(_panel(frame, 0.0, True, ())), room, tall, 6.0, panel.title, picture_css(paper=True)
    )


def _svg(items: str, wide: float, tall: float, margin: float, title: str, style: str = "") -> str:
    """Return an element with its title; style: of a file of its own."""
    box = f"{-margin:g} {-margin:g} {wide + 2 * margin:g} {tall + 2 * margin:g}"
    if style:
        size = f'width="{wide + 2 * margin:g}" height="{tall + 2 * margin:g}"'
        head = f'<svg xmlns="http://www.w3.org/2000/svg" {size}'
        items = f"<style>{style}</style>\n{items}"
    else:
        head = "<svg"
    return f'{head} class="s" viewBox="{box}" role="img">\n<title>{escape(title)}</title>\n{items}</svg>\n'


def _drawn(picture: Picture, look: Look, paper: bool, headed: bool = True) -> tuple[float, str]:
    """Return the height of a picture and its items; headed: with its heading."""
    heading = folded(look.text(picture.heading), int(WIDTH / _BOLD)) if headed else []
    items = "".join(
        _text((16 + 17 * number) * 1j, text, "h") for number, text in enumerate(heading)
    )
    below, last = 7.0 * headed + 17 * len(heading), len(picture.panels) - 1
    top, tall = below, _TALL if len(picture.panels) < 3 else _SHORT
    for number, panel in enumerate(picture.panels):
        column = number % picture.across
        # what is alone in the last row has all of it
        each = (
            WIDTH
            if number == last and column == 0
            else (WIDTH + _GUTTER) / picture.across - _GUTTER
        )
        if number and column == 0:
            top = below + 4
        left, right, above, under = (
            (0.0, 0.0, 18.0, 8.0) if panel.plain else (48.0, 12.0, 20.0, 18.0)
        )
        frame = PanelFrame(panel, look, PAPER_SIZES, each - left - right, tall)
        legend = [] if panel.plain else _legend(frame, left)
        above += 14 * len(legend)
        under += 12 * len(frame.below) + (
            18.0 + 15.0 * len(_footnote(frame)) if panel.footnote else 0.0
        )
        corner = f"{column * (each + _GUTTER) + left:g} {top + above:g}"
        items += f'<g transform="translate({corner})">\n{"".join(_panel(frame, left, paper, legend))}</g>\n'
        below = max(below, top + above + frame.tall + under)
    for number, (name, mark) in enumerate(picture.legend):
        place = complex(12 + number % 4 * (WIDTH - 12) / 4, below + 18 + number // 4 * 16)
        items += _shape(f"c{mark % LOOKS}", _dot(place - 4j, mark)) + _text(
            place + 9, symbol(name, look)
        )
    return below + 4 + (-(-len(picture.legend) // 4) * 16 + 8 if picture.legend else 0), items


def _panel(
    frame: PanelFrame, left: float, paper: bool, legend: Sequence[LegendRow]
) -> Iterator[str]:
    """Yield what is on a panel, from below to above; what moves twice, in motion and at rest.

    left: the room at its left.
    """
    panel, look = frame.panel, frame.look
    if not panel.plain:
        yield from _around(frame, left, legend)
    for shade in panel.shades:
        low, high = (thinned(frame.place(shade.x, line)) for line in (shade.low, shade.high))
        # bars are all that there is to see; areas are behind their curves
        gain, loss = ("p", "n") if panel.curves else ("c0", "c1")
        yield _shape(gain if shade.gain else loss, _path(np.append(low, high[::-1])) + "Z")
    yield from (_body(frame, body, paper) for body in panel.bodies)
    moving, resting = "", _text(-5j, look.text(panel.title), "note") if panel.plain else ""
    for curve, number in zip(panel.curves, looks_of(panel)):
        if curve.x.ndim == 1 or paper:
            yield _curve(frame, curve.at_moment(0), number)
        else:  # forces alone move
            moving += _arrow(frame, [curve.at_moment(moment) for moment in range(len(curve.x))])
            resting += _arrow(frame, [curve.at_moment(0)])
    if moving or (not paper and any(body.moves for body in panel.bodies)):
        resting = f'<g class="moving">{moving}</g>\n<g class="still">{resting}</g>\n'
    yield resting
    labels = frame.labels(named=False)
    yield from (
        _shape("f", _path(np.array([one.point, one.lead])))
        for one in labels
        if one.lead is not None
    )
    yield from (
        _shape("o", _dot(complex(frame.place(mark.x, mark.y)), 0, 2.6)) for mark in panel.marks
    )
    clear = -math.inf if panel.plain else _CLEAR  # of the axis
    for label in labels:
        yield _text(complex(max(label.left, clear), label.top + 9.5), label.text, "halo")
    for caption in panel.captions:
        place = complex(frame.place(caption.place.real, caption.place.imag)) + 4.5j
        yield _text(
            place,
            look.text(caption.text),
            "mark strong" if caption.strong else "mark note",
            "middle",
        )
    if panel.footnote:
        yield from _below(frame)


def _body(frame: PanelFrame, body: Body, paper: bool) -> str:
    """Return shapes that move together, at rest and, unless on paper, also in motion."""
    places, scale = frame.place(body.place.real, body.place.imag), frame.points_per_unit
    # on the page y counts downward, so that angles turn the other way
    turn, moved = -body.turn, places - places[0]
    # what turns on and on ends a turn later
    turned = turn[1] + 360.0 * round(float(turn[-1] - turn[1]) / 360.0) if len(turn) > 1 else 0.0
    steps = (
        ("scale", [f"{_number(one, 4)} 1" for one in body.stretch], "1 1", ""),
        ("rotate", [_number(one, 2) for one in turn], "0", _number(turned, 2)),
        # from where it rests, which has fewer digits
        ("translate", [_both(one) for one in moved], "0 0", ""),
    )
    tints, shapes = (
        [_number(one, 2) for one in body.tint],
        "".join(_part(shape, scale) for shape in body.shapes),
    )

    def drawn(animated: bool) -> str:
        found = shapes
        for kind, texts, nothing, last in steps:
            if set(texts if animated else texts[:1]) != {nothing}:
                moves = (
                    _animated(f'Transform attributeName="transform" type="{kind}"', texts, last)
                    if animated
                    else ""
                )
                found = f'<g transform="{kind}({texts[0]})">{moves}{found}</g>'
        tint, fades = "", ""
        if set(tints) != {"1"}:
            tint, fades = (
                f' opacity="{tints[0]}"',
                _animated(' attributeName="opacity"', tints) if animated else "",
            )
        return f'<g transform="translate({_both(places[0])})"{tint}>{fades}{found}</g>\n'

    if paper or not body.moves:
        return drawn(False)
    return f'<g class="moving">{drawn(True)}</g>\n<g class="still">{drawn(False)}</g>\n'


def _part(shape: Shape, scale: float) -> str:
    points, radius = shape.points.conj() * scale, shape.radius * scale
    if radius:
        x, y = _both(points[0]).split()
        return f'<circle class="{shape.look}" cx="{x}" cy="{y}" r="{_number(radius)}"/>'
    return f'<path class="{shape.look}" d="{_path(points)}{"z" if len(points) > 2 else ""}"/>'


def _below(frame: PanelFrame) -> Iterator[str]:
    """Yield a bar of a round length, and what of the picture is to scale."""
    scale, top = frame.points_per_unit, frame.tall + 22.0
    power = 10.0 ** math.floor(math.log10(_LONGEST_BAR / scale))
    length = next(one * power for one in (5.0, 2.0, 1.0) if one * power * scale <= _LONGEST_BAR)
    end = length * scale
    yield _shape("thin", f"M0 {top - 3:g}v6m0-3h{end:.1f}m0-3v6")
    yield _text(
        complex(end + 7.0, top + 4.0), f"{length:g} {frame.look.unit(frame.panel.x.unit)}", "note"
    )
    for number, line in enumerate(_footnote(frame)):
        yield _text(complex(frame.wide, top + 4.0 + 15.0 * number), line, "note", "end")


def _footnote(frame: PanelFrame) -> list[str]:
    """Return the lines of the footnote at the right of the bar."""
    return folded(frame.look.text(frame.panel.footnote), int((frame.wide - 190.0) / _NOTE))


def _legend(frame: PanelFrame, left: float) -> list[LegendRow]:
    """Return what is above a panel: its title, what runs upward, and of several curves each with its stroke."""
    panel, look = frame.panel, frame.look
    named = [
        (curve, number)
        for curve, number in zip(panel.curves, looks_of(panel))
        if curve.kind == "line"
    ]
    texts: list[tuple[str, int | None]] = [
        (look.text(panel.title), None),
        (axis_text(panel.y, look), None),
    ]
    texts += (
        [(legend_text(curve.name, look), number) for curve, number in named]
        if len(named) > 1
        else []
    )
    rows, at = list[LegendRow](), math.inf
    for text, number in texts:
        wide = PAPER_SIZES.letter * width(text) + (0 if number is None else 30)
        if text and at + wide > frame.wide + 12:
            rows.append([])
            at = -left
        if text:
            rows[-1].append((text, at, number))
            at += wide + 18
    return rows


def _around(frame: PanelFrame, left: float, legend: Sequence[LegendRow]) -> Iterator[str]:
    """Yield thin lines with their values, what runs along the axes, and above which stroke is which quantity."""
    wide, tall = frame.wide, frame.tall
    across = frame.ticks_across(max(3, int(wide / 64)), -left, wide + 8)
    up = ticks(frame.y, int(tall / 30), frame.look)
    lines = [_path(np.array([place, place + 1j * tall])) for place, _, _ in across]
    lines += [_path(np.array([1j * place, wide + 1j * place])) for place, _ in up]
    yield _shape("g", "".join(lines)) + _shape(
        "x", _path(np.array([0.0, 1j * tall, wide + 1j * tall]))
    )
    yield from (_text(complex(start, tall + 14), text) for _, start, text in across if text)
    yield from (_text(complex(-6, place + 3.5), text, anchor="end") for place, text in up)
    yield from (
        _text(complex(wide, tall + 27 + 12 * k), text, anchor="end")
        for k, text in enumerate(frame.below)
    )
    for k, row in enumerate(reversed(legend)):
        base = -1j * (10 + 14 * k)
        for text, at, number in row:
            if number is not None:
                yield _shape(f"k{number}", _path(np.array([at, at + 26]) + base - 4j))
            yield _text(at + base + (0 if number is None else 30), text)


def _curve(frame: PanelFrame, curve: Curve, number: int) -> str:
    """Return a curve that does not move; number: of its colour and stroke."""
    if curve.kind in ("arrow", "force"):
        return _arrow(frame, [curve])
    pieces = [frame.place(*piece) for piece in curve.pieces()]
    if curve.kind in _POINTS:
        look, radius = _POINTS[curve.kind]
        return _shape(look, "".join(_dot(point, 0, radius) for point in pieces[0]))
    lines = "".join(_path(thinned(piece)) for piece in pieces)
    if curve.kind == "line":
        jumps = "".join(_path(frame.place(*jump)) for jump in curve.jumps())
        return _shape(f"k{number}", lines) + (_shape(f"j{number}", jumps) if jumps else "")
    if curve.kind == "dots":
        figure = number if curve.look is None else curve.look
        dots = "".join(_dot(point, figure) for piece in pieces for point in piece)
        return _shape(f"j{number}", lines) + _shape(f"c{number}", dots)
    return _shape({"member": "m", "block": "b"}.get(curve.kind, "f"), lines)


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
        paths.append(_path(np.array([*(side + half), tip, *(side - half)[::-1]])) + "Z")
        # a force is named at its end away from the shaft, where nothing else is
        inward = force and np.hypot(curve.x[0], curve.y[0]) > np.hypot(curve.x[1], curve.y[1])
        names.append((tail - _NAMED * along if inward else tip + _NAMED * along) + 3.5j)
    name, look = symbol(moments[0].name, frame.look), "halo force" if force else "halo"
    return _shape("c0" if force else "c1", *paths) + _text(names[0], name, look, "middle", names)


def thinned(places: ComplexArray) -> ComplexArray:
    """Return places x + iy (n,) without those that are on a straight line between their neighbours."""
    for parity in (0, 1) * 6:  # of neighbours every other one
        if len(places) < 3:
            break
        off, chord = places[1:-1] - places[:-2], places[2:] - places[:-2]
        share = np.clip((off * chord.conj()).real / np.maximum(np.abs(chord) ** 2, 1e-12), 0.0, 1.0)
        kept = np.abs(off - share * chord) > _STRAIGHT
        kept[parity::2] = True
        places = places[np.concatenate(([True], kept, [True]))]
    return places


def _path(places: ComplexArray) -> str:
    rounded = np.round(places, 1)
    steps = (np.round(np.diff(rounded), 1) + 0.0).tolist()  # a call for each point would take long
    return f"M{_both(rounded[0])}{'l' if steps else ''}{' '.join([f'{step.real:g} {step.imag:g}' for step in steps])}"


def _dot(middle: complex, figure: int, radius: float = 2.4) -> str:
    """Return the path of a point, as a circle or another figure."""
    corners, turn = _FIGURES[figure % len(_FIGURES)]
    if corners:
        around = np.exp(1j * np.radians(turn + 360.0 / corners * np.arange(corners)))
        return _path(middle + 1.4 * radius * around) + "Z"
    r, across = f"{radius:g}", f"{2 * radius:g}"
    return f"M{_both(middle - radius)}a{r} {r} 0 1 0 {across} 0a{r} {r} 0 1 0-{across} 0Z"


def _shape(look: str, *paths: str) -> str:
    """Return a path, the first one at rest, or at all of which it is in turn."""
    moves = _animated(' attributeName="d"', paths)
    return f'<path class="{look}" d="{paths[0]}"{f">{moves}</path>" if moves else "/>"}\n'


def _text(
    place: complex, text: str, look: str = "", anchor: str = "", loop: Sequence[complex] = ()
) -> str:
    """Return a text with its subscripts; loop: the places through which it moves."""
    first, *following = subscripts(text)
    words = escape(first)
    for below, rest in zip(following[::2], following[1::2]):
        words += f'<tspan dy="2" font-size="80%">{escape(below)}</tspan>'
        words += f'<tspan dy="-2">{escape(rest)}</tspan>' if rest else ""
    moves = _animated(' attributeName="x"', [_number(one.real) for one in loop])
    moves += _animated(' attributeName="y"', [_number(one.imag) for one in loop])
    attributes = (f' class="{look}"' if look else "") + (
        f' text-anchor="{anchor}"' if anchor else ""
    )
    return f'<text{attributes} x="{_number(place.real)}" y="{_number(place.imag)}">{words}{moves}</text>\n'


def _animated(what: str, values: Sequence[str], last: str = "") -> str:
    """Return the movement through values, the first of which is at rest, and round again; last: where a loop ends."""
    loop = values[1:]
    if len(set(loop)) < 2:
        return ""
    around, seconds = ";".join((*loop, last or loop[0])), len(loop) / MOMENTS_PER_TURN * _SECONDS
    return f'<animate{what} dur="{seconds:g}s" repeatCount="indefinite" values="{around}"/>'


def _both(place: complex) -> str:
    return f"{_number(place.real)} {_number(place.imag)}"


def _number(value: float, decimals: int = 1) -> str:
    return f"{round(value, decimals) + 0.0:g}"
