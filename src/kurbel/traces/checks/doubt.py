"""A doubt about a trace, and what several checks say."""

from typing import NamedTuple

from kurbel.traces.reading import TraceReading

LEAST_SWING = 1e3
"""Range in Pa below which a trace is flat."""


class Doubt(NamedTuple):
    """A sentence, and the trace with what it asks for; None where that cannot be computed."""

    text: str
    cured: TraceReading | None = None


def sense_key(reading: TraceReading) -> str:
    """Return the key that lets the angle count in the other sense."""
    trace = reading.trace
    against = trace.placed.against if trace.placed else trace.against
    return f"angle_sense: {'with' if against else 'against'}"
