"""Standard uncertainties: against closed derivatives, and against a large sample."""

import json
from collections.abc import Callable, Sequence
from functools import cache
from math import exp, expm1, hypot, isnan, pi, sqrt
from pathlib import Path
from statistics import NormalDist, correlation, stdev
from typing import Any, Union

import mpmath as mp
import numpy as np
import pytest

import kurbel
from command import run
from kurbel.designs import uncertainty
from kurbel.designs.answers import Answer, DesignValues, Row
from kurbel.designs.binding import Binder, KeyColumn
from kurbel.designs.plan import latin_hypercube
from kurbel.designs.uncertainty import (
    Inputs,
    Uncertain,
    given_uncertainty,
    uncertainties,
    with_uncertainty,
)
from kurbel.errors import MachineFileError, UsageError
from kurbel.quantities import every_quantity
from kurbel.report.commands import report_of, subjects_of
from kurbel.solver.case import Case
from kurbel.tables.frame import Frame
from kurbel.tables.tables import Part, PlaceTable
from representative import CONFIGS

WATERWORKS = CONFIGS["waterworks"]


def of(spreads: dict[str, str], *ids: str, command: str = "forces") -> dict[str, Uncertain]:
    known = every_quantity().key_values(command)
    words = [
        Answer(known[id], command, "cylinder 1" if command == "forces" else "whole machine")
        for id in ids
    ]
    inputs = given_uncertainty(kurbel.load(WATERWORKS), [*spreads.items()])
    assert inputs
    result = uncertainties(inputs, words)
    return {one.answer.quantity.id: one for one in result}


def test_first_order_is_that_of_closed_formulas() -> None:
    """c_m = 2 s n; b_max = R ω² (1 + λ): relative uncertainties 2 of n, and λ/(1 + λ) of L/R."""
    result = of({"speed": "1 %", "rod_ratio": "2 %"}, "c_m", "b_max", "A_head")
    assert result["c_m"].spread == pytest.approx(0.01 * result["c_m"].value, rel=1e-9)
    assert result["c_m"].shares == pytest.approx((1, 0), abs=1e-15)
    by_speed, by_ratio = 2 * 0.01, 0.2 / 1.2 * 0.02
    size = np.hypot(by_speed, by_ratio)
    assert result["b_max"].spread == pytest.approx(size * result["b_max"].value, rel=1e-8)
    assert result["b_max"].shares == pytest.approx(
        ((by_speed / size) ** 2, (by_ratio / size) ** 2), rel=1e-7
    )
    assert result["A_head"].spread <= 1e-15
    assert all(one.sample == 0 for one in result.values())


def test_a_point_of_a_card_may_be_off() -> None:
    """A_i = s (A_H + A_C) ∮ p df: the line between f = 0.35 and 0.7 is drawn over its point at 0.5 on both sides."""
    result = of({"indicator.head_end.expansion.2.1": "0.1"}, "work", "A_head", "A_crank")
    areas = result["A_head"].value + result["A_crank"].value
    assert result["work"].spread == pytest.approx(
        0.1 * 98066.5 * (0.7 - 0.35) / 2 * 0.8 * areas, rel=1e-8
    )


def test_drawn_machines_that_fail_are_reported() -> None:
    """Of bores of 450 ± 900 mm 35 % are thinner than the rod."""
    (one,) = of({"bore": "200 %"}, "A_head").values()
    lost = 2000 - one.sample
    assert lost == pytest.approx(2000 * NormalDist(450, 900).cdf(100), abs=1)
    assert one.failed.startswith(f"{lost} of 2000 sampled machines fail and are ignored (bore: -")


def test_what_bends_is_known_by_a_sample() -> None:
    """c_max with L/R = 5 ± 0.8 is far from straight; the spread is that of a sample drawn otherwise."""
    (one,) = of({"rod_ratio": "0.8"}, "c_max").values()
    assert one.sample > 1000
    ratios = np.random.default_rng(4).normal(5, 0.8, 600)
    machine = kurbel.load(WATERWORKS)
    drawn = kurbel.sweep(machine, {"rod_ratio": ratios[ratios > 1.01]}, ["c_max"])["c_max"]
    assert one.spread == pytest.approx(np.nanstd(drawn), rel=0.15)


