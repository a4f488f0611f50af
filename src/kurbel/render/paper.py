"""Pictures on sheets of paper: of each picture, and of each crank angle for which it is drawn, a sheet that it fills."""

import math
from collections.abc import Iterable, Iterator
from itertools import groupby
from typing import NamedTuple

from kurbel.pictures.picture import Panel, Picture
from kurbel.render import Look
from kurbel.render.picture import Medium
from kurbel.render.svg import PAPER_SIZES, panel_height, sheet_svg

A4, LETTER, FIT = "a4", "letter", "fit"
"""Sizes of paper; `fit` is one sheet as large as the pictures."""
_ASIDE, _ABOVE_AND_BELOW = 28.0, 48.0
"""What margins, footer and caption take of the width and of the height of a sheet, in mm."""


_TALLEST = tuple(PAPER_SIZES.tallest - 20.0 * step for step in range(13))
"""Heights of panels of one scale, of which the first is taken with which the picture fits on a sheet."""


class Paper(NamedTuple):
    """A size of paper: its word in typst, width and height in mm."""

    word: str
    wide: float
    tall: float

    def height_over_width(self, lies: bool) -> float:
        """Return that of the room for a picture; lies: the longer side is below."""
        wide, tall = (self.tall, self.wide) if lies else (self.wide, self.tall)
        return (tall - _ABOVE_AND_BELOW) / (wide - _ASIDE)


PAPERS = {A4: Paper("a4", 210.0, 297.0), LETTER: Paper("us-letter", 215.9, 279.4)}


class Sheet(NamedTuple):
    """A picture drawn for a sheet; lies: the longer side is below; tall: the height of the drawing over its width."""

    picture: Picture
    lies: bool
    tall: float
    svg: str


def sheets(pictures: Iterable[Picture], paper: Paper, look: Look) -> Iterator[Sheet]:
    """Yield the sheets of pictures; a picture that is too tall for one has its next panels on further ones."""
    for picture in pictures:
        for _, of_angle in groupby(picture.panels, lambda panel: panel.angle):
            at_angle = picture._replace(panels=tuple(of_angle))
            for part, medium in _parts(at_angle, paper, look):
                yield _filled(part, paper, look, medium)


def _parts(picture: Picture, paper: Paper, look: Look) -> Iterator[tuple[Picture, Medium]]:
    """Yield a picture as it fits on an upright sheet, with lower panels of one scale if need be, or else in parts."""
    room = paper.height_over_width(lies=False)
    height = panel_height(picture)
    for tallest in _TALLEST:
        medium = PAPER_SIZES._replace(tallest=tallest)
        tall, _ = sheet_svg(picture, look, height, medium)
        if tall <= room:
            yield picture, medium
            return

    # row by row as many as there is room for
    part: tuple[Panel, ...] = ()
    tall = 0.0
    for row in picture.rows:
        row_tall, _ = sheet_svg(row, look, height, PAPER_SIZES)
        if part and tall + row_tall > room:
            yield picture._replace(panels=part), PAPER_SIZES
            part = ()
            tall = 0.0
        part += row.panels
        tall += row_tall
    yield picture._replace(panels=part), PAPER_SIZES


def _filled(picture: Picture, paper: Paper, look: Look, medium: Medium) -> Sheet:
    """Return a picture on a sheet that lies or not, whichever shows it larger, with panels as tall as there is room."""
    height = panel_height(picture)
    tall, svg = sheet_svg(picture, look, height, medium)

    # as wide as the width of the sheet, or its height, allows
    upright_room = paper.height_over_width(lies=False)
    lying_room = paper.height_over_width(lies=True)
    upright_width = (paper.wide - _ASIDE) * min(1.0, upright_room / tall)
    lying_width = (paper.tall - _ASIDE) * min(1.0, lying_room / tall)
    lies = lying_width > upright_width

    # panels with a scale for each axis take what is left of the height
    room = lying_room if lies else upright_room
    taller_by_one, _ = sheet_svg(picture, look, height + 1.0, medium)
    if tall < taller_by_one <= room:
        more = math.floor((room - tall) / (taller_by_one - tall))
        filling = min(height + more, PAPER_SIZES.tallest)
        tall, svg = sheet_svg(picture, look, filling, medium)
    return Sheet(picture, lies, tall, svg)
