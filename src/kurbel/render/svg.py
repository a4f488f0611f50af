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
    panel_title,
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
_MARGIN = 8.0
"""Around the pictures of a file."""
_TALL, _SHORT = 250.0, 170.0
"""Height of a panel among at most two and of one among several."""
_TALL_ROW = 340.0
"""Height of a row of panels from which on it takes more room in print than others."""
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
        tall, items = _drawn(picture, look, paper, panel_height(picture))
        texts.append(picture_text(picture, look))
        parts += f'<g transform="translate(0 {height:g})">\n{items}</g>\n'
        height += tall
    return _svg(parts, WIDTH, height, _MARGIN, " ".join(texts), picture_css(paper))


def svg_rows(picture: Picture, look: Look) -> Iterator[str]:
    """Yield the rows of a picture as parts of a page that has the style sheet, and its heading.

    Between two of them a page of paper may end.
    """
    height = panel_height(picture)
    for row in picture.rows:
        tall, items = _drawn(row, look, False, height, headed=False)
        look_of_row = "s tall" if tall > _TALL_ROW else "s"
        yield _svg(items, WIDTH, tall, 1.0, picture_text(row, look), name=look_of_row)


def sheet_svg(picture: Picture, look: Look, height: float, medium: Medium) -> tuple[float, str]:
    """Return height over width of a picture as it is on paper, and its file; height: of its panels."""
    tall, items = _drawn(picture, look, True, height, medium=medium)
    title = picture_text(picture, look)
    drawn = _svg(items, WIDTH, tall, _MARGIN, title, picture_css(paper=True))
    return float(tall + 2 * _MARGIN) / (WIDTH + 2 * _MARGIN), drawn


def poster_svg(panel: Panel, look: Look, wide: bool) -> str:
    """Return a panel alone, as it is on a sheet of paper, wide or tall, with fine lines and small texts."""
    room, tallest = _POSTER if wide else _POSTER[::-1]
    frame = PanelFrame(panel, look, PAPER_SIZES._replace(tallest=tallest), room, tallest)
    items = "".join(_panel(frame, 0.0, True, ()))
    tall = frame.tall + 30.0 + 15.0 * len(_footnote(frame))
    return _svg(items, room, tall, 6.0, panel.title, picture_css(paper=True))


def _svg(
    items: str,
    wide: float,
    tall: float,
    margin: float,
    title: str,
    style: str = "",
    name: str = "s",
) -> str:
    """Return an element with its title; style: of a file of its own; name: of its class."""
    box = f"{-margin:g} {-margin:g} {wide + 2 * margin:g} {tall + 2 * margin:g}"
    if style:
        size = f'width="{wide + 2 * margin:g}" height="{tall + 2 * margin:g}"'
        head = f'<svg xmlns="http://www.w3.org/2000/svg" {size}'
        items = f"<style>{style}</style>\n{items}"
    else:
        head = "<svg"
    return f'{head} class="{name}" viewBox="{box}" role="img">\n<title>{escape(title)}</title>\n{items}</svg>\n'


def panel_height(picture: Picture) -> float:
    """Return the height of the panels of a picture, without what is around them."""
    return _TALL if len(picture.panels) < 3 else _SHORT


def _drawn(
    picture: Picture,
    look: Look,
    paper: bool,
    panel_height: float,
    headed: bool = True,
    medium: Medium = PAPER_SIZES,
) -> tuple[float, str]:
    """Return the height of a picture and its items; headed: with its heading.

    panel_height: that of its panels, but of those whose axes have one scale.
    """
    heading = folded(look.text(picture.heading), int(WIDTH / _BOLD)) if headed else []
    items = ""
    for number, text in enumerate(heading):
        items += _text((16 + 17 * number) * 1j, text, "h")
    bottom = 17.0 * len(heading) + (7.0 if headed else 0.0)

    # the panels, row by row
    top = bottom
    column_width = (WIDTH + _GUTTER) / picture.across - _GUTTER
    last = len(picture.panels) - 1
    for number, panel in enumerate(picture.panels):
        column = number % picture.across
        begins_a_row = column == 0
        is_alone_in_its_row = begins_a_row and number == last
        if begins_a_row and number:
            top = bottom + 4
        panel_width = WIDTH if is_alone_in_its_row else column_width
        left = column * (column_width + _GUTTER)
        panel_items, height = _placed(
            panel, look, paper, left, top, panel_width, panel_height, medium
        )
        items += panel_items
        bottom = max(bottom, top + height)

    # what the marks mean, four in a line
    for number, (name, mark) in enumerate(picture.legend):
        line, place_in_line = divmod(number, 4)
        spot = complex(12 + place_in_line * (WIDTH - 12) / 4, bottom + 18 + 16 * line)
        items += _shape(f"c{mark % LOOKS}", _dot(spot - 4j, mark))
        items += _text(spot + 9, symbol(name, look))
    height = bottom + 4
    if picture.legend:
        lines = math.ceil(len(picture.legend) / 4)
        height += 16 * lines + 8
    return height, items


