"""Every kind of quantity: the sizes that a machine file may hold, its units, and how a value is read.

The sizes are far outside of what was ever built and far inside of what floats can be computed with, so that no square
and no quotient of values from a file leaves their range. They hold for the file and for records made in Python.
"""

import math
import re
from functools import cache
from typing import NamedTuple

from kurbel.declared.numerals import NUMBER, keyboard_text, parse_ratio
from kurbel.errors import UnitError

UnitFactor = tuple[float, float]
"""A unit as multiplier and divisor of its base, so that 450 mm becomes 450 / 1000, correctly rounded."""


class Kind(NamedTuple):
    """A kind of quantity: the sizes of its values in its base, its units, and which of them results are shown in.

    smallest: above 0; where it is 0, values are sums in which noise is no fault: a measured pressure may be 1e-17 Pa.
    units: names, or each of a list times (*) or over (/) each of another, between semicolons. metric, technical,
    imperial: None for the unit of SI; of several the size of a value decides. written: as a person writes a value.
    """

    smallest: float
    largest: float
    units: str
    si: str
    metric: str | tuple[str, ...] | None = None
    technical: str | None = None
    imperial: str | None = None
    written: str = ""


_LENGTHS = "m, mm, cm, dm, um, km, in, ft"
_AREAS = "m2, mm2, cm2, dm2, um2, km2, in2, ft2"
_MASSES = "kg, g, t, lb"
_FORCES = "N, kN, MN, kgf, kp, tf, lbf"
_PRESSURES = "Pa, kPa, MPa, GPa, hPa, mbar, bar, at, atm, psi, Torr, mmHg, cmHg, inHg, mmH2O, cmH2O, inH2O, mWS"
_STRESSES = f"{_FORCES} / {_AREAS}"
_TORQUES = f"{_FORCES} * {_LENGTHS}"

