"""A scene as SVG: text stays text, colours and strokes are classes, and what moves, moves without a script."""

from collections.abc import Iterator
from html import escape

from kurbel.render import Look
from kurbel.render.pictures.scene import Dots, Item, Places, Scene, Text
from kurbel.render.pictures.style import css
from kurbel.report.pictures.picture import Picture


def svg_file(pictures: list[Picture], look: Look) -> Iterator[str]:
    """Yield a file with pictures one below the other."""
    from kurbel.render.pictures.layout import scene

    scenes = [scene(picture, look) for picture in pictures]
    wide, tall = max(one.width for one in scenes), sum(one.height for one in scenes)
    words = " ".join(one.words for one in scenes)
    yield (
        f'<svg xmlns="http://www.w3.org/2000/svg" class="s" viewBox="0 0 {wide:g} {tall:g}" width="{wide:g}" '
        f'height="{tall:g}" role="img">\n<title>{escape(words)}</title>\n<style>{css()}</style>\n'
    )
    top = 0.0
    for one in scenes:
        yield f'<g transform="translate(0 {top:g})">\n'
        yield from _items(one)
        yield "</g>\n"
        top += one.height
    yield "</svg>\n"


def svg(scene: Scene) -> str:
    """Return a scene as a part of a page that has the style sheet."""
    head = f'<svg class="s" viewBox="0 0 {scene.width:g} {scene.height:g}" role="img">'
    return f"{head}<title>{escape(scene.words)}</title>\n{''.join(_items(scene))}</svg>"


def _items(scene: Scene) -> Iterator[str]:
    """Yield what stands still, then what moves, and the same once more for those who want it still."""
    for item in scene.items:
        if not (item.frames or _of_one_moment(item)):
            yield _item(item, 0.0) + "\n"
    if scene.seconds:
        moving = (_item(item, scene.seconds) for item in scene.items if item.frames)
        yield f'<g class="moving">{"".join(moving)}</g>\n'
        still = (_item(item, 0.0) for item in scene.items if item.frames or _of_one_moment(item))
        yield f'<g class="still">{"".join(still)}</g>\n'


def _of_one_moment(item: Item) -> bool:
    return isinstance(item, Text) and item.still


def _item(item: Item, seconds: float) -> str:
    if isinstance(item, Text):
        return _text(item, seconds)
    if isinstance(item, Dots):
        return _dots(item, seconds)
    path = _path(item.parts, item.closed)
    moves = _moves("d", (_path(one, item.closed) for one in item.frames), seconds)
    style = ' style="stroke-dasharray:none"' if item.look.endswith(" solid") else ""
    return f'<path class="{item.look.removesuffix(" solid")}"{style} d="{path}"{f">{moves}</path>" if moves else "/>"}'


def _text(item: Text, seconds: float) -> str:
    anchor = "" if item.anchor == "start" else f' text-anchor="{item.anchor}"'
    halo = " halo" if item.halo else ""
    places = (("x", 0), ("y", 1))
    moves = "".join(_moves(name, (_number(one[place]) for one in item.frames), seconds) for name, place in places)
    where = f'x="{_number(item.x)}" y="{_number(item.y)}"'
    return f'<text class="{item.look}{halo}" {where}{anchor}>{_typeset(item)}{moves}</text>'


def _typeset(item: Text) -> str:
    """Return the words of a text with their subscripts lowered."""
    first, *following = item.levels
    text = escape(first)
    for below, rest in zip(following[::2], following[1::2]):
        text += f'<tspan dy="2" font-size="80%">{escape(below)}</tspan>'
        text += f'<tspan dy="-2">{escape(rest)}</tspan>' if rest else ""
    return text


def _dots(item: Dots, seconds: float) -> str:
    """Return circles; each moves by itself."""
    found = []
    for number, (x, y) in enumerate(item.places):
        moves = ""
        for name, part in (("cx", 0), ("cy", 1)):
            values = [_number(one[number][part]) for one in item.frames]
            moves += _moves(name, iter(values), seconds) if len(set(values)) > 1 else ""
        if item.corners:
            corners = tuple((x + item.radius * a, y + item.radius * b) for a, b in item.corners)
            found.append(f'<path class="{item.look}" d="{_path((corners,), True)}"/>')
            continue
        where = f'cx="{_number(x)}" cy="{_number(y)}" r="{item.radius:g}"'
        found.append(f'<circle class="{item.look}" {where}{f">{moves}</circle>" if moves else "/>"}')
    return "".join(found)


def _moves(attribute: str, values: Iterator[str], seconds: float) -> str:
    every = [*values]
    if not (every and seconds):
        return ""
    around = ";".join([*every, every[0]])
    return f'<animate attributeName="{attribute}" dur="{seconds:g}s" repeatCount="indefinite" values="{around}"/>'


def _path(parts: tuple[Places, ...], closed: bool) -> str:
    return "".join(
        f"M{'L'.join(f'{_number(x)} {_number(y)}' for x, y in part)}{'Z' if closed else ''}" for part in parts
    )


def _number(value: float) -> str:
    text = f"{value:.1f}"
    return text.removesuffix(".0") if text != "-0.0" else "0"
