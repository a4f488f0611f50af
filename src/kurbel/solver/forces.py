"""Key values of `kurbel forces` for one cylinder, or for the same cylinder of many machines."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache, cached_property
from itertools import chain
from typing import TYPE_CHECKING, Any

import numpy as np

from kurbel.arrays import Array, Number
from kurbel.machine import Cylinder, Machine
from kurbel.machine.cylinder import may_lock, work_alike
from kurbel.mechanisms import KeyOffer, Mechanism, Offer
from kurbel.numerics.arithmetic import every, some, total, where
from kurbel.numerics.extreme import Extreme, Extremes, largest, smallest
from kurbel.numerics.pieces import resolved
from kurbel.quantity import Heading, Quantity, value, values_for
from kurbel.solver.books_of_friction import mean_by_integral, mean_by_logarithm
from kurbel.solver.cycle import SampledCylinder, reversals, shared
from kurbel.solver.drive import Drive
from kurbel.solver.figures import (
    ExtremesOfColumns,
    Results,
    Rows,
    column_rows,
    crank_angles,
    part,
    result_rows,
)
from kurbel.solver.motion import Motion
from kurbel.solver.newton import residual
from kurbel.solver.piston_works import Brake, PistonWork
from kurbel.solver.rod_load import RodLoads
from kurbel.solver.state import State

if TYPE_CHECKING:
    from kurbel.solver.heat_release import HeatRelease
    from kurbel.solver.indicated import Indicated
    from kurbel.solver.valve import ValveGear


def _indicated() -> type[Indicated]:
    from kurbel.solver.indicated import Indicated

    return Indicated


def _heat_release() -> type[HeatRelease]:
    from kurbel.solver.heat_release import HeatRelease

    return HeatRelease


def _valve_gear() -> type[ValveGear]:
    from kurbel.solver.valve import ValveGear

    return ValveGear


SLIDING = {
    "crosshead": ("K", "at the crosshead"),
    "rings": ("R", "at the piston rings"),
    "guides": ("F", "at the guides of the yoke"),
}
"""Key of the friction of what slides along the stroke line -> index of the symbols, and the place of the friction."""
RUBBING = {
    "crank_pin": ("Z", "in the crank pin"),
    "crosshead_pin": ("H", "in the crosshead pin"),
    "journals": ("J", "in the journals of the throw"),
    "block": ("B", "at the block in the yoke"),
}
"""The same of the friction of what turns, or slides along the slot of a yoke."""
_PLACES = {**SLIDING, "constant": ("c", "by the constant force"), **RUBBING}


def share_of_driving(forces: CylinderForces, name: str) -> Any:
    """Return a work of friction over the work of the driving pistons; nan for machines of many without such pistons."""
    return _over_driving(forces, forces.friction_works.get(name))


def _over_driving(forces: CylinderForces, lost: Any) -> Any:
    """Return a work in J over that of the driving pistons, None without either."""
    driving = forces.work_driving
    if lost is None or driving is None or every(driving == 0):
        return None
    return lost / where(driving == 0, math.nan, driving)


def power_of_work(work: Any, speed: Any, revolutions: int) -> Any:
    """Return the power in W of a work in J in so many turns; None without a speed in turns per second, and at rest."""
    if work is None or speed is None or every(speed == 0):
        return None
    return work * speed / revolutions


def _power_of_work(forces: CylinderForces, work: Any) -> Any:
    """Return the power in W of a work in J per cycle of a cylinder."""
    return power_of_work(work, forces.drive.machine.speed, forces.drive.revolutions)


def _rubs_at_one_place(forces: CylinderForces) -> bool:
    """Return whether friction is given at one place, so that what is lost there is all that is lost."""
    return len(forces.friction_works) == 1


class CylinderForces(SampledCylinder, Results):
    """Key values of the forces of one cylinder, in SI.

    A key value that the machine does not have is None. `at(degrees)` gives the columns. count: number of machines; the
    numbers of machine and cylinder, and all key values, are then arrays (machines,).
    """

    command, state = "forces", State
    twin: CylinderForces | None

    def __init__(
        self,
        machine: Machine,
        cylinder: Cylinder,
        count: int | None = None,
        twin: CylinderForces | None = None,
    ) -> None:
        self.drive, self.twin = Drive(machine, cylinder, count), twin
        self.mechanism: Mechanism = cylinder.mechanism
        self.omega = self.drive.omega

    def is_like(self, other: Cylinder) -> bool:
        """Return whether another cylinder of the machine has the same motion and forces, wherever it is on the shaft.

        Where journals rub, each carries what its own throw carries.
        """
        if self.drive.links:
            return False
        friction = self.drive.pin_friction
        if friction is not None and friction.line is not None and some(friction.journals != 0):
            return False
        return work_alike(self.drive.cylinder, other)

    @property
    def rows(self) -> Rows:
        """The rows that a machine with this mechanism may have, its pressures counted as in the machine file."""
        mechanism, cylinder, gas = self.mechanism, self.drive.cylinder, self.drive.own_gas
        is_loaded = cylinder.ram_force is not None or cylinder.force is not None
        of_ram = not cylinder.pistons and bool(is_loaded or mechanism.quick_return)
        absolute = bool(gas and gas.absolute)
        return _rows(
            mechanism.OFFERS, mechanism.KEY_OFFERS, of_ram, absolute, mechanism.guided, self.closed
        )

    @property
    def _of(self) -> str:
        return self.drive.name

    def at(self, degrees: object, within: Array | None = None) -> State:
        """Return every quantity at crank angles (n,) in degrees: `forces.at([0, 10]).T` in N, …

        At a jump the value on the side that holds `within` (n,) is meant, just after it where that is not given.
        """
        return State.at(self.drive, crank_angles(degrees), within)

    # the key values, in the order in which they are printed

    @part(Motion)
    def motion(self) -> Motion:
        """What the mechanism does."""
        if self.twin:
            return self.twin.motion
        return Motion(self.mechanism, self.drive.machine.speed, self.drive.count)

    @part(_valve_gear, there=lambda forces: forces.drive.cylinder.valve is not None)
    def valve_gear(self) -> ValveGear | None:
        """What the valve does."""
        cylinder = self.drive.cylinder
        if not cylinder.valve:
            return None
        return _valve_gear()(cylinder.valve, cylinder, self.motion)

    _pressures = Heading("Pressures and work")
    A_head = value("A_H", "area", "Piston area at the head end")
    A_crank = value(
        "A_C",
        "area",
        "Piston area at the crank end",
        repeats=lambda forces: forces.open_at_crank_end,
    )
    p_max = value(
        "p_max", "pressure", "Largest gauge pressure on the cylinder's own piston", gauge=True
    )
    _forces = Heading("Forces")
    m = value("m", "mass", "Reciprocating mass, including its share of the connecting rod")
    extremes = ExtremesOfColumns()
    P_inertia_max = value(
        "P_b,max",
        "force",
        "Largest inertia force toward the shaft",
        lambda forces: largest(*forces.inertia_extremes) if forces.inertia_extremes else None,
        after="P_start_min",
        repeats=lambda forces: forces.inertia_alone,
    )
    P_inertia_min = value(
        "P_b,min",
        "force",
        "Largest inertia force away from the shaft, negative",
        lambda forces: smallest(*forces.inertia_extremes) if forces.inertia_extremes else None,
        after="P_start_min",
        repeats=lambda forces: forces.inertia_alone,
    )
    p_guide_max = value(
        "p_g,max",
        "pressure",
        "Largest pressure of the crosshead shoe on its guide",
        lambda forces: forces.on_guide.get("p_guide_max"),
        after="T_peak",
    )
    p_guide_mean = value(
        "p_g,m",
        "pressure",
        "Mean pressure of the crosshead shoe on its guide over both strokes",
        lambda forces: forces.on_guide.get("p_guide_mean"),
        after="T_peak",
    )
    wear_max = value(
        "f N c_max",
        "power",
        "Largest friction power on the guide",
        lambda forces: forces.on_guide.get("wear_max"),
        after="T_peak",
    )
    wear_mean = value(
        "f N c_m",
        "power",
        "Mean friction power on the guide",
        lambda forces: forces.on_guide.get("wear_mean"),
        after="T_peak",
    )
    phi_reversal = value(
        "φ_P=0",
        "angle",
        "Force reversal: crank angles at which the piston force changes sign",
        lambda forces: forces.changes_of_force[0],
        listed=True,
    )
    _work = Heading("Pressures and work")
    work = value("A_i", "energy", "Indicated work of all pistons of the rod per cycle")
    work_driving = value(
        "A_i+",
        "energy",
        "Indicated work of the driving pistons per cycle",
        unless=lambda forces: forces.works_one_way,
    )
    work_driven = value(
        "A_i−",
        "energy",
        "Indicated work of the driven pistons per cycle, negative",
        unless=lambda forces: forces.works_one_way,
    )
    resistance_work = value(
        "A_r", "energy", "Work per cycle of the resistance at the ram or rocker, negative"
    )
    load_work = value(
        "A_L",
        "energy",
        "Work per cycle of the load `force` on the output, negative where the machine moves it",
    )
    power = value("N_i", "power", "Indicated power")
    mean_pressure = value("p_i", "pressure", "Mean indicated pressure of the cylinder's own piston")

    p_rise_max = value(
        "dp/dφ_max",
        "pressure_rise",
        "Largest rate of pressure rise, over 1 deg of crank angle",
        lambda forces: forces.drive.own_gas.steepest if forces.drive.own_gas else None,
        after="discharge_loss",
    )
    V_clearance = value(
        "V_c", "volume", "Clearance volume of the head-end chamber", after="mean_pressure_exchange"
    )

    @part(
        _indicated,
        there=lambda forces: bool(forces.drive.own_gas and forces.drive.own_gas.has_trace),
    )
    def indicated(self) -> Indicated | None:
        """Key values of the traces of the cylinder's own piston."""
        gas = self.drive.own_gas
        return _indicated()(gas) if gas and gas.has_trace else None

    @part(
        _heat_release,
        there=lambda forces: bool(forces.drive.own_gas and forces.drive.own_gas.releases_heat),
    )
    def heat_release(self) -> HeatRelease | None:
        """Key values of the heat release over the cylinder's own piston."""
        gas = self.drive.own_gas
        return _heat_release()(gas) if gas and gas.releases_heat else None

    @part(Brake)
    def brake(self) -> Brake | None:
        """Key values of the brake, where this is the only cylinder."""
        machine = self.drive.machine
        is_only = len(machine.cylinders) == 1
        return Brake(machine, (self,)) if is_only and machine.brake_power is not None else None

    work_sensitivity = value(  # an indicator's dead centre is seldom known better
        "dA_i/A_i",
        "ratio",
        "Relative change of the indicated work for a shift of the traces by +0.1 deg",
    )
    _resistance = Heading("Forces")
    W = value(
        "W",
        "force",
        "Mean tangential force over the cycle: the resistance",
        lambda forces: (
            None
            if forces.work_left is None
            else forces.work_left
            / (2 * math.pi * forces.mechanism.crank * forces.drive.revolutions)
        ),
    )
    _friction = Heading("Friction")
    friction_work = value(
        "A_f",
        "energy",
        "Work lost by friction per cycle",
        lambda forces: (
            total(*forces.friction_works.values())
            if forces.drive.has_force and forces.friction_works
            else None
        ),
    )
    friction_power = value(
        "N_f",
        "power",
        "Power lost by friction: its work times cycles per second",
        lambda forces: _power_of_work(forces, forces.friction_work),
    )
    friction_loss = value(
        "e_f",
        "ratio",
        "Friction loss: work lost over that of the driving pistons",
        lambda forces: _over_driving(forces, forces.friction_work),
    )
    friction_force_mean = value(
        "F_m",
        "force",
        "Redtenbacher's mean crosshead friction ½ λ f |P|_m (D 6)",
        lambda forces: forces.mean_crosshead_friction(),
    )
    loss_of_sliding = values_for(
        SLIDING,
        "loss_*",
        "e_*",
        "ratio",
        "Work lost * over that of the driving pistons",
        of=share_of_driving,
        repeats=_rubs_at_one_place,
    )
    loss_crosshead_redtenbacher = value(
        "½ λ f",
        "ratio",
        "The same loss by Redtenbacher's mean over the rod angle (D 7)",
        lambda forces: forces.of_crosshead(lambda lam, f: lam * f / 2),
        plain="lam f/2",
        after="loss_crosshead",
        of_book=True,
    )
    loss_crosshead_logarithm = value(
        "e_ln",
        "ratio",
        "The same loss with his cos β ≈ 1, sin β ≈ β: 1 − ln(1 + λ f)/(λ f) (D, after 5)",
        lambda forces: forces.of_crosshead(mean_by_logarithm),
        after="loss_crosshead",
        of_book=True,
    )
    loss_crosshead_integral = value(
        "e_β",
        "ratio",
        "The same loss by his integral over the rod angle β from 0 to λ, without approximation (D 5)",
        lambda forces: forces.of_crosshead(mean_by_integral),
        after="loss_crosshead",
        of_book=True,
    )
    pin_work = values_for(
        RUBBING,
        "work_*",
        "A_f,*",
        "energy",
        "Work lost * per cycle",
        of=lambda forces, name: forces.friction_works.get(name),
        repeats=_rubs_at_one_place,
    )
    pin_loss = values_for(
        RUBBING,
        "loss_*",
        "e_*",
        "ratio",
        "Work lost * over that of the driving pistons",
        of=share_of_driving,
        repeats=_rubs_at_one_place,
    )
    power_of_places = values_for(
        _PLACES,
        "friction_power_*",
        "N_f,*",
        "power",
        "Power lost *",
        of=lambda forces, name: _power_of_work(forces, forces.friction_works.get(name)),
        repeats=_rubs_at_one_place,
    )
    _checks = Heading("Checks")
    energy_residual = value(
        "ΔA/A",
        "ratio",
        "Energy balance of the cycle over ∮ |T| R dφ, by an independent quadrature",
        lambda forces: forces.energy_balance(),
        residual=True,
    )
    residual = value(
        "r_F",
        "ratio",
        "Residual of Newton's law for the forces, relative to the largest force",
        residual,
        residual=True,
    )

    _rod_load = Heading("Rod load")

    @part(RodLoads, unless=lambda forces: forces.no_compressor)
    def rod_loads(self) -> RodLoads | None:
        """The rod load, judged after API 618; None where no force acts."""
        if not self.drive.has_force:
            return None
        loads = {}
        for name in ("P_gas", "P_rod", "P_piston_rod"):
            values = self.sampled(name)
            if values is not None:
                loads[name] = values
        if not loads:
            return None
        return RodLoads(self.drive, self.pieces, loads)

    @shared
    def answers(self) -> dict[str, object]:
        """The key values that follow from dimensions and pressures alone, without samples of forces."""
        drive, pistons = self.drive, self.drive.cylinder.pistons
        answers = dict[str, object]()
        answers["m"] = drive.mass if drive.cylinder.masses else None
        answers["resistance_work"] = drive.resistance_work
        answers["load_work"] = drive.load and drive.load.work
        if pistons:
            answers["A_head"] = pistons[0].head_area
            answers["A_crank"] = pistons[0].crank_area

        # of the cylinder's own piston
        gas = drive.own_gas
        if gas:
            highest = largest(*(end.highest for end, _ in gas.ends))
            answers["p_max"] = Extreme(highest.value + gas.base, highest.degrees)
            answers["mean_pressure"] = gas.work / gas.swept_volume
            volume = gas.clearance_volumes[0] if gas.head else 0.0
            if some(volume != 0):  # of many machines nan where it is not known
                answers["V_clearance"] = where(volume == 0, math.nan, volume)

        # of all pistons of the rod
        if drive.gas:
            works = [gas.work for gas in drive.gas]
            answers["work"] = work = total(*chain(*(gas.works for gas in drive.gas)))
            answers["work_driving"] = total(*(where(work > 0, work, 0.0) for work in works))
            answers["work_driven"] = total(*(where(work < 0, work, 0.0) for work in works))
            answers["power"] = _power_of_work(self, work)
        traced = [gas.traced for gas in drive.gas if gas.traced]
        traced_work = math.fsum(work for work, _ in traced)
        if traced_work:
            by_angle = math.fsum(by_angle for _, by_angle in traced)
            answers["work_sensitivity"] = math.radians(0.1) * by_angle / traced_work
        return answers

    @property
    def works_one_way(self) -> bool:
        """Whether the pistons of the rod all drive or are all driven, so that `work` is the only work."""
        return not (self.work_driving and self.work_driven)

    @cached_property
    def pistons(self) -> tuple[PistonWork, ...]:
        """Work, power and mean pressure of each piston, where the rod has several with an indicator."""
        machine, gases = self.drive.machine, self.drive.gas
        speed = machine.speed
        rate = None if speed is None or every(speed == 0) else speed / self.drive.revolutions
        names = machine.piston_names(self.drive.cylinder)
        pistons = tuple(PistonWork(name, gas, rate) for name, gas in zip(names, gases))
        return pistons if len(pistons) > 1 else ()

    @property
    def no_compressor(self) -> bool:
        """Whether rod loads are not shown: those of API 618 are of compressors, and at a connecting rod.

        An engine may be motored, and a pump and a ram are driven, too; with another load on the rod the gas and the
        masses are not all that it carries.
        """
        if self.work is None or self.work >= 0:
            return True
        drive = self.drive
        if drive.revolutions > 1 or not self.mechanism.has_rod:
            return True
        loads = (drive.cylinder.ram_force, drive.cylinder.force)
        if drive.machine.pump is not None or any(load is not None for load in loads):
            return True
        return not any(gas.work < 0 and gas.compresses_gas for gas in drive.gas)

    @property
    def open_at_crank_end(self) -> bool:
        """Whether the piston is a trunk piston, whose crank end has the ambient pressure."""
        indicator = self.drive.cylinder.pistons[0].indicator
        return indicator is not None and indicator.crank_end is None

    @property
    def inertia_alone(self) -> bool:
        """Whether the piston force is that of inertia alone."""
        return self.drive.has_inertia and self.samples.P_start is None

    # extremes of the columns

    def repeats(self, column: str) -> bool:
        """Return whether people read the extremes of a column in those of the piston force, or they are 0."""
        if super().repeats(column):
            return True
        piston_force, force = self.extremes_of("P"), self.extremes_of(column)
        if column == "P" or piston_force is None or force is None:
            return False
        return all(map(_are_equal, force, piston_force))

    @property
    def inertia_extremes(self) -> list[Extreme]:
        """The inertia forces in N where the acceleration is largest and smallest; none without masses or speed."""
        turns = (self.motion.b_max, self.motion.b_min) if self.drive.has_inertia else ()
        return [Extreme(-self.drive.mass * turn.value, turn.degrees) for turn in turns if turn]

    def extremes_of(self, column: str) -> Extremes | None:
        """Return the extremes in SI of a column that is declared to have them, None where it is left out."""
        extremes = self._extremes.get(column) if self.drive.has_force else None
        return extremes or self.motion.extremes_of(column)

    @shared
    def _extremes(self) -> dict[str, Extremes]:
        """Extremes of the columns that are declared to have them, by id."""
        declared = column_rows(State, self.mechanism.OFFERS)
        searched = {id: row for id, row in declared.items() if "forces" in row.quantity.extremes}
        return self.extremes_over({id: row.of(self.samples) for id, row in searched.items()})

    def refuse_locking(self) -> None:
        """Raise NoSolutionError where the crosshead locks itself, with an angle that does not depend on a step."""
        if self.drive.count is None and may_lock(self.drive.cylinder):
            self.extremes_of("N")

    @shared
    def changes_of_force(self) -> tuple[tuple[object, ...] | None, int]:
        """The crank angles in degrees at which P changes sign, through zero or by a jump, None without P.

        Changes that are noise of a trace count once, at the middle one; with them, how many of them are not listed. For
        many machines one tuple each.
        """
        P = self.sampled("P") if self.drive.has_force else None
        if P is None:
            return None, 0
        changes = reversals(self.drive, self.pieces, P)
        if not self.drive.noise:
            return changes, 0
        return changes, len(self.pieces.zeros(P).degrees) - len(changes)

    # guide and shoe of the crosshead

    @cached_property
    def lifted(self) -> tuple[tuple[float, float], ...]:
        """Stretches of crank angle in degrees on which N presses on the upper guide, R p. 602.

        Empty, too, where there is no guide, no N, or no inclination, so that no guide is the lower one.
        """
        down = self.drive.down
        side = self.sampled("N") if self.drive.has_force else None
        if side is None or not down or not (self.mechanism.guided and self.mechanism.has_rod):
            return ()
        turns = self.pieces.zeros(side).degrees.tolist() or [0.0]
        stretches = list(zip(turns, [*turns[1:], turns[0] + self.drive.cycle]))
        middles = np.array([(start + end) / 2 for start, end in stretches])
        pressing = self.pieces.at(side, np.zeros(len(middles), dtype=np.intp), middles) * down
        return tuple(stretch for stretch, force in zip(stretches, pressing) if force < 0)

    @cached_property
    def on_guide(self) -> dict[str, object]:
        """The key values of the shoe; the means over its path there and back, or over time, only with friction."""
        drive = self.drive
        answers = dict[str, object]()
        if drive.guide_area is None:
            return answers
        side = self.extremes_of("N")
        if side:
            most = largest(*(Extreme(abs(force.value), force.degrees) for force in side))
            answers["p_guide_max"] = Extreme(most.value / drive.guide_area, most.degrees)
        if drive.has_force:
            wear = self.extremes_over({"wear": self.samples.wear})
            answers["wear_max"] = wear["wear"].largest if wear else None

        lost, speed = self.friction_works.get("crosshead"), drive.machine.speed
        if lost is not None:
            if drive.rubs and some(lost != 0):
                path_of_area = drive.crosshead_friction * drive.guide_area * drive.path
                answers["p_guide_mean"] = lost / path_of_area
            if speed is not None:
                answers["wear_mean"] = lost * speed / drive.revolutions
        return answers

    # works

    @cached_property
    def work_left(self) -> Any:
        """Work in J per cycle that reaches the shaft: indicated, less friction and that of the load on the output."""
        if not self.drive.has_force:
            return None
        work = 0.0 if self.work is None else self.work
        lost = 0.0 if self.friction_work is None else self.friction_work
        return total(work, -lost, self.drive.output_work)

    @shared
    def friction_works(self) -> dict[str, Any]:
        """Works of friction in J per cycle, by the keys given in `friction`; ∮ f |N| |dx| at the crosshead.

        Constant forces act over the whole path.
        """
        drive, friction = self.drive, self.drive.cylinder.friction
        works = dict[str, Any]()
        if friction is None:
            return works

        def over_cycle(values: Number) -> Number:
            return self.result(self.pieces.integral(self.pieces.filled(values)))

        if friction.crosshead is not None and drive.has_force:
            works["crosshead"] = 0.0
            if drive.rubs:
                samples = self.samples
                works["crosshead"] = over_cycle(
                    samples.crosshead_drag * (samples.slope * samples.direction)
                )
        if friction.rings is not None:
            works["rings"] = drive.ring_force * drive.path
            if some(drive.ring_surface != 0):
                drag = np.abs(self.samples.pressure_difference) * self.pieces.of(drive.ring_surface)
                works["rings"] = over_cycle(drag * self.samples.slope * self.samples.direction)
        if friction.constant is not None:
            works["constant"] = friction.constant * drive.path
        if drive.has_force:
            names = list(friction.of_pins)
            if friction.block is not None:
                names.append("block")
            for name in names:
                works[name] = over_cycle(self.samples.losses.get(name, 0.0))
        if friction.guides is not None and drive.has_force:
            samples = self.samples
            works["guides"] = over_cycle(
                samples.drag_of_guides * (samples.slope * samples.direction)
            )
        return works

    def of_crosshead(self, formula: Callable[[Number, Number], Number]) -> Number | None:
        """Return a formula of the books in λ = R/L and f; None without friction at the crosshead."""
        if "crosshead" not in self.friction_works:
            return None
        return formula(self.mechanism.lam, self.drive.crosshead_friction)

    def mean_crosshead_friction(self) -> Number | None:
        """Return ½ λ f P_m in N (D 6), P_m the mean magnitude of the piston force over the path of the crosshead."""
        share = self.loss_crosshead_redtenbacher
        P = self.sampled("P") if self.drive.has_force else None
        if share is None or P is None:
            return None
        # |P| |dx| has kinks where P changes sign; the slope does only at the ends of pieces
        P_and_slope = np.stack((P, self.pieces.filled(self.samples.slope)))
        pieces, (work,), _ = resolved(
            self.pieces,
            P_and_slope,
            P[None],
            self.pieces.largest(P[None]),
            lambda _, parts: np.abs(parts[:1] * parts[1:]),
        )
        P_m = self.result(pieces.integral(work)) / self.drive.path
        return share * P_m

    def energy_balance(self) -> Number | None:
        """Return the energy balance (∮ T R dφ − `work_left`) over ∮ |T| R dφ: quadrature against work in closed form.

        With a measured trace at equal angles the quadrature follows the straight lines between the samples, the
        indicated work the trapezoid rule: the residual then shows the error of the spacing of the samples.
        """
        if self.work_left is None:
            return None
        M = self.samples.M
        turnover = self.result(self.pieces.integral(np.abs(M)))
        work = self.result(self.pieces.integral(M))
        has_turnover = turnover > 0
        left_open = (work - self.work_left) / where(has_turnover, turnover, 1.0)
        return where(has_turnover, left_open, 0.0)


def _are_equal(force: Extreme, other: Extreme) -> bool:
    """Return whether two extremes of one machine are equal but for rounding, at the same angle."""
    same_value = math.isclose(force.value, other.value, rel_tol=1e-12)
    return same_value and math.isclose(force.degrees, other.degrees, abs_tol=1e-9)


@cache
def _rows(
    offers: tuple[Offer, ...],
    key_offers: tuple[KeyOffer, ...],
    of_ram: bool,
    absolute: bool,
    guided: bool,
    closed: frozenset[str],
) -> Rows:
    """Return the rows of cylinders with these quantities of mechanisms, in the words for a machine of their kind."""
    rows = result_rows(CylinderForces, offers, key_offers, closed)
    if of_ram:
        rows = rows.changed(Quantity.of_ram)
    elif absolute:
        rows = rows.changed(Quantity.absolute)
    if guided:
        return rows
    return rows.changed(Quantity.without_guide)
