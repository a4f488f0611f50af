"""`kurbel find`: values planted, published, or known by a law are found again."""

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from command import run
from kurbel.arrays import Array
from kurbel.designs.find import Solutions, find_solutions
from kurbel.errors import NoSolutionError
from kurbel.machine_file.source import decode, read
from kurbel.numerics.search import lowest, roots
from kurbel.render.solutions import picture
from kurbel.solver.flywheel import MachineTurning
from representative import CONFIGS, few


def found_in(name: str, vary: str, *equations: str, **how: object) -> Solutions:
    return find_solutions(read(CONFIGS[name]), vary.split("; "), equations, **how)  # type: ignore[arg-type]


def test_the_flywheel_of_a_fluctuation_is_the_one_that_kurbel_gives() -> None:
    """J_δ,ω of `kurbel flywheel` is found by another way: Newton's method on the speed line of one machine."""
    result = found_in(
        "waterworks-two-cranks", "flywheel.inertia=10000:80000 kg m2", "delta = 1/50"
    ).found
    reported = json.loads(
        run("flywheel", str(CONFIGS["waterworks-two-cranks"]), "-f", "json").stdout
    )
    by_id = {key_value["id"]: key_value["value"] for key_value in reported["machine_key_values"]}
    assert [one.values[0] for one in result] == pytest.approx([by_id["J_exact"]], rel=1e-9)


