"""What pumps and compressors deliver: flow over the angle, air vessels and pipes; capacities, temperatures, stages.

    q(φ) = (1 − slip) Σ A |dx/dt|            over the chambers that shrink; where they grow it is drawn in
    ΔV = swing of ∫ (q − q_m) dt             the fluctuating volume, found as ΔE of the turning effort is
    V = ΔV (r + 1)/(2 (r − 1))               air vessel; r = V_max/V_min = ((2 + δ)/(2 − δ))^(1/n), V = ΔV/δ for n = 1
    h_a = l/(g a) dq/dt, h_f = f l u²/(2 g d)    heads in a pipe of the section a, u = q/a; behind a vessel q is q_m
    η_v = 1 − ε₀ [(p_d/p_s)^(1/n) − 1]       end of a compressor with the clearance ε₀
    V̇ = η_v V_s n, m = p_s V̇/(R T₁)          capacity at suction, mass flow
    T₂ = T₁ (p_d/p_s)^((n − 1)/n)            temperature of delivery
    N_is = κ/(κ − 1) p_s V̇ [(p_d/p_s)^((κ − 1)/κ) − 1]
    A_W = 1 − A_R,m/A_R,0                    share of the work against pipe friction that vessels save

Pressures in the formulas are absolute. The flow is sampled on the pieces of the cycle, which are cut at dead centres,
where the valves change.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from copy import copy
from functools import cache, cached_property, partial
from typing import Any, NamedTuple

import numpy as np

from kurbel.arrays import Array, Number, Truth
from kurbel.declared.unit_systems import show
from kurbel.declared.units import GRAVITY
from kurbel.errors import UsageError
from kurbel.machine import Machine
from kurbel.machine.ideal_cards import Compressor
from kurbel.machine.indicator import Card, Chamber, Rectangle
from kurbel.machine.pumped import Gas, Pipe, Pump, Vessel
from kurbel.numerics.arithmetic import every, some, total, unless_cancelled, where
from kurbel.numerics.extreme import Extremes
from kurbel.numerics.pieces import Pieces
from kurbel.quantity import ValuesById, value, values_for
from kurbel.solver.drive import Drive
from kurbel.solver.effort import TurningEffort, position
from kurbel.solver.figures import AtAngles, ExtremesOfColumns, Results, result
from kurbel.solver.gas import PistonGas
from kurbel.solver.state import State

_NORMAL = 101325.0, 273.15
"""Pressure in Pa and temperature in K of normal conditions."""
_CANCELLED = 4e-14
"""Relative to its largest value: a smaller flow is rounding."""

# pistons that deliver


class DrivenPiston(NamedTuple):
    """A driven piston: its number among those of the cylinder, its pressures, and which of its ends deliver."""

    number: int
    gas: PistonGas
    head: bool
    crank: bool
    pumps: bool


def driven_pistons(drive: Drive) -> Iterator[DrivenPiston]:
    """Yield the pistons of a cylinder that are driven by it; raises UsageError where many machines differ in that."""
    for gas in drive.gas:
        chambers = list(gas.piston.chambers.values())
        ideal = any(isinstance(chamber, Compressor) for chamber in chambers)
        if _agreed(gas.work < 0) or (ideal and not _agreed(gas.work > 0)):
            number = drive.cylinder.pistons.index(gas.piston)
            works = iter(gas.works)
            head, crank = (
                end is not None and _agreed(next(works) < 0) for end in (gas.head, gas.crank)
            )
            pumps = not ideal and (drive.machine.pump is not None or all(map(_is_level, chambers)))
            yield DrivenPiston(number, gas, head, crank, pumps)


def _agreed(condition: Truth) -> bool:
    if some(condition) and not every(condition):
        raise UsageError("these machines differ in what is driven")
    return bool(every(condition))


def _is_level(chamber: Chamber | None) -> bool:
    """Return whether a chamber has one pressure on each stroke, as a pump's has."""
    if isinstance(chamber, Card):
        return all(
            np.array_equal(pressure, line.pressures[0])
            for line in chamber.lines
            for pressure in line.pressures
        )
    return isinstance(chamber, Rectangle) and not some(chamber.mean != 0)


