"""The picture of the heat release, and the axis of angles after the dead centre that pictures of traces share."""

from collections.abc import Iterator

import numpy as np

from kurbel.arrays import Array
from kurbel.mechanisms.setting import Setting
from kurbel.pictures.picture import Axis, Curve, Mark, PageFigure, Panel, Words
from kurbel.pictures.picture_source import Source

_SHARES = {"phi_burnt_05": 0.05, "phi_burnt_50": 0.5, "phi_burnt_90": 0.9}
"""Key value -> burnt share that is reached there."""
_POINTS = 1000
"""Points of each curve."""


def after_dead_centre(setting: Setting) -> Axis:
    """Return the axis of crank angles after the chamber's own dead centre."""
    centre = "firing dead centre" if setting.cycle == 720 else "dead centre"
    words = f"crank angle after the {centre} of the chamber"
    return Axis(Words("φ", "phi", words), "angle")


def at_dead_centres(setting: Setting, angles: Array, values: Array) -> Iterator[Curve]:
    """Yield an upright line, as high as the values are, at each dead centre between the angles, with its name."""
    heights = np.array([values.min(), values.max()])
    for name, centre in zip(("inner", "outer"), setting.mechanism.dead_centres()):
        for turn in (-360.0, 0.0, 360.0):
            after = centre - setting.own_dead_centre + turn
            if angles[0] < after < angles[-1]:
                yield Curve(Words(f"{name} dead centre"), np.full(2, after), heights, "faint")


def heat_release(source: Source) -> Iterator[Panel]:
    """Heat released per degree of crank angle, and the share x_b of all heat that is released so far, over the crank
    angle after the firing dead centre, less what the walls take."""
    gas = source.results.drive.own_gas
    heat = gas.heat if gas else None
    if heat is None:
        return
    released = heat.released
    begin, end = released.span
    angles = np.linspace(begin, end, _POINTS)
    rates = released.rate_at(angles)
    burnt = released.burnt_at(angles)
    across = after_dead_centre(heat.setting)

    # the rate, with its largest value
    rate, fastest = released.fastest
    curves = (
        *at_dead_centres(heat.setting, angles, rates),
        Curve(source.words("dQ"), angles, rates),
    )
    figure = PageFigure(source.words("heat_rate_max"), rate, at_deg=fastest)
    marks: tuple[Mark, ...] = (Mark(fastest, rate, figure),)
    yield Panel(across, source.axis("dQ"), curves, marks=marks)

    # the share, with the angles that are key values
    curves = (
        *at_dead_centres(heat.setting, angles, burnt),
        Curve(source.words("x_b"), angles, burnt),
    )
    points = []
    for id, share in _SHARES.items():
        angle = released.angle_at(share)
        points.append(Mark(angle, share, PageFigure(source.words(id), at_deg=angle)))
    yield Panel(across, source.axis("x_b"), curves, marks=tuple(points))
