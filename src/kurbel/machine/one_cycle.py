"""A machine with one measured cycle of its traces in place of the mean of all."""

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

from kurbel.errors import UsageError
from kurbel.machine import Machine
from kurbel.machine.cylinder import CYCLES
from kurbel.machine.parts import Piston
from kurbel.traces.correct import Trace


def of_cycle(machine: Machine, number: int) -> Machine:
    """Return the machine with the cycle of this number, counted from 1, of every trace that has several.

    Raises UsageError where no trace has so many.
    """
    counts = [len(trace.over(period).samples) for trace, period in _of_several(machine)]
    if not counts:
        raise UsageError("--cycle: no trace of this machine has several cycles; leave it out")
    if number > min(counts):
        raise UsageError(f"--cycle {number}: there are {min(counts)} cycles, counted from 1")
    # a mirrored end stays the same trace
    alone: dict[int, Any] = {id(trace): trace.of_cycle(number, period) for trace, period in _of_several(machine)}

    def changed(piston: Piston) -> Piston:
        ends = {end: alone[id(chamber)] for end, chamber in piston.chambers.items() if id(chamber) in alone}
        return replace(piston, indicator=replace(piston.indicator, **ends)) if piston.indicator else piston

    cylinders = (replace(one, pistons=tuple(map(changed, one.pistons))) for one in machine.cylinders)
    return replace(machine, cylinders=tuple(cylinders))


def _of_several(machine: Machine) -> Iterator[tuple[Trace, float]]:
    """Yield the traces of several cycles, each with the degrees of one."""
    for cylinder in machine.cylinders:
        for index, piston in enumerate(cylinder.pistons):
            period = 360.0 * CYCLES[machine.cycle_of_piston(cylinder, index)]
            for chamber in piston.chambers.values():
                if isinstance(chamber, Trace) and len(chamber.over(period).samples) > 1:
                    yield chamber, period
