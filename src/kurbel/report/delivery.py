"""The report of `kurbel delivery`: what pumps and compressors deliver."""

from collections.abc import Iterator
from itertools import chain, pairwise

from kurbel.declared.unit_systems import show
from kurbel.machine import Machine
from kurbel.machine.pumped import Pump
from kurbel.notes.left_out import missing
from kurbel.notes.warnings import of_machine
from kurbel.quantity import Quantity, by_id
from kurbel.solver.case import Case
from kurbel.solver.chapters.compressors import CompressorStage
from kurbel.solver.chapters.delivery import MachineDelivery
from kurbel.tables.frame import CommandReport, Subject
from kurbel.tables.shown import PlaceRow, Places
from kurbel.tables.tables import LeftOut

ENDS = by_id(
    Quantity("stroke_volume", "V_s", "volume", "Volume that the end sweeps in a turn"),
    Quantity("volumetric_efficiency", "η_v", "ratio", "Volumetric efficiency"),
    Quantity("capacity", "V_1", "flow", "Volume flow as it is drawn in"),
    Quantity("mass_flow", "q_M", "mass_flow", "Mass flow"),
    Quantity("discharge_temperature", "T_2", "temperature", "Temperature of what is delivered"),
)
"""Of one end of a compressor, by id."""
_APART = 0.02
"""By what mass flows of stages in series may differ without a note."""
_IN_SERIES = 0.8, 1.05
"""Suction pressure over the delivery pressure of the stage before, where one feeds the other."""
_COARSE = 0.5
"""Swing of the pressure in a vessel, over its mean, beyond which a note is due."""


def _delivering(case: Case) -> list[Subject]:
    """Return the stages of a compressor, the pistons of a pump, and the whole machine."""
    delivery = case.delivery
    subjects = []
    for stage in delivery.stages:
        subjects.append(Subject(stage.name, stage, tables=_ends_tables(stage), part=stage.part))
    for piston in delivery.pistons:
        subjects.append(Subject(piston.name, piston, piston.at))
    pump = delivery.pump
    machine_subject = Subject(
        "whole machine",
        pump,
        pump.at if pump else None,
        left_out=delivery_left_out(delivery),
        warnings=chain(of_machine(case), delivery_warnings(delivery)),
        whole=True,
    )
    return [*subjects, machine_subject]


def _ends_tables(stage: CompressorStage) -> Iterator[Places]:
    rows: list[PlaceRow] = [((end.owner, end.end), end.figures) for end in stage.ends]
    pressures = ""
    if stage.suction is not None:
        pressures = (
            f", {show(stage.suction, 'pressure')} to {show(stage.delivery, 'pressure')} absolute"
        )
    yield Places(
        "ends", f"Ends of {stage.name}{pressures}", ("cylinder", "end"), ENDS, rows, headed=True
    )


def _delivery_notes(case: Case) -> Iterator[str]:
    delivery = case.delivery
    if delivery.pump:
        if delivery.pump.is_compressible:
            yield (
                "Valves open late, after the liquid has been compressed or has expanded (bulk_modulus): flow counts at "
                "the pressure of its pipe, η_v is what is drawn in over the displacement."
            )
        else:
            yield "Flow is that of rigid pistons: each chamber delivers all that it displaces, less the slip."
        for name, end in delivery.open_ends:
            if end.pipe:
                side = "head" if end.is_head else "crank"
                yield (
                    f"The {side} end of {name} has the pressure of the {end.pipe} pipe on both strokes: "
                    "it is always open to it, and what it displaces comes from there and goes there."
                )
        if delivery.pistons:
            yield "φ is the angle of crank 1 for the whole machine, of its own crank for each piston."
    if delivery.stages:
        yield "Compressors are those of the ideal card: valves without losses, no leakage, no heat from the walls."


DELIVERY = CommandReport("Delivery", _delivering, _delivery_notes)


