"""One reader of values: every spelling is read in every place where a value may be."""

import csv
import json
from collections.abc import Callable
from typing import NamedTuple

import pytest

import kurbel
from command import answer, printed, run
from kurbel.designs.uncertainty import given_uncertainty

PSI, AT = 0.45359237 * 9.80665 / 0.0254**2, 98066.5
INCH = 0.0254


class Spelling(NamedTuple):
    """Three values of a key in equal steps as they are written, the step, and the middle one and the step in SI.

    key: of the machine; id: of the key value that it is; column: one that reaches it.
    """

    key: str
    id: str
    column: str
    low: str
    middle: str
    high: str
    step: str
    value: float
    step_value: float

    @property
    def machine(self) -> str:
        """A pump whose suction pressure names the same zero as the values."""
        lowest, middle = "0.1 bara", "7 bara"
        stroke = self.middle
        if self.key != "stroke":
            lowest, middle, stroke = self.low.replace("6", "0.1"), self.middle, "300 mm"
        return f"""
speed: 240 rpm
stroke: {stroke}
rod: 30 in
bore: 12 in
ambient: 1 bar
indicator:
  head_end: {{constant: {{expansion: {lowest}, compression: {middle}}}}}
  crank_end: mirrored
"""


def pressures(unit: str, size: float) -> Spelling:
    key = "indicator.head_end.constant.compression"
    texts = (f"{number} {unit}" for number in ("6", "7", "8", "1"))
    return Spelling(key, "p_max", "p_head", *texts, 7 * size, size)


def strokes(low: str, middle: str, high: str, step: str) -> Spelling:
    """The stroke of 17 1/2, 18, 18 1/2 inches."""
    return Spelling("stroke", "stroke", "x", low, middle, high, step, 18 * INCH, INCH / 2)


SPELLINGS = [
    pressures("bara", 1e5),
    pressures("barg", 1e5),
    pressures("psia", PSI),
    pressures("psig", PSI),
    pressures("ata", AT),
    pressures("atü", AT),
    pressures("bar abs", 1e5),
    pressures("kPa(g)", 1e3),
    strokes("17 1/2 in", "18 in", "18 1/2 in", "1/2 in"),
    strokes("1 ft 5 1/2 in", "1 ft 6 in", "1 ft 6 1/2 in", "1/2 in"),
    strokes("1' 5.5\"", "1'-6\"", "1'-6 1/2\"", '1/2"'),
]


def key_values(spelling: Spelling, *words: str, more: str = "") -> float:
    """Return the key value that a command prints."""
    chosen = ("--key-values", spelling.id)
    result = answer("forces", "-", *words, *chosen, text=spelling.machine + more)
    (key_value,) = result["cylinders"][0]["key_values"]
    return float(key_value["value"])


def rows(spelling: Spelling, vary: str, *words: str) -> list[float]:
    """Return the key value in the rows of a sweep."""
    columns = ("--columns", spelling.id, "-f", "csv")
    text = printed(
        "sweep", "-", "--vary", f"{spelling.key}={vary}", *words, *columns, text=spelling.machine
    )
    parsed = list(csv.DictReader(text.splitlines()))
    (name,) = (name for name in parsed[0] if name.startswith(f"{spelling.id}_"))
    assert not any(row["failure"] for row in parsed), text
    return [float(row[name]) for row in parsed]


def uncertainty(spelling: Spelling, *words: str, more: str = "") -> float:
    """Return the standard uncertainty of the key value, which is that of its key."""
    chosen = ("--key-values", spelling.id)
    result = answer("forces", "-", *words, *chosen, text=spelling.machine + more)
    (table,) = result["cylinders"][0]["place_tables"]
    (column,) = (column for column in table["columns"] if column["id"] == "uncertainty")
    return float(column["values"][0])


def judged(spelling: Spelling, more: str) -> float:
    """Return the value that a limit or an expectation of the file allows."""
    result = run("check", "-", "-f", "json", text=spelling.machine + more)
    assert result.exit_code == 0, result.output
    findings = json.loads(result.stdout)["findings"]
    (bound,) = (finding["bound"] for finding in findings if finding.get("bound") is not None)
    return float(bound if isinstance(bound, float) else sum(bound) / 2)


def of_case(spelling: Spelling) -> float:
    quoted = spelling.middle.replace("'", "''")
    case = f"cases: [{{name: a, set: {{{spelling.key}: '{quoted}'}}}}]\n"
    assert run("check", "-", text=spelling.machine + case).exit_code == 0
    return key_values(spelling, "--case", "a", more=case)


def of_where(spelling: Spelling) -> float:
    low = spelling._replace(middle=spelling.high)
    text = printed(
        "forces",
        "-",
        *("--where", f"{spelling.column} = {spelling.middle}", "--columns", spelling.column),
        *("-f", "csv"),
        text=low.machine if spelling.column == "x" else spelling.machine,
    )
    return float(text.splitlines()[1].split(",")[1])


def of_find(spelling: Spelling) -> float:
    vary = f"{spelling.key}={spelling.low}:{spelling.high}"
    wanted = f"{spelling.id} = {spelling.middle}"
    result = answer("find", "-", "--vary", vary, wanted, text=spelling.machine)
    (solution,) = result["found"]
    return float(solution["values"][0])


