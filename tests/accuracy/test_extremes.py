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
    assert len(CASES) == 180
    assert all(case.asked and case.expected for case in CASES)


QUICK = {
    ("no flywheel", "flywheel dE"),
    ("vertical jumps", "forces T_max"),
    ("friction 0.06", "forces friction_work"),
}
"""One of each of the dear kinds, every day."""
BY_HAND = {
    ("two cranks at 90°", "flywheel dE"),
    ("friction 1e-15", "forces friction_work"),
    ("work at rest", "forces work"),
    ("card of 1e5 points", "forces work"),
}
"""Cases of seconds that others are like: `kurbel accuracy --extremes` has them all."""


def is_quick(case: Probe) -> bool:
    """Return whether no reference is computed that takes most of a second: of energy, or of many samples."""
    dear = ("flywheel dE", "forces T_max", "forces T_min", "forces friction_work", "balance")
    if (case.case, case.asked) in QUICK:
        return True
    if case.case in ("polytropic card", "card of 1e5 points", "trace of 1e5 points"):
        return False
    return not case.asked.startswith(dear)


def faults(cases: list[Probe]) -> list[str]:
    """Return what is wrong with the answers of cases."""
    wrong = []
    for verdict in verdicts(cases, answer_of, loads):
        if not verdict.passed:
            missed = f"observed {verdict.observed} ({verdict.ulp} ulp)"
            wrong.append(f"{verdict.case}, {verdict.asked}: expected {verdict.expected}, {missed}")
    return wrong


@pytest.mark.parametrize("command", sorted({case.asked.split()[0] for case in CASES} - {"balance"}))
def test_quick_cases(command: str) -> None:
    cases = [case for case in CASES if is_quick(case) and case.asked.startswith(command)]
    assert cases
    assert faults([case for case in cases if (case.case, case.asked) not in BY_HAND]) == []


@pytest.mark.slow
@pytest.mark.parametrize("command", ["forces", "flywheel", "balance"])
def test_dear_cases(command: str) -> None:
    cases = [case for case in CASES if not is_quick(case) and case.asked.startswith(command)]
    assert cases
    assert faults([case for case in cases if (case.case, case.asked) not in BY_HAND]) == []


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
    """They are no extremes; the messages are those of `tests/messages/refused.yaml`."""
    lines = (
        (Path(__file__).parent / "reading_faults.tsv").read_text(encoding="utf-8").splitlines()[1:]
    )
    cases = [Probe(*line.split("\t")) for line in lines]
    assert faults(cases) == []


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
