"""What is told of the guide of a lying machine whose sense of rotation is known, R p. 602."""

from collections.abc import Iterable
from dataclasses import replace

from kurbel.report.alike import together
from kurbel.solver.case import Case
from kurbel.solver.forces import CylinderForces

_OTHER = {"over": "under", "under": "over"}
_MOST = 4


def guide_notes(case: Case) -> Iterable[str]:
    """Yield of which cylinders the crosshead rests on the lower guide."""
    resting = [forces for forces in case.cylinders if _guided(forces) and not forces.lifted]
    if resting:
        name = f"{together([one.drive.name for one in resting])}: " if len(case.cylinders) > 1 else ""
        yield f"{name}{_told(resting[0])} (R p. 602)."


def guide_warnings(forces: CylinderForces) -> Iterable[str]:
    """Yield where the crosshead of a cylinder lifts off the lower guide, and whether the other sense avoids it."""
    if _guided(forces) and forces.lifted:
        machine, drive = forces.drive.machine, forces.drive
        other = _OTHER[machine.rotation or "over"]
        turned = CylinderForces(replace(machine, rotation=other), drive.cylinder)
        yield f"{_told(forces)}; turning {other} it {_rests(turned, 'would rest', 'would lift')} (R p. 602)"


def _guided(forces: CylinderForces) -> bool:
    """Return whether there is a guide below, and a sense of rotation that is told."""
    drive = forces.drive
    if drive.machine.rotation is None or not drive.down or not (drive.mechanism.guided and drive.mechanism.has_rod):
        return False
    return forces.extremes_of("N") is not None


def _told(forces: CylinderForces) -> str:
    return f"Turning {forces.drive.machine.rotation}, the crosshead {_rests(forces, 'rests', 'lifts')}"


def _rests(forces: CylinderForces, rests: str, lifts: str) -> str:
    lifted, cycle = forces.lifted, forces.drive.cycle
    if not lifted:
        return f"{rests} on the lower guide all round"
    if lifted[0][1] - lifted[0][0] >= cycle:
        return f"{rests} on the upper guide all round"
    spans = ", ".join(f"from {start:.4g} to {end % cycle:.4g} deg" for start, end in lifted)
    return f"{lifts} off the lower guide {spans if len(lifted) <= _MOST else f'{len(lifted)} times a cycle'}"
