"""Form of a firing order."""

import re

from kurbel.declared.bounds import MOST_ITEMS
from kurbel.declared.forms.scalars import Patterned
from kurbel.errors import refused


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
