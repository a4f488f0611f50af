"""What a machine leaves out, and why: decided from the description alone, so that nothing is computed to find out."""

from collections.abc import Iterable

from kurbel.machine import Cylinder, Machine
from kurbel.report.tables import LeftOut


def stages(machine: Machine, cylinder: Cylinder) -> dict[str, str]:
    """Return all that forces and motion of a cylinder can consist of, with the reason why it is left out, or ""."""
    motion = _motion_stages(machine, cylinder)
    turning = {"moment at the output": "" if cylinder.moment else "no moment given"}
    acting = _sliding_forces(machine, cylinder) if cylinder.mechanism.slides else turning
    has_force = not all(why for what, why in acting.items() if what != "friction")
    if not has_force:
        idle = {"friction": "no force acts"} if cylinder.friction else {}
        return {**motion, **acting, "forces in the crank train": "no force acts", **idle}
    of_crank = {"forces in the crank train": "", **_of_mechanism(cylinder)}
    return {**motion, **acting, **of_crank, **_works(machine, cylinder, acting)}


def _motion_stages(machine: Machine, cylinder: Cylinder) -> dict[str, str]:
    position = "displacement" if cylinder.mechanism.slides else "angle of the output"
    return {position: "", "velocity, acceleration": "no speed given" if machine.speed is None else ""}


def _sliding_forces(machine: Machine, cylinder: Cylinder) -> dict[str, str]:
    no_masses = "no masses given" if cylinder.masses is None else ""
    rods = dict.fromkeys(_rod_areas(cylinder), "no crank_end_rod given, its area is taken as 0")
    ram = {"ram force": "" if cylinder.ram_force else "no ram_force given"}
    return {
        "gas force": _no_gas(cylinder),
        **rods,
        # of an engine nobody expects one
        **(ram if cylinder.ram_force or cylinder.mechanism.quick_return else {}),
        "inertia": no_masses or ("no speed given" if machine.speed is None else ""),
        "weight": "no inclination given" if cylinder.inclination is None else no_masses,
        "friction": "no friction given" if cylinder.friction is None else "",
    }


def _rod_areas(cylinder: Cylinder) -> Iterable[str]:
    """Yield what a pressure at the crank end would not act on if the rod were given."""
    for number, piston in enumerate(cylinder.pistons):
        if piston.indicator and piston.indicator.crank_end is not None and not piston.crank_end_rod:
            yield f"piston rod of {piston.name}" if number else "piston rod"


def _of_mechanism(cylinder: Cylinder) -> dict[str, str]:
    """Return what a slider-crank has and this mechanism has not, and what the mechanism itself misses."""
    mechanism = cylinder.mechanism
    if not mechanism.slides or mechanism.has_rod:
        return dict(mechanism.lacks)
    of_rod = "S" if mechanism.known_across and cylinder.inclination is not None and cylinder.masses else "S, N"
    return {of_rod: f"a {mechanism.name} has no connecting rod", **dict(mechanism.lacks)}


def _works(machine: Machine, cylinder: Cylinder, acting: dict[str, str]) -> dict[str, str]:
    if "gas force" not in acting or (not cylinder.pistons and cylinder.ram_force):
        # of a ram without a piston nobody expects an indicator
        return {}
    power = "no speed given" if machine.speed is None else "" if machine.speed else "not defined at rest"
    brake = {} if machine.brake_power is None else {"comparison with brake_power": acting["gas force"] or power}
    return {"work": acting["gas force"], "power": acting["gas force"] or power, **brake}


def missing(reasons: dict[str, str]) -> tuple[LeftOut, ...]:
    """Return what of these stages is left out, those with a reason."""
    return tuple(LeftOut(what, why) for what, why in reasons.items() if why)


def left_out(machine: Machine, cylinder: Cylinder) -> tuple[LeftOut, ...]:
    """Return everything that forces and motion of this cylinder leave out, with the reason."""
    return missing(stages(machine, cylinder))


def motion_left_out(machine: Machine, cylinder: Cylinder) -> tuple[LeftOut, ...]:
    """Return what of the motion of this cylinder is left out, with the reason."""
    return missing(_motion_stages(machine, cylinder))


def strength_left_out(machine: Machine) -> tuple[LeftOut, ...]:
    """Return what the strength of a machine's crankshaft leaves out, with the reason."""
    shaft = machine.crankshaft
    if shaft is None:
        return ()
    upright = "" if all(cylinder.inclination is not None for cylinder in machine.cylinders) else "no inclination given"
    journals = "" if shaft.journal_diameter else "no journal_diameter given"
    return missing(
        {
            "flywheel weight": upright if shaft.flywheel_mass else "no flywheel_mass given",
            "journals": journals,
            "pressure on the journals": journals or ("" if shaft.journal_length else "no journal_length given"),
            "p_m v": "no speed given" if machine.speed is None else "",
            "safety": "" if shaft.allowable_bending else "no allowable_bending given",
            "α₀ of the webs": "" if shaft.allowable_bending and shaft.allowable_torsion else "1 without k_b and k_d",
        }
    )


def _no_gas(cylinder: Cylinder) -> str:
    if not cylinder.pistons:
        return "no bore given"
    return "" if any(piston.indicator for piston in cylinder.pistons) else "no indicator given"


def flywheel_left_out(machine: Machine) -> tuple[LeftOut, ...]:
    """Return what turning effort, flywheel and speed line of a machine leave out, with the reason."""
    of_each = [
        [one for one in left_out(machine, cylinder) if one.what.startswith(_IN_EFFORT)]
        for cylinder in machine.cylinders
    ]
    alike = all(found == of_each[0] for found in of_each)
    found = [
        one if alike else LeftOut(f"{one.what} of {cylinder.name}", one.why)
        for cylinder, ones in list(zip(machine.cylinders, of_each))[: 1 if alike else None]
        for one in ones
    ]
    if machine.flywheel and machine.flywheel.rim and machine.flywheel.rim.sized_by:
        found.append(LeftOut("arms and hub of the flywheel", "J is that of the rim, whose sizes are given"))
    return (*found, *missing(turning_stages(machine)))


def turning_stages(machine: Machine) -> dict[str, str]:
    """Return all that `kurbel flywheel` can have of the whole machine, with the reason why it is left out, or ""."""
    speed = "no speed given" if machine.speed is None else "" if machine.speed else "not defined at rest"
    wheel = speed or ("" if machine.flywheel else "no flywheel given")
    wanted = machine.flywheel is not None and machine.flywheel.fluctuation is not None
    varies = machine.load is not None and machine.load.diagram is None
    return {
        "turning effort, ΔE": "",
        "T, W": "" if machine.cylinders else "no crank: the effort is given as a torque",
        "power": speed,
        **({"J": speed} if wanted else {}),
        "speed line, δ": wheel,
        **({"load over the speed": wheel} if varies else {}),
        **({"coupling": wheel} if machine.coupling else {}),
    }


_IN_EFFORT = ("gas force", "piston rod", "inertia", "weight", "friction")
"""Stages of a cylinder that its turning effort is made of."""
