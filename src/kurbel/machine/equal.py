"""Equal cylinders described at once, and cranks that follow from a firing order."""

from collections.abc import Sequence
from dataclasses import replace
from typing import ClassVar

from kurbel.declared.forms import Count, FiringOrder, Listing, Physical, Record, positive
from kurbel.declared.keys import Described, Key, Keys
from kurbel.declared.kinds import MOST_ITEMS
from kurbel.errors import Fault, Path, refuse, refused
from kurbel.frozen import frozen
from kurbel.machine.cylinder import CYCLES, Cylinder


@frozen
class EqualCylinders(Described):
    """Cylinders that differ in name, crank position and place only.

    cylinders: with bank angle γ in degrees and place along the shaft in m; firing_order: their numbers, from 1; shared:
    every bank has one cylinder, so that all can stand on one crank pin.
    """

    cylinders: tuple[Cylinder, ...]
    firing_order: tuple[int, ...] | None
    shared: bool

    KEYS: ClassVar[Keys] = {
        "count": Key(Count(most=MOST_ITEMS), "Number of cylinders", required=True, example="4"),
        "firing_order": Key(
            FiringOrder(),
            "Order in which they fire, at equal intervals over the cycle",
            absent="that of the machine; where every bank has one cylinder, all stand on one crank pin",
        ),
        "spacing": positive(
            "length", "From one cylinder of a bank to the next along the shaft", absent="free moments left out"
        ),
        "bank_angles": Key(
            Listing(Physical("angle", least=-360, most=360)),
            "Angles of the stroke lines in the sense of rotation: one for each cylinder, or for the cylinders in turn "
            "(1, 2, 1, 2, …)",
            "γ",
            absent="in line",
        ),
        "each": Key(Record("kurbel.machine:Cylinder", inline_too=True), "The keys of one cylinder", required=True),
    }

    @classmethod
    def of_keys(
        cls,
        count: int,
        each: Cylinder,
        firing_order: tuple[int, ...] | None = None,
        spacing: float | None = None,
        bank_angles: tuple[float, ...] = (0.0,),
    ) -> "EqualCylinders":
        """Return the cylinders that these keys of a machine file describe; raises RuleError."""
        if count % len(bank_angles):
            message = f"{len(bank_angles)} angles for {count} cylinders; give one for each bank or for each cylinder"
            refused(message, "bank_angles")
        angles = [bank_angles[index % len(bank_angles)] for index in range(count)]
        places = [None if spacing is None else spacing * angles[:index].count(one) for index, one in enumerate(angles)]
        cylinders = (_standing(each, angle - angles[0], place) for angle, place in zip(angles, places))
        named = tuple(replace(one, name=f"{each.name or 'cylinder'} {i}") for i, one in enumerate(cylinders, 1))
        return cls(named, firing_order, len(set(angles)) == count)

    def standing(self, order: tuple[int, ...] | None, cycle: float) -> tuple[Cylinder, ...]:
        """Return the cylinders with their crank positions; order: of the machine, cycle: in degrees."""
        if order and self.firing_order:
            refused("a firing order also stands in 'cylinders'; leave one of them out", "firing_order")
        if order or self.firing_order:
            where: Path = ("cylinders", "firing_order") if self.firing_order else ("firing_order",)
            return fired(self.cylinders, self.firing_order or order or (), cycle, where)
        if not self.shared:
            message = (
                "'firing_order' is missing: where the cranks stand; write for instance 'firing_order: 1-3-4-2', or "
                "list the cylinders with 'crank_position', each 'like' the first"
            )
            refused(message, "cylinders")
        # on one pin each dead centre follows by the angle between the stroke lines
        return tuple(replace(one, crank_position=one.crank_position + one.bank_angle) for one in self.cylinders)


def _standing(each: Cylinder, bank: float, place: float | None) -> Cylinder:
    """Return a cylinder turned by a bank angle in degrees, at a place along the shaft in m."""
    incline = each.inclination
    if incline is not None:
        incline = (incline + bank + 180.0) % 360.0 - 180.0 if bank else incline
    along = each.axial_position if place is None else place + (each.axial_position or 0.0)
    return replace(each, bank_angle=each.bank_angle + bank, inclination=incline, axial_position=along)


def in_order(
    cylinders: tuple[Cylinder, ...] | EqualCylinders, order: tuple[int, ...] | None, cycle: str
) -> tuple[Cylinder, ...]:
    """Return the cylinders with the crank positions of their firing order; cycle: that of the machine."""
    each = cylinders if isinstance(cylinders, tuple) else cylinders.cylinders
    degrees = 360.0 * max((CYCLES[one.cycle or cycle] for one in each), default=1)
    if isinstance(cylinders, tuple):
        return fired(cylinders, order or (), degrees, ("firing_order",))
    return cylinders.standing(order, degrees)


def fired(cylinders: Sequence[Cylinder], order: tuple[int, ...], cycle: float, where: Path) -> tuple[Cylinder, ...]:
    """Return the cylinders with the crank positions, from cylinder 1, of a firing order over a cycle in degrees.

    Raises RuleError, `where` the order stands, if it does not name each cylinder, and for positions given besides.
    """
    if len(order) != len(cylinders):
        refused(f"it names {len(order)} cylinders, the machine has {len(cylinders)}", *where)
    refuse(
        *(
            Fault(("cylinders", index, "crank_position"), "'firing_order' sets the crank positions; leave it out")
            for index, one in enumerate(cylinders)
            if one.crank_position
        )
    )
    first = order.index(1)
    late = [(order.index(number) - first) % len(order) for number in range(1, len(order) + 1)]
    return tuple(replace(one, crank_position=cycle * turn / len(order)) for one, turn in zip(cylinders, late))
