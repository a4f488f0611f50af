"""Ideal cards: the few numbers from which theoretical indicator diagrams are drawn.

Fractions are fractions of the stroke from the chamber's smallest volume, as on every card; a clearance is a volume over
the stroke volume. Exponents are those of p V^n.
"""

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Any, ClassVar, Union

import numpy as np

from kurbel.arrays import Number, Truth
from kurbel.declared.forms.values import CLEARANCE, CLEARANCE_OR_NONE
from kurbel.declared.keys import Key
from kurbel.declared.record import FieldValue, Record, Rule, alternative, field
from kurbel.machine.chamber import ChamberCard, StrokeCard

_CLEARANCE = "Clearance volume over stroke volume"
AIR_EXPONENT = 1.4
"""Exponent of the adiabatic line of air."""


def _pressure(text: str, **more: Any) -> FieldValue:
    # beyond any machine; powers of the volume ratio, up to 1e60, cannot make it overflow
    return field("pressure", text, most=1e15, **more)


def _exponent(text: str, absent: str, default: float | None = None, **more: Any) -> FieldValue:
    return field(
        "ratio", text, "n", default=default, above=0, most=10, absent=absent, example="1.3", **more
    )


def _order(key: str, high: Number, low_name: str, low: Number) -> Rule:
    """Return the rule that the pressure under `key` is larger than the other one."""
    message = f"{{high:pressure}} is not above the {low_name} pressure ({{low:pressure}})"
    return Rule(key, high <= low, message, {"high": high, "low": low})


def after_polytrope(pressure: Number, volume: Number, next_volume: Number, exponent: Number) -> Any:
    """Return P (V/V′)^n: the pressure after a change of volume along P V^n = const; P absolute, V in any unit.

    >>> after_polytrope(1.0, 8.0, 1.0, 1.0)
    8.0
    """
    has_arrays = any(map(np.ndim, (volume, next_volume, exponent)))
    if has_arrays:
        hyperbola = pressure * volume / next_volume
        ratio = np.exp(exponent * np.log(volume / next_volume))
        return np.where(np.equal(exponent, 1), hyperbola, ratio * pressure)
    if exponent == 1:
        return pressure * volume / next_volume
    return math.exp(exponent * math.log(volume / next_volume)) * pressure


def _above_vacuum(lift: Number, **pressures: Number | None) -> Iterator[Rule]:
    """Yield the rule that pressures are above the perfect vacuum; lift makes them absolute."""
    for name, pressure in pressures.items():
        if pressure is not None:
            message = f"{name}: {{pressure:pressure}} is not above the vacuum, as p V^n needs"
            yield Rule((), pressure + lift <= 0, message, {"pressure": pressure})


def diagram_factor_field() -> FieldValue:
    """Return the field of the diagram factor of a card."""
    text = (
        "p_i of the true card over that of the theoretical one, "
        "which is drawn lower about the back pressure"
    )
    return field("ratio", text, "κ_d", default=1.0, above=0, most=1, example="0.85")


def _factor_notes(factor: float) -> tuple[str, ...]:
    """Return the note on what a diagram factor leaves out of the pressures."""
    if factor == 1:
        return ()
    most = f"{100 * (1 - factor):.3g} %"
    return (
        f"diagram_factor {factor:g}: a real card loses at its corners and keeps its peak, "
        f"here up to {most} low",
    )


def _only_two_stroke(card: Record, cycle: str) -> Rule:
    """Return the rule that a card is of no other cycle."""
    kind = type(card).__name__.lower()
    message = f"a {kind} card is one of a two-stroke cycle; leave out 'cycle: {cycle}'"
    return Rule((), cycle != "two-stroke", message)


