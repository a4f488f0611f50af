"""From a machine file to a `Machine`: text, tree, records; or one error with all faults."""

import os
import re
from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any

from kurbel.declared.forms.making import Maker
from kurbel.declared.forms.structures import ReadMapping, RecordForm, key_places
from kurbel.declared.numerals import WRITTEN, familiar
from kurbel.declared.reading import (
    REFUSED,
    Node,
    Plain,
    Reading,
    StopReading,
    glued_hint,
    node_kind,
    text_in_one_line,
)
from kurbel.declared.units import ZEROED_UNITS
from kurbel.errors import Fault, MachineFileError, Path, UsageError
from kurbel.machine import Machine
from kurbel.machine.origin import Origin
from kurbel.machine_file import source
from kurbel.machine_file.events import located, parse
from kurbel.machine_file.overrides import named, set_over
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
        raise MachineFileError(
            origin.name, sorted(dict.fromkeys(faults), key=lambda one: (one.line, one.column))
        )
    return machines


def loads(text: str, name: str = "<text>", overrides: Iterable[str] = ()) -> Machine:
    """Return the machine that a text describes; name: used as the file name in messages; overrides: see `load`.

    Raises MachineFileError with every fault of the text.

    >>> loads("{crank: 400 mm, rod_ratio: 5}").cylinders[0].mechanism.stroke
    0.8
    """
    # half of a surrogate pair is no text: let the decoder say so
    return read_machine(
        source.decode(name, text.encode("utf-8", "surrogatepass")).set_over(overrides)
    )


def machine_of(given: object) -> Machine:
    """Return the machine: given itself, as the path of a file, or as a text; raises UsageError for anything else.

    A text has several lines, or braces, or a colon followed by a blank; a path has none of these.
    """
    if isinstance(given, Machine):
        return given
    if isinstance(given, str) and re.search(r"[\n{]|:\s", given):
        return loads(given)
    if isinstance(given, (str, os.PathLike)):
        return load(given)
    raise UsageError(
        f"a machine is expected, or the path or text of a machine file, not {text_in_one_line(repr(given))}"
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
    known = len(reading.faults)  # those of YAML, which have their places
    overrides = set_over(tree, origin)
    given = REFUSED
    try:
        if isinstance(tree, dict):
            given = ROOT.read(reading, {"name": origin.stem, **_without_zeros(tree, reading)}, ())
            Maker(reading).made(given)
        elif isinstance(tree, Plain) and not tree:
            reading.fault((), "the file is empty; 'kurbel example' lists machines to start from")
        elif tree is not REFUSED:
            reading.fault(
                (),
                f"expected lines such as 'crank: 400 mm', got {node_kind(tree)}{glued_hint(tree)}",
            )
    except StopReading:
        pass
    if reading.faults:
        found = [named(fault, overrides) for fault in reading.faults[known:]]
        in_file = located(origin.text, [one for one in found if not one.override])
        raise origin.error(
            *reading.faults[:known], *(one for one in found if one.override), *in_file
        )
    assert isinstance(given, ReadMapping)
    return given


# pressure units that name their zero, such as psia and barg, must agree with the reference of the value; in the tree
# they are replaced by psi and bar, so that no other code needs to handle them

_COUNTED = {
    "ambient": "absolute",
    "vapour_pressure": "absolute",
    **dict.fromkeys(("offset", "mean_pressure", "drawn"), ""),
}
"""Keys whose pressures are not relative to the reference of the indicator: '' for differences of pressure."""
_ZEROED = re.compile(rf"((?:{WRITTEN})?\s*)({'|'.join(ZEROED_UNITS)})")


def _without_zeros(tree: Node, reading: Reading, path: Path = (), counted: str = "") -> Any:
    """Return a tree without such units; one that does not agree with `counted`, gauge or absolute, is a fault.

    Pressures of an indicator are gauge or absolute by its `pressures`, the ambient is absolute, others are neither.
    """
    if isinstance(tree, dict):
        if path[-1:] == ("indicator",):
            counted = "absolute" if tree.get("pressures") == "absolute" else "gauge"
        zeros = {key: _COUNTED.get(key, counted) for key in tree}
        return {
            key: _without_zeros(one, reading, (*path, key), zeros[key]) for key, one in tree.items()
        }
    if isinstance(tree, list) and not (
        tree and isinstance(tree[0], list)
    ):  # points are of bare numbers
        return [
            _without_zeros(one, reading, (*path, index), counted) for index, one in enumerate(tree)
        ]
    found = _ZEROED.fullmatch(familiar(tree).strip()) if isinstance(tree, str) else None
    if not found or (path[-1] != "unit" and not found[1].strip()):
        return tree
    zero, plain = ZEROED_UNITS[found[2]]
    if zero == counted:
        return type(tree)(found[1] + plain)
    if not counted:
        wrong = f"but this pressure has no zero; write the unit {plain}"
    elif path[-1] == "ambient":
        wrong = f"but the ambient is absolute; write the absolute pressure in {plain}"
    else:
        other = f"write 'pressures: {zero}', or the {counted} pressure in {plain}"
        wrong = f"but 'pressures: {counted}' holds here; {other}"
    return reading.fault(path, f"'{found[2]}' is {zero}, {wrong}")
