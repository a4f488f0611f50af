"""A point of the connecting rod or coupler, of which the motion is asked."""

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from kurbel.declared.record import Record, Rule, field
from kurbel.mechanisms import Mechanism


@dataclass(frozen=True, eq=False, repr=False)
class RodPoint(Record):
    """A point along the rod from one of its pins toward the other, or beyond it, and across from its line.

    origin: `crank_pin`, or the other pin as the mechanism calls it; across: positive to the side to which the crank
    pin stands at φ = 90°.
    """

    origin: str = field(
        ("crank_pin", "crosshead_pin", "rocker_pin"),
        "Pin from which the distance counts",
        required=True,
        example="crank_pin",
        key="from",
    )
    along: float = field("length", "Distance along the rod, toward its other pin", required=True)
    across: float = field(
        "length",
        "Distance from the rod's line, positive to the side of the outstroke",
        default=0.0,
        absent="0",
    )

    def from_crank_pin(self, mechanism: Mechanism) -> float:
        """Return the distance along the rod in m from the crank pin toward the other one."""
        return self.along if self.origin == "crank_pin" else mechanism.coupler_length - self.along

    def rules_on(self, mechanism: Mechanism) -> Iterator[Rule]:
        """Yield what keeps the point from being one of this mechanism."""
        endless = np.isinf(mechanism.coupler_length)
        yield Rule((), endless, f"this {mechanism.name} has no connecting rod of a length, of which it were a point")
        other = np.logical_not(endless) & (self.origin not in ("crank_pin", mechanism.far_pin))
        yield Rule("from", other, f"the pins of a {mechanism.name} are crank_pin and {mechanism.far_pin}")
