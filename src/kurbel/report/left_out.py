"""What a machine leaves out, and why: decided from the description alone, so that nothing is computed to find out."""

from __future__ import annotations

from kurbel.machine import Cylinder, Machine
from kurbel.report.tables import LeftOut


def stages(machine: Machine, cylinder: Cylinder) -> dict[str, str]:
    """Return all that forces and motion of a cylinder can consist of, with the reason why it is left out, or ""."""
    no_masses, no_speed = "no masses given", "no speed given"
    reasons = {
        "displacement": "",
        "velocity, acceleration": no_speed if machine.speed is None else "",
        "gas force": _no_gas(cylinder),
        "inertia": no_masses if cylinder.masses is None else no_speed if machine.speed is None else "",
        "weight": "no inclination given"
        if cylinder.inclination is None
        else no_masses
        if cylinder.masses is None
        else "",
        "friction": "no friction given" if cylinder.friction is None else "",
    }
    if not _has_force(reasons):
        return {**reasons, "forces in the crank train": "no force acts", "friction": "no force acts"}
    power = no_speed if machine.speed is None else "" if machine.speed else "not defined at rest"
    return {
        **reasons,
        "forces in the crank train": "",
        "work": reasons["gas force"],
        "power": reasons["gas force"] or power,
    }


def left_out(machine: Machine, cylinder: Cylinder) -> tuple[LeftOut, ...]:
    """Return everything that forces and motion of this cylinder leave out, with the reason."""
    return tuple(LeftOut(what, why) for what, why in stages(machine, cylinder).items() if why)


def _has_force(reasons: dict[str, str]) -> bool:
    return not all(reasons[what] for what in ("gas force", "inertia", "weight"))


def _no_gas(cylinder: Cylinder) -> str:
    if not cylinder.pistons:
        return "no bore given"
    return "" if any(piston.indicator for piston in cylinder.pistons) else "no indicator given"


def warnings(cylinder: Cylinder) -> tuple[str, ...]:
    """Return what the reader tidied up in the indicator cards of a cylinder."""
    return tuple(
        f"{piston.name}, {end}: {note}"
        for piston in cylinder.pistons
        if piston.indicator
        for end, chamber in (("head end", piston.indicator.head_end), ("crank end", piston.indicator.crank_end))
        for note in getattr(chamber, "notes", ())
    )
