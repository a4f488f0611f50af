"""kurbel check: limits, expectations, findings for programs, warnings, firing order."""

import json
import math
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest

from command import run
from kurbel import loads, solve
from representative import CONFIGS

pytestmark = pytest.mark.usefixtures("solved_once")

ENDLESS = "{constant: {expansion: 1e300 at, compression: 1e300 at}}"
HUGE = f"crank: 1 m\nrod_ratio: 5\nbore: 1 m\nindicator: {{head_end: {ENDLESS}}}\n"
ENGINE = "speed: 60 rpm\ncrank: 400 mm\nrod: 2 m\nbore: 450 mm\n"
PRESSURE = "constant: {expansion: 5 bar, compression: 1 bar}"
GAUGE = "indicator: {head_end: {trace: {unit: bar, points: [[0, 1], [180, 5], [360, 1]]}}}\n"


def called(text: str, *arguments: str) -> tuple[int, str, str]:
    result = run(*arguments, "-", text=text)
    return result.exit_code, result.stdout, result.stderr


# limits


def test_what_overflows_is_neither_kept_nor_broken() -> None:
    status, listed, said = called(HUGE + "limits: {work: 1 J, stroke: 1 m}\n", "check")
    assert status == 2
    assert "too large" in said
    assert "PASS" not in listed
    assert "nan" not in listed + said
    assert "inf " not in listed + said


# by the trapezoid rule the work of a sawtooth of four samples is far from that between them


def test_all_limits_are_told_in_one_run() -> None:
    status, listed, said = called(
        ENGINE + "limits: {c_max: 1 m/s, delta: 1/100, sigma_pin_max: 1 MPa, v: 9 m/s}\n", "check"
    )
    assert status == 2
    assert "FAIL  (cylinder 1)" in listed
    assert "≤ 9 m/s  PASS" in listed
    assert "limits.delta: " in said
    assert "limits.sigma_pin_max: " in said


def test_a_machine_that_stalls_does_not_hide_a_broken_limit() -> None:
    text = ENGINE + f"indicator: {{head_end: {{{PRESSURE}}}}}\nflywheel: {{inertia: 1e-3 kg m2}}\n"
    status, listed, said = called(text + "limits: {delta: 0.01, c_max: 1 m/s}\n", "check")
    assert (status, "FAIL" in listed, said.startswith("Error: limits.delta: ")) == (3, True, True)
    assert called(text + "limits: {delta: 0.01, sigma_pin_max: 1 MPa}\n", "check")[0] == 2


@pytest.mark.parametrize(
    ("limit", "shown"),
    [
        ("c_max: 6000 mm/s", "≤ 6000 mm/s  PASS"),
        ("stroke: 3 ft", "≤ 3 ft  PASS"),
        ("stroke: 2 1/2 ft", "2.62467192 ft > 2.5 ft  FAIL"),
        ("N_i: 50 PS", "> 50 PS  FAIL"),
        ("loss_crosshead_redtenbacher: 1 %", "1 % ≤ 1 %  PASS"),
        ("loss_crosshead_redtenbacher: 1/200", "0.01 > 0.005  FAIL"),
    ],
)
def test_a_limit_is_shown_in_the_unit_in_which_it_was_written(limit: str, shown: str) -> None:
    """s = 0.8 m / 0.3048 m; ½ λ f = ½ · 0.2 · 0.1."""
    text = ENGINE + f"friction: {{crosshead: 0.1}}\nindicator: {{head_end: {{{PRESSURE}}}}}\nlimits: {{{limit}}}\n"
    assert shown in called(text, "check")[1]


def test_a_limit_passed_in_magnitude_by_the_other_sign_is_told() -> None:
    text = ENGINE + f"masses: {{piston: 500 kg}}\nindicator: {{head_end: {{{PRESSURE}}}}}\n"
    low, high = sorted(solve(loads(text)).cylinders[0].extremes_of("T") or (), key=lambda one: one.value)
    assert high.value > 0 > low.value
    assert -low.value < high.value  # so that the largest magnitude is that of T_max
    halfway = (high.value - low.value) / 2
    status, listed, _ = called(text + f"limits: {{T_min: -{halfway} N}}\n", "check")
    assert status == 0
    assert f"T_max = {high.value:.9g} N is beyond it with the other sign; " in listed
    for told in ("", f", T_max: {2 * high.value} N"):  # who bounds the other end too knows
        status, listed, _ = called(text + f"limits: {{T_min: -{2 * high.value} N{told}}}\n", "check")
        assert (status, "other sign" in listed) == (0, False)