KINDS = {
    "length": Kind(1e-9, 1e9, _LENGTHS, "m", ("mm", "m"), "mm", "in", "450 mm"),
    "area": Kind(1e-18, 1e18, _AREAS, "m^2", "cm^2", "cm^2", "in^2", "1500 cm2"),
    "mass": Kind(
        1e-12,
        1e18,
        f"{_MASSES}; tonne, long ton, short ton",
        "kg",
        ("kg", "t"),
        None,
        "lb",
        "120 kg",
    ),
    "force": Kind(
        0, 1e18, f"{_FORCES}; long tonf, short tonf", "N", ("N", "kN", "MN"), "kgf", "lbf", "5 kN"
    ),
    "pressure": Kind(
        0,
        1e15,
        f"{_PRESSURES}; {_STRESSES}; lb/in2, lb/ft2",
        "Pa",
        ("mbar", "bar"),
        "at",
        "psi",
        "5.4 bar",
    ),
    "stress": Kind(
        1e-3,
        1e15,
        f"N/mm2; {_STRESSES}; {_PRESSURES}; lb/in2, lb/ft2",
        "Pa",
        "N/mm^2",
        "kgf/cm^2",
        "psi",
        "60 N/mm2",
    ),
    "time": Kind(1e-12, 1e12, "s, min, h", "s"),
    "angle": Kind(0, 1e6, "deg, °, rad", "deg", written="90 deg"),
    "speed": Kind(
        1e-9,
        1e6,
        "rps, rpm, 1/s, 1/min, U/min, rev/min, r/min, U/s, rev/s, r/s, min-1, s-1, Hz, rad/s",
        "rps",
        "rpm",
        "rpm",
        "rpm",
        "50 rpm",
    ),
    "frequency": Kind(1e-9, 1e9, "Hz, 1/s, kHz, 1/min", "Hz"),
    "angular_velocity": Kind(0, 1e9, "rad/s", "rad/s"),
    "angular_acceleration": Kind(0, 1e18, "rad/s2", "rad/s^2"),
    "velocity": Kind(0, 1e15, f"{_LENGTHS} / s, min, h", "m/s", imperial="ft/s"),
    "acceleration": Kind(0, 1e18, f"{_LENGTHS} / s2", "m/s^2", imperial="ft/s^2"),
    "torque": Kind(
        0,
        1e18,
        f"{_TORQUES}; Nm, kNm, lb ft, ft lb, ft lbf, lb in, in lb, in lbf",
        "N m",
        ("N m", "kN m"),
        "kgf m",
        "lbf ft",
        "1200 N m",
    ),
    "energy": Kind(
        0,
        1e18,
        f"J, kJ, MJ; {_TORQUES}; Nm, kcal, Btu",
        "J",
        ("J", "kJ", "MJ"),
        "kgf m",
        "lbf ft",
        "20 kJ",
    ),
    "power": Kind(
        0, 1e18, "W, kW, MW, PS, hp, kgf m/s", "W", ("W", "kW", "MW"), "PS", "hp", "25 kW"
    ),
    "inertia": Kind(
        1e-18,
        1e18,
        f"{_MASSES} * {_AREAS}; lbf in s2, lbf ft s2",
        "kg m^2",
        imperial="lb ft^2",
        written="800 kg m2",
    ),
    "unbalance": Kind(
        1e-15, 1e18, f"{_MASSES}, mg * {_LENGTHS}", "kg m", imperial="lb in", written="40 kg m"
    ),
    "gd2": Kind(
        1e-18,
        1e18,
        "kg, t * m2, cm2; kgf m2, kp m2, tf m2, N m2, lb ft2",
        "kg m^2",
        None,
        "kgf m^2",
        "lb ft^2",
        "3200 kgf m2",
    ),
    "stiffness": Kind(
        1e-12,
        1e18,
        f"{_FORCES} * m/rad, mm/rad, ft/rad, m/deg; Nm/rad, kNm/rad, Nm/deg",
        "N m/rad",
        imperial="lbf ft/rad",
        written="2000 kN m/rad",
    ),
    "spring_rate": Kind(
        1e-12,
        1e18,
        f"{_FORCES} / m, cm, mm, in, ft; lb/in, lb/ft",
        "N/m",
        "N/mm",
        "kgf/mm",
        "lbf/in",
        written="50 N/mm",
    ),
    "damping": Kind(
        1e-15,
        1e18,
        f"{_FORCES} * m s/rad; Nm s/rad, kNm s/rad, N m s, Nm s, kN m s, lbf ft s/rad",
        "N m s/rad",
        imperial="lbf ft s/rad",
        written="500 N m s/rad",
    ),
    "volume": Kind(
        1e-27,
        1e27,
        "m3, dm3, l, cm3, mm3, in3, ft3, US gal, imp gal, bbl, cc, ml",
        "m^3",
        ("cm^3", "m^3"),
        "dm^3",
        "in^3",
        "60 dm3",
    ),
    "volume_rise": Kind(
        0, 1e27, "m3, cm3, in3 / deg, rad", "m^3/deg", "cm^3/deg", "cm^3/deg", "in^3/deg"
    ),
    "pressure_rise": Kind(
        0,
        1e15,
        f"{_PRESSURES}, lb/in2, lb/ft2 / deg, rad",
        "Pa/deg",
        ("mbar/deg", "bar/deg"),
        "at/deg",
        "psi/deg",
        "10 bar/deg",
    ),
    "energy_rise": Kind(
        0,
        1e18,
        "J, kJ, kgf m, lbf ft / deg, rad",
        "J/deg",
        ("J/deg", "kJ/deg"),
        "kgf m/deg",
        "lbf ft/deg",
    ),
    "pressure_velocity": Kind(
        0,
        1e18,
        "W/m2, N/mm2 m/s, kgf m/s/cm2, psi ft/s",
        "W/m^2",
        "N/mm^2 m/s",
        "kgf m/s/cm^2",
        "psi ft/s",
    ),
    "density": Kind(
        1e-9,
        1e9,
        "kg/m3, kg/dm3, g/cm3, t/m3, lb/ft3, lb/in3",
        "kg/m^3",
        imperial="lb/ft^3",
        written="1000 kg/m3",
    ),
    "temperature": Kind(1e-3, 1e6, "K, °C, °F", "K", imperial="°F", written="20 °C"),
    "flow": Kind(
        0,
        1e18,
        "m3, dm3, l, cm3, ft3, in3 / s, min, h; US gal, imp gal, bbl / s, min, h, d; US gpm, imp gpm, cfm",
        "m^3/s",
        ("l/min", "m^3/h"),
        "m^3/h",
        "ft^3/min",
    ),
    "mass_flow": Kind(0, 1e18, f"{_MASSES} / s, min, h", "kg/s", "kg/h", "kg/h", "lb/h"),
    "molar_mass": Kind(
        1e-9, 1e6, "kg/mol, g/mol, kg/kmol", "kg/mol", "g/mol", written="28.96 g/mol"
    ),
    "gas_constant": Kind(1e-3, 1e9, "J/kg K, kJ/kg K, kgf m/kg K", "J/kg K", written="287 J/kg K"),
    "fuel": Kind(1e-15, 1e6, f"mg, {_MASSES}", "kg", ("mg", "g", "kg"), "g", "lb", "35 mg"),
    "heating_value": Kind(
        0,
        1e12,
        "J/kg, kJ/kg, MJ/kg, kcal/kg, Btu/lb",
        "J/kg",
        "MJ/kg",
        "kcal/kg",
        "Btu/lb",
        "42.7 MJ/kg",
    ),
    "viscosity": Kind(
        1e-6,
        1e3,
        "Pa s, mPa s, cP, P, N s/m2, kgf s/m2, lbf s/in2, reyn",
        "Pa s",
        "mPa s",
        "cP",
        "reyn",
        "30 mPa s",
    ),
    "film": Kind(1e-12, 1e9, _LENGTHS, "m", "um", "um", "in", "3 um"),
    "spring": Kind(
        1e-15,
        1e3,
        f"mm, cm, m, in / {_PRESSURES}, lb/in2, lb/ft2; mm/kgf/cm2, cm/kgf/cm2",
        "m/Pa",
        "mm/bar",
        "mm/at",
        "in/psi",
        "6 mm/at",
    ),
    "ratio": Kind(1e-15, 1e15, "", ""),
}
"""A value may be 0, and of either sign. An angle of 1e6° is known to 1e-10°; beyond, nothing of it would be left."""

