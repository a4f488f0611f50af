"""The pictures of the whole machine and of its bearings: functions that yield their panels, listed in `pictures`."""

import math
from collections.abc import Iterator, Sequence
from functools import partial

import numpy as np

from kurbel.arrays import Array, ComplexArray, Number
from kurbel.machine.shaft_line import GROUNDED, ShaftLine
from kurbel.pictures.picture import Axis, Curve, Mark, PageFigure, Panel, Shade, Words
from kurbel.pictures.picture_source import CurveFormula, Source, curve, level
from kurbel.solver.chapters.bearings import BearingColumns
from kurbel.solver.chapters.stress import PARTS
from kurbel.solver.effort import Term
from kurbel.solver.figures import AtAngles
from kurbel.solver.flywheel import TurningState
from kurbel.solver.state import State

_MOST_NUMBERED = 24
_HIGHEST = 12
"""Order up to which bars are drawn: beyond it they are too small to be seen."""
_LEAST_BARS = 6
"""How many there is room for at least, so that one alone is no block."""
_MODES = 4
_FASTEST, _STRONGEST = 1.25, 6
"""Of a Campbell diagram: its highest speed over the working speed, and how many critical speeds are marked besides
those near the working speed."""
_MOST_CRANKS = 4
"""Each has a stroke of its own, next to the sum with and without losses."""
_SLENDEREST = 15.0
"""Length over height of a locus from which on it is drawn as little as a line."""
_FRAMES = {
    "load_throw": "throw: outward →",
    "load_engine": "engine: stroke line →",
    "load_rod": "rod: its line →",
}


def effort(source: Source) -> Iterator[Panel]:
    """Turning effort of the whole machine and the resistance, its lobes numbered with their work; below them the excess
    work and the speed (R Abb. 1064 to 1067)."""
    results = source.results
    if not source.having("M"):
        return
    id, radius = ("T", results.crank) if source.having("T") else ("M", 1.0)
    level_load = results.machine.load is None or results.machine.load.diagram is None
    name = Words("W" if id == "T" else "M_m" if level_load else "M_W", words="resistance")
    load: CurveFormula = name, lambda state: state["M_load"] / radius
    panel = source.panel([id, load], shaded=True, faint=level_load, also=results.phi_crossing)
    shades, lobes = list(panel.shades), results.lobes
    if 0 < len(lobes) <= _MOST_NUMBERED:
        owners = [
            np.searchsorted(results.phi_crossing, (shade.x[0] + shade.x[-1]) / 2) - 1
            for shade in shades
        ]
        for lobe, work in enumerate(lobes):
            own = [place for place, owner in enumerate(owners) if owner % len(lobes) == lobe]
            # of a lobe that the end of the cycle cuts, the wider part has its number and work
            widest = max(own, key=lambda place: float(np.ptp(shades[place].x)), default=None)
            if widest is not None:
                shades[widest] = shades[widest]._replace(
                    figure=PageFigure(Words(f"A_{lobe + 1}"), work, kind="energy")
                )
    yield panel._replace(shades=tuple(shades))

    yield from source.panels(["E"])
    if source.having("omega"):
        mean_speed: CurveFormula = source.words("omega_mean"), lambda state: results.omega_mean
        yield source.panel(["omega", mean_speed], faint=True)
    if source.having("M_coupling"):
        mean_torque: CurveFormula = source.words("M_mean"), lambda state: results.M_mean
        yield source.panel(["M_coupling", mean_torque], faint=True)


def flow(source: Source) -> Iterator[Panel]:
    """Flow that the pumps deliver over the crank angle, and its mean; what is between them fills and empties the air
    vessel. Below it, where there is a suction pipe without a vessel, the head that accelerates the liquid."""
    if source.having("flow"):
        mean: CurveFormula = source.words("flow_mean"), lambda state: source.results.flow_mean
        yield source.panel(["flow", mean], shaded=True, faint=True)
        yield from source.panels(["acceleration_head"])


def crank_efforts(source: Source) -> Iterator[Panel]:
    """Tangential force of each cylinder as its crank stands, their sum, and dashed the sum with the efficiency (R Abb.
    1062, 1064)."""
    effort = source.results.effort
    acting = [cylinder for cylinder in effort.cylinders if cylinder.drive.has_force]
    lossy = bool(effort.machine.efficiency != 1)
    if (
        effort.given is not None
        or not source.having("T")
        or len(acting) > _MOST_CRANKS
        or len(acting) + lossy < 2
    ):
        return
    whole = effort.sampled([Term(1.0, group) for group in effort.groups])
    lines = [_on_crank_1(source, source.words("T"), whole)]
    lines += [_on_crank_1(source, Words("T with η", "T with eta"), effort.M)] if lossy else []
    for one in acting if len(acting) > 1 else ():
        lines.append(_on_crank_1(source, Words(one.drive.name), effort.sampled([Term(1.0, [one])])))
    lines.append((Words("W"), lambda state: effort.mean[0] / source.results.crank))
    yield source.panel(lines, like="T", faint=True)._replace(marks=source.marks("T"))


