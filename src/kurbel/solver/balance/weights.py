"""The throws of a machine, and the weights that turn with the crank or on balance shafts."""

from collections.abc import Iterator
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

from kurbel.errors import UsageError
from kurbel.machine import Machine
from kurbel.solver.balance.circles import unit_vectors
from kurbel.solver.cylinder.drive import Drive

if TYPE_CHECKING:
    from kurbel.machine.balance import Counterweight, SharedCounterweights


class Weight(NamedTuple):
    """A weight that turns `order` times in a turn of the crank, against it where that is negative.

    product: mass times radius in kg m, with its direction at φ = 0; place: along the shaft in m, None: not known.
    """

    product: complex
    order: int
    place: float | None


class Throw:
    """A cylinder with its throw; bank, late: γ from the stroke line of cylinder 1, and β, in degrees."""

    def __init__(self, drive: Drive, first_line: float) -> None:
        self.drive = drive
        self.bank = drive.cylinder.bank_angle - first_line
        self.late = drive.cylinder.crank_position
        self.place = drive.cylinder.axial_position
        self.crank = drive.mechanism.crank

    @cached_property
    def rotating(self) -> float:
        """Mass in kg that turns with the crank pin."""
        masses = self.drive.cylinder.masses
        return masses.at_pin(self.drive.mechanism.rod_length) if masses else 0.0

    def weight(self, mass: float) -> Weight:
        """Return a mass at the crank pin."""
        return Weight(mass * self.crank * complex(unit_vectors(self.bank - self.late)), 1, self.place)

    def against(self, share: float) -> Weight:
        """Return the counterweight of what turns, and of a share of what goes to and fro."""
        return self.weight(-(self.rotating + share * self.drive.mass))

    def carrying(self, one: "Counterweight", beside: float | None) -> Weight:
        """Return a counterweight whose angle counts from this throw; beside: its place where none is given."""
        direction = complex(unit_vectors(self.bank - self.late + one.angle))
        return Weight(one.product * direction, 1, beside if one.axial_position is None else one.axial_position)


def counterweights_of(machine: Machine, throws: tuple[Throw, ...], wheels: tuple[float, ...]) -> Iterator[Weight]:
    """Yield the weights on the crank, those of each throw and those of the whole machine.

    wheels: the planes in m in which those of a locomotive stand, or (). Raises UsageError where a place is missing.
    """
    for throw in throws:
        yield from _given((throw,), throw.drive.cylinder.counterweights, wheels)
    yield from _given(throws, machine.counterweights, wheels)


def _given(
    throws: tuple[Throw, ...], given: "SharedCounterweights | tuple[Counterweight, ...]", wheels: tuple[float, ...]
) -> Iterator[Weight]:
    if isinstance(given, tuple):
        # among several throws nobody knows beside which one a weight stands
        yield from (throws[0].carrying(one, throws[0].place if len(throws) == 1 else None) for one in given)
        return
    planes = given.planes or wheels
    for throw in throws:
        weight = throw.against(given.share)
        yield from levered(weight, planes, throw.drive.name) if planes else (weight,)


def levered(weight: Weight, planes: tuple[float, ...], owner: str) -> tuple[Weight, Weight]:
    """Return two weights in these planes that have the force and the moment of one.

    Raises UsageError, in the name of the cylinder that it is of, where its place is not known.
    """
    if weight.place is None:
        raise UsageError(f"{owner}: weights in two planes need its 'axial_position', or 'spacing' of equal cylinders")
    first, second = planes
    share = (weight.place - first) / (second - first)
    return (
        Weight(weight.product * (1 - share), weight.order, first),
        Weight(weight.product * share, weight.order, second),
    )


def shafts_of(machine: Machine) -> Iterator[Weight]:
    """Yield the weights of the balance shafts."""
    for one in machine.balance_shafts:
        order = -one.order if one.against else one.order
        yield Weight(one.product * complex(unit_vectors(one.angle)), order, one.axial_position)
