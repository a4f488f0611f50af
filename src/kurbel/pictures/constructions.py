"""What the book finds with ruler and compasses: the motion and the tangential force at chosen crank angles, to scale.

Where it is drawn in velocities, v of the crank pin is as long as the crank, and every length is times ω.
"""

import math
from collections.abc import Iterator, Sequence

import numpy as np

from kurbel.arrays import ComplexArray
from kurbel.crank_angle import CrankAngle
from kurbel.mechanisms import Mechanism, RamLever
from kurbel.pictures.picture import Axis, Curve, Mark, PageFigure, Panel, Words
from kurbel.pictures.picture_source import AROUND, NO_NAME, Source, curve
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
        lever = mechanism.ram_lever
        if math.isfinite(mechanism.rod_length):
            panels["Displacement"] = _displacement(mechanism, angle)
            if omega:
                panels["Velocity by components"] = _components(mechanism, angle, omega)
                polar = _on_the_vertical(source, mechanism, angle, omega)
                panels["Velocity on the vertical; dashed with an infinite rod"] = polar
        elif lever and omega:
            panels["Velocity"] = _of_lever(source, lever, angle, omega)
        for title, panel in panels.items():
            yield panel._replace(title=f"{title}, {_at(degrees)}", angle=degrees)


def polar_force(source: Source) -> Iterator[Panel]:
    """Piston force P, less friction, drawn from the shaft along the crank; the parallel to the rod through its end
    cuts off T on the vertical through the shaft (R Abb. 1063)."""
    drive = source.results.drive
    mechanism = drive.mechanism
    by_rod = drive.rod is None and drive.pin_friction is None and not drive.yoke_rubs
    if not (mechanism.is_crank_drive and by_rod and source.having("T")):
        return

    def tip(state: State) -> ComplexArray:
        return state.along_stroke * np.exp(1j * np.radians(state.phi))

    symbol = Words("P + F_f") if source.having("F_friction") else source.words("P")
    panel = source.locus(tip, "P", symbol)
    outline = panel.curves[0]
    reach = max(float(np.nanmax(np.abs(outline.x))), float(np.nanmax(np.abs(outline.y))))
    radius = _SMALL * (reach or 1.0)
    for degrees in source.angles or (_USUAL,):
        angle = CrankAngle.of(np.asarray(degrees))
        sin, cos = map(float, mechanism.rod_angle(angle) or (0.0, 1.0))
        end, outward = source.point(tip, degrees), complex(angle.cos, angle.sin)
        force = (end * outward.conjugate()).real
        pin, cut = radius * outward, 1j * force * (outward.imag + outward.real * sin / cos)
        rod = min(mechanism.rod_length / mechanism.crank, 1 / _SMALL) * radius * complex(cos, -sin)
        heights = np.append(panel.curves[0].y, [0.0, cut.imag])
        construction = _panel(
            "force",
            {symbol.symbol: end, "T": cut},
            {symbol.symbol: force, "T": cut.imag},
            faint=(
                radius * AROUND,
                (1.1j * np.nanmin(heights), 1.1j * np.nanmax(heights)),
                (end, cut),
            ),
            member=[(0j, pin, pin + rod)],
            line=[(0j, end), (0j, cut)],
        )
        curves = (*panel.curves, *construction.curves)
        yield construction._replace(curves=curves, title=_at(degrees), angle=degrees)


def _at(degrees: float) -> str:
    return f"φ = {round(degrees, 6):.9g}°"


