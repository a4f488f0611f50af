"""Stiff and extreme cases: the whole table passes, and a wrong answer would not."""

from pathlib import Path

import mpmath
import pytest
from extreme_formulas import all_formulas

from kurbel.accuracy.extremes import Probe, all_cases, verdicts
from kurbel.cli.comparing import answer_of
from kurbel.errors import NoSolutionError, UsageError
from kurbel.machine import Machine
from kurbel.machine_file import loads
from kurbel.report import accuracy

mp = mpmath.mp
CASES = all_cases()
PLAIN = "{speed: 60 rpm, crank: 400 mm, rod_ratio: 5}"


def test_there_are_many_cases() -> None:
    assert len(CASES) == 178
    assert all(case.asked and case.expected for case in CASES)


LONG = ("polytropic card", "card of 1e4 points")


def quick(case: Probe) -> bool:
    """Whether no reference is computed that takes most of a second: of energy, or of many samples."""
    dear = ("flywheel dE", "forces T_max", "forces T_min", "forces friction_work", "balance")
    return (case.case, case.asked) in KEPT or not (
        case.asked.startswith(dear) or case.case in ("polytropic card", "card of 1e4 points")
    )


KEPT = {
    ("no flywheel", "flywheel dE"),
    ("vertical jumps", "forces T_max"),
    ("friction 0.06", "forces friction_work"),
}
"""One of each of the dear ones by default."""


DEAR = {
    (case.case, case.asked.partition("@")[0]): case for case in CASES if not quick(case)
}.values()
"""At one angle each: `kurbel accuracy --extremes` asks at all."""


def fault(case: Probe) -> str:
    """What is wrong with the answer of a case; '' where nothing is."""
    (one,) = verdicts([case], answer_of, loads)
    wrong = f"{case.case}, {case.asked}: expected {one.expected}, observed {one.observed} ({one.ulp} ulp)"
    return "" if one.passed else wrong


@pytest.mark.parametrize("command", sorted({case.asked.split()[0] for case in CASES} - {"balance"}))
def test_quick_cases(command: str) -> None:
    cases = [case for case in CASES if quick(case) and case.asked.startswith(command)]
    assert cases
    assert [wrong for case in cases if (wrong := fault(case))] == []


@pytest.mark.slow
@pytest.mark.parametrize("case", DEAR, ids=[f"{case.case}: {case.asked}" for case in DEAR])
def test_dear_case(case: Probe) -> None:
    assert fault(case) == ""


@pytest.mark.parametrize(
    ("expected", "observed"),
    [
        ("reference", 0.1),
        ("reference", None),
        ("reference", float("nan")),
        ("reference", UsageError("no")),
        ("reference", ZeroDivisionError("division by zero")),
        ("left out", 1.0),
        ("status 2: too large", 1.0),
        ("status 2: too large", None),
        ("status 2: too large", UsageError("too small")),
        ("status 3: locks", UsageError("locks")),
        ("1", 1.0 + 1e-14),
        ("0", 1e-300),
    ],
)
def test_a_wrong_answer_fails(expected: str, observed: float | Exception | None) -> None:
    def wrong(machine: Machine, asked: str) -> float | None:
        if isinstance(observed, Exception):
            raise observed
        return observed

    ulp = "" if expected[:2] in ("st", "le") else "8"
    (verdict,) = verdicts([Probe("wrong", PLAIN, "motion x@30", expected, ulp)], wrong, loads)
    assert not verdict.passed


def test_a_right_refusal_passes() -> None:
    def refuses(machine: Machine, asked: str) -> float | None:
        raise NoSolutionError("the crosshead locks itself")

    (verdict,) = verdicts(
        [Probe("right", PLAIN, "motion x@30", "status 3: locks itself")], refuses, loads
    )
    assert verdict.passed


MARCHED = {
    (case.case, case.asked)
    for case in CASES
    if "omega@" in case.asked and case.case != "slip 1e-12"
}
"""Their references are those of benchmarks/speed_lines.py."""


def test_numbers_of_the_table_are_those_of_their_formulas() -> None:
    with mp.workdps(40):
        formulas = all_formulas()
        numbers = {
            (case.case, case.asked): case.expected
            for case in CASES
            if case.ulp and case.expected != "reference" and (case.case, case.asked) not in MARCHED
        }
        assert {at for at, number in numbers.items() if number != "0"} == set(formulas)
        assert all(abs(mpmath.mpf(numbers[at]) / formulas[at] - 1) < 1e-25 for at in formulas)


def test_every_command_has_extreme_cases() -> None:
    commands = (
        "motion forces flywheel torsion balance harmonics bearings stress delivery find sweep"
    )
    assert {case.asked.split()[0] for case in CASES} == set(commands.split())


def test_faults_of_reading_are_refused() -> None:
    """They are no extremes; the messages are those of `tests/refused.txt`."""
    lines = (
        (Path(__file__).parent / "reading_faults.tsv").read_text(encoding="utf-8").splitlines()[1:]
    )
    cases = [Probe(*line.split("\t")) for line in lines]
    assert [wrong for case in cases if (wrong := fault(case))] == []


def test_the_worst_verdict_comes_first(monkeypatch: pytest.MonkeyPatch) -> None:
    cases = [
        Probe("refused", "{speed: 60 rpm}", "motion x@30", "status 2: "),
        Probe("near", PLAIN, "motion x@30", "reference", "8"),
        Probe("wrong", PLAIN, "motion x@30", "1", "8"),
    ]
    monkeypatch.setattr(accuracy, "all_cases", lambda: cases)
    report, passed = accuracy.extremes_report(loads, answer_of)
    (judged,) = report.parts[0].place_tables
    assert not passed
    assert [names[0] for names in judged.names] == ["wrong", "near", "refused"]
    assert [column.id for column in judged.columns] == ["ulp", "allowed", "time"]