DiagramPoint = tuple[float, ...]
"""Numbers of a diagram: two, or three."""

MOST_POINTS = 500_000
"""Points or samples of one diagram."""
MOST_ITEMS = 100
"""Items of one list, such as cylinders."""
MOST_SHAFT_ITEMS = 400
"""Items of a shaft line: masses, and the segments between them."""


def range_of(kind: str) -> str:
    """Return the sizes that a value of this kind may have.

    >>> range_of("length")
    '0 or 1e-09 to 1e+09 m'
    """
    smallest, largest, _, unit, *_ = KINDS[kind]
    lower = f"0 or {smallest:g}" if smallest else "0"
    return f"{lower} to {largest:g} {unit}".rstrip()


GRAVITY = 9.80665
"""m/s²; makes kgf and at exact."""
_INCH = 0.0254
_POUND = 0.45359237
_LBF = _POUND * GRAVITY
_MMHG = 133.322387415

_FACTORS: dict[str, UnitFactor] = {
    # length in m, volume in m³, mass in kg, time in s, frequency in Hz
    "m": (1, 1),
    "in": (254, 1e4),
    "ft": (3048, 1e4),
    "l": (1, 1e3),
    "ml": (1, 1e6),
    "cc": (1, 1e6),
    "US_gal": (3785411784, 1e12),
    "imp_gal": (454609, 1e8),
    "bbl": (158987294928, 1e12),
    "kg": (1, 1),
    "g": (1, 1e3),
    "t": (1e3, 1),
    "tonne": (1e3, 1),
    "lb": (_POUND, 1),
    "long_ton": (2240 * _POUND, 1),
    "short_ton": (2e3 * _POUND, 1),
    "s": (1, 1),
    "min": (60, 1),
    "h": (3600, 1),
    "d": (86400, 1),
    "Hz": (1, 1),
    # temperature in K, see `_ZEROS`
    "K": (1, 1),
    "°C": (1, 1),
    "°F": (5, 9),
    # flow in m³/s
    "US_gpm": (3785411784, 60e12),
    "imp_gpm": (454609, 60e8),
    "cfm": (3048**3, 60e12),
    "mol": (1, 1),
    "kmol": (1e3, 1),
    # angle and revolutions, but for those of `_ELSEWHERE`
    **dict.fromkeys(("rad", "deg", "°", "rps", "U", "rev", "r", "1"), (1, 1)),
    "rpm": (1, 60),
    # force in N, pressure in Pa
    "N": (1, 1),
    "kgf": (GRAVITY, 1),
    "kp": (GRAVITY, 1),
    "tf": (1e3 * GRAVITY, 1),
    "lbf": (_LBF, 1),
    "long_tonf": (2240 * _LBF, 1),
    "short_tonf": (2e3 * _LBF, 1),
    "Pa": (1, 1),
    "bar": (1e5, 1),
    "at": (98066.5, 1),
    "atm": (101325, 1),
    "psi": (_LBF, _INCH * _INCH),
    "Torr": (101325, 760),
    "mmHg": (_MMHG, 1),
    "cmHg": (10 * _MMHG, 1),
    "inHg": (25.4 * _MMHG, 1),
    "mmH2O": (GRAVITY, 1),
    "cmH2O": (10 * GRAVITY, 1),
    "inH2O": (25.4 * GRAVITY, 1),
    "mWS": (GRAVITY * 1e3, 1),
    # torque in N m, energy in J, power in W
    "Nm": (1, 1),
    "J": (1, 1),
    "kcal": (4186.8, 1),
    "Btu": (4186.8 * _POUND * 5, 9),
    "W": (1, 1),
    "PS": (75 * GRAVITY, 1),
    # viscosity in Pa s
    "P": (1, 10),
    "cP": (1, 1e3),
    "reyn": (_LBF, _INCH * _INCH),
    "hp": (550 * _LBF * 3048, 1e4),
}
"""Single units, of which those of every kind are made."""

