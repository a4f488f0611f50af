"""The report of `kurbel check`: what a machine has, what is left out, and how its limits and expectations compare."""

import math
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import suppress
from typing import NamedTuple

from kurbel.checks.limits import CheckEntry, compared_entries
from kurbel.declared.unit_systems import show
from kurbel.errors import Fault, KurbelError, MachineFileError, Path, path_text
from kurbel.machine import Machine
from kurbel.machine.cylinder import pin_lag
from kurbel.machine.firing import firings
from kurbel.machine.several import intervals, rounded_within_cycle
from kurbel.notes.left_out import (
    balance_left_out,
    missing,
    stages,
    strength_left_out,
    turning_stages,
)
from kurbel.notes.warnings import Note, as_far_as_solved, bearing_warnings, machine_notes
from kurbel.solver.case import Case
from kurbel.solver.drive import any_of
from kurbel.solver.forces import CylinderForces
from kurbel.tables.tables import LeftOut, grouped, together

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
        groups = grouped(
            self.sections,
            lambda one: (one.cylinder or one.title, tuple(entry[:3] for entry in one.entries)),
        )
        return [group[0]._replace(title=together([one.title for one in group])) for group in groups]


def checked(case: Case, cases: Sequence[Case] = ()) -> Checked:
    """Return the check of a machine, and of its limits in its load cases; only what this needs is computed."""
    machine, notes, every = case.machine, machine_notes(case), compared_entries(case, cases)
    figures = [one for one in every if not one.error]
    of_whole = (CheckEntry("note", note.text, "warning") for note in notes if note.cylinder is None)
    topics: dict[str, Iterable[CheckEntry]] = {
        "Cranks": _crank_entries(machine),
        "Whole machine": (*_turning_entries(machine), *of_whole),
        "Crankshaft": _crankshaft_entries(case),
        "Oil film": _oil_film_entries(case),
        "Balance": _balance_entries(case),
        "Shaft line": _shaft_entries(case),
        "Delivery": _delivery_entries(case),
        "Limits": [figure for figure in figures if figure.path[0] == "limits"],
        "Expected": [figure for figure in figures if figure.path[0] == "expect"],
    }
    found = (
        Topic("Machine", tuple(_machine_entries(machine))),
        *(
            Topic(one.name, tuple(_cylinder_entries(machine, number, notes)), cylinder=True)
            for number, one in enumerate(machine.cylinders)
        ),
        *(Topic(title, tuple(entries)) for title, entries in topics.items()),
    )
    sections = tuple(one for one in found if one.entries)
    broken = any(figure.severity == "error" for figure in figures)
    return Checked(
        f"{machine.name}: a valid machine",
        sections,
        broken,
        tuple(one for one in every if one.error),
    )


def _machine_entries(machine: Machine) -> Iterator[CheckEntry]:
    none = "none, a given turning effort" if machine.effort else "none, a shaft line alone"
    yield CheckEntry("cylinders", str(len(machine.cylinders)) if machine.cylinders else none)
    yield CheckEntry("cycle", f"{machine.cycle}, {360 * machine.revolutions} deg")
    yield CheckEntry(
        "speed", "not given" if machine.speed is None else show(machine.speed, "speed")
    )
    if found := firings(machine):
        path: Path = ("cylinders",) if len(machine.cylinders) > 1 else ()
        angles = [angle for angle, _ in found]
        between = intervals(angles, 360.0 * machine.revolutions)
        least, most = min(between), max(between)
        uneven = most - least > _EVEN
        listed = ", ".join(f"{angle:g}" for angle in (between if uneven else [most]))
        at = ", ".join(f"{angle:g}" for angle in angles) + " deg"
        if len(found) == 1 and angles[0]:
            # with an offset, the inner dead centre is a little before or after φ = 0
            at = f"{math.remainder(angles[0], most):g} deg, the inner dead centre"
        order = f"order {'-'.join(str(number) for _, number in found)}, " if path else ""
        text = f"{order}at {at}, intervals {listed} deg"
        yield CheckEntry("firing", text, "info", path)
        if uneven:
            yield CheckEntry(
                "note", f"the firing intervals are uneven: {least:g} to {most:g} deg", "info", path
            )


