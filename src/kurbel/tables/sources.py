"""The books that letters before equations and pages refer to, as in (R 290) or (D 7)."""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from kurbel.tables.tables import Report

BOOKS = {
    "R": "Rötscher, Die Maschinenelemente (1927)",
    "D": "Redtenbacher, Der Maschinenbau (1862)",
    "B": "Blau, Die Mechanik fester Körper (1905)",
    "G": "Öl- und Gasmaschinen, crankshafts",
}
"""By their letters."""
_IN_BRACKETS = re.compile(r"\([^()]*\)")
_REFERENCE = re.compile(r"\b([RDBG]) (?:Abb\. |pp?\. )?[0-9]")


def legend(texts: Iterable[str]) -> str:
    """Return the line that names the books to which texts refer, '' if they refer to none.

    >>> legend(["Mean piston speed 2 s n (R 290)", "the same loss (D 7)", "pin of B 2"])
    'R: Rötscher, Die Maschinenelemente (1927); D: Redtenbacher, Der Maschinenbau (1862)'
    """
    letters = set[str]()
    for text in texts:
        for bracket in _IN_BRACKETS.findall(text):
            letters.update(_REFERENCE.findall(bracket))
    return "; ".join(f"{letter}: {book}" for letter, book in BOOKS.items() if letter in letters)


def texts_of(report: Report) -> list[str]:
    """Return the texts of a report for people that may refer to a book."""
    texts = [report.title, report.mirrored, *report.head, *report.notes]
    texts += [table.title for table in report.printed_tables]
    for part in report.all_parts:
        texts += [key_value.text for key_value in part.key_values]
        texts += [left_out.why for left_out in part.left_out]
        texts += part.warnings
    return texts


def legend_of(report: Report) -> str:
    """Return the legend of a report for people."""
    return legend(texts_of(report))
