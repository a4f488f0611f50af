"""A machine with one of the cycles that its traces have."""

from dataclasses import replace
from typing import Any

from kurbel.crank_angle import CYCLES
from kurbel.errors import UsageError
from kurbel.machine import Machine
from kurbel.traces.correct import Trace


def of_cycle(machine: Machine, number: int) -> Machine:
    """Return the machine with one cycle, counted from 1, of every trace that has several.

    Raises UsageError if no trace has several cycles, or one has fewer.
    """
    counts: list[int] = []
    alone: dict[int, Trace] = {}  # a mirrored end stays the same trace
    cylinders = []
    for cylinder in machine.cylinders:
        pistons = []
        for index, piston in enumerate(cylinder.pistons):
            period = 360.0 * CYCLES[machine.cycle_of_piston(cylinder, index)]
            ends: dict[str, Any] = {}
            for end, chamber in piston.chambers.items():
                if not chamber.traced:
                    continue
                count = len(chamber.over(period).samples)
                if count < 2:
                    continue
                counts.append(count)
                cycle = chamber.of_cycle(min(number, count), period)
                ends[end] = alone.setdefault(id(chamber), cycle)
            indicator = replace(piston.indicator, **ends) if piston.indicator else None
            pistons.append(replace(piston, indicator=indicator))
        cylinders.append(replace(cylinder, pistons=tuple(pistons)))
    if not counts:
        raise UsageError("--cycle: no trace of this machine has several cycles; leave it out")
    if number > min(counts):
        raise UsageError(f"--cycle {number}: there are {min(counts)} cycles, counted from 1")
    return replace(machine, cylinders=tuple(cylinders))
