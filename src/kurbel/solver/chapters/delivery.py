"""What pumps and compressors deliver: flow over the angle, air vessels and pipes; capacities, temperatures, stages.

    q(φ) = (1 − slip) Σ A |dx/dt|            over the chambers that shrink; where they grow it is drawn in
    ΔV = swing of ∫ (q − q_m) dt             the fluctuating volume, found as ΔE of the turning effort is
    q = … ± A dx/dt                          also of a chamber that is always open to the pipe: differential pumps
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
from collections.abc import Callable, Iterator, Mapping, Sequence
from copy import copy
from functools import cache, cached_property, partial, reduce
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
from kurbel.numerics.pieces import Pieces, resolved
from kurbel.quantity import ValuesById, value, values_for
from kurbel.solver.drive import Drive
from kurbel.solver.effort import TurningEffort, position
from kurbel.solver.figures import AtAngles, ExtremesOfColumns, Results, result
from kurbel.solver.forces import CylinderForces
from kurbel.solver.gas import PistonGas
from kurbel.solver.state import State

_NORMAL = 101325.0, 273.15
"""Pressure in Pa and temperature in K of normal conditions."""
_CANCELLED = 4e-14
"""Relative to its largest value: a smaller flow is rounding."""

# pistons that deliver


class DrivenPiston(NamedTuple):
    """A driven piston: its number in the cylinder, its pressures, which ends deliver, and whether it pumps."""

    number: int
    gas: PistonGas
    head_delivers: bool
    crank_delivers: bool
    is_pump: bool


def driven_pistons(drive: Drive) -> Iterator[DrivenPiston]:
    """Yield the pistons of a cylinder that are driven by it.

    Raises UsageError where many machines differ in that.
    """
    for gas in drive.gas:
        # the gas takes work from a driven piston; a compressor without work is driven, too
        chambers = list(gas.piston.chambers.values())
        is_compressor = any(isinstance(chamber, Compressor) for chamber in chambers)
        is_driven = _alike(gas.work < 0)
        if not is_driven and is_compressor:
            is_driven = not _alike(gas.work > 0)
        if not is_driven:
            continue
        # an end delivers if work is done on its gas; there are works of the ends that there are
        works = iter(gas.works)
        head_delivers = gas.head is not None and _alike(next(works) < 0)
        crank_delivers = gas.crank is not None and _alike(next(works) < 0)
        # a pump is declared as one, or has a constant pressure on each stroke
        is_pump = False
        if not is_compressor:
            is_pump = drive.machine.pump is not None or all(map(_is_level, chambers))
        number = drive.cylinder.pistons.index(gas.piston)
        yield DrivenPiston(number, gas, head_delivers, crank_delivers, is_pump)


def _alike(condition: Truth) -> bool:
    """Return the condition that all machines have in common; raises UsageError where they differ."""
    holds_for_all = bool(every(condition))
    if some(condition) and not holds_for_all:
        raise UsageError("these machines differ in what is driven")
    return holds_for_all


def _is_level(chamber: Chamber | None) -> bool:
    """Return whether a chamber has one pressure on each stroke, as a pump's has."""
    return _levels(chamber) is not None


def _levels(chamber: Chamber | None) -> list[Number] | None:
    """Return the pressures in Pa that a chamber has, each on a whole stroke; of the ambient none; else None."""
    if isinstance(chamber, Rectangle):
        if some(chamber.mean != 0):
            return None
        return [] if chamber.level is None else [chamber.level]
    if not isinstance(chamber, Card):
        return None
    levels = list[Number]()
    for line in chamber.lines:
        first = line.pressures[0]
        if not all(np.array_equal(pressure, first) for pressure in line.pressures):
            return None
        levels.append(first)
    return levels


# chambers that are always open to a pipe


class OpenEnd(NamedTuple):
    """An end with one pressure on both strokes; that of a pipe, to which it is then always open.

    number: of its piston in the cylinder; turned: whether that moves against the crosshead; pipe: delivery, suction,
    or '' where it has the pressure of neither.
    """

    number: int
    is_head: bool
    turned: bool
    pipe: str


