"""Every kind of quantity: the sizes that a machine file may hold, its units, and how a value is read.

The sizes are far outside of what was ever built and far inside of what floats can be computed with, so that no square
and no quotient of values from a file leaves their range. They hold for the file and for records made in Python.
"""

import math
import re
from collections.abc import Callable, Iterable
from functools import cache
from typing import Any, NamedTuple

from kurbel.declared.numerals import NUMBER, parse_ratio, plain
from kurbel.errors import Fault, Path, UnitError

Factor = tuple[float, float]
"""A unit as multiplier and divisor of its base, so that 450 mm becomes 450 / 1000, correctly rounded."""


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

Point = tuple[float, float]

MOST_POINTS = 500_000
"""Points or samples of one diagram."""
MOST_ITEMS = 100
"""Items of one list, such as cylinders."""


def out_of_size(value: Any, kind: str) -> str:
    """Return in what way a value in the base of its kind, or any of many, is beyond what a machine file may hold.

    >>> out_of_size(1e-200, "length")
    'is too small; a length in a machine file is 0 or at least 1e-09 m'
    """
    import numpy as np

    smallest, largest, unit, *_ = KINDS[kind]
    if not np.all(abs(value) <= largest):
        return f"is too large; {_held(kind)} at most {largest:g} {unit}".rstrip()
    if np.any((value != 0) & (abs(value) < smallest)):
        return f"is too small; {_held(kind)} 0 or at least {smallest:g} {unit}".rstrip()
    return ""


def _held(kind: str) -> str:
    name = "bare number" if kind == "ratio" else kind.replace("_", " ")
    return f"{'an' if name[0] in 'aei' else 'a'} {name} in a machine file is"


def range_of(kind: str) -> str:
    """Return the sizes that a value of this kind may have.

    >>> range_of("length")
    '0 or 1e-09 to 1e+09 m'
    """
    smallest, largest, unit, *_ = KINDS[kind]
    return f"{f'0 or {smallest:g}' if smallest else '0'} to {largest:g} {unit}".rstrip()


def size_faults(points: list[Point], unit: Factor, kind: str, path: Path) -> list[Fault]:
    """Return a fault for the first point whose value in this unit of its kind is too large; [] where there is none."""
    up, down = unit
    largest = KINDS[kind].largest
    for index, (_, value) in enumerate(points):
        if not abs(value * up / down) <= largest:
            return [Fault((*path, index, 1), f"{value:g} {out_of_size(math.inf, kind)}")]
    return []


GRAVITY = 9.80665
"""m/s²; makes kgf and at exact."""
_INCH = 0.0254
_POUND = 0.45359237
_LBF = _POUND * GRAVITY
_MMHG = 133.322387415

_LENGTH: dict[str, Factor] = {
    "m": (1, 1),
    "mm": (1, 1e3),
    "cm": (1, 1e2),
    "dm": (1, 10),
    "um": (1, 1e6),
    "km": (1e3, 1),
    "in": (254, 1e4),
    "ft": (3048, 1e4),
}
_AREA = {f"{name}2": (up * up, down * down) for name, (up, down) in _LENGTH.items()}
_MASS: dict[str, Factor] = {"kg": (1, 1), "g": (1, 1e3), "t": (1e3, 1), "lb": (_POUND, 1)}
_FORCE: dict[str, Factor] = {
    "N": (1, 1),
    "kN": (1e3, 1),
    "MN": (1e6, 1),
    "kgf": (GRAVITY, 1),
    "kp": (GRAVITY, 1),
    "tf": (1e3 * GRAVITY, 1),
    "lbf": (_LBF, 1),
}
_TIME: dict[str, Factor] = {"s": (1, 1), "min": (60, 1), "h": (3600, 1)}


def _product(first: dict[str, Factor], second: dict[str, Factor], joint: str) -> dict[str, Factor]:
    """Return every unit of `first` times (joint " ") or over (joint "/") every unit of `second`."""
    over = joint == "/"
    return {
        f"{a}{joint}{b}": (au * (bd if over else bu), ad * (bu if over else bd))
        for a, (au, ad) in first.items()
        for b, (bu, bd) in second.items()
    }


