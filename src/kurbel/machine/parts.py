"""The parts of a cylinder: moving masses, friction, resistance, a point of the rod, the piston."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from kurbel.arrays import Number
from kurbel.declared.forms.structures import Listing, OneOf, RecordForm
from kurbel.declared.forms.values import Choice, NumberForm
from kurbel.declared.keys import Key
from kurbel.declared.record import Record, Rule, ValuesByKey, alternative, field, first_of
from kurbel.declared.units import KINDS
from kurbel.machine.indicator import Chamber, Indicator
from kurbel.mechanisms import Mechanism
from kurbel.numerics.arithmetic import total

if TYPE_CHECKING:
    from kurbel.machine.crankshaft import Crankshaft
    from kurbel.machine.drawn_gas import Gas


class ConnectingRod(Record):
    """The connecting rod and how it moves: by the share that reciprocates or, exactly, as the rigid body that it is."""

    mass: float = field("mass", "Mass of the rod", least=0)
    share: float = field(
        "ratio",
        "Reciprocating share of the mass",
        default=0.5,
        least=0,
        most=1,
        absent="1/2",
        example="1/2",
        usual="1/2 to 2/3 (R p. 608)",
    )
    center_of_gravity: float | None = field(
        "length",
        "Distance of its centre of gravity from the crosshead pin",
        "a",
        least=0,
        instead="share",
        needs="inertia",
        or_else="it is the distance a from the crosshead pin; where the moment of inertia is not known, write the "
        "reciprocating share 1 − a/L as 'share' in its place",
    )
    inertia: float | None = field(
        "inertia",
        "Moment of inertia about the centre of gravity",
        "I_r",
        least=0,
        needs="center_of_gravity",
    )

    @property
    def exact(self) -> bool:
        """Whether the rod is described by centre of gravity and moment of inertia."""
        return self.center_of_gravity is not None

    def at_crosshead(self, length: float) -> float:
        """Reciprocating mass in kg: the share, or m (1 − a/L) with the length L of the rod in m."""
        share = self.share
        if self.center_of_gravity is not None:
            share = 1 - self.center_of_gravity / length
        return self.mass * share

    def at_pin(self, length: float) -> float:
        """Mass in kg that turns with the crank pin: what the share leaves, or m a/L with the length L in m."""
        return self.mass - self.at_crosshead(length)

    def excess_inertia(self, length: float) -> float:
        """I_r − m a (L − a) in kg m²: what the two masses have too little of; for an exact rod of length L in m.

        >>> round(ConnectingRod(2.0, center_of_gravity=0.1, inertia=0.0242).excess_inertia(0.25) * 23000, 1)
        -133.4
        """
        assert self.center_of_gravity is not None
        assert self.inertia is not None
        a = self.center_of_gravity
        return self.inertia - self.mass * a * (length - a)


def _part(text: str) -> Key:
    """Return the key of a reciprocating part: a mass, or a list of masses."""
    mass = NumberForm("mass", least=0)
    return alternative(OneOf(mass, Listing(mass)), text, instead="reciprocating")


class Masses(Record):
    """Moving masses in kg: what reciprocates besides the connecting rod, the connecting rod, and what turns.

    parts: the sum of piston, piston rod, crosshead and others; rotating: at the radius of the crank pin, beside what of
    the connecting rod turns with it; crosshead: what of the sum is the crosshead's, None where that is not known;
    undivided: the sum was given as one and includes the connecting rod's share; pistons: the mass of each, where
    `piston` is a list.
    """

    _reciprocating = alternative(
        "mass",
        "Total reciprocating mass, including its share of the connecting rod; instead of the parts",
        "m",
        least=0,
    )
    _piston = _part("Piston, or a list of pistons")
    _piston_rod = _part("Piston rod")
    _crosshead = _part("Crosshead")
    _other = _part("Any other reciprocating mass")
    _connecting_rod = alternative(
        OneOf(NumberForm("mass", least=0), RecordForm(ConnectingRod)),
        "Connecting rod: its mass, half of which counts as reciprocating, or a mapping",
        instead="reciprocating",
        also=("con_rod", "conrod"),
    )

    parts: float = 0.0
    connecting_rod: ConnectingRod | None = None
    rotating: float = field(
        "mass",
        "Unbalanced mass of the crank, reduced to the pin, without the connecting rod",
        "m_rot",
        default=0.0,
        least=0,
    )
    crosshead: float | None = None
    undivided: bool = False
    pistons: tuple[float, ...] = ()

    @classmethod
    def rules_of_keys(cls, values: ValuesByKey) -> Iterator[Rule]:
        message = (
            "no mass is given; leave 'masses' out or give 'reciprocating', "
            "or 'piston', 'crosshead', …"
        )
        yield Rule((), not values, message)

    @classmethod
    def of_keys(
        cls,
        connecting_rod: float | ConnectingRod | None = None,
        rotating: float = 0.0,
        **parts: Any,
    ) -> Masses:
        """Return the masses of these keys; each part is a mass or a tuple of masses."""
        sums = {}
        for name, mass in parts.items():
            sums[name] = total(*mass) if isinstance(mass, tuple) else mass
        if connecting_rod is not None and not isinstance(connecting_rod, ConnectingRod):
            connecting_rod = ConnectingRod(connecting_rod)
        piston = parts.get("piston")
        return cls(
            parts=total(*sums.values()),
            connecting_rod=connecting_rod,
            rotating=rotating,
            crosshead=sums.get("crosshead"),
            undivided="reciprocating" in sums,
            pistons=piston if isinstance(piston, tuple) else (),
        )

    def at_pin(self, rod_length: float) -> float:
        """Mass in kg that turns with the crank pin, with the share of a connecting rod of this length in m."""
        if self.connecting_rod is None:
            return self.rotating
        return self.rotating + self.connecting_rod.at_pin(rod_length)

    def at_crosshead(self, rod_length: float) -> float:
        """Reciprocating mass m in kg (R 298): all parts, and the share of a connecting rod of this length in m."""
        if self.connecting_rod is None:
            return self.parts
        return self.parts + self.connecting_rod.at_crosshead(rod_length)


class GasOnRings(Record):
    """Rings that the gas presses on the wall (Redtenbacher): in proportion to the pressure difference."""

    gas: float = field(
        "ratio",
        "Pressure on the wall over the difference across the piston",
        "k",
        least=0,
        example="0.5",
    )


class Rings(Record):
    """Piston rings."""

    count: int = field(int, "Number of rings", least=1)
    height: float = field("length", "Height of one ring along the bore", "h", above=0)
    pressure: float | GasOnRings = field(
        OneOf(Choice(("gas",)), NumberForm("pressure", least=0), RecordForm(GasOnRings)),
        "Pressure of the ring on the wall; `gas` or `{gas: k}`: k times the pressure difference across the piston",
        "p_r",
        gives=lambda values: {"pressure": GasOnRings(1.0)} if values["pressure"] == "gas" else {},
    )
    coefficient: float = field("ratio", "Coefficient of friction", "f", least=0)


class Guide(Record):
    """The shoe with which a crosshead presses on its guide."""

    length: float = field("length", "Length of the shoe along the stroke", above=0)
    width: float = field("length", "Width of the shoe", above=0)


_PINS: dict[str, tuple[str, str]] = {
    "crank_pin": ("crank_pin_diameter", "pin_diameter"),
    "crosshead_pin": ("crosshead_pin_diameter", ""),
    "journals": ("journal_diameter", "journal_diameter"),
}
"""Where pins and journals rub: the keys of their diameters here, and in `crankshaft`."""


class Friction(Record):
    """Friction of the moving parts of a cylinder; what is None is left out."""

    crosshead: float | None = field(
        "ratio",
        "Coefficient of friction of the crosshead on its guide",
        "f",
        least=0,
        usual="1/10 in Redtenbacher's example (D 7)",
    )
    rings: Rings | None = field(Rings, "Piston rings")
    constant: float | None = field(
        "force",
        "Force opposing the motion, constant over the stroke",
        "F_0",
        least=0,
        example="500 N",
    )
    guide: Guide | None = field(Guide, "Shoe of the crosshead", needs="crosshead")
    crank_pin: float | None = field(
        "ratio",
        "Coefficient of friction of the connecting rod on the crank pin",
        "f_Z",
        least=0,
        example="0.02",
    )
    crank_pin_diameter: float | None = field(
        "length",
        "Diameter of the crank pin",
        "d_z",
        above=0,
        absent="that of `crankshaft`",
        needs="crank_pin",
    )
    crosshead_pin: float | None = field(
        "ratio",
        "Coefficient of friction of the connecting rod on the crosshead pin",
        "f_H",
        least=0,
        needs="crosshead_pin_diameter",
        example="0.02",
    )
    crosshead_pin_diameter: float | None = field(
        "length", "Diameter of the crosshead pin", "d_H", above=0, needs="crosshead_pin"
    )
    crosshead_pin_length: float | None = field(
        "length",
        "Length of the crosshead pin",
        "l_H",
        above=0,
        absent="no pressure on it",
        needs="crosshead_pin",
    )
    journals: float | None = field(
        "ratio",
        "Coefficient of friction of the journals in the main bearings",
        "f_j",
        least=0,
        example="0.02",
    )
    journal_diameter: float | None = field(
        "length",
        "Diameter of the journals",
        "d_j",
        above=0,
        absent="that of `crankshaft`",
        needs="journals",
    )
    block: float | None = field(
        "ratio", "Coefficient of friction of the sliding block in a Scotch yoke", "f_b", least=0
    )
    guides: float | None = field(
        "ratio",
        "Coefficient of friction of the two guides of a Scotch yoke, at `guide_length`",
        "f_g",
        least=0,
    )

    def rules(self) -> Iterator[Rule]:
        sliding = (self.crosshead, self.rings, self.constant, self.block, self.guides)
        slides = any(friction is not None for friction in sliding)
        keys = (
            "'crosshead', 'rings', 'constant', 'crank_pin', 'crosshead_pin', "
            "'journals', 'block' or 'guides'"
        )
        message = f"no friction is given; leave 'friction' out or give {keys}"
        yield Rule((), not slides and not self.of_pins, message)

    @property
    def of_pins(self) -> tuple[str, ...]:
        """The keys of the pins and journals whose coefficient is given."""
        coefficients = (self.crank_pin, self.crosshead_pin, self.journals)
        return tuple(
            pin for pin, coefficient in zip(_PINS, coefficients) if coefficient is not None
        )

    def rules_beside(self, shaft: Crankshaft | None, pin_of_yoke: float | None) -> Iterator[Rule]:
        """Yield a diameter that is needed and given nowhere, or given here and in the crankshaft.

        pin_of_yoke: diameter in m of the crank pin that a Scotch yoke gives.
        """
        for pin in self.of_pins:
            key, key_of_shaft = _PINS[pin]
            # a diameter that is given elsewhere
            elsewhere = ""
            if pin == "crank_pin" and pin_of_yoke is not None:
                elsewhere = "'pin_diameter'"
            elif shaft and key_of_shaft and vars(shaft)[key_of_shaft] is not None:
                elsewhere = f"'{key_of_shaft}' in 'crankshaft'"
            has_diameter = vars(self)[key] is not None
            message = f"{elsewhere} gives the same; leave one of them out"
            yield Rule(key, has_diameter and bool(elsewhere), message)
            message = f"'{pin}' needs a diameter: write for instance '{key}: 120 mm'"
            if key_of_shaft:
                message += f", or give '{key_of_shaft}' in 'crankshaft'"
            yield Rule(pin, not has_diameter and not elsewhere, message)


class RamForce(Record):
    """A force on the ram that opposes its motion, or if negative helps, constant on each stroke: cutting out, dragging back."""

    work: float = field(
        "force",
        "Force opposing the motion on the working stroke; negative if it helps",
        "P_a",
        default=0.0,
    )
    back: float = field(
        "force",
        "Force opposing the motion on the return stroke; negative if it helps",
        "P_r",
        default=0.0,
        key="return",
    )

    @classmethod
    def rules_of_keys(cls, values: ValuesByKey) -> Iterator[Rule]:
        message = "give 'work', the force on the working stroke, or 'return', or both"
        yield Rule((), not values, message)


class Moment(RamForce):
    """A moment on a member that swings or turns, opposing its motion; what turns has no return stroke."""

    work: float = field(
        "torque",
        "Moment opposing the motion on the working stroke; negative if it helps",
        "M_a",
        default=0.0,
    )
    back: float = field(
        "torque",
        "Moment opposing the motion on the return stroke; negative if it helps",
        "M_r",
        default=0.0,
        key="return",
    )


class RodPoint(Record):
    """A point along the rod from one of its pins toward the other, or beyond it, and across from its line.

    origin: `crank_pin`, or the other pin as the mechanism calls it; across: positive to the side to which the crank
    pin is at φ = 90°.
    """

    origin: str = field(
        ("crank_pin", "crosshead_pin", "rocker_pin"),
        "Pin from which the distance counts",
        example="crank_pin",
        key="from",
    )
    along: float = field("length", "Distance along the rod, toward its other pin")
    across: float = field(
        "length",
        "Distance from the centre line of the rod, positive toward the side of the outstroke",
        default=0.0,
    )

    def from_crank_pin(self, mechanism: Mechanism) -> float:
        """Return the distance along the rod in m from the crank pin toward the other one."""
        if self.origin == "crank_pin":
            return self.along
        return mechanism.coupler_length - self.along

    def rules_on(self, mechanism: Mechanism) -> Iterator[Rule]:
        """Yield what keeps the point from being one of this mechanism."""
        is_infinite = np.isinf(mechanism.coupler_length)
        message = (
            f"this {mechanism.name} has no connecting rod of a length, of which it were a point"
        )
        yield Rule((), is_infinite, message)
        has_pin = self.origin in ("crank_pin", mechanism.far_pin)
        message = f"the pins of a {mechanism.name} are crank_pin and {mechanism.far_pin}"
        yield Rule("from", np.logical_not(is_infinite) & (not has_pin), message)


def _gas() -> type[Gas]:
    from kurbel.machine.drawn_gas import Gas

    return Gas


_SAME_DISPLACEMENT = 0.005
"""Relative difference of a displacement from that of bore and stroke, through rounded figures."""
_SAME_ENGINE = 0.03
"""The same of that of several cylinders, which is given in litres."""


class Piston(Record):
    """A piston: bore and rods, and what the indicator shows on its two sides.

    lever_ratio: its displacement over that of the crosshead, 1 where both are on one rod; see `TandemPiston`.
    """

    bore: float = field(
        "length",
        "Diameter of the cylinder",
        "d",
        above=0,
        also=("bohrung", "cylinder_diameter", "piston_diameter", "bore_diameter"),
    )
    head_end_rod: float = field(
        "length", "Diameter of the rod through the head end", default=0.0, least=0
    )
    crank_end_rod: float = field(
        "length",
        "Diameter of the rod through the crank end",
        default=0.0,
        least=0,
        also=("piston_rod", "rod_diameter"),
    )
    indicator: Indicator | None = field(
        Indicator,
        "Pressures on the two sides",
        absent="no gas force",
        also=("pressure", "card", "trace"),
    )
    name: str = field(str, "Name of the piston", default="piston", absent="piston")
    gas: Gas | None = field(_gas, "Gas that the piston draws in", absent="that of the machine")
    lever_ratio: float = 1.0
    displacement: float | None = field(
        "volume",
        "Volume that the whole bore sweeps, π/4 d² s, of one cylinder: gives the bore, or with the bore the stroke, and "
        "is compared where both are given",
        "V_s",
        above=0,
        instead="bore",
        compared=True,
        absent="by bore and stroke",
        example="500 cm3",
        also=("hubraum", "capacity", "cubic_capacity", "swept_volume", "engine_displacement"),
    )

    def rules(self) -> Iterator[Rule]:
        message = "{head_end_rod} is no thinner than the bore ({bore})"
        yield Rule("head_end_rod", self.head_end_rod >= self.bore, message)
        message = "{crank_end_rod} is no thinner than the bore ({bore})"
        yield Rule("crank_end_rod", self.crank_end_rod >= self.bore, message)

    @property
    def head_area(self) -> float:
        """Effective area at the head end in m²."""
        return math.pi / 4 * (self.bore - self.head_end_rod) * (self.bore + self.head_end_rod)

    @property
    def crank_area(self) -> float:
        """Effective area at the crank end in m²."""
        return math.pi / 4 * (self.bore - self.crank_end_rod) * (self.bore + self.crank_end_rod)

    @property
    def chambers(self) -> dict[str, Chamber]:
        """What the indicator shows, by the key of the end."""
        if self.indicator is None:
            return {}
        ends = {"head_end": self.indicator.head_end, "crank_end": self.indicator.crank_end}
        return {end: chamber for end, chamber in ends.items() if chamber is not None}

    def displacement_rules(self, stroke: float) -> Iterator[Rule]:
        """Yield that the displacement is another one than that of bore and stroke in m."""
        if self.displacement is None:
            return
        # what it gives together with the other one is a length, too
        smallest, largest, *_ = KINDS["length"]
        is_beyond = (self.bore < smallest) | (self.bore > largest)
        is_beyond = is_beyond | (stroke < smallest) | (stroke > 2 * largest)
        sizes = {"bore": self.bore, "stroke": stroke}
        message = "with it the bore is {bore:length}, the stroke {stroke:length}: beyond what a machine may have"
        yield Rule("displacement", is_beyond, message, sizes)
        # V = π/4 d² s
        swept = math.pi / 4 * self.bore**2 * stroke
        ratio = self.displacement / swept
        is_different = np.abs(ratio - 1) > _SAME_DISPLACEMENT
        count = np.round(ratio)
        is_of_several = is_different & (count > 1) & (np.abs(ratio / count - 1) < _SAME_ENGINE)
        numbers = {
            "given": self.displacement,
            "swept": swept,
            "count": count,
            "percent": np.round(np.abs(100 * (ratio - 1)), 2),
        }
        message = (
            "{given:volume} is {count} times what bore and stroke sweep, {swept:volume}; give the "
            "displacement of one cylinder, not of the engine"
        )
        yield Rule("displacement", is_of_several, message, numbers)
        sense = "more" if np.ndim(ratio) == 0 and ratio > 1 else "less"
        message = (
            f"{{given:volume}} is {{percent}} % {sense} than what bore and stroke sweep, "
            "{swept:volume}; correct one of the three, or leave it out"
        )
        yield Rule("displacement", is_different & ~is_of_several, message, numbers)

    def cycle_beside(self, cycle: str) -> str:
        """Return the working cycle of a tandem piston: that of the cylinder, or the two-stroke one of its cards.

        A pump or a compressor works in two strokes, whatever drives it: its cards then run twice in 720°.
        """
        cycles_of_cards = [chamber.cycles for chamber in self.chambers.values()]
        fit = all(cycle in cycles for cycles in cycles_of_cards)
        work_in_two_strokes = all("two-stroke" in cycles for cycles in cycles_of_cards)
        return "two-stroke" if work_in_two_strokes and not fit else cycle

    def indicator_rules(self, cycle: str, ambient: Number) -> Iterator[Rule]:
        """Yield the first thing at each end that does not fit the cycle or the ambient pressure in Pa."""
        is_absolute = self.indicator is not None and self.indicator.absolute
        lift = 0.0 if is_absolute else ambient
        for end, chamber in self.chambers.items():
            for rule in first_of(chamber.rules_in(cycle, lift)):
                yield rule.below("indicator", end)


class TandemPiston(Piston):
    """A further piston on the same rod, or driven from the crosshead by a rocker."""

    lever_ratio: float = field(
        "ratio",
        "Displacement of a pump or air pump by a rocker over that of the crosshead, negative where it moves against it",
        default=1.0,
        least=-100,
        most=100,
        absent="1: on the same rod",
        example="0.5",
    )

    def rules(self) -> Iterator[Rule]:
        yield from super().rules()
        message = "a piston with a lever ratio of 0 does not move"
        yield Rule("lever_ratio", self.lever_ratio == 0, message)
