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
from kurbel.numerics.pieces import Pieces, resolved
from kurbel.solver.figures import Columns, Results
from kurbel.solver.forces import CylinderForces
from kurbel.solver.pins import on_pin
from kurbel.solver.shaft import FreeBody, Vector, WebLoads, equilibrium_residual, flywheel_weight
from kurbel.solver.state import State

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

    >>> round(bach(100.0, 0.0, 1.0), 9), round(bach(0.0, 100.0, 1.0), 9)
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
    return bool(np.ravel(shaft.flywheel_position)[0] >= 0)


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
    """The cycle on pieces: Bach's and von Mises' stress of every place, and the loads, (q, nodes, pieces)."""

    pieces: Pieces
    places: tuple[tuple[str, str], ...]
    values: Array


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
        """Return the throw under a force on its pin at crank angles, those of the nodes of pieces or one of each machine."""
        spread = self.count is not None and pieces is not None
        machine = taken(self.machine, pieces.machine) if spread and pieces is not None else self.machine
        (cylinder,) = machine.cylinders
        weight = flywheel_weight(machine, cylinder, angle)
        return FreeBody(machine.crankshaft, cylinder.mechanism.crank, pin, weight)

    def _running(self, state: State) -> FreeBody:
        return self._body(on_pin(state), state.angle)

    def _columns(self, phi: Array, within: Array) -> Columns:
        """Return forces on pin (D, T: of the rod alone, R 302 and 303) and bearings, and the stresses of each part."""
        state = self.forces.drive.at(phi, within)
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
        names: list[tuple[str, str]] = []

        def magnitudes(some: Pieces, found: Array) -> Array:
            body = self._body(Vector(*found[:2]), CrankAngle.at_nodes(some), some)
            every_place = tuple(places(body))
            names[:] = [(one.part, one.name) for one in every_place]
            loads = (found[:2], body.A, body.B, (found[0] + found[2], found[1]))
            return np.stack(
                [one.combined for one in every_place]
                + [one.von_mises for one in every_place]
                + [np.hypot(*load) for load in loads]
            )

        fine, values, _ = resolved(pieces, parts, kinks, pieces.largest(kinks), magnitudes)
        if self.count is not None:
            alike = (self.shaft.flywheel_position >= 0) == _flywheel_beyond(self.shaft)
            values = np.where(fine.of(np.broadcast_to(alike, self.count)), values, math.nan)
        return _Cycle(fine, tuple(names), values)
