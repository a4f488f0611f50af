"""How long a method takes: one warm-up, then the median and the least of some repeats."""

import statistics
import time
from collections.abc import Callable
from typing import Any, NamedTuple

_SLOW = 2.0


class Patience(NamedTuple):
    """How often a method is repeated at most, and after how many seconds no repeat is begun."""

    repeats: int = 20
    seconds: float = 0.5

    @classmethod
    def of(cls, quick: bool) -> "Patience":
        """Return that of a run, which is less for a quick one."""
        return cls(5, 0.1) if quick else cls()


class Timed(NamedTuple):
    """What a method answered, with the median and the least of its times in seconds."""

    answer: Any
    median: float
    least: float


def timed(method: Callable[[], Any], patience: Patience) -> Timed:
    """Return answer and times of a method; one that takes more than two seconds is run only once."""
    begin = time.perf_counter()
    answer = method()
    first = time.perf_counter() - begin
    if first > _SLOW:
        return Timed(answer, first, first)
    times: list[float] = []
    while len(times) < patience.repeats and (not times or sum(times) < patience.seconds):
        begin = time.perf_counter()
        method()
        times.append(time.perf_counter() - begin)
    return Timed(answer, statistics.median(times), min(times))
