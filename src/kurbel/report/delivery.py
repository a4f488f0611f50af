"""The report of `kurbel delivery`, and the tables of load cases: a row for each, of several commands."""

from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np

from kurbel.declared.reading import shown
from kurbel.declared.unit_systems import show
from kurbel.errors import KurbelError, UsageError
from kurbel.machine import Machine
from kurbel.near_words import did_you_mean
from kurbel.numerics.extreme import number_of
from kurbel.quantities import every_quantity
from kurbel.quantity import Quantity, by_id, called
from kurbel.report.frame import Frame, Row, Subject, place_table, report_on, subjects_of
from kurbel.report.left_out import missing
from kurbel.report.tables import LeftOut, PlaceTable, Report
from kurbel.report.warnings import of_machine
from kurbel.solver.case import Case
from kurbel.solver.delivery import CompressorStage, MachineDelivery

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


@np.errstate(all="ignore")  # what overflows is refused by name
def delivery_report(case: Case, frame: Frame) -> Report:
    """Return what pumps and compressors deliver; pumps over the crank angle, that of crank 1 for all together.

    Raises UsageError if nothing is delivered, or a vessel would empty.
    """
    found = case.delivery
    subjects = [
        replace(one, tables=[_ends_table(one.results, frame.system)])
        if isinstance(one.results, CompressorStage)
        else one
        for one in subjects_of(case, "delivery")
    ]
    whole = subjects.pop() if found.pump else Subject("whole machine")
    if frame.prose:
        warnings = (*of_machine(case), *delivery_warnings(found))
        whole = replace(whole, left_out=delivery_left_out(found), warnings=warnings)
    return report_on(frame, case.machine, "Delivery", subjects, whole, _delivery_notes(found))


def _ends_table(stage: CompressorStage, system: str) -> PlaceTable:
    rows: list[Row] = [
        ((one.owner, one.end), {id: one.figures[id] for id in ENDS if id in one.figures}) for one in stage.ends
    ]
    pressures = ""
    if stage.suction is not None:
        pressures = f", {show(stage.suction, 'pressure')} to {show(stage.delivery, 'pressure')} absolute"
    return place_table("ends", f"Ends of {stage.name}{pressures}", ("cylinder", "end"), ENDS, rows, system, headed=True)


def _delivery_notes(found: MachineDelivery) -> Iterator[str]:
    if found.pump:
        yield "Flow is that of rigid pistons: each chamber delivers all that it displaces, less the slip."
        if found.pistons:
            yield "φ is the angle of crank 1 for the whole machine, of its own crank for each piston."
    if found.stages:
        yield "Compressors are those of the ideal card: valves without losses, no leakage, no heat from the walls."


def delivery_left_out(found: MachineDelivery) -> list[LeftOut]:
    """Return what flows, capacities and powers of pumps and compressors leave out."""
    machine, drawn = found.machine, any(one.suction is None for one in found.stages)
    gases = [piston.gas or machine.gas for cylinder in machine.cylinders for piston in cylinder.pistons]
    constants = [one for one in (*gases, machine.gas) if one]
    no_speed = "no speed given" if machine.speed is None else ""
    no_gas = "no gas given" if not constants else ""
    known = found.stages and not drawn
    pipes = machine.pump and (machine.pump.suction_pipe or machine.pump.delivery_pipe)
    return missing(
        {
            "flow": no_speed if found.pump else "",
            "pipes, vessels, suction lift": "no pipes given under pump" if found.pump and not pipes else "",
            "capacity and the rest": "a drawn card or a trace does not say when valves open" if drawn else "",
            "capacity": no_speed if known else "",
            "mass flow": (no_gas or ("" if any(one.gas_constant for one in constants) else "no molar_mass given"))
            if known
            else "",
            "discharge temperature": no_gas if known else "",
            "isentropic power": (
                no_gas or ("" if any(one.isentropic_exponent for one in constants) else "no isentropic_exponent given")
            )
            if known
            else "",
        }
    )


