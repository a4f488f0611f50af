"""The rolling moment on the frame about the shaft: against the turning effort, and what the masses add to it."""

from collections.abc import Sequence
from typing import Any

from kurbel.machine import Machine
from kurbel.solver.cylinder.forces import CylinderForces
from kurbel.solver.cylinder.state import State
from kurbel.solver.turning.effort import efforts
from kurbel.solver.turning.machine_effort import MachineEffort
from kurbel.solver.turning.torques import Sum


def rolling_moment(machine: Machine, cylinders: Sequence[CylinderForces]) -> Sum:
    """Return −(M + dH/dt) in N m, positive in the sense of rotation; H is the moment of momentum about the shaft.

    Of a straight slider-crank whose rod counts as two masses H does not change. Raises UsageError where no force acts.
    """
    turned = MachineEffort(machine, cylinders)
    swirl = efforts(filter(swirls, cylinders), turned.cycle, _swirl)
    return Sum(*((-factor, part) for factor, part in turned.effort.parts), *((-1.0, one) for one in swirl))


def swirls(cylinder: CylinderForces) -> bool:
    """Return whether the moment of momentum of its masses about the shaft changes."""
    drive = cylinder.drive
    return drive.has_inertia and bool(drive.mechanism.offset or drive.rod)


def _swirl(state: State) -> Any:
    """Return dH/dt = m e b in N m, less the couple of an exact rod, which swings against the crank."""
    drive = state.drive
    moment = state.b * (drive.mass * drive.mechanism.offset)
    return moment - drive.rod.couple(state.rod_angle, state.angle) if drive.rod else moment