def _open_ends(drive: Drive, pipes: Mapping[str, Sequence[Number]]) -> Iterator[OpenEnd]:
    """Yield the ends of pistons that do not drive which have one pressure on both strokes, but not the ambient one.

    pipes: the absolute pressures in Pa in the delivery and in the suction pipes.
    """
    for gas in drive.gas:
        if _alike(gas.work > 0):
            continue
        for end in ("head_end", "crank_end"):
            levels = _absolute_levels(gas, end, drive.machine.ambient)
            if not levels or not all(_are_equal(level, levels[0]) for level in levels):
                continue
            if _are_equal(levels[0], drive.machine.ambient):
                continue
            joined = ""
            for pipe, pressures in pipes.items():
                if any(_are_equal(levels[0], pressure) for pressure in pressures):
                    joined = pipe
            number = drive.cylinder.pistons.index(gas.piston)
            yield OpenEnd(number, end == "head_end", gas.turned, joined)


def _absolute_levels(gas: PistonGas, end: str, ambient: Number) -> list[Number]:
    """Return the absolute pressures in Pa of an end that has one on each stroke; none of another end."""
    lift = 0.0 if gas.absolute else ambient
    return [level + lift for level in _levels(gas.piston.chambers.get(end)) or ()]


def _are_equal(pressure: Number, other: Number) -> bool:
    """Return whether two pressures in Pa are equal but for rounding, of all machines."""
    difference = np.abs(np.subtract(pressure, other))
    return _alike(difference <= _SAME_PRESSURE * np.maximum(np.abs(pressure), np.abs(other)))


def _given_by(state: State, end: OpenEnd, is_derivative: bool) -> Array:
    """Return dV/dφ in m³ of what an end that is always open gives to its pipe, or takes from it (negative)."""
    dimensions = state.drive.cylinder.pistons[end.number]
    area = dimensions.head_area if end.is_head else dimensions.crank_area
    change = state.curvature if is_derivative else state.slope
    # the head end grows on the outstroke, the crank end shrinks
    shrinks_outward = end.is_head == end.turned
    sense = 1.0 if shrinks_outward else -1.0
    return sense * abs(dimensions.lever_ratio) * area * np.asarray(change)