def test_forces_and_flywheel_report_it_with_their_key_values(tmp_path: Path) -> None:
    text = (
        WATERWORKS.read_text(encoding="utf-8")
    ) + 'uncertainty: {speed: "± 1 %", bore: ± 0.2 mm}\n'
    file = tmp_path / "m.yaml"
    file.write_text(text, encoding="utf-8")
    for name, id, part in (
        ("forces", "T_max", "cylinders"),
        ("flywheel", "dE", "machine_place_tables"),
    ):
        result = run(name, file, "--key-values", "-f", "json")
        assert result.exit_code == 0, result.output
        reported = json.loads(result.stdout)
        tables = (
            reported[part] if part == "machine_place_tables" else reported[part][0]["place_tables"]
        )
        (table,) = tables
        assert any(id in str(row) for row in table["rows"])
    page = run("forces", file, "--key-values").stdout
    assert "Standard uncertainty, and the share of each input in its square" in page
    assert "speed" in page


@pytest.mark.parametrize("share", [1e-5, 1e-3, 0.02, 0.05])
def test_differences_are_as_good_as_exact_derivatives(share: float) -> None:
    """Of c_max by L/R against thirty digits: u has eight of them from uncertainties of 1e-5 of the value to 5 %."""
    with mp.workdps(30):
        ratio = mp.mpf(5)

        def slope(length: Any, phi: Any) -> Any:
            return mp.diff(lambda p: mp.cos(p) + mp.sqrt(length**2 - mp.sin(p) ** 2), phi)

        place = mp.findroot(lambda phi: mp.diff(lambda p: slope(ratio, p), phi), mp.radians(79))
        by_ratio = mp.diff(
            lambda length: slope(length, place), ratio
        )  # where x′ is largest its place does not count
        exact = float(abs(by_ratio / slope(ratio, place)) * ratio * mp.mpf(share))
    (one,) = of({"rod_ratio": f"{100 * share!r} %"}, "c_max").values()
    assert one.sample == 0
    assert one.spread / one.value == pytest.approx(exact, rel=1e-8)


# what is written

COMPRESSOR = """
speed: 300 rpm
stroke: 200 mm
rod: 500 mm
offset: -10 mm
bore: 150 mm
indicator: {head_end: {compressor: {suction: 0 bar, delivery: 6 bar, clearance: 0.05}}}
gas: {inlet_temperature: 20 °C, molar_mass: 28.96 g/mol, isentropic_exponent: 1.4}
"""
SIZES = {
    ("offset", "10 %"): 0.001,  # of −10 mm
    ("offset", "1 mm"): 0.001,
    ("gas.inlet_temperature", "2 °C"): 2.0,
    ("gas.inlet_temperature", "1 °F"): 5 / 9,
    ("gas.inlet_temperature", "1 %"): 2.9315,
    ("speed", "3 rpm"): 0.05,
    ("stroke", "0.01 in"): 0.000254,
    ("stroke", "0.5 %"): 0.001,
    ("indicator.head_end.compressor.suction", "0.1 bar"): 1e4,
    ("indicator.head_end.compressor.delivery", "1 %"): 6e3,
    ("indicator.head_end.compressor.clearance", "0.01"): 0.01,
    ("indicator.head_end.compressor.clearance", "10 %"): 0.005,
}


def test_an_uncertainty_is_a_size_in_si() -> None:
    """With a unit it counts from no zero; percent are of the size of a value, of temperatures from absolute zero."""
    machine = kurbel.loads(COMPRESSOR)
    for (key, text), size in SIZES.items():
        inputs = given_uncertainty(machine, [(key, text)])
        assert inputs is not None
        assert inputs.spreads.tolist() == pytest.approx([size], rel=1e-12), (key, text)


def test_one_outside_the_file_replaces_that_of_its_key() -> None:
    machine = kurbel.loads(COMPRESSOR + "uncertainty: {stroke: 5 mm, bore: 1 %}\n")
    inputs = given_uncertainty(machine, [("stroke", "2 mm"), ("offset", "3 mm")])
    assert inputs is not None
    sizes = dict(zip(inputs.keys, inputs.spreads.tolist()))
    values = dict(zip(inputs.keys, inputs.values.tolist()))
    assert sizes == pytest.approx({"stroke": 0.002, "bore": 0.0015, "offset": 0.003})
    assert values == pytest.approx({"stroke": 0.2, "bore": 0.15, "offset": -0.01})
    assert given_uncertainty(kurbel.loads(COMPRESSOR)) is None


