"""Machines that several tests build in a line."""

from typing import Any

from kurbel.machine import Cylinder, Machine
from kurbel.machine.indicator import Card, Constant, Indicator
from kurbel.machine.parts import Masses, Piston
from kurbel.mechanisms import Mechanism
from kurbel.mechanisms.slider_crank import SliderCrank
from kurbel.solver.forces import CylinderForces

AT = 98066.5

STEAM_CARD = Card.from_keys(
    unit=(AT, 1),
    expansion=[(0, 9.5), (0.35, 9.5), (0.5, 6.7), (0.7, 4.7), (0.95, 3.3), (1, 2.2)],
    compression=[(1, 1.2), (0.25, 1.2), (0.1, 2.4), (0.02, 6.5), (0, 9.5)],
)


def constant_pressure(pressure: float) -> Card:
    """A chamber that always holds this pressure in Pa."""
    return Constant.from_keys(expansion=pressure, compression=pressure)


def one_cylinder(mechanism: Mechanism, rpm: float | None = None, **cylinder: Any) -> CylinderForces:
    """Solve a machine with one cylinder."""
    own = Cylinder(mechanism, **cylinder)
    return CylinderForces(Machine((own,), speed=None if rpm is None else rpm / 60), own)


def single_acting(
    crank: float,
    rod: float,
    bore: float,
    pressure: float,
    rpm: float,
    mass: float,
    vertical: bool = False,
    **more: Any,
) -> CylinderForces:
    """Solve a single-acting cylinder whose gauge pressure in Pa is the same all the time."""
    return one_cylinder(
        SliderCrank(crank, rod),
        rpm,
        pistons=(Piston(bore, indicator=Indicator(constant_pressure(pressure))),),
        masses=Masses(mass),
        inclination=90.0 if vertical else None,
        **more,
    )
