"""An elastic coupling between the crank shaft and a driven inertia: two masses that turn nearly uniformly.

        M →  [J₁]──k, d──[J₂]  ← M_load        T = k (θ₁ − θ₂) + d (ω₁ − ω₂)  the torque in the coupling

    J₁ ω̇₁ = M − T        J₂ ω̇₂ = T − M_load(ω₂)        d/dt = ω_n d/dφ

It is the shortest chain of `kurbel.solver.chain`. Its natural order is q = √(k (1/J₁ + 1/J₂))/ω_n.
"""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from kurbel.arrays import Array
from kurbel.errors import NoSolutionError
from kurbel.machine.turning import Coupling
from kurbel.numerics.collocation import periodic
from kurbel.numerics.extreme import Extremes
from kurbel.quantity import value
from kurbel.solver.chain import Chain, ChainEquation
from kurbel.solver.effort import TurningEffort
from kurbel.solver.harmonics import amplitudes
from kurbel.solver.speed import SpeedLaw, SpeedLine

_NEAR, _WORTH, _AMPLIFIED = 0.1, 1e-3, 1.5
"""A harmonic whose order is so near the natural one, relatively, is worth a warning if its amplitude is at least so
much of one that swings as the whole torque does in the mean, and if it is amplified at least so many times."""
_ENDLESS = 1e9
"""Amplification beyond which nothing but rounding keeps a resonance from being endless."""
_PRESENT = 1e-9
"""Of that size: a smaller harmonic is not there."""


class Harmonic(NamedTuple):
    """A harmonic near the natural order: order, relative distance from it, amplitude in N m, amplification."""

    order: float
    distance: float
    amplitude: float
    amplification: float


def natural_order(coupling: Coupling, own: Array, omega: Any) -> Array:
    """Return the natural order √(k (1/J₁ + 1/J₂))/ω_n of cranks and driven inertia, J₁ in kg m²."""
    return np.asarray(np.sqrt(coupling.stiffness * (1 / own + 1 / coupling.inertia)) / omega)


