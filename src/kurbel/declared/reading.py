"""What forms read: the tree of a machine file, and one pass over it that collects every fault.

The tree is made of dict, list and texts. Numbers stay text, since their key decides what a text means.
"""

import re
from collections.abc import Callable, Iterable, Mapping
from enum import Enum
from typing import Final, Union

from kurbel.errors import Fault, Path, RuleError
from kurbel.quantity import Quantity

Node = Union[str, list["Node"], dict[str, "Node"], "Reported"]
"""The value of a key: a text, a list, a mapping, or REFUSED."""
Tree = dict[str, Node]
FAULT_LIMIT = 100
"""Reading stops at this number of faults: the file is no machine file, and suggestions cost time."""
LONGEST_VALUE = 200
"""Most characters of a value; a longer one is no number, and would flood the message."""


class Plain(str):
    """A text without quotation marks."""

    __slots__ = ()


class Reported(Enum):
    """Its only member replaces a value whose fault has been reported."""

    REFUSED = "REFUSED"


REFUSED: Final = Reported.REFUSED
"""Replaces a value whose fault has been reported; readers ignore it."""


def has_refused(values: Iterable[object]) -> bool:
    """Return whether a value could not be read; others may be arrays, which `in` would compare by their numbers."""
    return any(value is REFUSED for value in values)


class StopReading(Exception):
    """The rest of the file cannot be read, or there are too many faults."""


class Reading:
    """One pass over a machine file, with the faults found so far.

    folder: to which paths in the file are relative; places: returns (words for its place, path, key) of every key of a
    file; key_values: returns the quantities that may have limits and expectations, by id.
    """

    def __init__(
        self,
        folder: str = "",
        places: Callable[[], Iterable[tuple[str, Path, str]]] = tuple,
        key_values: Callable[[], Mapping[str, Quantity]] = dict,
    ) -> None:
        self.folder = folder
        self.key_values = key_values
        self._key_places = places
        self.faults: list[Fault] = []
        self.alike: dict[Path, Path] = {}
        """Path of a mapping that copies the values of another one (`like`) -> path of the other one."""

    def where_it_belongs(self, key: str, path: Path) -> str:
        """Return where near a path a key is valid, such as "it belongs under 'friction.rings'", or ''.

        Near are the mappings above the path and those directly below it; if none of these has the key, any further
        below. A key of that name elsewhere means something else.
        """
        here = tuple(step for step in path if isinstance(step, str))
        # the paths of keys are those within a cylinder
        if here[:2] == ("cylinders", "each"):
            here = here[2:]
        elif here[:1] == ("cylinders",):
            here = here[1:]
        # where a key of this name is valid: near the path, or further below
        near: dict[str, None] = {}
        below: dict[str, None] = {}
        for words, there, name in self._key_places():
            if name != key:
                continue
            is_above = here[: len(there)] == there
            is_directly_below = there[:-1] == here
            if is_above or is_directly_below:
                near[words] = None
            if there[: len(here)] == here:
                below[words] = None
        listed = list(near or below)[:3]
        if not listed:
            return ""
        return "it belongs " + " or ".join(listed)

    def note(self, fault: Fault) -> Reported:
        """Keep a fault and return REFUSED, which replaces the value that could not be read.

        A fault in a copied value is reported once, at the original.
        """
        if self._is_noted_at_original(fault):
            return REFUSED
        is_last = len(self.faults) + 1 >= FAULT_LIMIT
        if is_last:
            message = f"{fault.message} (reading stopped after {FAULT_LIMIT} faults)"
            fault = fault._replace(message=message)
        self.faults.append(fault)
        if is_last:
            raise StopReading
        return REFUSED

    def _is_noted_at_original(self, fault: Fault) -> bool:
        """Return whether a fault is in a copied value and has been reported at the original."""
        for copy, original in self.alike.items():
            if fault.path[: len(copy)] != copy:
                continue
            fault_of_original = fault._replace(path=original + fault.path[len(copy) :])
            if fault_of_original in self.faults or self._is_noted_at_original(fault_of_original):
                return True
        return False

    def fault(self, path: Path, message: str, at_key: bool = False) -> Reported:
        """Keep a fault at a path of the tree and return REFUSED."""
        return self.note(Fault(path, message, at_key))

    def refuse(self, path: Path, error: RuleError) -> Reported:
        """Keep the faults of an error that was raised for the value at a path, and return REFUSED."""
        for fault in error.faults:
            self.note(fault.below(path))
        return REFUSED


def text_in_one_line(text: str, most: int = 60) -> str:
    """Write a text from the file so that it fits into one line of a message, without control characters."""
    if text.isprintable() and len(text) <= most:
        return text
    line = ""
    for character in text[: most + 1]:
        if character.isprintable():
            line += character
        elif character in "\t\r\n":
            line += " "
        else:
            line += f"\\u{ord(character):04x}"
    if len(line) <= most:
        return line
    return line[: most - 3] + "…"


def node_kind(value: Node) -> str:
    """Return the description of a value of the tree for messages, as in 'got a list'."""
    if isinstance(value, dict):
        return "a mapping" if value else "an empty mapping"
    if isinstance(value, list):
        return "a list" if value else "an empty list"
    return f"'{text_in_one_line(str(value))}'"


def is_nothing(value: Node) -> bool:
    """Return whether nothing is written, or what YAML takes for nothing."""
    return isinstance(value, Plain) and value in ("", "~", "null", "Null", "NULL")


def glued_hint(value: Node) -> str:
    """Return a hint if a value seems to contain a key without a space after its colon, or an empty text."""
    if not isinstance(value, str):
        return ""
    glued_key = re.search(r"\b([A-Za-z_]\w*):\S", value)
    if glued_key is None:
        return ""
    return f"; perhaps a space is missing after the colon of '{glued_key[1]}'"
