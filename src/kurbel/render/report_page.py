"""A long report as one page of HTML: contents with links, tables, and pictures that are part of the page."""

from collections.abc import Iterator
from html import escape
from itertools import chain

from kurbel import __version__
from kurbel.render import Look
from kurbel.render.document import Table
from kurbel.render.html import grid, item_list, page, tables
from kurbel.render.pictures.layout import scene
from kurbel.render.pictures.style import css
from kurbel.render.pictures.svg import svg
from kurbel.render.prose import sentence_text
from kurbel.render.sheet import Row
from kurbel.report.document import Document, Grid, Item, Pair, Section
from kurbel.report.pictures.picture import Picture
from kurbel.report.tables import Provenance, Report

_STYLE = (
    "header{border-bottom:2px solid var(--ink);margin-bottom:1rem}nav ul{columns:16rem;padding-left:1.2rem}\n"
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


def report_page(document: Document, look: Look, date: str) -> Iterator[str]:
    """Yield the page. date: what stands as its date."""
    sections = (text for section in document.sections for text in _section(section, look))
    body = chain(("<main>\n",), _head(document, look, date), sections, ("</main>\n",))
    style = _STYLE + _STYLE_OF_PAIRS if len(document.provenance) > 1 else _STYLE
    yield from page(look.charset.text(document.title), body, f"{style}{css()}\n")


def _head(document: Document, look: Look, date: str) -> Iterator[str]:
    yield f"<header>\n<h1>{_text(document.title, look)}</h1>\n<p>{_text(date, look)}, kurbel {__version__}</p>\n"
    yield from (_provenance(one, look) for one in document.provenance)
    yield "</header>\n"
    links = "".join(f'<li><a href="#{one.id}">{_text(one.title, look)}</a></li>\n' for one in document.sections)
    yield f'<nav aria-label="Contents">\n<h2>Contents</h2>\n<ul>\n{links}</ul>\n</nav>\n'


def _provenance(given: Provenance, look: Look) -> str:
    said = [f"{one.file}: SHA-256 {one.sha256 or 'not known, the file is gone'}" for one in given.inputs]
    said += [f"set over it: {one}" for one in given.overrides]
    said += [f"{name} {version}" for name, version in given.versions.items()]
    return item_list("Made from", [sentence_text(one, look) for one in said], 2) if said else ""


def _section(section: Section, look: Look) -> Iterator[str]:
    yield f'<section id="{section.id}">\n<h2>{_text(section.title, look)}</h2>\n'
    yield from (_item(one, look) for one in section.items)
    yield "</section>\n"


def _item(item: Item, look: Look) -> str:
    if isinstance(item, Picture):
        return _figure(item, look)
    if isinstance(item, Report):
        return "".join(tables(item, look, 3))
    if isinstance(item, Grid):
        return _grid(item, look)
    if isinstance(item, Pair):
        sides = "".join(_figure(one, look) if one else "<div></div>\n" for one in item)
        return f'<div class="pair">\n{sides}</div>\n'
    return f"<p>{_text(item, look)}</p>\n"


def _figure(picture: Picture, look: Look) -> str:
    caption = _text(picture.text, look)
    label = escape(look.charset.text(picture.heading), quote=True)
    drawn = f'<div class="wide" tabindex="0" role="region" aria-label="{label}">{svg(scene(picture, look))}</div>'
    return f"<figure>\n{drawn}\n<figcaption>{caption}</figcaption>\n</figure>\n"


def _grid(given: Grid, look: Look) -> str:
    charset = look.charset
    columns = []
    for k, (head, texts) in enumerate(zip(given.heads, zip(*given.rows))):
        cells = [*map(charset.unit if k in given.units else charset.text, texts)]
        columns.append(Row(charset.text(head), "", cells, words=k not in given.numbers))
    return "".join(grid(Table(charset.text(given.title), columns, 1), given.verdicts))


def _text(text: str, look: Look) -> str:
    return escape(look.charset.text(text))