# expectations


def test_expected_figures_are_compared() -> None:
    """b_max = ω² R (1 + λ) for the straight slider-crank: (2π)² · 0.4 · 1.2 = 18.9496 m/s²."""
    for figure in ("18.95 m/s2 ± 0.5 %", "18.95 m/s2 +- 0.5 %", "18.95 ± 0.05 m/s2", "18.95 m/s2 ± 1 cm/s2"):
        for name in ("b_max", "'b_max'"):
            status, listed, _ = called(ENGINE + f'expect: {{{name}: "{figure}"}}\n', "check")
            assert (status, "  PASS  (cylinder 1)" in listed) == (0, True), figure
    status, listed, _ = called(ENGINE + "expect: {b_max: [18.9 m/s2, 19 m/s2], c_m: 1600 mm/s +/- 1 %}\n", "check")
    assert (status, listed.count("  PASS  ")) == (0, 2)
    status, listed, _ = called(ENGINE + 'expect: {b_max: "18.8 m/s2 ± 0.5 %"}\n', "check")
    off = (2 * math.pi) ** 2 * 0.4 * 1.2 - 18.8 * 1.005
    assert status == 1
    assert f"FAIL, {off:.9g} m/s2 too large  (cylinder 1)" in listed
    status, listed, _ = called(ENGINE + "expect: {c_m: [1.7 m/s, 1.8 m/s]}\n", "check")
    assert (status, "1.6 m/s, expected 1.7 m/s to 1.8 m/s  FAIL, 0.1 m/s too small" in listed) == (1, True)


# findings for programs

FINDING = ["file", "line", "column", "key", "message", "severity"]


def found_as_json(text: str, *arguments: str) -> tuple[int, dict[str, Any]]:
    status, listed, said = called(text, "check", "-f", "json", *arguments)
    assert said == ""
    parsed: dict[str, Any] = json.loads(listed)
    assert all(list(one) == FINDING for one in parsed["findings"])
    return status, parsed


def test_findings_of_a_check_have_their_place() -> None:
    text = ENGINE + "limits:\n  c_max: 1 m/s\n  delta: 0.01\n  s: 900 mm\nexpect:\n  φ_o: 180 deg ± 1 deg\n"
    status, parsed = found_as_json(text)
    places = {one["key"]: (one["line"], one["column"], one["severity"]) for one in parsed["findings"] if one["key"]}
    assert status == 2  # δ cannot be judged
    assert parsed["machine"] == "machine"
    assert places == {
        "limits.c_max": (6, 3, "error"),
        "limits.s": (8, 3, "info"),
        "expect.φ_o": (10, 3, "info"),
        "limits.delta": (7, 3, "error"),
    }
    (left_out,) = (one for one in parsed["findings"] if "no bore" in one["message"] or "no indicator" in one["message"])
    assert (left_out["key"], left_out["severity"]) == (None, "info")
    assert found_as_json(ENGINE + "limits: {c_max: 1 m/s}\n")[0] == 1
    assert found_as_json(ENGINE)[0] == 0


def test_a_warning_has_the_place_of_its_cylinder() -> None:
    one = "  - {name: %s, crank: 400 mm, rod: 2 m, bore: 450 mm, %s}\n"
    text = "speed: 60 rpm\ncylinders:\n" + one % ("left", GAUGE.strip()) + one % ("right", GAUGE.strip())
    warnings = [one for one in found_as_json(text)[1]["findings"] if "absolute?" in one["message"]]
    assert [(one["key"], one["line"], one["severity"]) for one in warnings] == [
        ("cylinders[0]", 3, "warning"),
        ("cylinders[1]", 4, "warning"),
    ]


JENKINS = {
    "testsuites": {"name", "time", "tests", "failures", "errors"},
    "testsuite": {
        "name",
        "tests",
        "failures",
        "errors",
        "group",
        "time",
        "skipped",
        "timestamp",
        "hostname",
        "id",
        "file",
    },
    "testcase": {"name", "time", "classname", "group"},
    "failure": {"type", "message"},
    "system-out": set(),
}
"""Elements and attributes of the schema junit-10.xsd of the xUnit plugin of Jenkins, as far as they are used."""


