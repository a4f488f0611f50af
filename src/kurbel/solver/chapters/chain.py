"""A shaft line as a chain of masses on segments of shaft: natural vibrations, response to torques, periodic motion.

          k₀, d₀        k₁, d₁                    T_i = k_i (θ_i − θ_{i+1}) + d_i (θ̇_i − θ̇_{i+1})
    J₀ ═══════════ J₁ ═══════════ J₂              J_i θ̈_i = M_i − c_i θ̇_i + T_{i−1} − T_i
    │      T₀      │      T₁      │
    c₀             c₁             c₂              θ: vibration about uniform rotation, all referred to one shaft

A segment carries the torque T from the mass before it to the mass behind it. Where an end is fixed, a segment leads
from there to the first mass, or from the last mass there.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from kurbel.arrays import Array, ComplexArray, Indices
from kurbel.machine.shaft_line import ShaftLine
from kurbel.numerics.pieces import Pieces
from kurbel.solver.speed import SpeedLaw

_NOTHING = 1e-40
"""In place of a quotient of Holzer's table that is exactly zero: there a mass stands still."""
_STILL = 1e-6
"""A first mass that moves less than this, over the largest motion, is not what the others are referred to."""


@dataclass(frozen=True, eq=False)
class Chain:
    """n masses and the segments between them, one more for each fixed end: `ground` is `before`, `after`, `both` or ''.

    inertias in kg m² (n,), stiffnesses in N m/rad; segment_damping, mass_damping in N m s/rad, of a twist and against
    uniform rotation; loss: loss factors η of the segments, with k (1 + iη).
    """

    inertias: Array
    stiffnesses: Array
    segment_damping: Array
    mass_damping: Array
    loss: Array
    ground: str = ""

    @classmethod
    def of(cls, line: ShaftLine, inertias: Sequence[float]) -> Chain:
        """Return the chain of a shaft line; inertias: those of its masses in kg m², with all that turns there."""
        each = np.array([(piece.stiffness, piece.damping, piece.loss_factor) for piece in line.pieces]).T
        damping = np.array([mass.damping for mass in line.masses])
        return cls(np.array(inertias), each[0], each[1], damping, each[2], line.ground)

    @cached_property
    def twists(self) -> Array:
        """The matrix (segments, n) that turns angles of the masses into twists, that before less that behind."""
        first, last = self.held
        held = np.eye(len(self.inertias) + first + last)
        return (held[:-1] - held[1:])[:, int(first) : len(held) - last]

    @property
    def held(self) -> tuple[bool, bool]:
        """Whether the end before the first mass is fixed, and that behind the last one."""
        return self.ground in ("before", "both"), self.ground in ("after", "both")

    @property
    def around(self) -> Array:
        """The stiffnesses (n + 1,) before the first mass, between the masses and behind the last, 0 at a free end."""
        first, last = self.held
        return np.concatenate(([0.0] * (not first), self.stiffnesses, [0.0] * (not last)))

    def springs(self, frequencies: Array) -> ComplexArray:
        """Return k (1 + iη) + iΩ d of the segments at angular frequencies Ω (…) in rad/s, (segments, …)."""
        still = (self.stiffnesses * (1 + 1j * self.loss)).reshape(-1, *(1,) * frequencies.ndim)
        return still + 1j * np.multiply.outer(self.segment_damping, frequencies)


# response to torques of one frequency


def response(
    chain: Chain, frequencies: Array, torques: ComplexArray, load_damping: Array | float = 0.0
) -> ComplexArray:
    """Return the complex amplitudes in rad (n, …) under torques (n, …) in N m at angular frequencies Ω (…) in rad/s.

    (K (1 + iη) + iΩ C − Ω² J) θ = M; load_damping: of the masses in addition to their own, (n, …) in N m s/rad. A
    resonance that nothing damps has no answer: it is not finite.
    """
    omegas, sides = frequencies.ravel(), torques.reshape(len(torques), -1)
    damping = chain.mass_damping[:, None] + np.broadcast_to(load_damping, torques.shape).reshape(sides.shape)
    twists, springs = chain.twists, chain.springs(omegas)
    # a pivot of exactly zero is none: it ends as inf
    own = 1j * (damping * omegas + np.finfo(float).tiny) - np.outer(chain.inertias, omegas**2)
    matrices = (twists.T * springs.T[:, None]) @ twists + own.T[:, :, None] * np.eye(len(own))

    def solved(sides: ComplexArray) -> ComplexArray:
        return np.linalg.solve(matrices, sides.T[:, :, None])[:, :, 0].T

    angles = solved(sides)
    # of soft masses on stiff springs the matrix has lost digits, what is left over by the masses and the twists has not
    left = sides - own * angles - twists.T @ (springs * (twists @ angles))
    return (angles + solved(left)).reshape(torques.shape)


def passing(chain: Chain, frequencies: Array, angles: ComplexArray) -> ComplexArray:
    """Return the torques (segments, …) in N m in springs and dampers of the segments; angles (n, …): see `response`."""
    return chain.springs(frequencies) * np.tensordot(chain.twists, angles, 1)


