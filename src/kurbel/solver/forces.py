"""Key values of `kurbel forces` for one cylinder, or for the same cylinder of many machines.

Rod loads are judged after API 618: unless crosshead pin and bush part once in every turn, no oil comes between them on
the loaded side. The standard asks for 15° of crank angle and 3 % of the larger load in the other direction; it takes
both every 5°, kurbel at the roots.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from functools import cached_property
from typing import Any

import numpy as np

from kurbel.arrays import Array, Indices
from kurbel.declared.quantities import Lists
from kurbel.machine import Cylinder, Machine
from kurbel.mechanisms import quantities_of
from kurbel.numerics.arithmetic import every, some, total, where
from kurbel.numerics.extreme import Extreme, Extremes, largest, smallest
from kurbel.solver.cycle import SampledCylinder
from kurbel.solver.drive import Drive
from kurbel.solver.figures import Results, crank_angles
from kurbel.solver.friction import redtenbacher_loss
from kurbel.solver.indicated import Indicated
from kurbel.solver.motion import Motion
from kurbel.solver.newton import residual
from kurbel.solver.state import State


class CylinderForces(SampledCylinder, Results):
    """Key values of the forces of one cylinder: attributes named by their ids, in SI.

    A key value that the machine does not have is None. `at(degrees)` gives the columns. count: number of machines; the
    numbers of machine and cylinder, and all key values, are then arrays (machines,).
    """

    command = "forces"

    def __init__(self, machine: Machine, cylinder: Cylinder, count: int | None = None) -> None:
        self.drive = Drive(machine, cylinder, count)
        self.motion = Motion(cylinder.mechanism, machine.speed, count)

    @property
    def answering(self) -> Iterator[Any]:
        """The objects that have key values, searched in this order; each is made only if those before it lack one."""
        yield from (self, self.motion)
        if self.drive.own_gas:
            yield self.indicated
            if self.drive.machine.brake_power is not None:
                yield self.brake

    @cached_property
    def indicated(self) -> Indicated:
        """Key values of the traces of the cylinder's own piston."""
        return Indicated(self.drive.own_gas)

    @property
    def brake(self) -> Brake | None:
        """Key values of the brake, where this is the only cylinder."""
        machine = self.drive.machine
        return Brake(machine, (self,)) if len(machine.cylinders) == 1 else None

    # key values

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

    def at(self, degrees: Any, within: Array | None = None) -> State:
        """Return every quantity at crank angles (n,) in degrees: `forces.at([0, 10]).T` in N, …

        At a jump the value on the side that holds `within` (n,) is meant, just after it where that is not given.
        """
        return self.drive.at(crank_angles(degrees), within)

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
        """Whether the output slides, so that x gives its position."""
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
        """Whether the pistons of the rod all drive or are all driven, so that `work` is the only work."""
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
        return self._over_cycle(self.samples.crosshead_power)

    def _over_cycle(self, values: Array) -> Any:
        """Return ∮ value dφ of samples (nodes, pieces): a number, or one of every machine."""
        return self.told(self.pieces.integral(values))

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
    def _pin_works(self) -> dict[str, Any]:
        """Works of friction in pins and journals in J per cycle, by the keys of the coefficients that are given."""
        friction = self.drive.cylinder.friction
        given = friction.of_pins if friction and self.drive.has_force else ()
        rubbing = self.samples.rubbing if given else None
        if rubbing is None:
            return dict.fromkeys(given, 0.0)
        moments = {"crank_pin": rubbing.crank_pin, "crosshead_pin": rubbing.crosshead_pin, "journals": rubbing.journals}
        shape = self.pieces.degrees.shape
        return {name: self._over_cycle(np.broadcast_to(moments[name], shape)) for name in given}

    def pin_work_of(self, name: str) -> float | None:
        """Return the work of friction in J per cycle of `crank_pin`, `crosshead_pin` or `journals`; None without it."""
        return self._pin_works.get(name)

    def pin_loss_of(self, name: str) -> Any:
        """Return the same over the work of the driving pistons."""
        return self._of_driving(self.pin_work_of(name))

    @property
    def way(self) -> Any:
        """Path in m of what slides, there and back, per cycle."""
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
        return redtenbacher_loss(self.drive.mechanism.lam, self.drive.crosshead_friction)

    @cached_property
    def loss_rings(self) -> Any:
        """Work lost at the rings over that of the driving pistons."""
        return self._of_driving(self.ring_work)

    def _of_driving(self, lost: Any) -> Any:
        """Return lost work in J over the work of the driving pistons; nan for those of many machines without any."""
        driving = self.work_driving
        if lost is None or driving is None or every(driving == 0):
            return None
        return lost / where(driving == 0, math.nan, driving)

    @cached_property
    def residual(self) -> float | None:
        """What Newton's law leaves open of the forces, over the largest; of one machine."""
        return residual(self)

    @cached_property
    def energy_residual(self) -> Any:
        """(∮ T R dφ − indicated work + other work) over ∮ |T| R dφ: quadrature of the torque against closed work.

        With a measured trace at equal angles the quadrature follows the straight lines between the samples, the
        indicated work the trapezoid rule: the residual then shows what the spacing of the samples leaves open.
        """
        if self.work_left is None:
            return None
        torque = self.samples.M
        turnover, missed = self._over_cycle(np.abs(torque)), self._over_cycle(torque) - self.work_left
        return where(turnover > 0, missed / where(turnover > 0, turnover, 1.0), 0.0)

    # rod load

    @property
    def no_compressor(self) -> bool:
        """Whether the rod load is of no interest: an engine, also a motored four-stroke one, or no connecting rod."""
        work, drive = self.work, self.drive
        return work is None or work >= 0 or drive.revolutions > 1 or not drive.mechanism.has_rod

    @cached_property
    def _rod_loads(self) -> dict[str, Extremes]:
        return self.extremes_over(("P_gas", "P_rod", "P_piston_rod")) if self.drive.has_force else {}

    def compression_max(self, column: str) -> Extreme | None:
        """Return the largest force in N toward the shaft; 0, where it comes nearest, if none."""
        found = self._rod_loads.get(column)
        return found and _at_least_zero(found.largest.value, found.largest.degrees)

    def tension_max(self, column: str) -> Extreme | None:
        """Return the size of the largest force in N away from the shaft; 0, where it comes nearest, if none."""
        found = self._rod_loads.get(column)
        return found and _at_least_zero(-found.smallest.value, found.smallest.degrees)

    @cached_property
    def phi_rod_reversal(self) -> tuple[Any, ...] | None:
        """Crank angles in degrees at which the rod load changes sign; changes within the noise of a trace count once.

        For many machines one tuple each.
        """
        return self.reversals_of("P_rod") if self.drive.has_force else None

    @cached_property
    def _reversed(self) -> Array | None:
        """Degrees of crank angle per cycle on which the rod is pressed, or pulled, whichever is less, (2, machines).

        All of them, and the longest stretch; 0 where the load does not reverse, None without one.
        """
        values = self.sampled("P_rod") if self.drive.has_force else None
        if values is None or self.phi_rod_reversal is None:
            return None
        each = [self.phi_rod_reversal] if self.drive.count is None else self.phi_rod_reversal
        machine = np.repeat(np.arange(len(each)), [len(one) for one in each])
        start = np.array([angle for one in each for angle in one])
        first, last = np.flatnonzero(np.diff(machine, prepend=-1)), np.flatnonzero(np.diff(machine, append=-1))
        end = np.append(start[1:], 0.0)[: len(start)]
        end[last] = start[first] + self.drive.cycle
        presses = self.pieces.at(values, machine, (start + end) / 2) > 0
        pressed, pulled = (_stretches(machine[way], (end - start)[way], len(each)) for way in (presses, ~presses))
        return np.where(pulled[0] < pressed[0], pulled, pressed)

    @property
    def reversal_angle(self) -> Any:
        """Degrees of crank angle per cycle of the reversed load; 0 where it does not reverse."""
        return None if self._reversed is None else self.told(self._reversed[0])

    @property
    def reversal_longest(self) -> Any:
        """The longest of its stretches in degrees."""
        return None if self._reversed is None else self.told(self._reversed[1])

    @property
    def reversal_ratio(self) -> Any:
        """Smaller peak of the rod load over the larger one; 0 where it does not reverse."""
        angle, peaks = self.reversal_angle, self._rod_loads.get("P_rod")
        if angle is None or peaks is None or not some(angle > 0):
            return angle
        pressed, pulled = (abs(one.value) for one in peaks)
        ratio = where(pressed < pulled, pressed, pulled) / where(pressed < pulled, pulled, pressed)
        return where(angle > 0, ratio, 0.0)

    # the shoe of the crosshead

    @property
    def p_guide_max(self) -> Extreme | None:
        """Largest pressure of the crosshead's shoe on its guide in Pa."""
        found = None if self.drive.guide_area is None else self.extremes_of("N")
        if found is None:
            return None
        most = largest(*(Extreme(abs(one.value), one.degrees) for one in found))
        return Extreme(most.value / self.drive.guide_area, most.degrees)

    @property
    def p_guide_mean(self) -> Any:
        """Mean pressure in Pa of the shoe on its guide over the way there and back; None without friction there."""
        f, lost, area = self.drive.crosshead_friction, self.crosshead_work, self.drive.guide_area
        if area is None or lost is None or not (self.drive.rubs and some(lost != 0)):
            return None
        return lost / (f * area * self.way)

    @property
    def wear_max(self) -> Extreme | None:
        """Largest value of the wear line f |N| |c| in W."""
        found = self.extremes_over(("wear",)) if self.drive.guide_area is not None and self.drive.has_force else {}
        return found["wear"].largest if found else None

    @property
    def wear_mean(self) -> Any:
        """Mean of the wear line over time in W."""
        speed, lost = self.drive.machine.speed, self.crosshead_work
        if self.drive.guide_area is None or lost is None or speed is None:
            return None
        return lost * speed / self.drive.revolutions


