"""Every error kurbel raises on purpose: one root, raised where the rule lives, caught once at the top."""

from collections.abc import Callable
from typing import NamedTuple, NoReturn, Union

Step = Union[str, int]
Path = tuple[Step, ...]
"""Place in a machine file: keys and list indices from the top, `("cylinders", 0, "rod")`."""


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
    """Root of all errors that a user can cause; `exit_status` is that of the command line."""

    exit_status = 2

    @property
    def reason(self) -> str:
        """What is wrong, without what would help if that takes long to compute: for one of many machines."""
        return str(self)


class Fault(NamedTuple):
    """One thing that is wrong: where, and what to write instead.

    path: relative to the record that found it, until the reader has made it whole; at_key: the key itself is meant.
    Line and column count from 1, in characters; they and the source line are filled in when the text is searched.
    override: the option it comes from, as it was given, `--set KEY=VALUE`, if it is not in the file.
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


class NotANumber(Fault):
    """A value is NaN: given in Python, or in place of one that could not be read."""


class RuleError(KurbelError):
    """A record breaks one or more of its own rules, such as a rod shorter than its crank."""

    def __init__(self, *faults: Fault) -> None:
        self.faults = faults
        super().__init__(
            "; ".join(f"{path_text(f.path)}: {f.message}" if f.path else f.message for f in faults)
        )


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
    """All faults of a machine file, in the order of the file."""

    def __init__(self, file_name: str, faults: list[Fault]) -> None:
        self.file_name = file_name
        self.faults = faults
        super().__init__("\n".join(self.line(fault) for fault in faults))

    def line(self, fault: Fault) -> str:
        """Return `file:line:column: path: message`; of an override the option instead of file and place."""
        where = f"{path_text(fault.path)}: " if fault.path else ""
        origin = fault.override or f"{self.file_name}:{fault.line}:{fault.column}"
        return f"{origin}: {where}{fault.message}"

    def pretty(self, cells: int = 104, spelt: Callable[[str], str] = str) -> str:
        """Return every fault with its source line below it, cut to this many cells, and a caret under the place.

        spelt: returns a text as the output can show it.
        """
        shown: list[str] = []
        for fault in self.faults:
            shown.append(spelt(self.line(fault)))
            if not fault.source_line.strip():
                continue
            column, room = (
                fault.column - 1,
                max(cells - 6, 1),
            )  # less the margin and an ellipsis on either side
            start = 0 if len(fault.source_line) <= room else max(column - room * 3 // 4, 0)
            text = fault.source_line[start : start + room]
            clean = [spelt(c if c.isprintable() else " ") for c in text]
            cut = spelt("…")[:1]
            lead, tail = (
                cut if start else " ",
                f" {cut}" if start + len(text) < len(fault.source_line) else "",
            )
            shown.append(f"  {lead} {''.join(clean)}{tail}".rstrip())
            shown.append(" " * (4 + len("".join(clean[: column - start]))) + "^")
        return "\n".join(shown)


class UsageError(KurbelError):
    """A request that does not fit the machine or the command."""


class NoSolutionError(KurbelError):
    """The machine as described does not run: it jams or stalls.

    remedy: returns the end of the message, what would help; it is computed only where the message is shown.
    """

    exit_status = 3

    def __init__(self, reason: str, remedy: Callable[[], str] = str) -> None:
        super().__init__(reason)
        self.remedy = remedy

    def __str__(self) -> str:
        return self.reason + self.remedy()

    @property
    def reason(self) -> str:
        """What is wrong, without the remedy."""
        return super().__str__()


class Nowhere(NoSolutionError):
    """A column of one cylinder does not reach the value of `--where`; that of another cylinder may."""
