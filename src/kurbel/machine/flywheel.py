"""The flywheel, and the rim that is to be built for it."""

import math
from dataclasses import dataclass
from typing import Any, ClassVar

from kurbel.declared.forms import Number, Record, not_negative, positive
from kurbel.declared.keys import Described, Key, Keys
from kurbel.declared.unit_systems import show
from kurbel.errors import refused

CAST_IRON = 7250.0
"""Density in kg/m³ of what rims are cast of."""


@dataclass(frozen=True, eq=False, repr=False)
class Rim(Described):
    """The rim of a flywheel: mean diameter in m, density in kg/m³, and the tension in Pa that it may bear or None.

    depth: of its section along the radius in m, 0 where it is not known; width: of its section along the shaft in m;
    mass in kg. Width or mass, beside a depth, tell its moment of inertia.
    """

    mean_diameter: float
    density: float = CAST_IRON
    allowable_tension: float | None = None
    depth: float = 0.0
    width: float | None = None
    mass: float | None = None

    KEYS: ClassVar[Keys] = {
        "mean_diameter": positive("length", "Mean diameter of the rim", "D", required=True, example="3 m"),
        "outer_diameter": positive(
            "length", "Outer diameter of the rim", "D_a", instead="mean_diameter", needs="inner_diameter"
        ),
        "inner_diameter": not_negative(
            "length", "Inner diameter of the rim, 0 of a disc", "D_i", needs="outer_diameter"
        ),
        "depth": positive(
            "length",
            "Depth of its section along the radius",
            "h",
            absent="a thin rim",
            instead="inner_diameter",
            needs="mean_diameter",
        ),
        "width": positive(
            "length", "Width of its section along the shaft; with it the rim has its moment of inertia", "b"
        ),
        "mass": positive(
            "mass", "Mass of the rim, which tells its moment of inertia as the width does", "m", instead="width"
        ),
        "density": positive(
            "density", "Density of its material", "ρ", absent="7250 kg/m³, cast iron", also=("material",)
        ),
        "allowable_tension": positive(
            "stress", "Tension that the rim may bear; a warning tells when it has more", "k_z"
        ),
    }

    @classmethod
    def of_keys(
        cls, outer_diameter: float | None = None, inner_diameter: float = 0.0, depth: float = 0.0, **keys: Any
    ) -> "Rim":
        """Return the rim with D = (D_a + D_i)/2 and h = (D_a − D_i)/2; raises RuleError."""
        if outer_diameter is None:
            return cls(depth=depth, **keys)
        if inner_diameter >= outer_diameter:
            outer, inner = show(outer_diameter, "length"), show(inner_diameter, "length")
            refused(f"{inner} leaves no rim inside of the outer diameter ({outer})", "inner_diameter")
        return cls((outer_diameter + inner_diameter) / 2, depth=(outer_diameter - inner_diameter) / 2, **keys)

    def __post_init__(self) -> None:
        if self.depth > self.mean_diameter:
            depth, mean = show(self.depth, "length"), show(self.mean_diameter, "length")
            refused(f"{depth} is more than the mean diameter ({mean}), that of a disc", "depth")
        if self.sized_by and not self.depth:
            message = "give 'outer_diameter' and 'inner_diameter', or 'depth' beside 'mean_diameter'"
            refused(f"tells no moment of inertia without the depth of the rim; {message}", self.sized_by)

    @property
    def sized_by(self) -> str:
        """What tells its moment of inertia: `mass` or `width`, or an empty text."""
        return "mass" if self.mass is not None else "width" if self.width is not None else ""

    @property
    def inertia(self) -> float | None:
        """J = m (D² + h²)/4 in kg m², which is π/32 ρ b (D_a⁴ − D_i⁴); None where its size is not known."""
        mass = self.mass
        if self.width is not None:
            mass = self.density * self.width * math.pi * self.mean_diameter * self.depth
        return None if mass is None else mass * self._square / 4

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


@dataclass(frozen=True, eq=False, repr=False)
class Flywheel(Described):
    """A flywheel: its moment of inertia J in kg m², the wanted coefficient of fluctuation δ, and the rim to be built.

    Any of them may be None, but not both of the first two.
    """

    inertia: float | None = None
    fluctuation: float | None = None
    rim: Rim | None = None

    KEYS: ClassVar[Keys] = {
        "inertia": not_negative("inertia", "Moment of inertia; or give `gd2`", "J"),
        "gd2": not_negative(
            "gd2",
            "Old form of the moment of inertia: 4gJ as a weight times an area, or 4J as a mass times an area",
            "GD²",
            instead="inertia",
        ),
        "mass": not_negative(
            "mass",
            "Mass, with the radius of gyration another form of the moment of inertia m k²",
            "m",
            instead="inertia",
            needs="radius_of_gyration",
        ),
        "radius_of_gyration": positive("length", "Radius of gyration", "k", instead="gd2", needs="mass"),
        "fluctuation": Key(
            Number(above=0, below=2),
            "Wanted coefficient of speed fluctuation (ω_max − ω_min)/ω_mean",
            "δ",
            example="1/80",
        ),
        "rim": Key(
            Record(Rim),
            "A rim that has the whole moment of inertia; its sizes tell it, or else its section is told",
            absent="no section",
        ),
    }

    @classmethod
    def of_keys(cls, **keys: Any) -> "Flywheel":
        """Return the flywheel with J = inertia, GD²/4, m k², or that of its rim; raises RuleError."""
        mass, radius, gd2 = (keys.pop(name, None) for name in ("mass", "radius_of_gyration", "gd2"))
        if gd2 is not None:
            keys["inertia"] = gd2 / 4
        if mass is not None:
            keys["inertia"] = mass * radius**2
        rim = keys.get("rim")
        if rim and rim.sized_by:
            if "inertia" in keys:
                message = (
                    "the sizes of the rim tell the moment of inertia, which is given besides; leave one of them out"
                )
                refused(message, "rim", rim.sized_by)
            keys["inertia"] = rim.inertia
        return cls(**keys)

    def __post_init__(self) -> None:
        if self.inertia is None and self.fluctuation is None:
            refused("a flywheel needs 'inertia', 'gd2', 'mass', a 'rim' with its sizes, or the wanted 'fluctuation'")
