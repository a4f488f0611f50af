"""The torques on the masses of a shaft line, order by order, and the vibration that they force."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cached_property
from typing import NamedTuple

import numpy as np

from kurbel.arrays import Array, ComplexArray, Flags
from kurbel.crank_angle import unit_vector
from kurbel.errors import UsageError
from kurbel.machine import Machine
from kurbel.machine.shaft_line import GROUNDED, ShaftLine, ShaftMass, ShaftSegment
from kurbel.numerics.arithmetic import unless_cancelled
from kurbel.numerics.pieces import NOWHERE, Pieces, refined
from kurbel.solver.chapters.chain import Chain, ShaftTree, loss, passing, response
from kurbel.solver.chapters.harmonics import amplitudes
from kurbel.solver.drive import Drive
from kurbel.solver.effort import Term, TurningEffort
from kurbel.solver.speed import SpeedLaw
from kurbel.solver.state import State, reduced_inertia

_ROUNDING = 1e-14
"""Of the largest torque on a mass: an order that is smaller is zero."""
_WAVE = 240.0
"""Degrees of the shortest wave that are a polynomial of 16 nodes to 1e-13."""
_ENDLESS = 1e9
"""Torques over those that drive, above which a resonance counts as undamped, since only rounding limits it."""


def shaft_line_of(machine: Machine) -> ShaftLine:
    """Return the shaft line of a machine: the given one, or the two masses of its coupling. Raises UsageError."""
    if machine.shaft:
        return machine.shaft
    coupling, wheel = machine.coupling, machine.flywheel
    if coupling is None:
        what = "write its masses and the segments between them below it, or give a 'coupling' behind a 'flywheel'"
        raise UsageError(f"{machine.name}: no 'shaft' is given; {what}")
    if wheel is None or wheel.inertia is None:
        raise UsageError(
            f"{machine.name}: the mass before the coupling is not known; give 'flywheel' an 'inertia'"
        )
    names = tuple(cylinder.name for cylinder in machine.cylinders)
    cranks = ShaftMass("cranks and flywheel", cylinders=names, flywheel=1.0)
    driven = ShaftMass("driven", coupling.inertia)
    return ShaftLine(
        (cranks, driven), (ShaftSegment(coupling.stiffness, coupling.damping),), load=1
    )


# what acts on the masses


class Excitation(NamedTuple):
    """The torques on n masses in N m, by orders (k,), over their common period of `cycle` degrees.

    M(φ) = M_m + Σ Re(M_ν e^{iνφ}), φ the angle of crank 1.

    gas, inertia: amplitudes (n, k) of what is independent of the speed, and of the inertia forces at ω_n = omega in
    rad/s; means (n,), with the load on the mass that takes it; load_slope: dL/dω of each mass at ω_n in N m s/rad (n,).
    """

    omega: float
    cycle: float
    orders: Array
    gas: ComplexArray
    inertia: ComplexArray
    means: Array
    load_slope: Array


def torques_on(effort: TurningEffort, line: ShaftLine) -> tuple[Array, Array]:
    """Return the torques on the masses in N m, and the part of the inertia forces, (masses, nodes, pieces).

    On the pieces of the effort. Efforts have the losses of the machine, inertia forces none; an effort given in the
    file acts on the first mass. Of a load that varies over the turn they have the variation about its mean.
    """
    torques, of_inertia = np.zeros((2, len(line.masses), *effort.pieces.degrees.shape))
    terms = [*effort.terms, *effort.missing_inertia]
    moving = [term._replace(factor=1.0) for term in effort.inertia_terms]
    for number, mass in enumerate(line.masses):
        torques[number] = effort.sampled(_terms_of(mass, terms))
        of_inertia[number] = effort.sampled(_terms_of(mass, moving))
    if effort.given is not None:
        torques[0] = effort.M
    if effort.diagram:
        torques[line.load] -= effort.load - effort.mean
    return torques, of_inertia


def _terms_of(mass: ShaftMass, terms: Sequence[Term]) -> list[Term]:
    """Return the terms of the torque, restricted to the cylinders whose cranks are at this mass."""
    of_mass = list[Term]()
    for term in terms:
        cylinders = [
            cylinder for cylinder in term.cylinders if cylinder.drive.name in mass.cylinders
        ]
        if cylinders:
            of_mass.append(term._replace(cylinders=cylinders))
    return of_mass


def excitation(effort: TurningEffort, line: ShaftLine, orders: Array) -> Excitation:
    """Return what acts on the masses of a shaft line, order by order; the load takes the mean of all torques."""
    torques, of_inertia = torques_on(effort, line)

    # order by order, gas and inertia in one analysis; [..., 0] is the only machine
    parts = np.concatenate((torques - of_inertia, of_inertia))
    acting = parts.any(axis=(1, 2))
    by_order = np.zeros((len(parts), len(orders)), complex)
    by_order[acting] = amplitudes(effort.pieces, parts[acting], orders)[..., 0]
    by_order = unless_cancelled(by_order, np.abs(parts).max(axis=(1, 2))[:, None], _ROUNDING)
    gas, inertia = np.split(by_order, 2)

    # the load takes the mean, and falls or rises with the speed
    means = effort.mean_of(torques)[:, 0]
    if not line.is_held:
        means[line.load] -= means.sum()
    omega = effort.omega or 0.0
    law = SpeedLaw.of(effort)
    load_slope = np.zeros(len(torques))
    if law:
        load_slope[line.load] = law.steepness[0] / omega
    return Excitation(omega, effort.cycle, orders, gas, inertia, means, load_slope)


# forced vibration


class Vibration:
    """The forced vibration of a chain at angular velocities (s,) in rad/s, order by order.

    driving, angles: amplitudes (n, s, k) in N m and in rad of the cranks' shaft. sections: the places along the shaft
    whose torques are computed, each a segment and a share of its length: the two ends and the middle of a segment that
    has inertia, else one. torques (sections, s, k) in N m, true ones on both sides of a gear. endless (s,): true
    where an order is at a natural frequency without damping; the torques are then infinite.
    """

    def __init__(self, chain: Chain, line: ShaftLine, acting: Excitation, omegas: Array) -> None:
        self.chain, self.line, self.acting, self.omegas = chain, line, acting, omegas
        self.driving = (
            acting.gas[:, None] + acting.inertia[:, None] * ((omegas / acting.omega) ** 2)[:, None]
        )
        self._frequencies = np.multiply.outer(omegas, acting.orders)
        # the load takes the same mean torque at every speed, so that its slope goes with 1/ω; (n, s, 1)
        self._load_damping = np.multiply.outer(acting.load_slope, acting.omega / omegas)[..., None]
        self.angles = response(chain, self._frequencies, self.driving, self._load_damping)
        self.ratios = np.array([segment.ratio for segment in line.segments])
        self.sections = _sections(line)
        passed = passing(chain, self._frequencies, self.angles, self.sections)
        self._segments = np.array([segment for segment, _ in self.sections])
        self.torques = passed / self.ratios[self._segments][:, None, None]
        largest, driving = (np.abs(torques).max(axis=(0, 2)) for torques in (passed, self.driving))
        self.endless: Flags = np.isfinite(driving) & ~(largest <= _ENDLESS * driving)

    @cached_property
    def means(self) -> Array:
        """Mean torques in the segments in N m."""
        return mean_torques(self.chain, self.acting.means) / self.ratios

    def _turns(self, count: int) -> Pieces:
        """Return the turns of so many machines in equal pieces, on each of which the waves are polynomials."""
        pieces = Pieces.between(NOWHERE, count, self.acting.cycle)
        parts = math.ceil(2 * pieces.half.max() * self.acting.orders.max() / _WAVE)
        return pieces.parted(np.full(len(pieces.half), parts))

    @cached_property
    def swings(self) -> tuple[Pieces, Array]:
        """The torques less their mean in N m over the turn, (sections, s, nodes, pieces)."""
        orders, pieces = self.acting.orders, self._turns(1)
        # at a node the waves are those at the beginning of its piece times those of a piece from there on
        inside = unit_vector(np.multiply.outer(pieces.half[0] * (1 + pieces.rule.nodes), orders))
        begin = unit_vector(np.multiply.outer(orders, pieces.low))
        return pieces, ((self.torques[:, :, None] * inside) @ begin).real

    @cached_property
    def _amplitudes(self) -> Array:
        """Half peak-to-peak torques in N m, (sections, s)."""
        torques, turns = self.swings[1], self._turns(self.swings[1].shape[1])
        amplitudes = np.empty(torques.shape[:2])
        for section, swing in enumerate(torques):
            # each speed is searched as a machine of its own; (s, nodes, pieces) -> (1, nodes, s · pieces)
            row = np.swapaxes(swing, 0, 1).reshape(1, swing.shape[1], -1)
            ends = turns.extremes(row)
            amplitudes[section] = (ends.largest[0] - ends.smallest[0]) / 2
        return np.where(np.isfinite(self.torques).all(axis=2), amplitudes, math.nan)

    @property
    def vibratory(self) -> Array:
        """Half peak-to-peak torques in the segments in N m, where each is largest, (segments, s)."""
        largest = np.zeros((len(self.ratios), len(self.omegas)))
        np.maximum.at(largest, self._segments, self._amplitudes)
        return largest

    @property
    def decisive(self) -> list[int]:
        """Of each segment the section whose torque swings most at the first speed."""
        amplitudes = np.nan_to_num(self._amplitudes[:, 0])
        decisive = list[int]()
        for segment in range(len(self.ratios)):
            sections = np.flatnonzero(self._segments == segment)
            decisive.append(int(sections[amplitudes[sections].argmax()]))
        return decisive

    @property
    def loss(self) -> Array:
        """Mean power in W lost in dampers, in the material, and in a load that rises with the speed, (s,)."""
        speeds = np.abs(self._frequencies * self.angles) ** 2
        damping = self.chain.mass_damping[:, None, None] + self._load_damping
        of_masses = (damping * speeds).sum(axis=(0, 2)) / 2
        return of_masses + loss(self.chain, self._frequencies, self.angles).sum(axis=(0, 2))


def _sections(line: ShaftLine) -> list[tuple[int, float]]:
    """Return the sections of a line whose torques are computed: of each its segment and the share before it."""
    sections = list[tuple[int, float]]()
    for segment, of_shaft in enumerate(line.segments):
        shares = (0.0, 0.5, 1.0) if of_shaft.inertia else (0.0,)
        sections += [(segment, share) for share in shares]
    return sections


def mean_torques(chain: Chain, means: Array) -> Array:
    """Return the mean torques in N m that the segments carry, (segments,), of mean torques on the masses (n,)."""
    torques = np.zeros(len(chain.joins))
    fixed = chain.fixed_segments
    tree = ShaftTree(chain, fixed[-1] if fixed else None)
    # with one fixed end, or none, each segment carries what acts beyond it
    beyond = means.astype(float)
    for mass in tree.leaves_first:
        link = tree.links[mass]
        if link is None:
            continue
        torques[link.segment] = beyond[mass] if link.onward else -beyond[mass]
        if link.parent != GROUNDED:
            beyond[link.parent] += beyond[mass]
    if len(fixed) < 2:
        return torques

    # what flows from each other fixed end to that of the root is such that the twists on its way add up to nothing
    ways = np.zeros((len(fixed) - 1, len(torques)))
    for way, segment in zip(ways, fixed):
        way[segment] = 1.0 if chain.joins[segment][0] == GROUNDED else -1.0
        for _, link in tree.path_to_root(max(chain.joins[segment])):
            assert link is not None
            way[link.segment] = 1.0 if link.onward else -1.0
    stiffness = ways / chain.stiffnesses @ ways.T
    return torques - ways.T @ np.linalg.solve(stiffness, ways @ (torques / chain.stiffnesses))


def mean_inertia(drive: Drive) -> float:
    """Return the mean over the turn of the reduced moment of inertia of a cylinder in kg m², whatever forces act."""
    pieces, inertia = refined(
        drive.pieces, lambda pieces: reduced_inertia(State.on(drive, pieces))[None]
    )
    return float(pieces.mean(inertia[0])[0])
