"""Laws that hold for every machine, on random files and on those that are shipped.

    python benchmarks/metamorphic.py [COUNT [SEED [LAW …]]]

batch      two keys of a file vary at once; four rows are computed together and each by itself
units      the same file with other units
like       with a cylinder that is `like` another one written out
scale      lengths four times as large, times twice, masses 64 times: gravity and densities stay
cylinders  the same cylinders, all but the first in another order
case       what `--set` gives as a load case
csv        csv against json

Every difference above rounding is printed, and every fault of kurbel's own. Without a seed it is that of the day,
without laws all of them.
"""

from __future__ import annotations

import csv
import io
import json
import math
import re
import sys
import time
import traceback
from collections import Counter
from collections.abc import Iterator
from datetime import date
from pathlib import Path
from typing import Any

import numpy as np
import yaml
from click.testing import CliRunner
from random_files import machine_file

import kurbel
from kurbel.cli import kurbel as command_line
from kurbel.errors import KurbelError
from kurbel.machine_file.overrides import dotted, leaves, tree_of
from kurbel.machine_file.reader import machine_of
from kurbel.solver.case import Case

Random = np.random.Generator
HOME = Path(__file__).parent.parent
NUMBER = re.compile(r"(-?[0-9.]+(?:e[+-]?[0-9]+)?)(?: (.*))?")
COLUMNS = (
    *(
        "b_max",
        "c_max",
        "T_max",
        "S_max",
        "N_max",
        "P_max",
        "p_max",
        "work",
        "power",
        "mean_pressure",
        "friction_work",
    ),
    *(
        "dE",
        "delta",
        "J",
        "M_max",
        "M_mean",
        "omega_max",
        "F_free_max",
        "M_free_max",
        "M_roll_max",
        "F_free_best",
    ),
    *(
        "load_max",
        "load_mean",
        "unloaded_arc",
        "sigma_pin_max",
        "sigma_web_A_max",
        "flow_mean",
        "flow_max",
    ),
    *("volume_fluctuation", "capacity", "rod_compression_max", "reversal_angle", "frequency"),
)
"""Key values of every command, of which a machine has some."""
SLOW = 30.0
"""Seconds of CPU above which a machine is named."""
ROUNDING = 1e-9
"""Relative difference below which two runs agree: rounding, and searches that end within it."""


def numbers_of(text: str) -> list[tuple[str, float, str]]:
    """Return every key of a file whose value is a number, the number and its unit."""
    origin = machine_of(text).origin
    assert origin is not None
    found = []
    points = 0
    for path, value in leaves(tree_of(origin)):
        number = NUMBER.fullmatch(str(value))
        points += isinstance(path[-1], int)
        few_points = not isinstance(path[-1], int) or points <= 3
        if number and few_points and not {"limits", "expect"} & set(map(str, path)):
            found.append((dotted(path), float(number[1]), number[2] or ""))
    return found


def distance(value: Any, other: Any, size: float) -> float:
    """Return by how much two key values differ, relative to the larger of them and to this size."""
    if isinstance(value, tuple) or isinstance(other, tuple):
        if not (isinstance(value, tuple) and isinstance(other, tuple) and len(value) == len(other)):
            return math.inf
        return max((abs(a - b) / 360 for a, b in zip(value, other)), default=0.0)
    first = math.nan if value is None else float(value)
    second = math.nan if other is None else float(other)
    if math.isnan(first) or math.isnan(second):
        return 0.0 if math.isnan(first) and math.isnan(second) else math.inf
    return abs(first - second) / (max(abs(first), abs(second), size) or 1.0)


# a batch against its machines one by one


