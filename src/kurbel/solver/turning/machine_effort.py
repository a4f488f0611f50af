"""The turning effort of the whole machine, what it works against, and the masses that move with it."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from kurbel.arrays import Array
from kurbel.declared.unit_systems import show
from kurbel.errors import NoSolutionError, UsageError
from kurbel.machine import Machine
from kurbel.numerics.extreme import Extreme
from kurbel.numerics.grid import Grid
from kurbel.numerics.jet import value_of
from kurbel.numerics.piecewise import Piecewise
from kurbel.solver.cylinder.drive import Drive
from kurbel.solver.cylinder.forces import CylinderForces
from kurbel.solver.cylinder.state import State
from kurbel.solver.turning.effort import CylinderEffort, driving_torque, efforts, inertia_torque, reduced_inertia
from kurbel.solver.turning.excess import Excess
from kurbel.solver.turning.torques import Diagram, Sum, Torque, known_torque

_SLOWEST = 1e-100
"""Revolutions per second below which, and above whose inverse, kinetic energies leave the range of floats."""


@dataclass(frozen=True, eq=False)
class Driving:
    """A cylinder in which a force acts, its torque over the angle of crank 1, and that of its masses, if they move.

    share: what the torque is multiplied by for the losses of the machine; lost: what they take off besides.
    """

    forces: CylinderForces
    effort: CylinderEffort
    inertia: CylinderEffort | None
    share: float
    lost: tuple[tuple[float, Torque], ...]


class MachineEffort:
    """The torques of the whole machine over its common cycle."""

    def __init__(self, machine: Machine, cylinders: Sequence[CylinderForces]) -> None:
        self._driving = tuple(forces for forces in cylinders if forces.drive.has_force)
        if not self._driving and machine.effort is None:
            raise UsageError(f"{machine.name}: no force acts, so that nothing turns the shaft; kurbel check says why")
        if machine.speed and not _SLOWEST < machine.speed < 1 / _SLOWEST:
            size = "large" if machine.speed > 1 else "small"
            raise UsageError(f"{machine.name}: a speed of {show(machine.speed, 'speed')} is too {size} to compute with")
        self.machine = machine
        self.cycle = 360.0 * machine.revolutions

    @property
    def omega(self) -> float | None:
        """Nominal angular velocity in rad/s; None without a speed."""
        return None if self.machine.speed is None else 2 * math.pi * self.machine.speed

    @cached_property
    def _indicated(self) -> Sum:
        """The torque without the losses of the machine."""
        if self.machine.effort:
            return Sum((1.0, known_torque(self.machine.effort, self.cycle)))
        return Sum(*((1.0, one) for one in efforts(self._driving, self.cycle, _effort)))

    @cached_property
    def _drives(self) -> bool:
        """Whether any piston drives; of an effort that is given, whether it does on the mean."""
        if self.machine.effort:
            return Excess(self._indicated).mean >= 0
        return any(forces.drive.driving for forces in self._driving)

    def share(self, drive: Drive | None) -> float:
        """Return what the torque of a cylinder, or a given effort, is multiplied by for the losses (R p. 610–613).

        η where its pistons drive, 1/η where the machine is driven and no piston drives. Beside driving pistons driven
        ones count in full; where both are on one rod, so does all but the force of the driving ones.
        """
        eta = self.machine.efficiency
        if eta == 1 or drive is None:
            return eta if eta == 1 or self._drives else 1 / eta
        if self._drives:
            return eta if drive.driving and not drive.driven else 1.0
        return 1 / eta if any(forces.drive.driven for forces in self._driving) else 1.0

    def _lost(self, cylinders: Sequence[CylinderForces]) -> tuple[tuple[float, Torque], ...]:
        """Return what is lost of the torque of driving pistons that have driven ones on their rods."""
        lost = 1 - self.machine.efficiency
        both = [one for one in cylinders if lost and one.drive.driving and one.drive.driven]
        return tuple((-lost, one) for one in efforts(both, self.cycle, driving_torque))

    @cached_property
    def of_cylinders(self) -> tuple[Driving, ...]:
        """The torques of the cylinders, each by itself."""
        return tuple(
            Driving(
                forces,
                CylinderEffort((forces,), self.cycle, _effort),
                CylinderEffort((forces,), self.cycle, inertia_torque) if _moves(forces) else None,
                self.share(forces.drive),
                self._lost((forces,)),
            )
            for forces in self._driving
        )

    @cached_property
    def effort(self) -> Sum:
        """The turning effort M, with the losses of the machine; see `share`."""
        shared = ((self.share(getattr(part, "drive", None)), part) for _, part in self._indicated.parts)
        return Sum(*shared, *self._lost(self._driving))

    @cached_property
    def masses(self) -> tuple[CylinderEffort, ...]:
        """The torques of the moving masses of the cylinders."""
        return efforts(filter(_moves, self._driving), self.cycle, inertia_torque)

    @cached_property
    def excess(self) -> Excess:
        """The excess of the turning effort over the resistance at the nominal speed.

        Raises NoSolutionError where the losses leave too little of what drives the machine.
        """
        given = self.machine.load.diagram if self.machine.load else None
        found = Excess(self.effort, None if given is None else Diagram(given, self.cycle))
        if found.mean < 0 and self.machine.efficiency != 1 and self._drives:
            raise NoSolutionError(self._why_it_stands(found.mean))
        return found

    def _why_it_stands(self, mean: float) -> str:
        """Return why the machine does not run with this negative mean torque in N m, and with which η it would."""
        eta, whole, runs = self.machine.efficiency, Excess(self._indicated).mean, "with no efficiency"
        if whole >= 0:  # the mean is linear in η
            least = 1 - (1 - eta) * whole / (whole - mean)
            printed = next(one for digits in range(4, 17) if (one := round(least, digits)) >= least)
            runs = f"from 'efficiency: {printed}' on"
        return (
            f"the machine cannot run: with the efficiency {eta:g} its driving pistons give a mean torque that is "
            f"{show(-mean, 'torque')} less than driven pistons and friction take; it runs {runs}"
        )

    @cached_property
    def true_excess(self) -> Excess:
        """The excess that changes the kinetic energy: efficiency takes its share of the effort, but not of inertia."""
        lost = [(1 - self.share(mass.drive), mass) for mass in self.masses]
        if not any(share for share, _ in lost):
            return self.excess
        return Excess(Sum(*self.effort.parts, *lost), self.excess.load)

    @cached_property
    def inertia(self) -> "MovingInertia":
        """What the moving masses add to the inertia of the shaft."""
        return MovingInertia(efforts(filter(_moves, self._driving), self.cycle, reduced_inertia), self.cycle)


def _moves(forces: CylinderForces) -> bool:
    """Return whether masses of a cylinder move at a known speed."""
    return forces.drive.has_inertia and bool(forces.drive.mass or forces.drive.pin_inertia)


def _effort(state: State) -> Any:
    return state.M


class MovingInertia:
    """The reduced moment of inertia Σ m x′² + … in kg m² of moving masses, sampled once over the cycle in degrees.

    grid, values: its smooth pieces, and what it is on them; line: the polynomials through it.
    """

    def __init__(self, masses: Sequence[CylinderEffort], cycle: float) -> None:
        whole = Sum(*((1.0, mass) for mass in masses))
        self.grid = whole.cuts.grid() if masses else Grid(np.array([0.0, cycle]))
        self.values: Array = whole.torque(self.grid.degrees, self.grid.within).value
        self.line = Piecewise(self.grid, self.values)

    @cached_property
    def bending(self) -> Piecewise:
        """The polynomials through its slopes by φ."""
        return Piecewise(self.grid, self.line.at(self.grid.degrees, self.grid.within).slope)

    @cached_property
    def mean(self) -> float:
        """Its mean over the cycle."""
        return self.grid.integral(self.values) / math.radians(float(self.grid.breaks[-1]))


def dead_centre_force(forces: CylinderForces, cycle: float) -> Extreme | None:
    """Return the largest force in N of steam and pump in a dead centre of a cylinder, without inertia (R p. 613).

    At the end of the stroke both oppose the motion, and the parts before the pump must stand their sum. None where
    the cylinder does not both drive and drive a pump.
    """
    if not (forces.work_driving and forces.work_driven):
        return None
    drive = forces.drive
    centres = np.add.outer(np.arange(0.0, drive.cycle, 360.0), drive.mechanism.dead_centres()).ravel()
    angles = np.repeat(centres, 2)
    sides = angles + np.tile([-1e-6, 1e-6], len(centres))
    force = drive.jets_at(angles, sides).P_gas
    values = np.asarray(value_of(force))
    largest = int(np.argmax(np.abs(values)))
    return Extreme(float(values[largest]), float(np.mod(angles[largest], cycle)))
