"""The long report as one page of HTML: contents with links, tables, and pictures that are part of the page."""

from collections.abc import Iterator
from html import escape
from itertools import chain

from kurbel import __version__
from kurbel.render import Look
from kurbel.render.html import page
from kurbel.render.markup import Html, document, listed, written
from kurbel.render.svg import css, svg
from kurbel.render.text_tables import TextTable, texts
from kurbel.report.picture import Document, Fact, Facts, Grid, Item, Pair, Picture
from kurbel.report.tables import Provenance, Report

_STYLE = (
    "header{border-bottom:2px solid var(--ink);margin-bottom:1rem}nav ul{columns:16rem;padding-left:1.2rem}\n"
    ".facts{display:grid;grid-template-columns:repeat(auto-fill,minmax(13rem,1fr));gap:.6rem;margin:1rem 0}"
    ".facts p{background:var(--shade);border-radius:.3rem;margin:0;padding:.5rem .7rem}.facts b{font-size:1.35rem}"
    "footer{border-top:2px solid var(--ink);margin-top:2rem}\n"
    "figure{margin:1rem 0}"
    "figure svg{width:100%;min-width:30rem;max-width:52rem;height:auto;display:block}figcaption{color:var(--faint)}\n"
    "@media print{figure svg{min-width:0;max-height:24cm}nav{break-after:page}a{color:inherit;text-decoration:none}}\n"
)
_STYLE_OF_PAIRS = (
    "@media screen{main{max-width:96rem}"
    ".pair{display:grid;grid-template-columns:1fr 1fr;gap:1rem}.pair>*{min-width:0}}\n"
    # side by side only where both pictures have the width below which they scroll
    "@media screen and (max-width:66rem){.pair{grid-template-columns:1fr}}@media print{.pair{break-inside:avoid}}\n"
)


def report_page(long: Document, look: Look, date: str) -> Iterator[str]:
    """Yield the page of a long report; date: as it is shown."""
    style = _STYLE + _STYLE_OF_PAIRS if len(long.provenance) > 1 else _STYLE
    sections = (
        f'<section id="{section.id}">\n<h2>{_text(section.title, look)}</h2>\n'
        f"{''.join(_item(one, look) for one in section.items)}</section>\n"
        for section in long.sections
    )
    parts = chain(_head(long, look, date), sections, _foot(long, look))
    yield from page(look.text(long.title), parts, f"{style}{css()}\n")


def _head(long: Document, look: Look, date: str) -> Iterator[str]:
    """Yield title and links; those of the first section, on the first page, are not needed."""
    subtitle = f"<p>{_text(long.subtitle, look)}</p>\n" if long.subtitle else ""
    yield f"<header>\n<h1>{_text(long.title, look)}</h1>\n{subtitle}<p>{_text(date, look)}, kurbel {__version__}</p>\n"
    links = "".join(f'<li><a href="#{one.id}">{_text(one.title, look)}</a></li>\n' for one in long.sections)
    yield f'</header>\n<nav aria-label="Contents">\n<ul>\n{links}</ul>\n</nav>\n'


def _foot(long: Document, look: Look) -> Iterator[str]:
    yield "<footer>\n"
    for one in long.provenance:
        yield from listed("Made from", _made_from(one), look, Html(1))
    yield "</footer>\n"


def _made_from(given: Provenance) -> list[str]:
    files = [f"{one.file}: SHA-256 {one.sha256 or 'not known, the file is gone'}" for one in given.inputs]
    set_over = [f"set over it: {one}" for one in given.overrides]
    return files + set_over + [f"{name} {version}" for name, version in given.versions.items()]


def _item(item: Item, look: Look) -> str:
    if isinstance(item, Picture):
        return _figure(item, look)
    if isinstance(item, Report):
        return "".join(document(item, look, Html(3)))
    if isinstance(item, Grid):
        return "".join(written(_text_table(item, look), Html()))
    if isinstance(item, Facts):
        return f'<div class="facts">\n{"".join(_fact(one, look) for one in item.facts)}</div>\n'
    if isinstance(item, Pair):
        sides = "".join(_figure(one, look) if one else "<div></div>\n" for one in item)
        return f'<div class="pair">\n{sides}</div>\n'
    return f"<p>{_text(item, look)}</p>\n"


def _fact(one: Fact, look: Look) -> str:
    """Return a key value as a tile; its symbol has its index below the line."""
    unit = f" <small>{_text(look.unit(one.unit), look)}</small>" if one.unit else ""
    letter, _, index = one.symbol.partition("_")
    symbol = _text(letter, look) + (f"<sub>{_text(index, look)}</sub>" if index else "")
    value = f"{_text(one.title, look)}<br><b>{_text(one.value, look)}</b>{unit}"
    return f"<p>{value}<br><small>{symbol} {_text(one.where, look)}</small></p>\n"


def _figure(picture: Picture, look: Look) -> str:
    label = _text(picture.heading, look)
    drawn = f'<div class="wide" tabindex="0" role="region" aria-label="{label}">{svg(picture, look)}</div>'
    return f"<figure>\n{drawn}\n<figcaption>{_text(picture.text, look)}</figcaption>\n</figure>\n"


def _text_table(grid: Grid, look: Look) -> TextTable:
    columns = []
    for k, (head, cells) in enumerate(zip(grid.heads, zip(*grid.rows))):
        shown = [*map(look.unit if k in grid.units else look.text, cells)]
        columns.append(texts(look.text(head), "", shown, "number" if k in grid.numbers else "name"))
    return TextTable(look.text(grid.title), columns, 1, grid.verdicts)


def _text(text: str, look: Look) -> str:
    return escape(look.text(text))
