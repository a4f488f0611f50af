"""Cards as the indicator drew them: by the length of the card on the paper and the scale of the spring."""

from dataclasses import dataclass

from kurbel.declared.forms import Physical
from kurbel.declared.forms.figures import Bound
from kurbel.declared.kinds import Factor
from kurbel.declared.record import Record, field
from kurbel.declared.units import written_unit
from kurbel.machine.rectangle import Rectangle


class _OnPaper(Physical):
    """A length that keeps the unit in which it is written."""

    def parse(self, text: str, folder: str) -> Bound:
        """Return the length in m, with its unit."""
        return Bound(super().parse(text, folder), written_unit(text))


@dataclass(frozen=True, eq=False, repr=False)
class Drawn(Record):
    """The paper of a card: its length, and the scale of the spring in m/Pa.

    Points are in millimetres, or in inches where the length is.
    """

    length: float = field(
        _OnPaper("length", above=0),
        "Length of the card on the paper",
        "l",
        required=True,
    )
    spring: float = field("spring", "Scale of the spring: height on the paper over pressure", above=0, required=True)

    @property
    def unit(self) -> str:
        """The unit of the points."""
        return "in" if isinstance(self.length, Bound) and self.length.unit.startswith("in") else "mm"

    @property
    def factor(self) -> Factor:
        """What turns heights above the atmospheric line into Pa."""
        return (1.0, 1e3 * self.spring) if self.unit == "mm" else (254.0, 1e4 * self.spring)

    @property
    def whole(self) -> float:
        """The length of the card in the unit of its points."""
        return round(1e3 * self.length if self.unit == "mm" else self.length * 1e4 / 254, 9)

    def rectangle(self, mean_height: float | None = None, area: float | None = None) -> Rectangle:
        """Return the card of the mean height in m, or of the area in m² by planimeter: p_i = a/(l · spring)."""
        height = (area or 0.0) / self.length if mean_height is None else mean_height
        return Rectangle(mean=height / self.spring)
