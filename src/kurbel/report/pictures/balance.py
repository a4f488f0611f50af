"""The pictures of what is free: the ways of the tips of force and moment over a turn, and their orders as bars."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from kurbel.declared.unit_systems import convert
from kurbel.report.pictures.picture import Axis, Curve, Figure, Mark, Panel, Shade, Words
from kurbel.report.pictures.sampling import pieces
from kurbel.report.pictures.source import Source, words

_BAR = 0.38
_SENSES = "left: circles with the rotation, right: against it"


def free_vectors(source: Source) -> Iterator[Panel]:
    """Yield the way of the tip of the free force, and of the free moment, over a turn."""
    for along, across, largest in (("F_x", "F_y", "F_free_max"), ("M_x", "M_y", "M_free_max")):
        if source.having((along, across)) == (along, across):
            yield _hodograph(source, along, across, largest)


def _hodograph(source: Source, along: str, across: str, largest: str) -> Panel:
    samples = source.samples((along, across))
    kind = source.quantity(along).kind
    unit = source.unit(kind, *samples.values)
    x, y = convert(samples.values, kind, unit)
    curve = Curve(words(source.quantity(across)), pieces(samples, x, y))
    axes = Axis(words(source.quantity(along)), unit), Axis(words(source.quantity(across)), unit)
    return Panel(*axes, (curve,), marks=tuple(_largest(source, along, across, largest, unit)), equal=True)


def _largest(source: Source, along: str, across: str, largest: str, unit: str) -> Iterator[Mark]:
    extreme = getattr(source.results, largest)
    if extreme is None or not extreme.value:
        return
    quantity = source.results.lists.key_values("balance")[largest]
    at = np.array([extreme.degrees])
    x, y = convert(source.values((along, across), at, at)[:, 0], quantity.kind, unit).tolist()
    value = float(convert(extreme.value, quantity.kind, unit))
    yield Mark(x, y, Figure(words(quantity), value, unit, extreme.degrees))


def free_over_angle(source: Source) -> Iterator[Panel]:
    """Yield force, moment and rolling moment over the crank angle."""
    for ids in (("F_x", "F_y"), ("M_x", "M_y"), ("M_roll",)):
        if having := source.having(ids):
            yield source.panel(having)


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
            yield bars(source, free.orders, sizes, name, kind, _SENSES)


def bars(
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
