"""A picture as lines of characters, for a terminal: curves in dots of Braille or in letters, with axes and labels."""

from collections.abc import Iterator
from itertools import groupby
from operator import itemgetter

import numpy as np

from kurbel.arrays import Array
from kurbel.render import Look
from kurbel.render.picture import Medium, PanelFrame, axis_text, dense, legend_text, looks_of, ticks
from kurbel.render.text import BLANK, Line, Piece, folded, line, padded, paragraph, width
from kurbel.report.picture import Panel, Picture

# lengths in columns; a row is as high as two columns are wide
TERMINAL = Medium(letter=1.0, line=2.0, dot=0.0, grain=(1.0, 2.0), covering=1.5, shortest=13.5, tallest=59.5)
_WIDTH, _NARROWEST, _WIDEST = 80, 24, 160
_TALL, _SHORT = 32.0, 20.0
"""Height of a panel alone and of one among several."""
_BRAILLE = np.array([[0x01, 0x08], [0x02, 0x10], [0x04, 0x20], [0x40, 0x80]])
"""Bits of the dots of a character, four down and two across."""
_LETTERS = {"rule": ".", **{f"curve{number}": letter for number, letter in enumerate("*+ox#@")}}
"""What draws a line of each role where there is no Braille."""
_ROLES = {"member": "curve0", "arrow": "curve1", "force": "curve1"}
"""How parts of mechanisms are drawn; others are thin lines."""
_OUTLINED = {"wall": "rule", "metal": "curve0", "rod": "curve0", "web": "curve2"}
"""Looks of bodies whose outlines are drawn."""


