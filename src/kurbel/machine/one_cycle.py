"""A machine with one measured cycle of its traces in place of the mean of all."""

from dataclasses import replace
from typing import Any

from kurbel.errors import UsageError
from kurbel.machine import Machine
from kurbel.machine.angle_points import CYCLES
from kurbel.machine.cylinder import Cylinder
from kurbel.machine.piston import Piston
from kurbel.machine.trace import Trace


def of_cycle(machine: Machine, number: int) -> Machine:
    """Return the machine with the cycle of this number, counted from 1, of every trace that has several.

    Raises UsageError where no trace has so many.
    """
    counts: list[int] = []
    cylinders = tuple(
        replace(one, pistons=tuple(_piston(machine, one, index, number, counts) for index in range(len(one.pistons))))
        for one in machine.cylinders
    )
    if not counts:
        raise UsageError("--cycle: no trace of this machine has several cycles; leave it out")
    if number > min(counts):
        raise UsageError(f"--cycle {number}: there are {min(counts)} cycles, counted from 1")
    return replace(machine, cylinders=cylinders)


def _piston(machine: Machine, cylinder: Cylinder, index: int, number: int, counts: list[int]) -> Piston:
    piston, period = cylinder.pistons[index], 360.0 * CYCLES[machine.cycle_of_piston(cylinder, index)]
    if piston.indicator is None:
        return piston
    ends: dict[str, Any] = {"head_end": piston.indicator.head_end, "crank_end": piston.indicator.crank_end}
    found: dict[int, Trace] = {}
    for chamber in ends.values():
        if isinstance(chamber, Trace) and len(whole := chamber.over(period).samples) > 1:
            counts.append(len(whole))
            if number <= len(whole):  # a mirrored end stays the same trace
                found[id(chamber)] = chamber.of_cycle(number, period)
    changed = {end: found.get(id(chamber), chamber) for end, chamber in ends.items()}
    return replace(piston, indicator=replace(piston.indicator, **changed))
