"""The flywheel, and the rim that is to be built for it."""

import math
from dataclasses import dataclass
from typing import Any, ClassVar

from kurbel.declared.forms import Number, Record, not_negative, positive
from kurbel.declared.keys import Described, Key, Keys
from kurbel.errors import Fault, refuse

CAST_IRON = 7250.0
"""Density in kg/m³ of what rims are cast of."""


@dataclass(frozen=True, eq=False, repr=False)
class Rim(Described):
    """The rim of a flywheel: mean diameter in m, density in kg/m³, and the tension in Pa that it may bear or None."""

    mean_diameter: float
    density: float = CAST_IRON
    allowable_tension: float | None = None

    KEYS: ClassVar[Keys] = {
        "mean_diameter": positive("length", "Mean diameter of the rim", "D", required=True),
        "density": positive(
            "density", "Density of its material", "ρ", absent="7250 kg/m³, cast iron", also=("material",)
        ),
        "allowable_tension": positive(
            "stress", "Tension that the rim may bear; a warning tells when it has more", "k_z"
        ),
    }

    def section(self, inertia: float) -> float:
        """Return the area A in m² of a thin rim with J = ρ A π D (D/2)², arms and hub left out; inertia in kg m²."""
        return 4 * inertia / (math.pi * self.density * self.mean_diameter**3)

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
            Number(above=0, below=2), "Wanted coefficient of speed fluctuation (ω_max − ω_min)/ω_mean", "δ"
        ),
        "rim": Key(
            Record("kurbel.machine.flywheel:Rim"), "A rim that has the whole moment of inertia", absent="no section"
        ),
    }

    @classmethod
    def of_keys(cls, **keys: Any) -> "Flywheel":
        """Return the flywheel with J = inertia, GD²/4 or m k²."""
        mass, radius, gd2 = (keys.pop(name, None) for name in ("mass", "radius_of_gyration", "gd2"))
        if gd2 is not None:
            keys["inertia"] = gd2 / 4
        return cls(**keys) if mass is None else cls(mass * radius**2, **keys)

    def __post_init__(self) -> None:
        if self.inertia is None and self.fluctuation is None:
            refuse(Fault((), "a flywheel needs 'inertia', 'gd2', 'mass' or the wanted 'fluctuation'"))
