"""Strength of a crankshaft with one throw, between two bearings or overhung: stresses over the whole cycle (G).

Stresses are looked at in these places, part by part:

    pin        middle          bent by A on the lever a, twisted by A_T r (G)
               at web A, B     bent by A, and by A and the force on the pin; twisted by A_T r as all of the pin
    web        wide face       compressed and bent in the plane of the throw, twisted: decisive for the shape (G)
               narrow face     compressed and bent out of that plane, twisted less
               corner          compressed and bent both ways, not twisted
    journal A  at web          bent by A on the lever up to web A
    journal B  at web          bent by A and the pin, twisted by T r; the shaft as far as B counts as journal
               at flywheel     the same, where the flywheel is before B
               in bearing      bent by the flywheel overhung beyond B, twisted by T r

Along the pin and along each journal the moments are straight lines from load to load, under the same torsion: their
vector sum is largest at a load or at an end, so that no section between these places is strained more. The force on the
pin acts in its middle, the forces of the bearings in theirs.

An overhung crank has a pin clamped at its only end, in web A, which is loaded as a web B with nothing before the pin;
journal A is bent by F and twisted by T r, at the web and in its bearing, and the shaft beyond counts as journal B.

A web is bent out of the plane of the throw most at one end of its arm, at the axis of the pin or at that of the shaft.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from kurbel.arrays import Array
from kurbel.crank_angle import CrankAngle
from kurbel.declared.units import GRAVITY
from kurbel.errors import UsageError
from kurbel.machine import Machine
from kurbel.machine.batch import taken
from kurbel.machine.crankshaft import Crankshaft
from kurbel.numerics.arithmetic import every, some, where
from kurbel.numerics.extreme import Extreme, Extremes, chosen, largest
from kurbel.numerics.pieces import Pieces, highest, resolved
from kurbel.quantity import column, for_each, key_value
from kurbel.solver.figures import AtAngles, Results
from kurbel.solver.forces import CylinderForces
from kurbel.solver.shaft import FreeBody, Vector, WebLoads, equilibrium_residual, flywheel_weight
from kurbel.solver.state import State, on_pin

PARTS = {
    "pin": ("pin", "the crank pin"),
    "web_A": ("w,A", "web A"),
    "web_B": ("w,B", "web B"),
    "journal_A": ("j,A", "journal A"),
    "journal_B": ("j,B", "journal B"),
}
"""Parts of a crankshaft: the index of their symbols, and what they are called in a sentence."""
_BEARINGS = {part: PARTS[part] for part in ("pin", "journal_A", "journal_B")}
"""Parts that are pressed: by the rod, and by bearings A and B."""

# Stresses in a section: numbers or arrays in N, N m and m give Pa. They divide by one length at a time: the product of
# three tiny ones would be zero.


def round_bending(moment: Any, diameter: Any) -> Any:
    """Return σ = 32 M/(π d³) in Pa at the surface of a round section; moment in N m, diameter in m (G, M_b/Z)."""
    return 32 / math.pi * moment / diameter / diameter / diameter


def round_torsion(moment: Any, diameter: Any) -> Any:
    """Return τ = 16 M/(π d³) in Pa at the surface of a round section; moment in N m, diameter in m (G, M_d/Z_p)."""
    return 16 / math.pi * moment / diameter / diameter / diameter


def bach_factor(allowable_bending: Any, allowable_torsion: Any) -> Any:
    """Return α₀ = k_b/(1.3 k_d), or 1 where one of the allowable stresses in Pa is not known (G).

    With it a part under torsion alone is fully used just where τ reaches k_d.
    """
    if allowable_bending is None or allowable_torsion is None:
        return 1.0
    return allowable_bending / (1.3 * allowable_torsion)


class Place(NamedTuple):
    """The stresses in Pa at one place of a part; None for what there cannot be there.

    compression is positive, and negative where the web is pulled; bendings and torsion are magnitudes. normal: all
    normal stress together, a magnitude. alpha: α₀ of Bach's combination. degrees: crank angle of the forces, if one.
    """

    part: str
    name: str
    alpha: Any
    compression: Any
    bending_in_plane: Any
    bending_out_of_plane: Any
    torsion: Any
    normal: Any
    degrees: Any = None

    @property
    def combined(self) -> Any:
        """Combined stress 0.35 σ + 0.65 √(σ² + 4 (α₀ τ)²) in Pa after Bach (G, "Resultierende Beanspruchung")."""
        torsion = 0.0 if self.torsion is None else self.torsion
        return 0.35 * abs(self.normal) + 0.65 * np.hypot(self.normal, 2 * self.alpha * torsion)

    @property
    def von_mises(self) -> Any:
        """Equivalent stress √(σ² + 3 τ²) in Pa after von Mises."""
        return np.hypot(self.normal, 0.0 if self.torsion is None else math.sqrt(3) * self.torsion)

    def one_of(self, number: Any, degrees: Any) -> Place:
        """Return the place at a crank angle in one of several states."""
        own: dict[str, Any] = {name: float(each[number]) for name, each in self._asdict().items() if np.ndim(each)}
        return self._replace(**own, degrees=degrees)


def places(body: FreeBody) -> Iterator[Place]:
    """Yield the places of a crankshaft under its forces; those of the journals only where their diameter is given.

    α₀ is 1 for what is round (G, for the pin), and that of the allowable stresses for the webs.
    """
    shaft, diameter = body.shaft, body.shaft.journal_diameter
    inner, outer = (shaft.web_distance + side * shaft.web_thickness / 2 for side in (-1, 1))  # faces of a web
    # in the middle of the pin M_b = a √(A_T² + A_D²) and M_d = A_T r (G)
    sections = {"at web A": inner} if shaft.overhung else {"middle": 0.0, "at web A": -inner, "at web B": inner}
    for name, u in sections.items():
        yield _round("pin", name, body.moments_at(u), body.before_pin.T * body.crank, shaft.pin_diameter)
    if shaft.overhung:
        yield from _web("web_A", shaft, body.web_beyond_pin)
    else:
        yield from _web("web_A", shaft, body.web_before_pin)
        yield from _web("web_B", shaft, body.web_beyond_pin)
    if diameter is None:
        return
    if shaft.overhung:
        yield _round("journal_A", "at web", body.moments_at(outer), body.torque, diameter)
        yield _round("journal_A", "in bearing", body.moments_at(shaft.a), body.torque, diameter)
    else:
        yield _round("journal_A", "at web", body.moments_at(-outer), None, diameter)
        yield _round("journal_B", "at web", body.moments_at(outer), body.torque, diameter)
    if _flywheel_beyond(shaft):
        yield _round("journal_B", "in bearing", body.overhung_moments, body.torque, diameter)
    else:
        flywheel = body.moments_at(shaft.b + shaft.flywheel_position)
        yield _round("journal_B", "at flywheel", flywheel, body.torque, diameter)


def _flywheel_beyond(shaft: Crankshaft) -> bool:
    """Return whether the flywheel is in bearing B or beyond, by the first of the machines."""
    return bool(np.ravel(shaft.b + shaft.flywheel_position >= shaft.b)[0])


def _round(part: str, name: str, moments: Vector, torque: Any, diameter: Any) -> Place:
    """Stresses at the surface of a round section, whose bendings add up as vectors."""
    in_plane, out_of_plane = (abs(round_bending(moment, diameter)) for moment in moments)
    torsion = None if torque is None else abs(round_torsion(torque, diameter))
    return Place(part, name, 1.0, None, in_plane, out_of_plane, torsion, np.hypot(in_plane, out_of_plane))


def _web(part: str, shaft: Crankshaft, loads: WebLoads) -> Iterator[Place]:
    """Stresses of a web, a rectangle t × w: σ = S/(t w) + 6 M/(b h²) across h (G, webs, "auf Druck", "auf Biegung").

    Its torsion is τ = (9/2) M_d/(t² w) in the middle of the wide faces and (9/2) M_d/(t w²) in that of the narrow ones
    (G, webs, "auf Drehung"): Bach's rounded factor; de Saint-Venant's own is 4.81 for a square and 3 for a strip.
    """
    t, w = shaft.web_thickness, shaft.web_width
    alpha = bach_factor(shaft.allowable_bending, shaft.allowable_torsion)
    direct = loads.force / t / w
    wide, narrow = abs(6 * loads.in_plane / w / t / t), 6 * loads.out_of_plane / t / w / w
    twist = 4.5 * abs(loads.twist)
    yield Place(part, "wide face", alpha, direct, wide, None, twist / t / t / w, abs(direct) + wide)
    yield Place(part, "narrow face", alpha, direct, None, narrow, twist / w / w / t, abs(direct) + narrow)
    yield Place(part, "corner", alpha, direct, wide, narrow, None, abs(direct) + wide + narrow)


class StressColumns(AtAngles):
    """Forces and stresses of one machine at crank angles φ (n,) in degrees; state: of its cylinder there."""

    commands = ("stress",)

    def __init__(self, phi: Array, state: State, body: FreeBody) -> None:
        self.phi, self._state, self._body = phi, state, body

    @column("D", "force")
    def D(self) -> Any:
        """Radial force at the crank pin, positive toward the shaft."""
        return self._state.D

    @column("T", "force")
    def T(self) -> Any:
        """Tangential force at the crank pin, positive when it drives."""
        return self._state.T

    @column("A_D", "force")
    def A_D(self) -> Any:
        """Force on bearing A along D, in the frame that turns with the throw."""
        return self._body.A.D

    @column("A_T", "force")
    def A_T(self) -> Any:
        """Force on bearing A along T."""
        return self._body.A.T

    @column("B_D", "force")
    def B_D(self) -> Any:
        """Force on bearing B, beside the flywheel, along D."""
        return self._body.B.D

    @column("B_T", "force")
    def B_T(self) -> Any:
        """Force on bearing B along T."""
        return self._body.B.T

    @cached_property
    def _largest(self) -> dict[str, tuple[Array, Array]]:
        """The largest of Bach's and of von Mises' stresses of each part that is examined."""
        found: dict[str, tuple[Array, Array]] = {}
        for place in places(self._body):
            known = found.get(place.part, (0.0, 0.0))
            found[place.part] = np.maximum(known[0], place.combined), np.maximum(known[1], place.von_mises)
        return found

    @for_each(PARTS, "sigma_*", "σ_*", "stress")
    def sigma(self, part: str) -> Array | None:
        """Largest combined stress of * (Bach)."""
        return self._largest[part][0] if part in self._largest else None

    @for_each(PARTS, "mises_*", "σ_v,*", "stress")
    def mises(self, part: str) -> Array | None:
        """Largest equivalent stress of * (von Mises)."""
        return self._largest[part][1] if part in self._largest else None


class _Cycle(NamedTuple):
    """The cycle on pieces on which the loads are polynomials, and no stress has a kink.

    pin: D and T of the whole force on the pin in N, and what the rod itself adds to D; loads: magnitudes in N of the
    forces on the pin, A and B, and of the rod force. Each (…, nodes, pieces).
    """

    pieces: Pieces
    pin: Array
    loads: Array


class CrankshaftStrength(Results):
    """What `kurbel stress` computes: statics and stresses of the only crank throw of a machine.

    Raises UsageError where the machine has no crankshaft, more than one cylinder, or no pressure that loads it. Of many
    machines the key values are arrays (machines,), nan where the flywheel is not on the same side of B as the first.
    """

    command = "stress"
    state = StressColumns

    def __init__(self, machine: Machine, cylinders: Sequence[CylinderForces]) -> None:
        obstacle = machine.strength_obstacle
        if obstacle or machine.crankshaft is None:
            raise UsageError(f"{machine.name}: {obstacle}")
        self.machine = machine
        self.shaft: Crankshaft = machine.crankshaft
        self.forces = cylinders[0]
        self.count = self.forces.drive.count

    # loads

    @property
    def weight(self) -> Any:
        """Weight of the flywheel in N that counts; None where there is none, or its direction is not known."""
        if self.forces.drive.cylinder.inclination is None or not some(self.shaft.flywheel_mass != 0):
            return None
        return self.shaft.flywheel_mass * GRAVITY

    def _body(self, pin: Vector, angle: CrankAngle, pieces: Pieces | None = None) -> FreeBody:
        """Return the throw under a force on its pin at crank angles: of the nodes of pieces, or one of each machine."""
        spread = pieces if self.count is not None else None
        machine = self.machine if spread is None else taken(self.machine, spread.machine)
        (cylinder,), shaft = machine.cylinders, machine.crankshaft
        assert shaft is not None
        return FreeBody(shaft, cylinder.mechanism.crank, pin, flywheel_weight(machine, cylinder, angle))

    def _columns(self, phi: Array, within: Array) -> StressColumns:
        state = State.at(self.forces.drive, phi, within)
        return StressColumns(phi, state, self._body(on_pin(state), state.angle))

    # the cycle

    @cached_property
    def _cycle(self) -> _Cycle:
        """The cycle cut where the force or moment of a stress is zero, so that its magnitude has a kink there."""
        pieces, state = self.forces.pieces, self.forces.samples
        pin = on_pin(state)
        parts = np.stack([np.broadcast_to(one, pieces.degrees.shape) for one in (*pin, state.D - pin.D)])
        body = self._body(Vector(*parts[:2]), state.angle, pieces)
        self._refuse_overflow(body)
        in_plane, twist = body.moments_at(body.shaft.web_distance)
        # the web beyond the pin is bent out of plane as much at the pin as at the shaft
        ends = (body.before_pin.T - body.pin.T, body.before_pin.T + body.pin.T)
        kinked = (*body.pin, *body.A, body.force_beyond_pin, in_plane, twist, *ends, state.D)
        kinks = np.stack([np.broadcast_to(one, pieces.degrees.shape) for one in kinked])

        def magnitudes(some: Pieces, found: Array) -> Array:
            body = self._body(Vector(*found[:2]), CrankAngle.at_nodes(some), some)
            loads = (found[:2], body.A, body.B, (found[0] + found[2], found[1]))
            return np.stack([np.hypot(*load) for load in loads])

        fine, loads, found = resolved(pieces, parts, kinks, pieces.largest(kinks), magnitudes)
        return _Cycle(fine, found, loads)

    def _refuse_overflow(self, body: FreeBody) -> None:
        """Raise UsageError where the stresses of the only machine are no finite numbers."""
        if self.count is None and not all(
            np.isfinite(stress).all() for place in places(body) for stress in (place.combined, place.von_mises)
        ):
            raise UsageError(
                f"{self.machine.name}: the stresses of the crankshaft are too large to compute with: "
                "check the numbers and units of the machine file"
            )

    @cached_property
    def _largest(self) -> list[Extreme]:
        """The largest of Bach's stresses over the cycle, then of von Mises', of every place."""

        def stresses(some: Pieces, pin: Array) -> Array:
            found = tuple(places(self._body(Vector(*pin[:2]), CrankAngle.at_nodes(some), some)))
            return np.stack([*(one.combined for one in found), *(one.von_mises for one in found)])

        found, degrees = highest(self._cycle.pieces, self._cycle.pin, stresses)
        if self.count is not None:
            alike = (self.shaft.b + self.shaft.flywheel_position >= self.shaft.b) == _flywheel_beyond(self.shaft)
            found = np.where(np.broadcast_to(alike, self.count), found, math.nan)
        return [Extreme(*map(self.forces.told, pair)) for pair in zip(found, degrees)]

    @cached_property
    def _largest_loads(self) -> list[Extreme]:
        """The largest forces on pin, A and B."""
        found = self._cycle.pieces.extremes(self._cycle.loads[:3])
        return [Extreme(*map(self.forces.told, pair)) for pair in zip(found.largest, found.largest_at)]

    @property
    def breaks(self) -> Array:
        """The crank angles in degrees of the only machine between which every quantity is smooth."""
        return np.append(self._cycle.pieces.low, self._cycle.pieces.cycle)

    # the two positions of the book, and the worst of the cycle

    def _force_extremes(self, column: str) -> Extremes:
        _ = self._cycle  # forces that are too large are refused before they are searched
        found = self.forces.extremes_of(column)
        assert found is not None
        return found

    @cached_property
    def largest_torque(self) -> Extreme:
        """The largest T in N, or the smallest where the machine is driven harder than it drives, and its angle."""
        found = self._force_extremes("T")
        return chosen(found.peak.degrees == found.largest.degrees, found.largest, found.smallest)

    @cached_property
    def full_force(self) -> Extreme:
        """The largest piston force without inertia in N, and the dead centre in degrees in which the throw takes it.

        Starting and slow running (R p. 608): the inner dead centre, or the outer one where pulling is stronger.
        """
        found, motion = self._force_extremes("P_start"), self.forces.motion
        pushes = found.largest.value >= -found.smallest.value
        inner, outer = Extreme(found.largest.value, motion.phi_idc), Extreme(found.smallest.value, motion.phi_odc)
        return chosen(pushes, inner, outer)

    @cached_property
    def at_dead_centre(self) -> tuple[Place, ...]:
        """Every place in the firing dead centre under the full force of the pressure: T = 0, D = P cos(φ+ψ)/cos ψ."""
        force, degrees = self.full_force
        angle = CrankAngle.of(degrees)
        radial: Any = self.forces.drive.mechanism.radial(angle)
        body = self._body(Vector(force * radial, 0.0), angle)
        return tuple(place._replace(degrees=degrees) for place in places(body))

    @cached_property
    def at_largest_torque(self) -> tuple[Place, ...]:
        """Every place in the position of the largest torque, of the only machine."""
        torque, degrees = self.largest_torque
        body, _ = self._beside([degrees])
        nearest = np.abs(body.pin.T - torque).argmin()
        return tuple(place.one_of(nearest, degrees) for place in places(body))

    @cached_property
    def at_worst(self) -> tuple[Place, ...]:
        """Every place at the crank angle of the running machine at which its own combined stress is largest."""
        worst = self._largest[: len(self.at_dead_centre)]
        body, side = self._beside([one.degrees for one in worst])
        found = []
        for number, (place, one) in enumerate(zip(places(body), worst)):
            nearest = np.where(side == number, np.abs(place.combined - one.value), math.inf).argmin()
            found.append(place.one_of(nearest, one.degrees))
        return tuple(found)

    def _beside(self, degrees: Sequence[float]) -> tuple[FreeBody, Array]:
        """Return the throw on both sides of angles in degrees of the only machine, and to which angle each belongs."""
        pieces, each = self._cycle.pieces, np.repeat(np.asarray(degrees), 2)
        rows = pieces.holding(np.zeros(len(each), dtype=np.intp), each + np.tile((-1e-9, 1e-9), len(degrees)))
        state = State(self.forces.drive, CrankAngle.of(each), pieces.middle[rows])
        return self._body(on_pin(state), state.angle), np.repeat(np.arange(len(degrees)), 2)

    # key values

    @key_value("P_dc", "force")
    def P_dc(self) -> Extreme:
        """Full piston force, without inertia, taken in the dead centre."""
        return self.full_force

    @key_value("C_r", "force")
    def C_rod(self) -> Any:
        """Centrifugal force of the connecting rod's turning part, which D does not contain."""
        return self.forces.drive.rod_pull if some(self.forces.drive.rod_pull != 0) else None

    @for_each(PARTS, "sigma_*_dc", "σ_*,dc", "stress", group=str)
    def sigma_dc_value(self, part: str) -> Any:
        """Combined stress of * in the dead centre under full force (Bach)."""
        found = self.sigma_dc(part)
        return found and found.value

    def sigma_dc(self, part: str) -> Extreme | None:
        """Return the largest combined stress of a part in Pa in the dead centre; None for one that is not examined."""
        return _highest(Extreme(one.combined, one.degrees) for one in self.at_dead_centre if one.part == part)

    def _largest_of(self, part: str, found: Sequence[Extreme]) -> Extreme | None:
        return _highest(one for one, place in zip(found, self.at_dead_centre) if place.part == part)

    @for_each(PARTS, "sigma_*_max", "σ_*,max", "stress", group=str)
    def sigma_max(self, part: str) -> Extreme | None:
        """Largest combined stress of * over the cycle (Bach)."""
        return self._largest_of(part, self._largest)

    @for_each(PARTS, "mises_*_max", "σ_v,*,max", "stress", group=str)
    def mises_max(self, part: str) -> Extreme | None:
        """Largest equivalent stress of * over the cycle (von Mises)."""
        return self._largest_of(part, self._largest[len(self.at_dead_centre) :])

    @for_each(PARTS, "safety_*_min", "S_*", "ratio", group=str)
    def safety(self, part: str) -> Extreme | None:
        """Smallest safety of *: k_b over its combined stress, dead centre and cycle."""
        allowable = self.shaft.allowable_bending
        worst = _highest(one for one in (self.sigma_dc(part), self.sigma_max(part)) if one)
        if allowable is None or worst is None or every(worst.value == 0):
            return None
        return Extreme(allowable / where(worst.value == 0, math.nan, worst.value), worst.degrees)

    @key_value("A_max", "force")
    def A_max(self) -> Extreme:
        """Largest force on bearing A."""
        return self._largest_loads[1]

    @key_value("B_max", "force")
    def B_max(self) -> Extreme:
        """Largest force on bearing B, beside the flywheel."""
        return self._largest_loads[2]

    @key_value("p_pin,dc", "pressure")
    def p_pin_dc(self) -> Any:
        """Pressure on the crank pin under full force, P/(d l).

        G: P_max/(d_z l_z).
        """
        return abs(self.full_force.value) / self.shaft.pin_diameter / self.shaft.pin_length

    @for_each(_BEARINGS, "p_*_max", "p_*,max", "pressure", group=str)
    def pressure_max(self, part: str) -> Extreme | None:
        """Largest pressure on * over the cycle, force over d l."""
        size, load = self._size(part), self._largest_loads[[*_BEARINGS].index(part)]
        return Extreme(load.value / size[0] / size[1], load.degrees) if size else None

    @for_each(_BEARINGS, "p_*_mean", "p_*,m", "pressure", after="p_*_max", group=str)
    def pressure_mean(self, part: str) -> Any:
        """Mean pressure on * over the time of a cycle.

        On the pin that of the rod force alone, as G has it for its bounds on p_m v.
        """
        size = self._size(part)
        return self._mean_loads[part] / size[0] / size[1] if size else None

    @cached_property
    def _mean_loads(self) -> dict[str, Any]:
        """Means over time in N of the forces on both bearings, and of the force of the rod on the pin."""
        means = self._cycle.pieces.mean(self._cycle.loads[1:])
        return dict(zip(("journal_A", "journal_B", "pin"), map(self.forces.told, means)))

    @for_each(_BEARINGS, "k_*", "k_*", "pressure_velocity", after="p_*_mean", group=str)
    def pressure_velocity(self, part: str) -> Any:
        """Mean pressure times surface speed, p_m v, of *.

        In W/m², v = π d n (G); None without a speed of rotation.
        """
        pressure, speed, size = self.pressure_mean(part), self.machine.speed, self._size(part)
        return None if pressure is None or speed is None or size is None else pressure * math.pi * size[0] * speed

    def _size(self, part: str) -> tuple[Any, Any] | None:
        """Return diameter and length of a pin or journal in m; None where one is not given."""
        shaft = self.shaft
        if part == "pin":
            return shaft.pin_diameter, shaft.pin_length
        given = shaft.journal_diameter is not None and shaft.journal_length is not None
        return (shaft.journal_diameter, shaft.journal_length) if given else None

    @key_value("ΣF, ΣM", "ratio", plain="sum F, M", residual=True)
    def equilibrium_residual(self) -> Any:
        """What is left of the sums of forces and moments on the crankshaft.

        Over the sizes of their terms, at its worst.
        """
        pieces, state = self.forces.pieces, self.forces.samples
        body = self._body(on_pin(state), state.angle, pieces)
        return self.forces.told(pieces.largest(equilibrium_residual(body, np.asarray(state.torque))))


def _highest(found: Iterable[Extreme]) -> Extreme | None:
    """Return the one with the largest value, the first of equal ones; None of none."""
    every_one = list(found)
    return largest(*every_one) if every_one else None