def _placed(
    panel: Panel,
    look: Look,
    paper: bool,
    left: float,
    top: float,
    wide: float,
    tall: float,
    medium: Medium,
) -> tuple[str, float]:
    """Return a panel at its place in the picture, and the height that it takes with what is around it."""
    room_left, room_right, room_above, room_below = 48.0, 12.0, 20.0, 18.0
    if panel.plain:
        room_left, room_right, room_above, room_below = 0.0, 0.0, 18.0, 8.0
    frame = PanelFrame(panel, look, medium, wide - room_left - room_right, tall)
    legend = [] if panel.plain else _legend(frame, room_left)
    room_above += 14 * len(legend)
    room_below += 12 * len(frame.below)
    if panel.footnote:
        room_below += 18.0 + 15.0 * len(_footnote(frame))
    corner = f"{left + room_left:g} {top + room_above:g}"
    inner = "".join(_panel(frame, room_left, paper, legend))
    items = f'<g transform="translate({corner})">\n{inner}</g>\n'
    return items, room_above + frame.tall + room_below


def _panel(
    frame: PanelFrame, left: float, paper: bool, legend: Sequence[LegendRow]
) -> Iterator[str]:
    """Yield what is on a panel, from below to above; what moves twice, in motion and at rest.

    left: the room at its left.
    """
    panel, look = frame.panel, frame.look
    if not panel.plain:
        yield from _around(frame, left, legend)

    # bars are all that there is to see; areas are behind their curves
    gain_look, loss_look = ("p", "n") if panel.curves else ("c0", "c1")
    for shade in panel.shades:
        low = thinned(frame.place(shade.x, shade.low))
        high = thinned(frame.place(shade.x, shade.high))
        shade_look = gain_look if shade.gain else loss_look
        yield _shape(shade_look, _path(np.append(low, high[::-1])) + "Z")
    for body in panel.bodies:
        yield _body(frame, body, paper)

    # curves, and forces, which alone move
    moving = ""
    resting = _text(-5j, panel_title(panel, look), "note") if panel.plain else ""
    for curve, number in zip(panel.curves, looks_of(panel)):
        is_at_rest = curve.x.ndim == 1 or paper
        if is_at_rest:
            yield _curve(frame, curve.at_moment(0), number)
        else:
            moments = [curve.at_moment(moment) for moment in range(len(curve.x))]
            moving += _arrow(frame, moments)
            resting += _arrow(frame, moments[:1])
    bodies_move = not paper and any(body.moves for body in panel.bodies)
    if moving or bodies_move:
        resting = f'<g class="moving">{moving}</g>\n<g class="still">{resting}</g>\n'
    yield resting

    # marked points, with labels that keep clear of the upright axis
    labels = frame.labels(named=False)
    for label in labels:
        if label.lead is not None:
            yield _shape("f", _path(np.array([label.point, label.lead])))
    for mark in panel.marks:
        yield _shape("o", _dot(complex(frame.place(mark.x, mark.y)), 0, 2.6))
    leftmost = -math.inf if panel.plain else _CLEAR
    for label in labels:
        yield _text(complex(max(label.left, leftmost), label.top + 9.5), label.text, "halo")
    for caption in panel.captions:
        spot = complex(frame.place(caption.place.real, caption.place.imag)) + 4.5j
        caption_look = "mark strong" if caption.strong else "mark note"
        yield _text(spot, look.text(caption.text), caption_look, "middle")
    if panel.footnote:
        yield from _below(frame)


