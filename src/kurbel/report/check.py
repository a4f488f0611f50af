"""The report of `kurbel check`: what a machine has, what is left out, and how its limits and expectations stand."""

import math
from collections.abc import Callable, Hashable, Iterable, Sequence
from functools import cache
from typing import TYPE_CHECKING, NamedTuple

from kurbel.declared.forms import Physical
from kurbel.declared.unit_systems import show
from kurbel.errors import Fault, KurbelError, MachineFileError, Path, path_text
from kurbel.machine import Cylinder, Machine
from kurbel.mechanisms import Mechanism
from kurbel.report.alike import grouped, together
from kurbel.report.compared import Entry, Unjudged, judged
from kurbel.report.left_out import left_out, missing, stages, strength_left_out, turning_stages
from kurbel.report.notes import Note, Solved, machine_notes
from kurbel.report.provenance import provenance
from kurbel.report.tables import LeftOut, Provenance

if TYPE_CHECKING:
    from kurbel.solver.case import Case


_EVEN = 0.5
"""Degrees by which firing intervals differ where angles were rounded."""


class Section(NamedTuple):
    """A head line with its entries; cylinder: they are all of the one whose name it is."""

    title: str
    entries: tuple[Entry, ...]
    cylinder: bool = False

    @property
    def said(self) -> Hashable:
        """What equal cylinders have in common."""
        return self.cylinder or self.title, tuple((one.what, one.text, one.severity) for one in self.entries)


class Checked(NamedTuple):
    """The outcome of a check; `broken`: a limit is, or a figure is off; `unjudged`: which cannot be judged, and why."""

    title: str
    sections: tuple[Section, ...]
    broken: bool
    unjudged: tuple[Unjudged, ...]

    @property
    def errors(self) -> tuple[KurbelError, ...]:
        """What keeps limits and expectations from being judged."""
        return tuple(one.error for one in self.unjudged)

    @property
    def told_once(self) -> tuple[Section, ...]:
        """The sections, equal cylinders in one."""
        groups = grouped(self.sections, lambda one: one.said)
        return tuple(group[0]._replace(title=together([one.title for one in group])) for group in groups)


def checked(machine: Machine, solved: "Case | None" = None) -> Checked:
    """Return what is to be said of a machine; key values are computed only as far as it needs.

    solved: the machine with its results, where there are some.
    """

    @cache
    def case() -> "Case":
        from kurbel.solver.case import Case

        return solved or Case(machine)

    found = tuple(judged(machine, case))
    entries = [one for one in found if isinstance(one, Entry)]
    notes = machine_notes(machine, case)
    sections = (
        Section("Machine", tuple(_machine_entries(machine))),
        *(_cylinder_section(machine, cylinder, notes) for cylinder in machine.cylinders),
        Section("Cranks", tuple(_crank_entries(machine))),
        Section("Whole machine", (*_turning_entries(machine), *_notes(notes, None))),
        Section("Crankshaft", tuple(_crankshaft_entries(machine, case))),
        Section("Balance", tuple(_balance_entries(machine, case))),
        Section("Shaft line", tuple(_shaft_entries(machine, case))),
        Section("Limits", tuple(one for one in entries if one.path[0] == "limits")),
        Section("Expected", tuple(one for one in entries if one.path[0] == "expect")),
    )
    broken = any(one.severity == "error" for one in entries)
    unjudged = tuple(one for one in found if isinstance(one, Unjudged))
    return Checked(f"{machine.name}: a valid machine", tuple(s for s in sections if s.entries), broken, unjudged)


def _machine_entries(machine: Machine) -> Iterable[Entry]:
    none = "none, a given turning effort" if machine.effort else "none, a shaft line alone"
    yield Entry("cylinders", str(len(machine.cylinders)) if machine.cylinders else none)
    yield Entry("cycle", f"{machine.cycle}, {360 * machine.revolutions} deg")
    yield Entry("speed", "not given" if machine.speed is None else show(machine.speed, "speed"))
    yield from _firing_entries(machine)


def _firing_entries(machine: Machine) -> Iterable[Entry]:
    """Yield the firing angles and intervals of an engine, and a note where they are uneven."""
    from kurbel.machine.firing import firings, intervals

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


def _cylinder_section(machine: Machine, cylinder: Cylinder, found: Sequence[Note]) -> Section:
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
    return Section(cylinder.name, tuple(entries), cylinder=True)


def _crank_entries(machine: Machine) -> Iterable[Entry]:
    """Yield for each of several cylinders when it follows the first, and where that puts its crank pin."""
    banked = any(cylinder.bank_angle for cylinder in machine.cylinders)
    for cylinder in machine.cylinders[: len(machine.cylinders) if len(machine.cylinders) > 1 else 0]:
        # the dead centre of a crank stands at its bank
        behind = (cylinder.crank_position - cylinder.bank_angle) % 360.0
        pin = f", stroke line at {cylinder.bank_angle:g} deg: crank pin {behind:g} deg behind the first"
        yield Entry(cylinder.name, f"{cylinder.crank_position:g} deg after the first{pin if banked else ''}")


