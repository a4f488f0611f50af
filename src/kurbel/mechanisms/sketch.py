"""What is drawn of a mechanism at a crank angle: where its joints stand, and what joins them."""

from dataclasses import dataclass
from typing import Any

Point = tuple[Any, Any]
"""Place in m from the shaft, along φ = 0 and along φ = 90°; each a number, or as the angle."""

SHAFT, PIN = "shaft", "pin"


@dataclass(frozen=True, eq=False)
class Sketch:
    """A mechanism at crank angles, to scale.

    joints: places by name, the shaft and the crank pin among them; links: stiff members, each the joints it runs
    through; blocks: joints that slide along a link; fixed: joints on the frame; guides: lines on the frame on which
    the output slides. output: the joint at which P acts; toward: the direction in which P counts positive, and `across`
    that in which the output presses on its guide where N is positive; of what only swings, None.
    """

    joints: dict[str, Point]
    links: tuple[tuple[str, ...], ...]
    fixed: tuple[str, ...]
    blocks: tuple[tuple[str, tuple[str, str]], ...] = ()
    guides: tuple[tuple[Point, Point], ...] = ()
    output: str = ""
    toward: Point | None = None
    across: Point | None = None


def on_circle(radius: Any, cos: Any, sin: Any, centre: Point = (0.0, 0.0)) -> Point:
    """Return the point of a circle in a direction."""
    return centre[0] + radius * cos, centre[1] + radius * sin
