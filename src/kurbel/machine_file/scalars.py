"""Readers of single values: numbers, values with a unit, counts, words, texts, file names."""

from __future__ import annotations

import os
import re
from typing import Any

from kurbel.declared import keys as forms
from kurbel.declared.bounds import out_of_size
from kurbel.declared.keys import out_of_bounds
from kurbel.declared.numerals import parse_number, plain
from kurbel.declared.units import parse_quantity, unit_factor
from kurbel.errors import Path, UnitError
from kurbel.machine_file.events import REFUSED, Plain
from kurbel.machine_file.reading import Reading
from kurbel.machine_file.source import LONGEST_VALUE, shown
from kurbel.machine_file.words import expected, kind_of, listed
from kurbel.near_words import did_you_mean

_GLUED = re.compile(r"\b[A-Za-z_]\w*:\S")
_NOTHING = ("", "~", "null", "Null", "NULL")


def _fits(reading: Reading, form: Any, value: Any, path: Path) -> bool:
    """Return whether a value is a text of sensible length; otherwise note what is expected."""
    if isinstance(value, Plain) and value in _NOTHING:
        reading.fault(path, f"a value is missing; write {expected(form)}")
    elif not isinstance(value, str):
        reading.fault(path, f"expected {expected(form)}, got {kind_of(value)}")
    elif len(value) > LONGEST_VALUE or not value.isprintable():
        reading.fault(path, f"expected {expected(form)}, got '{shown(value)}'")
    elif not value.strip():
        reading.fault(path, f"expected {expected(form)}, got an empty text")
    else:
        return True
    return False


def physical(reading: Reading, form: forms.Physical, value: Any, path: Path) -> Any:
    """Read a number with its unit into the base of its kind."""
    if not _fits(reading, form, value, path):
        return REFUSED
    for word, stands_for in form.words:
        if value == word:
            return stands_for
    if form.words and value.strip()[0].isalpha():
        return reading.fault(path, f"expected {expected(form)}, got '{value}'")
    try:
        number = parse_quantity(value, form.kind)
    except UnitError as error:
        return reading.fault(path, f"{error}{glued_hint(value)}")
    wrong = out_of_bounds(number, form) or out_of_size(number, form.kind)
    return reading.fault(path, f"{value} {wrong}") if wrong else number


def number(reading: Reading, form: forms.Number, value: Any, path: Path) -> Any:
    """Read a bare number."""
    if not _fits(reading, form, value, path):
        return REFUSED
    for word, stands_for in form.words:
        if value == word:
            return stands_for
    if not isinstance(value, Plain):
        return reading.fault(path, f'expected a number, got the text "{value}"; leave out the quotation marks')
    if form.words and value.strip()[0].isalpha():
        return reading.fault(path, f"expected {expected(form)}, got '{value}'")
    try:
        bare = parse_number(value)
    except UnitError as error:
        return reading.fault(path, f"{error}{glued_hint(value)}")
    wrong = out_of_bounds(bare, form) or out_of_size(bare, "ratio")
    return reading.fault(path, f"{value} {wrong}") if wrong else bare


def glued_hint(value: str) -> str:
    """Return what to write when a key without a space after its colon hides in a value, or an empty text."""
    found = _GLUED.search(value)
    return f"; perhaps a space is missing after the colon of '{found.group().split(':')[0]}'" if found else ""


def count(reading: Reading, form: forms.Count, value: Any, path: Path) -> Any:
    """Read a whole number."""
    if not _fits(reading, form, value, path):
        return REFUSED
    if not isinstance(value, Plain):
        return reading.fault(path, f'expected a whole number, got the text "{value}"; leave out the quotation marks')
    if not re.fullmatch(r"[-+]?(0|[1-9][0-9]{0,8})", value):
        return reading.fault(path, f"expected a whole number, got '{value}'")
    whole = int(value)
    if form.most == form.least != whole:
        return reading.fault(path, f"{whole} is not supported; it must be {form.least}")
    if whole < form.least:
        return reading.fault(path, f"{whole} is too small; it must be at least {form.least}")
    if form.most is not None and whole > form.most:
        return reading.fault(path, f"{whole} is too large; it must be at most {form.most}")
    return whole


