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
from functools import cached_property, partial
from typing import Any, NamedTuple

import numpy as np

from kurbel.arrays import Array
from kurbel.crank_angle import CrankAngle
from kurbel.declared.units import GRAVITY
from kurbel.errors import UsageError
from kurbel.machine import Machine
from kurbel.machine.crankshaft import Crankshaft
from kurbel.machine.variants import taken
from kurbel.numerics.arithmetic import every, some, where
from kurbel.numerics.extreme import Extreme, Extremes, chosen, largest
from kurbel.numerics.pieces import Pieces, highest, resolved
from kurbel.solver.figures import Columns, Results
from kurbel.solver.forces import CylinderForces
from kurbel.solver.shaft import FreeBody, Vector, WebLoads, equilibrium_residual, flywheel_weight
from kurbel.solver.state import State, on_pin

PARTS = ("pin", "web_A", "web_B", "journal_A", "journal_B")

# Stresses in a section: numbers or arrays in N, N m and m give Pa. They divide by one length at a time: the product of
# three tiny ones would be zero.


def rectangle_bending(moment: Any, depth: Any, breadth: Any) -> Any:
    """Return σ = 6M/(b h²) in Pa at the faces of a rectangle bent across its depth h.

    moment in N m; depth: h in m, the side in the plane of bending; breadth: b in m. Source: G, webs, "auf Biegung".

    >>> round(rectangle_bending(1000.0, depth=0.1, breadth=0.2))
    3000000
    """
    return 6 * moment / breadth / depth / depth


def face_torsion(moment: Any, depth: Any, breadth: Any) -> Any:
    """Return τ = (9/2) M/(b h²) in Pa at the middle of the two faces of a rectangle that are h apart.

    moment in N m, depth and breadth in m: at the wide faces, where it is largest, h is the shorter side; at the narrow
    ones the longer one. Bach's rounded factor: de Saint-Venant's own is 4.81 for a square and 3 for a strip, 4.07 for
    sides of 1 and 2. Source: G, webs, "auf Drehung".
    """
    return 4.5 * moment / depth / depth / breadth


def round_bending(moment: Any, diameter: Any) -> Any:
    """Return σ = 32 M/(π d³) in Pa at the surface of a round section; moment in N m, diameter in m (G, M_b/Z)."""
    return 32 / math.pi * moment / diameter / diameter / diameter


def round_torsion(moment: Any, diameter: Any) -> Any:
    """Return τ = 16 M/(π d³) in Pa at the surface of a round section; moment in N m, diameter in m (G, M_d/Z_p)."""
    return 16 / math.pi * moment / diameter / diameter / diameter


def bach(sigma: Any, tau: Any, alpha: Any) -> Any:
    """Return Bach's combined stress 0.35 σ + 0.65 √(σ² + 4 (α₀ τ)²) in Pa.

    sigma: normal stress in Pa, its magnitude counts; tau: shear stress in Pa; alpha: α₀ = k_b/(1.3 k_d), see
    `bach_factor`. Source: G, "Resultierende Beanspruchung nach Bach".

    >>> float(bach(100.0, 0.0, 1.0)), float(bach(0.0, 100.0, 1.0))
    (100.0, 130.0)
    """
    return 0.35 * abs(sigma) + 0.65 * np.hypot(sigma, 2 * alpha * tau)


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
        """Stress in Pa combined after Bach."""
        return bach(self.normal, 0.0 if self.torsion is None else self.torsion, self.alpha)

    @property
    def von_mises(self) -> Any:
        """Equivalent stress √(σ² + 3 τ²) in Pa after von Mises."""
        return np.hypot(self.normal, 0.0 if self.torsion is None else math.sqrt(3) * self.torsion)


