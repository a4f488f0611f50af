"""What the book finds with ruler and compasses: the motion and the tangential force at chosen crank angles, to scale.

Where it is drawn in velocities, v of the crank pin is as long as the crank, and every length is times ω.
"""

import math
from collections.abc import Iterator

import numpy as np

from kurbel.arrays import ComplexArray
from kurbel.crank_angle import CrankAngle
from kurbel.mechanisms.scotch_yoke import ScotchYoke
from kurbel.mechanisms.slider_crank import SliderCrank
from kurbel.mechanisms.slotted_lever import SlottedLever
from kurbel.report.picture import Axis, Curve, Mark, PageFigure, Panel, Words
from kurbel.report.picture_source import AROUND, NO_NAME, Source, curve
from kurbel.solver.state import State

_USUAL = 60.0
"""Degrees at which a construction is shown where no angle is chosen."""
_SMALL = 0.2
"""Radius of the crank circle over the largest force: the book draws it reduced."""


def construction(source: Source) -> Iterator[Panel]:
    """Displacement by an arc with the rod, velocity by components and as the piece that the rod cuts off on the
    vertical through the shaft (R Abb. 1047 to 1049); of a slotted lever by FH, parallel to CG (R Abb. 1071, 1072)."""
    mechanism, omega = source.results.drive.mechanism, source.results.drive.omega
    for degrees in source.angles or (_USUAL,):
        angle, panels = CrankAngle.of(np.asarray(degrees)), dict[str, Panel]()
        if isinstance(mechanism, SliderCrank) and math.isfinite(mechanism.rod):
            panels["Displacement"] = _displacement(mechanism, angle)
            if omega:
                panels["Velocity by components"] = _components(mechanism, angle, omega)
                polar = _on_the_vertical(source, mechanism, angle, omega)
                panels["Velocity on the vertical; dashed with an infinite rod"] = polar
        elif isinstance(mechanism, SlottedLever) and mechanism.slides and math.isinf(mechanism.link) and omega:
            panels["Velocity"] = _of_lever(source, mechanism, angle, omega)
        for title, panel in panels.items():
            yield panel._replace(title=f"{title}, {_at(degrees)}")


def polar_force(source: Source) -> Iterator[Panel]:
    """Piston force P, less friction, drawn from the shaft along the crank; the parallel to the rod through its end
    cuts off T on the vertical through the shaft (R Abb. 1063)."""
    drive = source.results.drive
    mechanism = drive.mechanism
    by_rod = drive.rod is None and drive.pin_friction is None and not drive.yoke_rubs
    if not (isinstance(mechanism, (SliderCrank, ScotchYoke)) and by_rod and source.having("T")):
        return

    def tip(state: State) -> ComplexArray:
        return np.asarray(state.along_rod * np.exp(1j * np.radians(state.phi)))

    symbol = Words("P + F_f") if source.having("F_friction") else source.words("P")
    panel = source.locus(tip, "P", symbol)
    reach = max(float(np.nanmax(np.abs(one))) for one in (panel.curves[0].x, panel.curves[0].y)) or 1.0
    radius = _SMALL * reach
    for degrees in source.angles or (_USUAL,):
        angle = CrankAngle.of(np.asarray(degrees))
        sin, cos = map(float, mechanism.rod_angle(angle) or (0.0, 1.0))
        end, outward = source.point(tip, degrees), complex(angle.cos, angle.sin)
        force = (end * outward.conjugate()).real
        pin, cut = radius * outward, 1j * force * (outward.imag + outward.real * sin / cos)
        rod = min(mechanism.rod_length / mechanism.crank, 1 / _SMALL) * radius * complex(cos, -sin)
        heights = np.append(panel.curves[0].y, [0.0, cut.imag])
        curves = (
            curve("faint", *(radius * AROUND)),
            curve("faint", 1.1j * float(np.nanmin(heights)), 1.1j * float(np.nanmax(heights))),
            curve("member", 0j, pin, pin + rod),
            curve("line", 0j, end, look=1),
            curve("faint", end, cut),
            curve("line", 0j, cut, look=2),
        )
        marks = _mark(symbol.symbol, end, force), _mark("T", cut, cut.imag)
        yield panel._replace(curves=(*panel.curves, *curves), marks=marks, plain=True, title=_at(degrees))


def _at(degrees: float) -> str:
    return f"φ = {round(degrees, 6):.9g}°"


