"""The pictures of a cylinder, each a function that yields its panels; the list of all pictures, and their drawing."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import partial
from itertools import chain, islice, pairwise
from operator import attrgetter, itemgetter
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kurbel.arrays import Array, ComplexArray
from kurbel.declared.forms.figures import scoped
from kurbel.declared.reading import text_in_one_line
from kurbel.errors import NoSolutionError, UsageError
from kurbel.near_words import did_you_mean
from kurbel.numerics.extreme import number_of
from kurbel.pictures.constructions import construction, polar_force
from kurbel.pictures.heat import heat_release
from kurbel.pictures.machine_pictures import (
    campbell,
    crank_efforts,
    driven_force,
    effort,
    effort_of_sides,
    flow,
    journal_orbit,
    polar_loads,
    shaft_modes,
    throw_stress,
    torque_orders,
    unbalanced_orders,
    unbalanced_over_angle,
    unbalanced_vectors,
)
from kurbel.pictures.picture import Axis, Curve, Mark, PageFigure, Panel, Picture, Words
from kurbel.pictures.picture_source import (
    AROUND,
    NO_NAME,
    PHI,
    CurveFormula,
    PictureOptions,
    Source,
    curve,
    in_units,
    level,
)
from kurbel.pictures.section import mechanism
from kurbel.pictures.valve import reuleaux, valve_ellipse, zeuner
from kurbel.report.commands import subjects_of
from kurbel.solver.case import Case
from kurbel.solver.gas import PistonGas, Pressure
from kurbel.solver.rod_load import LEAST_REVERSAL, RodLoads
from kurbel.solver.state import State
from kurbel.tables.frame import equal_parts
from kurbel.tables.tables import cylinder_meant, grouped, joined_names

if TYPE_CHECKING:
    from kurbel.pictures.measured import TracePictures

# one cylinder


def piston_force(source: Source) -> Iterator[Panel]:
    """Force P_0 of gas, weight and resistance against the line of the inertia forces over the crank angle; what is
    between them is the piston force P, shown alone below. It changes sign where both lines cross."""
    if not source.having("P"):
        return
    reversals = source.results.phi_reversal or ()
    figures = [PageFigure(Words("force reversal"), at_deg=angle) for angle in reversals]
    lines = _remaining_force(source)
    if len(lines) > 1:
        panel = source.panel(lines, like="P", shaded=True, zero=True, also=reversals)
        # a panel without an area has its marks on zero
        heights = np.zeros(len(reversals))
        if panel.shades:
            heights = source.values(lines[1:], reversals)[0]
        marks = map(Mark, reversals, heights.tolist(), figures)
        yield panel._replace(marks=(*panel.marks, *marks))
    panel = source.panel(["P"], zero=True)
    marks = map(Mark, reversals, [0.0] * len(reversals), figures)
    yield panel._replace(marks=(*panel.marks, *marks))


def _remaining_force(source: Source) -> list[CurveFormula]:
    """Return what the force P is between: P_0 and the inertia line, or P and zero."""
    if len(source.having("P_start", "P_inertia")) < 2:
        return [(Words("P"), itemgetter("P"))]
    inertia = Words("−P_b", words="inertia line"), lambda state: -state.P_inertia
    return [(Words("P_0", words="without inertia"), itemgetter("P_start")), inertia]


def piston_force_over_stroke(source: Source) -> Iterator[Panel]:
    """Piston force over the displacement, stroke by stroke; with inertia it is what is between P_0 and the inertia
    line. J: force reversal (R Abb. 1055)."""
    if len(source.having("P", "x")) < 2 or source.results.drive.mechanism.turns:
        return
    lines = _remaining_force(source)
    reversals = source.results.phi_reversal or ()
    panels = []
    for breaks, title in _strokes(source, reversals):
        panel = source.panel(
            lines, "x", like="P", shaded=True, zero=True, breaks=breaks, title=title
        )
        marks = _reversals_of_stroke(source, lines, reversals, breaks)
        panels.append(panel._replace(marks=(*panel.marks, *marks)))
    # one scale for all, or the noise of a traced gas exchange would have its own
    heights = []
    for panel in panels:
        heights += panel.places[1]
    high = float(np.nanmax(np.concatenate(heights)))
    low = float(np.nanmin(np.concatenate(heights)))
    low -= 0.1 * (high - low)  # or a lowest line that is level would be on the axis
    for panel in panels:
        yield panel._replace(y=panel.y._replace(low=low, high=high))


def _reversals_of_stroke(
    source: Source,
    lines: Sequence[CurveFormula],
    reversals: Sequence[float],
    breaks: Array,
) -> Iterator[Mark]:
    """Yield a mark J where the piston force reverses in a stroke: on the inertia line, else on zero."""
    start, end = breaks[0], breaks[-1]
    for angle in reversals:
        is_inside = start < angle < end or start < angle + source.results.drive.cycle < end
        if is_inside:
            state = source.results.at([angle])
            height = float(lines[1][1](state)[0]) if len(lines) > 1 else 0.0
            yield Mark(float(state.x[0]), height, PageFigure(Words("J"), at_deg=angle))


def _strokes(source: Source, also: Sequence[float] = ()) -> Iterator[tuple[Array, str]]:
    """Yield the crank angles at which a stroke begins, bends, or has a point, and ends, and its name."""
    drive = source.results.drive
    cycle, (inner, outer) = drive.cycle, drive.mechanism.dead_centres()
    # twice, since a stroke may go over the end of the cycle
    angles = np.concatenate((source.results.breaks, also))
    bends = np.sort(np.concatenate((angles, angles + cycle)))
    ends = set[float]()
    for turn in range(0, int(cycle), 360):
        ends |= {(inner + turn) % cycle, (outer + turn) % cycle}
    in_order = sorted(ends)
    for start, end in pairwise((*in_order, in_order[0] + cycle)):
        is_outward = math.cos(math.radians(start - inner)) > 1 - 1e-9
        name = "Outstroke" if is_outward else "Return stroke"
        inside = bends[(start < bends) & (bends < end)]
        yield np.concatenate(([start], inside, [end])), f"{name} {start:.4g}–{end:.4g}°"


def piston_force_of_crank(source: Source) -> Iterator[Panel]:
    """Force of the driving pistons, with the efficiency, over the stroke, against that of the driven ones and of the
    masses: what is left between them passes through the crank (R Abb. 1065)."""
    drive = source.results.drive
    if len(source.having("P", "x")) < 2 or not (drive.drives and drive.driven):
        return
    has_losses = bool(drive.machine.efficiency != 1)
    driving = Words("η P_driving", "eta P_driving") if has_losses else Words("P_driving")
    lines: list[CurveFormula] = [
        (driving, lambda state: drive.machine.efficiency * state.driving_force),
        (Words("−P_driven"), lambda state: -driven_force(state)),
    ]
    if source.having("P_inertia"):
        masses = " − P_b − P_w" if source.having("P_weight") else " − P_b"
        lines.append((Words(f"−P_driven{masses}"), lambda state: state.driving_force - state.P))
    for breaks, title in _strokes(source):
        yield source.panel(lines, "x", like="P", shaded=True, zero=True, breaks=breaks, title=title)


def cards(source: Source, over_volume: bool = False) -> Iterator[Panel]:
    """Pressure at both ends of the pistons over the displacement from the inner dead centre (R Abb. 1051)."""
    results, gases = source.results, source.results.drive.gas
    for gas in gases:
        curves = list[Curve]()
        for number, end in enumerate((gas.head, gas.crank)):
            if end:
                curves.append(_card(source, gas, number, end, over_volume))
        marks: tuple[Mark, ...] = ()
        highest = results.p_max
        if gas is gases[0] and not over_volume and highest:
            displacement = float(results.at([highest.degrees]).displacement[0])
            marks = (source.mark("p_max", highest, displacement),)
        across = Axis(Words("V", words="volume"), "volume") if over_volume else source.axis("x")
        up = Axis(Words("p", words="absolute pressure" if gas.absolute else "pressure"), "pressure")
        curves.append(level(np.concatenate([curve.x for curve in curves]), gas.base))
        title = gas.piston.name if len(gases) > 1 else ""
        yield Panel(across, up, tuple(curves), marks=marks, title=title)


def _card(source: Source, gas: PistonGas, number: int, end: Pressure, over_volume: bool) -> Curve:
    """Return the card of the head end of a piston, 0, or of its crank end, 1."""
    id, words = ("p_crank", "crank end") if number else ("p_head", "head end")
    name, _ = source.line(id, words)
    across = partial(_volume, gas, number) if over_volume else attrgetter("displacement")
    samples = source.samples("P", [(NO_NAME, across), (name, partial(_pressure, gas, end))])
    return samples.curve(name, *samples.values).closed()


def _pressure(gas: PistonGas, end: Pressure, state: State) -> Array:
    """Return the pressure in Pa at an end of a piston, absolute if the file has it so."""
    return state.pressure(end) + gas.base


def _volume(gas: PistonGas, number: int, state: State) -> Array:
    """Return the volume in m³ at the head end of a piston, 0, or the crank end, 1, with the clearance if known."""
    shrinks_outward = gas.turned != bool(number)
    stroke = gas.stroke - state.displacement if shrinks_outward else state.displacement
    return np.asarray(stroke * gas.areas[number] + gas.clearance_volumes[number])


def cards_over_volume(source: Source) -> Iterator[Panel]:
    """Pressure over the volume swept in each chamber, with the clearance where that is known."""
    return cards(source, over_volume=True)


def measured_cycles(source: Source) -> Iterator[Panel]:
    """Measured pressure over the crank angle after the dead centre of each chamber: every cycle in a thin line, their
    mean in a bold one, upright lines at the dead centres."""
    yield from _of_traces(source, lambda pictures: pictures.over_angle())


def measured_lines(source: Source) -> Iterator[Panel]:
    """Mean measured pressure over the volume of each chamber, both by powers of ten: where p V^n is constant the line
    is straight. n_c, n_d: exponents of compression and expansion, by the thin lines through the measured ones."""
    yield from _of_traces(source, lambda pictures: pictures.logarithmic())


def _of_traces(
    source: Source, panels: Callable[[TracePictures], Iterator[Panel]]
) -> Iterator[Panel]:
    """Yield panels of the traces of a cylinder, if it has any."""
    gases = source.results.drive.gas
    if any(gas.has_trace for gas in gases):
        yield from panels(_trace_pictures()(gases))


def _trace_pictures() -> type[TracePictures]:
    from kurbel.pictures.measured import TracePictures

    return TracePictures


def forces(source: Source) -> Iterator[Panel]:
    """Forces in the rod, on the guide and at the crank pin over the crank angle (R Abb. 1061, 1062)."""
    ids = ["S", "N", "D", "T", "M_out"]
    for offer in source.results.drive.mechanism.OFFERS:
        if offer.quantity.commands == ("forces",):
            ids.append(offer.quantity.id)
    for of_kind in grouped(source.having(*ids), lambda id: source.quantities[id].kind):
        yield source.panel(of_kind, zero=True)


_LIMITED = {"rod_compression_max": 1.0, "rod_tension_max": -1.0}
"""Limits that are drawn with the rod load at the crosshead pin, each with the sign of the load."""


def rod_load(source: Source) -> Iterator[Panel]:
    """Rod load of a compressor after API 618 over the crank angle: P_G at the crosshead pin is made from gas and
    inertia, P_KS at the piston rod lacks the crosshead; compression is positive. J: P_G reverses. Thin lines: limits of
    the machine."""
    results = source.results
    loads = None if results.no_compressor else results.rod_loads
    if loads is None or not source.having("P_rod"):
        return
    reversals = loads.phi_rod_reversal or ()
    at_pin = {"P_rod": "at the crosshead pin"}
    panel = source.panel(["P_rod"], shaded=True, zero=True, also=reversals, words=at_pin)

    # what it is made from, and the load of the piston rod
    names = {"P_piston_rod": "at the piston rod", "P_gas": "gas"}
    parts = [source.line(id, names[id]) for id in source.having(*names)]
    masses = results.drive.cylinder.masses
    if masses and results.drive.has_inertia:
        inertia = Words("−m b", "-m b", "inertia without the connecting rod")
        parts.append((inertia, lambda state: -masses.parts * state.b))
    with_parts = source.panel(parts, like="P_rod", also=reversals)
    load, zero = panel.curves
    limits = _limits_of_rod_load(source, load.x)

    # the largest loads, and where the load changes its direction
    marks = []
    for id, sign in _LIMITED.items():
        extreme = source.extreme(id)
        if extreme and extreme.value:
            mark = source.mark(id, extreme, extreme.degrees)
            marks.append(mark._replace(y=sign * mark.y))
    for angle in reversals:
        marks.append(Mark(angle, 0.0, PageFigure(Words("J"), at_deg=angle)))
    curves = (load, *with_parts.curves, zero, *limits)
    yield panel._replace(curves=curves, marks=tuple(marks), title=_reversal_text(loads))


def _limits_of_rod_load(source: Source, angles: Array) -> Iterator[Curve]:
    """Yield level lines at the limits of the rod load that the machine, or this cylinder, has."""
    drive = source.results.drive
    for name, bound in drive.machine.limits:
        scope, id = scoped(name)
        if id in _LIMITED and scope in ("", drive.name):
            symbol = source.key_values[id].symbol
            yield level(angles, _LIMITED[id] * float(bound), Words(f"limit of {symbol}"))


def _reversal_text(loads: RodLoads) -> str:
    """Return how long and how far the rod load reverses, and what API 618 requires."""
    angle, ratio = loads.reversal_longest, loads.reversal_ratio
    if not angle or ratio is None:
        return "never reverses"
    least_angle, least_ratio = LEAST_REVERSAL
    return (
        f"reverses over {angle:.4g}°, to {100 * ratio:.3g} % of the larger load "
        f"(API 618: {least_angle:g}°, {100 * least_ratio:g} %)"
    )


def polar_effort(source: Source) -> Iterator[Panel]:
    """Tangential force T drawn outward from the circle of the crank pin."""
    if not source.having("T"):
        return
    base = 1.2 * float(np.abs(source.samples("T", [source.line("T")]).values).max()) or 1.0

    def tip(state: State) -> ComplexArray:
        return (base + state.T) * np.exp(1j * np.radians(state.phi))

    circles = [curve("faint", *(base * AROUND), name=Words("T = 0"))]
    if mean := source.results.W:
        circles.append(curve("faint", *((base + mean) * AROUND), name=Words("W")))
    panel = source.locus(tip, "T", source.words("T"))
    marks = *source.marks("T", partial(source.point, tip)), *panel.marks
    yield panel._replace(curves=(*panel.curves, *circles), marks=marks, plain=True)


def motion(source: Source) -> Iterator[Panel]:
    """Displacement, velocity and acceleration over the crank angle; dashed those of an infinite rod (R Abb. 1047 to
    1050)."""
    for id in source.having("x", "c", "b", "theta", "theta_dot", "theta_ddot"):
        yield _with_infinite_rod(source, id, PHI)


def approximations(source: Source) -> Iterator[Panel]:
    """Error of the first-order formulas of the books (R 286, B 25, R 291) over the crank angle: approximation less exact
    value, with the largest errors marked; it grows with the cube of λ."""
    wholes = {"x_error": "stroke", "c_error": "c_max", "b_error": "b_max"}
    for id in source.having(*wholes):
        panel = source.panel([id], zero=True)
        largest = max((abs(mark.y) for mark in panel.marks), default=0.0)
        whole = source.key_values[wholes[id]]
        share = largest / abs(number_of(source.key_value(whole.id)))
        yield panel._replace(title=f"at most {100 * share:.2g} % of {whole.symbol}")


def motion_over_stroke(source: Source) -> Iterator[Panel]:
    """Velocity and acceleration over the displacement; dashed those of an infinite rod, an ellipse and a straight line
    (R Abb. 1049, 1050)."""
    if not source.having("x"):
        return
    for id in source.having("c", "b"):
        panel = _with_infinite_rod(source, id, "x")
        marks = _zeros_of_acceleration(source) if id == "b" else ()
        yield panel._replace(marks=(*panel.marks, *marks))


def _zeros_of_acceleration(source: Source) -> Iterator[Mark]:
    """Yield marks where b passes zero, one for both strokes if they are at the same displacement."""
    displacements = set[float]()
    for angle in source.results.motion.phi_b_zero or ():
        x = float(source.results.at([angle]).x[0])
        if round(x, 9) not in displacements:
            displacements.add(round(x, 9))
            yield Mark(x, 0.0, PageFigure(Words("b = 0"), at_deg=angle))


def _with_infinite_rod(source: Source, id: str, over: str) -> Panel:
    """Return a panel of a column; of x, c or b of a slider-crank with the same for an infinite rod."""
    panel = source.panel([id], over)
    drive = source.results.drive
    if math.isinf(drive.mechanism.rod_length):  # as where there is none
        return panel
    crank, omega = drive.mechanism.crank, drive.omega or 0.0
    infinite: dict[str, Callable[[State], Array]] = {
        PHI: lambda state: state.phi,
        "x": lambda state: crank * (1 - np.cos(np.radians(state.phi))),
        "c": lambda state: crank * omega * np.sin(np.radians(state.phi)),
        "b": lambda state: crank * omega**2 * np.cos(np.radians(state.phi)),
    }
    symbol = source.words(id).symbol
    name = Words(f"{symbol}, L/R = ∞", f"{symbol}, L/R = inf")
    # over the displacement out and back, but a straight line only out: two dashed lines would hide the dashes
    once = (0.0, 180.0) if id == "b" else (0.0, 180.0, 360.0)
    breaks = once if over == "x" else None
    samples = source.samples(id, [(name, infinite[over]), (name, infinite[id])], breaks=breaks)
    return panel._replace(curves=(*panel.curves, samples.curve(name, *samples.values)))


# which pictures there are


class PictureKind(NamedTuple):
    """A picture: its word and title, the command whose results it shows, and the function that yields its panels.

    The docstring of that function is the caption. It yields nothing if the machine lacks what the picture shows.
    across: panels next to each other. Without a command all cylinders of the machine are in one picture, drawn from
    the case and those that are wanted.
    """

    id: str
    title: str
    command: str
    panels: Callable[[Source], Iterable[Panel]]
    across: int = 1

    @property
    def text(self) -> str:
        """The caption."""
        return " ".join((self.panels.__doc__ or "").split())


PICTURES = (
    PictureKind("piston-force", "Piston force", "forces", piston_force),
    PictureKind(
        "piston-force-way", "Piston force over the stroke", "forces", piston_force_over_stroke
    ),
    PictureKind(
        "piston-force-crank",
        "Piston force that the crank passes on",
        "forces",
        piston_force_of_crank,
    ),
    PictureKind("card", "Indicator diagram", "forces", cards),
    PictureKind("card-volume", "Indicator diagram over the volume", "forces", cards_over_volume),
    PictureKind("trace-cycles", "Measured pressure", "forces", measured_cycles),
    PictureKind("trace-lines", "Compression and expansion", "forces", measured_lines),
    PictureKind("heat-release", "Heat release", "forces", heat_release),
    PictureKind("forces", "Forces in the crank train", "forces", forces),
    PictureKind("rod-load", "Rod load", "forces", rod_load),
    PictureKind("effort-polar", "Tangential force in polar form", "forces", polar_effort),
    PictureKind("force-polar", "Piston force in polar form", "forces", polar_force),
    PictureKind("effort", "Turning effort", "flywheel", effort),
    PictureKind("flow", "Flow delivered", "delivery", flow),
    PictureKind("effort-cranks", "Turning effort of each crank", "flywheel", crank_efforts),
    PictureKind(
        "effort-sides", "Turning effort against the driven pistons", "flywheel", effort_of_sides
    ),
    PictureKind("throw-stress", "Stress of the crankshaft", "stress", throw_stress),
    PictureKind("bearing-loads", "Bearing loads in polar form", "bearings", polar_loads, across=2),
    PictureKind("journal-orbit", "Path of the journal in its shell", "bearings", journal_orbit),
    PictureKind("orders", "Turning effort by order", "harmonics", torque_orders),
    PictureKind("modes", "Natural modes of the shaft", "torsion", shaft_modes),
    PictureKind("campbell", "Campbell diagram", "torsion", campbell),
    PictureKind("free-vectors", "Unbalanced force and moment", "balance", unbalanced_vectors),
    PictureKind(
        "free-angle",
        "Unbalanced force and moment over the crank angle",
        "balance",
        unbalanced_over_angle,
    ),
    PictureKind(
        "free-orders", "Unbalanced force and moment by order", "balance", unbalanced_orders
    ),
    PictureKind("zeuner", "Valve diagram of Zeuner", "motion", zeuner, across=2),
    PictureKind("reuleaux", "Valve diagram of Reuleaux", "motion", reuleaux, across=2),
    PictureKind("valve-ellipse", "Valve over the piston", "motion", valve_ellipse),
    PictureKind("motion", "Displacement, velocity, acceleration", "motion", motion),
    PictureKind(
        "motion-way", "Velocity and acceleration over the stroke", "motion", motion_over_stroke
    ),
    PictureKind("approximations", "Error of the approximations", "motion", approximations),
    PictureKind("mechanism", "Mechanism", "", mechanism),
    PictureKind(
        "construction", "Constructions of displacement and velocity", "motion", construction
    ),
)
"""The pictures, the most informative picture of a machine first."""
_OF_PARTS = ("motion", "forces", "bearings")
"""Commands whose pictures are of each cylinder or bearing; those of others are of the whole machine."""


def pictures(case: Case, names: Sequence[str], options: PictureOptions) -> Iterator[Picture]:
    """Yield these pictures of a machine; without names the first that it has, for `all` every one.

    Raises UsageError for a picture that does not exist, or that this machine does not have, NoSolutionError where the
    machine locks itself or stalls.
    """
    machine = case.machine.name
    if options.cylinder:
        options = options._replace(cylinder=_cylinder_meant(case, names, options.cylinder))
    if not names or "all" in names:
        drawn = filter(None, (pictures_if_any(case, kind, options) for kind in PICTURES))
        chosen = list(drawn if names else islice(drawn, 1))
        if not chosen and not names:
            raise UsageError(
                f"{machine}: there is nothing to draw; kurbel check says what is missing"
            )
        yield from chain.from_iterable(chosen)
        return
    kinds = {kind.id: kind for kind in PICTURES}
    for id in names:
        of_kind = _drawn(case, kinds[id], options) if id in kinds else []
        if not of_kind:
            wrong = f"no picture '{text_in_one_line(id)}'{did_you_mean(id, tuple(kinds))}"
            if id in kinds:
                wrong = f"{machine} has no picture '{id}': what it shows is left out"
            listed = ", ".join(kind.id for kind in pictures_of(case, options))
            raise UsageError(f"{wrong} ({machine} has {listed})")
        yield from of_kind


def _cylinder_meant(case: Case, names: Sequence[str], cylinder: str) -> str:
    """Return the name of the cylinder or throw that `--cylinder` means. Raises UsageError where there is none."""
    listed = [forces.drive.name for forces in case.cylinders]
    if tuple(names) == ("throw-stress",):
        listed += [throw.name for throw in case.stress.throws]
    name = cylinder_meant(cylinder, listed)
    if name not in listed:
        raise UsageError(
            f"--cylinder: there is no '{text_in_one_line(name)}'; there are {', '.join(listed)}"
        )
    return name


def pictures_if_any(case: Case, kind: PictureKind, options: PictureOptions) -> list[Picture]:
    """Return one picture of a machine, as often as it has it, or none; raises NoSolutionError as `pictures` does."""
    try:
        return _drawn(case, kind, options)
    except UsageError:
        return []


def pictures_of(case: Case, options: PictureOptions) -> list[PictureKind]:
    """Return the pictures that a machine has, those without a solution among them: drawing reports why."""

    def has(kind: PictureKind) -> bool:
        try:
            return bool(pictures_if_any(case, kind, options))
        except NoSolutionError:
            return True

    return [kind for kind in PICTURES if has(kind)]


def _drawn(case: Case, kind: PictureKind, options: PictureOptions) -> list[Picture]:
    """Return the pictures of a kind, one for each cylinder or bearing that differs."""
    drawn = []
    machine = case.machine.name
    for source, name in _sources(case, kind, options):
        panels = tuple(in_units(panel, options.system) for panel in kind.panels(source))
        if panels:
            across = min(kind.across, len(panels))
            drawn.append(Picture(kind.id, kind.title, kind.text, panels, machine, name, across))
    return drawn


def _sources(
    case: Case, kind: PictureKind, options: PictureOptions
) -> Iterator[tuple[Source, str]]:
    """Yield (source of a picture, name of its cylinder or bearing); identical ones are drawn once."""
    command, name = kind.command, options.cylinder
    if not command:
        chosen = [forces for forces in case.cylinders if name in (None, forces.drive.name)]
        is_named = len(case.cylinders) > 1 and bool(name)
        yield Source((case, chosen), options.angles), (name or "") if is_named else ""
    elif command == "torsion":
        yield Source(case.torsion, options.angles), ""
    elif command == "stress":
        throw = case.stress.worst
        for other in case.stress.throws:
            if name in (other.name, *(forces.drive.name for forces in other.rods)):
                throw = other
        yield Source(throw, options.angles), "" if case.stress.only else throw.name
    elif command in _OF_PARTS:
        yield from _sources_of_parts(case, command, options)
    else:
        with_results = [subject for subject in subjects_of(case, command) if subject.results]
        yield Source(with_results[-1].results, options.angles), ""


def _sources_of_parts(
    case: Case, command: str, options: PictureOptions
) -> Iterator[tuple[Source, str]]:
    """Yield (source, name) for each cylinder or bearing of a command that differs from those before it."""
    name = options.cylinder
    if command == "forces":
        for forces in case.cylinders:
            if name in (None, forces.drive.name):
                forces.refuse_locking()
    are_bearings = command == "bearings"
    are_several = are_bearings or len(case.cylinders) > 1
    parts = [subject for subject in subjects_of(case, command) if not subject.whole]
    for group in equal_parts(parts, command):
        chosen = [subject for subject in group if are_bearings or name in (None, subject.name)]
        if chosen:
            names = joined_names([subject.name for subject in chosen]) if are_several else ""
            yield Source(chosen[0].results, options.angles), names
