"""The bytes of a machine file and the text they make, before any YAML is looked at."""

import os

from kurbel.declared.numerals import SPACES
from kurbel.errors import Fault, MachineFileError, UnreadableFileError
from kurbel.machine.origin import Origin, lines_of

SIZE_LIMIT = 16 * 1024 * 1024
"""Largest machine file in bytes; a longer measurement belongs into a file of its own."""
_SPACE = dict.fromkeys(map(ord, SPACES), " ")  # YAML takes them for letters
_UNPRINTABLE = frozenset(
    map(chr, (*range(9), 11, 12, *range(14, 32), *range(127, 133), *range(134, 160), 0xFFFE, 0xFFFF))
)
"""As YAML has it, without the surrogates, which no UTF-8 holds."""


def read(path: str | os.PathLike[str]) -> Origin:
    """Return the machine file at a path, or standard input for "-".

    Raises UnreadableFileError when there is no such file, and MachineFileError when it is no UTF-8 text.
    """
    name = os.fspath(path)
    if name == "-":
        import sys

        if sys.stdin is None:
            raise UnreadableFileError("cannot read standard input: it is closed")
        return decode("<stdin>", sys.stdin.buffer.read(SIZE_LIMIT + 1))
    try:
        with open(name, "rb") as file:
            content = file.read(SIZE_LIMIT + 1)
    except (OSError, ValueError) as error:  # ValueError: a NUL character in the name
        raise UnreadableFileError(_why_unreadable(name, error)) from None
    return decode(name, content, os.path.dirname(name))


def _why_unreadable(name: str, error: OSError | ValueError) -> str:
    if isinstance(error, FileNotFoundError):
        return f"{name or 'the empty name'}: there is no such file; 'kurbel example' lists machines to start from"
    if isinstance(error, IsADirectoryError):
        return f"{name} is a folder; name the machine file in it"
    if isinstance(error, PermissionError):
        return f"{name} may not be read; check its permissions"
    return f"{name} cannot be read: {error.strerror if isinstance(error, OSError) else error}"


def decode(name: str, content: bytes, folder: str = "") -> Origin:
    """Return the text of a machine file, which is UTF-8 with or without a byte-order mark.

    Raises UnreadableFileError when it is too long, and MachineFileError at the first byte that is no UTF-8.
    """
    if len(content) > SIZE_LIMIT:
        raise UnreadableFileError(
            f"{name} is larger than {SIZE_LIMIT // 2**20} MiB; "
            "put measured pressures into a csv file and name it under 'trace'"
        )
    if content[:2] in (b"\xff\xfe", b"\xfe\xff") or b"\0" in content[:2]:
        raise Origin(name, "").error(Fault((), "the file is UTF-16; save it as UTF-8").at(0, 0))
    try:
        origin = Origin(name, content.decode("utf-8-sig").translate(_SPACE), folder, content)
    except UnicodeDecodeError as error:
        raise _encoding_error(name, content, error.start) from None
    if found := _UNPRINTABLE.intersection(origin.text):
        place = min(map(origin.text.index, found))
        message = f"the character U+{ord(origin.text[place]):04X} cannot be printed; remove it"
        raise origin.error(Fault((), message).at(*_place_of(origin.text, place)))
    return origin


def _encoding_error(name: str, content: bytes, start: int) -> MachineFileError:
    before = content[:start].decode("utf-8-sig")
    read_as = content[start : start + 1].decode("latin-1")
    hint = f", in Latin-1 the letter '{read_as}'" if read_as.isalpha() else ""
    message = f"byte 0x{content[start]:02X} is no UTF-8{hint}; save the file as UTF-8"
    readable = Origin(name, before + content[start:].decode("latin-1"))
    return readable.error(Fault((), message).at(*_place_of(before, len(before))))


def _place_of(text: str, index: int) -> tuple[int, int]:
    """Return line and column, from 0, of the character at an index."""
    lines = lines_of(text[:index])
    return len(lines) - 1, len(lines[-1])
