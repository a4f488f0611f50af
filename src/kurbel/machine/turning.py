"""What works on the shaft: load, a turning-moment diagram known from elsewhere, an elastic coupling."""

from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar

from kurbel.declared.forms import Points, UnitName
from kurbel.declared.kinds import Factor, Point, size_faults
from kurbel.declared.record import Record, Rule, alternative, field
from kurbel.errors import Fault, Path, refuse
from kurbel.machine.cylinder import CYCLES


@dataclass(frozen=True, eq=False)
class Effort:
    """A turning-moment diagram: torques in N m over crank angles in degrees, from 0 to 360 or 720, ascending.

    Two points at one angle are a jump.
    """

    angles: tuple[float, ...]
    torques: tuple[float, ...]
    files: tuple[str, ...] = ()
    notes: tuple[str, ...] = ()

    @classmethod
    def of_points(cls, unit: Factor, points: list[Point]) -> "Effort":
        """Return the diagram of the points that stand under `points` in a machine file; raises RuleError."""
        refuse(*(_angle_faults(points, ("points",)) or size_faults(points, unit, "torque", ("points",))))
        up, down = unit
        return cls(tuple(angle for angle, _ in points), tuple(torque * up / down for _, torque in points))

    def cycle_fault(self, cycle: str) -> str:
        """Return what does not fit the cycle of the machine, or an empty text."""
        return _beyond_cycle(self.angles[-1], cycle)

    @property
    def key(self) -> str:
        """The key that the torques stand under."""
        return "file" if self.files else "points"


@dataclass(frozen=True, eq=False)
class Harmonics:
    """A turning effort by harmonics, M = mean + Σ c cos νφ + s sin νφ: in N m, ν per turn of the shaft.

    terms: (ν, c, s) each.
    """

    mean: float
    terms: tuple[tuple[float, float, float], ...]

    key: ClassVar[str] = "harmonics"

    def cycle_fault(self, cycle: str) -> str:
        """Return what does not fit the cycle of the machine, or an empty text."""
        for order, _, _ in self.terms:
            if (order * CYCLES[cycle]) % 1:
                return f"order {order:g} does not repeat after a {cycle} cycle; orders count periods per turn"
        return ""


@dataclass(frozen=True, eq=False, repr=False)
class Load(Record):
    """The resistance at the shaft, in exactly one of three forms.

    power: k of a torque ∝ ω^k that equals the mean effort at the nominal speed; slip: s of a torque
    mean · (1 + (ω/ω_n − 1)/s); diagram: a resistance that varies over the turn.
    """

    power: float | None = field("ratio", "Torque proportional to ω^k: 2 for a fan, 0 for a hoist", "k", key="power_law")
    slip: float | None = field(
        "ratio", "Slip of a grid-tied generator at mean torque; stiff for small slip", "s", above=0
    )
    _unit = alternative(UnitName("torque"), "Unit of the torques", needs="points", key="unit")
    _points = alternative(
        Points("deg", "torque"),
        "Torque over the crank angle; two points at one angle are a jump",
        "M",
        needs="unit",
        gives=lambda given: {"diagram": Effort.of_points(given["unit"], given["points"])},
        key="points",
    )
    diagram: Effort | None = None

    def rules(self) -> Iterator[Rule]:
        forms = {"power_law": self.power, "slip": self.slip, "points": self.diagram}
        given = [name for name, value in forms.items() if value is not None]
        yield Rule((), not given, "give one of 'power_law', 'slip' or 'points'; or write 'load: constant'")
        names = " and ".join(f"'{name}'" for name in given)
        yield Rule((given[1:] or ("",))[0], len(given) > 1, f"{names} are different loads; keep one of them")

    def cycle_fault(self, cycle: str) -> str:
        """Return what does not fit the cycle of the machine, or an empty text."""
        return self.diagram.cycle_fault(cycle) if self.diagram else ""


@dataclass(frozen=True, eq=False, repr=False)
class Coupling(Record):
    """An elastic coupling and what it drives."""

    stiffness: float = field("stiffness", "Torque per angle of twist", "k", above=0, required=True)
    inertia: float = field("inertia", "Moment of inertia of what is driven", "J_2", above=0, required=True)
    damping: float = field("damping", "Torque per speed of twist", "d", default=0.0, least=0, absent="0")


def _angle_faults(points: list[Point], path: Path) -> list[Fault]:
    """Return what is wrong with the angles of a diagram over one cycle.

    They run from 0 to 360 or 720 deg and do not turn back; two points at one angle are a jump, three are one too many.
    """
    for i, (angle, _) in enumerate(points):
        if not 0 <= angle <= 720:
            return [Fault((*path, i), f"{angle:g} deg is outside the cycle; angles run from 0 to 360 or 720 deg")]
        if i and angle < points[i - 1][0]:
            return [
                Fault((*path, i), f"{angle:g} deg after {points[i - 1][0]:g} deg; put the points in order of the angle")
            ]
        if i >= 2 and angle == points[i - 2][0]:
            return [Fault((*path, i), f"three points at {angle:g} deg; a jump has two")]
    if not points or points[0][0] != 0 or points[-1][0] not in (360, 720):
        runs = f"this one runs from {points[0][0]:g} to {points[-1][0]:g} deg" if points else "this one has no points"
        whole = "a diagram runs from 0 to 360 deg, or to 720 deg in a four-stroke cycle"
        return [Fault(path, f"{whole}, {runs}; give the values at both ends of the cycle, with angles in degrees")]
    return []


def _beyond_cycle(last: float, cycle: str) -> str:
    """Return what to write when a diagram ends at an angle (in degrees) that the cycle does not have; else ''."""
    whole = 360.0 * CYCLES[cycle]
    if last <= whole:  # one of a single turn repeats in the second one of a four-stroke cycle
        return ""
    return f"the diagram runs to {last:g} deg, a {cycle} cycle has {whole:g} deg; write 'cycle: four-stroke' at the top"
