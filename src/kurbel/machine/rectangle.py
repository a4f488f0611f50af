"""Rectangular cards: one pressure on every stroke, or an indicated mean pressure and nothing more."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any, ClassVar

from kurbel.declared.forms import Physical
from kurbel.declared.keys import Rule
from kurbel.declared.numerals import NUMBER, plain
from kurbel.declared.reading import shown
from kurbel.declared.unit_systems import show
from kurbel.errors import refused


@dataclass(frozen=True, eq=False)
class Rectangle:
    """A card of horizontal lines, for any working cycle; pressures in Pa.

    level: the pressure on every stroke, None for the ambient; mean: what the expansion line of a chamber that drives
    stands above it, or, where it is negative, the compression line of one that is driven: p_i. notes: what is to be
    said of such a card.
    """

    level: float | None = None
    mean: float = 0.0

    cycles: ClassVar[tuple[str, ...]] = ("two-stroke", "four-stroke")

    @property
    def notes(self) -> tuple[str, ...]:
        """That a card which only keeps the work is none that was indicated."""
        if not self.mean:
            return ()
        return (
            f"a rectangular card of the mean pressure {show(self.mean, 'pressure')} stands for the true one: "
            "work and power hold, forces over the angle do not",
        )

    def rules_in(self, cycle: str, lift: Any) -> Iterator[Rule]:
        """Yield what is below the vacuum; lift makes the pressure absolute, in Pa."""
        if self.level is not None:
            below = "{level:pressure} is below the vacuum, which is at {vacuum:pressure}"
            yield Rule((), self.level + lift < 0, below, {"level": self.level, "vacuum": 0.0 - lift})


class Rectangular(Physical):
    """A pressure that becomes the `level` or the `mean` of a rectangular card."""

    def __init__(self, field: str) -> None:
        super().__init__("pressure")
        self.field = field

    def parse(self, text: str, folder: str) -> Rectangle:  # type: ignore[override]
        """Return the card of the pressure that stands here; raises RuleError."""
        if self.field == "level" and not NUMBER.match(plain(text)):
            refused(f"expected {self.expected()}, or a card below it, got '{shown(text)}'")
        return Rectangle(**{self.field: super().parse(text, folder)})

    def of_numbers(self, numbers: Any) -> Rectangle:
        """Return the card of many machines, of their pressures (machines,)."""
        return Rectangle(**{self.field: numbers})
