"""The pictures of the whole machine and of its bearings: functions that yield their panels, listed in `pictures`."""

import math
from collections.abc import Iterator, Sequence
from functools import partial
from typing import Any

import numpy as np

from kurbel.arrays import Array
from kurbel.report.picture import Axis, Curve, Mark, PageFigure, Panel, Shade, Words
from kurbel.report.picture_source import PHI, Sampled, Source, between, level
from kurbel.solver.effort import Term
from kurbel.solver.state import State
from kurbel.solver.stress import PARTS

_MOST_NUMBERED = 24
_HIGHEST = 12
"""Order up to which bars are drawn: beyond it they are too small to be seen."""
_LEAST_BARS = 6
"""How many there is room for at least, so that one alone is no block."""
_MODES = 4
_FASTEST, _MOST_ORDERS = 1.25, 8
"""Of a Campbell diagram: its highest speed over the working speed, and how many orders it has."""
_MOST_CRANKS = 4
"""Each has a stroke of its own, next to the sum with and without losses."""
_SLENDEREST = 15.0
"""Length over height of a locus from which on it is drawn as little as a line."""
_FRAMES = {"load_throw": "throw: outward →", "load_engine": "engine: stroke line →", "load_rod": "rod: its line →"}


def effort(source: Source) -> Iterator[Panel]:
    """Turning effort of the whole machine and the resistance, its lobes numbered with their work; below them the excess
    work and the speed (R Abb. 1064 to 1067)."""
    results = source.results
    if not source.having("M"):
        return
    id, radius = ("T", results.crank) if source.having("T") else ("M", 1.0)
    samples = source.samples((PHI, id, "M_load"), results.phi_crossing)
    x, line, load = samples.values
    level_load = results.machine.load is None or results.machine.load.diagram is None
    name = Words("W" if id == "T" else "M_m" if level_load else "M_W", words="resistance")
    resistance = samples.curve(name, x, load / radius)
    curves = samples.curve(source.words(id), x, line), resistance._replace(kind="faint" if level_load else "line")
    shades, lobes = list(between(x, load / radius, line)), results.lobes
    if 0 < len(lobes) <= _MOST_NUMBERED:
        # of a lobe that the end of the cycle cuts, the wider part has its number and work
        widest: dict[int, int] = {}
        for place, shade in enumerate(shades):
            owner = int(np.searchsorted(results.phi_crossing, (shade.x[0] + shade.x[-1]) / 2) - 1) % len(lobes)
            wide = [np.ptp(shades[one].x) for one in (place, widest.get(owner, place))]
            widest[owner] = place if wide[0] >= wide[1] else widest[owner]
        for owner, place in widest.items():
            shades[place] = shades[place]._replace(figure=PageFigure(Words(f"A_{owner + 1}"), lobes[owner]))
    marks = source.marks(id, lambda angle: angle)
    yield Panel(source.axis(PHI), source.axis(id), curves, tuple(shades), marks)

    yield from source.panels(("E",))
    means = ("omega", "omega_mean", results.omega_mean), ("M_coupling", "M_mean", results.M_mean)
    for id, mean, height in means:
        for panel in source.panels((id,)):
            mean_line = level(panel.curves[0].x, height, source.words(mean))
            yield panel._replace(curves=(*panel.curves, mean_line))


def flow(source: Source) -> Iterator[Panel]:
    """Flow that the pumps deliver over the crank angle, and its mean; what is between them fills and empties the air
    vessel. Below it, where there is a suction pipe without a vessel, the head that accelerates the liquid."""
    if not source.having("flow"):
        return
    samples, mean = source.samples((PHI, "flow")), source.results.flow_mean
    x, line = samples.values
    panel = source.panel(("flow",))
    curves = (*panel.curves, level(x, mean, source.words("flow_mean")))
    yield panel._replace(curves=curves, shades=tuple(between(x, np.full_like(x, mean), line)))
    yield from source.panels(("acceleration_head",))


def crank_efforts(source: Source) -> Iterator[Panel]:
    """Tangential force of each cylinder as its crank stands, their sum, and dashed the sum with the efficiency (R Abb.
    1062, 1064)."""
    effort, crank = source.results.effort, source.results.crank
    acting = [one for one in effort.cylinders if one.drive.has_force]
    lossy = bool(effort.machine.efficiency != 1)
    if effort.given is not None or not source.having("T") or len(acting) > _MOST_CRANKS or len(acting) + lossy < 2:
        return
    lines = [(source.words("T"), 0, effort.sampled([Term(1.0, group) for group in effort.groups]))]
    lines += [(Words("T with η", "T with eta"), 1, effort.M)] if lossy else []
    for number, one in enumerate(acting if len(acting) > 1 else ()):
        lines.append((Words(one.drive.name), 2 + number, effort.sampled([Term(1.0, [one])])))
    samples = _efforts(source, [torque for *_, torque in lines])
    x, *found = samples.values
    curves = [samples.curve(name, x, y)._replace(look=look) for (name, look, _), y in zip(lines, found)]
    mean = level(x, float(effort.mean[0]) / crank, Words("W"))
    yield Panel(source.axis(PHI), source.axis("T"), (*curves, mean), marks=source.marks("T", lambda angle: angle))


