"""Markdown: one row per crank angle, key values as a second table, for reports and issues."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import TYPE_CHECKING

from kurbel.render.numbers import angle
from kurbel.render.prose import list_text, sentence_text, value_text
from kurbel.render.sheet import MARK, part_name, sheets

if TYPE_CHECKING:
    from kurbel.render import Look
    from kurbel.report.tables import KeyValue, Part, Report


def markdown(report: Report, look: Look) -> str:
    """Return the report as Markdown, every number as in the printed table."""
    blocks = [f"## {_escaped(look.charset.text(report.title))}"]
    blocks += [_escaped(look.charset.text(sentence)) for sentence in report.head]
    blocks += [*_tables(report, look), *_place_tables(report, look)]
    notes = [note for note in (report.mirrored, *report.notes) if note]
    blocks += [_escaped(sentence_text(note, look)) for note in notes]
    for part in report.all_parts:
        blocks += _of_part(part_name(report, part, look), part, look)
    return "\n\n".join(blocks) + "\n"


def _tables(report: Report, look: Look) -> Iterator[str]:
    for sheet in sheets(report, look):
        for band in sheet.bands:
            if band.name:
                yield f"### {_escaped(band.name)}"
            columns = [*sheet.heads, *band.rows]
            heads = [f"{row.symbol} ({row.unit})" if row.unit else row.symbol for row in columns]
            yield _table(heads, ["--:"] * len(heads), zip(*(row.cells for row in columns)))


def _place_tables(report: Report, look: Look) -> Iterator[str]:
    from kurbel.render.place_table import cells_of

    for table in (table for part in report.all_parts for table in part.place_tables):
        cells = cells_of(table, look)
        yield f"### {_escaped(look.charset.text(table.title))}"
        heads = [*table.heads, *(f"{symbol} ({unit})" if unit else symbol for symbol, unit in cells.heads)]
        rules = ["---"] * len(table.heads) + ["--:"] * len(cells.heads)
        yield _table(heads, rules, ((*names, *texts) for names, texts in zip(cells.names, cells.rows)))


def _table(heads: list[str], rules: list[str], rows: Iterable[Iterable[str]]) -> str:
    lines = [heads, rules, *rows]
    return "\n".join(f"| {' | '.join(_bold_if_marked(text) for text in texts)} |" for texts in lines)


def _bold_if_marked(text: str) -> str:
    text = text.strip()
    return f"**{text[:-1]}**" if text.endswith(MARK) else _escaped(text)


def _escaped(text: str) -> str:
    for character in "\\|*_<>`[]":
        text = text.replace(character, "\\" + character)
    return text


def _of_part(name: str, part: Part, look: Look) -> Iterator[str]:
    said = f": {_escaped(name)}" if name else ""
    if part.key_values:
        yield f"### Key values{said}"
        rows = ([*_cells(one, look)] for one in part.key_values)
        yield _table(["Symbol", "Value", "Unit", "At", "Meaning"], ["---", "--:", "---", "--:", "---"], rows)
    if part.left_out:
        yield f"### Left out{said}"
        yield "\n".join(f"- {_prose(one.what, look)}: {_prose(one.why, look)}" for one in part.left_out)
    if part.warnings:
        yield f"### Warnings{said}"
        yield "\n".join(f"- {_prose(warning, look)}" for warning in part.warnings)


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