class Steam(StrokeCard, Record):
    """A steam engine: admission to the cut-off, expansion to the release, exhaust to the start of the compression.

    cut_off: None where a valve sets this and the other events (`kurbel.machine.valve`).
    """

    admission: float = _pressure("Pressure while steam is admitted")
    exhaust: float = _pressure("Pressure while steam leaves")
    cut_off: float | None = field(
        "ratio",
        "Fraction of the stroke at which admission ends",
        above=0,
        most=1,
        absent="the `valve` sets all events",
        example="0.35",
    )
    clearance: float = field(CLEARANCE_OR_NONE, _CLEARANCE, "c", example="0.05")
    release: float = field(
        "ratio",
        "Fraction of the stroke at which the exhaust opens",
        default=1.0,
        above=0,
        most=1,
        example="0.95",
    )
    compression: float = field(
        "ratio",
        "Fraction of the return stroke at which the exhaust closes",
        default=0.0,
        least=0,
        below=1,
        example="0.2",
    )
    lead: float = field(
        "ratio",
        "Fraction of the stroke before the dead centre at which admission opens; the pressure then rises evenly",
        default=0.0,
        least=0,
        below=1,
        example="0.01",
    )
    exponent: float = _exponent("Exponent of expansion and compression", "1, the hyperbola", 1.0)
    diagram_factor: float = diagram_factor_field()

    cycles: ClassVar[tuple[str, ...]] = ("two-stroke",)
    by_steam: ClassVar[bool] = True

    @property
    def exponents(self) -> tuple[Number, ...]:
        """That of expansion and compression."""
        return (self.exponent,)

    @property
    def events(self) -> list[str]:
        """The keys of the events that are given."""
        values = self._not_default()
        return [key for key in ("cut_off", "release", "compression", "lead") if key in values]

    def rules_of_events(self, valve_compresses: Truth | None) -> Iterator[Rule]:
        """Yield events that are missing without a valve, or given beside one; of the clearance the rule of the card."""
        if valve_compresses is None:
            message = (
                "'cut_off' is missing; "
                "give it here, or the cylinder a 'valve', which sets all events"
            )
            yield Rule("steam", self.cut_off is None, message)
            return
        message = "the 'valve' sets cut_off, release, compression and lead; leave them out"
        for key in self.events:
            yield Rule(("steam", key), True, message, at_key=True)
        lacks_volume = (self.clearance == 0) & valve_compresses
        message = (
            "the valve shuts the exhaust before the dead centre, "
            "and compression needs a final volume; give 'clearance'"
        )
        yield Rule(("steam", "clearance"), lacks_volume, message)

    @property
    def back_pressure(self) -> float:
        """Pressure in Pa about which a diagram factor lowers the card."""
        return self.exhaust

    @property
    def notes(self) -> tuple[str, ...]:
        """What the diagram factor leaves out."""
        return _factor_notes(self.diagram_factor)

    def rules(self) -> Iterator[Rule]:
        is_too_early = (self.lead > 0) & (self.lead >= self.compression)
        message = (
            "{lead} is not less than the compression ({compression}), in which admission opens"
        )
        yield Rule("lead", is_too_early, message)
        yield _order("admission", self.admission, "exhaust", self.exhaust)
        if self.cut_off is not None:
            message = "the exhaust opens at {release}, before the cut-off at {cut_off}"
            yield Rule("release", self.release < self.cut_off, message)
        lacks_volume = (self.clearance == 0) & (self.compression != 0)
        message = "compression needs a final volume; give 'clearance', or leave 'compression' out"
        yield Rule("clearance", lacks_volume, message)

    def rules_in(self, cycle: str, lift: Number) -> Iterator[Rule]:
        """Yield the rules on the cycle of the machine, and on absolute pressures."""
        yield _only_two_stroke(self, cycle)
        yield from _above_vacuum(lift, admission=self.admission, exhaust=self.exhaust)


