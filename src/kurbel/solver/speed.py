"""The angular velocity of the shaft over the cycle, of a machine with a flywheel or of many.

With the reduced inertia J(φ) = J + Σ m x′² the kinetic energy is ½ J(φ) ω² = ½ J(φ) ω_n² + z, and hence

    r = (ω/ω_n)² − 1 = z/(½ J(φ) ω_n²)        z′ = M − M_load(r)        u = ω/ω_n − 1 = r/(1 + √(1 + r))

z is the kinetic energy beyond that of uniform rotation; M is the torque at uniform rotation, inertia forces included,
whose part −½ ω_n² dJ/dφ makes up for the varying J(φ) in z. These forms lose no digits by cancellation, with a heavy
flywheel or a load that depends strongly on the speed.

Under a load that does not depend on the speed z = E + C, with the excess work E; the constant C is chosen so that the
mean speed over time is the nominal one. Under a load that does, z is the periodic solution, found by collocation.
"""

from __future__ import annotations

from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from kurbel.arrays import Array, Flags, Number
from kurbel.errors import UsageError
from kurbel.numerics.arithmetic import every
from kurbel.numerics.collocation import Unsettled, periodic
from kurbel.numerics.extreme import Extreme
from kurbel.numerics.pieces import Pieces, Sample, refined
from kurbel.quantity import value
from kurbel.solver.effort import TurningEffort
from kurbel.solver.figures import Results

_SLOWEST = 0.01
"""Relative to the nominal speed: below it, a machine under a constant load counts as stalled."""
_FASTEST = 3e5
"""Largest ω/ω_n that leaves a digit of the smallest energy."""
_STILL = 1e-12 - 1
"""Smallest (ω/ω_n)² − 1 for which a speed is computed."""
_NO_INERTIA = 1e-12
"""Relative to the largest inertia over the cycle: a smaller one counts as none."""


class SpeedLaw(NamedTuple):
    """Load torque as a function of speed: a power, mean · (ω/ω_n)^k, or by slip, mean + |mean| (ω/ω_n − 1)/s.

    mean: at the nominal speed in N m, (n,); power k or slip s: a number, or (n,), the other one None.
    """

    mean: Array
    power: Any = None
    slip: Any = None

    @classmethod
    def of(cls, effort: TurningEffort) -> SpeedLaw | None:
        """Return the law of a machine; None where its load does not depend on the speed, or has a mean of zero."""
        load = effort.machine.load
        if load is None or load.diagram or not effort.mean.any():
            return None
        is_constant = load.slip is None and every(load.power == 0)
        if is_constant:
            return None
        return cls(effort.mean, load.power, load.slip)

    @property
    def steepness(self) -> Array:
        """ω_n dM_load/dω at the nominal speed in N m, (n,)."""
        if self.slip is None:
            return self.mean * self.power
        return np.abs(self.mean) / self.slip

    def rise(self, ratio: Array, pieces: Pieces) -> tuple[Array, Array]:
        """Return the load beyond that at the nominal speed in N m, and its derivative by r, at r (…, pieces)."""
        if self.slip is not None:
            steepness, root = pieces.of(self.steepness), np.sqrt(1 + ratio)
            return steepness * ratio / (1 + root), steepness / (2 * root)
        mean, half, logarithm = pieces.of(self.mean), pieces.of(self.power) / 2, np.log1p(ratio)
        return mean * np.expm1(half * logarithm), mean * half * np.exp((half - 1) * logarithm)


