"""What stands below the table: notes, key values, what was left out and why, warnings."""

import re
from collections.abc import Collection, Iterator
from typing import NamedTuple

from kurbel.declared.quantity import NOISE_POWER
from kurbel.render import Look
from kurbel.render.numbers import angle, single
from kurbel.render.sheet import part_name
from kurbel.render.text import Line, Piece, folded, left, line, right, width
from kurbel.report.tables import KeyValue, LeftOut, Part, Report

_LONGEST = 16  # of a number, or two angles; a longer list stands out, its sentence on the next line
_MOST_LISTED = 12
_LEAST_BESIDE = 24  # narrower than this a sentence is folded below its head instead


def prose(report: Report, look: Look) -> Iterator[list[Line]]:
    """Yield the paragraphs below the tables."""
    if notes := [note for note in (report.mirrored, *report.notes) if note]:
        yield [one for note in notes for one in sentence("", note, look)]
    for part in report.all_parts:
        yield from _of_part(part_name(report, part, look), part, look)


def _of_part(name: str, part: Part, look: Look) -> Iterator[list[Line]]:
    said = f": {name}" if name else ""
    if part.key_values:
        yield [line(f"Key values{said}", "name"), *key_value_lines(part.key_values, look)]
    if part.left_out:
        yield [line(f"Left out{said}", "name"), *_left_out(part.left_out, look)]
    if part.warnings:
        warnings = (one for warning in part.warnings for one in sentence("  ", warning, look))
        yield [line(f"Warnings{said}", "name"), *warnings]


def _left_out(left_out: Collection[LeftOut], look: Look) -> Iterator[Line]:
    column = max(width(look.charset.text(one.what)) for one in left_out)
    for one in left_out:
        yield from sentence(f"  {left(look.charset.text(one.what), column)}  ", one.why, look)


class _Shown(NamedTuple):
    """A key value as text; `whole` and `fraction` are its number, split where the decimal points align."""

    symbol: str
    whole: str
    fraction: str
    unit: str
    place: str
    text: str


def key_value_lines(key_values: Collection[KeyValue], look: Look) -> Iterator[Line]:
    """Yield a line for each key value: symbol, value, unit, where it stands, what it is; decimal points in one line."""
    shown = [_shown(one, look) for one in key_values]
    symbol, unit, place = (max(width(s[field]) for s in shown) for field in (0, 3, 4))
    whole = max((width(s.whole) for s in shown if s.fraction), default=0)
    # a long list stands out beyond the column of numbers instead of pushing everything aside
    number = max((w for s in shown if (w := width(_aligned(s, whole))) <= _LONGEST), default=0)
    if look.width is not None and 2 + symbol + 2 + number + 2 + unit + 2 + place > look.width:
        below = (one._replace(place="", text=f"{one.place}  {one.text}") if one.place else one for one in shown)
        shown, place = list(below), 0
    for one in shown:
        value = _aligned(one, whole)
        head = f"  {left(one.symbol, symbol)}  {left(value, number)}  {left(one.unit, unit)}  "
        head += f"{left(one.place, place)}  " if place else ""
        if width(value) > number:
            yield from _standing_out(f"  {left(one.symbol, symbol)}  ", f"{value}  {one.unit}".rstrip(), look)
            head = " " * (4 + symbol + number + 2 + unit + 2 + (place + 2 if place else 0))
        yield from sentence(head, one.text, look)


def _standing_out(head: str, value: str, look: Look) -> Iterator[Line]:
    """Yield a long list beside its symbol, in as many lines as it takes."""
    rest = None if look.width is None else max(look.width - width(head), _LEAST_BESIDE)
    for index, text in enumerate(folded(value, rest)):
        yield line((" " * width(head) if index else head) + text, "cell")


def _aligned(one: _Shown, whole: int) -> str:
    return right(one.whole, whole) + one.fraction if one.fraction else one.whole


def _shown(one: KeyValue, look: Look) -> _Shown:
    charset = look.charset
    whole, fraction = _number(one, look)
    place = "" if one.at_deg is None else f"at {angle(one.at_deg, look.comma)}{charset.text('°')}"
    return _Shown(
        charset.symbol(one.symbol, one.ascii_symbol), whole, fraction, charset.unit(one.unit), place, one.text
    )


def _number(one: KeyValue, look: Look) -> tuple[str, str]:
    """Return the number up to its decimal point and from there; a list, or no value, is not split."""
    # what is only known to be small has no decimal point to stand under the others
    if one.value is None or isinstance(one.value, tuple) or one.noise:
        return number_text(one, look), ""
    text, exponent = _single(one.value, one.unit, look)
    whole, point, fraction = text.partition("," if look.comma else ".")
    # a whole number is split too, at its end, so that its units stand under those of the others
    return whole, look.charset.counted(point + fraction, exponent) or " "


def number_text(one: KeyValue, look: Look) -> str:
    """Return the number of a key value, or its numbers in one line; of a long list how many there are."""
    if one.value is None or one.value == ():
        return look.charset.text("–")
    if one.noise:
        return look.charset.below(NOISE_POWER)
    if not isinstance(one.value, tuple):
        return look.charset.counted(*_single(one.value, one.unit, look))
    if len(one.value) > _MOST_LISTED:
        low, high = (_in_list(value, one.unit, look) for value in (min(one.value), max(one.value)))
        return f"{len(one.value)} from {low} to {high}"
    return ("; " if look.comma else ", ").join(_in_list(value, one.unit, look) for value in one.value)


def _in_list(value: float, unit: str, look: Look) -> str:
    if unit == "deg":
        return angle(value, look.comma)
    return look.charset.counted(*single(value, look.digits, look.comma))


def _single(value: float, unit: str, look: Look) -> tuple[str, int]:
    """Return a value and its power of ten; angles have two decimals where no digits are asked for."""
    if unit == "deg" and look.digits is None:
        return angle(value, look.comma), 0
    return single(value, look.digits, look.comma)


def sentence_text(text: str, look: Look) -> str:
    """Return a sentence in the characters of the output, its numbers with the decimal comma where that is asked for."""
    squared = re.sub(r"(?<=[a-z])\^2", "²", text) if "^2" in text else text  # compiled only where it is needed
    text = look.charset.text(squared if look.charset.has(squared) else text)
    return re.sub(r"(?<=\d)\.(?=\d)", ",", text) if look.comma else text


def sentence(head: str, text: str, look: Look) -> Iterator[Line]:
    """Yield head and sentence; on a terminal the sentence is folded beside its head, or below it if that is narrow."""
    text = sentence_text(text, look)
    if look.width is None or width(head) + width(text) <= look.width:
        yield (Piece(head, "cell"), Piece(text))
        return
    indent = width(head)
    if look.width - indent < _LEAST_BESIDE:
        if head.strip():
            yield line(head, "cell")
        head, indent = "", 6
    for index, one in enumerate(folded(text, max(look.width - indent, _LEAST_BESIDE))):
        yield (Piece(head if head and index == 0 else " " * indent, "cell"), Piece(one))
