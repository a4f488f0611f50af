"""What is asked of orders and speeds, checked against the machine."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from kurbel.errors import UsageError
from kurbel.machine import Machine
from kurbel.report.tables import Column

if TYPE_CHECKING:
    from kurbel.arrays import Array, ComplexArray

_HIGHEST = 1000
_COUNTS = ("order", "mode", "distance")


def orders_of(machine: Machine, asked: Sequence[float] | None) -> Array | None:
    """Return the orders (n,) that are asked for, ascending and each once; None for the usual ones.

    Raises UsageError for one that is none of the cycle.
    """
    if asked is None:
        return None
    for order in asked:
        if not 0 < order <= _HIGHEST:
            raise UsageError(f"--orders {order:g}: an order is more than 0 and at most {_HIGHEST} periods per turn")
        if (order * machine.revolutions) % 1:
            known = "½, 1, 1½, …" if machine.revolutions == 2 else "1, 2, 3, …"
            degrees = 360 * machine.revolutions
            raise UsageError(
                f"--orders {order:g}: the cycle repeats after {degrees} degrees and has the orders {known}"
            )
    return np.array(sorted(set(asked)), dtype=float)


def phase_degrees(amplitudes: ComplexArray) -> list[float | None]:
    """Return ε in degrees, above −180 up to 180, with Re(M e^{iνφ}) = |M| cos(νφ − ε); None of what is zero."""
    phases = np.degrees(np.arctan2(-amplitudes.imag, amplitudes.real)) + 0.0
    return [phase if amplitude else None for phase, amplitude in zip(phases.tolist(), amplitudes.tolist())]


def counted(columns: Iterable[Column]) -> tuple[Column, ...]:
    """Return columns with orders and numbers of modes written as such, 1.5, but 1 and 2; a distance in thousandths."""
    return tuple(one._replace(decimals=_decimals(one)) if one.id in _COUNTS else one for one in columns)


def _decimals(column: Column) -> int:
    if column.id == "distance":
        return 3
    return 1 if any(value and value % 1 for value in column.values) else 0