def batch_against_alone(text: str, random: Random) -> Iterator[str]:
    """Yield by how much four designs differ that are computed together and alone; two keys vary."""
    numbers = numbers_of(text)
    if len(numbers) < 2:
        return
    case = Case(machine_of(text))
    columns = [name for name in COLUMNS if has(case, name)]
    if not columns:
        return
    for _ in range(4):
        pair = [numbers[place] for place in random.choice(len(numbers), 2, replace=False)]
        inputs = {key: varied(value, unit, random) for key, value, unit in pair}
        try:
            together = kurbel.sweep(text, inputs, columns)
        except KurbelError:
            continue
        for row in range(4):
            alone = kurbel.sweep(
                text, {key: [texts[row]] for key, texts in inputs.items()}, columns
            )
            for name in together.keys() & alone.keys():
                if "residual" in name:
                    continue
                if name in ("failure", "keeps"):
                    if together[name][row] != alone[name][0]:
                        yield f"{inputs} row {row}: {name} {together[name][row]!r}, alone {alone[name][0]!r}"
                elif (apart := distance(together[name][row], alone[name][0], 0.0)) > ROUNDING:
                    yield (
                        f"{inputs} row {row}: {name} {together[name][row]!r}, alone {alone[name][0]!r}: {apart:.1e}"
                    )
            if together.keys() != alone.keys():
                only = sorted(together.keys() ^ alone.keys())
                yield f"{inputs} row {row}: columns {only} are in one of both only"


def varied(value: float, unit: str, random: Random) -> list[str]:
    """Return four values of a key near its own as texts; of a count, of an angle, and of 0 now and then far off."""
    if value.is_integer() and abs(value) < 20 and not unit:
        return [f"{value + step:g}" for step in (0, 1, 2, -1)]
    factors = (
        random.uniform(0.95, 1.05, 4) if random.random() < 0.8 else 10 ** random.uniform(-2, 1, 4)
    )
    if value == 0:
        factors, value = random.uniform(-1, 1, 4), 1.0
    return [f"{value * factor:.9g} {unit}".strip() for factor in factors.tolist()]


def has(case: Case, name: str) -> bool:
    """Return whether a machine has a key value."""
    try:
        with np.errstate(all="ignore"):
            return case[name] is not None
    except KurbelError:
        return False


# one machine, written in two ways

UNITS = {
    **{
        "m": ("mm", 1e3),
        "mm": ("m", 1e-3),
        "rpm": ("Hz", 1 / 60),
        "kg": ("g", 1e3),
        "bar": ("kPa", 1e2),
    },
    **{
        "N": ("kN", 1e-3),
        "N m": ("kN m", 1e-3),
        "deg": ("rad", math.pi / 180),
        "kg m2": ("t m2", 1e-3),
    },
    **{"N m/rad": ("kN m/rad", 1e-3), "kW": ("W", 1e3), "N/mm2": ("MPa", 1.0)},
}
"""Unit -> another one, and how many of it there are in one."""


def in_other_units(value: Any) -> Any:
    """Return the keys of a file with numbers in other units; a unit beside points stays."""
    if isinstance(value, dict):
        return {
            key: in_other_units(inner) if key not in ("limits", "expect") else inner
            for key, inner in value.items()
        }
    if isinstance(value, list):
        return [in_other_units(inner) for inner in value]
    number = NUMBER.fullmatch(value) if isinstance(value, str) else None
    if number is None or number[2] not in UNITS:
        return value
    unit, factor = UNITS[number[2]]
    return f"{float(number[1]) * factor!r} {unit}"


def written_out(keys: Any) -> Any:
    """Return the keys of a file in which no cylinder is `like` another one; None where there is none."""
    cylinders = keys.get("cylinders")
    if not isinstance(cylinders, list) or not any("like" in cylinder for cylinder in cylinders):
        return None
    by_name: dict[str, Any] = {}
    written = []
    for number, cylinder in enumerate(cylinders):
        name = cylinder.get("name", f"cylinder {number + 1}")
        model = by_name.get(cylinder.get("like"), {})
        own = {key: value for key, value in cylinder.items() if key != "like"}
        merged = {key: value for key, value in model.items() if key != "name"} | own
        by_name[name] = merged
        written.append(merged | {"name": name})
    return keys | {"cylinders": written}


class Repeated(yaml.SafeDumper):
    """Writes what is in several places in each of them: machine files have no aliases."""

    def ignore_aliases(self, data: Any) -> bool:
        return True


def text_of(keys: Any) -> str:
    """Return the text of a machine file with these keys."""
    return yaml.dump(keys, Dumper=Repeated, sort_keys=False)


