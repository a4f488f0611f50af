"""Points over the crank angle, `[[deg, value], …]`: what every diagram over the angle must keep to."""

from kurbel.declared.kinds import Point
from kurbel.errors import Fault, Path

CYCLES = {"two-stroke": 1, "four-stroke": 2}
"""Cycle -> revolutions of the shaft."""


def angle_faults(points: list[Point], path: Path) -> list[Fault]:
    """Return what is wrong with the angles of a diagram over one cycle.

    They run from 0 to 360 or 720 deg and do not turn back; two points at one angle are a jump, three are one too many.
    """
    for i, (angle, _) in enumerate(points):
        if not 0 <= angle <= 720:
            return [Fault((*path, i), f"{angle:g} deg is outside the cycle; angles run from 0 to 360 or 720 deg")]
        if i and angle < points[i - 1][0]:
            return [
                Fault((*path, i), f"{angle:g} deg after {points[i - 1][0]:g} deg; put the points in order of the angle")
            ]
        if i >= 2 and angle == points[i - 2][0]:
            return [Fault((*path, i), f"three points at {angle:g} deg; a jump has two")]
    if not points or points[0][0] != 0 or points[-1][0] not in (360, 720):
        runs = f"this one runs from {points[0][0]:g} to {points[-1][0]:g} deg" if points else "this one has no points"
        whole = "a diagram runs from 0 to 360 deg, or to 720 deg in a four-stroke cycle"
        return [Fault(path, f"{whole}, {runs}; give the values at both ends of the cycle, with angles in degrees")]
    return []


def beyond_cycle(last: float, cycle: str) -> str:
    """Return what to write when a diagram ends at an angle (in degrees) that the cycle does not have; else ''."""
    whole = 360.0 * CYCLES[cycle]
    if last <= whole:  # one of a single turn repeats in the second one of a four-stroke cycle
        return ""
    return f"the diagram runs to {last:g} deg, a {cycle} cycle has {whole:g} deg; write 'cycle: four-stroke' at the top"
