"""Free bodies of the throws of a crankshaft: bearing forces, and internal forces and moments.

                      F = (D, T)
                          │
                    ┌─────┴─────┐          r   crank radius
             web A  │           │  web B   e   from the middle of the pin to the middle of a web
                    │           │
    ──A─────────────┘           └─────────────B──────── G    flywheel, f outside of B
      |←────── a ──────→|←─────── b ─────────→|←── f ──→|

A force is D + iT in the frame that turns with the throw: D from the pin toward the shaft, T in the sense of rotation.
u is the coordinate along the shaft from the middle of the pin. A and B are the forces of the shaft on the bearings, so
that a load D on a pin between them gives A_D and B_D of the same sign. In an overhung crank bearing A is at u = +a,
between its only web and bearing B.

    between bearings    1──┐ ┌──2──┐ ┌──3            a, b from every pin to its bearings; the flywheel by the last one
                           └─┘     └─┘
    overhung            ┌──1────────2──┐             at most two throws, at the ends of a shaft with two bearings
                        ┘              └

Several throws are made statically determinate by a hinge in each bearing between two throws, which carries the forces
of both. A real shaft is continuous over its bearings; their loads then depend on the stiffness of shaft and frame.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np

from kurbel.arrays import Array, Indices, Number, Truth
from kurbel.crank_angle import CrankAngle, unit_vector
from kurbel.declared.units import GRAVITY
from kurbel.errors import UsageError
from kurbel.machine import Cylinder, Machine
from kurbel.machine.crankshaft import Counterweight, Crankshaft, SharedCounterweights
from kurbel.machine.cylinder import crank_lag, pin_lag
from kurbel.numerics.arithmetic import magnitude, some, where
from kurbel.solver.vector import Force

_ALIKE = 1e-9
"""Degrees, and metres, by which throws differ by rounding only."""


# one throw


def weight_in_throw(weight: float, angle: CrankAngle, inclination: float) -> Force:
    """Return a weight on the shaft in the frame of the throw: D = G sin(φ + i), T = −G cos(φ + i).

    weight: G in N; angle: crank angles φ (n,); inclination: i of the stroke line in degrees, 0 horizontal, 90 cylinder
    above the shaft. The shaft turns so that an engine which drives presses the crosshead down: with a horizontal stroke
    line the pin rises on the outstroke, and in the inner dead centre the weight is square to the throw (G).

    >>> weight_in_throw(100.0, CrankAngle.of(0.0), 0.0)
    -100j
    >>> weight_in_throw(100.0, CrankAngle.of(0.0), 90.0).real
    100.0
    """
    incline = CrankAngle.of(inclination)
    return -1j * weight * (angle.cos + 1j * angle.sin) * (incline.cos + 1j * incline.sin)


def flywheel_weight(machine: Machine, cylinder: Cylinder, angle: CrankAngle) -> Force:
    """Return the weight of the flywheel in the frame of a cylinder's throw; nothing where its direction is not known.

    angle: crank angles φ (n,) of that cylinder; the inclination given is that of the stroke line of cylinder 1.
    """
    shaft, first = machine.crankshaft, machine.cylinders[0]
    lean = machine.inclination_of(first)
    if shaft is None or lean is None or not some(shaft.flywheel_mass != 0):
        return 0.0
    inclination = lean + cylinder.bank_angle - first.bank_angle
    return weight_in_throw(shaft.flywheel_mass * GRAVITY, angle, inclination)


class FreeBody:
    """One throw under the forces of the rods on its pin and the weight of the flywheel, with the torque that enters it.

    shaft: lengths in m; crank: r in m; rods: force of each in N, in one frame, from bearing A toward B, at the places
    of `Crankshaft.rod_places`; weight: of the flywheel in N; torque_A: M_A in N m in journal A, from the throws before
    this one, None where there is none. The torque leaves at bearing B.

    pin: sum of the rods' forces; A, B: forces on the bearings in N,

        A = (Σ F_k (b − u_k) − G f)/(b − u_A)        u_A = −a, overhung a; G: A_p = P b/(a + b)

    before_pin: shear force in N in the shaft before the pin, the force on bearing A; 0 for an overhung crank.
    along_web: force along the web toward B, compression positive: D − A_D, that is B_D less the flywheel weight;
    D in the web of an overhung crank. torque_pin, torque_B: M_p = M_A + A_T r in the pin, M_B = M_A + T r behind it; of
    the part before a cut through the pin the bearing's force −A_T acts r inward of the pin's axis.
    """

    def __init__(
        self,
        shaft: Crankshaft,
        crank: Number,
        rods: Sequence[Force],
        weight: Force,
        torque_A: Number | None = None,
    ) -> None:
        self.shaft, self.crank, self.weight, self.torque_A = shaft, crank, weight, torque_A
        self.rods = list(zip(rods, shaft.rod_places(len(rods))))
        self.pin = sum(rods[1:], start=rods[0])
        b, f, span = shaft.b, shaft.flywheel_position, shaft.span
        of_A = [force * (b - u) for force, u in self.rods]
        of_B = [force * (shaft.place_A - u) for force, u in self.rods]
        self.A = (sum(of_A[1:], start=of_A[0]) - weight * f) / span
        self.B = (weight * (span + f) - sum(of_B[1:], start=of_B[0])) / span
        self.before_pin = 0 * self.A if shaft.overhung else self.A
        self.along_web = (self.pin - self.before_pin).real
        entering: Number = 0.0 if torque_A is None else torque_A
        self.torque_pin = entering + self.before_pin.imag * crank
        self.torque_B = entering + self.pin.imag * crank

    def moments_at(self, u: Number) -> Force:
        """Return the bending moments in N m at the section u, of the forces before it: D and T of each times its arm.

        A ⟨u − u_A⟩ − Σ F_k ⟨u − u_k⟩ with ⟨x⟩ = max(x, 0), valid up to B, or to a flywheel before B. The opposite sign
        of G, P e − A_p (a + e).
        """
        moments = self.A * _at_least_0(u - self.shaft.place_A)
        for force, u_rod in self.rods:
            moments = moments - force * _at_least_0(u - u_rod)
        return moments

    def equilibrium_residual(self, torque: Array) -> Array:
        """Return the relative residual of the equilibrium of forces and of moments, the larger of both.

        torque: M_B − M_A in N m, shaped as the forces (…), from the work of the piston forces and not from T. Moments
        are about the middle of the pin, of the forces where they act; the formulas above are not used.
        """
        shaft = self.shaft
        forces = [*(force for force, _ in self.rods), -self.A, -self.B, self.weight + 0 * self.A]
        arms = [
            *(u for _, u in self.rods),
            shaft.place_A,
            shaft.b,
            shaft.b + shaft.flywheel_position,
        ]
        bends = [force * arm for force, arm in zip(forces, arms)]
        twists = [
            torque,
            *(force.imag * self.crank for force in forces[len(self.rods) :]),
        ]  # the pin's have no arm
        size_of_forces = sum(np.abs(force) for force in forces)
        size_of_moments = sum(np.abs(moment) for moment in [*bends, *twists])
        left_of_forces = np.abs(sum(forces))
        left_of_moments = np.hypot(np.abs(sum(bends)), sum(twists))
        return np.maximum(
            _share(left_of_forces, size_of_forces), _share(left_of_moments, size_of_moments)
        )


def _at_least_0(arm: Number) -> Number:
    return where(arm > 0, arm, 0.0)


def _share(left: Array, size: Array) -> Array:
    """Return what is left over the size of the terms; 0 where there is none."""
    return np.where(size > 0, left / np.where(size > 0, size, 1.0), 0.0)


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
    at_A: Force = 0.0
    at_B: Force = 0.0


class SupportedShaft:
    """The crankshaft of a machine. throws: in order along the shaft; bearings: how many main bearings there are.

    Raises UsageError for many machines whose throws are not alike.
    """

    def __init__(self, machine: Machine) -> None:
        assert machine.crankshaft is not None
        self.machine, self.shaft = machine, machine.crankshaft
        throws = throws_of(machine.cylinders)
        throws.sort(key=lambda throw: float(np.ravel(throw.place)[0]))
        for throw, following in pairwise(throws):
            _decided(throw.place <= following.place)

        # on their bearings; the second throw of an overhung shaft is at its other end
        overhung = self.shaft.overhung
        at_flywheel = 0 if overhung else len(throws) - 1
        for number, throw in enumerate(throws):
            A, B = (1, 0) if overhung and number else (number, number + 1)
            throws[number] = throw._replace(A=A, B=B, flywheel=number == at_flywheel)

        # what turns with the throws pulls at both bearings
        for number, product, beside in self._turning(throws):
            throw = throws[number]
            pull = product * unit_vector(-throw.angle)
            u = beside if throw.A < throw.B else -beside
            at_B = pull * (u - self.shaft.place_A) / self.shaft.span
            throws[number] = throw._replace(at_A=throw.at_A + pull - at_B, at_B=throw.at_B + at_B)
        self.throws = tuple(throws)
        self.bearings = 2 if overhung else len(throws) + 1

    def _turning(self, throws: Sequence[Throw]) -> Iterator[tuple[int, Force, Number]]:
        """Yield of each rotating weight the index of the throw whose bearings carry it, mass times radius, and u in m.

        The masses times radii in kg m are complex, as angles of throws count. A weight is between the bearings of the
        throw that is nearest to it; where its place is not known, of the throw that it belongs to. The rotating part of
        a rod is not included: its force acts on the pin.
        """
        cranks = throws_with_masses(self.machine)
        weights = [crank.weight(crank.unbalanced) for crank in cranks]
        weights += counterweights_of(self.machine, cranks)
        for weight in weights:
            if _is_at(weight, cranks[weight.owner].place):
                for number, throw in enumerate(throws):
                    if weight.owner in throw.cylinders:
                        yield number, weight.product, 0.0
                        break
            else:
                distances = [np.asarray(abs(throw.place - weight.place)) for throw in throws]
                nearest = int(_decided(np.argmin(np.broadcast_arrays(*distances), axis=0)))
                yield nearest, weight.product, weight.place - throws[nearest].place

    def throw_of(self, cylinder: int) -> Throw:
        """Return the throw on whose pin a cylinder is, by its number from 0."""
        return next(throw for throw in self.throws if cylinder in throw.cylinders)

    def reactions(
        self, throw: Throw, rods: Sequence[Force], cylinder: Cylinder, angle: CrankAngle
    ) -> tuple[Force, Force]:
        """Return the forces in N of a throw on its bearings A and B, in its own frame.

        rods: forces on its pin in N, as its cylinders follow one another; cylinder: one of them, with its own crank
        angle, for the weight of the flywheel.
        """
        weight = flywheel_weight(self.machine, cylinder, angle) if throw.flywheel else 0.0
        if any(self.machine.cylinders[index].link_rod for index in throw.cylinders):
            # link rods push through the big end of their master rod
            rods = [sum(rods)]
        body = FreeBody(self.shaft, cylinder.mechanism.crank, rods, weight)
        omega = 0.0 if self.machine.speed is None else 2 * math.pi * self.machine.speed
        # what turns pulls outward, against D
        A = body.A - np.conj(throw.at_A) * omega * omega
        B = body.B - np.conj(throw.at_B) * omega * omega
        return A, B


def strength_obstacle(machine: Machine) -> str:
    """Return why the strength of the crankshaft of a machine cannot be examined, or an empty text."""
    if machine.strength_obstacle or len(machine.cylinders) == 1:
        return machine.strength_obstacle
    return shaft_obstacle(machine)


def shaft_obstacle(machine: Machine) -> str:
    """Return why the loads on the main bearings of a machine cannot be given, or an empty text."""
    if machine.crankshaft is None:
        return (
            "no 'crankshaft' given, which has the lengths of a throw: 'crankshaft: {a: …, b: …, …}'"
        )
    if not machine.cylinders:
        return "no cylinder loads them; 'effort' gives a torque and no force"
    unknown = next(
        (
            cylinder.mechanism.name
            for cylinder in machine.cylinders
            if not cylinder.mechanism.has_rod
        ),
        None,
    )
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


def throws_of(cylinders: Sequence[Cylinder]) -> list[Throw]:
    """Return the throws of these cylinders, not yet on their bearings, as the cylinders follow one another.

    Cylinders share a pin where their throws have one angle, γ − δ, and one place, and their stroke lines differ.
    """
    throws: list[Throw] = []
    for number, cylinder in enumerate(cylinders):
        angle = _remainder(-pin_lag(cylinder, cylinders[0]))
        position = 0.0 if cylinder.axial_position is None else cylinder.axial_position
        for index, throw in enumerate(throws):
            banks = [cylinders[other].bank_angle for other in throw.cylinders]
            if _shares_pin(throw, angle, position, cylinder.bank_angle, banks):
                throws[index] = throw._replace(cylinders=(*throw.cylinders, number))
                break
        else:
            throws.append(Throw((number,), angle, position))
    return throws


def _shares_pin(
    throw: Throw, angle: Number, position: Number, bank: Number, banks: Iterable[Number]
) -> bool:
    """Return whether a cylinder is on the pin of a throw; banks: stroke lines of those that are on it already."""
    same = magnitude(_remainder(throw.angle - angle)) <= _ALIKE
    same = same & (magnitude(throw.place - position) <= _ALIKE)
    for other_bank in banks:
        same = same & (magnitude(_remainder(other_bank - bank)) > _ALIKE)
    return bool(_decided(same))


def _is_at(weight: Weight, position: Number | None) -> bool:
    """Return whether a weight is where its throw is, or anywhere."""
    if weight.place is None or weight.place is position:
        return True
    return position is not None and bool(_decided(weight.place == position))


def _decided(condition: Truth | Indices) -> bool | int:
    """Return what is so in every machine. Raises UsageError where it differs: such machines are computed one by one."""
    of_machines = np.ravel(condition)
    if (of_machines != of_machines[0]).any():
        raise UsageError("the throws of these machines are not alike")
    return of_machines[0]


def _remainder(degrees: Number) -> Number:
    """Return an angle in degrees without whole turns, from −180 to 180."""
    return degrees - 360.0 * np.rint(degrees / 360.0)


# rotating and reciprocating masses of the throws, and the weights on crank, wheels and balance shafts against them


class Weight(NamedTuple):
    """A weight that turns at `order` times the speed of the crank, against it where that is negative.

    product: mass times radius in kg m, complex, in its direction at φ = 0; place: position along the shaft in m, None
    if unknown; owner: index of the cylinder to whose throw it belongs, 0 for a weight of the whole machine.
    """

    product: Any
    order: int
    place: Any
    owner: int = 0


class CylinderThrow(NamedTuple):
    """The throw of one cylinder with its moving masses in kg.

    number: of the cylinder, from 0; place: along the shaft in m; bank: γ from the stroke line of cylinder 1 in degrees;
    lag: δ of its crank angle in degrees; arm: the crank in m, complex, in its direction at φ = 0; rotating: mass that
    turns with the pin; unbalanced: that of the crank among it, without the rod; mass: reciprocating;
    knuckle_mass: of a link rod at its knuckle pin.
    """

    number: int
    name: str
    cylinder: Cylinder
    place: Any
    bank: Number
    lag: Number
    arm: Any
    rotating: Number
    unbalanced: Number
    mass: Number
    knuckle_mass: Number = 0.0

    def weight(self, mass: Number) -> Weight:
        """Return a mass at the crank pin."""
        return Weight(mass * self.arm, 1, self.place, self.number)


def throws_with_masses(machine: Machine) -> list[CylinderThrow]:
    """Return the throws of all cylinders of a machine; directions count from the stroke line of cylinder 1."""
    throws = []
    first = machine.cylinders[0].bank_angle if machine.cylinders else 0.0
    for number, cylinder in enumerate(machine.cylinders):
        masses, length = cylinder.masses, cylinder.mechanism.rod_length
        bank = cylinder.bank_angle - first
        lag = crank_lag(cylinder, machine.cylinders[0])
        arm = cylinder.mechanism.crank * unit_vector(bank - lag)
        throw = CylinderThrow(
            number,
            cylinder.name,
            cylinder,
            cylinder.axial_position,
            bank,
            lag,
            arm,
            masses.at_pin(length) if masses else 0.0,
            masses.rotating if masses else 0.0,
            masses.at_crosshead(length) if masses else 0.0,
            cylinder.link_rod.knuckle_mass if cylinder.link_rod else 0.0,
        )
        throws.append(throw)
    return throws


def middle_of(machine: Machine) -> Any:
    """Return the reference plane of moments in m: the one given, or midway between the outer cylinders."""
    positions = []
    for cylinder in machine.cylinders:
        if cylinder.axial_position is not None:
            positions.append(cylinder.axial_position)
    if machine.moment_reference is not None or not positions:
        return machine.moment_reference
    of_machines = np.broadcast_arrays(*positions)
    middle = (np.min(of_machines, axis=0) + np.max(of_machines, axis=0)) / 2
    if np.ndim(middle):
        return middle
    return float(middle)


def wheels_of(machine: Machine) -> tuple[Any, ...]:
    """Return the places in m of the counterweights in the wheels of a locomotive; () of another machine."""
    if machine.locomotive is None:
        return ()
    reference = middle_of(machine)
    middle = 0.0 if reference is None else reference
    half = machine.locomotive.wheel_distance / 2
    return middle - half, middle + half


def counterweights_of(machine: Machine, throws: Sequence[CylinderThrow]) -> Iterator[Weight]:
    """Yield the weights on the crank, those of each throw and those of the whole machine.

    Of a locomotive they are in its wheels. Raises UsageError where a place is missing.
    """
    for throw in throws:
        yield from _weights_of(machine, [throw], throw.cylinder.counterweights)
    yield from _weights_of(machine, throws, machine.counterweights)


def _weights_of(
    machine: Machine,
    owners: Sequence[CylinderThrow],
    counterweights: SharedCounterweights | tuple[Counterweight, ...],
) -> Iterator[Weight]:
    """Yield the weights of these throws: given one by one, or as a share of the masses that they balance."""
    if isinstance(counterweights, tuple):
        # an angle counts from the throw; with several throws a weight without a place belongs to none of them
        otherwise = owners[0].place if len(owners) == 1 else None
        for counterweight in counterweights:
            angle = owners[0].bank - owners[0].lag + counterweight.angle
            position = counterweight.axial_position
            yield Weight(
                counterweight.product * unit_vector(angle),
                1,
                otherwise if position is None else position,
                owners[0].number,
            )
        return
    planes = counterweights.planes or wheels_of(machine)
    for throw in owners:
        # the mass at a knuckle pin counts as on the crank pin
        on_pin = throw.rotating + throw.knuckle_mass
        weight = throw.weight(-(on_pin + counterweights.share * throw.mass))
        if not planes:
            yield weight
        elif throw.cylinder.masses:
            yield from split_by_lever(weight, planes, throw.name)


def split_by_lever(weight: Weight, planes: tuple[Any, ...], owner: str) -> tuple[Weight, Weight]:
    """Return two weights in these planes with the force and the moment of one.

    Raises UsageError, naming its owner, where its axial position is not known.
    """
    if weight.place is None:
        raise UsageError(
            f"{owner}: weights in two planes need its 'axial_position', or 'spacing' of equal cylinders"
        )
    first, second = planes
    share = (weight.place - first) / (second - first)
    return (
        weight._replace(product=weight.product * (1 - share), place=first),
        weight._replace(product=weight.product * share, place=second),
    )
