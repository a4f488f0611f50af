"""Stiff and extreme cases: the whole table passes, and a wrong answer would not."""

from __future__ import annotations

from decimal import Decimal

import pytest

from kurbel.accuracy.extremes import Absent, Oracle, Probe, Refusal, all_cases
from kurbel.accuracy.extremes.judge import judged
from kurbel.errors import NoSolutionError, UsageError
from kurbel.machine_file import loads
from kurbel.report.accuracy import answer

CASES = all_cases()
PLAIN = "{speed: 60 rpm, crank: 400 mm, rod_ratio: 5}"


def ask(text: str, asked: str) -> float | None:
    return answer(loads(text), asked)


def test_there_are_many_cases() -> None:
    assert len(CASES) >= 60


def quick(case: Probe) -> bool:
    """Whether no decimal reference is asked that takes most of a second: of energy, power series, or many samples."""
    dear = ("flywheel omega@", "flywheel dE", "forces T_max", "forces T_min", "forces friction_work")
    return (case.name, case.asked) in KEPT or not (
        case.asked.startswith(dear) or case.name in ("1e5 noisy samples", "polytropic card")
    )


KEPT = {
    ("no flywheel", "flywheel dE"),
    ("vertical jumps", "forces T_max"),
    ("friction 0.06", "forces friction_work"),
}
"""One of each of the dear ones by default."""


DEAR = {(case.name, case.asked.partition("@")[0]): case for case in CASES if not quick(case)}.values()
"""At one angle each: `kurbel accuracy --extremes` asks at all."""


def told(case: Probe) -> str:
    """What is wrong with the answer of a case; '' where nothing is."""
    one = judged(case, ask, loads)
    wrong = f"{case.name}, {case.asked}: expected {one.expected}, observed {one.observed} ({one.ulp} ulp)"
    return "" if one.passed else wrong


@pytest.mark.parametrize("command", ["motion", "forces", "flywheel"])
def test_quick_cases(command: str) -> None:
    cases = [case for case in CASES if quick(case) and case.asked.startswith(command)]
    assert cases
    assert [wrong for case in cases if (wrong := told(case))] == []


@pytest.mark.slow
@pytest.mark.parametrize("case", DEAR, ids=[f"{case.name}: {case.asked}" for case in DEAR])
def test_dear_case(case: Probe) -> None:
    assert told(case) == ""


@pytest.mark.parametrize(
    ("expected", "observed"),
    [
        (Oracle(), 0.1),
        (Oracle(), None),
        (Oracle(), float("nan")),
        (Oracle(), UsageError("no")),
        (Oracle(), ZeroDivisionError("division by zero")),
        (Absent(), 1.0),
        (Refusal("too large"), 1.0),
        (Refusal("too large"), UsageError("too small")),
        (Refusal("locks", 3), UsageError("locks")),
        (lambda: Decimal(1), 1.0 + 1e-14),
        (0, 1e-300),
    ],
)
def test_a_wrong_answer_fails(expected: object, observed: object) -> None:
    def wrong(text: str, asked: str) -> object:
        if isinstance(observed, Exception):
            raise observed
        return observed

    assert not judged(Probe("wrong", PLAIN, "motion x@30", expected), wrong, loads).passed  # type: ignore[arg-type]


def test_a_right_refusal_passes() -> None:
    def refuses(text: str, asked: str) -> object:
        raise NoSolutionError("the crosshead locks itself")

    assert judged(Probe("right", PLAIN, "motion x@30", Refusal("locks itself", 3)), refuses, loads).passed
