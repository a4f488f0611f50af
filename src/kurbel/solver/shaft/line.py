"""The throws of a crankshaft along its line, each on two bearings of its own: statically determinate, throw by throw.

    between bearings    1──┐ ┌──2──┐ ┌──3            a, b from every pin to its bearings; the flywheel by the last one
                           └─┘     └─┘
    overhung            ┌──1────────2──┐             at most two throws, at the ends of a shaft with two bearings
                        ┘              └

The shaft counts as hinged in every bearing between two throws, which carries what both of them leave on it. A real
shaft goes on through its bearings; what each of them carries then hangs on how stiff shaft and frame are.
"""

import math
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, NamedTuple

from kurbel.crank_angle import CrankAngle, unit_vector
from kurbel.errors import UsageError
from kurbel.machine import Cylinder, Machine
from kurbel.solver.shaft.statics import FreeBody, Vector, flywheel_weight
from kurbel.solver.shaft.weights import OwnThrow, counterweights_of

if TYPE_CHECKING:
    from kurbel.machine.crankshaft import Crankshaft

_ALIKE = 1e-9
"""Degrees, and metres, by which throws differ by rounding only."""


class Throw(NamedTuple):
    """One throw: the cylinders on its pin by their numbers, from 0; its angle in degrees from the throw of crank 1.

    place: along the shaft in m, 0 where it is not known; A, B: numbers of its bearings, from 0; flywheel: whether its
    weight rests on them; at_A, at_B: mass times radius in kg m of what turns with the shaft, divided between them as by
    a lever, complex: along this throw, and 90° on in the sense of rotation.
    """

    cylinders: tuple[int, ...]
    angle: float
    place: float
    A: int = 0
    B: int = 1
    flywheel: bool = False
    at_A: complex = 0.0
    at_B: complex = 0.0


class ShaftLine:
    """The crankshaft of a machine. throws: in order along the shaft; bearings: how many main bearings there are."""

    def __init__(self, machine: Machine, shaft: "Crankshaft") -> None:
        self.machine = machine
        self.shaft = shaft
        found = sorted(throws_of(machine.cylinders), key=lambda throw: throw.place)
        self.bearings = 2 if shaft.overhung else len(found) + 1
        weights = tuple(_turning(machine, found))
        self.throws = tuple(self._supported(number, found, weights) for number in range(len(found)))

    def _supported(self, number: int, throws: Sequence[Throw], weights: Sequence[tuple[int, complex, float]]) -> Throw:
        """Return a throw with its bearings, and with what turns between them."""
        shaft, throw = self.shaft, throws[number]
        own = [(weight * unit_vector(-throw.angle), place) for owner, weight, place in weights if owner == number]
        # the second throw of an overhung shaft stands at its other end
        mirrored = shaft.overhung and number > 0
        sign = -1.0 if mirrored else 1.0
        return throw._replace(
            A=1 if mirrored else number,
            B=0 if mirrored else number + 1,
            flywheel=number == (0 if shaft.overhung else len(throws) - 1),
            at_A=sum(weight * (shaft.b - sign * u) / shaft.span for weight, u in own),
            at_B=sum(weight * (sign * u - shaft.place_A) / shaft.span for weight, u in own),
        )

    def throw_of(self, cylinder: int) -> Throw:
        """Return the throw on whose pin a cylinder stands, by its number from 0."""
        return next(throw for throw in self.throws if cylinder in throw.cylinders)

    def carried(self, throw: Throw, pin: Vector, own: Cylinder, angle: CrankAngle) -> tuple[Vector, Vector]:
        """Return the forces in N of a throw on its bearings A and B, in its own frame.

        pin: force on its pin in N; own: a cylinder on it, and its own crank angle, for the weight of the flywheel.
        """
        weight = flywheel_weight(self.machine, own, angle) if throw.flywheel else Vector(0.0, 0.0)
        body = FreeBody(self.shaft, own.mechanism.crank, pin, weight)
        omega = 2 * math.pi * (self.machine.speed or 0.0)
        return _pulled(body.A, throw.at_A * omega * omega), _pulled(body.B, throw.at_B * omega * omega)


def shaft_obstacle(machine: Machine) -> str:
    """Return why the loads on the main bearings of a machine cannot be told, or an empty text."""
    if machine.crankshaft is None:
        return "no 'crankshaft' given, which has the lengths of a throw: 'crankshaft: {a: …, b: …, …}'"
    if not machine.cylinders:
        return "no cylinder loads them; 'effort' tells a torque and no force"
    unknown = next((one.mechanism.name for one in machine.cylinders if not one.mechanism.has_rod), None)
    if unknown is not None:
        return f"the force of a {unknown} on the crank pin is not followed to the bearings"
    count = len(throws_of(machine.cylinders))
    if machine.crankshaft.overhung and count > 2:
        return f"{count} throws cannot all be overhung; a shaft has two ends"
    try:
        list(counterweights_of(machine, [OwnThrow(number, one) for number, one in enumerate(machine.cylinders)]))
    except UsageError as error:
        return str(error)
    return ""


def throws_of(cylinders: Sequence[Cylinder]) -> list[Throw]:
    """Return the throws of these cylinders, not yet on their bearings, as the cylinders follow one another.

    Cylinders share a pin where their throws have one angle, γ − β, and one place, and their stroke lines differ.
    """
    found: list[Throw] = []
    for number, one in enumerate(cylinders):
        angle, place = math.fmod(one.bank_angle - one.crank_position, 360.0), one.axial_position or 0.0
        for index, throw in enumerate(found):
            lines = [cylinders[other].bank_angle - one.bank_angle for other in throw.cylinders]
            same = _turn(throw.angle - angle) <= _ALIKE and abs(throw.place - place) <= _ALIKE
            if same and all(_turn(line) > _ALIKE for line in lines):
                found[index] = throw._replace(cylinders=(*throw.cylinders, number))
                break
        else:
            found.append(Throw((number,), angle, place))
    return found


def _turning(machine: Machine, throws: Sequence[Throw]) -> Iterator[tuple[int, complex, float]]:
    """Yield all that turns: the throw between whose bearings it is, mass times radius, and u in m from its pin.

    The masses times radii in kg m are complex, as angles of throws count. A weight stands between the bearings of the
    throw that is nearest to its place; where that is not told, of the throw that it belongs to. What of a rod turns
    pulls at its pin.
    """
    cranks = [OwnThrow(number, one) for number, one in enumerate(machine.cylinders)]
    of_cylinders = {cylinder: number for number, throw in enumerate(throws) for cylinder in throw.cylinders}
    for one in (*(crank.weight(crank.unbalanced) for crank in cranks), *counterweights_of(machine, cranks)):
        place = one.place
        if place is None or place == cranks[one.owner].place:
            yield of_cylinders[one.owner], one.product, 0.0
        else:
            nearest = min(throws, key=lambda throw: abs(throw.place - place))
            yield throws.index(nearest), one.product, place - nearest.place


def _pulled(force: Vector, pull: complex) -> Vector:
    return Vector(force.D - pull.real, force.T + pull.imag)


def _turn(degrees: float) -> float:
    """Return the size of an angle in degrees, whole turns left aside."""
    return abs(math.remainder(degrees, 360.0))
