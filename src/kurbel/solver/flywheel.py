"""Flywheel of the whole machine: key values and columns of `kurbel flywheel`, of one machine or of many.

    J_δ = ΔE/(δ ω²)           the flywheel of the books for the wanted δ (R p. 613)
    GD² = 4 J                 A_K = 4 J/(π ρ D (D² + h²))     section of the rim that has it

The books take J as constant and the load as independent of the speed; the speed line of `speed` or `coupling` does not.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cached_property
from typing import Any

import numpy as np

from kurbel.arrays import Array
from kurbel.declared.unit_systems import show
from kurbel.errors import NoSolutionError, UsageError
from kurbel.numerics.arithmetic import every, some, where
from kurbel.numerics.collocation import Standstill, Unsettled
from kurbel.numerics.extreme import Extreme, Extremes
from kurbel.numerics.pieces import Pieces
from kurbel.numerics.roots import rising_root
from kurbel.quantity import column, key_value
from kurbel.solver.coupling import ElasticCoupling, natural_order
from kurbel.solver.cycle import Where, where_is
from kurbel.solver.effort import TurningEffort
from kurbel.solver.figures import AtAngles, Results, Searched, part
from kurbel.solver.forces import Brake, CylinderForces
from kurbel.solver.motion import every_dead_centre
from kurbel.solver.speed import RigidLine, SpeedLaw, SpeedLine
from kurbel.solver.state import State

RIGID_ABOVE = 100.0
"""Natural order from which on a coupling counts as rigid: it transmits what a rigid one would but for 1 in 10⁴."""
_MISSED = 1e-3
"""By what δ may miss the wanted one, relatively, before a warning."""
_LARGEST_EXPONENT = 709.7
"""Its power of e is all but the largest float."""
_DOUBLINGS = 30
"""How many doublings of the flywheel are tried for one that turns."""


class TurningState(AtAngles):
    """The columns of the whole machine.

    shown: makes of samples on pieces what is wanted, values at crank angles φ (n,) in degrees or the samples.
    """

    commands = ("flywheel",)

    def __init__(self, turning: MachineTurning, phi: Array, shown: Callable[[Pieces, Array], Any]) -> None:
        self._turning, self._effort, self.phi, self._shown = turning, turning.effort, phi, shown

    def __getitem__(self, id: str) -> Any:
        """Return a column by its id; None for one that there is not."""
        return self.M_load if id == "M_load" else super().__getitem__(id)

    def _at_crank(self, torque: Array) -> Any:
        """Return a torque in N m as a force in N at the radius of crank 1; None without a crank."""
        crank, pieces = self._turning.crank, self._effort.pieces
        return None if crank is None else self._shown(pieces, torque / pieces.of(crank))

    @column("T", "force", extremes=("flywheel",), called="tangential force", peak=True)
    def T(self) -> Any:
        """Tangential force at the crank pin, positive when it drives."""
        return self._at_crank(self._effort.M)

    @column("T_b", "force")
    def T_inertia(self) -> Any:
        """Share of the inertia forces in T, at uniform rotation (Tolle)."""
        terms = self._effort.inertia_terms
        return self._at_crank(self._effort.sampled(terms)) if terms else None

    @column("M", "torque", extremes=("flywheel",), called="torque")
    def M(self) -> Any:
        """Torque on the shaft."""
        return self._shown(self._effort.pieces, self._effort.M)

    @property
    def M_load(self) -> Any:
        """Load in N m at the nominal speed."""
        return self._shown(self._effort.pieces, self._effort.load)

    @column("E", "energy")
    def E(self) -> Any:
        """Excess of the work of M over that of the resistance since angle 0."""
        return self._shown(self._effort.pieces, self._turning.excess.E)

    @column("ω", "angular_velocity")
    def omega(self) -> Any:
        """Angular velocity of the shaft."""
        return self._shown(*self._turning.speed.omega) if self._turning.speed else None

    @column("α", "angular_acceleration", extremes=("flywheel",), called="angular acceleration of the shaft")
    def alpha(self) -> Any:
        """Angular acceleration of the shaft, just after a jump."""
        return self._shown(*self._turning.speed.alpha) if self._turning.speed else None

    @column("M_K", "torque")
    def M_coupling(self) -> Any:
        """Torque in the elastic coupling."""
        return self._shown(*self._turning.elastic.torque) if self._turning.elastic else None


class MachineTurning(Results):
    """The key values of the whole machine over its common cycle; `at(degrees)` gives the columns.

    Attributes are named by the ids of the key values, in SI; one that the machine does not have is None. Forces T are
    referred to the radius of crank 1. The key values of many machines are (machines,), nan for a machine that has none.
    Raises UsageError where nothing turns the machine, NoSolutionError where it cannot run.
    """

    command, state = "flywheel", TurningState

    def __init__(self, effort: TurningEffort) -> None:
        self.effort, self.machine, self.excess = effort, effort.machine, effort.excess
        self.omega = effort.omega
        self.crank = self.machine.cylinders[0].mechanism.crank if self.machine.cylinders else None
        self._extremes: dict[str, Extremes | None] = {}
        wheel = self.machine.flywheel
        self._given, self._wanted, self._rim = (wheel.inertia, wheel.fluctuation, wheel.rim) if wheel else (None,) * 3
        self._turns = self.omega is not None and some(self.omega != 0)
        if effort.count is not None:
            _ = self.natural_order  # refuses machines of a batch before any result is read

    # over the crank angle

    def _columns(self, phi: Array, within: Array) -> TurningState:
        return TurningState(self, phi, lambda pieces, values: self.effort.at(pieces, values, phi, within))

    def samples_of(self, column: str) -> tuple[Pieces, Array] | None:
        """Return a column at the nodes of pieces; None for one that is left out."""
        found: tuple[Pieces, Array] | None = TurningState(self, np.zeros(0), lambda *samples: samples)[column]
        return found

    @property
    def breaks(self) -> Array:
        """The crank angles in degrees of the only machine between which every quantity is smooth."""
        return np.append(self.effort.pieces.low, self.effort.cycle)

    def angles_where(self, column: str, value: float) -> Where | None:
        """Return where in the cycle a column has a value in SI; None for a column that is left out."""
        found = self.samples_of(column)
        return None if found is None else where_is(*found, value)

    def extremes_of(self, column: str) -> Extremes | None:
        """Return the extremes in SI of a column that is declared to have them; None for one that is left out."""
        if column not in self._extremes:
            found = self.samples_of(column)
            result = self.speed.result if column == "alpha" and self.speed else self.effort.result
            self._extremes[column] = None if found is None else found[0].extremes(found[1][None]).each(result)[0]
        return self._extremes[column]

    # turning effort

    @part(Brake)
    def brake(self) -> Brake:
        """Key values of the brake."""
        return Brake(self.machine, self.effort.cylinders)

    @key_value("W", "force")
    def W(self) -> Any:
        """Mean tangential force over the cycle: the resistance."""
        return None if self.crank is None else self.M_mean / self.crank

    @key_value("M_m", "torque")
    def M_mean(self) -> Any:
        """Mean torque of the turning effort: the resistance."""
        return self.effort.result(self.effort.mean)

    @key_value("A", "energy")
    def work_shaft(self) -> Any:
        """Work of the turning effort per cycle."""
        return self.M_mean * math.radians(self.effort.cycle)

    @key_value("N_e", "power")
    def power_shaft(self) -> Any:
        """Power at the shaft, mean torque times nominal angular velocity."""
        return self.M_mean * self.omega if self._turns else None

    _searched = Searched()

    @property
    def deficit(self) -> Any:
        """Mean effort less the mean of a resistance given by points, in N m; None where they agree."""
        found = self.effort.deficit
        return self.effort.result(np.where(found == 0, np.nan, found)) if found.any() else None

    # excess work

    def _of_each(self, values: Array) -> Any:
        """Return numbers of the crossings as a tuple, of many machines one each."""
        each = self.excess.crossings._replace(degrees=values).of_each(self.excess.pieces.count)
        tuples = tuple(tuple(one.tolist()) for one in each)
        return tuples[0] if self.effort.count is None else tuples

    @key_value("φ_T=W", "angle", listed=True)
    def phi_crossing(self) -> Any:
        """Crank angles at which the effort crosses the resistance."""
        return self._of_each(self.excess.crossings.degrees)

    @key_value("A_1, A_2, …", "energy", plain="A_1, ...", listed=True)
    def lobes(self) -> Any:
        """Excess work of the lobes, from crossing to crossing."""
        return self._of_each(self.excess.lobes)

    @cached_property
    def _summits(self) -> Extremes | None:
        """Largest and smallest E with their angles; None where the only machine has no excess."""
        return self.excess.summits.each(self.effort.result)[0] if self.excess.torque.any() else None

    @key_value("E_max", "energy")
    def E_max(self) -> Extreme | None:
        """Largest excess work since angle 0."""
        return self._summits and self._summits.largest

    @key_value("E_min", "energy")
    def E_min(self) -> Extreme | None:
        """Smallest excess work since angle 0."""
        return self._summits and self._summits.smallest

    @key_value("ΔE", "energy")
    def dE(self) -> Any:
        """Largest swing of the excess work, over all lobes."""
        return self.effort.result(self.excess.dE)

    @key_value("ΔE/A", "ratio")
    def energy_fluctuation(self) -> Any:
        """Coefficient of fluctuation of energy.

        None where no work is done, nan for such a machine of many.
        """
        work = self.work_shaft
        return self.dE / where(work > 0, work, math.nan) if some(work > 0) else None

    # flywheel

    @key_value("J", "inertia")
    def J(self) -> Any:
        """Moment of inertia of the flywheel: the given one, or that for the wanted δ."""
        return self.J_needed if self._given is None else self._given

    @property
    def is_the_needed(self) -> bool:
        """Whether the flywheel is the one for the wanted δ."""
        return self._given is None or (self.J_needed is not None and every(self.J_needed == self._given))

    @key_value("GD²", "gd2", plain="GD2")
    def GD2(self) -> Any:
        """Old form of the moment of inertia, 4gJ as a weight times an area."""
        return None if self.J is None else 4 * self.J

    @key_value("J_δ", "inertia", unless=lambda turning: turning.is_the_needed)
    def J_needed(self) -> Any:
        """Flywheel for the wanted δ, ΔE/(δ ω²).

        What a rigid coupling adds comes off.
        """
        if self._wanted is None or not self._turns:
            return None
        return self.effort.result(np.maximum(self._needed_in_all - self._driven_rigidly, 0.0))

    @property
    def _needed_in_all(self) -> Array:
        return np.asarray(self.excess.dE / (self._wanted * self.omega**2))

    @key_value("GD²_δ", "gd2", plain="GD2_delta", unless=lambda turning: turning.is_the_needed)
    def GD2_needed(self) -> Any:
        """The same as GD² = 4gJ."""
        return None if self.J_needed is None else 4 * self.J_needed

    @key_value("A_K", "area")
    def rim_section(self) -> Any:
        """Section of the rim for the wanted δ, or for J: 4 J/(π ρ D (D² + h²))."""
        wanted = self.J if self.J_needed is None else self.J_needed
        return None if self._rim is None or wanted is None else self._rim.section(wanted)

    @key_value("v_K", "velocity")
    def rim_speed(self) -> Any:
        """Speed of the middle of the rim."""
        return self._rim.speed(self.omega) if self._rim and self._turns else None

    @key_value("σ_K", "stress")
    def rim_stress(self) -> Any:
        """Hoop stress of the rim, ρ v²."""
        return self._rim.stress(self.omega) if self._rim and self._turns else None

    # speed line

    @cached_property
    def law(self) -> SpeedLaw | None:
        """How the load depends on the speed; None where it does not."""
        return SpeedLaw.of(self.effort)

    @property
    def load_ignored(self) -> bool:
        """Whether the load depends on the speed, but is in proportion to a mean torque of zero."""
        load = self.machine.load
        return load is not None and (load.slip is not None or bool(load.power)) and self.law is None

    @property
    def _needs_no_inertia(self) -> bool:
        """Whether the wanted δ is met by no flywheel at all, the effort being uniform; any inertia then turns alike."""
        uniform = not self.effort.inertia_terms and not self.excess.dE.any()
        return self._wanted is not None and uniform and not some(self.J != 0)

    def _line(self, flywheel: Any) -> SpeedLine:
        """Return the speed line with a flywheel in kg m²; raises Standstill, Unsettled, NoSolutionError, UsageError."""
        coupling, count = self.machine.coupling, self.effort.count
        if coupling and not self._needs_no_inertia:
            own = self._before_coupling(flywheel)
            if count is None and not own[0]:
                raise UsageError("nothing before the coupling has any inertia: give 'flywheel' an inertia")
            if some(natural_order(coupling, own, self.omega) <= RIGID_ABOVE):
                return ElasticCoupling(self.effort, own, self.law)
        whole = np.asarray(flywheel + (coupling.inertia if coupling else 0.0), dtype=float)
        return RigidLine(self.effort, self.law, np.broadcast_to(whole, self.effort.mean.shape))

    @part(SpeedLine)
    def speed(self) -> SpeedLine | None:
        """The speed of the crank shaft over the turn; None without a flywheel or a speed.

        Raises NoSolutionError where the machine stalls.
        """
        if self.J is None or not self._turns:
            return None
        try:
            return self._line(1.0 if self._needs_no_inertia else self.J)
        except Unsettled as stop:
            raise NoSolutionError(self._why_it_stalls(self.J, stop)) from None

    def _delta_with(self, flywheel: float) -> float:
        """Return δ of the speed line with a flywheel in kg m²; inf where it stalls."""
        try:
            return float(self._line(flywheel).delta)
        except (Unsettled, NoSolutionError, UsageError):
            return math.inf

    def _why_it_stalls(self, flywheel: float, stop: Unsettled) -> str:
        """Return where the machine stands still, if it does, and the flywheel with which it was found to turn."""
        elastic = self.natural_order is not None and not self.rigid
        with_this = f"with J = {show(flywheel, 'inertia')}{' and the elastic coupling' if elastic else ''}"
        message = f"{with_this} no speed line is found that repeats under this load"
        if isinstance(stop, Standstill):
            message = (
                f"the machine stops near φ = {stop.degrees:.0f}°: {with_this} its kinetic energy does not carry it over"
            )
        enough = self._enough(flywheel, stop.enough)
        if enough is None:
            return f"{message}, nor is one with any other flywheel: look at its effort, load and speed"
        return (
            f"{message}; it turns with a flywheel from J = {show(enough, 'inertia')} "
            f"(GD2 = {show(4 * enough, 'gd2')}) on"
        )

    def _enough(self, flywheel: float, more: float | None) -> float | None:
        """Return the least flywheel of three digits, within a fiftieth, with which a machine turns; None without any.

        flywheel: one with which it does not; more: kinetic energy in J that is known to be just enough besides.
        """
        moving = float(self.effort.pieces.mean(self.effort.J_moving)[0])
        least = max(flywheel, 1e-6 * moving, 1e-300)
        enough = flywheel + 2 * more / self.omega**2 if more else least + self.dE / self.omega**2
        for _ in range(_DOUBLINGS):
            if math.isfinite(self._delta_with(_rounded_up(enough))):
                break
            least, enough = enough, 2 * enough
        else:
            return None
        while not more and enough > 1.02 * max(least, enough / 1000):
            middle = math.sqrt(max(least, enough / 4) * enough)
            turns = math.isfinite(self._delta_with(_rounded_up(middle)))
            least, enough = (least, middle) if turns else (middle, enough)
        return _rounded_up(enough)

    @key_value("δ_0", "ratio", after="delta")
    def delta_book(self) -> Any:
        """The same after the books, ΔE/(J ω²)."""
        inertia = (0.0 if self.J is None else self.J) + self._driven_rigidly
        if not self._turns or not some(inertia != 0):
            return None
        return self.dE / (where(inertia == 0, math.nan, inertia) * self.omega**2)

    @key_value("μ", "ratio")
    def multiplier(self) -> Any:
        """What is left of a disturbance after a cycle (Floquet); below 1 it dies away.

        μ = exp(−∮ ∂M_load/∂ω/(J ω) dφ), or the largest float; None where the load does not depend on the speed.
        """
        if self.law is None or not self.speed:
            return None
        found = np.exp(np.minimum(self.speed.growth, _LARGEST_EXPONENT))
        return float(found) if self.effort.count is None else found

    # coupling

    @key_value("n_e", "ratio")
    def natural_order(self) -> Any:
        """Natural frequency of the coupled masses over the angular velocity."""
        if self.machine.coupling is None or not self._turns or (self._given is None and self._wanted is None):
            return None
        own = self._before_coupling(self._needed_in_all if self._given is None else self._given)
        if not every(own != 0):
            return None
        found = natural_order(self.machine.coupling, own, self.omega)
        if not every(found > RIGID_ABOVE):  # in a batch machines with a rigid coupling are left out
            self.effort.refused |= found > RIGID_ABOVE
        return self.effort.result(found)

    def _before_coupling(self, flywheel: Any) -> Array:
        """Return J₁ in kg m² (n,): the flywheel and the mean of what the moving masses add."""
        return np.asarray(flywheel + self.effort.pieces.mean(self.effort.J_moving))

    @property
    def rigid(self) -> bool:
        """Whether the coupling is so stiff that it counts as rigid; that of many machines, whether all do."""
        return self.natural_order is not None and not some(self.natural_order <= RIGID_ABOVE)

    @property
    def _driven_rigidly(self) -> Any:
        return self.machine.coupling.inertia if self.machine.coupling and self.rigid else 0.0

    @part(ElasticCoupling)
    def elastic(self) -> ElasticCoupling | None:
        """The elastic coupling; None where there is none, one as good as rigid, or nothing to compute it with.

        Raises NoSolutionError where no motion of it repeats.
        """
        if self.machine.coupling is None or self.rigid:
            return None
        return self.speed if isinstance(self.speed, ElasticCoupling) else None

    # the wanted δ, held against the speed line

    @cached_property
    def delta_needed(self) -> Any:
        """δ of the speed line with the flywheel of the books for the wanted δ; None where it stalls."""
        if self.J_needed is None or not self._turns or self._needs_no_inertia:
            return None
        if self.is_the_needed:
            return self.speed and self.speed.delta
        if self.effort.count is not None:
            return self._line(self.J_needed).delta
        delta = self._delta_with(self.J_needed)
        return delta if math.isfinite(delta) else None

    @property
    def misses_the_wish(self) -> bool:
        """Whether that differs from the wanted δ by what one would notice; of many machines, that of any."""
        if self._wanted is None or self.delta_needed is None:
            return False
        return some((self.delta_needed != 0) & (abs(self.delta_needed / self._wanted - 1) > _MISSED))

    @key_value("J_δ,ω", "inertia", after="rim_stress")
    def J_exact(self) -> Any:
        """Flywheel with which δ of the speed line is the wanted one.

        None where that of the books does; of many machines nan: each is searched by itself.
        """
        if not self.misses_the_wish or self._wanted is None or not some(self.J_needed != 0):
            return None
        if self.effort.count is not None:
            return np.full(self.effort.count, np.nan)
        wanted, known = self._wanted, {self.J_needed: self.delta_needed}

        def surplus(flywheel: float) -> float:
            delta = known.get(flywheel) or self._delta_with(flywheel)
            return wanted / delta - 1 if delta else math.inf

        return rising_root(surplus, self.J_needed)


def _rounded_up(value: float) -> float:
    """Return the next larger number of three digits."""
    digit = 10.0 ** (math.floor(math.log10(value)) - 2)
    return math.ceil(value / digit) * digit


class DeadCentre(Results):
    """What `kurbel flywheel` has of a cylinder that drives a pump; cycle: of the machine in degrees."""

    command = "flywheel"

    def __init__(self, forces: CylinderForces, cycle: float) -> None:
        self.forces, self._cycle = forces, cycle

    @key_value("P_d + P_p", "force")
    def P_dead_centre(self) -> Extreme | None:
        """Force before the pump in a dead centre, without inertia.

        At the end of the stroke steam and pump both oppose the motion, and the parts before the pump must carry their
        sum (R p. 613). None if the cylinder does not both drive and drive a pump.
        """
        forces, drive, count = self.forces, self.forces.drive, self.forces.drive.count or 1
        driving, driven = forces.work_driving, forces.work_driven
        both = np.asarray(driving is not None and (driving > 0) & (driven < 0))
        if not both.any():
            return None
        centres = every_dead_centre(drive.mechanism, count, drive.cycle)
        angles = np.repeat(centres, 2, axis=1)
        sides = angles + np.tile([-1e-6, 1e-6], centres.shape[1])
        machine = np.repeat(np.arange(count), angles.shape[1])
        values = State.at(drive, angles.ravel(), sides.ravel(), machine).P_gas.reshape(angles.shape)
        largest = np.arange(count), np.abs(values).argmax(axis=1)
        found = np.where(both, values[largest], np.nan), np.mod(angles[largest], self._cycle)
        return Extreme(*map(forces.told, found))
