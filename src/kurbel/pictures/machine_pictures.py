"""The pictures of the whole machine and of its bearings: functions that yield their panels, listed in `pictures`."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from kurbel.arrays import Array, ComplexArray, Number
from kurbel.pictures.picture import Axis, Curve, Mark, PageFigure, Panel, Shade, Words
from kurbel.pictures.picture_source import AROUND, CurveFormula, Source, curve, level
from kurbel.solver.effort import Term
from kurbel.solver.figures import AtAngles
from kurbel.solver.state import State

if TYPE_CHECKING:
    from kurbel.machine.shaft_line import ShaftLine
    from kurbel.solver.chapters.bearing import BearingColumns
    from kurbel.solver.flywheel import TurningState

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

    # turning effort and resistance, as forces on the crank where there is one
    has_crank = bool(source.having("T"))
    id = "T" if has_crank else "M"
    radius = results.crank if has_crank else 1.0
    is_level = results.machine.load is None or results.machine.load.diagram is None
    if has_crank:
        load_symbol = "W"
    else:
        load_symbol = "M_m" if is_level else "M_W"
    name = Words(load_symbol, words="resistance")
    load: CurveFormula = name, lambda state: state["M_load"] / radius
    panel = source.panel([id, load], shaded=True, faint=is_level, also=results.phi_crossing)
    yield panel._replace(shades=_numbered(panel.shades, results.lobes, results.phi_crossing))

    # excess work, speed, and torque in the coupling
    yield from source.panels(["E"])
    if source.having("omega"):
        mean_speed: CurveFormula = source.words("omega_mean"), lambda state: results.omega_mean
        yield source.panel(["omega", mean_speed], faint=True)
    if source.having("M_coupling"):
        mean_torque: CurveFormula = source.words("M_mean"), lambda state: results.M_mean
        yield source.panel(["M_coupling", mean_torque], faint=True)


def _numbered(
    shades: Sequence[Shade], lobes: Sequence[float], crossings: Array
) -> tuple[Shade, ...]:
    """Return the areas between effort and resistance with number and work of their lobes, unless these are many."""
    numbered = list(shades)
    if not 0 < len(lobes) <= _MOST_NUMBERED:
        return tuple(numbered)
    lobe_of_shade = []
    for shade in shades:
        middle = (shade.x[0] + shade.x[-1]) / 2
        lobe_of_shade.append(int(np.searchsorted(crossings, middle) - 1) % len(lobes))
    for lobe, work in enumerate(lobes):
        of_lobe = [index for index, owner in enumerate(lobe_of_shade) if owner == lobe]
        if not of_lobe:
            continue
        # of a lobe that the end of the cycle cuts, the wider part has its number and work
        widest = max(of_lobe, key=lambda index: float(np.ptp(shades[index].x)))
        figure = PageFigure(Words(f"A_{lobe + 1}"), work, kind="energy")
        numbered[widest] = numbered[widest]._replace(figure=figure)
    return tuple(numbered)


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
    if effort.given is not None or not source.having("T"):
        return
    acting = [cylinder for cylinder in effort.cylinders if cylinder.drive.has_force]
    has_losses = bool(effort.machine.efficiency != 1)
    curves = len(acting) + (1 if has_losses else 0)
    if len(acting) > _MOST_CRANKS or curves < 2:
        return

    all_cranks = effort.sampled([Term(1.0, group) for group in effort.groups])
    lines = [_on_crank_1(source, source.words("T"), all_cranks)]
    if has_losses:
        lines.append(_on_crank_1(source, Words("T with η", "T with eta"), effort.M))
    if len(acting) > 1:
        for cylinder in acting:
            torque = effort.sampled([Term(1.0, [cylinder])])
            lines.append(_on_crank_1(source, Words(cylinder.drive.name), torque))
    lines.append((Words("W"), lambda state: effort.mean[0] / source.results.crank))
    yield source.panel(lines, like="T", faint=True)._replace(marks=source.marks("T"))


def effort_of_sides(source: Source) -> Iterator[Panel]:
    """Turning effort of the driving pistons, with losses and masses, against the resistance line of the driven ones
    (R Abb. 1067)."""
    effort = source.results.effort
    driven = [group for group in effort.groups if group[0].drive.driven]
    has_both_sides = bool(driven) and effort.drives
    if effort.given is not None or not source.having("T") or not has_both_sides:
        return
    terms = [Term(1.0, group, _driven_torque) for group in driven]
    resistance = -effort.sampled(terms)
    driving_name = Words("T_driving", words="driving pistons")
    driven_name = Words("−T_driven", words="driven pistons")
    lines = [
        _on_crank_1(source, driving_name, effort.M + resistance),
        _on_crank_1(source, driven_name, resistance),
    ]
    yield source.panel(lines, like="T", shaded=True, zero=True)


def _driven_torque(state: State) -> Number:
    return driven_force(state) * state.slope


def driven_force(state: State) -> Number:
    """Return the force in N of the pistons of a rod that do not drive, and of loads that the machine moves."""
    force: Number = 0.0 if state.P_gas is None else state.P_gas
    load = state.output_load
    if load is not None:
        force = force + load
    return force - state.driving_force


def _on_crank_1(source: Source, name: Words, torque: Array) -> CurveFormula:
    """Return a torque on the pieces of the machine as a force on crank 1."""
    effort, crank = source.results.effort, source.results.crank

    def force(state: TurningState) -> Array:
        return effort.at(effort.pieces, torque, state.phi, state.within) / crank

    return name, force


def throw_stress(source: Source) -> Iterator[Panel]:
    """Largest combined stress of each part of the crank throw over the cycle."""
    from kurbel.solver.chapters.stress_places import PARTS

    names = {}
    for part, (_, words) in PARTS.items():
        names[f"sigma_{part}"] = words.removeprefix("the ")
    return source.panels([*names], words=names)


def torque_orders(source: Source) -> Iterator[Panel]:
    """Amplitudes of the turning effort by order, periods per turn of the shaft."""
    machine = source.results.machine
    is_drawn = source.results.orders <= _HIGHEST
    orders = source.results.orders[is_drawn]
    name = Words("|M_ν|", words="amplitude")
    of_machine = np.abs(machine.whole)[is_drawn]
    parts = []
    for spectrum in (machine.gas, machine.inertia):
        if spectrum is not None:
            parts.append(np.abs(spectrum)[is_drawn])
    # a single part is all
    has_both = len(parts) == 2 and all(part.any() for part in parts)
    if of_machine.any():
        yield _bars(orders, [of_machine], name, "torque", "all" if has_both else "")
    if has_both:
        yield _bars(orders, parts, name, "torque", "left: gas, weight, friction; right: inertia")


def _has_bars(panel: Panel) -> bool:
    return any(shade.high.any() for shade in panel.shades)


def unbalanced_orders(source: Source) -> Iterator[Panel]:
    """Radii of the circles on which unbalanced force and moment turn, order by order, with the shaft and against it."""
    omega = source.results.omega
    free = source.results.free
    title = "left: turning with the shaft, right: against it"
    panels = []
    for name, kind, vector in (("F", "force", free.force), ("M", "torque", free.moment)):
        if vector is None or not free.orders or not source.having("F_x"):
            continue
        radii = []
        for sense in (1, -1):
            amplitudes = np.array([abs(vector.of(sense * order)) for order in free.orders])
            radii.append(amplitudes * omega**2)
        panels.append(_bars(free.orders, radii, Words(name, words="radius"), kind, title))

    # what is balanced has nothing to show, unless all is
    with_bars = [panel for panel in panels if _has_bars(panel)]
    yield from with_bars or panels[:1]


def _bars(
    orders: Sequence[float], sizes: Sequence[Array], name: Words, kind: str, title: str
) -> Panel:
    """Return one or two rows of sizes as bars over orders, next to each other."""
    bar_width = 0.76 / len(sizes)
    shades = []
    for number, row in enumerate(sizes):
        edges = np.array([number, number + 1]) * bar_width - 0.38
        for index, size in enumerate(row):
            shades.append(Shade(index + edges, np.zeros(2), np.full(2, size), number == 0))
    names = tuple(f"{order:g}" for order in orders)
    high = max(len(names), _LEAST_BARS) - 0.4
    x_axis = Axis(Words("n", words="order"), low=-0.6, high=high, names=names)
    return Panel(x_axis, Axis(name, kind, low=0.0), shades=tuple(shades), title=title)


def shaft_modes(source: Source) -> Iterator[Panel]:
    """Angles by which the masses of the shaft line turn in its first natural vibrations."""
    vibration = source.results
    names = tuple(mass.name for mass in vibration.line.masses)
    numbers = _along(vibration.line)
    is_gap = np.isnan(numbers)
    masses = np.where(is_gap, 0, numbers).astype(int)
    curves = []
    for mode, frequency in _frequencies(source):
        angles = np.asarray(vibration.holzer(mode).angles, dtype=float)
        relative = angles / np.abs(angles).max()
        upright = np.where(is_gap, math.nan, relative[masses])
        curves.append(Curve(Words(f"{mode}: {frequency:.4g} Hz"), numbers, upright))
    if curves:
        up = Axis(Words("θ", words="angle over the largest"))
        rest = level(np.arange(float(len(names))))
        yield Panel(Axis(Words(""), names=names), up, (*curves, rest))


def _along(line: ShaftLine) -> Array:
    """Return the numbers of the masses along a shaft line, with a gap before a branch or behind it.

    What follows a gap begins at the mass where it leaves the line.
    """
    from kurbel.machine.shaft_line import GROUNDED

    numbers = [0.0]
    for segment in line.segments:
        before, behind = segment.before, segment.behind
        if GROUNDED in (before, behind):
            continue
        if before != numbers[-1]:
            numbers += [math.nan, math.nan, before]
        numbers.append(behind)
    return np.array(numbers)


def _frequencies(source: Source) -> list[tuple[int, float]]:
    """Return the first modes of a shaft line, each with its frequency in Hz."""
    vibration = source.results
    omegas = vibration.modes.omegas[1 - vibration.first :][:_MODES]
    return [(mode, float(omega) / (2 * math.pi)) for mode, omega in enumerate(omegas, 1)]


def campbell(source: Source) -> Iterator[Panel]:
    """Natural frequencies against the speed with the lines of the orders that excite them; where they cross the speed
    is critical: the strongest, and those near the working speed, the upright line, are marked with the order ν."""
    vibration = source.results
    modes = _frequencies(source)
    working_speed = vibration.machine.speed
    if not modes or not working_speed:
        return
    fastest = _FASTEST * working_speed

    # the strongest critical speeds, and those near the working speed
    critical_speeds = [
        critical
        for critical in vibration.critical_speeds(_MODES, _HIGHEST)
        if critical.speed <= fastest and critical.share > 0
    ]
    strongest = sorted(critical_speeds, key=lambda critical: -critical.share)
    marked = strongest[:_STRONGEST]
    marked += [critical for critical in strongest[_STRONGEST:] if critical.near]
    orders = sorted({critical.order for critical in marked})
    highest_excited = fastest * max(orders, default=0.0)
    reached = [frequency for _, frequency in modes if frequency <= highest_excited]
    top = 1.15 * max(reached, default=modes[0][1])

    # level lines of the modes, lines of the orders through the origin, the working speed upright
    curves = []
    for mode, frequency in modes:
        if frequency <= top:
            name = Words(f"f_{mode}", words=f"mode {mode}")
            curves.append(curve("line", 1j * frequency, fastest + 1j * frequency, name=name))
    for order in orders:
        end = min(fastest, top / order)
        curves.append(curve("faint", 0j, complex(end, order * end)))
    working_line = (complex(working_speed), complex(working_speed, top))
    curves.append(curve("faint", *working_line, name=Words("working speed")))

    marks = []
    for critical in marked:
        name = Words(f"ν = {critical.order:g}:")
        figure = PageFigure(name, critical.speed, kind="speed")
        marks.append(Mark(critical.speed, critical.order * critical.speed, figure))
    x = Axis(Words("n", words="speed"), "speed", low=0.0)
    y = Axis(Words("f", words="frequency"), "frequency", low=0.0)
    yield Panel(x, y, tuple(curves), marks=tuple(marks))


# tips of vectors over the cycle


def unbalanced_vectors(source: Source) -> Iterator[Panel]:
    """Locus of the tip of the unbalanced force, and of the unbalanced moment, over one revolution."""
    results = source.results
    vectors = []
    for x, y, id, largest in (
        ("F_x", "F_y", "F_free_max", results.F_free_max),
        ("M_x", "M_y", "M_free_max", results.M_free_max),
    ):
        if source.having(x, y) == (x, y):
            vectors.append((x, y, id, largest))
    # what is balanced is a point, which is shown only where all is
    unbalanced = [vector for vector in vectors if vector[3] and vector[3].value]
    for x, y, id, largest in unbalanced or vectors[:1]:
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
    panels = []
    for frame in source.having(*_FRAMES):
        tip = partial(_tip_of_load, frame)
        name = source.words("load")
        panel = source.locus(tip, "load", name, _FRAMES[frame], largest=("load_max", largest))
        panels.append(panel)
    wide = [panel for panel in panels if _slenderness(panel) < _SLENDEREST]
    yield from wide or panels[:1]


def journal_orbit(source: Source) -> Iterator[Panel]:
    """Path of the middle of every pin and journal in its shell, as a share of the radial clearance, seen from the
    shell. On the circle they would touch."""
    if not source.having("eccentricity"):
        return
    farthest = "eccentricity_max", source.extreme("eccentricity_max")
    title = _FRAMES[f"load_{source.results.shell}"]
    name = source.words("eccentricity")
    panel = source.locus(_middle_of_journal, "eccentricity", name, title, largest=farthest)
    axis = Axis(name, "ratio")
    shell = curve("faint", *AROUND, name=Words("c"))
    yield panel._replace(x=axis, y=axis, curves=(*panel.curves, shell))


def _middle_of_journal(state: BearingColumns) -> ComplexArray:
    """Return ε."""
    return state["eccentricity"] * np.exp(1j * np.radians(state["film_direction"]))


def _tip_of_load(frame: str, state: BearingColumns) -> ComplexArray:
    """Return the load along and across the direction from which its angle counts; of 0 there is none."""
    angle = np.where(state.load > 0, np.nan_to_num(state[frame]), 0.0)
    return state.load * np.exp(1j * np.radians(angle))


def _slenderness(panel: Panel) -> float:
    """Return the longer over the shorter side of what the curve of a panel covers."""
    locus = panel.curves[0]
    width = float(np.nanmax(locus.x) - np.nanmin(locus.x))
    height = float(np.nanmax(locus.y) - np.nanmin(locus.y))
    short, long = sorted((width, height))
    if short:
        return long / short
    return math.inf