COMMANDS = (
    "motion",
    "forces",
    "flywheel",
    "balance",
    "bearings",
    "harmonics",
    "stress",
    "torsion",
    "delivery",
)


def run(text: str, *arguments: str) -> Any:
    """Return the result of a command on this text."""
    return CliRunner().invoke(command_line, [*arguments, "-"], input=text)


def figures_of(
    output: str, with_units: bool = False, by_name: bool = False
) -> dict[str, list[Any]]:
    """Return the columns and key values of a document, by where they are in it.

    with_units: each begins with its unit; by_name: parts that have a name are found by it, not by their number.
    """
    document = json.loads(output)
    found: dict[str, list[Any]] = {}

    def gather(value: Any, place: str) -> None:
        if isinstance(value, list):
            for number, inner in enumerate(value):
                is_named = by_name and isinstance(inner, dict) and {"name", "id"} & inner.keys()
                gather(inner, place if is_named else f"{place}[{number}]")
        if not isinstance(value, dict):
            return
        name = f"{place}/{value.get('id') or value.get('name') or ''}"
        for key, inner in value.items():
            if key in ("values", "value"):
                values = inner if isinstance(inner, list) else [inner]
                unit = [value.get("unit", "")] if with_units else []
                found[name] = [*unit, *values]
            elif isinstance(inner, dict | list):
                gather(inner, f"{name}/{key}")

    gather(document, "")
    return found


_BY_ROUNDING = ("residual", "phi", "angle", "M_phase")
"""Parts of names that are not compared; the phase of a small order is that of its parts M_cos and M_sin, which are."""


def differences(
    first: dict[str, list[Any]], second: dict[str, list[Any]], tolerance: float
) -> Iterator[str]:
    """Yield where two documents have other figures; of a column relative to its largest one."""
    for name in sorted(first.keys() ^ second.keys()):
        yield f"{name} is in one of both only"
    for name in first.keys() & second.keys():
        if not any(word in name for word in _BY_ROUNDING):
            yield from values_apart(name, first[name], second[name], tolerance)


def values_apart(
    name: str, values: list[Any], others: list[Any], tolerance: float
) -> Iterator[str]:
    """Yield the first of the values of a column, or the key value, that differs."""
    if len(values) != len(others):
        yield f"{name}: {len(values)} and {len(others)} values"
        return
    numbers = [abs(value) for value in values if isinstance(value, int | float)]
    size = max(numbers, default=0.0)
    for value, other_value in zip(values, others):
        if isinstance(value, str) or isinstance(other_value, str):
            continue
        if (apart := distance(value, other_value, size)) > tolerance:
            yield f"{name}: {value!r} and {other_value!r}: {apart:.1e}"
            return


# the same machine in another size

_LENGTH, _TIME, _MASS = 4.0, 2.0, 64.0
"""Powers of two change no digit; L/T² and M/L³ stay, and with them gravity and densities."""
_FORCE = _MASS * _LENGTH / _TIME**2
_PRESSURE = _FORCE / _LENGTH**2
SCALES = {
    **dict.fromkeys(("m", "mm", "cm", "in", "ft"), _LENGTH),
    **dict.fromkeys(("l", "cm3"), _LENGTH**3),
    **dict.fromkeys(("s", "min", "h"), _TIME),
    **dict.fromkeys(("Hz", "rps", "rpm"), 1 / _TIME),
    **dict.fromkeys(("kg", "g", "t", "lb"), _MASS),
    **dict.fromkeys(("N", "kN", "MN", "kgf", "kp", "tf", "lbf"), _FORCE),
    **dict.fromkeys(
        ("Pa", "kPa", "MPa", "GPa", "bar", "mbar", "at", "atm", "psi", "inHg"), _PRESSURE
    ),
    **dict.fromkeys(("J", "kJ", "Nm", "kNm"), _FORCE * _LENGTH),
    **dict.fromkeys(("W", "kW", "PS", "hp"), _FORCE * _LENGTH / _TIME),
}
"""How many times as large a figure in such a unit becomes; one in another unit, such as degrees, stays."""
_FACTOR = re.compile(r"(/?) ?\(?([A-Za-z]+)\^?(\d?)\)?")
_ABSENT = {
    "ambient": f"{101325 * _PRESSURE!r} Pa",
    "shear_modulus": f"{82 * _PRESSURE!r} GPa",
    "vapour_pressure": f"{2339 * _PRESSURE!r} Pa",
}
"""What kurbel takes for keys that are absent, which has to grow, too."""
_OF_ANOTHER_SIZE = {"capacity_normal"}
"""Key values that refer to a fixed pressure."""


