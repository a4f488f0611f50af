"""How numbers and texts look, and lines of text: as many digits as an engineer reads, widths in cells, folding."""

import math
import re
from collections.abc import Iterable, Iterator, Sequence
from functools import cache
from textwrap import wrap
from typing import NamedTuple
from unicodedata import combining, east_asian_width, normalize

from kurbel.declared.unit_systems import SYSTEMS
from kurbel.quantity import ENTRY_DECIMALS, ENTRY_DIGITS, GREEK
from kurbel.tables.tables import CellValue

# numbers

DIGITS = 4
"""Significant digits of the largest value of a row by default."""

_LARGE = 7  # from 1e7 on, and below 1e-4, a row gets its power of ten into the head
_SMALL = -4


class Scale(NamedTuple):
    """How a row is written: each value over 10^exponent, with this many decimals."""

    decimals: int
    exponent: int = 0


def digit_scale(values: Iterable[CellValue], digits: int | None = None) -> Scale:
    """Return the scale that shows so many significant digits of the largest value.

    By default there are four, and whole numbers keep all of theirs; with `digits` they are rounded, too.

    >>> digit_scale([1.2, -0.014]), digit_scale([81134.0]), digit_scale([81134.0], 2)
    (Scale(decimals=3, exponent=0), Scale(decimals=0, exponent=0), Scale(decimals=-3, exponent=0))
    >>> digit_scale([2.4e7, 1.0])
    Scale(decimals=2, exponent=6)
    """
    largest = max((abs(value) for value in values if value is not None), default=0.0)
    if largest == 0:
        return Scale(0)
    power = _power(largest, digits or DIGITS)
    exponent = 0 if _SMALL <= power < _LARGE else 3 * math.floor(power / 3)
    decimals = (digits or DIGITS) - 1 - power + exponent
    return Scale(decimals if digits else max(0, decimals), exponent)


def angle_scale(values: Iterable[CellValue], digits: int | None = None) -> Scale:
    """Return the scale of angles in degrees: two decimals, fewer if no angle has them; or so many digits.

    >>> angle_scale([79.27236, 90.0]), angle_scale([79.27236, 90.0], 6), angle_scale([0.0, 90.0])
    (Scale(decimals=2, exponent=0), Scale(decimals=4, exponent=0), Scale(decimals=0, exponent=0))
    """
    angles = [value for value in values if value is not None]
    if digits:
        return Scale(max(0, digit_scale(angles, digits).decimals))
    return Scale(_most_decimals(angles, 2))


def head_scale(values: Sequence[CellValue], digits: int | None = None) -> Scale:
    """Return the scale of the crank angles of a table, which distinguishes them all, with six decimals at most.

    Angles that were written keep their decimals; computed ones have as many digits as other angles.

    >>> head_scale([0.0, 22.5]), head_scale([79.272357282, 280.727642718])
    (Scale(decimals=1, exponent=0), Scale(decimals=2, exponent=0))
    >>> head_scale([10.0011111111, 10.0022222222]), head_scale([79.100135299], 5)
    (Scale(decimals=3, exponent=0), Scale(decimals=3, exponent=0))
    """
    angles = [value for value in values if value is not None]
    if all(_is_written(value) for value in angles):
        return Scale(_most_decimals(angles, _MOST_DECIMALS))
    different = len({round(value, _MOST_DECIMALS) for value in angles})
    for decimals in range(angle_scale(angles, digits).decimals, _MOST_DECIMALS):
        if len({round(value, decimals) for value in angles}) == different:
            return Scale(decimals)
    return Scale(max(_MOST_DECIMALS, angle_scale(angles, digits).decimals))


def _is_written(value: float) -> bool:
    """Return whether an angle has no more decimals than a table shows, as people write angles."""
    return abs(value - round(value, _MOST_DECIMALS)) <= 1e-12 * abs(value)


_MOST_DECIMALS = 6
"""Of the crank angles of a table."""


def _most_decimals(angles: Iterable[float], limit: int) -> int:
    """Return how many decimals the angles need, at most `limit`, without zeros at the end."""
    texts = (angle(value, limit) for value in angles)
    return max((len(text.partition(".")[2]) for text in texts), default=0)


def _power(value: float, digits: int) -> int:
    """Return the power of ten of the value as rounded: 3 for 999.96 at four digits."""
    return int(f"{abs(value):.{digits - 1}e}".partition("e")[2])


def cell(value: CellValue, scale: Scale) -> str:
    """Return the value as a table shows it; an exact zero is `0` as in the book, no value is empty.

    >>> cell(-0.0142, Scale(3)), cell(-0.0001, Scale(3)), cell(0.0, Scale(3)), cell(81134.0, Scale(-3))
    ('-0.014', '0.000', '0', '81000')
    """
    if not value:
        return "" if value is None else "0"
    if scale.exponent:
        mantissa, power = f"{value:.25e}".split("e")
        value = float(f"{mantissa}e{int(power) - scale.exponent}")  # rounded once
    # adding 0.0 turns -0.0 into 0.0
    return f"{round(value, scale.decimals) + 0.0:.{max(0, scale.decimals)}f}"


