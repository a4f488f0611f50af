"""What looks wrong in what was given: one list for a whole machine, from which every command takes what concerns it."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, NamedTuple

from kurbel.machine import Cylinder, Machine
from kurbel.report.sizes import size_notes, speed_notes

if TYPE_CHECKING:
    from kurbel.solver.case import Case


class Note(NamedTuple):
    """A sentence, and the name of the cylinder that it is about; None for the whole machine."""

    cylinder: str | None
    text: str


def machine_notes(machine: Machine, case: Case | None = None) -> tuple[Note, ...]:
    """Return the notes on a machine, each once: on cards that the reader tidied up, on traces, on the brake power.

    case: the machine with its results; without measurements nothing is computed.
    """
    chambers = [(cylinder, *one) for cylinder in machine.cylinders for one in _chambers(cylinder)]
    found = [
        Note(cylinder.name, f"{where}: {text}")
        for cylinder, where, chamber in chambers
        for text in getattr(chamber, "notes", ())
    ]
    found += _on_card_ends(machine) if chambers else ()
    found += [Note(None, f"effort: {text}") for text in getattr(machine.effort, "notes", ())]
    found += [Note(None, text) for text in speed_notes(machine)]
    found += [Note(cylinder.name, text) for cylinder in machine.cylinders for text in size_notes(cylinder)]
    if machine.brake_power is not None or any(hasattr(chamber, "angle_zero") for _, _, chamber in chambers):
        found += _on_measurements(machine, case)
    return tuple(dict.fromkeys(found))


def _chambers(cylinder: Cylinder) -> Iterable[tuple[str, Any]]:
    for piston in cylinder.pistons:
        if piston.indicator:
            yield f"{piston.name}, head end", piston.indicator.head_end
            yield f"{piston.name}, crank end", piston.indicator.crank_end


def _on_card_ends(machine: Machine) -> Iterable[Note]:
    from kurbel.report.card_ends import card_end_notes

    for cylinder in machine.cylinders:
        for piston in cylinder.pistons:
            yield from (Note(cylinder.name, text) for text in card_end_notes(piston))


def _on_measurements(machine: Machine, case: Case | None) -> Iterable[Note]:
    from kurbel.report.plausibility import brake_warnings, trace_warnings
    from kurbel.solver.case import Case

    cylinders = (case or Case(machine)).cylinders
    for forces in cylinders:
        yield from (Note(forces.drive.name, text) for text in trace_warnings(forces))
    yield from (Note(None, text) for text in brake_warnings(machine, cylinders))


def of_cylinder(found: Iterable[Note], machine: Machine, cylinder: Cylinder) -> Iterable[str]:
    """Yield the notes on a cylinder; below the last one also those on the whole machine."""
    for name, text in found:
        if name == cylinder.name or (name is None and cylinder is machine.cylinders[-1]):
            yield text


def of_machine(found: Iterable[Note], machine: Machine) -> Iterable[str]:
    """Yield all notes, each after the name of its cylinder where there are several."""
    for name, text in found:
        yield f"{name}, {text}" if name is not None and len(machine.cylinders) > 1 else text
