"""Measured pressure over the crank angle."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from kurbel.errors import Fault, refuse
from kurbel.machine.angle_points import CYCLES

if TYPE_CHECKING:
    from kurbel.arrays import Array

PERIODS = (360.0, 720.0)
_EVEN = 1e-3  # of a step: what rounded angles may miss
_ROUNDING = 1e-9  # of a period


@dataclass(frozen=True, eq=False)
class Trace:
    """A measured trace over one whole cycle.

    angles (n,) in degrees as the trace counts them, rising over 360 or 720; pressures (n,) in Pa; two samples at one
    angle are a jump. angle_zero: the angle, as the trace counts, of the firing or inner dead centre, in degrees. Both
    ends of a cylinder count from the same dead centre, as one encoder on the shaft does; a mirrored trace follows one
    stroke later. file: where the samples came from, if not from the machine file; notes: what was tidied up in them.
    Raises RuleError for samples that are no such cycle.
    """

    angles: Array
    pressures: Array
    angle_zero: float = 0.0
    file: str | None = None
    notes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        if self.angles.ndim != 1 or len(self.angles) < 2 or self.angles.shape != self.pressures.shape:
            refuse(Fault((), "a trace needs as many pressures as angles, two or more"))
        if not np.isfinite([self.angles, self.pressures]).all() or (np.diff(self.angles) < 0).any() or not self.period:
            refuse(Fault((), "a trace has finite samples at angles that rise over one whole cycle, 360 or 720 deg"))

    @property
    def period(self) -> float:
        """360 or 720; 0 where the angles cover neither."""
        span = float(self.angles[-1] - self.angles[0])
        return next((period for period in PERIODS if abs(span - period) <= _ROUNDING * period), 0.0)

    @property
    def even(self) -> bool:
        """Whether the samples stand at equal angles."""
        steps = np.diff(self.angles)
        step = self.period / len(steps)
        return bool(np.abs(steps - step).max() <= _EVEN * step)

    @property
    def cycles(self) -> tuple[str, ...]:
        """The one cycle that is as long."""
        return tuple(cycle for cycle, turns in CYCLES.items() if 360.0 * turns == self.period)

    def fault_in(self, cycle: str, lift: float) -> str:
        """Return what does not fit the cycle of the machine, or an empty text."""
        whole = 360.0 * CYCLES[cycle]
        if self.period == whole:
            return ""
        other = next(name for name in CYCLES if name != cycle)
        covers = f"the trace covers {self.period:g} deg, a {cycle} cycle has {whole:g} deg"
        return f"{covers}; write 'cycle: {other}' at the top"
