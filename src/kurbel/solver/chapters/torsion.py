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

from kurbel.arrays import Array, ComplexArray, Flags
from kurbel.crank_angle import unit_vector
from kurbel.errors import UsageError
from kurbel.machine import Machine
from kurbel.machine.cylinder import crank_lag
from kurbel.machine.shaft_line import GROUNDED, ShaftLine, ShaftMass, ShaftSegment
from kurbel.numerics.arithmetic import unless_cancelled
from kurbel.numerics.collocation import periodic
from kurbel.numerics.pieces import NOWHERE, Pieces, refined
from kurbel.quantity import value
from kurbel.solver.chapters.chain import (
    Chain,
    ChainEquation,
    Holzer,
    Modes,
    ShaftTree,
    loss,
    passing,
    response,
)
from kurbel.solver.chapters.harmonics import HIGHEST, amplitudes, every_order
from kurbel.solver.drive import Drive
from kurbel.solver.effort import Term, TurningEffort
from kurbel.solver.figures import AtAngles, Results
from kurbel.solver.speed import SpeedLaw
from kurbel.solver.state import State, reduced_inertia

NEAR = 0.1
"""A critical speed so near the working speed, relatively, is worth a note."""
RUN_UP = 1.2
"""Over the working speed, up to which a machine meets its critical speeds at all."""
_PRESENT = 1e-6
"""An order whose sum of phase vectors is smaller, over the sum of their lengths, does no work."""
_FAINT = 0.01
"""An order that excites a mode no more than this, over the order that does so most, is no danger to it."""
_ROUNDING = 1e-14
"""Of the largest torque on a mass: an order that is smaller is zero."""
_MOST_WORK, _FEWEST = 3.75e4, 40
"""Pieces, at least the second number, times the cube of the unknowns: beyond that its modes are solved one by one."""
_MOST_NUMBERS = 3e5
"""Pieces times unknowns: what such a solution of some seconds takes."""
_LONG = 50
"""Masses of a line of which fewer orders are summed."""
_WAVE = 240.0
"""Degrees of the shortest wave that are a polynomial of 16 nodes to 1e-13."""
_ENDLESS = 1e9
"""Torques over those that drive, above which a resonance counts as undamped, since only rounding limits it."""


def shaft_line_of(machine: Machine) -> ShaftLine:
    """Return the shaft line of a machine: the given one, or the two masses of its coupling. Raises UsageError."""
    if machine.shaft:
        return machine.shaft
    coupling, wheel = machine.coupling, machine.flywheel
    if coupling is None:
        what = "write its masses and the segments between them below it, or give a 'coupling' behind a 'flywheel'"
        raise UsageError(f"{machine.name}: no 'shaft' is given; {what}")
    if wheel is None or wheel.inertia is None:
        raise UsageError(
            f"{machine.name}: the mass before the coupling is not known; give 'flywheel' an 'inertia'"
        )
    names = tuple(cylinder.name for cylinder in machine.cylinders)
    cranks = ShaftMass("cranks and flywheel", cylinders=names, flywheel=1.0)
    driven = ShaftMass("driven", coupling.inertia)
    return ShaftLine(
        (cranks, driven), (ShaftSegment(coupling.stiffness, coupling.damping),), load=1
    )


def stress(line: ShaftLine, segment: int) -> float | None:
    """Return the stress in Pa that a torque of 1 N m makes in a segment, where it is thinnest; None if not known."""
    moduli = [section.modulus for section in line.segments[segment].sections]
    return 1 / min(moduli) if moduli and math.isfinite(min(moduli)) else None


# what acts on the masses


class Excitation(NamedTuple):
    """The torques on n masses in N m, by orders (k,), over their common period of `cycle` degrees.

    gas, inertia: amplitudes (n, k) of what is independent of the speed, and of the inertia forces at ω_n = omega in
    rad/s; means (n,), with the load on the mass that takes it; load_slope: dL/dω of each mass at ω_n in N m s/rad (n,).
    """

    omega: float
    cycle: float
    orders: Array
    gas: ComplexArray
    inertia: ComplexArray
    means: Array
    load_slope: Array