_PREFIXES: dict[str, UnitFactor] = {
    "G": (1e9, 1),
    "M": (1e6, 1),
    "k": (1e3, 1),
    "h": (1e2, 1),
    "d": (1, 10),
    "c": (1, 1e2),
    "m": (1, 1e3),
    "u": (1, 1e6),
}
for _name in ("m", "g", "Hz", "N", "Pa", "bar", "Nm", "J", "W"):
    _multiplier, _divisor = _FACTORS[_name]
    for _prefix, (_more, _less) in _PREFIXES.items():
        _FACTORS.setdefault(_prefix + _name, (_more * _multiplier, _less * _divisor))

_ZEROS = {"°C": 273.15, "°F": 459.67}
"""Temperatures that count from elsewhere than from absolute zero, and by how many of their degrees."""
_DEGREES: dict[str, UnitFactor] = {"rad": (180, math.pi)}
_POUND_OF_FORCE: dict[str, UnitFactor] = {"lb": (_LBF, 1)}
_ELSEWHERE: dict[str, dict[str, UnitFactor]] = {
    **dict.fromkeys(("angle", "volume_rise", "energy_rise"), _DEGREES),
    # only a force gives a pressure or a torque: there the pound of everyday English can mean nothing else
    **dict.fromkeys(("pressure", "stress", "torque", "spring", "spring_rate"), _POUND_OF_FORCE),
    "pressure_rise": {**_DEGREES, **_POUND_OF_FORCE},
    "speed": {"rad": (1, 2 * math.pi)},
    "stiffness": {"deg": (math.pi, 180)},
    "gd2": {"kgf": (1, 1), "kp": (1, 1), "tf": (1e3, 1), "N": (1, GRAVITY)},
}
"""Kind -> single units that mean something else in it. GD2 = 4J counts in kg m2: 1 kgf is the weight of 1 kg."""


ZEROED_UNITS = {
    "psia": ("absolute", "psi"),
    "psig": ("gauge", "psi"),
    "bara": ("absolute", "bar"),
    "barg": ("gauge", "bar"),
    "mbara": ("absolute", "mbar"),
    "mbarg": ("gauge", "mbar"),
    "kPaa": ("absolute", "kPa"),
    "kPag": ("gauge", "kPa"),
    "MPaa": ("absolute", "MPa"),
    "MPag": ("gauge", "MPa"),
    "ata": ("absolute", "at"),
    "atü": ("gauge", "at"),
    "atu": ("gauge", "at"),
}
"""Pressure units that name what they count from, and the unit without. So do `bar abs`, `bar(g)`, of every unit."""
_ZEROS_BY_ENDING = {
    "abs": "absolute",
    "absolute": "absolute",
    "(a)": "absolute",
    "(abs)": "absolute",
    "gauge": "gauge",
    "(g)": "gauge",
}


