"""Rotating and reciprocating masses of the throws, and the weights on crank, wheels and balance shafts against them."""

from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np

from kurbel.arrays import Number
from kurbel.crank_angle import unit_vector
from kurbel.errors import UsageError
from kurbel.machine import Cylinder, Machine


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
    arm: the crank in m, complex, in its direction at φ = 0; rotating: mass that turns with the pin; unbalanced: that of
    the crank among it, without the rod; mass: reciprocating.
    """

    number: int
    name: str
    cylinder: Cylinder
    place: Any
    bank: Number
    arm: Any
    rotating: Number
    unbalanced: Number
    mass: Number

    def weight(self, mass: Number) -> Weight:
        """Return a mass at the crank pin."""
        return Weight(mass * self.arm, 1, self.place, self.number)


def throws_with_masses(machine: Machine, first: Number = 0.0) -> list[CylinderThrow]:
    """Return the throws of all cylinders of a machine; first: stroke line from which their directions count."""
    found = []
    for number, one in enumerate(machine.cylinders):
        masses, length, bank = one.masses, one.mechanism.rod_length, one.bank_angle - first
        of_masses = (masses.at_pin(length), masses.rotating, masses.at_crosshead(length)) if masses else (0.0,) * 3
        arm = one.mechanism.crank * unit_vector(bank - one.crank_position)
        found.append(CylinderThrow(number, one.name, one, one.axial_position, bank, arm, *of_masses))
    return found


def middle_of(machine: Machine) -> Any:
    """Return the reference plane of moments in m: the one given, or midway between the outer cylinders."""
    places = [one.axial_position for one in machine.cylinders if one.axial_position is not None]
    if machine.moment_reference is not None or not places:
        return machine.moment_reference
    each = np.broadcast_arrays(*places)
    middle = (np.min(each, axis=0) + np.max(each, axis=0)) / 2
    return middle if np.ndim(middle) else float(middle)


def wheels_of(machine: Machine) -> tuple[Any, ...]:
    """Return the places in m of the counterweights in the wheels of a locomotive; () of another machine."""
    if machine.locomotive is None:
        return ()
    given, half = middle_of(machine), machine.locomotive.wheel_distance / 2
    middle = 0.0 if given is None else given
    return middle - half, middle + half


def counterweights_of(machine: Machine, throws: Sequence[CylinderThrow]) -> Iterator[Weight]:
    """Yield the weights on the crank, those of each throw and those of the whole machine.

    Of a locomotive they are in its wheels. Raises UsageError where a place is missing.
    """
    given = [((throw,), throw.cylinder.counterweights) for throw in throws]
    for owners, weights in (*given, (tuple(throws), machine.counterweights)):
        if not isinstance(weights, tuple):
            planes = weights.planes or wheels_of(machine)
            for throw in owners:
                weight = throw.weight(-(throw.rotating + weights.share * throw.mass))
                yield from split_by_lever(weight, planes, throw.name) if planes else (weight,)
        else:
            # an angle counts from the throw; with several throws a weight without a place belongs to none of them
            otherwise = owners[0].place if len(owners) == 1 else None
            for one in weights:
                product = one.product * unit_vector(owners[0].bank - owners[0].cylinder.crank_position + one.angle)
                place = otherwise if one.axial_position is None else one.axial_position
                yield Weight(product, 1, place, owners[0].number)


def split_by_lever(weight: Weight, planes: tuple[Any, ...], owner: str) -> tuple[Weight, Weight]:
    """Return two weights in these planes with the force and the moment of one.

    Raises UsageError, naming its owner, where its axial position is not known.
    """
    if weight.place is None:
        raise UsageError(f"{owner}: weights in two planes need its 'axial_position', or 'spacing' of equal cylinders")
    first, second = planes
    share = (weight.place - first) / (second - first)
    return (
        weight._replace(product=weight.product * (1 - share), place=first),
        weight._replace(product=weight.product * share, place=second),
    )
