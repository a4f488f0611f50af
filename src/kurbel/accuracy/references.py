"""References of a machine: what textbooks sum over its cylinders, integrated and searched in mpmath's numbers."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kurbel.accuracy.cards import KNOWN_CARDS
from kurbel.accuracy.efforts import Diagram, diagram_of, knees_of
from kurbel.accuracy.methods import MethodValue, Precise, by_gauss, integrals, merged, mpf
from kurbel.accuracy.textbook import STEPS, TextbookCylinder
from kurbel.arrays import Array
from kurbel.machine import Cylinder, Machine
from kurbel.machine.cylinder import crank_lag, work_alike
from kurbel.machine.shaft_side import Swing

if TYPE_CHECKING:
    from kurbel.traces.correct import Trace

MOST_SAMPLES = 400
"""Samples of a trace of which a reference is computed: its time is in proportion to them."""
NEEDED: dict[str, Callable[[Precise], Precise]] = {
    "A_i": lambda state: state.slope * state.P_gas,
    "T_max, T_min": lambda state: state.T,
    "A_f": lambda state: sum(state.losses.values()) - state.slope * state.F_friction,
    "ΔE": lambda state: state.M,
}
"""Quantity -> what it is the integral, the extremes or the swing of, from the columns of `Forces` or of the solver."""
Torque = Callable[[Precise, Precise], Precise]
"""Takes an angle in degrees, and one within its piece."""


# what has no reference


def taking_part(machine: Machine, quantity: str) -> tuple[Cylinder, ...]:
    """Return the cylinders that a quantity belongs to: all, or the first one."""
    return machine.cylinders if quantity == "ΔE" else machine.cylinders[:1]


def unknown(machine: Machine, quantity: str) -> Iterator[str]:
    """Yield what of a machine has no independent calculation of a quantity here."""
    if quantity in "xcb":
        return
    for cylinder in taking_part(machine, quantity):
        for piston in cylinder.pistons:
            for card in piston.chambers.values():
                if card.traced:
                    yield from _unknown_of_trace(card, quantity)
                elif not isinstance(card, KNOWN_CARDS):
                    yield "a card by Wiebe"
        friction = cylinder.friction
        if friction and friction.journals and machine.crankshaft is not None:
            yield "journals that rub in the bearings of a crankshaft"
    if quantity == "ΔE" and isinstance(machine.effort, Swing):
        yield "an effort of which the swing of energy is given"


def _unknown_of_trace(trace: Trace, quantity: str) -> Iterator[str]:
    """Yield what of a trace has no independent calculation of a quantity."""
    if len(trace.angles) > MOST_SAMPLES:
        yield f"a trace of more than {MOST_SAMPLES} samples"
    elif quantity == "A_i" and trace.even:
        yield "the work of a trace at equal angles, which is a sum over its samples"


# sums


class Share(NamedTuple):
    """What the torque of a cylinder counts for the losses (R p. 611-613), and the torque of its driving pistons."""

    of_all: Precise = 1.0
    of_driving: Precise = 0.0


class Addends(NamedTuple):
    """What a quantity is a sum of: cylinders with the lags of their cranks and their shares; diagrams with factors.

    A cylinder is a function that returns its columns at angles of its own crank.
    """

    cylinders: Sequence[tuple[Torque, Precise, Share]]
    diagrams: Sequence[tuple[Torque, float]] = ()


def needed(quantity: str, addends: Addends, phi: Precise, within: Precise) -> Precise:
    """Return what a quantity is computed from, at angles of crank 1."""
    total = 0 * phi
    for at, lag, share in addends.cylinders:
        state = at(phi - lag, within - lag)
        total = total + share.of_all * NEEDED[quantity](state)
        if share.of_driving:
            total = total + share.of_driving * state.P_driving * state.slope
    for diagram, factor in addends.diagrams:
        total = total + factor * diagram(phi, within)
    return total


class AlikeCylinders(NamedTuple):
    """A cylinder of the textbook, of which others have the same: with its surroundings and the lags of its links."""

    cylinder: Cylinder
    surroundings: tuple[object, ...]
    links: tuple[tuple[TextbookCylinder, Precise], ...]
    textbook: TextbookCylinder


class Textbook:
    """The references of a machine, which share its cylinders; equal cylinders are one.

    earlier: of another machine, whose cylinders are taken over where they are equal.
    """

    def __init__(self, machine: Machine, earlier: Textbook | None = None) -> None:
        self.machine = machine
        self._cylinders: list[AlikeCylinders] = earlier._cylinders if earlier else []

    def cylinder(self, cylinder: Cylinder) -> TextbookCylinder:
        """Return the cylinder of the textbook for one of the file; where it is on the shaft makes no difference."""
        machine = self.machine
        surroundings = (
            machine.speed,
            machine.ambient,
            machine.cycle,
            machine.inclination_of(cylinder),
            machine.crankshaft,
            machine.pump,
        )
        links = []
        for link in machine.cylinders:
            if link.hangs_on(cylinder.name):
                links.append((self.cylinder(link), mpf(lag_of_link(link, cylinder))))
        for earlier in self._cylinders:
            is_alike = work_alike(earlier.cylinder, cylinder)
            if is_alike and earlier.surroundings == surroundings and earlier.links == tuple(links):
                return earlier.textbook
        textbook_cylinder = TextbookCylinder(machine, cylinder, links)
        alike = AlikeCylinders(cylinder, surroundings, tuple(links), textbook_cylinder)
        self._cylinders.append(alike)
        return textbook_cylinder

    def reference(self, quantity: str) -> MethodValue:
        """Return A_i and A_f in J, T_max and T_min in N, of the first cylinder, or ΔE in J."""
        book = TextbookMachine(self, quantity)
        return by_gauss(quantity, book.function(quantity), book.edges, STEPS)


def lag_of_link(link: Cylinder, master: Cylinder) -> float:
    """Return the degrees by which the crank angle of a link lags that of its master, in its own turn of the cycle."""
    between = link.bank_angle - master.bank_angle
    turns = round((crank_lag(link, master) - between) / 360)
    return between + 360 * turns


class TextbookMachine:
    """Cylinders with the lags of their cranks; edges: of all pieces of the cycle, at the angles of crank 1."""

    def __init__(self, textbook: Textbook, quantity: str) -> None:
        machine = textbook.machine
        self.cylinders: list[tuple[TextbookCylinder, Precise]] = []
        for cylinder in taking_part(machine, quantity):
            lag = mpf(crank_lag(cylinder, machine.cylinders[0]))
            self.cylinders.append((textbook.cylinder(cylinder), lag))

        # the pieces of the cylinders
        turns = machine.revolutions if quantity == "ΔE" else self.cylinders[0][0].turns
        self.cycle = 360 * turns
        edges = [mpf(0), mpf(self.cycle)]
        for textbook_cylinder, lag in self.cylinders:
            for turn in range(0, turns, textbook_cylinder.turns):
                edges += [
                    (edge + lag + 360 * turn) % self.cycle for edge in textbook_cylinder.edges
                ]

        # what the file gives over the angle
        self.diagrams: list[tuple[Torque, float]] = []
        self.shares = [Share()] * len(self.cylinders)
        if quantity == "ΔE":
            for diagram, factor in _diagrams_of(machine, self.cycle):
                self.diagrams.append((diagram_of(diagram), factor))
                edges += knees_of(diagram, self.cycle)
            self.shares = self._shares(mpf(machine.efficiency))
        self.edges = merged(np.array(edges))

    @property
    def addends(self) -> Addends:
        """What its quantity is a sum of."""
        cylinders = []
        for (cylinder, lag), share in zip(self.cylinders, self.shares):
            cylinders.append((cylinder.at, lag, share))
        return Addends(cylinders, self.diagrams)

    def _shares(self, eta: Precise) -> list[Share]:
        """Return the shares of the cylinders: of a machine that drives, driven pistons count in full."""
        cylinders = [cylinder for cylinder, _ in self.cylinders]
        if not any(cylinder.drives for cylinder in cylinders):
            is_driven = any(cylinder.is_driven for cylinder in cylinders)
            share = Share(1 / eta) if is_driven else Share()
            return [share] * len(cylinders)
        shares = []
        for cylinder in cylinders:
            share = Share()
            if cylinder.drives and cylinder.is_driven:
                share = Share(1.0, eta - 1)
            elif cylinder.drives:
                share = Share(eta)
            shares.append(share)
        return shares

    def function(self, quantity: str) -> Callable[[Array, Array], Array]:
        """Return what a quantity is computed from."""
        return np.frompyfunc(partial(needed, quantity, self.addends), 2, 1)


def _diagrams_of(machine: Machine, cycle: int) -> Iterator[tuple[Diagram, float]]:
    """Yield a given effort, with the factor for its losses, and a given load."""
    effort = machine.effort
    if effort is not None:
        assert not isinstance(effort, Swing)
        torque = np.frompyfunc(diagram_of(effort), 2, 1)
        edges = merged(np.array([mpf(0), mpf(cycle), *knees_of(effort, cycle)]))
        drives = integrals(torque, edges, STEPS).sum() >= 0
        yield effort, machine.efficiency if drives else 1 / machine.efficiency
    load = machine.load.diagram if machine.load else None
    if load is not None:
        yield load, -1.0
