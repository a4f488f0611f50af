"""The report of `kurbel check`: what a machine has, what is left out, and how its limits and expectations compare."""

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import suppress
from typing import NamedTuple

from kurbel.checks.limits import (
    CheckEntry,
    JudgedFigure,
    compared_entries,
    load_cases_of,
    margin_text,
    margins,
)
from kurbel.declared.unit_systems import show
from kurbel.errors import Fault, KurbelError, MachineFileError, Path, path_text
from kurbel.machine import Machine
from kurbel.machine.cylinder import pin_lag
from kurbel.machine.firing import firings
from kurbel.machine.indicator import Chamber
from kurbel.machine.several import intervals, rounded_within_cycle
from kurbel.notes.left_out import (
    balance_left_out,
    missing,
    stages,
    strength_left_out,
    turning_stages,
)
from kurbel.notes.machine_results import bearing_warnings
from kurbel.notes.warnings import Note, as_far_as_solved, machine_notes
from kurbel.solver.case import Case
from kurbel.solver.drive import any_of
from kurbel.solver.forces import CylinderForces
from kurbel.tables.tables import LeftOut, grouped, joined_names

_EVEN = 0.5
"""Difference of firing intervals in degrees that rounded angles explain."""


class Topic(NamedTuple):
    """A title with its entries; cylinder: it is the name of the cylinder that all of them are about."""

    title: str
    entries: tuple[CheckEntry, ...]
    cylinder: bool = False


class Checked(NamedTuple):
    """The outcome of a check; broken: a limit or an expectation FAILs; unjudged: those that cannot be compared."""

    title: str
    sections: tuple[Topic, ...]
    broken: bool
    unjudged: tuple[CheckEntry, ...]

    @property
    def shown_once(self) -> list[Topic]:
        """The sections, with one for identical cylinders."""
        # a cylinder is identical to another whatever its title
        groups = grouped(
            self.sections,
            lambda topic: (
                topic.cylinder or topic.title,
                tuple(entry[:3] for entry in topic.entries),
            ),
        )
        merged = []
        for group in groups:
            title = joined_names([topic.title for topic in group])
            merged.append(group[0]._replace(title=title))
        return merged


def checked(case: Case, cases: Sequence[Case] = ()) -> Checked:
    """Return the check of a machine, and of its limits in its load cases; only what this needs is computed."""
    machine = case.machine
    notes = machine_notes(case)
    # limits and expectations
    figures = compared_entries(case, cases)
    judged = [figure for figure in figures if figure.error is None]
    unjudged = [figure for figure in figures if figure.error is not None]
    # the sections: of each cylinder, and of the machine
    topics = [Topic("Machine", tuple(_machine_entries(machine)))]
    for number, cylinder in enumerate(machine.cylinders):
        entries = (*_cylinder_entries(machine, number, notes), *_valve_entries(case, number))
        topics.append(Topic(cylinder.name, entries, cylinder=True))
    notes_of_machine = [note.text for note in notes if note.cylinder is None]
    warnings = [CheckEntry("note", text, "warning") for text in notes_of_machine]
    topics += [
        Topic("Cranks", tuple(_crank_entries(machine))),
        Topic("Whole machine", (*_turning_entries(machine), *warnings)),
        Topic("Crankshaft", tuple(_crankshaft_entries(case))),
        Topic("Oil film", tuple(_oil_film_entries(case))),
        Topic("Balance", tuple(_balance_entries(case))),
        Topic("Shaft line", tuple(_shaft_entries(case))),
        Topic("Delivery", tuple(_delivery_entries(case))),
        Topic("Limits", tuple(figure for figure in judged if figure.path[0] == "limits")),
        Topic("Margins to the limits", tuple(_margin_entries(judged, machine.name))),
        Topic("Expected", tuple(figure for figure in judged if figure.path[0] == "expect")),
    ]
    sections = tuple(topic for topic in topics if topic.entries)
    is_broken = any(figure.severity == "error" for figure in judged)
    return Checked(f"{machine.name}: a valid machine", sections, is_broken, tuple(unjudged))