def _displacement(mechanism: Mechanism, angle: CrankAngle) -> Panel:
    """Return x as AG, cut off on the stroke line by an arc about the crosshead, and as CE up to the arc through A.

    F: foot of the vertical from C. D is the pin half a turn later, at the same angle on the return stroke: its way
    back from B, x_D, is the shorter one.
    """
    pin, head, sin, cos = _straight(mechanism, angle)
    length = mechanism.rod_length
    way = float(mechanism.coordinate(angle))
    psi = math.atan2(sin, cos)
    arc = length * np.exp(1j * np.linspace(math.pi - psi, math.pi, 25))
    dead = head + way  # the crosshead at its inner dead centre
    start = complex(-mechanism.crank, mechanism.offset)
    above = dead + complex(arc[0])

    # the opposite pin and its crosshead; B is the pin at the outer dead centre, laid off along the stroke line
    later = CrankAngle.of(np.asarray(float(angle.degrees) + 180.0))
    opposite, head_of_opposite, _, _ = _straight(mechanism, later)
    outer = dead - mechanism.stroke - length
    way_back = float(mechanism.stroke - mechanism.coordinate(later))
    foot = complex(pin.real, mechanism.offset)
    points = {
        "A": dead - length,
        "B": outer,
        "C": pin,
        "D": opposite,
        "E": above,
        "F": foot,
        "G, x": head - length,
        "x_D": head_of_opposite - length,
    }
    return _panel(
        "length",
        points,
        {"G, x": way, "x_D": way_back},
        faint=(
            mechanism.crank * AROUND,
            (start, dead),
            head + arc,
            dead + arc,
            (pin, foot),
            (opposite, head_of_opposite),
        ),
        member=[(0j, pin, head)],
        line=[(dead - length, head - length), (outer, head_of_opposite - length), (pin, above)],
        joint=[(0j, pin, head)],
    )


def _components(mechanism: Mechanism, angle: CrankAngle, omega: float) -> Panel:
    """Return v of the pin with its component v_s along the rod, which is that of c of the crosshead, too."""
    pin, head, sin, cos = _straight(mechanism, angle)
    pin, head = omega * pin, omega * head
    along, v = complex(-cos, sin), 1j * pin
    share = (v * along.conjugate()).real
    c, v_s, below = share / cos, share * along, complex(pin.real, head.imag)
    return _panel(
        "velocity",
        {"v": pin + v, "v_s": pin + v_s, "c": head - c},
        {"v": abs(v), "v_s": share, "c": c},
        faint=[
            omega * mechanism.crank * AROUND,
            (below, head),
            (pin + v, pin + v_s),
            (head - c, head + v_s),
        ],
        member=[(0j, pin, head)],
        arrow=[(pin, pin + v), (pin, pin + v_s), (head, head + v_s), (head, head - c)],
        joint=[(0j, pin, head)],
    )


def _on_the_vertical(
    source: Source, mechanism: Mechanism, angle: CrankAngle, omega: float
) -> Panel:
    """Return c as MF, the curve of c over the displacement, and the circle that it is with an infinite rod."""
    pin, _, sin, cos = _straight(mechanism, angle)
    pin, v = omega * pin, omega * mechanism.crank
    cut = 1j * (pin.imag + pin.real * sin / cos)
    foot = complex(sin, cos) * (pin.real * sin + pin.imag * cos)
    x, c = source.samples("c", [source.line("x"), source.line("c")]).values
    over, end = complex(v - omega * float(mechanism.coordinate(angle)), cut.imag), complex(1.1 * v)
    panel = _panel(
        "velocity",
        {"M": 0j, "B": pin, "G": foot, "F, c": cut},
        {"F, c": cut.imag},
        faint=[
            (-end, end),
            (-1j * end, 1j * end),
            (pin, cut, foot),
            (0j, foot),
            (cut, over, complex(over.real)),
        ],
        member=[(0j, pin)],
        line=[(0j, cut)],
        joint=[(0j, pin)],
    )
    infinite = curve("line", *(v * AROUND), name=Words("c, L/R = ∞", "c, L/R = inf"), look=1)
    return panel._replace(
        curves=(Curve(Words("c"), v - omega * x, c, look=0), infinite, *panel.curves)
    )


