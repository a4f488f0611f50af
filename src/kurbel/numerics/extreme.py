"""An extreme: the value and where it stands."""

from typing import Any, NamedTuple

from kurbel.numerics.arithmetic import where


class Extreme(NamedTuple):
    """A value and the angle in degrees at which it stands.

    Of many variants of a machine both are arrays (v,), which type checkers are not told: who asks for one has
    floats.
    """

    value: float
    degrees: float


def number_of(answer: Any) -> Any:
    """Return an answer without its angle: the value of an extreme, or the answer itself."""
    return answer.value if isinstance(answer, Extreme) else answer


def size_of(answer: Any) -> float:
    """Return the magnitude of an answer, of a list the largest, 0 of none."""
    number = number_of(answer)
    return max(map(abs, number), default=0.0) if isinstance(number, tuple) else abs(number or 0.0)


def largest(first: Extreme, *others: Extreme) -> Extreme:
    """Return the one with the largest value, the first of equal ones; one that is nan counts for nothing."""
    for other in others:
        first = chosen(other.value > first.value, other, first)
    return first


def smallest(first: Extreme, *others: Extreme) -> Extreme:
    """Return the one with the smallest value, the first of equal ones; one that is nan counts for nothing."""
    for other in others:
        first = chosen(other.value < first.value, other, first)
    return first


def chosen(condition: Any, extreme: Extreme, otherwise: Extreme) -> Extreme:
    """Return the one extreme where a condition holds, else the other."""
    return Extreme(*(where(condition, one, other) for one, other in zip(extreme, otherwise, strict=True)))
