"""What turns with the crank or on balance shafts: the masses of the cylinders, and the weights against them."""

from collections.abc import Iterator, Sequence
from functools import reduce
from typing import NamedTuple

from kurbel.crank_angle import unit_vector
from kurbel.errors import UsageError
from kurbel.machine import Cylinder, Machine
from kurbel.machine.balance import Counterweight, SharedCounterweights
from kurbel.numerics.arithmetic import where


class Weight(NamedTuple):
    """A weight that turns `order` times in a turn of the crank, against it where that is negative.

    product: mass times radius in kg m, with its direction at φ = 0; place: along the shaft in m, None: not known.
    owner: number of the cylinder, from 0, whose throw it belongs to, the first one's if it is of the whole machine.
    """

    product: complex
    order: int
    place: float | None
    owner: int = 0


class OwnThrow:
    """The throw of one cylinder with what moves at it, masses in kg.

    rotating: what turns with the pin, of which unbalanced is that of the crank, without its rod; mass: what goes to and
    fro. number: of the cylinder, from 0; bank, late: γ from the stroke line `first`, and β, in degrees.
    """

    def __init__(self, number: int, cylinder: Cylinder, first: float = 0.0) -> None:
        self.number, self.name, self.mechanism = number, cylinder.name, cylinder.mechanism
        self.counterweights = cylinder.counterweights
        self.bank, self.late, self.place = cylinder.bank_angle - first, cylinder.crank_position, cylinder.axial_position
        masses, length = cylinder.masses, cylinder.mechanism.rod_length
        self.rotating = masses.at_pin(length) if masses else 0.0
        self.unbalanced = masses.rotating if masses else 0.0
        self.mass = masses.at_crosshead(length) if masses else 0.0

    def weight(self, mass: float) -> Weight:
        """Return a mass at the crank pin."""
        product = mass * self.mechanism.crank * unit_vector(self.bank - self.late)
        return Weight(product, 1, self.place, self.number)

    def carrying(self, one: Counterweight, otherwise: float | None) -> Weight:
        """Return a counterweight whose angle counts from this throw; otherwise: its place where none is given."""
        product = one.product * unit_vector(self.bank - self.late + one.angle)
        return Weight(product, 1, otherwise if one.axial_position is None else one.axial_position, self.number)


def middle_of(machine: Machine) -> float | None:
    """Return from where moments are taken in m: the place given, or the middle of the outer cylinders."""
    places = [one.axial_position for one in machine.cylinders if one.axial_position is not None]
    given = machine.moment_reference
    if given is not None or not places:
        return given
    lowest = reduce(lambda one, other: where(other < one, other, one), places)
    highest = reduce(lambda one, other: where(other > one, other, one), places)
    return (lowest + highest) / 2


def wheels_of(machine: Machine) -> tuple[float, ...]:
    """Return the places in m of the counterweights in the wheels of a locomotive; () of another machine."""
    if machine.locomotive is None:
        return ()
    middle, half = middle_of(machine) or 0.0, machine.locomotive.wheel_distance / 2
    return middle - half, middle + half


def counterweights_of(machine: Machine, throws: Sequence[OwnThrow]) -> Iterator[Weight]:
    """Yield the weights on the crank, those of each throw and those of the whole machine.

    Of a locomotive they are in its wheels. Raises UsageError where a place is missing.
    """
    wheels = wheels_of(machine)
    for throw in throws:
        yield from _given((throw,), throw.counterweights, wheels)
    yield from _given(throws, machine.counterweights, wheels)


def _given(
    throws: Sequence[OwnThrow], given: SharedCounterweights | tuple[Counterweight, ...], wheels: tuple[float, ...]
) -> Iterator[Weight]:
    if isinstance(given, tuple):
        # with several throws a weight without a place belongs to none of them
        yield from (throws[0].carrying(one, throws[0].place if len(throws) == 1 else None) for one in given)
        return
    planes = given.planes or wheels
    for throw in throws:
        weight = throw.weight(-(throw.rotating + given.share * throw.mass))
        yield from levered(weight, planes, throw.name) if planes else (weight,)


def levered(weight: Weight, planes: tuple[float, ...], owner: str) -> tuple[Weight, Weight]:
    """Return two weights in these planes that have the force and the moment of one.

    Raises UsageError, in the name of the cylinder that it is of, where its place is not known.
    """
    if weight.place is None:
        raise UsageError(f"{owner}: weights in two planes need its 'axial_position', or 'spacing' of equal cylinders")
    first, second = planes
    share = (weight.place - first) / (second - first)
    return (
        weight._replace(product=weight.product * (1 - share), place=first),
        weight._replace(product=weight.product * share, place=second),
    )


def shafts_of(machine: Machine) -> Iterator[Weight]:
    """Yield the weights of the balance shafts."""
    for one in machine.balance_shafts:
        order = -one.order if one.against else one.order
        yield Weight(one.product * unit_vector(one.angle), order, one.axial_position)
