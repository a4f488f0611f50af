"""An elastic coupling between the crank shaft and a driven inertia: two masses that turn nearly uniformly.

        M →  [J₁]──k, d──[J₂]  ← M_load        T = k (θ₁ − θ₂) + d (ω₁ − ω₂)  the torque in the coupling

    J₁ ω̇₁ = M − T        J₂ ω̇₂ = T − M_load(ω₂)        d/dt = ω_n d/dφ

The unknowns are, in N m and of one size: the torque of the spring less its mean over the natural order q,
q = √(k (1/J₁ + 1/J₂))/ω_n, and for each mass J ω_n (ω − ω_n).
"""

from __future__ import annotations

from dataclasses import replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from kurbel.arrays import Array, Flags
from kurbel.errors import NoSolutionError
from kurbel.machine.turning import Coupling
from kurbel.numerics.collocation import growth, periodic
from kurbel.numerics.extreme import Extreme, Extremes
from kurbel.numerics.pieces import Pieces, SampledExtremes
from kurbel.solver.effort import TurningEffort
from kurbel.solver.harmonics import amplitudes
from kurbel.solver.speed import SpeedLaw

_NEAR = 0.1
"""A harmonic whose order is so near the natural one, relatively, is worth a warning …"""
_WORTH = 1e-3
"""… if its amplitude is at least so much of one that swings as the whole torque does in the mean …"""
_AMPLIFIED = 1.5
"""… and it is amplified at least so many times: one that is damped is no resonance."""
_ENDLESS = 1e9
"""Amplification beyond which nothing but rounding keeps a resonance from being endless."""
_PRESENT = 1e-9
"""Of that size: a smaller harmonic is not there."""
_SWING = 120.0
"""Degrees of a natural oscillation that one piece may hold at first, …"""
_MOST_PARTS = 8000
"""… though a piece is cut into no more parts than these."""


class Harmonic(NamedTuple):
    """A harmonic near the natural order: order, relative distance from it, amplitude in N m, amplification."""

    order: float
    distance: float
    amplitude: float
    amplification: float