class SpeedLine(Results):
    """Speed of the crankshaft over the cycle: samples of u = ω/ω_n − 1 (nodes, pieces).

    mean (n,): mean speed over ω_n. failed (n,): True for machines of a batch without a speed line; one machine alone
    raises UsageError instead, or Unsettled where u falls to `least`. alpha: pieces and samples of dω/dt in rad/s².
    growth: logarithm of the factor by which a small disturbance of the speed changes in one cycle.
    """

    delta = value(
        "δ",
        "ratio",
        "Coefficient of speed fluctuation, (ω_max − ω_min)/ω_m",
        lambda line: line.fluctuation,
    )
    omega_max = value(
        "ω_max", "angular_velocity", "Largest angular velocity", lambda line: line.extreme(0)
    )
    omega_min = value(
        "ω_min", "angular_velocity", "Smallest angular velocity", lambda line: line.extreme(2)
    )
    omega_mean = value(
        "ω_m",
        "angular_velocity",
        "Mean angular velocity over time",
        lambda line: line.result(line.effort.omega * line.mean),
    )
    alpha: Any
    growth: Any

    def __init__(
        self,
        effort: TurningEffort,
        pieces: Pieces,
        u: Array,
        mean: Array,
        failed: Flags,
        least: float,
    ) -> None:
        beyond = ~(pieces.largest(u) < _FASTEST)
        self.effort, self.pieces, self.mean = effort, pieces, mean
        self.u = np.where(pieces.of(failed) | ~np.isfinite(u), 0.0, u)
        self._ends = [extreme[0] for extreme in pieces.extremes(self.u[None])]
        stands = self._ends[2] <= least
        self.failed = failed | beyond | stands
        if effort.count is None and stands[0]:
            raise Unsettled(degrees=float(self._ends[3][0]))
        if effort.count is None and beyond[0]:
            raise UsageError("numeric overflow in the speed: check effort and flywheel")

    def result(self, values: Array) -> Any:
        """Return values (n,), nan for machines without a speed line; for one machine a float."""
        return self.effort.result(np.where(self.failed, np.nan, values))

    @property
    def fluctuation(self) -> Number:
        """δ, from the extremes of u; for a heavy flywheel the difference of those of ω would lose all digits."""
        return self.result((self._ends[0] - self._ends[2]) / self.mean)

    def extreme(self, end: int) -> Any:
        """Return the largest (end 0) or smallest (end 2) angular velocity in rad/s, with its angle if that is known."""
        u, degrees = self._ends[end : end + 2]
        return Extreme(self.result(self.effort.omega * (1 + u)), self.result(degrees))

    @property
    def omega(self) -> tuple[Pieces, Array] | None:
        """Samples of the angular velocity in rad/s with their pieces."""
        return self.pieces, self.pieces.of(self.effort.omega) * (1 + self.u)


class SwingLine(SpeedLine):
    """Extremes of the speed for an effort of which only ΔE in J, (n,), is known; ω over the angle is not.

    With ω_m = (ω_max + ω_min)/2 exactly ΔE = ½ J (ω_max² − ω_min²) = δ J ω_m². flywheel in kg m².
    """

    alpha = None

    def __init__(self, effort: TurningEffort, swing: Array, flywheel: Number) -> None:
        self.effort, self.pieces, self.mean = effort, effort.pieces, np.ones(effort.pieces.count)
        energy = np.ones(effort.pieces.count) * (flywheel * effort.omega**2)
        if effort.count is None and not energy[0]:
            raise UsageError("nothing that turns has any inertia: give 'flywheel' an inertia")
        self._delta = swing / np.where(energy == 0, np.nan, energy)
        self.failed = ~(self._delta < 2)
        self.growth = self.result(np.zeros(effort.pieces.count))
        if effort.count is None and self.failed[0]:
            raise Unsettled()

    @property
    def fluctuation(self) -> Number:
        """δ."""
        return self.result(self._delta)

    def extreme(self, end: int) -> Any:
        """Return the largest (end 0) or smallest (end 2) angular velocity in rad/s."""
        return self.result(self.effort.omega * (1 + (0.5 - 0.5 * end) * self._delta))

    @property
    def omega(self) -> None:
        """None: the speed is not known over the angle."""
        return None


class SpeedEquation:
    """z′ = M − M_load(r), r = z/(½ J(φ) ω_n²), for `kurbel.numerics.collocation`; flywheel in kg m², (n,)."""

    unknowns = 1
    bounded: int | None = 0
    modal = None

    def __init__(self, effort: TurningEffort, law: SpeedLaw | None, flywheel: Array) -> None:
        self._effort, self._law, self.flywheel = effort, law, flywheel
        self._course = np.stack((effort.true_excess.torque, effort.J_moving))
        # a torque known to one unit in the last place moves z by this in a turn; the energy is not known better either
        energy = np.minimum.reduceat(self.known(effort.pieces)[1].min(axis=0), effort.pieces.first)
        self.noise = 1e-16 * np.minimum(effort.pieces.largest(effort.M), energy)

    def known(self, pieces: Pieces) -> Array:
        """Return M − M_load at uniform rotation in N m, and the kinetic energy ½ J(φ) ω_n² in J."""
        excess, moving = pieces.resampled(self._course, self._effort.pieces)
        inertia = moving + pieces.of(self.flywheel)
        return np.stack((excess, inertia * pieces.of(self._effort.omega**2 / 2)))

    def rate(self, samples: Array, y: Array, pieces: Pieces) -> tuple[Array, Array]:
        """Return z′ and its derivative by z."""
        assert self._law
        excess, energy = samples
        rise, slope = self._law.rise(y[0] / energy, pieces)
        return (excess - rise)[None], (-slope / energy)[None, None]


