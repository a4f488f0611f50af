"""The orders of the turning effort as bars, and the natural vibrations of the shaft line."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from kurbel.report.pictures.balance import bars
from kurbel.report.pictures.picture import Axis, Curve, Panel, Piece, Words
from kurbel.report.pictures.source import Source, zero_line

_HIGHEST = 12
"""Order up to which bars are drawn: beyond it they are too small to be seen."""
_MODES = 4
_LONGEST_NAME = 14


def torque_orders(source: Source) -> Iterator[Panel]:
    """Yield the amplitudes of the torque by order, of gas and of inertia apart where both are known."""
    found = source.results.machine
    shown = source.results.orders <= _HIGHEST
    orders = source.results.orders[shown].tolist()
    whole = np.abs(found.whole.amplitudes)[shown].tolist()
    yield bars(source, orders, [whole], "|M_ν|", "torque", "all")
    if found.inertia is not None:
        apart = [np.abs(one.amplitudes)[shown].tolist() for one in (found.gas, found.inertia)]
        yield bars(source, orders, apart, "|M_ν|", "torque", "left: gas, weight, friction; right: inertia")


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
