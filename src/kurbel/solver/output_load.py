"""The load `force` of a cylinder on what slides or swings, over the crank angle.

    F = F_0 + F_V − k l x + f(z)        N, positive where x rises

x: displacement from the inner dead centre, of what swings the angle on the lever l; z: its fraction of the stroke. The
points of f are a card on an area of 1 m²: their corners are those of its lines. Constant parts and springs do no work
over the cycle of i revolutions, so that W = i l s ∮ f dz.
"""

from __future__ import annotations

from functools import cached_property

from kurbel.arrays import Indices, Number
from kurbel.machine.load import OutputForce
from kurbel.mechanisms import Mechanism
from kurbel.mechanisms.setting import Setting
from kurbel.numerics.arithmetic import spread
from kurbel.numerics.pieces import Angles
from kurbel.solver.gas import CardPressure


class OutputLoad:
    """The load on the output of a cylinder, of one machine or of `count`, whose numbers are then arrays (machines,).

    turns: of the crank per working cycle. lever: in m, 1 where the output slides.
    """

    def __init__(
        self, force: OutputForce, mechanism: Mechanism, turns: int, count: int | None
    ) -> None:
        self.force, self.turns = force, turns
        self.stroke: Number = mechanism.stroke
        self.lever: Number = 1.0 if force.lever is None else force.lever
        self.profile: CardPressure | None = None
        if force.profile is not None:
            # as a card on 1 m²: its pressures in Pa are forces in N, and there is no ambient to add
            setting = Setting(mechanism, 360.0, head_end=True, ambient=0.0, absolute=False)
            self.profile = CardPressure(force.profile, setting, count, None)

    def constant_and_spring(self, displacement: Number, index: Indices | None) -> Number:
        """Return constant part and spring in N at displacements of the output; index: the machine of each, if many."""
        force = spread(self.force.constant + self.force.preload, index)
        if self.force.spring is None:
            return force
        travel = displacement * spread(self.lever, index)
        return force - travel * spread(self.force.spring, index)

    @property
    def starts(self) -> list[Angles]:
        """The crank angles of a cycle at which the force bends or jumps, for each turn."""
        if self.profile is None:
            return []
        corners = self.profile.starts
        of_turns = []
        for turn in range(self.turns):
            of_turns.append(Angles(corners.machine, corners.degrees + 360.0 * turn))
        return of_turns

    @cached_property
    def work(self) -> Number:
        """Work W in J per cycle that the load does on the output, negative where the machine moves it."""
        if self.profile is None:
            return 0.0 * self.stroke  # of the shape of the numbers
        return self.profile.area * self.stroke * self.lever * self.turns
