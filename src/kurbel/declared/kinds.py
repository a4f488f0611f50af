"""Every kind of quantity, declared once: its units as people read it, the sizes that a machine file may hold."""

# annotations are taken as they stand: NamedTuple compiles each postponed one at every start

from typing import Any, NamedTuple


class Kind(NamedTuple):
    """What is said of a kind: sizes in its base, and units, of which none is that of SI.

    smallest: above 0; where it is 0, values are sums in which noise is no fault: a measured pressure may be 1e-17 Pa.
    metric: also several units, of which the size of a value decides. written: a value as a person writes it.
    """

    smallest: float
    largest: float
    si: str
    metric: Any = None
    technical: Any = None
    imperial: Any = None
    written: str = ""


KINDS = {
    "length": Kind(1e-9, 1e9, "m", ("mm", "m"), "mm", "in", "450 mm"),
    "area": Kind(1e-18, 1e18, "m^2", "cm^2", "cm^2", "in^2"),
    "mass": Kind(1e-12, 1e18, "kg", ("kg", "t"), None, "lb", "120 kg"),
    "force": Kind(0, 1e18, "N", ("N", "kN", "MN"), "kgf", "lbf"),
    "pressure": Kind(0, 1e15, "Pa", ("mbar", "bar"), "at", "psi", "5.4 bar"),
    "stress": Kind(1e-3, 1e15, "Pa", "N/mm^2", "kgf/cm^2", "psi", "60 N/mm2"),
    "time": Kind(1e-12, 1e12, "s"),
    "angle": Kind(0, 1e6, "deg", written="90 deg"),
    "speed": Kind(1e-9, 1e6, "1/s", "rpm", "rpm", "rpm", "50 rpm"),
    "frequency": Kind(1e-9, 1e9, "Hz"),
    "angular_velocity": Kind(0, 1e9, "rad/s"),
    "angular_acceleration": Kind(0, 1e18, "rad/s^2"),
    "velocity": Kind(0, 1e15, "m/s", imperial="ft/s"),
    "acceleration": Kind(0, 1e18, "m/s^2", imperial="ft/s^2"),
    "torque": Kind(0, 1e18, "N m", ("N m", "kN m"), "kgf m", "lbf ft"),
    "energy": Kind(0, 1e18, "J", ("J", "kJ", "MJ"), "kgf m", "lbf ft"),
    "power": Kind(0, 1e18, "W", ("W", "kW", "MW"), "PS", "hp"),
    "inertia": Kind(1e-18, 1e18, "kg m^2", imperial="lb ft^2"),
    "unbalance": Kind(1e-15, 1e18, "kg m", imperial="lb in"),
    "gd2": Kind(1e-18, 1e18, "kg m^2", None, "kgf m^2", "lb ft^2", "10 kgf m2"),
    "stiffness": Kind(1e-12, 1e18, "N m/rad", imperial="lbf ft/rad"),
    "damping": Kind(1e-15, 1e18, "N m s/rad", imperial="lbf ft s/rad"),
    "pressure_velocity": Kind(0, 1e18, "W/m^2", "N/mm^2 m/s", "kgf m/s/cm^2", "psi ft/s"),
    "volume": Kind(1e-27, 1e27, "m^3", ("cm^3", "m^3"), "dm^3", "in^3", "10 cm3"),
    "volume_rise": Kind(0, 1e27, "m^3/deg", "cm^3/deg", "cm^3/deg", "in^3/deg"),
    "pressure_rise": Kind(0, 1e15, "Pa/deg", ("mbar/deg", "bar/deg"), "at/deg", "psi/deg", "10 bar/deg"),
    "density": Kind(1e-9, 1e9, "kg/m^3"),
    "spring": Kind(1e-15, 1e3, "m/Pa", "mm/bar", "mm/at", "in/psi", "10 mm/at"),
    "ratio": Kind(1e-15, 1e15, ""),
}
"""A value may be 0, and of either sign. An angle of 1e6° is known to 1e-10°; beyond, nothing of it would be left."""
