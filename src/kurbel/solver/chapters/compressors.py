"""Stages of compressors: capacity, mass flow, temperature of delivery, isentropic power.

    η_v = 1 − ε₀ [(p_d/p_s)^(1/n) − 1]       end of a compressor with the clearance ε₀
    V̇ = η_v V_s n, m = p_s V̇/(R T₁)          capacity at suction, mass flow
    T₂ = T₁ (p_d/p_s)^((n − 1)/n)            temperature of delivery
    N_is = κ/(κ − 1) p_s V̇ [(p_d/p_s)^((κ − 1)/κ) − 1]

Pressures in the formulas are absolute.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from functools import cached_property
from typing import Any

import numpy as np

from kurbel.arrays import Number
from kurbel.errors import UsageError
from kurbel.machine.drawn_gas import Gas
from kurbel.machine.ideal_cards import Compressor
from kurbel.numerics.arithmetic import some, where
from kurbel.quantity import ValuesById, value
from kurbel.solver.chapters.driven_pistons import SAME_PRESSURE, DrivenPiston
from kurbel.solver.drive import Drive
from kurbel.solver.figures import Results

_NORMAL = 101325.0, 273.15
"""Pressure in Pa and temperature in K of normal conditions."""


class CompressorEnd:
    """One end of a compressor; figures: its key values in SI by id, those that there are, of many machines (machines,).

    suction, delivery: absolute pressures in Pa, None with a drawn card or a trace.
    """

    def __init__(self, drive: Drive, piston: DrivenPiston, end: str) -> None:
        gas = piston.gas
        name = gas.piston.name
        card = gas.piston.chambers[end]
        is_head = end == "head_end"
        area = gas.areas[0] if is_head else gas.areas[1]
        self.owner = drive.name if piston.number == 0 else f"{drive.name}, {name}"
        self.end = end.replace("_", " ")
        self.loaded = not (isinstance(card, Compressor) and card.unloaded)
        self.figures: ValuesById = {"stroke_volume": area * gas.stroke}
        self.suction: Any = None
        self.delivery: Any = None
        if not isinstance(card, Compressor):
            return
        # absolute pressures
        lift = 0.0 if gas.absolute else drive.machine.ambient
        self.suction = card.suction + lift
        self.delivery = card.delivery + lift
        # the properties of the piston's gas come before those of the machine's
        gases = [properties for properties in (gas.piston.gas, drive.machine.gas) if properties]
        # there are works of the ends that there are; a turn is a share of the cycle
        work = gas.works[0] if is_head or gas.head is None else gas.works[1]
        self._add_figures(card, gases, drive.machine.speed, -(work / gas.repeats))

    def _add_figures(
        self, card: Compressor, gases: Sequence[Gas], speed: Number | None, work: Number
    ) -> None:
        """Add what follows from the card, from the first gas that has what is needed, and from the speed."""
        figures = self.figures
        ratio = self.delivery / self.suction
        # η_v = 1 − ε₀ [(p_d/p_s)^(1/n) − 1], T₂ = T₁ (p_d/p_s)^((n − 1)/n)
        efficiency: Number = 0.0
        if self.loaded:
            efficiency = 1 - card.clearance * (ratio ** (1 / card.of_expansion) - 1)
            figures["volumetric_efficiency"] = efficiency
        if self.loaded and gases:
            n = card.exponent
            figures["discharge_temperature"] = gases[0].inlet_temperature * ratio ** ((n - 1) / n)
        if speed is None:
            return
        # V̇ = η_v V_s n
        capacity = efficiency * figures["stroke_volume"] * speed
        figures["capacity"] = capacity
        figures["stage_power"] = work * speed
        # m = p_s V̇/(R T₁), and the same mass at normal conditions
        if gases:
            density = self.suction / gases[0].inlet_temperature
            figures["capacity_normal"] = density * capacity * (_NORMAL[1] / _NORMAL[0])
            constants = [gas.gas_constant for gas in gases if gas.gas_constant is not None]
            if constants:
                figures["mass_flow"] = density * capacity / constants[0]
        # N_is = κ/(κ − 1) p_s V̇ [(p_d/p_s)^((κ − 1)/κ) − 1]
        kappas = [gas.isentropic_exponent for gas in gases if gas.isentropic_exponent is not None]
        if kappas:
            power = (kappas[0] - 1) / kappas[0]
            bracket = np.expm1(power * np.log(ratio)) / power
            figures["isentropic_power"] = self.suction * capacity * bracket


_OF_ALL_ENDS = (
    "stroke_volume",
    "capacity",
    "capacity_normal",
    "mass_flow",
    "stage_power",
    "isentropic_power",
)
_OF_LOADED_ENDS = ("volumetric_efficiency", "discharge_temperature")


class CompressorStage(Results):
    """The ends of a compressor that have suction and delivery pressure in common, or one piston with another card."""

    command = "delivery"

    stroke_volume = value("V_s", "volume", "Volume that the delivering chambers displace in a turn")
    volumetric_efficiency = value(
        "η_v",
        "ratio",
        "Volumetric efficiency of the ends that deliver",
        wanted_large=True,
        plain="eta_v",
    )
    capacity = value("V_1", "flow", "Capacity: volume flow as it is drawn in", wanted_large=True)
    capacity_normal = value(
        "V_N",
        "flow",
        "Volume flow at normal conditions: the ice point and 1 atm",
        wanted_large=True,
    )
    mass_flow = value("q_M", "mass_flow", "Mass flow", wanted_large=True)
    discharge_temperature = value("T_2", "temperature", "Temperature of what is delivered")
    stage_power = value("N_i,s", "power", "Indicated power that the stage takes")
    isentropic_power = value("N_is", "power", "Power of the compression without heat")
    isentropic_efficiency = value(
        "η_is", "ratio", "Isentropic over indicated power", wanted_large=True
    )

    def __init__(self, ends: Sequence[CompressorEnd]) -> None:
        self.name = self.part = ends[0].owner
        self.ends = tuple(ends)
        self.suction = ends[0].suction
        self.delivery = ends[0].delivery

    @cached_property
    def answers(self) -> ValuesById:
        """The key values; a stage all of whose ends are unloaded delivers nothing."""
        figures = [end.figures for end in self.ends]
        loaded = [end.figures for end in self.ends if end.loaded]
        # sums over all ends
        answers = ValuesById()
        for id in _OF_ALL_ENDS:
            if all(id in values for values in figures):
                answers[id] = sum(values[id] for values in figures)
        if not loaded:
            return answers
        # means over the volumes that the loaded ends displace
        stroke_volume = sum(values["stroke_volume"] for values in loaded)
        for id in _OF_LOADED_ENDS:
            if all(id in values for values in loaded):
                weighted = sum(values[id] * values["stroke_volume"] for values in loaded)
                answers[id] = weighted / stroke_volume
        # η_is where power is taken
        if "isentropic_power" in answers:
            takes_power = answers["stage_power"] > 0
            if some(takes_power):
                power = where(takes_power, answers["stage_power"], math.nan)
                answers["isentropic_efficiency"] = answers["isentropic_power"] / power
        return answers


def compressor_ends(drive: Drive, piston: DrivenPiston) -> Iterator[CompressorEnd]:
    """Yield the ends of a piston that compress, or have the card of a compressor."""
    for end, delivers in (
        ("head_end", piston.head_delivers),
        ("crank_end", piston.crank_delivers),
    ):
        if delivers or isinstance(piston.gas.piston.chambers.get(end), Compressor):
            yield CompressorEnd(drive, piston, end)


def staged(ends: Sequence[CompressorEnd]) -> tuple[CompressorStage, ...]:
    """Return the stages that ends of equal pressures make, the lowest suction first; those without any last.

    Raises UsageError for many machines whose stages are not alike: they are computed one by one.
    """
    # an end joins the first group with its pressures
    groups: list[list[CompressorEnd]] = []
    for end in ends:
        for group in groups:
            if _are_of_one_stage(group[0], end):
                group.append(end)
                break
        else:
            groups.append([end])
    stages = [CompressorStage(group) for group in groups]
    stages.sort(key=_suction_of)
    # stages with known pressures are numbered; all know their pistons
    number = 0
    for stage in stages:
        stage.part = _part_of(stage.ends, ends)
        if stage.suction is not None:
            number += 1
            stage.name = f"stage {number}"
    return tuple(stages)


def _suction_of(stage: CompressorStage) -> float:
    """Return the suction pressure of a stage in Pa, of many machines their mean; without one infinity."""
    if stage.suction is None:
        return math.inf
    return float(np.mean(stage.suction))


def _are_of_one_stage(end: CompressorEnd, other: CompressorEnd) -> bool:
    """Return whether two ends have suction and delivery pressure in common, or are of one piston without them."""
    if end.suction is None or other.suction is None:
        return end.suction is other.suction and end.owner == other.owner
    same_suction = np.abs(end.suction - other.suction) <= SAME_PRESSURE * np.abs(end.suction)
    same_delivery = np.abs(end.delivery - other.delivery) <= SAME_PRESSURE * np.abs(end.delivery)
    are_same = np.ravel(same_suction & same_delivery)
    if are_same.any() != are_same.all():
        raise UsageError("the stages of these machines are not alike")
    return bool(are_same.all())


def _part_of(of_stage: Sequence[CompressorEnd], ends: Sequence[CompressorEnd]) -> str:
    """Return the name of a stage by its pistons; by its ends, where a piston has others in another stage."""
    names: list[str] = []
    for end in of_stage:
        has_others = any(other.owner == end.owner and other not in of_stage for other in ends)
        names.append(f"{end.owner}, {end.end}" if has_others else end.owner)
    return " + ".join(dict.fromkeys(names))
