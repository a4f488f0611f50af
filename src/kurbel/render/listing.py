"""A check as text: head lines with their entries, one to a line."""

from __future__ import annotations

from kurbel.render.charset import Charset, left, width
from kurbel.report.check import Checked


def listing(checked: Checked, charset: Charset) -> str:
    """Return the check as plain text in the characters of the output."""
    lines = [charset.text(checked.title)]
    for section in checked.sections:
        lines += ["", charset.text(section.title)]
        column = max(width(charset.text(entry.what)) for entry in section.entries)
        lines += [
            f"  {left(charset.text(entry.what), column)}  {charset.text(entry.text)}".rstrip()
            for entry in section.entries
        ]
    return "\n".join(lines) + "\n"
