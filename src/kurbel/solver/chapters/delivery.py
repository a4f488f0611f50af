"""What pumps and compressors deliver: flow over the angle, air vessels and pipes.

    q(φ) = (1 − slip) Σ A |dx/dt|            over the chambers that shrink; where they grow it is drawn in
    ΔV = swing of ∫ (q − q_m) dt             the fluctuating volume, found as ΔE of the turning effort is
    q = 0 before z_s, z_d                    until the valves open, where the liquid is compressible, see `pumped`
    q = … ± A dx/dt                          also of a chamber that is always open to the pipe: differential pumps
    V = ΔV (r + 1)/(2 (r − 1))               air vessel; r = V_max/V_min = ((2 + δ)/(2 − δ))^(1/n), V = ΔV/δ for n = 1
    NPSH = (p_0 − p_v)/(ρ g) − h − h_a − h_f  p_0: pressure on the liquid, h: lift of the suction pipe
    h_a = l/(g a) dq/dt, h_f = f l u²/(2 g d)    heads in a pipe of the section a, u = q/a; behind a vessel q is q_m
    A_W = 1 − A_R,m/A_R,0                    share of the work against pipe friction that vessels save

Pressures in the formulas are absolute. The flow is sampled on the pieces of the cycle, which are cut where the
valves change: at dead centres, and at the corners of the card of a compressible liquid.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from copy import copy
from functools import cache, cached_property, partial, reduce
from typing import Any

import numpy as np

from kurbel.arrays import Array, Number
from kurbel.declared.unit_systems import show
from kurbel.declared.units import GRAVITY
from kurbel.errors import UsageError
from kurbel.machine import Machine
from kurbel.machine.pumped import Pipe, Pump, Vessel
from kurbel.numerics.arithmetic import total, unless_cancelled, where
from kurbel.numerics.extreme import Extremes
from kurbel.numerics.pieces import Pieces, resolved
from kurbel.quantity import ValuesById, value, values_for
from kurbel.solver.chapters.compressors import (
    CompressorEnd,
    CompressorStage,
    compressor_ends,
    staged,
)
from kurbel.solver.chapters.driven_pistons import (
    DrivenPiston,
    OpenEnd,
    absolute_levels,
    displaced,
    driven_pistons,
    flow_of,
    open_ends,
)
from kurbel.solver.effort import TurningEffort, position
from kurbel.solver.figures import AtAngles, ExtremesOfColumns, Results, result
from kurbel.solver.forces import CylinderForces
from kurbel.solver.state import State

_CANCELLED = 4e-14
"""Relative to its largest value: a smaller flow is rounding."""

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
    npsh = value(
        "NPSH",
        "length",
        "Net positive suction head at the pump: pressure on the liquid over its vapour pressure, less lift and heads",
    )
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

    pieces: of the cycle in degrees; rate: takes the words of `displaced` and returns dV/dφ in m³ per radian at their
    nodes; is_double_acting: whether both ends of one piston deliver; is_compressible: whether the liquid is, so that valves
    open late; pump: its pipes, None for one piston of several.
    Raises UsageError for a vessel that would empty.
    """

    command, state = "delivery", DeliveryState

    stroke_volume = value("V_s", "volume", "Volume that the delivering chambers displace in a turn")
    volumetric_efficiency = value(
        "η_v",
        "ratio",
        "Volumetric efficiency of the ends that deliver",
        wanted_large=True,
        plain="eta_v",
    )
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
        "Largest suction lift: pressure on the liquid (barometer) less vapour pressure and heads",
        wanted_large=True,
    )
    npsh_available = value(
        "NPSH_A",
        "length",
        "Net positive suction head available, the least of the cycle: h_s less the lift of the pipe",
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
        is_compressible: bool,
        pump: Pump | None = None,
    ) -> None:
        self.name = name
        self.machine = machine
        self.pieces = pieces
        self.pump = pump
        self._rate = cache(rate)
        self._is_double_acting = is_double_acting
        self.is_compressible = is_compressible
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
        # a flow cannot begin at once: heads are those of valves that open in the dead centres
        at_dead_centres = {"is_rigid": True} if self.is_compressible else {}
        for pipe, is_suction in self._pipes:
            prefix = "" if is_suction else "delivery_"
            # h_a = l/(g a) dq/dt; behind a vessel the flow is steady
            if pipe.vessel is None:
                inertia = self.pieces.of(pipe.length / (GRAVITY * _section(pipe)))
                derivative = self._rate(
                    is_suction=is_suction, is_derivative=True, **at_dead_centres
                )
                columns[f"{prefix}acceleration_head"] = derivative * omega**2 * inertia
            # h_f = f l u²/(2 g d), u = q/a
            rate = self._rate(is_suction=is_suction, **at_dead_centres)
            if pipe.vessel:
                rate = self.pieces.of(self._mean(is_suction))
            heads = self.pieces.of(_friction(pipe) / GRAVITY) * rate * np.abs(rate) * omega**2
            columns[f"{prefix}friction_head"] = self.pieces.filled(heads)
        if self.pump and self.pump.suction_pipe and self.pump.suction_pipe.lift is not None:
            at_pump = self._head_of_suction(self.pump) - self.pump.suction_pipe.lift
            columns["npsh"] = self.pieces.of(at_pump) - _heads_of_suction(columns)
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
        displacement = mean / (1 - slip)
        if self.is_compressible:
            rigid = self.pieces.mean(self._rate(is_rigid=True))
            displacement = self._result(rigid) / (1 - slip)
            answers["volumetric_efficiency"] = self._mean(is_suction=True) / displacement
        answers["stroke_volume"] = 2 * math.pi * displacement
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
            lift = self._suction_lift(self.pump)
            answers["suction_lift_max"] = lift
            if self.pump.suction_pipe.lift is not None:
                answers["npsh_available"] = lift - self.pump.suction_pipe.lift
        return answers

    def _suction_lift(self, pump: Pump) -> Number:
        """Return the head in m that is left of the barometer for the lift, where the pipe takes most of it."""
        heads = _heads_of_suction(self.sampled)
        largest = self._result(self.pieces.extremes(heads[None]).largest[0])
        return self._head_of_suction(pump) - largest

    def _head_of_suction(self, pump: Pump) -> Number:
        """Return the head in m of the pressure on the liquid where the suction pipe begins, over its vapour pressure."""
        assert pump.suction_pipe is not None
        pressure: Number = self.machine.ambient
        if pump.suction_pipe.pressure is not None:
            pressure = pump.suction_pipe.pressure
        return (pressure - pump.liquid.boiling_pressure) / (pump.liquid.density * GRAVITY)

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


