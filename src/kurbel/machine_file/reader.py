"""From a machine file to a `Machine`: text, tree, records; or one error with all faults."""

from __future__ import annotations

import os
from dataclasses import replace
from typing import Any

from kurbel.declared.forms import Record
from kurbel.declared.reading import REFUSED, Plain, Reading, StopReading, glued_hint, kind_of
from kurbel.errors import Fault
from kurbel.machine import Machine
from kurbel.machine.origin import Origin
from kurbel.machine_file import source
from kurbel.machine_file.events import parse
from kurbel.machine_file.source import Source

ROOT = Record("kurbel.machine:Machine")
"""The form of a whole machine file."""


def load(path: str | os.PathLike[str]) -> Machine:
    """Return the machine that a file describes; "-" is standard input.

    Raises MachineFileError with every fault of the file, UnreadableFileError where there is none to read.
    """
    return read_machine(source.read(path))


def loads(text: str, name: str = "<text>") -> Machine:
    """Return the machine that a text describes; `name` stands for the file in messages.

    Raises MachineFileError with every fault of the text.

    >>> loads("{crank: 400 mm, rod_ratio: 5}").cylinders[0].mechanism.stroke
    0.8
    """
    # half of a surrogate pair is no text: let the decoder say so
    return read_machine(source.decode(name, text.encode("utf-8", "surrogatepass")))


def read_machine(origin: Source) -> Machine:
    """Return the machine that a source describes; raises MachineFileError."""
    reading = Reading(origin.folder, lambda: ROOT.places("", "at the top of the file"))
    tree = parse(origin.text, reading)
    known = len(reading.faults)  # YAML has told their places
    machine = REFUSED if tree is REFUSED else _machine(reading, tree, origin.stem)
    if reading.faults:
        raise origin.error(*reading.faults[:known], *_located(origin.text, reading.faults[known:]))
    assert isinstance(machine, Machine)
    return replace(machine, origin=Origin(origin.name, origin.content))


def _machine(reading: Reading, tree: Any, stem: str) -> Any:
    try:
        if isinstance(tree, dict):
            return ROOT.read(reading, {"name": stem, **tree}, ())
        if isinstance(tree, Plain) and not tree:
            return reading.fault((), "the file is empty; 'kurbel example' lists machines to start from")
        return reading.fault((), f"expected lines such as 'crank: 400 mm', got {kind_of(tree)}{glued_hint(tree)}")
    except StopReading:
        return REFUSED


def _located(text: str, faults: list[Fault]) -> list[Fault]:
    """Return the faults with their places in the text."""
    if not faults:
        return []
    from kurbel.machine_file.positions import located

    return located(text, faults)
