"""The motion of a chain of masses over the crank angle: mode by mode where many masses make that cheaper."""

from __future__ import annotations

from typing import Any

import numpy as np

from kurbel.arrays import Array, Indices
from kurbel.numerics.collocation import Modal
from kurbel.numerics.pieces import Pieces
from kurbel.solver.chapters.chain import Chain
from kurbel.solver.speed import SpeedLaw

_SWING = 200.0
"""Degrees of the fastest natural vibration that a piece may hold at first, …"""
_MOST_PARTS = 8000
"""… though one is cut into no more parts than these."""


class ChainEquation:
    """y′ = A y + driving − rise: vibrations of chains without loss factors about uniform rotation at ω_n.

    Numbers of the chain are (n,), or (n, machines); order: the largest natural one, omega: ω_n in rad/s, numbers or
    (machines,); driving: torques on the masses less their means in N m, (n, nodes, pieces). law: how the load on the
    mass `loaded` rises with the speed; by_modes: of one machine, whether its modes are solved one by one.
    The unknowns are, in N m and of one size: for each segment the torque of its spring less its mean, over `order`, and
    for each mass J ω_n (ω − ω_n).
    """

    noise: Array
    modal: Modal | None = None

    def __init__(
        self,
        chain: Chain,
        order: Any,
        omega: Any,
        pieces: Pieces,
        driving: Array,
        law: SpeedLaw | None = None,
        loaded: int = 0,
        by_modes: bool = False,
    ) -> None:
        self._source = pieces
        self._driving = driving
        self._law = law
        self.noise = np.zeros(pieces.count)
        self._order, omega = (np.broadcast_to(number, pieces.count) for number in (order, omega))
        parts = np.ceil(2 * pieces.half * self._order[pieces.machine] / _SWING).clip(1, _MOST_PARTS)
        self.pieces = pieces.parted(parts.astype(int))

        numbers = (chain.inertias, chain.stiffnesses, chain.segment_damping, chain.mass_damping)
        inertias, stiffnesses, self._damping, self._against = (
            number.reshape(len(number), -1) for number in numbers
        )
        self._twists, self._speeds = chain.twists, 1 / (inertias * omega)
        self._springs = stiffnesses / (omega * self._order)
        self.unknowns = sum(chain.twists.shape)
        self.bounded = len(chain.stiffnesses) + loaded if law else None
        self._height = inertias[loaded] * omega**2
        unit = np.broadcast_to(
            np.eye(self.unknowns)[..., None], (self.unknowns, self.unknowns, pieces.count)
        )
        self._matrix = self._flow(unit, np.arange(pieces.count))[1]
        self.modal = self._modes(chain) if by_modes else None

    def _modes(self, chain: Chain) -> Modal:
        """Return the modes of the only machine, under a load that rises as at the nominal speed.

        Of unknowns whose squares are energies the matrix is skew but for the damping. Raises LinAlgError.
        """
        matrix = self._matrix[..., 0].copy()
        if self._law:
            matrix[self.bounded, self.bounded] -= self._law.steepness[0] / self._height[0]
        springs = np.sqrt(chain.stiffnesses) / self._order[0]
        masses = np.sqrt(chain.inertias) / (chain.inertias * self._speeds[:, 0])
        return Modal.of(matrix, np.concatenate((springs, masses)))

    def _flow(self, y: Array, machine: Indices) -> tuple[Array, Array]:
        """Return the torques in the segments (segments, k, n), and A y, at y (m, k, n) of these machines (n,)."""
        segments = len(self._springs)
        speeds = y[segments:] * self._speeds[:, None, machine]
        apart = np.tensordot(self._twists, speeds, 1)
        torques = self._order[machine] * y[:segments] + self._damping[:, None, machine] * apart
        masses = (
            -np.tensordot(self._twists.T, torques, 1) - self._against[:, None, machine] * speeds
        )
        return torques, np.concatenate((self._springs[:, None, machine] * apart, masses))

    def known(self, pieces: Pieces) -> Array:
        """Return the torques on the masses, and J ω_n² of the one under the load: less by so much, it stands still."""
        torques = pieces.resampled(self._driving, self._source)
        return np.concatenate(
            (torques, np.broadcast_to(pieces.of(self._height), (1, *torques.shape[1:])))
        )

    def rate(
        self, torques_and_height: Array, y: Array, pieces: Pieces
    ) -> tuple[Array, Array | None]:
        """Return y′ and its derivative by y, None where the modes are known."""
        torques, height = torques_and_height[:-1], torques_and_height[-1]
        rate = self._flow(y, pieces.machine)[1]
        rate[-len(torques) :] += torques
        slope = None
        if self.modal is None:
            slope = self._matrix[:, :, None, pieces.machine].repeat(y.shape[1], axis=2)
        if self._law:
            # with u = (ω − ω_n)/ω_n the square of the speed is 1 + u (2 + u) of the nominal one
            u = y[self.bounded] / height
            rise, by_square = self._law.rise(u * (2 + u), pieces)
            rate[self.bounded] -= rise
            if slope is not None:
                slope[self.bounded, self.bounded] -= by_square * 2 * (1 + u) / height
        return rate, slope

    def torques(self, y: Array, pieces: Pieces) -> Array:
        """Return the torques in the segments less their means in N m, (segments, nodes, pieces)."""
        return self._flow(y, pieces.machine)[0]

    def vibration(self, y: Array, pieces: Pieces) -> Array:
        """Return ω − ω_n of the masses in rad/s, (n, nodes, pieces)."""
        speeds = y[len(self._springs) :] * self._speeds[:, None, pieces.machine]
        return np.asarray(speeds)
