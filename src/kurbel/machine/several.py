"""Several cylinders: equal ones described at once, where their cranks are, and when they fire."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import groupby, product

from kurbel.crank_angle import CYCLES
from kurbel.declared.forms.structures import RecordForm
from kurbel.declared.forms.values import FIRING_ORDER
from kurbel.declared.record import Record, Rule, field
from kurbel.declared.units import MOST_ITEMS
from kurbel.errors import Fault, Path, refuse, refused
from kurbel.machine.cylinder import Cylinder


class EqualCylinders(Record):
    """Cylinders that differ only in name, crank position and place."""

    count: int = field(int, "Number of cylinders", most=MOST_ITEMS, example="4")
    firing_order: tuple[int, ...] | None = field(
        FIRING_ORDER,
        "Order in which they fire, at equal intervals over the cycle",
        absent="that of the machine; if every bank has one cylinder, all share one crank pin",
    )
    crank_positions: tuple[float, ...] | None = field(
        ["angle"],
        "Angles by which the cranks lag crank 1, one for each cylinder, if not given by a firing order; if all are "
        "less than 360 deg, four-stroke cylinders fire with the most even intervals possible",
        absent="from the firing order",
        instead="firing_order",
        example="[0 deg, 120 deg, 240 deg]",
    )
    spacing: float | None = field(
        "length",
        "Distance between neighbouring cylinders of a bank along the shaft, the first of every bank at 0; 0 mm: two "
        "rods at one place; for rods side by side list the cylinders, each with its axial_position",
        least=0,
        absent="unbalanced moments left out",
    )
    bank_angles: tuple[float, ...] = field(
        ["angle"],
        "Angles of the stroke lines in the sense of rotation: one for each cylinder, or for the cylinders in turn "
        "(1, 2, 1, 2, …)",
        "γ",
        default=(0.0,),
        least=-360,
        most=360,
        absent="in line",
    )
    each: Cylinder = field(RecordForm(Cylinder, inline_too=True), "The keys of one cylinder")

    def rules(self) -> Iterator[Rule]:
        positions, banks = self.crank_positions or (), self.bank_angles
        number = f"{len(banks)} angles for {self.count} cylinders; give one for each bank or for each cylinder"
        yield Rule("bank_angles", self.count % len(banks) != 0, number)
        number = f"{len(positions)} angles for {self.count} cylinders; give one for each"
        yield Rule("crank_positions", bool(positions) and len(positions) != self.count, number)
        twice = bool(positions) and self.each.crank_position is not None
        yield Rule(("each", "crank_position"), twice, "'crank_positions' sets it; leave it out")

    @property
    def cylinders(self) -> tuple[Cylinder, ...]:
        """Each with its name and its place; its crank position if that is given."""
        each, angles = self.each, self.bank_angles * (self.count // len(self.bank_angles))
        cylinders = []
        for index, angle in enumerate(angles):
            bank, incline, along = angle - angles[0], each.inclination, each.axial_position
            if bank and incline is not None:
                incline = (incline + bank + 180.0) % 360.0 - 180.0
            if self.spacing is not None:
                along = self.spacing * angles[:index].count(angle) + (along or 0.0)
            cylinders.append(
                replace(
                    each,
                    name=f"{each.name or 'cylinder'} {index + 1}",
                    crank_position=self.crank_positions[index]
                    if self.crank_positions
                    else each.crank_position,
                    bank_angle=each.bank_angle + bank,
                    inclination=incline,
                    axial_position=along,
                )
            )
        return tuple(cylinders)


def in_order(
    cylinders: tuple[Cylinder, ...] | EqualCylinders, order: tuple[int, ...] | None, cycle: str
) -> tuple[Cylinder, ...]:
    """Return the cylinders with their crank positions, those of the firing order if there is one.

    order, cycle: those of the machine.
    """
    if isinstance(cylinders, tuple):
        if order:
            return fired(cylinders, order, cycle, ("firing_order",))
        free = [cylinder.crank_position is None for cylinder in cylinders]
        at_pins = [
            replace(one, crank_position=0.0) if alone else one
            for one, alone in zip(cylinders, free)
        ]
        return in_even_turns(at_pins, free, cycle)
    equal, each = cylinders, cylinders.cylinders
    if order and (equal.firing_order or equal.crank_positions):
        given = "crank positions are" if equal.crank_positions else "a firing order is"
        refused(f"{given} also given in 'cylinders'; leave one of them out", "firing_order")
    if order or equal.firing_order:
        where: Path = ("cylinders", "firing_order") if equal.firing_order else ("firing_order",)
        return fired(each, equal.firing_order or order or (), cycle, where)
    if equal.crank_positions:
        only_pins = all(0 <= angle < 360 for angle in equal.crank_positions)
        return in_even_turns(each, [only_pins] * equal.count, cycle)
    if len(set(equal.bank_angles)) < equal.count:
        message = (
            "'firing_order' is missing: positions of the cranks; write for instance 'firing_order: 1-3-4-2', or "
            "'crank_positions', one for each cylinder"
        )
        refused(message, "cylinders")
    # on one pin each dead centre follows by the angle between the stroke lines
    on_pin = [
        replace(one, crank_position=(one.crank_position or 0.0) + one.bank_angle) for one in each
    ]
    return in_even_turns(on_pin, [True] * equal.count, cycle)


def fired(
    cylinders: Sequence[Cylinder], order: tuple[int, ...], cycle: str, where: Path
) -> tuple[Cylinder, ...]:
    """Return the cylinders with the crank positions, from cylinder 1, of a firing order.

    cycle: that of the machine; where: the place of the order, for errors. Raises RuleError if it does not name each
    cylinder once, and if crank positions are given, too.
    """
    if len(order) != len(cylinders):
        refused(f"it names {len(order)} cylinders, the machine has {len(cylinders)}", *where)
    given = [
        ("cylinders", index, "crank_position")
        for index, one in enumerate(cylinders)
        if one.crank_position
    ]
    refuse(
        *(Fault(place, "'firing_order' sets the crank positions; leave it out") for place in given)
    )
    longest = 360.0 * max(CYCLES[cylinder.cycle or cycle] for cylinder in cylinders)
    late = [
        (order.index(number) - order.index(1)) % len(order) for number in range(1, len(order) + 1)
    ]
    return tuple(
        replace(one, crank_position=longest * turn / len(order))
        for one, turn in zip(cylinders, late)
    )


_TOGETHER = 12
"""Cylinders of which all combinations of turns are compared; of more, those of one crank pin after another."""
_ON_A_PIN = 9
"""Cylinders that are compared together where there are more: a row of a large radial engine."""


def in_even_turns(
    cylinders: Sequence[Cylinder], free: Sequence[bool], cycle: str
) -> tuple[Cylinder, ...]:
    """Return the cylinders, each free one firing in that turn of its four-stroke cycle which is most even.

    The sum of the squared firing intervals is the least one; among equals the firing order reads smallest. Cylinder 1
    stays in its turn. free: whose crank positions tell no turn; cycle: that of the machine.
    """
    firing = [place for place, one in enumerate(cylinders) if CYCLES[one.cycle or cycle] == 2]
    choosing = [place for place in firing if free[place] and place > 0]
    angles = {place: cylinders[place].crank_position for place in firing}
    fixed = {place: angle for place, angle in angles.items() if place not in choosing}
    for pin in (
        _pins(cylinders, choosing) if len(firing) > _TOGETHER else [choosing] if choosing else []
    ):
        turns = product(*((angles[place], angles[place] + 360.0) for place in pin))
        fixed = min(({**fixed, **dict(zip(pin, chosen))} for chosen in turns), key=_unevenness)
    return tuple(
        replace(one, crank_position=fixed[place]) if place in choosing else one
        for place, one in enumerate(cylinders)
    )


def _pins(cylinders: Sequence[Cylinder], places: Sequence[int]) -> list[list[int]]:
    """Return the places in the list of the cylinders that share a crank pin, pin by pin along the shaft."""
    pins = {}
    for place in places:
        one = cylinders[place]
        turned = round((one.bank_angle - one.crank_position) % 360.0, 6) % 360.0
        pins[place] = one.axial_position or 0.0, turned
    along = sorted(places, key=lambda place: pins[place][0])
    each = [list(group) for _, group in groupby(along, lambda place: pins[place])]
    return [
        one[start : start + _ON_A_PIN] for one in each for start in range(0, len(one), _ON_A_PIN)
    ]


def _unevenness(angles: Mapping[int, float]) -> tuple[float, list[int]]:
    """Return the sum of the squared firing intervals, and the cylinders in the order in which they fire."""
    # rounded, since equal sums may differ by rounding
    squares = round(sum(interval * interval for interval in intervals(angles.values(), 720.0)), 6)
    first = angles[min(angles)]
    return squares, sorted(
        angles, key=lambda place: (rounded_within_cycle(angles[place] - first, 720.0), place)
    )


def rounded_within_cycle(angle: float, cycle: float) -> float:
    """Return an angle of the cycle, in degrees."""
    return round(angle % cycle, 9) % cycle


def intervals(angles: Iterable[float], cycle: float) -> list[float]:
    """Return the angles from one firing to the next over a cycle, all in degrees.

    >>> intervals([450, 0], 720)
    [450.0, 270.0]
    """
    found = sorted(rounded_within_cycle(angle, cycle) for angle in angles)
    return [
        float(round(after - one, 9)) for one, after in zip(found, (*found[1:], found[0] + cycle))
    ]
