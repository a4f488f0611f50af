"""Key values of `kurbel forces` for one cylinder, or for the same cylinder of many machines."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cache, cached_property
from typing import Any

import numpy as np

from kurbel.arrays import Array
from kurbel.machine import Cylinder, Machine
from kurbel.machine.cylinder import may_lock
from kurbel.mechanisms import KeyOffer, Mechanism, Offer
from kurbel.numerics.arithmetic import every, some, total, where
from kurbel.numerics.extreme import Extreme, Extremes, largest, smallest
from kurbel.quantity import Quantity, for_each, key_value
from kurbel.solver.cycle import SampledCylinder, reversals
from kurbel.solver.drive import Drive
from kurbel.solver.figures import Results, Rows, Searched, column_rows, crank_angles, part, rows_of
from kurbel.solver.friction import redtenbacher_loss
from kurbel.solver.indicated import Indicated
from kurbel.solver.motion import Motion
from kurbel.solver.newton import residual
from kurbel.solver.rod_load import RodLoads
from kurbel.solver.state import State

_RUBBING = {
    "crank_pin": ("Z", "in the crank pin"),
    "crosshead_pin": ("H", "in the crosshead pin"),
    "journals": ("J", "in the journals of the throw"),
}
"""Key of the coefficient of friction -> index of the symbols, and where it rubs."""


class Brake(Results):
    """What the brake has measured against what the indicator shows; None without a brake or an indicated power.

    A machine that is driven takes more at the shaft than its pistons give to the gas: there the efficiency is the
    other way round.
    """

    def __init__(self, machine: Machine, cylinders: Sequence[CylinderForces]) -> None:
        self.machine = machine
        # each once in a turn, a cycle of two turns in every other one
        gases = [(one.drive.own_gas, one.drive.revolutions) for one in cylinders]
        swept = _sum_of_all([None if gas is None else gas.swept_volume / turns for gas, turns in gases])
        self.indicated: Any = _sum_of_all([one.power for one in cylinders])
        """Indicated power in W of all cylinders, negative where they are driven; None where one has none."""
        rate = None if swept is None or machine.speed is None else swept * machine.speed
        self._swept: Any = None if rate is None or every(rate == 0) else rate
        """Volume in m³ that the cylinders' own pistons sweep per second against their pressures; None at rest."""

    @key_value("p_e", "pressure")
    def mean_pressure_brake(self) -> Any:
        """Mean effective pressure: brake work over the swept volume."""
        power = self.machine.brake_power
        return None if power is None or self._swept is None else power / self._swept

    @key_value("p_r", "pressure")
    def mean_pressure_friction(self) -> Any:
        """Friction mean pressure, p_i less p_e.

        p_e less |p_i| where the machine is driven.
        """
        brake, indicated = self.mean_pressure_brake, self.indicated
        if brake is None or indicated is None:
            return None
        return where(indicated < 0, -1.0, 1.0) * (abs(indicated) / self._swept - brake)

    @key_value("η_m", "ratio")
    def eta_m(self) -> Any:
        """Mechanical efficiency: brake power over indicated power.

        Indicated over brake power where the machine is driven.
        """
        power, indicated = self.machine.brake_power, self.indicated
        if power is None or indicated is None or every(power == 0) or every(indicated == 0):
            return None
        drives = indicated > 0
        return where(drives, power, -indicated) / where(drives, indicated, power)


