"""Crankshafts that the tests of strength build in a line; lengths in m."""

from typing import Any

import numpy as np

from kurbel.machine import Cylinder, Machine
from kurbel.machine.crankshaft import Crankshaft
from kurbel.machine.indicator import Indicator
from kurbel.machine.parts import Piston
from kurbel.mechanisms.slider_crank import SliderCrank
from kurbel.solver.case import Case
from kurbel.solver.chapters.stress import ThrowStrength
from kurbel.solver.chapters.stress_places import Place, places
from kurbel.solver.shaft import FreeBody
from machines import constant_pressure

SHAFT: dict[str, Any] = {
    "a": 0.4,
    "b": 0.42,
    "web_distance": 0.17,
    "web_thickness": 0.12,
    "web_width": 0.22,
    "pin_diameter": 0.18,
    "pin_length": 0.2,
    "journal_diameter": 0.19,
    "journal_length": 0.3,
}


def shaft(**changed: Any) -> Crankshaft:
    """The crankshaft above with these lengths instead."""
    return Crankshaft(**(SHAFT | changed))


def body(D: float, T: float, weight: tuple[float, float] = (0.0, 0.0), **changed: Any) -> FreeBody:
    """The crankshaft above on a crank of 0.3 m, under these forces on its pin and at its flywheel in N."""
    pin, turned = np.array([complex(D, T)]), np.array([complex(*weight)])
    return FreeBody(shaft(**changed), 0.3, [pin], turned)


def place_at(body: FreeBody, part: str, name: str) -> Place:
    """The place of this name with its stresses."""
    return next(place for place in places(body) if (place.part, place.name) == (part, name))


def strength(
    crankshaft: Crankshaft,
    mechanism: Any = None,
    card: Any = None,
    rpm: float | None = None,
    **cylinder: Any,
) -> ThrowStrength:
    """Solve a single-acting machine of 0.4 m bore with this crankshaft; 10 bar all the time without a card."""
    piston = Piston(0.4, indicator=Indicator(card or constant_pressure(1e6)))
    own = Cylinder(mechanism or SliderCrank(0.3, 1.5), pistons=(piston,), **cylinder)
    return Case(
        Machine((own,), speed=None if rpm is None else rpm / 60, crankshaft=crankshaft)
    ).stress.throws[0]
