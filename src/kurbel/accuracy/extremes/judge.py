"""Put the cases to the program, and hold its answers against what was expected."""

import math
from collections.abc import Iterable, Iterator
from decimal import Decimal
from typing import Any

from kurbel.accuracy import references
from kurbel.accuracy.decimals import pi, precise
from kurbel.accuracy.extremes import Absent, Ask, Oracle, Probe, Refusal, Verdict
from kurbel.accuracy.oracle import CylinderOracle
from kurbel.accuracy.periodic import SAMPLE_STEP, SpeedOracle
from kurbel.accuracy.scenes import Loads
from kurbel.errors import KurbelError
from kurbel.machine import Machine


def verdicts(cases: Iterable[Probe], ask: Ask, loads: Loads) -> Iterator[Verdict]:
    """Yield the verdict on every case; ask: runs the program."""
    for case in cases:
        yield judged(case, ask, loads)


def judged(case: Probe, ask: Ask, loads: Loads) -> Verdict:
    """Return the verdict on one case. What is no KurbelError is a fault of the program."""
    text = case.text if isinstance(case.text, str) else case.text()
    wanted = _wanted(case, text, loads)
    try:
        answer = ask(text, case.asked)
    except KurbelError as error:
        return _refused(case, wanted, error)
    except Exception as error:
        return Verdict(case, _said(wanted), f"fault: {type(error).__name__}: {error}", None, False)
    if not isinstance(wanted, Decimal):
        absent = answer is None and isinstance(wanted, Absent)
        return Verdict(case, _said(wanted), "left out" if answer is None else repr(answer), None, absent)
    if answer is None:
        return Verdict(case, _said(wanted), "left out", None, False)
    missed = _ulp(answer, wanted)
    return Verdict(case, _said(wanted), repr(answer), missed, missed <= case.ulp)


def _wanted(case: Probe, text: str, loads: Loads) -> Decimal | Refusal | Absent:
    expected = case.expected
    if isinstance(expected, (Refusal, Absent)):
        return expected
    if isinstance(expected, int):
        return Decimal(expected)
    with precise(expected.digits if isinstance(expected, Oracle) else 60):
        return oracle_answer(loads(text), case.asked) if isinstance(expected, Oracle) else expected()


def _said(wanted: Decimal | Refusal | Absent) -> str:
    if isinstance(wanted, Refusal):
        return f"status {wanted.status}: {wanted.text or 'any message'}"
    return "left out" if isinstance(wanted, Absent) else f"{wanted:.20g}"


_LONGEST = 72


def _refused(case: Probe, wanted: Any, error: KurbelError) -> Verdict:
    """Show as much of the message as holds what was expected of it."""
    message = " ".join(str(error).split())
    expected = isinstance(wanted, Refusal) and wanted.text in message and wanted.status == error.exit_status
    start = max(message.find(wanted.text), 0) if isinstance(wanted, Refusal) else 0
    end = max(start + len(wanted.text) if isinstance(wanted, Refusal) else 0, _LONGEST)
    shown = message if end >= len(message) else message[max(0, end - _LONGEST) : end] + " …"
    return Verdict(case, _said(wanted), f"status {error.exit_status}: {shown}", None, expected)


def _ulp(answer: float, truth: Decimal) -> float:
    if not math.isfinite(answer):
        return math.inf
    with precise(60):
        missed = abs(Decimal(answer) - truth)
        return float(missed / Decimal(math.ulp(float(truth)))) if missed else 0.0


def oracle_answer(machine: Machine, asked: str) -> Decimal:
    """Return what the Decimal reference says to the question, in the current decimal context."""
    quantity = asked.split()[1]
    name, _, at = quantity.partition("@")
    if name in _OF_MACHINE:
        return references.excess_energy(machine)
    if name == "omega":
        return SpeedOracle(machine).omega()[int(at) // SAMPLE_STEP]
    cylinder = CylinderOracle(machine, machine.cylinders[0])
    return _of_motion(machine, cylinder, name, at) if name in _MOTION else _of_forces(cylinder, name)


_OF_MACHINE = ("dE",)
_MOTION = {"x": 0, "c": 1, "b": 2, "c_max": 1, "stroke": 0}


def _of_motion(machine: Machine, cylinder: CylinderOracle, name: str, at: str) -> Decimal:
    omega = 2 * pi() * Decimal(machine.speed or 0.0)
    factor = omega ** _MOTION[name] if _MOTION[name] else Decimal(1)
    if name == "stroke":
        return cylinder.motion.stroke
    if name == "c_max":
        return references.largest_slope(cylinder.motion) * factor
    asked = ("coordinate", "slope", "curvature")[_MOTION[name]]
    return references.motion_at(cylinder.motion, [float(at)], asked)[0] * factor


def _of_forces(cylinder: CylinderOracle, name: str) -> Decimal:
    if name == "work":
        return references.work(cylinder)
    if name == "friction_work":
        return references.friction_work(cylinder)
    return references.tangential_extremes(cylinder)[("T_max", "T_min").index(name)]
