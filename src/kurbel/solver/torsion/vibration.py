"""What `kurbel torsion` answers: natural vibrations of the shaft line, critical speeds, and forced vibration."""

import math
from collections.abc import Sequence
from functools import cached_property
from typing import NamedTuple

import numpy as np

from kurbel.arrays import Array
from kurbel.crank_angle import unit_vector
from kurbel.errors import UsageError
from kurbel.machine import Machine
from kurbel.machine.shaft_line import ShaftLine, ShaftMass, ShaftPiece
from kurbel.numerics.collocation_old import Unsettled
from kurbel.solver.cylinder.forces import CylinderForces
from kurbel.solver.figures import Columns, Results
from kurbel.solver.shaft_line.chain import Chain
from kurbel.solver.shaft_line.modes import Holzer, Modes
from kurbel.solver.torsion.forced import Excitation, Vibration, excitation, stress
from kurbel.solver.torsion.steady import SteadyMotion
from kurbel.solver.turning.effort import CylinderEffort, reduced_inertia
from kurbel.solver.turning.harmonics import HIGHEST, MachineOrders, every_order
from kurbel.solver.turning.machine_effort import MachineEffort, MovingInertia

NEAR = 0.1
"""A critical speed so near the working speed, relatively, is worth a note."""
_PRESENT = 1e-6
"""An order whose phase-vector sum is smaller, over the sum of its vectors, meets no resistance and no work."""
_FAINT = 0.01
"""An order that excites a mode no more than this, over the order that does so most, is no danger to it."""
RUN_UP = 1.2
"""Over the working speed, up to which a machine meets its critical speeds at all."""


def shaft_line_of(machine: Machine) -> ShaftLine:
    """Return the shaft line of a machine: the given one, or the two masses of its coupling. Raises UsageError."""
    if machine.shaft:
        return machine.shaft
    coupling, wheel = machine.coupling, machine.flywheel
    if coupling is None:
        what = "write its masses and the pieces between them below it, or give a 'coupling' behind a 'flywheel'"
        raise UsageError(f"{machine.name}: no 'shaft' is given; {what}")
    if wheel is None or wheel.inertia is None:
        raise UsageError(f"{machine.name}: the mass before the coupling is not known; give 'flywheel' an 'inertia'")
    names = tuple(cylinder.name for cylinder in machine.cylinders)
    cranks = ShaftMass("cranks and flywheel", cylinders=names, flywheel=1.0)
    piece = ShaftPiece(coupling.stiffness, coupling.damping)
    return ShaftLine((cranks, ShaftMass("driven", coupling.inertia)), (piece,), load=1)


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
        """Whether it lies beside the working speed, and its order excites it."""
        return self.distance is not None and abs(self.distance) <= NEAR and self.share > _FAINT


