"""Indicated work, power, friction and mechanical efficiency of the whole machine, from the works of its cylinders."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from functools import cached_property
from typing import Any, NamedTuple

from kurbel.machine import Machine
from kurbel.numerics.arithmetic import every, total, where
from kurbel.quantity import value
from kurbel.solver.figures import Results
from kurbel.solver.forces import CylinderForces, power_of_work

_PRINTED = ("flywheel", "forces")
"""The commands that have the key values; limits take those of the first."""


class PistonWorks(NamedTuple):
    """Indicated work of driving and of driven pistons, negative, and work of the loads on rams, negative if moved, in J."""

    driving: Any
    driven: Any
    loads: Any


class TotalWork(Results):
    """Key values of the work of all pistons; None for a machine without pistons.

    Works are those of a cycle of the machine, which may be several of a cylinder.
    """

    command = "forces"
    work_indicated = value(
        "A_Σ",
        "energy",
        "Indicated work of all driving pistons per cycle; of all driven ones if none drives",
        lambda machine_work: machine_work.indicated_work,
        plain="A_sum",
        commands=_PRINTED,
    )
    power_indicated = value(
        "N_Σ",
        "power",
        "Indicated power of the whole machine: of all driving pistons; of all driven ones if none drives",
        lambda machine_work: machine_work.power_of_work(machine_work.indicated_work),
        plain="N_sum",
        commands=_PRINTED,
    )
    work_friction = value(
        "A_f,Σ",
        "energy",
        "Work lost by friction in all cylinders per cycle",
        lambda machine_work: machine_work.friction_work,
        plain="A_f,sum",
        commands=_PRINTED,
        repeats=lambda machine_work: machine_work.is_of_one_cylinder,
    )
    power_friction = value(
        "N_f,Σ",
        "power",
        "Power lost by friction in all cylinders",
        lambda machine_work: machine_work.power_of_work(machine_work.friction_work),
        plain="N_f,sum",
        commands=_PRINTED,
        repeats=lambda machine_work: machine_work.is_of_one_cylinder,
    )
    mechanical_efficiency = value(
        "η_g",
        "ratio",
        "Mechanical efficiency of the whole machine: work at the shaft and of driven pistons over the work put in",
        lambda machine_work: machine_work.useful_share,
        unless=lambda machine_work: (
            machine_work.useful_share is not None
            and every(abs(machine_work.useful_share - 1) <= 1e-12)
        ),
        commands=_PRINTED,
    )

    def __init__(
        self,
        machine: Machine,
        cylinders: Sequence[CylinderForces],
        mean_torque: Callable[[], Any],
    ) -> None:
        """Take the mean torque in N m with the losses of the machine as a function, which the efficiency alone calls."""
        self.machine, self.cylinders, self._mean_torque = machine, tuple(cylinders), mean_torque

    @property
    def is_of_one_cylinder(self) -> bool:
        """Whether the only cylinder has the same friction."""
        return len(self.cylinders) == 1

    @cached_property
    def piston_works(self) -> PistonWorks | None:
        """The work of all cylinders per cycle of the machine; None without pistons."""
        if self.machine.effort is not None:
            return None
        works = list[PistonWorks]()
        for cylinder in self.cylinders:
            if cylinder.work is None:
                continue
            cycles = self.machine.revolutions / cylinder.drive.revolutions
            works.append(
                PistonWorks(
                    cylinder.work_driving * cycles,
                    cylinder.work_driven * cycles,
                    cylinder.drive.output_work * cycles,
                )
            )
        if not works:
            return None
        return PistonWorks(*(total(*of_cylinders) for of_cylinders in zip(*works)))

    @property
    def indicated_work(self) -> Any:
        """Indicated work in J per cycle of the driving pistons; of the driven ones if none drives."""
        works = self.piston_works
        return works and where(works.driving > 0, works.driving, works.driven)

    @cached_property
    def friction_work(self) -> Any:
        """Work of friction in J per cycle of the machine; None where no cylinder has friction."""
        works = []
        for cylinder in self.cylinders:
            lost = cylinder.friction_work
            if lost is not None:
                works.append(lost * (self.machine.revolutions / cylinder.drive.revolutions))
        if not works:
            return None
        return total(*works)

    def power_of_work(self, work: Any) -> Any:
        """Return the power in W of a work in J per cycle of the machine; None without a speed, and at rest."""
        return power_of_work(work, self.machine.speed, self.machine.revolutions)

    @cached_property
    def useful_share(self) -> Any:
        """Work given off at the shaft and by driven pistons over that put in by driving ones and at the shaft."""
        works = self.piston_works
        if works is None:
            return None
        # the work at the shaft, with the losses of the machine
        work = self._mean_torque() * (2 * math.pi * self.machine.revolutions)
        put_in = (
            works.driving + where(work < 0, -work, 0.0) + where(works.loads > 0, works.loads, 0.0)
        )
        given_off = (
            where(work > 0, work, 0.0) - works.driven - where(works.loads < 0, works.loads, 0.0)
        )
        if every(put_in == 0):
            return None
        return given_off / where(put_in == 0, math.nan, put_in)
