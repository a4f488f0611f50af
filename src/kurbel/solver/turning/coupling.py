"""An elastic coupling between the crank shaft and a driven inertia, both moving nearly uniformly.

About the nominal speed the equations are linear: J₁ ω̇₁ = M − T, J₂ ω̇₂ = T − L − c (ω₂ − ω_n), Ṡ = k (ω₁ − ω₂), with the
torque T = S + d (ω₁ − ω₂) in the coupling, its stiffness k and damping d, the slope c of the load over the speed. Their
periodic solution is found by collocation.
"""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kurbel.errors import NoSolutionError
from kurbel.machine.turning import Coupling
from kurbel.numerics.elements import Elements, rule
from kurbel.numerics.extreme import Extreme
from kurbel.numerics.grid import Grid
from kurbel.numerics.linear_collocation import linear_periodic
from kurbel.numerics.search import Extremes, Sampled, extremes
from kurbel.solver.turning.excess import Excess
from kurbel.solver.turning.torques import Sum

if TYPE_CHECKING:
    from kurbel.arrays import Array, ComplexArray

_SWING = 120.0
"""Degrees of a natural oscillation that one element may hold at first, …"""
_MOST_PARTS = 8000
"""… though a piece is cut into no more parts than these."""
_NEAR = 0.1
"""A harmonic whose order lies so near the natural one, relatively, is worth a warning."""
_WORTH = 1e-3
"""… if its amplitude is at least so much of one that swings as the whole torque does in the mean, …"""
_AMPLIFIED = 1.5
"""… and it is amplified at least so many times: one that is damped is no resonance."""


def natural_frequency(coupling: Coupling, inertia: float) -> float:
    """Return √(k (J₁ + J₂)/(J₁ J₂)) in rad/s; J₁: moment of inertia in kg m² on the side of the cranks.

    >>> round(natural_frequency(Coupling(stiffness=100.0, inertia=2.0), 2.0), 12)
    10.0
    """
    return math.sqrt(coupling.stiffness) * math.hypot(1 / math.sqrt(inertia), 1 / math.sqrt(coupling.inertia))


class Shaft(NamedTuple):
    """What the coupling stands between: J₁ in kg m², ω_n in rad/s, slope of the load over the speed in N m s."""

    inertia: float
    omega: float
    load_slope: float


class Harmonic(NamedTuple):
    """One harmonic near the natural order: order, relative distance from it, amplitude in N m, amplification."""

    order: float
    distance: float
    amplitude: float
    amplification: float


