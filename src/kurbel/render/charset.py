"""Characters that the output can show: Greek, powers and thin rules, or ASCII where its encoding lacks them."""

from typing import NamedTuple

from kurbel.declared.quantity import GREEK

_ASCII = {
    **GREEK, "∮": "integral ", "₀": "0",
    "√": "sqrt", "∞": "inf",
    "²": "^2", "³": "^3", "¼": "1/4", "⅔": "2/3", "·": "*", "×": "x", "–": "-", "—": "-",
    "±": "+-", "≤": "<=", "≥": ">=", "≈": "~", "≠": "!=", "→": "->", "…": "...", "°": " deg", "′": "'", "″": '"',
    "‘": "'", "’": "'", "“": '"', "”": '"', "„": '"', "─": "-", "│": "|", "═": "=", "µ": "u", "‰": "1/1000",
    "ä": "ae", "ö": "oe", "ü": "ue", "Ä": "Ae", "Ö": "Oe", "Ü": "Ue", "ß": "ss",
}  # fmt: skip
_SUPERSCRIPT = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
_NARROW = {*map(chr, (*range(32, 127), *_SUPERSCRIPT.values())), *_ASCII, "∠"} - {"\u0307", "\u0308"}
"""What kurbel itself writes, one terminal cell each; only other characters need the tables of Unicode."""
_CONTROL = dict.fromkeys((*range(32), *range(127, 160)), "�")


class Charset(NamedTuple):
    """What can be written in this encoding, and what stands for the rest."""

    encoding: str = "utf-8"

    def has(self, text: str) -> bool:
        """Whether the encoding has all these characters."""
        try:
            text.encode(self.encoding)
        except (UnicodeEncodeError, LookupError):
            return text.isascii()
        return True

    def text(self, text: str) -> str:
        """Return the text with a stand-in for each character that is missing; control characters lose their effect.

        >>> Charset("ascii").text("Werte für φ ≤ 90°")
        'Werte fuer phi <= 90 deg'
        """
        text = text.translate(_CONTROL)
        return text if self.has(text) else "".join(c if self.has(c) else _stand_in(c) for c in text)

    def symbol(self, symbol: str, ascii_symbol: str) -> str:
        """Return the textbook symbol, or its ASCII name."""
        return symbol if self.has(symbol) else ascii_symbol

    def unit(self, unit: str, exponent: int = 0) -> str:
        """Return a unit as it is printed, after the power of ten that its row is counted in.

        >>> Charset().unit("m/s^2"), Charset().unit("N", 6), Charset("ascii").unit("N", 6)
        ('m/s²', '10⁶ N', '10^6 N')
        """
        printed = {"deg": "°"}.get(unit, unit.replace("^2", "²").replace("^3", "³"))
        if not self.has(printed):
            printed = unit
        return f"{self._power(exponent)} {printed}".strip() if exponent else printed

    def counted(self, number: str, exponent: int) -> str:
        """Return a number that is counted in a power of ten: `2.4·10⁶`, or `2.4e6`."""
        printed = "·" + self._power(exponent)
        return f"{number}{printed if self.has(printed) else f'e{exponent}'}" if exponent else number

    def below(self, exponent: int) -> str:
        """Return what stands for a value that is only known to be less than a power of ten.

        >>> Charset().below(-14), Charset("ascii").below(-14)
        ('< 10⁻¹⁴', '< 1e-14')
        """
        printed = "< " + self._power(exponent)
        return printed if not printed.isascii() else f"< 1e{exponent}"

    def _power(self, exponent: int) -> str:
        printed = "10" + str(exponent).translate(_SUPERSCRIPT)
        return printed if self.has(printed) else f"10^{exponent}"


def _stand_in(character: str) -> str:
    if character in _ASCII:
        return _ASCII[character]
    from unicodedata import normalize

    return normalize("NFKD", character).encode("ascii", "ignore").decode() or "?"


def width(text: str) -> int:
    """Return the number of terminal cells of a text: none for an accent, two for a wide character."""
    if text.isascii() or _NARROW.issuperset(text):
        return len(text)
    from unicodedata import combining, east_asian_width

    return sum(0 if combining(c) else 2 if east_asian_width(c) in "WF" else 1 for c in text)


def left(text: str, cells: int) -> str:
    """Return the text, filled on its right."""
    return text + " " * (cells - width(text))


def right(text: str, cells: int) -> str:
    """Return the text, filled on its left."""
    return " " * (cells - width(text)) + text
