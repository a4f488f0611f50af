"""The long report as one page of HTML: a first page, answers with pictures and tables, and the input last."""

import re
from collections.abc import Iterable, Iterator
from html import escape

from kurbel import __version__
from kurbel.render import Look
from kurbel.render.html import page
from kurbel.render.markup import Html, listed, of_places, over_angle, written
from kurbel.render.numbers import DIGITS, angle, single
from kurbel.render.svg import css, svg
from kurbel.render.text_tables import TextTable, key_value_table, part_name, place_table, sentence_text, texts
from kurbel.report.picture import Answers, Document, Fact, Facts, Grid, Item, Notice, OverAngle, Pair, Picture, Shown
from kurbel.report.tables import PlaceTable, Provenance, Report

_OUT = Html()
_CLOSE = 5
"""Digits of a value next to its bound."""
_STYLE = """\
main{max-width:61rem;padding:1.5rem 1rem}
h1{font-size:1.9rem;line-height:1.2;margin:0 0 .2rem}
h2{border-bottom:2px solid var(--ink);margin:2.6rem 0 .8rem}
h3{font-weight:600;margin:1.6rem 0 .3rem}
section>p{max-width:46rem}#summary>p{max-width:none}
.sub,figcaption{color:var(--faint);margin:.1rem 0}
figcaption b{color:var(--ink)}
#summary{border:1px solid var(--rule);border-radius:.4rem;padding:.6rem 1.1rem 1rem;margin:1rem 0}
.facts{display:grid;grid-template-columns:repeat(4,1fr);gap:.6rem;margin:1rem 0}
.facts p{background:var(--shade);border-radius:.3rem;margin:0;padding:.5rem .7rem}
.facts b{font-size:1.35rem;white-space:nowrap}.facts small{font-size:.8rem}
@media screen and (max-width:52rem){.facts{grid-template-columns:1fr 1fr}#summary{border:0;padding:0}}
.notice{margin:.5rem 0}
.warning{padding:.4rem .8rem;border-left:.3rem solid var(--warn);background:var(--warned)}
tr.good,tr.bad{color:var(--ink);font-weight:400}
tr.good td:nth-child(3),tr.bad td:nth-child(3){white-space:nowrap}
tr.good td:nth-child(4){color:var(--good);font-weight:600}
tr.bad td:nth-child(4){color:var(--bad);font-weight:600}
nav ul{display:flex;flex-wrap:wrap;gap:.3rem 1.3rem;list-style:none;padding:0}
footer{border-top:2px solid var(--ink);margin-top:2.6rem}
figure{margin:1.2rem 0}
figure svg{width:100%;min-width:30rem;height:auto;display:block}
#summary figure svg{min-width:0}
@media print{main{padding:0}figure svg{min-width:0;max-height:23cm}nav{display:none}
h1{font-size:18pt}h2{margin-top:1.2rem}#summary{break-after:page}
a{color:inherit;text-decoration:none}}
"""
_STYLE_OF_PAIRS = """\
@media screen{main{max-width:96rem}.pair{display:grid;grid-template-columns:1fr 1fr;gap:1.6rem}.pair>*{min-width:0}}
@media screen and (max-width:66rem){.pair{grid-template-columns:1fr}}@media print{.pair{break-inside:avoid}}
"""
"""Next to each other only where both pictures have the width below which they scroll."""


def report_page(long: Document, look: Look, date: str) -> Iterator[str]:
    """Yield the page of a long report; date: as it is shown."""
    style = _STYLE + _STYLE_OF_PAIRS if len(long.provenance) > 1 else _STYLE
    yield from page(look.text(long.title), _parts(long, look, date), f"{style}{css()}\n")


