"""The force and the work of gas, steam or water on one piston."""

import math
from collections.abc import Callable
from copy import copy
from functools import cached_property
from typing import Any

from kurbel.arrays import Indices
from kurbel.machine.piston import Piston
from kurbel.machine.variants import taken
from kurbel.mechanisms import Mechanism
from kurbel.numerics.arithmetic import total
from kurbel.numerics.cycles import later
from kurbel.solver.pressure import Pressure, Setting, pressure_in


class PistonGas:
    """The pressures on both sides of one piston that has an indicator.

    head, crank: the pressures of the two ends, None for an end that is open to the ambient. cycle: degrees of its own
    cycle, which is run through `repeats` times in that of the cylinder. absolute: whether the figures of the
    file are; base: what they less this are gauge pressures, in Pa.
    """

    def __init__(self, piston: Piston, mechanism: Mechanism, cycle: float, ambient: float, repeats: int = 1) -> None:
        indicator = piston.indicator
        assert indicator is not None
        head, crank = indicator.head_end, indicator.crank_end
        at_head = Setting(mechanism, cycle, True, ambient, indicator.absolute)
        at_crank = at_head._replace(head_end=False, mirrored=crank is head)
        self.piston = piston
        self.absolute, self.base = indicator.absolute, at_head.base
        self.repeats = repeats
        self._cycle = cycle
        self.head = None if head is None else pressure_in(head, at_head)
        self.crank = None if crank is None else pressure_in(crank, at_crank)
        self.stroke = mechanism.stroke

    def taken(self, index: Indices) -> "PistonGas":
        """Return the gas of these variants, at angles of the shape of the index."""
        other = copy(self)
        other.piston, other.stroke = taken(self.piston, index), taken(self.stroke, index)
        other.base = taken(self.base, index)
        other.head, other.crank = (end and end.taken(index) for end in (self.head, self.crank))
        return other

    @property
    def starts(self) -> list[Any]:
        """The crank angles (n,) in degrees of the cylinder's cycle at which each pressure bends or jumps, or `Flat`."""
        ends = [end.starts for end in (self.head, self.crank) if end]
        return [later(starts, turn * self._cycle) for turn in range(self.repeats) for starts in ends]

    @property
    def bends(self) -> tuple[Any, ...]:
        """Crank angles in degrees of a turn at which quadratures should split."""
        return tuple(angle for end in (self.head, self.crank) if end for angle in end.bends)

    @property
    def straight(self) -> bool:
        """Whether the force is a straight line over the stroke between any two neighbouring starts."""
        return all(end.straight for end in (self.head, self.crank) if end)

    def force(self, pressure: Callable[[Pressure], Any], alike: bool = False) -> Any:
        """Return P = p_H A_H − p_C A_C in N, R 296; alike: with the mean of both areas, R 297.

        pressure: gives the gauge pressure in Pa at either end.
        """
        mean = (self.piston.head_area + self.piston.crank_area) / 2
        at_head, at_crank = (mean, mean) if alike else (self.piston.head_area, self.piston.crank_area)
        force: Any = at_head * pressure(self.head) if self.head else 0.0
        return force - at_crank * pressure(self.crank) if self.crank else force

    @cached_property
    def works(self) -> tuple[Any, Any]:
        """Indicated work in J per cycle of the cylinder of head end and crank end: A s ∮ p dz."""
        way = self.stroke * self.repeats
        return (
            self.piston.head_area * way * self.head.area if self.head else 0.0,
            self.piston.crank_area * way * self.crank.area if self.crank else 0.0,
        )

    @property
    def work(self) -> float:
        """Indicated work in J per cycle."""
        work: float = total(*self.works)
        return work

    @cached_property
    def traced(self) -> tuple[float, float] | None:
        """Indicated work in J of the ends that have a trace, and its change per radian of angle; None without."""
        ends = ((self.head, self.piston.head_area), (self.crank, self.piston.crank_area))
        found = [
            (area * end.area, area * end.area_by_angle) for end, area in ends if end and hasattr(end, "area_by_angle")
        ]
        way = self.stroke * self.repeats
        return (way * sum(w for w, _ in found), way * sum(d for _, d in found)) if found else None

    @property
    def noise(self) -> float:
        """Standard deviation in N of the noise that traces bring into the force."""
        ends = ((self.head, self.piston.head_area), (self.crank, self.piston.crank_area))
        noises = [getattr(end, "noise", None) for end, _ in ends]
        return math.hypot(*(noise * area for noise, (_, area) in zip(noises, ends) if noise))

    @cached_property
    def clearance_volumes(self) -> tuple[Any, Any]:
        """Smallest volumes in m³ of head end and crank end; 0 where one is not known."""
        indicator = self.piston.indicator
        chambers = (indicator.head_end, indicator.crank_end) if indicator else (None, None)
        head, crank = (getattr(chamber, "clearance", None) for chamber in chambers)
        return (
            0.0 if head is None else head * self.piston.head_area * self.stroke,
            0.0 if crank is None else crank * self.piston.crank_area * self.stroke,
        )

    @property
    def swept_volume(self) -> float:
        """Volume in m³ swept in the chambers that have pressures."""
        head = self.piston.head_area if self.head else 0.0
        return (head + (self.piston.crank_area if self.crank else 0.0)) * self.stroke