def _displaced(
    state: State,
    piston: DrivenPiston,
    is_suction: bool = False,
    is_derivative: bool = False,
    head_counts: bool = True,
    crank_counts: bool = True,
) -> Array:
    """Return dV/dφ in m³ of what the chambers of a piston deliver; on each stroke it is one of them.

    is_suction: of what they draw in; is_derivative: d²V/dφ² instead; head_counts, crank_counts: whether that end does.
    """
    # of many machines the numbers of the piston of the state are those of the angles
    dimensions = state.drive.cylinder.pistons[piston.number]
    head_area = dimensions.head_area if piston.head_delivers and head_counts else 0.0
    crank_area = dimensions.crank_area if piston.crank_delivers and crank_counts else 0.0
    # a chamber delivers while its volume falls: the crank end on the outstroke, the head end on the return
    # stroke, and it draws in on the other one; of a piston that a lever moves against the crosshead it is turned round
    outward_area, return_area = crank_area, head_area
    if is_suction != piston.gas.turned:
        outward_area, return_area = head_area, crank_area
    # dV/dφ = A dx/dφ is positive on both strokes
    ratio = abs(dimensions.lever_ratio)
    area = np.where(state.direction > 0, ratio * outward_area, -(ratio * return_area))
    change = state.curvature if is_derivative else state.slope
    return area * np.asarray(change)


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
        self._delivery = delivery
        self.phi = phi
        self._within = within

    @cached_property
    def answers(self) -> dict[str, Array]:
        """The columns (n,) that there are."""
        pieces = self._delivery.pieces
        machine = np.zeros(len(self.phi), dtype=np.intp)
        columns = dict[str, Array]()
        for id, values in self._delivery.sampled.items():
            column = pieces.at(values, machine, self.phi, self._within)
            largest = pieces.largest(values)[0]
            columns[id] = np.asarray(unless_cancelled(column, largest, _CANCELLED))
        return columns


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
    nodes; is_double_acting: whether both ends of one piston deliver; pump: its pipes, None for one piston of several.
    Raises UsageError for a vessel that would empty.
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
        is_double_acting: bool,
        pump: Pump | None = None,
    ) -> None:
        self.name = name
        self.machine = machine
        self.pieces = pieces
        self.pump = pump
        self._rate = cache(rate)
        self._is_double_acting = is_double_acting
        # the pipes, and whether each is that of suction
        self._pipes = list[tuple[Pipe, bool]]()
        if pump and pump.suction_pipe:
            self._pipes.append((pump.suction_pipe, True))
        if pump and pump.delivery_pipe:
            self._pipes.append((pump.delivery_pipe, False))
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
        # q = dV/dφ ω
        omega = self.pieces.of(self.omega)
        columns = {
            "flow": self._rate() * omega,
            "flow_suction": self._rate(is_suction=True) * omega,
        }
        if self._is_double_acting:
            columns["flow_head"] = self._rate(crank_counts=False) * omega
            columns["flow_crank"] = self._rate(head_counts=False) * omega
        for pipe, is_suction in self._pipes:
            prefix = "" if is_suction else "delivery_"
            # h_a = l/(g a) dq/dt; behind a vessel the flow is steady
            if pipe.vessel is None:
                inertia = self.pieces.of(pipe.length / (GRAVITY * _section(pipe)))
                derivative = self._rate(is_suction=is_suction, is_derivative=True)
                columns[f"{prefix}acceleration_head"] = derivative * omega**2 * inertia
            # h_f = f l u²/(2 g d), u = q/a
            rate = self._rate(is_suction=is_suction)
            if pipe.vessel:
                rate = self.pieces.of(self._mean(is_suction))
            heads = self.pieces.of(_friction(pipe) / GRAVITY) * rate * np.abs(rate) * omega**2
            columns[f"{prefix}friction_head"] = self.pieces.filled(heads)
        return columns

    def _mean(self, is_suction: bool = False) -> Number:
        """Return the mean over the cycle of dV/dφ."""
        return self._result(self.pieces.mean(self._rate(is_suction=is_suction)))

    def _mean_cube(self, is_suction: bool = False) -> Number:
        """Return the mean over the cycle of |dV/dφ|³."""
        rate = self._rate(is_suction=is_suction)
        if not (rate < 0).any():
            return self._result(self.pieces.mean(rate * rate * rate))  # ** 3 is slow
        # where liquid flows back the pieces are cut
        pieces, cubes, _ = resolved(
            self.pieces,
            rate[None],
            rate[None],
            self.pieces.largest(rate[None]),
            lambda pieces, rates: np.abs(rates) ** 3,
        )
        return self._result(pieces.mean(cubes[0]))

    def _swing(self, is_suction: bool) -> Number:
        """Return the fluctuating volume in m³ of a flow, with all its crossings of the mean."""
        rate = self._rate(is_suction=is_suction)
        mean = self.pieces.of(self.pieces.mean(rate))
        volume = self.pieces.running(rate - mean)[None]
        scale = self.pieces.integral(rate)[None]
        largest, _, smallest, _ = self.pieces.extremes(volume, scale)
        return self._result((largest - smallest)[0])

    def extremes_of(self, column: str) -> Extremes | None:
        """Return the extremes in SI of a column that is declared to have them; None for one that is left out."""
        return self._extremes.get(column)

    @cached_property
    def _extremes(self) -> dict[str, Extremes]:
        rows = self.rows.columns
        columns = {
            id: values
            for id, values in self.sampled.items()
            if id in rows and rows[id].quantity.extremes
        }
        if not columns:
            return {}
        extremes = self.pieces.extremes([*columns.values()]).each(self._result)
        return dict(zip(columns, extremes))

    @cached_property
    def answers(self) -> ValuesById:
        """The key values that are no extremes."""
        # what the strokes give without a speed
        mean = self._mean()
        slip = self.machine.pump.slip if self.machine.pump else 0.0
        swing = self._swing(is_suction=False)
        answers = ValuesById()
        answers["stroke_volume"] = 2 * math.pi * mean / (1 - slip)
        answers["volume_fluctuation"] = swing
        answers["vessel_saving"] = self._saving(mean)
        # air vessels
        for pipe, is_suction in self._pipes:
            if pipe.vessel and is_suction:
                suction_swing = self._swing(is_suction=True)
                volume, delta = _vessel(pipe.vessel, suction_swing, "suction")
                answers["suction_vessel_volume"] = volume
                answers["suction_vessel_swing"] = delta
            elif pipe.vessel:
                volume, delta = _vessel(pipe.vessel, swing, "delivery")
                answers["vessel_volume"] = volume
                answers["vessel_swing"] = delta
        if self.omega is None:
            return answers

        # flow, work in the pipes, and suction lift at the speed
        answers["flow_mean"] = mean * self.omega
        if self._pipes:
            for id, work in zip(_PIPE_WORKS, self._works_of_pipes):
                answers[id] = work * self.omega**2
        if self.pump and self.pump.suction_pipe:
            answers["suction_lift_max"] = self._suction_lift(self.pump)
        return answers

    def _suction_lift(self, pump: Pump) -> Number:
        """Return the head in m that is left of the barometer for the lift, where the pipe takes most of it."""
        heads = self.sampled["friction_head"]
        if "acceleration_head" in self.sampled:
            heads = heads + self.sampled["acceleration_head"]
        largest = self._result(self.pieces.extremes(heads[None]).largest[0])
        weight = pump.liquid.density * GRAVITY
        barometric_head = (self.machine.ambient - pump.liquid.vapour_pressure) / weight
        return barometric_head - largest

    def _saving(self, mean: Number) -> Number:
        """Return the share of the work against friction that vessels at all pipes save: 1 − A_R,m/A_R,0.

        Without pipes it is that of one for the flow delivered, of which the mean per radian is given in m³.
        """
        saving_of_flow = 1 - mean**3 / self._mean_cube()
        if not self._pipes:
            return saving_of_flow
        _, bare, steady = self._works_of_pipes
        has_friction = bare > 0
        saving = 1 - steady / where(has_friction, bare, 1.0)
        return where(has_friction, saving, saving_of_flow)

    @cached_property
    def _works_of_pipes(self) -> tuple[Number, ...]:
        """Works over ω² per cycle against friction in all pipes: as they are, without vessels, with one at each."""
        works = [self._works_of(pipe, is_suction) for pipe, is_suction in self._pipes]
        return tuple(total(*terms) for terms in zip(*works))

    def _works_of(self, pipe: Pipe, is_suction: bool) -> tuple[Number, Number, Number]:
        """Return the works over ω² against friction in a pipe: as it is, without a vessel, and with one."""
        assert self.pump is not None
        scale = self.pump.liquid.density * _friction(pipe) * math.radians(self.pieces.cycle)
        bare = scale * self._mean_cube(is_suction)
        steady = scale * self._mean(is_suction) ** 3
        as_it_is = steady if pipe.vessel else bare
        return as_it_is, bare, steady


