"""The speed of the shaft over the turn, of a machine with a flywheel or of many.

With the reduced inertia J(φ) = J + Σ m x′² the kinetic energy is ½ J(φ) ω² = ½ J(φ) ω_n² + z, and hence

    r = (ω/ω_n)² − 1 = z/(½ J(φ) ω_n²)        z′ = M − M_load(r)

with M at uniform rotation, inertia forces included: z is the energy beyond that of uniform rotation. Nothing cancels,
whether the flywheel is heavy or the load stiff.

A load that does not depend on the speed lets the machine run at any speed: z = E + C is closed, and C makes the mean
speed over time the nominal one. Under a load that depends on it z is the periodic solution, found by collocation.
"""

from __future__ import annotations

from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from kurbel.arrays import Array, Flags
from kurbel.errors import UsageError
from kurbel.numerics.arithmetic import every
from kurbel.numerics.collocation import Periodic, Standstill, growth, periodic
from kurbel.numerics.extreme import Extreme, Extremes
from kurbel.numerics.pieces import TAIL, Pieces, joined, refined
from kurbel.solver.effort import Term, TurningEffort, inertia_torque

_SLOWEST = 0.01
"""Of the nominal speed: a machine under a constant load that falls below it stands still."""
_NARROWEST = 1e-8
"""Degrees of a piece that is halved no more."""
_MORE_PIECES = 3000
"""So many more pieces show what can be shown of ω_n/ω: beyond them its rounding is halved."""
_FASTEST = 1e11
"""Largest (ω/ω_n)² that leaves a digit of the smallest one."""
_BEYOND = "the speed line leads beyond what can be computed with: check effort and flywheel"
_NO_INERTIA = 1e-12
"""Of the largest inertia over the turn: what is smaller is none."""


class SpeedLaw(NamedTuple):
    """How the load rises with the speed: as a power, mean · (ω/ω_n)^k, or by the slip, mean ± |mean| (ω/ω_n − 1)/s.

    mean: M at the nominal speed in N m, (n,); power or slip: a number, or (n,), the other one None.
    """

    mean: Array
    power: Any = None
    slip: Any = None

    @classmethod
    def of(cls, effort: TurningEffort) -> SpeedLaw | None:
        """Return that of a machine; None where its load does not depend on the speed, or is nothing on the mean."""
        load = effort.machine.load
        if load is None or not effort.mean.any():
            return None
        if load.slip is not None:
            return cls(effort.mean, slip=load.slip)
        return cls(effort.mean, power=load.power) if load.power is not None and not every(load.power == 0) else None

    def rise(self, ratio: Array, pieces: Pieces) -> tuple[Array, Array]:
        """Return the load beyond that at the nominal speed in N m, and its derivative by r, at r (…, pieces)."""
        mean = pieces.of(self.mean)
        if self.slip is not None:
            steepness, root = np.abs(mean) / pieces.of(self.slip), np.sqrt(1 + ratio)
            return steepness * ratio / (1 + root), steepness / (2 * root)
        half, logarithm = pieces.of(self.power) / 2, np.log1p(ratio)
        return mean * np.expm1(half * logarithm), mean * half * np.exp((half - 1) * logarithm)


class Course:
    """What drives the speed line with any flywheel: the excess of the effort, E, and the moving inertia over φ."""

    def __init__(self, effort: TurningEffort) -> None:
        self.effort, self.pieces = effort, effort.pieces
        self.samples = np.stack((effort.true_excess.torque, effort.J_moving, effort.true_excess.E))

    def on(self, pieces: Pieces, *which: int) -> Array:
        """Return excess in N m, moving inertia in kg m², and E in J, or which of them, at the nodes of pieces."""
        return pieces.carried(self.samples[list(which) or slice(None)], self.pieces)

    @cached_property
    def inertia_torque(self) -> Array:
        """The torque of all moving masses in N m, −½ ω_n² dJ/dφ."""
        effort = self.effort
        return effort.sampled([Term(1.0, one, inertia_torque) for _, one, _ in effort.inertia_terms])


