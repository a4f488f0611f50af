"""The pictures of a machine: each a function that yields its panels, and the list of them."""

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import partial
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from kurbel.arrays import Array
from kurbel.declared.reading import shown
from kurbel.errors import KurbelError, NoSolutionError, UsageError
from kurbel.mechanisms.slider_crank import SliderCrank
from kurbel.near_words import did_you_mean
from kurbel.report.alike import together
from kurbel.report.constructions import construction, polar_force
from kurbel.report.crank import equal_bearings, equal_cylinders
from kurbel.report.frame import subjects_of
from kurbel.report.mechanism_picture import mechanism
from kurbel.report.picture import Axis, Curve, Mark, PageFigure, Panel, Picture, Shade, Words
from kurbel.report.picture_source import PHI, PictureOptions, Sampled, Source, Values, in_units, level
from kurbel.report.tables import cylinder_meant
from kurbel.solver.case import Case
from kurbel.solver.effort import Term
from kurbel.solver.state import State
from kurbel.solver.stress import PARTS

_CROSSING = 1e-9
"""Of the largest distance between two lines: where they cross, rounding alone is between them."""
_MOST_NUMBERED = 24
_MOST_SHADES = 100
_HIGHEST = 12
"""Order up to which bars are drawn: beyond it they are too small to be seen."""
_MODES = 4
_FASTEST, _MOST_ORDERS = 1.25, 8
"""Of a Campbell diagram: its highest speed over the working speed, and how many orders it has."""
_MOST_CRANKS = 4
"""Each has a stroke of its own, next to the sum with and without losses."""
_FRAMES = {"load_throw": "throw: outward →", "load_engine": "engine: stroke line →", "load_rod": "rod: its line →"}

# one cylinder


def piston_force(source: Source) -> Iterator[Panel]:
    """Force P_0 of gas, weight and resistance against the line of the inertia forces over the crank angle; what is
    between them is the piston force P, shown alone below. It changes sign where both lines cross."""
    if not source.having("P"):
        return

    def marked(heights: Sequence[float]) -> list[Mark]:
        figures = (PageFigure(Words("force reversal"), at_deg=angle) for angle in reversals)
        return [Mark(*one) for one in zip(reversals, heights, figures)]

    reversals = source.results.phi_reversal or ()
    ids = source.having("P_start", "P_inertia")
    if len(ids) == 2:
        panel = _remaining_force(source, ids, PHI, also=reversals)
        yield panel._replace(marks=tuple(marked((-source.values(ids, reversals)[1]).tolist())))
    panel = source.panel(("P",), zero=True)
    yield panel._replace(marks=(*panel.marks, *marked([0.0] * len(reversals))))


def _remaining_force(source: Source, ids: Sequence[str], over: str, **how: Any) -> Panel:
    """Return a panel of a force and the inertia line, or the line of no force, with what is between them shaded."""
    samples = source.samples((over, *ids), **how)
    x, force, *inertia = samples.values
    base = -inertia[0] if inertia else np.zeros_like(x)
    name = Words("P_0", words="without inertia") if inertia else Words("P")
    curves = [samples.curve(name, x, force)]
    curves += [samples.curve(Words("−P_b", words="inertia line"), x, base)] if inertia else []
    return Panel(source.axis(over), source.axis("P"), (*curves, level(x)), tuple(_between(x, base, force)))


def _between(x: Array, base: Array, line: Array) -> Iterator[Shade]:
    """Yield what is between two lines, cut where they cross; where they cross all over, what is above and below."""
    apart = line - base
    above = np.where(np.abs(apart) > _CROSSING * np.abs(apart).max(), np.sign(apart), 0.0)
    # a point on the base belongs to the area before it, and to the next one, too
    crossings = np.flatnonzero((above[1:-1] == 0) | (above[1:-1] * above[2:] < 0)) + 1
    if len(crossings) > _MOST_SHADES:
        yield Shade(x, base, np.maximum(line, base))
        yield Shade(x, base, np.minimum(line, base), gain=False)
        return
    for start, end in pairwise((0, *crossings.tolist(), len(x) - 1)):
        part = slice(start, end + 1)
        if end > start and (above[part] != 0).any():
            yield Shade(x[part], base[part], line[part], bool(above[part].sum() > 0))


