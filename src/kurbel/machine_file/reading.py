"""What all readers of forms share: the faults found so far, and where paths in the file lead."""

from __future__ import annotations

from typing import Any, NamedTuple

from kurbel.errors import Path
from kurbel.machine_file.events import FAULT_LIMIT, REFUSED


class Finding(NamedTuple):
    """One fault: its path in the tree, what is wrong and what to write, and whether it is about the key itself."""

    path: Path
    message: str
    at_key: bool


class TooManyFaults(Exception):
    """The file has so many faults that reading on would help nobody."""


class Reading:
    """One pass over the tree of a machine file, collecting every fault."""

    def __init__(self, folder: str) -> None:
        self.folder = folder
        self.findings: list[Finding] = []

    def fault(self, path: Path, message: str, at_key: bool = False) -> Any:
        """Note a fault and return REFUSED, which stands for the value that could not be read."""
        full = len(self.findings) + 1 >= FAULT_LIMIT
        note = f" (reading stopped after {FAULT_LIMIT} faults)" if full else ""
        self.findings.append(Finding(path, message + note, at_key))
        if full:
            raise TooManyFaults
        return REFUSED