_PRESSURE: dict[str, Factor] = {
    "Pa": (1, 1),
    "kPa": (1e3, 1),
    "MPa": (1e6, 1),
    "GPa": (1e9, 1),
    "hPa": (1e2, 1),
    "mbar": (1e2, 1),
    "bar": (1e5, 1),
    "at": (98066.5, 1),
    "atm": (101325, 1),
    "psi": (_LBF, _INCH * _INCH),
    "Torr": (101325, 760),
    "mmHg": (_MMHG, 1),
    "inHg": (25.4 * _MMHG, 1),
    "mWS": (GRAVITY * 1e3, 1),
}
_TORQUE: dict[str, Factor] = {"Nm": (1, 1), "kNm": (1e3, 1)}
_POUNDS_OF_FORCE = {"lb/in2": (_LBF, _INCH * _INCH), "lb/ft2": (_LBF * 1e8, 3048 * 3048)}
"""Only a force gives a pressure or a torque: there the pound of everyday English can mean nothing else."""
_POUND_FEET = {
    f"{a} {b}": (_LBF * up, down)
    for c, up, down in (("ft", 3048, 1e4), ("in", 254, 1e4))
    for a, b in (("lb", c), (c, "lb"), (c, "lbf"))
}

_PER_ANGLE: dict[str, Factor] = {"deg": (1, 1), "rad": (180, math.pi)}

_BUILDERS: dict[str, Callable[[], dict[str, Factor]]] = {
    "length": lambda: _LENGTH,
    "area": lambda: _AREA,
    "mass": lambda: {**_MASS, "tonne": (1e3, 1), "long ton": (2240 * _POUND, 1), "short ton": (2e3 * _POUND, 1)},
    "force": lambda: {**_FORCE, "long tonf": (2240 * _LBF, 1), "short tonf": (2e3 * _LBF, 1)},
    "pressure": lambda: {**_PRESSURE, **_product(_FORCE, _AREA, "/"), **_POUNDS_OF_FORCE},
    "stress": lambda: {"N/mm2": (1e6, 1), **_product(_FORCE, _AREA, "/"), **_PRESSURE, **_POUNDS_OF_FORCE},
    "time": lambda: _TIME,
    "angle": lambda: {"deg": (1, 1), "°": (1, 1), "rad": (180, math.pi)},
    "speed": lambda: {
        "1/s": (1, 1),
        **dict.fromkeys(("rpm", "1/min", "U/min", "rev/min", "r/min", "min-1"), (1, 60)),
        **dict.fromkeys(("rps", "s-1", "Hz"), (1, 1)),
        "rad/s": (1, 2 * math.pi),
    },
    "frequency": lambda: {"Hz": (1, 1), "1/s": (1, 1), "kHz": (1e3, 1), "1/min": (1, 60)},
    "angular_velocity": lambda: {"rad/s": (1, 1)},
    "angular_acceleration": lambda: {"rad/s2": (1, 1)},
    "velocity": lambda: _product(_LENGTH, _TIME, "/"),
    "acceleration": lambda: _product(_LENGTH, {"s2": (1, 1)}, "/"),
    "torque": lambda: {**_product(_FORCE, _LENGTH, " "), **_TORQUE, **_POUND_FEET},
    "energy": lambda: {"J": (1, 1), "kJ": (1e3, 1), "MJ": (1e6, 1), **_product(_FORCE, _LENGTH, " "), "Nm": (1, 1)},
    "power": lambda: {
        "W": (1, 1),
        "kW": (1e3, 1),
        "MW": (1e6, 1),
        "PS": (75 * GRAVITY, 1),
        "hp": (550 * _LBF * 3048, 1e4),
        "kgf m/s": (GRAVITY, 1),
    },
    "inertia": lambda: {
        **_product(_MASS, _AREA, " "),
        **{f"lbf {name} s2": (_LBF * up, down) for name, (up, down) in _LENGTH.items() if name in ("in", "ft")},
    },
    "unbalance": lambda: _product({**_MASS, "mg": (1, 1e6)}, _LENGTH, " "),
    "gd2": lambda: {
        **_product({"kg": (1, 1), "t": (1e3, 1)}, {"m2": (1, 1), "cm2": (1, 1e4)}, " "),
        "kgf m2": (1, 1),
        "kp m2": (1, 1),
        "tf m2": (1e3, 1),
        "N m2": (1, GRAVITY),
        "lb ft2": (_POUND * 3048 * 3048, 1e8),
    },
    "stiffness": lambda: _product(
        {**_product(_FORCE, {"m": (1, 1), "mm": (1, 1e3), "ft": (3048, 1e4)}, " "), **_TORQUE}, {"rad": (1, 1)}, "/"
    ),
    "damping": lambda: (
        _product({**_product(_FORCE, {"m": (1, 1)}, " "), **_TORQUE}, {"s/rad": (1, 1)}, " ")
        | {"N m s/rad": (1, 1), "Nm s/rad": (1, 1), "kN m s/rad": (1e3, 1)}
        | {"N m s": (1, 1), "Nm s": (1, 1), "kN m s": (1e3, 1), "lbf ft s/rad": (_LBF * 3048, 1e4)}
    ),
    "density": lambda: {
        "kg/m3": (1, 1),
        "kg/dm3": (1e3, 1),
        "g/cm3": (1e3, 1),
        "t/m3": (1e3, 1),
        "lb/ft3": (_POUND * 1e12, 3048**3),
        "lb/in3": (_POUND * 1e12, 254**3),
    },
    "spring": lambda: (
        _product(
            {"mm": (1, 1e3), "cm": (1, 1e2), "m": (1, 1), "in": (254, 1e4)}, {**_PRESSURE, **_POUNDS_OF_FORCE}, "/"
        )
        | {f"{name}/kgf/cm2": (1, down * 98066.5) for name, down in (("mm", 1e3), ("cm", 1e2))}
    ),
    "volume": lambda: {
        "m3": (1, 1),
        "dm3": (1, 1e3),
        "l": (1, 1e3),
        "cm3": (1, 1e6),
        "mm3": (1, 1e9),
        "in3": (254**3, 1e12),
    },
    "volume_rise": lambda: _product({"m3": (1, 1), "cm3": (1, 1e6), "in3": (254**3, 1e12)}, _PER_ANGLE, "/"),
    "pressure_rise": lambda: _product({**_PRESSURE, **_POUNDS_OF_FORCE}, _PER_ANGLE, "/"),
    "pressure_velocity": lambda: {
        "W/m2": (1, 1),
        "N/mm2 m/s": (1e6, 1),
        "kgf m/s/cm2": (GRAVITY * 1e4, 1),
        "psi ft/s": (_LBF * 3048, _INCH * _INCH * 1e4),
    },
}
"""Kind -> its units. `gd2` counts in kg m2 of GD2 = 4J: a weight of 1 kgf is that of 1 kg."""