def piston_force_over_stroke(source: Source) -> Iterator[Panel]:
    """The same over the displacement of the piston, stroke by stroke (R Abb. 1055)."""
    if len(source.having("P", "x")) < 2 or source.results.drive.mechanism.turns:
        return
    parts = source.having("P_start", "P_inertia")
    ids = parts if len(parts) == 2 else ("P",)
    strokes = _strokes(source, partial(source.values, ("x", *ids)), source.results.phi_reversal or ())
    panels = [_remaining_force(source, ids, "x", **how)._replace(title=title) for how, title in strokes]
    if any(gas.traced for gas in source.results.drive.gas):  # or the noise of the gas exchange would have its own scale
        heights = np.concatenate([one for panel in panels for one in panel.places[1]])
        low, high = float(np.nanmin(heights)), float(np.nanmax(heights))
        panels = [panel._replace(y=panel.y._replace(low=low, high=high)) for panel in panels]
    yield from panels


def _strokes(source: Source, of: Values, also: Sequence[float] = ()) -> Iterator[tuple[dict[str, Any], str]]:
    """Yield how `Source.samples` takes values over each stroke, with points at the angles `also`, and its name."""
    results, drive = source.results, source.results.drive
    cycle, (inner, outer) = drive.cycle, drive.mechanism.dead_centres()
    bends = [angle + turn for angle in (*results.breaks, *also) for turn in (0.0, cycle)]

    def values(degrees: Array, within: Array) -> Array:
        turned = cycle * np.floor(within / cycle)  # the end of the cycle is not its beginning
        return of(degrees - turned, within - turned)

    ends = sorted({(end + turn) % cycle for turn in range(0, int(cycle), 360) for end in (inner, outer)})
    for start, end in pairwise((*ends, ends[0] + cycle)):
        breaks = np.array(sorted({start, *(angle for angle in bends if start < angle < end), end}))
        name = "Outstroke" if math.cos(math.radians(start - inner)) > 1 - 1e-9 else "Return stroke"
        yield {"values": values, "breaks": breaks}, f"{name} {start:.4g}–{end:.4g}°"


def piston_force_of_crank(source: Source) -> Iterator[Panel]:
    """Force of the driving pistons, with the efficiency, over the stroke, against that of the driven ones and of the
    masses: what is left between them passes through the crank (R Abb. 1065)."""
    results, drive = source.results, source.results.drive
    if len(source.having("P", "x")) < 2 or not (drive.drives and drive.driven):
        return
    moved = bool(source.having("P_inertia"))
    ids = ("x", "P", "P", "P") if moved else ("x", "P", "P")

    def values(degrees: Array, within: Array) -> Array:
        state = results.at(degrees, within)
        steam = state.P_driving
        lines = [state.x, drive.machine.efficiency * steam, -driven_force(state)]
        return np.stack([*lines, steam - state.P] if moved else lines)

    masses = " − P_b − P_w" if source.having("P_weight") else " − P_b"
    names = Words("η P_driving", "eta P_driving"), Words("−P_driven"), Words(f"−P_driven{masses}")
    for how, title in _strokes(source, values):
        samples = source.samples(ids, **how)
        x, *lines = samples.values
        curves = [samples.curve(name, x, line) for name, line in zip(names, lines)]
        shades = tuple(_between(x, lines[-1], lines[0]))
        yield Panel(source.axis("x"), source.axis("P"), (*curves, level(x)), shades, title=title)