def _notes(found: Sequence[Note], cylinder: str | None, path: Path = ()) -> Iterable[Entry]:
    """Yield the notes on a cylinder, or on the whole machine."""
    return (Entry("note", text, "warning", path) for name, text in found if name == cylinder)


def _computed(stages: dict[str, str]) -> Entry:
    return Entry("computed", ", ".join(what for what, why in stages.items() if not why))


def _without(found: Iterable[LeftOut], path: Path = ()) -> Iterable[Entry]:
    return (Entry("left out", f"{what}: {why}", "info", path) for what, why in found)


def _turning_entries(machine: Machine) -> Iterable[Entry]:
    """Yield what kurbel flywheel has to say of a machine, where that is more than its only cylinder has."""
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


def _crankshaft_entries(machine: Machine, case: Solved) -> Iterable[Entry]:
    if machine.crankshaft is None:
        return
    from kurbel.report.bearings import bearing_warnings
    from kurbel.report.warnings import as_far_as_solved
    from kurbel.solver.shaft import shaft_obstacle

    yield from (
        Entry("bearings", text, "warning", ("crankshaft",))
        for text in as_far_as_solved(bearing_warnings(case()), "bearings")
    )
    if not shaft_obstacle(machine):
        yield Entry("computed", "loads on pins and main bearings")
    if obstacle := machine.strength_obstacle:
        yield Entry("left out", f"strength: {obstacle}", "info", ("crankshaft",))
        return
    yield Entry("computed", "forces on the bearings, stresses in pin and webs")
    yield from _without(strength_left_out(machine), ("crankshaft",))


def _balance_entries(machine: Machine, case: Solved) -> Iterable[Entry]:
    """Yield what kurbel balance has to say of a machine of which a place, a weight or a wheel is told."""
    placed = any(one.axial_position is not None or one.counterweights for one in machine.cylinders)
    if not (placed or machine.counterweights or machine.balance_shafts or machine.locomotive):
        return
    from kurbel.report.balance import subjects

    try:
        (whole,) = subjects(case())
        lacking = tuple(whole.left_out())
    except KurbelError as error:
        yield Entry("left out", str(error), "info")
        return
    yield Entry("computed", "free forces and moments, their orders, best counterweights")
    yield from _without(lacking)


def _shaft_entries(machine: Machine, case: Solved) -> Iterable[Entry]:
    """Yield what kurbel torsion has to say of a shaft line or a coupling, or why it refuses it."""
    if machine.shaft is None and machine.coupling is None:
        return
    from kurbel.report.torsion import torsion_left_out, torsion_warnings
    from kurbel.report.warnings import as_far_as_solved

    yield from (Entry("torsion", text, "warning") for text in as_far_as_solved(torsion_warnings(case()), "torsion"))
    if machine.shaft is None:
        return
    yield Entry("masses", str(len(machine.shaft.masses)))
    try:
        found = case().torsion
    except KurbelError as error:
        yield Entry("left out", f"torsional vibration: {error}", "info", ("shaft",))
        return
    forced = "" if found.obstacle else ", torques and stresses"
    yield Entry("computed", f"natural frequencies, critical speeds{forced}")
    yield from _without(torsion_left_out(found), ("shaft",))


def _described(mechanism: Mechanism) -> str:
    """Return the kind of a mechanism and its lengths."""
    lengths = [
        f"{name} {'infinite' if math.isinf(size) else show(size, key.form.kind)}"
        for name, key in mechanism.KEYS.items()
        if isinstance(key.form, Physical) and isinstance(size := getattr(mechanism, name, None), float) and size
    ]
    return f"{mechanism.name}: {', '.join(lengths)}"


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
    said = [
        (
            one.path,
            f"{f'{section.title}: ' if several and section.cylinder else ''}{one.what}: {one.text}",
            one.severity,
        )
        for section in checked.sections
        for one in section.entries
        if one.severity
    ]
    said += [(path, str(error).removeprefix(f"{path_text(path)}: "), "error") for path, error in checked.unjudged]
    origin, paths = machine.origin, {path for path, _, _ in said if path}
    placed = locate(origin.text, [Fault(path, "", at_key=True) for path in paths]) if origin and paths else []
    places = {fault.path: fault for fault in placed}
    file = origin.name if origin else machine.name
    found = tuple(_finding(file, path, places.get(path), text, severity) for path, text, severity in said)
    return Findings(machine.name, found, provenance(machine))


def _finding(file: str, path: Path, place: Fault | None, message: str, severity: str) -> Finding:
    line, column = (place.line, place.column) if place else (None, None)
    return Finding(file, line, column, path_text(path) or None, message, severity)