ZEROED_UNITS = {
    **{"psia": ("absolute", "psi"), "psig": ("gauge", "psi"), "bara": ("absolute", "bar"), "barg": ("gauge", "bar")},
    **{"ata": ("absolute", "at"), "atü": ("gauge", "at")},
}
"""Pressure units that name what they count from, and the unit without; machine files have them (`zeroed_units`)."""


@cache
def _units_of(kind: str) -> dict[str, Factor]:
    return _BUILDERS[kind]()


def _normal(unit: str) -> str:
    """Write `kg·m²`, `kg*m^2` and `kg  m2` alike."""
    unit = plain(unit)
    for sign, ours in (("⁻¹", "-1"), ("²", "2"), ("³", "3"), ("^", ""), ("·", " "), ("*", " "), ("µ", "u"), ("μ", "u")):
        unit = unit.replace(sign, ours)
    unit = re.sub(r"\binch(es)?\b", "in", re.sub(r"\b(foot|feet)\b", "ft", unit))
    return re.sub(r"\s*/\s*", "/", " ".join(unit.split()))


@cache
def unit_factor(unit: str, kind: str) -> Factor:
    """Return multiplier and divisor that turn a value in `unit` into the base of `kind`.

    Raises UnitError with the known units and, where the unit is one of another kind, that kind.
    """
    known = _units_of(kind)
    factor = known.get(_normal(unit))
    if factor is not None:
        return factor
    hint = unit_hint(_normal(unit), kind)
    raise UnitError(f"unknown {kind_name(kind)} unit '{unit.strip()}' (known: {_known_text(kind)}){hint}")


