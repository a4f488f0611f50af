"""Forms of texts: any text, texts of a pattern, the name of a file."""

import os
import re

from kurbel.declared.forms.scalars import Scalar
from kurbel.declared.keys import Schema
from kurbel.declared.kinds import MOST_ITEMS
from kurbel.declared.numerals import plain
from kurbel.declared.reading import shown
from kurbel.errors import refused


class Text(Scalar):
    """Any text that is not empty."""

    def parse(self, text: str, folder: str) -> str:
        return text.strip()

    def expected(self) -> str:
        return "a text"

    def schema(self, definitions: Schema) -> Schema:
        return {"type": ["string", "number"]}


class Patterned(Scalar):
    """A text of a pattern, such as numbers joined by hyphens; what: what it is, sample: one that fits."""

    pattern: str
    what: str
    sample: str

    def matched(self, text: str) -> str:
        """Return a text that fits as a keyboard writes it; raises RuleError."""
        if not re.fullmatch(self.pattern, plain(text)):
            refused(f"expected {self.expected()}, got '{text}'")
        return plain(text)

    def expected(self) -> str:
        return f"{self.what}, such as '{self.sample}'"

    def example(self) -> str:
        return self.sample

    def written(self) -> str:
        return f"`{self.sample}`"

    def schema(self, definitions: Schema) -> Schema:
        return {"type": ["string", "integer"], "pattern": rf"^\s*{self.pattern}\s*$"}


class FiringOrder(Patterned):
    """The numbers of all cylinders in the order in which they fire, such as `1-3-4-2`; becomes a tuple of int."""

    pattern = r"[1-9][0-9]{0,2}(\s*[-, ]\s*[1-9][0-9]{0,2})*"
    what, sample = "the numbers of the cylinders", "1-3-4-2"

    def parse(self, text: str, folder: str) -> tuple[int, ...]:
        """Return the numbers; raises RuleError where they are not those from 1 on, each once."""
        order = tuple(map(int, re.findall("[0-9]+", self.matched(text))))
        twice = next((number for number in order if order.count(number) > 1), None)
        if twice:
            refused(f"cylinder {twice} stands twice in {text}")
        missing = next((number for number in range(1, max(order) + 1) if number not in order), None)
        if missing or len(order) > MOST_ITEMS:
            refused(f"cylinder {missing} is missing in {text}" if missing else f"more than {MOST_ITEMS} cylinders")
        return order


_COLUMNS = r"[1-9][0-9]{0,4}(\s*-\s*[1-9][0-9]{0,4})?"
_MOST = 5000


class ColumnRange(Patterned):
    """The numbers of columns, such as `2-61` or `2, 5, 7-9`; becomes a tuple of int."""

    pattern = rf"{_COLUMNS}(\s*,\s*{_COLUMNS})*"
    what, sample = "the numbers of columns", "2-61"

    def parse(self, text: str, folder: str) -> tuple[int, ...]:
        """Return the numbers, each once; raises RuleError."""
        parts = [[int(one) for one in part.split("-")] for part in self.matched(text).split(",")]
        found = tuple(number for part in parts for number in range(part[0], part[-1] + 1))
        if len(set(found)) < len(found) or any(part[0] > part[-1] for part in parts):
            refused(f"{text} runs backward or names a column twice; write for instance '2-61'")
        return found if len(found) <= _MOST else refused(f"{text} are {len(found)} columns; at most {_MOST} are read")

    def expected(self) -> str:
        return "the numbers of columns, such as '2-61', or in quotation marks '2, 5, 7-9'"

    def written(self) -> str:
        return "`2-61`, or in quotation marks `'2, 5, 7-9'`"


class FilePath(Scalar):
    """The path of a file, relative to the machine file; becomes a path that can be opened."""

    def parse(self, text: str, folder: str) -> str:
        full = os.path.join(folder, text)
        if os.path.isdir(full):
            refused(f"'{shown(text)}' is a folder; name the file in it")
        if os.path.exists(full) and not os.path.isfile(full):
            refused(f"'{shown(text)}' is a device or a pipe; name a file that can be read again")
        if not os.path.isfile(full):
            refused(f"there is no file '{shown(text)}' in {shown(folder) if folder else 'the working directory'}")
        return full

    def expected(self) -> str:
        return "the name of a file"

    def schema(self, definitions: Schema) -> Schema:
        return {"type": "string", "minLength": 1}
