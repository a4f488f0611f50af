"""Friction of the crosshead on its guide and of piston rings (Redtenbacher 1862), as a force, in pins and journals."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

from kurbel.declared.record import Record, Rule, field
from kurbel.errors import Fault

if TYPE_CHECKING:
    from kurbel.machine.crankshaft import Crankshaft


@dataclass(frozen=True, eq=False, repr=False)
class Rings(Record):
    """Piston rings."""

    count: int = field(int, "Number of rings", least=1, required=True)
    height: float = field("length", "Height of one ring along the bore", "h", above=0, required=True)
    pressure: float = field("pressure", "Pressure of the ring on the wall", "p_r", least=0, required=True)
    coefficient: float = field("ratio", "Coefficient of friction", "f", least=0, required=True)


@dataclass(frozen=True, eq=False, repr=False)
class Guide(Record):
    """The shoe with which a crosshead presses on its guide."""

    length: float = field("length", "Length of the shoe along the stroke", above=0, required=True)
    width: float = field("length", "Width of the shoe", above=0, required=True)


_PINS = {
    "crank_pin": ("crank_pin_diameter", "pin_diameter"),
    "crosshead_pin": ("crosshead_pin_diameter", ""),
    "journals": ("journal_diameter", "journal_diameter"),
}
"""Where pins and journals rub: the keys of their diameters here, and in `crankshaft`."""


@dataclass(frozen=True, eq=False, repr=False)
class Friction(Record):
    """Friction of the moving parts of a cylinder; what is None is left out."""

    crosshead: float | None = field("ratio", "Coefficient of friction of the crosshead on its guide", "f", least=0)
    rings: Rings | None = field(Rings, "Piston rings")
    constant: float | None = field("force", "Force against the motion, the same over the stroke", "F_0", least=0)
    guide: Guide | None = field(Guide, "Shoe of the crosshead", needs="crosshead")
    crank_pin: float | None = field(
        "ratio", "Coefficient of friction of the connecting rod on the crank pin", "f_Z", least=0
    )
    crank_pin_diameter: float | None = field(
        "length", "Diameter of the crank pin", "d_z", above=0, absent="that of `crankshaft`", needs="crank_pin"
    )
    crosshead_pin: float | None = field(
        "ratio",
        "Coefficient of friction of the connecting rod on the crosshead pin",
        "f_H",
        least=0,
        needs="crosshead_pin_diameter",
    )
    crosshead_pin_diameter: float | None = field(
        "length", "Diameter of the crosshead pin", "d_H", above=0, needs="crosshead_pin"
    )
    crosshead_pin_length: float | None = field(
        "length", "Length of the crosshead pin", "l_H", above=0, absent="no pressure on it", needs="crosshead_pin"
    )
    journals: float | None = field(
        "ratio", "Coefficient of friction of the journals in the main bearings", "f_j", least=0
    )
    journal_diameter: float | None = field(
        "length", "Diameter of the journals", "d_j", above=0, absent="that of `crankshaft`", needs="journals"
    )

    def rules(self) -> Iterator[Rule]:
        yield from self.contradictions()
        none = not self.of_pins and self.crosshead is None and self.rings is None and self.constant is None
        given = "'crosshead', 'rings', 'constant', 'crank_pin', 'crosshead_pin' or 'journals'"
        yield Rule((), none, f"no friction is given; leave 'friction' out or give {given}")

    @property
    def of_pins(self) -> tuple[str, ...]:
        """The keys of the pins and journals whose coefficient is given."""
        given = (self.crank_pin, self.crosshead_pin, self.journals)
        return tuple(name for name, coefficient in zip(_PINS, given) if coefficient is not None)

    def faults_beside(self, shaft: "Crankshaft | None") -> Iterator[Fault]:
        """Yield a diameter that is needed and given nowhere, or given here and in the crankshaft."""
        for name in self.of_pins:
            here, there = _PINS[name]
            in_shaft = there and shaft is not None and vars(shaft)[there] is not None
            given = vars(self)[here] is not None
            if not given and not in_shaft:
                needed = f"'{name}' needs a diameter: write for instance '{here}: 120 mm'"
                yield Fault((name,), f"{needed}, or give '{there}' in 'crankshaft'" if there else needed)
            elif given and in_shaft:
                yield Fault((here,), f"'{there}' in 'crankshaft' says the same; leave one of them out")
