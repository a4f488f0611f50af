"""Friction of the crosshead on its guide and of piston rings (Redtenbacher 1862), as a force, in pins and journals."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar

from kurbel.declared.forms import Count, Number, Record, not_negative, positive
from kurbel.declared.keys import Described, Key, Keys, check
from kurbel.errors import Fault, refused

if TYPE_CHECKING:
    from kurbel.machine.crankshaft import Crankshaft


@dataclass(frozen=True, eq=False, repr=False)
class Rings(Described):
    """Piston rings: their number, height in m, pressure on the wall in Pa, and coefficient of friction."""

    count: int
    height: float
    pressure: float
    coefficient: float

    KEYS: ClassVar[Keys] = {
        "count": Key(Count(least=1), "Number of rings", required=True),
        "height": positive("length", "Height of one ring along the bore", "h", required=True),
        "pressure": not_negative("pressure", "Pressure of the ring on the wall", "p_r", required=True),
        "coefficient": Key(Number(least=0), "Coefficient of friction", "f", required=True),
    }


@dataclass(frozen=True, eq=False, repr=False)
class Guide(Described):
    """The shoe with which a crosshead presses on its guide: length along the stroke and width in m."""

    length: float
    width: float

    KEYS: ClassVar[Keys] = {
        "length": positive("length", "Length of the shoe along the stroke", required=True),
        "width": positive("length", "Width of the shoe", required=True),
    }


_PINS = {
    "crank_pin": ("crank_pin_diameter", "pin_diameter"),
    "crosshead_pin": ("crosshead_pin_diameter", ""),
    "journals": ("journal_diameter", "journal_diameter"),
}
"""Where pins and journals rub: the keys of their diameters here, and in `crankshaft`."""


def _diameter(of: str, text: str, symbol: str, absent: str = "") -> Key:
    return positive("length", text, symbol, absent=absent, needs=of)


@dataclass(frozen=True, eq=False, repr=False)
class Friction(Described):
    """Coefficient f of the crosshead, None where it is left out, rings, a force in N against the motion, the shoe.

    crank_pin, crosshead_pin, journals: coefficients of the pins of the connecting rod and of the main bearings, with
    diameters in m, which may stand in the crankshaft; crosshead_pin_length in m for its pressure.
    """

    crosshead: float | None = None
    rings: Rings | None = None
    constant: float | None = None
    guide: Guide | None = None
    crank_pin: float | None = None
    crank_pin_diameter: float | None = None
    crosshead_pin: float | None = None
    crosshead_pin_diameter: float | None = None
    crosshead_pin_length: float | None = None
    journals: float | None = None
    journal_diameter: float | None = None

    KEYS: ClassVar[Keys] = {
        "crosshead": Key(Number(least=0), "Coefficient of friction of the crosshead on its guide", "f"),
        "rings": Key(Record(Rings), "Piston rings"),
        "constant": not_negative("force", "Force against the motion, the same over the stroke", "F_0"),
        "guide": Key(Record(Guide), "Shoe of the crosshead", needs="crosshead"),
        "crank_pin": Key(Number(least=0), "Coefficient of friction of the connecting rod on the crank pin", "f_Z"),
        "crank_pin_diameter": _diameter("crank_pin", "Diameter of the crank pin", "d_z", "that of `crankshaft`"),
        "crosshead_pin": Key(
            Number(least=0),
            "Coefficient of friction of the connecting rod on the crosshead pin",
            "f_H",
            needs="crosshead_pin_diameter",
        ),
        "crosshead_pin_diameter": _diameter("crosshead_pin", "Diameter of the crosshead pin", "d_H"),
        "crosshead_pin_length": _diameter("crosshead_pin", "Length of the crosshead pin", "l_H", "no pressure on it"),
        "journals": Key(Number(least=0), "Coefficient of friction of the journals in the main bearings", "f_j"),
        "journal_diameter": _diameter("journals", "Diameter of the journals", "d_j", "that of `crankshaft`"),
    }

    def __post_init__(self) -> None:
        check(self.KEYS, vars(self))
        if all(getattr(self, name) is None for name in ("crosshead", "rings", "constant", *_PINS)):
            given = "'crosshead', 'rings', 'constant', 'crank_pin', 'crosshead_pin' or 'journals'"
            refused(f"no friction is given; leave 'friction' out or give {given}")

    @property
    def of_pins(self) -> tuple[str, ...]:
        """The keys of the pins and journals whose coefficient is given."""
        return tuple(name for name in _PINS if getattr(self, name) is not None)

    def faults_beside(self, shaft: "Crankshaft | None") -> Iterator[Fault]:
        """Yield a diameter that is needed and given nowhere, or given here and in the crankshaft."""
        for name in self.of_pins:
            here, there = _PINS[name]
            in_shaft = there and getattr(shaft, there, None)
            if not getattr(self, here) and not in_shaft:
                needed = f"'{name}' needs a diameter: write for instance '{here}: 120 mm'"
                yield Fault((name,), f"{needed}, or give '{there}' in 'crankshaft'" if there else needed)
            elif getattr(self, here) and in_shaft:
                yield Fault((here,), f"'{there}' in 'crankshaft' says the same; leave one of them out")
