"""An elastic coupling between the crank shaft and a driven inertia: a chain of two masses, moving nearly uniformly.

The equations are those of `kurbel.solver.shaft_line.periodic`; the load on the driven mass may depend on its speed.
"""

import math
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from kurbel.arrays import Array
from kurbel.errors import NoSolutionError
from kurbel.machine.turning import Coupling
from kurbel.numerics.collocation_old import Periodic, Unsettled
from kurbel.numerics.extreme import Extreme
from kurbel.numerics.grid import Grid
from kurbel.numerics.search import Extremes, Sampled, extremes
from kurbel.solver.shaft_line.chain import Chain, responding, twisting
from kurbel.solver.shaft_line.periodic import ChainEquation, Rise
from kurbel.solver.turning.excess import Excess, torque_extremes
from kurbel.solver.turning.harmonics import spectrum
from kurbel.solver.turning.speed import SpeedLaw
from kurbel.solver.turning.torques import Sum

_NEAR = 0.1
"""A harmonic whose order lies so near the natural one, relatively, is worth a warning."""
_WORTH = 1e-3
"""… if its amplitude is at least so much of one that swings as the whole torque does in the mean, …"""
_AMPLIFIED = 1.5
"""… and it is amplified at least so many times: one that is damped is no resonance."""
_ENDLESS = 1e9
"""Amplification beyond which nothing but rounding keeps a resonance from being endless."""


def coupled(coupling: Coupling, inertia: float) -> Chain:
    """Return the chain of two masses; inertia: J₁ in kg m² on the side of the cranks.

    >>> from kurbel.solver.shaft_line.modes import Modes
    >>> [round(float(one), 12) for one in Modes(coupled(Coupling(stiffness=100.0, inertia=2.0), 2.0)).omegas]
    [0.0, 10.0]
    """
    stiffness, damping = (np.array([one]) for one in (coupling.stiffness, coupling.damping))
    return Chain(np.array([inertia, coupling.inertia]), stiffness, damping, np.zeros(2), np.zeros(1))


class Shaft(NamedTuple):
    """What the coupling stands between: J₁ in kg m², ω_n in rad/s, how the load rises with the speed or None."""

    inertia: float
    omega: float
    law: SpeedLaw | None

    @property
    def load_slope(self) -> float:
        """Slope of the load over the speed at ω_n in N m s/rad."""
        return 0.0 if self.law is None else 2 * float(self.law(np.zeros(1))[1][0]) / self.omega


class Harmonic(NamedTuple):
    """One harmonic near the natural order: order, relative distance from it, amplitude in N m, amplification."""

    order: float
    distance: float
    amplitude: float
    amplification: float


def _end(name: str, end: str, text: str) -> Any:
    """Return the largest or the smallest torque or speed, from what it has beside its mean."""

    def extreme(coupling: Any) -> Extreme:
        found: Extreme = getattr(coupling._extremes[name], end)
        base = coupling.mean if name == "torque" else coupling.shaft.omega
        return Extreme(base + found.value, found.degrees % coupling.cycle)

    return property(extreme, doc=text)


