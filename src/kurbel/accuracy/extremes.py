"""Stiff and extreme machines, each with what must come out of it: the table `extremes.tsv`, and how answers are judged.

A line of the table is a case: a name, the text of a machine file, command and key value, or command and
column@degrees, what is expected, and by how many units of the last place a value may miss it. Of `find` and `sweep` the
range or the values of a key come before ` | `, behind it what is wanted, or a key value and the number of its row.
Expected are `reference`, the value of the textbook in mpmath's numbers; a number, from a formula in tests/accuracy;
`left out`; or an exit status and words of the message. MANY_POINTS in a machine is the line of a card, MANY_SAMPLES a trace.
"""

import csv
import math
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from textwrap import shorten
from typing import NamedTuple

import numpy as np

from kurbel.accuracy.linkages import motion_of
from kurbel.accuracy.methods import Precise, largest_and_smallest, mp, mpf
from kurbel.accuracy.references import Textbook
from kurbel.accuracy.textbook import DIGITS, STEPS
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
    """What the program returned, and in how many ms, reading included; ulp, allowed: None where there is no value."""

    case: str
    asked: str
    expected: str
    observed: str
    verdict: str
    ulp: float | None
    allowed: float | None
    time: float

    @property
    def badness(self) -> tuple[bool, float]:
        """What is larger for a worse verdict: failed, and the share of what is allowed."""
        if self.ulp is None or not self.allowed:
            return not self.passed, -1.0
        return not self.passed, self.ulp / self.allowed

    @property
    def passed(self) -> bool:
        """Whether it is what was expected."""
        return self.verdict == "passed"


def table_lines(name: str) -> list[list[str]]:
    """Return the lines of a table of this package, without its head."""
    with open(Path(__file__).parent / name, encoding="utf-8", newline="") as file:
        return list(csv.reader(file, delimiter="\t", quoting=csv.QUOTE_NONE))[1:]


def all_cases() -> list[Probe]:
    """Return the cases of the table."""
    return [Probe(*line) for line in table_lines("extremes.tsv")]


def fine_line() -> str:
    """Return a line of a card with 100 001 points: p = 1 + 8 (1 − z)², z from 0 to 1."""
    count = 100_000
    points = (f"[{k / count!r}, {1 + 8 * (1 - k / count) ** 2!r}]" for k in range(count + 1))
    return f"[{', '.join(points)}]"


def fine_trace() -> str:
    """Return 100 001 samples of a trace over one turn: p = 5 + 4 sin φ."""
    step = 2 * math.pi / 100_000
    samples = (f"[{0.0036 * k!r}, {5 + 4 * math.sin(step * k)!r}]" for k in range(100_001))
    return f"[{', '.join(samples)}]"


def verdicts(
    cases: list[Probe],
    compute: Callable[[Machine, str], float | None],
    loads: Callable[[str], Machine],
) -> Iterator[Verdict]:
    """Yield the verdict on each case. Any exception except KurbelError is a fault of the program.

    compute: runs the program: (machine, requested quantity) -> its value, or None if it is left out.
    """
    textbooks: dict[str, Textbook] = {}
    for case in cases:
        text = case.machine.replace("\\n", "\n")
        if "MANY_POINTS" in text:
            text = text.replace("MANY_POINTS", fine_line())
        if "MANY_SAMPLES" in text:
            text = text.replace("MANY_SAMPLES", fine_trace())

        # the program on the text
        expected = case.expected
        missed = None
        begin = time.perf_counter()
        try:
            machine = loads(text)
            value = compute(machine, case.asked)
        except KurbelError as error:
            spent = time.perf_counter() - begin
            observed, passed = _refused(case, error)
        except Exception as error:
            spent = time.perf_counter() - begin
            observed = f"fault: {type(error).__name__}: {error}"
            passed = False
        else:
            # its answer against the reference
            spent = time.perf_counter() - begin
            observed = "left out" if value is None else repr(value)
            passed = observed == expected
            if case.ulp:
                textbook = textbooks.setdefault(text, Textbook(machine))
                expected, missed = _missed(case, textbook, value)
                passed = missed is not None and missed <= float(case.ulp)
        allowed = None if missed is None else float(case.ulp)
        verdict = "passed" if passed else "FAILED"
        names = (case.case, case.asked, expected, observed, verdict)
        yield Verdict(*names, missed, allowed, 1e3 * spent)


def _refused(case: Probe, error: KurbelError) -> tuple[str, bool]:
    """Return status and message of an error, and whether it was expected."""
    status = f"status {error.exit_status}: "
    message = " ".join(str(error).split())
    expected_words = case.expected.removeprefix(status)
    passed = case.expected.startswith(status) and expected_words in message
    return shorten(status + message, 100, placeholder=" …"), passed


def _missed(case: Probe, textbook: Textbook, answer: float | None) -> tuple[str, float | None]:
    """Return the expected value, and the error of an answer in units of the last place."""
    digits = 2 * DIGITS if case.asked.startswith("motion") else DIGITS
    with mp.workdps(digits):
        if case.expected == "reference":
            truth = exact(textbook, case.asked)
        else:
            truth = mpf(case.expected)
        expected = mp.nstr(truth, 20)
        if answer is None or math.isnan(answer):
            return expected, None
        return expected, float(abs(answer - truth) / math.ulp(float(truth)))


_OF_FORCES = {"work": "A_i", "friction_work": "A_f", "dE": "ΔE"}
"""Ids of key values -> their quantities."""


def exact(textbook: Textbook, asked: str) -> Precise:
    """Return a requested quantity by the textbook, in SI, with the precision set in mpmath."""
    machine = textbook.machine
    command, _, quantity = asked.partition(" ")
    name, _, angle = quantity.partition("@")
    if command != "motion":
        if name in _OF_FORCES:
            return textbook.reference(_OF_FORCES[name])
        largest, smallest = textbook.reference("T_max, T_min")
        return largest if name == "T_max" else smallest

    motion = motion_of(machine.cylinders[0].mechanism)
    omega = 2 * mp.pi * mpf(machine.speed or 0.0)
    if name == "stroke":
        return motion.stroke
    if name == "c_max":
        slopes = np.frompyfunc(lambda phi, _: motion.at(phi).slope, 2, 1)
        largest, _ = largest_and_smallest(slopes, motion.ends[:2], STEPS)
        return largest * omega
    order = "xcb".index(name)
    return motion.at(mpf(float(angle)))[order] * omega**order
