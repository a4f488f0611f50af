"""The turning effort of the whole machine against its resistance: mean, crossings, lobes, ΔE."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from kurbel.declared.unit_systems import show
from kurbel.errors import UsageError
from kurbel.machine import Machine
from kurbel.numerics.extreme import Extreme
from kurbel.solver.cylinder.forces import CylinderForces
from kurbel.solver.turning.effort import CylinderEffort, InertiaEffort
from kurbel.solver.turning.excess import Excess, mean_torque
from kurbel.solver.turning.torques import Diagram, Mean, Sum, Torque, Uniform, total_work

if TYPE_CHECKING:
    from kurbel.arrays import Array

_BALANCED = 1e-9
"""Means of effort and resistance that differ by less, relatively, are equal."""

_SLOWEST = 1e-100
"""Revolutions per second below which, and above whose inverse, kinetic energies leave the range of floats."""


class MachineTurning:
    """The whole machine over its common cycle. Attributes are named by the ids of the key values, in SI.

    A key value that the machine does not have is None. Forces T are referred to the radius of crank 1.
    """

    def __init__(self, machine: Machine, cylinders: Sequence[CylinderForces]) -> None:
        idle = [forces.drive.name for forces in cylinders if not forces.drive.has_force]
        if len(idle) == len(cylinders) and machine.effort is None:
            raise UsageError(f"{machine.name}: no force acts, so that nothing turns the shaft; kurbel check says why")
        if machine.speed and not _SLOWEST < machine.speed < 1 / _SLOWEST:
            size = "large" if machine.speed > 1 else "small"
            raise UsageError(f"{machine.name}: a speed of {show(machine.speed, 'speed')} is too {size} to compute with")
        self.machine = machine
        self.cycle = 360.0 * machine.revolutions
        self._driving = tuple(forces for forces in cylinders if forces.drive.has_force)
        self.crank = machine.cylinders[0].mechanism.crank if machine.cylinders else None

    # turning effort

    @cached_property
    def _indicated(self) -> tuple[Torque, ...]:
        if self.machine.effort:
            return (Diagram(self.machine.effort, self.cycle),)
        return tuple(CylinderEffort(forces, self.cycle) for forces in self._driving)

    @cached_property
    def efficiency(self) -> float:
        """What the turning effort is multiplied by: η, or 1/η where the machine is driven, its work being negative."""
        work = total_work(Sum([(1.0, source) for source in self._indicated]), 0.0, self.cycle)
        return self.machine.efficiency if work >= 0 else 1 / self.machine.efficiency

    @cached_property
    def effort(self) -> Sum:
        """The turning effort M, with the losses of the machine: times the efficiency, or over it; see there."""
        return Sum([(self.efficiency, source) for source in self._indicated])

    @cached_property
    def masses(self) -> tuple[InertiaEffort, ...]:
        """The moving masses of the cylinders."""
        driving = [forces for forces in self._driving if forces.drive.has_inertia]
        return tuple(InertiaEffort(f, self.cycle) for f in driving if f.drive.mass or f.drive.pin_inertia)

    @property
    def omega(self) -> float | None:
        """Nominal angular velocity in rad/s; None without a speed."""
        return None if self.machine.speed is None else 2 * math.pi * self.machine.speed

    @cached_property
    def M_mean(self) -> float:
        """Mean torque in N m, from the closed work of a cycle."""
        return mean_torque(self.effort, self.cycle)

    @property
    def W(self) -> float | None:
        """Mean tangential force in N at the radius of crank 1: the resistance."""
        return None if self.crank is None else self.M_mean / self.crank

    @property
    def work_shaft(self) -> float:
        """Work of the turning effort in J per cycle."""
        return self.M_mean * math.radians(self.cycle)

    @property
    def power_shaft(self) -> float | None:
        """Mean torque times nominal angular velocity in W."""
        return None if not self.omega else self.M_mean * self.omega

    @cached_property
    def load(self) -> Torque:
        """The resistance at the nominal speed; one given by points is brought to the mean of the effort."""
        given = self.machine.load.diagram if self.machine.load else None
        if given is None:
            return Mean(self.effort, self.cycle)
        return Sum(((1.0, Diagram(given, self.cycle)), (1.0, Uniform(self.deficit or 0.0, self.cycle))))

    @cached_property
    def deficit(self) -> float | None:
        """Mean effort less the mean of a resistance given by points, in N m; None where they agree."""
        given = self.machine.load.diagram if self.machine.load else None
        if given is None:
            return None
        mean = mean_torque(Diagram(given, self.cycle), self.cycle)
        difference = self.M_mean - mean
        return difference if abs(difference) > _BALANCED * max(abs(mean), abs(self.M_mean)) else None

    @cached_property
    def excess(self) -> Excess:
        """The excess of the turning effort over the resistance."""
        return Excess(self.effort, self.load)

    @property
    def M_max(self) -> Extreme:
        """Largest torque in N m."""
        return self.excess.effort_extremes.largest

    @property
    def M_min(self) -> Extreme:
        """Smallest torque in N m."""
        return self.excess.effort_extremes.smallest

    @property
    def T_max(self) -> Extreme | None:
        """Largest tangential force in N at the radius of crank 1."""
        return None if self.crank is None else Extreme(self.M_max.value / self.crank, self.M_max.degrees)

    @property
    def T_min(self) -> Extreme | None:
        """Smallest tangential force in N at the radius of crank 1."""
        return None if self.crank is None else Extreme(self.M_min.value / self.crank, self.M_min.degrees)

    @property
    def phi_crossing(self) -> tuple[float, ...]:
        """Crank angles in degrees at which T crosses W."""
        return self.excess.crossings

    @property
    def lobes(self) -> tuple[float, ...]:
        """Work in J of the lobes between the crossings."""
        return self.excess.lobes

    @property
    def dE(self) -> float:
        """ΔE in J."""
        return self.excess.dE

    @property
    def E_max(self) -> Extreme | None:
        """Largest excess work in J since angle 0; None where there is none."""
        return self._excess_at(self.excess.phi_largest)

    @property
    def E_min(self) -> Extreme | None:
        """Smallest excess work in J since angle 0."""
        return self._excess_at(self.excess.phi_smallest)

    def _excess_at(self, degrees: float | None) -> Extreme | None:
        return None if degrees is None else Extreme(total_work(self.excess.torque, 0.0, degrees), degrees)

    @property
    def energy_fluctuation(self) -> float | None:
        """ΔE over the work of a cycle."""
        return self.dE / self.work_shaft if self.work_shaft > 0 else None

    # columns

    def M(self, degrees: Array) -> Array:
        """Return the turning effort in N m at crank angles (n,) in degrees, just after a jump where there is one."""
        return np.asarray(self.effort.torque(degrees, degrees).value)

    def E(self, degrees: Array) -> Array:
        """Return the excess work in J since angle 0."""
        return self.excess.at(degrees)

    def T(self, degrees: Array) -> Array | None:
        """Return the turning effort as a force in N at the radius of crank 1."""
        return None if self.crank is None else self.M(degrees) / self.crank

    def T_inertia(self, degrees: Array) -> Array | None:
        """Return the share of the inertia forces in T, in N (Tolle)."""
        if self.crank is None or not self.masses:
            return None
        torque = Sum([(self.efficiency, mass) for mass in self.masses]).torque(degrees, degrees)
        return np.asarray(torque.value / self.crank)

    # parts before a directly driven pump

    def dead_centre_force(self, forces: CylinderForces) -> Extreme | None:
        """Return the largest force in N of steam and pump in a dead centre of a cylinder, without inertia (R p. 613).

        At the end of the stroke both oppose the motion, and the parts before the pump must stand their sum. None where
        the cylinder does not both drive and drive a pump.
        """
        if not (forces.work_driving and forces.work_driven):
            return None
        drive = forces.drive
        centres = np.array(drive.mechanism.dead_centres())
        angles = np.repeat(np.concatenate([centres + 360.0 * turn for turn in range(drive.revolutions)]), 2)
        sides = angles + np.tile([-1e-6, 1e-6], len(angles) // 2)
        force = drive.jets_at(angles, sides).P_gas
        values = np.asarray(getattr(force, "value", force))
        largest = int(np.argmax(np.abs(values)))
        return Extreme(float(values[largest]), float(np.mod(angles[largest], self.cycle)))
