"""Lines of a printed page, as pieces that say what they are; a terminal may colour them."""

from collections.abc import Iterable, Iterator
from typing import NamedTuple


class Piece(NamedTuple):
    """A piece of a line; `role` is what it is: title, head, rule, name, symbol, unit, cell, mark or text."""

    text: str
    role: str = "text"


Line = tuple[Piece, ...]
BLANK: Line = ()


def line(text: str, role: str = "text") -> Line:
    """Return a line of one piece."""
    return (Piece(text, role),)


def plain(lines: Iterable[Line]) -> Iterator[str]:
    """Yield the lines as text, without blanks at their ends."""
    for pieces in lines:
        yield "".join(piece.text for piece in pieces).rstrip() + "\n"