def torques_on(effort: TurningEffort, line: ShaftLine) -> tuple[Array, Array]:
    """Return the torques on the masses in N m, and what the inertia forces have in them, (masses, nodes, pieces).

    On the pieces of the effort. Efforts have the losses of the machine, inertia forces none; an effort that is known
    from elsewhere acts on the first mass. Where a load varies over the turn, it is in them but for its mean.
    """
    torques, of_inertia = np.zeros((2, len(line.masses), *effort.pieces.degrees.shape))
    terms = [*effort.terms, *effort.missing_inertia]
    moving = [term._replace(factor=1.0) for term in effort.inertia_terms]
    for number, mass in enumerate(line.masses):
        torques[number] = effort.sampled(_terms_of(mass, terms))
        of_inertia[number] = effort.sampled(_terms_of(mass, moving))
    if effort.given is not None:
        torques[0] = effort.M
    if effort.diagram:
        torques[line.load] -= effort.load - effort.mean
    return torques, of_inertia


def _terms_of(mass: ShaftMass, terms: Sequence[Term]) -> list[Term]:
    """Return the terms of the torque with the cylinders alone whose cranks are at a mass."""
    of_mass = list[Term]()
    for term in terms:
        cylinders = [
            cylinder for cylinder in term.cylinders if cylinder.drive.name in mass.cylinders
        ]
        if cylinders:
            of_mass.append(term._replace(cylinders=cylinders))
    return of_mass


def excitation(effort: TurningEffort, line: ShaftLine, orders: Array) -> Excitation:
    """Return what acts on the masses of a shaft line, order by order; the load takes the mean of all torques."""
    torques, of_inertia = torques_on(effort, line)
    count = len(torques)
    both = np.concatenate((torques - of_inertia, of_inertia))
    acting = both.any(axis=(1, 2))
    by_order = np.zeros((2 * count, len(orders)), complex)
    by_order[acting] = amplitudes(effort.pieces, both[acting], orders)[..., 0]
    by_order = unless_cancelled(by_order, np.abs(both).max(axis=(1, 2))[:, None], _ROUNDING)

    means = effort.mean_of(torques)[:, 0]
    if not line.is_held:
        means[line.load] -= means.sum()
    omega, law = effort.omega or 0.0, SpeedLaw.of(effort)
    slopes = np.zeros(count)
    if law:
        slopes[line.load] = law.steepness[0] / omega
    return Excitation(
        omega, effort.cycle, orders, by_order[:count], by_order[count:], means, slopes
    )


# forced vibration


class Vibration:
    """The forced vibration of a chain at angular velocities (s,) in rad/s, order by order.

    driving, angles: amplitudes (n, s, k) in N m and in rad of the cranks' shaft. sections: the places along the shaft
    whose torques are computed, each a segment and a share of its length: the two ends and the middle of a segment that
    has inertia, else one. torques (sections, s, k) in N m, true ones on both sides of a gear. endless (s,): where an
    order meets a mode that next to nothing damps, so that rounding bounds the torques.
    """

    def __init__(self, chain: Chain, line: ShaftLine, acting: Excitation, omegas: Array) -> None:
        self.chain, self.line, self.acting, self.omegas = chain, line, acting, omegas
        self.driving = (
            acting.gas[:, None] + acting.inertia[:, None] * ((omegas / acting.omega) ** 2)[:, None]
        )
        self._frequencies = np.multiply.outer(omegas, acting.orders)
        # the load takes the same mean torque at every speed, so that its slope goes with 1/ω; (n, s, 1)
        self._load_damping = np.multiply.outer(acting.load_slope, acting.omega / omegas)[..., None]
        self.angles = response(chain, self._frequencies, self.driving, self._load_damping)
        self.ratios = np.array([segment.ratio for segment in line.segments])
        self.sections = _sections(line)
        passed = passing(chain, self._frequencies, self.angles, self.sections)
        self._segments = np.array([segment for segment, _ in self.sections])
        self.torques = passed / self.ratios[self._segments][:, None, None]
        largest, driving = (np.abs(torques).max(axis=(0, 2)) for torques in (passed, self.driving))
        self.endless: Flags = np.isfinite(driving) & ~(largest <= _ENDLESS * driving)

    @cached_property
    def means(self) -> Array:
        """Mean torques in the segments in N m."""
        return mean_torques(self.chain, self.acting.means) / self.ratios

    def _turns(self, count: int) -> Pieces:
        """Return the turns of so many machines in equal pieces, on each of which the waves are polynomials."""
        pieces = Pieces.between(NOWHERE, count, self.acting.cycle)
        parts = math.ceil(2 * pieces.half.max() * self.acting.orders.max() / _WAVE)
        return pieces.parted(np.full(len(pieces.half), parts))

    @cached_property
    def swings(self) -> tuple[Pieces, Array]:
        """The torques less their mean in N m over the turn, (sections, s, nodes, pieces)."""
        orders, pieces = self.acting.orders, self._turns(1)
        # at a node the waves are those at the beginning of its piece times those of a piece from there on
        inside = unit_vector(np.multiply.outer(pieces.half[0] * (1 + pieces.rule.nodes), orders))
        begin = unit_vector(np.multiply.outer(orders, pieces.low))
        return pieces, ((self.torques[:, :, None] * inside) @ begin).real

    @cached_property
    def _amplitudes(self) -> Array:
        """Half peak-to-peak torques in N m, (sections, s)."""
        torques, turns = self.swings[1], self._turns(self.swings[1].shape[1])
        amplitudes = np.empty(torques.shape[:2])
        for section, swing in enumerate(torques):
            # each speed is searched as a machine of its own; (s, nodes, pieces) -> (1, nodes, s · pieces)
            row = np.swapaxes(swing, 0, 1).reshape(1, swing.shape[1], -1)
            ends = turns.extremes(row)
            amplitudes[section] = (ends.largest[0] - ends.smallest[0]) / 2
        return np.where(np.isfinite(self.torques).all(axis=2), amplitudes, math.nan)

    @property
    def vibratory(self) -> Array:
        """Half peak-to-peak torques in the segments in N m, where each is largest, (segments, s)."""
        largest = np.zeros((len(self.ratios), len(self.omegas)))
        np.maximum.at(largest, self._segments, self._amplitudes)
        return largest

    @property
    def decisive(self) -> list[int]:
        """Of each segment the section whose torque swings most at the first speed."""
        amplitudes = np.nan_to_num(self._amplitudes[:, 0])
        decisive = list[int]()
        for segment in range(len(self.ratios)):
            sections = np.flatnonzero(self._segments == segment)
            decisive.append(int(sections[amplitudes[sections].argmax()]))
        return decisive

    @property
    def loss(self) -> Array:
        """Mean power in W lost in dampers, in the material, and in a load that rises with the speed, (s,)."""
        speeds = np.abs(self._frequencies * self.angles) ** 2
        damping = self.chain.mass_damping[:, None, None] + self._load_damping
        of_masses = (damping * speeds).sum(axis=(0, 2)) / 2
        return of_masses + loss(self.chain, self._frequencies, self.angles).sum(axis=(0, 2))


