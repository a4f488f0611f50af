"""The ideal card of an engine that burns its charge over the crank angle by the function of Wiebe.

Angles count from the chamber's own (firing) dead centre.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, ClassVar, Literal

import numpy as np

from kurbel.arrays import Array, Number
from kurbel.declared.record import Record, Rule, alternative, field
from kurbel.machine.ideal_cards import (
    EngineCard,
    clearance_field,
    compression_exponent_field,
    compression_ratio_key,
    diagram_factor_field,
    exhaust_field,
    expansion_exponent_field,
    intake_field,
)

_MOST_HEAT = 1e9
"""Heat over the volume of a stroke in Pa: a hundred times what the densest charge of any engine burns."""


class Wiebe(EngineCard, Record):
    """An engine that burns by x_b = 1 − exp(−a ((θ − θ_s)/Δθ)^(m+1)), with polytropic compression and expansion.

    heat: in J per cycle, of the fuel; heat_ratio: κ in dQ = V dp/(κ − 1) + …, None for the exponent of the compression.
    """

    intake: float = intake_field()
    _compression_ratio = compression_ratio_key()
    clearance: float = clearance_field()
    exhaust: float | None = exhaust_field()
    heat: float = field(
        "energy", "Heat of the fuel per cycle in this chamber", "Q", least=0, example="1.5 kJ"
    )
    _fuel = alternative(
        "fuel",
        "Mass of fuel per cycle in this chamber, instead of `heat`",
        least=0,
        instead="heat",
        needs="heating_value",
        example="35 mg",
        gives=lambda values: {"heat": values["fuel"] * values["heating_value"]},
    )
    _heating_value = alternative(
        "heating_value",
        "Lower heating value of the fuel",
        "H_u",
        above=0,
        needs="fuel",
        usual="42.7 MJ/kg of diesel oil, 42 to 44 of petrol",
    )
    efficiency: float = field(
        "ratio",
        "Share of that heat that the combustion releases",
        default=1.0,
        above=0,
        most=1,
        example="0.95",
    )
    wall_loss: float = field(
        "ratio",
        "Share of the released heat that the walls take, while it is released",
        default=0.0,
        least=0,
        below=1,
        example="0.15",
    )
    start: float = field(
        "angle",
        "Angle from the firing dead centre at which heat begins to be released",
        "θ_s",
        least=-180,
        most=180,
        example="-10 deg",
    )
    duration: float = field(
        "angle", "Duration of the heat release", "Δθ", least=0.1, most=360, example="40 deg"
    )
    shape: float = field(
        "ratio",
        "Factor a of the function: with the duration 1 − e^−a of the heat is released",
        "a",
        default=5.0,
        above=0,
        most=100,
        example="6.9",
        usual="5, of 99.3 %, to 6.9, of 99.9 %",
    )
    form_exponent: float = field(
        "ratio",
        "Exponent of the function, Wiebe's m plus 1",
        "m+1",
        default=3.0,
        least=1,
        most=20,
        example="2.5",
        usual="3; 1.5 to 2.5 of Diesel engines",
    )
    runs_on: bool = field(
        bool,
        "Whether the function runs on after the duration, up to the outer dead centre; else the release ends with it",
        default=False,
    )
    exponent: float = compression_exponent_field()
    expansion_exponent: float = expansion_exponent_field()
    heat_ratio: float | None = field(
        "ratio",
        "Ratio of the specific heats of the charge, by which heat raises the pressure",
        "κ",
        above=1,
        most=10,
        absent="exponent of the compression",
        example="1.35",
    )
    diagram_factor: float = diagram_factor_field()

    by_stroke: ClassVar[Literal[False]] = False

    @property
    def kappa(self) -> float:
        """Ratio of the specific heats κ."""
        return self.exponent if self.heat_ratio is None else self.heat_ratio

    @property
    def heat_to_gas(self) -> float:
        """Heat in J per cycle that the gas would take if the function ended at 1."""
        return self.heat * self.efficiency * (1 - self.wall_loss)

    def burnt(self, after: Array, expansion: Number) -> Any:
        """Return 1 − exp(−a s^(m+1)) at degrees after the dead centre, s = (θ − θ_s)/Δθ; expansion: degrees of its stroke."""
        end = np.asarray(expansion) if self.runs_on else self.start + self.duration
        passed = np.minimum(after, end) - self.start
        share = np.maximum(passed / self.duration, 0.0)
        return -np.expm1(-self.shape * share**self.form_exponent)

    def angle_at(self, burnt: Number) -> Any:
        """Return the degrees after the dead centre at which 1 − exp(−a s^(m+1)) is so much."""
        share = (-np.log1p(-np.asarray(burnt)) / self.shape) ** (1 / self.form_exponent)
        return self.start + self.duration * share

    def rules(self) -> Iterator[Rule]:
        message = (
            "'heat_ratio' is missing: the exponent of the compression ({exponent}) is no ratio of specific heats, "
            "which is above 1"
        )
        yield Rule("exponent", (self.heat_ratio is None) & np.less_equal(self.exponent, 1), message)

    def rules_of_strokes(
        self, compression: Number, expansion: Number, volume: Number
    ) -> Iterator[Rule]:
        """Yield heat before the compression or after the expansion, and more than any charge holds."""
        message = (
            "heat begins at {start:angle}, before the compression, "
            "which takes {compression:angle} up to the dead centre"
        )
        numbers = {"start": self.start, "compression": compression, "expansion": expansion}
        yield Rule(("wiebe", "start"), self.start < -compression, message, numbers)
        # the end of the expansion
        is_late = self.start >= expansion
        message = (
            "heat begins at {start:angle}, after the expansion, which ends at {expansion:angle}"
        )
        yield Rule(("wiebe", "start"), is_late, message, numbers)
        end = self.start + self.duration
        is_long = np.logical_not(is_late) & (end > expansion) & (not self.runs_on)
        message = (
            "heat is released until {end:angle}, but the expansion ends at {expansion:angle}; "
            "shorten it, or write 'runs_on: true'"
        )
        yield Rule(("wiebe", "duration"), is_long, message, {**numbers, "end": end})
        # a slip of the unit
        mean = self.heat / volume
        message = "{heat:energy} in a stroke volume of {volume:volume} is more than any charge holds; is the unit right?"
        numbers = {"heat": self.heat, "volume": volume}
        yield Rule(("wiebe", "heat"), mean > _MOST_HEAT, message, numbers)