def in_thousands(text: str) -> str:
    """Return a text in which numbers from 10,000 on have thin spaces.

    >>> in_thousands("J = 18066.25, -1234567; 1234, 0.123456, run-10000.csv").replace("\N{NARROW NO-BREAK SPACE}", "_")
    'J = 18_066.25, -1_234_567; 1234, 0.123456, run-10000.csv'
    """
    long = r"(?<![\w.,^-])-?[1-9]\d{4,}(?=[.,]\d|[.,;]?(?:\s|$)|\))"
    return re.sub(long, lambda number: f"{int(number[0]):_}".replace("_", _THIN), text)


def single(value: float, digits: int | None = None, own: int = 0) -> tuple[str, int]:
    """Return a single value, and its power of ten.

    own: digits of a value among others of quite another size, which has a power of ten sooner.

    >>> single(0.8), single(2.4e7), single(-1.1e-16)
    (('0.8000', 0), ('2.400', 7), ('-1.100', -16))
    >>> single(0.0417, own=2), single(3.2e-16, own=2), single(1464, own=2), single(0, own=2)
    (('0.042', 0), ('3.2', -16), ('1464', 0), ('0', 0))
    """
    if not value or isinstance(value, int):
        return str(int(value)), 0
    count = digits or own or DIGITS
    power = _power(value, count)
    small, large = (-2, 5) if own else (_SMALL, _LARGE)
    exponent = 0 if small <= power < large else power
    decimals = count - 1 - power + exponent
    # only requested digits round whole numbers, too
    if own or not digits:
        decimals = max(0, decimals)
    return cell(value, Scale(decimals, exponent)), exponent


def angle(value: float, decimals: int = 2) -> str:
    """Return an angle in degrees with so many decimals at most.

    >>> angle(79.10014), angle(180.0)
    ('79.1', '180')
    """
    text = f"{round(value, decimals) + 0.0:.{decimals}f}"
    return text.rstrip("0").rstrip(".")


def rounded(value: CellValue, digits: int | None) -> CellValue:
    """Return the value to this many significant digits; counts and None, or without `digits` all, as they are.

    >>> rounded(0.1, None), rounded(5, 2), rounded(-0.0, None), rounded(0.12345, 2)
    (0.1, 5, 0.0, 0.12)
    """
    if value is None or isinstance(value, int):
        return value
    return float(value if digits is None else f"{value:.{digits}g}") + 0.0


def whole_if_integral(value: CellValue) -> CellValue:
    """Return 10 for 10.0, so that angles and ratios are written as people write them."""
    if value is None:
        return None
    is_integral = abs(value) < 1e15 and value == int(value)
    if not is_integral:
        return value
    return int(value)


# texts

FORMATS = ("table", "csv", "json", "xlsx", "markdown", "html", "latex")
LAYOUTS = ("book", "rows")
_ASCII = {
    **GREEK, "∮": "integral ", "₀": "0",
    "√": "sqrt", "∞": "inf",
    "²": "^2", "³": "^3", "¼": "1/4", "⅔": "2/3", "·": "*", "×": "x", "–": "-", "—": "-",
    "±": "+-", "≤": "<=", "≥": ">=", "≈": "~", "≠": "!=", "→": "->", "…": "...", "°": " deg", "′": "'", "″": '"',
    "‘": "'", "’": "'", "“": '"', "”": '"', "„": '"', "─": "-", "│": "|", "═": "=", "µ": "u", "‰": "1/1000",
    "ä": "ae", "ö": "oe", "ü": "ue", "Ä": "Ae", "Ö": "Oe", "Ü": "Ue", "ß": "ss",
}  # fmt: skip
_SUPERSCRIPT = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
_CONTROL = dict.fromkeys((*range(32), *range(127, 160), 0xFFFE, 0xFFFF), "�")
TURNING = (0x061C, 0x200E, 0x200F, *range(0x202A, 0x202F), *range(0x2066, 0x206A))
"""Characters that turn the direction of writing: a name with one could make a line read backward."""
_TURNING = dict.fromkeys(TURNING, "�")
_NARROWEST = 24  # below this a sentence is folded under its head instead of next to it
_NO_BREAK, _THIN = "\N{NO-BREAK SPACE}", "\N{NARROW NO-BREAK SPACE}"
_POINT = r"(?<=\d)\.(?=\d)"
_SUBSCRIPT = "(?:(?<=\\b\\w)|(?<=\\b\\w[\u0307\u0308])|(?<=Δ\\w))_([^\\s|()/;²³]+?)(?=[,.:]?\\s|[,.:]?$|[|()/;²³])"
"""The decimal point of a number, and what is below the line: patterns that few commands need."""


