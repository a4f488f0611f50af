"""Free bodies of the throws of a crankshaft: bearing forces, and internal forces and moments.

                      F = (D, T)
                          │
                    ┌─────┴─────┐          r   crank radius
             web A  │           │  web B   e   from the middle of the pin to the middle of a web
                    │           │
    ──A─────────────┘           └─────────────B──────── G    flywheel, f outside of B
      |←────── a ──────→|←─────── b ─────────→|←── f ──→|

Components are in the frame that turns with the throw: D from the pin toward the shaft, T in the sense of rotation; u is
the coordinate along the shaft from the middle of the pin. A and B are the forces of the shaft on the bearings, so that
a load D on a pin between them gives A_D and B_D of the same sign. In an overhung crank bearing A is at u = +a, between
its only web and bearing B.

    between bearings    1──┐ ┌──2──┐ ┌──3            a, b from every pin to its bearings; the flywheel by the last one
                           └─┘     └─┘
    overhung            ┌──1────────2──┐             at most two throws, at the ends of a shaft with two bearings
                        ┘              └

Several throws are made statically determinate by a hinge in each bearing between two throws, which carries the forces
of both. A real shaft is continuous over its bearings; their loads then depend on the stiffness of shaft and frame.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from kurbel.arrays import Array, Number, Truth
from kurbel.crank_angle import CrankAngle, unit_vector
from kurbel.declared.units import GRAVITY
from kurbel.errors import UsageError
from kurbel.machine import Cylinder, Machine
from kurbel.machine.crankshaft import Crankshaft
from kurbel.numerics.arithmetic import magnitude, some, where
from kurbel.solver.weights import counterweights_of, throws_with_masses

_ALIKE = 1e-9
"""Degrees, and metres, by which throws differ by rounding only."""


class Vector(NamedTuple):
    """A force in N along D and along T, or the moments in N m of forces along them."""

    D: Number
    T: Number


# one throw


def weight_in_throw(weight: float, angle: CrankAngle, inclination: float) -> Vector:
    """Return a weight on the shaft in the frame of the throw: D = G sin(φ + i), T = −G cos(φ + i).

    weight: G in N; angle: crank angles φ (n,); inclination: i of the stroke line in degrees, 0 horizontal, 90 cylinder
    above the shaft. The shaft turns so that an engine which drives presses the crosshead down: with a horizontal stroke
    line the pin rises on the outstroke, and in the inner dead centre the weight is square to the throw (G).

    >>> weight_in_throw(100.0, CrankAngle.of(0.0), 0.0)
    Vector(D=0.0, T=-100.0)
    >>> weight_in_throw(100.0, CrankAngle.of(0.0), 90.0).D
    100.0
    """
    incline = CrankAngle.of(inclination)
    return Vector(
        weight * (angle.sin * incline.cos + angle.cos * incline.sin),
        weight * (angle.sin * incline.sin - angle.cos * incline.cos),
    )


def flywheel_weight(machine: Machine, cylinder: Cylinder, angle: CrankAngle) -> Vector:
    """Return the weight of the flywheel in the frame of a cylinder's throw; nothing where its direction is not known.

    angle: crank angles φ (n,) of that cylinder; the inclination given is that of the stroke line of cylinder 1.
    """
    shaft, first = machine.crankshaft, machine.cylinders[0]
    lean = machine.inclination_of(first)
    if shaft is None or lean is None or not some(shaft.flywheel_mass != 0):
        return Vector(0.0, 0.0)
    inclination = lean + cylinder.bank_angle - first.bank_angle
    return weight_in_throw(shaft.flywheel_mass * GRAVITY, angle, inclination)


class FreeBody:
    """One throw under the force on its pin and the weight of the flywheel.

    shaft: lengths in m; crank: r in m; pin: whole force on the pin in N; weight: of the flywheel in N, in one frame.
    The torque T r in N m leaves the shaft at the flywheel; end A has no torque.

    A, B: forces on the bearings in N, A = (F b − G f)/(b − u_A), u_A = −a, overhung a; G: A_p = P b/(a + b).
    before_pin: shear force in N in the shaft before the pin, the force on bearing A; 0 for an overhung crank.
    along_web: force along the web toward B, compression positive: D − A_D, that is B_D less the flywheel weight;
    D in the web of an overhung crank.
    """

    def __init__(self, shaft: Crankshaft, crank: Number, pin: Vector, weight: Vector) -> None:
        self.shaft, self.crank, self.pin, self.weight = shaft, crank, pin, weight
        b, f, span, both = shaft.b, shaft.flywheel_position, shaft.span, list(zip(pin, weight))
        self.A = Vector(*((F * b - G * f) / span for F, G in both))
        self.B = Vector(*((G * (span + f) - F * shaft.place_A) / span for F, G in both))
        self.before_pin = Vector(self.A.D * 0.0, self.A.T * 0.0) if shaft.overhung else self.A
        self.along_web, self.torque = pin.D - self.before_pin.D, pin.T * crank

    def moments_at(self, u: Number) -> Vector:
        """Return the bending moments in N m at the section u, of the forces before it.

        A (u − u_A) from bearing A on, less F u from the pin on; valid up to B, or to a flywheel before B. The opposite
        sign of G, P e − A_p (a + e).
        """
        from_A, from_pin = (where(arm > 0, arm, 0.0) for arm in (u - self.shaft.place_A, u))
        return Vector(*(A * from_A - F * from_pin for A, F in zip(self.A, self.pin)))

    def equilibrium_residual(self, torque: Array) -> Array:
        """Return the relative residual of the equilibrium of forces and of moments, the larger of both.

        torque: M on the shaft in N m, shaped as the forces (…), from the work of the piston force and not from T.
        Moments are about the middle of the pin, of the forces where they act; the formulas above are not used.
        """
        shaft = self.shaft
        acting = (
            (self.pin, 1.0, 0.0),
            (self.A, -1.0, shaft.place_A),
            (self.B, -1.0, shaft.b),
            (self.weight, 1.0, shaft.b + shaft.flywheel_position),
        )
        forces = np.stack([sign * (force.D + 1j * force.T) + 0 * torque for force, sign, _ in acting])
        bends = np.stack([force * place for force, (_, _, place) in zip(forces, acting)])
        twists = np.stack([torque, *(force.imag * self.crank for force in forces[1:])])  # the pin's has no arm
        turning = np.hypot(np.abs(bends.sum(axis=0)), twists.sum(axis=0))
        left = np.stack((np.abs(forces.sum(axis=0)), turning))
        sizes = np.stack((np.abs(forces).sum(axis=0), np.abs(bends).sum(axis=0) + np.abs(twists).sum(axis=0)))
        shares = np.divide(left, sizes, out=np.zeros_like(sizes), where=sizes > 0)
        return np.asarray(shares.max(axis=0))


# the throws along a shaft


class Throw(NamedTuple):
    """One throw: the cylinders on its pin by their numbers, from 0; its angle in degrees from the throw of crank 1.

    place: along the shaft in m, 0 where it is not known; A, B: numbers of its bearings, from 0; flywheel: whether its
    weight rests on them; at_A, at_B: mass times radius in kg m of what turns with the shaft, divided between them as by
    a lever, complex: along this throw, and 90° on in the sense of rotation.
    """

    cylinders: tuple[int, ...]
    angle: Number
    place: Number
    A: int = 0
    B: int = 1
    flywheel: bool = False
    at_A: Any = 0.0
    at_B: Any = 0.0


Turned = tuple[Any, Number]
"""Mass times radius in kg m of what turns with the shaft, complex, and its place u in m from a pin."""


def _of_first(condition: Any) -> Any:
    """Return a condition as it holds for the first of many machines."""
    return np.ravel(condition)[0]


class SupportedShaft:
    """The crankshaft of a machine. throws: in order along the shaft; bearings: how many main bearings there are.

    Of many machines the throws are those of the first; the forces of one that has others are nan.
    """

    def __init__(self, machine: Machine) -> None:
        assert machine.crankshaft is not None
        self.machine, self.shaft = machine, machine.crankshaft
        like_first: Truth = True

        def decided(condition: Any) -> Any:
            """Return what holds for the first machine; others for which something else does have other throws."""
            nonlocal like_first
            like_first = like_first & (condition == _of_first(condition))
            return _of_first(condition)

        found = throws_of(machine.cylinders, decided)
        found.sort(key=lambda throw: float(_of_first(throw.place)))
        for one, following in pairwise(found):
            decided(one.place <= following.place)

        between: list[list[Turned]] = [[] for _ in found]
        for number, product, u in self._turning(found, decided):
            between[number].append((product * unit_vector(-found[number].angle), u))
        known = where(like_first, 0.0, math.nan)
        self.throws = tuple(self._supported(found, number, own, known) for number, own in enumerate(between))
        self.bearings = 2 if self.shaft.overhung else len(found) + 1

    def _supported(self, throws: Sequence[Throw], number: int, own: Sequence[Turned], known: Number) -> Throw:
        """Return a throw with its bearings and the weights that turn between them.

        own: mass times radius in kg m, complex, and u in m from the pin, of each weight.

        known: nan for machines with other throws. The second throw of an overhung shaft is at its other end.
        """
        shaft, mirrored = self.shaft, self.shaft.overhung and number > 0
        sign = -1.0 if mirrored else 1.0
        return throws[number]._replace(
            A=1 if mirrored else number,
            B=0 if mirrored else number + 1,
            flywheel=number == (0 if shaft.overhung else len(throws) - 1),
            at_A=known + sum(product * (shaft.b - sign * u) / shaft.span for product, u in own),
            at_B=known + sum(product * (sign * u - shaft.place_A) / shaft.span for product, u in own),
        )

    def _turning(self, throws: Sequence[Throw], decided: Callable[[Any], Any]) -> Iterator[tuple[int, Any, Any]]:
        """Yield of each rotating weight the index of the throw whose bearings carry it, mass times radius, and u in m.

        The masses times radii in kg m are complex, as angles of throws count. A weight is between the bearings of the
        throw that is nearest to it; where its place is not known, of the throw that it belongs to. The rotating part of
        a rod is not included: its force acts on the pin.
        """
        cranks = throws_with_masses(self.machine)
        of_cylinders = {cylinder: number for number, throw in enumerate(throws) for cylinder in throw.cylinders}
        weights = (*(crank.weight(crank.unbalanced) for crank in cranks), *counterweights_of(self.machine, cranks))
        for one in weights:
            own = cranks[one.owner].place
            if one.place is None or one.place is own or (own is not None and decided(one.place == own)):
                yield of_cylinders[one.owner], one.product, 0.0
            else:
                distances = [np.asarray(abs(throw.place - one.place)) for throw in throws]
                nearest = int(decided(np.argmin(np.broadcast_arrays(*distances), axis=0)))
                yield nearest, one.product, one.place - throws[nearest].place

    def throw_of(self, cylinder: int) -> Throw:
        """Return the throw on whose pin a cylinder is, by its number from 0."""
        return next(throw for throw in self.throws if cylinder in throw.cylinders)

    def carried(self, throw: Throw, pin: Vector, own: Cylinder, angle: CrankAngle) -> tuple[Vector, Vector]:
        """Return the forces in N of a throw on its bearings A and B, in its own frame.

        pin: force on its pin in N; own: a cylinder on it, and its own crank angle, for the weight of the flywheel.
        """
        weight = flywheel_weight(self.machine, own, angle) if throw.flywheel else Vector(0.0, 0.0)
        body = FreeBody(self.shaft, own.mechanism.crank, pin, weight)
        omega = 0.0 if self.machine.speed is None else 2 * math.pi * self.machine.speed
        pulls = throw.at_A * omega * omega, throw.at_B * omega * omega
        at_A, at_B = (Vector(one.D - pull.real, one.T + pull.imag) for one, pull in zip((body.A, body.B), pulls))
        return at_A, at_B


def shaft_obstacle(machine: Machine) -> str:
    """Return why the loads on the main bearings of a machine cannot be given, or an empty text."""
    if machine.crankshaft is None:
        return "no 'crankshaft' given, which has the lengths of a throw: 'crankshaft: {a: …, b: …, …}'"
    if not machine.cylinders:
        return "no cylinder loads them; 'effort' gives a torque and no force"
    unknown = next((one.mechanism.name for one in machine.cylinders if not one.mechanism.has_rod), None)
    if unknown is not None:
        return f"the force of a {unknown} on the crank pin is not followed to the bearings"
    count = len(throws_of(machine.cylinders))
    if machine.crankshaft.overhung and count > 2:
        return f"{count} throws cannot all be overhung; a shaft has two ends"
    try:
        list(counterweights_of(machine, throws_with_masses(machine)))
    except UsageError as error:
        return str(error)
    return ""


def throws_of(cylinders: Sequence[Cylinder], decided: Callable[[Any], Any] = _of_first) -> list[Throw]:
    """Return the throws of these cylinders, not yet on their bearings, as the cylinders follow one another.

    Cylinders share a pin where their throws have one angle, γ − β, and one place, and their stroke lines differ.
    decided: says of many machines which condition counts.
    """
    found: list[Throw] = []
    for number, one in enumerate(cylinders):
        angle, place = _remainder(one.bank_angle - one.crank_position), one.axial_position
        place = 0.0 if place is None else place
        for index, throw in enumerate(found):
            lines = [cylinders[other].bank_angle - one.bank_angle for other in throw.cylinders]
            same = (magnitude(_remainder(throw.angle - angle)) <= _ALIKE) & (magnitude(throw.place - place) <= _ALIKE)
            for line in lines:
                same = same & (magnitude(_remainder(line)) > _ALIKE)
            if decided(same):
                found[index] = throw._replace(cylinders=(*throw.cylinders, number))
                break
        else:
            found.append(Throw((number,), angle, place))
    return found


def _remainder(degrees: Number) -> Number:
    """Return an angle in degrees without whole turns, from −180 to 180."""
    return degrees - 360.0 * np.rint(degrees / 360.0)