class Compressor(StrokeCard, Record):
    """A compressor: suction, compression, delivery, and expansion of what is left in the clearance."""

    suction: float = _pressure("Pressure while the chamber fills")
    delivery: float = _pressure("Pressure while the chamber empties", also=("discharge",))
    clearance: float = field(CLEARANCE_OR_NONE, _CLEARANCE, "c", example="0.05")
    exponent: float = _exponent("Exponent of compression and expansion", "1.4, air", AIR_EXPONENT)
    expansion_exponent: float | None = _exponent(
        "Exponent of the expansion", "that of the compression"
    )
    unloaded: bool = field(
        bool,
        "Whether the suction valves are held open, so that nothing is delivered; may also be given with `compressor`",
        default=False,
    )

    cycles: ClassVar[tuple[str, ...]] = ("two-stroke",)
    notes: ClassVar[tuple[str, ...]] = ()
    compresses: ClassVar[bool] = True

    @property
    def exponents(self) -> tuple[Number, ...]:
        """Those of compression and expansion."""
        return (self.exponent, self.of_expansion)

    def loaded(self) -> "Compressor":
        """Return the card with its valves at work."""
        if not self.unloaded:
            return self
        return replace(self, unloaded=False)

    def rules(self) -> Iterator[Rule]:
        yield _order("delivery", self.delivery, "suction", self.suction)

    @property
    def of_expansion(self) -> float:
        """Exponent of the expansion of what is left in the clearance."""
        if self.expansion_exponent is None:
            return self.exponent
        return self.expansion_exponent

    def rules_in(self, cycle: str, lift: Number) -> Iterator[Rule]:
        """Yield what does not fit the cycle or the absolute pressures; also a delivery that is never reached."""
        yield _only_two_stroke(self, cycle)
        yield from _above_vacuum(lift, suction=self.suction, delivery=self.delivery)
        # the pressures at the dead centre from which compression and expansion span the whole stroke
        c = self.clearance
        suction = self.suction + lift
        with np.errstate(all="ignore"):
            clearance = np.where(np.equal(c, 0), np.nan, c)
            top = after_polytrope(suction, 1 + c, clearance, self.exponent) - lift
            full = after_polytrope(suction, 1 + c, clearance, self.of_expansion) - lift
        message = (
            "delivery: the piston compresses to {top:pressure} only; "
            "such a compressor delivers nothing"
        )
        yield Rule((), self.delivery >= top, message, {"top": top})
        draws_nothing = (self.delivery < top) & (self.delivery >= full)
        message = (
            "expansion_exponent: what is left in the clearance fills the whole stroke; "
            "nothing is drawn in"
        )
        yield Rule((), draws_nothing, message)


class EngineCard(ChamberCard):
    """What the cards of combustion engines have in common, whatever pressure they have while the charge burns.

    exhaust: pressure of the exhaust stroke of a four-stroke cycle, None for that of the intake; a two-stroke engine
    changes its gas at the outer dead centre.
    """

    burns: ClassVar[bool] = True

    intake: float
    clearance: float
    exhaust: float | None
    exponent: float
    expansion_exponent: float
    diagram_factor: float

    @property
    def exponents(self) -> tuple[Number, ...]:
        """Those of compression and expansion."""
        return (self.exponent, self.expansion_exponent)

    @property
    def cycles(self) -> tuple[str, ...]:
        """Both; with an exhaust stroke the four-stroke cycle alone."""
        return ("two-stroke", "four-stroke") if self.exhaust is None else ("four-stroke",)

    @property
    def back_pressure(self) -> float:
        """Pressure in Pa of the exhaust stroke, about which a diagram factor lowers the card."""
        return self.intake if self.exhaust is None else self.exhaust

    @property
    def notes(self) -> tuple[str, ...]:
        """What the diagram factor leaves out."""
        return _factor_notes(self.diagram_factor)

    def rules_in(self, cycle: str, lift: Number) -> Iterator[Rule]:
        """Yield what does not fit the cycle or the absolute pressures."""
        has_no_exhaust_stroke = cycle != "four-stroke"
        message = (
            "exhaust: a two-stroke engine has no exhaust stroke; "
            "leave it out, or write 'cycle: four-stroke' at the top"
        )
        yield Rule((), has_no_exhaust_stroke and self.exhaust is not None, message)
        yield from _above_vacuum(lift, intake=self.intake, exhaust=self.exhaust)


