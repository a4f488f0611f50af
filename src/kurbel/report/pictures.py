"""The pictures of a cylinder, each a function that yields its panels; the list of all pictures, and their drawing."""

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from functools import partial
from itertools import chain, islice, pairwise
from typing import Any, NamedTuple

import numpy as np

from kurbel.arrays import Array
from kurbel.declared.reading import shown
from kurbel.errors import KurbelError, NoSolutionError, UsageError
from kurbel.mechanisms.slider_crank import SliderCrank
from kurbel.near_words import did_you_mean
from kurbel.report.alike import together
from kurbel.report.commands import subjects_of
from kurbel.report.constructions import construction, polar_force
from kurbel.report.frame import equal_parts
from kurbel.report.machine_pictures import (
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
from kurbel.report.picture import Axis, Curve, Mark, PageFigure, Panel, Picture, Words
from kurbel.report.picture_source import PHI, PictureOptions, Source, Values, between, in_units, level
from kurbel.report.section import mechanism
from kurbel.report.tables import cylinder_meant
from kurbel.solver.case import Case

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
    return Panel(source.axis(over), source.axis("P"), (*curves, level(x)), tuple(between(x, base, force)))


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
        shades = tuple(between(x, lines[-1], lines[0]))
        yield Panel(source.axis("x"), source.axis("P"), (*curves, level(x)), shades, title=title)


def cards(source: Source, over_volume: bool = False) -> Iterator[Panel]:
    """Pressure at both ends of the pistons over the displacement from the inner dead centre (R Abb. 1051)."""
    results = source.results
    for number, gas in enumerate(results.drive.gas):
        ends = [(id, end) for id, end in (("p_head", gas.head), ("p_crank", gas.crank)) if end]

        def values(degrees: Array, within: Array) -> Array:
            state = results.at(degrees, within)
            pressures = (state.pressure(end) + gas.base for _, end in ends)  # noqa: B023 (used before the next one)
            return np.stack([state.displacement, *pressures])

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
            curves.append(samples.curve(end, place, pressure).closed())
        marks: tuple[Mark, ...] = ()
        if number == 0 and not over_volume and (highest := results.p_max):
            marks = (source.mark("p_max", highest, float(results.at(np.array([highest.degrees])).displacement[0])),)
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
    reach = 1.04 * (base + max(float(force.max()), mean or 0.0, 0.15 * size))
    for angle in range(0, 360, 90):
        spoke = np.array([base, reach]) * np.exp(1j * np.radians(angle))
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
        x = crank * (1 - np.cos(turned))
        of = {"x": x, "c": crank * omega * np.sin(turned), "b": crank * omega**2 * np.cos(turned)}
        return np.stack([degrees if over == PHI else x, of[id]])

    # over the displacement out and back, but a straight line only out: two dashed lines would hide the dashes
    once = np.array([0.0, 180.0] if id == "b" else [0.0, 180.0, 360.0]) if over == "x" else None
    samples, symbol = source.samples((over, id), values=values, breaks=once), source.words(id).symbol
    name = Words(f"{symbol}, L/R = ∞", f"{symbol}, L/R = inf")
    return panel._replace(curves=(*panel.curves, samples.curve(name, *samples.values)))


# which pictures there are


class PictureKind(NamedTuple):
    """A picture: its word and title, the command whose results it shows, and the function that yields its panels.

    The docstring of that function is the caption. It yields nothing if the machine lacks what the picture shows.
    across: panels next to each other; whole: whether all cylinders of the machine are in one picture, drawn from the
    case and those that are wanted.
    """

    id: str
    title: str
    command: str
    panels: Callable[[Source], Iterable[Panel]]
    across: int = 1
    whole: bool = False

    @property
    def text(self) -> str:
        """The caption."""
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
    PictureKind("mechanism", "Mechanism", "motion", mechanism, whole=True),
    PictureKind("construction", "Constructions of displacement and velocity", "motion", construction),
)
"""The pictures, the most informative picture of a machine first."""
_OF_PARTS = ("motion", "forces", "bearings")
"""Commands whose pictures are of each cylinder or bearing; those of others are of the whole machine."""


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
        each = filter(None, (pictures_if_any(case, kind, options) for kind in PICTURES))
        drawn = list(islice(each, None if names else 1))
        if not drawn and not names:
            raise UsageError(f"{name}: there is nothing to draw; kurbel check says what is missing")
        yield from chain.from_iterable(drawn)
        return

    def having() -> str:
        return ", ".join(kind.id for kind in pictures_of(case, options))

    for id in names:
        if id not in known:
            raise UsageError(f"no picture '{shown(id)}'{did_you_mean(id, tuple(known))} ({name} has {having()})")
    for id in names:
        if drawn_of := _drawn(case, known[id], options):
            yield from drawn_of
        elif options.cylinder in (None, *cylinders):
            raise UsageError(f"{name} has no picture '{id}': what it shows is left out; it has {having()}")
        else:
            there = ", ".join(cylinders)
            raise UsageError(f"--cylinder: there is no '{shown(options.cylinder or '')}'; there are {there}")


def pictures_if_any(case: Case, kind: PictureKind, options: PictureOptions) -> list[Picture]:
    """Return one picture of a machine, as often as it has it, or none; raises NoSolutionError as `pictures` does."""
    try:
        return _drawn(case, kind, options)
    except UsageError:
        return []


@np.errstate(all="ignore")
def pictures_of(case: Case, options: PictureOptions) -> list[PictureKind]:
    """Return the pictures that a machine has, those without a solution among them: drawing reports why."""

    def has(kind: PictureKind) -> bool:
        try:
            return any(True for source, _ in _sources(case, kind, options) for _ in kind.panels(source))
        except KurbelError as error:
            return isinstance(error, NoSolutionError)

    return [kind for kind in PICTURES if has(kind)]


@np.errstate(all="ignore")
def _drawn(case: Case, kind: PictureKind, options: PictureOptions) -> list[Picture]:
    found = []
    for source, name in _sources(case, kind, options):
        if panels := tuple(in_units(panel, options.system) for panel in kind.panels(source)):
            # three of which two are next to each other would leave a quadrant empty
            across = 3 if kind.across > 1 and len(panels) == 3 else min(kind.across, len(panels))
            found.append(Picture(kind.id, kind.title, kind.text, panels, case.machine.name, name, across))
    return found


def _sources(case: Case, kind: PictureKind, options: PictureOptions) -> Iterator[tuple[Source, str]]:
    """Yield (source of a picture, name of its cylinder or bearing); identical ones are drawn once."""
    command, bearings = kind.command, kind.command == "bearings"
    if command not in _OF_PARTS:
        having = [one.results for one in subjects_of(case, command) if one.results]
        results = case.torsion if command == "torsion" else having[-1]
        yield Source(results, options.angles), ""
        return
    if kind.whole:
        drawn = [one for one in case.cylinders if options.cylinder in (None, one.drive.name)]
        yield Source((case, drawn), options.angles), (len(case.cylinders) > 1 and options.cylinder) or ""
        return
    for one in case.cylinders if command == "forces" else ():
        if options.cylinder in (None, one.drive.name):
            one.refuse_locking()
    for equal in equal_parts(subjects_of(case, command), command):
        wanted = [one for one in equal if bearings or options.cylinder in (None, one.name)]
        if wanted:
            several = bearings or len(case.cylinders) > 1
            names = together([one.name for one in wanted]) if several else ""
            yield Source(wanted[0].source or wanted[0].results, options.angles), names
