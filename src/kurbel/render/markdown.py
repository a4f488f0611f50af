"""Markdown: one row per crank angle, key values as a second table, for reports and issues."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from itertools import chain
from typing import TYPE_CHECKING

from kurbel.render.numbers import angle
from kurbel.render.prose import list_text, sentence_text, value_text
from kurbel.render.sheet import MARK, part_name, sheets
from kurbel.report.alike import told_once

if TYPE_CHECKING:
    from kurbel.render import Look
    from kurbel.report.tables import KeyValue, Part, Report


Block = Iterable[str]
"""Lines that stand together; a blank line parts them from the next block."""


def markdown(report: Report, look: Look) -> Iterator[str]:
    """Yield the report as lines of Markdown, every number as in the printed table."""
    for index, block in enumerate(_blocks(told_once(report), look)):
        if index:
            yield "\n"
        for text in block:
            yield text + "\n"


def _blocks(report: Report, look: Look) -> Iterator[Block]:
    yield [f"## {_escaped(look.charset.text(report.title))}"]
    for sentence in report.head:
        yield [_escaped(look.charset.text(sentence))]
    yield from _tables(report, look)
    yield from _place_tables(report, look)
    for note in (report.mirrored, *report.notes):
        if note:
            yield [_escaped(sentence_text(note, look))]
    for part in report.all_parts:
        yield from _of_part(part_name(report, part, look), part, look)


def _tables(report: Report, look: Look) -> Iterator[Block]:
    for sheet in sheets(report, look):
        for band in sheet.bands:
            if band.name:
                yield [f"### {_escaped(band.name)}"]
            columns = [*sheet.heads, *band.rows]
            heads = [f"{row.symbol} ({row.unit})" if row.unit else row.symbol for row in columns]
            yield _table(heads, ["--:"] * len(heads), zip(*(row.cells for row in columns)))


def _place_tables(report: Report, look: Look) -> Iterator[Block]:
    from kurbel.render.place_table import cells_of

    for table in (table for part in report.all_parts for table in part.place_tables):
        cells = cells_of(table, look)
        yield [f"### {_escaped(look.charset.text(table.title))}"]
        heads = [*table.heads, *(f"{symbol} ({unit})" if unit else symbol for symbol, unit in cells.heads)]
        rules = ["---"] * len(table.heads) + ["--:"] * len(cells.heads)
        yield _table(heads, rules, ((*names, *texts) for names, texts in zip(cells.names, cells.rows)))


def _table(heads: list[str], rules: list[str], rows: Iterable[Iterable[str]]) -> Block:
    return (f"| {' | '.join(_bold_if_marked(text) for text in texts)} |" for texts in chain((heads, rules), rows))


def _bold_if_marked(text: str) -> str:
    text = text.strip()
    return f"**{text[:-1]}**" if text.endswith(MARK) else _escaped(text)


def _escaped(text: str) -> str:
    for character in "\\|*_<>`[]":
        text = text.replace(character, "\\" + character)
    return text


def _of_part(name: str, part: Part, look: Look) -> Iterator[Block]:
    said = f": {_escaped(name)}" if name else ""
    if part.key_values:
        yield [f"### Key values{said}"]
        rows = ([*_cells(one, look)] for one in part.key_values)
        yield _table(["Symbol", "Value", "Unit", "At", "Meaning"], ["---", "--:", "---", "--:", "---"], rows)
    if part.left_out:
        yield [f"### Left out{said}"]
        yield [f"- {_prose(one.what, look)}: {_prose(one.why, look)}" for one in part.left_out]
    if part.warnings:
        yield [f"### Warnings{said}"]
        yield [f"- {_prose(warning, look)}" for warning in part.warnings]


def _prose(text: str, look: Look) -> str:
    return _escaped(sentence_text(text, look))


def _cells(one: KeyValue, look: Look) -> Iterator[str]:
    charset = look.charset
    yield charset.symbol(one.symbol, one.ascii_symbol)
    if one.value is None or one.value == ():
        yield charset.no_value
    elif isinstance(one.value, tuple):
        yield list_text(one, look)
    else:
        text, exponent = value_text(one, look)
        yield text + (charset.times_power(exponent) if exponent else "")
    yield charset.unit(one.unit)
    yield "" if one.at_deg is None else angle(one.at_deg, look.comma) + charset.degree
    yield sentence_text(one.text, look)