def zero_and_unit(unit: str) -> tuple[str, str]:
    """Return the zero that a unit of pressure names, 'absolute' or 'gauge', '' for none, and the unit without it.

    >>> zero_and_unit("psia"), zero_and_unit("bar abs"), zero_and_unit("kPa (g)"), zero_and_unit("at")
    (('absolute', 'psi'), ('absolute', 'bar'), ('gauge', 'kPa'), ('', 'at'))
    """
    name = keyboard_text(unit)
    if name in ZEROED_UNITS:
        return ZEROED_UNITS[name]
    for ending, zero in _ZEROS_BY_ENDING.items():
        plain = name.removesuffix(ending).rstrip()
        is_apart = ending.startswith("(") or name.endswith(f" {ending}")
        if plain and plain != name and is_apart:
            return zero, plain
    return "", name


def other_zero(unit: str, zero: str, what: str) -> str:
    """Return the message if a unit of pressure names another zero than `what` has, '' if it does not.

    zero: `absolute`, `gauge`, or '' of a difference of pressures.

    >>> other_zero("7 bara".split()[1], "gauge", "p_max")
    "'bara' is absolute, but p_max is gauge; write the gauge pressure in bar"
    """
    named, plain = zero_and_unit(unit)
    if named in ("", zero):
        return ""
    if not zero:
        return f"'{unit}' is {named}, but {what} has no zero; write the unit {plain}"
    return f"'{unit}' is {named}, but {what} is {zero}; write the {zero} pressure in {plain}"


@cache
def _names_of(kind: str) -> tuple[str, ...]:
    """Return the names of the units of a kind."""
    names: list[str] = []
    for listed in KINDS[kind].units.split("; "):
        product = re.fullmatch(r"(.*) ([*/]) (.*)", listed)
        if product is None:
            names += listed.split(", ")
            continue
        sign = "/" if product[2] == "/" else " "
        for first in product[1].split(", "):
            names += [first + sign + second for second in product[3].split(", ")]
    return tuple(dict.fromkeys(names))


_WORDS_OF_NAME = re.compile("(long|short|US|imp) ")
"""First words of units of two words; in `_FACTORS` they are joined by `_`."""


def _factor(unit: str, kind: str) -> UnitFactor:
    """Return multiplier and divisor of a product of single units, such as `kgf m/s/cm2`."""
    if kind == "spring":  # height over pressure, which may be a quotient itself
        height, _, pressure = unit.partition("/")
        multiplier, divisor = _factor(height, "length")
        pressure_multiplier, pressure_divisor = _factor(pressure, "pressure")
        return multiplier * pressure_divisor, divisor * pressure_multiplier
    multiplier = 1.0
    divisor = 1.0
    for slash, text in re.findall(r"(/?)([^ /]+)", _WORDS_OF_NAME.sub(r"\1_", unit)):
        base, digits = re.findall(r"^(.*?\D|1)(-?\d)?$", text)[0]
        factor = _ELSEWHERE.get(kind, {}).get(base) or _FACTORS.get(base)
        if factor is None:
            raise LookupError(
                f"the unit '{base}' in {unit} of the kind {kind} has no factor: add its multiplier and divisor "
                "to _FACTORS of kurbel.declared.units, or take it out of KINDS"
            )
        more, less = factor
        power = int(digits or 1)
        is_divisor = (power < 0) != bool(slash)
        if is_divisor:
            more, less = less, more
        multiplier *= more ** abs(power)
        divisor *= less ** abs(power)
    return multiplier, divisor


_SAME_SIGNS = (
    ("⁻¹", "-1"),
    ("²", "2"),
    ("³", "3"),
    ("^", ""),
    ("·", " "),
    ("*", " "),
    ("µ", "u"),
    ("μ", "u"),
)
"""Signs of units, and how they are written here."""


_MARKS = {
    **dict.fromkeys(("'", "′", "’"), "ft"),
    **dict.fromkeys(("''", '"', "″", "”", "′′", "’’"), "in"),
}
"""How feet and inches are marked on drawings."""


def normal_unit(unit: str) -> str:
    """Write `kg·m²`, `kg*m^2` and `kg  m2` alike."""
    unit = keyboard_text(unit)
    for sign, same in _SAME_SIGNS:
        unit = unit.replace(sign, same)
    unit = unit.replace("/(kg K)", "/kg K")
    unit = re.sub(r"\bdeg ?(?=[CF]$)", "°", unit)
    unit = re.sub(r" (?=(H2O|Hg)\b)", "", unit)
    unit = re.sub(r"\b(foot|feet)\b", "ft", unit)
    unit = re.sub(r"\binch(es)?\b", "in", unit)
    unit = _MARKS.get(unit, unit)
    return re.sub(r"\s*/\s*", "/", " ".join(unit.split()))