def effort_of_sides(source: Source) -> Iterator[Panel]:
    """Turning effort of the driving pistons, with losses and masses, against the resistance line of the driven ones
    (R Abb. 1067)."""
    effort = source.results.effort
    driven = [group for group in effort.groups if group[0].drive.driven]
    if effort.given is not None or not source.having("T") or not driven or not effort.drives:
        return
    resistance = -effort.sampled([Term(1.0, group, lambda one: driven_force(one) * one.slope) for group in driven])
    samples = _efforts(source, [effort.M + resistance, resistance])
    x, driving, against = samples.values
    names = Words("T_driving", words="driving pistons"), Words("−T_driven", words="driven pistons")
    curves = [samples.curve(name, x, line) for name, line in zip(names, (driving, against))]
    shades = tuple(between(x, against, driving))
    yield Panel(source.axis(PHI), source.axis("T"), (*curves, level(x)), shades)


def driven_force(state: State) -> Any:
    """Return the force in N of the pistons of a rod that do not drive, and of what a ram works against."""
    gas = 0.0 if state.P_gas is None else state.P_gas - (0.0 if state.P_driving is None else state.P_driving)
    return gas if state.P_ram is None else gas + state.P_ram


def _efforts(source: Source, torques: Sequence[Array]) -> Sampled:
    """Return crank angles and torques on the pieces of the machine as forces on crank 1."""
    effort, crank = source.results.effort, source.results.crank

    def values(degrees: Array, within: Array) -> Array:
        return np.stack([degrees, *(effort.at(effort.pieces, one, degrees, within) / crank for one in torques)])

    return source.samples((PHI, *("T" for _ in torques)), values=values)


def throw_stress(source: Source) -> Iterator[Panel]:
    """Largest combined stress of each part of the crank throw over the cycle."""
    called = {f"σ_{index}": part.removeprefix("the ") for index, part in PARTS.values()}
    for panel in source.panels(tuple(f"sigma_{part}" for part in PARTS)):
        yield panel.called(called)._replace(y=panel.y._replace(name=Words("", words="combined stress")))


def torque_orders(source: Source) -> Iterator[Panel]:
    """Amplitudes of the turning effort by order, periods per turn of the shaft."""
    found, drawn = source.results.machine, source.results.orders <= _HIGHEST
    gas, whole = (np.abs(one)[drawn] for one in (found.gas, found.whole))
    orders, name = source.results.orders[drawn], Words("|M_ν|", words="amplitude")
    inertia = np.zeros(0) if found.inertia is None else np.abs(found.inertia)[drawn]
    both = gas.any() and inertia.any()  # one alone is all
    if whole.any():
        yield _bars(orders, [whole], name, "torque", "all" if both else "")
    if both:
        yield _bars(orders, [gas, inertia], name, "torque", "left: gas, weight, friction; right: inertia")


def unbalanced_orders(source: Source) -> Iterator[Panel]:
    """The circles of each order, with the rotation and against it."""
    omega, free, panels = source.results.omega, source.results.free, list[Panel]()
    for name, kind, vector in (("F", "force", free.force), ("M", "torque", free.moment)):
        if source.having("F_x") and vector is not None and free.orders:
            sizes = [np.array([abs(vector.of(sense * n)) for n in free.orders]) * omega**2 for sense in (1, -1)]
            title = "left: turning with the shaft, right: against it"
            panels.append(_bars(free.orders, sizes, Words(name, words="radius"), kind, title))
    # what is balanced has nothing to show, unless all is
    yield from [one for one in panels if any(shade.high.any() for shade in one.shades)] or panels[:1]


def _bars(orders: Sequence[float], sizes: Sequence[Array], name: Words, kind: str, title: str) -> Panel:
    """Return one or two rows of sizes as bars over orders, next to each other."""
    wide = 0.76 / len(sizes)
    shades = []
    for number, row in enumerate(sizes):
        for place, size in enumerate(row):
            left = place - 0.38 + number * wide
            shades.append(Shade(np.array([left, left + wide]), np.zeros(2), np.full(2, size), number == 0))
    names = tuple(f"{order:g}" for order in orders)
    x = Axis(Words("n", words="order"), low=-0.6, high=max(len(names), _LEAST_BARS) - 0.4, names=names)
    return Panel(x, Axis(name, kind, low=0.0), shades=tuple(shades), title=title)


def shaft_modes(source: Source) -> Iterator[Panel]:
    """Angles by which the masses of the shaft line turn in its first natural vibrations."""
    found, curves = source.results, []
    places = np.arange(float(len(found.line.masses)))
    for mode in range(1, min(_MODES, found.first + len(found.modes.omegas) - 1) + 1):
        angles = np.asarray(found.holzer(mode).angles, dtype=float)
        frequency = float(found.modes.omegas[mode - found.first]) / (2 * math.pi)
        curves.append(Curve(Words(f"{mode}: {frequency:.4g} Hz"), places, angles / np.abs(angles).max()))
    if curves:
        names = tuple(mass.name for mass in found.line.masses)
        yield Panel(
            Axis(Words(""), names=names), Axis(Words("θ", words="angle over the largest")), (*curves, level(places))
        )