def _machine_entries(machine: Machine) -> Iterator[CheckEntry]:
    """Yield what kind of machine it is: cylinders, cycle, speed, and when its cylinders fire."""
    cylinders = str(len(machine.cylinders))
    if not machine.cylinders:
        cylinders = "none, a shaft line alone"
        if machine.effort:
            cylinders = "none, a given turning effort"
    yield CheckEntry("cylinders", cylinders)
    yield CheckEntry("cycle", f"{machine.cycle}, {360 * machine.revolutions} deg")
    speed = "not given" if machine.speed is None else show(machine.speed, "speed")
    yield CheckEntry("speed", speed)
    fired = firings(machine)
    if fired:
        yield from _firing_entries(machine, fired)


def _firing_entries(machine: Machine, fired: Sequence[tuple[float, int]]) -> Iterator[CheckEntry]:
    """Yield order, angles and intervals of the firings; fired: (angle, number of the cylinder), in order."""
    path: Path = ("cylinders",) if len(machine.cylinders) > 1 else ()
    angles = [angle for angle, _ in fired]
    differences = intervals(angles, 360.0 * machine.revolutions)
    least = min(differences)
    most = max(differences)
    is_uneven = most - least > _EVEN
    # where they fire; with an offset, the inner dead centre is a little before or after φ = 0
    position = f"{_listed(angles)} deg"
    if len(fired) == 1 and angles[0]:
        position = f"{math.remainder(angles[0], most):g} deg, the inner dead centre"
    order = ""
    if path:
        numbers = "-".join(str(number) for _, number in fired)
        order = f"order {numbers}, "
    listed_intervals = _listed(differences if is_uneven else [most])
    text = f"{order}at {position}, intervals {listed_intervals} deg"
    yield CheckEntry("firing", text, "info", path)
    if is_uneven:
        text = f"the firing intervals are uneven: {least:g} to {most:g} deg"
        yield CheckEntry("note", text, "info", path)


def _listed(angles: Iterable[float]) -> str:
    """Return angles separated by commas."""
    return ", ".join(f"{angle:g}" for angle in angles)


def _cylinder_entries(machine: Machine, number: int, notes: Sequence[Note]) -> Iterator[CheckEntry]:
    """Yield the dimensions of a cylinder, what is computed of it, what is left out, and its notes."""
    cylinder = machine.cylinders[number]
    mechanism = cylinder.mechanism
    path: Path = ("cylinders", number) if len(machine.cylinders) > 1 else ()
    # dimensions; the stroke may be given instead of the crank
    sizes = {"stroke": mechanism.stroke, **vars(mechanism)}
    lengths = []
    for name, key in mechanism.KEYS.items():
        size = sizes.get(name)
        is_length = isinstance(size, float) and key.form.kind != "ratio"
        if is_length and size:
            text = "infinite" if math.isinf(size) else show(size, key.form.kind)
            lengths.append(f"{name} {text}")
    yield CheckEntry("mechanism", f"{mechanism.name}: {', '.join(lengths)}")
    for piston in cylinder.pistons:
        yield CheckEntry(piston.name, f"bore {show(piston.bore, 'length')}")
    # chapters and notes
    yield from _stages(stages(machine, cylinder), path)
    for note in notes:
        if note.cylinder == cylinder.name:
            yield CheckEntry("note", note.text, "warning", path)
    for text in mechanism.notes:
        yield CheckEntry("note", text, "info", path)


