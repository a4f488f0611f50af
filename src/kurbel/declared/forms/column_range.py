"""Form of several columns of a file."""

from kurbel.declared.forms.scalars import Patterned
from kurbel.errors import refused

_ONE = r"[1-9][0-9]{0,4}(\s*-\s*[1-9][0-9]{0,4})?"
_MOST = 5000


class ColumnRange(Patterned):
    """The numbers of columns, such as `2-61` or `2, 5, 7-9`; becomes a tuple of int."""

    pattern = rf"{_ONE}(\s*,\s*{_ONE})*"
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
