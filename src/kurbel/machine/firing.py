"""When the cylinders of a machine fire."""

from kurbel.crank_angle import CYCLES
from kurbel.machine import Machine
from kurbel.machine.indicator import Rectangle
from kurbel.machine.several import rounded_within_cycle


def firings(machine: Machine) -> list[tuple[float, int]]:
    """Return (crank angle in degrees, number of the cylinder) for every ignition of a cycle, in order."""
    cycle = 360 * machine.revolutions
    found = []
    for number, cylinder in enumerate(machine.cylinders, 1):
        mechanism, each = (
            cylinder.mechanism,
            list[tuple[int, bool]](),
        )  # of every end that fires its turns, and which
        four = machine.cycle_of(cylinder) == "four-stroke"
        if four and mechanism.slides and not any(one.chambers for one in cylinder.pistons):
            each.append((2, False))
        for index, piston in enumerate(cylinder.pistons):
            turns = CYCLES[machine.cycle_of_piston(cylinder, index)]
            for end, chamber in piston.chambers.items():
                # one pressure on every stroke does no work; other cards of two strokes may be those of steam or a pump
                idle = isinstance(chamber, Rectangle) and chamber.mean <= 0
                if chamber.burns or (turns == 2 and not idle):
                    each.append((turns, end == "crank_end"))
        for turns, outer in each:
            first = mechanism.dead_centres()[outer] + cylinder.crank_position
            found += [
                (rounded_within_cycle(turn + first, float(cycle)), number)
                for turn in range(0, cycle, 360 * turns)
            ]
    return sorted(found)