def cards(source: Source, over_volume: bool = False) -> Iterator[Panel]:
    """Pressure at both ends of the pistons over the displacement from the inner dead centre (R Abb. 1051)."""
    results = source.results
    for number, gas in enumerate(results.drive.gas):
        ends = [(id, end) for id, end in (("p_head", gas.head), ("p_crank", gas.crank)) if end]

        def values(degrees: Array, within: Array) -> Array:
            state = results.at(degrees, within)
            pressures = (state.pressure(end) + gas.base for _, end in ends)  # noqa: B023 (used before the next one)
            return np.stack([state.way, *pressures])

        samples = source.samples(("x", *(id for id, _ in ends)), values=values)
        x, *pressures = samples.values
        places, curves = list[Array](), list[Curve]()
        for (id, _), pressure in zip(ends, pressures):
            place = x
            if over_volume:
                piston, head = gas.piston, id == "p_head"
                own = head != gas.turned
                chamber = piston.indicator and (piston.indicator.head_end if head else piston.indicator.crank_end)
                clearance = getattr(chamber, "clearance", None) or 0.0
                swept = (x if own else gas.stroke - x) + clearance * gas.stroke
                place = np.asarray(swept * gas.areas[0 if head else 1])
            places.append(place)
            end = source.words(id)._replace(words=id.replace("p_", "") + " end")
            curves.append(samples.curve(end, place, pressure))
        marks: tuple[Mark, ...] = ()
        if number == 0 and not over_volume and (highest := results.p_max):
            marks = (source.mark("p_max", highest, float(results.at(np.array([highest.degrees])).way[0])),)
        across = Axis(Words("V", words="volume"), "volume") if over_volume else source.axis("x")
        up = Axis(Words("p", words="pressure"), "pressure", mark="abs" if gas.absolute else "")
        title = gas.piston.name if len(results.drive.gas) > 1 else ""
        curves.append(level(np.concatenate(places), gas.base))
        yield Panel(across, up, tuple(curves), marks=marks, title=title)


def cards_over_volume(source: Source) -> Iterator[Panel]:
    """Pressure over the volume swept in each chamber, with the clearance where that is known."""
    return cards(source, over_volume=True)


def forces(source: Source) -> Iterator[Panel]:
    """Forces in the rod, on the guide and at the crank pin over the crank angle (R Abb. 1061, 1062)."""
    offered = [one.quantity.id for one in source.results.drive.mechanism.OFFERS if one.quantity.commands == ("forces",)]
    found = source.having("S", "N", "D", "T", "M_out", *offered)
    for kind in dict.fromkeys(source.quantities[id].kind for id in found):
        yield source.panel([id for id in found if source.quantities[id].kind == kind], zero=True)


def polar_effort(source: Source) -> Iterator[Panel]:
    """Tangential force T drawn outward from the circle of the crank pin."""
    if not source.having("T"):
        return
    (force,) = source.samples(("T",)).values
    size = float(np.abs(force).max()) or 1.0
    base = max(0.6 * size, 0.25 * size - float(force.min()))

    def tip(degrees: Any, within: Array | None = None) -> Array:
        place = (base + source.values(("T",), degrees, within)[0]) * np.exp(1j * np.radians(degrees))
        return np.stack([place.real, place.imag])

    around = np.exp(2j * np.pi * np.linspace(0.0, 1.0, 121))
    rings = [(Words("T = 0"), base * around)]
    if mean := source.results.W:
        rings.append((Words("W"), (base + mean) * around))
    for angle in range(0, 360, 90):
        spoke = np.array([base, 1.04 * (base + size)]) * np.exp(1j * np.radians(angle))
        rings.append((Words(f"φ = {angle}°", f"phi = {angle}"), spoke))
    faint = [Curve(name, places.real, places.imag, "faint") for name, places in rings]
    marks = source.marks("T", lambda angle: tip(angle)[:, 0])
    panel, axis = source.locus(("T", "T"), tip, source.words("T"), ()), Axis(Words(""), "force")
    yield panel._replace(x=axis, y=axis, curves=(*panel.curves, *faint), marks=marks, plain=True)