def delivery_warnings(found: MachineDelivery) -> Iterator[str]:
    """Yield stages in series whose mass flows differ, vessels that are small, and a lift that is too high."""
    known = [one for one in found.stages if one.suction is not None]
    for one, after in pairwise(known):
        flow, next_flow = one.answers.get("mass_flow"), after.answers.get("mass_flow")
        low, high = _IN_SERIES
        if not (flow and next_flow and low <= after.suction / one.delivery <= high):
            continue
        if abs(next_flow / flow - 1) > _APART:
            yield (
                f"{after.name} draws in {next_flow / flow:.4g} times the mass flow of {one.name}: in steady running "
                "the pressure between them would move until both are equal"
            )
    answers = found.pump.answers if found.pump else {}
    for id, name in (("vessel_swing", "delivery"), ("suction_vessel_swing", "suction")):
        if answers.get(id, 0.0) > _COARSE:
            yield f"the pressure in the {name} vessel swings by {answers[id]:.3g} of its mean; its pipe is not at rest"
    pipe = found.machine.pump and found.machine.pump.suction_pipe
    most = answers.get("suction_lift_max")
    if pipe and pipe.lift is not None and most is not None and pipe.lift > most:
        yield (
            f"the suction pipe lifts by {show(pipe.lift, 'length')}, more than the {show(most, 'length')} at which the "
            "liquid begins to boil: the column breaks off"
        )


# load cases

IN_CASES = {
    "forces": "p_max P_max P_min T_max rod_compression_max rod_tension_max reversal_angle reversal_ratio work power",
    "bearings": "load_max load_mean pressure_max pressure_velocity unloaded_arc",
    "torsion": "natural_frequency M_vibratory tau_vibratory vibration_loss",
    "delivery": "volumetric_efficiency capacity mass_flow discharge_temperature stage_power isentropic_efficiency "
    "flow_mean flow_max volume_fluctuation vessel_volume vessel_swing suction_lift_max",
}
"""Command -> the key values of its table of load cases if none are requested."""


@np.errstate(all="ignore")  # what overflows is refused by name
def cases_report(
    base: Machine, cases: Sequence[Case], command: str, system: str, names: Sequence[str] | None = None
) -> Report:
    """Return the key values of load cases, a row for each, of each part of the machine.

    base: the machine as it is without them; names: ids or symbols of the key values. Raises UsageError for a name that
    is none, and if no case has any.
    """
    declared = every_quantity().key_values(command)
    ids = [_id_of(name, command, declared) for name in names] if names else IN_CASES[command].split()
    rows: dict[str, list[Row]] = {}
    notes: list[str] = []
    for case in cases:
        name = case.machine.origin.case if case.machine.origin else case.machine.name
        try:
            for subject in subjects_of(case, command):
                answers = {id: number_of(subject.answer(declared[id])) for id in ids}
                values = {id: one for id, one in answers.items() if isinstance(one, float)}
                if values:
                    rows.setdefault(subject.name, []).append(((name,), values))
        except KurbelError as error:
            notes.append(f"{name}: {error}")
    if not rows:
        raise UsageError("; ".join(notes) or f"{base.name}: no case has any of {', '.join(ids)}")
    shown_ones = {id: declared[id] for id in ids}
    parts = []
    for name, of_part in rows.items():
        title = f"Load cases: {name}" if len(rows) > 1 else "Load cases"
        parts.append(Subject(name, tables=[place_table("cases", title, ("case",), shown_ones, of_part, system, True)]))
    report = report_on(Frame(command, (), None, system), base, "Load cases", parts, notes=notes)
    return report._replace(group="bearings") if command == "bearings" else report


def _id_of(name: str, command: str, declared: dict[str, Quantity]) -> str:
    ids = called(name, declared.values())
    if not ids:
        near = did_you_mean(name, tuple(declared))
        raise UsageError(f"--columns: '{shown(name)}' is no key value of kurbel {command}{near}")
    return ids[0]
