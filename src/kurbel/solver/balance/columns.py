"""What `kurbel balance` tells over the angle of crank 1."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from kurbel.arrays import Array, ComplexArray
    from kurbel.solver.balance.circles import Circles
    from kurbel.solver.balance.machine_balance import MachineBalance


def _part(of: str, vector: str, part: Callable[[ComplexArray], Array]) -> property:
    """Return a column: a part of the free force or moment, the true one (`free`) or that of the book."""

    def column(columns: BalanceColumns) -> Array | None:
        found = columns.vector(of, vector)
        return None if found is None else part(found)

    return property(column)


class BalanceColumns:
    """The whole machine at crank angles (n,) in degrees; attributes by the ids of the columns, in SI, each (n,).

    A column that the machine does not have is None.
    """

    def __init__(self, balance: MachineBalance, phi: Array, within: Array | None = None) -> None:
        self._balance = balance
        self.phi = phi
        self._within = phi if within is None else within
        self._vectors: dict[tuple[str, str], ComplexArray] = {}

    def vector(self, of: str, name: str) -> ComplexArray | None:
        """Return the force in N or the moment in N m, `free` or by the `book`; None where there is none."""
        if (of, name) not in self._vectors:
            circles: Circles | None = getattr(getattr(self._balance, of), name, None)
            omega = self._balance.omega
            if circles is None or omega is None:
                return None
            self._vectors[of, name] = circles.at(self.phi) * (omega * omega)
        return self._vectors[of, name]

    F_x = _part("free", "force", np.real)
    F_y = _part("free", "force", np.imag)
    F_free = _part("free", "force", np.abs)
    M_x = _part("free", "moment", np.real)
    M_y = _part("free", "moment", np.imag)
    M_free = _part("free", "moment", np.abs)
    F_x_book = _part("book", "force", np.real)
    F_y_book = _part("book", "force", np.imag)
    M_x_book = _part("book", "moment", np.real)
    M_y_book = _part("book", "moment", np.imag)

    @property
    def M_roll(self) -> Array | None:
        """Rolling moment on the frame in N m."""
        roll = self._balance.roll
        return None if roll is None else np.asarray(roll.torque(self.phi, self._within).value)
