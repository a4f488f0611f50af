"""Steady forced vibration of a shaft line with all its orders: the motion over the angle, every jump of it included.

What is damped by the speed has an equation over the angle, `kurbel.solver.shaft_line.periodic`. A loss factor has none:
it is known of single orders only.
"""

from functools import cached_property

import numpy as np

from kurbel.arrays import Array
from kurbel.machine.shaft_line import ShaftLine
from kurbel.numerics.collocation_old import Unsettled
from kurbel.numerics.elements import STAGES
from kurbel.numerics.grid import Cuts, Grid
from kurbel.numerics.search import Sampled, extremes
from kurbel.solver.shaft_line.chain import Chain
from kurbel.solver.shaft_line.periodic import ChainEquation, Rise
from kurbel.solver.turning.excess import Excess
from kurbel.solver.turning.machine_effort import MachineEffort
from kurbel.solver.turning.speed_lines import speed_law
from kurbel.solver.turning.torques import Sum, Torque

_MOST_WORK = 5e7
"""Multiplications that one solution of all elements may take; with what refines them that is about a second."""
_FEWEST = 40
"""Elements that a cycle is refined to at least."""


def acting(turned: MachineEffort, line: ShaftLine) -> dict[int, Sum]:
    """Return the torques on the masses of a shaft line over the angle, by mass; see `forced.excitation`."""
    found: dict[int, list[tuple[float, Torque]]] = {}
    places = {name: index for index, mass in enumerate(line.masses) for name in mass.cylinders}
    if turned.machine.effort:
        found[0] = [(1.0, turned.effort)]
    else:
        for one in turned.of_cylinders:
            of_mass = found.setdefault(places[one.forces.drive.name], [])
            of_mass += [(one.share, one.effort), *one.lost]
            of_mass += [(1 - one.share, one.inertia)] if one.inertia else []
    if turned.machine.load and turned.machine.load.diagram:
        found.setdefault(line.load % len(line.masses), []).append((-1.0, turned.excess.load))
    return {mass: Sum(*parts) for mass, parts in found.items()}


class SteadyMotion:
    """The torques in the pieces of a shaft line at the working speed; means (pieces,): their means in N m.

    Raises Unsettled where no motion is found, or none that is worth its time.
    """

    def __init__(self, chain: Chain, line: ShaftLine, turned: MachineEffort, means: Array) -> None:
        self.chain, self.means, self.cycle = chain, means, turned.cycle
        self._ratios = np.array([piece.ratio for piece in line.pieces])
        self._acting = {mass: Excess(torque) for mass, torque in acting(turned, line).items()}
        omega = turned.omega or 0.0
        law = speed_law(turned)
        rise = Rise(line.load % len(line.masses), law) if law else None
        self._equation = ChainEquation(chain, omega, self._driving, rise)
        breaks = Cuts.joined([one.effort.cuts for one in self._acting.values()]).grid().breaks
        elements = max(self._equation.parts(breaks).sum(), _FEWEST)
        if elements * (STAGES * len(self._equation.matrix)) ** 3 > _MOST_WORK:
            raise Unsettled
        self.motion = self._equation.solved(breaks)

    def _driving(self, degrees: Array, within: Array) -> Array:
        """Return the torques on the masses less their means in N m, (n, …)."""
        torques = np.zeros((len(self.chain.inertias), *degrees.shape))
        for mass, one in self._acting.items():
            torques[mass] = one.effort.torque(degrees, within).value - one.mean
        return torques

    def _sampled(self, degrees: Array, within: Array) -> dict[str, Sampled]:
        """Return the torques in the pieces less their means, with their slopes by φ."""
        state = self.motion.at(degrees, within)
        rate = self._equation.rate(self._equation.prepared(degrees, within), state)[0]
        passing = self._equation.passing / self._ratios[:, None]
        return {str(piece): Sampled(state @ of, rate @ of) for piece, of in enumerate(passing)}

    @cached_property
    def crests(self) -> tuple[Array, Array]:
        """Largest and smallest torque in the pieces beside their mean in N m, (pieces, 1) each."""
        grid = Grid(np.append(self.motion.elements.low, self.cycle))
        found = extremes(grid, self._sampled(grid.degrees, grid.within), self._sampled).values()
        return (
            np.array([[one.largest.value] for one in found]),
            np.array([[one.smallest.value] for one in found]),
        )

    def over(self, piece: int, degrees: Array) -> Array:
        """Return the torque in a piece in N m at crank angles (n,) in degrees, just after a jump."""
        angles = np.mod(degrees, self.cycle)
        return np.asarray(self.means[piece] + self._sampled(angles, angles)[str(piece)].value)
