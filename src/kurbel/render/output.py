"""Where the text goes: standard output, a terminal, or a file; and what its encoding and width are."""

import codecs
import errno
import os
import stat
import sys
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import replace
from itertools import islice
from shutil import get_terminal_size
from typing import TextIO

from kurbel.errors import UsageError
from kurbel.render import Look
from kurbel.render.text import Line, width

_MOST_COLOURED_LINES = 400
_STYLES = {
    "title": "bold",
    "head": "bold cyan",
    "rule": "dim",
    "name": "bold",
    "symbol": "cyan",
    "unit": "dim",
    "mark": "bold red",
    "cell": "",
    "text": "",
    **{f"curve{number}": style for number, style in enumerate(("bold", "blue", "red", "green", "magenta", "yellow"))},
}
"""Role of a piece of a line -> its colour."""


# standard output


def stdout_look(look: Look) -> Look:
    """Return the look with encoding and width of standard output.

    The width of a terminal is its own, that of a pipe what COLUMNS says, or None.
    """
    stdout = _stdout()
    measured = stdout.isatty() or os.environ.get("COLUMNS", "").isdecimal()
    wide = look.width or (get_terminal_size().columns if measured else None)
    return replace(look, encoding=stdout.encoding or "utf-8", width=wide)


def _stdout() -> TextIO:
    if sys.stdout is None or sys.stdout.closed:
        raise UsageError("cannot write to standard output: it is closed")
    return sys.stdout


def write_coloured(page: Iterable[Line], look: Look) -> bool:
    """Write lines in colour and return True; False without a terminal, or where it or its user would rather not."""
    if not _stdout().isatty() or os.environ.get("NO_COLOR") or os.environ.get("TERM") == "dumb":
        return False
    lines = list(islice(page, _MOST_COLOURED_LINES + 1))
    tables = (one for one in lines if any(piece.role in ("rule", "head") for piece in one))
    too_wide = look.width is not None and any(sum(width(piece.text) for piece in one) > look.width for one in tables)
    if len(lines) > _MOST_COLOURED_LINES or too_wide:
        return False
    from rich.console import Console  # takes longer to load than most tables to print
    from rich.text import Text

    # a width, and a height with it, or rich believes a COLUMNS=0 of the environment and prints nothing
    console = Console(width=look.width, height=25, highlight=False, markup=False, emoji=False, soft_wrap=True)
    for one in lines:  # as Text objects: a string would lose its brackets as markup
        console.print(Text.assemble(*coloured(one)))
    return True


def coloured(line: Line) -> list[tuple[str, str]]:
    """Return the pieces of a line with their colours."""
    return [(piece.text, _STYLES[piece.role]) for piece in line]


def write_out(texts: Iterable[str], file_name: str | None, encoding: str | None = None) -> None:
    """Write to a file as UTF-8, or to standard output, in its own encoding if none is given; UsageError as both.

    What is to be piped on as a file is UTF-8 whatever the encoding of standard output.
    """
    if file_name is not None and file_name != "-":
        write_file(file_name, texts)
    else:
        write_stdout(texts, encoding)


def write_stdout(texts: Iterable[str], encoding: str | None = None) -> None:
    """Write to standard output, as bytes so that line ends stay `\n`; a reader that leaves early is no fault.

    Raises UsageError where it cannot be written, on a full disk say.
    """
    stdout = _stdout()
    try:
        if hasattr(stdout, "buffer"):
            stdout.flush()
            encoder = codecs.getincrementalencoder(encoding or stdout.encoding or "utf-8")("replace")
            for text in texts:  # one byte order mark at most
                stdout.buffer.write(encoder.encode(text))
        else:
            stdout.writelines(texts)
        stdout.flush()
    except BrokenPipeError:
        silence(stdout)
    except OSError as error:
        silence(stdout)
        raise UsageError(f"cannot write to standard output: {error.strerror}") from None


def silence(stream: TextIO) -> None:
    """Let what is still buffered go nowhere: Python would complain about it at its end, and change the exit status."""
    with suppress(OSError, ValueError, AttributeError):  # there may be no real file behind it
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())


# files


def write_file(file_name: str, texts: Iterable[str]) -> None:
    """Write a file as UTF-8 with `\n` line ends, whole or not at all. Raises UsageError where it cannot be written."""
    try:
        with replaced(file_name) as path, open(path, "w", encoding="utf-8", newline="\n") as file:
            file.writelines(texts)
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) else ""
        raise UsageError(f"cannot write {file_name or 'to an empty file name'}: {reason or error}") from None


@contextmanager
def replaced(file_name: str) -> Iterator[str]:
    """Yield the path to write to: a new file next to the wanted one, which replaces it once it is whole.

    What is no file, such as a pipe or /dev/stdout, is written to as it is.
    """
    if not (target := whole_file(file_name)):
        yield file_name
        return
    new = os.path.join(os.path.dirname(target), f".kurbel-{os.urandom(8).hex()}{os.path.splitext(file_name)[1]}")
    try:
        os.close(os.open(new, os.O_CREAT | os.O_EXCL, 0o666))
        take_mode(new, target)
        yield new
        os.replace(new, target)
    except BaseException:  # an interrupt, too, leaves nothing behind
        with suppress(OSError):
            os.unlink(new)
        raise


def whole_file(file_name: str) -> str:
    """Return the path of a file that may be replaced once a new one is whole, "" for a device, a pipe or /dev/stdout.

    Raises OSError where it may not be written.
    """
    if not os.path.basename(file_name):
        missing = errno.EISDIR if file_name else errno.ENOENT
        raise OSError(missing, os.strerror(missing))
    with suppress(FileNotFoundError):
        old = os.stat(file_name)
        if not stat.S_ISREG(old.st_mode) or _is_open(old):
            return ""
        if not os.access(file_name, os.W_OK):  # a rename would not ask
            raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), file_name)
    return os.path.realpath(file_name)  # a link stays one


def _is_open(status: os.stat_result) -> bool:
    """Whether this file is where standard output or standard error goes: /dev/stdout by its other name."""
    for descriptor in (1, 2):
        with suppress(OSError):
            if os.path.samestat(status, os.fstat(descriptor)):
                return True
    return False


def take_mode(new: str, target: str) -> None:
    """Give a file the mode of the one that it is to replace, if there is one."""
    with suppress(FileNotFoundError):
        os.chmod(new, stat.S_IMODE(os.stat(target).st_mode))


def refuse_overwriting(file_name: str | None, read: Iterable[str]) -> None:
    """Raise UsageError where a file to be written is one of those that are read, by whatever name; - is stdin."""
    if file_name is None or file_name == "-":
        return
    for other in read:
        with suppress(OSError, ValueError):
            status = os.fstat(0) if other == "-" else os.stat(other)
            if stat.S_ISREG(status.st_mode) and os.path.samestat(os.stat(file_name), status):
                shown = "standard input" if other == "-" else other
                raise UsageError(f"{file_name} would overwrite {shown}, which is read; name another file")
