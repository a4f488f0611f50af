"""Answers are those frozen by `tests/freeze.py`: a part of them; its `compare` holds all."""

from __future__ import annotations

import copy
from collections.abc import Callable
from functools import cache
from typing import Any

import pytest

from freeze import KEPT, Record, compare, read, report
from frozen_runs import Answer, among_traces, answer_of, hash_of

PARTS = 60

kept = cache(lambda: read(KEPT))


@pytest.mark.parametrize("part", [5, 29])
def test_answers_are_those_frozen(part: int) -> None:
    runs = [(machine, line) for machine, one in kept().items() for line in one["answers"]][part::PARTS]
    old: Record = {}
    new: Record = {}
    with among_traces():
        for machine, line in runs:
            frozen = kept()[machine]
            old.setdefault(machine, {"hash": frozen["hash"], "answers": {}})["answers"][line] = frozen["answers"][line]
            anew = new.setdefault(machine, {"hash": hash_of(machine), "answers": {}})
            anew["answers"][line] = answer_of(machine, line)
        found = compare(old, new)
    assert not found, report(found)


LINE = "forces - -f json --angles 0,33,90,147,180,215.5,280,341"
COLUMN: dict[str, Callable[[Answer], Any]] = {
    "T": lambda answer: next(one for one in answer["cylinders"][0]["columns"] if one["id"] == "T"),
    "T_min": lambda answer: next(one for one in answer["cylinders"][0]["key_values"] if one["id"] == "T_min"),
}


def changed(change: Callable[[Answer], object], tight: bool = False) -> list[str]:
    """Return the ids that a comparison names when one answer of the waterworks engine has been changed."""
    frozen = kept()["shipped/waterworks"]
    old = {"shipped/waterworks": frozen | {"answers": {LINE: frozen["answers"][LINE]}}}
    new = copy.deepcopy(old)
    change(new["shipped/waterworks"]["answers"][LINE])
    return [one.id for one in compare(old, new, tight)]


def shift(id: str, key: str, by: float) -> Callable[[Answer], None]:
    def change(answer: Answer) -> None:
        place = COLUMN[id](answer)
        if key == "values":
            place[key][1] += by
        else:
            place[key] += by

    return change


# T runs up to 87.7 kN and its least is -28 kN: both count by the largest
@pytest.mark.parametrize(
    ("change", "told", "told_tight"),
    [
        (shift("T", "values", 5e-7), [], ["T"]),
        (shift("T", "values", 1.2e-6), ["T"], ["T"]),
        (shift("T_min", "value", 5e-7), [], ["T_min"]),
        (shift("T_min", "value", -1.2e-6), ["T_min"], ["T_min"]),
        (shift("T_min", "at_deg", 2e-8), [], []),  # so flat is T there
        (shift("T_min", "at_deg", 1.0), ["T_min at"], ["T_min at"]),
        (lambda answer: answer.update(exit=3), ["exit"], ["exit"]),
        (lambda answer: answer["cylinders"][0]["warnings"].append("a doubt"), ["warnings"], ["warnings"]),
        (lambda answer: COLUMN["T"](answer)["values"].pop(), ["T", "T"], ["T", "T"]),
        (lambda answer: COLUMN["T_min"](answer).update(unit="kN"), ["T_min"], ["T_min"]),
        (lambda answer: answer["cylinders"][0]["key_values"].clear(), None, None),
        (lambda answer: None, [], []),
    ],
)
def test_what_a_comparison_names(
    change: Callable[[Answer], object], told: list[str] | None, told_tight: list[str] | None
) -> None:
    for tight, expected in ((False, told), (True, told_tight)):
        found = changed(change, tight)
        assert len(found) > 20 if expected is None else found == expected
