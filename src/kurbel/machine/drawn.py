"""Cards as the indicator drew them: millimetres on the paper, by the length of the card and the scale of its spring."""

from dataclasses import dataclass

from kurbel.declared.kinds import Factor
from kurbel.declared.record import Record, field
from kurbel.machine.rectangle import Rectangle


@dataclass(frozen=True, eq=False, repr=False)
class Drawn(Record):
    """The paper of a card: its length, and the scale of the spring in m/Pa."""

    length: float = field("length", "Length of the card on the paper", "l", above=0, required=True)
    spring: float = field("spring", "Scale of the spring: height on the paper over pressure", above=0, required=True)

    @property
    def unit(self) -> Factor:
        """What turns millimetres above the atmospheric line into Pa."""
        return 1.0, 1e3 * self.spring

    @property
    def whole(self) -> float:
        """The length of the card in mm."""
        return round(1e3 * self.length, 9)

    def rectangle(self, mean_height: float | None = None, area: float | None = None) -> Rectangle:
        """Return the card of the mean height in m, or of the area in m² by planimeter: p_i = a/(l · spring)."""
        height = (area or 0.0) / self.length if mean_height is None else mean_height
        return Rectangle(mean=height / self.spring)
