"""An extreme: the value and where it stands."""

from __future__ import annotations

from typing import NamedTuple


class Extreme(NamedTuple):
    """A value and the angle in degrees at which it stands."""

    value: float
    degrees: float
