"""What torques of certain orders make of a chain at certain speeds, order by order.

(K (1 + iη) + iνω C − (νω)² J) θ = M has three diagonals. It is taken apart for all orders and speeds at once, the
larger of two rows first.
"""

import numpy as np

from kurbel.arrays import Array, ComplexArray
from kurbel.solver.shaft_line.chain import Chain

_AT_ONCE = 2048
"""Orders at speeds that are solved together: what the nearest memory holds."""


def responding(
    chain: Chain, frequencies: Array, torques: ComplexArray, more_damping: Array | None = None
) -> ComplexArray:
    """Return the angles (n, …) in rad of the masses under torques (n, …) in N m at angular frequencies νω (…) in rad/s.

    more_damping: of the masses beside their own, (n, …) in N m s/rad. Without any damping a resonance has no answer:
    it is not finite.
    """
    shape, flat = torques.shape, frequencies.ravel()
    held = np.zeros((1, 1)) if more_damping is None else more_damping.reshape(shape[0], -1)
    held, sides = np.broadcast_to(held, (shape[0], len(flat))), torques.reshape(shape[0], -1)
    parts = (slice(start, start + _AT_ONCE) for start in range(0, max(1, len(flat)), _AT_ONCE))
    each = [_responding(chain, flat[part], sides[:, part], held[:, part]) for part in parts]
    return np.concatenate(each, axis=1).reshape(shape)


def _responding(chain: Chain, frequencies: Array, torques: ComplexArray, held: Array) -> ComplexArray:
    """Return the angles (n, m) at frequencies (m,)."""
    spring = _springs(chain, frequencies)
    damping = chain.mass_damping[:, None] + held
    own = -np.multiply.outer(chain.inertias, frequencies**2) + 1j * damping * frequencies
    between = spring
    if chain.ground:
        end, at = (spring[0], 0) if chain.ground == "before" else (spring[-1], -1)
        own[at] += end
        between = spring[1:] if chain.ground == "before" else spring[:-1]
    own[:-1] += between
    own[1:] += between
    return _three_diagonals(own, -between, torques)


def twisting(chain: Chain, frequencies: Array, angles: ComplexArray) -> ComplexArray:
    """Return the torques (pieces, …) in N m in springs and dampers of the pieces; angles (n, …): see `responding`."""
    return np.asarray(_springs(chain, frequencies) * chain.twisted(angles))


def _springs(chain: Chain, frequencies: Array) -> ComplexArray:
    """Return k (1 + iη) + iνω d of the pieces, (pieces, …)."""
    still = (chain.stiffnesses * (1 + 1j * chain.loss)).reshape(-1, *(1,) * frequencies.ndim)
    return np.asarray(still + 1j * np.multiply.outer(chain.piece_damping, frequencies))


def _three_diagonals(own: ComplexArray, beside: ComplexArray, sides: ComplexArray) -> ComplexArray:
    """Return x (n, m) with beside_{i−1} x_{i−1} + own_i x_i + beside_i x_{i+1} = sides_i."""
    count, width = own.shape
    # of each row that is done with: the factors of x_i, x_{i+1}, x_{i+2}, and its right side
    done = np.zeros((count, 4, width), dtype=complex)
    row, lower = np.zeros((2, 4, width), dtype=complex)
    row[0], row[3] = own[0], sides[0]
    row[1] = beside[0] if count > 1 else 0.0
    for index in range(1, count):
        lower[0], lower[1], lower[3] = beside[index - 1], own[index], sides[index]
        lower[2] = beside[index] if index + 1 < count else 0.0
        swap = np.abs(lower[0]) > np.abs(row[0])
        above = np.where(swap, lower, row)
        below = np.where(swap, row, lower)
        done[index - 1] = above
        row[[0, 1, 3]] = below[1:] - below[0] / above[0] * above[1:]
    done[-1] = row
    found = np.zeros((count + 2, width), dtype=complex)
    for index in range(count - 1, -1, -1):
        first, second, third, right = done[index]
        found[index] = (right - second * found[index + 1] - third * found[index + 2]) / first
    return np.asarray(found[:-2])
