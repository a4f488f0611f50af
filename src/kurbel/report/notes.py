"""What looks wrong in what was given: one list for a whole machine, from which every command takes what concerns it.

It is said as notes, since the file may be right.
"""

from collections.abc import Callable, Iterable
from itertools import pairwise
from typing import TYPE_CHECKING, NamedTuple

from kurbel.declared.unit_systems import show
from kurbel.machine import Cylinder, Machine
from kurbel.machine.piston import Piston
from kurbel.report.alike import grouped, together
from kurbel.report.pin_notes import pin_notes

if TYPE_CHECKING:
    from kurbel.machine.indicator import Card
    from kurbel.solver.case import Case

_LARGEST_BORE = 5.0  # m; the widest cylinder built, of the Cruquius engine of 1849, has 3.66 m
_LARGEST_MASS = 1e5  # kg going to and fro in one cylinder; those of the largest marine diesels weigh some 2e4
_HIGHEST_SPEED = 1000.0  # 1/s; model racing engines stay below 700
_ASK = "is beyond anything built; is its unit right?"
_LARGEST_FLUCTUATION = 0.25  # of what the books let vary most, crushers and hammers, 1/5
_EXPONENTS = 0.9, 1.7  # wet steam that dries as it expands; a gas of single atoms without heat
LARGEST_PEAK = 300e5  # Pa; of combustion engines
_PLAIN = 0.02
"""Lean of a card, over its range of pressures, below which it has no high end; one open for half the stroke has ¼."""


class Note(NamedTuple):
    """A sentence, and the name of the cylinder that it is about; None for the whole machine."""

    cylinder: str | None
    text: str


Solved = Callable[[], "Case"]
"""Returns a machine with its results; asked only where some are needed, which loads what computes them."""


def machine_notes(machine: Machine, solved: Solved) -> tuple[Note, ...]:
    """Return the notes on a machine, each once: on what was given, on measurements, and on what comes out."""

    def of_each(judge: Callable[[Cylinder], Iterable[str]]) -> list[Note]:
        return [Note(cylinder.name, text) for cylinder in machine.cylinders for text in judge(cylinder)]

    effort = (f"effort: {text}" for text in getattr(machine.effort, "notes", ()))
    found = [*of_each(_chamber_notes), *of_each(_card_notes)]
    found += [Note(None, text) for text in (*effort, *_speed_notes(machine))]
    found += [*of_each(_size_notes), *(Note(None, text) for text in pin_notes(machine))]
    if machine.effort or any(map(_acts, machine.cylinders)):
        import numpy as np

        with np.errstate(all="ignore"):
            found += _on_results(solved())
    return tuple(dict.fromkeys(found))


def _chamber_notes(cylinder: Cylinder) -> Iterable[str]:
    for piston in cylinder.pistons:
        for end, chamber in piston.chambers.items():
            for text in getattr(chamber, "notes", ()):
                yield f"{piston.name}, {end.replace('_', ' ')}: {text}"


def _card_notes(cylinder: Cylinder) -> Iterable[str]:
    for piston in cylinder.pistons:
        yield from (*_card_end_notes(piston), *_exponent_notes(piston))


def _acts(cylinder: Cylinder) -> bool:
    """Return whether forces are given, of which something may come out that looks wrong."""
    return bool(cylinder.pistons or cylinder.masses or cylinder.ram_force or cylinder.moment)


def _on_results(case: "Case") -> Iterable[Note]:
    from kurbel.report import warnings
    from kurbel.report.warnings import as_far_as_solved as told

    for one in case.cylinders:
        yield from (Note(one.drive.name, text) for text in warnings.trace_warnings(one))
    yield from (Note(None, text) for text in warnings.brake_warnings(case.machine, case.cylinders))
    for one in case.cylinders:
        yield from (Note(one.drive.name, text) for text in told(warnings.cylinder_warnings(one), "forces"))
    yield from (Note(None, text) for text in told(warnings.turning_warnings(case), "flywheel"))
    yield from (Note(None, text) for text in told(warnings.strength_warnings(case), "stress"))


