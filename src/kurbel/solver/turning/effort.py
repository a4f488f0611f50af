"""What one cylinder gives to the shaft, over the angle of crank 1: its torque, that of its masses, their inertia."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from kurbel.numerics.jet import Jet
from kurbel.solver.cylinder.following import Following
from kurbel.solver.cylinder.forces import CylinderForces
from kurbel.solver.cylinder.state import State

if TYPE_CHECKING:
    from kurbel.arrays import Array


class CylinderEffort(Following):
    """A torque of one cylinder at the angles φ of crank 1.

    torque_in: what is asked of the cylinder's state: all its torque, or one of the functions below.
    """

    def __init__(self, forces: CylinderForces, cycle: float, torque_in: Callable[[State], Any]) -> None:
        super().__init__(forces, cycle)
        self._torque_in = torque_in

    def torque(self, degrees: Array, within: Array) -> Jet:
        """Return the torque; see `Torque`."""
        torque: Jet = self._torque_in(self.jets_at(degrees, within))
        return torque


def inertia_torque(state: State) -> Any:
    """Return the torque in N m of the inertia forces at uniform rotation, Tolle's inertia line: −½ ω² dJ/dφ.

    That is −m x′ x″ ω², less the couple of an exact rod times ψ′.
    """
    drive = state.drive
    torque = state.slope * state.curvature * (-drive.mass * (drive.omega or 0.0) ** 2)
    rod, rod_angle = drive.rod, drive.mechanism.rod_angle(state.angle)
    if rod is None or rod_angle is None:
        return torque
    return torque - rod.couple(rod_angle, state.angle) * rod.swing_slope(rod_angle, state.angle)


def reduced_inertia(state: State) -> Any:
    """Return J = m x′² + … in kg m²: what the moving masses, connecting rods included, add to that of the shaft."""
    drive = state.drive
    inertia = state.slope * state.slope * drive.mass + drive.pin_inertia
    rod, rod_angle = drive.rod, drive.mechanism.rod_angle(state.angle)
    if rod is None or rod_angle is None:
        return inertia
    return inertia + rod.reduced_inertia(rod_angle, state.angle)