def _displaced(
    state: State,
    piston: DrivenPiston,
    draws: bool = False,
    rises: bool = False,
    head: bool = True,
    crank: bool = True,
) -> Array:
    """Return dV/dφ in m³ of what chambers deliver, or draw in; rises: d²V/dφ². On each stroke it is one of them.

    head, crank: whether that end counts.
    """
    own = state.drive.cylinder.pistons[
        piston.number
    ]  # of many machines its numbers are those of the angles
    areas = own.head_area * (piston.head and head), own.crank_area * (piston.crank and crank)
    # a piston that a lever moves against the crosshead draws in where another one delivers
    outward, back = (
        abs(own.lever_ratio) * area
        for area in (areas if draws != piston.gas.turned else areas[::-1])
    )
    return np.where(state.direction > 0, outward, -back) * np.asarray(
        state.curvature if rises else state.slope
    )


# pumps


class DeliveryState(AtAngles):
    """The flow of a pump at crank angles φ (n,) in degrees, on the sides of jumps that hold `within`."""

    commands = ("delivery",)
    flow_head = value("q_H", "flow", "Flow delivered at the head end")
    flow_crank = value("q_C", "flow", "Flow delivered at the crank end")
    flow = value("q", "flow", "Flow delivered", called="flow", extremes=("delivery",))
    flow_suction = value("q_s", "flow", "Flow drawn in")
    acceleration_head = value(
        "h_a",
        "length",
        "Head that the suction pipe takes to accelerate the liquid",
        called="acceleration head of the suction pipe",
        extremes=("delivery",),
    )
    friction_head = value("h_f", "length", "Head of friction in the suction pipe")
    delivery_acceleration_head = value(
        "h_a,d",
        "length",
        "Head that the delivery pipe takes to accelerate the liquid",
        called="acceleration head of the delivery pipe",
        extremes=("delivery",),
    )
    delivery_friction_head = value("h_f,d", "length", "Head of friction in the delivery pipe")

    def __init__(self, delivery: Delivery, phi: Array, within: Array) -> None:
        self._delivery, self.phi, self._within = delivery, phi, within

    @cached_property
    def answers(self) -> dict[str, Array]:
        """The columns (n,) that there are."""
        pieces, machine = self._delivery.pieces, np.zeros(len(self.phi), dtype=np.intp)
        found = dict[str, Array]()
        for id, values in self._delivery.sampled.items():
            at = pieces.at(values, machine, self.phi, self._within)
            found[id] = np.asarray(unless_cancelled(at, pieces.largest(values)[0], _CANCELLED))
        return found


_PIPES = {"": ("", "delivery"), "suction_": ("s,", "suction")}
_WORKS = {
    "": ("R", "as they are"),
    "_bare": ("R,0", "without vessels"),
    "_steady": ("R,m", "with vessels at both"),
}
_PIPE_WORKS = tuple(f"pipe_work{state}" for state in _WORKS)


