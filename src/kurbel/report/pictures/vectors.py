"""The ways of the tips of vectors over the cycle: what is free of the whole machine, and the loads on its bearings."""

from collections.abc import Iterator

import numpy as np

from kurbel.arrays import Array
from kurbel.crank_angle import CrankAngle
from kurbel.declared.unit_systems import convert
from kurbel.numerics.extreme import Extreme
from kurbel.report.pictures.picture import Axis, Curve, Panel, Words
from kurbel.report.pictures.sampling import Samples, pieces
from kurbel.report.pictures.source import Source, mark

_FRAMES = {
    "load_throw": "throw: outward →",
    "load_engine": "engine: stroke line →",
    "load_rod": "rod: its line →",
}
_F = Words("F")


def free_vectors(source: Source) -> Iterator[Panel]:
    """Yield the way of the tip of the free force, and of the free moment, over a turn."""
    for ids, largest in ((("F_x", "F_y"), "F_free_max"), (("M_x", "M_y"), "M_free_max")):
        if source.having(ids) == ids:
            samples = source.samples(ids)
            extreme = getattr(source.results, largest)
            at = np.array([extreme.degrees if extreme else 0.0])
            tip = source.values(ids, at, at)[:, 0]
            x, y = map(source.words, ids)
            yield _panel(source, samples, (x, y, y), largest, extreme, tip)


def polar_loads(source: Source) -> Iterator[Panel]:
    """Yield a panel for each frame, what its directions count from to the right."""
    for frame in source.having(_FRAMES):
        yield _polar(source, frame)._replace(title=_FRAMES[frame])


def _polar(source: Source, frame: str) -> Panel:
    def tip(degrees: Array, within: Array) -> Array:
        """Return the load (2, n) in N along and across the direction from which its angle counts."""
        load, direction = source.values(("load", frame), degrees, within)
        # a load of nothing has no direction
        angle = CrankAngle.of(np.where(load > 0, np.nan_to_num(direction), 0.0))
        return np.stack([load * angle.cos, load * angle.sin])

    samples = source.sampled(("load", "load"), tip)
    extreme = next((found for quantity, found in source.extremes("load") if quantity.id == "load_max"), None)
    at = np.full(2, extreme.degrees if extreme else 0.0)
    # at a jump the largest load stands on one of its sides
    sides = tip(at, at + np.array([-1e-6, 1e-6]))
    side = int(np.argmin(np.abs(np.hypot(*sides) - (extreme.value if extreme else 0.0))))
    return _panel(source, samples, (_F, _F, source.words("load")), "load_max", extreme, sides[:, side])


def _panel(
    source: Source, samples: Samples, names: tuple[Words, Words, Words], id: str, largest: Extreme | None, tip: Array
) -> Panel:
    """Return the way of a tip (2, n); names: of both axes and of the curve; tip: where the largest, called id, is."""
    quantity = source.results.lists.key_values(source.results.command)[id]
    unit = source.unit(quantity.kind, *samples.values)
    x, y = convert(samples.values, quantity.kind, unit)
    curve = Curve(names[2], pieces(samples, x, y))
    found = (largest,) if largest and largest.value else ()
    marks = tuple(mark(quantity, one, unit, *convert(tip, quantity.kind, unit).tolist()) for one in found)
    return Panel(Axis(names[0], unit), Axis(names[1], unit), (curve,), marks=marks, equal=True)
