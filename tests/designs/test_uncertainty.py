"""Standard uncertainties: against closed derivatives, and against a large sample."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Iterable, Sequence
from pathlib import Path
from statistics import NormalDist
from typing import Any

import mpmath as mp
import numpy as np
import pytest
from click.testing import CliRunner

import kurbel
from kurbel.cli import kurbel as command
from kurbel.designs import uncertainty
from kurbel.designs.answers import Answer
from kurbel.designs.uncertainty import Uncertain, data_uncertainty, read_inputs, uncertainties
from kurbel.machine_file import source
from kurbel.quantities import every_quantity
from kurbel.traces import read as trace_files

WATERWORKS = Path(__file__).parent.parent.parent / "configs" / "waterworks.yaml"


def of(spreads: dict[str, str], *ids: str, command: str = "forces") -> dict[str, Uncertain]:
    known = every_quantity().key_values(command)
    asked = [Answer(known[id], command, "cylinder 1" if command == "forces" else "whole machine") for id in ids]
    found = uncertainties(read_inputs(source.read(WATERWORKS), spreads)[0], asked)
    return {one.answer.quantity.id: one for one in found}


def test_first_order_is_that_of_closed_formulas() -> None:
    """c_m = 2 s n; b_max = R ω² (1 + λ): relative uncertainties 2 of n, and λ/(1 + λ) of L/R."""
    found = of({"speed": "1 %", "rod_ratio": "2 %"}, "c_m", "b_max", "A_head")
    assert found["c_m"].spread == pytest.approx(0.01 * found["c_m"].value, rel=1e-9)
    assert found["c_m"].shares == pytest.approx((1, 0), abs=1e-15)
    by_speed, by_ratio = 2 * 0.01, 0.2 / 1.2 * 0.02
    size = np.hypot(by_speed, by_ratio)
    assert found["b_max"].spread == pytest.approx(size * found["b_max"].value, rel=1e-8)
    assert found["b_max"].shares == pytest.approx(((by_speed / size) ** 2, (by_ratio / size) ** 2), rel=1e-7)
    assert found["A_head"].spread <= 1e-15
    assert all(one.sample == 0 for one in found.values())


def test_the_errors_of_the_data_are_those_of_the_file_too() -> None:
    """`kurbel accuracy FILE`: without masses all that the gas does goes with bore², c_max with n, b_max with n²."""
    machine = kurbel.loads("""
        {speed: 50 rpm, crank: 400 mm, rod: 2000 mm, bore: 450 mm, indicator: {head_end: 9 bar, crank_end: 2 bar},
         uncertainty: {bore: 0.9 mm, speed: 1 %}}
        """)
    found = {one.quantity: one.error for one in data_uncertainty(machine)}
    assert found == pytest.approx({"c_max": 0.01, "b_max": 0.02, "T_max": 0.004, "ΔE": 0.004}, rel=1e-6)


def test_a_point_of_a_card_may_be_off() -> None:
    """A_i = s (A_H + A_C) ∮ p df: the line between f = 0.35 and 0.7 is drawn over its point at 0.5 on both sides."""
    found = of({"indicator.head_end.expansion.2.1": "0.1"}, "work", "A_head", "A_crank")
    areas = found["A_head"].value + found["A_crank"].value
    assert found["work"].spread == pytest.approx(0.1 * 98066.5 * (0.7 - 0.35) / 2 * 0.8 * areas, rel=1e-8)


def test_drawn_machines_that_fail_are_told_of() -> None:
    """Of bores of 450 ± 900 mm 35 % are thinner than the rod; of 1e308 mm no machine is left, which was not told."""
    (one,) = of({"bore": "200 %"}, "A_head").values()
    lost = 2000 - one.sample
    assert lost == pytest.approx(2000 * NormalDist(450, 900).cdf(100), abs=1)
    assert one.failed.startswith(f"{lost} of 2000 drawn machines fail and count for nothing (bore: -")
    told = CliRunner().invoke(command, ["forces", str(WATERWORKS), "--key-values", "--uncertainty", "bore=1e308 mm"])
    assert "2000 of 2000 drawn machines fail" in told.stdout


def test_what_bends_is_told_by_a_sample() -> None:
    """c_max with L/R = 5 ± 0.8 is far from straight; the spread is that of a sample drawn otherwise."""
    (one,) = of({"rod_ratio": "0.8"}, "c_max").values()
    assert one.sample > 1000
    ratios = np.random.default_rng(4).normal(5, 0.8, 600)
    machine = kurbel.load(WATERWORKS)
    drawn = kurbel.sweep(machine, {"rod_ratio": ratios[ratios > 1.01]}, ["c_max"])["c_max"]
    assert one.spread == pytest.approx(np.nanstd(drawn), rel=0.15)


@pytest.mark.slow
def test_first_order_is_that_of_a_large_sample() -> None:
    """Sampling noise of a standard deviation from n drawn ones is 1/√(2n)."""
    found = of({"bore": "0.2 mm", "friction.crosshead": "10 %", "speed": "0.5 %"}, "T_max", "N_max", "W", "P_max")
    count, random = 20_000, np.random.default_rng(1)
    inputs = {
        "bore": random.normal(0.45, 2e-4, count),
        "friction.crosshead": random.normal(0.1, 0.01, count),
        "speed": random.normal(50 / 60, 0.005 * 50 / 60, count),
    }
    drawn = kurbel.sweep(kurbel.load(WATERWORKS), inputs, list(found))
    for name, one in found.items():
        assert one.sample == 0
        assert one.spread == pytest.approx(drawn[name].std(ddof=1), rel=4 / np.sqrt(2 * count))


def test_forces_and_flywheel_tell_it_beside_their_key_values(tmp_path: Path) -> None:
    text = (WATERWORKS.read_text(encoding="utf-8")) + 'uncertainty: {speed: "± 1 %", bore: ± 0.2 mm}\n'
    file = tmp_path / "m.yaml"
    file.write_text(text, encoding="utf-8")
    for name, id, part in (("forces", "T_max", "cylinders"), ("flywheel", "dE", "machine_place_tables")):
        result = CliRunner().invoke(command, [name, str(file), "--key-values", "-f", "json"])
        assert result.exit_code == 0, result.output
        told = json.loads(result.stdout)
        tables = told[part] if part == "machine_place_tables" else told[part][0]["place_tables"]
        (table,) = tables
        assert any(id in str(row) for row in table["rows"])
    page = CliRunner().invoke(command, ["forces", str(file), "--key-values"]).stdout
    assert "Standard uncertainty, and the share of each input in its square" in page
    assert "speed" in page


def test_stress_tells_it_beside_its_key_values() -> None:
    """The full force goes with bore², the safety against it of a pin of 0.1 % uncertain k_b likewise."""
    engine = str(WATERWORKS.parent / "gas-engine.yaml")
    spreads = ["--uncertainty", "bore=0.5 %", "--uncertainty", "crankshaft.allowable_bending=0.1 %"]
    result = CliRunner().invoke(command, ["stress", engine, "--key-values", "-f", "json", *spreads])
    assert result.exit_code == 0, result.output
    table = json.loads(result.stdout)["machine_place_tables"][-1]
    assert table["id"] == "uncertainty"
    told = {column["id"]: column["values"] for column in table["columns"]}
    names = [row["key_value"] for row in table["rows"]]
    force, safety = names.index("P_dc"), names.index("safety_pin_min")
    assert told["uncertainty"][force] == pytest.approx(0.01 * told["value"][force], rel=1e-8)
    assert told["bore"][force] == 100
    assert 0.001 * told["value"][safety] < told["uncertainty"][safety] < 0.0101 * told["value"][safety]


def _rig(folder: Path) -> Path:
    """A test rig: a compression and an expansion with exponents 1.35 and 1.28, 16.5 : 1, three noisy cycles."""
    angles = np.arange(0, 720, 1.0)
    sine, cosine = np.sin(np.radians(angles)), np.cos(np.radians(angles))
    volume = (1 + 3.6 - cosine - np.sqrt(3.6**2 - sine**2)) / 2 + 1 / 15.5
    least, most = 1 / 15.5, 1 + 1 / 15.5
    burnt = 95 * (least / volume) ** 1.28
    compressed = 0.95 * (most / volume) ** 1.35
    mean = np.select([angles < 180, angles < 360, angles < 540], [burnt, 1.2, 0.95], compressed)
    noise = 0.1 * np.random.default_rng(3).standard_normal((3, 720))
    np.savetxt(folder / "rig.csv", np.column_stack([angles, *(mean + noise)]), "%.4f", ",")
    file = folder / "rig.yaml"
    file.write_text("""
        {cycle: four-stroke, speed: 1500 rpm, stroke: 100 mm, rod_ratio: 3.6, bore: 90 mm,
         indicator: {pressures: absolute, head_end: {trace: {
          file: rig.csv, unit: bar, pressure_columns: 2-4, angle_zero: 0 deg, compression_ratio: 16.5}}}}
        """)
    return file


def test_what_is_answered_alone_is_sampled_less_and_its_trace_read_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(uncertainty, "SLOW_SAMPLE", 25)
    trace_files._numbers.cache_clear()  # of other tests, which may have read the same
    read, loadtxt = list[Any](), np.loadtxt
    monkeypatch.setattr(np, "loadtxt", lambda *args, **more: (read.append(args), loadtxt(*args, **more))[1])
    told = list[int]()

    def counted(parts: Sequence[Any]) -> Iterable[Any]:
        for part in parts:
            told.append(len(part))
            yield part

    known = every_quantity().key_values("forces")
    asked = [Answer(known[id], "forces", "cylinder 1") for id in ("mean_pressure", "n_expansion", "T_max")]
    spreads = {"indicator.head_end.trace.angle_zero": "0.6 deg"}
    found = uncertainties(read_inputs(source.read(_rig(tmp_path)), spreads)[0], asked, counted)
    assert {one.answer.quantity.id: one.sample for one in found} == {"mean_pressure": 0, "n_expansion": 25, "T_max": 0}
    assert told == [10, 10, 5]
    assert len(read) == 1


def test_why_the_residual_of_a_trace_is_no_rounding(tmp_path: Path) -> None:
    """Samples at equal angles have the trapezoid's work; others that of the lines that the quadrature follows."""
    asked = ["forces", str(_rig(tmp_path)), "--key-values", "-f", "json"]
    told = json.loads(CliRunner().invoke(command, asked).stdout)
    residual = next(one for one in told["cylinders"][0]["key_values"] if one["id"] == "energy_residual")["value"]
    assert abs(residual) > 1e-9
    assert any(note.startswith("ΔA/A of a trace at equal angles is no rounding") for note in told["notes"])
    uneven = np.loadtxt(tmp_path / "rig.csv", delimiter=",")[np.arange(720) % 7 != 3]
    np.savetxt(tmp_path / "rig.csv", uneven, "%.4f", ",")
    told = json.loads(CliRunner().invoke(command, asked).stdout)
    residual = next(one for one in told["cylinders"][0]["key_values"] if one["id"] == "energy_residual")["value"]
    assert abs(residual) < 1e-13
    assert not any("ΔA/A" in note for note in told.get("notes", ()))