@cache
def unit_factor(unit: str, kind: str) -> UnitFactor:
    """Return multiplier and divisor that turn a value in `unit` into the base of `kind`.

    Raises UnitError with the known units and, where the unit is one of another kind, that kind.
    """
    names = _names_of(kind)
    name = normal_unit(unit)
    if kind == "pressure":
        _, name = zero_and_unit(name)
    if name in names:
        return _factor(name, kind)
    usual = listed_units(kind)
    listed = ", ".join(usual[:8])
    if len(usual) > 8:
        listed += ", …"
    hint = unit_hint(name, kind)
    raise UnitError(f"unknown {kind_name(kind)} unit '{unit.strip()}' (known: {listed}){hint}")


def kind_name(kind: str) -> str:
    """Return what a kind is called in messages."""
    special = {
        "gd2": "GD²",
        "speed": "speed of rotation",
        "unbalance": "mass-times-radius",
        "film": "film thickness",
    }
    return special.get(kind, kind.replace("_", " "))


_FRACTION = r"(?:([0-9]{1,4})[ -])?([0-9]{1,4})/([1-9][0-9]{0,3})"
_INCHES = rf"([-+]?){_FRACTION}(?=\s*[A-Za-z\"'″′”’]|$)"
"""A number as drawings in inches have it: 2 1/4, 2-1/4, 3/8."""
FEET_AND_INCHES = (
    r"([-+]?)([0-9]{1,6}) ?(?:ft|feet|foot|['′’])[ -]{0,3}"
    rf"(?:{_FRACTION}|([0-9]{{1,4}}(?:\.[0-9]*)?)) ?(?:in|inch|inches|''|[\"″”])"
)
"""Feet and inches: 5 ft 6 in, 5' 6", 5'-6 1/2"."""
_FEET_AND_INCHES = re.compile(FEET_AND_INCHES)
_QUOTIENT = rf"{NUMBER.pattern}\s*/\s*{NUMBER.pattern}(?=\s*[A-Za-z°]|$)"


def split_quantity(text: str) -> tuple[float, str] | None:
    """Return number and unit of a value in plain signs, None where it begins with no number.

    >>> split_quantity("5.4 at"), split_quantity("2 1/4 in"), split_quantity("12 ft 6 in"), split_quantity("1/80")
    ((5.4, 'at'), (2.25, 'in'), (150.0, 'in'), (0.0125, ''))
    """
    feet_and_inches = _FEET_AND_INCHES.fullmatch(text)
    if feet_and_inches:
        sign, feet, inch, numerator, denominator, inches = feet_and_inches.groups()
        value = 12 * int(feet) + float(inches or inch or 0)
        if numerator:
            value += int(numerator) / int(denominator)
        return float(f"{sign}1") * value, "in"
    if "/" in text:
        fraction = re.match(_INCHES, text)
        if fraction:
            sign, inch, numerator, denominator = fraction.groups()
            parts = int(inch or 0) * int(denominator) + int(numerator)
            value = float(f"{sign}1") * parts / int(denominator)
            return value, text[fraction.end() :].strip()
        quotient = re.match(_QUOTIENT, text)
        if quotient:
            return parse_ratio(quotient.group()), text[quotient.end() :].strip()
    number = NUMBER.match(text)
    if number is None:
        return None
    return float(number.group()), text[number.end() :].strip()