class ElasticCoupling:
    """The torque in the coupling and the speed of the crank shaft; see the head of the module.

    The unknowns, (…, 3), are S − M_m over the natural order, and what J₁ and J₂ gain over ω_n times their momentum: all
    in N m, of one size.
    Raises NoSolutionError in a resonance that nothing damps, and where floats do not hold the figures.
    """

    def __init__(self, coupling: Coupling, shaft: Shaft, excess: Excess) -> None:
        self.coupling = coupling
        self.shaft = shaft
        self._excess = excess
        self.cycle = excess.cycle
        self.natural_frequency = natural_frequency(coupling, shaft.inertia)
        self.natural_order = self.natural_frequency / shaft.omega
        self._speeds = np.array([0.0, 1 / shaft.inertia, 1 / coupling.inertia]) / shaft.omega
        twisting = self._speeds * np.array([0.0, 1.0, -1.0])
        self._passing = coupling.damping * twisting + np.array([self.natural_order, 0.0, 0.0])
        self.matrix = np.stack(
            (
                coupling.stiffness / self.natural_frequency * twisting,
                -self._passing,
                self._passing - np.array([0.0, 0.0, shaft.load_slope * self._speeds[2]]),
            )
        )
        self._refuse_resonance(self._first_elements)
        try:
            self.elements, self._coefficients = linear_periodic(self, self._first_elements)
        except np.linalg.LinAlgError:
            raise NoSolutionError(
                "stiffness, damping and inertia of the coupling are too far apart to compute with; look at their units"
            ) from None
        # a load that does not depend on the speed leaves the mean speed open: it is the nominal one
        drift = np.radians(self.elements.width) @ self._coefficients[:, 1, 0] / math.radians(self.cycle)
        self._coefficients[:, 1:, 0] -= drift * self._speeds[1] / self._speeds[1:]

    @cached_property
    def _first_elements(self) -> Elements:
        """The smooth pieces, cut so that a natural oscillation has several elements."""
        breaks = self._excess.grid.breaks
        parts = np.ceil(np.diff(breaks) * (self.natural_order / _SWING)).astype(int).clip(1, _MOST_PARTS)
        cuts = [low + step * np.arange(n) / n for low, step, n in zip(breaks[:-1], np.diff(breaks), parts)]
        return Elements.over(np.append(np.concatenate(cuts), breaks[-1]))

    @property
    def mean(self) -> float:
        """Mean torque in N m."""
        return self._excess.mean

    def prepared(self, degrees: Array, within: Array) -> Array:
        """Return what drives the unknowns: nothing, the effort, and the load, less their mean in N m, as (3, …)."""
        effort, load = (
            part.torque(degrees, within).value - self.mean for part in (self._excess.effort, self._excess.load)
        )
        return np.stack((np.zeros_like(effort), effort, -load))

    def _amplitudes(self, orders: Array, elements: Elements) -> tuple[ComplexArray, ComplexArray, float]:
        """Return amplitudes in N m of effort and load at orders (n,), M = mean + Re Σ M̂ e^{inφ}, and the size of both.

        The size is the amplitude of a single harmonic with the same mean square.
        """
        torques = elements.prepared(self)[1:] * np.array([1.0, -1.0])[:, None, None]
        weights = np.radians(elements.width)[:, None] * rule().matrix[-1] * (2 / math.radians(self.cycle))
        waves = np.exp(-1j * orders[:, None] * np.radians(elements.degrees.ravel()))
        effort, load = (np.asarray(waves @ (weights * part).ravel(), dtype=complex) for part in torques)
        return effort, load, float(np.sqrt((weights * torques**2).sum(axis=(1, 2))).sum())

    @cached_property
    def _orders(self) -> Array:
        """Orders of the harmonics near the natural one."""
        step = 360 / self.cycle
        low, high = (self.natural_order * (1 + side * _NEAR) / step for side in (-1, 1))
        return step * np.arange(max(math.ceil(low), 1), math.floor(high) + 1, dtype=float)

    def _denominators(self, orders: Array) -> tuple[ComplexArray, ComplexArray]:
        """Return c + iνJ₂ and 1 + iνJ₁ (1/(k/(iν) + d) + 1/(c + iνJ₂)) at orders (n,), ν = n ω_n.

        The second one is by what the harmonics of the torque in the coupling are less than M̂ + L̂ iνJ₁/(c + iνJ₂).
        """
        nu = 1j * orders * self.shaft.omega
        driven = nu * self.coupling.inertia + self.shaft.load_slope
        spring = self.coupling.stiffness / nu + self.coupling.damping
        return np.asarray(driven), np.asarray(1 + nu * self.shaft.inertia * (1 / spring + 1 / driven), dtype=complex)

    def _refuse_resonance(self, elements: Elements) -> None:
        driven, below = self._denominators(self._orders)
        nu = 1j * self._orders * self.shaft.omega
        spring = self.coupling.stiffness / nu + self.coupling.damping
        free = np.abs(below) < 1e-9 * np.abs(nu * self.shaft.inertia / spring)
        if not free.any():
            return
        effort, load, size = self._amplitudes(self._orders, elements)
        stuck = free & (np.abs(effort + load * (nu * self.shaft.inertia / driven)) > 1e-9 * size)
        if stuck.any():
            order = self._orders[np.argmax(stuck)]
            raise NoSolutionError(
                f"the coupling is in resonance with harmonic {order:g} of the torque and nothing damps it: give "
                "'coupling.damping', or change its stiffness or the speed"
            )

    def _sampled(self, degrees: Array, within: Array) -> dict[str, Sampled]:
        """Return the torque less its mean, and ω₁ − ω_n, with their slopes by φ, at crank angles of the cycle."""
        state = self.elements.at(self._coefficients, degrees, within)
        rate = self._rate(state, degrees, within)
        return {
            "torque": Sampled(state @ self._passing, rate @ self._passing),
            "omega": Sampled(state[..., 1] * self._speeds[1], rate[..., 1] * self._speeds[1]),
        }

    def _rate(self, state: Array, degrees: Array, within: Array) -> Array:
        return np.asarray(state @ self.matrix.T + np.moveaxis(self.prepared(degrees, within), 0, -1))

    def _alpha(self, degrees: Array, within: Array) -> dict[str, Sampled]:
        """Return dω₁/dt = ω_n dω₁/dφ in rad/s², about the mean speed, with its slope by φ."""
        rate = self._rate(self.elements.at(self._coefficients, degrees, within), degrees, within)
        driving = self._excess.effort.torque(degrees, within).slope
        scale = self._speeds[1] * self.shaft.omega
        return {"alpha": Sampled(rate[..., 1] * scale, (rate @ self.matrix[1] + driving) * scale)}

    def alpha(self, degrees: Array) -> Array:
        """Return the angular acceleration of the crank shaft in rad/s², just after a jump."""
        angles = np.mod(degrees, self.cycle)
        return self._alpha(angles, angles)["alpha"].value

    def curves(self, degrees: Array, within: Array) -> dict[str, Sampled]:
        """Return torque in N m, speed in rad/s and acceleration in rad/s² with their slopes by φ, by their columns."""
        torque, omega = self._sampled(degrees, within).values()
        return {
            "M_coupling": torque._replace(value=self.mean + torque.value),
            "omega": omega._replace(value=self.shaft.omega + omega.value),
            **self._alpha(degrees, within),
        }

    @cached_property
    def grid(self) -> Grid:
        """The cycle in the elements of the solution."""
        return Grid(np.append(self.elements.low, self.cycle))

    @cached_property
    def alpha_extremes(self) -> Extremes:
        """Largest and smallest angular acceleration of the crank shaft in rad/s²."""
        return extremes(self.grid, self._alpha(self.grid.degrees, self.grid.within), self._alpha)["alpha"]

    def torque(self, degrees: Array) -> Array:
        """Return the torque in the coupling in N m at crank angles (n,) in degrees."""
        angles = np.mod(degrees, self.cycle)
        return self.mean + self._sampled(angles, angles)["torque"].value

    def omega(self, degrees: Array) -> Array:
        """Return the angular velocity of the crank shaft in rad/s."""
        angles = np.mod(degrees, self.cycle)
        return self.shaft.omega + self._sampled(angles, angles)["omega"].value

    @cached_property
    def _extremes(self) -> dict[str, Extremes]:
        return extremes(self.grid, self._sampled(self.grid.degrees, self.grid.within), self._sampled)

    def _shifted(self, name: str, largest: bool, base: float) -> Extreme:
        found = self._extremes[name].largest if largest else self._extremes[name].smallest
        return Extreme(base + found.value, found.degrees % self.cycle)

    @property
    def M_coupling_max(self) -> Extreme:
        """Largest torque in the coupling in N m."""
        return self._shifted("torque", True, self.mean)

    @property
    def M_coupling_min(self) -> Extreme:
        """Smallest torque in the coupling in N m."""
        return self._shifted("torque", False, self.mean)

    @property
    def omega_max(self) -> Extreme:
        """Largest angular velocity of the crank shaft in rad/s."""
        return self._shifted("omega", True, self.shaft.omega)

    @property
    def omega_min(self) -> Extreme:
        """Smallest angular velocity of the crank shaft in rad/s."""
        return self._shifted("omega", False, self.shaft.omega)

    @property
    def omega_mean(self) -> float:
        """ω_n: the equations are drawn up about it."""
        return self.shaft.omega

    @property
    def delta(self) -> float:
        """(ω_max − ω_min)/ω_n of the crank shaft."""
        swing = self._extremes["omega"]
        return (swing.largest.value - swing.smallest.value) / self.shaft.omega

    @cached_property
    def growth(self) -> float:
        """Logarithm of what is left of a small disturbance after a cycle: its length times the largest real part.

        Of the eigenvalues of the equations at the head of the module.
        """
        return float(np.linalg.eigvals(self.matrix).real.max()) * math.radians(self.cycle)

    @cached_property
    def amplification(self) -> float | None:
        """Swing of the torque in the coupling over that in a rigid one, J₂ (M − L)/(J₁ + J₂) + L, if it swings."""
        own, driven = self.shaft.inertia, self.coupling.inertia
        rigid = Sum((driven / (own + driven), self._excess.effort), (own / (own + driven), self._excess.load))
        grid = self._excess.grid

        def evaluate(degrees: Array, within: Array) -> dict[str, Sampled]:
            return {"torque": Sampled.of(rigid.torque(degrees, within), degrees.shape)}

        found = extremes(grid, evaluate(grid.degrees, grid.within), evaluate)["torque"]
        swing = found.largest.value - found.smallest.value
        torque = self._extremes["torque"]
        return (torque.largest.value - torque.smallest.value) / swing if swing else None

    @property
    def resonances(self) -> tuple[Harmonic, ...]:
        """Harmonics that are present in the torque and lie near the natural order."""
        orders = self._orders
        effort, load, size = self._amplitudes(orders, self.elements)
        amplitudes = np.abs(effort) + np.abs(load)
        distance = orders / self.natural_order - 1
        own, driven = self.shaft.inertia, self.coupling.inertia
        gain = np.abs(1 / self._denominators(orders)[1]) * (own + driven) / driven
        near = (amplitudes > _WORTH * size) & (gain >= _AMPLIFIED)
        return tuple(
            Harmonic(*(float(of[i]) for of in (orders, distance, amplitudes, gain))) for i in np.nonzero(near)[0]
        )
