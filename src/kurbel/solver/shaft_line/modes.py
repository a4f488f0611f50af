"""Natural vibrations of a chain: frequencies, shapes, and Holzer's table.

Going along the chain at ω, s = θ_{i+1}/θ_i = 1 − r/k and r_{i+1} = r_i/s_i + ω² J_{i+1}, where r θ is the torque behind
a mass: Holzer's table as quotients. No step loses digits by cancellation but through the figures of its own mass and
piece, so that the sign of s, of which the negative ones count the modes below ω (Sturm), is that of a chain whose J and
k differ by rounding. A symmetric eigenproblem would lose the low modes of a chain of very unequal masses.
"""

from functools import cached_property
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from kurbel.arrays import Array, Indices
from kurbel.solver.shaft_line.chain import Chain

_NOTHING = 1e-40
"""What stands for a quotient of exactly zero: a mass that stands still."""
_STILL = 1e-6
"""A first mass that moves less than this, over the largest motion, is not what the others are told by."""


class Holzer(NamedTuple):
    """Holzer's table of a mode: amplitudes θ (n,), and torques (pieces,) in N m per radian of it.

    residual: what is left of the torque behind the last mass, over the largest one.
    """

    angles: Array
    torques: Array
    residual: float


class Modes:
    """The natural vibrations of a chain, the lowest first; the rigid rotation of a free one is the first."""

    def __init__(self, chain: Chain) -> None:
        self.chain = chain
        # read toward the fixed end
        self._line = chain.reversed() if chain.ground == "before" else chain

    @cached_property
    def omegas(self) -> Array:
        """Natural angular velocities in rad/s (n,), of a free chain the first exactly 0."""
        elastic = self._elastic()
        return elastic if self.chain.ground else np.concatenate(([0.0], elastic))

    def _elastic(self) -> Array:
        """Return those of the elastic modes by bisection of the number of modes below, to the last digit."""
        wanted = np.arange(len(self.chain.stiffnesses))
        low, high = self._between(wanted)
        while True:
            # halving exponents first, then digits
            middle = np.where(high > 2 * low, np.sqrt(low) * np.sqrt(high), low + (high - low) / 2)
            inside = (low < middle) & (middle < high)
            if not inside.any():
                return high
            more = self._below(middle) > wanted
            high, low = np.where(inside & more, middle, high), np.where(inside & ~more, middle, low)

    def _between(self, wanted: Indices) -> tuple[Array, Array]:
        """Return bounds of these modes: plain eigenvalues with their rounding, if that holds, or the bounds of all."""
        chain, roots = self._line, np.sqrt(self._line.inertias)
        matrix = (chain.twists.T * chain.stiffnesses) @ chain.twists / roots / roots[:, None]
        highest = 1.01 * float(np.sqrt(2 * np.diag(matrix).max()))  # Gershgorin, for the matrix J⁻¹ K
        about = np.sqrt(np.abs(np.linalg.eigvalsh(matrix)))[-len(wanted) :]
        share = 1e-14 * (1 + (highest / np.maximum(about, 1e-100 * highest)) ** 2)
        low, high = about * (1 - np.minimum(share, 0.5)), about * (1 + share)
        holds = (self._below(low) <= wanted) & (self._below(high) > wanted)
        lowest = self._below_all(highest)
        return np.where(holds, low, lowest), np.where(holds, high, highest)

    def _below_all(self, high: float) -> float:
        low = high
        while self._below(np.array([low]))[0] > 0:
            low *= 1e-3
        return low

    def _below(self, omegas: Array) -> Array:
        """Return how many elastic modes lie below each ω (m,)."""
        stiffness, last = self._line.stiffnesses, _behind(self._line, omegas)
        quotients = 1 - last[: len(stiffness)] / stiffness[:, None]
        negative = (quotients < 0).sum(axis=0)
        return np.asarray(negative if self.chain.ground else negative + (last[-1] > 0) - 1)

    def holzer(self, mode: int) -> Holzer:
        """Return the table of a mode, counted from 0.

        From the mass at which the tables from both ends meet best one goes outward both ways, where nothing grows.
        """
        omega = np.array([self.omegas[mode]])
        inertias, stiffnesses = self._line.inertias, self._line.stiffnesses
        behind, before = _behind(self._line, omega)[:, 0], _behind(self._line.reversed(), omega)[::-1, 0]
        own = omega[0] ** 2 * inertias
        gap = behind + before - own
        meet = int(np.argmin(np.abs(gap) / inertias))
        angles = np.ones(len(inertias))
        for index in range(meet - 1, -1, -1):
            angles[index] = angles[index + 1] / _not_zero(1 - behind[index] / stiffnesses[index])
        for index in range(meet + 1, len(inertias)):
            angles[index] = angles[index - 1] / _not_zero(1 - before[index] / stiffnesses[index - 1])
        torques = np.concatenate((behind[:meet] * angles[:meet], -(before * angles)[meet + 1 :]))
        if self.chain.ground:
            torques = np.append(torques, stiffnesses[-1] * angles[-1])
        if self.chain.ground == "before":
            angles, torques = angles[::-1], -torques[::-1]
        left = abs(float(gap[meet])) / max(float(np.abs(torques).max(initial=0.0)), float(own[meet]), 1e-300)
        unit = angles[0] if abs(angles[0]) > _STILL * np.abs(angles).max() else angles[np.argmax(np.abs(angles))]
        return Holzer(angles / unit, torques / unit, left)

    def nodes(self, mode: int) -> tuple[tuple[int, float], ...]:
        """Return where a mode stands still: the mass before, and the share of the way to the next one."""
        beside = enumerate(pairwise(self.holzer(mode).angles.tolist()))
        return tuple((mass, a / (a - b)) for mass, (a, b) in beside if a * b < 0 or a == 0 != b)


def _behind(chain: Chain, omegas: Array) -> Array:
    """Return r (n, m): the torque behind a mass over its angle, ω² J of it included, going along at ω (m,)."""
    squares, between = omegas * omegas, chain.stiffnesses[chain.between]
    found = np.empty((len(chain.inertias), len(omegas)))
    carried = np.full(len(omegas), -chain.stiffnesses[0] if chain.ground == "before" else 0.0)
    for index, inertia in enumerate(chain.inertias):
        found[index] = carried + squares * inertia
        if index < len(between):
            carried = found[index] / _not_zero(1 - found[index] / between[index])
    return found


def _not_zero(quotient: Array) -> Array:
    return np.where(quotient == 0, _NOTHING, quotient)
