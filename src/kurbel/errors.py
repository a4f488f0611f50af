"""Every error kurbel raises on purpose: one root, raised where the rule lives, caught once at the top."""

from collections.abc import Callable, Iterator
from typing import NamedTuple, NoReturn, Union

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
    override: what it is of, as it was given, `--set KEY=VALUE`, if that does not stand in the file.
    """

    path: Path
    message: str
    at_key: bool = False
    line: int = 0
    column: int = 0
    source_line: str = ""
    override: str = ""

    def below(self, path: Path) -> "Fault":
        """Return it as seen from further up: its path with this one before it."""
        return self._replace(path=(*path, *self.path))

    def at(self, line: int, column: int) -> "Fault":
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


def refused(message: str, *path: Step) -> NoReturn:
    """Raise RuleError with what is wrong with the value at a path, or with the whole."""
    raise RuleError(Fault(path, message))


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
        place = fault.override or f"{self.file_name}:{fault.line}:{fault.column}"
        return f"{place}: {where}{fault.message}"

    def pretty(self, cells: int = 104, spelt: Callable[[str], str] = str, size: Callable[[str], int] = len) -> str:
        """Return every fault with its source line below it, cut to this many cells, and a caret under the place.

        spelt: returns a text as the output can show it; size: the cells that such a text takes.
        """

        def lines() -> Iterator[str]:
            for fault in self.faults:
                yield spelt(self.line(fault))
                yield from _pointed(fault, cells, spelt, size)

        return "\n".join(lines())


def _pointed(fault: Fault, cells: int, spelt: Callable[[str], str], size: Callable[[str], int]) -> Iterator[str]:
    """Yield the source line, cut and cleared of what could steer a terminal, and the caret under the fault."""
    text, place = fault.source_line, fault.column - 1
    if not text.strip():
        return
    first = max(0, place - cells)
    shown = [spelt(c if c.isprintable() else " ") for c in text[first : place + cells]]
    widths, at = [size(one) for one in shown], place - first
    room = max(cells - 6, 1)  # beside the margin and a sign of the cut, with its blank, on either side
    whole = len(shown) == len(text) and sum(widths) <= room
    start = 0 if whole else next(i for i in range(at + 1) if sum(widths[i:at]) <= room * 3 // 4)
    end = next(i for i in range(len(shown), -1, -1) if sum(widths[start:i]) <= room)
    cut = spelt("…")[:1]
    lead, tail = f"{cut} " if first + start else "  ", f" {cut}" if first + end < len(text) else ""
    yield f"  {lead}{''.join(shown[start:end])}{tail}".rstrip()
    yield " " * (4 + sum(widths[start:at])) + "^"


class UsageError(KurbelError):
    """A question that the machine or the command cannot answer as it was put."""


class NoSolutionError(KurbelError):
    """The machine as described does not run: it locks itself or stalls."""

    exit_status = 3


class Nowhere(NoSolutionError):
    """A column of one cylinder does not reach the value at which rows are sought; another cylinder's may."""