class Delivery(Results):
    """What one pumping piston, or all of a machine, deliver; key values in SI, of many machines (machines,).

    pieces: of the cycle in degrees; rate: takes the words of `_displaced` and returns dV/dφ in m³ per radian at their
    nodes; both: whether both ends of one piston deliver; pump: its pipes, None for one piston of several. Raises
    UsageError for a vessel that would empty.
    """

    command, state = "delivery", DeliveryState

    stroke_volume = value("V_s", "volume", "Volume that the delivering chambers displace in a turn")
    flow_mean = value("q_m", "flow", "Mean flow delivered", wanted_large=True)
    extremes = ExtremesOfColumns()
    volume_fluctuation = value(
        "ΔV", "volume", "Fluctuating volume: swing of what is delivered above the mean flow"
    )
    vessel_volume = values_for(
        _PIPES, "*vessel_volume", "V_*W", "volume", "Mean volume of air in the * vessel"
    )
    vessel_swing = values_for(
        _PIPES,
        "*vessel_swing",
        "δ_*W",
        "ratio",
        "Swing of the absolute pressure in the * vessel, over its mean",
    )
    suction_lift_max = value(
        "h_s",
        "length",
        "Largest suction lift: barometer less vapour pressure and heads",
        wanted_large=True,
    )
    pipe_work = values_for(
        _WORKS, "pipe_work*", "A_*", "energy", "Work against friction in the pipes per cycle, *"
    )
    vessel_saving = value(
        "A_W", "ratio", "Share of the work against pipe friction that vessels at all pipes save"
    )

    def __init__(
        self,
        name: str,
        machine: Machine,
        pieces: Pieces,
        count: int | None,
        rate: Callable[..., Array],
        both: bool,
        pump: Pump | None = None,
    ) -> None:
        self.name, self.machine, self.pieces, self.pump = name, machine, pieces, pump
        self._rate, self._both = cache(rate), both
        both_pipes = ((pump.suction_pipe, True), (pump.delivery_pipe, False)) if pump else ()
        self._pipes = [(pipe, draws) for pipe, draws in both_pipes if pipe]
        self._result = partial(result, count=count)
        self.omega: Any = None if machine.speed is None else 2 * math.pi * machine.speed
        self.breaks = pieces.ends
        if count is None:
            _ = self.answers  # refuses a vessel that would empty

    def _columns(self, phi: Array, within: Array) -> DeliveryState:
        return DeliveryState(self, phi, within)

    @cached_property
    def sampled(self) -> dict[str, Array]:
        """The columns that there are, at the nodes of the pieces; none without a speed."""
        if self.omega is None:
            return {}
        omega, of = self.pieces.of(self.omega), self.pieces.of
        found = {"flow": self._rate() * omega, "flow_suction": self._rate(draws=True) * omega}
        if self._both:
            found["flow_head"], found["flow_crank"] = (
                self._rate(crank=False) * omega,
                self._rate(head=False) * omega,
            )
        for pipe, draws in self._pipes:
            name = "" if draws else "delivery_"
            if pipe.vessel is None:
                scale = of(pipe.length / (GRAVITY * _section(pipe)))
                found[f"{name}acceleration_head"] = (
                    self._rate(draws=draws, rises=True) * omega**2 * scale
                )
            passed = of(self._mean(draws)) if pipe.vessel else self._rate(draws=draws)
            heads = of(_friction(pipe) / GRAVITY) * (passed * omega) ** 2
            found[f"{name}friction_head"] = self.pieces.filled(heads)
        return found

    def _mean(self, draws: bool = False, cubed: bool = False) -> Number:
        """Return the mean over the cycle of dV/dφ, or of its cube."""
        rate = self._rate(draws=draws)
        return self._result(self.pieces.mean(rate * rate * rate if cubed else rate))  # ** 3 is slow

    def _swing(self, draws: bool) -> Number:
        """Return the fluctuating volume in m³ of a flow, with all its crossings of the mean."""
        rate = self._rate(draws=draws)
        above = self.pieces.running(rate - self.pieces.of(self.pieces.mean(rate)))[None]
        high, _, low, _ = self.pieces.extremes(above, self.pieces.integral(rate)[None])
        return self._result((high - low)[0])

    def extremes_of(self, column: str) -> Extremes | None:
        """Return the extremes in SI of a column that is declared to have them; None for one that is left out."""
        return self._extremes.get(column)

    @cached_property
    def _extremes(self) -> dict[str, Extremes]:
        declared = {id for id, row in self.rows.columns.items() if row.quantity.extremes}
        found = {id: values for id, values in self.sampled.items() if id in declared}
        return (
            dict(zip(found, self.pieces.extremes([*found.values()]).each(self._result)))
            if found
            else {}
        )

    @cached_property
    def answers(self) -> ValuesById:
        """The key values that are no extremes."""
        found, mean = ValuesById(), self._mean()
        slip = self.machine.pump.slip if self.machine.pump else 0.0
        found["stroke_volume"] = 2 * math.pi * mean / (1 - slip)
        found["volume_fluctuation"] = swing = self._swing(draws=False)
        found["vessel_saving"] = self._saving(mean)
        for pipe, draws in self._pipes:
            if pipe.vessel and draws:
                sizes = _vessel(pipe.vessel, self._swing(draws=True), "suction")
                found["suction_vessel_volume"], found["suction_vessel_swing"] = sizes
            elif pipe.vessel:
                found["vessel_volume"], found["vessel_swing"] = _vessel(
                    pipe.vessel, swing, "delivery"
                )
        if self.omega is None:
            return found

        found["flow_mean"] = mean * self.omega
        if self._pipes:
            for id, work in zip(_PIPE_WORKS, self._works_of_pipes):
                found[id] = work * self.omega**2
        if self.pump and self.pump.suction_pipe:
            liquid, heads = self.pump.liquid, self.sampled["friction_head"]
            if "acceleration_head" in self.sampled:
                heads = heads + self.sampled["acceleration_head"]
            most = self._result(self.pieces.extremes(heads[None]).largest[0])
            static = (self.machine.ambient - liquid.vapour_pressure) / (liquid.density * GRAVITY)
            found["suction_lift_max"] = static - most
        return found

    def _saving(self, mean: Number) -> Number:
        """Return the share of the work against friction that vessels at all pipes save: 1 − A_R,m/A_R,0.

        Without pipes it is that of one for the flow delivered, of which the mean per radian is given in m³.
        """
        of_flow_alone = 1 - mean**3 / self._mean(cubed=True)
        if not self._pipes:
            return of_flow_alone
        _, bare, steady = self._works_of_pipes
        rubs = bare > 0
        return where(rubs, 1 - steady / where(rubs, bare, 1.0), of_flow_alone)

    @cached_property
    def _works_of_pipes(self) -> tuple[Number, ...]:
        """Works over ω² per cycle against friction in all pipes: as they are, without vessels, with one at each."""
        works = [self._works_of(pipe, draws) for pipe, draws in self._pipes]
        return tuple(total(*terms) for terms in zip(*works))

    def _works_of(self, pipe: Pipe, draws: bool) -> tuple[Number, Number, Number]:
        """Return the works over ω² against friction in a pipe: as it is, without a vessel, and with one."""
        assert self.pump is not None
        scale = self.pump.liquid.density * _friction(pipe) * math.radians(self.pieces.cycle)
        bare = scale * self._mean(draws, cubed=True)
        steady = scale * self._mean(draws) ** 3
        as_it_is = steady if pipe.vessel else bare
        return as_it_is, bare, steady


