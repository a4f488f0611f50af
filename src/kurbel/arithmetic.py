"""The few operations beside + − × ÷ that the formulas need, for floats, arrays, jets and high-precision numbers."""

from __future__ import annotations

import math
from typing import Any


def sqrt(value: Any) -> Any:
    """Return the square root of a float, an array, or any number that brings its own `sqrt` (Decimal, mpf, Jet)."""
    if isinstance(value, (float, int)):
        return math.sqrt(value)
    if hasattr(value, "sqrt"):
        return value.sqrt()
    import numpy as np

    return np.sqrt(value)


def where(condition: Any, value: Any, otherwise: Any) -> Any:
    """Return `value` where the condition holds and `otherwise` elsewhere; shapes as for numpy.where."""
    if isinstance(condition, bool):
        return value if condition else otherwise
    for branch in (value, otherwise):
        if hasattr(branch, "where"):  # a Jet chooses value and slope together
            return branch.where(condition, value, otherwise)
    import numpy as np

    return np.where(condition, value, otherwise)


def bearing(sin: Any, cos: Any) -> Any:
    """Return the direction of (cos, sin) in degrees, from −180 to 180, for floats, arrays or numbers that bring it.

    >>> bearing(1.0, 0.0)
    90.0
    """
    if isinstance(sin, (float, int)):
        return math.degrees(math.atan2(sin, cos))
    if hasattr(sin, "bearing"):
        return sin.bearing(cos)
    import numpy as np

    return np.degrees(np.arctan2(sin, cos))
