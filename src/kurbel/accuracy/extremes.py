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
from random import Random
from typing import NamedTuple

from kurbel.accuracy import textbook
from kurbel.accuracy.textbook import DIGITS, Number, TextbookMotion, mp
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
    """What the program returned; ulp: None where no value was expected, or none was returned."""

    case: Probe
    expected: str
    observed: str
    ulp: float | None
    passed: bool


def all_cases() -> list[Probe]:
    """Return the cases of the table."""
    with open(Path(__file__).parent / "extremes.tsv", encoding="utf-8", newline="") as file:
        lines = csv.reader(file, delimiter="\t", quoting=csv.QUOTE_NONE)
        return [Probe(*line) for line in lines][1:]


def text_of(case: Probe) -> str:
    """Return the text of the machine file of a case."""
    return noisy_trace() if case.machine == "noisy trace" else case.machine.replace("\\n", "\n")


def noisy_trace() -> str:
    """Return a machine with 1e5 samples 10 bar + 5 bar sin φ, and noise that is the same on both strokes.

    What is even in φ does no work; with an infinite rod ∮ sin φ dx = π R.
    """
    random, count = Random(1932), 100_000
    noise = [random.gauss(0.0, 5e3) for _ in range(count // 2 + 1)]
    points = [
        f"[{360 * k / count!r}, {1e6 + 5e5 * math.sin(2 * math.pi * k / count) + noise[min(k, count - k)]!r}]"
        for k in range(count)
    ]
    trace = f"{{trace: {{unit: Pa, points: [{', '.join(points)}]}}}}"
    return f"{{speed: 60 rpm, crank: 400 mm, rod: infinite, bore: 450 mm, indicator: {{head_end: {trace}}}}}"


def verdicts(
    cases: list[Probe], compute: Callable[[str, str], float | None], loads: Callable[[str], Machine]
) -> Iterator[Verdict]:
    """Yield the verdict on each case. Any exception except KurbelError is a fault of the program.

    compute: runs the program: (text of the machine, requested quantity) -> its value, or None if it is left out.
    """
    for case in cases:
        text, expected, missed, answer = text_of(case), case.expected, None, None
        try:
            answer = compute(text, case.asked)
        except KurbelError as error:
            message, status = " ".join(str(error).split()), f"status {error.exit_status}: "
            words = expected.removeprefix(status)
            passed = expected.startswith(status) and words in message
            end = max(message.find(words) + len(words), 72)  # the part with the expected words is shown
            observed = status + (message if end >= len(message) else message[end - 72 : end] + " …")
            expected = expected if words else status + "any message"
        except Exception as error:
            observed, passed = f"fault: {type(error).__name__}: {error}", False
        else:
            observed = "left out" if answer is None else repr(answer)
            passed = observed == expected
            if case.ulp:
                expected, missed = _missed(case, text, answer, loads)
                passed = missed is not None and missed <= float(case.ulp)
        yield Verdict(case, expected, observed, missed, passed)


def _missed(case: Probe, text: str, answer: float | None, loads: Callable[[str], Machine]) -> tuple[str, float | None]:
    """Return the expected value, and the error of an answer in units of the last place."""
    with mp.workdps(2 * DIGITS if case.asked.startswith("motion") else DIGITS):
        truth = reference(loads(text), case.asked) if case.expected == "reference" else mp.mpf(case.expected)
        expected = mp.nstr(truth, 20) if truth else "0"
        if answer is None:
            return expected, None
        missed = abs(answer - truth) / math.ulp(float(truth)) if math.isfinite(answer) else math.inf
        return expected, float(missed)


def reference(machine: Machine, asked: str) -> Number:
    """Return a requested quantity by the textbook, in SI, with the precision set in mpmath."""
    command, _, quantity = asked.partition(" ")
    name, _, at = quantity.partition("@")
    if command != "motion":
        symbol = {"work": "A_i", "friction_work": "A_f", "dE": "ΔE"}.get(name, "T_max, T_min")
        found, _ = textbook.reference(machine, symbol)
        return found[("T_max", "T_min").index(name)] if name[0] == "T" else found
    mechanism, omega = machine.cylinders[0].mechanism, 2 * mp.pi * mp.mpf(machine.speed or 0.0)
    if name == "stroke":
        return TextbookMotion(mechanism).stroke
    if name == "c_max":
        return textbook.peak_slope(mechanism) * omega
    order = "xcb".index(name)
    return TextbookMotion(mechanism).at(mp.radians(mp.mpf(float(at))))[order] * omega**order
