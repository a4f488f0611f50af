"""What turns with the shaft: flywheel, load, a turning-moment diagram known from elsewhere, an elastic coupling."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from kurbel.declared.bounds import Point, size_faults
from kurbel.declared.forms import Number, Physical, Points, UnitName
from kurbel.declared.keys import Described, Key, Keys
from kurbel.declared.units import Factor
from kurbel.errors import Fault, refuse
from kurbel.machine.angle_points import angle_faults, beyond_cycle

_TORQUE_KEYS: Keys = {
    "unit": Key(UnitName("torque"), "Unit of the torques", needs="points"),
    "points": Key(
        Points("deg", "torque"), "Torque over the crank angle; two points at one angle are a jump", "M", needs="unit"
    ),
}


@dataclass(frozen=True, eq=False)
class Flywheel(Described):
    """A flywheel: its moment of inertia J in kg m², and the wanted coefficient of fluctuation δ; either may be None."""

    inertia: float | None = None
    fluctuation: float | None = None

    KEYS: ClassVar[Keys] = {
        "inertia": Key(Physical("inertia", least=0), "Moment of inertia; or give `gd2`", "J"),
        "gd2": Key(
            Physical("gd2", least=0),
            "Old form of the moment of inertia: 4gJ as a weight times an area, or 4J as a mass times an area",
            "GD²",
            instead="inertia",
        ),
        "fluctuation": Key(
            Number(above=0, below=2), "Wanted coefficient of speed fluctuation (ω_max − ω_min)/ω_mean", "δ"
        ),
    }

    @classmethod
    def of_keys(
        cls, inertia: float | None = None, gd2: float | None = None, fluctuation: float | None = None
    ) -> Flywheel:
        """Return the flywheel with J = inertia or GD²/4."""
        return cls(gd2 / 4 if gd2 is not None else inertia, fluctuation)

    def __post_init__(self) -> None:
        if self.inertia is None and self.fluctuation is None:
            refuse(Fault((), "a flywheel needs 'inertia', 'gd2' or the wanted 'fluctuation'"))


@dataclass(frozen=True, eq=False)
class Effort(Described):
    """A turning-moment diagram: torques in N m over crank angles in degrees, from 0 to 360 or 720, ascending.

    Two points at one angle are a jump.
    """

    angles: tuple[float, ...]
    torques: tuple[float, ...]

    KEYS: ClassVar[Keys] = {name: key._replace(required=True) for name, key in _TORQUE_KEYS.items()}

    @classmethod
    def of_keys(cls, unit: Factor, points: list[Point]) -> Effort:
        """Return the diagram that these keys of a machine file describe; raises RuleError."""
        refuse(*(angle_faults(points, ("points",)) or size_faults(points, unit, "torque", ("points",))))
        up, down = unit
        return cls(tuple(angle for angle, _ in points), tuple(torque * up / down for _, torque in points))

    def cycle_fault(self, cycle: str) -> str:
        """Return what does not fit the cycle of the machine, or an empty text."""
        return beyond_cycle(self.angles[-1], cycle)


@dataclass(frozen=True, eq=False)
class Load(Described):
    """The resistance at the shaft, in exactly one of three forms.

    power: k of a torque ∝ ω^k that equals the mean effort at the nominal speed; slip: s of a torque
    mean · (1 + (ω/ω_n − 1)/s); diagram: a resistance that varies over the turn.
    """

    power: float | None = None
    slip: float | None = None
    diagram: Effort | None = None

    KEYS: ClassVar[Keys] = {
        "power_law": Key(Number(), "Torque proportional to ω^k: 2 for a fan, 0 for a hoist", "k"),
        "slip": Key(Number(above=0), "Slip of a grid-tied generator at mean torque; stiff for small slip", "s"),
        **_TORQUE_KEYS,
    }

    @classmethod
    def of_keys(
        cls,
        power_law: float | None = None,
        slip: float | None = None,
        unit: Factor | None = None,
        points: list[Point] | None = None,
    ) -> Load:
        """Return the load that these keys of a machine file describe; raises RuleError."""
        diagram = None if unit is None or points is None else Effort.from_keys(unit=unit, points=points)
        return cls(power_law, slip, diagram)

    def __post_init__(self) -> None:
        forms = {"power_law": self.power, "slip": self.slip, "points": self.diagram}
        given = [name for name, value in forms.items() if value is not None]
        if not given:
            refuse(Fault((), "give one of 'power_law', 'slip' or 'points'; or write 'load: constant'"))
        if len(given) > 1:
            names = " and ".join(f"'{name}'" for name in given)
            refuse(Fault((given[1],), f"{names} are different loads; keep one of them"))

    def cycle_fault(self, cycle: str) -> str:
        """Return what does not fit the cycle of the machine, or an empty text."""
        return self.diagram.cycle_fault(cycle) if self.diagram else ""


@dataclass(frozen=True, eq=False)
class Coupling(Described):
    """An elastic coupling: stiffness in N m/rad, damping in N m s/rad, and the driven moment of inertia in kg m²."""

    stiffness: float
    inertia: float
    damping: float = 0.0

    KEYS: ClassVar[Keys] = {
        "stiffness": Key(Physical("stiffness", above=0), "Torque per angle of twist", "k", required=True),
        "damping": Key(Physical("damping", least=0), "Torque per speed of twist", "d", absent="0"),
        "inertia": Key(Physical("inertia", above=0), "Moment of inertia of what is driven", "J_2", required=True),
    }
