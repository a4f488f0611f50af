"""The speed of the shaft over the turn: z, the kinetic energy beyond that of uniform rotation, decides it.

With the reduced inertia J(φ) = J + Σ m x′² the kinetic energy is ½ J(φ) ω_n² + z, hence ω = ω_n √(1 + z/(½ J(φ) ω_n²)).
z changes by the excess of the turning effort at uniform rotation, inertia forces included, over the load at the true
speed. Nothing cancels, whether the flywheel is heavy or the load stiff.
"""

import math
from abc import ABC, abstractmethod
from collections.abc import Callable
from functools import cached_property

import numpy as np

from kurbel.arrays import Array
from kurbel.errors import UsageError
from kurbel.numerics.collocation_old import Periodic, Standstill, periodic
from kurbel.numerics.elements import Elements
from kurbel.numerics.extreme import Extreme
from kurbel.numerics.grid import Grid
from kurbel.numerics.jet import Jet
from kurbel.numerics.search import Extremes, Sampled, extremes
from kurbel.solver.turning.excess import Excess
from kurbel.solver.turning.machine_effort import MovingInertia


class Place:
    """Crank angles (…,) on the sides of jumps that hold `within`, with what no flywheel changes there, each (…,)."""

    def __init__(self, course: "Course", degrees: Array, within: Array) -> None:
        self._course = course
        self.degrees = degrees
        self.within = within

    @cached_property
    def torque(self) -> Jet:
        """The excess of the turning effort in N m with its slope."""
        return self._course.excess.line.at(self.degrees, self.within)

    @cached_property
    def work(self) -> Array:
        """The excess work E in J."""
        return self._course.excess.at(self.degrees)

    @cached_property
    def moving(self) -> Jet:
        """The moving inertia Σ m x′² + … in kg m² with its slope."""
        return self._course.moving.line.at(self.degrees, self.within)

    @cached_property
    def bending(self) -> Array:
        """The second derivative of that by φ."""
        return np.asarray(self._course.moving.bending.at(self.degrees, self.within).slope)


class Course:
    """What drives the speed line of a machine with any flywheel: the excess of its effort and its moving inertia."""

    def __init__(self, excess: Excess, moving: MovingInertia) -> None:
        self.excess = excess
        self.moving = moving

    def at(self, degrees: Array, within: Array) -> Place:
        """Return what there is at crank angles (…,) in degrees within the cycle, on the sides that hold `within`."""
        return Place(self, degrees, within)

    def on(self, grid: Grid) -> Place:
        """Return what there is at the nodes of a grid."""
        return self.at(grid.degrees, grid.within)

    @cached_property
    def fine(self) -> tuple[Grid, Place]:
        """The grid cut ever finer on both sides of the crossings, where a slow machine lingers, with its nodes."""
        grid = self.excess.grid
        if self.excess.crossings:
            steps = np.array([0.0, *(sign * 10.0 / 3.0**k for k in range(4) for sign in (1, -1))])
            angles = (np.array(self.excess.crossings)[:, None] + steps).ravel()
            grid = grid.split_at(np.mod(angles, self.excess.cycle))
        return grid, self.on(grid)


class Inertia:
    """The reduced moment of inertia J(φ) = J + Σ m x′² + … in kg m², at a nominal angular velocity ω_n in rad/s."""

    def __init__(self, flywheel: float, omega: float) -> None:
        self.flywheel = flywheel
        self.omega = omega

    def energy(self, place: Place) -> Jet:
        """Return ½ J(φ) ω_n² in J with its slope."""
        return (place.moving + self.flywheel) * (self.omega**2 / 2)

    def energy_curvature(self, place: Place) -> Array:
        """Return the second derivative of that by φ in J."""
        return np.asarray(place.bending * (self.omega**2 / 2))


SpeedLaw = Callable[[Array], tuple[Array, Array]]
"""How a load rises with the speed: takes r = (ω/ω_n)² − 1 (…,) and returns its torque less that at the nominal speed in
N m, and the derivative of that by r, (…,) each."""


def constant_law(ratio: Array) -> tuple[Array, Array]:
    """A load that does not mind the speed; see `SpeedLaw`."""
    return np.zeros_like(ratio), np.zeros_like(ratio)


def power_law(mean: float, exponent: float) -> SpeedLaw:
    """Return M_m ((ω/ω_n)^k − 1)."""

    def law(ratio: Array) -> tuple[Array, Array]:
        half, logarithm = exponent / 2, np.log1p(ratio)
        return mean * np.expm1(half * logarithm), mean * half * np.exp((half - 1) * logarithm)

    return law