class SpeedEquation:
    """z′ = M − M_load(r), r = z/(½ J(φ) ω_n²), as an equation of `kurbel.numerics.collocation`."""

    unknowns = 1

    def __init__(self, course: Course, law: SpeedLaw, flywheel: Array) -> None:
        self.course, self.law, self.flywheel = course, law, flywheel
        # a torque known to one unit in the last place moves z by this in a turn; the energy is not known better either
        torque, energy = course.pieces.largest(course.effort.M), self.energy(course.samples[1], course.pieces)
        self.noise = 1e-16 * np.minimum(torque, np.minimum.reduceat(energy.min(axis=0), course.pieces.first))

    def energy(self, moving: Array, pieces: Pieces) -> Array:
        """Return ½ J(φ) ω_n² in J where the moving masses have so much inertia in kg m²."""
        omega: Any = self.course.effort.omega
        return np.asarray((moving + pieces.of(self.flywheel)) * pieces.of(omega * omega / 2))

    def known(self, pieces: Pieces) -> Array:
        """Return M − M_load at uniform rotation in N m, and ½ J(φ) ω_n² in J."""
        excess, moving = self.course.on(pieces, 0, 1)
        return np.stack((excess, self.energy(moving, pieces)))

    def rate(self, known: Array, z: Array, pieces: Pieces, eased: Array) -> tuple[Array, Array]:
        """Return z′ and its derivative by z; eased: so much more kinetic energy in J."""
        energy = known[1] + pieces.of(eased)
        rise, slope = self.law.rise(z[0] / energy, pieces)
        return (known[0] - rise)[None], (-slope / energy)[None, None]

    def floor(self, known: Array, pieces: Pieces, eased: Array) -> Array:
        """Return the z of a machine that stands still."""
        return np.asarray(-(known[1] + pieces.of(eased)))[None]

    def also(self, known: Array, z: Array, pieces: Pieces, eased: Array) -> Array:
        """Return r, and ω_n/ω, of which the mean over time is made."""
        ratio = z[0] / (known[1] + pieces.of(eased))
        return np.stack((ratio, 1 / np.sqrt(np.maximum(1 + ratio, 1e-12))))