def _heads_of_suction(columns: Mapping[str, Array]) -> Array:
    """Return the heads in m that the suction pipe takes, of friction and, without a vessel, of acceleration."""
    heads = columns["friction_head"]
    if "acceleration_head" in columns:
        heads = heads + columns["acceleration_head"]
    return heads


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
        ratio = ((2 + delta) / (2 - delta)) ** (1 / vessel.air_exponent)
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
    pressure_ratio = volume_ratio**vessel.air_exponent
    delta = 2 * (pressure_ratio - 1) / (pressure_ratio + 1)
    return where(is_empty, math.nan, volume), delta


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
                    ends += compressor_ends(forces.drive, piston)
        self.stages: tuple[CompressorStage, ...] = staged(ends)
        pipes = _pressures_of_pipes(self._pumps)
        if self._pumps:
            for forces in effort.cylinders:
                self._open += [(forces, end) for end in open_ends(forces.drive, pipes)]
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
            any(piston.opens_late for _, piston in self._pumps),
            self.machine.pump,
        )

    @cached_property
    def pistons(self) -> tuple[Delivery, ...]:
        """What each of several pumping pistons delivers, over the angle of its own crank; equal ones once."""
        if len(self._pumps) < 2:
            return ()
        # cylinders of a group are alike but for their crank angles: the first is computed for all
        representatives = dict[int, CylinderForces]()
        for group in self.effort.groups:
            representatives |= {id(forces): group[0] for forces in group}
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
        delivery = Delivery(
            "",
            self.machine,
            forces.pieces,
            self._count,
            rate,
            is_double_acting,
            piston.opens_late,
        )
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

        It takes the words of `displaced`.
        """
        slip = self.machine.pump.slip if self.machine.pump else 0.0
        share = 1 - slip

        def rate(**words: bool) -> Array:
            terms = [
                pieces.of(share) * displaced(state, piston, **words) for state, piston in pistons
            ]
            is_suction = words.get("is_suction", False)
            for state, end in ends:
                if end.pipe == ("suction" if is_suction else "delivery"):
                    own_flow = flow_of(state, end, words.get("is_derivative", False))
                    terms.append(-own_flow if is_suction else own_flow)
            rates = pieces.filled(sum(terms))
            # rates of which the terms cancel at all angles are rounding
            sizes = sum(map(pieces.largest, terms))
            is_left = unless_cancelled(pieces.largest(rates), sizes, _CANCELLED) != 0
            return np.where(pieces.of(is_left), rates, 0.0)

        return rate


def _pressures_of_pipes(
    pumps: Sequence[tuple[CylinderForces, DrivenPiston]],
) -> dict[str, list[Number]]:
    """Return the absolute pressures in Pa of the delivery and of the suction pipes, those of the ends that deliver."""
    pipes: dict[str, list[Number]] = {"delivery": [], "suction": []}
    for forces, piston in pumps:
        delivering = {"head_end": piston.head_delivers, "crank_end": piston.crank_delivers}
        for end, delivers in delivering.items():
            levels = absolute_levels(forces.drive, piston.gas, end) if delivers else []
            if len(levels) > 1:
                pipes["delivery"].append(reduce(np.maximum, levels))
                pipes["suction"].append(reduce(np.minimum, levels))
    return pipes
