"""Cards as the indicator drew them: points on the paper, by the length of the card and the scale of its spring."""

from collections.abc import Sequence
from dataclasses import dataclass

from kurbel.declared.forms import Physical
from kurbel.declared.kinds import Factor
from kurbel.declared.record import Record, field
from kurbel.declared.units import unit_factor, written_unit
from kurbel.machine.rectangle import Rectangle


class PaperLength(float):
    """A length in m with the unit that it is written in, which is also that of the points on the paper."""

    unit = "mm"


class _Paper(Physical):
    """The length of a card, with its unit."""

    def parse(self, text: str, folder: str) -> PaperLength:
        """Return the length; raises RuleError."""
        length = PaperLength(super().parse(text, folder))
        length.unit = written_unit(text)
        return length

    @property
    def is_number(self) -> bool:
        """Whether the value is a mere number: it has a unit, too."""
        return False

    def numbers(self, texts: Sequence[str]) -> None:
        """Return nothing: each text has a unit of its own."""


@dataclass(frozen=True, eq=False, repr=False)
class Drawn(Record):
    """The paper of a card: its length, and the scale of the spring in m/Pa."""

    length: float = field(_Paper("length", above=0), "Length of the card on the paper", "l", required=True)
    spring: float = field("spring", "Scale of the spring: height on the paper over pressure", above=0, required=True)

    @property
    def paper_unit(self) -> str:
        """The unit of the points: that of the length, or mm."""
        return self.length.unit if isinstance(self.length, PaperLength) else PaperLength.unit

    @property
    def unit(self) -> Factor:
        """What turns heights above the atmospheric line into Pa."""
        up, down = unit_factor(self.paper_unit, "length")
        return up, down * self.spring

    @property
    def whole(self) -> float:
        """The length of the card in the unit of its points."""
        up, down = unit_factor(self.paper_unit, "length")
        return round(self.length * down / up, 9)

    def rectangle(self, mean_height: float | None = None, area: float | None = None) -> Rectangle:
        """Return the card of the mean height in m, or of the area in m² by planimeter: p_i = a/(l · spring)."""
        height = (area or 0.0) / self.length if mean_height is None else mean_height
        return Rectangle(mean=height / self.spring)
