"""Turning effort of the whole machine over the angle φ of crank 1, what it works against, and the excess work.

    M(φ) = Σ share_k M_k(φ − φ_k)        cylinder k with its crank φ_k behind crank 1 (R p. 612); M_k = R T (R 303)
    E(φ) = ∫₀^φ (M − M_load) dφ          excess work; ΔE = E_max − E_min (R p. 608)
    J(φ) = Σ m x′² + …                   what the moving masses add to the inertia of the shaft

The pieces of the whole machine lie within those of every cylinder. Each cylinder is sampled on its own pieces, and the
polynomials there are evaluated on the common ones. Of cylinders that work alike only one is sampled.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from kurbel.arrays import Array, Flags, Indices
from kurbel.crank_angle import unit_vector
from kurbel.declared.unit_systems import show
from kurbel.errors import NoSolutionError, UsageError
from kurbel.machine import Machine
from kurbel.machine.alike import gathered, work_alike
from kurbel.machine.turning import Effort, Harmonics
from kurbel.numerics.arithmetic import some, unless_cancelled, where
from kurbel.numerics.extreme import Extreme, Extremes
from kurbel.numerics.pieces import Angles, Pieces, common
from kurbel.solver.drive import Drive, any_of
from kurbel.solver.forces import CylinderForces
from kurbel.solver.state import State, reduced_inertia

_SLOWEST = 1e-100
"""Revolutions per second below which, and above whose inverse, kinetic energies leave the range of floats."""
_ROUNDING = 1e-13
"""Relative to the largest torque: a smaller mean, as that of masses without gas, is rounding."""
_CANCELLED = 4e-14
"""Relative to the terms of a sum: if the sum is smaller over the whole cycle, the terms cancel."""
_UNIFORM = 1e-14
"""Relative to the largest torque: load and effort that differ by less over the whole cycle are equal."""
_BALANCED = 1e-9
"""Relative difference below which the means of effort and load are equal."""
_LEVEL = 16 * float(np.finfo(float).eps)
"""Relative to the work of all lobes: maxima, or minima, of E that differ by less are equal."""


def shaft_torque(state: State) -> Any:
    """Return the torque M = R T of a cylinder in N m."""
    return state.M


def driving_torque(state: State) -> Any:
    """Return the torque P_driving dx/dφ in N m of the gas on the pistons that drive."""
    return state.P_driving * state.slope


def inertia_torque(state: State) -> Any:
    """Return the torque −m x′ x″ ω² in N m of the inertia forces at uniform rotation, −½ ω² dJ/dφ (Tolle).

    An exact rod adds its couple times −ψ′.
    """
    rod, omega = state.drive.rod, state.drive.omega
    assert omega is not None
    torque = state.slope * state.curvature * (-state.drive.mass * omega * omega)
    if rod is None:
        return torque
    return torque - state.rod_couple * state.rod_slope


class Term(NamedTuple):
    """A torque, or another quantity, of cylinders that work alike; factor: a number, or one of every machine (n,)."""

    factor: Any
    cylinders: Sequence[CylinderForces]
    torque: Callable[[State], Any]


class TurningEffort:
    """The turning effort of a machine, or of `count` machines of one kind, over their common cycle in degrees.

    Samples are (nodes, pieces) at the nodes of `pieces`, numbers of the machines (n,); of one machine, n = 1.
    refused: which machines (n,) of many have no result; with one machine an error is raised instead.
    """

    def __init__(self, machine: Machine, cylinders: Sequence[CylinderForces], count: int | None = None) -> None:
        self.machine, self.count = machine, count
        self.cylinders = tuple(forces for forces in cylinders if forces.drive.has_force)
        self.refused: Flags = np.zeros(count or 1, dtype=bool)
        self.cycle = 360.0 * machine.revolutions
        self.omega: Any = None if machine.speed is None else 2 * math.pi * machine.speed
        if not self.cylinders and machine.effort is None:
            raise UsageError(f"{machine.name}: no force acts, so that nothing turns the shaft; kurbel check says why")
        self._refuse_speeds_beyond_floats()

    def _refuse_speeds_beyond_floats(self) -> None:
        speed: Any = self.machine.speed
        if speed is None:
            return
        beyond = (speed != 0) & ((speed <= _SLOWEST) | (speed >= 1 / _SLOWEST))
        self.refused |= beyond
        if self.count is None and beyond:
            size, name = "large" if speed > 1 else "small", self.machine.name
            raise UsageError(f"{name}: a speed of {show(speed, 'speed')} is too {size} to compute with")

    def result(self, values: Array) -> Any:
        """Return values (n,), nan for refused machines; for one machine a float."""
        return float(values[0]) if self.count is None else np.where(self.refused, np.nan, values)

    # the common pieces

    @cached_property
    def groups(self) -> list[list[CylinderForces]]:
        """The cylinders, those together that work alike."""
        return gathered(self.cylinders, lambda one, other: work_alike(one.drive.cylinder, other.drive.cylinder))

    @cached_property
    def given(self) -> Diagram | HarmonicTorque | None:
        """The effort that is known from elsewhere; None where cylinders give it."""
        effort = self.machine.effort
        if isinstance(effort, Harmonics):
            return HarmonicTorque(effort, self.cycle)
        return None if effort is None else Diagram(effort, self.cycle, self.count or 1)

    @cached_property
    def diagram(self) -> Diagram | None:
        """The load that is given by points; None for another load."""
        points = self.machine.load.diagram if self.machine.load else None
        return None if points is None else Diagram(points, self.cycle, self.count or 1)

    @cached_property
    def pieces(self) -> Pieces:
        """The cycle in pieces on which every torque is a polynomial."""
        none = Angles(np.zeros(0, dtype=np.intp), np.zeros(0))
        breaks = [none, *(given.breaks for given in (self.given, self.diagram) if given)]
        cuts = Angles(*(np.concatenate(parts) for parts in zip(*breaks)))
        if not self.cylinders:
            return Pieces.between(cuts, self.count or 1, self.cycle)
        parts = [(group[0].pieces, position(one)) for group in self.groups for one in group]
        return common(parts, self.cycle).split(cuts)

    def sampled(self, terms: Sequence[Term]) -> Array:
        """Return the sum of the terms on the common pieces; exactly 0 in machines where the terms cancel."""
        pieces, whole, size = self.pieces, np.zeros(self.pieces.degrees.shape), np.zeros(self.pieces.count)
        for factor, cylinders, torque in terms:
            own = cylinders[0].pieces
            values = np.broadcast_to(torque(cylinders[0].samples), own.degrees.shape) * own.of(factor)
            size = size + len(cylinders) * own.largest(values)
            for forces in cylinders:
                whole += values if own is pieces else pieces.carried(values, own, position(forces))
        return np.where(pieces.of(pieces.largest(whole) > _CANCELLED * size), whole, 0.0)

    def sum_at(self, terms: Sequence[Term], degrees: Array, within: Array) -> Array:
        """Return the sum of the terms of one machine at crank angles (k,), on the sides of jumps that hold `within`."""
        behind = [(term, position(forces)) for term in terms for forces in term.cylinders]
        values = [
            np.broadcast_to(factor * torque(State.at(cylinders[0].drive, degrees - late, within - late)), degrees.shape)
            for (factor, cylinders, torque), late in behind
        ]
        every = np.array(values).reshape(len(values), *degrees.shape)
        return np.asarray(unless_cancelled(every.sum(axis=0), np.abs(every).sum(axis=0)))

    # the effort

    @cached_property
    def indicated(self) -> Array:
        """The torque M in N m without the losses of the machine."""
        if self.given:
            return self.given.at(self.pieces.degrees, self.pieces.middle, self.pieces.machine)
        return self.sampled([Term(1.0, group, shaft_torque) for group in self.groups])

    @cached_property
    def drives(self) -> Any:
        """Whether any piston drives; for a given effort, whether its mean does."""
        if self.given:
            return self.result(self._mean_of(self.indicated)) >= 0
        return any_of(forces.drive.drives for forces in self.cylinders)

    def share(self, drive: Drive | None) -> Any:
        """Return what the torque of a cylinder, or a given effort, is multiplied by for the losses (R p. 610–613).

        η where its pistons drive, 1/η where the machine is driven and no piston drives. In a machine with driving
        pistons the driven ones count in full. On a rod with both the factor is 1, and `lost` subtracts the loss of the
        driving ones.
        """
        eta = self.machine.efficiency
        if not some(eta != 1) or drive is None:
            return where(self.drives, eta, 1 / eta) if some(eta != 1) else eta
        driven = any_of(forces.drive.driven for forces in self.cylinders)
        alone = drive.drives & np.logical_not(drive.driven)
        return where(self.drives, where(alone, eta, 1.0), where(driven, 1 / eta, 1.0))

    def lost(self, group: Sequence[CylinderForces]) -> list[Term]:
        """Return the loss, at most one term, of driving pistons that share their rods with driven ones; see `share`."""
        drive = group[0].drive
        factor = where(drive.drives & drive.driven, self.machine.efficiency - 1.0, 0.0)
        return [Term(factor, group, driving_torque)] if some(factor != 0) else []

    @cached_property
    def terms(self) -> list[Term]:
        """The terms of M with the losses of the machine."""
        whole = [Term(self.share(group[0].drive), group, shaft_torque) for group in self.groups]
        return whole + [term for group in self.groups for term in self.lost(group)]

    @cached_property
    def M(self) -> Array:
        """The turning effort in N m, with the losses of the machine; see `share`."""
        if self.given:
            return np.asarray(self.indicated * self.pieces.of(self.share(None)))
        return self.indicated if not some(self.machine.efficiency != 1) else self.sampled(self.terms)

    def M_at(self, degrees: Array, within: Array) -> Array:
        """Return the same of one machine at crank angles (k,) in degrees, on the sides of jumps that hold `within`."""
        if self.given:
            given = self.given.at(degrees, within, np.zeros(len(within), dtype=np.intp))
            return np.asarray(given * self.share(None))
        return self.sum_at(self.terms, degrees, within)

    @cached_property
    def extremes(self) -> Extremes:
        """Largest and smallest M in N m, one-sided values at jumps included."""
        return self.pieces.extremes(self.M[None]).each(self.result)[0]

    @cached_property
    def mean(self) -> Array:
        """Mean of M in N m, (n,)."""
        return self._mean_of(self.M)

    def _mean_of(self, torque: Array) -> Array:
        mean = self.pieces.mean(torque)
        return np.where(np.abs(mean) > _ROUNDING * self.pieces.largest(torque), mean, 0.0)

    # the load

    @cached_property
    def deficit(self) -> Array:
        """Mean of M less that of a load by points in N m, (n,); 0 where they agree, and for another load."""
        if self.diagram is None:
            return np.zeros_like(self.mean)
        given = self._mean_of(self._diagram_samples)
        return np.where(
            np.abs(self.mean - given) > _BALANCED * np.maximum(np.abs(given), np.abs(self.mean)), self.mean - given, 0.0
        )

    @cached_property
    def _diagram_samples(self) -> Array:
        assert self.diagram
        return self.diagram.at(self.pieces.degrees, self.pieces.middle, self.pieces.machine)

    @cached_property
    def load(self) -> Array:
        """The load in N m at the nominal speed: the mean of M, or that by points brought to the same mean."""
        if self.diagram is None:
            return np.broadcast_to(self.pieces.of(self.mean), self.pieces.degrees.shape)
        return np.asarray(self._diagram_samples + self.pieces.of(self.deficit))

    def load_at(self, degrees: Array, within: Array) -> Array:
        """Return the same of one machine at crank angles (k,) in degrees, on the sides of jumps that hold `within`."""
        if self.diagram is None:
            return np.full_like(degrees, self.mean[0])
        return np.asarray(self.diagram.at(degrees, within, np.zeros(len(within), dtype=np.intp)) + self.deficit[0])

    # the masses

    def moves(self, forces: CylinderForces) -> bool:
        """Return whether masses of a cylinder move at a known speed."""
        drive = forces.drive
        return bool(drive.has_inertia and (some(drive.mass != 0) or some(drive.pin_inertia != 0)))

    @cached_property
    def _moving(self) -> list[list[CylinderForces]]:
        """The cylinders whose masses move at a known speed, those together that work alike."""
        return [one for one in self.groups if self.moves(one[0])]

    @property
    def inertia_terms(self) -> list[Term]:
        """The terms of the torque of the moving masses in N m, each with its share of the losses; see `M`."""
        return [Term(self.share(one[0].drive), one, inertia_torque) for one in self._moving]

    @cached_property
    def inertia_torque(self) -> Array:
        """The torque of all moving masses in N m, −½ ω_n² dJ/dφ."""
        return self.sampled([Term(1.0, one, inertia_torque) for one in self._moving])

    @cached_property
    def J_moving(self) -> Array:
        """The reduced moment of inertia Σ m x′² + … in kg m² of the moving masses."""
        return self.sampled([Term(1.0, one, reduced_inertia) for one in self._moving])

    @cached_property
    def J_moving_mean(self) -> Array:
        """Its mean over the cycle, (n,)."""
        return self.pieces.mean(self.J_moving)

    # the excess

    @cached_property
    def excess(self) -> ExcessWork:
        """The excess of the effort over the load at the nominal speed.

        Raises NoSolutionError where the losses leave too little of what drives the machine.
        """
        stands = (self.mean < 0) & (self.machine.efficiency != 1) & self.drives
        self.refused |= stands
        if self.count is None and stands.any():
            raise NoSolutionError(self._why_it_stands(float(self.mean[0])))
        return ExcessWork(self, self.M - self.load)

    def _why_it_stands(self, mean: float) -> str:
        """Return why the machine does not run with this negative mean torque in N m, and with which η it would."""
        eta, whole = self.machine.efficiency, float(self._mean_of(self.indicated)[0])
        runs = "with no efficiency"
        if whole >= 0:  # the mean is linear in η
            least = 1 - (1 - eta) * whole / (whole - mean)
            printed = next(one for digits in range(4, 17) if (one := round(least, digits)) >= least)
            runs = f"from 'efficiency: {printed}' on"
        return (
            f"the machine cannot run: with the efficiency {eta:g} its driving pistons give a mean torque that is "
            f"{show(-mean, 'torque')} less than driven pistons and friction take; it runs {runs}"
        )

    @cached_property
    def true_excess(self) -> ExcessWork:
        """The excess that changes the kinetic energy: with the losses of the effort, but none of the inertia torque."""
        missing = [Term(1 - share, one, torque) for share, one, torque in self.inertia_terms if some(share != 1)]
        return ExcessWork(self, self.excess.torque + self.sampled(missing)) if missing else self.excess


class ExcessWork:
    """The works between the crossings of effort and load; torque: M − M_load in N m, (nodes, pieces)."""

    def __init__(self, effort: TurningEffort, torque: Array) -> None:
        self._effort, self.pieces = effort, effort.pieces
        uneven = self.pieces.largest(torque) > _UNIFORM * self.pieces.largest(effort.M)
        self.torque = np.where(self.pieces.of(uneven), torque, 0.0)

    @cached_property
    def E(self) -> Array:
        """∫ (M − M_load) dφ in J from φ = 0, (nodes, pieces)."""
        pieces = self.pieces
        found = pieces.running(self.torque)
        gained = np.append(found[-1, pieces.first[1:] - 1], found[-1, -1])  # rounding of the mean
        return np.asarray(found - pieces.of(gained) * (pieces.degrees / pieces.cycle))

    @cached_property
    def _to_and_fro(self) -> Array:
        """Work in J of all lobes, each counted positive, (n,): the size of the terms of E."""
        return self.pieces.integral(np.abs(self.torque))

    def at(self, degrees: Array, machine: Indices | None = None) -> Array:
        """Return E in J at crank angles (k,) in degrees of these machines, or of the only one."""
        whose = np.zeros(len(degrees), dtype=np.intp) if machine is None else machine
        found = np.zeros(len(degrees))
        uneven = np.bincount(self.crossings.machine, minlength=self.pieces.count)[whose] > 0
        found[uneven] = self.pieces.at(self.E, whose[uneven], degrees[uneven])
        return np.asarray(unless_cancelled(found, self._to_and_fro[whose]))

    @cached_property
    def crossings(self) -> Angles:
        """Crank angles in degrees at which the effort crosses the load, by a jump or through zero."""
        # an effort that equals the load over a while differs from it by the rounding of the effort
        return self.pieces.zeros(self.torque, self.pieces.largest(self._effort.M))

    @cached_property
    def _heights(self) -> Array:
        """E in J at the crossings."""
        return self.at(self.crossings.degrees, self.crossings.machine)

    def _of_each(self, values: Array) -> Any:
        """Return a list of numbers of the crossings as a tuple, of many machines one each."""
        each = [tuple(one.tolist()) for one in self.crossings._replace(degrees=values).of_each(self.pieces.count)]
        return each[0] if self._effort.count is None else tuple(each)

    @property
    def phi_crossing(self) -> Any:
        """The crossings as a tuple of angles in degrees."""
        return self._of_each(self.crossings.degrees)

    @cached_property
    def lobes(self) -> Any:
        """Work in J of every lobe from one crossing to the next, cyclically; positive ones speed the machine up."""
        machine, heights = self.crossings.machine, self._heights
        following = np.append(heights[1:], 0.0)[: len(heights)]
        last = np.flatnonzero(np.diff(machine, append=-1))
        following[last] = heights[np.flatnonzero(np.diff(machine, prepend=-1))]
        return self._of_each(following - heights)

    @cached_property
    def _summits(self) -> tuple[Array, Array, Array, Array]:
        """Largest and smallest E in J with their angles, the first of equal ones, (n,); nan where E is the same."""
        machine, heights = self.crossings.machine, self._heights
        found = []
        for sign in (1.0, -1.0):
            best = np.full(self.pieces.count, -np.inf)
            np.maximum.at(best, machine, sign * heights)
            reached = np.flatnonzero(sign * heights >= (best - _LEVEL * self._to_and_fro)[machine])
            whose, first = np.unique(machine[reached], return_index=True)
            summit = np.full((2, self.pieces.count), np.nan)
            summit[:, whose] = heights[reached[first]], self.crossings.degrees[reached[first]]
            found += [*summit]
        return found[0], found[1], found[2], found[3]

    @cached_property
    def extremes(self) -> Extremes | None:
        """Largest and smallest E in J with their angles; None where the only machine has no excess."""
        if self._effort.count is None and not len(self.crossings.degrees):
            return None
        high, high_at, low, low_at = map(self._effort.result, self._summits)
        return Extremes(Extreme(high, high_at), Extreme(low, low_at))

    @cached_property
    def dE(self) -> Array:
        """ΔE in J, the largest swing of the excess work, (n,)."""
        high, _, low, _ = self._summits
        return np.nan_to_num(high - low, nan=0.0)


class Diagram:
    """A torque by points, straight between them, that repeats from its last angle on; cycle: of the machine."""

    def __init__(self, points: Effort, cycle: float, count: int) -> None:
        angles, torques = np.array(points.angles), np.array(points.torques)
        self.period, kept = float(angles[-1]), np.diff(angles) > 0
        self._starts, self._torques = angles[:-1][kept], torques[:-1][kept]
        self._rises = np.diff(torques)[kept] / np.diff(angles)[kept]
        every = np.add.outer(np.arange(0.0, cycle, self.period), self._starts).ravel()
        self.breaks = Angles(np.repeat(np.arange(count), len(every)), np.tile(every, count))

    def at(self, degrees: Array, within: Array, machine: Indices) -> Array:
        """Return the torque in N m at crank angles (…, n) in degrees, on the sides of jumps that hold `within` (n,)."""
        turn = self.period * np.floor(within / self.period)
        piece = np.searchsorted(self._starts, within - turn, side="right") - 1
        return np.asarray(self._torques[piece] + self._rises[piece] * (degrees - turn - self._starts[piece]))


class HarmonicTorque:
    """A torque by harmonics, M = mean + Σ c cos νφ + s sin νφ; cycle: of the machine."""

    def __init__(self, given: Harmonics, cycle: float) -> None:
        self._mean = given.mean
        self._orders, cos, sin = np.array(given.terms).T
        self._amplitudes = cos - 1j * sin
        # the nodes of one piece resolve a quarter of the shortest period
        every = np.linspace(0.0, cycle, math.ceil(cycle / 90 * max(1.0, float(self._orders.max()))) + 1)
        self.breaks = Angles(np.zeros(len(every), dtype=np.intp), every)

    def at(self, degrees: Array, within: Array, machine: Indices) -> Array:
        """Return the torque in N m at crank angles (…, n) in degrees."""
        waves = unit_vector(np.multiply.outer(degrees, self._orders)) @ self._amplitudes
        return np.asarray(self._mean + waves.real)


def position(forces: CylinderForces) -> Any:
    """Return by how many degrees the crank of a cylinder lags crank 1.

    Whole cycles are taken off, which is exact; added to a large position an angle would lose digits.
    """
    behind = forces.drive.cylinder.crank_position
    return (
        np.fmod(behind, forces.drive.cycle) if isinstance(behind, np.ndarray) else math.fmod(behind, forces.drive.cycle)
    )
