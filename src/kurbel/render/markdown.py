"""Markdown: one row per crank angle, key values as a second table, for reports and issues."""

from collections.abc import Collection, Iterator, Sequence
from itertools import chain
from typing import NamedTuple

from kurbel.render import Look
from kurbel.render.document import Table, document, key_value_table
from kurbel.render.sheet import MARK
from kurbel.report.tables import KeyValue, Report


def markdown(report: Report, look: Look) -> Iterator[str]:
    """Yield the report as lines of Markdown, every number as in the printed table."""
    return document(report, look, _Markdown(look))


class _Markdown(NamedTuple):
    """Writes Markdown; a blank line parts what stands together from what stands before it."""

    look: Look
    across: int | None = None

    def title(self, text: str) -> Iterator[str]:
        yield f"## {_escaped(text)}\n"

    def paragraph(self, text: str) -> Iterator[str]:
        yield f"\n{_escaped(text)}\n"

    def table(self, table: Table) -> Iterator[str]:
        if table.caption:
            yield f"\n### {_escaped(table.caption)}\n"
        yield "\n"
        heads = [f"{one.symbol} ({one.unit})" if one.unit else one.symbol for one in table.columns]
        rules = ["---" if one.words else "--:" for one in table.columns]
        for row in chain((heads, rules), table.rows):
            yield f"| {' | '.join(map(_bold_if_marked, row))} |\n"

    def key_values(self, title: str, found: Collection[KeyValue]) -> Iterator[str]:
        return self.table(key_value_table(title, found, self.look))

    def items(self, title: str, lines: Sequence[str]) -> Iterator[str]:
        yield f"\n### {_escaped(title)}\n\n"
        yield from (f"- {_escaped(line)}\n" for line in lines)


def _bold_if_marked(text: str) -> str:
    text = text.strip()
    return f"**{text[:-1]}**" if text.endswith(MARK) else _escaped(text)


def _escaped(text: str) -> str:
    for character in "\\|*_<>`[]":
        text = text.replace(character, "\\" + character)
    return text
