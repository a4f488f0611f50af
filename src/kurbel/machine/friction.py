"""Friction along the stroke line: of the crosshead on its guide, of piston rings (Redtenbacher 1862), or as a force."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from kurbel.declared.forms import Count, Number, Physical, Record
from kurbel.declared.keys import Described, Key, Keys, check
from kurbel.errors import Fault, refuse


@dataclass(frozen=True, eq=False)
class Rings(Described):
    """Piston rings: their number, height in m, pressure on the wall in Pa, and coefficient of friction."""

    count: int
    height: float
    pressure: float
    coefficient: float

    KEYS: ClassVar[Keys] = {
        "count": Key(Count(least=1), "Number of rings", required=True),
        "height": Key(Physical("length", above=0), "Height of one ring along the bore", "h", required=True),
        "pressure": Key(Physical("pressure", least=0), "Pressure of the ring on the wall", "p_r", required=True),
        "coefficient": Key(Number(least=0), "Coefficient of friction", "f", required=True),
    }


@dataclass(frozen=True, eq=False)
class Guide(Described):
    """The shoe with which a crosshead presses on its guide: length along the stroke and width in m."""

    length: float
    width: float

    KEYS: ClassVar[Keys] = {
        "length": Key(Physical("length", above=0), "Length of the shoe along the stroke", required=True),
        "width": Key(Physical("length", above=0), "Width of the shoe", required=True),
    }


@dataclass(frozen=True, eq=False)
class Friction(Described):
    """Coefficient f of the crosshead, None where it is left out, rings, a force in N against the motion, the shoe."""

    crosshead: float | None = None
    rings: Rings | None = None
    constant: float | None = None
    guide: Guide | None = None

    KEYS: ClassVar[Keys] = {
        "crosshead": Key(Number(least=0), "Coefficient of friction of the crosshead on its guide", "f"),
        "rings": Key(Record("kurbel.machine.friction:Rings"), "Piston rings"),
        "constant": Key(Physical("force", least=0), "Force against the motion, the same over the stroke", "F_0"),
        "guide": Key(Record("kurbel.machine.friction:Guide"), "Shoe of the crosshead", needs="crosshead"),
    }

    def __post_init__(self) -> None:
        check(self.KEYS, vars(self))
        if self.crosshead is None and self.rings is None and self.constant is None:
            refuse(Fault((), "no friction is given; leave 'friction' out or give 'crosshead', 'rings' or 'constant'"))
