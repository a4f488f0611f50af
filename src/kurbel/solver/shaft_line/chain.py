"""A chain of masses on pieces of shaft, J θ̈ + C θ̇ + K θ = M, and what torques of certain orders make of it.

(K (1 + iη) + iνω C − (νω)² J) θ = M has three diagonals. It is taken apart for all orders and speeds at once, the
larger of two rows first.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from kurbel.arrays import Array, ComplexArray
from kurbel.machine.shaft_line import ShaftLine

_AT_ONCE = 2048
"""Orders at speeds that are solved together: what the nearest memory holds."""
_EPSILON = float(np.finfo(float).eps)
_STILL = float(np.finfo(float).tiny)
_ARRAYS = ("inertias", "stiffnesses", "piece_damping", "mass_damping", "loss")


@dataclass(frozen=True, eq=False)
class Chain:
    """n masses with the pieces between them, one more where an end is fixed: `ground` is `before`, `after` or empty.

    inertias in kg m² (n,), stiffnesses in N m/rad; piece_damping, mass_damping in N m s/rad, of a twist and against
    uniform rotation; loss: loss factors of the pieces. All of it is referred to one shaft.
    """

    inertias: Array
    stiffnesses: Array
    piece_damping: Array
    mass_damping: Array
    loss: Array
    ground: str = ""

    @classmethod
    def of(cls, line: ShaftLine, inertias: Sequence[float]) -> "Chain":
        """Return the chain of a shaft line; inertias: those of its masses in kg m², with all that stands there."""
        each = np.array([(piece.stiffness, piece.damping, piece.loss_factor) for piece in line.pieces]).T
        damping = np.array([mass.damping for mass in line.masses])
        return cls(np.array(inertias), each[0], each[1], damping, each[2], line.ground)

    @cached_property
    def twists(self) -> Array:
        """The matrix (pieces, n) by which angles become twists."""
        return np.asarray(self.twisted(np.eye(len(self.inertias))))

    def twisted(self, angles: Any) -> Any:
        """Return the twists (pieces, …) that angles of the masses (n, …) make: that before a piece less that after."""
        held = np.pad(angles, (self.fixed, *((0, 0),) * (angles.ndim - 1))) if self.ground else angles
        return held[:-1] - held[1:]

    @property
    def fixed(self) -> tuple[int, int]:
        """1 for an end that is fixed, before the first mass and after the last one, else 0."""
        return int(self.ground == "before"), int(self.ground == "after")

    @property
    def between(self) -> slice:
        """Which of the pieces lie between two masses."""
        return slice(self.fixed[0], self.fixed[0] + len(self.inertias) - 1)

    @property
    def damped(self) -> bool:
        """Whether anything damps it."""
        return bool(self.piece_damping.any() or self.mass_damping.any() or self.loss.any())

    def reversed(self) -> "Chain":
        """Return the same chain read from its other end."""
        ground = {"before": "after", "after": "before"}.get(self.ground, "")
        turned = {name: getattr(self, name)[::-1] for name in _ARRAYS}
        return Chain(**turned, ground=ground)


class Response(NamedTuple):
    """The angles of the masses in rad, (n, …), and about what rounding moves them by.

    A θ = M is solved for a chain and torques whose last digits are unsure: A δθ = δM − δA θ, all of it taken in phase
    with the angles, as it is where they meet a natural vibration.
    """

    angles: ComplexArray
    moved: ComplexArray


def responding(chain: Chain, frequencies: Array, torques: ComplexArray, held: Array | float = 0.0) -> Response:
    """Return what the masses do under torques (n, …) in N m at angular frequencies νω (…) in rad/s.

    held: damping of the masses beside their own, (n, …) in N m s/rad. Without any damping a resonance has no answer: it
    is not finite.
    """
    shape, flat = torques.shape, frequencies.ravel()
    sides, held = (np.broadcast_to(one, shape).reshape(shape[0], -1) for one in (torques, held))
    parts = (slice(start, start + _AT_ONCE) for start in range(0, max(1, len(flat)), _AT_ONCE))
    each = [_responding(chain, flat[part], sides[:, part], held[:, part]) for part in parts]
    return Response(*(np.concatenate(of, axis=1).reshape(shape) for of in zip(*each)))


def _responding(chain: Chain, frequencies: Array, torques: ComplexArray, held: Array) -> Response:
    """Return it at frequencies (m,)."""
    spring, damping = _springs(chain, frequencies), chain.mass_damping[:, None] + held
    own = -np.multiply.outer(chain.inertias, frequencies**2) + 1j * damping * frequencies
    before, after = chain.fixed
    beside = np.pad(spring, ((1 - before, 1 - after), (0, 0)))
    springs = beside[:-1] + beside[1:]
    solved = _three_diagonals(own + springs, -spring[chain.between])
    angles = solved(torques)
    phases = angles / np.maximum(np.abs(angles), _STILL)
    return Response(
        angles, solved(_EPSILON * ((np.abs(own) + 2 * np.abs(springs)) * angles + np.abs(torques) * phases))
    )


def twisting(chain: Chain, frequencies: Array, angles: ComplexArray) -> ComplexArray:
    """Return the torques (pieces, …) in N m in springs and dampers of the pieces; angles (n, …): see `responding`."""
    return np.asarray(_springs(chain, frequencies) * chain.twisted(angles))


def _springs(chain: Chain, frequencies: Array) -> ComplexArray:
    """Return k (1 + iη) + iνω d of the pieces, (pieces, …)."""
    still = (chain.stiffnesses * (1 + 1j * chain.loss)).reshape(-1, *(1,) * frequencies.ndim)
    return np.asarray(still + 1j * np.multiply.outer(chain.piece_damping, frequencies))


def _three_diagonals(own: ComplexArray, beside: ComplexArray) -> Callable[[ComplexArray], ComplexArray]:
    """Return what solves beside_{i−1} x_{i−1} + own_i x_i + beside_i x_{i+1} = sides_i for x (n, m)."""
    count, width = own.shape
    # of each row that is done with: the factors of x_i, x_{i+1}, x_{i+2}
    done = np.zeros((count, 3, width), dtype=complex)
    row, lower = np.zeros((2, 3, width), dtype=complex)
    swaps, shares = np.zeros((count, width), dtype=bool), np.zeros((count, width), dtype=complex)
    row[0] = own[0]
    row[1] = beside[0] if count > 1 else 0.0
    for index in range(1, count):
        lower[0], lower[1] = beside[index - 1], own[index]
        lower[2] = beside[index] if index + 1 < count else 0.0
        swap = swaps[index] = np.abs(lower[0]) > np.abs(row[0])
        above = done[index - 1] = np.where(swap, lower, row)
        below = np.where(swap, row, lower)
        shares[index] = below[0] / above[0]
        row[:2] = below[1:] - shares[index] * above[1:]
    done[-1] = row

    def solved(sides: ComplexArray) -> ComplexArray:
        right = sides.astype(complex)
        for index in range(1, count):
            above = np.where(swaps[index], right[index], right[index - 1])
            right[index] = np.where(swaps[index], right[index - 1], right[index]) - shares[index] * above
            right[index - 1] = above
        found = np.zeros((count + 2, width), dtype=complex)
        for index in range(count - 1, -1, -1):
            first, second, third = done[index]
            found[index] = (right[index] - second * found[index + 1] - third * found[index + 2]) / first
        return np.asarray(found[:-2])

    return solved
