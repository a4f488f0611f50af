"""Measured pressure over the crank angle."""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import ClassVar

import numpy as np

from kurbel.arrays import Array
from kurbel.declared.forms import Physical
from kurbel.declared.keys import Described, Key, Keys
from kurbel.errors import refused
from kurbel.machine.cylinder import CYCLES

PERIODS = (360.0, 720.0)
_EVEN = 1e-3  # of a step: what rounded angles may miss
_ROUNDING = 1e-9  # of a period


@dataclass(frozen=True, eq=False, repr=False)
class Pegging(Described):
    """Where the level of a trace is known: angle in degrees from the (firing) dead centre, pressure in Pa.

    Piezoelectric sensors measure changes of pressure only. None for both: the ambient, at the dead centre where the
    compression begins.
    """

    angle: float | None = None
    pressure: float | None = None

    KEYS: ClassVar[Keys] = {
        "angle": Key(Physical("angle"), "Crank angle from the (firing) dead centre", required=True),
        "pressure": Key(Physical("pressure"), "Pressure there, as `pressures` says", required=True),
    }


@dataclass(frozen=True, eq=False)
class Trace:
    """A measured trace over one whole cycle, or over many.

    angles (n,) in degrees as the trace counts them, rising over 360 or 720; samples (m, n) in Pa, of m laps one after
    the other, each over these angles; two samples at one angle are a jump. Laps of 360 deg are cycles of two strokes,
    or by twos of four. angle_zero: the angle, as the trace counts, of the firing or inner dead centre, in degrees. Both
    ends of a cylinder count from the same dead centre, as one encoder on the shaft does; a mirrored trace follows one
    stroke later. files: where the samples came from, if not from the machine file; notes: what was tidied up in them;
    completed: the last sample is the first one again; clearance: smallest volume over that of the stroke, None where
    it is not known; level: a line over the cycle is taken off so that it closes; against: the file counts its angles
    against the rotation, those here are their negatives; scale: what the figures of the file were multiplied by,
    and offset: the Pa that were added then.
    Raises RuleError for samples that are
    no such cycle.
    """

    angles: Array
    samples: Array
    angle_zero: float = 0.0
    files: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
    completed: bool = False
    clearance: float | None = None
    level: bool = False
    pegging: Pegging | None = None
    against: bool = False
    scale: float = 1.0
    offset: float = 0.0

    def __post_init__(self) -> None:
        if self.angles.ndim != 1 or len(self.angles) < 2 or self.samples.shape[1:] != self.angles.shape:
            refused("a trace needs as many pressures as angles, two or more")
        finite = np.isfinite(self.angles).all() and np.isfinite(self.samples).all()
        if not finite or (np.diff(self.angles) < 0).any() or not self.period:
            refused("a trace has finite samples at angles that rise over one whole cycle, 360 or 720 deg")

    @cached_property
    def pressures(self) -> Array:
        """Mean (n,) in Pa of all laps."""
        return np.asarray(self.samples.mean(axis=0))

    @property
    def written_zero(self) -> float:
        """angle_zero as the file counts."""
        return 0.0 - self.angle_zero if self.against else self.angle_zero

    def turned_round(self) -> "Trace":
        """Return it as if its angles counted the other way."""
        angles, samples = -self.angles[::-1], self.samples[::-1, ::-1]
        return replace(self, angles=angles, samples=samples, angle_zero=-self.angle_zero, against=not self.against)

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
        """The working cycles that its laps are, or make by twos."""
        return tuple(cycle for cycle, turns in CYCLES.items() if self._laps_to(360.0 * turns))

    def _laps_to(self, period: float) -> int:
        """Return how many laps make a cycle of these degrees; 0 where none do."""
        laps = round(period / self.period)
        return laps if laps == 1 or (laps == 2 and len(self.samples) > 1) else 0

    def fault_in(self, cycle: str, lift: float) -> str:
        """Return what does not fit the cycle of the machine, or an empty text."""
        whole = 360.0 * CYCLES[cycle]
        if self._laps_to(whole):
            return ""
        other = next(name for name in CYCLES if name != cycle)
        covers = f"the trace covers {self.period:g} deg, a {cycle} cycle has {whole:g} deg"
        return f"{covers}; write 'cycle: {other}' at the top"

    def over(self, period: float) -> "Trace":
        """Return it with laps that are cycles of these degrees; a last turn that has no other is left out."""
        if self.period == period:
            return self
        even = self.samples[: len(self.samples) // 2 * 2]
        joined = np.concatenate((even[0::2, :-1], even[1::2, :-1], even[0::2, :1]), axis=1)
        angles = np.concatenate((self.angles[:-1], self.angles + self.period))
        return replace(self, angles=angles, samples=joined, completed=True)

    def of_cycle(self, number: int, period: float) -> "Trace":
        """Return one cycle of these degrees alone, counted from 1."""
        whole = self.over(period)
        return replace(whole, samples=whole.samples[number - 1 : number])
