"""The turning effort of the whole machine: every cylinder's torque, shifted by its crank, over the common cycle."""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from kurbel.crank_angle import CrankAngle
from kurbel.numerics.arithmetic import running_sums
from kurbel.numerics.grid import Grid
from kurbel.numerics.jet import Jet
from kurbel.numerics.legendre import legendre
from kurbel.solver.cylinder.drive import Drive
from kurbel.solver.cylinder.forces import CylinderForces
from kurbel.solver.cylinder.rod import ExactRod
from kurbel.solver.cylinder.state import State
from kurbel.solver.pressure.card import ProcessPressure
from kurbel.solver.turning.card_work import CardWork
from kurbel.solver.turning.torques import exact_product

if TYPE_CHECKING:
    from kurbel.arrays import Array


class _Shifted:
    """What belongs to one cylinder, at the crank angles φ of crank 1: its own crank stands at φ − position."""

    def __init__(self, forces: CylinderForces, cycle: float) -> None:
        self.drive: Drive = forces.drive
        # whole cycles off, which is exact: beside a large position an angle would lose its digits
        self.position = math.fmod(forces.drive.cylinder.crank_position, self.drive.cycle)
        own = forces.grid.breaks[:-1] + self.position
        repeated = np.concatenate([own + turn for turn in np.arange(0.0, cycle, self.drive.cycle)])
        self.breaks: Array = np.concatenate(([0.0], np.sort(np.mod(repeated, cycle)), [cycle]))

    def angle(self, degrees: Array) -> CrankAngle:
        """Return the cylinder's own crank angle when crank 1 stands at `degrees` (n,), what rounding takes included."""
        own = degrees - self.position
        shift = own - degrees
        lost = (degrees - (own - shift)) - (self.position + shift)
        return CrankAngle.of(own, lost)

    def state(self, degrees: Array, within: Array) -> State:
        """Return the cylinder's state, with slopes, when crank 1 stands at `degrees` (n,)."""
        return self.drive.jets_at(degrees - self.position, within - self.position)


class InertiaEffort(_Shifted):
    """The torque of a cylinder's inertia forces at uniform rotation, Tolle's inertia line: −½ ω² dJ/dφ.

    J = m x′², and what an exact connecting rod adds to it.
    """

    @property
    def _square(self) -> float:
        return (self.drive.omega or 0.0) ** 2

    def torque(self, degrees: Array, within: Array) -> Jet:
        """Return the torque; see `Torque`."""
        torque: Jet = self.torque_in(self.state(degrees, within))
        return torque

    def torque_in(self, state: State) -> Any:
        """Return the torque in N m in a state: −m x′ x″ ω², less the couple of an exact rod times ψ′."""
        torque = state.slope * state.curvature * (-self.drive.mass * self._square)
        rod, rod_angle = self.drive.rod, self.drive.mechanism.rod_angle(state.angle)
        if rod is None or rod_angle is None:
            return torque
        return torque - rod.couple(rod_angle, state.angle) * rod.swing_slope(rod_angle, state.angle)

    def work(self, low: Array, high: Array) -> Array:
        """Return −½ ω² times what J gains; see `Torque`."""
        at_low, at_high = self.angle(low), self.angle(high)
        slopes = [self.drive.mechanism.slope(angle) for angle in (at_low, at_high)]
        terms = [self.drive.mass * _square_gain(*slopes)]
        if self.drive.rod is not None:
            swings = [self._swing(self.drive.rod, angle) for angle in (at_low, at_high)]
            terms.append(self.drive.rod.excess_inertia * _square_gain(*swings))
        return np.stack(terms) * (-self._square / 2)

    def _swing(self, rod: ExactRod, angle: CrankAngle) -> Array:
        rod_angle = self.drive.mechanism.rod_angle(angle)
        assert rod_angle is not None
        return np.asarray(rod.swing_slope(rod_angle, angle))

    def reduced_inertia(self, degrees: Array, within: Array) -> Jet:
        """Return J in kg m²: what the moving masses, connecting rods included, add to the inertia of the shaft."""
        state = self.state(degrees, within)
        inertia: Jet = state.slope * state.slope * self.drive.mass + self.drive.pin_inertia
        rod, rod_angle = self.drive.rod, self.drive.mechanism.rod_angle(state.angle)
        if rod is not None and rod_angle is not None:
            inertia = inertia + rod.reduced_inertia(rod_angle, state.angle)
        return inertia


def _square_gain(low: Array, high: Array) -> Array:
    """Return high² − low² without their cancellation."""
    return (high - low) * (high + low)


