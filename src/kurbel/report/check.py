"""The report of `kurbel check`: what a machine has, what is left out, and how its limits and expectations compare."""

import math
from collections.abc import Callable, Hashable, Iterable, Iterator, Sequence
from typing import NamedTuple

from kurbel.declared.unit_systems import show
from kurbel.errors import Fault, KurbelError, MachineFileError, Path, path_text
from kurbel.machine import Cylinder, Machine, firings
from kurbel.machine.several import intervals
from kurbel.mechanisms import Mechanism
from kurbel.report.alike import grouped, together
from kurbel.report.frame import provenance
from kurbel.report.left_out import balance_left_out, left_out, missing, stages, strength_left_out, turning_stages
from kurbel.report.limits import Entry, Unjudged, judged
from kurbel.report.tables import LeftOut, Provenance
from kurbel.report.turning import torsion_left_out, torsion_warnings
from kurbel.report.warnings import Note, as_far_as_solved, bearing_warnings, machine_notes
from kurbel.solver.case import Case
from kurbel.solver.shaft import shaft_obstacle

_EVEN = 0.5
"""Degrees by which firing intervals differ where angles were rounded."""


class Topic(NamedTuple):
    """A head line with its entries; cylinder: they are all about the cylinder of this name."""

    title: str
    entries: tuple[Entry, ...]
    cylinder: bool = False


class Checked(NamedTuple):
    """The outcome of a check; broken: a limit is, or a figure is off; unjudged: which cannot be compared, and why."""

    title: str
    sections: tuple[Topic, ...]
    broken: bool
    unjudged: tuple[Unjudged, ...]

    @property
    def errors(self) -> tuple[KurbelError, ...]:
        """What keeps limits and expectations from being compared."""
        return tuple(one.error for one in self.unjudged)

    @property
    def shown_once(self) -> list[Topic]:
        """The sections, equal cylinders in one."""
        groups = grouped(self.sections, _content)
        return [group[0]._replace(title=together([one.title for one in group])) for group in groups]


def _content(section: Topic) -> Hashable:
    """Return what the sections of equal cylinders have in common."""
    entries = tuple((one.what, one.text, one.severity) for one in section.entries)
    return section.cylinder or section.title, entries


def checked(case: Case, cases: Sequence[Case] = ()) -> Checked:
    """Return the check of a machine, and of its limits in its load cases, computed only as far as it needs."""
    machine = case.machine
    found, entries = [], []
    for one in (case, *cases):
        own = list(judged(one))
        of_case = f", {one.machine.origin.case}" if one is not case and one.machine.origin else ""
        found += own
        entries += [entry._replace(what=entry.what + of_case) for entry in own if isinstance(entry, Entry)]
    notes = machine_notes(case)
    sections = (
        Topic("Machine", tuple(_machine_entries(machine))),
        *(_cylinder_section(machine, cylinder, notes) for cylinder in machine.cylinders),
        Topic("Cranks", tuple(_crank_entries(machine))),
        Topic("Whole machine", (*_turning_entries(machine), *_notes(notes, None))),
        Topic("Crankshaft", tuple(_crankshaft_entries(case))),
        Topic("Balance", tuple(_balance_entries(case))),
        Topic("Shaft line", tuple(_shaft_entries(case))),
        Topic("Limits", tuple(one for one in entries if one.path[0] == "limits")),
        Topic("Expected", tuple(one for one in entries if one.path[0] == "expect")),
    )
    return Checked(
        f"{machine.name}: a valid machine",
        tuple(one for one in sections if one.entries),
        any(one.severity == "error" for one in entries),
        tuple(one for one in found if isinstance(one, Unjudged)),
    )