def of_python(spelling: Spelling) -> float:
    texts = [spelling.low, spelling.middle, spelling.high]
    result = kurbel.sweep(kurbel.loads(spelling.machine), {spelling.key: texts}, spelling.id)
    assert set(result["failure"]) == {""}
    found = kurbel.find(
        spelling.machine,
        {spelling.key: (spelling.low, spelling.high)},
        f"{spelling.id} = {spelling.middle}",
    )
    assert found.found[0].values[0] == pytest.approx(spelling.value, rel=1e-9)
    return float(result[spelling.id][1])


def of_list(spelling: Spelling) -> float:
    _, middle, _ = rows(spelling, f"{spelling.low},{spelling.middle},{spelling.high}")
    return middle


def of_range(spelling: Spelling) -> float:
    _, middle, _ = rows(spelling, f"{spelling.low}:{spelling.high}:{spelling.step}")
    return middle


def of_normal(spelling: Spelling) -> float:
    """A value as it is read, if a sample of the distribution is within five deviations of it."""
    sample = rows(spelling, f"normal({spelling.middle}, {spelling.step})", "--sample", "5")
    assert max(abs(row - spelling.value) for row in sample) < 5 * spelling.step_value
    return spelling.value


def of_uniform(spelling: Spelling) -> float:
    """A value as it is read, if a sample of the distribution is between its ends."""
    sample = rows(spelling, f"uniform({spelling.low}, {spelling.high})", "--sample", "5")
    assert max(abs(row - spelling.value) for row in sample) < spelling.step_value
    return spelling.value


def of_uncertainty(spelling: Spelling) -> float:
    """The value, if its uncertainty is the step."""
    spread = uncertainty(spelling, "--uncertainty", f"{spelling.key}={spelling.step}")
    return spelling.value * spread / spelling.step_value


def of_uncertainty_in_file(spelling: Spelling) -> float:
    line = f"uncertainty: {{{spelling.key}: ± {spelling.step}}}\n"
    return spelling.value * uncertainty(spelling, more=line) / spelling.step_value


def of_row_condition(spelling: Spelling) -> float:
    vary = f"{spelling.low},{spelling.middle},{spelling.high}"
    middle, _ = rows(spelling, vary, "--where", f"{spelling.id} >= {spelling.middle}")
    return middle


def of_key_condition(spelling: Spelling) -> float:
    vary = f"{spelling.low},{spelling.middle},{spelling.high}"
    middle, _ = rows(spelling, vary, "--where", f"{spelling.key} >= {spelling.middle}")
    return middle


def of_override(spelling: Spelling) -> float:
    machine = spelling._replace(middle=spelling.low)
    return key_values(machine, "--set", f"{spelling.key}={spelling.middle}")


PLACES: dict[str, Callable[[Spelling], float]] = {
    "the file": key_values,
    "--set": of_override,
    "a load case": of_case,
    "a list": of_list,
    "a range": of_range,
    "a normal distribution": of_normal,
    "a uniform distribution": of_uniform,
    "--uncertainty": of_uncertainty,
    "uncertainty of the file": of_uncertainty_in_file,
    "find": of_find,
    "--where of a table": of_where,
    "--where of a sweep": of_row_condition,
    "--where of a key": of_key_condition,
    "a limit": lambda s: judged(s, f"limits:\n  {s.id}: {s.middle}\n"),
    "an expectation": lambda s: judged(s, f"expect:\n  {s.id}: {s.middle} ± {s.step}\n"),
    "Python": of_python,
}


@pytest.mark.parametrize("place", PLACES)
def test_every_spelling_is_read_in_this_place(place: str) -> None:
    read = {spelling.middle: PLACES[place](spelling) for spelling in SPELLINGS}
    expected = {spelling.middle: spelling.value for spelling in SPELLINGS}
    assert read == pytest.approx(expected, rel=1e-9)


def test_uncertainties_of_temperatures_count_from_no_zero() -> None:
    """2 °C as a standard uncertainty, a deviation or a tolerance are 2 K, not 275.15 K."""
    machine = """
speed: 300 rpm
stroke: 200 mm
rod: 500 mm
bore: 150 mm
indicator: {head_end: {compressor: {suction: 0 bar, delivery: 6 bar, clearance: 0.05}}}
gas: {inlet_temperature: 20 °C, molar_mass: 28.96 g/mol, isentropic_exponent: 1.4}
"""
    for spread in ("2 °C", "2 K", "3.6 °F"):
        inputs = given_uncertainty(kurbel.loads(machine), [("gas.inlet_temperature", spread)])
        assert inputs is not None
        assert inputs.spreads.tolist() == pytest.approx([2.0], rel=1e-12)
    vary = "gas.inlet_temperature=normal(20 °C, {})"
    swept = ("sweep", "-", "--sample", "3", "--columns", "mass_flow", "-f", "csv", "--vary")
    by_degrees = printed(*swept, vary.format("2 °C"), text=machine)
    assert by_degrees == printed(*swept, vary.format("2 K"), text=machine)
    range_in = "gas.inlet_temperature=20 °C:30 °C:5 {}"
    swept = ("sweep", "-", "--columns", "mass_flow", "-f", "csv", "--vary")
    by_degrees = printed(*swept, range_in.format("°C"), text=machine)
    assert by_degrees == printed(*swept, range_in.format("K"), text=machine)
    # T_2 = T_1 (p_2/p_1)^((κ − 1)/κ)
    temperature = 293.15 * ((6 + 1.01325) / 1.01325) ** (2 / 7)
    for error, status in ((1, 0), (3, 1)):
        line = f"expect: {{discharge_temperature: {temperature + error} K ± 2 °C}}\n"
        assert run("check", "-", text=machine + line).exit_code == status
