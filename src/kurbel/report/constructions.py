"""What the book finds with ruler and compasses: the motion and the tangential force at chosen crank angles, to scale.

Where it is drawn in velocities, v of the crank pin is as long as the crank, and every length is times ω.
"""

import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from kurbel.arrays import Array
from kurbel.crank_angle import CrankAngle
from kurbel.mechanisms.scotch_yoke import ScotchYoke
from kurbel.mechanisms.slider_crank import SliderCrank
from kurbel.mechanisms.slotted_lever import SlottedLever
from kurbel.report.picture import Axis, Curve, Mark, PageFigure, Panel, Words
from kurbel.report.picture_source import Source

_USUAL = 60.0
"""Degrees at which a construction is shown where no angle is chosen."""
_SMALL = 0.2
"""Radius of the crank circle over the largest force: the book draws it reduced."""
_AROUND = np.exp(2j * np.pi * np.linspace(0.0, 1.0, 121))
_NO_NAME = Words("")


def construction(source: Source) -> Iterator[Panel]:
    """Displacement by an arc with the rod, velocity by components and as the piece that the rod cuts off on the
    vertical through the shaft (R Abb. 1047 to 1049); of a slotted lever by FH, parallel to CG (R Abb. 1071, 1072)."""
    drive = source.results.drive
    mechanism = drive.mechanism
    for degrees in source.angles or (_USUAL,):
        at, angle = f"φ = {round(degrees, 6):.9g}°", CrankAngle.of(np.asarray(degrees))
        if isinstance(mechanism, SliderCrank) and math.isfinite(mechanism.rod):
            yield _displacement(mechanism, angle)._replace(title=f"Displacement, {at}")
            if drive.omega:
                yield _components(mechanism, angle, drive.omega)._replace(title=f"Velocity by components, {at}")
                polar = _on_the_vertical(source, mechanism, angle, drive.omega)
                yield polar._replace(title=f"Velocity on the vertical; dashed with an infinite rod, {at}")
        elif isinstance(mechanism, SlottedLever) and mechanism.slides and math.isinf(mechanism.link) and drive.omega:
            yield _of_lever(source, mechanism, angle, drive.omega)._replace(title=f"Velocity, {at}")


def polar_force(source: Source) -> Iterator[Panel]:
    """Piston force P, less friction, drawn from the shaft along the crank; the parallel to the rod through its end
    cuts off T on the vertical through the shaft (R Abb. 1063)."""
    drive = source.results.drive
    mechanism = drive.mechanism
    by_rod = drive.rod is None and drive.pin_friction is None and not drive.yoke_rubs
    known = isinstance(mechanism, (SliderCrank, ScotchYoke)) and by_rod
    if not known or not source.having("T"):
        return

    def tip(degrees: Any, within: Array | None = None) -> Array:
        degrees = np.atleast_1d(np.asarray(degrees, dtype=float))
        state = source.results.at(degrees, degrees if within is None else within)
        place = state.along_rod * np.exp(1j * np.radians(degrees))
        return np.stack([place.real, place.imag])

    symbol = Words("P + F_f") if source.having("F_friction") else source.words("P")
    panel, axis = source.locus(("P", "P"), tip, symbol, ()), Axis(_NO_NAME, "force")
    all_x, all_y = panel.curves[0].x, panel.curves[0].y
    radius = _SMALL * (float(np.nanmax(np.hypot(all_x, all_y))) or 1.0)
    for degrees in source.angles or (_USUAL,):
        angle = CrankAngle.of(np.asarray(degrees))
        sin, cos = map(float, mechanism.rod_angle(angle) or (0.0, 1.0))
        outward = complex(angle.cos, angle.sin)
        x, y = tip(degrees)[:, 0].tolist()
        force = x * angle.cos + y * angle.sin
        pin, end, cut = radius * outward, complex(x, y), 1j * force * (angle.sin + angle.cos * sin / cos)
        rod = min(mechanism.rod_length / mechanism.crank, 1 / _SMALL) * radius * complex(cos, -sin)
        heights = 0.0, cut.imag, float(np.nanmin(all_y)), float(np.nanmax(all_y))
        curves = (
            _curve("faint", *(radius * _AROUND)),
            _curve("faint", 1.1j * min(heights), 1.1j * max(heights)),
            _curve("member", 0j, pin, pin + rod),
            _curve("line", 0j, end, look=1),
            _curve("faint", end, cut),
            _curve("line", 0j, cut, look=2),
        )
        marks = _mark(symbol.symbol, end, force), _mark("T", cut, cut.imag)
        title = f"φ = {round(degrees, 6):.9g}°"
        yield panel._replace(
            x=axis, y=axis, curves=(*panel.curves, *curves), marks=marks, equal=True, plain=True, title=title
        )


def _displacement(mechanism: SliderCrank, angle: CrankAngle) -> Panel:
    """Return x as AG, cut off on the stroke line by an arc about the crosshead, and as CE up to the arc through A."""
    pin, head = _pin_and_head(mechanism, angle)
    length, way = mechanism.rod, float(mechanism.coordinate(angle))
    psi = math.atan2(*mechanism.rod_angle(angle))
    arc = length * np.exp(1j * np.linspace(math.pi - psi, math.pi, 25))
    dead = head + way  # the crosshead at its inner dead centre
    curves = (
        _curve("faint", *(mechanism.crank * _AROUND)),
        _curve("faint", complex(-mechanism.crank, mechanism.offset), dead),
        _curve("faint", *(head + arc)),
        _curve("faint", *(dead + arc)),
        _curve("member", 0j, pin, head),
        _curve("line", dead - length, head - length, look=1),
        _curve("line", pin, dead + complex(arc[0]), look=1),
        _curve("joint", 0j, pin, head),
    )
    places = {"A": dead - length, "C": pin, "E": dead + complex(arc[0])}
    marks = *(_mark(name, place) for name, place in places.items()), _mark("x", head - length, way)
    return _panel("length", curves, marks)


