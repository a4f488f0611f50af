"""An elastic coupling between the crank shaft and a driven inertia, by harmonic balance at the nominal speed.

Every harmonic ν = nω of the turning effort M̂ and of the load L̂ drives both masses through the coupling:
T̂ = (M̂ + L̂ iνJ₁/(iνJ₂ + c)) / (1 + iνJ₁ (1/(k/(iν) + d) + 1/(iνJ₂ + c))), with stiffness k, damping d, the moments of
inertia J₁ and J₂, and the slope c of the load over the speed.
"""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kurbel.errors import NoSolutionError
from kurbel.machine.turning import Coupling
from kurbel.mechanisms import Extreme
from kurbel.solver.excess import mean_torque
from kurbel.solver.grid import Grid
from kurbel.solver.search import Extremes, Sampled, extremes
from kurbel.solver.torques import Mean, Sum, Torque

if TYPE_CHECKING:
    from kurbel.arrays import Array, ComplexArray

RIGID_ABOVE = 100.0
"""Natural order from which on a coupling counts as rigid: it transmits what a rigid one would but for 1 in 10⁴."""
_NEAR = 0.1
"""A harmonic whose order lies so near the natural one, relatively, is worth a warning."""
_WORTH = 1e-3
"""… if its amplitude is at least so much of the largest harmonic, …"""
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
    """The torque in the coupling and the speed of the crank shaft; see the head of the module."""

    def __init__(self, coupling: Coupling, shaft: Shaft, effort: Torque, load: Torque) -> None:
        self.coupling = coupling
        self.shaft = shaft
        self._effort, self._load = effort, load
        self.cycle = float(max(effort.breaks[-1], load.breaks[-1]))
        self.natural_frequency = natural_frequency(coupling, shaft.inertia)
        self.natural_order = self.natural_frequency / shaft.omega
        most = max(200.0, 8 * self.natural_order)
        self._orders = np.arange(1, math.ceil(most * self.cycle / 360) + 1) * (360 / self.cycle)

    @cached_property
    def _spectra(self) -> tuple[ComplexArray, ComplexArray]:
        """Amplitudes of effort and load in N m at the orders, M(φ) = mean + Re Σ M̂ e^{inφ}."""
        return self._spectrum(self._effort), self._spectrum(self._load)

    def _spectrum(self, torque: Torque) -> ComplexArray:
        """Fourier integrals by Gauss on the smooth pieces, cut so that no harmonic swings more than twice in one."""
        widest = 720.0 / float(self._orders[-1])
        low, width = torque.breaks[:-1], np.diff(torque.breaks)
        parts = np.ceil(width / widest).astype(int)
        cuts = [start + step * np.arange(n) / n for start, step, n in zip(low, width, parts, strict=True)]
        grid = Grid(np.append(np.concatenate(cuts), torque.breaks[-1]))
        values = torque.torque(grid.degrees, grid.within).value
        turn = np.exp(-1j * np.radians(grid.degrees) * (360 / self.cycle))
        phase, found = np.ones_like(turn), []
        for _ in self._orders:
            phase = phase * turn
            wave = values * phase
            found.append(grid.integral(wave.real) + 1j * grid.integral(wave.imag))
        return np.asarray(np.array(found) * (2 / math.radians(self.cycle)), dtype=complex)

    @cached_property
    def _balance(self) -> tuple[ComplexArray, ComplexArray, ComplexArray]:
        """Amplitudes of the torque in the coupling, of the speed it takes from the cranks, and the denominators."""
        nu = 1j * self._orders * self.shaft.omega
        effort, load = self._spectra
        driven = nu * self.coupling.inertia + self.shaft.load_slope
        spring = self.coupling.stiffness / nu + self.coupling.damping
        below = 1 + nu * self.shaft.inertia * (1 / spring + 1 / driven)
        torque = effort + load * (nu * self.shaft.inertia / driven)
        excited = np.abs(torque) > 1e-9 * np.abs(torque).max()
        stuck = excited & (np.abs(below) < 1e-9 * np.abs(nu * self.shaft.inertia / spring))
        if stuck.any():
            order = self._orders[np.argmax(stuck)]
            raise NoSolutionError(
                f"the coupling is in resonance with harmonic {order:g} of the torque and nothing damps it: give "
                "'coupling.damping', or change its stiffness or the speed"
            )
        torque = np.asarray(torque / np.where(below == 0, 1.0, below), dtype=complex)
        speed: ComplexArray = np.asarray(torque / (nu * self.shaft.inertia), dtype=complex)
        return torque, speed, np.asarray(below, dtype=complex)

    def _series(self, amplitudes: ComplexArray, degrees: Array) -> Sampled:
        """Return Re Σ a e^{inφ} and its slope by φ at crank angles (n,)."""
        turn = np.exp(1j * np.radians(degrees) * (360 / self.cycle))
        phase, value, slope = np.ones_like(turn), np.zeros_like(turn), np.zeros_like(turn)
        for amplitude, order in zip(amplitudes, self._orders, strict=True):
            phase = phase * turn
            wave = amplitude * phase
            value, slope = value + wave, slope + 1j * order * wave
        return Sampled(value.real, slope.real)

    @cached_property
    def mean(self) -> float:
        """Mean torque in N m."""
        return mean_torque(self._effort, self.cycle)

    def torque(self, degrees: Array) -> Array:
        """Return the torque in the coupling in N m at crank angles (n,) in degrees."""
        return self.mean + self._series(self._balance[0], degrees).value

    def omega(self, degrees: Array) -> Array:
        """Return the angular velocity of the crank shaft in rad/s."""
        angles = np.mod(degrees, self.cycle)
        return self.shaft.omega + self._swing(angles, angles).value

    def _swing(self, degrees: Array, within: Array) -> Sampled:
        """Return ω − ω_n: what the effort alone would do, closed, less what the coupling takes, as a series."""
        back = self._series(self._balance[1], degrees)
        effort, work = self._alone.torque(degrees, within).value, self._alone_work(degrees)
        momentum = self.shaft.inertia * self.shaft.omega
        return Sampled((work - self._mean_work) / momentum - back.value, effort / momentum - back.slope)

    @cached_property
    def _alone(self) -> Sum:
        return Sum(((1.0, self._effort), (-1.0, Mean(self._effort, self.cycle))))

    def _alone_work(self, degrees: Array) -> Array:
        flat = degrees.ravel()
        return np.asarray(self._alone.work(np.zeros_like(flat), flat).sum(axis=0).reshape(degrees.shape))

    @cached_property
    def _mean_work(self) -> float:
        grid = Grid(self._effort.breaks)
        return grid.integral(self._alone_work(grid.degrees)) / math.radians(self.cycle)

    @cached_property
    def _extremes(self) -> dict[str, Extremes]:
        # the largest peaks belong to the orders up to the natural one; 18 nodes to a piece find them
        pieces = max(16, math.ceil(min(self._orders[-1], 4 * self.natural_order) * self.cycle / 360))
        grid = Grid(self._effort.breaks).split_at(np.linspace(0.0, self.cycle, pieces + 1))

        def evaluate(degrees: Array, within: Array) -> dict[str, Sampled]:
            return {"torque": self._series(self._balance[0], degrees), "omega": self._swing(degrees, within)}

        return extremes(grid, evaluate(grid.degrees, grid.within), evaluate)

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
        """ω_n: the balance is drawn up about it."""
        return self.shaft.omega

    @property
    def delta(self) -> float:
        """(ω_max − ω_min)/ω_n of the crank shaft."""
        swing = self._extremes["omega"]
        return (swing.largest.value - swing.smallest.value) / self.shaft.omega

    @cached_property
    def growth(self) -> float:
        """Logarithm of what is left of a small disturbance after a cycle: 2π n/ω_n times the largest real part.

        Of the eigenvalues of J₁ ω̇₁ = −T, J₂ ω̇₂ = T − c ω₂, T = k ∫(ω₁ − ω₂) dt + d (ω₁ − ω₂), about uniform rotation.
        """
        coupling, natural = self.coupling, self.natural_frequency
        own = np.array([coupling.stiffness / natural, coupling.damping, -coupling.damping]) / self.shaft.inertia
        driven = own * (self.shaft.inertia / coupling.inertia)
        driven[2] -= self.shaft.load_slope / coupling.inertia
        # with the twist as a speed, times the natural frequency, all entries are of one size
        matrix = np.stack((np.array([0.0, natural, -natural]), -own, driven))
        largest = float(np.linalg.eigvals(matrix).real.max())
        return largest * math.radians(self.cycle) / self.shaft.omega

    @cached_property
    def amplification(self) -> float | None:
        """Swing of the torque in the coupling over that in a rigid one, J₂ (M − L)/(J₁ + J₂) + L, if it swings."""
        own, driven = self.shaft.inertia, self.coupling.inertia
        rigid = Sum(((driven / (own + driven), self._effort), (own / (own + driven), self._load)))
        grid = Grid(rigid.breaks)

        def evaluate(degrees: Array, within: Array) -> dict[str, Sampled]:
            jet = rigid.torque(degrees, within)
            return {"torque": Sampled(jet.value, jet.slope)}

        found = extremes(grid, evaluate(grid.degrees, grid.within), evaluate)["torque"]
        swing = found.largest.value - found.smallest.value
        torque = self._extremes["torque"]
        return (torque.largest.value - torque.smallest.value) / swing if swing else None

    @property
    def resonances(self) -> tuple[Harmonic, ...]:
        """Harmonics that are present in the torque and lie near the natural order."""
        effort = np.abs(self._spectra[0]) + np.abs(self._spectra[1])
        distance = self._orders / self.natural_order - 1
        own, driven = self.shaft.inertia, self.coupling.inertia
        gain = np.abs(1 / self._balance[2]) * (own + driven) / driven
        near = (np.abs(distance) < _NEAR) & (effort > _WORTH * effort.max()) & (gain >= _AMPLIFIED)
        return tuple(
            Harmonic(*(float(of[i]) for of in (self._orders, distance, effort, gain))) for i in np.nonzero(near)[0]
        )
