"""What `kurbel balance` tells over the angle of crank 1."""

from __future__ import annotations

from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from kurbel.solver.balance.circles import Circles

if TYPE_CHECKING:
    from kurbel.arrays import Array, ComplexArray
    from kurbel.solver.balance.free import Free
    from kurbel.solver.balance.machine_balance import MachineBalance


class BalanceColumns:
    """The whole machine at crank angles (n,) in degrees; attributes by the ids of the columns, in SI, each (n,).

    A column that the machine does not have is None.
    """

    def __init__(self, balance: MachineBalance, phi: Array, within: Array | None = None) -> None:
        self._balance = balance
        self.phi = phi
        self._within = phi if within is None else within

    def _vector(self, free: Free | None, name: str) -> ComplexArray | None:
        circles: Circles | None = getattr(free, name, None)
        omega = self._balance.omega
        return None if circles is None or omega is None else circles.at(self.phi) * (omega * omega)

    @cached_property
    def _F(self) -> ComplexArray | None:
        return self._vector(self._balance.free, "force")

    @cached_property
    def _M(self) -> ComplexArray | None:
        return self._vector(self._balance.free, "moment")

    @cached_property
    def _F_book(self) -> ComplexArray | None:
        return self._vector(self._balance.book, "force")

    @cached_property
    def _M_book(self) -> ComplexArray | None:
        return self._vector(self._balance.book, "moment")

    @property
    def F_x(self) -> Array | None:
        """Free force in N along the stroke line of cylinder 1, outward from the shaft."""
        return None if self._F is None else self._F.real

    @property
    def F_y(self) -> Array | None:
        """Free force in N across it, 90° on in the sense of rotation."""
        return None if self._F is None else self._F.imag

    @property
    def F_free(self) -> Array | None:
        """Magnitude of the free force in N."""
        return None if self._F is None else np.abs(self._F)

    @property
    def M_free(self) -> Array | None:
        """Magnitude of the free moment in N m."""
        return None if self._M is None else np.abs(self._M)

    @property
    def M_x(self) -> Array | None:
        """Free moment in N m: of the forces F_x, times their places."""
        return None if self._M is None else self._M.real

    @property
    def M_y(self) -> Array | None:
        """Free moment in N m: of the forces F_y, times their places."""
        return None if self._M is None else self._M.imag

    @property
    def M_roll(self) -> Array | None:
        """Rolling moment on the frame in N m."""
        roll = self._balance.roll
        return None if roll is None else np.asarray(roll.torque(self.phi, self._within).value)

    @property
    def F_x_book(self) -> Array | None:
        """F_x in N by the book's acceleration of first order."""
        return None if self._F_book is None else self._F_book.real

    @property
    def F_y_book(self) -> Array | None:
        """F_y in N by the book's acceleration of first order."""
        return None if self._F_book is None else self._F_book.imag

    @property
    def M_x_book(self) -> Array | None:
        """M_x in N m by the book's acceleration of first order."""
        return None if self._M_book is None else self._M_book.real

    @property
    def M_y_book(self) -> Array | None:
        """M_y in N m by the book's acceleration of first order."""
        return None if self._M_book is None else self._M_book.imag