# natural vibrations


class Holzer(NamedTuple):
    """Holzer's table of a mode: amplitudes Θ (n,), and torques (segments,) in N m per radian of the first mass.

    residual: what is left of the torque behind the last mass, over the largest one.
    """

    angles: Array
    torques: Array
    residual: float


def holzer_at(chain: Chain, omega: float) -> Holzer:
    """Return Holzer's table at any angular frequency in rad/s, from the first mass on.

    residual: the torque left behind the last mass in N m, or at a fixed end behind it the angle left in rad, both per
    radian of the first mass: at a natural frequency it is zero.
    """
    springs, angles = chain.around, [1.0]
    torques = [-springs[0]]
    for inertia, stiffness in zip(chain.inertias, springs[1:]):
        torques.append(torques[-1] + omega**2 * inertia * angles[-1])
        angles.append(angles[-1] - torques[-1] / (stiffness or math.inf))
    far = angles.pop()
    return Holzer(np.array(angles), np.array(torques)[springs != 0], far if chain.held[1] else torques[-1])


class Modes:
    """The natural vibrations of a chain, the lowest first; of a free one the first is the rotation of the whole.

    Along the chain at ω, θ_{i+1}/θ_i = s = 1 − r/k and r_{i+1} = r_i/s_i + ω² J_{i+1}, where r θ is the torque behind a
    mass: Holzer's table as quotients. No step loses digits by cancellation but through the figures of its own mass and
    segment, so that the sign of s, of which the negative ones count the modes below ω (Sturm), is that of a chain whose
    J and k differ by rounding. A symmetric eigenproblem would lose the low modes of a chain of very unequal masses.
    """

    def __init__(self, chain: Chain) -> None:
        self.chain = chain
        self._onward = -1 if chain.ground == "before" else 1  # read toward the fixed end
        self._inertias, self._springs = chain.inertias[:: self._onward], chain.around[:: self._onward]

    @cached_property
    def omegas(self) -> Array:
        """Natural angular frequencies in rad/s (n,), of a free chain the first exactly 0.

        Those of the elastic modes by bisection of the number of modes below, to the last digit.
        """
        elastic = len(self.chain.inertias) - (not self.chain.ground)
        wanted, springs = np.arange(elastic), self._springs[:-1] + self._springs[1:]
        high = np.full(len(wanted), 1.01 * np.sqrt(2 * (springs / self._inertias).max()))  # Gershgorin, J⁻¹ K
        low = high * 1e-3
        while self._below(low[:1])[0]:
            low = low * 1e-3
        while True:
            # exponents are halved first, then digits
            middle = np.where(high > 2 * low, np.sqrt(low) * np.sqrt(high), low + (high - low) / 2)
            inside = (low < middle) & (middle < high)
            if not inside.any():
                return high if self.chain.ground else np.append(0.0, high)
            more = self._below(middle) > wanted
            high, low = np.where(inside & more, middle, high), np.where(inside & ~more, middle, low)

    def _below(self, omegas: Array) -> Array:
        """Return how many elastic modes are below each ω (m,)."""
        negative = (_behind(self._inertias, self._springs, omegas) > self._springs[1:, None]).sum(axis=0)
        return negative - (not self.chain.ground)

    def holzer(self, mode: int) -> Holzer:
        """Return the table of a mode, counted from 0.

        From the mass at which the tables from both ends meet best it is computed outward both ways, where no error
        grows.
        """
        omega, inertias, springs = self.omegas[mode : mode + 1], self._inertias, self._springs
        behind = _behind(inertias, springs, omega)[:, 0]
        before = _behind(inertias[::-1], springs[::-1], omega)[::-1, 0]
        own = omega[0] ** 2 * inertias
        gap = behind + before - own
        meet = int(np.argmin(np.abs(gap) / inertias))
        up = 1 / _not_zero(1 - behind[:meet] / springs[1 : meet + 1])
        down = 1 / _not_zero(1 - before[meet + 1 :] / springs[meet + 1 : -1])
        angles = np.concatenate((np.cumprod(up[::-1])[::-1], [1.0], np.cumprod(down)))
        inner = behind[:meet] * angles[:meet], -(before * angles)[meet + 1 :]
        torques = np.concatenate(([-springs[0] * angles[0]], *inner, [springs[-1] * angles[-1]]))[springs != 0]
        if self._onward < 0:
            angles, torques = angles[::-1], -torques[::-1]
        left = abs(float(gap[meet])) / max(float(np.abs(torques).max(initial=0.0)), float(own[meet]), 1e-300)
        unit = angles[0] if abs(angles[0]) > _STILL * np.abs(angles).max() else angles[np.argmax(np.abs(angles))]
        return Holzer(angles / unit, torques / unit, left)

    def nodes(self, mode: int) -> tuple[tuple[int, float], ...]:
        """Return where a mode has no motion: the mass before, and the share of the segment up to there."""
        neighbours = enumerate(pairwise(self.holzer(mode).angles.tolist()))
        return tuple((mass, a / (a - b)) for mass, (a, b) in neighbours if a * b < 0 or a == 0 != b)


