"""What some work needs of memory."""

from __future__ import annotations

import gc
import tracemalloc
from collections.abc import Callable


def peak(work: Callable[[], object]) -> tuple[object, int]:
    """Return what some work answers, and the bytes that it needed at most, the answer included."""
    gc.collect()
    gc.freeze()  # what other tests have left must not put off the collection of what this one leaves
    tracemalloc.start()
    try:
        return work(), tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()
        gc.unfreeze()