def _section(pipe: Pipe) -> Number:
    return math.pi / 4 * pipe.diameter**2


def _friction(pipe: Pipe) -> Number:
    """Return f l/(2 d a²) in 1/m⁴, which times ρ q² is the loss of pressure."""
    return pipe.friction_factor * pipe.length / (2 * pipe.diameter * _section(pipe) ** 2)


def _vessel(vessel: Vessel, swing: Number, place: str) -> tuple[Number, Number]:
    """Return mean volume in m³ and swing of pressure of a vessel that takes a fluctuating volume in m³."""
    if vessel.pressure_swing is not None:
        delta = vessel.pressure_swing
        ratio = ((2 + delta) / (2 - delta)) ** (1 / vessel.exponent)
        return swing * (ratio + 1) / (2 * (ratio - 1)), delta
    volume: Any = vessel.volume
    half = swing / 2
    empties = volume <= half
    if isinstance(empties, (bool, np.bool_)) and empties:
        least, given = show(float(half), "volume"), show(volume, "volume")
        raise UsageError(
            f"pump.{place}_pipe.vessel.volume: {given} would empty; it must be more than ΔV/2 = {least}"
        )
    ratio = (
        where(empties, math.nan, (volume + half) / where(empties, 1.0, volume - half))
        ** vessel.exponent
    )
    return where(empties, math.nan, volume), 2 * (ratio - 1) / (ratio + 1)


# compressors