def test_what_is_no_uncertainty_is_refused_with_all_faults() -> None:
    machine = kurbel.loads(COMPRESSOR)
    with pytest.raises(UsageError) as caught:
        given_uncertainty(machine, [("stroke", "0 mm"), ("bore", "-1 mm"), ("offset", "1 kg")])
    for key in ("stroke: it must be more than 0", "bore: it must be more than 0", "offset: "):
        assert f"--uncertainty {key}" in str(caught.value)
    with pytest.raises(UsageError, match="stroke: this key is given twice"):
        given_uncertainty(machine, [("stroke", "1 mm"), ("stroke", "2 mm")])
    in_file = """uncertainty:
  indicator.head_end.compressor.suction: 1 %    # of 0 bar
  stroke: 2 kg
"""
    with pytest.raises(MachineFileError) as refused:
        given_uncertainty(kurbel.loads(COMPRESSOR + in_file))
    assert ":10:" in str(refused.value)
    assert "must be more than 0, got 1 %" in str(refused.value)
    assert "unknown length unit 'kg'" in str(refused.value)


# first order and samples of formulas that are known

Formula = Callable[..., Union[tuple[float, ...], str]]
"""Key values of a machine by its inputs, or why it fails."""


@cache
def two_inputs() -> Inputs:
    """Inputs whose names do not matter: the formula of a test stands for the machine."""
    inputs = given_uncertainty(kurbel.loads(COMPRESSOR), [("stroke", "1 mm"), ("bore", "1 mm")])
    assert inputs
    return inputs


class Formulas:
    """Formulas in the place of the solver; `machines` are the inputs of those computed last."""

    def __init__(self, monkeypatch: pytest.MonkeyPatch) -> None:
        self.machines: list[tuple[float, ...]] = []
        self._patch = monkeypatch

    def of(
        self,
        formula: Formula,
        values: Sequence[float] = (0.0, 0.0),
        spreads: Sequence[float] = (1.0, 1.0),
        sample: int = 400,
    ) -> list[Uncertain]:
        """Return the uncertainties of the key values of a formula of two inputs."""

        def answers(
            _: Binder, columns: Sequence[KeyColumn], requested: Sequence[Answer]
        ) -> list[DesignValues]:
            numbers = [column.numbers[column.indices].tolist() for column in columns]
            machines = list(zip(*numbers))
            self.machines += machines
            rows: list[DesignValues] = []
            for machine in machines:
                result = formula(*machine)
                if isinstance(result, str):
                    rows.append(result)
                else:
                    numbers_of = {answer.quantity.id: result[k] for k, answer in enumerate(every)}
                    rows.append(Row([numbers_of[answer.quantity.id] for answer in requested]))
            return rows

        names = ("c_m", "c_max", "b_max")
        quantities = every_quantity().key_values("forces")
        centre = formula(*values)
        every = [Answer(quantities[id], "forces", "cylinder 1") for id in names[: len(centre)]]
        self.machines.clear()
        self._patch.setattr(uncertainty, "answered", answers)
        self._patch.setattr(uncertainty, "SAMPLE", sample)
        inputs = two_inputs()._replace(values=np.array(values), spreads=np.array(spreads))
        return uncertainties(inputs, every)

    @property
    def sampled(self) -> list[tuple[float, ...]]:
        """The machines of the sample: those after the first order, of 13 machines for two inputs."""
        return self.machines[13:]


@pytest.fixture
def formulas(monkeypatch: pytest.MonkeyPatch) -> Formulas:
    return Formulas(monkeypatch)


