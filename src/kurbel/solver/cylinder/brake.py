"""What the brake has measured against what the indicator shows."""

import math
from collections.abc import Sequence
from functools import cached_property
from typing import TYPE_CHECKING

from kurbel.machine import Machine

if TYPE_CHECKING:
    from kurbel.solver.cylinder.forces import CylinderForces


class Brake:
    """Mean pressures and mechanical efficiency of a whole machine; None without a brake or an indicated power.

    A machine that is driven takes more at the shaft than its pistons give to the gas: there the efficiency is the
    other way round.
    """

    def __init__(self, machine: Machine, cylinders: "Sequence[CylinderForces]") -> None:
        self.machine = machine
        self.cylinders = cylinders

    @cached_property
    def indicated(self) -> float | None:
        """Indicated power in W of all cylinders, negative where they are driven; None where one has none."""
        powers = [forces.power for forces in self.cylinders]
        known = [power for power in powers if power is not None]
        return math.fsum(known) if known and len(known) == len(powers) else None

    @cached_property
    def _swept(self) -> float | None:
        """Volume in m³ that the cylinders' own pistons sweep per second against their pressures."""
        speed, volumes = self.machine.speed, list(map(_swept_rate, self.cylinders))
        known = [volume for volume in volumes if volume is not None]
        return math.fsum(known) * speed if speed and len(known) == len(volumes) and known else None

    @property
    def mean_pressure_brake(self) -> float | None:
        """p_e in Pa: brake power over the volume swept in a second."""
        power = self.machine.brake_power
        return None if power is None or not self._swept else power / self._swept

    @property
    def mean_pressure_friction(self) -> float | None:
        """p_r in Pa: |p_i| less p_e, or p_e less |p_i| where the machine is driven."""
        brake = self.mean_pressure_brake
        if brake is None or self.indicated is None or not self._swept:
            return None
        return math.copysign(1.0, self.indicated) * (abs(self.indicated) / self._swept - brake)

    @property
    def eta_m(self) -> float | None:
        """Brake over indicated power, or indicated over brake power where the machine is driven."""
        power, indicated = self.machine.brake_power, self.indicated
        if not power or not indicated:
            return None
        return power / indicated if indicated > 0 else -indicated / power


def _swept_rate(forces: "CylinderForces") -> float | None:
    """Return the volume in m³ per turn that a cylinder's own piston sweeps against its pressures, once in a cycle."""
    gas = forces.drive.own_gas
    return None if gas is None else gas.swept_volume / forces.drive.revolutions