class ShaftVibration(Results):
    """The vibrations of the shaft line of a machine; orders (k,) are those that are told. Raises UsageError."""

    command = "torsion"

    def __init__(self, machine: Machine, cylinders: Sequence[CylinderForces], orders: Array | None = None) -> None:
        self.machine = machine
        self.line = shaft_line_of(machine)
        self._forces = {forces.drive.name: forces for forces in cylinders}
        self.cycle = 360.0 * machine.revolutions
        self._every = orders is None
        self.orders = every_order(self.cycle) if orders is None else orders
        self.chain = Chain.of(self.line, [self._inertia(mass) for mass in self.line.masses])
        self.modes = Modes(self.chain)

    def _inertia(self, mass: ShaftMass) -> float:
        """Return J in kg m²: what is given, the flywheel, and the mean of what the parts of the cylinders reduce to."""
        wheel = self.machine.flywheel.inertia if self.machine.flywheel else None
        moving = [self._forces[name] for name in mass.cylinders if self._forces[name].drive.cylinder.masses]
        reduced = (
            MovingInertia([CylinderEffort((one,), self.cycle, reduced_inertia)], self.cycle).mean for one in moving
        )
        inertia = math.fsum((mass.inertia, mass.flywheel * (wheel or 0.0), *reduced))
        if not inertia > 0:
            raise UsageError(f"{mass.name} has no inertia in the shaft line; give its item 'inertia', or it 'masses'")
        return inertia

    # natural vibrations

    @property
    def first(self) -> int:
        """Number of the first mode: 0 where the shaft turns freely."""
        return 1 if self.chain.ground else 0

    def holzer(self, mode: int) -> Holzer:
        """Return Holzer's table of a mode by its number. Raises UsageError where there is none."""
        last = self.first + len(self.modes.omegas) - 1
        if not 1 <= mode <= last:
            raise UsageError(f"--mode {mode}: the shaft line has the modes 1 to {last}")
        return self.modes.holzer(mode - self.first)

    @property
    def natural_frequency(self) -> float:
        """Lowest natural frequency in Hz but for the rotation of the whole."""
        return float(self.modes.omegas[1 - self.first]) / (2 * math.pi)

    @cached_property
    def holzer_residual(self) -> float:
        """Largest torque left behind the last mass, over the largest of its table, of all modes."""
        return max(self.modes.holzer(index).residual for index in range(len(self.modes.omegas)))

    # critical speeds

    def critical_speeds(self, modes: int, highest: float = math.inf) -> tuple[Critical, ...]:
        """Return the critical speeds of all orders up to the highest with the first modes."""
        found = []
        last = min(modes, self.first + len(self.modes.omegas) - 1)
        for mode in range(1, last + 1):
            omega = float(self.modes.omegas[mode - self.first])
            angles = self.holzer(mode).angles
            sums = self._phase_sums(angles)
            shares = self._shares(angles, sums)
            told = self.orders[self.orders <= highest]
            for order, total, share in zip(told.tolist(), sums.tolist(), shares.tolist()):
                speed = omega / (2 * math.pi * order)
                distance = speed / self.machine.speed - 1 if self.machine.speed else None
                found.append(Critical(order, mode, speed, total, distance, share))
        return tuple(found)

    def _phase_sums(self, angles: Array) -> Array:
        """Return |Σ Θ e^{−iνβ}| over the cranks (k,); of an effort without cranks, the amplitude where it acts."""
        at = {name: float(angles[i]) for i, mass in enumerate(self.line.masses) for name in mass.cylinders}
        cranks = [(at[one.name], one.crank_position) for one in self.machine.cylinders]
        amplitudes, positions = np.array(cranks or [(float(angles[0]), 0.0)]).T
        sums = np.abs(unit_vector(np.outer(self.orders, positions)) @ amplitudes)
        return np.where(sums > _PRESENT * np.abs(amplitudes).sum(), sums, 0.0)

    def _shares(self, angles: Array, sums: Array) -> Array:
        """Return how strongly the orders excite a mode, over the one that does so most (k,).

        That is |Σ M_ν Θ| of the torques at the working speed; of torques that are not known |Σ Θ e^{−iνβ}|.
        """
        works = sums
        if not self._unexcited:
            torques = self.acting.torques(np.array([self.acting.omega]))
            works = np.abs(np.tensordot(angles, torques, 1)[0])
        return np.asarray(works / (works.max() or 1.0))

    # forced vibration

    @property
    def _unexcited(self) -> str:
        """Why no torques are known, or an empty text."""
        if not self.machine.speed:
            return "no speed given" if self.machine.speed is None else "not defined at rest"
        if not self.machine.effort and not any(forces.drive.has_force for forces in self._forces.values()):
            return "no torque acts: no effort and no cylinder with a force is given"
        return ""

    @property
    def obstacle(self) -> str:
        """Why no forced vibration can be told, or an empty text."""
        if self._unexcited:
            return self._unexcited
        return "" if self.chain.damped else "no damping given; at resonance nothing but damping bounds a vibration"

    @cached_property
    def _turned(self) -> MachineEffort:
        return MachineEffort(self.machine, tuple(self._forces.values()))

    @cached_property
    def acting(self) -> Excitation:
        """The torques on the masses."""
        return excitation(MachineOrders(self._turned, self.orders), self.line)

    def forced(self, speeds: Sequence[float]) -> Vibration:
        """Return the forced vibration at speeds in revolutions per second."""
        return Vibration(self.chain, self.line, self.acting, 2 * np.pi * np.array(speeds))

    @cached_property
    def vibration(self) -> Vibration | None:
        """The forced vibration at the working speed; None where none can be told."""
        return None if self.obstacle or self.machine.speed is None else self.forced([self.machine.speed])

    @cached_property
    def steady(self) -> SteadyMotion | None:
        """The motion at the working speed with all orders, where none are asked for; None where only orders tell it."""
        if self.vibration is None or not self._every or self.chain.loss.any():
            return None
        try:
            return SteadyMotion(self.chain, self.line, self._turned, self.vibration.means)
        except Unsettled:
            return None

    @cached_property
    def together(self) -> SteadyMotion | Vibration | None:
        """The motion at the working speed of all orders; where only orders tell it, of four times the usual ones."""
        if self.steady or self.vibration is None or not self._every:
            return self.steady or self.vibration
        orders = every_order(self.cycle, 4 * HIGHEST)
        acting = excitation(MachineOrders(self._turned, orders), self.line)
        return Vibration(self.chain, self.line, acting, self.vibration.omegas)

    @property
    def summed(self) -> Array | None:
        """The orders that are in it, (n,); None where all are."""
        return self.together.acting.orders if isinstance(self.together, Vibration) else None

    @property
    def remainder(self) -> float | None:
        """About what orders beyond those summed add to any piece in N m; None where they are in it, or not wanted."""
        found = self.together
        return float(found.remainder[0]) if self._every and isinstance(found, Vibration) else None

    @property
    def vibration_loss(self) -> float | None:
        """Mean power in W that the damping takes."""
        return None if self.vibration is None else float(self.vibration.loss[0])

    @property
    def M_vibratory(self) -> float | None:
        """Largest vibratory torque in N m of any piece at the working speed."""
        return max((piece.M_vibratory for piece in self.pieces), default=None)

    @property
    def tau_vibratory(self) -> float | None:
        """Largest vibratory stress in Pa of any piece at the working speed."""
        return max((piece.tau_vibratory for piece in self.pieces if piece.tau_vibratory is not None), default=None)

    def met(self, critical: Critical) -> bool:
        """Whether the machine meets a critical speed on its way to the working speed, or a little beyond."""
        return not self.obstacle and bool(self.machine.speed) and critical.speed <= RUN_UP * (self.machine.speed or 0.0)

    @cached_property
    def pieces(self) -> "tuple[PieceTorque, ...]":
        """The torque in every piece at the working speed; none where no forced vibration can be told."""
        if self.together is None:
            return ()
        return tuple(
            PieceTorque(self.together, stress(self.line, piece), piece, self.piece_name(piece))
            for piece in range(len(self.line.pieces))
        )

    def piece_name(self, piece: int) -> str:
        """Return what a piece lies between."""
        names = [mass.name for mass in self.line.masses]
        ends = [*(["ground"] if self.chain.ground == "before" else []), *names, "ground"]
        return f"{ends[piece]} – {ends[piece + 1]}"


