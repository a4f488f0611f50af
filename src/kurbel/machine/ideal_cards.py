"""Ideal cards: the few numbers from which theoretical indicator diagrams are drawn.

Fractions are fractions of the stroke from the chamber's smallest volume, as on every card; a clearance is a volume over
the stroke volume. Exponents are those of p V^n.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, ClassVar, Union

from kurbel.declared.forms import Number, Physical
from kurbel.declared.keys import Described, Key, Keys
from kurbel.declared.reading import REFUSED
from kurbel.declared.unit_systems import show
from kurbel.errors import Fault, refuse

CLEARANCE = Number("the stroke", least=1e-6, most=1e5)
"""A clearance volume over the stroke volume: what a machine can have, and p V^n can be computed with."""
CLEARANCE_OR_NONE = Number("the stroke", least=1e-6, most=1e5, zero=True)
"""The same where nothing need be compressed into it: then it may be left out of the theory."""
_CLEARANCE = Key(CLEARANCE_OR_NONE, "Clearance volume over stroke volume", "c", required=True)
AIR_EXPONENT = 1.4
"""Exponent of the adiabatic line of air."""


def _pressure(text: str, required: bool = True, absent: str = "") -> Key:
    # beyond any machine; powers of the volume ratio, up to 1e60, cannot make it overflow
    return Key(Physical("pressure", most=1e15), text, required=required, absent=absent)


def _exponent(text: str, absent: str) -> Key:
    return Key(Number(above=0, most=10), text, "n", absent=absent, example="1.3")


def _order_fault(key: str, high: float, low_name: str, low: float) -> list[Fault]:
    """Return a fault unless the pressure under `key` is larger than the other one."""
    if high > low:
        return []
    return [Fault((key,), f"{show(high, 'pressure')} is not above the {low_name} pressure ({show(low, 'pressure')})")]


def after_polytrope(pressure: float, volume: float, next_volume: float, exponent: float) -> float:
    """Return P (V/V′)^n: the pressure after a change of volume along P V^n = const; P absolute, V in any unit.

    >>> after_polytrope(1.0, 8.0, 1.0, 1.0)
    8.0
    """
    return (
        math.exp(exponent * math.log(volume / next_volume)) * pressure
        if exponent != 1
        else pressure * volume / next_volume
    )


def _vacuum_fault(lift: float, **pressures: float | None) -> str:
    """Return what to say of pressures that are not above the perfect vacuum; lift makes them absolute."""
    for name, pressure in pressures.items():
        if pressure is not None and pressure + lift <= 0:
            return f"{name}: {show(pressure, 'pressure')} is not above the vacuum, as p V^n needs"
    return ""


class _TwoStroke(Described):
    """What the cards of machines of two strokes share: two pressures, one above the other."""

    cycles: ClassVar[tuple[str, ...]] = ("two-stroke",)
    higher: ClassVar[str]
    lower: ClassVar[str]

    @classmethod
    def faults_of_keys(cls, values: Mapping[str, Any]) -> list[Fault]:
        """Return what is wrong with the pressures, whether the other keys could be read or not."""
        high, low = values.get(cls.higher, REFUSED), values.get(cls.lower, REFUSED)
        return [] if high is REFUSED or low is REFUSED else _order_fault(cls.higher, high, cls.lower, low)

    def fault_in(self, cycle: str, lift: float) -> str:
        """Return what does not fit the cycle of the machine or the absolute pressures, or an empty text."""
        if cycle != "two-stroke":
            return f"a {type(self).__name__.lower()} card is one of a two-stroke cycle; leave out 'cycle: {cycle}'"
        return _vacuum_fault(lift, **{key: getattr(self, key) for key in self.KEYS if key in (self.higher, self.lower)})


@dataclass(frozen=True, eq=False, repr=False)
class Steam(_TwoStroke):
    """A steam engine: admission to the cut-off, expansion to the release, exhaust to the start of the compression.

    Pressures in Pa; cut_off, release, compression: fractions of the stroke at which admission ends, exhaust opens, and
    exhaust closes on the way back; exponent 1 is the hyperbola of the old books.
    """

    admission: float
    exhaust: float
    cut_off: float
    clearance: float
    release: float = 1.0
    compression: float = 0.0
    exponent: float = 1.0

    higher, lower = "admission", "exhaust"
    KEYS: ClassVar[Keys] = {
        "admission": _pressure("Pressure while steam is admitted"),
        "exhaust": _pressure("Pressure while steam leaves"),
        "cut_off": Key(Number(above=0, most=1), "Fraction of the stroke at which admission ends", required=True),
        "release": Key(Number(above=0, most=1), "Fraction of the stroke at which the exhaust opens", absent="1"),
        "compression": Key(
            Number(least=0, below=1), "Fraction of the stroke at which the exhaust closes on the way back", absent="0"
        ),
        "clearance": _CLEARANCE,
        "exponent": _exponent("Exponent of expansion and compression", "1, the hyperbola"),
    }

    def __post_init__(self) -> None:
        faults = self.faults_of_keys(vars(self))
        if self.release < self.cut_off:
            faults.append(
                Fault(("release",), f"the exhaust opens at {self.release:g}, before the cut-off at {self.cut_off:g}")
            )
        if not self.clearance and self.compression:
            message = "what is compressed needs a volume in the end; give 'clearance', or leave 'compression' out"
            faults.append(Fault(("clearance",), message))
        refuse(*faults)


@dataclass(frozen=True, eq=False, repr=False)
class Compressor(_TwoStroke):
    """A compressor: suction, compression, delivery, and expansion of what is left in the clearance. Pressures in Pa."""

    suction: float
    delivery: float
    clearance: float
    exponent: float = AIR_EXPONENT

    higher, lower = "delivery", "suction"
    KEYS: ClassVar[Keys] = {
        "suction": _pressure("Pressure while the chamber fills"),
        "delivery": _pressure("Pressure while the chamber empties")._replace(also=("discharge",)),
        "clearance": _CLEARANCE,
        "exponent": _exponent("Exponent of compression and expansion", "1.4, air"),
    }

    def __post_init__(self) -> None:
        refuse(*self.faults_of_keys(vars(self)))

    def fault_in(self, cycle: str, lift: float) -> str:
        """Return what does not fit the cycle of the machine or the absolute pressures, or an empty text."""
        if (fault := super().fault_in(cycle, lift)) or not self.clearance:
            return fault
        top = after_polytrope(self.suction + lift, 1 + self.clearance, self.clearance, self.exponent) - lift
        if self.delivery < top:
            return ""
        return f"delivery: the piston compresses to {show(top, 'pressure')} only; such a compressor delivers nothing"


_ENGINE_KEYS: Keys = {
    "intake": _pressure("Pressure in the cylinder when compression begins, and while it fills"),
    "exhaust": _pressure("Pressure while the burnt gas leaves, in a four-stroke cycle", False, "that of the intake"),
    "compression_ratio": Key(
        Number(least=1.00001, most=1e6),
        "Largest over smallest volume; or give `clearance`",
        "ε",
        required=True,
        example="8",
    ),
    "clearance": Key(
        CLEARANCE,
        "Clearance volume over stroke volume; or give `compression_ratio`",
        "c",
        instead="compression_ratio",
    ),
    "exponent": _exponent("Exponent of the compression", "1.4, air"),
    "expansion_exponent": _exponent("Exponent of the expansion", "that of the compression"),
}
"""What every combustion engine gives."""


def _peak_fault(peak: float | None, card: "_Engine", lift: float) -> str:
    """Return what to say of a peak below the end of the compression; lift makes the pressures absolute."""
    compressed = after_polytrope(card.intake + lift, 1 + card.clearance, card.clearance, card.exponent) - lift
    # as much as rounding of the clearance may take from a peak that is just that pressure
    if peak is None or peak >= compressed - 1e-9 * abs(compressed):
        return ""
    return f"peak: {show(peak, 'pressure')} is below the end of the compression ({show(compressed, 'pressure')})"


class _Engine(Described):
    """What the cards of combustion engines share."""

    intake: float
    exhaust: float | None
    peak: float | None
    clearance: float
    exponent: float

    fires: ClassVar[bool] = True

    @classmethod
    def of_keys(cls, compression_ratio: float = 0.0, clearance: float = 0.0, **keys: Any) -> Any:
        """Return the card with the clearance c = 1/(ε − 1); one of both is given."""
        keys.setdefault("expansion_exponent", keys.get("exponent", AIR_EXPONENT))
        return super().of_keys(clearance=clearance or 1 / (compression_ratio - 1), **keys)

    def __post_init__(self) -> None:
        if self.peak is not None:
            refuse(*_order_fault("peak", self.peak, "intake", self.intake))

    @property
    def cycles(self) -> tuple[str, ...]:
        """Both; with an exhaust stroke the four-stroke cycle alone."""
        return ("two-stroke", "four-stroke") if self.exhaust is None else ("four-stroke",)

    @property
    def leaving(self) -> float:
        """Pressure of the exhaust stroke in Pa."""
        return self.intake if self.exhaust is None else self.exhaust

    def fault_in(self, cycle: str, lift: float) -> str:
        """Return what does not fit the cycle of the machine or the absolute pressures, or an empty text."""
        return (
            _no_exhaust_stroke(self.exhaust, cycle)
            or _vacuum_fault(lift, intake=self.intake, exhaust=self.exhaust)
            or _peak_fault(self.peak, self, lift)
        )


@dataclass(frozen=True, eq=False, repr=False)
class Otto(_Engine):
    """An Otto engine: the pressure rises to its peak at the dead centre, at constant volume. Pressures in Pa.

    exhaust: pressure of the exhaust stroke of a four-stroke cycle, None for that of the intake; a two-stroke engine
    changes its gas at the outer dead centre.
    """

    intake: float
    peak: float
    clearance: float
    exhaust: float | None = None
    exponent: float = AIR_EXPONENT
    expansion_exponent: float = AIR_EXPONENT

    KEYS: ClassVar[Keys] = {**_ENGINE_KEYS, "peak": _pressure("Largest pressure, after combustion")}


@dataclass(frozen=True, eq=False, repr=False)
class Diesel(_Engine):
    """A Diesel engine: injection at constant pressure up to the cut-off. Pressures in Pa.

    peak: where it is given, the pressure first rises to it at constant volume (mixed cycle, Seiliger); None: the
    pressure of injection is that at the end of the compression.
    """

    intake: float
    cut_off: float
    clearance: float
    exhaust: float | None = None
    peak: float | None = None
    exponent: float = AIR_EXPONENT
    expansion_exponent: float = AIR_EXPONENT

    KEYS: ClassVar[Keys] = {
        **_ENGINE_KEYS,
        "cut_off": Key(Number(above=0, below=1), "Fraction of the stroke at which injection ends", required=True),
        "peak": _pressure("Pressure of injection, reached at constant volume", False, "that at the end of compression"),
    }


def _no_exhaust_stroke(exhaust: float | None, cycle: str) -> str:
    if exhaust is None or cycle == "four-stroke":
        return ""
    return "exhaust: a two-stroke engine has no exhaust stroke; leave it out, or write 'cycle: four-stroke' at the top"


IdealCard = Union[Steam, Compressor, Otto, Diesel]
