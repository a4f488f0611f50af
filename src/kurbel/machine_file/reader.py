"""From a machine file to a `Machine`: text, tree, records; or one error with all faults."""

import os
import re
from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any

from kurbel.declared.forms.structures import Given, Maker, RecordForm, places
from kurbel.declared.reading import REFUSED, Plain, Reading, StopReading, glued_hint, kind_of, shown
from kurbel.errors import Fault, MachineFileError, UsageError
from kurbel.machine import Machine
from kurbel.machine.origin import Origin
from kurbel.machine_file import source
from kurbel.machine_file.events import located, parse
from kurbel.machine_file.overrides import named, set_over
from kurbel.machine_file.zeroed_units import without_zeros
from kurbel.quantities import every_quantity
from kurbel.quantity import Quantity, by_id

ROOT = RecordForm(Machine)
"""The form of a whole machine file."""


def load(path: str | os.PathLike[str], overrides: Iterable[str] = (), case: str = "") -> Machine:
    """Return the machine that a file describes; "-" is standard input.

    overrides: values in place of those of the file, such as `cylinders.0.bore=450 mm`; case: the name of one of its
    load cases, over which they are set. Raises UsageError for one that
    cannot be set, MachineFileError with every fault of the file, UnreadableFileError where there is none to read.
    """
    return read_machine(source.read(path)._replace(case=case).set_over(overrides))


def load_cases(origin: Origin, names: Iterable[str]) -> list[Machine]:
    """Return the machine of each of these load cases; raises MachineFileError with the faults of all of them."""
    machines: list[Machine] = []
    faults: list[Fault] = []
    for name in names:
        try:
            machines.append(read_machine(origin._replace(case=name)))
        except MachineFileError as error:
            faults += error.faults
    if faults:
        raise MachineFileError(origin.name, sorted(dict.fromkeys(faults), key=lambda one: (one.line, one.column)))
    return machines


def loads(text: str, name: str = "<text>", overrides: Iterable[str] = ()) -> Machine:
    """Return the machine that a text describes; `name` stands for the file in messages; overrides: see `load`.

    Raises MachineFileError with every fault of the text.

    >>> loads("{crank: 400 mm, rod_ratio: 5}").cylinders[0].mechanism.stroke
    0.8
    """
    # half of a surrogate pair is no text: let the decoder say so
    return read_machine(source.decode(name, text.encode("utf-8", "surrogatepass")).set_over(overrides))


def machine_of(given: Any) -> Machine:
    """Return a machine as it is, that of a file by its path, or that of a text; raises UsageError for anything else.

    A text has several lines, or braces, or a colon with a blank behind it; a path has none of these.
    """
    if isinstance(given, Machine):
        return given
    if isinstance(given, str) and re.search(r"[\n{]|:\s", given):
        return loads(given)
    if isinstance(given, (str, os.PathLike)):
        return load(given)
    raise UsageError(f"a machine is expected, or the path or text of a machine file, not {shown(repr(given))}")


def key_values() -> Mapping[str, Quantity]:
    """Return the key values on which a machine file may put limits, by id."""
    return by_id(*every_quantity().all_key_values)


def reading_of(origin: Origin) -> Reading:
    """Return a pass over a file that has not begun."""
    return Reading(origin.folder, lambda: places(ROOT), key_values)


def read_machine(origin: Origin) -> Machine:
    """Return the machine that a file describes; errors: see `load`."""
    machine: Machine = read_values(origin, reading_of(origin)).made
    name = f"{machine.name}, {origin.case}" if origin.case else machine.name
    return replace(machine, name=name, origin=origin)


def read_values(origin: Origin, reading: Reading) -> Given:
    """Return what a file says, with the records that were made of it; errors: see `load`; reading: see `reading_of`."""
    tree = parse(origin.text, reading)
    known = len(reading.faults)  # YAML has told their places
    overrides = set_over(tree, origin)
    given = REFUSED
    try:
        if isinstance(tree, dict):
            given = ROOT.read(reading, {"name": origin.stem, **without_zeros(tree, reading)}, ())
            Maker(reading).made(given)
        elif isinstance(tree, Plain) and not tree:
            reading.fault((), "the file is empty; 'kurbel example' lists machines to start from")
        elif tree is not REFUSED:
            reading.fault((), f"expected lines such as 'crank: 400 mm', got {kind_of(tree)}{glued_hint(tree)}")
    except StopReading:
        pass
    if reading.faults:
        found = [named(fault, overrides) for fault in reading.faults[known:]]
        in_file = located(origin.text, [one for one in found if not one.override])
        raise origin.error(*reading.faults[:known], *(one for one in found if one.override), *in_file)
    assert isinstance(given, Given)
    return given
