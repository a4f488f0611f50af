"""The destination of the text: standard output, a terminal, or a file; with encoding and width."""

import codecs
import errno
import os
import stat
import sys
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager, suppress
from io import TextIOWrapper
from typing import TYPE_CHECKING, BinaryIO, TextIO

from kurbel.errors import UsageError
from kurbel.render import Look

if TYPE_CHECKING:
    from kurbel.render.text import Line

STYLES = {
    "title": "bold",
    "head": "bold cyan",
    "rule": "dim",
    "name": "bold",
    "symbol": "cyan",
    "unit": "dim",
    "mark": "bold red",
    "cell": "",
    "text": "",
    **{
        f"curve{number}": style
        for number, style in enumerate(("bold", "blue", "red", "green", "magenta", "yellow"))
    },
}
"""Role of a piece of a line -> its colour."""
_AT_ONCE = 1 << 20
"""Bytes that are copied at once."""


# lists of the commands that print no report


def listing(
    title: str, sections: Iterable[tuple[str, Sequence[tuple[str, str]]]], look: Look
) -> str:
    """Return a title and sections, each a head line with its entries, as plain text."""
    from kurbel.render.text import BLANK, in_two_columns, paragraph, plain_lines

    lines = paragraph(look.text(title), look.width)
    for name, entries in sections:
        lines += [BLANK, *paragraph(look.text(name), look.width), *in_two_columns(entries, look)]
    return "".join(plain_lines(lines))


def write_entries(entries: Sequence[tuple[str, str]], file_name: str | None = None) -> None:
    """Write heads in a column, each with its text, to a file or to standard output."""
    from kurbel.render.text import in_two_columns, plain_lines

    write_out(plain_lines(in_two_columns(entries, look_at(file_name, Look()), "")), file_name)


# standard output


def look_at(file_name: str | None, look: Look) -> Look:
    """Return the look of what goes to a file, as UTF-8, or with encoding and width of standard output.

    The width is that of the terminal; in a pipe that of COLUMNS, or None.
    """
    if file_name not in (None, "-"):
        return look
    stdout = _stdout()
    encoding = stdout.encoding or "utf-8"
    has_width = stdout.isatty() or os.environ.get("COLUMNS", "").isdecimal()
    if look.width or not has_width:
        return look._replace(encoding=encoding, width=look.width or None)
    return look._replace(encoding=encoding, width=terminal_size()[0])


def terminal_size(fallback: tuple[int, int] = (80, 24)) -> tuple[int, int]:
    """Return columns and lines of the terminal: those of the environment, or its own."""
    measured: tuple[int, int] = fallback
    if sys.__stdout__:
        with suppress(ValueError, OSError):  # standard output may be closed, or no terminal
            measured = os.get_terminal_size(sys.__stdout__.fileno())
    columns = _number_of("COLUMNS") or measured[0] or fallback[0]
    lines = _number_of("LINES") or measured[1] or fallback[1]
    return columns, lines


def _number_of(variable: str) -> int:
    """Return the number that a variable of the environment has, 0 without one."""
    text = os.environ.get(variable, "")
    if not text.isdecimal():
        return 0
    return int(text)


def _stdout() -> TextIO:
    if sys.stdout is None or sys.stdout.closed:
        raise UsageError("cannot write to standard output: it is closed")
    return sys.stdout


def write_lines(lines: "Iterable[Line]", look: Look) -> None:
    """Write lines to standard output, in colour on a terminal unless colours are not wanted.

    NO_COLOR forbids colours, FORCE_COLOR has them in a pipe, too, as in the log of a CI service.
    """
    forbidden = bool(os.environ.get("NO_COLOR")) or os.environ.get("TERM") == "dumb"
    forced = os.environ.get("FORCE_COLOR", "") not in ("", "0")
    is_coloured = not forbidden and (forced or _stdout().isatty())
    if not is_coloured:
        from kurbel.render.text import plain_lines

        write_out(plain_lines(lines), None, look.encoding)
        return
    from rich.console import Console  # takes longer to load than most tables to print
    from rich.text import Text

    # a width, and a height with it, or rich believes a COLUMNS=0 of the environment and prints nothing
    console = Console(
        width=look.width, height=25, highlight=False, markup=False, emoji=False, soft_wrap=True
    )
    for line in lines:  # as Text objects: a string would lose its brackets as markup
        console.print(Text.assemble(*((piece.text, STYLES[piece.role]) for piece in line)))