def _cylinder_entries(machine: Machine, number: int, notes: Sequence[Note]) -> Iterator[CheckEntry]:
    cylinder = machine.cylinders[number]
    mechanism, path = (
        cylinder.mechanism,
        ("cylinders", number) if len(machine.cylinders) > 1 else (),
    )
    given = {
        "stroke": mechanism.stroke,
        **vars(mechanism),
    }  # the stroke may be given instead of the crank
    lengths = [
        f"{name} {'infinite' if math.isinf(size) else show(size, key.form.kind)}"
        for name, key in mechanism.KEYS.items()
        if key.form.kind != "ratio" and isinstance(size := given.get(name), float) and size
    ]
    yield CheckEntry("mechanism", f"{mechanism.name}: {', '.join(lengths)}")
    for piston in cylinder.pistons:
        yield CheckEntry(piston.name, f"bore {show(piston.bore, 'length')}")
    yield from _stages(stages(machine, cylinder), path)
    yield from (
        CheckEntry("note", note.text, "warning", path)
        for note in notes
        if note.cylinder == cylinder.name
    )
    yield from (CheckEntry("note", text, "info", path) for text in mechanism.notes)


def _stages(stages: dict[str, str], path: Path = ()) -> Iterator[CheckEntry]:
    """Yield what is computed, and what is left out and why."""
    yield from _computed(
        ", ".join(what for what, why in stages.items() if not why), missing(stages), path
    )


def _computed(what: str, left_out: Iterable[LeftOut], path: Path = ()) -> Iterator[CheckEntry]:
    yield CheckEntry("computed", what)
    yield from (_left_out(f"{what}: {why}", path) for what, why in left_out)


def _left_out(text: str, path: Path = ()) -> CheckEntry:
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
        behind = rounded_within_cycle(pin_difference, 360.0)
        text += f"crank pin {behind:g} deg behind the first"
        yield CheckEntry(cylinder.name, text)


def _turning_entries(machine: Machine) -> Iterator[CheckEntry]:
    """Yield what `kurbel flywheel` computes of a machine, unless it is a single cylinder with nothing on the shaft."""
    given, load = (machine.flywheel, machine.load, machine.effort, machine.coupling), machine.load
    alone = len(machine.cylinders) == 1 and machine.efficiency == 1 and not any(given)
    if alone or not (machine.cylinders or machine.effort):
        return
    yield from _stages(turning_stages(machine))
    if load is None:
        text = "constant"
    elif load.diagram:
        text = load.diagram.size
    else:
        text = (
            f"slip {load.slip:g}"
            if load.slip is not None
            else f"torque as the speed to the power {load.power:g}"
        )
    yield CheckEntry("load", text)


def _crankshaft_entries(case: Case) -> Iterator[CheckEntry]:
    machine, path = case.machine, ("crankshaft",)
    if machine.crankshaft is None:
        return
    for text in as_far_as_solved(bearing_warnings(case), "bearings"):
        yield CheckEntry("bearings", text, "warning", path)
    from kurbel.solver.shaft import shaft_obstacle, strength_obstacle

    if not shaft_obstacle(machine):
        yield CheckEntry("computed", "loads on pins and main bearings")
    if strength_obstacle(machine):
        yield _left_out(f"strength: {strength_obstacle(machine)}", path)
    else:
        yield from _computed(
            "forces on the bearings, stresses in pin and webs", strength_left_out(machine), path
        )


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
    having = [bearing.name for bearing in bearings if bearing.oil and not bearing.film_obstacle]
    if having:
        yield CheckEntry("computed", f"oil film of {together(having)}")
    for bearing in bearings:
        if bearing.film_obstacle:
            yield _left_out(f"oil film of {bearing.name}: {bearing.film_obstacle}", path)


def _balance_entries(case: Case) -> Iterator[CheckEntry]:
    """Yield what `kurbel balance` computes of a machine with axial positions, counterweights or driven wheels."""
    machine = case.machine
    placed = any(
        cylinder.axial_position is not None or cylinder.counterweights
        for cylinder in machine.cylinders
    )
    if not (placed or machine.counterweights or machine.balance_shafts or machine.locomotive):
        return
    try:
        lacking = [*balance_left_out(case)]
    except KurbelError as error:
        yield _left_out(str(error))
    else:
        yield from _computed(
            "unbalanced forces and moments, their orders, best counterweights", lacking
        )


