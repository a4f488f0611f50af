"""The crankshaft cut free from its bearings: bearing forces, and the forces and moments in its sections.

                      F = (D, T)
                          │
                    ┌─────┴─────┐          r   crank radius
             web A  │           │  web B   e   from the middle of the pin to the middle of a web
                    │           │
    ──A─────────────┘           └─────────────B──────── G    flywheel, f outside of B
      |←────── a ──────→|←─────── b ─────────→|←── f ──→|

Everything is told in the frame that turns with the throw: D from the pin toward the shaft, T in the sense of rotation,
u along the shaft from the middle of the pin. Forces on bearings count as loads do: between the bearings a load D on the
pin gives A_D and B_D of its own sign. An overhung crank has nothing before its pin: bearing A stands at u = +a, between
its only web and bearing B.
"""

import math
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from kurbel.arrays import Array
from kurbel.crank_angle import CrankAngle
from kurbel.declared.units import GRAVITY
from kurbel.machine import Cylinder, Machine
from kurbel.numerics.arithmetic import where
from kurbel.numerics.jet import Jet

if TYPE_CHECKING:
    from kurbel.machine.crankshaft import Crankshaft


class Vector(NamedTuple):
    """A force in N, or the moments in N m of forces along D and along T; each (n,) or a jet."""

    D: Any
    T: Any


class WebLoads(NamedTuple):
    """What a web carries: force along it in N; in-plane bending, out-of-plane bending and twist in N m."""

    force: Any
    in_plane: Any
    out_of_plane: Any
    twist: Any


def weight_in_throw(weight: float, angle: CrankAngle, inclination: float) -> Vector:
    """Return a weight on the shaft in the frame of the throw: D = G sin(φ + i), T = −G cos(φ + i).

    weight: G in N; angle: crank angles φ (n,); inclination: i of the stroke line in degrees, 0 lying, 90 cylinder above
    the shaft. The shaft turns so that an engine which drives presses the crosshead down: lying, the pin rises on the
    outstroke, and in the inner dead centre the weight stands square to the throw (G).

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

    angle: crank angles φ (n,) of that cylinder; what inclines is the stroke line of cylinder 1.
    """
    shaft, first = machine.crankshaft, machine.cylinders[0]
    lean = machine.lean_of(first)
    if shaft is None or lean is None or not shaft.flywheel_mass:
        return Vector(0.0, 0.0)
    inclination = lean + cylinder.bank_angle - first.bank_angle
    return weight_in_throw(shaft.flywheel_mass * GRAVITY, angle, inclination)


def norm(first: Any, second: Any) -> Any:
    """Return √(x² + y²); a jet that vanishes gets the slope 0, where the root has a kink and no slope."""
    square = first * first + second * second
    if not isinstance(square, Jet):
        return np.sqrt(square) if isinstance(square, np.ndarray) else math.sqrt(square)
    root = np.sqrt(square.value)
    slope = np.divide(square.slope, 2 * root, out=np.zeros_like(root), where=root > 0)
    return Jet(root, slope)


