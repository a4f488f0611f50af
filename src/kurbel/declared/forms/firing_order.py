"""Form of a firing order."""

from __future__ import annotations

import re

from kurbel.declared.bounds import MOST_ITEMS
from kurbel.declared.forms.scalars import Scalar, refused
from kurbel.declared.keys import Schema
from kurbel.declared.numerals import plain

_ORDER = r"[1-9][0-9]{0,2}(\s*[-, ]\s*[1-9][0-9]{0,2})*"


class FiringOrder(Scalar):
    """The numbers of all cylinders in the order in which they fire, such as `1-3-4-2`; becomes a tuple of int."""

    def parse(self, text: str, folder: str) -> tuple[int, ...]:
        """Return the numbers; raises RuleError where they are not those from 1 on, each once."""
        if not re.fullmatch(_ORDER, plain(text)):
            refused(f"expected {self.expected()}, got '{text}'")
        order = tuple(map(int, re.findall("[0-9]+", text)))
        twice = next((number for number in order if order.count(number) > 1), None)
        if twice:
            refused(f"cylinder {twice} stands twice in {text}")
        missing = next((number for number in range(1, max(order) + 1) if number not in order), None)
        if missing or len(order) > MOST_ITEMS:
            refused(f"cylinder {missing} is missing in {text}" if missing else f"more than {MOST_ITEMS} cylinders")
        return order

    def expected(self) -> str:
        return "the numbers of the cylinders, such as '1-3-4-2'"

    def example(self) -> str:
        return "1-3-4-2"

    def written(self) -> str:
        return "`1-3-4-2`"

    def schema(self, definitions: Schema) -> Schema:
        return {"type": ["string", "integer"], "pattern": rf"^\s*{_ORDER}\s*$"}
