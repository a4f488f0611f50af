"""Torques on the shaft over the crank angle, whatever they come from: one interface, sums, and the simple ones."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Protocol

import numpy as np

from kurbel.machine.turning import Effort
from kurbel.numerics.arithmetic import exact_sum, running_sums
from kurbel.numerics.grid import ascending
from kurbel.numerics.jet import Jet

if TYPE_CHECKING:
    from kurbel.arrays import Array, Indices


class Torque(Protocol):
    """A torque that repeats after a cycle."""

    @property
    def breaks(self) -> Array:
        """Crank angles (n,) in degrees, from 0 to the full cycle, at which it bends or jumps."""
        ...

    def torque(self, degrees: Array, within: Array) -> Jet:
        """Return the torque in N m with its slope by φ at crank angles (n,), on the sides that hold `within`."""
        ...

    def work(self, low: Array, high: Array) -> Array:
        """Return ∫ M dφ in J from `low` to `high` (n,) in degrees, as terms (k, n) that add up to it.

        The terms are differences taken before anything is summed, so that an exact sum of them loses nothing.
        """
        ...


def total_work(torque: Torque, low: float, high: float) -> float:
    """Return ∫ M dφ in J between two angles in degrees, its terms added exactly."""
    return total_works(torque, (low,), (high,))[0]


def total_works(torque: Torque, low: Sequence[float], high: Sequence[float]) -> list[float]:
    """Return ∫ M dφ in J between every two angles in degrees, each by terms added exactly."""
    return [exact_sum(terms) for terms in torque.work(np.array(low), np.array(high)).T.tolist()]


def exact_product(a: Array, b: Array | float) -> Array:
    """Return a·b (k, n) as terms (2k, n) whose sum is the exact product (Dekker)."""
    product = a * b
    a_high, b_high = (x * 134217729.0 - (x * 134217729.0 - x) for x in (a, b))
    a_low, b_low = a - a_high, b - b_high
    return np.concatenate((product, ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low))


class Sum:
    """A sum of torques, each with a factor: the load counts −1."""

    def __init__(self, parts: Sequence[tuple[float, Torque]]) -> None:
        self.parts = tuple((factor, part) for factor, part in parts if factor)

    @cached_property
    def breaks(self) -> Array:
        """The breaks of all parts; two that differ by rounding only are one."""
        joined = np.concatenate([part.breaks for _, part in self.parts])
        end = joined.max()
        kept = ascending(joined, apart=1e-10)
        kept = kept[kept < end - 1e-10]
        return np.append(kept, end)

    def torque(self, degrees: Array, within: Array) -> Jet:
        """Return the sum with its slope; see `Torque`."""
        total = Jet(np.zeros_like(degrees), np.zeros_like(degrees))
        for factor, part in self.parts:
            total = total + part.torque(degrees, within) * factor
        return total

    def work(self, low: Array, high: Array) -> Array:
        """Return the terms of all parts; see `Torque`."""
        return np.concatenate([part.work(low, high) * factor for factor, part in self.parts])


class Uniform:
    """The same torque in N m all the time, over a cycle in degrees."""

    def __init__(self, value: float, cycle: float) -> None:
        self.value = value
        self.breaks = np.array([0.0, cycle])

    def torque(self, degrees: Array, within: Array) -> Jet:
        """Return the torque; see `Torque`."""
        return Jet(np.full_like(degrees, self.value), np.zeros_like(degrees))

    def work(self, low: Array, high: Array) -> Array:
        """Return the work; see `Torque`."""
        return self.value * np.radians(high - low)[None, :]


class Mean(Uniform):
    """The mean of another torque, all the time.

    Over a cycle its work is many times the excess; it is held as two floats so that their difference keeps its digits.
    """

    def __init__(self, torque: Torque, cycle: float) -> None:
        terms: list[float] = torque.work(np.array([0.0]), np.array([cycle]))[:, 0].tolist()
        whole = exact_sum(terms)
        self._per_degree = whole / cycle
        there = exact_product(np.array([[self._per_degree]]), cycle)[:, 0].tolist()
        self._rest = exact_sum((*terms, *(-part for part in there))) / cycle
        super().__init__(whole / math.radians(cycle), cycle)

    def work(self, low: Array, high: Array) -> Array:
        """Return the work; see `Torque`."""
        ends = np.stack((high, -low))
        return np.concatenate((exact_product(ends, self._per_degree), (high - low)[None, :] * self._rest))


class Diagram:
    """A turning-moment diagram by points, straight between them, that repeats from its last angle on."""

    def __init__(self, points: Effort, cycle: float) -> None:
        angles, torques = np.array(points.angles), np.array(points.torques)
        self.period = float(angles[-1])
        width = np.diff(angles)
        kept = width > 0
        self._starts, self._torques, self._widths = angles[:-1][kept], torques[:-1][kept], width[kept]
        self._rises = np.diff(torques)[kept] / self._widths
        turns = np.arange(0.0, cycle, self.period)
        self.breaks = np.append(np.concatenate([self._starts + turn for turn in turns]), cycle)

    def _piece(self, degrees: Array) -> Indices:
        return np.searchsorted(self._starts, np.mod(degrees, self.period), side="right") - 1

    def torque(self, degrees: Array, within: Array) -> Jet:
        """Return the torque with its slope; see `Torque`."""
        piece = self._piece(within)
        turn = self.period * np.floor(within / self.period)
        rise = self._rises[piece]
        return Jet(self._torques[piece] + rise * (degrees - turn - self._starts[piece]), np.degrees(rise))

    @cached_property
    def _areas(self) -> Array:
        """Work in N m deg up to the start of each piece, and over the whole period at the end."""
        pieces = self._widths * (self._torques + self._rises * self._widths / 2)
        return np.array([0.0, *(total for total, _ in running_sums((one,) for one in pieces.tolist()))])

    def work(self, low: Array, high: Array) -> Array:
        """Return the closed work; see `Torque`."""
        (turns_low, area_low, part_low), (turns_high, area_high, part_high) = map(self._work_to, (low, high))
        terms = self._areas[-1] * (turns_high - turns_low), area_high - area_low, part_high - part_low
        return np.asarray(np.radians(np.stack(terms)))

    def _work_to(self, degrees: Array) -> tuple[Array, Array, Array]:
        turns = np.floor(degrees / self.period)
        piece = self._piece(degrees)
        way = degrees - turns * self.period - self._starts[piece]
        return turns, self._areas[piece], way * (self._torques[piece] + self._rises[piece] * way / 2)
