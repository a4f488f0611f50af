"""Periodic solutions of y′ = A y + f(φ), a few unknowns with constant coefficients, by the collocation of `elements`.

Being linear, the unknowns of every element are solved for at once, and joined round the cycle by rotations.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Protocol

import numpy as np

from kurbel.numerics.elements import Elements, rule

if TYPE_CHECKING:
    from kurbel.arrays import Array

_TOLERANCE = 1e-10
"""An element is cut while its last two coefficients are more over the swing, with which the error is far less, …"""
_ROUNDS, _MOST_ELEMENTS = 10, 8000
"""… so many times at the most."""


class Forced(Protocol):
    """y′ = A y + f(φ), per radian, with m unknowns y of about one size; f is smooth between its breaks."""

    matrix: Array

    def prepared(self, degrees: Array, within: Array) -> Array:
        """Return f at angles (k, n) in degrees, on the sides that hold `within`, as (m, k, n)."""
        ...


def linear_periodic(equation: Forced, elements: Elements) -> tuple[Elements, Array]:
    """Return elements and Legendre coefficients (k, m, s + 1) of the periodic solution on them.

    What the equation leaves open is as small as can be. Raises LinAlgError where floats do not hold the figures.
    """
    answers, largest = _answers(equation, elements)
    for _ in range(_ROUNDS):
        coefficients = _joined(answers, len(equation.matrix))
        least = _TOLERANCE * np.ptp(coefficients.sum(axis=2), axis=0) + 1e-14 * largest
        rough = (np.abs(coefficients[..., -2:]).sum(axis=2) > least).any(axis=1)
        if not rough.any() or len(rough) > _MOST_ELEMENTS:
            break
        elements, old, _ = elements.cut(rough)
        answers = answers[old]
        answers[rough[old]] = _answers(equation, Elements(*(of[rough[old]] for of in elements)))[0]
    return elements, coefficients


def _answers(equation: Forced, elements: Elements) -> tuple[Array, float]:
    """Return the unknowns at all nodes (k, m s, m + 1), under f from 0, and from unit starts; and the largest |f|."""
    weights, size = rule().matrix, len(equation.matrix)
    unknowns = size * len(weights)
    forcing = np.moveaxis(elements.prepared(equation), 0, -1)
    width = np.radians(elements.width)[:, None, None]
    fed = width * (weights @ forcing)
    starts = np.broadcast_to(np.tile(np.eye(size), (len(weights), 1)), (len(width), unknowns, size))
    systems = np.eye(unknowns) - width * np.kron(weights, equation.matrix)
    sides = np.concatenate((fed.reshape(-1, unknowns, 1), starts), axis=2)
    return np.asarray(np.linalg.solve(systems, sides)), float(np.abs(forcing).max())


def _joined(answers: Array, size: int) -> Array:
    """Return the Legendre coefficients (k, m, s + 1) of the periodic solution from `_answers` (k, m s, m + 1)."""
    last = answers[:, -size:]
    starts = around(-last[..., 1:], np.broadcast_to(np.eye(3), last[..., 1:].shape), last[..., 0])
    values = answers[..., 0] + (answers[..., 1:] @ starts[..., None])[..., 0]
    whole = np.concatenate((starts, values), axis=1).reshape(len(starts), -1, size)
    return np.asarray(np.einsum("ns,ksm->kmn", rule().to_legendre, whole))


def around(before: Array, after: Array, sides: Array) -> Array:
    """Return x (k, m) with before_i x_i + after_i x_{i+1} = sides_i, x_k being x_0; matrices (k, m, m), sides (k, m).

    Every second x is eliminated by rotations, which do not mind whether a solution grows or dies on its way, until one
    is left. What the equations leave open there is taken as small as can be. Raises LinAlgError where floats do not
    reach.
    """
    count, size = sides.shape
    if count == 1:
        if not (np.isfinite(before).all() and np.isfinite(after).all() and np.isfinite(sides).all()):
            raise np.linalg.LinAlgError("beyond the range of floats")  # LAPACK itself would only print it
        return np.asarray(np.linalg.lstsq(before[0] + after[0], sides[0], rcond=1e-13)[0][None])
    even, odd = slice(0, count - 1, 2), slice(1, count, 2)
    turn, upper = np.linalg.qr(np.concatenate((after[even], before[odd]), axis=1), mode="complete")
    empty = np.zeros_like(before[odd])
    blocks = ((before[even], empty, sides[even][..., None]), (empty, after[odd], sides[odd][..., None]))
    rows = np.swapaxes(turn, 1, 2) @ np.concatenate([np.concatenate(row, axis=2) for row in blocks], axis=1)
    parts = rows[:, size:, :size], rows[:, size:, size:-1], rows[:, size:, -1]
    left = [np.concatenate((part, whole[2 * len(part) :])) for part, whole in zip(parts, (before, after, sides))]
    found = np.empty_like(sides)
    found[::2] = around(*left)
    ends = np.concatenate((found[even], np.roll(found[::2], -1, axis=0)[: len(turn)]), axis=1)
    rest = rows[:, :size, -1:] - rows[:, :size, :-1] @ ends[..., None]
    found[odd] = np.linalg.solve(upper[:, :size], rest)[..., 0]
    return found
