"""A grid of characters to draw on: eight dots of Braille to a character, or one letter where there are none."""

from itertools import groupby
from operator import itemgetter

import numpy as np

from kurbel.arrays import Array
from kurbel.render.pictures.style import LOOKS
from kurbel.render.text import Line, Piece, width

_BLANK = 0x2800
_DOTS = np.array([[0x01, 0x08], [0x02, 0x10], [0x04, 0x20], [0x40, 0x80]])
"""Bits of the dots of a character, four down and two across."""


class Canvas:
    """Characters (rows, columns) with dots in them, written over with texts; each has the role of what is in it.

    braille: whether there are dots; else a character stands for its curve.
    """

    def __init__(self, columns: int, rows: int, braille: bool) -> None:
        self.columns, self.rows, self.braille = columns, rows, braille
        self._bits = np.zeros((rows, columns), dtype=int)
        self._letters = [[" "] * columns for _ in range(rows)]
        self._roles = [["text"] * columns for _ in range(rows)]

    @property
    def fine(self) -> tuple[int, int]:
        """Dots across and down."""
        return (2 * self.columns, 4 * self.rows) if self.braille else (self.columns, self.rows)

    def line(self, x: Array, y: Array, role: str) -> None:
        """Draw a line through places (n,), counted in dots from the upper left corner; what lies beyond is cut off."""
        across, down = self.fine
        steps = np.maximum(np.ceil(np.maximum(np.abs(np.diff(x)), np.abs(np.diff(y)))), 1).astype(int)
        piece = np.repeat(np.arange(len(steps)), steps)
        way = np.append(piece + (np.arange(len(piece)) - (np.cumsum(steps) - steps)[piece]) / steps[piece], len(steps))
        columns, rows = (np.rint(np.interp(way, np.arange(len(x)), one)).astype(int) for one in (x, y))
        inside = (columns >= 0) & (columns < across) & (rows >= 0) & (rows < down)
        columns, rows = columns[inside], rows[inside]
        if self.braille:
            dots = _DOTS[rows % 4, columns % 2]
            columns, rows = columns // 2, rows // 4
            np.bitwise_or.at(self._bits, (rows, columns), dots)
        for column, row in set(zip(columns.tolist(), rows.tolist())):
            if not self.braille and (role.startswith("curve") or self._letters[row][column] == " "):
                self._letters[row][column] = LOOKS[int(role[5:])].character if role.startswith("curve") else "."
            self._roles[row][column] = role

    def write(self, column: int, row: int, text: str, role: str) -> None:
        """Write a text over what is drawn."""
        end = column
        for letter in text:
            start, end = end, end + width(letter)
            if start == end:  # a mark on the letter before it, as the dots of θ̈
                self._letters[row][end - 1] += letter
            for place in range(start, end):
                self._letters[row][place] = letter if place == start else ""
                self._bits[row, place] = 0
                self._roles[row][place] = role

    @property
    def used(self) -> tuple[int, int]:
        """The first row in which something stands, and the row after the last one."""
        rows = [k for k in range(self.rows) if self._bits[k].any() or "".join(self._letters[k]).strip()] or [0]
        return rows[0], rows[-1] + 1

    def line_of(self, row: int) -> Line:
        """Return a row of the canvas, neighbours of one role as one piece."""
        drawn = zip(self._bits[row].tolist(), self._letters[row], self._roles[row])
        return tuple(
            Piece("".join(chr(_BLANK + bits) if bits else letter for bits, letter, _ in alike), role)
            for role, alike in groupby(drawn, key=itemgetter(2))
        )