def test_shares_of_a_linear_function(formulas: Formulas) -> None:
    """y = 2 a − 3 b + 7, u_a = 0.5, u_b = 0.2: u² = 1 + 0.36, whatever the order of the inputs."""
    (result,) = formulas.of(lambda a, b: (2 * a - 3 * b + 7,), (4.0, -2.0), (0.5, 0.2))
    assert (result.value, result.sample, result.failed) == (21.0, 0, "")
    assert result.spread == pytest.approx(sqrt(1.36), rel=1e-12)
    assert result.shares == pytest.approx((1 / 1.36, 0.36 / 1.36), rel=1e-12)
    assert sum(result.shares) == pytest.approx(1, rel=1e-12)
    (swapped,) = formulas.of(lambda b, a: (2 * a - 3 * b + 7,), (-2.0, 4.0), (0.2, 0.5))
    assert swapped.spread == pytest.approx(result.spread, rel=1e-12)
    assert swapped.shares == pytest.approx(result.shares[::-1], rel=1e-12)


def test_slopes_of_cubics_are_exact(formulas: Formulas) -> None:
    """Differences at two steps, extrapolated, have no error of the third order: y = a + a³, y′(0) = 1."""
    (result,) = formulas.of(lambda a, b: (a + a**3,))
    assert result.spread == pytest.approx(1, rel=1e-12)
    assert result.shares == (1, 0)


def test_shifts_are_a_tenth_a_twentieth_and_one_uncertainty(formulas: Formulas) -> None:
    formulas.of(lambda a, b: (a + b,), (10.0, 20.0), (1.0, 2.0))
    shifts = {(round(a - 10, 9), round((b - 20) / 2, 9)) for a, b in formulas.machines}
    alone = {(sign * step, 0) for step in (0.1, 0.05, 1) for sign in (1, -1)}
    assert shifts == {(0, 0), *alone, *((b, a) for a, b in alone)}


@pytest.mark.parametrize(
    ("formula", "is_sampled"),
    [
        (lambda a, b: (a + 0.09 * a**2,), False),
        (lambda a, b: (a + 0.11 * a**2,), True),
        (lambda a, b: (a + 0.11 * b**2,), True),
        (lambda a, b: (a + 12 * a**3,), False),  # differences at 0.1 and at 0.05: 0.0075 of a³
        (lambda a, b: (a + 15 * a**3,), True),
        (lambda a, b: (-a - 0.11 * a**2,), True),
        (lambda a, b: (a - 0.11 * a**2,), True),
        (lambda a, b: (-5 + 4e-9 * a**2,), False),
        (lambda a, b: (-5 + 6e-9 * a**2,), True),
        (lambda a, b: "too far" if a > 0.5 else (a,), True),
    ],
)
def test_which_key_values_are_sampled(
    formulas: Formulas, formula: Formula, is_sampled: bool
) -> None:
    """Where the second-order part passes a tenth of u and 1e-9 of the value, or a shifted machine fails."""
    (result,) = formulas.of(formula, sample=40)
    assert bool(result.sample) == is_sampled
    assert len(formulas.sampled) == 40 * is_sampled


def test_a_sample_is_of_normal_inputs(formulas: Formulas) -> None:
    """ln y = a + b/2: mean square of e^(s²) (e^(s²) − 1), s² = u_a² + u_b²/4; the value is that without errors."""
    spreads = 0.4, 0.6
    (result,) = formulas.of(lambda a, b: (exp(a + b / 2),), (0, 0), spreads, 1000)
    assert (result.value, result.sample) == (1, 1000)
    square = 0.4**2 + 0.3**2
    exact = sqrt(exp(square) * expm1(square))
    assert result.spread == pytest.approx(exact, rel=5 / sqrt(1000))
    # the squared correlation of e^x with one part of x is s_a²/(e^(s²) − 1)
    correlated = [0.4**2 / expm1(square), 0.3**2 / expm1(square)]
    assert result.shares == pytest.approx(correlated, abs=5 / sqrt(1000))
    for values, spread in zip(zip(*formulas.sampled), spreads):
        assert stdev(values) == pytest.approx(spread, rel=0.01)
    assert abs(correlation(*zip(*formulas.sampled))) < 4 / sqrt(1000)


