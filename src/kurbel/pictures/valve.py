"""The diagrams of a valve gear: those of Zeuner and of Reuleaux for each end, and the valve over the piston."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from kurbel.arrays import ComplexArray
from kurbel.crank_angle import CrankAngle, unit_vector
from kurbel.pictures.picture import Axis, Curve, Mark, PageFigure, Panel, Words
from kurbel.pictures.picture_source import AROUND, NO_NAME, Source, curve, level

if TYPE_CHECKING:
    from kurbel.machine.valve import Valve, ValveEnd

_BEYOND = 1.25
"""Radius of the crank circle of Zeuner's diagram over the eccentricity."""
_STEPS = 181
"""Points of Zeuner's curve; it turns back where the valve is in the middle."""


def zeuner(source: Source) -> Iterator[Panel]:
    """Displacement of the valve drawn from O along the crank (Zeuner). Where the loop through r reaches beyond the arc
    of the steam lap S, the end is open to steam; where the other one reaches beyond that of the exhaust lap E, to the
    exhaust; v is the lead. Angles count from the end's own dead centre, which is on the right."""
    valve = source.results.drive.cylinder.valve
    for end in valve.ends if valve else ():
        along = unit_vector(90.0 - end.eccentric.advance)
        crank = _BEYOND * end.eccentric.radius
        tip = (end.eccentric.radius + end.shift) * along
        other_tip = (end.shift - end.eccentric.radius) * along
        pins = [crank * unit_vector(degrees) for degrees in end.events]
        curves = [
            curve("line", *_loops(valve, end), look=0),
            curve("line", *(end.steam_lap * AROUND), look=1),
            curve("line", *(end.exhaust_lap * AROUND), look=2),
            curve("faint", *(crank * AROUND)),
            curve("faint", -crank, crank),
            curve("faint", other_tip, tip),
            *(curve("faint", 0j, pin) for pin in pins),
        ]
        widest = end.steam_lap + end.port
        if widest < abs(tip):
            curves.append(curve("faint", *(widest * AROUND), name=Words("S + a")))
        marks = [
            *_event_marks(end, pins),
            _letter("O", 0j),
            _letter("S", end.steam_lap * along, end.steam_lap),
            _letter("E", -end.exhaust_lap * along, end.exhaust_lap),
            _letter("v", complex(end.steam_lap + end.lead), end.lead),
            _letter("r", tip, end.eccentric.radius),
        ]
        yield _panel(end, curves, marks)


def _loops(valve: Valve, end: ValveEnd) -> ComplexArray:
    """Return how far the valve is off the middle, without its sign, along the crank as this end counts it."""
    middle = end.eccentric.angle_at(-end.shift, end.sense)
    passed = [
        (middle - end.eccentric.advance) % 360.0,
        (180.0 - middle - end.eccentric.advance) % 360.0,
    ]
    degrees = np.sort(np.concatenate((np.linspace(0.0, 360.0, _STEPS), np.array(passed))))
    displacement = valve.displacement(CrankAngle.of(degrees + end.dead_centre))
    return np.abs(displacement) * unit_vector(degrees)


def reuleaux(source: Source) -> Iterator[Panel]:
    """Crank circle to the scale of the eccentric (Reuleaux). The diameter, δ below the dead centre on the right, is
    the crank with the valve in its middle; the chord from admission to cut-off is at the distance of the steam lap S
    from it, that from release to compression at that of the exhaust lap E, with a short eccentric rod nearly; v is the
    lead. Angles count from the end's own dead centre."""
    valve = source.results.drive.cylinder.valve
    for end in valve.ends if valve else ():
        r, delta = end.eccentric.radius, end.eccentric.advance
        pins = [r * unit_vector(degrees) for degrees in end.events]
        cut_off, release, compression, admission = pins
        steam, exhaust = (admission + cut_off) / 2, (release + compression) / 2
        foot = r - end.lead * unit_vector(90.0 - delta)
        curves = [
            curve("line", admission, cut_off, look=0),
            curve("line", release, compression, look=1),
            curve("line", complex(r), foot, look=2),
            curve("faint", *(r * AROUND)),
            curve("faint", -r, r),
            curve("faint", -r * unit_vector(-delta), r * unit_vector(-delta)),
            curve("faint", steam, 0j, exhaust),
        ]
        marks = [
            *_event_marks(end, pins),
            _letter("O", 0j),
            _letter("S", steam, end.steam_lap),
            _letter("E", exhaust, end.exhaust_lap),
            _letter("v", foot, end.lead),
        ]
        yield _panel(end, curves, marks)


def valve_ellipse(source: Source) -> Iterator[Panel]:
    """Displacement of the valve over that of the piston. The head end is open to steam above S_H and to the exhaust
    below −E_H, the crank end to steam below −S_C and to the exhaust above E_C."""
    valve = source.results.drive.cylinder.valve
    if valve is None:
        return
    panel = source.panel(["valve"], "x", zero=True)
    x = panel.curves[0].x
    curves, marks = list(panel.curves), list[Mark]()
    for end, index, sign in zip(valve.ends, "HC", (1.0, -1.0)):
        minus = "" if sign > 0 else "−"
        curves.append(level(x, sign * end.steam_lap, Words(f"{minus}S_{index}")))
        curves.append(level(x, -sign * end.exhaust_lap, Words(f"{'' if minus else '−'}E_{index}")))
        angles = [(degrees + end.dead_centre) % 360.0 for degrees in end.events]
        across, up = source.values([source.line("x"), source.line("valve")], angles)
        points = across + 1j * up
        marks += _event_marks(end, points.tolist(), angles)
    yield panel._replace(curves=tuple(curves), marks=tuple(marks))


def _panel(end: ValveEnd, curves: list[Curve], marks: list[Mark]) -> Panel:
    axis = Axis(NO_NAME, "length")
    return Panel(
        axis,
        axis,
        tuple(curves),
        marks=tuple(marks),
        equal=True,
        plain=True,
        title=end.name.capitalize(),
    )


def _event_marks(
    end: ValveEnd, points: list[complex], angles: list[float] | None = None
) -> Iterator[Mark]:
    """Yield the events of an end with their angles, by default from its own dead centre."""
    for event, point, degrees in zip(end.events._fields, points, angles or end.events):
        yield Mark(
            point.real, point.imag, PageFigure(Words(event.replace("_", "-")), at_deg=degrees)
        )


def _letter(letter: str, point: complex, length: float | None = None) -> Mark:
    """Return a point with its letter, and the length that it stands for."""
    return Mark(point.real, point.imag, PageFigure(Words(letter), length))