def slip_law(mean: float, slip: float) -> SpeedLaw:
    """Return |M_m| (ω/ω_n − 1)/s: an induction machine on the grid, generator or motor."""
    steepness = abs(mean) / slip

    def law(ratio: Array) -> tuple[Array, Array]:
        root = np.sqrt(1 + ratio)
        return steepness * ratio / (1 + root), steepness / (2 * root)

    return law


class SpeedLine(ABC):
    """ω over the turn. `z(place)` is the kinetic energy beyond that of uniform rotation, in J.

    law: of the load; grid, nodes: on which it is searched; growth: logarithm of what is left of a small disturbance
    after a cycle. Its extremes, and what hangs on them, raise Standstill where ω falls to
    SLOWEST times the nominal speed.
    """

    SLOWEST = 0.0
    growth = 0.0

    def __init__(self, course: Course, law: SpeedLaw, inertia: Inertia, grid: Grid, nodes: Place) -> None:
        self.course, self.law, self.inertia = course, law, inertia
        self.grid = grid
        self._nodes = nodes
        self.cycle = float(grid.breaks[-1])

    @abstractmethod
    def z(self, place: Place) -> Array:
        """Return z in J at crank angles (…,) within the cycle."""

    def _ratio(self, place: Place) -> Sampled:
        """Return (ω/ω_n)² − 1 with its slope by φ."""
        energy = self.inertia.energy(place)
        ratio = self.z(place) / energy.value
        return Sampled(ratio, (place.torque.value - self.law(ratio)[0] - ratio * energy.slope) / energy.value)

    @cached_property
    def _samples(self) -> Sampled:
        return self._ratio(self._nodes)

    @cached_property
    def _extremes(self) -> Extremes:
        if not np.isfinite(self._samples.value).all():
            raise UsageError("the speed line leads beyond what can be computed with: check effort and flywheel")
        found = extremes(self.grid, {"r": self._samples}, lambda *at: {"r": self._ratio(self.course.at(*at))})["r"]
        if not found.smallest.value > self.SLOWEST**2 - 1:
            raise Standstill(found.smallest.degrees)
        return found

    def curves(self, degrees: Array, within: Array) -> dict[str, Sampled]:
        """Return ω in rad/s and its derivative by time in rad/s², each with its slope by φ."""
        place, nominal = self.course.at(degrees, within), self.inertia.omega
        ratio = self._ratio(place)
        omega = nominal * np.sqrt(1 + ratio.value)
        return {"omega": Sampled(omega, nominal**2 * ratio.slope / (2 * omega)), "alpha": self._alpha(place)}

    @cached_property
    def omega_max(self) -> Extreme:
        """Largest angular velocity in rad/s."""
        return self._omega_at(self._extremes.largest)

    @cached_property
    def omega_min(self) -> Extreme:
        """Smallest angular velocity in rad/s."""
        return self._omega_at(self._extremes.smallest)

    def _omega_at(self, ratio: Extreme) -> Extreme:
        return Extreme(self.inertia.omega * math.sqrt(1 + ratio.value), ratio.degrees)

    def _alpha(self, place: Place) -> Sampled:
        """Return dω/dt = ½ ω_n² dr/dφ in rad/s², r = (ω/ω_n)² − 1, with its slope by φ.

        With e = ½ J(φ) ω_n²: e r′ = M − M_load − r e′, and so e r″ = (M − M_load)′ − 2 r′ e′ − r e″.
        """
        energy, bend = self.inertia.energy(place), self.inertia.energy_curvature(place)
        ratio, slope = self._ratio(place)
        rising = self.law(ratio)[1] * slope
        curvature = (place.torque.slope - rising - 2 * slope * energy.slope - ratio * bend) / energy.value
        half = self.inertia.omega**2 / 2
        return Sampled(half * slope, half * curvature)

    @cached_property
    def alpha_extremes(self) -> Extremes:
        """Largest and smallest angular acceleration in rad/s²."""
        alpha = {"alpha": self._alpha(self._nodes)}
        return extremes(self.grid, alpha, lambda *at: {"alpha": self._alpha(self.course.at(*at))})["alpha"]

    @cached_property
    def omega_mean(self) -> float:
        """Mean angular velocity over time in rad/s: 2π by the time of a turn."""
        slowness = -self._samples.value / (np.sqrt(1 + self._samples.value) * (1 + np.sqrt(1 + self._samples.value)))
        return self.inertia.omega / (1 + self.grid.integral(slowness) / math.radians(self.cycle))

    @cached_property
    def delta(self) -> float:
        """δ = (ω_max − ω_min)/ω_mean, as the difference of the squares over the sum, which loses nothing."""
        squares = self._extremes.largest.value - self._extremes.smallest.value
        return self.inertia.omega**2 * squares / ((self.omega_max.value + self.omega_min.value) * self.omega_mean)