class Brake:
    """What the brake has measured against what the indicator shows; None without a brake or an indicated power.

    A machine that is driven takes more at the shaft than its pistons give to the gas: there the efficiency is the
    other way round.
    """

    def __init__(self, machine: Machine, cylinders: Sequence[CylinderForces]) -> None:
        self.machine, self.cylinders = machine, cylinders

    @cached_property
    def indicated(self) -> Any:
        """Indicated power in W of all cylinders, negative where they are driven; None where one has none."""
        powers = [forces.power for forces in self.cylinders]
        known = [power for power in powers if power is not None]
        return total(*known) if known and len(known) == len(powers) else None

    @cached_property
    def _swept(self) -> Any:
        """Volume in m³ that the cylinders' own pistons sweep per second against their pressures; None at rest."""
        speed, volumes = self.machine.speed, list(map(_swept_rate, self.cylinders))
        known = [volume for volume in volumes if volume is not None]
        whole = total(*known) if known and len(known) == len(volumes) else None
        return None if whole is None or speed is None or every(whole * speed == 0) else whole * speed

    @property
    def mean_pressure_brake(self) -> Any:
        """p_e in Pa: brake power over the volume swept in a second."""
        power = self.machine.brake_power
        return None if power is None or self._swept is None else power / self._swept

    @property
    def mean_pressure_friction(self) -> Any:
        """p_r in Pa: |p_i| less p_e, or p_e less |p_i| where the machine is driven."""
        brake, indicated = self.mean_pressure_brake, self.indicated
        if brake is None or indicated is None:
            return None
        return where(indicated < 0, -1.0, 1.0) * (abs(indicated) / self._swept - brake)

    @property
    def eta_m(self) -> Any:
        """Brake over indicated power, or indicated over brake power where the machine is driven."""
        power, indicated = self.machine.brake_power, self.indicated
        if power is None or indicated is None or every(power == 0) or every(indicated == 0):
            return None
        drives = indicated > 0
        return where(drives, power, -indicated) / where(drives, indicated, power)


def _swept_rate(forces: CylinderForces) -> float | None:
    """Return the volume in m³ per turn that a cylinder's own piston sweeps against its pressures, once in a cycle."""
    gas = forces.drive.own_gas
    return None if gas is None else gas.swept_volume / forces.drive.revolutions


def _stretches(whose: Indices, degrees: Array, count: int) -> Array:
    """Return the sum of the stretches (n,) of each of `count` machines, and the longest, (2, count)."""
    longest = np.zeros(count)
    np.maximum.at(longest, whose, degrees)
    return np.stack((np.bincount(whose, degrees, count), longest))


def _at_least_zero(value: Any, degrees: Any) -> Extreme:
    return Extreme(where(value > 0, value, 0.0), degrees)
