"""What a sweep shows of limits, and which rows it keeps, by every name that a column has."""

import numpy as np
import pytest

import kurbel
from kurbel.designs.chosen import unbettered
from swept_rows import CONFIGS, WATERWORKS, rows

RATIOS = ("--vary", "rod_ratio=0.5,3,4,5,6")


def numbers(*args: str) -> list[object]:
    return [row["row"] for row in rows(*args)]


def test_a_limit_that_cannot_be_judged_is_not_kept() -> None:
    """Without a flywheel there is no δ, as `check` says; all rows were said to keep the bound on it."""
    delta = ("--set", "limits.delta=1/50")
    (result,) = rows("--vary", "rod_ratio=5", "--columns", "N_max", *delta)
    assert (result["keeps"], result["broken"]) == (None, None)
    assert result["failure"] == "limits.delta: this machine has no delta"
    assert result["N_max_N"] == pytest.approx(
        kurbel.solve(kurbel.load(WATERWORKS)).cylinders[0]["N_max"].value
    )
    (broken,) = rows(
        "--vary", "rod_ratio=5", "--columns", "N_max", *delta, "--set", "limits.N_max=16 kN"
    )
    assert (broken["keeps"], broken["broken"], broken["failure"]) == (
        False,
        "N_max",
        result["failure"],
    )
    judged = rows("--vary", "flywheel.inertia=1e4,5e4 kg m2", "--columns", "N_max", *delta)
    assert [(one["keeps"], one["failure"]) for one in judged] == [(False, None), (True, None)]


def test_rows_are_chosen_by_their_texts() -> None:
    words = (*RATIOS, "--columns", "N_max", "--set", "limits.N_max=20 kN")
    assert numbers(*words, "--where", "keeps = yes") == [4, 5]
    assert (
        numbers(*words, "--where", "keeps == no")
        == numbers(*words, "--where", "broken = N_max")
        == [2, 3]
    )
    assert numbers(*words, "--where", "failure =") == [2, 3, 4, 5]
    assert numbers(*words, "--where", "failure ≠") == [1]


def test_an_infinite_rod_is_the_longest() -> None:
    """It stands in the table as a word, and counted as having no length: no front of Pareto had it."""
    words = ("--vary", "rod_ratio=4,infinite,0.5,3", "--columns", "T_max")
    assert numbers(*words, "--sort", "-rod_ratio") == [2, 1, 4, 3]
    assert numbers(*words, "--sort", "rod_ratio") == [3, 4, 1, 2]
    assert numbers(*words, "--pareto", "rod_ratio,T_max") == [1, 2, 4]
    assert numbers(*words, "--pareto", "-rod_ratio,T_max") == [2]
    assert numbers(*words, "--where", "rod_ratio > 3.5") == [1, 2]
    assert numbers(*words, "--where", "rod_ratio = infinite") == [2]


def test_rows_are_chosen_by_printed_symbols() -> None:
    words = (*RATIOS, "--columns", "dE,P_start_max")
    assert (
        numbers(*words, "--sort", "-ΔE", "--top", "1") == numbers(*words, "--pareto", "-ΔE") == [2]
    )
    assert numbers(*words, "--where", "P_0,max ≥ 1 N", "--where", "rod_ratio ≤ 4") == [2, 3]
    of_machine = rows(
        *RATIOS, "--columns", "machine.T_max", "--sort", "-machine.T_max", "--top", "1"
    )
    assert [(one["row"], "machine.T_max_N" in one) for one in of_machine] == [(2, True)]
    assert numbers(*RATIOS, "--columns", "machine.dE", "--sort", "-machine.ΔE", "--top", "1") == [2]
    compressor = str(CONFIGS["compressor-two-stage"])
    by_symbol = ("--vary", "speed=300,500 rpm", "--columns", "p_i", "--sort", "low pressure.p_i")
    assert [row["row"] for row in rows(*by_symbol, file=compressor)]


def test_every_extreme_has_its_angle() -> None:
    """Not of `forces` alone: ω_max of the speed line, loads and stresses stand somewhere, too."""
    file = str(CONFIGS["gas-engine"])
    (result,) = rows(
        "--vary", "speed=200 rpm", "--columns", "P_dc,sigma_pin_max,E_max,dE", "--angles", file=file
    )
    case = kurbel.solve(kurbel.load(file, ["speed=200 rpm"]))
    assert result["E_max_at_deg"] == case["E_max"].degrees
    assert result["sigma_pin_max_at_deg"] == case["sigma_pin_max"].degrees
    assert {"P_dc_at_deg", "dE_at_deg"} & set(result) == {"P_dc_at_deg"}


def test_python_gets_the_reason_why_the_only_design_fails() -> None:
    """As an optimiser may ask for one design at a time, and for one key value of it."""
    result = kurbel.sweep(kurbel.load(WATERWORKS), {"rod_ratio": [0.5]}, "N_max")
    assert np.isnan(result["N_max"]).tolist() == [True]
    assert result["failure"].tolist() == ["rod_ratio: 0.5 is too small; it must be more than 1"]


@pytest.mark.parametrize("aims", [1, 2, 3, 4])
def test_the_front_by_comparing_every_pair(aims: int) -> None:
    """Also where rows are equal in one cost or in all, and of more rows than are compared together."""
    random = np.random.default_rng(aims)
    drawn = [random.integers(0, 4, (count, aims)).astype(float) for count in (0, 1, 2, 30, 90)]
    drawn += [random.normal(size=(count, aims)) for count in (3, 40, 700)]
    on_a_sphere = np.abs(random.normal(size=(1300, aims)))
    drawn.append(-on_a_sphere / np.linalg.norm(on_a_sphere, axis=1)[:, None])
    for costs in drawn:
        not_more = (costs[:, None] <= costs).all(axis=-1)
        less = (costs[:, None] < costs).any(axis=-1)
        assert (unbettered(costs) == ~(not_more & less).any(axis=0)).all()


@pytest.mark.parametrize("aims", [2, 3, 5])
def test_a_sphere_is_a_front_and_what_is_inside_it_is_not(aims: int) -> None:
    """Of 3000 points of a sphere none betters another one; the same points nearer to its centre are all bettered."""
    drawn = np.abs(np.random.default_rng(0).normal(size=(3000, aims)))
    on_the_sphere = drawn / np.linalg.norm(drawn, axis=1)[:, None]
    both = np.concatenate((on_the_sphere, 0.99 * on_the_sphere))
    assert unbettered(-both).tolist() == [True] * 3000 + [False] * 3000