def motion(source: Source) -> Iterator[Panel]:
    """Displacement, velocity and acceleration over the crank angle; dashed those of an infinite rod (R Abb. 1047 to
    1050)."""
    for ids in (("x",), ("c",), ("b",), ("theta",), ("theta_dot",), ("theta_ddot",)):
        for panel in source.panels(ids):
            yield _with_infinite_rod(source, panel, ids[0], PHI)


def motion_over_stroke(source: Source) -> Iterator[Panel]:
    """Velocity and acceleration over the displacement; dashed those of an infinite rod, an ellipse and a straight line
    (R Abb. 1049, 1050)."""
    for id in ("c", "b"):
        for panel in source.panels((id,), over="x"):
            yield _with_infinite_rod(source, panel, id, "x")


def _with_infinite_rod(source: Source, panel: Panel, id: str, over: str) -> Panel:
    """Return a panel of x, c or b of a slider-crank with the same for an infinite rod."""
    drive = source.results.drive
    if not isinstance(drive.mechanism, SliderCrank) or math.isinf(drive.mechanism.rod):
        return panel

    def values(degrees: Array, within: Array) -> Array:
        turned, crank, omega = np.radians(degrees), drive.mechanism.crank, drive.omega or 0.0
        way = crank * (1 - np.cos(turned))
        of = {"x": way, "c": crank * omega * np.sin(turned), "b": crank * omega**2 * np.cos(turned)}
        return np.stack([degrees if over == PHI else way, of[id]])

    # over the displacement once to and fro, of a straight line once only: dashes over dashes are no dashes
    once = np.array([0.0, 180.0] if id == "b" else [0.0, 180.0, 360.0]) if over == "x" else None
    samples, symbol = source.samples((over, id), values=values, breaks=once), source.words(id).symbol
    name = Words(f"{symbol}, L/R = ∞", f"{symbol}, L/R = inf")
    return panel._replace(curves=(*panel.curves, samples.curve(name, *samples.values)))


# the whole machine


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
    resistance = samples.curve(Words("W" if id == "T" else "M_m" if level_load else "M_W"), x, load / radius)
    curves = samples.curve(source.words(id), x, line), resistance._replace(kind="faint" if level_load else "line")
    shades, lobes = list(_between(x, load / radius, line)), results.lobes
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
    yield panel._replace(curves=curves, shades=tuple(_between(x, np.full_like(x, mean), line)))
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
    shades = tuple(_between(x, against, driving))
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
    for panel in source.panels(tuple(f"sigma_{part}" for part in PARTS)):
        called = {f"σ_{index}": part.removeprefix("the ") for index, part in PARTS.values()}
        names = [one.name._replace(words=called.get(one.name.symbol, "")) for one in panel.curves]
        curves = tuple(one._replace(name=name) for one, name in zip(panel.curves, names))
        yield panel._replace(curves=curves, y=panel.y._replace(name=Words("", words="combined stress")))


def torque_orders(source: Source) -> Iterator[Panel]:
    """Amplitudes of the turning effort by order, periods per turn of the shaft."""
    found, drawn = source.results.machine, source.results.orders <= _HIGHEST
    gas, whole = (np.abs(one.amplitudes)[drawn] for one in (found.gas, found.whole))
    orders, name = source.results.orders[drawn], Words("|M_ν|", words="amplitude")
    yield _bars(orders, [whole], name, "torque", "all")
    if found.inertia is not None:
        inertia = np.abs(found.inertia.amplitudes)[drawn]
        yield _bars(orders, [gas, inertia], name, "torque", "left: gas, weight, friction; right: inertia")


def unbalanced_orders(source: Source) -> Iterator[Panel]:
    """The circles of each order, with the rotation and against it."""
    if source.having("F_x"):
        omega, free = source.results.omega, source.results.free
        for name, kind, vector in (("F", "force", free.force), ("M", "torque", free.moment)):
            if vector is not None and free.orders:
                sizes = [np.array([abs(vector.of(sense * n)) for n in free.orders]) * omega**2 for sense in (1, -1)]
                title = "left: circles with the rotation, right: against it"
                yield _bars(free.orders, sizes, Words(name, words="radius"), kind, title)


