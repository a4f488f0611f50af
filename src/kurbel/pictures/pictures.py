"""The pictures of a cylinder, each a function that yields its panels; the list of all pictures, and their drawing."""

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import partial
from itertools import chain, islice, pairwise
from operator import attrgetter, itemgetter
from typing import NamedTuple

import numpy as np

from kurbel.arrays import Array, ComplexArray
from kurbel.declared.reading import text_in_one_line
from kurbel.errors import NoSolutionError, UsageError
from kurbel.mechanisms.slider_crank import SliderCrank
from kurbel.near_words import did_you_mean
from kurbel.pictures.constructions import construction, polar_force
from kurbel.pictures.machine_pictures import (
    campbell,
    crank_efforts,
    driven_force,
    effort,
    effort_of_sides,
    flow,
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
from kurbel.solver.state import State
from kurbel.tables.frame import equal_parts
from kurbel.tables.tables import cylinder_meant, grouped, together

# one cylinder


def piston_force(source: Source) -> Iterator[Panel]:
    """Force P_0 of gas, weight and resistance against the line of the inertia forces over the crank angle; what is
    between them is the piston force P, shown alone below. It changes sign where both lines cross."""
    if not source.having("P"):
        return
    reversals = source.results.phi_reversal or ()
    lines = _remaining_force(source)
    panels = (
        [source.panel(lines, like="P", shaded=True, zero=True, also=reversals)]
        if len(lines) > 1
        else []
    )
    for panel in (*panels, source.panel(["P"], zero=True)):
        heights = (
            source.values(lines[1:], reversals)[0] if panel.shades else np.zeros(len(reversals))
        )
        figures = [PageFigure(Words("force reversal"), at_deg=angle) for angle in reversals]
        yield panel._replace(marks=(*panel.marks, *map(Mark, reversals, heights.tolist(), figures)))


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
    lines, reversals = _remaining_force(source), source.results.phi_reversal or ()
    panels = []
    for breaks, title in _strokes(source, reversals):
        panel = source.panel(
            lines, "x", like="P", shaded=True, zero=True, breaks=breaks, title=title
        )
        marks = _reversals_of_stroke(source, lines, reversals, breaks)
        panels.append(panel._replace(marks=(*panel.marks, *marks)))
    # one scale for all, or the noise of a traced gas exchange would have its own
    heights = np.concatenate([one for panel in panels for one in panel.places[1]])
    low, high = float(np.nanmin(heights)), float(np.nanmax(heights))
    low -= 0.1 * (high - low)  # or a lowest line that is level would be on the axis
    yield from (panel._replace(y=panel.y._replace(low=low, high=high)) for panel in panels)


def _reversals_of_stroke(
    source: Source,
    lines: Sequence[CurveFormula],
    reversals: Sequence[float],
    breaks: Sequence[float],
) -> Iterator[Mark]:
    """Yield a mark J where the piston force reverses in a stroke: on the inertia line, else on zero."""
    start, end = breaks[0], breaks[-1]
    for angle in reversals:
        is_inside = start < angle < end or start < angle + source.results.drive.cycle < end
        if is_inside:
            state = source.results.at([angle])
            height = float(lines[1][1](state)[0]) if len(lines) > 1 else 0.0
            yield Mark(float(state.x[0]), height, PageFigure(Words("J"), at_deg=angle))


def _strokes(source: Source, also: Sequence[float] = ()) -> Iterator[tuple[list[float], str]]:
    """Yield the crank angles at which a stroke begins, bends, or has a point, and ends, and its name."""
    drive = source.results.drive
    cycle, (inner, outer) = drive.cycle, drive.mechanism.dead_centres()
    bends = [angle + turn for angle in (*source.results.breaks, *also) for turn in (0.0, cycle)]
    ends = sorted(
        {(end + turn) % cycle for turn in range(0, int(cycle), 360) for end in (inner, outer)}
    )
    for start, end in pairwise((*ends, ends[0] + cycle)):
        name = "Outstroke" if math.cos(math.radians(start - inner)) > 1 - 1e-9 else "Return stroke"
        yield (
            [start, *(angle for angle in bends if start < angle < end), end],
            f"{name} {start:.4g}–{end:.4g}°",
        )


def piston_force_of_crank(source: Source) -> Iterator[Panel]:
    """Force of the driving pistons, with the efficiency, over the stroke, against that of the driven ones and of the
    masses: what is left between them passes through the crank (R Abb. 1065)."""
    drive = source.results.drive
    if len(source.having("P", "x")) < 2 or not (drive.drives and drive.driven):
        return
    has_losses = bool(drive.machine.efficiency != 1)
    driving = Words("η P_driving", "eta P_driving") if has_losses else Words("P_driving")
    lines: list[CurveFormula] = [
        (driving, lambda state: drive.machine.efficiency * state.P_driving),
        (Words("−P_driven"), lambda state: -driven_force(state)),
    ]
    if source.having("P_inertia"):
        masses = " − P_b − P_w" if source.having("P_weight") else " − P_b"
        lines.append((Words(f"−P_driven{masses}"), lambda state: state.P_driving - state.P))
    for breaks, title in _strokes(source):
        yield source.panel(lines, "x", like="P", shaded=True, zero=True, breaks=breaks, title=title)


def cards(source: Source, over_volume: bool = False) -> Iterator[Panel]:
    """Pressure at both ends of the pistons over the displacement from the inner dead centre (R Abb. 1051)."""
    results, every = source.results, source.results.drive.gas
    for gas in every:
        across = Axis(Words("V", words="volume"), "volume") if over_volume else source.axis("x")
        curves = list[Curve]()
        for number, end in enumerate((gas.head, gas.crank)):
            if end:
                name, _ = source.line(
                    "p_crank" if number else "p_head", "crank end" if number else "head end"
                )
                place = partial(_volume, gas, number) if over_volume else attrgetter("displacement")
                samples = source.samples(
                    "P", [(NO_NAME, place), (name, partial(_pressure, gas, end))]
                )
                curves.append(samples.curve(name, *samples.values).closed())
        marks: tuple[Mark, ...] = ()
        if gas is every[0] and not over_volume and (highest := results.p_max):
            marks = (
                source.mark("p_max", highest, float(results.at([highest.degrees]).displacement[0])),
            )
        up = Axis(Words("p", words="absolute pressure" if gas.absolute else "pressure"), "pressure")
        curves.append(level(np.concatenate([one.x for one in curves]), gas.base))
        title = gas.piston.name if len(every) > 1 else ""
        yield Panel(across, up, tuple(curves), marks=marks, title=title)


def _pressure(gas: PistonGas, end: Pressure, state: State) -> Array:
    """Return the pressure in Pa at an end of a piston, absolute if the file has it so."""
    return state.pressure(end) + gas.base


def _volume(gas: PistonGas, number: int, state: State) -> Array:
    """Return the volume in m³ at the head end of a piston, 0, or the crank end, 1, with the clearance if known."""
    swept = gas.stroke - state.displacement if gas.turned != bool(number) else state.displacement
    return np.asarray(swept * gas.areas[number] + gas.clearance_volumes[number])


def cards_over_volume(source: Source) -> Iterator[Panel]:
    """Pressure over the volume swept in each chamber, with the clearance where that is known."""
    return cards(source, over_volume=True)


def forces(source: Source) -> Iterator[Panel]:
    """Forces in the rod, on the guide and at the crank pin over the crank angle (R Abb. 1061, 1062)."""
    offered = [
        offer.quantity.id
        for offer in source.results.drive.mechanism.OFFERS
        if offer.quantity.commands == ("forces",)
    ]
    found = source.having("S", "N", "D", "T", "M_out", *offered)
    for alike in grouped(found, lambda id: source.quantities[id].kind):
        yield source.panel(alike, zero=True)


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


def motion_over_stroke(source: Source) -> Iterator[Panel]:
    """Velocity and acceleration over the displacement; dashed those of an infinite rod, an ellipse and a straight line
    (R Abb. 1049, 1050)."""
    for id in source.having("c", "b") if source.having("x") else ():
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
    panel, drive = source.panel([id], over), source.results.drive
    if not isinstance(drive.mechanism, SliderCrank) or math.isinf(drive.mechanism.rod):
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
    samples = source.samples(
        id, [(name, infinite[over]), (name, infinite[id])], breaks=once if over == "x" else None
    )
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
    PictureKind("forces", "Forces in the crank train", "forces", forces),
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
    name, cylinders = case.machine.name, [cylinder.drive.name for cylinder in case.cylinders]
    if options.cylinder:
        if tuple(names) == ("throw-stress",):
            cylinders += [throw.name for throw in case.stress.throws]
        options = options._replace(cylinder=cylinder_meant(options.cylinder, cylinders))
        if options.cylinder not in cylinders:
            there = f"there is no '{text_in_one_line(options.cylinder or '')}'; there are {', '.join(cylinders)}"
            raise UsageError(f"--cylinder: {there}")
    if not names or "all" in names:
        each = filter(None, (pictures_if_any(case, kind, options) for kind in PICTURES))
        drawn = list(islice(each, None if names else 1))
        if not drawn and not names:
            raise UsageError(f"{name}: there is nothing to draw; kurbel check says what is missing")
        yield from chain.from_iterable(drawn)
        return
    known = {kind.id: kind for kind in PICTURES}
    for id in names:
        found = _drawn(case, known[id], options) if id in known else []
        if not found:
            wrong = f"no picture '{text_in_one_line(id)}'{did_you_mean(id, tuple(known))}"
            wrong = (
                f"{name} has no picture '{id}': what it shows is left out" if id in known else wrong
            )
            raise UsageError(
                f"{wrong} ({name} has {', '.join(kind.id for kind in pictures_of(case, options))})"
            )
        yield from found


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


@np.errstate(all="ignore")
def _drawn(case: Case, kind: PictureKind, options: PictureOptions) -> list[Picture]:
    found = []
    for source, name in _sources(case, kind, options):
        if panels := tuple(in_units(panel, options.system) for panel in kind.panels(source)):
            across = min(kind.across, len(panels))
            found.append(
                Picture(kind.id, kind.title, kind.text, panels, case.machine.name, name, across)
            )
    return found


def _sources(
    case: Case, kind: PictureKind, options: PictureOptions
) -> Iterator[tuple[Source, str]]:
    """Yield (source of a picture, name of its cylinder or bearing); identical ones are drawn once."""
    command, wanted = (
        kind.command,
        [
            cylinder
            for cylinder in case.cylinders
            if options.cylinder in (None, cylinder.drive.name)
        ],
    )
    if not command:
        yield (
            Source((case, wanted), options.angles),
            (len(case.cylinders) > 1 and options.cylinder) or "",
        )
    elif command == "torsion":
        yield Source(case.torsion, options.angles), ""
    elif command == "stress":
        throw = case.stress.worst
        for other in case.stress.throws:
            if options.cylinder in (other.name, *(forces.drive.name for forces in other.rods)):
                throw = other
        yield Source(throw, options.angles), "" if case.stress.only else throw.name
    elif command not in _OF_PARTS:
        having = [one.results for one in subjects_of(case, command) if one.results]
        yield Source(having[-1], options.angles), ""
    else:
        for one in wanted if command == "forces" else ():
            one.refuse_locking()
        parts = [subject for subject in subjects_of(case, command) if not subject.whole]
        for equal in equal_parts(parts, command):
            named = [
                one
                for one in equal
                if command == "bearings" or options.cylinder in (None, one.name)
            ]
            if named:
                several = command == "bearings" or len(case.cylinders) > 1
                names = together([one.name for one in named]) if several else ""
                yield Source(named[0].results, options.angles), names
