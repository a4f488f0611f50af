"""Where the text goes: standard output, a terminal, or a file; and what its encoding and width are."""

import codecs
import errno
import os
import stat
import sys
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from itertools import islice
from typing import TYPE_CHECKING, Any

from kurbel.errors import UsageError
from kurbel.render import Look
from kurbel.render.text import Charset

if TYPE_CHECKING:
    from kurbel.render.text import Line

_MOST_COLOURED_LINES = 400


def write_coloured(page: "Iterable[Line]", look: Look) -> bool:
    """Write lines in colour and return True, unless there is no terminal, or it or its user would rather not."""
    if not _stdout().isatty() or os.environ.get("NO_COLOR") or os.environ.get("TERM") == "dumb":
        return False
    lines = list(islice(page, _MOST_COLOURED_LINES + 1))
    if len(lines) > _MOST_COLOURED_LINES:
        return False
    from kurbel.render.terminal import write_lines

    return write_lines(lines, look)


def stdout_width() -> int | None:
    """Return the columns of the terminal; of a pipe what COLUMNS says, or None: it has no width."""
    if not _stdout().isatty() and not os.environ.get("COLUMNS", "").isdecimal():
        return None
    from shutil import get_terminal_size

    return get_terminal_size().columns


def _stdout() -> Any:
    if sys.stdout is None or sys.stdout.closed:
        raise UsageError("cannot write to standard output: it is closed")
    return sys.stdout


def stdout_charset() -> Charset:
    """Return what standard output can show."""
    return Charset(getattr(_stdout(), "encoding", None) or "utf-8")


def stdout_look() -> Look:
    """Return how text looks that standard output can show."""
    return Look(encoding=stdout_charset().encoding, width=stdout_width())


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


def silence(stream: Any) -> None:
    """Let what is still buffered go nowhere: Python would complain about it at its end, and change the exit status."""
    with suppress(OSError, ValueError, AttributeError):  # there may be no real file behind it
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())


def write_file(file_name: str, texts: Iterable[str]) -> None:
    """Write a file as UTF-8 with `\n` line ends, whole or not at all. Raises UsageError where it cannot be written."""
    try:
        with replaced(file_name) as path, open(path, "w", encoding="utf-8", newline="\n") as file:
            file.writelines(texts)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise UsageError(f"cannot write {file_name or 'to an empty file name'}: {reason}") from None


@contextmanager
def replaced(file_name: str) -> Iterator[str]:
    """Yield the path to write to: a new file beside the wanted one, which takes its place once it is whole.

    What is no file, such as a pipe or /dev/stdout, is written to as it is.
    """
    if not (target := whole_file(file_name)):
        yield file_name
        return
    beside = os.path.join(os.path.dirname(target), f".kurbel-{os.urandom(8).hex()}{os.path.splitext(file_name)[1]}")
    try:
        os.close(os.open(beside, os.O_CREAT | os.O_EXCL, 0o666))
        take_mode(beside, target)
        yield beside
        os.replace(beside, target)
    except BaseException:  # an interrupt, too, leaves nothing behind
        with suppress(OSError):
            os.unlink(beside)
        raise


def whole_file(file_name: str) -> str:
    """Return the path of a file that may be replaced once a new one is whole, "" for a device, a pipe or /dev/stdout.

    Raises OSError where it may not be written.
    """
    old = _status(file_name)
    if old and (not stat.S_ISREG(old.st_mode) or _is_open(old)):
        return ""
    if old and not os.access(file_name, os.W_OK):  # a rename would not ask
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), file_name)
    return os.path.realpath(file_name)  # a link stays one


def take_mode(new: str, target: str) -> None:
    """Give a file the mode of the one that it is to replace, if there is one."""
    with suppress(FileNotFoundError):
        os.chmod(new, stat.S_IMODE(os.stat(target).st_mode))


def _status(file_name: str) -> os.stat_result | None:
    if not os.path.basename(file_name):
        missing = errno.EISDIR if file_name else errno.ENOENT
        raise OSError(missing, os.strerror(missing))
    try:
        return os.stat(file_name)
    except FileNotFoundError:
        return None


def _is_open(status: os.stat_result) -> bool:
    """Whether this file is where standard output or standard error goes: /dev/stdout by its other name."""
    for descriptor in (1, 2):
        with suppress(OSError):
            if os.path.samestat(status, os.fstat(descriptor)):
                return True
    return False


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