def _behind(inertias: Array, springs: Array, omegas: Array) -> Array:
    """Return r (n, m): the torque behind a mass over its angle, ω² J of it included, along a chain at ω (m,).

    springs: those around the masses, see `Chain.around`.
    """
    found, carried = np.empty((len(inertias), len(omegas))), np.full(len(omegas), -springs[0])
    for i, inertia in enumerate(inertias):
        found[i] = carried + omegas * omegas * inertia
        if i + 1 < len(found):
            carried = found[i] / _not_zero(1 - found[i] / springs[i + 1])
    return found


def _not_zero(quotient: Array) -> Array:
    return np.where(quotient == 0, _NOTHING, quotient)


# periodic motion over the angle, with all its orders

_SWING = 200.0
"""Degrees of the fastest natural vibration that a piece may hold at first, …"""
_MOST_PARTS = 8000
"""… though one is cut into no more parts than these."""


class ChainEquation:
    """y′ = A y + driving − rise: vibrations of chains without loss factors about uniform rotation at ω_n.

    Numbers of the chain are (n,), or (n, machines); order: the largest natural one, omega: ω_n in rad/s, numbers or
    (machines,); driving: torques on the masses less their means in N m, (n, nodes, pieces). law: how the load on the
    mass `loaded` rises with the speed. The unknowns are, in N m and of one size: for each segment the torque of its
    spring less its mean, over `order`, and for each mass J ω_n (ω − ω_n).
    """

    noise: Array

    def __init__(
        self,
        chain: Chain,
        order: Any,
        omega: Any,
        pieces: Pieces,
        driving: Array,
        law: SpeedLaw | None = None,
        loaded: int = 0,
    ) -> None:
        self._source, self._driving, self._law, self.noise = pieces, driving, law, np.zeros(pieces.count)
        self._order, omega = (np.broadcast_to(one, pieces.count) for one in (order, omega))
        parts = np.ceil(2 * pieces.half * self._order[pieces.machine] / _SWING).clip(1, _MOST_PARTS)
        self.pieces = pieces.parted(parts.astype(int))

        numbers = (chain.inertias, chain.stiffnesses, chain.segment_damping, chain.mass_damping)
        inertias, stiffnesses, self._damping, self._against = (one.reshape(len(one), -1) for one in numbers)
        self._twists, self._speeds = chain.twists, 1 / (inertias * omega)
        self._springs = stiffnesses / (omega * self._order)
        self.unknowns = sum(chain.twists.shape)
        self.bounded = len(chain.stiffnesses) + loaded if law else None
        self._height = inertias[loaded] * omega**2
        unit = np.broadcast_to(np.eye(self.unknowns)[..., None], (self.unknowns, self.unknowns, pieces.count))
        self._matrix = self._flow(unit, np.arange(pieces.count))[1]

    def _flow(self, y: Array, machine: Indices) -> tuple[Array, Array]:
        """Return the torques in the segments (segments, k, n), and A y, at y (m, k, n) of these machines (n,)."""
        segments = len(self._springs)
        speeds = y[segments:] * self._speeds[:, None, machine]
        apart = np.tensordot(self._twists, speeds, 1)
        torques = self._order[machine] * y[:segments] + self._damping[:, None, machine] * apart
        masses = -np.tensordot(self._twists.T, torques, 1) - self._against[:, None, machine] * speeds
        return torques, np.concatenate((self._springs[:, None, machine] * apart, masses))

    def known(self, pieces: Pieces) -> Array:
        """Return the torques on the masses, and J ω_n² of the one under the load: less by so much, it stands still."""
        torques = pieces.carried(self._driving, self._source)
        return np.concatenate((torques, np.broadcast_to(pieces.of(self._height), (1, *torques.shape[1:]))))

    def rate(self, known: Array, y: Array, pieces: Pieces) -> tuple[Array, Array]:
        """Return y′ and its derivative by y."""
        torques, height = known[:-1], known[-1]
        rate = self._flow(y, pieces.machine)[1]
        rate[-len(torques) :] += torques
        slope = self._matrix[:, :, None, pieces.machine].repeat(y.shape[1], axis=2)
        if self._law:
            # with u = (ω − ω_n)/ω_n the square of the speed is 1 + u (2 + u) of the nominal one
            u = y[self.bounded] / height
            rise, by_square = self._law.rise(u * (2 + u), pieces)
            rate[self.bounded] -= rise
            slope[self.bounded, self.bounded] -= by_square * 2 * (1 + u) / height
        return rate, slope

    def torques(self, y: Array, pieces: Pieces) -> Array:
        """Return the torques in the segments less their means in N m, (segments, nodes, pieces)."""
        return self._flow(y, pieces.machine)[0]
