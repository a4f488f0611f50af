"""Forms of mappings by dotted keys of the machine file: standard uncertainties, and the values of a load case."""

import re
from typing import Any

from kurbel.declared.keys import Form, Schema
from kurbel.declared.numerals import NUMBER, plain
from kurbel.declared.reading import LONGEST_VALUE, REFUSED, Reading, is_nothing, kind_of, shown
from kurbel.errors import Path, refused

_EXAMPLE = "'bore: ± 0.2 mm' or 'masses.piston: ± 2 %'"
_SIGN = r"(±|\+/-|\+-)\s*"


class Uncertainties(Form):
    """A mapping from dotted keys to `± 0.2 mm` or `± 2 %`; becomes pairs of key and text without the sign."""

    shape = dict

    def expected(self) -> str:
        return f"a mapping of keys to standard uncertainties, such as {_EXAMPLE}"

    def schema(self, definitions: Schema) -> Schema:
        return {"type": "object", "minProperties": 1, "additionalProperties": {"type": ["string", "number"]}}

    def take(self, reading: Reading, value: Any, path: Path) -> Any:
        """Read every uncertainty."""
        if not isinstance(value, dict) or not value:
            refused(f"expected {self.expected()}, got {'nothing' if is_nothing(value) else kind_of(value)}")
        found = [(name, self._read(reading, one, (*path, name))) for name, one in value.items()]
        return REFUSED if any(text is REFUSED for _, text in found) else tuple(found)

    def _read(self, reading: Reading, value: Any, path: Path) -> Any:
        if isinstance(value, str) and len(value) <= LONGEST_VALUE:
            text = spread_text(value)
            if text:
                return text
            value = shown(value)
        return reading.fault(path, f"expected a standard uncertainty above 0, such as {_EXAMPLE}, got {value!r}")


class Settings(Form):
    """A mapping from dotted keys to values that stand there instead; becomes pairs of key and value, as in the file."""

    shape = dict

    def expected(self) -> str:
        return "a mapping of dotted keys to values, such as 'speed: 60 rpm' or 'cylinders.0.bore: 450 mm'"

    def schema(self, definitions: Schema) -> Schema:
        return {"type": "object", "minProperties": 1}

    def take(self, reading: Reading, value: Any, path: Path) -> Any:
        """Take the values as they are: they are read with the case."""
        if not isinstance(value, dict) or not value:
            refused(f"expected {self.expected()}, got {'nothing' if is_nothing(value) else kind_of(value)}")
        return tuple(value.items())


def spread_text(text: str) -> str:
    """Return the number with its unit, or percent, after `±`; '' for what is none above 0.

    >>> spread_text("± 0.2 mm"), spread_text("+-2 %"), spread_text("±-1 mm")
    ('0.2 mm', '2 %', '')
    """
    rest = re.sub(_SIGN, "", plain(text).strip(), count=1)
    number = NUMBER.match(rest)
    return rest if number and float(number.group()) > 0 else ""
