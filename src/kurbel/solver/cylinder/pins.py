"""Friction in the pins of a connecting rod and in the journals of its throw.

Where f is given, each rubs with f |F| on its radius r, so that it takes the moment f r |F| and, in a turn by dα, the
work f r |F| dα: the journals turn by dφ, the rod on the crank pin by dφ + dψ, on the crosshead pin by dψ. In each pin
the moment also acts on the rod, as a couple that guide and crank pin carry. The forces F are those without this
friction: what it changes in them is of second order in f, as with the friction circles of the books.
"""

import math
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from kurbel import crank_formulas as formulas
from kurbel.arrays import Array
from kurbel.mechanisms import fan
from kurbel.numerics.grid import Grid
from kurbel.numerics.jet import Jet
from kurbel.numerics.search import Sampled, curves
from kurbel.solver.shaft import ShaftLine, Vector, shaft_obstacle

if TYPE_CHECKING:
    from kurbel.solver.cylinder.drive import Drive
    from kurbel.solver.cylinder.state import State


class Rubbing(NamedTuple):
    """Moments of friction in N m, each (n,) or a jet; those of both pins on the rod, in the sense of rotation.

    slope: dψ/dφ, by which the rod turns back.
    """

    at_crank: Any
    at_crosshead: Any
    journals: Any
    slope: Any

    @property
    def couple(self) -> Any:
        """Couple of both pins on the rod."""
        return self.at_crank + self.at_crosshead

    @property
    def by_couple(self) -> Any:
        """What the couple takes of the torque of the force on the crank pin."""
        return self.couple * self.slope

    @property
    def crank_pin(self) -> Any:
        """What the crank pin takes of the torque, as the next two do."""
        return self.at_crank * (1 + self.slope)

    @property
    def crosshead_pin(self) -> Any:
        """What the crosshead pin takes."""
        return self.at_crosshead * self.slope

    @property
    def lost(self) -> Any:
        """What all of them take."""
        return self.crank_pin + self.crosshead_pin + self.journals


_NEAR = 0.5
"""Radians off the real axis beyond which a pole is no matter to a piece of 36°."""


class PinFriction:
    """The frictions of one cylinder that are given, each as f times the radius in m, 0 where it is not."""

    def __init__(self, drive: "Drive") -> None:
        friction, shaft = drive.cylinder.friction, drive.machine.crankshaft
        assert friction is not None
        self._drive = drive
        self._line = ShaftLine(drive.machine, shaft) if shaft and not shaft_obstacle(drive.machine) else None
        pin, journal = (shaft.pin_diameter, shaft.journal_diameter) if shaft else (None, None)
        self.crank_pin = _arm(friction.crank_pin, friction.crank_pin_diameter or pin)
        self.crosshead_pin = _arm(friction.crosshead_pin, friction.crosshead_pin_diameter)
        self.journals = _arm(friction.journals, friction.journal_diameter or journal)

    def _forces(self, degrees: Array, within: Array) -> list[tuple[Sampled, Sampled]]:
        """Return the forces in N that rub, by their components, at crank angles (n,)."""
        state = self._drive.jets_at(degrees, within).unrubbed
        forces = (
            *((on_pin(state),) if self.crank_pin else ()),
            *((on_crosshead_pin(state),) if self.crosshead_pin else ()),
            *(self._on_journals(state) if self.journals else ()),
        )
        return [(Sampled.of(force.D, degrees.shape), Sampled.of(force.T, degrees.shape)) for force in forces]

    def bends(self, grid: Grid) -> Array:
        """Return crank angles (n,) in degrees at which the size of a force that rubs bends."""
        return bends_of_size(grid, self._forces)

    def moments(self, state: "State") -> Rubbing:
        """Return the moments under the forces of a state without this friction."""
        drive, angle = state.drive, state.angle
        _, cos_psi = drive.mechanism.rod_angle(angle) or (0.0, 1.0)
        slope = formulas.rod_slope(angle.cos, cos_psi, drive.mechanism.lam)
        # the rod turns by −dψ: forward where it swings back
        side = np.where(state.inside.angle.cos >= 0, 1.0, -1.0)
        return Rubbing(
            norm(*on_pin(state)) * self.crank_pin,
            norm(*on_crosshead_pin(state)) * (side * self.crosshead_pin),
            sum(norm(*force) for force in self._on_journals(state)) * self.journals,
            slope,
        )

    def _on_journals(self, state: "State") -> tuple[Vector, ...]:
        """Return the forces of the throw on its bearings; without a crankshaft, that on the pin stands for their sum.

        Of several cylinders each counts by itself, with an equal part of what else loads the bearings of its throw.
        """
        if not self.journals or self._line is None:
            return (on_pin(state),)
        cylinders, own = self._drive.machine.cylinders, self._drive.cylinder
        throw = self._line.throw_of(cylinders.index(own))
        count = len(throw.cylinders)
        pin = Vector(*(force * count for force in on_pin(state)))
        found = self._line.carried(throw, pin, own, state.angle)
        return tuple(Vector(force.D / count, force.T / count) for force in found)