def test_of_many_designs_none_that_stalls_searches_the_flywheel_that_would_do(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """That search takes 40 times as long as the design; only the message of a single machine shows its result."""
    machine, key = str(CONFIGS["punch"]), "flywheel.inertia"
    alone = run("flywheel", machine, "--set", f"{key}=3 kg m2")
    reason, _, remedy = alone.stderr.removeprefix("Error: ").partition(";")
    assert alone.exit_code == 3
    assert remedy.startswith(" it runs with a flywheel from J = ")
    monkeypatch.delattr(MachineTurning, "_enough")
    swept = run(
        "sweep", machine, "--vary", f"{key}=3 kg m2, 200 kg m2", "--columns", "delta", "-f", "json"
    )
    assert [json.loads(row)["failure"] for row in swept.stdout.splitlines()] == [reason, None]
    assert found_in("punch", f"{key}=0:1000 kg m2", "delta = 0.05").found


def test_the_offset_of_least_guide_force() -> None:
    """A kink, where N_max = −N_min: 29.237 mm and 4.0010 kN, against 5.99 kN without an offset."""
    result = found_in("offset-engine", "offset=0:60 mm", least="N_peak").found[0]
    assert result.values[0] == pytest.approx(29.237e-3, abs=5e-7)
    assert result.key_values[0] == pytest.approx(4001.0, abs=0.05)
    both = [found_in("offset-engine", "offset=28:31 mm", f"{name} = {size!r} N") for name, size in (
        ("N_max", result.key_values[0]), ("N_min", -result.key_values[0]),
    )]  # fmt: skip
    for one in both:
        assert one.found[0].values[0] == pytest.approx(result.values[0], rel=1e-8)


def test_a_greatest_value_is_at_the_bound_of_a_condition() -> None:
    """c_m = 2 s n: at 50/min and 1.5 m/s the stroke is 0.9 m."""
    result = found_in(
        "waterworks", "stroke=600:1000 mm", greatest="power", conditions=["c_m < 1.5 m/s"]
    ).found[0]
    assert result.values[0] == pytest.approx(0.9, rel=1e-9)
    assert result.notes == ("beyond it: c_m < 1.5 m/s",)


def test_a_flat_optimum_is_a_range() -> None:
    notes = found_in("waterworks", "speed=40:60 rpm", least="stroke").found[0].notes
    assert "as good from 40 to 60 rpm" in notes


@pytest.mark.parametrize("span", ["5%:30%", "5:30 %", "0.05:0.3"])
def test_a_range_in_percent_is_one_of_shares(span: str) -> None:
    """η_v = 1 − ε [(p_d/p_s)^(1/n) − 1] of the ideal compressor is ½ at ε = ½/(4^(1/1.3) − 1)."""
    card = "compressor: {suction: 1 bar, delivery: 4 bar, clearance: 8 %, exponent: 1.3}"
    indicator = f"indicator: {{pressures: absolute, head_end: {{{card}}}}}"
    text = f"{{speed: 1 1/s, stroke: 1 m, rod_ratio: 4, bore: 1 m, {indicator}}}"
    vary = f"indicator.head_end.compressor.clearance={span}"
    ended = run(
        "find", "-", "--vary", vary, "volumetric_efficiency = 50 %", "-f", "json", text=text
    )
    (result,) = json.loads(ended.stdout)["found"]
    assert result["values"] == pytest.approx([0.5 / (4 ** (1 / 1.3) - 1)], rel=1e-9)


def test_two_planted_values_are_found_again() -> None:
    """A machine with s = 0.8 m and L/R = 5 has these T_max and N_max: both equations give its sizes back."""
    case = json.loads(
        run("forces", str(CONFIGS["waterworks"]), "-f", "json", "--set", "rod_ratio=5").stdout
    )
    by_id = {
        key_value["id"]: key_value["value"] for key_value in case["cylinders"][0]["key_values"]
    }
    equations = [f"{id} = {by_id[id]!r} N" for id in ("T_max", "N_max")]
    result = found_in("waterworks", "stroke=600:1000 mm; rod_ratio=4:8", *equations).found
    assert [one.values for one in result] == [pytest.approx((0.8, 5.0), rel=1e-9)]


def test_all_solutions_of_a_range() -> None:
    """P_max of a vertical machine is m g sin γ + m b: the angles on both sides of 90° give the same."""
    text = (
        "{stroke: 1 m, rod_ratio: 5, speed: 60 rpm, masses: {piston: 100 kg}, inclination: 90 deg}"
    )
    origin = decode("<text>", text.encode())
    result = find_solutions(origin, ["inclination=0:180 deg"], ["P_max = 2000 N"]).found
    angles = [one.values[0] for one in result]
    assert len(angles) == 2
    assert sum(angles) == pytest.approx(180.0, abs=1e-6)


def test_parts_of_the_range_that_fail_are_reported() -> None:
    result = found_in("waterworks", "rod_ratio=0.5:8", "N_max = 20 kN")
    assert result.failed[0].low == 0.5
    assert result.failed[0].high == pytest.approx(
        1.01**0.5, abs=1e-9
    )  # to 1 by the rule, beyond it the crosshead locks
    assert "must be more than 1" in result.failed[0].why
    assert len(result.found) == 1


def test_the_written_file_has_what_was_wanted(tmp_path: Path) -> None:
    file = CONFIGS["waterworks-two-cranks"]
    words = ("find", str(file), "--vary", "flywheel.inertia=10000:80000 kg m2", "delta = 1/80")
    written = run(*words, "--write")
    new = tmp_path / "new.yaml"
    new.write_text(written.stdout, encoding="utf-8")
    reported = json.loads(run("flywheel", str(new), "-f", "json").stdout)
    assert {key_value["id"]: key_value["value"] for key_value in reported["machine_key_values"]}[
        "delta"
    ] == pytest.approx(1 / 80, rel=1e-10)
    comments = [
        line for line in file.read_text(encoding="utf-8").splitlines() if line.startswith("#")
    ]
    assert [line for line in written.stdout.splitlines() if line.startswith("#")] == comments
    row = run(*words, "-f", "csv").stdout.splitlines()
    assert row[0] == "row,flywheel.inertia_kgm2,delta"
    assert (
        float(row[1].split(",")[1])
        == json.loads(run(*words, "-f", "json").stdout)["found"][0]["values"][0]
    )


def test_of_several_solutions_one_is_taken() -> None:
    text = "{stroke: 1 m, rod_ratio: 5, speed: 60 rpm, masses: {piston: 100 kg}, inclination: 90 deg}\n"
    words = ("find", "-", "--vary", "inclination=0:180 deg", "P_max = 2000 N", "--write")
    assert run(*words, text=text).exit_code == 2
    first, second = (run(*words, "--take", str(number), text=text).stdout for number in (1, 2))
    assert first != second
    assert np.array([len(first), len(second)]).min() > 50


def test_the_key_value_is_drawn_over_the_key(tmp_path: Path) -> None:
    """Every design that was computed is a point, the solutions are marked, and where designs fail there is no curve."""
    result = found_in("waterworks", "rod_ratio=0.5:8", "N_max = 20 kN")
    (panel,) = picture(result, "metric").panels
    curve, wanted = panel.curves
    computed = result.values[:, 0]
    whole = np.isfinite(computed)
    assert (curve.x[np.isfinite(curve.x)] == result.places[whole, 0]).all()
    assert (curve.y[np.isfinite(curve.y)] == computed[whole] / 1e3).all()
    assert len(curve.pieces()) == len(result.failed) == 1
    assert curve.jumps() == []
    assert np.nanmin(curve.x) > 1.01**0.5  # below, the crosshead locks itself
    assert wanted.y.tolist() == [20.0, 20.0]
    assert [(mark.x, mark.y) for mark in panel.marks] == [
        (result.found[0].values[0], pytest.approx(20.0))
    ]
    level = picture(found_in("waterworks", "speed=40:60 rpm", least="stroke"), "metric")
    assert len(level.panels[0].curves) == 1

    arguments = (
        "find",
        str(CONFIGS["waterworks"]),
        "--vary",
        "rod_ratio=3:8",
        "N_max = 20 kN",
        "--plot",
    )
    assert "rod_ratio 4.123" in run(*arguments).stdout
    file = tmp_path / "found.svg"
    assert run(*arguments, "-o", str(file)).exit_code == 0
    assert file.read_text(encoding="utf-8").startswith("<svg")


def banana(steep: float) -> Callable[[Array], Array]:
    """Rosenbrock's valley over [−2, 2]², lifted to 1; its lowest place is (1, 1)."""
    return lambda at: (
        1 + (3 - 4 * at[:, 0]) ** 2 + steep * (4 * at[:, 1] - 2 - (4 * at[:, 0] - 2) ** 2) ** 2
    )


@pytest.mark.parametrize(
    ("function", "place"),
    [
        (banana(1e2), (0.75, 0.75)),
        (banana(1e6), (0.75, 0.75)),
        (
            lambda at: (
                1 + (at[:, 0] - 0.3) ** 2 + 1e4 * (at[:, 1] - np.sin(3 * at[:, 0]) ** 2) ** 2
            ),
            (0.3, np.sin(0.9) ** 2),
        ),
        (
            lambda at: 1 + (at[:, 0] - 0.37) ** 2 + 30 * abs(at[:, 1] - np.sin(2 * at[:, 0])),
            (0.37, np.sin(0.74)),
        ),
        (lambda at: 1 + abs(at[:, 0] - 0.41) + 3 * abs(at[:, 1] - 0.7 * at[:, 0]), (0.41, 0.287)),
        (lambda at: 1 + at[:, 0] + (at[:, 1] - 0.2) ** 2, (0.0, 0.2)),
        (
            lambda at: np.where(at.sum(axis=1) < 1, 1 + ((at - 1) ** 2).sum(axis=1), np.nan),
            (0.5, 0.5),
        ),
    ],
)
def test_the_lowest_place_of_narrow_curved_valleys(
    function: Callable[[Array], Array], place: tuple[float, ...]
) -> None:
    """Smooth, with a kink along the valley, at an edge, and at the end of what counts."""
    result, value = lowest(function, 2)
    expected = 1.5 if place == (0.5, 0.5) else 1.0
    assert value == pytest.approx(expected, rel=1e-11)
    assert result == pytest.approx(np.array(place), abs=2e-6)


def test_an_end_of_the_range_may_fail_by_what_is_wanted() -> None:
    """The vessel of this end would empty: ΔV/2 is 11.3 cm³."""
    result = found_in(
        "triplex-pump", "pump.delivery_pipe.vessel.volume=0.001:10 l", "vessel_swing = 1 %"
    )
    assert len(result.found) == 1
    assert "would empty" in result.failed[0].why
    vary = (
        "--vary",
        "pump.delivery_pipe.vessel.volume=0.001,1 l",
        "--columns",
        "vessel_swing",
        "-f",
        "csv",
    )
    ran = run("sweep", str(CONFIGS["triplex-pump"]), *vary)
    assert [("would empty" in line) for line in ran.stdout.splitlines()] == [False, True, False]


SPEEDS = (15, 30, 45, 60, 75, 90, 105, 120, 150)
STROKES = ((400, 600), (450, 700), (500, 800), (300, 900))
ROUND_QUESTIONS = [(rpm, *span) for rpm in SPEEDS for span in STROKES]


@pytest.mark.parametrize(
    ("rpm", "low", "high"), few(ROUND_QUESTIONS, [(90, 400, 600), (45, 450, 700), (105, 300, 900)])
)
def test_round_questions_have_the_ends_of_their_range_as_solutions(
    rpm: int, low: int, high: int
) -> None:
    """c_m = 2 s n at both ends and in the middle, as a person writes it: the nearest float may be beyond the end."""
    head = "indicator: {head_end: {constant: {expansion: 2 bar, compression: 0 bar}}}"
    origin = decode(
        "<text>",
        f"{{speed: {rpm} rpm, stroke: 500 mm, rod_ratio: 5, bore: 200 mm, {head}}}".encode(),
    )
    for stroke in (low, (low + high) / 2, high):
        wanted = f"{stroke * rpm / 30000:.10g}"
        result = find_solutions(origin, [f"stroke={low}:{high} mm"], [f"c_m = {wanted} m/s"]).found
        assert [one.values[0] for one in result] == pytest.approx([stroke / 1000], rel=1e-12), (
            wanted
        )


@pytest.mark.parametrize(
    ("wanted", "having"), [("1.333333333333333 m/s", "every"), ("2 m/s", "no")]
)
def test_a_key_value_that_does_not_depend_on_the_key(wanted: str, having: str) -> None:
    origin = decode("<text>", b"{speed: 50 rpm, stroke: 800 mm, rod_ratio: 5}")
    with pytest.raises(
        NoSolutionError,
        match=f"{having} design has c_m = .*m/s throughout, and does not depend on rod",
    ):
        find_solutions(origin, ["rod_ratio=4:8"], [f"c_m = {wanted}"])


def test_a_key_value_that_is_constant_over_a_part_of_the_range_is_one_solution() -> None:
    places, jumps, until = roots(lambda x: np.maximum(x[:, 0] - 0.4, 0.0), 1.0)
    assert places == pytest.approx([0.0])
    assert until == pytest.approx([0.4], abs=1e-9)
    assert not jumps.any()
    places, jumps, until = roots(lambda x: np.clip(x[:, 0] - 0.4, -0.1, 0.1) - 0.1, 1.0)
    assert places == pytest.approx([0.5], abs=1e-9)
    assert until == pytest.approx([1.0])