def _sections(line: ShaftLine) -> list[tuple[int, float]]:
    """Return the sections of a line whose torques are computed: of each its segment and the share before it."""
    sections = list[tuple[int, float]]()
    for segment, of_shaft in enumerate(line.segments):
        shares = (0.0, 0.5, 1.0) if of_shaft.inertia else (0.0,)
        sections += [(segment, share) for share in shares]
    return sections


def mean_torques(chain: Chain, means: Array) -> Array:
    """Return the mean torques in N m that the segments carry, (segments,), of mean torques on the masses (n,)."""
    torques = np.zeros(len(chain.joins))
    fixed = chain.fixed_segments
    tree = ShaftTree(chain, fixed[-1] if fixed else None)
    # with one fixed end, or none, each segment carries what acts beyond it
    beyond = means.astype(float)
    for mass in tree.leaves_first:
        link = tree.links[mass]
        if link is None:
            continue
        torques[link.segment] = beyond[mass] if link.onward else -beyond[mass]
        if link.parent != GROUNDED:
            beyond[link.parent] += beyond[mass]
    if len(fixed) < 2:
        return torques

    # what flows from each other fixed end to that of the root is such that the twists on its way add up to nothing
    ways = np.zeros((len(fixed) - 1, len(torques)))
    for way, segment in zip(ways, fixed):
        way[segment] = 1.0 if chain.joins[segment][0] == GROUNDED else -1.0
        for _, link in tree.path_to_root(max(chain.joins[segment])):
            assert link is not None
            way[link.segment] = 1.0 if link.onward else -1.0
    stiffness = ways / chain.stiffnesses @ ways.T
    return torques - ways.T @ np.linalg.solve(stiffness, ways @ (torques / chain.stiffnesses))


def _mean_inertia(drive: Drive) -> float:
    """Return the mean over the turn of the reduced moment of inertia of a cylinder in kg m², whatever forces act."""
    pieces, inertia = refined(
        drive.pieces, lambda some: reduced_inertia(State.on(drive, some))[None]
    )
    return float(pieces.mean(inertia[0])[0])


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


# the results


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
        moving = [_mean_inertia(drive) for drive in drives if drive.cylinder.masses]
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
            raise UsageError(f"--mode {mode}: the shaft line has the modes 1 to {self.last}")
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
        power = pieces.carried(driven, effort.pieces) * equation.vibration(samples, pieces)
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