def _valve_entries(case: Case, number: int) -> Iterator[CheckEntry]:
    """Yield the events of the slide valve of a cylinder, for each end with fractions of the stroke and crank angles."""
    gear = case.cylinders[number].valve_gear
    if gear is None:
        return
    for end, events in gear.events_of_ends():
        texts = []
        for name, (fraction, degrees) in events.items():
            percent = f"{100 * fraction:.1f}".rstrip("0").rstrip(".")
            position = f"at {percent} %"
            if name in ("admission", "compression"):  # on the stroke back
                position = f"{percent} % before the dead centre"
            texts.append(f"{name} {position} ({degrees:.1f} deg)")
        yield CheckEntry("valve", f"{end}: {', '.join(texts)}")


def _stages(stages: dict[str, str], path: Path = ()) -> Iterator[CheckEntry]:
    """Yield what is computed, and what is left out and why."""
    computed = [name for name, reason in stages.items() if not reason]
    yield from _computed(", ".join(computed), missing(stages), path)


def _computed(what: str, left_out: Iterable[LeftOut], path: Path = ()) -> Iterator[CheckEntry]:
    """Yield what is computed, and each thing that is left out with its reason."""
    yield CheckEntry("computed", what)
    for name, reason in left_out:
        yield _left_out(f"{name}: {reason}", path)


def _left_out(text: str, path: Path = ()) -> CheckEntry:
    """Return the entry of what is left out."""
    return CheckEntry("left out", text, "info", path)


def _crank_entries(machine: Machine) -> Iterator[CheckEntry]:
    """Yield for each of several cylinders by which angle it follows the first, and where its crank pin is."""
    if len(machine.cylinders) < 2:
        return
    first = machine.cylinders[0]
    is_banked = any(cylinder.bank_angle for cylinder in machine.cylinders)
    for cylinder in machine.cylinders:
        text = f"{cylinder.crank_position:g} deg after the first, "
        if is_banked:
            text += f"stroke line at {cylinder.bank_angle:g} deg: "
        pin_difference = pin_lag(cylinder, first) - pin_lag(first, first)
        lag = rounded_within_cycle(pin_difference, 360.0)
        text += f"crank pin {lag:g} deg behind the first"
        if cylinder.link_rod is not None:
            text += f", on the master rod of {cylinder.link_rod.master}"
        yield CheckEntry(cylinder.name, text)
    yield from _radial_entries(machine)


def _radial_entries(machine: Machine) -> Iterator[CheckEntry]:
    """Yield the note that built radials have link rods, where three or more rods are on one crank pin itself."""
    from kurbel.solver.shaft import throws_of

    for throw in throws_of(machine.cylinders):
        rods = len(throw.cylinders)
        has_links = any(machine.cylinders[index].link_rod for index in throw.cylinders)
        mechanisms = [machine.cylinders[index].mechanism for index in throw.cylinders]
        if rods < 3 or has_links or not all(mechanism.has_rod for mechanism in mechanisms):
            continue
        text = (
            f"{rods} rods are put on the crank pin itself; built radials have one master rod, and link rods on "
            "knuckle pins shift dead centres by 2 to 6 deg (outer ones 3 to 20) and raise the largest acceleration "
            "by 5 to 40 %: give 'link_rod'"
        )
        yield CheckEntry("note", text, "info", ("cylinders",))
        return


def _turning_entries(machine: Machine) -> Iterator[CheckEntry]:
    """Yield what `kurbel flywheel` computes of a machine, unless it is a single cylinder with nothing on the shaft."""
    load = machine.load
    on_shaft = (machine.flywheel, load, machine.effort, machine.coupling)
    is_bare = machine.efficiency == 1 and not any(on_shaft)
    if is_bare and len(machine.cylinders) == 1:
        return
    if not (machine.cylinders or machine.effort):
        return
    yield from _stages(turning_stages(machine))
    if load is None:
        text = "constant"
    elif load.diagram:
        text = load.diagram.size
    elif load.slip is not None:
        text = f"slip {load.slip:g}"
    else:
        text = f"torque as the speed to the power {load.power:g}"
    yield CheckEntry("load", text)


