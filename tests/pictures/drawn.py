"""Machines and their pictures, for the tests of this folder."""

from dataclasses import replace
from functools import cache

import numpy as np

from kurbel.machine_file import loads
from kurbel.pictures.picture import Curve, Panel, Picture
from kurbel.pictures.picture_source import PictureOptions
from kurbel.pictures.pictures import pictures, pictures_of
from kurbel.solver.case import Case
from representative import case_of

BAD_NAME = "<script>alert(1)</script> \x1b[31m & \"'"
"""Markup, an escape sequence (which a machine file refuses, but Python does not), and quotation marks."""


@cache
def named() -> Case:
    """A machine whose name is an attack."""
    machine = loads("{speed: 50 rpm, stroke: 800 mm, rod_ratio: 5, masses: {piston: 100 kg}}")
    return Case(replace(machine, name=BAD_NAME))


@cache
def drawn(name: str, id: str) -> tuple[Picture, ...]:
    """A picture of a shipped machine; of its first cylinder, where it shows one."""
    case = case_of(name)
    first = case.cylinders[0].drive.name if case.cylinders else None
    return tuple(pictures(case, (id,), PictureOptions(cylinder=first)))


def ids_of(case: str | Case) -> tuple[str, ...]:
    """The pictures of a shipped machine, or of another."""
    return tuple(
        one.id
        for one in pictures_of(case if isinstance(case, Case) else case_of(case), PictureOptions())
    )


def curve_of(panel: Panel, symbol: str) -> Curve:
    """The curve of this symbol."""
    return next(curve for curve in panel.curves if curve.name.symbol == symbol)


def on_its_side(degrees: np.ndarray) -> np.ndarray:
    """Angles next to crank angles (n,) of a piece, on the side of a jump from which each was computed."""
    before, after = np.diff(degrees, prepend=np.nan), np.diff(degrees, append=np.nan)
    return degrees + np.where(after > 0, after, -before) / 2


def off_line(curve: Curve, points: np.ndarray) -> float:
    """The largest distance of points x + iy (n,) from the nearest line of a curve."""
    least = np.full(len(points), np.inf)
    for x, y in curve.pieces():
        z = x + 1j * y
        start, chord = z[:-1, None], np.diff(z)[:, None]
        along = np.divide(
            points - start,
            chord,
            out=np.zeros((len(start), len(points)), complex),
            where=chord != 0,
        ).real
        least = np.minimum(
            least, np.abs(points - start - along.real.clip(0, 1) * chord).min(axis=0)
        )
    return float(least.max())
