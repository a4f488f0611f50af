"""What cylinders give to the shaft, over the angle of crank 1: its torque, that of its masses, their inertia."""

from collections.abc import Callable, Iterable, Sequence
from functools import cached_property
from typing import Any

import numpy as np

from kurbel.arrays import Array
from kurbel.machine.alike import gathered, work_alike
from kurbel.numerics.arithmetic import unless_cancelled
from kurbel.numerics.brackets import Sampled
from kurbel.numerics.grid import Cuts
from kurbel.numerics.jet import Jet
from kurbel.solver.cylinder.following import own_cuts, position
from kurbel.solver.cylinder.forces import CylinderForces
from kurbel.solver.cylinder.inside import Inside
from kurbel.solver.cylinder.state import State

_SAME_PLACE = 1e-12
"""Degrees by which cranks at equal distances, as of a firing order, stand elsewhere by rounding."""


class CylinderEffort:
    """The sum of a torque of cylinders that work alike, at the angles φ of crank 1: one cylinder, asked at all angles.

    torque_in: what is asked of the cylinder's state: all its torque, or one of the functions below. drive: of one.
    """

    def __init__(self, alike: Sequence[CylinderForces], cycle: float, torque_in: Callable[[State], Any]) -> None:
        self._alike = alike
        self._cycle = cycle
        self.drive = alike[0].drive
        self._positions = np.array([position(one) for one in alike])
        self._torque_in = torque_in

    @cached_property
    def cuts(self) -> Cuts:
        """Where it bends or jumps over the cycle; searched only where more is asked than the torque at some angles."""
        cuts = own_cuts(self._alike[0])
        return Cuts.joined([cuts.shifted(behind, self._cycle) for behind in self._positions.tolist()])

    @cached_property
    def repeats(self) -> int:
        """How often it comes back in the cycle: as often as the cranks stand alike over that of a cylinder."""
        own = self.drive.cycle
        stand = np.sort(np.mod(self._positions, own))
        parts = (each for each in range(len(stand), 0, -1) if len(stand) % each == 0)
        return next(each for each in parts if _same_places(stand, own / each, own)) * round(self._cycle / own)

    def torque(self, degrees: Array, within: Array | Inside) -> Jet:
        """Return the torque; see `Torque`."""
        angles = degrees - self._behind(degrees)
        inside = within if isinstance(within, Inside) else (within - self._behind(within)).ravel()
        every = Sampled.of(self._torque_in(self.drive.jets_at(angles.ravel(), inside)), (angles.size,))
        values, slopes = (part.reshape(angles.shape) for part in every)
        return Jet(unless_cancelled(values.sum(axis=0), np.abs(values).sum(axis=0)), slopes.sum(axis=0))

    def inside(self, within: Array) -> Inside:
        """Return what all angles in the pieces share that hold these (n,)."""
        return Inside(self.drive, (within - self._behind(within)).ravel())

    def _behind(self, degrees: Array) -> Array:
        return self._positions.reshape(-1, *(1 for _ in degrees.shape))


def _same_places(places: Array, turn: float, cycle: float) -> bool:
    """Return whether places (n,) in degrees over a cycle are the same ones, but for rounding, when each is turned."""
    apart = np.subtract.outer(places + turn, places)
    return bool((np.abs(apart - cycle * np.rint(apart / cycle)).min(axis=1) <= _SAME_PLACE).all())


def efforts(
    cylinders: Iterable[CylinderForces], cycle: float, torque_in: Callable[[State], Any]
) -> tuple[CylinderEffort, ...]:
    """Return a torque of several cylinders, those that work alike as one."""
    groups = gathered(cylinders, lambda one, other: work_alike(one.drive.cylinder, other.drive.cylinder))
    return tuple(CylinderEffort(group, cycle, torque_in) for group in groups)


def driving_torque(state: State) -> Any:
    """Return the torque in N m of the gas on the pistons that drive, P_driving dx/dφ."""
    return state.P_driving * state.slope


def inertia_torque(state: State) -> Any:
    """Return the torque in N m of the inertia forces at uniform rotation, Tolle's inertia line: −½ ω² dJ/dφ.

    That is −m x′ x″ ω², less the couple of an exact rod times ψ′.
    """
    rod = state.drive.rod
    torque = state.slope * state.curvature * (-state.drive.mass * (state.drive.omega or 0.0) ** 2)
    if rod is None:
        return torque
    return torque - rod.couple(state.rod_angle, state.angle) * rod.swing_slope(state.rod_angle, state.angle)


def reduced_inertia(state: State) -> Any:
    """Return J = m x′² + … in kg m²: what the moving masses, connecting rods included, add to that of the shaft."""
    rod = state.drive.rod
    inertia = state.slope * state.slope * state.drive.mass + state.drive.pin_inertia
    return inertia + rod.reduced_inertia(state.rod_angle, state.angle) if rod else inertia
