"""Colours for a terminal; the lines themselves are those of the plain page."""

from collections.abc import Iterable, Iterator

from rich.console import Console
from rich.text import Text

from kurbel.render import Look
from kurbel.render.text import Line, width

_STYLES = {
    "title": "bold",
    "head": "bold cyan",
    "rule": "dim",
    "name": "bold",
    "symbol": "cyan",
    "unit": "dim",
    "mark": "bold red",
    "cell": "",
    "text": "",
    **{f"curve{number}": style for number, style in enumerate(("bold", "blue", "red", "green", "magenta", "yellow"))},
}


def write_lines(lines: Iterable[Line], look: Look) -> bool:
    """Write the lines in colour and return True, or nothing and False where a table is wider than the terminal."""
    lines = list(lines)
    tables = (line for line in lines if any(piece.role in ("rule", "head") for piece in line))
    if look.width is not None and any(sum(width(piece.text) for piece in line) > look.width for line in tables):
        return False
    # a width, and a height with it, or rich believes a COLUMNS=0 of the environment and prints nothing
    console = Console(width=look.width, height=25, highlight=False, markup=False, emoji=False, soft_wrap=True)
    for text in coloured(lines):
        console.print(text)
    return True


def coloured(lines: Iterable[Line]) -> Iterator[Text]:
    """Yield the lines with their colours, as Text objects: a string would lose its brackets as markup."""
    for pieces in lines:
        yield Text.assemble(*((piece.text, _STYLES[piece.role]) for piece in pieces))
