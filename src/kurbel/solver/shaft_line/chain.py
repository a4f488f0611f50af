"""A chain of masses on pieces of shaft, as numbers: J θ̈ + C θ̇ + K θ = M."""

from collections.abc import Sequence
from functools import cached_property

import numpy as np

from kurbel.arrays import Array, ComplexArray
from kurbel.frozen import frozen
from kurbel.machine.shaft_line import ShaftLine

_ARRAYS = ("inertias", "stiffnesses", "piece_damping", "mass_damping", "loss")


@frozen
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
        """The matrix (pieces, n) by which angles become twists: that before a piece less that after it."""
        count = len(self.inertias)
        first = -1 if self.ground == "before" else 0
        matrix = np.zeros((len(self.stiffnesses), count))
        for piece in range(len(self.stiffnesses)):
            for mass, sign in ((piece + first, 1.0), (piece + first + 1, -1.0)):
                if 0 <= mass < count:
                    matrix[piece, mass] = sign
        return matrix

    def twisted(self, angles: ComplexArray) -> ComplexArray:
        """Return the twists (pieces, …) that angles of the masses (n, …) make; see `twists`."""
        still = np.zeros_like(angles[:1])
        first, last = [still] * (self.ground == "before"), [still] * (self.ground == "after")
        held = np.concatenate((*first, angles, *last)) if self.ground else angles
        return np.asarray(held[:-1] - held[1:])

    @property
    def damped(self) -> bool:
        """Whether anything damps it."""
        return bool(self.piece_damping.any() or self.mass_damping.any() or self.loss.any())

    def reversed(self) -> "Chain":
        """Return the same chain read from its other end."""
        ground = {"before": "after", "after": "before"}.get(self.ground, "")
        turned = {name: getattr(self, name)[::-1] for name in _ARRAYS}
        return Chain(**turned, ground=ground)
