"""Work and power of single pistons, and the brake beside the indicated power of all."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cached_property
from typing import Any, Protocol

from kurbel.arrays import Number
from kurbel.machine import Machine
from kurbel.numerics.arithmetic import every, total, where
from kurbel.quantity import value
from kurbel.solver.drive import Drive
from kurbel.solver.figures import Results
from kurbel.solver.gas import PistonGas


class PoweredCylinder(Protocol):
    """A cylinder with its indicated power in W, None without one."""

    drive: Drive

    @property
    def power(self) -> Any:
        """Its indicated power."""


class Brake(Results):
    """Brake power compared with indicated power; None without one of them.

    A driven machine takes more power at the shaft than its pistons give to the gas: there p_r = p_e − |p_i|, and the
    efficiency is indicated over brake power. indicated: power in W of all cylinders, negative where they are driven;
    None where one has none.
    """

    mean_pressure_brake = value(
        "p_e", "pressure", "Mean effective pressure: brake work over the swept volume"
    )
    mean_pressure_friction = value("p_r", "pressure", "Friction mean effective pressure, p_i − p_e")
    eta_m = value("η_m", "ratio", "Mechanical efficiency: brake power over indicated power")

    def __init__(self, machine: Machine, cylinders: Sequence[PoweredCylinder]) -> None:
        self.machine, self.cylinders = machine, cylinders
        self.indicated: Any = _sum_of_all([cylinder.power for cylinder in cylinders])

    @cached_property
    def answers(self) -> dict[str, object]:
        """The key values."""
        answers = dict[str, object]()
        power, indicated = self.machine.brake_power, self.indicated
        if power is None:
            return answers
        swept = self._swept_per_turn
        rate = None if swept is None or self.machine.speed is None else swept * self.machine.speed
        if rate is not None and not every(rate == 0):
            p_e = power / rate
            answers["mean_pressure_brake"] = p_e
            if indicated is not None:
                sense = where(indicated < 0, -1.0, 1.0)
                answers["mean_pressure_friction"] = sense * (abs(indicated) / rate - p_e)
        if indicated is not None and not every(power == 0) and not every(indicated == 0):
            drives = indicated > 0
            answers["eta_m"] = where(drives, power, -indicated) / where(drives, indicated, power)
        return answers

    @property
    def _swept_per_turn(self) -> Any:
        """Swept volume of all cylinders in m³ per turn: each sweeps once in a cycle; None where one has none."""
        volumes = list[Any]()
        for cylinder in self.cylinders:
            gas = cylinder.drive.own_gas
            volumes.append(None if gas is None else gas.swept_volume / cylinder.drive.revolutions)
        return _sum_of_all(volumes)


class PistonWork(Results):
    """Work and power of one of several pistons of a rod."""

    command = "forces"
    work = value(
        "A_i", "energy", "Indicated work of the piston per cycle", lambda piston: piston.gas.work
    )
    power = value(
        "N_i",
        "power",
        "Indicated power of the piston",
        lambda piston: None if piston.rate is None else piston.gas.work * piston.rate,
    )
    mean_pressure = value(
        "p_i",
        "pressure",
        "Mean indicated pressure of the piston",
        lambda piston: piston.gas.work / piston.gas.swept_volume,
    )

    def __init__(self, name: str, gas: PistonGas, rate: Number | None) -> None:
        """Take the name, the pressures, and cycles per second, None without a speed."""
        self.name, self.gas, self.rate = name, gas, rate


def _sum_of_all(values: Sequence[Any]) -> Any:
    """Return the sum of the values of all cylinders; None where one has none."""
    if not values or any(value is None for value in values):
        return None
    return total(*values)
