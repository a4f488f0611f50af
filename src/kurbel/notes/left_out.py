"""What the results of a machine leave out, and why: for every topic its stages, each with the reason or ""."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from kurbel.arrays import Number
from kurbel.machine import Cylinder, Machine
from kurbel.machine.cylinder import with_article
from kurbel.solver.case import Case
from kurbel.solver.forces import CylinderForces
from kurbel.tables.tables import LeftOut

if TYPE_CHECKING:
    from kurbel.solver.chapters.bearing import Bearing

_IN_EFFORT = ("gas force", "piston rod", "inertia", "weight", "friction")
"""Stages of a cylinder that its turning effort consists of."""


def missing(reasons: dict[str, str]) -> Iterator[LeftOut]:
    """Yield what of these stages is left out: those with a reason."""
    for stage, reason in reasons.items():
        if reason:
            yield LeftOut(stage, reason)


def _no_speed(machine: Machine) -> str:
    """Return why there is nothing that takes a speed; "" where there is."""
    return "no speed given" if machine.speed is None else ""


def _no_power(machine: Machine) -> str:
    """Return why there is no power; "" where there is."""
    if machine.speed == 0:
        return "not defined at rest"
    return _no_speed(machine)


def _unless(is_present: object, reason: str) -> str:
    """Return why something is left out; "" if it is not."""
    return "" if is_present else reason


# one cylinder, from its description alone


def stages(machine: Machine, cylinder: Cylinder) -> dict[str, str]:
    """Return all that motion and forces of a cylinder can consist of, with the reason why it is left out, or ""."""
    mechanism = cylinder.mechanism
    stages = _motion_stages(machine, cylinder)
    # the forces that act on it
    if mechanism.slides:
        acting = _sliding_forces(machine, cylinder)
    else:
        has_load = cylinder.moment or cylinder.force
        acting = {"moment at the output": _unless(has_load, "no moment given")}
    stages |= acting
    absent = {force for force, reason in acting.items() if reason}
    has_force = bool(acting.keys() - absent - {"friction"})
    stages["forces in the crank train"] = _unless(has_force, "no force acts")
    if not has_force:
        if cylinder.friction:
            stages["friction"] = "no force acts"
        return stages

    # what a mechanism without a connecting rod has not
    if mechanism.slides and not mechanism.has_rod:
        is_pressed = cylinder.inclination is not None and cylinder.masses
        has_friction = cylinder.friction and cylinder.friction.block
        has_guide_force = mechanism.known_across and (is_pressed or has_friction)
        rod_forces = "S" if has_guide_force else "S, N"
        stages[rod_forces] = f"{with_article(mechanism.name)} has no connecting rod"
    stages |= dict(mechanism.lacks)

    # work and power; of a ram without a piston nobody expects an indicator
    is_ram = not cylinder.pistons and (cylinder.ram_force or cylinder.force)
    if mechanism.slides and not is_ram:
        no_gas = acting["gas force"]
        no_power = no_gas or _no_power(machine)
        stages |= {"work": no_gas, "power": no_power}
        if machine.brake_power is not None:
            stages["comparison with brake_power"] = no_power
    return stages


def _motion_stages(machine: Machine, cylinder: Cylinder) -> dict[str, str]:
    """Return what the motion of a cylinder consists of."""
    position = "displacement" if cylinder.mechanism.slides else "angle of the output"
    return {position: "", "velocity, acceleration": _no_speed(machine)}


def _sliding_forces(machine: Machine, cylinder: Cylinder) -> dict[str, str]:
    """Return the forces on a mechanism whose output slides."""
    no_masses = _unless(cylinder.masses is not None, "no masses given")
    has_indicator = any(piston.indicator for piston in cylinder.pistons)
    no_gas = _unless(has_indicator, "no indicator given")
    if not cylinder.pistons:
        no_gas = "no bore given"
    forces = {"gas force": no_gas}
    # pressures on a crank end need the area of its piston rod
    for number, piston in enumerate(cylinder.pistons):
        has_crank_end = piston.indicator and piston.indicator.crank_end is not None
        if has_crank_end and not piston.crank_end_rod:
            rod = f"piston rod of {piston.name}" if number else "piston rod"
            forces[rod] = "no crank_end_rod given, its area is taken as 0"
    if cylinder.force:
        forces["load"] = ""
    # of an engine nobody expects a ram
    if cylinder.ram_force or (cylinder.mechanism.quick_return and not cylinder.force):
        forces["ram force"] = _unless(cylinder.ram_force, "no ram_force given")
    forces["inertia"] = no_masses or _no_speed(machine)
    forces["weight"] = no_masses
    if cylinder.inclination is None:
        forces["weight"] = "no inclination given"
    forces["friction"] = _unless(cylinder.friction is not None, "no friction given")
    return forces


def left_out(machine: Machine, cylinder: Cylinder) -> Iterator[LeftOut]:
    """Yield everything that motion and forces of this cylinder leave out."""
    yield from missing(stages(machine, cylinder))


def motion_left_out(machine: Machine, cylinder: Cylinder) -> Iterator[LeftOut]:
    """Yield what the motion of this cylinder leaves out."""
    yield from missing(_motion_stages(machine, cylinder))


def forces_left_out(machine: Machine, forces: CylinderForces) -> Iterator[LeftOut]:
    """Yield everything that the computed forces of a cylinder leave out."""
    cylinder = forces.drive.cylinder
    yield from left_out(machine, cylinder)
    if forces.friction_work is not None and not forces.work_driving:
        yield LeftOut("friction loss as a share", "no piston drives")
    gas = forces.drive.own_gas
    heat = gas.heat if gas and gas.releases_heat else None
    if heat is not None and heat.released.supplied == 0:
        yield LeftOut("indicated efficiency", "the fuel has no heat")
    if gas and gas.wanders:
        yield LeftOut("scatter of p_i", "the measured cycles wander against each other")
    has_no_crosshead = cylinder.masses and cylinder.masses.crosshead is None
    if has_no_crosshead and not forces.no_compressor:
        yield LeftOut("load on the piston rod", "no mass of the crosshead given")
    _, changes_in_noise = forces.changes_of_force
    if changes_in_noise:
        reason = "are within the noise of the trace and no force reversal"
        yield LeftOut(f"{changes_in_noise} changes of the sign of P", reason)


# the whole machine


def turning_stages(machine: Machine) -> dict[str, str]:
    """Return all that `kurbel flywheel` can have of the whole machine, with the reason why it is left out, or ""."""
    effort = machine.effort
    flywheel = machine.flywheel
    no_power = _no_power(machine)
    no_speed_line = no_power or _unless(flywheel, "no flywheel given")
    is_swing_alone = bool(effort and effort.alone)

    # the effort
    stages = {"turning effort, ΔE": ""}
    if is_swing_alone:
        stages = {
            "ΔE": "",
            "turning effort and speed over the angle": "its swing of energy alone is given",
        }
    stages["T, W"] = _unless(machine.cylinders, "no crank: the effort is given as a torque")
    has_no_mean = effort and effort.alone and effort.mean is None
    stages["power"] = no_power
    if has_no_mean:
        stages["power"] = no_power or "no mean torque given"

    # the speed
    if flywheel is not None and flywheel.fluctuation is not None:
        stages["J"] = no_power
    speed_line = "δ" if is_swing_alone else "speed line, δ"
    stages[speed_line] = no_speed_line
    if machine.load is not None and machine.load.diagram is None:
        stages["load over the speed"] = no_speed_line
    if machine.coupling:
        stages["coupling"] = no_speed_line
    return stages


def flywheel_left_out(machine: Machine) -> Iterator[LeftOut]:
    """Yield what turning effort, flywheel and speed line of a machine leave out."""
    # of the cylinders: once if all leave out the same
    lists = [_left_out_of_effort(machine, cylinder) for cylinder in machine.cylinders]
    are_equal = all(items == lists[0] for items in lists)
    if lists and are_equal:
        yield from lists[0]
    else:
        for cylinder, items in zip(machine.cylinders, lists):
            for item in items:
                yield LeftOut(f"{item.what} of {cylinder.name}", item.why)
    # of the flywheel
    if machine.flywheel and machine.flywheel.rim and machine.flywheel.rim.sized_by:
        yield LeftOut("arms and hub of the flywheel", "J is that of the rim, whose sizes are given")
    yield from missing(turning_stages(machine))


def _left_out_of_effort(machine: Machine, cylinder: Cylinder) -> list[LeftOut]:
    """Return what the effort of a cylinder leaves out."""
    return [item for item in left_out(machine, cylinder) if item.what.startswith(_IN_EFFORT)]


def strength_left_out(machine: Machine) -> Iterator[LeftOut]:
    """Yield what the strength of a machine's crankshaft leaves out."""
    shaft = machine.crankshaft
    if shaft is None:
        return
    # the weight of the flywheel
    has_inclinations = all(cylinder.inclination is not None for cylinder in machine.cylinders)
    no_weight = _unless(has_inclinations, "no inclination given")
    if not shaft.flywheel_mass:
        no_weight = "no flywheel_mass given"
    # the journals; a bearing between two throws carries both
    from kurbel.solver.shaft import throws_of

    no_journals = _unless(shaft.journal_diameter, "no journal_diameter given")
    no_pressure = no_journals or _unless(shaft.journal_length, "no journal_length given")
    if not no_pressure and len(throws_of(machine.cylinders)) > 1:
        no_pressure = "bearings between two throws carry both; see kurbel bearings"
    has_both_stresses = shaft.allowable_bending and shaft.allowable_torsion
    yield from missing(
        {
            "flywheel weight": no_weight,
            "journals": no_journals,
            "pressure on the journals": no_pressure,
            "p_m v": _no_speed(machine),
            "safety": _unless(shaft.allowable_bending, "no allowable_bending given"),
            "α₀ of the webs": _unless(has_both_stresses, "1 without k_b and k_d"),
        }
    )


