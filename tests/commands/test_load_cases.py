"""Load cases: what they set, where their faults are shown, and that the limits are checked in all of them."""

import json
from pathlib import Path

import pytest

import kurbel as api
from command import run

PUMP = """\
speed: 50 rpm
crank: 400 mm
rod: 2 m
bore: 450 mm
indicator: {head_end: {constant: {expansion: 0 bar, compression: 3 bar}}}
limits: {c_max: 3 m/s}
cases:
  - {name: full speed, set: {speed: 80 rpm}}
  - name: half the pressure
    set:
      indicator.head_end.constant.compression: 1.5 bar
      crank_end_rod: 100 mm
"""


@pytest.fixture
def pump(tmp_path: Path) -> Path:
    (tmp_path / "pump.yaml").write_text(PUMP, encoding="utf-8")
    return tmp_path / "pump.yaml"


def test_a_case_is_the_file_with_its_values(pump: Path) -> None:
    """Speeds are proportional to the speed of rotation, and the work of the card to its pressure."""
    plain, fast = (api.solve(api.load(pump, case=name)) for name in ("", "full speed"))
    assert fast["c_max"].value == pytest.approx(1.6 * plain["c_max"].value, rel=1e-14)
    half = api.solve(api.load(pump, case="half the pressure"))
    assert half["work"].value == pytest.approx(plain["work"].value / 2, rel=1e-14)
    assert half.machine.cylinders[0].pistons[0].crank_end_rod == 0.1
    assert half.machine.name == "pump, half the pressure"


def test_check_reports_the_faults_of_every_case(pump: Path) -> None:
    pump.write_text(
        PUMP.replace("80 rpm", "-80 rpm").replace("1.5 bar", "1.5 bra"), encoding="utf-8"
    )
    result = json.loads(run("check", pump, "-f", "json").stdout)["findings"]
    key = "indicator.head_end.constant.compression"
    assert [one["line"] for one in result] == [8, 11]
    assert [one["key"] for one in result] == ["cases[0].set.speed", f"cases[1].set.{key}"]


def test_set_takes_precedence_over_the_case_and_vary_over_both(pump: Path) -> None:
    set_over = run(
        "motion",
        pump,
        "--case",
        "full speed",
        "--set",
        "speed=100 rpm",
        "--key-values",
        "-f",
        "json",
    )
    result = run(
        "sweep",
        pump,
        "--case",
        "full speed",
        "--vary",
        "rod=2 m",
        "--columns",
        "c_max",
        "-f",
        "csv",
    )
    varied = run(
        "sweep",
        pump,
        "--case",
        "full speed",
        "--vary",
        "speed=100 rpm",
        "--columns",
        "c_max",
        "-f",
        "csv",
    )
    key_values = json.loads(set_over.stdout)["cylinders"][0]["key_values"]
    of_set = next(key_value["value"] for key_value in key_values if key_value["id"] == "c_max")
    assert float(varied.stdout.splitlines()[1].split(",")[2]) == pytest.approx(of_set, rel=1e-15)
    assert float(result.stdout.splitlines()[1].split(",")[2]) == pytest.approx(
        0.8 * of_set, rel=1e-14
    )


def test_check_holds_the_limits_in_every_case(pump: Path) -> None:
    result = run("check", pump)
    assert result.exit_code == 1
    lines = [" ".join(line.split()) for line in result.stdout.splitlines() if "m/s" in line]
    lines = [line for line in lines if line.startswith("c_max")]
    assert [line.split(" m/s")[0].rpartition(" ")[0] for line in lines] == [
        "c_max",
        "c_max, full speed",
        "c_max, half the pressure",
    ]
    assert [("FAIL" in line) for line in lines] == [False, True, False]
    assert run("check", pump, "--case", "half the pressure").exit_code == 0


def test_a_sweep_has_a_row_for_each_case(pump: Path) -> None:
    result = run(
        "sweep", pump, "--cases", "--vary", "rod=2,0.3,3 m", "--columns", "c_max", "-f", "csv"
    )
    rows = [line.split(",") for line in result.stdout.splitlines()]
    assert rows[0][:3] == ["row", "case", "rod_m"]
    assert [row[1] for row in rows[1:]] == ["full speed"] * 3 + ["half the pressure"] * 3
    assert rows[2][-1].startswith("rod: 300 mm is shorter than the crank (400 mm)")
    for row in (1, 3):
        assert float(rows[row][3]) == pytest.approx(1.6 * float(rows[row + 3][3]), rel=1e-14)


@pytest.mark.parametrize(
    ("pressures", "status"),
    [(("5 bara", "5 barg"), 2), (("5 bara", "6 bara"), 0), (("5 bar", "6 barg"), 0)],
)
def test_one_column_has_pressures_from_one_zero(
    tmp_path: Path, pressures: tuple[str, str], status: int
) -> None:
    """5 bar absolute and 5 bar gauge, 1.01 bar apart, would both be 5 in one column."""
    sets = [f"{{name: {p}, set: {{indicator.head_end: {p}}}}}" for p in pressures]
    file = tmp_path / "machine.yaml"
    file.write_text(
        "speed: 50 rpm\nstroke: 300 mm\nrod_ratio: 4\nbore: 200 mm\n"
        f"indicator: {{head_end: 3 bar}}\ncases: [{', '.join(sets)}]\n"
    )
    result = run("sweep", file, "--cases", "--columns", "p_max")
    assert result.exit_code == status
    assert ("from one zero" in result.stderr) == (status == 2)


def test_a_condition_that_holds_nowhere_hides_no_column(pump: Path) -> None:
    """The crosshead goes 800 mm: x = 1 km has no solution, and the column x is there all the same."""
    result = run("motion", pump, "--columns", "x", "--where", "x = 1 km")
    assert result.exit_code == 3
    assert "x is nowhere 1000 m: it goes from 0 mm to 800 mm" in result.stderr
