"""What a state of a cylinder tells of its chambers beside the pressure: volumes, and the rise of pressure."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from kurbel.crank_angle import CrankAngle
    from kurbel.solver.cylinder.drive import Drive
    from kurbel.solver.cylinder.gas import PistonGas


class OfChamber:
    """The columns of the chambers, as `State` has them; None where the cylinder has no such chamber."""

    drive: Drive
    angle: CrankAngle
    slope: Any
    x: Any

    @property
    def V(self) -> Any:
        """Volume of the head-end chamber in m³, with its clearance where that is given."""
        gas = self.drive.own_gas
        return gas.piston.head_area * self._way + gas.clearance_volumes[0] if gas and gas.head else None

    @property
    def V_crank(self) -> Any:
        """Volume of the crank-end chamber in m³, with its clearance where that is given."""
        gas = self.drive.own_gas
        if not (gas and gas.crank):
            return None
        return gas.piston.crank_area * (self.drive.mechanism.stroke - self._way) + gas.clearance_volumes[1]

    @property
    def dV(self) -> Any:
        """Change of the volume of the head-end chamber in m³ per degree."""
        gas = self.drive.own_gas
        return gas.piston.head_area * np.radians(1.0) * self.slope if gas and gas.head else None

    @property
    def dp_head(self) -> Any:
        """Rise of the head-end pressure in Pa per degree; None without a trace."""
        return self._rise(self.drive.own_gas, "head")

    @property
    def dp_crank(self) -> Any:
        """Rise of the crank-end pressure in Pa per degree; None without a trace."""
        return self._rise(self.drive.own_gas, "crank")

    @property
    def _way(self) -> Any:
        return self.x - self.drive.mechanism.start

    def _rise(self, gas: PistonGas | None, end: str) -> Any:
        rise = getattr(getattr(gas, end, None), "rise", None)
        return rise(self.angle.degrees) if rise else None
