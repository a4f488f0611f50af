"""The long report as one page of HTML: a first page, answers with pictures and tables, and the input last."""

import re
from collections.abc import Iterable, Iterator

from kurbel import __version__
from kurbel.render import Look
from kurbel.render.markup import Html, listed, of_places, over_angle, page, written
from kurbel.render.style import LONG_REPORT, MOVING, PAIRS, PICTURE, PICTURE_COLOURS, page_css
from kurbel.render.svg import svg
from kurbel.render.text import DIGITS
from kurbel.render.text_tables import TextTable, key_value_table, part_name, place_table, texts
from kurbel.report.picture import Answers, Document, Fact, Facts, Grid, Item, Notice, OverAngle, Pair, Picture, Shown
from kurbel.report.tables import PlaceTable, Provenance, Report

_OUT = Html()
_CLOSE = 5
"""Digits of a value next to its bound."""


def report_page(long: Document, look: Look, date: str) -> Iterator[str]:
    """Yield the page of a long report; date: as it is shown."""
    look = look._replace(format="html")
    pairs = PAIRS if len(long.provenance) > 1 else ""
    style = page_css(LONG_REPORT, pairs, PICTURE, PICTURE_COLOURS, MOVING)
    yield from page(look.text(long.title), _parts(long, look, date), style)


def _parts(long: Document, look: Look, date: str) -> Iterator[str]:
    """Yield title, first page, links, sections, and what it was made from."""
    yield f"<header>\n<h1>{_text(long.title, look)}</h1>\n"
    yield from (f'<p class="sub">{_prose(one, look)}</p>\n' for one in long.subtitles if one)
    yield '</header>\n<section id="summary" aria-label="Summary">\n'
    yield from (_item(one, look) for one in long.summary)
    links = "".join(f'<li><a href="#{one.id}">{_text(one.title, look)}</a></li>\n' for one in long.sections)
    yield f'</section>\n<nav aria-label="Contents">\n<ul>\n{links}</ul>\n</nav>\n'
    for section in long.sections:
        yield f'<section id="{section.id}">\n<h2>{_text(section.title, look)}</h2>\n'
        yield from (_item(one, look) for one in section.items)
        yield "</section>\n"
    yield f"<footer>\n<p>{_text(date, look)}, kurbel {__version__}</p>\n"
    for one in long.provenance:
        yield from listed("Made from", _made_from(one), look, _OUT)
    yield "</footer>\n"


def _made_from(given: Provenance) -> list[str]:
    files = [f"{one.file}: SHA-256 {one.sha256 or 'not known, the file is gone'}" for one in given.inputs]
    set_over = [f"set over it: {one}" for one in given.overrides]
    return files + set_over + [f"{name} {version}" for name, version in given.versions.items()]


def _item(item: Item, look: Look) -> str:
    if isinstance(item, Picture):
        return _figure(item, look)
    if isinstance(item, Answers):
        return "".join(_answers(item.report, look))
    if isinstance(item, OverAngle):
        return f"<h3>{_text(item.title, look)}</h3>\n{_tables(over_angle(item.report, look, _OUT))}"
    if isinstance(item, Grid):
        return _tables([_text_table(item, look)])
    if isinstance(item, PlaceTable):
        return _tables([place_table(item, look)])
    if isinstance(item, Facts):
        return f'<div class="facts">\n{"".join(_fact(one, look) for one in item.facts)}</div>\n'
    if isinstance(item, Notice):
        return f'<p class="notice {item.kind}">{_prose(item.text, look)}</p>\n'
    if isinstance(item, Pair):
        sides = "".join(_figure(one, look) if one else "<div></div>\n" for one in item)
        return f'<div class="pair">\n{sides}</div>\n'
    return f"<p>{_prose(item, look)}</p>\n"


def _answers(report: Report, look: Look) -> Iterator[str]:
    """Yield the key values of every part, tables of places, and notes."""
    for part in report.all_parts:
        if part.key_values:
            name = part_name(report, part, look) or "Key values"
            yield _tables([key_value_table(name, part.key_values, look)])
    yield _tables(of_places(report, look, _OUT))
    yield from (f"<p>{_prose(one, look)}</p>\n" for one in report.notes)


def _tables(tables: Iterable[TextTable]) -> str:
    return "".join(written(tables, _OUT))


def _fact(one: Fact, look: Look) -> str:
    """Return a key value as a tile: what it is, its value, its symbol with its place."""
    value, unit = look.measured(one.value, one.unit, DIGITS)
    at = "" if one.at_deg is None else f"at {look.degrees(one.at_deg)}"
    place = " ".join(filter(None, (look.text(one.where), at)))
    title, of = _text(one.title, look), f" <small>{_OUT.text(unit)}</small>" if unit else ""
    symbol = _OUT.symbol(look.text(one.symbol))
    return (
        f"<p><small>{title}</small><br><b>{_OUT.text(value)}</b>{of}"
        f"<br><small>{symbol} {_OUT.text(place)}</small></p>\n"
    )


def _figure(picture: Picture, look: Look) -> str:
    label = _text(picture.heading, look)
    drawn = f'<div class="wide" tabindex="0" role="region" aria-label="{label}">{svg(picture, look)}</div>'
    caption = f"<b>{label}.</b> {_prose(picture.text, look)}"
    return f"<figure>\n<figcaption>{caption}</figcaption>\n{drawn}\n</figure>\n"


def _text_table(grid: Grid, look: Look) -> TextTable:
    columns = []
    for k, (head, cells) in enumerate(zip(grid.heads, zip(*grid.rows))):
        kind = "symbol" if head == "Symbol" else "number" if k in grid.numbers else "name"
        columns.append(texts(look.text(head), "", [_shown(one, head, look) for one in cells], kind))
    return TextTable(look.text(grid.title), columns, 1, grid.verdicts)


def _shown(cell: Shown, head: str, look: Look) -> str:
    if isinstance(cell, float):
        return look.value(cell, DIGITS)
    if isinstance(cell, tuple):
        value, unit = look.measured(*cell, _CLOSE)
        return f"{value} {_powers(unit)}".strip()
    if head == "Unit":
        return look.unit(cell)
    return _powers(look.number(cell)) if head == "Bound" else look.sentence(cell)


def _powers(unit: str) -> str:
    """Return a unit as a file has it, `cm2`, with its powers above the line."""
    return re.sub(r"(?<=[a-z])[23]\b", lambda power: "²³"[int(power[0]) - 2], unit)


def _text(text: str, look: Look) -> str:
    return _OUT.text(look.text(text))


def _prose(text: str, look: Look) -> str:
    return _OUT.sentence(look.sentence(text))
