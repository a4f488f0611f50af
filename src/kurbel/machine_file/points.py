"""Reader of lists of pairs, `[[x, y], …]`, quick enough for a measurement of 1e5 of them."""

from __future__ import annotations

import re
from typing import Any

from kurbel.declared.bounds import MOST_POINTS
from kurbel.declared.keys import Points
from kurbel.declared.numerals import parse_number
from kurbel.errors import Path, UnitError
from kurbel.machine_file.events import REFUSED, Plain
from kurbel.machine_file.reading import Reading
from kurbel.machine_file.source import LONGEST_VALUE, shown
from kurbel.machine_file.words import expected, kind_of

_FAULTS_SHOWN = 3  # of one list: the others are of the same sort, as when every pair has a decimal comma


def points(reading: Reading, form: Points, value: Any, path: Path) -> Any:
    """Read a list of pairs of bare numbers."""
    if not isinstance(value, list):
        missing = isinstance(value, Plain) and not value
        got = "" if missing else f", got {kind_of(value)}"
        return reading.fault(path, f"{'a value is missing; write' if missing else 'expected'} {expected(form)}{got}")
    if len(value) > MOST_POINTS:
        return reading.fault(path, f"{len(value)} points; more than {MOST_POINTS} are not taken, thin them out")
    pairs = [_pair(item) for item in value]
    bad = [index for index, pair in enumerate(pairs) if pair is None]
    if bad:
        return _report(reading, form, value, path, bad)
    if len(pairs) < form.least:
        only = f"only {len(pairs)} point" if pairs else "no points"
        return reading.fault(path, f"{only}; at least {form.least} are needed, [[{form.x}, {form.y}], …]")
    return pairs


def _pair(item: Any) -> tuple[float, float] | None:
    """Return the numbers of a point, None where it is none."""
    if type(item) is not list or len(item) != 2:
        return None
    x, y = item
    if type(x) is not Plain or type(y) is not Plain or len(x) > LONGEST_VALUE or len(y) > LONGEST_VALUE:
        return None
    try:
        return parse_number(x), parse_number(y)
    except UnitError:
        return None


def _report(reading: Reading, form: Points, value: list[Any], path: Path, bad: list[int]) -> Any:
    if all(isinstance(item, str) for item in value):
        return reading.fault(path, f"expected {expected(form)}, got single values; put each pair into its own brackets")
    told = [index for index in bad if value[index] is not REFUSED]
    for index in told[:_FAULTS_SHOWN]:
        _explain(reading, form, value[index], (*path, index))
    more = told[_FAULTS_SHOWN:]
    if more:
        these = f"these {len(more)} points are" if len(more) > 1 else "this point is"
        reading.fault((*path, more[0]), f"from here on {these} wrong as well")
    return REFUSED


def _explain(reading: Reading, form: Points, item: Any, path: Path) -> None:
    """Note what is wrong with one point."""
    pair = f"[{form.x}, {form.y}]"
    if not isinstance(item, list):
        reading.fault(path, f"expected a pair {pair}, got {kind_of(item)}")
    elif any(isinstance(entry, (list, dict)) for entry in item):
        reading.fault(path, f"expected a pair {pair} of numbers; are there too many brackets?")
    elif len(item) != 2:
        reading.fault(path, _wrong_length(item, pair))
    else:
        for name, index in ((form.x, 0), (form.y, 1)):
            _explain_number(reading, name, item[index], (*path, index))


def _wrong_length(item: list[Any], pair: str) -> str:
    written = shown(", ".join(str(entry) for entry in item[:6]))
    if len(item) == 1 and re.fullmatch(r"\S+\s+\S+", str(item[0])):
        return f"a comma is missing between the two numbers; write [{shown(', '.join(str(item[0]).split()))}]"
    if len(item) in (3, 4) and all(re.fullmatch(r"[-+]?\d+", str(entry)) for entry in item):
        return f"a pair {pair} has two numbers, [{written}] has {len(item)}; write decimal points, such as 1.5 for 1,5"
    return f"a pair {pair} has two numbers, [{written}] has {len(item) or 'none'}"


def _explain_number(reading: Reading, name: str, entry: Any, path: Path) -> None:
    if entry is REFUSED:
        return
    if isinstance(entry, Plain) and entry in ("", "~", "null"):
        reading.fault(path, f"a value is missing; write the {name} as a number")
        return
    if not isinstance(entry, Plain):
        reading.fault(path, f'expected a number, got the text "{shown(entry)}"; leave out the quotation marks')
        return
    try:
        parse_number(shown(entry, LONGEST_VALUE))
    except UnitError as error:
        reading.fault(path, str(error))