def _machine_entries(machine: Machine) -> Iterator[Entry]:
    none = "none, a given turning effort" if machine.effort else "none, a shaft line alone"
    yield Entry("cylinders", str(len(machine.cylinders)) if machine.cylinders else none)
    yield Entry("cycle", f"{machine.cycle}, {360 * machine.revolutions} deg")
    yield Entry("speed", "not given" if machine.speed is None else show(machine.speed, "speed"))
    found = firings(machine)
    if not found:
        return
    path: Path = ("cylinders",) if len(machine.cylinders) > 1 else ()
    angles = [angle for angle, _ in found]
    between = intervals(angles, 360.0 * machine.revolutions)
    least, most = min(between), max(between)
    uneven = most - least > _EVEN
    listed = _listed(between) if uneven else f"{most:g}"
    order = f"order {'-'.join(str(number) for _, number in found)}, " if path else ""
    yield Entry("firing", f"{order}at {_listed(angles)} deg, intervals {listed} deg", "info", path)
    if uneven:
        yield Entry("note", f"the firing intervals are uneven: {least:g} to {most:g} deg", "info", path)


def _listed(angles: Iterable[float]) -> str:
    return ", ".join(f"{angle:g}" for angle in angles)


def _cylinder_section(machine: Machine, cylinder: Cylinder, found: Sequence[Note]) -> Topic:
    several = len(machine.cylinders) > 1
    path: Path = ("cylinders", machine.cylinders.index(cylinder)) if several else ()
    entries = [
        Entry("mechanism", _described(cylinder.mechanism)),
        *(Entry(f"{piston.name}", f"bore {show(piston.bore, 'length')}") for piston in cylinder.pistons),
        _computed(stages(machine, cylinder)),
        *_without(left_out(machine, cylinder), path),
        *_notes(found, cylinder.name, path),
        *(Entry("note", note, "info", path) for note in cylinder.mechanism.notes),
    ]
    return Topic(cylinder.name, tuple(entries), cylinder=True)


def _described(mechanism: Mechanism) -> str:
    """Return the kind of a mechanism and its lengths."""
    lengths = [
        f"{name} {'infinite' if math.isinf(size) else show(size, key.form.kind)}"
        for name, key in mechanism.KEYS.items()
        if key.form.kind != "ratio" and isinstance(size := getattr(mechanism, name, None), float) and size
    ]
    return f"{mechanism.name}: {', '.join(lengths)}"


def _computed(stages: dict[str, str]) -> Entry:
    return Entry("computed", ", ".join(what for what, why in stages.items() if not why))


def _without(found: Iterable[LeftOut], path: Path = ()) -> Iterator[Entry]:
    return (Entry("left out", f"{what}: {why}", "info", path) for what, why in found)


def _notes(found: Sequence[Note], cylinder: str | None, path: Path = ()) -> Iterator[Entry]:
    """Yield the warnings on a cylinder, or on the whole machine."""
    return (Entry("note", text, "warning", path) for name, text in found if name == cylinder)


def _crank_entries(machine: Machine) -> Iterator[Entry]:
    """Yield for each of several cylinders by how much it follows the first, and where that puts its crank pin."""
    banked = any(cylinder.bank_angle for cylinder in machine.cylinders)
    for cylinder in machine.cylinders if len(machine.cylinders) > 1 else ():
        # the dead centre of a crank is at its bank
        behind = (cylinder.crank_position - cylinder.bank_angle) % 360.0
        pin = f", stroke line at {cylinder.bank_angle:g} deg: crank pin {behind:g} deg behind the first"
        yield Entry(cylinder.name, f"{cylinder.crank_position:g} deg after the first{pin if banked else ''}")


def _turning_entries(machine: Machine) -> Iterator[Entry]:
    """Yield what kurbel flywheel has of a machine, if that is more than its only cylinder has."""
    if not machine.cylinders and not machine.effort:
        return
    given = (machine.flywheel, machine.load, machine.effort, machine.coupling)
    if len(machine.cylinders) == 1 and machine.efficiency == 1 and not any(given):
        return
    stages = turning_stages(machine)
    yield _computed(stages)
    yield from _without(missing(stages))
    yield Entry("load", _load(machine))


def _load(machine: Machine) -> str:
    load = machine.load
    if load is None:
        return "constant"
    if load.diagram:
        return f"a diagram of {len(load.diagram.angles)} points"
    return f"slip {load.slip:g}" if load.slip is not None else f"torque as the speed to the power {load.power:g}"


