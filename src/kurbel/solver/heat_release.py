"""Key values of the heat release in a chamber of a cylinder."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from kurbel.numerics.arithmetic import every
from kurbel.numerics.extreme import Extreme
from kurbel.quantity import value
from kurbel.solver.figures import Results
from kurbel.solver.gas import PistonGas


class HeatRelease(Results):
    """The key values of the heat release of a cylinder's own piston, in SI."""

    heat_released = value("Q_b", "energy", "Heat released per cycle, less what the walls take")
    phi_burnt_05 = value(
        "φ_05", "angle", "Angle after the firing dead centre at which 5 % of the heat is released"
    )
    phi_burnt_50 = value(
        "φ_50", "angle", "Angle after the firing dead centre at which half the heat is released"
    )
    phi_burnt_90 = value(
        "φ_90", "angle", "Angle after the firing dead centre at which 90 % of the heat is released"
    )
    heat_rate_max = value("dQ_max", "energy", "Largest heat released over 1 deg of crank angle")
    indicated_efficiency = value(
        "η_i",
        "ratio",
        "Indicated efficiency: work of the chamber over the heat of its fuel",
        wanted_large=True,
    )

    def __init__(self, gas: PistonGas) -> None:
        self.gas = gas

    @cached_property
    def answers(self) -> dict[str, object]:
        """The key values, of the first end that has a heat release."""
        heat = self.gas.heat
        if heat is None:
            return {}
        released = heat.released
        rate, after = released.fastest
        degrees = np.mod(after + heat.setting.own_dead_centre, heat.setting.cycle)
        supplied = released.supplied
        efficiency = None
        if supplied is not None and every(supplied > 0):
            efficiency = heat.work / supplied
        return {
            "indicated_efficiency": efficiency,
            "heat_released": released.total,
            "phi_burnt_05": released.angle_at(0.05),
            "phi_burnt_50": released.angle_at(0.5),
            "phi_burnt_90": released.angle_at(0.9),
            "heat_rate_max": Extreme(rate, degrees),
        }
