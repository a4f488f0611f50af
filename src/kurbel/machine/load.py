"""A force on the crosshead, ram or rocker: constant, of a spring, or by points over the stroke, of either sign.

Its sign is that of P: positive from the inner toward the outer dead centre, as x and θ rise.
"""

from __future__ import annotations

from collections.abc import Iterator

from kurbel.declared.forms.values import Points, order_faults, size_faults, unit_name
from kurbel.declared.record import Record, Rule, ValuesByKey, alternative, field
from kurbel.declared.units import DiagramPoint, UnitFactor
from kurbel.errors import Fault, refuse
from kurbel.machine.indicator import Card, CardLine
from kurbel.mechanisms import Mechanism

_PARTS = ("constant", "spring", "points")
"""Keys of which a load has one or several; their forces add up."""


class OutputForce(Record):
    """A force on the output in N, positive where its displacement x or θ rises: of a slider-crank toward the shaft.

    lever: of what swings, in m; spring: its rate in N/m; preload: its force at the inner dead centre. profile: the
    force by points as a card on an area of 1 m²: over the stroke from the inner dead centre, and back.
    """

    constant: float = field(
        "force",
        "Constant part, as of a hanging weight; positive where x or θ rises: toward the shaft",
        "F_0",
        default=0.0,
        absent="none",
        example="-20 kN",
    )
    spring: float | None = field(
        "spring_rate",
        "Rate of a spring between output and frame: its force falls with the displacement",
        "k",
        above=0,
        absent="no spring",
    )
    preload: float = field(
        "force",
        "OutputForce of the spring at the inner dead centre, positive where x or θ rises",
        "F_V",
        default=0.0,
        absent="0 N",
        needs="spring",
        example="1 kN",
    )
    _unit = alternative(
        unit_name("force"), "Unit of the forces by points", needs="points", example="kN"
    )
    _points = alternative(
        Points("stroke fraction", "out", "back", ratio=True),
        "Forces while x or θ rises, and while it falls, over the fraction of the stroke from the inner dead centre; "
        "straight between points, two at one fraction are a jump",
        needs="unit",
        example="[[0, 0, 1000], [0.05, 0, 1000], [0.05, 0, 0], [1, 0, 0]]",
    )
    lever: float | None = field(
        "length",
        "Lever at which the force acts on an output that swings, as the horsehead of a pumpjack",
        "l_F",
        above=0,
        absent="needed where the output swings",
    )
    profile: Card | None = None

    @classmethod
    def rules_of_keys(cls, values: ValuesByKey) -> Iterator[Rule]:
        is_empty = not any(key in values for key in _PARTS)
        yield Rule((), is_empty, "no force is given; write 'constant', 'spring' or 'points'")

    @classmethod
    def of_keys(
        cls,
        unit: UnitFactor = (1.0, 1.0),
        points: list[DiagramPoint] | None = None,
        constant: float = 0.0,
        spring: float | None = None,
        preload: float = 0.0,
        lever: float | None = None,
    ) -> OutputForce:
        """Return the load that these keys of a machine file describe; raises RuleError with every fault of its points."""
        profile = None if points is None else _profile(points, unit)
        return cls(constant, spring, preload, lever, profile)

    def rules_on(self, mechanism: Mechanism) -> Iterator[Rule]:
        """Yield whether the load fits the output of a mechanism: with a stroke, and a lever where it swings."""
        message = f"the output of a {mechanism.name} rotates continuously and has no stroke; give a 'moment'"
        yield Rule((), bool(mechanism.turns), message)
        slides = bool(mechanism.slides)
        no_lever = f"the output of a {mechanism.name} slides; a force on it has no lever"
        yield Rule("lever", slides and self.lever is not None, no_lever)
        message = (
            f"the output of a {mechanism.name} swings; give 'lever', the radius at which the force "
            "acts on it, or a 'moment' in the place of the force"
        )
        yield Rule((), not slides and not mechanism.turns and self.lever is None, message)


def _profile(points: list[DiagramPoint], unit: UnitFactor) -> Card:
    """Return the forces over the stroke and back as the two lines of a card, in N for Pa; raises RuleError."""
    refuse(*(fault.below(("points",)) for fault in _point_faults(points, unit)))
    multiplier, divisor = unit
    fractions = tuple(z for z, _, _ in points)
    outward = tuple(out * multiplier / divisor for _, out, _ in points)
    backward = tuple(back * multiplier / divisor for _, _, back in points)
    out_line = CardLine("out", fractions, outward, 0)
    back_line = CardLine("back", fractions[::-1], backward[::-1], 1)
    return Card((out_line, back_line))


def _point_faults(points: list[DiagramPoint], unit: UnitFactor) -> list[Fault]:
    """Return what is wrong with the fractions of points, with their order, or with the size of their forces."""
    fractions = [z for z, _, _ in points]
    for index, z in enumerate(fractions):
        if not 0 <= z <= 1:
            message = f"{z:g} is outside 0 to 1, the fractions of the stroke"
            return [Fault((index,), message)]
    first, last = fractions[0], fractions[-1]
    if (first, last) != (0.0, 1.0):
        message = (
            "the points must run from 0, the inner dead centre, to 1, the outer one; "
            f"they run from {first:g} to {last:g}"
        )
        return [Fault((), message)]

    # the order, then the sizes of both columns
    faults = order_faults(points, "fraction {:g}")
    faults += size_faults([(z, out) for z, out, _ in points], unit, "force")
    for fault in size_faults([(z, back) for z, _, back in points], unit, "force"):
        faults.append(fault._replace(path=(*fault.path[:-1], 2)))
    return faults