class Canvas:
    """Characters (rows, columns) with dots in them, written over with texts; each has the role of what is in it.

    braille: whether there are dots; else a letter represents its curve.
    """

    def __init__(self, columns: int, rows: int, braille: bool) -> None:
        self.columns, self.braille = columns, braille
        self._bits = _BRAILLE if braille else np.array([[1]])
        self._dots = np.zeros((rows, columns), dtype=int)
        self._texts = [[" "] * columns for _ in range(rows)]
        self._roles = [["text"] * columns for _ in range(rows)]
        down, across = self._bits.shape
        self.dot = 1 / across, 2 / down
        """Width and height of a dot, in columns."""

    def line(self, x: Array, y: Array, role: str) -> None:
        """Draw a line through places (n,), counted in columns from the upper left corner; what is beyond is cut off."""
        down, across = self._bits.shape
        columns, rows = (np.rint(one).astype(int) for one in dense(x / self.dot[0], y / self.dot[1]))
        tall, wide = self._dots.shape
        inside = (columns >= 0) & (columns < across * wide) & (rows >= 0) & (rows < down * tall)
        columns, rows = columns[inside], rows[inside]
        np.bitwise_or.at(self._dots, (rows // down, columns // across), self._bits[rows % down, columns % across])
        for column, row in set(zip((columns // across).tolist(), (rows // down).tolist())):
            self._roles[row][column] = role

    def write(self, column: int, row: int, text: str, role: str) -> None:
        """Write a text over what is drawn, in the last row if it is below that."""
        row = min(row, len(self._texts) - 1)
        for letter in text:
            wide = width(letter)
            if not wide:  # a mark on the letter before it, as the dots of θ̈
                self._texts[row][column - 1] += letter
            for place in range(column, column + wide):
                self._texts[row][place] = letter if place == column else ""
                self._dots[row, place] = 0
                self._roles[row][place] = role
            column += wide

    def lines(self) -> list[Line]:
        """Return the rows, neighbours of one role as one piece."""
        return [
            tuple(
                Piece("".join(self._sign(*one) for one in each), role)
                for role, each in groupby(zip(dots, texts, roles), key=itemgetter(2))
            )
            for dots, texts, roles in zip(self._dots.tolist(), self._texts, self._roles)
        ]

    def _sign(self, dots: int, text: str, role: str) -> str:
        if not dots:
            return text
        return chr(0x2800 + dots) if self.braille else _LETTERS[role]


def braille(picture: Picture, look: Look) -> Iterator[Line]:
    """Yield a picture line by line, in the width of the look."""
    wide = min(max(look.width or _WIDTH, _NARROWEST), _WIDEST)
    yield from paragraph(look.text(picture.heading), wide, "title")
    for panel in picture.panels:
        yield BLANK
        yield from _panel(panel, look, wide, _TALL if len(picture.panels) == 1 else _SHORT)


def _panel(panel: Panel, look: Look, wide: int, tall: float) -> Iterator[Line]:
    has_dots = look.has("⣿")
    dot = (0.5, 0.5) if has_dots else (1.0, 2.0)
    side, needed, up = -1, 0, []  # columns of the texts at the left, which are others in a narrower frame
    while side < needed:
        side = needed
        frame = PanelFrame(panel, look, TERMINAL, wide - side - dot[0], tall - dot[1])
        up = [] if panel.plain else ticks(panel.y, frame.y, int(tall / 4), look)
        needed = max((width(text) + 1 for _, text in up), default=0)
    canvas = Canvas(wide - side, int(frame.tall // 2) + 1, has_dots)
    _draw(canvas, frame)
    _label(canvas, frame)
    named = [legend_text(curve.name, look) for curve in panel.curves if curve.kind == "line" and curve.name.words]
    above = [look.text(panel.title), "" if panel.plain else axis_text(panel.y, look)]
    above += [", ".join(named)] if len(named) > 1 else []
    yield from paragraph("   ".join(filter(None, above)), wide)
    rows = canvas.lines()
    if panel.plain:
        used = [number for number, row in enumerate(rows) if "".join(piece.text for piece in row).strip()]
        yield from rows[used[0] : used[-1] + 1]
        yield from (line(one, "unit") for one in folded(look.text(panel.footnote), wide) if one)
        return
    at = {int(place // 2): text for place, text in up}
    for number, row in enumerate(rows):
        yield (*line(padded(at.get(number, ""), side - 1, True) + " ", "unit"), *row)

    # the axis below, its ticks, and what runs along it
    rule, under = [look.text("─")] * canvas.columns, [" "] * canvas.columns
    for place, left, text in frame.ticks_across(max(2, canvas.columns // 10), 0.0, canvas.columns):
        rule[int(place)] = "┴" if look.has("┴") else "+"
        under[round(left) : round(left) + len(text)] = text
    yield line(" " * side + "".join(rule), "rule")
    yield line(" " * side + "".join(under).rstrip(), "unit")
    yield from (line(padded(text, wide, True), "unit") for text in frame.below)


def _draw(canvas: Canvas, frame: PanelFrame) -> None:
    """Draw curves, or bars where there are none; areas between curves are left blank."""
    panel = frame.panel.at_moment(0)
    drawn = [
        (_OUTLINED[of], (places[0].real, places[0].imag))
        for body in panel.bodies
        for of, places in body.outlines()
        if of in _OUTLINED
    ]
    for curve, look in zip(panel.curves, looks_of(panel)):
        role = f"curve{look}" if curve.kind in ("line", "dots") else _ROLES.get(curve.kind, "rule")
        if curve.kind not in ("fixed", "beads", "pole"):
            drawn += [(role, piece) for piece in (*curve.pieces(), *curve.jumps())]
    # the lines to compare with first, so that curves are over them
    for role, points in sorted(drawn, key=lambda one: one[0] != "rule"):
        places = frame.place(*points)
        canvas.line(places.real, places.imag, role)
    for shade in () if panel.curves else panel.shades:
        start, end = frame.x.place(shade.x[[0, -1]])
        ends, step = frame.y.place(np.array([shade.low[0], shade.high[0]])), canvas.dot[0]
        for place in np.arange(np.ceil(start / step), end / step, 1 if shade.gain else 2) * step:
            canvas.line(np.full(2, place), ends, "curve0" if shade.gain else "curve1")


def _label(canvas: Canvas, frame: PanelFrame) -> None:
    """Write captions and labels over what is drawn."""
    for one in frame.panel.captions:
        at, text = complex(frame.place(one.place.real, one.place.imag)), frame.look.text(one.text)
        left = min(max(round(at.real - width(text) / 2), 0), canvas.columns - width(text))
        canvas.write(left, round(at.imag / 2), text, "head" if one.strong else "unit")
    for label in frame.labels(named=True):
        role = "head" if label.look is None else f"curve{label.look}"
        canvas.write(round(label.left), round(label.top / 2), label.text, role)