def parse_quantity(text: str, kind: str, is_difference: bool = False) -> float:
    """Return the value of `text`, a number with a unit, in the base of `kind`; a ratio has none.

    is_difference: it is one of two values, so that its unit counts from its own zero.

    >>> parse_quantity("450 mm", "length"), parse_quantity("1/80", "ratio")
    (0.45, 0.0125)
    >>> parse_quantity("2 °C", "temperature"), parse_quantity("2 °C", "temperature", is_difference=True)
    (275.15, 2.0)

    Raises UnitError when there is no number, no unit, or a unit of another kind.
    """
    if kind == "ratio":
        return parse_ratio(text)
    stripped = keyboard_text(text)
    number_and_unit = split_quantity(stripped)
    expected = f"expected a number with its unit, such as '{kind_example(kind)}'"
    if number_and_unit is None:
        raise UnitError(f"{expected}, got '{text}'")
    value, unit = number_and_unit
    # what is no unit after the number
    if not unit:
        fitting = _fitting_unit(value, kind)
        raise UnitError(
            f"{stripped} has no unit; write it with one, such as '{stripped} {fitting}'"
        )
    if re.match(r",[0-9]+(?![0-9.,])", unit):
        raise UnitError(f"'{stripped}' has a decimal comma; write {stripped.replace(',', '.', 1)}")
    if re.match(",[0-9]", unit):
        raise UnitError(f"'{stripped}' has commas between thousands; leave them out")
    if re.match("[0-9]{3}(?![0-9])", unit):
        raise UnitError(f"'{stripped}' has spaces between thousands; leave them out")
    if unit[0] in "0123456789._:" and not unit.startswith("1/"):
        raise UnitError(f"{expected}, got '{stripped}'")
    # its value in the base
    multiplier, divisor = unit_factor(unit, kind)
    zero = 0.0 if is_difference else zero_of(unit)
    in_base = (value + zero) * multiplier / divisor
    if not math.isfinite(in_base):
        raise UnitError(f"{stripped} is too large to compute with")
    return in_base


def zero_of(unit: str) -> float:
    """Return how far below its 0 a unit has the 0 of its base, in that unit: 273.15 of °C, 0 of most."""
    if unit[-1:] not in "CF":
        return 0.0
    return _ZEROS.get(normal_unit(unit), 0.0)


def step_unit(unit: str) -> str:
    """Return the unit in which differences of values in a unit are written, itself of most.

    >>> step_unit("bara"), step_unit("°C"), step_unit("mm")
    ('bar', 'K', 'mm')
    """
    zero, plain = zero_and_unit(unit)
    if zero:
        return plain
    return "K" if normal_unit(unit) == "°C" else unit


_FITTING = {
    "length": (("mm", 10), ("m", 0)),
    "pressure": (("Pa", 1e4), ("kPa", 500), ("bar", 0)),
    "stress": (("Pa", 1e5), ("N/mm2", 0)),
    "power": (("W", 1e3), ("kW", 0)),
    "speed": (("rpm", 10), ("rps", 0)),
}
"""Kind -> units with the bare numbers from which on they are likely, the largest first."""


def _fitting_unit(value: float, kind: str) -> str:
    """Return the unit that a bare number was probably meant in."""
    for unit, least in _FITTING.get(kind, ()):
        if abs(value) >= least:
            return unit
    return unit_example(kind)


def written_unit(text: str) -> str:
    """Return the unit of a value, as written; '%' of a percentage, '' of a bare number.

    >>> written_unit("5.4 at"), written_unit("2 1/4 in"), written_unit("2 %"), written_unit("1/200")
    ('at', 'in', '%', '')
    """
    _, unit = split_quantity(keyboard_text(text)) or (0.0, "")
    return "" if re.match(r"/\s*[0-9.]", unit) else unit


def kind_example(kind: str) -> str:
    """Return a value of this kind as a person would write it, for messages and for the schema."""
    return KINDS[kind].written or f"10 {normal_unit(KINDS[kind].si)}"


def unit_example(kind: str) -> str:
    """Return its unit."""
    return kind_example(kind).partition(" ")[2]


def kinds() -> tuple[str, ...]:
    """Return the kinds of quantities that have units."""
    return tuple(name for name, kind in KINDS.items() if kind.units)


def unit_names(kind: str) -> tuple[str, ...]:
    """Return the units of a kind in the spelling that messages and the schema use."""
    names = _names_of(kind)
    if kind != "pressure":
        return names
    return (*names, *ZEROED_UNITS)