def _body(frame: PanelFrame, body: Body, paper: bool) -> str:
    """Return shapes that move together, at rest and, unless on paper, also in motion."""
    resting = _body_at_rest(frame, body)
    if paper or not body.moves:
        return resting
    moving = _moving_body(frame, body)
    return f'<g class="moving">{moving}</g>\n<g class="still">{resting}</g>\n'


def _steps(frame: PanelFrame, body: Body) -> list[tuple[str, list[str], str, str]]:
    """Return kind, values, the value that changes nothing, and the last value of each step of a movement."""
    centres = frame.place(body.place.real, body.place.imag)
    # the places from where it rests, which have fewer digits
    displacements = centres - centres[0]
    # on the page y counts downward, so that angles turn the other way
    turn = -body.turn
    # what turns on and on ends a turn later
    last_turn = 0.0
    if len(turn) > 1:
        full_turns = round(float(turn[-1] - turn[1]) / 360.0)
        last_turn = turn[1] + 360.0 * full_turns
    return [
        ("scale", [f"{_number(stretch, 4)} 1" for stretch in body.stretch], "1 1", ""),
        ("rotate", [_number(angle, 2) for angle in turn], "0", _number(last_turn, 2)),
        ("translate", [_both(displacement) for displacement in displacements], "0 0", ""),
    ]


def _shapes(frame: PanelFrame, body: Body) -> str:
    return "".join(_part(shape, frame.points_per_unit) for shape in body.shapes)


def _body_at_rest(frame: PanelFrame, body: Body) -> str:
    items = _shapes(frame, body)
    for kind, values, neutral, _ in _steps(frame, body):
        if values[0] != neutral:
            items = f'<g transform="{kind}({values[0]})">{items}</g>'
    return _body_in_place(frame, body, items)


def _moving_body(frame: PanelFrame, body: Body) -> str:
    items = _shapes(frame, body)
    for kind, values, neutral, last in _steps(frame, body):
        if set(values) != {neutral}:
            movement = f'Transform attributeName="transform" type="{kind}"'
            animation = _animated(movement, values, last)
            items = f'<g transform="{kind}({values[0]})">{animation}{items}</g>'
    fading = _animated(' attributeName="opacity"', _tints(body)) if _is_tinted(body) else ""
    return _body_in_place(frame, body, f"{fading}{items}")


def _tints(body: Body) -> list[str]:
    return [_number(tint, 2) for tint in body.tint]


def _is_tinted(body: Body) -> bool:
    return set(_tints(body)) != {"1"}


def _body_in_place(frame: PanelFrame, body: Body, items: str) -> str:
    centre = complex(frame.place(body.place.real, body.place.imag)[0])
    opacity = f' opacity="{_tints(body)[0]}"' if _is_tinted(body) else ""
    return f'<g transform="translate({_both(centre)})"{opacity}>{items}</g>\n'


def _part(shape: Shape, scale: float) -> str:
    points = shape.points.conj() * scale
    radius = shape.radius * scale
    if radius:
        x, y = _both(points[0]).split()
        return f'<circle class="{shape.look}" cx="{x}" cy="{y}" r="{_number(radius)}"/>'
    closing = "z" if len(points) > 2 else ""
    return f'<path class="{shape.look}" d="{_path(points)}{closing}"/>'


def _below(frame: PanelFrame) -> Iterator[str]:
    """Yield a bar of a round length, and what of the picture is to scale."""
    scale = frame.points_per_unit
    top = frame.tall + 22.0

    # the longest of 1, 2 and 5 of a power of ten that has room
    power = 10.0 ** math.floor(math.log10(_LONGEST_BAR / scale))
    length = next(step * power for step in (5.0, 2.0, 1.0) if step * power * scale <= _LONGEST_BAR)
    end = length * scale
    yield _shape("thin", f"M0 {top - 3:g}v6m0-3h{end:.1f}m0-3v6")
    unit = frame.look.unit(frame.panel.x.unit)
    yield _text(complex(end + 7.0, top + 4.0), f"{length:g} {unit}", "note")
    for number, line in enumerate(_footnote(frame)):
        yield _text(complex(frame.wide, top + 4.0 + 15.0 * number), line, "note", "end")


