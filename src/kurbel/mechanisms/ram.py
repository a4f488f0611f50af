"""What carries the end of a slotted lever to its ram: a fork head that slides along it, or a connecting link.

All lengths are over the lever's length; θ is the lever's tilt, given by sine and cosine. `place` is the ram's position,
`lead` its derivative by θ, `bend` minus the derivative of that.
"""

import math
from typing import Any, NamedTuple

from kurbel.numerics.arithmetic import sqrt

Direction = tuple[float, float]
"""(sin θ, cos θ)."""


class ForkHead(NamedTuple):
    """The lever's end slides in the ram itself: x = sin θ."""

    ends: tuple[Direction, Direction] = ((-1.0, 0.0), (1.0, 0.0))
    """Where the ram turns over, if the lever gets there."""

    def place(self, sin: Any, cos: Any) -> Any:
        """Return sin θ."""
        return sin

    def lead(self, sin: Any, cos: Any) -> Any:
        """Return cos θ."""
        return cos

    def bend(self, sin: Any, cos: Any) -> Any:
        """Return sin θ."""
        return sin


class ConnectingLink(NamedTuple):
    """A link of general length, ahead of the lever's end, on a ram whose line runs `height` above the lever's pivot.

    sin γ = (h − cos θ)/l; x = sin θ + l cos γ, counted from where one link length lies ahead of the line of the pivots.
    """

    length: float
    height: float

    @property
    def ends(self) -> tuple[Direction, Direction]:
        """Where link and lever lie in line: folded behind, stretched ahead."""
        folded, stretched = -self.height / (self.length - 1), self.height / (self.length + 1)
        return (
            (-math.sqrt((1 - folded) * (1 + folded)), folded),
            (math.sqrt((1 - stretched) * (1 + stretched)), stretched),
        )

    def _angle(self, cos: Any) -> tuple[Any, Any]:
        rise = (self.height - cos) / self.length
        return rise, sqrt((1 - rise) * (1 + rise))

    def place(self, sin: Any, cos: Any) -> Any:
        """Return sin θ − l(1 − cos γ)."""
        rise, run = self._angle(cos)
        return sin - self.length * (rise * rise) / (1 + run)

    def lead(self, sin: Any, cos: Any) -> Any:
        """Return cos(θ + γ)/cos γ."""
        rise, run = self._angle(cos)
        return cos - sin * (rise / run)

    def bend(self, sin: Any, cos: Any) -> Any:
        """Return sin θ + cos θ tan γ + sin²θ/(l cos³γ)."""
        rise, run = self._angle(cos)
        return sin + cos * (rise / run) + (sin * sin) / (self.length * (run * run * run))
