"""The pictures of the whole machine: turning effort with its lobes, orders as bars, vibrations of the shaft line."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from kurbel.declared.unit_systems import convert
from kurbel.report.pictures.cylinder import between
from kurbel.report.pictures.picture import Axis, Curve, Figure, Panel, Piece, Shade, Words
from kurbel.report.pictures.sampling import pieces
from kurbel.report.pictures.source import PHI, Source, level, words

_MOST_NUMBERED = 24
_HIGHEST = 12
"""Order up to which bars are drawn: beyond it they are too small to be seen."""
_MODES = 4
_LONGEST_NAME = 14
_BAR = 0.38
_SENSES = "left: circles with the rotation, right: against it"


def effort(source: Source) -> Iterator[Panel]:
    """Yield the turning effort with the resistance, its lobes numbered with their work, and the speed line below."""
    yield _effort(source)
    for id, mean in (("E", None), ("omega", "omega_mean"), ("M_coupling", "M_mean")):
        if source.having((id,)):
            panel = source.panel((id,))
            if mean:
                quantity = source.results.lists.key_values("flywheel")[mean]
                height = convert(getattr(source.results, mean), source.quantity(id).kind, panel.y.unit)
                line = level(panel.curves, float(height), words(quantity))
                panel = panel._replace(curves=(*panel.curves, line))
            yield panel


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
    resistance = Words("W") if at_crank else Words("M_m" if level_load else "M_W")
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
        name = Words(f"A_{owner + 1}")
        yield replace(shade, figure=Figure(name, float(convert(lobes[owner], "energy", unit)), unit))


def torque_orders(source: Source) -> Iterator[Panel]:
    """Yield the amplitudes of the torque by order, of gas and of inertia apart where both are known."""
    found = source.results.machine
    shown = source.results.orders <= _HIGHEST
    orders = source.results.orders[shown].tolist()
    whole = np.abs(found.whole.amplitudes)[shown].tolist()
    yield _bars(source, orders, [whole], "|M_ν|", "torque", "all")
    if found.inertia is not None:
        apart = [np.abs(one.amplitudes)[shown].tolist() for one in (found.gas, found.inertia)]
        yield _bars(source, orders, apart, "|M_ν|", "torque", "left: gas, weight, friction; right: inertia")


def free_orders(source: Source) -> Iterator[Panel]:
    """Yield the circles that make the free force and the free moment, order by order."""
    if not source.having(("F_x",)):
        return
    omega, free = source.results.omega, source.results.free
    for name, kind, vector in (("F", "force", free.force), ("M", "torque", free.moment)):
        if vector is not None and free.orders:
            sizes = [[abs(vector.of(sense * n)) * omega * omega for n in free.orders] for sense in (1, -1)]
            yield _bars(source, free.orders, sizes, name, kind, _SENSES)


def shaft_modes(source: Source) -> Iterator[Panel]:
    """Yield how far the masses of the shaft line turn in its first modes, the largest of each as one."""
    found = source.results
    last = min(_MODES, found.first + len(found.modes.omegas) - 1)
    curves = []
    for mode in range(1, last + 1):
        angles = np.asarray(found.holzer(mode).angles, dtype=float)
        frequency = float(found.modes.omegas[mode - found.first]) / (2 * math.pi)
        name = f"{mode}: {frequency:.4g} Hz"
        shape = angles / np.abs(angles).max()
        curves.append(Curve(Words(name), (Piece(np.arange(float(len(shape))), shape),)))
    if curves:
        names = tuple(mass.name[:_LONGEST_NAME] for mass in found.line.masses)
        yield Panel(Axis(Words(""), "", names=names), Axis(Words("θ"), ""), (*curves, level(curves)))


def _bars(
    source: Source, orders: Sequence[float], sizes: Sequence[Sequence[float]], name: str, kind: str, title: str
) -> Panel:
    """Return sizes in SI of one or two sorts as bars over orders, side by side."""
    unit = source.unit(kind, np.array(sizes))
    wide = 2 * _BAR / len(sizes)
    shades = []
    for number, sort in enumerate(sizes):
        for place, size in enumerate(convert(np.array(sort), kind, unit)):
            left = place - _BAR + number * wide
            edges = np.array([left, left + wide])
            shades.append(Shade(edges, np.zeros(2), np.full(2, size), gain=number == 0))
    names = tuple(f"{order:g}" for order in orders)
    x = Axis(Words("n"), "", low=-0.6, high=len(names) - 0.4, names=names)
    return Panel(x, Axis(Words(name), unit, low=0.0), shades=tuple(shades), title=title)