class CompressorEnd:
    """One end of a compressor; figures: its key values in SI by id, those that there are, of many machines (machines,).

    suction, delivery: absolute pressures in Pa, None with a drawn card or a trace.
    """

    def __init__(self, drive: Drive, piston: DrivenPiston, end: str) -> None:
        self.suction: Any = None
        self.delivery: Any = None
        own, gas = piston.gas.piston, piston.gas
        card, head = own.chambers[end], end == "head_end"
        self.owner = drive.name if piston.number == 0 else f"{drive.name}, {own.name}"
        self.end = end.replace("_", " ")
        self.loaded = not (isinstance(card, Compressor) and card.unloaded)
        self.figures: ValuesById = {"stroke_volume": gas.areas[0 if head else 1] * gas.stroke}
        if isinstance(card, Compressor):
            lift = 0.0 if gas.absolute else drive.machine.ambient
            self.suction, self.delivery = card.suction + lift, card.delivery + lift
            gases = [one for one in (own.gas, drive.machine.gas) if one]
            work = gas.works[0 if head or gas.head is None else 1] / gas.repeats
            self._add_figures(card, gases, drive.machine.speed, -work)

    def _add_figures(
        self, card: Compressor, gases: Sequence[Gas], speed: Number | None, work: Number
    ) -> None:
        """Add what follows from the card, from the first gas that has what is needed, and from the speed."""
        found, ratio, n = self.figures, self.delivery / self.suction, card.exponent
        if self.loaded:
            found["volumetric_efficiency"] = 1 - card.clearance * (
                ratio ** (1 / card.of_expansion) - 1
            )
            if gases:
                found["discharge_temperature"] = gases[0].inlet_temperature * ratio ** ((n - 1) / n)
        if speed is None:
            return
        capacity = found.get("volumetric_efficiency", 0.0) * found["stroke_volume"] * speed
        found["capacity"], found["stage_power"] = capacity, work * speed
        if gases:
            density = self.suction / gases[0].inlet_temperature
            found["capacity_normal"] = density * capacity * (_NORMAL[1] / _NORMAL[0])
            constants = [gase.gas_constant for gase in gases if gase.gas_constant is not None]
            if constants:
                found["mass_flow"] = density * capacity / constants[0]
        kappas = [
            gase.isentropic_exponent for gase in gases if gase.isentropic_exponent is not None
        ]
        if kappas:
            power = (kappas[0] - 1) / kappas[0]
            head = np.expm1(power * np.log(ratio)) / power
            found["isentropic_power"] = self.suction * capacity * head


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
        "V_N", "flow", "Volume flow at normal conditions, 0 °C and 1.01325 bar", wanted_large=True
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
        self.suction, self.delivery = ends[0].suction, ends[0].delivery

    @cached_property
    def answers(self) -> ValuesById:
        """The key values; a stage all of whose ends are unloaded delivers nothing."""
        every = [end.figures for end in self.ends]
        loaded = [end.figures for end in self.ends if end.loaded]
        found = {
            id: sum(one[id] for one in every)
            for id in _OF_ALL_ENDS
            if all(id in one for one in every)
        }
        for id in _OF_LOADED_ENDS:  # means
            if loaded and all(id in one for one in loaded):
                swept = sum(one["stroke_volume"] for one in loaded)
                found[id] = sum(one[id] * one["stroke_volume"] for one in loaded) / swept
        if loaded and "isentropic_power" in found and some(found["stage_power"] > 0):
            taken = where(found["stage_power"] > 0, found["stage_power"], math.nan)
            found["isentropic_efficiency"] = found["isentropic_power"] / taken
        return found


# the machine


