"""What a machine is read from."""

import os
import re
from collections.abc import Iterable
from typing import NamedTuple

from kurbel.declared.reading import LONGEST_VALUE, text_in_one_line
from kurbel.errors import Fault, MachineFileError, Step

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

    def __repr__(self) -> str:
        """Return it without its text, which would hide the machine that it is of."""
        return f"Origin({self.name!r})"

    def set_over(self, overrides: Iterable[str]) -> "Origin":
        """Return it with these values set over it, too."""
        return self._replace(overrides=(*self.overrides, *overrides))

    @property
    def stem(self) -> str:
        """The name a machine gets from its file."""
        file_name, _ = os.path.splitext(os.path.basename(self.name))
        stem = file_name.strip()
        is_file = not self.name.startswith("<")
        return stem[:LONGEST_VALUE] if stem and is_file and stem.isprintable() else "machine"

    def error(self, *faults: Fault) -> MachineFileError:
        """Return these faults as an error, each once and in the order of the file."""
        lines = [*yaml_lines(self.text), ""]  # the end of a file may be a place, too
        in_order = sorted(dict.fromkeys(faults), key=lambda fault: (fault.line, fault.column))
        shown = []
        for fault in in_order:
            path: list[Step] = []
            for step in fault.path:
                path.append(text_in_one_line(step) if isinstance(step, str) else step)
            source_line = lines[fault.line - 1]
            shown.append(fault._replace(path=tuple(path), source_line=source_line))
        return MachineFileError(self.name, shown)


def yaml_lines(text: str) -> list[str]:
    """Return the lines of a text, split where YAML splits them."""
    return re.split(_LINE_END, text)