def kind_name(kind: str) -> str:
    """Return what a kind is called in messages."""
    return {"gd2": "GD²", "speed": "speed of rotation", "unbalance": "mass-times-radius"}.get(
        kind, kind.replace("_", " ")
    )


def _known_text(kind: str) -> str:
    names = list(_units_of(kind))
    return ", ".join(names[:8]) + (", …" if len(names) > 8 else "")


def parse_quantity(text: str, kind: str) -> float:
    """Return the value of `text`, a number with a unit, in the base of `kind`; a ratio has none.

    >>> parse_quantity("450 mm", "length"), parse_quantity("1/80", "ratio")
    (0.45, 0.0125)

    Raises UnitError when there is no number, no unit, or a unit of another kind.
    """
    if kind == "ratio":
        return parse_ratio(text)
    stripped = plain(text)
    number = _number_of(stripped)
    if not number:
        raise UnitError(f"expected a number with its unit, such as '{example(kind)}', got '{text}'")
    unit = stripped[number.end() :].strip()
    if not unit:
        fitting = f"{stripped} {_fitting_unit(_value(number), kind)}"
        raise UnitError(f"{stripped} has no unit; write it with one, such as '{fitting}'")
    if unit[0] in "0123456789.,_:":
        _refuse_more_figures(stripped, unit, kind)
    up, down = unit_factor(unit, kind)
    value = _value(number) * up / down
    if not math.isfinite(value):
        raise UnitError(f"{stripped} is too large to compute with")
    return value


def plain_quantities(texts: Iterable[str], kind: str) -> list[float] | None:
    """Return the values of texts in the base of `kind`; None where one is more than a decimal number and its unit.

    Such a one is to be read by itself. A bare number is one of the kind `ratio`.

    >>> plain_quantities(["450 mm", "0.5 m"], "length"), plain_quantities(["2 1/4 in"], "length")
    ([0.45, 0.5], None)
    """
    units = {"": (1, 1)} if kind == "ratio" else _units_of(kind)
    values = []
    for text in texts:
        number, _, unit = text.partition(" ")
        factor = units.get(unit)
        if factor is None or not NUMBER.fullmatch(number):
            return None
        values.append(float(number) * factor[0] / factor[1])
    return values if all(map(math.isfinite, values)) else None


def _refuse_more_figures(text: str, rest: str, kind: str) -> None:
    """Raise UnitError where figures go on in the rest of a text, behind its number; but for 1/s, which is a unit."""
    if re.match(r",[0-9]+(?![0-9.,])", rest):
        raise UnitError(f"'{text}' has a decimal comma; write {text.replace(',', '.', 1)}")
    if re.match(r",[0-9]", rest):
        raise UnitError(f"'{text}' has commas between thousands; leave them out")
    if re.match(r"[0-9]{3}(?![0-9])", rest):
        raise UnitError(f"'{text}' has spaces between thousands; leave them out")
    if rest[0] != "," and not rest.startswith("1/"):
        raise UnitError(f"expected a number with its unit, such as '{example(kind)}', got '{text}'")


def written_unit(text: str) -> str:
    """Return the unit that a value is written with, as it stands there; '%' of a percentage, '' of a bare number.

    >>> written_unit("5.4 at"), written_unit("2 1/4 in"), written_unit("2 %"), written_unit("1/200")
    ('at', 'in', '%', '')
    """
    stripped = plain(text)
    number = _number_of(stripped)
    unit = stripped[number.end() :].strip() if number else ""
    return "" if re.match(r"/\s*[0-9.]", unit) else unit


# compiled only where there is a stroke
_INCHES = r"([-+]?)(?:([0-9]{1,4})[ -])?([0-9]{1,4})/([1-9][0-9]{0,3})(?=\s*[A-Za-z]|$)"
"""A number as drawings in inches have it: 2 1/4, 2-1/4, 3/8."""
_QUOTIENT = rf"{NUMBER.pattern}\s*/\s*{NUMBER.pattern}(?=\s*[A-Za-z°]|$)"


def _number_of(text: str) -> re.Match[str] | None:
    parted = (re.match(_INCHES, text) or re.match(_QUOTIENT, text)) if "/" in text else None
    return parted or NUMBER.match(text)


