"""All results of a machine, each computed on first use, and imported on first use.

A chapter of results is a row of `CHAPTERS`; its class is behind a door, a function with one import inside.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from functools import cached_property
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from kurbel.arrays import Array
from kurbel.declared.reading import text_in_one_line
from kurbel.errors import UsageError
from kurbel.machine import Machine
from kurbel.near_words import did_you_mean
from kurbel.quantity import called
from kurbel.solver.figures import Figure, NotebookView, Results, doors_of, result_rows
from kurbel.solver.forces import CylinderForces

if TYPE_CHECKING:
    from kurbel.solver.chapters.balance import MachineBalance
    from kurbel.solver.chapters.bearing import Bearing
    from kurbel.solver.chapters.bearings import ShaftBearings
    from kurbel.solver.chapters.compressors import CompressorStage
    from kurbel.solver.chapters.delivery import Delivery, MachineDelivery
    from kurbel.solver.chapters.harmonics import MachineOrders
    from kurbel.solver.chapters.stress import CrankshaftStrength
    from kurbel.solver.chapters.torsion import ShaftVibration
    from kurbel.solver.dead_centre import DeadCentre
    from kurbel.solver.effort import TurningEffort
    from kurbel.solver.flywheel import MachineTurning


class Case(NotebookView):
    """A machine with its results; count: of how many machines its numbers are arrays (machines,), None for one.

    >>> from kurbel.machine import Cylinder, Machine
    >>> from kurbel.mechanisms.slider_crank import SliderCrank
    >>> case = Case(Machine((Cylinder(SliderCrank(crank=0.4, rod=2.0)),), speed=50 / 60))
    >>> round(case.cylinders[0].motion.c_max.value, 6)
    2.135933
    """

    def __init__(self, machine: Machine, count: int | None = None) -> None:
        self.machine, self.count = machine, count

    def __getitem__(self, name: str) -> Figure:
        """Return a key value by its id or printed symbol, of the only cylinder, or of the whole machine.

        Of several cylinders each has its own: `case.cylinders[0]["P_max"]`. Raises UsageError where there is none.
        """
        why = ""
        for chapter in self._chapters_with(name):
            results = chapter.of(self)
            if len(results) == 1:
                return results[0][name]
            if results:
                why = chapter.each.format(name)
            elif not why:
                why = f"this machine has no {name}"
        if not why:
            ids = list[str]()
            for chapter in CHAPTERS:
                ids += result_rows(chapter.kind).key_values
            near = did_you_mean(name, tuple(ids))
            why = f"no key value '{text_in_one_line(name)}'{near}"
        raise UsageError(why)

    def _chapters_with(self, name: str) -> Iterator[Chapter]:
        """Yield the chapters that have a key value; one is opened only if those before it do not have it."""
        # without the parts that this machine has not
        having = False
        for chapter in CHAPTERS:
            if chapter.kind is CylinderForces and self.cylinders:
                rows = self.cylinders[0].rows
            else:
                rows = result_rows(chapter.kind, closed=doors_of(chapter.kind))
            if called(name, rows.lists.all_key_values):
                having = True
                yield chapter
        if having:
            return
        for chapter in CHAPTERS:
            if called(name, result_rows(chapter.kind).lists.all_key_values):
                yield chapter

    def results(self, command: str) -> list[Results]:
        """Return all results of a command; raises what these raise, UsageError where the machine has none."""
        results = list[Results]()
        for chapter in CHAPTERS:
            if chapter.command == command:
                results += chapter.of(self)
        return results

    def __repr__(self) -> str:
        return f"<kurbel case '{self.machine.name}': .cylinders ({len(self.machine.cylinders)}), .flywheel, .stress>"

    @cached_property
    def cylinders(self) -> tuple[CylinderForces, ...]:
        """Motion, forces and key values of every cylinder, in the order of the file; those of equal ones are shared."""
        cylinders: list[CylinderForces] = []
        for cylinder in self.machine.cylinders:
            twin = None
            for other in cylinders:
                if other.twin is None and other.is_like(cylinder):
                    twin = other
                    break
            cylinders.append(CylinderForces(self.machine, cylinder, self.count, twin))
        return tuple(cylinders)

    @cached_property
    def stress(self) -> CrankshaftStrength:
        """Strength of the crankshaft. Raises UsageError where the machine has none that can be examined."""
        return _stress()(self.machine, self.cylinders)

    @cached_property
    def bearings(self) -> ShaftBearings:
        """Loads on pins and main bearings. Raises UsageError where nothing loads them."""
        from kurbel.solver.chapters.bearings import ShaftBearings

        return ShaftBearings(self.machine, self.cylinders)

    @cached_property
    def balance(self) -> MachineBalance:
        """Unbalanced forces and moments of the whole machine. Raises UsageError where no masses move."""
        return _balance()(self.effort)

    @cached_property
    def flywheel(self) -> MachineTurning:
        """Turning effort, flywheel and speed line of the whole machine. Raises UsageError where nothing turns it."""
        return _turning()(self.effort)

    @cached_property
    def delivery(self) -> MachineDelivery:
        """What pumps and compressors deliver. Raises UsageError where the machine delivers nothing."""
        from kurbel.solver.chapters.delivery import MachineDelivery

        return MachineDelivery(self.effort)

    @cached_property
    def effort(self) -> TurningEffort:
        """Turning effort and load of the whole machine, which raise errors only when they are computed."""
        from kurbel.solver.effort import TurningEffort

        return TurningEffort(self.machine, self.cylinders, self.count)

    def harmonics(self, orders: Array | Sequence[float] | None = None) -> MachineOrders:
        """Return the orders (n,) of the turning effort, or the usual ones.

        Raises UsageError where nothing turns the machine, NoSolutionError where losses leave too little.
        """
        _ = self.effort.excess  # refuses a machine that cannot run
        chosen = None if orders is None else np.asarray(orders, dtype=float)
        harmonics = _orders()(self.effort, chosen)
        # those of the same orders are computed once
        return self._harmonics.setdefault(tuple(harmonics.orders.tolist()), harmonics)

    @cached_property
    def _harmonics(self) -> dict[tuple[float, ...], MachineOrders]:
        """Harmonics of the turning effort that are in use, by their orders."""
        return {}

    @cached_property
    def torsion(self) -> ShaftVibration:
        """Torsional vibration of the shaft line, by the usual orders. Raises UsageError where there is none."""
        return self.torsion_of(None)

    def torsion_of(self, orders: Array | None) -> ShaftVibration:
        """Return the torsional vibration by these orders (k,)."""
        return _torsion()(self.effort, orders)


# the doors


def _turning() -> type[MachineTurning]:
    from kurbel.solver.flywheel import MachineTurning

    return MachineTurning


def _dead_centre() -> type[DeadCentre]:
    from kurbel.solver.dead_centre import DeadCentre

    return DeadCentre


def _stress() -> type[CrankshaftStrength]:
    from kurbel.solver.chapters.stress import CrankshaftStrength

    return CrankshaftStrength


def _bearing() -> type[Bearing]:
    from kurbel.solver.chapters.bearing import Bearing

    return Bearing


def _balance() -> type[MachineBalance]:
    from kurbel.solver.chapters.balance import MachineBalance

    return MachineBalance


def _orders() -> type[MachineOrders]:
    from kurbel.solver.chapters.harmonics import MachineOrders

    return MachineOrders


def _torsion() -> type[ShaftVibration]:
    from kurbel.solver.chapters.torsion import ShaftVibration

    return ShaftVibration


def _pump() -> type[Delivery]:
    from kurbel.solver.chapters.delivery import Delivery

    return Delivery


def _stage() -> type[CompressorStage]:
    from kurbel.solver.chapters.compressors import CompressorStage

    return CompressorStage


class Chapter(NamedTuple):
    """A class of results behind a door, the command that prints it, and a function that returns those of a case.

    each: where these are several, the message for a key value `{}` of which it is not known whose it is.
    """

    command: str
    door: Callable[[], type[Results]]
    of: Callable[[Case], Sequence[Results]]
    each: str = ""

    @property
    def kind(self) -> type[Results]:
        """The class."""
        return self.door()


CHAPTERS = (
    Chapter(
        "forces",
        lambda: CylinderForces,
        lambda case: case.cylinders,
        "each cylinder has its own {}: ask one of case.cylinders",
    ),
    Chapter("flywheel", _turning, lambda case: [case.flywheel]),
    Chapter(
        "flywheel",
        _dead_centre,
        lambda case: [_dead_centre()(cylinder, case.effort.cycle) for cylinder in case.cylinders],
    ),
    Chapter("stress", _stress, lambda case: [case.stress]),
    Chapter(
        "bearings",
        _bearing,
        lambda case: case.bearings.parts,
        "each pin and main bearing has its own {}: ask one of case.bearings.parts",
    ),
    Chapter("balance", _balance, lambda case: [case.balance]),
    Chapter("harmonics", _orders, lambda case: [case.harmonics()]),
    Chapter("torsion", _torsion, lambda case: [case.torsion]),
    Chapter("delivery", _pump, lambda case: [case.delivery.pump] if case.delivery.pump else []),
    Chapter(
        "delivery",
        _stage,
        lambda case: case.delivery.stages,
        "each stage has its own {}: ask one of case.delivery.stages",
    ),
)
"""Every class of results, in the order in which its quantities are listed; each includes those of its parts."""