def effort_of_sides(source: Source) -> Iterator[Panel]:
    """Turning effort of the driving pistons, with losses and masses, against the resistance line of the driven ones
    (R Abb. 1067)."""
    effort = source.results.effort
    driven = [group for group in effort.groups if group[0].drive.driven]
    if effort.given is not None or not source.having("T") or not driven or not effort.drives:
        return
    resistance = -effort.sampled(
        [Term(1.0, group, lambda one: driven_force(one) * one.slope) for group in driven]
    )
    driving = Words("T_driving", words="driving pistons"), effort.M + resistance
    against = Words("−T_driven", words="driven pistons"), resistance
    lines = [_on_crank_1(source, *one) for one in (driving, against)]
    yield source.panel(lines, like="T", shaded=True, zero=True)


def driven_force(state: State) -> Number:
    """Return the force in N of the pistons of a rod that do not drive, and of what a ram works against."""
    gas = (
        0.0
        if state.P_gas is None
        else state.P_gas - (0.0 if state.P_driving is None else state.P_driving)
    )
    return gas if state.P_ram is None else gas + state.P_ram


def _on_crank_1(source: Source, name: Words, torque: Array) -> CurveFormula:
    """Return a torque on the pieces of the machine as a force on crank 1."""
    effort, crank = source.results.effort, source.results.crank

    def force(state: TurningState) -> Array:
        return effort.at(effort.pieces, torque, state.phi, state.within) / crank

    return name, force


def throw_stress(source: Source) -> Iterator[Panel]:
    """Largest combined stress of each part of the crank throw over the cycle."""
    called = {f"sigma_{part}": words.removeprefix("the ") for part, (_, words) in PARTS.items()}
    return source.panels([*called], words=called)


def torque_orders(source: Source) -> Iterator[Panel]:
    """Amplitudes of the turning effort by order, periods per turn of the shaft."""
    found, drawn = source.results.machine, source.results.orders <= _HIGHEST
    spectra = [
        np.abs(one)[drawn] for one in (found.whole, found.gas, found.inertia) if one is not None
    ]
    whole, *parts = spectra
    orders, name = source.results.orders[drawn], Words("|M_ν|", words="amplitude")
    both = len(parts) == 2 and all(part.any() for part in parts)  # one alone is all
    if whole.any():
        yield _bars(orders, [whole], name, "torque", "all" if both else "")
    if both:
        yield _bars(orders, parts, name, "torque", "left: gas, weight, friction; right: inertia")


def unbalanced_orders(source: Source) -> Iterator[Panel]:
    """Radii of the circles on which unbalanced force and moment turn, order by order, with the shaft and against it."""
    omega, free, panels = source.results.omega, source.results.free, list[Panel]()
    for name, kind, vector in (("F", "force", free.force), ("M", "torque", free.moment)):
        if source.having("F_x") and vector is not None and free.orders:
            sizes = [
                np.array([abs(vector.of(sense * n)) for n in free.orders]) * omega**2
                for sense in (1, -1)
            ]
            title = "left: turning with the shaft, right: against it"
            panels.append(_bars(free.orders, sizes, Words(name, words="radius"), kind, title))
    # what is balanced has nothing to show, unless all is
    yield from [
        panel for panel in panels if any(shade.high.any() for shade in panel.shades)
    ] or panels[:1]


def _bars(
    orders: Sequence[float], sizes: Sequence[Array], name: Words, kind: str, title: str
) -> Panel:
    """Return one or two rows of sizes as bars over orders, next to each other."""
    wide, shades = 0.76 / len(sizes), list[Shade]()
    for number, row in enumerate(sizes):
        for place, size in enumerate(row):
            x = place - 0.38 + np.array([number, number + 1]) * wide
            shades.append(Shade(x, np.zeros(2), np.full(2, size), number == 0))
    names = tuple(f"{order:g}" for order in orders)
    x_axis = Axis(
        Words("n", words="order"), low=-0.6, high=max(len(names), _LEAST_BARS) - 0.4, names=names
    )
    return Panel(x_axis, Axis(name, kind, low=0.0), shades=tuple(shades), title=title)


def shaft_modes(source: Source) -> Iterator[Panel]:
    """Angles by which the masses of the shaft line turn in its first natural vibrations."""
    found, curves = source.results, list[Curve]()
    names = tuple(mass.name for mass in found.line.masses)
    places = _along(found.line)
    is_gap = np.isnan(places)
    masses = np.where(is_gap, 0, places).astype(int)
    for mode, frequency in _frequencies(source):
        angles = np.asarray(found.holzer(mode).angles, dtype=float)
        shape = angles / np.abs(angles).max()
        upright = np.where(is_gap, math.nan, shape[masses])
        curves.append(Curve(Words(f"{mode}: {frequency:.4g} Hz"), places, upright))
    if curves:
        up = Axis(Words("θ", words="angle over the largest"))
        rest = level(np.arange(float(len(names))))
        yield Panel(Axis(Words(""), names=names), up, (*curves, rest))


