"""Several cylinders: equal ones described at once, where their cranks are, and when they fire."""

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from itertools import groupby, product
from typing import Any

from kurbel.crank_angle import CYCLES
from kurbel.declared.forms.structures import RecordForm
from kurbel.declared.forms.values import FIRING_ORDER
from kurbel.declared.record import Record, Rule, field
from kurbel.declared.units import MOST_ITEMS
from kurbel.errors import Fault, Path, refuse, refused
from kurbel.machine.cylinder import Cylinder, crank_lag, names_of, pin_lag
from kurbel.numerics.arithmetic import where as choose


class EqualCylinders(Record):
    """Cylinders that differ only in name, crank position and place."""

    count: int = field(int, "Number of cylinders", most=MOST_ITEMS, example="4")
    firing_order: tuple[int, ...] | None = field(
        FIRING_ORDER,
        "Order in which they fire, at equal intervals over the cycle",
        absent="that of the machine; if every bank has one cylinder, all share one crank pin",
        also=("firing", "ignition_order", "zuendfolge"),
    )
    crank_positions: tuple[float, ...] | None = field(
        ["angle"],
        "Angles by which the cranks lag crank 1, one for each cylinder, if not given by a firing order; if all are "
        "less than 360 deg, four-stroke cylinders fire with the most even intervals possible",
        absent="from the firing order",
        instead="firing_order",
        example="[0 deg, 120 deg, 240 deg]",
    )
    throw_angles: tuple[float, ...] | None = field(
        ["angle"],
        "Angles by which the crank pins, as the shaft is built, lag the first: one for each throw along the shaft, "
        "which has one cylinder of every bank, or one for each cylinder, of split pins; a `firing_order` beside them "
        "only gives the turns in which four-stroke cylinders fire",
        absent="from the firing order or the crank positions",
        instead="crank_positions",
        example="[0 deg, 120 deg, 240 deg]",
        also=("throws", "throw_angle", "split_pin", "split_pins", "pin_angles", "crank_pins"),
    )
    spacing: float | None = field(
        "length",
        "Distance between neighbouring throws along the shaft, and so of the cylinders of a bank, the first at 0; "
        "0 mm: all rods at one place",
        least=0,
        absent="unbalanced moments left out",
    )
    bank_offset: float = field(
        "length",
        "Distance along the shaft from each cylinder to the next one of the same throw, in the next bank; negative "
        "where that one is set back",
        default=0.0,
        absent="0 mm",
        needs="spacing",
        also=("rod_offset", "bank_stagger", "stagger"),
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
        banks = len(self.bank_angles)
        fits = self.count % banks == 0
        advice = f"{banks} angles for {self.count} cylinders; give one for each bank or for each cylinder"
        yield Rule("bank_angles", not fits, advice)

        positions = len(self.crank_positions or ())
        fits = positions in (0, self.count)
        advice = f"{positions} angles for {self.count} cylinders; give one for each"
        yield Rule("crank_positions", not fits, advice)

        is_set_twice = positions > 0 and self.each.crank_position is not None
        advice = "'crank_positions' sets it; leave it out"
        yield Rule(("each", "crank_position"), is_set_twice, advice)
        yield from self._throw_rules()

    def _throw_rules(self) -> Iterator[Rule]:
        """Yield the rules on the throws: one angle for each throw or cylinder, and nothing beside them."""
        angles = len(self.throw_angles or ())
        banks = len(set(self.bank_angles))
        throws = self._throws_along_the_shaft
        advice = f"{angles} angles for {self.count} cylinders"
        if throws in (None, self.count):
            advice += f"; give {self.count}, one for each"
        else:
            advice += f" in {banks} banks; give {throws}, one for each throw, or {self.count}"
        yield Rule("throw_angles", angles not in (0, throws, self.count), advice)

        is_set_twice = angles > 0 and self.each.crank_position is not None
        advice = "'throw_angles' sets it; leave it out"
        yield Rule(("each", "crank_position"), is_set_twice, advice)

        link_rod = self.each.link_rod
        advice = "of equal cylinders the first one of every throw has the master rod; leave it out"
        names_master = link_rod is not None and bool(link_rod.master)
        yield Rule(("each", "link_rod", "master"), names_master, advice)

        advice = "equal cylinders have 'throw_angles' beside 'count', one for each throw"
        yield Rule(("each", "throw_angle"), self.each.throw_angle is not None, advice)

    @property
    def _bank_of_each(self) -> tuple[float, ...]:
        """The bank angle of every cylinder."""
        return self.bank_angles * (self.count // len(self.bank_angles))

    @property
    def _throws_along_the_shaft(self) -> int | None:
        """How many throws there are if each has one cylinder of every bank; None where banks are not alike."""
        angles = self._bank_of_each
        sizes = {angles.count(angle) for angle in angles}
        if len(sizes) != 1:
            return None
        return sizes.pop()

    def _master_of(self, index: int, throw: int) -> int:
        """Return the index of the first cylinder on the throw of a cylinder."""
        angles = self._bank_of_each
        for other in range(index + 1):
            if angles[:other].count(angles[other]) == throw:
                return other
        return index

    @property
    def cylinders(self) -> tuple[Cylinder, ...]:
        """Each with its name and its place; its crank position or throw if that is given."""
        angles = self._bank_of_each
        banks = list(dict.fromkeys(angles))
        cylinders = []
        for index, angle in enumerate(angles):
            # the same bank angle occurs once for each cylinder of the bank before this one
            throw = angles[:index].count(angle)
            cylinders.append(self._cylinder(index, angle - angles[0], throw, banks.index(angle)))
        return tuple(cylinders)

    def _cylinder(self, index: int, bank_angle: float, throw: int, bank: int) -> Cylinder:
        """Return a cylinder; bank_angle: against the first bank; throw, bank: numbers from 0."""
        pattern = self.each
        crank_position = pattern.crank_position
        if self.crank_positions:
            crank_position = self.crank_positions[index]
        throw_angle = None
        if self.throw_angles:
            number = index if len(self.throw_angles) == self.count else throw
            throw_angle = self.throw_angles[number] - self.throw_angles[0]
        link_rod = pattern.link_rod
        if link_rod is not None:
            # the first cylinder of every throw has the master rod
            master = f"{pattern.name or 'cylinder'} {self._master_of(index, throw) + 1}"
            link_rod = replace(link_rod, master=master) if bank else None
        inclination = pattern.inclination
        if bank_angle and inclination is not None:
            inclination = (inclination + bank_angle + 180.0) % 360.0 - 180.0
        axial_position = pattern.axial_position
        if self.spacing is not None:
            along_the_shaft = self.spacing * throw + self.bank_offset * bank
            axial_position = along_the_shaft + (axial_position or 0.0)
        return replace(
            pattern,
            name=f"{pattern.name or 'cylinder'} {index + 1}",
            crank_position=crank_position,
            throw_angle=throw_angle,
            link_rod=link_rod,
            bank_angle=pattern.bank_angle + bank_angle,
            inclination=inclination,
            axial_position=axial_position,
        )


def in_order(
    cylinders: tuple[Cylinder, ...] | EqualCylinders, order: tuple[int, ...] | None, cycle: str
) -> tuple[Cylinder, ...]:
    """Return the cylinders with their crank positions, those of the firing order if there is one.

    order, cycle: those of the machine.
    """
    if isinstance(cylinders, EqualCylinders):
        return _equal_in_order(cylinders, order, cycle)
    if any(cylinder.link_rod for cylinder in cylinders):
        return _linked_in_order(cylinders, order, cycle, ("firing_order",))
    if any(cylinder.throw_angle is not None for cylinder in cylinders):
        return on_throws(cylinders, order, cycle, ("firing_order",))
    if order:
        return fired(cylinders, order, cycle, ("firing_order",))
    is_free = [cylinder.crank_position is None for cylinder in cylinders]
    at_pins = []
    for cylinder in cylinders:
        if cylinder.crank_position is None:
            cylinder = replace(cylinder, crank_position=0.0)
        at_pins.append(cylinder)
    return in_even_turns(at_pins, is_free, cycle)


def _equal_in_order(
    equal: EqualCylinders, order: tuple[int, ...] | None, cycle: str
) -> tuple[Cylinder, ...]:
    """Return equal cylinders with their crank positions: by a firing order, as given, or all on one pin."""
    if order and (equal.firing_order or equal.crank_positions):
        what = "crank positions are" if equal.crank_positions else "a firing order is"
        refused(f"{what} also given in 'cylinders'; leave one of them out", "firing_order")
    if equal.each.link_rod:
        where = ("cylinders", "firing_order") if equal.firing_order else ("firing_order",)
        return _linked_in_order(equal.cylinders, equal.firing_order or order, cycle, where)
    if equal.throw_angles:
        where = ("cylinders", "firing_order") if equal.firing_order else ("firing_order",)
        return on_throws(equal.cylinders, equal.firing_order or order, cycle, where)
    if equal.firing_order:
        return fired(equal.cylinders, equal.firing_order, cycle, ("cylinders", "firing_order"))
    if order:
        return fired(equal.cylinders, order, cycle, ("firing_order",))
    if equal.crank_positions:
        # angles of less than a turn give the pins, and not the turn of the cycle
        only_pins = all(0 <= angle < 360 for angle in equal.crank_positions)
        return in_even_turns(equal.cylinders, [only_pins] * equal.count, cycle)
    if len(set(equal.bank_angles)) < equal.count:
        message = (
            "'firing_order' is missing: positions of the cranks; write for instance 'firing_order: 1-3-4-2', or "
            "'crank_positions', one for each cylinder"
        )
        refused(message, "cylinders")

    # on one pin each dead centre follows by the angle between the stroke lines
    on_pin = []
    for cylinder in equal.cylinders:
        position = (cylinder.crank_position or 0.0) + cylinder.bank_angle
        on_pin.append(replace(cylinder, crank_position=position))
    return in_even_turns(on_pin, [True] * equal.count, cycle)


def fired(
    cylinders: Sequence[Cylinder], order: tuple[int, ...], cycle: str, where: Path
) -> tuple[Cylinder, ...]:
    """Return the cylinders with the crank positions, from cylinder 1, of a firing order.

    cycle: that of the machine; where: the place of the order, for errors. Raises RuleError if it does not name each
    cylinder once, and if crank positions are given, too.
    """
    count = len(cylinders)
    _refuse_other_count(order, count, where)
    advice = "'firing_order' sets the crank positions; leave it out"
    refuse(
        *(
            Fault(("cylinders", index, "crank_position"), advice)
            for index, cylinder in enumerate(cylinders)
            if cylinder.crank_position
        )
    )
    longest_cycle = 360.0 * max(CYCLES[cylinder.cycle or cycle] for cylinder in cylinders)
    first = order.index(1)
    in_place = []
    for number, cylinder in enumerate(cylinders, 1):
        intervals_after_first = (order.index(number) - first) % count
        position = longest_cycle * intervals_after_first / count
        in_place.append(replace(cylinder, crank_position=position))
    return tuple(in_place)


def _refuse_other_count(order: tuple[int, ...], count: int, where: Path) -> None:
    """Raise RuleError for a firing order that does not name each of so many cylinders once."""
    if len(order) != count:
        refused(f"it names {len(order)} cylinders, the machine has {count}", *where)


_WHOLE_TURN = 1e-9
"""Degrees short of a whole turn that rounding explains."""


def on_throws(
    cylinders: Sequence[Cylinder], order: tuple[int, ...] | None, cycle: str, where: Path
) -> tuple[Cylinder, ...]:
    """Return the cylinders with the crank positions that follow from their throws.

    β = ζ + γ − φ_i,1 + φ_i, and in a four-stroke cycle the turn: that of a firing order, or the most even one. A
    cylinder without a throw keeps its crank position. cycle: that of the machine; where: the place of the order, for
    errors. Raises RuleError for an order in which these throws cannot fire.
    """
    first = cylinders[0]
    on_pins = []
    is_free = []
    for cylinder in cylinders:
        is_free.append(cylinder.crank_position is None)
        position = 0.0 if cylinder.crank_position is None else cylinder.crank_position
        if cylinder.throw_angle is not None:
            # crank_lag of a dead centre at β = 0 is φ_i,1 − φ_i
            lead = crank_lag(replace(cylinder, crank_position=0.0), first)
            bank_angle = cylinder.bank_angle - first.bank_angle
            position = (cylinder.throw_angle + bank_angle - lead) % 360.0
            position = choose(position > 360.0 - _WHOLE_TURN, 0.0, position)
        on_pins.append(replace(cylinder, crank_position=position))
    if order is None:
        return in_even_turns(on_pins, is_free, cycle)

    _refuse_other_count(order, len(cylinders), where)
    refuse(*_without_throw(cylinders))
    fired_in_turns = _in_turns_of_order(on_pins, order, cycle)
    if _firing_sequence(fired_in_turns, order, cycle) != list(order):
        even = in_even_turns(on_pins, is_free, cycle)
        best = "-".join(map(str, _firing_sequence(even, order, cycle)))
        message = f"these throws cannot fire in this order; the most even order on them is {best}"
        refused(message, *where)
    return fired_in_turns


def _linked_in_order(
    cylinders: Sequence[Cylinder], order: tuple[int, ...] | None, cycle: str, where: Path
) -> tuple[Cylinder, ...]:
    """Return cylinders of which some have link rods, on the pins of their masters; see `on_throws`."""
    linked = _with_links()(cylinders)
    first = linked[0]
    on_pins: list[Cylinder] = []
    throw_angles: dict[str, float | None] = {}
    for name, cylinder in zip(names_of(linked), linked):
        if cylinder.link_rod:
            # on the pin of its master, from which its dead centre follows
            throw_angle = throw_angles[cylinder.link_rod.master]
            keys: dict[str, Any] = {"throw_angle": throw_angle, "crank_position": None}
            cylinder = replace(cylinder, **keys)
        else:
            has_order = order is not None
            cylinder = replace(cylinder, throw_angle=_throw_angle(cylinder, first, has_order))
        throw_angles.setdefault(name, cylinder.throw_angle)
        on_pins.append(cylinder)
    return on_throws(on_pins, order, cycle, where)


def _with_links() -> Callable[[Sequence[Cylinder]], tuple[Cylinder, ...]]:
    from kurbel.machine.linked import with_links

    return with_links


def _throw_angle(cylinder: Cylinder, first: Cylinder, has_order: bool) -> float | None:
    """Return the throw angle in degrees of a cylinder beside link rods; None where its pin follows from the firing order alone."""
    if cylinder.throw_angle is not None:
        return cylinder.throw_angle
    if cylinder.crank_position is not None:
        return pin_lag(cylinder, first)
    if cylinder is not first and has_order:
        return None
    # where no pin is given, that of cylinder 1
    return 0.0


def _without_throw(cylinders: Sequence[Cylinder]) -> Iterator[Fault]:
    """Yield a fault for each cylinder but the first that names no throw, where others do, beside a firing order."""
    advice = "'firing_order' needs the 'throw_angle' of this cylinder, too, or of none"
    for index, cylinder in enumerate(cylinders):
        if index > 0 and cylinder.throw_angle is None:
            yield Fault(("cylinders", index), advice)


def _in_turns_of_order(
    cylinders: Sequence[Cylinder], order: tuple[int, ...], cycle: str
) -> tuple[Cylinder, ...]:
    """Return the cylinders, four-stroke ones in the turn that is nearest to even intervals in this order."""
    count = len(cylinders)
    first = order.index(1)
    in_turns = []
    for number, cylinder in enumerate(cylinders, 1):
        position = cylinder.crank_position
        even_position = 720.0 * ((order.index(number) - first) % count) / count
        is_nearer_later = abs(position + 360.0 - even_position) < abs(position - even_position)
        if CYCLES[cylinder.cycle or cycle] == 2 and is_nearer_later:
            cylinder = replace(cylinder, crank_position=position + 360.0)
        in_turns.append(cylinder)
    return tuple(in_turns)


def _firing_sequence(
    cylinders: Sequence[Cylinder], order: tuple[int, ...], cycle: str
) -> list[int]:
    """Return the numbers of the cylinders as they fire, begun as the order; what fires at once stays in its order."""
    longest_cycle = 360.0 * max(CYCLES[cylinder.cycle or cycle] for cylinder in cylinders)
    first = order.index(1)
    from_first = [*order[first:], *order[:first]]

    def fires_at(number: int) -> float:
        position = cylinders[number - 1].crank_position - cylinders[0].crank_position
        return rounded_within_cycle(position, longest_cycle)

    sequence = sorted(from_first, key=fires_at)
    return [*sequence[len(order) - first :], *sequence[: len(order) - first]]


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
    four_stroke = [
        index for index, cylinder in enumerate(cylinders) if CYCLES[cylinder.cycle or cycle] == 2
    ]
    choosing = [index for index in four_stroke if free[index] and index > 0]
    angles = {index: cylinders[index].crank_position for index in four_stroke}

    # groups are compared one after another, in each all combinations of turns
    groups = [choosing] if choosing else []
    if len(four_stroke) > _TOGETHER:
        groups = _pins(cylinders, choosing)
    chosen = {index: angle for index, angle in angles.items() if index not in choosing}
    for group in groups:
        turns = product(*((angles[index], angles[index] + 360.0) for index in group))
        candidates = ({**chosen, **dict(zip(group, angles_of_turn))} for angles_of_turn in turns)
        chosen = min(candidates, key=_unevenness)

    in_turns = list(cylinders)
    for index in choosing:
        in_turns[index] = replace(cylinders[index], crank_position=chosen[index])
    return tuple(in_turns)


def _pins(cylinders: Sequence[Cylinder], numbers: Sequence[int]) -> list[list[int]]:
    """Return the indices of the cylinders that share a crank pin, pin by pin along the shaft."""
    pins = {}
    for index in numbers:
        cylinder = cylinders[index]
        pin_angle = round((cylinder.bank_angle - cylinder.crank_position) % 360.0, 6) % 360.0
        pins[index] = cylinder.axial_position or 0.0, pin_angle
    along_the_shaft = sorted(numbers, key=lambda index: pins[index][0])
    groups = []
    for _, on_pin in groupby(along_the_shaft, lambda index: pins[index]):
        indices = list(on_pin)
        for start in range(0, len(indices), _ON_A_PIN):
            groups.append(indices[start : start + _ON_A_PIN])
    return groups


def _unevenness(angles: Mapping[int, float]) -> tuple[float, list[int]]:
    """Return the sum of the squared firing intervals, and the cylinders in the order in which they fire."""
    # rounded, since equal sums may differ by rounding
    squares = round(sum(interval * interval for interval in intervals(angles.values(), 720.0)), 6)
    first = angles[min(angles)]

    def firing(index: int) -> tuple[float, int]:
        return rounded_within_cycle(angles[index] - first, 720.0), index

    return squares, sorted(angles, key=firing)


def rounded_within_cycle(angle: float, cycle: float) -> float:
    """Return an angle of the cycle, in degrees."""
    return round(angle % cycle, 9) % cycle


def intervals(angles: Iterable[float], cycle: float) -> list[float]:
    """Return the angles from one firing to the next over a cycle, all in degrees.

    >>> intervals([450, 0], 720)
    [450.0, 270.0]
    """
    firings = sorted(rounded_within_cycle(angle, cycle) for angle in angles)
    following = [*firings[1:], firings[0] + cycle]
    return [float(round(next_angle - angle, 9)) for angle, next_angle in zip(firings, following)]