def _components(mechanism: SliderCrank, angle: CrankAngle, omega: float) -> Panel:
    """Return v of the pin with its component v_s along the rod, which is that of c of the crosshead, too."""
    pin, head = (omega * place for place in _pin_and_head(mechanism, angle))
    sin, cos = map(float, mechanism.rod_angle(angle))
    along, around = complex(-cos, sin), 1j * pin
    share = (around * along.conjugate()).real
    c = share / cos
    curves = (
        _curve("faint", *(omega * mechanism.crank * _AROUND)),
        _curve("faint", complex(pin.real, head.imag), head),
        _curve("member", 0j, pin, head),
        _curve("faint", pin + around, pin + share * along),
        _curve("faint", head - c, head + share * along),
        *(_curve("arrow", pin, pin + one) for one in (around, share * along)),
        *(_curve("arrow", head, head + one) for one in (share * along, -c)),
        _curve("joint", 0j, pin, head),
    )
    at_pin = _mark("v", pin + around, abs(around)), _mark("v_s", pin + share * along, share)
    return _panel("velocity", curves, (*at_pin, _mark("c", head - c, c)))


def _on_the_vertical(source: Source, mechanism: SliderCrank, angle: CrankAngle, omega: float) -> Panel:
    """Return c as MF, the curve of c over the displacement, and the circle that it is with an infinite rod."""
    sin, cos = map(float, mechanism.rod_angle(angle))
    pin = omega * _pin_and_head(mechanism, angle)[0]
    v = omega * mechanism.crank
    cut = 1j * (pin.imag + pin.real * sin / cos)
    foot = complex(sin, cos) * (pin.real * sin + pin.imag * cos)
    x, c = source.samples(("x", "c")).values
    over = complex(v - omega * float(mechanism.coordinate(angle)), cut.imag)
    curves = (
        Curve(Words("c"), v - omega * x, c, look=0),
        _curve("line", *(v * _AROUND), name=Words("c, L/R = ∞", "c, L/R = inf"), look=1),
        _curve("faint", -1.1 * v + 0j, 1.1 * v + 0j),
        _curve("faint", -1.1j * v, 1.1j * v),
        _curve("member", 0j, pin),
        _curve("faint", pin, cut, foot),
        _curve("faint", 0j, foot),
        _curve("faint", cut, over, complex(over.real, 0.0)),
        _curve("line", 0j, cut, look=2),
        _curve("joint", 0j, pin),
    )
    return _panel("velocity", curves, (_mark("B", pin), _mark("G", foot), _mark("c", cut, cut.imag)))


def _of_lever(source: Source, mechanism: SlottedLever, angle: CrankAngle, omega: float) -> Panel:
    """Return c as GH, G under the lever's end and FH parallel to CG, and the curve of c over the place of the ram."""
    pivot, pin = complex(-mechanism.frame * omega), mechanism.crank * omega * complex(angle.cos, angle.sin)
    along = (pin - pivot) / abs(pin - pivot)
    length = omega * (mechanism.lever or 0.0)
    end = pivot + length * along
    foot = pivot - pivot.real * along.real * along
    under = complex(end.real)
    cut = pivot + (under - pivot) * ((foot - pivot) / (pin - pivot)).real
    x, c = source.samples(("x", "c")).values
    line = pivot.real + length
    ram = complex(line, end.imag)
    curves = (
        _curve("faint", *(mechanism.crank * omega * _AROUND)),
        _curve("faint", *(pivot / 2 * (1 + _AROUND))),
        _curve("faint", pivot, complex(line)),
        _curve("guide", *(complex(line, omega * one) for one in (x.min(), x.max()))),
        Curve(Words("c"), line + c, omega * x, look=0),
        _curve("member", 0j, pin),
        _curve("member", pivot, end),
        _curve("faint", end, under, pin),
        _curve("faint", 0j, foot, cut),
        _curve("faint", end, ram),
        _curve("line", under, cut, look=2),
        _curve("arrow", ram, ram + under - cut),
        _curve("joint", 0j, pin, end, pivot),
    )
    places = {"C": pin, "D": pivot, "E": end, "F": foot, "G": under, "H": cut}
    marks = *(_mark(name, place) for name, place in places.items()), _mark("c", ram + under - cut, (under - cut).real)
    return _panel("velocity", curves, marks)


def _pin_and_head(mechanism: SliderCrank, angle: CrankAngle) -> tuple[complex, complex]:
    """Return the places of crank pin and crosshead in m; φ = 0 is to the right."""
    pin = mechanism.crank * complex(angle.cos, angle.sin)
    return pin, complex(pin.real + mechanism.rod * mechanism.rod_angle(angle)[1], mechanism.offset)


def _curve(kind: str, *places: complex, name: Words = _NO_NAME, look: int | None = None) -> Curve:
    points = np.array(places)
    return Curve(name, points.real, points.imag, kind, look)


def _mark(symbol: str, place: complex, value: float | None = None) -> Mark:
    return Mark(place.real, place.imag, PageFigure(Words(symbol), value))


def _panel(kind: str, curves: tuple[Curve, ...], marks: tuple[Mark, ...]) -> Panel:
    axis = Axis(_NO_NAME, kind)
    return Panel(axis, axis, curves, marks=marks, equal=True, plain=True)