class ElasticCoupling(SpeedLine):
    """The torque in the coupling and the speed of the crank shaft, of one machine or of many.

    own: J₁ in kg m², (n,). torque, alpha: samples of the torque in N m, and of dω/dt in rad/s², with their pieces.
    Raises NoSolutionError in a resonance without damping and where numbers leave the range of floats, Unsettled where
    no motion repeats.
    """

    M_coupling_max = value(
        "M_K,max", "torque", "Largest torque in the elastic coupling", lambda one: one.torque_extremes.largest
    )
    M_coupling_min = value(
        "M_K,min", "torque", "Smallest torque in the elastic coupling", lambda one: one.torque_extremes.smallest
    )
    amplification = value(
        "V", "ratio", "Swing of the torque in the coupling over that in a rigid one", lambda one: one.amplified()
    )

    def __init__(self, effort: TurningEffort, own: Array, law: SpeedLaw | None) -> None:
        coupling, pieces = effort.machine.coupling, effort.pieces
        assert coupling is not None
        self._omega, stiffness, self._damping, driven = (
            np.broadcast_to(one, own.shape)
            for one in (effort.omega, coupling.stiffness, coupling.damping, coupling.inertia)
        )
        self.effort, self._order = effort, natural_order(coupling, own, effort.omega)
        self._masses, self._stiffness = np.stack((own, driven)), stiffness
        self.load_slope = np.zeros(own.shape) if law is None else law.steepness / effort.omega
        load = effort.load - pieces.of(effort.mean)
        self._torques = np.stack((effort.true_excess.torque + load, -load))  # on either mass, less the mean
        failed = np.array([self._resonates(machine) for machine in range(pieces.count)])
        if law:
            failed |= law.mean == 0

        nothing = np.zeros((2, *own.shape))
        chain = Chain(self._masses, stiffness[None], self._damping[None], nothing, nothing[:1])
        equation = ChainEquation(chain, self._order, effort.omega, pieces, self._torques, law, 1)
        self._found = periodic(equation, equation.pieces)
        if effort.count is None and self._found.failed[0]:
            if law is None:
                raise NoSolutionError(
                    "stiffness, damping and inertia of the coupling are too far apart to compute with; "
                    "look at their units"
                )
            self._found.refuse()
        pieces, y = self._found.pieces, self._found.samples
        if law is None:  # any mean speed would do: it is the nominal one
            y[1:] -= (self._masses * pieces.mean(y[1]) / own)[:, None, pieces.machine]
        torque = equation.torques(y, pieces)[0]
        self.torque = pieces, pieces.of(effort.mean) + torque
        self.alpha = pieces, (equation.known(pieces)[0] - torque) / pieces.of(own)
        u = y[1] / pieces.of(own * effort.omega**2)
        super().__init__(effort, pieces, u, 1 + pieces.mean(u), failed | self._found.failed, -1.0)

    @property
    def natural_order(self) -> Any:
        """Natural frequency of both masses on the coupling over ω_n."""
        return self.result(self._order)

    @cached_property
    def growth(self) -> Any:
        """Logarithm of what is left of a small disturbance after a cycle."""
        return self.result(self._found.growth)

    @cached_property
    def torque_extremes(self) -> Extremes:
        """Largest and smallest torque in the coupling in N m."""
        return self.pieces.extremes(self.torque[1][None]).each(self.result)[0]

    def amplified(self) -> Any:
        """Return the swing of the torque over that of J₂ (M − L)/(J₁ + J₂) + L; None where that does not swing."""
        of, (own, driven) = self.effort.pieces.of, self._masses
        rigid = (self._torques[0] * of(driven) - self._torques[1] * of(own)) / of(own + driven)
        high, _, low, _ = (one[0] for one in self.effort.pieces.extremes(rigid[None]))
        if self.effort.count is None and high[0] == low[0]:
            return None
        found = self.torque_extremes
        return (found.largest.value - found.smallest.value) / self.result(high - low)

    # resonance

    def _harmonics(self, machine: int) -> tuple[Array, Array, Array, float]:
        """Return the orders (k,) near the natural one of a machine, their amplitudes on both masses (2, k) in N m,
        those in the coupling (k,), and the amplitude of a single harmonic of the mean square of effort and load.

        With a load c ω₂, a₁ = −Ω² J₁ and a₂ = −Ω² J₂ + iΩ c, T = s (M₁/a₁ − M₂/a₂)/(1 + s/a₁ + s/a₂), s = k + iΩ d.
        """
        pieces, step = self.effort.pieces, 360 / self.effort.cycle
        low, high = (self._order[machine] * (1 + side * _NEAR) / step for side in (-1, 1))
        orders = step * np.arange(max(np.ceil(low), 1), np.floor(high) + 1)
        rows = pieces.machine == machine
        alone = replace(pieces.taken(rows), machine=np.zeros(rows.sum(), int), count=1)
        torques = self._torques[..., rows]
        first, second = acting = amplitudes(alone, torques, orders)[..., 0]

        frequencies = orders * self._omega[machine]
        own, driven = -np.multiply.outer(self._masses[:, machine], frequencies**2).astype(complex)
        driven += 1j * frequencies * self.load_slope[machine]
        spring = self._stiffness[machine] + 1j * frequencies * self._damping[machine]
        with np.errstate(all="ignore"):
            passed = np.abs(spring * (first * driven - second * own) / (own * driven + spring * (own + driven)))
        return orders, np.abs(acting), passed, float(np.sqrt(2 * alone.mean(torques**2)).sum())

    def _resonates(self, machine: int) -> bool:
        """Return whether a harmonic that is there meets the natural order and nothing damps it.

        Raises NoSolutionError for the only machine.
        """
        if self._damping[machine] or self.load_slope[machine]:
            return False
        orders, acting, passed, size = self._harmonics(machine)
        stuck = ~(passed < _ENDLESS * size) & (acting.max(axis=0) > _PRESENT * size)
        if stuck.any() and self.effort.count is None:
            raise NoSolutionError(
                f"the coupling is in resonance with harmonic {orders[np.argmax(stuck)]:g} of the torque and "
                "nothing damps it: give 'coupling.damping', or change its stiffness or the speed"
            )
        return bool(stuck.any())

    @property
    def resonances(self) -> tuple[Harmonic, ...]:
        """Harmonics of the only machine that are present in the torque and near the natural order."""
        orders, acting, passed, size = self._harmonics(0)
        amplitude, distance = acting.sum(axis=0), orders / self._order[0] - 1
        rigid = (acting * self._masses[::-1]).sum(axis=0) / self._masses.sum()
        gain = passed / np.where(rigid > 0, rigid, np.inf)
        near = (amplitude > _WORTH * size) & (gain >= _AMPLIFIED)
        return tuple(Harmonic(*row) for row in np.stack((orders, distance, amplitude, gain))[:, near].T.tolist())
