"""Friction in the pins of a connecting rod and in the journals of its throw.

Where f is given, each rubs with f |F| on its radius r, so that it takes the moment f r |F| and, in a turn by dα, the
work f r |F| dα: the journals turn by dφ, the rod on the crank pin by dφ + dψ, on the crosshead pin by dψ. In each pin
the moment also acts on the rod, as a couple that guide and crank pin carry. The forces F are those without this
friction: what it changes in them is of second order in f, as with the friction circles of the books.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from kurbel import crank_formulas as formulas
from kurbel.machine.crankshaft import Crankshaft
from kurbel.machine.friction import Friction
from kurbel.numerics.arithmetic import some
from kurbel.solver.shaft import ShaftLine, Vector, shaft_obstacle

if TYPE_CHECKING:
    from kurbel.machine import Cylinder, Machine
    from kurbel.solver.state import State


class Rubbing(NamedTuple):
    """Moments of friction in N m; those of both pins on the rod, in the sense of rotation.

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


class PinFriction:
    """The frictions of one cylinder that are given, each as f times the radius in m, 0 where it is not."""

    def __init__(self, machine: Machine, cylinder: Cylinder, friction: Friction) -> None:
        self._machine, self._cylinder = machine, cylinder
        shaft: Crankshaft | None = machine.crankshaft
        self._line = ShaftLine(machine, shaft) if shaft and not shaft_obstacle(machine) else None
        pin, journal = (shaft.pin_diameter, shaft.journal_diameter) if shaft else (None, None)
        self.crank_pin = _arm(friction.crank_pin, friction.crank_pin_diameter, pin)
        self.crosshead_pin = _arm(friction.crosshead_pin, friction.crosshead_pin_diameter)
        self.journals = _arm(friction.journals, friction.journal_diameter, journal)

    def moments(self, state: State) -> Rubbing:
        """Return the moments under the forces of a state without this friction."""
        angle, lam = state.angle, state.drive.mechanism.lam
        _, cos_psi = state.rod_angle or (0.0, 1.0)
        slope = formulas.rod_slope(angle.cos, cos_psi, lam)
        # the rod turns by −dψ: forward where it swings back
        turned = np.mod(state.within, 360.0)
        side = np.where((turned < 90.0) | (turned >= 270.0), 1.0, -1.0)
        return Rubbing(
            _size(on_pin(state)) * self.crank_pin,
            _size(on_crosshead_pin(state)) * (side * self.crosshead_pin),
            sum(_size(force) for force in self._on_journals(state)) * self.journals,
            slope,
        )

    def _on_journals(self, state: State) -> tuple[Vector, ...]:
        """Return the forces of the throw on its bearings; without a crankshaft, that on the pin stands for their sum.

        Of several cylinders each counts by itself, with an equal part of what else loads the bearings of its throw.
        """
        if not some(self.journals != 0) or self._line is None:
            return (on_pin(state),)
        throw = self._line.throw_of([one.name for one in self._machine.cylinders].index(self._cylinder.name))
        count = len(throw.cylinders)
        pin = Vector(*(force * count for force in on_pin(state)))
        found = self._line.carried(throw, pin, self._cylinder, state.angle)
        return tuple(Vector(force.D / count, force.T / count) for force in found)


def on_pin(state: State) -> Vector:
    """Return the force of the rod on the crank pin in N, in the frame of the throw."""
    return Vector(state.D - state.drive.rod_pull, state.T)


def on_crosshead_pin(state: State) -> Vector:
    """Return the force of the crosshead on its pin in N, along as P and across as N, without inertia of the rod.

    Along it is the rod load less friction.
    """
    drive, masses = state.drive, state.drive.cylinder.masses
    of_rod = drive.mass - masses.parts if masses else 0.0
    weight = drive.weight_of(of_rod) or (0.0, 0.0)
    along = state.along_rod + state.b * of_rod if drive.has_inertia else state.along_rod
    return Vector(along - weight[0], state.N - drive.guide_weight + weight[1])


def _size(force: Vector) -> Any:
    return np.hypot(force.D, force.T)


def _arm(coefficient: Any, diameter: Any, otherwise: Any = None) -> Any:
    """Return f times the radius in m, of one diameter or the other; 0 where either f or both are not given."""
    diameter = otherwise if diameter is None else diameter
    return 0.0 if coefficient is None or diameter is None else coefficient * diameter / 2
