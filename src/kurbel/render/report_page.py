"""The long report as one page of HTML: a first page, answers with pictures and tables, and the input last."""

import re
from collections.abc import Iterator

from kurbel import __version__
from kurbel.page.contents import TABLES
from kurbel.pictures.picture import (
    Document,
    Fact,
    Facts,
    FactValue,
    Grid,
    Notice,
    OverAngle,
    Pair,
    Picture,
    ReportAnswers,
    SectionItem,
)
from kurbel.render import Look
from kurbel.render.json_text import sha256_of
from kurbel.render.markup import Html, html_page, listed, over_angle, place_tables_of, written
from kurbel.render.style import LONG_REPORT, MOVING, PAIRS, PICTURE, PICTURE_COLOURS, page_css
from kurbel.render.svg import svg_rows
from kurbel.render.text import DIGITS
from kurbel.render.text_tables import TextColumn, TextTable, key_value_table, part_name, place_table
from kurbel.tables.sources import legend, texts_of
from kurbel.tables.tables import PlaceTable, notes_for_people

_CLOSE = 5
"""Digits of a value next to its bound."""
_BOX = """\
<input type="checkbox" id="print-tables"{}>
<label for="print-tables">Print these tables, too</label>
<p class="unprinted">These tables are on the page as it is on a screen, where a box selects them for print; \
<code>kurbel report --sections all</code> prints them, too.</p>
"""
_PRINTED, _UNPRINTED = _BOX.format(" checked"), _BOX.format("")
"""What decides whether the tables over the crank angle are printed; what follows it is hidden on paper."""


def report_page(long: Document, look: Look, paper: str, date: str) -> Iterator[str]:
    """Yield the page of a long report; paper: the word of a sheet in CSS; date: as it is shown."""
    out = Html(look._replace(format="html"))
    are_pairs = len(long.provenance) > 1
    pairs = PAIRS if are_pairs else ""
    if are_pairs:
        paper = f"{paper} landscape"
    sheet = f"@page{{size:{paper}}}\n"
    style = page_css(LONG_REPORT, pairs, PICTURE, PICTURE_COLOURS, MOVING, sheet)
    yield from html_page(out.look.text(long.title), _parts(long, out, date), style)


def _parts(long: Document, out: Html, date: str) -> Iterator[str]:
    """Yield title, first page, links, sections, and what it was made from."""
    yield f"<header>\n<h1>{out.words(long.title)}</h1>\n"
    for subtitle in filter(None, long.subtitles):
        yield f'<p class="sub">{out.prose(subtitle)}</p>\n'
    yield '</header>\n<section id="summary" aria-label="Summary">\n'
    for item in long.summary:
        yield from _item(item, out)
    yield '</section>\n<nav aria-label="Contents">\n<ul>\n'
    for section in long.sections:
        yield f'<li><a href="#{section.id}">{out.words(section.title)}</a></li>\n'
    yield "</ul>\n</nav>\n"
    for section in long.sections:
        yield f'<section id="{section.id}">\n<h2>{out.words(section.title)}</h2>\n'
        if section.id == TABLES:
            yield _PRINTED if long.prints_tables else _UNPRINTED
        for item in section.items:
            yield from _item(item, out)
        yield "</section>\n"

    yield f"<footer>\n<p>{out.words(date)}, kurbel {__version__}</p>\n"
    books = legend(_texts_of(long))
    if books:
        yield f"<p>{out.prose(books)}</p>\n"
    for made_from in long.provenance:
        texts = []
        for file in made_from.inputs:
            texts.append(f"{file.file}: SHA-256 {sha256_of(file) or 'not known, the file is gone'}")
        texts += [f"set over it: {override}" for override in made_from.overrides]
        texts += [f"{name} {version}" for name, version in made_from.versions.items()]
        yield from listed("Made from", texts, out)
    yield "</footer>\n"


