"""Pistons that the shaft drives, and chambers of others that are always open to a pipe."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

import numpy as np

from kurbel.arrays import Array, Number, Truth
from kurbel.crank_angle import CrankAngle
from kurbel.errors import UsageError
from kurbel.machine.ideal_cards import Compressor
from kurbel.machine.indicator import Chamber, levels_of_strokes
from kurbel.numerics.arithmetic import every, some, spread
from kurbel.solver.drive import Drive
from kurbel.solver.gas import PistonGas
from kurbel.solver.state import State

SAME_PRESSURE = 1e-9
"""Relative difference of pressures that are equal but for rounding."""
_CANCELLED = 4e-14
"""Relative to its largest value: a smaller flow is rounding."""


Openings = tuple[Number, Number]
"""Fractions of the stroke from the smallest volume at which the suction and the delivery valve of a chamber open."""
_AT_ONCE: Openings = (0.0, 1.0)


class DrivenPiston(NamedTuple):
    """A driven piston: its number in the cylinder, its pressures, which ends deliver, and whether it pumps.

    head_opens, crank_opens: where valves open late, since the liquid is compressible.
    """

    number: int
    gas: PistonGas
    head_delivers: bool
    crank_delivers: bool
    is_pump: bool
    head_opens: Openings = _AT_ONCE
    crank_opens: Openings = _AT_ONCE

    @property
    def opens_late(self) -> bool:
        """Whether a valve opens after the dead centre."""
        return self.head_opens is not _AT_ONCE or self.crank_opens is not _AT_ONCE


def driven_pistons(drive: Drive) -> Iterator[DrivenPiston]:
    """Yield the pistons of a cylinder that are driven by it.

    Raises UsageError where many machines differ in that.
    """
    for gas in drive.gas:
        # the gas takes work from a driven piston; a compressor without work is driven, too
        by_end = drive.cylinder.pistons[gas.number].chambers
        chambers = list(by_end.values())
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
        head_opens = crank_opens = _AT_ONCE
        if drive.machine.pump is not None:
            liquid = drive.machine.pump.liquid
            head_opens = liquid.opening_fractions(by_end.get("head_end")) or _AT_ONCE
            crank_opens = liquid.opening_fractions(by_end.get("crank_end")) or _AT_ONCE
        yield DrivenPiston(
            gas.number, gas, head_delivers, crank_delivers, is_pump, head_opens, crank_opens
        )


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
            levels = absolute_levels(drive, gas, end)
            if not levels or not all(_are_equal(level, levels[0]) for level in levels):
                continue
            if _are_equal(levels[0], drive.machine.ambient):
                continue
            joined = ""
            for pipe, pressures in pipes.items():
                if any(_are_equal(levels[0], pressure) for pressure in pressures):
                    joined = pipe
            yield OpenEnd(gas.number, end == "head_end", gas.turned, joined)


def absolute_levels(drive: Drive, gas: PistonGas, end: str) -> list[Number]:
    """Return the absolute pressures in Pa of an end that has one on each stroke; none of another end."""
    lift = 0.0 if gas.absolute else drive.machine.ambient
    card = drive.cylinder.pistons[gas.number].chambers.get(end)
    return [level + lift for level in levels_of_strokes(card) or ()]


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
    is_rigid: bool = False,
) -> Array:
    """Return dV/dφ in m³ of what the chambers of a piston deliver; on each stroke it is one of them.

    is_suction: of what they draw in; is_derivative: d²V/dφ² instead; head_counts, crank_counts: whether that end does;
    is_rigid: of an incompressible liquid.
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
    if piston.opens_late and not is_rigid:
        area = np.where(_is_open(state, piston, is_suction), area, 0.0)
    return area * np.asarray(change)


def _is_open(state: State, piston: DrivenPiston, is_suction: bool) -> Array:
    """Return whether the valve is open of the chamber that draws in, or delivers, on the stroke of each angle."""
    # the chamber that grows draws in: on the outstroke the head end, unless a lever turns the piston round
    moves_outward = (state.direction > 0) != piston.gas.turned
    is_head = moves_outward if is_suction else np.logical_not(moves_outward)

    # the fraction of its stroke from its smallest volume, on the side of a corner that is meant
    within = State(state.drive, CrankAngle.of(state.within), state.within)
    z = np.asarray(within.z)
    from_head = 1 - z if piston.gas.turned else z
    passed = np.where(is_head, from_head, 1 - from_head)

    valve = 0 if is_suction else 1
    index = state.drive.index
    head_opens = spread(piston.head_opens[valve], index)
    crank_opens = spread(piston.crank_opens[valve], index)
    opens = np.where(is_head, head_opens, crank_opens)
    is_open: Array = passed >= opens if is_suction else passed <= opens
    return is_open