def _displacement(mechanism: SliderCrank, angle: CrankAngle) -> Panel:
    """Return x as AG, cut off on the stroke line by an arc about the crosshead, and as CE up to the arc through A."""
    pin, head, sin, cos = _straight(mechanism, angle)
    length, way, psi = mechanism.rod, float(mechanism.coordinate(angle)), math.atan2(sin, cos)
    arc = length * np.exp(1j * np.linspace(math.pi - psi, math.pi, 25))
    dead = head + way  # the crosshead at its inner dead centre
    curves = (
        curve("faint", *(mechanism.crank * AROUND)),
        curve("faint", complex(-mechanism.crank, mechanism.offset), dead),
        curve("faint", *(head + arc)),
        curve("faint", *(dead + arc)),
        curve("member", 0j, pin, head),
        curve("line", dead - length, head - length, look=1),
        curve("line", pin, dead + complex(arc[0]), look=1),
        curve("joint", 0j, pin, head),
    )
    places = {"A": dead - length, "C": pin, "E": dead + complex(arc[0])}
    marks = *(_mark(name, place) for name, place in places.items()), _mark("x", head - length, way)
    return _panel("length", curves, marks)


def _components(mechanism: SliderCrank, angle: CrankAngle, omega: float) -> Panel:
    """Return v of the pin with its component v_s along the rod, which is that of c of the crosshead, too."""
    pin, head, sin, cos = _straight(mechanism, angle)
    pin, head = omega * pin, omega * head
    along, around = complex(-cos, sin), 1j * pin
    share = (around * along.conjugate()).real
    c = share / cos
    curves = (
        curve("faint", *(omega * mechanism.crank * AROUND)),
        curve("faint", complex(pin.real, head.imag), head),
        curve("member", 0j, pin, head),
        curve("faint", pin + around, pin + share * along),
        curve("faint", head - c, head + share * along),
        *(curve("arrow", pin, pin + one) for one in (around, share * along)),
        *(curve("arrow", head, head + one) for one in (share * along, -c)),
        curve("joint", 0j, pin, head),
    )
    at_pin = _mark("v", pin + around, abs(around)), _mark("v_s", pin + share * along, share)
    return _panel("velocity", curves, (*at_pin, _mark("c", head - c, c)))


def _on_the_vertical(source: Source, mechanism: SliderCrank, angle: CrankAngle, omega: float) -> Panel:
    """Return c as MF, the curve of c over the displacement, and the circle that it is with an infinite rod."""
    pin, _, sin, cos = _straight(mechanism, angle)
    pin, v = omega * pin, omega * mechanism.crank
    cut = 1j * (pin.imag + pin.real * sin / cos)
    foot = complex(sin, cos) * (pin.real * sin + pin.imag * cos)
    x, c = source.samples("c", [source.line("x"), source.line("c")]).values
    over = complex(v - omega * float(mechanism.coordinate(angle)), cut.imag)
    curves = (
        Curve(Words("c"), v - omega * x, c, look=0),
        curve("line", *(v * AROUND), name=Words("c, L/R = ∞", "c, L/R = inf"), look=1),
        curve("faint", -1.1 * v + 0j, 1.1 * v + 0j),
        curve("faint", -1.1j * v, 1.1j * v),
        curve("member", 0j, pin),
        curve("faint", pin, cut, foot),
        curve("faint", 0j, foot),
        curve("faint", cut, over, complex(over.real, 0.0)),
        curve("line", 0j, cut, look=2),
        curve("joint", 0j, pin),
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
    x, c = source.samples("c", [source.line("x"), source.line("c")]).values
    line = pivot.real + length
    ram = complex(line, end.imag)
    curves = (
        curve("faint", *(mechanism.crank * omega * AROUND)),
        curve("faint", *(pivot / 2 * (1 + AROUND))),
        curve("faint", pivot, complex(line)),
        curve("guide", *(complex(line, omega * one) for one in (x.min(), x.max()))),
        Curve(Words("c"), line + c, omega * x, look=0),
        curve("member", 0j, pin),
        curve("member", pivot, end),
        curve("faint", end, under, pin),
        curve("faint", 0j, foot, cut),
        curve("faint", end, ram),
        curve("line", under, cut, look=2),
        curve("arrow", ram, ram + under - cut),
        curve("joint", 0j, pin, end, pivot),
    )
    places = {"C": pin, "D": pivot, "E": end, "F": foot, "G": under, "H": cut}
    marks = *(_mark(name, place) for name, place in places.items()), _mark("c", ram + under - cut, (under - cut).real)
    return _panel("velocity", curves, marks)


def _straight(mechanism: SliderCrank, angle: CrankAngle) -> tuple[complex, complex, float, float]:
    """Return the places of crank pin and crosshead in m, with φ = 0 to the right, and sine and cosine of ψ."""
    pin, (sin, cos) = mechanism.crank * complex(angle.cos, angle.sin), map(float, mechanism.rod_angle(angle))
    return pin, complex(pin.real + mechanism.rod * cos, mechanism.offset), sin, cos


def _mark(symbol: str, place: complex, value: float | None = None) -> Mark:
    return Mark(place.real, place.imag, PageFigure(Words(symbol), value))


def _panel(kind: str, curves: tuple[Curve, ...], marks: tuple[Mark, ...]) -> Panel:
    axis = Axis(NO_NAME, kind)
    return Panel(axis, axis, curves, marks=marks, equal=True, plain=True)
