"""What `kurbel flywheel` answers for the whole machine: turning effort, excess work, flywheel, coupling, speed line."""

import math
from collections.abc import Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Any

from kurbel.arrays import Array
from kurbel.declared.unit_systems import show
from kurbel.errors import NoSolutionError
from kurbel.machine import Machine
from kurbel.numerics.collocation_old import Standstill, Unsettled
from kurbel.numerics.extreme import Extreme
from kurbel.numerics.roots import rising_root
from kurbel.numerics.search import Extremes
from kurbel.solver.cylinder.brake import Brake
from kurbel.solver.cylinder.forces import CylinderForces
from kurbel.solver.figures import Columns, Results, passed_on
from kurbel.solver.turning.columns import OF_SPEED, TurningCurves
from kurbel.solver.turning.machine_effort import MachineEffort
from kurbel.solver.turning.speed import SpeedLine
from kurbel.solver.turning.speed_lines import RIGID_ABOVE, SpeedLines, speed_law, turning

if TYPE_CHECKING:
    from kurbel.numerics.where import Where
    from kurbel.solver.turning.coupling import ElasticCoupling

_MISSED = 1e-3
"""By what δ may miss the wanted one, relatively, before it is told."""


class MachineTurning(Results):
    """The key values of the whole machine over its common cycle; `at(degrees)` gives the columns.

    Attributes are named by the ids of the key values, in SI; one that the machine does not have is None. Forces T are
    referred to the radius of crank 1.
    """

    def __init__(self, machine: Machine, cylinders: Sequence[CylinderForces]) -> None:
        self.machine = machine
        self.turned = MachineEffort(machine, cylinders)
        self.excess = self.turned.excess
        self.omega = self.turned.omega
        self.crank = machine.cylinders[0].mechanism.crank if machine.cylinders else None
        self.brake = Brake(machine, cylinders)
        wheel = machine.flywheel
        self._given, self._wanted, self._rim = (wheel.inertia, wheel.fluctuation, wheel.rim) if wheel else (None,) * 3
        self._lines = SpeedLines(self.turned, self.omega) if self.omega else None

    command = "flywheel"

    @property
    def answering(self) -> tuple[Any, ...]:
        """What answers key values, the first that knows one."""
        return (self, *((self.elastic,) if self.elastic else ()), self.brake)

    def _columns(self, phi: Array, within: Array) -> Columns:
        return TurningCurves(self, phi, within).columns()

    @property
    def breaks(self) -> Array:
        """The crank angles in degrees between which every quantity is smooth."""
        return self.excess.grid.breaks

    def angles_where(self, column: str, value: float) -> "Where | None":
        """Return where in the cycle a column has a value in SI; None for a column that is left out."""
        from kurbel.numerics.where import where

        def sampled(degrees: Array, within: Array) -> Any:
            return TurningCurves(self, degrees, within).curve(column)

        grid = self.speed.grid if column in OF_SPEED and self.speed else self.excess.grid
        samples = sampled(grid.degrees, grid.within)
        return None if samples is None else where(grid, samples, sampled, value)

    # turning effort

    @property
    def M_mean(self) -> float:
        """Mean torque in N m."""
        return self.excess.mean

    @property
    def W(self) -> float | None:
        """Mean tangential force in N at the radius of crank 1: the resistance."""
        return None if self.crank is None else self.M_mean / self.crank

    @property
    def work_shaft(self) -> float:
        """Work of the turning effort in J per cycle."""
        return self.M_mean * math.radians(self.turned.cycle)

    @property
    def power_shaft(self) -> float | None:
        """Mean torque times nominal angular velocity in W."""
        return None if not self.omega else self.M_mean * self.omega

    @property
    def deficit(self) -> float | None:
        """Mean effort less the mean of a resistance given by points, in N m; None where they agree."""
        given = self.machine.load.diagram if self.machine.load else None
        return self.excess.deficit or None if given else None

    def extremes_of(self, column: str) -> Extremes | None:
        """Return the extremes in SI of a column that is declared to have them; None for one that is left out."""
        if column == "alpha":
            return None if self.speed is None else self.speed.alpha_extremes
        arm, found = self.crank if column == "T" else 1.0, self.excess.effort_extremes
        return None if arm is None else Extremes(*(Extreme(one.value / arm, one.degrees) for one in found))

    # excess work

    phi_crossing = passed_on("excess", "crossings", "Crank angles in degrees at which T crosses W.")
    lobes = passed_on("excess", "lobes", "Work in J of the lobes between the crossings.")
    dE = passed_on("excess", "dE", "ΔE in J.")
    _heights = passed_on("excess", "extremes", "Largest and smallest excess work in J; None where there is none.")
    E_max = passed_on("_heights", "largest", "Largest excess work in J since angle 0; None where there is none.")
    E_min = passed_on("_heights", "smallest", "Smallest excess work in J since angle 0.")

    @property
    def energy_fluctuation(self) -> float | None:
        """ΔE over the work of a cycle."""
        return self.dE / self.work_shaft if self.work_shaft > 0 else None

    # flywheel

    @cached_property
    def _needed_in_all(self) -> float | None:
        """ΔE/(δ ω²) in kg m² for the wanted δ."""
        return self.dE / (self._wanted * self.omega**2) if self._wanted and self.omega else None

    @property
    def J_needed(self) -> float | None:
        """Flywheel in kg m² for the wanted δ, J = ΔE/(δ ω²); what a rigid coupling adds comes off."""
        return None if self._needed_in_all is None else max(self._needed_in_all - self._driven_rigidly, 0.0)

    @property
    def GD2_needed(self) -> float | None:
        """GD² = 4 J for the wanted δ, in kg m²."""
        return None if self.J_needed is None else 4 * self.J_needed

    @property
    def rim_section(self) -> float | None:
        """Section of the rim in m² that has the wanted moment of inertia, or else the given one."""
        wanted = self.J if self.J_needed is None else self.J_needed
        return None if self._rim is None or wanted is None else self._rim.section(wanted)

    @property
    def rim_speed(self) -> float | None:
        """Speed of the middle of the rim in m/s."""
        return self._rim.speed(self.omega) if self._rim and self.omega else None

    @property
    def rim_stress(self) -> float | None:
        """Hoop stress ρ v² of the rim in Pa."""
        return self._rim.stress(self.omega) if self._rim and self.omega else None

    @property
    def is_the_needed(self) -> bool:
        """Whether the flywheel is the one for the wanted δ."""
        return self.J_needed == self.J

    @property
    def J(self) -> float | None:
        """Flywheel in kg m²: the given one, or else the one for the wanted δ."""
        return self.J_needed if self._given is None else self._given

    @property
    def GD2(self) -> float | None:
        """GD² = 4 J in kg m²."""
        return None if self.J is None else 4 * self.J

    @property
    def delta_book(self) -> float | None:
        """δ ≈ ΔE/(J ω²) of the books: constant J, and a load that does not mind the speed."""
        energy = ((self.J or 0.0) + self._driven_rigidly) * (self.omega or 0.0) ** 2
        return self.dE / energy if energy else None

    # coupling

    @cached_property
    def natural_order(self) -> float | None:
        """Natural frequency of cranks and driven inertia on the coupling, over ω; None where not defined."""
        flywheel = self._needed_in_all if self._given is None else self._given
        return None if self._lines is None or flywheel is None else self._lines.natural_order(flywheel)

    @property
    def rigid(self) -> bool:
        """Whether the coupling is so stiff that it counts as rigid."""
        return self.natural_order is not None and self.natural_order > RIGID_ABOVE

    @property
    def _driven_rigidly(self) -> float:
        return self.machine.coupling.inertia if self.machine.coupling and self.rigid else 0.0

    @cached_property
    def elastic(self) -> "ElasticCoupling | None":
        """The elastic coupling; None where there is none, one as good as rigid, or nothing to compute it with.

        Raises NoSolutionError where no motion of it repeats.
        """
        if self.J is None or not self._lines or self._needs_no_inertia:
            return None
        try:
            return self._lines.elastic(self.J)
        except Unsettled as stop:
            raise NoSolutionError(self._refusal(self._lines, self.J, stop)) from None

    # speed line

    @property
    def load_ignored(self) -> bool:
        """Whether the load depends on the speed, but stands in proportion to a mean torque of zero."""
        load = self.machine.load
        return bool(load and (load.slip or load.power)) and speed_law(self.turned) is None

    @property
    def _needs_no_inertia(self) -> bool:
        """Whether the wanted δ is met by no flywheel at all, the effort being uniform; any inertia then turns alike."""
        return self.J == self.J_needed == 0 and not self.dE and not self.turned.masses

    @cached_property
    def speed(self) -> "SpeedLine | ElasticCoupling | None":
        """The speed of the crank shaft over the turn; None without a flywheel or a speed.

        Raises NoSolutionError where the machine stalls.
        """
        if self.J is None or self._lines is None:
            return None
        try:
            return turning(self.elastic or self._lines.rigid(1.0 if self._needs_no_inertia else self.J))
        except Unsettled as stop:
            raise NoSolutionError(self._refusal(self._lines, self.J, stop)) from None

    def _refusal(self, lines: SpeedLines, flywheel: float, stop: Unsettled) -> str:
        """Return where the machine stands still, if it does, and the flywheel with which it was found to turn."""
        elastic = self.natural_order is not None and not self.rigid
        with_this = f"with J = {show(flywheel, 'inertia')}{' and the elastic coupling' if elastic else ''}"
        message = f"{with_this} no speed line is found that repeats under this load"
        if isinstance(stop, Standstill):
            message = (
                f"the machine stops near φ = {stop.degrees:.0f}°: {with_this} its kinetic energy does not carry it over"
            )
        enough = lines.enough(flywheel, stop.enough)
        if enough is None:
            return f"{message}, nor is one with any other flywheel: look at its effort, load and speed"
        return (
            f"{message}; it turns with a flywheel from J = {show(enough, 'inertia')} "
            f"(GD2 = {show(4 * enough, 'gd2')}) on"
        )

    delta = passed_on("speed", "delta", "δ = (ω_max − ω_min)/ω_mean of the speed line.")
    omega_max = passed_on("speed", "omega_max", "Largest angular velocity in rad/s.")
    omega_min = passed_on("speed", "omega_min", "Smallest angular velocity in rad/s.")
    omega_mean = passed_on("speed", "omega_mean", "Mean angular velocity over time in rad/s.")

    @property
    def multiplier(self) -> float | None:
        """Floquet multiplier: what is left of a small disturbance after one cycle; stable below 1.

        μ = exp(−∮ ∂M_load/∂ω/(J ω) dφ), or the largest float; None where the load does not depend on the speed.
        """
        minds = self._lines is not None and self._lines.law is not None
        return math.exp(min(self.speed.growth, 709.7)) if minds and self.speed else None

    # the wanted δ, held against the speed line

    @cached_property
    def delta_needed(self) -> float | None:
        """δ of the speed line with the flywheel of the books for the wanted δ; None where it stalls."""
        if self.J_needed is None or self._lines is None or self._needs_no_inertia:
            return None
        delta = self.delta if self.J_needed == self.J else self._lines.delta(self.J_needed)
        return delta if delta is not None and math.isfinite(delta) else None

    @property
    def misses_the_wish(self) -> bool:
        """Whether that differs from the wanted δ by what one would notice."""
        return bool(self._wanted and self.delta_needed and abs(self.delta_needed / self._wanted - 1) > _MISSED)

    @cached_property
    def J_exact(self) -> float | None:
        """Flywheel in kg m² with which δ of the speed line is the wanted one, where that of the books misses it."""
        if not self.misses_the_wish or not self.J_needed or self._wanted is None or self._lines is None:
            return None
        wanted, lines, known = self._wanted, self._lines, {self.J_needed: self.delta_needed}

        def surplus(flywheel: float) -> float:
            delta = known.get(flywheel) or lines.delta(flywheel)
            return wanted / delta - 1 if delta else math.inf

        return rising_root(surplus, self.J_needed)
