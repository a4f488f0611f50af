"""The first answer of `kurbel forces`: what it names, that no row contradicts another, and none says nothing.

Figures with a source: Redtenbacher's locomotive (D 5 to D 7), and an independent calculation of a pump with friction in
crank pin and journals.
"""

import csv
import sys
from io import StringIO
from pathlib import Path

import numpy as np
import pytest

from command import answer, printed, run
from kurbel.machine_file import load
from kurbel.render import Look, page
from kurbel.render.page import fitting, selection
from kurbel.render.text import plain_lines
from kurbel.report.commands import COMMANDS, report_of
from kurbel.solver.case import Case
from kurbel.tables.frame import Frame
from kurbel.tables.tables import Report, first_selection, shown_once, stepped

CONFIGS = Path(__file__).parents[2] / "configs"
WATERWORKS = str(CONFIGS / "waterworks.yaml")
LOCOMOTIVE = str(CONFIGS / "locomotive.yaml")
SHIPPED = [path for path in sorted(CONFIGS.glob("*.yaml")) if load(str(path)).cylinders]
NAMED = ("b_max", "c_max", "friction_work", "friction_power", "friction_loss")

# friction in pins and journals; its figures by numpy alone
PUMP = """
speed: 60 rpm
crank: 100 mm
rod: 400 mm
bore: 200 mm
indicator: {head_end: {constant: {expansion: 0 bar, compression: 10 bar}}}
friction: {crank_pin: 0.1, crank_pin_diameter: 100 mm, journals: 0.1, journal_diameter: 100 mm}
"""


def forces_of(path: Path) -> Report:
    case = Case(load(str(path)))
    end = COMMANDS["forces"].functions.last_angle(case)
    return report_of(case, Frame("forces", stepped(10.0, end), None, "metric"))


