"""The report of `kurbel check`: what a machine has, what is left out, and how its limits stand."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import NamedTuple

from kurbel.declared.forms import Physical
from kurbel.declared.quantity import NOISE_POWER, Quantity, by_id
from kurbel.declared.unit_systems import SI, show
from kurbel.errors import KurbelError, NoSolutionError, UsageError
from kurbel.machine import Cylinder, Machine
from kurbel.machine.cylinder import may_lock
from kurbel.mechanisms import Mechanism, every_quantity
from kurbel.report.left_out import left_out, stages, strength_left_out, turning_stages
from kurbel.report.notes import Note, machine_notes, of_cylinder


class Entry(NamedTuple):
    """One line of a section: what, and what is to be said of it; `bad` marks a limit that is broken."""

    what: str
    text: str
    bad: bool = False


class Section(NamedTuple):
    """A head line with its entries."""

    title: str
    entries: tuple[Entry, ...]


class Checked(NamedTuple):
    """The outcome of a check; `broken` says that a limit is, `errors` which ones cannot be judged, and why."""

    title: str
    sections: tuple[Section, ...]
    broken: bool
    errors: tuple[KurbelError, ...]


def checked(machine: Machine) -> Checked:
    """Return what is to be said of a machine; key values are computed only where it has limits."""
    judged = tuple(_limits(machine))
    limits = tuple(one for one in judged if isinstance(one, Entry))
    found = machine_notes(machine)
    sections = (
        Section("Machine", tuple(_machine_entries(machine))),
        *(_cylinder_section(machine, cylinder, found) for cylinder in machine.cylinders),
        Section("Whole machine", tuple(_turning_entries(machine))),
        Section("Crankshaft", tuple(_crankshaft_entries(machine))),
        Section("Limits", limits),
    )
    broken = any(entry.bad for entry in limits)
    errors = tuple(one for one in judged if isinstance(one, KurbelError))
    return Checked(f"{machine.name}: a valid machine", tuple(s for s in sections if s.entries), broken, errors)


def _machine_entries(machine: Machine) -> Iterable[Entry]:
    yield Entry("cylinders", str(len(machine.cylinders)) if machine.cylinders else "none, a given turning effort")
    yield Entry("cycle", f"{machine.cycle}, {360 * machine.revolutions} deg")
    yield Entry("speed", "not given" if machine.speed is None else show(machine.speed, "speed"))


def _cylinder_section(machine: Machine, cylinder: Cylinder, found: Sequence[Note]) -> Section:
    entries = [
        Entry("mechanism", _described(cylinder.mechanism)),
        *(Entry(f"{piston.name}", f"bore {show(piston.bore, 'length')}") for piston in cylinder.pistons),
        Entry("computed", ", ".join(what for what, why in stages(machine, cylinder).items() if not why)),
        *(Entry("left out", f"{what}: {why}") for what, why in left_out(machine, cylinder)),
        *(Entry("note", note) for note in (*of_cylinder(found, machine, cylinder), *cylinder.mechanism.notes)),
        *(Entry("note", note) for note in _of_locking(machine, cylinder)),
    ]
    return Section(cylinder.name, tuple(entries))


def _of_locking(machine: Machine, cylinder: Cylinder) -> Iterable[str]:
    """Yield where a crosshead locks itself; nothing is computed unless it may."""
    if not may_lock(cylinder):
        return
    from kurbel.solver.case import Case

    forces = Case(machine).cylinders[machine.cylinders.index(cylinder)]
    try:
        forces.extremes_of("N")
    except NoSolutionError as error:
        yield f"{error}. kurbel forces ends with status {error.exit_status}"


def _turning_entries(machine: Machine) -> Iterable[Entry]:
    """Yield what kurbel flywheel has to say of a machine, where that is more than its only cylinder has."""
    given = (machine.flywheel, machine.load, machine.effort, machine.coupling)
    if len(machine.cylinders) == 1 and machine.efficiency == 1 and not any(given):
        return
    stages = turning_stages(machine)
    yield Entry("computed", ", ".join(what for what, why in stages.items() if not why))
    for what, why in stages.items():
        if why:
            yield Entry("left out", f"{what}: {why}")
    yield Entry("load", _load(machine))


def _load(machine: Machine) -> str:
    load = machine.load
    if load is None:
        return "constant"
    if load.diagram:
        return f"a diagram of {len(load.diagram.angles)} points"
    return f"slip {load.slip:g}" if load.slip is not None else f"torque as the speed to the power {load.power:g}"


def _crankshaft_entries(machine: Machine) -> Iterable[Entry]:
    if machine.crankshaft is None:
        return
    if obstacle := machine.strength_obstacle:
        yield Entry("left out", f"strength: {obstacle}")
        return
    yield Entry("computed", "forces on the bearings, stresses in pin and webs")
    for what, why in strength_left_out(machine):
        yield Entry("left out", f"{what}: {why}")


def _described(mechanism: Mechanism) -> str:
    """Return the kind of a mechanism and its lengths."""
    lengths = [
        f"{name} {'infinite' if math.isinf(size) else show(size, key.form.kind)}"
        for name, key in mechanism.KEYS.items()
        if isinstance(key.form, Physical) and isinstance(size := getattr(mechanism, name, None), float) and size
    ]
    return f"{mechanism.name}: {', '.join(lengths)}"


def _limits(machine: Machine) -> Iterable[Entry | KurbelError]:
    """Yield how each limit stands, or why that cannot be told."""
    if not machine.limits:
        return
    from kurbel.report.limits import limited_values

    values = limited_values(machine, (name for name, _ in machine.limits))
    declared = by_id(every_quantity().all_key_values)
    for name, bound in machine.limits:
        found, quantity = values[name], declared[name]
        if isinstance(found, KurbelError):
            yield type(found)(f"limits.{name}: {found}")
        elif not found:
            yield UsageError(
                f"limits.{name}: this machine has no {name}: {quantity.text[:1].lower()}{quantity.text[1:]}"
            )
        else:
            yield from (_compared(quantity, bound, where, value) for where, value in found)


_ROUNDING = 1e-9
"""A bound is no more exact than what is printed of it: a stroke of 110 mm does not break a limit of 110 mm."""


def _compared(quantity: Quantity, bound: float, where: str, value: float) -> Entry | KurbelError:
    """Compare a value with its bound: a `_min` may not fall below it, everything else may not exceed it.

    Of a residual the magnitude counts. What is not finite cannot be compared.
    """
    name, kind = quantity.id, quantity.kind
    if not math.isfinite(value):
        from kurbel.report.shown import too_large

        return UsageError(f"limits.{name} ({where}): {too_large(quantity)}")
    lower, bars = name.endswith("_min"), "|" if name.endswith("_residual") else ""
    excess = bound - value if lower else (abs(value) if bars else value) - bound
    broken = excess > _ROUNDING * abs(bound)
    relation = ("<" if broken else "≥") if lower else (">" if broken else "≤")
    size = f"< 1e{NOISE_POWER}" if quantity.is_noise(value) else f"{bars}{_shown(value, kind)}{bars}"
    text = f"{size} {relation} {_shown(bound, kind)}"
    return Entry(name, f"{text}  {'BROKEN' if broken else 'kept'}  ({where})", broken)


def _shown(value: float, kind: str) -> str:
    return f"{value:.9g} {SI[kind]}".rstrip()
