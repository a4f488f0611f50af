"""What looks wrong in what was given: one list for a whole machine, from which every command takes what concerns it."""

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, NamedTuple

from kurbel.machine import Cylinder, Machine
from kurbel.report.alike import grouped, together
from kurbel.report.given import card_end_notes, exponent_notes, pin_notes, size_notes, speed_notes

if TYPE_CHECKING:
    from kurbel.solver.case import Case


class Note(NamedTuple):
    """A sentence, and the name of the cylinder that it is about; None for the whole machine."""

    cylinder: str | None
    text: str


def machine_notes(machine: Machine, case: "Case | None" = None) -> tuple[Note, ...]:
    """Return the notes on a machine, each once: on what was given, on measurements, and on what comes out.

    case: the machine with its results; of a machine that only moves nothing is computed.
    """
    chambers = [(cylinder, *one) for cylinder in machine.cylinders for one in _chambers(cylinder)]
    found = [
        Note(cylinder.name, f"{where}: {text}")
        for cylinder, where, chamber in chambers
        for text in getattr(chamber, "notes", ())
    ]
    found += [
        Note(cylinder.name, text)
        for cylinder in machine.cylinders
        for piston in cylinder.pistons
        for text in (*card_end_notes(piston), *exponent_notes(piston))
    ]
    found += [Note(None, f"effort: {text}") for text in getattr(machine.effort, "notes", ())]
    found += [Note(None, text) for text in speed_notes(machine)]
    found += [Note(cylinder.name, text) for cylinder in machine.cylinders for text in size_notes(cylinder)]
    found += [Note(None, text) for text in pin_notes(machine)]
    if machine.effort or any(map(_acts, machine.cylinders)):
        import numpy as np

        from kurbel.solver.case import Case

        with np.errstate(all="ignore"):
            found += _on_results(case or Case(machine))
    return tuple(dict.fromkeys(found))


def _chambers(cylinder: Cylinder) -> Iterable[tuple[str, Any]]:
    for piston in cylinder.pistons:
        if piston.indicator:
            yield f"{piston.name}, head end", piston.indicator.head_end
            yield f"{piston.name}, crank end", piston.indicator.crank_end


def _acts(cylinder: Cylinder) -> bool:
    """Return whether forces are given, of which something may come out that looks wrong."""
    return bool(cylinder.pistons or cylinder.masses or cylinder.ram_force or cylinder.moment)


def _on_results(case: "Case") -> Iterable[Note]:
    from kurbel.report import warnings

    yield from (Note(one.drive.name, text) for one in case.cylinders for text in warnings.trace_warnings(one))
    yield from (Note(None, text) for text in warnings.brake_warnings(case.machine, case.cylinders))
    yield from (Note(one.drive.name, text) for one in case.cylinders for text in warnings.cylinder_warnings(one))
    yield from (Note(None, text) for text in (*warnings.turning_warnings(case), *warnings.strength_warnings(case)))


def of_cylinder(found: Iterable[Note], machine: Machine, cylinder: Cylinder) -> Iterable[str]:
    """Yield the notes on a cylinder; below the last one also those on the whole machine."""
    for name, text in found:
        if name == cylinder.name or (name is None and cylinder is machine.cylinders[-1]):
            yield text


def of_machine(case: "Case") -> Iterable[str]:
    """Yield all notes on a machine, each after the names of its cylinders where there are several."""
    for notes in grouped(machine_notes(case.machine, case), lambda note: note.text):
        names = [note.cylinder for note in notes if note.cylinder is not None]
        several = names and len(case.machine.cylinders) > 1
        yield f"{together(names)}: {notes[0].text}" if several else notes[0].text