class CylinderEffort(_Shifted):
    """The torque of one cylinder: gas, inertia, weight and friction."""

    def __init__(self, forces: CylinderForces, cycle: float) -> None:
        super().__init__(forces, cycle)
        self._inertia = InertiaEffort(forces, cycle) if self.drive.has_inertia else None
        self._own_grid = forces.grid

    def torque(self, degrees: Array, within: Array) -> Jet:
        """Return the torque; see `Torque`."""
        torque: Jet = self.state(degrees, within).M
        return torque

    def work(self, low: Array, high: Array) -> Array:
        """Return the work of everything that turns the crank; see `Torque`.

        Cards, masses, weight and rings are closed; measured traces and the crosshead's friction go by Gauss.
        """
        terms = [np.zeros((1, len(low)))]
        if self._inertia:
            terms.append(self._inertia.work(low, high))
        own_low, own_high = self.angle(low), self.angle(high)
        terms += self._gas_work(own_low, own_high)
        terms += self._along_the_way(own_low, own_high)
        if self._open:
            terms.append(self._open.work(own_low.degrees, own_high.degrees))
        return np.concatenate(terms)

    def _gas_work(self, low: CrankAngle, high: CrankAngle) -> list[Array]:
        stroke = self.drive.mechanism.stroke
        # the works of the chambers are large beside their excess over the mean: their products are not rounded yet
        return [exact_product(work.between(low, high), area * stroke) for area, work in self._cards]

    @cached_property
    def _cards(self) -> tuple[tuple[float, CardWork], ...]:
        """Piston area and work of every chamber; none where the pressure of any does not hang on the displacement."""
        chambers = [
            (area, pressure)
            for gas in self.drive.gas
            for area, pressure in ((gas.piston.head_area, gas.head), (gas.piston.crank_area, gas.crank))
            if pressure is not None
        ]
        closed = tuple((area, CardWork(p)) for area, p in chambers if isinstance(p, ProcessPressure))
        return closed if len(closed) == len(chambers) else ()

    def _along_the_way(self, low: CrankAngle, high: CrankAngle) -> list[Array]:
        """Return the work of the weight, and of the rings on the way of the piston."""
        drive = self.drive
        terms = []
        if drive.weight:
            rise = np.diff([drive.mechanism.coordinate(end) for end in (low, high)], axis=0)
            terms.append(drive.weight[0] * rise)
        if drive.ring_force:
            terms.append(-drive.ring_force * np.diff([self._way(end) for end in (low, high)], axis=0))
        return terms

    def _way(self, angle: CrankAngle) -> Array:
        """Return the way in m that the piston has run, to and fro, since an inner dead centre."""
        mechanism = self.drive.mechanism
        inner, outer = mechanism.dead_centres()
        turns, since = np.divmod(angle.degrees - inner, 360.0)
        x = mechanism.coordinate(angle) - mechanism.start
        return np.asarray(2 * mechanism.stroke * turns + np.where(since < outer - inner, x, 2 * mechanism.stroke - x))

    @cached_property
    def _open(self) -> _GaussWork | None:
        """The torque that has no closed work: crosshead friction, traces, a ram; None without anything of the kind."""
        grid = self._own_grid
        rest, whole = self._rest(grid.degrees, grid.within), self.drive.jets_at(grid.degrees, grid.within).M.value
        if np.abs(rest).max() <= 1e-12 * np.abs(whole).max():
            return None
        return _GaussWork(grid, rest)

    def _rest(self, degrees: Array, within: Array) -> Array:
        """Return the torque less that of everything whose work is closed."""
        state = State(self.drive, CrankAngle.of(degrees), within)
        closed = -self.drive.ring_force * state.direction
        for force in (state.P_weight, state.P_gas if self._cards else None):
            closed = closed if force is None else closed + force
        inertia = self._inertia.torque_in(state) if self._inertia else 0.0
        return np.asarray(state.M - closed * state.slope - inertia)


class _GaussWork:
    """∫ M dφ of a torque in N m that is smooth on the pieces of a grid over one cycle.

    On every piece the polynomial through the points of its rule is integrated: up to the end of the piece that is
    the rule itself.
    """

    def __init__(self, grid: Grid, torque: Array) -> None:
        self._breaks = grid.breaks
        used = grid.weights != 0
        self._count = int(used.sum())
        order = np.arange(self._count)
        squares = 2 / (2 * order + 1)
        if grid.weights[0]:
            squares[-1] = 2 / order[-1]  # the rule of Lobatto: P_{N−1}² summed over its points
        at_nodes = legendre(grid.nodes[used], self._count - 1) * grid.weights[used][:, None]
        self._coefficients = torque[:, used] @ (at_nodes / squares)
        whole = (2 * self._coefficients[:, 0] * self._half_widths).tolist()
        self._up_to = np.array([0.0, *(total for total, _ in running_sums((one,) for one in whole))])

    @property
    def _half_widths(self) -> Array:
        return np.asarray(np.radians(np.diff(self._breaks)) / 2)

    def work(self, low: Array, high: Array) -> Array:
        """Return the work between angles (n,) in degrees as terms (k, n)."""
        (turns_low, up_low, part_low), (turns_high, up_high, part_high) = map(self._at, (low, high))
        return np.stack((self._up_to[-1] * (turns_high - turns_low), up_high - up_low, part_high - part_low))

    def _at(self, degrees: Array) -> tuple[Array, Array, Array]:
        turns, angle = np.divmod(degrees, self._breaks[-1])
        piece = np.clip(np.searchsorted(self._breaks, angle, side="right") - 1, 0, len(self._breaks) - 2)
        low, high = self._breaks[piece], self._breaks[piece + 1]
        p = legendre(2 * (angle - low) / (high - low) - 1, self._count)
        # ∫ P_n from −1 to x is (P_{n+1} − P_{n−1})/(2n + 1), with P_{−1} = −1
        below = np.concatenate((-np.ones_like(p[:, :1]), p[:, :-2]), axis=1)
        integrals = (p[:, 1:] - below) / (2 * np.arange(self._count) + 1)
        return turns, self._up_to[piece], self._half_widths[piece] * (self._coefficients[piece] * integrals).sum(axis=1)
