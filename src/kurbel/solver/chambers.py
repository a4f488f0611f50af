"""Pressures and volumes in the chambers of a cylinder at crank angles, and the force that they have on its pistons."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cached_property

import numpy as np

from kurbel.arrays import Array, Indices, Number, Truth
from kurbel.crank_angle import CrankAngle
from kurbel.numerics.arithmetic import spread
from kurbel.quantity import value, values_for
from kurbel.solver.drive import Drive
from kurbel.solver.gas import HeatOfEnd, PistonGas, Pressure
from kurbel.solver.motion import MotionColumns

_BOTH = ("motion", "forces")
_ENDS = {"head": ("H", "head-end"), "crank": ("C", "crank-end")}
"""End of the cylinder -> index of its symbols, and its name."""


def _own_end(state: Chambers, end: str) -> Pressure | None:
    """Return the pressure at an end of the cylinder's own piston; None where it has no indicator."""
    gas = state.drive.own_gas
    return None if gas is None else gas.head if end == "head" else gas.crank


def _own_pressure(state: Chambers, end: str) -> Array | None:
    gas, chamber = state.drive.own_gas, _own_end(state, end)
    return (
        state.pressure(chamber) + spread(gas.base, state.drive.index) if gas and chamber else None
    )


def _own_volume(state: Chambers, end: str) -> Number | None:
    gas, passed = state.drive.own_gas, state.displacement
    if gas is None or _own_end(state, end) is None:
        return None
    if end == "head":
        return gas.piston.head_area * passed + gas.clearance_volumes[0]
    return gas.piston.crank_area * (state.mechanism.stroke - passed) + gas.clearance_volumes[1]


def _own_rise(state: Chambers, end: str) -> Array | None:
    """Return the rise of a pressure over the crank angle; None where the end has none, or a card over the stroke."""
    chamber = _own_end(state, end)
    if chamber is None or chamber.by_stroke:
        return None
    return chamber.rise(state.phi, state.drive.index)


def _own_heat(
    state: Chambers, column: Callable[[HeatOfEnd, Array, Array, Indices | None], Array]
) -> Array | None:
    """Return a column of the heat release; None where the cylinder's own piston has none."""
    gas = state.drive.own_gas
    heat = gas.heat if gas else None
    return None if heat is None else column(heat, state.phi, state.within, state.drive.index)


def _opening(state: Chambers, end: str) -> Number | None:
    valve, w = state.drive.cylinder.valve, state.valve_displacement
    if valve is None or w is None:
        return None
    head, crank = valve.ends
    if end == "head":
        return head.opening_at(w)
    return crank.opening_at(-w)


_NEEDED_FOR_HEAT = (
    "a 'wiebe' combustion, or a trace with 'heat: {exponent: 1.34}' and a 'clearance' or volumes"
)


