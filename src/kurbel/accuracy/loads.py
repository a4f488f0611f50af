"""Loads on what slides or swings, in mpmath's numbers: straight between their points, springs, constant parts."""

from itertools import pairwise

from kurbel.accuracy.methods import Precise, mpf
from kurbel.machine import Cylinder


class TextbookLoads:
    """Loads on the output of a cylinder, forces in N or moments in N m, positive where it moves out.

    stroke: of the output in m, or radians; turns: per cycle; never_returns: whether the output turns on.
    """

    def __init__(
        self, cylinder: Cylinder, stroke: Precise, turns: int, works_out: bool, never_returns: bool
    ) -> None:
        self._stroke = stroke
        self._turns = turns
        self._works_out = works_out
        self._never_returns = never_returns
        # against the motion, on the working stroke and back
        self._resistance = [mpf(0), mpf(0)]
        resistance = cylinder.ram_force or cylinder.moment
        if resistance is not None:
            self._resistance = [mpf(resistance.work), mpf(resistance.back)]
        # along one direction
        force = cylinder.force
        self._constant = mpf(0) if force is None else mpf(force.constant) + mpf(force.preload)
        self._spring = mpf(0) if force is None else mpf(force.spring or 0.0)
        self._lever = mpf(1) if force is None else mpf(force.lever or 1.0)
        self._points: list[list[tuple[Precise, Precise]]] = [[], []]
        if force is not None and force.profile is not None:
            for number, line in enumerate(force.profile.lines):
                points = [(mpf(z), mpf(load)) for z, load in zip(line.fractions, line.pressures)]
                self._points[number] = points if number == 0 else points[::-1]

    def fractions(self, is_back: bool) -> set[Precise]:
        """Return the fractions of the stroke at which the force of a stroke bends or jumps."""
        return {z for z, _ in self._points[is_back]}

    def at(self, z: Precise, within: Precise, sense: int) -> Precise:
        """Return the load at a fraction of the stroke, on the side of a corner on which `within` is."""
        is_working = (sense > 0) == self._works_out
        against = self._resistance[0 if is_working else 1]
        force = self._constant - self._spring * self._lever * self._stroke * z
        for (begin, low), (end, high) in pairwise(self._points[sense < 0]):
            if begin < within < end:
                force += low + (high - low) * (z - begin) / (end - begin)
        return self._lever * force - sense * against

    @property
    def work(self) -> Precise:
        """The work in J per cycle on the output: what springs and constant parts do, they take back."""
        against = self._resistance[0]
        if not self._never_returns:
            against += self._resistance[1]
        areas = []
        for points in self._points:
            trapezoids = (
                (low + high) / 2 * (end - begin) for (begin, low), (end, high) in pairwise(points)
            )
            areas.append(sum(trapezoids, mpf(0)))
        out, back = areas
        return self._turns * self._stroke * (self._lever * (out - back) - against)
