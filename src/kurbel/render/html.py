"""Pages of HTML: one report, or the long report of a machine with contents, tables and pictures, self-contained."""

from collections.abc import Iterable, Iterator
from html import escape
from itertools import chain

from kurbel import __version__
from kurbel.render import Look
from kurbel.render.markup import Html, document, listed, written
from kurbel.render.pictures.layout import scene
from kurbel.render.pictures.style import css
from kurbel.render.pictures.svg import svg
from kurbel.render.text_tables import TextTable, texts
from kurbel.report.document import Document, Grid, Item, Pair
from kurbel.report.pictures.picture import Picture
from kurbel.report.tables import Provenance, Report

INK, PAPER, FAINT, RULE, SHADE = (
    ("#1a1a1a", "#e8e8e8"),
    ("#ffffff", "#15181b"),
    ("#555555", "#adadad"),
    ("#c4c4c4", "#41474d"),
    ("#f3f4f5", "#1f2428"),
)
GOOD, BAD, LINK = ("#1d6b34", "#7fd49a"), ("#a31515", "#ff9d94"), ("#0b5394", "#8cc4f5")
"""Each in light and in dark, of a contrast of 4.5 to the paper and to the shade."""


def html(report: Report, look: Look) -> Iterator[str]:
    """Yield the report as a page of its own."""
    yield from page(look.charset.text(report.title), document(report, look, Html(1)))


def page(title: str, main: Iterable[str], more_style: str = "") -> Iterator[str]:
    """Yield a self-contained page: no script, nothing from elsewhere, and the browser is told so."""
    yield (
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        '<meta name="viewport" content="width=device-width, initial-scale=1">\n'
        "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; style-src 'unsafe-inline'; "
        'img-src data:">\n'
        f'<meta name="color-scheme" content="light dark">\n<title>{escape(title)}</title>\n'
        f"<style>\n{style()}{more_style}</style>\n</head>\n<body>\n<main>\n"
    )
    yield from main
    yield "</main>\n</body>\n</html>\n"


def style() -> str:
    """Return the style sheet of pages: light, dark, and print."""
    names = {"ink": INK, "paper": PAPER, "faint": FAINT, "rule": RULE, "shade": SHADE}
    names |= {"good": GOOD, "bad": BAD, "link": LINK}
    light, dark = (";".join(f"--{name}:{colours[mode]}" for name, colours in names.items()) for mode in (0, 1))
    return (
        f":root{{{light}}}\n@media screen and (prefers-color-scheme:dark){{:root{{{dark}}}}}\n"
        "body{margin:0;background:var(--paper);color:var(--ink);"
        'font:15px/1.45 system-ui,"DejaVu Sans",sans-serif}\n'
        "main{max-width:60rem;margin:0 auto;padding:1rem;overflow-wrap:anywhere}\n"
        "h1{font-size:1.5rem}h2{font-size:1.25rem;border-bottom:1px solid var(--rule)}h3{font-size:1.05rem}"
        "h4{font-size:1rem;margin-bottom:.3rem}a{color:var(--link)}\n"
        ".wide{overflow-x:auto;margin:.6rem 0}.wide:focus-visible{outline:2px solid var(--link)}\n"
        "table{border-collapse:collapse;font-variant-numeric:tabular-nums}"
        "caption{text-align:left;font-weight:600;padding:.3rem 0}\n"
        "th,td{padding:.12rem .5rem;text-align:left;vertical-align:top;overflow-wrap:normal}"
        "td.r,th.r{text-align:right}td.r,tbody th.r,thead small,.n{white-space:nowrap}\n"
        "thead th{border-top:2px solid var(--ink);border-bottom:1px solid var(--ink);vertical-align:bottom}"
        "tbody tr:last-child>*{border-bottom:2px solid var(--ink)}tbody th{font-weight:400}\n"
        "@media screen and (max-width:40rem){.wide td:not(.r):last-child{min-width:12rem}}\n"
        "tbody tr:nth-child(even){background:var(--shade)}small{color:var(--faint)}"
        ".good{color:var(--good)}.bad{color:var(--bad);font-weight:600}\n"
        "@page{margin:14mm}@media print{body{font-size:9pt}main{max-width:none;padding:0}"
        ".wide{overflow:visible}table{font-size:7.5pt}th,td{padding:.05rem .3rem}"
        "tr,figure,h2,h3,h4,caption{break-inside:avoid}h2,h3,h4,caption{break-after:avoid}"
        "thead{display:table-header-group}}\n"
    )


# the long report


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


def report_page(long: Document, look: Look, date: str) -> Iterator[str]:
    """Yield the page of a long report; date: as it is shown."""
    style = _STYLE + _STYLE_OF_PAIRS if len(long.provenance) > 1 else _STYLE
    sections = (
        f'<section id="{section.id}">\n<h2>{_text(section.title, look)}</h2>\n'
        f"{''.join(_item(one, look) for one in section.items)}</section>\n"
        for section in long.sections
    )
    yield from page(look.charset.text(long.title), chain(_head(long, look, date), sections), f"{style}{css()}\n")


def _head(long: Document, look: Look, date: str) -> Iterator[str]:
    yield f"<header>\n<h1>{_text(long.title, look)}</h1>\n<p>{_text(date, look)}, kurbel {__version__}</p>\n"
    for one in long.provenance:
        yield from listed("Made from", _made_from(one), look, Html(1))
    links = "".join(f'<li><a href="#{one.id}">{_text(one.title, look)}</a></li>\n' for one in long.sections)
    yield f'</header>\n<nav aria-label="Contents">\n<h2>Contents</h2>\n<ul>\n{links}</ul>\n</nav>\n'


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
    if isinstance(item, Pair):
        sides = "".join(_figure(one, look) if one else "<div></div>\n" for one in item)
        return f'<div class="pair">\n{sides}</div>\n'
    return f"<p>{_text(item, look)}</p>\n"


def _figure(picture: Picture, look: Look) -> str:
    label = _text(picture.heading, look)
    drawn = f'<div class="wide" tabindex="0" role="region" aria-label="{label}">{svg(scene(picture, look))}</div>'
    return f"<figure>\n{drawn}\n<figcaption>{_text(picture.text, look)}</figcaption>\n</figure>\n"


def _text_table(grid: Grid, look: Look) -> TextTable:
    charset = look.charset
    columns = []
    for k, (head, cells) in enumerate(zip(grid.heads, zip(*grid.rows))):
        shown = [*map(charset.unit if k in grid.units else charset.text, cells)]
        columns.append(texts(charset.text(head), "", shown, "number" if k in grid.numbers else "name"))
    return TextTable(charset.text(grid.title), columns, 1, grid.verdicts)


def _text(text: str, look: Look) -> str:
    return escape(look.charset.text(text))