def test_a_check_as_junit(tmp_path: Path) -> None:
    good, bad, wrong = (tmp_path / name for name in ("good.yaml", "b&d.yaml", "wrong.yaml"))
    engine = "{speed: 50 rpm, crank: 400 mm, rod: 2000 mm, "
    good.write_text(engine + "limits: {c_max: 3 m/s}, expect: {b_max: 13.16 m/s2 ± 0.1 %}}", encoding="utf-8")
    bad.write_text(engine + "limits: {c_max: 1 m/s, b_max: 20 m/s2}}", encoding="utf-8")
    wrong.write_text("crank: <400", encoding="utf-8")
    results = tmp_path / "results.xml"
    ended = run("check", *map(str, (good, bad, wrong)), "-o", results)
    assert (ended.exit_code, ended.stdout) == (2, "")
    root = ElementTree.parse(results).getroot()
    for one in root.iter():
        assert set(one.attrib) <= JENKINS[one.tag]
    suites = {suite.attrib["name"]: suite for suite in root}
    assert list(suites) == [str(good), str(bad), str(wrong)]
    failed = {name: len(suite.findall("testcase/failure")) for name, suite in suites.items()}
    assert list(failed.values()) == [0, 1, 2]  # the length is no number, and the rod is missing
    assert any(case.attrib["name"].startswith("crank: ") for case in suites[str(wrong)])
    for name, suite in suites.items():
        cases = suite.findall("testcase")
        assert (int(suite.attrib["tests"]), int(suite.attrib["failures"])) == (len(cases), failed[name])
        names = [case.attrib["name"] for case in cases]
        assert len(set(names)) == len(names)  # GitLab reads the first of a name alone
        assert {case.attrib["classname"] for case in cases} == {name}
    assert len(root.findall("*/testcase/failure")) == 3
    (limit,) = (case for case in suites[str(bad)] if case.attrib["name"] == "c_max")
    (failure,) = limit
    assert "2.13593341 m/s > 1 m/s" in failure.attrib["message"]
    assert (failure.text or "").startswith(f"{bad}:1:")


def test_a_machine_without_a_finding_is_a_test_that_passes() -> None:
    text = "{crank: 400 mm, rod: 2000 mm}"
    status, listed, _ = called(text, "check", "-f", "junit")
    (suite,) = ElementTree.fromstring(listed.encode())
    assert (status, int(suite.attrib["tests"]) > 0, suite.attrib["failures"]) == (0, True, "0")


def test_faults_of_the_file_are_findings_too(tmp_path: Path) -> None:
    status, parsed = found_as_json("speed: 60\ncrank: 400 mm\nrd: 2 m\n")
    assert (status, parsed["machine"]) == (2, None)
    assert [tuple(one[key] for key in FINDING if key != "message") for one in parsed["findings"]] == [
        ("<stdin>", 1, 8, "speed", "error"),
        ("<stdin>", 3, 1, "rd", "error"),
    ]
    assert parsed["findings"][1]["message"] == "unknown key; did you mean 'rod'?"
    (tmp_path / "m.yaml").write_text("crank: [")
    for name, line in (("m.yaml", 1), ("none.yaml", None)):
        result = run("check", tmp_path / name, "-o", tmp_path / "out.json")
        (finding,) = json.loads((tmp_path / "out.json").read_text(encoding="utf-8"))["findings"]
        assert (result.exit_code, finding["line"], finding["severity"]) == (2, line, "error")


SEVERAL = {
    "good.yaml": ENGINE,
    "slow.yaml": "name: The slow one\n" + ENGINE + "limits: {c_max: 9 m/s}\n",
    "fast.yaml": ENGINE + "limits:\n  c_max: 1 m/s\n",
    "wrong.yaml": ENGINE + "bor: 1 m\n",
}