_SELDOM = {
    "um, km or dm in a product": r"(?=.*[ /]).*\b(um|km|dm)[23]?\b",
    "inches with other units than pounds": r"(?=.*\b(in|ft)2?\b).*\b(k?Nm?|MN|kgf|kp|tf|m?g|kg|t)\b",
    "pounds with metres": r"(?=.*\blbf?\b).*[ /](m|mm|cm)2?\b",
    "large forces by small levers": r"MN [mc]m\b|MN/[mc]m2",
    "slow speeds": r"(m|mm|cm|in|ft)/h",
    "pressures of laboratories in a quotient": r".*\b(GPa|hPa|atm|Torr|.mHg|inHg|.mH2O|inH2O|mWS)/",
    "springs of laboratories": r"(mm|cm|m|in)/(GPa|hPa|atm|Torr|.mHg|inHg|.mH2O|inH2O|mWS)",
    "springs in metres, or of both systems": r"m/([kM]?Pa|m?bar|at|psi|lb/)|in/([kM]?Pa|m?bar|at)$|[mc]m/(psi|lb/)",
}
"""Units that are read but not listed, and why."""
_SELDOM_UNIT = re.compile("|".join(f"(?:{pattern})" for pattern in _SELDOM.values()))
_USUAL = ("kg/dm3", "dm3/s", "km/h", "km/s", "um/s")


def listed_units(kind: str) -> tuple[str, ...]:
    """Return the units of a kind that people write: products such as kN/in2 are read, too."""
    listed = []
    for name in unit_names(kind):
        if name in _USUAL or not _SELDOM_UNIT.match(name):
            listed.append(name)
    return tuple(listed)


_SPOKEN = (
    (r"\b(cu|cubic) ?(ft|in)\b", r"\g<2>3"),
    (
        r"\b(upm|umin|u\.?p\.?m\.?|r\.p\.m\.?|rpms|(turns|revs?|revolutions|rotations)( per |/)min(ute)?)$",
        "rpm",
    ),
    (r"\b(turns|revs|revolutions|rotations)( per |/)s(econd)?$", "rev/s"),
    (r"^1?/min(ute)?$", "1/min"),
    (r"^1?/s(econd)?$", "1/s"),
    (r"\bhertz\b", "Hz"),
    (r"\b(barrels?|bbls)\b", "bbl"),
    (r"\bpounds?\b", "lb"),
    (r"\b(lbf?|kg|in|ft|mm|cm)s\b", r"\1"),
)
"""How people write some units, and what these are here."""

_KINEMATIC = ("mm2/s", "cm2/s", "m2/s", "cSt", "St", "ft2/s", "in2/s")
"""Units of kinematic viscosity, by which oils are sold."""


def unit_hint(name: str, kind: str) -> str:
    """Return what to write instead of a unit, of which the white space is that of ours; '' where nothing is known."""
    if kind == "length" and re.fullmatch(r"(ft|['′’])[ -]*[0-9].*", name):
        return "; write feet and inches as '7 ft 6 in', or in one unit: '90 in'"
    if kind == "viscosity" and name in _KINEMATIC:
        return (
            f"; {name} is a unit of kinematic viscosity; times the density it is the dynamic one: "
            "100 mm2/s · 0.88 kg/dm3 = 88 mPa s"
        )
    if kind == "spring":
        return "; it is height over pressure: a spring of 60 lb per inch is '1/60 in/psi'"
    gallons = re.fullmatch(r"(gal|gallons?|gpm)(/.*)?", name)
    if gallons:
        unit = gallons[1] if gallons[1] == "gpm" else "gal"
        rest = gallons[2] or ""
        return (
            f"; a gallon is 'US gal' (3.785 l) or 'imp gal' (4.546 l): "
            f"write 'US {unit}{rest}' or 'imp {unit}{rest}'"
        )
    if name in ("ton", "tons", "tonf"):
        f = "f" if name == "tonf" else ""
        return (
            f"; a ton is 't{f}' (1000 kg{f}), 'long ton{f}' (2240 lb{f}) "
            f"or 'short ton{f}' (2000 lb{f}): write which"
        )
    # a mass in place of a force
    units = unit_names(kind)
    weight = re.sub(r"\bkg\b", "kgf", name)
    if weight != name and weight in units:
        return f"; kg is a mass, write '{weight}'"
    # as people say it, or in the wrong case
    written_name = name
    for spoken, written in _SPOKEN:
        written_name = re.sub(spoken, written, written_name, flags=re.IGNORECASE)
    for unit in units:
        if unit.lower() == written_name.lower():
            return f"; did you mean '{unit}'?"
    number = NUMBER.match(name)
    if number:
        return f"; write the unit alone, without {number.group()}"
    if kind == "speed" and name == "min":
        return "; did you mean '1/min'?"
    # a unit of another kind
    for other in kinds():
        names = unit_names(other)
        if name in names or written_name in names:
            return f"; {name} is a unit of {kind_name(other)}"
    return ""