def _footnote(frame: PanelFrame) -> list[str]:
    """Return the lines of the footnote at the right of the bar."""
    return folded(frame.look.text(frame.panel.footnote), int((frame.wide - 190.0) / _NOTE))


def _legend(frame: PanelFrame, left: float) -> list[LegendRow]:
    """Return what is above a panel: its title, what runs upward, and of several curves each with its stroke."""
    panel, look = frame.panel, frame.look
    texts: list[tuple[str, int | None]] = [
        (panel_title(panel, look), None),
        (axis_text(panel.y, look), None),
    ]
    lines = [pair for pair in zip(panel.curves, looks_of(panel)) if pair[0].kind == "line"]
    if len(lines) > 1:
        texts += [(legend_text(curve.name, look), number) for curve, number in lines]

    # as many in a row as fit
    rows: list[LegendRow] = []
    start = math.inf
    for text, number in texts:
        if not text:
            continue
        stroke_width = 0 if number is None else 30
        text_width = PAPER_SIZES.letter * width(text) + stroke_width
        if start + text_width > frame.wide + 12:
            rows.append([])
            start = -left
        rows[-1].append((text, start, number))
        start += text_width + 18
    return rows


def _around(frame: PanelFrame, left: float, legend: Sequence[LegendRow]) -> Iterator[str]:
    """Yield thin lines with their values, what runs along the axes, and above which stroke is which quantity."""
    wide, tall = frame.wide, frame.tall

    # thin lines, and the axes
    across = frame.ticks_across(max(3, int(wide / 64)), -left, wide + 8)
    up = ticks(frame.y, int(tall / 30), frame.look)
    lines = [_path(np.array([x, x + 1j * tall])) for x, _, _ in across]
    lines += [_path(np.array([1j * y, wide + 1j * y])) for y, _ in up]
    yield _shape("g", "".join(lines))
    yield _shape("x", _path(np.array([0.0, 1j * tall, wide + 1j * tall])))

    # their values, and the name of what runs across
    for _, start, text in across:
        if text:
            yield _text(complex(start, tall + 14), text)
    for y, text in up:
        yield _text(complex(-6, y + 3.5), text, anchor="end")
    for line_number, text in enumerate(frame.below):
        yield _text(complex(wide, tall + 27 + 12 * line_number), text, anchor="end")

    # the legend, its last row next to the panel
    for row_number, row in enumerate(reversed(legend)):
        base = -1j * (10 + 14 * row_number)
        for text, start, number in row:
            if number is None:
                yield _text(start + base, text)
            else:
                yield _shape(f"k{number}", _path(np.array([start, start + 26]) + base - 4j))
                yield _text(start + base + 30, text)


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
        jump_shape = _shape(f"j{number}", jumps) if jumps else ""
        return _shape(f"k{number}", lines) + jump_shape
    if curve.kind == "dots":
        figure = number if curve.look is None else curve.look
        dots = ""
        for piece in pieces:
            dots += "".join(_dot(point, figure) for point in piece)
        return _shape(f"j{number}", lines) + _shape(f"c{number}", dots)
    look = {"member": "m", "block": "b", "cycles": "q"}.get(curve.kind, "f")
    return _shape(look, lines)


def _arrow(frame: PanelFrame, moments: Sequence[Curve]) -> str:
    """Return an arrow with its name, through all moments of its movement, or at its only one."""
    is_force = moments[0].kind == "force"
    paths: list[str] = []
    name_places: list[complex] = []
    for curve in moments:
        tail, tip = frame.place(curve.x, curve.y).tolist()
        length = abs(tip - tail)
        if len(moments) == 1 and length < _SHORTEST:
            return ""
        along = (tip - tail) / length if length else 0.0

        # half of the outline, from the tail to the barb; the other half is its mirror image
        neck = tip - min(9.0, length) * along
        half_widths = np.array([0.8, 0.8, 3.6]) * 1j * along
        middle_line = np.array([tail, neck, neck])
        outline = [*(middle_line + half_widths), tip, *(middle_line - half_widths)[::-1]]
        paths.append(_path(np.array(outline)) + "Z")

        # a force is named at its end away from the shaft, where nothing else is
        points_inward = np.hypot(curve.x[0], curve.y[0]) > np.hypot(curve.x[1], curve.y[1])
        if is_force and points_inward:
            name_places.append(tail - _NAMED * along + 3.5j)
        else:
            name_places.append(tip + _NAMED * along + 3.5j)
    name = symbol(moments[0].name, frame.look)
    arrow_look = "c0" if is_force else "c1"
    name_look = "halo force" if is_force else "halo"
    arrow = _shape(arrow_look, *paths)
    return arrow + _text(name_places[0], name, name_look, "middle", name_places)