def bearing_left_out(
    diameter: float | None, length: float | None, omega: Number | None
) -> Iterator[LeftOut]:
    """Yield what the load on a pin or bearing leaves out; omega: angular speed of the crank, None if not given."""
    lacking = []
    if not diameter:
        lacking.append("diameter")
    if not length:
        lacking.append("length")
    if lacking:
        yield LeftOut("pressure, p v", f"no {' and '.join(lacking)} given")
    if omega is None:
        yield LeftOut("rubbing speed", "no speed given")


def film_left_out(bearing: Bearing) -> Iterator[LeftOut]:
    """Yield the oil film of a bearing that `oil_film` describes but that has none."""
    if bearing.film_obstacle:
        yield LeftOut("oil film", bearing.film_obstacle)


def bearings_left_out(case: Case) -> Iterator[LeftOut]:
    """Yield what the loads on all bearings leave out."""
    machine = case.machine
    shaft = machine.crankshaft
    has_flywheel = shaft is not None and shaft.flywheel_mass
    has_weight = not has_flywheel or machine.cylinders[0].inclination is not None
    yield from missing(
        {
            "main bearings": case.bearings.obstacle or "",
            "flywheel weight": _unless(has_weight, "no inclination given"),
            "inertia": _no_speed(machine),
        }
    )


def balance_left_out(case: Case, compare: bool = False) -> Iterator[LeftOut]:
    """Yield what the balance leaves out; compare: with the figures of first order requested."""
    machine = case.machine
    balance = case.balance
    for cylinder in machine.cylinders:
        if not cylinder.masses:
            yield LeftOut(f"inertia of {cylinder.name}", "no masses given")
    if balance.omega is None:
        yield LeftOut(
            "unbalanced forces and moments",
            "no speed given; the counterweights do not depend on it",
        )
    if balance.free.moment is None:
        without_position = [throw.name for throw in balance.throws if throw.place is None]
        if any(weight.place is None for weight in balance.counterweights):
            without_position.append("counterweights of the machine")
        if any(shaft.axial_position is None for shaft in machine.balance_shafts):
            without_position.append("balance_shafts")
        reason = f"no axial_position given of {', '.join(without_position)}"
        yield LeftOut("unbalanced moments", reason)
    if compare and balance.book is None:
        yield LeftOut(
            "figures of first order", "the book has no such formula for an offset stroke line"
        )
