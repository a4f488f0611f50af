"""Forces and key values of one cylinder; each is computed when it is asked for, and none depends on a step."""

import math
from collections.abc import Iterator
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from kurbel.arrays import Array
from kurbel.crank_angle import CrankAngle
from kurbel.declared.quantities import Lists
from kurbel.machine import Cylinder, Machine
from kurbel.mechanisms import quantities_of
from kurbel.numerics.arithmetic import every, total, where
from kurbel.numerics.extreme import Extreme, largest, smallest
from kurbel.numerics.grid import Pieces, integral
from kurbel.solver.cylinder.drive import Drive
from kurbel.solver.cylinder.motion import Motion
from kurbel.solver.cylinder.rod_load import RodLoad
from kurbel.solver.cylinder.searched import Searched
from kurbel.solver.cylinder.state import State
from kurbel.solver.figures import Results, crank_angles

if TYPE_CHECKING:
    from kurbel.solver.cylinder.brake import Brake
    from kurbel.solver.cylinder.guide_load import GuideLoad
    from kurbel.solver.cylinder.indicated import Indicated


class CylinderForces(Searched, Results):
    """What `kurbel forces` answers for one cylinder. Attributes are named by the ids of the key values, in SI.

    A key value that the machine does not have is None. `at(degrees)` gives the columns. count: of how many variants the
    numbers of machine and cylinder are, (v,), as `side_by_side` makes them; then so are all key values.
    """

    def __init__(self, machine: Machine, cylinder: Cylinder, count: int | None = None) -> None:
        super().__init__(Drive(machine, cylinder, count), Motion(cylinder.mechanism, machine.speed))

    command = "forces"

    @property
    def lists(self) -> Lists:
        """The quantities that a machine with this mechanism may have, its pressures counted as in the machine file."""
        known, cylinder = quantities_of(self.drive.mechanism), self.drive.cylinder
        if not cylinder.pistons and (cylinder.ram_force or self.drive.mechanism.quick_return):
            return known.of_ram
        gas = self.drive.own_gas
        return known.absolute if gas and gas.absolute else known

    @property
    def _of(self) -> str:
        return self.drive.name

    @property
    def answering(self) -> Iterator[Any]:
        """What answers key values, the first that knows one; the others need not be made for it."""
        yield from (self, self.motion)
        if self.drive.has_force:
            yield from (self.rod_load, self.guide_load)
        if self.drive.own_gas:
            yield self.indicated
            if self.drive.machine.brake_power is not None:
                yield self.brake

    @cached_property
    def rod_load(self) -> RodLoad:
        """The rod load, as compressors are judged by it."""
        from kurbel.solver.cylinder.rod_load import RodLoad

        return RodLoad(self)

    @property
    def guide_load(self) -> "GuideLoad":
        """How hard the crosshead presses on its guide."""
        from kurbel.solver.cylinder.guide_load import GuideLoad

        return GuideLoad(self)

    @cached_property
    def indicated(self) -> "Indicated":
        """What the traces of the cylinder's own piston tell."""
        from kurbel.solver.cylinder.indicated import Indicated

        return Indicated(self.drive.own_gas)

    @cached_property
    def brake(self) -> "Brake | None":
        """What the brake tells, where this is the only cylinder."""
        from kurbel.solver.cylinder.brake import Brake

        machine = self.drive.machine
        return Brake(machine, (self,)) if len(machine.cylinders) == 1 else None

    def at(self, degrees: Any, within: Array | None = None) -> State:
        """Return every quantity at crank angles (n,) in degrees: `forces.at([0, 10]).T` in N, …

        At a jump the value on the side that holds `within` (n,) is meant, just after it where that is not given.
        """
        return self.drive.at(crank_angles(degrees), within)

    @property
    def breaks(self) -> Array:
        """The crank angles in degrees between which every quantity is smooth."""
        return self.grid.breaks

    @cached_property
    def p_max(self) -> Extreme | None:
        """Largest pressure in Pa at either end of the cylinder's own piston, counted as in the machine file."""
        if not self.drive.own_gas:
            return None
        gas = self.drive.own_gas
        highest = largest(*(end.highest for end in (gas.head, gas.crank) if end))
        return Extreme(highest.value + gas.base, highest.degrees)

    def offered(self, id: str) -> Any:
        """Return a key value that the mechanism offers."""
        return self.drive.mechanism.offered(id, self)

    @property
    def omega(self) -> Any:
        """Angular velocity in rad/s."""
        return self.drive.omega

    @property
    def slides(self) -> bool:
        """Whether the output slides, so that its place is told by x."""
        return bool(self.drive.mechanism.slides)

    @cached_property
    def P_inertia_max(self) -> Extreme | None:
        """Largest inertia force −m b in N, R 298."""
        return largest(*self._inertia) if self._inertia else None

    @cached_property
    def P_inertia_min(self) -> Extreme | None:
        """Smallest inertia force in N."""
        return smallest(*self._inertia) if self._inertia else None

    @property
    def _inertia(self) -> list[Extreme]:
        """The inertia forces where the acceleration is largest and smallest; none without masses or speed."""
        turns = (self.motion.b_max, self.motion.b_min) if self.drive.has_inertia else ()
        return [Extreme(-self.drive.mass * one.value, one.degrees) for one in turns if one]

    @property
    def A_head(self) -> Any:
        """Area in m² of the cylinder's own piston at the head end."""
        pistons = self.drive.cylinder.pistons
        return pistons[0].head_area if pistons else None

    @property
    def A_crank(self) -> Any:
        """Area in m² of the cylinder's own piston at the crank end."""
        pistons = self.drive.cylinder.pistons
        return pistons[0].crank_area if pistons else None

    @property
    def m(self) -> Any:
        """Reciprocating mass in kg; None where no masses are given."""
        return self.drive.mass if self.drive.cylinder.masses else None

    # work

    @property
    def works_one_way(self) -> bool:
        """Whether the works of driving and driven pistons do not differ from the whole: not both hang on the rod."""
        return not (self.work_driving and self.work_driven)

    @cached_property
    def piston_works(self) -> tuple[Any, ...] | None:
        """Indicated work in J per cycle of each piston that has an indicator, in the order of the machine file."""
        return tuple(gas.work for gas in self.drive.gas) if self.drive.gas else None

    @cached_property
    def work(self) -> Any:
        """Indicated work in J per cycle of all pistons on the rod."""
        return None if self.piston_works is None else total(*(w for gas in self.drive.gas for w in gas.works))

    @cached_property
    def work_driving(self) -> Any:
        """Sum in J of the positive indicated works: what the driving pistons give."""
        return None if self.piston_works is None else total(*(where(work > 0, work, 0.0) for work in self.piston_works))

    @cached_property
    def work_driven(self) -> Any:
        """Sum in J of the negative indicated works: what the driven pistons take."""
        return None if self.piston_works is None else total(*(where(work < 0, work, 0.0) for work in self.piston_works))

    @cached_property
    def power(self) -> Any:
        """Indicated power in W; None without a speed or at rest."""
        speed = self.drive.machine.speed
        if self.work is None or speed is None or every(speed == 0):
            return None
        return self.work * speed / self.drive.revolutions

    @cached_property
    def mean_pressure(self) -> Any:
        """Mean indicated pressure p_i of the cylinder's own piston in Pa: its work over the volume it sweeps."""
        gas = self.drive.own_gas
        return None if gas is None else gas.work / gas.swept_volume

    @cached_property
    def work_sensitivity(self) -> float | None:
        """Change of the indicated work of the measured traces if they are put 0.1° later, over that work.

        An indicator's dead centre is seldom known better. None without a trace.
        """
        traced = [gas.traced for gas in self.drive.gas if gas.traced]
        work = math.fsum(work for work, _ in traced)
        return math.radians(0.1) * math.fsum(by_angle for _, by_angle in traced) / work if work else None

    @cached_property
    def crosshead_work(self) -> Any:
        """∮ f |N| |dx| in J per cycle."""
        if not self.drive.has_force or not self.drive.rubs:
            return 0.0 if self._has_crosshead else None
        if self.drive.pin_friction:  # whose couple bends N where a load all but vanishes
            return float(integral(self.grid, lambda pieces: np.asarray(self._on(pieces).crosshead_power)))
        return self.grid.integral(self.samples.crosshead_power)

    @property
    def _has_crosshead(self) -> bool:
        friction = self.drive.cylinder.friction
        return self.drive.has_force and friction is not None and friction.crosshead is not None

    @cached_property
    def ring_work(self) -> Any:
        """Work of ring friction in J per cycle: the ring force over every stroke."""
        friction = self.drive.cylinder.friction
        if friction is None or friction.rings is None:
            return None
        return self.drive.ring_force * self.way

    @cached_property
    def constant_work(self) -> Any:
        """Work of the friction that is given as a force, in J per cycle."""
        friction = self.drive.cylinder.friction
        return None if friction is None or friction.constant is None else friction.constant * self.way

    @cached_property
    def _pin_works(self) -> dict[str, float]:
        """Works of friction in pins and journals in J per cycle, by the keys of the coefficients that are given."""
        friction = self.drive.cylinder.friction
        given = friction.of_pins if friction and self.drive.has_force else ()
        if not given or self.drive.pin_friction is None:
            return dict.fromkeys(given, 0.0)
        from kurbel.solver.cylinder.pin_works import pin_works

        return pin_works(self.drive, self.grid, given)

    def pin_work_of(self, name: str) -> float | None:
        """Return the work of friction in J per cycle of `crank_pin`, `crosshead_pin` or `journals`; None without it."""
        return self._pin_works.get(name)

    def pin_loss_of(self, name: str) -> Any:
        """Return the same over the work of the driving pistons."""
        return self._of_driving(self.pin_work_of(name))

    @property
    def way(self) -> Any:
        """The way in m of what slides, there and back, per cycle."""
        return 2 * self.drive.mechanism.stroke * self.drive.revolutions

    @cached_property
    def friction_work(self) -> Any:
        """Work of all friction in J per cycle."""
        if not self.drive.has_force:
            return None
        every = (self.crosshead_work, self.ring_work, self.constant_work, *self._pin_works.values())
        given = [work for work in every if work is not None]
        return total(*given) if given else None

    @cached_property
    def resistance_work(self) -> Any:
        """Work in J per cycle of what the ram, or a swinging output, works against; negative."""
        return self.drive.resistance_work

    @cached_property
    def work_left(self) -> Any:
        """Work in J per cycle that reaches the shaft: indicated, less friction and what the output works against."""
        if not self.drive.has_force:
            return None
        work, lost, resisted = (
            0.0 if one is None else one for one in (self.work, self.friction_work, self.resistance_work)
        )
        return total(work, -lost, resisted)

    @cached_property
    def W(self) -> Any:
        """Mean tangential force in N over the cycle: what is left of the indicated work over the way of the pin."""
        if self.work_left is None:
            return None
        way = 2 * math.pi * self.drive.mechanism.crank * self.drive.revolutions
        return self.work_left / way

    @cached_property
    def loss_crosshead(self) -> Any:
        """Work lost at the crosshead over that of the driving pistons."""
        return self._of_driving(self.crosshead_work)

    @cached_property
    def loss_crosshead_redtenbacher(self) -> Any:
        """½ λ f, D 7."""
        if not self._has_crosshead:
            return None
        from kurbel.solver.cylinder.friction import redtenbacher_loss

        return redtenbacher_loss(self.drive.mechanism.lam, self.drive.crosshead_friction)

    @cached_property
    def loss_rings(self) -> Any:
        """Work lost at the rings over that of the driving pistons."""
        return self._of_driving(self.ring_work)

    def _of_driving(self, lost: Any) -> Any:
        """Return work lost in J over that of the driving pistons; of variants that have none it is nan."""
        driving = self.work_driving
        if lost is None or driving is None or every(driving == 0):
            return None
        return lost / where(driving == 0, math.nan, driving)

    @cached_property
    def energy_residual(self) -> float | None:
        """(∮ T R dφ − indicated work + other work) over ∮ |T| R dφ: another quadrature against closed work.

        The work of friction is itself a quadrature on the pieces of the grid. This one shares none of them, nor a node,
        searches anew where the guide changes sides, and cuts its pieces until they agree: an error of either shows.

        With a measured trace at equal angles the quadrature follows the straight lines between the samples, the
        indicated work the trapezoid rule: the residual then shows what the spacing of the samples leaves open.
        """
        if self.work_left is None:
            return None
        turnover = self.grid.integral(np.abs(self.samples.M))
        pieces = self.drive.pieces.other()
        if self._is_cut:
            pieces = self.cut_at_bends(pieces, self.drive.on(pieces))
        return float(integral(pieces, self._torque) - self.work_left) / turnover if turnover else 0.0

    def _torque(self, pieces: Pieces) -> Array:
        return np.asarray(self._on(pieces).M)

    def _on(self, pieces: Pieces) -> State:
        return State(self.drive, CrankAngle.at_nodes(pieces))
