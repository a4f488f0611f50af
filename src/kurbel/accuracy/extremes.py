"""Stiff and extreme machines, each with what must come out of it: the table `extremes.tsv`, and how answers are judged.

A line of the table is a case: a name, the text of a machine file, command and key value, or command and
column@degrees, what is expected, and by how many units of the last place a value may miss it. Expected are `reference`,
the value of the textbook in mpmath's numbers; a number, from a formula in tests/accuracy; `left out`; or an exit status
and words of the message.
"""

import csv
import math
from collections.abc import Callable, Iterator
from pathlib import Path
from textwrap import shorten
from typing import NamedTuple

import numpy as np

from kurbel.accuracy.methods import Number, largest_and_smallest, mp, mpf
from kurbel.accuracy.textbook import DIGITS, STEPS, TextbookMotion, reference
from kurbel.errors import KurbelError
from kurbel.machine import Machine


class Probe(NamedTuple):
    """One case: a line of the table."""

    case: str
    machine: str
    asked: str
    expected: str
    ulp: str = ""


class Verdict(NamedTuple):
    """What the program returned; ulp, allowed: None where no value was expected, or none was returned."""

    case: str
    asked: str
    expected: str
    observed: str
    verdict: str
    ulp: float | None
    allowed: float | None

    @property
    def passed(self) -> bool:
        """Whether it is what was expected."""
        return self.verdict == "passed"


def table(name: str) -> list[list[str]]:
    """Return the lines of a table of this package, without its head."""
    with open(Path(__file__).parent / name, encoding="utf-8", newline="") as file:
        return list(csv.reader(file, delimiter="\t", quoting=csv.QUOTE_NONE))[1:]


def all_cases() -> list[Probe]:
    """Return the cases of the table."""
    return [Probe(*line) for line in table("extremes.tsv")]


def verdicts(
    cases: list[Probe], compute: Callable[[Machine, str], float | None], loads: Callable[[str], Machine]
) -> Iterator[Verdict]:
    """Yield the verdict on each case. Any exception except KurbelError is a fault of the program.

    compute: runs the program: (machine, requested quantity) -> its value, or None if it is left out.
    """
    for case in cases:
        expected, missed = case.expected, None
        try:
            machine = loads(case.machine.replace("\\n", "\n"))
            answer = compute(machine, case.asked)
        except KurbelError as error:
            message, status = " ".join(str(error).split()), f"status {error.exit_status}: "
            passed = expected.startswith(status) and expected.removeprefix(status) in message
            observed = shorten(status + message, 100, placeholder=" …")
        except Exception as error:
            observed, passed = f"fault: {type(error).__name__}: {error}", False
        else:
            observed = "left out" if answer is None else repr(answer)
            passed = observed == expected
            if case.ulp:
                expected, missed = _missed(case, machine, answer)
                passed = missed is not None and missed <= float(case.ulp)
        allowed = None if missed is None else float(case.ulp)
        verdict = "passed" if passed else "FAILED"
        yield Verdict(case.case, case.asked, expected, observed, verdict, missed, allowed)


def _missed(case: Probe, machine: Machine, answer: float | None) -> tuple[str, float | None]:
    """Return the expected value, and the error of an answer in units of the last place."""
    with mp.workdps(2 * DIGITS if case.asked.startswith("motion") else DIGITS):
        truth = exact(machine, case.asked) if case.expected == "reference" else mpf(case.expected)
        missed = None if answer is None else abs(answer - truth) / math.ulp(float(truth))
        return mp.nstr(truth, 20), None if missed is None or mp.isnan(missed) else float(missed)


def exact(machine: Machine, asked: str) -> Number:
    """Return a requested quantity by the textbook, in SI, with the precision set in mpmath."""
    command, _, quantity = asked.partition(" ")
    name, _, at = quantity.partition("@")
    if command != "motion":
        found, _ = reference(machine, {"work": "A_i", "friction_work": "A_f", "dE": "ΔE"}.get(name, "T_max, T_min"))
        return found[("T_max", "T_min").index(name)] if isinstance(found, tuple) else found
    motion, omega = TextbookMotion(machine.cylinders[0].mechanism), 2 * mp.pi * mpf(machine.speed or 0.0)
    if name == "stroke":
        return motion.stroke
    if name == "c_max":
        slopes = np.frompyfunc(lambda phi, _: motion.at(phi).slope, 2, 1)
        return largest_and_smallest(slopes, motion.ends[:2], STEPS)[0] * omega
    order = "xcb".index(name)
    return motion.at(mpf(float(at)))[order] * omega**order
