"""The speed line of a machine with any flywheel: rigid or elastic, under a load that minds the speed or does not."""

import math
from collections.abc import Callable
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from kurbel.errors import NoSolutionError, UsageError
from kurbel.numerics.collocation_old import Standstill, Unsettled
from kurbel.solver.turning.machine_effort import MachineEffort
from kurbel.solver.turning.speed import (
    ConstantLoad,
    Course,
    Inertia,
    SpeedDependentLoad,
    SpeedLaw,
    SpeedLine,
    power_law,
    slip_law,
)

if TYPE_CHECKING:
    from kurbel.solver.turning.coupling import ElasticCoupling

RIGID_ABOVE = 100.0
"""Natural order from which on a coupling counts as rigid: it transmits what a rigid one would but for 1 in 10⁴."""
_DOUBLINGS = 30
"""How many doublings of the flywheel are tried for one that turns."""


def speed_law(turned: MachineEffort) -> SpeedLaw | None:
    """Return how the load depends on the speed; None where it does not, or is nothing on the mean."""
    load, excess = turned.machine.load, turned.excess
    if load is None or not excess.mean:
        return None
    if load.slip is not None:
        return slip_law(excess.mean, load.slip)
    return power_law(excess.mean, load.power) if load.power else None


class SpeedLines:
    """The speed lines of a machine with a speed, each for a flywheel in kg m²."""

    def __init__(self, turned: MachineEffort, omega: float) -> None:
        self._turned = turned
        self.omega = omega
        self._coupling = turned.machine.coupling
        self.law = speed_law(turned)

    def natural_order(self, flywheel: float) -> float | None:
        """Return the natural frequency of cranks and driven inertia on the coupling over ω; None where not defined."""
        own = self._turned.inertia.mean + flywheel
        if self._coupling is None or not own:
            return None
        from kurbel.solver.shaft_line.modes import Modes
        from kurbel.solver.turning.coupling import coupled

        return float(Modes(coupled(self._coupling, own)).omegas[1]) / self.omega

    def elastic(self, flywheel: float) -> "ElasticCoupling | None":
        """Return the line on an elastic coupling; None where there is none, or one as good as rigid."""
        if self._coupling is None or (self.natural_order(flywheel) or 0.0) > RIGID_ABOVE:
            return None
        from kurbel.solver.turning.coupling import ElasticCoupling, Shaft

        own = flywheel + self._turned.inertia.mean
        if not own:
            raise UsageError("nothing before the coupling has any inertia: give 'flywheel' an inertia")
        return ElasticCoupling(self._coupling, Shaft(own, self.omega, self.law), self._turned.true_excess)

    def rigid(self, flywheel: float) -> SpeedLine:
        """Return the line without a coupling, or with a rigid one."""
        turned = flywheel + (self._coupling.inertia if self._coupling else 0.0)
        self._refuse_no_inertia(turned)
        inertia, course = Inertia(turned, self.omega), self._course
        return ConstantLoad(course, inertia) if self.law is None else SpeedDependentLoad(course, self.law, inertia)

    @cached_property
    def _course(self) -> Course:
        return Course(self._turned.true_excess, self._turned.inertia)

    def _refuse_no_inertia(self, flywheel: float) -> None:
        moving = self._turned.inertia
        if moving.values.min() + flywheel <= 1e-12 * (moving.values.max() + flywheel):
            angle = float(moving.grid.degrees.ravel()[np.argmin(moving.values)])
            raise UsageError(f"nothing that turns has any inertia at φ = {angle:.4g}°: give 'flywheel' an inertia")

    def line(self, flywheel: float) -> "SpeedLine | ElasticCoupling":
        """Return the speed line; raises Standstill, Unsettled, NoSolutionError, UsageError."""
        return turning(self.elastic(flywheel) or self.rigid(flywheel))

    def delta(self, flywheel: float) -> float:
        """Return δ of the speed line; inf where it stalls."""
        try:
            return self.line(flywheel).delta
        except (Unsettled, NoSolutionError, UsageError):
            return math.inf

    def enough(self, flywheel: float, more: float | None) -> float | None:
        """Return the smallest flywheel, within a fiftieth, with which a machine turns that stalls; None without any.

        more: kinetic energy in J that is known to be just enough.
        """
        least = max(flywheel, 1e-6 * self._turned.inertia.mean, 1e-300)
        start = flywheel + 2 * more / self.omega**2 if more else least + self._turned.excess.dE / self.omega**2
        return _smallest(lambda inertia: math.isfinite(self.delta(inertia)), least, start, exact=bool(more))


def turning(line: "SpeedLine | ElasticCoupling") -> "SpeedLine | ElasticCoupling":
    """Return the line if it never stands still; raises Standstill."""
    if not line.omega_min.value > 0:
        raise Standstill(line.omega_min.degrees)
    return line


def _smallest(turns: Callable[[float], bool], least: float, start: float, exact: bool) -> float | None:
    """Return the least number of three digits that turns; `least` does not; exact: `start` is all but it."""
    enough = start
    for _ in range(_DOUBLINGS):
        if turns(_rounded_up(enough)):
            break
        least, enough = enough, 2 * enough
    else:
        return None
    while not exact and enough > 1.02 * max(least, enough / 1000):
        middle = math.sqrt(max(least, enough / 4) * enough)
        least, enough = (least, middle) if turns(_rounded_up(middle)) else (middle, enough)
    return _rounded_up(enough)


def _rounded_up(value: float) -> float:
    """Return the next larger number of three digits."""
    digit = 10.0 ** (math.floor(math.log10(value)) - 2)
    return math.ceil(value / digit) * digit