class Chambers(MotionColumns):
    """Motion and gas forces of a cylinder at crank angles; see `MotionColumns`."""

    commands = ("forces",)

    def __init__(self, drive: Drive, angle: CrankAngle, within: Array) -> None:
        super().__init__(drive.mechanism, angle, within, drive.omega, drive.cylinder.point)
        self.drive = drive

    valve = value(
        "w",
        "length",
        "Displacement of the valve from the middle of its ports, in the sense that opens the head end to steam",
        lambda state: state.valve_displacement,
        commands=_BOTH,
        on_request=("forces",),
    )
    ports = values_for(
        _ENDS,
        "port_*",
        "a_*",
        "length",
        "Opening of the * port, to the exhaust negative",
        of=_opening,
        commands=_BOTH,
        on_request=("forces",),
    )
    own_pressures = values_for(
        _ENDS,
        "p_*",
        "p_*",
        "pressure",
        "Gauge pressure in the * chamber, just after a jump",
        of=_own_pressure,
        gauge=True,
    )
    V = value(
        "V",
        "volume",
        "Volume of the head-end chamber, including clearance if given",
        lambda state: _own_volume(state, "head"),
        on_request=("forces",),
    )
    V_crank = value(
        "V_C",
        "volume",
        "Volume of the crank-end chamber, including clearance if given",
        lambda state: _own_volume(state, "crank"),
        on_request=("forces",),
    )
    dV = value(
        "dV/dφ",
        "volume_rise",
        "Rate of change of the head-end volume with the crank angle",
        lambda state: (
            state.drive.own_gas.piston.head_area * np.radians(1.0) * state.slope
            if _own_end(state, "head")
            else None
        ),
        on_request=("forces",),
    )
    own_rises = values_for(
        _ENDS,
        "dp_*",
        "dp_*/dφ",
        "pressure_rise",
        "Rise of the * pressure, over 1 deg",
        of=_own_rise,
        on_request=("forces",),
    )
    dQ = value(
        "dQ/dφ",
        "energy_rise",
        "Heat released per degree of crank angle, over 1 deg, less what the walls take",
        lambda state: _own_heat(state, HeatOfEnd.rate),
        on_request=("forces",),
        needs=_NEEDED_FOR_HEAT,
    )
    x_b = value(
        "x_b",
        "ratio",
        "Burnt share: heat released so far over all that is released",
        lambda state: _own_heat(state, HeatOfEnd.burnt),
        on_request=("forces",),
        needs=_NEEDED_FOR_HEAT,
    )
    P_gas = value(
        "P_gas",
        "force",
        "Force of gas, steam or water on all pistons of the rod",
        lambda state: sum(state.piston_forces) if state.drive.gas else None,
    )
    P_gas_book = value(
        "P_297",
        "force",
        "The same with the mean of both piston areas (R 297)",
        lambda state: (
            sum(state.force_on(gas, mean_area=True) for gas in state.drive.gas)
            if state.drive.gas
            else None
        ),
        on_request=("forces",),
    )

    @cached_property
    def valve_displacement(self) -> Number | None:
        """Displacement w of the valve in m; None without one."""
        valve = self.drive.cylinder.valve
        if not valve:
            return None
        return valve.displacement(self.angle)

    def pressure(self, end: Pressure) -> Array:
        """Return the gauge pressure in Pa at an end of a piston."""
        if end.traced:
            return end.at(self.phi, self.within)
        left = self.mechanism.remaining(self.posed) / self.mechanism.stroke if end.steep else None
        return end.at(self.z, self.phi, self.within, self.drive.index, left)

    def force_on(self, gas: PistonGas, mean_area: bool = False) -> Array:
        """Return the gas force p_H A_H − p_C A_C in N on a piston (R 296); mean_area: both ½(A_H + A_C) (R 297)."""
        head, crank = (spread(area, self.drive.index) for area in gas.areas)
        if mean_area:
            head = crank = (head + crank) / 2
        sense = -1.0 if gas.turned else 1.0
        return sum(
            self.pressure(end) * (area * sense)
            for end, area in ((gas.head, head), (gas.crank, -crank))
            if end
        )

    @cached_property
    def piston_forces(self) -> list[Array]:
        """Force in N on each piston that has an indicator."""
        return [self.force_on(gas) for gas in self.drive.gas]

    def force_of(self, chosen: Sequence[Truth]) -> Array | None:
        """Return the sum of the gas forces in N on the pistons that are chosen, in each machine; None if none is."""
        forces = []
        for force, is_chosen in zip(self.piston_forces, chosen):
            if is_chosen is not False:
                forces.append(force * spread(is_chosen, self.drive.index))
        if not forces:
            return None
        return sum(forces)

    P_driving = value(
        "P_gas+",
        "force",
        "Force of gas or steam on the pistons that drive",
        lambda state: state.force_of(state.drive.driving),
        unless=lambda forces: forces.works_one_way,
    )
    P_driven = value(
        "P_gas−",
        "force",
        "Force of gas or water on the pistons that are driven",
        lambda state: state.force_of(state.drive.pumping),
        unless=lambda forces: forces.works_one_way,
    )
