"""Flywheel, coupling and speed line of the whole machine."""

from __future__ import annotations

import math
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from kurbel.declared.units import show
from kurbel.errors import NoSolutionError, UsageError
from kurbel.numerics.collocation import Standstill, Unsettled
from kurbel.numerics.extreme import Extreme
from kurbel.numerics.grid import Grid
from kurbel.numerics.roots import rising_root
from kurbel.solver.turning.excess import Excess
from kurbel.solver.turning.machine_effort import MachineTurning
from kurbel.solver.turning.speed import (
    ConstantLoad,
    Inertia,
    PowerLaw,
    SlipLaw,
    SpeedDependentLoad,
    SpeedLaw,
    SpeedLine,
    Turning,
    floquet,
)
from kurbel.solver.turning.torques import Sum

if TYPE_CHECKING:
    from kurbel.arrays import Array
    from kurbel.solver.turning.coupling import ElasticCoupling

_MISSED = 1e-3
"""By what δ may miss the wanted one, relatively, before it is told."""
_RIGID_ABOVE = 100.0
"""Natural order from which on a coupling counts as rigid: it transmits what a rigid one would but for 1 in 10⁴."""
_DOUBLINGS = 30
"""How many doublings of the flywheel are tried for one that turns."""


class MachineSpeed(MachineTurning):
    """What `kurbel flywheel` answers for the whole machine: its turning effort, flywheel, coupling and speed line.

    Attributes are named by the ids of the key values, in SI; one that the machine does not have is None.
    """

    @property
    def J_needed(self) -> float | None:
        """Flywheel in kg m² for the wanted δ, J = ΔE/(δ ω²); what a rigid coupling adds comes off."""
        wanted = self.machine.flywheel.fluctuation if self.machine.flywheel else None
        if wanted is None or not self.omega:
            return None
        return max(self._needed_in_all - self._driven_rigidly, 0.0)

    @property
    def GD2_needed(self) -> float | None:
        """GD² = 4 J for the wanted δ, in kg m²."""
        return None if self.J_needed is None else 4 * self.J_needed

    @property
    def is_the_needed(self) -> bool:
        """Whether the flywheel is the one for the wanted δ."""
        return self.J_needed == self.J

    @property
    def J(self) -> float | None:
        """Flywheel in kg m²: the given one, or else the one for the wanted δ."""
        given = self.machine.flywheel.inertia if self.machine.flywheel else None
        return self.J_needed if given is None else given

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
    def elastic(self) -> ElasticCoupling | None:
        """The elastic coupling; None where there is none, one as good as rigid, or nothing to compute it with."""
        return None if self.J is None or not self.omega or self._needs_no_inertia else self._coupled_to(self.J)

    def _coupled_to(self, flywheel: float) -> ElasticCoupling | None:
        """Return the elastic coupling to a flywheel in kg m²; None where there is none, or one as good as rigid."""
        coupling = self.machine.coupling
        if not coupling or (self._natural_order_with(flywheel) or self.natural_order or 0.0) > _RIGID_ABOVE:
            return None
        from kurbel.solver.turning.coupling import ElasticCoupling, Shaft

        assert self.omega
        own = flywheel + self._mean_of_masses
        if not own:
            raise UsageError("nothing before the coupling has any inertia: give 'flywheel' an inertia")
        shaft = Shaft(own, self.omega, self._load_slope)
        return ElasticCoupling(coupling, shaft, self._true_excess.effort, self.load)

    @cached_property
    def natural_order(self) -> float | None:
        """Natural frequency of cranks and driven inertia on the coupling, over ω; None where not defined."""
        if self.machine.coupling is None or not self.omega or self.machine.flywheel is None:
            return None
        given = self.machine.flywheel.inertia
        return self._natural_order_with(given if given is not None else self._needed_in_all)

    def _natural_order_with(self, flywheel: float) -> float | None:
        from kurbel.solver.turning.coupling import natural_frequency

        assert self.machine.coupling
        assert self.omega
        inertia = self._mean_of_masses + flywheel
        return natural_frequency(self.machine.coupling, inertia) / self.omega if inertia else None

    @property
    def rigid(self) -> bool:
        """Whether the coupling is so stiff that it counts as rigid."""
        return self.natural_order is not None and self.natural_order > _RIGID_ABOVE

    @property
    def _needed_in_all(self) -> float:
        assert self.omega
        assert self.machine.flywheel
        assert self.machine.flywheel.fluctuation
        return self.dE / (self.machine.flywheel.fluctuation * self.omega**2)

    @property
    def _driven_rigidly(self) -> float:
        return self.machine.coupling.inertia if self.machine.coupling and self.rigid else 0.0

    @cached_property
    def _mean_of_masses(self) -> float:
        """Mean of what the moving masses add to the inertia over the turn, in kg m²."""
        grid, values = self._moving_inertia
        return grid.integral(values) / math.radians(self.cycle)

    @cached_property
    def _moving_inertia(self) -> tuple[Grid, Array]:
        """What the moving masses add to the inertia in kg m², on a grid."""
        grid = Grid(Sum([(1.0, mass) for mass in self.masses]).breaks if self.masses else np.array([0.0, self.cycle]))
        return grid, Inertia(0.0, self.masses, 1.0).at(grid.degrees, grid.within).value

    @property
    def _load_slope(self) -> float:
        """Slope of the load torque over the angular velocity at the nominal speed, in N m s."""
        law = self._law
        return 0.0 if law is None or not self.omega else 2 * float(law(np.zeros(1))[1][0]) / self.omega

    # speed line

    @cached_property
    def _law(self) -> SpeedLaw | None:
        """How the load depends on the speed; None where it does not, or is nothing on the mean."""
        load = self.machine.load
        largest = max(abs(self.M_max.value), abs(self.M_min.value))
        if load is None or abs(self.M_mean) <= 1e-12 * largest:
            return None
        if load.slip is not None:
            return SlipLaw(self.M_mean, load.slip)
        return PowerLaw(self.M_mean, load.power) if load.power else None

    @property
    def load_ignored(self) -> bool:
        """Whether the load depends on the speed, but stands in proportion to a mean torque of zero."""
        load = self.machine.load
        return load is not None and bool(load.slip or load.power) and self._law is None

    @cached_property
    def _true_excess(self) -> Excess:
        """The excess that changes the kinetic energy: efficiency takes its share of the effort, but not of inertia."""
        lost = 1 - self.efficiency
        if not lost or not self.masses:
            return self.excess
        return Excess(Sum((*self.effort.parts, *((lost, mass) for mass in self.masses))), self.load)

    @cached_property
    def speed(self) -> SpeedLine | ElasticCoupling | None:
        """The speed of the crank shaft over the turn; None without a flywheel or a speed.

        Raises NoSolutionError where the machine stalls.
        """
        if self.J is None or not self.omega:
            return None
        try:
            return self._line_with(1.0 if self._needs_no_inertia else self.J)
        except Unsettled as stop:
            raise NoSolutionError(self._refusal(stop)) from None

    @property
    def _needs_no_inertia(self) -> bool:
        """Whether the wanted δ is met by no flywheel at all, the effort being uniform; any inertia then turns alike."""
        return self.J == self.J_needed == 0 and not self.dE and not self.masses

    def _line_with(self, flywheel: float) -> SpeedLine | ElasticCoupling:
        """Return the speed with a flywheel in kg m²; raises Standstill, Unsettled, NoSolutionError, UsageError."""
        elastic = self.elastic if flywheel == self.J else self._coupled_to(flywheel)
        line = elastic or self._without_coupling(flywheel)
        if not line.omega_min.value > 0:
            raise Standstill(line.omega_min.degrees)
        return line

    def _without_coupling(self, flywheel: float) -> SpeedLine:
        assert self.omega
        turned = flywheel + (self.machine.coupling.inertia if self.machine.coupling else 0.0)
        self._refuse_no_inertia(turned)
        if self._law is not None:
            return SpeedDependentLoad(self._true_excess, self._law, Inertia(turned, self.masses, self.omega))
        return ConstantLoad(self._turning, turned)

    @cached_property
    def _turning(self) -> Turning:
        assert self.omega
        return Turning(self._true_excess, self.masses, self.omega)

    def _refuse_no_inertia(self, flywheel: float) -> None:
        grid, values = self._moving_inertia
        if values.min() + flywheel <= 1e-12 * (values.max() + flywheel):
            angle = float(grid.degrees.ravel()[np.argmin(values)])
            raise UsageError(f"nothing that turns has any inertia at φ = {angle:.4g}°: give 'flywheel' an inertia")

    def _refusal(self, stop: Unsettled) -> str:
        """Return where the machine stands still, if it does, and the flywheel with which it was found to turn."""
        assert self.J is not None
        with_this = f"with J = {show(self.J, 'inertia')}{' and the elastic coupling' if self.elastic else ''}"
        message = f"{with_this} no speed line is found that repeats under this load"
        if isinstance(stop, Standstill):
            message = (
                f"the machine stops near φ = {stop.degrees:.4g}°: {with_this} its kinetic energy does not carry it over"
            )
        enough = self._enough(stop.inertia)
        if enough is None:
            return f"{message}, nor is one with any other flywheel: look at its effort, load and speed"
        return (
            f"{message}; it turns with a flywheel from J = {show(enough, 'inertia')} "
            f"(GD2 = {show(4 * enough, 'gd2')}) on"
        )

    def _enough(self, more: float | None) -> float | None:
        """Return the smallest flywheel in kg m², within a fiftieth, with which the machine turns; None without any.

        more: kinetic energy in J that is known to be just enough.
        """
        assert self.J is not None
        assert self.omega
        least = max(self.J, 1e-6 * self._mean_of_masses, 1e-300)
        enough = self.J + 2 * more / self.omega**2 if more else least + self.dE / self.omega**2
        for _ in range(_DOUBLINGS):
            if self._turns(_rounded_up(enough)):
                break
            least, enough = enough, 2 * enough
        else:
            return None
        while not more and enough > 1.02 * max(least, enough / 1000):
            middle = math.sqrt(max(least, enough / 4) * enough)
            least, enough = (least, middle) if self._turns(_rounded_up(middle)) else (middle, enough)
        return _rounded_up(enough)

    def _turns(self, flywheel: float) -> bool:
        return flywheel != self.J and math.isfinite(self._delta_with(flywheel))

    @property
    def delta(self) -> float | None:
        """δ = (ω_max − ω_min)/ω_mean of the speed line."""
        return None if self.speed is None else self.speed.delta

    # the wanted δ, held against the speed line

    @cached_property
    def delta_needed(self) -> float | None:
        """δ of the speed line with the flywheel of the books for the wanted δ; None where it stalls."""
        if self.J_needed is None or self._needs_no_inertia:
            return None
        if self.J_needed == self.J:
            return self.delta
        delta = self._delta_with(self.J_needed)
        return delta if math.isfinite(delta) else None

    @property
    def misses_the_wish(self) -> bool:
        """Whether that differs from the wanted δ by what one would notice."""
        wanted = self.machine.flywheel.fluctuation if self.machine.flywheel else None
        return bool(wanted and self.delta_needed and abs(self.delta_needed / wanted - 1) > _MISSED)

    @cached_property
    def J_exact(self) -> float | None:
        """Flywheel in kg m² with which δ of the speed line is the wanted one, where that of the books misses it."""
        if not self.misses_the_wish or not self.J_needed:
            return None
        assert self.machine.flywheel
        wanted = self.machine.flywheel.fluctuation
        assert wanted

        def surplus(flywheel: float) -> float:
            delta = self._delta_with(flywheel)
            return wanted / delta - 1 if delta else math.inf

        return rising_root(surplus, self.J_needed)

    def _delta_with(self, flywheel: float) -> float:
        """Return δ of the speed line with another flywheel in kg m²; inf where it stalls."""
        try:
            line = self.speed if flywheel == self.J else None
            return (line or self._line_with(flywheel)).delta
        except (Unsettled, NoSolutionError, UsageError):
            return math.inf

    @property
    def omega_max(self) -> Extreme | None:
        """Largest angular velocity in rad/s."""
        return None if self.speed is None else self.speed.omega_max

    @property
    def omega_min(self) -> Extreme | None:
        """Smallest angular velocity in rad/s."""
        return None if self.speed is None else self.speed.omega_min

    @property
    def omega_mean(self) -> float | None:
        """Mean angular velocity over time in rad/s."""
        return None if self.speed is None else self.speed.omega_mean

    @property
    def multiplier(self) -> float | None:
        """Floquet multiplier per cycle; None where the load does not depend on the speed."""
        if self.elastic:
            return None if self._law is None else floquet(self.elastic.growth)
        return self.speed.multiplier if isinstance(self.speed, SpeedDependentLoad) else None

    def omega_line(self, degrees: Array) -> Array | None:
        """Return the angular velocity in rad/s at crank angles (n,) in degrees."""
        return None if self.speed is None else self.speed.omega(degrees)

    def M_coupling(self, degrees: Array) -> Array | None:
        """Return the torque in the elastic coupling in N m."""
        return None if self.elastic is None else self.elastic.torque(degrees)


def _rounded_up(value: float) -> float:
    """Return the next larger number of three digits."""
    digit = 10.0 ** (math.floor(math.log10(value)) - 2)
    return math.ceil(value / digit) * digit