def thinned(points: ComplexArray) -> ComplexArray:
    """Return places x + iy (n,) without those that are on a straight line between their neighbours."""
    # of neighbours every other one, the odd and the even ones in turn
    for parity in (0, 1) * 6:
        if len(points) < 3:
            break
        offset = points[1:-1] - points[:-2]
        chord = points[2:] - points[:-2]
        share = (offset * chord.conj()).real / np.maximum(np.abs(chord) ** 2, 1e-12)
        distance = np.abs(offset - np.clip(share, 0.0, 1.0) * chord)
        stays = distance > _STRAIGHT
        stays[parity::2] = True
        points = points[np.concatenate(([True], stays, [True]))]
    return points


def _path(points: ComplexArray) -> str:
    rounded = np.round(points, 1)
    # one call for all steps: one for each point would take long
    steps = (np.round(np.diff(rounded), 1) + 0.0).tolist()
    start = f"M{_both(rounded[0])}"
    if not steps:
        return start
    return f"{start}l{' '.join([f'{step.real:g} {step.imag:g}' for step in steps])}"


def _dot(middle: complex, figure: int, radius: float = 2.4) -> str:
    """Return the path of a point, as a circle or another figure."""
    corners, turn = _FIGURES[figure % len(_FIGURES)]
    if corners:
        around = np.exp(1j * np.radians(turn + 360.0 / corners * np.arange(corners)))
        return _path(middle + 1.4 * radius * around) + "Z"
    r = f"{radius:g}"
    diameter = f"{2 * radius:g}"
    start = _both(middle - radius)
    return f"M{start}a{r} {r} 0 1 0 {diameter} 0a{r} {r} 0 1 0-{diameter} 0Z"


def _shape(look: str, *paths: str) -> str:
    """Return a path, the first one at rest, or at all of which it is in turn."""
    animation = _animated(' attributeName="d"', paths)
    end = f">{animation}</path>" if animation else "/>"
    return f'<path class="{look}" d="{paths[0]}"{end}\n'


def _text(
    point: complex, text: str, look: str = "", anchor: str = "", loop: Sequence[complex] = ()
) -> str:
    """Return a text with its subscripts; loop: the places through which it moves."""
    first, *following = subscripts(text)
    words = escape(first)
    for subscript, rest in zip(following[::2], following[1::2]):
        words += f'<tspan dy="2" font-size="80%">{escape(subscript)}</tspan>'
        if rest:
            words += f'<tspan dy="-2">{escape(rest)}</tspan>'

    animation = _animated(' attributeName="x"', [_number(point.real) for point in loop])
    animation += _animated(' attributeName="y"', [_number(point.imag) for point in loop])
    attributes = f' class="{look}"' if look else ""
    if anchor:
        attributes += f' text-anchor="{anchor}"'
    attributes += f' x="{_number(point.real)}" y="{_number(point.imag)}"'
    return f"<text{attributes}>{words}{animation}</text>\n"


def _animated(what: str, values: Sequence[str], last: str = "") -> str:
    """Return the movement through values, the first of which is at rest, and round again; last: where a loop ends."""
    loop = values[1:]
    if len(set(loop)) < 2:
        return ""
    around = ";".join((*loop, last or loop[0]))
    seconds = len(loop) / MOMENTS_PER_TURN * _SECONDS
    return f'<animate{what} dur="{seconds:g}s" repeatCount="indefinite" values="{around}"/>'


def _both(point: complex) -> str:
    return f"{_number(point.real)} {_number(point.imag)}"


def _number(value: float, decimals: int = 1) -> str:
    return f"{round(value, decimals) + 0.0:g}"
