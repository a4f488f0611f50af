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

ENGINE = "speed: 60 rpm\ncrank: 400 mm\nrod: 2 m\nbore: 450 mm\n"
PRESSURE = "constant: {expansion: 5 bar, compression: 1 bar}"
GAUGE = "indicator: {role: engine, head_end: {trace: {unit: bar, points: [[0, 1], [180, 5], [360, 1]]}}}\n"


def called(text: str, *arguments: str) -> tuple[int, str, str]:
    result = run(*arguments, "-", text=text)
    return result.exit_code, result.stdout, result.stderr


def test_a_limit_passed_in_magnitude_by_the_other_sign_is_reported() -> None:
    text = ENGINE + f"masses: {{piston: 500 kg}}\nindicator: {{head_end: {{{PRESSURE}}}}}\n"
    low, high = sorted(
        solve(loads(text)).cylinders[0].extremes_of("T") or (), key=lambda one: one.value
    )
    assert high.value > 0 > low.value
    assert -low.value < high.value  # so that the largest magnitude is that of T_max
    halfway = (high.value - low.value) / 2
    status, listed, _ = called(text + f"limits: {{T_min: -{halfway} N}}\n", "check")
    assert status == 0
    assert f"T_max = {high.value:.9g} N is beyond it with the other sign; " in listed
    for reported in ("", f", T_max: {2 * high.value} N"):  # who bounds the other end too knows
        status, listed, _ = called(
            text + f"limits: {{T_min: -{2 * high.value} N{reported}}}\n", "check"
        )
        assert (status, "other sign" in listed) == (0, False)


# findings for programs

PLACE = ["file", "line", "column", "key", "message", "severity"]
FINDING = [*PLACE, "id", "scope", "value", "bound", "unit", "margin", "verdict", "case"]


def found_as_json(text: str, *arguments: str) -> tuple[int, dict[str, Any]]:
    status, listed, said = called(text, "check", "-f", "json", *arguments)
    assert said == ""
    parsed: dict[str, Any] = json.loads(listed)
    assert all(list(finding) == FINDING for finding in parsed["findings"])
    return status, parsed


def test_findings_of_a_check_have_their_place() -> None:
    text = (
        ENGINE
        + "limits:\n  c_max: 1 m/s\n  delta: 0.01\n  s: 900 mm\nexpect:\n  φ_o: 180 deg ± 1 deg\n"
    )
    status, parsed = found_as_json(text)
    places = {
        finding["key"]: (finding["line"], finding["column"], finding["severity"])
        for finding in parsed["findings"]
        if finding["key"]
    }
    assert status == 2  # δ cannot be judged
    assert parsed["machine"] == "machine"
    assert places == {
        "limits.c_max": (6, 3, "error"),
        "limits.s": (8, 3, "info"),
        "expect.φ_o": (10, 3, "info"),
        "limits.delta": (7, 3, "error"),
    }
    (left_out,) = (
        finding
        for finding in parsed["findings"]
        if "no bore" in finding["message"] or "no indicator" in finding["message"]
    )
    assert (left_out["key"], left_out["severity"]) == (None, "info")
    assert found_as_json(ENGINE + "limits: {c_max: 1 m/s}\n")[0] == 1
    assert found_as_json(ENGINE)[0] == 0


def test_a_warning_has_the_place_of_its_cylinder() -> None:
    one = "  - {name: %s, crank: 400 mm, rod: 2 m, bore: 450 mm, %s}\n"
    text = (
        "speed: 60 rpm\ncylinders:\n"
        + one % ("left", GAUGE.strip())
        + one % ("right", GAUGE.strip())
    )
    warnings = [
        finding
        for finding in found_as_json(text)[1]["findings"]
        if "absolute?" in finding["message"]
    ]
    assert [(warning["key"], warning["line"], warning["severity"]) for warning in warnings] == [
        ("cylinders[0]", 3, "warning"),
        ("cylinders[1]", 4, "warning"),
    ]


JENKINS = {
    "testsuites": {"name", "time", "tests", "failures", "errors"},
    "testsuite": {"name", "tests", "failures", "errors", "group", "time", "skipped", "timestamp"}
    | {"hostname", "id", "file"},
    "testcase": {"name", "time", "classname", "group"},
    "failure": {"type", "message"},
    "system-out": set(),
}
"""Elements and attributes of the schema junit-10.xsd of the xUnit plugin of Jenkins, as far as they are used."""


