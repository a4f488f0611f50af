"""A check as text: head lines with their entries, one to a line."""

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from kurbel.render import Look
from kurbel.render.prose import sentence
from kurbel.render.text import folded, left, plain, width

if TYPE_CHECKING:
    from kurbel.report.check import Checked


def listing(checked: "Checked", look: Look) -> str:
    """Return the check as plain text in the characters and the width of the output."""
    charset = look.charset
    lines = folded(charset.text(checked.title), look.width)
    for section in checked.told_once:
        lines += ["", *folded(charset.text(section.title), look.width)]
        column = max(width(charset.text(entry.what)) for entry in section.entries)
        lines += entries(((f"  {left(charset.text(e.what), column)}  ", e.text) for e in section.entries), look)
    return "\n".join(lines) + "\n"


def write_entries(found: Sequence[tuple[str, str]], file_name: str | None = None) -> None:
    """Write heads in a column, each with its text, to a file or to standard output."""
    from kurbel.render.output import stdout_look, write_out

    longest = max((len(head) for head, _ in found), default=0)
    padded = ((f"{head:<{longest}}  ", text) for head, text in found)
    look = Look() if file_name else stdout_look()
    write_out((line + "\n" for line in entries(padded, look)), file_name)


def entries(found: Iterable[tuple[str, str]], look: Look) -> Iterable[str]:
    """Return heads with their texts, folded where the output has a width."""
    return (text.rstrip("\n") for head, one in found for text in plain(sentence(head, one, look)))
