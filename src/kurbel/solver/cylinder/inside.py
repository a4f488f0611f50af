"""What stays the same over a smooth piece of the cycle: the sense of the motion, the guide, the lines of the cards."""

from collections.abc import Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from kurbel.arrays import Array, Indices
from kurbel.crank_angle import CrankAngle

if TYPE_CHECKING:
    from kurbel.solver.cylinder.drive import Drive
    from kurbel.solver.cylinder.state import State
    from kurbel.solver.pressure import Pressure


class GasLine(NamedTuple):
    """The force of the gas on pieces on which it is straight over the stroke, each (n,) or (n, 1).

    force: in N at a share z of the stroke; rise: of it over a whole stroke.
    """

    force: Array
    rise: Array
    z: Array

    def at(self, z: Any) -> Any:
        """Return the force in N at shares of the stroke, arrays or jets."""
        return (z - self.z) * self.rise + self.force


class Inside:
    """The pieces that hold some crank angles in degrees, (n,), or (pieces, 1) once for all nodes of each.

    States at other angles in the same pieces share it. rubs: whether friction in pins and journals counts.
    """

    def __init__(self, drive: "Drive", degrees: Array, rubs: bool = True) -> None:
        self.drive = drive
        self.degrees = degrees
        self.rubs = rubs
        self._held: dict[int, Any] = {}
        self._side: Array | None = None
        self.gas_line: GasLine | None = None  # where a state at the nodes of the pieces has found it

    @classmethod
    def at(cls, drive: "Drive", angle: CrankAngle) -> "Inside":
        """Return the pieces in which these angles themselves stand."""
        found = cls(drive, angle.degrees)
        found.angle = angle
        return found

    @classmethod
    def of_pieces(cls, drive: "Drive", parts: "Sequence[Inside]", place: Indices) -> "Inside":
        """Return what is known of the pieces at these places of several, counted from one to the next.

        place: (n,), or (n, 1) for all nodes of each; drive: of the variants that they are of.
        """

        def known(*each: Any) -> Any:
            return np.concatenate(each)[place, 0]

        found = cls(drive, known(*(one.degrees for one in parts)), parts[0].rubs)
        found.direction = known(*(one.direction for one in parts))
        sides, lines = zip(*((one._side, one.gas_line) for one in parts))
        found._side = None if any(one is None for one in sides) else known(*sides)
        found.gas_line = GasLine(*map(known, *lines)) if all(lines) else None
        return found

    @property
    def unrubbed(self) -> "Inside":
        """The same without friction in pins and journals."""
        found = Inside(self.drive, self.degrees, rubs=False)
        found.angle = self.angle
        return found

    @cached_property
    def angle(self) -> CrankAngle:
        """The crank angles."""
        return CrankAngle.of(self.degrees)

    @cached_property
    def direction(self) -> Array:
        """+1 on the outstroke, −1 on the return stroke; +1 for what turns on and on."""
        if self.drive.mechanism.turns:
            return np.ones_like(self.degrees)
        inner, outer = self.drive.mechanism.dead_centres()
        return np.where(np.mod(self.degrees - inner, 360.0) < outer - inner, 1.0, -1.0)

    def held(self, end: "Pressure") -> Any:
        """Return what the pressure at an end of a piston holds there, as it is asked by it."""
        if id(end) not in self._held:
            self._held[id(end)] = end.held(self.degrees)
        return self._held[id(end)]

    def guide_side(self, state: "State") -> Array:
        """Return +1 where N ≥ 0, else −1; state: one that is asked for, which may be that at these very angles."""
        if self._side is None:
            inside = state if state.angle is self.angle else type(state)(self.drive, self.angle, self)
            self._side = 2.0 * (inside.guide_sense >= 0) - 1.0
        return self._side
