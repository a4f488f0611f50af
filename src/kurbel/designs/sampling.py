"""Points of a sample in the unit cube: a Latin hypercube, or the sequence of Sobol, by numpy alone."""

from typing import Any

import numpy as np

from kurbel.arrays import Array
from kurbel.errors import UsageError

_BITS = 32
_DIRECTIONS = (
    (1, 0, (1,)),
    (2, 1, (1, 3)),
    (3, 1, (1, 3, 1)),
    (3, 2, (1, 1, 1)),
    (4, 1, (1, 1, 3, 3)),
    (4, 4, (1, 3, 5, 13)),
    (5, 2, (1, 1, 5, 5, 17)),
    (5, 4, (1, 1, 5, 5, 5)),
    (5, 7, (1, 1, 7, 11, 19)),
    (5, 11, (1, 1, 5, 1, 1)),
    (5, 13, (1, 1, 1, 3, 11)),
    (5, 14, (1, 3, 5, 5, 31)),
)
"""Degree and coefficients of the primitive polynomials, and first direction numbers, after Joe and Kuo (2008)."""


def latin_hypercube(count: int, width: int, seed: int) -> Array:
    """Return (count, width) numbers between 0 and 1: in every column one in each of `count` equal strips, at random."""
    random = np.random.default_rng(seed)
    strips = random.permuted(np.tile(np.arange(float(count))[:, None], width), axis=0)
    # neither 0 nor 1, so that no distribution is asked for its end
    within = np.clip(random.random((count, width)), 2.0**-40, 1 - 2.0**-40)
    return np.asarray((strips + within) / count)


def sobol(count: int, width: int, seed: int) -> Array:
    """Return the first points (count, width) of the sequence of Sobol, shifted digit by digit at random.

    Raises UsageError for more columns than there are direction numbers.
    """
    if width > len(_DIRECTIONS) + 1:
        raise UsageError(f"--sobol: {width} distributions; the sequence is known for {len(_DIRECTIONS) + 1} here")
    shift = np.random.default_rng(seed).integers(0, 2**_BITS, width, dtype=np.uint64)
    return np.asarray((np.bitwise_xor(_digits(count, width), shift).astype(float) + 0.5) / 2.0**_BITS)


def _digits(count: int, width: int) -> Any:
    """Return the points as whole numbers below 2³², in the order of the Gray code (Antonov and Saleev)."""
    change = np.arange(count, dtype=np.uint64)
    change = change ^ (change >> np.uint64(1))
    found = np.zeros((count, width), dtype=np.uint64)
    for column in range(width):
        for bit, direction in enumerate(_direction_numbers(column)):
            found[:, column] ^= np.where((change >> np.uint64(bit)) & np.uint64(1), np.uint64(direction), np.uint64(0))
    return found


def _direction_numbers(column: int) -> list[int]:
    if not column:
        return [1 << (_BITS - 1 - bit) for bit in range(_BITS)]
    degree, polynomial, first = _DIRECTIONS[column - 1]
    numbers = [number << (_BITS - 1 - bit) for bit, number in enumerate(first)]
    for bit in range(degree, _BITS):
        number = numbers[bit - degree] ^ (numbers[bit - degree] >> degree)
        for k in range(1, degree):
            if (polynomial >> (degree - 1 - k)) & 1:
                number ^= numbers[bit - k]
        numbers.append(number)
    return numbers