@pytest.mark.parametrize(
    ("names", "status"),
    [
        (("good", "slow"), 0),
        (("fast", "good", "slow"), 1),
        (("wrong", "fast", "good"), 2),
        (("good", "none"), 2),
    ],
)
def test_many_files_are_checked_in_one_run(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, names: tuple[str, ...], status: int
) -> None:
    """The gravest status of all; each file is named with what is found in it, and none hides another one."""
    monkeypatch.chdir(tmp_path)
    for name, text in SEVERAL.items():
        Path(name).write_text(text)
    files = [f"{name}.yaml" for name in names]
    result = run("check", *files)
    assert result.exit_code == status
    assert all(name in result.stdout + result.stderr for name in files)
    assert result.stdout.count("a valid machine") == len({*names} & {"good", "slow", "fast"})
    assert ("wrong.yaml:5:1: bor: unknown key" in result.stderr) == ("wrong" in names)
    as_json = run("check", *files, "-f", "json")
    assert as_json.exit_code == status
    found = json.loads(as_json.stdout)["findings"]
    assert {one["file"] for one in found} == set(files)


# notes


@pytest.mark.parametrize("command", ["check", "forces", "flywheel"])
def test_notes_name_their_cylinder(command: str) -> None:
    one = "{name: %s, crank: 400 mm, rod: 2 m, bore: 450 mm, %s}"
    both = ", ".join(one % (name, GAUGE.strip()) for name in ("left", "right"))
    _, printed, _ = called(f"speed: 60 rpm\ncylinders: [{both}]\nbrake_power: 1e6 kW\n", command)
    assert printed.count("about the ambient: absolute?") == 1
    assert printed.count("is below the brake power") == 1
    lines = [line.strip() for line in printed.splitlines()]
    (place,) = (index for index, line in enumerate(lines) if "about the ambient" in line)
    if command == "flywheel":
        assert lines[place].startswith("left, right: piston, head end: ")
    else:  # below the head of both
        assert any("left, right" in line for line in lines[:place])


# firing


def firing(text: str) -> list[str]:
    status, listed, _ = called(text, "check", "-f", "json")
    assert status == 0
    found = [one["message"] for one in json.loads(listed)["findings"]]
    return [one for one in found if one.startswith("firing: ") or "uneven" in one]


TWIN = "cycle: four-stroke\ncylinders: {count: 2, bank_angles: [0 deg, 90 deg], each: {stroke: 80 mm, rod_ratio: 4}}\n"


def test_check_lists_firing_angles_and_intervals() -> None:
    told = ["order 1-2, at 0, 450 deg, intervals 450, 270 deg", "the firing intervals are uneven: 270 to 450 deg"]
    assert firing(TWIN) == [f"firing: {told[0]}", f"note: {told[1]}"]
    listed = called(TWIN, "check")[1]
    assert all(line in listed for line in told)
    assert firing(TWIN.replace("90 deg", "360 deg")) == ["firing: order 1-2, at 0, 360 deg, intervals 360 deg"]


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("gas-engine", ["firing: at 0 deg, intervals 720 deg"]),
        # the crank end fires one stroke after the head end (R p. 609)
        (
            "gas-engine-double-acting",
            ["firing: at 0, 180 deg, intervals 180, 540 deg", "note: the firing intervals are uneven: 180 to 540 deg"],
        ),
        ("marine-diesel", ["firing: order 1-5-3-4-2-6, at 0, 60, 120, 180, 240, 300 deg, intervals 60 deg"]),
        ("waterworks-two-cranks", []),
        ("compressor-two-stage", []),
    ],
)
def test_every_engine_and_nothing_else_fires(name: str, expected: list[str]) -> None:
    assert firing(CONFIGS[name].read_text(encoding="utf-8")) == expected


def test_a_firing_angle_is_that_of_the_dead_centre() -> None:
    """Of an offset slider-crank φ_i = asin(e/(L + R)), here e/(L + R) = 1/10."""
    (told,) = firing("cycle: four-stroke\ncrank: 100 mm\nrod: 400 mm\noffset: 50 mm\n")
    assert abs(float(told.split()[2])) % 720 == pytest.approx(math.degrees(math.asin(0.1)), abs=1e-4)


# whose key value a limit or an expectation is put on: `machine.T_max`, `HP.T_max`, and `T_max` alone

