"""What a report was made from."""

import sys
from collections.abc import Iterator
from contextlib import suppress

from kurbel.machine import Machine
from kurbel.report.tables import Input, Later, Provenance


def provenance(machine: Machine) -> Provenance:
    """Return what results of a machine are made from; nothing is hashed before it is read."""
    overrides = machine.origin.overrides if machine.origin else ()
    numpy = sys.modules.get("numpy")  # else nothing is computed with it
    versions = {"numpy": numpy.__version__} if numpy else {}
    return Provenance(Later(lambda: _inputs(machine)), overrides, versions)


def _inputs(machine: Machine) -> Iterator[Input]:
    from hashlib import sha256

    if machine.origin:  # standard input cannot be read again
        yield Input(machine.origin.name, sha256(machine.origin.content).hexdigest())
    for name in machine.trace_files:
        digest = None
        with suppress(OSError), open(name, "rb") as file:
            digest = sha256(file.read()).hexdigest()
        yield Input(name, digest)
