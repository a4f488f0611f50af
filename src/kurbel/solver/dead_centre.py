"""Forces at a dead centre of a cylinder that drives a pump."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from kurbel.numerics.extreme import Extreme
from kurbel.quantity import key_value
from kurbel.solver.figures import Results
from kurbel.solver.forces import CylinderForces
from kurbel.solver.motion import every_dead_centre
from kurbel.solver.state import State

if TYPE_CHECKING:
    pass


class DeadCentre(Results):
    """Key value of `kurbel flywheel` for a cylinder that drives a pump; cycle: of the machine in degrees."""

    command = "flywheel"

    def __init__(self, forces: CylinderForces, cycle: float) -> None:
        self.forces, self._cycle = forces, cycle

    @key_value("P_d + P_p", "force")
    def P_dead_centre(self) -> Extreme | None:
        """Force ahead of the pump at a dead centre, without inertia.

        At the end of the stroke steam and pump both oppose the motion, and the parts before the pump must carry their
        sum (R p. 613). None if the cylinder does not both drive and drive a pump.
        """
        forces, drive = self.forces, self.forces.drive
        count = drive.count or 1
        driving, driven = forces.work_driving, forces.work_driven
        drives_a_pump = np.asarray(driving is not None and (driving > 0) & (driven < 0))
        if not drives_a_pump.any():
            return None

        # just before and just after each dead centre
        centres = every_dead_centre(drive.mechanism, count, drive.cycle)
        angles = np.repeat(centres, 2, axis=1)
        sides = angles + np.tile([-1e-6, 1e-6], centres.shape[1])
        machine = np.repeat(np.arange(count), angles.shape[1])
        state = State.at(drive, angles.ravel(), sides.ravel(), machine)
        values = state.P_gas.reshape(angles.shape)
        largest = np.arange(count), np.abs(values).argmax(axis=1)
        force = np.where(drives_a_pump, values[largest], np.nan)
        return Extreme(forces.result(force), forces.result(np.mod(angles[largest], self._cycle)))
