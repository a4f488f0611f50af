"""How hard the crosshead's shoe presses on its guide, and wears it."""

from typing import TYPE_CHECKING, Any

from kurbel.numerics.arithmetic import some
from kurbel.numerics.extreme import Extreme, largest

if TYPE_CHECKING:
    from kurbel.solver.cylinder.forces import CylinderForces


class GuideLoad:
    """Loads of one guide. Attributes are named by the ids of the key values, in SI; None without a shoe."""

    def __init__(self, forces: "CylinderForces") -> None:
        self._forces = forces
        self._area = forces.drive.guide_area

    @property
    def p_guide_max(self) -> Extreme | None:
        """Largest pressure of the crosshead's shoe on its guide in Pa."""
        found = self._forces.extremes_of("N")
        if self._area is None or found is None:
            return None
        most = largest(*(Extreme(abs(one.value), one.degrees) for one in found))
        return Extreme(most.value / self._area, most.degrees)

    @property
    def p_guide_mean(self) -> Any:
        """Mean pressure in Pa of the shoe on its guide over the way there and back; None without friction there."""
        f, lost = self._forces.drive.crosshead_friction, self._forces.crosshead_work
        if self._area is None or lost is None or not (self._forces.drive.rubs and some(lost != 0)):
            return None
        return lost / (f * self._area * self._forces.way)

    @property
    def wear_max(self) -> Extreme | None:
        """Largest value of the wear line f |N| |c| in W."""
        found = self._forces.extremes_over(("wear",)) if self._area is not None else {}
        return found["wear"].largest if found else None

    @property
    def wear_mean(self) -> Any:
        """Mean of the wear line over time in W."""
        speed, lost = self._forces.drive.machine.speed, self._forces.crosshead_work
        if self._area is None or lost is None or speed is None:
            return None
        return lost * speed / self._forces.drive.revolutions
