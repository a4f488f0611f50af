"""Turning effort M of the whole machine over the angle φ of crank 1, its load, and the excess work.

    M(φ) = Σ share_k M_k(φ − δ_k)        M_k = R T (R 303) of cylinder k, whose crank angle lags by δ_k (R p. 612);
                                         share: factor for the efficiency
    E(φ) = ∫₀^φ (M − M_load) dφ          excess work; ΔE = E_max − E_min (R p. 612)
    J(φ) = Σ m x′² + …                   reduced moment of inertia of the moving masses

The common pieces of the machine are cut at the ends of the pieces of all cylinders. Each cylinder is sampled on its own
pieces, and its polynomials are evaluated on the common ones. Of identical cylinders only one is sampled.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from kurbel.arrays import Array, Flags, Indices, Number, Truth
from kurbel.declared.unit_systems import show
from kurbel.errors import NoSolutionError, UsageError
from kurbel.machine import Machine
from kurbel.numerics.arithmetic import some, unless_cancelled, where
from kurbel.numerics.pieces import Angles, Pieces, SampledExtremes, common
from kurbel.solver.drive import Drive, any_of
from kurbel.solver.forces import CylinderForces
from kurbel.solver.state import State, reduced_inertia

if TYPE_CHECKING:
    from kurbel.machine.shaft_side import KnownDiagram

_SLOWEST = 1e-100
"""Revolutions per second below which, and above whose inverse, kinetic energies leave the range of floats."""
_ROUNDING = 1e-13
"""Relative to the largest torques of all cylinders: a smaller mean, as that of masses without gas, is rounding."""
_CANCELLED = 4e-14
"""Relative to the terms of a sum: if the sum is smaller over the whole cycle, the terms cancel."""
_UNIFORM = 1e-14
"""Relative to the largest torque: load and effort that differ by less over the whole cycle are equal."""
_BALANCED = 1e-9
"""Relative difference below which the means of effort and load are equal."""


def torque_of_inertia(state: State) -> Any:
    """Return the torque −m x′ x″ ω² in N m of the inertia forces at uniform rotation, −½ ω² dJ/dφ (Tolle).

    An exact rod adds its couple times −ψ′.
    """
    rod, omega = state.drive.rod, state.drive.omega
    assert omega is not None
    torque = state.slope * state.curvature * (-state.drive.mass * omega * omega)
    if state.drive.cylinder.link_rod is not None:
        torque = torque + state.knuckle_inertia_torque
    if rod is None:
        return torque
    return torque - state.rod_couple * state.rod_slope


def position(forces: CylinderForces) -> Number:
    """Return the degrees by which a crank lags crank 1, without whole cycles, which would cost digits."""
    return np.fmod(forces.drive.lag, forces.drive.cycle)


def moves(group: Sequence[CylinderForces]) -> bool:
    """Return whether identical cylinders have moving masses and a speed."""
    drive = group[0].drive
    masses = (drive.mass, drive.pin_inertia, drive.knuckle_mass)
    has_mass = any(some(mass != 0) for mass in masses)
    return bool(drive.has_inertia and has_mass)


class Term(NamedTuple):
    """A torque of each of several identical cylinders; factor: a number, or (machines,), by which it is multiplied."""

    factor: Number
    cylinders: Sequence[CylinderForces]
    quantity: Callable[[State], Number] = lambda state: state.M


class TurningEffort:
    """The turning effort of a machine, or of `count` machines of one kind, over their common cycle in degrees.

    Samples are (nodes, pieces) at the nodes of `pieces`, numbers are (machines,), of one machine (1,).
    swing: ΔE in J without losses, for an effort given by this fluctuation of energy alone, else None.
    refused: True for those of many machines (machines,) that have no result, complete once `pieces` and `excess` are
    computed. For one machine these raise errors instead: `pieces` where no torque acts and where the speed is beyond
    floats, `excess` where the machine cannot run.
    """

    def __init__(
        self, machine: Machine, cylinders: Sequence[CylinderForces], count: int | None = None
    ) -> None:
        self.machine, self.cylinders, self.count = machine, tuple(cylinders), count
        self.refused: Flags = np.zeros(count or 1, dtype=bool)
        self.cycle = 360.0 * machine.revolutions
        self.diagram = machine.load.diagram if machine.load else None
        self.omega: Any = None if machine.speed is None else 2 * math.pi * machine.speed
        self.swing: Any = None
        if machine.effort and machine.effort.alone:
            self.swing = machine.effort.energy(machine.revolutions)
        # cylinders in which a force acts, identical ones in one group
        groups: dict[CylinderForces, list[CylinderForces]] = {}
        for forces in cylinders:
            if forces.drive.has_force:
                groups.setdefault(forces.twin or forces, []).append(forces)
        self.groups = list(groups.values())
        # groups with moving masses and a speed
        self._moving = [group for group in self.groups if moves(group)]

    def result(self, values: Array) -> Any:
        """Return values (machines,), nan for refused machines; for one machine a float."""
        if self.count is None:
            return float(values[0])
        return np.where(self.refused, np.nan, values)

    @cached_property
    def pieces(self) -> Pieces:
        """The cycle in pieces on which every torque is a polynomial. Raises UsageError where no force acts."""
        name, count = self.machine.name, self.count or 1
        if not self.groups and not self.machine.effort:
            raise UsageError(
                f"{name}: no force acts, so there is no torque; kurbel check shows why"
            )
        self._refuse_speeds()

        # cut at the points of a torque and of a load that are given over the angle
        points: list[Array] = [np.zeros(0)]
        for diagram in (self.machine.effort, self.diagram):
            if diagram:
                from kurbel.solver.given_torque import corners

                points.append(corners(diagram, self.cycle))
        breaks = np.concatenate(points)
        cuts = Angles(np.repeat(np.arange(count), len(breaks)), np.tile(breaks, count))
        if not self.groups:
            return Pieces.between(cuts, count, self.cycle)

        # and where the forces of any cylinder bend
        parts = []
        for group in self.groups:
            parts += [(group[0].pieces, position(cylinder)) for cylinder in group]
        return common(parts, self.cycle).split(cuts)

    def _refuse_speeds(self) -> None:
        """Refuse machines with a speed that is beyond floats; raise UsageError for the only one."""
        speed = self.machine.speed
        if speed is None:
            return
        is_beyond = (speed != 0) & ((speed <= _SLOWEST) | (speed >= 1 / _SLOWEST))
        self.refused |= is_beyond
        if self.count is None and is_beyond:
            size = "large" if speed > 1 else "small"
            raise UsageError(
                f"{self.machine.name}: a speed of {show(speed, 'speed')} is too {size} to compute with"
            )

    def sampled(self, terms: Sequence[Term]) -> Array:
        """Return the sum of the terms on the common pieces; exactly 0 in machines where the terms cancel."""
        return self._sampled_with_size(terms)[0]

    def _sampled_with_size(self, terms: Sequence[Term]) -> tuple[Array, Array]:
        """Return the sum of the terms as `sampled` does, and the sum of their largest values (machines,)."""
        pieces = self.pieces
        size = np.zeros(pieces.count)
        summed = pieces.filled(0.0)
        for factor, cylinders, torque in terms:
            source = cylinders[0].pieces
            values = source.filled(torque(cylinders[0].samples)) * source.of(factor)
            size = size + len(cylinders) * source.largest(values)
            for cylinder in cylinders:
                summed = summed + pieces.resampled(values, source, position(cylinder))
        is_left = unless_cancelled(pieces.largest(summed), size, _CANCELLED) != 0
        if not is_left.all():
            summed = np.where(pieces.of(is_left), summed, 0.0)
        return summed, size

    def at(
        self,
        pieces: Pieces,
        values: Array,
        degrees: Array,
        within: Array,
        machine: Indices | None = None,
    ) -> Array:
        """Return samples at crank angles (k,), on the sides of jumps that hold `within`.

        machine: of each angle, (k,), where there are many. What is rounding of their largest value is 0.
        """
        numbers = np.zeros(len(degrees), dtype=np.intp) if machine is None else machine
        at_angles = pieces.at(values, numbers, degrees, within)
        return unless_cancelled(at_angles, pieces.largest(values)[numbers], _CANCELLED)

    # the effort

    @cached_property
    def given(self) -> Array | None:
        """The effort in N m that is known from elsewhere, without losses; None where cylinders give it."""
        if not self.machine.effort:
            return None
        return _torque_on(self.machine.effort, self.pieces)

    @cached_property
    def drives(self) -> Truth:
        """Whether any piston drives; for a given effort, whether its mean does."""
        if self.given is not None:
            return self.result(self.mean_of(self.given)) >= 0
        return any_of(group[0].drive.drives for group in self.groups)

    def share(self, drive: Drive | None) -> Number:
        """Return what the torque of a cylinder, or a given effort, is multiplied by for the losses (R p. 611–613).

        η where its pistons drive, 1/η where the machine is driven and no piston drives. In a machine with driving
        pistons the driven ones count in full. On a rod with both the factor is 1, and `lost` subtracts the loss of the
        driving ones.
        """
        eta = self.machine.efficiency
        if not some(eta != 1):
            return eta
        if drive is None:
            return where(self.drives, eta, 1 / eta)
        driven = any_of(group[0].drive.driven for group in self.groups)
        alone = drive.drives & np.logical_not(drive.driven)
        return where(self.drives, where(alone, eta, 1.0), where(driven, 1 / eta, 1.0))

    def lost(self, group: Sequence[CylinderForces]) -> list[Term]:
        """Return the loss, at most one term, of driving pistons that share their rods with driven ones; see `share`."""
        drive = group[0].drive
        factor = where(drive.drives & drive.driven, self.machine.efficiency - 1.0, 0.0)
        if not some(factor != 0):
            return []
        return [Term(factor, group, lambda state: state.driving_force * state.slope)]

    @cached_property
    def terms(self) -> list[Term]:
        """The terms of M with the losses of the machine."""
        terms = [Term(self.share(group[0].drive), group) for group in self.groups]
        for group in self.groups:
            terms += self.lost(group)
        return terms

    @cached_property
    def _effort_with_size(self) -> tuple[Array, Array]:
        """M, and in N m (machines,) the sum of the largest values of its terms, which may all but cancel."""
        if self.given is None:
            return self._sampled_with_size(self.terms)
        torque = self.given * self.pieces.of(self.share(None))
        return torque, self.pieces.largest(torque)

    @property
    def M(self) -> Array:
        """The turning effort in N m, with the losses of the machine; see `share`."""
        return self._effort_with_size[0]

    @cached_property
    def mean(self) -> Array:
        """Mean of M in N m, (machines,); 0 where nothing but rounding is left of those of all cylinders."""
        torque, size = self._effort_with_size
        return unless_cancelled(self.pieces.mean(torque), size, _ROUNDING)

    def mean_of(self, torque: Array) -> Array:
        """Return means in N m (…, machines) of torques (…, nodes, pieces); 0 where nothing but rounding is left."""
        return unless_cancelled(self.pieces.mean(torque), self.pieces.largest(torque), _ROUNDING)

    # the load

    @cached_property
    def load(self) -> Array:
        """The load in N m at the nominal speed: the mean of M, or that by points brought to the same mean."""
        level = self.pieces.filled(self.pieces.of(self.mean))
        if self.diagram is None:
            return level
        torque = _torque_on(self.diagram, self.pieces)
        return level + (torque - self.pieces.of(self.pieces.mean(torque)))

    @property
    def deficit(self) -> Array:
        """Mean of M less that of a load by points in N m, (machines,); 0 where they agree, and for another load."""
        load = self.mean
        if self.diagram:
            load = self.pieces.mean(_torque_on(self.diagram, self.pieces))
        size = np.maximum(np.abs(load), np.abs(self.mean))
        return unless_cancelled(self.mean - load, size, _BALANCED)

    # the masses

    @property
    def inertia_terms(self) -> list[Term]:
        """The terms of the torque of the moving masses in N m, each with its share of the losses; see `M`."""
        return [
            Term(self.share(group[0].drive), group, torque_of_inertia) for group in self._moving
        ]

    @cached_property
    def inertia_torque(self) -> Array:
        """The torque of all moving masses in N m, −½ ω_n² dJ/dφ, without losses."""
        return self.sampled([Term(1.0, group, torque_of_inertia) for group in self._moving])

    @cached_property
    def J_moving(self) -> Array:
        """The reduced moment of inertia Σ m x′² + … in kg m² of the moving masses."""
        return self.sampled([Term(1.0, group, reduced_inertia) for group in self._moving])

    # the excess

    @cached_property
    def excess(self) -> ExcessWork:
        """The excess of the effort over the load at the nominal speed.

        Raises NoSolutionError where the losses leave too little of what drives the machine.
        """
        gets_too_little = (self.mean < 0) & (self.machine.efficiency != 1) & self.drives
        self.refused |= gets_too_little
        if self.count is None and gets_too_little.any():
            raise self._no_effort()
        return self._excess_by(self.M - self.load)

    def _no_effort(self) -> NoSolutionError:
        """Return the error of a machine that cannot run, with the efficiency from which on it can."""
        eta, mean = self.machine.efficiency, float(self.mean[0])
        without_losses = self.given
        if without_losses is None:
            without_losses = self.sampled([Term(1.0, group) for group in self.groups])
        full_mean = float(self.mean_of(without_losses)[0])
        runs = "with no efficiency"
        if full_mean >= 0:  # the mean is linear in η
            least = 1 - (1 - eta) * full_mean / (full_mean - mean)
            shown = (round(least, digits) for digits in range(4, 17))
            enough = next(efficiency for efficiency in shown if efficiency >= least)
            runs = f"from 'efficiency: {enough}' on"
        return NoSolutionError(
            f"the machine cannot run: with the efficiency {eta:g} its driving pistons give a mean torque that is "
            f"{show(-mean, 'torque')} less than driven pistons and friction take; it runs {runs}"
        )

    def _excess_by(self, torque: Array) -> ExcessWork:
        swing = None if self.swing is None else self.swing * self.share(None)
        return ExcessWork(self.pieces, torque, self.pieces.largest(self.M), swing)

    @property
    def missing_inertia(self) -> list[Term]:
        """What the losses take off the torque of the moving masses: η holds for it, too, but not for kinetic energy."""
        return [
            Term(1 - share, group, quantity)
            for share, group, quantity in self.inertia_terms
            if some(share != 1)
        ]

    @cached_property
    def true_excess(self) -> ExcessWork:
        """The excess that changes the kinetic energy: losses do not reduce its share of the moving masses."""
        missing = self.missing_inertia
        if not missing:
            return self.excess
        return self._excess_by(self.excess.torque + self.sampled(missing))


class ExcessWork:
    """The works between the crossings of effort and load.

    torque: M − M_load in N m, E: its integral in J over φ from 0 on, (nodes, pieces); size: (machines,), of M; swing:
    ΔE in J where it alone is known.
    """

    def __init__(self, pieces: Pieces, torque: Array, size: Array, swing: Number | None) -> None:
        self.pieces, self._size, self._swing = pieces, size, swing
        is_uneven = pieces.largest(torque) > _UNIFORM * size
        self.torque = torque
        if not is_uneven.all():
            self.torque = np.where(pieces.of(is_uneven), torque, 0.0)
        running = pieces.running(self.torque)
        # what is gained in a cycle, by the rounding of the mean, is taken off evenly
        gained = np.append(running[-1, pieces.first[1:] - 1], running[-1, -1])
        self.E = np.asarray(running - pieces.of(gained / pieces.cycle) * pieces.degrees)

    @cached_property
    def crossings(self) -> Angles:
        """Crank angles in degrees at which the effort crosses the load, by a jump or through zero."""
        # an effort that equals the load over a while differs from it by the rounding of the effort
        return self.pieces.zeros(self.torque, self._size)

    @cached_property
    def lobes(self) -> Array:
        """Work in J of every lobe from its crossing to the next, cyclically; positive ones speed the machine up."""
        machine = self.crossings.machine
        heights = self.pieces.at(self.E, *self.crossings)
        following = np.roll(heights, -1)
        # the last crossing of each machine is followed by its own first one
        first = np.flatnonzero(np.diff(machine, prepend=-1))
        last = np.flatnonzero(np.diff(machine, append=-1))
        following[last] = heights[first]
        return following - heights

    @cached_property
    def summits(self) -> SampledExtremes:
        """Largest and smallest E in J with their angles, the first of equal ones, (1, n); nan where E is the same."""
        size = self.pieces.integral(np.abs(self.torque))  # work of all lobes, each counted positive
        extremes = self.pieces.extremes(self.E[None], size[None])
        return SampledExtremes(*(np.where(size == 0, np.nan, values) for values in extremes))

    @cached_property
    def dE(self) -> Array:
        """ΔE in J, the largest swing of the excess work, (machines,)."""
        if self._swing is not None:
            return np.ones(self.pieces.count) * self._swing
        return np.nan_to_num(self.summits.largest[0] - self.summits.smallest[0], nan=0.0)


def _torque_on(diagram: KnownDiagram, pieces: Pieces) -> Array:
    """Return a torque that is given over the angle at the nodes of pieces, in N m."""
    from kurbel.solver.given_torque import torque_on

    return torque_on(diagram, pieces)