def _table(*args: str) -> str:
    asked = ["forces", str(WATERWORKS), "--key-values", "--uncertainty", "bore=0.1mm", *args]
    result = CliRunner().invoke(command, asked)
    assert result.exit_code == 0, result.output
    return result.stdout


def test_its_figures_are_numbers_to_programs() -> None:
    """The guard against formulas in spreadsheets is for names, not for negative numbers."""
    rows = {row["key_value"]: row for row in csv.DictReader(io.StringIO(_table("-f", "csv")))}
    (table,) = json.loads(_table("-f", "json"))["cylinders"][0]["place_tables"]
    columns = {column["id"]: column["values"] for column in table["columns"]}
    cylinder = kurbel.solve(kurbel.load(str(WATERWORKS))).cylinders[0]
    for place, name in enumerate(row["key_value"] for row in table["rows"]):
        assert float(rows[name]["value"]) == columns["value"][place]
        assert columns["value"][place] == pytest.approx(cylinder[name].value, rel=1e-14)
        assert float(rows[name]["uncertainty"]) == columns["uncertainty"][place] > 0
    assert float(rows["P_min"]["value"]) < 0
    assert table["rows"][0] == {"key_value": "A_head", "symbol": "A_H", "unit": "m^2"}


@pytest.mark.parametrize(
    ("args", "message"),
    [
        (("bor=1 mm",), "bor: no value stands under this key"),
        (("bo..re=1 mm",), "bo..re: no value stands under this key"),
        (("bore=1 kg",), "kg is a unit of mass"),
        (("bore=-1 mm",), "write KEY=SPREAD, above 0"),
        (("bore",), "write KEY=SPREAD"),
        (("name=1 mm",), "is no number that could be off"),
        (("bore=1 mm", "bore=2 mm"), "--uncertainty bore: this key is given twice"),
        (("tandem.0.bore=1 mm", "tandem[0].bore=2 mm"), "--uncertainty tandem[0].bore: this key is given twice"),
        (("tandem.bore=1 mm",), "did you mean 'tandem.0.bore'?"),
    ],
)
def test_bad_uncertainties(args: tuple[str, ...], message: str) -> None:
    options = [part for one in args for part in ("--uncertainty", one)]
    result = CliRunner().invoke(command, ["forces", str(WATERWORKS), *options])
    assert result.exit_code == 2
    assert message in " ".join(result.output.split())