class ElasticCoupling:
    """The torque in the coupling and the speed of the crank shaft.

    Raises NoSolutionError in a resonance that nothing damps, and where floats do not hold the figures; Unsettled where
    no motion repeats.
    """

    def __init__(self, coupling: Coupling, shaft: Shaft, excess: Excess) -> None:
        self.coupling = coupling
        self.shaft = shaft
        self._excess = excess
        self.cycle = excess.cycle
        self.chain = coupled(coupling, shaft.inertia)
        rise = Rise(1, shaft.law) if shaft.law else None
        self._equation = ChainEquation(self.chain, shaft.omega, self._driving, rise)
        self.natural_order = self._equation.order
        self._refuse_resonance()
        self._passing, self._speed = self._equation.passing[0], float(self._equation.speeds[0])
        self.motion = self._solved()

    def _solved(self) -> Periodic:
        try:
            return self._equation.solved(self._excess.grid.breaks)
        except Unsettled:
            if self.shaft.law is not None:
                raise
            raise NoSolutionError(
                "stiffness, damping and inertia of the coupling are too far apart to compute with; look at their units"
            ) from None

    @property
    def mean(self) -> float:
        """Mean torque in N m."""
        return self._excess.mean

    def _driving(self, degrees: Array, within: Array) -> Array:
        """Return effort and load less their mean in N m, as they act on the two masses, (2, …)."""
        effort, load = (
            part.torque(degrees, within).value - self.mean for part in (self._excess.effort, self._excess.load)
        )
        return np.stack((effort, -load))

    @cached_property
    def _orders(self) -> Array:
        """Orders of the harmonics near the natural one."""
        step = 360 / self.cycle
        low, high = (self.natural_order * (1 + side * _NEAR) / step for side in (-1, 1))
        return step * np.arange(max(math.ceil(low), 1), math.floor(high) + 1, dtype=float)

    def _of_orders(self, damping: float) -> tuple[Array, Array, Array]:
        """Return amplitudes in N m of effort and load near the natural order, and of the torque in the coupling.

        damping: of the driven mass, in N m s/rad.
        """
        effort, load = (spectrum(part, self._orders).amplitudes for part in (self._excess.effort, self._excess.load))
        frequencies, torques = self._orders * self.shaft.omega, np.stack((effort, -load))
        held = np.multiply.outer([0.0, damping], np.ones(len(frequencies)))
        with np.errstate(all="ignore"):
            angles = responding(self.chain, frequencies, torques, held).angles
            return np.abs(effort), np.abs(load), np.abs(twisting(self.chain, frequencies, angles)[0])

    @cached_property
    def _size(self) -> float:
        """Amplitude in N m of a single harmonic of the mean square that effort and load swing by."""
        grid = self._excess.grid
        squares = self._driving(grid.degrees, grid.within) ** 2
        return sum(math.sqrt(2 * grid.integral(one) / math.radians(self.cycle)) for one in squares)

    def _refuse_resonance(self) -> None:
        """Raise NoSolutionError where a harmonic that is there meets the natural order and nothing damps it."""
        if self.coupling.damping or self.shaft.load_slope:
            return
        effort, load, passed = self._of_orders(0.0)
        stuck = ~(passed < _ENDLESS * self._size) & (np.maximum(effort, load) > 1e-9 * self._size)
        if stuck.any():
            order = self._orders[np.argmax(stuck)]
            raise NoSolutionError(
                f"the coupling is in resonance with harmonic {order:g} of the torque and nothing damps it: give "
                "'coupling.damping', or change its stiffness or the speed"
            )

    def _sampled(self, degrees: Array, within: Array) -> dict[str, Sampled]:
        """Return the torque less its mean, and ω₁ − ω_n, with their slopes by φ, at crank angles of the cycle."""
        state = self.motion.at(degrees, within)
        rate = self._rate(degrees, within)
        return {
            "torque": Sampled(state @ self._passing, rate @ self._passing),
            "omega": Sampled(state[..., 1] * self._speed, rate[..., 1] * self._speed),
        }

    def _rate(self, degrees: Array, within: Array) -> Array:
        return self._equation.rate(self._equation.prepared(degrees, within), self.motion.at(degrees, within))[0]

    def _alpha(self, degrees: Array, within: Array) -> dict[str, Sampled]:
        """Return dω₁/dt = ω_n dω₁/dφ in rad/s², about the mean speed, with its slope by φ."""
        rate = self._rate(degrees, within)
        driving = self._excess.effort.torque(degrees, within).slope
        scale = self._speed * self.shaft.omega
        return {"alpha": Sampled(rate[..., 1] * scale, (rate @ self._equation.matrix[1] + driving) * scale)}

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
        return Grid(np.append(self.motion.elements.low, self.cycle))

    @cached_property
    def alpha_extremes(self) -> Extremes:
        """Largest and smallest angular acceleration of the crank shaft in rad/s²."""
        return extremes(self.grid, self._alpha(self.grid.degrees, self.grid.within), self._alpha)["alpha"]

    @cached_property
    def _extremes(self) -> dict[str, Extremes]:
        return extremes(self.grid, self._sampled(self.grid.degrees, self.grid.within), self._sampled)

    M_coupling_max = _end("torque", "largest", "Largest torque in the coupling in N m.")
    M_coupling_min = _end("torque", "smallest", "Smallest torque in the coupling in N m.")
    omega_max = _end("omega", "largest", "Largest angular velocity of the crank shaft in rad/s.")
    omega_min = _end("omega", "smallest", "Smallest angular velocity of the crank shaft in rad/s.")

    @cached_property
    def omega_mean(self) -> float:
        """Mean angular velocity in rad/s, the same before and behind the coupling: ω_n under a constant load."""
        width = np.radians(self.motion.elements.width)
        gained = float(width @ self.motion.coefficients[:, 1, 0]) * self._speed
        return self.shaft.omega + gained / math.radians(self.cycle)

    @property
    def delta(self) -> float:
        """(ω_max − ω_min)/ω_mean of the crank shaft."""
        swing = self._extremes["omega"]
        return (swing.largest.value - swing.smallest.value) / self.omega_mean

    @property
    def growth(self) -> float:
        """Logarithm of what is left of a small disturbance after a cycle."""
        return self.motion.growth

    @cached_property
    def amplification(self) -> float | None:
        """Swing of the torque in the coupling over that in a rigid one, J₂ (M − L)/(J₁ + J₂) + L, if it swings."""
        own, driven = self.shaft.inertia, self.coupling.inertia
        rigid = Sum((driven / (own + driven), self._excess.effort), (own / (own + driven), self._excess.load))
        grid = self._excess.grid
        found = torque_extremes(rigid, grid, rigid.torque(grid.degrees, grid.within))
        swing = found.largest.value - found.smallest.value
        torque = self._extremes["torque"]
        return (torque.largest.value - torque.smallest.value) / swing if swing else None

    @property
    def resonances(self) -> tuple[Harmonic, ...]:
        """Harmonics that are present in the torque and lie near the natural order."""
        orders = self._orders
        effort, load, passed = self._of_orders(self.shaft.load_slope)
        amplitudes, distance = effort + load, orders / self.natural_order - 1
        own, driven = self.shaft.inertia, self.coupling.inertia
        rigid = (effort * driven + load * own) / (own + driven)
        gain = passed / np.where(rigid > 0, rigid, np.inf)
        near = (amplitudes > _WORTH * self._size) & (gain >= _AMPLIFIED)
        return tuple(
            Harmonic(*(float(of[i]) for of in (orders, distance, amplitudes, gain))) for i in np.nonzero(near)[0]
        )