def _value(number: re.Match[str]) -> float:
    """Return the float of a match of `_number_of`."""
    if number.re.pattern != _INCHES:
        return parse_ratio(number.group()) if number.re.pattern == _QUOTIENT else float(number.group())
    sign, whole, above, below = number.groups()
    return float(f"{sign}1") * (int(whole or 0) * int(below) + int(above)) / int(below)


def _fitting_unit(value: float, kind: str) -> str:
    """Return the unit that a bare number of this size was probably meant in."""
    for fitting, least in _FITTING.get(kind, ()):
        if abs(value) >= least:
            return fitting
    return unit_example(kind)


_FITTING = {
    "length": (("mm", 10), ("m", 0)),
    "pressure": (("Pa", 1e4), ("kPa", 500), ("bar", 0)),
    "stress": (("Pa", 1e5), ("N/mm2", 0)),
    "power": (("W", 1e3), ("kW", 0)),
    "speed": (("rpm", 10), ("1/s", 0)),
}
"""Kind -> units with the bare numbers from which on they are likely, the largest first."""


def example(kind: str) -> str:
    """Return a value of this kind as a person would write it, for messages and for the schema."""
    return KINDS[kind].written or f"10 {_normal(KINDS[kind].si)}"


def unit_example(kind: str) -> str:
    """Return its unit."""
    return example(kind).partition(" ")[2]


def kinds() -> tuple[str, ...]:
    """Return the kinds of quantities that have units."""
    return tuple(_BUILDERS)


def unit_names(kind: str) -> tuple[str, ...]:
    """Return the units of a kind in the spelling that messages and the schema use."""
    return (*_units_of(kind), *(ZEROED_UNITS if kind == "pressure" else ()))


_RARE = r"\b(um|km|dm)[23]?\b"
_WRITTEN = ("kg/dm3", "km/h", "km/s", "um/s")


def listed_units(kind: str) -> tuple[str, ...]:
    """Return the units of a kind that people write: products with micrometres, kilometres, decimetres are read, too."""
    rare = (name for name in unit_names(kind) if re.search(_RARE, name) and re.search("[ /]", name))
    left_out = set(rare) - set(_WRITTEN)
    return tuple(name for name in unit_names(kind) if name not in left_out)


_SPOKEN = (
    (r"''|[\"″”]", "in"),
    (r"['′’]", "ft"),
    (r"\bpounds?\b", "lb"),
    (r"\b(lbf?|kg|in|ft|mm|cm)s\b", r"\1"),
)
"""How people write some units, and what these are here."""


def unit_hint(name: str, kind: str) -> str:
    """Return what to write instead of a unit, of which the white space is that of ours; '' where nothing is known."""
    known = unit_names(kind)
    if kind == "length" and re.fullmatch(r"(ft|['′’])[ -]*[0-9].*", name):
        return "; write feet and inches in one unit, such as '90 in' for 7 ft 6 in"
    if kind == "spring":
        return "; it is height over pressure: a spring of 60 lb per inch is '1/60 in/psi'"
    if number := NUMBER.match(name):
        return f"; write the unit alone, without {number.group()}"
    if name in (*ZEROED_UNITS, "atu"):
        return "; whether a pressure is gauge or absolute is said by the key 'pressures'"
    if name in ("ton", "tons", "tonf"):
        f = name.removeprefix("ton").removeprefix("s")
        return f"; a ton is 't{f}' (1000 kg{f}), 'long ton{f}' (2240 lb{f}) or 'short ton{f}' (2000 lb{f}): write which"
    weight = re.sub(r"\bkg\b", "kgf", name)
    if weight != name and weight in known:
        return f"; kg is a mass, write '{weight}'"
    ours = _ours(name)
    if alike := [unit for unit in known if unit.lower() == ours.lower()]:
        return f"; did you mean '{alike[0]}'?"
    of = [kind_name(other) for other in kinds() if {name, ours} & {*unit_names(other)}]
    return f"; {name} is a unit of {of[0]}" if of else ""


def _ours(name: str) -> str:
    """Return a unit as it is written here, where people write it otherwise."""
    for spoken, ours in _SPOKEN:
        name = re.sub(spoken, ours, name, flags=re.IGNORECASE)
    return name
