"""What a machine file gives of one cylinder, in the numbers of a calculation: Decimals for the truth, else floats.

No formula of motion, force or sign stands here; each calculation has its own.
"""

import math
from collections.abc import Callable, Iterator
from decimal import Decimal
from typing import Any, NamedTuple

from kurbel.accuracy.decimals import pi
from kurbel.machine import CYCLES, Cylinder, Machine

Number = Callable[[Any], Any]
"""`float` or `Decimal`."""


class End(NamedTuple):
    """An end of a cylinder with its card: area in m²; lift: what makes its pressures absolute, base: gauge, in Pa."""

    card: Any
    area: Any
    head_end: bool
    lift: Any
    base: Any


class Given:
    """Masses in kg, weight in N and its lean in degrees, friction and cards of one cylinder.

    massless: whether masses and weight are left out.
    """

    def __init__(self, machine: Machine, cylinder: Cylinder, number: Number, massless: bool = False) -> None:
        self._number, self._ambient, self._cylinder = number, machine.ambient, cylinder
        self.pi = pi() if number is Decimal else math.pi
        self.turns = CYCLES[machine.cycle_of(cylinder)]
        masses = None if massless else cylinder.masses
        rod = masses.connecting_rod if masses else None
        rod_mass, share = (number(rod.mass), number(rod.share)) if rod else (number(0), number(0))
        self.mass = number(masses.parts if masses else 0) + rod_mass * share
        self.turning_inertia = rod_mass * (1 - share) * number(cylinder.mechanism.crank) ** 2
        self.lean = machine.lean_of(cylinder)
        self.weight = number(0) if self.lean is None else self.mass * number("9.80665")
        friction = cylinder.friction
        rubs = friction and cylinder.mechanism.has_rod
        self.crosshead = number(friction.crosshead or 0) if friction and rubs else number(0)

    @property
    def steady_friction(self) -> Any:
        """What rings and a constant force take along the stroke in N."""
        number, friction = self._number, self._cylinder.friction
        constant, rings = (friction.constant, friction.rings) if friction else (None, None)
        if rings is None:
            return number(constant or 0)
        bore, height = number(self._cylinder.pistons[0].bore), number(rings.height)
        pressure, coefficient = number(rings.pressure), number(rings.coefficient)
        return number(constant or 0) + rings.count * self.pi * bore * height * pressure * coefficient

    @property
    def ends(self) -> Iterator[End]:
        """The ends of all pistons that have cards."""
        number, ambient = self._number, self._number(self._ambient)
        for piston in self._cylinder.pistons:
            indicator: Any = piston.indicator
            lift, base = (number(0), ambient) if indicator and indicator.absolute else (ambient, number(0))
            for name in ("head", "crank") if indicator else ():
                card, rod = getattr(indicator, f"{name}_end"), number(getattr(piston, f"{name}_end_rod"))
                if card is not None:
                    yield End(card, self.pi / 4 * (number(piston.bore) ** 2 - rod**2), name == "head", lift, base)
