"""A check as text: head lines with their entries, one to a line."""

from __future__ import annotations

from collections.abc import Iterable

from kurbel.render import Look
from kurbel.render.charset import left, width
from kurbel.render.lines import plain
from kurbel.render.prose import folded, sentence
from kurbel.report.check import Checked


def listing(checked: Checked, look: Look) -> str:
    """Return the check as plain text in the characters and the width of the output."""
    charset = look.charset
    lines = folded(charset.text(checked.title), look.width)
    for section in checked.sections:
        lines += ["", charset.text(section.title)]
        column = max(width(charset.text(entry.what)) for entry in section.entries)
        lines += entries(((f"  {left(charset.text(e.what), column)}  ", e.text) for e in section.entries), look)
    return "\n".join(lines) + "\n"


def entries(found: Iterable[tuple[str, str]], look: Look) -> Iterable[str]:
    """Return heads with their texts, folded where the output has a width."""
    return (text.rstrip("\n") for head, one in found for text in plain(sentence(head, one, look)))
