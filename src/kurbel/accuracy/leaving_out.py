"""What leaving out saves: the same machine with less and less in it, the stages evaluated, and their time."""

from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import cached_property, partial
from typing import Any, NamedTuple

from kurbel.accuracy.timing import Patience, timed
from kurbel.machine import Machine
from kurbel.quantity import Computed
from kurbel.solver.case import Case


class Saving(NamedTuple):
    """A machine with something left out: cached stages evaluated, seconds, and the time over that of the whole."""

    machine: str
    stages: int
    median: float
    least: float
    ratio: float


def savings(machine: Machine, answers: Callable[[Case], Any], patience: Patience) -> Iterator[Saving]:
    """Yield the whole machine, and the same with one thing after another left out.

    answers: asks a case for everything that a command prints.
    """
    whole = 0.0
    for what, lighter in _lighter(machine):
        case = Case(lighter)
        answers(case)
        _, median, least = timed(partial(_answered, answers, lighter), patience)
        whole = whole or median
        yield Saving(what, evaluated(case), median, least, median / whole)


def _answered(answers: Callable[[Case], Any], machine: Machine) -> None:
    answers(Case(machine))


def _lighter(machine: Machine) -> Iterator[tuple[str, Machine]]:
    """Yield the machine without what it has, piece after piece: friction, masses, cards, speed."""
    yield "everything", machine
    steps: tuple[tuple[str, dict[str, Any]], ...] = (
        ("no friction", {"friction": None}),
        ("no masses either", {"masses": None, "inclination": None}),
        ("no cards either: motion alone", {"pistons": ()}),
    )
    for what, less in steps:
        if any(getattr(cylinder, name) for cylinder in machine.cylinders for name in less):
            cylinders = tuple(replace(cylinder, **less) for cylinder in machine.cylinders)
            machine = replace(machine, cylinders=cylinders, limits=())
            yield what, machine
    if machine.speed is not None:
        yield "no speed either: positions alone", replace(machine, speed=None)


def evaluated(thing: Any, seen: set[int] | None = None) -> int:
    """Count what was computed once, and is there, in an object of kurbel's solver, and in all that it holds."""
    seen = set() if seen is None else seen
    if id(thing) in seen:
        return 0
    seen.add(id(thing))
    if isinstance(thing, (tuple, list)):
        return sum(evaluated(one, seen) for one in thing)
    if not type(thing).__module__.startswith("kurbel.solver") or not hasattr(thing, "__dict__"):
        return 0
    there = {name: value for name, value in vars(thing).items() if value is not None}
    cached = [name for name in there if isinstance(getattr(type(thing), name, None), (cached_property, Computed))]
    return len(cached) + sum(evaluated(value, seen) for value in there.values())
