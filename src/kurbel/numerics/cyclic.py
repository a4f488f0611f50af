"""Equations joined round a cycle: each has the unknowns of one place and of the next, the last those of the first."""

import numpy as np

from kurbel.arrays import Array


def around(before: Array, after: Array, sides: Array) -> Array:
    """Return x (k, m) with before_i x_i + after_i x_{i+1} = sides_i, x_k being x_0; matrices (k, m, m), sides (k, m).

    Every second x is eliminated by rotations, which do not mind whether a solution grows or dies on its way, until one
    is left. What the equations leave open there is taken as small as can be. Raises LinAlgError where floats do not
    reach.
    """
    if not all(np.isfinite(one).all() for one in (before, after, sides)):
        raise np.linalg.LinAlgError("beyond the range of floats")  # LAPACK itself prints it, or answers with anything
    return _around(before, after, sides)


def _around(before: Array, after: Array, sides: Array) -> Array:
    count, size = sides.shape
    if count == 1:
        # a direction that is open has a singular value of rounding, 1e-13 as it may be; one of 1e-11 has no digit left
        return np.asarray(np.linalg.lstsq(before[0] + after[0], sides[0], rcond=1e-11)[0][None])
    even, odd = slice(0, count - 1, 2), slice(1, count, 2)
    turn, upper = np.linalg.qr(np.concatenate((after[even], before[odd]), axis=1), mode="complete")
    empty = np.zeros_like(before[odd])
    blocks = ((before[even], empty, sides[even][..., None]), (empty, after[odd], sides[odd][..., None]))
    rows = np.swapaxes(turn, 1, 2) @ np.concatenate([np.concatenate(row, axis=2) for row in blocks], axis=1)
    parts = rows[:, size:, :size], rows[:, size:, size:-1], rows[:, size:, -1]
    left = [np.concatenate((part, whole[2 * len(part) :])) for part, whole in zip(parts, (before, after, sides))]
    found = np.empty_like(sides)
    found[::2] = _around(*left)
    ends = np.concatenate((found[even], np.roll(found[::2], -1, axis=0)[: len(turn)]), axis=1)
    rest = rows[:, :size, -1:] - rows[:, :size, :-1] @ ends[..., None]
    found[odd] = np.linalg.solve(upper[:, :size], rest)[..., 0]
    return found
