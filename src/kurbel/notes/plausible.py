"""Figures of a machine file that no machine built has: one table, a row for each.

They are warnings, not errors: a wrong unit or a slipped decimal point is likely, but the file may be right.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, NamedTuple

from kurbel.declared.unit_systems import show
from kurbel.machine import Cylinder, Machine

if TYPE_CHECKING:
    from kurbel.machine.drawn_gas import Gas

_STEEL = 7850.0
"""kg/m³"""
_ASK = "is its unit right?"


class PlausibleFigure(NamedTuple):
    """A figure of a machine or cylinder, in SI; name: of the part that has it, '' where there is only one."""

    value: float
    name: str = ""


class Bounds(NamedTuple):
    """A row of the table: what the figure is, how it is found, and the range beyond which it is doubted.

    kind: of its quantity; figures: takes the machine, and a cylinder in the table of cylinders; sentence: after the
    figure, why it cannot be. A figure of 0 is not doubted: it is left out on purpose.
    """

    text: str
    kind: str
    figures: Callable[..., Iterator[PlausibleFigure]]
    least: float
    most: float
    sentence: str

    def warnings(self, *owners: Machine | Cylinder) -> Iterator[str]:
        """Yield a sentence for each figure beyond the range."""
        for figure in self.figures(*owners):
            if figure.value == 0 or self.least <= figure.value <= self.most:
                continue
            name = f"{figure.name}: " if figure.name else ""
            shown = show(figure.value, self.kind)
            yield f"{name}{self.text} of {shown} {self.sentence}; {_ASK}"


def _bores(machine: Machine, cylinder: Cylinder) -> Iterator[PlausibleFigure]:
    for piston in cylinder.pistons:
        yield PlausibleFigure(piston.bore, piston.name)


def _strokes(machine: Machine, cylinder: Cylinder) -> Iterator[PlausibleFigure]:
    if cylinder.pistons:
        yield PlausibleFigure(cylinder.mechanism.stroke)


def _moving_mass(machine: Machine, cylinder: Cylinder) -> Iterator[PlausibleFigure]:
    masses = cylinder.masses
    if masses:
        rod = masses.connecting_rod
        yield PlausibleFigure(masses.parts + (rod.mass if rod else 0.0))


def _mass_over_piston(machine: Machine, cylinder: Cylinder) -> Iterator[PlausibleFigure]:
    """Yield the reciprocating mass of a piston over that of a cube of steel as wide.

    Crossheads, and rods with several pistons, are far heavier than a small plunger: they are not compared.
    """
    masses = cylinder.masses
    if masses and masses.crosshead is None and len(cylinder.pistons) == 1:
        [piston] = cylinder.pistons
        yield PlausibleFigure(masses.parts / (_STEEL * piston.bore**3))


def _gyration_over_rod(machine: Machine, cylinder: Cylinder) -> Iterator[PlausibleFigure]:
    """Yield the radius of gyration of an exact rod over its length."""
    rod = cylinder.masses.connecting_rod if cylinder.masses else None
    length = cylinder.mechanism.rod_length if cylinder.mechanism.has_rod else math.inf
    if rod and rod.inertia is not None and rod.mass > 0:
        yield PlausibleFigure(math.sqrt(rod.inertia / rod.mass) / length)


def _mean_piston_speed(machine: Machine, cylinder: Cylinder) -> Iterator[PlausibleFigure]:
    if machine.speed is not None and cylinder.pistons:
        yield PlausibleFigure(2 * cylinder.mechanism.stroke * machine.speed)


def _clearances(machine: Machine, cylinder: Cylinder) -> Iterator[PlausibleFigure]:
    for piston in cylinder.pistons:
        for end, chamber in piston.chambers.items():
            clearance = vars(chamber).get("clearance")
            if clearance is not None:
                yield PlausibleFigure(clearance, f"{piston.name}, {end.replace('_', ' ')}")


def _temperature_of(gas: Gas | None, name: str = "") -> Iterator[PlausibleFigure]:
    if gas:
        yield PlausibleFigure(gas.inlet_temperature, name)


def _molar_mass_of(gas: Gas | None, name: str = "") -> Iterator[PlausibleFigure]:
    if gas and gas.mass_of_mole is not None:
        yield PlausibleFigure(gas.mass_of_mole, name)


def _temperatures(machine: Machine, cylinder: Cylinder) -> Iterator[PlausibleFigure]:
    for piston in cylinder.pistons:
        yield from _temperature_of(piston.gas, piston.name)


def _molar_masses(machine: Machine, cylinder: Cylinder) -> Iterator[PlausibleFigure]:
    for piston in cylinder.pistons:
        yield from _molar_mass_of(piston.gas, piston.name)


# compressors of boil-off gas draw in at 110 K; hydrogen has 2 g/mol, heavy refrigerants 0.2 kg/mol
_COLDEST, _HOTTEST = 70.0, 1000.0
_LIGHTEST, _HEAVIEST = 1.9e-3, 0.4
_NO_GAS = "is none that is compressed"
_NO_MOLECULE = "is that of no gas"

OF_CYLINDERS = (
    # the widest cylinder built, of the Cruquius engine of 1849, has 3.66 m
    Bounds("a bore", "length", _bores, 0.0, 5.0, "is beyond anything built"),
    # the longest, of pumping engines and pumping units, have some 3.7 and 9 m
    Bounds("a stroke", "length", _strokes, 0.0, 20.0, "is beyond anything built"),
    # reciprocating masses of the largest marine diesels weigh some 2e4 kg
    Bounds("a mass", "mass", _moving_mass, 0.0, 1e5, "in moving parts is beyond anything built"),
    Bounds(
        "a reciprocating mass",
        "ratio",
        _mass_over_piston,
        0.0,
        150.0,
        "times a cube of steel as wide as the piston is too heavy for it",
    ),
    Bounds(
        "a radius of gyration √(I/m)",
        "ratio",
        _gyration_over_rod,
        0.0,
        1.0,
        "times the length of the connecting rod is more than the rod can have",
    ),
    # racing engines have 27 m/s
    Bounds(
        "a mean piston speed", "velocity", _mean_piston_speed, 0.0, 45.0, "is beyond anything built"
    ),
    Bounds(
        "a clearance",
        "ratio",
        _clearances,
        0.0,
        3.0,
        "times the stroke volume leaves no compression",
    ),
    Bounds("a gas temperature", "temperature", _temperatures, _COLDEST, _HOTTEST, _NO_GAS),
    Bounds("a molar mass", "molar_mass", _molar_masses, _LIGHTEST, _HEAVIEST, _NO_MOLECULE),
)
"""Figures of one cylinder."""


def _speed(machine: Machine) -> Iterator[PlausibleFigure]:
    if machine.speed is not None:
        yield PlausibleFigure(machine.speed)


def _efficiency(machine: Machine) -> Iterator[PlausibleFigure]:
    yield PlausibleFigure(machine.efficiency)


def _ambient(machine: Machine) -> Iterator[PlausibleFigure]:
    yield PlausibleFigure(machine.ambient)


OF_MACHINES = (
    # model racing engines stay below 700 rps
    Bounds("a speed", "speed", _speed, 0.0, 1000.0, "is beyond anything built"),
    Bounds("an efficiency", "ratio", _efficiency, 0.2, 1.0, "is that of no machine that runs"),
    # the highest places where engines run have 0.5 bar, caissons some 4 bar
    Bounds(
        "an ambient pressure", "pressure", _ambient, 0.2e5, 10e5, "is none in which engines run"
    ),
    Bounds(
        "a gas temperature",
        "temperature",
        lambda machine: _temperature_of(machine.gas),
        _COLDEST,
        _HOTTEST,
        _NO_GAS,
    ),
    Bounds(
        "a molar mass",
        "molar_mass",
        lambda machine: _molar_mass_of(machine.gas),
        _LIGHTEST,
        _HEAVIEST,
        _NO_MOLECULE,
    ),
)
"""Figures of the whole machine."""


def doubts_of(machine: Machine) -> Iterator[str]:
    """Yield warnings on all figures of a machine that none built has."""
    yield from machine_doubts(machine)
    for cylinder in machine.cylinders:
        yield from cylinder_doubts(machine, cylinder)


def cylinder_doubts(machine: Machine, cylinder: Cylinder) -> Iterator[str]:
    """Yield warnings on figures of a cylinder that no machine built has."""
    for bounds in OF_CYLINDERS:
        yield from bounds.warnings(machine, cylinder)


def machine_doubts(machine: Machine) -> Iterator[str]:
    """Yield warnings on figures of the whole machine that none built has."""
    for bounds in OF_MACHINES:
        yield from bounds.warnings(machine)
