"""What torques of certain orders make of a chain at certain speeds: (K (1 + iη) + iνω C − (νω)² J) θ = M, order by order.

The matrix has three diagonals. It is taken apart for all orders and speeds at once, the larger of two rows first.
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
    count = len(chain.inertias)
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
    return _three_diagonals(own, -between, np.array(torques, dtype=complex), count)


def twisting(chain: Chain, frequencies: Array, angles: ComplexArray) -> ComplexArray:
    """Return the torques (pieces, …) in N m in springs and dampers of the pieces; angles (n, …) as `responding` has them."""
    return np.asarray(_springs(chain, frequencies) * np.tensordot(chain.twists, angles, axes=1))


def _springs(chain: Chain, frequencies: Array) -> ComplexArray:
    """Return k (1 + iη) + iνω d of the pieces, (pieces, …)."""
    still = (chain.stiffnesses * (1 + 1j * chain.loss)).reshape(-1, *(1,) * frequencies.ndim)
    return np.asarray(still + 1j * np.multiply.outer(chain.piece_damping, frequencies))


def _three_diagonals(own: ComplexArray, beside: ComplexArray, sides: ComplexArray, count: int) -> ComplexArray:
    """Return x (n, …) with beside_{i−1} x_{i−1} + own_i x_i + beside_i x_{i+1} = sides_i."""
    first, second, third, right = [], [], [], []
    row = own[0], beside[0] if count > 1 else None, sides[0]
    for index in range(1, count):
        after = beside[index] if index + 1 < count else np.zeros_like(own[0])
        lower = beside[index - 1], own[index], after, sides[index]
        upper = row[0], row[1], np.zeros_like(own[0]), row[2]
        swap = np.abs(lower[0]) > np.abs(upper[0])
        above = [np.where(swap, low, up) for low, up in zip(lower, upper)]
        below = [np.where(swap, up, low) for low, up in zip(lower, upper)]
        share = below[0] / above[0]
        for kept, part in zip((first, second, third, right), above):
            kept.append(part)
        row = below[1] - share * above[1], below[2] - share * above[2], below[3] - share * above[3]
    found = np.empty_like(sides)
    found[-1] = row[2] / row[0]
    for index in range(count - 2, -1, -1):
        known = second[index] * found[index + 1]
        if index + 2 < count:
            known = known + third[index] * found[index + 2]
        found[index] = (right[index] - known) / first[index]
    return found