class FreeBody:
    """The crankshaft under the force on its pin and the weight of its flywheel.

    shaft: lengths in m; crank: r in m; pin: whole force on the pin in N; weight: of the flywheel in N, in one frame.
    The torque T r leaves the shaft at the flywheel; nothing is taken off at A.
    """

    def __init__(self, shaft: "Crankshaft", crank: float, pin: Vector, weight: Vector) -> None:
        self.shaft = shaft
        self.crank = crank
        self.pin = pin
        self.weight = weight

    @cached_property
    def A(self) -> Vector:
        """Force on bearing A in N: (F b − G f)/(b − u_A), u_A = −a, overhung a; G: A_p = P b/(a + b)."""
        shaft = self.shaft
        span, f = shaft.span, shaft.flywheel_position
        return Vector(*((F * shaft.b - G * f) / span for F, G in zip(self.pin, self.weight)))

    @cached_property
    def B(self) -> Vector:
        """Force on bearing B in N: (G (b − u_A + f) − F u_A)/(b − u_A)."""
        shaft = self.shaft
        span, f = shaft.span, shaft.flywheel_position
        return Vector(*((G * (span + f) - F * shaft.place_A) / span for F, G in zip(self.pin, self.weight)))

    @cached_property
    def before_pin(self) -> Vector:
        """What stands before the pin, and so is carried through it, in N: the force of bearing A, nothing overhung."""
        share = 0.0 if self.shaft.overhung else 1.0
        return Vector(self.A.D * share, self.A.T * share)

    @cached_property
    def torque(self) -> Any:
        """Torque T r in N m that web B and the shaft beyond it carry."""
        return self.pin.T * self.crank

    def moments_at(self, u: float) -> Vector:
        """Return the moments in N m about the section at u beyond the pin, of what lies before it.

        A (u − u_A) beyond bearing A, less F u beyond the pin; up to B, or to the flywheel where it stands before B.
        G: P e − A_p (a + e), with the other sign.
        """
        arms = max(u - self.shaft.place_A, 0.0), max(u, 0.0)
        return Vector(*(A * arms[0] - F * arms[1] for A, F in zip(self.A, self.pin)))

    @cached_property
    def web_before_pin(self) -> WebLoads:
        """What web A carries, where the pin has one before it."""
        moments, carried = self.moments_at(-self.shaft.web_distance), self.before_pin
        return WebLoads(carried.D, moments.D, abs(carried.T) * self.crank, moments.T)

    @cached_property
    def web_beyond_pin(self) -> WebLoads:
        """What the web between pin and shaft carries, bent out of plane as it is at the worse of its ends."""
        moments = self.moments_at(self.shaft.web_distance)
        at_pin, at_shaft = abs(self.before_pin.T) * self.crank, abs(self.torque)
        bent = where(at_pin - at_shaft >= 0, at_pin, at_shaft)
        return WebLoads(self.force_beyond_pin, moments.D, bent, moments.T)

    @property
    def overhung_moments(self) -> Vector:
        """The moments G f in N m in the middle of bearing B of a flywheel outside of it."""
        outside = max(self.shaft.flywheel_position, 0.0)
        return Vector(self.weight.D * outside, self.weight.T * outside)

    @property
    def force_beyond_pin(self) -> Any:
        """Force in N along the web toward B, compression positive: D − A_D, which is B_D less the flywheel beyond.

        D alone in the web of an overhung crank.
        """
        return self.pin.D - self.before_pin.D


def equilibrium_residual(body: FreeBody, torque: Array) -> float:
    """Return what is left of the sums of forces and of moments over the sizes of their terms, the larger of both.

    torque: M on the shaft in N m (n,), found from the work of the piston force and not from T. The sums are taken in
    space, at the points where the forces stand, about the middle of the pin: nothing of the formulas above is used.
    """
    forces, points = _forces_in_space(body, len(torque))
    moments = np.cross(points, forces)
    resistance = np.zeros_like(moments[:1])
    resistance[0, :, 2] = torque  # the shaft turns about −z: from the pin toward T
    return max(_left_over(forces), _left_over(np.concatenate((moments, resistance))))


def _forces_in_space(body: FreeBody, count: int) -> tuple[Array, Array]:
    """Return the forces (4, n, 3) on the shaft in N, along T, toward the pin and along z, and their points in m."""
    shaft, r = body.shaft, body.crank
    pairs = ((body.pin, 1.0), (body.A, -1.0), (body.B, -1.0), (body.weight, 1.0))
    forces = np.zeros((4, count, 3))
    for row, (force, sign) in enumerate(pairs):
        forces[row, :, 0], forces[row, :, 1] = sign * np.asarray(force.T), -sign * np.asarray(force.D)
    z = (0.0, shaft.place_A, shaft.b, shaft.b + shaft.flywheel_position)
    points = [[0.0, 0.0 if row == 0 else -r, place] for row, place in enumerate(z)]
    return forces, np.asarray(points)[:, None, :]


def _left_over(terms: Array) -> float:
    """Return the largest |sum| over the sum of the sizes, for terms (m, n, 3); 0 where there are none."""
    size = np.linalg.norm(terms, axis=2).sum(axis=0)
    rest = np.linalg.norm(terms.sum(axis=0), axis=1)
    return float(np.divide(rest, size, out=np.zeros_like(rest), where=size > 0).max())
