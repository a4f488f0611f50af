"""Torques on the shaft over the crank angle, whatever they come from: one interface, sums, and the simple ones."""

import math
from functools import cached_property
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np

from kurbel.arrays import Array
from kurbel.crank_angle import unit_vector
from kurbel.numerics.grid import Cuts
from kurbel.numerics.jet import Jet

if TYPE_CHECKING:
    from kurbel.machine.turning import Effort, Harmonics


class Torque(Protocol):
    """A torque that repeats after a cycle."""

    @property
    def cuts(self) -> Cuts:
        """Where it bends or jumps over the cycle."""
        ...

    def torque(self, degrees: Array, within: Array) -> Jet:
        """Return the torque in N m with its slope by φ at crank angles (n,), on the sides that hold `within`."""
        ...


class Sum:
    """A sum of torques, each with a factor: the load counts −1."""

    def __init__(self, *parts: tuple[float, Torque]) -> None:
        self.parts = tuple((factor, part) for factor, part in parts if factor)

    @cached_property
    def cuts(self) -> Cuts:
        """The cuts of all parts."""
        return Cuts.joined([part.cuts for _, part in self.parts])

    @property
    def repeats(self) -> int:
        """How often it comes back in the cycle, as far as its parts know that of themselves."""
        return math.gcd(*(getattr(part, "repeats", 1) for _, part in self.parts))

    def torque(self, degrees: Array, within: Array | tuple[Any, ...]) -> Jet:
        """Return the sum with its slope; see `Torque`. within: angles, or what `inside` made of them."""
        total = Jet(np.zeros_like(degrees), np.zeros_like(degrees))
        of_each = within if isinstance(within, tuple) else (within,) * len(self.parts)
        for (factor, part), inside in zip(self.parts, of_each):
            total = total + part.torque(degrees, inside) * factor
        return total

    def inside(self, within: Array) -> tuple[Any, ...]:
        """Return what each part takes in place of these angles (n,): what all angles in a piece share is found once."""
        return tuple(part.inside(within) if hasattr(part, "inside") else within for _, part in self.parts)


class Uniform:
    """The same torque in N m all the time, over a cycle in degrees."""

    def __init__(self, value: float, cycle: float) -> None:
        self.value = value
        self.cuts = Cuts(np.array([0.0, cycle]))

    def torque(self, degrees: Array, within: Array) -> Jet:
        """Return the torque; see `Torque`."""
        return Jet(np.full_like(degrees, self.value), np.zeros_like(degrees))


class HarmonicTorque:
    """A torque by harmonics, over a cycle in degrees."""

    def __init__(self, given: "Harmonics", cycle: float) -> None:
        self._mean = given.mean
        self._orders, cos, sin = np.array(given.terms).T
        self._amplitudes = cos - 1j * sin
        # the nodes of one piece resolve a quarter of the shortest period
        pieces = math.ceil(cycle / 90 * max(1.0, float(self._orders.max())))
        self.cuts = Cuts(np.linspace(0.0, cycle, pieces + 1))

    def torque(self, degrees: Array, within: Array) -> Jet:
        """Return the torque with its slope; see `Torque`."""
        waves = unit_vector(np.multiply.outer(degrees, self._orders)) * self._amplitudes
        return Jet(self._mean + waves.real.sum(axis=-1), -(waves.imag * self._orders).sum(axis=-1))


class Diagram:
    """A turning-moment diagram by points, straight between them, that repeats from its last angle on."""

    def __init__(self, points: "Effort", cycle: float) -> None:
        angles, torques = np.array(points.angles), np.array(points.torques)
        self.period = float(angles[-1])
        width = np.diff(angles)
        kept = width > 0
        self._starts, self._torques = angles[:-1][kept], torques[:-1][kept]
        self._rises = np.diff(torques)[kept] / width[kept]
        turns = np.arange(0.0, cycle, self.period)
        self.cuts = Cuts(np.array([0.0, cycle]), np.concatenate([self._starts + turn for turn in turns]))

    def torque(self, degrees: Array, within: Array) -> Jet:
        """Return the torque with its slope; see `Torque`."""
        turn = self.period * np.floor(within / self.period)
        piece = np.searchsorted(self._starts, within - turn, side="right") - 1
        rise = self._rises[piece]
        return Jet(self._torques[piece] + rise * (degrees - turn - self._starts[piece]), np.degrees(rise))


def known_torque(effort: "Effort | Harmonics", cycle: float) -> Torque:
    """Return the torque of an effort that is known from elsewhere, over a cycle in degrees."""
    from kurbel.machine.turning import Harmonics

    return HarmonicTorque(effort, cycle) if isinstance(effort, Harmonics) else Diagram(effort, cycle)
