"""Pistons that the shaft drives, and chambers of others that are always open to a pipe."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

import numpy as np

from kurbel.arrays import Array, Number, Truth
from kurbel.errors import UsageError
from kurbel.machine.ideal_cards import Compressor
from kurbel.machine.indicator import Chamber, levels_of_strokes
from kurbel.numerics.arithmetic import every, some
from kurbel.solver.drive import Drive
from kurbel.solver.gas import PistonGas
from kurbel.solver.state import State

SAME_PRESSURE = 1e-9
"""Relative difference of pressures that are equal but for rounding."""
_CANCELLED = 4e-14
"""Relative to its largest value: a smaller flow is rounding."""


class DrivenPiston(NamedTuple):
    """A driven piston: its number in the cylinder, its pressures, which ends deliver, and whether it pumps."""

    number: int
    gas: PistonGas
    head_delivers: bool
    crank_delivers: bool
    is_pump: bool


def driven_pistons(drive: Drive) -> Iterator[DrivenPiston]:
    """Yield the pistons of a cylinder that are driven by it.

    Raises UsageError where many machines differ in that.
    """
    for gas in drive.gas:
        # the gas takes work from a driven piston; a compressor without work is driven, too
        chambers = list(gas.piston.chambers.values())
        is_compressor = any(isinstance(chamber, Compressor) for chamber in chambers)
        is_driven = _alike(gas.work < 0)
        if not is_driven and is_compressor:
            is_driven = not _alike(gas.work > 0)
        if not is_driven:
            continue
        # an end delivers if work is done on its gas; there are works of the ends that there are
        works = iter(gas.works)
        head_delivers = gas.head is not None and _alike(next(works) < 0)
        crank_delivers = gas.crank is not None and _alike(next(works) < 0)
        # a pump is declared as one, or has a constant pressure on each stroke
        is_pump = False
        if not is_compressor:
            is_pump = drive.machine.pump is not None or all(map(_is_level, chambers))
        number = drive.cylinder.pistons.index(gas.piston)
        yield DrivenPiston(number, gas, head_delivers, crank_delivers, is_pump)


def _alike(condition: Truth) -> bool:
    """Return the condition that all machines have in common; raises UsageError where they differ."""
    holds_for_all = bool(every(condition))
    if some(condition) and not holds_for_all:
        raise UsageError("these machines differ in what is driven")
    return holds_for_all


def _is_level(chamber: Chamber | None) -> bool:
    """Return whether a chamber has one pressure on each stroke, as a pump's has."""
    return levels_of_strokes(chamber) is not None


# chambers that are always open to a pipe


class OpenEnd(NamedTuple):
    """An end with one pressure on both strokes; that of a pipe, to which it is then always open.

    number: of its piston in the cylinder; turned: whether that moves against the crosshead; pipe: delivery, suction,
    or '' where it has the pressure of neither.
    """

    number: int
    is_head: bool
    turned: bool
    pipe: str


def open_ends(drive: Drive, pipes: Mapping[str, Sequence[Number]]) -> Iterator[OpenEnd]:
    """Yield the ends of pistons that do not drive which have one pressure on both strokes, but not the ambient one.

    pipes: the absolute pressures in Pa in the delivery and in the suction pipes.
    """
    for gas in drive.gas:
        if _alike(gas.work > 0):
            continue
        for end in ("head_end", "crank_end"):
            levels = absolute_levels(gas, end, drive.machine.ambient)
            if not levels or not all(_are_equal(level, levels[0]) for level in levels):
                continue
            if _are_equal(levels[0], drive.machine.ambient):
                continue
            joined = ""
            for pipe, pressures in pipes.items():
                if any(_are_equal(levels[0], pressure) for pressure in pressures):
                    joined = pipe
            number = drive.cylinder.pistons.index(gas.piston)
            yield OpenEnd(number, end == "head_end", gas.turned, joined)


def absolute_levels(gas: PistonGas, end: str, ambient: Number) -> list[Number]:
    """Return the absolute pressures in Pa of an end that has one on each stroke; none of another end."""
    lift = 0.0 if gas.absolute else ambient
    return [level + lift for level in levels_of_strokes(gas.piston.chambers.get(end)) or ()]


def _are_equal(pressure: Number, other: Number) -> bool:
    """Return whether two pressures in Pa are equal but for rounding, of all machines."""
    difference = np.abs(np.subtract(pressure, other))
    return _alike(difference <= SAME_PRESSURE * np.maximum(np.abs(pressure), np.abs(other)))


def flow_of(state: State, end: OpenEnd, is_derivative: bool) -> Array:
    """Return dV/dφ in m³ of what an end that is always open gives to its pipe, or takes from it (negative)."""
    dimensions = state.drive.cylinder.pistons[end.number]
    area = dimensions.head_area if end.is_head else dimensions.crank_area
    change = state.curvature if is_derivative else state.slope
    # the head end grows on the outstroke, the crank end shrinks
    shrinks_outward = end.is_head == end.turned
    sense = 1.0 if shrinks_outward else -1.0
    return sense * abs(dimensions.lever_ratio) * area * np.asarray(change)


def displaced(
    state: State,
    piston: DrivenPiston,
    is_suction: bool = False,
    is_derivative: bool = False,
    head_counts: bool = True,
    crank_counts: bool = True,
) -> Array:
    """Return dV/dφ in m³ of what the chambers of a piston deliver; on each stroke it is one of them.

    is_suction: of what they draw in; is_derivative: d²V/dφ² instead; head_counts, crank_counts: whether that end does.
    """
    # of many machines the numbers of the piston of the state are those of the angles
    dimensions = state.drive.cylinder.pistons[piston.number]
    head_area = dimensions.head_area if piston.head_delivers and head_counts else 0.0
    crank_area = dimensions.crank_area if piston.crank_delivers and crank_counts else 0.0
    # a chamber delivers while its volume falls: the crank end on the outstroke, the head end on the return
    # stroke, and it draws in on the other one; of a piston that a lever moves against the crosshead it is turned round
    outward_area, return_area = crank_area, head_area
    if is_suction != piston.gas.turned:
        outward_area, return_area = head_area, crank_area
    # dV/dφ = A dx/dφ is positive on both strokes
    ratio = abs(dimensions.lever_ratio)
    area = np.where(state.direction > 0, ratio * outward_area, -(ratio * return_area))
    change = state.curvature if is_derivative else state.slope
    return area * np.asarray(change)