def places(body: FreeBody) -> Iterator[Place]:
    """Yield the places of a crankshaft under its forces; those of the journals only where their diameter is given.

    α₀ is 1 for what is round (G, for the pin), and that of the allowable stresses for the webs.
    """
    shaft, diameter = body.shaft, body.shaft.journal_diameter
    inner, outer = (shaft.web_distance + side * shaft.web_thickness / 2 for side in (-1, 1))  # faces of a web
    # in the middle of the pin M_b = a √(A_T² + A_D²) and M_d = A_T r (G)
    sections = {"at web A": inner} if shaft.overhung else {"middle": 0.0, "at web A": -inner, "at web B": inner}
    for name, u in sections.items():
        twist = body.before_pin.T * body.crank
        yield _round("pin", name, body.moments_at(u), twist, shaft.pin_diameter)
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
    t, w = shaft.web_thickness, shaft.web_width
    alpha = bach_factor(shaft.allowable_bending, shaft.allowable_torsion)
    direct = loads.force / t / w  # G, webs, "auf Druck"
    wide = abs(rectangle_bending(loads.in_plane, t, w))
    narrow = rectangle_bending(loads.out_of_plane, w, t)
    at_wide, at_narrow = abs(face_torsion(loads.twist, t, w)), abs(face_torsion(loads.twist, w, t))
    yield Place(part, "wide face", alpha, direct, wide, None, at_wide, abs(direct) + wide)
    yield Place(part, "narrow face", alpha, direct, None, narrow, at_narrow, abs(direct) + narrow)
    yield Place(part, "corner", alpha, direct, wide, narrow, None, abs(direct) + wide + narrow)


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

    @property
    def C_rod(self) -> Any:
        """Centrifugal force in N of the connecting rod's turning part that D does not contain; None without one."""
        return self.forces.drive.rod_pull if some(self.forces.drive.rod_pull != 0) else None

    def _body(self, pin: Vector, angle: CrankAngle, pieces: Pieces | None = None) -> FreeBody:
        """Return the throw under a force on its pin at crank angles: of the nodes of pieces, or one of each machine."""
        spread = pieces if self.count is not None else None
        machine = self.machine if spread is None else taken(self.machine, spread.machine)
        (cylinder,), shaft = machine.cylinders, machine.crankshaft
        assert shaft is not None
        weight = flywheel_weight(machine, cylinder, angle)
        return FreeBody(shaft, cylinder.mechanism.crank, pin, weight)

    def _running(self, state: State) -> FreeBody:
        return self._body(on_pin(state), state.angle)

    def _columns(self, phi: Array, within: Array) -> Columns:
        """Return forces on pin (D, T: of the rod alone, R 302 and 303) and bearings, and the stresses of each part."""
        state = State.at(self.forces.drive, phi, within)
        body = self._running(state)
        found = dict(zip(("D", "T", "A_D", "A_T", "B_D", "B_T"), (state.D, state.T, *body.A, *body.B)))
        for part in PARTS:
            own = [place for place in places(body) if place.part == part]
            found[f"sigma_{part}"] = np.max([one.combined for one in own], axis=0) if own else None
            found[f"mises_{part}"] = np.max([one.von_mises for one in own], axis=0) if own else None
        return Columns(phi, {id: partial(found.get, id) for id in found})

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

    @cached_property
    def _parts(self) -> tuple[str, ...]:
        """The part of every place."""
        return tuple(place.part for place in self.at_dead_centre)

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
        found = self._cycle.pieces.extremes(self._cycle.loads[:3])
        return [Extreme(*map(self.forces.told, pair)) for pair in zip(found.largest, found.largest_at)]

    def _refuse_overflow(self, body: FreeBody) -> None:
        """Raise UsageError where the stresses of the only machine are no finite numbers."""
        if self.count is None and not all(
            np.isfinite(stress).all() for place in places(body) for stress in (place.combined, place.von_mises)
        ):
            raise UsageError(
                f"{self.machine.name}: the stresses of the crankshaft are too large to compute with: "
                "check the numbers and units of the machine file"
            )

    @property
    def breaks(self) -> Array:
        """The crank angles in degrees of the only machine between which every quantity is smooth."""
        return np.append(self._cycle.pieces.low, self._cycle.pieces.cycle)

    # the two positions of the book, and the worst of the cycle

    @cached_property
    def full_force(self) -> Extreme:
        """The largest piston force without inertia in N, and the dead centre in degrees in which the throw takes it.

        Starting and slow running (R p. 608): the inner dead centre, or the outer one where pulling is stronger.
        """
        found, motion = self._force_extremes("P_start"), self.forces.motion
        assert motion.phi_idc is not None
        assert motion.phi_odc is not None
        pushes = found.largest.value >= -found.smallest.value
        return chosen(
            pushes, Extreme(found.largest.value, motion.phi_idc), Extreme(found.smallest.value, motion.phi_odc)
        )

    @cached_property
    def largest_torque(self) -> Extreme:
        """The largest T in N, or the smallest where the machine is driven harder than it drives, and its angle."""
        found = self._force_extremes("T")
        return chosen(found.peak.degrees == found.largest.degrees, found.largest, found.smallest)

    def _force_extremes(self, column: str) -> Extremes:
        _ = self._cycle  # forces that are too large are refused before they are searched
        found = self.forces.extremes_of(column)
        assert found is not None
        return found

    @cached_property
    def at_dead_centre(self) -> tuple[Place, ...]:
        """Every place in the firing dead centre under the full force of the pressure: T = 0, D = P cos(φ+ψ)/cos ψ."""
        force, degrees = self.full_force
        angle = CrankAngle.of(degrees)
        radial: Any = self.forces.drive.mechanism.radial(angle)
        body = self._body(Vector(force * radial, 0.0), angle)
        return tuple(_at(place, degrees) for place in places(body))

    @cached_property
    def at_largest_torque(self) -> tuple[Place, ...]:
        """Every place in the position of the largest torque, of the only machine."""
        torque, degrees = self.largest_torque
        body, _ = self._beside([degrees])
        nearest = np.abs(body.pin.T - torque).argmin()
        return tuple(_at(place, degrees, nearest) for place in places(body))

    @cached_property
    def at_worst(self) -> tuple[Place, ...]:
        """Every place at the crank angle of the running machine at which its own combined stress is largest."""
        worst = self._largest[: len(self._parts)]
        body, side = self._beside([one.degrees for one in worst])
        found = []
        for number, (place, one) in enumerate(zip(places(body), worst)):
            nearest = np.where(side == number, np.abs(place.combined - one.value), math.inf).argmin()
            found.append(_at(place, one.degrees, nearest))
        return tuple(found)

    def _beside(self, degrees: Sequence[float]) -> tuple[FreeBody, Array]:
        """Return the throw on both sides of angles in degrees of the only machine, and to which angle each belongs."""
        pieces, each = self._cycle.pieces, np.repeat(np.asarray(degrees), 2)
        rows = pieces.holding(np.zeros(len(each), dtype=np.intp), each + np.tile((-1e-9, 1e-9), len(degrees)))
        state = State(self.forces.drive, CrankAngle.of(each), pieces.middle[rows])
        return self._running(state), np.repeat(np.arange(len(degrees)), 2)

    def sigma_dc(self, part: str) -> Extreme | None:
        """Return the largest combined stress of a part in Pa in the dead centre; None for one that is not examined."""
        return _highest(Extreme(one.combined, one.degrees) for one in self.at_dead_centre if one.part == part)

    def sigma_max(self, part: str) -> Extreme | None:
        """Return the largest combined stress of a part in Pa over the cycle, and its crank angle."""
        return _highest(one for one, own in zip(self._largest, self._parts) if own == part)

    def mises_max(self, part: str) -> Extreme | None:
        """Return the largest stress of a part after von Mises in Pa over the cycle, and its crank angle."""
        return _highest(one for one, own in zip(self._largest[len(self._parts) :], self._parts) if own == part)

    def safety(self, part: str) -> Extreme | None:
        """Return k_b over the largest combined stress of a part, dead centre and cycle; None without k_b or stress."""
        allowable = self.shaft.allowable_bending
        worst = _highest(one for one in (self.sigma_dc(part), self.sigma_max(part)) if one)
        if allowable is None or worst is None or every(worst.value == 0):
            return None
        return Extreme(allowable / where(worst.value == 0, math.nan, worst.value), worst.degrees)

    # bearings

    def load_max(self, bearing: str) -> Extreme:
        """Return the largest force in N on `pin`, `A` or `B` over the cycle."""
        return self._largest_loads[("pin", "A", "B").index(bearing)]

    def pressure_max(self, bearing: str) -> Extreme | None:
        """Return the largest force over the projected area d l in Pa; None where diameter or length is not given."""
        size, load = self._size(bearing), self.load_max(bearing)
        return Extreme(load.value / size[0] / size[1], load.degrees) if size else None

    def pressure_mean(self, bearing: str) -> Any:
        """Return p_m in Pa: the mean over time, at uniform rotation, of the force over the projected area.

        On the pin that of the rod force alone, as G has it for its bounds on p_m v.
        """
        size = self._size(bearing)
        return self._mean_loads[bearing] / size[0] / size[1] if size else None

    @cached_property
    def _mean_loads(self) -> dict[str, Any]:
        """Means over time in N of the forces on both bearings, and of the force of the rod on the pin."""
        means = self._cycle.pieces.mean(self._cycle.loads[1:])
        return dict(zip(("A", "B", "pin"), map(self.forces.told, means)))

    def pressure_velocity(self, bearing: str) -> Any:
        """Return k = p_m v in W/m² with the surface speed v = π d n (G); None without a speed of rotation."""
        pressure, speed, size = self.pressure_mean(bearing), self.machine.speed, self._size(bearing)
        return None if pressure is None or speed is None or size is None else pressure * math.pi * size[0] * speed

    def _size(self, bearing: str) -> tuple[Any, Any] | None:
        shaft = self.shaft
        if bearing == "pin":
            return shaft.pin_diameter, shaft.pin_length
        given = shaft.journal_diameter is not None and shaft.journal_length is not None
        return (shaft.journal_diameter, shaft.journal_length) if given else None

    @property
    def pin_pressure_dc(self) -> Any:
        """Full force over the projected area of the pin in Pa (G: P_max/(d_z l_z))."""
        return abs(self.full_force.value) / self.shaft.pin_diameter / self.shaft.pin_length

    @cached_property
    def equilibrium_residual(self) -> Any:
        """What is left of the sums of forces and moments on the shaft, over the sizes of their terms, at its worst."""
        pieces, state = self.forces.pieces, self.forces.samples
        body = self._body(on_pin(state), state.angle, pieces)
        return self.forces.told(pieces.largest(equilibrium_residual(body, np.asarray(state.torque))))


def _at(place: Place, degrees: Any, number: Any = None) -> Place:
    """Return a place at a crank angle; with the stresses in one of several states, where one is meant."""
    if number is None:
        return place._replace(degrees=degrees)
    own: dict[str, Any] = {name: float(each[number]) for name, each in place._asdict().items() if np.ndim(each)}
    return place._replace(**own, degrees=degrees)


def _highest(found: Iterable[Extreme]) -> Extreme | None:
    """Return the one with the largest value, the first of equal ones; None of none."""
    every_one = list(found)
    return largest(*every_one) if every_one else None