class SpeedLine:
    """The speed of machines over the turn, by samples of r = (ω/ω_n)² − 1 on pieces of their cycles.

    failed (n,): which of a batch have none; found: the solution of their equation, None under a load that does not
    depend on the speed.
    """

    def __init__(
        self,
        course: Course,
        flywheel: Array,
        pieces: Pieces,
        ratio: Array,
        failed: Flags,
        law: SpeedLaw | None = None,
        growth: Array | None = None,
    ) -> None:
        self.course, self.flywheel, self.law, self.pieces = course, flywheel, law, pieces
        self.ratio, self.failed, self._growth = np.where(pieces.of(failed), 0.0, ratio), failed, growth
        if course.effort.count is None and not np.isfinite(ratio).all():
            raise UsageError(_BEYOND)

    def told(self, values: Array) -> Any:
        """Return values (n,), nan for machines without a speed line; for one machine a float."""
        return self.course.effort.told(np.where(self.failed, np.nan, values))

    @cached_property
    def _omega(self) -> Array:
        return np.broadcast_to(np.asarray(self.course.effort.omega), self.pieces.count)

    @cached_property
    def _extremes(self) -> tuple[Array, Array, Array, Array]:
        """Largest and smallest r with their angles in degrees, (n,)."""
        high, high_at, low, low_at = (one[0] for one in self.pieces.extremes(self.ratio[None]))
        slowest = 0.0 if self.law else _SLOWEST
        stands = ~(low > slowest**2 - 1)
        if self.course.effort.count is None and stands[0]:
            raise Standstill(float(low_at[0]))
        self.failed = self.failed | stands
        return high, high_at, np.where(stands, 0.0, low), low_at

    def _omega_at(self, which: int) -> Extreme:
        ratio, degrees = self._extremes[which : which + 2]
        return Extreme(self.told(self._omega * np.sqrt(1 + ratio)), self.told(degrees))

    @property
    def omega_max(self) -> Extreme:
        """Largest angular velocity in rad/s."""
        return self._omega_at(0)

    @property
    def omega_min(self) -> Extreme:
        """Smallest angular velocity in rad/s."""
        return self._omega_at(2)

    @cached_property
    def _mean(self) -> Array:
        """Mean angular velocity over time over the nominal one: 2π by the time of a turn."""
        return 1 / (1 + self.pieces.mean(_slowness(self.ratio)))

    @property
    def omega_mean(self) -> Any:
        """Mean angular velocity over time in rad/s."""
        return self.told(self._omega * self._mean)

    @property
    def delta(self) -> Any:
        """δ = (ω_max − ω_min)/ω_mean, as the difference of the squares over the sum, which loses nothing."""
        high, _, low, _ = self._extremes
        return self.told((high - low) / ((np.sqrt(1 + high) + np.sqrt(1 + low)) * self._mean))

    @property
    def growth(self) -> Any:
        """Logarithm of what is left of a small disturbance after a cycle: −∮ ∂M_load/∂ω/(J ω) dφ."""
        return self.told(np.zeros(self.pieces.count) if self._growth is None else self._growth)

    def _alpha_on(self, pieces: Pieces) -> Array:
        """Return dω/dt = ½ ω_n² dr/dφ in rad/s² at the nodes of pieces: e r′ = M − M_load − r e′, e = ½ J(φ) ω_n²."""
        excess, moving = self.course.on(pieces, 0, 1)
        torque = pieces.carried(self.course.inertia_torque, self.course.pieces)
        ratio = pieces.carried(self.ratio, self.pieces)
        rise = self.law.rise(ratio, pieces)[0] if self.law else 0.0
        return np.asarray((excess - rise + ratio * torque) / (moving + pieces.of(self.flywheel)))

    @cached_property
    def _alpha(self) -> tuple[Pieces, Array]:
        pieces, values = refined(self.pieces, lambda some: self._alpha_on(some)[None])
        return pieces, np.where(pieces.of(self.failed), 0.0, values)

    @cached_property
    def alpha_extremes(self) -> Extremes:
        """Largest and smallest angular acceleration in rad/s²."""
        pieces, values = self._alpha
        return pieces.extremes(values).each(self.told)[0]

    def samples_of(self, column: str) -> tuple[Pieces, Array] | None:
        """Return the samples of ω in rad/s or α in rad/s² with their pieces; None for another column."""
        if column == "omega":
            return self.pieces, self._omega[0] * np.sqrt(1 + self.ratio)
        return (self._alpha[0], self._alpha[1][0]) if column == "alpha" else None


def _slowness(ratio: Array) -> Array:
    """Return ω_n/ω − 1 where (ω/ω_n)² − 1 is r."""
    root = np.sqrt(1 + ratio)
    return np.asarray(-ratio / (root * (1 + root)))


