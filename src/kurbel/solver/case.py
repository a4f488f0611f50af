"""All results of a machine, each computed on first use."""

from __future__ import annotations

from functools import cached_property

from kurbel.arrays import Array
from kurbel.errors import UsageError
from kurbel.machine import Machine
from kurbel.solver.balance import MachineBalance
from kurbel.solver.bearings import Bearing, ShaftBearings
from kurbel.solver.delivery import CompressorStage, Delivery, MachineDelivery
from kurbel.solver.effort import TurningEffort
from kurbel.solver.figures import Figure, Shown, rows_of
from kurbel.solver.flywheel import MachineTurning
from kurbel.solver.forces import CylinderForces
from kurbel.solver.harmonics import MachineOrders
from kurbel.solver.stress import CrankshaftStrength
from kurbel.solver.torsion import ShaftVibration


class Case(Shown):
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
        of_cylinder = bool(self.cylinders) and self.cylinders[0].rows.named(name)
        if of_cylinder and len(self.cylinders) == 1:
            return self.cylinders[0][name]
        if rows_of(CrankshaftStrength).named(name):
            return self.stress[name]
        if rows_of(MachineTurning).named(name):
            return self.flywheel[name]
        if rows_of(MachineBalance).named(name):
            return self.balance[name]
        if rows_of(ShaftVibration).named(name):
            return self.torsion[name]
        if rows_of(Delivery).named(name) and self.delivery.pump:
            return self.delivery.pump[name]
        if rows_of(CompressorStage).named(name):
            if len(self.delivery.stages) == 1:
                return self.delivery.stages[0][name]
            raise UsageError(f"each stage has its own {name}: ask one of case.delivery.stages")
        if of_cylinder:
            raise UsageError(f"each cylinder has its own {name}: ask one of case.cylinders")
        if rows_of(Bearing).named(name):
            raise UsageError(f"each pin and main bearing has its own {name}: ask one of case.bearings.parts")
        return self.flywheel[name]

    def __repr__(self) -> str:
        return f"<kurbel case '{self.machine.name}': .cylinders ({len(self.machine.cylinders)}), .flywheel, .stress>"

    @cached_property
    def cylinders(self) -> tuple[CylinderForces, ...]:
        """Motion, forces and key values of every cylinder, in the order of the file; those of equal ones are shared."""
        found: list[CylinderForces] = []
        for cylinder in self.machine.cylinders:
            twin = next((one for one in found if one.twin is None and one.is_like(cylinder)), None)
            found.append(CylinderForces(self.machine, cylinder, self.count, twin))
        return tuple(found)

    @cached_property
    def stress(self) -> CrankshaftStrength:
        """Strength of the crankshaft. Raises UsageError where the machine has none that can be examined."""
        return CrankshaftStrength(self.machine, self.cylinders)

    @cached_property
    def bearings(self) -> ShaftBearings:
        """Loads on pins and main bearings. Raises UsageError where nothing loads them."""
        return ShaftBearings(self.machine, self.cylinders)

    @cached_property
    def balance(self) -> MachineBalance:
        """Unbalanced forces and moments of the whole machine. Raises UsageError where no masses move."""
        return MachineBalance(self.effort)

    @cached_property
    def flywheel(self) -> MachineTurning:
        """Turning effort, flywheel and speed line of the whole machine. Raises UsageError where nothing turns it."""
        return MachineTurning(self.effort)

    @cached_property
    def delivery(self) -> MachineDelivery:
        """What pumps and compressors deliver. Raises UsageError where the machine delivers nothing."""
        return MachineDelivery(self.effort)

    @cached_property
    def effort(self) -> TurningEffort:
        """Turning effort and load of the whole machine, which raise errors only when they are computed."""
        return TurningEffort(self.machine, self.cylinders, self.count)

    def harmonics(self, orders: Array | None = None) -> MachineOrders:
        """Return the orders (n,) of the turning effort, or the usual ones.

        Raises UsageError where nothing turns the machine, NoSolutionError where losses leave too little.
        """
        _ = self.effort.excess  # refuses a machine that cannot run
        return MachineOrders(self.effort, orders)

    @cached_property
    def torsion(self) -> ShaftVibration:
        """Torsional vibration of the shaft line, by the usual orders. Raises UsageError where there is none."""
        return self.torsion_of(None)

    def torsion_of(self, orders: Array | None) -> ShaftVibration:
        """Return the torsional vibration by these orders (k,)."""
        return ShaftVibration(self.effort, orders)