def _section(pipe: Pipe) -> Number:
    return math.pi / 4 * pipe.diameter**2


def _friction(pipe: Pipe) -> Number:
    """Return f l/(2 d a²) in 1/m⁴, which times ρ q² is the loss of pressure."""
    return pipe.friction_factor * pipe.length / (2 * pipe.diameter * _section(pipe) ** 2)


def _vessel(vessel: Vessel, swing: Number, side: str) -> tuple[Number, Number]:
    """Return mean volume in m³ and swing of pressure of a vessel that takes a fluctuating volume in m³."""
    # V = ΔV (r + 1)/(2 (r − 1)), r = ((2 + δ)/(2 − δ))^(1/n)
    if vessel.pressure_swing is not None:
        delta = vessel.pressure_swing
        ratio = ((2 + delta) / (2 - delta)) ** (1 / vessel.exponent)
        return swing * (ratio + 1) / (2 * (ratio - 1)), delta
    # a vessel of a given volume must hold more than half of the fluctuating volume
    volume: Any = vessel.volume
    half = swing / 2
    is_empty = volume <= half
    if isinstance(is_empty, (bool, np.bool_)) and is_empty:
        least_text = show(float(half), "volume")
        volume_text = show(volume, "volume")
        raise UsageError(
            f"pump.{side}_pipe.vessel.volume: {volume_text} would empty; "
            f"it must be more than ΔV/2 = {least_text}"
        )
    # r = V_max/V_min of the volumes, to the power n of the pressures; of many machines NaN where it empties
    smallest = where(is_empty, 1.0, volume - half)
    volume_ratio = where(is_empty, math.nan, (volume + half) / smallest)
    pressure_ratio = volume_ratio**vessel.exponent
    delta = 2 * (pressure_ratio - 1) / (pressure_ratio + 1)
    return where(is_empty, math.nan, volume), delta


