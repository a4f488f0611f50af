"""Torsional vibration of the shaft line: natural vibrations, critical speeds, and forced vibration.

The chain of masses and its equations are those of `kurbel.solver.chapters.chain`. On each mass act the torques of its
cylinders, with what the efficiency leaves of the effort but all of the inertia, and on one of them the load:

    M(φ) = M_m + Σ Re(M_ν e^{iνφ})           orders of the torques, see `kurbel.solver.chapters.harmonics`
    n_k = ω_e/(2π ν)                         critical speed of order ν with the natural frequency ω_e
    |Σ Θ e^{−iνδ}|                           sum of the phase vectors of the cranks: how they excite the mode Θ together

A loss factor is known of single orders only. Where none is given, the motion at the working speed is computed over the
angle, with every jump and thus with all orders; else it is the sum of many orders.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import cached_property, partial
from typing import Any, NamedTuple

import numpy as np

from kurbel.arrays import Array
from kurbel.crank_angle import unit_vector
from kurbel.errors import UsageError
from kurbel.machine.cylinder import crank_lag
from kurbel.machine.shaft_line import GROUNDED, ShaftLine, ShaftMass
from kurbel.numerics.collocation import periodic
from kurbel.numerics.pieces import Pieces
from kurbel.quantity import value
from kurbel.solver.chapters.chain import Chain
from kurbel.solver.chapters.chain_equation import ChainEquation
from kurbel.solver.chapters.excitation import (
    Excitation,
    Vibration,
    excitation,
    mean_inertia,
    shaft_line_of,
    torques_on,
)
from kurbel.solver.chapters.harmonics import HIGHEST, every_order
from kurbel.solver.chapters.natural_modes import Holzer, Modes
from kurbel.solver.effort import TurningEffort
from kurbel.solver.figures import AtAngles, Results
from kurbel.solver.speed import SpeedLaw

NEAR = 0.1
"""A critical speed so near the working speed, relatively, is worth a note."""
RUN_UP = 1.2
"""Over the working speed, up to which a machine meets its critical speeds at all."""
_PRESENT = 1e-6
"""An order whose sum of phase vectors is smaller, over the sum of their lengths, does no work."""
_FAINT = 0.01
"""An order that excites a mode no more than this, over the order that does so most, is no danger to it."""


_MOST_WORK, _FEWEST = 3.75e4, 40
"""Pieces, at least the second number, times the cube of the unknowns: beyond that its modes are solved one by one."""
_MOST_NUMBERS = 3e5
"""Pieces times unknowns: what such a solution of some seconds takes."""
_LONG = 50
"""Masses of a line of which fewer orders are summed."""


def stress(line: ShaftLine, segment: int) -> float | None:
    """Return the stress in Pa that a torque of 1 N m makes in a segment, where it is thinnest; None if not known."""
    moduli = [section.modulus for section in line.segments[segment].sections]
    return 1 / min(moduli) if moduli and math.isfinite(min(moduli)) else None


class SegmentTorque(NamedTuple):
    """The torque in one segment of the shaft line at the working speed in N m.

    swing: samples of what swings about the mean, (nodes, pieces); factor: the stress in Pa per N m, None if not known.
    """

    name: str
    M_shaft_mean: float
    M_shaft_max: float
    M_shaft_min: float
    pieces: Pieces
    swing: Array
    factor: float | None

    @property
    def M_vibratory(self) -> float:
        """Half of what it swings."""
        return (self.M_shaft_max - self.M_shaft_min) / 2

    def stress_of(self, torque: Any) -> Any:
        """Return the stress in Pa of torques in N m, None if not known."""
        if self.factor is None:
            return None
        return self.factor * torque

    @property
    def tau_mean(self) -> float | None:
        """The stress of the mean torque in Pa."""
        return self.stress_of(self.M_shaft_mean)

    @property
    def tau_vibratory(self) -> float | None:
        """The stress of half of what the torque swings in Pa."""
        return self.stress_of(self.M_vibratory)

    def torque_at(self, degrees: Array) -> Array:
        """Return the torque in N m at crank angles (n,) in degrees."""
        return self.M_shaft_mean + self.pieces.at(
            self.swing, np.zeros(len(degrees), dtype=np.intp), degrees
        )

    def at(self, degrees: Array) -> SegmentState:
        """Return torque and stress at crank angles (n,) in degrees."""
        return SegmentState(self, degrees)


class SegmentState(AtAngles):
    """The columns of a segment at crank angles φ (n,) in degrees; of the whole shaft line there are none."""

    commands = ("torsion",)
    M_shaft = value(
        "M_w",
        "torque",
        "Torque in the shaft segment, mean and vibratory",
        lambda columns: columns.segment and columns.segment.torque_at(columns.phi),
    )
    tau = value(
        "τ",
        "stress",
        "Torsional stress at the smallest section of the segment",
        lambda columns: columns.segment and columns.segment.stress_of(columns.M_shaft),
    )

    def __init__(self, segment: SegmentTorque | None, phi: Array) -> None:
        self.segment, self.phi = segment, phi


class Critical(NamedTuple):
    """A critical speed in revolutions per second: order, mode, and the sum of the phase vectors of the cranks.

    distance: from the working speed, relatively; None without one. share: how strongly the order excites the mode, over
    the order that does so most.
    """

    order: float
    mode: int
    speed: float
    phase_sum: float
    distance: float | None
    share: float

    @property
    def near(self) -> bool:
        """Whether it is near the working speed, and its order excites it."""
        return self.distance is not None and abs(self.distance) <= NEAR and self.share > _FAINT


class SteadyMotion(NamedTuple):
    """The motion at the working speed with all orders: torques in the segments less their means, in N m.

    (segments, nodes, pieces); loss: mean power in W that the vibration dissipates.
    """

    pieces: Pieces
    torques: Array
    loss: float


class ShaftVibration(Results):
    """The vibrations of the shaft line of a machine; orders (k,): those of the tables. Raises UsageError.

    first, last: numbers of the first mode, 0 where the shaft turns freely, and of the last. obstacle: why no forced
    vibration can be computed, or an empty text.
    """

    command, state = "torsion", SegmentState

    natural_frequency = value(
        "f_1",
        "frequency",
        "Lowest natural frequency of torsional vibration",
        lambda vibration: (
            float(vibration.modes.omegas[1 - vibration.first]) / (2 * math.pi)
        ),  # no mode of rotation
    )
    holzer_residual = value(
        "ΣωJΘ",
        "ratio",
        "Residual torque of the Holzer table, relative to the largest torque",
        lambda vibration: max(
            table.residual for table in map(vibration.modes.holzer, vibration.mode_numbers)
        ),
        plain="sum w2 J Theta",
        residual=True,
    )
    vibration_loss = value(
        "N_d",
        "power",
        "Mean power dissipated by damping",
        lambda vibration: vibration.loss,
        after="tau_vibratory",
    )
    M_vibratory = value(
        "M_w,a",
        "torque",
        "Largest vibratory torque amplitude (half peak-to-peak) of any shaft segment",
        lambda vibration: max(
            (segment.M_vibratory for segment in vibration.segments), default=None
        ),
    )
    tau_vibratory = value(
        "τ_a",
        "stress",
        "Largest vibratory stress amplitude of any shaft segment",
        lambda vibration: vibration.largest_stress(),
    )

    def __init__(self, effort: TurningEffort, orders: Array | None = None) -> None:
        self.effort, self.machine, self.line = effort, effort.machine, shaft_line_of(effort.machine)
        self._every = orders is None
        self.orders = every_order(effort.cycle) if orders is None else orders
        self.chain = Chain.of(self.line, [self._inertia_of(mass) for mass in self.line.masses])
        self.modes = Modes(self.chain)
        self.first = 1 if self.chain.is_held else 0
        self.last = self.first + len(self.modes.omegas) - 1

        if self.machine.speed is None:
            self._unexcited = "no speed given"
        elif not self.machine.speed:
            self._unexcited = "not defined at rest"
        elif not effort.groups and (not self.machine.effort or effort.swing is not None):
            self._unexcited = "no torque acts: no effort and no cylinder with a force is given"
        else:
            self._unexcited = ""
        is_damped = (
            self.chain.segment_damping.any()
            or self.chain.mass_damping.any()
            or self.chain.loss.any()
        )
        undamped = (
            ""
            if is_damped
            else "no damping given; at resonance nothing but damping bounds a vibration"
        )
        self.obstacle = self._unexcited or undamped

    def _inertia_of(self, mass: ShaftMass) -> float:
        """Return the inertia of a mass in kg m² with the flywheel and the cylinders there; none of a joint."""
        wheel = self.machine.flywheel
        of_wheel = (wheel and wheel.inertia) or 0.0
        drives = [
            cylinder.drive
            for cylinder in self.effort.cylinders
            if cylinder.drive.name in mass.cylinders
        ]
        moving = [mean_inertia(drive) for drive in drives if drive.cylinder.masses]
        inertia = math.fsum((mass.inertia, mass.flywheel * of_wheel, *moving))
        if not (inertia > 0 or mass.is_joint):
            raise UsageError(
                f"{mass.name} has no inertia in the shaft line; give its item 'inertia', or it 'masses'"
            )
        return inertia

    def _columns(self, phi: Array, within: Array) -> SegmentState:
        return SegmentState(None, phi)

    def segment_name(self, segment: int) -> str:
        """Return what a segment is between."""
        ends = [
            "ground" if mass == GROUNDED else self.line.masses[mass].name
            for mass in (self.line.segments[segment].before, self.line.segments[segment].behind)
        ]
        return " – ".join(ends)

    @property
    def mode_numbers(self) -> range:
        """The modes, counted from 0 even of a line that is held."""
        return range(len(self.modes.omegas))

    def holzer(self, mode: int) -> Holzer:
        """Return Holzer's table of a mode by its number. Raises UsageError where there is none."""
        if not 1 <= mode <= self.last:
            raise UsageError(f"mode {mode}: the shaft line has the modes 1 to {self.last}")
        return self.modes.holzer(mode - self.first)

    # critical speeds

    def critical_speeds(self, modes: int, highest: float = math.inf) -> tuple[Critical, ...]:
        """Return the critical speeds of all orders up to the highest with the first modes.

        The phase sum is |Σ Θ e^{−iνβ}| over the cranks; of an effort without cranks the amplitude where it acts. The
        share is that of |Σ M_ν Θ|, of the torques at the working speed; of torques that are not known of the phase sum.
        """
        critical, working = list[Critical](), self.machine.speed
        for mode in range(1, min(modes, self.last) + 1):
            angles, omega = self.holzer(mode).angles, float(self.modes.omegas[mode - self.first])
            at_cranks = dict[str, float]()
            for mass, angle in zip(self.line.masses, angles.tolist()):
                at_cranks |= dict.fromkeys(mass.cylinders, angle)
            cranks = [
                (at_cranks[cylinder.name], crank_lag(cylinder, self.machine.cylinders[0]))
                for cylinder in self.machine.cylinders
            ]
            amplitudes, positions = np.array(cranks or [(float(angles[0]), 0.0)]).T
            sums = np.abs(unit_vector(np.outer(self.orders, positions)) @ amplitudes)
            sums = np.where(sums > _PRESENT * np.abs(amplitudes).sum(), sums, 0.0)
            works = (
                sums
                if self._unexcited
                else np.abs(angles @ (self.acting.gas + self.acting.inertia))
            )
            shares = works / (works.max() or 1.0)

            for order, total, share in zip(self.orders.tolist(), sums.tolist(), shares.tolist()):
                speed = omega / (2 * math.pi * order)
                distance = speed / working - 1 if working else None
                if order <= highest:
                    critical.append(Critical(order, mode, speed, total, distance, share))
        return tuple(critical)

    def met(self, critical: Critical) -> bool:
        """Whether the machine meets a critical speed on its way to the working speed, or a little beyond."""
        return not self.obstacle and critical.speed <= RUN_UP * (self.machine.speed or 0.0)

    # forced vibration

    @cached_property
    def acting(self) -> Excitation:
        """The torques on the masses."""
        return excitation(self.effort, self.line, self.orders)

    def forced(self, speeds: Sequence[float]) -> Vibration:
        """Return the forced vibration at speeds in revolutions per second."""
        return Vibration(self.chain, self.line, self.acting, 2 * np.pi * np.array(speeds))

    @cached_property
    def vibration(self) -> Vibration | None:
        """The forced vibration at the working speed; None where none can be computed."""
        if self.obstacle or self.machine.speed is None:
            return None
        return self.forced([self.machine.speed])

    @cached_property
    def steady(self) -> SteadyMotion | None:
        """The motion at the working speed with all orders.

        None where certain orders are requested, where a loss factor or a segment with inertia is given, and where no
        motion is found, or none that is worth its time.
        """
        chain, effort = self.chain, self.effort
        has_other_segments = chain.loss.any() or chain.segment_inertias.any()
        if self.vibration is None or not self._every or has_other_segments:
            return None
        driven, _ = torques_on(effort, self.line)
        driven -= effort.pieces.mean(driven)[:, None]
        order = self.modes.omegas[-1] / effort.omega
        loaded = self.line.load % len(self.line.masses)
        motion_of = partial(
            ChainEquation,
            *(chain, order, effort.omega, effort.pieces, driven, SpeedLaw.of(effort), loaded),
        )
        equation = motion_of()
        count, unknowns = len(equation.pieces.half), equation.unknowns
        if count * unknowns > _MOST_NUMBERS:
            return None
        # the springs of a chain between several fixed ends are more unknowns than equations
        is_open = len(chain.fixed_segments) > 1
        if is_open or max(count, _FEWEST) * unknowns**3 > _MOST_WORK:
            try:
                equation = motion_of(by_modes=True)
            except np.linalg.LinAlgError:
                return None
        motion = periodic(equation, equation.pieces)
        if motion.failed[0]:
            return None
        pieces, samples = motion.pieces, motion.samples
        # what the torques put in is what the dampers and the load take out
        power = pieces.resampled(driven, effort.pieces) * equation.vibration(samples, pieces)
        return SteadyMotion(
            pieces,
            equation.torques(samples, pieces) / self.vibration.ratios[:, None, None],
            float(pieces.mean(power).sum()),
        )

    @property
    def loss(self) -> float | None:
        """The mean power in W dissipated at the working speed by all orders, or by those requested."""
        if self.steady:
            return self.steady.loss
        if not self._summed:
            return None
        return float(self._summed.loss[0])

    @cached_property
    def _summed(self) -> Vibration | None:
        """The orders that are summed at the working speed, many times the usual ones; None where `steady` has all."""
        if self.steady or self.vibration is None:
            return None
        if not self._every:
            return self.vibration
        times = 16 if len(self.line.masses) <= _LONG else 4
        orders = every_order(self.effort.cycle, times * HIGHEST)
        acting = excitation(self.effort, self.line, orders)
        return Vibration(self.chain, self.line, acting, self.vibration.omegas)

    @property
    def summed(self) -> Array | None:
        """The orders that are summed at the working speed, (n,); None where all are in it."""
        if not self._summed:
            return None
        return self._summed.acting.orders

    @property
    def remainder(self) -> float | None:
        """About what orders beyond those summed add to any torque in N m; None without a remainder.

        What falls off as 1/ν², as behind a jump through a damper, or faster, is in all of them together no more than in
        the upper half of these.
        """
        if not self._every or not self._summed:
            return None
        orders = self._summed.acting.orders
        return float(np.abs(self._summed.torques[:, 0, orders > orders[-1] / 2]).sum(axis=1).max())

    @cached_property
    def segments(self) -> tuple[SegmentTorque, ...]:
        """The torque in every segment at the working speed; none where no forced vibration can be computed."""
        if self.vibration is None:
            return ()
        if self._summed:
            pieces, swings = self._summed.swings
            torques = swings[self._summed.decisive, 0]
        else:
            assert self.steady
            pieces, torques = self.steady.pieces, self.steady.torques
        ends, are_finite = pieces.extremes(torques), np.isfinite(torques).all(axis=(1, 2))
        highest = np.where(are_finite, ends.largest[:, 0], math.nan).tolist()
        lowest = np.where(are_finite, ends.smallest[:, 0], math.nan).tolist()
        segments = list[SegmentTorque]()
        for segment, mean in enumerate(self.vibration.means.tolist()):
            segments.append(
                SegmentTorque(
                    name=self.segment_name(segment),
                    M_shaft_mean=mean,
                    M_shaft_max=mean + highest[segment],
                    M_shaft_min=mean + lowest[segment],
                    pieces=pieces,
                    swing=torques[segment],
                    factor=stress(self.line, segment),
                )
            )
        return tuple(segments)

    def largest_stress(self) -> float | None:
        """Return the largest vibratory stress of any segment in Pa, None if no section is known."""
        stresses = [segment.tau_vibratory for segment in self.segments]
        return max((stress for stress in stresses if stress is not None), default=None)
