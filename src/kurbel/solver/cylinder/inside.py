"""What stays the same over a smooth piece of the cycle: the sense of the motion, the guide, the lines of the cards."""

from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from kurbel.arrays import Array
from kurbel.crank_angle import CrankAngle

if TYPE_CHECKING:
    from kurbel.solver.cylinder.drive import Drive
    from kurbel.solver.cylinder.state import State
    from kurbel.solver.pressure import Pressure


class Inside:
    """The pieces that hold some crank angles (n,), or (pieces, 1) once for all nodes of each.

    States at other angles in the same pieces share it. rubs: whether friction in pins and journals counts.
    """

    def __init__(self, drive: "Drive", angle: CrankAngle, rubs: bool = True) -> None:
        self.drive = drive
        self.angle = angle
        self.rubs = rubs
        self._held: dict[int, Any] = {}
        self._side: Array | None = None

    @property
    def unrubbed(self) -> "Inside":
        """The same without friction in pins and journals."""
        return Inside(self.drive, self.angle, rubs=False)

    @cached_property
    def direction(self) -> Array:
        """+1 on the outstroke, −1 on the return stroke; +1 for what turns on and on."""
        if self.drive.mechanism.turns:
            return np.ones_like(self.angle.degrees)
        inner, outer = self.drive.mechanism.dead_centres()
        return np.where(np.mod(self.angle.degrees - inner, 360.0) < outer - inner, 1.0, -1.0)

    def held(self, end: "Pressure") -> Any:
        """Return what the pressure at an end of a piston holds there, as it is asked by it."""
        if id(end) not in self._held:
            self._held[id(end)] = end.held(self.angle.degrees)
        return self._held[id(end)]

    def guide_side(self, state: "State") -> Array:
        """Return +1 where N ≥ 0, else −1; state: one that is asked for, which may be that at these very angles."""
        if self._side is None:
            inside = state if state.angle is self.angle else type(state)(self.drive, self.angle, self)
            self._side = 2.0 * (inside.guide_sense >= 0) - 1.0
        return self._side