# compressors


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


# the machine


class MachineDelivery:
    """All that a machine delivers: `pump`, of all its pumping pistons together, None without any; `pistons`, each of
    several; `stages`, those of its compressors, the lowest suction pressure first.

    Raises UsageError where nothing is delivered.
    """

    def __init__(self, effort: TurningEffort) -> None:
        self.machine = effort.machine
        self.effort = effort
        self._count = effort.count
        # the pistons that pump, and the ends of those that compress
        self._pumps = list[tuple[CylinderForces, DrivenPiston]]()
        self._open = list[tuple[CylinderForces, OpenEnd]]()
        ends = list[CompressorEnd]()
        for forces in effort.cylinders:
            for piston in driven_pistons(forces.drive):
                if piston.is_pump:
                    self._pumps.append((forces, piston))
                else:
                    ends += _compressor_ends(forces.drive, piston)
        self.stages: tuple[CompressorStage, ...] = _staged(ends)
        pumping = [piston for _, piston in self._pumps]
        pipes = _pressures_of_pipes(pumping, self.machine.ambient)
        if self._pumps:
            for forces in effort.cylinders:
                self._open += [(forces, end) for end in _open_ends(forces.drive, pipes)]
        if not (self._pumps or self.stages):
            raise UsageError(
                f"{self.machine.name} delivers nothing: no piston is driven by the shaft; "
                "a pump has a 'constant' pressure on each stroke, the higher one on compression, "
                "a compressor has 'compressor: {…}'"
            )

    @cached_property
    def pump(self) -> Delivery | None:
        """What all pumping pistons deliver together, over the angle of crank 1."""
        if not self._pumps:
            return None
        # the states of the cylinders at the same angles, once for all pistons of one
        pieces = self.effort.pieces
        states: dict[int, State] = {}
        for forces, _ in (*self._pumps, *self._open):
            if id(forces) not in states:
                angles = pieces.by_crank(position(forces))
                states[id(forces)] = State.on(forces.drive, angles)
        rate = self._rate_of(
            pieces,
            [(states[id(forces)], piston) for forces, piston in self._pumps],
            [(states[id(forces)], end) for forces, end in self._open],
        )
        # flows of the ends are those of a single piston
        first = self._pumps[0][1]
        is_double_acting = len(self._pumps) == 1 and first.head_delivers and first.crank_delivers
        return Delivery(
            "whole machine",
            self.machine,
            pieces,
            self._count,
            rate,
            is_double_acting,
            self.machine.pump,
        )

    @cached_property
    def pistons(self) -> tuple[Delivery, ...]:
        """What each of several pumping pistons delivers, over the angle of its own crank; equal ones once."""
        if len(self._pumps) < 2:
            return ()
        # cylinders of a group are alike but for their crank angles: the first is computed for all
        representatives = {id(forces): group[0] for group in self.effort.groups for forces in group}
        computed: dict[tuple[int, int], Delivery] = {}
        deliveries = list[Delivery]()
        for forces, piston in self._pumps:
            representative = representatives[id(forces)]
            key = id(representative), piston.number
            if key not in computed:
                computed[key] = self._delivery_of(representative, piston)
            delivery = copy(computed[key])
            delivery.name = forces.drive.name
            if piston.number > 0:
                delivery.name = f"{forces.drive.name}, {piston.gas.piston.name}"
            deliveries.append(delivery)
        return tuple(deliveries)

    def _delivery_of(self, forces: CylinderForces, piston: DrivenPiston) -> Delivery:
        """Return what one pumping piston delivers, computed once for all its copies."""
        own_ends = [
            (forces.samples, end)
            for owner, end in self._open
            if owner is forces and end.number == piston.number
        ]
        rate = self._rate_of(forces.pieces, [(forces.samples, piston)], own_ends)
        is_double_acting = piston.head_delivers and piston.crank_delivers
        delivery = Delivery("", self.machine, forces.pieces, self._count, rate, is_double_acting)
        _ = delivery.answers, delivery.extremes_of("flow")
        return delivery

    @property
    def open_ends(self) -> Iterator[tuple[str, OpenEnd]]:
        """The ends with one pressure on both strokes, each with the name of its cylinder, or of its tandem piston."""
        for forces, end in self._open:
            name = forces.drive.name
            if end.number > 0:
                name = f"{name}, {forces.drive.cylinder.pistons[end.number].name}"
            yield name, end

    def _rate_of(
        self,
        pieces: Pieces,
        pistons: Sequence[tuple[State, DrivenPiston]],
        ends: Sequence[tuple[State, OpenEnd]],
    ) -> Callable[..., Array]:
        """Return what returns dV/dφ of these pistons together, less the slip, and of ends that are always open.

        It takes the words of `_displaced`.
        """
        slip = self.machine.pump.slip if self.machine.pump else 0.0
        share = 1 - slip

        def rate(**words: bool) -> Array:
            terms = [
                pieces.of(share) * _displaced(state, piston, **words) for state, piston in pistons
            ]
            is_suction = words.get("is_suction", False)
            for state, end in ends:
                if end.pipe == ("suction" if is_suction else "delivery"):
                    own_flow = _given_by(state, end, words.get("is_derivative", False))
                    terms.append(-own_flow if is_suction else own_flow)
            rates = pieces.filled(sum(terms))
            # rates of which the terms cancel at all angles are rounding
            sizes = sum(map(pieces.largest, terms))
            is_left = unless_cancelled(pieces.largest(rates), sizes, _CANCELLED) != 0
            return np.where(pieces.of(is_left), rates, 0.0)

        return rate


