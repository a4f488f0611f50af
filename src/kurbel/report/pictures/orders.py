"""Orders as bars, of the turning effort and of what is free, and the natural vibrations of the shaft line."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np

from kurbel.declared.unit_systems import convert
from kurbel.report.pictures.picture import Axis, Curve, Panel, Piece, Shade, Words
from kurbel.report.pictures.source import Source, zero_line

_HIGHEST = 12
"""Order up to which bars are drawn: beyond it they are too small to be seen."""
_MODES = 4
_LONGEST_NAME = 14
_BAR = 0.38
_SENSES = "left: circles with the rotation, right: against it"


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
            sizes = [
                [abs(side[n - 1]) * omega * omega for n in free.orders] for side in (vector.forward, vector.backward)
            ]
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
        curves.append(Curve(Words(name, name), (Piece(np.arange(float(len(shape))), shape),)))
    if curves:
        names = tuple(mass.name[:_LONGEST_NAME] for mass in found.line.masses)
        yield Panel(Axis(Words("", ""), "", names=names), Axis(Words("θ", "theta"), ""), (*curves, zero_line(curves)))


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
    x = Axis(Words("n", "n"), "", low=-0.6, high=len(names) - 0.4, names=names)
    return Panel(x, Axis(Words(name, name), unit, low=0.0), shades=tuple(shades), title=title)
