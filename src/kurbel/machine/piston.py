"""A piston with the pressures on its two sides."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from kurbel.declared.record import Record, Rule, field, first_of
from kurbel.machine.indicator import Chamber, Indicator


@dataclass(frozen=True, eq=False, repr=False)
class Piston(Record):
    """A piston: bore and rods, and what the indicator shows on its two sides."""

    bore: float = field("length", "Diameter of the cylinder", "d", above=0, required=True)
    head_end_rod: float = field("length", "Diameter of the rod through the head end", default=0.0, least=0, absent="0")
    crank_end_rod: float = field(
        "length",
        "Diameter of the rod through the crank end",
        default=0.0,
        least=0,
        absent="0",
        also=("piston_rod", "rod_diameter"),
    )
    indicator: Indicator | None = field(
        Indicator, "Pressures on the two sides", absent="no gas force", also=("pressure", "card", "trace")
    )
    name: str = field(str, "Name of the piston", default="piston", absent="piston")

    def rules(self) -> Iterator[Rule]:
        for key, rod in (("head_end_rod", self.head_end_rod), ("crank_end_rod", self.crank_end_rod)):
            yield Rule(key, rod >= self.bore, f"{{{key}}} is no thinner than the bore ({{bore}})")

    @property
    def head_area(self) -> float:
        """Effective area at the head end in m²."""
        return math.pi / 4 * (self.bore - self.head_end_rod) * (self.bore + self.head_end_rod)

    @property
    def crank_area(self) -> float:
        """Effective area at the crank end in m²."""
        return math.pi / 4 * (self.bore - self.crank_end_rod) * (self.bore + self.crank_end_rod)

    @property
    def chambers(self) -> "dict[str, Chamber]":
        """What the indicator shows, by the key of the end."""
        ends = ("head_end", "crank_end") if self.indicator else ()
        return {end: chamber for end in ends if (chamber := getattr(self.indicator, end)) is not None}

    def cycle_beside(self, cycle: str) -> str:
        """Return the working cycle of a tandem piston: that of the cylinder, or the two-stroke one of its cards.

        A pump or a compressor works in two strokes, whatever drives it: its cards then run twice in 720°.
        """
        given = [chamber.cycles for chamber in self.chambers.values()]
        fits = all(cycle in each for each in given)
        return cycle if fits or not all("two-stroke" in each for each in given) else "two-stroke"

    def indicator_rules(self, cycle: str, ambient: Any) -> Iterator[Rule]:
        """Yield the first thing at each end that does not fit the cycle or the ambient pressure in Pa."""
        lift = 0.0 if self.indicator and self.indicator.absolute else ambient
        for end, chamber in self.chambers.items():
            yield from (rule.below("indicator", end) for rule in first_of(chamber.rules_in(cycle, lift)))