def text(reading: Reading, form: forms.Text, value: Any, path: Path) -> Any:
    """Read a text of one line."""
    return value.strip() if _fits(reading, form, value, path) else REFUSED


def choice(reading: Reading, form: forms.Choice, value: Any, path: Path) -> Any:
    """Read one of several words."""
    if isinstance(value, str) and value in form.words:
        return str(value)
    if not _fits(reading, form, value, path):
        return REFUSED
    hint = did_you_mean(value, form.words) or f"; write {expected(form)}"
    return reading.fault(path, f"unknown word '{shown(value)}'{hint}")


def file_path(reading: Reading, form: forms.FilePath, value: Any, path: Path) -> Any:
    """Read the name of a file relative to the machine file into a path that can be opened."""
    if not _fits(reading, form, value, path):
        return REFUSED
    full = os.path.join(reading.folder, value)
    if os.path.isdir(full):
        return reading.fault(path, f"'{shown(value)}' is a folder; name the file in it")
    if os.path.exists(full) and not os.path.isfile(full):
        return reading.fault(path, f"'{shown(value)}' is a device or a pipe; name a file that can be read again")
    if not os.path.isfile(full):
        where = f"in {shown(reading.folder)}" if reading.folder else "in the working directory"
        return reading.fault(path, f"there is no file '{shown(value)}' {where}")
    return full


def unit_name(reading: Reading, form: forms.UnitName, value: Any, path: Path) -> Any:
    """Read the name of a unit into its factor pair."""
    if not _fits(reading, form, value, path):
        return REFUSED
    try:
        return unit_factor(value, form.kind)
    except UnitError as error:
        return reading.fault(path, str(error))


def limits(reading: Reading, form: forms.Limits, value: Any, path: Path) -> Any:
    """Read bounds for key values into pairs of id and bound in the base of its quantity."""
    from kurbel.declared.quantity import by_id
    from kurbel.mechanisms import every_quantity

    if not isinstance(value, dict) or not value:
        got = "nothing" if isinstance(value, Plain) and value in _NOTHING else kind_of(value)
        return reading.fault(path, f"expected {expected(form)}, got {got}")
    bounds, known = [], by_id(every_quantity().all_key_values)
    for name, bound in value.items():
        if name not in known:
            hint = did_you_mean(name, tuple(known)) or f"; known are {listed([*known][:6], '…')}"
            reading.fault((*path, name), f"unknown key value '{shown(name)}'{hint}", at_key=True)
            continue
        if known[name].listed:
            reading.fault((*path, name), f"'{name}' is a list of values; no bound can be put on it", at_key=True)
            continue
        bounds.append((name, _limit(reading, known[name].kind, bound, (*path, name))))
    return REFUSED if any(bound is REFUSED for _, bound in bounds) else tuple(bounds)


def _limit(reading: Reading, kind: str, value: Any, path: Path) -> Any:
    """Read one bound; a ratio may be a quotient such as 1/200."""
    if value is REFUSED:
        return REFUSED
    if kind != "ratio":
        return physical(reading, forms.Physical(kind), value, path)
    parts = plain(value).split("/") if isinstance(value, Plain) and len(value) < LONGEST_VALUE else []
    if len(parts) != 2:
        return number(reading, forms.Number(), value, path)
    try:
        over, under = (parse_number(part) for part in parts)
        ratio = over / under
    except (UnitError, ZeroDivisionError):
        return reading.fault(path, f"expected a number or a quotient such as 1/200, got '{shown(value)}'")
    wrong = out_of_size(ratio, "ratio")
    return reading.fault(path, f"{shown(value)} {wrong}") if wrong else ratio
