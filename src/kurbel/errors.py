"""Every error kurbel raises on purpose: one root, raised where the rule lives, caught once at the top."""

from __future__ import annotations

from typing import NamedTuple, Union

Step = Union[str, int]
Path = tuple[Step, ...]
"""Where something stands in a machine file: keys and list indices from the top, `("cylinders", 0, "rod")`."""


def path_text(path: Path) -> str:
    """Write a path the way people read it.

    >>> path_text(("cylinders", 0, "rod"))
    'cylinders[0].rod'
    """
    text = ""
    for step in path:
        if isinstance(step, int):
            text += f"[{step}]"
        else:
            text += f".{step}" if text else step
    return text


class KurbelError(Exception):
    """Root of all errors that a user can cause; `exit_status` is what the command line answers with."""

    exit_status = 2


class Fault(NamedTuple):
    """One thing that is wrong: where, and what to write instead.

    path: relative to the record that found it, until the reader has made it whole; at_key: the key itself is meant.
    Line and column count from 1, in characters; they and the source line are filled in when the text is searched.
    override: the KEY=VALUE from outside that it is of, if it does not stand in the file.
    """

    path: Path
    message: str
    at_key: bool = False
    line: int = 0
    column: int = 0
    source_line: str = ""
    override: str = ""

    def below(self, path: Path) -> Fault:
        """Return it as seen from further up: its path with this one before it."""
        return self._replace(path=(*path, *self.path))

    def at(self, line: int, column: int) -> Fault:
        """Return it with its place, both counted from 0, as YAML counts them."""
        return self._replace(line=line + 1, column=column + 1)


class RuleError(KurbelError):
    """A record breaks one or more of its own rules, such as a rod shorter than its crank."""

    def __init__(self, *faults: Fault) -> None:
        self.faults = faults
        super().__init__("; ".join(f"{path_text(f.path)}: {f.message}" if f.path else f.message for f in faults))


def refuse(*faults: Fault) -> None:
    """Raise RuleError where there is any fault."""
    if faults:
        raise RuleError(*faults)


class UnitError(RuleError):
    """A text is not a number, or not one with a unit of the wanted kind."""

    def __init__(self, message: str) -> None:
        super().__init__(Fault((), message))


class UnreadableFileError(KurbelError):
    """A file is missing, may not be read, or is too long."""


class MachineFileError(KurbelError):
    """All faults of a machine file, in the order in which they stand in it."""

    def __init__(self, file_name: str, faults: list[Fault]) -> None:
        self.file_name = file_name
        self.faults = faults
        super().__init__("\n".join(self.line(fault) for fault in faults))

    def line(self, fault: Fault) -> str:
        """Return `file:line:column: path: message`, or what it is of instead of file and place."""
        where = f"{path_text(fault.path)}: " if fault.path else ""
        place = f"--set {fault.override}" if fault.override else f"{self.file_name}:{fault.line}:{fault.column}"
        return f"{place}: {where}{fault.message}"

    def pretty(self) -> str:
        """Return every fault with its source line below it and a caret under the place."""
        return "\n".join(part for fault in self.faults for part in (self.line(fault), *_pointed(fault)))


_SHOWN_WIDTH = 100  # of a source line; a diagram in one long line is cut to what stands round the fault


def _pointed(fault: Fault) -> tuple[str, ...]:
    """Return the source line, cut and cleared of what could steer a terminal, and the caret under the fault."""
    if not fault.source_line.strip():
        return ()
    start = max(0, fault.column - 1 - _SHOWN_WIDTH * 3 // 4) if len(fault.source_line) > _SHOWN_WIDTH else 0
    piece = fault.source_line[start : start + _SHOWN_WIDTH]
    clear = "".join(c if c.isprintable() else " " for c in piece)
    lead, tail = "… " if start else "  ", " …" if start + _SHOWN_WIDTH < len(fault.source_line) else ""
    return f"  {lead}{clear}{tail}".rstrip(), " " * (4 + fault.column - 1 - start) + "^"


class UsageError(KurbelError):
    """A question that the machine or the command cannot answer as it was put."""


class NoSolutionError(KurbelError):
    """The machine as described does not run: it locks itself or stalls."""

    exit_status = 3
