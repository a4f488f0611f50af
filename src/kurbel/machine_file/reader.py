"""From a machine file to a `Machine`: text, tree, records; or one error with all faults."""

import os
import re
from collections.abc import Iterable, Mapping
from dataclasses import replace

from kurbel.declared.forms.making import Maker
from kurbel.declared.forms.structures import ReadMapping, RecordForm, key_places
from kurbel.declared.reading import (
    REFUSED,
    Plain,
    Reading,
    StopReading,
    glued_hint,
    node_kind,
    text_in_one_line,
)
from kurbel.errors import Fault, MachineFileError, UsageError
from kurbel.machine import Machine
from kurbel.machine.origin import Origin
from kurbel.machine_file import source
from kurbel.machine_file.events import located, parse
from kurbel.machine_file.overrides import set_over, with_override
from kurbel.machine_file.zeros import without_zeros
from kurbel.quantities import KEY_VALUES
from kurbel.quantity import Quantity

ROOT = RecordForm(Machine)
"""The form of a whole machine file."""


def load(path: str | os.PathLike[str], overrides: Iterable[str] = (), case: str = "") -> Machine:
    """Return the machine that a file describes; "-" is standard input.

    overrides: values that replace those of the file, such as `cylinders.0.bore=450 mm`; case: the name of one of its
    load cases, whose values they replace, too. Raises UsageError for an override that cannot be set, MachineFileError
    with every fault of the file, UnreadableFileError if the file cannot be read.
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
        # a fault of the file itself occurs in every case
        different = dict.fromkeys(faults)
        in_order = sorted(different, key=lambda fault: (fault.line, fault.column))
        raise MachineFileError(origin.name, in_order)
    return machines


def loads(text: str, name: str = "<text>", overrides: Iterable[str] = ()) -> Machine:
    """Return the machine that a text describes; name: used as the file name in messages; overrides: see `load`.

    Raises MachineFileError with every fault of the text.

    >>> loads("{crank: 400 mm, rod_ratio: 5}").cylinders[0].mechanism.stroke
    0.8
    """
    # half of a surrogate pair is no text: let the decoder say so
    origin = source.decode(name, text.encode("utf-8", "surrogatepass"))
    return read_machine(origin.set_over(overrides))


def machine_of(machine: object) -> Machine:
    """Return a machine that is given itself, as the path of a file, or as a text; raises UsageError for anything else.

    A text has several lines, or braces, or a colon followed by a blank; a path has none of these.
    """
    if isinstance(machine, Machine):
        return machine
    if isinstance(machine, str) and re.search(r"[\n{]|:\s", machine):
        return loads(machine)
    if isinstance(machine, (str, os.PathLike)):
        return load(machine)
    raise UsageError(
        "a machine is expected, or the path or text of a machine file, "
        f"not {text_in_one_line(repr(machine))}"
    )


def key_values() -> Mapping[str, Quantity]:
    """Return the key values on which a machine file may put limits, by id."""
    return KEY_VALUES


def reading_of(origin: Origin) -> Reading:
    """Return a new pass over a file."""
    return Reading(origin.folder, lambda: key_places(ROOT), key_values)


def read_machine(origin: Origin) -> Machine:
    """Return the machine that a file describes; errors: see `load`."""
    machine: Machine = read_values(origin, reading_of(origin)).made
    name = f"{machine.name}, {origin.case}" if origin.case else machine.name
    return replace(machine, name=name, origin=origin)


def read_values(origin: Origin, reading: Reading) -> ReadMapping:
    """Return the result of both passes over a file; errors: see `load`; reading: see `reading_of`."""
    tree = parse(origin.text, reading)
    faults_of_yaml = list(reading.faults)  # they have their positions
    overrides = set_over(tree, origin)
    mapping = REFUSED
    try:
        if isinstance(tree, dict):
            keys = {"name": origin.stem, **without_zeros(tree, reading)}
            mapping = ROOT.read(reading, keys, ())
            Maker(reading).made(mapping)
        elif isinstance(tree, Plain) and not tree:
            reading.fault((), "the file is empty; 'kurbel example' lists machines to start from")
        elif tree is not REFUSED:
            node = f"{node_kind(tree)}{glued_hint(tree)}"
            reading.fault((), f"expected lines such as 'crank: 400 mm', got {node}")
    except StopReading:
        pass
    if not reading.faults:
        assert isinstance(mapping, ReadMapping)
        return mapping
    # faults of overrides have no position in the file
    others = [with_override(fault, overrides) for fault in reading.faults[len(faults_of_yaml) :]]
    of_overrides = [fault for fault in others if fault.override]
    of_file = [fault for fault in others if not fault.override]
    raise origin.error(*faults_of_yaml, *of_overrides, *located(origin.text, of_file))