def _bars(orders: Sequence[float], sizes: Sequence[Array], name: Words, kind: str, title: str) -> Panel:
    """Return one or two rows of sizes as bars over orders, next to each other."""
    wide = 0.76 / len(sizes)
    shades = []
    for number, row in enumerate(sizes):
        for place, size in enumerate(row):
            left = place - 0.38 + number * wide
            shades.append(Shade(np.array([left, left + wide]), np.zeros(2), np.full(2, size), number == 0))
    names = tuple(f"{order:g}" for order in orders)
    x = Axis(Words("n", words="order"), low=-0.6, high=len(names) - 0.4, names=names)
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
        names = [one.name._replace(words=words.get(one.name.symbol, "")) for one in panel.curves]
        yield panel._replace(curves=tuple(one._replace(name=name) for one, name in zip(panel.curves, names)))


def polar_loads(source: Source) -> Iterator[Panel]:
    """Locus of the tip of the load on every pin and main bearing, in the frames of throw, engine and rod."""
    largest = source.results.load_max if "load_max" in source.key_values and source.marks("load", float) else None
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
        yield source.locus(("load", "load"), tip, source.words("load"), marks, _FRAMES[frame])


# which pictures there are


class PictureKind(NamedTuple):
    """A picture: its word and title, the command whose results it shows, and the function that yields its panels.

    The docstring of that function says what is seen. It yields nothing where the machine lacks what the picture shows.
    across: panels next to each other.
    """

    id: str
    title: str
    command: str
    panels: Callable[[Source], Iterable[Panel]]
    across: int = 1

    @property
    def text(self) -> str:
        """The sentence that says what is seen."""
        return " ".join((self.panels.__doc__ or "").split())


PICTURES = (
    PictureKind("piston-force", "Piston force", "forces", piston_force),
    PictureKind("piston-force-way", "Piston force over the stroke", "forces", piston_force_over_stroke),
    PictureKind("piston-force-crank", "Piston force that the crank passes on", "forces", piston_force_of_crank),
    PictureKind("card", "Indicator diagram", "forces", cards),
    PictureKind("card-volume", "Indicator diagram over the volume", "forces", cards_over_volume),
    PictureKind("forces", "Forces in the crank train", "forces", forces),
    PictureKind("effort-polar", "Tangential force in polar form", "forces", polar_effort),
    PictureKind("force-polar", "Piston force in polar form", "forces", polar_force),
    PictureKind("effort", "Turning effort", "flywheel", effort),
    PictureKind("flow", "Flow delivered", "delivery", flow),
    PictureKind("effort-cranks", "Turning effort of each crank", "flywheel", crank_efforts),
    PictureKind("effort-sides", "Turning effort against the driven pistons", "flywheel", effort_of_sides),
    PictureKind("throw-stress", "Stress of the crankshaft", "stress", throw_stress),
    PictureKind("bearing-loads", "Bearing loads in polar form", "bearings", polar_loads, across=2),
    PictureKind("orders", "Turning effort by order", "harmonics", torque_orders),
    PictureKind("modes", "Natural modes of the shaft", "torsion", shaft_modes),
    PictureKind("campbell", "Campbell diagram", "torsion", campbell),
    PictureKind("free-vectors", "Unbalanced force and moment", "balance", unbalanced_vectors),
    PictureKind("free-angle", "Unbalanced force and moment over the crank angle", "balance", unbalanced_over_angle),
    PictureKind("free-orders", "Unbalanced force and moment by order", "balance", unbalanced_orders),
    PictureKind("motion", "Displacement, velocity, acceleration", "motion", motion),
    PictureKind("motion-way", "Velocity and acceleration over the stroke", "motion", motion_over_stroke),
    PictureKind("mechanism", "Mechanism", "motion", mechanism, across=2),
    PictureKind("construction", "Constructions of displacement and velocity", "motion", construction),
)
"""The pictures, the most informative picture of a machine first."""


