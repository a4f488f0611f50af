"""What turns with the shaft and works on it: flywheel, load, a turning effort known from elsewhere, a coupling."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar, Literal

from kurbel.crank_angle import CYCLES
from kurbel.declared.forms.structures import OneOf
from kurbel.declared.forms.values import NumberForm, Points, order_faults, size_faults, unit_name
from kurbel.declared.record import Record, Rule, ValuesByKey, alternative, field
from kurbel.declared.units import DiagramPoint, UnitFactor
from kurbel.errors import Fault, refuse, refused
from kurbel.machine.cylinder import MOST_TURNS
from kurbel.numerics.arithmetic import is_whole, some

CAST_IRON = 7250.0
"""Density in kg/m³ of what rims are cast of."""
_HIGHEST = 1000
"""Periods per turn of a harmonic; each is followed, so that more of them take long."""


class Rim(Record):
    """The rim of a flywheel; its width or its mass, with its depth, give its moment of inertia."""

    mean_diameter: float = field("length", "Mean diameter of the rim", "D", above=0, example="3 m")
    _outer_diameter = alternative(
        "length",
        "Outer diameter of the rim",
        "D_a",
        above=0,
        instead="mean_diameter",
        needs="inner_diameter",
        gives=lambda values: {
            "mean_diameter": (values["outer_diameter"] + values["inner_diameter"]) / 2,
            "depth": (values["outer_diameter"] - values["inner_diameter"]) / 2,
        },
    )
    _inner_diameter = alternative(
        "length",
        "Inner diameter of the rim, 0 of a disc",
        "D_i",
        least=0,
        needs="outer_diameter",
    )
    depth: float = field(
        "length",
        "Radial depth of its section",
        "h",
        default=0.0,
        above=0,
        absent="a thin rim",
        instead="inner_diameter",
        needs="mean_diameter",
    )
    width: float | None = field(
        "length", "Axial width of its section, which gives its moment of inertia", "b", above=0
    )
    mass: float | None = field(
        "mass",
        "Mass of the rim, which gives its moment of inertia instead of the width",
        "m",
        above=0,
        instead="width",
    )
    density: float = field(
        "density",
        "Density of its material",
        "ρ",
        default=CAST_IRON,
        above=0,
        absent="7250 kg/m³, cast iron",
        also=("material",),
        example="7250 kg/m3",
    )
    allowable_tension: float | None = field(
        "stress",
        "Allowable hoop stress of the rim; a warning is given if it is exceeded",
        "k_z",
        above=0,
    )

    @classmethod
    def rules_of_keys(cls, values: ValuesByKey) -> Iterator[Rule]:
        inner = values.get("inner_diameter")
        outer = values.get("outer_diameter")
        if inner is not None and outer is not None:
            sentence = "{inner:length} leaves no rim inside of the outer diameter ({outer:length})"
            yield Rule("inner_diameter", inner >= outer, sentence, {"inner": inner, "outer": outer})

    def rules(self) -> Iterator[Rule]:
        message = "{depth} is more than the mean diameter ({mean_diameter}), that of a disc"
        yield Rule("depth", self.depth > self.mean_diameter, message)
        if self.sized_by:
            advice = "give 'outer_diameter' and 'inner_diameter', or 'depth' with 'mean_diameter'"
            message = f"gives no moment of inertia without the depth of the rim; {advice}"
            yield Rule(self.sized_by, self.depth == 0, message)

    @property
    def sized_by(self) -> str:
        """What gives its moment of inertia: `mass` or `width`, or an empty text."""
        if self.mass is not None:
            return "mass"
        return "width" if self.width is not None else ""

    @property
    def inertia(self) -> float | None:
        """J = m (D² + h²)/4 in kg m², which is π/32 ρ b (D_a⁴ − D_i⁴); None where its size is not known."""
        mass = self.mass
        if self.width is not None:
            mass = self.density * self.width * math.pi * self.mean_diameter * self.depth
        if mass is None:
            return None
        return mass * self._square / 4

    @property
    def _square(self) -> float:
        """D² + h² = (D_a² + D_i²)/2 in m²."""
        return self.mean_diameter**2 + self.depth**2

    def section(self, inertia: float) -> float:
        """Return the area A in m² of a rim with J = ρ A π D (D² + h²)/4, arms and hub left out; inertia in kg m²."""
        return 4 * inertia / (math.pi * self.density * self.mean_diameter * self._square)

    def speed(self, omega: float) -> float:
        """Return the speed v in m/s of the middle of the rim at an angular velocity in rad/s."""
        return omega * self.mean_diameter / 2

    def stress(self, omega: float) -> float:
        """Return the hoop stress ρ v² in Pa of a rim that turns freely, at an angular velocity in rad/s."""
        return self.density * self.speed(omega) ** 2


def _rim_and_inertia(values: ValuesByKey) -> dict[str, object]:
    """Return what a rim determines of its flywheel: the moment of inertia if its sizes are given."""
    rim = values["rim"]
    if rim.sized_by:
        return {"rim": rim, "inertia": rim.inertia}
    return {"rim": rim}


class Flywheel(Record):
    """A flywheel by its moment of inertia, by the wanted fluctuation of the speed, or both."""

    inertia: float | None = field("inertia", "Moment of inertia; or give `gd2`", "J", least=0)
    _gd2 = alternative(
        "gd2",
        "Flywheel effect: 4gJ in units of weight times area, or 4J in units of mass times area",
        "GD²",
        least=0,
        instead="inertia",
        gives=lambda values: {"inertia": values["gd2"] / 4},
    )
    _mass = alternative(
        "mass",
        "Mass; with the radius of gyration it gives the moment of inertia m k²",
        "m",
        least=0,
        instead="inertia",
        needs="radius_of_gyration",
        gives=lambda values: {"inertia": values["mass"] * values["radius_of_gyration"] ** 2},
    )
    _radius_of_gyration = alternative(
        "length",
        "Radius of gyration",
        "k",
        above=0,
        instead="gd2",  # beside `mass`, which is instead of `inertia`
        needs="mass",
    )
    fluctuation: float | None = field(
        "ratio",
        "Required coefficient of speed fluctuation (ω_max − ω_min)/ω_mean",
        "δ",
        above=0,
        below=2,
        example="1/80",
    )
    _rim = alternative(
        Rim,
        "A rim that has the whole moment of inertia: its dimensions give J; without them the required section is "
        "printed",
        absent="no section",
        gives=_rim_and_inertia,
    )
    rim: Rim | None = None

    @classmethod
    def rules_of_keys(cls, values: ValuesByKey) -> Iterator[Rule]:
        rim = values.get("rim")
        if isinstance(rim, Rim) and rim.sized_by:
            has_inertia = bool({"inertia", "gd2", "mass"} & values.keys())
            message = (
                "the moment of inertia is given and also follows from the sizes of the rim; "
                "give only one of them"
            )
            yield Rule(("rim", rim.sized_by), has_inertia, message)

    def rules(self) -> Iterator[Rule]:
        message = (
            "a flywheel needs 'inertia', 'gd2', 'mass', a 'rim' with its sizes, "
            "or the wanted 'fluctuation'"
        )
        yield Rule((), self.inertia is None and self.fluctuation is None, message)


def _cycle_name(cycle: str, turns: int) -> str:
    """Return the name of a working cycle; '' where the machine repeats after other turns than those of its cycle."""
    if turns != CYCLES[cycle]:
        return ""
    return f"a {cycle} cycle"


@dataclass(frozen=True, eq=False)
class Effort:
    """A turning-moment diagram: torques in N m over crank angles in degrees, from 0 to 360 or 720, ascending.

    Two points at one angle are a jump.
    """

    angles: tuple[float, ...]
    torques: tuple[float, ...]
    files: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()
    alone: ClassVar[Literal[False]] = False

    @property
    def size(self) -> str:
        """How much is given."""
        return f"a diagram of {len(self.angles)} points"

    def of_cycle(self, turns: int) -> "Effort":
        """Return it for a cycle of so many turns of the shaft."""
        return self

    def rules_of_cycle(self, cycle: str, turns: int) -> Iterator[Rule]:
        """Yield what does not fit the cycle of the machine, of so many turns of the shaft."""
        last = self.angles[-1]
        cycle_angle = 360.0 * turns
        # a diagram of a single turn repeats in the second one of a four-stroke cycle
        repeats = cycle_angle % last == 0
        advice = f"cycle_turns: {last / 360:g}"
        if turns < 2 and last == 720:
            advice = "cycle: four-stroke"
        name = _cycle_name(cycle, turns) or "the cycle"
        message = (
            f"the diagram runs to {last:g} deg, {name} has {cycle_angle:g} deg; "
            f"write '{advice}' at the top"
        )
        yield Rule("file" if self.files else "points", not repeats, message)


@dataclass(frozen=True, eq=False)
class Harmonics:
    """A torque by harmonics, M = mean + Σ c cos νφ + s sin νφ: in N m, ν per turn of the shaft.

    terms: (ν, c, s) each.
    """

    mean: float
    terms: tuple[tuple[float, float, float], ...]
    files: ClassVar[tuple[str, ...]] = ()
    notes: ClassVar[tuple[str, ...]] = ()
    alone: ClassVar[Literal[False]] = False

    @property
    def size(self) -> str:
        """How much is given."""
        return f"{len(self.terms)} harmonics"

    def of_cycle(self, turns: int) -> "Harmonics":
        """Return it for a cycle of so many turns of the shaft."""
        return self

    def rules_of_cycle(self, cycle: str, turns: int) -> Iterator[Rule]:
        """Yield what does not fit the cycle of the machine, of so many turns of the shaft."""
        name = _cycle_name(cycle, turns) or f"{turns} turns"
        for order, _, _ in self.terms:
            if not is_whole(order * turns):
                message = (
                    f"order {order:g} does not repeat after {name}; orders count periods per turn"
                )
                yield Rule("harmonics", True, message)
                return


@dataclass(frozen=True, eq=False)
class Swing:
    """A turning effort of which the swing of energy alone is known, ΔE in J, or its coefficient ΔE/A.

    mean: mean torque in N m, None where it is not known.
    """

    swing: float | None = None
    coefficient: float | None = None
    mean: float | None = None
    files: ClassVar[tuple[str, ...]] = ()
    notes: ClassVar[tuple[str, ...]] = ()
    alone: ClassVar[Literal[True]] = True

    def of_cycle(self, turns: int) -> "Swing":
        """Return it for a cycle of so many turns of the shaft."""
        return self

    def rules_of_cycle(self, cycle: str, turns: int) -> Iterator[Rule]:
        """Yield no rule: it fits every cycle."""
        return iter(())

    def energy(self, turns: int) -> float | None:
        """Return ΔE in J, with the work of a cycle of so many turns, A = 2π turns M_m."""
        if self.coefficient is None:
            return self.swing
        work_per_torque = 2 * math.pi * turns
        return self.coefficient * work_per_torque * abs(self.mean or 0.0)


KnownDiagram = Effort | Harmonics | Swing
"""A turning effort that is known from elsewhere."""


class InUnit(float):
    """A bare number in the unit of the key `unit`."""


UNIT = alternative(unit_name("torque"), "Unit of the torques")
POINTS = alternative(
    Points("deg", "torque"),
    "Torque over the crank angle; two points at one angle are a jump",
    "M",
    needs="unit",
)
MEAN = alternative(
    OneOf(NumberForm("torque"), NumberForm("ratio", becomes=lambda number, _: InUnit(number))),
    "Mean torque with its unit, or bare in that of the harmonics",
    "M_m",
)
HARMONICS = alternative(
    Points("order", "cos", "sin", least=1),
    "Harmonics of the torque: periods per turn, coefficients of cos νφ and sin νφ",
    needs="mean",
    instead="points",
)


def harmonics_need_a_unit(values: ValuesByKey) -> Rule:
    """Return the rule that coefficients of harmonics have the unit of their key."""
    lacks_unit = "harmonics" in values and "unit" not in values
    return Rule("harmonics", lacks_unit, "'harmonics' needs 'unit' beside it")


def points_of(unit: UnitFactor, points: list[DiagramPoint]) -> Effort:
    """Return the diagram of the value of `points` in a machine file; raises RuleError."""
    faults = _angle_faults(points) or size_faults(points, unit, "torque")
    refuse(*(fault.below(("points",)) for fault in faults))
    multiplier, divisor = unit
    angles = tuple(angle for angle, _ in points)
    torques = tuple(torque * multiplier / divisor for _, torque in points)
    return Effort(angles, torques)


def harmonics_of(unit: UnitFactor, mean: float, terms: list[DiagramPoint]) -> Harmonics:
    """Return those of the values of `unit`, `mean` and `harmonics` in a machine file; raises RuleError."""
    for index, (order, *_) in enumerate(terms):
        if not 0 < order <= _HIGHEST:
            bounds = f"it must be more than 0, at most {_HIGHEST}"
            message = f"order {order:g} is no number of periods per turn; {bounds}"
            refused(message, "harmonics", index, 0)
    # no torque is too large for its unit
    sizes: list[DiagramPoint] = []
    if isinstance(mean, InUnit):
        sizes.append((0.0, mean))
    sizes += [(order, abs(cosine) + abs(sine)) for order, cosine, sine in terms]
    refuse(*(fault._replace(path=("harmonics",)) for fault in size_faults(sizes, unit, "torque")))
    # in N m
    multiplier, divisor = unit
    terms_in_newton_metres = tuple(
        (order, cosine * multiplier / divisor, sine * multiplier / divisor)
        for order, cosine, sine in terms
    )
    return Harmonics(in_unit(mean, unit), terms_in_newton_metres)


def in_unit(mean: float, unit: UnitFactor) -> float:
    """Return a mean torque in N m, where a bare number is in this unit."""
    if not isinstance(mean, InUnit):
        return mean
    multiplier, divisor = unit
    return mean * multiplier / divisor


class Load(Record):
    """The resistance at the shaft, in exactly one of four forms.

    power: k of a torque ∝ ω^k that equals the mean effort at the nominal speed; slip: s of a torque
    mean · (1 + (ω/ω_n − 1)/s); diagram: a resistance that varies over the turn, by points or harmonics.
    """

    power: float | None = field(
        "ratio",
        "Torque proportional to ω^k: 2 for a fan, 0 for a hoist",
        "k",
        key="power_law",
        example="2",
    )
    slip: float | None = field(
        "ratio",
        "Slip of a grid-tied generator at mean torque; stiff for small slip",
        "s",
        above=0,
        example="0.03",
    )
    _unit = UNIT
    _points = POINTS._replace(
        gives=lambda values: {"diagram": points_of(values["unit"], values["points"])}
    )
    _mean = MEAN._replace(needs="harmonics")
    _harmonics = HARMONICS._replace(
        gives=lambda values: {
            "diagram": harmonics_of(values["unit"], values["mean"], values["harmonics"])
        }
    )
    diagram: Effort | Harmonics | None = None

    @classmethod
    def rules_of_keys(cls, values: ValuesByKey) -> Iterator[Rule]:
        has_numbers = bool({"points", "harmonics"} & values.keys())
        is_lone = "unit" in values and not has_numbers
        yield Rule("unit", is_lone, "'unit' needs 'points' or 'harmonics' beside it")
        yield harmonics_need_a_unit(values)

    def rules(self) -> Iterator[Rule]:
        diagram_key = "harmonics" if isinstance(self.diagram, Harmonics) else "points"
        forms = {"power_law": self.power, "slip": self.slip, diagram_key: self.diagram}
        keys = [key for key, value in forms.items() if value is not None]
        if not keys:
            message = (
                "give one of 'power_law', 'slip', 'points' or 'harmonics'; "
                "or write 'load: constant'"
            )
            yield Rule((), True, message)
        elif len(keys) > 1:
            message = f"{' and '.join(map(repr, keys))} are different loads; keep one of them"
            yield Rule(keys[-1], True, message)

    @property
    def varies(self) -> bool:
        """Whether it varies over the turn or with the speed."""
        return self.diagram is not None or self.slip is not None or some(self.power != 0)


class Coupling(Record):
    """An elastic coupling and what it drives."""

    stiffness: float = field("stiffness", "Torque per angle of twist", "k", above=0)
    inertia: float = field("inertia", "Moment of inertia of the driven machine", "J_2", above=0)
    damping: float = field("damping", "Torque per speed of twist", "d", default=0.0, least=0)


def _angle_faults(points: list[DiagramPoint]) -> list[Fault]:
    """Return what is wrong with the angles of a diagram over one cycle: from 0 to the end of a turn, in order."""
    for index, (angle, _) in enumerate(points):
        if not 0 <= angle <= 360 * MOST_TURNS:
            message = f"{angle:g} deg is outside the cycle; angles run from 0 to 360 or 720 deg"
            return [Fault((index,), message)]
    faults = order_faults(points, "{:g} deg")
    if faults:
        return faults
    first = points[0][0]
    last = points[-1][0]
    is_cycle = first == 0 and last != 0 and last % 360 == 0
    if is_cycle:
        return []
    message = (
        "a diagram runs from 0 to 360 deg, or to 720 deg in a four-stroke cycle, "
        f"this one runs from {first:g} to {last:g} deg; "
        "give the values at both ends of the cycle, with angles in degrees"
    )
    return [Fault((), message)]
