"""What is larger or faster than anything that was built, as when a unit is wrong: said, since the file may be right."""

from __future__ import annotations

from collections.abc import Iterable

from kurbel.declared.unit_systems import show
from kurbel.machine import Cylinder, Machine

_LARGEST_BORE = 5.0  # m; the widest cylinder built, of the Cruquius engine of 1849, has 3.66 m
_LARGEST_MASS = 1e5  # kg going to and fro in one cylinder; those of the largest marine diesels weigh some 2e4
_HIGHEST_SPEED = 1000.0  # 1/s; model racing engines stay below 700
_ASK = "is beyond anything built; is its unit right?"


def speed_notes(machine: Machine) -> Iterable[str]:
    """Yield a note on a speed that no crank has reached."""
    if machine.speed is not None and machine.speed > _HIGHEST_SPEED:
        yield f"a speed of {show(machine.speed, 'speed')} {_ASK}"


def size_notes(cylinder: Cylinder) -> Iterable[str]:
    """Yield a note on each bore, and on moving parts, that no machine has had."""
    for piston in cylinder.pistons:
        if piston.bore > _LARGEST_BORE:
            yield f"{piston.name}: a bore of {show(piston.bore, 'length')} {_ASK}"
    if cylinder.masses:
        rod = cylinder.masses.connecting_rod
        moving = cylinder.masses.parts + (rod.mass if rod else 0.0)
        if moving > _LARGEST_MASS:
            yield f"a mass of {show(moving, 'mass')} in moving parts {_ASK}"
