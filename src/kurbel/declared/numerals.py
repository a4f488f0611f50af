"""Numbers as people write them, with the white space and the signs that word processors put in their place."""

import math
import re

from kurbel.errors import UnitError

NUMBER = re.compile(r"[-+]?(?:(?:0|[1-9][0-9]*)(?:\.[0-9]*)?|\.[0-9]+)(?:[eE][-+]?[0-9]+)?")
"""A number as YAML 1.2 writes it: no leading zero, no underscore, no base 60, no inf."""
RATIO = rf"({NUMBER.pattern})\s*(?:/\s*({NUMBER.pattern})|%)"
"""A quotient or a percentage; compiled only when a text is no plain number."""

WRITTEN = rf"(?:[0-9]{{1,4}}[ -])?{NUMBER.pattern}(?:\s*/\s*{NUMBER.pattern})?"
"""A number before a unit, as inches have it, too: 2 1/4."""

SPACES = (
    "\xa0\u1680\u2000\u2001\u2002\u2003\u2004\u2005\u2006\u2007\u2008\u2009\u200a\u202f\u205f\u3000"
)
"""White space that no keyboard has; who wrote it meant a space."""
_ALIKE: dict[int, int | str] = {
    **{code: code - 0xFEE0 for code in range(0xFF01, 0xFF5F)},  # full-width forms
    **dict.fromkeys(map(ord, SPACES), " "),
    **dict.fromkeys((0x2010, 0x2011, 0x2012, 0x2013, 0x2212, 0xFE63), "-"),
    **dict.fromkeys((0x2044, 0x2215), "/"),
    **dict.fromkeys((0x2219, 0x22C5), "·"),
    **dict.fromkeys((0x00BA, 0x02DA), "°"),
}
"""Signs that look like one of ours and can mean nothing else in a number or a unit."""


def familiar(text: str) -> str:
    """Return a text with look-alikes as a keyboard has them."""
    if text.isascii():
        return text
    return text.translate(_ALIKE)


def keyboard_text(text: str) -> str:
    """Return a number or unit as a keyboard writes it, one space wherever there is white space, none at the ends.

    >>> keyboard_text("\\u22125\\u202fmm ")
    '-5 mm'
    """
    return " ".join(familiar(text).split())


def parse_number(text: str) -> float:
    """Return the finite number that `text` is; raises UnitError with a fix."""
    number = NUMBER.fullmatch(text) or NUMBER.fullmatch(keyboard_text(text))
    if not number:
        raise UnitError(f"expected a number, got '{text}'{_hint(keyboard_text(text))}")
    value = float(number.group())
    if not math.isfinite(value):
        raise UnitError(f"{number.group()} is too large to compute with")
    return value


def parse_ratio(text: str) -> float:
    """Return the number that a text is, also as a quotient or in percent; raises UnitError as `parse_number` does.

    >>> parse_ratio("1/80"), parse_ratio("75 %")
    (0.0125, 0.75)
    """
    if NUMBER.fullmatch(text):
        return parse_number(text)
    quotient = re.fullmatch(RATIO, keyboard_text(text))
    if not quotient:
        return parse_number(text)
    numerator = parse_number(quotient[1])
    denominator = parse_number(quotient[2] or "100")
    has_value = denominator and bool(numerator) == bool(numerator / denominator)
    if not has_value:
        raise UnitError(f"expected a number or a quotient such as 1/200, got '{text}'")
    return numerator / denominator


def _hint(text: str) -> str:
    """Return how to write what a text probably means, '' where nothing is likely."""
    if re.fullmatch(r"[-+]?[0-9]+,[0-9]+", text):
        return "; write the decimal point: " + text.replace(",", ".")
    if re.fullmatch(r"[-+]?[0-9.]+(,[0-9.]+)+", text):
        return "; write it without commas between thousands"
    if re.fullmatch(r"[-+]?[0-9]+( [0-9]{3})+(\.[0-9]*)?", text):
        return "; write it without spaces between thousands"
    if re.fullmatch(r"[-+]?[0-9]+(\.[0-9]+)?\s*%", text):
        return f"; write it as a fraction: {float(text[:-1]) / 100:.12g}"
    if re.fullmatch(r"[-+]?[0-9_]+(\.[0-9]+)?", text) and "_" in text:
        return "; leave out the underscores"
    if re.fullmatch(r"[-+]?0[0-9]+(\.[0-9]*)?", text):
        return "; leave out the leading zero"
    if re.fullmatch(r"[0-9]+(:[0-9]+(\.[0-9]+)?)+", text):
        return "; a ratio is written as one number, such as 5 for 5:1"
    if re.fullmatch(r"[-+]?[0-9]+(\.[0-9]+)?/[0-9]+(\.[0-9]+)?", text):
        numerator, denominator = map(float, text.split("/"))
        if not denominator:
            return ""
        return f"; write it as one number: {numerator / denominator:.12g}"
    if text.lower().strip("+-.") in ("nan", "inf", "infinity"):
        return "; it must be finite"
    number = NUMBER.match(text)
    if number is None or re.match("0[box]", text):
        return ""
    has_unit = re.match(r"\s*[A-Za-z°]", text[number.end() :])
    if not has_unit:
        return ""
    return f"; it has no unit, write {number.group()}"
