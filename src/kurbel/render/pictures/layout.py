"""From a neutral picture to a scene: every panel gets its place, its axes, its lines and its labels."""

from collections.abc import Iterator

from kurbel.render import Look
from kurbel.render.pictures.labels import Box, figure_text, symbol
from kurbel.render.pictures.panel_items import panel_items
from kurbel.render.pictures.scale import Scale, scale_of, taller
from kurbel.render.pictures.scene import Dots, Item, Scene, Text
from kurbel.render.pictures.style import LOOKS, SHAPES
from kurbel.render.text import folded
from kurbel.report.pictures.picture import Panel, Picture

WIDTH = 720.0
_HEIGHT, _SHORT = 250.0, 170.0
_TALLEST, _LEAST = 460.0, 110.0
_TITLE, _BOLD = 24.0, 8.3
"""Height of a heading, and width of a character of it."""
SECONDS = 6.0
"""How long a moving mechanism takes for one cycle."""


def scene(picture: Picture, look: Look) -> Scene:
    """Return a picture laid out, in points."""
    heading = folded(look.charset.text(picture.heading), int((WIDTH - 16) / _BOLD))
    items: list[Item] = [Text(8.0, 16.0 + 17.0 * number, text, "h", plain=True) for number, text in enumerate(heading)]
    top = _TITLE + 17.0 * (len(heading) - 1)
    rows = [picture.panels[i : i + picture.across] for i in range(0, len(picture.panels), picture.across)]
    for row in rows:
        each = WIDTH / picture.across
        placed = [
            _placed(panel, Box(k * each, top, (k + 1) * each, top), len(picture.panels)) for k, panel in enumerate(row)
        ]
        for panel, frame, scales in placed:
            items += panel_items(panel, frame, scales, look)
        top = max(frame.bottom for _, frame, _ in placed) + 4
    legend = list(_legend(picture, top, look))
    top += legend[-1].y - top + 10 if legend and isinstance(legend[-1], Text) else 0.0
    items += legend
    moving = any(panel.frames for panel in picture.panels)
    return Scene(WIDTH, top, tuple(items), words_of(picture, look), SECONDS if moving else 0.0)


def _placed(panel: Panel, room: Box, count: int) -> tuple[Panel, Box, tuple[Scale, Scale]]:
    """Return a panel with its room, and its scales on paper; where both are one, the height follows from the width."""
    x, y = scale_of(panel, "x"), scale_of(panel, "y")
    left, right = (8.0, 8.0) if panel.plain else (58.0, 16.0)
    above, below = (18.0, 8.0) if panel.plain else (34.0, 30.0)
    across = room.right - room.left - left - right
    tall = _HEIGHT if count < 3 else _SHORT
    if panel.equal:
        y = taller(y, _LEAST / across * (x.high - x.low))
        tall = min(_TALLEST, across * (y.high - y.low) / (x.high - x.low))
        spare = across - tall * (x.high - x.low) / (y.high - y.low)
        left, across = left + spare / 2, across - spare
    frame = room._replace(bottom=room.top + above + tall + below)
    start = room.left + left
    return panel, frame, (x.reach(start, start + across), y.reach(room.top + above + tall, room.top + above))


def _legend(picture: Picture, top: float, look: Look) -> Iterator[Item]:
    """Yield what the marks of all panels stand for, in columns."""
    across = 4
    for number, (name, mark) in enumerate(picture.legend):
        left, base = 12 + number % across * (WIDTH - 12) / across, top + 14 + number // across * 16
        yield Dots(((left, base - 4),), f"c{mark % len(LOOKS)}", 3.0, corners=SHAPES[mark % len(SHAPES)])
        yield Text(left + 9, base, symbol(name, look))


def words_of(picture: Picture, look: Look) -> str:
    """Return a picture in words: what it shows, and every figure in it."""
    figures = [mark.figure for panel in picture.panels for mark in panel.marks]
    figures += [shade.figure for panel in picture.panels for shade in panel.shades if shade.figure]
    said = "; ".join(dict.fromkeys(figure_text(figure, look) for figure in figures))
    sentence = f"{look.charset.text(picture.heading)}. {look.charset.text(picture.text)}"
    return f"{sentence} {said}." if said else sentence
