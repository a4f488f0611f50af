"""The report of `kurbel check`: what a machine has, what is left out, what nothing uses, and how its limits stand."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import NamedTuple

from kurbel.errors import UsageError
from kurbel.keys import Key
from kurbel.machine import Cylinder, Machine
from kurbel.mechanisms import Mechanism
from kurbel.quantities import KEY_VALUES
from kurbel.report.left_out import left_out, stages, warnings
from kurbel.units import SI, show


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
    """The outcome of a check; `broken` says that a limit is."""

    title: str
    sections: tuple[Section, ...]
    broken: bool


def checked(machine: Machine, commands: Sequence[str]) -> Checked:
    """Return what is to be said of a machine; `commands` are those that exist.

    Key values are computed only where the machine has limits. Raises UsageError for a limit of something that the
    machine does not have.
    """
    limits = tuple(_limits(machine, commands))
    sections = (
        Section("Machine", tuple(_machine_entries(machine))),
        *(_cylinder_section(machine, cylinder) for cylinder in machine.cylinders),
        Section("Not used yet", tuple(_unused(machine, commands))),
        Section("Limits", limits),
    )
    broken = any(entry.bad for entry in limits)
    return Checked(f"{machine.name}: a valid machine", tuple(s for s in sections if s.entries), broken)


def _machine_entries(machine: Machine) -> Iterable[Entry]:
    yield Entry("cylinders", str(len(machine.cylinders)) if machine.cylinders else "none, a given turning effort")
    yield Entry("cycle", f"{machine.cycle}, {360 * machine.revolutions} deg")
    yield Entry("speed", "not given" if machine.speed is None else show(machine.speed, "speed"))


def _cylinder_section(machine: Machine, cylinder: Cylinder) -> Section:
    entries = [
        Entry("mechanism", _described(cylinder.mechanism)),
        *(Entry(f"{piston.name}", f"bore {show(piston.bore, 'length')}") for piston in cylinder.pistons),
        Entry("computed", ", ".join(what for what, why in stages(machine, cylinder).items() if not why)),
        *(Entry("left out", f"{what}: {why}") for what, why in left_out(machine, cylinder)),
        *(Entry("note", note) for note in warnings(cylinder)),
    ]
    return Section(cylinder.name, tuple(entries))


def _described(mechanism: Mechanism) -> str:
    """Return the kind of a mechanism and its lengths."""
    lengths = [
        f"{key} {'infinite' if math.isinf(length) else show(length, 'length')}"
        for key in mechanism.KEYS
        if isinstance(length := getattr(mechanism, key, None), float) and length
    ]
    return f"{mechanism.name}: {', '.join(lengths)}"


def _unused(machine: Machine, commands: Sequence[str]) -> Iterable[Entry]:
    """Yield the keys that are given, but belong to commands that do not exist."""
    for name, key in Machine.KEYS.items():
        if _pending(key, commands) and getattr(machine, name, None) not in (None, 1.0):
            yield Entry(
                name, f"read and checked; it is for kurbel {' and '.join(key.commands)}, which does not exist yet"
            )


def _pending(key: Key, commands: Sequence[str]) -> bool:
    return bool(key.commands) and not any(command in commands for command in key.commands)


def _limits(machine: Machine, commands: Sequence[str]) -> Iterable[Entry]:
    if not machine.limits:
        return
    from kurbel.report.forces import limited_values

    values = limited_values(machine)
    for name, bound in machine.limits:
        found = [(where, value) for where, id, value in values if id == name]
        if not found and name in _LATER and not any(command in commands for command in _LATER[name]):
            yield Entry(name, f"not checked: kurbel {' and '.join(_LATER[name])} does not exist yet")
        elif not found:
            raise UsageError(f"limits.{name}: this machine has no {name}: {KEY_VALUES[name].text.lower()}")
        for where, value in found:
            yield _compared(name, bound, where, value)


_LATER = dict.fromkeys(("M_mean", "dE", "delta", "J", "GD2", "omega_max", "omega_min"), ("flywheel",))
"""Key values of commands beside `kurbel forces`."""


def _compared(name: str, bound: float, where: str, value: float) -> Entry:
    """Compare a value with its bound: a `_min` may not fall below it, everything else may not exceed it."""
    kind = KEY_VALUES[name].kind
    lower = name.endswith("_min")
    broken = value < bound if lower else value > bound
    relation = ("<" if broken else "≥") if lower else (">" if broken else "≤")
    text = f"{_shown(value, kind)} {relation} {_shown(bound, kind)}"
    return Entry(name, f"{text}  {'BROKEN' if broken else 'kept'}  ({where})", broken)


def _shown(value: float, kind: str) -> str:
    return f"{value:.6g} {SI[kind]}".rstrip()