def _of_lever(source: Source, lever: RamLever, angle: CrankAngle, omega: float) -> Panel:
    """Return c as GH, G under the lever's end and FH parallel to CG, and the curve of c over the place of the ram.

    c_1, c_2: largest velocities out and back. Of a lever that swings its end moves on the arc AB, while the crank
    turns through 2 α on the working stroke and 2 β on the return stroke, between the perpendiculars from M on the
    extreme positions.
    """
    pivot = complex(-lever.frame * omega)
    v = lever.crank * omega
    pin = v * complex(angle.cos, angle.sin)
    along = (pin - pivot) / abs(pin - pivot)
    length = omega * lever.length
    end = pivot + length * along
    foot = pivot - pivot.real * along.real * along
    under = complex(end.real)
    cut = pivot + (under - pivot) * ((foot - pivot) / (pin - pivot)).real
    x, c = source.samples("c", [source.line("x"), source.line("c")]).values
    line = pivot + length  # of the ram
    ram = complex(line.real, end.imag)
    circle = v * AROUND
    tip = ram + under - cut

    # the largest velocities, with the pin in the line of both pivots (R 304, 305)
    out, back = source.results.at([0.0]), source.results.at([180.0])
    c_1, c_2 = float(out.c[0]), float(back.c[0])
    points = {"M": 0j, "C": pin, "D": pivot, "E": end, "F": foot, "G": under, "H": cut, "c": tip}
    points["c_1"] = complex(line.real + c_1, omega * float(out.x[0]))
    points["c_2"] = complex(line.real + c_2, omega * float(back.x[0]))

    # the extreme positions of a lever that swings
    extremes: list[Sequence[complex] | ComplexArray] = []
    angles: list[Curve] = []
    if lever.crank < lever.frame:
        tilt = math.asin(lever.crank / lever.frame)
        last = complex(math.cos(tilt), math.sin(tilt))
        foot_of_last = pivot - pivot.real * last.real * last
        swing = np.linspace(-tilt, tilt, 37)
        points["A"] = pivot + length * last.conjugate()
        points["B"] = pivot + length * last
        alpha = math.pi / 2 + tilt
        to_label = 0.4 * v * np.exp(1j * np.linspace(alpha, -math.pi / 4, 49))
        from_label = 0.4 * v * np.exp(1j * np.linspace(-math.pi / 4, -alpha, 25))
        returning = 0.6 * v * np.exp(1j * np.linspace(alpha, 2 * math.pi - alpha, 49))
        angles.append(curve("faint", *from_label))
        angles.append(curve("faint", *to_label, name=Words("2 α", "2 alpha")))
        angles.append(curve("faint", *returning, name=Words("2 β", "2 beta")))
        extremes.append((points["A"], pivot, points["B"]))
        extremes.append((foot_of_last.conjugate(), 0j, foot_of_last))
        extremes.append(pivot + length * np.exp(1j * swing))
    panel = _panel(
        "velocity",
        points,
        {"c": (under - cut).real, "c_1": c_1, "c_2": c_2},
        guide=[(line + 1j * omega * x.min(), line + 1j * omega * x.max())],
        faint=(
            circle,
            pivot / 2 * (1 + AROUND),
            (pivot, line),
            (end, under, pin),
            (0j, foot, cut),
            (end, ram),
            *extremes,
        ),
        member=[(0j, pin), (pivot, end)],
        line=[(under, cut)],
        arrow=[(ram, tip)],
        joint=[(0j, pin, end, pivot)],
    )
    return panel._replace(
        curves=(Curve(Words("c"), line.real + c, omega * x, look=0), *panel.curves, *angles)
    )


def _straight(mechanism: Mechanism, angle: CrankAngle) -> tuple[complex, complex, float, float]:
    """Return the places of crank pin and crosshead in m, with φ = 0 to the right, and sine and cosine of ψ."""
    pin = mechanism.crank * complex(angle.cos, angle.sin)
    sin, cos = map(float, mechanism.rod_angle(angle) or (0.0, 1.0))
    head = complex(pin.real + mechanism.rod_length * cos, mechanism.offset)
    return pin, head, sin, cos


def _panel(
    kind: str,
    named_points: dict[str, complex],
    values: dict[str, float],
    **lines: Sequence[Sequence[complex] | ComplexArray],
) -> Panel:
    """Return a panel of lines by their kinds, with named places and the values of some; what is found is a `line`."""
    curves = []
    for line_kind, of_kind in lines.items():
        look = 1 if line_kind == "line" else None
        for points in of_kind:
            curves.append(curve(line_kind, *points, look=look))
    marks = []
    for name, point in named_points.items():
        marks.append(Mark(point.real, point.imag, PageFigure(Words(name), values.get(name))))
    axis = Axis(NO_NAME, kind)
    return Panel(axis, axis, tuple(curves), marks=tuple(marks), equal=True, plain=True)
