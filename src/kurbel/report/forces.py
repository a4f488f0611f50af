"""The reports of `kurbel motion` and `kurbel forces`: every cylinder by itself.

What is only said to people, warnings and what is left out, is imported when it is read: a CSV table has none of it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from typing import TYPE_CHECKING

from kurbel.arrays import Array
from kurbel.errors import UsageError
from kurbel.solver.case import Case
from kurbel.solver.forces import CylinderForces
from kurbel.solver.gas import Pressure
from kurbel.solver.state import State
from kurbel.tables.frame import CommandReport, Frame, Subject
from kurbel.tables.shown import PlaceRow, Places
from kurbel.tables.tables import LeftOut

if TYPE_CHECKING:
    from kurbel.solver.total_work import TotalWork


def mechanism_notes(case: Case) -> Iterable[str]:
    """Return what a reader should know about the mechanisms, each sentence once."""
    notes = dict[str, None]()
    for cylinder in case.machine.cylinders:
        notes |= dict.fromkeys(cylinder.mechanism.notes)
    return notes


def _motion_left_out(case: Case, forces: CylinderForces) -> Iterator[LeftOut]:
    from kurbel.notes.left_out import motion_left_out

    yield from motion_left_out(case.machine, forces.drive.cylinder)


def _valve_warnings(forces: CylinderForces) -> Iterator[str]:
    from kurbel.notes.warnings import valve_warnings

    yield from valve_warnings(forces)


def _forces_left_out(case: Case, forces: CylinderForces) -> Iterator[LeftOut]:
    from kurbel.notes.left_out import forces_left_out

    yield from forces_left_out(case.machine, forces)


def _with_motion(case: Case) -> list[Subject]:
    return [
        Subject(
            forces.drive.name,
            forces,
            forces.at,
            left_out=_motion_left_out(case, forces),
            warnings=_valve_warnings(forces),
        )
        for forces in case.cylinders
    ]


def _motion_shown(
    case: Case, frame: Frame, shaft_angle: bool = False
) -> tuple[list[Subject], Iterable[str]]:
    """Return the motion of every cylinder, over its own crank angle or that of crank 1."""
    cylinders = _with_motion(case)
    if shaft_angle:
        cylinders = _over_shaft_angle(cylinders, frame)
    return cylinders, mechanism_notes(case)


def _over_shaft_angle(subjects: list[Subject], frame: Frame) -> list[Subject]:
    """Return the cylinders with rows over the angle of crank 1 instead of their own one, φ − δ, and no key values.

    Raises UsageError where rows or key values are requested that count by the own angle.
    """
    if frame.names or callable(frame.angles):
        raise UsageError(
            "--shaft-angle has a table over the angle of crank 1; leave out --key-values, --where and --over"
        )
    over_shaft_angle = []
    for subject in subjects:
        forces = subject.results
        if isinstance(forces, CylinderForces):
            subject = subject._replace(at=_at_shaft_angle(forces), columns_alone=True, tables=())
            over_shaft_angle.append(subject)
    return over_shaft_angle


def _at_shaft_angle(forces: CylinderForces) -> Callable[[Array], State]:
    """Return the state of a cylinder as a function of the angles (n,) of crank 1 in degrees."""
    return lambda degrees: forces.at(degrees - forces.drive.lag)


MOTION = CommandReport(
    "Motion of the crank train",
    _with_motion,
    mechanism_notes,
    lambda case: 360.0,
    subjects_and_notes=_motion_shown,
)


def _with_forces(case: Case) -> list[Subject]:
    cylinders = [
        Subject(
            forces.drive.name,
            forces,
            forces.at,
            left_out=_forces_left_out(case, forces),
            tables=_piston_table(forces),
            pistons=[Subject(piston.name, piston) for piston in forces.pistons],
            idle="" if forces.drive.has_force else "no force acts; kurbel motion prints its motion",
        )
        for forces in case.cylinders
    ]
    with_gas = [forces for forces in case.cylinders if forces.work is not None]
    pistons = sum(max(len(forces.pistons), 1) for forces in with_gas)
    if pistons < 2:
        return cylinders
    total = _total_work()(
        case.machine, case.cylinders, lambda: case.effort.result(case.effort.mean)
    )
    return [*cylinders, Subject("whole machine", total, whole=True)]


def _total_work() -> type[TotalWork]:
    from kurbel.solver.total_work import TotalWork

    return TotalWork


def _forces_shown(
    case: Case, frame: Frame, shaft_angle: bool = False
) -> tuple[list[Subject], Iterable[str]]:
    """Return the forces of every cylinder; without the table over the crank angle its measured cycles, one to a line.

    Raises UsageError without a cylinder, or without several cycles, NoSolutionError if its friction locks one.
    """
    cylinders = _with_forces(case)
    if frame.prose and cylinders:
        from kurbel.notes.warnings import by_cylinder

        warnings = by_cylinder(case)
        cylinders = [
            subject._replace(warnings=warnings.get(subject.name, ())) for subject in cylinders
        ]
    if shaft_angle:
        cylinders = _over_shaft_angle(cylinders, frame)
    if frame.table:
        for forces in case.cylinders:
            forces.refuse_locking()
        return cylinders, _forces_notes(case)
    have_cycles = [forces.indicated and forces.indicated.cycles for forces in case.cylinders]
    if cylinders and not any(have_cycles):
        raise UsageError("--each-cycle: no trace of this machine has several cycles; leave it out")
    with_cycles = [
        subject._replace(tables=_cycle_table(forces))
        for subject, forces in zip(cylinders, case.cylinders)
    ]
    return with_cycles, ()


def _piston_table(forces: CylinderForces) -> Iterator[Places]:
    """Yield work, power and mean pressure of each piston of a rod that has several."""
    if not forces.pistons:
        return
    declared = forces.pistons[0].lists.key_values("forces")
    rows: list[PlaceRow] = []
    for piston in forces.pistons:
        name = piston.name.removeprefix(f"{forces.drive.name}.")
        values = {id: figure.value for id, figure in piston.key_values().items()}
        rows.append(((name,), values))
    yield Places("pistons", "Each piston", ("piston",), declared, rows, headed=True)


def _cycle_table(forces: CylinderForces) -> Iterator[Places]:
    """Yield the measured cycles of a trace, one to a line."""
    cycles = forces.indicated and forces.indicated.cycles
    if not cycles:
        return
    from kurbel.solver.indicated import OF_CYCLES

    gas = forces.drive.own_gas
    is_absolute = bool(gas and gas.absolute)
    declared = {}
    for quantity in OF_CYCLES:
        declared[quantity.id] = quantity.absolute() if is_absolute else quantity
    rows: list[PlaceRow] = []
    for number, values in enumerate(zip(*(values.tolist() for values in cycles)), 1):
        rows.append(((str(number),), dict(zip(declared, values))))
    yield Places("cycles", "Measured cycles", ("cycle",), declared, rows, headed=True)


def _forces_notes(case: Case) -> Iterator[str]:
    from kurbel.notes.warnings import guide_notes, rod_ratio_notes

    yield from mechanism_notes(case)
    yield from guide_notes(case)
    yield from rod_ratio_notes(case)
    if any(forces.drive.pin_friction and forces.drive.has_force for forces in case.cylinders):
        yield (
            "T is M/R, less the friction of pins and journals, and W its mean; T_Z is the force at the crank pin, "
            "which the books call T."
        )
    if any(forces.drive.rod and forces.drive.has_force for forces in case.cylinders):
        yield (
            "S of an exact rod is the force between the masses at its ends and the force along it at neither pin: "
            "S_H is that at the crosshead pin, S_Z that at the crank pin; the rod must carry the largest of both."
        )
    compressors = [forces.drive.cylinder for forces in case.cylinders if not forces.no_compressor]
    if compressors:
        yield (
            "Rod load after API 618: P_G at the crosshead pin counts gas, inertia and weight of piston, piston rod, "
            "crosshead and other parts, P_KS at the piston rod the same without the crosshead; neither has the "
            "connecting rod's share or friction. d: in compression, z: in tension."
        )
    if any(cylinder.masses and cylinder.masses.undivided for cylinder in compressors):
        yield (
            "'reciprocating' is one sum, with the connecting rod's share: P_G counts all of it; give the parts to leave"
            " that share out."
        )
    ends = list[Pressure | None]()
    for forces in case.cylinders:
        for gas in forces.drive.gas:
            ends += [gas.head, gas.crank]
    if any(end and end.traced and end.trace.even for end in ends):
        yield (
            "ΔA/A of a trace is not a rounding error: the indicated work is by the trapezoid rule on the samples, "
            "the quadrature by straight lines between them; the difference shows the effect of the sample spacing."
        )


FORCES = CommandReport(
    "Forces in the crank train", _with_forces, _forces_notes, subjects_and_notes=_forces_shown
)