def campbell(source: Source) -> Iterator[Panel]:
    """Natural frequencies against the speed with the lines of the orders that excite them; where they cross the speed
    is critical. The upright line is the working speed."""
    found = source.results
    modes = [float(omega) / (2 * math.pi) for omega in found.modes.omegas[1 - found.first :][:_MODES]]
    working = found.machine.speed
    if not modes or not working:
        return
    fastest = _FASTEST * working
    critical = found.critical_speeds(_MODES, _HIGHEST)
    reached = [one for one in critical if one.speed <= fastest and one.share > 0]
    orders = sorted({one.order for one in sorted(reached, key=lambda one: -one.share)[:_MOST_ORDERS]})
    drawn = [one for one in reached if one.order in orders and one.mode <= len(modes)]
    top = max((one for one in modes if one <= fastest * max(orders, default=0.0)), default=modes[0]) * 1.15
    ends = np.array([0.0, fastest])
    curves = []
    for number, frequency in enumerate(modes, 1):
        if frequency <= top:
            curves.append(Curve(Words(f"f_{number}", words=f"mode {number}"), ends, np.full(2, frequency)))
    for order in orders:
        end = min(fastest, top / order)
        curves.append(Curve(Words(f"ν = {order:g}"), np.array([0.0, end]), np.array([0.0, order * end]), "faint"))
    curves.append(Curve(Words("working speed"), np.full(2, working), np.array([0.0, top]), "faint"))
    marks = [
        Mark(one.speed, one.order * one.speed, PageFigure(Words("n_k"), one.speed), of_x=True)
        for one in sorted(drawn, key=lambda one: -one.share)
    ]
    x, y = Axis(Words("n", words="speed"), "speed", low=0.0), Axis(Words("f", words="frequency"), "frequency", low=0.0)
    yield Panel(x, y, tuple(curves), marks=tuple(marks))


# tips of vectors over the cycle


def unbalanced_vectors(source: Source) -> Iterator[Panel]:
    """Locus of the tip of the unbalanced force, and of the unbalanced moment, over one revolution."""
    results = source.results
    each = ("F_x", "F_y", "F_free_max", results.F_free_max), ("M_x", "M_y", "M_free_max", results.M_free_max)
    known = [one for one in each if source.having(*one[:2]) == one[:2]]
    # what is balanced is a point, which is shown only where all is
    for x, y, id, largest in [one for one in known if one[3] and one[3].value] or known[:1]:
        tip = partial(source.values, (x, y))
        marks = (source.mark(id, largest, *tip(largest.degrees)[:, 0].tolist()),) if largest and largest.value else ()
        panel = source.locus((x, y), tip, source.words(y), marks, cycle=360.0)
        yield panel._replace(x=source.axis(x), y=source.axis(y))


def unbalanced_over_angle(source: Source) -> Iterator[Panel]:
    """Unbalanced force, unbalanced moment and rolling moment on the frame over the crank angle."""
    words = {"F_x": "along the stroke", "F_y": "across it", "M_x": "along the stroke", "M_y": "across it"}
    for panel in source.panels(("F_x", "F_y"), ("M_x", "M_y"), ("M_roll",)):
        yield panel.called(words)


def polar_loads(source: Source) -> Iterator[Panel]:
    """Locus of the tip of the load on every pin and main bearing, in the frames of throw, engine and rod, unless it is
    all but a straight line."""
    largest = source.results.load_max if "load_max" in source.key_values and source.marks("load", float) else None
    panels = list[Panel]()
    for frame in source.having(*_FRAMES):

        def tip(degrees: Array, within: Array, frame: str = frame) -> Array:
            """Return the load (2, n) along and across the direction from which its angle counts; of 0 there is none."""
            load, angle = source.values(("load", frame), degrees, within)
            angle = np.radians(np.where(load > 0, np.nan_to_num(angle), 0.0))
            return np.stack([load * np.cos(angle), load * np.sin(angle)])

        marks: tuple[Mark, ...] = ()
        if largest and largest.value:
            at = np.full(2, largest.degrees)
            # at a jump the largest load is on one of its sides
            sides = tip(at, at + np.array([-1e-6, 1e-6]))
            side = int(np.argmin(np.abs(np.hypot(*sides) - largest.value)))
            marks = (source.mark("load_max", largest, *sides[:, side].tolist()),)
        panels.append(source.locus(("load", "load"), tip, source.words("load"), marks, _FRAMES[frame]))
    yield from [one for one in panels if _slenderness(one) < _SLENDEREST] or panels[:1]


def _slenderness(panel: Panel) -> float:
    """Return the longer over the shorter side of what the curve of a panel covers."""
    short, long = sorted(float(np.nanmax(one) - np.nanmin(one)) for one in (panel.curves[0].x, panel.curves[0].y))
    return long / short if short else math.inf
