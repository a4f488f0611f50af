"""The polar diagrams of pins and main bearings: the way of the tip of the load in every frame that it has."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

from kurbel.crank_angle import CrankAngle
from kurbel.declared.unit_systems import convert
from kurbel.report.pictures.picture import Axis, Curve, Figure, Mark, Panel, Words
from kurbel.report.pictures.sampling import pieces, sampled
from kurbel.report.pictures.source import Source, words

_FRAMES = {
    "load_throw": "throw: outward →",
    "load_engine": "engine: stroke line →",
    "load_rod": "rod: its line →",
}


def polar_loads(source: Source) -> Iterator[Panel]:
    """Yield a panel for each frame, what its directions count from to the right."""
    for frame in source.having(_FRAMES):
        yield _polar(source, frame)


def _polar(source: Source, frame: str) -> Panel:
    found = sampled(
        source.results.breaks, lambda degrees, within: _tip(source, frame, degrees, within), source.fineness
    )
    source.refuse_overflow("load", found.values)
    unit = source.unit("force", found.values)
    x, y = convert(found.values, "force", unit)
    curve = Curve(words(source.quantity("load")), pieces(found, x, y))
    axes = Axis(Words("F", "F"), unit), Axis(Words("F", "F"), unit)
    marks = tuple(_marks(source, frame, unit))
    return Panel(*axes, (curve,), marks=marks, equal=True, title=_FRAMES[frame])


def _tip(source: Source, frame: str, degrees: Any, within: Any) -> Any:
    """Return the load (2, n) in N along and across the direction from which its angle counts."""
    load, direction = source.values(("load", frame), degrees, within)
    # a load of nothing has no direction
    angle = CrankAngle.of(np.where(load > 0, np.nan_to_num(direction), 0.0))
    return np.stack([load * angle.cos, load * angle.sin])


def _marks(source: Source, frame: str, unit: str) -> Iterator[Mark]:
    for quantity, extreme in source.extremes("load"):
        if quantity.id != "load_max" or not extreme.value:
            continue
        at = np.array([extreme.degrees, extreme.degrees])
        # at a jump the largest load stands on one of its sides
        beside = at + np.array([-1e-6, 1e-6])
        tips = _tip(source, frame, at, beside)
        side = int(np.argmin(np.abs(np.hypot(*tips) - extreme.value)))
        x, y = convert(tips[:, side], "force", unit).tolist()
        value = float(convert(extreme.value, "force", unit))
        yield Mark(x, y, Figure(words(quantity), value, unit, extreme.degrees))