def _crankshaft_entries(case: Case) -> Iterator[CheckEntry]:
    """Yield what `kurbel bearings` and `kurbel stress` compute of a crankshaft, or why they cannot."""
    machine = case.machine
    if machine.crankshaft is None:
        return
    path = ("crankshaft",)
    for text in as_far_as_solved(bearing_warnings(case), "bearings"):
        yield CheckEntry("bearings", text, "warning", path)
    from kurbel.solver.shaft import shaft_obstacle, strength_obstacle

    if not shaft_obstacle(machine):
        yield CheckEntry("computed", "loads on pins and main bearings")
    obstacle = strength_obstacle(machine)
    if obstacle:
        yield _left_out(f"strength: {obstacle}", path)
        return
    computed = "forces on the bearings, stresses in pin and webs"
    yield from _computed(computed, strength_left_out(machine), path)


def _oil_film_entries(case: Case) -> Iterator[CheckEntry]:
    """Yield the warnings on oil films, and what is computed of them."""
    if case.machine.oil_film is None:
        return
    from kurbel.notes.oil_film import film_warnings

    path = ("oil_film",)
    try:
        bearings = case.bearings.parts
    except KurbelError as error:
        yield _left_out(f"oil film: {error}", path)
        return
    for text in as_far_as_solved(film_warnings(case), "bearings"):
        yield CheckEntry("oil film", text, "warning", path)
    with_film = [bearing.name for bearing in bearings if bearing.oil and not bearing.film_obstacle]
    if with_film:
        yield CheckEntry("computed", f"oil film of {joined_names(with_film)}")
    for bearing in bearings:
        if bearing.film_obstacle:
            yield _left_out(f"oil film of {bearing.name}: {bearing.film_obstacle}", path)


def _balance_entries(case: Case) -> Iterator[CheckEntry]:
    """Yield what `kurbel balance` computes of a machine with axial positions, counterweights or driven wheels."""
    machine = case.machine
    is_balanced = bool(machine.counterweights or machine.balance_shafts or machine.locomotive)
    for cylinder in machine.cylinders:
        if cylinder.axial_position is not None or cylinder.counterweights:
            is_balanced = True
    if not is_balanced:
        return
    try:
        left_out = [*balance_left_out(case)]
    except KurbelError as error:
        yield _left_out(str(error))
        return
    computed = "unbalanced forces and moments, their orders, best counterweights"
    yield from _computed(computed, left_out)


def _shaft_entries(case: Case) -> Iterator[CheckEntry]:
    """Yield what `kurbel torsion` computes of a shaft line or a coupling, or why it cannot."""
    shaft = case.machine.shaft
    if shaft is None and case.machine.coupling is None:
        return
    from kurbel.report.torsion import torsion_left_out, torsion_warnings

    for text in as_far_as_solved(torsion_warnings(case), "torsion"):
        yield CheckEntry("torsion", text, "warning")
    if shaft is None:
        return
    yield CheckEntry("masses", str(len(shaft.masses)))
    path = ("shaft",)
    try:
        torsion = case.torsion
    except KurbelError as error:
        yield _left_out(f"torsional vibration: {error}", path)
        return
    computed = "natural frequencies, critical speeds"
    if not torsion.obstacle:
        computed += ", torques and stresses"
    yield from _computed(computed, torsion_left_out(torsion), path)


def _delivers(forces: CylinderForces) -> bool:
    """Return whether a cylinder has a pump or a compressor."""
    chambers: list[Chamber] = []
    for gas in forces.drive.gas:
        chambers += gas.piston.chambers.values()
    has_compressor = any(chamber.compresses for chamber in chambers)
    return has_compressor or bool(any_of(forces.drive.pumping))