def speed_line(course: Course, law: SpeedLaw | None, flywheel: Array) -> SpeedLine:
    """Return the speed line of machines with flywheels (n,) in kg m².

    Raises Standstill or Unsettled where the only machine has none, UsageError where nothing that turns has inertia.
    """
    effort, moving, first = course.effort, course.samples[1], course.pieces.first
    least, most = (one.reduceat(moving, first, axis=1) for one in (np.minimum, np.maximum))
    least, most = least.min(axis=0) + flywheel, most.max(axis=0) + flywheel
    none = least <= _NO_INERTIA * most
    if law is not None:
        none |= law.mean == 0  # of a batch: its load is nothing on the mean
    if effort.count is None and none[0]:
        angle = float(course.pieces.degrees.T.ravel()[np.argmin(moving.T)])
        raise UsageError(f"nothing that turns has any inertia at φ = {angle:.4g}°: give 'flywheel' an inertia")
    flywheel = np.where(none, 1.0, flywheel)  # no machine of a batch stops the others
    if law is None:
        pieces, ratio, failed = _constant_load(course, flywheel)
        return SpeedLine(course, flywheel, pieces, ratio, none | failed)
    equation = SpeedEquation(course, law, flywheel)
    found: Periodic = periodic(equation, course.pieces)
    if effort.count is None:
        found.refuse()
    ratio = found.samples[0] / equation.known(found.pieces)[1]
    return SpeedLine(course, flywheel, found.pieces, ratio, none | found.failed, law, growth(equation, found))


def _constant_load(course: Course, flywheel: Array) -> tuple[Pieces, Array, Flags]:
    """Return r = (E + C)/(½ J(φ) ω_n²) under a load that does not depend on the speed, and which machines stand still.

    Pieces on which r, or ω_n/ω, is no polynomial are halved: the latter bends where a slow machine lingers.
    """
    omega: Any = course.effort.omega
    pieces = course.pieces
    most = np.bincount(pieces.machine) + _MORE_PIECES
    while True:
        moving, excess = course.on(pieces, 1, 2)
        energy = (moving + pieces.of(flywheel)) * pieces.of(omega * omega / 2)
        constant, stands = _constant(pieces, energy, excess)
        if course.effort.count is None and stands[0]:
            _, at, _, _ = pieces.extremes((-excess + (_SLOWEST**2 - 1) * energy)[None])
            raise Standstill(float(at[0, 0]))
        ratio = np.where(pieces.of(stands), 0.0, (excess + pieces.of(constant)) / energy)
        beyond = ~(pieces.largest(ratio) < _FASTEST)
        if course.effort.count is None and beyond[0]:
            raise UsageError(_BEYOND)
        stands, ratio = stands | beyond, np.where(pieces.of(beyond), 0.0, ratio)
        both = np.stack((ratio, 1 + _slowness(ratio)))
        size = np.maximum.reduceat(np.abs(both).max(axis=1), pieces.first, axis=1)
        tails = np.abs(pieces.rule.series[-2:] @ both).max(axis=1)
        rough = (tails > TAIL * size[:, pieces.machine]).any(axis=0) & (pieces.half > _NARROWEST / 2)
        rough &= pieces.of(np.bincount(pieces.machine) < most)
        if not rough.any():
            return pieces, ratio, stands
        parts = [pieces.taken(~rough), pieces.halved(rough)]
        pieces = joined(parts, [part.low for part in parts])[0]


def _constant(pieces: Pieces, energy: Array, excess: Array) -> tuple[Array, Flags]:
    """Return C in J by which the mean of ω_n/ω = 1/√(1 + r) is 1, and which machines cannot have it so slow.

    That mean falls with C and is convex: Newton's method from below.
    """
    least = np.maximum.reduceat((-excess + (_SLOWEST**2 - 1) * energy).max(axis=0), pieces.first)
    constant, stands = least, np.zeros(pieces.count, dtype=bool)
    swing = np.maximum.reduceat(excess.max(axis=0), pieces.first) - np.minimum.reduceat(
        excess.min(axis=0), pieces.first
    )
    for _ in range(100):
        ratio = np.maximum((excess + pieces.of(constant)) / energy, _SLOWEST**2 - 1)
        lag = pieces.mean(_slowness(ratio))
        slope = pieces.mean(-0.5 / ((1 + ratio) * np.sqrt(1 + ratio) * energy))
        step = -lag / slope
        stands |= (step < 0) & (constant == least)
        constant = np.where(stands, constant, constant + step)
        if (stands | (np.abs(step) <= 1e-15 * swing)).all():
            break
    return constant, stands