def delivery_left_out(delivery: MachineDelivery) -> Iterator[LeftOut]:
    """Yield what flows, capacities and powers of pumps and compressors leave out."""
    machine = delivery.machine
    gases = [machine.gas]
    for cylinder in machine.cylinders:
        gases += [piston.gas for piston in cylinder.pistons]
    constants = [gas for gas in gases if gas]
    has_mass = any(gas.gas_constant for gas in constants)
    has_exponent = any(gas.isentropic_exponent for gas in constants)
    no_speed = "no speed given" if machine.speed is None else ""
    no_gas = "" if constants else "no gas given"
    no_mass = "" if has_mass else "no molar_mass given"
    no_exponent = "" if has_exponent else "no isentropic_exponent given"
    if delivery.pump:
        pipes = machine.pump and (machine.pump.suction_pipe or machine.pump.delivery_pipe)
        no_pipes = "" if pipes else "no pipes given under pump"
        yield from missing({"flow": no_speed, "pipes, vessels, suction lift": no_pipes})
        if machine.pump:
            yield from _assumed(machine, machine.pump)
        for name, end in delivery.open_ends:
            if not end.pipe:
                side = "head" if end.is_head else "crank"
                reason = "one pressure on both strokes, which is that of neither pipe"
                yield LeftOut(f"what the {side} end of {name} displaces", reason)
    elif machine.pump:
        yield LeftOut("what is given under pump", "no piston is that of a pump")
    if any(stage.suction is None for stage in delivery.stages):
        yield LeftOut(
            "capacity and the rest", "a drawn card or a trace does not say when valves open"
        )
    elif delivery.stages:
        yield from missing(
            {
                "capacity": no_speed,
                "mass flow": no_gas or no_mass,
                "discharge temperature": no_gas,
                "isentropic power": no_gas or no_exponent,
            }
        )


def _assumed(machine: Machine, pump: Pump) -> Iterator[LeftOut]:
    """Yield what is taken for figures of a pump that are not given."""
    for pipe, side in ((pump.suction_pipe, "suction"), (pump.delivery_pipe, "delivery")):
        if pipe and pipe.vessel and pipe.vessel.exponent is None:
            reason = "no exponent given, 1 (isothermal air) is taken"
            yield LeftOut(f"exponent of the air in the {side} vessel", reason)
    liquid = pump.liquid
    if pump.suction_pipe and liquid.vapour_pressure is None:
        pressure = show(liquid.boiling_pressure, "pressure")
        reason = f"no vapour_pressure given, that of water at 20 °C, {pressure}, is taken"
        yield LeftOut("vapour pressure of the liquid", reason)
    if pump.suction_pipe and pump.suction_pipe.lift is None:
        yield LeftOut("NPSH available", "no lift of the suction pipe given")
    if liquid.bulk_modulus is None:
        return
    soft = [card for card in machine.chambers if liquid.opening_fractions(card) is not None]
    if not soft:
        reason = "no chamber has one pressure on each stroke, as `constant` gives"
        yield LeftOut("compression of the liquid", reason)
        return
    if any(card.clearance is None for card in soft):
        reason = "no clearance given with every `constant`, it is taken as 0"
        yield LeftOut("clearance of the chambers", reason)
    reason = "heads in pipes are those of valves that open in the dead centres"
    yield LeftOut("surge of pressure where a valve opens late", reason)


def delivery_warnings(delivery: MachineDelivery) -> Iterator[str]:
    """Yield stages in series whose mass flows differ, vessels that are small, and a lift that is too high."""
    low, high = _IN_SERIES
    with_lines = [stage for stage in delivery.stages if stage.suction is not None]
    for stage, after in pairwise(with_lines):
        flow, next_flow = stage.answers.get("mass_flow"), after.answers.get("mass_flow")
        in_series = low <= after.suction / stage.delivery <= high
        if not (flow and next_flow and in_series):
            continue
        if abs(next_flow / flow - 1) > _APART:
            yield (
                f"{after.name} draws in {next_flow / flow:.4g} times the mass flow of {stage.name}: in steady running "
                "the pressure between them would move until both are equal"
            )
    answers = delivery.pump.answers if delivery.pump else {}
    for id, name in (("vessel_swing", "delivery"), ("suction_vessel_swing", "suction")):
        if answers.get(id, 0.0) > _COARSE:
            yield f"the pressure in the {name} vessel swings by {answers[id]:.3g} of its mean; its pipe is not at rest"
    yield from _boiling_warnings(delivery)


def _boiling_warnings(delivery: MachineDelivery) -> Iterator[str]:
    """Yield that the liquid boils in the suction pipe: the lift is too high, or the pressure in a flooded one too low."""
    pipe = delivery.machine.pump and delivery.machine.pump.suction_pipe
    most = delivery.pump.answers.get("suction_lift_max") if delivery.pump else None
    if not pipe or pipe.lift is None or most is None or pipe.lift <= most:
        return
    boiling = "the liquid begins to boil: the column breaks off"
    if most >= 0:
        yield (
            f"the suction pipe lifts by {show(pipe.lift, 'length')}, more than the {show(most, 'length')} at which "
            f"{boiling}"
        )
        return
    if pipe.lift >= 0:
        height = f"the pump is {show(pipe.lift, 'length')} above the liquid"
    else:
        height = f"the liquid is {show(-pipe.lift, 'length')} above the pump"
    yield f"{height}, but must be {show(-most, 'length')} above it, since below that {boiling}"
