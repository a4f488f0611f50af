"""What is told of the guide of a lying machine whose sense of rotation is known, R p. 602."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace

from kurbel.solver.case import Case
from kurbel.solver.cylinder.forces import CylinderForces

_OTHER = {"over": "under", "under": "over"}
_MOST = 4


def guide_notes(case: Case) -> Iterable[str]:
    """Yield for each cylinder where its crosshead lifts off the lower guide, and whether the other sense avoids it."""
    machine = case.machine
    if machine.rotation is None:
        return
    for forces in case.cylinders:
        mechanism, upright = forces.drive.mechanism, not forces.drive.down
        if upright or forces.extremes_of("N") is None or not (mechanism.guided and mechanism.has_rod):
            continue
        name = f"{forces.drive.name}: " if len(machine.cylinders) > 1 else ""
        other = _OTHER[machine.rotation]
        turned = CylinderForces(replace(machine, rotation=other), forces.drive.cylinder)
        there = f"; turning {other} it {_rests(turned, 'would rest', 'would lift')}" if forces.lifted else ""
        yield f"{name}Turning {machine.rotation}, the crosshead {_rests(forces, 'rests', 'lifts')}{there} (R p. 602)."


def _rests(forces: CylinderForces, rests: str, lifts: str) -> str:
    lifted, cycle = forces.lifted, forces.drive.cycle
    if not lifted:
        return f"{rests} on the lower guide all round"
    if lifted[0][1] - lifted[0][0] >= cycle:
        return f"{rests} on the upper guide all round"
    spans = ", ".join(f"from {start:.4g} to {end % cycle:.4g} deg" for start, end in lifted)
    return f"{lifts} off the lower guide {spans if len(lifted) <= _MOST else f'{len(lifted)} times a cycle'}"