def scale_of(unit: str) -> float:
    """Return how many times as large a figure in a unit such as N/mm2 or kg m^2 becomes."""
    scale = 1.0
    is_divisor = False
    for over, name, power in _FACTOR.findall(unit):
        is_divisor = is_divisor or bool(over)
        factor = SCALES.get(name, 1.0) ** int(power or 1)
        scale = scale / factor if is_divisor else scale * factor
    return scale


def in_another_size(value: Any, key: str = "") -> Any:
    """Return the keys of a file of the machine in its other size."""
    if isinstance(value, dict):
        return sized(value, key)
    if isinstance(value, list):
        return [in_another_size(item, key) for item in value]
    number = NUMBER.fullmatch(value) if isinstance(value, str) else None
    if number is None or not number[2]:
        return value
    scale = scale_of(number[2])
    # the R of a gas is J/(kg K) and grows with J/kg; of a molar mass it is the divisor
    if key == "molar_mass":
        scale = _TIME**2 / _LENGTH**2
    return f"{float(number[1]) * scale!r} {number[2]}"


def sized(keys: dict[str, Any], name: str) -> dict[str, Any]:
    """Return the keys of a mapping in the other size: numbers beside a unit, and what is on paper, are other ones."""
    if name == "drawn":
        # the diagram on paper stays as it is
        spring = NUMBER.fullmatch(keys["spring"])
        assert spring
        return keys | {"spring": f"{float(spring[1]) / _PRESSURE!r} {spring[2]}"}
    larger = {
        key: in_another_size(value, key)
        for key, value in keys.items()
        if key not in ("limits", "expect")
    }
    if "drawn" in keys:
        larger |= {key: keys[key] for key in ("area", "mean_height") if key in keys}
    unit = keys.get("unit")
    if isinstance(unit, str):
        scale = scale_of(unit)
        numbers = {
            key: rows_times(value, scale, key)
            for key, value in keys.items()
            if key in ("points", "harmonics", "mean", *_LINES)
        }
        larger |= numbers
    if "diameter" in keys and "length" in keys and "stiffness" not in keys and name == "shaft":
        larger.setdefault("shear_modulus", _ABSENT["shear_modulus"])
    if name == "liquid":
        larger.setdefault("vapour_pressure", _ABSENT["vapour_pressure"])
    return larger


_LINES = ("expansion", "compression", "intake", "exhaust")
"""Lines of a card."""


def rows_times(value: Any, scale: float, key: str) -> Any:
    """Return a number, or the points or orders of a table, with all but its first column so many times as large."""
    if not isinstance(value, list):
        return value * scale
    return [[row[0], *(number * scale for number in row[1:])] for row in value]


def figures_apart(output: str, other: str) -> Iterator[str]:
    """Yield which figures of the machine in its other size are not those of the scale."""
    first, second = figures_of(output, with_units=True), figures_of(other)
    yield from (f"{place} is in one of both only" for place in sorted(first.keys() ^ second.keys()))
    for place in first.keys() & second.keys():
        unit, *values = first[place]
        if "residual" in place or any(name in place for name in _OF_ANOTHER_SIZE):
            continue
        scale = scale_of(unit)
        scaled = [value * scale if isinstance(value, float) else value for value in values]
        yield from values_apart(place, scaled, second[place], ROUNDING)


# the same cylinders in another order


