"""The speed of the shaft over the turn: z, the kinetic energy beyond that of uniform rotation, decides it.

With the reduced inertia J(φ) = J + Σ m x′² the kinetic energy is ½ J(φ) ω_n² + z, hence ω = ω_n √(1 + z/(½ J(φ) ω_n²)).
z changes by the excess of the turning effort at uniform rotation, inertia forces included, over the load at the true
speed. Nothing cancels, whether the flywheel is heavy or the load stiff.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from functools import cached_property
from typing import TYPE_CHECKING, Protocol

import numpy as np

from kurbel.errors import UsageError
from kurbel.numerics.collocation import Periodic, Standstill, periodic
from kurbel.numerics.elements import Elements
from kurbel.numerics.extreme import Extreme
from kurbel.numerics.grid import Grid
from kurbel.numerics.jet import Jet
from kurbel.numerics.search import Extremes, Sampled, extremes
from kurbel.solver.turning.excess import Excess
from kurbel.solver.turning.machine_effort import MovingInertia

if TYPE_CHECKING:
    from kurbel.arrays import Array


class Inertia:
    """The reduced moment of inertia J(φ) = J + Σ m x′² + … in kg m², at a nominal angular velocity ω_n in rad/s."""

    def __init__(self, flywheel: float, moving: MovingInertia, omega: float) -> None:
        self.flywheel = flywheel
        self.moving = moving
        self.omega = omega

    def at(self, degrees: Array, within: Array) -> Jet:
        """Return J(φ) with its slope at crank angles (…,)."""
        return self.moving.line.at(degrees, within) + self.flywheel

    def energy(self, degrees: Array, within: Array) -> Jet:
        """Return ½ J(φ) ω_n² in J."""
        return self.at(degrees, within) * (self.omega**2 / 2)

    def energy_curvature(self, degrees: Array, within: Array) -> Array:
        """Return the second derivative of that by φ in J."""
        return np.asarray(self.moving.bending.at(degrees, within).slope * (self.omega**2 / 2))


class SpeedLaw(Protocol):
    """How a load rises with the speed: its torque less that at the nominal speed, over r = (ω/ω_n)² − 1."""

    def __call__(self, ratio: Array) -> tuple[Array, Array]:
        """Return the rise in N m and its derivative by r, (…,)."""
        ...


class PowerLaw:
    """M_m ((ω/ω_n)^k − 1)."""

    def __init__(self, mean: float, exponent: float) -> None:
        self.mean, self.exponent = mean, exponent

    def __call__(self, ratio: Array) -> tuple[Array, Array]:
        """See `SpeedLaw`."""
        half = self.exponent / 2
        logarithm = np.log1p(ratio)
        return self.mean * np.expm1(half * logarithm), self.mean * half * np.exp((half - 1) * logarithm)


class SlipLaw:
    """|M_m| (ω/ω_n − 1)/s: an induction machine on the grid, generator or motor."""

    def __init__(self, mean: float, slip: float) -> None:
        self.steepness = abs(mean) / slip

    def __call__(self, ratio: Array) -> tuple[Array, Array]:
        """See `SpeedLaw`."""
        root = np.sqrt(1 + ratio)
        return self.steepness * ratio / (1 + root), self.steepness / (2 * root)


class SpeedLine(ABC):
    """ω over the turn. `z(degrees, within)` is the kinetic energy beyond that of uniform rotation, in J.

    Its extremes, and what hangs on them, raise Standstill where ω falls to SLOWEST times the nominal speed.
    """

    SLOWEST = 0.0

    def __init__(self, excess: Excess, inertia: Inertia, grid: Grid) -> None:
        self.excess = excess
        self.inertia = inertia
        self.grid = grid
        self.cycle = float(grid.breaks[-1])

    @abstractmethod
    def z(self, degrees: Array, within: Array) -> Array:
        """Return z in J at crank angles (n,) within the cycle."""

    def _rise(self, ratio: Array) -> Array:
        """Return what the load takes beyond its torque at the nominal speed, in N m; ratio: (ω/ω_n)² − 1."""
        return np.zeros_like(ratio)

    def _rise_slope(self, ratio: Array) -> Array:
        """Return the derivative of that by the ratio."""
        return np.zeros_like(ratio)

    def _ratio(self, degrees: Array, within: Array) -> Sampled:
        """Return (ω/ω_n)² − 1 with its slope by φ."""
        torque = self.excess.line.at(degrees, within).value
        return self._sampled(self.z(degrees, within), self.inertia.energy(degrees, within), torque)

    def _sampled(self, z: Array, energy: Jet, torque: Array) -> Sampled:
        ratio = z / energy.value
        return Sampled(ratio, (torque - self._rise(ratio) - ratio * energy.slope) / energy.value)

    @cached_property
    def _samples(self) -> Sampled:
        return self._ratio(self.grid.degrees, self.grid.within)

    @cached_property
    def _extremes(self) -> Extremes:
        def evaluate(degrees: Array, within: Array) -> dict[str, Sampled]:
            return {"ratio": self._ratio(degrees, within)}

        if not np.isfinite(self._samples.value).all():
            raise UsageError("the speed line leads beyond what can be computed with: check effort and flywheel")
        found = extremes(self.grid, {"ratio": self._samples}, evaluate)["ratio"]
        if not found.smallest.value > self.SLOWEST**2 - 1:
            raise Standstill(found.smallest.degrees)
        return found

    def omega(self, degrees: Array) -> Array:
        """Return the angular velocity in rad/s at crank angles (n,) in degrees."""
        angles = np.mod(degrees, self.cycle)
        ratio = self.z(angles, angles) / self.inertia.energy(angles, angles).value
        return np.asarray(self.inertia.omega * np.sqrt(1 + ratio))

    def curves(self, degrees: Array, within: Array) -> dict[str, Sampled]:
        """Return ω in rad/s and its derivative by time in rad/s², each with its slope by φ."""
        ratio, nominal = self._ratio(degrees, within), self.inertia.omega
        omega = nominal * np.sqrt(1 + ratio.value)
        return {"omega": Sampled(omega, nominal**2 * ratio.slope / (2 * omega)), **self._alpha(degrees, within)}

    @cached_property
    def omega_max(self) -> Extreme:
        """Largest angular velocity in rad/s."""
        return self._omega_at(self._extremes.largest)

    @cached_property
    def omega_min(self) -> Extreme:
        """Smallest angular velocity in rad/s."""
        return self._omega_at(self._extremes.smallest)

    def _omega_at(self, ratio: Extreme) -> Extreme:
        return Extreme(self.inertia.omega * math.sqrt(1 + ratio.value), ratio.degrees)

    def _alpha(self, degrees: Array, within: Array) -> dict[str, Sampled]:
        """Return dω/dt = ½ ω_n² dr/dφ in rad/s², r = (ω/ω_n)² − 1, with its slope by φ.

        With e = ½ J(φ) ω_n²: e r′ = M − M_load − r e′, and so e r″ = (M − M_load)′ − 2 r′ e′ − r e″.
        """
        z, torque, energy = self.z(degrees, within), self.excess.line.at(degrees, within), self.inertia
        line, bend = energy.energy(degrees, within), energy.energy_curvature(degrees, within)
        ratio, slope = self._sampled(z, line, torque.value)
        rising = self._rise_slope(ratio) * slope
        curvature = (torque.slope - rising - 2 * slope * line.slope - ratio * bend) / line.value
        half = self.inertia.omega**2 / 2
        return {"alpha": Sampled(half * slope, half * curvature)}

    def alpha(self, degrees: Array) -> Array:
        """Return the angular acceleration in rad/s² at crank angles (n,) in degrees, just after a jump."""
        angles = np.mod(degrees, self.cycle)
        return self._alpha(angles, angles)["alpha"].value

    @cached_property
    def alpha_extremes(self) -> Extremes:
        """Largest and smallest angular acceleration in rad/s²."""
        return extremes(self.grid, self._alpha(self.grid.degrees, self.grid.within), self._alpha)["alpha"]

    @cached_property
    def omega_mean(self) -> float:
        """Mean angular velocity over time in rad/s: 2π by the time of a turn."""
        slowness = -self._samples.value / (np.sqrt(1 + self._samples.value) * (1 + np.sqrt(1 + self._samples.value)))
        return self.inertia.omega / (1 + self.grid.integral(slowness) / math.radians(self.cycle))

    @cached_property
    def delta(self) -> float:
        """δ = (ω_max − ω_min)/ω_mean, as the difference of the squares over the sum, which loses nothing."""
        squares = self._extremes.largest.value - self._extremes.smallest.value
        return self.inertia.omega**2 * squares / ((self.omega_max.value + self.omega_min.value) * self.omega_mean)


class ConstantLoad(SpeedLine):
    """ω under a load that does not depend on speed: z = E + C, closed.

    Such a load lets the machine run at any speed; C is chosen so that the mean speed over time is the nominal one.
    Raises Standstill where that takes a smallest speed below a hundredth of it.
    """

    SLOWEST = 0.01

    def __init__(self, excess: Excess, inertia: Inertia) -> None:
        super().__init__(excess, inertia, _split_at_dips(excess))
        self.constant = self._constant()

    def z(self, degrees: Array, within: Array) -> Array:
        """Return E + C in J; see `SpeedLine`."""
        return self.excess.at(degrees) + self.constant

    def _constant(self) -> float:
        """C in J, from ∫ dφ/ω = 2π/ω_n: the mean of 1/√(1 + r) is 1. That falls and is convex: Newton from below."""
        energy = self.inertia.energy(self.grid.degrees, self.grid.within).value
        excess = self.excess.at(self.grid.degrees)
        least = -excess + (self.SLOWEST**2 - 1) * energy
        constant = float(least.max())
        whole = math.radians(self.cycle)
        for _ in range(100):
            ratio = (excess + constant) / energy
            root = np.sqrt(1 + ratio)
            lag = self.grid.integral(-ratio / (root * (1 + root))) / whole
            slope = self.grid.integral(-0.5 / ((1 + ratio) * root * energy)) / whole
            step = -lag / slope
            if step < 0 and constant == float(least.max()):
                raise Standstill(float(self.grid.degrees.ravel()[np.argmax(least)]))
            constant += step
            if abs(step) <= 1e-15 * np.ptp(excess):
                break
        return constant


def _split_at_dips(excess: Excess) -> Grid:
    """Cut the grid ever finer on both sides of the crossings, where a slow machine lingers."""
    if not excess.crossings:
        return excess.grid
    steps = np.array([0.0, *(sign * 10.0 / 3.0**k for k in range(4) for sign in (1, -1))])
    angles = (np.array(excess.crossings)[:, None] + steps).ravel()
    return excess.grid.split_at(np.mod(angles, excess.cycle))


def floquet(growth: float) -> float:
    """Return the multiplier e^growth; what is beyond the range of a float is the end of it."""
    return math.exp(min(growth, 709.7))


class SpeedEquation:
    """z′ = M − M_load(ω), ω from z; see `collocation.Equation`."""

    def __init__(self, excess: Excess, law: SpeedLaw, inertia: Inertia, noise: float, eased: float = 0.0) -> None:
        self.excess, self.law, self.inertia, self.noise = excess, law, inertia, noise
        self._more = eased

    def prepared(self, degrees: Array, within: Array) -> Array:
        """See `collocation.Equation`."""
        energy = self.inertia.energy(degrees, within).value + self._more
        return np.stack((self.excess.line.at(degrees, within).value, energy))

    def eased(self, by: float) -> SpeedEquation:
        """See `collocation.Equation`: so much more inertia, as ½ J ω_n² in J."""
        return SpeedEquation(self.excess, self.law, self.inertia, self.noise, by)

    def rate(self, prepared: Array, z: Array) -> tuple[Array, Array]:
        """See `collocation.Equation`."""
        excess, energy = prepared
        rise, slope = self.law(z[..., 0] / energy)
        return (excess - rise)[..., None], (-slope / energy)[..., None, None]

    def floor(self, prepared: Array) -> Array:
        """See `collocation.Equation`."""
        return np.asarray(-prepared[1])[..., None]


class SpeedDependentLoad(SpeedLine):
    """ω under a load that depends on speed: the periodic state, found by collocation over the whole cycle."""

    def __init__(self, excess: Excess, law: SpeedLaw, inertia: Inertia) -> None:
        # a torque known to one unit in the last place moves z by this in a turn; the energy is not known better either
        torque = max(abs(extreme.value) for extreme in excess.effort_extremes)
        energy = inertia.energy(excess.grid.degrees, excess.grid.within).value.min()
        noise = 1e-16 * min(torque, float(energy))
        self._law = law
        self.solution: Periodic = periodic(
            SpeedEquation(excess, law, inertia, noise), Elements.over(excess.grid.breaks)
        )
        super().__init__(excess, inertia, Grid(np.append(self.solution.elements.low, excess.cycle)))

    def z(self, degrees: Array, within: Array) -> Array:
        """Return z in J; see `SpeedLine`."""
        return np.asarray(self.solution.at(degrees, within)[..., 0])

    def _rise(self, ratio: Array) -> Array:
        return self._law(ratio)[0]

    def _rise_slope(self, ratio: Array) -> Array:
        return self._law(ratio)[1]

    @property
    def multiplier(self) -> float:
        """Floquet multiplier: what is left of a small disturbance of the energy after one cycle; stable below 1.

        μ = exp(−∮ ∂M_load/∂ω/(J ω) dφ).
        """
        return floquet(self.solution.growth)
