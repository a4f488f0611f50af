"""The pictures of one cylinder: indicator cards, piston force with its inertia line, forces, T in polar form."""

from collections.abc import Iterable, Iterator
from dataclasses import replace
from functools import partial
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from kurbel.arrays import Array
from kurbel.crank_angle import CrankAngle
from kurbel.declared.unit_systems import convert
from kurbel.report.pictures.picture import Axis, Curve, Figure, Mark, Panel, Piece, Shade, Words
from kurbel.report.pictures.sampling import Samples, pieces
from kurbel.report.pictures.source import PHI, Source, level, mark

if TYPE_CHECKING:
    from kurbel.solver.gas import PistonGas

_V, _P, _P_0 = Words("V"), Words("P"), Words("P_0")
_INERTIA_LINE = Words("−P_b")
_REVERSAL = Words("Druckwechsel")
_MET = 1e-9
"""Of the largest distance between two lines: where they cross, rounding alone is between them."""


def cards(source: Source, over_volume: bool = False) -> Iterator[Panel]:
    """Yield the indicator cards of every piston, both ends over the stroke, or over the volumes of the chambers."""
    return (_card(source, gas, over_volume) for gas in source.results.drive.gas)


cards_over_volume = partial(cards, over_volume=True)


def _card(source: Source, gas: "PistonGas", over_volume: bool) -> Panel:
    """Return the pressures of one piston over the way, or over the volume of each chamber."""
    piston, several = gas.piston, len(source.results.drive.gas) > 1
    ends = [(name, end) for name, end in (("p_head", gas.head), ("p_crank", gas.crank)) if end]

    def values(degrees: Array, within: Array) -> Array:
        state = source.results.at(degrees, within)
        return np.stack([state.way, *(state.pressure(end) + gas.base for _, end in ends)])

    samples = source.sampled(("x", *(name for name, _ in ends)), values)
    unit = source.unit("pressure", *samples.values[1:])
    places = {name: _volume(gas, name, samples.values[0]) if over_volume else samples.values[0] for name, _ in ends}
    kind = "volume" if over_volume else "length"
    run = source.unit(kind, *places.values())
    curves = [
        Curve(
            source.words(name),
            pieces(samples, convert(places[name], kind, run), convert(p, "pressure", unit)),
        )
        for (name, _), p in zip(ends, samples.values[1:])
    ]
    own = piston is source.results.drive.cylinder.pistons[0] and not over_volume
    marks = tuple(_highest(source, unit, run)) if own else ()
    y = Axis(Words("p"), f"{unit} abs" if gas.absolute else unit)
    x = Axis(_V if over_volume else source.words("x"), run)
    ambient = level(curves, float(convert(gas.base, "pressure", unit)))
    return Panel(x, y, (*curves, ambient), marks=marks, title=piston.name if several else "")


def _volume(gas: "PistonGas", end: str, way: Array) -> Array:
    """Return the volume in m³ of a chamber: what the piston has swept, and the clearance where it is known."""
    indicator, stroke = gas.piston.indicator, gas.stroke
    at_head = end == "p_head"
    chamber = indicator and (indicator.head_end if at_head else indicator.crank_end)
    area = gas.piston.head_area if at_head else gas.piston.crank_area
    clearance = getattr(chamber, "clearance", None) or 0.0
    return np.asarray(area * ((way if at_head else stroke - way) + clearance * stroke))


def _highest(source: Source, unit: str, run: str) -> Iterable[Mark]:
    highest = source.results.p_max
    if highest is not None:
        way = float(source.results.at(np.array([highest.degrees])).way[0])
        quantity = source.results.lists.key_values("forces")["p_max"]
        yield mark(quantity, highest, unit, float(convert(way, "length", run)))


def piston_force(source: Source) -> Iterator[Panel]:
    """Yield the force without inertia against the inertia line, what is left between them shaded, and that alone."""
    if source.having(("P",)):
        if source.having(("P_inertia", "P_start")) == ("P_inertia", "P_start"):
            yield _against_inertia(source)
        yield _rest(source)


def piston_force_over_way(source: Source) -> Iterator[Panel]:
    """Yield the same over the way, one panel for each stroke."""
    if source.having(("P", "x")) != ("P", "x") or source.results.drive.mechanism.turns:
        return
    with_inertia = source.having(("P_inertia", "P_start")) == ("P_inertia", "P_start")
    inner, outer = source.results.drive.mechanism.dead_centres()
    cycle = source.results.drive.cycle
    ends = sorted({(end + turn) % cycle for turn in range(0, int(cycle), 360) for end in (inner, outer)})
    for start, end in zip(ends, [*ends[1:], ends[0] + cycle]):
        out = bool(np.isclose((start - inner) % 360.0, 0.0) or np.isclose((start - inner) % 360.0, 360.0))
        title = f"{'Hingang' if out else 'Rückgang'} {start:.4g}–{end:.4g}°"
        ids = ("x", "P_start", "P_inertia") if with_inertia else ("x", "P")
        yield _stroke(source, ids, start, end, title)


