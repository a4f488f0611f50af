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
    from kurbel.solver.chapters.bearings import Bearing

_IN_EFFORT = ("gas force", "piston rod", "inertia", "weight", "friction")
"""Stages of a cylinder that its turning effort consists of."""


def missing(reasons: dict[str, str]) -> Iterator[LeftOut]:
    """Yield what of these stages is left out: those with a reason."""
    return (LeftOut(what, why) for what, why in reasons.items() if why)


def _speeds(machine: Machine) -> tuple[str, str]:
    """Return why there is nothing that takes a speed, and why there is no power; "" where there is."""
    no_speed = "no speed given" if machine.speed is None else ""
    return no_speed, no_speed or ("" if machine.speed else "not defined at rest")


# one cylinder, from its description alone


def stages(machine: Machine, cylinder: Cylinder) -> dict[str, str]:
    """Return all that motion and forces of a cylinder can consist of, with the reason why it is left out, or ""."""
    mechanism, motion = cylinder.mechanism, _motion_stages(machine, cylinder)
    if not mechanism.slides:
        acting = {"moment at the output": "" if cylinder.moment else "no moment given"}
    else:
        acting = _sliding_forces(machine, cylinder)
    if all(why for what, why in acting.items() if what != "friction"):
        idle = {"friction": "no force acts"} if cylinder.friction else {}
        return {**motion, **acting, "forces in the crank train": "no force acts", **idle}

    of_rod, works = {}, {}
    if mechanism.slides and not mechanism.has_rod:
        pressed = cylinder.inclination is not None and cylinder.masses
        known = mechanism.known_across and (
            pressed or (cylinder.friction and cylinder.friction.block)
        )
        of_rod = {"S" if known else "S, N": f"{with_article(mechanism.name)} has no connecting rod"}
    # of a ram without a piston nobody expects an indicator
    if mechanism.slides and (cylinder.pistons or not cylinder.ram_force):
        no_gas = acting["gas force"]
        works = {"work": no_gas, "power": no_gas or _speeds(machine)[1]}
        if machine.brake_power is not None:
            works["comparison with brake_power"] = works["power"]
    return {
        **motion,
        **acting,
        "forces in the crank train": "",
        **of_rod,
        **dict(mechanism.lacks),
        **works,
    }


def _motion_stages(machine: Machine, cylinder: Cylinder) -> dict[str, str]:
    position = "displacement" if cylinder.mechanism.slides else "angle of the output"
    return {position: "", "velocity, acceleration": _speeds(machine)[0]}


def _sliding_forces(machine: Machine, cylinder: Cylinder) -> dict[str, str]:
    no_masses = "no masses given" if cylinder.masses is None else ""
    no_gas = "" if cylinder.pistons else "no bore given"
    if cylinder.pistons and not any(piston.indicator for piston in cylinder.pistons):
        no_gas = "no indicator given"
    rods = {
        f"piston rod of {piston.name}"
        if number
        else "piston rod": "no crank_end_rod given, its area is taken as 0"
        for number, piston in enumerate(cylinder.pistons)
        if piston.indicator and piston.indicator.crank_end is not None and not piston.crank_end_rod
    }
    expected = (
        cylinder.ram_force or cylinder.mechanism.quick_return
    )  # of an engine nobody expects a ram
    ram = {"ram force": "" if cylinder.ram_force else "no ram_force given"} if expected else {}
    return {
        "gas force": no_gas,
        **rods,
        **ram,
        "inertia": no_masses or _speeds(machine)[0],
        "weight": "no inclination given" if cylinder.inclination is None else no_masses,
        "friction": "no friction given" if cylinder.friction is None else "",
    }


def left_out(machine: Machine, cylinder: Cylinder) -> Iterator[LeftOut]:
    """Yield everything that motion and forces of this cylinder leave out."""
    yield from missing(stages(machine, cylinder))


def motion_left_out(machine: Machine, cylinder: Cylinder) -> Iterator[LeftOut]:
    """Yield what the motion of this cylinder leaves out."""
    yield from missing(_motion_stages(machine, cylinder))


def forces_left_out(machine: Machine, forces: CylinderForces) -> Iterator[LeftOut]:
    """Yield everything that the computed forces of a cylinder leave out."""
    cylinder, (_, in_noise) = forces.drive.cylinder, forces.changes_of_force
    yield from left_out(machine, cylinder)
    if forces.friction_work is not None and not forces.work_driving:
        yield LeftOut("friction loss as a share", "no piston drives")
    if not forces.no_compressor and cylinder.masses and cylinder.masses.crosshead is None:
        yield LeftOut("load on the piston rod", "no mass of the crosshead given")
    if in_noise:
        why = "are within the noise of the trace and no force reversal"
        yield LeftOut(f"{in_noise} changes of the sign of P", why)


# the whole machine