def by_cylinder(case: "Case") -> dict[str, list[str]]:
    """Return the notes on each cylinder by its name; those on the whole machine stand below the last one."""
    found: dict[str, list[str]] = {one.name: [] for one in case.machine.cylinders}
    for name, text in machine_notes(case.machine, lambda: case):
        found[name or [*found][-1]].append(text)
    return found


def of_machine(case: "Case") -> Iterable[str]:
    """Yield all notes on a machine, each after the names of its cylinders where there are several."""
    for notes in grouped(machine_notes(case.machine, lambda: case), lambda note: note.text):
        names = [note.cylinder for note in notes if note.cylinder is not None]
        several = names and len(case.machine.cylinders) > 1
        yield f"{together(names)}: {notes[0].text}" if several else notes[0].text


def _speed_notes(machine: Machine) -> Iterable[str]:
    """Yield a note on a speed that no crank has reached, and on a wish that hardly holds it."""
    if machine.speed is not None and machine.speed > _HIGHEST_SPEED:
        yield f"a speed of {show(machine.speed, 'speed')} {_ASK}"
    wanted = machine.flywheel.fluctuation if machine.flywheel else None
    if wanted is not None and wanted > _LARGEST_FLUCTUATION:
        yield (
            f"a wanted fluctuation of {wanted:g} lets the speed vary between {1 - wanted / 2:g} and {1 + wanted / 2:g} "
            "times its mean; those of the books are 1/5 to 1/300: is it right?"
        )


def _size_notes(cylinder: Cylinder) -> Iterable[str]:
    """Yield a note on each bore, and on moving parts, that no machine has had."""
    for piston in cylinder.pistons:
        if piston.bore > _LARGEST_BORE:
            yield f"{piston.name}: a bore of {show(piston.bore, 'length')} {_ASK}"
    if cylinder.masses:
        rod = cylinder.masses.connecting_rod
        moving = cylinder.masses.parts + (rod.mass if rod else 0.0)
        if moving > _LARGEST_MASS:
            yield f"a mass of {show(moving, 'mass')} in moving parts {_ASK}"


def _exponent_notes(piston: Piston) -> Iterable[str]:
    """Yield a note on each exponent of a card by which no gas expands or is compressed."""
    least, most = _EXPONENTS
    for end, chamber in piston.chambers.items():
        given = {getattr(chamber, key) for key in ("exponent", "expansion_exponent") if hasattr(chamber, key)}
        for value in sorted(given):
            if not least <= value <= most:
                said = f"an exponent of {value:g} is none of gas or steam, {least} to {most}; is it right?"
                yield f"{piston.name}, {end.replace('_', ' ')}: {said}"


def _card_end_notes(piston: Piston) -> Iterable[str]:
    """Yield a note where both ends of a piston have their high pressure on the same side, at the same crank angle.

    Their cards may be drawn from the same dead centre.
    """
    if not piston.chambers:
        return
    from kurbel.machine.indicator import Card

    leans = [_lean(end) for end in piston.chambers.values() if isinstance(end, Card)]
    if len(leans) < 2 or min(leans) >= -_PLAIN or max(leans) <= _PLAIN:
        return
    end, centre = ("crank end", "outer") if leans[1] < 0 else ("head end", "inner")
    yield (
        f"{piston.name}, {end}: both ends have their high pressure at the same crank angle; a card counts from its own "
        f"dead centre, that of the {end} from the {centre} one: is it drawn from the other?"
    )


def _lean(card: "Card") -> float:
    """Return the mean of p (1 − 2z) over both strokes by the range of p: positive where p is high at small volumes."""
    pressures = [p for line in card.lines for p in line.pressures]
    middle, span = (max(pressures) + min(pressures)) / 2, max(pressures) - min(pressures)
    points = [pairwise(zip(line.fractions, line.pressures)) for line in card.lines]
    parts = [_part(z, p - middle, z2, p2 - middle) for line in points for (z, p), (z2, p2) in line]
    return sum(parts) / (span * len(card.lines)) if span else 0.0


def _part(z: float, p: float, next_z: float, next_p: float) -> float:
    """Return ∫ p (1 − 2z) |dz| over a straight piece, by Simpson's rule, which is exact."""
    ends = p * (1 - 2 * z) + next_p * (1 - 2 * next_z)
    return abs(next_z - z) / 6 * (ends + 2 * (p + next_p) * (1 - z - next_z))