def test_failed_machines_have_no_part_in_spread_and_shares(formulas: Formulas) -> None:
    """Of a small sample, against the standard deviation (of n − 1) and the correlations of those that are good."""

    def formula(a: float, b: float) -> tuple[float, ...] | str:
        return "too far" if a > 0.5 else (a**2 + b + 40,)

    (result,) = formulas.of(formula, sample=24)
    good = [(a, b) for a, b in formulas.sampled if a <= 0.5]
    results = [a**2 + b + 40 for a, b in good]
    lost = 24 - len(good)
    assert lost == pytest.approx(24 * (1 - NormalDist().cdf(0.5)), abs=1)
    assert (result.value, result.sample) == (40, len(good))
    assert result.failed == f"{lost} of 24 sampled machines fail and are ignored (too far)."
    assert result.spread == pytest.approx(stdev(results), rel=1e-12)
    shares = [correlation(values, results) ** 2 for values in zip(*good)]
    assert result.shares == pytest.approx(shares, rel=1e-9)


def test_a_sample_of_which_all_fail_has_no_spread(formulas: Formulas) -> None:
    (result,) = formulas.of(lambda a, b: "no" if (a, b) != (0, 0) else (3.0,), sample=20)
    assert (result.sample, result.shares, result.counts) == (0, (0, 0), False)
    assert isnan(result.spread)
    assert result.failed == "20 of 20 sampled machines fail and are ignored (no)."


def test_key_values_keep_their_order(formulas: Formulas) -> None:
    """A straight one between two that bend, and one that is no number in front of others."""
    first, second, third = formulas.of(lambda a, b: (5 + a**2, 2 * b, -7 - 3 * b**2), sample=400)
    assert [result.answer.quantity.id for result in (first, second, third)] == [
        "c_m",
        "c_max",
        "b_max",
    ]
    assert (first.value, second.value, third.value) == (5, 0, -7)
    assert (first.sample, second.sample, third.sample) == (400, 0, 400)
    assert second.spread == pytest.approx(2, rel=1e-12)
    # the variance of the square of a normal number is 2, and both are independent of its sign
    assert first.spread == pytest.approx(sqrt(2), rel=0.1)
    assert third.spread == pytest.approx(3 * sqrt(2), rel=0.1)
    assert max(*first.shares, *third.shares) < 0.05
    (left,) = formulas.of(lambda a, b: (float("nan"), a + 3), (1.0, 0.0))
    assert (left.answer.quantity.id, left.value) == ("c_max", 4)


def test_rounding_does_not_count() -> None:
    answer = answer_of_a_speed()
    for value in (3.0, -3.0):
        assert not Uncertain(answer, value, 0.0, ()).counts
        assert not Uncertain(answer, value, 2e-12, ()).counts
        assert Uncertain(answer, value, 4e-12, ()).counts


def answer_of_a_speed() -> Answer:
    return Answer(every_quantity().key_values("forces")["c_m"], "forces", "cylinder 1")


def test_a_sample_is_stratified() -> None:
    """Every column has one number in each strip, at random within it, in an order of its own."""
    numbers = latin_hypercube(200, 3, 5)
    strips = np.floor(numbers * 200)
    within = numbers * 200 - strips
    for column in strips.T:
        assert sorted(column) == list(range(200))
    assert abs(np.corrcoef(numbers.T) - np.eye(3)).max() < 4 / sqrt(200)
    assert within.mean() == pytest.approx(1 / 2, abs=4 / sqrt(12 * 600))
    assert within.std() == pytest.approx(sqrt(1 / 12), rel=0.1)
    assert not (latin_hypercube(200, 3, 6) == numbers).any()
    assert (latin_hypercube(200, 3, 5) == numbers).all()


# the table in a report


def tables_of(
    text: str, command: str, more: Sequence[tuple[str, str]], system: str
) -> dict[str | float, PlaceTable]:
    """Return the tables of uncertainties in a report, by the name of their part."""
    case = Case(kurbel.loads(text))
    report = report_of(case, Frame(command, (0.0,), None, system))
    report = with_uncertainty(report, case, more, system)
    tables = {}
    for part in report.all_parts:
        for table in part.place_tables:
            if table.id == "uncertainty":
                tables[part.name] = table
    return tables


def row_of(table: PlaceTable, id: str) -> tuple[str, list[Any]]:
    """Return the unit and the numbers of a key value in a table."""
    ids = [names[0] for names in table.names]
    number = ids.index(id)
    return table.names[number][2], [column.values[number] for column in table.columns]