def _shaft_entries(case: Case) -> Iterator[CheckEntry]:
    """Yield what `kurbel torsion` computes of a shaft line or a coupling, or why it cannot."""
    shaft, path = case.machine.shaft, ("shaft",)
    if shaft is None and case.machine.coupling is None:
        return
    from kurbel.report.torsion import torsion_left_out, torsion_warnings

    for text in as_far_as_solved(torsion_warnings(case), "torsion"):
        yield CheckEntry("torsion", text, "warning")
    if shaft is None:
        return
    yield CheckEntry("masses", str(len(shaft.masses)))
    try:
        found = case.torsion
    except KurbelError as error:
        yield _left_out(f"torsional vibration: {error}", path)
    else:
        forced = "" if found.obstacle else ", torques and stresses"
        yield from _computed(
            f"natural frequencies, critical speeds{forced}", torsion_left_out(found), path
        )


def _with_compressor(forces: CylinderForces) -> bool:
    chambers = (chamber for gas in forces.drive.gas for chamber in gas.piston.chambers.values())
    return any(chamber.compresses for chamber in chambers)


def _delivery_entries(case: Case) -> Iterator[CheckEntry]:
    """Yield what `kurbel delivery` computes of a machine with pumps or compressors, or why it cannot."""
    if not any(
        any_of(forces.drive.pumping) or _with_compressor(forces) for forces in case.cylinders
    ):
        return
    with suppress(KurbelError):  # nothing is delivered
        from kurbel.report.delivery import delivery_left_out, delivery_warnings

        found = case.delivery
        try:
            yield from [
                CheckEntry("delivery", text, "warning") for text in delivery_warnings(found)
            ]
        except KurbelError as error:
            yield _left_out(str(error), ("pump",))
            return
        pump = (
            ["flow"] * (case.machine.speed is not None) + ["fluctuating volume"]
            if found.pump
            else []
        )
        stages = ["stages and ends of compressors"] if found.stages else []
        yield from _computed(", ".join([*pump, *stages]), delivery_left_out(found))


# for programs: each finding with its place in the machine file


class Finding(NamedTuple):
    """One finding: file; line and column from 1 and the dotted key, None if it is about no key; severity.

    severity: `error` for a fault of the file, for a limit or an expectation that FAILs or cannot be judged; `warning`;
    `info` for one that is a PASS, and for what is left out.
    """

    file: str
    line: int | None
    column: int | None
    key: str | None
    message: str
    severity: str


def faults_found(file: str, error: KurbelError) -> list[Finding]:
    """Return what is wrong with a machine file that cannot be read."""
    if not isinstance(error, MachineFileError):
        return [Finding(file, None, None, None, str(error), "error")]
    return [
        Finding(
            error.file_name,
            fault.line,
            fault.column,
            path_text(fault.path) or None,
            fault.message,
            "error",
        )
        for fault in error.faults
    ]


Locate = Callable[[str, "list[Fault]"], "list[Fault]"]


def findings(machine: Machine, checked: Checked, locate: Locate) -> list[Finding]:
    """Return the outcome of a check for programs; locate: adds to faults their places in the text of the file."""
    several, origin = len(machine.cylinders) > 1, machine.origin
    found: list[tuple[Path, str, str]] = []
    for section in checked.sections:
        head = f"{section.title}: " if several and section.cylinder else ""
        found += [
            (entry.path, f"{head}{entry.what}: {entry.text}", entry.severity)
            for entry in section.entries
            if entry.severity
        ]
    found += [
        (one.path, str(one.error).removeprefix(f"{path_text(one.path)}: "), "error")
        for one in checked.unjudged
    ]

    at_keys = [Fault(path, "", at_key=True) for path in {path for path, _, _ in found if path}]
    located = locate(origin.text, at_keys) if origin and at_keys else ()
    places = {fault.path: fault for fault in located}
    unknown, file = Fault((), ""), origin.name if origin else machine.name
    return [
        Finding(file, at.line or None, at.column or None, path_text(path) or None, text, severity)
        for path, text, severity in found
        for at in [places.get(path, unknown)]
    ]