def screen_of(report: Report, width: int) -> list[str]:
    first = first_selection(report, COMMANDS["forces"].first.split(), (width - 14) // 8, rows=4)
    return list(plain_lines(selection(first, Look(width=width))))


# the first selection


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_what_the_user_named_is_on_the_first_screen(path: Path) -> None:
    report = forces_of(path)
    symbols = [
        key_value.symbol for key_value in report.parts[0].key_values if key_value.id in NAMED
    ]
    for width in (80, 100):
        begun = [line.split()[0] for line in screen_of(report, width)[:24] if line.startswith("  ")]
        assert set(symbols) <= set(begun)


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_a_terminal_of_24_lines_keeps_what_the_user_named_of_every_cylinder(
    path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The prompt takes the last of the 24 lines; what scrolls away is not an answer."""
    monkeypatch.setattr(page, "terminal_size", lambda: (80, 24))
    monkeypatch.setattr(sys.stdout, "isatty", lambda: True)
    command = COMMANDS["forces"]
    report = forces_of(path)
    ids = (command.first.split(), command.named.split())
    lines = list(plain_lines(fitting(report, Look(width=80), *ids)))
    kept = [line.split()[0] for line in lines[-23:] if line.startswith("  ")]
    for part in shown_once(report).parts:
        for key_value in part.key_values:
            if key_value.id in NAMED and not key_value.minor:
                kept.remove(key_value.symbol)


def test_the_help_and_the_report_name_the_books_of_their_references() -> None:
    assert "R: Roetscher, Die Maschinenelemente (1927)" in " ".join(
        printed("motion", "--help").split()
    )
    assert "Roetscher" not in printed("units", "--help")
    footer = run("report", WATERWORKS, "-o", "-").stdout.partition("<footer>")[2]
    assert "Rötscher, Die Maschinenelemente (1927)" in footer


def test_the_first_selection_of_the_waterworks_engine_has_at_most_26_lines() -> None:
    lines = screen_of(forces_of(Path(WATERWORKS)), 100)
    assert len(lines) <= 26
    assert lines[-1].startswith("Left out: weight (no inclination given).")
    assert [line.split()[0] for line in lines if line.startswith("  ")] == [
        *("b_max", "c_max", "N_i", "p_i", "P_max", "P_min", "N_max", "N_min", "T_max", "T_min"),
        *("A_f", "N_f", "e_f", "F_m"),
    ]


def test_the_first_page_of_the_report_has_the_same_figures() -> None:
    text = run("report", WATERWORKS, "-o", "-").stdout
    facts = text.index('class="facts"')
    tiles = text[facts : text.index("</div>", facts)]
    for title in (
        "Largest acceleration",
        "Highest piston speed",
        "Friction power",
        "Friction loss",
    ):
        assert f"<small>{title}</small>" in tiles


# friction


def test_the_three_losses_of_the_locomotive_after_redtenbacher() -> None:
    """r/l = 1/6, f = 1/10: D 5 with the logarithm 0.8242 %, as an integral 0.8280 %, D 7 1/120; D 6 F_m = ½ P f r/l."""
    (cylinder,) = answer("forces", LOCOMOTIVE)["cylinders"]
    values = {key_value["id"]: key_value["value"] for key_value in cylinder["key_values"]}
    assert values["loss_crosshead_logarithm"] == pytest.approx(0.008242, abs=5e-7)
    assert values["loss_crosshead_integral"] == pytest.approx(0.008280, abs=5e-7)
    assert values["loss_crosshead_redtenbacher"] == pytest.approx(1 / 120)
    # the piston force is the same throughout
    assert values["friction_force_mean"] == pytest.approx(values["P_max"] / 120)
    text = printed("forces", LOCOMOTIVE)
    assert "½ λ f  " not in text
    compared = printed("forces", LOCOMOTIVE, "--compare")
    assert all(f"  {symbol} " in compared for symbol in ("½ λ f", "e_ln", "e_β"))


@pytest.mark.parametrize(
    "name", ["waterworks", "diesel-four-stroke", "scotch-yoke-pump", "compressor"]
)
def test_the_power_of_friction_is_the_mean_of_its_column_and_the_work_times_cycles_per_second(
    name: str,
) -> None:
    case = Case(load(str(CONFIGS / f"{name}.yaml")))
    (forces,) = case.cylinders
    cycle = 360.0 * forces.drive.revolutions
    angles = (np.arange(200_000) + 0.5) * cycle / 200_000
    assert forces.friction_power == pytest.approx(forces.at(angles).friction_power.mean(), rel=1e-5)
    assert forces.friction_power == pytest.approx(
        forces.friction_work * case.machine.speed / forces.drive.revolutions, rel=1e-12
    )
    places = [row for row in forces.rows.key_values if row.startswith("friction_power_")]
    parts = [forces[row].value for row in places if getattr(forces, row) is not None]
    assert sum(parts) == pytest.approx(forces.friction_power, rel=1e-12)


def test_the_new_key_values_in_sweeps_limits_and_conditions() -> None:
    swept = printed(
        "sweep",
        LOCOMOTIVE,
        "--vary",
        "speed=100,200 rpm",
        "--columns",
        "friction_power",
        "-f",
        "csv",
    )
    first, second = (float(row["friction_power_W"]) for row in csv.DictReader(StringIO(swept)))
    assert second == pytest.approx(2 * first)
    checked = run("check", LOCOMOTIVE, "--set", "limits.friction_power=1 kW")
    assert (checked.exit_code, "friction_power" in checked.stdout) == (1, True)
    rows = printed(
        "forces",
        LOCOMOTIVE,
        "--where",
        "friction_power = 3 kW",
        "--columns",
        "friction_power",
        "-f",
        "csv",
    )
    values = [float(row["friction_power_W"]) for row in csv.DictReader(StringIO(rows))]
    assert values == pytest.approx([3000.0] * 4)


# one meaning of T


def test_T_is_the_torque_over_the_crank_with_friction_in_pins_and_journals() -> None:
    (cylinder,) = answer("forces", "-", "--step", "0.5", text=PUMP)["cylinders"]
    columns = {column["id"]: np.array(column["values"]) for column in cylinder["columns"]}
    values = {key_value["id"]: key_value["value"] for key_value in cylinder["key_values"]}
    assert columns["M"] == pytest.approx(columns["T"] * 0.1)
    assert values["W"] == pytest.approx(-11596.24, abs=0.005)
    assert values["T_min"] == pytest.approx(-35723.0, abs=0.5)
    whole = {
        key_value["id"]: key_value["value"]
        for key_value in answer("flywheel", "-", text=PUMP)["machine_key_values"]
    }
    assert (whole["T_min"], whole["W"]) == pytest.approx((values["T_min"], values["W"]), rel=1e-12)
    # the force at the pin alone, R 303, with the friction that the rod passes on to the guide
    assert columns["T_pin"][180 * 2] == pytest.approx(393, abs=1)


# extremes at a jump


def test_an_extreme_before_a_jump_is_marked() -> None:
    (cylinder,) = answer("forces", WATERWORKS)["cylinders"]
    sides = {key_value["id"]: key_value.get("side", "") for key_value in cylinder["key_values"]}
    assert {id for id, side in sides.items() if side} == {
        "P_max",
        "P_min",
        "P_peak",
        "P_start_max",
        "P_start_min",
    }
    text = printed("forces", WATERWORKS)
    assert "at 360°−" in text
    assert "− after an angle: just before the jump there." in text
    assert "at 360 deg-" in run("forces", WATERWORKS).stdout.replace("°−", " deg-")


def test_an_extreme_without_a_jump_has_no_side() -> None:
    (cylinder,) = answer("forces", str(CONFIGS / "diesel-trace.yaml"))["cylinders"]
    assert not any("side" in key_value for key_value in cylinder["key_values"])


# rows that say nothing


def rows_of(text: str) -> set[str]:
    return {line.split()[0] for line in text.splitlines() if line.strip()}


GAS_ALONE = """
{speed: 60 rpm, crank: 100 mm, rod_ratio: infinite, bore: 200 mm,
 indicator: {head_end: {constant: {expansion: 5 bar, compression: 1 bar}}}}
"""


def test_rows_that_repeat_others_or_are_zero_are_for_programs() -> None:
    """An infinite rod without masses: P = P_gas = S = P_0, N = 0, and the largest magnitude is that of max or min."""
    page = rows_of(printed("forces", "-", text=GAS_ALONE))
    assert page.isdisjoint(
        {"P_gas", "S", "N", "M", "N_max", "S_max", "P_0,max", "P_peak", "T_peak", "A_C", "φ_i"}
    )
    assert {"P", "T", "P_max", "T_max", "T_min"} <= page
    head, *_ = printed("forces", "-", "-f", "csv", text=GAS_ALONE).splitlines()
    assert {"P_gas_N", "P_N", "S_N", "N_N", "M_Nm"} <= set(head.split(","))
    (cylinder,) = answer("forces", "-", text=GAS_ALONE)["cylinders"]
    ids = {key_value["id"] for key_value in cylinder["key_values"]}
    assert {"P_peak", "T_peak", "N_max", "S_max", "P_start_max", "A_crank", "phi_idc"} <= ids
    assert {"P_gas", "N", "M"} <= rows_of(
        printed("forces", "-", "--columns", "P_gas,N,M", text=GAS_ALONE)
    )
    assert "P_peak" in rows_of(printed("forces", "-", "--key-values", "P_peak", text=GAS_ALONE))


def test_the_weight_of_a_horizontal_engine_is_no_row() -> None:
    with_masses = GAS_ALONE.replace(
        "bore", "inclination: 0 deg, masses: {reciprocating: 10 kg}, bore"
    )
    assert "P_w" not in rows_of(printed("forces", "-", text=with_masses))
    upright = with_masses.replace("0 deg", "90 deg")
    assert "P_w" in rows_of(printed("forces", "-", text=upright))


def test_forces_without_a_force_say_so() -> None:
    page = printed("forces", "-", text="{speed: 60 rpm, crank: 100 mm, rod: 400 mm}")
    assert "no force acts; kurbel motion prints its motion" in page
    assert "─" not in page
    assert "c_max" in page


def test_roots_of_first_order_are_printed_in_comparisons() -> None:
    assert "φ_b0=0" not in printed("motion", WATERWORKS)
    assert "φ_b0=0" in printed("motion", WATERWORKS, "--compare")


def test_two_rods_with_several_pistons_have_tables_with_their_names() -> None:
    page = printed("forces", str(CONFIGS / "waterworks-two-cranks.yaml"))
    assert "Each piston: high pressure" in page
    assert "Each piston: low pressure" in page


def test_a_machine_without_a_guide_has_no_guide_force() -> None:
    page = printed("forces", str(CONFIGS / "yoke-frame-pump.yaml"))
    assert "guide force" not in page


def cells_of_b(angles: str) -> list[str]:
    table = printed("motion", WATERWORKS, "--angles", angles, "--columns", "b")
    row = next(line for line in table.splitlines() if line.startswith("b"))
    return row.split()[2:]


def test_no_value_next_to_a_zero_of_the_curve_is_printed_as_zero() -> None:
    """R ω² (cos φ + (λ cos 2φ + λ³ sin⁴ φ)/(1 − λ² sin² φ)^1.5) is 2.207e-3 m/s2 at 79.09, 7.687e-6 at 79.1001 degrees."""
    assert cells_of_b("0,79,90") == ["13.16", "0.02", "-2.24"]
    # one or two more decimals for all, so that they can be compared
    assert cells_of_b("0,79.09,90") == ["13.159", "0.002", "-2.238"]
    # a power of ten for that value alone
    assert cells_of_b("0,79.1001,90")[::2] == ["13.16", "-2.24"]
    number, _, power = cells_of_b("0,79.1001,90")[1].partition("·")
    assert (number, power) == ("7.7", "10⁻⁶")