def test_differences_of_temperatures_are_reported_without_a_zero() -> None:
    """T_2 = T_1 (p_2/p_1)^((κ − 1)/κ), 2 K of T_1 = 293.15 K; in °F the value has a zero, and its error none."""
    machine = kurbel.loads(COMPRESSOR)
    inputs = given_uncertainty(machine, [("gas.inlet_temperature", "2 °C")])
    assert inputs
    stage = subjects_of(Case(machine), "delivery")[0]
    temperature = every_quantity().key_values("delivery")["discharge_temperature"]
    answer = Answer(temperature, "delivery", stage.name, part=stage.identity)
    (result,) = uncertainties(inputs, [answer])
    ratio = ((6 + 1.01325) / 1.01325) ** (2 / 7)
    assert result.spread == pytest.approx(2 * ratio, rel=1e-8)
    expected = {
        "metric": ("K", 293.15 * ratio, 2 * ratio),
        "imperial": ("°F", 293.15 * ratio * 1.8 - 459.67, 3.6 * ratio),
    }
    for system, (unit, value, size) in expected.items():
        part = uncertainty._with_table(Part(stage.name, ()), [result], inputs.keys, system)
        shown, numbers = row_of(part.place_tables[0], "discharge_temperature")
        assert shown == unit
        assert numbers == [pytest.approx(value), pytest.approx(size, rel=1e-8), 100, None]


def test_each_cylinder_has_its_own_uncertainties() -> None:
    """A = π D²/4, u_A = π D u_D/2; P = −m R ω² (1 + λ); shares in percent."""
    cylinder = "stroke: 200 mm, rod: 500 mm, masses: {reciprocating: 20 kg}"
    pressures = "indicator: {head_end: {constant: {expansion: 6 bar, compression: 0 bar}}}"
    text = f"""
speed: 300 rpm
cylinders:
  - {{name: a, bore: 150 mm, {cylinder}, {pressures}}}
  - {{name: b, bore: 300 mm, {cylinder}, {pressures}}}
"""
    spreads = [("cylinders.0.bore", "1 mm"), ("cylinders.1.bore", "3 mm"), ("speed", "1 %")]
    tables = tables_of(text, "forces", spreads, "metric")
    by_name = {"a": (15.0, 0.1, [100, 0, 0]), "b": (30.0, 0.3, [0, 100, 0])}
    for name, (bore, size, percent) in by_name.items():
        unit, numbers = row_of(tables[name], "A_head")
        assert unit == "cm^2"
        assert numbers[:2] == pytest.approx([pi / 4 * bore**2, pi / 2 * bore * size], rel=1e-8)
        assert numbers[2:] == [*percent, None]
        # m R ω² (1 + λ) at the head end: twice the error of ω
        force = -20 * 0.1 * (10 * pi) ** 2 * 1.2 / 1000
        unit, numbers = row_of(tables[name], "P_inertia_min")
        assert unit == "kN"
        assert numbers[:2] == pytest.approx([force, 0.02 * abs(force)], rel=1e-4)
        assert numbers[2:] == [0, 0, 100, None]


def test_shares_in_percent_have_one_decimal() -> None:
    """Of b_max = R ω² (1 + λ): u of 2 %, and λ/(1 + λ) of 1 %, so 0.7 % by L/R; every input has its column."""
    text = WATERWORKS.read_text(encoding="utf-8")
    tables = tables_of(text, "forces", [("rod_ratio", "1 %"), ("speed", "1 %")], "si")
    table = tables["cylinder 1"]
    assert [column.id for column in table.columns[2:]] == ["rod_ratio", "speed", "sample"]
    square = (0.2 / 1.2) ** 2
    percent = round(100 * square / (square + 4), 1)
    assert row_of(table, "b_max")[1][2:] == [percent, 100 - percent, None]
    _, (value, size, *_) = row_of(table, "b_max")
    assert size / value == pytest.approx(0.01 * hypot(2, 0.2 / 1.2), rel=1e-6)


def test_the_size_of_a_negative_value_decides_its_unit() -> None:
    quantity = every_quantity().key_values("forces")["P_inertia_min"]
    result = Uncertain(Answer(quantity, "forces", "a"), -11300.0, 200.0, (1.0,))
    part = uncertainty._with_table(Part("a", ()), [result], ("speed",), "metric")
    assert row_of(part.place_tables[0], "P_inertia_min") == ("kN", [-11.3, 0.2, 100.0, None])
