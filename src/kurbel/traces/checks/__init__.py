"""What is implausible in a measured trace: one table of checks, for the kinds of machine that each can judge.

A check returns None where nothing is wrong, or a doubt: what is seen, what to write, and p_i with and without that
correction, computed from the samples themselves. The trace is then judged again with the correction, since what comes
later may look wrong only because of what comes before: every doubt is shown, the one that misleads the others first.
"""

from collections.abc import Callable
from typing import NamedTuple

from kurbel.arrays import Array
from kurbel.mechanisms.setting import Setting
from kurbel.traces.checks.dead_centre import (
    backward,
    flanks_elsewhere,
    high_at_largest,
    motored_peak,
    other_sense,
    peak_elsewhere,
)
from kurbel.traces.checks.doubt import Doubt
from kurbel.traces.checks.lines import lines_of_no_gas
from kurbel.traces.checks.pressures import inverted, level, unit_of_another_size
from kurbel.traces.checks.samples import (
    drift,
    recorded_speed,
    rounded_angles,
    turns_in_pairs,
    wandering_cycles,
)
from kurbel.traces.correct import Trace
from kurbel.traces.reading import (
    COMPRESSOR,
    ENGINES,
    EVERY,
    MOTORED,
    PUMP,
    STEAM,
    UNKNOWN,
    TraceReading,
)

_MOST_DOUBTS = 4


def doubts(trace: Trace, setting: Setting, each: Array, role: str | None = None) -> list[str]:
    """Return what is implausible in a trace with the pressures `each` (m, n) of its cycles, the strongest first."""
    reading = TraceReading(trace, setting, each, role)
    texts: list[str] = []
    while len(texts) < _MOST_DOUBTS:
        doubt = _first_doubt(reading)
        if doubt is None or doubt.text in texts:
            break
        texts.append(doubt.text)
        if doubt.cured is None:
            break
        reading = doubt.cured
    return texts


def _first_doubt(reading: TraceReading) -> Doubt | None:
    """Return the first doubt of the table on a trace."""
    for check in CHECKS:
        if reading.kind not in check.kinds:
            continue
        doubt = check.judge(reading)
        if doubt is not None:
            return doubt
    return None


class Check(NamedTuple):
    """A row of the table: the kinds of machine that it can judge, and the function that does so."""

    kinds: frozenset[str]
    judge: Callable[[TraceReading], Doubt | None]


_MOTORED_ONLY = frozenset((MOTORED,))
_WITH_LINES = ENGINES | {COMPRESSOR}
_WITH_SENSE = frozenset((COMPRESSOR, STEAM))
_WITH_FLANKS = frozenset((COMPRESSOR, STEAM, PUMP))
_WITHOUT_SHAPE = frozenset((UNKNOWN, PUMP, STEAM, COMPRESSOR))

CHECKS: tuple[Check, ...] = (
    Check(EVERY, recorded_speed),
    Check(EVERY, turns_in_pairs),
    Check(EVERY, wandering_cycles),
    Check(EVERY, rounded_angles),
    Check(EVERY, drift),
    Check(EVERY, inverted),
    Check(ENGINES, unit_of_another_size),
    Check(_WITH_SENSE, other_sense),
    Check(_WITH_FLANKS, flanks_elsewhere),
    Check(_WITHOUT_SHAPE, high_at_largest),
    Check(ENGINES, backward),
    Check(ENGINES, peak_elsewhere),
    Check(_MOTORED_ONLY, motored_peak),
    Check(EVERY, level),
    Check(_WITH_LINES, lines_of_no_gas),
)
"""What is judged, in this order: a fault before those that it misleads."""