def bends_of_size(grid: Grid, forces: Callable[[Array, Array], list[tuple[Sampled, Sampled]]]) -> Array:
    """Return crank angles (n,) in degrees, ever denser toward those at which a force, one of several, all but vanishes.

    Beside the smallest size of F the size √(F·F) has a pole off the real axis, where F + F′ Δφ is square to itself. The
    direction of F has it, too: it turns about within as narrow an angle.

    forces: their components at crank angles (n,) in degrees, on the sides of jumps that hold `within` (n,).
    """

    def squares(degrees: Array, within: Array) -> dict[str, Sampled]:
        return {str(number): _square(*force) for number, force in enumerate(forces(degrees, within))}

    found: list[float] = []
    for number, curve in enumerate(curves(grid, squares(grid.degrees, grid.within), squares).values()):
        degrees, within = curve.peaks
        (x, dx), (y, dy) = forces(degrees, within)[number]
        with np.errstate(all="ignore"):
            beside = np.hypot(x, y) / np.hypot(dx, dy)
        for one in np.flatnonzero(beside < _NEAR).tolist():
            found += (float(degrees[one]), *fan(float(degrees[one]), math.degrees(beside[one])))
    return np.asarray(np.mod(found, grid.breaks[-1]))


def norm(first: Any, second: Any) -> Any:
    """Return √(x² + y²); a jet that vanishes gets the slope 0, where the root has a kink and no slope."""
    square = first * first + second * second
    if not isinstance(square, Jet):
        return np.sqrt(square) if isinstance(square, np.ndarray) else math.sqrt(square)
    root = np.sqrt(square.value)
    slope = np.divide(square.slope, 2 * root, out=np.zeros_like(root), where=root > 0)
    return Jet(root, slope)


def on_pin(state: "State") -> Vector:
    """Return the force of the rod on the crank pin in N, in the frame of the throw."""
    return Vector(state.D - state.drive.rod_pull, state.T)


def on_crosshead_pin(state: "State") -> Vector:
    """Return the force of the crosshead on its pin in N, along as P and across as N, without inertia of the rod.

    Along it is the rod load less friction.
    """
    drive, masses = state.drive, state.drive.cylinder.masses
    of_rod = drive.mass - masses.parts if masses else 0.0
    weight = drive.weight_of(of_rod) or (0.0, 0.0)
    along = state.along_rod + state.b * of_rod if drive.has_inertia else state.along_rod
    return Vector(along - weight[0], state.N - drive.guide_weight + weight[1])


def _square(x: Sampled, y: Sampled) -> Sampled:
    return Sampled(x.value * x.value + y.value * y.value, 2 * (x.value * x.slope + y.value * y.slope))


def _arm(coefficient: float | None, diameter: float | None) -> float:
    return coefficient * diameter / 2 if coefficient and diameter else 0.0