def _stroke(source: Source, ids: tuple[str, ...], start: float, end: float, title: str) -> Panel:
    cycle = source.results.drive.cycle
    reversals = source.results.phi_reversal or ()
    inside = [a + turn for a in (*source.results.breaks, *reversals) for turn in (0.0, cycle) if start < a + turn < end]
    breaks = np.array(sorted({start, *inside, end}))

    def values(degrees: Array, within: Array) -> Array:
        turned = cycle * np.floor(within / cycle)  # the end of the cycle is not its beginning
        return source.values(ids, degrees - turned, within - turned)

    return _panel_of_rest(source, source.sampled(ids, values, breaks), "x")._replace(title=title)


def _against_inertia(source: Source) -> Panel:
    reversals = source.results.phi_reversal or ()
    panel = _panel_of_rest(source, source.samples((PHI, "P_start", "P_inertia"), reversals), PHI)
    return panel._replace(marks=tuple(_reversals(source, reversals, panel.y.unit)))


def _reversals(source: Source, angles: Iterable[float], unit: str) -> Iterator[Mark]:
    for angle in angles:
        at = np.array([angle])
        (line,) = source.values(("P_inertia",), at, at)
        yield Mark(angle, -float(convert(line[0], "force", unit)), Figure(_REVERSAL, at_deg=angle))


def _panel_of_rest(source: Source, samples: Samples, over: str) -> Panel:
    """Return a panel of a force and the inertia line (or the line of no force), with what lies between them shaded."""
    way, *found = samples.values
    unit, run = source.unit("force", *found), source.axis(over, way)
    x = convert(way, source.quantity(over).kind, run.unit)
    force, *inertia = (convert(line, "force", unit) for line in found)
    curves = [Curve(_P_0 if inertia else _P, pieces(samples, x, force))]
    base = -inertia[0] if inertia else np.zeros_like(x)
    if inertia:
        curves.append(Curve(_INERTIA_LINE, pieces(samples, x, base)))
    return Panel(run, Axis(_P, unit), (*curves, level(curves)), tuple(between(x, base, force)))


def between(x: Array, base: Array, line: Array) -> Iterator[Shade]:
    """Yield what lies between two lines, cut where they cross."""
    apart = line - base
    above = np.where(np.abs(apart) > _MET * np.abs(apart).max(), np.sign(apart), 0.0)
    # a point on the base belongs to the surface before it, and to the next one, too
    turns = [i for i in range(1, len(x) - 1) if above[i] == 0 or above[i] * above[i + 1] < 0]
    cuts = [0, *turns, len(x) - 1]
    for start, end in pairwise(cuts):
        part = slice(start, end + 1)
        if end > start and (above[part] != 0).any():
            yield Shade(x[part], base[part], line[part], bool(above[part].sum() > 0))


def _rest(source: Source) -> Panel:
    """Return the whole piston force over the crank angle, its extremes and the Druckwechsel marked."""
    panel = source.panel(("P",))
    reversals = source.results.phi_reversal or ()
    marks = tuple(Mark(angle, 0.0, Figure(_REVERSAL, at_deg=angle)) for angle in reversals)
    return panel._replace(curves=(*panel.curves, level(panel.curves)), marks=(*panel.marks, *marks))


def forces(source: Source) -> Iterator[Panel]:
    """Yield the forces in the rod, on the guide and on the pin, and what else the mechanism offers, kind by kind."""
    offered = [one.quantity.id for one in source.results.drive.mechanism.OFFERS if one.quantity.commands == ("forces",)]
    found = source.having(("S", "N", "D", "T", "M_out", *offered))
    kinds = dict.fromkeys(source.quantity(id).kind for id in found)
    for kind in kinds:
        panel = source.panel([id for id in found if source.quantity(id).kind == kind])
        yield panel._replace(curves=(*panel.curves, level(panel.curves)))


def polar_effort(source: Source) -> Iterator[Panel]:
    """Yield T drawn outward from the crank circle, which stands for zero, R Abb. 1063."""
    if not source.having(("T",)):
        return
    samples = source.samples((PHI, "T"))
    unit = source.unit("force", samples.values[1])
    force = convert(samples.values[1], "force", unit)
    size = float(np.abs(force).max()) or 1.0
    base = max(0.6 * size, size * 0.25 - float(force.min()))
    around = np.linspace(0.0, 360.0, 121)
    rings = [_faint(Words("T = 0"), around, base)]
    if mean := getattr(source.results, "W", None):
        rings.append(_faint(Words("W"), around, base + float(convert(mean, "force", unit))))
    spokes = [
        _faint(Words(f"φ = {angle:g}°", f"phi = {angle:g}"), angle, np.array([base, (base + size) * 1.04]))
        for angle in range(0, 360, 90)
    ]
    curves = (Curve(source.words("T"), pieces(samples, *_polar(samples.degrees, base + force))), *rings, *spokes)
    marks = tuple(_placed(one, base) for one in source.marks("T", unit))
    axis = Axis(Words(""), unit)
    yield Panel(axis, axis, curves, marks=marks, equal=True, plain=True)


def _polar(degrees: Any, radius: Any) -> tuple[Any, Any]:
    angle = CrankAngle.of(np.asarray(degrees, dtype=float))
    return radius * angle.cos, radius * angle.sin


def _faint(name: Words, degrees: Any, radius: Any) -> Curve:
    """Return a ring or a spoke."""
    return Curve(name, (Piece(*_polar(degrees, radius)),), kind="faint")


def _placed(mark: Mark, base: float) -> Mark:
    x, y = _polar(mark.x, base + mark.y)
    return replace(mark, x=float(x), y=float(y))
