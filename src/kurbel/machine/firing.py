"""When cylinders fire: the turn of a four-stroke cycle that each takes where the file leaves it open; intervals."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from itertools import groupby, pairwise, product
from typing import TYPE_CHECKING

from kurbel.machine.cylinder import CYCLES, Cylinder

if TYPE_CHECKING:
    from kurbel.machine import Machine

_TOGETHER = 12
"""Cylinders of which all combinations of turns are compared; of more, those of one crank pin after another."""
_ON_A_PIN = 9
"""Cylinders that are compared together where there are more: a row of a large radial engine."""
_EQUAL = 1e-9
"""Share by which sums of squared intervals differ that are equal but for rounding."""


def in_even_turns(cylinders: Sequence[Cylinder], free: Sequence[bool], cycle: str) -> tuple[Cylinder, ...]:
    """Return the cylinders, each free one firing in that turn of its four-stroke cycle which is most even.

    The sum of the squared firing intervals is the least one; among equals the firing order reads smallest. Cylinder 1
    stays in its turn. free: whose crank positions tell no turn; cycle: that of the machine.
    """
    firing = [place for place, one in enumerate(cylinders) if CYCLES[one.cycle or cycle] == 2]
    choosing = [place for place in firing if free[place] and place > 0]
    angles = {place: cylinders[place].crank_position for place in firing}
    fixed = {place: angle for place, angle in angles.items() if place not in choosing}
    for pin in _pins(cylinders, choosing) if len(firing) > _TOGETHER else [choosing] if choosing else []:
        fixed = _most_even(fixed, {place: angles[place] for place in pin})
    return tuple(
        replace(one, crank_position=fixed[place]) if place in choosing else one for place, one in enumerate(cylinders)
    )


def _pins(cylinders: Sequence[Cylinder], places: Iterable[int]) -> list[list[int]]:
    """Return the places in the list of the cylinders that share a crank pin, pin by pin along the shaft."""

    def pin(place: int) -> tuple[float, float]:
        one = cylinders[place]
        return one.axial_position or 0.0, round((one.bank_angle - one.crank_position) % 360.0, 6) % 360.0

    along = sorted(places, key=lambda place: pin(place)[0])
    pins = [list(group) for _, group in groupby(along, pin)]
    return [one[start : start + _ON_A_PIN] for one in pins for start in range(0, len(one), _ON_A_PIN)]


def _most_even(fixed: Mapping[int, float], open_: Mapping[int, float]) -> dict[int, float]:
    """Return the angles of those that are fixed and of those of which each may fire a turn later."""
    here = [_within(angle, 720.0) for angle in fixed.values()]
    either = [(_within(angle, 720.0), _within(angle + 360.0, 720.0)) for angle in open_.values()]
    sums = [_squared([*here, *angles]) for angles in product(*either)]
    least = min(sums) * (1 + _EQUAL)
    turns = product(*((angle, angle + 360.0) for angle in open_.values()))
    found = ({**fixed, **dict(zip(open_, angles))} for angles, size in zip(turns, sums) if size <= least)
    return min(found, key=_order)


def _squared(angles: list[float]) -> float:
    """Return the sum of the squared intervals between angles of 0 to 720 degrees."""
    angles.sort()
    total = (angles[0] + 720.0 - angles[-1]) ** 2
    for one, after in pairwise(angles):
        total += (after - one) ** 2
    return total


def _order(angles: Mapping[int, float]) -> list[int]:
    """Return the cylinders in the order in which they fire, from the first one on."""
    first = angles[min(angles)]
    return sorted(angles, key=lambda place: (_within(angles[place] - first, 720.0), place))


def _within(angle: float, cycle: float) -> float:
    """Return an angle of the cycle, in degrees."""
    return round(angle % cycle, 9) % cycle


def intervals(angles: Iterable[float], cycle: float) -> list[float]:
    """Return the angles from one firing to the next over a cycle, all in degrees.

    >>> intervals([450, 0], 720)
    [450.0, 270.0]
    """
    found = sorted(_within(angle, cycle) for angle in angles)
    return [float(round(after - one, 9)) for one, after in zip(found, (*found[1:], found[0] + cycle))]


def firings(machine: "Machine") -> list[tuple[float, int]]:
    """Return the crank angles of a cycle in degrees at which cylinders fire, each with the number of its cylinder."""
    cycle = 360.0 * machine.revolutions
    return sorted(
        (_within(turn + angle + cylinder.crank_position, cycle), number)
        for number, cylinder in enumerate(machine.cylinders, 1)
        for length, angle in _of_cylinder(machine, cylinder)
        for turn in range(0, round(cycle), length)
    )


def _of_cylinder(machine: "Machine", cylinder: Cylinder) -> Iterable[tuple[int, float]]:
    """Yield for every end that fires the length of its cycle and its dead centre, in degrees of its own crank."""
    four = machine.cycle_of(cylinder) == "four-stroke"
    if four and cylinder.mechanism.slides and not any(one.chambers for one in cylinder.pistons):
        yield 720, cylinder.mechanism.dead_centres()[0]
    for number, piston in enumerate(cylinder.pistons):
        turns = CYCLES[machine.cycle_of_piston(cylinder, number)]
        for end, chamber in piston.chambers.items():
            # one pressure on every stroke does no work; other cards of two strokes may be those of steam or a pump
            if getattr(chamber, "fires", turns == 2 and getattr(chamber, "mean", 1.0) > 0):
                yield 360 * turns, cylinder.mechanism.dead_centres()[end == "crank_end"]
