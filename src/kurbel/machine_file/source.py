"""The bytes of a machine file and the text they make, before any YAML is looked at."""

import os
import re
import sys

from kurbel.declared.numerals import SPACES
from kurbel.declared.reading import text_in_one_line
from kurbel.errors import Fault, MachineFileError, UnreadableFileError
from kurbel.machine.origin import Origin, yaml_lines
from kurbel.shipped import shipped

SIZE_LIMIT = 16 * 1024 * 1024
"""Largest machine file in bytes; a longer measurement belongs into a file of its own."""
_SPACE = dict.fromkeys(map(ord, SPACES), " ")  # YAML takes them for letters
_UNPRINTABLE = re.compile("[\0-\x08\x0b\x0c\x0e-\x1f\x7f-\x84\x86-\x9f\ufffe\uffff]")
"""As YAML has it, without the surrogates, which no UTF-8 holds."""


def read(path: str | os.PathLike[str]) -> Origin:
    """Return the machine file at a path, or standard input for "-".

    Raises UnreadableFileError when there is no such file, and MachineFileError when it is no UTF-8 text.
    """
    name = os.fspath(path)
    if name == "-":
        if sys.stdin is None:
            raise UnreadableFileError("cannot read standard input: it is closed")
        return decode("<stdin>", sys.stdin.buffer.read(SIZE_LIMIT + 1))
    try:
        with open(name, "rb") as file:
            return decode(name, file.read(SIZE_LIMIT + 1), os.path.dirname(name))
    except FileNotFoundError:
        hint = _hint_without_file(name)
        shown = text_in_one_line(name) if "\n" in name else name
        message = f"{shown or 'the empty name'}: there is no such file; {hint}"
    except IsADirectoryError:
        message = f"{name} is a folder; name the machine file in it"
    except PermissionError:
        message = f"{name} may not be read; check its permissions"
    except OSError as error:
        message = f"{name} cannot be read: {error.strerror}"
    except ValueError as error:  # a NUL character in the name
        message = f"{name} cannot be read: {error}"
    raise UnreadableFileError(message)


def _hint_without_file(name: str) -> str:
    """Return what to do where there is no file of this name."""
    if name in shipped():
        return f"'kurbel example {name} > {name}.yaml' writes the shipped machine of this name"
    if name:
        for ending in (".yaml", ".yml"):
            if os.path.isfile(f"{name}{ending}"):
                return f"did you mean '{name}{ending}'?"
    if "\n" in name:
        return "the text of a machine is read by kurbel.loads"
    return "'kurbel example' lists machines to start from"


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
        raise _refused(name, "", 0, "the file is UTF-16; save it as UTF-8")
    try:
        text = content.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        before = content[: error.start].decode("utf-8-sig")
        after = content[error.start :].decode("latin-1")
        message = f"byte 0x{content[error.start]:02X} is no UTF-8; save the file as UTF-8"
        raise _refused(name, before + after, len(before), message) from None
    unprintable = _UNPRINTABLE.search(text)
    if unprintable:
        message = f"the character U+{ord(unprintable.group()):04X} cannot be printed; remove it"
        raise _refused(name, text, unprintable.start(), message)
    return Origin(name, text.translate(_SPACE), folder, content)


def _refused(name: str, text: str, index: int, message: str) -> MachineFileError:
    """Return what is wrong with the character at an index of a text."""
    lines = yaml_lines(text[:index])
    return Origin(name, text).error(Fault((), message).at(len(lines) - 1, len(lines[-1])))
