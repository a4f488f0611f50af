"""A file of a data logger as text, whatever its encoding; what is no text is named as what it is."""

import os

from kurbel.errors import Fault, RuleError, refused

LARGEST_FILE = 64 * 2**20
"""Bytes; a million samples have about twenty million."""
_LONGEST_LINE = 10_000
_WORKBOOK = "save its sheet as CSV"
_FOREIGN = {
    b"PK\x03\x04": ("an Excel or other workbook, or a zip archive", _WORKBOOK),
    b"\xd0\xcf\x11\xe0": ("an old Excel workbook (xls)", _WORKBOOK),
    b"TDSm": ("a TDMS file of LabVIEW", "export its channels as CSV"),
    b"MDF ": ("an MDF file of a measuring system", "export its channels as CSV"),
    b"\x89HDF": ("an HDF5 file", "export its data set as CSV"),
    b"MATLAB 5.0 MAT": ("a MAT file of MATLAB", "write its matrix as CSV (writematrix)"),
    b"\x1f\x8b": ("compressed by gzip", "unpack it"),
    b"PAR1": ("a Parquet file", "export its columns as CSV"),
    b"%PDF": ("a PDF", "name the file of figures itself"),
}
"""First bytes of files that people name for a table -> what they are, and the way out."""


def text_of(file: str) -> str:
    """Return the text of a file with line feeds alone; figures are ASCII, headings may be in any encoding.

    Raises RuleError for what is too large, or no text.
    """
    text = _decoded(_bytes_of(file)).replace("\r\n", "\n").replace("\r", "\n")
    if "\0" in text:
        refused("is no text: it has zero bytes; export the samples as CSV", "file")
    if _has_long_line(text):
        refused(f"has a line of more than {_LONGEST_LINE} characters", "file")
    return text


def _bytes_of(file: str) -> bytes:
    try:
        if os.path.getsize(file) > LARGEST_FILE:
            refused(f"is larger than {LARGEST_FILE // 2**20} MiB; thin out the samples", "file")
        with open(file, "rb") as stream:
            raw = stream.read()
    except OSError as error:
        raise RuleError(Fault(("file",), f"cannot be read: {error.strerror or error}")) from None
    for begin, (what, advice) in _FOREIGN.items():
        if raw.startswith(begin):
            refused(f"{os.path.basename(file)} is {what}, no text; {advice}", "file")
    return raw


def _decoded(raw: bytes) -> str:
    """Return the text of bytes; UTF-16 is known by its mark, or by the zero in every other byte of its figures."""
    if raw[:2] in (b"\xff\xfe", b"\xfe\xff"):
        return raw.decode("utf-16", errors="replace")
    head = raw[:400]
    for first, name in ((1, "utf-16-le"), (0, "utf-16-be")):
        if head and head[first::2].count(0) > len(head) // 4:
            return raw.decode(name, errors="replace")
    return raw.decode("utf-8-sig", errors="replace")


def _has_long_line(text: str) -> bool:
    """Return whether any line is too long, by leaps of half of what it may have: between two breaks lie less."""
    leap, begin = _LONGEST_LINE, 0
    while len(text) - begin > leap:
        end = text.rfind("\n", begin, begin + leap + 1)
        if end < 0:
            return True
        begin = end + 1
    return False