_OF_MACHINE = ("flywheel", "stress", "balance", "harmonics", "torsion", "delivery")
"""Commands whose pictures are of the whole machine; those of others are drawn of each cylinder or bearing."""


def pictures(case: Case, names: Sequence[str], options: PictureOptions) -> Iterator[Picture]:
    """Yield these pictures of a machine; without names the first that it has, for `all` every one.

    Raises UsageError for a picture that does not exist, or that this machine does not have, NoSolutionError where the
    machine locks itself or stalls.
    """
    name, cylinders = case.machine.name, tuple(one.drive.name for one in case.cylinders)
    if options.cylinder:
        options = options._replace(cylinder=cylinder_meant(options.cylinder, cylinders))
    known = {kind.id: kind for kind in PICTURES}
    if not names or "all" in names:
        found = False
        for kind in PICTURES:
            for one in pictures_if_any(case, kind, options):
                found = True
                yield one
            if found and not names:
                return
        if not found and not names:
            raise UsageError(f"{name}: there is nothing to draw; kurbel check says what is missing")
        return

    if unknown := [id for id in names if id not in known]:
        having = ", ".join(kind.id for kind in pictures_of(case, options))
        hint = did_you_mean(unknown[0], tuple(known))
        raise UsageError(f"no picture '{shown(unknown[0])}'{hint} ({name} has {having})")
    for id in names:
        if drawn := _drawn(case, known[id], options):
            yield from drawn
        elif options.cylinder in (None, *cylinders):
            having = ", ".join(kind.id for kind in pictures_of(case, options))
            raise UsageError(f"{name} has no picture '{id}': what it shows is left out; it has {having}")
        else:
            there = ", ".join(cylinders)
            raise UsageError(f"--cylinder: there is no '{shown(options.cylinder or '')}'; there are {there}")


def pictures_if_any(case: Case, kind: PictureKind, options: PictureOptions) -> list[Picture]:
    """Return one picture of a machine, as often as it has it, or none; raises NoSolutionError as `pictures` does."""
    try:
        return _drawn(case, kind, options)
    except UsageError:
        return []


def pictures_of(case: Case, options: PictureOptions) -> list[PictureKind]:
    """Return the pictures that a machine has, those without a solution among them: drawing reports why."""
    found = []
    for kind in PICTURES:
        with np.errstate(all="ignore"):
            try:
                has = any(True for source, _ in _sources(case, kind, options) for _ in kind.panels(source))
            except KurbelError as error:
                has = isinstance(error, NoSolutionError)
        found += [kind] if has else []
    return found


def _drawn(case: Case, kind: PictureKind, options: PictureOptions) -> list[Picture]:
    found = []
    with np.errstate(all="ignore"):
        for source, name in _sources(case, kind, options):
            if panels := tuple(in_units(panel, options.system) for panel in kind.panels(source)):
                # three of which two are next to each other would leave a quadrant empty
                across = 3 if kind.across > 1 and len(panels) == 3 else min(kind.across, len(panels))
                found.append(Picture(kind.id, kind.title, kind.text, panels, case.machine.name, name, across))
    return found


def _sources(case: Case, kind: PictureKind, options: PictureOptions) -> Iterator[tuple[Source, str]]:
    """Yield what a picture is drawn from, each with the name of its cylinder or bearing; equal ones are drawn once."""
    command = kind.command
    if command in _OF_MACHINE:
        results = case.torsion if command == "torsion" else subjects_of(case, command)[-1].results
        yield Source(results, options.angles), ""
    elif command == "bearings":
        for bearings in equal_bearings(case):
            yield Source(bearings[0], options.angles), together([one.name for one in bearings])
    else:
        for one in case.cylinders if command == "forces" else ():
            if options.cylinder in (None, one.drive.name):
                one.refuse_locking()
        for equal in equal_cylinders(case, command, options.cylinder):
            names = together([one.drive.name for one in equal]) if len(case.cylinders) > 1 else ""
            yield Source(equal[0], options.angles), names