def _along(line: ShaftLine) -> Array:
    """Return the numbers of the masses along a shaft line, with a gap before a branch or behind it.

    What follows a gap begins at the mass where it leaves the line.
    """
    places = [0.0]
    for segment in line.segments:
        before, behind = segment.before, segment.behind
        if GROUNDED in (before, behind):
            continue
        if before != places[-1]:
            places += [math.nan, math.nan, before]
        places.append(behind)
    return np.array(places)


def _frequencies(source: Source) -> list[tuple[int, float]]:
    """Return the first modes of a shaft line, each with its frequency in Hz."""
    found = source.results
    omegas = found.modes.omegas[1 - found.first :][:_MODES]
    return [(mode, float(omega) / (2 * math.pi)) for mode, omega in enumerate(omegas, 1)]


def campbell(source: Source) -> Iterator[Panel]:
    """Natural frequencies against the speed with the lines of the orders that excite them; where they cross the speed
    is critical: the strongest, and those near the working speed, the upright line, are marked with the order ν."""
    found, modes = source.results, _frequencies(source)
    working = found.machine.speed
    if not modes or not working:
        return
    fastest = _FASTEST * working
    every = [
        critical_speed
        for critical_speed in found.critical_speeds(_MODES, _HIGHEST)
        if critical_speed.speed <= fastest and critical_speed.share > 0
    ]
    strongest = sorted(every, key=lambda one: -one.share)
    marked = [one for number, one in enumerate(strongest) if number < _STRONGEST or one.near]
    orders = sorted({one.order for one in marked})
    reached = [
        frequency for _, frequency in modes if frequency <= fastest * max(orders, default=0.0)
    ]
    top = 1.15 * max(reached, default=modes[0][1])

    curves = [
        curve(
            "line",
            1j * frequency,
            fastest + 1j * frequency,
            name=Words(f"f_{mode}", words=f"mode {mode}"),
        )
        for mode, frequency in modes
        if frequency <= top
    ]
    for order in orders:
        end = min(fastest, top / order)
        curves.append(curve("faint", 0j, complex(end, order * end)))
    curves.append(
        curve("faint", complex(working), complex(working, top), name=Words("working speed"))
    )
    marks = [
        Mark(
            one.speed,
            one.order * one.speed,
            PageFigure(Words(f"ν = {one.order:g}:"), one.speed, kind="speed"),
        )
        for one in marked
    ]
    x, y = (
        Axis(Words("n", words="speed"), "speed", low=0.0),
        Axis(Words("f", words="frequency"), "frequency", low=0.0),
    )
    yield Panel(x, y, tuple(curves), marks=tuple(marks))


# tips of vectors over the cycle


def unbalanced_vectors(source: Source) -> Iterator[Panel]:
    """Locus of the tip of the unbalanced force, and of the unbalanced moment, over one revolution."""
    results = source.results
    each = (
        ("F_x", "F_y", "F_free_max", results.F_free_max),
        ("M_x", "M_y", "M_free_max", results.M_free_max),
    )
    known = [one for one in each if source.having(*one[:2]) == one[:2]]
    # what is balanced is a point, which is shown only where all is
    for x, y, id, largest in [one for one in known if one[3] and one[3].value] or known[:1]:
        tip = partial(_of_components, x, y)
        panel = source.locus(tip, x, source.words(y), cycle=360.0, largest=(id, largest))
        yield panel._replace(x=source.axis(x), y=source.axis(y))


def _of_components(x: str, y: str, state: AtAngles) -> ComplexArray:
    return state[x] + 1j * state[y]


def unbalanced_over_angle(source: Source) -> Iterator[Panel]:
    """Unbalanced force, unbalanced moment and rolling moment on the frame over the crank angle."""
    words = {
        "F_x": "along the stroke",
        "F_y": "across it",
        "M_x": "along the stroke",
        "M_y": "across it",
    }
    return source.panels(["F_x", "F_y"], ["M_x", "M_y"], ["M_roll"], words=words)


def polar_loads(source: Source) -> Iterator[Panel]:
    """Locus of the tip of the load on every pin and main bearing, in the frames of throw, engine and rod, unless it is
    all but a straight line."""
    largest = source.extreme("load_max")
    panels = [
        source.locus(
            partial(_tip_of_load, frame),
            "load",
            source.words("load"),
            _FRAMES[frame],
            largest=("load_max", largest),
        )
        for frame in source.having(*_FRAMES)
    ]
    yield from [panel for panel in panels if _slenderness(panel) < _SLENDEREST] or panels[:1]


def _tip_of_load(frame: str, state: BearingColumns) -> ComplexArray:
    """Return the load along and across the direction from which its angle counts; of 0 there is none."""
    angle = np.where(state.load > 0, np.nan_to_num(state[frame]), 0.0)
    return state.load * np.exp(1j * np.radians(angle))


def _slenderness(panel: Panel) -> float:
    """Return the longer over the shorter side of what the curve of a panel covers."""
    short, long = sorted(
        float(np.nanmax(one) - np.nanmin(one)) for one in (panel.curves[0].x, panel.curves[0].y)
    )
    return long / short if short else math.inf
