"""An elastic coupling between the crankshaft and a driven inertia: two inertias and a spring with damping.

        M →  [J₁]──k, d──[J₂]  ← M_load        T = k (θ₁ − θ₂) + d (ω₁ − ω₂)  the torque in the coupling

    J₁ ω̇₁ = M − T        J₂ ω̇₂ = T − M_load(ω₂)        d/dt = ω_n d/dφ

It is the shortest chain of `kurbel.solver.chapters.chain`. Its natural order is q = √(k (1/J₁ + 1/J₂))/ω_n. A stiff
one does not vibrate with the torque: both masses turn alike, and

    T = J₂ ω̇ + M_load(ω)
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from kurbel.arrays import Array, Number
from kurbel.errors import NoSolutionError
from kurbel.machine.shaft_side import Coupling
from kurbel.numerics.collocation import periodic
from kurbel.numerics.extreme import Extremes
from kurbel.numerics.pieces import Pieces
from kurbel.quantity import value
from kurbel.solver.chapters.chain import Chain, row_of_joins
from kurbel.solver.chapters.chain_equation import ChainEquation
from kurbel.solver.chapters.harmonics import amplitudes
from kurbel.solver.effort import TurningEffort
from kurbel.solver.figures import Results
from kurbel.solver.speed import RigidLine, SpeedLaw, SpeedLine

_NEAR, _WORTH, _AMPLIFIED = 0.1, 1e-3, 1.5
"""A harmonic causes a warning if its order is within _NEAR of the natural one (relatively), its amplitude at least
_WORTH of that of a sine with the root mean square of the varying torque, its amplification at least _AMPLIFIED."""
_ENDLESS, _MEETS = 1e9, 1e-6
"""Amplification above which a resonance counts as undamped, since only rounding limits it, where the order is within
_MEETS of the natural one (relatively)."""


class Harmonic(NamedTuple):
    """A harmonic near the natural order: order, relative distance from it, amplitude in N m, amplification."""

    order: float
    distance: float
    amplitude: float
    amplification: float


def natural_order(coupling: Coupling, ahead: Array, omega: Number) -> Array:
    """Return the natural order √(k (1/J₁ + 1/J₂))/ω_n of cranks and driven inertia; ahead: J₁ in kg m²."""
    return np.sqrt(coupling.stiffness * (1 / ahead + 1 / coupling.inertia)) / omega


class CouplingTorque(Results, ABC):
    """Extremes of the torque in a coupling; torque: its samples in N m with their pieces."""

    torque: tuple[Pieces, Array]

    M_coupling_max = value(
        "M_K,max",
        "torque",
        "Largest torque in the elastic coupling",
        lambda coupling: coupling.torque_extremes.largest,
    )
    M_coupling_min = value(
        "M_K,min",
        "torque",
        "Smallest torque in the elastic coupling",
        lambda coupling: coupling.torque_extremes.smallest,
    )
    amplification = value(
        "V",
        "ratio",
        "Torque variation in the coupling, relative to that in a rigid coupling",
        lambda coupling: coupling.amplified(),
    )

    @cached_property
    def torque_extremes(self) -> Extremes:
        """Largest and smallest torque in the coupling in N m."""
        pieces, torque = self.torque
        return pieces.extremes(torque[None]).each(self.result)[0]

    @abstractmethod
    def result(self, values: Array) -> Any:
        """Return values (n,), nan for machines without a solution; for one machine a float."""

    @abstractmethod
    def amplified(self) -> Number | None:
        """Return the swing of the torque over that in a rigid coupling; None where that does not swing."""


class StiffCoupling(CouplingTorque):
    """The torque in a coupling so stiff that the driven inertia turns with the cranks."""

    def __init__(self, line: RigidLine, driven: Number) -> None:
        """Take the speed line of all that turns, and the driven inertia in kg m²."""
        self._line = line
        self.torque = line.torque_beyond(driven)

    def result(self, values: Array) -> Any:
        """Return values (n,), nan for machines without a speed line; for one machine a float."""
        return self._line.result(values)

    def amplified(self) -> Number | None:
        """Return 1, since it counts as rigid; None where the torque of the only machine does not swing."""
        pieces, _ = self.torque
        highest, lowest = self.torque_extremes
        still = self._line.effort.count is None and highest.value == lowest.value
        if still:
            return None
        return self.result(np.ones(pieces.count))


class ElasticCoupling(SpeedLine, CouplingTorque):
    """The torque in the coupling and the speed of the crank shaft, of one machine or of many.

    own: J₁ in kg m², (n,). torque, alpha: samples of the torque in N m, and of dω/dt in rad/s², with their pieces.
    Raises NoSolutionError in a resonance without damping and where numbers leave the range of floats, Unsettled where
    no motion repeats.
    """

    def __init__(self, effort: TurningEffort, ahead: Array, law: SpeedLaw | None) -> None:
        coupling, pieces = effort.machine.coupling, effort.pieces
        assert coupling is not None
        self.effort = effort
        self._omega = np.broadcast_to(effort.omega, ahead.shape)
        self._stiffness = np.broadcast_to(coupling.stiffness, ahead.shape)
        self._damping = np.broadcast_to(coupling.damping, ahead.shape)
        self._masses = np.stack((ahead, np.broadcast_to(coupling.inertia, ahead.shape)))
        self._order = natural_order(coupling, ahead, effort.omega)
        self._step = 360 / effort.cycle
        self.load_slope = np.zeros(ahead.shape)
        if law is not None:
            self.load_slope = law.steepness / effort.omega
        # on either mass, less the mean
        load = effort.load - pieces.of(effort.mean)
        self._torques = np.stack((effort.true_excess.torque + load, -load))

        nothing = np.zeros((2, *ahead.shape))
        chain = Chain(
            inertias=self._masses,
            stiffnesses=self._stiffness[None],
            segment_damping=self._damping[None],
            mass_damping=nothing,
            loss=nothing[:1],
            joins=row_of_joins(2),
            segment_inertias=nothing[:1],
        )
        equation = ChainEquation(chain, self._order, effort.omega, pieces, self._torques, law, 1)
        self._course = periodic(equation, equation.pieces)
        pieces, y, failed = self._course.pieces, self._course.samples, self._course.failed
        if law is None:  # any mean speed would do: it is the nominal one
            y[1:] -= (self._masses * pieces.mean(y[1]) / ahead)[:, None, pieces.machine]
        torque = equation.torques(y, pieces)[0]
        if law:
            failed = failed | (law.mean == 0)
        else:
            nearest = np.maximum(np.rint(self._order / self._step), 1) * self._step
            limit = _ENDLESS * effort.pieces.largest(self._torques).sum(axis=0)
            is_endless = ~(pieces.largest(torque) < limit)
            meets = (self._damping == 0) & (np.abs(self._order / nearest - 1) < _MEETS)
            resonates = meets & (failed | is_endless)
            failed = failed | (meets & is_endless)
            if effort.count is None and resonates[0]:
                raise NoSolutionError(
                    f"the coupling is in resonance with harmonic {nearest[0]:g} of the torque, without damping: give "
                    "'coupling.damping', or change its stiffness or the speed"
                )
            if effort.count is None and failed[0]:
                raise NoSolutionError(
                    "stiffness, damping and inertia of the coupling are too far apart to compute with; "
                    "look at their units"
                )
        if effort.count is None:
            self._course.refuse()
        self.torque = pieces, pieces.of(effort.mean) + torque
        self.alpha = pieces, (equation.known(pieces)[0] - torque) / pieces.of(ahead)
        u = y[1] / pieces.of(ahead * effort.omega**2)
        super().__init__(effort, pieces, u, 1 + pieces.mean(u), failed, -1.0)

    @property
    def natural_order(self) -> Number:
        """Natural frequency of both masses on the coupling over ω_n."""
        return self.result(self._order)

    @cached_property
    def growth(self) -> Any:
        """Logarithm of what is left of a small disturbance after a cycle."""
        return self.result(self._course.growth)

    def amplified(self) -> Number | None:
        """Return the swing of the torque over that of J₂ (M − L)/(J₁ + J₂) + L; None where that does not swing."""
        pieces, (ahead, driven) = self.effort.pieces, self._masses
        M, L = self._torques[0], -self._torques[1]
        rigid = (M * pieces.of(driven) + L * pieces.of(ahead)) / pieces.of(ahead + driven)
        high, _, low, _ = (extreme[0] for extreme in pieces.extremes(rigid[None]))
        if self.effort.count is None and high[0] == low[0]:
            return None
        highest, lowest = self.torque_extremes.largest, self.torque_extremes.smallest
        return (highest.value - lowest.value) / self.result(high - low)

    @property
    def resonances(self) -> tuple[Harmonic, ...]:
        """Harmonics of the only machine that are present in the torque and near the natural order.

        With a load c ω₂, a₁ = −Ω² J₁ and a₂ = −Ω² J₂ + iΩ c, T = s (M₁/a₁ − M₂/a₂)/(1 + s/a₁ + s/a₂), s = k + iΩ d.
        """
        pieces, masses = self.effort.pieces, self._masses
        (order,) = self._order
        low = order * (1 - _NEAR) / self._step
        high = order * (1 + _NEAR) / self._step
        orders = self._step * np.arange(max(np.ceil(low), 1), np.floor(high) + 1)
        acting = amplitudes(pieces, self._torques, orders)[..., 0]
        M_1, M_2 = acting

        # T of the sentence above, multiplied by a₁ a₂
        Omega = orders * self._omega[0]
        a_1, a_2 = -np.multiply.outer(masses[:, 0], Omega**2).astype(complex)
        a_2 += 1j * Omega * self.load_slope[0]
        s = self._stiffness[0] + 1j * Omega * self._damping[0]
        with np.errstate(all="ignore"):
            T = np.abs(s * (M_1 * a_2 - M_2 * a_1) / (a_1 * a_2 + s * (a_1 + a_2)))

        amplitude, distance = np.abs(acting).sum(axis=0), orders / order - 1
        rigid = (np.abs(acting) * masses[::-1]).sum(axis=0) / masses.sum()
        gain = T / np.where(rigid > 0, rigid, np.inf)
        # the amplitude of one wave with their mean squares
        size = np.sqrt(2 * pieces.mean(self._torques**2)).sum()
        is_near = (amplitude > _WORTH * size) & (gain >= _AMPLIFIED)
        rows = np.stack((orders, distance, amplitude, gain))[:, is_near].T.tolist()
        return tuple(Harmonic(*row) for row in rows)