class ConstantLoad(SpeedLine):
    """ω under a load that does not depend on speed: z = E + C, closed.

    Such a load lets the machine run at any speed; C is chosen so that the mean speed over time is the nominal one.
    Raises Standstill where that takes a smallest speed below a hundredth of it.
    """

    SLOWEST = 0.01

    def __init__(self, course: Course, inertia: Inertia) -> None:
        super().__init__(course, constant_law, inertia, *course.fine)
        self.constant = self._constant()

    def z(self, place: Place) -> Array:
        """Return E + C in J; see `SpeedLine`."""
        return place.work + self.constant

    def _constant(self) -> float:
        """C in J, from ∫ dφ/ω = 2π/ω_n: the mean of 1/√(1 + r) is 1. That falls and is convex: Newton from below."""
        energy, excess = self.inertia.energy(self._nodes).value, self._nodes.work
        least = -excess + (self.SLOWEST**2 - 1) * energy
        constant = float(least.max())
        whole = math.radians(self.cycle)
        for _ in range(100):
            ratio = (excess + constant) / energy
            root = np.sqrt(1 + ratio)
            lag = self.grid.integral(-ratio / (root * (1 + root))) / whole
            slope = self.grid.integral(-0.5 / ((1 + ratio) * root * energy)) / whole
            step = -lag / slope
            if step < 0 and constant == float(least.max()):
                raise Standstill(float(self.grid.degrees.ravel()[np.argmax(least)]))
            constant += step
            if abs(step) <= 1e-15 * np.ptp(excess):
                break
        return constant


class SpeedEquation:
    """z′ = M − M_load(ω), ω from z; see `collocation.Equation`."""

    def __init__(self, course: Course, law: SpeedLaw, inertia: Inertia, noise: float, eased: float = 0.0) -> None:
        self.course, self.law, self.inertia, self.noise = course, law, inertia, noise
        self._more = eased

    def prepared(self, degrees: Array, within: Array) -> Array:
        """See `collocation.Equation`."""
        place = self.course.at(degrees, within)
        return np.stack((place.torque.value, self.inertia.energy(place).value + self._more))

    def eased(self, by: float) -> "SpeedEquation":
        """See `collocation.Equation`: so much more inertia, as ½ J ω_n² in J."""
        return SpeedEquation(self.course, self.law, self.inertia, self.noise, by)

    def rate(self, prepared: Array, z: Array) -> tuple[Array, Array]:
        """See `collocation.Equation`."""
        excess, energy = prepared
        rise, slope = self.law(z[..., 0] / energy)
        return (excess - rise)[..., None], (-slope / energy)[..., None, None]

    def floor(self, prepared: Array) -> Array:
        """See `collocation.Equation`."""
        return np.asarray(-prepared[1])[..., None]


class SpeedDependentLoad(SpeedLine):
    """ω under a load that depends on speed: the periodic state, found by collocation over the whole cycle."""

    def __init__(self, course: Course, law: SpeedLaw, inertia: Inertia) -> None:
        # a torque known to one unit in the last place moves z by this in a turn; the energy is not known better either
        excess = course.excess
        torque = max(abs(extreme.value) for extreme in excess.effort_extremes)
        energy = inertia.energy(course.on(excess.grid)).value.min()
        noise = 1e-16 * min(torque, float(energy))
        # elements as wide as whole pieces see too little of a load that all but stalls
        elements = Elements.over(excess.grid.other().breaks)
        self.solution: Periodic = periodic(SpeedEquation(course, law, inertia, noise), elements)
        self.growth = self.solution.growth
        grid = Grid(np.append(self.solution.elements.low, excess.cycle))
        super().__init__(course, law, inertia, grid, course.on(grid))

    def z(self, place: Place) -> Array:
        """Return z in J; see `SpeedLine`."""
        return np.asarray(self.solution.at(place.degrees, place.within)[..., 0])
