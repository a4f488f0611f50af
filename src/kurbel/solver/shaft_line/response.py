"""What torques of certain orders make of a chain at certain speeds, order by order.

(K (1 + iη) + iνω C − (νω)² J) θ = M has three diagonals. It is taken apart for all orders and speeds at once, the
larger of two rows first.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kurbel.solver.shaft_line.chain import Chain

if TYPE_CHECKING:
    from kurbel.arrays import Array, ComplexArray


def responding(
    chain: Chain, frequencies: Array, torques: ComplexArray, more_damping: Array | None = None
) -> ComplexArray:
    """Return the angles (n, …) in rad of the masses under torques (n, …) in N m at angular frequencies νω (…) in rad/s.

    more_damping: of the masses beside their own, (n, …) in N m s/rad. Without any damping a resonance has no answer:
    it is not finite.
    """
    spring = _springs(chain, frequencies)
    own = -np.multiply.outer(chain.inertias, frequencies**2) + 1j * np.multiply.outer(chain.mass_damping, frequencies)
    if more_damping is not None:
        own = own + 1j * more_damping * frequencies
    between = spring
    if chain.ground:
        held, at = (spring[0], 0) if chain.ground == "before" else (spring[-1], -1)
        own[at] += held
        between = spring[1:] if chain.ground == "before" else spring[:-1]
    own[:-1] += between
    own[1:] += between
    return _three_diagonals(own, -between, np.array(torques, dtype=complex))


def twisting(chain: Chain, frequencies: Array, angles: ComplexArray) -> ComplexArray:
    """Return the torques (pieces, …) in N m in springs and dampers of the pieces; angles (n, …): see `responding`."""
    return np.asarray(_springs(chain, frequencies) * np.tensordot(chain.twists, angles, axes=1))


def _springs(chain: Chain, frequencies: Array) -> ComplexArray:
    """Return k (1 + iη) + iνω d of the pieces, (pieces, …)."""
    still = (chain.stiffnesses * (1 + 1j * chain.loss)).reshape(-1, *(1,) * frequencies.ndim)
    return np.asarray(still + 1j * np.multiply.outer(chain.piece_damping, frequencies))


def _three_diagonals(own: ComplexArray, beside: ComplexArray, sides: ComplexArray) -> ComplexArray:
    """Return x (n, …) with beside_{i−1} x_{i−1} + own_i x_i + beside_i x_{i+1} = sides_i."""
    zero = np.zeros_like(own[:1])
    beside = np.concatenate((beside, zero))
    # of each row that is done with: the factors of x_i, x_{i+1}, x_{i+2}, and its right side
    done = np.empty((len(own), 4, *own.shape[1:]), dtype=complex)
    row = np.stack((own[0], beside[0], zero[0], sides[0]))
    for index in range(1, len(own)):
        lower = np.stack((beside[index - 1], own[index], beside[index], sides[index]))
        swap = np.abs(lower[0]) > np.abs(row[0])
        done[index - 1] = above = np.where(swap, lower, row)
        below = np.where(swap, row, lower)
        rest = below[1:] - below[0] / above[0] * above[1:]
        row = np.stack((rest[0], rest[1], zero[0], rest[2]))
    done[-1] = row
    found = np.zeros((len(own) + 2, *own.shape[1:]), dtype=complex)
    for index in range(len(own) - 1, -1, -1):
        first, second, third, right = done[index]
        found[index] = (right - second * found[index + 1] - third * found[index + 2]) / first
    return np.asarray(found[:-2])
