"""A picture as lines of characters, for a terminal: curves in dots of Braille or in letters, with axes and labels."""

from collections.abc import Iterator
from itertools import groupby
from operator import itemgetter

import numpy as np

from kurbel.arrays import ComplexArray
from kurbel.pictures.picture import Panel, Picture
from kurbel.render import Look
from kurbel.render.picture import Medium, PanelFrame, axis_text, dense, legend_text, looks_of, ticks
from kurbel.render.text import BLANK, Line, Piece, folded, line, padded, paragraph, width

# lengths in columns; a row is as high as two columns are wide
TERMINAL = Medium(
    letter=1.0, line=2.0, dot=0.0, grain=(1.0, 2.0), covering=1.5, shortest=13.5, tallest=59.5
)
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

    Places are counted in columns from `side`, to the right of what is written beside a picture. braille: whether there
    are dots; else a letter represents its curve.
    """

    def __init__(self, columns: int, rows: int, side: int, braille: bool) -> None:
        self.columns, self.side, self.braille = columns - side, side, braille
        self._bits = _BRAILLE if braille else np.array([[1]])
        self._dots = np.zeros((rows, columns), dtype=int)
        self._texts = np.full((rows, columns), " ", dtype=object)
        self._roles = np.full((rows, columns), "text", dtype=object)
        down, across = self._bits.shape
        self.dot = 1 / across, 2 / down
        """Width and height of a dot, in columns."""

    def line(self, places: ComplexArray, role: str) -> None:
        """Draw a line through places x + iy (n,); what is beyond is cut off."""
        down, across = self._bits.shape
        columns, rows = (
            np.rint(one).astype(int)
            for one in dense(places.real / self.dot[0], places.imag / self.dot[1])
        )
        inside = (
            (columns >= 0)
            & (columns < across * self.columns)
            & (rows >= 0)
            & (rows < down * len(self._dots))
        )
        columns, rows = columns[inside] + across * self.side, rows[inside]
        cells = rows // down, columns // across
        np.bitwise_or.at(self._dots, cells, self._bits[rows % down, columns % across])
        self._roles[cells] = role

    def write(self, column: int, row: int, text: str, role: str) -> None:
        """Write a text over what is drawn."""
        column += self.side
        for letter in text:
            wide = width(letter)
            if not wide:  # a mark on the letter before it, as the dots of θ̈
                self._texts[row, column - 1] += letter
            else:
                cells = row, slice(column, column + wide)
                self._texts[cells], self._dots[cells], self._roles[cells] = "", 0, role
                self._texts[row, column] = letter
            column += wide

    def lines(self) -> list[Line]:
        """Return the rows, neighbours of one role as one piece."""
        found = []
        for row in zip(self._dots.tolist(), self._texts, self._roles):
            signs = (
                (role, text if not dots else chr(0x2800 + dots) if self.braille else _LETTERS[role])
                for dots, text, role in zip(*row)
            )
            pieces = groupby(signs, key=itemgetter(0))
            found.append(
                tuple(Piece("".join(sign for _, sign in each), role) for role, each in pieces)
            )
        return found


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
    side, needed, up = (
        -1,
        0,
        [],
    )  # columns of the texts at the left, which are others in a narrower frame
    while side < needed:
        side = needed
        frame = PanelFrame(panel, look, TERMINAL, wide - side - dot[0], tall - dot[1])
        up = [] if panel.plain else ticks(frame.y, int(tall / 4), look)
        needed = max((width(text) + 1 for _, text in up), default=0)
    rows = int(frame.tall // 2) + 1
    canvas = Canvas(wide, rows if panel.plain else rows + 2, side, has_dots)
    _draw(canvas, frame)
    _label(canvas, frame, rows)
    above = [look.text(panel.title)]
    if not panel.plain:
        above.append(axis_text(panel.y, look))
        for place, text in up:
            canvas.write(-1 - width(text), int(place // 2), text, "unit")
        canvas.write(0, rows, look.text("─") * canvas.columns, "rule")
        for place, left, text in frame.ticks_across(
            max(2, canvas.columns // 10), 0.0, canvas.columns
        ):
            canvas.write(int(place), rows, "┴" if look.has("┴") else "+", "rule")
            canvas.write(round(left), rows + 1, text, "unit")
    named = [
        legend_text(curve.name, look)
        for curve in panel.curves
        if curve.kind == "line" and curve.name.words
    ]
    above += [", ".join(named)] if len(named) > 1 else []
    yield from paragraph("   ".join(filter(None, above)), wide)
    drawn = canvas.lines()
    used = [
        number for number, row in enumerate(drawn) if "".join(piece.text for piece in row).strip()
    ]
    yield from drawn[used[0] : used[-1] + 1]
    if panel.plain:
        yield from (line(one, "unit") for one in folded(look.text(panel.footnote), wide) if one)
    else:
        yield from (line(padded(text, wide, True), "unit") for text in frame.below)


def _draw(canvas: Canvas, frame: PanelFrame) -> None:
    """Draw curves, or bars where there are none; areas between curves are left blank."""
    panel = frame.panel.at_moment(0)
    drawn = [
        (_OUTLINED[of], frame.place(places[0].real, places[0].imag))
        for body in panel.bodies
        for of, places in body.outlines()
        if of in _OUTLINED
    ]
    for curve, look in zip(panel.curves, looks_of(panel)):
        role = f"curve{look}" if curve.kind in ("line", "dots") else _ROLES.get(curve.kind, "rule")
        if curve.kind not in ("fixed", "beads", "pole"):
            drawn += [(role, frame.place(*piece)) for piece in (*curve.pieces(), *curve.jumps())]
    # the lines to compare with first, so that curves are over them
    for role, places in sorted(drawn, key=lambda one: one[0] != "rule"):
        canvas.line(places, role)
    for shade in () if panel.curves else panel.shades:
        ends, step = (
            frame.place(shade.x[[0, -1]], np.array([shade.low[0], shade.high[0]])),
            canvas.dot[0],
        )
        for dots in np.arange(
            np.ceil(ends[0].real / step), ends[1].real / step, 1 if shade.gain else 2
        ):
            canvas.line(dots * step + 1j * ends.imag, "curve0" if shade.gain else "curve1")


def _label(canvas: Canvas, frame: PanelFrame, rows: int) -> None:
    """Write captions and labels over what is drawn in these rows."""
    for caption in frame.panel.captions:
        at, text = (
            complex(frame.place(caption.place.real, caption.place.imag)),
            frame.look.text(caption.text),
        )
        left = min(max(round(at.real - width(text) / 2), 0), canvas.columns - width(text))
        canvas.write(
            left, min(round(at.imag / 2), rows - 1), text, "head" if caption.strong else "unit"
        )
    for label in frame.labels(named=True):
        role = "head" if label.look is None else f"curve{label.look}"
        canvas.write(round(label.left), min(round(label.top / 2), rows - 1), label.text, role)
