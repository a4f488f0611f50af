"""Form of a list of records, of which one may be like another."""

from typing import Any

from kurbel.declared.forms.records import Record
from kurbel.declared.forms.structures import Listing
from kurbel.declared.keys import Schema
from kurbel.declared.kinds import MOST_ITEMS
from kurbel.declared.reading import REFUSED, Reading, Tree, shown
from kurbel.errors import Path
from kurbel.near_words import did_you_mean

LIKE, _NAME = "like", "name"


class Alike(Listing):
    """A list of records with names; `like: NAME` in one takes over what stands in that one above it.

    What stands in the item itself comes first, also before what says the same thing there by another key. called: what
    an item without a name is called, before its number.
    """

    def __init__(self, item: Record, called: str) -> None:
        super().__init__(item)
        self.record, self.called = item, called

    def take(self, reading: Reading, value: Any, path: Path) -> Any:
        """Read the list, its items completed."""
        items = value if isinstance(value, list) and len(value) <= MOST_ITEMS else []
        whole: dict[str, tuple[int, Tree]] = {}
        completed = []
        for index, item in enumerate(items):
            full = self._completed(reading, item, whole, (*path, index))
            if isinstance(full, dict):
                name = full.get(_NAME)
                whole.setdefault(name if isinstance(name, str) else f"{self.called} {index + 1}", (index, full))
            completed.append(full)
        return super().take(reading, completed or value, path)

    def _completed(self, reading: Reading, item: Any, above: dict[str, tuple[int, Tree]], path: Path) -> Any:
        """Return an item with what it takes over; its faults are those of the other one where they are the same."""
        if not isinstance(item, dict) or LIKE not in item or item[LIKE] is REFUSED:
            return item
        name = item[LIKE]
        if not isinstance(name, str) or name not in above:
            hint = did_you_mean(str(name), tuple(above)) or f"; above are {', '.join(map(shown, above))}"
            none_such = f"no {self.called} above this one is called '{shown(str(name))}'{hint if above else ''}"
            return reading.fault((*path, LIKE), none_such)
        index, other = above[name]
        reading.alike[path] = (*path[:-1], index)
        own = {key: value for key, value in item.items() if key != LIKE}
        replaced = {_NAME, *(key for pair in self.record.alternatives() if own.keys() & set(pair) for key in pair)}
        return {key: value for key, value in other.items() if key not in replaced} | own

    def schema(self, definitions: Schema) -> Schema:
        """Return the schema of the list; an item that is like another need not say everything."""
        properties: Schema = {}
        self.record.describe_all(properties, [], definitions)
        short = {"type": "object", "additionalProperties": False, "properties": properties}
        listing = super().schema(definitions)
        return listing | {"items": {"if": {"required": [LIKE]}, "then": short, "else": listing["items"]}}
