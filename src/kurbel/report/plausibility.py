"""What looks wrong with measured traces and the brake: said as warnings, since only who measured can know."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import Any

from kurbel.declared.unit_systems import show
from kurbel.machine import Machine
from kurbel.solver.cylinder.brake import Brake
from kurbel.solver.cylinder.forces import CylinderForces

_LEAST_OF_SEVERAL = 1.1
"""Brake over indicated power of one cylinder from which on others are likely to be missing."""
_TAKEN = 0.3, 1.0
"""Indicated over brake power of a machine that is driven."""
_GOOD = 0.85
"""Mechanical efficiency by which the number of cylinders is reckoned that the brake asks for."""


def trace_warnings(forces: CylinderForces) -> Iterable[str]:
    """Yield what is implausible in the traces of a cylinder."""
    for gas in forces.drive.gas:
        ends: tuple[tuple[str, Any], ...] = (("head end", gas.head), ("crank end", gas.crank))
        for end, pressure in ends:
            if hasattr(pressure, "each"):
                yield from (f"{gas.piston.name}, {end}: {note}" for note in _of_trace(pressure))


def _of_trace(pressure: Any) -> Iterable[str]:
    """Yield the notes on one trace: on its samples, or else on its angles, or else on its pressures."""
    from kurbel.report.trace_level import level_notes
    from kurbel.report.trace_place import place_notes
    from kurbel.report.trace_readings import Reading
    from kurbel.report.trace_samples import sample_notes

    reading = Reading(pressure)
    yield from tuple(sample_notes(reading)) or tuple(place_notes(reading)) or level_notes(reading)


def brake_warnings(machine: Machine, cylinders: Sequence[CylinderForces]) -> Iterable[str]:
    """Yield a warning where brake and indicator contradict each other."""
    brake, indicated = machine.brake_power, Brake(machine, cylinders).indicated
    if not brake or indicated is None:
        return
    shown = f"the indicated power, {show(indicated, 'power')}, is"
    if indicated < 0:
        if not _TAKEN[0] <= -indicated / brake <= _TAKEN[1]:
            much = "more than" if -indicated > brake else "far below what"
            yield f"{shown} {much} the driven shaft takes, {show(brake, 'power')}: check angle_zero, units and areas"
        return
    if indicated < brake:
        yield (
            f"{shown} below the brake power, {show(brake, 'power')}: check angle_zero, units and areas"
            f"{_of_several(machine, brake / indicated if indicated else math.inf)}"
        )


def _of_several(machine: Machine, times: float) -> str:
    if len(machine.cylinders) != 1 or not _LEAST_OF_SEVERAL < times < 100:
        return ""
    count = max(2, math.ceil(times / _GOOD - 0.3))
    return (
        f"; or is this one cylinder of {count}, say? Then write all of them: 'cylinders: {{count: {count}, each: …}}' "
        "with a firing order"
    )