def _crankshaft_entries(case: Case) -> Iterator[Entry]:
    machine, path = case.machine, ("crankshaft",)
    if machine.crankshaft is None:
        return
    for text in as_far_as_solved(bearing_warnings(case), "bearings"):
        yield Entry("bearings", text, "warning", path)
    if not shaft_obstacle(machine):
        yield Entry("computed", "loads on pins and main bearings")
    if machine.strength_obstacle:
        yield Entry("left out", f"strength: {machine.strength_obstacle}", "info", path)
        return
    yield Entry("computed", "forces on the bearings, stresses in pin and webs")
    yield from _without(strength_left_out(machine), path)


def _balance_entries(case: Case) -> Iterator[Entry]:
    """Yield what kurbel balance has of a machine with a place, a weight or a wheel."""
    machine = case.machine
    placed = any(one.axial_position is not None or one.counterweights for one in machine.cylinders)
    if not (placed or machine.counterweights or machine.balance_shafts or machine.locomotive):
        return
    try:
        lacking = balance_left_out(case)
    except KurbelError as error:
        yield Entry("left out", str(error), "info")
        return
    yield Entry("computed", "free forces and moments, their orders, best counterweights")
    yield from _without(lacking)


def _shaft_entries(case: Case) -> Iterator[Entry]:
    """Yield what kurbel torsion has of a shaft line or a coupling, or why it refuses it."""
    shaft, path = case.machine.shaft, ("shaft",)
    if shaft is None and case.machine.coupling is None:
        return
    for text in as_far_as_solved(torsion_warnings(case), "torsion"):
        yield Entry("torsion", text, "warning")
    if shaft is None:
        return
    yield Entry("masses", str(len(shaft.masses)))
    try:
        found = case.torsion
    except KurbelError as error:
        yield Entry("left out", f"torsional vibration: {error}", "info", path)
        return
    forced = "" if found.obstacle else ", torques and stresses"
    yield Entry("computed", f"natural frequencies, critical speeds{forced}")
    yield from _without(torsion_left_out(found), path)


# for programs: each finding with its place in the machine file


class Finding(NamedTuple):
    """One finding: file; line and column from 1 and the dotted key, None where it is about no key; severity.

    severity: `error`: a fault of the file, a limit that is broken, a figure that is off, or what cannot be judged;
    `warning`; `info`: what is kept, met or left out.
    """

    file: str
    line: int | None
    column: int | None
    key: str | None
    message: str
    severity: str


class Findings(NamedTuple):
    """The outcome of a check for programs; machine: its name, None where the file describes none."""

    machine: str | None
    findings: tuple[Finding, ...]
    provenance: Provenance | None = None


def faults_found(file: str, error: KurbelError) -> Findings:
    """Return what is wrong with a machine file that cannot be read."""
    if not isinstance(error, MachineFileError):
        return Findings(None, (Finding(file, None, None, None, str(error), "error"),))
    return Findings(
        None, tuple(_finding(error.file_name, fault.path, fault, fault.message, "error") for fault in error.faults)
    )


Locate = Callable[[str, "list[Fault]"], "list[Fault]"]


def findings(machine: Machine, checked: Checked, locate: Locate) -> Findings:
    """Return what was found of a machine; locate: returns faults with their places in the text of the file."""
    several = len(machine.cylinders) > 1
    found: list[tuple[Path, str, str]] = []
    for section in checked.sections:
        head = f"{section.title}: " if several and section.cylinder else ""
        found += [(one.path, f"{head}{one.what}: {one.text}", one.severity) for one in section.entries if one.severity]
    found += [(path, str(error).removeprefix(f"{path_text(path)}: "), "error") for path, error in checked.unjudged]
    origin, paths = machine.origin, {path for path, _, _ in found if path}
    placed = locate(origin.text, [Fault(path, "", at_key=True) for path in paths]) if origin and paths else []
    places = {fault.path: fault for fault in placed}
    file = origin.name if origin else machine.name
    listed = tuple(_finding(file, path, places.get(path), text, severity) for path, text, severity in found)
    return Findings(machine.name, listed, provenance(machine))


def _finding(file: str, path: Path, place: Fault | None, message: str, severity: str) -> Finding:
    line, column = (place.line, place.column) if place else (None, None)
    return Finding(file, line, column, path_text(path) or None, message, severity)
