"""The turning effort of the whole machine with its lobes; excess work, speed and coupling below it."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from kurbel.declared.unit_systems import convert
from kurbel.report.pictures.cylinder import between
from kurbel.report.pictures.picture import Axis, Curve, Figure, Panel, Shade, Words, extent
from kurbel.report.pictures.sampling import pieces
from kurbel.report.pictures.source import PHI, Source, level, words

_MOST_NUMBERED = 24


def effort(source: Source) -> Iterator[Panel]:
    """Yield the turning effort with the resistance, its lobes numbered with their work, and the speed line below."""
    yield _effort(source)
    for id, mean in (("E", None), ("omega", "omega_mean"), ("M_coupling", "M_mean")):
        if source.having((id,)):
            panel = source.panel((id,))
            yield _with_mean(source, panel, id, mean) if mean else panel


def _with_mean(source: Source, panel: Panel, id: str, mean: str) -> Panel:
    value = getattr(source.results, mean)
    quantity = source.results.lists.key_values("flywheel")[mean]
    every = [piece for curve in panel.curves for piece in curve.pieces]
    line = level(words(quantity), float(convert(value, source.quantity(id).kind, panel.y.unit)), extent(every, "x"))
    return panel._replace(curves=(*panel.curves, line))


def _effort(source: Source) -> Panel:
    results = source.results
    at_crank = bool(source.having(("T",)))
    id, kind, over = ("T", "force", results.crank) if at_crank else ("M", "torque", 1.0)
    samples = source.samples((PHI, id, "M_load"), results.phi_crossing)
    unit = source.unit(kind, samples.values[1])
    x = samples.values[0]
    line, load = convert(samples.values[1], kind, unit), convert(samples.values[2] / over, kind, unit)
    name = source.words(id)
    level_load = results.machine.load is None or results.machine.load.diagram is None
    resistance = Words("W", "W") if at_crank else Words(*("M_m" if level_load else "M_W",) * 2)
    curves = (
        Curve(name, pieces(samples, x, line)),
        Curve(resistance, pieces(samples, x, load), kind="faint" if level_load else "line"),
    )
    shades = list(between(x, load, line))
    marks = tuple(source.marks(id, unit))
    return Panel(Axis(source.words(PHI), "deg"), Axis(name, unit), curves, tuple(_numbered(source, shades)), marks)


def _numbered(source: Source, shades: list[Shade]) -> Iterator[Shade]:
    """Yield the lobes with their numbers and works; of one that the end of the cycle cuts, the wider part has them."""
    results = source.results
    crossings, lobes = results.phi_crossing, results.lobes
    if not 0 < len(lobes) <= _MOST_NUMBERED:
        yield from shades
        return
    owners = [int(np.searchsorted(crossings, (shade.x[0] + shade.x[-1]) / 2) - 1) % len(lobes) for shade in shades]
    for shade, owner in zip(shades, owners):
        widest = max((other.x[-1] - other.x[0] for other, one in zip(shades, owners) if one == owner))
        if shade.x[-1] - shade.x[0] < widest:
            yield shade
            continue
        unit = source.unit("energy", results.lobes)
        name = Words(f"A_{owner + 1}", f"A_{owner + 1}")
        yield shade._replace(figure=Figure(name, float(convert(lobes[owner], "energy", unit)), unit))
