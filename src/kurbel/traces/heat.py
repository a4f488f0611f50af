"""Heat release of a trace: what burns, from pressure and volume by the first law, without derivatives of the pressure.

    dQ = (κ p dV + V dp)/(κ − 1),  whose integral is  Q = ∫ p dV + (p V − p₀ V₀)/(κ − 1)

with absolute pressures: the net heat, less what the walls take.
"""

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from kurbel.arrays import Array, Indices
from kurbel.declared.record import Record, Rule, field


class HeatLaw(Record):
    """How the heat release of a trace is computed."""

    exponent: float = field(
        "ratio", "Ratio of the specific heats of the charge", "κ", default=1.33, above=1
    )
    begin: float = field(
        "angle", "Angle from the firing dead centre from which heat is counted", default=-40.0
    )
    end: float = field(
        "angle", "Angle from the firing dead centre up to which heat is counted", default=100.0
    )

    def rules(self) -> Iterator[Rule]:
        yield Rule("end", self.end <= self.begin, "{end} is not after {begin}")

    def released(
        self, after: Array, absolute: Array, volumes: Array, growth: Array
    ) -> "Released | None":
        """Return the heat of samples (n,); None for too few, or where none is released.

        after: degrees from the firing dead centre, rising; absolute: Pa; volumes: m³; growth: dV/dφ in m³ per degree.
        """
        inside = (after >= self.begin) & (after <= self.end)
        angles, rows = np.unique(after[inside], return_index=True)
        if len(angles) < _FEWEST:
            return None
        p = absolute[inside][rows]
        V = volumes[inside][rows]

        # ∫ p dV by the trapezoid rule with the slopes at both ends of each step
        power = p * growth[inside][rows]
        steps = np.diff(angles)
        slopes = np.gradient(power, angles)
        parts = steps / 2 * (power[1:] + power[:-1]) - steps**2 / 12 * np.diff(slopes)
        work = np.concatenate(([0.0], np.cumsum(parts)))
        heat = work + (p * V - p[0] * V[0]) / (self.exponent - 1)

        # from the least heat before its largest
        top = int(np.argmax(heat))
        bottom = int(np.argmin(heat[: top + 1]))
        total = float(heat[top] - heat[bottom])
        if total <= 0 or top == bottom:
            return None
        return Released(angles, heat, bottom, top, total)


_FEWEST = 8
"""Samples at least, between both angles."""
CHORD = 1.0
"""Degrees over which the fastest release is measured: between two samples noise would dominate."""


class Released(NamedTuple):
    """The heat of a cycle: angles (n,) in degrees from the firing dead centre, heat (n,) in J from the first one on.

    first, last: the samples with the least heat, and with the largest after it; total: the heat between them.
    """

    angles: Array
    heat: Array
    first: int
    last: int
    total: float

    @property
    def supplied(self) -> None:
        """The heat of the fuel: a trace does not show it."""
        return None

    @property
    def span(self) -> tuple[float, float]:
        """The degrees from the firing dead centre between which heat is counted."""
        return float(self.angles[0]), float(self.angles[-1])

    @property
    def burnt(self) -> Array:
        """The burnt share x_b (n,) at its angles: 0 before combustion, 1 after it."""
        burnt = (self.heat - self.heat[self.first]) / self.total
        burnt[: self.first] = 0.0
        burnt[self.last :] = 1.0
        return burnt

    def end_of_cycle(self, cycle: float) -> float:
        """Return the degrees after the firing dead centre at which x_b falls to 0, in a cycle of so many."""
        return cycle / 2

    def burnt_at(self, after: Array, machine: Indices | None = None) -> Array:
        """Return the burnt share x_b at so many degrees after the firing dead centre; a trace is of one machine."""
        return np.interp(after, self.angles, self.burnt)

    def rate_at(self, after: Array, machine: Indices | None = None) -> Array:
        """Return the heat in J released over the degree around these angles, after the firing dead centre."""
        ahead = np.interp(after + CHORD / 2, self.angles, self.heat)
        behind = np.interp(after - CHORD / 2, self.angles, self.heat)
        return (ahead - behind) / CHORD

    def angle_at(self, share: float) -> float:
        """Return the first angle in degrees after which so much of the heat is released."""
        burnt = self.burnt
        after = int(np.argmax(burnt >= share))
        before = max(after - 1, 0)
        low = float(burnt[before])
        high = float(burnt[after])
        if high == low:
            return float(self.angles[after])
        passed = (share - low) / (high - low)
        return float(self.angles[before] + passed * (self.angles[after] - self.angles[before]))

    @property
    def fastest(self) -> tuple[float, float]:
        """The largest heat in J that is released over one degree, and the angle in the middle of that."""
        middles = self.angles[self.first : self.last + 1]
        rates = self.rate_at(middles)
        top = int(np.argmax(rates))
        return float(rates[top]), float(middles[top])