class ElasticCoupling:
    """The torque in the coupling and the speed of the crank shaft, of one machine or of many.

    own: J₁ in kg m², (n,). Raises NoSolutionError in a resonance without damping and where numbers leave the
    range of floats, Unsettled where no motion repeats.
    """

    unknowns = 3

    def __init__(self, effort: TurningEffort, own: Array, law: SpeedLaw | None) -> None:
        coupling: Any = effort.machine.coupling
        omega: Any = effort.omega
        self.effort, self.law, self.own = effort, law, own
        self.stiffness, self.damping, self.driven, self.omega = (
            np.broadcast_to(one, own.shape) for one in (coupling.stiffness, coupling.damping, coupling.inertia, omega)
        )
        self._order = natural_order(coupling, own, omega)
        self.noise = np.zeros(own.shape)
        self.failed: Flags = np.zeros(own.shape, dtype=bool) if law is None else law.mean == 0
        self._torques = np.stack((effort.true_excess.torque + effort.load, effort.load)) - effort.pieces.of(effort.mean)
        self._refuse_resonance()
        self._solve()

    # the equation; see `kurbel.numerics.collocation`

    def known(self, pieces: Pieces) -> Array:
        """Return effort and load less their mean in N m."""
        return pieces.carried(self._torques, self.effort.pieces)

    def _twisted(self, y: Array, pieces: Pieces) -> tuple[Array, Array]:
        """Return ω₁ − ω₂ over ω_n, and the torque in the coupling less its mean in N m."""
        of = pieces.of
        apart = y[1] / of(self.own * self.omega**2) - y[2] / of(self.driven * self.omega**2)
        return apart, of(self._order) * y[0] + of(self.damping * self.omega) * apart

    def rate(self, known: Array, y: Array, pieces: Pieces, eased: Array) -> tuple[Array, Array]:
        """Return y′ and its derivative; eased: so much more J₂ ω_n² in N m, as the load sees it."""
        of = pieces.of
        spring, apart_1, apart_2 = (
            of(one)
            for one in (
                self.stiffness / self._order,
                1 / (self.own * self.omega**2),
                -1 / (self.driven * self.omega**2),
            )
        )
        damping = of(self.damping * self.omega)
        apart, torque = self._twisted(y, pieces)
        rate = np.stack((spring * apart, known[0] - torque, torque - known[1]))
        slope = np.zeros((3, *y.shape))
        for column, by in ((1, apart_1), (2, apart_2)):
            slope[0, column], slope[1, column], slope[2, column] = spring * by, -damping * by, damping * by
        slope[1, 0], slope[2, 0] = -of(self._order), of(self._order)
        if self.law:
            # with u = (ω − ω_n)/ω_n the square of the speed is 1 + u (2 + u) of the nominal one
            height = of(self.driven * self.omega**2 + eased)
            gained = y[2] / height
            rise, bend = self.law.rise(gained * (2 + gained), pieces)
            rate[2] -= rise
            slope[2, 2] -= bend * 2 * (1 + gained) / height
        return rate, slope

    def floor(self, known: Array, pieces: Pieces, eased: Array) -> Array:
        """Return −∞, and for the driven mass what it must not lose, so as not to stand still."""
        floor = np.full((3, *known.shape[1:]), -np.inf)
        if self.law:
            floor[2] = -pieces.of(self.driven * self.omega**2 + eased)
        return floor

    def also(self, known: Array, y: Array, pieces: Pieces, eased: Array) -> Array:
        """Return nothing: all results are linear in y."""
        return y[:0]

    def _solve(self) -> None:
        """Solve it; a load that does not depend on the speed leaves the mean speed open: it is the nominal one."""
        found = periodic(self, _cut(self.effort.pieces, self._order))
        self.failed = self.failed | found.failed
        if self.effort.count is None and found.failed[0]:
            if self.law is None:
                raise NoSolutionError(
                    "stiffness, damping and inertia of the coupling are too far apart to compute with; "
                    "look at their units"
                )
            found.refuse()
        pieces, y = found.pieces, np.where(found.pieces.of(self.failed), 0.0, found.samples)
        if self.law is None:
            drift = pieces.mean(y[1]) / self.own
            y[1] -= pieces.of(drift * self.own)
            y[2] -= pieces.of(drift * self.driven)
        self.pieces, self._found = pieces, found
        # torque less its mean in N m, ω₁ − ω_n in rad/s, ω̇₁ in rad/s²
        torque = self._twisted(y, pieces)[1]
        omega, alpha = y[1] / pieces.of(self.own * self.omega), (self.known(pieces)[0] - torque) / pieces.of(self.own)
        self.samples = np.stack((torque, omega, alpha))

    # results

    def told(self, values: Array) -> Any:
        """Return values (n,), nan for machines without a solution; for one machine a float."""
        return self.effort.told(np.where(self.failed, np.nan, values))

    def samples_of(self, column: str) -> tuple[Pieces, Array] | None:
        """Return the samples of torque in N m, ω in rad/s or α in rad/s² with their pieces; None for another column."""
        if column not in ("M_coupling", "omega", "alpha"):
            return None
        base = {"M_coupling": self.effort.mean, "omega": self.omega}.get(column, np.zeros(1))
        values = self.samples[("M_coupling", "omega", "alpha").index(column)]
        return self.pieces, self.pieces.of(base) + values

    @cached_property
    def _extremes(self) -> SampledExtremes:
        return self.pieces.extremes(self.samples)

    def _end(self, which: int, smallest: bool, base: Array) -> Extreme:
        value, degrees = (one[which] for one in self._extremes[2 * smallest : 2 * smallest + 2])
        return Extreme(self.told(base + value), self.told(np.mod(degrees, self.pieces.cycle)))

    @property
    def natural_order(self) -> Any:
        """Natural frequency of both masses on the coupling over ω_n."""
        return self.told(self._order)

    @property
    def M_coupling_max(self) -> Extreme:
        """Largest torque in the coupling in N m."""
        return self._end(0, False, self.effort.mean)

    @property
    def M_coupling_min(self) -> Extreme:
        """Smallest torque in the coupling in N m."""
        return self._end(0, True, self.effort.mean)

    @property
    def omega_max(self) -> Extreme:
        """Largest angular velocity of the crank shaft in rad/s."""
        return self._end(1, False, self.omega)

    @property
    def omega_min(self) -> Extreme:
        """Smallest angular velocity of the crank shaft in rad/s."""
        return self._end(1, True, self.omega)

    @property
    def alpha_extremes(self) -> Extremes:
        """Largest and smallest angular acceleration of the crank shaft in rad/s²."""
        return self._extremes.each(self.told)[2]

    @cached_property
    def _mean(self) -> Array:
        return self.omega + self.pieces.mean(self.samples[1])

    @property
    def omega_mean(self) -> Any:
        """Mean angular velocity in rad/s, the same before and behind the coupling: ω_n under a constant load."""
        return self.told(self._mean)

    @property
    def delta(self) -> Any:
        """(ω_max − ω_min)/ω_mean of the crank shaft."""
        return self.told((self._extremes[0][1] - self._extremes[2][1]) / self._mean)

    @cached_property
    def growth(self) -> Any:
        """Logarithm of what is left of a small disturbance after a cycle."""
        return self.told(growth(self, self._found))

    @cached_property
    def amplification(self) -> Any:
        """Swing of the torque in the coupling over that in a rigid one, J₂ (M − L)/(J₁ + J₂) + L; None without any."""
        of, (effort, load) = self.effort.pieces.of, self._torques
        rigid = (effort * of(self.driven) + load * of(self.own)) / of(self.own + self.driven)
        high, _, low, _ = (one[0] for one in self.effort.pieces.extremes(rigid[None]))
        if self.effort.count is None and high[0] == low[0]:
            return None
        return self.told((self._extremes[0][0] - self._extremes[2][0]) / (high - low))

    # resonance

    def _harmonics(self, machine: int, damping: float) -> tuple[Array, Array, Array, Array]:
        """Return the orders (k,) near the natural one of a machine, and their amplitudes in N m.

        They are those of the effort, of the load, and of the torque in the coupling; damping: of the driven mass in
        N m s/rad.
        """
        step, natural = 360 / self.effort.cycle, float(self._order[machine])
        low, high = (natural * (1 + side * _NEAR) / step for side in (-1, 1))
        orders = step * np.arange(max(np.ceil(low), 1), np.floor(high) + 1)
        pieces = self.effort.pieces.taken(self.effort.pieces.machine == machine)
        alone = replace(pieces, machine=np.zeros_like(pieces.machine), count=1)
        torques = self._torques[..., self.effort.pieces.machine == machine]
        effort, load = amplitudes(alone, torques, orders)[..., 0]
        k, d, J1, J2, omega = (
            float(one[machine]) for one in (self.stiffness, self.damping, self.own, self.driven, self.omega)
        )
        # (k + iνd) (θ₁ − θ₂) = T, −ν² J₁ θ₁ = M − T, (−ν² J₂ + iν c) θ₂ = T − L
        nu = orders * omega
        spring, first, second = k + 1j * nu * d, -(nu**2) * J1, -(nu**2) * J2 + 1j * nu * damping
        with np.errstate(all="ignore"):
            passed = np.abs(spring * (effort * second + load * first) / (first * second + spring * (first + second)))
        return orders, np.abs(effort), np.abs(load), passed

    @cached_property
    def _size(self) -> Array:
        """Amplitude in N m of a single harmonic of the mean square that effort and load swing by, (n,)."""
        return np.asarray(np.sqrt(2 * self.effort.pieces.mean(self._torques**2)).sum(axis=0))

    @property
    def load_slope(self) -> Array:
        """Slope of the load over the speed at the nominal one in N m s/rad, (n,)."""
        if self.law is None:
            return np.zeros_like(self.own)
        first = self.effort.pieces.taken(self.effort.pieces.first)
        return np.asarray(2 * self.law.rise(np.zeros(len(self.own)), first)[1] / self.omega)

    def _refuse_resonance(self) -> None:
        """Raise NoSolutionError where a harmonic that is there meets the natural order and nothing damps it."""
        for machine in np.flatnonzero((self.damping == 0) & (self.load_slope == 0)).tolist():
            size = self._size[machine]
            orders, effort, load, passed = self._harmonics(machine, 0.0)
            stuck = ~(passed < _ENDLESS * size) & (np.maximum(effort, load) > _PRESENT * size)
            if stuck.any() and self.effort.count is None:
                raise NoSolutionError(
                    f"the coupling is in resonance with harmonic {orders[np.argmax(stuck)]:g} of the torque and "
                    "nothing damps it: give 'coupling.damping', or change its stiffness or the speed"
                )
            self.failed[machine] |= stuck.any()

    @property
    def resonances(self) -> tuple[Harmonic, ...]:
        """Harmonics of the only machine that are present in the torque and near the natural order."""
        orders, effort, load, passed = self._harmonics(0, float(self.load_slope[0]))
        amplitudes, distance = effort + load, orders / self._order[0] - 1
        rigid = (effort * self.driven + load * self.own) / (self.own + self.driven)
        gain = passed / np.where(rigid > 0, rigid, np.inf)
        near = (amplitudes > _WORTH * self._size[0]) & (gain >= _AMPLIFIED)
        return tuple(Harmonic(*row) for row in np.stack((orders, distance, amplitudes, gain))[:, near].T.tolist())


def natural_order(coupling: Coupling, own: Array, omega: Any) -> Array:
    """Return the natural order √(k (1/J₁ + 1/J₂))/ω_n of cranks and driven inertia, J₁ in kg m²."""
    return np.asarray(np.sqrt(coupling.stiffness * (1 / own + 1 / coupling.inertia)) / omega)


def _cut(pieces: Pieces, order: Array) -> Pieces:
    """Return pieces that hold no more of a natural oscillation than one may at first."""
    parts = np.ceil(2 * pieces.half * (pieces.of(order) / _SWING)).clip(1, _MOST_PARTS).astype(int)
    return pieces.parted(parts)
