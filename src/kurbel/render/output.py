"""Where the text goes: standard output, a terminal, or a file; and what its encoding and width are."""

from __future__ import annotations

import os
import sys
from contextlib import suppress
from typing import TYPE_CHECKING, Any

from kurbel.errors import UsageError
from kurbel.render import Look, render
from kurbel.render.charset import Charset

if TYPE_CHECKING:
    from kurbel.report.tables import Report

_MOST_COLOURED_ROWS = 400


def write_report(report: Report, look: Look, file_name: str | None = None) -> None:
    """Write the report to a file (as UTF-8), or to standard output in the encoding of that.

    A terminal gets as many angles to a block as fit its width, and colours where they are wanted; a pipe gets plain
    text. Raises UsageError where it cannot be written.
    """
    if file_name is not None and file_name != "-":
        write_file(file_name, render(report, look._replace(encoding="utf-8", width=None)))
        return
    stdout = _stdout()
    look = look._replace(encoding=stdout_charset().encoding)
    if look.format != "table" or not stdout.isatty():
        write_stdout(render(report, look))
        return
    look = look._replace(width=_terminal_width())
    if not _coloured(report, look):
        write_stdout(render(report, look))


def _coloured(report: Report, look: Look) -> bool:
    """Write the page in colour and return True, unless the terminal or its user would rather not."""
    if os.environ.get("NO_COLOR") or os.environ.get("TERM") == "dumb":
        return False
    from kurbel.render.page import page

    lines = page(report, look)
    if len(lines) > _MOST_COLOURED_ROWS:
        return False
    from kurbel.render.terminal import write_lines

    return write_lines(lines, look)


def _terminal_width() -> int:
    from shutil import get_terminal_size

    return get_terminal_size().columns


def _stdout() -> Any:
    if sys.stdout is None or sys.stdout.closed:
        raise UsageError("cannot write to standard output: it is closed")
    return sys.stdout


def stdout_charset() -> Charset:
    """Return what standard output can show."""
    return Charset(getattr(_stdout(), "encoding", None) or "utf-8")


def write_stdout(text: str, encoding: str | None = None) -> None:
    """Write to standard output, as bytes so that line ends stay `\\n`; a reader that leaves early is no fault.

    Raises UsageError where it cannot be written, on a full disk say.
    """
    stdout = _stdout()
    try:
        if hasattr(stdout, "buffer"):
            stdout.flush()
            stdout.buffer.write(text.encode(encoding or stdout.encoding or "utf-8", "replace"))
        else:
            stdout.write(text)
        stdout.flush()
    except BrokenPipeError:
        silence_stdout()
    except OSError as error:
        silence_stdout()
        raise UsageError(f"cannot write to standard output: {error.strerror}") from None


def silence_stdout() -> None:
    """Let what is still buffered go nowhere: Python would complain about it at its end."""
    with suppress(OSError, ValueError, AttributeError):  # there may be no real file behind it
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


def write_text(text: str, file_name: str | None = None) -> None:
    """Write UTF-8 text unchanged to a file, or to standard output whatever its encoding: a file that is piped on."""
    if file_name is not None and file_name != "-":
        write_file(file_name, text)
    else:
        write_stdout(text, "utf-8")


def write_file(file_name: str, text: str) -> None:
    """Write a file as UTF-8 with `\\n` line ends. Raises UsageError where it cannot be written."""
    try:
        with open(file_name, "w", encoding="utf-8", newline="\n") as file:
            file.write(text)
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or str(error)
        raise UsageError(f"cannot write {file_name or 'to an empty file name'}: {reason}") from None