class Look(NamedTuple):
    """How a report is to look, and what its output can show.

    format, layout: of FORMATS and LAYOUTS; comma: decimal comma; digits: significant digits, where None means four in
    print and all of them in csv and json; width: columns to fill, None for nine angles to a block and nothing folded;
    encoding: of the output, whose missing characters are replaced.
    """

    format: str = "table"
    layout: str = "book"
    comma: bool = False
    digits: int | None = None
    width: int | None = None
    encoding: str = "utf-8"

    def has(self, text: str) -> bool:
        """Whether the encoding has all these characters."""
        try:
            text.encode(self.encoding)
        except (UnicodeEncodeError, LookupError):
            return text.isascii()
        return True

    def text(self, text: str) -> str:
        """Return the text for people, without characters that are missing or would turn the writing.

        >>> Look(encoding="ascii").text("Werte für φ ≤ 90°")
        'Werte fuer phi <= 90 deg'
        """
        return self.data(text.translate(_TURNING))

    def data(self, text: str) -> str:
        """Return the text for programs, without control characters and what the encoding lacks."""
        text = text.translate(_CONTROL)
        if self.has(text):
            return text
        return "".join(c if self.has(c) else self._replaced(c) for c in text)

    def _replaced(self, character: str) -> str:
        """Return what is written for a character that the encoding lacks."""
        plain = normalize("NFKD", character).encode("ascii", "ignore").decode()
        return _ASCII.get(character) or plain or "?"

    def sentence(self, text: str) -> str:
        """Return a sentence for people, its numbers as they are wanted."""
        printed = re.sub(r"(?<=[a-z])\^2", "²", text)
        if self.has("µ"):
            printed = re.sub(r"(?<=\d )um\b", "µm", printed)
        return self.number(self.text(printed))

    def number(self, text: str) -> str:
        """Return a text whose numbers have the decimal sign that is wanted; in HTML and LaTeX see `fine`."""
        if self.format in ("html", "latex"):
            return self.fine(text)
        if not self.comma:
            return text
        return re.sub(_POINT, ",", text)

    def fine(self, text: str) -> str:
        """Return a text whose numbers have thin spaces, minus signs and degrees as signs, where the output has them.

        >>> Look(comma=True).fine("J = 18066.25, -1.5 and run-10000.csv").replace("\N{NARROW NO-BREAK SPACE}", "_")
        'J = 18_066,25, −1,5 and run-10000.csv'
        """
        if self.has("−" + _THIN):
            text = re.sub(r"(?<![\w.-])-(?=\d)", "−", in_thousands(text))
            text = re.sub(r"(?<=\d) deg\b", "°", text)
        if not self.comma:
            return text
        return re.sub(_POINT, ",", text)

    def value(self, value: float, digits: int | None = None) -> str:
        """Return a single value with its power of ten, to so many digits if no others are wanted."""
        return self.number(self.counted(*single(value, self.digits or digits)))

    def measured(self, value: float, unit: str, digits: int | None = None) -> tuple[str, str]:
        """Return a single value and its unit as printed; a degree is at its number.

        >>> Look().measured(87.7, "kN"), Look().measured(22.02, "deg")
        (('87.70', 'kN'), ('22.02°', ''))
        """
        number, printed = self.value(value, digits), self.unit(unit)
        if printed == "°":
            return (number + printed, "")
        return (number, printed)

    def angle(self, value: float) -> str:
        """Return an angle in degrees, with two decimals at most if no digits are wanted."""
        if self.digits:
            return self.value(value)
        return self.number(angle(value))

    def value_for_entry(self, value: float) -> str:
        """Return a value with the digits with which people write it into a machine file."""
        return self.value(value, ENTRY_DIGITS)

    def angle_for_entry(self, value: float) -> str:
        """Return an angle with the decimals with which people write it into a machine file."""
        if self.digits:
            return self.value(value)
        return self.number(angle(value, ENTRY_DECIMALS))

    def degrees(self, value: float) -> str:
        """Return an angle with its unit."""
        return self.angle(value) + self.text("°")

    def extreme_at(self, value: float, side: str) -> str:
        """Return the angle of an extreme with its unit; with a minus after it if it is the limit before a jump.

        >>> Look().extreme_at(360.0, "before"), Look().extreme_at(67.3, "")
        ('360°−', '67.3°')
        """
        return self.degrees(value) + self.text("−" if side else "")

    def symbol(self, symbol: str, ascii_symbol: str) -> str:
        """Return the textbook symbol, or its ASCII name."""
        return symbol if self.has(symbol) else ascii_symbol

    def unit(self, unit: str, exponent: int = 0) -> str:
        """Return a unit as printed, after the power of ten of its row.

        >>> Look().unit("m/s^2"), Look().unit("N", 6), Look(encoding="ascii").unit("N", 6)
        ('m/s²', '10⁶ N', '10^6 N')
        """
        signs = {"deg": "°", "um": "µm"}
        printed = signs.get(unit, unit.replace("^2", "²").replace("^3", "³"))
        if not self.has(printed):
            printed = unit
        if not exponent:
            return printed
        return f"{self._power(exponent)} {printed}".strip()

    def counted(self, number: str, exponent: int) -> str:
        """Return a number with its power of ten: `2.4·10⁶`, or `2.4e6`."""
        if not exponent:
            return number
        printed = "·" + self._power(exponent)
        if self.has(printed):
            return number + printed
        return f"{number}e{exponent}"

    def _power(self, exponent: int) -> str:
        printed = "10" + str(exponent).translate(_SUPERSCRIPT)
        if self.has(printed):
            return printed
        return f"10^{exponent}"


