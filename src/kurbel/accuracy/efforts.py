"""Torques that a machine file gives over the angle of the crank, in mpmath's numbers: by points or by harmonics."""

from collections.abc import Callable, Iterator
from itertools import pairwise
from typing import Union

from kurbel.accuracy.methods import Precise, mp, mpf
from kurbel.machine.shaft_side import Effort, Harmonics

Diagram = Union[Effort, Harmonics]


def knees_of(diagram: Diagram, cycle: int) -> Iterator[Precise]:
    """Yield the angles in degrees of a cycle at which a diagram bends or jumps."""
    if isinstance(diagram, Harmonics):
        return
    period = mpf(diagram.angles[-1])
    for lap in range(round(cycle / float(period))):
        for angle in diagram.angles[1:]:
            yield (mpf(angle) + lap * period) % cycle


def diagram_of(diagram: Diagram) -> Callable[[Precise, Precise], Precise]:
    """Return the torque in N m at an angle in degrees; within: any angle of the same piece."""
    if isinstance(diagram, Harmonics):
        mean = mpf(diagram.mean)
        terms = [(mpf(order), mpf(cos), mpf(sin)) for order, cos, sin in diagram.terms]

        def of_harmonics(phi: Precise, within: Precise) -> Precise:
            torque = mean
            for order, cos, sin in terms:
                turned = order * phi / 180
                torque += cos * mp.cospi(turned) + sin * mp.sinpi(turned)
            return torque

        return of_harmonics

    points = [(mpf(angle), mpf(torque)) for angle, torque in zip(diagram.angles, diagram.torques)]
    period = points[-1][0]

    def between_points(phi: Precise, within: Precise) -> Precise:
        inside = within % period
        shift = within - inside
        for (angle, torque), (next_angle, next_torque) in pairwise(points):
            if angle <= inside < next_angle:
                rise = (next_torque - torque) / (next_angle - angle)
                return torque + rise * (phi - shift - angle)
        raise ValueError(f"no line of the diagram at {within} deg")

    return between_points
