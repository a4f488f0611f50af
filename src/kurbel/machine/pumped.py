"""What pumps and compressors move: the gas of a compressor, and liquid, pipes and air vessels of a pump.

A liquid of the bulk modulus K loses the share x = Δp/K of its volume at suction pressure. In a chamber with the
clearance c over the stroke volume the delivery valve opens where that is lost, and the suction valve where what stays in
the clearance has expanded again, at the fractions of the stroke

    z_d = 1 − (1 + c) x      z_s = c x/(1 − x)      from the chamber's smallest volume
"""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from kurbel.declared.record import Record, Rule, field
from kurbel.machine.indicator import Card, CardLine, Chamber
from kurbel.machine.parts import Piston

WATER = 1000.0, 2339.0
"""Density in kg/m³ of water, and its vapour pressure in Pa at 20 °C."""


class Liquid(Record):
    """What a pump moves."""

    density: float = field(
        "density", "Density", "ρ", default=WATER[0], above=0, absent="1000 kg/m³, water"
    )
    vapour_pressure: float | None = field(
        "pressure",
        "Absolute pressure at which the liquid boils",
        least=0,
        absent="23.4 mbar, water at 20 °C",
        example="23.4 mbar",
    )
    bulk_modulus: float | None = field(
        "stress",
        "Bulk modulus of the liquid, the rise of pressure over the share of its volume that is lost: valves open late",
        "K",
        above=0,
        absent="incompressible",
        example="2.2 GPa",
    )

    @property
    def boiling_pressure(self) -> float:
        """Its vapour pressure in Pa, by default that of cold water."""
        return WATER[1] if self.vapour_pressure is None else self.vapour_pressure

    def opening_fractions(self, card: object) -> tuple[Any, Any] | None:
        """Return the fractions of the stroke at which suction and delivery valve of a chamber open, z_s and z_d.

        None of a chamber that has not one pressure on each stroke, and of an incompressible liquid.
        """
        if self.bulk_modulus is None or not isinstance(card, Card):
            return None
        if len(card.lines) != 2 or not card.flat:
            return None
        outward, back = card.lines
        # a chamber that is always open to a pipe, or drives, compresses nothing
        rise = np.maximum(back.pressures[0] - outward.pressures[0], 0.0)
        lost: Any = rise / self.bulk_modulus
        c = 0.0 if card.clearance is None else card.clearance
        # if it is compressed over the whole stroke, neither valve opens: z_s = 1
        rest = np.maximum(np.maximum(1 - lost, c * lost), np.finfo(float).tiny)
        return c * lost / rest, 1 - (1 + c) * lost

    def compressed(self, piston: Piston) -> Piston:
        """Return a piston with cards in which this liquid is compressed before it leaves, and expands again."""
        indicator = piston.indicator
        if indicator is None or self.bulk_modulus is None:
            return piston
        head_end = self._compressed_card(indicator.head_end)
        crank_end = head_end
        if indicator.crank_end is not indicator.head_end:
            crank_end = self._compressed_card(indicator.crank_end)
        return replace(piston, indicator=replace(indicator, head_end=head_end, crank_end=crank_end))

    def _compressed_card(self, card: Chamber | None) -> Chamber | None:
        """Return a card with the straight lines on which this liquid changes its pressure."""
        fractions = self.opening_fractions(card)
        if fractions is None:
            return card
        assert isinstance(card, Card)
        suction_opens, delivery_opens = fractions
        suction = card.lines[0].pressures[0]
        delivery = card.lines[1].pressures[0]
        outward = CardLine(
            "expansion", (0.0, suction_opens, 1.0), (delivery, suction, suction), start=0
        )
        back = CardLine(
            "compression", (1.0, delivery_opens, 0.0), (suction, delivery, delivery), start=1
        )
        return replace(card, lines=(outward, back))


class Vessel(Record):
    """An air vessel; its volume of air, or the swing of pressure for which its volume is wanted."""

    volume: float | None = field("volume", "Mean volume of its air", "V", above=0, example="20 l")
    pressure_swing: float | None = field(
        "ratio",
        "Wanted swing of its absolute pressure, (p_max − p_min)/p_mean",
        "δ",
        above=0,
        below=2,
        instead="volume",
        example="5 %",
    )
    exponent: float | None = field(
        "ratio",
        "Exponent of p V^n of its air",
        "n",
        least=0.5,
        most=2,
        absent="1, isothermal",
        example="1.2",
    )

    @property
    def air_exponent(self) -> float:
        """Its exponent n, by default that of isothermal air."""
        return 1.0 if self.exponent is None else self.exponent

    def rules(self) -> Iterator[Rule]:
        is_empty = self.volume is None and self.pressure_swing is None
        message = "give the 'volume' of the vessel, or the 'pressure_swing' that it may have"
        yield Rule((), is_empty, message)


class Pipe(Record):
    """A pipe with all chambers of the pump on it."""

    length: float = field("length", "Length of the pipe", "l", above=0, example="12 m")
    diameter: float = field("length", "Bore of the pipe", "d", above=0, example="100 mm")
    lift: float | None = field(
        "length", "Height that the pipe lifts the liquid", "h", least=0, absent="not compared"
    )
    friction_factor: float = field(
        "ratio",
        "Friction factor of the pipe (Darcy)",
        "f",
        default=0.0,
        least=0,
        most=1,
        absent="0, no friction",
        example="0.03",
    )
    vessel: Vessel | None = field(Vessel, "Air vessel between pipe and pump", absent="none")


class SuctionPipe(Pipe):
    """The pipe to a pump, from a level below or above it."""

    lift: float | None = field(
        "length",
        "Height that the pipe lifts the liquid to the pump; negative where it flows in from above",
        "h",
        absent="not compared, no NPSH",
        example="-2 m",
    )
    pressure: float | None = field(
        "pressure",
        "Absolute pressure on the liquid where the pipe begins, as in a closed tank or behind a booster pump",
        "p_0",
        least=0,
        absent="the ambient pressure",
        example="1.8 bar",
        also=("suction_pressure", "tank_pressure", "surface_pressure"),
    )


class Pump(Record):
    """What a pump's flow depends on besides its pistons."""

    slip: float = field(
        "ratio",
        "Share of the displaced volume that is not delivered",
        default=0.0,
        least=0,
        below=1,
        example="0.03",
    )
    liquid: Liquid = field(Liquid, "What is pumped", default=Liquid(), absent="water")
    suction_pipe: SuctionPipe | None = field(
        SuctionPipe, "Pipe to the pump", absent="suction lift and NPSH left out"
    )
    delivery_pipe: Pipe | None = field(Pipe, "Pipe from the pump", absent="left out")

    def rules_of(self, pistons: Sequence[Piston]) -> Iterator[Rule]:
        """Yield whether the liquid of a chamber is compressed over the whole stroke, so that nothing is delivered."""
        for piston in pistons:
            for card in piston.chambers.values():
                fractions = self.liquid.opening_fractions(card)
                if fractions is None:
                    continue
                message = (
                    "with {K:stress} the liquid is compressed over the whole stroke of '{name}', "
                    "and nothing is delivered"
                )
                numbers = {"K": self.liquid.bulk_modulus, "name": piston.name}
                if card.clearance is not None:
                    message = f"{message}; the clearance is {{c}} times the stroke volume"
                    numbers["c"] = card.clearance
                path = ("pump", "liquid", "bulk_modulus")
                yield Rule(path, fractions[1] <= 0, message, numbers)
