"""Forces and key values of one cylinder; each is computed when it is asked for, and none depends on a step."""

from __future__ import annotations

import math
from collections.abc import Iterable
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from kurbel.crank_angle import CrankAngle
from kurbel.machine import Cylinder, Machine
from kurbel.machine.cylinder import may_lock
from kurbel.mechanisms import quantities_of
from kurbel.numerics.extreme import Extreme
from kurbel.numerics.grid import Grid, Pieces, integral
from kurbel.numerics.search import Curve, Evaluate, Extremes, Sampled, curves, extremes_of, lasting, sign_changes, zeros
from kurbel.solver.cylinder.drive import Drive
from kurbel.solver.cylinder.motion import Motion
from kurbel.solver.cylinder.state import State
from kurbel.solver.figures import Results, answered, crank_angles

if TYPE_CHECKING:
    from kurbel.arrays import Array
    from kurbel.declared.quantities import Lists
    from kurbel.numerics.where import Where
    from kurbel.solver.cylinder.brake import Brake
    from kurbel.solver.cylinder.indicated import Indicated
    from kurbel.solver.cylinder.pin_works import PinWorks
    from kurbel.solver.cylinder.rod_load import RodLoad


_SURE = 4.0
"""Standard deviations that the noise of thousands of samples does not reach."""