class PieceTorque:
    """The torque in one piece of the shaft line at the working speed, and the stress where its section is known.

    factor: the stress in Pa per N m.
    """

    def __init__(self, vibration: Vibration | SteadyMotion, factor: float | None, piece: int, name: str) -> None:
        self._vibration, self._stress, self._piece, self.name = vibration, factor, piece, name

    def _stressed(self, torque: float) -> float | None:
        return None if self._stress is None else self._stress * torque

    @property
    def M_shaft_mean(self) -> float:
        """Mean torque in N m."""
        return float(self._vibration.means[self._piece])

    @property
    def M_shaft_max(self) -> float:
        """Largest torque in N m."""
        return self.M_shaft_mean + float(self._vibration.crests[0][self._piece, 0])

    @property
    def M_shaft_min(self) -> float:
        """Smallest torque in N m."""
        return self.M_shaft_mean + float(self._vibration.crests[1][self._piece, 0])

    @property
    def M_vibratory(self) -> float:
        """Half of what the torque swings, in N m."""
        return (self.M_shaft_max - self.M_shaft_min) / 2

    @property
    def tau_mean(self) -> float | None:
        """Stress of the mean torque in Pa."""
        return self._stressed(self.M_shaft_mean)

    @property
    def tau_vibratory(self) -> float | None:
        """Half of what the stress swings, in Pa."""
        return self._stressed(self.M_vibratory)

    def at(self, degrees: Array) -> Columns:
        """Return torque and stress at crank angles (n,) in degrees."""
        torque, factor = self._vibration.over(self._piece, degrees), self._stress
        return Columns(degrees, {"M_shaft": lambda: torque, "tau": lambda: None if factor is None else torque * factor})