def width(text: str) -> int:
    """Return the number of terminal cells of a text: none for an accent, two for a wide character."""
    if text.isascii():
        return len(text)
    cells = 0
    for character in text:
        if not combining(character):
            cells += 2 if east_asian_width(character) in "WF" else 1
    return cells


def padded(text: str, cells: int, flush_right: bool = False) -> str:
    """Return the text in so many cells, flush left or right."""
    blanks = " " * (cells - width(text))
    if flush_right:
        return blanks + text
    return text + blanks


class Piece(NamedTuple):
    """A piece of a line; role, for colours: title, head, rule, name, symbol, unit, cell, mark or text."""

    text: str
    role: str = "text"


Line = tuple[Piece, ...]
BLANK: Line = ()


def line(text: str, role: str = "text") -> Line:
    """Return a line of one piece."""
    return (Piece(text, role),)


def paragraph(text: str, cells: int | None, role: str = "text") -> list[Line]:
    """Return a text in lines of so many cells; see `folded`."""
    return [line(row, role) for row in folded(text, cells)]


def plain_lines(lines: Iterable[Line]) -> Iterator[str]:
    """Yield the lines as text, without blanks at their ends."""
    for pieces in lines:
        yield "".join(piece.text for piece in pieces).rstrip() + "\n"


def folded(text: str, cells: int | None) -> list[str]:
    """Return a text in lines of so many cells, None for one line; no word is broken, no number parted from its unit."""
    if cells is None or width(text) <= cells:
        return [text]
    kept = measures().sub(lambda measure: measure[0].replace(" ", _NO_BREAK), text)
    rows = wrap(kept, cells, break_long_words=False, break_on_hyphens=False)
    return [row.replace(_NO_BREAK, " ") for row in rows]


def in_two_columns(
    entries: Iterable[tuple[str, str]], look: Look, indent: str = "  "
) -> Iterator[Line]:
    """Yield heads in a column, each with its sentence."""
    rows = [(look.text(head), text) for head, text in entries]
    column = max((width(head) for head, _ in rows), default=0)
    for head, text in rows:
        yield from sentence(f"{indent}{padded(head, column)}  ", text, look)


def sentence(head: str, text: str, look: Look) -> Iterator[Line]:
    """Yield a head and its sentence, which is folded next to it, or below it if there is little room."""
    text = look.sentence(text)
    room = None if look.width is None else look.width - width(head)
    if room is not None and room < min(width(text), _NARROWEST):
        if head.strip():
            yield line(head, "cell")
        head = " " * 6
        room = max((look.width or 0) - 6, _NARROWEST)
    for row in folded(text, room):
        yield (Piece(head, "cell"), Piece(row))
        head = " " * width(head)


@cache
def measures() -> re.Pattern[str]:
    """Return the pattern of a number with its unit, which stay in one line.

    >>> measures().findall("within 10 % of 2.35 kN m at 5 points")
    ['10 %', '2.35 kN m']
    """
    units = set[str]()
    for system in SYSTEMS.values():
        for of_kind in system.values():
            units.update([of_kind] if isinstance(of_kind, str) else of_kind)
    printed = {"%", "°", *units, *map(Look().unit, units)} - {""}
    longest_first = "|".join(map(re.escape, sorted(printed, key=len, reverse=True)))
    return re.compile(rf"(?:\S|{_THIN})*\d  ?(?:{longest_first})(?!\w)")


def subscripts(text: str) -> list[str]:
    """Return what is on the line and what is below it as subscripts, in turn.

    >>> subscripts("T_max 5.1 kN"), subscripts("F_x², F_y: forces"), subscripts("my_engine")
    (['T', 'max', ' 5.1 kN'], ['F', 'x', '², F', 'y', ': forces'], ['my_engine'])
    """
    return re.split(_SUBSCRIPT, text)
