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

import numpy as np

from kurbel.accuracy.methods import DIGITS, PRECISE, Number, mp, precise_integrals, roots
from kurbel.accuracy.textbook import TextbookMotion
from kurbel.accuracy.trials import STEP, by_pieces, speed_line
from kurbel.errors import KurbelError
from kurbel.machine import Machine


class Probe(NamedTuple):
    """One case, as a line of the table has it."""

    case: str
    machine: str
    asked: str
    expected: str
    ulp: str = ""


class Verdict(NamedTuple):
    """How the program answered; ulp: None where no value was expected, or none came."""

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
    cases: list[Probe], ask: Callable[[str, str], float | None], loads: Callable[[str], Machine]
) -> Iterator[Verdict]:
    """Yield the verdict on each case. What is no KurbelError is a fault of the program.

    ask: runs the program: text of the machine, what is asked -> a value, or None where it is left out.
    """
    for case in cases:
        text = text_of(case)
        try:
            answer = ask(text, case.asked)
        except KurbelError as error:
            yield _of_refusal(case, error)
        except Exception as error:
            yield Verdict(case, case.expected, f"fault: {type(error).__name__}: {error}", None, False)
        else:
            yield _of_answer(case, text, answer, loads)


def _of_refusal(case: Probe, error: KurbelError) -> Verdict:
    """Judge a message, of which as much is shown as holds what was expected of it."""
    message, status = " ".join(str(error).split()), f"status {error.exit_status}: "
    words = case.expected.removeprefix(status)
    passed = case.expected.startswith(status) and words in message
    end = max(message.find(words) + len(words), 72)
    shown = message if end >= len(message) else message[end - 72 : end] + " …"
    return Verdict(case, case.expected if words else status + "any message", status + shown, None, passed)


def _of_answer(case: Probe, text: str, answer: float | None, loads: Callable[[str], Machine]) -> Verdict:
    observed = "left out" if answer is None else repr(answer)
    if not case.ulp:
        return Verdict(case, case.expected, observed, None, observed == case.expected)
    motion = case.asked.startswith("motion")
    with mp.workdps(2 * DIGITS if motion else DIGITS):
        truth = reference(loads(text), case.asked) if case.expected == "reference" else mp.mpf(case.expected)
        expected = mp.nstr(truth, 20) if truth else "0"
        if answer is None:
            return Verdict(case, expected, observed, None, False)
        missed = float(abs(answer - truth) / math.ulp(float(truth))) if math.isfinite(answer) else math.inf
    return Verdict(case, expected, observed, missed, missed <= float(case.ulp))


def reference(machine: Machine, asked: str) -> Number:
    """Return what the textbook makes of a question, in SI, to the digits that mpmath has now."""
    command, _, quantity = asked.partition(" ")
    name, _, at = quantity.partition("@")
    if name == "omega":
        return speed_line(machine, PRECISE)[int(at) // STEP - 1]
    if command != "motion":
        symbol = {"work": "A_i", "friction_work": "A_f", "dE": "ΔE"}.get(name, "T_max, T_min")
        found = by_pieces(symbol, precise_integrals, 0, machine, PRECISE)
        return found[("T_max", "T_min").index(name)] if name[0] == "T" else found
    book, omega = TextbookMotion(machine.cylinders[0].mechanism, PRECISE), 2 * mp.pi * mp.mpf(machine.speed or 0.0)
    if name == "stroke":
        return book.stroke
    if name == "c_max":
        (peak,), _ = roots(lambda phi, _: book.at(phi).curvature, np.array(book.dead_centres), PRECISE)
        return book.at(peak).slope * omega
    order = "xcb".index(name)
    return book.at(mp.mpf(float(at)) * mp.pi / 180)[order] * omega**order