# the fields of their records


def intake_field() -> FieldValue:
    """Return the field of the pressure when compression begins."""
    return _pressure("Pressure in the cylinder when compression begins, and while it fills")


def compression_ratio_key() -> Key:
    """Return the key that gives the clearance as the ratio of the volumes."""
    return alternative(
        "ratio",
        "Largest over smallest volume; or give `clearance`",
        "ε",
        least=1.00001,
        most=1e6,
        required=True,
        example="8",
        gives=lambda values: {"clearance": 1 / (values["compression_ratio"] - 1)},
    )


def clearance_field() -> FieldValue:
    """Return the field of the clearance, which a compression ratio may replace."""
    return field(
        CLEARANCE, f"{_CLEARANCE}; or give `compression_ratio`", "c", instead="compression_ratio"
    )


def exhaust_field() -> FieldValue:
    """Return the field of the pressure of the exhaust stroke."""
    return _pressure(
        "Pressure while the burnt gas leaves, in a four-stroke cycle", absent="that of the intake"
    )


def compression_exponent_field() -> FieldValue:
    """Return the field of the exponent of the compression, which is that of the expansion, too, unless that is given."""
    return _exponent(
        "Exponent of the compression",
        "1.4, air",
        AIR_EXPONENT,
        gives=lambda values: {
            "expansion_exponent": values.get("expansion_exponent", values["exponent"])
        },
    )


def expansion_exponent_field() -> FieldValue:
    """Return the field of the exponent of the expansion."""
    return _exponent("Exponent of the expansion", "that of the compression", AIR_EXPONENT)


class _Engine(EngineCard, StrokeCard, Record):
    """The card of a combustion engine whose largest pressure is given, or follows from its compression."""

    intake: float = intake_field()
    peak: float | None = _pressure(
        "Pressure of injection, reached at constant volume",
        absent="that at the end of compression",
        example="33 at",
        usual="30 to 35 at (R p. 610)",
    )
    _compression_ratio = compression_ratio_key()
    clearance: float = clearance_field()
    exhaust: float | None = exhaust_field()
    exponent: float = compression_exponent_field()
    expansion_exponent: float = expansion_exponent_field()
    diagram_factor: float = diagram_factor_field()

    def rules(self) -> Iterator[Rule]:
        if self.peak is not None:
            yield _order("peak", self.peak, "intake", self.intake)

    def rules_in(self, cycle: str, lift: Number) -> Iterator[Rule]:
        """Yield what does not fit the cycle or the absolute pressures; also a peak below the compression."""
        yield from super().rules_in(cycle, lift)
        if self.peak is None:
            return
        # the end of the compression
        c = self.clearance
        end = after_polytrope(self.intake + lift, 1 + c, c, self.exponent) - lift
        # as much as rounding of the clearance may take from a peak that is just that pressure
        is_below = self.peak < end - 1e-9 * abs(end)
        message = "peak: {peak:pressure} is below the end of the compression ({end:pressure})"
        yield Rule((), is_below, message, {"peak": self.peak, "end": end})


class Otto(_Engine):
    """An Otto engine: the pressure rises to its peak at the dead centre, at constant volume."""

    peak: float = _pressure(
        "Largest pressure, after combustion", example="25 at", usual="about 25 at (R p. 609)"
    )


class Diesel(_Engine):
    """A Diesel engine: injection at constant pressure up to the cut-off.

    peak: where it is given, the pressure first rises to it at constant volume (mixed cycle, Seiliger); None: the
    pressure of injection is that at the end of the compression.
    """

    cut_off: float = field(
        "ratio", "Fraction of the stroke at which injection ends", above=0, below=1, example="0.08"
    )


IdealCard = Union[Steam, Compressor, Otto, Diesel]