def test_an_uncertainty_of_the_file_that_is_none() -> None:
    with pytest.raises(kurbel.KurbelError, match="expected a standard uncertainty above 0"):
        kurbel.loads("{stroke: 1 m, rod_ratio: 5, uncertainty: {stroke: 0 mm}}")
    with pytest.raises(kurbel.KurbelError, match="expected a mapping of keys"):
        kurbel.loads("{stroke: 1 m, rod_ratio: 5, uncertainty: 1 mm}")


@pytest.mark.parametrize("asked", ["check", "forces"])
def test_all_that_is_wrong_with_uncertainties_is_told_at_its_place(asked: str) -> None:
    text = """\
crank: 400 mm
rod: 2 m
uncertainty:
  rd: 1 %
  rod: 3 kg
  name: 2 %
  crank: 0.1 mm
"""
    result = CliRunner().invoke(command, [asked, "-"], input=text)
    assert result.exit_code == 2
    told = [line for line in result.stderr.splitlines() if line.startswith("<stdin>")]
    assert [line.split(":")[1:4] for line in told] == [
        ["4", "7", " uncertainty.rd"],
        ["5", "8", " uncertainty.rod"],
        ["6", "9", " uncertainty.name"],
    ]
    assert "did you mean 'rod'" in told[0]
    assert "kg is a unit of mass" in told[1]


@pytest.mark.parametrize("share", [1e-5, 1e-3, 0.02, 0.05])
def test_differences_are_as_good_as_exact_derivatives(share: float) -> None:
    """Of c_max by L/R against thirty digits: u has eight of them from uncertainties of 1e-5 of the value to 5 %."""
    with mp.workdps(30):
        ratio = mp.mpf(5)

        def slope(length: Any, phi: Any) -> Any:
            return mp.diff(lambda p: mp.cos(p) + mp.sqrt(length**2 - mp.sin(p) ** 2), phi)

        place = mp.findroot(lambda phi: mp.diff(lambda p: slope(ratio, p), phi), mp.radians(79))
        by_ratio = mp.diff(lambda length: slope(length, place), ratio)  # where x′ is largest its place does not count
        exact = float(abs(by_ratio / slope(ratio, place)) * ratio * mp.mpf(share))
    (one,) = of({"rod_ratio": f"{100 * share!r} %"}, "c_max").values()
    assert one.sample == 0
    assert one.spread / one.value == pytest.approx(exact, rel=1e-8)
