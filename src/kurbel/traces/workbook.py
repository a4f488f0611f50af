"""Sheets of Excel workbooks as text, a row in a line and a tab between cells, so that they are read as other files are.

Needs openpyxl, which is optional; old workbooks (xls) it cannot read.
"""

import io
import itertools
import warnings
import zipfile
from collections.abc import Iterator
from functools import lru_cache
from typing import Any

from kurbel.errors import RuleError, refused
from kurbel.near_words import did_you_mean

_LARGEST = 1 << 30
"""Most bytes of an unpacked workbook: a small archive can unpack to anything."""
_MOST_ROWS = 1 << 20
"""Rows of a sheet; no program writes more."""
_EXAMINED = 200
"""Rows in which formulas are looked for."""
_ERRORS = ("#N/A", "#DIV/0!", "#REF!", "#VALUE!", "#NAME?", "#NUM!", "#NULL!")
"""What a cell shows whose formula has no value; '#' would begin a comment."""
_BLANK = "-"
"""For an empty cell next to others: it is no number."""


@lru_cache(maxsize=2)
def sheet_text(raw: bytes, name: str, sheet: str | None, columns: int) -> str:
    """Return the first columns of a sheet of a workbook as text; raises RuleError.

    raw: the bytes of the file; name: of the file, for messages; sheet: its name, None for the first. Kept, since designs
    that vary what is known of a trace have one file in common.
    """
    try:
        chosen = _chosen(_workbook(raw, name, data_only=True), name, sheet)
        chosen.reset_dimensions()  # some programs write wrong ones
        rows = chosen.iter_rows(max_row=_MOST_ROWS, max_col=columns, values_only=True)
        return "\n".join(_lines(rows)) + "\n"
    except RuleError:
        raise
    # whatever damaged bytes do to the libraries that unpack and parse them
    except Exception as error:
        refused(f"{name} cannot be read as a workbook ({error}); export its table as CSV", "file")


def advice_on_sheet(raw: bytes, name: str, sheet: str | None, columns: int) -> str:
    """Return why a sheet that could be opened has no rows of figures, or '' where it does not show.

    Another program writes formulas without their values, or the figures are on another sheet than the first.
    """
    workbook = _workbook(raw, name, data_only=False)
    chosen = _chosen(workbook, name, sheet)
    chosen.reset_dimensions()
    rows = chosen.iter_rows(max_row=_EXAMINED, max_col=columns, values_only=True)
    cells = itertools.chain.from_iterable(rows)
    if any(isinstance(cell, str) and cell.startswith("=") for cell in cells):
        return (
            "; it has formulas: open and save it in Excel or LibreOffice, which store their values"
        )
    others = [f"'{other.title}'" for other in workbook.worksheets if other is not chosen]
    if sheet is None and others:
        return f"; the first sheet, '{chosen.title}', is read: choose another with 'sheet': {', '.join(others)}"
    return ""


def _workbook(raw: bytes, name: str, data_only: bool) -> Any:
    """Return a workbook opened by openpyxl, with values in place of formulas or without; raises RuleError."""
    from openpyxl import load_workbook

    with zipfile.ZipFile(io.BytesIO(raw)) as archive:
        size = sum(entry.file_size for entry in archive.infolist())
    if size > _LARGEST:
        refused(f"{name} unpacks to {size / 2**30:.1f} GiB; export its table as CSV", "file")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of styles and extensions, which nobody needs here
        return load_workbook(io.BytesIO(raw), read_only=True, data_only=data_only)


def _chosen(workbook: Any, name: str, sheet: str | None) -> Any:
    """Return the sheet of this name, or the first; raises RuleError."""
    sheets = {candidate.title: candidate for candidate in workbook.worksheets}
    if not sheets:
        refused(f"{name} has no sheet with cells", "file")
    if sheet is None:
        return next(iter(sheets.values()))
    if sheet in sheets:
        return sheets[sheet]
    hint = did_you_mean(sheet, tuple(sheets))
    if not hint:
        hint = "; its sheets are " + ", ".join(f"'{title}'" for title in sheets)
    return refused(f"{name} has no sheet '{sheet}'{hint}", "sheet")


def _lines(rows: Any) -> Iterator[str]:
    """Yield each row as a line; an empty one is an empty line, so that numbers of rows stay."""
    for row in rows:
        cells = [_text_of(cell) for cell in row]
        while cells and cells[-1] == _BLANK:
            cells.pop()
        yield "\t".join(cells)


def _text_of(cell: object) -> str:
    """Return a cell as text of one line: a number with all its digits."""
    if cell is None:
        return _BLANK
    if isinstance(cell, (int, float)) and not isinstance(cell, bool):
        return repr(cell)
    text = " ".join(str(cell).replace('"', "").split())
    if text in _ERRORS:
        return text[1:]
    return text or _BLANK