def _delivery_entries(case: Case) -> Iterator[CheckEntry]:
    """Yield what `kurbel delivery` computes of a machine with pumps or compressors, or why it cannot."""
    if not any(map(_delivers, case.cylinders)):
        return
    from kurbel.report.delivery import delivery_left_out, delivery_warnings

    try:
        delivery = case.delivery
    except KurbelError:  # nothing is delivered
        return
    try:
        warnings = [*delivery_warnings(delivery)]
    except KurbelError as error:
        yield _left_out(str(error), ("pump",))
        return
    for text in warnings:
        yield CheckEntry("delivery", text, "warning")
    computed = []
    if delivery.pump and case.machine.speed is not None:
        computed.append("flow")
    if delivery.pump:
        computed.append("fluctuating volume")
    if delivery.stages:
        computed.append("stages and ends of compressors")
    with suppress(KurbelError):
        yield from _computed(", ".join(computed), delivery_left_out(delivery))


def _margin_entries(judged: Iterable[CheckEntry], name: str) -> Iterator[CheckEntry]:
    """Yield a line of heads and one for each limit: its smallest margin in the machine itself and in each load case."""
    table = margins(judged)
    cases = load_cases_of(table)
    if not cases:
        return
    heads = [case or name for case in cases]
    yield CheckEntry("", "  ".join(f"{head:>8}" for head in heads))
    for limit, of_limit in table.items():
        cells = []
        for case, head in zip(cases, heads):
            cells.append(f"{margin_text(of_limit.get(case)):>{max(len(head), 8)}}")
        yield CheckEntry(limit, "  ".join(cells))


# for programs: each finding with its place in the machine file


class Finding(NamedTuple):
    """One finding: file; line and column from 1 and the dotted key, None if it is about no key; severity.

    severity: `error` for a fault of the file, for a limit or an expectation that FAILs or cannot be judged; `warning`;
    `info` for one that is a PASS, and for what is left out. Of a limit or an expectation the rest is its `JudgedFigure`.
    """

    file: str
    line: int | None
    column: int | None
    key: str | None
    message: str
    severity: str
    id: str | None = None
    scope: str | None = None
    value: float | None = None
    bound: float | tuple[float, float] | None = None
    unit: str | None = None
    margin: float | None = None
    verdict: str | None = None
    case: str | None = None


def faults_found(file: str, error: KurbelError) -> list[Finding]:
    """Return what is wrong with a machine file that cannot be read."""
    if not isinstance(error, MachineFileError):
        return [Finding(file, None, None, None, str(error), "error")]
    findings = []
    for fault in error.faults:
        key = path_text(fault.path) or None
        findings.append(
            Finding(error.file_name, fault.line, fault.column, key, fault.message, "error")
        )
    return findings


Locate = Callable[[str, "list[Fault]"], "list[Fault]"]


def findings(machine: Machine, checked: Checked, locate: Locate) -> list[Finding]:
    """Return the outcome of a check for programs; locate: adds to faults their places in the text of the file."""
    # paths, messages and severities
    messages: list[tuple[Path, str, str, JudgedFigure | None]] = []
    for section in checked.sections:
        is_of_several = section.cylinder and len(machine.cylinders) > 1
        prefix = f"{section.title}: " if is_of_several else ""
        for entry in section.entries:
            if entry.severity:
                text = f"{prefix}{entry.what}: {entry.text}"
                messages.append((entry.path, text, entry.severity, entry.figure))
    for entry in checked.unjudged:
        text = str(entry.error).removeprefix(f"{path_text(entry.path)}: ")
        messages.append((entry.path, text, "error", None))

    # where the keys are
    paths = {path for path, *_ in messages if path}
    origin = machine.origin
    positions: dict[Path, Fault] = {}
    if origin and paths:
        at_keys = [Fault(path, "", at_key=True) for path in paths]
        positions = {fault.path: fault for fault in locate(origin.text, at_keys)}

    file = origin.name if origin else machine.name
    findings = []
    for path, text, severity, figure in messages:
        position = positions.get(path, Fault((), ""))
        line = position.line or None
        column = position.column or None
        finding = Finding(file, line, column, path_text(path) or None, text, severity)
        if figure:
            finding = finding._replace(**figure._asdict())
        findings.append(finding)
    return findings