def in_another_order(text: str, random: Random) -> tuple[str, bool] | None:
    """Return the file with all cylinders but the first in another order, and whether their places are known.

    None where there are fewer than three; cylinders at one place keep their order, which is that on the pin.
    """
    machine = machine_of(text)
    keys = yaml.safe_load(text)
    listed = keys.get("cylinders")
    if isinstance(listed, dict):
        listed = [listed["each"]] * len(machine.cylinders)
        keys = keys | {"cylinders": listed}
    else:
        keys = written_out(keys) or keys
    if not isinstance(listed, list) or len(listed) < 3:
        return None
    # where each is, and by which name the rest of the file calls it
    cylinders = list[dict[str, Any]]()
    for cylinder, own in zip(machine.cylinders, keys["cylinders"]):
        place = {
            "name": cylinder.name,
            "crank_position": f"{cylinder.crank_position!r} deg",
            "bank_angle": f"{cylinder.bank_angle!r} deg",
        }
        if cylinder.inclination is not None:
            place["inclination"] = f"{cylinder.inclination!r} deg"
        if cylinder.axial_position is not None:
            place["axial_position"] = f"{cylinder.axial_position!r} m"
        cylinders.append(own | place)
    places = [cylinder.get("axial_position") for cylinder in cylinders]
    order = (1 + random.permutation(len(cylinders) - 1)).tolist()
    for place in set(places):
        together = [number for number in order if places[number] == place]
        ranked = iter(sorted(together))
        order = [next(ranked) if places[number] == place else number for number in order]
    shuffled = [cylinders[number] for number in [0, *order]]
    keys = {key: value for key, value in keys.items() if key != "firing_order"}
    return text_of(keys | {"cylinders": shuffled}), None not in places


def ordered(text: str, random: Random) -> Iterator[str]:
    """Yield what differs where the cylinders are in another order."""
    another = in_another_order(text, random)
    if another is None:
        return
    other_text, has_places = another
    for command in COMMANDS:
        if command in ("bearings", "stress", "balance") and not has_places:
            continue
        plain = run(text, command, "-f", "json")
        other = run(other_text, command, "-f", "json")
        yield from own_fault(other, f"cylinders {command}")
        if (plain.exit_code == 0) != (other.exit_code == 0):
            yield (
                f"cylinders: {command} ends with {plain.exit_code} and {other.exit_code}: {other.stderr[-200:]}"
            )
        elif plain.exit_code == 0:
            first = figures_of(plain.stdout, by_name=True)
            second = figures_of(other.stdout, by_name=True)
            for line in differences(first, second, ROUNDING):
                yield f"cylinders: {command} {line}"


# the laws


def compared(text: str, other_text: str, name: str, differ: Any) -> Iterator[str]:
    """Yield what differs in any command between a file and another one."""
    for command in COMMANDS:
        plain = run(text, command, "-f", "json")
        yield from own_fault(plain, command)
        other = run(other_text, command, "-f", "json")
        yield from own_fault(other, f"{name} {command}")
        if (plain.exit_code == 0) != (other.exit_code == 0):
            yield f"{name}: {command} ends with {plain.exit_code} and {other.exit_code}: {other.stderr[-200:]}"
        elif plain.exit_code == 0:
            for line in differ(plain.stdout, other.stdout):
                yield f"{name}: {command} {line}"


def same_figures(output: str, other: str) -> Iterator[str]:
    """Yield where two documents have other figures."""
    return differences(figures_of(output), figures_of(other), ROUNDING)


def units(text: str, random: Random) -> Iterator[str]:
    """Yield what differs with other units."""
    return compared(text, text_of(in_other_units(yaml.safe_load(text))), "units", same_figures)


def like(text: str, random: Random) -> Iterator[str]:
    """Yield what differs with every cylinder written out."""
    other = written_out(yaml.safe_load(text))
    if other is not None:
        yield from compared(text, text_of(other), "like", same_figures)


def scale(text: str, random: Random) -> Iterator[str]:
    """Yield what differs in another size."""
    larger = {"ambient": _ABSENT["ambient"]} | in_another_size(yaml.safe_load(text))
    if "pump" in larger:
        larger["pump"] = {"liquid": {"vapour_pressure": _ABSENT["vapour_pressure"]}} | larger[
            "pump"
        ]
    yield from compared(text, text_of(larger), "scale", figures_apart)