def turning_stages(machine: Machine) -> dict[str, str]:
    """Return all that `kurbel flywheel` can have of the whole machine, with the reason why it is left out, or ""."""
    speed = _speeds(machine)[1]
    wheel = speed or ("" if machine.flywheel else "no flywheel given")
    wanted = machine.flywheel is not None and machine.flywheel.fluctuation is not None
    varies = machine.load is not None and machine.load.diagram is None
    effort = machine.effort
    alone = "its swing of energy alone is given" if effort and effort.alone else ""
    no_mean = "no mean torque given" if effort and effort.alone and effort.mean is None else ""
    return {
        **(
            {"ΔE": "", "turning effort and speed over the angle": alone}
            if alone
            else {"turning effort, ΔE": ""}
        ),
        "T, W": "" if machine.cylinders else "no crank: the effort is given as a torque",
        "power": speed or no_mean,
        **({"J": speed} if wanted else {}),
        "δ" if alone else "speed line, δ": wheel,
        **({"load over the speed": wheel} if varies else {}),
        **({"coupling": wheel} if machine.coupling else {}),
    }


def flywheel_left_out(machine: Machine) -> Iterator[LeftOut]:
    """Yield what turning effort, flywheel and speed line of a machine leave out."""
    of_each = [
        [one for one in left_out(machine, cylinder) if one.what.startswith(_IN_EFFORT)]
        for cylinder in machine.cylinders
    ]
    if of_each and all(of_one == of_each[0] for of_one in of_each):
        yield from of_each[0]
    else:
        for cylinder, of_one in zip(machine.cylinders, of_each):
            yield from (LeftOut(f"{one.what} of {cylinder.name}", one.why) for one in of_one)
    if machine.flywheel and machine.flywheel.rim and machine.flywheel.rim.sized_by:
        yield LeftOut("arms and hub of the flywheel", "J is that of the rim, whose sizes are given")
    yield from missing(turning_stages(machine))


def strength_left_out(machine: Machine) -> Iterator[LeftOut]:
    """Yield what the strength of a machine's crankshaft leaves out."""
    shaft = machine.crankshaft
    if shaft is None:
        return
    upright = (
        ""
        if all(cylinder.inclination is not None for cylinder in machine.cylinders)
        else "no inclination given"
    )
    journals = "" if shaft.journal_diameter else "no journal_diameter given"
    from kurbel.solver.shaft import throws_of

    # a bearing between two throws carries both
    pressure = journals or ("" if shaft.journal_length else "no journal_length given")
    if not pressure and len(throws_of(machine.cylinders)) > 1:
        pressure = "bearings between two throws carry both; see kurbel bearings"
    yield from missing(
        {
            "flywheel weight": upright if shaft.flywheel_mass else "no flywheel_mass given",
            "journals": journals,
            "pressure on the journals": pressure,
            "p_m v": _speeds(machine)[0],
            "safety": "" if shaft.allowable_bending else "no allowable_bending given",
            "α₀ of the webs": ""
            if shaft.allowable_bending and shaft.allowable_torsion
            else "1 without k_b and k_d",
        }
    )


def bearing_left_out(
    diameter: float | None, length: float | None, omega: Number | None
) -> Iterator[LeftOut]:
    """Yield what the load on a pin or bearing leaves out; omega: angular speed of the crank, None if not given."""
    if lacks := [name for name, size in (("diameter", diameter), ("length", length)) if not size]:
        yield LeftOut("pressure, p v", f"no {' and '.join(lacks)} given")
    if omega is None:
        yield LeftOut("rubbing speed", "no speed given")


def film_left_out(bearing: Bearing) -> Iterator[LeftOut]:
    """Yield the oil film of a bearing that `oil_film` describes but that has none."""
    if bearing.film_obstacle:
        yield LeftOut("oil film", bearing.film_obstacle)


def bearings_left_out(case: Case) -> Iterator[LeftOut]:
    """Yield what the loads on all bearings leave out."""
    machine, shaft = case.machine, case.machine.crankshaft
    heavy = shaft and shaft.flywheel_mass and machine.cylinders[0].inclination is None
    yield from missing(
        {
            "main bearings": case.bearings.obstacle or "",
            "flywheel weight": "no inclination given" if heavy else "",
            "inertia": _speeds(machine)[0],
        }
    )


def balance_left_out(case: Case, compare: bool = False) -> Iterator[LeftOut]:
    """Yield what the balance leaves out; compare: with the figures of first order requested."""
    balance, machine = case.balance, case.machine
    for cylinder in machine.cylinders:
        if not cylinder.masses:
            yield LeftOut(f"inertia of {cylinder.name}", "no masses given")
    if balance.omega is None:
        yield LeftOut(
            "unbalanced forces and moments",
            "no speed given; the counterweights do not depend on it",
        )
    if balance.free.moment is None:
        placeless = [throw.name for throw in balance.throws if throw.place is None]
        if any(counterweight.place is None for counterweight in balance.counterweights):
            placeless.append("counterweights of the machine")
        if any(balance_shaft.axial_position is None for balance_shaft in machine.balance_shafts):
            placeless.append("balance_shafts")
        yield LeftOut("unbalanced moments", f"no axial_position given of {', '.join(placeless)}")
    if compare and balance.book is None:
        yield LeftOut(
            "figures of first order", "the book has no such formula for an offset stroke line"
        )