class CylinderForces(SampledCylinder, Results):
    """Key values of the forces of one cylinder, in SI.

    A key value that the machine does not have is None. `at(degrees)` gives the columns. count: number of machines; the
    numbers of machine and cylinder, and all key values, are then arrays (machines,).
    """

    command, state = "forces", State

    def __init__(self, machine: Machine, cylinder: Cylinder, count: int | None = None) -> None:
        self.drive = Drive(machine, cylinder, count)

    @property
    def rows(self) -> Rows:
        """The rows that a machine with this mechanism may have, its pressures counted as in the machine file."""
        mechanism, cylinder, gas = self.mechanism, self.drive.cylinder, self.drive.own_gas
        of_ram = not cylinder.pistons and bool(cylinder.ram_force or mechanism.quick_return)
        return _rows(mechanism.OFFERS, mechanism.KEY_OFFERS, of_ram, bool(gas and gas.absolute))

    @property
    def mechanism(self) -> Mechanism:
        """The mechanism."""
        return self.drive.mechanism

    @property
    def omega(self) -> Any:
        """Angular velocity in rad/s."""
        return self.drive.omega

    @property
    def _of(self) -> str:
        return self.drive.name

    def at(self, degrees: Any, within: Array | None = None) -> State:
        """Return every quantity at crank angles (n,) in degrees: `forces.at([0, 10]).T` in N, …

        At a jump the value on the side that holds `within` (n,) is meant, just after it where that is not given.
        """
        return State.at(self.drive, crank_angles(degrees), within)

    @part(Motion)
    def motion(self) -> Motion:
        """What the mechanism does."""
        return Motion(self.mechanism, self.drive.machine.speed, self.drive.count)

    @key_value("A_H", "area")
    def A_head(self) -> Any:
        """Piston area at the head end."""
        pistons = self.drive.cylinder.pistons
        return pistons[0].head_area if pistons else None

    @key_value("A_C", "area")
    def A_crank(self) -> Any:
        """Piston area at the crank end."""
        pistons = self.drive.cylinder.pistons
        return pistons[0].crank_area if pistons else None

    @key_value("p_max", "pressure", gauge=True)
    def p_max(self) -> Extreme | None:
        """Largest gauge pressure in the cylinder's own piston."""
        if not self.drive.own_gas:
            return None
        gas = self.drive.own_gas
        highest = largest(*(end.highest for end in (gas.head, gas.crank) if end))
        return Extreme(highest.value + gas.base, highest.degrees)

    @key_value("m", "mass")
    def m(self) -> Any:
        """Reciprocating mass with its share of the connecting rod."""
        return self.drive.mass if self.drive.cylinder.masses else None

    extremes = Searched()

    @property
    def _inertia(self) -> list[Extreme]:
        """The inertia forces where the acceleration is largest and smallest; none without masses or speed."""
        turns = (self.motion.b_max, self.motion.b_min) if self.drive.has_inertia else ()
        return [Extreme(-self.drive.mass * one.value, one.degrees) for one in turns if one]

    @key_value("P_b,max", "force", after="P_start_min")
    def P_inertia_max(self) -> Extreme | None:
        """Largest inertia force toward the shaft."""
        return largest(*self._inertia) if self._inertia else None

    @key_value("P_b,min", "force", after="P_start_min")
    def P_inertia_min(self) -> Extreme | None:
        """Largest inertia force away from the shaft, negative."""
        return smallest(*self._inertia) if self._inertia else None

    def extremes_of(self, column: str) -> Extremes | None:
        """Return the extremes in SI of a column that is declared to have them, None where it is left out."""
        found = self._extremes.get(column) if self.drive.has_force else None
        return found or self.motion.extremes_of(column)

    @cached_property
    def _extremes(self) -> dict[str, Extremes]:
        """Those of every column that is declared to have extremes, as far as there is one."""
        declared = column_rows(State, self.mechanism.OFFERS)
        return self.extremes_over(id for id, row in declared.items() if "forces" in row.quantity.extremes)

    def refuse_locking(self) -> None:
        """Raise NoSolutionError where the crosshead locks itself, with an angle that does not depend on a step."""
        if self.drive.count is None and may_lock(self.drive.cylinder):
            self.extremes_of("N")

    # guide and shoe of the crosshead

    @cached_property
    def lifted(self) -> tuple[tuple[float, float], ...]:
        """Stretches of crank angle in degrees on which N presses on the upper guide, R p. 602.

        Empty, too, where there is no guide, no N, or no inclination, so that no guide is the lower one.
        """
        down, side = self.drive.down, self.sampled("N") if self.drive.has_force else None
        if side is None or not down or not (self.mechanism.guided and self.mechanism.has_rod):
            return ()
        turns = self.pieces.zeros(side).degrees.tolist() or [0.0]
        stretches = list(zip(turns, [*turns[1:], turns[0] + self.drive.cycle]))
        middles = np.array([(start + end) / 2 for start, end in stretches])
        pressing = self.pieces.at(side, np.zeros(len(middles), dtype=np.intp), middles) * down
        return tuple(stretch for stretch, force in zip(stretches, pressing) if force < 0)

    @key_value("p_g,max", "pressure", after="T_peak")
    def p_guide_max(self) -> Extreme | None:
        """Largest pressure of the crosshead's shoe on its guide."""
        found = None if self.drive.guide_area is None else self.extremes_of("N")
        if found is None:
            return None
        most = largest(*(Extreme(abs(one.value), one.degrees) for one in found))
        return Extreme(most.value / self.drive.guide_area, most.degrees)

    @key_value("p_g,m", "pressure", after="T_peak")
    def p_guide_mean(self) -> Any:
        """Mean over the way of the shoe's pressure on its guide.

        There and back; None without friction there.
        """
        f, lost, area = self.drive.crosshead_friction, self.friction_works.get("crosshead"), self.drive.guide_area
        if area is None or lost is None or not (self.drive.rubs and some(lost != 0)):
            return None
        return lost / (f * area * self.way)

    @key_value("f N c_max", "power", after="T_peak")
    def wear_max(self) -> Extreme | None:
        """Largest value of the wear line of the guide.

        f |N| |c|.
        """
        found = self.extremes_over(("wear",)) if self.drive.guide_area is not None and self.drive.has_force else {}
        return found["wear"].largest if found else None

    @key_value("f N c_m", "power", after="T_peak")
    def wear_mean(self) -> Any:
        """Mean of the wear line: power lost on the guide."""
        speed, lost = self.drive.machine.speed, self.friction_works.get("crosshead")
        if self.drive.guide_area is None or lost is None or speed is None:
            return None
        return lost * speed / self.drive.revolutions

    # work

    @key_value("φ_P=0", "angle", listed=True)
    def phi_reversal(self) -> tuple[Any, ...] | None:
        """Force reversal: crank angles at which the piston force changes sign.

        P changes sign there, through zero or by a jump. Changes that are noise of a trace count once, at the middle
        one. For many machines one tuple each.
        """
        P = self.sampled("P") if self.drive.has_force else None
        return None if P is None else reversals(self.drive, self.pieces, P)

    @property
    def reversals_in_noise(self) -> int:
        """How many changes of the sign of P are noise of a trace, and are not listed."""
        values = self.sampled("P") if self.drive.noise and self.drive.has_force else None
        return 0 if values is None else len(self.pieces.zeros(values).degrees) - len(self.phi_reversal or ())

    @property
    def works_one_way(self) -> bool:
        """Whether the pistons of the rod all drive or are all driven, so that `work` is the only work."""
        return not (self.work_driving and self.work_driven)

    @cached_property
    def piston_works(self) -> tuple[Any, ...] | None:
        """Indicated work in J per cycle of each piston that has an indicator, in the order of the machine file."""
        return tuple(gas.work for gas in self.drive.gas) if self.drive.gas else None

    @key_value("A_i", "energy")
    def work(self) -> Any:
        """Indicated work of all pistons of the rod per cycle."""
        return None if self.piston_works is None else total(*(w for gas in self.drive.gas for w in gas.works))

    @key_value("A_i+", "energy", unless=lambda forces: forces.works_one_way)
    def work_driving(self) -> Any:
        """Indicated work of the driving pistons per cycle."""
        return None if self.piston_works is None else total(*(where(work > 0, work, 0.0) for work in self.piston_works))

    @key_value("A_i−", "energy", unless=lambda forces: forces.works_one_way)
    def work_driven(self) -> Any:
        """Indicated work of the driven pistons per cycle, negative."""
        return None if self.piston_works is None else total(*(where(work < 0, work, 0.0) for work in self.piston_works))

    @key_value("A_r", "energy")
    def resistance_work(self) -> Any:
        """Work per cycle of what the ram or rocker works against, negative."""
        return self.drive.resistance_work

    @key_value("N_i", "power")
    def power(self) -> Any:
        """Indicated power."""
        speed = self.drive.machine.speed
        if self.work is None or speed is None or every(speed == 0):
            return None
        return self.work * speed / self.drive.revolutions

    @key_value("p_i", "pressure")
    def mean_pressure(self) -> Any:
        """Mean indicated pressure of the cylinder's own piston.

        Its work over the volume that it sweeps.
        """
        gas = self.drive.own_gas
        return None if gas is None else gas.work / gas.swept_volume

    @part(Indicated)
    def indicated(self) -> Indicated | None:
        """Key values of the traces of the cylinder's own piston."""
        return Indicated(self.drive.own_gas) if self.drive.own_gas else None

    @part(Brake)
    def brake(self) -> Brake | None:
        """Key values of the brake, where this is the only cylinder."""
        machine = self.drive.machine
        return Brake(machine, (self,)) if len(machine.cylinders) == 1 and machine.brake_power is not None else None

    @key_value("dA_i/A_i", "ratio")
    def work_sensitivity(self) -> float | None:
        """Change of the indicated work of the traces, over that work, if they are put 0.1 deg later.

        An indicator's dead centre is seldom known better. None without a trace.
        """
        traced = [gas.traced for gas in self.drive.gas if gas.traced]
        work = math.fsum(work for work, _ in traced)
        return math.radians(0.1) * math.fsum(by_angle for _, by_angle in traced) / work if work else None

    @cached_property
    def work_left(self) -> Any:
        """Work in J per cycle that reaches the shaft: indicated, less friction and what the output works against."""
        if not self.drive.has_force:
            return None
        work, lost, resisted = (
            0.0 if one is None else one for one in (self.work, self.friction_work, self.resistance_work)
        )
        return total(work, -lost, resisted)

    @key_value("W", "force")
    def W(self) -> Any:
        """Mean tangential force over the cycle: the resistance.

        What is left of the indicated work over the path of the pin.
        """
        if self.work_left is None:
            return None
        way = 2 * math.pi * self.drive.mechanism.crank * self.drive.revolutions
        return self.work_left / way

    # friction

    def _over_cycle(self, values: Array) -> Any:
        """Return ∮ value dφ of samples (nodes, pieces): a number, or one of every machine."""
        return self.told(self.pieces.integral(values))

    @cached_property
    def friction_works(self) -> dict[str, Any]:
        """Works of friction in J per cycle, by the names in `friction` of what is given; ∮ f |N| |dx| at the crosshead.

        Rings, and what is given as a force, act over all of the path.
        """
        drive, friction, found = self.drive, self.drive.cylinder.friction, dict[str, Any]()
        if friction is None:
            return found
        if friction.crosshead is not None and drive.has_force:
            state = self.samples if drive.rubs else None
            found["crosshead"] = (
                self._over_cycle(state.crosshead_drag * (state.slope * state.direction)) if state else 0.0
            )
        if friction.rings is not None:
            found["rings"] = drive.ring_force * self.way
        if friction.constant is not None:
            found["constant"] = friction.constant * self.way
        return found | self._pin_works(friction.of_pins if drive.has_force else ())

    def _pin_works(self, given: tuple[str, ...]) -> dict[str, Any]:
        """Return the works of friction in pins and journals in J per cycle, by the keys of the given coefficients."""
        rubbing = self.samples.rubbing if given else None
        if rubbing is None:
            return dict.fromkeys(given, 0.0)
        state, shape = self.samples, self.pieces.degrees.shape
        losses = (state.crank_pin_loss, state.crosshead_pin_loss, rubbing.journals)
        moments = (np.broadcast_to(one, shape) for one in losses)
        return {name: self._over_cycle(moment) for name, moment in zip(_RUBBING, moments) if name in given}

    @property
    def way(self) -> Any:
        """Path in m of what slides, there and back, per cycle."""
        return 2 * self.drive.mechanism.stroke * self.drive.revolutions

    @key_value("A_f", "energy")
    def friction_work(self) -> Any:
        """Work lost by friction per cycle."""
        given = self.friction_works.values() if self.drive.has_force else ()
        return total(*given) if given else None

    def _of_driving(self, lost: Any) -> Any:
        """Return lost work in J over the work of the driving pistons; nan for those of many machines without any."""
        driving = self.work_driving
        if lost is None or driving is None or every(driving == 0):
            return None
        return lost / where(driving == 0, math.nan, driving)

    @key_value("e_K", "ratio")
    def loss_crosshead(self) -> Any:
        """Work lost at the crosshead over that of the driving pistons."""
        return self._of_driving(self.friction_works.get("crosshead"))

    @key_value("½ λ f", "ratio", plain="lam f/2")
    def loss_crosshead_redtenbacher(self) -> Any:
        """Redtenbacher's mean over the rod angle of the same loss (D 7)."""
        if "crosshead" not in self.friction_works:
            return None
        return redtenbacher_loss(self.drive.mechanism.lam, self.drive.crosshead_friction)

    @key_value("e_R", "ratio")
    def loss_rings(self) -> Any:
        """Work lost at the piston rings over that of the driving pistons."""
        return self._of_driving(self.friction_works.get("rings"))

    @for_each(_RUBBING, "work_*", "A_f,*", "energy")
    def pin_work_of(self, name: str) -> Any:
        """Work lost * per cycle.

        Of `crank_pin`, `crosshead_pin` or `journals`; None without its friction.
        """
        return self.friction_works.get(name)

    @for_each(_RUBBING, "loss_*", "e_*", "ratio")
    def pin_loss_of(self, name: str) -> Any:
        """Work lost * over that of the driving pistons."""
        return self._of_driving(self.pin_work_of(name))

    @key_value("ΔA/A", "ratio", residual=True)
    def energy_residual(self) -> Any:
        """Energy in minus energy out by an independent quadrature.

        (∮ T R dφ − indicated work + other work) over ∮ |T| R dφ: quadrature of the torque against closed work. With a
        measured trace at equal angles the quadrature follows the straight lines between the samples, the indicated work
        the trapezoid rule: the residual then shows what the spacing of the samples leaves open.
        """
        if self.work_left is None:
            return None
        torque = self.samples.M
        turnover, missed = self._over_cycle(np.abs(torque)), self._over_cycle(torque) - self.work_left
        return where(turnover > 0, missed / where(turnover > 0, turnover, 1.0), 0.0)

    @key_value("r_F", "ratio", residual=True)
    def residual(self) -> float | None:
        """What Newton's law leaves open of the forces, over the largest.

        Of one machine.
        """
        return residual(self)

    # rod load

    @property
    def no_compressor(self) -> bool:
        """Whether the rod load is of no interest: an engine, also a motored four-stroke one, or no connecting rod."""
        work, drive = self.work, self.drive
        return work is None or work >= 0 or drive.revolutions > 1 or not self.mechanism.has_rod

    @part(RodLoads, unless=lambda forces: forces.no_compressor)
    def rod_loads(self) -> RodLoads | None:
        """The rod load, judged after API 618; None where no force acts."""
        columns = ("P_gas", "P_rod", "P_piston_rod") if self.drive.has_force else ()
        loads = {name: values for name in columns if (values := self.sampled(name)) is not None}
        return RodLoads(self.drive, self.pieces, loads) if loads else None


@cache
def _rows(offers: tuple[Offer, ...], key_offers: tuple[KeyOffer, ...], of_ram: bool, absolute: bool) -> Rows:
    """Return the rows of cylinders with these quantities of mechanisms: of a ram without piston, or absolute."""
    known = rows_of(CylinderForces, offers, key_offers)
    return known.changed(Quantity.of_ram if of_ram else Quantity.absolute) if of_ram or absolute else known


def _sum_of_all(values: Sequence[Any]) -> Any:
    """Return the sum of the values of all cylinders; None where one has none."""
    known = [value for value in values if value is not None]
    return total(*known) if known and len(known) == len(values) else None
