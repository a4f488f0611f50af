"""Records of many variants of a machine: what differs among them is an array over the variants, (v,)."""

from typing import Any, NamedTuple

import numpy as np

from kurbel.arrays import Indices


class Chambers(NamedTuple):
    """What stands in one end of a cylinder of many variants: the different chambers, and which one each has, (v,)."""

    each: tuple[Any, ...]
    which: Indices | None

    @property
    def cycles(self) -> tuple[str, ...]:
        """The working cycles that they can be part of, which are the same for all of a kind."""
        return self.each[0].cycles  # type: ignore[no-any-return]


def taken(record: Any, index: Indices) -> Any:
    """Return a record of many variants with the numbers of these ones, of the shape of the index."""
    if isinstance(record, np.ndarray):
        return record[index]
    if isinstance(record, tuple) and not hasattr(record, "_fields"):
        return tuple(taken(one, index) for one in record)
    varied = _varied(record)
    return record_of(record, {name: taken(getattr(record, name), index) for name in varied}) if varied else record


def count_of(record: Any) -> int | None:
    """Return how many variants a record is of; None for one machine, and where all variants have the same."""
    if isinstance(record, np.ndarray):
        return len(record)
    if isinstance(record, Chambers):
        return None if record.which is None else len(record.which)
    parts = record if isinstance(record, tuple) else (getattr(record, name) for name in _varied(record))
    return next((count for part in parts if (count := count_of(part)) is not None), None)


def record_of(like: Any, varied: dict[str, Any]) -> Any:
    """Return a record like another one but for these values; what was checked when theirs were born is not again."""
    made = object.__new__(type(like))
    made.__dict__.update(vars(like) | varied, _varied=tuple(varied))
    return made


def _varied(record: Any) -> tuple[str, ...]:
    """Return which values may differ among the variants of a record: records of machines alone tell of none."""
    varied: tuple[str, ...] = getattr(record, "__dict__", {}).get("_varied", ())
    return varied
