"""A picture as lines of characters, for a terminal: curves in dots of Braille or in letters, with axes and labels."""

from collections.abc import Iterable, Iterator, Sequence
from itertools import groupby
from operator import itemgetter

import numpy as np

from kurbel.arrays import ComplexArray
from kurbel.pictures.picture import Panel, Picture
from kurbel.render import Look
from kurbel.render.picture import (
    Medium,
    PanelFrame,
    axis_text,
    dense,
    legend_text,
    looks_of,
    panel_title,
    ticks,
)
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

    def line(self, points: ComplexArray, role: str) -> None:
        """Draw a line through points x + iy (n,); what is beyond is cut off."""
        down, across = self._bits.shape
        x, y = dense(points.real / self.dot[0], points.imag / self.dot[1])
        columns, rows = np.rint(x).astype(int), np.rint(y).astype(int)
        is_across = (columns >= 0) & (columns < across * self.columns)
        is_down = (rows >= 0) & (rows < down * len(self._dots))
        inside = is_across & is_down
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
        lines = []
        for dots, texts, roles in zip(self._dots.tolist(), self._texts, self._roles):
            signs = map(self._sign, dots, texts, roles)
            pieces = list[Piece]()
            for role, run in groupby(zip(roles, signs), key=itemgetter(0)):
                pieces.append(Piece("".join(sign for _, sign in run), role))
            lines.append(tuple(pieces))
        return lines

    def _sign(self, dots: int, text: str, role: str) -> str:
        """Return what is in a cell: its text, or its dots."""
        if not dots:
            return text
        if self.braille:
            return chr(0x2800 + dots)
        return _LETTERS[role]


def braille(picture: Picture, look: Look) -> Iterator[Line]:
    """Yield a picture line by line, in the width of the look."""
    wide = min(max(look.width or _WIDTH, _NARROWEST), _WIDEST)
    yield from paragraph(look.text(picture.heading), wide, "title")
    for panel in picture.panels:
        yield BLANK
        yield from _panel(panel, look, wide, _TALL if len(picture.panels) == 1 else _SHORT)


def _panel(panel: Panel, look: Look, wide: int, tall: float) -> Iterator[Line]:
    """Yield a panel: what is above it, its rows, and what is below it."""
    has_dots = look.has("⣿")
    frame, side, up = _frame(panel, look, wide, tall, (0.5, 0.5) if has_dots else (1.0, 2.0))
    rows = int(frame.tall // 2) + 1
    canvas = Canvas(wide, rows if panel.plain else rows + 2, side, has_dots)
    _draw(canvas, frame)
    _label(canvas, frame, rows)
    if not panel.plain:
        _write_axes(canvas, frame, rows, up)

    above = [panel_title(panel, look)]
    if not panel.plain:
        above.append(axis_text(panel.y, look))
    lines = [curve for curve in panel.curves if curve.kind == "line" and curve.name.words]
    if len(lines) > 1:
        above.append(", ".join(legend_text(curve.name, look) for curve in lines))
    yield from paragraph("   ".join(filter(None, above)), wide)

    yield from _without_blank_ends(canvas.lines())
    if panel.plain:
        for text in folded(look.text(panel.footnote), wide):
            if text:
                yield line(text, "unit")
    else:
        for text in frame.below:
            yield line(padded(text, wide, True), "unit")


def _frame(
    panel: Panel, look: Look, wide: int, tall: float, dot: tuple[float, float]
) -> tuple[PanelFrame, int, list[tuple[float, str]]]:
    """Return the frame of a panel, the columns of the texts at its left, and these texts with their places.

    A narrower frame may have other texts, so that it is made anew until they fit.
    """
    side, needed = -1, 0
    while side < needed:
        side = needed
        frame = PanelFrame(panel, look, TERMINAL, wide - side - dot[0], tall - dot[1])
        up = [] if panel.plain else list(ticks(frame.y, int(tall / 4), look))
        needed = max((width(text) + 1 for _, text in up), default=0)
    return frame, side, up


def _write_axes(
    canvas: Canvas, frame: PanelFrame, rows: int, up: Iterable[tuple[float, str]]
) -> None:
    """Write the numbers at the left, and the rule below with its numbers."""
    look = frame.look
    for row, text in up:
        canvas.write(-1 - width(text), int(row // 2), text, "unit")
    canvas.write(0, rows, look.text("─") * canvas.columns, "rule")
    count = max(2, canvas.columns // 10)
    for column, left, text in frame.ticks_across(count, 0.0, canvas.columns):
        canvas.write(int(column), rows, "┴" if look.has("┴") else "+", "rule")
        canvas.write(round(left), rows + 1, text, "unit")


def _without_blank_ends(lines: Sequence[Line]) -> Sequence[Line]:
    """Return lines without the blank ones before the first and after the last that is not."""
    used = []
    for number, pieces in enumerate(lines):
        if "".join(piece.text for piece in pieces).strip():
            used.append(number)
    return lines[used[0] : used[-1] + 1]


def _draw(canvas: Canvas, frame: PanelFrame) -> None:
    """Draw curves, or bars where there are none; areas between curves are left blank."""
    panel = frame.panel.at_moment(0)
    # the lines to compare with first, so that curves are over them
    lines = sorted(_lines_of(panel, frame), key=lambda line: line[0] != "rule")
    for role, points in lines:
        canvas.line(points, role)
    if panel.curves:
        return
    step = canvas.dot[0]
    for shade in panel.shades:
        low_and_high = np.array([shade.low[0], shade.high[0]])
        ends = frame.place(shade.x[[0, -1]], low_and_high)
        role, spacing = ("curve0", 1) if shade.gain else ("curve1", 2)
        for dots in np.arange(np.ceil(ends[0].real / step), ends[1].real / step, spacing):
            canvas.line(dots * step + 1j * ends.imag, role)


def _lines_of(panel: Panel, frame: PanelFrame) -> Iterator[tuple[str, ComplexArray]]:
    """Yield the outlines of bodies, and the curves, with their roles."""
    for body in panel.bodies:
        for look, outlines in body.outlines():
            if look in _OUTLINED:
                yield _OUTLINED[look], frame.place(outlines[0].real, outlines[0].imag)
    for curve, number in zip(panel.curves, looks_of(panel)):
        is_coloured = curve.kind in ("line", "dots")
        role = f"curve{number}" if is_coloured else _ROLES.get(curve.kind, "rule")
        if curve.kind not in ("fixed", "beads", "pole"):
            for piece in (*curve.pieces(), *curve.jumps()):
                yield role, frame.place(*piece)


def _label(canvas: Canvas, frame: PanelFrame, rows: int) -> None:
    """Write captions and labels over what is drawn in these rows."""
    for caption in frame.panel.captions:
        centre = complex(frame.place(caption.place.real, caption.place.imag))
        text = frame.look.text(caption.text)
        left = min(max(round(centre.real - width(text) / 2), 0), canvas.columns - width(text))
        row = min(round(centre.imag / 2), rows - 1)
        canvas.write(left, row, text, "head" if caption.strong else "unit")
    for label in frame.labels(named=True):
        role = "head" if label.look is None else f"curve{label.look}"
        canvas.write(round(label.left), min(round(label.top / 2), rows - 1), label.text, role)