def _parts(long: Document, look: Look, date: str) -> Iterator[str]:
    """Yield title, first page, links, sections, and what it was made from."""
    yield f"<header>\n<h1>{_text(long.title, look)}</h1>\n"
    yield from (f'<p class="sub">{_OUT.name(sentence_text(one, look))}</p>\n' for one in long.subtitles if one)
    yield "</header>\n"
    first = "".join(_item(one, look) for one in long.summary)
    yield f'<section id="summary" aria-label="Summary">\n{first}</section>\n'
    links = "".join(f'<li><a href="#{one.id}">{_text(one.title, look)}</a></li>\n' for one in long.sections)
    yield f'<nav aria-label="Contents">\n<ul>\n{links}</ul>\n</nav>\n'
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
        tables = over_angle(item.report, look, Html.across)
        return f"<h3>{_text(item.title, look)}</h3>\n" + "".join(_written(tables))
    if isinstance(item, (Grid, PlaceTable)):
        return "".join(_written([_text_table(item, look) if isinstance(item, Grid) else place_table(item, look)]))
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
            yield from written(
                key_value_table(part_name(report, part, look) or "Key values", part.key_values, look), _OUT
            )
    yield from _written(of_places(report, look, Html.across))
    yield from (f"<p>{_prose(one, look)}</p>\n" for one in report.notes)


def _written(tables: Iterable[TextTable]) -> Iterator[str]:
    return (piece for table in tables for piece in written(table, _OUT))


def _fact(one: Fact, look: Look) -> str:
    """Return a key value as a tile: what it is, its value, its symbol with its place."""
    degrees = look.unit(one.unit) if one.unit == "deg" else ""
    unit = f" <small>{_OUT.text(look.unit(one.unit))}</small>" if one.unit and not degrees else ""
    at = "" if one.at_deg is None else f"at {angle(one.at_deg, look.comma)}°"
    place = " ".join(filter(None, (look.text(one.where), at)))
    value = f"<small>{_text(one.title, look)}</small><br><b>{_OUT.number(_number(one.value, look))}{degrees}</b>{unit}"
    return f"<p>{value}<br><small>{_OUT.symbol(look.text(one.symbol))} {_OUT.text(place)}</small></p>\n"


def _number(value: float, look: Look) -> str:
    return look.counted(*single(value, look.digits or DIGITS, look.comma))


def _figure(picture: Picture, look: Look) -> str:
    label = _text(picture.heading, look)
    drawn = f'<div class="wide" tabindex="0" role="region" aria-label="{label}">{svg(picture, look)}</div>'
    caption = f"<b>{label}.</b> {_prose(picture.text, look)}"
    return f"<figure>\n<figcaption>{caption}</figcaption>\n{drawn}\n</figure>\n"


def _text_table(grid: Grid, look: Look) -> TextTable:
    columns = []
    for k, (head, cells) in enumerate(zip(grid.heads, zip(*grid.rows))):
        kind = "symbol" if head == "Symbol" else "number" if k in grid.numbers else "name"
        shown = [_shown(one, head, look) for one in cells]
        columns.append(texts(look.text(head), "", shown, kind))
    return TextTable(look.text(grid.title), columns, 1, grid.verdicts)


def _shown(cell: Shown, head: str, look: Look) -> str:
    if isinstance(cell, tuple):
        number = look.counted(*single(cell[0], look.digits or _CLOSE, look.comma))
        return f"{number} {_powers(look.unit(cell[1]))}".replace(" °", "°").strip()
    if isinstance(cell, float):
        return _number(cell, look)
    return look.unit(cell) if head == "Unit" else _powers(cell) if head == "Bound" else sentence_text(cell, look)


def _powers(unit: str) -> str:
    """Return a unit as a file has it, `cm2`, with its powers above the line, and a minus sign in place of a hyphen."""
    return re.sub(r"(?<=[a-z])[23]\b", lambda power: "²³"[int(power[0]) - 2], re.sub(r"^-", "−", unit))


def _text(text: str, look: Look) -> str:
    return escape(look.text(text))


def _prose(text: str, look: Look) -> str:
    return _OUT.sentence(sentence_text(text, look))
