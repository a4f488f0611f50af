"""The machine: one immutable description in SI, complete at birth, from a file or from Python.

Records check their own rules and raise RuleError. They hold numbers only; what the numbers lead to is in
`kurbel.solver`. Records that few machines need live in modules of their own and are imported when a machine names them.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, ClassVar

from kurbel.declared.forms import Choice, Count, Inline, Limits, Listing, Number, OneOf, Physical, Record, Text, Variant
from kurbel.declared.keys import Described, Key, Keys
from kurbel.errors import Fault, refuse
from kurbel.machine.fit import misfits
from kurbel.mechanisms import MECHANISMS, Mechanism

if TYPE_CHECKING:
    from kurbel.machine.crankshaft import Crankshaft
    from kurbel.machine.friction import Friction
    from kurbel.machine.masses import Masses
    from kurbel.machine.piston import Piston
    from kurbel.machine.resistance import Moment, RamForce
    from kurbel.machine.turning import Coupling, Effort, Flywheel, Load

FORMAT = 1
"""Number of the machine-file format that this version reads."""
STANDARD_ATMOSPHERE = 101325.0
CYCLES = {"two-stroke": 1, "four-stroke": 2}
"""Cycle -> revolutions of the shaft."""


@dataclass(frozen=True, eq=False)
class Cylinder(Described):
    """One cylinder with its crank mechanism and everything that hangs on the same rod.

    pistons: its own first, then the tandem ones; inclination in degrees against the horizontal, None where the weight
    is left out; crank_position: degrees by which this crank follows crank 1; ram_force, moment: what the output works
    against, where it slides or only swings. Raises RuleError for parts that the mechanism cannot have.
    """

    mechanism: Mechanism
    name: str = "cylinder 1"
    pistons: tuple[Piston, ...] = ()
    masses: Masses | None = None
    friction: Friction | None = None
    inclination: float | None = None
    crank_position: float = 0.0
    ram_force: RamForce | None = None
    moment: Moment | None = None
    cycle: str | None = None

    KEYS: ClassVar[Keys] = {
        "name": Key(Text(), "Name of the cylinder", absent="cylinder 1, cylinder 2, …"),
        "mechanism": Key(
            Variant("slider-crank", MECHANISMS),
            "Kind of crank mechanism",
            absent="slider-crank",
        ),
        "inclination": Key(
            Physical("angle", least=-180, most=180),
            "Stroke line against the horizontal: 0 deg lying, 90 deg cylinder above the shaft, beyond it leaning over",
            absent="weight left out",
        ),
        "piston": Key(Inline(Record("kurbel.machine.piston:Piston")), "The cylinder's own piston"),
        "tandem": Key(
            Listing(Record("kurbel.machine.piston:Piston"), inline_too=True),
            "Further pistons on the same rod, such as a pump; their two-stroke cards run twice in 720°",
            absent="none",
        ),
        "masses": Key(Record("kurbel.machine.masses:Masses"), "Masses of the moving parts", absent="no inertia"),
        "friction": Key(
            Record("kurbel.machine.friction:Friction"), "Friction of crosshead and piston rings", absent="no friction"
        ),
        "crank_position": Key(Physical("angle"), "Angle by which this crank follows crank 1", absent="0 deg"),
        "ram_force": Key(
            Record("kurbel.machine.resistance:RamForce"),
            "Force on a ram against its motion, constant on each stroke",
            absent="none",
        ),
        "moment": Key(
            Record("kurbel.machine.resistance:Moment"),
            "Moment against the motion of a mechanism whose output only swings or turns",
            absent="none",
        ),
        "cycle": Key(
            Choice(tuple(CYCLES)), "Working cycle of this cylinder, among others", absent="that of the machine"
        ),
    }

    @classmethod
    def of_keys(cls, piston: Piston | None = None, tandem: tuple[Piston, ...] = (), **keys: Any) -> Cylinder:
        """Return the cylinder that these keys of a machine file describe; the machine names it where they do not."""
        if tandem and piston is None:
            refuse(Fault(("tandem",), "a tandem piston stands beside the cylinder's own one; give its 'bore'"))
        return cls(pistons=() if piston is None else (piston, *tandem), **{"name": "", **keys})

    def __post_init__(self) -> None:
        rings = self.friction and self.friction.rings
        faults = list(misfits(self))
        if rings and not self.pistons and self.mechanism.slides:
            faults.append(Fault(("friction", "rings"), "rings rub on the bore; give the cylinder a 'bore'"))
        refuse(*faults)


@dataclass(frozen=True, eq=False)
class Machine(Described):
    """A whole machine.

    speed: revolutions per second, None where it is not given; cycle: `two-stroke` or `four-stroke`; ambient: absolute
    pressure in Pa; efficiency η multiplies the turning effort of the whole machine, or divides it where the machine is
    driven; brake_power: measured, in W; limits: key-value id -> bound in SI.
    """

    cylinders: tuple[Cylinder, ...]
    name: str = "machine"
    speed: float | None = None
    cycle: str = "two-stroke"
    efficiency: float = 1.0
    ambient: float = STANDARD_ATMOSPHERE
    brake_power: float | None = None
    flywheel: Flywheel | None = None
    load: Load | None = None
    effort: Effort | None = None
    coupling: Coupling | None = None
    crankshaft: Crankshaft | None = None
    limits: tuple[tuple[str, float], ...] = ()

    KEYS: ClassVar[Keys] = {
        "kurbel": Key(Count(least=FORMAT, most=FORMAT), "Number of the file format", absent="1"),
        "name": Key(Text(), "Name of the machine", absent="the file name"),
        "speed": Key(
            Physical("speed", least=0),
            "Speed of rotation",
            "n",
            absent="no velocities, accelerations or inertia in physical units",
        ),
        "cycle": Key(Choice(tuple(CYCLES)), "Working cycle: 360° or 720°", absent="two-stroke"),
        "efficiency": Key(
            Number(above=0, most=1),
            "Mechanical efficiency of the whole machine: its turning effort is multiplied by it (R p. 611), or divided "
            "by it where the machine is driven",
            "η",
            absent="1",
        ),
        "ambient": Key(Physical("pressure", least=0), "Absolute pressure round the machine", absent="1.01325 bar"),
        "brake_power": Key(
            Physical("power", least=0),
            "Power measured at the shaft; a warning tells when less is indicated",
            "N_e",
            absent="not compared",
        ),
        "cylinder": Key(Inline(Record("kurbel.machine:Cylinder"), unless="cylinders"), "The keys of the only cylinder"),
        "cylinders": Key(
            Listing(Record("kurbel.machine:Cylinder"), inline_too=True),
            "Several cylinders; their keys then do not stand at the top",
            absent="one cylinder, flat",
        ),
        "flywheel": Key(Record("kurbel.machine.turning:Flywheel"), "Flywheel", absent="no speed line"),
        "load": Key(
            OneOf(Choice(("constant",)), Record("kurbel.machine.turning:Load")),
            "Resistance at the shaft",
            absent="constant",
        ),
        "effort": Key(
            Record("kurbel.machine.turning:Effort"),
            "A turning-moment diagram known from elsewhere, instead of cylinders",
            absent="from the cylinders",
        ),
        "coupling": Key(
            Record("kurbel.machine.turning:Coupling"),
            "Elastic coupling to a driven moment of inertia",
            absent="rigid",
        ),
        "crankshaft": Key(
            Record("kurbel.machine.crankshaft:Crankshaft"),
            "One throw between bearings A and B",
            absent="no strength check",
        ),
        "limits": Key(Limits(), "Bounds for key values, checked by `kurbel check`", absent="none"),
    }

    @classmethod
    def of_keys(
        cls,
        cylinder: Cylinder | None = None,
        cylinders: tuple[Cylinder, ...] = (),
        load: Load | str | None = None,
        kurbel: int = FORMAT,
        **keys: Any,
    ) -> Machine:
        """Return the machine that these keys of a machine file describe; raises RuleError."""
        from dataclasses import replace

        given = cylinders if cylinder is None else (cylinder,)
        named = tuple(c if c.name else replace(c, name=f"cylinder {i}") for i, c in enumerate(given, 1))
        return cls(named, load=None if isinstance(load, str) else load, **keys)

    def __post_init__(self) -> None:
        if not self.cylinders and self.effort is None:
            refuse(Fault((), "the machine has no cylinder: give 'crank' and 'rod', or 'cylinders'"))
        if self.cylinders and self.effort is not None:
            refuse(Fault(("effort",), "'effort' stands instead of cylinders; leave one of them out"))
        names = [cylinder.name for cylinder in self.cylinders]
        for index, name in enumerate(names):
            if name in names[:index]:
                refuse(Fault(("cylinders", index, "name"), f"two cylinders are called '{name}'"))
        faults = [fault for index in range(len(self.cylinders)) for fault in self._cycle_faults(index)]
        for key, diagram in (("effort", self.effort), ("load", self.load)):
            if diagram is not None and (message := diagram.cycle_fault(self._common_cycle)):
                faults.append(Fault((key, "points"), message))
        refuse(*faults)

    def _cycle_faults(self, index: int) -> list[Fault]:
        """A four-stroke cycle needs four-line cards, a two-stroke one two-line cards; some need absolute pressures."""
        cylinder = self.cylinders[index]
        return [
            fault.below(("cylinders", index))
            for number, piston in enumerate(cylinder.pistons)
            for fault in piston.indicator_faults(
                self.cycle_of_piston(cylinder, number), self.ambient, () if number == 0 else ("tandem", number - 1)
            )
        ]

    def cycle_of(self, cylinder: Cylinder) -> str:
        """Return the working cycle of a cylinder: its own, or that of the machine."""
        return cylinder.cycle or self.cycle

    def cycle_of_piston(self, cylinder: Cylinder, number: int) -> str:
        """Return the working cycle of a piston of a cylinder, counted from its own one as 0."""
        cycle = self.cycle_of(cylinder)
        return cylinder.pistons[number].cycle_beside(cycle) if number else cycle

    @property
    def _common_cycle(self) -> str:
        """The longest working cycle, after which everything repeats."""
        return max((self.cycle, *map(self.cycle_of, self.cylinders)), key=CYCLES.__getitem__)

    @property
    def revolutions(self) -> int:
        """Revolutions of the shaft until everything repeats: 1, or 2 where any cylinder works in four strokes."""
        return CYCLES[self._common_cycle]

    @property
    def trace_files(self) -> tuple[str, ...]:
        """The files that the traces of the machine were read from."""
        indicators = [
            piston.indicator for cylinder in self.cylinders for piston in cylinder.pistons if piston.indicator
        ]
        files = (getattr(end, "file", None) for one in indicators for end in (one.head_end, one.crank_end))
        return tuple(dict.fromkeys(file for file in files if file))
