"""The report of `kurbel bearings`: the load on every pin and main bearing, each a part of its own."""

from collections.abc import Iterable
from functools import partial

from kurbel.declared.unit_systems import show
from kurbel.report.frame import Frame, Subject
from kurbel.report.notes import of_machine
from kurbel.report.tables import LeftOut, Report
from kurbel.report.warnings import as_far_as_solved
from kurbel.solver.bearings import Bearing, ShaftBearings
from kurbel.solver.case import Case


def bearings_report(case: Case, frame: Frame) -> Report:
    """Return the loads on pins and main bearings over the angle of crank 1.

    Raises UsageError where nothing loads them.
    """
    whole = Subject(
        "whole machine",
        (),
        left_out=lambda: _machine_left_out(case.bearings),
        warnings=lambda: (*of_machine(case), *as_far_as_solved(bearing_warnings(case), "bearings")),
    )
    report = frame.report(case.machine, "Lagerkräfte", subjects(case), whole, _notes(case.bearings))
    return report._replace(group="bearings")


def subjects(case: Case) -> Iterable[Subject]:
    """Yield every pin and main bearing."""
    for forces in case.cylinders:
        forces.refuse_locking()
    for part in case.bearings.parts:
        of = part.followed[0].cylinder.name if part.of_rod else ""
        yield Subject(part.name, (part,), part.at, left_out=partial(_left_out, part), of=of)


_FRAMES = (
    "Loads are those of a rod on its pin and of the shaft on its bearings. Directions count in the sense of rotation: "
    "ε_K from the throw outward (of a main bearing from that of crank 1), ε_M from the stroke line of cylinder 1 "
    "outward, ε_S from the rod's line, crank pin to crosshead. A surface counts as loaded 60° to either side of where "
    "it is pressed; crank pins and journals turn with the throw, crosshead pins and main shells stand in the engine."
)


def _notes(bearings: ShaftBearings) -> Iterable[str]:
    machine, line = bearings.machine, bearings.line
    yield _FRAMES
    if len(machine.cylinders) > 1:
        yield "φ is the angle of crank 1."
    if line and len(line.throws) > 1:
        yield (
            "Statically determinate, throw by throw: the shaft counts as hinged in every bearing between two throws, "
            "and 'crankshaft' as the throw of every cylinder."
        )
    if line and any(len(throw.cylinders) > 1 for throw in line.throws):
        yield "Rods on one pin stand side by side, each on an equal part of its length; all load the pin in its middle."
    if any(one.masses and one.masses.undivided for one in machine.cylinders):
        yield "'reciprocating' is one sum, all of which counts as pushing on the crosshead pin."


def _left_out(part: Bearing) -> Iterable[LeftOut]:
    diameter, length = part.size
    if not diameter or not length:
        lacks = " and ".join(name for name, size in (("diameter", diameter), ("length", length)) if not size)
        yield LeftOut("pressure, p v", f"no {lacks} given")
    if part.omega is None:
        yield LeftOut("rubbing speed", "no speed given")


def _machine_left_out(bearings: ShaftBearings) -> Iterable[LeftOut]:
    machine, shaft = bearings.machine, bearings.machine.crankshaft
    if bearings.obstacle:
        yield LeftOut("main bearings", bearings.obstacle)
    if shaft and shaft.flywheel_mass and machine.cylinders[0].inclination is None:
        yield LeftOut("flywheel weight", "no inclination given")
    if machine.speed is None:
        yield LeftOut("inertia", "no speed given")


_ROUNDED = 0.05
"""By which distances of throws may contradict their crankshaft, over what they should be."""


def bearing_warnings(case: Case) -> Iterable[str]:
    """Yield that the throws do not stand as far apart as their bearings put them."""
    shaft, cylinders = case.machine.crankshaft, case.machine.cylinders
    if shaft is None or shaft.overhung or any(one.axial_position is None for one in cylinders):
        return
    line = case.bearings.line
    if line is None:
        return
    apart = shaft.a + shaft.b
    for one, following in zip(line.throws, line.throws[1:]):
        given = following.place - one.place
        if abs(given - apart) > _ROUNDED * apart:
            yield (
                f"throws {show(given, 'length')} apart along the shaft do not fit bearings between them, by which they "
                f"are a + b = {show(apart, 'length')} apart; the loads are those of a and b"
            )
            return
