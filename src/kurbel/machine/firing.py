"""When the cylinders of a machine fire."""

from kurbel.crank_angle import CYCLES
from kurbel.machine import Cylinder, Machine
from kurbel.machine.indicator import Rectangle
from kurbel.machine.several import rounded_within_cycle


def firings(machine: Machine) -> list[tuple[float, int]]:
    """Return (crank angle in degrees, number of the cylinder) for every ignition of a cycle, in order.

    The angles of several cylinders count from the inner dead centre of cylinder 1, that of a single one from φ = 0.
    """
    cycle = 360 * machine.revolutions
    several = len(machine.cylinders) > 1
    ignitions = []
    for number, cylinder in enumerate(machine.cylinders, 1):
        inner, outer = cylinder.mechanism.dead_centres()
        first = cylinder.crank_position
        if several:
            first = first - machine.cylinders[0].crank_position
        else:
            first = first + inner
        for turns, at_outer in _firing_ends(machine, cylinder):
            begin = first
            if at_outer:
                begin = first + (outer - inner)
            for turn in range(0, cycle, 360 * turns):
                ignitions.append((rounded_within_cycle(turn + begin, float(cycle)), number))
    return sorted(ignitions)


def _firing_ends(machine: Machine, cylinder: Cylinder) -> list[tuple[int, bool]]:
    """Return of every end that fires the turns of its cycle, and whether it is the crank end."""
    ends: list[tuple[int, bool]] = []
    has_cards = any(piston.chambers for piston in cylinder.pistons)
    is_four_stroke = machine.cycle_of(cylinder) == "four-stroke"
    if is_four_stroke and cylinder.mechanism.slides and not has_cards:
        ends.append((CYCLES["four-stroke"], False))
    for index, piston in enumerate(cylinder.pistons):
        turns = CYCLES[machine.cycle_of_piston(cylinder, index)]
        for end, chamber in piston.chambers.items():
            # one pressure on every stroke does no work; other cards of two strokes may be those of steam or a pump
            is_idle = isinstance(chamber, Rectangle) and chamber.mean <= 0
            if chamber.burns or (turns == CYCLES["four-stroke"] and not is_idle):
                ends.append((turns, end == "crank_end"))
    return ends