class CylinderForces(Results):
    """What `kurbel forces` answers for one cylinder. Attributes are named by the ids of the key values, in SI.

    A key value that the machine does not have is None. `at(degrees)` gives the columns.
    """

    def __init__(self, machine: Machine, cylinder: Cylinder) -> None:
        self.drive = Drive(machine, cylinder)
        self.motion = Motion(cylinder.mechanism, machine.speed)

    command = "forces"

    @property
    def lists(self) -> Lists:
        """The quantities that a machine with this mechanism may have, its pressures counted as in the machine file."""
        known = quantities_of(self.drive.mechanism)
        gas = self.drive.own_gas
        return known.absolute if gas and gas.absolute else known

    @property
    def _of(self) -> str:
        return self.drive.name

    @property
    def answering(self) -> tuple[Any, ...]:
        """What answers key values, the first that knows one."""
        gas, brake = self.drive.own_gas, self.drive.machine.brake_power
        return (
            self,
            self.motion,
            *((self.rod_load, self.pin_works) if self.drive.has_force else ()),
            *((self.indicated,) if gas else ()),
            *((self.brake,) if gas and brake is not None else ()),
        )

    @cached_property
    def pin_works(self) -> PinWorks:
        """Works of friction in pins and journals."""
        from kurbel.solver.cylinder.pin_works import PinWorks

        return PinWorks(self)

    @cached_property
    def rod_load(self) -> RodLoad:
        """The rod load, as compressors are judged by it."""
        from kurbel.solver.cylinder.rod_load import RodLoad

        return RodLoad(self)

    @cached_property
    def indicated(self) -> Indicated:
        """What the traces of the cylinder's own piston tell."""
        from kurbel.solver.cylinder.indicated import Indicated

        return Indicated(self.drive.own_gas)

    @cached_property
    def brake(self) -> Brake | None:
        """What the brake tells, where this is the only cylinder."""
        from kurbel.solver.cylinder.brake import Brake

        machine = self.drive.machine
        return Brake(machine, (self,)) if len(machine.cylinders) == 1 else None

    def __getattr__(self, id: str) -> Any:
        """Return a key value that is no attribute here: extremes, and what the motion or the mechanism has."""
        quantity = self.lists.key_values("forces").get(id) if "drive" in self.__dict__ else None
        if quantity is None:
            raise AttributeError(f"no key value is called {id}")
        return answered(self.answering, quantity)

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
    def grid(self) -> Grid:
        """The cycle in smooth pieces, cut also where the guide force changes sides, if friction makes that a kink."""
        return self._cut_at_turns(self.drive.cuts.grid())

    def _cut_at_turns(self, grid: Grid) -> Grid:
        """Return the grid cut where the guide force changes sides, and where a force on a pin all but vanishes."""
        pins = self.drive.pin_friction
        if self.drive.crosshead_friction:
            # what makes pins rub bends where N changes sides without them; only beside that are the true turns exact
            for rubs in (False, True) if pins else (True,):
                grid = grid.split_at(self._turns(grid, rubs))
        return grid.split_at(pins.bends(grid)) if pins and self.drive.has_force else grid

    def _turns(self, grid: Grid, rubs: bool) -> Array:
        """Return where the guide force changes sides; rubs: with the friction of the pins."""

        def sides(degrees: Array, within: Array) -> dict[str, Sampled]:
            state = self.drive.jets_at(degrees, within)
            return _sampled(state if rubs else state.unrubbed, ("guide_sense",))

        return zeros(grid, sides(grid.degrees, grid.within), sides)["guide_sense"]

    def _quantities(self, *names: str) -> Evaluate:
        return lambda degrees, within: _sampled(self.drive.jets_at(degrees, within), names)

    @cached_property
    def _samples(self) -> State:
        return self.drive.jets_at(self.grid.degrees, self.grid.within, self.grid.beyond)

    @cached_property
    def _curves(self) -> dict[str, Curve]:
        declared = quantities_of(self.drive.mechanism).all_columns
        return self.searched(*(one.id for one in declared if "forces" in one.extremes))

    def searched(self, *columns: str) -> dict[str, Curve]:
        """Return the curves over the cycle of those of these columns that there are."""
        names = [name for name in columns if getattr(self._samples, name) is not None]
        return curves(self.grid, _sampled(self._samples, names), self._quantities(*names)) if names else {}

    def extremes_of(self, column: str) -> Extremes | None:
        """Return the extremes in SI of a column that is declared to have them, None where it is left out."""
        if column == "S" and self.drive.rod:
            # S of an exact rod stands between the masses at its ends: what it must bear is the force at its pins
            return self._at_pins
        curve = self._curves.get(column) if self.drive.has_force else None
        return extremes_of(curve) if curve else self.motion.extremes_of(column)

    def refuse_locking(self) -> None:
        """Raise NoSolutionError where the crosshead locks itself, with an angle that does not depend on a step."""
        if may_lock(self.drive.cylinder):
            self.extremes_of("N")

    @property
    def _at_pins(self) -> Extremes | None:
        """Largest and smallest force in N along an exact rod, of both pins."""
        found = [one for end in ("S_crosshead", "S_crank") if (one := self.extremes_of(end))]
        if not found:
            return None
        largest, smallest = zip(*found, strict=True)
        return Extremes(max(largest, key=lambda one: one.value), min(smallest, key=lambda one: one.value))

    def angles_where(self, column: str, value: float) -> Where | None:
        """Return where in the cycle a column has a value in SI; None for a column that is left out."""
        if getattr(self._samples, column) is None:
            return None
        from kurbel.numerics.where import where

        samples, evaluate = _sampled(self._samples, (column,))[column], self._quantities(column)
        return where(self.grid, samples, lambda *place: evaluate(*place)[column], value)

    @cached_property
    def p_max(self) -> Extreme | None:
        """Largest pressure in Pa at either end of the cylinder's own piston, counted as in the machine file."""
        if not self.drive.own_gas:
            return None
        found = [extremes_of(curve).largest for curve in self.searched("p_head", "p_crank").values()]
        return max(found, key=lambda one: one.value)

    def offered(self, id: str) -> Any:
        """Return a key value that the mechanism offers."""
        return self.drive.mechanism.offered(id, self)

    @property
    def omega(self) -> float | None:
        """Angular velocity in rad/s."""
        return self.drive.omega

    @property
    def slides(self) -> bool:
        """Whether the output slides, so that its place is told by x."""
        return self.drive.mechanism.slides

    @cached_property
    def P_inertia_max(self) -> Extreme | None:
        """Largest inertia force −m b in N, R 298."""
        return max(self._inertia, default=None)

    @cached_property
    def P_inertia_min(self) -> Extreme | None:
        """Smallest inertia force in N."""
        return min(self._inertia, default=None)

    @property
    def _inertia(self) -> list[Extreme]:
        """The inertia forces where the acceleration is largest and smallest; none without masses or speed."""
        turns = (self.motion.b_max, self.motion.b_min) if self.drive.has_inertia else ()
        return [Extreme(-self.drive.mass * one.value, one.degrees) for one in turns if one]

    @cached_property
    def phi_reversal(self) -> tuple[float, ...] | None:
        """Druckwechsel: crank angles in degrees at which P takes the other sign, through zero or by a jump.

        Of those that are the noise of a trace alone the middle one stands for all.
        """
        return self.reversals_of("P", self._curves.get("P") if self.drive.has_force else None)

    def reversals_of(self, column: str, curve: Curve | None) -> tuple[float, ...] | None:
        """Return the crank angles in degrees at which a force of the gas takes the other sign for longer than noise."""
        changes = self._changes(column, curve)
        if changes is None or curve is None:
            return None
        return tuple(lasting(curve, changes, _SURE * self._noise).tolist())

    def _changes(self, column: str, curve: Curve | None) -> Array | None:
        return None if curve is None else sign_changes(self.grid, {column: curve}, self._quantities(column))[column]

    @property
    def reversals_in_noise(self) -> int:
        """How many changes of the sign of P are the noise of a trace alone, and not told."""
        # without noise nothing is within it, and no reversal need be searched to tell so
        return len(self._reversals) - len(self.phi_reversal or ()) if self._noise and self._reversals is not None else 0

    @cached_property
    def _reversals(self) -> Array | None:
        return self._changes("P", self._curves.get("P") if self.drive.has_force else None)

    @property
    def _noise(self) -> float:
        """Standard deviation in N of the noise that traces bring into P."""
        return math.hypot(*(gas.noise for gas in self.drive.gas))

    @cached_property
    def lifted(self) -> tuple[tuple[float, float], ...]:
        """Stretches of crank angle in degrees on which N presses on the upper guide, R p. 602.

        Empty, too, where there is no guide, no N, or no inclination that says which guide is the lower one.
        """
        down, side = self.drive.down, self._curves.get("N") if self.drive.has_force else None
        if side is None or not down or not (self.drive.mechanism.guided and self.drive.mechanism.has_rod):
            return ()
        turns = sign_changes(self.grid, {"N": side}, self._quantities("N"))["N"].tolist() or [0.0]
        stretches = list(zip(turns, [*turns[1:], turns[0] + self.drive.cycle]))
        pressing = np.asarray(self.at([(start + end) / 2 for start, end in stretches]).N) * down
        return tuple(stretch for stretch, force in zip(stretches, pressing) if force < 0)

    @property
    def p_guide_max(self) -> Extreme | None:
        """Largest pressure of the crosshead's shoe on its guide in Pa."""
        area, found = self.drive.guide_area, self.extremes_of("N")
        if not area or found is None:
            return None
        most = max(found, key=lambda extreme: abs(extreme.value))
        return Extreme(abs(most.value) / area, most.degrees)

    @property
    def p_guide_mean(self) -> float | None:
        """Mean pressure in Pa of the shoe on its guide over the way there and back; None without friction there."""
        area, f = self.drive.guide_area, self.drive.crosshead_friction
        return self.crosshead_work / (f * area * self._way) if self.crosshead_work and area and f else None

    @property
    def wear_max(self) -> Extreme | None:
        """Largest value of the wear line f |N| |c| in W."""
        if self.drive.guide_area is None:
            return None
        return max((extremes_of(curve).largest for curve in self.searched("wear").values()), default=None)

    @property
    def wear_mean(self) -> float | None:
        """Mean of the wear line over time in W."""
        speed = self.drive.machine.speed
        lost = self.crosshead_work if self.drive.guide_area else None
        return None if lost is None or speed is None else lost * speed / self.drive.revolutions

    @property
    def A_head(self) -> float | None:
        """Area in m² of the cylinder's own piston at the head end."""
        pistons = self.drive.cylinder.pistons
        return pistons[0].head_area if pistons else None

    @property
    def A_crank(self) -> float | None:
        """Area in m² of the cylinder's own piston at the crank end."""
        pistons = self.drive.cylinder.pistons
        return pistons[0].crank_area if pistons else None

    @property
    def m(self) -> float | None:
        """Reciprocating mass in kg; None where no masses are given."""
        return self.drive.mass if self.drive.cylinder.masses else None

    # work

    @property
    def works_one_way(self) -> bool:
        """Whether the works of driving and driven pistons do not differ from the whole: not both hang on the rod."""
        return not (self.work_driving and self.work_driven)

    @cached_property
    def piston_works(self) -> tuple[float, ...] | None:
        """Indicated work in J per cycle of each piston that has an indicator, in the order of the machine file."""
        return tuple(gas.work for gas in self.drive.gas) if self.drive.gas else None

    @cached_property
    def work(self) -> float | None:
        """Indicated work in J per cycle of all pistons on the rod."""
        return None if self.piston_works is None else math.fsum(w for gas in self.drive.gas for w in gas.works)

    @cached_property
    def work_driving(self) -> float | None:
        """Sum in J of the positive indicated works: what the driving pistons give."""
        return None if self.piston_works is None else math.fsum(work for work in self.piston_works if work > 0)

    @cached_property
    def work_driven(self) -> float | None:
        """Sum in J of the negative indicated works: what the driven pistons take."""
        return None if self.piston_works is None else math.fsum(work for work in self.piston_works if work < 0)

    @cached_property
    def power(self) -> float | None:
        """Indicated power in W; None without a speed or at rest."""
        speed = self.drive.machine.speed
        return None if self.work is None or not speed else self.work * speed / self.drive.revolutions

    @cached_property
    def mean_pressure(self) -> float | None:
        """Mean indicated pressure p_i of the cylinder's own piston in Pa: its work over the volume it sweeps."""
        gas = self.drive.own_gas
        return None if gas is None else gas.work / gas.swept_volume

    @property
    def swept_rate(self) -> float | None:
        """Volume in m³ per turn that the cylinder's own piston sweeps against its pressures, once in a cycle."""
        gas = self.drive.own_gas
        return None if gas is None else gas.swept_volume / self.drive.revolutions

    @cached_property
    def work_sensitivity(self) -> float | None:
        """Change of the indicated work of the measured traces if they are put 0.1° later, over that work.

        An indicator's dead centre is seldom known better. None without a trace.
        """
        traced = [gas.traced for gas in self.drive.gas if gas.traced]
        work = math.fsum(work for work, _ in traced)
        return math.radians(0.1) * math.fsum(by_angle for _, by_angle in traced) / work if work else None

    @cached_property
    def crosshead_work(self) -> float | None:
        """∮ f |N| |dx| in J per cycle."""
        if not self.drive.has_force or not self.drive.crosshead_friction:
            return 0.0 if self._has_crosshead else None
        if self.drive.pin_friction:  # whose couple bends N where a load all but vanishes
            return float(integral(self.grid, lambda pieces: np.asarray(self._on(pieces).crosshead_power)))
        return self.grid.integral(self._samples.crosshead_power.value)

    @property
    def _has_crosshead(self) -> bool:
        friction = self.drive.cylinder.friction
        return self.drive.has_force and friction is not None and friction.crosshead is not None

    @cached_property
    def ring_work(self) -> float | None:
        """Work of ring friction in J per cycle: the ring force over every stroke."""
        friction = self.drive.cylinder.friction
        if friction is None or friction.rings is None:
            return None
        return self.drive.ring_force * self._way

    @cached_property
    def constant_work(self) -> float | None:
        """Work of the friction that is given as a force, in J per cycle."""
        friction = self.drive.cylinder.friction
        return None if friction is None or friction.constant is None else friction.constant * self._way

    @property
    def _way(self) -> float:
        """The way in m of what slides, there and back, per cycle."""
        return 2 * self.drive.mechanism.stroke * self.drive.revolutions

    @cached_property
    def friction_work(self) -> float | None:
        """Work of all friction in J per cycle."""
        if not self.drive.has_force:
            return None
        every = (self.crosshead_work, self.ring_work, self.constant_work, *self.pin_works.all)
        given = [work for work in every if work is not None]
        return math.fsum(given) if given else None

    @cached_property
    def resistance_work(self) -> float | None:
        """Work in J per cycle of what the ram, or a swinging output, works against; negative."""
        return self.drive.resistance_work

    @cached_property
    def work_left(self) -> float | None:
        """Work in J per cycle that reaches the shaft: indicated, less friction and what the output works against."""
        if not self.drive.has_force:
            return None
        return math.fsum((self.work or 0.0, -(self.friction_work or 0.0), self.resistance_work or 0.0))

    @cached_property
    def W(self) -> float | None:
        """Mean tangential force in N over the cycle: what is left of the indicated work over the way of the pin."""
        if self.work_left is None:
            return None
        way = 2 * math.pi * self.drive.mechanism.crank * self.drive.revolutions
        return self.work_left / way

    @cached_property
    def loss_crosshead(self) -> float | None:
        """Work lost at the crosshead over that of the driving pistons."""
        return None if self.crosshead_work is None or not self.work_driving else self.crosshead_work / self.work_driving

    @cached_property
    def loss_crosshead_redtenbacher(self) -> float | None:
        """½ λ f, D 7."""
        if not self._has_crosshead:
            return None
        from kurbel.solver.cylinder.friction import redtenbacher_loss

        return redtenbacher_loss(self.drive.mechanism.lam, self.drive.crosshead_friction)

    @cached_property
    def loss_rings(self) -> float | None:
        """Work lost at the rings over that of the driving pistons."""
        return None if self.ring_work is None or not self.work_driving else self.ring_work / self.work_driving

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
        turnover = self.grid.integral(np.abs(self._samples.M.value))
        pieces = self._cut_at_turns(self.drive.cuts.grid().other())
        return float(integral(pieces, self._torque) - self.work_left) / turnover if turnover else 0.0

    def _torque(self, pieces: Pieces) -> Array:
        return np.asarray(self._on(pieces).M)

    def _on(self, pieces: Pieces) -> State:
        return State(self.drive, CrankAngle.of(pieces.degrees, pieces.beyond))


def _sampled(state: State, names: Iterable[str]) -> dict[str, Sampled]:
    return {name: Sampled.of(getattr(state, name), state.phi.shape) for name in names}
