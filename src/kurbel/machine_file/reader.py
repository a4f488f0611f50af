"""From a machine file to a `Machine`: text, tree, records; or one error with all faults."""

from __future__ import annotations

import os
from typing import Any

from kurbel.machine import Machine
from kurbel.machine_file import source
from kurbel.machine_file.events import REFUSED, Mistake, Plain, parse
from kurbel.machine_file.reading import Reading, TooManyFaults
from kurbel.machine_file.scalars import glued_hint
from kurbel.machine_file.source import Place, Source
from kurbel.machine_file.structures import read_record
from kurbel.machine_file.words import kind_of


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
    tree, mistakes = parse(origin.text)
    reading = Reading(origin.folder)
    machine = REFUSED if tree is REFUSED else _machine(reading, tree, origin.stem)
    if mistakes or reading.findings:
        raise origin.error([*mistakes, *_located(origin.text, reading)])
    assert isinstance(machine, Machine)
    return machine


def _machine(reading: Reading, tree: Any, stem: str) -> Any:
    try:
        if isinstance(tree, dict):
            return read_record(reading, Machine, tree, (), **({} if "name" in tree else {"name": stem}))
        if isinstance(tree, Plain) and not tree:
            return reading.fault((), "the file is empty; 'kurbel example' lists machines to start from")
        hint = glued_hint(tree) if isinstance(tree, str) else ""
        return reading.fault((), f"expected lines such as 'crank: 400 mm', got {kind_of(tree)}{hint}")
    except TooManyFaults:
        return REFUSED


def _located(text: str, reading: Reading) -> list[Mistake]:
    """Return the findings of a reading with their places in the text."""
    if not reading.findings:
        return []
    from kurbel.machine_file.positions import locate

    places: list[Place] = locate(text, [(path, at_key) for path, _, at_key in reading.findings])
    return [Mistake(place, path, message) for place, (path, message, _) in zip(places, reading.findings)]