def _texts_of(long: Document) -> Iterator[str]:
    """Yield the texts of a long report that may refer to a book: those of its answers, notices and pictures."""
    items = list(long.summary)
    for section in long.sections:
        items += section.items
    for item in items:
        if isinstance(item, ReportAnswers):
            yield from texts_of(item.report)
        elif isinstance(item, Grid):
            for row in item.rows:
                yield from (cell for cell in row if isinstance(cell, str))
        elif isinstance(item, (Notice, Picture)):
            yield item.text
        elif isinstance(item, Pair):
            yield from (picture.text for picture in item if picture)
        elif isinstance(item, str):
            yield item


def _item(item: SectionItem, out: Html) -> Iterator[str]:
    if isinstance(item, Picture):
        yield _figure(item, out)
    elif isinstance(item, ReportAnswers):
        report = item.report
        for part in report.all_parts:
            if part.key_values:
                name = part_name(report, part, out.look) or "Key values"
                yield from written([key_value_table(name, part.key_values, out.look)], out)
        yield from written(place_tables_of(report, out), out)
        yield from (f"<p>{out.prose(note)}</p>\n" for note in notes_for_people(report))
    elif isinstance(item, OverAngle):
        yield f"<h3>{out.words(item.title)}</h3>\n"
        yield from written(over_angle(item.report, out), out)
    elif isinstance(item, Grid):
        yield from written([_text_table(item, out.look)], out)
    elif isinstance(item, PlaceTable):
        yield from written([place_table(item, out.look)], out)
    elif isinstance(item, Facts):
        yield f'<div class="facts">\n{"".join(_fact(fact, out) for fact in item.facts)}</div>\n'
    elif isinstance(item, Notice):
        yield f'<p class="notice {item.kind}">{out.prose(item.text)}</p>\n'
    elif isinstance(item, Pair):
        sides = "".join(_figure(side, out) if side else "<div></div>\n" for side in item)
        yield f'<div class="pair">\n{sides}</div>\n'
    else:
        yield f"<p>{out.prose(item)}</p>\n"


def _fact(fact: Fact, out: Html) -> str:
    """Return a key value as a tile: what it is, its value, its symbol with its place."""
    look = out.look
    value, unit = look.measured(fact.value, fact.unit, DIGITS)
    at = "" if fact.at_deg is None else f"at {look.extreme_at(fact.at_deg, fact.side)}"
    where = " ".join(filter(None, (look.text(fact.where), at)))
    of = f" <small>{out.text(unit)}</small>" if unit else ""
    return (
        f"<p><small>{out.words(fact.title)}</small><br><b>{out.text(value)}</b>{of}"
        f"<br><small>{out.symbol(look.text(fact.symbol))} {out.text(where)}</small></p>\n"
    )


def _figure(picture: Picture, out: Html) -> str:
    label = out.words(picture.heading)
    rows = "".join(svg_rows(picture, out.look))
    drawn = f'<div class="wide" tabindex="0" role="region" aria-label="{label}">{rows}</div>'
    caption = f"<b>{label}.</b> {out.prose(picture.text)}"
    return f"<figure>\n<figcaption>{caption}</figcaption>\n{drawn}\n</figure>\n"


def _text_table(grid: Grid, look: Look) -> TextTable:
    """Return a grid as a table of texts."""
    columns = []
    for number, (head, cells) in enumerate(zip(grid.heads, zip(*grid.rows))):
        kind = "name"
        if head == "Symbol":
            kind = "symbol"
        elif number in grid.numbers:
            kind = "number"
        texts = [_shown(cell, head, look) for cell in cells]
        columns.append(TextColumn(look.text(head), "", texts, kind))
    return TextTable(look.text(grid.title), columns, 1, grid.verdicts)


def _shown(cell: FactValue, head: str, look: Look) -> str:
    if isinstance(cell, float):
        return look.value(cell, DIGITS)
    if isinstance(cell, tuple):
        value, unit = look.measured(*cell, _CLOSE)
        return f"{value} {_powers(unit)}".strip()
    if head == "Unit":
        return look.unit(cell)
    if head == "Bound":
        return _powers(look.number(cell))
    return look.sentence(cell)


def _powers(unit: str) -> str:
    """Return a unit as a file has it, `cm2`, with its powers above the line."""
    return re.sub(r"(?<=[a-z])[23]\b", lambda power: "²³"[int(power[0]) - 2], unit)
