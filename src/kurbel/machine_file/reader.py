"""From a machine file to a `Machine`: text, tree, records; or one error with all faults."""

import os
from collections.abc import Iterable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from kurbel.declared.forms import Record
from kurbel.declared.reading import REFUSED, Plain, Reading, StopReading, glued_hint, kind_of
from kurbel.errors import Fault
from kurbel.machine import Machine
from kurbel.machine.origin import Origin
from kurbel.machine_file import source
from kurbel.machine_file.events import parse
from kurbel.machine_file.source import Source

if TYPE_CHECKING:
    from kurbel.machine_file.overrides import Override

ROOT = Record("kurbel.machine:Machine")
"""The form of a whole machine file."""


def load(path: str | os.PathLike[str], overrides: Iterable[str] = ()) -> Machine:
    """Return the machine that a file describes; "-" is standard input.

    overrides: values in place of those of the file, such as `cylinders.0.bore=450 mm`. Raises UsageError for one that
    cannot be set, MachineFileError with every fault of the file, UnreadableFileError where there is none to read.
    """
    return read_machine(source.read(path), overrides)


def loads(text: str, name: str = "<text>", overrides: Iterable[str] = ()) -> Machine:
    """Return the machine that a text describes; `name` stands for the file in messages; overrides: see `load`.

    Raises MachineFileError with every fault of the text.

    >>> loads("{crank: 400 mm, rod_ratio: 5}").cylinders[0].mechanism.stroke
    0.8
    """
    # half of a surrogate pair is no text: let the decoder say so
    return read_machine(source.decode(name, text.encode("utf-8", "surrogatepass")), overrides)


def reading_of(origin: Source) -> Reading:
    """Return a pass over a source that has not begun."""
    return Reading(origin.folder, lambda: ROOT.places("", "at the top of the file"))


def read_machine(origin: Source, overrides: Iterable[str] = (), reading: Reading | None = None) -> Machine:
    """Return the machine that a source describes; overrides and errors: see `load`; reading: see `reading_of`."""
    reading = reading or reading_of(origin)
    tree = parse(origin.text, reading)
    known = len(reading.faults)  # YAML has told their places
    given = tuple(overrides)
    set_over = _set_over(tree, given)
    machine = REFUSED if tree is REFUSED else _machine(reading, tree, origin.stem)
    if reading.faults:
        raise origin.error(*reading.faults[:known], *_located(origin.text, reading.faults[known:], set_over))
    assert isinstance(machine, Machine)
    return replace(machine, origin=Origin(origin.name, origin.content, given))


def _set_over(tree: Any, overrides: Sequence[str]) -> "list[Override]":
    """Put the overrides into the tree, and return them."""
    if not overrides or not isinstance(tree, dict):
        return []
    from kurbel.machine_file.overrides import overridden, read_override

    read = [read_override(one) for one in overrides]
    overridden(tree, read)
    return read


def _machine(reading: Reading, tree: Any, stem: str) -> Any:
    try:
        if isinstance(tree, dict):
            return ROOT.read(reading, {"name": stem, **tree}, ())
        if isinstance(tree, Plain) and not tree:
            return reading.fault((), "the file is empty; 'kurbel example' lists machines to start from")
        return reading.fault((), f"expected lines such as 'crank: 400 mm', got {kind_of(tree)}{glued_hint(tree)}")
    except StopReading:
        return REFUSED


def _located(text: str, faults: list[Fault], set_over: "Sequence[Override]") -> list[Fault]:
    """Return the faults with their places in the text, or with the override that they are of."""
    if not faults:
        return []
    from kurbel.machine_file.positions import located

    if set_over:
        from kurbel.machine_file.overrides import named

        faults = named(faults, set_over)
    return [*(one for one in faults if one.override), *located(text, [one for one in faults if not one.override])]
