"""Pressures in the chambers over the crank angle: one interface, be it for a card, a trace or a few numbers.

A kind of chamber is a class of `kurbel.machine`, named in `_CHAMBER` of `kurbel.machine.indicator` for the machine file
and in `_KINDS` here; its module is imported only when a machine has one.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

from kurbel.crank_angle import CrankAngle
from kurbel.machine.indicator import Chamber
from kurbel.mechanisms import Mechanism

if TYPE_CHECKING:
    from kurbel.arrays import Array


class Setting(NamedTuple):
    """Where a chamber stands and what its pressures count from.

    cycle: degrees of crank angle, 360 or 720; ambient: absolute pressure in Pa; absolute: whether the chamber's own
    figures are; mirrored: the crank end repeats the head end's figures one stroke later.
    """

    mechanism: Mechanism
    cycle: float
    head_end: bool
    ambient: float
    absolute: bool
    mirrored: bool = False

    @property
    def base(self) -> float:
        """What the chamber's figures less this are gauge pressures, in Pa."""
        return self.ambient if self.absolute else 0.0

    @property
    def lift(self) -> float:
        """What the chamber's figures plus this are absolute pressures, in Pa."""
        return 0.0 if self.absolute else self.ambient


class Pressure(Protocol):
    """The gauge pressure in one chamber over the crank angle."""

    @property
    def starts(self) -> Array:
        """Crank angles (n,) in degrees in [0, cycle), ascending, at which it bends or jumps."""
        ...

    @property
    def bends(self) -> tuple[float, ...]:
        """Crank angles in degrees of a turn at which a quadrature should split."""
        ...

    def __call__(self, x: Any, angle: CrankAngle, within: Array) -> Any:
        """Return the gauge pressure in Pa at crank angles (n,), where the displacement is x (n,) in m.

        within: angles (n,) in degrees inside the segment that is meant, so that each side of a jump can be asked for.
        With a jet for x the pressure is a jet too.
        """
        ...

    @property
    def area(self) -> float:
        """∮ p dz in Pa per cycle, z being the fraction of the stroke from the chamber's smallest volume."""
        ...


_CARDS = "kurbel.solver.pressure.card:CardPressure"
_IDEAL = "kurbel.solver.pressure.ideal:ideal_pressure"
_KINDS = {
    "kurbel.machine.indicator:Card": _CARDS,
    "kurbel.machine.rectangle:Rectangle": "kurbel.solver.pressure.card:rectangle_pressure",
    "kurbel.machine.trace:Trace": "kurbel.solver.pressure.trace:TracePressure",
    "kurbel.machine.ideal_cards:Steam": _IDEAL,
    "kurbel.machine.ideal_cards:Compressor": _IDEAL,
    "kurbel.machine.ideal_cards:Otto": _IDEAL,
    "kurbel.machine.ideal_cards:Diesel": _IDEAL,
}
"""Class of the chamber -> what makes its pressure, from the chamber and its setting."""


def pressure_in(chamber: Chamber, setting: Setting) -> Pressure:
    """Return the pressure in a chamber."""
    paths = (f"{kind.__module__}:{kind.__qualname__}" for kind in type(chamber).__mro__)
    module, name = next(_KINDS[path] for path in paths if path in _KINDS).split(":")
    pressure: Pressure = getattr(import_module(module), name)(chamber, setting)
    return pressure