def test_a_check_as_junit(tmp_path: Path) -> None:
    good, bad, wrong = (tmp_path / name for name in ("good.yaml", "b&d.yaml", "wrong.yaml"))
    engine = "{speed: 50 rpm, crank: 400 mm, rod: 2000 mm, "
    good.write_text(
        engine + "limits: {c_max: 3 m/s}, expect: {b_max: 13.16 m/s2 ± 0.1 %}}", encoding="utf-8"
    )
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
        assert (int(suite.attrib["tests"]), int(suite.attrib["failures"])) == (
            len(cases),
            failed[name],
        )
        names = [case.attrib["name"] for case in cases]
        assert len(set(names)) == len(names)  # GitLab reads the first of a name alone
        assert {case.attrib["classname"] for case in cases} == {name}
    assert len(root.findall("*/testcase/failure")) == 3
    (limit,) = (case for case in suites[str(bad)] if case.attrib["name"] == "c_max")
    (failure,) = limit
    assert "2.13593341 m/s > 1 m/s" in failure.attrib["message"]
    assert (failure.text or "").startswith(f"{bad}:1:")


def test_faults_of_the_file_are_findings_too(tmp_path: Path) -> None:
    status, parsed = found_as_json("speed: 60\ncrank: 400 mm\nrd: 2 m\n")
    assert (status, parsed["machine"]) == (2, None)
    assert [
        tuple(finding[key] for key in PLACE if key != "message") for finding in parsed["findings"]
    ] == [
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
    results = json.loads(as_json.stdout)["findings"]
    assert {result["file"] for result in results} == set(files)


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
    ("name", "largest"),
    [("T_max", LP), ("HP.T_max", HP), ("LP.T_max", LP), ("machine.T_max", HP + LP)],
)
def test_a_limit_is_held_against_those_it_names(name: str, largest: float) -> None:
    """Of each cylinder, and not of the machine, where nobody is named."""
    assert of_two(f"limits: {{{name}: {newton(1.001 * largest)}}}", "check")[0] == 0
    status, reported = of_two(f"limits: {{{name}: {newton(0.999 * largest)}}}", "check")
    assert status == 1
    assert reported.count("FAIL") == 1


def test_expectations_have_scopes_too() -> None:
    figures = {"machine.T_max": HP + LP, "HP.T_max": HP, "LP.T_max": LP}
    lines = [f"  {name}: {newton(size)} ± 0.1 %" for name, size in figures.items()]
    status, reported = of_two("\n".join(["expect:", *lines]), "check")
    assert (status, reported.count(" PASS ")) == (0, 3)
    assert (
        of_two(f"expect: {{T_max: {newton(LP)} ± 0.1 %}}", "check")[0] == 1
    )  # the HP cylinder has less


def test_a_sweep_keeps_limits_of_those_they_name() -> None:
    bounds = (
        f"limits: {{LP.T_max: {newton(1.001 * LP)}, machine.T_max: {newton(1.001 * (HP + LP))}}}"
    )
    words = (
        "sweep",
        "--vary",
        "cylinders.1.bore=400,500,600 mm",
        "--vary",
        "speed=50,60 rpm",
        "--columns",
        "LP.T_max",
    )
    status, reported = of_two(bounds, *words, "-f", "json")
    results = [json.loads(line) for line in reported.splitlines()]
    assert (status, [result["broken"] for result in results]) == (
        0,
        [None, None, None, None, "LP.T_max", "LP.T_max"],
    )
    reported = of_two(
        bounds, *words, "-f", "json", "--set", "limits={}", "--set", "limits.machine.T_max=56 kN"
    )[1]
    assert [json.loads(line)["broken"] for line in reported.splitlines()] == [None] * 2 + [
        "machine.T_max"
    ] * 4


def test_shipped_machines_keep_their_limits_and_the_figures_that_their_sources_print() -> None:
    result = run("check", "-f", "json", *map(str, CONFIGS.values()))
    assert result.exit_code == 0, result.output
    messages = [
        (Path(finding["file"]).stem, finding["message"])
        for finding in json.loads(result.stdout)["findings"]
    ]
    compared = {name for name, message in messages if ", expected " in message}
    assert compared >= {"waterworks", "waterworks-two-cranks", "locomotive", "gas-engine"}


