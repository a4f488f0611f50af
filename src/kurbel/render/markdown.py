"""Markdown: one row per crank angle, key values as a second table, for reports and issues."""

from collections.abc import Iterable, Iterator, Sequence
from itertools import chain
from typing import NamedTuple

from kurbel.render import Look
from kurbel.render.document import KEY_VALUE_HEADS, Table, document, key_value_cells
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
        heads = [f"{symbol} ({unit})" if unit else symbol for symbol, unit in table.heads]
        rules = ["---"] * table.names + ["--:"] * (len(heads) - table.names)
        yield from self._table(table.caption, heads, rules, table.rows)

    def key_values(self, title: str, found: Iterable[KeyValue]) -> Iterator[str]:
        rows = (key_value_cells(one, self.look) for one in found)
        yield from self._table(title, KEY_VALUE_HEADS, ("---", "--:", "---", "--:", "---"), rows)

    def items(self, title: str, lines: Sequence[str]) -> Iterator[str]:
        yield f"\n### {_escaped(title)}\n\n"
        yield from (f"- {_escaped(line)}\n" for line in lines)

    def _table(
        self, caption: str, heads: Sequence[str], rules: Sequence[str], rows: Iterable[Sequence[str]]
    ) -> Iterator[str]:
        if caption:
            yield f"\n### {_escaped(caption)}\n"
        yield "\n"
        for row in chain((heads, rules), rows):
            yield f"| {' | '.join(map(_bold_if_marked, row))} |\n"


def _bold_if_marked(text: str) -> str:
    text = text.strip()
    return f"**{text[:-1]}**" if text.endswith(MARK) else _escaped(text)


def _escaped(text: str) -> str:
    for character in "\\|*_<>`[]":
        text = text.replace(character, "\\" + character)
    return text
