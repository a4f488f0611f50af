"""What a machine is read from."""

import os
import re
from collections.abc import Iterable
from typing import NamedTuple

from kurbel.declared.reading import LONGEST_VALUE, text_in_one_line
from kurbel.errors import Fault, MachineFileError

_LINE_END = r"\r\n|[\n\r\x85\u2028\u2029]"  # what YAML takes for the end of a line, no more


class Origin(NamedTuple):
    """A machine file: the name that messages show, its text, the folder that paths in it are relative to, its bytes.

    case: the name of its load case; overrides: what is set over that, `KEY=VALUE` each; varied: what a row of a sweep
    sets over both.
    """

    name: str
    text: str
    folder: str = ""
    content: bytes = b""
    overrides: tuple[str, ...] = ()
    case: str = ""
    varied: tuple[str, ...] = ()

    def set_over(self, overrides: Iterable[str]) -> "Origin":
        """Return it with these values set over it, too."""
        return self._replace(overrides=(*self.overrides, *overrides))

    @property
    def stem(self) -> str:
        """The name a machine gets from its file."""
        stem = os.path.splitext(os.path.basename(self.name))[0].strip()
        named = stem.isprintable() and stem and not self.name.startswith("<")
        return stem[:LONGEST_VALUE] if named else "machine"

    def error(self, *faults: Fault) -> MachineFileError:
        """Return these faults as an error, each once and in the order of the file."""
        lines = [*yaml_lines(self.text), ""]  # the end of a file may be a place, too
        found = []
        for fault in sorted(dict.fromkeys(faults), key=lambda fault: (fault.line, fault.column)):
            path = tuple(
                text_in_one_line(step) if isinstance(step, str) else step for step in fault.path
            )
            found.append(fault._replace(path=path, source_line=lines[fault.line - 1]))
        return MachineFileError(self.name, found)


def yaml_lines(text: str) -> list[str]:
    """Return the lines of a text, split where YAML splits them."""
    return re.split(_LINE_END, text)