class MachineDelivery:
    """All that a machine delivers: `pump`, of all its pumping pistons together, None without any; `pistons`, each of
    several; `stages`, those of its compressors, the lowest suction pressure first.

    Raises UsageError where nothing is delivered.
    """

    def __init__(self, effort: TurningEffort) -> None:
        self.machine, self.effort, self._count = effort.machine, effort, effort.count
        driven = [(forces, list(driven_pistons(forces.drive))) for forces in effort.cylinders]
        self._pumps = [
            (forces, piston) for forces, pistons in driven for piston in pistons if piston.pumps
        ]
        ends = [
            CompressorEnd(forces.drive, piston, end)
            for forces, pistons in driven
            for piston in pistons
            for end, works in (("head_end", piston.head), ("crank_end", piston.crank))
            if not piston.pumps
            and (works or isinstance(piston.gas.piston.chambers.get(end), Compressor))
        ]
        self.stages: tuple[CompressorStage, ...] = _staged(ends)
        if not (self._pumps or self.stages):
            raise UsageError(
                f"{self.machine.name} delivers nothing: no piston is driven by the shaft; a pump has a 'constant' "
                "pressure on each stroke, the higher one on compression, a compressor has 'compressor: {…}'"
            )

    @cached_property
    def pump(self) -> Delivery | None:
        """What all pumping pistons deliver together, over the angle of crank 1."""
        if not self._pumps:
            return None
        pieces = self.effort.pieces
        states = {
            id(forces): State.on(forces.drive, pieces.by_crank(position(forces)))
            for forces, _ in self._pumps
        }
        rate = self._rate_of(pieces, [(states[id(forces)], one) for forces, one in self._pumps])
        both = len(self._pumps) == 1 and self._pumps[0][1].head and self._pumps[0][1].crank
        return Delivery(
            "whole machine", self.machine, pieces, self._count, rate, both, self.machine.pump
        )

    @cached_property
    def pistons(self) -> tuple[Delivery, ...]:
        """What each of several pumping pistons delivers, over the angle of its own crank; equal ones once."""
        found = list[Delivery]()
        firsts = {id(forces): group[0] for group in self.effort.groups for forces in group}
        known: dict[tuple[int, int], Delivery] = {}
        for forces, one in self._pumps if len(self._pumps) > 1 else ():
            first, name = firsts[id(forces)], forces.drive.name
            alike = id(first), one.number
            if alike not in known:
                rate = self._rate_of(first.pieces, [(first.samples, one)])
                made = Delivery(
                    "", self.machine, first.pieces, self._count, rate, one.head and one.crank
                )
                _ = made.answers, made.extremes_of("flow")  # once for all copies
                known[alike] = made
            found.append(copy(known[alike]))
            found[-1].name = name if one.number == 0 else f"{name}, {one.gas.piston.name}"
        return tuple(found)

    def _rate_of(
        self, pieces: Pieces, pistons: Sequence[tuple[State, DrivenPiston]]
    ) -> Callable[..., Array]:
        """Return what returns dV/dφ of these pistons together, less the slip; it takes the words of `_displaced`."""
        share = 1 - (self.machine.pump.slip if self.machine.pump else 0.0)

        def rate(**how: bool) -> Array:
            each = [pieces.of(share) * _displaced(state, one, **how) for state, one in pistons]
            whole = pieces.filled(sum(each))
            lasting = (
                unless_cancelled(pieces.largest(whole), sum(map(pieces.largest, each)), _CANCELLED)
                != 0
            )
            return np.where(pieces.of(lasting), whole, 0.0)

        return rate


def _staged(ends: Sequence[CompressorEnd]) -> tuple[CompressorStage, ...]:
    """Return the stages that ends of equal pressures make, the lowest suction first; those without any last.

    Raises UsageError for many machines whose stages are not alike: they are computed one by one.
    """
    groups: list[list[CompressorEnd]] = []
    for end in ends:
        group = next((group for group in groups if _are_of_one_stage(group[0], end)), None)
        if group is None:
            groups.append([end])
        else:
            group.append(end)
    stages = [CompressorStage(group) for group in groups]
    stages.sort(key=lambda one: math.inf if one.suction is None else float(np.mean(one.suction)))
    for number, stage in enumerate((one for one in stages if one.suction is not None), 1):
        stage.name = f"stage {number}"
    for stage in stages:
        stage.part = _part_of(stage.ends, ends)
    return tuple(stages)


_SAME_PRESSURE = 1e-9
"""Relative difference of pressures that are equal but for rounding."""


def _are_of_one_stage(end: CompressorEnd, other: CompressorEnd) -> bool:
    """Return whether two ends have suction and delivery pressure in common, or are of one piston without them."""
    if end.suction is None or other.suction is None:
        return end.suction is other.suction and end.owner == other.owner
    same_suction = np.abs(end.suction - other.suction) <= _SAME_PRESSURE * np.abs(end.suction)
    same_delivery = np.abs(end.delivery - other.delivery) <= _SAME_PRESSURE * np.abs(end.delivery)
    same = np.ravel(same_suction & same_delivery)
    if same.any() != same.all():
        raise UsageError("the stages of these machines are not alike")
    return bool(same.all())


def _part_of(of_stage: Sequence[CompressorEnd], ends: Sequence[CompressorEnd]) -> str:
    """Return the name of a stage by its pistons; by its ends, where a piston has others in another stage."""
    names: list[str] = []
    for end in of_stage:
        has_others = any(other.owner == end.owner and other not in of_stage for other in ends)
        names.append(f"{end.owner}, {end.end}" if has_others else end.owner)
    return " + ".join(dict.fromkeys(names))