def silence(stream: TextIO) -> None:
    """Discard what is still buffered: Python would report it at exit, and change the exit status."""
    with suppress(OSError, ValueError, AttributeError):  # there may be no real file behind it
        os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())


# standard output and files alike


def write_out(texts: Iterable[str], file_name: str | None, encoding: str | None = None) -> None:
    r"""Write with `\n` line ends to a file as UTF-8, or to standard output, in its own encoding if none is given.

    Raises UsageError where it cannot be written.
    """
    if file_name in (None, "-"):
        stdout = _stdout()
        if not isinstance(stdout, TextIOWrapper):  # that of a notebook has no bytes below it
            stdout.writelines(texts)
            return
        encoding = encoding or stdout.encoding
    # one byte order mark at most
    encoder = codecs.getincrementalencoder(encoding or "utf-8")("replace")
    with opened(file_name) as file:
        for text in texts:
            file.write(encoder.encode(text))


@contextmanager
def opened(file_name: str | None, resumed: int | None = None) -> Iterator[BinaryIO]:
    """Yield a binary stream to standard output or to a file, which is replaced only when the new one is complete.

    A device or a pipe is written to as it is. resumed: of what may go on later, the bytes that stay of what is there;
    it goes to FILE.part, which an early end leaves. A reader that leaves early is no fault; raises UsageError.
    """
    has_name = file_name not in (None, "-")
    try:
        if not has_name:
            stdout = _stdout()
            stdout.flush()
            yield stdout.buffer
            stdout.flush()
            return
        target = whole_file(str(file_name))
        if target:
            with _replacing(target, resumed) as file:
                yield file
        else:
            with open(str(file_name), "wb") as file:
                yield file
    except OSError as error:
        if not has_name:
            silence(sys.stdout)
        if not isinstance(error, BrokenPipeError):
            target_name = file_name or "to an empty file name"
            where = target_name if has_name else "to standard output"
            raise UsageError(f"cannot write {where}: {error.strerror or error}") from None


@contextmanager
def _replacing(target: str, resumed: int | None) -> Iterator[BinaryIO]:
    """Yield a new file next to a target, which it replaces with the same mode; an empty one is removed."""
    ending = f".kurbel-{os.urandom(8).hex()}"
    if resumed is None:
        path = os.path.join(os.path.dirname(target), ending)
    else:
        path = f"{target}.part"
    if resumed and not os.path.isfile(path):
        with open(target, "rb") as old, open(path, "wb") as file:
            file.writelines(iter(lambda: old.read(_AT_ONCE), b""))
    try:
        with open(path, "r+b" if resumed else "wb") as file:
            with suppress(FileNotFoundError):
                os.chmod(path, stat.S_IMODE(os.stat(target).st_mode))
            file.seek(resumed or 0)
            file.truncate()
            yield file
        os.replace(path, target)
    except BaseException:  # an interrupt, too, leaves nothing behind that is not wanted
        with suppress(OSError):
            if resumed is None or not os.path.getsize(path):
                os.unlink(path)
        raise


def whole_file(file_name: str) -> str:
    """Return the path of a file that may be replaced by a new one, "" for a device, a pipe or /dev/stdout.

    Raises OSError where it may not be written.
    """
    with suppress(FileNotFoundError):
        old = os.stat(file_name)
        if not stat.S_ISREG(old.st_mode) or any(_is_same(old, descriptor) for descriptor in (1, 2)):
            return ""
        if not os.access(file_name, os.W_OK):  # a rename would not ask
            raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), file_name)
    return os.path.realpath(file_name)  # a link stays one


def _is_same(file: os.stat_result, other: str | int) -> bool:
    """Return whether a file is the one with this name or descriptor; /dev/stdout, for one, has another name."""
    with suppress(OSError, ValueError):
        return os.path.samestat(file, os.stat(other))
    return False


def refuse_overwriting(file_name: str | None, read: Iterable[str]) -> None:
    """Raise UsageError if a file to be written is one of those that are read, under any name; - is stdin."""
    if file_name is None or file_name == "-":
        return
    for other in read:
        with suppress(OSError, ValueError):
            status = os.stat(0 if other == "-" else other)
            if stat.S_ISREG(status.st_mode) and _is_same(status, file_name):
                shown = "standard input" if other == "-" else other
                raise UsageError(
                    f"{file_name} would overwrite {shown}, which is read; name another file"
                )
