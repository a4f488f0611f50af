"""The machine: one immutable description in SI, complete when it is made, from a file or in Python.

Records check their own rules and raise RuleError. They hold numbers only; what the numbers lead to is in
`kurbel.solver`.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import numpy as np

from kurbel.crank_angle import CYCLES, CrankAngle
from kurbel.declared.forms.figures import (
    EXPECTATIONS,
    LIMITS,
    MACHINE,
    SETTINGS,
    UNCERTAINTIES,
    Bound,
    Expected,
    scoped,
)
from kurbel.declared.forms.structures import Inline, Listing, OneOf, RecordForm
from kurbel.declared.forms.values import FIRING_ORDER, Choice
from kurbel.declared.reading import REFUSED, text_in_one_line
from kurbel.declared.record import Record, Rule, ValuesByKey, alternative, field
from kurbel.declared.units import MOST_SHAFT_ITEMS
from kurbel.errors import Fault, RuleError, refuse
from kurbel.machine.cylinder import MOST_TURNS, Cylinder, counterweights, crowded, names_of
from kurbel.machine.indicator import Chamber
from kurbel.machine.origin import Origin
from kurbel.near_words import did_you_mean

if TYPE_CHECKING:
    from kurbel.machine.crankshaft import (
        BalanceShaft,
        Counterweight,
        Crankshaft,
        Locomotive,
        SharedCounterweights,
    )
    from kurbel.machine.drawn_gas import Gas
    from kurbel.machine.known_effort import KnownEffort
    from kurbel.machine.oil_film import OilFilms
    from kurbel.machine.pumped import Pump
    from kurbel.machine.several import EqualCylinders
    from kurbel.machine.shaft_line import ShaftLine, ShaftPart
    from kurbel.machine.shaft_side import Coupling, Flywheel, KnownDiagram, Load

__all__ = ["CYCLES", "Cylinder", "Machine"]

FORMAT = 1
"""Number of the machine-file format that this version reads."""
STANDARD_ATMOSPHERE = 101325.0


def _names(cylinders: tuple[Cylinder, ...] | EqualCylinders) -> list[str]:
    """Return the names of cylinders, listed or equal ones."""
    if isinstance(cylinders, (tuple, list)):
        return names_of(cylinders)
    return names_of(cylinders.cylinders)


def _with_position(cylinder: Cylinder) -> Cylinder:
    """Return the only cylinder, at φ = 0 if no crank position is given."""
    if cylinder.crank_position is not None:
        return cylinder
    return replace(cylinder, crank_position=0.0)


def _flywheel() -> type[Flywheel]:
    from kurbel.machine.shaft_side import Flywheel

    return Flywheel


def _load() -> type[Load]:
    from kurbel.machine.shaft_side import Load

    return Load


def _known_effort() -> type[KnownEffort]:
    from kurbel.machine.known_effort import KnownEffort

    return KnownEffort


def _coupling() -> type[Coupling]:
    from kurbel.machine.shaft_side import Coupling

    return Coupling


def _crankshaft() -> type[Crankshaft]:
    from kurbel.machine.crankshaft import Crankshaft

    return Crankshaft


def _balance_shaft() -> type[BalanceShaft]:
    from kurbel.machine.crankshaft import BalanceShaft

    return BalanceShaft


def _locomotive() -> type[Locomotive]:
    from kurbel.machine.crankshaft import Locomotive

    return Locomotive


def _shaft_part() -> type[ShaftPart]:
    from kurbel.machine.shaft_line import ShaftPart

    return ShaftPart


def _gas() -> type[Gas]:
    from kurbel.machine.drawn_gas import Gas

    return Gas


def _pump() -> type[Pump]:
    from kurbel.machine.pumped import Pump

    return Pump


def _oil_films() -> type[OilFilms]:
    from kurbel.machine.oil_film import OilFilms

    return OilFilms


def _equal_cylinders() -> type[EqualCylinders]:
    from kurbel.machine.several import EqualCylinders

    return EqualCylinders


def _throw_of_first(cylinders: tuple[Cylinder, ...]) -> Iterator[Rule]:
    """Yield the rule that the throws count from that of cylinder 1."""
    if not cylinders or cylinders[0].throw_angle is None:
        return
    message = "the throws count from that of cylinder 1; give 0 deg, or leave it out"
    is_turned = np.not_equal(cylinders[0].throw_angle % 360.0, 0.0)
    yield Rule(("cylinders", 0, "throw_angle"), is_turned, message)


class LoadCase(Record):
    """A load case: values by dotted key that replace those of the file."""

    name: str = field(str, "Name of the case, for `--case`", example="full load")
    values: tuple[tuple[str, object], ...] = field(
        SETTINGS,
        "Values instead of those of the file, by dotted key",
        example="{speed: 40 rpm}",
        key="set",
    )


class Machine(Record):
    """A whole machine.

    speed: revolutions per second, None where it is not given; ambient: absolute pressure in Pa; efficiency η of the
    driving side, by which the turning effort is divided where no piston drives; limits: key-value id -> bound in SI;
    expect: key-value id -> the smallest and the largest permissible value in SI; in both, an id may have the prefix
    `machine.` or the name of a cylinder; uncertainty: dotted key -> its standard uncertainty as a text.
    """

    _kurbel = alternative(int, "Version of the file format", least=FORMAT, most=FORMAT, absent="1")
    cylinders: tuple[Cylinder, ...]
    name: str = field(str, "Name of the machine", default="machine", absent="the file name")
    speed: float | None = field(
        "speed",
        "Speed of rotation",
        "n",
        least=0,
        also=("rpm", "upm", "drehzahl", "rotational_speed", "engine_speed"),
        absent="no velocities, accelerations or inertia in physical units",
    )
    cycle: str = field(
        tuple(CYCLES), "Working cycle: 360° or 720°", default="two-stroke", absent="two-stroke"
    )
    efficiency: float = field(
        "ratio",
        "Mechanical efficiency: multiplies the torque of driving cylinders, or only the gas force of the driving "
        "pistons if others on the rod are driven (R p. 611–613); divides the whole torque if no piston drives",
        "η",
        default=1.0,
        above=0,
        most=1,
        example="0.88",
        usual="0.85 to 0.92 for ordinary piston machines (R p. 611)",
    )
    ambient: float = field(
        "pressure",
        "Absolute ambient pressure",
        default=STANDARD_ATMOSPHERE,
        least=0,
        absent="1.01325 bar",
    )
    brake_power: float | None = field(
        "power",
        "Brake power, measured at the shaft; a warning is given if the indicated power is less",
        "N_e",
        least=0,
        absent="not compared",
    )
    _brake_torque = alternative(
        "torque",
        "Brake torque, instead of `brake_power`",
        "M_e",
        least=0,
        instead="brake_power",
        needs="speed",
        gives=lambda values: {
            "brake_power": 2 * math.pi * values["speed"] * values["brake_torque"]
        },
    )
    _cylinder = alternative(Inline(Cylinder, unless="cylinders"), "The keys of the only cylinder")
    _cylinders = alternative(
        OneOf(
            Listing(RecordForm(Cylinder, inline_too=True), called="cylinder"),
            RecordForm(_equal_cylinders),
        ),
        "Several cylinders as a list, or equal ones as one mapping; their keys are then not allowed at the top level",
        absent="one cylinder, flat",
        gives=lambda values: {"cylinders": values["cylinders"]},
    )
    _firing_order = alternative(
        FIRING_ORDER,
        "Order in which the cylinders fire, at equal intervals over the cycle; sets `crank_position`",
        absent="positions as given",
        also=("firing", "ignition_order", "zuendfolge"),
    )
    flywheel: Flywheel | None = field(_flywheel, "Flywheel", absent="no speed line")
    load: Load | None = field(
        OneOf(Choice(("constant",)), RecordForm(_load)),
        "Resistance at the shaft",
        absent="constant",
        gives=lambda values: {"load": None if values["load"] == "constant" else values["load"]},
    )
    effort: KnownDiagram | None = field(
        RecordForm(_known_effort),
        "A given turning-moment diagram, instead of cylinders",
        absent="from the cylinders",
    )
    coupling: Coupling | None = field(
        _coupling, "Elastic coupling to a driven moment of inertia", absent="rigid"
    )
    crankshaft: Crankshaft | None = field(
        _crankshaft,
        "The throw between bearings A and B, the same for all cylinders",
        absent="no strength check",
    )
    counterweights: SharedCounterweights | tuple[Counterweight, ...] = counterweights()
    balance_shafts: tuple[BalanceShaft, ...] = field(
        [RecordForm(_balance_shaft)],
        "Balance shafts, turning once, twice, … per turn of the crank, with or against it",
        default=(),
    )
    moment_reference: float | None = field(
        "length",
        "Position along the shaft about which unbalanced moments are taken",
        "z_0",
        absent="the middle of the outer cylinders",
    )
    locomotive: Locomotive | None = field(
        _locomotive, "Driven wheels, for hammer blow and swaying couple", absent="no locomotive"
    )
    shaft: ShaftLine | None = field(
        Listing(
            OneOf(Choice(("ground", "flywheel")), RecordForm(_shaft_part)), most=MOST_SHAFT_ITEMS
        ),
        "Shaft line for torsional vibration, in order along the shaft: masses, shaft segments between them, gears, "
        "branches, `flywheel` (that of the machine) and `ground` (a fixed end)",
        absent="no torsional vibration",
        also=("shaft_line", "torsion"),
    )
    limits: tuple[tuple[str, float], ...] = field(
        LIMITS,
        "Limits of key values, checked by `kurbel check` for each cylinder that has the value, else for the machine; "
        "`machine.T_max` is of the whole machine, `NAME.T_max` of one cylinder",
        default=(),
    )
    expect: tuple[tuple[str, Expected], ...] = field(
        EXPECTATIONS,
        "Expected key values, compared by `kurbel check`; names as in `limits`",
        default=(),
    )
    uncertainty: tuple[tuple[str, str], ...] = field(
        UNCERTAINTIES,
        "Standard uncertainties of values of this file, by dotted key; forces, flywheel and stress propagate them to "
        "the key values",
        default=(),
    )
    rotation: str | None = field(
        ("over", "under"),
        "Sense of rotation of a horizontal machine: over (the crank pin rises from the inner dead centre, so that an "
        "engine presses its crosshead down) or under (R p. 602)",
        absent="over, with no remark on the guide",
        also=("direction", "sense"),
    )
    gas: Gas | None = field(_gas, "The gas that a compressor draws in", absent="volumes only")
    pump: Pump | None = field(
        _pump,
        "Slip, liquid, pipes and vessels of a pump; its driven pistons are then those of pumps",
        absent="no pipes",
    )
    oil_film: OilFilms | None = field(
        _oil_films,
        "Oil between pins and shells, for the thickness of its film",
        absent="no film",
        also=("oil", "lubrication", "oil_films"),
    )
    origin: Origin | None = None
    cases: tuple[LoadCase, ...] = field(
        [LoadCase],
        "Load cases: `--case NAME` computes one, `kurbel check` checks the limits in all, `kurbel sweep --cases` "
        "prints one row for each",
        default=(),
        absent="one case, the file as it is",
    )
    cycle_turns: int = field(
        int,
        "Turns of the shaft after which everything repeats, as of a press that works once in several",
        default=1,
        least=1,
        most=MOST_TURNS,
        absent="those of the working cycle",
    )

    @classmethod
    def of_keys(
        cls,
        cylinder: Cylinder | None = None,
        cylinders: tuple[Cylinder, ...] | EqualCylinders = (),
        firing_order: tuple[int, ...] | None = None,
        shaft: tuple[ShaftPart | str, ...] | None = None,
        **keys: Any,
    ) -> Machine:
        """Return the machine that these keys of a machine file describe; raises RuleError."""
        items = (cylinder,) if cylinder else cylinders
        # faults of the shaft line are reported with those of the cylinders
        faults: list[Fault] = []
        if shaft:
            from kurbel.machine.shaft_line import ShaftLine, line_of, shaft_faults

            faults = shaft_faults(shaft, _names(items))
        try:
            # each cylinder at its crank angle
            if cylinder and not firing_order:
                items = (_with_position(cylinder),)
            elif cylinders or firing_order:
                from kurbel.machine.several import in_order

                items = in_order(items, firing_order, keys.get("cycle", "two-stroke"))
            else:
                items = ()
            names = _names(items)
            if shaft:
                keys["shaft"] = ShaftLine((), ()) if faults else line_of(shaft, names)
            named = tuple(replace(item, name=name) for item, name in zip(items, names))
            machine: Machine = super().of_keys(cylinders=named, **keys)
        except RuleError as error:
            raise RuleError(*error.faults, *faults) from None
        refuse(*faults)
        if machine.effort is None:
            return machine
        # the cycles of a recording
        effort = machine.effort.of_cycle(machine.revolutions)
        return machine if effort is machine.effort else replace(machine, effort=effort)

    @classmethod
    def faults_of_some(cls, values: ValuesByKey) -> list[Fault]:
        """Return what is wrong with the keys; also with the shaft line if other keys could not be read."""
        faults = super().faults_of_some(values)
        shaft = values.get("shaft")
        only_cylinder = (values.get("cylinder", REFUSED),)
        cylinders = values.get("cylinders", only_cylinder)
        has_refused = isinstance(cylinders, tuple) and REFUSED in cylinders
        if not isinstance(shaft, tuple) or cylinders is REFUSED or has_refused:
            return faults
        from kurbel.machine.shaft_line import shaft_faults

        return faults + shaft_faults(shaft, _names(cylinders))

    def rules(self) -> Iterator[Rule]:
        """Yield the rules on the machine as a whole."""
        is_empty = not self.cylinders and self.effort is None and self.shaft is None
        none = "the machine has no cylinder: give 'crank' and 'rod', or 'cylinders'"
        yield Rule((), is_empty, f"{none}, or 'effort', a given turning-moment diagram")
        has_two_efforts = bool(self.cylinders) and self.effort is not None
        yield Rule("effort", has_two_efforts, "'effort' replaces cylinders; give only one of them")
        yield from self._name_rules()
        for index, cylinder in enumerate(self.cylinders):
            for rule in self._rules_of_cylinder(cylinder):
                yield rule.below("cylinders", index)
        if self.pump:
            pistons = [piston for cylinder in self.cylinders for piston in cylinder.pistons]
            yield from self.pump.rules_of(pistons)
        if self.oil_film:
            frictions = [cylinder.friction for cylinder in self.cylinders]
            for rule in self.oil_film.rules_beside(self.crankshaft, frictions):
                yield rule.below("oil_film")
        yield from _throw_of_first(self.cylinders)
        yield from crowded(self.cylinders)
        yield from self._shaft_rules()

    def _rules_of_cylinder(self, cylinder: Cylinder) -> Iterator[Rule]:
        """Yield the rules on a cylinder that need the cycle, the ambient or the crankshaft of the machine."""
        for number, piston in enumerate(cylinder.pistons):
            path = ("tandem", number - 1) if number else ()
            cycle = self.cycle_of_piston(cylinder, number)
            for rule in piston.indicator_rules(cycle, self.ambient):
                yield rule.below(*path)
        if cylinder.friction:
            rubbing_pin = cylinder.mechanism.rubbing_pin
            for rule in cylinder.friction.rules_beside(self.crankshaft, rubbing_pin):
                yield rule.below("friction")

    def _shaft_rules(self) -> Iterator[Rule]:
        """Yield the rules on what is on the shaft: effort, load, coupling, shaft line."""
        # diagrams cover the cycle
        diagrams = {"effort": self.effort, "load": self.load.diagram if self.load else None}
        for key, diagram in diagrams.items():
            if diagram:
                for rule in diagram.rules_of_cycle(self._common_cycle, self.revolutions):
                    yield rule.below(key)
        # an effort of which only the swing of energy is given
        has_coupling = self.coupling is not None
        if self.effort and self.effort.alone:
            message = (
                "needs the effort over the angle; of this one the swing of energy alone is given"
            )
            yield Rule("load", self.load is not None and self.load.varies, message)
            yield Rule("coupling", has_coupling, message)
        # the shaft line
        if self.shaft is not None:
            message = (
                "'coupling' is a shaft line of two masses, and 'shaft' another one; "
                "leave one of them out"
            )
            yield Rule("coupling", has_coupling, message)
            inertia = self.flywheel.inertia if self.flywheel else None
            has_inertia = inertia is not None and bool(np.all(inertia))
            has_flywheel = any(mass.flywheel for mass in self.shaft.masses)
            message = "the shaft line has a 'flywheel'; give the machine one with its 'inertia'"
            yield Rule("shaft", has_flywheel and not has_inertia, message)

    def _name_rules(self) -> Iterator[Rule]:
        """Yield the rules of the names of cylinders, and of those in limits and expectations."""
        names = [cylinder.name for cylinder in self.cylinders]
        for index, name in enumerate(names):
            path = ("cylinders", index, "name")
            yield Rule(path, name in names[:index], f"two cylinders are called '{name}'")
            message = (
                f"'{MACHINE}' means the whole machine in 'limits' and 'expect'; give another name"
            )
            yield Rule(path, name == MACHINE, message)
        case_names = [case.name for case in self.cases]
        for index, name in enumerate(case_names):
            path = ("cases", index, "name")
            yield Rule(path, name in case_names[:index], f"two cases are called '{name}'")
        # the prefixes of limits and expectations
        scopes = self._scopes()
        for key, figures in (("limits", self.limits), ("expect", self.expect)):
            for id, figure in figures:
                scope, _ = scoped(id)
                if not scope or scope in scopes:
                    continue
                hint = did_you_mean(scope, scopes) or f"; there are {', '.join(scopes)}"
                message = f"no cylinder is called '{text_in_one_line(scope)}'{hint}"
                written = figure.name if isinstance(figure, (Bound, Expected)) else ""
                yield Rule((key, written or id), True, message, at_key=True)

    def _scopes(self) -> tuple[str, ...]:
        """Return what limits and expectations may be for: the machine, its cylinders, pistons and throws."""
        scopes = [MACHINE]
        scopes += [cylinder.name for cylinder in self.cylinders]
        for cylinder in self.cylinders:
            scopes += self.piston_names(cylinder)
        if self.crankshaft is not None and len(self.cylinders) > 1:
            scopes += [f"throw {number}" for number in range(1, len(self.cylinders) + 1)]
        return tuple(dict.fromkeys(scopes))

    def cycle_of(self, cylinder: Cylinder) -> str:
        """Return the working cycle of a cylinder: its own, or that of the machine."""
        return cylinder.cycle or self.cycle

    def cycle_of_piston(self, cylinder: Cylinder, number: int) -> str:
        """Return the working cycle of a piston of a cylinder; number: 0 for its own, then the tandem ones."""
        cycle = self.cycle_of(cylinder)
        if not number:
            return cycle
        return cylinder.pistons[number].cycle_beside(cycle)

    def piston_names(self, cylinder: Cylinder) -> tuple[str, ...]:
        """Return the names of the pistons with an indicator, as in limits, if a rod has several: `pump`.

        With several cylinders the name of the cylinder comes first, `cylinder 1.pump`; equal names are numbered.
        """
        names = [piston.name for piston in cylinder.pistons if piston.indicator]
        if len(names) < 2:
            return ()
        prefix = f"{cylinder.name}." if len(self.cylinders) > 1 else ""
        numbered = []
        for index, name in enumerate(names):
            count = names[: index + 1].count(name)
            number = f" {count}" if count > 1 else ""
            numbered.append(f"{prefix}{name}{number}")
        return tuple(numbered)

    @property
    def _common_cycle(self) -> str:
        """The longest working cycle, after which everything repeats."""
        return max((self.cycle, *map(self.cycle_of, self.cylinders)), key=CYCLES.__getitem__)

    @property
    def revolutions(self) -> int:
        """Revolutions of the shaft until everything repeats: those of the longest cycle, and of `cycle_turns`."""
        return math.lcm(CYCLES[self._common_cycle], self.cycle_turns)

    @property
    def chambers(self) -> list[Chamber]:
        """What the indicators of all pistons show."""
        chambers: list[Chamber] = []
        for cylinder in self.cylinders:
            for piston in cylinder.pistons:
                chambers += piston.chambers.values()
        return chambers

    @property
    def trace_files(self) -> tuple[str, ...]:
        """The files that the traces of the machine, or its effort, were read from."""
        files: list[str] = []
        for chamber in self.chambers:
            files += chamber.files
        if self.effort:
            files += self.effort.files
        return tuple(dict.fromkeys(files))

    def inclination_of(self, cylinder: Cylinder) -> float | None:
        """Return the inclination in degrees as the throw sees it: a machine that turns under is mirrored, 180° − i."""
        inclination = cylinder.inclination
        if inclination is None or self.rotation != "under":
            return inclination
        return 180.0 - inclination

    @property
    def strength_obstacle(self) -> str:
        """Why the strength of the crankshaft cannot be examined, or an empty text."""
        if self.crankshaft is None:
            lengths = "its strength needs the lengths of the throw: 'crankshaft: {a: …, b: …, …}'"
            return f"no 'crankshaft' is given; {lengths}"
        if not self.cylinders:
            return (
                "no cylinder loads the crankshaft; 'effort' gives a torque and no force on the pin"
            )
        has_pressure = False
        for cylinder in self.cylinders:
            mechanism = cylinder.mechanism
            if mechanism.quick_return or mechanism.radial(CrankAngle.of(0.0)) is None:
                return (
                    f"the force on the crank pin of a {mechanism.name} is not known; "
                    "give a slider-crank"
                )
            if cylinder.link_rod is not None:
                return (
                    "the strength of a crank pin under link rods is not computed; "
                    "kurbel bearings prints its loads"
                )
            if any(piston.indicator for piston in cylinder.pistons):
                has_pressure = True
        if not has_pressure:
            return "no pressure loads the crankshaft; give 'bore' and 'indicator'"
        return ""