class RigidLine(SpeedLine):
    """The speed line of machines whose flywheels (n,) in kg m² turn with the cranks.

    Raises Unsettled where the only machine has none, UsageError where nothing that turns has inertia.
    """

    def __init__(self, effort: TurningEffort, law: SpeedLaw | None, flywheel: Array) -> None:
        moving, first = effort.J_moving, effort.pieces.first
        least = np.minimum.reduceat(np.minimum.reduce(moving), first) + flywheel
        most = np.maximum.reduceat(np.maximum.reduce(moving), first) + flywheel
        failed = least <= _NO_INERTIA * most
        if effort.count is None and failed[0]:
            angle = float(effort.pieces.degrees.T.ravel()[np.argmin(moving.T)])
            raise UsageError(
                f"no rotating part has inertia at φ = {angle:.4g}°: give 'flywheel' an inertia"
            )
        self.law = law
        # any inertia for the failed ones of a batch, so that the others are computed
        self._equation = SpeedEquation(effort, law, np.where(failed, 1.0, flywheel))

        if law:
            course = periodic(self._equation, effort.pieces)
            if effort.count is None:
                course.refuse()
            # in a batch: a load with a mean of zero fails, too
            failed = failed | course.failed | (law.mean == 0)
            sample = self._speeds(course.pieces, course.samples[0], np.zeros(len(failed)))
            pieces, (u, lag) = refined(course.pieces, sample)
        else:
            pieces, u, lag = self._under_constant_load(effort)
        least_u = -1.0 if law else 1.000001 * _SLOWEST - 1
        super().__init__(effort, pieces, u, 1 / (1 + pieces.mean(lag)), failed, least_u)

    def _speeds(self, source: Pieces, energy: Array, constant: Array) -> Sample:
        """Return a function that samples u and ω_n/ω − 1; z = energy + constant in J.

        The mean of ω_n/ω − 1 over φ gives the mean speed over time.
        """

        def sample(pieces: Pieces) -> Array:
            z = pieces.resampled(energy, source) + pieces.of(constant)
            ratio = np.maximum(z / self._equation.known(pieces)[1], _STILL)
            u = ratio / (1 + np.sqrt(1 + ratio))
            return np.stack((u, -u / (1 + u)))

        return sample

    def _under_constant_load(self, effort: TurningEffort) -> tuple[Pieces, Array, Array]:
        """Return pieces, u and ω_n/ω − 1 for z = E + C, with C that makes the mean of the latter 0.

        That mean decreases with C and is convex, so Newton's method starts at the smallest C, where the machine almost
        stalls. A machine whose mean speed is too high even there keeps this C.
        """
        pieces, E = effort.pieces, effort.true_excess.E
        while True:
            excess = pieces.resampled(E, effort.pieces)
            _, energy = self._equation.known(pieces)
            missing = (_SLOWEST**2 - 1) * energy - excess
            least = np.maximum.reduceat(missing.max(axis=0), pieces.first)
            swing = pieces.largest(excess)
            constant = least
            for _ in range(100):
                _, lag = self._speeds(effort.pieces, E, constant)(pieces)
                slope = pieces.mean(-0.5 * (1 + lag) ** 3 / energy)
                before = constant
                constant = np.maximum(before - pieces.mean(lag) / slope, least)
                if (np.abs(constant - before) <= 1e-15 * swing).all():
                    break
            fine, (u, lag) = refined(pieces, self._speeds(effort.pieces, E, constant))
            if fine is pieces:
                return pieces, u, lag
            pieces = fine

    @cached_property
    def growth(self) -> Any:
        """Logarithm of the factor by which a small disturbance changes in a cycle: −∮ ∂M_load/∂ω/(J ω) dφ."""
        if self.law is None:
            return self.result(np.zeros(self.pieces.count))
        slope = self.law.rise(self.u * (2 + self.u), self.pieces)[1]
        return self.result(-self.pieces.integral(slope / self._equation.known(self.pieces)[1]))

    @cached_property
    def alpha(self) -> tuple[Pieces, Array]:
        """Samples of α = ½ ω_n² dr/dφ in rad/s²: e r′ = M − M_load − r e′, e = ½ J(φ) ω_n²."""
        effort = self.effort

        def sample(pieces: Pieces) -> Array:
            u = pieces.resampled(self.u, self.pieces)
            excess, energy = self._equation.known(pieces)
            ratio = u * (2 + u)
            torque = pieces.resampled(effort.inertia_torque, effort.pieces)
            rise = self.law.rise(ratio, pieces)[0] if self.law else 0.0
            slope = (excess - rise + ratio * torque) / energy  # dr/dφ
            return (slope * pieces.of(effort.omega**2 / 2))[None]

        pieces, (values,) = refined(self.pieces, sample)
        return pieces, np.where(pieces.of(self.failed), 0.0, values)

    def torque_beyond(self, inertia: Number) -> tuple[Pieces, Array]:
        """Return samples of J₂ α + M_load in N m: what passes to the load and an inertia J₂ in kg m² that it drives."""
        pieces, alpha = self.alpha
        effort = self.effort
        load = pieces.resampled(effort.load, effort.pieces)
        if self.law:
            u = pieces.resampled(self.u, self.pieces)
            load = load + self.law.rise(u * (2 + u), pieces)[0]
        return pieces, pieces.of(inertia) * alpha + load