CARD = "{constant: {expansion: 2 bar, compression: 0 bar}}"
TWO = f"""\
speed: 60 rpm
cylinders:
- {{name: HP, stroke: 1 m, rod_ratio: infinite, bore: 400 mm, indicator: {{head_end: {CARD}, crank_end: {CARD}}}}}
- {{like: HP, name: LP, bore: 500 mm, crank_position: 0 deg}}
"""
"""With an infinite rod T = 2 bar · A |sin φ| of each cylinder, and the sum of both of the machine."""
HP, LP = (2e5 * math.pi / 4 * bore**2 for bore in (0.4, 0.5))


def newton(force: float) -> str:
    return f"{force!r} N"


def of_two(figures: str, *arguments: str) -> tuple[int, str]:
    status, listed, said = called(TWO + figures, *arguments)
    return status, listed + said


@pytest.mark.parametrize(
    ("name", "largest"), [("T_max", LP), ("HP.T_max", HP), ("LP.T_max", LP), ("machine.T_max", HP + LP)]
)
def test_a_limit_is_held_against_those_it_names(name: str, largest: float) -> None:
    """Of each cylinder, and not of the machine, where nobody is named."""
    assert of_two(f"limits: {{{name}: {newton(1.001 * largest)}}}", "check")[0] == 0
    status, told = of_two(f"limits: {{{name}: {newton(0.999 * largest)}}}", "check")
    assert status == 1
    assert told.count("FAIL") == 1


def test_expectations_have_scopes_too() -> None:
    figures = {"machine.T_max": HP + LP, "HP.T_max": HP, "LP.T_max": LP}
    lines = [f"  {name}: {newton(size)} ± 0.1 %" for name, size in figures.items()]
    status, told = of_two("\n".join(["expect:", *lines]), "check")
    assert (status, told.count(" PASS ")) == (0, 3)
    assert of_two(f"expect: {{T_max: {newton(LP)} ± 0.1 %}}", "check")[0] == 1  # the HP cylinder has less


def test_findings_stand_at_the_name_as_it_is_written() -> None:
    result = of_two(f"limits: {{machine.T_max: {newton(1)}}}", "check", "-f", "json")[1]
    found = [one for one in json.loads(result)["findings"] if one["key"] == "limits.machine.T_max"]
    assert [(one["line"], one["column"], one["severity"]) for one in found] == [(5, 10, "error")]


def test_a_sweep_keeps_limits_of_those_they_name() -> None:
    bounds = f"limits: {{LP.T_max: {newton(1.001 * LP)}, machine.T_max: {newton(1.001 * (HP + LP))}}}"
    asked = ("sweep", "--vary", "cylinders.1.bore=400,500,600 mm", "--vary", "speed=50,60 rpm", "--columns", "LP.T_max")
    status, told = of_two(bounds, *asked, "-f", "json")
    found = [json.loads(line) for line in told.splitlines()]
    assert (status, [one["broken"] for one in found]) == (0, [None, None, None, None, "LP.T_max", "LP.T_max"])
    told = of_two(bounds, *asked, "-f", "json", "--set", "limits={}", "--set", "limits.machine.T_max=56 kN")[1]
    assert [json.loads(line)["broken"] for line in told.splitlines()] == [None] * 2 + ["machine.T_max"] * 4


def test_check_lists_what_pumps_and_compressors_deliver() -> None:
    """Of a machine that delivers nothing there is no such section; what its command refuses is the reason here."""
    names = ("triplex-pump", "compressor-two-stage", "gas-engine")
    pump, compressor, engine = (CONFIGS[one].read_text(encoding="utf-8") for one in names)
    for text, listed in (
        (pump, ("Delivery", "flow, fluctuating volume")),
        (compressor, ("stages and ends", "0.9657 times")),
        (pump.replace("volume: 4 l", "volume: 0.01 l").partition("limits:")[0], ("would empty",)),
    ):
        status, out, _ = called(text, "check")
        assert status == 0
        assert all(one in out for one in listed), out
    assert "Delivery" not in called(engine, "check")[1]


def test_shipped_machines_keep_their_limits_and_the_figures_that_their_sources_print() -> None:
    result = run("check", "-f", "json", *map(str, CONFIGS.values()))
    assert result.exit_code == 0, result.output
    messages = [(Path(one["file"]).stem, one["message"]) for one in json.loads(result.stdout)["findings"]]
    compared = {name for name, message in messages if ", expected " in message}
    assert compared == {"waterworks", "waterworks-two-cranks", "locomotive", "gas-engine"}