def _pressures_of_pipes(
    pistons: Sequence[DrivenPiston], ambient: Number
) -> dict[str, list[Number]]:
    """Return the absolute pressures in Pa of the delivery and of the suction pipes, those of the ends that deliver."""
    pipes: dict[str, list[Number]] = {"delivery": [], "suction": []}
    for piston in pistons:
        delivering = {"head_end": piston.head_delivers, "crank_end": piston.crank_delivers}
        for end, delivers in delivering.items():
            levels = _absolute_levels(piston.gas, end, ambient) if delivers else []
            if len(levels) > 1:
                pipes["delivery"].append(reduce(np.maximum, levels))
                pipes["suction"].append(reduce(np.minimum, levels))
    return pipes


def _compressor_ends(drive: Drive, piston: DrivenPiston) -> Iterator[CompressorEnd]:
    """Yield the ends of a piston that compress, or have the card of a compressor."""
    for end, delivers in (
        ("head_end", piston.head_delivers),
        ("crank_end", piston.crank_delivers),
    ):
        if delivers or isinstance(piston.gas.piston.chambers.get(end), Compressor):
            yield CompressorEnd(drive, piston, end)


def _staged(ends: Sequence[CompressorEnd]) -> tuple[CompressorStage, ...]:
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


_SAME_PRESSURE = 1e-9
"""Relative difference of pressures that are equal but for rounding."""


def _are_of_one_stage(end: CompressorEnd, other: CompressorEnd) -> bool:
    """Return whether two ends have suction and delivery pressure in common, or are of one piston without them."""
    if end.suction is None or other.suction is None:
        return end.suction is other.suction and end.owner == other.owner
    same_suction = np.abs(end.suction - other.suction) <= _SAME_PRESSURE * np.abs(end.suction)
    same_delivery = np.abs(end.delivery - other.delivery) <= _SAME_PRESSURE * np.abs(end.delivery)
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
