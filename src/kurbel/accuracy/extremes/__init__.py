"""Stiff and extreme machines, each with the answer it must get: a value from an independent reference, or a message.

A case is data: a name, the text of a machine file, what is asked, what is expected. Modules by subject hold them.
"""

from collections.abc import Callable
from decimal import Decimal
from typing import Any, NamedTuple, Union


class Refusal(NamedTuple):
    """The program must refuse with a message that holds this text, and end with this status."""

    text: str
    status: int = 2


class Absent(NamedTuple):
    """The answer must be left out."""


class Oracle(NamedTuple):
    """The value must be that of the Decimal reference, computed with so many digits."""

    digits: int = 40


Law = Callable[[], Decimal]
"""A value from a formula that is written beside the case, in Decimal."""
Expected = Union[Refusal, Absent, Oracle, Law, int]


class Probe(NamedTuple):
    """One case.

    text: the machine file, or a function that returns it where it is long; asked: command and key value, or command and
    column@degrees; ulp: units of the last place that the answer may miss the expected value by.
    """

    name: str
    text: str | Callable[[], str]
    asked: str
    expected: Expected
    ulp: float = 8.0


class Verdict(NamedTuple):
    """How the program answered; ulp: None where no value was expected, or none came."""

    case: Probe
    expected: str
    observed: str
    ulp: float | None
    passed: bool


Ask = Callable[[str, str], Any]
"""Runs the program: (text of the machine, what is asked) -> value, or None where it is left out. Raises KurbelError."""


def all_cases() -> list[Probe]:
    """Return the cases of all modules."""
    from kurbel.accuracy.extremes import force_cases, inputs, motion_cases, turning_cases

    modules = (motion_cases, force_cases, turning_cases, inputs)
    return [case for module in modules for case in module.CASES]
