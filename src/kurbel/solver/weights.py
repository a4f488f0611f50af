"""What turns with the crank or on balance shafts: the masses of the cylinders, and the weights against them."""

from collections.abc import Iterator, Sequence
from functools import reduce
from typing import NamedTuple

from kurbel.crank_angle import unit_vector
from kurbel.errors import UsageError
from kurbel.machine import Machine
from kurbel.machine.balance import Counterweight, SharedCounterweights
from kurbel.mechanisms import Mechanism
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


class OwnThrow(NamedTuple):
    """The throw of one cylinder with what moves at it, masses in kg.

    number: of the cylinder, from 0; bank, late: γ from the stroke line of cylinder 1, and β, in degrees; arm: the
    crank in m, complex, in its direction at φ = 0. rotating: what turns with the pin, of which unbalanced is that of
    the crank, without its rod; mass: what goes to and fro.
    """

    number: int
    name: str
    mechanism: Mechanism
    counterweights: SharedCounterweights | tuple[Counterweight, ...]
    bank: float
    late: float
    place: float | None
    arm: complex
    rotating: float
    unbalanced: float
    mass: float

    def weight(self, mass: float) -> Weight:
        """Return a mass at the crank pin."""
        return Weight(mass * self.arm, 1, self.place, self.number)


def throws_with_masses(machine: Machine, first: float = 0.0) -> list[OwnThrow]:
    """Return the throws of all cylinders of a machine; first: stroke line from which their directions count."""
    found = []
    for number, one in enumerate(machine.cylinders):
        masses, length, bank, late = one.masses, one.mechanism.rod_length, one.bank_angle - first, one.crank_position
        found.append(
            OwnThrow(
                *(number, one.name, one.mechanism, one.counterweights, bank, late, one.axial_position),
                arm=one.mechanism.crank * unit_vector(bank - late),
                rotating=masses.at_pin(length) if masses else 0.0,
                unbalanced=masses.rotating if masses else 0.0,
                mass=masses.at_crosshead(length) if masses else 0.0,
            )
        )
    return found


def middle_of(machine: Machine) -> float | None:
    """Return from where moments are taken in m: the place given, or the middle of the outer cylinders."""
    places = [one.axial_position for one in machine.cylinders if one.axial_position is not None]
    if machine.moment_reference is not None or not places:
        return machine.moment_reference
    lowest = reduce(lambda one, other: where(other < one, other, one), places)
    highest = reduce(lambda one, other: where(other > one, other, one), places)
    return (lowest + highest) / 2


def wheels_of(machine: Machine) -> tuple[float, ...]:
    """Return the places in m of the counterweights in the wheels of a locomotive; () of another machine."""
    if machine.locomotive is None:
        return ()
    given, half = middle_of(machine), machine.locomotive.wheel_distance / 2
    middle = 0.0 if given is None else given
    return middle - half, middle + half


def counterweights_of(machine: Machine, throws: Sequence[OwnThrow]) -> Iterator[Weight]:
    """Yield the weights on the crank, those of each throw and those of the whole machine.

    Of a locomotive they are in its wheels. Raises UsageError where a place is missing.
    """
    given = [((throw,), throw.counterweights) for throw in throws]
    for owners, weights in (*given, (tuple(throws), machine.counterweights)):
        if isinstance(weights, tuple):
            # an angle counts from the throw; with several throws a weight without a place belongs to none of them
            otherwise = owners[0].place if len(owners) == 1 else None
            for one in weights:
                product = one.product * unit_vector(owners[0].bank - owners[0].late + one.angle)
                place = otherwise if one.axial_position is None else one.axial_position
                yield Weight(product, 1, place, owners[0].number)
            continue
        planes = weights.planes or wheels_of(machine)
        for throw in owners:
            weight = throw.weight(-(throw.rotating + weights.share * throw.mass))
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
