"""What the balance of a locomotive does to its wheels, its drawbar and its course."""

import math
from collections.abc import Iterable
from functools import cached_property

from kurbel.machine.balance import Locomotive
from kurbel.numerics.extreme import Extreme
from kurbel.solver.balance.machine_balance import MachineBalance
from kurbel.solver.weights import Weight, levered


class LocomotiveBalance:
    """The key values of a locomotive, in SI, at the angular velocity of its machine; None what hangs on one not given.

    The counterweights balance all that turns; what they have more than that, so as to balance a share of what goes to
    and fro, loads and lifts the wheel in which it stands: its hammer blow.
    """

    def __init__(self, balance: MachineBalance, given: Locomotive) -> None:
        self._balance, self._given = balance, given
        self._square = balance.omega**2 if balance.omega else None

    @property
    def train_speed(self) -> float | None:
        """Speed of the train in m/s; None without the diameter of the wheels."""
        return self._rolling(self._balance.omega) if self._balance.omega else None

    def _rolling(self, omega: float) -> float | None:
        return self._given.wheel_diameter and self._given.wheel_diameter / 2 * omega

    @property
    def traction_variation(self) -> Extreme | None:
        """Largest free force in N along the stroke lines, by which the pull at the drawbar varies."""
        return self._balance.largest(self._balance.free.force.along)

    @property
    def swaying_couple(self) -> Extreme | None:
        """Largest moment in N m of the free forces along the stroke lines about the upright axis."""
        moment = self._balance.free.moment
        return None if moment is None else self._balance.largest(moment.along)

    def _in_wheels(self, weights: Iterable[tuple[str, Weight]]) -> tuple[complex, complex]:
        """Return the sums of weights in the two wheels, as by a lever, in kg m; each with what it is of."""
        parts = [levered(one, self._balance.wheels, owner) for owner, one in weights]
        return sum(part[0].product for part in parts), sum(part[1].product for part in parts)

    @cached_property
    def unbalanced(self) -> tuple[complex, complex]:
        """What turns in each wheel in kg m, counterweights and rotating masses together."""
        rotating = [(one.name, one.weight(one.rotating)) for one in self._balance.throws]
        return self._in_wheels((*rotating, *(("counterweights", one) for one in self._balance.counterweights)))

    @property
    def hammer_blow(self) -> float | None:
        """Largest force in N by which a wheel is loaded and lifted."""
        return None if self._square is None else self._most * self._square

    @property
    def _most(self) -> float:
        return max(map(abs, self.unbalanced))

    @property
    def hammer_speed(self) -> float | None:
        """Revolutions per second at which the hammer blow is the load of a wheel; None without that, or a blow."""
        if self._given.wheel_load is None or not self._most:
            return None
        return math.sqrt(self._given.wheel_load / self._most) / (2 * math.pi)

    @property
    def hammer_train_speed(self) -> float | None:
        """Speed of the train in m/s at which it is."""
        return None if self.hammer_speed is None else self._rolling(2 * math.pi * self.hammer_speed)

    @property
    def share_allowed(self) -> float | None:
        """Largest share of the reciprocating masses of which the counterweights keep the limit of the hammer blow."""
        if self._given.hammer_limit is None or self._square is None:
            return None
        whole = self._in_wheels((one.name, one.weight(one.mass)) for one in self._balance.throws)
        blow = max(map(abs, whole)) * self._square
        return min(1.0, self._given.hammer_limit / blow) if blow else 1.0