def test_check_lists_the_events_of_a_slide_valve() -> None:
    """Infinite rods: r sin(φ + δ) is the lap at an event, sin δ = (15 + 3)/30; x = (1 − cos φ)/2 of the stroke.

    Cut-off at 180 − 30 − 36.87 = 113.13 degrees, release at 143.13, admission at −6.87, compression at −36.87.
    """
    text = (
        "{speed: 60 rpm, crank: 300 mm, rod: infinite, bore: 300 mm, indicator: {head_end: {steam: {admission: 5 bar, "
        "exhaust: 0.2 bar, clearance: 0.05}}, crank_end: mirrored}, valve: {travel: 60 mm, steam_lap: 15 mm, exhaust_lap: 0 mm, lead: 3 mm}}"
    )
    printed = run("check", "-", text=text)
    assert printed.exit_code == 0, printed.output
    assert (
        "valve      head end: admission 0.4 % before the dead centre (353.1 deg), cut-off at 69.6 % (113.1 deg), "
        "release at 90 % (143.1 deg), compression 10 % before the dead centre (323.1 deg)\n"
    ) in printed.stdout
    assert "valve" not in run("check", str(CONFIGS["locomotive"])).stdout


LIMITED = """
speed: 60 rpm
stroke: 800 mm
rod: infinite
limits: {c_max: 3 m/s, stroke: 0.7 m}
expect: {v: 2.5 m/s ± 0.1 m/s}
cases: [{name: fast, set: {speed: 75 rpm}}]
"""
"""c_max = v = R ω: 2.513274 m/s at 60, 3.141593 m/s at 75 per minute."""


def test_json_has_every_verdict_with_its_figures_and_its_margin() -> None:
    checked = run("check", "-", "-f", "json", text=LIMITED)
    assert checked.exit_code == 1
    findings = json.loads(checked.stdout)["findings"]
    figures = {(row["id"], row["case"]): row for row in findings if row["verdict"]}
    v = 0.8 * math.pi
    c_max = figures["c_max", ""]
    assert (c_max["scope"], c_max["unit"], c_max["verdict"]) == ("cylinder 1", "m/s", "PASS")
    assert (c_max["value"], c_max["bound"]) == (pytest.approx(v), 3.0)
    assert c_max["margin"] == pytest.approx((3 - v) / 3)
    fast = figures["c_max", "fast"]
    assert (fast["verdict"], fast["margin"]) == ("FAIL", pytest.approx((3 - 1.25 * v) / 3))
    assert figures["stroke", ""]["margin"] == pytest.approx(-0.1 / 0.7)
    expected = figures["v", ""]
    assert expected["bound"] == [pytest.approx(2.4), pytest.approx(2.6)]
    assert expected["margin"] == pytest.approx((2.6 - v) / 2.6)
    others = [row for row in findings if not row["verdict"]]
    assert others
    assert all(row["value"] is row["bound"] is row["margin"] is None for row in others)


def test_margins_of_limits_in_all_load_cases_are_a_table() -> None:
    lines = run("check", "-", text=LIMITED).stdout.splitlines()
    start = lines.index("Margins to the limits")
    assert [line.split() for line in lines[start + 1 : start + 4]] == [
        ["machine", "fast"],
        ["c_max", "+16.2", "%", "-4.7", "%"],
        ["stroke", "-14.3", "%", "-14.3", "%"],
    ]
    without_cases = LIMITED[: LIMITED.index("cases")]
    assert "Margins" not in run("check", "-", text=without_cases).stdout


def test_a_quiet_check_prints_what_fails() -> None:
    quiet = run("check", "-", "--quiet", text=LIMITED)
    assert quiet.exit_code == 1
    names = [line.split(":")[1].strip() for line in quiet.stdout.splitlines()]
    assert names == ["stroke", "c_max, fast", "stroke, fast", "v, fast"]
    good = run("check", str(CONFIGS["waterworks"]), "-q")
    assert (good.exit_code, good.stdout) == (0, "")


def test_what_is_left_out_is_no_test_of_junit() -> None:
    text = run("check", "-", "-f", "junit", text=LIMITED).stdout
    assert "left out" in run("check", "-", text=LIMITED).stdout
    names = [case.get("name") for case in ElementTree.fromstring(text).iter("testcase")]
    assert names == ["c_max", "stroke", "c_max, fast", "stroke, fast", "v", "v, fast"]
