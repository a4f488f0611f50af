"""Pressures in the chambers over the crank angle: one interface, be it for a card, a trace or a few numbers.

A kind of chamber is a class of `kurbel.machine`, named in `_CHAMBER` of `kurbel.machine.indicator` for the machine file
and in `_PROCESSES` or `_PRESSURES` here; its module is imported only when a machine has one.
"""

from collections.abc import Callable
from importlib import import_module
from typing import TYPE_CHECKING, Any, NamedTuple, Protocol

import numpy as np

from kurbel.arrays import Array, Indices
from kurbel.machine.variants import Chambers, count_of, taken
from kurbel.mechanisms import Mechanism
from kurbel.numerics.extreme import Extreme

if TYPE_CHECKING:
    from kurbel.solver.pressure.segments import Processes


class Setting(NamedTuple):
    """Where a chamber stands and what its pressures count from.

    cycle: degrees of crank angle, 360 or 720; ambient: absolute pressure in Pa, of many variants (v,); absolute:
    whether the chamber's own
    figures are; mirrored: the crank end repeats the head end's figures one stroke later.
    """

    mechanism: Mechanism
    cycle: float
    head_end: bool
    ambient: float
    absolute: bool
    mirrored: bool = False

    def taken(self, index: Indices) -> "Setting":
        """Return the setting of these variants, with numbers of the shape of the index."""
        return self._replace(mechanism=taken(self.mechanism, index), ambient=taken(self.ambient, index))

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
    def straight(self) -> bool:
        """Whether it is a straight line over the stroke between any two neighbouring starts."""
        ...

    @property
    def starts(self) -> Any:
        """Crank angles (n,) in degrees in [0, cycle), ascending, at which it bends or jumps; or `Flat` of variants."""
        ...

    @property
    def bends(self) -> tuple[Any, ...]:
        """Crank angles in degrees of a turn at which a quadrature should split."""
        ...

    @property
    def highest(self) -> Extreme:
        """The highest gauge pressure in Pa, and the first crank angle in degrees of the cycle that has it."""
        ...

    def held(self, within: Array) -> Any:
        """Return what holds over the segments in which angles (n,) in degrees lie: each side of a jump has its own."""
        ...

    def __call__(self, z: Any, degrees: Array, held: Any) -> Any:
        """Return the gauge pressure in Pa at crank angles (n,) in degrees, where z (n,) of the stroke is passed.

        held: of the segment that is meant. With a jet for z the pressure is a jet too.
        """
        ...

    def taken(self, index: Indices) -> "Pressure":
        """Return the pressure of these of many variants, at angles of the shape of the index."""
        ...

    @property
    def area(self) -> Any:
        """∮ p dz in Pa per cycle, z being the fraction of the stroke from the chamber's smallest volume."""
        ...


_IDEAL = "kurbel.solver.pressure.ideal:process_in"
_PROCESSES = {
    "kurbel.machine.indicator:Card": "kurbel.solver.pressure.card:card_process",
    "kurbel.machine.rectangle:Rectangle": "kurbel.solver.pressure.card:rectangle_process",
    "kurbel.machine.ideal_cards:Steam": _IDEAL,
    "kurbel.machine.ideal_cards:Compressor": _IDEAL,
    "kurbel.machine.ideal_cards:Otto": _IDEAL,
    "kurbel.machine.ideal_cards:Diesel": _IDEAL,
}
"""Class of a chamber with a process over the stroke -> what makes it, from the chamber and its setting."""
_PRESSURES = {"kurbel.machine.trace:Trace": "kurbel.solver.pressure.trace:TracePressure"}
"""Class of another chamber -> what makes its pressure, from the chamber and its setting."""


def pressure_in(chamber: Any, setting: Setting) -> Pressure:
    """Return the pressure in a chamber, or in the chambers of many variants."""
    if isinstance(chamber, Chambers) or _named(chamber, _PROCESSES):
        from kurbel.solver.pressure.card import ProcessPressure

        return ProcessPressure(_processes(chamber, setting), setting)
    return _load(chamber, _PRESSURES)(chamber, setting)  # type: ignore[no-any-return]


def _processes(chamber: Any, setting: Setting) -> "Processes":
    from kurbel.solver.pressure.segments import Processes

    chambers = chamber if isinstance(chamber, Chambers) else Chambers((chamber,), None)
    if (count := count_of(setting.ambient)) is None:
        return Processes(tuple(_load(one, _PROCESSES)(one, setting) for one in chambers.each), chambers.which)
    which = np.zeros(count, dtype=np.intp) if chambers.which is None else chambers.which
    ambients: Any = setting.ambient
    one_by_one = zip([chambers.each[place] for place in which.tolist()], ambients.tolist())
    each = (_load(one, _PROCESSES)(one, setting._replace(ambient=ambient)) for one, ambient in one_by_one)
    return Processes(tuple(each), np.arange(count))


def _named(chamber: Any, targets: dict[str, str]) -> str:
    """Return what stands for the class of a chamber, or for one that it is made from; '' for none."""
    paths = (f"{kind.__module__}:{kind.__qualname__}" for kind in type(chamber).__mro__)
    return next((targets[path] for path in paths if path in targets), "")


def _load(chamber: Any, targets: dict[str, str]) -> Callable[[Any, Setting], Any]:
    module, name = _named(chamber, targets).split(":")
    return getattr(import_module(module), name)  # type: ignore[no-any-return]
