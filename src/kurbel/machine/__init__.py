"""The machine: one immutable description in SI, complete at birth, from a file or from Python.

Records check their own rules and raise RuleError. They hold numbers only; what the numbers lead to is in
`kurbel.solver`.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, ClassVar

from kurbel.crank_angle import CrankAngle
from kurbel.declared.forms import (
    Alike,
    Choice,
    Count,
    Expectations,
    FiringOrder,
    Inline,
    Limits,
    Listing,
    Number,
    OneOf,
    Physical,
    Record,
    Text,
    Uncertainties,
    not_negative,
)
from kurbel.declared.forms.figures import MACHINE, Expected, scoped
from kurbel.declared.keys import Described, Key, Keys
from kurbel.declared.reading import REFUSED, shown
from kurbel.errors import Fault, RuleError, refuse
from kurbel.machine.balance import BalanceShaft, Counterweight, Locomotive, SharedCounterweights
from kurbel.machine.crankshaft import Crankshaft
from kurbel.machine.cylinder import COUNTERWEIGHTS, CYCLES, Cylinder, crowded
from kurbel.machine.equal import EqualCylinders, in_order
from kurbel.machine.flywheel import Flywheel
from kurbel.machine.origin import Origin
from kurbel.machine.shaft_line import ShaftLine, ShaftPart
from kurbel.machine.shaft_list import line_of, shaft_faults
from kurbel.machine.turning import Coupling, Effort, Harmonics, Load
from kurbel.near_words import did_you_mean

__all__ = ["CYCLES", "Cylinder", "Machine"]

FORMAT = 1
"""Number of the machine-file format that this version reads."""
STANDARD_ATMOSPHERE = 101325.0


def _names(cylinders: Sequence[Cylinder]) -> list[str]:
    return [one.name or f"cylinder {number}" for number, one in enumerate(cylinders, 1)]


def _shaft_faults(parts: Sequence[ShaftPart | str], cylinders: tuple[Cylinder, ...] | EqualCylinders) -> list[Fault]:
    names = _names(cylinders if isinstance(cylinders, tuple) else cylinders.cylinders)
    return [fault.below(("shaft",)) for fault in shaft_faults(parts, names)]


@dataclass(frozen=True, eq=False, repr=False)
class Machine(Described):
    """A whole machine.

    speed: revolutions per second, None where it is not given; cycle: `two-stroke` or `four-stroke`; ambient: absolute
    pressure in Pa; efficiency η of the driving side, by which the turning effort is divided where no piston
    drives; brake_power: measured, in W; limits: key-value id -> bound in SI; expect: key-value id -> the smallest and
    the largest value in SI that are met, either id after `machine.` or the name of a cylinder where it is of that one;
    uncertainty: dotted key -> its standard uncertainty as a text; rotation: `over` or `under`, the sense in which it
    turns, None where it is not told; moment_reference: place along the shaft in m about which free moments are taken,
    None for the middle.
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
    effort: Effort | Harmonics | None = None
    coupling: Coupling | None = None
    crankshaft: Crankshaft | None = None
    counterweights: SharedCounterweights | tuple[Counterweight, ...] = ()
    balance_shafts: tuple[BalanceShaft, ...] = ()
    moment_reference: float | None = None
    locomotive: Locomotive | None = None
    shaft: ShaftLine | None = None
    limits: tuple[tuple[str, float], ...] = ()
    expect: tuple[tuple[str, Expected], ...] = ()
    uncertainty: tuple[tuple[str, str], ...] = ()
    rotation: str | None = None
    origin: Origin | None = None

    KEYS: ClassVar[Keys] = {
        "kurbel": Key(Count(least=FORMAT, most=FORMAT), "Number of the file format", absent="1"),
        "name": Key(Text(), "Name of the machine", absent="the file name"),
        "speed": not_negative(
            "speed", "Speed of rotation", "n", absent="no velocities, accelerations or inertia in physical units"
        ),
        "cycle": Key(Choice(tuple(CYCLES)), "Working cycle: 360° or 720°", absent="two-stroke"),
        "rotation": Key(
            Choice(("over", "under")),
            "Sense in which a lying machine turns: over, the crank pin rising from the inner dead centre, so that an "
            "engine presses its crosshead down, or under (R p. 602)",
            absent="over, and nothing is said of the guide",
            also=("direction", "sense"),
        ),
        "efficiency": Key(
            Number(above=0, most=1),
            "Mechanical efficiency: multiplies the torque of cylinders whose pistons drive, or only the gas force of "
            "those that drive where others on the rod are driven (R p. 610–613); divides all torque where none drives",
            "η",
            absent="1",
        ),
        "ambient": not_negative("pressure", "Absolute pressure round the machine", absent="1.01325 bar"),
        "brake_power": not_negative(
            "power", "Power measured at the shaft; a warning tells when less is indicated", "N_e", absent="not compared"
        ),
        "brake_torque": not_negative("torque", "The same as a torque", "M_e", instead="brake_power", needs="speed"),
        "cylinder": Key(Inline(Record(Cylinder), unless="cylinders"), "The keys of the only cylinder"),
        "cylinders": Key(
            OneOf(
                Alike(Record(Cylinder, inline_too=True), "cylinder"),
                Record(EqualCylinders),
            ),
            "Several cylinders, listed, or equal ones at once; their keys then do not stand at the top",
            absent="one cylinder, flat",
        ),
        "firing_order": Key(
            FiringOrder(),
            "Order in which the cylinders fire, at equal intervals over the cycle; sets `crank_position`",
            absent="positions as given",
        ),
        "flywheel": Key(Record(Flywheel), "Flywheel", absent="no speed line"),
        "load": Key(
            OneOf(Choice(("constant",)), Record(Load)),
            "Resistance at the shaft",
            absent="constant",
        ),
        "effort": Key(
            Record("kurbel.machine_file.effort:Known"),
            "A turning-moment diagram known from elsewhere, instead of cylinders",
            absent="from the cylinders",
        ),
        "coupling": Key(Record(Coupling), "Elastic coupling to a driven moment of inertia", absent="rigid"),
        "crankshaft": Key(
            Record(Crankshaft),
            "One throw between bearings A and B",
            absent="no strength check",
        ),
        "counterweights": COUNTERWEIGHTS,
        "balance_shafts": Key(
            Listing(Record(BalanceShaft)),
            "Shafts with weights that turn once, twice, … in a turn of the crank, with it or against it",
            absent="none",
        ),
        "moment_reference": Key(
            Physical("length"),
            "Place along the shaft about which free moments are taken",
            "z_0",
            absent="the middle of the outer cylinders",
        ),
        "locomotive": Key(
            Record(Locomotive),
            "Driven wheels, for hammer blow and swaying couple",
            absent="no locomotive",
        ),
        "shaft": Key(
            Listing(OneOf(Choice(("ground", "flywheel")), Record(ShaftPart))),
            "Shaft line for torsional vibration, read along the shaft: masses, pieces between them, one pair of gears, "
            "and the words `flywheel`, that of the machine, and `ground`, a fixed end",
            absent="no torsional vibration",
            also=("shaft_line", "torsion"),
        ),
        "limits": Key(
            Limits(),
            "Bounds for key values, checked by `kurbel check`: of each cylinder that has one, else of the machine; "
            "`machine.T_max` of the whole machine, `NAME.T_max` of one cylinder",
            absent="none",
        ),
        "expect": Key(
            Expectations(),
            "Figures that key values are to meet, compared by `kurbel check`, with the names of `limits`",
            absent="none",
        ),
        "uncertainty": Key(
            Uncertainties(),
            "Standard uncertainties of values of this file, by dotted key: forces, flywheel and stress tell what they "
            "make of the key values",
            absent="none told",
        ),
    }

    @classmethod
    def of_keys(
        cls,
        cylinder: Cylinder | None = None,
        cylinders: tuple[Cylinder, ...] | EqualCylinders = (),
        firing_order: tuple[int, ...] | None = None,
        load: Load | str | None = None,
        kurbel: int = FORMAT,
        brake_torque: float | None = None,
        shaft: tuple[ShaftPart | str, ...] | None = None,
        **keys: Any,
    ) -> Machine:
        """Return the machine that these keys of a machine file describe; raises RuleError."""
        if brake_torque is not None:
            keys["brake_power"] = 2 * math.pi * keys["speed"] * brake_torque
        given = (cylinder,) if cylinder else cylinders
        faults = _shaft_faults(shaft, given) if shaft else []
        try:
            if firing_order or not isinstance(given, tuple) or len(given) > 1:
                given = in_order(given, firing_order, keys.get("cycle", "two-stroke"))
            if shaft and not faults:
                keys["shaft"] = line_of(shaft, _names(given))
            elif not given:
                refuse(*faults)
            if len(given) == 1 and given[0].crank_position is None:
                given = (replace(given[0], crank_position=0.0),)
            named = tuple(one if one.name else replace(one, name=name) for one, name in zip(given, _names(given)))
            machine = cls(named, load=None if isinstance(load, str) else load, **keys)
        except RuleError as error:
            raise RuleError(*dict.fromkeys((*error.faults, *faults))) from None
        refuse(*faults)
        return machine

    @staticmethod
    def faults_of_keys(values: Mapping[str, Any]) -> list[Fault]:
        """Return what is wrong with the shaft line, where other keys could not be read."""
        shaft, cylinders = values.get("shaft"), values.get("cylinders", (values.get("cylinder", REFUSED),))
        unknown = cylinders is REFUSED or (isinstance(cylinders, tuple) and REFUSED in cylinders)
        return [] if unknown or not isinstance(shaft, tuple) else _shaft_faults(shaft, cylinders)

    def __post_init__(self) -> None:
        refuse(*self._faults())

    def _faults(self) -> list[Fault]:
        faults = []
        if not self.cylinders and self.effort is None and self.shaft is None:
            message = "the machine has no cylinder: give 'crank' and 'rod', or 'cylinders'"
            faults.append(Fault((), f"{message}, or 'effort', a turning-moment diagram known from elsewhere"))
        if self.cylinders and self.effort is not None:
            faults.append(Fault(("effort",), "'effort' stands instead of cylinders; leave one of them out"))
        names = [cylinder.name for cylinder in self.cylinders]
        for index, name in enumerate(names):
            if name in names[:index]:
                faults.append(Fault(("cylinders", index, "name"), f"two cylinders are called '{name}'"))
            if name == MACHINE:
                message = f"'{MACHINE}' stands for the whole machine in 'limits' and 'expect'; give another name"
                faults.append(Fault(("cylinders", index, "name"), message))
        scopes = tuple(dict.fromkeys((MACHINE, *names)))
        for key, id, figure in (*(("limits", *one) for one in self.limits), *(("expect", *one) for one in self.expect)):
            if (scope := scoped(id)[0]) and scope not in scopes:
                hint = did_you_mean(scope, scopes) or f"; there are {', '.join(scopes)}"
                written = getattr(figure, "name", "") or id
                faults.append(Fault((key, written), f"no cylinder is called '{shown(scope)}'{hint}", at_key=True))
        faults += [fault for index in range(len(self.cylinders)) for fault in self._cycle_faults(index)]
        for index, cylinder in enumerate(self.cylinders):
            rubbing = cylinder.friction.faults_beside(self.crankshaft) if cylinder.friction else ()
            faults += [fault.below(("cylinders", index, "friction")) for fault in rubbing]
        faults += crowded(self.cylinders)
        for key, diagram in (("effort", self.effort), ("load", self.load)):
            if diagram is not None and (message := diagram.cycle_fault(self._common_cycle)):
                faults.append(Fault((key, getattr(diagram, "key", "points")), message))
        return [*faults, *self._shaft_faults()]

    def _shaft_faults(self) -> Iterator[Fault]:
        if self.shaft is None:
            return
        if self.coupling is not None:
            message = "'coupling' is a shaft line of two masses, and 'shaft' another one; leave one of them out"
            yield Fault(("coupling",), message)
        if any(mass.flywheel for mass in self.shaft.masses) and not (self.flywheel and self.flywheel.inertia):
            yield Fault(("shaft",), "the shaft line has a 'flywheel'; give the machine one with its 'inertia'")

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
        """The files that the traces of the machine, or its effort, were read from."""
        pistons = [piston for cylinder in self.cylinders for piston in cylinder.pistons]
        measured = (*(chamber for piston in pistons for chamber in piston.chambers.values()), self.effort)
        return tuple(dict.fromkeys(file for one in measured for file in getattr(one, "files", ())))

    def lean_of(self, cylinder: Cylinder) -> float | None:
        """Return the inclination in degrees as the throw sees it: a machine that turns under is mirrored, 180° − i."""
        inclination = cylinder.inclination
        return inclination if inclination is None or self.rotation != "under" else 180.0 - inclination

    @property
    def strength_obstacle(self) -> str:
        """Why the strength of the crankshaft cannot be examined, or an empty text."""
        if self.crankshaft is None:
            return (
                "no 'crankshaft' is given; its strength needs the lengths of the throw: 'crankshaft: {a: …, b: …, …}'"
            )
        if len(self.cylinders) != 1:
            return (
                f"{len(self.cylinders)} cylinders; the crankshaft that is examined has one throw, for one cylinder"
                if self.cylinders
                else "no cylinder loads the crankshaft; 'effort' tells a torque and no force on the pin"
            )
        cylinder = self.cylinders[0]
        if cylinder.mechanism.quick_return or cylinder.mechanism.radial(CrankAngle.of(0.0)) is None:
            return f"the force on the crank pin of a {cylinder.mechanism.name} is not known; give a slider-crank"
        if not any(piston.indicator for piston in cylinder.pistons):
            return "no pressure loads the crankshaft; give 'bore' and 'indicator'"
        return ""