def case(text: str, random: Random) -> Iterator[str]:
    """Yield what differs between a load case and what `--set` gives."""
    keys = yaml.safe_load(text)
    if "cases" in keys:
        return
    with_case = text_of(keys | {"cases": [{"name": "as set", "set": {"speed": "77 rpm"}}]})
    for command in COMMANDS:
        in_case = run(with_case, command, "-f", "json", "--case", "as set")
        as_set = run(text, command, "-f", "json", "--set", "speed=77 rpm")
        if in_case.exit_code != as_set.exit_code:
            yield f"case: {command} ends with {in_case.exit_code} and {as_set.exit_code}"
        elif as_set.exit_code == 0:
            first, second = figures_of(in_case.stdout), figures_of(as_set.stdout)
            for line in differences(first, second, 0.0):
                yield f"case: {command} {line}"


def csv_as_json(text: str, random: Random) -> Iterator[str]:
    """Yield what csv has that json has not."""
    for command in COMMANDS:
        plain = run(text, command, "-f", "json")
        if plain.exit_code == 0:
            yield from csv_against_json(text, command, plain.stdout)


LAWS = {
    "batch": batch_against_alone,
    "units": units,
    "like": like,
    "scale": scale,
    "cylinders": ordered,
    "case": case,
    "csv": csv_as_json,
}


def csv_against_json(text: str, command: str, document: str) -> Iterator[str]:
    """Yield numbers of the csv of a command that its json has not."""
    result = run(text, command, "-f", "csv")
    yield from own_fault(result, f"{command} -f csv")
    if result.exit_code != 0:
        return
    numbers = {
        value
        for values in figures_of(document).values()
        for value in values
        if isinstance(value, int | float)
    }
    for row in csv.DictReader(io.StringIO(result.stdout)):
        # names may be numbers
        for cell in (
            cell for name, cell in row.items() if name not in ("cylinder", "part", "name")
        ):
            try:
                number = float(cell)
            except (TypeError, ValueError):
                continue
            if number not in numbers:
                yield f"csv: {command} has {cell}, json has not"
                return


def own_fault(result: Any, what: str) -> Iterator[str]:
    """Yield the fault where a command ended by one of its own."""
    if result.exit_code not in (0, 1, 2, 3) or "Warning:" in result.stderr:
        yield f"{what}: status {result.exit_code}: {result.stderr.strip()[-300:]}"


def compare(name: str, text: str, random: Random, laws: list[Any], found: Counter[str]) -> None:
    """Print every difference of a machine by these laws, and count what there was."""
    try:
        machine_of(text)
    except KurbelError:
        found["invalid"] += 1
        return
    found["valid"] += 1
    begin = time.process_time()
    try:
        for law in laws:
            for line in law(text, random):
                found["differences"] += 1
                print(f"{name}: {line}", flush=True)
    except Exception:
        found["faults"] += 1
        print(f"{name}: {traceback.format_exc(limit=-4)}", flush=True)
    if (seconds := time.process_time() - begin) > SLOW:
        print(f"{name}: {seconds:.0f} s", flush=True)


def main() -> None:
    """Print every difference with the machine, and how many there were."""
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 200
    seed = int(sys.argv[2]) if len(sys.argv) > 2 else date.today().toordinal()
    laws = [LAWS[word] for word in sys.argv[3:]] or [*LAWS.values()]
    texts = {
        f"random {number}": machine_file(np.random.default_rng([seed, number]))
        for number in range(count)
    }
    shipped = [
        *HOME.glob("configs/*.yaml"),
        *HOME.glob("tests/examples/*.yaml"),
        *HOME.glob("tests/machine_file/good/*"),
    ]
    texts |= {
        path.stem: path.read_text("utf-8") for path in sorted(shipped) if path.stem != "answers"
    }
    found: Counter[str] = Counter()
    try:
        for number, (name, text) in enumerate(texts.items()):
            compare(name, text, np.random.default_rng([seed, number]), laws, found)
    except KeyboardInterrupt:
        print("interrupted; so far:")
    print(f"seed {seed}: {dict(found)}")


if __name__ == "__main__":
    main()
