"""Stiff and extreme cases: the whole table passes, and a wrong answer would not."""

import mpmath
import pytest

from kurbel.accuracy.extremes import Probe, all_cases, verdicts
from kurbel.errors import NoSolutionError, UsageError
from kurbel.machine import Machine
from kurbel.machine_file import loads
from kurbel.report.accuracy import answer

mp = mpmath.mp
CASES = all_cases()
PLAIN = "{speed: 60 rpm, crank: 400 mm, rod_ratio: 5}"


def test_there_are_many_cases() -> None:
    assert len(CASES) == 154
    assert all(case.asked and case.expected for case in CASES)


def quick(case: Probe) -> bool:
    """Whether no reference is computed that takes most of a second: of energy, or of many samples."""
    dear = ("flywheel dE", "forces T_max", "forces T_min", "forces friction_work")
    return (case.case, case.asked) in KEPT or not (case.asked.startswith(dear) or case.case == "polytropic card")


KEPT = {
    ("no flywheel", "flywheel dE"),
    ("vertical jumps", "forces T_max"),
    ("friction 0.06", "forces friction_work"),
}
"""One of each of the dear ones by default."""


DEAR = {(case.case, case.asked.partition("@")[0]): case for case in CASES if not quick(case)}.values()
"""At one angle each: `kurbel accuracy --extremes` asks at all."""


def fault(case: Probe) -> str:
    """What is wrong with the answer of a case; '' where nothing is."""
    (one,) = verdicts([case], answer, loads)
    wrong = f"{case.case}, {case.asked}: expected {one.expected}, observed {one.observed} ({one.ulp} ulp)"
    return "" if one.passed else wrong


@pytest.mark.parametrize("command", ["motion", "forces", "flywheel"])
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

    (verdict,) = verdicts([Probe("right", PLAIN, "motion x@30", "status 3: locks itself")], refuses, loads)
    assert verdict.passed


def closed_forms() -> dict[tuple[str, str], mpmath.mpf]:
    """The numbers of the table that are no references, from formulas."""
    pi, mpf = mp.pi, mpmath.mpf
    found = {
        ("infinite rod", "motion x@60"): mpf(0.4) / 2,
        ("1e3 mm is a number", "motion stroke"): mpf(2),
        ("effort in a block", "flywheel dE"): 100 * pi,
        # δ = ΔE/(J ω²), where δ² no longer shows
        ("J = 1e15 kg m²", "flywheel delta"): 100 * pi / (mpf(1e15) * (2 * pi) ** 2),
        ("load that falls as 1/ω, ∮ dφ/ω as at the nominal speed", "flywheel omega_mean"): 100 * pi / 60,
    }
    crank, lever, sin, cos = mpf(0.1), mpf(0.4), mp.sin(mp.radians(175)), mp.cos(mp.radians(175))
    for name, frame in (("100.0001", mpf(100.0001 / 1000)), ("300", mpf(0.3)), ("1e12", mpf(1e9))):
        case = f"slotted lever, frame {name} mm"
        across, along = crank * sin, frame + crank * cos
        found |= {
            (case, "motion x@175"): lever * across / mp.hypot(across, along),  # R_l sin θ
            (case, "motion c_work_max"): 2 * pi * crank * lever / (frame + crank),  # v R_l/(e ± r), R 304, 305
            (case, "motion c_return_max"): 2 * pi * crank * lever / (frame - crank),
        }
    return found


def test_numbers_of_the_table_are_those_of_their_formulas() -> None:
    with mp.workdps(40):
        formulas = closed_forms()
        numbers = {
            (one.case, one.asked): one.expected
            for one in CASES
            if one.ulp and one.expected != "reference" and "omega@" not in one.asked  # of benchmarks/speed_lines.py
        }
        assert {at for at, number in numbers.items() if number != "0"} == set(formulas)
        assert all(abs(mpmath.mpf(numbers[at]) / formulas[at] - 1) < 1e-25 for at in formulas)
